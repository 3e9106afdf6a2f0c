"""Steady rolling: the shear between tire and road, where it sticks and where it slips.

A particle enters the patch at its leading edge (large x) and travels to the trailing edge. Over a step of
one cell the two surfaces slip by  s = w dx + u(x) - u(x + dx),  with the rigid slip
w_x = ξ - φ y  and  w_y = η + φ x  (Kalker 1990, section 1.5). Shear q acts on the tire here; results turn
it round, to the shear on the road.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from treadload.contact.bodies.influence import Influence
from treadload.contact.solvers.tangential import Axes, Forces, TangentialSolution, solve_tangential
from treadload.kernels.arrays import Array

# Where, between x and x + dx, the rigid slip of spin is taken; CONTACT uses the same sixth of a cell.
_SPIN_POINT = 1 / 6


def rigid_slip(x: Array, y: Array, dx: float, creepages: tuple[float, float], spin: float) -> Array:
    """Rigid slip w (2, ny, nx) of creepages (ξ, η) and spin, rad/m, at cell centres x (nx,), y (ny,), m."""
    w = np.empty((2, y.size, x.size))
    w[0] = creepages[0] - spin * y[:, None]
    w[1] = creepages[1] + spin * (x + _SPIN_POINT * dx)[None, :]
    return w


def solve_rolling(
    influence: Influence,
    bound: Array,
    rigid: Array,
    forces: Forces,
    *,
    axes: Axes = (1.0, 1.0),
    start: TangentialSolution | None = None,
    tolerance: float = 1e-6,
) -> TangentialSolution:
    """Shear, slip and creepages of steady rolling under a known pressure.

    bound: μp (ny, nx) ≥ 0, Pa. rigid: known rigid slip (2, ny, nx), with that of dissimilar bodies.
    forces: of the road on the tire (Q_x, Q_y), N; None where the creepage is known (and in `rigid`).
    axes: (d_x, d_y) of the friction ellipse, of product 1 (`contact.friction.laws`).
    start: a solution near this one, on the same grid; left out, the solution on half the grid serves.
    Returns shear on the tire, slip velocity of the tire relative to the road over speed, the unknown creepages
    (zero where known), stick. Raises ConvergenceError with the residual reached.
    Method: Kalker (1990), by the solver of `kernels.complementarity.coulomb`.
    """
    dx = influence.dx
    solution = solve_tangential(
        influence, bound, rigid * dx, forces, rolls=True, axes=axes, start=start, tolerance=tolerance
    )
    return replace(solution, slip=solution.slip / dx)
