"""`treadload field`: what roads show."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from treadload.cli import shell
from treadload.cli.progress import Count, counts

if TYPE_CHECKING:
    from treadload.life.field import FieldBench, FieldLook, Predictions, SectionTable


@dataclass(frozen=True)
class Mechanics:
    """Where the predicted ages are from, as typed."""

    mechanics: Annotated[
        bool, typer.Option(help="Predict the age of every section, from the tire to the damage, and judge it.")
    ] = True
    solve: Annotated[
        bool, typer.Option("--solve", help="Solve every section, though the table names a file of predicted ages.")
    ] = False
    kept: Annotated[
        Path | None,
        typer.Option(help="File that keeps solved sections; the same command goes on from it.", show_default=False),
    ] = None
    workers: Annotated[int | None, typer.Option(min=1, help="Threads; all cores if left out.")] = None


@shell.with_options
def field(
    table: Annotated[str, typer.Argument(help='Road sections: a TOML file, or "LTPP" for those of the catalogue.')],
    mechanics: Mechanics,
    output: shell.Output = None,
    report: shell.Report = None,
    look: Annotated[bool, typer.Option("--look", help="Only shares cracked so far; of few sections, too.")] = False,
    event: Annotated[str, typer.Option(help='"wheel-path", or "wheel-path or alligator".')] = "wheel-path",
    json: Annotated[bool, typer.Option("--json", help="Print the rows of the result as JSON.")] = False,
    quiet: shell.Quiet = False,
) -> None:
    """Fit the age of the first crack of road sections, and judge mechanics by it."""
    from treadload.errors import InputError, nearest
    from treadload.life import field_bench, field_look, read_field_table
    from treadload.life.field import EVENTS
    from treadload.rows import as_json

    shell.check_files(output, report)
    chosen = next((name for name in EVENTS if name == event), None)
    if chosen is None:
        raise InputError(f"no event {event!r}; {nearest(event, EVENTS)}")
    sections = read_field_table(table)
    with counts(shell.err, quiet=quiet) as tell:
        if look:
            result: FieldLook | FieldBench = field_look(sections)
        else:
            sections.check_fit()
            predicted = _predicted(sections, table, mechanics, tell) if mechanics.mechanics else None
            result = field_bench(sections, predicted, event=chosen, progress=tell)
    if json:
        shell.plain(f"{as_json(result.rows())}\n")
    else:
        shell.summarise(result)
    shell.write_files(result, output, report, f"What roads show: {sections.name}", quiet=quiet)


def _predicted(sections: SectionTable, table: str, mechanics: Mechanics, tell: Count) -> Predictions:
    """Predicted ages from the file that the table names, or solved and kept."""
    from treadload.life import predict_sections, read_predictions

    if sections.predictions is not None and not mechanics.solve:
        return read_predictions(sections.predictions)
    kept = mechanics.kept or Path(f"{Path(table).stem}_predicted.json")
    try:
        return predict_sections(sections, kept=kept, workers=mechanics.workers, progress=tell)
    except KeyboardInterrupt:
        raise KeyboardInterrupt(f"solved sections are kept in {kept}; the same command goes on from there") from None
