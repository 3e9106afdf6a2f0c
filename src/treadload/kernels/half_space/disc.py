"""Stress and displacement of a half-space under a uniformly loaded disc, at any depth, in closed form.

Source: Love (1929), Phil. Trans. R. Soc. A 228, 377-420; Lipschitz-Hankel integrals as named by Eason,
Noble and Sneddon (1955), Phil. Trans. R. Soc. A 247, 529-551, written here with Carlson's symmetric elliptic
integrals (Numer. Algorithms 10 (1995), 13-26) so that the axis and far points keep their digits.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy

from treadload.kernels.arrays import Array, ComplexArray, Numbers
from treadload.kernels.half_space.upright import Modes, UprightMedium

# Closer to the axis than this part of the distance to the rim, two terms of the power series in r serve:
# the next one is below 1e-16, while the closed form would lose its digits in r - r.
_AXIS = 1e-4
# Keeps the integrals finite on the rim itself, where they are multiplied by zero.
_RIM = 1e-290
_DUPLICATIONS = 3


def disc_fields(
    radius: float, x: Array, y: Array, z: float, shear: float, poisson: float | UprightMedium
) -> tuple[Array, Array]:
    """Stress and displacement at (x, y, z) per unit pressure on a disc centred at the origin.

    radius: m. x, y: m, broadcast together. z: depth, m, >= 0. shear: shear modulus, Pa. poisson: ν, or what stands in
    its place where the half-space is another along z; shear is then that of the horizontal plane.
    Returns stress (6, ...) in the order xx, yy, zz, xy, xz, yz, tension positive, and displacement (3, ...) in m
    per Pa, z down. On the rim at the surface stress takes the mean of its sides.
    """
    x, y = np.broadcast_arrays(np.asarray(x, float), np.asarray(y, float))
    a, r = radius, np.hypot(x, y)
    of_media = _isotropic(a, r, z, poisson) if isinstance(poisson, int | float) else _upright(a, r, z, poisson)
    radial, around, down, slant, outward, sunk = of_media
    c, t = np.where(r > 0, x / np.where(r > 0, r, 1), 1), np.where(r > 0, y / np.where(r > 0, r, 1), 0)
    stress = np.stack(
        [
            c * c * radial + t * t * around,
            t * t * radial + c * c * around,
            down,
            c * t * (radial - around),
            c * slant,
            t * slant,
        ]
    )
    return stress, np.stack([x * outward, y * outward, sunk]) / shear


def _isotropic(a: float, r: Array, z: float, nu: float) -> tuple[Array, ...]:
    """σ_rr, σ_tt, σ_zz, σ_rz, u_r / r and u_z, displacement times the shear modulus."""
    f, soft = _Integrals.of(a, r, z), 1 - 2 * nu
    hoop = soft * f.i11m_r - z * f.i110_r
    radial, around = -a * (f.i100 - f.zi101 - hoop), -a * (2 * nu * f.i100 + hoop)
    sunk = a / 2 * (2 * (1 - nu) * f.i10m + z * f.i100)
    return radial, around, -a * (f.i100 + f.zi101), -a * f.zi111, -a / 2 * hoop, sunk


def _upright(a: float, r: Array, z: float, medium: UprightMedium) -> tuple[Array, ...]:
    """The same of a half-space that is another along z: the waves of `kernels.half_space.upright`."""
    modes: Modes = medium.modes
    alone = _Integrals.of(a, r, z) if z <= 0 else None
    total: Numbers = np.zeros(())
    for s, weight, kk, tt, out, down in zip(
        modes.decay, modes.pressed, modes.along, modes.across, modes.out, modes.down, strict=True
    ):
        f = _Integrals.of(a, r, z * s) if alone is None else alone
        turned = (kk - tt) * f.i11m_r
        total = total + weight * np.stack(
            [kk * f.i100 - turned, tt * f.i100 + turned, -f.i100, -s * r * f.i110_r, out * f.i11m_r, down * f.i10m]
        )
    return tuple(a * total.real)


@dataclass(frozen=True, eq=False)
class _Integrals:
    """∫ J(k a) J(k r) kⁿ e^{-k z} dk at distances r (...): the orders of both J and n, `m` for -1, `_r` over r.

    zi101, zi111: times z, those that only isotropy needs, at real depths.
    """

    i100: Array
    i110_r: Array
    i10m: Array
    i11m_r: Array
    zi101: Array
    zi111: Array

    @classmethod
    def of(cls, a: float, r: Array, z: complex) -> _Integrals:
        """z: depth, complex with a positive real part where waves swing; 0 is the surface."""
        s2, d2 = (a + r) ** 2 + z * z, (a - r) ** 2 + z * z
        s, m, rest = np.sqrt(s2), 4 * a * r / s2, d2 / s2
        rest = np.where(np.abs(rest) < _RIM, _RIM, rest)
        zero, ones = np.zeros_like(rest), np.ones_like(rest)
        first = scipy.special.elliprf(zero, rest, ones)
        part = scipy.special.elliprd(zero, rest, ones) / 3
        second = first - m * part
        # ∫ J0 J0 and ∫ J1 J1 of arguments a t and r t under e^(-z t).
        i000 = 2 / (math.pi * s) * first
        i110_r = np.where(r > 0, (2 * part - first) * 2 / (math.pi * s) / np.where(r > 0, r, 1), 0)
        inside = 0.5 * (1 + np.sign(a - r))
        if z != 0:
            third = _third(rest, np.maximum(((a - r) / (a + r)) ** 2, _RIM)) * np.sign(a - r) ** 2
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
            zi101 = zi111 = np.zeros_like(r)
        i100 = angle / a
        i11m_r = 0.5 * (a * outer / np.where(r > 0, r, 1) + i100 - z * i110_r)
        near = r < _AXIS * np.abs(s)
        s0 = np.sqrt(a * a + z * z)
        axis = 0.5 * (1 - z / s0) / a - r**2 / 16 * 3 * a * z / s0**5
        axis_1 = 0.5 * a / s0**3 - r**2 / 16 * 3 * a * (4 * z * z - a * a) / s0**7
        i11m_r, i110_r = np.where(near, axis, i11m_r), np.where(near, axis_1, i110_r)
        zi111 = np.where(near, r * z * 1.5 * a * z / s0**5, zi111)
        i10m = a * i000 - r * r * i110_r - z * i100
        return cls(i100, i110_r, i10m, i11m_r, zi101, zi111)


def _third(rest: Numbers, p: Numbers) -> Numbers:
    """Carlson's R_J(0, rest, 1, p), p > 0; rest may be complex, off the negative real axis."""
    if not np.iscomplexobj(rest):
        plain: Array = scipy.special.elliprj(np.zeros_like(rest), rest, np.ones_like(rest), p)
        return plain
    # SciPy's wants arguments in the right half of the plane: duplication moves them there.
    x, y, z, p = np.zeros_like(rest), rest, np.ones_like(rest), p + 0j
    total, share = np.zeros_like(rest), 1.0
    for _ in range(_DUPLICATIONS):
        root_x, root_y, root_z, root_p = np.sqrt(x), np.sqrt(y), np.sqrt(z), np.sqrt(p)
        moved = root_x * root_y + root_x * root_z + root_y * root_z
        d = (root_p + root_x) * (root_p + root_y) * (root_p + root_z)
        total += share * 6 / d * scipy.special.elliprc(np.ones_like(d), 1 + (p - x) * (p - y) * (p - z) / d**2)
        share /= 4
        x, y, z, p = ((term + moved) / 4 for term in (x, y, z, p))
    turned: ComplexArray = total + share * scipy.special.elliprj(x, y, z, p)
    return turned
