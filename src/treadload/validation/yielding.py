"""Checks of what yields: return maps, first yield under a sphere, and the surface above endless bars."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from scipy.optimize import minimize_scalar

from treadload.grid import Grid
from treadload.kernels.eigenstrain.operator import moved_by_endless
from treadload.kernels.plasticity.state import State
from treadload.materials import Elastic, ElastoPlastic, MohrCoulomb, VonMises
from treadload.pavement import Layer, Pavement
from treadload.response import GridLoad, roll_passes
from treadload.response.passes.box import Box
from treadload.response.passes.surface import surface_profile
from treadload.validation.check import Check, absolute, relative

_ELASTIC = Elastic(1e9, 0.3)


def yielding_checks() -> Iterator[Check]:
    """Yield functions after a return, the first yield of a sphere, Betti's theorem beside closed forms."""
    trial = 1e6 * np.random.default_rng(1).standard_normal((6, 2000))
    for name, law in (
        ("von Mises, hardening", VonMises(1e5, 1e7, 2e7, 20.0)),
        ("Mohr-Coulomb", MohrCoulomb(5e4, 0.6)),
    ):
        back = law.return_map(_ELASTIC)
        before = State.virgin((2000,))
        after = back(trial, before)
        stress = trial - back.elastic(after.strain)
        yields = after.hardening > 0
        worst = float(np.abs(back.excess(stress, after)[yields]).max()) / law.strength
        yield absolute("return maps", f"{name}: yield function over strength", worst, 0, 1e-12, "consistency")
    yield _first_yield()
    yield _surface()


def _first_yield() -> Check:
    def along_axis(z: float) -> float:
        down = -1 / (1 + z * z)
        return -abs(down + (1 + _ELASTIC.poisson) * (1 - z * math.atan(1 / z)) + 0.5 * down)

    exact = 1 / -float(minimize_scalar(along_axis, bounds=(0.2, 1.0), method="bounded").fun)
    grid = Grid.centred(2.1, 2.1, 2.1 / 64)
    radius = grid.x[None] ** 2 + grid.y[:, None] ** 2
    load = GridLoad(grid, 1e6 * np.sqrt(np.clip(1 - radius, 0, None)))
    road = Pavement.half_space(ElastoPlastic(_ELASTIC, VonMises(1e6)))
    found = roll_passes(load, road, passes=1, spacing=0.05).dataset.attrs["elastic_load_factor"]
    return relative("rolling sphere", "peak pressure over yield stress at first yield", found, exact, 0.01, "Hertz")


def _surface() -> Check:
    box = Box(2, 16, 0.1, 0.1, 0.0, -0.75, np.array([0, 0.1, 0.25, 0.5]))
    strain = np.random.default_rng(2).standard_normal((6, 3, 16))
    exact = moved_by_endless(box.cells, 0.3)(strain[..., None])[2, 0, :, 0]
    halves = Pavement([Layer(_ELASTIC, 0.2), Layer(Elastic(1e9 * (1 + 1e-9), 0.3))])
    worst = float(np.abs(surface_profile(strain, box, halves, box.y) - exact).max() / np.abs(exact).max())
    what = "surface above bars in two equal layers, error over the largest"
    return absolute("rut by Betti's theorem", what, worst, 0, 1e-7, "closed form of a half-space")
