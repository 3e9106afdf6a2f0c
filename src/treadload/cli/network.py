"""`treadload network`: the remaining life of the sections of a network."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from treadload.cli import ending, shell
from treadload.cli.progress import counts
from treadload.cli.sweep import Jobs, Scheduler


@dataclass(frozen=True)
class Solving:
    """Where the sections are solved and kept, as typed."""

    jobs: Jobs = 1
    scheduler: Scheduler = None
    store: Annotated[
        Path | None,
        typer.Option(
            help="Folder *.zarr that keeps what is solved; the same command goes on in it; the table's name if left "
            "out.",
            show_default=False,
        ),
    ] = None


@shell.with_options
def network(
    sections: Annotated[
        Path,
        typer.Argument(help="Sections in a CSV file or an Excel sheet: ids, station, age, and the keys that differ."),
    ],
    case: Annotated[
        Path | None,
        typer.Argument(help="The design case of all sections, a TOML file; the table's name if left out."),
    ] = None,
    *,
    ids: Annotated[
        list[str] | None,
        typer.Option(
            "--id",
            metavar="COLUMN",
            help="A column that identifies a section; id, name, section, label and station do so by themselves. May "
            "be given several times.",
            show_default=False,
        ),
    ] = None,
    output: shell.Output = None,
    report: Annotated[
        Path | None,
        typer.Option(help="Page to write, .html; the default is the name of the table.", show_default=False),
    ] = None,
    solving: Solving,
    changes: shell.Changes = None,
    dry_run: shell.DryRun = False,
    quiet: shell.Quiet = False,
) -> None:
    """Find the remaining life of every section of a network, and write a report that ranks them."""
    from treadload.case.schema import read_case
    from treadload.files import check_writable
    from treadload.sweeps import plan_sweep, read_sections, solve_network
    from treadload.sweeps.network.solve import check_case

    page = report or sections.with_suffix(".html")
    shell.check_files(output, page)
    question = read_case(case or sections.with_suffix(".toml"), changes=changes or ())
    check_case(question)
    listed = read_sections(question, sections, ids=ids or ())
    if dry_run:
        return shell.planned(plan_sweep(question, listed.design), page)
    check_writable(page)
    with counts(shell.err, quiet=quiet) as tell:
        result = solve_network(
            question, listed, store=solving.store or sections.with_suffix(".zarr"), jobs=solving.jobs,
            scheduler=solving.scheduler, progress=tell,
        )  # fmt: skip
    shell.summarise(result)
    title = f"Network: {question.title or sections.stem}"
    shell.write_files(result, output, page if result.ranked else None, title, quiet=quiet)
    if not result.ranked:
        raise typer.Exit(ending.FAILED)
