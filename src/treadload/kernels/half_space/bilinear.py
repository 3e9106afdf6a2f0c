"""Stress and displacement of a half-space under a load interpolated bilinearly between the centres of its cells.

The load is Σ load[j, i] Λ(x - x_i) Λ(y - y_j) with hats Λ that fall from one at a centre to zero at the next: it
is continuous, ends one cell beyond the outermost centres and has the force of the uniform cells. A hat is the
mean of a box over a cell, so the field is that of uniform cells averaged over a window of one cell:

    K(x, y) = (dx dy)⁻¹ δx² δy² G(x, y, z),   ∂²G/∂x∂y = F,

where δx δy F is the field of a uniform cell and δ are central differences over a cell. F is a sum of a few elementary
functions, G of their integrals, see `kernels.half_space.corners`. Differences of G lose (R / dx)² of the precision at
a distance R: beyond 24 cells the field of the uniform cells is averaged instead, by nine values per direction. Either
way 2e-13 of the cell's load is left, measured in extended precision; in cells a hundred times as long as wide, 1e-11.

Load, signs and units as in `kernels.half_space.interior`; source as in `kernels.half_space.corners`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from treadload.kernels.arrays import Array, ComplexArray, Reals
from treadload.kernels.gridding.gridded import Method, on_grid
from treadload.kernels.gridding.lattice import Cell, Kernels, Source, over_depths
from treadload.kernels.gridding.precorrected import Keeper
from treadload.kernels.half_space.corners import at_corners, at_nodes, is_surface
from treadload.kernels.half_space.upright import Medium, fields_of
from treadload.kernels.layers.wavenumbers import Spectrum, cells_spectrum

# Cells from which on the average of uniform cells replaces differences of G.
_NEAR = 24
# Values on each side of a window that its average takes; exact for polynomials of degree 9.
_SIDE = 4


def bilinear_sums_on_grid(
    load: Array,
    dx: float,
    dy: float,
    depths: Array,
    mean: Array,
    poisson: Medium,
    x: Array,
    y: Array,
    method: Method = "auto",
    *,
    moves: bool = True,
    kept: Keeper | None = None,
) -> tuple[Array, str]:
    """As `kernels.half_space.interior.sums_on_grid`, of such a load."""
    summed, stand = over_depths(hat_kernels(dx, dy, poisson, moves=moves), depths, mean)
    slot = None if kept is None else kept.of("bilinear", poisson, dx, dy, *depths, mean.tobytes(), moves)
    return on_grid(Source(load, dx, dy, summed, 9 if moves else 6, half=1.0), stand, x, y, method, slot)


def bilinear_spectrum(load: Array, dx: float, dy: float, x0: float, y0: float) -> Spectrum:
    """Spectrum of the load: that of uniform cells once more times the transform of a box of one cell.

    load: (3, ny, nx), Pa. dx, dy: cell, m. x0, y0: centre of the first cell, m.
    """
    cells = cells_spectrum(load, dx, dy, x0, y0)

    def spectrum(kx: Array, ky: Array) -> ComplexArray:
        # numpy's sinc takes half turns.
        along, across = np.sinc(kx * dx / (2 * math.pi)), np.sinc(ky * dy / (2 * math.pi))
        result: ComplexArray = cells(kx, ky) * (across[:, None] * along)
        return result

    return spectrum


def hat_kernels(dx: float, dy: float, nu: Medium, *, moves: bool = True) -> Kernels:
    """Fields of one node's hat, times the shear modulus for displacement, see `kernels.gridding.lattice.Kernels`.

    moves: False leaves the displacement out.
    """

    def kernels(first_x: Array, first_y: Array, shape: tuple[int, int], z: float) -> Iterator[Cell]:
        m, n = shape

        def places(before: float, more: int) -> tuple[Array, Array]:
            along, across = dx * (np.arange(n + more) - before), dy * (np.arange(m + more) - before)
            return (first_x[:, None] + along)[None, None], (first_y[:, None] + across)[:, :, None, None]

        x, y = places(0, 0)
        near: NDArray[np.bool_] = x * x + y * y + z * z < (_NEAR * max(dx, dy)) ** 2
        rows, columns = _range(np.any(near, axis=(0, 2, 3))), _range(np.any(near, axis=(0, 1, 2)))
        node_x, node_y = places(1, 2)
        node_x = node_x[..., columns.start : columns.stop + 2]
        node_y = node_y[:, rows.start : rows.stop + 2]
        deep = not is_surface(z, dx, dy)
        close = fields_of(lambda stretch: at_nodes(node_x, node_y, z, dx, dy, stretch), nu, deep, moves=moves)
        if near.all():
            for values, uses in close:
                yield _differences(values, 2) / (dx * dy), uses
            return
        average = _window_average()
        corner_x, corner_y = places(_SIDE + 0.5, 2 * _SIDE + 1)
        far = fields_of(lambda stretch: at_corners(corner_x, corner_y, z, dx, dy, stretch), nu, deep, moves=moves)
        inside = near[:, rows, :, columns]
        for values, uses in far:
            if np.ndim(values):
                cells = _differences(values, 1)
                cells = sum(part * cells[:, k : k + m] for k, part in enumerate(average))
                kernel = sum(part * cells[..., k : k + n] for k, part in enumerate(average))
            else:
                kernel = np.zeros(near.shape)
            if inside.size:
                exact, _ = next(close)
                window = kernel[:, rows, :, columns]
                kernel[:, rows, :, columns] = np.where(inside, _differences(exact, 2) / (dx * dy), window)
            yield kernel, uses

    return kernels


def _range(wanted: NDArray[np.bool_]) -> slice:
    """Smallest slice that holds all True."""
    members = np.flatnonzero(wanted)
    return slice(int(members[0]), int(members[-1]) + 1) if len(members) else slice(0, 0)


def _differences(values: Reals, order: int) -> Array:
    result: Array = np.diff(np.diff(values, order, axis=1), order, axis=3)
    return result


def _window_average() -> Array:
    """Weights of values at -4 … 4 whose sum is the mean over (-1/2, 1/2), exact for polynomials."""
    at, power = np.arange(-_SIDE, _SIDE + 1.0), np.arange(2 * _SIDE + 1)
    moments = np.where(power % 2, 0.0, 0.5**power / (power + 1))
    weights: Array = np.linalg.solve(at[None, :] ** power[:, None], moments)
    return weights
