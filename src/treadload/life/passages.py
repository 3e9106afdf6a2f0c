"""Passages: what every class of axle does to every season's road, with few solves for many combinations."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from treadload.damage.climate import Season
from treadload.damage.cycles import harm_of
from treadload.damage.laws.fatigue import FatigueLaw
from treadload.damage.miner import wander_of
from treadload.deferred import xarray as xr
from treadload.kernels.arrays import Array, BoolArray
from treadload.life.caveats import bond_caveats
from treadload.life.climate import nodes, over_the_climate, warmth_of
from treadload.life.contacts import Counter, Progress
from treadload.life.design import Design
from treadload.life.halving import pushed_classes
from treadload.life.passage import ANGLE, BEHIND, BORDER, DEPTH, DIP, Passing, stream_passings, turns_of
from treadload.life.seasons import laws_of, layer_temperatures, roads_of
from treadload.life.threads import how_many, pool_of
from treadload.life.wheels import Wheels, across, check_speed, states_of, wheels_of
from treadload.response.basin import basin_reach, too_wide
from treadload.response.input_caveats import overlapping, road_caveats


@dataclass(frozen=True, eq=False)
class Passages:
    """Readings of the criteria as every class of axle passes in every season.

    readings: (criterion, axle_class, season, turn, y): the cycles of a passage by rainflow, those that do most first:
    peak, valley, peak, ..., the first paired with rest, zeros behind the last, see `damage.cycles`.
    crack_angle, crack_dip: (criterion, axle_class, season, y), rad, of the crack at the worst instant, in the
    season's road or the nearest that was solved. read_depth: of the largest reading there, m.
    layer_temperatures: (criterion, season), °C. contacts, responses: how many were really solved.
    interpolation_error: the largest that interpolation over the climate does, measured on the heaviest class: the
    relative error of its largest reading that would move damage as much; 0 if nothing was interpolated. moved: how
    far a wheel was moved to stand on the common cells, m. reach: how far around the wheels was read, m.
    laws: (criterion, axle_class, season), of the moduli that were solved. evaluated: (criterion, axle_class, season,
    turns + `BEHIND`, y), what readings and cracks are parts of. warnings: sentences for the user.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> asphalt, soil = tl.Layer(tl.Elastic(5e9, 0.35), 0.03, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> design = tl.Design(tire, tl.Pavement([asphalt, soil]), traffic, climate, [base], spacing=0.01)
    >>> passages = tl.life.solve_passages(design)
    >>> f"{passages.responses} response solved for 1 class of axles in 1 season"
    '1 response solved for 1 class of axles in 1 season'
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
    reach: float
    wheels: tuple[Wheels, ...]
    laws: tuple[tuple[tuple[FatigueLaw, ...], ...], ...]
    evaluated: Array
    warnings: tuple[str, ...] = ()

    @property
    def combinations(self) -> int:
        """Classes times seasons."""
        return int(self.readings.sizes["axle_class"] * self.readings.sizes["season"])


def solve_passages(
    design: Design,
    *,
    workers: int | None = None,
    progress: Progress | None = None,
    earlier: Passages | None = None,
) -> Passages:
    """What the laws read as every class of axle passes over the road in every season.

    A point of the road meets the whole field along x as the wheels roll by, from rest to rest, the basin around them
    included; rainflow makes cycles of it.
    workers: threads; all cores if left out. progress: called after every solve. earlier: of the same design before
    contacts were halved; classes whose contacts stay keep what was read.
    One contact is solved for each load, pressure and maneuver: the road's moduli do not matter to it. With many
    seasons of one temperature each, the heaviest class is solved in all of them, and the others, criterion by
    criterion, only in those from which splines give the harm of the heaviest class within the tolerance, see
    `climate.nodes`.
    Raises InputError, and ConvergenceError of a contact.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> asphalt, soil = tl.Layer(tl.Elastic(5e9, 0.35), 0.03, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> design = tl.Design(tire, tl.Pavement([asphalt, soil]), traffic, climate, [base], spacing=0.01)
    >>> passages = tl.life.solve_passages(design)
    >>> f"{passages.readings.max().item() * 1e6:.0f} microstrain at the bottom of the asphalt"
    '72 microstrain at the bottom of the asphalt'
    """
    tire, road, criteria, contacts = design.tire, design.road, design.criteria, design.contacts
    classes, seasons = design.traffic.classes, design.climate.seasons
    for criterion in criteria:
        criterion.depth(road)
    warm = roads_of(road, criteria, seasons, classes)
    distinct = warm.distinct
    for row in classes:
        check_speed(row, distinct[0].road)
    temperatures = layer_temperatures(road, criteria, seasons)
    states = [state for row in classes for state in states_of(row, tire)]
    touched = len(contacts.missing(states))
    count = Counter(touched + len(classes) * len(distinct), progress)
    solved_before = (0, 0) if earlier is None else (earlier.contacts, earlier.responses)
    threads = how_many(workers)
    with pool_of(threads) as pool:
        contacts.solve(states, distinct[0].road, pool, count)
        by_class = [[contacts.of(state) for state in states_of(row, tire)] for row in classes]
        reach = basin_reach(road.road for roads in warm.by_class for road in roads)
        y = (
            across([contacts_of_class[0] for contacts_of_class in by_class], classes, reach)
            if earlier is None
            else earlier.readings["y"].to_numpy()
        )
        wheels = [
            wheels_of(contacts_of_class, row, y) for contacts_of_class, row in zip(by_class, classes, strict=True)
        ]
        turns = turns_of(wheels)

        # Most turns of most classes are nothing: as the first axis in memory, what is not written takes none.
        shape = (turns + BEHIND, len(criteria), len(classes), len(distinct), len(y))
        values = np.zeros(shape, np.float32).transpose(2, 3, 1, 0, 4)
        changed = set(range(len(classes)))
        if earlier is not None:
            changed = set(pushed_classes(design.traffic))
            roads_at = [warm.where.index(number) for number in range(len(distinct))]
            for number in set(range(len(classes))) - changed:
                values[number] = earlier.evaluated[:, number, roads_at].swapaxes(0, 1)

        def solve_all(rows: Sequence[int], by_road: Sequence[tuple[int, list[int]]]) -> None:
            """Into values, for classes, of roads those criteria; all by number."""
            rows = [row for row in rows if row in changed]
            tasks = [(row, number, numbers) for row in rows for number, numbers in by_road]
            passings = [
                Passing(wheels[row], warm.by_class[row][number].reading(numbers), y, turns, reach)
                for row, number, numbers in tasks
            ]
            for task, read in stream_passings(passings, pool, count, threads):
                row, number, numbers = tasks[task]
                for k, passage in zip(numbers, read, strict=True):
                    filled = passage.any(axis=1)
                    values[row, number, k, filled] = passage[filled]

        heaviest = int(np.argmax([row.wheel_load for row in classes]))
        lighter = [row for row in range(len(classes)) if row != heaviest and row in changed]
        solve_all([heaviest], [(number, list(range(len(criteria)))) for number in range(len(distinct))])
        warmths = [warmth_of(seasons, [road.road for road in roads]) for roads in warm.by_class]
        warmth, laws = warmths[heaviest], laws_of(warm, temperatures)
        kept, errors = [], []
        for k, criterion in enumerate(criteria):
            wander = wander_of(criterion.law_at(temperatures[k, 0]), design.traffic)
            pilot, step = values[heaviest, :, k, :turns], float(y[1] - y[0])
            yearly = partial(_yearly, laws=laws[k][heaviest], where=warm.where, seasons=seasons)
            # Roads below a weather differ in several ways: holding their sum as close would ask for most of them.
            single = warmth is not None and warmth.ndim == 1
            chosen, error = nodes(warmth, pilot, design.tolerance, wander, step, yearly if single else None)
            kept.append(chosen)
            errors.append(error)
        by_road = [(n, [k for k, chosen in enumerate(kept) if n in chosen]) for n in sorted(set().union(*kept))]
        count.total = touched + (heaviest in changed) * len(distinct) + len(lighter) * len(by_road)
        if lighter:
            solve_all(lighter, by_road)
            for k, chosen in enumerate(kept):
                if len(chosen) < len(distinct):
                    for number in lighter:
                        rest = values[number, chosen, k]
                        filled: BoolArray = np.any(rest, axis=(0, 2))
                        read = over_the_climate(
                            warmths[number], chosen, rest[None, :, filled], int(filled[:turns].sum())
                        )
                        values[number, :, k, filled] = read[0].swapaxes(0, 1)
    # (criterion, axle_class, season, turn, y), with the crack behind the turns.
    each = values if warm.where == tuple(range(len(distinct))) else values[:, warm.where]
    everything = each.transpose(2, 0, 1, 3, 4)
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
        everything[:, :, :, turns + ANGLE],
        everything[:, :, :, turns + DIP],
        everything[:, :, :, turns + DEPTH],
        temperatures,
        solved_before[0] + touched,
        solved_before[1] + count.total - touched,
        max(errors),
        max(wheel.moved for wheel in wheels),
        reach,
        tuple(wheels),
        laws,
        everything,
        tuple(f"{wheel.name}: {text}" for wheel in wheels for text in overlapping(wheel.loads))
        + road_caveats(distinct[0].road)
        + bond_caveats(criteria, distinct, wheels)
        + tuple(dict.fromkeys(text for road in distinct if (text := too_wide(road.road))))
        + _on_the_border(readings, everything[:, :, :, turns + BORDER], reach),
    )


