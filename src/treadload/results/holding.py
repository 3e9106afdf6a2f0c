"""A dataset from a file becomes an object only where it holds what its class says that it reads."""

from __future__ import annotations

import functools
import types
import typing
from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Any, Literal, Union, get_args, get_origin

import numpy as np
import xarray as xr

from treadload.composing import BaseResult, Holds
from treadload.errors import InputError, one_line
from treadload.results.schema import RESPONSES, check_kind, check_number, check_numbers, read_json, short
from treadload.variables import in_order

# What a class raises that is made of the wrong things.
_WRONG = (TypeError, ValueError, AttributeError, ArithmeticError, LookupError)
_ANY = "..."


def made(kind: type[BaseResult], given: Mapping[str, Any], where: str) -> Any:
    """The result of this class. given: its fields by name. where: the file and the part.

    Raises InputError where a field is not what its annotation says, and as `check_dataset`.
    """
    hints = _hints(kind)
    for name, value in given.items():
        try:
            fits = _fits(value, hints.get(name, Any))
        except TypeError as error:  # of a class of another package
            raise InputError(
                f"{where}: the field {name} of {kind.__name__} is annotated {hints[name]!r}, which no value can be "
                "compared with; annotate it with a class, or with Any"
            ) from error
        if not fits:
            raise InputError(f"{where}: the {name} of a {kind.__name__} cannot be {short(value)}; compute it anew")
    dataset = given.get("dataset")
    if isinstance(dataset, xr.Dataset):
        check_dataset(kind, dataset, where, given)
        given = {**given, "dataset": in_order(dataset)}
    try:
        return kind(**given)
    except InputError as error:
        raise InputError(f"{where}: {error}") from error
    except _WRONG as error:
        raise InputError(f"{where}: no {kind.__name__} can be made of what it holds: {said(error)}") from error


def check_dataset(
    kind: type[BaseResult], data: xr.Dataset, where: str, given: Mapping[str, Any] = MappingProxyType({})
) -> None:
    """Raise InputError where a dataset lacks what results of a class must hold, see `composing.Holds`.

    where: the file and the part. given: the other fields of the result, where they are known already.
    """
    check_kind(data, "points" if "point" in data.dims and kind.group in RESPONSES else kind.group, where)
    holds = kind.holds
    for name, dims in _each(holds.fields):
        _check_field(_there(data, name, where), dims, where)
    for name, dims in _each(holds.maybe):
        if name in data.variables:
            _check_field(data[name], dims, where)
    for of, names in holds.asked.items():
        for name in names.split() if given.get(of) is not None else ():
            _there(data, name, where)
    for name, dims in _each(holds.labels):
        label = _there(data, name, where)
        if set(label.dims) != set(dims.split()):
            raise InputError(f"{where}: {name} must be over {dims}, and is over {_listed(label.dims)}")
        if label.dtype.kind not in "UO":
            raise InputError(f"{where}: {name} holds {label.dtype}, not texts")
    for name in holds.known.split():
        if data[name].isnull().all():
            raise InputError(f"{where}: {name} is NaN everywhere")
    for name in holds.positive.split():
        if name in data.variables and not (data[name] > 0).all():
            raise InputError(f"{where}: {name} is not above zero everywhere")
    _check_places(data, given, holds, where)
    _check_attributes(data, holds, where)
    stats = given.get("stats", {})
    for entries in (one.split() for one in holds.stats):
        for name in entries if entries[0] in stats else ():
            check_number(_number(stats.get(name)), f"{where}: the entry {name} of stats")
    if holds.reads is not None:
        try:
            holds.reads(data, given)
        except InputError as error:
            raise InputError(f"{where}: {error}") from error
        except _WRONG as error:
            raise InputError(f"{where}: it cannot be read as a {kind.__name__}: {said(error)}") from error


def said(error: Exception) -> str:
    """What another library raised, in a part of a sentence."""
    return one_line(f"{type(error).__name__}: {error}")[:120]


def _check_places(data: xr.Dataset, given: Mapping[str, Any], holds: Holds, where: str) -> None:
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
        if of not in given:
            continue
        entries = given[of]
        if data.sizes.get(dim, 0) != len(entries):
            raise InputError(
                f"{where} has {data.sizes.get(dim, 0)} places along {dim}, and {len(entries)} {of} that were asked"
            )
        called = [getattr(one, "name", None) for one in entries]
        by_name = dim in data.coords and data[dim].dtype.kind in "UO" and all(isinstance(one, str) for one in called)
        if by_name and _names(data[dim]) != called:
            raise InputError(f"{where}: {dim} names {_listed(_names(data[dim]))}, and asked was {_listed(called)}")


def _check_attributes(data: xr.Dataset, holds: Holds, where: str) -> None:
    attrs = data.attrs
    needed = [*holds.numbers.split(), *holds.texts.split(), *holds.lists.split(), *holds.members.split()]
    for together in (one.split() for one in holds.together):
        needed += together if together[0] in attrs else []
    for name in needed:
        if name not in attrs:
            raise InputError(f"{where} lacks the attribute {name!r}; compute it anew")
    for name in (*holds.numbers.split(), *holds.maybe_numbers.split()):
        if name in attrs:
            check_number(attrs[name], f"{where}: the attribute {name}", positive=name in holds.positive.split())
    for name in holds.texts.split():
        if not isinstance(attrs[name], str):
            raise InputError(f"{where}: the attribute {name} must be text, got {short(attrs[name])}")
    for name in holds.members.split():
        if not _fits(attrs[name], list[str]):
            raise InputError(f"{where}: the attribute {name} must be a list of texts, got {short(attrs[name])}")
    for name in holds.lists.split():
        if not _fits(read_json(attrs[name], [None]), list[str]):
            raise InputError(f"{where}: the attribute {name} must be texts as JSON, got {short(attrs[name])}")


def _check_field(field: xr.DataArray, dims: str, where: str) -> None:
    words = dims.split()
    check_numbers(field, set(words) - {_ANY}, f"{where}: {field.name}", more=_ANY in words)


def _there(data: xr.Dataset, name: str, where: str) -> xr.DataArray:
    if name not in data.variables:
        raise InputError(f"{where} lacks {name!r}; compute it anew, or take the part out")
    return data[name]


def _each(told: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    return ((name, dims) for names, dims in told.items() for name in names.split())


def _names(coordinate: xr.DataArray) -> list[str]:
    return [str(one) for one in np.atleast_1d(coordinate.to_numpy()).ravel()]


def _listed(names: Any) -> str:
    return short([str(one) for one in names]).strip("[]") or "nothing"


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
    """True where a value is what an annotation of a field says; of protocols and functions nothing is known."""
    origin, inner = get_origin(hint), get_args(hint)
    if origin in (Union, types.UnionType):
        return any(_fits(value, one) for one in inner)
    if origin is Literal:
        return any(type(value) is type(one) and value == one for one in inner)
    if origin is tuple:
        if not isinstance(value, tuple | list | np.ndarray):
            return False
        each = inner[:1] * len(value) if inner[-1:] == (Ellipsis,) else inner
        return len(value) == len(each) and all(map(_fits, value, each))
    if origin is list:
        return isinstance(value, list) and all(_fits(one, inner[0]) for one in value)
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
