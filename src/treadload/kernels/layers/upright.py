"""A layer that is the same in all horizontal directions and another along z: what it does to waves.

In the frame and the units of `kernels.layers.layered`, u = k (i u_k, u_z), f = (i f_k, f_z) and ζ = k z,

    u' = A u - b f,   f' = D u - Aᵀ f,   A = [[0, 1], [-A13/A33, 0]],   b = diag(1/A44, 1/A33),   D = -diag(P, 0)

with P = A11 - A13²/A33. The four waves decay and grow as exp(± s1 ζ), exp(± s2 ζ), the roots of
A33 A44 s⁴ - (A11 A33 - A13² - 2 A13 A44) s² + A11 A44 = 0, real or a complex pair, and the same where the layer is
isotropic. No wave is written out: compliance C, stiffness K and transmission T of a slab grow with its thickness by

    C' = T b Tᵀ,   T' = -T (A + b K),   K' = -D - K A - Aᵀ K - K b K,

so that power series of ζ, the same for every wave, give them where ζ is small, and two equal slabs make one twice as
thick. Nothing is divided by s1 - s2, nothing grows, and what stands on the diagonals is a sum of positive numbers.

Source: Lekhnitskii (1963), Theory of Elasticity of an Anisotropic Elastic Body, for the equations; the
doubling of slabs after van de Hulst (1980), Multiple Light Scattering, chapter 4.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from treadload.kernels.arrays import Array

# Terms of the power series, and what the last may be of the first: where it is more, the slab is halved.
_TERMS, _LEFT = 28, 1e-17

Two = tuple[Any, Any, Any]
"""A symmetric matrix of two rows: xx, zz, xz."""


@dataclass(frozen=True)
class Upright:
    """What such a layer has beside its shear modulus and Poisson's ratio in the horizontal plane, all in Pa.

    along, across, shear: A33, A13 and A44 of its stiffness in Voigt's order.
    """

    along: float
    across: float
    shear: float

    @property
    def lift(self) -> float:
        """A13 / A33: horizontal stress by vertical where nothing strains horizontally; ν / (1 - ν) in isotropy."""
        return self.across / self.along

    def horizontal(self, shear: float, poisson: float) -> float:
        """A11, Pa."""
        return 2 * shear / (1 - poisson) + self.across * self.lift

    def roots(self, shear: float, poisson: float) -> tuple[float, float, float]:
        """Sum g and product of the decays s1 and s2, and the decay s3 of the transverse wave, all over k."""
        first, product = self.horizontal(shear, poisson), self.along * self.shear
        both = math.sqrt(first * self.along)
        total = math.sqrt((both - self.across) * (both + self.across + 2 * self.shear) / product)
        return total, math.sqrt(first / self.along), math.sqrt(shear / self.shear)

    def fade(self, shear: float, poisson: float) -> float:
        """Decay of the wave that reaches deepest, over k: 1 in isotropy."""
        total, product, transverse = self.roots(shear, poisson)
        apart = 0.25 * total * total - product
        # Of real roots the smaller, without a difference; of a complex pair the real part.
        slowest = product / (0.5 * total + math.sqrt(apart)) if apart > 0 else 0.5 * total
        return min(slowest, transverse)

    def half_space(self, shear: float, poisson: float) -> tuple[float, float, float, float]:
        """Compliance of a half-space to waves, times k, 1/Pa: xx, zz, xz and the transverse one.

        Source: Turner (1980), Int. J. Solids Struct. 16, 409-419, for zz.
        """
        first = self.horizontal(shear, poisson)
        both, total = math.sqrt(first * self.along), self.roots(shear, poisson)[0]
        # A11 A33 - A13², without a difference.
        area = self.along * 2 * shear / (1 - poisson)
        return (
            *(self.along * total / area, both * total / area, -1 / (both + self.across)),
            1 / math.sqrt(self.shear * shear),
        )

    def slab(self, phase: Array, shear: float, poisson: float) -> tuple[Two, Two, tuple[Array, ...]]:
        """Compliance C of its top, held at its bottom, 1/Pa; stiffness K of its bottom, free at its top, Pa; T.

        phase: k times the thickness (nk,). T is what the top shows of the bottom: xx, xz, zx, zz and the determinant.
        """
        unit = self.shear
        plate = 2 * shear / (1 - poisson) / unit
        series = _series(plate, self.lift, self.along / unit)
        halvings = np.maximum(0, np.ceil(np.log2(phase / series.reach))).astype(int)
        c, k, t = series.at(np.ldexp(phase, -halvings))
        for step in range(int(halvings.max(initial=0))):
            rows = np.flatnonzero(halvings > step)
            c[:, rows], k[:, rows], t[:, rows] = _doubled(c[:, rows], k[:, rows], t[:, rows])
        return tuple(c / unit), tuple(k * unit), tuple(t)


@dataclass(frozen=True, eq=False)
class _Series:
    """Coefficients (terms, …) of powers of ζ of C and K, xx, zz, xz, and of T, xx, xz, zx, zz; up to `reach`."""

    c: Array
    k: Array
    t: Array
    reach: float

    def at(self, phase: Array) -> tuple[Array, Array, Array]:
        """C (3, nk), K (3, nk) and T (5, nk), the last row of T its determinant."""
        c, k, t = (np.polynomial.polynomial.polyval(phase, coefficients) for coefficients in (self.c, self.k, self.t))
        return c, k, np.concatenate([t, [t[0] * t[3] - t[1] * t[2]]])


@lru_cache(maxsize=64)
def _series(plate: float, lift: float, along: float) -> _Series:
    """Of a layer in units of its A44: P, A13 / A33 and A33."""
    turn = np.array([[0.0, 1.0], [-lift, 0.0]])
    soft = np.diag([1.0, 1 / along])
    c, k, t = (np.zeros((_TERMS, 2, 2)) for _ in range(3))
    t[0] = np.eye(2)
    for n in range(_TERMS - 1):
        before = slice(None, n + 1)
        pressed = np.einsum("nij,jk,nkl->il", k[before], soft, k[before][::-1])
        grown = -k[n] @ turn - turn.T @ k[n] - pressed
        if n == 0:
            grown[0, 0] += plate
        k[n + 1] = grown / (n + 1)
        t[n + 1] = -(t[n] @ turn + np.einsum("nij,jk,nkl->il", t[before], soft, k[before][::-1])) / (n + 1)
        c[n + 1] = np.einsum("nij,jk,nlk->il", t[before], soft, t[before][::-1]) / (n + 1)
    # The first terms on the diagonals are those of ζ, but of K's zz that of ζ³; the others are held against them.
    first = np.abs([c[1, 0, 0], c[1, 1, 1], k[1, 0, 0], k[3, 1, 1], 1.0])
    powers = np.array([1, 1, 1, 3, 0])
    last = np.abs([[entry[n] for entry in (c[:, 0, 0], c[:, 1, 1], k[:, 0, 0], k[:, 1, 1])] for n in (-2, -1)]).max(
        axis=0
    )
    last = np.append(last, np.abs(t[-2:]).max())
    reach = (_LEFT * first / np.maximum(last, 1e-300)) ** (1 / (_TERMS - 2 - powers))
    pairs = [(0, 0), (1, 1), (0, 1)]
    return _Series(
        np.stack([c[:, i, j] for i, j in pairs], axis=1),
        np.stack([k[:, i, j] for i, j in pairs], axis=1),
        t.reshape(_TERMS, 4),
        float(min(reach.min(), 0.5)),
    )


def _doubled(c: Array, k: Array, t: Array) -> tuple[Array, Array, Array]:
    """Two equal slabs as one: C + T W C Tᵀ, K + Tᵀ K W T, T W T with W = (1 + C K)⁻¹."""
    cx, cz, cc = c
    kx, kz, kc = k
    xx, xz, zx, zz, det = t
    c_det, k_det = cx * cz - cc * cc, kx * kz - kc * kc
    whole = 1 + cx * kx + cz * kz + 2 * cc * kc + c_det * k_det
    # W C = (C + det C adj K) / whole, K W = (K + det K adj C) / whole, W = (1 + adj K adj C) / whole.
    soft = np.stack([cx + c_det * kz, cz + c_det * kx, cc - c_det * kc]) / whole
    stiff = np.stack([kx + k_det * cz, kz + k_det * cx, kc - k_det * cc]) / whole
    w = (
        *((1 + kz * cz + kc * cc) / whole, -(kz * cc + kc * cx) / whole),
        *(-(kc * cz + kx * cc) / whole, (1 + kc * cc + kx * cx) / whole),
    )
    rise = w[0] * xx + w[1] * zx, w[0] * xz + w[1] * zz, w[2] * xx + w[3] * zx, w[2] * xz + w[3] * zz
    return (
        c + _between(soft, xx, xz, zx, zz),
        k + _between(stiff, xx, zx, xz, zz),
        np.stack(
            [
                *(xx * rise[0] + xz * rise[2], xx * rise[1] + xz * rise[3]),
                *(zx * rise[0] + zz * rise[2], zx * rise[1] + zz * rise[3]),
                det * det / whole,
            ]
        ),
    )


def _between(s: Array, xx: Array, xz: Array, zx: Array, zz: Array) -> Array:
    """T S Tᵀ of a symmetric S, as xx, zz, xz."""
    ax, az = xx * s[0] + xz * s[2], xx * s[2] + xz * s[1]
    bx, bz = zx * s[0] + zz * s[2], zx * s[2] + zz * s[1]
    return np.stack([ax * xx + az * xz, bx * zx + bz * zz, ax * zx + az * zz])
