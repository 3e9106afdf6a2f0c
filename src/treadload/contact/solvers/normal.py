"""Normal contact: the pressure that carries the load."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from treadload.contact.bodies.influence import Influence
from treadload.contact.solvers.levels import double, halve
from treadload.errors import ConvergenceError, GeometryError
from treadload.kernels import fft
from treadload.kernels.arrays import Array
from treadload.kernels.complementarity import active_set, projected_cg

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
    if np.isnan(gap).all():
        raise GeometryError("no cell of the height map has material: the contact has nothing to press with")
    if start is None:
        start = _start(influence, gap, load, approach)
    symbol = influence.normal_stiffness

    def precondition(residual: Array) -> Array:
        inverse: Array = fft.irfft2(symbol * fft.rfft2(residual), s=influence.shape)
        return inverse

    cell = influence.dx * influence.dy
    solve = projected_cg.solve if influence.symmetric else active_set.solve
    solution = solve(
        influence.normal,
        gap,
        start,
        total=None if load is None else load / cell,
        level=approach,
        precondition=precondition,
        tolerance=tolerance,
    )
    if not solution.converged:
        raise ConvergenceError(
            f"normal contact stopped after {solution.iterations} iterations with a residual of "
            f"{solution.residual:.2e}, above the tolerance of {tolerance:.2e}; raise the tolerance or "
            "smooth the height map",
            solution.residual,
        )
    return NormalSolution(
        solution.pressure,
        gap + solution.compliance - solution.level,
        solution.level,
        solution.residual,
        solution.iterations,
        solution.products,
    )


def _start(influence: Influence, gap: Array, load: float | None, approach: float | None) -> Array:
    """Pressure of the solution on half the grid, repeated; on the coarsest, of a first guess."""
    if min(influence.shape) < _COARSEST:
        # Where a rigid tread sinks to the depth that half of all cells reach, it surely touches.
        return np.where(gap <= np.nanmedian(gap), 1.0, 0.0)
    coarse_gap = halve(gap)
    coarse = replace(influence, shape=coarse_gap.shape, dx=2 * influence.dx, dy=2 * influence.dy)
    solution = solve_normal(coarse, coarse_gap, load=load, approach=approach, tolerance=_START_TOLERANCE)
    return double(solution.pressure, influence.shape)
