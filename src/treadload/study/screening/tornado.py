"""Tornado: what a result does as each input goes to the ends of its range, the others in their place."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from treadload import variables
from treadload.case.file import FilePart
from treadload.case.keys import value_at
from treadload.composing import BaseResult, Holds
from treadload.describing import first_line
from treadload.errors import InputError
from treadload.study.screening.asked import Progress, Ranges, Where, answer
from treadload.study.sweeps import over_points


@dataclass(frozen=True, eq=False)
class Tornado(BaseResult, group="tornado"):
    """A result at both ends of the range of every input, one at a time; the largest swing first.

    dataset: over `input`: ends and base of the inputs, the reading at them, the swing; NaN where a case failed.
    """

    holds: ClassVar[Holds] = Holds(
        {"input_low input_high input_base reading_low reading_high swing": "input", "reading_base": ""},
        labels={"input key key_unit": "input"},
        texts="of unit place",
    )

    dataset: xr.Dataset
    case: FilePart
    warnings: tuple[str, ...] = ()

    def summary(self) -> str:
        """A table: the reading at both ends of every input."""
        data = self.dataset
        unit = "" if data.attrs["unit"] == "1" else f" {data.attrs['unit']}"
        place = f", {data.attrs['place']}" if data.attrs["place"] else ""
        lines = [f"{data.attrs['of']}{place}: {float(data['reading_base']):.4g}{unit} of the base case"]
        wide = max(len(str(name)) for name in data["input"].to_numpy())
        for k, name in enumerate(data["input"].to_numpy()):
            one = {key: float(data[key][k]) for key in ("input_low", "input_high", "reading_low", "reading_high")}
            of = str(data["key_unit"].to_numpy()[k])
            low, high = (
                "failed" if math.isnan(one[end]) else f"{one[end]:.4g}" for end in ("reading_low", "reading_high")
            )
            lines.append(
                f"  {name!s:{wide}}  {low} to {high}{unit} for "
                f"{one['input_low']:.6g} to {one['input_high']:.6g}{f' {of}' if of else ''}"
            )
        return "\n".join([*lines, *(f"warning: {text}" for text in self.warnings)])

    __repr__ = first_line


def tornado(
    case: FilePart,
    ranges: Mapping[str, tuple[Any, Any]],
    of: str,
    *,
    at: Mapping[str, Any] | None = None,
    store: str | os.PathLike[str] | None = None,
    jobs: int = 1,
    in_threads: bool = False,
    scheduler: Any = None,
    progress: Progress | None = None,
) -> Tornado:
    """Take every input to the low and the high end of its range, one at a time around the case.

    case: the base, which gives every input. ranges: key → (low, high), in SI units or with their units. of: name of a
    number of every case, "worst_strain", or of a field over the plane, "max(principal_strain_1)". at: dimension →
    value of a number that is over one, {"depth": 0.21}. store, jobs, in_threads, scheduler, progress: as in `sweep`.
    2 n + 1 cases for n inputs. It sees no interaction of inputs: `sobol` does. Returns the Tornado. A case that
    failed leaves a gap and a warning. Raises InputError, also where the base case fails.
    """
    inputs = Ranges.of(case, ranges)
    base = np.array([base_value(case, name, key) for name, key in zip(inputs.names, inputs.keys, strict=True)])
    count = len(base)
    points = np.tile(base, (2 * count + 1, 1))
    points[1 : count + 1][np.diag_indices(count)] = inputs.low
    points[count + 1 :][np.diag_indices(count)] = inputs.high
    found = answer(
        case, over_points(case, list(inputs.names), points), of, at,
        Where(store, jobs, in_threads, scheduler, progress),
    )  # fmt: skip
    values = found.values
    if not np.isfinite(values[0]):
        raise InputError(f"the base case has no {of}: {found.reason(0)}")
    low, high = values[1 : count + 1], values[count + 1 :]
    ends = np.stack([low, high, np.full(count, values[0])])
    swing = np.nanmax(ends, axis=0) - np.nanmin(ends, axis=0)
    swing[np.isnan(low) & np.isnan(high)] = np.nan
    order = np.argsort(-np.nan_to_num(swing, nan=-1.0), kind="stable")
    warnings = []
    for k in order:
        for end, number, value in (("low", 1 + k, inputs.low[k]), ("high", 1 + count + k, inputs.high[k])):
            if np.isnan(values[number]):
                warnings.append(
                    f"no reading at the {end} end of {inputs.names[k]}, {value:.6g} {inputs.units[k]}".rstrip()
                    + f": {found.reason(int(number))}"
                )
        if not inputs.low[k] <= base[k] <= inputs.high[k]:
            warnings.append(f"{inputs.names[k]} of the base case, {base[k]:.6g}, lies outside its range")
    dataset = variables.dataset(
        {
            "input_low": (("input",), inputs.low[order]),
            "input_high": (("input",), inputs.high[order]),
            "input_base": (("input",), base[order]),
            "reading_low": (("input",), low[order]),
            "reading_high": (("input",), high[order]),
            "swing": (("input",), swing[order]),
            "reading_base": ((), values[0]),
        },
        inputs.coordinates(order),
        **found.about,
    )
    return Tornado(dataset, case, tuple(warnings))


def base_value(case: FilePart, name: str, key: str) -> float:
    """What the case itself gives for a key, or leaves to its default. Raises InputError where that is no number."""
    here = value_at(case, key)
    if isinstance(here, bool) or not isinstance(here, int | float):
        said = "gives none" if here is None else f"gives {here!r}"
        raise InputError(f"a tornado turns around the number that the case gives for {name}, and it {said}; give one")
    return float(here)
