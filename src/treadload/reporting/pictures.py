"""Figures as pictures inside a page."""

from __future__ import annotations

import base64
import struct
import warnings
from collections.abc import Callable
from dataclasses import dataclass

from matplotlib.figure import Figure

from treadload.errors import InputError
from treadload.plots import png

_DPI = 140.0
# Pixels of the page for an inch of a figure.
_PAGE_DPI = 98.0


@dataclass(frozen=True)
class Picture:
    """A figure in the page. source: data URI. width: of the page, pixels. wide: takes the full width."""

    title: str
    caption: str
    source: str
    width: int
    wide: bool


def picture(title: str, caption: str, draw: Callable[[], Figure], wide: bool = False) -> list[Picture]:
    """The picture, or nothing when the results lack what it draws."""
    with warnings.catch_warnings():
        # Of a single row of cells, or a single place, matplotlib finds no extent to draw.
        for said in ("constrained_layout not applied", "Attempting to set identical low and high"):
            warnings.filterwarnings("error", said, UserWarning)
        try:
            image = png(draw(), dpi=_DPI)
        except (InputError, UserWarning):
            return []
    # The width stands at a fixed place of every PNG; all figures get letters of the same size.
    (pixels,) = struct.unpack(">I", image[16:20])
    encoded = base64.b64encode(image).decode("ascii")
    return [Picture(title, caption, f"data:image/png;base64,{encoded}", round(pixels * _PAGE_DPI / _DPI), wide)]
