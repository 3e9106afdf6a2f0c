"""Rigid discs on layers, without friction, by an integral equation on their radius: no cells, no Fourier grid.

N(k) is k times the displacement under a pressure wave, N∞ its limit. With p̄(k) = ∫ φ(t) cos kt dt the pressure
vanishes outside of the radius a; the displacement u(r) inside asks for

    φ(t) + 1/π ∫ φ(s) [K(t - s) + K(t + s)] ds = 2/(π N∞) d/dt ∫ r u(r)/√(t² - r²) dr,  K(u) = ∫ (N/N∞ - 1) cos ku dk

and the load is 2π ∫ φ dt.

Source: Lebedev & Ufliand (1958), J. Appl. Math. Mech. 22, 442-450.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from treadload.kernels.arrays import Array
from treadload.kernels.layers.images import half_space_compliance, surface_compliance
from treadload.kernels.layers.layered import Stack

_NODES = 48


def sphere_on_layers(stack: Stack, radius: float, curvature: float) -> tuple[float, float]:
    """Load, N, and approach, m, of a rigid paraboloid r²/2R that touches within a radius, m; curvature: R, m."""
    carried, rim = _solved(stack, radius, lambda t: np.stack([np.ones_like(t), -((radius * t) ** 2) / curvature], 1))
    # φ = 0 at the rim: the pressure there is finite.
    approach = -float(rim[1] / rim[0])
    return 2 * math.pi * radius * float(approach * carried[0] + carried[1]), approach


def plate_stiffness(stack: Stack, radius: float) -> float:
    """Load over settlement, N/m, of a flat rigid disc of a radius, m, that touches everywhere."""
    carried, _ = _solved(stack, radius, lambda t: np.ones((t.size, 1)))
    return 2 * math.pi * radius * float(carried[0])


def _solved(stack: Stack, radius: float, side: Callable[[Array], Array]) -> tuple[Array, Array]:
    """∫ φ dt and φ at the rim, t in radii; side(t): right sides (n, sides) over 2/(π N∞)."""
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    t, w = np.append((nodes + 1) / 2, 1.0), weights / 2
    top = float(half_space_compliance(stack, 0)[0])
    # N/N∞ - 1 is gone at k h = 20; panels graded towards k = 0 hold what happens at long waves.
    last = max(2.0, 20 * radius / stack.thickness[0]) + 1
    edges = np.concatenate([[0], np.geomspace(1e-9, 1, 60), np.arange(1.5, last, 0.5)])
    half = np.diff(edges) / 2
    k = (edges[:-1, None] + half[:, None] * (1 + nodes)).ravel()
    change = (half[:, None] * weights).ravel() * (surface_compliance(k / radius, stack)[0] / top - 1)
    wave = np.cos(np.outer(t, k))
    kernel = 2 / np.pi * ((wave * change) @ wave[:-1].T) * w
    right = 2 / (np.pi * top) * side(t)
    phi = np.linalg.solve(np.eye(_NODES) + kernel[:-1], right[:-1])
    return w @ phi, right[-1] - kernel[-1] @ phi
