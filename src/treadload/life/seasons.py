"""The road and the criteria at the temperatures of a season."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from treadload.damage.climate import Season
from treadload.damage.criterion import Criterion
from treadload.damage.frequency import contact_radius
from treadload.damage.laws.fatigue import FatigueLaw
from treadload.damage.traffic import AxleClass
from treadload.errors import InputError, nearest
from treadload.kernels.arrays import Array
from treadload.life.stiffer import names_of, stiffer
from treadload.materials import Mix, StressDependent
from treadload.materials.kinds import AnyElastic
from treadload.pavement import Pavement, TemperatureProfile
from treadload.pavement.sublayers import divided, middle_temperatures
from treadload.response import UniformDisc, settle


@dataclass(frozen=True)
class Warm:
    """The road and the criteria at the temperatures of a season."""

    road: Pavement
    criteria: tuple[Criterion, ...]

    def reading(self, numbers: Sequence[int]) -> Warm:
        """With those of the criteria."""
        return Warm(self.road, tuple(self.criteria[k] for k in numbers))


@dataclass(frozen=True)
class Warmed:
    """The roads of a climate.

    distinct: those that differ. where: which of them each season has, by number. by_class: the same roads for every
    class of axles, at its own loading frequency if it reads moduli at one, with the moduli that it makes of
    stress-dependent layers; `distinct` are then those of the heaviest class.
    """

    distinct: tuple[Warm, ...]
    where: tuple[int, ...]
    by_class: tuple[tuple[Warm, ...], ...]


def roads_of(
    road: Pavement, criteria: Sequence[Criterion], seasons: Sequence[Season], classes: Sequence[AxleClass]
) -> Warmed:
    """The road and the criteria in all seasons under all classes. Raises InputError."""
    warm = [warmed(road, criteria, season) for season in seasons]
    firsts = [k for k, season in enumerate(warm) if season not in warm[:k]]
    distinct = tuple(warm[k] for k in firsts)
    where = tuple(distinct.index(season) for season in warm)
    by_class = tuple(
        tuple(warmed(road, criteria, seasons[k], row) for k in firsts) if of_class(road, row) else distinct
        for row in classes
    )
    heaviest = int(np.argmax([row.wheel_load for row in classes]))
    return Warmed(by_class[heaviest] if road.depends_on_stress else distinct, where, by_class)


def of_class(road: Pavement, row: AxleClass) -> bool:
    """True where a class has a road of its own: by its loading frequency, or by the stress of its wheels."""
    return row.frequency is not None or road.depends_on_stress


def warmed(road: Pavement, criteria: Sequence[Criterion], season: Season, row: AxleClass | None = None) -> Warm:
    """The road and the criteria in a season; below a profile courses are divided, and criteria read their ends.

    row: the class of axles, which may read moduli at its own loading frequency; stress-dependent layers have the
    moduli of its wheels, discs of the wheel load under the inflation pressure, and nominal ones without a class.
    Raises InputError for temperatures that do not fit the road, ConvergenceError for moduli that do not settle.
    """
    road = in_season(road, season)
    temperature = season.temperature
    if isinstance(temperature, tuple) and len(temperature) != len(road.layers):
        raise InputError(
            f"season {season.name!r} has {len(temperature)} temperatures, the road {len(road.layers)} layers"
        )
    profile = season.profile
    if profile is None:
        assert not isinstance(temperature, TemperatureProfile)
        warm, numbers, parts = road.at_temperature(temperature), None, road
        each = list(temperature) if isinstance(temperature, tuple) else [temperature] * len(road.layers)
    else:
        parts, owner = divided(road, thickest=season.sublayers, ageing=season.ageing)
        # A sunny hour is warmer than the tables of most mixes: their modulus goes on, and the life says so.
        each = middle_temperatures(parts, profile)
        warm, numbers = parts.at_temperature(each, extrapolate=True), owner
    if row is not None and row.frequency is not None:
        assert row.speed is not None
        radius = contact_radius(row.wheel_load, row.inflation_pressure)
        faster, _ = row.frequency.on(parts, each, row.speed, radius)
        warm = faster.at_temperature(each, extrapolate=True)
    placed = [_placed(criterion, road, numbers) for criterion in criteria]
    pairs = zip(placed, criteria, strict=True)
    placed_in = tuple(new.at(_at_layer(old, road, season)) for new, old in pairs)
    return _settled(Warm(warm, placed_in), row) if warm.depends_on_stress else Warm(warm, placed_in)


def in_season(road: Pavement, season: Season) -> Pavement:
    """The road with the factors of the season on the moduli of its layers. Raises InputError for a strange name."""
    names = names_of(road)
    for name, factor in season.factors:
        if name not in names:
            raise InputError(f"season {season.name!r} has a factor of the layer {name!r}; {nearest(name, names)}")
        number = names.index(name)
        if not isinstance(road.layers[number].material, AnyElastic | Mix | StressDependent):
            raise InputError(
                f"season {season.name!r} has a factor of {name!r}, which has no single modulus; leave it out"
            )
        road = stiffer(road, number, factor)
    return road


def _settled(warm: Warm, row: AxleClass | None) -> Warm:
    """The road with the moduli of its stress-dependent layers, divided over depth, and the criteria in it."""
    if row is None:
        return replace(warm, road=warm.road.at_nominal_stress)
    radius = contact_radius(row.wheel_load, row.inflation_pressure)
    discs = [UniformDisc(radius, row.inflation_pressure, x, y) for x, y in row.wheels]
    state = settle(discs, warm.road, speed=row.speed if warm.road.is_viscoelastic else None)
    owner = state.sublayers.owner
    return Warm(state.road, tuple(_placed(criterion, warm.road, owner) for criterion in warm.criteria))


def layer_temperatures(road: Pavement, criteria: Sequence[Criterion], seasons: Sequence[Season]) -> Array:
    """Temperature (criterion, season) of the layer that each criterion reads, °C; of a divided one, of its part.

    Within the data of a mix, to which laws go no further.
    """
    return np.array([[_at_layer(c, road, season) for season in seasons] for c in criteria])


def laws_of(warm: Warmed, temperatures: Array) -> tuple[tuple[tuple[FatigueLaw, ...], ...], ...]:
    """Laws (criterion, axle_class, season) of the roads as they are solved. temperatures: (criterion, season), °C."""
    return tuple(
        tuple(
            tuple(
                warm_roads[n].criteria[k].law_on(warm_roads[n].road, float(t))
                for n, t in zip(warm.where, row, strict=True)
            )
            for warm_roads in warm.by_class
        )
        for k, row in enumerate(temperatures)
    )


def frequencies(road: Pavement, season: Season, row: AxleClass) -> tuple[list[float], list[float]]:
    """Loading frequencies of a class in a season at the mixes' middles, Hz, and their moduli over those at 10 Hz."""
    assert row.frequency is not None
    assert row.speed is not None
    profile, temperature = season.profile, season.temperature
    parts = road
    if profile is not None:
        parts, _ = divided(road, thickest=season.sublayers, ageing=season.ageing)
        each = middle_temperatures(parts, profile)
    else:
        assert not isinstance(temperature, TemperatureProfile)
        each = list(temperature) if isinstance(temperature, tuple) else [temperature] * len(road.layers)
    faster, hertz = row.frequency.on(parts, each, row.speed, contact_radius(row.wheel_load, row.inflation_pressure))
    fast, slow = (road_at.at_temperature(each, extrapolate=True) for road_at in (faster, parts))
    mixes = [k for k, layer in enumerate(parts.layers[: len(hertz)]) if layer.depends_on_temperature]
    ratios = [fast.layers[k].elastic.modulus / slow.layers[k].elastic.modulus for k in mixes]  # type: ignore[union-attr]
    return [hertz[k] for k in mixes], ratios


