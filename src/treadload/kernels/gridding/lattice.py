"""Fields of a gridded load from the field of one of its cells.

On points that lie a whole number of cells apart the sum over all cells is a convolution, by zero-padded FFT: a
lattice. Elsewhere it is summed, or interpolated, see `kernels.gridding.precorrected`;
`kernels.gridding.gridded` chooses.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from treadload.kernels import fft
from treadload.kernels.arrays import Array, BoolArray, ComplexArray, Reals

# Output coordinates whose place within a cell differs by less than this part of a cell share a lattice.
_SAME_PLACE = 1e-6
# Fine cells in a coarse one from afar, and how many of these lie at least between a point and the load.
_COARSE, _AFAR = 6, 25
# Lattices whose first points differ by less than this part of a cell are the same.
_KEPT = 1e-9
# Points times cells evaluated at once: keeps the temporaries in cache.
_BLOCK = 17_000
# Share of corners at which the load changes, below which the others are left out of sums.
_SPARSE = 0.9

Indices = NDArray[np.integer[Any]]
Use = tuple[int, int]
Corner = tuple[Reals, tuple[Use, ...]]
Cell = tuple[Array, tuple[Use, ...]]
Corners = Callable[[Array, Array, float], Iterator[Corner]]
"""(x, y, z) from a corner, m → functions, broadcast from x and y, each with the (load, component) pairs it serves.

x and y are a row and a column of a grid, or both (n,), of corners one by one. A plain number stands for a function
that is the same everywhere, of which no cell has a field.
"""
Function = TypeVar("Function", Array, Reals)
OnLattice = Callable[..., Array]
Spectrum = tuple[ComplexArray, tuple[Use, ...]]
"""The transform of the field of one cell, and the (load, component) pairs that it serves."""
Kernels = Callable[[Array, Array, tuple[int, int], float], Iterator[Cell]]
"""(x, y, (m, n), z) → fields of one cell, (b, m, a, n), each with the (load, component) pairs it serves.

