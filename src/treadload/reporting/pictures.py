"""Figures as pictures inside a page."""

from __future__ import annotations

import base64
import io
import struct
import warnings
from collections.abc import Callable
from dataclasses import dataclass

from matplotlib.figure import Figure

# Pillow comes with matplotlib.
from PIL import Image, features

from treadload.errors import InputError, one_line
from treadload.plots import png

_DPI = 125.0
# Pixels of the page for an inch of a figure.
_PAGE_DPI = 98.0


@dataclass(frozen=True)
class Picture:
    """A figure in the page. source: data URI. width: of the page, pixels. wide: takes the full width.

    missing: why there is none, a sentence that stands in its place.
    """

    title: str
    caption: str
    source: str
    width: int
    wide: bool
    missing: str = ""


def picture(title: str, caption: str, draw: Callable[[], Figure], wide: bool = False) -> list[Picture]:
    """The picture; where it cannot be drawn a sentence in its place that says why."""
    with warnings.catch_warnings():
        # Of a single row of cells, or a single place, matplotlib finds no extent to draw.
        for said in ("constrained_layout not applied", "Attempting to set identical low and high"):
            warnings.filterwarnings("error", said, UserWarning)
        try:
            image = png(draw(), dpi=_DPI)
        # Minutes of other figures are not lost for one that fails, whatever it raises.
        except Exception as error:
            return [Picture(title, caption, "", 0, wide, f"This figure could not be drawn: {_reason(error)}.")]
    # The width stands at a fixed place of every PNG; all figures get letters of the same size.
    (pixels,) = struct.unpack(">I", image[16:20])
    return [Picture(title, caption, _as_data(image), round(pixels * _PAGE_DPI / _DPI), wide)]


def _as_data(image: bytes) -> str:
    """A PNG inside a page: as WebP without loss, a third smaller, where this Pillow writes it."""
    kind = "png"
    if features.check("webp"):
        stream = io.BytesIO()
        with Image.open(io.BytesIO(image)) as picture:
            picture.convert("RGB").save(stream, "webp", lossless=True, quality=20, method=1)
        kind, image = "webp", stream.getvalue()
    return f"data:image/{kind};base64,{base64.b64encode(image).decode('ascii')}"


def _reason(error: Exception) -> str:
    if isinstance(error, UserWarning):
        return "there is no extent to draw, a single row of cells or a single place"
    said = one_line(str(error)).rstrip(".") or "no reason given"
    return said if isinstance(error, InputError) else f"{type(error).__name__}, {said}"
