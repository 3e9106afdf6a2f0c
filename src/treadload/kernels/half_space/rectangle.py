"""Surface displacement of two half-spaces under a uniformly loaded rectangle.

All coefficients are corner sums [[f]] of closed forms in the distance (X, Y) from a corner, sampled at
offsets of whole cells 0, 1, 2, … along x and y; parity gives the other three quadrants.

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

    @property
    def dundurs(self) -> float:
        """Dundurs' β = K/(1-ν): how strongly pressure and shear are coupled, |β| ≤ 0.5."""
        return self.difference / (1 - self.poisson)


def normal_by_pressure(ny: int, nx: int, dx: float, dy: float, bodies: CombinedElasticity) -> Array:
    """u_n under unit p: (ny, nx) at offsets 0 … n-1, m/Pa. Even in x and y."""
    scale = (1 - bodies.poisson) / (np.pi * bodies.shear_modulus)
    return scale * (_along_x(ny, nx, dx, dy) + _along_y(ny, nx, dx, dy))


def tangential_by_shear(
    ny: int, nx: int, dx: float, dy: float, bodies: CombinedElasticity
) -> tuple[Array, Array, Array]:
    """(u_x by q_x, u_y by q_y, u_x by q_y = u_y by q_x) under unit shear: (ny, nx) each, m/Pa.

    The first two are even in x and y, the third is odd in both.
    """
    nu, scale = bodies.poisson, 1 / (np.pi * bodies.shear_modulus)
    along_x, along_y = _along_x(ny, nx, dx, dy), _along_y(ny, nx, dx, dy)
    x, y = _corners(ny, nx, dx, dy)
    cross = _corner_sum(-np.hypot(x, y))
    xx = scale * ((1 - nu) * along_x + along_y)
    yy = scale * (along_x + (1 - nu) * along_y)
    return xx, yy, scale * nu * cross


def coupling(ny: int, nx: int, dx: float, dy: float, bodies: CombinedElasticity) -> tuple[Array, Array]:
    """(k_x, k_y): u_n = k_x ∗ q_x + k_y ∗ q_y and u_x = -k_x ∗ p, u_y = -k_y ∗ p; (ny, nx) each, m/Pa.

    k_x is odd in x and even in y, k_y the other way round.
    """
    scale = bodies.difference / (np.pi * bodies.shear_modulus)
    x, y = _corners(ny, nx, dx, dy)
    half_log = 0.5 * np.log(x**2 + y**2)
    k_x = _corner_sum(y * half_log + x * np.arctan(y / x))
    k_y = _corner_sum(x * half_log + y * np.arctan(x / y))
    return scale * k_x, scale * k_y


def _corners(ny: int, nx: int, dx: float, dy: float) -> tuple[Array, Array]:
    """Corner distances (1, nx+1) and (ny+1, 1): never zero, so that no limit is needed."""
    return dx * (np.arange(nx + 1) - 0.5)[None, :], dy * (np.arange(ny + 1) - 0.5)[:, None]


def _corner_sum(f: Array) -> Array:
    return f[1:, 1:] - f[1:, :-1] - f[:-1, 1:] + f[:-1, :-1]


def _along_x(ny: int, nx: int, dx: float, dy: float) -> Array:
    # asinh(Y/|X|) replaces Love's ln(Y + R): the difference depends on X only and drops out of the corner sum.
    x, y = _corners(ny, nx, dx, dy)
    return _corner_sum(x * np.arcsinh(y / np.abs(x)))


def _along_y(ny: int, nx: int, dx: float, dy: float) -> Array:
    x, y = _corners(ny, nx, dx, dy)
    return _corner_sum(y * np.arcsinh(x / np.abs(y)))
