"""A largest value on the border of what was solved: named, since a larger one may lie beyond."""

from __future__ import annotations

from treadload.composing import Source
from treadload.damage.reading import Field
from treadload.response import Response
from treadload.response.basin import basin_reach

# Points along an axis from which its ends are a border, and not a line or a few places that were chosen.
_MAP = 5


def on_the_border(response: Source, field: Field) -> list[str]:
    """A sentence if the largest evaluated value of a map lies at its end; none if it lies inside or nothing opens.

    response: that of the map, whose road says how far its basin reaches. field: over (depth, y, x).
    """
    if not field.value[field.worst] > 0:
        return []
    _, *place = field.worst
    ends = {
        name: 1e3 * float(field.data[name][number])
        for name, number in zip(("y", "x"), place, strict=True)
        if field.data.sizes[name] >= _MAP and number in (0, field.data.sizes[name] - 1)
    }
    if not ends:
        return []
    where = " and ".join(f"{name} = {value:.0f} mm" for name, value in ends.items())
    remedy = "give solve_response x and y that reach further around the loads"
    if isinstance(response, Response) and response.road is not None and len(response.road.layers) > 1:
        remedy += f", {basin_reach([response.road]):.2g} m for the whole basin of this road"
    most = 1e6 * float(field.value[field.worst])
    return [
        f"the largest evaluated strain of the map, {most:.3g} microstrain, lies at its end, {where}, so that a "
        f"larger one may lie beyond: {remedy}; a service life evaluates the whole basin"
    ]
