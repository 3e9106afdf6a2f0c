"""Morris screening: which of many inputs matter at all, from few cases."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, Unpack

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

# Levels of the grid that trajectories step on, bootstrap samples and their confidence.
_LEVELS, _RESAMPLES, _LEVEL = 4, 1000, 0.95
# Fewer trajectories say little of how an effect varies.
_FEWEST = 8
# Deviation over mean of the effects of an input beyond which it bends or interacts.
_BENDS = 0.5
_EFFECTS = ("absolute_effect", "absolute_effect_interval", "mean_effect", "effect_deviation")


@dataclass(frozen=True, eq=False)
class Morris(Screening, group="morris"):
    """Effects of every input on a result, each over its whole range, from many places; the largest first.

    dataset: over `input`: `absolute_effect` (μ*) with the half width of its 95 % interval, `mean_effect` (μ) and
    `effect_deviation` (σ), all in the unit of the result.

    >>> tire = {"profile": {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}, "inflation_pressure": "8 bar"}
    >>> road = {"layers": [{"material": {"kind": "elastic", "modulus": "5 GPa", "poisson": 0.35}}]}
    >>> wheel = {"normal_load": "100 N", "friction": 0.7}
    >>> case = tl.Case.from_dict({"tire": tire, "pavement": road, "rolling": wheel, "spacing": "6 mm"})
    >>> morris = tl.sweeps.morris(case, {"normal_load": ("50 N", "100 N")}, of="largest_pressure", trajectories=2)
    >>> morris.dataset.mean_effect.item() == morris.dataset.absolute_effect.item()  # all effects have one sign
    True
    """

    title: ClassVar[str] = "Morris screening"
    holds: ClassVar[Holds] = Holds(
        {"input_low input_high absolute_effect absolute_effect_interval mean_effect effect_deviation": "input"},
        labels={"input key key_unit": "input"},
        numbers="trajectories cases",
        texts="of unit place",
    )

    @property
    def heading(self) -> str:
        """The reading, its unit and the trajectories."""
        attrs = self.dataset.attrs
        return (
            f"{reading_in_words(attrs)}, effect of every input over its range, {attrs['trajectories']:g} "
            f"trajectories of {attrs['cases']:g} cases"
        )

    def rows(self) -> tuple[Row, ...]:
        """Effects of every input, and whether they bend or interact."""
        data, rows = self.dataset, []
        for k, name in enumerate(map(str, data["input"].to_numpy())):
            star, mean, sigma = (
                float(data[key][k]) for key in ("absolute_effect", "mean_effect", "effect_deviation")
            )
            way = "up" if mean > 0.9 * star else "down" if mean < -0.9 * star else "up and down"
            rows += [row(key, data[key][k], group=name) for key in _EFFECTS]
            rows.append(row("effect_direction", way, group=name, note="bends or interacts" * (sigma > _BENDS * star)))
        return tuple(rows)


def morris(
    case: Case,
    ranges: Mapping[str, tuple[object, object]],
    of: str,
    *,
    trajectories: int = 10,
    logarithmic: bool = False,
    seed: int = 0,
    at: Mapping[str, object] | None = None,
    **solving: Unpack[Solving],
) -> Morris:
    """Effects of inputs along random trajectories that change one of them at a time, after Morris (1991).

    case: the base. ranges: key → (low, high). of, at: as in `tornado`. trajectories: of which each takes n + 1 cases
    for n inputs; ten separate the few inputs that matter from the many that do not. logarithmic: of log10 of the
    result. seed: of the trajectories. solving: store, jobs, in_threads, scheduler, progress, as in `sweep`.
    Returns the Morris effects. A trajectory with a case that failed is left out and warned of; more than a fifth of
    them is an error. Raises InputError.
    Sources: Morris (1991), Technometrics 33; Campolongo, Cariboni and Saltelli (2007), Environ. Model. Softw. 22, of
    μ*; SALib as in `sobol`.

    >>> tire = {"profile": {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}, "inflation_pressure": "8 bar"}
    >>> road = {"layers": [{"material": {"kind": "elastic", "modulus": "5 GPa", "poisson": 0.35}}]}
    >>> wheel = {"normal_load": "100 N", "friction": 0.7}
    >>> case = tl.Case.from_dict({"tire": tire, "pavement": road, "rolling": wheel, "spacing": "6 mm"})
    >>> morris = tl.sweeps.morris(case, {"normal_load": ("50 N", "100 N")}, of="largest_pressure", trajectories=2)
    >>> f"{morris.dataset.absolute_effect.item() / 1e3:.0f} kPa over the range of the load"
    '32 kPa over the range of the load'
    """
    inputs = Ranges.of(case, ranges)
    points = morris_points(inputs, trajectories, seed=seed)
    design = over_points(case, list(inputs.names), points)
    answers = answer(case, design, of, at, logarithmic=logarithmic, **solving)
    size = len(inputs.names) + 1
    whole, warnings = kept(answers, size, "trajectories")
    rows = np.repeat(whole, size)
    dataset, more = morris_effects(inputs, points[rows], answers.values[rows], seed=seed)
    return Morris(dataset.assign_attrs(answers.about), case, tuple([*warnings, *more]))


def morris_points(inputs: Ranges, trajectories: int, *, seed: int) -> Array:
    """Inputs of all cases (trajectories (n + 1), n) in SI units. Raises InputError."""
    if isinstance(trajectories, bool) or not isinstance(trajectories, int) or trajectories < 2:
        raise InputError(f"trajectories must be a whole number, from 2 on, got {trajectories!r}; 10 is the default")
    sampled: Array = salib().sample.morris.sample(inputs.problem, trajectories, num_levels=_LEVELS, seed=seed)
    return sampled


def morris_effects(inputs: Ranges, points: Array, values: Array, *, seed: int = 0) -> tuple[xr.Dataset, list[str]]:
    """Effects from the result of every case, in the order of `morris_points`, and what to warn of."""
    effects = salib().analyze.morris.analyze(
        inputs.problem, points, values, num_levels=_LEVELS, num_resamples=_RESAMPLES, conf_level=_LEVEL, seed=seed
    )
    star, half, mean, sigma = (
        np.asarray(np.ma.filled(effects[name], np.nan), dtype=float)
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
    if count < _FEWEST:
        warnings.append(f"{count} trajectories are few: an effect may be missed; take {_FEWEST} or more")
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