Offsets from its centre, m: x[a], x[a] + dx, … n of them, and y[b], y[b] + dy, … m of them.
"""


@dataclass(frozen=True, eq=False)
class Source:
    """A gridded load, or several on the same cells, and the field of its cells.

    load: (3, ny, nx) or (3, n, ny, nx), Pa; fields then are (nz, components, n, my, mx); convolutions are in its
    precision, single or double. dx, dy: cell, m. kernels: see `Kernels`. components: of the
    field. half: of the width of the load of one cell, in cells.
    """

    load: Array
    dx: float
    dy: float
    kernels: Kernels
    components: int
    half: float = 0.5


@dataclass(frozen=True, eq=False)
class _OfCorners:
    """`Kernels` of a uniform cell: the alternating sums of some functions over its four corners."""

    corners: Corners
    dx: float
    dy: float

    def __call__(self, x: Array, y: Array, shape: tuple[int, int], z: float) -> Iterator[Cell]:
        for ends, uses in self.at_corners(x, y, shape, z):
            lines = ends[..., 1:] - ends[..., :-1]
            yield lines[:, 1:] - lines[:, :-1], uses

    def at_corners(self, x: Array, y: Array, shape: tuple[int, int], z: float) -> Iterator[Cell]:
        """The functions at the corners (b, m + 1, a, n + 1) of the cells at these offsets."""
        m, n = shape
        # Neighbouring offsets share their corners: one more corner than offsets each way.
        corner_x = (x[:, None] + self.dx * (np.arange(n + 1) - 0.5)).reshape(1, -1)
        corner_y = (y[:, None] + self.dy * (np.arange(m + 1) - 0.5)).reshape(-1, 1)
        for values, uses in self.corners(corner_x, corner_y, z):
            if isinstance(values, np.ndarray):
                yield values.reshape(len(y), m + 1, len(x), n + 1), uses


def of_corners(corners: Corners, dx: float, dy: float) -> Kernels:
    """Fields of a uniform cell: the alternating sums of some functions over its four corners."""
    return _OfCorners(corners, dx, dy)


def over_depths(
    functions: Callable[..., Iterator[tuple[Function, tuple[Use, ...]]]], depths: Array, mean: Array
) -> tuple[Callable[..., Iterator[tuple[Function, tuple[Use, ...]]]], Array]:
    """`Corners` or `Kernels` whose depths stand for sums over several, and the depths that stand for them.

    depths: (n,), m. mean: weights (rows, n) of each in the sums. Returns as well (rows,), the shallowest of each.
    """
    sums: dict[float, list[tuple[float, float]]] = {}
    stand = []
    for weights in mean:
        levels = [(float(weight), float(depth)) for weight, depth in zip(weights, depths, strict=True) if weight]
        depth = min(depth for _, depth in levels)
        while sums.setdefault(depth, levels) != levels:
            depth = math.nextafter(depth, math.inf)
        stand.append(depth)

    def summed(*at: Array | tuple[int, int] | float) -> Iterator[tuple[Function, tuple[Use, ...]]]:
        *place, z = at
        assert isinstance(z, float)
        if len(sums[z]) == 1 and sums[z][0][0] == 1:
            yield from functions(*at)
            return
        weights, each = zip(*sums[z], strict=True)
        for parts in zip(*(functions(*place, depth) for depth in each), strict=True):
            total = weights[0] * parts[0][0]
            for weight, (values, _) in zip(weights[1:], parts[1:], strict=True):
                total = total + weight * values
            yield total, parts[0][1]

    return summed, np.array(stand)


def loaded(source: Source, x: Array, y: Array) -> tuple[Source, Array, Array] | None:
    """The source without unloaded margins, and the coordinates from its first cell; None without load."""
    load = source.load
    flat = load.reshape(-1, *load.shape[-2:])
    rows, columns = np.flatnonzero(flat.any(axis=(0, 2))), np.flatnonzero(flat.any(axis=(0, 1)))
    if not len(rows):
        return None
    # Unloaded rows and columns around the footprint do nothing but cost.
    part = load[..., rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    return replace(source, load=part), x - source.dx * columns[0], y - source.dy * rows[0]


def by_lattices(source: Source, depths: Array, x: Array, y: Array, near: OnLattice | None = None) -> Array:
    """Fields (nz, components, …, my, mx) on a grid by a convolution for each lattice that its coordinates form.

    depths: (nz,), m. x: (mx,), y: (my,): relative to the centre of the first cell, m, in any order. near: in place of
    `on_lattice`, for lattices of all whose points some are asked.
    """
    ny, nx = source.load.shape[-2:]
    shape = (len(depths), source.components, *source.load.shape[1:-2], len(y), len(x))
    fields = np.zeros(shape, source.load.dtype)
    for y0, count_y, at_y, from_y in as_lattices(y, source.dy, ny):
        for x0, count_x, at_x, from_x in as_lattices(x, source.dx, nx):
            shape, wanted = (count_y, count_x), (from_y, from_x)
            if near is not None:
                part = near(source, depths, shape, x0, y0)[..., from_y[:, None], from_x]
            else:
                way = from_afar if _is_far(source, x0, count_x) else on_lattice
                part = way(source, depths, shape, x0, y0, wanted)
            fields[..., at_y[:, None], at_x] = part
    return fields


def _is_far(source: Source, x0: float, count: int) -> bool:
    """Whether points along x, count of them from x0 on, are so far from the load that coarse cells serve readings."""
    nx = source.load.shape[-1]
    ahead = max(x0 / source.dx - (nx - 1), -(x0 / source.dx + count - 1))
    return source.load.dtype == np.float32 and ahead > _AFAR * _COARSE


def from_afar(
    source: Source,
    depths: Array,
    shape: tuple[int, int],
    x0: float,
    y0: float,
    wanted: tuple[Indices | slice, Indices | slice] = (slice(None), slice(None)),
) -> Array:
    """`on_lattice` where no point is near the load: from coarser cells to coarser points, and between these.

    The load's moments up to the third stay, and the field is as smooth as it is far. Arguments as in `on_lattice`.
    """
    (ny, nx), (my, mx) = source.load.shape[-2:], shape
    (gather_y, first_y), (gather_x, first_x) = _between_coarse(ny), _between_coarse(nx)
    (spread_y, point_y), (spread_x, point_x) = _between_coarse(my), _between_coarse(mx)
    wide, high = _COARSE * source.dx, _COARSE * source.dy

    def kernels(x: Array, y: Array, shape: tuple[int, int], z: float) -> Iterator[Cell]:
        each_y, each_x = (
            at[0] + step * np.arange(n) for at, step, n in zip((y, x), (high, wide), shape, strict=True)
        )
        for values, uses in source.kernels(each_x, each_y, (1, 1), z):
            yield values[:, 0, :, 0][None, :, None], uses

    coarse = replace(source, load=gather_y.T @ source.load @ gather_x, dx=wide, dy=high, kernels=kernels)
    first = x0 + source.dx * (point_x - first_x), y0 + source.dy * (point_y - first_y)
    fields = on_lattice(coarse, depths, (spread_y.shape[1], spread_x.shape[1]), *first)
    return np.asarray(spread_y[wanted[0]] @ fields @ spread_x[wanted[1]].T, source.load.dtype)


@lru_cache(maxsize=64)
def _between_coarse(count: int) -> tuple[Array, float]:
    """Weights (count, n) of coarse points in fine ones by Lagrange's cubics; the first of them, in fine steps."""
    n = math.ceil((count - 1) / _COARSE) + 4
    first = 0.5 * (count - 1) - 0.5 * (n - 1) * _COARSE
    at = (np.arange(count) - first) / _COARSE
    low = np.clip(np.floor(at).astype(int) - 1, 0, n - 4)
    t = at - low
    weights = np.zeros((count, n))
    for k in range(4):
        neighbours = [j for j in range(4) if j != k]
        weights[np.arange(count), low + k] = np.prod([(t - j) / (k - j) for j in neighbours], axis=0)
    return weights, first


