"""Figures as files and as bytes."""

from __future__ import annotations

import io
from os import PathLike
from pathlib import Path
from typing import Any, BinaryIO

from matplotlib.figure import Figure

from treadload.errors import InputError
from treadload.files import replacing
from treadload.plots.style import house_style, styled

_FORMATS = {".png": "png", ".svg": "svg", ".pdf": "pdf"}


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
    with replacing(path) as temporary, temporary.open("wb") as stream:
        _draw(figure, stream, kind, resolution)
    return Path(path)


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
