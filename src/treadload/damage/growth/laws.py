"""Paris' law: how far a crack grows at a passage, by the range of its stress intensity; and which mix has which."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from treadload.citations import COMMONLY_QUOTED
from treadload.describing import as_call
from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.materials import Material, Mix, TemperatureDependent
from treadload.materials.stress_dependent import StressDependent
from treadload.registry import GROWTH
from treadload.units import Length, Modulus, Number

# The stress intensity at which a law tells its rate: 1 MPa √m, which is 31.62 N/mm^1.5.
REFERENCE = 1e6
_TO_MM = REFERENCE / (1e6 * math.sqrt(1e-3))
# What specimens of one mix scatter about their line, of log₁₀ A: a factor of two, as commonly quoted.
_SCATTER = 0.3


class GrowthLaw(ABC):
    """What a law of crack growth provides.

    scatter: standard deviation of log₁₀ of the rate, about the line. source: of its numbers. caveat: what of them no
    source could be read for, in words; empty if nothing.
    """

    scatter: float
    source: str
    caveat: str

    @abstractmethod
    def at(self, modulus: float) -> ParisLaw:
        """Paris' law of the mix where its modulus is this, Pa."""


GROWTH.makes(GrowthLaw)


@GROWTH.register("paris")
@dataclass(frozen=True)
class ParisLaw(GrowthLaw):
    """Growth per passage da/dN = C (ΔK / 1 MPa √m)^n.

    rate: C, m per passage at a range of 1 MPa √m. exponent: n, >= 1. scatter: standard deviation of log₁₀ C.
    source, caveat: in words. Raises InputError.
    Source: Paris and Erdogan (1963), J. Basic Eng. 85, 528-534.

    >>> law = tl.damage.ParisLaw(1e-8, 4.0)
    >>> law.exponent
    4.0
    """

    rate: Length
    exponent: Number
    scatter: Number = _SCATTER
    source: str = "Paris and Erdogan (1963), numbers of the user"
    caveat: str = ""

    def __post_init__(self) -> None:
        positive("rate of Paris' law", self.rate, "m at 1 MPa √m", "asphalt is near 1e-5 to 1e-3")
        _check(self.exponent, self.scatter)

    @classmethod
    def from_millimetres(cls, coefficient: float, exponent: float, **more: float | str) -> ParisLaw:
        """From A and n as asphalt laboratories print them: da/dN in mm, ΔK in N/mm^1.5.

        1 MPa √m = 31.62 N/mm^1.5, so that C = A 31.62^n mm. more: scatter, source, caveat.
        """
        positive("A of Paris' law", coefficient, "mm by N/mm^1.5")
        return cls(1e-3 * coefficient * _TO_MM**exponent, exponent, **more)  # type: ignore[arg-type]

    def at(self, modulus: float) -> ParisLaw:
        """Itself."""
        return self

    def growth(self, ranges: Array) -> Array:
        """Growth per passage, m, at ranges of the stress intensity, Pa √m, >= 0."""
        rate: Array = self.rate * (np.asarray(ranges, dtype=float) / REFERENCE) ** self.exponent
        return rate

    def __str__(self) -> str:
        return f"Paris' law, {1e3 * self.rate:.3g} mm per passage at 1 MPa √m, n = {self.exponent:g}"

    __repr__ = as_call


@GROWTH.register("from-strength")
@dataclass(frozen=True)
class FromStrength(GrowthLaw):
    """Paris' law of asphalt by its modulus and strength: log₁₀ A = 4.389 - 2.52 log₁₀(E σₘ n), in mm and N.

    exponent: n. strength: σₘ, tensile, Pa. scatter: standard deviation of log₁₀ A. A is in mm per passage by
    N/mm^1.5, E and σₘ in MPa; E is that of the layer in its season. The colder, the slower at one ΔK; but ΔK is
    larger then. Raises InputError.
    Source: Molenaar (1984), PAAPT 53, as thermal cracking of NCHRP 1-37A takes it up; the constants are as commonly
    quoted, not checked against the source.

    >>> law = tl.damage.FromStrength(strength=3e6)
    >>> f"{law.at(5e9).rate / law.at(10e9).rate:.1f} times faster at half the modulus"
    '5.7 times faster at half the modulus'
    """

    exponent: Number = 4.0
    strength: Modulus = 4e6
    scatter: Number = _SCATTER
    source: str = "Molenaar (1984), PAAPT 53"
    caveat: str = f"4.389 and 2.52 are {COMMONLY_QUOTED}"

    def __post_init__(self) -> None:
        positive("strength", self.strength, "Pa", "asphalt has 1e6 to 6e6")
        _check(self.exponent, self.scatter)

    def at(self, modulus: float) -> ParisLaw:
        """Paris' law at a modulus, Pa."""
        product = (modulus / 1e6) * (self.strength / 1e6) * self.exponent
        return ParisLaw.from_millimetres(
            10 ** (4.389 - 2.52 * math.log10(product)),
            self.exponent,
            scatter=self.scatter,
            source=self.source,
            caveat=self.caveat,
        )

    def __str__(self) -> str:
        return f"Paris' law by modulus and strength, {self.strength / 1e6:g} MPa, n = {self.exponent:g}"

    __repr__ = as_call


def _check(exponent: float, scatter: float) -> None:
    if not (math.isfinite(exponent) and 1 <= exponent <= 10):
        raise InputError(f"the exponent of Paris' law must lie in [1, 10], got {exponent}; asphalt has 3 to 6")
    if not 0 <= scatter <= 2:
        raise InputError(f"the scatter of log10 A must lie in [0, 2], got {scatter}; 0.3 is a factor of two")


_OF_THE_LINE = f"n is that of the fatigue line, -1/b; the strength is a usual one; both are {COMMONLY_QUOTED}"
# Tensile strength near 10 °C by what a mix's name begins with, Pa: usual values, none measured on these mixes.
_STRENGTHS: Mapping[str, float] = MappingProxyType(
    {"EB-BBSG": 4e6, "EB-BBME": 4.5e6, "EB-BBA": 4e6, "EB-GB": 3.5e6, "EB-EME": 5e6, "EB-BBM": 3.5e6, "EB-BBTM": 3e6}
)
PARIS: Mapping[str, float] = _STRENGTHS
"""Mixes that have data of crack growth: what their names begin with, and the strength taken, Pa."""


def law_of_mix(material: Material | TemperatureDependent | StressDependent, layer: str) -> GrowthLaw:
    """The law of a layer's mix. Raises InputError for one without data of crack growth."""
    strength = None
    if isinstance(material, Mix):
        names = [name for name in PARIS if material.name.startswith(name)]
        strength = PARIS[max(names, key=len)] if names else None
    if not isinstance(material, Mix) or strength is None or material.slope is None:
        raise InputError(
            f"layer {layer!r}, {material}, has no data of crack growth; give [growth] a law, such as "
            '{ law = "paris", rate = "0.1 mm", exponent = 4 }, its growth per passage at 1 MPa √m'
        )
    return FromStrength(-1 / material.slope, strength, caveat=f"4.389 and 2.52 are {COMMONLY_QUOTED}; {_OF_THE_LINE}")
