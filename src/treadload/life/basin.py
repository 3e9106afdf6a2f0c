"""Near and far: a passage on cells near the wheels, joined with the basin around them on few points."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
import scipy

from treadload.deferred import xarray as xr
from treadload.kernels.arrays import Array
from treadload.life.wheels import Wheels
from treadload.response.basin import BEYOND
from treadload.response.several import without_indexes

# Points of a basin stand this far apart, m, and half as far within so much of the wheels; readings between two of
# them follow splines.
STEP, _SOON = 0.072, 0.20
# Beside the cells of an axle points of the near field stand so far apart, m.
BESIDE_STEP = 0.012
_SAME = 1e-9
# Weights of values that change no digit of single precision.
_LOST = 1e-12


@dataclass(frozen=True, eq=False)
class Basin:
    """Where the basin of a class is read.

    x: (mx,), y: (my,), m, points that are solved. columns: (nx,), m, of which lines are read, with along (nx, mx)
    that makes their values of those at x. rows: (ny,), m, lines away from the wheels, with across (ny, my). near:
    (lines,), m, rows of the near field. outside: (nx,), columns that the near field leaves to the basin.
    outside_rows: (rows,), m, those of the near rows on which these are read, with onto (rows, my).
    """

    x: Array
    y: Array
    columns: Array
    along: Array
    rows: Array
    across: Array
    near: Array
    outside: Array
    outside_rows: Array
    onto: Array

    @classmethod
    def points(cls, wheels: Wheels, y: Array, reach: float) -> tuple[Array, Array]:
        """Where the basin of a class is solved, x and y, m; arguments as of `of`."""
        beside = [(load.grid.y[0], load.grid.y[-1]) for load in wheels.loads]
        x = _graded(wheels.x[0, 0] - reach, wheels.x[-1, -1] + reach, _axles(wheels))
        return x, _graded(float(y[0]), float(y[-1]), np.array(beside))

    @classmethod
    def of(cls, wheels: Wheels, y: Array, near: Array, reach: float) -> Basin:
        """Of a class that is read at y, whose near field has some rows, m. reach: m, along travel."""
        x, at_y = cls.points(wheels, y, reach)
        columns, rows = _halved(x), _halved(at_y)
        gap = np.abs(rows[:, None] - near).min(axis=1)
        rows = rows[gap > 0.25 * STEP]
        inside = np.zeros(len(columns), dtype=bool)
        for low, high in _axles(wheels):
            inside |= (columns > low - BEYOND - _SAME) & (columns < high + BEYOND + _SAME)
        outside_rows = _apart(near)
        along, across, onto = _splines(x, columns), _splines(at_y, rows), _splines(at_y, outside_rows)
        return cls(x, at_y, columns, along, rows, across, near, ~inside, outside_rows, onto)

    def lines(self, data: xr.Dataset) -> tuple[xr.Dataset, xr.Dataset]:
        """Tensors over (depth, y, x) of the basin's points: on its lines, and in the columns outside on near rows.

        Components are smooth and follow splines; what is read of them is not, where principal directions change
        places and where tension begins.
        """
        both: list[dict[str, xr.Variable]] = [{}, {}]
        for name, field in data.variables.items():
            if name not in data.coords:
                along = field.values.astype(np.float32, copy=False) @ self.along.T
                sheets = self.across @ along, self.onto @ along[..., self.outside]
                for part, sheet in zip(both, sheets, strict=True):
                    part[str(name)] = xr.Variable(field.dims, sheet, field.attrs, fastpath=True)
        depths = data.variables["depth"].values
        # Variables, not arrays with coordinates, which cost more than these products.
        return (
            xr.Dataset(both[0], without_indexes(depths, self.rows, self.columns)),
            xr.Dataset(both[1], without_indexes(depths, self.outside_rows, self.columns[self.outside])),
        )


def _axles(wheels: Wheels) -> Array:
    """First and last x (axle, 2) of the cells under each axle, m."""
    return np.stack([wheels.x[:, 0], wheels.x[:, -1]], axis=1)


def _graded(low: float, high: float, wheels: Array) -> Array:
    """Points from low to high, m, `STEP` apart at most and half as far near intervals (n, 2) of wheels."""
    count = max(int(np.ceil((high - low) / STEP - _SAME)), 3)
    even = np.linspace(low, high, 2 * count + 1)
    near = np.zeros(len(even), dtype=bool)
    for start, end in wheels:
        near |= (even > start - _SOON) & (even < end + _SOON)
    near[::2] = True
    points: Array = even[near]
    return points


def _apart(rows: Array) -> Array:
    """Those of rising rows, m, that are `BESIDE_STEP` apart where they are closer, with the first and the last."""
    chosen = [rows[0]]
    for row, following in itertools.pairwise(rows[1:]):
        if following - chosen[-1] > BESIDE_STEP + _SAME:
            chosen.append(row)
    return np.array([*chosen, rows[-1]])


def _halved(at: Array) -> Array:
    """Points and the middles between them."""
    return np.sort(np.concatenate([at, 0.5 * (at[1:] + at[:-1])]))


def _splines(at: Array, onto: Array) -> Array:
    """Weights (n, m) of values at m points in those of cubic splines through them at n places."""
    weights: Array = scipy.interpolate.make_interp_spline(at, np.eye(len(at)), k=3)(onto)
    # They fall by a factor of four a point, below the normal numbers, with which products are many times slower.
    weights[np.abs(weights) < _LOST] = 0.0
    return weights.astype(np.float32)
