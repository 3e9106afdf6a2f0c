"""What a table of road sections does not state: structure, mix, vehicles, tires and weather, each with its reason."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace

import numpy as np

from treadload.damage.climate import Climate
from treadload.damage.criterion import Criterion
from treadload.damage.laws.fatigue import FatigueLine
from treadload.damage.laws.french import FrenchBituminous
from treadload.damage.thermal import Thermal
from treadload.damage.traffic import AxleClass, Traffic, Wander
from treadload.errors import InputError, positive
from treadload.life.contacts import Contacts
from treadload.life.design import Design
from treadload.materials import Elastic, Mix
from treadload.materials.ageing import GlobalAging
from treadload.materials.library import mixes
from treadload.pavement import Layer, Pavement, divided
from treadload.pavement.heating import Heat, road_temperatures
from treadload.pavement.weather import Weather
from treadload.tire import Belt, Tire
from treadload.units import PSI, Force, Kelvin, Length, Modulus, Number, Pressure, Years, quantity

FAMILIES = ("ACUB", "ACATB", "ACTB")
"""Untreated base, asphalt-treated base, base treated otherwise: the families of LTPP's GPS experiments."""
SURFACE, BOTTOM = "surface", "bottom"
"""Criteria of a section: a crack from the surface down, one from the bottom of the asphalt up."""
# Asphalt of LTPP's sections, m; more than a tenth outside is a unit by mistake.
_THINNEST, _THICKEST = 0.010, 0.60


@dataclass(frozen=True)
class RoadSection:
    """A section of a table of roads.

    name: for tables. thickness: of the asphalt layers, m. family: of its base, one of `FAMILIES`. traffic: standard
    axles of 80 kN a year, or None where it is missing. mean_air: of the air over the year, °C. Raises InputError.
    """

    name: str
    thickness: float
    family: str
    traffic: float | None
    mean_air: float

    def __post_init__(self) -> None:
        if not _THINNEST <= self.thickness <= _THICKEST:
            raise InputError(
                f"section {self.name}: the asphalt is {self.thickness:g} m thick, not between {_THINNEST:g} and "
                f"{_THICKEST:g} m; give metres, 5 inches are 0.127"
            )
        if self.family not in FAMILIES:
            raise InputError(f"section {self.name}: family must be one of {', '.join(FAMILIES)}, got {self.family!r}")
        if self.traffic is not None:
            positive(f"traffic of section {self.name}", self.traffic, "standard axles a year", "None if missing")
        if not -10 <= self.mean_air <= 35:
            raise InputError(
                f"section {self.name}: the mean air temperature is {self.mean_air:g} °C, not between -10 and 35; "
                "50 °F is 10 °C"
            )


