"""Cells that the border of a sphere cuts: which of them stand for it, and how stiff they are.

Where whole cells are of a stone or not, its volume is off by a few per cent, and its steps make it look larger. Cells
in order of their share, as many as the volume asks for, mend the first. The second is mended for what is stiffer than
the mortar by the mean compliance of a cut cell's parts, as if these lay behind one another. For soft stones that is
several times worse than steps: they keep whole cells.
"""

from __future__ import annotations

import math

import numpy as np

from treadload.kernels.arrays import Array, IntArray
from treadload.materials.aggregates import Spheres

# Sub-cells of a cell along each axis.
_SUB = 6


def shares(stones: Spheres, x: Array, y: Array, z: Array) -> tuple[IntArray, IntArray, Array]:
    """How much of each cell is stone, all (nz, ny, nx). x, y, z: centres of even cells, m.

    Number of the stone that a cell stands for, from 1, 0 for none: of each stone the fullest cells, as many as its
    volume is; number of the stone that has the largest share in it, 0 where none has any; that share.
    """
    steps = [float(axis[1] - axis[0]) if len(axis) > 1 else 1.0 for axis in (z, y, x)]
    shape = len(z), len(y), len(x)
    most, holder, fullest = np.zeros(shape), np.zeros(shape, int), np.zeros(shape, int)
    inner = (np.arange(_SUB) + 0.5) / _SUB - 0.5
    for number, (cx, cy, cz, r) in enumerate(zip(stones.x, stones.y, stones.z, stones.radius, strict=True), start=1):
        parts = [
            np.flatnonzero(np.abs(axis - centre) < r + 0.5 * step)
            for axis, centre, step in zip((z, y, x), (cz, cy, cx), steps, strict=True)
        ]
        if not all(len(part) for part in parts):
            continue
        block = tuple(slice(part[0], part[-1] + 1) for part in parts)
        down, across, along = (
            ((axis[part, None] + step * inner - centre) ** 2).ravel()
            for axis, part, centre, step in zip((z, y, x), parts, (cz, cy, cx), steps, strict=True)
        )
        inside = down[:, None, None] + across[:, None] + along < r * r
        nz, ny, nx = (len(part) for part in parts)
        share = inside.reshape(nz, _SUB, ny, _SUB, nx, _SUB).mean(axis=(1, 3, 5))
        larger = share > most[block]
        holder[block][larger], most[block][larger] = number, share[larger]
        covered = np.where(larger, share, 0.0).ravel()
        fill = np.argsort(-covered, kind="stable")[: round(4 / 3 * math.pi * r**3 / math.prod(steps))]
        mine = np.zeros(covered.size, bool)
        mine[fill[covered[fill] > 0]] = True
        fullest[block][mine.reshape(share.shape)] = number
    return fullest, holder, most


def mixed(stiffness: Array, matrix: float, share: Array) -> Array:
    """A modulus (n,), Pa, of cells of which a share is stone, by the mean of their compliances; voids are whole."""
    cut = share < 1
    result: Array = stiffness.copy()
    result[cut] = 1 / (share[cut] / stiffness[cut] + (1 - share[cut]) / matrix)
    return result
