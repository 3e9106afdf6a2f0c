"""Friction laws: how much shear a cell of the contact can carry.

A law gives the local coefficient μ ≥ 0; the bound of the shear is μp. The laws here that read the slip fall with it,
so that the bound at rest is the largest; another may rise, as rubber does at first. Laws on a `base` multiply its
coefficient.

Sources: Vollebregt & Schuttelaars (2012), J. Sound Vib. 331, 2141-2155 (falling friction, half-value speeds, as
in the program CONTACT); Kalker (1990), section 1.4; Schallamach (1952), Proc. Phys. Soc. B 65, 657-661 (rubber).
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from treadload.errors import InputError, positive, within
from treadload.kernels.arrays import Array
from treadload.registry import FRICTION
from treadload.units import Number, Pressure, SlidingSpeed

# Beyond them arithmetic ends, not friction: of μ > 0, of the ratio of an ellipse's axes, of slip speeds, m/s, and of
# pressures, Pa.
_COEFFICIENTS, _LONGEST, _SPEEDS, _PRESSURES = (1e-9, 1e6), 1e3, (1e-12, 1e12), (1e-9, 1e15)


@dataclass(frozen=True)
class Interface:
    """What friction may depend on, at the cells of a contact.

    pressure: (ny, nx) ≥ 0, Pa. slip: of the tire relative to the road, over the rolling speed (2, ny, nx).
    x (nx,), y (ny,): cell centres, m, ascending. dx: cell size along travel, m. speed: of rolling, m/s; None if
    it is not known.
    """

    pressure: Array
    slip: Array
    x: Array
    y: Array
    dx: float
    speed: float | None = None

    @property
    def slip_speed(self) -> Array:
        """Speed of slip (ny, nx), m/s. Raises InputError without a rolling speed."""
        speed: Array = np.hypot(self.slip[0], self.slip[1]) * self.known_speed
        return speed

    @property
    def known_speed(self) -> float:
        """The rolling speed, m/s. Raises InputError where it is not known."""
        if self.speed is None:
            raise InputError("friction that depends on the slip speed or on heat needs the rolling speed (m/s)")
        return self.speed


class FrictionLaw(ABC):
    """What every friction law provides.

    axes: (d_x, d_y) with d_x d_y = 1: shear is bounded by the ellipse (q_x/d_x)² + (q_y/d_y)² ≤ (μp)², and slips
    against its normal (the associated rule); (1, 1) is the disc. needs_speed: μ depends on the slip speed, in m/s.
    largest: an upper bound of μ, whatever the pressure, the place and the slip. outermost: it cannot be the base
    of another law.
    """

    outermost: ClassVar[bool] = False

    @property
    def axes(self) -> tuple[float, float]:
        """Factors (d_x, d_y) of the ellipse's axes, of product 1."""
        return 1.0, 1.0

    @property
    def needs_speed(self) -> bool:
        """Whether μ depends on the slip speed, so that the rolling speed must be known."""
        return False

    @property
    @abstractmethod
    def largest(self) -> float:
        """Upper bound of μ."""

    @abstractmethod
    def coefficient(self, at: Interface) -> Array:
        """Local coefficient μ (ny, nx); it means nothing where there is no pressure. Raises InputError."""

    def bound(self, at: Interface) -> Array:
        """μp (ny, nx), Pa, zero outside the contact. Raises InputError."""
        return np.where(at.pressure > 0, self.coefficient(at) * at.pressure, 0.0)

    def temperature(self, at: Interface) -> Array | None:
        """Flash temperature (ny, nx), K above the bodies, of a law that reads it; else None."""
        return None


FRICTION.makes(FrictionLaw)


@dataclass(frozen=True)
class Coulomb(FrictionLaw):
    """Coulomb's law: one coefficient μ ≥ 0 for stick and slip, everywhere.

    >>> tl.contact.friction.Coulomb(0.7).largest
    0.7
    """

    number: float

    def __post_init__(self) -> None:
        check_coefficient("friction", self.number)

    @property
    def largest(self) -> float:
        """μ."""
        return self.number

    def coefficient(self, at: Interface) -> Array:
        """μ (ny, nx), the same everywhere."""
        return np.full(at.pressure.shape, float(self.number))

    def __str__(self) -> str:
        return f"{self.number:g}"


@FRICTION.register("coulomb")
def _coulomb(coefficient: Number) -> Coulomb:
    """One coefficient for stick and slip, everywhere: the same as a number in place of the table.

    coefficient: μ >= 0.
    """
    return Coulomb(coefficient)


