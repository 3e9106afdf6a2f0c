"""Figures on the page: the browser draws the text that the process of a session made; the server does not read it."""

from __future__ import annotations

from nicegui import ui

from treadload.app.elements import call_script, with_attributes
from treadload.plots.interactive.view import CONFIG


class Place:
    """Where a figure is drawn. name: one of the page. words: for who does not see it."""

    def __init__(self, name: str, words: str) -> None:
        self.name, self._client = name, ui.context.client
        self._element = with_attributes(ui.element("div"), role="group", aria_label=words)
        self._element.classes.extend(("figure", name))

    def draw(self, figure: str, mark: str = "", *, add: bool = False) -> None:
        """Draw a figure, given as JSON; the newest wins. mark: stands on the body of the page once it is drawn.

        add: True to add its traces to what stands there.
        """
        with self._client:
            call_script("treadloadDraw", self.name, figure, mark, CONFIG, add)
