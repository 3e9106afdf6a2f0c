"""One tree of named results with its provenance, and their inputs.

Names, units and signs of the variables are stated in `variables.py` and explained in
docs/explanation/conventions.md.
"""

from __future__ import annotations

import datetime
import json
import platform
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict
from importlib import metadata
from typing import Any

from treadload._version import __version__
from treadload.case import Case
from treadload.citations import references
from treadload.composing import BaseResult
from treadload.contact import Contact
from treadload.damage import Season
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.footprint import Footprint
from treadload.pavement import LayerRow, Pavement, layer_rows, methods_of, road_in_words
from treadload.pavement.sublayers import middle_temperatures
from treadload.response import GridLoad
from treadload.results.dataset import Fields
from treadload.results.questions import Writer
from treadload.results.roads import rows_of
from treadload.rows import as_json
from treadload.us_units import display_units

FORMAT = 2
"""Format of the files: 1 holds fields, words and the case; 2 also the inputs of every result."""
CF = "CF-1.11"
"""Conventions of names, units and flags that the files follow (Climate and Forecast metadata conventions)."""
QUESTIONS = "asked"
"""Name of the group that holds the inputs of the parts."""

# Attributes of a group, and the row that each of them is.
_ANSWERS = {"sentence": "verdict", "governing": "governing"}
_NAME = re.compile(r"\w[\w \-+.,=%°()]*(?<! )")


# Files stay in SI units, whatever is shown.
@display_units("si")
def to_tree(
    parts: Any,
    *,
    case: Case | None = None,
    road: Pavement | None = None,
    season: Season | None = None,
    title: str = "",
    summary: str = "",
) -> xr.DataTree:
    """One tree of named results, ready to be saved, reported, or opened again.

    parts: a result or several, of any verb: contacts, responses, assessments, lives, curves, comparisons; a GridLoad
    that was recorded in place of a contact; a dataset of fields. A mapping names them, {"free": r1, "braking": r2};
    else each takes the name of its kind: /contact, /response, /damage, /bonds, /life, /sensitivity, /transient, …,
    numbered where there are several, /response, /response_2. A response on a single row of y becomes /slice_along, on
    a single column of x /slice_across, on a single line of the surface /bowl, one at a list of points /points.
    case: that they answer; left out, that which a study varied. road: at its temperature; left out, that of the
    contact. season: whose temperatures the road has, under a life. summary: of all of them; left out, those of the
    parts.
    The root carries the title, the case as TOML text, the layers of the road as JSON, versions, the date and the
    citations as JSON; the group /asked the inputs of every part, for `open_results`.
    Raises InputError for what is not a result, and for a name that no file can hold.

    >>> road = tl.Pavement.half_space(tl.Elastic(100e6, 0.35))
    >>> plates = {"light": tl.UniformDisc(0.15, 500e3), "heavy": tl.UniformDisc(0.15, 700e3)}
    >>> solved = {name: tl.solve_response(load, road, depths=[0.15], x=[0], y=[0]) for name, load in plates.items()}
    >>> tree = tl.results.to_tree(solved, title="plate tests")
    >>> [f"{tree[name].stress_zz.item() / 1e3:.0f} kPa" for name in solved]
    ['-323 kPa', '-453 kPa']
    """
    named = dict(named_parts(parts))
    names = {id(part): name for name, part in named.items()}
    owner: dict[str, str] = {}
    queue = list(named)
    questions: dict[str, Any] = {}

    def name_of(result: BaseResult) -> str:
        """Of a part inside another, which becomes a part of its own."""
        if id(result) not in names:
            name = _free(f"{queue[0]}_{result.group_name}", named)
            names[id(result)], named[name], owner[name] = name, result, queue[0]
            queue.append(name)
        return names[id(result)]

    writer = Writer(name_of)
    groups: dict[str, xr.Dataset] = {}
    while queue:
        part = named[queue[0]]
        questions[queue[0]] = writer.result(part)
        groups[queue[0]] = part.dataset.assign_attrs(_about(part, owner.get(queue[0], "")))
        queue.pop(0)
    free = [part for name, part in named.items() if name not in owner]
    if case is None:
        # Of a study, whose parts are cases of its own.
        case = next((varied for part in free if isinstance(varied := getattr(part, "case", None), Case)), None)
    contact = next((part for part in free if isinstance(part, Contact)), None)
    if road is None and contact is not None:
        road = contact.road
    layers = rows_of(road, case) if season is None else _warm_rows(road, season)
    methods = [key for part in free for key in part.cites()]
    if season is not None and road is not None:
        methods += methods_of(road)
    root = {
        "title": title or (case.title if case is not None else ""),
        "case": case.to_toml() if case is not None else "",
        "layers": json.dumps([asdict(layer) for layer in layers], ensure_ascii=False),
        **({} if season is None else {"season": season.name}),
        **({"summary": summary} if summary else {}),
        "citations": json.dumps(references(methods), ensure_ascii=False),
        **_provenance(),
    }
    arrays = {
        name: ([f"{name}_{k}" for k in range(array.ndim)], array, {"long_name": "array among the inputs of a result"})
        for name, array in writer.arrays.items()
    }
    groups[QUESTIONS] = xr.Dataset(arrays, attrs={"questions": json.dumps(questions, ensure_ascii=False)})
    return xr.DataTree.from_dict({"/": xr.Dataset(attrs=root), **{f"/{k}": v for k, v in groups.items()}})


