"""Morris screening: which of many inputs matter at all, from few cases."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from treadload import variables
from treadload.case.file import FilePart
from treadload.composing import BaseResult, Holds
from treadload.describing import first_line
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.study.screening.asked import Progress, Ranges, Where, answer, kept, salib
from treadload.study.sweeps import over_points

# Levels of the grid that trajectories step on, bootstrap samples and their confidence.
_LEVELS, _RESAMPLES, _LEVEL = 4, 1000, 0.95
# Fewer trajectories say little of how an effect varies.
_FEW = 8
# Deviation over mean of the effects of an input beyond which it bends or interacts.
_BENDS = 0.5


@dataclass(frozen=True, eq=False)
class Morris(BaseResult, group="morris"):
    """Effects of every input on a result, each over its whole range, from many places; the largest first.

    dataset: over `input`: `absolute_effect` (μ*) with the half width of its 95 % interval, `mean_effect` (μ) and
    `effect_deviation` (σ), all in the unit of the result.
    """

    holds: ClassVar[Holds] = Holds(
        {"input_low input_high absolute_effect absolute_effect_interval mean_effect effect_deviation": "input"},
        labels={"input key key_unit": "input"},
        numbers="trajectories cases",
        texts="of unit place",
    )

    dataset: xr.Dataset
    case: FilePart
    warnings: tuple[str, ...] = ()

    def summary(self) -> str:
        """A table: effects of every input, and whether they bend or interact."""
        data, attrs = self.dataset, self.dataset.attrs
        unit = "" if attrs["unit"] == "1" else f", {attrs['unit']}"
        place = f", {attrs['place']}" if attrs["place"] else ""
        names = [str(name) for name in data["input"].to_numpy()]
        wide = max(len(name) for name in names)
        lines = [
            f"{attrs['of']}{place}: effect of every input over its range{unit}, {attrs['trajectories']:g} "
            f"trajectories of {attrs['cases']:g} cases"
        ]
        for k, name in enumerate(names):
            star, half, mean, sigma = (
                float(data[one][k])
                for one in ("absolute_effect", "absolute_effect_interval", "mean_effect", "effect_deviation")
            )
            way = "up" if mean > 0.9 * star else "down" if mean < -0.9 * star else "up and down"
            bends = "; bends or interacts" if sigma > _BENDS * star else ""
            lines.append(f"  {name:{wide}}  {star:.3g} ± {half:.2g}, σ {sigma:.2g}: {way}{bends}")
        return "\n".join([*lines, *(f"warning: {text}" for text in self.warnings)])

    __repr__ = first_line


def morris(
    case: FilePart,
    ranges: Mapping[str, tuple[Any, Any]],
    of: str,
    *,
    trajectories: int = 10,
    logarithmic: bool = False,
    seed: int = 0,
    at: Mapping[str, Any] | None = None,
    store: str | os.PathLike[str] | None = None,
    jobs: int = 1,
    in_threads: bool = False,
    scheduler: Any = None,
    progress: Progress | None = None,
) -> Morris:
    """Effects of inputs along random trajectories that change one of them at a time, after Morris (1991).

    case: the base. ranges: key → (low, high). of, at: as in `tornado`. trajectories: of which each takes n + 1 cases
    for n inputs; ten tell the few inputs that matter from the many that do not. logarithmic: of log10 of the result.
    seed: of the trajectories. store, jobs, in_threads, scheduler, progress: as in `sweep`.
    Returns the Morris effects. A trajectory with a case that failed is left out and warned of; more than a fifth of
    them is an error. Raises InputError.
    Sources: Morris (1991), Technometrics 33; Campolongo, Cariboni and Saltelli (2007), Environ. Model. Softw. 22, of
    μ*; SALib as in `sobol`.
    """
    inputs = Ranges.of(case, ranges)
    points = morris_points(inputs, trajectories, seed=seed)
    found = answer(
        case, over_points(case, list(inputs.names), points), of, at,
        Where(store, jobs, in_threads, scheduler, progress), logarithmic=logarithmic,
    )  # fmt: skip
    size = len(inputs.names) + 1
    whole, warnings = kept(found, size, "trajectories")
    rows = np.repeat(whole, size)
    dataset, more = morris_effects(inputs, points[rows], found.values[rows], seed=seed)
    return Morris(dataset.assign_attrs(found.about), case, tuple([*warnings, *more]))


def morris_points(inputs: Ranges, trajectories: int, *, seed: int) -> Array:
    """Inputs of all cases (trajectories (n + 1), n) in SI units. Raises InputError."""
    if isinstance(trajectories, bool) or not isinstance(trajectories, int) or trajectories < 2:
        raise InputError(f"trajectories must be a whole number, from 2 on, got {trajectories!r}; 10 is the default")
    sampled: Array = salib().sample.morris.sample(inputs.problem, trajectories, num_levels=_LEVELS, seed=seed)
    return sampled


def morris_effects(inputs: Ranges, points: Array, values: Array, *, seed: int = 0) -> tuple[xr.Dataset, list[str]]:
    """Effects from the result of every case, in the order of `morris_points`, and what to warn of."""
    told = salib().analyze.morris.analyze(
        inputs.problem, points, values, num_levels=_LEVELS, num_resamples=_RESAMPLES, conf_level=_LEVEL, seed=seed
    )
    star, half, mean, sigma = (
        np.asarray(np.ma.filled(told[name], np.nan), dtype=float)
        for name in ("mu_star", "mu_star_conf", "mu", "sigma")
    )
    order = np.argsort(-star, kind="stable")
    count = len(values) // (len(inputs.names) + 1)
    dataset = variables.dataset(
        {
            "input_low": (("input",), inputs.low[order]),
            "input_high": (("input",), inputs.high[order]),
            "absolute_effect": (("input",), star[order]),
            "absolute_effect_interval": (("input",), half[order]),
            "mean_effect": (("input",), mean[order]),
            "effect_deviation": (("input",), sigma[order]),
        },
        inputs.coordinates(order),
        trajectories=count,
        cases=len(values) // count,
    )
    warnings = []
    if count < _FEW:
        warnings.append(f"{count} trajectories are few: an effect may be missed; take {_FEW} or more")
    largest = float(star.max())
    vague = [
        f"{inputs.names[k]} {star[k]:.2g} ± {half[k]:.2g}"
        for k in order
        if half[k] > star[k] and half[k] > 0.05 * largest
    ]
    if vague:
        warnings.append(
            f"effects whose 95 % interval is wider than they are: {', '.join(vague)}; take more trajectories"
        )
    return dataset, warnings
