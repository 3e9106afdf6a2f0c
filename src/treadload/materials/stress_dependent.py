"""Unbound materials whose modulus follows from the state of stress, and what they are once it is known."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from treadload.describing import as_call
from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.materials.elastic import Elastic
from treadload.materials.stress_laws import Boyce, ModulusLaw
from treadload.registry import MATERIALS
from treadload.units import Length, Number, Pressure, Share, UnitWeight

POISSON = 0.35
"""Poisson's ratio of a law that has none of its own."""
# Under a truck, below a usual course of asphalt: bulk and deviator stress, Pa, of the nominal modulus.
_NOMINAL = 150e3, 75e3
# Soils below are neither lighter nor heavier, N/m³.
_LIGHTEST, _HEAVIEST = 5e3, 40e3


@MATERIALS.register("stress-dependent")
@dataclass(frozen=True)
class StressDependent:
    """An unbound material that is elastic with the modulus of its law under the stress of loads and its own weight.

    law: KTheta, Uzan, Universal, Boyce, Bilinear, or any ModulusLaw. poisson: Poisson's ratio; left out, that of the
    law, or 0.35. earth_pressure: horizontal over vertical stress of its own weight, K₀; 0.6 is usual of granular
    materials, 0.8 of fine soils. unit_weight: N/m³. tension: share of a tensile principal stress that counts in bulk
    and deviator stress, in [0, 1]: 0 cuts tension off, 1 counts it as linear layers have it. least_stress: which bulk
    and deviator stress do not fall below in the law, Pa. sublayer: greatest thickness of the parts into which a layer
    is divided over depth, m; left out, the rule of `pavement.stress_sublayers`. factor: on the modulus of the law,
    as of moisture or season. Raises InputError.

    >>> base = tl.materials.StressDependent(tl.materials.Uzan(k1=90e6, k2=0.5, k3=-0.1), poisson=0.35)
    >>> base.poisson
    0.35
    """

    law: ModulusLaw
    poisson: Number | None = None
    earth_pressure: Number = 0.6
    unit_weight: UnitWeight = 20e3
    tension: Share = 0.5
    least_stress: Pressure = 3e3
    sublayer: Length | None = None
    factor: Number = 1.0

    def __post_init__(self) -> None:
        if not isinstance(self.law, ModulusLaw):
            raise InputError(f"law must be KTheta, Uzan, Universal, Boyce or Bilinear, got {self.law!r}")
        if self.poisson is not None and isinstance(self.law, Boyce):
            raise InputError(
                f"Boyce's law has a Poisson's ratio of its own, got poisson = {self.poisson!r}; leave it out"
            )
        if self.poisson is not None and (isinstance(self.poisson, str) or not -1 < self.poisson < 0.5):
            raise InputError(f"poisson must lie in (-1, 0.5), got {self.poisson!r}; unbound materials are near 0.35")
        if isinstance(self.earth_pressure, str) or not 0 <= self.earth_pressure <= 5:
            raise InputError(
                f"earth_pressure must lie in [0, 5], got {self.earth_pressure!r}; 0.6 is usual of granular "
                "materials, 0.8 of fine soils"
            )
        if isinstance(self.unit_weight, str) or not _LIGHTEST <= self.unit_weight <= _HEAVIEST:
            raise InputError(
                f"unit_weight must lie in [{_LIGHTEST:g}, {_HEAVIEST:g}] N/m³, got {self.unit_weight!r}; 20 kN/m³ is "
                "usual, a density in kg/m³ times 9.81"
            )
        if isinstance(self.tension, str) or not 0 <= self.tension <= 1:
            raise InputError(f"tension must lie in [0, 1], got {self.tension!r}; 0.5 is the default")
        positive("least_stress", self.least_stress, "Pa", "3e3 is the default")
        positive("factor", self.factor, remedy="1 is the law as it is")
        if self.sublayer is not None:
            positive("sublayer", self.sublayer, "m", "leave it out for parts that grow with depth")

    def moduli(self, bulk: ArrayLike, deviator: ArrayLike) -> tuple[Array, Array]:
        """Young's modulus, Pa, and Poisson's ratio under bulk and deviator stress, Pa, compression positive."""
        theta, q = (np.maximum(np.asarray(part, dtype=float), self.least_stress) for part in (bulk, deviator))
        modulus = self.factor * self.law.modulus(theta, q)
        if isinstance(self.law, Boyce):
            return modulus, self.law.poisson_ratio(theta, q)
        return modulus, np.full(np.shape(modulus), POISSON if self.poisson is None else self.poisson)

    def invariants(self, principal: ArrayLike) -> tuple[Array, Array]:
        """Bulk and deviator stress that the law takes, Pa.

        principal: stresses (3, ...), Pa, compression positive, of which tensile ones count by the share `tension`.
        """
        stress = np.asarray(principal, dtype=float)
        stress = np.where(stress < 0, self.tension * stress, stress)
        first, second, third = stress
        square = 0.5 * ((first - second) ** 2 + (second - third) ** 2 + (third - first) ** 2)
        return stress.sum(axis=0), np.sqrt(square)

    def under(self, bulk: float, deviator: float) -> AtStress:
        """The material under bulk and deviator stress, Pa, compression positive."""
        modulus, poisson = self.moduli(bulk, deviator)
        return AtStress(float(modulus), float(poisson), bulk=float(bulk), deviator=float(deviator), law=self.law)

    @property
    def nominal(self) -> AtStress:
        """The material at a bulk stress of 150 kPa and a deviator stress of 75 kPa, where no load is known."""
        return self.under(*_NOMINAL)

    def __str__(self) -> str:
        return f"stress-dependent, {self.law}" + ("" if self.factor == 1 else f", times {self.factor:g}")

    __repr__ = as_call


@dataclass(frozen=True)
class AtStress(Elastic):
    """A stress-dependent material under a state of stress: elastic.

    modulus: Pa. poisson: Poisson's ratio. bulk, deviator: stress of the law, Pa, compression positive. law: of the
    modulus.

    >>> base = tl.materials.StressDependent(tl.materials.KTheta(k1=90e6, k2=0.5), poisson=0.35)
    >>> [round(base.under(bulk, 50e3).modulus / 1e6) for bulk in (100e3, 400e3)]  # MPa under 100 and 400 kPa
    [89, 179]
    """

    bulk: float = field(default=np.nan, compare=False, kw_only=True)
    deviator: float = field(default=np.nan, compare=False, kw_only=True)
    law: ModulusLaw | None = field(default=None, compare=False, kw_only=True)

    def __str__(self) -> str:
        return f"{super().__str__()} at θ = {self.bulk / 1e3:.3g} kPa, q = {self.deviator / 1e3:.3g} kPa"

    __repr__ = as_call


@dataclass(frozen=True, kw_only=True)
class UnboundByStress(StressDependent):
    """A stress-dependent material of the catalogue.

    name: in the catalogue. source: where the numbers are from. caveats: what is not certain about them, a
    sentence each.

    >>> base = tl.catalogue.mixes["FDOT limerock"]
    >>> [round(base.under(bulk, 75e3).modulus / 1e6) for bulk in (150e3, 300e3)]  # MPa: stiffer under a larger load
    [134, 199]
    """

    name: str
    source: str = field(default="", repr=False)
    caveats: tuple[str, ...] = field(default=(), repr=False)

    def __str__(self) -> str:
        return f"{self.name}, {super().__str__()}"

    __repr__ = as_call
