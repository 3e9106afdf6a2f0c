"""Records of cases put together: arrays over the dimensions of a study, and then over those of each result."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from treadload import variables
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.sweeps.design import Design
from treadload.sweeps.record import Record, Values
from treadload.sweeps.selection import attributes

UNSOLVED, SOLVED, FAILED = 0, 1, 2
# Coordinates that differ by less are one place, m; below every cell and above every round-off.
_DIGITS = 9
# Cells of a common grid over those of the largest of its members.
_SPARSE = 4


def gathered(design: Design, records: Iterable[Record]) -> xr.Dataset:
    """The numbers of records as a dataset over the dimensions of a design, NaN where there is none.

    Also `status`, `seconds`, and as attributes the reasons of failures and the warnings with their cases, as JSON.
    """
    solved = list(records)
    status = np.full(design.count, UNSOLVED, dtype=np.int8)
    seconds = np.full(design.count, np.nan)
    for record in solved:
        status[record.number] = SOLVED if record.failure is None else FAILED
        seconds[record.number] = record.seconds
    axes = common_axes(solved, "numbers")
    columns: dict[str, Values] = {"status": (design.dims, status), "seconds": (design.dims, seconds)}
    for name, dims in _layout(solved, "numbers").items():
        values = _empty(design.count, [len(axes[dim]) for dim in dims], _kind(solved, name))
        for record in solved:
            if name in record.numbers:
                place(values[record.number : record.number + 1], record.numbers[name], record.coordinates, axes)
        columns[name] = ((*design.dims, *dims), values)
    data = _dataset(design, columns, axes)
    failures = [[record.number, record.failure] for record in solved if record.failure is not None]
    warnings: dict[str, list[int]] = {}
    for record in solved:
        for text in record.warnings:
            warnings.setdefault(text, []).append(record.number)
    return data.assign_attrs(
        failures=json.dumps(failures, ensure_ascii=False), warnings=json.dumps(warnings, ensure_ascii=False)
    )


def with_fields(data: xr.Dataset, design: Design, records: Sequence[Record]) -> xr.Dataset:
    """A dataset of numbers with the fields of the records, in memory."""
    axes = common_axes(records, "fields")
    columns: dict[str, Values] = {}
    for name, dims in _layout(records, "fields").items():
        values = _empty(design.count, [len(axes[dim]) for dim in dims], "f")
        for record in records:
            if name in record.fields:
                place(values[record.number : record.number + 1], record.fields[name], record.coordinates, axes)
        columns[name] = ((*design.dims, *dims), values)
    return data.merge(_dataset(design, columns, axes), compat="no_conflicts")


def _dataset(design: Design, columns: Mapping[str, Values], axes: Mapping[str, np.ndarray]) -> xr.Dataset:
    fields = {
        label_of(name, design): (dims, array.reshape(*design.shape, *array.shape[1:]), attributes(name))
        for name, (dims, array) in columns.items()
    }
    return xr.Dataset(fields, {**design.coordinates(), **coordinates_of(axes)})


def coordinates_of(axes: Mapping[str, np.ndarray]) -> dict[str, object]:
    """Axes as coordinates with units and long names."""
    return {
        dim: (dim, axis, variables.attributes(dim) if dim in variables.VARIABLES else {})
        for dim, axis in axes.items()
    }


def label_of(name: str, design: Design) -> str:
    """The name of a result in a study, which no input has: "solved_normal_load" of one over "normal_load"."""
    taken = {*design.dims, *(variable.name for variable in design.inputs), *design.labels}
    return f"solved_{name}" if name in taken else name


def common_axes(records: Sequence[Record], kind: str) -> dict[str, np.ndarray]:
    """The union of the coordinates of all dimensions that numbers or fields have. Raises InputError."""
    members: dict[str, list[np.ndarray]] = {}
    for record in records:
        values: Mapping[str, Values] = getattr(record, kind)
        for dim in dict.fromkeys(dim for dims, _ in values.values() for dim in dims):
            if dim in record.coordinates:
                members.setdefault(dim, []).append(record.coordinates[dim])
            else:
                size = next(np.shape(a)[dims.index(dim)] for dims, a in values.values() if dim in dims)
                members.setdefault(dim, []).append(np.arange(size))
    axes = {}
    for dim, labels in members.items():
        if labels[0].dtype.kind in "fiu":
            axis = np.unique(np.round(np.concatenate(labels).astype(float), _DIGITS))
        else:
            axis = np.array(list(dict.fromkeys(str(label) for labels_of in labels for label in labels_of)))
        longest = max(len(labels_of) for labels_of in labels)
        if len(axis) > _SPARSE * longest and axis.dtype.kind == "f":
            raise InputError(
                f"the cases have different places along {dim}: together {len(axis)}, each {longest} at most; keep "
                "the spacing of cells the same, or ask for max(…), min(…) or mean(…) of a field"
            )
        axes[dim] = axis
    return axes


def place(
    target: np.ndarray, values: Values, coordinates: Mapping[str, np.ndarray], axes: Mapping[str, np.ndarray]
) -> None:
    """Put the values of a case into its row (1, ...) of an array over common axes."""
    dims, array = values
    if not dims:
        # An array of objects would keep a text as an array without dimensions, which no store takes.
        target[0] = np.asarray(array)[()]
        return
    at: list[np.ndarray] = []
    for k, dim in enumerate(dims):
        axis = coordinates.get(dim, np.arange(np.shape(array)[k]))
        if axes[dim].dtype.kind == "f":
            at.append(np.searchsorted(axes[dim], np.round(axis.astype(float), _DIGITS)))
        else:
            order = {label: k for k, label in enumerate(axes[dim].tolist())}
            at.append(np.array([order[str(label)] for label in axis]))
    target[0][np.ix_(*at)] = array


def _layout(records: Sequence[Record], kind: str) -> dict[str, tuple[str, ...]]:
    """Names and dimensions of all numbers or fields."""
    return {name: dims for record in records for name, (dims, _) in getattr(record, kind).items()}


def _kind(records: Sequence[Record], name: str) -> str:
    return next(str(np.asarray(record.numbers[name][1]).dtype.kind) for record in records if name in record.numbers)


def _empty(count: int, sizes: Sequence[int], kind: str) -> np.ndarray:
    """Texts that are missing are empty."""
    return np.full((count, *sizes), "", dtype=object) if kind in "UO" else np.full((count, *sizes), np.nan)
