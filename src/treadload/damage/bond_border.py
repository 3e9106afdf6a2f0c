"""A largest utilisation of a bond on the edge of what was solved: the interface is solved further, or it is named."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from treadload.composing import Source
from treadload.damage.border import LARGER, Beyond, beyond_the_map
from treadload.damage.laws.bond import BondStrength
from treadload.kernels.arrays import Array
from treadload.kernels.largest import index_of_largest
from treadload.response import Response, solve_response
from treadload.response.basin import basin_reach

# Beyond the map a utilisation counts where the shear is this part of the map's largest: below, friction alone would
# divide what is left of the shear by what is left of the pressure.
_FELT = 1e-3


@dataclass(frozen=True)
class WorstOfBond:
    """The place of an interface where its bond is used most.

    utilisation, shear, Pa, pressure, Pa, compression positive, at x and y, m. sentence: for the user, where it lies
    at the edge of the points or beyond them; else empty.
    """

    utilisation: float
    x: float
    y: float
    shear: float
    pressure: float
    sentence: str = ""


def worst_of_bond(
    source: Source, strength: BondStrength, depth: float, x: Array, y: Array, shear: Array, pressure: Array
) -> WorstOfBond:
    """Where a bond is used most, solved further than the points where the largest lies at their edge.

    source: a response, whose road and loads are solved again; fields alone cannot be. strength: of the bond. depth:
    of the interface, m. x, y: of the points, (mx,) and (my,), m. shear, pressure: (my, mx), Pa.
    """
    used = strength.utilisation(shear, pressure)
    row, column = index_of_largest(used)
    worst = WorstOfBond(
        float(used[row, column]), float(x[column]), float(y[row]), float(shear[row, column]),
        float(pressure[row, column]),
    )  # fmt: skip
    if not worst.utilisation > 0 or not _on_edge((row, column), used.shape):
        return worst
    solvable = isinstance(source, Response) and source.road is not None and bool(source.loads)
    further = _further(source, strength, depth, x, y, shear, used) if solvable else None
    if further is None:
        sentence = "utilisation largest at the edge of the points; solve it further out"
        if isinstance(source, Response) and source.road is not None:
            sentence += f", {basin_reach([source.road]):.2g} m for the whole basin of this road"
        return replace(worst, sentence=sentence)
    beyond, at_place = further
    if not at_place.utilisation > LARGER * worst.utilisation:
        return worst
    text = (
        f"utilisation largest at the edge of the points, {worst.utilisation:.3g}; solved further, to "
        f"{beyond.reach:.2g} m beyond them, it is {at_place.utilisation:.3g} at x = {1e3 * at_place.x:.0f} mm, "
        f"y = {1e3 * at_place.y:.0f} mm"
    )
    if beyond.at_end:
        text += ", still at the end, so that a larger one may lie beyond"
    return replace(at_place, sentence=text)


def _on_edge(peak: tuple[int, int], shape: tuple[int, ...]) -> bool:
    return any(size > 2 and at in (0, size - 1) for at, size in zip(peak, shape, strict=True))


def _further(
    response: Source, strength: BondStrength, depth: float, x: Array, y: Array, shear: Array, used: Array
) -> tuple[Beyond, WorstOfBond] | None:
    """What was evaluated beyond the points, and the largest there; None for so few points that no map ends there."""
    assert isinstance(response, Response)
    assert response.road is not None
    road, least = response.road, _FELT * float(shear.max())

    def tractions(at_x: Array, at_y: Array) -> tuple[Array, Array]:
        data = solve_response(
            response.loads, road, depths=[depth], x=at_x, y=at_y, speed=response.speed, side=response.side
        ).dataset.transpose("depth", "y", "x", ...)
        along, across, normal = (data[f"stress_{name}"].to_numpy()[0] for name in ("xz", "yz", "zz"))
        return np.hypot(along, across), -normal

    def evaluate(at_x: Array, at_y: Array) -> Array:
        size, pressure = tractions(at_x, at_y)
        felt = np.where(size >= least, strength.utilisation(size, pressure), 0.0)
        return np.asarray(felt[None])

    beyond = beyond_the_map(used[None], x, y, evaluate, basin_reach([road]))
    if beyond is None:
        return None
    size, pressure = (part[0, 0] for part in tractions(np.array([beyond.x]), np.array([beyond.y])))
    utilisation = float(strength.utilisation(size, pressure))
    return beyond, WorstOfBond(utilisation, beyond.x, beyond.y, float(size), float(pressure))
