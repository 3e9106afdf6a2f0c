"""Plasticity: laws of yielding, and a material that is elastic until it yields.

Pressure-dependent laws use Drucker and Prager's cone; a Mohr-Coulomb material is given by the cone through the
compression edges of its pyramid.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from typing_extensions import Protocol, runtime_checkable

from treadload.describing import as_call
from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.kernels.plasticity.cone import Cone
from treadload.kernels.plasticity.mises import Mises, Viscosity
from treadload.kernels.plasticity.state import ReturnMap
from treadload.materials.elastic import Elastic
from treadload.registry import MATERIALS, PLASTICITY
from treadload.units import Angle, Celsius, Frequency, Modulus, Number, Pressure


@runtime_checkable
class PlasticLaw(Protocol):
    """A law of yielding that is followed step by step.

    >>> law = tl.materials.VonMises(0.4e6)
    >>> isinstance(law, tl.materials.PlasticLaw), round(law.strength / 1e6, 2)  # MPa
    (True, 0.4)
    """

    @property
    def strength(self) -> float:
        """Von Mises stress at which the virgin material yields without mean stress, Pa."""

    def return_map(self, elastic: Elastic, viscosity: Viscosity | None = None) -> ReturnMap:
        """The law's return map at elastic moduli; viscosity: of a law that depends on time."""


@dataclass(frozen=True)
class Swift:
    """Isotropic hardening after Swift: σ = strength (offset + p)^exponent, p the equivalent plastic strain.

    strength: Pa, > 0. offset: > 0, so that the virgin material has a yield stress. exponent: in [0, 1].
    Where strains are counted in microstrain, as in σ = 1280 MPa (4 + 10⁶ p)^0.095, strength is 1280 MPa times
    10^(6·0.095) and offset 4e-6. Raises InputError.

    Source: Swift (1952), J. Mech. Phys. Solids 1, 1-18.

    >>> steel = tl.materials.VonMises(tl.materials.Swift(strength=1280e6 * 10**0.57, offset=4e-6, exponent=0.095))
    >>> round(steel.strength / 1e6)  # MPa, at first yield
    1460
    """

    strength: Pressure
    offset: Number
    exponent: Number

    def __post_init__(self) -> None:
        positive("strength of Swift's law", self.strength, "Pa", "bearing steels are near 4.8e9")
        positive("offset of Swift's law", self.offset, "", "it is a strain, near 4e-6 for bearing steels")
        if isinstance(self.exponent, str) or not 0 <= self.exponent <= 1:
            raise InputError(
                f"exponent of Swift's law must lie in [0, 1], got {self.exponent!r}; steels are near 0.1"
            )

    def curve(self, hardening: Array) -> tuple[Array, Array]:
        """Yield stress and its slope, Pa, at equivalent plastic strains."""
        stress = self.strength * (self.offset + hardening) ** self.exponent
        return stress, self.exponent * stress / (self.offset + hardening)

    __repr__ = as_call


