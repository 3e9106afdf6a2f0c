"""Friction that falls as the interface heats up: flash temperature of the sliding contact.

Heat q·s V of friction enters tire and road where they slip. Both pass through the patch at the rolling speed V
and conduct heat into their depth only: along travel it is carried faster than it spreads. Then

    T(x) = 1 / ((b₁ + b₂) √(πV)) ∫ f(x') / √(x' - x) dx'   over x' > x, b = √(λρc),

which makes both surfaces equally warm and so divides the heat as b₁ : b₂. A band of length L under a uniform f
reaches 2f √(L/πV) / (b₁ + b₂) at its trailing edge.

Sources: Jaeger (1942), Proc. R. Soc. N.S.W. 76, 203-224; Carslaw & Jaeger (1959), Conduction of Heat in Solids,
sections 2.9 and 10.7.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from treadload.contact.friction.laws import FrictionLaw, Interface
from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.registry import FRICTION
from treadload.units import Conductivity, HeatCapacity, Kelvin, Number

# V dx/κ of a cell above which heat spreads along travel, and to the sides, by less than a cell.
_LEAST_PECLET = 10.0


@dataclass(frozen=True)
class Heat:
    """How a body takes up heat.

    conductivity: λ, W/(m K), > 0. heat_capacity: ρc, J/(m³ K), > 0. Rubber is near 0.25 and 2e6, asphalt concrete
    near 1.2 and 2.1e6.
    """

    conductivity: Conductivity
    heat_capacity: HeatCapacity

    def __post_init__(self) -> None:
        positive("conductivity", self.conductivity, "W/(m K)", "rubber is near 0.25")
        positive("heat_capacity", self.heat_capacity, "J/(m³ K)", "rubber is near 2e6")

    @property
    def effusivity(self) -> float:
        """Effusivity b = √(λρc), W √s/(m² K)."""
        return math.sqrt(self.conductivity * self.heat_capacity)

    @property
    def diffusivity(self) -> float:
        """κ = λ/ρc, m²/s."""
        return self.conductivity / self.heat_capacity


@FRICTION.register("flash")
@dataclass(frozen=True)
class FlashHeating(FrictionLaw):
    """A law whose coefficient falls as sliding heats the interface.

    base: the cold law. tire, road: Heat of the bodies.
    onset: flash temperature, K above the bodies, ≥ 0, up to which friction is the base's. span: K, > 0, over which
    it then falls on a straight line. hot: share of the base's friction in [0, 1] at which it ends and stays.
    """

    base: FrictionLaw
    tire: Heat
    road: Heat
    onset: Kelvin
    span: Kelvin
    hot: Number

    # Heat comes from the whole friction: nothing may multiply it afterwards.
    outermost: ClassVar[bool] = True

    def __post_init__(self) -> None:
        if not isinstance(self.base, FrictionLaw) or isinstance(self.base, FlashHeating):
            raise InputError(f"the base of flash heating must be another friction law, got {self.base!r}")
        for name in ("tire", "road"):
            if not isinstance(getattr(self, name), Heat):
                raise InputError(f"{name} of flash heating must be Heat(conductivity, heat_capacity)")
        positive("span", self.span, "K", "friction falls over it")
        if not (math.isfinite(self.onset) and self.onset >= 0):
            raise InputError(f"onset of flash heating must be >= 0 K, got {self.onset:g} K")
        if not 0 <= self.hot <= 1:
            raise InputError(f"hot, the share of friction that is left, must lie in [0, 1], got {self.hot:g}")

    @property
    def axes(self) -> tuple[float, float]:
        """As the base."""
        return self.base.axes

    @property
    def needs_speed(self) -> bool:
        """True: heat is frictional work in time."""
        return True

    @property
    def largest(self) -> float:
        """That of the base."""
        return self.base.largest

    def coefficient(self, at: Interface) -> Array:
        """μ (ny, nx) at the flash temperature that it makes itself. Raises InputError."""
        return self._solve(at)[0]

    def temperature(self, at: Interface) -> Array:
        """Flash temperature (ny, nx), K above the bodies. Raises InputError."""
        return self._solve(at)[1]

    def _solve(self, at: Interface) -> tuple[Array, Array]:
        """μ and temperature (ny, nx) that fit each other, column by column from the leading edge.

        Heat is carried backwards only. In a column temperature rises with friction and friction falls with
        temperature, so that they meet in exactly one point.
        """
        speed, dx = at.known_speed, at.dx
        self._check_speed(speed, dx)
        cold = self.base.coefficient(at)
        d_x, d_y = self.axes
        # On the ellipse, shear times slip is the bound times the slip stretched by the axes.
        power = np.where(at.pressure > 0, at.pressure * speed * np.hypot(d_x * at.slip[0], d_y * at.slip[1]), 0.0)
        kernel = strip_kernel(at.x.size, dx, speed, self.tire.effusivity + self.road.effusivity)
        flux, temperature, share = np.zeros_like(power), np.zeros_like(power), np.ones_like(power)
        for column in reversed(range(at.x.size)):
            ahead = flux[:, column + 1 :] @ kernel[1 : at.x.size - column]
            heating = kernel[0] * cold[:, column] * power[:, column]
            temperature[:, column], share[:, column] = self._meet(ahead, heating)
            flux[:, column] = share[:, column] * cold[:, column] * power[:, column]
        return cold * share, temperature

    def _meet(self, ahead: Array, heating: Array) -> tuple[Array, Array]:
        """Temperature T and share φ with T = ahead + own φ(T)."""
        slope = (1 - self.hot) / self.span
        on_the_line = (ahead + heating * (1 + slope * self.onset)) / (1 + slope * heating)
        temperature = np.where(
            ahead + heating <= self.onset,
            ahead + heating,
            np.maximum(on_the_line, ahead + heating * self.hot),
        )
        share = 1 - (1 - self.hot) * np.clip((temperature - self.onset) / self.span, 0.0, 1.0)
        return temperature, share

    def _check_speed(self, speed: float, dx: float) -> None:
        slowest = _LEAST_PECLET * max(self.tire.diffusivity, self.road.diffusivity) / dx
        if speed < slowest:
            raise InputError(
                f"flash heating needs a rolling speed of at least {slowest:.2g} m/s on cells of {dx * 1e3:g} mm, got "
                f"{speed:g} m/s: slower, heat spreads to the sides; use larger cells or leave heating out"
            )

    def __str__(self) -> str:
        return f"{self.base}, x {self.hot:g} when {self.onset + self.span:g} K hot"


def strip_kernel(count: int, dx: float, speed: float, effusivity: float) -> Array:
    """Temperature at the centre of a cell by unit flux into the cell 0, 1, … (count,) ahead of it, K m²/W.

    dx: cell size along travel, m. speed: m/s. effusivity: sum of both bodies' b, W √s/(m² K).
    """
    edges = np.sqrt(dx * np.maximum(np.arange(count + 1) - 0.5, 0.0))
    kernel: Array = 2 * np.diff(edges) / (effusivity * math.sqrt(math.pi * speed))
    return kernel


def flash_temperature(flux: Array, dx: float, speed: float, effusivity: float) -> Array:
    """Flash temperature (ny, nx), K, at the centres of cells under a flux of heat (ny, nx), W/m².

    The leading edge is at the last column. Arguments as for `strip_kernel`.
    """
    nx = flux.shape[1]
    kernel = strip_kernel(nx, dx, speed, effusivity)
    ahead = np.arange(nx)[:, None] - np.arange(nx)[None, :]
    return flux @ np.where(ahead >= 0, kernel[np.maximum(ahead, 0)], 0.0)
