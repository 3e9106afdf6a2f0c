"""Checks of what yields: return maps, first yield under a sphere, and the surface above endless bars."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from scipy.optimize import minimize_scalar

from treadload.contact import solve_indentation
from treadload.grid import Grid
from treadload.kernels.eigenstrain.operator import moved_by_endless
from treadload.kernels.plasticity.state import State
from treadload.materials import Elastic, ElastoPlastic, MohrCoulomb, VonMises
from treadload.pavement import Layer, Pavement
from treadload.response import GridLoad, roll_drum, roll_passes
from treadload.response.passes.box import Box
from treadload.response.passes.limits import limit_loads
from treadload.response.passes.surface import surface_profile
from treadload.tire import Tire, TreadProfile
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
    yield _at_rest()
    yield _surface()
    yield from _pressed()
    yield from _drum()


def _sphere() -> GridLoad:
    """Pressure of a sphere, 1 MPa at most, on a radius of 1 m."""
    grid = Grid.centred(2.1, 2.1, 2.1 / 64)
    radius = grid.x[None] ** 2 + grid.y[:, None] ** 2
    return GridLoad(grid, 1e6 * np.sqrt(np.clip(1 - radius, 0, None)))


def _at_rest() -> Check:
    law = VonMises(1e6, kinematic=2e7)
    _, factor, _ = limit_loads(_sphere(), Pavement.half_space(ElastoPlastic(_ELASTIC, law)), spacing=0.1, layers=12)
    return relative(
        "rolling sphere",
        "peak pressure over k at the limit of shakedown",
        factor * 3**0.5,
        4.68,
        0.02,
        "Johnson (1985)",
    )


def _first_yield() -> Check:
    def along_axis(z: float) -> float:
        down = -1 / (1 + z * z)
        return -abs(down + (1 + _ELASTIC.poisson) * (1 - z * math.atan(1 / z)) + 0.5 * down)

    exact = 1 / -float(minimize_scalar(along_axis, bounds=(0.2, 1.0), method="bounded").fun)
    road = Pavement.half_space(ElastoPlastic(_ELASTIC, VonMises(1e6)))
    factor = roll_passes(_sphere(), road, passes=1, spacing=0.05).dataset.attrs["elastic_load_factor"]
    return relative("rolling sphere", "peak pressure over yield stress at first yield", factor, exact, 0.01, "Hertz")


def _pressed() -> Iterator[Check]:
    """A rigid sphere in an almost perfectly plastic half-space."""
    soft, strength, radius, source = Elastic(1000.0, 0.3), 2.0, 100.0, "Kogut and Etsion (2002)"
    peak = (0.454 + 0.41 * soft.poisson) * 2.8 * strength
    first = (math.pi * peak * (1 - soft.poisson**2) / (2 * soft.modulus)) ** 2 * radius
    load = 2 / 3 * peak * math.pi * first * radius
    road, times = Pavement.half_space(ElastoPlastic(soft, VonMises(strength, hardening=1.0))), (3.0, 5.0)
    size, cells = math.sqrt(first * radius) * times[-1] ** (1 / 3), 24
    cell = 2.7 * size / cells
    across = (np.arange(cells) - (cells - 1) / 2) * cell
    ball = Tire.from_height_map(
        (across[None] ** 2 + across[:, None] ** 2) / (2 * radius), cell, material=Elastic(1e9, 0.3)
    )
    done = solve_indentation(ball, road, [share * load for share in times], depth=2 * size, layers=10).dataset
    for share, deep in zip(times, done["approach"].to_numpy() / first, strict=True):
        # Their fits of finite elements are good to 2 or 3 %.
        what = f"load over that of first yield at the depth found under {share:g}"
        yield relative("indentation", what, share, 1.03 * deep**1.425, 0.04, source)


def _drum() -> Iterator[Check]:
    """A rigid ball that rolls just below the load of first yield: Hertz' contact, and no rut."""
    radius, soil = 1.0, Elastic(100e6, 0.35)
    road = Pavement.half_space(ElastoPlastic(soil, VonMises(0.4e6)))
    ball = Tire.from_profile(
        TreadProfile(rolling_radius=radius, crown_radius=radius, width=0.06), material=Elastic(1e15, 0.3)
    )
    plane = soil.modulus / (1 - soil.poisson**2)
    peak = 1.55 * 0.4e6
    load = (math.pi * peak) ** 3 * radius**2 / (6 * plane**2)
    done = roll_drum(ball, road, load, passes=1, spacing=(2e-3, 2e-3), layers=6).dataset
    sinks = (9 * load**2 / (16 * radius * plane**2)) ** (1 / 3)
    # On twelve cells of contact.
    yield relative("rolling drum", "peak pressure, Pa", float(done["peak_pressure"][0]), peak, 0.01, "Hertz")
    yield relative("rolling drum", "approach, m", float(done["approach"][0]), sinks, 0.01, "Hertz")
    yield absolute(
        "rolling drum", "rut below first yield, m", float(done["rut_depth"][0]), 0, 0, "first yield at 1.60 Y"
    )


def _surface() -> Check:
    box = Box(2, 16, 0.1, 0.1, 0.0, -0.75, np.array([0, 0.1, 0.25, 0.5]))
    strain = np.random.default_rng(2).standard_normal((6, 3, 16))
    exact = moved_by_endless(box.cells, 0.3)(strain[..., None])[2, 0, :, 0]
    halves = Pavement([Layer(_ELASTIC, 0.2), Layer(Elastic(1e9 * (1 + 1e-9), 0.3))])
    worst = float(np.abs(surface_profile(strain, box, halves, box.y) - exact).max() / np.abs(exact).max())
    what = "surface above bars in two equal layers, error over the largest"
    return absolute("rut by Betti's theorem", what, worst, 0, 1e-7, "closed form of a half-space")
