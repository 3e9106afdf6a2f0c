"""A verdict freed of the places where the contact's cells happen to lie: the mean of two lattices.

A cell is in contact as a whole or not at all, so that the edge of a rib stands up to half a cell from its place, and
reading and life depend on where the lattice lies. Where it stands outwards on one of two lattices half a cell apart,
it stands inwards on the other: this error largely cancels in the mean of both loads, for two contacts. What falls
with the first power of the cells for other reasons stays.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from treadload.composing import Source
from treadload.damage import Verdict, assess
from treadload.damage.laws.fatigue import PowerLaw
from treadload.errors import InputError
from treadload.response import GridLoad, Response
from treadload.tire import Tire

SHIFTED = (0.5, 0.5)
"""The `offset` of `solve_contact` for the second lattice, in cells."""

_Place = Callable[[GridLoad], Sequence[GridLoad]]


def assess_on_two_lattices(
    response: Response,
    here: Source,
    shifted: Source,
    line: PowerLaw,
    *,
    place: _Place = lambda load: [load],
    **reading: Any,
) -> Verdict:
    """A verdict under the mean of two contacts of one wheel, whose cells lie half a cell apart.

    response: under the first contact; its road is read again. here, shifted: the contacts, the second solved with
    `offset=(0.5, 0.5)`, or their loads. place: puts a load at every wheel; one wheel if left out. reading:
    keywords of `assess`, but for depth, whose points belong to one lattice.
    Returns the verdict, whose attribute `lattices` is 2. Raises InputError, and what `assess` raises.
    """
    if reading.get("depth") is not None:
        raise InputError("points at a depth belong to the cells of one lattice; leave depth out, or take `assess`")
    loads = mean_loads([here, shifted], place)
    verdict = assess(replace(response, loads=tuple(loads)), line, **reading)
    return replace(verdict, dataset=verdict.dataset.assign_attrs(lattices=2))


def mean_loads(contacts: Sequence[Source], place: _Place) -> list[GridLoad]:
    """The mean of several contacts of one wheel, as loads of every wheel that add up."""
    several = [GridLoad.from_dataset(one) for one in contacts]
    return [part for load in several for part in place(_part(load, 1 / len(several)))]


def check_two_lattices(tire: Tire | None) -> None:
    """Raise InputError for what is known on its own cells only; None stands for a recorded footprint."""
    if tire is None or tire.fixed_grid is not None:
        what = "a recorded footprint" if tire is None else "a height map"
        raise InputError(f"{what} has one lattice of cells and is not known between them; give lattices = 1")


def _part(load: GridLoad, share: float) -> GridLoad:
    pressure, along, across = share * load.array
    return replace(load, pressure=pressure, traction_x=along, traction_y=across)
