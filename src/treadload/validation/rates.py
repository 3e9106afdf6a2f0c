"""Checks of the order at which the surface strain under smooth shear converges, cells against bilinear ones."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

import numpy as np
from scipy.integrate import quad
from scipy.special import jv

from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.materials import Elastic
from treadload.pavement import Pavement
from treadload.response import GridLoad, solve_response
from treadload.validation.check import Check, absolute

_ASPHALT = Elastic(5.4e9, 0.35)
_WIDTH, _SHEAR = 0.03, 1e6
# Cells over twelve standard deviations; odd and tripled, so that centres stay centres.
_CELLS = (25, 75, 225)


def _exact(x: Array) -> Array:
    """Strain_xx on the x axis under q_x = q exp(-r²/2s²), by Hankel's integral of the half-space.

    Source: u_x = (1 - ν kx²/k²) q / (G k) in wavenumbers, Johnson (1985), section 3.2.
    """
    nu = _ASPHALT.poisson

    def integrand(k: float, at: float) -> float:
        j1, j3 = jv(1, k * at), jv(3, k * at)
        return float(-(_WIDTH**2) * _SHEAR * np.exp(-((k * _WIDTH) ** 2) / 2) * k * (j1 - nu * (3 * j1 - j3) / 4))

    integrals = [quad(integrand, 0, 9 / _WIDTH, args=(at,), epsrel=1e-11)[0] for at in x]
    return np.array(integrals) / _ASPHALT.shear_modulus


def _errors(interpolation: Literal["constant", "bilinear"]) -> Array:
    """Largest error over the largest strain at centres of the coarsest grid, for each grid."""
    x = np.arange(-4, 5) * 12 * _WIDTH / _CELLS[0]
    exact = _exact(x)
    errors = []
    for n in _CELLS:
        grid = Grid.centred(12 * _WIDTH, 12 * _WIDTH, 12 * _WIDTH / n)
        shear = _SHEAR * np.exp(-(grid.x[None, :] ** 2 + grid.y[:, None] ** 2) / (2 * _WIDTH**2))
        load = GridLoad(grid, 0 * shear, shear, interpolation=interpolation)
        data = solve_response(load, Pavement.half_space(_ASPHALT), depths=0.0, x=x, y=0.0).dataset
        errors.append(np.abs(data["strain_xx"].to_numpy().ravel() - exact).max() / np.abs(exact).max())
    return np.array(errors)


def rate_checks() -> Iterator[Check]:
    """Order one of uniform cells, two of bilinear ones, and their errors at 6 cells per standard deviation."""
    group, source = "surface strain under Gaussian shear", "Johnson (1985), section 3.2, by Hankel's integral"
    for interpolation, rate, bound in (("constant", 1, 0.05), ("bilinear", 2, 0.006)):
        errors = _errors("bilinear" if interpolation == "bilinear" else "constant")
        rates = np.log(errors[:-1] / errors[1:]) / np.log(3)
        worst = rates[int(np.abs(rates - rate).argmax())]
        # The next order fades.
        yield absolute(group, f"{interpolation} cells: order of convergence, worst of 2", worst, rate, 0.12, source)
        what = f"{interpolation} cells of 0.16 standard deviations: error over the largest value"
        yield absolute(group, what, errors[1], 0, bound, source)
