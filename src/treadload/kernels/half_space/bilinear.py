"""Stress and displacement of a half-space under a load interpolated bilinearly between the centres of its cells.

The load is Σ load[j, i] Λ(x - x_i) Λ(y - y_j) with hats Λ that fall from one at a centre to zero at the next: it
is continuous, ends one cell beyond the outermost centres and has the force of the uniform cells. A hat is the
mean of a box over a cell, so the field is that of uniform cells averaged over a window of one cell:

    K(x, y) = (dx dy)⁻¹ δx² δy² G(x, y, z),   ∂²G/∂x∂y = F,

where δx δy F is the field of a uniform cell, see `kernels.half_space.interior`, and δ are central differences over a
cell. F is a sum of a few elementary functions; `_at_nodes` has the integral G of each in closed form, continuous
everywhere, the surface included. Differences of G lose (R / dx)² of the precision at a distance R: beyond 24
cells the field of the uniform cells is averaged instead, by nine values per direction. Either way 2e-13 of the
cell's load is left, measured in extended precision; in cells a hundred times as long as wide, 1e-11.

Source: the integrals G were found as polynomials times the functions of F, exact rational coefficients, and are
held by tests against quadrature. Load, signs and units as in `kernels.half_space.interior`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from treadload.kernels.arrays import Array, ComplexArray
from treadload.kernels.gridding.gridded import Method, on_grid
from treadload.kernels.gridding.lattice import Corner, Kernels, Source
from treadload.kernels.layers.wavenumbers import Spectrum, cells_spectrum

_XX, _YY, _ZZ, _XY, _XZ, _YZ, _UX, _UY, _UZ = range(9)
_P, _QX, _QY = range(3)

# Cells from which on the average of uniform cells replaces differences of G.
_NEAR = 24
# Values on each side of a window that its average takes; exact for polynomials of degree 9.
_SIDE = 4


def bilinear_on_grid(
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
    """Stress and displacement on the grid of any coordinates x and y.

    load: (3, ny, nx), Pa, values at the centres of the cells. dx, dy: cell, m. depths: (nz,), m, >= 0.
    shear: shear modulus, Pa. poisson: Poisson's ratio. x: (mx,), y: (my,): coordinates relative to the centre of
    the first cell, m, in any order.
    Returns stress (nz, 6, my, mx), Pa, displacement (nz, 3, my, mx), m, and the methods, see
    `kernels.gridding.gridded.on_grid`.
    """
    source = Source(load, dx, dy, hat_kernels(dx, dy, poisson), 9, half=1.0)
    fields, used = on_grid(source, depths, x, y, method)
    return fields[:, :6], fields[:, 6:] / shear, used


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


def hat_kernels(dx: float, dy: float, nu: float) -> Kernels:
    """Fields of one node's hat, times the shear modulus for displacement, see `kernels.gridding.lattice.Kernels`."""

    def kernels(first_x: Array, first_y: Array, shape: tuple[int, int], z: float) -> Iterator[Corner]:
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
        close = _combined(_at_nodes(node_x, node_y, z), z, nu)
        if near.all():
            for values, uses in close:
                yield _differences(values, 2) / (dx * dy), uses
            return
        average = _window_average()
        corner_x, corner_y = places(_SIDE + 0.5, 2 * _SIDE + 1)
        far = _combined(_Corners(corner_x, corner_y, z, *_elementary(corner_x, corner_y, z)), z, nu)
        inside = near[:, rows, :, columns]
        for values, uses in far:
            cells = _differences(values, 1)
            cells = sum(part * cells[:, k : k + m] for k, part in enumerate(average))
            kernel = sum(part * cells[..., k : k + n] for k, part in enumerate(average))
            if inside.size:
                exact, _ = next(close)
                window = kernel[:, rows, :, columns]
                kernel[:, rows, :, columns] = np.where(inside, _differences(exact, 2) / (dx * dy), window)
            yield kernel, uses

    return kernels


def _range(wanted: NDArray[np.bool_]) -> slice:
    """Smallest slice that holds all True."""
    found = np.flatnonzero(wanted)
    return slice(int(found[0]), int(found[-1]) + 1) if len(found) else slice(0, 0)


def _differences(values: Array, order: int) -> Array:
    result: Array = np.diff(np.diff(values, order, axis=1), order, axis=3)
    return result


def _window_average() -> Array:
    """Weights of values at -4 … 4 whose sum is the mean over (-1/2, 1/2), exact for polynomials."""
    at, power = np.arange(-_SIDE, _SIDE + 1.0), np.arange(2 * _SIDE + 1)
    moments = np.where(power % 2, 0.0, 0.5**power / (power + 1))
    weights: Array = np.linalg.solve(at[None, :] ** power[:, None], moments)
    return weights


