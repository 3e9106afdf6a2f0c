"""Files of tables in the user's cache folder: written whole or not at all, and the oldest of many are removed.

TREADLOAD_CACHE names another folder; empty, nothing is kept on the disk.
"""

from __future__ import annotations

import contextlib
import io
import os
import zipfile
from pathlib import Path

import numpy as np
import platformdirs

from treadload.errors import TreadloadError
from treadload.files import write_whole
from treadload.kernels.arrays import Array


def cache_file(kind: str, name: str) -> Path | None:
    """Path of a file of the cache; None where nothing is kept on the disk. kind: the folder of such tables."""
    folder = os.environ.get("TREADLOAD_CACHE")
    if folder == "":
        return None
    place = Path(folder) if folder else platformdirs.user_cache_path("treadload", appauthor=False)
    return place / kind / name


def read_arrays(path: Path, names: tuple[str, ...]) -> list[Array] | None:
    """Arrays of a file; None where there is none, or where it is damaged."""
    try:
        with np.load(path, allow_pickle=False) as stored:
            return [stored[name] for name in names]
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
        return None


def content_of(description: str, arrays: dict[str, Array]) -> bytes:
    """What a file of arrays holds, the text that describes them among it."""
    content = io.BytesIO()
    np.savez(content, description=description, **arrays)  # type: ignore[arg-type]
    return content.getvalue()


def keep_arrays(path: Path, description: str, arrays: dict[str, Array], most: int) -> None:
    """Write a file, where that can be done, and remove the oldest of its folder beyond so many."""
    # A folder that cannot be written costs time, and no result.
    with contextlib.suppress(OSError, TreadloadError):
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(path, content_of(description, arrays), sync=False)
        files = sorted(path.parent.glob("*.npz"), key=lambda file: file.stat().st_mtime)
        for file in files[:-most]:
            file.unlink(missing_ok=True)
