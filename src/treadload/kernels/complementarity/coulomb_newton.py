"""Semi-smooth Newton for the tangential problem, with Krylov inner solves.

Fast on smooth patches. Where its line search stalls, a burst of splitting moves on.

Sources: Alart & Curnier (1991), Comput. Methods Appl. Mech. Eng. 92, 353-375; Vollebregt (2010), 100-fold
speed-up of the normal contact problem and other recent developments in CONTACT (cumulative sums).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from treadload.kernels.arrays import Array, BoolArray
from treadload.kernels.complementarity import conjugate_residuals
from treadload.kernels.complementarity.coulomb import CoulombProblem, project_disc, shrink
from treadload.kernels.complementarity.coulomb_splitting import split

_LINE_SEARCH = (1.0, 0.5, 0.25, 0.1, 0.02)
_SPLITTING_BURST = 40
_KRYLOV_MEMORY = 60
# Two digits a step near the solution, where Newton's method converges; less than one while cells still change sides.
_KRYLOV_TOLERANCES = (1e-2, 0.4)
_RESERVE = 0.8
# What holding friction's bound changes may leave too much: then the steps before it aim this much lower.
_TIGHTER = 0.3
# A step may be followed in single precision where ten times what that loses of the residual is below the tolerance.
_SINGLE = 1e-6
_FAR, _POOR_STEP = 1e-4, 0.05
# What rigid slips do through the preconditioner serves until this share of the cells sticks or slips otherwise.
_OTHER_CELLS = 0.1
# A stick cell below this share of its bound can take up what clipping took from the forces.
_ROOM = 0.999
# Forces are held this much tighter than the cells' conditions.
_FORCE_WEIGHT = 100.0
# A residual is relative to a hundred times the shear where that is less than friction: the error of shear is about
# the residual, so that under a small creepage it is 1e-4 at most. Below the second, there is no shear; nor is shear
# known better than a known rigid slip that an unknown one makes up for.
_SMALL_SHEAR, _NO_SHEAR = 100.0, 1e-12
# In the linear systems this much tighter: enough that the last step seldom leaves a force to mend.
_FORCE_ROW = 10.0


@dataclass(frozen=True)
class CoulombSolution:
    """Solution of the tangential problem.

    shear: q (2, ny, nx). slip: s (2, ny, nx). xi: ξ (2,), zero where prescribed.
    stick: (ny, nx) True where |q| < g. residual: |q - P(q - r s)| / |g|, or a hundred times the imbalance of
    the forces relative to Σg if that is larger; where little of friction is used, with a hundred times the shear, or
    what the known rigid slip asks of a cell, in the place of g. newton, krylov, splitting, products: iterations, and
    products with S.
    """

    shear: Array
    slip: Array
    xi: Array
    stick: BoolArray
    residual: float
    converged: bool
    newton: int = 0
    krylov: int = 0
    splitting: int = 0
    products: int = 0


def solve(
    problem: CoulombProblem,
    start: Array | None = None,
    xi: Array | None = None,
    *,
    tolerance: float = 1e-6,
    max_iterations: int = 60,
) -> CoulombSolution:
    """Shear, slip and unknown rigid slips of a tangential contact problem.

    start: q (2, ny, nx) and xi: ξ (2,) to begin with; left out, the ξ by which the start slips least in the mean.
    tolerance: of the residual.
    Returns the solution, converged or not.
    """
    newton = _Newton(problem, tolerance)
    q = np.zeros_like(problem.rigid) if start is None else project_disc(start, problem.bound)
    state = newton.state_of(q, np.zeros(2) if xi is None else np.asarray(xi, float))
    if xi is None:
        state = newton.at_rest(state)
    while True:
        while state.residual > newton.tolerance and newton.count < max_iterations:
            state = newton.advance(state)
        # Friction's bound holds to the last digit: what that changes is seen in the residual.
        stick = state.stick
        q = np.where(stick, project_disc(state.q, problem.bound), state.reach * state.shrink) * newton.contact
        state = newton.state_of(_balance(problem, q, stick), state.xi)
        if state.residual <= tolerance or newton.count >= max_iterations:
            break
        newton.tolerance *= _TIGHTER
    return CoulombSolution(
        state.q,
        state.slip,
        state.xi,
        stick,
        state.residual,
        state.residual <= tolerance,
        newton.count,
        newton.krylov,
        newton.splitting,
        newton.products,
    )


def _balance(problem: CoulombProblem, q: Array, stick: BoolArray) -> Array:
    """Shear that carries the prescribed forces to the last digit: stick cells with room share what is missing."""
    room = stick & (np.hypot(q[0], q[1]) < _ROOM * problem.bound)
    cells = int(room.sum())
    for c in problem.forced:
        total = problem.totals[c]
        if cells and total is not None:
            q[c][room] += (total - q[c].sum()) / cells
    return np.where(stick, project_disc(q, problem.bound), q)


@dataclass(frozen=True)
class _State:
    """A trial point with what is derived from it.

    q, slip, error: (2, ny, nx). xi, imbalance: (2,). reach = q - r s; shrink: min(1, g/|reach|) (ny, nx).
    stick: cells of the contact whose reach stays within the bound. residual: what must become small.
    merit: what a step must lower; forces weigh less in it, or they would hold the cells back.
    """

    q: Array
    xi: Array
    slip: Array
    reach: Array
    shrink: Array
    stick: BoolArray
    error: Array
    imbalance: Array
    residual: float
    merit: float


@dataclass
class _Newton:
    """The semi-smooth Newton iteration and its counts."""

    problem: CoulombProblem
    tolerance: float
    count: int = 0
    krylov: int = 0
    splitting: int = 0
    products: int = 0
    last_residual: float = float("inf")
    # What a unit of every unknown rigid slip does to the shear, through the preconditioner; and which cells stuck.
    columns: tuple[Array | None, Any] = (None, None)
    single: CoulombProblem = field(init=False)
    contact: BoolArray = field(init=False)
    n_cells: int = field(init=False)
    # Shear that would make each cell by itself follow the known rigid slip.
    wanted: float = field(init=False)

    def __post_init__(self) -> None:
        # The Krylov solves only need two digits: half the precision is half the time.
        full = self.problem.compliance.transpose(0, 2, 1)
        half = full.astype(np.complex64, "C") if np.iscomplexobj(full) else full.astype(np.float32, "C")
        self.single = replace(self.problem, compliance=half.transpose(0, 2, 1))
        self.contact = self.problem.bound > 0
        self.n_cells = int(self.contact.sum())
        self.wanted = float(np.linalg.norm(self.problem.rigid * self.contact)) / self.problem.self_influence

    def state_of(self, q: Array, xi: Array) -> _State:
        """State of shear (2, ny, nx) and ξ (2,)."""
        self.products += 1
        return self.state(q, xi, self.problem.slip(q, xi))

    def state(self, q: Array, xi: Array, slip: Array) -> _State:
        """State of shear (2, ny, nx), ξ (2,) and the slip (2, ny, nx) that they make."""
        problem = self.problem
        tiny = np.finfo(float).tiny
        reach = q - slip / problem.self_influence
        size = np.sqrt(_dot(reach, reach))
        factor = shrink(size, problem.bound)
        projected = reach * factor
        error = q - projected
        totals = problem.totals
        imbalance = np.array([0.0 if (total := totals[c]) is None else total - q[c].sum() for c in (0, 1)])
        friction = max(float(np.linalg.norm(problem.bound)), tiny)
        apart = float(np.linalg.norm(error)) / friction
        short = float(np.linalg.norm(imbalance) / max(problem.bound.sum(), tiny))
        stick = self.contact & (size <= problem.bound)
        used = max(_SMALL_SHEAR * float(np.linalg.norm(projected)), self.wanted) / friction
        small = min(1.0, max(used, _NO_SHEAR))
        return _State(
            q,
            xi,
            slip,
            reach,
            factor,
            stick,
            error,
            imbalance,
            max(apart, _FORCE_WEIGHT * short) / small,
            math.hypot(apart, short),
        )

    def at_rest(self, state: _State) -> _State:
        """The state with unknown rigid slips that make up for what the shear of the contact slips by in the mean."""
        xi = np.zeros(2)
        for c in self.problem.forced:
            xi[c] = -state.slip[c][self.contact].mean() / self.problem.travel
        return self.state(state.q, xi, state.slip + self.problem.travel * xi[:, None, None])

    def advance(self, state: _State) -> _State:
        """One Newton step with line search; where that stalls, a burst of splitting."""
        # Slip is affine in shear: one product serves every step length.
        step_q, step_xi, along = self._step(state)
        self.count += 1
        best = state
        for length in _LINE_SEARCH:
            # A singular system may lead beyond all numbers: such a trial lowers nothing.
            with np.errstate(over="ignore", invalid="ignore"):
                trial = self.state(
                    state.q + length * step_q, state.xi + length * step_xi, state.slip + length * along
                )
            if trial.merit < best.merit:
                best = trial
            if best.merit <= (1 - 0.1 * length) * state.merit:
                break
        if best.merit > 0.95 * state.merit:
            q, xi, steps = split(self.problem, best.q, best.xi, tolerance=0.0, max_iterations=_SPLITTING_BURST)
            self.splitting += steps
            best = self.state_of(q, xi)
        return best

    def _step(self, state: _State) -> tuple[Array, Array, Array]:
        """Newton step dq (2, ny, nx) and dξ (2,), and the slip (2, ny, nx) that it makes.

        Stick cells: r(S dq + e dξ) = -r s. Slip cells, n along the trial shear and t across, m = g/|z|:
        n·dq = -n·F and (1 - m) t·dq + m r t·(S dq + e dξ) = -t·F. Force rows: Σ dq_c = Q_c - Σ q_c.
        Unknowns: dq and, scaled like it, r e dξ.
        """
        poor = state.merit > _FAR and (self.count == 0 or state.residual > _POOR_STEP * self.last_residual)
        self.last_residual = state.residual
        # No further than what is asked, with a reserve for what the linear system cannot see.
        rtol = max(
            _KRYLOV_TOLERANCES[poor], min(_RESERVE * self.tolerance / state.residual, _KRYLOV_TOLERANCES[True])
        )
        rows = _Rows(self, state)
        before = self.products
        with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
            solution, along = conjugate_residuals.solve(
                rows.right_hand_side(state),
                rows.product,
                rows.precondition,
                size=state.q.size,
                rtol=rtol,
                most=_KRYLOV_MEMORY,
            )
        self.krylov += self.products - before
        forced = self.problem.forced
        xi = np.zeros(2)
        xi[forced] = solution[state.q.size :] * self.problem.self_influence / self.problem.travel
        step = solution[: state.q.size].reshape(state.q.shape).astype(float)
        if _SINGLE * state.residual <= self.tolerance:
            slip = along.reshape(state.q.shape) / rows.r
        else:
            self.products += 1
            slip = self.problem.apply(step)
        return step, xi, slip + self.problem.travel * xi[:, None, None]


class _Rows:
    """The linear system of one Newton step, in single precision, scaled so that its entries are near one.

    Cells outside of the contact have neither stick nor direction: their rows and unknowns are zero.
    """

    def __init__(self, newton: _Newton, state: _State) -> None:
        self.newton = newton
        self.forced = newton.problem.forced
        self.stick = state.stick
        bound = np.where(newton.contact, newton.problem.bound, 1.0)
        self.normal = np.where(state.stick, 0.0, state.reach * (state.shrink / bound)).astype(np.float32)
        self.across = np.stack([-self.normal[1], self.normal[0]])
        self.m = state.shrink.astype(np.float32)
        # Across the shear, a slip cell is a mixture of 1 - m of its own row and m of a stick cell's.
        self.weight = np.where(state.stick, 1, self.m * newton.contact).astype(np.float32)
        self.r = np.float32(1 / newton.problem.self_influence)
        # What a mean over the contact counts beside the cells, if it counts as much as in the merit, and a bit more.
        g = newton.problem.bound
        self.force_row = _FORCE_ROW * float(np.linalg.norm(g) / g.sum()) * newton.n_cells
        columns, last = newton.columns
        if columns is None or (last != self.stick).sum() > _OTHER_CELLS * newton.n_cells:
            units, nothing = np.eye(len(self.forced), dtype=np.float32), np.zeros_like(self.normal)
            columns = np.array([self._inverse(self._rows(nothing, self._uniform(unit))) for unit in units])
            newton.columns = columns, self.stick
        self.columns = columns
        schur = np.array([self._mean(column) for column in self.columns]).T
        self.unmixed = np.linalg.pinv(schur, rcond=1e-12) if self.forced else schur

    def product(self, v: Array) -> tuple[Array, Array]:
        """Left side of the rows for unknowns v (2 ny nx + forces,), and r S dq (2 ny nx,)."""
        self.newton.products += 1
        dq, xi = self._unpack(v)
        slip = self.r * self.newton.single.apply(dq)
        return self._pack(self._rows(dq, slip + self._uniform(xi)), self.force_row * self._mean(dq)), slip.ravel()

    def precondition(self, v: Array) -> Array:
        """Approximate solution of the rows: stick cells by the approximate inverse, then the forces."""
        rows, force = self._unpack(v)
        dq = self._inverse(rows)
        if not self.forced:
            return dq.ravel()
        xi = (self.unmixed @ (self._mean(dq) - force / self.force_row)).astype(np.float32)
        for unknown, column in zip(xi, self.columns, strict=True):
            dq -= unknown * column
        return self._pack(dq, xi)

    def right_hand_side(self, state: _State) -> Array:
        """Right side (2 ny nx + forces,)."""
        fields = np.where(self.stick, -self.r * state.slip, -state.error)
        return self._pack(fields, self.force_row * state.imbalance[self.forced] / self.newton.n_cells)

    def _rows(self, dq: Array, slip: Array) -> Array:
        tangent = _dot(self.across, dq)
        along_t: Array = self.m * (_dot(self.across, slip) - tangent) + tangent
        rows: Array = self.across * along_t
        rows += self.normal * _dot(self.normal, dq)
        np.copyto(rows, slip, where=self.stick)
        return rows

    def _inverse(self, rows: Array) -> Array:
        """Approximate solution of the rows of the cells: the preconditioner where they stick, or nearly do."""
        mixed = self.across * (_dot(self.across, rows) * self.weight)
        inverse: Array = self.newton.single.precondition(np.where(self.stick, rows, mixed), self.newton.contact)
        inverse /= self.r
        sliding = rows - mixed + self.across * (_dot(self.across, inverse) * self.weight)
        np.copyto(inverse, sliding, where=~self.stick)
        return inverse

    def _mean(self, fields: Array) -> Array:
        """Means over the contact of the components whose force is prescribed."""
        return np.array([fields[c].sum() for c in self.forced], float) / self.newton.n_cells

    def _uniform(self, xi: Array) -> Array:
        slip = np.zeros((2, 1, 1), np.float32)
        slip[self.forced, 0, 0] = xi
        return slip

    def _pack(self, fields: Array, forces: Array) -> Array:
        return np.concatenate([fields.ravel(), forces], dtype=np.float32, casting="same_kind")

    def _unpack(self, v: Array) -> tuple[Array, Array]:
        size = self.normal.size
        return v[:size].reshape(self.normal.shape), v[size:]


def _dot(first: Array, second: Array) -> Array:
    product: Array = first[0] * second[0]
    product += first[1] * second[1]
    return product
