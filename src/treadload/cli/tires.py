"""`treadload scan`, `card` and `tir`: what a tire is, its properties under load, its Magic Formula."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeVar

import typer

from treadload.cli import shell
from treadload.cli.progress import stages

if TYPE_CHECKING:
    from treadload.tire.fringes import FringeScan
    from treadload.tire.keywords import ScanKeys
    from treadload.tire.scan.laser import LaserPiece

# Options of a scan that a measurement with fringes states in its own file.
_OF_MESHES = (
    "units", "nominal_diameter", "rotation", "camber", "revolve", "fill_holes", "smooth", "outliers", "roundness",
    "spacing", "known_length", "reference", "reference_length",
)  # fmt: skip


Measurement = TypeVar("Measurement", "LaserPiece", "FringeScan")


@dataclass(frozen=True)
class Reading:
    """How a scan is read, as typed."""

    units: Annotated[str | None, typer.Option(help="Unit of the file: m, cm, mm or inch.")] = None
    nominal_diameter: Annotated[str | None, typer.Option(help='Outer diameter, e.g. "1076 mm".')] = None
    known_length: Annotated[
        str | None, typer.Option(help='A known length: its measure in the file and itself, "0.8123 = 1000 mm".')
    ] = None
    rotation: Annotated[str, typer.Option(help="Angle of the wheel about its axle.")] = "0 deg"
    camber: Annotated[str, typer.Option(help="Lean to the right.")] = "0 deg"
    revolve: Annotated[str, typer.Option(help="Revolve the meridian, not the facets: yes, no or auto.")] = "auto"
    smooth: Annotated[str, typer.Option(help='Length to smooth noise over, e.g. "6 mm"; no or auto.')] = "no"
    outliers: Annotated[str, typer.Option(help="Points that stick out: remove, refuse or keep.")] = "remove"
    fill_holes: Annotated[
        str, typer.Option(help="Fill holes of the tread from the rest of the turn: yes, no or auto.")
    ] = "auto"
    roundness: Annotated[float, typer.Option(help="Share of the radius by which it may vary.")] = 0.02

    def lies(self) -> ScanKeys:
        """How the wheel lies in the file, and what is done to its tread."""
        from treadload.tire.scan.options import smooth_choice, yes_no_auto
        from treadload.units import quantity

        diameter = self.nominal_diameter
        return {
            **self.read_by(self.known_length),
            "nominal_diameter": None if diameter is None else quantity(diameter, "m"),
            "rotation": quantity(self.rotation, "rad"),
            "camber": quantity(self.camber, "rad"),
            "revolve": yes_no_auto("revolve", self.revolve),
            "fill_holes": yes_no_auto("fill_holes", self.fill_holes),
            "smooth": smooth_choice(self.smooth),
            "outliers": self.outliers,  # type: ignore[typeddict-item]  # checked where it is used
            "roundness": self.roundness,
        }

    def read_by(self, length: str | None) -> ScanKeys:
        """Unit, noise and scale, which an earlier scan of the tire shares. length: that is known, as typed."""
        from treadload.tire.scan.options import scale_choice, smooth_choice

        scale = None if length is None else scale_choice(length)
        return {"units": self.units, "smooth": smooth_choice(self.smooth), "scale": scale}


@dataclass(frozen=True)
class Worn:
    """What the tire was before, as typed."""

    reference: Annotated[
        Path | None, typer.Option(help="An earlier scan of the same tire: what was worn off.", show_default=False)
    ] = None
    reference_length: Annotated[
        str | None,
        typer.Option(
            help="The known length as the earlier scan has it; --known-length if left out.", show_default=False
        ),
    ] = None


@shell.with_options
def scan(
    context: typer.Context,
    mesh: Annotated[
        Path,
        typer.Argument(
            help="Mesh (OBJ, PLY, STL, GLB, OFF), cloud (PLY, XYZ, LAS, E57), or a TOML of fringes or of a laser."
        ),
    ],
    *,
    output: shell.Output = None,
    reading: Reading,
    spacing: Annotated[str, typer.Option(help="Cell size of the height map.")] = "3 mm",
    worn: Worn,
    figure: Annotated[
        Path | None, typer.Option(help="Picture of what was read and done: .png, .svg or .pdf.", show_default=False)
    ] = None,
    quiet: shell.Quiet = False,
) -> None:
    """Read a scan, pictures of fringes or lines of a laser, report the quality, draw it, write the height map."""
    from treadload.errors import InputError
    from treadload.files import check_writable
    from treadload.results.exports import check_output, write
    from treadload.results.scanned import scan_fields, scan_map, scan_wear
    from treadload.tire import Tire
    from treadload.units import quantity

    if output is not None:
        check_output(output)
    if worn.reference_length is not None and worn.reference is None:
        raise InputError("--reference-length is of an earlier scan: give it with --reference, or leave it out")
    if mesh.suffix.lower() == ".toml" and not (lines_of_wheel := _turned(mesh)):
        sources = {name: context.get_parameter_source(name) for name in _OF_MESHES}
        keys = [name for name, source in sources.items() if source is not None and source.name != "DEFAULT"]
        if keys:
            option = keys[0].replace("_", "-")
            page = "fringes" if lines_of_wheel is None else "laser"
            raise InputError(
                f"--{option} belongs to a scan of a tire; {mesh} has its own keys, see docs/howto/{page}.md"
            )
        evaluate = _fringes if lines_of_wheel is None else _piece
        return evaluate(mesh, output, figure, quiet=quiet)
    if figure is not None:
        check_writable(figure)
    with stages(shell.err, quiet=quiet) as tell:
        tell(f"reading {mesh}")
        tire = Tire.from_scan(mesh, **reading.lies())
        earlier = None
        if worn.reference is not None:
            tell(f"reading {worn.reference}")
            length = worn.reference_length or reading.known_length
            earlier = Tire.from_scan(worn.reference, **reading.read_by(length))
    with shell.in_chosen_units():
        shell.out.print(str(tire.quality), markup=False)
    if earlier is not None:
        with shell.in_chosen_units():
            shell.out.print(str(scan_wear(tire, earlier)), markup=False)
    with stages(shell.err, quiet=quiet) as tell:
        if figure is not None:
            from treadload.plots import save
            from treadload.plots.scan import scan as drawn

            tell("drawing")
            with shell.in_chosen_units():
                save(drawn(scan_fields(tire, earlier)), figure)
        if output is not None:
            tell("casting rays")
            files = write(scan_map(tire, earlier, spacing=quantity(spacing, "m")), output)
    if output is not None:
        shell.written(files)


def _turned(file: Path) -> bool | None:
    """Whether a wheel turned before the laser whose lines a TOML file names; None where it names none."""
    from treadload.tire.scan.laser_file import is_laser, read_laser_file

    return read_laser_file(file).turns if is_laser(file) else None


def _piece(file: Path, output: Path | None, figure: Path | None, *, quiet: bool) -> None:
    """Level the piece of tread under a laser whose lines a file names."""
    from treadload.tire.scan.laser import piece_of_lines

    def draw(result: LaserPiece, path: Path) -> Path:
        from treadload.plots import save
        from treadload.plots.contact import height_map

        with shell.in_chosen_units():
            return save(height_map(result.dataset), path)

    _measured(f"reading the lines of {file}", lambda: piece_of_lines(file), draw, output, figure, quiet=quiet)


def _fringes(file: Path, output: Path | None, figure: Path | None, *, quiet: bool) -> None:
    """Evaluate the pictures that a file names."""
    from treadload.tire.fringes import read_fringes

    def draw(result: FringeScan, path: Path) -> Path:
        from treadload.plots import fringe_scan, save

        with shell.in_chosen_units():
            return save(fringe_scan(result.pixels), path)

    _measured(f"evaluating the pictures of {file}", lambda: read_fringes(file), draw, output, figure, quiet=quiet)


def _measured(
    stage: str,
    measure: Callable[[], Measurement],
    draw: Callable[[Measurement, Path], Path],
    output: Path | None,
    figure: Path | None,
    *,
    quiet: bool,
) -> None:
    """A measurement, written and drawn where that is asked for, and printed. draw: writes its figure."""
    from treadload.files import check_writable
    from treadload.results.exports import write

    if figure is not None:
        check_writable(figure)
    with stages(shell.err, quiet=quiet) as tell:
        tell(stage)
        result = measure()
    shell.summarise(result)
    if output is not None:
        shell.written(write(result.dataset, output))
    if figure is not None:
        with stages(shell.err, quiet=quiet) as tell:
            tell("drawing")
            picture = draw(result, figure)
        shell.written([picture])


def card(
    case: Annotated[Path, typer.Argument(help="A case of `treadload run`: its tire and road are read.")],
    loads: Annotated[str, typer.Option(help='Loads of the wheel, such as "20 kN; 35 kN; 50 kN".')],
    pressures: Annotated[
        str | None, typer.Option(help='Inflation pressures, "7 bar; 8 bar"; the tire\'s own if left out.')
    ] = None,
    stiffness: Annotated[bool, typer.Option(help="Slip and lateral stiffnesses, which cost most.")] = True,
    output: shell.Output = None,
    report: shell.Report = None,
    changes: shell.Changes = None,
    quiet: shell.Quiet = False,
) -> None:
    """Deflection, footprint and stiffnesses of a freely rolling tire, over loads and inflation pressures."""
    from treadload.case import Case
    from treadload.errors import InputError
    from treadload.footprint import tire_card
    from treadload.units import quantity

    shell.check_files(output, report)
    question = Case.from_toml(case, changes=changes or ())
    if question.tire is None:
        raise InputError(f"{case} has a recorded footprint and no tire; a card needs [tire]")
    forces = [quantity(part, "N") for part in loads.split(";")]
    inflation = None if pressures is None else [quantity(part, "Pa") for part in pressures.split(";")]
    with stages(shell.err, quiet=quiet) as tell:
        result = tire_card(
            question.build_tire(),
            question.road(),
            forces,
            inflation,
            stiffness=stiffness,
            spacing=question.spacing,
            progress=tell,
        )
    shell.summarise(result)
    shell.write_files(result, output, report, f"Tire card: {question.title or case.stem}", quiet=quiet)


def tir(
    case: Annotated[
        Path, typer.Argument(help="A case of `treadload run`: its tire, road, friction and speed are read.")
    ],
    loads: Annotated[str, typer.Option(help='Three loads of the wheel or more, "20 kN; 27.5 kN; 35 kN".')],
    pressures: Annotated[
        str | None,
        typer.Option(help='Inflation pressures beside the tire\'s own, "7 bar; 9 bar"; one pressure if left out.'),
    ] = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="File to write, .tir.", show_default=False)
    ] = None,
    figure: Annotated[
        Path | None,
        typer.Option(help="Picture of the curves beside the fit: .png, .svg or .pdf.", show_default=False),
    ] = None,
    reach: Annotated[float, typer.Option(help="Factor of all slips, 0.3 to 3; 1 is κ of 0.3 and 14 degrees.")] = 1.0,
    changes: shell.Changes = None,
    quiet: shell.Quiet = False,
) -> None:
    """Fit the Magic Formula 6.1 to a tire's solved curves over slip, and write it as a .tir file."""
    from treadload.case import Case
    from treadload.errors import InputError
    from treadload.files import check_writable
    from treadload.footprint import magic_formula
    from treadload.tire.tir_writing import check_tir_name
    from treadload.units import quantity

    if output is not None:
        check_tir_name(output)
    for path in (output, figure):
        if path is not None:
            check_writable(path)
    question = Case.from_toml(case, changes=changes or ())
    if question.tire is None:
        raise InputError(f"{case} has a recorded footprint and no tire; a .tir file needs [tire]")
    forces = [quantity(part, "N") for part in loads.split(";")]
    inflation = [] if pressures is None else [quantity(part, "Pa") for part in pressures.split(";")]
    with stages(shell.err, quiet=quiet) as tell:
        result = magic_formula(
            question.build_tire(),
            question.road(),
            question.build_rolling(),
            loads=forces,
            pressures=inflation,
            reach=reach,
            spacing=question.spacing,
            progress=tell,
        )
    shell.summarise(result)
    if output is not None:
        shell.written([result.formula.to_file(output)])
    if figure is not None:
        from treadload.plots import save, tir_fit

        with stages(shell.err, quiet=quiet) as tell:
            tell("drawing")
            with shell.in_chosen_units():
                picture = save(tir_fit(result), figure)
        shell.written([picture])
