"""Which place of a field is named as that of its largest value, where round-off cannot decide."""

from __future__ import annotations

from typing import Any

import numpy as np

from treadload.kernels.arrays import Array

ALIKE = 1e-6
"""Values that differ by less than this part of the largest are equally large."""


def index_of_largest(values: Array, *, horizontal: int = 2, alike: float = ALIKE) -> tuple[int, ...]:
    """Index of the largest value of a field; of several that are equally large, a rule chooses the place.

    The tire is symmetric, and so are its two mirror places: round-off would choose between them. Among the values
    within `alike` of the largest, relative to its magnitude, the place is the one with the largest y, then with the
    largest x; of several depths (or other leading axes) the first counts, which is the shallowest.

    values: (..., y, x), whose coordinates rise along both. horizontal: how many of the last axes are y and x; 1 for a
    section over (depth, y) and for a line over y. NaN does not count; where there is nothing else, the index is that
    of the first value.
    """
    if not np.size(values):
        return (0,) * np.ndim(values)
    numbers: Array = np.where(np.isnan(values), -np.inf, values)
    largest = float(numbers.max())
    if largest == -np.inf:
        return (0,) * numbers.ndim
    slack = alike * abs(largest) if np.isfinite(largest) else 0.0
    first = numbers.ndim - min(horizontal, numbers.ndim)
    turned = (*(slice(None),) * first, *(slice(None, None, -1),) * (numbers.ndim - first))
    near: Any = (numbers >= largest - slack)[turned]
    at = [int(k) for k in np.unravel_index(int(near.argmax()), near.shape)]
    return tuple(k if axis < first else numbers.shape[axis] - 1 - k for axis, k in enumerate(at))
