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
from dataclasses import dataclass
from typing import Any

import numpy as np

from treadload.kernels.arrays import Array
from treadload.kernels.gridding.gridded import Method, on_grid
from treadload.kernels.gridding.lattice import Corner, Kernels, Source, of_corners

COMPONENTS = ("xx", "yy", "zz", "xy", "xz", "yz")
_XX, _YY, _ZZ, _XY, _XZ, _YZ = range(6)
_P, _QX, _QY = range(3)

# Distances below this part of a cell are zero: round-off of coordinates, not geometry.
_SNAP = 1e-9


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
            for values, uses in stress_corners(elementary(corner_x, corner_y, z, dx, dy), poisson):
                for load, component in uses:
                    stress[load, component] += sign_x * sign_y * values
    if is_surface(z, dx, dy):
        inside = _share(x, dx) * _share(y, dy)
        for k, unit in enumerate(np.eye(3)):
            _add_surface_load(stress[k], np.multiply.outer(unit, inside), poisson)
    stress[..., np.broadcast_to(np.isnan(x) | np.isnan(y), shape)] = np.nan
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
    method: Method = "auto",
) -> tuple[Array, str]:
    """Stress on the grid of any coordinates x and y, by the cheapest way, see `kernels.gridding.gridded`.

    load: (3, ny, nx), Pa. dx, dy: cell, m. depths: (nz,), m, >= 0. poisson: Poisson's ratio.
    x: (mx,), y: (my,): coordinates relative to the centre of the first cell, m, in any order.
    method: see `kernels.gridding.gridded.on_grid`. Returns (nz, 6, my, mx), Pa, and the methods used.
    """
    stress, used = on_grid(Source(load, dx, dy, _kernels(dx, dy, poisson), 6), depths, x, y, method)
    add_standing_load(stress, load, dx, dy, depths, poisson, x, y)
    return stress, used


def is_surface(z: Array | float, dx: float, dy: float) -> Any:
    """Whether a depth is the surface."""
    return z <= _SNAP * min(dx, dy)


def add_standing_load(
    stress: Array, load: Array, dx: float, dy: float, depths: Array, poisson: float, x: Array, y: Array
) -> None:
    """Add to stress (nz, 6 or more, my, mx) what the load gives where it stands itself, at depths of the surface."""
    rows = np.flatnonzero(is_surface(depths, dx, dy))
    if not rows.size:
        return
    _, ny, nx = load.shape
    share_x, share_y = _share(x[:, None] - dx * np.arange(nx), dx), _share(y[:, None] - dy * np.arange(ny), dy)
    local = share_y @ load @ share_x.T
    for row in rows:
        _add_surface_load(stress[row], local, poisson)


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


@dataclass(frozen=True)
class Elementary:
    """Functions of the distance x, y, z to a corner, m, that the fields of a rectangle are made of.

    r: R. log_x, log_y: asinh(x / √(y² + z²)), asinh(y / √(x² + z²)). log_r: ln(R + z). turn: atan(x y / z R).
    turn_x, turn_y: atan(x y (R - z) / (x² R + z y²)) and the same with x and y exchanged.
    At the surface z is zero and so is turn: its jump under the load is left to `add_standing_load`.
    """

    x: Array
    y: Array
    z: float
    r: Array
    log_x: Array
    log_y: Array
    log_r: Array
    turn: Array | float
    turn_x: Array
    turn_y: Array


