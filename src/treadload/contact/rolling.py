"""Steady rolling: the shear between tire and road, where it sticks and where it slips.

A particle enters the patch at its leading edge (large x) and travels to the trailing edge. Over a step of
one cell the two surfaces slip by  s = w dx + u(x) - u(x + dx),  with the rigid slip
w_x = ξ - φ y  and  w_y = η + φ x  (Kalker 1990, section 1.5). Shear q acts on the tire here; results turn
it round, to the shear on the road.
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
from treadload.kernels.coulomb import CoulombProblem, CoulombSolution

_COARSEST = 24
_START_TOLERANCE = 1e-3
# Where, between x and x + dx, the rigid slip of spin is taken; CONTACT uses the same sixth of a cell.
_SPIN_POINT = 1 / 6


@dataclass(frozen=True)
class RollingSolution:
    """Result of steady rolling.

    shear: on the tire (2, ny, nx), Pa. slip: of the tire relative to the road over speed (2, ny, nx).
    creepage: (ξ, η). stick: (ny, nx), True where |q| < μp. residual: natural residual of the inequality.
    newton, krylov, splitting, products: iterations and products with the slip operator, on this grid.
    """

    shear: Array
    slip: Array
    creepage: tuple[float, float]
    stick: BoolArray
    residual: float
    newton: int
    krylov: int
    splitting: int
    products: int


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
    forces: tuple[float | None, float | None],
    *,
    start: RollingSolution | None = None,
    tolerance: float = 1e-6,
) -> RollingSolution:
    """Shear, slip and creepages of steady rolling under a known pressure.

    bound: μp (ny, nx) ≥ 0, Pa. rigid: known rigid slip (2, ny, nx), with that of dissimilar bodies.
    forces: of the road on the tire (Q_x, Q_y), N; None where the creepage is known (and in `rigid`).
    start: a solution near this one, on the same grid; left out, the solution on half the grid serves.
    Returns shear on the tire, slip, creepages found (zero where known), stick.
    Raises ConvergenceError with the residual reached.
    """
    box = _bounding_box(bound > 0)
    if box is None:
        return _without_friction(bound, rigid)
    rows, columns = box
    shape = (rows.stop - rows.start, columns.stop - columns.start)
    small = replace(influence, shape=shape)
    first = None
    if start is not None:
        first = start.shear[:, rows, columns], np.asarray(start.creepage)
    elif min(shape) >= _COARSEST:
        coarse = _solve_coarse(small, bound[rows, columns], rigid[:, rows, columns], forces)
        first = double(coarse.shear, shape), np.asarray(coarse.creepage)
    problem = _problem(small, bound[rows, columns], rigid[:, rows, columns], forces)
    if first is None:
        first = _carry_forces(problem), np.zeros(2)
    solution = coulomb.solve(problem, *first, tolerance=tolerance)
    if not solution.converged:
        # The fast path stalled: the slow one always moves on.
        slow = coulomb.solve_by_splitting(problem, solution.shear, tolerance=tolerance)
        solution = slow if slow.residual < solution.residual else solution
    if not solution.converged:
        raise ConvergenceError(
            f"rolling contact stopped with a residual of {solution.residual:.2e}, above the tolerance of "
            f"{tolerance:.2e}; near gross sliding prescribe the creepage instead of the force",
            solution.residual,
        )
    return _uncrop(solution, bound, rigid, influence.dx, box)


def _problem(
    influence: Influence, bound: Array, rigid: Array, forces: tuple[float | None, float | None]
) -> CoulombProblem:
    cell = influence.dx * influence.dy
    return CoulombProblem(
        padding=influence.padding,
        operator=influence.rolling,
        self_influence=influence.rolling_self_influence,
        bound=bound,
        rigid=rigid * influence.dx,
        travel=influence.dx,
        totals=tuple(None if q is None else q / cell for q in forces),  # type: ignore[arg-type]
        precondition=_Preconditioner(influence),
    )


class _Preconditioner:
    """Approximate inverse of S on the cells of a mask: inverse compliance, then a cumulative sum.

    With q summed up from increments at the leading edge, S acts as the compliance itself, whose inverse is
    G|k|/2 (1 + ν/(1-ν) k kᵀ/k²) in Fourier space. On the unpadded, periodic grid: a quarter of the work.
    Source: Vollebregt (2010); Johnson (1985), section 3.
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
        increments = fft.irfft2(q, s=self.shape) * mask
        total: Array = np.cumsum(increments[:, :, ::-1], axis=2)[:, :, ::-1] * mask
        return total


def _carry_forces(problem: CoulombProblem) -> Array:
    """Shear in proportion to its bound that carries the prescribed forces."""
    capacity = problem.bound.sum()
    return np.stack([problem.bound * ((total or 0.0) / capacity) for total in problem.totals])


def _solve_coarse(
    influence: Influence, bound: Array, rigid: Array, forces: tuple[float | None, float | None]
) -> RollingSolution:
    coarse_bound = np.nan_to_num(halve(bound))
    # The border cells of an odd grid keep their share of the friction force, not their mean.
    coarse_bound *= bound.sum() / (4 * coarse_bound.sum())
    coarse = replace(influence, shape=coarse_bound.shape, dx=2 * influence.dx, dy=2 * influence.dy)
    return solve_rolling(coarse, coarse_bound, np.nan_to_num(halve(rigid)), forces, tolerance=_START_TOLERANCE)


def _without_friction(bound: Array, rigid: Array) -> RollingSolution:
    """No cell can carry shear: the bodies slide freely at the known rigid slip."""
    return RollingSolution(
        np.zeros((2, *bound.shape)), rigid.copy(), (0.0, 0.0), np.zeros(bound.shape, bool), 0.0, 0, 0, 0, 0
    )


def _bounding_box(mask: BoolArray) -> tuple[slice, slice] | None:
    rows, columns = np.flatnonzero(mask.any(1)), np.flatnonzero(mask.any(0))
    if rows.size == 0:
        return None
    return slice(int(rows[0]), int(rows[-1]) + 1), slice(int(columns[0]), int(columns[-1]) + 1)


def _uncrop(
    solution: CoulombSolution, bound: Array, rigid: Array, dx: float, box: tuple[slice, slice]
) -> RollingSolution:
    rows, columns = box
    shear, slip = np.zeros((2, *bound.shape)), np.zeros((2, *bound.shape))
    stick = np.zeros(bound.shape, bool)
    shear[:, rows, columns] = solution.shear
    stick[rows, columns] = solution.stick
    # Slip is zero by definition where the patch sticks, and means nothing outside of it.
    slip[:, rows, columns] = np.where((bound[rows, columns] > 0) & ~solution.stick, solution.slip / dx, 0.0)
    return RollingSolution(
        shear,
        slip,
        (float(solution.creepage[0]), float(solution.creepage[1])),
        stick,
        solution.residual,
        solution.newton,
        solution.krylov,
        solution.splitting,
        solution.products,
    )
