"""How warm a road is over depth and time below a weather: heat conduction, or a published formula."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta

import numpy as np
from numpy.typing import ArrayLike

from treadload.errors import ConvergenceError, InputError, positive
from treadload.kernels.arrays import Array
from treadload.kernels.heat import conducted, graded, read_at
from treadload.materials import HydraulicMix
from treadload.materials.kinds import elastic_part
from treadload.pavement.asphalt import is_bituminous
from treadload.pavement.structure import Pavement
from treadload.pavement.weather import Weather
from treadload.units import Conductivity, HeatCapacity, Share

_BOLTZMANN, _KELVIN = 5.670374419e-8, 273.15
# Where nothing is known: a wind over open ground, m/s, and a relative humidity, %.
WIND, HUMIDITY = 2.0, 70.0
# Of the film that gives heat to the air, h = 698.24 (0.00144 T^0.3 U^0.7 + 0.00097 |Ts - Ta|^0.3), W/(m² K), T the
# mean of both, K, U the wind, m/s.
_FORCED, _FREE = 698.24 * 0.00144, 698.24 * 0.00097
# Cells: the first, m; their growth; how deep, beyond a yearly wave.
_FIRST, _GROWTH, _DEPTH = 0.005, 1.15, 10.0


@dataclass(frozen=True)
class Heat:
    """How a road takes up heat and passes it on.

    absorptivity: share of the sun's radiation that the surface takes up. emissivity: of the surface in long waves.
    asphalt_conductivity: of bituminous layers, W/(m K). asphalt_capacity: what they store, J/(m³ K).
    bound_conductivity: of layers bound by cement, W/(m K). bound_capacity: what they store, J/(m³ K).
    unbound_conductivity: of all other layers, W/(m K). unbound_capacity: what they store, J/(m³ K).
    Defaults: those of the MEPDG for asphalt, 0.85, 0.93, 0.67 BTU/(h ft °F) and 0.23 BTU/(lb °F) at 2300 kg/m³; usual
    ones for the rest; as commonly quoted, not checked against the source. ProductOneME (commit c89fe2b) has an
    emissivity of 0.93, too, but also an absorptivity of 0.93, and the guide's mean conductivity, 1.08 W/(m K).
    Raises InputError.

    >>> road = tl.Pavement.from_catalogue("4 BBM / 15 GNT1 / PF2", temperature=15)
    >>> conductivity, capacity = tl.pavement.Heat(asphalt_conductivity=1.5).of(road)
    >>> [float(value) for value in conductivity]  # W/(m K), from the surface down
    [1.5, 1.5, 1.5]
    """

    absorptivity: Share = 0.85
    emissivity: Share = 0.93
    asphalt_conductivity: Conductivity = 1.16
    asphalt_capacity: HeatCapacity = 2.2e6
    bound_conductivity: Conductivity = 1.7
    bound_capacity: HeatCapacity = 2.1e6
    unbound_conductivity: Conductivity = 1.5
    unbound_capacity: HeatCapacity = 2.0e6

    def __post_init__(self) -> None:
        for name in ("absorptivity", "emissivity"):
            if not 0 < getattr(self, name) <= 1:
                raise InputError(f"{name} must lie in (0, 1], got {getattr(self, name)}; asphalt is near 0.9")
        for kind in ("asphalt", "bound", "unbound"):
            positive(f"{kind}_conductivity", getattr(self, f"{kind}_conductivity"), "W/(m K)", "asphalt is near 1.2")
            positive(f"{kind}_capacity", getattr(self, f"{kind}_capacity"), "J/(m³ K)", "asphalt is near 2.2e6")

    def of(self, road: Pavement) -> tuple[Array, Array]:
        """Conductivity and heat capacity of each layer."""
        kinds = [_kind(elastic_part(layer.material)) for layer in road.layers]
        return tuple(  # type: ignore[return-value]
            np.array([getattr(self, f"{kind}_{what}") for kind in kinds]) for what in ("conductivity", "capacity")
        )


def _kind(material: object) -> str:
    if isinstance(material, HydraulicMix):
        return "bound"
    # A stiff elastic layer of unknown kind is taken as asphalt.
    return "unbound" if is_bituminous(material) is False else "asphalt"  # type: ignore[arg-type]


@dataclass(frozen=True, eq=False)
class RoadTemperatures:
    """Temperatures of a road over time and depth.

    start: of the first row, local time. step: hours. depths: (nz,), m, the first at the surface. temperatures:
    (nt, nz), °C. air: (nt,), °C. method: how they were found, in words. assumed: sentences on what the weather
    lacked.

    >>> from datetime import datetime
    >>> surface = [15, 15, 20, 35, 50, 45, 30, 20]  # °C, every three hours
    >>> day = tl.pavement.Weather(datetime(2023, 7, 1), 3.0, [20] * 8, surface_temperature=surface)
    >>> road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3", temperature=15)
    >>> times = tl.pavement.road_temperatures(road, day, [0.1])
    >>> float(times.hour_of_day[times.temperatures[:, 1].argmax()])  # hottest 100 mm deep
    15.0
    """

    start: datetime
    step: float
    depths: Array
    temperatures: Array
    air: Array
    method: str
    assumed: tuple[str, ...] = ()

    @property
    def months(self) -> np.ndarray:
        """Month of each row (nt,), 1 to 12."""
        return np.array([(self.start + timedelta(hours=k * self.step)).month for k in range(len(self.air))])

    @property
    def hour_of_day(self) -> Array:
        """Hour of each row (nt,), in [0, 24)."""
        hour: Array = np.mod(self.start.hour + self.start.minute / 60 + self.step * np.arange(len(self.air)), 24.0)
        return hour


def road_temperatures(
    road: Pavement, weather: Weather, depths: Sequence[float], heat: Heat | None = None
) -> RoadTemperatures:
    """Temperatures of a road below a weather by heat conduction over depth.

    road: its layers; their moduli do not matter. depths: m, downwards; the surface joins them. heat: what the layers
    conduct and store. The surface takes up αS of the sun, gives off εσT⁴, receives the sky's long waves and gives
    h (Ts - Ta) to the air; a measured surface_temperature takes the place of this balance. The ground below 10 m is
    cut off. The weather is run through twice, the second time from where the first ended, so that the start does not
    matter. Raises InputError and ConvergenceError.
    Sources: h of Vehrencamp (1953) as in NCHRP 1-37A; where the sky is not measured its emissivity 0.77 - 0.28·
    10^(-0.074 p), p the vapour's pressure in mmHg (Geiger); both as coded in ProductOneME (commit c89fe2b).

    >>> from datetime import datetime
    >>> surface = [15, 15, 20, 35, 50, 45, 30, 20]  # °C, every three hours
    >>> day = tl.pavement.Weather(datetime(2023, 7, 1), 3.0, [20] * 8, surface_temperature=surface)
    >>> road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3", temperature=15)
    >>> tl.pavement.road_temperatures(road, day, [0.1]).temperatures.max(axis=0).round().tolist()  # surface, 100 mm
    [50.0, 37.0]
    """
    exchange = Heat() if heat is None else heat
    k, c = exchange.of(road)
    bottoms = road.interfaces[: len(road.layers) - 1]
    cells = graded(bottoms, k, c, first=_FIRST, growth=_GROWTH, depth=_DEPTH)
    # Two steps of a weather of hours instead of one would move no temperature by more than 0.06 K.
    step, count = weather.step * 3600, len(weather.air_temperature) - 1
    assumed: list[str] = []
    if weather.surface_temperature is not None:
        surface_temperatures = weather.surface_temperature.tolist()

        def surface(at: float) -> float:
            return _between(surface_temperatures, at / step)

        def run(start: Array) -> Array:
            return conducted(cells, start, step, count, surface=surface)

        mean, method = float(weather.surface_temperature.mean()), "heat conduction below the measured surface"
    else:
        flux = _Balance(weather, exchange, assumed)

        def run(start: Array) -> Array:
            return conducted(cells, start, step, count, flux=flux)

        mean, method = float(weather.air_temperature.mean()), "heat conduction below a balance at the surface"
    first = run(np.full(len(cells.thickness), mean))
    cycle = run(first[-1, 1:])
    if not np.isfinite(cycle).all():
        raise ConvergenceError("the surface found no temperature that balances what it takes up and gives off")
    levels = np.unique(np.append(np.asarray(depths, dtype=float), 0.0))
    return RoadTemperatures(
        weather.start,
        weather.step,
        levels,
        read_at(cells, cycle, levels),
        weather.air_temperature,
        method,
        tuple(assumed),
    )


def _between(values: list[float], at: float) -> float:
    """Linear between rows."""
    low = min(int(at), len(values) - 2)
    part = min(at - low, 1.0)
    return values[low] + part * (values[low + 1] - values[low])


class _Balance:
    """Heat flux into a surface below a weather."""

    def __init__(self, weather: Weather, heat: Heat, assumed: list[str]) -> None:
        count = len(weather.air_temperature)
        assert weather.radiation is not None
        self.seconds = weather.step * 3600
        air = weather.air_temperature + _KELVIN
        if weather.wind is None:
            assumed.append(f"the climate has no wind: {WIND:g} m/s is taken at all hours")
        wind = np.full(count, WIND) if weather.wind is None else weather.wind
        if weather.sky is not None:
            sky = weather.sky
        else:
            if weather.humidity is None:
                assumed.append(
                    f"the climate has neither sky radiation nor humidity: a relative humidity of {HUMIDITY:g} % and "
                    "a clear sky are taken, which gives cold nights"
                )
            humidity = np.full(count, HUMIDITY) if weather.humidity is None else weather.humidity
            sky = sky_emissivity(weather.air_temperature, humidity) * _BOLTZMANN * air**4
        self.absorbed = (heat.absorptivity * weather.radiation + heat.emissivity * sky).tolist()
        self.air = weather.air_temperature.tolist()
        self.blown = (_FORCED * wind**0.7).tolist()
        self.emissivity = heat.emissivity

    def __call__(self, at: float) -> Callable[[float], tuple[float, float]]:
        """At a time, s: the flux, W/m², and its slope, over the surface temperature, °C."""
        row = at / self.seconds
        air, radiation = _between(self.air, row), _between(self.absorbed, row)
        blown = _between(self.blown, row)
        radiates = self.emissivity * _BOLTZMANN

        def flux(top: float) -> tuple[float, float]:
            kelvin, warmer = top + _KELVIN, top - air
            forced = blown * (kelvin - 0.5 * warmer) ** 0.3
            free = _FREE * abs(warmer) ** 0.3
            into = radiation - radiates * kelvin**4 - (forced + free) * warmer
            # The film's own slope with the mean temperature is a thousandth of the rest.
            return into, -4 * radiates * kelvin**3 - forced - 1.3 * free

        return flux


def sky_emissivity(air: Array, humidity: Array) -> Array:
    """Emissivity of a clear sky, (n,), from the air's temperature, °C, and relative humidity, %."""
    # Vapour pressure by Magnus' formula, hPa, in mmHg.
    pressure = 0.01 * humidity * 6.112 * np.exp(17.62 * air / (243.12 + air)) / 1.33322
    emissivity: Array = 0.77 - 0.28 * 10 ** (-0.074 * pressure)
    return emissivity


