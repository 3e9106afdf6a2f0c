"""Frost and thaw in the unbound layers of a road: depths, indices, and what they do to moduli month by month."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from treadload.errors import ConvergenceError, InputError, nearest, positive
from treadload.kernels.arrays import Array, IntArray
from treadload.kernels.freezing import FreezingCells, freezing
from treadload.kernels.heat import graded
from treadload.materials.kinds import elastic_part
from treadload.pavement.asphalt import is_bituminous
from treadload.pavement.heating import Heat, RoadTemperatures
from treadload.pavement.structure import Pavement
from treadload.units import Number, Share

# Water: heat of fusion, J/kg, and heat capacities of water, ice and dry soil, J/(kg K).
_FUSION, _WATER, _ICE, _SOIL = 333.6e3, 4186.0, 2093.0, 800.0
# BTU in/(ft² h °F) in W/(m K), and lb/ft³ in kg/m³, of Kersten's formulas.
_BTU, _POUNDS = 0.144228, 16.0185
# Cells: the first, m; their growth; their depth, m. Steps of so many hours.
_FIRST, _GROWTH, _DEPTH, _HOURS = 0.01, 1.05, 10.0, 6.0
# A semi-infinite soil counts to so far below its top, m: what wheels feel.
_FELT = 1.0
# Days of a season count as a law of strain sees them: E^-0.8 for strain, its fifth power for harm.
_HARM = 4.0


@dataclass(frozen=True)
class Moisture:
    """Water in an unbound layer.

    water: mass of water over that of the dry material, in (0, 1). dry_density: kg/m³. kind: "granular" or "fine", of
    the conductivity by Kersten. Raises InputError.
    Source: Kersten (1949), Thermal Properties of Soils, University of Minnesota, bulletin 28.

    >>> soil = tl.pavement.Moisture(water=0.15, dry_density=1750.0, kind="fine")
    >>> f"{soil.latent / 1e6:.0f} MJ/m³ to freeze it"
    '88 MJ/m³ to freeze it'
    """

    water: Share = 0.10
    dry_density: Number = 1900.0
    kind: Literal["granular", "fine"] = "granular"

    def __post_init__(self) -> None:
        if not 0.005 <= self.water < 1:
            raise InputError(f"water must lie in [0.005, 1) of the dry mass, got {self.water}; 0.05 to 0.25 is usual")
        if not 800 <= self.dry_density <= 2600:
            raise InputError(f"dry_density must lie in [800, 2600] kg/m³, got {self.dry_density:g}; 1900 is usual")
        if self.kind not in ("granular", "fine"):
            raise InputError(f'kind must be "granular" or "fine", got {self.kind!r}')

    @property
    def latent(self) -> float:
        """Heat of freezing, J/m³."""
        return _FUSION * self.water * self.dry_density

    @property
    def capacities(self) -> tuple[float, float]:
        """Heat capacity thawed and frozen, J/(m³ K)."""
        return (
            self.dry_density * (_SOIL + _WATER * self.water),
            self.dry_density * (_SOIL + _ICE * self.water),
        )

    @property
    def conductivities(self) -> tuple[float, float]:
        """Conductivity thawed and frozen, W/(m K)."""
        percent, pounds = max(100 * self.water, 1.0), self.dry_density / _POUNDS
        if self.kind == "granular":
            thawed = (0.7 * math.log10(percent) + 0.4) * 10 ** (0.01 * pounds)
            frozen = 0.076 * 10 ** (0.013 * pounds) + 0.032 * 10 ** (0.0146 * pounds) * percent
        else:
            thawed = max(0.9 * math.log10(percent) - 0.2, 0.1) * 10 ** (0.01 * pounds)
            frozen = 0.01 * 10 ** (0.022 * pounds) + 0.085 * 10 ** (0.008 * pounds) * percent
        return _BTU * thawed, _BTU * frozen


@dataclass(frozen=True)
class Frost:
    """How the unbound layers of a road freeze and thaw.

    soil: moisture of the last layer. base: of all other unbound layers. layers: of layers by their names, in place of
    these. frozen: modulus of a frozen layer over that of the thawed one. thawed: modulus just after thawing over that
    of the recovered one, in (0, 1]. recovery: days from thawing until the modulus is back, linear between. Defaults
    of the last three after NCHRP 1-37A, as commonly quoted, not checked against the source. Raises InputError.

    >>> road = tl.Pavement.from_catalogue("4 BBM / 15 GNT1 / PF2", temperature=15)
    >>> [water and water.kind for water in tl.pavement.Frost().moisture(road)]  # asphalt, base, subgrade
    [None, 'granular', 'fine']
    """

    soil: Moisture = Moisture(0.15, 1750.0, "fine")
    base: Moisture = Moisture(0.05, 2100.0)
    layers: dict[str, Moisture] = field(default_factory=dict)
    frozen: Number = 10.0
    thawed: Number = 0.6
    recovery: Number = 90.0

    def __post_init__(self) -> None:
        if not 1 <= self.frozen <= 1000:
            raise InputError(f"frozen must lie in [1, 1000], got {self.frozen:g}; 10 is the default")
        if not 0 < self.thawed <= 1:
            raise InputError(f"thawed must lie in (0, 1], got {self.thawed:g}; 0.6 is the default")
        positive("recovery", self.recovery, "days", "90 of granular layers, 150 of clay")

    def __hash__(self) -> int:
        return hash((self.soil, self.base, tuple(self.layers.items()), self.frozen, self.thawed, self.recovery))

    def moisture(self, road: Pavement) -> list[Moisture | None]:
        """Of each layer; None where it is bound. Raises InputError for the name of no layer."""
        names = [layer.name for layer in road.layers]
        stray = next((name for name in self.layers if name not in names), None)
        if stray is not None:
            raise InputError(f"frost names the layer {stray!r}; {nearest(stray, names)}")
        last = len(road.layers) - 1
        return [
            self.layers.get(layer.name, self.soil if number == last else self.base)
            if is_bituminous(elastic_part(layer.material)) is False
            else None
            for number, layer in enumerate(road.layers)
        ]


@dataclass(frozen=True, eq=False)
class FrostYear:
    """Frost in a road over a year, by days.

    months: of each day, 1 to 12. frost_depth: of the deepest frozen point below the surface, m, 0 where there is
    none. thaw_depth: of the uppermost frozen point, m, NaN where there is none. factors: modulus of each layer over
    that of the recovered one (day, layer). names: of the layers. air_index, surface_index: frost index of the air and
    of the surface, °C days: by how much the sum of daily means falls over the winter.

    >>> import math
    >>> from datetime import datetime
    >>> road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")
    >>> air = [6 - 14 * math.cos(2 * math.pi * (hour / 24 - 15) / 365) for hour in range(0, 8760, 3)]  # °C
    >>> weather = tl.pavement.Weather(datetime(2023, 1, 1), 3.0, air, surface_temperature=air)
    >>> temperatures = tl.pavement.road_temperatures(road, weather, [0.03, 0.2])
    >>> frost = tl.pavement.frost_year(road, temperatures, tl.pavement.Frost())
    >>> f"frost reaches a depth of {frost.frost_depth.max():.2f} m"
    'frost reaches a depth of 1.11 m'
    """

    months: IntArray
    frost_depth: Array
    thaw_depth: Array
    factors: Array
    names: tuple[str, ...]
    air_index: float
    surface_index: float

    def factor(self, month: int) -> dict[str, float]:
        """Factors on the moduli of the layers in a month, 1 to 12, that do the harm of its days; left out where 1."""
        days = self.factors[self.months == month]
        if not len(days):
            return {}
        mean = np.mean(days**-_HARM, axis=0) ** (-1 / _HARM)
        return {name: float(value) for name, value in zip(self.names, mean, strict=True) if abs(value - 1) > 1e-6}

    def __str__(self) -> str:
        deepest = float(self.frost_depth.max())
        if deepest == 0:
            return "no frost in the unbound layers"
        frozen = int((self.frost_depth > 0).sum())
        return (
            f"frost reaches {deepest:.2f} m, on {frozen} days; frost index {self.air_index:.0f} °C days of the air, "
            f"{self.surface_index:.0f} of the surface"
        )


def frost_year(road: Pavement, temperatures: RoadTemperatures, frost: Frost, heat: Heat | None = None) -> FrostYear:
    """Frost in a road below the temperatures of its surface, by heat conduction with latent heat.

    road: whose unbound layers hold water. temperatures: of a year at least, of which the surface is taken; it was
    found without the heat of freezing. heat: of the bound layers. The year is run twice, so that the start does not
    matter. Raises InputError and ConvergenceError.
    Method: `kernels.freezing`.

    >>> import math
    >>> from datetime import datetime
    >>> road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")
    >>> air = [6 - 14 * math.cos(2 * math.pi * (hour / 24 - 15) / 365) for hour in range(0, 8760, 3)]  # °C
    >>> weather = tl.pavement.Weather(datetime(2023, 1, 1), 3.0, air, surface_temperature=air)
    >>> temperatures = tl.pavement.road_temperatures(road, weather, [0.03, 0.2])
    >>> frost = tl.pavement.frost_year(road, temperatures, tl.pavement.Frost())
    >>> f"frost index of the air: {frost.air_index:.0f} °C days"
    'frost index of the air: 683 °C days'
    """
    if not any(temperatures.depths == 0.0):
        raise InputError("frost needs the temperature of the surface: give depth 0 among those of the road")
    moisture = frost.moisture(road)
    cells, owner = _cells(road, moisture, Heat() if heat is None else heat)
    rows = max(1, round(_HOURS / temperatures.step))
    surface = _means(temperatures.temperatures[:, int(np.argmin(temperatures.depths))], rows)
    step = rows * temperatures.step * 3600
    start = np.full(len(owner), float(surface.mean()))
    state, _ = freezing(cells, start, surface, step)
    state, shares = freezing(cells, state[-1], surface, step)
    if not np.isfinite(shares).all():
        raise ConvergenceError("freezing layers found no temperature; give a drier soil, or a finer weather")
    daily = max(1, round(24 / (rows * temperatures.step)))
    months = temperatures.months[:: rows * daily]
    bottoms = np.cumsum(cells.thickness)
    wet = np.array([moisture[number] is not None for number in owner])
    count = len(surface) // daily
    ice = shares[: count * daily].reshape(count, daily, -1)[:, -1] * wet
    deep, up = _depths(ice, bottoms, cells.thickness)
    air = _means(temperatures.air, rows * daily)
    return FrostYear(
        months[:count],
        deep,
        up,
        _factors(road, ice, cells, owner, frost),
        _names(road),
        frost_index(air),
        frost_index(_means(surface, daily)),
    )


def _names(road: Pavement) -> tuple[str, ...]:
    """Of the layers, with their numbers where several have one, as the tables of a life have them."""
    names = [layer.name or f"layer {number}" for number, layer in enumerate(road.layers, start=1)]
    pairs = enumerate(names, start=1)
    return tuple(name if names.count(name) == 1 else f"{name} ({number})" for number, name in pairs)


def frost_index(daily: Array) -> float:
    """Frost index of daily mean temperatures, °C, over a winter: by how much their sum falls at most, °C days.

    daily: of a year, whose end is joined to its start.

    >>> tl.pavement.frost_index([5.0] * 300 + [-4.0] * 30 + [6.0] * 35)  # °C days: thirty days at -4 °C
    120.0
    """
    total = np.concatenate([[0.0], np.cumsum(np.tile(daily, 2))])
    # Of a winter, no longer than a year.
    length = len(daily)
    falls = [float((total[at : at + length + 1].min()) - total[at]) for at in range(length)]
    return max(0.0, -min(falls))


def _cells(road: Pavement, moisture: list[Moisture | None], heat: Heat) -> tuple[FreezingCells, IntArray]:
    """Cells of a road, and the layer that each belongs to."""
    conductivity, capacity = heat.of(road)
    numbers = np.arange(len(road.layers), dtype=float)
    plain = graded(
        road.interfaces[: len(road.layers) - 1], numbers, numbers, first=_FIRST, growth=_GROWTH, depth=_DEPTH
    )
    owner = plain.conductivity.astype(int)
    thawed, frozen = conductivity.copy(), conductivity.copy()
    warm, cold, latent = capacity.copy(), capacity.copy(), np.zeros(len(capacity))
    for number, water in enumerate(moisture):
        if water is not None:
            thawed[number], frozen[number] = water.conductivities
            warm[number], cold[number] = water.capacities
            latent[number] = water.latent
    columns = (part[owner] for part in (thawed, frozen, warm, cold, latent))
    return FreezingCells(plain.thickness, *columns), owner


def _depths(ice: Array, bottoms: Array, thickness: Array) -> tuple[Array, Array]:
    """Depth of the deepest and of the uppermost frozen point (day,), m, from shares of ice (day, cell)."""
    deep, up = np.zeros(len(ice)), np.full(len(ice), math.nan)
    for day, share in enumerate(ice):
        frozen = np.flatnonzero(share > 0)
        if len(frozen):
            first, last = int(frozen[0]), int(frozen[-1])
            deep[day] = bottoms[last] - (1 - share[last]) * thickness[last]
            up[day] = bottoms[first] - share[first] * thickness[first]
    return deep, up


def _factors(road: Pavement, ice: Array, cells: FreezingCells, owner: IntArray, frost: Frost) -> Array:
    """Modulus of each layer over that of the recovered one (day, layer): parts over each other, in series."""
    days, count = ice.shape
    since = np.full(count, math.inf)
    softness = np.empty((days, count))
    # Through the year twice, so that January remembers December.
    for day in range(2 * days):
        share = ice[day % days]
        since = np.where(share > 0, 0.0, since + 1)
        recovered = frost.thawed + (1 - frost.thawed) * np.minimum(since / frost.recovery, 1.0)
        softness[day % days] = share / frost.frozen + (1 - share) / recovered
    factors = np.ones((days, len(road.layers)))
    bottoms = np.cumsum(cells.thickness)
    for number in range(len(road.layers)):
        members = owner == number
        if number == len(road.layers) - 1:
            top = float(bottoms[members][0] - cells.thickness[members][0])
            members &= bottoms <= max(top + _FELT, float(bottoms[members][0]))
        weights = cells.thickness[members] / cells.thickness[members].sum()
        factors[:, number] = 1 / (softness[:, members] @ weights)
    return factors


def _means(values: Array, rows: int) -> Array:
    """Means of so many rows each, without a rest at the end."""
    count = len(values) // rows
    means: Array = np.asarray(values[: count * rows]).reshape(count, rows).mean(axis=1)
    return means


def named_factors(factors: Mapping[str, float]) -> tuple[tuple[str, float], ...]:
    """Factors on moduli by the names of layers, ordered. Raises InputError for one that is not above 0."""
    for name, value in factors.items():
        positive(f"factor of {name}", value, remedy="1 leaves the modulus as it is")
    return tuple(sorted((str(name), float(value)) for name, value in factors.items()))
