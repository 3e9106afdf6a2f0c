"""`treadload study`: the results of a study in a store, as text, as tables, as a page."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from treadload.cli import shell
from treadload.cli.progress import stages

Store = Annotated[Path, typer.Argument(help="The store that `treadload sweep` wrote, *.zarr.")]

app = typer.Typer(
    help="Summarise a parameter study: a summary, tables, a page with its figures.", no_args_is_help=True
)


def summary(store: Store) -> None:
    """What was varied, how many cases are solved, why others failed, and the range of the results."""
    from treadload.sweeps import open_sweep

    shell.summarise(open_sweep(store))


def table(
    store: Store,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", help="File to write: .csv, .xlsx or .parquet.", show_default=False),
    ] = None,
    fields: Annotated[bool, typer.Option("--fields", help="Fields too, a row for each place of every case.")] = False,
) -> None:
    """Write a row for each case: inputs, whether it was solved, its numbers, why it failed."""
    from treadload.files import check_suffix
    from treadload.results.exports import TABLES, check_output, write
    from treadload.sweeps import open_sweep, table_of

    path = output or store.with_suffix(".csv")
    check_suffix(path, TABLES, "a table")
    check_output(path)
    shell.written(write(table_of(open_sweep(store), fields=fields), path))


def report(
    store: Store,
    output: shell.Page = None,
    title: Annotated[str, typer.Option(help="Heading of the page.")] = "",
    units: shell.Units = None,
    quiet: shell.Quiet = False,
) -> None:
    """Write a self-contained HTML page: what was varied, curves, maps, what failed, the base case."""
    from treadload.files import HTML, check_suffix, check_writable
    from treadload.reporting import report as write_page
    from treadload.sweeps import open_sweep

    if units is not None:
        shell.choose_units(units)
    path = output or store.with_suffix(".html")
    check_suffix(path, HTML, "the report")
    check_writable(path)
    with stages(shell.err, quiet=quiet) as tell:
        tell("reading")
        study = open_sweep(store)
        tell("drawing")
        with shell.in_chosen_units():
            write_page(study, path, title=title or f"Study: {study.case.title or store.stem}")
    shell.written([path])


for _command in (summary, table, report):
    app.command()(shell.one_sentence(_command))
