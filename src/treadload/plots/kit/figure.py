"""New figures, which a notebook shows by themselves."""

from __future__ import annotations

import io
import os
import struct
from typing import IO

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from treadload.files import write_whole
from treadload.plots.kit.files import png
from treadload.plots.kit.style import figure_of

# Points per inch of the picture in a notebook, and those of the page it stands on.
_SHARP, _PAGE = 200.0, 100.0
# Pixels across a small picture: twice those of a page, so that it is sharp on every screen.
_ACROSS = 720


class ShownFigure(Figure):
    """A matplotlib Figure that a notebook shows where it is the last line of a cell.

    pyplot does not know our figures, so that nothing global changes and none is drawn twice. Without pyplot a
    notebook has no way of its own to show a Figure; this one brings it. Where `%matplotlib inline` brought another
    before, that one serves, once.
    """

    def savefig(
        self,
        fname: str | os.PathLike[str] | IO[bytes],
        *,
        transparent: bool | None = None,
        format: str | None = None,
        **how: object,
    ) -> None:
        """Write the figure as matplotlib does, whole or not at all: an old picture stays where this fails.

        fname: path or stream. format: "png", "pdf", ...; the file extension of the path if left out. how: as of
        `matplotlib.figure.Figure.savefig`. Raises WriteError where the disk is full, read-only or gone.
        """
        if not isinstance(fname, str | os.PathLike):
            return super().savefig(fname, transparent=transparent, format=format, **how)
        path = os.fspath(fname)
        kind = format or os.path.splitext(path)[1][1:]
        if not kind:
            kind = self.canvas.get_default_filetype()
            path = f"{path.rstrip('.')}.{kind}"
        stream = io.BytesIO()
        super().savefig(stream, transparent=transparent, format=kind, **how)
        write_whole(path, stream.getvalue())

    def thumbnail(self) -> bytes:
        """A small PNG of the figure."""
        return png(self, dpi=_ACROSS / self.get_figwidth())

    def _repr_png_(self) -> tuple[bytes, dict[str, object]]:
        image = png(self, dpi=_SHARP)
        # Width and height stand at a fixed place of every PNG.
        pixels = struct.unpack(">II", image[16:24])
        width, height = (round(side * _PAGE / _SHARP) for side in pixels)
        return image, {"width": width, "height": height}


def new_figure(width: float, height: float, layout: str = "constrained") -> Figure:
    """An empty figure. width, height: inches. layout: of matplotlib, "constrained" or "compressed".

    >>> figure = tl.plots.new_figure(6.0, 4.0)
    >>> ax = figure.add_subplot()
    >>> [f"{length:g} inches" for length in figure.get_size_inches()]
    ['6 inches', '4 inches']
    """
    return ShownFigure(figsize=(width, height), layout=layout)  # type: ignore[arg-type]


def figure_and_axes(ax: Axes | None, width: float, height: float) -> tuple[Figure, Axes]:
    """The figure (inches) of a new pair of axes, or of the axes given."""
    if ax is not None:
        return figure_of(ax), ax
    figure = new_figure(width, height)
    return figure, figure.add_subplot()
