"""Peaks and valleys of a passage, between the points where it is read too.

A reading ends abruptly where nothing is tensile any more, along travel and across it, and is often largest just
there. What it would be beyond, and the tension itself, vary steadily, so that both are followed up to that place.
"""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
from scipy import sparse

from treadload.damage.quantity import cut
from treadload.kernels.arrays import Array

# Beside points of this part of the largest reading of a line a larger one may lie.
_RIVAL = 0.8
# Lines in a strip of a passage, and the part of the largest reading below which they are not worth while: less than
# a hundredth of its damage.
_LINES, _FAINT = 4, 0.3
# Columns whose reading is at least this part of a row's largest, and so many beside them, are looked at between rows.
_HEARD, _BESIDE = 0.6, 4
# Points that are looked at together.
_BLOCK = 100_000
# Steps that differ by less than this part are even.
_EVEN = 1e-6


def onto_lines(rows: Array, y: Array) -> sparse.csr_array:
    """What makes values at y of those at rows: cubics through four even rows, straight lines where these are uneven.

    rows, y: m, rising; y within the rows.
    """
    at = np.clip(np.searchsorted(rows, y, side="right") - 1, 0, len(rows) - 2)
    apart = np.diff(rows)
    t = (y - rows[at]) / apart[at]
    step = np.pad(apart, 1, constant_values=np.inf)
    even = (np.abs(step[at] / apart[at] - 1) < _EVEN) & (np.abs(step[at + 2] / apart[at] - 1) < _EVEN)
    cubic = np.array(
        [
            -t * (t - 1) * (t - 2) / 6,
            (t + 1) * (t - 1) * (t - 2) / 2,
            -(t + 1) * t * (t - 2) / 2,
            (t + 1) * t * (t - 1) / 6,
        ]
    )
    straight = np.array([np.zeros(len(t)), 1 - t, t, np.zeros(len(t))])
    weights = np.where(even, cubic, straight)
    columns = np.clip(at + np.arange(-1, 3)[:, None], 0, len(rows) - 1)
    lines = np.broadcast_to(np.arange(len(y)), columns.shape)
    return sparse.coo_array((weights.ravel(), (lines.ravel(), columns.ravel())), (len(y), len(rows))).tocsr()


