"""Compliances of tread blocks, kept in memory and in the user's cache folder beside those of sections.

As `section_tables`: a file holds one table, for E = 1 Pa, is written whole or not at all, and is made again, without
a word, where it is missing, damaged, or of another version.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from treadload.contact.bodies.kept_files import cache_file, keep_arrays, read_arrays
from treadload.kernels.arrays import Array, IntArray
from treadload.kernels.sections import Block, FaceCells, block_compliance

# Raised with every change of the elements or of what a file holds.
_VERSION = 1
# Tables in memory, and on the disk: one to ten MB each.
_KEPT, _MOST_FILES = 32, 80
# Lengths are compared to so many decimals of a metre: blocks that differ by round-off share a table.
_DECIMALS = 9
_Key = tuple[tuple[tuple[float, float], ...], float, float]


@dataclass(frozen=True, eq=False)
class BlockTable:
    """Compliance of the cells of a block or of its image.

    compliance: (3 n, 3 n), m/Pa, of E = 1 Pa, as of `block_compliance`, shared by all blocks of the shape: read-only.
    order: (n,) numbers of the cells as they come in it. is_mirrored: True where it is that of the image in y = 0.
    """

    compliance: Array
    order: IntArray
    is_mirrored: bool


def block_table(block: Block, poisson: float, cells: FaceCells) -> BlockTable:
    """As `block_compliance`, solved or taken from an earlier time; a block and its image share a table."""
    plain, order = _key_of(cells, 1.0)
    image, image_order = _key_of(cells, -1.0)
    upright, turned = _rounded(block), _rounded(block.mirrored)
    # Any rule will do that picks the same for a block and for its image.
    if (repr(turned), image) < (repr(upright), plain):
        return BlockTable(_table(turned, float(poisson), image), image_order, True)
    return BlockTable(_table(upright, float(poisson), plain), order, False)


def _key_of(cells: FaceCells, side: float) -> tuple[_Key, IntArray]:
    """Middles in a fixed order, with y turned round by a sign, and the sizes of the cells; and that order."""
    centres = np.round(cells.centres * np.array([1.0, side]), _DECIMALS) + 0.0
    order = np.lexsort((centres[:, 0], centres[:, 1]))
    listed = tuple((float(x), float(y)) for x, y in centres[order])
    return (listed, round(cells.dx, _DECIMALS), round(cells.dy, _DECIMALS)), order


@lru_cache(maxsize=_KEPT)
def _table(block: Block, poisson: float, key: _Key) -> Array:
    centres, dx, dy = key
    description = f"treadload block {_VERSION}: {block!r}, poisson {poisson!r}, cells {key!r}"
    path = cache_file("blocks", f"{hashlib.sha256(description.encode()).hexdigest()[:32]}.npz")
    table = None if path is None else _read(path, description, 3 * len(centres))
    if table is None:
        table = block_compliance(block, poisson, FaceCells(np.array(centres), dx, dy))
        if path is not None:
            keep_arrays(path, description, {"compliance": table}, _MOST_FILES)
    table.flags.writeable = False
    return table


def _rounded(block: Block) -> Block:
    def near(values: tuple[float, float, float, float]) -> tuple[float, float, float, float]:
        left, front, right, rear = (round(value, _DECIMALS) + 0.0 for value in values)
        return left, front, right, rear

    rear_left, front_left, front_right, rear_right = (
        (round(x, _DECIMALS) + 0.0, round(y, _DECIMALS) + 0.0) for x, y in block.corners
    )
    return replace(
        block,
        corners=(rear_left, front_left, front_right, rear_right),
        height=round(block.height, _DECIMALS),
        floors=near(block.floors),
        beside=near(block.beside),
        draft=near(block.draft),
    )


def _read(path: Path, description: str, size: int) -> Array | None:
    """The table of a file; None where there is none, or where it does not hold what it should."""
    stored = read_arrays(path, ("description", "compliance"))
    if stored is None:
        return None
    about, compliance = stored
    sound = str(about) == description and compliance.shape == (size, size) and bool(np.isfinite(compliance).all())
    return np.asarray(compliance) if sound else None
