"""The strength of the bond between two layers: Coulomb's strength with a tensile limit, its utilisation by a load,
and its fatigue in shear.

Another strength is a subclass of `BondStrength`; a case names it by a quantity that makes its `BondUtilisation`, as
`utilisation_of` does.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from treadload.citations import COMMONLY_QUOTED
from treadload.damage.laws.fatigue import PowerLaw
from treadload.damage.quantity import INTERFACE, Quantity
from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.registry import CRITERIA
from treadload.tables import finite_list
from treadload.units import Number

Strength = float | Callable[[float], float]

LEUTNER_MINIMUM: Mapping[str, float] = MappingProxyType({"wearing": 15e3, "lower": 12e3})
"""Shear forces, N, that cores of 150 mm must reach in Leutner's test, at 20 °C, by the German rules.

"wearing": under the wearing course, "lower": between the courses below. The numbers are as commonly quoted, not
checked against the source, ZTV Asphalt-StB 07; that it has a requirement for each of these two places is stated by
the FGSV, committee 7.4.3. Proposals that were read: 16 to 25 kN (Stöckert and Grätz 2001, Forschung Straßenbau 829),
and 21 kN under wearing courses just built (Swiss project FA 12/94, as its successor VSS 2005/503 reports).
"""
_CORE = 0.15
# Utilisation of a bond that has certainly failed: finite, so that readings can be interpolated.
_PARTED = 1e3
# Utilisation below this is the solver's round-off, as on an interface that bears no shear.
_ROUND_OFF = 1e-6
# Tests through which a line is drawn.
_FEWEST = 3
_QUOTED_FORCE = f"the least force of Leutner's test is {COMMONLY_QUOTED}"


class BondStrength(ABC):
    """The strength of a bond, whichever the law: subclasses are frozen dataclasses.

    caveat: which of its numbers have no source that was read; a field, or nothing.

    >>> bond: tl.damage.BondStrength = tl.damage.InterfaceStrength(cohesion=0.8e6, friction_angle=0.6)
    >>> [f"{bond.utilisation(400e3, normal):.2f}" for normal in (0.0, -300e3)]  # compression adds friction
    ['0.50', '0.67']
    """

    caveat: str = ""

    @abstractmethod
    def utilisation(self, shear: float | Array, normal: float | Array) -> Array:
        """Utilisation of the bond; it fails at 1. shear: its size, Pa. normal: Pa, compression positive."""

    @property
    def tension_limit(self) -> float:
        """Tension at which the bond fails without shear, Pa; infinite where the law has no limit in tension."""
        return math.inf

    def at(self, temperature: float) -> Self:
        """The strength at a temperature of the interface, °C."""
        return self

    def passing(self, speed: float | None, depth: float, length: float) -> Self:
        """The strength as a wheel rolls by; speed: m/s, None if unknown; depth and length of the footprint: m."""
        return self


@dataclass(frozen=True)
class InterfaceStrength(BondStrength):
    """Strength of a bond after Coulomb: τ ≤ c + σ_n tan φ, compression positive, with a tensile limit.

    cohesion: c, Pa, >= 0, or a function that gives it at a temperature, °C. friction_angle: φ, rad, in [0, π/2).
    tensile_strength: Pa, or a function of °C likewise, at most c / tan φ, where the line ends; left out, the line's
    own end, and no limit where φ = 0. caveat: which numbers have no source that was read.
    The law predicts when an intact bond fails; friction on a debonded face is another matter.
    Raises InputError.

    >>> strength = tl.damage.InterfaceStrength(cohesion=0.85e6, friction_angle=0.6)
    >>> strength.cohesion
    850000.0
    """

    cohesion: Strength
    friction_angle: float = 0.0
    tensile_strength: Strength | None = None
    caveat: str = ""

    def __post_init__(self) -> None:
        if not (math.isfinite(self.friction_angle) and 0 <= self.friction_angle < math.pi / 2):
            raise InputError(
                f"friction_angle must lie in [0, π/2) rad, got {self.friction_angle}; 35° is math.radians(35)"
            )
        if not callable(self.cohesion) and not (math.isfinite(self.cohesion) and self.cohesion >= 0):
            raise InputError(f"cohesion must be a number >= 0 Pa, got {self.cohesion}; 0.85 MPa is 0.85e6")
        tensile = self.tensile_strength
        if tensile is None or callable(tensile):
            return
        if not (math.isfinite(tensile) and tensile >= 0):
            raise InputError(f"tensile_strength must be a number >= 0 Pa, got {tensile}; leave it out if unknown")
        if not callable(self.cohesion) and tensile > self._end * (1 + 1e-12):
            raise InputError(
                f"tensile_strength {tensile:g} Pa lies beyond the end of Coulomb's line, c / tan φ = {self._end:g} "
                "Pa; lower it or the friction angle"
            )

    @classmethod
    def from_leutner(
        cls,
        force: float,
        diameter: float = _CORE,
        *,
        friction_angle: float = 0.0,
        tensile_strength: Strength | None = None,
    ) -> InterfaceStrength:
        """Strength from the largest force of Leutner's shear test, which applies no normal stress: c = F / (π d²/4).

        force: N, > 0, at the temperature of the test. diameter: of the core, m. friction_angle: rad; 0 counts on
        no help of compression. 15 kN on 150 mm is 0.85 MPa. Raises InputError.
        """
        positive("the force of a Leutner test", force, "N", "15 kN is 15e3")
        positive("the diameter of a core", diameter, "metres", "150 mm is 0.15")
        if diameter > 1:
            raise InputError(f"the diameter of a core must be in m, got {diameter}; 150 mm is 0.15")
        return cls(force / (math.pi * diameter**2 / 4), friction_angle, tensile_strength)

    @classmethod
    def leutner_minimum(cls, place: str) -> InterfaceStrength:
        """Strength of a core that just passes Leutner's test. place: of `LEUTNER_MINIMUM`, with its caveat."""
        if place not in LEUTNER_MINIMUM:
            raise InputError(f"place must be one of {', '.join(LEUTNER_MINIMUM)}, got {place!r}")
        return replace(cls.from_leutner(LEUTNER_MINIMUM[place]), caveat=_QUOTED_FORCE)

    @property
    def depends_on_temperature(self) -> bool:
        """True if a strength is known only once the temperature is."""
        return callable(self.cohesion) or callable(self.tensile_strength)

    def at(self, temperature: float) -> InterfaceStrength:
        """The strength at a temperature of the interface, °C. Raises InputError for one that is not a number."""
        if not self.depends_on_temperature:
            return self
        cohesion, tensile = (
            float(value(temperature)) if callable(value) else value
            for value in (self.cohesion, self.tensile_strength)
        )
        assert cohesion is not None
        try:
            return replace(self, cohesion=cohesion, tensile_strength=tensile)
        except InputError as error:
            raise InputError(f"at {temperature:g} °C: {error}") from error

    @property
    def tension_limit(self) -> float:
        """Tension at which the bond fails without shear, Pa; infinite where the law has no limit in tension."""
        return self._end if self.tensile_strength is None else self._number(self.tensile_strength)

    @property
    def _end(self) -> float:
        """Where Coulomb's line ends in tension, Pa."""
        slope = math.tan(self.friction_angle)
        return self._number(self.cohesion) / slope if slope > 0 else math.inf

    def shear_strength(self, normal: float | Array) -> Array:
        """Shear at which the bond fails, Pa: c + σ_n tan φ, at least 0. normal: σ_n, Pa, compression positive."""
        resisted = self._number(self.cohesion) + np.asarray(normal, dtype=float) * math.tan(self.friction_angle)
        return np.maximum(resisted, 0.0)

    def utilisation(self, shear: float | Array, normal: float | Array) -> Array:
        """Utilisation of the bond: max(τ / (c + σ_n tan φ), -σ_n / f_t); it fails at 1.

        shear: τ, the size of the shear vector, Pa. normal: σ_n, Pa, compression positive. In compression the second
        part is zero; in tension the first has less cohesion left. Infinite where nothing resists: without
        cohesion wherever nothing presses. Raises InputError for a strength that waits for its temperature.
        """
        size, pressed = np.broadcast_arrays(np.asarray(shear, dtype=float), np.asarray(normal, dtype=float))
        return np.maximum(
            _ratio(size, self.shear_strength(pressed)), _ratio(np.maximum(-pressed, 0.0), self.tension_limit)
        )

    @staticmethod
    def _number(value: Strength) -> float:
        if callable(value):
            raise InputError("this strength of an interface depends on temperature; choose one with .at(°C) first")
        return value

    def __str__(self) -> str:
        angle = f", φ = {math.degrees(self.friction_angle):.3g}°" if self.friction_angle else ""
        if self.depends_on_temperature:
            return f"bond with a strength of its temperature{angle}"
        end = f", {self.tension_limit / 1e6:.3g} MPa in tension" if math.isfinite(self.tension_limit) else ""
        return f"bond with c = {self._number(self.cohesion) / 1e6:.3g} MPa{angle}{end}"


