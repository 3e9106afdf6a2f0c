"""A verdict freed of the places where the contact's cells happen to lie: the mean of two lattices."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from treadload.contact import Rolling, solve_contact
from treadload.contact.solve import DEFAULT_SPACING, NO_OFFSET
from treadload.damage import Verdict, assess
from treadload.damage.laws.fatigue import PowerLaw
from treadload.errors import InputError
from treadload.pavement import Pavement
from treadload.response import GridLoad, solve_response
from treadload.tire import Tire

SHIFTED = (0.5, 0.5)


def assess_on_two_lattices(
    tire: Tire,
    road: Pavement,
    rolling: Rolling,
    line: PowerLaw,
    *,
    spacing: float = DEFAULT_SPACING,
    depths: Sequence[float] = (0.0,),
    speed: float | None = None,
    **reading: Any,
) -> Verdict:
    """A verdict under the mean of two contacts whose cells lie half a cell apart.

    A cell is in contact as a whole or not at all, so that the edge of a rib stands up to half a cell from its place,
    and reading and life depend on where the lattice lies. Where it stands outwards on one of two lattices half a cell
    apart, it stands inwards on the other: this error largely cancels in the mean of both loads, for two contacts and
    three readings. What falls with the first power of the cells for other reasons stays.
    spacing: of the cells, m. depths, speed: of `solve_response`. reading: keywords of `assess`.
    Returns the verdict under the mean of both loads, with the readings of either alone in its summary and its
    attributes `lattice_strain` and `shifted_strain`.
    Raises InputError for a height map, whose cells are fixed, and what contact, response and verdict raise.
    """
    if tire.fixed_grid is not None:
        raise InputError("a height map has one lattice of cells and is not known between them; take `assess` for it")
    here, shifted = (
        GridLoad.from_dataset(solve_contact(tire, road, rolling, spacing=spacing, offset=offset))
        for offset in (NO_OFFSET, SHIFTED)
    )
    x, y = here.grid.x, here.grid.y

    def judged(loads: Sequence[GridLoad]) -> Verdict:
        return assess(solve_response(loads, road, depths=depths, speed=speed, x=x, y=y), line, **reading)

    alone = [float(judged([load]).dataset["worst_strain"]) for load in (here, shifted)]
    verdict = judged([_halved(here), _halved(shifted)])
    about = {"lattice_strain": alone[0], "shifted_strain": alone[1]}
    return replace(verdict, dataset=verdict.dataset.assign_attrs(about))


def _halved(load: GridLoad) -> GridLoad:
    pressure, along, across = 0.5 * load.array
    return replace(load, pressure=pressure, traction_x=along, traction_y=across)
