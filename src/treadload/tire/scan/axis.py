"""The axis of a tire: where a mesh of unknown pose has its axle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from treadload.kernels.arrays import Array

Indices = NDArray[np.int64]

SAMPLES = 80_000
TREAD_FLOOR = 0.94  # cells below this part of the outer radius are sidewall, rim or a hole
ANGLE_CELLS = 72
ROW = 0.01  # height of a cell across the tread over the outer radius
SMOOTHING_NEIGHBOURS = 80


@dataclass(frozen=True)
class Axis:
    """Axis of revolution.

    origin: (3,) a point on it amid the tread. direction: (3,) unit vector. radius: outer radius.
    residual: rms over the angle of the envelope of the tread, robust. arc: rad of the turn that has tread.
    share: part of the surface that is tread. Lengths are in the unit of the points.
    """

    origin: Array
    direction: Array
    radius: float
    residual: float
    arc: float
    share: float


def sample_surface(vertices: Array, faces: Indices, count: int = SAMPLES) -> tuple[Array, Array]:
    """Points spread evenly over a mesh and the normals of their faces.

    vertices: (n, 3). faces: (m, 3) indices. Returns (count, 3) and (count, 3) unit vectors; the same each time.
    """
    corner = vertices[faces]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    area = np.linalg.norm(normal, axis=1)
    total = np.cumsum(area)
    random = np.random.default_rng(0)
    # Stratified, so that no part of the tread is thin by chance.
    pick = (np.arange(count) + random.random(count)) / count
    face = np.minimum(np.searchsorted(total, pick * total[-1]), len(faces) - 1)
    u, v = random.random((2, count))
    fold = u + v > 1
    u[fold], v[fold] = 1 - u[fold], 1 - v[fold]
    a, b, c = corner[face, 0], corner[face, 1], corner[face, 2]
    return a + u[:, None] * (b - a) + v[:, None] * (c - a), normal[face] / area[face, None]


def fit_axis(points: Array, normals: Array) -> Axis:
    """Axis about which the outer envelope of a surface does not depend on the angle.

    points: (n, 3). normals: (n, 3) unit vectors of either sign. Returns the axis, in the unit of the points.
    Starts from the line that the normals meet (Pottmann's linear complex; their sign does not matter) and from
    the principal directions of the normals; refines the best by robust least squares on two tilts and two shifts.
    On a ribbed tread of radius 0.54 m with vertices 2.5 to 5 mm apart the axis is within 0.005° and 0.01 mm for
    0.3 mm noise on the whole turn, 0.06° and 0.4 mm for 2 mm on 120°, 0.1° and 0.4 mm for 1 mm on 60°; with 2 mm
    on 60° it may be wrong altogether.
    """
    middle = points.mean(axis=0)
    size = float(np.linalg.norm(points - middle, axis=1).max())
    scaled = (points - middle) / size
    candidates = _candidates(scaled, normals)
    coarse = [_refine(scaled[::6], origin, direction, rounds=4) for origin, direction in candidates]
    # A wrong axis fits a few cells well: the more of the surface an axis explains the better.
    best = min(coarse, key=lambda axis: (axis.residual + 1e-3) / max(axis.share * axis.arc, 1e-9))
    # A scan of a part of the turn has its points in fewer cells: finer ones make as much of them.
    cells = round(ANGLE_CELLS * min(6.0, 2 * np.pi / max(best.arc, 1e-3)))
    best = _refine(scaled, best.origin, best.direction, rounds=12, cells=cells)
    return Axis(
        middle + size * best.origin, best.direction, size * best.radius, size * best.residual, best.arc, best.share
    )


def across(direction: Array) -> tuple[Array, Array]:
    """Two unit vectors that complete a direction to a right-handed frame (first, direction, second)."""
    helper = np.eye(3)[np.argmin(np.abs(direction))]
    first = np.cross(direction, helper)
    first /= np.linalg.norm(first)
    return first, np.cross(first, direction)


def _candidates(points: Array, normals: Array) -> list[tuple[Array, Array]]:
    sample = points[:: max(1, len(points) // 3000)]
    smooth = _smoothed_normals(points, normals, sample)
    raw = normals[:: max(1, len(points) // 3000)]
    lines = [_meeting_line(sample, raw), _meeting_line(sample, smooth)]
    principal = np.linalg.eigh(smooth.T @ smooth)[1].T[[0, 2]]
    return lines + [(_centre(sample, smooth, direction), direction) for direction in principal]


def _smoothed_normals(points: Array, normals: Array, at: Array) -> Array:
    """Mean direction of the normals near each point, as lines without sign."""
    tree = scipy.spatial.cKDTree(points)
    near = tree.query(at, k=min(SMOOTHING_NEIGHBOURS, len(points)))[1]
    around = normals[near]
    spread = np.einsum("nki,nkj->nij", around, around)
    return np.asarray(np.linalg.eigh(spread)[1][:, :, 2], dtype=np.float64)


def _meeting_line(points: Array, normals: Array) -> tuple[Array, Array]:
    """Line that the normals meet: the velocity of a turn about it, c' + c × p, is square to every normal."""
    rows = np.hstack([np.cross(points, normals), normals])
    weight = np.ones(len(rows))
    direction, moment = np.array([0.0, 1.0, 0.0]), np.zeros(3)
    for _ in range(6):
        matrix = (rows * weight[:, None]).T @ rows
        a, b, d = matrix[:3, :3], matrix[:3, 3:], matrix[3:, 3:]
        inverse = np.linalg.pinv(d)
        reduced = a - b @ inverse @ b.T
        direction = np.linalg.eigh(reduced)[1][:, 0]
        moment = -inverse @ b.T @ direction
        residual = np.abs(rows @ np.concatenate([direction, moment]))
        scale = 1.5 * np.median(residual) + 1e-9
        weight = 1 / (1 + (residual / scale) ** 2)
    return np.cross(direction, moment), direction


def _centre(points: Array, normals: Array, direction: Array) -> Array:
    """Point that the normals meet when looked at along a given direction."""
    first, second = across(direction)
    p = np.stack([points @ first, points @ second], axis=1)
    n = np.stack([normals @ second, -(normals @ first)], axis=1)
    centre = np.linalg.lstsq(n, np.einsum("ij,ij->i", n, p), rcond=None)[0]
    return np.asarray(centre[0] * first + centre[1] * second, dtype=np.float64)


def _refine(points: Array, origin: Array, direction: Array, rounds: int, cells: int = ANGLE_CELLS) -> Axis:
    """Gauss-Newton with Tukey weights on the envelope; the meridian is eliminated row by row."""
    radius = residual = arc = share = 0.0
    for _ in range(rounds):
        first, second = across(direction)
        p = points - origin
        x, y, z = p @ first, p @ direction, p @ second
        r = np.hypot(x, z)
        radius = float(np.quantile(r, 0.98))
        use = r > TREAD_FLOOR * radius
        share = float(use.mean())
        # A tilt about a point far from the tread would be a shift as well.
        shift = float(0.5 * np.sum(np.quantile(y[use], [0.02, 0.98])))
        origin = origin + shift * direction
        x, y, z, r = x[use], y[use] - shift, z[use], r[use]
        keep, row, turn = _envelope(y, np.arctan2(z, x), r, radius, cells)
        x, y, z, r = x[keep], y[keep], z[keep], r[keep]
        arc = len(np.unique(turn)) * 2 * np.pi / cells
        height, slope = _meridian(row, r, ROW * radius)
        tilt = 1 / np.hypot(1, slope)
        error = (r - height) * tilt
        scale = 1.4826 * float(np.median(np.abs(error))) + 1e-7 * radius
        weight = np.clip(1 - (error / (4.7 * scale)) ** 2, 0, None) ** 2
        residual = float(np.sqrt(np.sum(weight * error**2) / max(np.sum(weight), 1e-12)))
        jacobian = np.stack([y * z / r + slope * z, -x * y / r - slope * x, -x / r, -z / r], axis=1) * tilt[:, None]
        jacobian -= _row_means(row, weight, jacobian)[row]
        error = error - _row_means(row, weight, error[:, None])[row, 0]
        root = np.sqrt(weight)[:, None]
        step = np.linalg.lstsq(root * jacobian, -root[:, 0] * error, rcond=1e-8)[0]
        step *= min(1.0, 0.1 / max(float(np.abs(step).max()), 1e-12))
        # Turning the points by +ω is turning the axis by −ω.
        direction = direction - np.cross(step[0] * first + step[1] * second, direction)
        direction /= np.linalg.norm(direction)
        origin = origin + step[2] * first + step[3] * second
        if float(np.abs(step).max()) < 2e-6:
            break
    return Axis(origin, direction, radius, residual, arc, share)


def _envelope(y: Array, angle: Array, r: Array, radius: float, cells: int) -> tuple[Indices, Indices, Indices]:
    """Index of the outer point (90 % quantile) of each cell, its row across and its column round the tire."""
    row = np.floor((y - y.min()) / (ROW * radius)).astype(np.int64)
    turn = np.floor((angle + np.pi) * (cells / (2 * np.pi))).astype(np.int64) % cells
    cell = row * cells + turn
    order = _by_cell_and_height(cell, r)
    start = np.flatnonzero(np.r_[True, np.diff(cell[order]) > 0])
    count = np.diff(np.r_[start, len(order)])
    keep = order[start + np.ceil(0.9 * (count - 1)).astype(np.int64)]
    row = np.unique(row[keep], return_inverse=True)[1]
    return keep, np.asarray(row, dtype=np.int64), turn[keep]


def _by_cell_and_height(cell: Indices, r: Array) -> Indices:
    """Order by cell, then by r: `np.lexsort((r, cell))`, faster by sorting numbers of 16 bits by their digits."""
    rising = np.argsort(r)
    of_cell = cell[rising]
    if of_cell.max() < 2**16:
        of_cell = of_cell.astype(np.uint16)
    return np.asarray(rising[np.argsort(of_cell, kind="stable")], dtype=np.int64)


def _meridian(row: Indices, r: Array, step: float) -> tuple[Array, Array]:
    """Height of the meridian (median of its row) and its slope, at every envelope point."""
    order = _by_cell_and_height(row, r)
    start = np.flatnonzero(np.r_[True, np.diff(row[order]) > 0])
    count = np.diff(np.r_[start, len(order)])
    height = r[order[start + count // 2]]
    slope = np.gradient(height, step) if len(height) > 1 else np.zeros(1)
    return height[row], slope[row]


def _row_means(row: Indices, weight: Array, values: Array) -> Array:
    """(rows, k) weighted means of (n, k) values in each row."""
    rows = int(row.max()) + 1
    total = np.bincount(row, weight, rows) + 1e-12
    return np.stack([np.bincount(row, weight * column, rows) / total for column in values.T], axis=1)
