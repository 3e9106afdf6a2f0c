"""Layers at one wavenumber against extended precision, by a method that shares no formula with the kernel."""

import math

import mpmath as mp
import numpy as np
import pytest

from treadload.kernels.layered import Stack, transfer


def propagator(k, shear, poisson, thickness):
    """Matrix exponential of the equations of elasticity for (i u_k, u_z, i f_k, f_z)."""
    g, nu = mp.mpf(shear), mp.mpf(poisson)
    grow = mp.matrix(
        [
            [0, k, -1 / g, 0],
            [-k * nu / (1 - nu), 0, 0, -(1 - 2 * nu) / (2 * g * (1 - nu))],
            [-2 * g * k * k / (1 - nu), 0, 0, k * nu / (1 - nu)],
            [0, 0, -k, 0],
        ]
    )
    return mp.expm(grow * mp.mpf(thickness))


def reference(k, stack):
    """Displacement at the surface per unit load, times k, and the force and displacement at the last interface."""
    k = mp.mpf(k)
    g, nu = mp.mpf(stack.shear[-1]), mp.mpf(stack.poisson[-1])
    chi = 3 - 4 * nu
    top = mp.matrix([[1, 0], [1, chi], [2 * g * k, g * k * (chi - 1)], [2 * g * k, g * k * (chi + 1)]])
    bottom = top.copy()
    for layer in reversed(range(len(stack.shear) - 1)):
        spring = stack.spring[layer]
        if math.isfinite(spring):
            # u_above = u_below + F / k_s
            for j in range(2):
                top[0, j] += top[2, j] / mp.mpf(spring)
        top = propagator(k, stack.shear[layer], stack.poisson[layer], -mp.mpf(stack.thickness[layer])) * top
    inverse = top[2:4, :] ** -1
    surface, deep = top[0:2, :] * inverse, bottom * inverse
    return (
        np.array((k * surface).tolist(), float),
        np.array((k * deep[0:2, :]).tolist(), float),
        np.array(deep[2:4, :].tolist(), float),
    )


RANDOM = np.random.default_rng(4)
INF = math.inf
STRUCTURES = {
    "incompressible": Stack([2e9, 1e8, 2e7], [0.5, 0.5, 0.5], [0.1, 0.3], [INF, INF]),
    "200 layers": Stack(
        list(10 ** RANDOM.uniform(7, 9.5, 201)), list(RANDOM.uniform(0.1, 0.5, 201)), [0.01] * 200, [INF] * 200
    ),
    "contrast 1e6": Stack([1e10, 1e4], [0.3, 0.45], [0.2], [INF]),
    "contrast 1e-6": Stack([1e4, 1e10], [0.3, 0.2], [0.2], [INF]),
    "1 mm layer": Stack([3e9, 1e6, 3e9, 2e7], [0.35, 0.49, 0.35, 0.4], [0.05, 1e-3, 0.15], [INF] * 3),
    "springs": Stack([3e9, 6e9, 2e7], [0.35, 0.25, 0.4], [0.06, 0.15], [1e9, 1e10]),
}


@pytest.mark.parametrize("name", STRUCTURES)
def test_against_extended_precision(name):
    stack = STRUCTURES[name]
    total = sum(stack.thickness[: len(stack.shear) - 1])
    wavenumbers = [1e-3, 0.1, 1.0, 10.0, 50.0] if total < 1 else [0.1, 5.0]
    result = transfer(wavenumbers, stack, [0.0, total], [False, True])
    for i, k in enumerate(wavenumbers):
        # Digits lost by the propagators: e^(2 k H); 40 remain.
        with mp.workdps(40 + int(k * total)):
            surface, moved, force = reference(k, stack)
        for rows, index, exact in ((slice(0, 2), 0, surface), (slice(0, 2), 1, moved), (slice(2, 4), 1, force)):
            error = np.abs(result.plane[index, rows, :, i] - exact).max() / np.abs(exact).max()
            # The bound of the method: 1e-9.
            assert error < 1e-9, (k, rows, index, error)