@dataclass(frozen=True)
class _Corners:
    """The functions of the distance x, y, z to a corner that fields are made of.

    r: R. log_x, log_y: asinh(x / √(y² + z²)), asinh(y / √(x² + z²)). log_r: ln(R + z). turn: atan(x y / z R).
    turn_x, turn_y: the angles of `kernels.half_space.interior`. Those below follow from them, evaluated when asked
    for, to keep little in memory; singular points, which lie near and are not used, are finite.
    """

    x: Array
    y: Array
    z: float
    r: Array
    log_x: Array
    log_y: Array
    log_r: Array
    turn: Array
    turn_x: Array
    turn_y: Array

    @property
    def part(self) -> Array:
        return self.z / _not_zero(self.r)

    @property
    def over_x(self) -> Array:
        return self.part * self.y * (self.x / _not_zero(self.x**2 + self.z**2))

    @property
    def over_y(self) -> Array:
        return self.part * self.x * (self.y / _not_zero(self.y**2 + self.z**2))

    @property
    def deep_x(self) -> Array:
        return self.part * self.z * (self.y / _not_zero(self.x**2 + self.z**2))

    @property
    def deep_y(self) -> Array:
        return self.part * self.z * (self.x / _not_zero(self.y**2 + self.z**2))

    @property
    def slope_x(self) -> Array:
        return self.x / _not_zero(self.r + self.z)

    @property
    def slope_y(self) -> Array:
        return self.y / _not_zero(self.r + self.z)

    @property
    def steep_x(self) -> Array:
        return self.part * self.slope_x

    @property
    def steep_y(self) -> Array:
        return self.part * self.slope_y

    @property
    def x_log_y(self) -> Array:
        return self.x * self.log_y

    @property
    def y_log_x(self) -> Array:
        return self.y * self.log_x

    @property
    def tilt_x(self) -> Array:
        return self.y * self.log_r + self.z * self.log_y + self.x * self.turn_x

    @property
    def tilt_y(self) -> Array:
        return self.x * self.log_r + self.z * self.log_x + self.y * self.turn_y


@dataclass(frozen=True)
class _Nodes:
    """Integrals over x and y of the functions of `_Corners`, by their names."""

    r: Array
    log_x: Array
    log_y: Array
    log_r: Array
    turn: Array
    turn_x: Array
    turn_y: Array
    over_x: Array
    over_y: Array
    deep_x: Array
    deep_y: Array
    part: Array
    slope_x: Array
    slope_y: Array
    steep_x: Array
    steep_y: Array
    x_log_y: Array
    y_log_x: Array
    tilt_x: Array
    tilt_y: Array


def _combined(f: _Corners | _Nodes, z: float, nu: float) -> Iterator[Corner]:
    """Stress, and displacement times the shear modulus, from the functions, see `interior`, `displacement`."""
    unit, soft = 1 / (2 * math.pi), 1 - 2 * nu
    yield unit * (f.over_x - 2 * nu * f.turn - soft * f.turn_x), ((_P, _XX),)
    yield unit * (f.over_y - 2 * nu * f.turn - soft * f.turn_y), ((_P, _YY),)
    yield -unit * (f.turn + f.over_x + f.over_y), ((_P, _ZZ),)
    yield -unit * (soft * f.log_r + f.part), ((_P, _XY),)
    yield unit * (f.over_x - f.turn), ((_QX, _XZ),)
    yield unit * (f.over_y - f.turn), ((_QY, _YZ),)
    yield -unit * f.part, ((_QX, _YZ), (_QY, _XZ))
    yield unit * f.deep_x, ((_P, _XZ), (_QX, _ZZ))
    yield unit * f.deep_y, ((_P, _YZ), (_QY, _ZZ))
    across_y, across_x = 2 * nu * f.slope_y + f.steep_y, 2 * nu * f.slope_x + f.steep_x
    yield unit * (2 * f.log_y + across_y - f.deep_x), ((_QX, _XX),)
    yield unit * (2 * f.log_x + across_x - f.deep_y), ((_QY, _YY),)
    yield unit * (2 * nu * f.log_y - across_y), ((_QX, _YY),)
    yield unit * (2 * nu * f.log_x - across_x), ((_QY, _XX),)
    yield unit * (f.log_x - across_x), ((_QX, _XY),)
    yield unit * (f.log_y - across_y), ((_QY, _XY),)

    half, whole = 0.5 * unit, f.x_log_y + f.y_log_x - z * f.turn
    yield half * (2 * (1 - nu) * whole + z * f.turn), ((_P, _UZ),)
    yield -half * (z * f.log_y + soft * f.tilt_x), ((_P, _UX),)
    yield -half * (z * f.log_x + soft * f.tilt_y), ((_P, _UY),)
    yield half * (soft * f.tilt_x - z * f.log_y), ((_QX, _UZ),)
    yield half * (soft * f.tilt_y - z * f.log_x), ((_QY, _UZ),)
    yield half * (2 * whole - f.x_log_y + soft * (f.x_log_y - z * f.turn_x)), ((_QX, _UX),)
    yield half * (2 * whole - f.y_log_x + soft * (f.y_log_x - z * f.turn_y)), ((_QY, _UY),)
    yield -half * (2 * nu * f.r + soft * z * f.log_r), ((_QX, _UY), (_QY, _UX))


