"""Tables whose truth is known: sections with the survey ages of a real table, cracks and overlays drawn at random."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from treadload.kernels.arrays import Array
from treadload.life.field.events import first_between
from treadload.life.field.fit import DROP, Model, fit
from treadload.life.field.likelihood import Parameters, Sections
from treadload.life.field.table import Interval

_MOST_DRAWS = 100_000


def drawn(truth: Parameters, index: Array, surveys: Sequence[Array], random: np.random.Generator) -> Sections:
    """Sections of a table by a truth. index: of their mechanics (n,). surveys: ages of each section's surveys, years.

    Age of the crack and lag to the overlay are drawn until the section is in the table at its first survey; it is
    then surveyed at all of its ages.
    """
    medians = truth.medians(index)
    low, high = np.empty(len(surveys)), np.empty(len(surveys))
    for k, ages in enumerate(surveys):
        for _ in range(_MOST_DRAWS):
            crack = medians[k] * np.exp(truth.scatter * random.standard_normal())
            if crack + random.exponential(truth.lag) > ages[0]:
                break
        low[k], high[k] = first_between(ages, crack <= ages)
    return Sections(Interval(low, high), np.array([ages[0] for ages in surveys]), np.asarray(index, dtype=float))


@dataclass(frozen=True, eq=False)
class Recovery:
    """How well fits of drawn tables recover their truth.

    covered: share of tables whose 95 % interval holds it, by parameter. powers: fitted g of each table. lateness:
    level of the plain fit over the true one.
    """

    covered: dict[str, float]
    powers: Array
    lateness: Array


def recovery(
    truth: Parameters, index: Array, surveys: Sequence[Array], *, tables: int = 200, seed: int = 1
) -> Recovery:
    """Draws tables, fits them, and counts how often the 95 % interval of the profile holds the truth.

    index, surveys: as of `drawn`. An interval holds the truth where the log likelihood with the parameter held there
    lies no more than `DROP` below the maximum.
    """
    model, plain = Model(with_power=True), Model("plain")
    values = {name: np.log(getattr(truth, name)) for name in ("level", "scatter", "lag")} | {"power": truth.power}
    covered = dict.fromkeys(values, 0)
    powers, lateness = np.empty(tables), np.empty(tables)
    for number in range(tables):
        sections = drawn(truth, index, surveys, np.random.default_rng([seed, number]))
        fitted = fit(sections, model)
        for name, value in values.items():
            covered[name] += fitted.profile(name, float(value)) >= -DROP
        powers[number] = fitted.parameters.power
        # Of ages alone: the mean of the index over the sections is zero.
        lateness[number] = fit(sections, plain).parameters.level / truth.level
    return Recovery({name: count / tables for name, count in covered.items()}, powers, lateness)
