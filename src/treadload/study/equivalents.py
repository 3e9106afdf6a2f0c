"""What a practitioner asks of a life: its classes in standard axles, and its climate as one temperature."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import xarray as xr
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq

from treadload import variables
from treadload.composing import BaseResult, Holds
from treadload.damage.laws.equivalence import GROUP_FACTORS, StandardAxle
from treadload.damage.laws.fatigue import FatigueLaw
from treadload.damage.miner import Life
from treadload.damage.traffic import AxleClass
from treadload.describing import first_line
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.pavement import Pavement
from treadload.response import GridLoad
from treadload.study.contacts import Counter
from treadload.study.passage import Passing, solve_passings
from treadload.study.seasons import warmed
from treadload.study.threads import pool_of
from treadload.study.wheels import Wheels

# Loads of the axles of both conventions by load alone, N.
_FRENCH, _AMERICAN = 130e3, 80e3
# Powers by convention: of French bituminous layers and of the AASHO road test; from memory, not verified in a source.
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
    """

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

    def summary(self) -> str:
        """A table of the classes in standard axles, and the equivalent temperatures."""
        data = self.dataset
        names = [str(name) for name in data["criterion"].to_numpy()]
        wide = max(22, *(len(str(name)) + 2 for name in data["axle_class"].to_numpy()))
        columns = [*(name[:20] for name in names), "(P/130)⁵ K", "(P/80)⁴"]
        lines = [
            f"one passage in standard axles of {data.attrs['standard_axle']}, each at its own worst place;",
            "by load alone: French (P/130 kN)⁵ with K of the group, and axles of 80 kN by the fourth power",
            "  " + " " * wide + "".join(f"{one:>22s}" for one in columns),
        ]
        for k, name in enumerate(data["axle_class"].to_numpy()):
            row = [*data["standard_axles"].to_numpy()[:, k], float(data["french_axles"][k])]
            cells = [_axles(float(value)) for value in (*row, float(data["single_axle_loads"][k]))]
            lines.append(f"  {name!s:{wide}s}" + "".join(f"{cell:>22s}" for cell in cells))
        mean = [_axles(float(value)) for value in data["mean_standard_axles"].to_numpy()]
        lines.append(f"  {'mean of the traffic':{wide}s}" + "".join(f"{cell:>22s}" for cell in mean))
        if float(data["standard_axles"].max()) > _MOST:
            lines.append(f"> {_MOST:g}: uniform discs hardly do that damage, so that axles of them say nothing of it")
        warm = data["equivalent_temperature"].to_numpy()
        readings = json.loads(data.attrs["readings"])
        told = [
            f"{name} {warmth:.1f} °C ({reading})"
            for name, warmth, reading in zip(names, warm, readings, strict=True)
            if math.isfinite(warmth)
        ]
        if told:
            lines.append(f"equivalent temperature by Miner's sum: \n  {f'{chr(10)}  '.join(told)}")
        governing = str(data.attrs["governing"])
        at = warm[names.index(governing)] if governing in names else math.nan
        if math.isfinite(at):
            pairs = zip(names, *(data[one].to_numpy() for one in ("years_at_equivalent", "life_years")), strict=True)
            lines.append(f"with the {at:.1f} °C of {governing} all year, and by the full sum:")
            lines += [f"  {name}: {_short(one)} and {_short(full)} years" for name, one, full in pairs]
        return "\n".join(lines)

    __repr__ = first_line


