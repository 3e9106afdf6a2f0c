"""How the axles of a group interact: the damage by one of them over that by the same axle alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from treadload.damage.cycles import harm_of
from treadload.damage.laws.equivalence import GROUP_FACTORS
from treadload.damage.life import Life
from treadload.kernels.arrays import Array
from treadload.life.contacts import Counter
from treadload.life.passage import Passing, solve_passings
from treadload.life.passages import Passages
from treadload.life.seasons import warmed
from treadload.life.threads import how_many, pool_of
from treadload.life.wheels import Wheels
from treadload.pavement import Pavement


def group_factors(road: Pavement, life: Life, passages: Passages, workers: int | None = None) -> tuple[Array, Array]:
    """K of every criterion and class, and the number of axles of every class.

    K = D(group) / (axles × D(one of its axles alone)), by the sum that the life takes, both at their own worst place,
    in the season in which the class does most of the damage. NaN for single axles and where there is no damage.
    life: by the readings of the passages. workers: threads; all cores if left out.
    One response is solved for each class with several axles. Returns K (criterion, axle_class) and axles
    (axle_class).
    """
    readings = life.readings.to_numpy()
    y = life.readings["y"].to_numpy()
    shares = life.dataset["damage_share"].to_numpy()
    factors = np.full(shares.shape[:2], np.nan)
    axles = np.array([len(wheel.x) for wheel in passages.wheels])
    several = [int(number) for number in np.flatnonzero(axles > 1)]
    seasons = [int(shares[:, number].sum(axis=0).argmax()) for number in several]
    classes, turns = life.traffic.classes, readings.shape[3]
    warm = {
        (number, season): warmed(road, life.criteria, life.climate.seasons[season], classes[number])
        for number, season in zip(several, seasons, strict=True)
    }
    tasks = [
        Passing(_one_axle(passages.wheels[number]), warm[number, season], y, turns, passages.reach)
        for number, season in zip(several, seasons, strict=True)
    ]
    threads = how_many(workers)
    with pool_of(threads) as pool:
        solved = solve_passings(tasks, pool, Counter(len(tasks), None), threads)
    for number, season, alone in zip(several, seasons, solved, strict=True):
        group = readings[:, number, season]
        for k, law in enumerate(row[number][season] for row in life.class_laws):
            together, single = (harm_of(law, values).max() for values in (group[k], alone[k, :turns]))
            if single > 0:
                factors[k, number] = together / (axles[number] * single)
    return factors, axles


def in_words(names: tuple[str, ...], criteria: tuple[str, ...], factors: Array, axles: Array) -> tuple[str, ...]:
    """A sentence for each class with several axles. names: of the classes; criteria: their names."""
    lines = []
    for name, count, column in zip(names, axles, factors.T, strict=True):
        if count == 1:
            continue
        pairs = zip(criteria, column, strict=True)
        factor_text = ", ".join(f"{value:.2f} ({name})" for name, value in pairs if np.isfinite(value)) or "unknown"
        french = " and ".join(
            f"{row[int(count)]:g} for {kind} layers" for kind, row in GROUP_FACTORS.items() if int(count) in row
        )
        beside = f"; the French method takes {french}" if french else ""
        lines.append(
            f"{name}: each of {count} axles does K = {factor_text} times the damage it would do alone{beside}"
        )
    return tuple(lines)


def _one_axle(wheels: Wheels) -> Wheels:
    """The rear axle of a group, where it stands."""
    first = wheels.x[0]
    half = 0.5 * (first[1] - first[0])
    kept = [number for number, load in enumerate(wheels.loads) if abs(load.grid.x[0] - first[0]) < half]
    offsets = tuple(wheels.offsets[number] for number in kept) if wheels.offsets else ()
    return replace(wheels, loads=tuple(wheels.loads[number] for number in kept), x=wheels.x[:1], offsets=offsets)
