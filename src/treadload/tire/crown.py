"""The arc of a tread across: its radius over the tops of the ribs."""

from __future__ import annotations

import math

import numpy as np

from treadload.kernels.arrays import Array

# Shoulders fall off steeply, and inflation flattens what lies between them.
_BETWEEN_SHOULDERS = 0.8
# What lies deeper than this under the arc of the rest, m, or than this many of its deviations, is a groove.
_GROOVE, _DEVIATIONS = 0.2e-3, 2.0
# Of an arc whose ends rise by less than a hundredth of a millimetre over a tread's width, m: it is flat.
_FLATTEST = 1e3
_FEWEST, _MOST_ROUNDS = 8, 20


def arc_radius(y: Array, drop: Array) -> float | None:
    """Radius of the arc across through the tops of a tread, m; inf where it is flat or hollow, None where unknown.

    y: places across, m. drop: of the surface below any level line there, m, NaN where unknown: (n,) each.
    Parabola by least squares over the middle four fifths of the tread; grooves are left out as they are found.
    """
    finite = np.isfinite(drop)
    if finite.sum() < _FEWEST:
        return None
    low, high = y[finite].min(), y[finite].max()
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    kept = finite & (np.abs(y - middle) <= _BETWEEN_SHOULDERS * half)
    for _ in range(_MOST_ROUNDS):
        if kept.sum() < _FEWEST:
            return None
        fit = np.polynomial.Polynomial.fit(y[kept], drop[kept], 2)
        over = drop - fit(y)
        deep = kept & (over > max(_GROOVE, _DEVIATIONS * float(np.std(over[kept]))))
        if not deep.any():
            break
        kept &= ~deep
    bend = float(fit.deriv(2)(0.0))
    return 1 / bend if bend > 1 / _FLATTEST else math.inf
