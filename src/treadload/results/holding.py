"""A dataset from a file becomes an object only where it holds the variables that its class reads."""

from __future__ import annotations

import functools
import types
import typing
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, Literal, Union, get_args, get_origin

import numpy as np

from treadload.composing import BaseResult, Holds
from treadload.deferred import xarray as xr
from treadload.errors import InputError, one_line
from treadload.results.schema import check_fields, check_number, each, read_json, short
from treadload.variables import in_order

# What a class raises that is made of the wrong things.
_WRONG = (TypeError, ValueError, AttributeError, ArithmeticError, LookupError)


def result_of(kind: type[BaseResult], values: Mapping[str, Any], where: str) -> Any:
    """The result of this class. values: its fields by name. where: the file and the part.

    Raises InputError where a field is not what its annotation states, and as `check_dataset`.
    """
    hints = _hints(kind)
    for name, value in values.items():
        try:
            fits = _fits(value, hints.get(name, Any))
        except TypeError as error:  # of a class of another package
            raise InputError(
                f"{where}: the field {name} of {kind.__name__} is annotated {hints[name]!r}, which no value can be "
                "compared with; annotate it with a class, or with Any"
            ) from error
        if not fits:
            raise InputError(f"{where}: the {name} of a {kind.__name__} cannot be {short(value)}; compute it again")
    dataset = values.get("dataset")
    if isinstance(dataset, xr.Dataset):
        check_dataset(kind, dataset, where, values)
        values = {**values, "dataset": in_order(dataset)}
    try:
        return kind(**values)
    except InputError as error:
        raise InputError(f"{where}: {error}") from error
    except _WRONG as error:
        raise InputError(f"{where}: no {kind.__name__} can be made of what it holds: {reason_of(error)}") from error


def check_dataset(
    kind: type[BaseResult], data: xr.Dataset, where: str, values: Mapping[str, Any] = MappingProxyType({})
) -> None:
    """Raise InputError where a dataset lacks what results of a class must hold, see `composing.Holds`.

    where: the file and the part. values: the other fields of the result, where they are known already.
    """
    holds = kind.holds
    for name, _ in each(holds.fields):
        _there(data, name, where)
    check_fields(holds, data, where)
    for of, names in holds.with_field.items():
        for name in names.split() if values.get(of) is not None else ():
            _there(data, name, where)
    for name, dims in each(holds.labels):
        label = _there(data, name, where)
        if set(label.dims) != set(dims.split()):
            raise InputError(f"{where}: {name} must be over {dims}, and is over {_listed(label.dims)}")
        if label.dtype.kind not in "UO":
            raise InputError(f"{where}: {name} holds {label.dtype}, not texts")
    for name in holds.not_nan.split():
        if data[name].isnull().all():
            raise InputError(f"{where}: {name} is NaN everywhere")
    for name in holds.positive.split():
        if name in data.variables and not (data[name] > 0).all():
            raise InputError(f"{where}: {name} is not above zero everywhere")
    _check_places(data, values, holds, where)
    _check_attributes(data, holds, where)
    stats = values.get("stats", {})
    for entries in (names.split() for names in holds.stats):
        for name in entries if entries[0] in stats else ():
            check_number(_number(stats.get(name)), f"{where}: the entry {name} of stats")
    if holds.reads is not None:
        try:
            holds.reads(data, values)
        except InputError as error:
            raise InputError(f"{where}: {error}") from error
        except _WRONG as error:
            raise InputError(f"{where}: it cannot be read as a {kind.__name__}: {reason_of(error)}") from error


def reason_of(error: Exception) -> str:
    """What another library raised, in a part of a sentence."""
    return one_line(f"{type(error).__name__}: {error}")[:120]