def over_strips(
    rows: Array,
    y: Array,
    x: Array,
    uncut: Array,
    margin: Array | None,
    *,
    centres: Array,
    turns: int,
    power: float,
) -> Array:
    """Peaks and valleys (turns, ny) of fields (..., rows, nx): peaks are those of strips, by mean damage.

    Readings end abruptly across travel too, so that those of single lines would depend on where the lines lie. Strips
    are as wide as y are apart; where readings are faint, straight lines between the rows will do, and for valleys.
    rows, y: m. power: of the law, by which damage grows with the reading. The others as of `peaks_and_valleys`.
    """
    own = peaks_and_valleys(x, uncut, margin, centres=centres, turns=turns, smooth=False)
    result = np.stack([np.interp(y, rows, one) for one in own])
    largest = own.max()
    if not largest > 0:
        return result
    at = np.clip(np.searchsorted(rows, y, side="right") - 1, 0, len(rows) - 2)
    within = (y[1] - y[0]) * ((np.arange(_LINES) + 0.5) / _LINES - 0.5)
    read = readings(uncut, margin).max(axis=0)
    for axle, inside in enumerate(_axles(x, centres)):
        peaks = own[2 * axle]
        loud = np.convolve(peaks >= _FAINT * largest, np.ones(3), "same") > 0
        asked = np.flatnonzero(loud[at] | loud[at + 1])
        if not len(asked):
            continue
        # Columns near the largest readings of these rows: fields vary little from one row to the next.
        heard = np.flatnonzero((read[:, inside] >= _HEARD * np.maximum(peaks, _FAINT * largest)[:, None]).any(axis=0))
        part = inside[max(int(heard[0]) - _BESIDE, 0) : int(heard[-1]) + _BESIDE + 1]
        few = slice(int(part[0]), int(part[-1]) + 1)
        # So many at a time that what is made of them stays in the cache.
        step = max(1, _BLOCK // (_LINES * len(part)))
        for start in range(0, len(asked), step):
            some = asked[start : start + step]
            onto = onto_lines(rows, np.clip(y[some, None] + within, rows[0], rows[-1]).ravel())
            tension = None if margin is None else _across(onto, margin[..., few])
            found = peaks_and_valleys(
                x[few],
                _across(onto, uncut[..., few]),
                tension,
                centres=centres[axle : axle + 1],
                turns=1,
                smooth=True,
            )
            lines = (found[0] / largest).reshape(len(some), _LINES)
            result[2 * axle, some] = largest * (lines**power).mean(axis=1) ** (1 / power)
    return result


def _across(onto: sparse.csr_array, field: Array) -> Array:
    """A field (..., rows, nx) at the lines of `onto`."""
    many = field.reshape(-1, *field.shape[-2:])
    result: Array = np.stack([onto @ one for one in many])
    return result.reshape(*field.shape[:-2], *result.shape[-2:])


def readings(uncut: Array, margin: Array | None) -> Array:
    """What is read at every depth, (nz, ny, nx), see `peaks_and_valleys`."""
    return (uncut if margin is None else cut(uncut, margin > 0)).reshape(-1, *uncut.shape[-2:])


def peaks_and_valleys(
    x: Array, uncut: Array, margin: Array | None = None, *, centres: Array, turns: int, smooth: bool
) -> Array:
    """Peak under each axle and valley between (turns, ny) of a passage (..., ny, nx), zeros behind the last.

    uncut, margin: see `Criterion.read_uncut`; of several depths the largest reading counts. centres: of the axles
    along x, m, rising. A peak belongs to the axle that it is nearest to; a valley is the least between two centres,
    which changes steadily as peaks wander below an axle and never hides a cycle.
    smooth: peaks lie between points too.
    """
    shape = (-1, *uncut.shape[-2:])
    uncut, margin = uncut.reshape(shape), None if margin is None else margin.reshape(shape)
    read = readings(uncut, margin).max(axis=0)
    result = np.zeros((turns, len(read)))
    axles = _axles(x, centres)
    known = np.full(read.shape, np.inf)
    for axle, inside in enumerate(axles):
        result[2 * axle] = read[:, inside].max(axis=1)
        known[:, inside] = np.minimum(known[:, inside], result[2 * axle][:, None])
    if smooth:
        tops = _between_points(uncut, margin, known)
        for axle, inside in enumerate(axles):
            if len(inside) > 1:
                result[2 * axle] = np.maximum(result[2 * axle], tops[:, inside[:-1]].max(axis=1))
    for axle in range(len(centres) - 1):
        between = (x >= centres[axle]) & (x <= centres[axle + 1])
        result[2 * axle + 1] = read[:, between].min(axis=1)
    return np.maximum(result, 0.0)


def _axles(x: Array, centres: Array) -> list[Any]:
    """Numbers of the points nearest to each axle."""
    ends = np.concatenate([[-np.inf], 0.5 * (centres[1:] + centres[:-1]), [np.inf]])
    return [np.flatnonzero((x >= low) & (x <= high)) for low, high in itertools.pairwise(ends)]


def _between_points(uncut: Array, margin: Array | None, known: Array) -> Array:
    """Largest reading of all depths (ny, nx - 1) between each of even points (nz, ny, nx) along x and the next one.

    Values follow the parabola through both with the mean curvature of either; tension, straight, ends between a point
    that has it and one that has none. Nothing where neither comes near the largest of its line, and where a parabola
    stays below what is known already, (ny, nx).
    """
    tops = np.zeros((uncut.shape[1], uncut.shape[2] - 1))
    if uncut.shape[2] < 3:
        return tops
    tensile = np.ones(uncut.shape, dtype=bool) if margin is None else margin > 0
    near = uncut >= _RIVAL * np.where(tensile, uncut, -np.inf).max(axis=(0, 2))[:, None]
    left, right = slice(None, -1), slice(1, None)
    asked = (near[..., left] | near[..., right]) & (tensile[..., left] | tensile[..., right])
    columns = np.flatnonzero(asked.any(axis=(0, 1)))
    if not len(columns):
        return tops
    # Of the stretch that holds all of them, with the points beside it.
    start, stop = max(int(columns[0]) - 1, 0), min(int(columns[-1]) + 3, uncut.shape[2])
    along = slice(start, stop)
    whole, uncut, asked, known = tops, uncut[..., along], asked[..., start : stop - 1], known[..., along]
    tops, margin = tops[:, start : stop - 1], None if margin is None else margin[..., along]
    bends = uncut[..., :-2] - 2 * uncut[..., 1:-1] + uncut[..., 2:]
    bends = 0.25 * np.concatenate(
        [2 * bends[..., :1], bends[..., 1:] + bends[..., :-1], 2 * bends[..., -1:]], axis=-1
    )
    # A parabola rises by a quarter of its bend above the straight line at most.
    most = np.maximum(uncut[..., left], uncut[..., right]) - 0.25 * np.minimum(bends, 0.0)
    z, j, i = np.nonzero(asked & (most > known[:, left]))
    first, last, bend = uncut[z, j, i], uncut[z, j, i + 1], bends[z, j, i]
    # Where tension begins and ends, in parts of the way between the two points.
    low, high = np.zeros(len(i)), np.ones(len(i))
    if margin is not None:
        before, after = margin[z, j, i], margin[z, j, i + 1]
        ends = np.divide(before, before - after, out=np.zeros(len(i)), where=before != after)
        low, high = np.where(before > 0, low, ends), np.where(after > 0, high, ends)
    slope = last - first - bend
    summit = np.divide(-0.5 * slope, bend, out=low.copy(), where=bend < 0)
    places = np.stack([low, high, np.clip(summit, low, high)])
    np.maximum.at(tops, (j, i), (first + places * (slope + places * bend)).max(axis=0))
    return whole
