"""Isotropic linear elasticity."""

from __future__ import annotations

from dataclasses import dataclass

from treadload.describing import as_call
from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.kernels.tensors import strain_from_stress
from treadload.registry import MATERIALS
from treadload.units import Modulus, Number

# Compliances of bodies add up, and must stay below the largest number.
_SOFTEST = 1e-300


@MATERIALS.register("elastic")
@dataclass(frozen=True)
class Elastic:
    """Isotropic linear elastic material.

    modulus: Young's modulus, Pa, > 0.
    poisson: Poisson's ratio, in (-1, 0.5].

    >>> steel = tl.Elastic(210e9, 0.3)
    >>> f"{steel.shear_modulus:.3g} Pa"
    '8.08e+10 Pa'
    """

    modulus: Modulus
    poisson: Number

    def __post_init__(self) -> None:
        positive("modulus", self.modulus, "Pa", "asphalt is near 5.4e9")
        if self.modulus < _SOFTEST:
            raise InputError(
                f"modulus is {self.modulus:g} Pa, below {_SOFTEST:g} Pa, where its inverse is beyond all numbers of "
                "this machine; asphalt is near 5.4e9"
            )
        if isinstance(self.poisson, str) or not -1 < self.poisson <= 0.5:
            raise InputError(
                f"poisson must lie in (-1, 0.5], got {self.poisson!r}; rubber is near 0.5, asphalt near 0.35"
            )

    @property
    def shear_modulus(self) -> float:
        """G = E / 2(1 + ν), Pa."""
        return self.modulus / (2 * (1 + self.poisson))

    def strain(self, stress: Array) -> Array:
        """Strain (6, ...) of a stress (6, ...), Pa: xx, yy, zz, xy, xz, yz, extension positive, tensor shear."""
        return strain_from_stress(stress, self.modulus, self.poisson)

    def __str__(self) -> str:
        return f"elastic, E = {self.modulus / 1e6:g} MPa, ν = {self.poisson:g}"

    __repr__ = as_call
