"""Where a road would crack first, by which criterion: all criteria of a life, all quantities of a response."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from treadload.damage.cracks import OBLIQUE_TOLERANCE, ORIENTATIONS, crack_plane, in_a_cell, opens_down, orientation
from treadload.damage.fields import known_quantities
from treadload.damage.quantity import Quantity, cut, in_tension
from treadload.deferred import xarray as xr
from treadload.kernels.largest import index_of_largest
from treadload.plots.first import crack_or_not, failing_order
from treadload.plots.response import NAMES
from treadload.reporting.typesetting import typeset, with_minus
from treadload.results.schema import read_json
from treadload.rows import Row, from_json, row, table_of
from treadload.variables import Display, display_of

_RESPONSE = ("quantity", "author", display_of("largest_reading").label, "where", display_of("first_crack").label,
             "calibrated")  # fmt: skip
_CONDITIONS = "law_conditions"
_AT = {"read_depth": "depth", "worst_y": "y ="}
_PLACES = {"top": "top of a layer", "bottom": "bottom of a layer", "interface": "bond between layers"}
CRACKS, FAILS = "Predicted cracking by criterion", "Predicted failure by criterion"


@dataclass(frozen=True)
class FirstPage:
    """The part of a report about it. heading: with the word "crack" only where one opens. sentence: the first of
    them.

    columns, rows: the table, first to fail first. note: how it is read. conditions: name of a criterion and what its
    law was calibrated by, which is too long for a column.
    """

    heading: str
    sentence: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str
    conditions: tuple[tuple[str, str], ...] = ()


def first_of_life(data: xr.Dataset, rows: Sequence[Row] = ()) -> FirstPage | None:
    """The page of a life; None for files without its rows. data: the group /life. rows: of the life, else its own."""
    rows = rows or from_json(data.attrs.get("rows"))
    criteria = [str(name) for name in data["criterion"].to_numpy()]
    keys = [{row.key for row in rows if row.group == name} for name in criteria]
    # Criteria of the surface have rows that those at depth lack: years by other lines.
    common = set.intersection(*keys) - {_CONDITIONS}
    by_criterion = {name: [row for row in rows if row.group == name and row.key in common] for name in criteria}
    if len({tuple(row.key for row in members) for members in by_criterion.values()}) != 1 or not common:
        return None
    proposed, places = (_texts(data, name, len(criteria)) for name in ("proposed", "places"))
    is_ranked = "design_utilisation" in data
    order = failing_order(data) if is_ranked else [int(k) for k in np.argsort(data["life_years"].to_numpy())]
    names = [criteria[k] for k in order]
    where = {name: _PLACES.get(places[k], "") for name, k in zip(names, order, strict=True)}

    def cell(row: Row, bare: bool) -> str:
        if row.key == "read_depth" and row.value and where[row.group]:
            return f"{typeset(row, bare=bare)}, {where[row.group]}"
        return typeset(row, bare=bare)

    columns, *cells = table_of([by_criterion[name] for name in names], cell)
    lines = tuple((line[0], short_source(proposed[k]), *line[1:]) for k, line in zip(order, cells, strict=True))
    first = {row.key: cell(row, False) for row in by_criterion[names[0]]}
    cracks = any(crack_or_not(data, k) == "crack" for k in order)
    if math.isinf(float(data["life_years"][order[0]])):
        sentence = "No criterion fails under this traffic."
    else:
        places_of_first = (f"{word} {first[key]}" for key, word in _AT.items() if key in first)
        where_and_way = (
            ", ".join(places_of_first),
            first.get("first_crack", ""),
            f"most by {first['damage_by']}" if "damage_by" in first else "",
        )
        text = "; ".join(filter(None, where_and_way))
        sentence = f"First fails {names[0]} after {first.get('life_years', 'years')}: {text}."
    note = (
        "First to fail first. Criteria by other laws end in different ways; see Methods. Utilisation: the largest "
        "value over the one that the law allows for all load repetitions of the design life, or of a year. y: right "
        "of the middle of the wheel path. A plane nearer to the horizontal than 45° is no crack from the surface "
        "down, and none opens where no principal stress is tensile."
    )
    texts = {row.group: str(row.value) for row in rows if row.key == _CONDITIONS}
    conditions = tuple((name, texts[name]) for name in names if name in texts)
    heads = ("criterion", "author", *columns[1:])
    return FirstPage(CRACKS if cracks else FAILS, sentence, heads, lines, note, conditions)


def _texts(data: xr.Dataset, name: str, count: int) -> list[str]:
    """The texts of an attribute, one for each criterion; a dash for each where the file does not hold them."""
    texts = read_json(data.attrs.get(name), [])
    return [str(text) for text in texts] if len(texts) == count else ["–"] * count


def first_of_response(data: xr.Dataset) -> FirstPage | None:
    """The page of a response on a grid: where each quantity is largest; None where it has none of their fields."""
    if not {"depth", "y", "x"} <= set(data.dims):
        return None
    quantity_rows = [
        _response_row(quantity, data) for quantity in known_quantities().values() if not quantity.missing(data)
    ]
    rows = tuple(row for row, _ in quantity_rows)
    if not rows:
        return None
    solved = [_length("depth", float(z), "g") for z in np.atleast_1d(data["depth"].to_numpy())]
    depths = f"{', '.join(depth.number for depth in solved)} {solved[0].shown_unit}"
    over = data.attrs.get("mean_over")
    how = (
        f"means over {_length('mean_over', float(over), 'g').text}"
        if over
        else "points, which depend on the cells near edges of ribs"
    )
    note = (
        f"Largest of the depths solved, {depths}, at {how}. Extensions are read only where a principal stress is "
        "tensile. No law ranks them: what is calibrated, and for what, is in the last column."
    )
    any_opens = any(opens for _, opens in quantity_rows)
    heading = "Predicted cracking by criterion" if any_opens else "Largest values by criterion"
    return FirstPage(heading, "", _RESPONSE, rows, note)


def short_source(source: str) -> str:
    """A source up to its year; the whole stands under Methods."""
    return re.split(r"(?<=\)),|; ", source)[0]


def _response_row(quantity: Quantity, data: xr.Dataset) -> tuple[tuple[str, ...], bool]:
    """Cells of the table, and whether a crack runs down there."""
    values = cut(quantity.values(data), quantity.opens(data))
    at = index_of_largest(values)
    largest = float(values[at])
    depth, y, x = (float(data[name][k]) for name, k in zip(("depth", "y", "x"), at, strict=True))
    way, opens = "–", False
    if largest > 0:
        normal = quantity.crack(data)
        way = quantity.harm
        if normal is not None and _is_tensile(data, at):
            angle, dip = (np.asarray(part[at]) for part in crack_plane(normal))
            word = ORIENTATIONS[int(orientation(angle, dip, OBLIQUE_TOLERANCE))]
            way, opens = in_a_cell(word), opens_down(word)
        elif normal is not None:
            way = "none: nothing is tensile"
    # Numbers stay on the line of what they belong to.
    places = (
        with_minus(f"{name} = {_length(name, at, 'z.0f').text}").replace(" ", "\u00a0")
        for name, at in (("x", x), ("y", y))
    )
    where = ", ".join((_deep(depth), *places)) if largest > 0 else "–"
    shown = Display("", "", quantity.in_words)
    read = typeset(row("largest_reading", largest, display=shown)) if largest > 0 else "none"
    name = f"{quantity.words}, {NAMES[quantity.strain]}" if quantity.extends else quantity.words
    return (name, short_source(quantity.source), read, where, way, quantity.calibrated), opens


def _is_tensile(data: xr.Dataset, at: tuple[int, ...]) -> bool:
    return bool(in_tension(data)[at])


def _deep(depth: float) -> str:
    return "surface" if depth == 0 else f"{_length('depth', depth, 'g').text} deep"


def _length(key: str, value: float, form: str) -> Row:
    """A length, m, as it is shown. form: of millimetres."""
    return Row(key, key, value, "mm", form)
