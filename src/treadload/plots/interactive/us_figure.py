"""Traces, layout and held grids of an interactive figure in the units of display, whichever function made them.

A figure is made in the SI units of its labels. Here its numbers become US units as a whole: coordinates, colours,
ranges, lines, hover texts and all sentences, so that a browser reads, zooms and snaps in the units that it shows.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from treadload.kernels.arrays import Array
from treadload.us_units import AxisUnit, axis_in_display_units, in_us_units, sentence_in_display_units

Part = dict[str, Any]
Units = dict[str, AxisUnit]
Numbers = Array | float | Sequence[float | None]

_AXIS = re.compile(r"([xyz])axis(\d*)")
# A number of a hover text with its unit: %{x:.1f} mm.
_HOVER = re.compile(r"%\{(?P<of>\w+)(?::\.(?P<digits>\d+)(?P<form>f|~g))?\} (?P<unit>[^\s<,;()]+)")
_PLACES, _RANGES = ("x", "x0", "x1"), ("y", "y0", "y1")
# Of a colour: its numbers by the name that a hover text has for them.
_COLOURS = {"z": ("z", "zmin", "zmax", "zmid"), "customdata": ("customdata", "surfacecolor", "cmin", "cmax")}


def in_display_units(traces: Sequence[Part], layout: Mapping[str, object]) -> tuple[list[Part], Part]:
    """Traces and layout of plotly in the units of display; in SI they stay as they are."""
    if not in_us_units():
        return list(traces), dict(layout)
    units: Units = {}
    page = dict(layout)
    changed: Part = {key: _axes(key, value, "", units, traces) for key, value in page.items()}
    shown = [_trace(trace, units) for trace in traces]
    changed["shapes"] = [_placed(shape, units, "xref", "yref") for shape in _parts(page, "shapes")]
    changed["annotations"] = _notes(_parts(page, "annotations"), units)
    if "sliders" in layout:
        changed["sliders"] = [_slider(slider, units) for slider in _parts(page, "sliders")]
    return shown, {key: value for key, value in changed.items() if key in layout}


def line_in_display_units(ends: Iterable[float]) -> tuple[float, ...]:
    """Ends of a line, mm, in the unit of maps."""
    _, unit = axis_in_display_units("(mm)")
    return tuple(ends) if unit is None else tuple(unit.number(end) for end in ends)


def values_in_display_units(values: Array, unit: str) -> Array:
    """Values in an SI unit of display, in that of the axis of a figure of them."""
    _, shown = axis_in_display_units(f"({unit})", _largest([values]))
    return values if shown is None else np.asarray(shown.number(values))  # type: ignore[arg-type]


def _axes(key: str, value: object, scene: str, units: Units, traces: Sequence[Part]) -> object:
    """A part of a layout, its axes in the units of display; their units by "x2" or "scene.x" are added."""
    if key == "title":
        return {**_as_part(value), "text": sentence_in_display_units(_text_of(value))}
    match = _AXIS.fullmatch(key)
    if not isinstance(value, dict) or (match is None and key != "scene"):
        return value
    if match is None:
        return {name: _axes(name, part, "scene.", units, traces) for name, part in value.items()}
    name = f"{match[1]}{match[2]}"
    along = [trace.get(match[1], ()) for trace in traces if trace.get(f"{match[1]}axis", match[1]) == name]
    label, unit = axis_in_display_units(_text_of(value.get("title")), _largest(along))
    axis = {**value, "title": {**_as_part(value.get("title")), "text": label}} if "title" in value else dict(value)
    if unit is not None:
        units[scene + name] = unit
        shown = _log(unit) if value.get("type") == "log" else unit.number
        axis |= {part: [shown(end) for end in value[part]] for part in ("range", "tickvals") if part in value}
    return axis


def _trace(trace: Part, units: Units) -> Part:
    """A trace in the units of its axes, of its colour bar and of its hover text."""
    of_trace: dict[str, AxisUnit] = {}
    scene = "scene." if trace.get("type") in ("surface", "scatter3d", "mesh3d") else ""
    hover = {match["of"]: match["unit"] for match in _HOVER.finditer(trace.get("hovertemplate", ""))}
    for name in ("x", "y", "z"):
        unit = units.get(scene + trace.get(f"{name}axis", name)) if name != "z" or scene else None
        # What is added to a figure comes without its axes.
        unit = unit or (axis_in_display_units(f"({hover[name]})")[1] if name in hover and name != "z" else None)
        if unit is not None and name in trace:
            of_trace[name] = unit
    bar = trace.get("colorbar")
    coloured = "customdata" if scene else "z"
    changed = dict(trace)
    if bar is not None:
        label, unit = axis_in_display_units(_text_of(bar.get("title")), _largest([trace.get(coloured, ())]))
        changed["colorbar"] = {**bar, "title": {**_as_part(bar.get("title")), "text": label}}
        if unit is not None:
            of_trace[coloured] = unit
    for name, unit in of_trace.items():
        keys = _COLOURS[name] if name == coloured else (name,)
        changed |= {key: _numbers(trace[key], unit) for key in keys if key in trace}
    if "hovertemplate" in trace:
        changed["hovertemplate"] = sentence_in_display_units(
            _HOVER.sub(lambda match: _hovered(match, of_trace), trace["hovertemplate"])
        )
    if "error_y" in trace and "y" in of_trace:
        ratio = of_trace["y"].size / of_trace["y"].shown.size
        bars = {key: trace["error_y"][key] * ratio for key in ("array", "arrayminus")}
        changed["error_y"] = {**trace["error_y"], **bars}
    for key in ("name", "text"):
        if key in trace:
            changed[key] = _words(trace[key])
    return changed


def _hovered(match: re.Match[str], units: Mapping[str, AxisUnit]) -> str:
    unit = units.get(match["of"])
    if unit is None:
        return match[0]
    digits, form = int(match["digits"] or 0), match["form"]
    form_of = "" if form is None else f":.{digits + unit.shown.decimals}f" if form == "f" else f":.{digits}~g"
    return f"%{{{match['of']}{form_of}}} {unit.shown.symbol}"


def _placed(part: Part, units: Units, x_of: str, y_of: str) -> Part:
    """A shape or a note where it was. x_of, y_of: the keys that name its axes, as plotly calls them."""
    changed = dict(part)
    for of, keys in ((x_of, _PLACES), (y_of, _RANGES)):
        unit = units.get(part.get(of, keys[0]))
        if unit is not None:
            changed |= {key: _numbers(part[key], unit) for key in keys if key in part}
    return changed


def _notes(notes: Sequence[Part], units: Units) -> list[Part]:
    """Notes in the units of display."""
    shown = [_placed(note, units, "xref", "yref") for note in notes]
    return [{**note, **{key: _words(note[key]) for key in ("text", "hovertext") if key in note}} for note in shown]


def _slider(slider: Part, units: Units) -> Part:
    """A slider through stages: its labels, and the notes that each step sets."""
    steps = []
    for step in slider["steps"]:
        which, *more = step["args"]
        more = [
            {**part, "annotations": _notes(part["annotations"], units)} if "annotations" in part else part
            for part in more
        ]
        steps.append({**step, "label": _words(step["label"]), "args": [which, *more]})
    return {**slider, "steps": steps}


def _log(unit: AxisUnit) -> Callable[[float], float]:
    """Of an axis of logarithms."""
    return lambda value: float(np.log10(unit.number(10.0**value)))


def _numbers(values: Numbers, unit: AxisUnit) -> Numbers:
    if isinstance(values, list | tuple):
        return [value if value is None else unit.number(value) for value in values]
    # Arrays as well as numbers.
    return unit.number(values)  # type: ignore[arg-type]


def _words(text: str | Sequence[str]) -> str | list[str]:
    return sentence_in_display_units(text) if isinstance(text, str) else [sentence_in_display_units(t) for t in text]


def _parts(layout: Part, key: str) -> list[Part]:
    return list(layout.get(key, ()))


def _text_of(title: object) -> str:
    return str(_as_part(title).get("text", ""))


def _as_part(title: object) -> Part:
    return dict(title) if isinstance(title, dict) else {"text": title or ""}


def _largest(arrays: Sequence[Numbers]) -> float:
    """The largest number of some arrays, in size; 0 of none."""
    sizes = []
    for values in map(np.asarray, arrays):
        # Names of cases lie along an axis, too.
        numbers = values.astype(float) if values.dtype.kind in "fiuO" else np.zeros(0)
        sizes.append(float(np.max(np.abs(numbers), initial=0.0, where=np.isfinite(numbers))))
    return max(sizes, default=0.0)
