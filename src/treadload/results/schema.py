"""What a tree of results must be like, so that whatever reads it can rely on it: checked in one place.

Groups may be absent, and most variables too. What is there has the units that `variables.py` and the dimensions and
kind of numbers that its class (`composing.Holds`) states.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from typing import Any

import numpy as np

from treadload.composing import BaseResult, Holds, class_of_group, result_classes
from treadload.deferred import xarray as xr
from treadload.errors import InputError, one_line
from treadload.files import parse_toml
from treadload.kernels.arrays import Array
from treadload.variables import VARIABLES

# Texts that a file and each of its groups may have.
_TEXTS = ("title", "case", "treadload_version", "created", "season", "summary")
_TEXTS_OF_A_GROUP = ("result", "part_of", "summary", "sentence", "rows")
# Dimensions that lie in the road, with a coordinate of numbers; the others are counted or named.
_LENGTHS = ("x", "y", "depth")
_COMPONENTS = 3
# No quantity of a tire or a road reaches it in SI units, and figures overflow not far beyond.
_LARGEST = 1e30
# Letters of a wrong value in a sentence.
_SHOWN = 100
_ANY, _AT = "...", "@"


def check_tree(tree: xr.DataTree, name: str) -> None:
    """Raise InputError that states what in a tree of results cannot be read. name: of the file or case."""
    _check_root(tree.attrs, name)
    for group, node in tree.children.items():
        where = f"{name}: the group /{group}"
        check_texts(node.attrs, _TEXTS_OF_A_GROUP, where)
        if node.data_vars:
            kind = _class_of(node.attrs.get("result") or str(group))
            if kind is not None:
                check_fields(kind.holds, node.to_dataset(), where)


def _class_of(kind: str) -> type[BaseResult] | None:
    """The class by which a group of this kind is checked before it is read; None without one."""
    classes = result_classes()
    group = classes[name].group if (name := class_of_group(kind)) else kind
    return next((kind for kind in classes.values() if kind.group == group and kind.holds.tree), None)


def check_texts(attrs: Mapping[Any, Any], names: Iterable[str], where: str) -> None:
    """Raise InputError where an attribute of these names is there and no text."""
    for key in names:
        if not isinstance(attrs.get(key, ""), str):
            raise InputError(f"{where}: the attribute {key} must be text, got {short(attrs[key])}")


def _check_root(attrs: Mapping[Any, Any], name: str) -> None:
    check_texts(attrs, _TEXTS, name)
    parse_toml(attrs.get("case", ""), f"{name}: the case that it holds")
    texts = _json_attributes(attrs, {"layers": list}, name)
    for number, layer in enumerate(texts.get("layers", ()), start=1):
        lacking = [key for key in ("modulus", "poisson") if not _is_number(_key(layer, key))]
        keys = [key for key in ("thickness", "temperature", "frequency") if _key(layer, key) is not None]
        lacking += [key for key in keys if not _is_number(layer[key])]
        lacking += [key for key in ("name", "bond") if not isinstance(_key(layer, key) or "", str)]
        if lacking:
            raise InputError(f"{name}: layer {number} of the attribute layers has no {lacking[0]} that can be read")


def check_fields(holds: Holds, data: xr.Dataset, where: str) -> None:
    """Raise InputError where what a dataset has is not as its class states. where: the file and the group."""
    if holds.tree:
        for name in _LENGTHS:
            if name in data.dims:
                _check_coordinate(data, name, where)
        if data.sizes.get("component", _COMPONENTS) != _COMPONENTS:
            raise InputError(f"{where} has {data.sizes['component']} components of a direction in space, not 3")
    needed = [*holds.tree.split(), *(required for name, required in holds.with_it.items() if name in data.variables)]
    lacking = next((name for name in needed if name not in data.variables), None)
    if lacking is not None:
        raise InputError(f"{where} lacks {lacking!r}; compute the case again, or remove the group")
    for name, dims in [*each(holds.fields), *each(holds.maybe)]:
        if name in data.variables:
            _check_field(data[name], _dimensions(dims, data), holds, f"{where}: {name}")
    for name in (*holds.numbers.split(), *holds.maybe_numbers.split()):
        if name in data.attrs:
            check_number(data.attrs[name], f"{where}: the attribute {name}", positive=name in holds.positive.split())
    _json_attributes(data.attrs, holds.json, where)
    _check_interfaces(data.attrs, where)
    if holds.agree is not None:
        try:
            holds.agree(data)
        except InputError as error:
            raise InputError(f"{where}: {error}") from error


def each(named: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """Pairs of a name and its description, from names with blanks between."""
    return ((name, words) for names, words in named.items() for name in names.split())


def _dimensions(words: str, data: xr.Dataset) -> list[str]:
    return words.replace(_AT, "point" if "point" in data.dims else "y x").split()


def _check_coordinate(data: xr.Dataset, name: str, where: str) -> None:
    """Coordinates present, finite, in m, increasing; depths in the road, repeated for both sides of an interface."""
    if not data.sizes[name]:
        raise InputError(f"{where} is empty: it has no {name}")
    if name not in data.coords:
        raise InputError(f"{where} has {data.sizes[name]} rows along {name} and does not state where they lie")
    _check_field(data[name], [name], Holds(finite=name), f"{where}: {name}")
    steps = np.diff(data[name].to_numpy())
    if (steps < 0).any() or (name != "depth" and (steps == 0).any()):
        raise InputError(f"{where}: {name} does not increase everywhere; sort it")
    if name == "depth":
        _check_depths(data[name].to_numpy(), where)


def _check_depths(depths: Array, where: str) -> None:
    if depths[0] < 0:
        raise InputError(f"{where}: depth is {depths[0]:g} m, above the road; depth counts downwards")
    often = depths[2:][depths[2:] == depths[:-2]]
    if often.size:
        raise InputError(
            f"{where}: depth {often[0]:g} m is there more than twice, and an interface has two sides; solve again"
        )


def check_number(value: Any, who: str, *, positive: bool = False) -> None:
    """Raise InputError for what is no number of a quantity. who: the file, the group and the attribute."""
    if not _is_number(value):
        raise InputError(f"{who} must be a finite number, got {short(value)}")
    if abs(value) > _LARGEST or (positive and not value > 0):
        bound = "above zero" if positive and not value > 0 else f"at most {_LARGEST:g}"
        raise InputError(f"{who} must be {bound}, got {value:g}")


def check_numbers(field: xr.DataArray, dims: AbstractSet[str], who: str, *, more: bool = False) -> Array:
    """Values of a variable over these dimensions, or over others besides, in the unit of results.

    who: the file, the group and the name. Raises InputError where they are no numbers, none at all, of another unit.
    """
    if set(field.dims) != dims and not (more and dims < set(field.dims)):
        got, wanted = (", ".join(sorted(map(str, names))) or "no dimension" for names in (field.dims, dims))
        raise InputError(f"{who} is over {got}, not {wanted}")
    if not field.size:
        raise InputError(f"{who} is empty")
    values: Array = field.to_numpy()
    if values.dtype.kind not in "fiu":
        raise InputError(f"{who} holds {values.dtype}, not numbers")
    unit, unit_in_file = VARIABLES.get(str(field.name), (None, ""))[0], field.attrs.get("units")
    if unit_in_file is not None and unit is not None and str(unit_in_file) != unit:
        raise InputError(f"{who} is in {unit_in_file!s}, results are in {unit if unit != '1' else 'pure numbers'}")
    return values


def _check_field(field: xr.DataArray, dims: Sequence[str], holds: Holds, who: str) -> None:
    name, values = str(field.name), check_numbers(field, {*dims} - {_ANY}, who, more=_ANY in dims)
    finite = np.isfinite(values)
    is_finite, is_bounded = name in holds.finite.split(), name in holds.bounded.split()
    if is_finite and not finite.all():
        raise InputError(f"{who} has {int((~finite).sum())} of {values.size} values that are NaN or infinite")
    if is_bounded and (np.isinf(values).any() or not finite.any()):
        raise InputError(f"{who} is infinite somewhere or NaN everywhere")
    largest = holds.largest.get(name, _LARGEST)
    if (is_finite or is_bounded) and (beyond := np.abs(values[finite]) > largest).any():
        raise InputError(
            f"{who} has {int(beyond.sum())} of {values.size} values beyond {largest:g}, which no road and no tire "
            "reaches"
        )
    if name in holds.above_zero.split() and (values <= 0).any():
        raise InputError(f"{who} has {int((values <= 0).sum())} of {values.size} values that are not above zero")
    if name in holds.codes and not np.isin(values, np.arange(holds.codes[name])).all():
        raise InputError(f"{who} has values other than 0 to {holds.codes[name] - 1}")


def _check_interfaces(attrs: Mapping[Any, Any], where: str) -> None:
    depths = np.atleast_1d(np.asarray(attrs.get("interfaces", [])))
    if depths.size and (depths.dtype.kind not in "fiu" or not (np.diff(depths, prepend=0.0) > 0).all()):
        raise InputError(
            f"{where}: the attribute interfaces must be increasing depths in m, got {short(attrs['interfaces'])}"
        )


def _json_attributes(attrs: Mapping[Any, Any], kinds: Mapping[str, type], where: str) -> dict[str, Any]:
    """What the JSON attributes hold, those that are there."""
    texts = {}
    for name, kind in kinds.items():
        if name not in attrs:
            continue
        try:
            texts[name] = json.loads(attrs[name]) if isinstance(attrs[name], str) else None
        except (ValueError, RecursionError):
            texts[name] = None
        if not isinstance(texts[name], kind):
            meant = "a list" if kind is list else "a table"
            raise InputError(f"{where}: the attribute {name} must be {meant} as JSON text, got {short(attrs[name])}")
    return texts


def read_json(text: Any, otherwise: Any) -> Any:
    """What JSON text holds, of the same kind as `otherwise`; that if it holds something else."""
    if not isinstance(text, str):
        return otherwise
    try:
        value = json.loads(text)
    except (ValueError, RecursionError):
        return otherwise
    return value if isinstance(value, type(otherwise)) else otherwise


def short(value: Any) -> str:
    """A value from a file in so few letters that a sentence stays one."""
    text = one_line(repr(value))
    return text if len(text) <= _SHOWN else f"{text[: _SHOWN - 1]}…"


def _key(table: Any, key: str) -> Any:
    return table.get(key) if isinstance(table, dict) else None


def _is_number(value: Any) -> bool:
    kind = isinstance(value, int | float | np.integer | np.floating) and not isinstance(value, bool)
    try:
        return kind and math.isfinite(value)
    except OverflowError:
        return False
