"""Fields of a gridded load anywhere, interpolated from lattices: N log N.

Lattices side by side are a few times as fine as the cells. A point interpolates between the nodes around it by
polynomials of degree 11 in x and in y, which fails for the cells near it: their field steps and has logarithms at
their edges. Those cells get the difference between their field and what was interpolated of it. The field of all
others is smooth over the nodes. Measured, 1e-9 of the largest value is left.

Source: Phillips and White (1997), IEEE Trans. CAD 16, 1059-1072 (precorrected FFT).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from scipy import sparse

from treadload.kernels.arrays import Array
from treadload.kernels.gridding.lattice import Indices, Source, blocks, on_lattice

# Nodes each way that a point interpolates between, and how many of their spacings lie between a point and the
# nearest cell that is not corrected.
STENCIL, _REACH = 12, 13.0
# Most nodes in the shorter side of a cell.
FINEST = 5


def nodes_of(source: Source, nodes: int) -> tuple[int, int]:
    """Nodes in a cell along x and along y, about as far apart as `nodes` in its shorter side."""
    shorter = min(source.dx, source.dy)
    return max(1, round(nodes * source.dx / shorter)), max(1, round(nodes * source.dy / shorter))


def window(source: Source, depth: float, nodes: int) -> tuple[int, int]:
    """Cells on each side of a point's own to correct, along x and along y; -1, -1 for none."""
    along, across = nodes_of(source, nodes)
    square = (_REACH * max(source.dx / along, source.dy / across)) ** 2 - depth**2
    if square <= 0:
        return -1, -1
    wide, high = (math.ceil(math.sqrt(square) / size + source.half - 0.5) for size in (source.dx, source.dy))
    return wide, high


def interpolated(source: Source, depths: Array, x: Array, y: Array, nodes: int) -> Array:
    """Fields (nz, components, my, mx) on the grid of any coordinates.

    depths: (nz,), m. x: (mx,), y: (my,): relative to the centre of the first cell, m. nodes: in the shorter side of
    a cell; more of them make fewer cells near.
    """
    in_x, in_y = nodes_of(source, nodes)
    along, across = _Stencils.of(x / source.dx, in_x), _Stencils.of(y / source.dy, in_y)
    fields = np.zeros((len(depths), source.components, len(y), len(x)))
    for y0, count_y, from_y in across.lattices():
        for x0, count_x, from_x in along.lattices():
            on_nodes = on_lattice(source, depths, (count_y, count_x), source.dx * x0, source.dy * y0)
            for row, component in np.ndindex(fields.shape[:2]):
                if on_nodes[row, component].any():
                    fields[row, component] += (from_x @ (from_y @ on_nodes[row, component]).T).T
    for field, depth in zip(fields, depths, strict=True):
        wide, high = window(source, float(depth), nodes)
        if wide >= 0:
            _correct(field, source, float(depth), along.near(wide), across.near(high))
    return fields


@dataclass(frozen=True, eq=False)
class _Near:
    """Cells near points of an axis and what is interpolated of them.

    cells: (m, 2 w + 1) falling, their offsets from the point rising. first: (m,) offset of the point from the first
    of them, in cells. table: offsets of the nodes from a cell at which its field is needed: the first of each of
    the lattices, and how many cells on. back: (m, 2 w + 1, nodes) from those, in rising order, to the point.
    """

    cells: Indices
    first: Array
    table: tuple[Array, int]
    back: Array

    def under(self, count: int) -> Indices:
        """Points with one of the cells 0 … count - 1 near."""
        return np.flatnonzero((self.cells[:, 0] >= 0) & (self.cells[:, -1] < count))

    def of(self, points: Indices) -> _Near:
        """Those of some points."""
        return replace(self, cells=self.cells[points], first=self.first[points], back=self.back[points])


