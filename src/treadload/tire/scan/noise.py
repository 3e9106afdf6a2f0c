"""Noise of a scan: how large it is, how far it must be smoothed, and the smoothing."""

from __future__ import annotations

import math

import numpy as np
import scipy
from numpy.typing import NDArray

from treadload.kernels.arrays import Array, BoolArray

Indices = NDArray[np.int64]

BAND = 0.003  # points of the tread lie this near to its envelope, m
FINE = 0.002  # what is nearer together than this may share its error: scanners smooth, m
NEIGHBOURS = 14
FEWEST = 60
MOST_SAMPLES = 20_000
FACET = 0.006  # shorter edges may join points that share their error, m
LEVEL = 0.2  # an edge runs round the tire when it climbs this little across it
# Standard deviation of pressure over the combined modulus that smoothing leaves: 10 kPa at 4 MPa.
ROUGH = 2.5e-3
SLOPE = 0.05  # of ribs and lugs against the envelope of their tread, standard deviation
REACH = 2.5  # of the window, in its standard deviations
MOST_NEIGHBOURS = 150
ROUNDS = 3
CUT = 4.7  # Tukey's constant: 95 % efficiency on normal noise


def unrolled(vertices: Array, outer: float) -> Array:
    """(n, 3) of length along the turn, place across and radius, m, of vertices in the frame of the wheel."""
    turn = np.arctan2(vertices[:, 0], vertices[:, 2])
    return np.stack([outer * turn, vertices[:, 1], np.hypot(vertices[:, 0], vertices[:, 2])], axis=1)


def radial_noise(flat: Array, faces: Indices, tread: BoolArray) -> float:
    """Standard deviation of the error of a scan along the radius, m; NaN when there are too few points.

    flat: (n, 3) unrolled vertices, their heights over the envelope of the tread. faces: (m, 3). tread: (n,) True on
    the tops of ribs and lugs. The smaller of two estimates that the shape of a tread can only raise: residuals of
    planes through the nearest points, 2 mm apart or more, and steps along edges longer than 6 mm that run round the
    tire (which facets leave level). Both are medians, so that walls and single wild points do not count. On white
    noise of 0.1 to 1 mm within 10 %.
    """
    estimates = [
        value for value in (_from_planes(flat, tread), _from_edges(flat, faces, tread)) if math.isfinite(value)
    ]
    return min(estimates, default=math.nan)


