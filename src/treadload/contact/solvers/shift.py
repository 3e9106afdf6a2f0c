"""A shift: two bodies pressed together, then moved along each other by a small distance, without rolling.

Every cell slips by  s = w + u,  the rigid shift plus the displacement difference that shear makes. Shear q
acts on body 1, as in `contact.solvers.rolling`.
"""

from __future__ import annotations

from treadload.contact.bodies.influence import Influence
from treadload.contact.solvers.tangential import Axes, Forces, TangentialSolution, solve_tangential
from treadload.kernels.arrays import Array


def solve_shift(
    influence: Influence,
    bound: Array,
    rigid: Array,
    forces: Forces,
    *,
    axes: Axes = (1.0, 1.0),
    start: TangentialSolution | None = None,
    tolerance: float = 1e-6,
) -> TangentialSolution:
    """Shear, slip and shift of two bodies moved along each other in one step.

    bound: μp (ny, nx) ≥ 0, Pa. rigid: known shift (2, ny, nx), m, positive when body 1 moves along the axis.
    forces: on body 1 (Q_x, Q_y), N; None where the shift is known (and in `rigid`).
    axes: (d_x, d_y) of the friction ellipse, of product 1 (`contact.friction.laws`).
    start: a solution near this one, on the same grid; left out, the solution on half the grid serves.
    Returns shear on body 1, slip, the unknown shift (m, zero where known), stick.
    Raises ConvergenceError with the residual reached.
    Method: Kalker (1990), section 1.6 (Cattaneo shift), by the solver of `kernels.complementarity.coulomb`.
    """
    return solve_tangential(influence, bound, rigid, forces, rolls=False, axes=axes, start=start, tolerance=tolerance)
