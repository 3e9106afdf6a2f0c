"""Bound-constrained conjugate gradients for contact: minimise ½ p·A p + p·h subject to p ≥ 0.

Either the sum of p is prescribed or the multiplier of that constraint, the approach.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from treadload.kernels.arrays import Array, BoolArray

# A running product u = A p gathers round-off and the clipped pressure; it is renewed this often at least.
_RENEW_EVERY = 12


@dataclass(frozen=True)
class BoundSolution:
    """Solution of the bound-constrained problem.

    pressure: (ny, nx) ≥ 0. compliance: A p (ny, nx). level: the approach. residual: largest violation of
    gap = 0 where p > 0 and of gap ≥ 0 elsewhere, relative to the level. converged: residual ≤ tolerance.
    """

    pressure: Array
    compliance: Array
    level: float
    residual: float
    iterations: int
    products: int
    converged: bool


def solve(
    product: Callable[[Array], Array],
    gap: Array,
    start: Array,
    *,
    total: float | None = None,
    level: float | None = None,
    precondition: Callable[[Array], Array],
    tolerance: float = 1e-6,
    max_iterations: int = 300,
) -> BoundSolution:
    """Find p ≥ 0 with gap = h + A p - level ≥ 0 and p·gap = 0.

    product: A, symmetric and positive definite. gap: h (ny, nx), NaN where no pressure can act.
    start: p ≥ 0 (ny, nx) to begin with. total: prescribed sum of p; or level: prescribed approach.
    precondition: an approximate inverse of A.
    Cells that penetrate enter without a restart, and the search direction stays conjugate by
    Polak and Ribière. Returns the solution, converged or not.

    Sources: Polonsky & Keer (1999), Wear 231, 206-219; Vollebregt (2014), J. Comput. Phys. 257, 333-351.
    """
    if (total is None) == (level is None):
        raise ValueError("give either total or level")
    material = ~np.isnan(gap)
    h = np.where(material, gap, np.inf)
    prescribed = level
    p = np.where(material, start, 0.0)
    active: BoolArray = p > 0
    if total is not None:
        if not active.any():
            active = h == h.min()
            p = active.astype(float)
        p *= total / p.sum()
    u = product(p)
    products = iterations = 0
    direction = np.zeros_like(p)
    old_residual = np.zeros_like(p)
    old_energy = 0.0
    fresh, age = True, 0
    while True:
        opening = u + h
        if prescribed is None:
            level = float(opening[active].mean())
        assert level is not None
        separation = opening - level
        error = _violation(separation, active) / _scale(level, h)
        if error <= tolerance or iterations >= max_iterations:
            if fresh:
                break
            u, fresh, age = product(p), True, 0
            products += 1
            continue
        entering = ~active & (separation < 0)
        active |= entering
        residual = np.where(active, -separation, 0.0)
        if prescribed is None:
            residual[active] -= residual[active].mean()
        z = np.where(active, precondition(residual), 0.0)
        if prescribed is None:
            z[active] -= z[active].mean()
        energy = float(np.vdot(z, residual))
        beta = max(0.0, (energy - float(np.vdot(z, old_residual))) / old_energy) if old_energy > 0 else 0.0
        direction = z + beta * np.where(active, direction, 0.0)
        if prescribed is None and beta > 0:
            direction[active] -= direction[active].mean()
        if not direction.any():
            # One active cell under a given total: nothing can move until another cell enters.
            break
        compliance = product(direction)
        products += 1
        curvature = float(np.vdot(direction, compliance))
        step = float(np.vdot(direction, residual)) / curvature
        if step <= 0:
            direction, compliance = z, product(z)
            products += 1
            step = energy / float(np.vdot(z, compliance))
        old_residual, old_energy = residual, energy
        p += step * direction
        u += step * compliance
        age += 1
        fresh = False
        clipped: BoolArray = p < 0
        lost = -float(p[clipped].sum())
        p[clipped] = 0.0
        active &= ~clipped
        direction[clipped] = 0.0
        if total is not None:
            factor = total / p.sum()
            p *= factor
            u *= factor
        iterations += 1
        if lost > tolerance * p.sum() or age >= _RENEW_EVERY:
            u, fresh, age = product(p), True, 0
            products += 1
    assert level is not None
    return BoundSolution(p, u, level, error, iterations, products, error <= tolerance)


def _violation(separation: Array, active: BoolArray) -> float:
    inside = float(np.abs(separation[active]).max(initial=0.0))
    outside = float(-separation[~active].min(initial=0.0))
    return max(inside, outside)


def _scale(level: float, h: Array) -> float:
    return max(abs(level - float(h.min())), np.finfo(float).tiny)
