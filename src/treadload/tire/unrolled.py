"""The meridian of a tread: quantiles over its turn or its length, and the grooves that it shows."""

from __future__ import annotations

import numpy as np
import scipy

from treadload.kernels.arrays import Array
from treadload.tire.quality import GrooveMeasure

TOP_BAND = 0.003  # heights this near to the highest at a place across belong to the blocks, not to the voids, m
HIGH = 0.98  # of the turn lies lower than the tops of blocks
SHALLOWEST = 0.002
NARROWEST = 0.002
WIDEST = 0.045


def median_meridian(unrolled: Array) -> Array:
    """(ny,) median over the angle of an unrolled tread (ny, nt), m; NaN where there is none."""
    return row_quantile(unrolled, 0.5)


def top_meridian(unrolled: Array) -> Array:
    """(ny,) median over the angle of the tops of the blocks, m: voids do not lower it and noise does not raise it."""
    high = row_quantile(unrolled, HIGH)[:, None]
    with np.errstate(invalid="ignore"):
        return row_quantile(np.where(unrolled > high - TOP_BAND, unrolled, np.nan), 0.5)


def row_quantile(values: Array, part: float) -> Array:
    """(ny,) quantile of each row of (ny, nt) without its NaN; one sort, as numpy's nanquantile goes row by row."""
    ordered = np.sort(values, axis=1)
    place = part * np.maximum(np.isfinite(values).sum(axis=1) - 1, 0)
    low = np.floor(place).astype(np.int64)
    row = np.arange(len(values))
    a, b = ordered[row, low], ordered[row, np.minimum(low + 1, values.shape[1] - 1)]
    share = place - low
    return np.asarray(np.where(share > 0, a + share * (b - a), a), dtype=np.float64)


def groove_depth(y: Array, meridian: Array) -> Array:
    """(ny,) depth below the ribs on both sides, m; 0 on ribs and outside the outermost ones.

    y: (ny,) even steps, m. meridian: (ny,), m; NaN counts as void.
    """
    cells = 2 * int(np.ceil(0.5 * WIDEST / (y[1] - y[0]))) + 1
    low = float(np.nanmin(meridian))
    height = np.where(np.isfinite(meridian), meridian, low)
    # A closing bridges what is narrower than its window and leaves the rounded crown as it is.
    return np.asarray(
        scipy.ndimage.grey_closing(height, size=cells, mode="constant", cval=low) - height, dtype=np.float64
    )


def find_grooves(
    y: Array, meridian: Array, crown_radius: float, shallowest: float = SHALLOWEST
) -> tuple[GrooveMeasure, ...]:
    """Circumferential grooves of a meridian, from left to right.

    y: (ny,) even steps, m. meridian: (ny,), m. crown_radius: m. shallowest: depth from which on a dip counts, m.
    Width is taken at half the depth.
    """
    depth = groove_depth(y, meridian)
    runs, count = scipy.ndimage.label(depth > shallowest)
    grooves = []
    beside = max(1, round(3e-3 / (y[1] - y[0])))
    for piece in scipy.ndimage.find_objects(runs, max_label=count):
        where = piece[0]
        first, last = where.start, where.stop - 1
        if first == 0 or last == len(y) - 1:
            continue
        deepest = float(np.quantile(depth[where], 0.75))
        half = 0.5 * deepest
        inside = first + np.flatnonzero(depth[where] > half)
        left = crossing(y, depth, inside[0] - 1, half)
        right = crossing(y, depth, inside[-1], half)
        floor = float(np.median(meridian[where][depth[where] > 0.8 * deepest]))
        if right - left > NARROWEST:
            # The ribs beside a groove may differ in height: the depth counts from their mean.
            sides = meridian[max(0, first - beside) : first], meridian[last + 1 :][:beside]
            left_rib, right_rib = (float(np.nanmax(side)) for side in sides)
            deep = meridian[where][depth[where] > 0.8 * deepest]
            # A cell of the wall itself may be among those beside it: the floor is the lowest of them.
            walls = left_rib - float(deep[:beside].min()), right_rib - float(deep[-beside:].min())
            depths = 0.5 * (left_rib + right_rib) - floor, crown_radius - floor, min(walls)
            grooves.append(GrooveMeasure(0.5 * (left + right), right - left, *depths))
    return tuple(grooves)


def crossing(y: Array, depth: Array, index: int, level: float) -> float:
    """Where the depth passes the level between one sample and the next, m."""
    a, b = float(depth[index]), float(depth[index + 1])
    part = 0.5 if a == b else (level - a) / (b - a)
    return float(y[index] + part * (y[index + 1] - y[index]))
