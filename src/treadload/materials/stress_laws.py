"""Laws of the resilient modulus of unbound materials over the state of stress.

All take the bulk stress θ = σ₁ + σ₂ + σ₃ and the deviator stress q, which is σ₁ - σ₃ where two principal stresses are
equal, as in a triaxial cell and below the axis of a round load, and 3/√2 of the octahedral shear stress anywhere.
Compression is positive here, as the laws are published.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from typing_extensions import Protocol, runtime_checkable

from treadload.describing import as_call
from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.registry import MODULUS_LAWS
from treadload.units import Modulus, Number, Pressure

ATMOSPHERE = 101_325.0
"""Pressure of the atmosphere, Pa: the usual reference of laws that are published without dimension."""
# What is nearly incompressible is as stiff as this in volume.
_MOST_POISSON = 0.49


@runtime_checkable
class ModulusLaw(Protocol):
    """How stiff a material is under a state of stress.

    >>> law = tl.materials.KTheta(k1=90e6, k2=0.5)
    >>> isinstance(law, tl.materials.ModulusLaw), round(float(law.modulus(150e3, 75e3)) / 1e6)  # MPa
    (True, 110)
    """

    def modulus(self, bulk: ArrayLike, deviator: ArrayLike) -> Array:
        """Young's modulus, Pa, under bulk stress and deviator stress, Pa, compression positive, > 0."""


MODULUS_LAWS.makes(ModulusLaw)


@MODULUS_LAWS.register("k-theta")
@dataclass(frozen=True)
class KTheta:
    """M = k₁ (θ / reference)^k₂: granular materials.

    k1: modulus at the reference, Pa. k2: exponent, 0.3 to 0.7 of granular materials. reference: of stress, Pa; a law
    in psi has 1 psi. Raises InputError.
    Source: Hicks & Monismith (1971), Highway Research Record 345, 15-31.

    >>> law = tl.materials.KTheta(k1=90e6, k2=0.5)
    >>> law.k2
    0.5
    """

    k1: Modulus
    k2: Number
    reference: Pressure = ATMOSPHERE

    def __post_init__(self) -> None:
        _check(self, ("k2",))

    def modulus(self, bulk: ArrayLike, deviator: ArrayLike) -> Array:
        """See `ModulusLaw`."""
        theta, _ = np.broadcast_arrays(np.asarray(bulk, dtype=float), deviator)
        return np.asarray(self.k1 * (theta / self.reference) ** self.k2)

    def __str__(self) -> str:
        return f"M = {self.k1 / 1e6:g} MPa (θ / {self.reference / 1e3:g} kPa)^{self.k2:g}"

    __repr__ = as_call


@MODULUS_LAWS.register("uzan")
@dataclass(frozen=True)
class Uzan:
    """M = k₁ (θ / reference)^k₂ (q / reference)^k₃: granular materials that soften or harden with shear.

    k1: modulus at the reference, Pa. k2, k3: exponents of bulk and of deviator stress. reference: of stress, Pa; a
    law in psi has 1 psi. Raises InputError.
    Source: Uzan (1985), Transportation Research Record 1022, 52-59.

    >>> tl.materials.Uzan(k1=90e6, k2=0.5, k3=-0.1).k3
    -0.1
    """

    k1: Modulus
    k2: Number
    k3: Number
    reference: Pressure = ATMOSPHERE

    def __post_init__(self) -> None:
        _check(self, ("k2", "k3"))

    def modulus(self, bulk: ArrayLike, deviator: ArrayLike) -> Array:
        """See `ModulusLaw`."""
        theta, q = np.asarray(bulk, dtype=float), np.asarray(deviator, dtype=float)
        return np.asarray(self.k1 * (theta / self.reference) ** self.k2 * (q / self.reference) ** self.k3)

    def __str__(self) -> str:
        kilopascals = f"{self.reference / 1e3:g} kPa"
        return f"M = {self.k1 / 1e6:g} MPa (θ / {kilopascals})^{self.k2:g} (q / {kilopascals})^{self.k3:g}"

    __repr__ = as_call


