"""The result of a calibration: the fitted tire, its error bars, and in words what the data cannot determine."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
import scipy

from treadload import variables
from treadload.calibration.problem import Model, Problem, inflated
from treadload.composing import BaseResult, Holds
from treadload.deferred import xarray as xr
from treadload.errors import InputError, nearest
from treadload.footprint import FootprintComparison, compare
from treadload.footprint.measured import READINGS, Measured, Unknown
from treadload.identifiability import UNDECIDED, quantile, spread, undecided_in_words
from treadload.kernels.arrays import Array, BoolArray
from treadload.pavement import Pavement
from treadload.response import GridLoad
from treadload.rows import Row, row
from treadload.tire import Tire
from treadload.units import Unit
from treadload.variables import Display, display_of

# Correlations above which a pair is named.
_CORRELATED = 0.9
# Data contradict the model, or each other, where scatter as large would come by chance less often than this.
_CHANCE = 0.01
_SHOWN = {
    "modulus": (1e-6, "MPa"), "radius": (1.0, "m"), "m": (1e3, "mm"), "Pa": (1e-6, "MPa"), "Pa/m": (1e-6, "MPa/m"),
    "rad": (180 / math.pi, "°"),
}  # fmt: skip
_LENGTHS_OF_CELLS = ("edge_radius", "shoulder_radius")


@dataclass(frozen=True, eq=False)
class Fit:
    """Where a search ended. Arrays over the numbers sought, and over the readings.

    start, values, low, high: SI. size: what slopes are taken per. at_bound: -1, 0 or 1. before, model, measured,
    errors: readings at the start, at the end, as measured, and their standard deviations, SI. stated: whether the
    errors were. slopes: (readings, numbers), SI per size.
    """

    start: Array
    values: Array
    low: Array
    high: Array
    size: Array
    at_bound: Array
    before: Array
    model: Array
    measured: Array
    errors: Array
    stated: Array
    slopes: Array


@dataclass(frozen=True, eq=False)
class Calibration(BaseResult, group="calibration"):
    """Numbers of a tire that fit what was measured, with their error bars.

    dataset: numbers over `unknown`, readings over `reading`, correlations, singular values of the slopes with their
    directions; see `treadload.variables`. tire: the fitted one. friction: fitted or given. road, sought, data:
    what was asked. before: the tire that the search began with. comparisons: of the rows with a footprint. warnings:
    sentences for the user.
    """

    title: ClassVar[str] = "Calibration of the tire"
    holds: ClassVar[Holds] = Holds(
        {
            "start_value fitted_value standard_deviation": "unknown",
            "number_correlation": "unknown other",
            "residual residual_before": "reading",
        },
        not_nan="residual",
        labels={"unknown": "unknown", "other": "other", "label": "reading"},
        each={"unknown": "sought", "other": "sought"},
        numbers="degrees_of_freedom errors_given",
        members="undecided",
        stats=("contacts evaluations seconds", "seconds contacts", "evaluations contacts"),
    )

    dataset: xr.Dataset
    tire: Tire
    friction: float
    road: Pavement
    sought: tuple[Unknown, ...]
    data: tuple[Measured, ...]
    before: Tire
    comparisons: tuple[FootprintComparison, ...] = ()
    stats: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    def value(self, name: str) -> float:
        """The fitted number of this name, SI. Raises InputError if it was not sought."""
        return float(self._of(name)["fitted_value"])

    def standard_deviation(self, name: str) -> float:
        """Of a fitted number, SI; NaN where the data do not determine it, or it ended at a bound."""
        return float(self._of(name)["standard_deviation"])

    def interval(self, name: str, level: float = 0.95) -> tuple[float, float]:
        """Between what a number lies with a probability, SI.

        Normal where the errors were given, else Student's with the degrees of freedom left; linear in the number.
        """
        if not 0 < level < 1:
            raise InputError(f"level must lie in (0, 1), got {level:g}; 0.95 is the default")
        free = float(self.dataset.attrs["degrees_of_freedom"])
        errors_stated = bool(self.dataset.attrs["errors_given"])
        half = quantile(level, free, stated=errors_stated) * self.standard_deviation(name)
        return self.value(name) - half, self.value(name) + half

    @property
    def undecided(self) -> tuple[str, ...]:
        """Sentences on what these data cannot determine."""
        return tuple(self.dataset.attrs["undecided"])

    def _of(self, name: str) -> xr.Dataset:
        names = [str(name) for name in self.dataset["unknown"].to_numpy()]
        if name not in names:
            raise InputError(f"{name!r} was not sought; {nearest(name, names, 'it sought')}")
        return self.dataset.sel(unknown=name)

    @property
    def heading(self) -> str:
        """The tire, and how many numbers of it from how many readings."""
        name, readings = self.tire.name or "a tire", self.dataset.sizes["reading"]
        return f"{name}, {len(self.sought)} numbers from {readings} readings"

    def rows(self) -> tuple[Row, ...]:
        """Numbers with error bars, how well they fit, and what the data cannot determine."""
        data, rows = self.dataset, []
        for unknown in self.sought:
            name, (factor, unit) = unknown.name, shown(unknown.unit)
            value, error, interval = self.value(name), self.standard_deviation(name), self.interval(name)
            before = float(data["start_value"].sel(unknown=name))
            part = f"{100 * error / abs(value):.2g} %" if value and math.isfinite(error) else ""
            numbers = {"fitted_value": value, "interval_low": interval[0], "interval_high": interval[1],
                       "start_value": before}  # fmt: skip
            rows += [
                row(key, number, group=name, display=_display(key, factor, unit)) for key, number in numbers.items()
            ]
            bars = error if math.isfinite(error) else "not determined"
            display = _display("standard_deviation", factor, unit, ".2g")
            rows.insert(-3, row("standard_deviation", bars, group=name, note=part, display=display))
        free = int(data.attrs["degrees_of_freedom"])
        worst = int(np.abs(data["residual"].to_numpy()).argmax())
        errors = "as given" if data.attrs["errors_given"] else "customary ones; their size from the scatter"
        rows += [
            row("residual", _rms(data["residual"]), note=f"in errors, {free} degrees of freedom"),
            row("residual_before", _rms(data["residual_before"])),
            row("reading_error", errors),
            row("worst_residual", data["residual"][worst], note=str(data["label"].to_numpy()[worst])),
            *_correlations(data),
        ]
        if self.stats:
            solved = "{contacts} contacts, {evaluations} evaluations, {seconds:.0f} s".format(**self.stats)
            rows.append(row("solved", solved))
        return (*rows, *(row("undecided", text) for text in self.undecided))


def _display(key: str, factor: float, unit: str, form: str = ".4g") -> Display:
    """How a number of a tire is shown. factor: from SI to its unit."""
    return Display(display_of(key).label, "", lambda value: f"{value * factor:{form}} {unit}".rstrip())


def shown(unit: Unit) -> tuple[float, str]:
    """Factor and unit that people count a number in."""
    return _SHOWN.get(unit.kind or unit.si, (1.0, unit.symbol))


def solution(problem: Problem, search_result: Fit, stats: Mapping[str, object]) -> Calibration:
    """The result of a search: covariance, what is not decided, warnings."""
    names = [unknown.name for unknown in problem.sought]
    free = search_result.at_bound == 0
    # Relative changes of the fitted numbers, so that directions compare.
    size = np.maximum(
        np.abs(search_result.values),
        np.where(np.abs(search_result.values) < 0.1 * search_result.size, search_result.size, 0.0),
    )
    slopes = search_result.slopes * (size / search_result.size) / search_result.errors[:, None]
    residual, before = (
        (computed - search_result.measured) / search_result.errors
        for computed in (search_result.model, search_result.before)
    )
    # Shares make 1 together: one of each set is told by the others.
    sets = sum(1 for measured in problem.data for name in ("rib_shares", "footprint") if name in measured.readings)
    left = len(residual) - sets - int(free.sum())
    square = float(residual @ residual)
    errors_stated = bool(search_result.stated.all())
    scatter = 1.0 if errors_stated else math.sqrt(square / left) if left > 0 else math.nan
    spread_of_fit = spread(slopes, free, scatter)
    values, directions = spread_of_fit.values, spread_of_fit.directions
    taken = scatter if math.isfinite(scatter) else 1.0
    undecided = undecided_in_words(names, values, directions, taken)
    # Numbers at a bound, one by one: some are pushed there, others have drifted.
    lost = ~free & (np.linalg.norm(slopes, axis=0) * UNDECIDED < taken)
    undecided += [f"these data leave {name} undecided: it drifted to its bound" for name in np.array(names)[lost]]
    labels = [_label(problem, *reading) for reading in problem.readings]
    rows = [problem.data[row] for row, _, _ in problem.readings]
    pressures = [
        measured_row.inflation_pressure or problem.tire.inflation_pressure or math.nan for measured_row in rows
    ]
    over, read = ("unknown",), ("reading",)
    dataset = variables.dataset(
        {
            "start_value": (over, search_result.start),
            "fitted_value": (over, search_result.values),
            "standard_deviation": (over, spread_of_fit.deviations * size),
            "lower_bound": (over, search_result.low),
            "upper_bound": (over, search_result.high),
            "at_bound": (over, search_result.at_bound),
            "number_correlation": (("unknown", "other"), spread_of_fit.correlation),
            "singular_value": (("direction",), values),
            "direction_part": (("direction", "unknown"), directions),
            "measured_reading": (read, search_result.measured),
            "fitted_reading": (read, search_result.model),
            "reading_before": (read, search_result.before),
            "reading_error": (read, search_result.errors),
            "residual": (read, residual),
            "residual_before": (read, before),
            "reading_slope": (("reading", "unknown"), slopes),
        },
        {
            "unknown": names,
            "other": names,
            "label": ("reading", labels),
            "kind": ("reading", [name for _, name, _ in problem.readings]),
            "wheel_load": ("reading", [float(measured_row.load or math.nan) for measured_row in rows]),
            "inflation_pressure": ("reading", pressures),
        },
        degrees_of_freedom=left,
        errors_given=int(errors_stated),
        scatter=scatter,
        undecided=list(undecided),
    )
    tire, friction = problem.at(search_result.values)
    comparisons = _compared(problem, tire, friction)
    warnings = [
        *_caveats(problem, search_result, lost, square, left, errors_stated),
        *(f"footprint: {text}" for comparison in comparisons for text in comparison.warnings),
    ]
    return Calibration(
        dataset, tire, friction, problem.road, problem.sought, problem.data, problem.tire, comparisons, dict(stats),
        tuple(warnings),
    )  # fmt: skip


def _caveats(
    problem: Problem, search_result: Fit, lost: BoolArray, square: float, left: int, errors_stated: bool
) -> list[str]:
    caveats = []
    for unknown, value, side, drifted in zip(
        problem.sought, search_result.values, search_result.at_bound, lost, strict=True
    ):
        if side and not drifted:
            factor, unit = shown(unknown.unit)
            caveats.append(
                f"{unknown.name} ended at its bound of {factor * value:.4g} {unit}: the data want it "
                f"{'lower' if side < 0 else 'higher'} still; it has no error bar, and those of the others hold it "
                "there. Widen the bound if a tire can have that, or question the data or the model"
            )
        if problem.spacing is not None and unknown.name in _LENGTHS_OF_CELLS and value < 2 * problem.spacing:
            caveats.append(
                f"{unknown.name} of {value * 1e3:.2g} mm is hardly seen on cells of {problem.spacing * 1e3:g} mm; "
                f"give a spacing of {max(value, 2e-3) * 500:.2g} mm or less"
            )
    if left <= 0:
        caveats.append("as many numbers as readings: nothing checks the fit; measure more")
    elif errors_stated and scipy.special.chdtrc(left, square) < _CHANCE:
        caveats.append(
            f"the readings scatter about the fit {math.sqrt(square / left):.2g} times as much as their errors allow: "
            "they contradict each other or the model, and the error bars are too narrow by as much"
        )
    if not errors_stated and search_result.stated.any():
        caveats.append("some errors were given and some are customary; all are scaled by the scatter")
    return caveats


def _compared(problem: Problem, tire: Tire, friction: float) -> tuple[FootprintComparison, ...]:
    """Rows with a footprint or with pins beside the fitted contact."""
    model, comparisons = Model(problem), []
    for number, measured in enumerate(problem.data):
        if measured.footprint is not None:
            with problem.tables:
                pressure, grid, _ = model.pressed(inflated(tire, measured), number)
            comparisons.append(compare(GridLoad(grid, pressure), measured.footprint))
        if measured.pins is not None:
            with problem.tables:
                comparisons.append(compare(model.rolled(tire, friction, number), measured.pins))
    return tuple(comparisons)


def _label(problem: Problem, row: int, name: str, number: int) -> str:
    """What a reading is called in figures."""
    measured, kind = problem.data[row], READINGS[name]
    count = f" {number + 1}" if name in ("rib_shares", "footprint") else ""
    pressure = "" if measured.inflation_pressure is None else f", {measured.inflation_pressure / 1e3:.4g} kPa"
    if name == "pins":
        count = f", {problem.pin_blocks[row].name(number)}"
    at = f"{float(measured.load or 0.0) / 1e3:.4g} kN{pressure}"
    return f"{kind.words}{count}, {measured.name or at}"


def _correlations(data: xr.Dataset) -> list[Row]:
    """Pairs that go together."""
    names, matrix = data["unknown"].to_numpy(), data["number_correlation"].to_numpy()
    pairs = [(i, j) for i in range(len(names)) for j in range(i) if abs(matrix[i, j]) >= _CORRELATED]
    return [row("number_correlation", matrix[i, j], note=f"{names[j]} and {names[i]}") for i, j in pairs]


def _rms(values: xr.DataArray) -> float:
    return float(np.sqrt(np.mean(np.square(values.to_numpy()))))
