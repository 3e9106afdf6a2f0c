"""Passages: what every class of axle does to every season's road, with few solves for many combinations."""

from __future__ import annotations

import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
import xarray as xr

from treadload.contact.solve import DEFAULT_SPACING
from treadload.damage.criterion import Criterion
from treadload.damage.traffic import Climate, Traffic
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.pavement import Pavement
from treadload.response.doubts import overlapping, road_doubts
from treadload.study.climate import nodes, over_the_climate, warmth_of
from treadload.study.contacts import Contacts, Counter, Progress
from treadload.study.passage import Passing, solve_passings
from treadload.study.seasons import Warm, layer_temperatures, warmed
from treadload.study.wheels import Wheels, across, check_speed, states_of, wheels_of
from treadload.tire import Tire


@dataclass(frozen=True, eq=False)
class Passages:
    """Readings of the criteria as every class of axle passes in every season.

    readings: (criterion, axle_class, season, turn, y): the peak under each axle of a group and, between them, the
    valley: peak, valley, peak, ..., zeros behind the last. crack_angle, crack_dip: (criterion, axle_class, season,
    y), rad, of the crack at the worst instant, in the season's road or the nearest that was solved.
    layer_temperatures: (criterion, season), °C. contacts, responses: how many were really solved.
    interpolation_error: largest relative error of a reading that was interpolated over the climate, measured on the
    heaviest class; 0 if none was. moved: how far a wheel was moved to stand on the common cells, m. warnings:
    sentences for the user.
    """

    readings: xr.DataArray
    crack_angle: Array
    crack_dip: Array
    layer_temperatures: Array
    contacts: int
    responses: int
    interpolation_error: float
    moved: float
    wheels: tuple[Wheels, ...]
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
    seasons of one temperature each, the heaviest class is solved in all of them, and the others only in those
    from which splines give the heaviest class within the tolerance.
    Raises InputError, and ConvergenceError of a contact.
    """
    if not criteria:
        raise InputError("a life needs at least one criterion, got none")
    if not 0 <= tolerance < 1:
        raise InputError(f"tolerance must lie in [0, 1), got {tolerance}; 5e-3 is the default")
    classes, seasons = traffic.classes, climate.seasons
    for criterion in criteria:
        criterion.depth(road)
    warm = [warmed(road, criteria, season) for season in seasons]
    for row in classes:
        check_speed(row, warm[0].road)
    distinct = [one for k, one in enumerate(warm) if one not in warm[:k]]
    states = [one for row in classes for one in states_of(row, tire)]
    contacts = contacts or Contacts(tire, spacing)
    touched = len(contacts.missing(states))
    count = Counter(touched + len(classes) * len(distinct), progress)
    with ThreadPoolExecutor(workers or os.cpu_count() or 1) as pool:
        contacts.solve(states, warm[0].road, pool, count)
        by_class = [[contacts.known[one] for one in states_of(row, tire)] for row in classes]
        y = across([one[0] for one in by_class], classes)
        wheels = [wheels_of(own, row, y) for own, row in zip(by_class, classes, strict=True)]
        turns = 2 * max(len(one.x) for one in wheels) - 1

        def solve_all(rows: Sequence[int], which: Sequence[Warm]) -> Array:
            tasks = [Passing(wheels[row], one, y, turns) for row in rows for one in which]
            solved = np.array(solve_passings(tasks, pool, count))
            return solved.reshape(len(rows), len(which), *solved.shape[1:])

        heaviest = int(np.argmax([row.wheel_load for row in classes]))
        others = [row for row in range(len(classes)) if row != heaviest]
        pilot = solve_all([heaviest], distinct)[0]
        warmth = warmth_of(seasons, [one.road for one in distinct])
        kept, error = nodes(warmth, pilot[:, :, :turns], tolerance)
        count.total = touched + len(distinct) + len(others) * len(kept)
        values = np.empty((len(classes), *pilot.shape))
        values[heaviest] = pilot
        if others:
            rest = solve_all(others, [distinct[k] for k in kept])
            values[others] = rest if len(kept) == len(distinct) else over_the_climate(warmth, kept, rest, turns)
    where = [distinct.index(one) for one in warm]
    # (criterion, axle_class, season, turn, y), with the crack behind the turns.
    everything = values[:, where].transpose(2, 0, 1, 3, 4)
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
        layer_temperatures(road, criteria, seasons),
        touched,
        count.total - touched,
        error,
        max(one.moved for one in wheels),
        tuple(wheels),
        tuple(f"{one.name}: {text}" for one in wheels for text in overlapping(one.loads)) + road_doubts(warm[0].road),
    )
