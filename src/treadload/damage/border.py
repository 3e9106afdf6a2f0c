"""The largest value beyond a map: a whole basin near the surface, else from a value on its border on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from treadload.composing import Source
from treadload.damage.field_beyond import FieldBeyond
from treadload.damage.reading import Field
from treadload.kernels.arrays import Array
from treadload.kernels.largest import index_of_largest
from treadload.response import Response
from treadload.response.basin import NEAR_SURFACE, basin_reach, too_wide
from treadload.response.means import Means

Evaluate = Callable[[Array, Array], Array]
"""Values (depth, y, x) at x (mx,) and y (my,), m."""

# Points along an axis from which its ends are a border, and not a line or a few places that were chosen.
_MAP = 5
# An enlargement goes so far, m, each further one twice as far; so many of them.
_FIRST, _ENLARGEMENTS = 0.3, 6
# Points beyond the map stand this far apart, m, and closer at its end, where a tread's edges may be near.
_STEP, _CLOSEST = 0.06, 0.004
_GRADED = _CLOSEST * 2.0 ** np.arange(np.ceil(np.log2(_STEP / _CLOSEST)))
# And further apart where that is this part of their distance.
_WIDER = 0.07
# Of the map itself so many points along an axis are evaluated again.
_INSIDE = 24
# Points between the neighbours of the largest value, and how often they are taken closer.
_FINER, _ZOOMS = 9, 2
# Under a load that stands beyond the map, and so far beside it, points are so far apart, m: half of the mean's cube.
_UNDER_LOADS, _BESIDE_LOADS = 0.005, 0.02
# From a value on the border of a map of this part of its largest on, a larger one may lie just beyond.
_RISING = 0.8
# A value beyond the map this part of its largest may be larger between the points.
_RIVAL = 0.97
LARGER = 1 + 1e-5
"""A value beyond a map is larger from this factor on: fields good enough for a search err by a tenth of it."""
# Where no crack opens in a map, one beyond counts from this part of its largest tensile strain.
_FLOOR = 1e-3


@dataclass(frozen=True, eq=False)
class Beyond:
    """What was evaluated beyond a map.

    x, y: place of the largest value beyond it, m. value: there. by_depth: (depth,), largest of each. enlargements:
    how often the field was enlarged. reach: how far beyond the ends of the map it was evaluated, m. at_end: whether
    the largest value still lies at the end.
    """

    x: float
    y: float
    value: float
    by_depth: Array
    enlargements: int
    reach: float
    at_end: bool


def beyond_the_map(
    values: Array, x: Array, y: Array, evaluate: Evaluate, limit: float, floor: float = 0.0
) -> Beyond | None:
    """Values beyond a map, evaluated until the largest lies inside; None where the map's own lies inside.

    values: (depth, y, x) on rising y (my,) and x (mx,), m. limit: how far beyond the ends of the map is evaluated at
    most, m. floor: value below which one beyond the map does not count. An enlargement goes beyond those ends at
    which the largest value lies, or all of them where nothing is above 0, 0.3 m first and twice as far each time, six
    times at most.
    """
    ends = _ends(values, (y, x))
    if not ends:
        return None
    *_, row, column = index_of_largest(values)
    axes: tuple[Array, ...] = (y, x)
    kept = _kept((y, x), (row, column))
    most, more = max(float(np.nanmax(values)), floor), np.zeros((2, 2))
    enlargements = 0
    at, further_values = axes, values
    while ends and enlargements < _ENLARGEMENTS:
        further = more.copy()
        for axis, side in ends:
            further[axis, side] = min(2 * more[axis, side] + _FIRST, limit)
        if (further == more).all():
            break
        more, enlargements = further, enlargements + 1
        at = tuple(_stretched(inside, *reach) for inside, reach in zip(kept, more, strict=True))
        further_values = evaluate(at[1], at[0])
        # Nothing beyond is as large as what lies at the map's end: that is a maximum.
        if np.nanmax(further_values) > most * LARGER:
            ends = _ends(further_values, at)
        elif np.nanmax(values) > 0:
            ends = []
    at_end = bool(ends) and bool(np.nanmax(further_values) > most)
    return _largest(at, further_values, evaluate, most, enlargements, float(more.max()), at_end)


def _largest(
    at: tuple[Array, ...],
    values: Array,
    evaluate: Evaluate,
    most: float,
    enlargements: int,
    reach: float,
    at_end: bool,
) -> Beyond:
    """What values (depth, y, x) at points beyond a map hold, evaluated closer where they come near the most of it."""
    by_depth = _by_depth(values)
    if not at_end and np.nanmax(values) > _RIVAL * most:
        at, values = _closer(at, values, evaluate)
        by_depth = np.fmax(by_depth, _by_depth(values))
    *_, row, column = index_of_largest(values)
    return Beyond(
        float(at[1][column]), float(at[0][row]), float(np.nanmax(values)), by_depth, enlargements, reach, at_end
    )


def _ends(values: Array, axes: tuple[Array, ...]) -> list[tuple[int, int]]:
    """(axis, side) of the ends at which the largest value lies; axes: y and x. Empty where it lies inside.

    All ends where no value is above 0, so that what counts lies beyond.
    """
    *_, row, column = index_of_largest(values)
    nothing = not np.nanmax(values) > 0
    return [
        (axis, side)
        for axis, (number, at) in enumerate(zip((row, column), axes, strict=True))
        for side, end in enumerate((0, len(at) - 1))
        if len(at) >= _MAP and (nothing or number == end)
    ]


def _stretched(inside: Array, before: float, after: float) -> Array:
    """Points of an axis with others up to so far before and after it, m."""
    return np.concatenate([inside[0] - _offsets(before)[::-1], inside, inside[-1] + _offsets(after)])


def _offsets(reach: float) -> Array:
    """Distances from an end up to a reach, m, from close ones to even and then to wider ones; none for 0."""
    if reach <= 0:
        return np.empty(0)
    even = np.arange(_GRADED[-1] + _STEP, _STEP / _WIDER, _STEP)
    more = max(0, int(np.ceil(np.log(reach / even[-1]) / np.log1p(_WIDER))))
    offsets = np.concatenate([_GRADED, even, even[-1] * (1 + _WIDER) ** np.arange(1, more + 1)])
    return np.append(offsets[offsets < reach - 0.5 * _CLOSEST], reach)


def _closer(axes: tuple[Array, ...], values: Array, evaluate: Evaluate) -> tuple[tuple[Array, ...], Array]:
    """Points between the neighbours of the largest value, and values there."""
    at, further_values = axes, values
    for _ in range(_ZOOMS):
        *_, row, column = index_of_largest(further_values)
        at = tuple(
            axis
            if len(axis) == 1
            else np.linspace(axis[max(number - 1, 0)], axis[min(number + 1, len(axis) - 1)], _FINER)
            for axis, number in zip(at, (row, column), strict=True)
        )
        further_values = evaluate(at[1], at[0])
    return at, further_values


def whole_basin(values: Array, x: Array, y: Array, field: FieldBeyond, reach: float) -> Beyond | None:
    """Values of the whole basin around loads, beyond a map, at once; None where the map holds all of it.

    values, x, y: of the map, as `beyond_the_map` takes them. field: anywhere. reach: how far around the loads the
    basin is followed, m. So a largest value inside the map does not hide a larger one of the basin. Points between a
    map that ends close to the loads and their basin cost most; they are evaluated where a load stands beyond the map,
    a value on its border or in the basin comes near to its largest, or nothing in it is tensile.
    """
    *_, row, column = index_of_largest(values)
    axes, kept = (y, x), _kept((y, x), (row, column))
    unmapped, most = field.unmapped(), float(np.nanmax(values))
    ends = bool(unmapped) or bool(_ends(values, axes)) or _border(values) > _RISING * most

    def places(cells: tuple[float, float] | None = None) -> tuple[Array, ...]:
        sides = enumerate(zip(kept, axes, field.loaded, cells or (0.0, 0.0), strict=True))
        under = [[load[axis] for load in unmapped] for axis in range(2)]
        return tuple(
            _around(inside, at, loaded, reach, cell, under[axis]) for axis, (inside, at, loaded, cell) in sides
        )

    # Closed forms cost least on the lattice of the loads, waves on few points.
    at = places(None if ends else field.lattice)
    more = max(max(axis[0] - points[0], points[-1] - axis[-1]) for axis, points in zip(axes, at, strict=True))
    if not more > 0:
        return None
    further = field.values(at[1], at[0], near=ends)
    if not ends and np.fmax.reduce(further, axis=None) > _RIVAL * most:
        at = places()
        further = field.values(at[1], at[0])
    if np.isnan(further).all():
        return None
    at_end = bool(_ends(further, at)) and bool(np.nanmax(further) > max(most, 0.0))
    return _largest(at, further, field.closely, most, 1, float(more), at_end)


def _kept(axes: tuple[Array, Array], largest: tuple[int, int]) -> list[Array]:
    """Of each axis of a map the points that are evaluated again: few, its ends, and the largest value's."""
    return [
        np.union1d(axis[:: max(1, len(axis) // _INSIDE)], axis[[0, number, -1]])
        for axis, number in zip(axes, largest, strict=True)
    ]


def _by_depth(values: Array) -> Array:
    largest: Array = np.fmax.reduce(values.reshape(len(values), -1), axis=1)
    return largest


def _border(values: Array) -> float:
    """The largest value (depth, y, x) on the border of a map, of those axes that have one; -inf for none."""
    sides = [values.swapaxes(0, axis)[[0, -1]] for axis in (1, 2) if values.shape[axis] >= _MAP]
    return max((float(np.nanmax(side)) for side in sides), default=-np.inf)


def _around(
    inside: Array,
    axis: Array,
    loaded: tuple[float, float],
    reach: float,
    cell: float,
    under: Sequence[tuple[float, float]],
) -> Array:
    """Points of an axis of a map with others as far as a reach around loads, m; of a few places those alone.

    cell: m, of a lattice that starts where loads start, on which all points stand then; 0 for none. under: from where
    to where loads stand under which points stand closer.
    """
    if len(axis) < _MAP:
        return inside
    low, high = loaded
    if cell:
        step = cell * max(1, round(_STEP / cell))
        return np.asarray(low + step * np.arange(-np.ceil(reach / step), np.ceil((high - low + reach) / step) + 1))
    beside = _offsets(reach)
    every = [low - beside, np.arange(low, high, _STEP), high + beside, axis[0] - _GRADED, axis[-1] + _GRADED]
    points = np.unique(np.concatenate(every))
    points = points[(points < axis[0] - 0.5 * _CLOSEST) | (points > axis[-1] + 0.5 * _CLOSEST)]
    points = points[np.diff(points, prepend=-np.inf) > 0.5 * _CLOSEST]
    # A load beside the map stands at the map's own places along one axis.
    closer = [np.arange(first - _BESIDE_LOADS, last + _BESIDE_LOADS, _UNDER_LOADS) for first, last in under]
    return np.union1d(inside, np.concatenate([points, *closer]))


def evaluated_further(response: Source, field: Field, means: Means | None) -> tuple[Field | None, Beyond | None]:
    """The field of an assessment at the largest value beyond its map, and what was evaluated there.

    response: whose road and loads are evaluated. means: of that response; None for points at a depth.
    Near the surface the whole basin is evaluated always, of a homogeneous road too: in front of a tire that rolls
    freely the strain rises with the distance at first, by a third 0.1 m beyond its cells. Deeper the field is
    enlarged where the largest value of the map lies at its end.
    Both are None where nothing beyond the map was evaluated; the field alone where the map's value is larger.
    """
    if not isinstance(response, Response) or response.road is None or not response.loads:
        return None, None
    more, reach = FieldBeyond.of(response, means, field), basin_reach([response.road])
    x, y = (field.data[name].to_numpy() for name in ("x", "y"))
    floor = _FLOOR * max(float(np.nanmax(field.extension)), 0.0)
    if more.coarse is not None and float(field.data["depth"].min()) <= NEAR_SURFACE:
        beyond = whole_basin(field.value, x, y, more, reach)
    else:
        beyond = beyond_the_map(field.value, x, y, more.values, reach, floor)
    # Coarse values may err by half a per cent, either way.
    if beyond is None or not beyond.value > max(_RIVAL * field.most, floor):
        return None, beyond
    exact = more.at(np.array([beyond.x]), np.array([beyond.y]))
    by_depth = np.fmin(beyond.by_depth, exact.most)
    by_depth[int(np.nanargmax(beyond.by_depth))] = exact.most
    beyond = replace(beyond, value=exact.most, by_depth=by_depth)
    return (exact if exact.most > max(LARGER * field.most, floor) else None), beyond


def border_in_words(response: Source, field: Field, beyond: Beyond | None) -> list[str]:
    """A sentence if a value beyond a map is or may be larger than the largest of the map.

    response: that of the map. field: over (depth, y, x). beyond: what was evaluated further, None for nothing.
    """
    axes = {name: field.data[name].to_numpy() for name in ("y", "x")}
    _, *numbers = field.worst
    ends = _ends(field.value, (axes["y"], axes["x"]))
    larger = beyond is not None and beyond.value > LARGER * max(field.most, 0.0)
    if not (ends or larger):
        return []
    names = ("y", "x")
    where = " and ".join(f"{names[axis]} = {1e3 * axes[names[axis]][numbers[axis]]:.0f} mm" for axis, _ in ends)
    wide = too_wide(response.road) if isinstance(response, Response) and response.road is not None else ""
    text = f"the largest evaluated strain of the map, {1e6 * field.most:.3g} microstrain, "
    text += f"lies at its end, {where}" if ends else "is smaller than one beyond it"
    if not field.most > 0:
        if not larger:
            return [wide] if wide else []
        text = "no crack opens in the map"
    if beyond is None:
        return [
            f"{text}, so that a larger one may lie beyond: this response cannot be solved again, solve it with x and "
            f"y that reach further around the loads{_how_far(response)}; a service life evaluates the whole basin"
        ]
    solved = f"the field was solved further, to {beyond.reach:.2g} m beyond the map"
    there = f"{1e6 * beyond.value:.3g} microstrain at x = {1e3 * beyond.x:.0f} mm, y = {1e3 * beyond.y:.0f} mm"
    if beyond.at_end:
        return [
            f"{text}; {solved}, and the largest, {there}, still lies at the end, so that a larger one may lie beyond"
            + (f": {wide}" if wide else "")
        ]
    return [f"{text}; {solved}, and the assessment is that of the largest, {there}"] if larger else []


def _how_far(response: Source) -> str:
    if isinstance(response, Response) and response.road is not None and len(response.road.layers) > 1:
        return f", {basin_reach([response.road]):.2g} m for the whole basin of this road"
    return ""
