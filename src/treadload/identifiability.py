"""What data decide about the numbers of a model: covariance from slopes, and in words what stays undecided."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

Array = NDArray[np.float64]

LEVEL = 0.9
"""Level of the intervals of fitted numbers."""
UNDECIDED = 0.5
"""Data that leave a number, or numbers together, uncertain by this part of their size do not decide them."""
# Part in a direction above which a number belongs to it.
_BELONGS = 0.3
# What the slopes cannot tell from nothing: below round-off of the largest singular value.
_NOTHING = 1e-10


@dataclass(frozen=True, eq=False)
class Spread:
    """How the errors of readings spread over the numbers of a model, linear about the fit.

    values: singular values of the slopes (d,). directions: (d, n) that belong to them. deviations: relative standard
    deviations (n,), NaN where the data do not decide. correlation: (n, n).
    """

    values: Array
    directions: Array
    deviations: Array
    correlation: Array


def spread(slopes: Array, free: NDArray[np.bool_], scatter: float) -> Spread:
    """Covariance of fitted numbers from the slopes of the readings; numbers at a bound are held there.

    slopes: (readings, numbers), change of a reading over its error per relative change of a number. free: (numbers,),
    False at a bound. scatter: size of the errors over what was taken.
    """
    count = slopes.shape[1]
    values, directions = np.zeros(0), np.zeros((0, count))
    deviations = np.full(count, math.nan)
    correlation = np.full((count, count), math.nan)
    if free.any():
        _, values, right = np.linalg.svd(slopes[:, free], full_matrices=False)
        directions = np.zeros((len(values), count))
        directions[:, free] = right
        sure = values > _NOTHING * values[0]
        inverse = np.where(sure, 1 / np.where(sure, values, 1.0), math.inf)
        covariance = np.full((count, count), math.nan)
        with np.errstate(invalid="ignore"):
            parts = np.where(right == 0, 0.0, right * inverse[:, None])
            covariance[np.ix_(free, free)] = parts.T @ parts
            deviations = scatter * np.sqrt(np.diag(covariance))
            sigma = np.sqrt(np.diag(covariance))
            correlation = covariance / np.outer(sigma, sigma)
    deviations = np.where(np.isfinite(deviations), deviations, math.nan)
    return Spread(values, directions, deviations, correlation)


def quantile(level: float, freedom: float, *, stated: bool) -> float:
    """Standard deviations on either side of a number that hold it with a probability.

    Normal where the errors of the readings are stated, else Student's with the degrees of freedom left; NaN for none.
    """
    tail = 0.5 * (1 + level)
    if stated:
        return float(scipy.special.ndtri(tail))
    return float(scipy.special.stdtrit(freedom, tail)) if freedom > 0 else math.nan


def undecided_in_words(names: Sequence[str], values: Array, directions: Array, scatter: float) -> list[str]:
    """A sentence for each direction that the data leave uncertain by half of the numbers' size.

    names: of the numbers. values, directions: of a `Spread`. scatter: as in `spread`.
    """
    caveats = []
    for value, parts in zip(values, directions, strict=True):
        reach = scatter / value if value > 0 else math.inf
        if reach <= UNDECIDED:
            continue
        # The largest first, and going up.
        order = [k for k in np.argsort(-np.abs(parts)) if abs(parts[k]) >= _BELONGS]
        sign = 1.0 if parts[order[0]] > 0 else -1.0
        sought = " and ".join(names[k] for k in order) if len(order) < 3 else ", ".join(names[k] for k in order)
        if not reach < 10:
            what = "it" if len(order) == 1 else "their change together"
            caveats.append(f"these data leave {sought} undecided: no reading depends on {what}")
        elif len(order) == 1:
            caveats.append(
                f"these data leave {sought} undecided: its standard deviation is {100 * reach:.0f} % of it"
            )
        else:
            changes = ", ".join(f"{names[k]} by {100 * sign * parts[k] * reach:+.0f} %" for k in order)
            caveats.append(
                f"these data leave {sought} undecided: changing {changes} moves the readings by no more than "
                "their errors"
            )
    return caveats
