"""Gridded loads on elastic layers: into wavenumbers and out of them as convolutions with kernels of |k| alone.

With q the shear, δ = ∂x q_x + ∂y q_y and p the pressure, the wave frame of `kernels.layers.layered` turned back to x
and y reads

    u_x = A q_x - ∂x φ,   u_y = A q_y - ∂y φ,   φ = C δ + D p,   u_z = E δ + F p,

where A to F are functions of |k|; the forces f_x, f_y, f_z follow with five functions of their own. Each is even
in kx and in ky, so that sines and cosines do not mix: one quadrant serves, in real numbers, and derivatives are
taken by the matrices that lead back to x and y. Strain is the gradient of u, stress follows from strain and f_z.

No lattice of wavenumbers: Gauss panels that shrink towards kx = 0 and ky = 0 see no periodic image.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from treadload.kernels.arrays import Array
from treadload.kernels.gridding.points import Points
from treadload.kernels.layers.wavenumbers import gauss, tabulated

# Errors by a field's largest value, measured: 1e-11 of stress and strain, 1e-9 of displacement.
# Panels start at this over the length of the problem.
_SMALLEST = 1e-7
# Up to this over that length a panel ends at so many times its beginning and has so many points.
_CALM, _STRIDE, _FEW = 0.02, 5.0, 8
# The same among the layers' own lengths: their poles lie off the axis by half their distance from zero.
_RATIO, _SOME = 3.0, 10
# Most radians that half a panel turns, and the points that each takes besides.
_PHASE, _MORE = 24.0, 0.6
# Wavenumbers of a block: keeps a block's fields, some 30 numbers for each, near the cache.
_BLOCK = 100_000


@dataclass(frozen=True, eq=False)
class Cells:
    """Load (3, ny, nx), Pa, on cells of dx by dy, m, the first centred at x0, y0, m.

    order: 1: uniform on each cell. 2: bilinear between centres, falling to zero in one cell around.
    """

    load: Array
    dx: float
    dy: float
    x0: float
    y0: float
    order: int = 1


@dataclass(frozen=True)
class ElasticPlane:
    """One depth to synthesise.

    kernels: k (n,) → (4, 2, n) and (2, n), as one depth of `kernels.layers.layered.Transfer`. shear, poisson: of the
    material there, Pa and 1. limit: largest wavenumber that matters at this depth, 1/m.
    """

    kernels: Callable[[Array], tuple[Array, Array]]
    shear: float
    poisson: float
    limit: float


def rule(limit: float, reach: float, length: float) -> tuple[Array, Array]:
    """Nodes (n,), rising, and weights, 1/m, on (0, limit) for a transform.

    limit: largest wavenumber, 1/m. reach: largest distance between a loaded and an output point along this axis,
    m. length: the largest length in the field, m: the reach or the characteristic length of the layers.
    """
    widest = 2 * _PHASE / max(reach, 1e-12)
    low, nodes, weights = 0.0, [], []
    while low < limit:
        calm = low * length < _CALM
        high = _SMALLEST / length if low == 0 else (_STRIDE if calm else _RATIO) * low
        high = min(limit, high, low + widest)
        count = (_FEW if calm else _SOME) + math.ceil(0.5 * (high - low) * reach * _MORE)
        points, share = _gauss(count)
        nodes.append(0.5 * (high - low) * points + 0.5 * (high + low))
        weights.append(0.5 * (high - low) * share)
        low = high
    return np.concatenate(nodes), np.concatenate(weights)


@lru_cache(maxsize=128)
def _gauss(count: int) -> tuple[Array, Array]:
    points, share = gauss(count)
    return points, share


def synthesise_cells(
    loads: Sequence[Cells],
    planes: Sequence[ElasticPlane],
    x: Array,
    y: Array,
    along: tuple[Array, Array],
    across: tuple[Array, Array],
    at: Points | None = None,
) -> Array:
    """Stress and displacement of elastic layers under gridded loads.

    loads: that add up. planes: (nz) depths. x: (mx,), y: (my,), m, any coordinates. along, across: nodes and
    weights in kx and in ky, see `rule`. at: of the grid of x and y only these points.
    Returns (nz, 9, my, mx): xx, yy, zz, xy, xz, yz in Pa, tension positive, then u_x, u_y, u_z in m, z down. Works
    in blocks of kx; the cost is that of the wavenumbers, whatever the number of cells times points.
    """
    (kx_all, wx_all), (ky_all, wy_all) = along, across
    sheared = any(cells.load[1:].any() for cells in loads)
    smallest = math.hypot(kx_all[0], ky_all[0])
    tables = [tabulated(_radial(plane), smallest, 1.5 * plane.limit) for plane in planes]
    rows = [int(np.searchsorted(ky_all, plane.limit, side="right")) for plane in planes]
    backs = [_back(ky_all[:n], wy_all[:n] / math.pi**2, y).transpose(0, 3, 1, 2) for n in rows]
    sums = np.zeros((len(planes), 9, *((len(y), len(x)) if at is None else at.shape)))
    spectra = [_towards(ky_all[: max(rows)], cells.dy, cells.y0, cells.load.shape[1], cells.order) for cells in loads]
    step = max(1, _BLOCK // max(rows))
    for start in range(0, len(kx_all), step):
        kx, wx = kx_all[start : start + step], wx_all[start : start + step]
        if all(kx[0] > plane.limit for plane in planes):
            break
        load = np.zeros((3, 2, 2, max(rows), len(kx)))
        for cells, narrow in zip(loads, spectra, strict=True):
            wide = _towards(kx, cells.dx, cells.x0, cells.load.shape[2], cells.order)
            for turned, by_x in zip(load.swapaxes(0, 1), np.split(wide, 2, axis=1), strict=True):
                turned += (narrow.T @ (cells.load @ by_x)).reshape(turned.shape)
        part = _divergence(load[1], load[2], kx, ky_all[: max(rows)]) if sheared else None
        out = _back(kx, wx, x)
        for total, plane, table, n, back in zip(sums, planes, tables, rows, backs, strict=True):
            columns = int(np.searchsorted(kx, plane.limit, side="right"))
            if not columns:
                continue
            k = np.hypot(kx[None, :columns], ky_all[:n, None])
            radial = np.ascontiguousarray(np.moveaxis(table(k), -1, 0))
            waves = _waves(load[..., :n, :columns], None if part is None else part[..., :n, :columns], radial)
            _add(total, waves, back.reshape(3, len(y), -1), out[:, :, :columns].reshape(3, -1, len(x)), at)
    return np.stack([_fields(total, plane) for total, plane in zip(sums, planes, strict=True)])


def _radial(plane: ElasticPlane) -> Callable[[Array], Array]:
    """A, C, D, E, F of the displacement, then of the force, as a function of k (n,) → (10, n)."""

    def values(k: Array) -> Array:
        kernel, turned = plane.kernels(k)

        def five(rows: Array, transverse: Array) -> list[Array]:
            ahead, down = rows
            return [transverse, (ahead[0] - transverse) / k**2, ahead[1] / k, down[0] / k, down[1]]

        moved, pushed = np.stack(five(kernel[:2], turned[0])) / k, np.stack(five(kernel[2:], turned[1]))
        return np.concatenate([moved, pushed])

    return values


def _towards(k: Array, width: float, first: float, count: int, order: int) -> Array:
    """Cosine and sine transforms of cells, (count, 2 nk)."""
    turn = np.outer(first + width * np.arange(count), k)
    # numpy's sinc takes half turns.
    share = width * np.sinc(k * width / (2 * math.pi)) ** order
    both: Array = np.concatenate([np.cos(turn) * share, np.sin(turn) * share], axis=1)
    return both


def _back(k: Array, weights: Array, x: Array) -> Array:
    """Matrices (3, 2, nk, mx) from cosine and sine parts to the value at x and its two derivatives."""
    turn = np.outer(k, x)
    weights, k = weights[:, None], k[:, None]
    cosine, sine = np.cos(turn) * weights, np.sin(turn) * weights
    return np.array([[cosine, sine], [-k * sine, k * cosine], [-k * k * cosine, -k * k * sine]])


def _divergence(along: Array, across: Array, kx: Array, ky: Array) -> Array:
    """∂x q_x + ∂y q_y in cosine and sine parts along x and y, (2, 2, nky, nkx), from those of q_x and q_y."""
    result = np.stack([kx * along[1], -kx * along[0]])
    result[:, 0] += ky[:, None] * across[:, 1]
    result[:, 1] -= ky[:, None] * across[:, 0]
    return result


def _waves(load: Array, divergence: Array | None, radial: Array) -> Array:
    """φ and ψ, under shear A q_x and A q_y, then u_z, f_z, then the force's own A q_x, A q_y.

    Returns (4 or 8, 2, 2 nky, nkx): cosine and sine parts along x, then along y.
    """
    pressure, shear_x, shear_y = load
    _, _, rows, count = pressure.shape
    waves = np.empty((4 if divergence is None else 8, 2, 2, rows, count))
    by_pressure = (2, 7, 4, 9)
    if divergence is None:
        np.multiply(pressure, radial[by_pressure, None, None], out=waves)
    else:
        for at, kernel, other in zip((0, 1, 4, 5), by_pressure, (1, 6, 3, 8), strict=True):
            np.multiply(pressure, radial[kernel], out=waves[at])
            waves[at] += divergence * radial[other]
        for at, kernel, shear in ((2, 0, shear_x), (3, 0, shear_y), (6, 5, shear_x), (7, 5, shear_y)):
            np.multiply(shear, radial[kernel], out=waves[at])
    return waves.reshape(len(waves), 2, 2 * rows, count)


def _add(total: Array, waves: Array, back: Array, out: Array, at: Points | None) -> None:
    """Add a block to u_x, u_y, u_z, e_xx, e_yy, 2 e_xy, f_x, f_y, f_z (9, my, mx)."""
    sheared = len(waves) == 8
    product = np.matmul if at is None else at.product

    def lines(derivative: int, count: int) -> list[Array]:
        """The first waves and their derivative on lines of y, (my, 2 nkx) each."""
        return [np.hstack(list(parts)) for parts in back[derivative] @ waves[:count]]

    value, slope, (bend,) = lines(0, len(waves)), lines(1, 4 if sheared else 2), lines(2, 1)
    settle, force = value[-4:-2] if sheared else value[-2:]
    at_value = {1: -slope[0], 2: settle, 4: -bend, 7: -slope[1], 8: force}
    at_slope = {0: -value[0], 5: -2 * slope[0], 6: -value[1]}
    if sheared:
        at_value |= {0: value[2], 1: value[3] - slope[0], 4: slope[3] - bend, 5: slope[2]}
        at_value |= {6: value[6], 7: value[7] - slope[1]}
        at_slope |= {3: value[2], 5: value[3] - 2 * slope[0]}
    for terms, matrix in ((at_value, out[0]), (at_slope, out[1]), ({3: -value[0]}, out[2])):
        total[list(terms)] += product(np.stack(list(terms.values())), matrix)


def _fields(total: Array, plane: ElasticPlane) -> Array:
    nu, double = plane.poisson, 2 * plane.shear
    u_x, u_y, u_z, e_xx, e_yy, g_xy, f_x, f_y, f_z = total
    s_xx = (double * (e_xx + nu * e_yy) - nu * f_z) / (1 - nu)
    s_yy = (double * (e_yy + nu * e_xx) - nu * f_z) / (1 - nu)
    return np.stack([s_xx, s_yy, -f_z, 0.5 * double * g_xy, -f_x, -f_y, u_x, u_y, u_z])
