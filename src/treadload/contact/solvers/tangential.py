"""Shear between two bodies that roll or shift: the cells of the contact, coarse to fine, fast path and safe path."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from treadload.contact.bodies.influence import Influence, operators
from treadload.contact.solvers.levels import ALONG, BOTH, halve, halve_along, interpolate
from treadload.errors import ConvergenceError
from treadload.kernels import fft
from treadload.kernels.arrays import Array, BoolArray
from treadload.kernels.complementarity import coulomb_direct, coulomb_newton, coulomb_splitting
from treadload.kernels.complementarity.coulomb import CoulombProblem, paired
from treadload.kernels.complementarity.coulomb_newton import CoulombSolution
from treadload.kernels.gridding.strips import StripInverse

# Below this many cells a side a solve costs nothing and needs no start from a coarser one.
_COARSEST = 48
_START_TOLERANCE = 1e-3
# Share of friction from which on a force is what makes a solve hard.
_NEARLY_ALL = 0.9

Forces = tuple[float | None, float | None]
Axes = tuple[float, float]


@dataclass(frozen=True)
class TangentialSolution:
    """Result of a tangential contact problem.

    shear: on body 1 (2, ny, nx), Pa. slip: of body 1 relative to body 2 (2, ny, nx), zero where it sticks: in
    rolling the velocity over speed, in a shift the distance, m. rigid: creepages, or the shift in m, that were
    not known; zero where they were.
    stick: (ny, nx), True where |q| < bound. residual: natural residual of the inequality.
    newton, krylov, splitting, products: iterations and products with the slip operator, on this grid.
    """

    shear: Array
    slip: Array
    rigid: tuple[float, float]
    stick: BoolArray
    residual: float
    newton: int = 0
    krylov: int = 0
    splitting: int = 0
    products: int = 0


def solve_tangential(
    influence: Influence,
    bound: Array,
    rigid: Array,
    forces: Forces,
    *,
    rolls: bool,
    axes: Axes = (1.0, 1.0),
    start: TangentialSolution | None = None,
    tolerance: float = 1e-6,
) -> TangentialSolution:
    """Shear, slip and unknown rigid slips under a known friction bound.

    bound: μp (ny, nx) ≥ 0, Pa. axes: (d_x, d_y) > 0 of the friction ellipse (q_x/d_x)² + (q_y/d_y)² ≤ bound²,
    against whose normal the bodies slip; of product 1. rigid: known rigid slip over one step (2, ny, nx), m.
    forces: on body 1 (Q_x, Q_y), N; None where the rigid slip is known (and in `rigid`).
    rolls: a step takes particles one cell back, and they slip by w + u(x) - u(x + dx); else by w + u.
    start: a solution near this one, on the same grid; left out, the solution on half the grid serves.
    Raises ConvergenceError with the residual reached.
    """
    box = _bounding_box(bound > 0)
    if box is None:
        # No cell can carry shear: the bodies slide freely at the known rigid slip.
        return TangentialSolution(np.zeros_like(rigid), rigid.copy(), (0.0, 0.0), np.zeros(bound.shape, bool), 0.0)
    striped = influence.has_blocks
    if striped:
        # Groups of rows are known as wholes.
        box = slice(0, bound.shape[0]), slice(0, bound.shape[1])
    rows, columns = box
    g, w = bound[rows, columns], rigid[:, rows, columns]
    small = influence if striped else replace(influence, shape=g.shape)
    if start is not None:
        # A rigid slip that is known now is not an unknown, whatever it was in the start.
        unknown = [force is not None for force in forces]
        q, xi = start.shear[:, rows, columns], np.where(unknown, start.rigid, 0.0)
    elif (small.has_strips and g.shape[1] >= _COARSEST) or (not striped and min(g.shape) >= _COARSEST):
        q, xi = _start(small, g, w, forces, rolls, axes, max(_START_TOLERANCE, tolerance))
    else:
        # Without shear the cells stick, and the first step is that of full adhesion; a force that is known takes an
        # equal share of friction everywhere, so that the first steps need not look for it, nor for its rigid slip.
        total = float(g.sum()) * small.dx * small.dy
        used = np.array([0.0 if force is None else force / total for force in forces])
        q, xi = used[:, None, None] * g, None
    # Stretched by the axes, the ellipse is a disc: q = D q', and S, w and Q become D S D, D w and D⁻¹ Q.
    stretch = np.array(axes)[:, None, None]
    problem = _problem(small, g, stretch * w, forces, rolls, axes)
    solution = _solve(problem, q / stretch, None if xi is None else xi * axes, tolerance)
    solution = replace(
        solution, shear=stretch * solution.shear, slip=solution.slip / stretch, xi=solution.xi / np.array(axes)
    )
    return _uncrop(solution, bound, box)


def _solve(problem: CoulombProblem, q: Array, xi: Array | None, tolerance: float) -> CoulombSolution:
    solution = coulomb_newton.solve(problem, q, xi, tolerance=tolerance)
    if not solution.converged and (problem.bound > 0).sum() <= coulomb_direct.MOST_CELLS:
        near = coulomb_direct.solve(problem, solution.shear, solution.xi, tolerance=tolerance)
        solution = coulomb_newton.solve(problem, *near, tolerance=tolerance)
    # Where the fast path stalls, the slow one always moves on, and the fast one polishes what it finds: from where it
    # stalled, or from the start, where it has carried unknown rigid slips far away.
    for q_near, xi_near in ((solution.shear, solution.xi), (q, np.zeros(2) if xi is None else xi)):
        if solution.converged:
            return solution
        q_near, xi_near, steps = coulomb_splitting.split(problem, q_near, xi_near, tolerance=0.1 * tolerance)
        polished = coulomb_newton.solve(problem, q_near, xi_near, tolerance=tolerance)
        solution = replace(polished, splitting=polished.splitting + solution.splitting + steps)
    if not solution.converged:
        what, unknown = ("rolling contact", "creepage") if problem.rolls else ("the shift", "shift")
        used = math.hypot(*(total or 0.0 for total in problem.totals)) / float(problem.bound.sum())
        remedy = (
            f"the forces take {100 * used:.3g} % of friction: prescribe the {unknown} instead"
            if used > _NEARLY_ALL
            else "take smaller cells or raise the tolerance"
        )
        raise ConvergenceError(
            f"{what} stopped with a residual of {solution.residual:.2e}, above the tolerance of {tolerance:.2e}; "
            f"{remedy}",
            solution.residual,
        )
    return solution


def _problem(
    influence: Influence, bound: Array, rigid: Array, forces: Forces, rolls: bool, axes: Axes
) -> CoulombProblem:
    """The problem on the disc; rigid is stretched already, forces are those of the bodies."""
    cell = influence.dx * influence.dy
    padding = influence.rolling_padding if rolls else influence.padding
    symbols = influence.tangential(padding)
    compliance = symbols * _stretches(axes, len(symbols))
    inverse = influence.strip_inverse((0, 1))
    along, across = (None if force is None else force / (cell * d) for force, d in zip(forces, axes, strict=True))
    return CoulombProblem(
        padding=padding,
        # Columns lie side by side, as products walk through them.
        compliance=np.ascontiguousarray(compliance.transpose(0, 2, 1)).transpose(0, 2, 1),
        rolls=rolls,
        self_influence=influence.self_influence(rolls=rolls),
        bound=bound,
        rigid=rigid,
        travel=influence.dx if rolls else 1.0,
        totals=(along, across),
        precondition=_StripPreconditioner(inverse, rolls, axes)
        if inverse
        else _Preconditioner(influence, rolls, axes),
        strips=influence.strips(padding),
        axes=axes,
    )


def _stretches(axes: Axes, symbols: int = 3) -> Array:
    """Factors (symbols, 1, 1) that stretch the symbols xx, yy, xy and, if there are four, yx of a compliance."""
    d_x, d_y = axes
    return np.array([d_x * d_x, d_y * d_y, d_x * d_y, d_x * d_y])[:symbols, None, None]


class _Preconditioner:
    """Approximate inverse of the slip operator on the cells of a mask, in single precision.

    In a shift: the inverse compliance in Fourier space, on the unpadded grid, a quarter of the work. In
    rolling, shear summed up from increments at the leading edge turns the slip operator into the compliance:
    the same, then a cumulative sum. Source: Vollebregt (2010).
    """

    def __init__(self, influence: Influence, rolls: bool, axes: Axes) -> None:
        # On periodic cells of numbers that are fast to transform: near the patch, and near is enough.
        ny, nx = influence.shape
        self.shape = int(fft.next_fast_len(ny)), int(fft.next_fast_len(nx, real=True))
        symbols = influence.tangential_stiffness_on(self.shape) / _stretches(axes)
        turned = np.iscomplexobj(symbols)
        self.symbols = symbols.astype(np.complex64) if turned else paired(symbols.astype(np.float32))
        self.rolls = rolls

    def __call__(self, slip: Array, mask: BoolArray) -> Array:
        ny, nx = mask.shape
        waves = fft.rfft2(slip.astype(np.float32, copy=False), s=self.shape)
        (xx, yy, xy), (x, y) = self.symbols, waves.view(self.symbols.dtype)
        mixed = xy * y
        y *= yy
        y += xy * x
        x *= xx
        x += mixed
        shear: Array = fft.irfft2(waves, s=self.shape)[:, :ny]
        if not self.rolls:
            return shear[..., :nx] * mask
        shear[..., :nx] *= mask
        shear[..., nx:] = 0
        return _summed_ahead(shear)[..., :nx] * mask


@dataclass(frozen=True)
class _StripPreconditioner:
    """The same for surfaces with strips: the inverse of the compliance on rows that repeat, then a sum in rolling."""

    inverse: StripInverse
    rolls: bool
    axes: Axes

    def __call__(self, slip: Array, mask: BoolArray) -> Array:
        stretch = np.array(self.axes, np.float32)[:, None, None]
        shear = self.inverse(slip / stretch) / stretch * mask
        return _summed_ahead(shear) * mask if self.rolls else shear


def _summed_ahead(shear: Array) -> Array:
    """Sums (…, n) of shear (…, n) from each cell to the leading edge, blocks of cells at a time.

    A running sum waits for every addition; a block is a product with a triangle of ones.
    """
    cells = shear.shape[-1]
    side = next(width for width in range(math.isqrt(cells), 0, -1) if cells % width == 0)
    inside: Array = shear.reshape(-1, side) @ np.tri(side, dtype=shear.dtype)
    inside = inside.reshape(*shear.shape[:-1], cells // side, side)
    ahead = np.cumsum(inside[..., ::-1, 0], axis=-1)[..., ::-1]
    inside[..., :-1, :] += ahead[..., 1:, None]
    return inside.reshape(shear.shape)


def _start(
    influence: Influence,
    bound: Array,
    rigid: Array,
    forces: Forces,
    rolls: bool,
    axes: Axes,
    tolerance: float,
) -> tuple[Array, Array]:
    """Shear and rigid slips of the solution on half the grid; of strips on the same rows of cells twice as long."""
    striped = influence.has_strips
    axes_halved, halved = (ALONG, halve_along) if striped else (BOTH, halve)
    coarse_bound = np.nan_to_num(halved(bound))
    # The border cells of an odd grid keep their share of the friction force, not their mean.
    coarse_bound *= bound.sum() / (2 ** len(axes_halved) * coarse_bound.sum())
    if striped:
        coarse = operators(coarse_bound.shape, 2 * influence.dx, influence.dy, influence.pair, influence.first_y)
    else:
        coarse = replace(influence, shape=coarse_bound.shape, dx=2 * influence.dx, dy=2 * influence.dy)
    step = 2 if rolls else 1
    rough = solve_tangential(
        coarse,
        coarse_bound,
        step * np.nan_to_num(halved(rigid)),
        forces,
        rolls=rolls,
        axes=axes,
        tolerance=tolerance,
    )
    # The share of friction that is used varies smoothly; shear itself jumps at every edge.
    loaded = coarse_bound > 0
    share = rough.shear / np.where(loaded, coarse_bound, 1.0)
    return interpolate(share, loaded, bound.shape, axes_halved) * bound, np.asarray(rough.rigid)


def _bounding_box(mask: BoolArray) -> tuple[slice, slice] | None:
    rows, columns = np.flatnonzero(mask.any(1)), np.flatnonzero(mask.any(0))
    if rows.size == 0:
        return None
    return slice(int(rows[0]), int(rows[-1]) + 1), slice(int(columns[0]), int(columns[-1]) + 1)


def _uncrop(solution: CoulombSolution, bound: Array, box: tuple[slice, slice]) -> TangentialSolution:
    rows, columns = box
    shear, slip = np.zeros((2, *bound.shape)), np.zeros((2, *bound.shape))
    stick = np.zeros(bound.shape, bool)
    shear[:, rows, columns] = solution.shear
    stick[rows, columns] = solution.stick
    # Slip is zero by definition where the patch sticks, and means nothing outside of it.
    slip[:, rows, columns] = np.where((bound[rows, columns] > 0) & ~solution.stick, solution.slip, 0.0)
    return TangentialSolution(
        shear,
        slip,
        (float(solution.xi[0]), float(solution.xi[1])),
        stick,
        solution.residual,
        solution.newton,
        solution.krylov,
        solution.splitting,
        solution.products,
    )
