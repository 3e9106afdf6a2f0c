"""The cross-section of ribs that stand on a common base, and its mesh.

y across, z from the base, where the rubber is bonded, to the face that meets the road. Mesh lines run from the base
to the surface, so that the section is a row of columns of elements: those of a rib reach the face, those of a groove
its floor.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from treadload.kernels.arrays import Array

# Sizes of elements over the height of the section: at a wall; at the base, a floor or the face; far from them. How
# fast they grow.
_AT_WALL, _AT_LEVEL, _LARGEST, _GROWTH = 1 / 60, 1 / 25, 1 / 5, 2.0
# The largest element over a cell: shear and pressure of a cell jump at its edges.
_PER_CELL = 0.7
SAME = 1e-9


@dataclass(frozen=True)
class Section:
    """Ribs of one height on a common base.

    ribs: (left, right) of the face of every rib, m, from left to right. height: of the face over the base, m.
    floors: height of the rubber to the left of the first rib, between ribs, and to the right of the last, m: the
    undertread, higher where a tie bar joins two ribs; 0 for none. ends: how far the undertread reaches beyond the
    feet of the first and the last rib, m. draft: slope of the walls, by which a rib widens per depth: of all, or
    (left, right) of every rib. halvings: of the largest elements across, for small cells, see `for_cells`.

    Raises ValueError for ribs without width, walls that meet, and floors outside 0 to the height.
    """

    ribs: tuple[tuple[float, float], ...]
    height: float
    floors: tuple[float, ...]
    ends: tuple[float, float] = (0.0, 0.0)
    draft: float | tuple[tuple[float, float], ...] = 0.0
    halvings: int = 0

    def __post_init__(self) -> None:
        if len(self.floors) != len(self.ribs) + 1:
            raise ValueError(f"{len(self.ribs)} ribs need {len(self.ribs) + 1} floors, got {len(self.floors)}")
        if not all(right > left for left, right in self.ribs):
            raise ValueError(f"every rib needs a width above 0 m, got {self.ribs}")
        if not all(0 <= floor < self.height for floor in self.floors):
            raise ValueError(f"floors must lie from 0 m to below the height of {self.height:g} m, got {self.floors}")
        if isinstance(self.draft, tuple) and len(self.draft) != len(self.ribs):
            raise ValueError(f"{len(self.ribs)} ribs need as many pairs of drafts, got {len(self.draft)}")
        if min(self.ends) < 0 or min(min(pair) for pair in self.drafts) < 0:
            raise ValueError(f"ends and draft must not be negative, got {self.ends} and {self.draft}")
        feet = self.feet
        for (_, right), (left, _) in itertools.pairwise(feet):
            if right >= left - SAME:
                raise ValueError(f"the walls of a groove meet above its floor, at y = {left:g} m")

    def for_cells(self, width: float) -> Section:
        """The section with elements fine enough for cells of this width, m."""
        largest = _LARGEST * self.height
        return replace(self, halvings=max(0, math.ceil(math.log2(largest / (_PER_CELL * width)) - SAME)))

    @property
    def mirrored(self) -> Section:
        """The image of the section in y = 0."""
        ribs = tuple((-right, -left) for left, right in reversed(self.ribs))
        draft = self.draft if isinstance(self.draft, float | int) else tuple(pair[::-1] for pair in self.draft[::-1])
        return replace(self, ribs=ribs, floors=self.floors[::-1], ends=(self.ends[1], self.ends[0]), draft=draft)

    @property
    def drafts(self) -> tuple[tuple[float, float], ...]:
        """Slopes of the left and the right wall of every rib."""
        return self.draft if isinstance(self.draft, tuple) else ((self.draft, self.draft),) * len(self.ribs)

    @property
    def feet(self) -> tuple[tuple[float, float], ...]:
        """(left, right) of every rib where its walls meet the floors, m."""
        return tuple(
            (
                left - self.drafts[number][0] * (self.height - self.floors[number]),
                right + self.drafts[number][1] * (self.height - self.floors[number + 1]),
            )
            for number, (left, right) in enumerate(self.ribs)
        )

    @cached_property
    def mesh(self) -> Mesh:
        """Columns of quadratic elements, finer at the walls."""
        levels = _levels(self.height, self.floors)
        lines: list[Array] = []
        rows: list[int] = []
        faces: list[tuple[int, int]] = []

        def add(left: Array, right: Array, parts: Array, height: int) -> None:
            """Columns between two lines; their first line is the last so far, where there is one."""
            between = left + parts[:, None] * (right - left)
            lines.extend(between[1:] if lines else between)
            rows.extend([height] * ((len(parts) - 1) // 2))

        feet = self.feet
        tops = [int(np.argmin(np.abs(levels - floor))) // 2 for floor in self.floors]
        if self.floors[0] > 0 and self.ends[0] > 0:
            wall = self._wall(levels, 0, 0)
            add(wall - self.ends[0], wall, self._parts(self.ends[0], walls=(False, True)), tops[0])
        for number, (left, right) in enumerate(self.ribs):
            first = max(len(lines) - 1, 0)
            add(
                self._wall(levels, number, 0),
                self._wall(levels, number, 1),
                self._parts(right - left),
                len(levels) // 2,
            )
            faces.append((first, len(lines)))
            last = number == len(self.ribs) - 1
            gap = self.ends[1] if last else feet[number + 1][0] - feet[number][1]
            wall = self._wall(levels, number, 1)
            opposite = wall + gap if last else self._wall(levels, number + 1, 0)
            if gap > 0 and (not last or self.floors[-1] > 0):
                add(wall, opposite, self._parts(gap, walls=(True, not last)), tops[number + 1])
        return Mesh(np.array(lines), levels, tuple(rows), tuple(faces))

    def _wall(self, levels: Array, number: int, side: int) -> Array:
        """Place across, y, of a wall of a rib at all levels, m: below the floor straight down."""
        above = np.maximum(levels, self.floors[number + side])
        draft = self.drafts[number][side]
        return np.asarray(self.ribs[number][side] + (2 * side - 1) * draft * (self.height - above))

    def _parts(self, width: float, walls: tuple[bool, bool] = (True, True)) -> Array:
        """Places of mesh lines, ends and middles of columns, as parts of a width, m, finer at walls."""
        largest = _LARGEST / 2**self.halvings
        if all(walls):
            return with_middles(_from_both_ends(width / self.height, _AT_WALL, largest))
        edges = _graded(width / self.height, _AT_WALL, largest)
        edges /= edges[-1]
        return with_middles(edges if walls[0] else 1 - edges[::-1])


@dataclass(frozen=True)
class Mesh:
    """Columns of quadratic elements between lines from the base up.

    lines: y (2 columns + 1, levels) of nodes, m: ends and middles of columns. levels: z of nodes, m, ends and middles
    of elements, from 0. rows: elements in every column. faces: (first, after) line of every rib.
    """

    lines: Array
    levels: Array
    rows: tuple[int, ...]
    faces: tuple[tuple[int, int], ...]

    @property
    def face_lines(self) -> Array:
        """Lines that reach the face, from left to right."""
        return np.concatenate([np.arange(*face) for face in self.faces])

    @property
    def face(self) -> tuple[Array, ...]:
        """Places across, y, of the nodes on the face of every rib, m."""
        return tuple(self.lines[first:after, -1] for first, after in self.faces)


def _levels(height: float, floors: tuple[float, ...]) -> Array:
    """Heights z of nodes, so that every floor is one, m."""
    steps = np.unique(np.round([0.0, *floors, height], 12))
    edges = [np.zeros(1)]
    for low, high in itertools.pairwise(steps):
        edges.append(low + (high - low) * _from_both_ends((high - low) / height, _AT_LEVEL)[1:])
    return with_middles(np.concatenate(edges))


def _from_both_ends(length: float, finest: float, largest: float = _LARGEST) -> Array:
    """Edges of elements, from 0 to 1, that grow from both ends of a length over the height."""
    half = _graded(0.5 * length, finest, largest) / length
    return np.concatenate([half, 1 - half[-2::-1]])


def _graded(length: float, finest: float, largest: float) -> Array:
    """Edges of elements from 0 to a length, over the height, that grow from a finest one at 0."""
    sizes = growing(length, finest, largest)
    edges = np.concatenate([[0.0], np.cumsum(sizes)])
    return np.asarray(edges * length / edges[-1])


def growing(length: float, finest: float, largest: float) -> list[float]:
    """Sizes of elements that grow from the finest to the largest and reach a length or a little more."""
    sizes: list[float] = []
    while sum(sizes) < length * (1 - SAME):
        sizes.append(min(finest * _GROWTH ** len(sizes), largest))
    return sizes


def with_middles(edges: Array) -> Array:
    """Edges of elements and their middles, in order."""
    nodes = np.empty(2 * edges.size - 1)
    nodes[::2], nodes[1::2] = edges, 0.5 * (edges[1:] + edges[:-1])
    return nodes