def elementary(x: Array, y: Array, z: float, dx: float, dy: float) -> Elementary:
    """The functions at (x, y, z) from a corner of cells dx by dy, broadcast from x and y."""
    x, y = _snapped(x, dx), _snapped(y, dy)
    surface = is_surface(z, dx, dy)
    if surface:
        z = 0.0
        edge_x, edge_y = np.where(x == 0, _SNAP * dx, np.abs(x)), np.where(y == 0, _SNAP * dy, np.abs(y))
        r = np.hypot(x, y)
        # The same for a lattice of corners: 0.27 of a square cell.
        far = np.where(r == 0, 0.27 * math.sqrt(dx * dy), r)
    else:
        edge_x, edge_y = np.sqrt(x * x + z * z), np.sqrt(y * y + z * z)
        r = np.sqrt(x * x + y * y + z * z)
        far = r + z
    log_x, log_y = np.arcsinh(x / edge_y), np.arcsinh(y / edge_x)
    if surface:
        # Σ ln|k| over k ≠ 0 is that of its integral plus ln 2π: a cut at dx / 2π takes the rest away, on the edge
        # alone; on its line beyond, both of its corners have it.
        cut = math.log(2 * math.pi * _SNAP)
        log_x += np.sign(x) * np.where(y == 0, cut, 0.0)
        log_y += np.sign(y) * np.where(x == 0, cut, 0.0)
    # R - z without cancellation deep below the load.
    slope = x * y * ((x * x + y * y) / far)
    return Elementary(
        x=x,
        y=y,
        z=z,
        r=r,
        log_x=log_x,
        log_y=log_y,
        log_r=np.log(far),
        turn=0.0 if surface else np.arctan2(x * y, z * r),
        turn_x=np.arctan2(slope, x * x * r + z * y * y),
        turn_y=np.arctan2(slope, y * y * r + z * x * x),
    )


def _kernels(dx: float, dy: float, poisson: float) -> Kernels:
    return of_corners(lambda x, y, z: stress_corners(elementary(x, y, z, dx, dy), poisson), dx, dy)


def stress_corners(e: Elementary, nu: float) -> Iterator[Corner]:
    """Functions of the distance to a corner whose alternating sum is the stress of a rectangle.

    Yields each with the (load, component) pairs that use it. At the surface, z → 0+, without the part of the load
    itself, see `add_standing_load`.
    """
    unit, x, y, z = 1 / (2 * math.pi), e.x, e.y, e.z
    turn: Any = e.turn
    log_x, log_y, soft = 2 * unit * e.log_x, 2 * unit * e.log_y, 1 - 2 * nu
    far = e.r + z if z > 0 else np.where(e.r == 0, 1.0, e.r)
    zr: Any = z / e.r if z > 0 else 0.0
    a: Any = 0.0
    b: Any = 0.0
    if z > 0:
        a, b = zr * (x / (x * x + z * z)) * y, zr * x * (y / (y * y + z * z))
    yield unit * (a - 2 * nu * turn - soft * e.turn_x), ((_P, _XX),)
    yield unit * (b - 2 * nu * turn - soft * e.turn_y), ((_P, _YY),)
    yield -unit * (soft * e.log_r + zr), ((_P, _XY),)
    across_x, across_y = unit * (2 * nu + zr) * x / far, unit * (2 * nu + zr) * y / far
    c: Any = 0.0
    d: Any = 0.0
    if z > 0:
        c, d = (unit * z) * zr * (y / (x * x + z * z)), (unit * z) * zr * (x / (y * y + z * z))
        yield c, ((_P, _XZ), (_QX, _ZZ))
        yield d, ((_P, _YZ), (_QY, _ZZ))
        yield -unit * (turn + a + b), ((_P, _ZZ),)
        yield unit * (a - turn), ((_QX, _XZ),)
        yield unit * (b - turn), ((_QY, _YZ),)
        yield -unit * zr, ((_QX, _YZ), (_QY, _XZ))
    yield log_y + across_y - c, ((_QX, _XX),)
    yield log_x + across_x - d, ((_QY, _YY),)
    yield nu * log_y - across_y, ((_QX, _YY),)
    yield nu * log_x - across_x, ((_QY, _XX),)
    yield 0.5 * log_x - across_x, ((_QX, _XY),)
    yield 0.5 * log_y - across_y, ((_QY, _XY),)