def _not_zero(values: Array) -> Array:
    return np.where(values == 0, 1, values)


def _elementary(x: Array, y: Array, z: float) -> tuple[Array, ...]:
    """r, log_x, log_y, log_r, turn, turn_x, turn_y; where a logarithm is infinite it is zero."""
    x2, y2 = x * x + z * z, y * y + z * z
    r = np.sqrt(x2 + y * y)
    log_x = np.arcsinh(x / np.where(y2 == 0, np.inf, np.sqrt(y2)))
    log_y = np.arcsinh(y / np.where(x2 == 0, np.inf, np.sqrt(x2)))
    log_r = np.log(np.where(r + z == 0, 1, r + z))
    turn = np.arctan2(x * y, z * r)
    slope = x * y * ((x * x + y * y) / np.where(r + z == 0, 1, r + z))
    turn_x, turn_y = np.arctan2(slope, x * x * r + z * y * y), np.arctan2(slope, y * y * r + z * x * x)
    return r, log_x, log_y, log_r, turn, turn_x, turn_y


def _at_nodes(x: Array, y: Array, z: float) -> _Nodes:
    """Integrals over x and y of the functions, less what second differences take away."""
    r, log_x, log_y, log_r, turn, turn_x, turn_y = _elementary(x, y, z)
    xx, yy, xy, zz = x * x, y * y, x * y, z * z
    by_y, by_x, over = y * log_y, x * log_x, x * log_y + y * log_x
    flat_x, flat_y = (yy - zz) / 2 * log_x, (xx - zz) / 2 * log_y
    edge_x, edge_y = z * (x * log_r - y * turn_x + y * turn), z * (y * log_r - x * turn_y + x * turn)
    return _Nodes(
        r=xy * r / 3 + x * (zz / 2 + xx / 6) * log_y + y * (zz / 2 + yy / 6) * log_x - z**3 / 3 * turn,
        log_x=xy * log_x + flat_y - x * z * turn - y * r / 2,
        log_y=xy * log_y + flat_x - y * z * turn - x * r / 2,
        log_r=xy * log_r + z * over + (yy - zz) / 2 * turn + (xx - yy) / 2 * turn_x,
        turn=xy * turn + z * (by_y + by_x - r),
        turn_x=xy * turn_x + (yy - xx) / 2 * log_r + z * (by_y - r / 2),
        turn_y=xy * turn_y + (xx - yy) / 2 * log_r + z * (by_x - r / 2),
        over_x=z * (r - by_y),
        over_y=z * (r - by_x),
        deep_x=z * (z * log_x + y * turn),
        deep_y=z * (z * log_y + x * turn),
        part=z * (over - z * turn),
        slope_x=y * r / 2 + flat_y - edge_y,
        slope_y=x * r / 2 + flat_x - edge_x,
        steep_x=zz * log_y + edge_y,
        steep_y=zz * log_x + edge_x,
        x_log_y=(yy / 6 - xx / 3 - zz / 3) * r + y * (xx + zz) / 2 * log_y,
        y_log_x=(xx / 6 - yy / 3 - zz / 3) * r + x * (yy + zz) / 2 * log_x,
        tilt_x=-x * z * r / 3
        + z * (xy * log_y + (yy / 2 - zz / 6) * log_x)
        + x * (yy / 2 - xx / 6) * log_r
        + y * ((yy / 6 - zz / 2) * turn + (xx / 2 - yy / 6) * turn_x),
        tilt_y=-y * z * r / 3
        + z * (xy * log_x + (xx / 2 - zz / 6) * log_y)
        + y * (xx / 2 - yy / 6) * log_r
        + x * ((xx / 6 - zz / 2) * turn + (yy / 2 - xx / 6) * turn_y),
    )