@PLASTICITY.register("von-mises")
@dataclass(frozen=True)
class VonMises:
    """Yielding at a von Mises stress, with isotropic and kinematic hardening: metals.

    yield_stress: Pa, > 0, or Swift's law, which hardens by itself. hardening: slope of the yield stress over
    equivalent plastic strain, Pa, >= 0. kinematic: c, Pa, >= 0: the back stress follows 2/3 c times the plastic
    strain (Prager). recovery: g >= 0: it fades with g times the equivalent plastic strain (Armstrong and Frederick),
    and saturates at c / g. Raises InputError.

    Sources: Prager (1956), J. Appl. Mech. 23, 493-496; Armstrong & Frederick (1966), CEGB report RD/B/N 731.

    >>> tl.materials.VonMises(0.4e6, hardening=60e6)
    VonMises(yield_stress=4e5, hardening=6e7)
    """

    yield_stress: Pressure | Swift
    hardening: Modulus = 0.0
    kinematic: Modulus = 0.0
    recovery: Number = 0.0

    def __post_init__(self) -> None:
        swift = isinstance(self.yield_stress, Swift)
        if not swift:
            positive("yield_stress", self.yield_stress, "Pa", "a mild steel is near 250e6")  # type: ignore[arg-type]
        for name in ("hardening", "kinematic", "recovery"):
            _at_least_zero(name, getattr(self, name), "1" if name == "recovery" else "Pa")
        if swift and self.hardening:
            raise InputError(
                f"Swift's law hardens by itself; leave the hardening of {self.hardening:g} Pa out, or give "
                "yield_stress as a number"
            )
        if self.recovery and not self.kinematic:
            raise InputError(
                f"recovery is {self.recovery:g} without kinematic hardening to recover from; give kinematic, Pa"
            )

    @property
    def strength(self) -> float:
        """See `PlasticLaw`."""
        return float(self._curve(np.zeros(()))[0])

    def _curve(self, hardening: Array) -> tuple[Array, Array]:
        if isinstance(self.yield_stress, Swift):
            return self.yield_stress.curve(hardening)
        return self.yield_stress + self.hardening * hardening, np.full_like(hardening, self.hardening)

    def return_map(self, elastic: Elastic, viscosity: Viscosity | None = None) -> ReturnMap:
        """See `PlasticLaw`."""
        return Mises(elastic.shear_modulus, _bulk(elastic), self._curve, self.kinematic, self.recovery, viscosity)

    __repr__ = as_call


@PLASTICITY.register("drucker-prager")
@dataclass(frozen=True)
class DruckerPrager:
    """Yielding at q + tan β σ_m = d + h p, q von Mises' stress, σ_m the mean stress, tension positive.

    cohesion: d, Pa, > 0. friction_angle: β, rad, in [0, π/2). dilation_angle: ψ, rad, in [0, β]: of plastic flow.
    hardening: h, Pa, >= 0, per equivalent plastic strain p. Angles are those of the plane (σ_m, q).
    Raises InputError.

    Source: Drucker & Prager (1952), Q. Appl. Math. 10, 157-165.

    >>> tl.materials.DruckerPrager(cohesion=50e3, friction_angle=0.5, dilation_angle=0.6)
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: dilation_angle must lie in [0, 0.5] rad, up to the friction angle, got 0.6;
    beyond it flow would make work of nothing
    """

    cohesion: Pressure
    friction_angle: Angle
    dilation_angle: Angle = 0.0
    hardening: Modulus = 0.0

    def __post_init__(self) -> None:
        _check_cone(self)

    @property
    def strength(self) -> float:
        """See `PlasticLaw`."""
        return self.cohesion

    def return_map(self, elastic: Elastic, viscosity: Viscosity | None = None) -> ReturnMap:
        """See `PlasticLaw`."""
        slopes = math.tan(self.friction_angle), math.tan(self.dilation_angle)
        return _cone(elastic, *slopes, self.cohesion, self.hardening, viscosity)

    __repr__ = as_call


@PLASTICITY.register("mohr-coulomb")
@dataclass(frozen=True)
class MohrCoulomb:
    """Yielding of soil, unbound courses and hot asphalt: cohesion and an angle of internal friction.

    cohesion: c, Pa, > 0. friction_angle: φ, rad, in [0, π/2); 35 degrees is math.radians(35). dilation_angle: ψ, rad,
    in [0, φ]: how much it swells as it shears. hardening: Pa, >= 0, slope of the von Mises strength over equivalent
    plastic strain. The cone that is used goes through the compression edges of the pyramid, as triaxial tests measure
    them: tan β = 6 sin φ / (3 - sin φ), d = 6 c cos φ / (3 - sin φ), and the flow with ψ; in triaxial extension
    the cone is stronger than the pyramid. Raises InputError.

    Source: de Souza Neto, Perić & Owen (2008), Computational Methods for Plasticity, section 6.4.4.

    >>> soil = tl.materials.MohrCoulomb(cohesion=20e3, friction_angle=0.61)  # 35 degrees
    >>> round(soil.strength / 1e3, 1)  # kPa, von Mises stress at yield under no mean stress
    40.5
    """

    cohesion: Pressure
    friction_angle: Angle
    dilation_angle: Angle = 0.0
    hardening: Modulus = 0.0

    def __post_init__(self) -> None:
        _check_cone(self)

    @property
    def strength(self) -> float:
        """See `PlasticLaw`."""
        return 6 * self.cohesion * math.cos(self.friction_angle) / (3 - math.sin(self.friction_angle))

    def return_map(self, elastic: Elastic, viscosity: Viscosity | None = None) -> ReturnMap:
        """See `PlasticLaw`."""
        friction, dilation = (6 * math.sin(a) / (3 - math.sin(a)) for a in (self.friction_angle, self.dilation_angle))
        return _cone(elastic, friction, dilation, self.strength, self.hardening, viscosity)

    __repr__ = as_call


