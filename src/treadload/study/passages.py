"""Passages: what every class of axle does to every season's road, with few solves for many combinations."""

from __future__ import annotations

import itertools
import math
import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr
from scipy.interpolate import PchipInterpolator

from treadload.contact import Contact, solve_contact
from treadload.damage.design import Criterion, Side
from treadload.damage.traffic import AxleClass, Climate, Season, Traffic
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.pavement import Pavement
from treadload.response import place, solve_response
from treadload.tire import Tire

Progress = Callable[[str], None]

# Points beyond the outer edges of the wheels, m: strain there is a few per cent of the largest.
_MARGIN = 0.3
# Below this depth, m, fields are as smooth as a sixth of the depth, m, can follow: 1 % of the shear at 60 mm.
_DEEP, _PER_DEPTH, _COARSE = 0.05, 6, 0.02


@dataclass(frozen=True, eq=False)
class Passages:
    """Readings of the criteria as every class of axle passes in every season.

    readings: (criterion, axle_class, season, y), the largest over the passage. layer_temperatures: (criterion,
    season), °C. solves: contacts and responses that were really solved. interpolation_error: largest relative
    error of a reading that was interpolated over temperature, measured on the heaviest class; 0 if none was.
    """

    readings: xr.DataArray
    layer_temperatures: Array
    contacts: int
    responses: int
    interpolation_error: float

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
    spacing: float = 6e-3,
    tolerance: float = 3e-3,
    workers: int | None = None,
    progress: Progress | None = None,
) -> Passages:
    """What the laws read as every class of axle passes over the road in every season.

    A point of the road sees the whole field along x as the wheel rolls by; the reading at y is the largest of
    it: one cycle for all wheels of a class together.
    tire: its inflation pressure is replaced by that of the class. road: materials may depend on temperature.
    spacing: cells of the contact, m. tolerance: of readings interpolated over temperature, relative; 0 solves
    every season. workers: threads; all cores if left out. progress: called with a line of text.
    One contact is solved for each load, pressure and maneuver: the road's moduli do not matter to it. With many
    seasons of one temperature each, the heaviest class is solved in all of them, and the others only at those
    temperatures from which piecewise cubics give the heaviest class within the tolerance.
    Raises InputError, and ConvergenceError of a contact.
    """
    tell = progress or (lambda text: None)
    if not criteria:
        raise InputError("a life needs at least one criterion, got none")
    if not 0 <= tolerance < 1:
        raise InputError(f"tolerance must lie in [0, 1), got {tolerance}; 3e-3 is the default")
    classes, seasons = traffic.classes, climate.seasons
    for criterion in criteria:
        criterion.depth(road)
    roads = [_warmed(road, criteria, season) for season in seasons]
    threads = workers or os.cpu_count() or 1
    with ThreadPoolExecutor(threads) as pool:
        states = list(dict.fromkeys(_state(row) for row in classes))
        tell(f"{len(states)} contacts")
        found = dict(zip(states, pool.map(lambda s: _contact(tire, roads[0].road, s, spacing), states), strict=True))
        contacts = [found[_state(row)] for row in classes]
        y = _across(contacts, classes)
        done = itertools.count(1)

        def solve(pair: tuple[int, _Warm]) -> Array:
            row, one = pair
            read = _readings(contacts[row], classes[row], one.road, one.criteria, y)
            tell(f"response {next(done)}")
            return read

        def solve_all(rows: Sequence[int], which: Sequence[_Warm]) -> Array:
            pairs = [(row, one) for row in rows for one in which]
            solved = np.array(list(pool.map(solve, pairs)))
            return solved.reshape(len(rows), len(which), *solved.shape[1:])

        distinct = [one for k, one in enumerate(roads) if one not in roads[:k]]
        heaviest = int(np.argmax([row.wheel_load for row in classes]))
        others = [row for row in range(len(classes)) if row != heaviest]
        pilot = solve_all([heaviest], distinct)[0]
        kept, error = _nodes(seasons, roads, distinct, pilot, tolerance)
        values = np.empty((len(classes), len(distinct), len(criteria), len(y)))
        values[heaviest] = pilot
        if others:
            rest = solve_all(others, [distinct[k] for k in kept])
            if len(kept) < len(distinct):
                warmth = _warmth(seasons, roads, distinct)
                rest = PchipInterpolator(warmth[kept], rest, axis=1)(warmth)
            values[others] = rest
        responses = len(distinct) + len(others) * len(kept)
    where = [distinct.index(one) for one in roads]
    readings = xr.DataArray(
        values[:, where].transpose(2, 0, 1, 3),
        dims=("criterion", "axle_class", "season", "y"),
        coords={
            "criterion": [criterion.name for criterion in criteria],
            "axle_class": [row.name for row in classes],
            "season": [season.name for season in seasons],
            "y": y,
        },
    )
    temperatures = np.array([[_at_layer(c.number(road), season) for season in seasons] for c in criteria])
    return Passages(readings, temperatures, len(states), responses, error)


@dataclass(frozen=True)
class _Warm:
    """The road and the criteria at the temperatures of a season."""

    road: Pavement
    criteria: tuple[Criterion, ...]


