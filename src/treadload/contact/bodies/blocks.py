"""Blocks of a tread on a belt: a surface that is not the same along travel.

In the frame of the tread the blocks stand still while the wheel rolls on, so that every block has one dense matrix on
its own cells. Cells of different blocks are coupled by belt and road alone, which are convolutions. What the
undertread between blocks passes on is left out, as between ribs: 1.6 % of the compliance at the depth of a truck's
grooves.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from treadload.contact.bodies.belt import BeltSheet, BeltString
from treadload.contact.bodies.block_tables import BlockTable, block_table
from treadload.contact.bodies.body import Body, Offsets, Sum
from treadload.contact.bodies.influence import Influence
from treadload.errors import InputError
from treadload.grid import Grid
from treadload.kernels.arrays import Array, BoolArray, IntArray
from treadload.kernels.gridding.convolution import Padding
from treadload.kernels.gridding.patches import Patch, Patches, PatchInverse
from treadload.kernels.gridding.strips import StripInverse, Strips, coupling_of
from treadload.kernels.sections import FaceCells
from treadload.kernels.sections.blocks import is_inside
from treadload.materials import Elastic
from treadload.tire.belt import InflatedBelt
from treadload.tire.blocks import TreadBlock

# Displacements (u_x, u_y, u_n) and loads (q_x, q_y, p) from those along x, y and out of the face.
_SIGNS = np.array([1.0, 1.0, -1.0])
# The image in y = 0 moves the other way across.
_IMAGE = np.array([1.0, -1.0, 1.0])
# Length of a piece over which belt and road are averaged in the preconditioner, m.
_PIECE = 0.025
_SAME = 1e-9
# Cells of a block at least.
_FEWEST = 9


@dataclass(frozen=True)
class BlockInfluence(Influence):
    """`Influence` of a pair whose tire has blocks on these cells. pair: belt and road.

    patches: the blocks. pieces: (ny nx,) number of the piece of a block that a cell belongs to, -1 for none.
    """

    patches: Patches | None = None
    pieces: IntArray | None = None

    __hash__ = None  # type: ignore[assignment]

    @property
    def has_blocks(self) -> bool:
        """As of `Influence`."""
        return True

    def strips(self, padding: Padding) -> Strips | None:
        """The blocks."""
        return self.patches

    def strips_ahead(self, distance: float) -> Strips | None:
        """The blocks; in the frame of the tread nothing moves ahead."""
        if distance:
            raise ValueError("blocks are known at their own cells only: march in the frame of the tread")
        return self.patches

    def strip_inverse(self, components: tuple[int, ...]) -> StripInverse | None:
        """As of `Influence`."""
        if components not in self._inverses:
            assert self.patches is not None
            assert self.pieces is not None
            self._inverses[components] = PatchInverse.of_patches(
                self.patches.patches, components, self.pieces, lambda index: self._means(components, index)
            )
        return self._inverses[components]

    @cached_property
    def dundurs(self) -> float:
        """Largest share of a load that couples pressure and shear in a block, in the mean over all loads."""
        assert self.patches is not None
        return max(coupling_of(patch.table) for patch in self.patches.patches)

    def _means(self, components: tuple[int, ...], index: IntArray) -> Array:
        """Mean displacement of pieces by unit loads on others through belt and road, m/Pa."""
        assert self.pieces is not None
        at = Offsets(*self.shape, self.dx, self.dy)
        if components == (2,):
            kernels = {(0, 0): self.pair.normal(at)}
        else:
            xx, yy, xy = self.pair.tangential(at)
            kernels = {(0, 0): xx, (1, 1): yy, (0, 1): xy}
        belongs = self.pieces[index]
        count = int(belongs.max()) + 1
        row, column = np.divmod(index, self.shape[1])
        cells = np.bincount(belongs, minlength=count)
        means = np.zeros((len(components), count, len(components), count))
        for piece in range(count):
            of = np.flatnonzero(belongs == piece)
            across, along = row[:, None] - row[of], column[:, None] - column[of]
            for (i, j), kernel in kernels.items():
                values = kernel[np.abs(across), np.abs(along)]
                if i != j:
                    values = values * (np.sign(across) * np.sign(along))
                mean = np.bincount(belongs, values.mean(1), minlength=count) / cells
                means[i, :, j, piece] = mean
                means[j, :, i, piece] = mean
        size = len(components) * count
        whole = means.reshape(size, size)
        return np.asarray(0.5 * (whole + whole.T))


def belt_alone(inflated: InflatedBelt, road: Body) -> Body:
    """Belt and road without the tread, whose blocks are known cell by cell."""
    parts: list[Body] = [BeltSheet(inflated.sheet)]
    if inflated.belt.lateral is not None:
        parts.append(BeltString(inflated.belt.lateral))
    return Sum.of(*parts, road)


def block_influence(grid: Grid, pair: Body, blocks: list[TreadBlock], material: Elastic) -> BlockInfluence:
    """Operators of blocks on a belt and of a road on a grid. pair: as of `belt_alone`. material: of the blocks.

    A cell belongs to a block if its middle lies on the face. Raises InputError for blocks of fewer than 9 cells.
    """
    shapes: dict[tuple[int, bool], tuple[BlockTable, list[IntArray]]] = {}
    pieces = np.full(grid.ny * grid.nx, -1)
    count = 0
    for block in blocks:
        cells, centres = _cells_of(grid, block)
        shape = block.block.for_cells(grid.dx, grid.dy)
        table = block_table(shape, material.poisson, FaceCells(centres, grid.dx, grid.dy))
        key = id(table.compliance), table.is_mirrored
        shapes.setdefault(key, (table, []))[1].append(cells[table.order])
        number = _pieces_of(centres)
        pieces[cells] = count + number
        count += int(number.max()) + 1
    patches = []
    for table, alike in shapes.values():
        size = alike[0].size
        signs = _SIGNS * (_IMAGE if table.is_mirrored else 1.0)
        compliance = table.compliance.reshape(3, size, 3, size) / material.modulus
        patches.append(Patch(np.stack(alike), compliance * signs[:, None, None, None] * signs[:, None]))
    return BlockInfluence(grid.shape, grid.dx, grid.dy, pair, grid.y0, Patches.of(tuple(patches)), pieces)


def on_blocks(grid: Grid, influence: BlockInfluence) -> BoolArray:
    """(ny, nx) True for cells that belong to a block."""
    assert influence.pieces is not None
    return np.asarray(influence.pieces.reshape(grid.shape) >= 0)


def _cells_of(grid: Grid, block: TreadBlock) -> tuple[IntArray, Array]:
    """Numbers of the cells of a block and their middles (n, 2) from its place, m."""
    corners = np.array(block.block.corners)
    columns = np.flatnonzero(np.abs(grid.x - block.x) <= np.abs(corners[:, 0]).max() + _SAME)
    rows = np.flatnonzero(np.abs(grid.y - block.y) <= np.abs(corners[:, 1]).max() + _SAME)
    row, column = np.meshgrid(rows, columns, indexing="ij")
    centres = np.stack([grid.x[column.ravel()] - block.x, grid.y[row.ravel()] - block.y], axis=1)
    inside = is_inside(block.block, centres)
    if inside.sum() < _FEWEST:
        shortest = float(np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1).min())
        raise InputError(
            f"a block has {int(inside.sum())} cells of {grid.dx * 1e3:.3g} x {grid.dy * 1e3:.3g} mm, and needs "
            f'{_FEWEST}; use spacing = "{np.floor(shortest / 3 * 1e4) / 10:g} mm" or less'
        )
    return (row.ravel() * grid.nx + column.ravel())[inside], centres[inside]


def _pieces_of(centres: Array) -> IntArray:
    """Number of the piece of every cell (n, 2) of a block: about squares, from 0."""
    parts = np.maximum(1, np.rint(np.ptp(centres, axis=0) / _PIECE)).astype(int)
    low, size = centres.min(0), np.ptp(centres, axis=0) + _SAME
    place = np.minimum((parts * (centres - low) / size).astype(int), parts - 1)
    return np.asarray(np.unique(place[:, 0] * parts[1] + place[:, 1], return_inverse=True)[1])
