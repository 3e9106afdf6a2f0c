"""Ageing of asphalt over years and depth: the Global Aging System of Mirza and Witczak, as colder mixes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from treadload.errors import InputError
from treadload.materials.celsius import check_celsius
from treadload.materials.elastic import Elastic
from treadload.materials.kinds import TemperatureDependent, Viscoelastic
from treadload.units import Celsius, Number, Years

_INCH = 0.0254
# The stiffest binder of the source: 2.7e10 poise, as log log of centipoise.
_GLASS = math.log10(math.log10(2.7e12))
# Where the surface's viscosity stands, m: cores were recovered over their upper half inch.
_SURFACE = 0.25 * _INCH
_LONGEST = 60.0
# A and VTS of log log η (cP) = A + VTS log T (°R) after mixing and laying, as commonly quoted.
BINDERS = {
    "AC-5": (11.2614, -3.7914),
    "AC-10": (11.0134, -3.6954),
    "AC-20": (10.7709, -3.6017),
    "AC-40": (10.5338, -3.5104),
    "40/50": (10.5254, -3.5047),
    "60/70": (10.6508, -3.5537),
    "PG 58-22": (11.787, -3.981),
    "PG 64-22": (10.980, -3.680),
    "PG 70-22": (10.299, -3.426),
    "PG 76-22": (9.715, -3.208),
}
"""Binders by grade: intercept A and slope VTS of their viscosity over temperature, after NCHRP 1-37A, as commonly
quoted, not checked against the source."""


@runtime_checkable
class Ageing(Protocol):
    """How a mix has aged at a depth: which temperature makes the young mix as stiff as the old one is."""

    def as_cold_as(self, temperature: float, depth: float) -> float:
        """Temperature, °C, at which the young mix is what the old one is at a temperature, °C, and a depth, m."""


@dataclass(frozen=True)
class GlobalAging:
    """The Global Aging System: viscosity of the binder over age, temperature and depth.

    age: of the road, years. mean_air: of the air over the year, °C: warm places age faster. binder: its grade, one of
    `BINDERS`; or intercept and slope, A and VTS of log log η = A + VTS log T, η in cP when laid, T in °R.
    At the surface log log η = (log log η₀ + a t)/(1 + b t), t in months, a and b of temperature and mean_air; over
    depth η(z) = [η (4 + E) - E η₀ (1 - 4 z)]/[4 (1 + E z)], z in inches, E = 23.83 exp(-0.0308 mean_air in °F): the
    surface's within the upper quarter inch, less below, without the term of the air voids.
    An old mix is taken to be as stiff as the young one at the temperature at which its binder had that viscosity: in
    Witczak's equation of the dynamic modulus temperature counts by viscosity alone. So a mix needs its own modulus
    over temperature and no other number.
    Raises InputError.
    Source: Mirza & Witczak (1995), J. Assoc. Asphalt Paving Technol. 64; NCHRP 1-37A (2004), part 2, chapter 2; the
    constants are as commonly quoted, not checked against the source.

    >>> ageing = tl.materials.GlobalAging(age=10, mean_air=15, binder="AC-20")
    >>> f"at 30 °C as stiff as the young mix at {ageing.as_cold_as(30, depth=0.0):.0f} °C"
    'at 30 °C as stiff as the young mix at 23 °C'
    """

    age: Years
    mean_air: Celsius
    binder: str | None = None
    intercept: Number | None = None
    slope: Number | None = None

    def __post_init__(self) -> None:
        if not 0 <= self.age <= _LONGEST:
            raise InputError(f"the age of a road must lie in [0, {_LONGEST:g}] years, got {self.age:g}")
        check_celsius(self.mean_air)
        if not -20 <= self.mean_air <= 40:
            raise InputError(f"mean_air is the air's mean over the year, -20 to 40 °C, got {self.mean_air:g}")
        if (self.intercept is None) != (self.slope is None):
            raise InputError("a binder needs its grade, or both intercept and slope of its viscosity")
        if self.intercept is None:
            grade = self.binder or "60/70"
            if grade not in BINDERS:
                raise InputError(f"no binder {grade!r}; known are {', '.join(BINDERS)}, or give intercept and slope")
            object.__setattr__(self, "binder", grade)
            object.__setattr__(self, "intercept", BINDERS[grade][0])
            object.__setattr__(self, "slope", BINDERS[grade][1])
        elif self.binder is not None and BINDERS.get(self.binder) != (self.intercept, self.slope):
            raise InputError("give the grade of a binder, or intercept and slope of its viscosity, not both")
        assert self.slope is not None
        if not self.slope < 0:
            raise InputError(f"slope must be negative, got {self.slope:g}: binders thin as they warm; -3.6 is usual")

    def viscosity(self, temperature: float) -> float:
        """Log log of the viscosity after mixing and laying, cP, at a temperature, °C."""
        assert self.intercept is not None
        assert self.slope is not None
        return min(self.intercept + self.slope * math.log10(_rankine(temperature)), _GLASS)

    def aged_viscosity(self, temperature: float, depth: float) -> float:
        """Log log of the viscosity at this age, cP, at a temperature, °C, and a depth, m."""
        young = self.viscosity(temperature)
        log_t = math.log10(_rankine(temperature))
        log_c = 274.4946 - 193.831 * log_t + 33.9366 * log_t**2
        c, d = 10**log_c, -14.5521 + 10.47662 * log_t - 1.88161 * log_t**2
        air = 1.8 * self.mean_air + 32
        a = -0.004166 + 1.41213 * c + c * math.log10(max(air, 1.0)) + d * young
        b = 0.197725 + 0.068384 * log_c
        months = 12 * self.age
        # Beyond the temperatures of its data the regression may turn: ageing never thins a binder.
        top = min(max((young + a * months) / (1 + b * months), young), _GLASS) if 1 + b * months > 0 else young
        inches = max(depth, _SURFACE) / _INCH
        steep = 23.83 * math.exp(-0.0308 * air)
        fresh, surface = 10 ** (10**young), 10 ** (10**top)
        below = (surface * (4 + steep) - steep * fresh * (1 - 4 * inches)) / (4 * (1 + steep * inches))
        return math.log10(math.log10(max(below, fresh)))

    def as_cold_as(self, temperature: float, depth: float) -> float:
        """Temperature, °C, at which the young mix is what the old one is at a temperature, °C, and a depth, m."""
        assert self.intercept is not None
        assert self.slope is not None
        if self.age == 0:
            return temperature
        old = self.aged_viscosity(temperature, depth)
        cold = 10 ** ((old - self.intercept) / self.slope) / 1.8 - 273.15
        return min(cold, temperature)

    def __str__(self) -> str:
        of = self.binder or f"binder A = {self.intercept:g}, VTS = {self.slope:g}"
        return f"Global Aging System, {self.age:g} years of {of}, air {self.mean_air:.1f} °C over the year"


@dataclass(frozen=True)
class Aged:
    """A material that depends on temperature, aged at a depth.

    material: young. ageing: how it ages. depth: m.

    >>> mix = tl.catalogue.mixes["EB-BBSG3"]
    >>> old = tl.materials.Aged(mix, tl.materials.GlobalAging(age=10, mean_air=15, binder="AC-20"), depth=0.0)
    >>> f"{old.at(15).modulus / mix.at(15).modulus:.2f} times as stiff at 15 °C after ten years"
    '2.04 times as stiff at 15 °C after ten years'
    """

    material: TemperatureDependent
    ageing: Ageing
    depth: float

    def at(self, temperature: float, *, extrapolate: bool = False) -> Elastic | Viscoelastic:
        """The old material at a temperature, °C; beyond the data of the young one only on the cold side.

        Raises InputError outside the data of the young one unless asked to extrapolate.
        """
        if not extrapolate:
            self.material.at(temperature)
        return self.material.at(self.ageing.as_cold_as(check_celsius(temperature), self.depth), extrapolate=True)

    def __str__(self) -> str:
        return f"{self.material}, aged {self.depth * 1e3:.0f} mm deep"


def _rankine(temperature: float) -> float:
    return 1.8 * (temperature + 273.15)