@PLASTICITY.register("perzyna")
@dataclass(frozen=True)
class Perzyna:
    """A law whose stress may exceed the yield surface for a time: dp/dt = fluidity (f / strength)^exponent.

    law: VonMises, DruckerPrager or MohrCoulomb, with its yield function f and its strength, Pa. fluidity: 1/s, > 0:
    the rate of plastic strain at twice the strength. exponent: >= 1. What a pass leaves grows with the time that it
    takes: the slower, the more; no number of passes ends it while the stress stays above the surface.
    Raises InputError.

    Source: Perzyna (1966), Adv. Appl. Mech. 9, 243-377.

    >>> tl.materials.Perzyna(tl.materials.VonMises(0.4e6), fluidity=1e-3, exponent=0.5)
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: exponent of Perzyna's law must lie in [1, 50], got 0.5; 1 is linear
    """

    law: PlasticLaw
    fluidity: Frequency
    exponent: Number = 1.0

    def __post_init__(self) -> None:
        if not isinstance(self.law, VonMises | DruckerPrager | MohrCoulomb):
            raise InputError(
                f"the law of Perzyna must be VonMises, DruckerPrager or MohrCoulomb, got {type(self.law).__name__}"
            )
        positive("fluidity", self.fluidity, "1/s", "the rate of plastic strain at twice the strength")
        if isinstance(self.exponent, str) or not (math.isfinite(self.exponent) and 1 <= self.exponent <= 50):
            raise InputError(f"exponent of Perzyna's law must lie in [1, 50], got {self.exponent!r}; 1 is linear")

    @property
    def strength(self) -> float:
        """See `PlasticLaw`."""
        return self.law.strength

    def return_map(self, elastic: Elastic, viscosity: Viscosity | None = None) -> ReturnMap:
        """See `PlasticLaw`."""
        return self.law.return_map(elastic, Viscosity(self.fluidity, self.exponent, self.strength))

    __repr__ = as_call


@PLASTICITY.register("passes-power-law")
@dataclass(frozen=True)
class PassesPowerLaw:
    """Plastic strain that grows with the passes: p = factor q/E N^exponent, q the largest von Mises stress of a pass.

    factor: > 0. exponent: in (0, 1]. The strain flows along the deviator of the stress at that instant. It fits tests
    of many load cycles at one stress; it knows no yield stress and no history.
    Raises InputError.

    Source of the form: Monismith, Ogawa & Freeme (1975), Transp. Res. Rec. 537, 1-17.

    >>> law = tl.materials.PassesPowerLaw.asphalt(40.0)  # °C
    >>> f"100 times the passes: {100**law.exponent:.1f} times the plastic strain"
    '100 times the passes: 9.1 times the plastic strain'
    """

    factor: Number
    exponent: Number

    def __post_init__(self) -> None:
        positive("factor", self.factor, "", "hot asphalt is near 1")
        if isinstance(self.exponent, str) or not 0 < self.exponent <= 1:
            raise InputError(f"exponent must lie in (0, 1], got {self.exponent!r}; asphalt is near 0.48")

    @classmethod
    def asphalt(cls, temperature: Celsius) -> PassesPowerLaw:
        """Hot-mix asphalt after the national calibration of the American design guide of 2004.

        Its ratio of plastic to resilient vertical strain is 10^-3.35412 T^1.5606 N^0.4791, T in °F, without its
        factor of depth. temperature: °C, in [5, 65]. Raises InputError.

        Source: ARA (2004), Guide for Mechanistic-Empirical Design, NCHRP 1-37A, part 3, chapter 3.
        """
        if isinstance(temperature, str) or not 5 <= temperature <= 65:
            raise InputError(f"temperature must lie in [5, 65] °C, got {temperature!r}; the data end there")
        return cls(10**-3.35412 * (32 + 1.8 * temperature) ** 1.5606, 0.4791)

    __repr__ = as_call