def as_tree(results: Any) -> xr.DataTree:
    """A tree of whatever verbs give: a tree, the result of a case, results that were opened, a result or several.

    >>> road = tl.Pavement.half_space(tl.Elastic(100e6, 0.35))
    >>> response = tl.solve_response(tl.UniformDisc(0.15, 700e3), road, depths=[0.15], x=[0.0, 0.1], y=[0.0, 0.1])
    >>> tree = tl.results.as_tree({"plate": response})
    >>> f"{tree['plate'].stress_zz.min().item() / 1e3:.0f} kPa"
    '-453 kPa'
    """
    if isinstance(results, xr.DataTree):
        return results
    whole = getattr(results, "to_tree", None)
    if callable(whole):
        tree: xr.DataTree = whole()
        return tree
    return to_tree(results)


def named_parts(parts: Any) -> Iterator[tuple[str, BaseResult]]:
    """Results by name, each name once. Raises InputError for what is not a result and for a wrong name."""
    taken: dict[str, Any] = {}
    if isinstance(parts, Mapping) and not isinstance(parts, xr.Dataset):
        entries: list[tuple[str | None, Any]] = [(_checked(name), part) for name, part in parts.items()]
    elif isinstance(parts, BaseResult | GridLoad | xr.Dataset) or hasattr(parts, "parts"):
        entries = [(None, parts)]
    elif isinstance(parts, Iterable) and not isinstance(parts, str | bytes):
        entries = [(None, part) for part in parts]
    else:
        raise InputError(_no_result(parts))
    for name, part in entries:
        inner = getattr(part, "parts", None)
        for inner_name, part_inside in inner.items() if isinstance(inner, Mapping) else [(None, part)]:
            result = _result(part_inside)
            wanted = " ".join(text for text in (name, inner_name) if text) or result.group_name
            free = _free(wanted, taken)
            taken[free] = result
            yield free, result


def _result(part: Any) -> BaseResult:
    if isinstance(part, BaseResult):
        return part
    if isinstance(part, GridLoad):
        return Footprint(part)
    if isinstance(part, xr.Dataset):
        return Fields(part)
    raise InputError(_no_result(part))


def _no_result(part: Any) -> str:
    return (
        f"a tree is made of results of treadload, got {type(part).__name__}; give what a verb such as solve_contact "
        "returned, a list of these, or a mapping of names to them"
    )


def _checked(name: Any) -> str:
    if not isinstance(name, str) or not _NAME.fullmatch(name) or name == QUESTIONS:
        raise InputError(
            f"a part of results cannot be named {name!r}; use letters, digits, blanks and -+.,=%°(), with a letter "
            f"or digit first, and not {QUESTIONS!r}, which belongs to the file"
        )
    return name


def _free(name: str, taken: Mapping[str, Any]) -> str:
    """The name, numbered if it is taken already."""
    free, number = name, 2
    while free in taken:
        free, number = f"{name}_{number}", number + 1
    return free


def _about(part: BaseResult, owner: str) -> dict[str, str]:
    """Description of a group in words, for people and for the report."""
    kind = part.group_name
    about = {"result": kind, "stats": json.dumps(dict(part.stats), default=_plain)}
    if owner:
        return {**about, "part_of": owner}
    # Sections through the road would repeat the warnings of the map, each for its own depths.
    if kind not in part.sections:
        rows = part.rows()
        about["warnings"] = json.dumps(list(part.warnings), ensure_ascii=False)
        about |= {"summary": part.text(), "heading": part.heading}
        about["rows"] = as_json(rows)
        answers = {row.key: str(row.value) for row in rows if not row.group}
        about |= {name: answers[key] for name, key in _ANSWERS.items() if key in answers}
    if isinstance(part, Contact):
        about |= {"tire": str(part.tire), "road": road_in_words(part.road), "rolling": str(part.rolling)}
    return about


def _plain(value: Any) -> Any:
    return value.tolist() if hasattr(value, "tolist") else float(value)


def _warm_rows(road: Pavement | None, season: Season) -> tuple[LayerRow, ...]:
    if road is None:
        return ()
    profile, warm = season.profile, season.temperatures
    if profile is not None:
        return layer_rows(road, middle_temperatures(road, profile))
    return layer_rows(road, warm if isinstance(season.temperature, tuple) else warm * len(road.layers))


def _provenance() -> dict[str, Any]:
    return {
        "treadload_version": __version__,
        "results_format": FORMAT,
        "versions": json.dumps(_versions()),
        "created": (created := datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds")),
        "Conventions": CF,
        "history": f"{created} solved by treadload {__version__}",
        "conventions": "x: travel, y: right, z: down; tension positive; traction: by the tire on the road; SI units",
    }


def _versions() -> Mapping[str, str]:
    names = ("numpy", "scipy", "xarray")
    return {"python": platform.python_version(), **{name: metadata.version(name) for name in names}}