def _check_places(data: xr.Dataset, values: Mapping[str, Any], holds: Holds, where: str) -> None:
    """How many places there are along a dimension, and what they are called."""
    for dim, (fewest, most) in holds.sizes.items():
        if not fewest <= data.sizes.get(dim, 0) <= most:
            raise InputError(
                f"{where} has {data.sizes.get(dim, 0)} places along {dim}, and needs {_range(fewest, most)}"
            )
    for dim, names in holds.values.items():
        if sorted(_names(_there(data, dim, where))) != sorted(names):
            raise InputError(f"{where}: {dim} must name {_listed(names)}, and names {_listed(_names(data[dim]))}")
    for dim, of in holds.each.items():
        if of not in values:
            continue
        entries = values[of]
        if data.sizes.get(dim, 0) != len(entries):
            raise InputError(
                f"{where} has {data.sizes.get(dim, 0)} places along {dim}, and {len(entries)} {of} that were asked"
            )
        called = [getattr(entry, "name", None) for entry in entries]
        by_name = (
            dim in data.coords and data[dim].dtype.kind in "UO" and all(isinstance(name, str) for name in called)
        )
        if by_name and _names(data[dim]) != called:
            raise InputError(f"{where}: {dim} names {_listed(_names(data[dim]))}, and asked was {_listed(called)}")


def _check_attributes(data: xr.Dataset, holds: Holds, where: str) -> None:
    attrs = data.attrs
    needed = [*holds.numbers.split(), *holds.texts.split(), *holds.lists.split(), *holds.members.split()]
    for together in (names.split() for names in holds.together):
        needed += together if together[0] in attrs else []
    for name in needed:
        if name not in attrs:
            raise InputError(f"{where} lacks the attribute {name!r}; compute it again")
    for name in holds.texts.split():
        if not isinstance(attrs[name], str):
            raise InputError(f"{where}: the attribute {name} must be text, got {short(attrs[name])}")
    for name in holds.members.split():
        if not _fits(attrs[name], list[str]):
            raise InputError(f"{where}: the attribute {name} must be a list of texts, got {short(attrs[name])}")
    for name in holds.lists.split():
        if not _fits(read_json(attrs[name], [None]), list[str]):
            raise InputError(f"{where}: the attribute {name} must be texts as JSON, got {short(attrs[name])}")


def _there(data: xr.Dataset, name: str, where: str) -> xr.DataArray:
    if name not in data.variables:
        raise InputError(f"{where} lacks {name!r}; compute it again, or take the part out")
    return data[name]


def _names(coordinate: xr.DataArray) -> list[str]:
    return [str(item) for item in np.atleast_1d(coordinate.to_numpy()).ravel()]


def _listed(names: Any) -> str:
    return short([str(name) for name in names]).strip("[]") or "nothing"


def _range(fewest: int, most: float) -> str:
    return f"{fewest}" if fewest == most else f"at least {fewest}"


def _number(value: Any) -> Any:
    """A number, also where it is a yes or no."""
    return int(value) if isinstance(value, bool) else value


@functools.cache
def _hints(kind: type[Any]) -> Mapping[str, Any]:
    try:
        return typing.get_type_hints(kind)
    except NameError:  # of a class of another package that imports for its types alone
        return {}


def _fits(value: Any, hint: Any) -> bool:
    """True where a value is what an annotation of a field states; of protocols and functions nothing is known."""
    origin, inner = get_origin(hint), get_args(hint)
    if origin in (Union, types.UnionType):
        return any(_fits(value, arm) for arm in inner)
    if origin is Literal:
        return any(type(value) is type(arm) and value == arm for arm in inner)
    if origin is tuple:
        if not isinstance(value, tuple | list | np.ndarray):
            return False
        each = inner[:1] * len(value) if inner[-1:] == (Ellipsis,) else inner
        return len(value) == len(each) and all(map(_fits, value, each))
    if origin is list:
        return isinstance(value, list) and all(_fits(item, inner[0]) for item in value)
    if origin is not None:
        return not isinstance(origin, type) or isinstance(value, origin)
    if hint is Any:
        return True
    if hint is None:
        return value is None
    if hint in (int, float):
        numbers = int | np.integer if hint is int else int | float | np.integer | np.floating
        return isinstance(value, numbers) and not isinstance(value, bool)
    if not isinstance(hint, type) or getattr(hint, "_is_protocol", False):
        return True
    return isinstance(value, hint)