@dataclass(frozen=True, eq=False)
class _Stencils:
    """Nodes that points of an axis interpolate between.

    nodes: in a cell; node k of cell 0 lies at (k + 1/2) / nodes - 1/2. cell: (m,) the cell of each point. place:
    (m,) position in it, -1/2 … 1/2. first: (m,) first node, counted from that of its cell. weights: (m, STENCIL).
    """

    nodes: int
    cell: Indices
    place: Array
    first: Indices
    weights: Array

    @classmethod
    def of(cls, x: Array, nodes: int) -> _Stencils:
        """x: (m,), in cells."""
        cell = np.floor(x + 0.5).astype(int)
        place = x - cell
        at = nodes * (place + 0.5) - 0.5
        first = np.floor(at).astype(int) - STENCIL // 2 + 1
        away = (at - first)[:, None, None] - np.arange(STENCIL)
        others = ~np.eye(STENCIL, dtype=bool)
        apart = np.subtract.outer(np.arange(STENCIL), np.arange(STENCIL))
        # Lagrange's polynomials.
        weights = np.where(others, away, 1.0).prod(axis=2) / np.where(others, apart, 1).prod(axis=1)
        return cls(nodes, cell, place, first, weights)

    def lattices(self) -> Iterator[tuple[float, int, sparse.csr_array]]:
        """First point, in cells, number of points, and the matrix (m, number) to the points, of each lattice."""
        at = (self.nodes * self.cell + self.first)[:, None] + np.arange(STENCIL)
        cells, node = np.divmod(at, self.nodes)
        start, count = int(cells.min()), int(np.ptp(cells)) + 1
        points = np.broadcast_to(np.arange(len(at))[:, None], at.shape)
        for k in range(self.nodes):
            here = node == k
            entries = self.weights[here], (points[here], cells[here] - start)
            yield float(start + self._at[k]), count, sparse.csr_array(entries, shape=(len(at), count))

    def near(self, width: int) -> _Near:
        """Cells up to `width` from that of each point."""
        offsets = np.arange(2 * width + 1)
        low = (-(STENCIL // 2)) // self.nodes - width
        high = (self.nodes + STENCIL // 2 - 1) // self.nodes + width
        back = np.zeros((len(self.cell), len(offsets), self.nodes * (high - low + 1)))
        place = (self.first - self.nodes * (width + low))[:, None, None] + self.nodes * offsets[:, None]
        np.put_along_axis(back, place + np.arange(STENCIL), self.weights[:, None, :].repeat(len(offsets), 1), axis=2)
        table = low + self._at, high - low + 1
        return _Near(self.cell[:, None] + width - offsets, self.place - width, table, back)

    @property
    def _at(self) -> Array:
        """Nodes of cell 0."""
        return (np.arange(self.nodes) + 0.5) / self.nodes - 0.5


def _correct(field: Array, source: Source, depth: float, along: _Near, across: _Near) -> None:
    """Add to a field (components, my, mx) the cells near each point, less what was interpolated of them."""
    _, ny, nx = source.load.shape
    columns, rows = along.under(nx), across.under(ny)
    # One cell without load on each side stands for all that lie beyond.
    loads = {k: np.pad(source.load[k], 1) for k in range(3) if source.load[k].any()}
    (table_x, wide), (table_y, high) = along.table, across.table
    tables = [
        values.transpose(1, 0, 3, 2).reshape(high * len(table_y), wide * len(table_x))
        for values, _ in source.kernels(source.dx * table_x, source.dy * table_y, (high, wide), depth)
    ]
    shape = across.cells.shape[1], along.cells.shape[1]
    for part_y, part_x in blocks(len(rows), len(columns), shape[0] * shape[1]):
        above, beside = across.of(rows[part_y]), along.of(columns[part_x])
        cells = np.ix_(np.clip(above.cells + 1, 0, ny + 1).ravel(), np.clip(beside.cells + 1, 0, nx + 1).ravel())
        corners = len(above.first), shape[0], len(beside.first), shape[1]
        patches = {k: load[cells].reshape(corners) for k, load in loads.items()}
        from_y, from_x = above.back.reshape(-1, above.back.shape[2]), beside.back.reshape(-1, beside.back.shape[2])
        exact = source.kernels(source.dx * beside.first, source.dy * above.first, shape, depth)
        points = np.ix_(rows[part_y], columns[part_x])
        for (values, uses), table in zip(exact, tables, strict=True):
            served = [(k, component) for k, component in uses if k in patches]
            if served:
                missing = values - (from_y @ table @ from_x.T).reshape(corners)
            for k, component in served:
                field[component][points] += np.einsum("bman,bman->ba", missing, patches[k])
