"""Passages: what every class of axle does to every season's road, with few solves for many combinations."""

from __future__ import annotations

import itertools
import math
import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Any, TypeVar

import numpy as np
import xarray as xr
from scipy.interpolate import Akima1DInterpolator, CubicSpline

from treadload.contact import Contact, solve_contact
from treadload.contact.solve import DEFAULT_SPACING
from treadload.damage.design import Criterion, Side
from treadload.damage.traffic import AxleClass, Climate, Season, Traffic
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.pavement import Pavement
from treadload.response import GridLoad, solve_response
from treadload.response.doubts import overlapping, road_doubts
from treadload.study.climate import nodes, over_the_climate, warmth_of
from treadload.tire import Tire

Found = TypeVar("Found")
Progress = Callable[[int, int, str], None]
"""(done, of how many, what) of the solves: contacts and responses."""

# Points beyond the outer edges of the wheels, m: strain there is a few per cent of the largest.
_MARGIN = 0.3
# Readings are told at least this close to each other across travel, m: a fifth of the mean that they are over.
_BETWEEN = 2e-3
# Near the surface points stand on every cell up to this far beside a wheel, m.
_BESIDE = 0.06
# Below this depth, m, fields are as smooth as a sixth of the depth, m, can follow: 1 % of the shear at 60 mm.
_DEEP, _PER_DEPTH, _COARSE = 0.05, 6, 0.02


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


@dataclass(frozen=True)
class Warm:
    """The road and the criteria at the temperatures of a season."""

    road: Pavement
    criteria: tuple[Criterion, ...]


