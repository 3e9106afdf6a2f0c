"""The life of a road under a traffic: what Miner's sum found, by criterion, place and season."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from treadload.citations import SOLVED_WHOLE
from treadload.composing import BaseResult, Columns, Holds
from treadload.damage.answer import RUT, Answer, life_answer
from treadload.damage.climate import Climate
from treadload.damage.criterion import Criterion
from treadload.damage.laws.fatigue import FatigueLaw
from treadload.damage.traffic import Traffic
from treadload.damage.words import (
    OF_SENSITIVITY,
    PER_CRITERION,
    STEEPEST,
    check_life,
    heading_of,
    life_rows,
)
from treadload.deferred import xarray as xr
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
    (criterion), of the class and season that do most, and orientation_damage (criterion, orientation); of criteria of
    tensile strain at the surface crack_repetitions, crack_place, crack_strain (criterion, direction) and cause_share
    (criterion, cause), see `life.first_crack`, NaN of others; below a
    weather day_temperature (month, hour, profile_depth); where daily thermal stress counts weather_share,
    weather_reading, weather_stress (criterion, month) and day_tension (month, profile_depth), damage_share being the
    traffic's in the whole; where courses are divided sublayer_modulus and
    sublayer_temperature (season, sublayer), with ageing sublayer_modulus_young; where seasons have factors on layers
    season_modulus (season, factored_layer), below a weather with frost frost_depth and thaw_depth (day); of criteria
    of the surface
    life_years_fresh_line and life_years_aged_line, NaN of others, with surface_lines in the attributes; with rutting
    rut_depth (rut_layer, year), and rut_names, rut_limit and rut_years in its attributes. criteria,
    traffic, climate: what was asked. readings, laws: behind the sum, see `miner`, a law for each criterion and
    season, of the first class of axles. by_class: (criterion, axle_class, season), where classes meet other moduli.
    stats: solves and errors behind the readings. warnings: sentences for the user.

    >>> axle = tl.damage.AxleClass("axle", 1.0, wheel_load=32.5e3, inflation_pressure=820e3)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e5), tl.damage.Climate.constant(15.0)
    >>> criteria = [tl.damage.Criterion(name, tl.FatigueLine(120e-6, -0.2), 0, name) for name in ("top", "bottom")]
    >>> life = tl.damage.miner([[[[60e-6] * 3]], [[[100e-6] * 3]]], criteria, traffic, climate, y=[-0.1, 0.0, 0.1])
    >>> life.governing, f"{life.years('bottom'):.0f} years"
    ('bottom', '25 years')
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
            "season_modulus": "season factored_layer",
            "frost_depth thaw_depth day_month": "day",
            "day": "day",
            "rut_depth": "rut_layer year",
            "rut_layer": "rut_layer",
            "year": "year",
            "weather_share weather_reading weather_stress": "criterion month",
            "day_tension": "month profile_depth",
            "damage_per_year": "criterion y",
            "design_damage design_utilisation first_crack_angle first_crack_dip read_depth": "criterion",
            "orientation_damage": "criterion orientation",
            "life_years_fresh_line life_years_aged_line": "criterion",
            "crack_repetitions crack_place crack_strain": "criterion direction",
            "cause_share": "criterion cause",
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
            "cause_share": "crack_repetitions",
            "crack_repetitions": "cause_share",
        },
        maybe_numbers=f"design_years {' '.join(OF_SENSITIVITY)}",
        positive="design_years",
        json={"stats": dict, **dict.fromkeys(PER_CRITERION, list), "ends": list, "groups": list, "conditions": dict},
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
        """Every criterion with what does most of its damage, the rut, what governs, and the assessment."""
        rows = life_rows(self.dataset, self.criteria, self.traffic)
        if self.stats:
            solved = (
                "{contacts} contacts and {responses} responses for {combinations} combinations; interpolation over "
                "the climate changes the damage by no more than an error of {interpolation_error:.1g} of the largest "
                "evaluated value".format(**self.stats)
            )
            rows.append(row("solved", solved))
        rows += [row("governing", self.governing), row("governing_years", self.years(self.governing))]
        return (*rows, row("verdict", life_answer(self.dataset, rows).sentence))

    @property
    def answer(self) -> Answer:
        """The service life, what governs it, where and why."""
        return life_answer(self.dataset, self.rows())
