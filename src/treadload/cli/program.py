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
    from treadload import catalogue as catalogues
    from treadload.errors import InputError, nearest

    kinds = {kind: getattr(catalogues, kind) for kind in ("structures", "mixes", "materials", "tires", "belts")}
    if kind and kind not in kinds:
        raise InputError(f"no catalogue of {kind!r}; {nearest(kind, kinds)}")
    if name:
        return shell.out.print(kinds[kind].about(name), markup=False)
    notes: dict[str, int] = {}
    for shelf in kinds.values() if not kind else [kinds[kind]]:
        table = Table(shell.names(), "what it is", "notes", title=shelf.use, title_justify="left")
        for item_name, words, item in shelf.rows():
            notes_of_item = [text for text in (item.source, *item.caveats) if text]
            marks = " ".join(f"[{notes.setdefault(text, len(notes) + 1)}]" for text in notes_of_item)
            table.add_row(item_name, Text(words), Text(marks))
        shell.out.print(table)
    if not kind:
        shell.out.print(_kinds())
    for text, number in notes.items():
        shell.out.print(f"[{number}] {text}", markup=False)


def criteria(
    name: Annotated[str, typer.Argument(help="One quantity or law, in full.", show_default=False)] = "",
) -> None:
    """What a criterion can read and by which laws: source, unit, what it asks for, what calibrates it."""
    import treadload.case  # noqa: F401  its rooms register what they have
    from treadload.damage import laws_listed, listed, quantities_listed

    if name:
        return shell.out.print(str(listed(name)), markup=False)
    parts = (
        ('what a criterion can read: reads = "…"', quantities_listed()),
        ('by which laws: law = "…"; numbers in brackets may be left out, or are the layer\'s own', laws_listed()),
    )
    for title, rows in parts:
        shell.out.print(Text(title, style="bold underline"))
        for row in rows:
            named, *lines = str(row).splitlines()
            shell.out.print(Text(named, style="bold"))
            for line in lines:  # no table: five columns of sentences are not read in a terminal of 80 characters
                shell.out.print(Padding.indent(Text(line.strip()), 4), soft_wrap=False)
        shell.out.print()


def _kinds() -> Table:
    """What a table of a case can be, by its kind, and which package brings it where it is not treadload."""
    import treadload.case  # its rooms register what they have
    import treadload.tire.scan.cloud_file  # noqa: F401
    from treadload.registry import ALL

    table = Table("key", "names", title="what a table of a case can be", title_justify="left")
    for registry in ALL:
        named = ", ".join(f"{name} ({package})" if package else name for name, package in registry.packages().items())
        if named:
            table.add_row(f"{registry.noun}, {registry.key} = …" if registry.key else registry.noun, Text(named))
    return table


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
