"""Peaks and valleys of a passage, between the points where it is read too.

A reading ends abruptly where nothing is tensile any more, along travel and across it, and is often largest just
there. What it would be beyond, and the tension itself, vary steadily, so that both are followed up to that place.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy

from treadload.damage.quantity import cut
from treadload.kernels.arrays import Array, BoolArray, IntArray

# Beside points of this part of the largest reading of a line a larger one may lie.
_RIVAL = 0.8
# Lines in a strip of a passage, and the part of the largest reading below which they are not worth while: less than
# a hundredth of its damage.
_LINES, _FAINT = 4, 0.3
# Lines in a strip where readings end abruptly, if tension may be left in a few millimetres across travel, as lines
# that differ by this part of the largest reading show: years within 0.1 % of 256 lines.
_MANY_LINES, _ABRUPT = 64, 0.02
# Columns whose reading is at least this part of a row's largest, and so many beside them, are looked at between rows.
_NEAR_LARGEST, _BESIDE = 0.6, 4
# Points that are looked at together.
_BLOCK = 100_000
# Steps that differ by less than this part are even.
_EVEN = 1e-6


@dataclass(frozen=True, eq=False)
class Strips:
    """Strips across travel, each of several lines, and what makes values on a line of those on rows.

    rows: (ny,), y: (strips,), m, rising; y evenly spaced, in the middle of their strips, which are as wide as they
    are apart. at: the row before each y. columns, weights: (strips, lines, 4), see `onto_lines`. narrow: the same of
    more lines, for strips in which readings end abruptly; None where a few are enough everywhere.
    """

    rows: Array
    y: Array
    at: Any
    columns: Any
    weights: Array
    narrow: Strips | None = None

    @classmethod
    def of(cls, rows: Array, y: Array, *, narrow: bool = False) -> Strips:
        """Of rows and y, m; those at the borders end there. narrow: where tension is left in a few millimetres."""
        strips = cls._of_lines(rows, y, _LINES)
        return replace(strips, narrow=cls._of_lines(rows, y, _MANY_LINES)) if narrow else strips

    @classmethod
    def _of_lines(cls, rows: Array, y: Array, count: int) -> Strips:
        within = (y[1] - y[0]) * ((np.arange(count) + 0.5) / count - 0.5)
        lines = np.clip(y[:, None] + within, rows[0], rows[-1])
        columns, weights = onto_lines(rows, lines.ravel())
        shape = (*lines.shape, 4)
        return cls(rows, y, _before(rows, y), columns.reshape(shape), weights.reshape(shape))

    def onto(self, strips: IntArray) -> scipy.sparse.csr_array:
        """What makes values on the lines of some strips, one after the other, of those on the rows; in single
        precision, which readings do not need more than.
        """
        columns, weights = self.columns[strips].ravel(), self.weights[strips].ravel().astype(np.float32)
        return scipy.sparse.csr_array(
            (weights, columns, np.arange(0, columns.size + 1, 4)), shape=(columns.size // 4, len(self.rows))
        )


def _before(rows: Array, y: Array) -> IntArray:
    """The last row before each y, of those with one behind it."""
    return np.clip(np.searchsorted(rows, y, side="right") - 1, 0, len(rows) - 2)


def onto_lines(rows: Array, y: Array) -> tuple[IntArray, Array]:
    """Four rows (ny, 4), by number, and their weights in the value at y.

    Cubics through four even rows, straight lines where these are uneven.
    """
    at = _before(rows, y)
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
    columns = np.clip(at + np.arange(-1, 3)[:, None], 0, len(rows) - 1)
    return columns.T, np.where(even, cubic, straight).T


def over_strips(
    strips: Strips,
    x: Array,
    uncut: Array,
    margin: Array | None,
    *,
    centres: Array,
    turns: int,
    power: float,
) -> Array:
    """Peaks and valleys (turns, ny) of fields (..., rows, nx): peaks are those of strips, by mean damage.

    Readings end abruptly across travel too, so that those of single lines would depend on where the lines lie. Where
    readings are faint, straight lines between the rows will do, and for valleys. power: of the law, by which damage
    grows with the reading. The others as of `peaks_and_valleys`.
    """
    rows, y, at = strips.rows, strips.y, strips.at
    read = readings(uncut, margin).max(axis=0)
    envelope = np.maximum(_on_points(x, read, centres, turns), 0.0)
    result = np.stack([np.interp(y, rows, line) for line in envelope])
    largest = envelope.max()
    if not largest > 0:
        return result
    for axle, inside in enumerate(_axles(x, centres)):
        peaks = envelope[2 * axle]
        strong = np.convolve(peaks >= _FAINT * largest, np.ones(3), "same") > 0
        wanted = np.flatnonzero(strong[at] | strong[at + 1])
        if not len(wanted):
            continue
        # Columns near the largest readings of these rows: fields vary little from one row to the next.
        audible = np.flatnonzero(
            (read[:, inside] >= _NEAR_LARGEST * np.maximum(peaks, _FAINT * largest)[:, None]).any(axis=0)
        )
        low, high = inside.start + int(audible[0]) - _BESIDE, inside.start + int(audible[-1]) + _BESIDE + 1
        window = slice(max(low, inside.start), min(high, inside.stop))
        inner, tense = (
            uncut[..., window].astype(np.float32),
            None if margin is None else margin[..., window].astype(np.float32),
        )
        field = x[window], inner, tense, centres[axle : axle + 1]
        lines = _on_lines(strips, wanted, *field) / largest
        result[2 * axle, wanted] = largest * (lines**power).mean(axis=1) ** (1 / power)
        if strips.narrow is not None:
            abrupt = wanted[_is_abrupt(lines)]
            lines = _on_lines(strips.narrow, abrupt, *field) / largest
            result[2 * axle, abrupt] = largest * (lines**power).mean(axis=1) ** (1 / power)
    return result


def _is_abrupt(lines: Array) -> BoolArray:
    """In which strips readings (strips, lines), parts of the largest, end abruptly, or on their borders."""
    steps = np.abs(np.diff(lines.ravel(), append=lines[-1, -1])).reshape(lines.shape) > _ABRUPT
    before = np.concatenate([[False], steps[:-1, -1]])
    return np.asarray(steps.any(axis=1) | before)


def _on_lines(
    strips: Strips, wanted: IntArray, x: Array, uncut: Array, margin: Array | None, centres: Array
) -> Array:
    """Largest readings (wanted, lines) on the lines of some strips; the others as of `peaks_and_valleys`."""
    count = strips.columns.shape[1]
    result = np.empty((len(wanted), count))
    # So many at a time that what is made of them stays in the cache.
    step = max(1, _BLOCK // (count * len(x)))
    for start in range(0, len(wanted), step):
        onto = strips.onto(wanted[start : start + step])
        fields = _across(onto, uncut), None if margin is None else _across(onto, margin)
        extremes = peaks_and_valleys(x, *fields, centres=centres, turns=1, smooth=True)
        result[start : start + step] = extremes[0].reshape(-1, count)
    return result


def _across(onto: scipy.sparse.csr_array, field: Array) -> Array:
    """A field (..., rows, nx) at the lines of `onto`."""
    many = field.reshape(-1, *field.shape[-2:])
    result: Array = np.stack([onto @ sheet for sheet in many])
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
    result = _on_points(x, readings(uncut, margin).max(axis=0), centres, turns)
    for axle, inside in enumerate(_axles(x, centres) if smooth else []):
        if inside.stop - inside.start > 1:
            within = uncut[..., inside], None if margin is None else margin[..., inside]
            result[2 * axle] = _between_points(*within, result[2 * axle])
    return np.maximum(result, 0.0)


def _on_points(x: Array, read: Array, centres: Array, turns: int) -> Array:
    """Peaks and valleys (turns, ny) of readings (ny, nx) where they stand, see `peaks_and_valleys`."""
    result = np.zeros((turns, len(read)))
    for axle, inside in enumerate(_axles(x, centres)):
        result[2 * axle] = read[:, inside].max(axis=1)
    for axle in range(len(centres) - 1):
        between = (x >= centres[axle]) & (x <= centres[axle + 1])
        result[2 * axle + 1] = read[:, between].min(axis=1)
    return result


def _axles(x: Array, centres: Array) -> list[slice]:
    """The points nearest to each axle."""
    ends = np.concatenate([[-np.inf], 0.5 * (centres[1:] + centres[:-1]), [np.inf]])
    return [
        slice(int(np.searchsorted(x, low)), int(np.searchsorted(x, high, side="right")))
        for low, high in itertools.pairwise(ends)
    ]


def _between_points(uncut: Array, margin: Array | None, largest: Array) -> Array:
    """Largest reading (ny,) of fields (nz, ny, nx) on even points along x and between them.

    Values follow the parabola through two points with the mean curvature of either; tension, straight, ends between a
    point that has it and one that has none. Only beside points near the largest of their line, (ny,).
    """
    left, right, peak = slice(None, -1), slice(1, None), largest[:, None].astype(uncut.dtype)
    # What is tensile and shortens may extend up to where tension ends.
    near = uncut >= _RIVAL * (peak if margin is None else np.where(peak > 0, peak, -np.inf))
    candidates = near[..., left] | near[..., right]
    if margin is not None:
        tensile = margin > 0
        candidates &= tensile[..., left] | tensile[..., right]
    columns = np.flatnonzero(candidates.any(axis=(0, 1)))
    if uncut.shape[2] < 3 or not len(columns):
        return largest
    # Of the stretch that holds all of them, with the points beside it.
    start, stop = max(int(columns[0]) - 1, 0), min(int(columns[-1]) + 3, uncut.shape[2])
    uncut, candidates = uncut[..., start:stop], candidates[..., start : stop - 1]
    bends = uncut[..., 2:] + uncut[..., :-2]
    bends -= 2 * uncut[..., 1:-1]
    # A parabola rises by a quarter of its bend above the larger of its ends at most, and bends as half of the points.
    near = uncut > peak + 0.125 * np.minimum(bends.min(axis=-1, keepdims=True), 0.0)
    candidates &= near[..., left] | near[..., right]
    j, z, i = np.nonzero(candidates.swapaxes(0, 1))
    bend = 0.25 * (bends[z, j, np.maximum(i - 1, 0)] + bends[z, j, np.minimum(i, bends.shape[-1] - 1)])
    first, last = uncut[z, j, i], uncut[z, j, i + 1]
    higher = np.flatnonzero(np.maximum(first, last) - 0.25 * np.minimum(bend, 0.0) > largest[j])
    if not len(higher):
        return largest
    j, z, i = j[higher], z[higher], i[higher]
    bend, first, last = bend[higher], first[higher], last[higher]
    # Where tension begins and ends, in parts of the way between the two points.
    low, high = np.zeros_like(first), np.ones_like(first)
    if margin is not None:
        before, after = margin[z, j, start + i], margin[z, j, start + i + 1]
        ends = np.divide(before, before - after, out=np.zeros_like(first), where=before != after)
        low, high = np.where(before > 0, low, ends), np.where(after > 0, high, ends)
    slope = last - first - bend
    summit = np.clip(np.divide(-0.5 * slope, bend, out=low.copy(), where=bend < 0), low, high)
    places = np.stack([low, high, summit])
    vertex_values = (first + places * (slope + places * bend)).max(axis=0)
    # Lines come one after the other.
    starts = np.flatnonzero(np.diff(j, prepend=-1))
    result, lines = largest.copy(), j[starts]
    result[lines] = np.maximum(result[lines], np.maximum.reduceat(vertex_values, starts))
    return result
