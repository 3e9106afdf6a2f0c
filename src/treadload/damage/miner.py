"""Miner's sum: the damage of a mixed traffic over a year, across the wheel path, for every criterion."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from treadload import variables
from treadload.damage.climate import MONTHS, Climate
from treadload.damage.cracks import OBLIQUE_TOLERANCE, ORIENTATIONS, orientation
from treadload.damage.criterion import Criterion
from treadload.damage.cycles import harm_of
from treadload.damage.laws.fatigue import FatigueLaw
from treadload.damage.life import Life
from treadload.damage.thermal import DailyCycles, years_until
from treadload.damage.traffic import Traffic, Wander
from treadload.damage.words import (
    cautions,
    criteria_attributes,
)
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels.arrays import Array, Reals
from treadload.kernels.largest import index_of_largest


def miner(
    readings: xr.DataArray | Array,
    criteria: Sequence[Criterion],
    traffic: Traffic,
    climate: Climate,
    *,
    y: Array | None = None,
    layer_temperatures: Array | None = None,
    cracks: tuple[Array, Array] | None = None,
    laws: Sequence[Sequence[Sequence[FatigueLaw]]] | None = None,
    weather: DailyCycles | None = None,
) -> Life:
    """Life of a road by Miner's sum, D = Σ n / N, over classes of axles and seasons, after wander.

    readings: (criterion, axle_class, season, y), what each criterion's law reads as a wheel passes, in the order of
    criteria, traffic.classes and climate.seasons; one cycle per passage. Or (criterion, axle_class, season, turn, y):
    peak, valley, peak, ... of a group of axles, zeros behind the last; a valley takes back what the rise to the next
    peak does not do again, D = Σ 1/N(peak) - Σ 1/N(valley). y: evenly spaced, m; left out, the coordinate of
    readings. layer_temperatures: (criterion, season), °C, for laws that depend on it; left out, the seasons' one
    temperature. cracks: angle of the trace and dip, rad, (criterion, axle_class, season, y), NaN for none. laws:
    (criterion, axle_class, season), where they hold for the moduli that classes meet; left out, those of
    layer_temperatures. weather: the days' own cycles, which do not grow with the traffic and load the whole width
    alike. Wander
    counts for laws that do not include it (`includes_wander`); with those that do, such as the French ones whose k_c
    was fitted to roads on which wheels wander, it would count twice: a warning gives both lives. The years are those
    after which the damage at the worst place is 1. Raises InputError for wrong shapes.

    >>> axle = tl.damage.AxleClass("axle", 1.0, wheel_load=32.5e3, inflation_pressure=820e3)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e5), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> life = tl.damage.miner([[[[90e-6, 120e-6, 90e-6]]]], [base], traffic, climate, y=[-0.1, 0.0, 0.1])
    >>> f"{life.years('base'):.0f} years"  # a million passes at 120 microstrain, 100 000 a year
    '10 years'
    """
    values = np.asarray(readings)
    # Single numbers stay: of many classes and seasons they are most of what a life keeps.
    values = values if values.dtype == np.float32 else np.asarray(values, dtype=float)
    expected = (len(criteria), len(traffic.classes), len(climate.seasons))
    if values.ndim not in (4, 5) or values.shape[:3] != expected:
        raise InputError(
            f"readings must be (criterion, axle_class, season, y) = {expected} and y, got {values.shape}"
        )
    if values.ndim == 4:
        values = values[:, :, :, None]
    at = np.asarray(readings["y"] if y is None and isinstance(readings, xr.DataArray) else y, dtype=float)
    if at.shape != (values.shape[-1],) or len(at) < 2 or np.ptp(np.diff(at)) > 1e-6 * abs(at[1] - at[0]):
        raise InputError(f"y must be {values.shape[-1]} evenly spaced values in m, got shape {at.shape}")
    if layer_temperatures is None:
        if any(len(season.temperatures) > 1 for season in climate.seasons):
            raise InputError("seasons with several temperatures need layer_temperatures (criterion, season)")
        temperatures = [season.temperatures[0] for season in climate.seasons]
        layer_temperatures = np.tile(temperatures, (len(criteria), 1))
    if laws is None:
        warm = zip(criteria, layer_temperatures, strict=True)
        laws = [[[c.law_at(float(t)) for t in row]] * len(traffic.classes) for c, row in warm]
    damage = damage_of(values, laws, traffic, climate)
    spacing = float(at[1] - at[0])
    still = damage.sum(axis=(1, 2))
    wandering = traffic.wander.spread(still, spacing)
    margin = (wandering.shape[-1] - len(at)) // 2
    wide = at[0] + spacing * (np.arange(wandering.shape[-1]) - margin)
    still = np.pad(still, [(0, 0), (margin, margin)])
    firsts = [row[0][0] for row in laws]
    wanders = [wander_of(passage, traffic) for passage in firsts]
    yearly = np.where([[wander != traffic.wander] for wander in wanders], still, wandering)
    worst = np.array(
        [_worst(yearly_damage, read, margin) for yearly_damage, read in zip(yearly, values, strict=True)]
    )
    busy = np.take_along_axis(yearly, worst[:, None], axis=-1)[:, 0]
    days = np.zeros(len(criteria)) if weather is None else weather.yearly
    peak = busy + days
    # Where the spread damage of a criterion is worst, in its columns.
    columns = [
        int(column) - (0 if wander == traffic.wander else margin)
        for column, wander in zip(worst, wanders, strict=True)
    ]
    here = [
        _over(wander.spread_at(part, spacing, column), top)
        for wander, part, column, top in zip(wanders, damage, columns, peak, strict=True)
    ]
    shares = np.stack(here)
    with np.errstate(divide="ignore", invalid="ignore"):
        passes = np.where(peak > 0, traffic.passes_per_year / peak, math.inf)
    years = [traffic.years_to(float(count)) for count in passes]
    for k in np.flatnonzero(days):
        years[k] = years_until(traffic, float(busy[k]), float(days[k]))
        passes[k] = traffic.passes(years[k])
    names = [criterion.name for criterion in criteria]

    def years_of(part: Array) -> list[float]:
        return [years_until(traffic, float(top), float(w)) for top, w in zip(part.max(axis=-1), days, strict=True)]

    fields: dict[str, tuple[tuple[str, ...], Any]] = {
        "damage_per_year": (("criterion", "y"), yearly + days[:, None]),
        "damage_share": (("criterion", "axle_class", "season"), shares),
        "life_years": (("criterion",), years),
        "life_passes": (("criterion",), passes),
        "worst_y": (("criterion",), wide[worst]),
        "largest_reading": (("criterion",), values.max(axis=(1, 2, 3, 4))),
        "class_reading": (("criterion", "axle_class", "season"), values.max(axis=(3, 4))),
        "design_utilisation": (
            ("criterion",),
            [_utilisation(row, read, traffic) for row, read in zip(laws, values, strict=True)],
        ),
    }
    if weather is not None:
        over = np.where(peak > 0, peak, 1.0)[:, None]
        fields["weather_share"] = (("criterion", "month"), weather.damage / over)
        fields["weather_reading"] = (("criterion", "month"), weather.readings)
        fields["weather_stress"] = (("criterion", "month"), weather.stress)
        used = np.maximum(fields["design_utilisation"][1], weather.utilisation)
        fields["design_utilisation"] = (("criterion",), used)
    coordinates = {
        "criterion": names,
        "axle_class": [row.name for row in traffic.classes],
        "season": [season.name for season in climate.seasons],
        "y": wide,
    }
    if weather is not None:
        coordinates["month"] = np.arange(1, len(MONTHS) + 1)
    if traffic.wander.reach:
        fields["life_years_without_wander"] = (("criterion",), years_of(still))
        fields["life_years_with_wander"] = (("criterion",), years_of(wandering))
    if traffic.years is not None:
        growth = traffic.growth_factor(traffic.years)
        fields["design_damage"] = (("criterion",), busy * growth + days * traffic.years)
    if cracks is not None:
        fields |= _cracks(damage, cracks, wanders, spacing, columns, peak)
        coordinates["orientation"] = list(ORIENTATIONS)
    dataset = variables.dataset(
        fields,
        coordinates,
        passes_per_year=traffic.passes_per_year,
        growth=traffic.growth,
        growth_kind=traffic.kind,
        **({"growth_years": traffic.grows_for} if math.isfinite(traffic.grows_for) else {}),
        wander=str(traffic.wander),
        **({} if traffic.years is None else {"design_years": traffic.years}),
        **criteria_attributes(criteria, firsts),
    )
    twice = [wander != traffic.wander for wander in wanders]
    caveats = cautions(dataset, criteria, laws, values, shares, twice)
    dims = ("criterion", "axle_class", "season", "turn", "y")
    places = {name: coordinates[name] for name in ("criterion", "axle_class", "season")}
    kept = xr.DataArray(values, dims=dims, coords={**places, "y": at})
    return Life(
        dataset,
        tuple(criteria),
        traffic,
        climate,
        kept,
        tuple(tuple(row[0]) for row in laws),
        warnings=caveats,
        by_class=tuple(tuple(map(tuple, row)) for row in laws)
        if any(row[0] != law for row in laws for law in row)
        else (),
    )


def _worst(yearly: Array, readings: Array, margin: int) -> int:
    """Column of the largest damage; where none is done that of the largest reading, margin columns further."""
    if yearly.max() > 0:
        return index_of_largest(yearly)[0]
    return margin + index_of_largest(readings.max(axis=(0, 1, 2)))[0]


def _utilisation(laws: Sequence[Sequence[FatigueLaw]], readings: Array, traffic: Traffic) -> float:
    """Largest reading (axle_class, season, turn, y) over what its law allows for the passes of the design life.

    Of the first year where there is no design life.
    """
    years = traffic.years
    passes = traffic.passes_per_year * (1.0 if years is None else traffic.growth_factor(years))
    if not passes > 0:
        return 0.0
    largest = readings.max(axis=(2, 3))
    return float(
        max(
            value / law.allowable_strain(passes)
            for law_of_row, row in zip(laws, largest, strict=True)
            for law, value in zip(law_of_row, row, strict=True)
        )
    )


def wander_of(law: FatigueLaw, traffic: Traffic) -> Wander:
    """The wander of a traffic that counts with a law: none for a law that includes it."""
    return Wander.none() if law.includes_wander else traffic.wander


def damage_of(
    readings: Array, laws: Sequence[Sequence[Sequence[FatigueLaw]]], traffic: Traffic, climate: Climate
) -> Array:
    """Damage of the first year (criterion, axle_class, season, y), without wander, from readings with turns.

    laws: one for each criterion, class of axles and season.
    """
    cycles = (
        traffic.passes_per_year
        * np.array([row.share for row in traffic.classes])[:, None]
        * np.array([season.share for season in climate.seasons])
    )
    damage = np.empty(np.delete(readings.shape, 3))
    for k, c in np.ndindex(damage.shape[:2]):
        of_season = laws[k][c]
        # Seasons of one law are evaluated together, which costs less than one after the other.
        for law in {id(law): law for law in of_season}.values():
            seasons = [s for s, season_law in enumerate(of_season) if season_law is law]
            turns = readings[k, c, seasons].swapaxes(0, 1)
            harm = harm_of(law, turns.reshape(len(turns), -1)).reshape(len(seasons), -1)
            damage[k, c, seasons] = cycles[c, seasons, None] * harm
    return damage


def passes_in_two_phases(before: Array, after: Array, change: float) -> Array:
    """Passes until Miner's sum is 1 where the road changes on the way: n₁ d₁ + (n - n₁) d₂ = 1.

    before, after: d₁ and d₂, damage of a pass, any shape, >= 0. change: n₁, passes until the change, >= 0 or inf.
    What fails before the change does so as if there were none; inf where no damage is done.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        alone = np.where(before > 0, 1 / before, np.inf)
        left = np.where(before > 0, 1 - change * before, 1.0)
        later = change + np.where(after > 0, left / after, np.inf)
    # The place where the change begins has failed by then, round-off or not.
    return np.where(alone <= change * (1 + 1e-12), alone, later)


