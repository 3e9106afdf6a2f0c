"""The keys of a case by their paths, "pavement.layers.0.thickness": which there are, their units, their values."""

from __future__ import annotations

import copy
from collections.abc import Iterator, Mapping
from typing import Annotated, Any, get_args, get_origin

from treadload.case.changes import set_key
from treadload.case.file import FilePart
from treadload.errors import InputError, nearest
from treadload.read import Table
from treadload.read.table import TargetTable, arms
from treadload.units import Unit

# Keys of a layer that a name behind them completes.
_OF_LAYER = {"thickness": "thickness", "modulus": "material.modulus", "poisson": "material.poisson", "mix": "mix"}


def keys_of(case: FilePart) -> dict[str, str | None]:
    """Paths of all keys that the tables of a case know, and the SI unit of those that are numbers ("" if pure)."""
    return dict(_keys(case, ""))


def _keys(table: Table, before: str) -> Iterator[tuple[str, str | None]]:
    hints = table.hints if isinstance(table, TargetTable) else {}
    for name in type(table).known_keys():
        path = f"{before}{name}"
        field = type(table).model_fields[name]
        hint = hints.get(name, Annotated[(field.annotation, *field.metadata)] if field.metadata else field.annotation)
        yield path, _unit(hint)
        value = getattr(table, name, None)
        members = enumerate(value) if isinstance(value, tuple | list) else [(None, value)]
        for number, member in members:
            if isinstance(member, Table):
                yield from _keys(member, f"{path}." if number is None else f"{path}.{number}.")


def _unit(hint: object) -> str | None:
    for arm in arms(hint):
        marks = get_args(arm)[1:] if get_origin(arm) is Annotated else ()
        unit = next((mark.si for mark in marks if isinstance(mark, Unit)), None)
        if unit is not None:
            return str(unit)
        inner = _unit(get_args(arm)[0]) if get_origin(arm) is Annotated else None
        if inner is not None:
            return inner
        if arm is float:
            return ""
    return None


def find_key(case: FilePart, name: str) -> str:
    """The path that a name means: itself, or the one path that ends in it, "friction" for "rolling.friction".

    "thickness base" and "modulus base" are keys of the layer of that name, as in tables of basins.
    Raises InputError for a name that no table has, for one that several have, and for a layer that is not there.
    """
    units = keys_of(case)
    if name in units or "." in name:
        return name
    if (of_layer := _key_of_layer(case, name)) is not None:
        return of_layer
    ends = [path for path in units if path.rpartition(".")[2] == name]
    if len(ends) == 1:
        return ends[0]
    if ends:
        raise InputError(f"the key {name!r} may mean {', '.join(ends)}; write one of these")
    short = sorted({path.rpartition(".")[2] for path in units})
    raise InputError(f"the case has no key {name!r}; {nearest(name, short)}")


def _key_of_layer(case: FilePart, name: str) -> str | None:
    """The path of "thickness base" or "modulus base"; None for any other name. Raises InputError."""
    key, _, layer = name.partition(" ")
    layer = layer.strip()
    if key not in _OF_LAYER or not layer:
        return None
    layers = value_at(case, "pavement.layers")
    parts = layers if isinstance(layers, list | tuple) else ()
    names = [str(getattr(part, "name", "") or getattr(part, "mix", "") or "") for part in parts]
    alike = [number for number, title in enumerate(names) if title.casefold() == layer.casefold()]
    if len(alike) == 1:
        return f"pavement.layers.{alike[0]}.{_OF_LAYER[key]}"
    if alike:
        raise InputError(
            f"{name!r}: {len(alike)} layers have the name {layer!r}; write "
            f"pavement.layers.{alike[0]}.{_OF_LAYER[key]}"
        )
    listed = nearest(layer, names) if any(names) else "give [[pavement.layers]] with names"
    raise InputError(f"{name!r}: no layer has the name {layer!r}; {listed}")


def with_values(table: Mapping[str, object], values: Mapping[str, object]) -> dict[str, object]:
    """A copy of the tables of a case with keys set. values: path → value. Raises InputError."""
    changed = copy.deepcopy(dict(table))
    for path, value in values.items():
        set_key(changed, path, copy.deepcopy(value))
    return changed


def value_at(case: FilePart | Mapping[str, object], path: str) -> object:
    """The value of a key in a case, with its defaults, or in the tables of one; None where it is not given."""
    here: Any = case
    for part in path.split("."):
        if isinstance(here, list | tuple):
            here = here[int(part)] if part.isdigit() and int(part) < len(here) else None
        else:
            table = {part: getattr(here, part, None)} if isinstance(here, Table) else here
            here = table.get(part) if isinstance(table, Mapping) else None
    return here
