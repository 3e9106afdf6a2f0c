"""Gross sliding: the point about which a contact turns where every cell slips, and the moment that friction gives."""

from __future__ import annotations

import numpy as np

from treadload.contact.solvers.tangential import Axes
from treadload.kernels.arrays import Array

_MOST_STEPS = 500


def sliding_pole(bound: Array, x: Array, y: Array, axes: Axes = (1.0, 1.0)) -> tuple[float, float]:
    """Point (x, y), m, about which a contact turns when it slides without a force along the road.

    bound: μp (ny, nx), Pa, at x (nx,), y (ny,), m. axes: of the friction ellipse. It is the point with the least
    `sliding_torque`, which is a convex function of it.
    Method: Weiszfeld (1937), Tohoku Math. J. 43, 355-386.
    """
    if not bound.any():
        return 0.0, 0.0
    # Slip along x comes from the arm across it, and the other way round.
    along, across = x[None, :] * axes[1], y[:, None] * axes[0]
    centre = np.zeros(2)
    # Half a cell under the pole keeps its weight finite.
    soft = 0.5 * min(_spacing(along[0]), _spacing(across[:, 0]))
    for _ in range(_MOST_STEPS):
        weight = bound / np.maximum(np.hypot(along - centre[0], across - centre[1]), soft)
        mean = np.array([(weight * along).sum(), (weight * across).sum()]) / weight.sum()
        moved, centre = np.abs(mean - centre).max(), mean
        if moved < 1e-9 * soft:
            break
    return float(centre[0] / axes[1]), float(centre[1] / axes[0])


def sliding_torque(
    bound: Array, x: Array, y: Array, cell_area: float, pole: tuple[float, float], axes: Axes = (1.0, 1.0)
) -> float:
    """∫ μp r dA, N m: the largest moment about a point that friction can give.

    bound: μp (ny, nx), Pa, at x (nx,), y (ny,), m, on cells of cell_area, m². pole: (x, y), m.
    axes: of the friction ellipse, which stretches the arms.
    """
    arm = np.hypot(axes[1] * (x[None, :] - pole[0]), axes[0] * (y[:, None] - pole[1]))
    return float((bound * arm).sum()) * cell_area


def _spacing(positions: Array) -> float:
    return float(np.ptp(positions)) / (positions.size - 1) if positions.size > 1 else np.inf
