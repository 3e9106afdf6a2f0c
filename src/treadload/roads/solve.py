"""Fits of a list of basins, some hundred at a time: what a process does, and what is kept of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from treadload.errors import InputError
from treadload.identifiability import LEVEL, quantile
from treadload.kernels.arrays import Array, IntArray
from treadload.roads.basins import Basins, Measured
from treadload.roads.drop_histories import DropHistories
from treadload.roads.history_model import history_models
from treadload.roads.model import models, thicknesses
from treadload.roads.moving_basins import MovingBasins
from treadload.roads.moving_model import moving_models
from treadload.roads.profiles import intervals
from treadload.roads.search import Model, Target, fit
from treadload.roads.station_loads import StationLoads
from treadload.roads.stress_model import StressModel, stress_models
from treadload.roads.uncertainty import SensorError, certainty
from treadload.roads.unknowns import DEPTH, Unknowns, layer_names, relative_modulus

FITTED, FLAGGED, REFUSED = 0, 1, 2
"""Status of a drop."""


@dataclass(frozen=True, eq=False)
class Fits:
    """Of drops, a row each; NaN where one was refused or has no such layer.

    x: logarithms of the unknowns (n, p). deviation: of them (n, p). low, high: ends of their intervals of the level
    of `identifiability.LEVEL` (n, p). at_bound: (n, p), -1, 0, 1. correlation: (n, p, p). deflection: fitted (n, s),
    m. misfit, scatter, freedom: (n,). status: (n,). reason, undecided: texts (n,).
    """

    x: Array
    deviation: Array
    low: Array
    high: Array
    at_bound: Array
    correlation: Array
    deflection: Array
    misfit: Array
    scatter: Array
    freedom: Array
    status: Array
    reason: Array
    undecided: Array


def solve(basins: Measured, unknowns: Unknowns, error: SensorError, usual: float) -> Fits:
    """The fit of every drop; see `backcalculate`. What cannot be fitted is refused with its reason.

    usual: compliance of the whole list, of which these are a part, m/N.
    """
    names = layer_names(unknowns.road)
    count, p, sensors = len(basins), len(unknowns.names), basins.readings.shape[1]
    table = thicknesses(basins, unknowns, names)
    reasons = _refusals(basins, unknowns, names, table, usual)
    flags = basins.flags()
    scales, error_sizes = basins.scales, basins.error_sizes
    fits = _empty(count, p, sensors)
    for number, reason in enumerate(reasons):
        if reason:
            fits.status[number], fits.reason[number] = REFUSED, reason
    drops = np.array([number for number, reason in enumerate(reasons) if not reason], dtype=int)
    centre = np.array(
        [0.0 if prior is None else prior[0] for prior in unknowns.priors] + [0.0] * unknowns.seeks_depth
    )
    width = np.array(
        [math.inf if prior is None else prior[1] for prior in unknowns.priors] + [math.inf] * unknowns.seeks_depth
    )
    for model in _models(basins, unknowns, table, drops):
        chosen = list(model.chosen)
        measured = basins.readings[model.drops]
        target = Target(
            measured,
            error.at(error_sizes[model.drops]),
            unknowns.low[chosen],
            unknowns.high[chosen],
            centre[chosen],
            width[chosen],
        )
        fitted = fit(model, target)
        sought = [unknowns.names[k] for k in chosen]
        settled = model.settled(fitted.x[:, None])[1][:, 0] if isinstance(model, StressModel) else fitted.converged
        # Of the errors as they weigh: what the intervals of the drops are made of.
        reach, linear = np.full(len(model.drops), math.nan), np.full(fitted.x.shape, math.nan)
        for row, drop in enumerate(model.drops):
            sizes = scales[drop], error_sizes[drop]
            sure = certainty(sought, measured[row], sizes, fitted, row, error, width[chosen])
            stated = error.stated or sure.scatter == 1.0 or not sure.freedom > 0
            reach[row] = quantile(LEVEL, sure.freedom, stated=stated) * sure.scatter
            # A fit without any residual has no scatter, and intervals without width.
            linear[row] = sure.deviations / (sure.scatter or 1.0)
            caveats = [flags[drop]] * bool(flags[drop]) + list(sure.caveats)
            caveats += _at_bounds(unknowns, chosen, fitted.at_bound[row])
            if not fitted.converged[row]:
                caveats.append("the search did not settle")
            elif not settled[row]:
                caveats.append("the moduli of the stress-dependent layers do not settle under its loads")
            fits.x[drop, chosen] = fitted.x[row]
            fits.deviation[drop, chosen] = sure.deviations
            fits.at_bound[drop, chosen] = fitted.at_bound[row]
            fits.correlation[np.ix_([drop], chosen, chosen)] = sure.correlation
            fits.deflection[drop] = np.where(np.isfinite(measured[row]), fitted.deflection[row], math.nan)
            fits.misfit[drop], fits.scatter[drop], fits.freedom[drop] = sure.misfit, sure.scatter, sure.freedom
            fits.status[drop] = FLAGGED if caveats else FITTED
            fits.reason[drop] = "; ".join(caveats)
            fits.undecided[drop] = "; ".join(sure.undecided)
        ends = intervals(model, target, fitted, linear, reach)
        for row, drop in enumerate(model.drops):
            fits.low[drop, chosen], fits.high[drop, chosen] = ends[0][row], ends[1][row]
    return fits


def _models(basins: Measured, unknowns: Unknowns, table: Array, drops: IntArray) -> Sequence[Model]:
    if not len(drops):
        return ()
    if isinstance(basins, MovingBasins):
        return moving_models(basins, unknowns, table, drops)
    if isinstance(basins, DropHistories):
        return history_models(basins, unknowns, table, drops)
    if isinstance(basins, StationLoads):
        return stress_models(basins, unknowns, table, drops)
    assert isinstance(basins, Basins)
    return models(basins, unknowns, table, drops)


def _cold(basins: Measured, unknowns: Unknowns, number: int) -> str:
    """Why the memory of a layer is not known at a drop."""
    warmth = math.nan if basins.temperature is None else float(basins.temperature[number])
    try:
        for layer in unknowns.road.layers:
            relative_modulus(layer, np.ones(1), warmth)
    except InputError as error:
        return str(error)
    return ""


def _empty(count: int, p: int, sensors: int) -> Fits:
    def nan(*shape: int) -> Array:
        return np.full((count, *shape), math.nan)

    texts = [np.full(count, "", dtype=object) for _ in range(2)]
    return Fits(
        nan(p),
        nan(p),
        nan(p),
        nan(p),
        np.zeros((count, p)),
        nan(p, p),
        nan(sensors),
        nan(),
        nan(),
        nan(),
        np.zeros(count),
        *texts,
    )


def _refusals(basins: Measured, unknowns: Unknowns, names: tuple[str, ...], table: Array, usual: float) -> list[str]:
    reasons = basins.refusals(usual)
    readings = np.isfinite(basins.readings).sum(axis=1)
    for number, reason in enumerate(reasons):
        if reason:
            continue
        thickness = table[number]
        wrong = np.flatnonzero(~np.isfinite(thickness[:-1]))
        there = [k for k, layer in enumerate(unknowns.moduli) if thickness[layer] > 0]
        bare = sum(unknowns.priors[k] is None for k in there) + int(unknowns.seeks_depth)
        if len(wrong):
            reasons[number] = f"the thickness of {names[wrong[0]]} is missing"
        elif not thickness[-1] > 0:
            reasons[number] = (
                f"its layers are {thickness[:-1].sum():.3g} m thick and reach below the stiff layer at "
                f"{unknowns.depth:g} m"
            )
        elif unknowns.seeks_depth and thickness[:-1].sum() >= unknowns.depth_bounds[0]:
            reasons[number] = (
                f"its layers are {thickness[:-1].sum():.3g} m thick and reach below the least depth of the stiff "
                f"layer, {unknowns.depth_bounds[0]:g} m"
            )
        elif not there and not unknowns.seeks_depth:
            reasons[number] = "none of the layers whose modulus is sought is present"
        elif readings[number] < bare:
            sought = ", ".join([names[unknowns.moduli[k]] for k in there] + [DEPTH] * unknowns.seeks_depth)
            reasons[number] = (
                f"{readings[number]} readings cannot decide {bare} numbers ({sought}); fix a layer or give priors"
            )
        else:
            reasons[number] = _cold(basins, unknowns, number)
    return reasons


def _at_bounds(unknowns: Unknowns, chosen: list[int], side: Array) -> list[str]:
    texts = []
    for k, where in zip(chosen, side, strict=True):
        if where:
            bound = float(np.exp(unknowns.low[k] if where < 0 else unknowns.high[k]))
            name = unknowns.names[k]
            shown = f"{bound:g} m" if name == DEPTH else f"{bound / 1e6:g} MPa"
            texts.append(f"{name} ended at its {'lower' if where < 0 else 'upper'} bound of {shown}")
    return texts
