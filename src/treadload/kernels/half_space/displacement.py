"""Displacement of a half-space under uniformly loaded rectangles, alone and with the stress.

Load, cells and signs as in `kernels.half_space.interior`; displacement (3, ...) along x, y and z, z down, m.

Source: Love (1929), Phil. Trans. R. Soc. A 228, 377-420; Boussinesq's and Cerruti's point loads as in Johnson
(1985), Contact Mechanics, section 3.2, integrated over a rectangle.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from treadload.kernels.arrays import Array
from treadload.kernels.gridding.gridded import Method, on_grid
from treadload.kernels.gridding.lattice import Corner, Source, of_corners
from treadload.kernels.half_space.interior import Elementary, add_standing_load, elementary, stress_corners

_P, _QX, _QY = range(3)


def displacement_on_grid(
    load: Array, dx: float, dy: float, depths: Array, shear: float, poisson: float, x: Array, y: Array
) -> Array:
    """Displacement on the grid of any coordinates x and y, m.

    load: (3, ny, nx), Pa: pressure, shear along x and y on the body. dx, dy: cell, m. depths: (nz,), m, >= 0.
    shear: shear modulus, Pa. poisson: Poisson's ratio. x: (mx,), y: (my,): coordinates relative to the centre
    of the first cell, m. Returns (nz, 3, my, mx), by the cheapest way, see `kernels.gridding.gridded`.
    """

    def corners(x: Array, y: Array, z: float) -> Iterator[Corner]:
        return _displacement_corners(elementary(x, y, z, dx, dy), poisson, 0)

    return on_grid(Source(load, dx, dy, of_corners(corners, dx, dy), 3), depths, x, y)[0] / shear


def fields_on_grid(
    load: Array,
    dx: float,
    dy: float,
    depths: Array,
    shear: float,
    poisson: float,
    x: Array,
    y: Array,
    method: Method = "auto",
) -> tuple[Array, Array, str]:
    """Stress and displacement at once, from the same functions of the corners.

    Arguments as in `displacement_on_grid`. Returns stress (nz, 6, my, mx), Pa, displacement (nz, 3, my, mx), m, and
    the methods, see `kernels.gridding.gridded.on_grid`.
    """

    def corners(x: Array, y: Array, z: float) -> Iterator[Corner]:
        functions = elementary(x, y, z, dx, dy)
        yield from stress_corners(functions, poisson)
        yield from _displacement_corners(functions, poisson, 6)

    fields, used = on_grid(Source(load, dx, dy, of_corners(corners, dx, dy), 9), depths, x, y, method)
    add_standing_load(fields, load, dx, dy, depths, poisson, x, y)
    return fields[:, :6], fields[:, 6:] / shear, used


def _displacement_corners(e: Elementary, nu: float, first: int) -> Iterator[Corner]:
    """Functions of the distance to a corner whose alternating sum is the displacement, times the shear modulus.

    first: number of the component u_x. At a corner of the surface every product vanishes.
    """
    along, across, down = first, first + 1, first + 2
    unit, soft = 1 / (4 * math.pi), 1 - 2 * nu
    x, y, z, turn = e.x, e.y, e.z, e.turn
    x_log_y, y_log_x = x * e.log_y, y * e.log_x
    z_log_y, z_log_x, z_turn = z * e.log_y, z * e.log_x, z * turn
    whole = x_log_y + y_log_x - z_turn
    tilt_x, tilt_y = y * e.log_r + z_log_y + x * e.turn_x, x * e.log_r + z_log_x + y * e.turn_y
    yield unit * (2 * (1 - nu) * whole + z_turn), ((_P, down),)
    yield -unit * (z_log_y + soft * tilt_x), ((_P, along),)
    yield -unit * (z_log_x + soft * tilt_y), ((_P, across),)
    yield unit * (soft * tilt_x - z_log_y), ((_QX, down),)
    yield unit * (soft * tilt_y - z_log_x), ((_QY, down),)
    yield unit * (2 * whole - x_log_y + soft * (x_log_y - z * e.turn_x)), ((_QX, along),)
    yield unit * (2 * whole - y_log_x + soft * (y_log_x - z * e.turn_y)), ((_QY, across),)
    yield -unit * (2 * nu * e.r + soft * z * e.log_r), ((_QX, across), (_QY, along))
