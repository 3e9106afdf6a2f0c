"""What results were asked, as JSON text and arrays, and back as the objects they were.

Descriptions are frozen dataclasses: their fields hold everything. A file is read without trust: it can name classes
of this package, and those that an installed package declares as entry points, and every number passes the checks of
its class. What a file cannot hold, a scan's mesh or a function, comes back as an object that raises an error when it
is used.
"""

from __future__ import annotations

import dataclasses
import functools
import math
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib import metadata
from types import MappingProxyType
from typing import Any

import numpy as np

from treadload.case import Case
from treadload.composing import BaseResult, result_class
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.registry import OURS, load_point, package_with
from treadload.results.dataset import Fields
from treadload.results.holding import reason_of, result_of
from treadload.tire import Tire
from treadload.tire.recorded import RecordedSurface
from treadload.tire.surface import Surface

_OURS = "treadload"
# At which functions of temperature are tabulated, °C.
_DEGREES = range(-30, 71)
_GROUPS = "treadload."
FORMER_NAMES: Mapping[str, str] = {"doubts": "caveats", "doubt": "caveat"}
"""Names of fields and attributes in earlier files, and what they are called now."""


@dataclass(frozen=True)
class Tabulated:
    """A function of temperature among a result's inputs, tabulated: a file holds no code.

    words: its name. temperatures: °C. values: what it gave there, a number or a law.
    """

    words: str
    temperatures: tuple[float, ...] = ()
    values: tuple[Any, ...] = ()

    def __call__(self, temperature: Any = math.nan) -> Any:
        """What it gave at a temperature, °C. Raises InputError for one that is not in the table."""
        if temperature in self.temperatures:
            return self.values[self.temperatures.index(temperature)]
        range_text = f", which was tabulated from {min(self.temperatures):g} to {max(self.temperatures):g} °C"
        raise InputError(
            f"{self.words} is a function{range_text if self.temperatures else ''}, and result files hold no code; "
            "give it again"
        )

    @classmethod
    def of(cls, function: Any) -> Tabulated:
        """A function as a table, empty where it does not take a temperature."""
        words = str(getattr(function, "__qualname__", type(function).__name__))
        values = {}
        for temperature in _DEGREES:
            try:
                values[float(temperature)] = function(float(temperature))
            # Whatever a function outside its range or of something else raises: it is not known there.
            except Exception:
                continue
        return cls(words, tuple(values), tuple(values.values()))

    def __str__(self) -> str:
        return self.words


@dataclass(eq=False)
class Writer:
    """Turns objects into what JSON holds. arrays: met on the way, by name, equal ones once.

    name_of: gives a part of the same tree its name.
    """

    name_of: Callable[[BaseResult], str]
    arrays: dict[str, np.ndarray] = field(default_factory=dict)
    _names: dict[tuple[Any, ...], str] = field(default_factory=dict)

    def result(self, result: BaseResult) -> dict[str, Any]:
        """The question of a result: all its fields but the dataset, whose attributes are kept as they are."""
        values = {entry.name: getattr(result, entry.name) for entry in _fields(result) if entry.name != "dataset"}
        package = package_with(type(result).__module__)
        return {
            "is": type(result).__name__,
            **({} if package == OURS else {"of": package}),
            "with": {name: self.value(value) for name, value in values.items()},
            "attrs": self.value(dict(result.dataset.attrs)),
        }

    def value(self, value: Any) -> Any:
        """A value as JSON can hold it."""
        if value is None or (isinstance(value, bool | str | int) and type(value).__module__ == "builtins"):
            return value
        if isinstance(value, np.generic):
            return self.value(value.item())
        if isinstance(value, float):
            return value if math.isfinite(value) else {"number": repr(value)}
        if isinstance(value, list):
            return [self.value(item) for item in value]
        if isinstance(value, tuple):
            return {"tuple": [self.value(item) for item in value]}
        if isinstance(value, Mapping | MappingProxyType):
            return {"table": [[self.value(key), self.value(item)] for key, item in value.items()]}
        if isinstance(value, np.ndarray):
            return {"array": self._array(value)}
        if isinstance(value, xr.DataArray):
            return {"fields": {key: self.value(part) for key, part in _parts_of(value).items()}}
        if isinstance(value, BaseResult):
            return {"part": self.name_of(value)}
        if isinstance(value, Case):
            return {"case": value.to_toml(), "of": type(value).__name__}
        # A tire can all that its surface can.
        scanned = isinstance(value, Surface) and not isinstance(value, Tire | RecordedSurface)
        if scanned and value.quality is not None:
            arrays = {
                name: getattr(value, name)
                for name in ("camber", "outer_radius", "crown_arc_radius", "cross_section")
                if hasattr(value, name)
            }
            value = RecordedSurface(str(value), value.extent, value.quality, **arrays)
        if dataclasses.is_dataclass(value) and not isinstance(value, type):
            values = {entry.name: self.value(getattr(value, entry.name)) for entry in _fields(value)}
            return {"is": _name_of(type(value)), "with": values}
        if callable(value):
            return self.value(Tabulated.of(value))
        raise InputError(f"no result file can hold {type(value).__name__}, which is among the inputs of one")

    def _array(self, values: np.ndarray) -> str:
        key = (values.shape, values.dtype.str, np.ascontiguousarray(values).tobytes())
        if key not in self._names:
            self._names[key] = f"array_{len(self._names)}"
            self.arrays[self._names[key]] = values
        return self._names[key]


