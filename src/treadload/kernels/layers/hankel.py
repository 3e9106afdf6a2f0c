"""Uniform discs on layers: one integral over wavenumbers for every distance from the disc's axis.

Under a pressure on a disc of radius a the field of a layered body has no angle, and its transforms are those of
Hankel: u_z(r) = a ∫ u_z(k) J0(k r) J1(k a) dk, u_r and stress_rz with J1(k r), and stress_rr + stress_tt and
stress_rr - stress_tt with J0 and J2 = 2 J1(k r) / (k r) - J0. Fields are smooth in r: from a certain number of
distances on they are interpolated, by polynomials on panels that narrow towards the rim. So many discs and many
points share one set of kernels.

Source: Burmister (1945), J. Appl. Phys. 16, 89-94; Sneddon (1951), Fourier Transforms, chapter 10.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.polynomial.chebyshev import chebpts1, chebvander

from treadload.kernels.arrays import Array
from treadload.kernels.gridding.points import Points
from treadload.kernels.layers.wavenumbers import quadrature

# Points of an interpolating panel. The field is singular nearest at a ± i D, D the `clearance`: a panel as wide as
# D next to the rim, or as its distance from the rim, converges like 4.6^-n: 1e-12.
_POINTS = 18
# Distances times wavenumbers of a block: keeps the Bessel functions near the cache.
_BLOCK = 500_000
# Distances that differ by less than this part of the largest are the same.
_SAME = 1e-13


@dataclass(frozen=True)
class Disc:
    """Uniform pressure, Pa, on a disc of a radius, m, centred at x, y, m."""

    radius: float
    pressure: float
    x: float
    y: float


@dataclass(frozen=True)
class AxialPlanes:
    """Depths to compute.

    kernels: k (n,) → (nz, 4, n): k·i u_k, k·u_z, i f_k, f_z under f_z = 1, as in `kernels.layers.layered.Transfer`.
    shear, poisson: (nz,) of the material there, Pa and 1, in the horizontal plane. lift: (nz,) see
    `kernels.layers.layered.Stack.lift_of`; None is isotropy everywhere. limit: (nz,) largest wavenumber that
    matters, 1/m. clearance: m, > 0; every kernel falls at least like exp(-k clearance).
    """

    kernels: Callable[[Array], Array]
    shear: Array
    poisson: Array
    limit: Array
    clearance: float
    lift: Array | None = None


def synthesise_discs(
    discs: Sequence[Disc], planes: AxialPlanes, x: Array, y: Array, length: float, at: Points | None = None
) -> Array:
    """Stress and displacement of a layered body under discs of uniform pressure.

    discs: that add up. x: (mx,), y: (my,), m, any coordinates. length: characteristic length of the layers, m.
    at: of the grid of x and y only these points.
    Returns (nz, 9, my, mx): xx, yy, zz, xy, xz, yz in Pa, tension positive, then u_x, u_y, u_z in m, z down.
    Cost: wavenumbers times distances or times some 20 distances for each doubling of r, whichever is less.
    """
    lines = (x[None, :], y[:, None]) if at is None else (x[None, at.columns], y[None, at.rows])
    across = [(lines[0] - disc.x, lines[1] - disc.y) for disc in discs]
    distance = [np.hypot(*apart) for apart in across]
    result = np.zeros((len(planes.limit), 9, *distance[0].shape))
    farthest = max(float(r.max()) for r in distance)
    sizes = sorted({disc.radius for disc in discs})
    knots = {}
    for radius in sizes:
        r = np.concatenate([r.ravel() for disc, r in zip(discs, distance, strict=True) if disc.radius == radius])
        distinct = np.unique(r)
        distinct = distinct[np.concatenate([[True], np.diff(distinct) > _SAME * farthest])]
        edges = panels(radius, float(distinct[-1]), planes.clearance)
        tabulated = len(distinct) <= _POINTS * (len(edges) - 1)
        knots[radius] = (distinct, None) if tabulated else (_points(edges), edges)
    tables = integrals({radius: nodes for radius, (nodes, _) in knots.items()}, planes, length)
    for disc, (dx, dy), r in zip(discs, across, distance, strict=True):
        nodes, edges_or_none = knots[disc.radius]
        if edges_or_none is None:
            values = tables[disc.radius][..., np.searchsorted(nodes, r, side="right") - 1]
        else:
            values = interpolated(tables[disc.radius], edges_or_none, r)
        _add(result, disc.pressure, values, dx, dy, r, planes)
    return result


def integrals(distances: dict[float, Array], planes: AxialPlanes, length: float) -> dict[float, Array]:
    """Integrals over wavenumbers under unit pressure on discs.

    distances: radius of a disc, m → distances from its axis (n,), m. length: see `synthesise_discs`.
    Returns for each radius (nz, 5, n): of u_z, f_z and k·i u_k with J0(k r), then u_r / r and -stress_rz / r.
    """
    reach = max(radius + float(r.max()) for radius, r in distances.items())
    nodes, weights = quadrature(float(planes.limit.max()), reach, max(length, reach))
    count = len(planes.limit)
    sums: dict[float, Array] = {radius: np.zeros((count, 5, len(r))) for radius, r in distances.items()}
    step = max(64, _BLOCK // max(len(r) for r in distances.values()))
    for start in range(0, len(nodes), step):
        k, weight = nodes[start : start + step], weights[start : start + step]
        kernel = planes.kernels(k) * (k <= planes.limit[:, None, None])
        plain = np.stack([kernel[:, 1] / k, kernel[:, 3], kernel[:, 0]], axis=1).reshape(-1, len(k))
        radial = np.stack([kernel[:, 0], kernel[:, 2] * k], axis=1).reshape(-1, len(k))
        for radius, r in distances.items():
            load = weight * radius * scipy.special.j1(k * radius)
            turn = np.outer(k, r)
            # J1(x) / x, one half on the axis.
            ratio = np.divide(scipy.special.j1(turn), turn, out=np.full_like(turn, 0.5), where=turn > 0)
            sums[radius][:, :3] += ((plain * load) @ scipy.special.j0(turn)).reshape(count, 3, -1)
            sums[radius][:, 3:] += ((radial * load) @ ratio).reshape(count, 2, -1)
    return sums


def panels(radius: float, farthest: float, clearance: float) -> Array:
    """Edges of panels over (0, farthest), as wide as their distance from the rim and at least as the clearance."""
    inwards, outwards = [radius], [radius]
    while inwards[-1] > 0:
        inwards.append(max(0.0, inwards[-1] - max(clearance, radius - inwards[-1])))
    while outwards[-1] < farthest:
        outwards.append(outwards[-1] + max(clearance, outwards[-1] - radius))
    edges = np.array([*inwards[::-1], *outwards[1:]])
    return edges[: max(2, int(np.searchsorted(edges, farthest)) + 1)]


def _points(edges: Array) -> Array:
    low, high = edges[:-1, None], edges[1:, None]
    points: Array = (0.5 * (high - low) * chebpts1(_POINTS) + 0.5 * (high + low)).ravel()
    return points


def interpolated(table: Array, edges: Array, r: Array) -> Array:
    """Values (..., *r.shape) from those at the Chebyshev points (..., n) of panels."""
    flat = r.ravel()
    result = np.empty((*table.shape[:-1], flat.size))
    to_series = np.linalg.inv(chebvander(chebpts1(_POINTS), _POINTS - 1)).T
    panel = np.clip(np.searchsorted(edges, flat, side="right") - 1, 0, len(edges) - 2)
    for number, (low, high) in enumerate(itertools.pairwise(edges)):
        there = np.flatnonzero(panel == number)
        series = table[..., number * _POINTS : (number + 1) * _POINTS] @ to_series
        result[..., there] = series @ chebvander((2 * flat[there] - low - high) / (high - low), _POINTS - 1).T
    return result.reshape(*table.shape[:-1], *r.shape)


def _add(result: Array, pressure: float, values: Array, dx: Array, dy: Array, r: Array, planes: AxialPlanes) -> None:
    """Add one disc's fields (nz, 9, my, mx), turned from its axes r, t to x, y."""
    nu, double = planes.poisson[:, None, None], 2 * planes.shear[:, None, None]
    c, s = np.divide(dx, r, out=np.ones_like(r), where=r > 0), np.divide(dy, r, out=np.zeros_like(r), where=r > 0)
    settle, force, stretch, outward, slant = pressure * np.moveaxis(values, 1, 0)
    lifted = nu if planes.lift is None else planes.lift[:, None, None] * (1 - nu)
    radial = (double * stretch - lifted * force) / (1 - nu) - double * outward
    hoop = (nu * double * stretch - lifted * force) / (1 - nu) + double * outward
    result[:, 0] += c * c * radial + s * s * hoop
    result[:, 1] += s * s * radial + c * c * hoop
    result[:, 2] -= force
    result[:, 3] += c * s * (radial - hoop)
    result[:, 4] -= dx * slant
    result[:, 5] -= dy * slant
    result[:, 6] += dx * outward
    result[:, 7] += dy * outward
    result[:, 8] += settle
