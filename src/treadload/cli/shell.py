"""What all commands share: where they write, options, and errors as one sentence."""

from __future__ import annotations

import dataclasses
import functools
import inspect
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn, ParamSpec, get_type_hints

import typer
from rich.console import Console
from rich.table import Column
from rich.text import Text

from treadload.cli import ending
from treadload.cli.ending import FAILED, WRONG
from treadload.cli.progress import stages
from treadload.errors import TreadloadError, WriteError

if TYPE_CHECKING:
    from treadload.describing import Described

_P = ParamSpec("_P")


class _Screen(Console):
    """A console that goes on where nobody reads any more, or the disk behind it is full: files are still written."""

    def on_broken_pipe(self) -> None:
        """Print nothing from now on."""
        ending.let_go(self.file, BrokenPipeError())

    def _check_buffer(self) -> None:
        try:
            super()._check_buffer()
        except OSError as error:
            ending.let_go(self.file, error)


# Without markup: a bracket in a text, as that of [pavement], is printed, not parsed.
out = _Screen(highlight=False, soft_wrap=True, markup=False)
err = _Screen(stderr=True, highlight=False, soft_wrap=True, markup=False)

Output = Annotated[
    Path | None,
    typer.Option("--output", "-o", help="File to write: .nc (NetCDF), .csv or .xlsx.", show_default=False),
]
Page = Annotated[Path | None, typer.Option("--output", "-o", help="File to write, .html.", show_default=False)]
Report = Annotated[Path | None, typer.Option(help="Page to write, .html.", show_default=False)]
Units = Annotated[
    str | None,
    typer.Option(
        help="Units of the numbers and figures, si or us; left out, those of `treadload --units`.", show_default=False
    ),
]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="No progress on stderr.")]
Changes = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help="Set a key of the case, as rolling.friction=0.6 or pavement.layers.0.thickness='8 cm'; without a value "
        "the key is removed. May be given several times.",
        show_default=False,
    ),
]
Kind = Annotated[str, typer.Argument(help="The command that runs the case: run, life or calibrate.")]
DryRun = Annotated[bool, typer.Option("--dry-run", help="Check the case and list what would be solved.")]


def names() -> Column:
    """A column of names that a case can copy: never broken into lines."""
    return Column("name", no_wrap=True)


class _Chosen:
    """Options of the whole program. units: of display, "si" or "us"."""

    units = "si"


def choose_units(system: str) -> None:
    """Set the units of what the command that follows shows. Raises InputError for an unknown word."""
    from treadload.us_units import check_system

    _Chosen.units = "si"
    _Chosen.units = check_system(system)


def chosen_units() -> str:
    """The units of `choose_units`, "si" or "us"."""
    return _Chosen.units


def in_chosen_units() -> AbstractContextManager[None]:
    """Where results are shown in the units of `choose_units`."""
    from treadload.us_units import display_units

    return display_units(_Chosen.units)


def summarise(result: Described) -> None:
    """Print the summary of a result, in the units of `choose_units`."""
    with in_chosen_units():
        out.print(result.summary(), markup=False)


def with_options(command: Callable[..., None]) -> Callable[..., None]:
    """A command that takes frozen groups of options: every field of such a dataclass is an option of its own.

    The order of the options in the help is that of the parameters, a group's in its place.
    """
    hints = get_type_hints(command, include_extras=True)
    groups = {name: hint for name, hint in hints.items() if inspect.isclass(hint) and dataclasses.is_dataclass(hint)}

    def options() -> Iterator[inspect.Parameter]:
        for name, parameter in inspect.signature(command).parameters.items():
            if name not in groups:
                yield parameter.replace(annotation=hints[name], kind=inspect.Parameter.KEYWORD_ONLY)
                continue
            annotations = get_type_hints(groups[name], include_extras=True)
            for field in dataclasses.fields(groups[name]):
                yield inspect.Parameter(
                    field.name, inspect.Parameter.KEYWORD_ONLY, default=field.default,
                    annotation=annotations[field.name],
                )  # fmt: skip

    @functools.wraps(command)
    def gathered(**typed: object) -> None:
        for name, group in groups.items():
            typed[name] = group(**{field.name: typed.pop(field.name) for field in dataclasses.fields(group)})
        command(**typed)

    gathered.__signature__ = inspect.Signature(list(options()))  # type: ignore[attr-defined]
    return gathered


def one_sentence(command: Callable[_P, None]) -> Callable[_P, None]:
    """Turn every expected error of a command into one sentence on stderr and an exit code."""

    @functools.wraps(command)
    def guarded(*args: _P.args, **kwargs: _P.kwargs) -> None:
        try:
            return command(*args, **kwargs)
        except TreadloadError as error:
            wrong = isinstance(error, ValueError) and not isinstance(error, WriteError)
            _fail(str(error), WRONG if wrong else FAILED)
        except KeyboardInterrupt as error:
            _fail(*ending.interrupted(str(error)))
        except MemoryError:
            _fail("out of memory: the grid is too fine for this machine; use a larger spacing", FAILED)

    return guarded


def _fail(message: str, code: int) -> NoReturn:
    err.print(Text("error: ", style="bold red") + Text(message))
    raise typer.Exit(code)


def plain(text: str) -> None:
    """Print a text for another program or a file as it is."""
    ending.say(text, sys.stdout)


def planned(plan: str, path: Path) -> None:
    """Print a plan, and the file that would be written."""
    out.print(plan, markup=False)
    out.print(f"\nwould be written: {path}", markup=False)


def check_files(output: Path | None, report: Path | None) -> None:
    """Refuse names that a result or a page cannot have, before anything is computed."""
    from treadload.files import HTML, check_suffix
    from treadload.results.exports import check_output

    if output is not None:
        check_output(output)
    if report is not None:
        check_suffix(report, HTML, "the report")


def write_files(result: object, output: Path | None, report: Path | None, title: str, *, quiet: bool) -> None:
    """Write a result to a file and a page, those that are asked for, and print what was written."""
    from treadload.results import to_tree
    from treadload.results.exports import write

    if output is not None:
        written(write(to_tree(result), output))
    if report is not None:
        from treadload.reporting import report as write_page

        with stages(err, quiet=quiet) as tell:
            tell("drawing")
            with in_chosen_units():
                page = write_page(result, report, title=title)
        written([page])


def written(files: Iterable[Path]) -> None:
    """Print the files that were written."""
    out.print("\n" + "\n".join(f"written: {file}" for file in files), markup=False)