def _from_planes(flat: Array, tread: BoolArray) -> float:
    points = flat[tread]
    # One point per box: nearer together they may not be independent.
    box = np.unique(np.floor(points[:, :2] / FINE).astype(np.int64), axis=0, return_index=True)[1]
    points = points[np.sort(box)]
    if len(points) < FEWEST:
        return math.nan
    at = points[:: max(1, len(points) // MOST_SAMPLES)]
    near = points[scipy.spatial.cKDTree(points[:, :2]).query(at[:, :2], k=NEIGHBOURS)[1]]
    across = near[..., :2] - near[..., :2].mean(axis=1, keepdims=True)
    rise = near[..., 2] - near[..., 2].mean(axis=1, keepdims=True)
    spread = np.einsum("nki,nkj->nij", across, across)
    # Points in one line say nothing about the slope across it.
    flatness = np.linalg.eigvalsh(spread)
    usable = flatness[:, 0] > 0.02 * flatness[:, 1]
    if usable.sum() < FEWEST:
        return math.nan
    slope = np.linalg.solve(spread[usable], np.einsum("nki,nk->ni", across[usable], rise[usable])[..., None])[..., 0]
    left = rise[usable] - np.einsum("nki,ni->nk", across[usable], slope)
    free = NEIGHBOURS - 3
    # Median of chi-squared with so many degrees of freedom (Wilson and Hilferty).
    middle = free * (1 - 2 / (9 * free)) ** 3
    return math.sqrt(float(np.median((left**2).sum(axis=1))) / middle)


def _from_edges(flat: Array, faces: Indices, tread: BoolArray) -> float:
    edge = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    edge = edge[tread[edge].all(axis=1)]
    step = flat[edge[:, 1]] - flat[edge[:, 0]]
    along = np.abs(step[:, 0])
    # Beyond half of the turn lies the seam, where the angle starts again.
    level = (np.abs(step[:, 1]) < LEVEL * along) & (along > FACET) & (along < 0.5 * np.ptp(flat[:, 0]))
    rise = step[level, 2]
    if len(rise) < FEWEST:
        return math.nan
    return 1.4826 * float(np.median(np.abs(rise))) / math.sqrt(2)


def apart(flat: Array, tread: BoolArray) -> float:
    """Distance between points of the tread, m: the side of the square that one of them has to itself."""
    points = flat[tread][:, :2]
    if len(points) < FEWEST:
        return math.nan
    at = points[:: max(1, len(points) // MOST_SAMPLES)]
    farthest = scipy.spatial.cKDTree(points).query(at, k=9)[0][:, -1]
    return math.sqrt(math.pi * float(np.median(farthest)) ** 2 / 8)


def smoothing_length(noise: float, spacing: float) -> float:
    """Standard deviation, m, of the Gaussian window that leaves 10 kPa of noise in a pressure at E* = 4 MPa.

    noise: standard deviation, m, of independent points `spacing` m apart. White noise of density σ²a² behind a
    window of length L presses with p = E*|k|/2 per wave: rms(p)/E* = σ a / (4 √π L²).
    """
    return math.sqrt(noise * spacing / (4 * math.sqrt(math.pi) * ROUGH))


def roughness(noise: float, spacing: float, length: float) -> float:
    """rms(p)/E* that noise leaves behind a window of a length; arguments as in smoothing_length."""
    return noise * spacing / (4 * math.sqrt(math.pi) * length**2)


def smoothed(flat: Array, use: BoolArray, length: float, noise: float) -> Array:
    """(n,) radii, m, of the vertices in `use` replaced by planes fitted round them; the others as they are.

    flat: (n, 3) unrolled vertices. length: standard deviation of the Gaussian window, m. noise: m. Points that lie
    further from the plane than noise takes them (Tukey's weights) do not count: edges of ribs and lugs stay.
    """
    out = flat[:, 2].copy()
    points = flat[use]
    if len(points) < NEIGHBOURS:
        return out
    extent = np.ptp(points[:, :2], axis=0)
    dense = math.pi * (REACH * length) ** 2 * len(points) / max(float(extent.prod()), 1e-12)
    sample = points[:: max(1, math.ceil(dense / MOST_NEIGHBOURS))]
    tree = scipy.spatial.cKDTree(sample[:, :2])
    count = min(2 * MOST_NEIGHBOURS, len(sample))
    where = np.flatnonzero(use)
    for start in range(0, len(points), 20_000):
        at = points[start : start + 20_000]
        distance, near = tree.query(at[:, :2], k=count, distance_upper_bound=REACH * length)
        inside = near < len(sample)
        around = sample[np.where(inside, near, 0)]
        weight = np.where(inside, np.exp(-0.5 * (np.where(inside, distance, 0.0) / length) ** 2), 0.0)
        out[where[start : start + len(at)]] = _planes(at, around, weight, max(noise, 1e-5), length)
    return out


def _planes(at: Array, around: Array, weight: Array, noise: float, length: float) -> Array:
    """(m,) height at each place of the robust plane through the points around it."""
    across = (around[..., :2] - at[:, None, :2]) / length
    rows = np.concatenate([np.ones_like(across[..., :1]), across], axis=-1)
    rise = around[..., 2] - at[:, None, 2]
    # The point itself may stand off by noise, so the first window is wider.
    left, width = rise, 1.5 * CUT * noise
    # The steepest slope there is: what too few points, or points on one side, give beyond that is noise.
    prior = (noise / (SLOPE * length)) ** 2
    plane = np.zeros((len(at), 3))
    for _ in range(ROUNDS):
        robust = weight * np.clip(1 - (left / width) ** 2, 0, None) ** 2
        weighted = rows * robust[..., None]
        normal = np.einsum("nki,nkj->nij", weighted, rows)
        normal += np.diag([1e-9, prior, prior])
        plane = np.linalg.solve(normal, np.einsum("nki,nk->ni", weighted, rise)[..., None])[..., 0]
        left, width = rise - np.einsum("nki,ni->nk", rows, plane), CUT * noise
    return np.asarray(at[:, 2] + plane[:, 0], dtype=np.float64)
