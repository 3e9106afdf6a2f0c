"""Passages: what every class of axle does to every season's road, with few solves for many combinations."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
import xarray as xr

from treadload.contact.solve import DEFAULT_SPACING
from treadload.damage.climate import Climate, Season
from treadload.damage.criterion import Criterion
from treadload.damage.laws.fatigue import FatigueLaw
from treadload.damage.miner import wander_of
from treadload.damage.traffic import Traffic
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.pavement import Pavement
from treadload.response.doubts import overlapping, road_doubts
from treadload.study.climate import nodes, over_the_climate, warmth_of
from treadload.study.contacts import Contacts, Counter, Progress
from treadload.study.doubts import bond_doubts
from treadload.study.passage import Passing, solve_passings
from treadload.study.seasons import laws_of, layer_temperatures, roads_of
from treadload.study.threads import how_many, pool_of
from treadload.study.wheels import Wheels, across, check_speed, states_of, wheels_of
from treadload.tire import Tire


@dataclass(frozen=True, eq=False)
class Passages:
    """Readings of the criteria as every class of axle passes in every season.

    readings: (criterion, axle_class, season, turn, y): the peak under each axle of a group and, between them, the
    valley: peak, valley, peak, ..., zeros behind the last. crack_angle, crack_dip: (criterion, axle_class, season,
    y), rad, of the crack at the worst instant, in the season's road or the nearest that was solved. read_depth:
    of the largest reading there, m.
    layer_temperatures: (criterion, season), °C. contacts, responses: how many were really solved.
    interpolation_error: the largest that interpolation over the climate does, measured on the heaviest class: the
    relative error of its largest reading that would move damage as much; 0 if nothing was interpolated. moved: how
    far a wheel was moved to stand on the common cells, m. laws: (criterion, axle_class, season), of the moduli that
    were solved. warnings: sentences for the user.
    """

    readings: xr.DataArray
    crack_angle: Array
    crack_dip: Array
    read_depth: Array
    layer_temperatures: Array
    contacts: int
    responses: int
    interpolation_error: float
    moved: float
    wheels: tuple[Wheels, ...]
    laws: tuple[tuple[tuple[FatigueLaw, ...], ...], ...]
    warnings: tuple[str, ...] = ()

    @property
    def combinations(self) -> int:
        """Classes times seasons."""
        return int(self.readings.sizes["axle_class"] * self.readings.sizes["season"])


def solve_passages(
    tire: Tire,
    road: Pavement,
    traffic: Traffic,
    climate: Climate,
    criteria: Sequence[Criterion],
    *,
    spacing: float = DEFAULT_SPACING,
    tolerance: float = 5e-3,
    workers: int | None = None,
    progress: Progress | None = None,
    contacts: Contacts | None = None,
) -> Passages:
    """What the laws read as every class of axle passes over the road in every season.

    A point of the road sees the whole field along x as the wheels roll by. Each axle of a group is a cycle of its
    own, less what is left of it before the next one comes; wheels side by side make one cycle.
    tire: of classes without one of their own; the inflation pressure is that of the class. road: materials may depend
    on temperature.
    spacing: cells of the contact, m; wheels are moved by half a cell at most, so that all share one lattice.
    tolerance: of readings interpolated over the climate, relative; 0 solves every season. workers: threads; all
    cores if left out. progress: called after every solve. contacts: known already, on cells of this
    spacing; those solved join them.
    One contact is solved for each load, pressure and maneuver: the road's moduli do not matter to it. With many
    seasons of one temperature each, the heaviest class is solved in all of them, and the others, criterion by
    criterion, only in those from which splines give the harm of the heaviest class within the tolerance, see
    `climate.nodes`.
    Raises InputError, and ConvergenceError of a contact.
    """
    if not criteria:
        raise InputError("a life needs at least one criterion, got none")
    if not 0 <= tolerance < 1:
        raise InputError(f"tolerance must lie in [0, 1), got {tolerance}; 5e-3 is the default")
    classes, seasons = traffic.classes, climate.seasons
    for criterion in criteria:
        criterion.depth(road)
    warm = roads_of(road, criteria, seasons, classes)
    distinct = warm.distinct
    for row in classes:
        check_speed(row, distinct[0].road)
    temperatures = layer_temperatures(road, criteria, seasons)
    states = [one for row in classes for one in states_of(row, tire)]
    contacts = contacts or Contacts(tire, spacing)
    touched = len(contacts.missing(states))
    count = Counter(touched + len(classes) * len(distinct), progress)
    threads = how_many(workers)
    with pool_of(threads) as pool:
        contacts.solve(states, distinct[0].road, pool, count)
        by_class = [[contacts.known[one] for one in states_of(row, tire)] for row in classes]
        y = across([one[0] for one in by_class], classes)
        wheels = [wheels_of(own, row, y) for own, row in zip(by_class, classes, strict=True)]
        turns = 2 * max(len(one.x) for one in wheels) - 1

        values = np.empty((len(classes), len(distinct), len(criteria), turns + 3, len(y)))

        def solve_all(rows: Sequence[int], asked: Sequence[tuple[int, list[int]]]) -> None:
            """Into values, for classes, of roads those criteria; all by number."""
            tasks = [(row, number, own) for row in rows for number, own in asked]
            passings = [
                Passing(wheels[row], warm.by_class[row][number].reading(own), y, turns) for row, number, own in tasks
            ]
            for (row, number, own), read in zip(tasks, solve_passings(passings, pool, count, threads), strict=True):
                values[row, number, own] = read

        heaviest = int(np.argmax([row.wheel_load for row in classes]))
        others = [row for row in range(len(classes)) if row != heaviest]
        solve_all([heaviest], [(number, list(range(len(criteria)))) for number in range(len(distinct))])
        warmths = [warmth_of(seasons, [one.road for one in own]) for own in warm.by_class]
        warmth, laws = warmths[heaviest], laws_of(warm, temperatures)
        kept, errors = [], []
        for k, criterion in enumerate(criteria):
            wander = wander_of(criterion.law_at(temperatures[k, 0]), traffic)
            pilot, step = values[heaviest, :, k, :turns], float(y[1] - y[0])
            yearly = partial(_yearly, laws=laws[k][heaviest], where=warm.where, seasons=seasons)
            # Roads below a weather differ in several ways: holding their sum as close would ask for most of them.
            single = warmth is not None and warmth.ndim == 1
            few, error = nodes(warmth, pilot, tolerance, wander, step, yearly if single else None)
            kept.append(few)
            errors.append(error)
        asked = [(n, [k for k, few in enumerate(kept) if n in few]) for n in sorted(set().union(*kept))]
        count.total = touched + len(distinct) + len(others) * len(asked)
        if others:
            solve_all(others, asked)
            for k, few in enumerate(kept):
                if len(few) < len(distinct):
                    for number in others:
                        rest = values[np.ix_([number], few)][:, :, k]
                        values[number, :, k] = over_the_climate(warmths[number], few, rest, turns)[0]
    # (criterion, axle_class, season, turn, y), with the crack behind the turns.
    everything = values[:, warm.where].transpose(2, 0, 1, 3, 4)
    readings = xr.DataArray(
        everything[:, :, :, :turns],
        dims=("criterion", "axle_class", "season", "turn", "y"),
        coords={
            "criterion": [criterion.name for criterion in criteria],
            "axle_class": [row.name for row in classes],
            "season": [season.name for season in seasons],
            "y": y,
        },
    )
    return Passages(
        readings,
        everything[:, :, :, turns],
        everything[:, :, :, turns + 1],
        everything[:, :, :, turns + 2],
        temperatures,
        touched,
        count.total - touched,
        max(errors),
        max(one.moved for one in wheels),
        tuple(wheels),
        laws,
        tuple(f"{one.name}: {text}" for one in wheels for text in overlapping(one.loads))
        + road_doubts(distinct[0].road)
        + bond_doubts(criteria, distinct, wheels),
    )


def _yearly(readings: Array, laws: Sequence[FatigueLaw], where: Sequence[int], seasons: Sequence[Season]) -> Array:
    """Damage of a passage (road, y), by the shares of the seasons, from readings (road, turn, y) of one class.

    laws: by season. where: the road of each season, by number.
    """
    sign = np.where(np.arange(readings.shape[1]) % 2, -1.0, 1.0)[:, None]
    damage = np.zeros((len(readings), readings.shape[2]))
    for road, law, season in zip(where, laws, seasons, strict=True):
        each = (sign / np.asarray(law.allowable_passes(np.maximum(readings[road], 0.0)))).sum(axis=0)
        damage[road] += season.share * np.maximum(each, 0.0)
    return damage
