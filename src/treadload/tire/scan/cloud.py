"""A surface through a cloud of points: the axle is found first, and the tread unrolled about it is a map r(θ, y)."""

from __future__ import annotations

import math

import numpy as np
import scipy
from numpy.typing import NDArray

from treadload.errors import GeometryError
from treadload.kernels.arrays import Array
from treadload.tire.scan.axis import SAMPLES, across, fit_axis

NEIGHBOURS = 12
CELL = 1.5  # side of a cell over the distance between points: two of them in one
MOST_CELLS = 4_000_000
INNERMOST = 0.85  # points below this part of the outer radius are rim, floor or inside
LAYER = 0.03  # over the outer radius: what lies this far under the outer points of a cell is another surface
BRIDGED = 2  # empty cells that lie between known ones on both sides


def mesh_of_points(points: Array, name: str) -> tuple[Array, NDArray[np.int64]]:
    """Vertices (n, 3) and faces (m, 3), in the unit of the cloud, of the tread through points (k, 3).

    The normals of planes through neighbours give the axle (`fit_axis`); each cell of angle and place across then
    takes the median radius of its outer points, at their mean place: points of walls and wild points do not shift it.
    Cells without points stay open where more than two lie side by side; nothing is carried over a hole.
    Raises GeometryError when the points are too few or make no surface.
    """
    count = len(points)
    points = points[_single(points)]
    if len(points) < NEIGHBOURS**2:
        raise GeometryError(
            f"the {count} points of {name!r} are at {len(points)} places, too few for a surface; is it the right "
            "file?"
        )
    sample = points[:: max(1, len(points) // SAMPLES)]
    normals, spacing = _normals(sample, len(points))
    axis = fit_axis(sample, normals)
    first, second = across(axis.direction)
    place = points - axis.origin
    x, y, z = place @ first, place @ axis.direction, place @ second
    r = np.hypot(x, z)
    keep = (r > INNERMOST * axis.radius) & (r < 1.15 * axis.radius) & (np.abs(y) < 0.5 * axis.radius)
    if keep.sum() < NEIGHBOURS**2:
        raise GeometryError(
            f"the {len(points)} points of {name!r} have no tire tread in them; check that the file holds one tire "
            "and nothing else (no rim, ground or fixture)"
        )
    r, y, turn = r[keep], y[keep], np.arctan2(x[keep], z[keep])
    low = float(y.min())
    # Points that are spread over the tread alone are further apart than the samples say, never nearer.
    turn_length = 2 * math.pi * axis.radius
    # The last bounds a tread without width, which has one row.
    cell = max(CELL * spacing, math.sqrt(turn_length * float(np.ptp(y)) / MOST_CELLS), turn_length / MOST_CELLS)
    round_cells = max(36, int(turn_length / cell))
    rows = int(float(np.ptp(y)) / cell) + 1
    column = np.minimum(((turn + math.pi) * (round_cells / (2 * math.pi))).astype(np.int64), round_cells - 1)
    key = ((y - low) / cell).astype(np.int64) * round_cells + column
    grid = _cells(key, r, turn, y, rows * round_cells, LAYER * axis.radius)
    grid = [bridged(part.reshape(rows, round_cells)) for part in grid]
    radius, angle, along = grid
    finite = np.isfinite(radius)
    number = np.cumsum(finite.ravel()).reshape(finite.shape) - 1
    whole, beside = finite[:-1] & finite[1:], np.roll(number, -1, axis=1)
    quad = whole & np.roll(whole, -1, axis=1)
    a, b, c, d = number[:-1][quad], beside[:-1][quad], number[1:][quad], beside[1:][quad]
    faces = np.concatenate([np.stack([a, c, b], axis=1), np.stack([b, c, d], axis=1)])
    radius, angle, along = radius[finite], angle[finite], along[finite]
    vertices = (
        axis.origin
        + np.outer(radius * np.sin(angle), first)
        + np.outer(along, axis.direction)
        + np.outer(radius * np.cos(angle), second)
    )
    return vertices, faces


def _single(points: Array) -> NDArray[np.int64]:
    """Indices of points, each place once, in their order."""
    order = np.lexsort(points.T)
    ordered = points[order]
    fresh = np.r_[True, (ordered[1:] != ordered[:-1]).any(axis=1)]
    return np.sort(order[fresh])


def _normals(sample: Array, count: int) -> tuple[Array, float]:
    """Normals of planes through the neighbours of each of a few points, and the distance between all `count`."""
    distance, near = scipy.spatial.cKDTree(sample).query(sample, k=NEIGHBOURS)
    around = sample[near] - sample[near].mean(axis=1, keepdims=True)
    normal = np.linalg.eigh(np.einsum("nki,nkj->nij", around, around))[1][:, :, 0]
    # A circle round a point up to its farthest neighbour holds them all.
    spacing = math.sqrt(math.pi / NEIGHBOURS) * float(np.median(distance[:, -1])) * math.sqrt(len(sample) / count)
    return np.asarray(normal, dtype=np.float64), spacing


def _cells(key: NDArray[np.int64], r: Array, turn: Array, y: Array, count: int, layer: float) -> list[Array]:
    """Median radius, mean angle and mean place across of the outer points of each cell; NaN without points."""
    order = np.lexsort((r, key))
    key, r, turn, y = key[order], r[order], turn[order], y[order]
    start = np.flatnonzero(np.r_[True, np.diff(key) > 0])
    many = np.diff(np.r_[start, len(key)])
    # The third quarter belongs to the outer surface where two lie over each other, and no wild point reaches it.
    top = r[start + (3 * (many - 1)) // 4]
    outer = r > np.repeat(top, many) - layer
    inside = np.add.reduceat((~outer).astype(np.int64), start)
    left = many - inside
    first = start + inside
    middle = 0.5 * (r[first + (left - 1) // 2] + r[first + left // 2])
    out = [np.full(count, np.nan) for _ in range(3)]
    used = key[start]
    out[0][used] = middle
    out[1][used] = np.add.reduceat(turn * outer, start) / left
    out[2][used] = np.add.reduceat(y * outer, start) / left
    return out


def bridged(field: Array) -> Array:
    """The field (rows, columns) with runs of up to two empty cells along the turn filled from both their ends."""
    finite = np.isfinite(field)
    holes = ~finite
    runs, count = scipy.ndimage.label(holes, structure=[[0, 0, 0], [1, 1, 1], [0, 0, 0]])
    length = np.bincount(runs.ravel(), minlength=count + 1)
    short = holes & (length[runs] <= BRIDGED)
    short[:, 0] = short[:, -1] = False
    row, column = np.nonzero(short)
    columns = np.arange(field.shape[1])
    before = np.maximum.accumulate(np.where(finite, columns, -1), axis=1)[row, column]
    after = np.minimum.accumulate(np.where(finite, columns, field.shape[1])[:, ::-1], axis=1)[:, ::-1][row, column]
    inner = (before >= 0) & (after < field.shape[1])
    row, column, before, after = row[inner], column[inner], before[inner], after[inner]
    share = (column - before) / (after - before)
    out = field.copy()
    out[row, column] = (1 - share) * field[row, before] + share * field[row, after]
    return out