@dataclass(frozen=True, eq=False)
class Reader:
    """Turns what JSON holds into objects. arrays: by name. part: gives a part of the same tree. where: for errors."""

    arrays: Mapping[str, np.ndarray]
    part: Callable[[str], Any]
    where: str

    def result(self, question: Any, dataset: xr.Dataset, name: str) -> BaseResult:
        """The result that was asked this, with its dataset. name: of the part. Raises InputError."""
        try:
            if not isinstance(question["is"], str):
                raise TypeError("the name of a class is a text")
            kind = result_class(question["is"])
            if kind is None:
                missing = {"unknown_class": question["is"], "package": str(question.get("of", ""))}
                return Fields(dataset.assign_attrs(missing))
            values = {str(name): self.value(item) for name, item in question["with"].items()}
            attrs = self.value(question["attrs"])
            attrs = renamed(attrs) if isinstance(attrs, dict) else attrs
        except (KeyError, TypeError, AttributeError) as error:
            raise InputError(
                f"{self.where}: the inputs of the part {name!r} cannot be read: {reason_of(error)}"
            ) from error
        if not isinstance(attrs, dict):
            raise InputError(f"{self.where}: the inputs of the part {name!r} cannot be read: {_cut(attrs)}")
        if any(entry.name == "dataset" for entry in dataclasses.fields(kind)):  # type: ignore[arg-type]
            values["dataset"] = dataset.drop_attrs(deep=False).assign_attrs(attrs)
        return result_of(kind, values, f"{self.where}: the part {name!r}")  # type: ignore[no-any-return]

    def value(self, written: Any) -> Any:
        """The value that `Writer.value` wrote. Raises InputError."""
        if isinstance(written, list):
            return [self.value(item) for item in written]
        if not isinstance(written, dict):
            return written
        if "is" in written:
            values = {str(name): self.value(item) for name, item in _table(written.get("with")).items()}
            return self._object(self._class(written["is"]), values)
        for kind, read in _KINDS.items():
            if kind in written:
                return read(self, written[kind], written)
        raise InputError(f"{self.where}: {_cut(written)} is not a possible input of a result")

    def array(self, name: Any, _: Any = None) -> np.ndarray:
        """A copy of an array by its name."""
        if not isinstance(name, str) or name not in self.arrays:
            raise InputError(f"{self.where}: the array {_cut(name)} of its inputs is missing")
        return self.arrays[name].copy()

    @functools.cached_property
    def _classes(self) -> dict[str, type[Any]]:
        return _described()

    def _class(self, name: Any) -> type[Any]:
        if isinstance(name, str) and name in self._classes:
            return self._classes[name]
        groups = [group for group in metadata.entry_points().groups if group.startswith(_GROUPS)]
        for point in (point for group in groups for point in metadata.entry_points(group=group)):
            if point.value == name:
                kind = load_point(point)
                assert isinstance(kind, type)
                return kind
        raise InputError(
            f"{self.where}: {_cut(name)} is unknown to this treadload; install the package that brings it"
        )

    def _object(self, kind: type[Any], values: dict[str, Any]) -> Any:
        fields = {entry.name for entry in dataclasses.fields(kind)} if dataclasses.is_dataclass(kind) else set()
        try:
            return kind(**{name if name in fields else FORMER_NAMES.get(name, name): values[name] for name in values})
        except InputError as error:
            raise InputError(f"{self.where}: {error}") from error
        except (TypeError, ValueError, AttributeError, ArithmeticError, LookupError) as error:
            raise InputError(
                f"{self.where}: no {kind.__name__} can be made of what it holds: {reason_of(error)}"
            ) from error


