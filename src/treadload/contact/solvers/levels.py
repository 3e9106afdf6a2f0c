"""Coarser and finer versions of a field, for starting a solve from the one on half the grid."""

from __future__ import annotations

import numpy as np

from treadload.kernels.arrays import Array, BoolArray

# Axes along which cells are joined: both, or along travel alone.
BOTH, ALONG = (-2, -1), (-1,)


def halve_along(field: Array) -> Array:
    """Means of two cells along travel (…, ny, ⌈nx/2⌉); the last cell of an odd number stays as it is."""
    if field.shape[-1] % 2:
        field = np.concatenate([field, field[..., -1:]], axis=-1)
    return np.asarray(0.5 * (field[..., ::2] + field[..., 1::2]))


def halve(field: Array) -> Array:
    """Means of 2 x 2 cells (…, ⌈ny/2⌉, ⌈nx/2⌉); NaN cells do not count, and only NaN gives NaN."""
    ny, nx = field.shape[-2:]
    if ny % 2 or nx % 2:
        border = [(0, 0)] * (field.ndim - 2) + [(0, ny % 2), (0, nx % 2)]
        field = np.pad(field, border, constant_values=np.nan)
    valid = ~np.isnan(field)
    count, total = _of_four(valid.astype(float)), _of_four(np.where(valid, field, 0.0))
    return np.where(count > 0, total / np.maximum(count, 1), np.nan)


def _of_four(field: Array) -> Array:
    """Sums of 2 x 2 cells, in pairs, so that mirrored fields have mirrored sums to the last digit."""
    along = field[..., ::2] + field[..., 1::2]
    return np.asarray(along[..., ::2, :] + along[..., 1::2, :])


def refine(field: Array, shape: tuple[int, int], axes: tuple[int, ...] = BOTH) -> Array:
    """Field (…, ny, nx) on cells of half the size, linear between the centres of the cells (⌈ny/2⌉, ⌈nx/2⌉).

    axes: along which the cells are of half the size.
    """
    for axis in axes:
        field = _refined(field, axis)
    return field[..., : shape[0], : shape[1]]


def _refined(field: Array, axis: int) -> Array:
    """Twice as many cells along an axis: three quarters of the cell around and one of the nearest other, if any."""
    finer = np.empty([n * (1 + (k - field.ndim == axis)) for k, n in enumerate(field.shape)], field.dtype)
    into, cells = np.moveaxis(finer, axis, 0), np.moveaxis(field, axis, 0)
    near, far = 0.75 * cells, 0.25 * cells
    into[0], into[-1] = cells[0], cells[-1]
    np.add(near[1:], far[:-1], out=into[2::2])
    np.add(near[:-1], far[1:], out=into[1:-1:2])
    return finer


def interpolate(field: Array, valid: BoolArray, shape: tuple[int, int], axes: tuple[int, ...] = BOTH) -> Array:
    """Field (…, ny, nx) on cells of half the size along axes, linear between the known cells (⌈ny/2⌉, ⌈nx/2⌉)."""
    weight = valid.astype(field.dtype)
    total, share = refine(field * weight, shape, axes), refine(weight, shape, axes)
    return np.divide(total, share, out=np.zeros_like(total), where=share > 0)
