"""Linked maps of a result as one page: shown in a notebook, or written as a file that needs no network."""

from __future__ import annotations

import functools
import html
import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Any

from treadload import figure_registry
from treadload.composing import Source
from treadload.files import check_suffix, write_whole
from treadload.plots.interactive.browser_grids import profile_held
from treadload.plots.interactive.cut import Cut, profiles
from treadload.plots.interactive.drawing import figure
from treadload.plots.interactive.field import (
    Field,
    damage_field,
    extension_field,
    field_of,
    pressure_field,
    shear_field,
    with_outline,
)
from treadload.plots.interactive.maps import WIDTH, laid_out, linked_maps
from treadload.plots.interactive.places import places_of
from treadload.plots.interactive.solid import tread
from treadload.plots.interactive.theme import FONT, Theme, theme_of
from treadload.plots.kit.plan import MM, fields_of
from treadload.plots.response import VARIABLE

if TYPE_CHECKING:
    from plotly.graph_objects import Figure

PAGE = {".html": "a page", ".htm": "a page"}
CONFIG = {
    "responsive": True, "displaylogo": False, "edits": {"shapePosition": True}, "scrollZoom": True,
    "modeBarButtonsToRemove": ["select2d", "lasso2d", "autoScale2d"],
}  # fmt: skip
"""Settings of plotly for every figure of a page."""


@dataclass(frozen=True, eq=False)
class LinkedView:
    """Linked maps, what lies along a line on them, and more, as figures of plotly on one page.

    figures: "maps", "profile" and "tread" where there is one. A notebook shows it at the end of a cell.
    """

    title: str
    figures: Mapping[str, Any]
    theme: Theme
    load: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    @property
    def height(self) -> int:
        """Of the page, pixels."""
        return int(sum(drawn.layout.height for drawn in self.figures.values()) + 60 + 40 * len(self.warnings))

    def to_html(self) -> str:
        """The whole page with all that it needs inside."""
        look = self.theme
        parts = "".join(
            drawn.to_html(full_html=False, include_plotlyjs=False, config=CONFIG, div_id=f"tl-{name}")
            for name, drawn in self.figures.items()
        )
        warnings = "".join(f'<p class="warning">Warning: {html.escape(text)}</p>' for text in self.warnings)
        below = 'document.getElementById("tl-profile")' if "profile" in self.figures else "null"
        load = json.dumps({"ink": look.ink, "grids": [], **self.load}).replace("<", "\\u003c")
        return (
            f'<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>{html.escape(self.title)}</title>'
            f"<style>body{{margin:0;padding:8px 12px;background:{look.paper};color:{look.ink};font:14px {FONT}}}"
            f"h1{{font-size:16px;margin:2px 0 6px}}.warning{{border-left:3px solid {look.slip};padding:2px 8px;"
            f"margin:4px 0;font-size:13px}}</style><script>{plotly_script()}</script></head><body>"
            f"<h1>{html.escape(self.title)}</h1>{warnings}{parts}<script>{link_script()}"
            f'window.treadloadLink(document.getElementById("tl-maps"),{below},{load});</script></body></html>'
        )

    def write_html(self, path: str | os.PathLike[str]) -> Path:
        """Write the page as one file that opens without a network; it appears whole or not at all. Returns the path.

        Raises InputError for another suffix than .html, and for a path that cannot be written.
        """
        check_suffix(path, PAGE, "a page")
        return write_whole(path, self.to_html())

    def _repr_html_(self) -> str:
        page = html.escape(self.to_html(), quote=True)
        return (
            f'<iframe srcdoc="{page}" sandbox="allow-scripts" style="width:100%;height:{self.height}px;border:0" '
            f'title="{html.escape(self.title, quote=True)}"></iframe>'
        )

    def __repr__(self) -> str:
        return f"<LinkedView: {self.title}; {', '.join(self.figures)}; write_html(path) keeps it>"


@functools.cache
def plotly_script() -> str:
    """The library that draws in the browser, as text. Raises InputError where plotly is not installed."""
    figure([], {}, theme_of("light"))
    from plotly.offline import get_plotlyjs

    return str(get_plotlyjs()).replace("</script", "<\\/script")


@functools.cache
def link_script() -> str:
    """The script that links maps: defines `treadloadLink(maps, below, load)` in the browser."""
    return resources.files("treadload.plots.interactive").joinpath("page.js").read_text(encoding="utf-8")


