"""`treadload catalogue`, `criteria`, `demo` and `validate`: what the program brings, shows and proves."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from treadload.cli import ending, shell
from treadload.cli.progress import stages


def catalogue(
    kind: Annotated[
        str,
        typer.Argument(help="structures, mixes, materials, tires or belts; all if left out.", show_default=False),
    ] = "",
    name: Annotated[str, typer.Argument(help="One of them, in full.", show_default=False)] = "",
) -> None:
    """Structures, mixes, viscoelastic materials, tires and belts that a case can name, with sources and caveats."""
    from treadload.cli import listings
    from treadload.errors import InputError, nearest

    if kind and kind not in listings.SHELVES:
        raise InputError(f"no catalogue of {kind!r}; {nearest(kind, listings.SHELVES)}")
    if name:
        return shell.out.print(listings.about(kind, name), markup=False)
    notes: dict[str, int] = {}
    for shelf in listings.catalogue([kind] if kind else listings.SHELVES):
        table = Table(shell.names(), "what it is", "notes", title=shelf["use"], title_justify="left")
        for item_name, words, notes_of_item in shelf["rows"]:
            marks = " ".join(f"[{notes.setdefault(text, len(notes) + 1)}]" for text in notes_of_item)
            table.add_row(item_name, Text(words), Text(marks))
        shell.out.print(table)
    if not kind:
        table = Table("key", "names", title="what a table of a case can be", title_justify="left")
        for key, named in listings.tables():
            table.add_row(key, Text(named))
        shell.out.print(table)
    for text, number in notes.items():
        shell.out.print(f"[{number}] {text}", markup=False)


def criteria(
    name: Annotated[str, typer.Argument(help="One quantity or law, in full.", show_default=False)] = "",
) -> None:
    """What a criterion can read and by which laws: source, unit, what it asks for, what calibrates it."""
    from treadload.cli import listings

    if name:
        return shell.out.print(listings.criterion(name), markup=False)
    texts = listings.criteria()
    parts = (
        ('what a criterion can read: reads = "…"', texts["quantities"]),
        ('by which laws: law = "…"; numbers in brackets may be left out, or are the layer\'s own', texts["laws"]),
    )
    for title, rows in parts:
        shell.out.print(Text(title, style="bold underline"))
        for row in rows.values():
            named, *lines = row.splitlines()
            shell.out.print(Text(named, style="bold"))
            for line in lines:  # no table: five columns of sentences are not read in a terminal of 80 characters
                shell.out.print(Padding.indent(Text(line.strip()), 4), soft_wrap=False)
        shell.out.print()


def demo(
    output: Annotated[Path, typer.Option("--output", "-o", help="Folder to write.")] = Path("demo"),
    units: shell.Units = None,
    quiet: shell.Quiet = False,
) -> None:
    """A real truck tire, rolling freely and driving: results, figures and a report."""
    from treadload.demo import run_demo
    from treadload.us_units import sentence_in_display_units

    if units is not None:
        shell.choose_units(units)
    try:
        with stages(shell.err, quiet=quiet) as tell:
            result = run_demo(output, progress=tell, units=shell.chosen_units())
    except KeyboardInterrupt:
        raise KeyboardInterrupt(
            f"the files in {output} are whole; the same command makes all of them again"
        ) from None
    with shell.in_chosen_units():
        heading, *rows = result.table
        title = sentence_in_display_units("A 335/65R22.5 truck tire at 32.5 kN on asphalt, friction 0.7")
    table = Table(*heading, title=title)
    for row in rows:
        table.add_row(*row)
    shell.out.print(table)
    shell.out.print(f"{len(result.files)} files in {output.resolve()} after {result.seconds:.1f} s", markup=False)
    shell.out.print(f"open {output / 'report.html'}", markup=False)


def validate(
    markdown: Annotated[bool, typer.Option("--markdown", help="Print a table for a document.")] = False,
    quiet: shell.Quiet = False,
) -> None:
    """Compare the solvers with closed forms and published numbers, row by row."""
    from treadload.validation import format_markdown, format_table, run_checks

    with stages(shell.err, quiet=quiet) as tell:
        checks = run_checks(progress=tell)
    # The table goes out as it is: a terminal may be narrower than it.
    shell.plain(f"{format_markdown(checks) if markdown else format_table(checks)}\n")
    failed = [check for check in checks if not check.passed]
    if failed:
        shell.err.print(f"{len(failed)} of {len(checks)} checks failed", style="bold red")
        raise typer.Exit(ending.FAILED)
