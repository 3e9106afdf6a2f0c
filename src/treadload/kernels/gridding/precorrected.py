"""Fields of a gridded load anywhere, interpolated from lattices: N log N.

Lattices side by side are a few times as fine as the cells. A point interpolates between the nodes around it by
polynomials in x and in y, see `Order`, which fails for the cells near it: their field steps and has logarithms at
their edges. Those cells get the difference between their field and what was interpolated of it. The field of all
others is smooth over the nodes.

Source: Phillips and White (1997), IEEE Trans. CAD 16, 1059-1072 (precorrected FFT).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import scipy

from treadload.kernels.arrays import Array
from treadload.kernels.gridding.lattice import Indices, Source, Spectrum, blocks, on_lattice


@dataclass(frozen=True)
class Order:
    """How finely points are interpolated between nodes.

    stencil: nodes each way that a point interpolates between. reach: how many of their spacings lie between a point
    and the nearest cell that is not corrected.
    """

    stencil: int
    reach: float


FINE = Order(12, 13.0)
"""1e-9 of the largest value is left, measured."""
ROUGH = Order(8, 8.0)
"""3e-7, for a third of the corrections: where the largest of many values is looked for."""

Shape = tuple[int, int]

# Most nodes in the shorter side of a cell.
FINEST = 5
# Places within a cell that differ by less than this part of it are one.
_SAME = 1e-9
# Fields on nodes are kept so many cells around the load, for loads whose sizes are multiples of so many.
_MARGIN, _ALIKE = 12, 4
# Numbers in a matrix that is better not sparse.
_SMALL = 4096
# Cells and nodes by which the sizes of loads that share spectra differ at most.
_SPARE = 8


def nodes_of(source: Source, nodes: int) -> tuple[int, int]:
    """Nodes in a cell along x and along y, about as far apart as `nodes` in its shorter side."""
    shorter = min(source.dx, source.dy)
    return max(1, round(nodes * source.dx / shorter)), max(1, round(nodes * source.dy / shorter))


def window(source: Source, depth: float, nodes: int, order: Order = FINE) -> tuple[int, int]:
    """Cells on each side of a point's own to correct, along x and along y; -1, -1 for none."""
    along, across = nodes_of(source, nodes)
    square = (order.reach * max(source.dx / along, source.dy / across)) ** 2 - depth**2
    if square <= 0:
        return -1, -1
    wide, high = (math.ceil(math.sqrt(square) / size + source.half - 0.5) for size in (source.dx, source.dy))
    return wide, high


@dataclass(frozen=True, eq=False)
class Kept:
    """What `interpolated` computes once for all points under the same kernels.

    nodes: first node, in cells, and field on a lattice of nodes (nz, components, count_y, count_x), by the load and
    where in a cell the lattice stands. lacking: see `_lacking`, by depth, cells near and the places of points.
    spectra: see `on_lattice`. order: of the polynomials. ready: for how many nodes in the shorter side of a cell
    fields are kept. padded: see `sizes`.
    """

    order: Order
    nodes: dict[tuple[Any, ...], tuple[int, int, Array]] = field(default_factory=dict)
    lacking: dict[tuple[Any, ...], Array] = field(default_factory=dict)
    spectra: dict[tuple[Any, ...], list[Spectrum]] = field(default_factory=dict)
    ready: set[int] = field(default_factory=set)
    padded: dict[tuple[Any, ...], list[tuple[Shape, Shape]]] = field(default_factory=dict)

    def sizes(self, place: tuple[object, ...], cells: Shape, nodes: Shape) -> tuple[Shape, Shape]:
        """Cells of a load and nodes of its lattice, padded so that loads of nearly the same shape share spectra.

        place: depths and first node, from the load's first cell. cells, nodes: the fewest that will do.
        """
        sizes = self.padded.setdefault(place, [])
        for both in sizes:
            spare = [size - n for size, n in zip(sum(both, ()), (*cells, *nodes), strict=True)]
            if min(spare) >= 0 and max(spare) <= _SPARE:
                return both
        more = [-n % _ALIKE for n in cells]
        both = (cells[0] + more[0], cells[1] + more[1]), (nodes[0] + more[0], nodes[1] + more[1])
        sizes.append(both)
        return both


