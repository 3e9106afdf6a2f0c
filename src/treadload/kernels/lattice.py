"""Fields of a gridded load from functions of the distance to the corners of its cells.

The field of a cell is the alternating sum of some functions over its four corners. On points that lie a whole
number of cells apart the sum over all cells is a convolution, by zero-padded FFT; elsewhere it is summed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from treadload.kernels.arrays import Array, ComplexArray

# Output coordinates whose place within a cell differs by less than this part of a cell share a lattice.
_SAME_PLACE = 1e-6
# Points times corners evaluated at once: keeps the temporaries of the direct sum in cache.
_BLOCK = 200_000
# Measured: a padded cell of a lattice costs about twice as much as a point-corner pair of the direct sum.
_LATTICE_COST = 2.0

Indices = NDArray[np.integer[Any]]
Use = tuple[int, int]
Corner = tuple[Array, tuple[Use, ...]]
Corners = Callable[[Array, Array, float], Iterator[Corner]]
"""(x, y, z) from a corner, m → functions, broadcast from x and y, each with the (load, component) pairs it serves."""


def on_lattice(
    load: Array,
    dx: float,
    dy: float,
    depths: Array,
    corners: Corners,
    components: int,
    shape: tuple[int, int],
    x0: float,
    y0: float,
    wanted: tuple[Indices | slice, Indices | slice] = (slice(None), slice(None)),
) -> Array:
    """Fields on points spaced like the cells, by zero-padded FFT convolution.

    load: (3, ny, nx), Pa. dx, dy: cell, m. depths: (nz,), m. corners: see `Corners`. components: how many.
    shape: (my, mx) of the lattice. x0, y0: its first point minus the centre of the first cell, m.
    wanted: its rows and columns to return; all. Returns (nz, components, rows, columns).
    """
    _, ny, nx = load.shape
    my, mx = shape
    high, wide = ny + my - 1, nx + mx - 1
    padded = int(fft.next_fast_len(high)), int(fft.next_fast_len(wide, real=True))
    transformed: dict[int, ComplexArray] = {k: fft.rfft2(load[k], s=padded) for k in range(3) if load[k].any()}
    # Neighbouring offsets share their corners: one more corner than offsets each way.
    corner_x = (x0 + dx * (np.arange(wide + 1) - nx + 0.5))[None, :]
    corner_y = (y0 + dy * (np.arange(high + 1) - ny + 0.5))[:, None]
    # The offsets start at the most negative one; what wraps around lies in the rows and columns before.
    rows, columns = np.arange(ny - 1, high)[wanted[0]], np.arange(nx - 1, wide)[wanted[1]]
    kernel, lines = np.zeros(padded), np.empty((high + 1, wide))
    fields = np.zeros((len(depths), components, len(rows), len(columns)))
    for field, depth in zip(fields, depths, strict=True):
        spectra: dict[int, ComplexArray] = {}
        for values, uses in corners(corner_x, corner_y, float(depth)):
            served = [(k, component) for k, component in uses if k in transformed]
            if not served:
                continue
            np.subtract(values[:, 1:], values[:, :-1], out=lines)
            np.subtract(lines[1:], lines[:-1], out=kernel[:high, :wide])
            spectrum = fft.rfft2(kernel)
            for k, component in served:
                product = spectrum * transformed[k]
                if component in spectra:
                    spectra[component] += product
                else:
                    spectra[component] = product
        for component, spectrum in spectra.items():
            part = fft.ifft(spectrum, axis=0, overwrite_x=True)[rows]
            field[component] = fft.irfft(part, n=padded[1], axis=1)[:, columns]
    return fields


def at_points(
    load: Array, dx: float, dy: float, depths: Array, corners: Corners, components: int, x: Array, y: Array
) -> Array:
    """Fields at scattered points, by direct summation over the corners of the cells.

    x, y: (n,) position of the points relative to the centre of the first cell, m; the rest as in `on_lattice`.
    Returns (nz, components, n). Works in blocks of points: memory does not grow with their number.
    """
    _, ny, nx = load.shape
    # Corners carry second differences of the load: a quarter of the evaluations.
    jumps = np.diff(np.diff(np.pad(load, ((0, 0), (1, 1), (1, 1))), axis=1), axis=2).reshape(3, -1)
    active = {k for k in range(3) if load[k].any()}
    edge_x, edge_y = dx * (np.arange(nx + 1) - 0.5), dy * (np.arange(ny + 1) - 0.5)
    step = max(1, _BLOCK // (edge_x.size * edge_y.size))
    fields = np.zeros((len(depths), components, len(x)))
    for start in range(0, len(x), step):
        block = slice(start, start + step)
        corner_x, corner_y = (
            x[block, None, None] - edge_x[None, None, :],
            y[block, None, None] - edge_y[None, :, None],
        )
        for field, depth in zip(fields, depths, strict=True):
            for values, uses in corners(corner_x, corner_y, float(depth)):
                for k, component in uses:
                    if k in active:
                        field[component, block] += values.reshape(len(values), -1) @ jumps[k]
    return fields


def on_grid(
    load: Array,
    dx: float,
    dy: float,
    depths: Array,
    corners: Corners,
    components: int,
    x: Array,
    y: Array,
    method: str = "auto",
) -> tuple[Array, str]:
    """Fields on the grid of any coordinates x and y, by the cheaper of the two ways.

    Coordinates that are a whole number of cells apart form a lattice; a grid twice as fine as the load's is four
    of them. Each goes through `on_lattice`, unless summing directly costs less.

    x: (mx,), y: (my,): relative to the centre of the first cell, m, in any order. method: "auto", "fft" or
    "direct"; the rest as in `on_lattice`. Returns (nz, components, my, mx) and the method used, "none" without load.
    """
    part = loaded_part(load)
    if part is None:
        return np.zeros((len(depths), components, len(y), len(x))), "none"
    load, row, column = part
    x, y = x - dx * column, y - dy * row
    if method == "auto":
        by_fft, by_sum = _costs(load.shape[1:], dx, dy, x, y)
        method = "fft" if by_fft <= by_sum else "direct"
    if method == "direct":
        grid_y, grid_x = np.meshgrid(y, x, indexing="ij")
        points = at_points(load, dx, dy, depths, corners, components, grid_x.ravel(), grid_y.ravel())
        return points.reshape(len(depths), components, len(y), len(x)), method
    fields = np.zeros((len(depths), components, len(y), len(x)))
    for y0, count_y, at_y, from_y in as_lattices(y, dy):
        for x0, count_x, at_x, from_x in as_lattices(x, dx):
            fields[:, :, at_y[:, None], at_x] = on_lattice(
                load, dx, dy, depths, corners, components, (count_y, count_x), x0, y0, (from_y, from_x)
            )
    return fields, method


def grid_cost(load: Array, dx: float, dy: float, x: Array, y: Array) -> float:
    """Point-corner pairs that cost as much as `on_grid` per depth."""
    part = loaded_part(load)
    return 0.0 if part is None else min(_costs(part[0].shape[1:], dx, dy, x, y))


def _costs(shape: tuple[int, ...], dx: float, dy: float, x: Array, y: Array) -> tuple[float, float]:
    ny, nx = shape
    padded = math.prod(
        sum(cells + count for _, count, _, _ in as_lattices(at, width))
        for cells, at, width in ((nx, x, dx), (ny, y, dy))
    )
    return _LATTICE_COST * padded, len(x) * len(y) * (nx + 1.0) * (ny + 1.0)


def loaded_part(load: Array) -> tuple[Array, int, int] | None:
    """The load (3, ny, nx) without unloaded margins, its first row and column; None without load."""
    rows, columns = np.flatnonzero(load.any(axis=(0, 2))), np.flatnonzero(load.any(axis=(0, 1)))
    if not len(rows):
        return None
    # Unloaded rows and columns around the footprint do nothing but cost.
    part = load[:, rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    return part, int(rows[0]), int(columns[0])


def as_lattices(x: Array, dx: float) -> list[tuple[float, int, Indices, Indices]]:
    """Coordinates as lattices of spacing dx: first point, number of points, indices into x and into the lattice."""
    cells = x / dx
    whole = np.floor(cells + _SAME_PLACE)
    place = cells - whole
    order = np.argsort(place, kind="stable")
    cuts = np.nonzero(np.diff(place[order]) > _SAME_PLACE)[0] + 1
    lattices: list[tuple[float, int, Indices, Indices]] = []
    for members in np.split(order, cuts):
        first, last = whole[members].min(), whole[members].max()
        start = dx * (first + place[members].mean())
        lattices.append((float(start), int(last - first) + 1, members, (whole[members] - first).astype(int)))
    return lattices
