"""`treadload scan` and `card`: what a tire is, and what it tells under load."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from treadload.cli import shell
from treadload.cli.progress import stages


def scan(
    mesh: Annotated[Path, typer.Argument(help="OBJ, PLY, STL, GLB or OFF file of a tire.")],
    output: shell.Output = None,
    units: Annotated[str | None, typer.Option(help="Unit of the file: m, cm, mm or inch.")] = None,
    nominal_diameter: Annotated[str | None, typer.Option(help='Outer diameter, e.g. "1076 mm".')] = None,
    rotation: Annotated[str, typer.Option(help="Angle of the wheel about its axle.")] = "0 deg",
    camber: Annotated[str, typer.Option(help="Lean to the right.")] = "0 deg",
    revolve: Annotated[str, typer.Option(help="Revolve the meridian, not the facets: yes, no or auto.")] = "auto",
    smooth: Annotated[str, typer.Option(help='Length to smooth noise over, e.g. "6 mm"; no or auto.')] = "no",
    outliers: Annotated[str, typer.Option(help="Points that stick out: remove, refuse or keep.")] = "remove",
    roundness: Annotated[float, typer.Option(help="Share of the radius by which it may vary.")] = 0.02,
    spacing: Annotated[str, typer.Option(help="Cell size of the height map.")] = "3 mm",
    quiet: shell.Quiet = False,
) -> None:
    """Read a tire mesh, report its quality, and write its height map."""
    from treadload.results import height_map
    from treadload.results.exports import check_output, write
    from treadload.tire import Tire
    from treadload.tire.scan.options import revolve_choice, smooth_choice
    from treadload.units import quantity

    if output is not None:
        check_output(output)
    with stages(shell.err, quiet=quiet) as tell:
        tell(f"reading {mesh}")
        tire = Tire.from_scan(
            mesh,
            units=units,
            nominal_diameter=None if nominal_diameter is None else quantity(nominal_diameter, "m"),
            rotation=quantity(rotation, "rad"),
            camber=quantity(camber, "rad"),
            revolve=revolve_choice(revolve),
            smooth=smooth_choice(smooth),
            outliers=outliers,  # type: ignore[arg-type]  # checked where it is used
            roundness=roundness,
        )
        if output is not None:
            tell("casting rays")
            files = write(height_map(tire, quantity(spacing, "m")), output)
    shell.out.print(str(tire.quality), markup=False)
    if output is not None:
        shell.written(files)


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
    from treadload.study import tire_card
    from treadload.units import quantity

    shell.check_files(output, report)
    question = Case.from_toml(case, changes=changes or ())
    if question.tire is None:
        raise InputError(f"{case} has a recorded footprint and no tire; a card needs [tire]")
    asked = [quantity(one, "N") for one in loads.split(";")]
    inflation = None if pressures is None else [quantity(one, "Pa") for one in pressures.split(";")]
    with stages(shell.err, quiet=quiet) as tell:
        made = tire_card(
            question.build_tire(),
            question.pavement.build(),
            asked,
            inflation,
            stiffness=stiffness,
            spacing=question.spacing,
            progress=tell,
        )
        files = shell.write_files(made, output, report, f"Tire card: {question.title or case.stem}", tell)
    shell.out.print(made.summary(), markup=False)
    if files:
        shell.written(files)
