"""Drucker and Prager's cone with dilation and an apex, strain-driven, backward Euler.

f = q + tan β σ_m - d - h p, flow by q + tan ψ σ_m: dp = f_trial / (3 G + K tan β tan ψ + h) on the cone. Where that
would turn the deviator round, the stress goes to the apex, σ_m = (d + h p) / tan β, and all of the deviator goes.

Sources: Drucker & Prager (1952), Q. Appl. Math. 10, 157-165; de Souza Neto, Perić & Owen (2008), Computational
Methods for Plasticity, section 8.3.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from treadload.kernels.arrays import Array
from treadload.kernels.plasticity.mises import Viscosity
from treadload.kernels.plasticity.multiplier import root
from treadload.kernels.plasticity.state import State, deviator, isotropic, size


@dataclass(frozen=True)
class Cone:
    """Return map of Drucker and Prager's law.

    shear, bulk: elastic moduli, Pa. friction: tan β; 0 is von Mises' law. dilation: tan ψ. strength: d, Pa.
    hardening: h, Pa. viscosity: None for a law without time; the apex, where the material parts, knows no time.
    """

    shear: float
    bulk: float
    friction: float
    dilation: float
    strength: float
    hardening: float = 0.0
    viscosity: Viscosity | None = None

    def elastic(self, strain: Array) -> Array:
        """See `ReturnMap`."""
        return isotropic(strain, self.shear, self.bulk)

    def excess(self, stress: Array, state: State) -> Array:
        """See `ReturnMap`."""
        mean = stress[:3].mean(axis=0)
        value: Array = size(deviator(stress)) + self.friction * mean - self.strength
        return value - self.hardening * state.hardening

    def __call__(self, trial: Array, state: State, duration: float = 0.0) -> State:
        """See `ReturnMap`."""
        if self.viscosity is not None and duration <= 0:
            return state
        over = self.excess(trial, state)
        plastic = over > 0
        if not plastic.any():
            return state
        stress, f = trial[:, plastic], over[plastic]
        s, mean = deviator(stress), stress[:3].mean(axis=0)
        q, before = size(s), state.hardening[plastic]
        stiff = 3 * self.shear + self.bulk * self.friction * self.dilation + self.hardening
        dp = f / stiff
        apex = q < 3 * self.shear * dp
        if self.viscosity is not None:
            viscous = self.viscosity

            def equation(step: Array) -> tuple[Array, Array]:
                more, steeper = viscous.over(step, duration)
                return f - stiff * step - more, -stiff - steeper

            dp = np.where(apex, dp, root(equation, dp, viscous.exponent))
        dp = np.where(apex, q / (3 * self.shear), dp)
        change = 1.5 * dp / np.where(q > 0, q, 1.0) * s
        if apex.any():
            tip = (self.strength + self.hardening * (before + dp)[apex]) / self.friction
            volume = self.dilation * dp
            volume[apex] = (mean[apex] - tip) / self.bulk
        else:
            volume = self.dilation * dp
        change[:3] += volume / 3
        strain, hardening = state.strain.copy(), state.hardening.copy()
        strain[:, plastic] += change
        hardening[plastic] += dp
        return State(strain, hardening, state.back)
