"""Cells of a height map: their size as a user gives it, and heights of cells without a point."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import scipy

from treadload.errors import InputError
from treadload.kernels.arrays import Array

# Of the eight neighbours of a cell without a point, so many must have one.
_ENOUGH = 5


def cell_of(spacing: float | Sequence[float] | None) -> tuple[float, float] | None:
    """(dx, dy) in m of a spacing given once or twice."""
    if spacing is None:
        return None
    try:
        values = tuple(float(value) for value in np.atleast_1d(np.asarray(spacing, dtype=np.float64)))
    except (TypeError, ValueError):
        values = ()
    if len(values) not in (1, 2) or not all(math.isfinite(v) and v > 0 for v in values):
        raise InputError(f"spacing must be a positive number of m, or (dx, dy), got {spacing!r}")
    return values[0], values[-1]


def from_neighbours(values: Array) -> Array:
    """Values (ny, nx) whose NaN are means of their neighbours where five or more of these have a value."""
    finite = np.isfinite(values)
    around = np.ones((3, 3))
    near = scipy.ndimage.convolve(finite.astype(float), around, mode="constant")
    total = scipy.ndimage.convolve(np.where(finite, values, 0.0), around, mode="constant")
    empty = ~finite & (near >= _ENOUGH)
    out = values.copy()
    out[empty] = total[empty] / near[empty]
    return out
