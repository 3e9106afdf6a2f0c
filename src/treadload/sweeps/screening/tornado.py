"""Tornado: what a result does as each input goes to the ends of its range, the others in their place."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, Unpack

import numpy as np

from treadload import variables
from treadload.case import Case
from treadload.case.keys import value_at
from treadload.composing import Holds
from treadload.errors import InputError
from treadload.rows import Row, row
from treadload.sweeps.sampling import over_points
from treadload.sweeps.screening.answers import Ranges, Screening, Solving, answer, reading_in_words


@dataclass(frozen=True, eq=False)
class Tornado(Screening, group="tornado"):
    """A result at both ends of the range of every input, one at a time; the largest swing first.

    dataset: over `input`: ends and base of the inputs, the reading at them, the swing; NaN where a case failed.

    >>> tire = {"profile": {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}, "inflation_pressure": "8 bar"}
    >>> road = {"layers": [{"material": {"kind": "elastic", "modulus": "5 GPa", "poisson": 0.35}}]}
    >>> wheel = {"normal_load": "100 N", "friction": 0.7}
    >>> case = tl.Case.from_dict({"tire": tire, "pavement": road, "rolling": wheel, "spacing": "6 mm"})
    >>> tornado = tl.sweeps.tornado(case, {"normal_load": ("50 N", "100 N")}, of="largest_pressure")
    >>> f"{tornado.dataset.reading_low.item() / 1e3:.0f} kPa at the low end"
    '116 kPa at the low end'
    """

    title: ClassVar[str] = "Tornado"
    holds: ClassVar[Holds] = Holds(
        {"input_low input_high input_base reading_low reading_high swing": "input", "reading_base": ""},
        labels={"input key key_unit": "input"},
        texts="of unit place",
    )

    @property
    def heading(self) -> str:
        """The reading and its unit."""
        return f"{reading_in_words(self.dataset.attrs)}, as each input goes to the ends of its range"

    def rows(self) -> tuple[Row, ...]:
        """The reading of the base case, and at both ends of every input."""
        data = self.dataset
        rows = [row("reading_base", data["reading_base"])]
        for k, name in enumerate(map(str, data["input"].to_numpy())):
            unit = str(data["key_unit"].to_numpy()[k])
            for end in ("low", "high"):
                value, reading = (float(data[f"{what}_{end}"][k]) for what in ("input", "reading"))
                at = row(f"input_{end}", f"{value:.6g} {unit}".rstrip(), group=name)
                outcome = "failed" if math.isnan(reading) else reading
                rows += [at, row(f"reading_{end}", outcome, group=name)]
        return tuple(rows)


def tornado(
    case: Case,
    ranges: Mapping[str, tuple[object, object]],
    of: str,
    *,
    at: Mapping[str, object] | None = None,
    **solving: Unpack[Solving],
) -> Tornado:
    """Take every input to the low and the high end of its range, one at a time around the case.

    case: the base, which gives every input. ranges: key → (low, high), in SI units or with their units. of: name of a
    number of every case, "worst_strain", or of a field over the plane, "max(principal_strain_1)". at: dimension →
    value of a number that is over one, {"depth": 0.21}. solving: store, jobs, in_threads, scheduler, progress, as in
    `sweep`. 2 n + 1 cases for n inputs. It sees no interaction of inputs: `sobol` does. Returns the Tornado. A case
    that failed leaves a gap and a warning. Raises InputError, also where the base case fails.

    >>> tire = {"profile": {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}, "inflation_pressure": "8 bar"}
    >>> road = {"layers": [{"material": {"kind": "elastic", "modulus": "5 GPa", "poisson": 0.35}}]}
    >>> wheel = {"normal_load": "100 N", "friction": 0.7}
    >>> case = tl.Case.from_dict({"tire": tire, "pavement": road, "rolling": wheel, "spacing": "6 mm"})
    >>> tornado = tl.sweeps.tornado(case, {"normal_load": ("50 N", "100 N")}, of="largest_pressure")
    >>> f"{tornado.dataset.swing.item() / 1e3:.0f} kPa from 50 to 100 N"
    '32 kPa from 50 to 100 N'
    """
    inputs = Ranges.of(case, ranges)
    base = np.array([base_value(case, name, key) for name, key in zip(inputs.names, inputs.keys, strict=True)])
    count = len(base)
    points = np.tile(base, (2 * count + 1, 1))
    points[1 : count + 1][np.diag_indices(count)] = inputs.low
    points[count + 1 :][np.diag_indices(count)] = inputs.high
    answers = answer(case, over_points(case, list(inputs.names), points), of, at, **solving)
    values = answers.values
    if not np.isfinite(values[0]):
        raise InputError(f"the base case has no {of}: {answers.reason(0)}")
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
                    + f": {answers.reason(int(number))}"
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
        **answers.about,
    )
    return Tornado(dataset, case, tuple(warnings))


def base_value(case: Case, name: str, key: str) -> float:
    """What the case itself gives for a key, or leaves to its default. Raises InputError where that is no number."""
    here = value_at(case, key)
    if isinstance(here, bool) or not isinstance(here, int | float):
        complaint = "gives none" if here is None else f"gives {here!r}"
        raise InputError(
            f"a tornado turns around the number that the case gives for {name}, and it {complaint}; give one"
        )
    return float(here)
