"""Von Mises' law with isotropic hardening and a back stress, strain-driven, backward Euler.

With θ = 1 / (1 + g dp) and ξ = s_trial - θ X the multiplier dp solves q(ξ) = σ_y(p + dp) + (3 G + c θ) dp (and the
overstress of a viscous law); then dε = 3/2 dp ξ/q and X ← θ (X + 2/3 c dε). Its left side less its right falls at
least as 3 G dp: there is one root, and it lies below f_trial / 3 G.

Sources: Simo & Hughes (1998), Computational Inelasticity, sections 3.3 and 1.7; Armstrong & Frederick (1966), CEGB
report RD/B/N 731, reprinted in Mater. High Temp. 24 (2007), 1-26; Perzyna (1966), Adv. Appl. Mech. 9, 243-377.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from treadload.kernels.arrays import Array
from treadload.kernels.plasticity.multiplier import root
from treadload.kernels.plasticity.state import State, contracted, deviator, isotropic, size

Curve = Callable[[Array], tuple[Array, Array]]
"""Equivalent plastic strain → yield stress and its slope, Pa."""


@dataclass(frozen=True)
class Viscosity:
    """Perzyna's: dp/dt = fluidity (f / stress)^exponent. fluidity: 1/s. stress: Pa."""

    fluidity: float
    exponent: float
    stress: float

    def over(self, step: Array, duration: float) -> tuple[Array, Array]:
        """Overstress of a step of the multiplier (n,) in a time, s, and its slope, Pa."""
        rate = step / (self.fluidity * duration)
        value = self.stress * rate ** (1 / self.exponent)
        with np.errstate(divide="ignore", invalid="ignore"):
            slope = np.where(step > 0, value / (self.exponent * step), np.inf)
        return value, slope


@dataclass(frozen=True)
class Mises:
    """Return map of von Mises' law.

    shear, bulk: elastic moduli, Pa. curve: of isotropic hardening. kinematic: c, Pa, of the back stress (Prager's,
    2/3 c a strain); recovery: g of Armstrong and Frederick, 0 for Prager. viscosity: None for a law without time.
    """

    shear: float
    bulk: float
    curve: Curve
    kinematic: float = 0.0
    recovery: float = 0.0
    viscosity: Viscosity | None = None

    def elastic(self, strain: Array) -> Array:
        """See `ReturnMap`."""
        return isotropic(strain, self.shear, self.bulk)

    def excess(self, stress: Array, state: State) -> Array:
        """See `ReturnMap`."""
        value: Array = size(deviator(stress) - state.back) - self.curve(state.hardening)[0]
        return value

    def __call__(self, trial: Array, state: State, duration: float = 0.0) -> State:
        """See `ReturnMap`."""
        if self.viscosity is not None and duration <= 0:
            return state
        over = self.excess(trial, state)
        plastic = over > 0
        if not plastic.any():
            return state
        begin, s, f = state.at(plastic), deviator(trial[:, plastic]), over[plastic]
        c, g, power = self.kinematic, self.recovery, 1.0 if self.viscosity is None else self.viscosity.exponent

        def equation(dp: Array) -> tuple[Array, Array]:
            theta = 1 / (1 + g * dp)
            xi = s - theta * begin.back
            q = size(xi)
            stress, slope = self.curve(begin.hardening + dp)
            value = q - stress - (3 * self.shear + c * theta) * dp
            fall = -slope - 3 * self.shear - c * theta**2
            if g:
                # dq/dp = 3/2 ξ:X g θ² / q.
                turn = contracted(xi, begin.back) * 1.5 * g * theta**2
                fall = fall + turn / np.where(q > 0, q, 1.0)
            if self.viscosity is not None:
                more, steeper = self.viscosity.over(dp, duration)
                value, fall = value - more, fall - steeper
            return value, fall

        dp = root(equation, f / (3 * self.shear), power)
        theta = 1 / (1 + g * dp)
        xi = s - theta * begin.back
        q = size(xi)
        change = 1.5 * dp / np.where(q > 0, q, 1.0) * xi
        strain, hardening, back = state.strain.copy(), state.hardening.copy(), state.back.copy()
        strain[:, plastic] += change
        hardening[plastic] += dp
        if c:
            back[:, plastic] = theta * (begin.back + 2 / 3 * c * change)
        return State(strain, hardening, back)
