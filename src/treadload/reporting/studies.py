"""A study of many cases in a report: what was varied, how it went, its curves and maps, what failed."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from treadload.errors import InputError
from treadload.plots import SweepPlots
from treadload.plots.kit.shown import Shown, numbers, shown
from treadload.plots.kit.style import power_of_ten, thousands
from treadload.plots.sweeps.curves import capital, slip_input
from treadload.plots.sweeps.reading import FAILED, UNSOLVED, View
from treadload.reporting.inputs import NamedTable
from treadload.reporting.pictures import Picture, picture
from treadload.study.sweeps import causes_of
from treadload.study.sweeps.design import CASE
from treadload.variables import VARIABLES

# What a reader looks for first, in this order; behind what was asked for by name.
_MAIN = (
    "worst_strain", "worst_passes", "governing_years", "life_years", "largest_extension", "slip_fraction",
    "largest_in_plane_extension", "largest_pressure", "creepage_x", "creepage_y", "tractive_force", "lateral_force",
    "approach", "net_area",
)  # fmt: skip
_ASKED = ("max_", "min_", "mean_")
# Results in curves, inputs that they are drawn against, maps of a result, maps of fields, rows of the tables.
_CURVES, _AGAINST, _MAPS, _FIELDS, _ROWS = 4, 4, 2, 2, 12


def study_tables(data: xr.Dataset) -> tuple[NamedTable, ...]:
    """What was varied, how many cases were solved, the range of the main results, why cases failed."""
    view = View.of(data)
    tables = [
        NamedTable("What was varied", ("input", "key", "values"), tuple(_varied(view))),
        NamedTable("Cases", ("cases", "solved", "failed", "not solved yet", "time of solving"), (_counts(view),)),
        NamedTable(
            "Range of the results", ("result", "smallest", "in the case", "largest", "in the case"),
            tuple(_range(view, name) for name in main_readings(view, _ROWS)),
        ),
        NamedTable("What failed", ("cases", "the first", "reason"), tuple(_failures(view))),
    ]  # fmt: skip
    return tuple(table for table in tables if table.rows)


def study_pictures(data: xr.Dataset) -> list[Picture]:
    """Curves against every input, the slip curve, maps, and fields as small multiples."""
    view, plots = View.of(data), SweepPlots(data)
    names = main_readings(view, _CURVES)
    drawn: list[Picture] = []
    inputs = [*view.numeric, *(name for name in view.inputs if view.data[name].dtype.kind not in "fiu")]
    lines = (
        "A line for each value of a second input, the others in their middle" if view.is_product else "A dot a case"
    )
    for name in inputs[:_AGAINST] if names else ():
        how = shown(view.data[name], name)
        drawn += picture(
            f"Against {how.words}", f"{lines}; crosses stand where cases failed.",
            _bound(plots.curves, names, name), wide=True,
        )  # fmt: skip
    try:
        slip_input(view)
    except InputError:
        pass
    else:
        drawn += picture("Slip curve", "Shear force over friction times load, against creepage.", plots.slip_curve)
    if len(view.numeric) > 1:
        for name in names[:_MAPS]:
            what = shown(view.reading(name), name)
            caption = "Over the two inputs of most values; what is varied besides stands in its middle."
            drawn += picture(capital(what.words), caption, _bound(plots.map, name))
    fields = [str(name) for name, one in data.data_vars.items() if {"x", "y"} <= set(one.dims)]
    for name in fields[:_FIELDS]:
        what = shown(data[name], name)
        caption = "In plan, one colour scale for all cases shown."
        drawn += picture(capital(what.words), caption, _bound(plots.multiples, name), wide=True)
    return drawn


def main_readings(view: View, most: int) -> list[str]:
    """Names of the results that a reader looks for first, those that differ between the cases."""
    varying = view.readings()
    asked = [name for name in varying if name.startswith(_ASKED) and name not in VARIABLES]
    wanted = [*asked, *(name for name in _MAIN if name in varying)]
    rest = [name for name in varying if name not in wanted and not name.startswith("solved_")]
    return (wanted or rest)[:most]


def _bound(draw: Callable[..., Figure], *given: object) -> Callable[[], Figure]:
    return lambda: draw(*given)


def _varied(view: View) -> Iterator[tuple[str, ...]]:
    for name in view.inputs:
        axis = view.data[name]
        how = shown(axis, name)
        distinct = np.unique(axis.to_numpy())
        if axis.dtype.kind in "fiu":
            told = f"{how.number(distinct[0])} to {how.number(distinct[-1])}, {_values(len(distinct))}"
            if len(distinct) <= 6:
                told = ", ".join(how.number(value) for value in distinct)
        else:
            told = ", ".join(map(str, distinct[:8])) + (f" … {len(distinct)} in all" if len(distinct) > 8 else "")
        yield how.words, str(axis.attrs["key"]), told


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


def _range(view: View, name: str) -> tuple[str, ...]:
    field = view.reading(name)
    how, values = shown(field, name), numbers(field.transpose(*view.dims, ...))
    told = [capital(how.words)]
    for pick in (np.nanmin, np.nanmax):
        extreme = pick(np.where(np.isnan(values), np.nan, values))
        place = np.unravel_index(int(np.flatnonzero(values.ravel() == extreme)[0]), values.shape)
        told += [_value(extreme, how), _case(view, place[: len(view.dims)])]
    return tuple(told)


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
        str(name): one for name, one in view.data.coords.items() if "key" not in one.attrs and one.dims == (CASE,)
    }
    told = [f"{name} {one.to_numpy()[at[CASE]]}" for name, one in coords.items()]
    for name in view.inputs:
        axis = view.data[name]
        value = axis.isel({dim: at[dim] for dim in map(str, axis.dims)}).to_numpy().item()
        how = shown(axis, name)
        told.append(f"{how.words} {how.number(value)}")
    return ", ".join(told)


def _failures(view: View) -> Iterator[tuple[str, ...]]:
    failures = [(int(number), str(reason)) for number, reason in json.loads(view.data.attrs.get("failures", "[]"))]
    for reason, cases in list(causes_of(failures).items())[:_ROWS]:
        first = np.unravel_index(min(cases), view.data["status"].shape)
        yield thousands(len(cases)), _case(view, first), reason


def _values(count: int) -> str:
    return f"{count} value{'s' * (count != 1)}"
