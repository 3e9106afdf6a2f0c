"""Which cases a study has: inputs that are varied, over named dimensions."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypedDict

import numpy as np

from treadload.case import Case
from treadload.case.keys import find_key, keys_of, value_at, with_values
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.sweeps.columns import is_finite, is_number, labels_of, listed_values, objects, objects_like
from treadload.variables import VARIABLES

CASE = "case"
"""Dimension of cases that stand in a list."""
# More cases than a study can hold in one table of scalars.
MOST_CASES = 10_000_000
# Of a list of cases, read before any is solved.
_TRIED = 64
ROW = "row"
"""Label of the rows of a file of cases: their numbers there."""
# Names of a study that no label can have.
_TAKEN = (CASE, "status", "seconds", "failure")


@dataclass(frozen=True, eq=False)
class Input:
    """A key that is varied.

    name: of it in results, as the user wrote it. key: its path in the case. unit: SI unit of numbers, "" of pure
    ones, None for what is none. dims: dimensions that it varies over. values: what the case is given, an object array
    over these dimensions. labels: the same as coordinates of a dataset.

    >>> wheel = {"tire": {"profile": "315/80R22.5"}, "rolling": {"normal_load": "32.5 kN", "friction": 0.7}}
    >>> case = tl.Case.from_dict(wheel | {"pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3", "temperature": 15}})
    >>> load = tl.sweeps.from_texts(case, ["normal_load=20e3:40e3:3"]).inputs[0]
    >>> load.key, load.unit, [float(value) for value in load.values]
    ('rolling.normal_load', 'N', [20000.0, 30000.0, 40000.0])
    """

    name: str
    key: str
    unit: str | None
    dims: tuple[str, ...]
    values: np.ndarray
    labels: np.ndarray

    @property
    def is_number(self) -> bool:
        """True if all values are numbers."""
        return self.labels.dtype.kind == "f"


class InputTable(TypedDict):
    """An input as JSON holds it."""

    name: str
    key: str
    dims: list[str]
    values: list[object]


class DesignTable(TypedDict, total=False):
    """A design as JSON holds it."""

    sizes: dict[str, int]
    inputs: list[InputTable]
    labels: dict[str, list[str | int]]
    faults: list[tuple[int, str]]


@dataclass(frozen=True, eq=False)
class Design:
    """The cases of a study.

    sizes: of its dimensions, in order. inputs: what is varied over them. labels: of a list of cases, name → what
    identifies each, the row of its file and the ids that stand there. faults: of a list, why a case cannot be read.

    >>> wheel = {"tire": {"profile": "315/80R22.5"}, "rolling": {"normal_load": "32.5 kN", "friction": 0.7}}
    >>> case = tl.Case.from_dict(wheel | {"pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3", "temperature": 15}})
    >>> design = tl.sweeps.from_texts(case, ["normal_load=20e3:40e3:3", "inflation_pressure=[6e5, 8e5]"])
    >>> f"{design.count} cases", design.at(5)
    ('6 cases', {'rolling.normal_load': 40000.0, 'tire.inflation_pressure': 800000.0})
    """

    sizes: Mapping[str, int]
    inputs: tuple[Input, ...]
    labels: Mapping[str, tuple[str | int, ...]] = field(default_factory=dict)
    faults: Mapping[int, str] = field(default_factory=dict)

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the dimensions."""
        return tuple(self.sizes)

    @property
    def shape(self) -> tuple[int, ...]:
        """Sizes of the dimensions."""
        return tuple(self.sizes.values())

    @property
    def count(self) -> int:
        """Number of cases."""
        return math.prod(self.shape)

    def at(self, number: int) -> dict[str, object]:
        """What case `number` is given, key → value; the last dimension runs fastest."""
        place = dict(zip(self.dims, np.unravel_index(number, self.shape), strict=True))
        return {variable.key: variable.values[tuple(place[dim] for dim in variable.dims)] for variable in self.inputs}

    def words_of(self, number: int) -> str:
        """Case `number` in words: "friction 0.3, normal_load 2e+04"; with its labels first."""
        place = dict(zip(self.dims, np.unravel_index(number, self.shape), strict=True))
        words = [f"{name} {values[number]}" for name, values in self.labels.items()]
        for variable in self.inputs:
            label = variable.labels[tuple(place[dim] for dim in variable.dims)]
            unit = f" {variable.unit}" if variable.unit else ""
            value = f"{label:.6g}{unit}" if variable.is_number else str(label)
            words.append(
                f"{variable.name} {value}" if value and not value.startswith("nan") else f"no {variable.name}"
            )
        return ", ".join(words)

    def named(self, number: int) -> str:
        """Case `number` by its labels: "row 3 (section A12)"; "" without labels."""
        first, *more = [f"{name} {values[number]}" for name, values in self.labels.items()] or [""]
        return f"{first} ({', '.join(more)})" if more else first

    def coordinates(self) -> dict[str, tuple[tuple[str, ...], np.ndarray, dict[str, str]]]:
        """The inputs as coordinates of a dataset: name → (dimensions, values, attributes)."""
        coordinates = {}
        for variable in self.inputs:
            leaf = variable.key.rpartition(".")[2]
            about = {
                "key": variable.key,
                "long_name": VARIABLES[leaf][1] if leaf in VARIABLES else leaf.replace("_", " "),
            }
            if variable.unit is not None:
                about["units"] = variable.unit or "1"
            coordinates[variable.name] = (variable.dims, variable.labels, about)
        for name, values in self.labels.items():
            about = {"long_name": "row of the table" if name == ROW else name.removeprefix("id_")}
            coordinates[name] = ((CASE,), np.array(values), about)
        return coordinates

    def to_json(self) -> dict[str, object]:
        """The design as what JSON holds."""
        return {
            "sizes": dict(self.sizes),
            "inputs": [
                {
                    "name": variable.name,
                    "key": variable.key,
                    "dims": list(variable.dims),
                    "values": variable.values.ravel().tolist(),
                }
                for variable in self.inputs
            ],
            **({"labels": {name: list(values) for name, values in self.labels.items()}} if self.labels else {}),
            **({"faults": [[number, text] for number, text in self.faults.items()]} if self.faults else {}),
        }

    @classmethod
    def from_json(cls, document: DesignTable, case: Case) -> Design:
        """The design that `to_json` wrote, of the same case. Raises InputError."""
        try:
            sizes = {str(dim): int(size) for dim, size in document["sizes"].items()}
            parts = [
                (str(entry["name"]), str(entry["key"]), tuple(map(str, entry["dims"])), list(entry["values"]))
                for entry in document["inputs"]
            ]
            if min(sizes.values(), default=0) < 1 or math.prod(sizes.values()) > MOST_CASES:
                raise ValueError("sizes of its dimensions")
            units = keys_of(case)
            inputs = []
            for name, key, dims, values in parts:
                array = objects(values).reshape([sizes[dim] for dim in dims])
                inputs.append(Input(name, key, units.get(key), dims, array, labels_of(array)))
            labels = {str(name): tuple(values) for name, values in document.get("labels", {}).items()}
            if any(len(values) != sizes.get(CASE) for values in labels.values()):
                raise ValueError("labels of its cases")
            faults = {int(number): str(text) for number, text in document.get("faults", ())}
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            raise InputError(f"the design of the study cannot be read: {error}") from error
        return cls(sizes, tuple(inputs), labels, faults)


