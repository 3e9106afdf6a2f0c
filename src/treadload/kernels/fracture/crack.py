"""A crack from a boundary of a layer along a path: its weight functions, and how its faces open.

The faces' relative displacement is a density of dislocations, singular at the tip as 1/√r, whose stress must take
away that of the uncracked body along the path. The density times √(r/a) is a polynomial in r, even in u = √(r/a) on
[-1, 1]: the rule of Gauss and Legendre for u takes its Cauchy integral exactly at the zeros of Legendre's function of
the second kind. What the boundaries send back is as singular where the crack meets them; it is integrated on points
that become ever closer towards the mouth. So the error falls faster than any power of the number of points.
Sources: Erdogan, Gupta and Cook (1973) for rules of Gauss on singular integral equations; Hills, Kelly, Dai and
Korsunsky (1996), Solution of Crack Problems, for dislocations and boundaries.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from treadload.kernels.arrays import Array
from treadload.kernels.fracture.dislocations import (
    Section,
    edge_images,
    edge_in_the_plane,
    edge_layers,
    screw_images,
    screw_in_the_plane,
    screw_layers,
)

# Points in a panel of the close rule; steps of Newton's method, which starts within a hundredth of a spacing.
_PANEL, _NEWTON = 8, 8

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


def crack_faces(section: Section, curve: Curve, length: float, points: int = 16) -> CrackFaces:
    """The faces of a crack up to s = length, m, along a curve in the layer of a section, z from the layer's top.

    points: n, at which tractions count, closest to each other at both ends. 12 give K of a free strip that is cracked
    over 0.9 of its height within 0.1 %.
    """
    n, rule = points, _rule(points)
    at = curve(length * (1 - rule.at**2))
    normal, tangent = _frame(*at[2:])

    def effect(sources: Array, weights: Array, edges: Stress, screws: Stress) -> tuple[Array, Array]:
        """Tractions of densities at the rule's points (2, 2, n, n), in the plane, and (n, n) out of it."""
        of = curve(length * (1 - sources**2))
        burgers = _frame(*of[2:])
        stress, screw = edges(of[:2], at[:2]), screws(of[:2], at[:2])
        vectors = [(stress[:, 0] * vector[0] + stress[:, 1] * vector[1]) @ weights for vector in burgers]
        plane = [[_traction(part, normal, onto) for part in vectors] for onto in (normal, tangent)]
        return np.array(plane), (screw[0] * normal[0][:, None] + screw[1] * normal[1][:, None]) @ weights

    # Beyond the images nothing is singular, unless an interface slides.
    smooth = rule.close if section.slides else rule.twice
    effects = [
        effect(rule.of, np.diag(2 * length * rule.weight), edge_in_the_plane, screw_in_the_plane),
        effect(*rule.spread(rule.close, length), partial(edge_images, section), partial(screw_images, section)),
        effect(*rule.spread(smooth, length), partial(edge_layers, section), partial(screw_layers, section)),
    ]
    # Faces part where the density falls towards the tip.
    matrix = -np.sum([plane for plane, _ in effects], axis=0).transpose(0, 2, 1, 3).reshape(2 * n, 2 * n)
    lateral = np.sum([screw for _, screw in effects], axis=0)
    displacement = 2 * length * rule.opening
    both = np.kron(np.eye(2), displacement)
    _, _, *end = curve(np.array([length]))
    factor = np.pi * np.sqrt(2 * np.pi * length / np.hypot(*end)[0])
    inverse, beside = np.linalg.inv(matrix), np.linalg.inv(lateral)
    return CrackFaces(
        length,
        at[0],
        at[1],
        tangent,
        normal,
        -factor * np.kron(np.eye(2), rule.tip) @ inverse,
        -factor * rule.tip @ beside,
        -both @ inverse,
        -displacement @ beside,
    )


Stress = Callable[[tuple[Array, Array], tuple[Array, Array]], Array]


@dataclass(frozen=True, eq=False)
class _Rule:
    """Points of a crack in u = √(r/a), from its mouth, 1, to its tip, 0.

    of, weight: n sources and their weights in u. at: n points where tractions count. tip: (n,) value at the tip of
    what the sources have. opening: (n, n) its integral from the tip to the points. coefficients: (n, n) of Legendre's
    polynomials of even degree. twice, close: points and weights of finer rules, close as they come to the mouth.
    """

    of: Array
    weight: Array
    at: Array
    tip: Array
    opening: Array
    coefficients: Array
    twice: tuple[Array, Array]
    close: tuple[Array, Array]

    def spread(self, finer: tuple[Array, Array], length: float) -> tuple[Array, Array]:
        """Points u of a finer rule, and from the sources' values to its weighted ones (m, n)."""
        u, weight = finer
        return u, 2 * length * weight[:, None] * (_even(u, len(self.of)) @ self.coefficients)


@functools.lru_cache(maxsize=16)
def _rule(n: int) -> _Rule:
    of, weight = _half(2 * n)
    at = _second_kind_zeros(2 * n)
    degree = 2 * np.arange(n)[:, None]
    coefficients = (2 * degree + 1) * _even(of, n).T * weight
    # ∫ P_k from 0 is (P_k+1 - P_k-1) / (2 k + 1), of which the first is P_1.
    odd = np.polynomial.legendre.legvander(at, 2 * n)[:, 1::2]
    before = np.concatenate([np.zeros((n, 1)), odd[:, :-1]], axis=1)
    opening = (odd - before) / (2 * degree[:, 0] + 1) @ coefficients
    # Panels half as long as the one before, until the last is shorter than the distance of a point from the mouth.
    count = max(3, math.ceil(-math.log2(1 - at[0])) + 1)
    edges = np.concatenate([[0.0], 1 - 0.5 ** np.arange(1, count), [1.0]])
    node, share = np.polynomial.legendre.leggauss(_PANEL)
    half = 0.5 * np.diff(edges)[:, None]
    close = (0.5 * (edges[1:] + edges[:-1])[:, None] + half * node).ravel(), (half * share).ravel()
    tip = (_even(np.zeros(1), n) @ coefficients)[0]
    return _Rule(of, weight, at, tip, opening, coefficients, _half(4 * n), close)


def _half(count: int) -> tuple[Array, Array]:
    """Points and weights in (0, 1), falling, of the rule of Gauss and Legendre with an even count in (-1, 1)."""
    u, weight = np.polynomial.legendre.leggauss(count)
    return u[: count // 2 - 1 : -1].copy(), weight[: count // 2 - 1 : -1].copy()


def _even(u: Array, count: int) -> Array:
    """Legendre's polynomials of the degrees 0, 2, ... (m, count)."""
    return np.polynomial.legendre.legvander(u, 2 * count - 1)[:, ::2]


def _second_kind_zeros(degree: int) -> Array:
    """Zeros in (0, 1), falling, of Legendre's function of the second kind and an even degree, by Newton's method."""
    theta = (np.arange(degree // 2) + 0.25) * np.pi / (degree + 0.5)
    for _ in range(_NEWTON):
        x = np.cos(theta)
        before, value = np.arctanh(x), x * np.arctanh(x) - 1
        for k in range(1, degree):
            before, value = value, ((2 * k + 1) * x * value - k * before) / (k + 1)
        theta += value * np.sin(theta) / (degree * (before - x * value))
    zeros: Array = np.cos(theta)
    return zeros


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
