"""`treadload report`: results as a page."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from treadload.cli import shell
from treadload.cli.progress import stages


def report(
    results: Annotated[
        list[Path], typer.Argument(help="One or more result files of `treadload run` or `treadload life`.")
    ],
    output: shell.Page = None,
    title: Annotated[str, typer.Option(help="Heading of the report.")] = "",
    units: shell.Units = None,
    quiet: shell.Quiet = False,
) -> None:
    """Write a self-contained HTML report with figures; several results stand side by side."""
    from treadload.files import HTML, check_suffix
    from treadload.reporting import write_report
    from treadload.results import open_results

    if units is not None:
        shell.choose_units(units)
    path = output or results[0].with_suffix(".html")
    check_suffix(path, HTML, "the report")
    with stages(shell.err, quiet=quiet) as tell:
        tell("reading")
        trees = {}
        for file in results:
            tree = open_results(file).tree
            label = str(tree.attrs.get("title") or file.stem)
            trees[label if label not in trees else f"{label} ({file.stem})"] = tree
        tell("drawing")
        with shell.in_chosen_units():
            write_report(trees, path, title=title or " and ".join(trees))
    shell.out.print(f"written: {path}", markup=False)