@MATERIALS.register("elastoplastic")
@dataclass(frozen=True)
class ElastoPlastic:
    """A material that is elastic until it yields.

    elastic: its elastic part, which contact and response take. law: how it yields, which `roll_passes` follows:
    VonMises, MohrCoulomb, DruckerPrager, Perzyna or PassesPowerLaw. Raises InputError.

    >>> soil = tl.materials.ElastoPlastic(tl.Elastic(60e6, 0.35), tl.materials.VonMises(120e3))
    >>> f"yields at {soil.yield_strain:.2%} of strain"
    'yields at 0.20% of strain'
    """

    elastic: Elastic
    law: PlasticLaw | PassesPowerLaw

    def __post_init__(self) -> None:
        if not isinstance(self.elastic, Elastic):
            raise InputError(
                f"the elastic part must be an Elastic, got {type(self.elastic).__name__}: of a viscoelastic material "
                "give the modulus at the time of loading"
            )
        if not isinstance(self.law, PlasticLaw | PassesPowerLaw):
            raise InputError(
                f"the law must be VonMises, MohrCoulomb, DruckerPrager, Perzyna or PassesPowerLaw, got {self.law!r}"
            )
        if self.elastic.poisson >= 0.5 and not isinstance(self.law, PassesPowerLaw):
            raise InputError(
                f"poisson is {self.elastic.poisson:g}: what yields needs a bulk modulus; give at most 0.49"
            )

    @property
    def yield_strain(self) -> float:
        """Strength over modulus. Raises InputError for a law of passes, which has none."""
        return self._followed.strength / self.elastic.modulus

    def return_map(self) -> ReturnMap:
        """The law at the elastic moduli. Raises InputError for a law of passes, which has none."""
        return self._followed.return_map(self.elastic)

    @property
    def _followed(self) -> PlasticLaw:
        if isinstance(self.law, PassesPowerLaw):
            raise InputError("a law of passes is not followed step by step; roll_passes evaluates it as a whole")
        return self.law

    def __str__(self) -> str:
        return f"{self.elastic}, yields by {type(self.law).__name__}"

    __repr__ = as_call


PLASTICITY.makes(PlasticLaw, PassesPowerLaw)


def _bulk(elastic: Elastic) -> float:
    return elastic.modulus / (3 * (1 - 2 * elastic.poisson))


def _cone(
    elastic: Elastic, friction: float, dilation: float, strength: float, hardening: float, viscosity: Viscosity | None
) -> Cone:
    return Cone(elastic.shear_modulus, _bulk(elastic), friction, dilation, strength, hardening, viscosity)


def _check_cone(law: DruckerPrager | MohrCoulomb) -> None:
    positive("cohesion", law.cohesion, "Pa", "hot asphalt is near 100e3, an unbound course near 20e3")
    if isinstance(law.friction_angle, str) or not 0 <= law.friction_angle < math.pi / 2:
        raise InputError(
            f"friction_angle must lie in [0, π/2) rad, got {law.friction_angle!r}; 35 degrees is math.radians(35), "
            'in a case "35 deg"'
        )
    if isinstance(law.dilation_angle, str) or not 0 <= law.dilation_angle <= law.friction_angle:
        raise InputError(
            f"dilation_angle must lie in [0, {law.friction_angle:g}] rad, up to the friction angle, got "
            f"{law.dilation_angle!r}; beyond it flow would make work of nothing"
        )
    _at_least_zero("hardening", law.hardening, "Pa")


def _at_least_zero(name: str, value: float, unit: str) -> None:
    if isinstance(value, bool | str) or not (math.isfinite(value) and value >= 0):
        raise InputError(f"{name} must be a number >= 0{f' {unit}' if unit != '1' else ''}, got {value!r}")
