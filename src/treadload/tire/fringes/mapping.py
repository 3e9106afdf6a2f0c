"""Points of pixels on the cells of a height map."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy

from treadload.errors import GeometryError, InputError
from treadload.grid import Grid
from treadload.kernels.arrays import Array, BoolArray
from treadload.tire.cells import from_neighbours

# Cells of a map at most.
_MOST = 25_000_000
# Directions of travel in the frame of the points: (x ahead, y to the right) as rows of a turn about the height.
TRAVEL = {
    "right": ((1, 0), (0, 1)),
    "left": ((-1, 0), (0, -1)),
    "up": ((0, 1), (-1, 0)),
    "down": ((0, -1), (1, 0)),
}


@dataclass(frozen=True, eq=False)
class CellMeans:
    """Mean height and its deviation by noise (ny, nx), m, NaN where not known; how many cells were filled."""

    grid: Grid
    height: Array
    deviation: Array
    filled: int


def as_travelled(x: Array, y: Array, travel: str) -> tuple[Array, Array]:
    """Places ahead and to the right of travel. travel: where the wheel goes in the frame. Raises InputError."""
    if travel not in TRAVEL:
        raise InputError(f"travel must be one of {', '.join(TRAVEL)}, got {travel!r}")
    (a, b), (c, d) = TRAVEL[travel]
    return a * x + b * y, c * x + d * y


def usual_spacing(x: Array, y: Array) -> float:
    """Median distance between neighbours along both axes of the picture, m."""
    steps = [np.hypot(np.diff(x, axis=axis), np.diff(y, axis=axis)) for axis in (0, 1)]
    joined = np.concatenate([step[np.isfinite(step)] for step in steps])
    return float(np.median(joined)) if joined.size else math.nan


def not_steep(height: Array, pixel: float, steepest: float) -> BoolArray:
    """Pixels whose eight neighbours differ by less than a wall so steep, rad, would make them; (rows, columns).

    A pixel that sees both sides of a wall sees neither's height.
    """
    finite = np.isfinite(height)
    high = scipy.ndimage.maximum_filter(np.where(finite, height, -np.inf), 3)
    low = scipy.ndimage.minimum_filter(np.where(finite, height, np.inf), 3)
    within: BoolArray = high - low <= 2 * math.tan(steepest) * pixel
    return within & finite


def onto_cells(x: Array, y: Array, height: Array, deviation: Array, spacing: float) -> CellMeans:
    """Means of points over square cells. x, y, height, deviation: (n,), m. spacing: m. Raises InputError."""
    if not len(x):
        raise GeometryError(
            "no pixel has a height: look at the masks; the pictures may be dark, saturated or unsharp"
        )
    left, first = float(x.min()), float(y.min())
    nx, ny = (round((float(at.max()) - low) / spacing) + 1 for at, low in ((x, left), (y, first)))
    if nx * ny > _MOST:
        raise InputError(f"cells of {spacing:g} m make a map of {nx} x {ny}, more than {_MOST}; use larger cells")
    cell = np.rint((y - first) / spacing).astype(np.int64) * nx + np.rint((x - left) / spacing).astype(np.int64)
    count = np.bincount(cell, minlength=nx * ny)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean: Array = (np.bincount(cell, height, nx * ny) / count).reshape(ny, nx)
        spread: Array = (np.sqrt(np.bincount(cell, deviation**2, nx * ny)) / count).reshape(ny, nx)
    without_point = int(np.isnan(mean).sum())
    mean, spread = from_neighbours(mean), from_neighbours(spread)
    filled = without_point - int(np.isnan(mean).sum())
    grid = Grid(nx, ny, spacing, spacing, -0.5 * (nx - 1) * spacing, -0.5 * (ny - 1) * spacing)
    return CellMeans(grid, mean, spread, filled)
