"""Bound-constrained conjugate gradients for contact: minimise ½ p·A p + p·h subject to p ≥ 0.

Either the sum of p is prescribed or the multiplier of that constraint, the approach.

Two loops. The outer one holds pressure and displacement in double precision on all cells, judges the conditions by a
fresh product and looks where the contact lies. The inner one corrects them, in single precision where it may: some
steps of conjugate gradients while no cell changes sides, then those that pull leave and those that penetrate enter.
Both are written in the array API standard alone, see `kernels.fft`.

Sources: Polonsky & Keer (1999), Wear 231, 206-219; Vollebregt (2014), J. Comput. Phys. 257, 333-351; Hintermüller,
Ito & Kunisch (2002), SIAM J. Optim. 13, 865-888 (sets of cells that change together).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import ModuleType

import numpy as np
from numpy.typing import DTypeLike

from treadload.kernels import fft
from treadload.kernels.arrays import Array, BoolArray

Product = Callable[[Array], Array]
Window = Callable[[tuple[int, int], bool], tuple[Product, Product]]

# Steps between two exchanges of cells: until the residual is this part of what it was, at most so many.
_GAIN, _STEPS = 0.3, 8
# Exchanges that bring the conditions no closer, before cells may leave and enter after every step.
_PATIENCE = 5
# The inner loop aims a little below the tolerance, but gains no more than single precision holds.
_AIM, _DIGITS = 0.9, 1e-5
# A round in single precision that leaves more of the residual than this was its last.
_PROGRESS = 0.5
# What the clipped pressure does to the gap is made good when it may reach this part of the residual.
_DRIFT = 0.1
# Cells around the contact that the inner loop sees, for it to grow into.
_MARGIN = 4


@dataclass(frozen=True)
class BoundSolution:
    """Solution of the bound-constrained problem.

    pressure: (ny, nx) ≥ 0. compliance: A p (ny, nx). level: the approach. residual: largest violation of
    gap = 0 where p > 0 and of gap ≥ 0 elsewhere, relative to the level, by a product in full precision.
    iterations: of conjugate gradients. products: with A, of both loops. converged: residual ≤ tolerance.
    """

    pressure: Array
    compliance: Array
    level: float
    residual: float
    iterations: int
    products: int
    converged: bool


def solve(
    product: Product,
    gap: Array,
    start: Array,
    *,
    total: float | None = None,
    level: float | None = None,
    precondition: Product | None = None,
    single_product: Product | None = None,
    window: Window | None = None,
    self_influence: float = float("inf"),
    tolerance: float = 1e-6,
    max_iterations: int = 300,
) -> BoundSolution:
    """Find p ≥ 0 with gap = h + A p - level ≥ 0 and p·gap = 0.

    product: A, symmetric and positive definite. gap: h (ny, nx), NaN where no pressure can act.
    start: p ≥ 0 (ny, nx) to begin with. total: prescribed sum of p; or level: prescribed approach.
    precondition: an approximate inverse of A. single_product: A in single precision, for the inner loop; left out, it
    runs in double precision. window: in place of both, for operators that are the same everywhere:
    A and the inverse on a part of (ny, nx) cells, in single precision if True. self_influence: diagonal of A; where
    it is left out, clipped pressure is made good at once.
    Cells that penetrate enter without a restart, and the search direction stays conjugate by
    Polak and Ribière. Returns the solution, converged or not.
    """
    if (total is None) == (level is None):
        raise ValueError("give either total or level")
    if (precondition is None) == (window is None):
        raise ValueError("give either precondition or window")
    xp = fft.namespace(gap)
    material = ~xp.isnan(gap)
    zero = xp.zeros_like(gap)
    h = xp.where(material, gap, zero)
    lowest = _least(xp, gap, material)
    p = xp.where(material, start, zero)
    if total is not None:
        if not bool(xp.any(p > 0)):
            p = xp.where(material & (h == lowest), zero + 1, zero)
        p *= total / float(xp.sum(p))
    counts = _Counts(max_iterations)
    part = slice(0, p.shape[0]), slice(0, p.shape[1])
    single, last = window is not None or single_product is not None, float("inf")
    while True:
        u = product(p)
        counts.products += 1
        active = p > 0
        separation = u + h
        if total is not None:
            level = _mean(xp, separation, active)
        assert level is not None
        separation -= level
        scale = max(abs(level - lowest), float(np.finfo(float).tiny))
        residual = _violation(xp, separation, active, material) / scale
        before = counts.iterations
        if residual <= tolerance or before >= max_iterations:
            break
        single = single and residual <= _PROGRESS * last
        last = residual
        goal = max(_AIM * tolerance, _DIGITS * residual if single else 0.0) * scale
        if precondition is not None:
            operators = (product if single_product is None or not single else single_product), precondition
        if window is not None:
            part = _bounding_box(xp, active | (material & (separation < 0)))
            operators = window((_length(part[0]), _length(part[1])), single)
        real = xp.float32 if single else gap.dtype
        inner = _Inner(*operators, h[part], material[part], total, level, goal, self_influence, real, counts)
        p[part] = inner.run(p[part], u[part])
        if counts.iterations == before and not single:
            # One active cell under a given total: nothing can move until another cell enters.
            break
    return BoundSolution(p, u, level, residual, counts.iterations, counts.products, residual <= tolerance)


@dataclass
class _Counts:
    """Iterations, how many there may be, and products."""

    most: int
    iterations: int = 0
    products: int = 0


@dataclass
class _Inner:
    """Corrections of the pressure on a part of the cells, in the precision of the product.

    h, material: (ny, nx) of the part. total: of all p, all of which lies here. goal: of the violation, m.
    real: the precision.
    """

    product: Product
    precondition: Product
    h: Array
    material: BoolArray
    total: float | None
    level: float
    goal: float
    self_influence: float
    real: DTypeLike
    counts: _Counts

    @property
    def xp(self) -> ModuleType:
        """The functions of the arrays' library."""
        return fft.namespace(self.h)

    def run(self, p: Array, u: Array) -> Array:
        """Pressure (ny, nx) whose conditions hold to the goal, from a pressure and the displacement A p."""
        xp, counts = self.xp, self.counts
        room = xp.asarray(self.material, dtype=self.real)
        active = p > 0
        nothing = xp.zeros_like(room)
        search = _Search(nothing, nothing, 0.0)
        clipped = nothing
        best, patience = np.inf, _PATIENCE
        while True:
            mask = xp.asarray(active, dtype=self.real)
            # What is left is small beside the numbers that it is the difference of.
            separation = xp.asarray(u + self.h - self.level, dtype=self.real)
            if self.total is not None:
                shift = _dot(xp, separation, mask) / float(xp.sum(mask))
                separation -= shift
                self.level += shift
            separation *= room
            lowest = float(xp.min(separation))
            violation = max(float(xp.max(separation * mask)), -lowest)
            patience = _PATIENCE if violation < best else patience - 1
            best = min(best, violation)
            if violation <= self.goal or counts.iterations >= counts.most:
                return p
            if lowest < 0:
                active = active | (separation < 0)
                mask = xp.asarray(active, dtype=self.real)
            gained, opened, residual = self._steps(mask, separation, search, 1 if patience < 0 else _STEPS)
            if gained is None:
                return p
            p = p + gained
            u = u + opened
            pulled = p < 0
            if bool(xp.any(pulled)):
                lost = xp.where(pulled, p, xp.zeros_like(p))
                p -= lost
                active = active & ~pulled
                search.direction = xp.where(pulled, nothing, search.direction)
                clipped = clipped - xp.asarray(lost, dtype=self.real)
            if self.total is not None:
                factor = self.total / float(xp.sum(p))
                p *= factor
                u *= factor
                clipped = clipped * factor
            if self._drift(clipped, p) > max(_DRIFT * residual, 0.2 * self.goal):
                u += self.product(clipped)
                counts.products += 1
                clipped = nothing

    def _drift(self, clipped: Array, p: Array) -> float:
        """About the most that clipped pressure does to the gap: by a cell and its neighbours, by all from afar."""
        largest = float(self.xp.max(clipped))
        if largest == 0:
            return 0.0
        afar = abs(self.level) * float(self.xp.sum(clipped)) / max(float(self.xp.sum(p)), largest)
        return 3 * self.self_influence * largest + afar

    def _steps(self, mask: Array, separation: Array, search: _Search, most: int) -> tuple[Array | None, Array, float]:
        """Conjugate gradients on the active cells: what p and A p gain, None of nothing, and the residual left."""
        xp, counts = self.xp, self.counts
        cells = float(xp.sum(mask))
        balanced = self.total is not None

        def centred(v: Array) -> Array:
            return v - (float(xp.sum(v)) / cells) * mask if balanced else v

        r = centred(separation * -mask)
        first = left = _largest(xp, r)
        gained, opened = xp.zeros_like(r), xp.zeros_like(r)
        # The last direction goes on without the cells that left.
        d = centred(search.direction * mask)
        steps = 0
        while steps < most and counts.iterations < counts.most:
            z = centred(self.precondition(r) * mask)
            energy = _dot(xp, z, r)
            if energy <= 0:
                # Nothing can move, or round-off is all that is left.
                break
            beta = 0.0
            if search.energy > 0:
                beta = max(0.0, (energy - _dot(xp, z, search.residual)) / search.energy)
            d = z + beta * d if beta > 0 else z
            response = self.product(d)
            counts.products += 1
            curvature = _dot(xp, d, response)
            if curvature <= 0:
                break
            step = (energy if steps else _dot(xp, d, r)) / curvature
            search.direction, search.residual, search.energy = d, r, energy
            gained += step * d
            opened += step * response
            counts.iterations += 1
            steps += 1
            response *= mask
            r = centred(r - step * response)
            left = _largest(xp, r)
            if left <= max(_GAIN * first, self.goal):
                break
        return (gained if steps else None), opened, left


