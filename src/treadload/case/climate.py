"""The climate of a design case: temperatures of the road as they are given, or found from those of the weather."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any, ClassVar

from pydantic import model_validator

from treadload.damage import Climate, Season
from treadload.damage.climate import MONTHS, PARTS, month_of
from treadload.damage.thermal import Thermal
from treadload.errors import InputError
from treadload.materials import GlobalAging
from treadload.pavement import (
    Frost,
    Heat,
    Pavement,
    RoadTemperatures,
    Weather,
    divided,
    frost_year,
    read_weather,
    road_temperatures,
)
from treadload.read import As, Table, table_of
from treadload.units import Angle, Celsius, Kelvin, Length, Number, Share, Years


def _season(
    name: str, share: Share, temperature: Celsius | tuple[Celsius, ...], factors: dict[str, Number] | None = None
) -> Season:
    """A part of the year with its temperatures.

    name: for tables. share: of the passes, in [0, 1]. temperature: of all layers, or one for each, surface first.
    factors: on the moduli of layers by their names, as of a thawing soil.
    """
    return Season(name, share, temperature, factors=tuple((factors or {}).items()))


_Season: Any = table_of(_season)
SEASONS, HEAT, THERMAL, FROST = As(tuple[_Season, ...]), As(Heat), As(bool | Thermal), As(bool | Frost)


class AirPart(Table):
    """`air = { months = [12 of them] }`: a year of equal days in each month, where no hours are known.

    months: mean temperatures of the air, January first. daily_range: from the coldest to the warmest hour; 10 K if
    left out. latitude: north positive; 47° if left out. clearness: radiation on the ground over that above the air;
    0.45 if left out.
    """

    months: tuple[Celsius, ...]
    daily_range: Kelvin = 10.0
    latitude: Angle = math.radians(47.0)
    clearness: Share = 0.45


class AgeingPart(Table):
    """`[ageing]`: how old the bituminous mixes are, over depth, by the Global Aging System.

    age: at which the road is read, all its life long. mean_air: of the air over the year; left out, that of the
    climate's weather. binder: a grade such as "60/70" or "PG 64-22". intercept: A of its viscosity instead. slope:
    VTS of its viscosity.
    """

    age: Years
    mean_air: Celsius | None = None
    binder: str | None = None
    intercept: Number | None = None
    slope: Number | None = None

    def build(self, weather: Weather | None) -> GlobalAging:
        """The ageing below a weather, if there is one. Raises InputError."""
        mean = self.mean_air
        if mean is None:
            if weather is None:
                raise InputError("ageing needs mean_air, the air's mean over the year in °C: this climate has no air")
            mean = float(weather.air_temperature.mean())
        return GlobalAging(self.age, mean, self.binder, self.intercept, self.slope)


class ClimatePart(Table):
    """`[climate]`: temperature = 15, or months = [12 of them], or seasons, in °C; or the weather: file, or air.

    temperature: of the road, all year round. months: of twelve months, January first. seasons: with their shares of
    the passes. file: of a year's hours, a table with time, air_temperature and radiation, or an EPW file, from which
    the road's temperatures over depth follow by heat conduction. air: the same from monthly means. parts_of_day: into
    which the hours of a month are gathered; 4 if left out. hours: shares of the passes in the 24 hours of a day; left
    out, all alike. sublayers: greatest thickness of the parts that courses are divided into below a file or air, or
    where they age; left out, 20 mm at the surface and more below. heat: what the road absorbs, conducts and stores.
    thermal: daily thermal stress in the damage, beside the passes; left out, it counts with its defaults below a file
    or air; false for none; see docs/explanation/climate.md. frost: true, or how unbound layers freeze and thaw below
    a file or air, which changes their moduli from month to month; left out, they stay as they are.
    """

    one_of: ClassVar = ("temperature", "months", "seasons", "file", "air")

    temperature: Celsius | None = None
    months: tuple[Celsius, ...] | None = None
    seasons: Annotated[Any, SEASONS] = None
    file: str | None = None
    air: AirPart | None = None
    parts_of_day: int = PARTS
    hours: tuple[Share, ...] | None = None
    sublayers: Length | None = None
    heat: Annotated[Any, HEAT] = None
    thermal: Annotated[Any, THERMAL] = True
    frost: Annotated[Any, FROST] = False

    @model_validator(mode="after")
    def _one_kind(self) -> ClimatePart:
        kinds = [name for name in self.one_of if getattr(self, name) is not None]
        if len(kinds) != 1:
            got = " and ".join(kinds) or "none of them"
            raise ValueError(f"give exactly one of temperature, months, seasons, file and air, got {got}")
        if self.months is not None and len(self.months) != len(MONTHS):
            raise ValueError(f"months needs 12 temperatures in °C, January first, got {len(self.months)}")
        stray = {"parts_of_day", "hours", "heat", "thermal", "frost"} & self.model_fields_set
        if not self.has_weather and stray:
            raise ValueError(f"{sorted(stray)[0]} belongs to a climate of weather; leave it out, or give file or air")
        return self

    def without(self, absent: Mapping[int, str], count: int) -> ClimatePart:
        """The climate of a road that lacks layers: less their factors, temperatures and moisture.

        absent: names of these layers by their numbers in the table of the case, from 0. count: layers of that table.
        """
        changes: dict[str, object] = {}
        if self.seasons is not None:
            seasons = SEASONS.build(self.seasons)
            changes["seasons"] = tuple(_without(season, absent, count) for season in seasons)
        frost = FROST.build(self.frost)
        if isinstance(frost, Frost):
            layers = {name: water for name, water in frost.layers.items() if name not in absent.values()}
            changes["frost"] = replace(frost, layers=layers)
        return self.model_copy(update=changes)

    @property
    def has_weather(self) -> bool:
        """True where the road's temperatures follow from the weather."""
        return self.file is not None or self.air is not None

    def build(self, road: Pavement, folder: Path, ageing: AgeingPart | None = None) -> Climate:
        """The climate of a road, whose file starts from the folder. Raises InputError."""
        if not self.has_weather:
            plain = self._plain()
            return plain if ageing is None else plain.within(self.sublayers, ageing.build(None))
        weather = self.weather(folder)
        aged = None if ageing is None else ageing.build(weather)
        temperatures = self.temperatures(road, folder)
        climate = _of_road(road, temperatures, self.parts_of_day, self.hours, self.sublayers, aged)
        thermal = THERMAL.build(self.thermal)
        if isinstance(thermal, bool):
            thermal = Thermal() if thermal else None
        climate = replace(climate, thermal=thermal)
        frost = FROST.build(self.frost)
        if frost is False:
            return climate
        year = frost_year(road, temperatures, Frost() if frost is True else frost, self._heat())
        return climate.with_frost(year, [month_of(season.name) for season in climate.seasons])

    def temperatures(self, road: Pavement, folder: Path) -> RoadTemperatures:
        """Temperatures of a road below the weather, at the middles of its parts and all interfaces."""
        parts, _ = divided(road, thickest=self.sublayers)
        ends = [float(interface) for interface in parts.interfaces]
        middles = [0.5 * (a + b) for a, b in zip([0.0, *ends], ends, strict=False)]
        return _road_temperatures(road, self.weather(folder), tuple(sorted({0.0, *middles, *ends})), self._heat())

    def _heat(self) -> Heat:
        heat: Heat = Heat() if self.heat is None else HEAT.build(self.heat)
        return heat

    def weather(self, folder: Path) -> Weather:
        """The weather. Raises InputError where there is none."""
        if self.air is not None:
            air = self.air
            return _of_months(air.months, air.daily_range, math.degrees(air.latitude), air.clearness)
        if self.file is None:
            raise InputError("this climate gives the road's temperatures and has no weather")
        path = folder / self.file
        return _read(path, path.stat().st_mtime_ns if path.is_file() else 0)

    def _plain(self) -> Climate:
        if self.temperature is not None:
            return Climate.constant(self.temperature)
        if self.months is not None:
            return Climate.equal_parts(self.months, MONTHS)
        return Climate(SEASONS.build(self.seasons))


