"""All commands, in the order of the help."""

from __future__ import annotations

from typing import Annotated

import typer

from treadload._version import __version__
from treadload.cli import (
    backcalculate,
    cases,
    compare,
    design,
    ending,
    exports,
    field,
    network,
    page,
    program,
    results,
    shell,
    studies,
    sweep,
    tires,
)

app = typer.Typer(
    help="What a tire does to a road: contact, rolling, strain, cracks and life.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["--help", "-h"]},
)

for _command in (
    cases.run,
    cases.life,
    design.design,
    sweep.sweep,
    network.network,
    field.field,
    cases.calibrate,
    backcalculate.backcalculate,
    cases.init,
    cases.schema,
    results.report,
    exports.export,
    exports.as_python,
    exports.cite,
    compare.compare,
    tires.scan,
    tires.card,
    tires.tir,
    program.catalogue,
    program.criteria,
    page.app,
    program.demo,
    program.validate,
):
    app.command()(shell.one_sentence(_command))
app.add_typer(studies.app, name="study")


@app.callback(invoke_without_command=True)
@shell.one_sentence
def _root(
    version: Annotated[bool, typer.Option("--version", help="Print the version and exit.")] = False,
    ascii_only: Annotated[
        bool,
        # Eager: a page of help that follows is in ASCII, too.
        typer.Option(
            "--ascii",
            help="Print ASCII characters only, as the environment variable TREADLOAD_ASCII=1 does.",
            is_eager=True,
            callback=ending.set_ascii,
        ),
    ] = False,
    units: Annotated[
        str,
        typer.Option(
            help="Units of summaries, reports and figures: si or us. Files of results stay in SI units.",
            envvar="TREADLOAD_UNITS",
        ),
    ] = "si",
) -> None:
    shell.choose_units(units)
    if version:
        shell.out.print(f"treadload {__version__}")
        raise typer.Exit(ending.DONE)
