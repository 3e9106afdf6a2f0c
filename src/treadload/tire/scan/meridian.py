"""What an unrolled tread shows: meridian, crown radius, grooves, facets."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import scipy
from numpy.typing import NDArray

from treadload.kernels.arrays import Array, BoolArray
from treadload.tire.quality import GrooveMeasure
from treadload.tire.unrolled import (
    HIGH,
    SHALLOWEST,
    TOP_BAND,
    WIDEST,
    crossing,
    groove_depth,
    median_meridian,
    row_quantile,
)

MISSED = 0.2  # of the sag is between the highest ray on a facet and its corner
HOLLOW = 0.008
STEADY = 0.3e-3  # what the fit of the axle and a drawn tread may be off, m
CHANGING = 0.005
WIDEST_FACET = math.radians(61)  # an edge wider than of a hexagon goes through the tire, to a point that stands wrong
MOST_FACES = 100_000  # are looked at for their sag; twice as many and more by every second, ...
STEEPEST = 1.5  # what rises more is a wall and not the rounded end of a tread


def high_meridian(unrolled: Array, part: float) -> Array:
    """(ny,) quantile over the angle of an unrolled tread, m: low only where that part of the turn is low."""
    return row_quantile(unrolled, part)


def beside(vertices: Array, y: Array, meridian: Array) -> Array:
    """(n,) radius of a meridian at y (ny,) beside vertices (n, 3) in the frame of the wheel, m; NaN off it."""
    return np.asarray(np.interp(vertices[:, 1], y, meridian, left=np.nan, right=np.nan), dtype=np.float64)


def crown(top: Array, facet_sag: float, unrolled: Array, largest: float) -> float:
    """Outer radius of the tread, m: the least of three estimates, each too large for some meshes.

    top: (ny,) median of the tops of blocks, m. facet_sag: m. unrolled: (ny, nt) radius of the tread, m. largest:
    radius of the outermost vertex, m, which no point of a mesh exceeds. A facet is a chord, (1 - t²) of the sag
    inside the circle at t from its middle to its end, -1 to 1: its median lies 3/4 of the sag inside, its 98 %
    quantile 4 %, or up to 20 % where rays a degree apart miss its ends. The median does not rise with noise; the
    quantile holds where few facets are as long as the sag, or blocks cover part of the turn.
    """
    middle = without_spikes(top).max() + 0.75 * facet_sag
    high = without_spikes(row_quantile(unrolled, HIGH)).max() + MISSED * facet_sag
    return float(min(middle, high, largest))


def without_spikes(meridian: Array) -> Array:
    """A meridian without the places, one or two cells wide, that stand out; 0 where it is not known."""
    filled = np.where(np.isfinite(meridian), meridian, 0.0)
    return np.asarray(scipy.ndimage.median_filter(filled, size=5, mode="nearest"), dtype=np.float64)


def facet_sag(vertices: Array, faces: NDArray[np.int64], envelope: Array) -> float:
    """How far the facets of the tread cut under the circle through their corners, m.

    vertices: (n, 3), m, in the frame of the wheel. envelope: (n,) radius of the tops of ribs and lugs beside them,
    m, NaN off the tread: facets of voids and of sidewalls meet no road.
    """
    r = np.hypot(vertices[:, 0], vertices[:, 2])
    with np.errstate(invalid="ignore"):
        high = r > envelope - TOP_BAND
    sample = faces[:: max(1, len(faces) // MOST_FACES)]
    edge = sample[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    edge = edge[high[edge].all(axis=1)]
    a, b = vertices[edge[:, 0]][:, [0, 2]], vertices[edge[:, 1]][:, [0, 2]]
    outer = 0.5 * (r[edge[:, 0]] + r[edge[:, 1]])
    sag = outer - np.linalg.norm(0.5 * (a + b), axis=1)
    # Weighted by length: a tread modelled in detail may have many short edges beside its long facets.
    length = np.linalg.norm(a - b, axis=1)
    facet = length < 2 * outer * math.sin(0.5 * WIDEST_FACET)
    sag, length = sag[facet], length[facet]
    if not length.sum() > 0:
        return 0.0
    order = np.argsort(sag)
    total = np.cumsum(length[order])
    return float(sag[order][np.searchsorted(total, 0.95 * total[-1])])


def is_steady(unrolled: Array, meridian: Array, rows: BoolArray, sag: float, noise: float) -> bool:
    """True when an unrolled tread (ny, nt) does not depend on the angle, so that its meridian describes it fully.

    rows: (ny,) True on the tread. Beside walls of grooves, 99.5 % of it must lie within 0.3 mm, the facets' sag and
    four standard deviations of the noise (m) of the median: grooves across the tread, blocks and lugs do not.
    """
    over = scatter(unrolled, meridian)[rows]
    over = np.abs(over[np.isfinite(over)])
    allowed = STEADY + 1.5 * sag + (4 * noise if np.isfinite(noise) else 0.0)
    return over.size > 0 and float((over > allowed).mean()) < CHANGING


def between_walls(y: Array, top: Array, margin: float) -> Array:
    """(ny,) radius of ribs and lugs carried on by a margin, m, over the walls beside them; top as it is elsewhere."""
    cells = 2 * math.ceil(margin / float(y[1] - y[0])) + 1
    height = np.where(np.isfinite(top), top, np.nanmin(top))
    return np.where(is_level(y, top, margin, STEEPEST), height, scipy.ndimage.maximum_filter1d(height, cells))


def is_level(y: Array, top: Array, margin: float, steepest: float) -> BoolArray:
    """(ny,) True where an envelope (ny,), m, at y, m, rises less than `steepest`, walls kept off by a margin, m."""
    step = float(y[1] - y[0])
    slope = np.abs(np.gradient(top, step))
    steep = ~(slope <= steepest)
    return np.asarray(~scipy.ndimage.maximum_filter1d(steep, 2 * math.ceil(margin / step) + 1), dtype=bool)


def scatter(unrolled: Array, meridian: Array) -> Array:
    """(ny, nt) height over the median meridian, m, outside groove walls; NaN on them and where nothing is known."""
    slope = np.abs(np.gradient(meridian))
    steep = scipy.ndimage.maximum_filter1d(np.where(np.isfinite(slope), slope, np.inf), 3) > 0.5e-3
    out = unrolled - meridian[:, None]
    out[steep] = np.nan
    return np.asarray(out, dtype=np.float64)


def reach(y: Array, meridian: Array, level: float) -> tuple[float, float]:
    """Leftmost and rightmost place, m, where a meridian stands above a level, m."""
    depth = np.where(np.isfinite(meridian), meridian, 0.0)
    above = np.flatnonzero(depth > level)
    first, last = int(above[0]), int(above[-1])
    left = crossing(y, depth, first - 1, level) if first > 0 and depth[first - 1] > 0 else float(y[first])
    right = crossing(y, depth, last, level) if last < len(y) - 1 and depth[last + 1] > 0 else float(y[last])
    return left, right


def shallowest_groove(unrolled: Array, top: Array) -> float:
    """Depth, m, from which on a dip of the meridian is a groove: a third of the voids of lugs, at least 2 mm.

    unrolled: (ny, nt) radius of the tread, m. top: (ny,) envelope, m. Beside lugs the meridian follows their ends,
    and its ripple is no groove. Voids are what a tenth of the turn is lower than.
    """
    void = top - row_quantile(unrolled, 0.1)
    finite = void[np.isfinite(void)]
    return max(SHALLOWEST, float(np.median(finite)) / 3) if finite.size else SHALLOWEST


def with_floors(meridian: Array, crown_radius: float, floor: float) -> Array:
    """A meridian (ny,), m, whose unknown places amid the tread lie at a floor, m, where no groove's floor was met."""
    present = np.flatnonzero(np.isfinite(meridian))
    if not len(present) or np.nanmin(meridian) < crown_radius - SHALLOWEST:
        return meridian
    amid = np.arange(len(meridian))
    unmet = ~np.isfinite(meridian) & (amid > present[0]) & (amid < present[-1])
    return np.asarray(np.where(unmet, floor, meridian), dtype=np.float64)


