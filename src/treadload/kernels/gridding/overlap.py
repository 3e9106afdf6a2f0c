"""Means of a field of rectangular cells over other cells, which may lie askew: exact by area, so that sums stay."""

from __future__ import annotations

import numpy as np

from treadload.kernels.arrays import Array

# Angles, rad, below which cells lie straight: 0.3 µm over a metre.
STRAIGHT = 3e-7
# Share of a cell below which an overlap is round-off.
_NOTHING = 1e-11
# Overlaps that are worked out at once.
_AT_ONCE = 2_000_000


def overlaps(first: Array, second: Array) -> Array:
    """Lengths (m, n) that m cells share with n others on a line. first: edges (m + 1,), second: edges (n + 1,)."""
    low = np.maximum(first[:-1, None], second[None, :-1])
    high = np.minimum(first[1:, None], second[None, 1:])
    shared: Array = np.maximum(high - low, 0.0)
    return shared


def means_over_faces(
    values: Array, x_edges: Array, y_edges: Array, x: Array, y: Array, face: tuple[float, float]
) -> Array:
    """Means (my, mx) of a field over rectangles of sides `face` along x and y, m, with centres at x (mx,), y (my,).

    values, x_edges, y_edges: as in `means_over_cells`. Rectangles may overlap, and need not cover the field.
    """
    along, across = (
        np.maximum(
            np.minimum(edges[1:], at[:, None] + 0.5 * side) - np.maximum(edges[:-1], at[:, None] - 0.5 * side), 0.0
        )
        for edges, at, side in ((x_edges, x, face[0]), (y_edges, y, face[1]))
    )
    means: Array = across @ values @ along.T / (face[0] * face[1])
    return means


def means_over_cells(
    values: Array, x_edges: Array, y_edges: Array, cell_x: Array, cell_y: Array, angle: float = 0.0
) -> Array:
    """Means (my, mx) of a field over the cells between the edges cell_x (mx + 1,), cell_y (my + 1,).

    values: (ny, nx), uniform between x_edges (nx + 1,) and y_edges (ny + 1,), all of one length; zero beyond them.
    angle: rad; the point (x, y) of the cells lies at (x cos - y sin, x sin + y cos) of the field. The integral over
    all cells is that of the field where they cover it, to round-off.
    """
    if abs(angle) < STRAIGHT:
        across, along = overlaps(cell_y, y_edges), overlaps(cell_x, x_edges)
        area = np.outer(np.diff(cell_y), np.diff(cell_x))
        means: Array = across @ values @ along.T / area
        return means
    rows, columns = np.nonzero(values)
    if not rows.size:
        return np.zeros((len(cell_y) - 1, len(cell_x) - 1))
    values = values[rows.min() : rows.max() + 1, columns.min() : columns.max() + 1]
    x_edges, y_edges = x_edges[columns.min() : columns.max() + 2], y_edges[rows.min() : rows.max() + 2]
    return _askew(values, x_edges, y_edges, cell_x, cell_y, angle)


def _askew(values: Array, x_edges: Array, y_edges: Array, cell_x: Array, cell_y: Array, angle: float) -> Array:
    cos, sin = np.cos(angle), np.sin(angle)
    dx, dy = (x_edges[-1] - x_edges[0]) / (len(x_edges) - 1), (y_edges[-1] - y_edges[0]) / (len(y_edges) - 1)
    wide, high = float(np.diff(cell_x).mean()), float(np.diff(cell_y).mean())
    middle_x, middle_y = (a.ravel() for a in np.meshgrid(*(0.5 * (e[1:] + e[:-1]) for e in (cell_x, cell_y))))
    centre_x, centre_y = middle_x * cos - middle_y * sin, middle_x * sin + middle_y * cos
    # Corners about the centre, anticlockwise in (x, y).
    corner_x, corner_y = 0.5 * wide * np.array([-1, 1, 1, -1]), 0.5 * high * np.array([-1, -1, 1, 1])
    corners = np.stack([corner_x * cos - corner_y * sin, corner_x * sin + corner_y * cos])
    reach_x, reach_y = np.abs(corners).max(axis=1)
    near = (
        (centre_x > x_edges[0] - reach_x) & (centre_x < x_edges[-1] + reach_x)
        & (centre_y > y_edges[0] - reach_y) & (centre_y < y_edges[-1] + reach_y)
    )  # fmt: skip
    means = np.zeros(centre_x.size)
    first_x = np.floor((centre_x - reach_x - x_edges[0]) / dx).astype(int)
    first_y = np.floor((centre_y - reach_y - y_edges[0]) / dy).astype(int)
    count_x, count_y = int(2 * reach_x / dx) + 2, int(2 * reach_y / dy) + 2
    padded = np.pad(values, ((count_y, count_y), (count_x, count_x)))
    chosen = np.nonzero(near)[0]
    step = max(1, _AT_ONCE // (4 * count_x * count_y))
    for start in range(0, chosen.size, step):
        part = chosen[start : start + step]
        i = first_x[part, None] + np.arange(count_x)
        j = first_y[part, None] + np.arange(count_y)
        # Relative to the centre, so that no digits are lost.
        left = x_edges[0] + i * dx - centre_x[part, None]
        low = y_edges[0] + j * dy - centre_y[part, None]
        shares = _areas(corners, left, left + dx, low, low + dy)
        shares[shares < _NOTHING * wide * high] = 0.0
        inside = (np.clip(j + count_y, 0, padded.shape[0] - 1), np.clip(i + count_x, 0, padded.shape[1] - 1))
        there = padded[inside[0][:, :, None], inside[1][:, None, :]]
        means[part] = (shares * there).sum(axis=(1, 2)) / (wide * high)
    return means.reshape(len(cell_y) - 1, len(cell_x) - 1)


def _areas(corners: Array, left: Array, right: Array, low: Array, high: Array) -> Array:
    """Areas (t, ky, kx) that a convex polygon shares with rectangles.

    corners: (2, n), anticlockwise. left, right: (t, kx), low, high: (t, ky). By Green's theorem the area is the
    integral along the polygon, within the rectangle's height, of how far x lies right of its left side, at most its
    width.
    """
    left, right = left[:, None, :], right[:, None, :]
    low, high = low[:, :, None], high[:, :, None]
    area = np.zeros(np.broadcast_shapes(left.shape, low.shape))
    for (xa, ya), (xb, yb) in zip(corners.T, np.roll(corners, -1, axis=1).T, strict=True):
        if ya == yb:
            continue
        begin, end = _between(ya, low, high), _between(yb, low, high)
        slope = (xb - xa) / (yb - ya)
        area += (end - begin) * _ramp(xa + (begin - ya) * slope, xa + (end - ya) * slope, left, right)
    return area


def _ramp(a: Array, b: Array, left: Array, right: Array) -> Array:
    """Mean, over x between a and b, of how far x lies right of `left`, at most that of `right`."""
    first, last = np.minimum(a, b), np.maximum(a, b)
    begin, end = _between(first, left, right), _between(last, left, right)
    length = last - first
    beyond = np.maximum(last - np.maximum(first, right), 0.0)
    safe = np.where(length > 0, length, 1.0)
    mean = ((0.5 * (begin + end) - left) * (end - begin) + (right - left) * beyond) / safe
    ramp: Array = np.where(length > 0, mean, _between(0.5 * (first + last), left, right) - left)
    return ramp


def _between(values: Array | float, low: Array, high: Array) -> Array:
    # Half the time of numpy's clip.
    kept: Array = np.minimum(np.maximum(values, low), high)
    return kept
