"""What `.plot` of all classes of results has in common."""

from __future__ import annotations

from typing import ClassVar

from treadload.composing import Source
from treadload.plots.kit.files import png

# Pixels across a small picture: twice those of a page, so that it is sharp on every screen.
_ACROSS = 720


class Figures:
    """Figures of a result, or of its dataset. Each returns a matplotlib Figure.

    main: name of the one that stands for it where there is little room; "" for none.
    """

    main: ClassVar[str] = ""

    def __init__(self, result: Source) -> None:
        self._result = result

    def thumbnail(self) -> bytes | None:
        """A small PNG of the main figure; None where none can be drawn without a question."""
        if not self.main:
            return None
        figure = getattr(self, self.main)()
        return png(figure, dpi=_ACROSS / figure.get_figwidth())
