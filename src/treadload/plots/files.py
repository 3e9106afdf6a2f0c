"""Files that are whole or not there."""

from __future__ import annotations

import io
import os
import tempfile
from collections.abc import Callable
from os import PathLike
from pathlib import Path
from typing import Any, BinaryIO

from matplotlib.figure import Figure

from treadload.errors import InputError
from treadload.plots.style import house_style, styled

_FORMATS = {".png": "png", ".svg": "svg", ".pdf": "pdf"}


def write_whole(path: str | PathLike[str], write: Callable[[BinaryIO], None]) -> Path:
    """Write a file under another name and rename it when it is complete.

    path: of the file. write: called with the open file. Returns the path.
    Raises InputError if the folder is missing or cannot be written; a file from before stays as it was.
    """
    target = Path(path)
    if target.is_dir():
        raise InputError(f"cannot write {str(target)!r}: it is a folder; give the name of a file in it")
    if not target.parent.is_dir():
        raise InputError(f"cannot write {str(target)!r}: there is no folder {str(target.parent)!r}; make it first")
    temporary = ""
    try:
        handle, temporary = tempfile.mkstemp(prefix=f".{target.name}.", suffix=".part", dir=target.parent)
        with os.fdopen(handle, "wb") as stream:
            write(stream)
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(temporary, 0o666 & ~mask)
        os.replace(temporary, target)
        temporary = ""
    except OSError as error:
        raise InputError(f"cannot write {str(target)!r}: {error.strerror or error}") from error
    finally:
        if temporary:
            Path(temporary).unlink(missing_ok=True)
    return target


@styled
def save(figure: Figure, path: str | PathLike[str], *, dpi: float | None = None) -> Path:
    """Write a figure as PNG, SVG or PDF, by the ending of the path.

    figure: from any function of this package. path: of the file. dpi: points per inch of pixels, 180 if left out.
    Returns the path. Raises InputError for an unknown ending or a path that cannot be written.
    """
    kind = _FORMATS.get(Path(path).suffix.lower())
    if kind is None:
        raise InputError(
            f"a figure cannot be written as {Path(path).suffix or 'a file without ending'!r}; "
            f"use one of {', '.join(_FORMATS)}"
        )
    resolution = 180.0 if dpi is None else dpi
    return write_whole(path, lambda stream: _draw(figure, stream, kind, resolution))


def png(figure: Figure, *, dpi: float = 160.0) -> bytes:
    """A figure as the bytes of a PNG. dpi: points per inch."""
    stream = io.BytesIO()
    with house_style():
        _draw(figure, stream, "png", dpi)
    return stream.getvalue()


def _draw(figure: Figure, stream: BinaryIO, kind: str, dpi: float) -> None:
    # No date inside, so that equal figures are equal files. Trimmed, as maps of true scale leave paper beside them.
    metadata: dict[str, dict[str, Any]] = {"svg": {"Date": None}, "pdf": {"CreationDate": None}, "png": {}}
    figure.savefig(stream, format=kind, dpi=dpi, metadata=metadata[kind], bbox_inches="tight", pad_inches=0.08)
