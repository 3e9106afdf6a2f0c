"""Surface displacement of two half-spaces at points ahead of the centres of the loaded rectangles' lattice.

The closed forms of `kernels.half_space.rectangle`, at offsets that are no whole cells: what a particle felt before it
travelled a step. They have no parity along x, and a corner may lie on x = 0, where every form has a limit.

Sources: those of `kernels.half_space.rectangle`.
"""

from __future__ import annotations

import numpy as np

from treadload.kernels.arrays import Array
from treadload.kernels.half_space.rectangle import CombinedElasticity


def tangential_by_shear(x: Array, y: Array, dx: float, dy: float, bodies: CombinedElasticity) -> Array:
    """u_x by q_x, u_y by q_y and u_x by q_y = u_y by q_x under unit shear: (3, ny, nx), m/Pa.

    x (nx,), y (ny,): distances from the centre of a rectangle dx by dy, m, dx and dy apart.
    """
    nu, scale = bodies.poisson, 1 / (np.pi * bodies.shear_modulus)
    x, y = _corners(x, dx)[None, :], _corners(y, dy)[:, None]
    along_x = _corner_sum(_product_with_asinh(x, y))
    along_y = _corner_sum(_product_with_asinh(y, x))
    cross = _corner_sum(-np.hypot(x, y))
    kernels: Array = scale * np.stack([(1 - nu) * along_x + along_y, along_x + (1 - nu) * along_y, nu * cross])
    return kernels


def coupling(x: Array, y: Array, dx: float, dy: float, bodies: CombinedElasticity) -> Array:
    """k_x, k_y with u_x = -k_x ∗ p, u_y = -k_y ∗ p: (2, ny, nx), m/Pa; arguments as in `tangential_by_shear`."""
    scale = bodies.difference / (np.pi * bodies.shear_modulus)
    x, y = _corners(x, dx)[None, :], _corners(y, dy)[:, None]
    squared = x**2 + y**2
    # At a corner on both axes every term is zero.
    half_log = 0.5 * np.log(squared, out=np.zeros_like(squared), where=squared > 0)
    k_x = _corner_sum(y * half_log + x * np.arctan2(y * np.sign(x), np.abs(x)))
    k_y = _corner_sum(x * half_log + y * np.arctan2(x * np.sign(y), np.abs(y)))
    kernels: Array = scale * np.stack([k_x, k_y])
    return kernels


def _corners(centres: Array, spacing: float) -> Array:
    """Distances (n + 1,) of the corners; those within round-off of zero are zero."""
    corners = np.append(centres, centres[-1] + spacing) - spacing / 2
    return np.where(np.abs(corners) < 1e-9 * spacing, 0.0, corners)


def _product_with_asinh(first: Array, second: Array) -> Array:
    """The first times asinh(second/|first|), with its limit zero where the first is zero."""
    size = np.abs(first)
    product: Array = first * np.arcsinh(second / np.where(size > 0, size, 1.0))
    return product


def _corner_sum(f: Array) -> Array:
    return f[1:, 1:] - f[1:, :-1] - f[:-1, 1:] + f[:-1, :-1]
