"""How far a crack has grown after so many passes, and how likely: Paris' law integrated, and its scatter."""

from __future__ import annotations

import numpy as np
import scipy

from treadload.errors import InputError
from treadload.kernels.arrays import Array

# Draws of the two scatters, a power of two as Sobol's sequence wants it: 5 % and 95 % within a per cent or so.
_DRAWS = 12
RISKS = (0.05, 0.5, 0.95)


def refined(lengths: Array, rates: Array, parts: int = 8) -> tuple[Array, Array]:
    """Lengths, m, at several points between those solved, and the rates there, m per load repetition.

    lengths: (n,), m, rising. rates: (n, ...), >= 0. The logarithm of the rate is a monotone cubic of that of the
    length, so that a power of the length stays one; rates that vanish next to a length vanish up to it.
    """
    logs = np.log(lengths)
    fine = np.unique(
        np.concatenate([logs, np.interp(np.arange(parts * (len(logs) - 1)) / parts, range(len(logs)), logs)])
    )
    nothing = 1e-30 * max(float(rates.max(initial=0.0)), 1e-270)
    values = scipy.interpolate.PchipInterpolator(logs, np.log(np.maximum(rates, nothing)), axis=0)(fine)
    between = np.exp(values)
    return np.exp(fine), np.where(between > 10 * nothing, between, 0.0)


def grown(lengths: Array, rates: Array, targets: Array) -> Array:
    """Passes (k, ...) from the first length to each target, m.

    lengths: (n,), m, rising. rates: (n, ...), growth per pass at them, m. targets: (k,), m; beyond the last length
    its rate holds, and below the first no pass is needed. inf where growth stops on the way.
    Between two lengths the rate is a power of the length, whose integral is a closed form.
    """
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        power = np.log(rates[1:] / rates[:-1]) / np.log(lengths[1:] / lengths[:-1]).reshape(
            -1, *[1] * (rates.ndim - 1)
        )
        passes = np.zeros((len(targets), *rates.shape[1:]))
        for k, target in enumerate(targets):
            for j in range(len(lengths) - 1):
                end = min(float(target), float(lengths[j + 1]))
                if end > lengths[j]:
                    passes[k] += _passes(float(lengths[j]), end, rates[j], power[j])
            if target > lengths[-1]:
                passes[k] += (target - lengths[-1]) / rates[-1]
    return np.where(np.isnan(passes), np.inf, passes)


def _passes(start: float, end: float, rate: Array, power: Array) -> Array:
    """∫ da / (rate (a / start)^power) from start to end."""
    stretch = np.log(end / start)
    bend = (1 - power) * stretch
    # expm1(b)/b, which is 1 where the rate is in proportion to the length.
    factor = np.where(np.abs(bend) > 1e-12, np.expm1(bend) / np.where(bend == 0, 1.0, bend), 1.0)
    passes: Array = start * stretch * factor / rate
    return np.where((rate > 0) & np.isfinite(power), passes, np.inf)


def draws() -> tuple[Array, Array]:
    """Standard normal deviates (m,) of initiation and of growth, independent, from Sobol's sequence."""
    # scipy.stats takes as long to import as all of this package.
    from scipy.stats import qmc

    uniform = qmc.Sobol(2, scramble=True, seed=1).random_base2(_DRAWS)
    normal = scipy.special.ndtri(np.clip(uniform, 1e-12, 1 - 1e-12))
    return normal[:, 0], normal[:, 1]


def drawn(initiation: Array, growth: Array, scatter: float, growth_scatter: float) -> Array:
    """Passes (m, k) until the first crack of any place has each length, for every draw.

    initiation: (ny,), passes at even odds. growth: (k, ny), passes from there. scatter, growth_scatter: standard
    deviations of log₁₀ of both. One draw holds for the whole road: places share their mix.
    """
    start, speed = draws()
    passes = np.full((len(start), len(growth)), np.inf)
    alive = np.isfinite(initiation) & np.isfinite(growth).any(axis=0)
    slow, fast = 10 ** (scatter * start), 10 ** (-growth_scatter * speed)
    for y in np.flatnonzero(alive):
        passes = np.minimum(passes, (slow * initiation[y])[:, None] + fast[:, None] * growth[:, y])
    return passes


def risk_quantiles(passes: Array, risks: tuple[float, ...] = RISKS) -> Array:
    """Passes (risks, k) that so large a share of the draws (m, k) does not reach. Raises InputError."""
    for risk in risks:
        if not 0 < risk < 1:
            raise InputError(f"a risk must lie between 0 and 1, got {risk}; 5 % is 0.05")
    ordered = np.sort(passes, axis=0)
    at = [min(int(risk * len(ordered)), len(ordered) - 1) for risk in risks]
    return ordered[at]


def chances(passes: Array, until: float) -> Array:
    """Share (k,) of the draws (m, k) that reach each length within so many passes."""
    share: Array = (passes <= until).mean(axis=0)
    return share
