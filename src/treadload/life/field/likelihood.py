"""Likelihood of the ages at which sections cracked first: lognormal, interval-censored, and who is in a table at all.

A section is in a programme of surveys only if nobody overlaid it before its first survey. A crack at the age T and an
overlay a lag L later leave it in the table at its first survey's age e where T + L > e. A fit that does not account
for this takes the sections that were left for all roads, and is late.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import scipy

from treadload.kernels.arrays import Array, IntArray
from treadload.life.field.table import Interval

Kind = Literal["overlay-lag", "left-truncated", "plain"]
KINDS: tuple[Kind, ...] = ("overlay-lag", "left-truncated", "plain")
"""Conditional on being in the table, with an exponential lag from crack to overlay; sections without a crack at their
first survey only, conditional on that; as if every road built were in the table."""
WHY_LATE = (
    "the plain fit is late: roads that cracked early were overlaid before anybody surveyed them, and it takes those "
    "that were left for all"
)
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(64)
# Scatters below the median at which cracks are no longer counted: a share of 1e-17.
_DEEPEST = 8.5
# Lags after which no crack is left without an overlay: exp(-40).
_LAGS = 40.0
_SMALLEST = 1e-300


@dataclass(frozen=True)
class Parameters:
    """Of the age T of the first crack: ln T is normal.

    level: years, the median of a section whose predicted age is the geometric mean of the table. scatter: standard
    deviation of ln T. lag: mean years from crack to overlay; inf where nobody overlays. power: g of the mechanics,
    the power with which predicted ages enter: 1 trusts them, 0 leaves them out.
    """

    level: float
    scatter: float
    lag: float = np.inf
    power: float = 0.0

    def medians(self, index: Array) -> Array:
        """Median ages (n,), years. index: ln of the predicted ages less its mean over the table (n,)."""
        return np.asarray(self.level * np.exp(self.power * index))


@dataclass(frozen=True, eq=False)
class Sections:
    """What of a table enters its likelihood: the event between two ages, the age at the first survey, and the index.

    index: ln of predicted ages less its mean over the table (n,); zeros without mechanics.
    """

    interval: Interval
    entry: Array
    index: Array

    def at(self, rows: IntArray) -> Sections:
        """Some of them."""
        return Sections(self.interval.at(rows), self.entry[rows], self.index[rows])

    def __len__(self) -> int:
        return len(self.entry)


def survival(age: Array, parameters: Parameters, medians: Array) -> Array:
    """Probability of no crack until an age, years; of age 0 it is 1, of inf 0."""
    return np.asarray(scipy.special.ndtr(-_deviation(age, parameters, medians)))


def cracked_and_left(age: Array, parameters: Parameters, medians: Array) -> Array:
    """Probability of a crack before an age and no overlay until then: ∫₀^age f(t) exp(-(age - t)/lag) dt.

    By Gauss-Legendre quadrature over ln t, no further back than overlays leave anything.
    """
    middle, scatter = np.log(medians), parameters.scatter
    with np.errstate(divide="ignore"):
        high = np.maximum(np.log(age), middle - (_DEEPEST + 1) * scatter)
    low = middle - _DEEPEST * scatter
    # Earlier cracks were overlaid long ago: no more than a share of 1e-17 is left.
    with np.errstate(divide="ignore"):
        low = np.maximum(low, np.log(np.maximum(age - _LAGS * parameters.lag, 0.0)))
    half = np.maximum(high - low, 0.0)[:, None] / 2
    place = low[:, None] + half * (1 + _NODES)
    deviation = (place - middle[:, None]) / scatter
    exponent = -0.5 * deviation**2
    if np.isfinite(parameters.lag):
        exponent = exponent - (age[:, None] - np.exp(place)) / parameters.lag
    # Positive only where the age lies below all that counts: the range is empty.
    total = (half * _WEIGHTS * np.exp(np.minimum(exponent, 0.0))).sum(axis=1)
    return np.asarray(total / (scatter * np.sqrt(2 * np.pi)))


def in_table(age: Array, parameters: Parameters, medians: Array) -> Array:
    """Probability that no overlay came until an age: no crack yet, or one whose overlay is still to come."""
    return survival(age, parameters, medians) + cracked_and_left(age, parameters, medians)


def log_likelihood(sections: Sections, parameters: Parameters, kind: Kind) -> Array:
    """Ln of the probability of what each section shows (n,), by a kind of likelihood.

    Sections that contribute nothing to a kind, those cracked at entry of "left-truncated", have 0.
    """
    low, high, entry = sections.interval.low, sections.interval.high, sections.entry
    medians = parameters.medians(sections.index)
    between = _log_between(low, high, parameters, medians)
    if kind == "plain":
        return between
    if kind == "left-truncated":
        clean = high > entry
        return np.where(clean, between - scipy.special.log_ndtr(-_deviation(entry, parameters, medians)), 0.0)
    seen = np.where(high <= entry, _log(cracked_and_left(entry, parameters, medians)), between)
    return np.asarray(seen - _log(in_table(entry, parameters, medians)))


def distribution(age: Array, sections: Sections, parameters: Parameters, kind: Kind) -> Array:
    """Probability that a section of the table has cracked by an age (n,), given that it is in the table at its entry.

    Before the entry: cracked by then and not overlaid until the entry.
    """
    medians, entry = parameters.medians(sections.index), sections.entry
    gone = 1 - survival(age, parameters, medians)
    if kind == "plain":
        return gone
    clean = survival(entry, parameters, medians)
    if kind == "left-truncated":
        return np.clip(1 - survival(age, parameters, medians) / np.maximum(clean, _SMALLEST), 0.0, 1.0)
    whole = in_table(entry, parameters, medians)
    left = cracked_and_left(entry, parameters, medians)
    late = clean - survival(np.maximum(age, entry), parameters, medians)
    early = cracked_and_left(np.minimum(age, entry), parameters, medians) * np.exp(
        -np.maximum(entry - age, 0.0) / parameters.lag
    )
    return np.asarray(np.where(age < entry, early, left + late) / whole)


def _deviation(age: Array, parameters: Parameters, medians: Array) -> Array:
    """Ln of an age over the median, in scatters; of age 0 it is -inf."""
    with np.errstate(divide="ignore"):
        return np.asarray((np.log(age) - np.log(medians)) / parameters.scatter)


def _log_between(low: Array, high: Array, parameters: Parameters, medians: Array) -> Array:
    """Ln of the probability of a crack between two ages, in whichever tail keeps its digits."""
    below, above = (_deviation(age, parameters, medians) for age in (low, high))
    # The normal distribution mirrored: both ends on the side where it is small.
    mirrored = below > 0
    near, far = np.where(mirrored, -below, above), np.where(mirrored, -above, below)
    whole = scipy.special.log_ndtr(near)
    with np.errstate(divide="ignore", invalid="ignore"):
        part = np.exp(scipy.special.log_ndtr(far) - whole)
        return np.asarray(whole + np.log1p(-np.where(np.isfinite(part), np.minimum(part, 1 - 1e-16), 0.0)))


def _log(probability: Array) -> Array:
    return np.asarray(np.log(np.maximum(probability, _SMALLEST)))
