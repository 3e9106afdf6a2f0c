"""From the scatter of standard normal inputs to that of a damage: draws, and the first order.

What scatters is ln D, the logarithm of the damage of a year, over independent standard normal inputs z. Draws take it
as it is; the first order takes the tangent at the point that is most likely among those with the same damage
(Hasofer and Lind 1974): at the distance β from the origin where ln D is largest (β > 0) or least.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from treadload.errors import InputError
from treadload.kernels.arrays import Array

# Steps to a point of the first order; on surfaces that bend as little as those of roads five suffice.
_STEPS = 60
_TINY = 1e-12


@dataclass(frozen=True)
class MonteCarlo:
    """Draws of a reliability: how many, from 1000 to 10 million, and from which seed. Raises InputError.

    >>> tl.life.MonteCarlo(draws=100)
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: draws must lie in [1000, 10000000], got 100; 100 000 is the default
    """

    draws: int = 100_000
    seed: int = 1

    def __post_init__(self) -> None:
        if not 1000 <= self.draws <= 10_000_000:
            raise InputError(f"draws must lie in [1000, 10000000], got {self.draws}; 100 000 is the default")


@dataclass(frozen=True, eq=False)
class Quadratic:
    """ln D = constant + gradient · z + ½ z · curvature · z over standard normal z (..., n)."""

    constant: float
    gradient: Array
    curvature: Array

    def __call__(self, z: Array) -> Array:
        """Ln D (...) at z (..., n)."""
        bent: Array = 0.5 * np.einsum("...i,ij,...j->...", z, self.curvature, z)
        return self.constant + z @ self.gradient + bent

    def slope(self, z: Array) -> Array:
        """Gradient (n,) at z (n,)."""
        slope: Array = self.gradient + self.curvature @ z
        return slope


def first_order(surface: Quadratic, risk: float) -> tuple[float, Array]:
    """Ln D that is exceeded with a probability, to the first order, and the direction cosines α (n,) there.

    risk: in (0, 1). α² are the shares of the inputs in the scatter; they sum to 1, and are 0 where nothing scatters.
    """
    beta = -float(scipy.special.ndtri(risk))
    slope = surface.gradient
    z = np.zeros_like(slope)
    for _ in range(_STEPS):
        length = float(np.linalg.norm(slope))
        if length < _TINY:
            return surface.constant, np.zeros_like(slope)
        # Half of the way: the other half keeps the step from going to and fro where the surface bends.
        last, z = z, 0.5 * (z + beta * slope / length)
        z *= abs(beta) / max(float(np.linalg.norm(z)), _TINY)
        slope = surface.slope(z)
        if float(np.abs(z - last).max()) < 1e-10:
            break
    return float(surface(z)), slope / max(float(np.linalg.norm(slope)), _TINY)


def drawn(surfaces: list[Quadratic], common: int, draws: int, seed: int) -> Array:
    """Ln D (surface, draws) for random inputs. common: the first so many inputs are the same for all surfaces."""
    random = np.random.default_rng(seed)
    shared = random.standard_normal((draws, common))
    return np.stack(
        [
            surface(np.hstack([shared, random.standard_normal((draws, len(surface.gradient) - common))]))
            for surface in surfaces
        ]
    )
