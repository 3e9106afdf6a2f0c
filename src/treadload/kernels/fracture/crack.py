"""A crack from a boundary of a layer along a path: its weight functions, and how its faces open.

The faces' relative displacement is a density of dislocations, singular at the tip as 1/√r, whose stress must take
away that of the uncracked body along the path. Gauss-Chebyshev quadrature with n points solves the integral equation.
Sources: Erdogan, Gupta and Cook (1973); Hills, Kelly, Dai and Korsunsky (1996), Solution of Crack Problems.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from treadload.kernels.arrays import Array
from treadload.kernels.fracture.dislocations import Section, edge_stress, screw_stress

Curve = Callable[[Array], tuple[Array, Array, Array, Array]]
"""Places x, z, m, and dx/ds, dz/ds at s, m, from the mouth: lengths, or what rises with them."""


@dataclass(frozen=True, eq=False)
class CrackFaces:
    """Points along a crack, and what traction there does.

    x, z: of the points (n,), m, from the mouth to the tip. tangent: (2, n) towards the tip, normal: (2, n). plane:
    stress intensity K_I, K_II (2, 2 n), √m, from the uncracked normal and shear traction at the points, Pa.
    antiplane: K_III (n,). opening, sliding: (2 n, 2 n) relative displacement, normal and tangential, from the same
    tractions, times E / 4π (1 - ν²), m. tearing: (n, n), likewise times μ / 2π.
    """

    length: float
    x: Array
    z: Array
    tangent: Array
    normal: Array
    plane: Array
    antiplane: Array
    opening: Array
    tearing: Array


def straight(direction: tuple[float, float], mouth: tuple[float, float] = (0.0, 0.0)) -> Curve:
    """A straight path from its mouth (x, z), m, in a direction, a unit vector."""

    def curve(s: Array) -> tuple[Array, Array, Array, Array]:
        along, down = direction
        return mouth[0] + along * s, mouth[1] + down * s, np.full_like(s, along), np.full_like(s, down)

    return curve


def crack_faces(section: Section, curve: Curve, length: float, points: int = 32) -> CrackFaces:
    """The faces of a crack up to s = length, m, along a curve in the layer of a section, z from the layer's top."""
    n = points
    theta = (2 * np.arange(1, n + 1) - 1) * np.pi / (2 * n + 1)
    phi = 2 * np.arange(1, n + 1)[::-1] * np.pi / (2 * n + 1)
    at, of = np.cos(phi), np.cos(theta)
    weight = 2 * np.pi * (1 + of) / (2 * n + 1)
    x, z, along, down = curve(0.5 * length * (1 + at))
    xi, zeta, its_along, its_down = curve(0.5 * length * (1 + of))
    normal, tangent = _frame(along, down)
    its_normal, its_tangent = _frame(its_along, its_down)
    # Stress of Burgers vectors along the normal and the tangent at the sources.
    stress = edge_stress(section, (xi, zeta), (x, z)) * (0.5 * length * weight)
    tractions = [sum(stress[:, part] * vector[part] for part in range(2)) for vector in (its_normal, its_tangent)]
    # Faces part where the density falls towards the tip.
    matrix = -np.block(
        [[_traction(stress_part, normal, direction) for stress_part in tractions] for direction in (normal, tangent)]
    )
    screw = screw_stress(section, (xi, zeta), (x, z)) * (0.5 * length * weight)
    lateral = screw[0] * normal[0][:, None] + screw[1] * normal[1][:, None]
    # Coefficients of Chebyshev polynomials of the third kind, of which all are 1 at the tip.
    order = np.arange(n)
    third = np.cos((order[:, None] + 0.5) * theta) / np.cos(0.5 * theta)
    coefficients = third * weight / np.pi
    tip = coefficients.sum(axis=0)
    gathered = np.sin((order + 1) * phi[:, None]) / (order + 1)
    gathered[:, 0] += phi
    gathered[:, 1:] += np.sin(order[1:] * phi[:, None]) / order[1:]
    displacement = 0.5 * length * gathered @ coefficients
    both = np.kron(np.eye(2), displacement)
    _, _, *end = curve(np.array([length]))
    factor = np.pi * np.sqrt(2 * np.pi * length / np.hypot(*end)[0])
    inverse, beside = np.linalg.inv(matrix), np.linalg.inv(lateral)
    return CrackFaces(
        length,
        x,
        z,
        tangent,
        normal,
        -factor * np.kron(np.eye(2), tip) @ inverse,
        -factor * tip @ beside,
        -both @ inverse,
        -displacement @ beside,
    )


def _frame(along: Array, down: Array) -> tuple[Array, Array]:
    """Unit normal and tangent (2, n)."""
    size = np.hypot(along, down)
    return np.stack([down, -along]) / size, np.stack([along, down]) / size


def _traction(stress: Array, normal: Array, onto: Array) -> Array:
    """Part along `onto` of the traction on planes of a normal, of stress (xx, zz, xz; points, sources)."""
    xx, zz, xz = stress
    n, m = (vector[:, :, None] for vector in (normal, onto))
    traction: Array = xx * n[0] * m[0] + zz * n[1] * m[1] + xz * (n[0] * m[1] + n[1] * m[0])
    return traction
