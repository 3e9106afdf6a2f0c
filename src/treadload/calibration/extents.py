"""Areas and extents of a footprint that change smoothly as the contact does, not by whole cells.

A fit follows slopes, and the number of cells in contact has none. Near the edge of a contact that may end where it
wants, pressure goes like the root of the distance to it. Over a cell of which a part f is covered, and over its
neighbour inside, the means of that root have the ratio

    r(f) = f^{3/2} / ((1 + f)^{3/2} - f^{3/2}),    r(1) = 0.547,

so that f follows from the ratio of two pressures. A cell beside a groove, whose wall is the edge, presses more than
that and counts as covered.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from treadload.errors import InputError
from treadload.kernels.arrays import Array

_PARTS = np.linspace(0.0, 1.0, 401)
_RATIOS = _PARTS**1.5 / ((1 + _PARTS) ** 1.5 - _PARTS**1.5)


@dataclass(frozen=True)
class Extents:
    """Of a footprint: areas of what presses and of its convex outline, m²; length and width, m."""

    net_area: float
    gross_area: float
    length: float
    width: float


def covered(pressure: Array) -> Array:
    """Part of each cell that is in contact: (ny, nx), 0 to 1. pressure: (ny, nx), Pa."""
    near = _neighbours(pressure)
    largest = near.max(0)
    ratio = np.divide(pressure, largest, out=np.ones(pressure.shape), where=largest > 0)
    at_edge = (near <= 0).any(0)
    part = np.where(at_edge, np.interp(ratio, _RATIOS, _PARTS), 1.0)
    return np.where(pressure > 0, part, 0.0)


def extents(pressure: Array, x: Array, y: Array, dx: float, dy: float) -> Extents:
    """Areas and extents. pressure: (ny, nx), Pa, on cells of dx by dy with centres at x (nx,) and y (ny,), m.

    Raises InputError where the outline has no area.
    """
    part = covered(pressure)
    rows = _ends(part, x, dx)
    columns = _ends(part.T, y, dy)
    along = np.array([[end, at] for at, ends in zip(y, rows, strict=True) for end in ends if np.isfinite(end)])
    across = np.array([[at, end] for at, ends in zip(x, columns, strict=True) for end in ends if np.isfinite(end)])
    if not len(along):
        raise InputError("nothing presses on the road, so that no area is determined; raise the load")
    # The outline runs through the ends of the rows and of the columns.
    try:
        gross = float(scipy.spatial.ConvexHull(np.concatenate([along, across])).volume)
    except scipy.spatial.QhullError as error:
        raise InputError("the outline of the contact has no area; check its spacing") from error
    return Extents(
        float(part.sum()) * dx * dy,
        gross,
        float(np.nanmax(rows) - np.nanmin(rows)),
        float(np.nanmax(columns) - np.nanmin(columns)),
    )


def _neighbours(pressure: Array) -> Array:
    """Pressure of the four cells beside each: (4, ny, nx); none outside."""
    wide = np.pad(pressure, 1)
    return np.array([wide[:-2, 1:-1], wide[2:, 1:-1], wide[1:-1, :-2], wide[1:-1, 2:]])


def _ends(part: Array, x: Array, dx: float) -> Array:
    """Where the contact begins and ends in each row: (rows, 2), m; NaN where nothing presses."""
    ends_by_row = np.full((len(part), 2), np.nan)
    for ends, row in zip(ends_by_row, part, strict=True):
        on = np.nonzero(row > 0)[0]
        if len(on):
            first, last = on[0], on[-1]
            ends[:] = x[first] + dx * (0.5 - row[first]), x[last] - dx * (0.5 - row[last])
            if first == last:
                ends[:] = x[first] + np.array([-0.5, 0.5]) * dx * row[first]
    return ends_by_row
