"""Mean over each cell of the stress that near cells give it: what makes the operator symmetric and negative.

Taken at the centres alone, stress that alternates from cell to cell has the wrong sign: equations with stiff and soft
cells then need not be solvable. Three Gauss points an axis, for the cells less than three away.
"""

from __future__ import annotations

import numpy as np

from treadload.kernels.arrays import Array
from treadload.kernels.eigenstrain.corners import stress_kernels
from treadload.kernels.eigenstrain.potentials import Coefficients

_NEAR = 3
_POINTS, _SHARES = np.polynomial.legendre.leggauss(3)


def average(kernels: Array, depth: int, x: Array, y: Array, edges: Array, of: Coefficients, *, surface: bool) -> None:
    """Put the means over the cells of a layer in the place of the values at their centres, where cells are near.

    kernels: (6, 6, nz, ny, nx), by offset from 0 on. depth: number of the layer of the points. x: (nx + 1,), y:
    (ny + 1, 1): corners of cells to the centre of a point's cell, m. edges: (nz + 1,), m, of the layers.
    """
    near = slice(max(depth - _NEAR + 1, 0), depth + _NEAR)
    around = edges[near.start : near.stop + 1]
    x, y = x[: _NEAR + 1], y[: _NEAR + 1]
    half_x, half_y = 0.5 * (x[1] - x[0]), 0.5 * (y[1] - y[0])
    middle, half_z = 0.5 * (edges[depth] + edges[depth + 1]), 0.5 * (edges[depth + 1] - edges[depth])
    total = 0.0
    for place in np.ndindex(3, 3, 3):
        at, share = _POINTS[list(place)], 0.125 * _SHARES[list(place)].prod()
        total = total + share * stress_kernels(
            x + half_x * at[0], y + half_y * at[1], middle + half_z * at[2], around, of, _blocks, surface=surface
        )
    kernels[:, :, near, :_NEAR, :_NEAR] = total


def _blocks(functions: Array) -> Array:
    result: Array = np.diff(np.diff(functions, axis=-1), axis=-2)
    return result
