"""`treadload design`: how thick a layer must be."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from treadload.cli import shell
from treadload.cli.progress import counts


@dataclass(frozen=True)
class Search:
    """What the thickness must achieve, and where it is searched for, as typed."""

    years: Annotated[
        float | None, typer.Option(min=0.0, help="That the road is to last; those of the traffic if left out.")
    ] = None
    risk: Annotated[
        str | None, typer.Option(help='Of failing, as "5%"; that of the laws if left out.', show_default=False)
    ] = None
    low: Annotated[str, typer.Option(help="Least thickness to look at.")] = "40 mm"
    high: Annotated[str, typer.Option(help="Largest thickness to look at.")] = "400 mm"
    step: Annotated[str, typer.Option(help="The thickness is rounded up to it.")] = "10 mm"


@shell.with_options
def design(
    case: Annotated[Path, typer.Argument(help="The design case, a TOML file.")],
    layer: Annotated[str, typer.Option(help="Its name, or its number from the surface, 1 the top one.")],
    search: Search,
    output: shell.Output = None,
    workers: Annotated[int | None, typer.Option(min=1, help="Threads; all cores if left out.")] = None,
    changes: shell.Changes = None,
    quiet: shell.Quiet = False,
) -> None:
    """Find the thickness of a layer for which a road lasts, rounded up, with the life on both sides of it."""
    from treadload.case import Case
    from treadload.files import check_writable
    from treadload.results import to_tree
    from treadload.results.exports import check_output, write
    from treadload.steps import design_case
    from treadload.units import quantity

    path = output or case.with_name(f"{case.stem}_design.nc")
    check_output(path)
    question = Case.from_toml(case, changes=changes or ())
    check_writable(path)
    share = None if search.risk is None else quantity(search.risk, "")
    with counts(shell.err, quiet=quiet) as tell:
        designed = design_case(
            question, int(layer) if layer.isdigit() else layer, years=search.years, risk=share,
            between=(quantity(search.low, "m"), quantity(search.high, "m")), step=quantity(search.step, "m"),
            workers=workers, progress=tell,
        )  # fmt: skip
    shell.summarise(designed)
    shell.written(write(to_tree(designed, case=question, road=designed.road.at_temperature(15.0)), path))
