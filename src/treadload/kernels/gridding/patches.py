"""Surfaces of separate blocks: one dense matrix for every block on its own cells.

Displacements (u_x, u_y, u_n) under loads (q_x, q_y, p), as in `strips`, of cells that need not lie in rows. Blocks of
one shape share a matrix and are multiplied at once. The inverse with a convolution besides takes the convolution in
the mean over pieces of a few cells, which is smooth: a block-diagonal inverse and a correction of low rank after
Woodbury.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from treadload.kernels.arrays import Array, IntArray
from treadload.kernels.gridding.convolution import Along
from treadload.kernels.gridding.strips import StripInverse, Strips


@dataclass(frozen=True, eq=False)
class Patch:
    """Blocks of one shape. cells: (blocks, n) numbers of their cells, row by row of the grid.

    compliance: (3, n, 3, n), m/Pa, u_x, u_y, u_n by q_x, q_y, p: symmetric, positive.
    """

    cells: IntArray
    compliance: Array

    @property
    def table(self) -> Array:
        """The compliance as a matrix (3 n, 3 n)."""
        size = 3 * self.cells.shape[1]
        return self.compliance.reshape(size, size)


@dataclass(frozen=True, eq=False)
class Patches(Strips):
    """Dense matrices of blocks: `Strips` without rows."""

    patches: tuple[Patch, ...] = ()
    _matrices: dict[tuple[tuple[int, ...], tuple[int, ...], str], list[Array]] = field(
        default_factory=dict, init=False, repr=False
    )

    @classmethod
    def of(cls, patches: tuple[Patch, ...]) -> Patches:
        """From blocks by their shapes."""
        return cls((), (), 0, patches)

    def added_to(
        self,
        convolved: Callable[[Along | None], list[Array]],
        loads: Array,
        components: tuple[int, ...],
        axes: tuple[float, ...] = (1.0, 1.0, 1.0),
    ) -> list[Array]:
        """As of `Strips`: cell by cell, as blocks are not the same along travel."""
        fields = convolved(None)
        scale = np.array(axes[: len(components)], loads.dtype)[:, None, None]
        moved = scale * self.displacement(scale * loads, components, components, fields[0].shape[1])
        return [field_ + more for field_, more in zip(fields, moved, strict=True)]

    def displacement(self, loads: Array, by: tuple[int, ...], of: tuple[int, ...], columns: int) -> Array:
        """As of `Strips`; the displacement is that of the loaded cells."""
        key = by, of, loads.dtype.char
        if key not in self._matrices:
            self._matrices[key] = [
                np.ascontiguousarray(
                    patch.compliance[list(of)][:, :, list(by)].reshape(len(of) * patch.cells.shape[1], -1).T,
                    loads.dtype,
                )
                for patch in self.patches
            ]
        flat = loads.reshape(len(by), -1)
        moved = np.zeros((len(of), flat.shape[1]), loads.dtype)
        for patch, matrix in zip(self.patches, self._matrices[key], strict=True):
            blocks, count = patch.cells.shape
            gathered = flat[:, patch.cells].swapaxes(0, 1).reshape(blocks, -1)
            moved[:, patch.cells] = (gathered @ matrix).reshape(blocks, len(of), count).swapaxes(0, 1)
        return moved.reshape(len(of), *loads.shape[1:])[..., :columns]

    def alone(self, component: int, places: int) -> Array:
        """As of `Strips`, at a distance of 0 alone: elsewhere it depends on the cell."""
        diagonal = [np.diagonal(patch.compliance[component, :, component]) for patch in self.patches]
        whole: Array = np.zeros(places)
        whole[0] = np.concatenate(diagonal).mean()
        return whole


@dataclass(frozen=True, eq=False)
class PatchInverse(StripInverse):
    """About the inverse of blocks and a convolution together, for loads on all cells of the blocks.

    blocks: (cells (blocks, n), inverse (m n, m n), Pa/m) of every shape. spread: (m cells, m pieces), what a unit of
    every piece does through the blocks; bound: (m pieces, m pieces), the inverse of the correction. index: of all
    cells in the order of the blocks.
    """

    blocks: tuple[tuple[IntArray, Array], ...] = ()
    spread: Array = field(default_factory=lambda: np.zeros((0, 0)))
    bound: Array = field(default_factory=lambda: np.zeros((0, 0)))
    index: IntArray = field(default_factory=lambda: np.zeros(0, int))

    @classmethod
    def of_patches(
        cls,
        patches: tuple[Patch, ...],
        components: tuple[int, ...],
        pieces: IntArray,
        means: Callable[[IntArray], Array],
    ) -> PatchInverse:
        """From blocks and what a convolution adds.

        pieces: (cells of the grid,) number of the piece of every cell, -1 on cells of no block. means: from the
        numbers of all cells in the order of the blocks, the mean displacement (m pieces, m pieces), m/Pa, of one
        piece by a unit load shared by the cells of another.
        """
        many = len(components)
        index = np.concatenate([patch.cells.ravel() for patch in patches])
        belongs = pieces[index]
        count = int(belongs.max()) + 1
        blocks: list[tuple[IntArray, Array]] = []
        for patch in patches:
            size = patch.cells.shape[1]
            matrix = patch.compliance[list(components)][:, :, list(components)].reshape(many * size, many * size)
            blocks.append((patch.cells, np.linalg.inv(matrix)))
        units = np.zeros((many * count, many, pieces.size))
        for component in range(many):
            units[component * count + belongs, component, index] = 1.0
        through = _through(blocks, units)
        spread = through[:, :, index].reshape(many * count, -1).T
        summed = np.einsum("upc,vpc->uv", units[:, :, index], through[:, :, index], optimize=True)
        coarse = means(index)
        bound = coarse @ np.linalg.inv(np.eye(len(coarse)) + summed @ coarse)
        single = tuple((cells, inverse.astype(np.float32)) for cells, inverse in blocks)
        symmetric = (0.5 * (bound + bound.T)).astype(np.float32)
        return cls((), components, 0, single, spread.astype(np.float32), symmetric, index)

    def __call__(self, fields: Array) -> Array:
        """As of `StripInverse`."""
        many = len(self.components)
        flat = fields.reshape(many, -1).astype(np.float32, copy=False)
        loads = _through(self.blocks, flat[None])[0]
        loads[:, self.index] -= (
            self.spread @ (self.bound @ (flat[:, self.index].reshape(-1) @ self.spread))
        ).reshape(many, -1)
        return np.asarray(loads.reshape(fields.shape))


def _through(blocks: list[tuple[IntArray, Array]] | tuple[tuple[IntArray, Array], ...], fields: Array) -> Array:
    """Loads (k, m, cells) that displace the blocks alone by fields (k, m, cells)."""
    loads = np.zeros_like(fields)
    many = fields.shape[1]
    for cells, inverse in blocks:
        number, count = cells.shape
        gathered = fields[:, :, cells].swapaxes(1, 2).reshape(len(fields), number, -1)
        loads[:, :, cells] = (gathered @ inverse).reshape(len(fields), number, many, count).swapaxes(1, 2)
    return loads
