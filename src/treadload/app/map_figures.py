"""Which figures the page shows of a result, in the words that a browser sends: names, indices, a theme."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from treadload.app.result_rows import quiet_groups
from treadload.composing import BaseResult
from treadload.contact import Contact
from treadload.damage import Verdict
from treadload.errors import InputError
from treadload.footprint import Footprint
from treadload.plots import interactive
from treadload.plots.interactive import Cut, Field
from treadload.plots.interactive.browser_grids import Grid
from treadload.plots.interactive.us_figure import line_in_display_units
from treadload.response import Response

if TYPE_CHECKING:
    from plotly.graph_objects import Figure

Parts = Mapping[str, BaseResult]
# Results that have maps.
_DRAWN = (Contact, Footprint, Response, Verdict)
# Pixels: below this the bar of a map has no room for words. Its unit stands in brackets.
_WIDE, _UNIT = 1000.0, re.compile(r"\(([^()]*)\)")
# Just below an interface, m, and the first depth of a block, as a part of the whole.
_BELOW, _FIRST = 1e-6, 0.02
# Plotly reads texts as HTML, links among it, and writes "<" in JSON as a code: tags that figures of ours do not have.
_LESS, _MORE, _OVER = r"(?:<|\\u003c)", r"(?:>|\\u003e)", r"(?:/|\\u002f)"
_STRANGE = re.compile(rf"{_LESS}(?!{_OVER}?(?:b|br|i|sub|sup|extra){_OVER}?{_MORE})", re.IGNORECASE)


def as_text(figure: Figure | SourcedFigure) -> str:
    """A figure as JSON for the browser, in which a tag that a name of a file brings is a text."""
    text: str = figure.to_json()
    return _STRANGE.sub("&lt;", text)


def choices_of(parts: Parts) -> dict[str, str]:
    """Maps that can be drawn: "part/name" → words."""
    choices: dict[str, str] = {}
    for part, result in parts.items():
        if isinstance(result, _DRAWN) and part not in quiet_groups():
            for name, words in interactive.choices(result).items():
                choices[f"{part}/{name}"] = words
    return choices


def depths_of(parts: Parts) -> list[float]:
    """Depths of the maps of the road, m."""
    response = parts.get("response")
    return [] if response is None else [float(depth) for depth in response.dataset["depth"].to_numpy()]


def maps(
    parts: Parts,
    *,
    theme: str,
    left: str = "contact/pressure",
    right: str = "response/principal_strain_1",
    depth: int = 0,
    width: float = 1100.0,
    line: Sequence[float] | None = None,
) -> dict[str, Figure]:
    """Two linked maps with the line of the slice on them.

    left, right: of `choices_of`; one that is not there yet gives way to the plainest. depth: number of the depth.
    line: x and y of its start, then of its end, m; left out, along travel through the largest pressure.
    """
    choices = choices_of(parts)
    if not choices:
        raise InputError("this result holds no map that the page could show")
    first = left if left in choices else next(iter(choices))
    beside = [name for name in (right, "contact/shear", *choices) if name in choices and name != first]
    chosen = [first, *beside[:1]]
    fields = [field_of(parts, name, depth) for name in chosen]
    cut = cut_of(parts, line)
    figure = interactive.linked_maps(fields, cut=cut, places=named_places(parts), theme=theme, width=width)
    return {"maps": _narrowed(figure, width)}


def places(parts: Parts, *, theme: str) -> dict[str, Figure]:
    """Marks of the places that a verdict names, to be put on the two maps that are drawn already."""
    return {"places": interactive.marked(named_places(parts), 2, theme=theme)}


def shows_damage(*, left: str = "", right: str = "", **_: object) -> bool:
    """True where a map is to be drawn of the verdict itself."""
    return any(name.startswith("damage/") for name in (left, right))


def named_places(parts: Parts) -> list[interactive.Place]:
    """Places that the verdict names."""
    return interactive.places_of(parts["damage"]) if "damage" in parts and worst(parts) else []


def _narrowed(figure: Figure, width: float) -> Figure:
    """The figure, its colour bars named by their units alone where there is no room for words."""
    if width < _WIDE:
        for trace in figure.data:
            title: Any = getattr(getattr(trace, "colorbar", None), "title", None)
            unit = _UNIT.search(title.text or "") if title is not None else None
            if unit:
                beyond = "; the peak lies beyond" if "peak" in title.text else ""
                title.text = f"{unit[1]}{beyond}"
    return figure


def worst(parts: Parts) -> bool:
    """True where the verdict names a place."""
    return float(parts["damage"].dataset["worst_strain"]) > 0 if "worst_strain" in parts["damage"].dataset else False


def field_of(parts: Parts, name: str, depth: int = 0) -> Field:
    """The map of a name of `choices_of`."""
    part, _, inner = name.partition("/")
    if part not in parts:
        raise InputError(f"this result has no part {part!r}; it holds {', '.join(parts)}")
    depths = depths_of(parts) if part == "response" else []
    at = depths[min(max(depth, 0), len(depths) - 1)] if depths else None
    return interactive.field_of(parts[part], inner, depth=at, contact=parts.get("contact"))


def cut_of(parts: Parts, line: Sequence[float] | None) -> Cut:
    """The line of the slice, inside the map."""
    source = parts.get("contact") or next(iter(parts.values()))
    if line is None:
        return Cut.along(source)
    return Cut((line[0], line[1]), (line[2], line[3])).within(source)


def along(
    parts: Parts,
    block: BaseResult | None,
    line: Sequence[float] | None,
    *,
    theme: str,
    name: str = "",
    over: BaseResult | None = None,
    with_source: bool = True,
) -> dict[str, Figure | SourcedFigure]:
    """The profile along the line, and the section below it where the road is known at several depths.

    name: variable of the section. over: another contact, or a measured footprint, whose pressure is drawn as well.
    with_source: True where each comes with what it was read from, so that the browser draws other lines by itself.
    """
    cut = cut_of(parts, line)
    overlaid = None if over is None else {"the other": over}
    source = parts.get("contact") or next(iter(parts.values()))
    profile = interactive.profiles(source, cut, overlaid=overlaid, theme=theme)
    drawn = {
        "profile": SourcedFigure.of(profile, interactive.profile_held(source, overlaid), cut)
        if with_source
        else profile
    }
    if block is not None:
        shown = name or "principal_strain_1"
        section = interactive.depth_slice(block, cut, shown, theme=theme, whole=True)
        drawn["section"] = SourcedFigure.of(section, interactive.section_held(block, shown), cut)
    return drawn


@dataclass(frozen=True)
class SourcedFigure:
    """A figure along a line, in the unit of the map, and the grids that a browser holds to draw other lines."""

    figure: Figure
    grids: list[Grid]
    line: tuple[float, ...]

    @classmethod
    def of(cls, figure: Figure, grids: list[Grid], cut: Cut) -> Figure | SourcedFigure:
        """The figure with its grids, or the figure alone where they are too large to be sent."""
        if interactive.held_numbers(grids) > interactive.MOST_HELD:
            return figure
        return cls(figure, grids, line_in_display_units((*cut.start_mm, *cut.end_mm)))

    def to_json(self) -> str:
        """As plotly's own text, with "held" besides."""
        source_text = json.dumps({"grids": self.grids, "line": self.line})
        return f'{{"held":{source_text},{self.figure.to_json()[1:]}'


