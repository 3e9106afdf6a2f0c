"""A largest value on the border of what was solved: the field is solved further; what still ends there is named."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from dataclasses import field as dataclass_field

import numpy as np
import xarray as xr

from treadload.composing import Source
from treadload.damage.history import with_horizontal_stress
from treadload.damage.reading import Field, read_means
from treadload.kernels.arrays import Array
from treadload.kernels.largest import index_of_largest
from treadload.response import Response, solve_response
from treadload.response.basin import BEYOND, basin_reach, basin_tensors, coarsened, too_wide
from treadload.response.loads import GridLoad, SurfaceLoad, UniformRectangle
from treadload.response.means import Means
from treadload.response.several import Question, components_of

Evaluate = Callable[[Array, Array], Array]
"""Values (depth, y, x) at x (mx,) and y (my,), m."""

# Points along an axis from which its ends are a border, and not a line or a few places that were chosen.
_MAP = 5
# An enlargement goes so far, m, each further one twice as far; so many of them.
_FIRST, _ENLARGEMENTS = 0.3, 6
# Points beyond the map stand this far apart, m, and closer at its end, where a tread's edges may be near.
_STEP, _CLOSEST = 0.06, 0.004
# Of the map itself so many points along an axis are evaluated again.
_INSIDE = 24
# Points between the neighbours of the largest value, and how often they are taken closer.
_FINER, _ZOOMS = 9, 2
# A value beyond the map this part of its largest may be larger between the points.
_RIVAL = 0.97
LARGER = 1 + 1e-5
"""A value beyond a map is larger from this factor on: fields good enough for a search err by a tenth of it."""
# Where no crack opens in a map, one beyond counts from this part of its largest tensile strain.
_FLOOR = 1e-3


@dataclass(frozen=True, eq=False)
class Beyond:
    """What was evaluated beyond a map whose largest value lies at its end.

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
    kept = [
        np.union1d(axis[:: max(1, len(axis) // _INSIDE)], axis[[0, number, -1]])
        for axis, number in zip(axes, (row, column), strict=True)
    ]
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
    by_depth = np.nanmax(further_values, axis=(1, 2))
    if not at_end and np.nanmax(further_values) > _RIVAL * most:
        at, further_values = _closer(at, further_values, evaluate)
        by_depth = np.fmax(by_depth, np.nanmax(further_values, axis=(1, 2)))
    *_, row, column = index_of_largest(further_values)
    return Beyond(
        float(at[1][column]),
        float(at[0][row]),
        float(np.nanmax(further_values)),
        by_depth,
        enlargements,
        float(more.max()),
        at_end,
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
    """Distances from an end up to a reach, m, from close ones to even ones; none for 0."""
    if reach <= 0:
        return np.empty(0)
    graded = _CLOSEST * 2.0 ** np.arange(np.ceil(np.log2(_STEP / _CLOSEST)))
    even = np.arange(graded[-1] + _STEP, reach, _STEP)
    offsets = np.concatenate([graded, even])
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


def evaluated_further(response: Source, field: Field, means: Means | None) -> tuple[Field | None, Beyond | None]:
    """The field of an assessment at the largest value beyond its map, and what was evaluated there.

    response: whose road and loads are evaluated. means: of that response; None for points at a depth.
    Both are None where the largest value of the map lies inside it, and where the response cannot be solved again;
    the field alone where the map's own value is larger.
    """
    if not isinstance(response, Response) or response.road is None or not response.loads:
        return None, None
    more = _Further.of(response, means, field)
    x, y = (field.data[name].to_numpy() for name in ("x", "y"))
    floor = _FLOOR * max(float(np.nanmax(field.extension)), 0.0)
    beyond = beyond_the_map(field.value, x, y, more.values, basin_reach([response.road]), floor)
    if beyond is None or not beyond.value > max(LARGER * field.most, floor):
        return None, beyond
    exact = more.at(np.array([beyond.x]), np.array([beyond.y]))
    return exact, replace(beyond, value=exact.most)


@dataclass(frozen=True, eq=False)
class _Further:
    """The field of an assessment anywhere; arguments as `evaluated_further`.

    coarse: loads under which the basin beyond the map is solved on few waves, to half a per cent, from `BEYOND` their
    cells on; None where loads are discs, which cost little, or the road is homogeneous. near: exact values nearer to
    the loads, by the points at which they were evaluated.
    """

    response: Response
    means: Means | None
    field: Field
    coarse: list[SurfaceLoad] | None = None
    near: dict[bytes, Array] = dataclass_field(default_factory=dict)

    @classmethod
    def of(cls, response: Response, means: Means | None, field: Field) -> _Further:
        """Of an assessment, with coarse loads where the response is of footprints on layers."""
        needs = components_of(field.quantity.needs)
        wheels = _grids(response)
        assert response.road is not None
        if needs is None or len(wheels) < len(response.loads) or response.road.is_homogeneous:
            return cls(response, means, field)
        return cls(response, means, field, coarsened(wheels))

    def values(self, x: Array, y: Array) -> Array:
        """What is evaluated at x (mx,) and y (my,), m, (depth, y, x); NaN in the map where the loads are coarse."""
        if self.coarse is None:
            return self.at(x, y).value
        response, depths = self.response, self.field.data["depth"].to_numpy()
        assert response.road is not None
        solved = basin_tensors(
            [Question(self.coarse, response.road, depths)], x, y, needs=self.field.quantity.needs,
            speed=response.speed, side=response.side, mean_over=None if self.means is None else self.means.length,
        )  # fmt: skip
        assert solved is not None
        values = replace(self.field, data=self._restrained(solved[0])).value
        data, wheels = self.field.data, [load.grid for load in _grids(response)]
        # By axis: whether a point lies within the map, and so near to the loads that the coarse ones are not enough.
        within, close = [], []
        for axis, at in (("y", y), ("x", x)):
            ends = data[axis].to_numpy()[[0, -1]]
            cells = [getattr(grid, axis)[[0, -1]] for grid in wheels]
            low, high = min(first for first, _ in cells) - BEYOND, max(last for _, last in cells) + BEYOND
            within.append((at > ends[0]) & (at < ends[1]))
            close.append((at > low) & (at < high))
        outside = any((near & ~inside).any() for near, inside in zip(close, within, strict=True))
        if outside and all(near.any() for near in close):
            values[:, *np.ix_(*close)] = self._near(x[close[1]], y[close[0]])
        values[:, *np.ix_(*within)] = np.nan
        return values

    def _near(self, x: Array, y: Array) -> Array:
        """Exact values, evaluated once for each set of points."""
        key = x.tobytes() + y.tobytes()
        if key not in self.near:
            self.near[key] = self.at(x, y).value
        return self.near[key]

    def at(self, x: Array, y: Array) -> Field:
        """The field itself there, exact to 1e-6 of the largest."""
        depths, response = self.field.data["depth"].to_numpy(), self.response
        if self.means is not None:
            quantity, rough = self.field.quantity, not self.means.road.is_viscoelastic
            return replace(self.field, data=read_means(self.means, quantity, depths, x=x, y=y, rough=rough))
        assert response.road is not None
        data = solve_response(
            response.loads, response.road, depths=depths, x=x, y=y, speed=response.speed, side=response.side
        ).dataset
        return replace(self.field, data=self._restrained(data))

    def _restrained(self, data: xr.Dataset) -> xr.Dataset:
        """Fields with the thermal stress that was added to the response."""
        response = self.response
        if not response.restrained:
            return data
        levels = response.dataset["depth"].to_numpy()
        stress = [response.restrained[int(np.argmin(np.abs(levels - z)))] for z in data["depth"].to_numpy()]
        return with_horizontal_stress(data, np.array(stress))


def _grids(response: Response) -> list[GridLoad]:
    """Those loads of a response that stand on cells, or are one."""
    loads = [load.cell if isinstance(load, UniformRectangle) else load for load in response.loads]
    return [load for load in loads if isinstance(load, GridLoad)]


def border_in_words(response: Source, field: Field, beyond: Beyond | None) -> list[str]:
    """A sentence if the largest value of a map lies at its end, and a larger one does or may lie beyond.

    response: that of the map. field: over (depth, y, x). beyond: what was evaluated further, None for nothing.
    """
    axes = {name: field.data[name].to_numpy() for name in ("y", "x")}
    _, *numbers = field.worst
    ends = _ends(field.value, (axes["y"], axes["x"]))
    if not ends:
        return []
    names = ("y", "x")
    where = " and ".join(f"{names[axis]} = {1e3 * axes[names[axis]][numbers[axis]]:.0f} mm" for axis, _ in ends)
    wide = too_wide(response.road) if isinstance(response, Response) and response.road is not None else ""
    most = field.most
    text = f"the largest evaluated strain of the map, {1e6 * most:.3g} microstrain, lies at its end, {where}"
    if not most > 0:
        if beyond is None or not beyond.value > 0:
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
            f"{text}; {solved} ({beyond.enlargements} enlargements), and the largest, {there}, still lies at the "
            "end, so that a larger one may lie beyond" + (f": {wide}" if wide else "")
        ]
    if beyond.value > LARGER * most:
        return [f"{text}; {solved}, and the assessment is that of the largest, {there}"]
    return []


def _how_far(response: Source) -> str:
    if isinstance(response, Response) and response.road is not None and len(response.road.layers) > 1:
        return f", {basin_reach([response.road]):.2g} m for the whole basin of this road"
    return ""
