"""Climate: how warm the road is over the passes of a year."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from treadload.damage.shares import check_shares
from treadload.damage.thermal import Thermal
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.materials import Mix
from treadload.materials.ageing import Ageing
from treadload.pavement import FrostYear, Pavement, RoadTemperatures, TemperatureProfile
from treadload.pavement.frost import named_factors
from treadload.tables import finite_list
from treadload.units import Celsius, Length, Share

MONTHS = ("January", "February", "March", "April", "May", "June", "July", "August", "September", "October",
          "November", "December")  # fmt: skip
PARTS = 4
"""Parts of the day that stand for its hours."""
_DIVISORS = (1, 2, 3, 4, 6, 8, 12, 24)
# Hours of a year, but for the last that a file may lack.
_YEAR = 8700.0
# Strain over stiffness in asphalt, and a usual law over strain.
_READING, _HARM = 0.8, 5.0
_POWERS = (3.0, 8.0)
# Temperatures at which a mix is tabulated between its coldest and its warmest hour.
_TABLE = 200


@dataclass(frozen=True)
class Season:
    """A part of the year with its temperatures.

    name: for tables. share: of the passes, in [0, 1]. temperature: °C, of all layers, or one for each, surface
    first; or a TemperatureProfile, over depth. sublayers: the greatest thickness of the parts into which courses are
    divided below a profile, m; left out, by the rule of `pavement.divided`. ageing: of the mixes, over depth.
    factors: on the moduli of elastic and stress-dependent layers, by their names, as of frost, thaw and moisture; a
    mapping is taken, too. Raises InputError.

    >>> tl.damage.Season("summer", 0.25, 25.0).temperature
    25.0
    """

    name: str
    share: Share
    temperature: Celsius | tuple[Celsius, ...] | TemperatureProfile
    sublayers: Length | None = None
    ageing: Ageing | None = None
    factors: tuple[tuple[str, float], ...] = ()

    def __post_init__(self) -> None:
        if not 0 <= self.share <= 1:
            raise InputError(f"the share of {self.name!r} must lie in [0, 1], got {self.share}; a month is 1/12")
        pairs = self.factors if isinstance(self.factors, Mapping) else dict(self.factors)
        object.__setattr__(self, "factors", named_factors(pairs))
        if isinstance(self.temperature, Sequence):
            object.__setattr__(self, "temperature", tuple(float(t) for t in self.temperature))
        if not np.isfinite(self.temperatures).all():
            raise InputError(f"the temperature of {self.name!r} must be finite, got {self.temperature} °C")
        if self.ageing is not None and isinstance(self.temperature, tuple):
            raise InputError(
                f"season {self.name!r} has a temperature for each layer and ageing, which divides them; give one "
                "temperature, or a profile over depth"
            )

    @property
    def temperatures(self) -> tuple[float, ...]:
        """All the temperatures that it names, °C, downwards."""
        temperature = self.temperature
        if isinstance(temperature, TemperatureProfile):
            return temperature.temperatures
        return temperature if isinstance(temperature, tuple) else (temperature,)

    @property
    def profile(self) -> TemperatureProfile | None:
        """Temperature over depth, where the road is divided for it; None where each layer stays whole."""
        if isinstance(self.temperature, TemperatureProfile):
            return self.temperature
        if self.ageing is None or isinstance(self.temperature, tuple):
            return None
        return TemperatureProfile((0.0, 1.0), (self.temperature, self.temperature))

    def warmer(self, degrees: float) -> Season:
        """The season warmer by so many degrees."""
        now = self.temperature
        if isinstance(now, TemperatureProfile):
            return replace(self, temperature=TemperatureProfile(now.depths, [t + degrees for t in now.temperatures]))
        return replace(self, temperature=tuple(t + degrees for t in now) if isinstance(now, tuple) else now + degrees)


@dataclass(frozen=True, eq=False)
class TypicalDays:
    """The mean day of every month, over depth.

    hours: (nh,), local, [0, 24). depths: (nz,), m, the first at the surface. temperatures: (12, nh, nz), °C, January
    first. Raises InputError.
    """

    hours: Array
    depths: Array
    temperatures: Array

    def __post_init__(self) -> None:
        expected = (len(MONTHS), len(self.hours), len(self.depths))
        if np.shape(self.temperatures) != expected or not np.isfinite(self.temperatures).all():
            raise InputError(
                f"typical days need finite temperatures (month, hour, depth) {expected}, got "
                f"{np.shape(self.temperatures)}"
            )

    @classmethod
    def of(cls, road_temperatures: RoadTemperatures) -> TypicalDays:
        """Means of a year's temperatures over the days of each month."""
        months, clock = road_temperatures.months, road_temperatures.hour_of_day
        whole = clock.astype(int)
        hours = np.unique(whole)
        means = [
            [road_temperatures.temperatures[(months == month) & (whole == hour)].mean(axis=0) for hour in hours]
            for month in range(1, len(MONTHS) + 1)
        ]
        return cls(
            np.array([clock[whole == hour].mean() for hour in hours]), road_temperatures.depths, np.array(means)
        )


