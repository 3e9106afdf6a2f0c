"""Checks of the stress inside the road: discs on their axis, and equilibrium at the surface."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.kernels.half_space.interior import fields_on_grid
from treadload.materials import Elastic
from treadload.pavement import Pavement
from treadload.response import GridLoad, solve_response
from treadload.validation.check import Check, absolute
from treadload.validation.closed_forms import disc_axis_stress, hertz_axis_stress

_CELLS, _FINE = 100, 16
_POISSON = 0.35


def _on_axis(profile: Callable[[Array], Array], depths: Array) -> tuple[Array, Array]:
    """(radial, vertical) stress below the middle of a disc of radius 1, pressure profile(r²), 100 cells across."""
    spacing = 2 / _CELLS
    points = (np.arange(_CELLS * _FINE) + 0.5) / (_CELLS * _FINE) * 2 - 1
    values = profile(points[None, :] ** 2 + points[:, None] ** 2)
    load = np.zeros((3, _CELLS, _CELLS))
    load[0] = values.reshape(_CELLS, _FINE, _CELLS, _FINE).mean((1, 3))
    middle = np.array([1 - spacing / 2])
    stress, *_ = fields_on_grid(load, spacing, spacing, depths, 1.0, _POISSON, middle, middle)
    return stress[:, 0, 0, 0], stress[:, 2, 0, 0]


def stress_checks() -> Iterator[Check]:
    """Axis of a Hertz disc and of a uniform disc from a depth of one cell; the surface itself."""
    zeta = np.array([2 / _CELLS, 0.1, 0.48, 1.0, 3.0])
    for group, profile, exact, source in (
        (
            "stress under a Hertz disc",
            lambda s: np.sqrt(np.maximum(0.0, 1 - s)),
            hertz_axis_stress,
            "Johnson (1985), eq. 3.45",
        ),
        (
            "stress under a uniform disc",
            lambda s: (s < 1).astype(float),
            disc_axis_stress,
            "Ahlvin & Ulery (1962)",
        ),
    ):
        stresses = _on_axis(profile, zeta)
        for name, measured, expected in zip(("radial", "vertical"), stresses, exact(zeta, _POISSON), strict=True):
            for k in (0, int(np.abs(measured - expected).argmax())):
                where = f"{zeta[k]:g} radii" + (" (one cell)" if k == 0 else " (worst of 5)")
                yield absolute(group, f"{name} over peak, depth {where}", measured[k], expected[k], 0.005, source)
                if k == 0 and int(np.abs(measured - expected).argmax()) == 0:
                    break
    random = np.random.default_rng(1)
    p, qx, qy = random.random((3, 12, 15)) * np.array([1e6, 7e5, -4e5])[:, None, None]
    grid = Grid(15, 12, 3e-3, 3e-3, 0.0, 0.0)
    road = Pavement.half_space(Elastic(5.4e9, _POISSON))
    surface = solve_response(GridLoad(grid, p, qx, qy), road, depths=[0.0]).dataset.isel(depth=0)
    pairs = (("stress_zz", p), ("stress_xz", qx), ("stress_yz", qy))
    off = max(float(np.abs(surface[name].to_numpy() + load).max()) for name, load in pairs)
    yield absolute("surface", "largest |σ_z + load| over 1 MPa", off / 1e6, 0, 1e-12, "equilibrium of the surface")
