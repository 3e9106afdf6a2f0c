"""The field of an assessment anywhere on a road: exactly near the loads and on its map, coarsely in the basin."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from dataclasses import field as dataclass_field

import numpy as np

from treadload.damage.history import with_horizontal_stress
from treadload.damage.quantity import STRESS
from treadload.damage.reading import Field, read_means
from treadload.deferred import xarray as xr
from treadload.kernels.arrays import Array
from treadload.response import Response, solve_response
from treadload.response.basin import BEYOND, basin_tensors, coarsened
from treadload.response.loads import GridLoad, SurfaceLoad, UniformDisc, UniformRectangle
from treadload.response.means import Means
from treadload.response.several import Question, components_of

# Of places, m.
_ROUND_OFF = 1e-9


@dataclass(frozen=True, eq=False)
class FieldBeyond:
    """The field of an assessment anywhere on its road.

    response: with its road and loads. means: of that response; None for points at a depth. field: of its map.
    coarse: loads under which what lies `BEYOND` their cells is solved on few points and waves, to half a per cent;
    None where the quantity is no component of stress or strain.
    exact_values: nearer to the loads, by the points at which they were evaluated.
    """

    response: Response
    means: Means | None
    field: Field
    coarse: list[SurfaceLoad] | None = None
    exact_values: dict[bytes, Array] = dataclass_field(default_factory=dict)

    @classmethod
    def of(cls, response: Response, means: Means | None, field: Field) -> FieldBeyond:
        """Of an assessment, with coarse loads where components of stress and strain serve."""
        wheels = [load for load in _placed(response) if isinstance(load, GridLoad)]
        discs = [load for load in _placed(response) if isinstance(load, UniformDisc)]
        if components_of(field.quantity.needs) is None:
            return cls(response, means, field)
        return cls(response, means, field, [*coarsened(wheels), *discs])

    @property
    def lattice(self) -> tuple[float, float] | None:
        """Cells of the coarse loads along y and x, m, where the road is one material; None elsewhere."""
        assert self.response.road is not None
        grids = [load.grid for load in self.coarse or () if isinstance(load, GridLoad)]
        return (grids[0].dy, grids[0].dx) if grids and self.response.road.is_homogeneous else None

    @property
    def loaded(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """From where to where loads stand along y and along x, m."""
        along_y, along_x = zip(*(_extent(load) for load in _placed(self.response)), strict=True)
        return _hull(along_y), _hull(along_x)

    def unmapped(self) -> list[tuple[tuple[float, float], tuple[float, float]]]:
        """From where to where, along y and along x, m, each load stands whose loaded cells reach beyond the map."""
        ends = [self.field.data[name].to_numpy()[[0, -1]] for name in ("y", "x")]
        return [
            reach
            for reach in map(_footprint, _placed(self.response))
            if any(
                low < first - _ROUND_OFF or high > last + _ROUND_OFF
                for (low, high), (first, last) in zip(reach, ends, strict=True)
            )
        ]

    def values(self, x: Array, y: Array, *, near: bool = True) -> Array:
        """What is evaluated at x (mx,) and y (my,), m, (depth, y, x); NaN in the map where the loads are coarse.

        near: False leaves out points nearer to the loads than `BEYOND` as well, which cost most.
        """
        if self.coarse is None:
            return self.at(x, y).value
        response, depths = self.response, self.field.data["depth"].to_numpy()
        assert response.road is not None
        # The thermal stress that was added to a response is added to its stress here.
        needs = {*self.field.quantity.needs, *(STRESS if response.restrained else ())}
        solved = basin_tensors(
            [Question(self.coarse, response.road, depths)], x, y, needs=needs,
            speed=response.speed, side=response.side, mean_over=None if self.means is None else self.means.length,
        )  # fmt: skip
        assert solved is not None
        values = replace(self.field, data=self._restrained(solved[0])).value
        # By axis: whether a point lies within the map, and so near to the loads that the coarse ones are not enough.
        within, close = [], []
        for axis, at, (first, last) in zip(("y", "x"), (y, x), self.loaded, strict=True):
            ends = self.field.data[axis].to_numpy()[[0, -1]]
            within.append((at > ends[0]) & (at < ends[1]))
            close.append((at > first - BEYOND) & (at < last + BEYOND))
        rows, columns = (within_reach & ~inside for within_reach, inside in zip(close, within, strict=True))
        if not near:
            values[:, close[0][:, None] & close[1]] = np.nan
        elif close[0].any() and close[1].any():
            # Above and below the map, then beside it.
            for at_y, at_x in ((rows, close[1]), (close[0] & within[0], columns)):
                if at_y.any() and at_x.any():
                    values[:, at_y[:, None] & at_x] = self._near(x[at_x], y[at_y]).reshape(len(depths), -1)
        values[:, within[0][:, None] & within[1]] = np.nan
        return values

    def closely(self, x: Array, y: Array) -> Array:
        """The same at few points; exact where all loads are discs, which cost little there."""
        discs = all(isinstance(load, UniformDisc) for load in _placed(self.response))
        return self.at(x, y).value if discs else self.values(x, y)

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

    def _near(self, x: Array, y: Array) -> Array:
        """Exact values, evaluated once for each set of points."""
        key = x.tobytes() + y.tobytes()
        if key not in self.exact_values:
            self.exact_values[key] = self.at(x, y).value
        return self.exact_values[key]

    def _restrained(self, data: xr.Dataset) -> xr.Dataset:
        """Fields with the thermal stress that was added to the response."""
        response = self.response
        if not response.restrained:
            return data
        levels = response.dataset["depth"].to_numpy()
        stress = [response.restrained[int(np.argmin(np.abs(levels - z)))] for z in data["depth"].to_numpy()]
        return with_horizontal_stress(data, np.array(stress))


def _placed(response: Response) -> list[SurfaceLoad]:
    """The loads of a response, rectangles as cells."""
    return [load.cell if isinstance(load, UniformRectangle) else load for load in response.loads]


def _extent(load: SurfaceLoad) -> tuple[tuple[float, float], tuple[float, float]]:
    """From where to where a load stands along y and along x, m, with the cells of its grid that carry nothing."""
    if isinstance(load, UniformDisc):
        return (load.y - load.radius, load.y + load.radius), (load.x - load.radius, load.x + load.radius)
    y, x = load.grid.y, load.grid.x
    return (float(y[0]), float(y[-1])), (float(x[0]), float(x[-1]))


def _footprint(load: SurfaceLoad) -> tuple[tuple[float, float], tuple[float, float]]:
    """The same of the cells that carry something; those of the grid where none does."""
    if isinstance(load, UniformDisc):
        return _extent(load)
    loaded = (load.array != 0).any(axis=0)
    rows, columns = np.flatnonzero(loaded.any(axis=1)), np.flatnonzero(loaded.any(axis=0))
    if not len(rows):
        return _extent(load)
    y, x = load.grid.y[rows[[0, -1]]], load.grid.x[columns[[0, -1]]]
    return (float(y[0]), float(y[1])), (float(x[0]), float(x[1]))


def _hull(ends: Sequence[tuple[float, float]]) -> tuple[float, float]:
    return min(first for first, _ in ends), max(last for _, last in ends)
