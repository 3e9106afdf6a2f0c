"""Sobol indices: which share of a result's variance is due to each input, alone and with the others."""

from __future__ import annotations

import warnings as python_warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Unpack

import numpy as np

from treadload import variables
from treadload.case import Case
from treadload.composing import Holds
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.rows import Row, row
from treadload.sweeps.sampling import over_points
from treadload.sweeps.screening.answers import (
    Ranges,
    Screening,
    Solving,
    answer,
    kept,
    reading_in_words,
    salib,
)

# Bootstrap samples, and their confidence.
_RESAMPLES, _LEVEL = 200, 0.95
# Fewer blocks tell little of the confidence itself; an index above this matters.
_FEWEST, _MATTERS = 64, 0.05
# Pairs that a summary lists.
_PAIRS = 3


@dataclass(frozen=True, eq=False)
class Sobol(Screening, group="sobol"):
    """Shares of the variance of a result over the ranges of its inputs, all equally likely; the largest total first.

    dataset: over `input`: `first_order`, the share that an input has alone; `total_order`, with all its interactions;
    each with the half width of its 95 % interval. With pairs over (input, other) as well: `second_order`.

    >>> tire = {"profile": {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}, "inflation_pressure": "8 bar"}
    >>> road = {"layers": [{"material": {"kind": "elastic", "modulus": "5 GPa", "poisson": 0.35}}]}
    >>> wheel = {"normal_load": "100 N", "friction": 0.7}
    >>> case = tl.Case.from_dict({"tire": tire, "pavement": road, "rolling": wheel, "spacing": "6 mm"})
    >>> ranges = {"normal_load": ("50 N", "100 N"), "friction": (0.5, 0.7)}
    >>> sobol = tl.sweeps.sobol(case, ranges, of="largest_pressure", blocks=2)
    >>> sobol.dataset.total_order.sel(input="friction").item()  # a wheel that rolls freely has the same pressure
    0.0
    """

    title: ClassVar[str] = "Sobol indices"
    holds: ClassVar[Holds] = Holds(
        {"input_low input_high first_order first_order_interval total_order total_order_interval": "input"},
        maybe={"second_order second_order_interval": "input other"},
        labels={"input key key_unit": "input"},
        numbers="blocks cases reading_mean reading_deviation",
        texts="of unit place",
    )

    @property
    def heading(self) -> str:
        """The reading, its unit and the blocks."""
        attrs = self.dataset.attrs
        return f"{reading_in_words(attrs)}, {attrs['blocks']:g} blocks of {attrs['cases']:g} cases"

    def rows(self) -> tuple[Row, ...]:
        """Mean and deviation of the reading; both indices of every input with their intervals; pairs."""
        data, attrs = self.dataset, self.dataset.attrs
        rows = [row("reading_mean", attrs["reading_mean"]), row("reading_deviation", attrs["reading_deviation"])]
        for k, name in enumerate(map(str, data["input"].to_numpy())):
            for key in ("first_order", "total_order"):
                rows += [row(column, data[column][k], group=name) for column in (key, f"{key}_interval")]
        return (*rows, *self._pairs())

    def _pairs(self) -> list[Row]:
        if "second_order" not in self.dataset or not {"input", "other"} <= set(self.dataset["second_order"].dims):
            return []
        values = self.dataset["second_order"].transpose("input", "other").to_numpy().astype(float)
        names = [str(name) for name in self.dataset["input"].to_numpy()]
        order = np.argsort(-np.nan_to_num(np.triu(values, 1)), axis=None)[:_PAIRS]
        pairs = [np.unravel_index(int(k), values.shape) for k in order]
        return [
            row("second_order", values[a, b], label=f"{names[a]} with {names[b]}")
            for a, b in pairs
            if values[a, b] > _MATTERS
        ]


def sobol(
    case: Case,
    ranges: Mapping[str, tuple[object, object]],
    of: str,
    *,
    blocks: int = 64,
    second_order: bool = False,
    logarithmic: bool = False,
    seed: int = 0,
    at: Mapping[str, object] | None = None,
    **solving: Unpack[Solving],
) -> Sobol:
    """Share of the variance of a result that is due to each input, by the estimators of Saltelli et al. (2010).

    case: the base. ranges: key → (low, high), all values between equally likely and independent of each other. of,
    at: as in `tornado`. blocks: a power of two; n inputs take blocks (n + 2) cases, with second_order, the indices of
    pairs, blocks (2 n + 2). logarithmic: of log10 of the result, for passes and years. seed: of the sequence.
    solving: store, jobs, in_threads, scheduler, progress, as in `sweep`.
    Returns the Sobol indices with 95 % intervals by bootstrap over the blocks. A block with a case that failed is
    left out and warned of; more than a fifth of them is an error. Intervals wider than an index that matters are
    warned of. Raises InputError.
    Sources: Sobol' (2001), Math. Comput. Simul. 55; Saltelli et al. (2010), Comput. Phys. Commun. 181; Iwanaga, Usher
    and Herman (2022), SALib 2.0, Socio-Environ. Syst. Model. 4.

    >>> tire = {"profile": {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}, "inflation_pressure": "8 bar"}
    >>> road = {"layers": [{"material": {"kind": "elastic", "modulus": "5 GPa", "poisson": 0.35}}]}
    >>> wheel = {"normal_load": "100 N", "friction": 0.7}
    >>> case = tl.Case.from_dict({"tire": tire, "pavement": road, "rolling": wheel, "spacing": "6 mm"})
    >>> ranges = {"normal_load": ("50 N", "100 N"), "friction": (0.5, 0.7)}
    >>> sobol = tl.sweeps.sobol(case, ranges, of="largest_pressure", blocks=2)
    >>> sobol.dataset.input.values.tolist()  # what matters most comes first; take 64 blocks or more for the shares
    ['normal_load', 'friction']
    """
    inputs = Ranges.of(case, ranges)
    points = sobol_points(inputs, blocks, second_order=second_order, seed=seed)
    design = over_points(case, list(inputs.names), points)
    answers = answer(case, design, of, at, logarithmic=logarithmic, **solving)
    size = len(points) // blocks
    whole, warnings = kept(answers, size, "blocks of cases")
    values = answers.values.reshape(-1, size)[whole].ravel()
    dataset, more = sobol_indices(inputs, values, second_order=second_order, seed=seed)
    return Sobol(dataset.assign_attrs(answers.about), case, tuple([*warnings, *more]))