def bells(
    surface: ArrayLike, depth: float, hour: ArrayLike, mean_air_before: ArrayLike, *, shaded: bool = False
) -> Array:
    """Temperature in asphalt below a measured surface, °C, by the BELLS formulas of the LTPP programme.

    surface: infrared temperature, °C. depth: m, > 0, in the asphalt. hour: local, [0, 24). mean_air_before: of the
    day before, (max + min) / 2, °C. shaded: True for BELLS2, of a surface in the shade for five minutes, as under a
    test vehicle; else BELLS3, for routine measurements. Shapes broadcast. Raises InputError.
    Source: Lukanen, Stubstad & Briggs, FHWA-RD-98-085, for BELLS2; those of BELLS3 as a public
    script for deflections codes them, the source's page was not had to its end.

    >>> round(float(tl.pavement.bells(surface=30.0, depth=0.1, hour=10.0, mean_air_before=20.0)), 1)  # °C at 100 mm
    24.4
    """
    positive("depth", depth, "metres", "BELLS holds inside the asphalt")
    ir, air, at = (np.asarray(series, dtype=float) for series in (surface, mean_air_before, hour))

    def sine(shift: float, first: float, last: float) -> Array:
        clock = np.where(at < first, at + 24, at)
        rest = (at >= first) & (at < last)
        value: Array = np.where(rest, -1.0, np.sin(2 * math.pi * (clock - shift) / 18))
        return value

    late, early = sine(15.5, 5.0, 11.0), sine(13.5, 3.0, 9.0)
    deep = math.log10(1e3 * depth) - 1.25
    if shaded:
        return np.asarray(2.78 + 0.912 * ir + deep * (-0.428 * ir + 0.553 * air + 2.63 * late) + 0.027 * ir * early)
    return np.asarray(0.95 + 0.892 * ir + deep * (-0.448 * ir + 0.621 * air + 1.83 * late) + 0.042 * ir * early)
