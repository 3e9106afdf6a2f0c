"""What a practitioner asks of a life: its classes in standard axles, and its climate as one temperature."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import scipy

from treadload import variables
from treadload.composing import BaseResult, Holds
from treadload.damage.cycles import harm_of
from treadload.damage.laws.equivalence import GROUP_FACTORS, StandardAxle
from treadload.damage.life import Life
from treadload.damage.traffic import AxleClass
from treadload.deferred import xarray as xr
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.life.contacts import Counter
from treadload.life.design import Design
from treadload.life.passage import Passing, solve_passings, turns_of
from treadload.life.seasons import warmed
from treadload.life.threads import pool_of
from treadload.life.wheels import Wheels
from treadload.pavement import Pavement
from treadload.response import GridLoad
from treadload.response.basin import basin_reach
from treadload.rows import Row, row
from treadload.variables import Display, display_of

# Loads of the axles of both conventions by load alone, N.
_FRENCH, _AMERICAN = 130e3, 80e3
# Powers by convention: of French bituminous layers, as commonly quoted, not checked against the source; and of the
# AASHO road test, whose equation implies the fourth power (Addis, Vehicle wheel loads and road pavement wear).
_FRENCH_POWER, _FOURTH = 5.0, 4.0
# Part of a cell that a disc covers is counted on so many points a side; cells, m, that stand for the disc at least.
_POINTS, _CELL = 8, 6e-3
# Wheels further apart than this, m, are those of both ends of an axle.
_BOTH_ENDS = 1.0
# Standard axles beyond which their own damage is next to none.
_MOST = 1000.0


@dataclass(frozen=True, eq=False)
class Equivalents(BaseResult, group="equivalents"):
    """A traffic in standard axles, and a climate as one temperature, by every criterion of a life.

    dataset: standard_axles (criterion, axle_class), passes of the standard axle of the traffic that do as much as one
    passage of a class, each at its own worst place, in the season that does most; attributes standard_axle and
    standard_axle_load, N, describe that axle. mean_standard_axles (criterion) over the traffic; french_axles and
    single_axle_loads (axle_class), the same by conventions that know loads alone; axle_load, axles (axle_class).
    equivalent_temperature, equivalent_reading (criterion): at which the damage of a year of one temperature is that
    of the climate, and the reading there; NaN for a climate without several temperatures. years_at_equivalent
    (criterion): at the equivalent temperature of the governing criterion all year round, beside life_years
    (criterion), the full sum.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> asphalt, soil = tl.Layer(tl.Elastic(5e9, 0.35), 0.03, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> design = tl.Design(tire, tl.Pavement([asphalt, soil]), traffic, climate, [base], spacing=0.01)
    >>> life = tl.solve_life(design)
    >>> equivalents = tl.life.life_equivalents(design, life)
    >>> f"standard axle of {equivalents.dataset.attrs['standard_axle_load'] / 1e3:.0f} kN"
    'standard axle of 130 kN'
    """

    title: ClassVar[str] = "Standard axles"
    subject: ClassVar[str] = "A traffic in standard axles"
    holds: ClassVar[Holds] = Holds(
        {
            "standard_axles": "criterion axle_class",
            "mean_standard_axles equivalent_temperature equivalent_reading": "criterion",
            "years_at_equivalent life_years": "criterion",
            "french_axles single_axle_loads axle_load axles": "axle_class",
        },
        labels={"criterion": "criterion", "axle_class": "axle_class"},
        texts="governing standard_axle",
        numbers="standard_axle_load",
        lists="readings",
    )

    dataset: xr.Dataset

    @property
    def heading(self) -> str:
        """The standard axle."""
        axle = self.dataset.attrs["standard_axle"]
        return f"standard axles of {axle} that do as much damage as one passage, each at its own worst place"

    def rows(self) -> tuple[Row, ...]:
        """Classes in standard axles by criterion and by load alone; equivalent temperatures and service lives."""
        data = self.dataset
        names = [str(name) for name in data["criterion"].to_numpy()]
        classes = [str(name) for name in data["axle_class"].to_numpy()]
        alone = ("french_axles", "single_axle_loads")
        counts = [
            (name, data["standard_axles"][:, k], [float(data[key][k]) for key in alone])
            for k, name in enumerate(classes)
        ]
        counts.append(("mean of the traffic", data["mean_standard_axles"], [math.nan, math.nan]))
        rows = []
        for group, by_criterion, by_load in counts:
            rows += [
                row("standard_axles", value, group=group, display=Display(name, "", _axles))
                for name, value in zip(names, by_criterion, strict=True)
            ]
            rows += [
                row(key, value, group=group, display=Display(display_of(key).label, "", _axles))
                for key, value in zip(alone, by_load, strict=True)
            ]
        if float(data["standard_axles"].max()) > _MOST:
            rows.append(row("standard_axles", f"> {_MOST:g}: uniform discs hardly do that damage", label="remark"))
        readings = json.loads(data.attrs["readings"])
        for k, (name, reading) in enumerate(zip(names, readings, strict=True)):
            if math.isfinite(float(data["equivalent_temperature"][k])):
                rows += [
                    row("equivalent_temperature", data["equivalent_temperature"][k], group=name),
                    row("equivalent_reading", reading, group=name),
                    row("years_at_equivalent", data["years_at_equivalent"][k], group=name),
                    row("life_years", data["life_years"][k], group=name),
                ]
        governing = str(data.attrs["governing"])
        at = float(data["equivalent_temperature"][names.index(governing)]) if governing in names else math.nan
        if math.isfinite(at):
            rows.append(row("years_at_equivalent", f"at the {at:.1f} °C of {governing} all year"))
        return tuple(rows)


def life_equivalents(design: Design, life: Life, *, workers: int | None = None) -> Equivalents:
    """Standard axles of the classes of a life, and equivalent temperatures of its climate.

    The standard axle is that of the life's traffic, see `StandardAxle`. life: of the design. workers: threads; all
    cores if left out. One response under the standard axle is solved for each season that does most damage by a
    criterion; temperatures need none: the damage of the seasons is interpolated over them.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> asphalt, soil = tl.Layer(tl.Elastic(5e9, 0.35), 0.03, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> design = tl.Design(tire, tl.Pavement([asphalt, soil]), traffic, climate, [base], spacing=0.01)
    >>> life = tl.solve_life(design)
    >>> equivalents = tl.life.life_equivalents(design, life)
    >>> f"{equivalents.dataset.single_axle_loads.item():.1e} standard axles by the fourth power of 1 kN over 80 kN"
    '2.4e-08 standard axles by the fourth power of 1 kN over 80 kN'
    """
    readings, shares = life.readings.to_numpy(), life.dataset["damage_share"].to_numpy()
    classes = life.traffic.classes
    seasons = [int(part.sum(axis=0).argmax()) for part in shares]
    harm = _of_the_axle(design.road, life, sorted(set(seasons)), workers)
    standard = np.full(shares.shape[:2], np.nan)
    for k, season in enumerate(seasons):
        laws = [row[season] for row in life.class_laws[k]]
        alone = float(harm_of(life.laws[k][season], harm[season][k]).max())
        if alone > 0:
            standard[k] = [float(harm_of(law, readings[k, n, season]).max()) / alone for n, law in enumerate(laws)]
    loads = [_axle_load(row) for row in classes]
    axles = np.array([len({x for x, _ in row.wheels}) for row in classes])
    factors = np.array([GROUP_FACTORS["bituminous"].get(int(count), math.nan) for count in axles])
    warmth, reading, years = _temperatures(life)
    words = [
        criterion.quantity.in_words(float(value)) if math.isfinite(value) else ""
        for criterion, value in zip(life.criteria, reading, strict=True)
    ]
    part = np.array([row.share for row in classes])
    fields: dict[str, tuple[tuple[str, ...], Any]] = {
        "standard_axles": (("criterion", "axle_class"), standard),
        "mean_standard_axles": (("criterion",), standard @ part),
        "axle_load": (("axle_class",), loads),
        "axles": (("axle_class",), axles),
        "french_axles": (("axle_class",), axles * factors * (np.array(loads) / _FRENCH) ** _FRENCH_POWER),
        "single_axle_loads": (("axle_class",), axles * (np.array(loads) / _AMERICAN) ** _FOURTH),
        "equivalent_temperature": (("criterion",), warmth),
        "equivalent_reading": (("criterion",), reading),
        "years_at_equivalent": (("criterion",), years),
        "life_years": (("criterion",), life.dataset["life_years"].to_numpy()),
    }
    names = {
        "criterion": [criterion.name for criterion in life.criteria],
        "axle_class": [row.name for row in classes],
    }
    return Equivalents(
        variables.dataset(
            fields,
            names,
            governing=life.governing_criterion,
            readings=json.dumps(words, ensure_ascii=False),
            standard_axle=str(life.traffic.standard_axle),
            standard_axle_load=life.traffic.standard_axle.load,
        )
    )


def _of_the_axle(road: Pavement, life: Life, seasons: list[int], workers: int | None) -> dict[int, Array]:
    """What the criteria read (criterion, turn, y) under the standard axle, by season."""
    y = life.readings["y"].to_numpy()
    speed = next((row.speed for row in life.traffic.classes if row.speed is not None), None)
    wheels = _dual(life.traffic.standard_axle, y, speed)
    warm = [warmed(road, life.criteria, life.climate.seasons[season]) for season in seasons]
    turns, reach = turns_of([wheels]), basin_reach(member.road for member in warm)
    tasks = [Passing(wheels, member, y, turns, reach) for member in warm]
    with pool_of(workers) as pool:
        solved = solve_passings(tasks, pool, Counter(len(tasks), None))
    return {season: read[:, :turns] for season, read in zip(seasons, solved, strict=True)}


def _dual(axle: StandardAxle, y: Array, speed: float | None) -> Wheels:
    """One end of the standard axle on the lattice of y, m: two discs whose edges are shared out among the cells."""
    step = float(y[1] - y[0])
    cell = step * max(1, round(_CELL / step))
    half = math.ceil(axle.radius / cell) + 1
    loads = []
    for middle in (-0.5 * axle.spacing, 0.5 * axle.spacing):
        first = round((middle - half * cell - y[0]) / cell)
        grid = Grid(2 * half + 1, 2 * half + 1, cell, cell, -half * cell, float(y[0]) + first * cell)
        fine = (np.arange(_POINTS) + 0.5) / _POINTS - 0.5
        x = (grid.x[:, None] + cell * fine).ravel()
        across = (grid.y[:, None] + cell * fine).ravel() - middle
        inside = (across[:, None] ** 2 + x**2 <= axle.radius**2).reshape(grid.ny, _POINTS, grid.nx, _POINTS)
        part = inside.mean(axis=(1, 3))
        loads.append(GridLoad(grid, part * axle.load / 4 / (part.sum() * cell**2)))
    return Wheels(tuple(loads), loads[0].grid.x[None], speed, "standard axle", 0.0)


def _axle_load(row: AxleClass) -> float:
    """Load of one axle, N: of both its ends, of which a class has one or two."""
    axle = [y for x, y in row.wheels if x == row.wheels[0][0]]
    ends = 1 if np.ptp(axle) > _BOTH_ENDS else 2
    return ends * len(axle) * row.wheel_load


def _temperatures(life: Life) -> tuple[Array, Array, Array]:
    """Equivalent temperature, °C, and reading of every criterion; years at that of the governing one."""
    count = len(life.criteria)
    warmth, reading, years = (np.full(count, np.nan) for _ in range(3))
    seasons = life.climate.seasons
    # A profile over depth, as layers with temperatures of their own, has no one temperature.
    degrees = np.array(
        [season.temperature if isinstance(season.temperature, float | int) else np.nan for season in seasons]
    )
    parts = np.array([season.share for season in seasons])
    distinct, first = np.unique(degrees, return_index=True)
    shares = life.dataset["damage_share"].to_numpy().sum(axis=1)
    if np.isnan(degrees).any() or len(distinct) < 2 or not (parts[first] > 0).all():
        return warmth, reading, years
    # The damage of a year at each temperature over that of the climate, at the worst place of the climate.
    rates = shares[:, first] / parts[first]
    curves = [
        scipy.interpolate.PchipInterpolator(distinct, np.log(row)) if (row > 0).all() else None for row in rates
    ]
    largest = life.readings.to_numpy().max(axis=(1, 3, 4))[:, first]
    for k, curve in enumerate(curves):
        if curve is not None:
            warmth[k] = _root(curve, distinct, float(shares[k] @ degrees))
            reading[k] = math.exp(scipy.interpolate.PchipInterpolator(distinct, np.log(largest[k]))(warmth[k]))
    at = warmth[[criterion.name for criterion in life.criteria].index(life.governing_criterion)]
    passes = life.dataset["life_passes"].to_numpy()
    for k, curve in enumerate(curves):
        if curve is not None and math.isfinite(at):
            years[k] = life.traffic.years_to(float(passes[k] / math.exp(curve(at))))
    return warmth, reading, years


def _root(curve: scipy.interpolate.PchipInterpolator, grid: Array, near: float) -> float:
    """Temperature at which the damage is that of the climate; of several the nearest to its mean by damage.

    The mean of a climate lies between its least and its largest season, so that there is one.
    """
    values = curve(grid)
    roots = [
        float(scipy.optimize.brentq(curve, low, high)) if before != 0 else float(low)
        for low, high, before, after in zip(grid[:-1], grid[1:], values[:-1], values[1:], strict=True)
        if before * after <= 0
    ]
    return min(roots, key=lambda root: abs(root - near))


def _axles(value: float) -> str:
    """A number of standard axles; none that means something where their discs hardly do that damage."""
    return f"> {_MOST:g}" if _MOST < value < math.inf else "–" if math.isnan(value) else f"{value:.3g}"