@dataclass(frozen=True)
class Priors:
    """What the sections of a table do not state, with the reasons in `reasons`; another set is another prediction.

    mix: of all asphalt. base_mix: of an asphalt-treated base. treated_thickness: of that base, m. granular: thickness
    of the untreated base by the least thickness of the asphalt, m. granular_modulus, bound_modulus, subgrade_modulus:
    Pa, of the untreated base, of one treated otherwise, of the subgrade. bound_thickness: m. tire: profile and belt,
    with ribs. steering_load, tandem_load: N, of the axle and of both axles of a tandem; steering_pressure,
    tandem_pressure: Pa. axles_per_truck: standard axles that a truck (one steering axle, two tandems of dual
    wheels) stands for. missing_traffic: standard axles a year by the least thickness of the asphalt, m. deviation: of
    the wander, m. age: at which the asphalt is read, years. parts_of_day, daily_range: K, of the weather.
    thermal: whether daily thermal stress counts. spacing: of the contact's cells, m.

    >>> priors = tl.life.Priors()
    >>> f"{priors.mix} under {priors.steering_load / 1e3:.0f} kN on the steering axle"
    'EB-BBSG3 under 53 kN on the steering axle'
    """

    mix: str = "EB-BBSG3"
    base_mix: str = "EB-GB3"
    treated_thickness: Length = 0.12
    granular: dict[Length, Length] = field(default_factory=lambda: {0.0: 0.30, 0.10: 0.25, 0.18: 0.20})
    granular_modulus: Modulus = 200e6
    bound_thickness: Length = 0.15
    bound_modulus: Modulus = 2000e6
    subgrade_modulus: Modulus = 70e6
    tire: str = "315/80R22.5"
    steering_load: Force = 53e3
    tandem_load: Force = 133e3
    steering_pressure: Pressure = 120 * PSI
    tandem_pressure: Pressure = 110 * PSI
    axles_per_truck: Number = 1.5
    missing_traffic: dict[Length, Number] = field(default_factory=lambda: {0.0: 83e3, 0.10: 96e3, 0.18: 171e3})
    deviation: Length = 0.25
    age: Years = 5.0
    parts_of_day: int = 4
    daily_range: Kelvin = 12.0
    thermal: bool = True
    spacing: Length = 6e-3

    def __post_init__(self) -> None:
        for name in ("granular", "missing_traffic"):
            classes = {
                quantity(least, "m") if isinstance(least, str) else float(least): value
                for least, value in getattr(self, name).items()
            }
            if min(classes, default=1.0) != 0:
                raise InputError(
                    f"{name} begins at {min(classes, default=math.nan):g} m of asphalt; thinner sections need a "
                    'value, too: give one for "0 mm"'
                )
            object.__setattr__(self, name, dict(sorted(classes.items())))

    @classmethod
    def of(cls, table: Mapping[str, object], where: str) -> Priors:
        """Priors of a table of a file, what it leaves out by default. where: of the table, for errors."""
        # pydantic is loaded when a file is read, not before.
        from treadload.read import read

        priors: Priors = read(cls, table, where)
        return priors

    @property
    def reasons(self) -> dict[str, str]:
        """Each prior with its reason, a sentence each."""
        base = ", ".join(f"{1e3 * thickness:g}" for thickness in self.granular.values())
        axles = ", ".join(f"{count:.3g}" for count in self.missing_traffic.values())
        bounds = " and ".join(f"{1e3 * least:g}" for least in list(self.granular)[1:])
        return {
            "mix": f"{self.mix} throughout, {self.base_mix} in asphalt-treated bases: mixes with published moduli; "
            "a table of sections names no mix",
            "structure": f"untreated bases of {base} mm, with steps at {bounds} mm of asphalt, as designs trade one "
            f"for the other; treated bases of {1e3 * self.treated_thickness:g} (asphalt) and "
            f"{1e3 * self.bound_thickness:g} mm: assumed",
            "moduli": f"{self.granular_modulus / 1e6:g} MPa untreated base, {self.bound_modulus / 1e6:g} MPa cracked "
            f"treated base, {self.subgrade_modulus / 1e6:g} MPa subgrade, usual of design: assumed",
            "vehicles": f"trucks with a steering axle of {self.steering_load / 1e3:g} kN and two tandems of "
            f"{self.tandem_load / 1e3:g} kN on dual wheels, a loaded semitrailer of five axles; such a truck counts "
            f"as {self.axles_per_truck:g} standard axles (AASHTO Guide 1993, 12 and 30 kip)",
            "missing traffic": f"{axles} standard axles a year by thickness class, the geometric means of LTPP's "
            "sections of that class",
            "tires": f"{self.tire} with ribs on its belt, rolling freely, at {self.steering_pressure / 1e5:.1f} and "
            f"{self.tandem_pressure / 1e5:.1f} bar: no other profile of a truck is fitted to a footprint",
            "wander": f"normal, {1e3 * self.deviation:g} mm: usual of lanes of 3.5 m",
            "weather": "from the mean air temperature alone: months swing by 17 K less 0.45 times it, latitude 50° "
            f"less 0.9° per K, {self.daily_range:g} K from night to day: rules of this package, through places from "
            "Minnesota to Florida",
            "age": f"asphalt read at {self.age:g} years, near the median age of first cracks, by the Global Aging "
            "System",
        }

    def of_class(self, classes: Mapping[float, float], thickness: float) -> float:
        """The value of a thickness class. classes: by least thickness, m."""
        return classes[max(least for least in classes if least <= thickness)]

    def traffic_of(self, section: RoadSection) -> float:
        """Standard axles a year, of the table or by the prior."""
        if section.traffic is None:
            return self.of_class(self.missing_traffic, section.thickness)
        return section.traffic

    def road(self, section: RoadSection) -> Pavement:
        """Its layers: asphalt, base, subgrade."""
        asphalt = Layer(mixes[self.mix], section.thickness, name="asphalt")
        granular = Elastic(self.granular_modulus, 0.35)
        untreated = Layer(granular, self.of_class(self.granular, section.thickness), name="untreated base")
        bases = {
            "ACUB": [untreated],
            "ACATB": [Layer(mixes[self.base_mix], self.treated_thickness, name="asphalt-treated base"), untreated],
            "ACTB": [Layer(Elastic(self.bound_modulus, 0.25), self.bound_thickness, name="treated base")],
        }
        soil = Layer(Elastic(self.subgrade_modulus, 0.40), name="subgrade")
        return Pavement([asphalt, *bases[section.family], soil])

    def traffic(self, section: RoadSection) -> Traffic:
        """Axles a year: the steering axle and the two tandems of each truck, the same every year."""
        half = 0.17
        tandem = tuple((x, y) for x in (0.0, 1.31) for y in (-half, half))
        classes = (
            AxleClass("steering axle", 1 / 3, self.steering_load / 2, self.steering_pressure),
            AxleClass("tandem", 2 / 3, self.tandem_load / 8, self.tandem_pressure, wheels=tandem),
        )
        passages = 3 * self.traffic_of(section) / self.axles_per_truck
        return Traffic(classes, passages, wander=Wander.normal(self.deviation))

    def weather(self, section: RoadSection) -> Weather:
        """A year of the section's air, by its mean alone."""
        swing = float(np.clip(17 - 0.45 * section.mean_air, 4.0, 20.0))
        months = [section.mean_air - swing * math.cos(2 * math.pi * (k - 0.5) / 12) for k in range(12)]
        latitude = float(np.clip(50 - 0.9 * section.mean_air, 20.0, 60.0))
        return Weather.of_months(months, daily_range=self.daily_range, latitude=latitude)

    def climate(self, section: RoadSection, road: Pavement) -> Climate:
        """Months by parts of the day, with temperatures and age over depth."""
        parts, _ = divided(road)
        ends = [float(interface) for interface in parts.interfaces]
        middles = [0.5 * (a + b) for a, b in zip([0.0, *ends], ends, strict=False)]
        weather = self.weather(section)
        warm = road_temperatures(road, weather, tuple(sorted({0.0, *middles, *ends})), Heat())
        ageing = GlobalAging(self.age, section.mean_air) if self.age > 0 else None
        climate = Climate.of_road(road, warm, parts=self.parts_of_day, ageing=ageing)
        return replace(climate, thermal=Thermal() if self.thermal else None)

    def mean_surface(self, mean_air: float) -> float:
        """Of a road's surface over the year below air of a mean temperature, °C."""
        section = RoadSection("range", 0.15, FAMILIES[0], None, mean_air)
        seasons = self.climate(section, self.road(section)).seasons
        return float(sum(season.share * season.temperatures[0] for season in seasons) / sum(s.share for s in seasons))

    def criteria(self, road: Pavement) -> tuple[Criterion, ...]:
        """The young line at the surface; half of roads by the French method at the bottom of the lowest asphalt."""
        top = _mix(self.mix)
        lowest = max(k for k, layer in enumerate(road.layers) if isinstance(layer.material, Mix))
        mix = _mix(self.base_mix if lowest else self.mix)
        thickness = float(road.interfaces[lowest])
        assert top.epsilon_6 is not None

        def by_temperature(temperature: float) -> FrenchBituminous:
            return FrenchBituminous.of(mix, thickness=thickness, risk=0.5, temperature=temperature)

        return (
            Criterion(SURFACE, FatigueLine(top.epsilon_6, -0.2), 0, "top"),
            Criterion(BOTTOM, by_temperature, lowest, "bottom"),
        )

    def design(self, section: RoadSection, contacts: Contacts) -> Design:
        """The section as the design that `solve_life` takes. contacts: of `contacts()`, shared by all sections."""
        road = self.road(section)
        return Design(
            contacts.tire,
            road,
            self.traffic(section),
            self.climate(section, road),
            self.criteria(road),
            spacing=self.spacing,
            contacts=contacts,
        )

    def contacts(self) -> Contacts:
        """The tire with ribs on its belt, none of its contacts solved yet."""
        # Shipped predictions were solved with the Poisson's ratio of the belt's layer; with 0.495 of rubber the
        # damage a year of ten sections of LTPP is 0.5 to 6 % smaller.
        belt = replace(Belt.from_library(self.tire), ribs_poisson=None)
        tire = Tire.from_profile(self.tire, belt=belt, tread="ribs")
        return Contacts(tire, self.spacing)

    def key(self, section: RoadSection) -> str:
        """All that a prediction depends on, as text."""
        return repr((section, sorted(asdict(self).items(), key=str)))


def _mix(name: str) -> Mix:
    """A bituminous mix of the catalogue. Raises InputError for another layer."""
    mix = mixes[name]
    if not isinstance(mix, Mix):
        raise InputError(f"{name!r} is no bituminous mix; the asphalt of the priors needs one, such as 'EB-BBSG3'")
    return mix