def _without(season: Season, absent: Mapping[int, str], count: int) -> Season:
    temperature = season.temperature
    if isinstance(temperature, tuple) and len(temperature) == count:
        temperature = tuple(value for number, value in enumerate(temperature) if number not in absent)
    factors = tuple((name, value) for name, value in season.factors if name not in absent.values())
    return replace(season, temperature=temperature, factors=factors)


# A case is built more than once: the same objects make the same temperatures, whose year takes a second.
@lru_cache(maxsize=4)
def _read(path: Path, changed: int) -> Weather:
    return read_weather(path)


@lru_cache(maxsize=4)
def _of_months(months: tuple[float, ...], daily_range: float, latitude: float, clearness: float) -> Weather:
    return Weather.of_months(months, daily_range=daily_range, latitude=latitude, clearness=clearness)


@lru_cache(maxsize=4)
def _road_temperatures(road: Pavement, weather: Weather, depths: tuple[float, ...], heat: Heat) -> RoadTemperatures:
    return road_temperatures(road, weather, depths, heat)


@lru_cache(maxsize=4)
def _of_road(
    road: Pavement, temperatures: RoadTemperatures, parts: int, hours: tuple[float, ...] | None,
    sublayers: float | None, ageing: GlobalAging | None,
) -> Climate:  # fmt: skip
    return Climate.of_road(road, temperatures, parts=parts, hours=hours, sublayers=sublayers, ageing=ageing)