def renamed(attrs: Mapping[Any, Any]) -> dict[Any, Any]:
    """Attributes of a file by their present names."""
    return {FORMER_NAMES.get(name, name): value for name, value in attrs.items()}


def _number(reader: Reader, text: Any, _: Any) -> float:
    if text not in ("nan", "inf", "-inf"):
        raise InputError(f"{reader.where}: {_cut(text)} is not a number")
    return float(text)


def _tuple(reader: Reader, written: Any, _: Any) -> tuple[Any, ...]:
    return tuple(reader.value(item) for item in _list(reader, written))


def _pairs(reader: Reader, written: Any, _: Any) -> dict[Any, Any]:
    pairs = [_list(reader, pair) for pair in _list(reader, written)]
    if any(len(pair) != 2 or not isinstance(pair[0], str | int | float) for pair in pairs):
        raise InputError(f"{reader.where}: {_cut(written)} is not a table")
    return {key: reader.value(item) for key, item in pairs}


def _fields_back(reader: Reader, written: Any, _: Any) -> xr.DataArray:
    parts = {key: reader.value(item) for key, item in _table(written).items()}
    try:
        return xr.DataArray(**parts)
    except (TypeError, ValueError) as error:
        raise InputError(f"{reader.where}: an input cannot be read: {reason_of(error)}") from error


def _case(reader: Reader, text: Any, whole: Any) -> Case:
    return Case.from_text(str(text), name=f"{reader.where}: the case")


_KINDS: Mapping[str, Callable[[Reader, Any, Any], Any]] = {
    "number": _number,
    "tuple": _tuple,
    "table": _pairs,
    "array": Reader.array,
    "fields": _fields_back,
    "part": lambda reader, written, _: reader.part(written),
    "case": _case,
}


def _fields(thing: Any) -> list[dataclasses.Field[Any]]:
    return [entry for entry in dataclasses.fields(thing) if entry.init]


def _parts_of(array: xr.DataArray) -> dict[str, Any]:
    coords = {
        str(name): (coordinate.dims, coordinate.to_numpy(), dict(coordinate.attrs))
        for name, coordinate in array.coords.items()
    }
    return {
        "data": array.to_numpy(), "coords": coords, "dims": array.dims, "name": array.name,
        "attrs": dict(array.attrs),
    }  # fmt: skip


def _name_of(kind: type[Any]) -> str:
    """Name of a class in a file: its own, so that it may move between our rooms; else with its module."""
    if kind.__module__.partition(".")[0] == _OURS:
        return kind.__name__
    return f"{kind.__module__}:{kind.__qualname__}"


def _described() -> dict[str, type[Any]]:
    """Dataclasses of this package by name: what describes a tire, a road, a law."""
    kinds: dict[str, type[Any]] = {}
    for name, module in list(sys.modules.items()):
        if name.partition(".")[0] != _OURS:
            continue
        classes = [
            member for member in list(vars(module).values()) if isinstance(member, type) and member.__module__ == name
        ]
        for member in classes:
            if dataclasses.is_dataclass(member) and not issubclass(member, BaseResult):
                kinds.setdefault(member.__name__, member)
    return kinds


def _list(reader: Reader, written: Any) -> list[Any]:
    if not isinstance(written, list):
        raise InputError(f"{reader.where}: {_cut(written)} is not a list")
    return written


def _table(written: Any) -> dict[Any, Any]:
    return written if isinstance(written, dict) else {}


def _cut(written: Any) -> str:
    return repr(written)[:60]
