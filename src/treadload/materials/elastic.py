"""Isotropic linear elasticity."""

from __future__ import annotations

import math
from dataclasses import dataclass

from treadload.describing import as_call
from treadload.errors import InputError
from treadload.registry import MATERIALS
from treadload.units import Modulus, Number


@MATERIALS.register("elastic")
@dataclass(frozen=True)
class Elastic:
    """Isotropic linear elastic material.

    modulus: Young's modulus, Pa, > 0.
    poisson: Poisson's ratio, in (-1, 0.5].
    """

    modulus: Modulus
    poisson: Number

    def __post_init__(self) -> None:
        if isinstance(self.modulus, str) or not (math.isfinite(self.modulus) and self.modulus > 0):
            raise InputError(f"modulus must be a positive number of Pa, got {self.modulus!r}; asphalt is near 5.4e9")
        if isinstance(self.poisson, str) or not -1 < self.poisson <= 0.5:
            raise InputError(
                f"poisson must lie in (-1, 0.5], got {self.poisson!r}; rubber is near 0.5, asphalt near 0.35"
            )

    @property
    def shear_modulus(self) -> float:
        """G = E / 2(1 + ν), Pa."""
        return self.modulus / (2 * (1 + self.poisson))

    def __str__(self) -> str:
        return f"elastic, E = {self.modulus / 1e6:g} MPa, ν = {self.poisson:g}"

    __repr__ = as_call
