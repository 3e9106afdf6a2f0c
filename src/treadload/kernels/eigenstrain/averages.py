"""Mean over each cell of the stress that near cells give it: what makes the operator symmetric and negative.

Taken at the centres alone, stress that alternates from cell to cell has the wrong sign: equations with stiff and
soft cells then need not be solvable, and neighbours that yield flow in turn. Three Gauss points an axis, for cells
less than three away; of bars along x for those less than three away across and down.
"""

from __future__ import annotations

import numpy as np

from treadload.kernels.arrays import Array
from treadload.kernels.eigenstrain.corners import Difference, stress_kernels
from treadload.kernels.eigenstrain.potentials import Coefficients

NEAR = 3
_POINTS, _SHARES = np.polynomial.legendre.leggauss(3)


def average(
    kernels: Array,
    depth: int,
    x: Array,
    y: Array,
    edges: Array,
    of: Coefficients,
    cells: Difference,
    size: tuple[float, float],
    *,
    surface: bool,
) -> None:
    """Put the means over the cells of a layer in the place of the values at their centres, where cells are near.

    kernels: (6, 6, nz, ny, mx), by offset from 0 on along y; the first of the columns are replaced. depth: number of
    the layer of the points. x: corners of cells to the centre of a point's cell, m, of the columns that are near.
    y: (ny + 1, 1), likewise, of all. edges: (nz + 1,), m, of the layers. cells: differences of corner functions.
    size: of the cells along x, 0 where x is a line of bars without ends, and y, m.
    """
    near = slice(max(depth - NEAR + 1, 0), depth + NEAR)
    around, y = edges[near.start : near.stop + 1], y[: NEAR + 1]
    middle, half_z = 0.5 * (edges[depth] + edges[depth + 1]), 0.5 * (edges[depth + 1] - edges[depth])
    along = _POINTS if size[0] else np.zeros(1)
    total: Array | float = 0.0
    for first, second, third in np.ndindex(len(along), 3, 3):
        share = 0.25 * _SHARES[second] * _SHARES[third] * (0.5 * _SHARES[first] if size[0] else 1.0)
        total = total + share * stress_kernels(
            x + 0.5 * size[0] * along[first],
            y + 0.5 * size[1] * _POINTS[second],
            middle + half_z * _POINTS[third],
            around,
            of,
            cells,
            surface=surface,
        )
    assert isinstance(total, np.ndarray)
    kernels[:, :, near, :NEAR, : total.shape[-1]] = total
