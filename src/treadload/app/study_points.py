"""What the page says of a study: its dimensions, and what is known at one of its points."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

from treadload.app.answers import PageRow
from treadload.composing import BaseResult
from treadload.describing import title_of
from treadload.errors import InputError
from treadload.plots.interactive.study import placed, study_curve, study_map, study_maps
from treadload.plots.kit.shown import shown
from treadload.plots.sweeps.reading import FAILED, View, beside
from treadload.sweeps import Sweep
from treadload.us_units import sentence_in_display_units

if TYPE_CHECKING:
    from plotly.graph_objects import Figure

# Values of a slider, results and characters of a label that a browser is sent.
_MOST_VALUES, _MOST_ROWS, _MOST_LETTERS = 2000, 40, 80


def study_of(parts: Mapping[str, BaseResult]) -> Sweep:
    """The study among the results of a file. Raises InputError."""
    study = next((part for part in parts.values() if isinstance(part, Sweep)), None)
    if study is None:
        raise InputError(f"this file holds {', '.join(parts)} and no study; results of one case open on the bench")
    return study


def about_study(study: Sweep) -> dict[str, object]:
    """Dimensions with their values in words, results that differ, fields that were kept, a summary."""
    view = View.of(study)
    dims = []
    for dim in view.dims:
        count = view.data["status"].sizes[dim]
        if count > _MOST_VALUES:
            raise InputError(f"{dim} has {count} values, a slider {_MOST_VALUES} at most; cut the study")
        dims.append({"name": dim, "words": _called(view, dim), "values": _values(view, dim, count)})
    readings = {name: shown(view.data[name], name).words for name in view.readings()}
    if not readings:
        raise InputError("nothing that this study solved differs from case to case, so there is nothing to look at")
    summary = [title_of(study), *(f"{stated.label} {stated.sentence}".strip() for stated in study.rows())]
    return {"dims": dims, "readings": readings, "fields": study_maps(study), "summary": summary}


def _called(view: View, dim: str) -> str:
    """A dimension in words, where it is an input."""
    return shown(view.data[dim], dim).words if dim in view.data.coords else dim


def _values(view: View, dim: str, count: int) -> list[str]:
    """Values of a dimension in words: of its input, or of all inputs that go along it."""
    names = [name for name in view.inputs if view.data[name].dims == (dim,)]
    texts = []
    for number in range(count):
        words = []
        for name in names:
            how, value = shown(view.data[name], name), view.data[name].to_numpy()[number]
            text = how.number(value.item() if hasattr(value, "item") else value)
            words.append(text if len(names) == 1 else f"{how.words} {text}")
        texts.append((", ".join(words) or str(number))[:_MOST_LETTERS])
    return texts


def point_of(
    study: Sweep, at: dict[str, int], reading: str, along: str, field: str, theme: str, width: float
) -> dict[str, Figure]:
    """Figures at a point of a study: the curve, and the map where a field was kept."""
    figures = {"curve": study_curve(study, reading, along, at, theme=theme)}
    if field:
        figures["field"] = study_map(study, field, at, theme=theme, width=width)
        view = View.of(study)
        if int(view.data["status"].isel(placed(view, at))) == FAILED:
            note = "this case failed; the reason is at the right"
            figures["field"].add_annotation(
                text=note, showarrow=False, x=0.5, y=0.9, xref="x domain", yref="y domain"
            )
    return figures


def point_rows(study: Sweep, at: dict[str, int]) -> list[PageRow]:
    """What was solved at a point of a study, or why it failed."""
    view = View.of(study)
    index = placed(view, at)
    rows = [
        _row(f"at:{dim}", _called(view, dim), text, "Point")
        for dim in view.dims for text in [_values(view, dim, view.data["status"].sizes[dim])[index[dim]]]
    ]  # fmt: skip
    if int(view.data["status"].isel(index)) == FAILED:
        number = 0
        for dim, place in index.items():
            number = number * view.data["status"].sizes[dim] + place
        why = _row("verdict", "Case", dict(study.failures).get(number, ""))
        return [*rows, _row("status", "Case", "failed"), why]
    for name in view.readings()[:_MOST_ROWS]:
        field = view.data[name]
        value = field.isel({dim: index.get(dim, 0) for dim in map(str, field.dims)}).item()
        how = shown(field, name)
        text = how.number(value) if math.isfinite(value) else "none"
        words = ", ".join(text for text in (how.words, beside(view, field)) if text)
        rows.append(_row(f"solved:{name}", words, text))
    return rows


def _row(key: str, label: str, value: str, heading: str = "Solved") -> PageRow:
    shown = sentence_in_display_units(value)
    return {"key": key, "label": label, "value": shown, "heading": heading, "about": "", "group": "", "note": ""}
