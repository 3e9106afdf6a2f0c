"""The plastic multiplier: the root of a scalar equation at every point at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from treadload.kernels.arrays import Array

# Newton's steps double the digits; bisection, where it must help, needs as many as a number has bits.
_MOST = 80


def root(function: Callable[[Array], tuple[Array, Array]], most: Array, power: float = 1.0) -> Array:
    """Where a falling function of the multiplier (n,) is zero, between 0 and `most`, to round-off.

    function: value and slope (n,), both of the same multiplier; the value is not below zero at 0 nor above it at
    `most`. power: the multiplier is most w^power, and the function is near linear in w: the exponent of a law whose
    overstress is a root of the multiplier. Newton's method, held between the ends.
    """
    low, high = np.zeros_like(most), np.ones_like(most)
    w = np.ones_like(most)
    for _ in range(_MOST):
        value, slope = function(most * w**power)
        above = value > 0
        low, high = np.where(above, w, low), np.where(above, high, w)
        fall = slope * most * power * w ** (power - 1)
        with np.errstate(divide="ignore", invalid="ignore"):
            step = w - value / fall
        inside = (step >= low) & (step <= high)
        step = np.where(inside, step, 0.5 * (low + high))
        done = (np.abs(step - w) <= 4e-16 * w) | (value == 0)
        w = np.where(value == 0, w, step)
        if done.all():
            break
    result: Array = most * w**power
    return result
