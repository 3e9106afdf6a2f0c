"""Checks of layers at one wavenumber: extended precision, reciprocity, continuity, springs."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from treadload.kernels.layers.layered import Stack, transfer
from treadload.validation.check import Check, absolute

_INF = math.inf
# Stack; wavenumber, 1/m: k·u of i u_k under i f_k = 1, of i u_k under f_z = 1 and of u_z under f_z = 1, 1/Pa.
_EXTENDED: dict[str, tuple[Stack, dict[float, tuple[float, float, float]]]] = {
    "ν = 0.5 throughout": (
        Stack([2e9, 1e8, 2e7], [0.5] * 3, [0.1, 0.3], [_INF] * 2),
        {
            0.01: (2.0346057285752696e-08, -3.4974487829619994e-12, 2.4999993900259833e-08),
            1.0: (1.1985843026847104e-09, -1.4765722156140276e-09, 2.2313719261653388e-08),
            50.0: (2.5084560263324414e-10, -1.0312237566069243e-12, 2.5125809213588683e-10),
        },
    ),
    "200 layers": (
        Stack(
            [*(1e9 * (1 + i % 7) for i in range(200)), 1e8],
            [*(0.1 + 0.05 * (i % 9) for i in range(200)), 0.4],
            [0.01] * 200,
            [_INF] * 200,
        ),
        {
            0.1: (4.926552312205783e-10, -5.931639461666954e-10, 5.3976721180179925e-09),
            5.0: (2.606975568346189e-10, -7.362258048059712e-11, 2.546370468543327e-10),
        },
    ),
    "contrast of 1e6": (
        Stack([1e10, 1e4], [0.3, 0.45], [0.2], [_INF]),
        {
            0.01: (1.7552172078282424e-08, -5.6069939904548234e-08, 5.4479038157805845e-05),
            1.0: (7.013528700537839e-10, -5.236863660296043e-09, 5.2869837315517854e-08),
            50.0: (7.00000522295299e-11, -2.000005771218772e-11, 7.000006377196743e-11),
        },
    ),
    "contrast of 1e-6": (
        Stack([1e4, 1e10], [0.3, 0.2], [0.2], [_INF]),
        {
            0.01: (2.0007931927079688e-07, -1.5199866536439838e-12, 5.722282196248815e-08),
            1.0: (1.923697127095252e-05, 2.607964067820992e-07, 5.7297396282759605e-06),
        },
    ),
    "a layer of 1 mm": (
        Stack([3e9, 1e6, 3e9, 2e7], [0.35, 0.49, 0.35, 0.4], [0.05, 1e-3, 0.15], [_INF] * 3),
        {
            0.01: (1.9326348454715843e-08, -3.245567283004063e-09, 2.9692758250145673e-08),
            1.0: (1.1381481951708663e-09, -2.004017771693977e-09, 2.4475366355046807e-08),
            50.0: (2.3926297950723496e-10, -8.371112021578002e-11, 2.672634508095851e-10),
        },
    ),
    "springs": (
        Stack([3e9, 6e9, 2e7], [0.35, 0.25, 0.4], [0.06, 0.15], [1e9, 1e10]),
        {
            0.01: (1.592312861771184e-08, -2.6864101417977524e-09, 2.9599823216101203e-08),
            1.0: (9.912099496642442e-10, -2.0330921798470926e-09, 2.2907146628080742e-08),
            50.0: (2.1836229270033145e-10, -5.2981086603694196e-11, 2.2172394590252082e-10),
        },
    ),
}
_SPRUNG = Stack([3e9, 6e9, 1e8, 2e7], [0.35, 0.25, 0.5, 0.4], [0.06, 0.15, 0.3], [1e9, 0.0, _INF])


def wave_checks() -> Iterator[Check]:
    """Six difficult stacks, and what holds on every one with slip."""
    for name, (stack, rows) in _EXTENDED.items():
        plane = transfer(list(rows), stack, [0.0], [False]).plane[0, :2]
        exact = np.array(list(rows.values())).T
        errors = np.abs(np.stack([plane[0, 0], plane[0, 1], plane[1, 1]]) - exact).max(axis=0)
        worst = float((errors / np.abs(exact).max(axis=0)).max())
        what = f"{name}: displacement of the surface, worst relative error"
        yield absolute("layers, one wave", what, worst, 0, 1e-9, "matrix exponential, 40 digits and more (mpmath)")
    k = np.geomspace(1e-3, 2e3, 40)
    depths, below = [0.0, 0.06, 0.06, 0.21, 0.21, 0.51, 0.51], [False, *[False, True] * 3]
    result = transfer(k, _SPRUNG, depths, below)
    surface = result.plane[0, :2]
    worst = float((np.abs(surface[0, 1] - surface[1, 0]) / np.abs(surface).max(axis=(0, 1))).max())
    group = "layers that slide, one wave"
    yield absolute(group, "settlement by shear less slide by pressure, relative", worst, 0, 1e-10, "Betti")
    above, under = result.plane[1::2], result.plane[2::2]
    # Of unit loads: waves that have died out before the interface leave nothing to compare.
    worst = float(np.abs(above[:, 2:] - under[:, 2:]).max())
    yield absolute(group, "traction across 3 interfaces, above less below", worst, 0, 1e-10, "equilibrium")
    slide = (above[0, 0] - under[0, 0]) / k
    size = np.abs(above[0, 0]) / k * _SPRUNG.spring[0] + np.abs(above[0, 2])
    worst = float((np.abs(above[0, 2] - _SPRUNG.spring[0] * slide) / size).max())
    yield absolute(group, "τ less k_s [u] over their size", worst, 0, 1e-10, "Goodman, Taylor & Brekke (1968)")
    worst = float(max(np.abs(above[1, 2]).max(), np.abs(result.transverse[3, 1]).max()))
    yield absolute(group, "shear through a frictionless interface", worst, 0, 1e-10, "its definition")
