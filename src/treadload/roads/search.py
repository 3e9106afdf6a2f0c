"""Weighted least squares of many basins at once: damped Gauss-Newton steps within bounds, from several starts.

No start is asked for: structures spread over the bounds are computed once for each geometry, scaled so that they fit
each basin in the mean where all moduli are sought, and the best of them begin. The starts of a drop run side by side,
and the one with the least sum of squares is its fit.

Source: Marquardt (1963), J. SIAM 11, 431-441; steps by QR, as Moré (1978), Lecture Notes in Mathematics 630, 105-116;
geodesic acceleration after Transtrum and Sethna (2012), arXiv:1201.5885.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from treadload.kernels.arrays import Array, BoolArray, IntArray

# Structures that a search may begin with, and how many begin for each drop.
_LIBRARY, _STARTS = 256, 5
# Readings below this part of the largest do not choose a start.
_FAINT = 1e-3
# Of the library: no further than this, Pa, whatever the bounds allow.
_SOFT, _STIFF = 1e7, 4e10
# Largest step of ln E. Steps below _SMALL end a search, so does damping beyond _STUCK; squares below _ZERO fit
# to round-off.
_LONGEST, _SMALL, _STUCK, _ZERO = 2.0, 1e-9, 1e9, 1e-22
# So does a step that gains less than this part of the sum of squares: a thousandth of its least scatter.
_GAIN = 1e-5
# The bend of the way is read this part of a step ahead, and followed where it is less than this part of the step.
_PROBE, _BEND = 0.1, 1.0
# Minima whose numbers differ by more than this, in ln, are two.
_APART = 0.3
_MOST = 80
# Structures times wavenumbers of a block keep near the cache.
_BLOCK = 60_000


class Model(Protocol):
    """What drops of the same sensors show over logarithms of the unknowns x (n, v, p); see `BasinModel`."""

    @property
    def drops(self) -> IntArray:
        """Numbers of the drops."""

    @property
    def present(self) -> tuple[int, ...]:
        """Numbers of the layers that are there."""

    @property
    def sought(self) -> tuple[int, ...]:
        """Places among these of the layers whose modulus is sought."""

    @property
    def chosen(self) -> tuple[int, ...]:
        """Numbers of the unknowns in the columns of x."""

    @property
    def load(self) -> Array:
        """Of the drops (n,), N."""

    @property
    def size(self) -> int:
        """Nodes of a structure."""

    @property
    def geometry(self) -> Array:
        """Numbers that drops of the same geometry share (n, ...)."""

    @property
    def coarse(self) -> Model:
        """A cheaper one that starts are found with, or itself."""

    def rows(self, at: IntArray) -> Model:
        """Of some of the drops."""

    def deflection(self, x: Array) -> Array:
        """Readings (n, v, r)."""

    def with_slopes(self, x: Array) -> tuple[Array, Array]:
        """Readings, and their slopes over x (n, v, r, p)."""


@dataclass(frozen=True, eq=False)
class Fitted:
    """Fits of the drops of a model. All over (n, ...).

    x: logarithms of the unknowns (n, p). deflection: (n, s), m. slopes: (n, s, p) over ln. at_bound: -1, 0, 1 (n, p).
    converged: (n,). rival: another minimum (n, p), NaN where there is none;
    gap: by how much its sum of squares is larger (n,).
    """

    x: Array
    deflection: Array
    slopes: Array
    at_bound: Array
    converged: BoolArray
    rival: Array
    gap: Array


@dataclass(frozen=True, eq=False)
class Target:
    """What the drops of a model are fitted to.

    deflection: measured (n, s), m, NaN where missing. error: (n, s), m. low, high: bounds of ln (p,). centre, width:
    of priors (p,), width inf for none.
    """

    deflection: Array
    error: Array
    low: Array
    high: Array
    centre: Array
    width: Array

    def rows(self, at: IntArray) -> Target:
        """Of some of the drops."""
        return Target(self.deflection[at], self.error[at], self.low, self.high, self.centre, self.width)

    def residuals(self, x: Array, deflection: Array) -> Array:
        """(n, v, s + p): over the errors, then from the priors."""
        weight = np.where(np.isfinite(self.deflection), 1 / self.error, 0.0)[:, None]
        apart = (deflection - np.nan_to_num(self.deflection)[:, None]) * weight
        return np.concatenate([apart, (x - self.centre) / self.width], axis=-1)

    def slopes(self, slopes: Array) -> Array:
        """Of the residuals (n, v, s + p, p), from those of the deflection (n, v, s, p)."""
        weight = np.where(np.isfinite(self.deflection), 1 / self.error, 0.0)[:, None, :, None]
        prior = np.broadcast_to(np.diag(1 / self.width), (*slopes.shape[:2], *([len(self.width)] * 2)))
        return np.concatenate([slopes * weight, prior], axis=-2)


def fit(model: Model, target: Target) -> Fitted:
    """The best fit of every drop of a model."""
    if model.coarse is not model:
        rough = fit(model.coarse, target)
        starts = np.stack([rough.x, np.where(np.isfinite(rough.rival), rough.rival, rough.x)], axis=1)
        if not np.isfinite(rough.rival).any():
            starts = starts[:, :1]
    else:
        starts = _starts(model, target)
    count = max(1, _BLOCK // (starts.shape[1] * (len(target.low) + 1) * model.size))
    parts = []
    for begin in range(0, len(model.drops), count):
        at = np.arange(begin, min(begin + count, len(model.drops)))
        parts.append(_fit_block(model.rows(at), target.rows(at), starts[at]))
    return Fitted(*(np.concatenate([getattr(part, name) for part in parts]) for name in Fitted.__dataclass_fields__))


def _starts(model: Model, target: Target) -> Array:
    """The best structures of the library for every drop: (n, starts, p)."""
    p = len(target.low)
    count = len(model.sought)
    low, high = target.low.copy(), target.high.copy()
    low[:count] = np.where(high[:count] > np.log(_SOFT), np.maximum(low[:count], np.log(_SOFT)), low[:count])
    high[:count] = np.where(low[:count] < np.log(_STIFF), np.minimum(high[:count], np.log(_STIFF)), high[:count])
    informed = np.isfinite(target.width)
    low = np.where(informed, np.maximum(low, target.centre - 2 * target.width), low)
    high = np.where(informed, np.minimum(high, target.centre + 2 * target.width), high)
    high = np.maximum(high, low)
    # Loads slowly, and whoever only reads a case has no use for it.
    from scipy.stats import qmc

    library = low + (high - low) * qmc.Sobol(p, rng=np.random.default_rng(1)).random(_LIBRARY)
    _, first, kind = np.unique(model.geometry, axis=0, return_index=True, return_inverse=True)
    chosen = np.empty((len(model.drops), _STARTS, p))
    scaled = len(model.sought) == len(model.present)
    for number, representative in enumerate(first):
        drops = np.flatnonzero(kind.ravel() == number)
        single = model.rows(np.array([representative]))
        # Structures of extreme contrast leave nothing of a far deflection but round-off.
        values = np.log(np.maximum(single.deflection(library[None])[0] / single.load[0], 1e-300))
        for part in np.array_split(drops, max(1, len(drops) // 64)):
            readings = target.deflection[part]
            # Starts are judged by ratios: by readings that have some size.
            small = ~(readings > _FAINT * np.nanmax(readings, axis=1, keepdims=True))
            measured = np.log(np.where(small, np.nan, readings) / model.load[part, None])
            chosen[part] = _best(library, values, measured, target, count if scaled else 0)
    return chosen


def _best(library: Array, values: Array, measured: Array, target: Target, scaled: int) -> Array:
    """Starts (n, starts, p) of structures (K, p) with ln deflections (K, s) for basins (n, s)."""
    apart = values[None] - measured[:, None]
    shift = np.nanmean(apart, axis=2) if scaled else np.zeros(apart.shape[:2])
    misfit = np.nanmean((apart - shift[..., None]) ** 2, axis=2)
    moved = np.broadcast_to(library, (*shift.shape, library.shape[1])).copy()
    # Moduli times a number divide the deflection by it.
    moved[..., :scaled] += shift[..., None]
    misfit += 0.1 * (np.maximum(0, np.maximum(target.low - moved, moved - target.high)) ** 2).sum(axis=2)
    best = np.argsort(misfit, axis=1)[:, :_STARTS]
    inside = np.clip(np.take_along_axis(moved, best[..., None], axis=1), target.low, target.high)
    return np.asarray(inside)


def _fit_block(model: Model, target: Target, x: Array) -> Fitted:
    n, starts, _ = x.shape
    low, high = target.low, target.high
    deflection, slopes = model.with_slopes(x)
    residual = target.residuals(x, deflection)
    cost = (residual**2).sum(axis=-1)
    damping = np.full((n, starts), 1e-2)
    running = np.ones((n, starts), bool)
    for _ in range(_MOST):
        drops = np.flatnonzero(running.any(axis=1))
        if not len(drops):
            break
        part, goal = (model, target) if len(drops) == n else (model.rows(drops), target.rows(drops))
        step = _step(part, goal, x[drops], residual[drops], goal.slopes(slopes[drops]), damping[drops])
        trial = np.clip(x[drops] + step, low, high)
        taken = np.abs(trial - x[drops]).max(axis=-1)
        new, new_slopes = part.with_slopes(trial)
        apart = goal.residuals(trial, new)
        square = (apart**2).sum(axis=-1)
        better = running[drops] & (square < cost[drops])
        gain = np.where(better, cost[drops] - square, 0.0) / np.maximum(cost[drops], 1e-300)
        # Where damping is weak, what a step gains is what is left to gain.
        small = (taken < _SMALL) | (better & (gain < _GAIN) & (damping[drops] < 0.1))
        rows, columns = np.nonzero(better)
        places = drops[rows], columns
        x[places], deflection[places], slopes[places] = trial[better], new[better], new_slopes[better]
        residual[places], cost[places] = apart[better], square[better]
        damping[drops] = np.where(better, np.maximum(damping[drops] / 8, 1e-14), damping[drops] * 4)
        running[drops] &= ~(small | (damping[drops] > _STUCK) | (cost[drops] < _ZERO))
    best = cost.argmin(axis=1)
    rows = np.arange(n)
    at = x[rows, best]
    side = np.where(at <= low + 1e-9, -1, np.where(at >= high - 1e-9, 1, 0))
    # A number that the search would lead away from its bound does not lie there.
    pull = np.einsum("nrp,nr->np", target.slopes(slopes)[rows, best], residual[rows, best])
    side = np.where(side * pull < 0, side, 0)
    apart = np.abs(x - at[:, None]).max(axis=-1)
    rivals = np.where((apart > _APART) & ~running, cost, np.inf)
    next_best = rivals.argmin(axis=1)
    gap = rivals[rows, next_best] - cost[rows, best]
    rival = np.where(np.isfinite(gap)[:, None], x[rows, next_best], np.nan)
    return Fitted(at, deflection[rows, best], slopes[rows, best], side, ~running[rows, best], rival, gap)


def _step(model: Model, target: Target, x: Array, residual: Array, slopes: Array, damping: Array) -> Array:
    """Damped step (n, v, p) with its geodesic acceleration; numbers at a bound that it would cross stay there.

    The acceleration follows valleys that bend, where layers trade their stiffness: half as many steps and fewer.
    """
    pull = np.einsum("nvrp,nvr->nvp", slopes, residual)
    at_limit = ((x <= target.low) & (pull > 0)) | ((x >= target.high) & (pull < 0))
    slopes = np.where(at_limit[..., None, :], 0.0, slopes)
    size = np.sqrt((slopes**2).sum(axis=-2))
    size = np.maximum(size, 1e-8 * np.maximum(size.max(axis=-1, keepdims=True), 1e-12))
    p = x.shape[-1]
    extra = np.sqrt(damping)[..., None, None] * np.eye(p)
    q, r = np.linalg.qr(np.concatenate([slopes / size[..., None, :], extra], axis=-2))
    rows = residual.shape[-1]

    def solved(wanted: Array) -> Array:
        turned = np.einsum("nvrp,nvr->nvp", q[..., :rows, :], wanted)
        return np.asarray(-np.linalg.solve(r, turned[..., None])[..., 0] / size)

    velocity = solved(residual)
    longest = np.abs(velocity).max(axis=-1, keepdims=True)
    velocity = velocity * np.minimum(1.0, _LONGEST / np.maximum(longest, 1e-300))
    probe = np.clip(x + _PROBE * velocity, target.low, target.high)
    ahead = target.residuals(probe, model.deflection(probe))
    straight = np.einsum("nvrp,nvp->nvr", slopes, velocity)
    bend = (ahead - residual - _PROBE * straight) * (2 / _PROBE**2)
    acceleration = np.where(at_limit, 0.0, 0.5 * solved(bend))
    lengths = [np.sqrt(((part * size) ** 2).sum(axis=-1, keepdims=True)) for part in (acceleration, velocity)]
    tame = 2 * lengths[0] <= _BEND * lengths[1]
    return np.asarray(velocity + np.where(tame, acceleration, 0.0))