def life_equivalents(road: Pavement, life: Life, *, workers: int | None = None) -> Equivalents:
    """Standard axles of the classes of a life, and equivalent temperatures of its climate.

    The standard axle is that of the life's traffic, see `StandardAxle`. road: that of the life; materials may depend
    on temperature. workers: threads; all cores if left out. One response under the standard axle is solved for each
    season that does most of the damage by a criterion; temperatures need none: the damage of the seasons is
    interpolated over them.
    """
    readings, shares = life.readings.to_numpy(), life.dataset["damage_share"].to_numpy()
    classes = life.traffic.classes
    seasons = [int(part.sum(axis=0).argmax()) for part in shares]
    harm = _of_the_axle(road, life, sorted(set(seasons)), workers)
    standard = np.full(shares.shape[:2], np.nan)
    for k, season in enumerate(seasons):
        laws = [row[season] for row in life.class_laws[k]]
        alone = _harm(life.laws[k][season], harm[season][k, :1])
        if alone > 0:
            standard[k] = [_harm(law, readings[k, n, season]) / alone for n, law in enumerate(laws)]
    loads = [_axle_load(row) for row in classes]
    axles = np.array([len({x for x, _ in row.wheels}) for row in classes])
    factors = np.array([GROUP_FACTORS["bituminous"].get(int(count), math.nan) for count in axles])
    warmth, reading, years = _temperatures(life)
    words = [
        one.quantity.in_words(float(value)) if math.isfinite(value) else ""
        for one, value in zip(life.criteria, reading, strict=True)
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
    names = {"criterion": [one.name for one in life.criteria], "axle_class": [row.name for row in classes]}
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
    """What the criteria read (criterion, 3, y) under the standard axle, by season."""
    y = life.readings["y"].to_numpy()
    speed = next((row.speed for row in life.traffic.classes if row.speed is not None), None)
    wheels = _dual(life.traffic.standard_axle, y, speed)
    tasks = [Passing(wheels, warmed(road, life.criteria, life.climate.seasons[one]), y, 1) for one in seasons]
    with pool_of(workers) as pool:
        return dict(zip(seasons, solve_passings(tasks, pool, Counter(len(tasks), None)), strict=True))


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


def _harm(law: FatigueLaw, turns: Array) -> float:
    """Damage of one passage at its worst place, from peaks and valleys (turn, y)."""
    sign = np.where(np.arange(len(turns)) % 2, -1.0, 1.0)[:, None]
    return float(max((sign / np.asarray(law.allowable_passes(turns))).sum(axis=0).max(), 0.0))


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
    degrees = np.array([one.temperature if isinstance(one.temperature, float | int) else np.nan for one in seasons])
    parts = np.array([one.share for one in seasons])
    known, first = np.unique(degrees, return_index=True)
    shares = life.dataset["damage_share"].to_numpy().sum(axis=1)
    if np.isnan(degrees).any() or len(known) < 2 or not (parts[first] > 0).all():
        return warmth, reading, years
    # The damage of a year at each temperature over that of the climate, at the worst place of the climate.
    rates = shares[:, first] / parts[first]
    curves = [PchipInterpolator(known, np.log(row)) if (row > 0).all() else None for row in rates]
    largest = life.readings.to_numpy().max(axis=(1, 3, 4))[:, first]
    for k, curve in enumerate(curves):
        if curve is not None:
            warmth[k] = _root(curve, known, float(shares[k] @ degrees))
            reading[k] = math.exp(PchipInterpolator(known, np.log(largest[k]))(warmth[k]))
    at = warmth[[one.name for one in life.criteria].index(life.governing_criterion)]
    passes = life.dataset["life_passes"].to_numpy()
    for k, curve in enumerate(curves):
        if curve is not None and math.isfinite(at):
            years[k] = life.traffic.years_to(float(passes[k] / math.exp(curve(at))))
    return warmth, reading, years


def _root(curve: PchipInterpolator, known: Array, near: float) -> float:
    """Temperature at which the damage is that of the climate; of several the nearest to its mean by damage.

    The mean of a climate lies between its least and its largest season, so that there is one.
    """
    values = curve(known)
    found = [
        float(brentq(curve, low, high)) if before != 0 else float(low)
        for low, high, before, after in zip(known[:-1], known[1:], values[:-1], values[1:], strict=True)
        if before * after <= 0
    ]
    return min(found, key=lambda one: abs(one - near))


def _short(value: float) -> str:
    return "–" if math.isnan(value) else "no end" if math.isinf(value) else f"{value:.3g}"


def _axles(value: float) -> str:
    """A number of standard axles; none that means something where their discs hardly do that damage."""
    return f"> {_MOST:g}" if _MOST < value < math.inf else _short(value)
