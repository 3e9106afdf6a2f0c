"""Surface displacement of two half-spaces under a uniformly loaded rectangle.

All coefficients are corner sums [[f]] of closed forms in the distance (X, Y) from a corner, sampled a cell apart:
from the centre of the loaded cell, where parity gives the other three quadrants, or from any distance ahead of it
along x, as for a particle before it travelled a step. There a corner may lie on x = 0, where every form has
a limit.

q acts on body 1, p presses the bodies together, u = u1 - u2, u_n opens the gap (after Kalker 1990):

    u_n = (1-ν)/(πG) ∫ p/r  + K/(πG) ∫ (q_x x + q_y y)/r²
    u_x = 1/(πG) ∫ {[(1-ν)/r + ν x²/r³] q_x + ν xy/r³ q_y}  - K/(πG) ∫ p x/r²

Sources: Love (1929), Phil. Trans. R. Soc. A 228, 377-420; Kalker (1990), Three-Dimensional Elastic Bodies
in Rolling Contact, eq. 1.44 and section 4.1; Johnson (1985), Contact Mechanics, section 3.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from treadload.kernels.arrays import Array


@dataclass(frozen=True)
class CombinedElasticity:
    """The two bodies seen as one: combined shear modulus, Poisson's ratio and difference parameter.

    shear_modulus: G, Pa: 1/G = (1/G1 + 1/G2)/2. poisson: ν with ν/G = (ν1/G1 + ν2/G2)/2.
    difference: K with K/G = ((1-2ν1)/G1 - (1-2ν2)/G2)/4; zero for like bodies.
    """

    shear_modulus: float
    poisson: float
    difference: float

    @classmethod
    def of(cls, shear_1: float, poisson_1: float, shear_2: float, poisson_2: float) -> CombinedElasticity:
        """Combine body 1 and body 2; a shear modulus of infinity is a rigid body.

        Source: Kalker (1990), eq. 1.44.
        """
        shear = 2.0 / (1 / shear_1 + 1 / shear_2)
        poisson = shear * (poisson_1 / shear_1 + poisson_2 / shear_2) / 2
        difference = shear * ((1 - 2 * poisson_1) / shear_1 - (1 - 2 * poisson_2) / shear_2) / 4
        return cls(shear, poisson, difference)

    @property
    def contact_modulus(self) -> float:
        """E* = G/(1-ν), Pa."""
        return self.shear_modulus / (1 - self.poisson)


def normal_by_pressure(
    ny: int, nx: int, dx: float, dy: float, bodies: CombinedElasticity, first: float = 0.0
) -> Array:
    """u_n under unit p: (ny, nx), m/Pa. Even in x and y.

    At x = first + dx (0 … nx - 1), y = dy (0 … ny - 1) from the centre of a cell, m.
    """
    scale = (1 - bodies.poisson) / (np.pi * bodies.shear_modulus)
    x, y = _corners(ny, nx, dx, dy, first)
    return scale * (_corner_sum(_product_with_asinh(x, y)) + _corner_sum(_product_with_asinh(y, x)))


def tangential_by_shear(
    ny: int, nx: int, dx: float, dy: float, bodies: CombinedElasticity, first: float = 0.0
) -> Array:
    """u_x by q_x, u_y by q_y, and u_x by q_y = u_y by q_x, under unit shear: (3, ny, nx), m/Pa.

    Places as in `normal_by_pressure`. The first two are even in x and y, the third is odd in both.
    """
    nu, scale = bodies.poisson, 1 / (np.pi * bodies.shear_modulus)
    x, y = _corners(ny, nx, dx, dy, first)
    along_x, along_y = _corner_sum(_product_with_asinh(x, y)), _corner_sum(_product_with_asinh(y, x))
    cross = _corner_sum(-np.hypot(x, y))
    return np.array(
        [scale * ((1 - nu) * along_x + along_y), scale * (along_x + (1 - nu) * along_y), scale * nu * cross]
    )


def coupling(ny: int, nx: int, dx: float, dy: float, bodies: CombinedElasticity, first: float = 0.0) -> Array:
    """k_x, k_y with u_n = k_x ∗ q_x + k_y ∗ q_y and u_x = -k_x ∗ p, u_y = -k_y ∗ p: (2, ny, nx), m/Pa.

    Places as in `normal_by_pressure`. k_x is odd in x and even in y, k_y the other way round.
    """
    scale = bodies.difference / (np.pi * bodies.shear_modulus)
    x, y = _corners(ny, nx, dx, dy, first)
    squared = x**2 + y**2
    # At a corner on both axes every term is zero.
    squared[np.ix_(y[:, 0] == 0, x[0] == 0)] = 1.0
    half_log = 0.5 * np.log(squared)
    k_x = _corner_sum(y * half_log + x * np.arctan(y / _divisor(x)))
    k_y = _corner_sum(x * half_log + y * np.arctan(x / _divisor(y)))
    return np.array([scale * k_x, scale * k_y])


def _corners(ny: int, nx: int, dx: float, dy: float, first: float) -> tuple[Array, Array]:
    """Corner distances (1, nx + 1) and (ny + 1, 1); those within round-off of zero are zero."""
    x = dx * (np.arange(nx + 1) - 0.5) + first
    return np.where(np.abs(x) < 1e-9 * dx, 0.0, x)[None, :], dy * (np.arange(ny + 1) - 0.5)[:, None]


def _corner_sum(f: Array) -> Array:
    return f[1:, 1:] - f[1:, :-1] - f[:-1, 1:] + f[:-1, :-1]


def _product_with_asinh(first: Array, second: Array) -> Array:
    """The first times asinh(second/|first|), with its limit zero where the first is zero."""
    # It replaces Love's ln(Y + R): the difference depends on the first only and drops out of the corner sum.
    product: Array = first * np.arcsinh(second / np.abs(_divisor(first)))
    return product


def _divisor(distance: Array) -> Array:
    """A distance, by which something is divided that it multiplies: any number will do in place of zero."""
    return np.where(distance == 0, 1.0, distance)
