"""Influence of pressure and shear on a half-space as dense matrices: sums over pairs of cells, without a transform.

Closed forms of Love (1929) and Johnson (1985), section 3.2, in their logarithms, written anew: nothing of the package
is called. Signs and combined constants as in `treadload.kernels.half_space.rectangle`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class DirectSums:
    """Matrices of a patch of (ny, nx) cells of dx by dy, m; G, Pa, ν and K of both bodies.

    Fields are flattened: n = ny nx values of pressure, 2 n of shear, x before y.
    """

    shape: tuple[int, int]
    dx: float
    dy: float
    shear_modulus: float
    poisson: float
    difference: float

    @cached_property
    def opening_by_pressure(self) -> Array:
        """(n, n), m/Pa."""
        along_x, along_y, *_ = self._integrals(0.0)
        return (1 - self.poisson) * (along_x + along_y) / (np.pi * self.shear_modulus)

    @cached_property
    def opening_by_shear(self) -> Array:
        """(n, 2 n), m/Pa."""
        *_, by_x, by_y = self._integrals(0.0)
        return np.hstack([by_x, by_y]) * self.difference / (np.pi * self.shear_modulus)

    def displacement(self, ahead: float) -> tuple[Array, Array]:
        """u (2 n) by shear (2 n, 2 n) and by pressure (2 n, n), m/Pa, at a distance ahead of the cells, m."""
        along_x, along_y, cross, by_x, by_y = self._integrals(ahead)
        nu = self.poisson
        by_shear = np.block([[(1 - nu) * along_x + along_y, nu * cross], [nu * cross, along_x + (1 - nu) * along_y]])
        scale = 1 / (np.pi * self.shear_modulus)
        return scale * by_shear, -scale * self.difference * np.vstack([by_x, by_y])

    def _integrals(self, ahead: float) -> tuple[Array, Array, Array, Array, Array]:
        """Over a cell: y²/r³, x²/r³, x y/r³, x/r² and y/r², (n, n): field cells by loaded cells."""
        ny, nx = self.shape
        y, x = (one.ravel() for one in np.mgrid[:ny, :nx])
        middle_x = self.dx * (x[:, None] - x[None, :]) + ahead
        middle_y = self.dy * (y[:, None] - y[None, :])
        sums = [np.zeros_like(middle_x) for _ in range(5)]
        for side_x, side_y in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
            corner = middle_x + side_x * self.dx / 2, middle_y + side_y * self.dy / 2
            for total, form in zip(sums, _forms(*corner), strict=True):
                total += side_x * side_y * form
        return sums[0], sums[1], sums[2], sums[3], sums[4]


def _forms(x: Array, y: Array) -> tuple[Array, Array, Array, Array, Array]:
    r = np.hypot(x, y)
    log_r = np.log(np.where(r > 0, r, 1.0))
    by_x = y * log_r + x * np.arctan2(y * np.sign(x), np.abs(x))
    by_y = x * log_r + y * np.arctan2(x * np.sign(y), np.abs(y))
    return _logarithm(x, y, r), _logarithm(y, x, r), -r, by_x, by_y


def _logarithm(a: Array, b: Array, r: Array) -> Array:
    """a ln(b + r), zero where a is."""
    size = np.where(a == 0, 1.0, np.abs(a))
    # Where b < 0 the sum b + r cancels.
    sum_of = np.where(b >= 0, b + r, size**2 / np.where(b >= 0, 1.0, r - b))
    return a * np.log(np.where(a == 0, 1.0, sum_of))
