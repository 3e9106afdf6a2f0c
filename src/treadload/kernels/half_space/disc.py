"""Stress and displacement of a half-space under a uniformly loaded disc, at any depth, in closed form.

Source: Love (1929), Phil. Trans. R. Soc. A 228, 377-420; Lipschitz-Hankel integrals as named by Eason,
Noble and Sneddon (1955), Phil. Trans. R. Soc. A 247, 529-551, written here with Carlson's symmetric elliptic
integrals (Numer. Algorithms 10 (1995), 13-26) so that the axis and far points keep their digits.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.special import elliprd, elliprf, elliprj

from treadload.kernels.arrays import Array

# Closer to the axis than this part of the distance to the rim, two terms of the power series in r serve:
# the next one is below 1e-16, while the closed form would lose its digits in r - r.
_AXIS = 1e-4
# Keeps the integrals finite on the rim itself, where they are multiplied by zero.
_RIM = 1e-290


def disc_fields(radius: float, x: Array, y: Array, z: float, shear: float, poisson: float) -> tuple[Array, Array]:
    """Stress and displacement at (x, y, z) per unit pressure on a disc centred at the origin.

    radius: m. x, y: m, broadcast together. z: depth, m, >= 0. shear: shear modulus, Pa. poisson: ν.
    Returns stress (6, ...) in the order xx, yy, zz, xy, xz, yz, tension positive, and displacement (3, ...) in m
    per Pa, z down. On the rim at the surface stress takes the mean of its sides.
    """
    x, y = np.broadcast_arrays(np.asarray(x, float), np.asarray(y, float))
    a, r, soft = radius, np.hypot(x, y), 1 - 2 * poisson
    s2, d2 = (a + r) ** 2 + z * z, (a - r) ** 2 + z * z
    s, m, rest = np.sqrt(s2), 4 * a * r / s2, np.maximum(d2 / s2, _RIM)
    zero, one = np.zeros_like(r), np.ones_like(r)
    first = elliprf(zero, rest, one)
    part = elliprd(zero, rest, one) / 3
    second = first - m * part
    # ∫ J0 J0 and ∫ J1 J1 of arguments a t and r t under e^(-z t).
    i000 = 2 / (math.pi * s) * first
    i110_r = np.where(r > 0, (2 * part - first) * 2 / (math.pi * s) / np.where(r > 0, r, 1), 0)
    inside = 0.5 * (1 + np.sign(a - r))
    if z > 0:
        third = elliprj(zero, rest, one, np.maximum(((a - r) / (a + r)) ** 2, _RIM)) * np.sign(a - r) ** 2
        angle = inside - z / (math.pi * s) * (
            first + (a - r) / (a + r) * (first + 4 * a * r / (a + r) ** 2 * third / 3)
        )
        # Solid angle of the disc of radius r seen from the rim's circle, over 2π r.
        outer = np.where(r > 0, (1 - inside) / np.where(r > 0, r, 1), 0) + z / (math.pi * s * (a + r)) * (
            -2 * first + 4 * a * (a - r) / (3 * (a + r) ** 2) * third
        )
        zi101 = z / (math.pi * a * s) * ((a * a - r * r - z * z) / d2 * second + first)
        # r in the denominator is taken by the bracket, which falls off as r².
        bracket = (1 - m / 2) / rest * second - first
        zi111 = np.where(r > 0, z * z / (math.pi * a * s) * bracket / np.where(r > 0, r, 1), 0)
    else:
        angle, outer = inside, np.where(r > 0, (1 - inside) / np.where(r > 0, r, 1), 0)
        zi101 = zi111 = zero
    i100 = angle / a
    i11m_r = 0.5 * (a * outer / np.where(r > 0, r, 1) + i100 - z * i110_r)
    near = r < _AXIS * s
    s0 = math.hypot(a, z)
    axis = 0.5 * (1 - z / s0) / a - r**2 / 16 * 3 * a * z / s0**5
    axis_1 = 0.5 * a / s0**3 - r**2 / 16 * 3 * a * (4 * z * z - a * a) / s0**7
    i11m_r, i110_r = np.where(near, axis, i11m_r), np.where(near, axis_1, i110_r)
    zi111 = np.where(near, r * z * 1.5 * a * z / s0**5, zi111)
    i10m = a * i000 - r * r * i110_r - z * i100

    hoop = soft * i11m_r - z * i110_r
    radial, around = -a * (i100 - zi101 - hoop), -a * (2 * poisson * i100 + hoop)
    c, t = np.where(r > 0, x / np.where(r > 0, r, 1), 1), np.where(r > 0, y / np.where(r > 0, r, 1), 0)
    slant = -a * zi111
    stress = np.stack(
        [
            c * c * radial + t * t * around,
            t * t * radial + c * c * around,
            -a * (i100 + zi101),
            c * t * (radial - around),
            c * slant,
            t * slant,
        ]
    )
    outward = -a / (2 * shear) * hoop
    displacement = np.stack([x * outward, y * outward, a / (2 * shear) * (2 * (1 - poisson) * i10m + z * i100)])
    return stress, displacement
