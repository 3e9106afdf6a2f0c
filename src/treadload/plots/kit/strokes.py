"""Directions as strokes: where to draw them, how long, in which colour."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection

from treadload.kernels.arrays import Array, BoolArray
from treadload.plots.kit.style import INK, PAPER

# Strokes along the longer side of a map: enough to follow the field, few enough to tell apart.
_ALONG = 34
# A stroke shorter than this share of the longest is a point: the direction stands out of the plane.
_POINT = 0.22


@dataclass(frozen=True)
class Strokes:
    """Strokes of a field of directions. middles: (n, 2), mm. halves: (n, 2), half of each stroke, mm.

    index: (n, 2), row and column of the value that each stroke stands for.
    """

    middles: Array
    halves: Array
    index: Array

    @property
    def segments(self) -> Array:
        """(n, 2, 2): both ends of each stroke, mm."""
        ends: Array = np.stack([self.middles - self.halves, self.middles + self.halves], axis=1)
        return ends


def choose(weight: Array, x: Array, y: Array, threshold: float, apart: float) -> Array:
    """Cells to draw strokes at, the largest weights first, none nearer than `apart` to another.

    weight: (ny, nx). x: (nx,), y: (ny,) and apart: mm. Returns (n, 2) rows and columns of weights ≥ threshold.
    """
    rows, columns = np.nonzero(np.nan_to_num(weight, nan=-np.inf) >= threshold)
    if not rows.size:
        return np.zeros((0, 2), dtype=int)
    order = np.argsort(-weight[rows, columns], kind="stable")
    free = np.ones(weight.shape, dtype=bool)
    chosen = []
    for row, column in zip(rows[order].tolist(), columns[order].tolist(), strict=True):
        if not free[row, column]:
            continue
        chosen.append((row, column))
        # What lies near it is no longer free; where the cells are listed in order, a small block of the map.
        down, along = (y - y[row]) ** 2, (x - x[column]) ** 2
        near_y, near_x = np.flatnonzero(down < apart**2), np.flatnonzero(along < apart**2)
        block = np.ix_(near_y, near_x)
        free[block] &= along[near_x] + down[near_y, None] >= apart**2
    return np.array(chosen, dtype=int)


def strokes(
    weight: Array, along_x: Array, along_y: Array, x: Array, y: Array, threshold: float, apart: float | None = None
) -> Strokes:
    """Strokes of a direction field where its weight matters.

    weight: (ny, nx), what makes a direction worth drawing. along_x, along_y: (ny, nx), components in the plane
    of a unit vector; what is missing to 1 stands out of the plane and shortens the stroke. x, y: centres, mm.
    threshold: of the weight. apart: mm between strokes; a part of the map if left out.
    """
    span = max(np.ptp(x), np.ptp(y))
    gap = float(span / _ALONG) if apart is None else apart
    index = choose(weight, x, y, threshold, gap)
    rows, columns = index[:, 0], index[:, 1]
    middles = np.stack([x[columns], y[rows]], axis=-1)
    halves = 0.46 * gap * np.stack([along_x[rows, columns], along_y[rows, columns]], axis=-1)
    return Strokes(middles, halves, index)


def draw_strokes(
    ax: Axes, drawn: Strokes, colours: str | list[str] = INK, width: float = 1.1, backing: bool = True
) -> LineCollection:
    """Strokes on axes in mm; a point where the direction stands out of the plane. Returns the strokes' lines."""
    segments = drawn.segments
    length = np.hypot(*drawn.halves.T) if len(segments) else np.zeros(0)
    longest = float(length.max(initial=0.0))
    points: BoolArray = length < _POINT * longest
    if backing:
        ax.add_collection(
            LineCollection(
                list(segments), colors=PAPER, linewidths=width + 1.3, alpha=0.75, capstyle="round", zorder=3
            ),
            autolim=False,
        )
    lines = LineCollection(list(segments), colors=colours, linewidths=width, capstyle="round", zorder=3.1)
    lines.set_gid("strokes")
    ax.add_collection(lines, autolim=False)
    if points.any():
        at = drawn.middles[points]
        inks = colours if isinstance(colours, str) else [c for c, p in zip(colours, points, strict=True) if p]
        ax.scatter(at[:, 0], at[:, 1], s=7, c=inks, edgecolors=PAPER, linewidths=0.5, zorder=3.2)
    return lines
