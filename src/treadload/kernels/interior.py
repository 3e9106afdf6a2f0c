"""Stress of a half-space under uniformly loaded rectangles, at the surface and at any depth.

A load is an array (3, ny, nx) of pressure, shear along x and shear along y exerted on the body, Pa,
uniform on cells of dx by dy. Stress is an array (6, ...) in the order of `COMPONENTS`, tension positive;
z points into the body, so that at z = 0 stress_zz = -pressure and stress_xz = -traction_x.

The field is that of the cells, exactly. Between the surface and half a cell of depth it shows the steps
between them, with a logarithm in the distance to an edge across which shear steps. At the surface this
leaves an error O(dx) at cell centres in xx, yy and xy under smooth shear: in stress_xx -(2/π) ln 2 times
the step of traction_x from one cell to the next. Points halfway between them are better, see below.

Singular points of the surface get finite values: a quantity that jumps takes the mean of its sides, and
ln d at a distance d = 0 is cut at dx / 2π, with which evenly spaced steps sum to the field of a smooth
load to second order, O(dx²).

Source: Love (1929), Phil. Trans. R. Soc. A 228, 377-420; potentials as in Johnson (1985), Contact
Mechanics, section 3.2; written with asinh and atan2 so that no corner loses digits.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from treadload.kernels.arrays import Array, ComplexArray
from treadload.kernels.convolution import Padding

COMPONENTS = ("xx", "yy", "zz", "xy", "xz", "yz")
_XX, _YY, _ZZ, _XY, _XZ, _YZ = range(6)
_P, _QX, _QY = range(3)

# Distances below this part of a cell are zero: round-off of coordinates, not geometry.
_SNAP = 1e-9
# Output coordinates whose place within a cell differs by less than this part of a cell share a lattice.
_SAME_PLACE = 1e-6
# Points times corners evaluated at once: keeps the temporaries of the direct sum in cache.
_BLOCK = 200_000
# Measured: a padded cell of a lattice costs about twice as much as a point-corner pair of the direct sum.
_LATTICE_COST = 2.0

_Indices = NDArray[np.integer[Any]]
_Use = tuple[int, int]
_Corner = tuple[Array, tuple[_Use, ...]]


def rectangle_stress(x: Array, y: Array, z: float, dx: float, dy: float, poisson: float) -> Array:
    """Stress at (x, y, z) under one uniformly loaded rectangle centred at the origin.

    x, y: position relative to the centre of the rectangle, m, broadcast together; NaN gives NaN.
    z: depth, m, >= 0. dx, dy: sides of the rectangle, m. poisson: Poisson's ratio.
    Returns (3, 6, ...): stress component per unit pressure, shear along x and shear along y.
    """
    x, y = np.asarray(x, float), np.asarray(y, float)
    shape = np.broadcast_shapes(x.shape, y.shape)
    stress = np.zeros((3, 6, *shape))
    for sign_x in (1, -1):
        for sign_y in (1, -1):
            corner_x, corner_y = x + sign_x * dx / 2, y + sign_y * dy / 2
            for values, uses in _corners(corner_x, corner_y, z, dx, dy, poisson):
                for load, component in uses:
                    stress[load, component] += sign_x * sign_y * values
    if _is_surface(z, dx, dy):
        inside = _share(x, dx) * _share(y, dy)
        for k, unit in enumerate(np.eye(3)):
            _add_surface_load(stress[k], np.multiply.outer(unit, inside), poisson)
    stress[..., np.broadcast_to(np.isnan(x) | np.isnan(y), shape)] = np.nan
    return stress


def stress_on_lattice(
    load: Array,
    dx: float,
    dy: float,
    depths: Array,
    poisson: float,
    *,
    shape: tuple[int, int] | None = None,
    x0: float = 0.0,
    y0: float = 0.0,
) -> Array:
    """Stress on points spaced like the load's cells, by zero-padded FFT convolution.

    load: (3, ny, nx), Pa. dx, dy: cell, m. depths: (nz,), m, >= 0. poisson: Poisson's ratio.
    shape: (my, mx) of the field; None: as the load. x0, y0: first point minus centre of the first cell, m.
    Returns (nz, 6, my, mx), Pa. Cost per depth: some 15 kernels evaluated once a corner, and their FFTs.
    """
    _, ny, nx = load.shape
    my, mx = (ny, nx) if shape is None else shape
    padding = Padding.of((ny, nx), (my, mx))
    active = [k for k in range(3) if load[k].any()]
    transformed = {k: padding.forward(load[k]) for k in active}
    # Neighbouring offsets share their corners: one more corner than offsets each way.
    corner_x = (x0 + dx * (np.arange(nx + mx) - nx + 0.5))[None, :]
    corner_y = (y0 + dy * (np.arange(ny + my) - ny + 0.5))[:, None]
    place = np.ix_(np.arange(1 - ny, my) % padding.shape[0], np.arange(1 - nx, mx) % padding.shape[1])
    share_x = _share(x0 + dx * (np.arange(mx)[:, None] - np.arange(nx)), dx)
    share_y = _share(y0 + dy * (np.arange(my)[:, None] - np.arange(ny)), dy)

    stress = np.zeros((len(depths), 6, my, mx))
    kernel = np.zeros(padding.shape)
    for field, depth in zip(stress, depths, strict=True):
        spectra: dict[int, ComplexArray] = {}
        for values, uses in _corners(corner_x, corner_y, float(depth), dx, dy, poisson):
            wanted = [(k, component) for k, component in uses if k in transformed]
            if not wanted:
                continue
            kernel[place] = np.diff(np.diff(values, axis=0), axis=1)
            spectrum = padding.spectrum(kernel)
            for k, component in wanted:
                product = spectrum * transformed[k]
                spectra[component] = spectra[component] + product if component in spectra else product
        for component, spectrum in spectra.items():
            field[component] = padding.inverse(spectrum)
        if _is_surface(float(depth), dx, dy):
            _add_surface_load(field, share_y @ load @ share_x.T, poisson)
    return stress


def corner_jumps(load: Array) -> Array:
    """Second differences (3, corners) of a load (3, ny, nx): corners carry it with a quarter of the evaluations."""
    jumps: Array = np.diff(np.diff(np.pad(load, ((0, 0), (1, 1), (1, 1))), axis=1), axis=2).reshape(3, -1)
    return jumps


def corner_blocks(
    shape: tuple[int, int], dx: float, dy: float, x: Array, y: Array
) -> Iterator[tuple[slice, Array, Array]]:
    """Blocks of points with their distances from all corners of (ny, nx) cells: memory does not grow with the points.

    x, y: (n,) position of the points relative to the centre of the first cell, m. Yields the block, then X
    (block, 1, nx + 1) and Y (block, ny + 1, 1), m.
    """
    ny, nx = shape
    edge_x, edge_y = dx * (np.arange(nx + 1) - 0.5), dy * (np.arange(ny + 1) - 0.5)
    step = max(1, _BLOCK // (edge_x.size * edge_y.size))
    for start in range(0, len(x), step):
        block = slice(start, start + step)
        yield block, x[block, None, None] - edge_x[None, None, :], y[block, None, None] - edge_y[None, :, None]


def stress_at_points(load: Array, dx: float, dy: float, depths: Array, poisson: float, x: Array, y: Array) -> Array:
    """Stress at scattered points, by direct summation over the corners of the cells.

    load: (3, ny, nx), Pa. dx, dy: cell, m. depths: (nz,), m, >= 0. poisson: Poisson's ratio.
    x, y: (n,) position of the points relative to the centre of the first cell, m.
    Returns (nz, 6, n), Pa. Works in blocks of points: memory does not grow with their number.
    """
    _, ny, nx = load.shape
    jumps = corner_jumps(load)
    active = [k for k in range(3) if load[k].any()]
    stress = np.zeros((len(depths), 6, len(x)))
    for block, corner_x, corner_y in corner_blocks((ny, nx), dx, dy, x, y):
        for field, depth in zip(stress, depths, strict=True):
            for values, uses in _corners(corner_x, corner_y, float(depth), dx, dy, poisson):
                for k, component in uses:
                    if k in active:
                        field[component, block] += values.reshape(len(values), -1) @ jumps[k]
            if _is_surface(float(depth), dx, dy):
                share_x = _share(x[block, None] - dx * np.arange(nx), dx)
                share_y = _share(y[block, None] - dy * np.arange(ny), dy)
                local = np.einsum("nj,kji,ni->kn", share_y, load, share_x, optimize=True)
                _add_surface_load(field[:, block], local, poisson)
    return stress


def stress_on_grid(
    load: Array,
    dx: float,
    dy: float,
    depths: Array,
    poisson: float,
    x: Array,
    y: Array,
    *,
    method: str = "auto",
) -> tuple[Array, str]:
    """Stress on the grid of any coordinates x and y, by the cheaper of the two ways.

    Coordinates that are a whole number of cells apart form a lattice; a grid twice as fine as the load's
    is four of them. Each goes through `stress_on_lattice`, unless summing directly costs less.

    load: (3, ny, nx), Pa. dx, dy: cell, m. depths: (nz,), m, >= 0. poisson: Poisson's ratio.
    x: (mx,), y: (my,): coordinates relative to the centre of the first cell, m, in any order.
    method: "auto", "fft" or "direct". Returns (nz, 6, my, mx), Pa, and the method used.
    """
    stress = np.zeros((len(depths), 6, len(y), len(x)))
    part_loaded = loaded_part(load)
    if part_loaded is None:
        return stress, "none"
    load, row, column = part_loaded
    x, y = x - dx * column, y - dy * row
    lattices_x, lattices_y = as_lattices(x, dx), as_lattices(y, dy)
    _, ny, nx = load.shape
    if method == "auto":
        padded = sum(nx + count for _, count, _, _ in lattices_x) * sum(ny + count for _, count, _, _ in lattices_y)
        pairs = len(x) * len(y) * (nx + 1) * (ny + 1)
        method = "fft" if _LATTICE_COST * padded <= pairs else "direct"
    if method == "direct":
        grid_y, grid_x = np.meshgrid(y, x, indexing="ij")
        points = stress_at_points(load, dx, dy, depths, poisson, grid_x.ravel(), grid_y.ravel())
        return points.reshape(stress.shape), method
    for y0, count_y, at_y, from_y in lattices_y:
        for x0, count_x, at_x, from_x in lattices_x:
            part = stress_on_lattice(load, dx, dy, depths, poisson, shape=(count_y, count_x), x0=x0, y0=y0)
            stress[:, :, at_y[:, None], at_x] = part[:, :, from_y[:, None], from_x]
    return stress, method


def loaded_part(load: Array) -> tuple[Array, int, int] | None:
    """The load (3, ny, nx) without unloaded margins, its first row and column; None without load."""
    rows, columns = np.flatnonzero(load.any(axis=(0, 2))), np.flatnonzero(load.any(axis=(0, 1)))
    if not len(rows):
        return None
    # Unloaded rows and columns around the footprint do nothing but cost.
    part = load[:, rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    return part, int(rows[0]), int(columns[0])


def as_lattices(x: Array, dx: float) -> list[tuple[float, int, _Indices, _Indices]]:
    """Coordinates as lattices of spacing dx: first point, number of points, indices into x and into the lattice."""
    cells = x / dx
    whole = np.floor(cells + _SAME_PLACE)
    place = cells - whole
    order = np.argsort(place, kind="stable")
    cuts = np.nonzero(np.diff(place[order]) > _SAME_PLACE)[0] + 1
    lattices: list[tuple[float, int, _Indices, _Indices]] = []
    for members in np.split(order, cuts):
        first, last = whole[members].min(), whole[members].max()
        start = dx * (first + place[members].mean())
        lattices.append((float(start), int(last - first) + 1, members, (whole[members] - first).astype(int)))
    return lattices


def _is_surface(z: float, dx: float, dy: float) -> bool:
    return z <= _SNAP * min(dx, dy)


def _snapped(x: Array, dx: float) -> Array:
    return np.where(np.abs(x) < _SNAP * dx, 0.0, x)


def _share(x: Array, dx: float) -> Array:
    """1 inside the interval |x| < dx / 2, one half on its ends, 0 outside."""
    share: Array = 0.5 * (np.sign(_snapped(x + dx / 2, dx)) - np.sign(_snapped(x - dx / 2, dx)))
    return share


def _add_surface_load(stress: Array, load: Array, poisson: float) -> None:
    """Add to stress (6, ...) what the load (3, ...) itself gives where it stands."""
    stress[_XX] -= 2 * poisson * load[_P]
    stress[_YY] -= 2 * poisson * load[_P]
    stress[_ZZ] -= load[_P]
    stress[_XZ] -= load[_QX]
    stress[_YZ] -= load[_QY]


def _corners(x: Array, y: Array, z: float, dx: float, dy: float, poisson: float) -> Iterator[_Corner]:
    """Functions of the distance to a corner whose alternating sum is the stress of a rectangle.

    Yields each function, broadcast from x and y, with the (load, component) pairs that use it.
    """
    x, y = _snapped(x, dx), _snapped(y, dy)
    if _is_surface(z, dx, dy):
        return _surface_corners(x, y, dx, dy, poisson)
    return _interior_corners(x, y, z, poisson)


def _interior_corners(x: Array, y: Array, z: float, nu: float) -> Iterator[_Corner]:
    x2, y2, unit = x * x + z * z, y * y + z * z, 1 / (2 * math.pi)
    r = np.sqrt(x2 + y * y)
    xy, zr, s = x * y, z / r, unit / (r + z)
    log_y, log_x = unit * np.arcsinh(y / np.sqrt(x2)), unit * np.arcsinh(x / np.sqrt(y2))
    turn = unit * np.arctan2(xy, z * r)
    # R - z without cancellation deep below the load.
    slope = xy * ((x * x + y * y) / (r + z))
    turn_x = unit * np.arctan2(slope, x * x * r + z * y * y)
    turn_y = unit * np.arctan2(slope, y * y * r + z * x * x)
    a, b = unit * zr * (x / x2) * y, unit * zr * x * (y / y2)
    yield -2 * nu * turn + a - (1 - 2 * nu) * turn_x, ((_P, _XX),)
    yield -2 * nu * turn + b - (1 - 2 * nu) * turn_y, ((_P, _YY),)
    yield -turn - a - b, ((_P, _ZZ),)
    yield -unit * ((1 - 2 * nu) * np.log(r + z) + zr), ((_P, _XY),)
    yield a - turn, ((_QX, _XZ),)
    yield b - turn, ((_QY, _YZ),)
    yield -unit * zr, ((_QX, _YZ), (_QY, _XZ))
    c, d = unit * z * zr * (y / x2), unit * z * zr * (x / y2)
    yield c, ((_P, _XZ), (_QX, _ZZ))
    yield d, ((_P, _YZ), (_QY, _ZZ))
    ys, xs = y * s, x * s
    yield 2 * log_y + (2 * nu + zr) * ys - c, ((_QX, _XX),)
    yield 2 * log_x + (2 * nu + zr) * xs - d, ((_QY, _YY),)
    yield 2 * nu * log_y - (2 * nu + zr) * ys, ((_QX, _YY),)
    yield 2 * nu * log_x - (2 * nu + zr) * xs, ((_QY, _XX),)
    yield log_x - (2 * nu + zr) * xs, ((_QX, _XY),)
    yield log_y - (2 * nu + zr) * ys, ((_QY, _XY),)


def _surface_corners(x: Array, y: Array, dx: float, dy: float, nu: float) -> Iterator[_Corner]:
    """Limits for z → 0+, without the part of the load itself (`_add_surface_load`)."""
    unit = 1 / (2 * math.pi)
    r = np.hypot(x, y)
    # Σ ln|k| over k ≠ 0 is that of its integral plus ln 2π: the cut on an edge takes the rest away.
    edge_x = np.where(x == 0, dx / (2 * math.pi), np.abs(x))
    edge_y = np.where(y == 0, dy / (2 * math.pi), np.abs(y))
    log_y, log_x = unit * np.arcsinh(y / edge_x), unit * np.arcsinh(x / edge_y)
    far = np.where(r == 0, 1.0, r)
    ys, xs = unit * y / far, unit * x / far
    xy = x * y
    yield -(1 - 2 * nu) * unit * np.arctan2(xy, x * x), ((_P, _XX),)
    yield -(1 - 2 * nu) * unit * np.arctan2(xy, y * y), ((_P, _YY),)
    # The same for a lattice of corners: 0.27 of a square cell.
    corner = 0.27 * math.sqrt(dx * dy)
    yield -(1 - 2 * nu) * unit * np.log(np.where(r == 0, corner, r)), ((_P, _XY),)
    yield 2 * log_y + 2 * nu * ys, ((_QX, _XX),)
    yield 2 * log_x + 2 * nu * xs, ((_QY, _YY),)
    yield 2 * nu * (log_y - ys), ((_QX, _YY),)
    yield 2 * nu * (log_x - xs), ((_QY, _XX),)
    yield log_x - 2 * nu * xs, ((_QX, _XY),)
    yield log_y - 2 * nu * ys, ((_QY, _XY),)
