"""Near and far: a passage on cells near the wheels, joined with the basin around them on few points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
import xarray as xr

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
    (lines,), m, rows of the near field, with onto (lines, my). outside: (nx,), columns that the near field leaves to
    the basin.
    """

    x: Array
    y: Array
    columns: Array
    along: Array
    rows: Array
    across: Array
    near: Array
    onto: Array
    outside: Array

    @classmethod
    def of(cls, wheels: Wheels, y: Array, near: Array, reach: float) -> Basin:
        """Of a class that is read at y, whose near field has some rows, m. reach: m, along travel."""
        axles = np.stack([wheels.x[:, 0], wheels.x[:, -1]], axis=1)
        beside = [(load.grid.y[0], load.grid.y[-1]) for load in wheels.loads]
        x = _graded(wheels.x[0, 0] - reach, wheels.x[-1, -1] + reach, axles)
        at_y = _graded(float(y[0]), float(y[-1]), np.array(beside))
        columns, rows = _halved(x), _halved(at_y)
        gap = np.abs(rows[:, None] - near).min(axis=1)
        rows = rows[gap > 0.25 * STEP]
        inside = np.zeros(len(columns), dtype=bool)
        for low, high in axles:
            inside |= (columns > low - BEYOND - _SAME) & (columns < high + BEYOND + _SAME)
        return cls(
            x, at_y, columns, _splines(x, columns), rows, _splines(at_y, rows), near, _splines(at_y, near), ~inside
        )

    def lines(self, data: xr.Dataset) -> tuple[xr.Dataset, xr.Dataset]:
        """Tensors over (depth, y, x) of the basin's points: on its lines, and on near rows in the columns outside.

        Components are smooth and follow splines; what is read of them is not, where principal directions change
        places and where tension begins.
        """
        return (
            _onto(data, self.across, self.along, self.rows, self.columns),
            _onto(data, self.onto, self.along[self.outside], self.near, self.columns[self.outside]),
        )


def _onto(data: xr.Dataset, across: Array, along: Array, y: Array, x: Array) -> xr.Dataset:
    """Fields (depth, y, x) on other y and x, m."""
    # Variables, not arrays with coordinates, which cost more than these products.
    fields = {
        name: (field.dims, across @ (field.values.astype(np.float32, copy=False) @ along.T), field.attrs)
        for name, field in data.variables.items()
        if name not in data.coords
    }
    return xr.Dataset(fields, without_indexes(data.variables["depth"].values, y, x))


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


def _halved(at: Array) -> Array:
    """Points and the middles between them."""
    return np.sort(np.concatenate([at, 0.5 * (at[1:] + at[:-1])]))


def _splines(at: Array, onto: Array) -> Array:
    """Weights (n, m) of values at m points in those of cubic splines through them at n places."""
    weights: Array = scipy.interpolate.make_interp_spline(at, np.eye(len(at)), k=3)(onto)
    # They fall by a factor of four a point, below the normal numbers, with which products are many times slower.
    weights[np.abs(weights) < _LOST] = 0.0
    return weights.astype(np.float32)
