"""Checks of the likelihood of first cracks: its integral, and what a trial by other hands found in the same table."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.integrate import quad
from scipy.stats import lognorm

from treadload.life.field import EVENTS, field_tables
from treadload.life.field.fit import Model, fit
from treadload.life.field.likelihood import Parameters, Sections, cracked_and_left
from treadload.validation.check import Check, absolute, relative


def road_checks() -> Iterator[Check]:
    """Cracked and not yet overlaid by adaptive quadrature; level and scatter of LTPP's 149 sections."""
    group, ages = "what roads show", np.array([3.0, 12.0, 30.0])
    values = cracked_and_left(ages, Parameters(5.9, 0.72, 3.8), np.full(3, 5.9))
    crack = lognorm(0.72, scale=5.9)
    for age, value in zip(ages, values, strict=True):
        integral, _ = quad(
            lambda t, end: crack.pdf(t) * np.exp(-(end - t) / 3.8), 0, age, (float(age),), epsrel=1e-11
        )
        yield relative(
            group, f"cracked by {age:g} years and not overlaid", value, integral, 1e-8, "adaptive quadrature"
        )
    table = field_tables["LTPP"]
    sections = Sections(table.interval(EVENTS[0]), table.entry, np.zeros(len(table)))
    source = "a trial by other hands on LTPP's sections"
    plain, lag = fit(sections, Model("plain")), fit(sections, Model())
    yield relative(group, "median of the plain fit, years", plain.parameters.level, 9.9, 0.01, source)
    yield absolute(group, "scatter of ln age", lag.parameters.scatter, 0.72, 0.07, source)
    logarithm = float(np.log(lag.parameters.level))
    yield absolute(group, "ln of the median with overlays, years", logarithm, float(np.log(5.9)), 0.18, source)
