"""Rows of cells on the faces of ribs: which belong to a rib, what part of it they stand for, and the gap there.

Pressure ends on the rounded edges of a rib, where it sinks in by what the rib is pressed together, and is largest
just inside. A row that meets this end stands for the part of the face inside of it, and the gap of a row is the mean
over its part, on which a uniform pressure works: so thirds of a rib and pins at its edges depend little on where rows
lie.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from treadload.grid import Grid
from treadload.kernels.arrays import Array, BoolArray, IntArray
from treadload.tire.grooves import rounding_start
from treadload.tire.ribs import Band, RibGroup
from treadload.tire.tread import TreadProfile

# A row of which less than this part lies on a face leaves it to the next row of the rib.
_LEAST = 0.2
# How deep rounded edges sink in, over the height of the rib: by a truck's pressure of 0.8 MPa on ribs of 5.5 MPa,
# which are 3.2 times as stiff as that where friction holds them.
_SUNK = 0.04
# Places at which the gap of a row is taken, over its part of the face.
_PLACES = 8
_SAME = 1e-9


@dataclass(frozen=True)
class FaceRows:
    """Rows on the face of a rib. rows: their numbers (n,). parts: (n, 2), ends of what they stand for, m."""

    rows: IntArray
    parts: Array

    def without(self, row: int) -> FaceRows:
        """The rows without the first or the last, whose part goes to the next."""
        kept = self.rows != row
        parts = self.parts[kept]
        if len(parts):
            parts[0, 0], parts[-1, 1] = self.parts[0, 0], self.parts[-1, 1]
        return FaceRows(self.rows[kept], parts)


def rows_on_faces(y: Array, dy: float, bands: Sequence[Band]) -> list[FaceRows]:
    """Rows of every face, none of them on two: it is of the face on which more of it lies, the left one of equals.

    y: middles of the rows (ny,), m, dy apart. bands: of every face, from left to right.
    A row carries the force of a whole cell, however much of it lies on the face.
    """
    faces = [_on_face(y, dy, band) for band in bands]
    for number in range(len(faces) - 1):
        left, right = faces[number], faces[number + 1]
        if left.rows.size and right.rows.size and left.rows[-1] == right.rows[0]:
            row = int(right.rows[0])
            if np.ptp(left.parts[-1]) >= np.ptp(right.parts[0]) * (1 - _SAME):
                faces[number + 1] = right.without(row)
            else:
                faces[number] = left.without(row)
    return faces


def _on_face(y: Array, dy: float, band: Band) -> FaceRows:
    left, low, high, right = band
    start, end = y - 0.5 * dy, y + 0.5 * dy

    def between(first: float, last: float) -> tuple[Array, BoolArray]:
        parts = np.stack([np.maximum(start, first), np.minimum(end, last)], axis=1)
        return parts, parts[:, 1] - parts[:, 0] >= _LEAST * dy * (1 - _SAME)

    parts, on = between(low, high)
    pressed = np.flatnonzero(on)
    if pressed.size:
        parts[pressed[0], 0], parts[pressed[-1], 1] = low, high
    for first, last in ((left, low), (high, right)):
        rim, on_rim = between(first, last)
        on_rim &= ~on
        parts[on_rim] = rim[on_rim]
        on |= on_rim
    rows = np.flatnonzero(on)
    return FaceRows(rows, parts[rows])


def with_bands(groups: Sequence[RibGroup], profile: TreadProfile) -> tuple[RibGroup, ...]:
    """Ribs of a profile with the bands of their faces, inside of which the rounded edges of grooves are pressed."""

    def rim(wall: float, height: float) -> float:
        """Of a wall: how far from it the rounded edge sinks in."""
        for groove in profile.grooves:
            if abs(abs(wall - groove.centre) - 0.5 * groove.width) < _SAME:
                radius, sunk = groove.edge_radius, min(_SUNK * height, groove.edge_radius)
                into = math.sqrt(sunk * (2 * radius - sunk))
                return max(0.0, rounding_start(groove.wall_angle, radius) - into)
        return 0.0

    def bands(group: RibGroup) -> tuple[Band, ...]:
        height = group.section.height
        ends = [(left, rim(left, height), rim(right, height), right) for left, right in group.faces]
        return tuple((left, left + first, right - last, right) for left, first, last, right in ends)

    return tuple(replace(group, pressed=bands(group)) for group in groups)


def gap_on_faces(profile: TreadProfile, grid: Grid, groups: Sequence[RibGroup], gap: Array) -> Array:
    """The gap of a tread (ny, nx), m, on ribs as the mean over what every row stands for of their faces.

    gap: at the middles of the cells, which the other rows keep.
    """
    mean = gap.copy()
    places = (np.arange(_PLACES) + 0.5) / _PLACES
    for face in rows_on_faces(grid.y, grid.dy, [band for group in groups for band in group.bands]):
        y = face.parts[:, :1] + places * (face.parts[:, 1:] - face.parts[:, :1])
        mean[face.rows] = profile.gap(grid.x, y.ravel()).reshape(face.rows.size, _PLACES, -1).mean(1)
    return mean


def shares_of_rows(y: Array, dy: float, groups: Sequence[RibGroup]) -> Array:
    """What part of a cell every row stands for (ny,): 1 but at the edges of ribs, where it may be a bit more."""
    shares = np.ones(y.size)
    for face in rows_on_faces(y, dy, [band for group in groups for band in group.bands]):
        shares[face.rows] = np.ptp(face.parts, axis=1) / dy
    return shares