def wide_voids(y: Array, top: Array) -> BoolArray:
    """(ny,) True in voids round the tire that are too wide for a groove, between ribs 8 mm higher or more.

    y: (ny,) even steps, m. top: (ny,) envelope of the tops, m. A tread is worn hollow by less than its 8 mm.
    """
    height = np.where(np.isfinite(top), top, np.nanmin(top) if np.isfinite(top).any() else 0.0)
    left, right = np.maximum.accumulate(height), np.maximum.accumulate(height[::-1])[::-1]
    low = np.minimum(left, right) - height
    runs, count = scipy.ndimage.label(low > HOLLOW)
    wide = [run[0] for run in scipy.ndimage.find_objects(runs, max_label=count) if np.ptp(y[run[0]]) > WIDEST]
    out = np.zeros(len(y), dtype=bool)
    for columns in wide:
        out[columns] = True
    return out


def land_ratio(
    y: Array, unrolled: Array, top: Array, rows: BoolArray, grooves: Sequence[GrooveMeasure] = ()
) -> float:
    """Share of an unrolled tread (ny, nt) that ribs, blocks and lugs make up; NaN where nothing is known.

    y: (ny,) even steps, m. top: (ny,) envelope of their tops, m. rows: (ny,) True on the tread; rows amid them that
    are not are voids. Land lies less than 3 mm, or half the depth of the shallowest of the grooves, below the tops
    carried on over grooves. What was not scanned at an angle with tread is as elsewhere.
    """
    band = min([TOP_BAND, *(0.5 * groove.depth for groove in grooves)])
    bridged = top + groove_depth(y, top)
    rows = rows & ~wide_voids(y, top)
    usual = median_meridian(unrolled)
    turn = unrolled[rows]
    turn = turn[:, np.isfinite(turn).mean(axis=0) > 0.5]
    turn = np.where(np.isfinite(turn), turn, usual[rows][:, None])
    finite = np.isfinite(turn) & np.isfinite(bridged[rows])[:, None]
    if not finite.any():
        return math.nan
    with np.errstate(invalid="ignore"):
        land = turn > bridged[rows][:, None] - band
    place = np.flatnonzero(rows)
    amid = len(place) / (place[-1] - place[0] + 1)
    return float(land[finite].mean() * amid)