@dataclass(frozen=True)
class _Falling(FrictionLaw):
    """Friction that falls with slip speed from a static to a kinetic value.

    static, kinetic: μ at rest and in fast slip, static ≥ kinetic ≥ 0. reference_speed: of slip, m/s, > 0, at which
    half of the difference is gone.
    """

    static: Number
    kinetic: Number
    reference_speed: SlidingSpeed

    def __post_init__(self) -> None:
        check_coefficient("static friction", self.static)
        check_coefficient("kinetic friction", self.kinetic)
        if self.kinetic > self.static:
            raise InputError(
                f"kinetic friction must be at most the static, got {self.kinetic:g} > {self.static:g}; "
                "for friction that rises with slip write a law of your own"
            )
        positive("reference_speed", self.reference_speed, "m/s", "without a fall, friction is a number")
        within("reference_speed", self.reference_speed, *_SPEEDS, "m/s", "without a fall, friction is a number")

    @property
    def needs_speed(self) -> bool:
        """True: μ reads the slip speed."""
        return True

    @property
    def largest(self) -> float:
        """The static coefficient."""
        return self.static

    def coefficient(self, at: Interface) -> Array:
        """μ (ny, nx) at the speed of slip."""
        share = self._share(at.slip_speed / self.reference_speed)
        return self.kinetic + (self.static - self.kinetic) * share

    @abstractmethod
    def _share(self, speed: Array) -> Array:
        """Share of static minus kinetic that is left at a speed relative to the reference: 1 at 0, ½ at 1."""

    def __str__(self) -> str:
        return f"{self.static:g} → {self.kinetic:g} ({type(self).__name__}, half-way at {self.reference_speed:g} m/s)"


@FRICTION.register("linear")
class LinearFalling(_Falling):
    """μ = μ_k + (μ_s - μ_k) max(0, 1 - v/2v_h): on a straight line to the kinetic value at twice v_h.

    >>> law = tl.contact.friction.LinearFalling(0.8, 0.5, 2.0)
    >>> law.largest
    0.8
    """

    def _share(self, speed: Array) -> Array:
        share: Array = np.maximum(0.0, 1 - 0.5 * speed)
        return share


@FRICTION.register("rational")
class Rational(_Falling):
    """μ = μ_k + (μ_s - μ_k) / (1 + v/v_h)."""

    def _share(self, speed: Array) -> Array:
        return 1 / (1 + speed)


@FRICTION.register("exponential")
class Exponential(_Falling):
    """μ = μ_k + (μ_s - μ_k) 2^(-v/v_h)."""

    def _share(self, speed: Array) -> Array:
        share: Array = np.exp2(-speed)
        return share


@FRICTION.register("pressure")
@dataclass(frozen=True)
class PressureDependent(FrictionLaw):
    """Rubber: μ = μ_ref (p/p_ref)^(-n), and never more than `upper`.

    reference: μ_ref ≥ 0 at p_ref. reference_pressure: p_ref, Pa, > 0. exponent: n in [0, 1/3]; 1/3 is a smooth sphere
    of rubber on a smooth plane, 0 a rough road. upper: μ under vanishing pressure; left out, twice μ_ref.
    Source: Schallamach (1952).
    """

    reference: Number
    reference_pressure: Pressure
    exponent: Number
    upper: Number | None = None

    def __post_init__(self) -> None:
        check_coefficient("reference friction", self.reference)
        positive("reference_pressure", self.reference_pressure, "Pa", "tires press with some 1e6")
        within("reference_pressure", self.reference_pressure, *_PRESSURES, "Pa", "tires press with some 1e6")
        if not (math.isfinite(self.exponent) and 0 <= self.exponent <= 1 / 3 + 1e-12):
            raise InputError(f"exponent of the pressure must lie in [0, 1/3], got {self.exponent:g}")
        if self.upper is not None:
            check_coefficient("upper bound of friction", self.upper)
            if self.upper < self.reference:
                raise InputError(
                    f"upper bound of friction must be at least the reference {self.reference:g}, got {self.upper:g}"
                )

    @property
    def largest(self) -> float:
        """The coefficient under vanishing pressure."""
        return 2 * self.reference if self.upper is None else self.upper

    def coefficient(self, at: Interface) -> Array:
        """μ (ny, nx) at the pressure."""
        # A pressure of nothing at all gives the upper value without a division by zero.
        relative = np.maximum(at.pressure / self.reference_pressure, np.finfo(float).tiny)
        mu: Array = np.minimum(self.reference * relative**-self.exponent, self.largest)
        return mu

    def __str__(self) -> str:
        return f"{self.reference:g} (p/{self.reference_pressure / 1e3:g} kPa)^-{self.exponent:.3g} ≤ {self.largest:g}"


