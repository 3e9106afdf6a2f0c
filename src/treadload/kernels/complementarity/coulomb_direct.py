"""The tangential problem on few cells, with dense matrices: for what neither Newton's steps nor splitting bring near.

Where all cells slip, a prescribed force does not determine its rigid slip until it is moved so far that a cell
sticks. Two cells pressed between unlike bodies slip apart, each by its friction, and pressures that differ by
round-off leave a force that no small step takes away. Here a prescribed force is a spring on the rigid slip, stiffer
from round to round, and the force that is left of it becomes known slip: the method of multipliers, which needs no
derivative there.

Source: Rockafellar (1976), Math. Oper. Res. 1, 97-116 (multipliers as a proximal point method).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from treadload.kernels.arrays import Array
from treadload.kernels.complementarity.coulomb import CoulombProblem

MOST_CELLS = 120
"""Cells in contact up to which dense matrices cost less than a failure."""

# Of the springs, in units of the cells' own compliance.
_SPRINGS = (1.0, 1e2, 1e4, 1e6, *(1e8,) * 30)
# A force that stays as it was moves its rigid slip on by twice as much.
_STAYS = 0.01
_NEWTON, _BURST = 60, 60
# Of what is left in the scaled equations: below it lies round-off.
_LEAST = 1e-6
# Forces count a hundredfold beside the cells' conditions, and as much again is left for the last steps.
_REACHED = 1e-4
_LENGTHS = (1.0, 0.5, 0.25, 0.1, 0.02)
# Of the resolvent in the slow path, in units of the cells' own stiffness.
_STEP = 0.5


def solve(problem: CoulombProblem, start: Array, xi: Array, *, tolerance: float) -> tuple[Array, Array]:
    """Shear (2, ny, nx) and rigid slips ξ (2,), as near as dense matrices bring them.

    start, xi: to begin with. tolerance: of the conditions, relative to the bound. At most `MOST_CELLS` in contact.
    """
    inside = problem.bound > 0
    cells = np.flatnonzero(np.broadcast_to(inside, start.shape))
    n = cells.size // 2
    stiffness = 1 / problem.self_influence
    bound = problem.bound[inside]
    matrix = stiffness * _matrix(problem, cells)
    forced = problem.forced
    creep = np.where([total is None for total in problem.totals], xi, 0.0)
    slip = stiffness * (problem.rigid + problem.travel * creep[:, None, None]).ravel()[cells]
    # Columns that a rigid slip moves, and forces, as means over the cells.
    rigid = np.repeat(np.eye(2)[:, forced], n, axis=0)
    wanted = np.array([problem.totals[c] for c in forced], float) / n
    unknown = stiffness * problem.travel * np.asarray(xi, float)[forced]
    q = start.ravel()[cells]
    goal = 0.1 * tolerance * float(np.linalg.norm(bound))
    missing, far = np.full(len(forced), np.inf), 1.0
    for spring in _SPRINGS if forced else (0.0,):
        # Scaled to a norm of about one, stiff springs take no cell past sticking into slip the other way.
        scale = 1 / (1 + spring)
        scaled = scale * (matrix + spring / n * rigid @ rigid.T)
        q = _bounded(
            scaled, scale * (slip + rigid @ (unknown - spring * wanted)), bound, q, max(scale, _LEAST) * goal
        )
        before, missing = missing, rigid.T @ q / n - wanted
        left = float(np.abs(missing).max(initial=0.0))
        far = 2 * far if np.abs(missing - before).max(initial=0.0) <= _STAYS * left else 1.0
        unknown = unknown + far * spring * missing
        if left * n <= _REACHED * goal:
            break
    shear, slips = np.zeros(start.size), creep.copy()
    shear[cells] = q
    slips[forced] = unknown / (stiffness * problem.travel)
    return shear.reshape(start.shape), slips


def _bounded(matrix: Array, slip: Array, bound: Array, q: Array, goal: float) -> Array:
    """Shear q (2 n,) with q = P(q - (matrix q + slip)), P the nearest within the bound (n,), by Newton's method."""
    size = bound.size
    identity = np.eye(2 * size)
    resolvent: Array | None = None
    error, turn = _error(matrix, slip, bound, q)
    for _ in range(_NEWTON):
        left = float(np.linalg.norm(error))
        if left <= goal:
            break
        step = np.linalg.lstsq(identity - turn @ (identity - matrix), -error, rcond=1e-15)[0]
        best, best_left = q, left
        for length in _LENGTHS:
            trial = q + length * step
            trial_left = float(np.linalg.norm(_error(matrix, slip, bound, trial)[0]))
            if trial_left < best_left:
                best, best_left = trial, trial_left
            if best_left <= (1 - 0.1 * length) * left:
                break
        if best_left > 0.95 * left:
            if resolvent is None:
                resolvent = np.linalg.inv(identity + _STEP * matrix)
            best = _split(resolvent, matrix, slip, bound, best)
        q = best
        error, turn = _error(matrix, slip, bound, q)
    return _nearest(q, bound)


def _error(matrix: Array, slip: Array, bound: Array, q: Array) -> tuple[Array, Array]:
    """What is left of q = P(q - s), (2 n,), and the derivative of P there, (2 n, 2 n)."""
    reach = (q - matrix @ q - slip).reshape(2, -1)
    size = np.hypot(*reach)
    slips = size > bound
    share = np.where(slips, bound / np.where(slips, size, 1.0), 1.0)
    across = np.stack([-reach[1], reach[0]]) / np.where(size > 0, size, 1.0)
    parts = [[np.diag(np.where(slips, share * across[i] * across[j], float(i == j))) for j in (0, 1)] for i in (0, 1)]
    return q - (reach * share).ravel(), np.block(parts)


def _split(resolvent: Array, matrix: Array, slip: Array, bound: Array, q: Array) -> Array:
    """Some steps of Douglas-Rachford splitting, as in `coulomb_splitting`."""
    z = q - _STEP * (matrix @ q + slip)
    for _ in range(_BURST):
        q = _nearest(z, bound)
        z += 1.5 * (resolvent @ (2 * q - z - _STEP * slip) - q)
    return _nearest(z, bound)


def _nearest(q: Array, bound: Array) -> Array:
    """Nearest shear (2 n,) within the bound (n,)."""
    parts = q.reshape(2, -1)
    size = np.hypot(*parts)
    nearest: Array = parts * np.divide(bound, size, out=np.ones_like(size), where=size > bound)
    return nearest.ravel()


def _matrix(problem: CoulombProblem, cells: NDArray[np.intp]) -> Array:
    """S on the cells in contact (2 n, 2 n), m/Pa: one product for every unit of shear."""
    columns = np.empty((cells.size, cells.size))
    unit = np.zeros(problem.rigid.shape)
    for number, cell in enumerate(cells):
        unit.flat[cell] = 1.0
        columns[:, number] = problem.apply(unit).ravel()[cells]
        unit.flat[cell] = 0.0
    return columns
