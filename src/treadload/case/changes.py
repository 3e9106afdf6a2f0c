"""Keys of a case set from outside: "rolling.friction=0.6", "pavement.layers.0.thickness=8 cm"."""

from __future__ import annotations

import copy
from collections.abc import Sequence
from typing import Any

from treadload.errors import InputError
from treadload.files import parse_toml

_REMOVED = object()
_EXAMPLE = 'rolling.friction=0.6 or pavement.layers.0.thickness="8 cm"'


def changed(table: dict[str, object], changes: Sequence[str]) -> dict[str, object]:
    """A copy of the tables of a case with keys set.

    changes: "key=value"; parts of a key are joined by points, rows of a list are counted from 0. A value is TOML,
    0.6 or true or [0, 0.02], or else text, 8 cm; without a value the key is removed. Whether the case knows the
    key is checked when it is read. Raises InputError.
    """
    table = copy.deepcopy(table)
    for change in changes:
        key, sign, value = change.partition("=")
        path = key.strip().split(".")
        if not sign or not all(path):
            raise InputError(f"cannot set {change!r}: write key=value, such as {_EXAMPLE}")
        _set(table, path, read_value(value.strip()) if value.strip() else _REMOVED, change)
    return table


def set_key(table: dict[str, object], path: str, value: object) -> None:
    """Set a key in the tables of a case. path: parts joined by points. Raises InputError."""
    _set(table, path.split("."), value, path)


def _set(table: dict[str, object], path: Sequence[str], value: object, change: str) -> None:
    here: Any = table
    for number, part in enumerate(path[:-1]):
        before = ".".join(path[:number])
        if isinstance(here, list):
            here = here[_row(here, part, before, change)]
        elif isinstance(here, dict):
            here = here.setdefault(part, {})
        else:
            raise InputError(f"cannot set {change!r}: {before} is {here!r} and has no keys")
    last, before = path[-1], ".".join(path[:-1])
    if isinstance(here, list):
        row = _row(here, last, before, change)
        if value is _REMOVED:
            del here[row]
        else:
            here[row] = value
    elif not isinstance(here, dict):
        raise InputError(f"cannot set {change!r}: {before} is {here!r} and has no keys")
    elif value is not _REMOVED:
        here[last] = value
    elif last in here:
        del here[last]
    else:
        raise InputError(f"cannot remove {'.'.join(path)}: the case does not give it; it has {', '.join(here)}")


def _row(rows: list[object], part: str, before: str, change: str) -> int:
    if not (part.isascii() and part.isdigit() and int(part) < len(rows)):
        raise InputError(
            f"cannot set {change!r}: {before} is a list of {len(rows)}, whose rows are 0 to {len(rows) - 1}, "
            f"got {part!r}"
        )
    return int(part)


def read_value(value: str) -> object:
    """A value of TOML, or the text itself."""
    try:
        table = parse_toml(f"value = {value}", value)
    except InputError:
        return value
    # A date is not a value of a case, and a second line would be another key.
    plain = isinstance(table["value"], bool | int | float | str | list | dict)
    return table["value"] if plain and len(table) == 1 else value
