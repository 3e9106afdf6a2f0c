"""One number of every case of a study, and what is done where cases failed."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import ModuleType
from typing import Any, TypedDict, Unpack, cast

import numpy as np

from treadload import variables
from treadload.case import Case
from treadload.case.keys import find_key, keys_of
from treadload.composing import BaseResult
from treadload.deferred import xarray as xr
from treadload.errors import InputError, how_to_install, nearest
from treadload.kernels.arrays import Array, BoolArray
from treadload.sweeps.design import Design
from treadload.sweeps.sampling import bounds_of
from treadload.sweeps.sweep import Sweep, causes_of, sweep

# Share of the trajectories or blocks that may be lost to cases that failed.
_MOST_LOST = 0.2


def reading_in_words(attrs: Mapping[str, object]) -> str:
    """The reading of a screening, its place and its unit. attrs: of the dataset."""
    unit = "" if attrs["unit"] == "1" else str(attrs["unit"])
    return ", ".join(part for part in (str(attrs["of"]), str(attrs["place"]), unit) if part)


@dataclass(frozen=True, eq=False)
class Screening(BaseResult):
    """Base of what matters among many inputs of a case. dataset: over `input`. case: the base."""

    dataset: xr.Dataset
    case: Case
    warnings: tuple[str, ...] = ()

    def cites(self) -> tuple[str, ...]:
        """Methods of the case."""
        return self.case.cites()


class Solving(TypedDict, total=False):
    """How the cases are solved, as in `sweep`."""

    store: str | os.PathLike[str] | None
    jobs: int
    in_threads: bool
    scheduler: Any
    progress: Callable[[int, int, str], None] | None


@dataclass(frozen=True, eq=False)
class Ranges:
    """Inputs and their ranges in SI units. names: as the user wrote them. keys, units: of the case."""

    names: tuple[str, ...]
    keys: tuple[str, ...]
    units: tuple[str, ...]
    low: Array
    high: Array

    @classmethod
    def of(cls, case: Case, ranges: Mapping[str, tuple[object, object]]) -> Ranges:
        """The ranges that a user gives. Raises InputError for what is no range."""
        bounds = bounds_of(case, ranges)
        keys = tuple(find_key(case, name) for name in bounds)
        units = keys_of(case)
        low, high = (np.array(ends, dtype=float) for ends in zip(*bounds.values(), strict=True))
        return cls(tuple(bounds), keys, tuple(units.get(key) or "" for key in keys), low, high)

    @property
    def problem(self) -> dict[str, object]:
        """As SALib has it."""
        bounds = np.stack([self.low, self.high], axis=1).tolist()
        return {"num_vars": len(self.names), "names": list(self.names), "bounds": bounds}

    def coordinates(self, order: np.ndarray) -> dict[str, list[str] | tuple[str, list[str]]]:
        """Names, keys and units of the inputs in an order, as coordinates of a dataset."""
        return {
            "input": [self.names[k] for k in order],
            "key": ("input", [self.keys[k] for k in order]),
            "key_unit": ("input", [self.units[k] for k in order]),
        }


@dataclass(frozen=True, eq=False)
class Answer:
    """One number of every case. name, unit: of it. place: where it was read. values: (n,), NaN of failures."""

    name: str
    unit: str
    place: str
    values: Array
    study: Sweep

    @property
    def about(self) -> dict[str, str]:
        """Its description in a dataset."""
        return {"of": self.name, "unit": self.unit, "place": self.place}

    def reason(self, number: int) -> str:
        """Why case `number` has no number."""
        return dict(self.study.failures).get(number, f"its {self.name} is not finite")

    def lost(self) -> str:
        """The most frequent reason of cases without a number, for a sentence."""
        lost = np.flatnonzero(~np.isfinite(self.values)).tolist()
        return next(iter(causes_of((number, self.reason(number)) for number in lost)), "")


def answer(
    case: Case,
    design: Design,
    of: str,
    at: Mapping[str, object] | None,
    *,
    logarithmic: bool = False,
    **solving: Unpack[Solving],
) -> Answer:
    """Solve the cases of a list and read one number of each. Raises InputError, also if no case was solved."""
    study = sweep(case, design, fields=[of] if "(" in of or "." in of else [], **solving)
    return read(study, of, at, logarithmic=logarithmic)


def read(study: Sweep, of: str, at: Mapping[str, object] | None, *, logarithmic: bool = False) -> Answer:
    """One number of every case of a study. of: its name. at: dimension → value where it has several."""
    if not study.stats["solved"]:
        reason = study.failures[0][1] if study.failures else "none was tried"
        raise InputError(f"none of {study.design.count} cases could be solved: {reason}")
    label = of.replace("(", "_").rstrip(")")
    full_name = next((name for name in (label, f"solved_{label}") if name in study.dataset), None)
    if full_name is None:
        numeric_names = [name for name in study.results if study.dataset[name].dtype.kind in "fiu"]
        raise InputError(f"the cases have no {of!r}; {nearest(of, numeric_names)[:400]}")
    field = study.dataset[full_name]
    if field.dtype.kind not in "fiu":
        raise InputError(f"{of} is a text; ask for a number")
    field, place = _cut(field, study, of, dict(at or {}))
    values = np.asarray(field.transpose(*study.design.dims).to_numpy(), dtype=float).ravel()
    unit = str(field.attrs.get("units", "1"))
    name = label
    if logarithmic:
        with np.errstate(divide="ignore", invalid="ignore"):
            values = np.log10(values)
        name, unit = f"log10 of {label}", "1"
    return Answer(name, unit, place, np.where(np.isfinite(values), values, np.nan), study)


def _cut(field: xr.DataArray, study: Sweep, of: str, at: dict[str, object]) -> tuple[xr.DataArray, str]:
    """The number at one place of the dimensions that a result has besides those of the design."""
    parts = []
    for dim in [str(dim_name) for dim_name in field.dims if dim_name not in study.design.dims]:
        axis = study.dataset[dim].to_numpy() if dim in study.dataset.coords else np.arange(field.sizes[dim])
        numeric = axis.dtype.kind in "fiu"
        listed = ", ".join(f"{value:g}" if numeric else repr(str(value)) for value in axis[:12])
        if dim not in at and len(axis) > 1:
            raise InputError(f"{of} is over {dim}: {listed}; state which, at={{{dim!r}: {axis[0]!s}}}")
        wanted = at.pop(dim, axis[0])
        if numeric:
            place = float(cast("float | str", wanted))
            index = int(np.argmin(np.abs(axis - place)))
            inside = abs(axis[index] - place) <= 1e-6 + 1e-3 * abs(place)
        else:
            index, inside = next(((k, True) for k, value in enumerate(axis) if str(value) == str(wanted)), (0, False))
        if not inside:
            raise InputError(f"{of} has no {dim} {wanted!r}; it has {listed}")
        is_length = variables.VARIABLES.get(dim, ("1", ""))[0] == "m"
        number = f"{1e3 * axis[index]:g} mm" if is_length else f"{axis[index]:g}" if numeric else ""
        parts.append(f"{dim} {number}" if numeric else str(axis[index]))
        field = field.isel({dim: index})
    if at:
        raise InputError(f"{of} is not over {', '.join(at)}; leave it out of at")
    return field, ", ".join(parts)


def kept(answer: Answer, size: int, what: str) -> tuple[BoolArray, list[str]]:
    """Which groups of `size` cases are whole, and a warning where some are not. Raises InputError if too many.

    what: the group is called, "trajectory". Cases of a group are compared with each other, so that one that failed
    takes all of them along.
    """
    finite = np.isfinite(answer.values).reshape(-1, size)
    whole: BoolArray = np.asarray(finite.all(axis=1))
    lost, count = int((~whole).sum()), len(whole)
    if not lost:
        return whole, []
    reason = answer.lost()
    if lost > _MOST_LOST * count or count - lost < 2:
        raise InputError(
            f"{lost} of {count} {what} have a case that failed, more than {100 * _MOST_LOST:.0f} %: what is left "
            f"does not represent these ranges; narrow them so that cases can be solved. Most often: {reason}"
        )
    return whole, [
        f"{lost} of {count} {what} are left out because a case of theirs failed: the numbers hold for the part of "
        f"the ranges in which cases can be solved. Most often: {reason}"
    ]


def salib() -> ModuleType:
    """The library of sensitivity analysis, its modules loaded. Raises InputError where it is not installed."""
    try:
        import SALib
        import SALib.analyze.morris
        import SALib.analyze.sobol
        import SALib.sample.morris
        import SALib.sample.sobol
    except ImportError as error:
        raise InputError(
            f"this needs SALib, which is not installed; {how_to_install('study')}, or use sweeps.screening.tornado"
        ) from error
    library: ModuleType = SALib
    return library