@figure_registry.figure("Contact", "Footprint", name="interactive")
def contact_view(
    contact: Source, *, measured: Source | None = None, cut: Cut | None = None, theme: str | Theme = "light"
) -> LinkedView:
    """Pressure and shear of a contact as linked maps, the profile along a line that can be dragged, and the tread.

    contact: a contact, a footprint or its dataset. measured: a footprint whose outline is drawn on the pressure and
    whose pressure is drawn along the line. cut: of the line; left out, along travel through the largest pressure.
    theme: "light" or "dark".
    """
    look, data = theme_of(theme), fields_of(contact, "pressure")
    line = cut or Cut.along(data)
    fields = [pressure_field(data)]
    if {"traction_x", "traction_y"} <= set(data.variables):
        fields.append(shear_field(data))
    if measured is not None:
        fields[0] = with_outline(fields[0], measured)
    over = {"measured": measured} if measured is not None else None
    figures = {
        "maps": linked_maps(fields, cut=line, theme=look),
        "profile": profiles(data, line, overlaid=over, theme=look),
    }
    if "initial_gap" in data:
        figures["tread"] = tread(data, theme=look)
    load = {"grids": profile_held(data, over)}
    return LinkedView("Contact", figures, look, load, tuple(getattr(contact, "warnings", ())))


@figure_registry.figure("Response", name="interactive")
def response_view(
    response: Source, *, contact: Source | None = None, cut: Cut | None = None, theme: str | Theme = "light"
) -> LinkedView:
    """Largest extension with its directions, in space and in the plane, at every depth; profiles along a line.

    response: over (depth, y, x). contact: gives the outline. A slider goes through the depths. theme: as before.
    """
    look, data = theme_of(theme), fields_of(response, *VARIABLE.values(), "depth")
    line = cut or Cut.along(data)
    depths = [float(depth) for depth in data["depth"].to_numpy()]
    by_depth = [
        [extension_field(data, depth=depth, strain="principal", contact=contact),
         extension_field(data, depth=depth, strain="in-plane", contact=contact)]
        for depth in depths
    ]  # fmt: skip
    figures = {
        "maps": _through(by_depth, [f"{MM * depth:g} mm" for depth in depths], line, look),
        "profile": profiles(data, line, theme=look),
    }
    load = {"grids": profile_held(data)}
    return LinkedView("Response of the road", figures, look, load, tuple(getattr(response, "warnings", ())))


@figure_registry.figure("Verdict", name="interactive")
def verdict_view(verdict: Source, *, theme: str | Theme = "light") -> LinkedView:
    """Damage of one passage with the traces of cracks beside the extension that was read, and the worst point."""
    look, data = theme_of(theme), fields_of(verdict, "allowable_passes", "extension_strain")
    fields = [damage_field(data), field_of(data, "extension_strain")]
    figures = {"maps": linked_maps(fields, places=places_of(data), theme=look)}
    return LinkedView("Verdict", figures, look, {}, tuple(getattr(verdict, "warnings", ())))


def _through(stages: Sequence[Sequence[Field]], words: Sequence[str], cut: Cut, look: Theme) -> Figure:
    """Linked maps with a slider through stages, each with maps of its own."""
    room = 58.0 if len(stages) > 1 else 0.0
    traces: list[dict[str, Any]] = []
    owner: list[int] = []
    page_notes = []
    layout: dict[str, Any] = {}
    for number, fields in enumerate(stages):
        drawn, page = laid_out(fields, theme=look, width=WIDTH, cut=cut, below=room)
        layout = layout or page
        page_notes.append(page["annotations"])
        traces += [{**trace, "visible": number == 0} for trace in drawn]
        owner += [number] * len(drawn)
    if len(stages) > 1:
        layout["margin"]["b"] += room
        steps = [
            {"label": label, "method": "update",
             "args": [{"visible": [map_ == number for map_ in owner]}, {"annotations": page_notes[number]}]}
            for number, label in enumerate(words)
        ]  # fmt: skip
        layout["sliders"] = [{"steps": steps, "active": 0, "currentvalue": {"prefix": "depth "}, "pad": {"t": 38},
                              "len": 0.5, "font": {"size": 11}}]  # fmt: skip
    return figure(traces, layout, look)
