"""The slice: a line on the maps, the profiles along it and the section of the road below it."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Mapping

from nicegui import ui

from treadload.app.elements import plain
from treadload.app.figure_place import Place

# Of a line as plotly holds it.
_ENDS = ("x0", "y0", "x1", "y1")
_SECTIONS = {
    "principal_strain_1": "largest tensile strain, three-dimensional",
    "in_plane_strain_1": "largest tensile strain, horizontal", "strain_zz": "vertical strain",
    "von_mises_stress": "von Mises stress",
    "mean_stress": "mean stress", "stress_zz": "vertical stress",
}  # fmt: skip


class SlicePanel:
    """Where the line lies and what is below it.

    The browser draws what lies along a line by itself where it holds the fields, which come with the figures.
    cut: called where it does not, and when other fields are wanted. js: calls a function in the browser.
    """

    def __init__(self, cut: Callable[[], object], js: Callable[..., object]) -> None:
        self._cut, self._js = cut, js
        self.line: list[float] | None = None
        self.section_of = "principal_strain_1"

    def build(self) -> None:
        """Put the tools, the profile and the section on the page."""
        with ui.element("div").classes("tools").props('role="group" aria-label="slice"'):
            ui.label("Slice: drag the line on the left map, or put it")
            plain("along travel", lambda: self._js("treadloadPut", {"along": "x", "at": 0})).props('id="along"')
            plain("across", lambda: self._js("treadloadPut", {"along": "y", "at": 0})).props('id="across"')
            with ui.element("span").classes("at"):
                # The browser alone moves it: a value from here would put it back.
                at = ui.element("input").props('type="range" min="-150" max="150" step="1" id="place"')
                at.props('aria-label="place of the slice, mm"')
                at.on("input", js_handler="(told) => treadloadPut({ at: +told.target.value })")
                ui.element("span").classes("place").props('id="placed"')
            section = ui.select(_SECTIONS, value=self.section_of, label="below the line",
                                on_change=lambda event: self._below(event.value))  # fmt: skip
            section.props("dense outlined options-dense").classes("long")
        self._profile = Place("profile", "profiles along the slice")
        self._section = Place("section", "section of the road below the slice")
        ui.on("line", lambda event: self._dragged(event.args))

    def draw(self, figures: dict[str, str]) -> None:
        """Draw those of some figures that are of the slice."""
        for place in (self._profile, self._section):
            if place.name in figures:
                place.draw(figures[place.name])

    def _dragged(self, ends: Mapping[str, float]) -> None:
        """The line lies elsewhere. ends: its ends, mm, and whether the browser has drawn what lies along it."""
        with contextlib.suppress(TypeError, ValueError, KeyError):
            self.line = [float(ends[key]) / 1e3 for key in _ENDS]
            if not ends["drawn"]:
                self._cut()

    def _below(self, name: str) -> None:
        self.section_of = name
        self._cut()
