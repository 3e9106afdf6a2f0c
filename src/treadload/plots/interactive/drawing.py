"""Traces, axes and figures of plotly, which is asked for here alone."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import wrap
from typing import TYPE_CHECKING, Any

import numpy as np

from treadload.errors import InputError, how_to_install
from treadload.kernels.arrays import Array, BoolArray
from treadload.plots.interactive.field import Field
from treadload.plots.interactive.theme import Theme, colour_scale, template
from treadload.plots.interactive.us_figure import in_display_units
from treadload.plots.kit.plan import X_LABEL, Y_LABEL, Plan, borders

if TYPE_CHECKING:
    from plotly.graph_objects import Figure

Trace = dict[str, Any]
# Head of an arrow: share of its length, and half its width over its length.
_HEAD, _WIDE = 0.38, 0.55
# Width of a letter of a title, pixels.
_LETTER = 7.6
_LINE = {"contact": ("muted", 1.0), "stick": ("stick", 2.0), "slip": ("slip", 1.6), "measured": ("ink", 2.2)}


def figure(traces: Sequence[Trace], layout: dict[str, object], theme: Theme) -> Figure:
    """A Figure of plotly in the units of display. Raises InputError where plotly is not installed."""
    try:
        import plotly.graph_objects
    except ImportError as error:
        raise InputError(
            f"interactive figures need plotly, which is not installed; {how_to_install('app')}, or draw with .plot"
        ) from error
    shown, page = in_display_units(traces, layout)
    return plotly.graph_objects.Figure({"data": shown, "layout": {"template": template(theme), **page}})


def cells(field: Field, axes: tuple[str, str], theme: Theme, bar: dict[str, object]) -> Trace:
    """The cells of a map in colour. axes: ("x", "y"), ("x2", "y2"), ... bar: where the colour bar stands."""
    values = field.values.astype(np.float32)
    unit = f" {field.unit}" if field.unit and field.unit != "–" else ""
    zones = field.kind == "zones"
    value_text = "%{z:.4~g}" + unit
    trace: Trace = {
        "type": "heatmap", "x": field.plan.x_edges, "y": field.plan.y_edges, "z": values,
        "xaxis": axes[0], "yaxis": axes[1], "zmin": field.scale.low, "zmax": field.scale.high,
        "colorscale": colour_scale(field.kind, theme.name), "hoverongaps": False, "name": field.name,
        "colorbar": _bar(field, theme, bar),
    }  # fmt: skip
    if zones:
        trace["customdata"] = np.array(["open", "sticks", "slips"])[np.nan_to_num(values).astype(int)]
        value_text = "%{customdata}"
    elif field.logarithmic:
        with np.errstate(over="ignore"):
            trace["customdata"] = 10.0**field.values
        value_text = "%{customdata:.2e}" + unit
    trace["hovertemplate"] = f"x %{{x:.1f}} mm, y %{{y:.1f}} mm<br>{value_text}<extra></extra>"
    return trace


def overlays(field: Field, axes: tuple[str, str], theme: Theme) -> list[Trace]:
    """Outlines, arrows, strokes and the mark of the peak on a map."""
    traces = [_lines(_outline(mask, plan), axes, getattr(theme, _LINE[role][0]), _LINE[role][1], f"outline {role}")
            for mask, plan, role in field.outlines if mask.any()]  # fmt: skip
    for lines, name in ((_arrows(field.arrows), "arrows"), (_strokes(field.strokes), "strokes")):
        if len(lines[0]):
            traces.append(_lines(lines, axes, theme.halo, 3.2, f"{name} halo", 0.7))
            traces.append(_lines(lines, axes, theme.ink, 1.3, name))
    if field.peak is not None:
        x, y, text = field.peak
        peak = marks([(x, y, text)], axes, theme, "peak")
        # Towards the middle of the map, or a long text would leave it, and beside the line of a cut through the peak.
        sides = ((edges[0] + edges[-1]) / 2 for edges in (field.plan.x_edges, field.plan.y_edges))
        right, down = (at > middle for at, middle in zip((x, y), sides, strict=True))
        traces.append(peak | {"textposition": f"{'top' if down else 'bottom'} {'left' if right else 'right'}"})
    return traces


def marks(places: Sequence[tuple[float, float, str]], axes: tuple[str, str], theme: Theme, name: str) -> Trace:
    """Rings on places, x and y in mm, with their texts when one points at them; the peak's stands beside it."""
    if name != "peak":
        look: Trace = {
            "mode": "markers",
            "marker": {
                "symbol": "diamond",
                "size": 11,
                "color": theme.slip,
                "line": {"width": 1.5, "color": theme.halo},
            },
        }
    else:
        # The ring twice: paper around it, so that it shows on dark and bright cells.
        places = [place for place in places for _ in range(2)]
        look = {
            "mode": "markers+text", "cliponaxis": False,
            "textfont": {"color": theme.ink, "size": 11, "weight": "bold", "shadow": _shadow(theme)},
            "marker": {"symbol": "circle-open", "size": 12, "color": [theme.halo, theme.ink] * (len(places) // 2),
                       "line": {"width": [5, 2] * (len(places) // 2)}},
        }  # fmt: skip
    return {
        "type": "scatter", "name": name, "xaxis": axes[0], "yaxis": axes[1], "showlegend": False,
        "x": [x for x, _, _ in places], "y": [y for _, y, _ in places],
        "text": [text.replace("-", "\u2212") for _, _, text in places],
        "hovertemplate": "%{text}<br>x %{x:.1f} mm, y %{y:.1f} mm<extra></extra>", **look,
    }  # fmt: skip


def plan_axes(number: int, plan: Plan, domain: tuple[float, float, float, float]) -> dict[str, object]:
    """Axes of the map of a number, from 1, seen from above at true scale and linked to the first.

    domain: left, right, bottom, top of the page, 0 to 1.
    """
    suffix = "" if number == 1 else str(number)
    along: dict[str, Any] = {
        "domain": list(domain[:2]), "anchor": f"y{suffix}", "title": {"text": X_LABEL},
        "range": [float(plan.x_edges[0]), float(plan.x_edges[-1])],
    }  # fmt: skip
    right: dict[str, Any] = {
        "domain": list(domain[2:]), "anchor": f"x{suffix}", "title": {"text": Y_LABEL}, "scaleanchor": f"x{suffix}",
        "scaleratio": 1, "range": [float(plan.y_edges[-1]), float(plan.y_edges[0])],
    }  # fmt: skip
    if number > 1:
        along["matches"], right["matches"] = "x", "y"
        del right["scaleanchor"], right["scaleratio"]
    return {f"xaxis{suffix}": along, f"yaxis{suffix}": right}


def heading(
    text: str, domain: tuple[float, float, float, float], theme: Theme, lift: float, room: float
) -> dict[str, object]:
    """A title flush left above a part of the page, in two lines at most within the room; pixels, as lift is."""
    lines = wrap(text, max(1, int(room / _LETTER)), max_lines=2, placeholder=" …")
    short = "<br>".join(lines)
    return {
        "text": f"<b>{short}</b>", "hovertext": text if short.endswith("…") else "",
        "x": domain[0], "y": domain[3], "xref": "paper", "yref": "paper", "showarrow": False,
        "xanchor": "left", "yanchor": "bottom", "align": "left", "yshift": lift,
        "font": {"size": 13, "color": theme.ink},
    }  # fmt: skip


def cut_shape(
    start: tuple[float, float], end: tuple[float, float], axes: tuple[str, str], theme: Theme, first: bool
) -> Trace:
    """The line of a cut on a map, mm; that on the first map can be dragged."""
    return {
        "type": "line", "xref": axes[0], "yref": axes[1], "x0": start[0], "y0": start[1], "x1": end[0], "y1": end[1],
        "line": {"color": theme.slip, "width": 2.5, "dash": "solid" if first else "dot"}, "editable": first,
        "name": "cut",
    }  # fmt: skip


def _shadow(theme: Theme) -> str:
    """Paper around letters that lie on a coloured field."""
    return ", ".join(f"{a}px {b}px 2px {theme.halo}" for a in (-1, 0, 1) for b in (-1, 0, 1))


def _bar(field: Field, theme: Theme, where: dict[str, object]) -> dict[str, object]:
    bar: dict[str, Any] = {
        "title": {"text": field.label, "side": "top", "font": {"size": 11}}, "thickness": 11, "outlinewidth": 0.7,
        "outlinecolor": theme.rule, "tickfont": {"size": 10}, "ticks": "outside", "ticklen": 3, "ypad": 0, "xpad": 0,
        "orientation": "h", "xanchor": "left", "yanchor": "bottom", "nticks": 7, **where,
    }  # fmt: skip
    if field.kind == "zones":
        bar |= {"tickvals": [0.167, 1.0, 1.833], "ticktext": ["open", "stick", "slip"], "ticks": ""}
    elif field.logarithmic:
        decades = [d for d in range(int(np.ceil(field.scale.low)), int(np.floor(field.scale.high)) + 1)]
        bar |= {"tickvals": decades, "ticktext": [f"10<sup>{d}</sup>" for d in decades]}
        bar["ticktext"] = [text.replace("-", "\u2212") for text in bar["ticktext"]]
    elif field.scale.clipped:
        bar["title"]["text"] += "; colours stop below the peak"
    return bar


def _lines(
    lines: tuple[Array, Array], axes: tuple[str, str], colour: str, width: float, name: str, opacity: float = 1.0
) -> Trace:
    return {
        "type": "scatter", "mode": "lines", "x": lines[0], "y": lines[1], "xaxis": axes[0], "yaxis": axes[1],
        "line": {"color": colour, "width": width, "simplify": False}, "hoverinfo": "skip", "showlegend": False,
        "name": name, "opacity": opacity,
    }  # fmt: skip


def _outline(mask: BoolArray, plan: Plan) -> tuple[Array, Array]:
    """Border of a mask as lines, straight runs joined."""
    return _chained(_runs(borders(mask, plan)))


def _runs(segments: Array) -> Array:
    """Segments (n, 2, 2) along x or y, those that continue each other joined."""
    joined = []
    for along, across in ((0, 1), (1, 0)):
        straight = segments[segments[:, 0, across] == segments[:, 1, across]]
        straight = straight[straight[:, 0, along] != straight[:, 1, along]]
        if not len(straight):
            continue
        ends = np.sort(straight[:, :, along], axis=1)
        order = np.lexsort((ends[:, 0], straight[:, 0, across]))
        ends, level = ends[order], straight[order, 0, across]
        starts = np.concatenate([[True], (level[1:] != level[:-1]) | (ends[1:, 0] > ends[:-1, 1] + 1e-9)])
        first = np.nonzero(starts)[0]
        last = np.concatenate([first[1:], [len(ends)]]) - 1
        run = np.empty((len(first), 2, 2))
        run[:, 0, along], run[:, 1, along] = ends[first, 0], ends[last, 1]
        run[:, :, across] = level[first, None]
        joined.append(run)
    return np.concatenate(joined) if joined else np.zeros((0, 2, 2))


def _chained(segments: Array) -> tuple[Array, Array]:
    """Segments (n, k, 2) as one trace, NaN between them."""
    gap = np.full((len(segments), 1, 2), np.nan)
    points = np.concatenate([segments, gap], axis=1).reshape(-1, 2).astype(np.float32)
    return points[:, 0], points[:, 1]


def _strokes(strokes: Array) -> tuple[Array, Array]:
    middles, halves = strokes[:, :2], strokes[:, 2:]
    return _chained(np.stack([middles - halves, middles + halves], axis=1))


def _arrows(arrows: Array) -> tuple[Array, Array]:
    """Shaft and head of each arrow in one stroke."""
    middles, halves = arrows[:, :2], arrows[:, 2:]
    tip, tail = middles + halves, middles - halves
    back = -2 * _HEAD * halves
    side = _WIDE * np.stack([-back[:, 1], back[:, 0]], axis=-1)
    return _chained(np.stack([tail, tip, tip + back + side, tip, tip + back - side], axis=1))