def product(case: Case, vary: Mapping[str, object]) -> Design:
    """Every combination of the values: one dimension for each input.

    vary: key → values in SI units or with their units. Raises InputError for a key that the case does not have and
    for a value that it does not take.
    """
    columns = {name: listed_values(name, values) for name, values in vary.items()}
    if not columns:
        raise InputError("nothing is varied; give keys and values, such as {'rolling.friction': [0.3, 0.5, 0.7]}")
    return checked_design(case, {name: ((name,), objects(values)) for name, values in columns.items()})


def listed(
    case: Case,
    rows: Sequence[Mapping[str, object]],
    *,
    labels: Mapping[str, Sequence[str | int]] | None = None,
    faults: Mapping[int, str] | None = None,
) -> Design:
    """Cases in a list, over the dimension "case".

    rows: key → value of each, the same keys in all, None where it has no value. labels: name → what identifies each.
    faults: number of a case → why it cannot be read, known beforehand. A case whose values cannot be read has a fault
    and fails alone. Raises InputError for keys that the case does not have, and where no case can be read.
    """
    if not rows:
        raise InputError("the list of cases is empty; give at least one")
    names = list(rows[0])
    for number, row in enumerate(rows):
        if set(row) != set(names):
            raise InputError(f"case {number} gives {', '.join(row)}, the first one {', '.join(names)}; give the same")
    taken = {*names, *_TAKEN}
    named = {
        in_a_word(f"id_{name}" if name in taken else name): tuple(values) for name, values in (labels or {}).items()
    }
    columns = {name: ((CASE,), objects([row[name] for row in rows])) for name in names}
    return checked_design(case, columns, faults=faults or {}, labels=named)


def from_dataset(case: Case, data: xr.Dataset) -> Design:
    """Cases from a dataset: variables, and coordinates of dimensions, are keys; dimensions are kept.

    Raises InputError.
    """
    names = [*(str(dim) for dim in data.dims if dim in data.coords), *map(str, data.data_vars)]
    if not names:
        raise InputError("the dataset of cases has neither coordinates nor variables; name them by keys of the case")
    columns = {
        name: (tuple(map(str, data[name].dims)), objects_like(data[name].to_numpy().astype(object))) for name in names
    }
    return checked_design(case, columns, tuple(map(str, data.dims)))


def in_si(case: Case, values: Mapping[str, object]) -> dict[str, object]:
    """What a case makes of values of keys: numbers in SI units, everything else as it is. Raises InputError."""
    table = with_values(case.as_tables(), values)
    read = type(case).from_dict(table, folder=case.folder, name="the study").as_tables()
    return {
        key: value if (value := value_at(read, key)) is not None else fallback for key, fallback in values.items()
    }


