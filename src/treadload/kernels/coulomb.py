"""The tangential problem: shear bounded by a disc, slip opposed to shear that reached the bound.

Find q (2, ny, nx) and the creepages whose force is prescribed, so that with  s = S q + w + e ξ

    |q| ≤ g;   s = 0 where |q| < g;   q = -g s/|s| where s ≠ 0;   Σ q_c = Q_c for prescribed forces.

S is a monotone convolution (u(x) - u(x + dx) in rolling, u itself in a shift), so that a solution exists
and is unique. Two solvers share one problem: semi-smooth Newton with Krylov inner solves, fast on smooth
patches, and Douglas-Rachford splitting, whose resolvent is diagonal in Fourier space, which always moves on.

Sources: Kalker (1990), Three-Dimensional Elastic Bodies in Rolling Contact, ch. 4; Alart & Curnier (1991),
Comput. Methods Appl. Mech. Eng. 92, 353-375; Vollebregt (2010), 100-fold speed-up of the normal contact
problem and other recent developments in CONTACT (cumulative sums); Lions & Mercier (1979), SIAM J. Numer.
Anal. 16, 964-979 (splitting).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from scipy.sparse.linalg import LinearOperator, gmres

from treadload.kernels.arrays import Array, BoolArray, ComplexArray
from treadload.kernels.convolution import Padding

_LINE_SEARCH = (1.0, 0.5, 0.25, 0.1, 0.02)
_SPLITTING_BURST = 40
_KRYLOV_MEMORY = 100
_KRYLOV_TOLERANCE = 1e-2


@dataclass(frozen=True)
class CoulombProblem:
    """What is given in the tangential problem.

    padding: padded space of the patch. operator: spectrum of S (2, 2, my, mx // 2 + 1).
    self_influence: diagonal of S, > 0. bound: g = μp (ny, nx) ≥ 0, zero outside contact.
    rigid: w (2, ny, nx): rigid slip that is known. travel: e, slip distance per unit of creepage.
    totals: prescribed sums of q_x and q_y over the cells; None where the creepage is prescribed instead
    (it is then part of `rigid`). precondition: approximate inverse of S on the cells of a mask.
    """

    padding: Padding
    operator: ComplexArray
    self_influence: float
    bound: Array
    rigid: Array
    travel: float
    totals: tuple[float | None, float | None]
    precondition: Callable[[Array], Array]

    @property
    def forced(self) -> tuple[int, ...]:
        """Components whose force is prescribed."""
        return tuple(c for c in (0, 1) if self.totals[c] is not None)

    def apply(self, q: Array) -> Array:
        """S q (2, ny, nx)."""
        spectrum = self.padding.forward(q)
        return self.padding.inverse(_multiply(self.operator, spectrum))

    def slip(self, q: Array, creepage: Array) -> Array:
        """S q + w + e ξ (2, ny, nx), with ξ (2,) the creepages found so far."""
        return self.apply(q) + self.rigid + self.travel * creepage[:, None, None]


@dataclass
class _Counts:
    newton: int = 0
    krylov: int = 0
    splitting: int = 0
    products: int = 0


@dataclass(frozen=True)
class CoulombSolution:
    """Solution of the tangential problem.

    shear: q (2, ny, nx). slip: s (2, ny, nx). creepage: ξ (2,), zero where prescribed.
    stick: (ny, nx) True where |q| < g. residual: |q - P(q - r s)| / |g| and the imbalance of forces
    relative to Σg, whichever is larger. newton, krylov, splitting, products: iterations and products with S.
    """

    shear: Array
    slip: Array
    creepage: Array
    stick: BoolArray
    residual: float
    converged: bool
    newton: int = 0
    krylov: int = 0
    splitting: int = 0
    products: int = 0
    history: list[float] = field(default_factory=list)


@dataclass(frozen=True)
class _State:
    """A trial point with everything that is derived from it, on the cells of the contact (2, n)."""

    q: Array
    creepage: Array
    slip: Array
    error: Array
    imbalance: Array
    reach: Array
    reach_size: Array
    merit: float


def project_disc(q: Array, bound: Array) -> Array:
    """Nearest shear (2, …) of size at most bound (…)."""
    return q * _shrink(np.hypot(q[0], q[1]), bound)


def _shrink(size: Array, bound: Array) -> Array:
    """Factor that brings a vector of this size back to the bound: 1 inside."""
    outside = size > bound
    return np.divide(bound, size, out=np.ones_like(size), where=outside)


def solve(
    problem: CoulombProblem,
    start: Array | None = None,
    creepage: Array | None = None,
    *,
    tolerance: float = 1e-6,
    max_iterations: int = 60,
) -> CoulombSolution:
    """Shear, slip and unknown creepages of a tangential contact problem.

    start: q (2, ny, nx) and creepage: ξ (2,) to begin with. Semi-smooth Newton; where its line search
    stalls, a burst of splitting moves on. Returns the solution, converged or not.
    """
    contact = problem.bound > 0
    bound = problem.bound[contact]
    ny, nx = problem.bound.shape
    q0 = np.zeros((2, ny, nx)) if start is None else project_disc(start, problem.bound)
    xi0 = np.zeros(2) if creepage is None else np.asarray(creepage, float).copy()
    counts = _Counts()
    if not contact.any():
        slip = problem.slip(q0, xi0)
        return CoulombSolution(q0, slip, xi0, np.zeros_like(contact), 0.0, True)
    state = _evaluate(problem, contact, bound, q0[:, contact], xi0, counts)
    history = [state.merit]
    while state.merit > tolerance and counts.newton < max_iterations:
        step_q, step_xi = _newton_step(problem, contact, bound, state, counts)
        counts.newton += 1
        best = state
        for length in _LINE_SEARCH:
            trial = _evaluate(
                problem, contact, bound, state.q + length * step_q, state.creepage + length * step_xi, counts
            )
            if trial.merit < best.merit:
                best = trial
            if best.merit <= (1 - 0.1 * length) * state.merit:
                break
        if best.merit > 0.95 * state.merit:
            best = _splitting_burst(problem, contact, bound, best, counts)
        state = best
        history.append(state.merit)
    return _finish(problem, contact, bound, state, counts, history, tolerance)


def solve_by_splitting(
    problem: CoulombProblem,
    start: Array | None = None,
    *,
    tolerance: float = 1e-6,
    max_iterations: int = 5000,
) -> CoulombSolution:
    """The same problem by Douglas-Rachford splitting alone: slower, and never stalls.

    A second way to the same answer, for patches where Newton does not settle and as its witness.
    """
    contact = problem.bound > 0
    bound = problem.bound[contact]
    q0 = np.zeros((2, *contact.shape)) if start is None else project_disc(start, problem.bound)
    counts = _Counts()
    if not contact.any():
        return solve(problem, start)
    q, xi = _split(problem, q0, np.zeros(2), tolerance, max_iterations, counts)
    state = _evaluate(problem, contact, bound, q[:, contact], xi, counts)
    return _finish(problem, contact, bound, state, counts, [state.merit], tolerance)


def _multiply(matrix: ComplexArray, vector: ComplexArray) -> ComplexArray:
    """Product of 2 x 2 symbols with 2 spectra, mode by mode."""
    return np.stack(
        [
            matrix[0, 0] * vector[0] + matrix[0, 1] * vector[1],
            matrix[1, 0] * vector[0] + matrix[1, 1] * vector[1],
        ]
    )


def _evaluate(
    problem: CoulombProblem, contact: BoolArray, bound: Array, q: Array, creepage: Array, counts: _Counts
) -> _State:
    full = np.zeros((2, *contact.shape))
    full[:, contact] = q
    slip = problem.slip(full, creepage)[:, contact]
    counts.products += 1
    reach = q - slip / problem.self_influence
    size = np.hypot(reach[0], reach[1])
    error = q - reach * _shrink(size, bound)
    totals = problem.totals
    imbalance = np.array([0.0 if (t := totals[c]) is None else t - q[c].sum() for c in (0, 1)])
    merit = float(np.hypot(np.linalg.norm(error) / np.linalg.norm(bound), np.linalg.norm(imbalance) / bound.sum()))
    return _State(q, creepage, slip, error, imbalance, reach, size, merit)


def _newton_step(
    problem: CoulombProblem, contact: BoolArray, bound: Array, state: _State, counts: _Counts
) -> tuple[Array, Array]:
    """Step of the semi-smooth Newton method: dq (2, n) and dξ (2,).

    Stick cells: r(S dq + e dξ) = -r s. Slip cells, n along the trial shear and t across, m = g/|z|:
    n·dq = -n·F and (1 - m) t·dq + m r t·(S dq + e dξ) = -t·F. Force rows: Σ dq_c = Q_c - Σ q_c.
    """
    n_cells = bound.size
    forced = problem.forced
    stick = state.reach_size <= bound
    shrink = _shrink(state.reach_size, bound)
    normal = np.where(stick, 0.0, state.reach * shrink / bound)
    across = np.stack([-normal[1], normal[0]])
    r = 1 / problem.self_influence
    full = np.zeros((2, *contact.shape))

    def slip_of(dq: Array) -> Array:
        full[:, contact] = dq
        counts.products += 1
        return r * problem.apply(full)[:, contact]

    def rows(dq: Array, slip: Array) -> Array:
        along_t = (1 - shrink) * (across * dq).sum(0) + shrink * (across * slip).sum(0)
        along_n = (normal * dq).sum(0)
        return np.where(stick, slip, across * along_t + normal * along_n)

    def pack(fields: Array, forces: Array) -> Array:
        return np.concatenate([fields.ravel(), forces])

    def creep_slip(xi: Array) -> Array:
        uniform = np.zeros((2, n_cells))
        uniform[list(forced)] = xi[:, None]
        return uniform

    def matvec(v: Array) -> Array:
        dq, xi = v[: 2 * n_cells].reshape(2, n_cells), v[2 * n_cells :]
        out = rows(dq, slip_of(dq) + creep_slip(xi))
        return pack(out, dq[list(forced)].mean(1))

    def inverse(v: Array) -> Array:
        full[:, contact] = np.where(stick, v, 0.0)
        return np.where(stick, problem.precondition(full)[:, contact] / r, v)

    zero = np.zeros((2, n_cells))
    columns = np.array([inverse(rows(zero, creep_slip(unit))) for unit in np.eye(len(forced))])
    schur = columns[:, list(forced)].mean(2).T if forced else np.zeros((0, 0))

    def precondition(v: Array) -> Array:
        dq, force = inverse(v[: 2 * n_cells].reshape(2, n_cells)), v[2 * n_cells :]
        if not forced:
            return dq.ravel()
        xi = np.linalg.lstsq(schur, dq[list(forced)].mean(1) - force, rcond=1e-12)[0]
        return pack(dq - np.tensordot(xi, columns, 1), xi)

    # The radial part of a slip cell's step is known beforehand; it goes to the right-hand side.
    radial = np.where(stick, 0.0, -normal * (normal * state.error).sum(0))
    coupled = slip_of(radial)
    rhs_stick = -r * state.slip - coupled
    rhs_slip = across * (-(across * state.error).sum(0) - shrink * (across * coupled).sum(0))
    force = (state.imbalance[list(forced)] - radial[list(forced)].sum(1)) / n_cells
    rhs = pack(np.where(stick, rhs_stick, rhs_slip), force)
    size = rhs.size
    before = counts.products
    with np.errstate(divide="ignore", invalid="ignore"):
        solution, _ = gmres(
            LinearOperator((size, size), matvec=matvec),
            rhs,
            M=LinearOperator((size, size), matvec=precondition),
            rtol=_KRYLOV_TOLERANCE,
            restart=_KRYLOV_MEMORY,
            maxiter=1,
        )
    if not np.isfinite(solution).all():
        # Where every cell slides along the force no creepage changes it: gmres divides by zero. Splitting moves on.
        solution = np.zeros(size)
    counts.krylov += counts.products - before
    step_xi = np.zeros(2)
    step_xi[list(forced)] = solution[2 * n_cells :] * problem.self_influence / problem.travel
    return solution[: 2 * n_cells].reshape(2, n_cells) + radial, step_xi


def _splitting_burst(
    problem: CoulombProblem, contact: BoolArray, bound: Array, state: _State, counts: _Counts
) -> _State:
    full = np.zeros((2, *contact.shape))
    full[:, contact] = state.q
    q, xi = _split(problem, full, state.creepage, 0.0, _SPLITTING_BURST, counts)
    return _evaluate(problem, contact, bound, q[:, contact], xi, counts)


def _split(
    problem: CoulombProblem,
    start: Array,
    creepage: Array,
    tolerance: float,
    max_iterations: int,
    counts: _Counts,
) -> tuple[Array, Array]:
    """Douglas-Rachford iterations on the whole padded grid: q (2, ny, nx) and ξ (2,).

    A uniform creepage acts on the k = 0 mode only, so a prescribed force replaces that mode's equation.
    """
    padding = problem.padding
    my, mx = padding.shape
    ny, nx = problem.bound.shape
    lam = 0.5 / problem.self_influence
    matrix = lam * problem.operator
    matrix[0, 0] += 1
    matrix[1, 1] += 1
    determinant = matrix[0, 0] * matrix[1, 1] - matrix[0, 1] * matrix[1, 0]
    resolvent = np.stack([[matrix[1, 1], -matrix[0, 1]], [-matrix[1, 0], matrix[0, 0]]]) / determinant
    base_creepage = np.where([t is None for t in problem.totals], creepage, 0.0)
    rigid = np.zeros((2, my, mx))
    rigid[:, :ny, :nx] = problem.rigid + problem.travel * base_creepage[:, None, None]
    bound = np.zeros((my, mx))
    bound[:ny, :nx] = problem.bound
    q: Array = np.zeros((2, my, mx))
    q[:, :ny, :nx] = start
    slip = np.fft.irfft2(_multiply(problem.operator, np.fft.rfft2(q)), s=(my, mx)) + rigid
    free = creepage - base_creepage
    slip += problem.travel * free[:, None, None]
    y = q - lam * slip
    scale = np.linalg.norm(bound)
    xi = free.copy()
    for _ in range(max_iterations):
        q = project_disc(y, bound)
        v = np.fft.rfft2(2 * q - y - lam * rigid)
        j = _multiply(resolvent, v)
        for c in problem.forced:
            total = problem.totals[c]
            assert total is not None
            j[c, 0, 0] = total
        if problem.forced:
            # The other component's k = 0 mode still sees the prescribed one.
            j0 = _zero_mode(matrix[:, :, 0, 0].real, v[:, 0, 0].real, problem.totals)
            j[:, 0, 0] = j0
            balance = (v[:, 0, 0].real - matrix[:, :, 0, 0].real @ j0) / (lam * problem.travel * my * mx)
            xi[list(problem.forced)] = balance[list(problem.forced)]
        change = np.fft.irfft2(j, s=(my, mx)) - q
        y += 1.5 * change
        counts.splitting += 1
        if np.linalg.norm(change) <= 0.3 * tolerance * scale:
            break
    q = project_disc(y, bound)
    return q[:, :ny, :nx], base_creepage + xi


def _zero_mode(matrix: Array, v: Array, totals: tuple[float | None, float | None]) -> Array:
    """Means (2,) that solve the rows of free components, with the prescribed ones given."""
    j = np.array([0.0 if t is None else t for t in totals])
    free = [c for c in (0, 1) if totals[c] is None]
    if free:
        rhs = (
            v[free]
            - matrix[np.ix_(free, [c for c in (0, 1) if c not in free])] @ j[[c for c in (0, 1) if c not in free]]
        )
        j[free] = np.linalg.solve(matrix[np.ix_(free, free)], rhs)
    return j


def _finish(
    problem: CoulombProblem,
    contact: BoolArray,
    bound: Array,
    state: _State,
    counts: _Counts,
    history: list[float],
    tolerance: float,
) -> CoulombSolution:
    q = np.zeros((2, *contact.shape))
    q[:, contact] = project_disc(state.q, bound)
    stick = np.zeros_like(contact)
    stick[contact] = state.reach_size <= bound
    slip = problem.slip(q, state.creepage)
    counts.products += 1
    return CoulombSolution(
        q,
        slip,
        state.creepage,
        stick,
        state.merit,
        state.merit <= tolerance,
        counts.newton,
        counts.krylov,
        counts.splitting,
        counts.products,
        history,
    )