def beyond_data(road: Pavement, season: Season) -> list[tuple[str, float, float]]:
    """Mixes of a road that a profile takes beyond their tables: name, the temperature furthest out, and the limit."""
    profile = season.profile
    if profile is None:
        return []
    parts, owner = divided(road, thickest=season.sublayers)
    beyond = []
    for number, value in zip(owner, middle_temperatures(parts, profile), strict=True):
        mix = road.layers[number].material
        if isinstance(mix, Mix):
            low, high = mix.temperatures[0], mix.temperatures[-1]
            if not low <= value <= high:
                beyond.append((mix.name, value, high if value > high else low))
    return beyond


def _placed(criterion: Criterion, road: Pavement, owner: tuple[int, ...] | None) -> Criterion:
    """The criterion at the part of its layer that it reads: the last, or at the top the first, to search them all."""
    if owner is None:
        return criterion
    number = criterion.number(road)
    members = [k for k, whose in enumerate(owner) if whose == number]
    if criterion.place == "top":
        return replace(criterion, layer=members[0], parts=max(criterion.parts, len(members)))
    return replace(criterion, layer=members[-1])


def _at_layer(criterion: Criterion, road: Pavement, season: Season) -> float:
    number, temperature, profile = criterion.number(road), season.temperature, season.profile
    if profile is None:
        assert not isinstance(temperature, TemperatureProfile)
        return temperature[number] if isinstance(temperature, tuple) else temperature
    parts, owner = divided(road, thickest=season.sublayers)
    layer = _placed(criterion, road, owner).layer
    value, mix = middle_temperatures(parts, profile)[layer], road.layers[number].material
    return float(np.clip(value, mix.temperatures[0], mix.temperatures[-1])) if isinstance(mix, Mix) else value