def _on_the_border(readings: xr.DataArray, border: Array, reach: float) -> tuple[str, ...]:
    """Sentences on criteria whose largest reading lies at the end of what was solved; border as readings, 0 or 1."""
    largest = readings.to_numpy()[:, :, :, 0]
    worst = largest.argmax(axis=-1)[..., None]
    most = np.take_along_axis(largest, worst, axis=-1)[..., 0]
    ends = (np.take_along_axis(border, worst, axis=-1)[..., 0] > 0) & (most > 0)
    names, classes = readings["criterion"].to_numpy(), readings["axle_class"].to_numpy()
    return tuple(
        f"{names[k]}: the largest evaluated value under {', '.join(map(str, classes[row.any(axis=1)]))} lies at the "
        f"end of the field that was solved, {reach:g} m around the wheels, so that a larger one may lie beyond"
        for k, row in enumerate(ends)
        if row.any()
    )


def _yearly(readings: Array, laws: Sequence[FatigueLaw], where: Sequence[int], seasons: Sequence[Season]) -> Array:
    """Damage of a passage (road, y), by the shares of the seasons, from readings (road, turn, y) of one class.

    laws: by season. where: the road of each season, by number.
    """
    damage = np.zeros((len(readings), readings.shape[2]))
    for road, law, season in zip(where, laws, seasons, strict=True):
        damage[road] += season.share * harm_of(law, np.maximum(readings[road], 0.0))
    return damage
