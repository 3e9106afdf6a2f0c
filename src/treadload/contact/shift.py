"""A shift: two bodies pressed together, then moved along each other by a small distance, without rolling.

Every cell slips by  s = w + u,  the rigid shift plus the displacement difference that shear makes. Shear q
acts on body 1, as in `contact.rolling`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy import fft

from treadload.contact.influence import Influence
from treadload.contact.levels import double, halve
from treadload.errors import ConvergenceError
from treadload.kernels import coulomb
from treadload.kernels.arrays import Array, BoolArray
from treadload.kernels.coulomb import CoulombProblem
from treadload.kernels.rectangle import tangential_by_shear

_COARSEST = 24
_START_TOLERANCE = 1e-3


@dataclass(frozen=True)
class ShiftSolution:
    """Result of a shift.

    shear: on body 1 (2, ny, nx), Pa. slip: of body 1 relative to body 2 (2, ny, nx), m, zero where it sticks.
    shift: (δx, δy) found, m, zero where known. stick: (ny, nx), True where |q| < bound. residual: natural
    residual of the inequality. newton, krylov, products: iterations and products on this grid.
    """

    shear: Array
    slip: Array
    shift: tuple[float, float]
    stick: BoolArray
    residual: float
    newton: int
    krylov: int
    products: int


def solve_shift(
    influence: Influence,
    bound: Array,
    rigid: Array,
    forces: tuple[float | None, float | None],
    *,
    start: ShiftSolution | None = None,
    tolerance: float = 1e-6,
) -> ShiftSolution:
    """Shear, slip and shift of two bodies moved along each other in one step.

    bound: μp (ny, nx) ≥ 0, Pa. rigid: known shift (2, ny, nx), m, positive when body 1 moves along the axis.
    forces: on body 1 (Q_x, Q_y), N; None where the shift is known (and in `rigid`).
    start: a solution near this one, on the same grid; left out, the solution on half the grid serves.
    Returns shear on body 1, slip, the shift found (zero where known), stick.
    Raises ConvergenceError with the residual reached.
    Method: Kalker (1990), section 1.6 (Cattaneo shift), by the solver of `kernels.coulomb`.
    """
    cell = influence.dx * influence.dy
    if not (bound > 0).any():
        return ShiftSolution(
            np.zeros_like(rigid), rigid.copy(), (0.0, 0.0), np.zeros(bound.shape, bool), 0.0, 0, 0, 0
        )
    if start is None and min(influence.shape) >= _COARSEST:
        start = _solve_coarse(influence, bound, rigid, forces)
    along, across = (None if force is None else force / cell for force in forces)
    problem = CoulombProblem(
        padding=influence.padding,
        operator=influence.tangential,
        self_influence=float(tangential_by_shear(1, 1, influence.dx, influence.dy, influence.bodies)[0][0, 0]),
        bound=bound,
        rigid=rigid,
        travel=1.0,
        totals=(along, across),
        precondition=_Stiffness(influence),
    )
    # Without shear every cell sticks, and the first step is that of full adhesion.
    first = (None, None) if start is None else (start.shear, np.asarray(start.shift))
    solution = coulomb.solve(problem, *first, tolerance=tolerance)
    if not solution.converged:
        raise ConvergenceError(
            f"the shift stopped with a residual of {solution.residual:.2e}, above the tolerance of "
            f"{tolerance:.2e}; near gross sliding prescribe the shift instead of the force",
            solution.residual,
        )
    slip = np.where((bound > 0) & ~solution.stick, solution.slip, 0.0)
    shift = float(solution.creepage[0]), float(solution.creepage[1])
    counts = solution.newton, solution.krylov, solution.products
    return ShiftSolution(solution.shear, slip, shift, solution.stick, solution.residual, *counts)


class _Stiffness:
    """Approximate inverse of the compliance on the cells of a mask: its inverse in Fourier space.

    G|k|/2 (1 + ν/(1-ν) k kᵀ/k²) on the unpadded, periodic grid. Source: Johnson (1985), section 3.
    """

    def __init__(self, influence: Influence) -> None:
        ny, nx = influence.shape
        kx = 2 * np.pi * fft.rfftfreq(nx, influence.dx)[None, :]
        ky = 2 * np.pi * fft.fftfreq(ny, influence.dy)[:, None]
        k = np.hypot(kx, ky)
        k[0, 0] = 1.0
        cosine, sine = kx / k, ky / k
        k[0, 0] = np.pi / max(nx * influence.dx, ny * influence.dy)
        stiffness = 0.5 * influence.bodies.shear_modulus * k
        ratio = influence.bodies.poisson / (1 - influence.bodies.poisson)
        self.shape = influence.shape
        self.xx = stiffness * (1 + ratio * cosine**2)
        self.yy = stiffness * (1 + ratio * sine**2)
        self.xy = stiffness * ratio * cosine * sine

    def __call__(self, slip: Array) -> Array:
        mask = (slip != 0).any(0)
        s = fft.rfft2(slip)
        q = np.stack([self.xx * s[0] + self.xy * s[1], self.xy * s[0] + self.yy * s[1]])
        shear: Array = fft.irfft2(q, s=self.shape) * mask
        return shear


def _solve_coarse(
    influence: Influence, bound: Array, rigid: Array, forces: tuple[float | None, float | None]
) -> ShiftSolution:
    """The solution on half the grid, with its shear on the cells of this one."""
    coarse_bound = np.nan_to_num(halve(bound))
    # The border cells of an odd grid keep their share of the friction force, not their mean.
    coarse_bound *= bound.sum() / (4 * coarse_bound.sum())
    coarse = replace(influence, shape=coarse_bound.shape, dx=2 * influence.dx, dy=2 * influence.dy)
    rough = solve_shift(coarse, coarse_bound, np.nan_to_num(halve(rigid)), forces, tolerance=_START_TOLERANCE)
    return replace(rough, shear=double(rough.shear, influence.shape))
