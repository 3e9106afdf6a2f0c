"""Cycles of a passage: rainflow of what a point of the road sees from rest to rest, and the damage that they do.

What is read is zero before and after a passage, and harmful above it. Rainflow pairs every rise with the fall that
closes it (Matsuishi and Endo 1968; ASTM E1049, 5.4.4): the largest peak with rest, each further peak with the valley
from which it rises or to which it falls, the higher of both.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from treadload.damage.laws.fatigue import FatigueLaw
from treadload.kernels.arrays import Array

# Readings below this part of the largest of all lines count as rest: less than a hundredth of a thousandth of their
# damage by a usual law.
_REST = 0.05


def turning_points(read: Array) -> tuple[Array, Array]:
    """Peaks (n, m) and valleys between them (n, m - 1) of lines of readings (n, nx).

    read: >= 0, at rest before the first and behind the last column. Lines with fewer peaks end in zeros. At least one
    peak each.
    """
    lines = np.zeros((len(read), read.shape[1] + 2), read.dtype)
    np.copyto(lines[:, 1:-1], read, where=read > _REST * read.max(initial=0.0))
    slope = np.diff(lines, axis=1)
    # A level stretch goes on as what came before it. Every line begins with a rise and ends with a fall.
    steep = np.flatnonzero(slope)
    rises = slope.ravel()[steep] > 0
    turn = np.flatnonzero(rises[1:] != rises[:-1]) + 1
    row, column = np.divmod(steep[turn], slope.shape[1])
    peak = ~rises[turn]
    # The fall that ends a line is followed by the rise that begins the next.
    valley = ~peak & (steep[turn - 1] >= row * slope.shape[1])
    values, counts = lines[row, column], np.bincount(row[peak], minlength=len(read))
    most = max(int(counts.max(initial=0)), 1)
    peaks, valleys = np.zeros((len(read), most)), np.zeros((len(read), most - 1))
    for result, chosen, of_line in ((peaks, peak, counts), (valleys, valley, np.maximum(counts - 1, 0))):
        place = np.arange(int(of_line.sum())) - np.repeat(np.cumsum(of_line) - of_line, of_line)
        result[row[chosen], place] = values[chosen]
    return peaks, valleys


def rainflow(peaks: Array, valleys: Array) -> tuple[Array, Array]:
    """Cycles (n, m) of lines of peaks (n, m) and the valleys between them (n, m - 1): peak and valley.

    The largest peak is paired with rest. What is missing in a line are peaks and valleys of zero behind the last.
    """
    peaks, valleys = np.array(peaks, dtype=float), np.array(valleys, dtype=float)
    n, m = peaks.shape
    tops, bottoms = np.zeros((n, m)), np.zeros((n, m))
    rows = np.arange(n)
    for number in range(m - 1):
        count = m - number
        # The smallest rise or fall between neighbours is a cycle that is closed.
        falls, rises = peaks[:, :-1] - valleys, peaks[:, 1:] - valleys
        smallest = np.concatenate([falls, rises], axis=1).argmin(axis=1)
        valley = smallest % (count - 1)
        peak = valley + (smallest >= count - 1)
        tops[:, number], bottoms[:, number] = peaks[rows, peak], valleys[rows, valley]
        left = np.arange(count - 1)
        kept = left + (left >= peak[:, None])
        peaks = np.take_along_axis(peaks, kept, axis=1)
        left = left[:-1]
        valleys = np.take_along_axis(valleys, left + (left >= valley[:, None]), axis=1)
    tops[:, -1] = peaks[:, 0]
    return tops, bottoms


def as_turns(tops: Array, bottoms: Array, turns: int, power: float) -> Array:
    """Peak, valley, peak, ... (turns, n) of cycles (n, m), those that do most first.

    The first is paired with rest, as the largest of a passage is; of each further one the valley stands before the
    peak. power: of the reading, by which damage grows. What cycles beyond
    (turns + 1)/2, the least, do is added to the last that is kept, as far as it stays below the first.
    """
    largest = tops.max(initial=0.0) or 1.0
    harm = (tops / largest) ** power - (bottoms / largest) ** power
    order, kept = np.argsort(-harm, axis=1, kind="stable"), (turns + 1) // 2
    left = np.take_along_axis(harm, order[:, kept:], axis=1).sum(axis=1)
    order = order[:, :kept]
    result = np.zeros((turns, len(tops)))
    result[: 2 * order.shape[1] : 2] = np.take_along_axis(tops, order, axis=1).T
    result[1 : 2 * order.shape[1] - 1 : 2] = np.take_along_axis(bottoms, order, axis=1).T[1:]
    if order.shape[1] == kept:
        last = np.minimum((result[-1] / largest) ** power + left, (result[0] / largest) ** power) ** (1 / power)
        result[-1] = np.where(left > 0, largest * last, result[-1])
    return result


def harm_of_each(law: FatigueLaw, tops: Array, bottoms: Array) -> Array:
    """Damage (n, m) of each cycle by a law, from peaks and valleys (n, m), see `rainflow` and `harm_of`."""
    by_cycle: Callable[[Array, Array], Array] | None = getattr(law, "allowable_cycles", None)
    if by_cycle is not None:
        each: Array = 1 / np.asarray(by_cycle(0.5 * (tops - bottoms), 0.5 * (tops + bottoms)))
        return each
    if getattr(law, "by_peak", False):
        # The largest peak is the last that is paired, with rest.
        tops, bottoms = np.where(np.arange(tops.shape[1]) == tops.shape[1] - 1, tops, 0.0), np.zeros_like(bottoms)
    harm: Array = 1 / np.asarray(law.allowable_passes(tops)) - 1 / np.asarray(law.allowable_passes(bottoms))
    return np.maximum(harm, 0.0)


def harm_of(law: FatigueLaw, turns: Array) -> Array:
    """Damage (ny,) of one passage by a law, from peak, valley, peak, ... (turn, ny), see `as_turns`.

    A law that has `allowable_cycles(amplitude, mean)` takes every cycle by these; one without reads peaks: a cycle
    does what its peak does from rest, less what its valley does, D = Σ 1/N(peak) - Σ 1/N(valley). Of a law that is
    `by_peak`, a limit, the largest peak alone counts.
    """
    by_cycle: Callable[[Array, Array], Array] | None = getattr(law, "allowable_cycles", None)
    if by_cycle is not None:
        tops = turns[::2]
        bottoms = np.concatenate([np.zeros((1, turns.shape[1])), turns[1::2]])
        cycles: Array = (1 / np.asarray(by_cycle(0.5 * (tops - bottoms), 0.5 * (tops + bottoms)))).sum(axis=0)
        return cycles
    if getattr(law, "by_peak", False):
        turns = turns.max(axis=0, keepdims=True)
    # Turns and places where nothing is read are many.
    filled = np.flatnonzero((turns > 0).any(axis=1))
    count = int(filled[-1]) + 1 if len(filled) else 1
    columns = np.flatnonzero(turns[:count].max(axis=0) > 0)
    harm = np.zeros(turns.shape[1])
    if len(columns):
        sign, read = np.where(np.arange(count) % 2, -1.0, 1.0)[:, None], turns[:count, columns]
        each, rises = np.zeros(read.shape), read > 0
        each[rises] = 1 / np.asarray(law.allowable_passes(read[rises]))
        # Where axles merge into one peak, round-off may leave less than nothing.
        harm[columns] = np.maximum((sign * each).sum(axis=0), 0.0)
    return harm
