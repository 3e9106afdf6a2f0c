"""Figures as pictures inside a page."""

from __future__ import annotations

import base64
import functools
import io
import os
import warnings
from collections.abc import Callable, Collection, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from matplotlib.figure import Figure

# Pillow comes with matplotlib.
from PIL import Image, features

from treadload.deferred import xarray as xr
from treadload.errors import InputError, one_line
from treadload.figure_registry import Drawing, RegisteredFigure, classes_of, figures_of
from treadload.plots import raster
from treadload.us_units import sentence_in_display_units

_DPI = 125.0
# Pixels of the page for an inch of a figure.
_PAGE_DPI = 98.0


@dataclass(frozen=True)
class Picture:
    """A figure in the page. width: of the page, pixels. wide: takes the full width.

    encoded: its data URI, once it is encoded; None where there is no figure.
    missing: why there is none, a sentence that stands in its place. rank: how well it answers what the result was
    asked, 0 for a figure among others, more for the main one of a result, most for that of an assessment.
    """

    title: str
    caption: str
    encoded: Future[str] | None
    width: int
    wide: bool
    missing: str = ""
    rank: int = 0

    @property
    def source(self) -> str:
        """The figure as a data URI; waits until it is encoded."""
        return "" if self.encoded is None else self.encoded.result()


def picture(title: str, caption: str, draw: Callable[[], Figure], wide: bool = False) -> list[Picture]:
    """The picture; where it cannot be drawn a sentence in its place that states why."""
    with warnings.catch_warnings():
        # Of a single row of cells, or a single place, matplotlib finds no extent to draw.
        for message in ("constrained_layout not applied", "Attempting to set identical low and high"):
            warnings.filterwarnings("error", message, UserWarning)
        try:
            image = raster(draw(), dpi=_DPI)
        # Minutes of other figures are not lost for one that fails, whatever it raises.
        except Exception as error:
            return [_missing(title, caption, wide, error)]
    # All figures get letters of the same size.
    encoded = _encoders().submit(_as_data, image)
    return [Picture(title, caption, encoded, round(image.width * _PAGE_DPI / _DPI), wide)]


@functools.cache
def _encoders() -> ThreadPoolExecutor:
    # Pillow encodes without Python's lock: beside the drawing of the next figure.
    return ThreadPoolExecutor(1, thread_name_prefix="treadload-pictures")


if hasattr(os, "register_at_fork"):
    # A process that was forked has the pool and not its thread: it would wait for ever.
    os.register_at_fork(after_in_child=_encoders.cache_clear)


def pictures_of(
    result: str,
    datasets: Sequence[xr.Dataset],
    beside: Mapping[str, xr.Dataset],
    left_out: Collection[Callable[..., object]] = (),
) -> list[Picture]:
    """The registered figures of results of a class, in their order.

    result: name of the class. beside: the other results of the case, by kind. left_out: functions not to be drawn.
    """
    pictures: list[Picture] = []
    for figure in figures_of(*classes_of(result)):
        for data in datasets if figure.draw not in left_out else ():
            drawn = _drawn(figure, partial(figure.drawings, data, beside), data)
            rank = 2 * figure.answers + figure.main
            pictures += [replace(each, rank=rank if k == 0 else 0) for k, each in enumerate(drawn)]
    return pictures


def negligible_of(result: str, datasets: Sequence[xr.Dataset], beside: Mapping[str, xr.Dataset]) -> list[str]:
    """Figures that would show nothing, each as a sentence. result, datasets, beside: as of `pictures_of`."""
    left_out = []
    for figure in figures_of(*classes_of(result)):
        for data in datasets:
            try:
                left_out += figure.negligible(data, beside)
            # It has a sentence among the pictures.
            except Exception:
                continue
    return [f"{drawing.title}: {sentence_in_display_units(drawing.negligible)}." for drawing in left_out]


def draw_all(figure: RegisteredFigure, datasets: list[xr.Dataset], labels: list[str]) -> list[Picture]:
    """The pictures of a registered comparison of several cases."""
    drawn = _drawn(figure, partial(figure.drawings_of_several, datasets), datasets, labels)
    return [replace(each, rank=2 * figure.answers if k == 0 else 0) for k, each in enumerate(drawn)]


def _drawn(figure: RegisteredFigure, drawings: Callable[[], list[Drawing]], *arguments: object) -> list[Picture]:
    try:
        wanted = drawings()
    # What decides whether a figure is shown may be another package's, and fail in any way.
    except Exception as error:
        return [_missing(figure.name.replace("_", " ").capitalize(), "", figure.wide, error)]
    draw: Any = figure.draw
    return [
        shown
        for each in wanted
        for shown in picture(
            sentence_in_display_units(each.title),
            sentence_in_display_units(each.caption),
            partial(draw, *arguments, **each.options),
            figure.wide,
        )
    ]


def _missing(title: str, caption: str, wide: bool, error: Exception) -> Picture:
    return Picture(title, caption, None, 0, wide, f"This figure could not be drawn: {_reason(error)}.")


def _as_data(image: Image.Image) -> str:
    """An image inside a page: as WebP without loss, a third smaller than PNG, where this Pillow writes it."""
    stream = io.BytesIO()
    if features.check("webp"):
        kind = "webp"
        image.save(stream, kind, lossless=True, quality=20, method=1)
    else:
        kind = "png"
        image.save(stream, kind, compress_level=4)
    return f"data:image/{kind};base64,{base64.b64encode(stream.getvalue()).decode('ascii')}"


def _reason(error: Exception) -> str:
    if isinstance(error, UserWarning):
        return "there is no extent to draw, a single row of cells or a single place"
    if isinstance(error, KeyError) and error.args:
        return f"the result lacks {one_line(str(error.args[0]))!r}"
    reason = one_line(str(error)).rstrip(".") or "no reason given"
    return reason if isinstance(error, InputError) else f"{type(error).__name__}, {reason}"