def difference(
    left: Parts, right: Parts, name: str, *, theme: str, width: float, labels: Sequence[str]
) -> dict[str, object]:
    """Two results and what sets them apart, on one scale."""
    part, _, inner = name.partition("/")
    for parts, label in zip((left, right), labels, strict=True):
        if part not in parts:
            raise InputError(f"{label} has no part {part!r}; it holds {', '.join(parts)}")
    figure = interactive.difference_map(
        left[part], right[part], inner, labels=(labels[0], labels[1]), theme=theme, width=width
    )
    return {"maps": _narrowed(figure, 0.0)}


def tread(parts: Parts, *, theme: str) -> dict[str, Figure]:
    """The tread in space with the pressure on it."""
    if "contact" not in parts:
        raise InputError("this result has no contact, so there is no tread to draw")
    return {"tread": interactive.tread(parts["contact"], theme=theme)}


def block_depths(bottom: float, interfaces: Sequence[float], count: int) -> list[float]:
    """Depths of the block of road that slices are cut from: closer to each other near the surface, m."""
    share = (1 / _FIRST) ** (1 / (count - 2))
    graded = [0.0, *(bottom * _FIRST * share**number for number in range(count - 1))]
    faces = [interface for interface in interfaces if interface < bottom]
    below = [face + _BELOW for face in faces]
    return sorted({round(depth, 7) for depth in (*graded, *faces, *below)})
