"""Coefficients of the corner functions that the fields of a uniform eigenstrain in a cuboid are sums of.

The stress of an eigenstrain e in an endless body follows from the fourth derivatives of Ψ = ∫ R dV alone,

    ε_im = -1/(4π μ) [(τ_il Φ,lm + τ_ml Φ,li)/2 - τ_jl Ψ,ijlm / (4 (1-ν))],   τ = C:e,   Φ = ∇²Ψ/2,

σ = C:ε, less τ inside. The free surface adds the field of the tractions that it takes away: in wavenumbers, for a
source plane at depth c, k exp(-k (z + c)) (C00 + C10 k z + C01 k c + C11 k² z c), where each C is a polynomial in
cosine and sine of the wave's direction, even and of degree four, or i times an odd one of degree three. The C are
read off the half-space's own transfer (`kernels.layers.layered`) at two depths and a few directions, which is exact.

Source: Mura (1987), Micromechanics of Defects in Solids, sections 11 and 15; Chiu (1977), J. Appl. Mech. 44, 587, for
the cuboid; Chiu (1978), J. Appl. Mech. 45, 302, for the surface, of whose potentials this is another form.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from treadload.kernels.arrays import Array, Numbers
from treadload.kernels.half_space.waves import POWERS
from treadload.kernels.layers.layered import Stack, transfer

PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
"""Axes of each component of a tensor: xx, yy, zz, xy, xz, yz."""

FOURTH = tuple((a, b, 4 - a - b) for a in range(5) for b in range(5 - a))
"""How often each fourth derivative of Ψ differentiates along x, y and z."""

_COMPONENT = np.array([[0, 3, 4], [3, 1, 5], [4, 5, 2]])
# Directions that the coefficients are read off at: more than the nine unknowns.
_DIRECTIONS = 16


@dataclass(frozen=True, eq=False)
class Coefficients:
    """Fields per unit of each component of the eigenstrain, the last axis but one, for a shear modulus of 1 Pa.

    inside: (6, 6), C: stress is less by it in the cell. full: (6, 6, 15), of `FOURTH`. stress: (2, 2, 6, 6, 9), C of
    the image by powers of k z and k c, of `POWERS`. moved: (2, 3, 6, 9), of the surface's displacement by powers of
    k c. Factors -1 of the odd functions are in.
    """

    inside: Array
    full: Array
    stress: Array
    moved: Array


@lru_cache(maxsize=32)
def coefficients(poisson: float) -> Coefficients:
    """Of a body of this Poisson's ratio, < 0.5."""
    stiffness, full = _stiffness(poisson), _full(poisson)
    theta = 2 * math.pi * (np.arange(_DIRECTIONS) + 0.5) / _DIRECTIONS
    c, s = np.cos(theta), np.sin(theta)
    # Depths of the source 0 and 1: what the endless body has at the plane of the surface.
    at_source = [_waves_of_source(full, c, s, source) for source in (0.0, 1.0)]
    values = np.empty((2, 2, 6, 6, _DIRECTIONS), complex)
    moved = np.empty((2, 3, 6, _DIRECTIONS), complex)
    response, deflection = _surface_response(poisson, c, s)
    for number, (stress, displacement) in enumerate(zip(at_source, _moved_by_source(poisson, c, s), strict=True)):
        traction = stress[[4, 5, 2]]
        values[:, number] = math.exp(number) * np.einsum("zisk,sjk->zijk", response, traction)
        moved[number] = math.exp(number) * (displacement + np.einsum("isk,sjk->ijk", deflection, traction))
    values[1] -= values[0]
    values[:, 1] -= values[:, 0]
    moved[1] -= moved[0]
    return Coefficients(stiffness, full, _fitted(values, c, s), _fitted(moved, c, s))


def _stiffness(nu: float) -> Array:
    """C (6, 6) on tensor components, shear modulus 1."""
    stiffness = np.diag([2.0] * 6)
    stiffness[:3, :3] += 2 * nu / (1 - 2 * nu)
    return stiffness


def _derivatives(*axes: int) -> int:
    """Number in `FOURTH` of the derivative along four axes."""
    return FOURTH.index((axes.count(0), axes.count(1), axes.count(2)))


def _full(nu: float) -> Array:
    """Stress of an endless body, outside of the source, by the fourth derivatives of Ψ, (6, 6, 15)."""
    stiffness = _stiffness(nu)
    strain = np.zeros((6, 6, len(FOURTH)))
    for row, (i, m) in enumerate(PAIRS):
        for column in range(6):
            tau = stiffness[:, column][_COMPONENT]
            for axis in range(3):
                for a, b in ((i, m), (m, i)):
                    for n in range(3):
                        strain[row, column, _derivatives(axis, b, n, n)] -= tau[a, axis] / 4
            for j, axis in itertools.product(range(3), repeat=2):
                strain[row, column, _derivatives(i, j, axis, m)] += tau[j, axis] / (4 * (1 - nu))
    stress: Array = np.einsum("ij,jkq->ikq", stiffness, strain / (4 * math.pi))
    return stress


