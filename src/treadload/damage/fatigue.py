"""The fatigue line: how many passes a strain allows."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import overload

import numpy as np

from treadload.errors import InputError
from treadload.kernels.arrays import Array

_MILLION = 1e6
# No road material bears a million passes at one per cent: such a number is microstrain without its unit.
_LARGEST = 0.01


@dataclass(frozen=True)
class FatigueLine:
    """Wöhler line ε = ε₆ (N / 10⁶)^b of a material under repeated extension.

    epsilon_6: strain that allows a million passes, plain strain (120 microstrain is 120e-6), > 0.
    slope: b, in (-1, 0); near -0.2 for bituminous mixes.
    A line measured in a laboratory carries no shift to the road: temperature, frequency, healing and
    scatter are the user's to include in epsilon_6.
    """

    epsilon_6: float
    slope: float

    def __post_init__(self) -> None:
        if not (math.isfinite(self.epsilon_6) and self.epsilon_6 > 0):
            raise InputError(f"epsilon_6 must be a positive strain, got {self.epsilon_6}; 120 microstrain is 120e-6")
        if self.epsilon_6 > _LARGEST:
            raise InputError(
                f"epsilon_6 must be a plain strain below {_LARGEST}, got {self.epsilon_6}; write "
                f'{self.epsilon_6:g}e-6 or "{self.epsilon_6:g} microstrain" if that is what you mean'
            )
        if not -1 < self.slope < 0:
            raise InputError(f"slope must lie in (-1, 0), got {self.slope}; -0.2 is usual for bituminous mixes")

    @overload
    def allowable_passes(self, strain: float) -> float: ...
    @overload
    def allowable_passes(self, strain: Array) -> Array: ...
    def allowable_passes(self, strain: float | Array) -> float | Array:
        """Passes N = 10⁶ (ε / ε₆)^(1/b) that a strain allows; inf where there is no extension, NaN for NaN."""
        given = np.asarray(strain, dtype=float)
        extended = np.where(given <= 0, 1.0, given)
        with np.errstate(over="ignore"):
            passes = _MILLION * (extended / self.epsilon_6) ** (1 / self.slope)
        passes = np.where(given <= 0, np.inf, passes)
        return passes if given.ndim else float(passes)

    @overload
    def allowable_strain(self, passes: float) -> float: ...
    @overload
    def allowable_strain(self, passes: Array) -> Array: ...
    def allowable_strain(self, passes: float | Array) -> float | Array:
        """Strain ε₆ (N / 10⁶)^b that allows this number of passes, > 0; InputError otherwise."""
        given = np.asarray(passes, dtype=float)
        if not (given > 0).all():
            raise InputError(f"passes must be positive, got {given.min():g}")
        strain = self.epsilon_6 * (given / _MILLION) ** self.slope
        return strain if given.ndim else float(strain)

    def __str__(self) -> str:
        return f"fatigue line, ε₆ = {self.epsilon_6 * 1e6:g} microstrain, slope {self.slope:g}"
