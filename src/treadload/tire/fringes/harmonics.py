"""What the steps leave over: the harmonics of the fringe, which all pixels share, and the noise."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from treadload.kernels.arrays import Array, BoolArray
from treadload.tire.fringes.steps import FEWEST, Steps, even_shifts

# Harmonics that a gamma makes worth telling from noise, and pixels that are enough to do it.
_HARMONICS, _ENOUGH = (2, 3, 4), 40_000


def leftovers(
    pictures: Array, steps: Steps, shifts: Sequence[float] | None, use: BoolArray
) -> tuple[float, float, float]:
    """Second harmonic over the first, standard deviation of a grey level, and of the ratio; NaN of three steps.

    pictures: (n, rows, columns), grey levels, and what `solve_steps` made of them. use: (rows, columns), pixels in
    light that lost no step. Harmonics of a gamma have one ratio to the fringe in all pixels and stand at its phase:
    a handful of numbers is fitted to what all pixels leave over, and the rest is noise.
    """
    count = len(pictures)
    if count <= FEWEST or not use.any():
        return np.nan, np.nan, np.nan
    delta = even_shifts(count) if shifts is None else np.asarray(shifts, dtype=float)
    where = np.nonzero(use.ravel())[0]
    where = where[:: max(1, len(where) // _ENOUGH)]
    phase, size = steps.phase.ravel()[where], steps.modulation.ravel()[where]
    grey = pictures.reshape(count, -1)[:, where].astype(np.float64)
    design = np.stack([np.ones(count), np.cos(delta), -np.sin(delta)], axis=1)
    rest = np.eye(count) - design @ np.linalg.pinv(design)
    left = (rest @ grey).ravel()
    shapes = np.stack(
        [(rest @ (size * np.cos(order * (phase + delta[:, None])))).ravel() for order in _HARMONICS], axis=1
    )
    normal = shapes.T @ shapes
    ratios = np.linalg.lstsq(normal, shapes.T @ left, rcond=1e-6)[0]
    noise = float(np.sqrt(((left - shapes @ ratios) ** 2).sum() / ((count - FEWEST) * len(where))))
    return float(ratios[0]), noise, noise / float(np.sqrt(max(normal[0, 0], 1e-300)))
