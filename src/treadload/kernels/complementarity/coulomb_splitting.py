"""Douglas-Rachford splitting of the tangential problem: slower than Newton, and it always moves on.

The constraint set contains q = 0 outside of the contact, so the problem may be posed on the whole padded
grid, where the resolvent of S is diagonal in Fourier space. A uniform rigid slip acts on the k = 0 mode only:
a prescribed force replaces that mode's equation.

Where groups of rows have dense blocks it is not, and the extragradient method serves: two products a step and no
resolvent, with the rigid slips as multipliers of the forces.

Sources: Lions & Mercier (1979), SIAM J. Numer. Anal. 16, 964-979; Korpelevich (1976), Matecon 12, 747-756; Khobotov
(1987), USSR Comput. Math. Math. Phys. 27, 120-127 (its step).
"""

from __future__ import annotations

import numpy as np

from treadload.kernels import fft
from treadload.kernels.arrays import Array
from treadload.kernels.complementarity.coulomb import CoulombProblem, four, project_disc

# Measured best on circles and ribbed treads.
_STEP = 0.5
_RELAXATION = 1.5
# A step of the extragradient method times the slope's change over the change of the shear; how steps grow again.
_CAUTION, _BOLDER = 0.9, 1.1


def split(
    problem: CoulombProblem, start: Array, xi_start: Array, *, tolerance: float = 1e-6, max_iterations: int = 5000
) -> tuple[Array, Array, int]:
    """Shear (2, ny, nx), rigid slips ξ (2,) and the number of iterations.

    start, xi_start: shear and ξ to begin with; ξ of a component whose rigid slip is known stays.
    Stops when the change of the shear falls below the tolerance relative to the bound.
    """
    if problem.strips is not None:
        return _extragradient(problem, start, xi_start, tolerance, max_iterations)
    my, mx = problem.padding.shape
    ny, nx = problem.bound.shape
    totals = problem.totals
    forced = [c for c in (0, 1) if totals[c] is not None]
    free = [c for c in (0, 1) if totals[c] is None]
    lam = _STEP / problem.self_influence
    xx, yy, xy, yx = four(problem.compliance)
    advance = 1 - np.exp(2j * np.pi * np.arange(mx // 2 + 1) / mx) if problem.rolls else np.ones(mx // 2 + 1)
    # (1 + λ S) and its inverse, mode by mode.
    a, d, b, c = (entry + lam * symbol * advance for entry, symbol in ((1, xx), (1, yy), (0, xy), (0, yx)))
    determinant = a * d - b * c
    zero_mode = np.array([[a[0, 0].real, b[0, 0].real], [c[0, 0].real, d[0, 0].real]])

    def pad(fields: Array) -> Array:
        padded = np.zeros((*fields.shape[:-2], my, mx))
        padded[..., :ny, :nx] = fields
        return padded

    creep = np.where([total is None for total in totals], xi_start, 0.0)
    rigid = pad(problem.rigid + problem.travel * creep[:, None, None])
    bound = pad(problem.bound)
    q = pad(start)
    x, y = fft.rfft2(q)
    s = np.stack([(xx * x + xy * y) * advance, (yx * x + yy * y) * advance])
    xi = xi_start - creep
    z = q - lam * (fft.irfft2(s, s=(my, mx)) + rigid + problem.travel * xi[:, None, None])
    scale = float(np.linalg.norm(bound))
    for iterations in range(1, max_iterations + 1):  # noqa: B007, it is returned
        q = project_disc(z, bound)
        v_x, v_y = fft.rfft2(2 * q - z - lam * rigid)
        resolved = np.stack([(d * v_x - b * v_y) / determinant, (a * v_y - c * v_x) / determinant])
        if forced:
            mean = np.array([0.0 if total is None else total for total in totals])
            v0 = np.array([v_x[0, 0].real, v_y[0, 0].real])
            if free:
                # The other component's k = 0 mode still sees the prescribed one.
                rhs = v0[free] - zero_mode[np.ix_(free, forced)] @ mean[forced]
                mean[free] = np.linalg.solve(zero_mode[np.ix_(free, free)], rhs)
            resolved[:, 0, 0] = mean
            xi[forced] = ((v0 - zero_mode @ mean) / (lam * problem.travel * my * mx))[forced]
        change = fft.irfft2(resolved, s=(my, mx)) - q
        z += _RELAXATION * change
        if np.linalg.norm(change) <= 0.3 * tolerance * scale:
            break
    return project_disc(z, bound)[:, :ny, :nx], creep + xi, iterations


def _extragradient(
    problem: CoulombProblem, start: Array, xi_start: Array, tolerance: float, max_iterations: int
) -> tuple[Array, Array, int]:
    """As `split`."""
    contact = problem.bound > 0
    cells = max(int(contact.sum()), 1)
    totals = np.array([0.0 if total is None else total for total in problem.totals])
    forced = np.array([total is not None for total in problem.totals])
    # Unknown rigid slips in a unit in which they move the slip as shear does.
    unit = problem.self_influence / (problem.travel * np.sqrt(cells))

    def slope(q: Array, z: Array) -> tuple[Array, Array]:
        excess = unit * problem.travel * (q.sum((1, 2)) - totals)
        return problem.slip(q, unit * z) * contact, np.where(forced, -excess, 0.0)

    q, z = project_disc(start, problem.bound), np.asarray(xi_start, float) / unit
    step, scale = 1 / problem.self_influence, float(np.linalg.norm(problem.bound))
    for iterations in range(1, max_iterations + 1):  # noqa: B007, it is returned
        by_q, by_z = slope(q, z)
        while True:
            ahead, z_ahead = project_disc(q - step * by_q, problem.bound), z - step * by_z
            ahead_q, ahead_z = slope(ahead, z_ahead)
            moved = np.hypot(np.linalg.norm(ahead - q), np.linalg.norm(z_ahead - z))
            turned = np.hypot(np.linalg.norm(ahead_q - by_q), np.linalg.norm(ahead_z - by_z))
            if step * turned <= _CAUTION * moved or moved == 0:
                break
            step *= max(0.5, 0.9 * _CAUTION * moved / (step * turned))
        last = q
        q, z = project_disc(q - step * ahead_q, problem.bound), z - step * ahead_z
        if np.linalg.norm(q - last) <= 0.1 * tolerance * scale:
            break
        step *= _BOLDER
    return q, unit * z, iterations