def _ratio(part: Array, whole: float | Array) -> Array:
    """Part / whole, both >= 0; 0 / 0 is 0, anything else over 0 infinite."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(part == 0, 0.0, part / whole)


@dataclass(frozen=True)
class BondUtilisation(Quantity):
    """Utilisation of a bond by a load, at an interface of the road; it fails at 1.

    strength: of the bond; left out, a response does not give it. Readings are at most 1000, round-off of the solver,
    as on an interface without shear, is 0. The layers separate along the horizontal plane.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.06), tl.Layer(tl.Elastic(100e6, 0.4))])
    >>> response = tl.solve_response(tl.UniformDisc(0.125, 8e5), road, depths=[0.06], x=[0.0, 0.125], y=[0.0])
    >>> bond = tl.damage.BondUtilisation(tl.damage.InterfaceStrength(cohesion=0.4e6))
    >>> [f"{share:.2f}" for share in bond.field(response.dataset).values.ravel()]
    ['0.00', '0.14']
    """

    strength: BondStrength | None = None

    name = "utilisation"
    words = "utilisation of the bond"
    source = "Coulomb's strength of the bond, or another"
    calibrated = "by shear tests of the bond (Leutner); not on roads"
    where = INTERFACE
    needs = ("stress_zz", "stress_xz", "stress_yz")
    bounded = True
    between_layers = True

    @property
    def lacks(self) -> str:
        """The strength, until it is given."""
        return "" if self.strength is not None else "the strength of the bond"

    @property
    def caveat(self) -> str:
        """That of the strength."""
        return "" if self.strength is None else self.strength.caveat

    def at(self, temperature: float) -> Self:
        """The same with the strength at a temperature of the layer above, °C."""
        return self if self.strength is None else replace(self, strength=self.strength.at(temperature))

    def passing(self, speed: float | None, depth: float, length: float) -> Self:
        """The same with the strength as a wheel rolls by."""
        return self if self.strength is None else replace(self, strength=self.strength.passing(speed, depth, length))

    def of(self, stress: Array, strain: Array) -> Array:
        """The strength's utilisation by the shear of the horizontal plane and the pressure on it."""
        if self.strength is None:
            raise InputError("no response gives the utilisation of a bond without its strength; give strength=")
        used = self.strength.utilisation(np.hypot(stress[4], stress[5]), -stress[2])
        return np.where(used < _ROUND_OFF, 0.0, np.minimum(used, _PARTED))

    def normal(self, stress: Array, strain: Array) -> Array:
        """The vertical."""
        return np.broadcast_to([0.0, 0.0, 1.0], (*stress.shape[1:], 3))


