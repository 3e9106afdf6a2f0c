"""`treadload compare`: a computed contact beside a measured footprint."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from treadload.cli import shell
from treadload.cli.progress import stages

if TYPE_CHECKING:
    from treadload.footprint import FootprintComparison

Tell = Callable[[str], None]
Footprint = Annotated[
    Path, typer.Argument(help="Tekscan ASCII, a table x, y, pressure, a matrix, NetCDF, or a picture.")
]
Units = Annotated[str | None, typer.Option(help="Unit of pressure where the file names none: kPa, kgf/cm2, psi.")]
Spacing = Annotated[str | None, typer.Option(help='Spacing of the cells where the file has none, "5 mm".')]
Frame = Annotated[str, typer.Option(help="Of several frames: peak, mean, or a number.")]
Travel = Annotated[str, typer.Option(help="Travel on the page of the file: right, left, up or down.")]
SeenFrom = Annotated[str, typer.Option(help="Side of the sensor that the file shows: above or below.")]
Calibration = Annotated[str | None, typer.Option(help='Pressure of one raw count, "3.2 kPa".')]
Load = Annotated[str | None, typer.Option(help='Known load that the footprint is scaled to, "35 kN".')]
Threshold = Annotated[str | None, typer.Option(help='Pressures below it are none, "10 kPa".')]
Saturation = Annotated[str | None, typer.Option(help='What a sensel reads at most, "1700 kPa".')]
Dead = Annotated[str, typer.Option(help="Sensels that read nothing amid loaded ones: leave or fill.")]
Colours = Annotated[str | None, typer.Option(help="Colour map of a picture, jet.")]
Scale = Annotated[str | None, typer.Option(help='Pressures at its ends, "0 kPa to 1000 kPa".')]
Registration = Annotated[str, typer.Option(help="How the footprint is laid: full, shift or none.")]
Tolerance = Annotated[str, typer.Option(help="Share by which the loads may differ.")]


@dataclass(frozen=True)
class Recording:
    """How the file of a footprint is read, as typed: options of `read_footprint`."""

    units: Units = None
    spacing: Spacing = None
    frame: Frame = "peak"
    travel: Travel = "right"
    seen_from: SeenFrom = "above"
    calibration: Calibration = None
    load: Load = None
    threshold: Threshold = None
    saturation: Saturation = None
    dead: Dead = "leave"
    colours: Colours = None
    scale: Scale = None

    def options(self) -> dict[str, object]:
        """Those that are given, as `read_footprint` takes them. Raises InputError for a scale that is none."""
        from treadload.errors import InputError

        options = {name: value for name, value in asdict(self).items() if value is not None}
        options["frame"] = int(self.frame) if self.frame.isdigit() else self.frame
        if self.scale is not None:
            ends = self.scale.split(" to ")
            if len(ends) != 2:
                raise InputError(f'the scale is written like "0 kPa to 1000 kPa", got {self.scale!r}')
            options["scale"] = tuple(ends)
        return options


@dataclass(frozen=True)
class Agreement:
    """How footprint and contact are compared, as typed."""

    registration: Registration = "full"
    load_tolerance: Tolerance = "25 %"


def compare_files(
    result: Path, footprint: Path, tell: Tell, recording: Recording, agreement: Agreement
) -> FootprintComparison:
    """A result file beside a footprint file."""
    from treadload.errors import InputError
    from treadload.footprint import compare, read_footprint
    from treadload.results import open_results
    from treadload.units import quantity

    tell(f"reading {footprint}")
    options: Any = recording.options()
    measured = read_footprint(footprint, **options)
    results = open_results(result)
    if "contact" not in results:
        raise InputError(f"{result} has no contact to compare with; it holds {', '.join(results) or 'no result'}")
    tell("laying the footprint onto the contact")
    how: Any = agreement.registration
    return compare(results.contact, measured, registration=how, load_tolerance=quantity(agreement.load_tolerance, ""))


@shell.with_options
def compare(
    result: Annotated[Path, typer.Argument(help="Result file of `treadload run`, with a contact.")],
    footprint: Footprint,
    *,
    output: shell.Output = None,
    report: shell.Report = None,
    recording: Recording,
    agreement: Agreement,
    quiet: shell.Quiet = False,
) -> None:
    """Compare a measured footprint with a computed contact."""
    shell.check_files(output, report)
    with stages(shell.err, quiet=quiet) as tell:
        comparison = compare_files(result, footprint, tell, recording, agreement)
    shell.summarise(comparison)
    shell.write_files(comparison, output, report, f"{result.name} and {footprint.name}", quiet=quiet)
