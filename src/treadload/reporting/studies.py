"""A study of many cases in a report: what was varied, how it went, its curves and maps, what failed."""

from __future__ import annotations

import json
from collections.abc import Iterator

import numpy as np

from treadload.deferred import xarray as xr
from treadload.plots.kit.shown import Shown, numbers, shown
from treadload.plots.kit.style import power_of_ten, thousands
from treadload.plots.sweeps.reading import FAILED, UNSOLVED, View, main_readings
from treadload.plots.sweeps.titles import capital
from treadload.reporting.tables import NamedTable
from treadload.sweeps import causes_of
from treadload.sweeps.design import CASE

# Rows of the tables.
_ROWS = 12


def study_tables(data: xr.Dataset) -> tuple[NamedTable, ...]:
    """What was varied, how many cases were solved, the range of the main results, why cases failed."""
    view = View.of(data)
    tables = [
        NamedTable("What was varied", ("input", "key", "values"), tuple(_varied(view))),
        NamedTable("Cases", ("cases", "solved", "failed", "not solved yet", "time of solving"), (_counts(view),)),
        NamedTable(
            "Range of the results", ("result", "smallest", "in the case", "largest", "in the case"),
            tuple(extremes_of(view, name) for name in main_readings(view, _ROWS)),
        ),
        NamedTable("What failed", ("cases", "the first", "reason"), tuple(_failures(view))),
    ]  # fmt: skip
    return tuple(table for table in tables if table.rows)


def _varied(view: View) -> Iterator[tuple[str, ...]]:
    for name in view.inputs:
        axis = view.data[name]
        how = shown(axis, name)
        distinct = np.unique(axis.to_numpy())
        if axis.dtype.kind in "fiu":
            text = f"{how.number(distinct[0])} to {how.number(distinct[-1])}, {_values(len(distinct))}"
            if len(distinct) <= 6:
                text = ", ".join(how.number(value) for value in distinct)
        else:
            text = ", ".join(map(str, distinct[:8])) + (f" … {len(distinct)} in all" if len(distinct) > 8 else "")
        yield how.words, str(axis.attrs["key"]), text


def _counts(view: View) -> tuple[str, ...]:
    status, seconds = view.data["status"].to_numpy(), float(np.nansum(view.data["seconds"].to_numpy()))
    failed, waiting = int((status == FAILED).sum()), int((status == UNSOLVED).sum())
    took = (
        f"{seconds:.3g} s"
        if seconds < 120
        else f"{seconds / 60:.3g} min"
        if seconds < 7200
        else f"{seconds / 3600:.3g} h"
    )
    counts = (status.size, status.size - failed - waiting, failed, waiting)
    return (*(thousands(count) for count in counts), took)


def extremes_of(view: View, name: str) -> tuple[str, ...]:
    """A result of a study: its name, the smallest value with its case, the largest with its case, as texts."""
    field = view.reading(name)
    how, values = shown(field, name), numbers(field.transpose(*view.dims, ...))
    parts = [capital(how.words)]
    for pick in (np.nanmin, np.nanmax):
        extreme = pick(np.where(np.isnan(values), np.nan, values))
        place = np.unravel_index(int(np.flatnonzero(values.ravel() == extreme)[0]), values.shape)
        parts += [_value(extreme, how), _case(view, place[: len(view.dims)])]
    return tuple(parts)


def _value(value: float, how: Shown) -> str:
    if np.isinf(value):
        return "without end"
    if how.logarithmic and abs(value) >= 1e4:
        return power_of_ten(float(value))
    return how.number(value)


def _case(view: View, place: tuple[int, ...] | tuple[np.intp, ...]) -> str:
    """The inputs of a case in words."""
    at = dict(zip(view.dims, map(int, place), strict=True))
    # The row of a table, and its ids.
    coords = {
        str(name): coordinate
        for name, coordinate in view.data.coords.items()
        if "key" not in coordinate.attrs and coordinate.dims == (CASE,)
    }
    texts = [f"{name} {coordinate.to_numpy()[at[CASE]]}" for name, coordinate in coords.items()]
    for name in view.inputs:
        axis = view.data[name]
        value = axis.isel({dim: at[dim] for dim in map(str, axis.dims)}).to_numpy().item()
        how = shown(axis, name)
        texts.append(f"{how.words} {how.number(value)}")
    return ", ".join(texts)


def _failures(view: View) -> Iterator[tuple[str, ...]]:
    failures = [(int(number), str(reason)) for number, reason in json.loads(view.data.attrs.get("failures", "[]"))]
    for reason, cases in list(causes_of(failures).items())[:_ROWS]:
        first = np.unravel_index(min(cases), view.data["status"].shape)
        yield thousands(len(cases)), _case(view, first), reason


def _values(count: int) -> str:
    return f"{count} value{'s' * (count != 1)}"