def checked_design(
    case: Case,
    columns: Mapping[str, tuple[tuple[str, ...], np.ndarray]],
    dims: tuple[str, ...] | None = None,
    *,
    faults: Mapping[int, str] | None = None,
    labels: Mapping[str, tuple[str | int, ...]] | None = None,
) -> Design:
    """A design of these values in SI units; every value of a dimension of its own is read by the case.

    faults: of a list of cases, whose values may be wrong in some; None where each has to be right.
    """
    keys = {in_a_word(name): find_key(case, name) for name in columns}
    columns = {in_a_word(name): (tuple(map(in_a_word, over)), values) for name, (over, values) in columns.items()}
    dims = dims and tuple(map(in_a_word, dims))
    twice = next((key for key in keys.values() if list(keys.values()).count(key) > 1), None)
    if twice is not None:
        raise InputError(f"{twice} is varied twice; vary each key once")
    dims = dims or tuple(dict.fromkeys(dim for dims_of, _ in columns.values() for dim in dims_of))
    sizes = {
        dim: next(values.shape[dims_of.index(dim)] for dims_of, values in columns.values() if dim in dims_of)
        for dim in dims
    }
    if math.prod(sizes.values()) > MOST_CASES:
        raise InputError(
            f"the study has {math.prod(sizes.values())} cases, more than {MOST_CASES}; vary less, or sample"
        )
    units = keys_of(case)
    wrong = None if faults is None else dict(faults)
    at = 0 if wrong is None else _readable(case, keys, columns, wrong)
    first = {keys[name]: values[(at,) * values.ndim] for name, (_, values) in columns.items()}
    inputs = []
    for name, (dims_of, values) in columns.items():
        key = keys[name]
        single = dims_of == (name,) or values.ndim == 0
        # Numbers are in SI units already; of text each is read once, beside the first of the other inputs.
        by_label: dict[Any, Any] = {}
        tried = _tried(values) if single else range(values.size)
        for number, value in enumerate(values.flat):
            if number not in tried or (wrong is not None and number in wrong):
                continue
            if is_number(value) and not single:
                if wrong is not None and not math.isfinite(value):
                    wrong[number] = f"{key} must be a finite number, got {value}"
                continue
            label = repr(value)
            if label in by_label:
                continue
            try:
                by_label[label] = in_si(case, {**first, key: value})[key]
            except InputError as error:
                if wrong is None:
                    raise
                wrong[number] = str(error).removeprefix("the study: ")
        # What was not tried is a number of the same kind.
        convert = float if any(isinstance(value, float) for value in by_label.values()) else lambda value: value
        read = objects([by_label[label] if (label := repr(value)) in by_label
                         else convert(value) if is_number(value) else value
                         for value in values.flat]).reshape(values.shape)  # fmt: skip
        if wrong:
            # What cannot be read has no value.
            read = objects([None if k in wrong and not is_finite(value) else value for k, value in enumerate(read)])
        shown = labels_of(read)
        if single and len(np.unique(shown)) < shown.size:
            raise InputError(f"values of {name} are given twice; give each once")
        inputs.append(Input(name, key, units.get(key), dims_of, read, shown))
    design = Design(sizes, tuple(inputs), labels or {}, dict(sorted((wrong or {}).items())))
    if any(variable.dims != (variable.name,) for variable in inputs):
        _check_some(case, design)
    return design


def in_a_word(name: str) -> str:
    """A name without blanks, which coordinates in a file cannot have: "thickness_base" for "thickness base"."""
    return "_".join(name.split())


def _check_some(case: Case, design: Design) -> None:
    """Reject a list of cases of which none of the first can be read; a study marks single ones that fail."""
    errors = [InputError(f"{design.named(number)}: {text}") for number, text in design.faults.items()][:1]
    for number in _spread(design.count):
        if number in design.faults:
            continue
        try:
            in_si(case, design.at(number))
        except InputError as error:
            errors.append(error)
        else:
            return
    raise errors[0]


def _readable(
    case: Case, keys: Mapping[str, str], columns: Mapping[str, tuple[object, np.ndarray]], faults: Mapping[int, str]
) -> int:
    """The first case of a list that can be read; the first of all where none of those tried can."""
    count = min(len(values) for _, values in columns.values())
    for number in _spread(count):
        if number not in faults:
            with contextlib.suppress(InputError):
                in_si(case, {keys[name]: values[number] for name, (_, values) in columns.items()})
                return number
    return 0


def _spread(count: int) -> list[int]:
    """The first cases of a list, and some of the others."""
    start = range(min(count, _TRIED // 2))
    return list(dict.fromkeys([*start, *np.linspace(0, count - 1, _TRIED // 2, dtype=int).tolist()]))


def _tried(values: np.ndarray) -> Collection[int]:
    """Which values of a dimension the case reads beforehand: all, of many numbers the ends and some between."""
    flat = list(values.flat)
    if len(flat) <= _TRIED or not all(map(is_number, flat)):
        return range(len(flat))
    return {*_spread(len(flat)), int(np.argmin(flat)), int(np.argmax(flat))}
