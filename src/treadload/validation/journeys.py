"""Checks of traffic: Miner's sum of a mix, wander, growth, and readings interpolated over temperature."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from treadload.damage import (
    AxleClass,
    Climate,
    Criterion,
    FatigueLine,
    FrenchSubgrade,
    Traffic,
    Wander,
)
from treadload.damage.miner import miner
from treadload.life.design import Design
from treadload.life.passages import solve_passages
from treadload.pavement import Pavement
from treadload.tire import Tire
from treadload.validation.check import Check, absolute, relative

_CRITERIA = (
    Criterion("top", FatigueLine(100e-6, -0.2), 0, "top", "principal"),
    Criterion("soil", FrenchSubgrade(), -1, "top"),
)
_TOLERANCE = 0.02


def traffic_checks() -> Iterator[Check]:
    """A mix against its parts, normal wander of normal damage, sums of years, temperatures of a year from few."""
    group = "traffic"
    yield absolute(group, "Miner: mixed less sum of parts, relative", _parts_off(), 0, 1e-12, "linearity of the sum")
    truck = (AxleClass("truck", 1.0, 32.5e3, 820e3),)
    for name, traffic, total in (
        ("geometric", Traffic(truck, 1e5, growth=0.03), 1e5 * sum(1.03**k for k in range(20))),
        (
            "arithmetic",
            Traffic(truck, 1e5, growth=0.03, kind="arithmetic"),
            1e5 * sum(1 + 0.03 * k for k in range(20)),
        ),
    ):
        passes = traffic.passes(20)
        yield relative(group, f"{name} growth of 3 %, passes of 20 years", passes, total, 1e-12, "sum of the years")
        years = traffic.years_to(passes)
        yield relative(group, f"{name} growth of 3 %, years to them", years, 20, 1e-9, "its inverse")
    dy, width, wander = 5e-3, 0.06, 0.12
    y = np.arange(-200, 201) * dy
    spread = Wander.normal(wander).spread(np.exp(-0.5 * (y / width) ** 2), dy)
    wide = (np.arange(len(spread)) - (len(spread) - 1) / 2) * dy
    both = math.hypot(width, wander)
    off = np.abs(spread - width / both * np.exp(-0.5 * (wide / both) ** 2)).max() * both / width
    # Tracks 5 mm wide widen the law by dy²/12.
    yield absolute(group, "normal damage under normal wander, error over the peak", off, 0, 1e-3, "sum of variances")
    total = float(spread.sum() * dy)
    yield relative(
        group, "damage after wander, summed over y, m", total, width * math.sqrt(2 * math.pi), 1e-9, "none lost"
    )
    yield from _interpolated()


def _parts_off() -> float:
    y = np.arange(-30, 31) * 0.02
    shares, climate = (0.5, 0.3, 0.2), Climate.equal_parts([0.0, 15.0, 30.0])
    peaks = np.random.default_rng(0).uniform(50e-6, 200e-6, (2, 3, 3, 1))
    values = peaks * np.exp(-0.5 * (y / 0.1) ** 2)
    classes = tuple(AxleClass(f"class {k}", share, 30e3, 8e5) for k, share in enumerate(shares))
    traffic = Traffic(classes, 1e5, wander=Wander.normal(0.2))
    whole = miner(values, _CRITERIA, traffic, climate, y=y).dataset["damage_per_year"].to_numpy()
    parts = np.zeros_like(whole)
    for k, axle in enumerate(classes):
        for s, season in enumerate(climate.seasons):
            alone = replace(
                traffic, classes=(replace(axle, share=1.0),), passes_per_year=1e5 * axle.share * season.share
            )
            part = miner(values[:, k : k + 1, s : s + 1], _CRITERIA, alone, Climate.constant(15.0), y=y)
            parts += part.dataset["damage_per_year"].to_numpy()
    return float(np.abs(whole - parts).max() / whole.max())


def _interpolated() -> Iterator[Check]:
    """A light class over eight temperatures, all solved against those that the heavy class chose."""
    tire = Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
    road = Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")
    traffic = Traffic((AxleClass("light", 0.6, 15e3, 700e3), AxleClass("heavy", 0.4, 32.5e3, 820e3)), 1e5)
    climate = Climate.equal_parts([2.0, 5.0, 8.0, 12.0, 16.0, 20.0, 24.0, 28.0])
    exact, sparse = (
        solve_passages(Design(tire, road, traffic, climate, _CRITERIA, spacing=12e-3, tolerance=tolerance), workers=1)
        for tolerance in (0.0, _TOLERANCE)
    )
    # Of the cycle that does most; those after it change places where two do the same.
    readings, exact_readings = sparse.readings.isel(turn=0), exact.readings.isel(turn=0)
    error = float((abs(readings - exact_readings).max("y") / exact_readings.max("y")).max())
    group, source = "life over a year", "all temperatures solved"
    yield absolute(
        group, "error on the heavy class, as the result states it", sparse.interpolation_error, 0, _TOLERANCE, source
    )
    # Another class than the one that chose the temperatures: twice the tolerance.
    what = f"readings of 16 passages from {sparse.responses} responses, relative error"
    yield absolute(group, what, error, 0, 2 * _TOLERANCE, source)
