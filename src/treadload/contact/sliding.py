"""Gross sliding: every cell slips, and the shear opposes the rigid slip wherever it points."""

from __future__ import annotations

import numpy as np

from treadload.kernels.arrays import Array

_MOST_STEPS = 500


def sliding_shear(bound: Array, rigid: Array) -> Array:
    """Shear (2, ny, nx) on body 1, Pa, where the whole contact slides: q = -μp w/|w|.

    bound: μp (ny, nx), Pa. rigid: direction of the slip w (2, ny, nx), of any size; no shear where it vanishes.
    The limit of rolling, shifting and turning when the rigid slip outgrows what the bodies can give way.
    """
    size = np.hypot(rigid[0], rigid[1])
    shear: Array = -rigid * np.divide(bound, size, out=np.zeros_like(bound), where=size > 0)
    return shear


def sliding_pole(bound: Array, x: Array, y: Array) -> tuple[float, float]:
    """Point (x, y), m, about which a contact turns when it slides without a force along the road.

    bound: μp (ny, nx), Pa, at x (nx,), y (ny,), m. It is the point with the least friction moment, which is a
    convex function of it. Method: Weiszfeld (1937), Tohoku Math. J. 43, 355-386, by its mean of weights.
    """
    pole = np.zeros(2)
    if not bound.any():
        return 0.0, 0.0
    across, along = np.meshgrid(y, x, indexing="ij")
    # Half a cell keeps the weight of the cell under the pole finite, as its area does.
    soft = 0.5 * min(np.ptp(x) / max(1, x.size - 1) or np.inf, np.ptp(y) / max(1, y.size - 1) or np.inf)
    soft = soft if np.isfinite(soft) else 0.0
    for _ in range(_MOST_STEPS):
        weight = bound / np.maximum(np.hypot(along - pole[0], across - pole[1]), max(soft, np.finfo(float).tiny))
        moved = np.array([(weight * along).sum(), (weight * across).sum()]) / weight.sum() - pole
        pole += moved
        if np.hypot(*moved) < 1e-9 * max(np.ptp(x), np.ptp(y)):
            break
    return float(pole[0]), float(pole[1])


def sliding_torque(bound: Array, x: Array, y: Array, cell_area: float, pole: tuple[float, float]) -> float:
    """∫ μp r dA, N m: the largest moment about a point that friction can give.

    bound: μp (ny, nx), Pa, at x (nx,), y (ny,), m, on cells of cell_area, m². pole: (x, y), m.
    """
    arm = np.hypot(x[None, :] - pole[0], y[:, None] - pole[1])
    return float((bound * arm).sum()) * cell_area
