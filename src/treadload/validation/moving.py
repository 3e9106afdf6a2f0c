"""Checks of loads that move over viscoelastic roads: ELLVA, the limits of speed, the energy dissipated."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from treadload.kernels.arrays import Array
from treadload.materials import Elastic, PowerLawCreep, Prony
from treadload.pavement import Layer, Pavement
from treadload.response import UniformDisc, UniformRectangle, solve_response
from treadload.validation.check import Check, absolute, relative

_KINDS = (
    tuple(f"stress_{c}" for c in ("xx", "yy", "zz", "xy", "xz", "yz")),
    tuple(f"strain_{c}" for c in ("xx", "yy", "zz", "xy", "xz", "yz")),
    tuple(f"displacement_{c}" for c in "xyz"),
)
_SOLID = Prony(8e9, ((0.5, 0.02), (0.4, 0.3)), 0.35)
_BASE, _SOIL = Elastic(2e8, 0.3), Elastic(5e7, 0.4)


def moving_checks() -> Iterator[Check]:
    """Deflection of ELLVA's road, elastic limits, energy against the work along the path."""
    yield from _ellva()
    yield from _limits()
    yield from _energy()


def _ellva() -> Iterator[Check]:
    """60 km/h, 0.3 m beside the path, 50 mm behind the load."""
    mix = PowerLawCreep(2.5e-11, 1e-8, 1000.0, 0.35, 0.3)
    road = Pavement([Layer(mix, 0.15), Layer(Elastic(2e8, 0.35), 0.6), Layer(Elastic(4e7, 0.4))])
    places = [-0.05, -0.2, 0.2]
    solved = solve_response(UniformDisc(0.15, 1.1e6), road, depths=[0.0], x=places, y=[0.3], speed=60 / 3.6)
    moved = solved.dataset["displacement_z"].to_numpy().ravel() * 1e3
    source = "steady state, computed apart from the package with a prototype of the theory"
    group = "ELLVA, 60 km/h"
    yield relative(group, "largest deflection, mm", moved[0], 0.7975, 1e-4, source)
    # Quasi-elastic steps of 50 mm along a finite path: up to 2 % on the flanks.
    for where, value, printed in zip(("behind", "ahead of"), moved[1:], (0.774, 0.728), strict=True):
        what = f"deflection 200 mm {where} the load, mm"
        yield relative(group, what, value, printed, 0.025, "ELLVA (Levenberg), tables of its validation in ALVA")


def _road(top: Prony | Elastic) -> Pavement:
    return Pavement([Layer(top, 0.08), Layer(_BASE, 0.2), Layer(_SOIL)])


def _limits() -> Iterator[Check]:
    load = UniformRectangle(0.18, 0.14, 6e5, traction_x=2e5, traction_y=-1e5)
    points: dict[str, Any] = {"depths": [0.0, 0.004, 0.07, 0.15], "x": [-0.1, 0.0, 0.013], "y": [0.0, 0.05]}
    for speed, words, limit in ((1e-9, "1 nm/s", _SOLID.rubbery), (1e9, "1e9 m/s", _SOLID.glassy)):
        moved = solve_response(load, _road(_SOLID), speed=speed, **points).dataset
        fixed = solve_response(load, _road(limit), **points).dataset
        worst = 0.0
        for names in _KINDS:
            values, reference = (np.stack([data[name].to_numpy() for name in names]) for data in (moved, fixed))
            worst = max(
                worst, float((np.abs(values - reference).max((0, 2, 3)) / np.abs(reference).max((0, 2, 3))).max())
            )
        what = f"{words}: 15 fields at 4 depths, error over the largest value"
        yield absolute("limits of speed", what, worst, 0, 1e-6, "elastic layers at that limit")


def _energy() -> Iterator[Check]:
    """What a passage dissipates is ∮ σ dε at a fixed point."""
    road = _road(_SOLID)
    load = UniformRectangle(0.18, 0.14, 6e5, traction_x=1e5)
    # 5 mm apart at the load, farther at a distance.
    x = 0.12 * np.sinh(np.linspace(-4.6, 4.0, 161))
    data = solve_response(load, road, depths=[0.07], x=x, y=[0.03], speed=10.0).dataset
    stress, strain = (np.stack([data[name].to_numpy()[:, 0] for name in names]) for names in _KINDS[:2])
    work = _work(stress, strain, x)
    dissipated = data["dissipated_energy"].to_numpy()[:, 0]
    for depth, value, reference in zip((70,), dissipated, work, strict=True):
        what = f"{depth} mm deep, 10 m/s, J/m³"
        # Differences and the trapezoidal rule on 161 points.
        yield relative("energy of a passage", what, value, reference, 5e-3, "∮ σ dε along the path")
    points: dict[str, Any] = {"depths": [0.07], "x": [0.0], "y": np.linspace(-0.3, 0.3, 7)}
    least = min(
        float(solve_response(load, road, speed=speed, **points).dataset["dissipated_energy"].min())
        for speed in (0.1, 30.0)
    )
    yield absolute(
        "energy of a passage", "below zero, 7 places x 2 speeds, J/m³", min(least, 0.0), 0, 0, "second law"
    )


def _work(stress: Array, strain: Array, x: Array) -> Array:
    """-∫ σ : dε/dx dx, (nz,), of (6, nz, nx): a fixed point sees x fall."""
    twice = np.array([1, 1, 1, 2, 2, 2])[:, None, None]
    slope = np.gradient(strain, x, axis=-1, edge_order=2)
    return np.asarray(-np.trapezoid((twice * stress * slope).sum(axis=0), x, axis=-1))