@dataclass
class _Search:
    """What conjugate gradients remember of their last step."""

    direction: Array
    residual: Array
    energy: float


def _dot(xp: ModuleType, first: Array, second: Array) -> float:
    return float(xp.tensordot(first, second, axes=2))


def _largest(xp: ModuleType, v: Array) -> float:
    return max(float(xp.max(v)), -float(xp.min(v)))


def _mean(xp: ModuleType, v: Array, mask: BoolArray) -> float:
    chosen = xp.asarray(mask, dtype=v.dtype)
    return float(xp.sum(v * chosen)) / float(xp.sum(chosen))


def _least(xp: ModuleType, v: Array, mask: BoolArray) -> float:
    """The smallest of the masked numbers; infinity of none."""
    return float(xp.min(xp.where(mask, v, xp.full_like(v, xp.inf))))


def _violation(xp: ModuleType, separation: Array, active: BoolArray, material: BoolArray) -> float:
    nothing = xp.zeros_like(separation)
    outside = -float(xp.min(xp.where(material, separation, nothing)))
    inside = float(xp.max(xp.where(active, separation, nothing)))
    return max(inside, outside, 0.0)


def _bounding_box(xp: ModuleType, mask: BoolArray) -> tuple[slice, slice]:
    """Slices around the masked cells, with a margin and of lengths that are fast to transform."""
    rows, columns = (_stretch(fft.to_host(xp.any(mask, axis=axis))) for axis in (1, 0))
    return rows, columns


def _stretch(line: BoolArray) -> slice:
    cells = np.flatnonzero(line)
    first, after = max(0, int(cells[0]) - _MARGIN), min(line.size, int(cells[-1]) + 1 + _MARGIN)
    length = min(line.size, int(fft.next_fast_len(after - first, real=True)))
    first = min(first, line.size - length)
    return slice(first, first + length)


def _length(part: slice) -> int:
    return int(part.stop - part.start)
