"""Stress and displacement of a half-space under uniformly loaded rectangles, at the surface and at any depth.

A load is an array (3, ny, nx) of pressure, shear along x and shear along y exerted on the body, Pa, uniform on cells
of dx by dy. Stress is an array (6, ...): xx, yy, zz, xy, xz, yz, tension positive; displacement (3, ...) goes along
x, y and z. z points into the body, so that at z = 0 stress_zz = -pressure and stress_xz = -traction_x.

The field is that of the cells, exactly. Between the surface and half a cell of depth it shows the steps between
them, with a logarithm in the distance to an edge across which shear steps. At the surface this leaves an error O(dx)
at cell centres in xx, yy and xy under smooth shear: in stress_xx -(2/π) ln 2 times the step of traction_x from one
cell to the next. Points halfway between them are better, see `kernels.half_space.corners.at_corners`.

Source: that of `kernels.half_space.corners`.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from treadload.kernels.arrays import Array
from treadload.kernels.gridding.gridded import Method, on_grid
from treadload.kernels.gridding.lattice import Corner, Corners, Indices, Source, of_corners, over_depths
from treadload.kernels.gridding.precorrected import Keeper
from treadload.kernels.half_space.corners import SNAP, at_corners, is_surface, snapped
from treadload.kernels.half_space.upright import Medium, fields_of, horizontal_stress_ratio

_XX, _YY, _ZZ, _XY, _XZ, _YZ = range(6)
_P, _QX, _QY = range(3)
# Components that have x, and y, once among their directions.
_ALONG, _ACROSS = (_XY, _XZ, 6), (_XY, _YZ, 7)
# Mirroring costs a part of what it saves: that so few distances must be left.
_WORTH = 0.75


def fields_on_grid(
    load: Array,
    dx: float,
    dy: float,
    depths: Array,
    shear: float,
    poisson: Medium,
    x: Array,
    y: Array,
    method: Method = "auto",
    *,
    moves: bool = True,
) -> tuple[Array, Array, str]:
    """Stress and displacement on the grid of any coordinates x and y, by the cheapest method.

    load: (3, ny, nx), Pa, or (3, n, ny, nx), several on the same cells. dx, dy: cell, m. depths: (nz,), m, >= 0.
    shear: shear modulus, Pa. poisson: Poisson's ratio, or what stands in its place where the half-space is another
    along z; shear is then that of the horizontal plane. x: (mx,), y: (my,): coordinates relative to the centre of the
    first cell, m, in any order. moves: False leaves the displacement out, zero.
    Returns stress (nz, 6, …, my, mx), Pa, displacement (nz, 3, …, my, mx), m, and the methods, see
    `kernels.gridding.gridded.on_grid`.
    """
    both, used = sums_on_grid(load, dx, dy, depths, np.eye(len(depths)), poisson, x, y, method, moves=moves)
    if not moves:
        return both, np.zeros((len(both), 3, *both.shape[2:])), used
    return both[:, :6], both[:, 6:] / shear, used


def sums_on_grid(
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
    """Sums over depths (rows, 6 or 9, …, my, mx) of stress and, if it moves, displacement times the shear modulus.

    mean: weights (rows, nz) of the depths in each sum. kept: of further calls, see `kernels.gridding.precorrected`.
    The others as in `fields_on_grid`. Returns the methods, too.
    """

    def corners(x: Array, y: Array, z: float) -> Iterator[Corner]:
        deep = not is_surface(z, dx, dy)
        return fields_of(lambda stretch: at_corners(x, y, z, dx, dy, stretch), poisson, deep, moves=moves)

    summed, stand = over_depths(corners, depths, mean)
    source = Source(load, dx, dy, of_corners(_mirrored(summed, dx, dy), dx, dy), 9 if moves else 6)
    slot = None if kept is None else kept.of("uniform", poisson, dx, dy, *depths, mean.tobytes(), moves)
    both, used = on_grid(source, stand, x, y, method, slot)
    _add_standing_load(both, load, dx, dy, mean @ is_surface(depths, dx, dy), poisson, x, y)
    return both, used


def _mirrored(functions: Corners, dx: float, dy: float) -> Corners:
    """The same functions, evaluated on one side of x = 0 and of y = 0 where the corners lie on both alike.

    The field of a cell is even or odd in x by how often x stands among the directions of load and component, and so
    in y. A function of its corners is the other of the two.
    """

    def corners(x: Array, y: Array, z: float) -> Iterator[Corner]:
        if x.ndim == 1:
            yield from functions(x, y, z)
            return
        (half_x, back_x, side_x), (half_y, back_y, side_y) = _one_side(x.ravel(), dx), _one_side(y.ravel(), dy)
        if max(len(half_x) / x.size, len(half_y) / y.size) > _WORTH:
            yield from functions(x, y, z)
            return
        for values, uses in functions(half_x[None], half_y[:, None], z):
            if np.ndim(values):
                load, component = uses[0]
                values = np.take(np.take(values, back_y, axis=0), back_x, axis=1)
                if (load == _QX) == (component in _ALONG):
                    values *= side_x
                if (load == _QY) == (component in _ACROSS):
                    values *= side_y[:, None]
            yield values, uses

    return corners


def _one_side(at: Array, size: float) -> tuple[Array, Indices, Array]:
    """Distinct distances from zero of coordinates, m, the number of each one's, and the side that it lies on, ±1."""
    _, first, back = np.unique(np.round(np.abs(at) / (SNAP * size)), return_index=True, return_inverse=True)
    return np.abs(at[first]), back, np.sign(at)


def _add_standing_load(
    stress: Array, load: Array, dx: float, dy: float, weights: Array, poisson: Medium, x: Array, y: Array
) -> None:
    """Add to stress (nz, 6 or more, my, mx) what the load gives where it stands itself.

    weights: (nz,), of the surface in each row.
    """
    rows = np.flatnonzero(weights)
    if not rows.size:
        return
    ny, nx = load.shape[-2:]
    share_x, share_y = _share(x[:, None] - dx * np.arange(nx), dx), _share(y[:, None] - dy * np.arange(ny), dy)
    at_rest = share_y @ load @ share_x.T
    share = horizontal_stress_ratio(poisson)
    for row in rows:
        local = weights[row] * at_rest
        stress[row, _XX] += share * local[_P]
        stress[row, _YY] += share * local[_P]
        stress[row, _ZZ] -= local[_P]
        stress[row, _XZ] -= local[_QX]
        stress[row, _YZ] -= local[_QY]


def _share(x: Array, dx: float) -> Array:
    """1 inside the interval |x| < dx / 2, one half on its ends, 0 outside."""
    share: Array = 0.5 * (np.sign(snapped(x + dx / 2, dx)) - np.sign(snapped(x - dx / 2, dx)))
    return share