UTILISATION = BondUtilisation()


@CRITERIA.register("shear-fatigue")
@dataclass(frozen=True)
class ShearFatigue(PowerLaw):
    """Fatigue of a bond: passes N = (u / u₁)^(1/b) that a utilisation u allows.

    slope: b, in (-1, 0), from cyclic shear tests of this bond at this temperature. single_pass: u₁, utilisation that
    one pass allows; 1 ties the line to the strength itself. caveat: which numbers have no source that was read.
    reads: the utilisation of a bond, with its strength where a criterion reads it of a response.
    It reads the largest utilisation, once as each axle passes, though the shear reverses under it: take a slope
    counted likewise. Straight lines in log-log were found by Tozzo, D'Andrea, Cozzani and Meo (2014), Modern Applied
    Science 8(2); they depend on normal stress and temperature (Isailović, Cannone Falchetto and Wistuba 2017, AAPT);
    Diakhaté et al. (2011), Constr. Build. Mater. 25, 2070, tested tack coats in double shear (not read). No slope is
    given here: `fit` draws the line through tests.
    Raises InputError.

    >>> f"{tl.damage.ShearFatigue(slope=-0.2).allowable_passes(0.5):.3g}"
    '32'
    """

    slope: Number
    single_pass: Number = 1.0
    caveat: str = ""
    reads: Quantity = UTILISATION

    source: ClassVar[str] = "a power law of the bond's utilisation with the user's numbers"
    end_of_life: ClassVar[str] = "the bond fails"
    calibrated: ClassVar[str] = "by the user's cyclic shear tests; no slope is given here"

    def __post_init__(self) -> None:
        if not -1 < self.slope < 0:
            raise InputError(
                f"the slope of a bond's fatigue must lie in (-1, 0), got {self.slope}; take it from tests of the bond"
            )
        positive("single_pass", self.single_pass, remedy="1 is the strength")
        if not self.reads.between_layers:
            raise InputError(f"the fatigue of a bond reads its utilisation, got the {self.reads}; take a law of that")

    @classmethod
    def fit(cls, utilisation: ArrayLike, passes: ArrayLike) -> Self:
        """The line through cyclic shear tests, by regression of log N on log u.

        utilisation: largest shear stress of a cycle over the strength at the same temperature, rate and normal
        stress, > 0. passes: cycles until the bond failed, > 0; leave out tests that did not fail. Raises InputError
        for fewer than three, for one utilisation, and for lives that grow with it.
        """
        used, borne = finite_list(utilisation, "utilisation"), finite_list(passes, "passes")
        if len(used) != len(borne) or len(used) < _FEWEST:
            raise InputError(
                f"a line of fatigue needs {_FEWEST} tests or more, a utilisation and passes each, got {len(used)} "
                f"and {len(borne)}"
            )
        if not ((used > 0).all() and (borne > 0).all()) or np.ptp(used) == 0:
            raise InputError("tests of fatigue need utilisations > 0 that differ, and passes > 0")
        power, log = np.polyfit(np.log(used), np.log(borne), 1)
        if not power < -1:
            raise InputError(
                f"in these tests passes go as the utilisation to the power {power:.3g}, which must lie below -1; "
                "look for columns that were exchanged"
            )
        return cls(float(1 / power), float(np.exp(-log / power)))

    @property
    def at_a_million(self) -> float:
        """Utilisation that allows a million passes."""
        return float(self.single_pass * 1e6**self.slope)

    @property
    def exponent(self) -> float:
        """Slope b."""
        return self.slope

    def __str__(self) -> str:
        return f"shear fatigue of the bond, slope {self.slope:g}, {self.single_pass:g} in one pass"