def _cracks(
    damage: Array,
    cracks: tuple[Array, Array],
    wanders: Sequence[Wander],
    spacing: float,
    columns: Sequence[int],
    peak: Array,
) -> dict[str, tuple[tuple[str, ...], object]]:
    """The first crack of every criterion, and the shares of orientations in the damage at its worst place.

    columns: of the damage after wander at each criterion's worst y, as `Wander.spread_at` counts them.
    """
    shares = np.zeros((len(damage), len(ORIENTATIONS)))
    first = np.empty((2, len(damage)))
    for k, (share, column, top) in enumerate(zip(damage, columns, peak, strict=True)):
        # One criterion at a time: of many classes and seasons these arrays are large.
        angle, dip = (np.asarray(part[k], dtype=float) for part in cracks)
        codes = orientation(angle, dip, OBLIQUE_TOLERANCE)
        for code in range(len(ORIENTATIONS)):
            part = np.where(codes == code, share, 0.0).sum(axis=(0, 1))
            shares[k, code] = _over(float(wanders[k].spread_at(part, spacing, column)), top)
        most = np.unravel_index(int(share.argmax()), share.shape)
        first[:, k] = angle[most], dip[most]
    return {
        "first_crack_angle": (("criterion",), first[0]),
        "first_crack_dip": (("criterion",), first[1]),
        "orientation_damage": (("criterion", "orientation"), shares),
    }


def _over(part: Reals, whole: float) -> Reals:
    return part / whole if whole > 0 else np.zeros_like(part)