@MODULUS_LAWS.register("universal")
@dataclass(frozen=True)
class Universal:
    """M = k₁ pₐ (θ / pₐ)^k₂ (τ / pₐ + 1)^k₃ with the octahedral shear stress τ = √2/3 q: granular, soils.

    k1: without dimension, > 0. k2: exponent of bulk stress, ≥ 0. k3: exponent of shear, ≤ 0. reference: pₐ, Pa.
    Raises InputError.
    Source: NCHRP project 1-28A; Andrei, Witczak, Schwartz & Uzan (2004), Transportation Research Record 1874, 29-37.

    >>> tl.materials.Universal(k1=1000.0, k2=0.6, k3=-0.2).k1
    1000.0
    """

    k1: Number
    k2: Number
    k3: Number
    reference: Pressure = ATMOSPHERE

    def __post_init__(self) -> None:
        _check(self, ("k2", "k3"), unit="")
        if self.k2 < 0 or self.k3 > 0:
            raise InputError(
                f"the universal law needs k2 >= 0 and k3 <= 0, got {self.k2:g} and {self.k3:g}; materials stiffen "
                "with confinement and soften with shear"
            )

    def modulus(self, bulk: ArrayLike, deviator: ArrayLike) -> Array:
        """See `ModulusLaw`."""
        theta, q = np.asarray(bulk, dtype=float), np.asarray(deviator, dtype=float)
        shear = math.sqrt(2) / 3 * q / self.reference
        return np.asarray(self.k1 * self.reference * (theta / self.reference) ** self.k2 * (shear + 1) ** self.k3)

    def __str__(self) -> str:
        return f"M = {self.k1:g} pₐ (θ / pₐ)^{self.k2:g} (τ / pₐ + 1)^{self.k3:g}, pₐ = {self.reference / 1e3:g} kPa"

    __repr__ = as_call


@MODULUS_LAWS.register("boyce")
@dataclass(frozen=True)
class Boyce:
    """K = Kₐ (p/pₐ)^(1-n) / (1 - β q²/p²), G = Gₐ (p/pₐ)^(1-n), β = (1-n) Kₐ / 6Gₐ, p = θ/3: granular materials.

    bulk_modulus: Kₐ, Pa. shear_modulus: Gₐ, Pa. n: in (0, 1]; 1 is linear. reference: pₐ, Pa. It has its own
    Poisson's ratio, taken as 0.49 at most, where shear makes the material dilate. Raises InputError.
    Source: Boyce (1980), International Symposium on Soils under Cyclic and Transient Loading, Swansea, 285-294.

    >>> law = tl.materials.Boyce(bulk_modulus=60e6, shear_modulus=70e6, n=0.3)
    >>> [round(float(law.modulus(bulk, 50e3)) / 1e6) for bulk in (100e3, 400e3)]  # MPa: stiffer under pressure
    [74, 184]
    """

    bulk_modulus: Modulus
    shear_modulus: Modulus
    n: Number
    reference: Pressure = ATMOSPHERE

    def __post_init__(self) -> None:
        for name in ("bulk_modulus", "shear_modulus", "reference"):
            positive(f"{name} of Boyce's law", getattr(self, name), "Pa", "crushed rock is near 100e6 at 100e3")
        if isinstance(self.n, str) or not 0 < self.n <= 1:
            raise InputError(f"n of Boyce's law must lie in (0, 1], got {self.n!r}; granular materials are near 0.3")

    def modulus(self, bulk: ArrayLike, deviator: ArrayLike) -> Array:
        """See `ModulusLaw`."""
        _, shear, poisson = self._moduli(bulk, deviator)
        return np.asarray(2 * shear * (1 + poisson))

    def poisson_ratio(self, bulk: ArrayLike, deviator: ArrayLike) -> Array:
        """Poisson's ratio under bulk and deviator stress, Pa."""
        return self._moduli(bulk, deviator)[2]

    def _moduli(self, bulk: ArrayLike, deviator: ArrayLike) -> tuple[Array, Array, Array]:
        mean, q = np.asarray(bulk, dtype=float) / 3, np.asarray(deviator, dtype=float)
        stiffening = (mean / self.reference) ** (1 - self.n)
        beta = (1 - self.n) * self.bulk_modulus / (6 * self.shear_modulus)
        # Over the bulk modulus: it passes through zero where the material dilates.
        softness = (1 - beta * (q / mean) ** 2) / (self.bulk_modulus * stiffening)
        shear = self.shear_modulus * stiffening
        ratio = np.maximum(softness, 0.0) * shear
        poisson = np.minimum((3 - 2 * ratio) / (2 * (3 + ratio)), _MOST_POISSON)
        return softness, shear, poisson

    def __str__(self) -> str:
        return (
            f"Boyce, K = {self.bulk_modulus / 1e6:g} MPa and G = {self.shear_modulus / 1e6:g} MPa at "
            f"{self.reference / 1e3:g} kPa, n = {self.n:g}"
        )

    __repr__ = as_call


