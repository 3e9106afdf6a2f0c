"""Figures on the page: the browser draws the text that the process of a session made; the server does not read it."""

from __future__ import annotations

import json

from nicegui import ui

from treadload.plots.interactive.view import CONFIG


class Place:
    """Where a figure is drawn. name: one of the page. words: for who does not see it."""

    def __init__(self, name: str, words: str) -> None:
        self.name, self._client = name, ui.context.client
        self._element = ui.element("div").classes(f"figure {name}")
        self._element.props(f'role="group" aria-label="{words}"')

    def draw(self, figure: str, mark: str = "", *, add: bool = False) -> None:
        """Draw a figure, given as JSON; the newest wins. mark: stands on the body of the page once it is drawn.

        add: True to add its traces to what stands there.
        """
        told = ", ".join(json.dumps(one) for one in (self.name, figure, mark, CONFIG, add))
        with self._client:
            ui.run_javascript(f"treadloadDraw({told})")