def on_lattice(
    source: Source,
    depths: Array,
    shape: tuple[int, int],
    x0: float,
    y0: float,
    wanted: tuple[Indices | slice, Indices | slice] = (slice(None), slice(None)),
    spectra: dict[tuple[object, ...], list[Spectrum]] | None = None,
) -> Array:
    """Fields on points spaced like the cells, by zero-padded FFT convolution.

    shape: (my, mx) of the lattice. x0, y0: its first point minus the centre of the first cell, m.
    wanted: its rows and columns to return; all. spectra: of the kernels, kept for other loads on as many cells.
    Returns (nz, components, …, rows, columns).
    """
    load, dx, dy = source.load, source.dx, source.dy
    ny, nx = load.shape[-2:]
    my, mx = shape
    high, wide = ny + my - 1, nx + mx - 1
    padded = int(fft.next_fast_len(high)), int(fft.next_fast_len(wide, real=True))
    transformed: dict[int, ComplexArray] = {k: fft.rfft2(load[k], s=padded) for k in range(3) if load[k].any()}
    first_x, first_y = np.array([x0 - dx * (nx - 1)]), np.array([y0 - dy * (ny - 1)])
    # The offsets start at the most negative one; what wraps around lies in the rows and columns before.
    rows, columns = np.arange(ny - 1, high)[wanted[0]], np.arange(nx - 1, wide)[wanted[1]]
    fields = np.zeros((len(depths), source.components, *load.shape[1:-2], len(rows), len(columns)), load.dtype)
    for field, depth in zip(fields, depths, strict=True):
        sums: dict[int, ComplexArray] = {}
        key = (float(depth), round(x0 / (_KEPT * dx)), round(y0 / (_KEPT * dy)), load.shape[-2:], shape)
        kernels: Iterable[Spectrum] = (
            (fft.rfft2(values[0, :, 0].astype(load.dtype, copy=False), s=padded), uses)
            for values, uses in source.kernels(first_x, first_y, (high, wide), float(depth))
            if spectra is not None or any(k in transformed for k, _ in uses)
        )
        if spectra is not None:
            if key not in spectra:
                spectra[key] = list(kernels)
            kernels = spectra[key]
        for spectrum, uses in kernels:
            for k, component in uses:
                if k not in transformed:
                    continue
                product = spectrum * transformed[k]
                if component in sums:
                    sums[component] += product
                else:
                    sums[component] = product
        for component, spectrum in sums.items():
            part = fft.ifft(spectrum, axis=-2, overwrite_x=True)[..., rows, :]
            field[component] = fft.irfft(part, n=padded[1], axis=-1)[..., columns]
    return fields