def sobol_points(inputs: Ranges, blocks: int, *, second_order: bool, seed: int) -> Array:
    """Inputs of all cases (blocks (n + 2) or blocks (2 n + 2), n) in SI units. Raises InputError."""
    if isinstance(blocks, bool) or not isinstance(blocks, int) or blocks < 2 or blocks & (blocks - 1):
        raise InputError(f"blocks must be a power of two, from 2 on, got {blocks!r}; 64 is the default")
    if len(inputs.names) < 2:
        raise InputError("Sobol indices share a variance between inputs; give two or more")
    sampled: Array = salib().sample.sobol.sample(
        inputs.problem, blocks, calc_second_order=second_order, scramble=True, seed=seed
    )
    return sampled


def sobol_indices(
    inputs: Ranges, values: Array, *, second_order: bool, seed: int = 0
) -> tuple[xr.Dataset, list[str]]:
    """Indices from the result of every case, in the order of `sobol_points`, and what to warn of.

    Raises InputError for a result that does not vary.
    """
    count = len(inputs.names)
    blocks = len(values) // ((2 * count + 2) if second_order else (count + 2))
    deviation = float(values.std())
    if not deviation > 1e-12 * float(np.abs(values).max()):
        raise InputError(
            f"the result is {values[0]:.6g} in all cases: none of {', '.join(inputs.names)} changes it; ask for "
            "another result or other inputs"
        )
    with python_warnings.catch_warnings():
        python_warnings.simplefilter("ignore")
        indices = salib().analyze.sobol.analyze(
            inputs.problem, values, calc_second_order=second_order, num_resamples=_RESAMPLES, conf_level=_LEVEL,
            seed=seed,
        )  # fmt: skip
    first, first_interval, total, total_interval = (
        np.asarray(indices[name], dtype=float) for name in ("S1", "S1_conf", "ST", "ST_conf")
    )
    order = np.argsort(-total, kind="stable")
    fields: dict[str, tuple[tuple[str, ...], Any]] = {
        "input_low": (("input",), inputs.low[order]),
        "input_high": (("input",), inputs.high[order]),
        "first_order": (("input",), first[order]),
        "first_order_interval": (("input",), first_interval[order]),
        "total_order": (("input",), total[order]),
        "total_order_interval": (("input",), total_interval[order]),
    }
    coordinates = inputs.coordinates(order)
    if second_order:
        for name, label in (("S2", "second_order"), ("S2_conf", "second_order_interval")):
            half = np.nan_to_num(np.asarray(indices[name], dtype=float))
            both = half + half.T
            both[np.diag_indices(count)] = np.nan
            fields[label] = (("input", "other"), both[np.ix_(order, order)])
        coordinates["other"] = coordinates["input"]
    dataset = variables.dataset(
        fields, coordinates, blocks=blocks, cases=len(values) // blocks, reading_mean=float(values.mean()),
        reading_deviation=deviation,
    )  # fmt: skip
    return dataset, _caveats(dataset, blocks)


def _caveats(data: xr.Dataset, blocks: int) -> list[str]:
    warnings = []
    if blocks < _FEWEST:
        warnings.append(
            f"{blocks} blocks are few: their intervals are themselves uncertain; take {_FEWEST} or more to "
            "separate inputs"
        )
    for which, words in (("total_order", "total"), ("first_order", "first-order")):
        values, wide = data[which].to_numpy(), data[f"{which}_interval"].to_numpy()
        vague = [
            f"{name} {value:.2f} ± {half:.2f}"
            for name, value, half in zip(data["input"].to_numpy(), values, wide, strict=True)
            if half > max(abs(value), _MATTERS)
        ]
        if vague:
            warnings.append(
                f"{words} indices whose 95 % interval is wider than they are: {', '.join(vague)}; four times the "
                "blocks halve the intervals"
            )
    return warnings