@dataclass(frozen=True, eq=False)
class Keeper:
    """What is kept of each kernel, by what it depends on. order: of the polynomials."""

    order: Order = FINE
    by_kernel: dict[tuple[Any, ...], Kept] = field(default_factory=dict)

    def of(self, *kernel: object) -> Kept:
        """What is kept of a kernel, at first nothing."""
        return replace(self.by_kernel.setdefault(kernel, Kept(self.order)), order=self.order)

    def with_order(self, order: Order) -> Keeper:
        """The same with polynomials of another order."""
        return replace(self, order=order)


def interpolated(source: Source, depths: Array, x: Array, y: Array, nodes: int, kept: Kept | None = None) -> Array:
    """Fields (nz, components, my, mx) on the grid of any coordinates.

    depths: (nz,), m. x: (mx,), y: (my,): relative to the centre of the first cell, m. nodes: in the shorter side of
    a cell; more of them make fewer cells near. kept: what further points under the same kernels need as well.
    """
    in_x, in_y = nodes_of(source, nodes)
    order = FINE if kept is None else kept.order
    along, across = (
        _Stencils.of(at / size, count, order.stencil)
        for at, size, count in ((x, source.dx, in_x), (y, source.dy, in_y))
    )
    fields = np.zeros((len(depths), source.components, len(y), len(x)))
    if kept is not None:
        kept.ready.add(nodes)
    for y0, count_y, from_y in across.lattices():
        for x0, count_x, from_x in along.lattices():
            at_nodes = on_nodes(source, depths, (count_y, count_x), source.dx * x0, source.dy * y0, kept)
            if isinstance(from_x, np.ndarray) and isinstance(from_y, np.ndarray):
                fields += from_y @ at_nodes @ from_x.T
                continue
            for row, component in np.ndindex(fields.shape[:2]):
                if at_nodes[row, component].any():
                    fields[row, component] += (from_x @ (from_y @ at_nodes[row, component]).T).T
    for each, depth in zip(fields, depths, strict=True):
        wide, high = window(source, float(depth), nodes, order)
        if wide >= 0:
            _correct(each, source, float(depth), along.near(wide), across.near(high), kept)
    return fields


def on_nodes(
    source: Source,
    depths: Array,
    shape: tuple[int, int],
    x0: float,
    y0: float,
    kept: Kept | None,
    *,
    whole: bool = False,
) -> Array:
    """As `on_lattice`; what is kept is the field on the lattice as far as any point on the load would need it.

    whole: whether only that at the centres of the cells is, where the nodes lie of which a cell has one.
    """
    alone = source.load.shape[1:-2]
    if kept is None or math.prod(alone) != 1:
        return on_lattice(source, depths, shape, x0, y0)
    ends = [
        (first - math.floor(first + _SAME), math.floor(first + _SAME), count, n)
        for first, count, n in zip((y0 / source.dy, x0 / source.dx), shape, source.load.shape[-2:], strict=True)
    ]
    if whole and any(abs(place) > _SAME for place, *_ in ends):
        return on_lattice(source, depths, shape, x0, y0)
    key = (source.load.tobytes(), *(n for *_, n in ends), *depths, *(round(place / _SAME) for place, *_ in ends))
    patch = kept.nodes.get(key)
    if patch is None or any(
        low < start or low + count > start + size
        for (_, low, count, _), start, size in zip(ends, patch[:2], patch[2].shape[-2:], strict=True)
    ):
        lows = [min(low, -_MARGIN) for _, low, _, _ in ends]
        counts = [max(low + count, n + _MARGIN) - start for (_, low, count, n), start in zip(ends, lows, strict=True)]
        corner = tuple(place + low for (place, *_), low in zip(ends, lows, strict=True))
        cells, nodes = kept.sizes(
            (*depths, *(round(at / _SAME) for at in corner)), source.load.shape[-2:], (counts[0], counts[1])
        )
        more = [size - n for size, n in zip(cells, source.load.shape[-2:], strict=True)]
        wide = replace(
            source, load=np.pad(source.load.reshape(3, *source.load.shape[-2:]), ((0, 0), *((0, k) for k in more)))
        )
        fields = on_lattice(wide, depths, nodes, source.dx * corner[1], source.dy * corner[0], spectra=kept.spectra)
        patch = kept.nodes[key] = lows[0], lows[1], fields
    row, column = (low - start for (_, low, _, _), start in zip(ends, patch[:2], strict=True))
    part = patch[2][..., row : row + shape[0], column : column + shape[1]]
    return part.reshape(*part.shape[:2], *alone, *shape)


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

    @property
    def places(self) -> tuple[Indices, Indices]:
        """One point of each place within a cell, and for all points the number of their place."""
        _, first, alike = np.unique(np.round(self.first / _SAME), return_index=True, return_inverse=True)
        return first, alike


