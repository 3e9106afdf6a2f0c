"""What the page says of a study: its dimensions, and what is known at one of its points."""

from __future__ import annotations

import math
from typing import Any

from treadload.app.telling import Row, row
from treadload.errors import InputError
from treadload.plots.interactive.study import placed, study_curve, study_map, study_maps
from treadload.plots.kit.shown import shown
from treadload.plots.sweeps.reading import FAILED, View, beside
from treadload.study.sweeps import Sweep

# Values of a slider, results and characters of a label that a browser is sent.
_MOST_VALUES, _MOST_ROWS, _MOST_LETTERS = 2000, 40, 80


def about_study(study: Sweep) -> dict[str, Any]:
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
    return {"dims": dims, "readings": readings, "fields": study_maps(study), "summary": study.summary()}


def _called(view: View, dim: str) -> str:
    """A dimension in words, where it is an input."""
    return shown(view.data[dim], dim).words if dim in view.data.coords else dim


def _values(view: View, dim: str, count: int) -> list[str]:
    """Values of a dimension in words: of its input, or of all inputs that go along it."""
    own = [name for name in view.inputs if view.data[name].dims == (dim,)]
    told = []
    for number in range(count):
        words = []
        for name in own:
            how, value = shown(view.data[name], name), view.data[name].to_numpy()[number]
            said = how.number(value.item() if hasattr(value, "item") else value)
            words.append(said if len(own) == 1 else f"{how.words} {said}")
        told.append((", ".join(words) or str(number))[:_MOST_LETTERS])
    return told


def point_of(study: Sweep, at: dict[str, int], reading: str, along: str, field: str, theme: str, width: float) -> Any:
    """Figures at a point of a study: the curve, and the map where a field was kept."""
    made = {"curve": study_curve(study, reading, along, at, theme=theme)}
    if field:
        made["field"] = study_map(study, field, at, theme=theme, width=width)
        view = View.of(study)
        if int(view.data["status"].isel(placed(view, at))) == FAILED:
            said = "this case failed; why stands at the right"
            made["field"].add_annotation(text=said, showarrow=False, x=0.5, y=0.9, xref="x domain", yref="y domain")
    return made


def point_rows(study: Sweep, at: dict[str, int]) -> list[Row]:
    """What was solved at a point of a study, or why it failed."""
    view = View.of(study)
    index = placed(view, at)
    rows = [
        row(f"at:{dim}", _called(view, dim), text, group="point")
        for dim in view.dims for text in [_values(view, dim, view.data["status"].sizes[dim])[index[dim]]]
    ]  # fmt: skip
    if int(view.data["status"].isel(index)) == FAILED:
        number = 0
        for dim, place in index.items():
            number = number * view.data["status"].sizes[dim] + place
        return [*rows, row("verdict", "Case", "failed", group="solved", note=dict(study.failures).get(number, ""))]
    for name in view.readings()[:_MOST_ROWS]:
        field = view.data[name]
        value = field.isel({dim: index.get(dim, 0) for dim in map(str, field.dims)}).item()
        how = shown(field, name)
        said = how.number(value) if math.isfinite(value) else "none"
        words = ", ".join(one for one in (how.words, beside(view, field)) if one)
        rows.append(row(f"solved:{name}", words, said, group="solved"))
    return rows
