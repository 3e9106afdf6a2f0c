"""Intervals where the linear ones fail: as far as the best fit with one number pinned stays within the errors.

The profile likelihood of a number: it is pinned aside from its fit, the others are fitted again, and the interval
ends where the sum of squares has risen by the square of the quantile. For a linear problem these are the linear
intervals. Square roots of the rise are nearly straight in the distance, so that a few secants find the ends.

Source: Venzon and Moolgavkar (1988), Applied Statistics 37, 87-94; Bates and Watts (1988), Nonlinear Regression
Analysis and Its Applications, chapter 6.
"""

from __future__ import annotations

import numpy as np

from treadload.kernels.arrays import Array, BoolArray
from treadload.roads.search import Fitted, Model, Target

# Rounds of secants, steps of the inner fit in each, and the largest move of a number in a round, in ln.
_ROUNDS, _STEPS, _FAR = 7, 3, 2.0
# Linear intervals whose ends differ in the rise by more than this part are replaced.
_BENT = 0.15
# Intervals narrower than this, in ln, are straight: what differs is round-off.
_NARROW = 1e-6


# Drops of a block: keeps the kernels near the cache.
_BLOCK = 8


def intervals(model: Model, target: Target, fits: Fitted, deviation: Array, reach: Array) -> tuple[Array, Array]:
    """Ends of the intervals of every drop, in ln (n, p) each: linear, and by their profiles where these are bent.

    deviation: linear standard deviations, errors as they weigh (n, p), NaN for none. reach: of the interval in them
    (n,), NaN without a reading to spare.
    """
    wide = reach[:, None] * deviation
    with np.errstate(over="ignore"):
        low, high = fits.x - wide, fits.x + wide
    count = max(1, _BLOCK * 100 // model.size)
    for start in range(0, len(fits.x), count):
        at = np.arange(start, min(start + count, len(fits.x)))
        at = at[np.nan_to_num(wide[at]).max(axis=1) > _NARROW]
        if len(at):
            at = at[bent(model.rows(at), target.rows(at), fits.x[at], deviation[at], reach[at])]
        if len(at):
            low[at], high[at] = profile(model.rows(at), target.rows(at), fits.x[at], deviation[at], reach[at])
    return low, high


def bent(model: Model, target: Target, x: Array, deviation: Array, reach: Array) -> BoolArray:
    """Which drops have intervals that are not linear (n,).

    x: the fit (n, p). deviation: linear standard deviations, errors as they weigh (n, p), NaN for none. reach: of the
    interval in them (n,).
    """
    base = _cost(model, target, x[:, None])
    wide = reach[:, None] * np.nan_to_num(deviation)
    _, slopes = model.with_slopes(x[:, None])
    weighed = target.slopes(slopes)[:, 0]
    normal = np.einsum("nrp,nrq->npq", weighed, weighed)
    covariance = np.linalg.pinv(normal, hermitian=True)
    # To the end of each interval the others go along as the linear fit has it.
    size = np.sqrt(np.maximum(np.einsum("npp->np", covariance), 1e-300))
    moves = covariance / np.square(size)[:, None, :] * wide[:, None, :]
    ends = np.concatenate([x[:, None] + s * np.swapaxes(moves, 1, 2) for s in (1, -1)], axis=1)
    inside = ((ends >= target.low) & (ends <= target.high)).all(axis=-1)
    rise = _cost(model, target, np.clip(ends, target.low, target.high)) - base
    wanted = np.square(reach)[:, None]
    there = np.tile(np.isfinite(deviation) & (wide > 0), (1, 2))
    wrong = np.abs(np.sqrt(np.maximum(rise, 0) / wanted) - 1) > _BENT
    return np.asarray((there & (wrong | ~inside)).any(axis=1))


def profile(model: Model, target: Target, x: Array, deviation: Array, reach: Array) -> tuple[Array, Array]:
    """Ends of the intervals, in ln (n, p) each; at a bound where the rise stays below; NaN where there is none.

    Arguments as those of `bent`; reach in the errors as they weigh.
    """
    p = x.shape[1]
    base = _cost(model, target, x[:, None])
    wanted = reach[:, None]
    holds = np.concatenate([np.arange(p), np.arange(p)])
    sign = np.repeat([1.0, -1.0], p)
    there = np.isfinite(deviation)[:, holds]
    away = np.where(there, np.minimum(reach[:, None] * np.nan_to_num(deviation)[:, holds], _FAR), 0.0)
    points = np.repeat(x[:, None], 2 * p, axis=1)
    room = np.where(sign > 0, (target.high - x)[:, holds], (x - target.low)[:, holds])
    best_low, best_high = np.zeros_like(away), np.minimum(room, np.full_like(away, np.inf))
    for _ in range(_ROUNDS):
        away = np.minimum(away, room)
        pinned = x[:, holds] + sign * away
        points = np.where(np.arange(p) == holds[:, None], pinned[..., None], points)
        # Slopes serve three steps each.
        points = _refit(model, target, _refit(model, target, points, holds), holds)
        rise = np.sqrt(np.maximum(_cost(model, target, points) - base, 0.0))
        short = rise < wanted
        best_low = np.where(short, np.maximum(best_low, away), best_low)
        best_high = np.where(short, best_high, np.minimum(best_high, away))
        factor = np.clip(wanted / np.maximum(rise, 1e-12), 0.4, 2.5)
        trial = away * factor
        # Between what fell short and what went too far.
        middle = 0.5 * (best_low + np.minimum(best_high, 2 * best_low + _FAR))
        away = np.where((trial <= best_low) | (trial >= best_high), middle, trial)
        away = np.where(there, away, 0.0)
    ends = np.where(there, x[:, holds] + sign * np.minimum(away, room), np.nan)
    return ends[:, p:], ends[:, :p]


def _cost(model: Model, target: Target, x: Array) -> Array:
    residual = target.residuals(x, model.deflection(x))
    return np.asarray((residual**2).sum(axis=-1))


def _refit(model: Model, target: Target, x: Array, holds: Array) -> Array:
    """The best fit with a number pinned in each variant: x (n, v, p), holds (v,)."""
    p = x.shape[-1]
    pinned = np.arange(p) == holds[:, None]
    reading, slopes = model.with_slopes(x)
    residual = target.residuals(x, reading)
    cost = (residual**2).sum(axis=-1)
    # Slopes of the point serve all steps: each costs a solve without them.
    weighed = np.where(pinned[:, None, :], 0.0, target.slopes(slopes))
    normal = np.einsum("nvrp,nvrq->nvpq", weighed, weighed)
    scale = np.einsum("nvpp->nvp", normal)
    damping = np.full(x.shape[:2], 1e-4)
    for _ in range(_STEPS):
        pull = np.einsum("nvrp,nvr->nvp", weighed, residual)
        diagonal = damping[..., None] * scale + 1e-12 * scale.max(axis=-1, keepdims=True) + pinned
        step = -np.linalg.solve(normal + diagonal[..., None] * np.eye(p), pull[..., None])[..., 0]
        step *= np.minimum(1.0, _FAR / np.maximum(np.abs(step).max(axis=-1, keepdims=True), 1e-300))
        trial = np.where(pinned, x, np.clip(x + step, target.low, target.high))
        apart = target.residuals(trial, model.deflection(trial))
        square = (apart**2).sum(axis=-1)
        better = square < cost
        x = np.where(better[..., None], trial, x)
        residual = np.where(better[..., None], apart, residual)
        cost = np.where(better, square, cost)
        damping = np.where(better, damping / 4, damping * 16)
    return x
