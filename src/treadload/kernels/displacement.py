"""Displacement of a half-space under uniformly loaded rectangles, at the surface and at any depth.

Load, cells and signs as in `kernels.interior`; displacement (3, ...) along x, y and z, z down, m.

Source: Love (1929), Phil. Trans. R. Soc. A 228, 377-420; Boussinesq's and Cerruti's point loads as in Johnson
(1985), Contact Mechanics, section 3.2, integrated over a rectangle.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from treadload.kernels.arrays import Array, ComplexArray
from treadload.kernels.convolution import Padding
from treadload.kernels.interior import as_lattices, corner_blocks, corner_jumps, loaded_part

_X, _Y, _Z = range(3)
_P, _QX, _QY = range(3)
_LATTICE_COST = 2.0

_Corner = tuple[Array, tuple[tuple[int, int], ...]]


def displacement_on_grid(
    load: Array, dx: float, dy: float, depths: Array, shear: float, poisson: float, x: Array, y: Array
) -> Array:
    """Displacement on the grid of any coordinates x and y, m.

    load: (3, ny, nx), Pa: pressure, shear along x and y on the body. dx, dy: cell, m. depths: (nz,), m, >= 0.
    shear: shear modulus, Pa. poisson: Poisson's ratio. x: (mx,), y: (my,): coordinates relative to the centre
    of the first cell, m. Returns (nz, 3, my, mx). By FFT on lattices of the cells' spacing or by direct sums,
    whichever costs less.
    """
    field = np.zeros((len(depths), 3, len(y), len(x)))
    part = loaded_part(load)
    if part is None:
        return field
    load, row, column = part
    x, y = x - dx * column, y - dy * row
    lattices_x, lattices_y = as_lattices(x, dx), as_lattices(y, dy)
    _, ny, nx = load.shape
    padded = sum(nx + n for _, n, _, _ in lattices_x) * sum(ny + n for _, n, _, _ in lattices_y)
    if _LATTICE_COST * padded > len(x) * len(y) * (nx + 1) * (ny + 1):
        grid_y, grid_x = np.meshgrid(y, x, indexing="ij")
        return _at_points(load, dx, dy, depths, poisson, grid_x.ravel(), grid_y.ravel()).reshape(field.shape) / shear
    for y0, count_y, at_y, from_y in lattices_y:
        for x0, count_x, at_x, from_x in lattices_x:
            part_field = _on_lattice(load, dx, dy, depths, poisson, (count_y, count_x), x0, y0)
            field[:, :, at_y[:, None], at_x] = part_field[:, :, from_y[:, None], from_x]
    return field / shear


def _on_lattice(
    load: Array, dx: float, dy: float, depths: Array, poisson: float, shape: tuple[int, int], x0: float, y0: float
) -> Array:
    _, ny, nx = load.shape
    my, mx = shape
    padding = Padding.of((ny, nx), (my, mx))
    transformed = {k: padding.forward(load[k]) for k in range(3) if load[k].any()}
    corner_x = (x0 + dx * (np.arange(nx + mx) - nx + 0.5))[None, :]
    corner_y = (y0 + dy * (np.arange(ny + my) - ny + 0.5))[:, None]
    place = np.ix_(np.arange(1 - ny, my) % padding.shape[0], np.arange(1 - nx, mx) % padding.shape[1])
    field = np.zeros((len(depths), 3, my, mx))
    kernel = np.zeros(padding.shape)
    for plane, depth in zip(field, depths, strict=True):
        spectra: dict[int, ComplexArray] = {}
        for values, uses in _corners(corner_x, corner_y, float(depth), poisson):
            wanted = [(k, component) for k, component in uses if k in transformed]
            if not wanted:
                continue
            kernel[place] = np.diff(np.diff(values, axis=0), axis=1)
            spectrum = padding.spectrum(kernel)
            for k, component in wanted:
                spectra[component] = spectra.get(component, 0) + spectrum * transformed[k]
        for component, spectrum in spectra.items():
            plane[component] = padding.inverse(spectrum)
    return field


def _at_points(load: Array, dx: float, dy: float, depths: Array, poisson: float, x: Array, y: Array) -> Array:
    _, ny, nx = load.shape
    jumps = corner_jumps(load)
    field = np.zeros((len(depths), 3, len(x)))
    for block, corner_x, corner_y in corner_blocks((ny, nx), dx, dy, x, y):
        for plane, depth in zip(field, depths, strict=True):
            for values, uses in _corners(corner_x, corner_y, float(depth), poisson):
                for k, component in uses:
                    plane[component, block] += values.reshape(len(values), -1) @ jumps[k]
    return field


def _corners(x: Array, y: Array, z: float, nu: float) -> Iterator[_Corner]:
    """Functions of the distance to a corner whose alternating sum is the displacement, times the shear modulus."""
    unit, soft = 1 / (4 * math.pi), 1 - 2 * nu
    x2, y2 = x * x + z * z, y * y + z * z
    r = np.sqrt(x2 + y * y)
    # At a corner of the surface every product below vanishes.
    log_y = np.arcsinh(y / np.where(x2 == 0, 1, np.sqrt(x2)))
    log_x = np.arcsinh(x / np.where(y2 == 0, 1, np.sqrt(y2)))
    turn = np.arctan2(x * y, z * r)
    log_r = np.log(np.where(r + z == 0, 1, r + z))
    slope = x * y * ((x * x + y * y) / np.where(r + z == 0, 1, r + z))
    turn_x = np.arctan2(slope, x * x * r + z * y * y)
    turn_y = np.arctan2(slope, y * y * r + z * x * x)
    whole = x * log_y + y * log_x - z * turn
    tilt_x, tilt_y = y * log_r + z * log_y + x * turn_x, x * log_r + z * log_x + y * turn_y
    yield unit * (2 * (1 - nu) * whole + z * turn), ((_P, _Z),)
    yield unit * (-z * log_y - soft * tilt_x), ((_P, _X),)
    yield unit * (-z * log_x - soft * tilt_y), ((_P, _Y),)
    yield unit * (-z * log_y + soft * tilt_x), ((_QX, _Z),)
    yield unit * (-z * log_x + soft * tilt_y), ((_QY, _Z),)
    yield unit * (2 * whole - x * log_y + soft * (x * log_y - z * turn_x)), ((_QX, _X),)
    yield unit * (2 * whole - y * log_x + soft * (y * log_x - z * turn_y)), ((_QY, _Y),)
    yield unit * (-2 * nu * r - soft * z * log_r), ((_QX, _Y), (_QY, _X))
