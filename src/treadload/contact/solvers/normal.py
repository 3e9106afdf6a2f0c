"""Normal contact: the pressure that carries the load."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from treadload.contact.bodies.influence import Influence, operators
from treadload.contact.solvers.levels import halve, refine
from treadload.errors import ConvergenceError, GeometryError, InputError
from treadload.kernels import fft
from treadload.kernels.arrays import Array, ComplexArray
from treadload.kernels.complementarity import active_set, projected_cg
from treadload.kernels.complementarity.active_set import PivotSolution
from treadload.kernels.complementarity.projected_cg import BoundSolution

Operator = Callable[[Array], Array]

# Below this many cells a side a solve costs nothing and needs no start from a coarser one.
_COARSEST = 24
_START_TOLERANCE = 1e-3


@dataclass(frozen=True)
class NormalSolution:
    """Result of normal contact.

    pressure: (ny, nx) ≥ 0, Pa. gap: (ny, nx) after loading, m, NaN where there is no material.
    approach: m. residual: largest violation of the contact conditions over the approach.
    iterations: of conjugate gradients on this grid. products: convolutions on this grid.
    """

    pressure: Array
    gap: Array
    approach: float
    residual: float
    iterations: int
    products: int

    def under(self, gap: Array, change: Array | float, *, loaded: bool) -> NormalSolution:
        """The same pressure under another gap, with the residual that it has there.

        gap: (ny, nx) before loading, m. change: (ny, nx), by which it differs from the one solved for, m.
        loaded: True where the load is known and the approach follows, False where the approach is known.
        """
        after = self.gap + change
        pressed = self.pressure > 0
        shift = float(after[pressed].mean()) if loaded else 0.0
        after -= shift
        scale = max(abs(self.approach + shift - float(np.nanmin(gap))), np.finfo(float).tiny)
        apart = max(float(np.abs(after[pressed]).max(initial=0.0)), -float(np.nanmin(after)))
        return replace(self, gap=after, approach=self.approach + shift, residual=apart / scale)


def solve_normal(
    influence: Influence,
    gap: Array,
    *,
    load: float | None = None,
    approach: float | None = None,
    start: Array | None = None,
    tolerance: float = 1e-6,
) -> NormalSolution:
    """Pressure of frictionless contact under a given load or approach.

    Minimises  ½ p·A p + p·gap  subject to  p ≥ 0  and  Σ p dA = load.
    gap: (ny, nx) before loading, m, NaN where there is no material. load: N, or approach: m.
    start: pressure (ny, nx), Pa, near the solution; left out, the solution on half the grid serves.
    Returns the pressure, the gap after loading and the approach.
    Raises ConvergenceError with the residual reached, GeometryError if there is no material at all.
    Method: Polonsky & Keer (1999), preconditioned in Fourier space (Vollebregt 2014).
    """
    if not influence.material.all():
        gap = np.where(influence.material[:, None], gap, np.nan)
    if np.isnan(gap).all():
        raise GeometryError("no cell of the height map has material: the contact has nothing to press with")
    if start is None:
        start = _start(influence, gap, load, approach)
    solution = _solve(influence, gap, load, approach, start, tolerance)
    return NormalSolution(
        solution.pressure,
        gap + solution.compliance - solution.level,
        solution.level,
        solution.residual,
        solution.iterations,
        solution.products,
    )


def _solve(
    influence: Influence, gap: Array, load: float | None, approach: float | None, start: Array, tolerance: float
) -> BoundSolution | PivotSolution:
    total = None if load is None else load / (influence.dx * influence.dy)
    solution: BoundSolution | PivotSolution
    if influence.symmetric:
        solution = _by_gradients(influence, gap, total, approach, start, tolerance)
    else:
        inverse = _by_strips(influence)
        solution = active_set.solve(
            influence.normal,
            gap,
            start,
            total=total,
            level=approach,
            precondition=_inverse(influence.normal_stiffness, influence.shape) if inverse is None else inverse,
            tolerance=tolerance,
        )
    if not solution.converged:
        raise ConvergenceError(
            f"normal contact stopped after {solution.iterations} iterations with a residual of "
            f"{solution.residual:.2e}, above the tolerance of {tolerance:.2e}; raise the tolerance or "
            "smooth the height map",
            solution.residual,
        )
    return solution


def _by_gradients(
    influence: Influence, gap: Array, total: float | None, approach: float | None, start: Array, tolerance: float
) -> BoundSolution:
    """The solution of a symmetric pair, found on the device of the kernels; of strips on the processor."""
    inverse = _by_strips(influence)
    if inverse is not None:
        return projected_cg.solve(
            influence.normal,
            gap,
            start,
            total=total,
            level=approach,
            precondition=inverse,
            single_product=influence.normal_single if influence.has_strips else None,
            self_influence=influence.normal_self_influence,
            tolerance=tolerance,
        )
    try:
        fft.device()
    except ValueError as why:
        raise InputError(str(why)) from why

    def window(shape: tuple[int, int], single: bool) -> tuple[Operator, Operator]:
        real = np.float32 if single else float
        product = influence.normal_on(shape, real)
        periodic = (int(fft.next_fast_len(shape[0])), int(fft.next_fast_len(shape[1], real=True)))
        symbol = fft.to_device(influence.normal_stiffness_on(periodic, real))
        return replace(product, spectrum=fft.to_device(product.spectrum)), _inverse(symbol, periodic)

    # A start needs no more than single precision.
    real = np.float32 if tolerance >= _START_TOLERANCE else float
    product = influence.convolved_normal if real is float else influence.normal_on(influence.shape, real)
    solution = projected_cg.solve(
        replace(product, spectrum=fft.to_device(product.spectrum)),
        fft.to_device(gap.astype(real)),
        fft.to_device(start.astype(real)),
        total=total,
        level=approach,
        window=window,
        self_influence=influence.normal_self_influence,
        tolerance=tolerance,
    )
    return replace(solution, pressure=fft.to_host(solution.pressure), compliance=fft.to_host(solution.compliance))


def _by_strips(influence: Influence) -> Operator | None:
    """About the inverse of normal compliance by the strips of a pair; None of a pair without."""
    inverse = influence.strip_inverse((2,))
    return None if inverse is None else lambda residual: inverse(residual[None])[0]


def _inverse(symbol: Array | ComplexArray, periodic: tuple[int, int]) -> Operator:
    """The convolution with a symbol on periodic cells (ny, nx), of which a residual is a part."""

    def apply(residual: Array) -> Array:
        ny, nx = residual.shape
        transformed = fft.rfft2(residual, s=periodic)
        transformed *= symbol
        inverse: Array = fft.irfft2(transformed, s=periodic)[:ny, :nx]
        return inverse

    return apply


def _start(influence: Influence, gap: Array, load: float | None, approach: float | None) -> Array:
    """Pressure where the solution on half the grid makes contact likely; on the coarsest, a first guess."""
    if min(influence.shape) < _COARSEST or influence.has_blocks:
        # Where a rigid tread sinks to the depth that half of all cells reach, it surely touches.
        return np.where(gap <= np.nanmedian(gap), 1.0, 0.0)
    coarse_gap = halve(gap)
    coarse = operators(coarse_gap.shape, 2 * influence.dx, 2 * influence.dy, influence.pair)
    start = _start(coarse, coarse_gap, load, approach)
    rough = _solve(coarse, coarse_gap, load, approach, start, _START_TOLERANCE)
    # Displacement is smooth, so that the fine gap is nearly known: what its cell would not push open is in contact.
    pressure = refine(rough.pressure, influence.shape)
    separation = gap + refine(rough.compliance, influence.shape) - rough.level
    return np.where(pressure * influence.normal_self_influence > separation, pressure, 0.0)