def summed(source: Source, depths: Array, x: Array, y: Array) -> Array:
    """Fields of one load by summing over the cells, arguments as in `by_lattices`; in blocks, to bound memory."""
    dx, dy = source.dx, source.dy
    _, ny, nx = source.load.shape
    # Offsets rise while cells fall.
    turned = {k: source.load[k, ::-1, ::-1] for k in range(3) if source.load[k].any()}
    kernels = source.kernels
    if isinstance(kernels, _OfCorners):
        # The alternating sums are taken of the load, once, in place of all functions.
        turned = {k: np.diff(np.diff(np.pad(load, 1), axis=0), axis=1) for k, load in turned.items()}
        changes = np.any([load != 0 for load in turned.values()], axis=0)
        if turned and changes.mean() < _SPARSE:
            return _summed_where(source, kernels, turned, changes, depths, x, y)
        kernels = kernels.at_corners
    fields = np.zeros((len(depths), source.components, len(y), len(x)))
    for rows, columns in blocks(len(y), len(x), ny * nx):
        first_x, first_y = x[columns] - dx * (nx - 1), y[rows] - dy * (ny - 1)
        for field, depth in zip(fields, depths, strict=True):
            for values, uses in kernels(first_x, first_y, (ny, nx), float(depth)):
                for k, component in uses:
                    if k in turned:
                        field[component, rows, columns] += np.tensordot(values, turned[k], axes=((1, 3), (0, 1)))
    return fields


def _summed_where(
    source: Source,
    kernels: _OfCorners,
    turned: dict[int, Array],
    changes: BoolArray,
    depths: Array,
    x: Array,
    y: Array,
) -> Array:
    """`summed` over the corners at which the load changes. turned, changes: at all corners, (ny + 1, nx + 1)."""
    ny, nx = source.load.shape[-2:]
    row, column = np.nonzero(changes)
    from_x, from_y = source.dx * (column - nx + 0.5), source.dy * (row - ny + 0.5)
    steps = {k: load[changes] for k, load in turned.items()}
    fields = np.zeros((len(depths), source.components, len(y), len(x)))
    for rows, columns in blocks(len(y), len(x), len(row)):
        shape = len(y[rows]), len(x[columns])
        at_x, at_y = np.broadcast_arrays(x[columns][None, :, None] + from_x, y[rows][:, None, None] + from_y)
        for field, depth in zip(fields, depths, strict=True):
            for values, uses in kernels.corners(at_x.ravel(), at_y.ravel(), float(depth)):
                if not isinstance(values, np.ndarray):
                    # A plain number has no sum.
                    continue
                for k, component in uses:
                    if k in steps:
                        field[component, rows, columns] += values.reshape(*shape, -1) @ steps[k]
    return fields


def blocks(rows: int, columns: int, each: int) -> Iterator[tuple[slice, slice]]:
    """Parts of a grid of points whose number times `each` stays in cache."""
    wide = max(1, min(columns, _BLOCK // each))
    high = max(1, _BLOCK // (each * wide))
    for row in range(0, rows, high):
        for column in range(0, columns, wide):
            yield slice(row, row + high), slice(column, column + wide)


def as_lattices(x: Array, dx: float, cells: int) -> list[tuple[float, int, Indices, Indices]]:
    """Coordinates as lattices of spacing dx: first point, number of points, indices into x and into the lattice.

    cells: of the load, along x. Points further apart go onto lattices of their own, which then cost less.
    """
    place, whole, runs = _runs(x, dx, cells)
    lattices: list[tuple[float, int, Indices, Indices]] = []
    for members in np.split(*runs):
        first, last = whole[members].min(), whole[members].max()
        start = dx * (first + place[members].mean())
        lattices.append((float(start), int(last - first) + 1, members, (whole[members] - first).astype(int)))
    return lattices


def padded_cells(x: Array, dx: float, cells: int) -> tuple[int, int]:
    """Cells of the lattices that coordinates form and of the load, of all lattices of `as_lattices`; their number."""
    _, whole, (order, cuts) = _runs(x, dx, cells)
    rising = whole[order]
    counts = rising[np.append(cuts - 1, len(x) - 1)] - rising[np.append(0, cuts)] + 1
    return int(counts.sum()) + cells * len(counts), len(counts)


def _runs(x: Array, dx: float, cells: int) -> tuple[Array, Array, tuple[Indices, Indices]]:
    """Places of coordinates in their cells, their cells, and an order with cuts between what forms a lattice."""
    at = x / dx
    whole = np.floor(at + _SAME_PLACE)
    place = at - whole
    order = np.argsort(place, kind="stable")
    alike = np.append(0, np.cumsum(np.diff(place[order]) > _SAME_PLACE))
    rising = np.lexsort((whole[order], alike))
    order, alike = order[rising], alike[rising]
    apart = (np.diff(alike) > 0) | (np.diff(whole[order]) > cells + 1)
    return place, whole, (order, np.flatnonzero(apart) + 1)
