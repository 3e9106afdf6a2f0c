"""Size of the cells of a height map, as a user gives it."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from treadload.errors import InputError


def cell_of(spacing: float | Sequence[float] | None) -> tuple[float, float] | None:
    """(dx, dy) in m of a spacing given once or twice."""
    if spacing is None:
        return None
    try:
        values = tuple(float(value) for value in np.atleast_1d(np.asarray(spacing, dtype=np.float64)))
    except (TypeError, ValueError):
        values = ()
    if len(values) not in (1, 2) or not all(math.isfinite(v) and v > 0 for v in values):
        raise InputError(f"spacing must be a positive number of m, or (dx, dy), got {spacing!r}")
    return values[0], values[-1]