@dataclass(frozen=True)
class Climate:
    """The temperatures of the road over the passes.

    seasons: whose shares sum to 1. about: how they were found, in sentences. warnings: sentences for the user. days:
    below a weather the mean day of every month, from which figures are drawn and daily thermal stress follows.
    thermal: how that stress counts; None for not at all. frost: in the unbound layers by days, from which figures are
    drawn; its factors stand in the seasons. Raises InputError.

    >>> climate = tl.damage.Climate.constant(15.0)
    >>> climate.seasons[0].temperature
    15.0
    """

    seasons: tuple[Season, ...]
    about: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    days: TypicalDays | None = field(default=None, compare=False, repr=False)
    thermal: Thermal | None = None
    frost: FrostYear | None = field(default=None, compare=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "seasons", tuple(self.seasons))
        if not self.seasons:
            raise InputError("a climate needs at least one season, got none")
        check_shares("climate", [season.share for season in self.seasons])
        if self.thermal is not None and self.days is None:
            raise InputError(
                "daily thermal stress needs the course of the day over depth, and this climate gives temperatures of "
                "the road without it; give its weather, in a case file or air, or leave thermal out"
            )

    @classmethod
    def constant(cls, temperature: float) -> Climate:
        """One temperature, °C, all year round, such as the equivalent one of a design method."""
        return cls((Season("all year", 1.0, temperature),))

    @classmethod
    def equal_parts(cls, temperatures: Sequence[float], names: Sequence[str] = ()) -> Climate:
        """Seasons of equal share, such as twelve months, with their temperatures, °C."""
        if names and len(names) != len(temperatures):
            raise InputError(f"there are {len(temperatures)} temperatures but {len(names)} names")
        count = len(temperatures)
        labels = names or [f"{k + 1} of {count}" for k in range(count)]
        return cls(tuple(Season(n, 1 / count, t) for n, t in zip(labels, temperatures, strict=True)))

    def with_frost(self, frost: FrostYear, months: Sequence[int]) -> Climate:
        """The climate with the moduli of frozen and thawing layers in its seasons.

        months: of each season, 1 to 12. Raises InputError for another number of them.
        """
        if len(months) != len(self.seasons):
            raise InputError(f"the climate has {len(self.seasons)} seasons, got {len(months)} months")
        by_month = {month: tuple(frost.factor(month).items()) for month in set(months)}
        seasons = tuple(
            replace(season, factors=by_month[month]) for season, month in zip(self.seasons, months, strict=True)
        )
        return replace(self, seasons=seasons, about=(*self.about, str(frost)), frost=frost)

    def within(self, sublayers: float | None, ageing: Ageing | None) -> Climate:
        """The same climate with the road's courses divided, see `Season`."""
        parts = tuple(replace(season, sublayers=sublayers, ageing=ageing) for season in self.seasons)
        return replace(self, seasons=parts, about=(*self.about, *_ageing_caveat(ageing)))

    def warmer(self, degrees: float) -> Climate:
        """The climate with all its seasons warmer by so many degrees."""
        days = self.days
        warm = None if days is None else replace(days, temperatures=days.temperatures + degrees)
        return replace(self, seasons=tuple(season.warmer(degrees) for season in self.seasons), days=warm)

    @classmethod
    def of_road(
        cls,
        road: Pavement,
        road_temperatures: RoadTemperatures,
        *,
        parts: int = PARTS,
        hours: Sequence[float] | None = None,
        sublayers: float | None = None,
        ageing: Ageing | None = None,
    ) -> Climate:
        """Months by parts of the day, each with a profile over depth that does the harm of its hours.

        At each depth in a mix it is the temperature at which E^-4 has its mean, strain taken as E^-0.8 and harm as
        its fifth power; else the mean.

        road: whose mixes wait for their temperature. road_temperatures: over a year at least. parts: of the day,
        a divisor of 24; `about` states what they cost. hours: shares of the passes in the 24 hours of a day,
        from midnight; left out, all alike. sublayers, ageing: as of a Season. Days count alike.
        Raises InputError.
        """
        labels, weights = _binned(road_temperatures, parts, hours)
        temperatures, total = road_temperatures.temperatures, float(weights.sum())
        soft = _softness(road, road_temperatures)
        seasons = []
        for label in np.unique(labels):
            rows = labels == label
            share = float(weights[rows].sum()) / total
            if share == 0:
                continue
            mean = _equivalent(soft, temperatures[rows], weights[rows])
            month, part = divmod(int(label), parts)
            wide = 24 // parts
            name = MONTHS[month] if parts == 1 else f"{MONTHS[month]}, {part * wide}-{(part + 1) * wide} h"
            seasons.append(
                Season(
                    name,
                    share,
                    TemperatureProfile(road_temperatures.depths.tolist(), mean.tolist()),
                    sublayers,
                    ageing,
                )
            )
        error = _binning_error(soft, labels, weights, temperatures)
        surface = road_temperatures.temperatures[:, 0]
        about = (
            f"temperatures by {road_temperatures.method}: surface {surface.min():.0f} to {surface.max():.0f} °C, "
            f"gathered into {len(seasons)} seasons by month and {parts} part(s) of the day, which moves damage as "
            f"readings off by {100 * error:.2g} % would"
        )
        return cls(
            tuple(seasons),
            (about, *_ageing_caveat(ageing)),
            road_temperatures.assumed,
            TypicalDays.of(road_temperatures),
        )