@MODULUS_LAWS.register("bilinear")
@dataclass(frozen=True)
class Bilinear:
    """Two straight lines over the deviator stress: fine-grained soils.

    break_modulus: where the lines meet, Pa. break_deviator: deviator stress there, Pa. slope_below: rise of the
    modulus per fall of the deviator stress below the break, >= 0. slope_above: its fall per rise above, >= 0.
    least, largest: bounds of the modulus, Pa; left out, a tenth and ten times that at the break. Raises InputError.
    Source: Thompson & Robnett (1979), Transportation Engineering Journal ASCE 105, 71-89.

    >>> law = tl.materials.Bilinear(break_modulus=50e6, break_deviator=43e3, slope_below=1110, slope_above=178)
    >>> law.break_modulus
    50000000.0
    """

    break_modulus: Modulus
    break_deviator: Pressure
    slope_below: Number
    slope_above: Number
    least: Modulus | None = None
    largest: Modulus | None = None

    def __post_init__(self) -> None:
        positive("break_modulus", self.break_modulus, "Pa", "soils are near 50e6")
        positive("break_deviator", self.break_deviator, "Pa", "43e3, 6.2 psi, is usual")
        for name in ("slope_below", "slope_above"):
            value = getattr(self, name)
            if isinstance(value, str) or not 0 <= value < math.inf:
                raise InputError(f"{name} of a bilinear law must be >= 0, got {value!r}; 1110 and 178 are usual")
        for name, usual in (("least", 0.1), ("largest", 10.0)):
            if getattr(self, name) is None:
                object.__setattr__(self, name, usual * self.break_modulus)
            positive(f"{name} of a bilinear law", getattr(self, name), "Pa", "leave it out")
        assert self.least is not None
        assert self.largest is not None
        if not self.least <= self.break_modulus <= self.largest:
            raise InputError(
                f"the modulus at the break, {self.break_modulus:g} Pa, must lie between least and largest, got "
                f"{self.least:g} and {self.largest:g} Pa"
            )

    def modulus(self, bulk: ArrayLike, deviator: ArrayLike) -> Array:
        """See `ModulusLaw`."""
        _, q = np.broadcast_arrays(bulk, np.asarray(deviator, dtype=float))
        below = np.asarray(self.break_deviator - q)
        slope = np.where(below > 0, self.slope_below, self.slope_above)
        return np.asarray(np.clip(self.break_modulus + slope * below, self.least, self.largest))

    def __str__(self) -> str:
        return (
            f"bilinear, {self.break_modulus / 1e6:g} MPa at q = {self.break_deviator / 1e3:g} kPa, slopes "
            f"{self.slope_below:g} below and {self.slope_above:g} above"
        )

    __repr__ = as_call


def _check(law: KTheta | Uzan | Universal, exponents: tuple[str, ...], unit: str = "Pa") -> None:
    name = type(law).__name__
    positive(f"k1 of {name}", law.k1, unit, "of granular materials: near 100e6 at 100e3 Pa" if unit else "near 1000")
    positive(f"reference of {name}", law.reference, "Pa", "a law in psi has 6894.757, one in kPa 1000")
    for exponent in exponents:
        value = getattr(law, exponent)
        if isinstance(value, str) or not -2 <= value <= 2:
            raise InputError(
                f"{exponent} of {name} must lie in [-2, 2], got {value!r}; granular materials are near 0.5"
            )