def _along(c: Array, s: Array, source: float, a: int, b: int, n: int) -> Numbers:
    """∂xᵃ ∂yᵇ ∂zⁿ of -2π (1 + |ζ|) exp(-|ζ|), R in waves of k = 1, at z = 0 above a source, (directions,)."""
    # (1 - ζ) exp(ζ) of ζ = z - c < 0; each derivative takes one more from the constant.
    along = (1 - n + source) * math.exp(-source)
    return -2 * math.pi * (1j * c) ** a * (1j * s) ** b * along


def _waves_of_source(full: Array, c: Array, s: Array, source: float) -> Numbers:
    """Stress (6, 6, directions) in waves of k = 1 at the plane of the surface in an endless body."""
    waves: Numbers = full @ np.array([_along(c, s, source, *powers) for powers in FOURTH])
    return waves


def _moved_by_source(nu: float, c: Array, s: Array) -> list[Numbers]:
    """Displacement (3, 6, directions), likewise, under sources at depths 0 and 1."""
    stiffness = _stiffness(nu)
    results: list[Numbers] = []
    for source in (0.0, 1.0):
        moved = np.zeros((3, 6, len(c)), complex)

        def third(*axes: int, source: float = source) -> Numbers:
            return _along(c, s, source, axes.count(0), axes.count(1), axes.count(2))

        for i in range(3):
            for column in range(6):
                tau = stiffness[:, column][_COMPONENT]
                for axis in range(3):
                    curl = sum(third(axis, n, n) for n in range(3)) / 2
                    moved[i, column] -= tau[i, axis] * curl
                    for j in range(3):
                        moved[i, column] += tau[j, axis] * third(i, j, axis) / (4 * (1 - nu))
        results.append(moved / (4 * math.pi))
    return results


def _surface_response(nu: float, c: Array, s: Array) -> tuple[Numbers, Numbers]:
    """What taking tractions xz, yz and zz off the surface does: stress times e^z at z = 0 and 1, displacement at 0.

    Stress (2, 6, 3, directions), displacement (3, 3, directions), in waves of k = 1 and a shear modulus of 1.
    """
    solved = transfer([1.0], Stack([1.0], [nu], [math.inf], []), [0.0, 1.0], [True, True])
    stress = np.empty((2, 6, 3, len(c)), complex)
    moved = np.empty((3, 3, len(c)), complex)
    zero, ones = np.zeros_like(c), np.ones_like(c)
    for column, (along, across, down) in enumerate(((c, -s, zero), (s, c, zero), (zero, zero, ones))):
        for row, depth in enumerate((0.0, 1.0)):
            # Loads are what cancels σ: q = σ_xz, p = σ_zz. i f_k and f_z, f_t.
            plane, turned = solved.plane[row, :, :, 0], solved.transverse[row, :, 0]
            u, w, shear, push = plane[:, 0, None] * (1j * along) + plane[:, 1, None] * down
            v, slide = turned[0] * across, turned[1] * across
            kk, zz, kt = u, -push, 0.5j * v
            vertical = ((1 - 2 * nu) * zz / 2 - nu * kk) / (1 - nu)
            trace = kk + vertical
            lame = 2 * nu / (1 - 2 * nu)
            s_kk, s_tt, s_kt = 2 * kk + lame * trace, lame * trace, 2 * kt
            k_z, t_z = 1j * shear, -slide
            stress[row, :, column] = math.exp(depth) * np.array(
                [
                    c * c * s_kk + s * s * s_tt - 2 * c * s * s_kt,
                    s * s * s_kk + c * c * s_tt + 2 * c * s * s_kt,
                    zz,
                    c * s * (s_kk - s_tt) + (c * c - s * s) * s_kt,
                    c * k_z - s * t_z,
                    s * k_z + c * t_z,
                ]
            )
            if row == 0:
                moved[:, column] = c * -1j * u - s * v, s * -1j * u + c * v, w
    return stress, moved


def _fitted(values: Numbers, c: Array, s: Array) -> Array:
    """Coefficients of `POWERS` (..., 9) of functions of the direction (..., directions), odd ones times -1."""
    waves = np.array([c**a * s**b for a, b in POWERS]).T
    even, odd = np.linalg.pinv(waves[:, :5]), np.linalg.pinv(waves[:, 5:])
    return np.concatenate([values.real @ even.T, -values.imag @ odd.T], axis=-1)
