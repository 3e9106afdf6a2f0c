"""Functions of the distance to a corner of a cuboid, and what the corners of layers of cells add up to.

Stress and surface displacement of a uniform eigenstrain in a cuboid are alternating sums over its eight corners of
fourth derivatives of Ψ, `derivatives`, of the waves of its image, `kernels.half_space.waves`, and of products of
these with depths, see `kernels.eigenstrain.potentials`. An end of the cuboid far away makes it a bar.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from treadload.kernels.arrays import Array, Numbers
from treadload.kernels.eigenstrain.potentials import FOURTH, Coefficients
from treadload.kernels.half_space.waves import Waves

Difference = Callable[[Array], Array]
"""Functions at corners (..., nY, nX) → their differences between the two corners of each cell, along both axes."""


def derivatives(x: Numbers, y: Numbers, z: Numbers) -> Array:
    """Corner functions of the fourth derivatives of Ψ in the order of `FOURTH`, (15, ...), without unit.

    x, y, z: from a corner, m, arrays that broadcast. On the plane of a face: the mean of both sides; on the line
    of an edge, where some are infinite, not defined.
    """
    r = np.sqrt(x * x + y * y + z * z)
    xy, xz, yz = x * x + y * y, x * x + z * z, y * y + z * z
    volume = x * y * z / r
    a, b, c = volume / xy, volume / xz, volume / yz
    log_x, log_y, log_z = np.arcsinh(x / np.sqrt(yz)), np.arcsinh(y / np.sqrt(xz)), np.arcsinh(z / np.sqrt(xy))
    values = {
        (4, 0, 0): a + b - 2 * _arctan(y * z, x * r), (0, 4, 0): a + c - 2 * _arctan(x * z, y * r),
        (0, 0, 4): b + c - 2 * _arctan(x * y, z * r), (2, 2, 0): -a, (2, 0, 2): -b, (0, 2, 2): -c,
        (2, 1, 1): x / r, (1, 2, 1): y / r, (1, 1, 2): z / r,
        (3, 1, 0): log_z - x * x * z / (xy * r), (1, 3, 0): log_z - y * y * z / (xy * r),
        (3, 0, 1): log_y - x * x * y / (xz * r), (1, 0, 3): log_y - z * z * y / (xz * r),
        (0, 3, 1): log_x - y * y * x / (yz * r), (0, 1, 3): log_x - z * z * x / (yz * r),
    }  # fmt: skip
    return np.stack(np.broadcast_arrays(*(values[powers] for powers in FOURTH)))


def stress_kernels(x: Array, y: Array, depth: float, edges: Array, of: Coefficients, cells: Difference, *,
                   surface: bool = True) -> Array:  # fmt: skip
    """Stress per unit of eigenstrain in layers of cells, for a shear modulus of 1, less what is in the cell itself.

    x, y: from corners of cells to the point, m, arrays that broadcast to (nY, nX). depth: of the point, m. edges:
    (n + 1,), m, of the layers. cells: differences along x and y. surface: False for an endless body.
    Returns (6, 6, n, ny, nx): stress, eigenstrain, layer, cell.
    """
    levels = edges[:, None, None]
    full = cells(derivatives(x, y, depth - levels))
    # Along z corners count from the near side: the source's coordinate runs against the distance.
    kernels = -np.tensordot(of.full, np.diff(full, axis=1), 1)
    if surface:
        kernels += _image(x, y, depth, edges, of, cells)
    return kernels


def _image(x: Array, y: Array, depth: float, edges: Array, of: Coefficients, cells: Difference) -> Array:
    """Of the image, (6, 6, n, ny, nx)."""
    deep = edges[:, None, None]
    waves = Waves(x, y, depth + deep)
    (c00, c01), (c10, c11) = of.stress
    slopes = cells(waves.slopes)
    functions = np.concatenate([cells(waves.values), slopes, deep * slopes, deep * cells(waves.curvatures)])
    factors = np.concatenate([c00 + c01, -depth * (c10 + c11), -c01, depth * c11], axis=-1)
    # Differences of the functions are fewer than those of the fields.
    result: Array = np.tensordot(factors, np.diff(functions, axis=1), 1)
    return result


def displacement_kernels(x: Array, y: Array, edges: Array, of: Coefficients, cells: Difference) -> Array:
    """Displacement of the free surface per unit of eigenstrain in layers of cells, m.

    Arguments as of `stress_kernels`. Returns (3, 6, n, ny, nx). At a corner below the point itself nothing is
    infinite but an edge at the surface.
    """
    waves = Waves(x, y, edges[:, None, None])
    e0, e1 = of.moved
    values, integrals = edges[:, None, None] * cells(waves.values), cells(waves.integrals)
    result: Array = np.diff(np.tensordot(e1, values, 1) - np.tensordot(e0 + e1, integrals, 1), axis=2)
    return result


def _arctan(rise: Numbers, run: Numbers) -> Numbers:
    """atan(rise / run), 0 where the run is."""
    rise, run = np.broadcast_arrays(rise, run)
    return np.arctan(np.divide(rise, run, out=np.zeros(run.shape), where=run != 0))
