"""Axes and colours of results of studies: logarithmic values and their ticks, maps of colours."""

from __future__ import annotations

import numpy as np
from matplotlib.colors import ListedColormap

from treadload.plots.kit.style import measure, power_of_ten, sequential


def is_logarithmic(x: np.ndarray) -> bool:
    """True of values that were chosen evenly in their logarithms, over more than a decade."""
    if len(x) < 3 or not (x > 0).all() or x.max() < 10 * x.min():
        return False
    steps = np.diff(np.log(np.sort(x)))
    return bool(np.ptp(steps) < 0.2 * steps.mean())


def logarithmic_tick(value: float, _: object = None) -> str:
    """A number of a logarithmic axis: 0.5, 20, 5×10⁷."""
    return measure(value) if 1e-2 < value < 1e4 else power_of_ten(value).replace(".0×", "×").removeprefix("1×")


def solid(name: str) -> ListedColormap:
    """A sequential map of which no value is as light as paper, which means that there is none."""
    return ListedColormap(sequential(name)(np.linspace(0.12, 1.0, 256)))
