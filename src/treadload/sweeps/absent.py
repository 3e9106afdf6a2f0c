"""Layers that a row of a table of cases does not have: a thickness of 0, or none where that is what it means."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from treadload.case import Case
from treadload.case.keys import find_key, value_at
from treadload.errors import InputError
from treadload.tables import NO_DATA
from treadload.units import quantity

_OF_LAYER = re.compile(r"(pavement\.layers\.\d+)\.(.+)")
_EMPTY = {"", "-", "–", "none", *(word.casefold() for word in NO_DATA)}


@dataclass(frozen=True)
class LayerColumns:
    """Columns of a table that belong to a layer which can be absent.

    thickness: name of the column. case_values: of the case, by the names of the other columns of the layer.
    is_top: True of the surface layer, whose empty cells are missing data: no road leaves its surface out.
    """

    thickness: str
    case_values: Mapping[str, object]
    is_top: bool


def layer_columns(case: Case, names: Sequence[str]) -> tuple[LayerColumns, ...]:
    """Of the layers whose thickness a table has; names: of its columns that are keys."""
    by_layer: dict[str, dict[str, str]] = {}
    for name in names:
        match = _OF_LAYER.fullmatch(find_key(case, name))
        if match is not None:
            by_layer.setdefault(match[1], {})[match[2]] = name
    columns = []
    for path, keys in by_layer.items():
        # A layer without thickness is semi-infinite, and always there.
        if "thickness" in keys and value_at(case, f"{path}.thickness") is not None:
            case_values = {name: value_at(case, f"{path}.{key}") for key, name in keys.items() if key != "thickness"}
            columns.append(LayerColumns(keys["thickness"], case_values, path.endswith(".0")))
    return tuple(columns)


def absent_in(
    layers: Sequence[LayerColumns], cells: Mapping[str, object], units: Mapping[str, str], *, empty_is_absent: bool
) -> dict[str, object]:
    """Values in the columns of the layers that a row does not have: a thickness of 0, and what the case has.

    cells: of the row. units: of the columns, "" for none. empty_is_absent: whether a layer below the surface is
    absent where all its cells are empty.
    """
    values: dict[str, object] = {}
    for layer in layers:
        cell = cells[layer.thickness]
        if _is_empty(cell):
            absent = (
                empty_is_absent and not layer.is_top and all(_is_empty(cells[name]) for name in layer.case_values)
            )
        else:
            absent = _is_zero(cell, units[layer.thickness])
        if absent:
            # A modulus of a layer that is not there is not read.
            values |= {layer.thickness: 0.0, **layer.case_values}
    return values


def _is_empty(cell: object) -> bool:
    return cell is None or (isinstance(cell, str) and cell.strip().casefold() in _EMPTY)


def _is_zero(cell: object, unit: str) -> bool:
    try:
        return quantity(f"{cell} {unit}".strip(), "m") == 0
    except InputError:
        return False
