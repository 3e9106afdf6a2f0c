"""One cuboid of uniform eigenstrain below a free surface: stress anywhere, displacement of the surface.

z points into the body, tension is positive, components are xx, yy, zz, xy, xz, yz with the tensor's shear.

Source: as of `kernels.eigenstrain.potentials`; equivalent to Liu, Jin, Wang, Keer and Wang (2012), Philos. Mag. 92,
1-27, for a half-space, in 27 elementary functions.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from treadload.kernels.arrays import Array
from treadload.kernels.eigenstrain.corners import displacement_kernels, stress_kernels
from treadload.kernels.eigenstrain.potentials import coefficients

# Points nearer to a face than this part of the cuboid are moved off it: stress is not defined there.
_OFF = 1e-9


@dataclass(frozen=True)
class Cuboid:
    """|x - x0| < length / 2, |y - y0| < width / 2, top < z < bottom, m."""

    x0: float
    y0: float
    length: float
    width: float
    top: float
    bottom: float


def cuboid_stress(
    strain: Array, cuboid: Cuboid, x: Array, y: Array, z: Array, shear: float, poisson: float, *, surface: bool = True
) -> Array:
    """Stress (6, n), Pa, at points under a uniform eigenstrain in a cuboid.

    strain: (6,). x, y, z: (n,), m, z >= 0 with a free surface at z = 0; surface: False for an endless body.
    shear: Pa. On the plane of a face, and so on the surface above a cuboid that reaches it, the field is that 1e-9 of
    the cuboid beside it, towards larger x, y and z.
    """
    of = coefficients(poisson)
    edges = np.array([cuboid.top, cuboid.bottom])
    stress = np.empty((6, len(x)))
    for number, (px, py, pz) in enumerate(zip(x, y, z, strict=True)):
        along = _corners(px - cuboid.x0, cuboid.length)
        across = _corners(py - cuboid.y0, cuboid.width)[:, None]
        depth = _beside(pz, edges)
        kernel = stress_kernels(along, across, depth, edges, of, _between, surface=surface)[..., 0, 0, 0]
        inside = along[0] < 0 < along[1] and across[0, 0] < 0 < across[1, 0] and edges[0] < depth < edges[1]
        stress[:, number] = shear * ((kernel - of.inside if inside else kernel) @ strain)
    return stress


def cuboid_surface_displacement(strain: Array, cuboid: Cuboid, x: Array, y: Array, poisson: float) -> Array:
    """Displacement (3, n), m, of points of the free surface under a uniform eigenstrain (6,) in a cuboid.

    x, y: (n,), m. The same for every shear modulus; zero far away.
    """
    of = coefficients(poisson)
    edges = np.array([cuboid.top, cuboid.bottom])
    moved = np.empty((3, len(x)))
    for number, (px, py) in enumerate(zip(x, y, strict=True)):
        along = _corners(px - cuboid.x0, cuboid.length)
        across = _corners(py - cuboid.y0, cuboid.width)[:, None]
        moved[:, number] = displacement_kernels(along, across, edges, of, _between)[..., 0, 0, 0] @ strain
    return moved


def _between(functions: Array) -> Array:
    result: Array = np.diff(np.diff(functions, axis=-1), axis=-2)
    return result


def _corners(offset: float, size: float) -> Array:
    """From the far and the near corner of a cell, along an axis, to a point, none of them zero, (2,)."""
    corners = np.array([offset - size / 2, offset + size / 2])
    return np.where(np.abs(corners) < _OFF * size, _OFF * size, corners)


def _beside(depth: float, edges: Array) -> float:
    off = _OFF * float(edges[1] - edges[0])
    return depth + off if np.abs(edges - depth).min() < off else depth