def _warmed(road: Pavement, criteria: Sequence[Criterion], season: Season) -> _Warm:
    warm = road.at_temperature(_each(season, road))
    return _Warm(warm, tuple(criterion.at(_at_layer(criterion.number(road), season)) for criterion in criteria))


def _each(season: Season, road: Pavement) -> float | tuple[float, ...]:
    if isinstance(season.temperature, tuple) and len(season.temperature) != len(road.layers):
        raise InputError(
            f"season {season.name!r} has {len(season.temperature)} temperatures, the road {len(road.layers)} layers"
        )
    return season.temperature


def _at_layer(layer: int, season: Season) -> float:
    return season.temperature[layer] if isinstance(season.temperature, tuple) else season.temperature


def _state(row: AxleClass) -> tuple[Any, ...]:
    return row.wheel_load, row.inflation_pressure, row.maneuver, row.friction, row.speed


def _contact(tire: Tire, road: Pavement, state: tuple[Any, ...], spacing: float) -> Contact:
    load, pressure, maneuver, friction, speed = state
    inflated = replace(tire, inflation_pressure=pressure)
    return solve_contact(inflated, road, maneuver.rolling(load, friction, speed=speed), spacing=spacing)


def _across(contacts: Sequence[Contact], classes: Sequence[AxleClass]) -> Array:
    """Evenly spaced y, m, over all wheels of all classes and a margin."""
    dy = float(contacts[0].dataset.attrs["dy"])
    half = 0.0
    for contact, row in zip(contacts, classes, strict=True):
        own = float(np.abs(contact.dataset["y"]).max())
        half = max(half, own + max(abs(y) for _, y in row.wheels))
    n = int(np.ceil((half + _MARGIN) / dy))
    return dy * np.arange(-n, n + 1)


def _readings(contact: Contact, row: AxleClass, road: Pavement, criteria: Sequence[Criterion], y: Array) -> Array:
    """(criterion, y): the largest reading over the passage."""
    loads = [place(contact, x=at_x, y=at_y) for at_x, at_y in row.wheels]
    found = np.empty((len(criteria), len(y)))
    groups: dict[tuple[float, Side], list[int]] = {}
    depths = [criterion.depth(road) for criterion in criteria]
    for k, criterion in enumerate(criteria):
        groups.setdefault((_step(depths[k]), criterion.side), []).append(k)
    for (step, side), members in groups.items():
        at = sorted({depths[k] for k in members})
        x = _along(contact, row, step)
        rows = np.linspace(y[0], y[-1], math.ceil((y[-1] - y[0]) / step) + 1) if step else y
        data = solve_response(loads, road, depths=at, x=x, y=rows, side=side, speed=row.speed).dataset
        for k in members:
            worst = criteria[k].read(data.isel(depth=at.index(depths[k]))).max(axis=1)
            found[k] = PchipInterpolator(rows, worst)(y) if step else worst
    return found


def _step(depth: float) -> float:
    """Spacing of the points at a depth, m; 0 for that of the contact."""
    return min(depth / _PER_DEPTH, _COARSE) if depth > _DEEP else 0.0


def _along(contact: Contact, row: AxleClass, step: float) -> Array:
    """Where along x a passage is read, m: under the wheels, or coarser and further where fields are smooth."""
    own = contact.dataset["x"].to_numpy()
    centres = sorted({x for x, _ in row.wheels})
    if not step:
        near = np.concatenate([own + x for x in centres])
        return np.unique(np.round(near, 9))
    return np.arange(own[0] + centres[0] - _MARGIN, own[-1] + centres[-1] + _MARGIN, step)


def _warmth(seasons: Sequence[Season], roads: Sequence[_Warm], distinct: Sequence[_Warm]) -> Array:
    """One temperature, °C, of each distinct road."""
    return np.array([float(seasons[roads.index(one)].temperature) for one in distinct])  # type: ignore[arg-type]


def _nodes(
    seasons: Sequence[Season], roads: Sequence[_Warm], distinct: Sequence[_Warm], pilot: Array, tolerance: float
) -> tuple[list[int], float]:
    """Roads to solve for the other classes, in the order of temperature, and the error of the rest on the pilot.

    pilot: (road, criterion, y). The error is that of the readings, over the largest of each criterion and road.
    """
    everything = list(range(len(distinct)))
    if tolerance == 0 or len(distinct) < 4 or any(isinstance(season.temperature, tuple) for season in seasons):
        return everything, 0.0
    warmth = _warmth(seasons, roads, distinct)
    order = np.argsort(warmth)
    kept = [int(order[0]), int(order[-1])]
    largest = np.abs(pilot).max(axis=-1, keepdims=True)
    largest[largest == 0] = 1.0
    while True:
        kept.sort(key=lambda k: warmth[k])
        guess = PchipInterpolator(warmth[kept], pilot[kept], axis=0)(warmth)
        errors = (np.abs(guess - pilot) / largest).max(axis=(1, 2))
        if errors.max() <= tolerance:
            return kept, float(errors.max())
        if len(kept) + 1 == len(distinct):
            return everything, 0.0
        kept.append(int(errors.argmax()))
