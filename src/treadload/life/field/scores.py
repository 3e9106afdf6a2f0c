"""What a model is worth on sections that it has not seen: log scores over folds, shares cracked, intervals."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from treadload.kernels.arrays import Array, IntArray
from treadload.life.field.fit import Fit, Model, fit
from treadload.life.field.likelihood import Parameters, Sections, distribution, log_likelihood

FOLDS, SHUFFLES, SEED = 5, 3, 31
# A gain below so many standard errors of the paired difference is none.
ENOUGH = 2.0


@dataclass(frozen=True, eq=False)
class Folds:
    """A model fitted without the sections that it is judged by.

    scores: ln of the probability of each section (shuffle, n), nats. fitted: parameters that each was judged by.
    """

    model: Model
    sections: Sections
    scores: Array
    fitted: tuple[tuple[Parameters, ...], ...]

    @property
    def score(self) -> float:
        """Sum over the sections, mean over the shuffles, nats."""
        return float(self.scores.sum(axis=1).mean())

    def by_distribution(self, age: Array) -> Array:
        """Probability that each section has cracked by an age (n,), mean over the shuffles, by the unseen fits."""
        each = np.zeros((len(self.fitted), len(age)))
        for row, fits in enumerate(self.fitted):
            for parameters in set(fits):
                at = np.array([k for k, used in enumerate(fits) if used == parameters])
                each[row, at] = distribution(age[at], self.sections.at(at), parameters, self.model.kind)
        return np.asarray(each.mean(axis=0))


@dataclass(frozen=True)
class Gain:
    """Difference of the log scores of two models on the same unseen sections, and its standard error, nats."""

    nats: float
    error: float

    @property
    def in_words(self) -> str:
        """Gain, loss or none: what lies below two standard errors is none."""
        if abs(self.nats) <= ENOUGH * self.error:
            return "no gain"
        return "gain" if self.nats > 0 else "loss"


def folds_of(sections: Sections, model: Model, *, seed: int = SEED) -> Folds:
    """Scores of every section by fits without its fold: `FOLDS` folds by section, `SHUFFLES` times."""
    count = len(sections)
    scores, fitted = np.empty((SHUFFLES, count)), []
    for shuffle in range(SHUFFLES):
        fold = np.random.default_rng([seed, shuffle]).permutation(count) % FOLDS
        used: list[Parameters | None] = [None] * count
        for number in range(FOLDS):
            unseen = np.flatnonzero(fold == number)
            parameters = fit(sections.at(np.flatnonzero(fold != number)), model).parameters
            scores[shuffle, unseen] = log_likelihood(sections.at(unseen), parameters, model.kind)
            for k in unseen:
                used[k] = parameters
        fitted.append(tuple(parameters for parameters in used if parameters is not None))
    return Folds(model, sections, scores, tuple(fitted))


def gain(over: Folds, model: Folds) -> Gain:
    """What a model gains over another on the same unseen sections."""
    difference = (model.scores - over.scores).mean(axis=0)
    return Gain(float(difference.sum()), float(np.sqrt(len(difference)) * difference.std(ddof=1)))


def score_on(unseen: Sections, fitted: Fit) -> float:
    """Log score of a fit on the sections of another table, nats."""
    return float(log_likelihood(unseen, fitted.parameters, fitted.model.kind).sum())


@dataclass(frozen=True)
class Cell:
    """Share cracked so far in a class of sections, seen and predicted for unseen folds.

    name: of the class. count: sections. seen, predicted: shares. error: standard error of the share seen. age: middle
    of a class of age, years; NaN of other classes.
    """

    name: str
    count: int
    seen: float
    predicted: float
    error: float
    age: float = math.nan


def shares(folds: Folds, surveys: Sequence[Array], ages: Sequence[float], rows: IntArray | None = None) -> list[Cell]:
    """Shares cracked by age class, of the last survey of each section within it.

    surveys: ages of all surveys of each section. ages: ends of the classes, years. rows: sections that count.
    """
    chosen = list(range(len(folds.sections)) if rows is None else map(int, rows))
    high = folds.sections.interval.high
    cells = []
    for low, end in pairwise(ages):
        latest = {k: max((a for a in surveys[k] if low <= a < end), default=None) for k in chosen}
        at = np.array([k for k, age in latest.items() if age is not None], dtype=int)
        if not len(at):
            continue
        age = np.array([latest[k] for k in at], dtype=float)
        whole = np.full(len(folds.sections), end)
        whole[at] = age
        predicted = folds.by_distribution(whole)[at]
        seen = float((high[at] <= age).mean())
        error = float(np.sqrt(np.mean(predicted) * (1 - np.mean(predicted)) / len(at)))
        middle = 0.5 * (low + end)
        cells.append(Cell(f"{low:g} to {end:g} years", len(at), seen, float(predicted.mean()), error, middle))
    return cells


@dataclass(frozen=True)
class Coverage:
    """90 % intervals of unseen sections. share: mass of the probability transform of the events' intervals that lies
    inside them. outside: share of sections whose event is surely outside.
    """

    share: float
    outside: float


def coverage(folds: Folds, level: float = 0.9) -> Coverage:
    """How much of what unseen sections show lies in the intervals that are predicted for them.

    The event of a section lies between two ages, so that its probability transform lies between two numbers; the part
    of these inside the level counts. Sections are taken as they are in the table, given their entry.
    """
    low, high = transform(folds)
    bottom, top = (1 - level) / 2, (1 + level) / 2
    inside = np.clip(np.minimum(high, top) - np.maximum(low, bottom), 0.0, None)
    width = high - low
    mass = np.where(width > 0, inside / np.where(width > 0, width, 1.0), (low >= bottom) & (low <= top))
    return Coverage(float(mass.mean()), float(((high < bottom) | (low > top)).mean()))


def transform(folds: Folds) -> tuple[Array, Array]:
    """Probability transform of both ends of every section's interval (n,), by the unseen fits."""
    low, high = folds.sections.interval.low, folds.sections.interval.high
    ends = [folds.by_distribution(np.clip(age, 1e-9, 1e9)) for age in (low, np.minimum(high, 1e9))]
    return ends[0], ends[1]