@dataclass(frozen=True, eq=False)
class _Stencils:
    """Nodes that points of an axis interpolate between.

    nodes: in a cell; node k of cell 0 lies at (k + 1/2) / nodes - 1/2. cell: (m,) the cell of each point. place:
    (m,) position in it, -1/2 … 1/2. first: (m,) first node, counted from that of its cell. weights: (m, stencil).
    """

    nodes: int
    cell: Indices
    place: Array
    first: Indices
    weights: Array

    @classmethod
    def of(cls, x: Array, nodes: int, stencil: int) -> _Stencils:
        """x: (m,), in cells."""
        # Points on a border all belong to the cell behind it, whatever their round-off.
        cell = np.floor(x + 0.5 + _SAME).astype(int)
        place = x - cell
        at = nodes * (place + 0.5) - 0.5
        first = np.floor(at + nodes * _SAME).astype(int) - stencil // 2 + 1
        away = (at - first)[:, None, None] - np.arange(stencil)
        off_diagonal = ~np.eye(stencil, dtype=bool)
        apart = np.subtract.outer(np.arange(stencil), np.arange(stencil))
        # Lagrange's polynomials.
        weights = np.where(off_diagonal, away, 1.0).prod(axis=2) / np.where(off_diagonal, apart, 1).prod(axis=1)
        return cls(nodes, cell, place, first, weights)

    def lattices(self) -> Iterator[tuple[float, int, Array | scipy.sparse.csr_array]]:
        """First point, in cells, number of points, and the matrix (m, number) to the points, of each lattice.

        A small matrix is an array, which costs less to make.
        """
        at = (self.nodes * self.cell + self.first)[:, None] + np.arange(self.stencil)
        cells, node = np.divmod(at, self.nodes)
        start, count = int(cells.min()), int(np.ptp(cells)) + 1
        points = np.broadcast_to(np.arange(len(at))[:, None], at.shape)
        for k in range(self.nodes):
            here = node == k
            weights, places = self.weights[here], (points[here], cells[here] - start)
            matrix: Array | scipy.sparse.csr_array
            if len(at) * count <= _SMALL:
                matrix = np.zeros((len(at), count))
                matrix[places] = weights
            else:
                matrix = scipy.sparse.csr_array((weights, places), shape=(len(at), count))
            yield float(start + self._at[k]), count, matrix

    def near(self, width: int) -> _Near:
        """Cells up to `width` from that of each point."""
        offsets = np.arange(2 * width + 1)
        low = (-(self.stencil // 2)) // self.nodes - width
        high = (self.nodes + self.stencil // 2 - 1) // self.nodes + width
        back = np.zeros((len(self.cell), len(offsets), self.nodes * (high - low + 1)))
        place = (self.first - self.nodes * (width + low))[:, None, None] + self.nodes * offsets[:, None]
        np.put_along_axis(
            back, place + np.arange(self.stencil), self.weights[:, None, :].repeat(len(offsets), 1), axis=2
        )
        table = low + self._at, high - low + 1
        return _Near(self.cell[:, None] + width - offsets, self.place - width, table, back)

    @property
    def stencil(self) -> int:
        """Nodes that a point interpolates between."""
        return int(self.weights.shape[1])

    @property
    def _at(self) -> Array:
        """Nodes of cell 0."""
        return (np.arange(self.nodes) + 0.5) / self.nodes - 0.5


def _correct(field: Array, source: Source, depth: float, along: _Near, across: _Near, kept: Kept | None) -> None:
    """Add to a field (components, my, mx) the cells near each point, less what was interpolated of them.

    What is lacking of a cell depends on the place of the point within its own cell alone: points share it.
    """
    _, ny, nx = source.load.shape
    columns, rows = along.under(nx), across.under(ny)
    if not len(columns) or not len(rows):
        return
    along, across = along.of(columns), across.of(rows)
    # One cell without load on each side stands for all that lie beyond.
    load = np.pad(source.load, ((0, 0), (1, 1), (1, 1)))
    cells_y, cells_x = (np.clip(axis.cells + 1, 0, n + 1) for axis, n in ((across, ny), (along, nx)))
    (first_y, place_y), (first_x, place_x) = across.places, along.places
    near = cells_y.shape[1] * cells_x.shape[1]
    for part_y, part_x in blocks(len(first_y), len(first_x), near):
        lacking = _lacking(source, depth, along.of(first_x[part_x]), across.of(first_y[part_y]), kept)
        at_row = [np.flatnonzero(place_y == k) for k in range(part_y.start, part_y.start + len(lacking))]
        at_column = [np.flatnonzero(place_x == k) for k in range(part_x.start, part_x.start + lacking.shape[1])]
        for points_y, several in zip(at_row, lacking, strict=True):
            lines = load[:, cells_y[points_y]]
            for points_x, weights in zip(at_column, several, strict=True):
                # (load, rows, cells, columns, cells)
                patches = lines[..., cells_x[points_x]].transpose(1, 3, 0, 2, 4)
                part = patches.reshape(len(points_y), len(points_x), -1) @ weights
                field[:, rows[points_y][:, None], columns[points_x]] += part.transpose(2, 0, 1)


def _lacking(source: Source, depth: float, along: _Near, across: _Near, kept: Kept | None) -> Array:
    """What interpolation lacks of the fields of unit loads on near cells, (y, x, 3 · cells, components), of places.

    along, across: points at the places.
    """
    shape = across.cells.shape[1], along.cells.shape[1]
    at_y, at_x = (np.round(axis.first / _SAME) for axis in (across, along))
    key = (depth, *shape, across.back.shape[2], at_y.tobytes(), at_x.tobytes())
    if kept is not None and key in kept.lacking:
        return kept.lacking[key]
    (table_x, wide), (table_y, high) = along.table, across.table
    tables = source.kernels(source.dx * table_x, source.dy * table_y, (high, wide), depth)
    exact = source.kernels(source.dx * along.first, source.dy * across.first, shape, depth)
    from_y, from_x = across.back.reshape(-1, across.back.shape[2]), along.back.reshape(-1, along.back.shape[2])
    whole = np.zeros((len(at_y), len(at_x), 3, *shape, source.components))
    for (values, uses), (nodes, _) in zip(exact, tables, strict=True):
        served = [use for use in uses if kept is not None or source.load[use[0]].any()]
        if served:
            table = nodes.transpose(1, 0, 3, 2).reshape(high * len(table_y), wide * len(table_x))
            missing = values - (from_y @ table @ from_x.T).reshape(values.shape)
        for k, component in served:
            whole[:, :, k, ..., component] += missing.transpose(0, 2, 1, 3)
    lacking = whole.reshape(len(at_y), len(at_x), -1, source.components)
    if kept is not None:
        kept.lacking[key] = lacking
    return lacking
