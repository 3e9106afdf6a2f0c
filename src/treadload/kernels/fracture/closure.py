"""Stress intensity of a crack whose faces touch and rub: neither do they pass through each other, nor slip freely.

On the faces stand a pressure, where they touch, and a shear that the pressure times a coefficient of friction bounds.
Both are bounded tractions f that keep a displacement at zero: displacement = G (σ - f), f at a bound where it is not.
"""

from __future__ import annotations

import numpy as np

from treadload.kernels.arrays import Array, BoolArray
from treadload.kernels.fracture.crack import CrackFaces

# Active sets settle in about five steps; rows that do not are finished by one change at a time.
_STEPS = 40
# Pressure and shear of the faces alternate where the path bends or leans.
_TURNS, _SETTLED = 30, 1e-5
# Rows whose sets are sought together, some 100 MB.
_TOGETHER = 20_000


def stress_intensity(faces: CrackFaces, traction: Array, friction: float) -> tuple[Array, BoolArray]:
    """K (..., 3), Pa √m, of modes I, II and III as the faces allow, and which states (...) settled.

    traction: (..., 3, n), Pa, normal, along the path and out of the plane, that the uncracked body has at the points.
    friction: of the faces. Shear starts from rest in every state: the faces remember no earlier slip. Its bound is
    shared between the modes as the shear of the uncracked body is. Faces that lean or bend may jam: pressure and
    shear then go round, and K is that without friction. Raises ArithmeticError.
    """
    shape, n = traction.shape[:-2], len(faces.z)
    normal, shear, lateral = np.moveaxis(traction.reshape(-1, 3, n), 1, 0)
    opening, across = faces.opening[:n, :n], faces.opening[:n, n:]
    sliding, along = faces.opening[n:, n:], faces.opening[n:, :n]
    coupled = bool(np.abs(across).max() > 1e-9 * np.abs(opening).max())
    size = np.hypot(shear, lateral)
    part = np.divide(np.abs(shear), size, out=np.full_like(shear, np.sqrt(0.5)), where=size > 0)
    rest = np.sqrt(1 - part**2)
    pressure, rubbing = np.zeros_like(normal), np.zeros_like(shear)
    left, settled = np.arange(len(normal)), np.ones(len(normal), dtype=bool)
    for _ in range(_TURNS):
        # Displacement that shear makes counts as normal traction that would make it, and the other way round.
        opening_load, beside = normal[left], shear[left]
        push = (
            opening_load + np.linalg.solve(opening, across @ (beside - rubbing[left]).T).T
            if coupled
            else opening_load
        )
        pressed = -bounded(opening, push, np.full_like(push, -np.inf), np.zeros_like(push))
        limit = friction * pressed * part[left]
        drive = beside + np.linalg.solve(sliding, along @ (opening_load + pressed).T).T if coupled else beside
        rubbed = bounded(sliding, drive, -limit, limit)
        change = np.maximum(np.abs(pressed - pressure[left]), np.abs(rubbed - rubbing[left])).max(axis=1)
        pressure[left], rubbing[left] = pressed, rubbed
        if not coupled:
            break
        left = left[change > _SETTLED * np.maximum(np.abs(opening_load), np.abs(beside)).max(axis=1)]
        if not len(left):
            break
    else:
        # Faces that jam have no state that the turns find: without friction they have one.
        settled[left] = False
        push = normal[left] + np.linalg.solve(opening, across @ shear[left].T).T
        pressure[left] = -bounded(opening, push, np.full_like(push, -np.inf), np.zeros_like(push))
        rubbing[left] = 0.0
    limit = friction * pressure * rest * settled[:, None]
    rubbed = bounded(faces.tearing, lateral, -limit, limit)
    plane = np.concatenate([normal + pressure, shear - rubbing], axis=1) @ faces.plane.T
    # Where the faces touch up to the tip nothing opens there but what round-off leaves.
    first = np.where(pressure[:, -1] > 0, 0.0, np.maximum(plane[:, 0], 0.0))
    modes = np.stack([first, plane[:, 1], (lateral - rubbed) @ faces.antiplane], axis=1)
    return modes.reshape(*shape, 3), settled.reshape(shape)


def bounded(compliance: Array, traction: Array, low: Array, high: Array) -> Array:
    """Tractions f (m, n) within low and high: u = G (σ - f) is zero inside, >= 0 at high, <= 0 at low.

    compliance: G (n, n), of positive principal minors. traction: σ (m, n). low <= high, which may be infinite.
    Method: primal-dual active sets (Hintermüller, Ito and Kunisch 2002), row by row of σ.
    Raises ArithmeticError.
    """
    bounded_traction = np.clip(traction, low, high)
    scale = np.abs(traction).max(axis=1, initial=0.0)
    # Most rows hold everywhere or nowhere.
    free = (traction <= high) & (traction >= low)
    apart = ((traction @ compliance.T) >= 0).all(axis=1) & (not high.any() and not np.isfinite(low).any())
    bounded_traction[apart] = 0.0
    rows = np.flatnonzero(~free.all(axis=1) & ~apart & (scale > 0))
    for start in range(0, len(rows), _TOGETHER):
        batch = rows[start : start + _TOGETHER]
        bounded_traction[batch] = _active(compliance, traction[batch], low[batch], high[batch], scale[batch])
    return bounded_traction


def _active(compliance: Array, traction: Array, low: Array, high: Array, scale: Array) -> Array:
    n = len(compliance)
    pace = 1 / np.diag(compliance).mean()
    moved = traction @ compliance.T
    force = np.clip(traction, low, high)
    upper, lower = traction > high, traction < low
    left = np.arange(len(traction))
    for _ in range(_STEPS):
        above, below = upper[left], lower[left]
        bound = np.where(above, high[left], np.where(below, low[left], 0.0))
        free = ~(above | below)
        # Of what is held the displacement is zero, of the rest the force is known.
        matrix = np.where(free[:, :, None], compliance, np.eye(n))
        right = np.where(free, moved[left], bound)
        solution = np.linalg.solve(matrix, right[:, :, None])[:, :, 0]
        slip = np.where(free, 0.0, moved[left] - solution @ compliance.T)
        trial = solution + pace * slip
        edge = 1e-12 * scale[left, None]
        new_upper, new_lower = trial > high[left] + edge, trial < low[left] - edge
        # At a bound with no displacement either set will do: keep that in which it is.
        new_upper |= above & (trial >= high[left] - edge)
        new_lower |= below & (trial <= low[left] + edge) & ~new_upper
        force[left] = solution
        done = (new_upper == above).all(axis=1) & (new_lower == below).all(axis=1)
        upper[left], lower[left] = new_upper, new_lower
        left = left[~done]
        if not len(left):
            return np.clip(force, low, high)
    for row in left:
        force[row] = _one_by_one(compliance, traction[row], low[row], high[row], float(scale[row]))
    return np.clip(force, low, high)


def _one_by_one(compliance: Array, traction: Array, low: Array, high: Array, scale: float) -> Array:
    """One row by projected Gauss-Seidel sweeps, which cannot cycle."""
    force = np.clip(traction, low, high)
    diagonal = np.diag(compliance)
    for _ in range(20_000):
        before = force.copy()
        for k in range(len(force)):
            slip = compliance[k] @ (traction - force)
            force[k] = np.clip(force[k] + slip / diagonal[k], low[k], high[k])
        if np.abs(force - before).max() <= 1e-9 * scale:
            return force
    raise ArithmeticError(
        f"the pressure on a crack's faces did not settle under a traction of {scale:.3g} Pa; report this case"
    )
