"""The road and the wheels of its axles to one scale: layers with their thickness, tires with their width."""

from __future__ import annotations

import json
from dataclasses import dataclass

from treadload.app.figure_place import Place
from treadload.case import Case
from treadload.errors import TreadloadError
from treadload.materials.kinds import elastic_part
from treadload.pavement import Pavement, is_bituminous
from treadload.plots.interactive.us_figure import in_display_units
from treadload.tire import Tire
from treadload.tire.tread import ProfileSurface

# Metres of wheel that are drawn above the road, of the last layer below it, beside the wheels, between two axles.
_WHEEL, _LAST, _BESIDE, _BETWEEN = 0.14, 0.12, 0.15, 0.3
# Axles side by side at most; pixels of the panel across, of its margins, between two names.
_AXLES, _ACROSS, _RIGHT, _TOP, _BOTTOM, _LINE = 3, 262, 104, 22, 42, 12
_INK, _FAINT = "#8a94a0", "rgba(138,148,160,.16)"
# Bound layers are darker than unbound ones, from the top down.
_BOUND, _UNBOUND = (
    ("rgba(128,140,155,.62)", "rgba(128,140,155,.42)"),
    ("rgba(190,140,80,.42)", "rgba(190,140,80,.28)"),
)


@dataclass(frozen=True)
class _Axle:
    """Wheels of an axle. wheels: x and y of each, m. width: of the tire, m; 0 where only its file knows it."""

    name: str
    wheels: tuple[tuple[float, float], ...]
    width: float

    @property
    def across(self) -> tuple[float, float]:
        """The outer sides of the wheels, m."""
        places = [y for _, y in self.wheels]
        return min(places) - self.width / 2, max(places) + self.width / 2

    @property
    def label(self) -> str:
        """The name, and how many axles stand behind each other."""
        rows = len({x for x, _ in self.wheels})
        return f"{self.name}{f', {rows} axles' if rows > 1 else ''}"


class RoadDrawing:
    """A place for the drawing, on the page that is being built."""

    def __init__(self) -> None:
        self._place = Place("road", "the road and the wheels of its axles, to scale")
        self._drawn = ""

    def draw(self, case: Case | None) -> None:
        """Draw the road and axles of a case; what stood there stays where its numbers are wrong."""
        if case is None or case.pavement is None:
            return
        try:
            figure = json.dumps(drawing_of(case.pavement.untempered(), _axles(case)))
        except TreadloadError:
            return
        if figure != self._drawn:
            self._drawn = figure
            self._place.draw(figure)


def _axles(case: Case) -> list[_Axle]:
    """Axles with different wheels; one wheel of a case without a traffic."""
    width = _width(case)
    if case.traffic is None:
        return [_Axle("wheel", ((0.0, 0.0),), width)]
    axles: list[_Axle] = []
    for kind in case.build_traffic().classes:
        tread = width if kind.tire is None else _width_of(kind.tire)
        name = kind.name.partition(", ")[0]
        if not any(axle.wheels == kind.wheels and axle.width == tread for axle in axles):
            axles.append(_Axle(name, kind.wheels, tread))
    return axles[:_AXLES]


def _width(case: Case) -> float:
    """Width of the tread of the case's tire, m; 0 where a file of a scan holds it."""
    if case.tire is None or case.tire.profile is None:
        return 0.0
    return _width_of(case.build_tire())


def _width_of(tire: Tire) -> float:
    return float(tire.surface.profile.width) if isinstance(tire.surface, ProfileSurface) else 0.0


def drawing_of(road: Pavement, axles: list[_Axle]) -> dict[str, object]:
    """The figure, as plotly reads it, in the units of display; one scale for both axes."""
    spans = [(axle.across, axle) for axle in axles]
    total = sum(high - low for (low, high), _ in spans) + 2 * _BESIDE + _BETWEEN * (len(spans) - 1)
    depths = [0.0, *(float(depth) for depth in road.interfaces)]
    if len(depths) <= len(road.layers):
        depths.append(depths[-1] + _LAST)
    shapes: list[dict[str, object]] = []
    notes: list[dict[str, object]] = []
    scale = (_ACROSS - _RIGHT) / total
    down = -1e9
    for number, layer in enumerate(road.layers):
        top, end = depths[number], depths[number + 1]
        colours = _UNBOUND if is_bituminous(elastic_part(layer.material)) is False and number else _BOUND
        shapes.append(_box(0.0, -top, total, -end, colours[number % 2]))
        thickness = "" if layer.thickness is None else f" {1e3 * layer.thickness:g} mm"
        # Names stand a line apart; a thin layer's is led to it.
        middle = scale * (top + end) / 2
        down = max(middle, down + _LINE)
        notes.append(
            {"x": 1e3 * total, "y": -500 * (top + end), "ax": 10, "ay": down - middle, "xanchor": "left",
             "text": f"{(layer.name or f'layer {number + 1}')[:16]}{thickness}", "showarrow": True, "arrowhead": 0,
             "arrowwidth": 0.7, "arrowcolor": _INK, "font": {"size": 10, "color": _INK}}
        )  # fmt: skip
    at = _BESIDE
    for (low, high), axle in spans:
        for y in sorted({y for _, y in axle.wheels}):
            left = at + y - low - axle.width / 2
            shapes.append(_box(left, _WHEEL, left + axle.width, 0.0, _FAINT, _INK))
        width = f"{1e3 * axle.width:.0f} mm tread" if axle.width else "width from its file"
        notes.append(
            {"x": 1e3 * (at + (high - low) / 2), "y": 1e3 * _WHEEL, "text": axle.label, "showarrow": False,
             "yanchor": "bottom", "font": {"size": 10, "color": _INK}, "hovertext": width}
        )  # fmt: skip
        at += high - low + _BETWEEN
    deepest = depths[-1]
    height = scale * (deepest + _WHEEL) + _TOP + _BOTTOM
    axis = {"showgrid": False, "zeroline": False, "fixedrange": True}
    ticks = {"ticks": "outside", "tickfont": {"size": 10}, "nticks": 4}
    _, layout = in_display_units(
        [],
        {
            "height": max(height, down + scale * _WHEEL + _TOP + _BOTTOM), "showlegend": False, "shapes": shapes,
            "annotations": notes, "margin": {"l": 6, "r": _RIGHT, "t": _TOP, "b": _BOTTOM},
            "font": {"size": 10, "color": _INK}, "paper_bgcolor": "rgba(0,0,0,0)", "plot_bgcolor": "rgba(0,0,0,0)",
            "xaxis": {**axis, **ticks, "range": [0, 1e3 * total], "title": {"text": _caption(axles), "standoff": 2}},
            "yaxis": {**axis, "visible": False, "range": [-1e3 * deepest, 1e3 * _WHEEL], "scaleanchor": "x",
                      "title": {"text": "(mm)"}, "scaleratio": 1, "constrain": "domain"},
        },
    )  # fmt: skip
    return {"data": [], "layout": layout}


def _caption(axles: list[_Axle]) -> str:
    widths = sorted({round(1e3 * axle.width) for axle in axles if axle.width})
    tread = f"tread {' or '.join(map(str, widths))} mm wide" if widths else "width of the tread from its file"
    return f"(mm); {tread}"


def _box(left: float, top: float, right: float, bottom: float, fill: str, line: str = "") -> dict[str, object]:
    return {"type": "rect", "x0": 1e3 * left, "y0": 1e3 * top, "x1": 1e3 * right, "y1": 1e3 * bottom,
            "fillcolor": fill, "line": {"width": 1.5 if line else 0, "color": line or _INK}}  # fmt: skip
