"""Miner's sum: the damage of a mixed traffic over a year, across the wheel path, for every criterion."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from treadload import variables
from treadload.citations import SOLVED_WHOLE
from treadload.composing import BaseResult, Columns, Holds
from treadload.damage.climate import MONTHS, Climate
from treadload.damage.cracks import OBLIQUE_TOLERANCE, ORIENTATIONS, orientation
from treadload.damage.criterion import Criterion
from treadload.damage.cycles import harm_of
from treadload.damage.laws.equivalence import growth_factor
from treadload.damage.laws.fatigue import FatigueLaw
from treadload.damage.thermal import DailyCycles, years_until
from treadload.damage.traffic import Traffic, Wander
from treadload.damage.words import (
    OF_SENSITIVITY,
    PER_CRITERION,
    RUT,
    STEEPEST,
    cautions,
    check_life,
    criteria_attributes,
    heading_of,
    life_rows,
    verdict_in_words,
)
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.kernels.largest import index_of_largest
from treadload.rows import Row, row


@dataclass(frozen=True, eq=False)
class Life(BaseResult, group="life"):
    """How long a road lasts under a traffic.

    dataset: damage_per_year (criterion, y), of the first year, with wander unless the criterion's law includes it;
    damage_share (criterion, axle_class, season) of it at the worst y; life_years, life_passes, worst_y,
    largest_reading (criterion) and its design_utilisation, over what the law allows for all passes of the design
    life, or of the first year without one; class_reading (criterion, axle_class, season), the largest of
    each; where the traffic wanders, life_years_without_wander and
    life_years_with_wander, whichever the law takes; with a design life design_damage; with cracks
    first_crack_angle, first_crack_dip
    (criterion), of the class and season that do most, and orientation_damage (criterion, orientation); below a
    weather day_temperature (month, hour, profile_depth); where daily thermal stress counts weather_share,
    weather_reading, weather_stress (criterion, month) and day_tension (month, profile_depth), damage_share being the
    traffic's in the whole; where courses are divided sublayer_modulus and
    sublayer_temperature (season, sublayer), with ageing sublayer_modulus_young; with rutting
    rut_depth (rut_layer, year), and rut_names, rut_limit and rut_years in its attributes. criteria,
    traffic, climate: what was asked. readings, laws: behind the sum, see `miner`, a law for each criterion and
    season, of the first class of axles. by_class: (criterion, axle_class, season), where classes meet other moduli.
    stats: solves and errors behind the readings. warnings: sentences for the user.
    """

    columns: ClassVar[Columns] = Columns()
    title: ClassVar[str] = "Service life"
    subject: ClassVar[str] = "How long a road lasts"
    holds: ClassVar[Holds] = Holds(
        {
            "life_years life_passes worst_y largest_reading": "criterion",
            "damage_share": "criterion axle_class season",
        },
        maybe={
            "day_temperature": "month hour profile_depth",
            "month": "month",
            "hour": "hour",
            "profile_depth": "profile_depth",
            "sublayer_top sublayer_bottom sublayer_layer": "sublayer",
            "sublayer_temperature sublayer_modulus sublayer_modulus_young": "season sublayer",
            "rut_depth": "rut_layer year",
            "rut_layer": "rut_layer",
            "year": "year",
            "weather_share weather_reading weather_stress": "criterion month",
            "day_tension": "month profile_depth",
            "damage_per_year": "criterion y",
            "design_damage design_utilisation first_crack_angle first_crack_dip read_depth": "criterion",
            "orientation_damage": "criterion orientation",
            "elasticity": "input",
        },
        finite="damage_per_year damage_share worst_y largest_reading design_damage design_utilisation "
        "orientation_damage elasticity",
        largest={"elasticity": STEEPEST},
        above_zero="life_years life_passes",
        with_it={
            "damage_per_year": "y",
            "damage_share": "season",
            "orientation": "orientation_damage",
            "orientation_damage": "first_crack_angle",
            "elasticity": "input",
        },
        maybe_numbers=f"design_years {' '.join(OF_SENSITIVITY)}",
        positive="design_years",
        json={"stats": dict, **dict.fromkeys(PER_CRITERION, list), "ends": list, "groups": list},
        tree="criterion life_years life_passes worst_y largest_reading",
        agree=lambda data: check_life(data),
        labels={"criterion": "criterion", "axle_class": "axle_class", "season": "season"},
        each={"criterion": "criteria"},
        stats=("contacts responses combinations interpolation_error",),
    )

    dataset: xr.Dataset
    criteria: tuple[Criterion, ...]
    traffic: Traffic
    climate: Climate
    readings: xr.DataArray
    laws: tuple[tuple[FatigueLaw, ...], ...]
    stats: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    by_class: tuple[tuple[tuple[FatigueLaw, ...], ...], ...] = ()

    def cites(self) -> tuple[str, ...]:
        """Methods of the contacts and responses, and of the sum."""
        return (*SOLVED_WHOLE, "miner")

    @property
    def class_laws(self) -> tuple[tuple[tuple[FatigueLaw, ...], ...], ...]:
        """A law for each criterion, class of axles and season."""
        return self.by_class or tuple((row,) * len(self.traffic.classes) for row in self.laws)

    @property
    def governing(self) -> str:
        """What ends the road first: the name of a criterion, or `RUT`, its rut at the limit."""
        first = self.governing_criterion
        return RUT if self.rut_years < self.years(first) else first

    @property
    def rut_years(self) -> float:
        """Years from the opening until the rut is as deep as its limit; inf if never, or where none is counted."""
        return float(self.dataset.attrs.get("rut_years", math.inf))

    @property
    def governing_criterion(self) -> str:
        """Name of the criterion that fails first, whatever the rut."""
        return str(self.dataset["criterion"].to_numpy()[int(np.argmin(self.dataset["life_years"].to_numpy()))])

    def years(self, criterion: str) -> float:
        """Years from the opening until a criterion's damage is 1 at its worst place, or of `RUT`; inf if never."""
        if criterion == RUT:
            return self.rut_years
        return float(self.dataset["life_years"].sel(criterion=criterion))

    def weather_damage(self, number: int) -> float:
        """Damage of a year that daily thermal stress does by a criterion, by its number."""
        if "weather_share" not in self.dataset:
            return 0.0
        share = float(self.dataset["weather_share"][number].sum())
        return share * float(self.dataset["damage_per_year"][number].max())

    @property
    def heading(self) -> str:
        """Traffic and climate."""
        return heading_of(self.traffic, self.climate)

    def rows(self) -> tuple[Row, ...]:
        """Every criterion with what does most of its damage, the rut, what governs, and the verdict."""
        years = self.years(self.governing)
        rows = life_rows(self.dataset, self.criteria, self.traffic)
        if self.stats:
            solved = (
                "{contacts} contacts and {responses} responses for {combinations} combinations; interpolation over "
                "the climate changes the damage by no more than an error of {interpolation_error:.1g} of the largest "
                "evaluated value".format(**self.stats)
            )
            rows.append(row("solved", solved))
        return (
            *rows,
            row("governing", self.governing),
            row("governing_years", years),
            row("verdict", verdict_in_words(self.dataset, self.governing, years)),
        )


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
        growth = growth_factor(traffic.years, traffic.growth, traffic.kind)
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
    passes = traffic.passes_per_year * (1.0 if years is None else growth_factor(years, traffic.growth, traffic.kind))
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
    for (k, c, s), cycle in np.ndenumerate(np.broadcast_to(cycles, damage.shape[:3])):
        damage[k, c, s] = cycle * harm_of(laws[k][c][s], readings[k, c, s])
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
    angle, dip = (np.asarray(part, dtype=float) for part in cracks)
    codes = orientation(angle, dip, OBLIQUE_TOLERANCE)
    shares = np.zeros((len(damage), len(ORIENTATIONS)))
    first = np.empty((2, len(damage)))
    for k, (share, column, top) in enumerate(zip(damage, columns, peak, strict=True)):
        for code in range(len(ORIENTATIONS)):
            part = np.where(codes[k] == code, share, 0.0).sum(axis=(0, 1))
            shares[k, code] = _over(float(wanders[k].spread_at(part, spacing, column)), top)
        most = np.unravel_index(int(share.argmax()), share.shape)
        first[:, k] = angle[k][most], dip[k][most]
    return {
        "first_crack_angle": (("criterion",), first[0]),
        "first_crack_dip": (("criterion",), first[1]),
        "orientation_damage": (("criterion", "orientation"), shares),
    }


def _over(part: Any, whole: float) -> Any:
    return part / whole if whole > 0 else np.zeros_like(part)