@dataclass(frozen=True, eq=False)
class Wheels:
    """The wheels of a class with their contact, on the cells of the common lattice.

    loads: one a wheel. x: of the cells' centres under the axles, m, one row an axle, from the rear to the front.
    speed: m/s, or None.
    """

    loads: tuple[GridLoad, ...]
    x: Array
    speed: float | None
    name: str

    @property
    def cell(self) -> float:
        """Size of the cells across travel, m."""
        return self.loads[0].grid.dy


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
) -> Passages:
    """What the laws read as every class of axle passes over the road in every season.

    A point of the road sees the whole field along x as the wheels roll by. Each axle of a group is a cycle of its
    own, less what is left of it before the next one comes; wheels side by side are one.
    tire: of classes without one of their own; the inflation pressure is that of the class. road: materials may depend
    on temperature.
    spacing: cells of the contact, m; wheels are moved by half a cell at most, so that all share one lattice.
    tolerance: of readings interpolated over the climate, relative; 0 solves every season. workers: threads; all
    cores if left out. progress: called after every solve.
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
    states = list(dict.fromkeys(one for row in classes for one in states_of(row, tire)))
    count = Counter(len(states) + len(classes) * len(distinct), progress)
    with ThreadPoolExecutor(workers or os.cpu_count() or 1) as pool:

        def touch(one: tuple[Any, ...]) -> Contact:
            return count.after(contact_of(tire, warm[0].road, one, spacing), "contact")

        found = dict(zip(states, pool.map(touch, states), strict=True))
        contacts = [[found[one] for one in states_of(row, tire)] for row in classes]
        y = across([one[0] for one in contacts], classes)
        wheels = [wheels_of(own, row, y) for own, row in zip(contacts, classes, strict=True)]
        turns = 2 * max(len(one.x) for one in wheels) - 1

        def solve(pair: tuple[int, Warm]) -> Array:
            return count.after(passage(wheels[pair[0]], pair[1], y, turns), "response")

        def solve_all(rows: Sequence[int], which: Sequence[Warm]) -> Array:
            solved = np.array(list(pool.map(solve, [(row, one) for row in rows for one in which])))
            return solved.reshape(len(rows), len(which), *solved.shape[1:])

        heaviest = int(np.argmax([row.wheel_load for row in classes]))
        others = [row for row in range(len(classes)) if row != heaviest]
        pilot = solve_all([heaviest], distinct)[0]
        warmth = warmth_of(seasons, [one.road for one in distinct])
        kept, error = nodes(warmth, pilot[:, :, :turns], tolerance)
        count.total = len(states) + len(distinct) + len(others) * len(kept)
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
        len(states),
        count.total - len(states),
        error,
        max(_moved(one, row) for one, row in zip(wheels, classes, strict=True)),
        tuple(wheels),
        tuple(f"{one.name}: {text}" for one in wheels for text in overlapping(one.loads)) + road_doubts(warm[0].road),
    )


class Counter:
    """How many solves of a total are done; threads may count at once."""

    def __init__(self, total: int, progress: Progress | None) -> None:
        self.total = total
        self._done = itertools.count(1)
        self._tell = progress or (lambda done, total, what: None)

    def after(self, found: Found, what: str) -> Found:
        """What was found, counted."""
        self._tell(next(self._done), self.total, what)
        return found


def warmed(road: Pavement, criteria: Sequence[Criterion], season: Season) -> Warm:
    """The road and the criteria in a season. Raises InputError for temperatures that do not fit the road."""
    temperature = season.temperature
    if isinstance(temperature, tuple) and len(temperature) != len(road.layers):
        raise InputError(
            f"season {season.name!r} has {len(temperature)} temperatures, the road {len(road.layers)} layers"
        )
    warm = road.at_temperature(temperature)
    return Warm(warm, tuple(criterion.at(_at_layer(criterion.number(road), season)) for criterion in criteria))


def layer_temperatures(road: Pavement, criteria: Sequence[Criterion], seasons: Sequence[Season]) -> Array:
    """Temperature (criterion, season) of the layer that each criterion reads, °C."""
    return np.array([[_at_layer(c.number(road), season) for season in seasons] for c in criteria])


def _at_layer(layer: int, season: Season) -> float:
    return season.temperature[layer] if isinstance(season.temperature, tuple) else season.temperature


def check_speed(row: AxleClass, road: Pavement) -> None:
    """Raise InputError for a class without speed on a viscoelastic road."""
    if road.is_viscoelastic and row.speed is None:
        raise InputError(f"the road is viscoelastic: give the class {row.name!r} a speed in m/s")


def state(row: AxleClass) -> tuple[Any, ...]:
    """What the contact of a class depends on, besides the tire and the road."""
    return row.wheel_load, row.inflation_pressure, row.maneuver, row.friction, row.speed, row.tire


def states_of(row: AxleClass, tire: Tire) -> tuple[tuple[Any, ...], ...]:
    """The state of a class; and, where wheels are mirrored and their tread is not its own mirror image, that whose
    mirror image is theirs: with side force and spin turned round.
    """
    if not row.mirrored or (row.tire or tire).is_symmetric:
        return (state(row),)
    maneuver = replace(row.maneuver, lateral=-row.maneuver.lateral, spin=-row.maneuver.spin)
    return state(row), state(replace(row, maneuver=maneuver))


def contact_of(tire: Tire, road: Pavement, one: tuple[Any, ...], spacing: float) -> Contact:
    """The contact in a state, see `state`."""
    load, pressure, maneuver, friction, speed, own = one
    inflated = replace(own or tire, inflation_pressure=pressure)
    return solve_contact(inflated, road, maneuver.rolling(load, friction, speed=speed), spacing=spacing)


def across(contacts: Sequence[Contact], classes: Sequence[AxleClass]) -> Array:
    """Evenly spaced y, m, on the cells of the first contact and between them, over all wheels and a margin.

    Between cells lie the places of the largest readings, which must not depend on where the cells lie.
    """
    first = contacts[0].dataset
    dy, start = float(first.attrs["dy"]), float(first["y"][0])
    half = max(
        float(np.abs(contact.dataset["y"]).max()) + max(abs(y) for _, y in row.wheels)
        for contact, row in zip(contacts, classes, strict=True)
    )
    low, high = np.floor((-half - _MARGIN - start) / dy), np.ceil((half + _MARGIN - start) / dy)
    between = math.ceil(dy / _BETWEEN - 1e-9)
    return start + dy / between * np.arange(between * low, between * high + 1)


def wheels_of(contacts: Sequence[Contact], row: AxleClass, y: Array) -> Wheels:
    """The wheels of a class, each moved by half a cell at most onto the lattice of y and of its own x.

    contacts: in the states of the class, see `states_of`.
    """
    own, other = GridLoad.from_dataset(contacts[0].dataset), GridLoad.from_dataset(contacts[-1].dataset)
    grid = own.grid
    dx, dy = grid.dx, grid.dy
    loads = []
    for number, (at_x, at_y) in enumerate(row.wheels):
        one = other.mirrored() if len(contacts) > 1 and number in row.mirrored else own
        row_y = round((at_y + one.grid.y0 - y[0]) / dy)
        loads.append(one.moved(x=dx * round(at_x / dx), y=float(y[0]) + dy * row_y - one.grid.y0))
    centres = sorted({round(at_x / dx) for at_x, _ in row.wheels})
    return Wheels(
        tuple(loads),
        np.array([grid.x + dx * centre for centre in centres]),
        row.speed,
        row.name,
    )


def _moved(wheels: Wheels, row: AxleClass) -> float:
    """Largest distance along x or y between where wheels stand and where they should, m."""
    own = wheels.loads[0].grid
    shifts = [
        (one.grid.x0 - own.x0 - (x - row.wheels[0][0]), one.grid.y0 - own.y0 - (y - row.wheels[0][1]))
        for one, (x, y) in zip(wheels.loads, row.wheels, strict=True)
    ]
    return float(np.abs(shifts).max())


def passage(wheels: Wheels, warm: Warm, y: Array, turns: int) -> Array:
    """(criterion, turns + 2, y): peaks and valleys, see `Passages`, then the angle and the dip of the crack."""
    found = np.empty((len(warm.criteria), turns + 2, len(y)))
    depths = [criterion.depth(warm.road) for criterion in warm.criteria]
    groups: dict[tuple[int, Side, float | None], list[int]] = {}
    for k, (depth, criterion) in enumerate(zip(depths, warm.criteria, strict=True)):
        stride = _stride(depth, wheels.cell)
        side = criterion.side if depth > 0 else "above"
        # Deep down points and means are alike.
        groups.setdefault((stride, side, None if stride else criterion.mean_over), []).append(k)
    speed = wheels.speed if warm.road.is_viscoelastic else None
    for (stride, side, mean_over), members in groups.items():
        at = sorted({depths[k] for k in members})
        x, rows = _along(wheels, stride), _rows(wheels, y, stride)
        data = solve_response(
            wheels.loads, warm.road, depths=at, x=x, y=y[rows], speed=speed, side=side, mean_over=mean_over
        ).dataset
        nearest = np.abs(y[:, None] - y[None, rows]).argmin(axis=1)
        for k in members:
            plane = data.isel(depth=at.index(depths[k]))
            read = warm.criteria[k].read(plane)
            peaks = _turns(x, read, wheels.x.mean(axis=1), turns, smooth=stride > 0 or mean_over is not None)
            found[k, :turns] = np.maximum(_between(y[rows], peaks, smooth=stride > 0)(y), 0.0)
            instant = read.argmax(axis=1)[:, None]
            for part, field in enumerate(warm.criteria[k].crack(plane)):
                found[k, turns + part] = np.take_along_axis(field, instant, axis=1)[nearest, 0]
    return found


def _stride(depth: float, cell: float) -> int:
    """Cells from one point to the next at a depth; 0 near the surface, where each counts."""
    wide = min(depth / _PER_DEPTH, _COARSE)
    return max(1, int(wide / cell + 0.5)) if depth > _DEEP else 0


def _along(wheels: Wheels, stride: int) -> Array:
    """Where along x a passage is read, m: on the cells under the axles and once between them, or every so many cells
    and further where fields are smooth.
    """
    cell = float(wheels.x[0, 1] - wheels.x[0, 0])
    if stride:
        step = stride * cell
        beyond = step * np.ceil(_MARGIN / step)
        return np.arange(wheels.x[0, 0] - beyond, wheels.x[-1, -1] + beyond + step / 2, step)
    centres = wheels.x.mean(axis=1)
    between = wheels.x[0, 0] + cell * np.round((0.5 * (centres[1:] + centres[:-1]) - wheels.x[0, 0]) / cell)
    return np.unique(np.round(np.concatenate([*wheels.x, between]), 9))


def _rows(wheels: Wheels, y: Array, stride: int) -> Any:
    """Which of y to solve: every cell under and beside a wheel, few elsewhere; few everywhere where it is deep."""
    cells = np.arange(0, len(y), round(wheels.cell / (y[1] - y[0])))
    wanted = np.zeros(len(cells), dtype=bool)
    wanted[:: stride or max(1, int(_COARSE / wheels.cell + 0.5))] = True
    wanted[-1] = True
    if not stride:
        for load in wheels.loads:
            low, high = load.grid.y[0] - _BESIDE, load.grid.y[-1] + _BESIDE
            wanted |= (y[cells] > low) & (y[cells] < high)
    return cells[wanted]


def _between(y: Array, peaks: Array, *, smooth: bool) -> CubicSpline | Akima1DInterpolator:
    """Curves through peaks (turns, ny) over y. smooth: as they are deep down; near the surface they end at once where
    nothing is tensile, and nothing may swing beside such an end.
    """
    return CubicSpline(y, peaks, axis=1) if smooth else Akima1DInterpolator(y, peaks, axis=1, method="makima")


def _turns(x: Array, read: Array, centres: Array, turns: int, *, smooth: bool) -> Array:
    """Peak under each axle and valley between (turns, ny) of a passage (ny, nx), zeros behind the last.

    centres: of the axles along x, m, rising. A peak belongs to the axle that it is nearest to; a valley is the
    least between two centres, which changes steadily as peaks wander below an axle and never hides a cycle.
    smooth: peaks lie between points too, on the parabola through three of them.
    """
    result = np.zeros((turns, len(read)))
    ends = np.concatenate([[-np.inf], 0.5 * (centres[1:] + centres[:-1]), [np.inf]])
    for axle in range(len(centres)):
        inside = np.flatnonzero((x >= ends[axle]) & (x <= ends[axle + 1]))
        at = inside[read[:, inside].argmax(axis=1)]
        result[2 * axle] = _vertex(read, at) if smooth else np.take_along_axis(read, at[:, None], axis=1)[:, 0]
    for axle in range(len(centres) - 1):
        between = (x >= centres[axle]) & (x <= centres[axle + 1])
        result[2 * axle + 1] = read[:, between].min(axis=1)
    return np.maximum(result, 0.0)


def _vertex(read: Array, at: Any) -> Array:
    """Top of the parabola through each row's largest value, in the columns `at`, and its even neighbours."""
    inner = np.clip(at, 1, read.shape[1] - 2)
    before, peak, after = (np.take_along_axis(read, (inner + k)[:, None], axis=1)[:, 0] for k in (-1, 0, 1))
    bend = 2 * peak - before - after
    # At the ends of the row, and on a plateau, there is nothing to add.
    good = (inner == at) & (bend > 0) & (peak >= before) & (peak >= after)
    rise = (after - before) ** 2 / (8 * np.where(good, bend, 1.0))
    own: Array = np.take_along_axis(read, at[:, None], axis=1)[:, 0]
    return np.where(good, own + rise, own)