@FRICTION.register("anisotropic")
@dataclass(frozen=True)
class Anisotropic(FrictionLaw):
    """Friction that differs along travel and across: the ellipse (q_x/μ_x)² + (q_y/μ_y)² ≤ p².

    along, across: μ_x, μ_y > 0; on a base, factors of its coefficient. base: law that it multiplies. Slip follows the
    associated rule: it is normal to the ellipse, so that shear opposes it only along the axes. Source: Michałowski &
    Mróz (1978), Arch. Mech. 30, 259-276.

    >>> law = tl.contact.friction.Anisotropic(along=0.8, across=0.6)
    >>> law.along, law.across
    (0.8, 0.6)
    """

    along: Number
    across: Number
    base: FrictionLaw | None = None

    def __post_init__(self) -> None:
        positive("friction along travel", self.along, remedy="a dry road is near 0.7")
        positive("friction across travel", self.across, remedy="a dry road is near 0.7")
        ratio = self.along / self.across
        within(
            "friction along travel over that across", ratio, 1 / _LONGEST, _LONGEST, "", "grooves make it 0.5 to 2"
        )
        check_base("an ellipse", self.base)

    @property
    def axes(self) -> tuple[float, float]:
        """Square root of μ_x/μ_y and its inverse, times those of the base."""
        ratio = math.sqrt(self.along / self.across)
        d_x, d_y = (1.0, 1.0) if self.base is None else self.base.axes
        return ratio * d_x, d_y / ratio

    @property
    def needs_speed(self) -> bool:
        """As the base."""
        return self.base is not None and self.base.needs_speed

    @property
    def largest(self) -> float:
        """Upper bound of the geometric mean."""
        return self._mean * (1.0 if self.base is None else self.base.largest)

    def coefficient(self, at: Interface) -> Array:
        """Geometric mean of μ_x and μ_y (ny, nx)."""
        if self.base is None:
            return np.full(at.pressure.shape, self._mean)
        return self._mean * self.base.coefficient(at)

    @property
    def _mean(self) -> float:
        return math.sqrt(self.along * self.across)

    def __str__(self) -> str:
        text = f"({self.along:g} along, {self.across:g} across)"
        return text if self.base is None else f"{text} x {self.base}"


def law_of(friction: float | FrictionLaw) -> FrictionLaw:
    """The law that a number (Coulomb's coefficient) or a law stands for. Raises InputError."""
    if isinstance(friction, FrictionLaw):
        return friction
    if isinstance(friction, bool) or not isinstance(friction, int | float | np.integer | np.floating):
        raise InputError(f"friction must be a coefficient such as 0.7 or a friction law, got {friction!r}")
    return Coulomb(float(friction))


def largest_force(
    axes: tuple[float, float], forces: tuple[float | None, float | None], total: float
) -> tuple[float, float]:
    """Size of a prescribed force and of the largest in its direction, N.

    axes: of the law. forces: along x and y, N; None counts as zero. total: Σ of the bound, N.
    """
    pull = [force or 0.0 for force in forces]
    demand = math.hypot(*pull)
    # Stretched by its axes, the ellipse is a disc: on it the direction counts.
    stretched = math.hypot(*(force / d for force, d in zip(pull, axes, strict=True)))
    return demand, total if demand == 0 else total * (demand / stretched)


def check_coefficient(name: str, value: float) -> None:
    """Refuse what is not a finite number >= 0."""
    if not math.isfinite(value):
        raise InputError(f"{name} must be a finite number, got {value}")
    if value < 0:
        raise InputError(f"{name} must be >= 0, got {value:g}; a dry road is near 0.7")
    if value > 0:
        within(name, value, *_COEFFICIENTS, "", "a dry road is near 0.7, and 0 is no friction")


def check_base(what: str, base: object) -> None:
    """Refuse what cannot be the base of a law."""
    if base is None or (isinstance(base, FrictionLaw) and not base.outermost):
        return
    if isinstance(base, FrictionLaw):
        raise InputError(
            f"{what} cannot have {type(base).__name__} as its base: heat comes from the whole friction; "
            f"put {what} inside it, as its base"
        )
    raise InputError(f"the base of {what} must be a friction law, got {base!r}")
