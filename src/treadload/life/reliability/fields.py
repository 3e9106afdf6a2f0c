"""The numbers of a reliability: years at the risks with their error, probabilities by year, shares of the inputs."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy

from treadload import variables
from treadload.damage.life import Life
from treadload.damage.scatter import Scatter
from treadload.damage.traffic import Traffic
from treadload.deferred import xarray as xr
from treadload.kernels.arrays import Array
from treadload.life.reliability.inputs import FATIGUE, INTERPOLATION, TRAFFIC, Input
from treadload.life.reliability.propagation import MonteCarlo, Quadratic, drawn, first_order

# Years of the curves; distances β of the first order between which its probabilities are interpolated.
_YEARS, _BETAS = 80, np.linspace(-4.5, 4.5, 73)
_LONGEST = 1e4


@dataclass(frozen=True, eq=False)
class Fit:
    """Damage of a criterion over what scatters.

    number: of the criterion. deviation: SN. surface: ln D over the inputs, traffic, fatigue and the error. power: to
    which its damage grows with its strain. missed: what ln D at each risk may err by, see `Direct.held_back`; NaN if
    it was not looked for.
    """

    number: int
    deviation: float
    surface: Quadratic
    power: float
    missed: Array


def reliability_dataset(
    life: Life,
    inputs: Sequence[Input],
    scatter: Scatter,
    fitted_to: Sequence[Fit],
    risks: tuple[float, ...],
    sampling: MonteCarlo,
) -> xr.Dataset:
    """The dataset of a reliability, without what was solved for it. fitted_to: each criterion."""
    traffic, chosen = life.traffic, [fit.number for fit in fitted_to]
    surfaces, powers = [fit.surface for fit in fitted_to], np.array([fit.power for fit in fitted_to])
    every = drawn(surfaces, len(inputs) + 1, sampling.draws, sampling.seed)
    missed = np.stack([fit.missed for fit in fitted_to])
    # Of a road that has failed as soon as one of its criteria has.
    road = np.sort(every.max(axis=0))
    road_missed = np.array([_missed_by_road(every, row, risk) for row, risk in zip(missed.T, risks, strict=True)])
    every.sort(axis=1)
    at_risk = np.quantile(every, 1 - np.array(risks), axis=1).T
    road_at_risk = np.quantile(road, 1 - np.array(risks))
    missed = missed + np.array([_drawn_error(row, risks) for row in every])
    road_missed = road_missed + _drawn_error(road, risks)
    point = [[first_order(surface, risk) for risk in risks] for surface in surfaces]
    median = np.quantile(every, 0.5, axis=1)
    names = [*(unsure.name for unsure in inputs), TRAFFIC, FATIGUE, INTERPOLATION]
    widths = np.array([unsure.width for unsure in inputs] + [math.nan] * 3)
    slopes = np.array([surface.gradient for surface in surfaces]) / powers[:, None] / math.log(10)
    with np.errstate(divide="ignore", invalid="ignore"):
        per_length = np.nanmin(np.where(np.isnan(widths), np.inf, slopes / widths), axis=1)
    years = _years(traffic, every)
    needed = np.array([-math.log(traffic.growth_factor(float(year))) for year in years])
    curves = np.array([[_first_order_of(surface, beta) for beta in _BETAS] for surface in surfaces])
    laws = [life.laws[number][0] for number in chosen]
    fields: dict[str, tuple[tuple[str, ...], Any]] = {
        "years_at_risk": (("criterion", "risk"), _in_years(traffic, at_risk)),
        "years_at_risk_first_order": (
            ("criterion", "risk"),
            _in_years(traffic, np.array([[damage for damage, _ in row] for row in point])),
        ),
        "risk_factor": (("criterion", "risk"), np.exp((median[:, None] - at_risk) / powers[:, None])),
        "failure_probability": (("criterion", "year"), np.array([_share_above(row, needed) for row in every])),
        "failure_probability_first_order": (
            ("criterion", "year"),
            np.array([scipy.special.ndtr(-np.interp(needed, row, _BETAS)) for row in curves]),
        ),
        "importance": (("criterion", "input"), np.array([row[0][1] ** 2 for row in point])),
        "years_error": (("criterion", "risk"), _years_error(traffic, at_risk, missed)),
        "road_years_at_risk": (("risk",), _in_years(traffic, road_at_risk)),
        "road_years_error": (("risk",), _years_error(traffic, road_at_risk, road_missed)),
        "road_failure_probability": (("year",), _share_above(road, needed)),
        "fatigue_scatter": (("criterion",), [fit.deviation for fit in fitted_to]),
        "law_risk": (("criterion",), [float(getattr(law, "risk", math.nan)) for law in laws]),
        "law_risk_factor": (("criterion",), [float(getattr(law, "risk_factor", math.nan)) for law in laws]),
        "law_years": (("criterion",), life.dataset["life_years"].to_numpy()[list(chosen)]),
        "thickness_slope": (("criterion",), np.where(np.isfinite(per_length), -per_length, np.nan)),
    }
    coordinates = {
        "criterion": [life.criteria[number].name for number in chosen],
        "risk": list(risks),
        "year": years,
        "input": names,
    }
    words = [*(unsure.deviation for unsure in inputs), f"{100 * scatter.traffic:g} %", "SN", "error of the surface"]
    return variables.dataset(
        fields,
        coordinates,
        deviations=json.dumps(words, ensure_ascii=False),
        ends=json.dumps([law.end_of_life for law in laws], ensure_ascii=False),
        **({} if traffic.years is None else {"design_years": traffic.years}),
    )


def _years(traffic: Traffic, every: Array) -> Array:
    """Years of the curves, evenly spaced in their logarithm, from the first to the last thousandth of all draws."""
    low, high = np.quantile(every, [0.999, 0.001])
    first, last = (min(max(year, 0.05), _LONGEST) for year in _in_years(traffic, np.array([low, high])))
    return np.geomspace(min(first, 0.5 * last), last, _YEARS)


def _in_years(traffic: Traffic, logarithms: Array) -> Array:
    """Years until damages of a year, by their logarithms, have added up to 1."""
    passes = traffic.passes_per_year * np.exp(-logarithms)
    return np.array([traffic.years_to(float(count)) for count in passes.ravel()]).reshape(passes.shape)


def _years_error(traffic: Traffic, logarithms: Array, missed: Array) -> Array:
    """Part of the years by which they change at most as ln D does by what it may have missed; NaN without."""
    years, off = _in_years(traffic, logarithms), np.nan_to_num(missed)
    ends = np.stack([_in_years(traffic, logarithms - off), _in_years(traffic, logarithms + off)])
    with np.errstate(invalid="ignore"):
        error: Array = np.abs(ends / years - 1).max(axis=0)
    return np.where(np.isfinite(missed) & np.isfinite(years), error, np.nan)


def _drawn_error(rising: Array, risks: Sequence[float]) -> Array:
    """Of quantiles of sorted draws, at each risk: two standard errors of how many draws lie below."""
    count = len(rising)
    places = (1 - np.array(risks)) * count
    off = 2 * np.sqrt(places * np.array(risks))
    low, high = (np.clip(places + sign * off, 0, count - 1).astype(int) for sign in (-1, 1))
    error: Array = 0.5 * (rising[high] - rising[low])
    return error


def _missed_by_road(every: Array, missed: Array, risk: float) -> float:
    """Half of how far ln D (criterion, draws) of the first to fail moves at a risk as each misses (criterion,)."""
    low, high = (np.quantile((every + sign * missed[:, None]).max(axis=0), 1 - risk) for sign in (-1, 1))
    return float(0.5 * (high - low))


def _share_above(rising: Array, bounds: Array) -> Array:
    """Share of sorted values that lies above each bound."""
    share: Array = 1 - np.searchsorted(rising, bounds, side="right") / len(rising)
    return share


def _first_order_of(surface: Quadratic, beta: float) -> float:
    """Ln D at a distance β of the first order."""
    return first_order(surface, float(scipy.special.ndtr(-beta)))[0]