def month_of(name: str) -> int:
    """Month, 1 to 12, of a season that `Climate.of_road` named."""
    return MONTHS.index(name.partition(",")[0]) + 1


def _ageing_caveat(ageing: Ageing | None) -> tuple[str, ...]:
    if ageing is None:
        return ()
    return (
        f"mixes aged by the {ageing}: read at this age all their life long, with the fatigue law of the young mix",
    )


def _binning_error(
    soft: Sequence[tuple[Array, Array] | None], labels: np.ndarray, weights: Array, temperatures: Array
) -> float:
    """Error of a reading from the gathering of hours (nt,) into bins; weights of the hours; temperatures (nt, nz).

    The harm of the binned temperatures over that of all hours, to the power 1/n, less one, for laws of another power
    n than that by which the bins were made, 3 and 8; the largest over the depths in mixes.
    """
    bins = [labels == label for label in np.unique(labels) if weights[labels == label].sum() > 0]
    shares = np.array([weights[rows].sum() for rows in bins])
    worst = 0.0
    binned = np.array([_equivalent(soft, temperatures[rows], weights[rows]) for rows in bins])
    for number, curve in enumerate(soft):
        if curve is None:
            continue
        for power in _POWERS:
            rough, fine = (
                float(np.average(np.exp(power * np.interp(warm, *curve)), weights=heavy))
                for warm, heavy in ((binned[:, number], shares), (temperatures[:, number], weights))
            )
            worst = max(worst, abs((rough / fine) ** (1 / power) - 1))
    return worst


def _softness(road: Pavement, road_temperatures: RoadTemperatures) -> list[tuple[Array, Array] | None]:
    """At each depth temperatures and ln of the strain there, but for a constant; None where there is no mix."""
    curves: list[tuple[Array, Array] | None] = []
    for number, depth in enumerate(road_temperatures.depths):
        mix, column = road.layers[road.layer_at(float(depth))].material, road_temperatures.temperatures[:, number]
        if not isinstance(mix, Mix) or np.ptp(column) == 0:
            curves.append(None)
            continue
        grid = np.linspace(column.min(), column.max(), _TABLE)
        moduli = [mix.modulus(float(temperature), extrapolate=True) for temperature in grid]
        curves.append((grid, -_READING * np.log(moduli)))
    return curves


def _equivalent(soft: Sequence[tuple[Array, Array] | None], temperatures: Array, weights: Array) -> Array:
    """Temperature at each depth (nz,) that does the harm of some hours (nt, nz)."""
    result: Array = np.average(temperatures, axis=0, weights=weights)
    for number, curve in enumerate(soft):
        if curve is not None:
            strain = np.interp(temperatures[:, number], *curve)
            harm = float(np.average(np.exp(_HARM * strain), weights=weights))
            result[number] = np.interp(math.log(harm) / _HARM, curve[1], curve[0])
    return result


def _binned(
    road_temperatures: RoadTemperatures, parts: int, hours: Sequence[float] | None
) -> tuple[np.ndarray, Array]:
    """Month times part of the day of each row, and its weight."""
    if parts not in _DIVISORS:
        raise InputError(f"parts of the day must divide 24: {', '.join(map(str, _DIVISORS))}; got {parts}")
    months, clock = road_temperatures.months, road_temperatures.hour_of_day
    if len(months) * road_temperatures.step < _YEAR or len(np.unique(months)) < 12:
        raise InputError(
            f"a life needs a year of temperatures, 8760 hours, got {len(months) * road_temperatures.step:g} from "
            f"{road_temperatures.start:%Y-%m-%d} on"
        )
    if hours is None:
        share = np.full(24, 1 / 24)
    else:
        share = finite_list(hours, "hours")
        if len(share) != 24:
            raise InputError(f"hours needs 24 shares of the passes, from midnight on, got {len(share)}")
        check_shares("day", share.tolist())
    part = (clock // (24 / parts)).astype(int)
    return (months - 1) * parts + part, share[clock.astype(int)]
