"""Classes of sections by age, thickness and age at entry: shares that are seen, and those that are predicted."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from treadload.kernels.arrays import Array
from treadload.life.field.fit import Fit, Model, fit
from treadload.life.field.likelihood import Sections, cracked_and_left, in_table, survival
from treadload.life.field.scores import Cell, Folds, shares
from treadload.life.field.table import Event, SectionTable

AGE_CLASSES = (0, 3, 6, 9, 12, 15, 18, 21, 25, 30, 40)
"""Ends of the classes of age at a survey, years."""
THICKNESS_CLASSES = (0.0, 0.10, 0.18, math.inf)
"""Ends of the classes of asphalt thickness, m."""
ENTRY_CLASSES = (0, 4, 7, 10, 14, 18, 60)
"""Ends of the classes of age at the first survey, years."""
FEWEST = 10
"""Sections of a class at least, for a share that is significant."""
BY_AGE, BY_THICKNESS = 2.5, 3.0
"""Standard errors by which shares of age classes, and of thickness classes, may differ from those predicted."""
LEAST = 0.15
"""Difference of an age class that is always allowed."""


def looked_at(table: SectionTable, event: Event) -> list[tuple[str, int, float, float]]:
    """Name, sections, share cracked so far and middle age, years, of every class of age, without any model."""
    high = table.interval(event).high
    rows = []
    for low, end in pairwise(AGE_CLASSES):
        latest = [max((age for age in ages if low <= age < end), default=math.nan) for ages in table.surveys]
        at = ~np.isnan(latest)
        share = float(np.mean(high[at] <= np.array(latest)[at])) if at.any() else math.nan
        rows.append((f"{low:g} to {end:g} years", int(at.sum()), share, 0.5 * (low + end)))
    return rows


def cells_of(folds: Folds, table: SectionTable) -> list[Cell]:
    """Classes of age, then classes of thickness alone and by age; all with `FEWEST` sections and more."""
    cells = shares(folds, table.surveys, AGE_CLASSES)
    for low, end in pairwise(THICKNESS_CLASSES):
        rows = np.flatnonzero((table.thickness >= low) & (table.thickness < end))
        if not len(rows):
            continue
        name = (
            f"asphalt of {1e3 * low:g} mm and more"
            if math.isinf(end)
            else f"asphalt of {1e3 * low:g} to {1e3 * end:g} mm"
        )
        whole = shares(folds, table.surveys, (0, AGE_CLASSES[-1] + 60), rows)
        parts = shares(folds, table.surveys, AGE_CLASSES, rows)
        cells += [Cell(name, cell.count, cell.seen, cell.predicted, cell.error) for cell in whole]
        cells += [Cell(f"{name}, {cell.name}", cell.count, cell.seen, cell.predicted, cell.error) for cell in parts]
    return [cell for cell in cells if cell.count >= FEWEST]


def is_within(cell: Cell) -> bool:
    """Whether a class lies within its bound."""
    if cell.name.startswith("asphalt"):
        return abs(cell.seen - cell.predicted) <= BY_THICKNESS * cell.error
    return abs(cell.seen - cell.predicted) <= max(LEAST, BY_AGE * cell.error)


@dataclass(frozen=True)
class Entry:
    """Sections that entered the table at an age. age: mean age at entry, years. count: sections. seen: share cracked
    at their first survey. predicted: by the fit with an overlay lag. plain: by the plain fit. level: median age that
    the plain likelihood gives these sections alone, years.
    """

    age: float
    count: int
    seen: float
    predicted: float
    plain: float
    level: float


def entries_of(sections: Sections, lag: Fit, plain: Fit) -> list[Entry]:
    """Survivorship: classes by age at entry."""
    entries = []
    for low, end in pairwise(ENTRY_CLASSES):
        rows = np.flatnonzero((sections.entry >= low) & (sections.entry < end))
        if len(rows) < FEWEST:
            continue
        part = sections.at(rows)
        age = part.entry
        medians = lag.parameters.medians(part.index)
        inside = cracked_and_left(age, lag.parameters, medians) / in_table(age, lag.parameters, medians)
        built = 1 - survival(age, plain.parameters, plain.parameters.medians(part.index))
        level = fit(part, Model("plain")).parameters.level
        seen = float(np.mean(part.interval.high <= age))
        entries.append(Entry(float(age.mean()), len(rows), seen, float(inside.mean()), float(built.mean()), level))
    return entries


def shares_of_all(ages: Array, fitted: Fit, draws: int, seed: int = 1) -> tuple[Array, Array, Array]:
    """Share of all roads built that have cracked by an age (n,), and the ends of its 95 % interval.

    Parameters are drawn as normal around the maximum with the curvature there.
    """
    names = fitted.model.names
    middle = np.array([fitted.values[name] for name in names])
    random = np.random.default_rng(seed)
    values = random.multivariate_normal(middle, fitted.covariance, size=draws)
    curves = []
    for at in values:
        parameters = fitted.model.parameters(dict(zip(names, at, strict=True)))
        curves.append(1 - survival(ages, parameters, np.full(len(ages), parameters.level)))
    best = 1 - survival(ages, fitted.parameters, np.full(len(ages), fitted.parameters.level))
    low, high = np.quantile(np.array(curves), [0.025, 0.975], axis=0)
    return best, low, high


def in_words(cells: Sequence[Cell]) -> str:
    """How many classes lie within their bounds, and the class that lies furthest out."""
    furthest = max(cells, key=lambda cell: abs(cell.seen - cell.predicted) / cell.error)
    within = sum(map(is_within, cells))
    return (
        f"{within} of {len(cells)} classes of {FEWEST} sections and more within their bounds (age: the larger of "
        f"{LEAST:g} and {BY_AGE:g} standard errors, thickness: {BY_THICKNESS:g}); furthest out {furthest.name}: "
        f"{furthest.seen:.2f} seen, {furthest.predicted:.2f} ± {furthest.error:.2f} predicted"
    )
