"""Compliances of tread blocks, kept in memory and in the user's cache folder beside those of sections.

As `section_tables`: a file holds one table, for E = 1 Pa, is written whole or not at all, and is made again, without
a word, where it is missing, damaged, or of another version.
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import os
import zipfile
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np
import platformdirs

from treadload.errors import TreadloadError
from treadload.files import write_whole
from treadload.kernels.arrays import Array
from treadload.kernels.sections import Block, FaceCells, block_compliance

# Raised with every change of the elements or of what a file holds.
_VERSION = 1
# Tables in memory, and on the disk: one to ten MB each.
_KEPT, _MOST_FILES = 32, 80
# Lengths are compared to so many decimals of a metre: blocks that differ by round-off share a table.
_DECIMALS = 9
_Key = tuple[tuple[tuple[float, float], ...], float, float]


def block_table(block: Block, poisson: float, cells: FaceCells) -> Array:
    """As `block_compliance`, solved or taken from an earlier time. Read-only."""
    centres = tuple((round(float(x), _DECIMALS) + 0.0, round(float(y), _DECIMALS) + 0.0) for x, y in cells.centres)
    key = centres, round(cells.dx, _DECIMALS), round(cells.dy, _DECIMALS)
    return _table(_rounded(block), float(poisson), key)


@lru_cache(maxsize=_KEPT)
def _table(block: Block, poisson: float, key: _Key) -> Array:
    centres, dx, dy = key
    description = f"treadload block {_VERSION}: {block!r}, poisson {poisson!r}, cells {key!r}"
    path = _path(description)
    table = None if path is None else _read(path, description, 3 * len(centres))
    if table is None:
        table = block_compliance(block, poisson, FaceCells(np.array(centres), dx, dy))
        if path is not None:
            _write(path, description, table)
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


def _path(description: str) -> Path | None:
    """Where a table lies; None where tables are not kept on the disk."""
    folder = os.environ.get("TREADLOAD_CACHE")
    if folder == "":
        return None
    place = Path(folder) if folder else platformdirs.user_cache_path("treadload", appauthor=False)
    return place / "blocks" / f"{hashlib.sha256(description.encode()).hexdigest()[:32]}.npz"


def _read(path: Path, description: str, size: int) -> Array | None:
    """The table of a file; None where there is none, or where it does not hold what it should."""
    try:
        with np.load(path, allow_pickle=False) as stored:
            about, compliance = stored["description"], stored["compliance"]
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
        return None
    sound = str(about) == description and compliance.shape == (size, size) and bool(np.isfinite(compliance).all())
    return np.asarray(compliance) if sound else None


def _write(path: Path, description: str, table: Array) -> None:
    """Write the file of a table, where that can be done, and remove the oldest of many."""
    content = io.BytesIO()
    np.savez(content, description=description, compliance=table)
    # A folder that cannot be written costs time, and no result.
    with contextlib.suppress(OSError, TreadloadError):
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(path, content.getvalue(), sync=False)
        files = sorted(path.parent.glob("*.npz"), key=lambda file: file.stat().st_mtime)
        for file in files[:-_MOST_FILES]:
            file.unlink(missing_ok=True)
