"""Coarser and finer versions of a field, for starting a solve from the one on half the grid."""

from __future__ import annotations

import numpy as np

from treadload.kernels.arrays import Array, BoolArray


def halve(field: Array) -> Array:
    """Means of 2 x 2 cells (…, ⌈ny/2⌉, ⌈nx/2⌉); NaN cells do not count, and only NaN gives NaN."""
    ny, nx = field.shape[-2:]
    padded = np.pad(field, [(0, 0)] * (field.ndim - 2) + [(0, ny % 2), (0, nx % 2)], constant_values=np.nan)
    blocks = padded.reshape(*field.shape[:-2], (ny + 1) // 2, 2, (nx + 1) // 2, 2)
    known = ~np.isnan(blocks)
    count = known.sum((-3, -1))
    total = np.where(known, blocks, 0.0).sum((-3, -1))
    return np.where(count > 0, total / np.maximum(count, 1), np.nan)


def refine(field: Array, shape: tuple[int, int]) -> Array:
    """Field (ny, nx) on cells of half the size, linear between the centres of the cells (⌈ny/2⌉, ⌈nx/2⌉)."""
    return _refined(_refined(field).T).T[: shape[0], : shape[1]]


def _refined(rows: Array) -> Array:
    """Twice as many rows: three quarters of the row around and one of the nearest other, which the outermost lack."""
    finer = np.empty((2 * rows.shape[0], rows.shape[1]), rows.dtype)
    near, far = 0.75 * rows, 0.25 * rows
    finer[0], finer[-1] = rows[0], rows[-1]
    np.add(near[1:], far[:-1], out=finer[2::2])
    np.add(near[:-1], far[1:], out=finer[1:-1:2])
    return finer


def double(field: Array, shape: tuple[int, int]) -> Array:
    """Every cell repeated 2 x 2 and cut to (…, ny, nx)."""
    return field.repeat(2, axis=-2).repeat(2, axis=-1)[..., : shape[0], : shape[1]]


def interpolate(field: Array, known: BoolArray, shape: tuple[int, int]) -> Array:
    """Field (…, ny, nx) on cells of half the size, linear between the known cells (⌈ny/2⌉, ⌈nx/2⌉)."""
    weight = known.astype(float)
    total = _between(_between(field * weight, -1), -2)
    share = _between(_between(weight, -1), -2)
    return np.divide(total, share, out=np.zeros_like(total), where=share > 0)[..., : shape[0], : shape[1]]


def _between(field: Array, axis: int) -> Array:
    """Twice as many cells along an axis: three quarters of the cell around and one of the nearest other."""
    cells = np.moveaxis(field, axis, -1)
    before = np.concatenate([cells[..., :1], cells[..., :-1]], axis=-1)
    after = np.concatenate([cells[..., 1:], cells[..., -1:]], axis=-1)
    halves = np.stack([0.75 * cells + 0.25 * before, 0.75 * cells + 0.25 * after], axis=-1)
    return np.moveaxis(halves.reshape(*cells.shape[:-1], -1), -1, axis)
