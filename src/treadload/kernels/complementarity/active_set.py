"""Contact with an operator that is positive but not symmetric: block pivoting of the complementarity problem.

Cells change sides together while that brings the conditions closer, which is a semi-smooth Newton method; where
it would cycle, one cell at a time changes, which must end because the operator is positive definite.

Sources: Hintermüller, Ito & Kunisch (2002), SIAM J. Optim. 13, 865-888 (active sets as Newton's method);
Júdice & Pires (1994), Comput. Oper. Res. 21, 587-596 (block pivoting with a guard against cycles).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy

from treadload.kernels.arrays import Array, BoolArray

# Full exchanges that leave no fewer wrong cells, before single ones.
_PATIENCE = 5
_KRYLOV_MEMORY = 80
_KRYLOV_RESTARTS = 5
# The first set of cells is only a guess. The equations inside are solved this much better than the conditions are
# asked to hold; no solve inside gains more digits than this at once.
_ROUGH, _INNER, _GAIN = 1e-2, 0.1, 1e-4


@dataclass(frozen=True)
class PivotSolution:
    """Solution of the complementarity problem.

    pressure: (ny, nx) ≥ 0. compliance: A p (ny, nx). level: the approach. residual: largest violation of
    gap = 0 where p > 0 and of gap ≥ 0 elsewhere, relative to the level. iterations: exchanges of cells.
    krylov: products in the equations inside. products: all with A. converged: residual ≤ tolerance.
    """

    pressure: Array
    compliance: Array
    level: float
    residual: float
    iterations: int
    krylov: int
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
    max_iterations: int = 200,
) -> PivotSolution:
    """Find p ≥ 0 with gap = h + A p - level ≥ 0 and p·gap = 0.

    product: A, positive definite (p·A p > 0), not necessarily symmetric. gap: h (ny, nx), NaN where no pressure
    can act. start: p ≥ 0 (ny, nx) to begin with. total: prescribed sum of p; or level: prescribed approach.
    precondition: an approximate inverse of A.
    Returns the solution, converged or not.
    """
    if (total is None) == (level is None):
        raise ValueError("give either total or level")
    problem = _Problem(product, gap, precondition, total, level)
    return problem.run(np.where(problem.material, start, 0.0), tolerance, max_iterations)


class _Problem:
    """What is given, and the counts."""

    def __init__(
        self,
        product: Callable[[Array], Array],
        gap: Array,
        precondition: Callable[[Array], Array],
        total: float | None,
        level: float | None,
    ) -> None:
        self.product, self.precondition = product, precondition
        self.material: BoolArray = ~np.isnan(gap)
        self.h = np.where(self.material, gap, 0.0)
        self.lowest = float(self.h[self.material].min())
        self.total, self.level = total, level
        self.krylov = self.products = 0

    def run(self, p: Array, tolerance: float, max_iterations: int) -> PivotSolution:
        active: BoolArray = p > 0
        if not active.any():
            active = self.material & (self.h == self.lowest)
        if self.total is not None and p.any():
            p *= self.total / p.sum()
        level = self.lowest if self.level is None else self.level
        # While cells still change sides, few digits are enough.
        accuracy = max(_ROUGH, tolerance)
        p, u, level = self._solve_on(active, p, level, accuracy)
        fewest, patience = active.size + 1, _PATIENCE
        pivots = 0
        while True:
            separation = u + self.h - level
            scale = self._scale(level)
            pulled = active & (p < 0)
            entering = self.material & ~active & (separation < -0.5 * accuracy * scale)
            wrong = pulled | entering
            count = int(wrong.sum())
            if (count == 0 and accuracy <= tolerance) or pivots >= max_iterations:
                break
            accuracy = tolerance if count == 0 else max(0.1 * accuracy, tolerance)
            if count < fewest:
                fewest, patience = count, _PATIENCE
            elif patience > 0:
                patience -= 1
            else:
                # One cell, always by the same order of cells: that cannot cycle.
                wrong = np.zeros_like(wrong)
                wrong.flat[int(np.flatnonzero(pulled | entering)[-1])] = True
            active = active ^ wrong
            if self.total is not None and not active.any():
                active = self.material & (self.h == self.lowest)
            p, u, level = self._solve_on(active, p, level, accuracy)
            pivots += 1
        p = np.maximum(p, 0.0)
        if self.total is not None and p.any():
            p *= self.total / p.sum()
        u = self._multiply(p)
        separation = u + self.h - level
        residual = self._violation(separation, p > 0) / self._scale(level)
        return PivotSolution(p, u, level, residual, pivots, self.krylov, self.products, residual <= tolerance)

    def _solve_on(self, active: BoolArray, p: Array, level: float, accuracy: float) -> tuple[Array, Array, float]:
        """Pressure with A p - level = -h on the active cells and Σ p = total; A p and the level."""
        cells = np.flatnonzero(active)
        p = np.where(active, p, 0.0)
        if cells.size == 0:
            return p, np.zeros_like(p), level
        bordered = self.total is not None
        ones = self._masked(np.ones_like(p), active) if bordered else np.zeros_like(p)
        unit = float(ones.sum())

        def apply(v: Array) -> Array:
            field = np.zeros_like(p)
            field.flat[cells] = v[: cells.size]
            image = self._multiply(field).flat[cells]
            return np.append(image - v[-1], field.sum() / unit) if bordered else image

        def invert(v: Array) -> Array:
            field = np.zeros_like(p)
            field.flat[cells] = v[: cells.size]
            z = self._masked(field, active)
            if not bordered:
                return np.asarray(z.flat[cells])
            # Level and pressure that balance the load, through the same approximate inverse.
            shift = v[-1] - float(z.sum()) / unit
            return np.append((z + shift * ones).flat[cells], shift)

        u = self._multiply(p)
        # A few corrections: a fresh product shows what a solve leaves behind.
        for _ in range(_KRYLOV_RESTARTS):
            if bordered:
                level = float((u + self.h).flat[cells].mean())
            gap_left = -(u + self.h - level).flat[cells]
            rhs = np.append(gap_left, (self.total - p.sum()) / unit) if self.total is not None else gap_left
            goal = _INNER * accuracy * self._scale(level)
            size = float(np.abs(rhs).max())
            if size <= goal:
                break
            step = self._gmres(apply, invert, rhs, max(goal / size, _GAIN))
            p.flat[cells] += step[: cells.size]
            level += float(step[-1]) if bordered else 0.0
            u = self._multiply(p)
        if bordered:
            level = float((u + self.h).flat[cells].mean())
        return p, u, level

    def _gmres(
        self, apply: Callable[[Array], Array], invert: Callable[[Array], Array], rhs: Array, rtol: float
    ) -> Array:
        """Solution of the equations on the active cells, preconditioned from the right."""
        shape = (rhs.size, rhs.size)
        operator = scipy.sparse.linalg.LinearOperator(shape, matvec=lambda v: apply(invert(v)), dtype=float)
        before = self.products
        with np.errstate(divide="ignore", invalid="ignore"):
            solution = scipy.sparse.linalg.gmres(operator, rhs, rtol=rtol, restart=_KRYLOV_MEMORY, maxiter=1)[0]
        self.krylov += self.products - before
        return invert(solution) if np.isfinite(solution).all() else np.zeros_like(rhs)

    def _multiply(self, p: Array) -> Array:
        self.products += 1
        return self.product(p)

    def _masked(self, field: Array, active: BoolArray) -> Array:
        return np.where(active, self.precondition(field), 0.0)

    def _scale(self, level: float) -> float:
        return max(abs(level - self.lowest), np.finfo(float).tiny)

    def _violation(self, separation: Array, active: BoolArray) -> float:
        inside = float(np.abs(separation[active]).max(initial=0.0))
        outside = float(-separation[self.material & ~active].min(initial=0.0))
        return max(inside, outside)
