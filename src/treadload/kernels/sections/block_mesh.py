"""The shape of a tread block with its undertread, and its mesh of hexahedra.

Mesh lines are those of a quadrilateral, finer at its walls; around it lie those of the undertread, which reaches the
floor of the grooves. Every level has the place of the walls at its depth.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from treadload.kernels.arrays import Array, BoolArray, IntArray
from treadload.kernels.sections.section import SAME, growing, with_middles

Point = tuple[float, float]
Sides = tuple[float, float, float, float]

# Sizes of elements over the height of a block: at the base, the floor and the face; the largest, up and across.
_AT_LEVEL, _LARGEST_UP, _LARGEST = 1 / 5, 1 / 3, 1 / 2
# Where the element at a wall is split, as a part of it; the first element beside a wall, as a part of the largest.
_AT_WALL, _BESIDE = 1 / 3, 1 / 2


@dataclass(frozen=True)
class Block:
    """A block with a face of four corners on a bonded base.

    corners: (x, y) of the face, m: rear left, front left, front right, rear right; x along travel, y to the right,
    convex. height: of the face over the base, m. floors: height of the undertread at the left, front, right and rear
    wall, m; 0 for none. beside: how far the undertread reaches beyond their feet, m. draft: slope of the walls, by
    which the block widens per depth. parts: elements along travel and across, of which those at the walls are split
    once more, see `for_cells`; left out, none is longer than half of the height.

    Raises ValueError for corners that are not convex, and numbers outside their bounds.
    """

    corners: tuple[Point, Point, Point, Point]
    height: float
    floors: Sides = (0.0, 0.0, 0.0, 0.0)
    beside: Sides = (0.0, 0.0, 0.0, 0.0)
    draft: Sides = (0.0, 0.0, 0.0, 0.0)
    parts: tuple[int, int] | None = None

    def __post_init__(self) -> None:
        if not all(0 <= floor < self.height for floor in self.floors):
            raise ValueError(f"floors must lie from 0 m to below the height of {self.height:g} m, got {self.floors}")
        if min(self.beside) < 0 or min(self.draft) < 0:
            raise ValueError(f"beside and draft must not be negative, got {self.beside} and {self.draft}")
        corners = np.array(self.corners, float)
        sides = np.roll(corners, -1, axis=0) - corners
        following = np.roll(sides, -1, axis=0)
        turns = sides[:, 0] * following[:, 1] - sides[:, 1] * following[:, 0]
        if not (np.isfinite(turns).all() and (turns > 0).all()):
            raise ValueError(
                "the corners of a block must be convex, in the order rear left, front left, front right, rear right, "
                f"got {self.corners}"
            )

    def for_cells(self, dx: float, dy: float) -> Block:
        """The block with elements for cells of dx by dy, m: one each, where walls lie between cells, or more."""
        largest = _LARGEST * self.height
        along, across = (
            max(1, round(length / cell)) * max(1, math.ceil(cell / largest - SAME))
            for length, cell in zip(self._lengths, (dx, dy), strict=True)
        )
        return replace(self, parts=(along, across))

    @property
    def _lengths(self) -> tuple[float, float]:
        """Length of the longer walls along travel and across, m."""
        corners = np.array(self.corners)
        sides = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
        return float(max(sides[0], sides[2])), float(max(sides[1], sides[3]))

    @property
    def mirrored(self) -> Block:
        """The image of the block in y = 0."""
        rear_left, front_left, front_right, rear_right = ((x, -y) for x, y in self.corners)

        def turned(sides: Sides) -> Sides:
            left, front, right, rear = sides
            return right, front, left, rear

        corners = (rear_right, front_right, front_left, rear_left)
        return replace(
            self,
            corners=corners,
            floors=turned(self.floors),
            beside=turned(self.beside),
            draft=turned(self.draft),
        )

    @cached_property
    def mesh(self) -> BlockMesh:
        """Slabs of elements across travel."""
        parts = self.parts
        if parts is None:
            largest = _LARGEST * self.height
            parts = self.for_cells(largest, largest).parts or (1, 1)
        levels = _levels(self.height, self.floors)
        rings = self._rings
        left, front, right, rear = rings
        along = _lines((rear, parts[0], front), _LARGEST * self.height)
        across = _lines((left, parts[1], right), _LARGEST * self.height)
        places = np.stack([self._level(z, rings, along, across) for z in levels], axis=2)
        nodes = np.concatenate([places, np.broadcast_to(levels[:, None], (*places.shape[:3], 1))], axis=3)
        rows = [int(np.argmin(np.abs(levels - floor))) // 2 for floor in self.floors]
        below = np.minimum.outer(
            np.array([rows[3], levels.size // 2, rows[1]])[along[::2, 0][:-1].astype(int)],
            np.array([rows[0], levels.size // 2, rows[2]])[across[::2, 0][:-1].astype(int)],
        )
        return BlockMesh(nodes, below)

    @property
    def _rings(self) -> Sides:
        """How far the undertread reaches beyond the feet, where there is one, m."""
        left, front, right, rear = (
            reach if floor > 0 else 0.0 for reach, floor in zip(self.beside, self.floors, strict=True)
        )
        return left, front, right, rear

    def _level(self, z: float, rings: Sides, along: Array, across: Array) -> Array:
        """Places (lines along, lines across, 2) of the nodes of a level."""
        sides = list(zip(self.draft, self.floors, rings, strict=True))
        walls = [slope * (self.height - max(z, floor)) for slope, floor, _ in sides]
        ends = [slope * (self.height - floor) + ring for slope, floor, ring in sides]
        net = np.empty((4, 4, 2))
        for i, (side, offset) in enumerate(((3, ends[3]), (3, walls[3]), (1, walls[1]), (1, ends[1]))):
            for j, (beside, aside) in enumerate(((0, ends[0]), (0, walls[0]), (2, walls[2]), (2, ends[2]))):
                net[i, j] = self._crossing((side, offset), (beside, aside))
        part, t = along[:, 0].astype(int)[:, None], along[:, 1][:, None, None]
        row, s = across[:, 0].astype(int)[None, :], across[:, 1][None, :, None]
        rear = (1 - s) * net[part, row] + s * net[part, row + 1]
        front = (1 - s) * net[part + 1, row] + s * net[part + 1, row + 1]
        return np.asarray((1 - t) * rear + t * front)

    def _crossing(self, first: tuple[int, float], second: tuple[int, float]) -> Array:
        """Where two sides meet, each moved outwards by a distance, m."""
        corners = np.array(self.corners)
        normals, reaches = [], []
        for side, offset in (first, second):
            start, stop = corners[side], corners[(side + 1) % 4]
            along = (stop - start) / np.linalg.norm(stop - start)
            normal = np.array([along[1], -along[0]])
            normals.append(normal)
            reaches.append(normal @ start + offset)
        return np.asarray(np.linalg.solve(np.array(normals), np.array(reaches)))


@dataclass(frozen=True, eq=False)
class BlockMesh:
    """Slabs of quadratic hexahedra, each from the base to the floor or to the face.

    nodes: (2 slabs + 1, 2 rows across + 1, levels, 3) x, y, z, m. tops: (slabs, rows across) elements above each
    other, 0 for none.
    """

    nodes: Array
    tops: IntArray

    @property
    def slabs(self) -> int:
        """How many slabs there are."""
        return len(self.tops)

    @cached_property
    def reaches_face(self) -> BoolArray:
        """(slabs, rows across) True where the elements reach the face."""
        return np.asarray(2 * self.tops == self.nodes.shape[2] - 1)

    @property
    def face(self) -> Array:
        """(planes, nodes across, 2) x, y of the nodes of the highest level, m."""
        return self.nodes[:, :, -1, :2]

    @cached_property
    def free(self) -> BoolArray:
        """(planes, nodes across, levels) True for nodes that an element has and the base does not hold."""
        free = np.zeros(self.nodes.shape[:3], bool)
        for slab, row in np.argwhere(self.tops > 0):
            free[2 * slab : 2 * slab + 3, 2 * row : 2 * row + 3, 1 : 2 * self.tops[slab, row] + 1] = True
        return free

    def elements_of(self, slab: int) -> tuple[Array, IntArray]:
        """Nodes (elements, 27, 3), m, of a slab, and their numbers (elements, 27) among its free ones; -1: base.

        Numbers: of the near plane, then of the middle and the far one; across, then up.
        """
        free = self.free[2 * slab : 2 * slab + 3]
        numbers = np.where(free, np.cumsum(free).reshape(free.shape) - 1, -1)
        planes = slice(2 * slab, 2 * slab + 3)
        nodes, places = [], []
        for row, rows in enumerate(self.tops[slab]):
            for level in range(rows):
                part = slice(2 * row, 2 * row + 3), slice(2 * level, 2 * level + 3)
                nodes.append(self.nodes[(planes, *part)].reshape(27, 3))
                places.append(numbers[(slice(None), *part)].ravel())
        return np.array(nodes), np.array(places)


def _levels(height: float, floors: Sides) -> Array:
    """Heights z of nodes, from 0 to the face, so that every floor is one, m."""
    steps = np.unique(np.round([0.0, *floors, height], 12))
    edges = [np.zeros(1)]
    for low, high in itertools.pairwise(steps):
        parts = _both_ends(float(high - low), height * _AT_LEVEL, height * _LARGEST_UP)
        edges.append(low + (high - low) * parts[1:])
    return with_middles(np.concatenate(edges))


def _lines(around: tuple[float, int, float], largest: float) -> Array:
    """Mesh lines (n, 2) across a block and what lies beside it: 0, 1 or 2 of the part, and where in it, 0 to 1.

    around: length before the block, m, elements in it, and length behind it, m. largest: element beside it, m.
    """
    before, count, behind = around
    inside = np.arange(count + 1) / count
    inside = np.unique([*inside, _AT_WALL / count, 1 - _AT_WALL / count])
    parts: list[tuple[int, Array]] = [(1, inside)]
    if before > 0:
        parts.insert(0, (0, 1 - _from_first_end(before, _BESIDE * largest, largest)[::-1]))
    if behind > 0:
        parts.append((2, _from_first_end(behind, _BESIDE * largest, largest)))
    lines: list[Point] = []
    for number, edges in parts:
        fine = with_middles(edges)
        lines += [(number, place) for place in fine[:-1]]
    lines.append((parts[-1][0], 1.0))
    return np.array(lines)


def _both_ends(length: float, finest: float, largest: float) -> Array:
    """Edges of elements, from 0 to 1, that grow from both ends of a length, m; one element where it is short."""
    if length <= finest * (1 + SAME):
        return np.array([0.0, 1.0])
    sizes = growing(0.5 * length, finest, largest)
    half = np.concatenate([[0.0], np.cumsum(sizes)]) / (2 * sum(sizes))
    return np.concatenate([half, 1 - half[-2::-1]])


def _from_first_end(length: float, finest: float, largest: float) -> Array:
    """Edges of elements, from 0 to 1, that grow from the first end of a length, m."""
    sizes = growing(length, finest, largest)
    return np.concatenate([[0.0], np.cumsum(sizes)]) / sum(sizes)
