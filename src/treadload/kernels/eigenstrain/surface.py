"""How the surface of any elastic body sinks under eigenstrain inside it, from the body's own stress under a load.

By Betti's theorem a point sinks by ∫ e : σ dV, σ the stress under a unit force there. A force on a point, seen from a
whole cell, is a pressure on a cell, seen from a point: what a cell of eigenstrain does to a point of the surface is
the stress below a pressure of one on a cell, integrated over the thickness of the layer, exactly. So a half-space and
a road of layers are one thing here, whatever the layers above and below the eigenstrain.

Source: Mura (1987), Micromechanics of Defects in Solids, section 14, for the theorem.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from treadload.kernels.arrays import Array
from treadload.kernels.eigenstrain.operator import Grid
from treadload.kernels.fft import irfft2, next_fast_len, rfft2

Pressed = Callable[[Array, Array, Array], Array]
"""(depths (nz,), x (mx,), y (my,)), m → stress (6, nz, my, mx) under a pressure of 1 on a cell around the origin."""

_WEIGHTS = np.array([1.0, 1, 1, 2, 2, 2])
# Gauss points over a layer; more where it is nearer to the surface than so many cells, whose edges it sees.
_POINTS, _NEAR, _MORE = 6, 2.0, 16


def settlement(strain: Array, grid: Grid, pressed: Pressed) -> Array:
    """How far the surface sinks above the centres of the cells, (ny, nx), m, positive down.

    strain: (6, nz, ny, nx), of layers that no interface of the body cuts. pressed: stress of the body.
    """
    _, ny, nx = grid.shape
    x, y = grid.dx * np.arange(1 - nx, nx), grid.dy * np.arange(1 - ny, ny)
    waves = next_fast_len(3 * ny - 2), next_fast_len(3 * nx - 2)
    total = np.zeros((waves[0], waves[1] // 2 + 1), complex)
    for layer, (top, thickness) in enumerate(zip(grid.edges[:-1], grid.thickness, strict=True)):
        near = top < _NEAR * max(grid.dx, grid.dy)
        points, shares = np.polynomial.legendre.leggauss(_MORE if near else _POINTS)
        stress = pressed(top + 0.5 * thickness * (points + 1), x, y)
        # From the cell to the point: the load is at the point.
        kernel = 0.5 * thickness * np.einsum("z,czyx->cyx", shares, stress)[:, ::-1, ::-1]
        total += (rfft2(_WEIGHTS[:, None, None] * kernel, s=waves) * rfft2(strain[:, layer], s=waves)).sum(axis=0)
    sunk: Array = irfft2(total, s=waves)[ny - 1 : 2 * ny - 1, nx - 1 : 2 * nx - 1]
    return sunk
