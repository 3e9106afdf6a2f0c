"""Rows of cells below a surface, thin above and thicker below."""

from __future__ import annotations

import math

import numpy as np

from treadload.kernels.arrays import Array

# Rows may grow by this factor from one to the next.
_STEEPEST = 1.5


def graded_edges(top: float, bottom: float, first: float, count: int) -> Array:
    """Edges (n + 1,), m, of at most `count` rows from top to bottom, the first of about a thickness, m.

    Even where so many rows of that thickness reach the bottom, else each thicker than the one above by a ratio.
    """
    deep = bottom - top
    first = min(first, deep / 2)
    count = max(2, min(count, math.ceil(deep / first - 1e-9)))
    ratio = 1.0
    if count * first < deep * (1 - 1e-9):
        low, high = 1.0, _STEEPEST
        for _ in range(60):
            ratio = 0.5 * (low + high)
            low, high = (ratio, high) if first * (ratio**count - 1) / (ratio - 1) < deep else (low, ratio)
    steps = ratio ** np.arange(count)
    edges: Array = top + deep * np.concatenate([[0.0], np.cumsum(steps)]) / steps.sum()
    return edges


def spread_edges(top: float, bottom: float, first: float, ratio: float, most: int) -> Array:
    """Edges (n + 1,), m, of as many rows as reach the bottom, each thicker by a ratio; graded more above `most`."""
    deep = bottom - top
    first = min(first, deep / 2)
    count = math.ceil(math.log1p(deep / first * (ratio - 1)) / math.log(ratio) - 1e-9)
    if count > most:
        return graded_edges(top, bottom, first, most)
    steps = ratio ** np.arange(max(count, 2))
    edges: Array = top + deep * np.concatenate([[0.0], np.cumsum(steps)]) / steps.sum()
    return edges
