"""Stress of eigenstrain in layers of equal cells, all at once: convolutions along x and y, dense between layers.

    stress = K strain,   strain (6, nz, ny, nx),   layers of any thickness below a free surface.

In the plane K is a convolution, done by transforms of twice the size, so that nothing comes round. Between layers and
components it is a matrix for each wave. Counted with a factor i for xz and yz these matrices are real, as each kernel
is even or odd in x and in y; those of -ky follow by signs. So a quarter of the plane is stored, in real numbers:
(ny + 1) (nx + 1) (6 nz)² of them. Bars that reach back from the front of a cell are half of a bar without ends, which
adds a constant, and a rest that is odd where a cell's field is even, about the front, half a cell away from a centre:
real numbers too, but for a turn by half a cell that all of a wave share.

`cells` has blocks, `track` bars that reach from a cell backwards without end, `endless` bars without ends, whose
fields no longer depend on x.

Source: Liu and Wang (2005), J. Tribol. 127, 5-13, and Zhou, Chen, Keer and Wang (2009), Int. J. Solids Struct. 46,
1343, for cells with transforms; bars are the closed forms with a corner far away.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from treadload.kernels.arrays import Array, BoolArray, Numbers
from treadload.kernels.eigenstrain.averages import NEAR, average
from treadload.kernels.eigenstrain.corners import displacement_kernels, stress_kernels
from treadload.kernels.eigenstrain.potentials import coefficients
from treadload.kernels.fft import (
    cosines,
    cosines_between,
    irfft2,
    next_fast_len,
    rfft,
    rfft2,
    sines,
    sines_between,
)

# Components that are odd in x, and in y: of a tensor, and of a displacement.
_ODD_X, _ODD_Y = (np.array([0, 0, 0, 1, 1, 0], bool), np.array([0, 0, 0, 1, 0, 1], bool))
_MOVED_X, _MOVED_Y = (np.array([1, 0, 0], bool), np.array([0, 1, 0], bool))
# A corner is far away at so many times the size of the grid: the other end adds the inverse square of it.
_FAR = 1e5

Rows = Callable[[int], Array]
"""Number of a depth → kernels (rows, 6, layers, ny, nx) by offset of the point from the cell, from 0 on."""


@dataclass(frozen=True, eq=False)
class Grid:
    """Layers of cells: nx by ny of dx by dy, m, between depths `edges`, (nz + 1,), m, rising from >= 0."""

    nx: int
    ny: int
    dx: float
    dy: float
    edges: Array

    @property
    def depths(self) -> Array:
        """Centres of the layers, (nz,), m."""
        middle: Array = 0.5 * (self.edges[1:] + self.edges[:-1])
        return middle

    @property
    def thickness(self) -> Array:
        """Of the layers, (nz,), m."""
        return np.diff(self.edges)

    @property
    def shape(self) -> tuple[int, int, int]:
        """Layers, rows, columns."""
        return len(self.edges) - 1, self.ny, self.nx

    @property
    def bytes(self) -> int:
        """Of the operator of these cells in double precision; half of it in single."""
        return 8 * (6 * (len(self.edges) - 1)) ** 2 * (self.nx + 1) * (self.ny + 1)


@dataclass(frozen=True, eq=False)
class Operator:
    """A linear map of strain (6, nz, ny, nx) to fields (rows, depths, ny, nx), see this module.

    matrices: (waves along y, along x, rows · depths, 6 nz). phase: the factors of each row and column, which may vary
    with the wave along x, or none: the matrices are complex then. signs: of each row and column at -ky. waves: cells
    of a period along y and x.
    """

    shape: tuple[int, int, int]
    rows: int
    matrices: Any
    phase: tuple[Any, Any] | None
    signs: tuple[Array, Array]
    waves: tuple[int, int]

    @property
    def bytes(self) -> int:
        """Memory that the matrices take."""
        return int(self.matrices.nbytes)

    def __call__(self, strain: Array) -> Array:
        """Fields (rows, depths, ny, nx), Pa or m, of an eigenstrain (6, nz, ny, nx)."""
        _, ny, nx = self.shape
        half = self.waves[0] // 2
        strain = np.asarray(strain, self.matrices.real.dtype).reshape(-1, ny, nx)
        spectrum = rfft2(strain, s=self.waves)
        columns = np.empty((half + 1, spectrum.shape[-1], len(strain), 2), spectrum.dtype)
        columns[..., 0] = np.moveaxis(spectrum[:, : half + 1], 0, -1)
        backwards = -np.arange(half + 1)
        columns[..., 1] = np.moveaxis(spectrum[:, backwards], 0, -1) * self.signs[1]
        if self.phase is None:
            both = self.matrices @ columns
        else:
            columns *= self.phase[1][..., None]
            real = columns.view(self.matrices.dtype).reshape(*columns.shape[:-1], 4)
            both = (self.matrices @ real).view(columns.dtype) / self.phase[0][..., None]
        result = np.empty((both.shape[2], self.waves[0], both.shape[1]), both.dtype)
        result[:, backwards] = np.moveaxis(both[..., 1] * self.signs[0], -1, 0)
        result[:, : half + 1] = np.moveaxis(both[..., 0], -1, 0)
        fields: Array = irfft2(result, s=self.waves)[:, :ny, :nx]
        return fields.reshape(self.rows, -1, ny, nx)


def cells(
    grid: Grid,
    shear: float,
    poisson: float,
    *,
    depths: Array | None = None,
    averaged: bool = False,
    along: int = NEAR,
    surface: bool = True,
    single: bool = False,
) -> Operator:
    """Stress, Pa, at the centres of the cells, or above and below these at other depths, (n,), m.

    Depths are not those of edges between layers; the surface may be one, where no layer begins there. averaged: the
    mean over each cell of the stress of those less than three cells away, which makes K symmetric and negative in the
    product of tensors weighted by the cells' volumes; at their centres only. along: of those less than so many away
    along x; with all of nx the cells add up to the bars of `track`. surface: False for an endless body.
    single: keeps single precision, half the memory and time, an error of 1e-7.
    """
    of = coefficients(poisson)
    x, y = _edges(grid.nx, grid.dx), _edges(grid.ny, grid.dy)[:, None]
    points = grid.depths if depths is None else depths

    def rows(number: int) -> Array:
        kernels = stress_kernels(x, y, points[number], grid.edges, of, _blocks, surface=surface)
        if averaged:
            average(kernels, number, x[: along + 1], y, grid.edges, of, _blocks, (grid.dx, grid.dy), surface=surface)
        layer = int(np.searchsorted(grid.edges, points[number])) - 1
        if 0 <= layer < len(grid.depths):
            kernels[:, :, layer, 0, 0] -= of.inside
        return shear * kernels

    operator = _even(rows, grid, len(points), (_ODD_X, _ODD_Y), single=single)
    if averaged:
        # What quadrature leaves of the symmetry: 1e-5, more at the surface. Solvers want none.
        weights = np.outer([1, 1, 1, 2, 2, 2], grid.thickness).ravel()
        for row in operator.matrices:
            row[:] = 0.5 * (row + np.swapaxes(row * weights[:, None], 1, 2) / weights[:, None])
    return operator


def track(grid: Grid, shear: float, poisson: float, *, averaged: bool = False, single: bool = False) -> Operator:
    """Stress, Pa, of eigenstrain in bars: each reaches from the front of its cell to x = -∞.

    With the increments D(x) that material takes as it comes from the front, at large x, the plastic strain at x is
    the sum of D from there to the front; its stress, the endless track behind the grid included, is track(D).
    averaged: see `cells`.
    """
    of = coefficients(poisson)
    # Points half a cell behind the front of a bar, half a cell ahead of it, and so on; the other end is far away.
    x = np.append(grid.dx * (np.arange(grid.nx + 1) - 0.5), _FAR * _size(grid))
    y = _edges(grid.ny, grid.dy)[:, None]

    def rows(depth: int) -> Array:
        kernels = stress_kernels(x, y, grid.depths[depth], grid.edges, of, _behind)
        if averaged:
            average(kernels, depth, x, y, grid.edges, of, _behind, (grid.dx, grid.dy), surface=True)
        kernels[:, :, depth, 0, :1] -= of.inside[..., None]
        return shear * kernels

    return _bars(rows, grid, single=single)


def endless(grid: Grid, shear: float, poisson: float, *, averaged: bool = False) -> Operator:
    """Stress (6, nz, ny, 1), Pa, of eigenstrain (6, nz, ny, 1) in bars along x without ends; nx is not read."""
    of = coefficients(poisson)
    x, y = _FAR * _size(grid) * np.array([-1.0, 1.0]), _edges(grid.ny, grid.dy)[:, None]

    def rows(depth: int) -> Array:
        kernels = stress_kernels(x, y, grid.depths[depth], grid.edges, of, _blocks)
        if averaged:
            average(kernels, depth, x, y, grid.edges, of, _blocks, (0.0, grid.dy), surface=True)
        kernels[:, :, depth, 0, 0] -= of.inside
        return shear * kernels

    plane = Grid(1, grid.ny, grid.dx, grid.dy, grid.edges)
    return _even(rows, plane, len(grid.depths), (_ODD_X, _ODD_Y))


def moved_by_cells(grid: Grid, poisson: float) -> Operator:
    """Displacement (3, 1, ny, nx), m, of the surface above the centres of the cells."""
    of = coefficients(poisson)
    x, y = _edges(grid.nx, grid.dx), _edges(grid.ny, grid.dy)[:, None]
    return _even(lambda _: displacement_kernels(x, y, grid.edges, of, _blocks), grid, 1, (_MOVED_X, _MOVED_Y))


def moved_by_track(grid: Grid, poisson: float) -> Operator:
    """As `moved_by_cells`, by the bars of `track`."""
    of = coefficients(poisson)
    x, y = _fronts(grid), _edges(grid.ny, grid.dy)[:, None]
    return _any(lambda _: displacement_kernels(x, y, grid.edges, of, _behind), grid, 1, (_MOVED_X, _MOVED_Y))


def moved_by_endless(grid: Grid, poisson: float) -> Operator:
    """Displacement (3, 1, ny, 1), m, by the bars of `endless`."""
    of = coefficients(poisson)
    x, y = _FAR * _size(grid) * np.array([-1.0, 1.0]), _edges(grid.ny, grid.dy)[:, None]
    plane = Grid(1, grid.ny, grid.dx, grid.dy, grid.edges)
    return _even(lambda _: displacement_kernels(x, y, grid.edges, of, _blocks), plane, 1, (_MOVED_X, _MOVED_Y))


def _edges(count: int, size: float) -> Array:
    """Corners of cells at offsets 0 … count - 1, (count + 1,)."""
    return size * (np.arange(count + 1) - 0.5)


def _size(grid: Grid) -> float:
    return max(grid.nx * grid.dx, grid.ny * grid.dy, float(grid.edges[-1]))


def _fronts(grid: Grid) -> Array:
    """Distance of points to the front of a bar at offsets 0, -1, …, 1 - nx, nx - 1, …, 1, and to its end, (2 nx,)."""
    offsets = np.concatenate([-np.arange(grid.nx), np.arange(grid.nx - 1, 0, -1)])
    return np.append(grid.dx * (offsets - 0.5), _FAR * _size(grid))


def _blocks(functions: Array) -> Array:
    result: Array = np.diff(np.diff(functions, axis=-1), axis=-2)
    return result


def _behind(functions: Array) -> Array:
    result: Array = np.diff(functions[..., -1:] - functions[..., :-1], axis=-2)
    return result


def _even(rows: Rows, grid: Grid, depths: int, odd: tuple[BoolArray, BoolArray], *, single: bool = False) -> Operator:
    """Of kernels that are even or odd along both axes: real matrices."""
    _, ny, nx = grid.shape
    ly, lx = next_fast_len(ny), next_fast_len(nx)
    imaginary = odd[0] ^ odd[1], _ODD_X ^ _ODD_Y
    kind = np.float32 if single else np.float64

    odd_x, odd_y = odd[0][:, None] != _ODD_X, odd[1][:, None] != _ODD_Y
    # (-i)² of two odd axes; i (-i) where the row alone counts with i, -i / i where the column does.
    negative = (odd_x & odd_y) | (imaginary[1] & ~imaginary[0][:, None])
    sign = np.where(negative, -1.0, 1.0)[..., None, None, None]

    def transformed(kernels: Array) -> Array:
        result = np.empty((*kernels.shape[:3], ly + 1, lx + 1), kind)
        signed = (sign * kernels).astype(kind)
        for parity in np.ndindex(2, 2):
            # All of one parity along both axes at once.
            where_parity = (odd_y == parity[0]) & (odd_x == parity[1])
            part = (sines if parity[0] else cosines)(signed[where_parity], ly, axis=2)
            result[where_parity] = (sines if parity[1] else cosines)(part, lx, axis=3)
        return result

    matrices = _gathered(rows, transformed, grid, depths, len(odd[0]), (ly + 1, lx + 1), np.dtype(kind))
    factors = np.result_type(kind, np.complex64)
    phase = (
        np.repeat(np.where(imaginary[0], 1j, 1), depths).astype(factors),
        np.repeat(np.where(imaginary[1], 1j, 1), len(grid.depths)).astype(factors),
    )
    signs = _signs(odd[1], depths, grid, kind)
    return Operator(grid.shape, len(odd[0]), matrices, phase, signs, (2 * ly, 2 * lx))


def _bars(rows: Rows, grid: Grid, *, single: bool = False) -> Operator:
    """Of stress at points half a cell behind the front of a bar, half a cell ahead, and so on: real matrices."""
    _, ny, nx = grid.shape
    ly, lx = next_fast_len(ny), next_fast_len(nx)
    kind = np.float32 if single else np.float64
    odd_x, odd_y = _ODD_X[:, None] != _ODD_X, _ODD_Y[:, None] != _ODD_Y
    even = ~odd_x[..., None, None]
    imaginary = _ODD_X ^ _ODD_Y
    sign, constant = (
        np.where(odd, -1.0, 1.0)[..., None, None, None]
        for odd in ((odd_x & odd_y) | (imaginary & ~imaginary[:, None]), _ODD_Y & ~_ODD_Y[:, None])
    )

    def transformed(kernels: Array) -> Array:
        # What is even adds up to the bar without ends; the rest is odd about the front, and the other way round.
        half = 0.5 * even * (kernels[..., 1] + kernels[..., 0])
        result = np.empty((*kernels.shape[:3], ly + 1, lx + 1), kind)
        rest = (kernels[..., 1:] - half[..., None]).astype(kind)
        for parity in np.ndindex(2, 2):
            where_parity = (odd_y == parity[0]) & (odd_x == parity[1])
            part = (
                -cosines_between(rest[where_parity], lx, axis=3)
                if parity[1]
                else sines_between(rest[where_parity], lx, axis=3)
            )
            # Of the longest wave: what all bars add up to, no turn and no factor.
            part[..., 0] = -part[..., 0] if parity[1] else 2 * lx * half[where_parity]
            result[where_parity] = (sines if parity[0] else cosines)(part, ly, axis=2)
        result[..., 1:] *= sign
        result[..., :1] *= constant
        return result

    matrices = _gathered(rows, transformed, grid, len(grid.depths), 6, (ly + 1, lx + 1), np.dtype(kind))
    turn = -1j * np.exp(-0.5j * np.pi * np.arange(lx + 1) / lx)[:, None]
    row, column = np.where(imaginary, 1j, 1) / turn, np.where(imaginary, 1j, 1) * np.ones_like(turn)
    row[0] = column[0] = np.where(_ODD_Y, 1j, 1)
    factors = np.result_type(kind, np.complex64)
    phase = tuple(np.repeat(factors_of, len(grid.depths), axis=-1).astype(factors) for factors_of in (row, column))
    signs = _signs(_ODD_Y, len(grid.depths), grid, kind)
    return Operator(grid.shape, 6, matrices, (phase[0], phase[1]), signs, (2 * ly, 2 * lx))


def _any(rows: Rows, grid: Grid, depths: int, odd: tuple[BoolArray, BoolArray]) -> Operator:
    """Of kernels that are even or odd along y alone, given at offsets 0, -1, … 1 along x: complex matrices."""
    _, ny, nx = grid.shape
    ly, lx = next_fast_len(ny), next_fast_len(nx)

    def transformed(kernels: Array) -> Numbers:
        result = np.empty((*kernels.shape[:3], ly + 1, lx + 1), complex)
        whole = np.zeros((*kernels.shape[2:4], 2 * lx))
        for row, column in np.ndindex(kernels.shape[:2]):
            # Offsets -m stand at 2 lx - m.
            whole[..., -np.arange(nx)] = kernels[row, column][..., :nx]
            whole[..., np.arange(nx - 1, 0, -1)] = kernels[row, column][..., nx:]
            along = rfft(whole, axis=2)
            odd_y = odd[1][row] != _ODD_Y[column]
            turn = sines if odd_y else cosines
            both = turn(along.real, ly, axis=1) + 1j * turn(along.imag, ly, axis=1)
            result[row, column] = -1j * both if odd_y else both
        return result

    matrices = _gathered(rows, transformed, grid, depths, len(odd[0]), (ly + 1, lx + 1), np.dtype(np.complex128))
    signs = _signs(odd[1], depths, grid, np.float64)
    return Operator(grid.shape, len(odd[0]), matrices, None, signs, (2 * ly, 2 * lx))


def _gathered(
    rows: Rows,
    transformed: Callable[[Array], Numbers],
    grid: Grid,
    depths: int,
    count: int,
    waves: tuple[int, int],
    kind: np.dtype[np.generic],
) -> Array:
    """Matrices (waves along y, along x, rows · depths, 6 layers), a depth at a time."""
    layers = len(grid.depths)
    matrices = np.empty((*waves, count, depths, 6, layers), kind)
    for depth in range(depths):
        matrices[:, :, :, depth] = np.moveaxis(transformed(rows(depth)), (3, 4), (0, 1))
    return matrices.reshape(*waves, count * depths, 6 * layers)


def _signs(odd_y: BoolArray, depths: int, grid: Grid, kind: type[np.floating]) -> tuple[Array, Array]:
    return (
        np.repeat(np.where(odd_y, -1, 1), depths).astype(kind),
        np.repeat(np.where(_ODD_Y, -1, 1), len(grid.depths)).astype(kind),
    )
