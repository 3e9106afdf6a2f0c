"""Means over a cube of road: what an asphalt mix responds to, and no finer mesh changes.

Under the edge of a rib the stress of a continuum has no bound, so that its largest value depends on how fine the
cells are. A mix is not a continuum below the size of its stones: damage belongs to a volume of that size
(Pijaudier-Cabot and Bažant 1987, J. Eng. Mech. 113, 1512-1533).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from treadload.errors import InputError
from treadload.grid import Grid
from treadload.kernels.arrays import Array, BoolArray
from treadload.response.loads import GridLoad, SurfaceLoad, UniformDisc

MATERIAL_LENGTH = 0.010
"""Side of the cube that surface criteria read, m: the largest stone of a typical wearing course, a 0/10 mix."""

# From this many lengths down points are read: they differ by a few per cent over the cube, and not with the cells.
_DEEP = 2.0
# A load's cells are at most this part of the length, so that the mean over it is one over several.
_FINE = 0.35
# Cells of a disc in a length, and samples across each to measure how much of it is covered.
_DISC_CELLS, _SAMPLES = 4, 16
# Two Gauss points stand for the mean over depth: 0.3 % of the strain under a rib's edge, measured against six.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(2)


@dataclass(frozen=True, eq=False)
class Windows:
    """The parts of the road that depths stand for.

    low, high: (nz,), m, from and to; equal where a depth stands for itself alone.
    nodes: depths to solve under the mean of the load, (n,). mean: (nz, n), their weights, rows of zeros for depths
    that stand for themselves. local: which those are, (nz,).
    """

    low: Array
    high: Array
    nodes: Array
    mean: Array
    local: BoolArray


def windows(depths: Array, length: float, interfaces: Array, where: Sequence[int]) -> Windows:
    """Windows of a length over depths: around each, but within the road and within its layer.

    depths: (nz,), m. interfaces: m, rising. where: number of the layer of each depth.
    """
    edges = np.concatenate([[0.0], interfaces, [math.inf]])
    local = depths >= _DEEP * length
    middle = np.maximum(depths, 0.5 * length)
    # A window at the surface keeps its length; one at an interface ends there.
    low = np.maximum(middle - 0.5 * length, [edges[k] for k in where])
    high = np.minimum(middle + 0.5 * length, [edges[k + 1] for k in where])
    low, high = np.where(local, depths, low), np.where(local, depths, high)
    spans = sorted({(a, b) for a, b, is_local in zip(low, high, local, strict=True) if not is_local})
    nodes = np.array([0.5 * (a + b) + 0.5 * (b - a) * t for a, b in spans for t in _NODES])
    mean = np.zeros((len(depths), len(nodes)))
    for row in np.flatnonzero(~local):
        first = len(_NODES) * spans.index((low[row], high[row]))
        mean[row, first : first + len(_NODES)] = 0.5 * _WEIGHTS
    return Windows(low, high, nodes, mean, local)


def check_length(length: float) -> None:
    """Raise InputError unless a cube of road can have this side."""
    if not (math.isfinite(length) and 0 < length <= 0.1):
        raise InputError(
            f"mean_over must lie in (0, 0.1] m, got {length:g}; {MATERIAL_LENGTH * 1e3:g} mm is the largest stone of "
            "a typical wearing course"
        )


def spread_over(load: SurfaceLoad, length: float) -> GridLoad:
    """The mean of a load over a square of road around each point: what the mean of its response belongs to.

    load: a disc is laid on cells first. length: side of the square, m. The force is kept.
    The sum of moved copies of the load with the force, the centre and the second moments of the exact mean.
    """
    cells = laid(load, length / _DISC_CELLS) if isinstance(load, UniformDisc) else load
    cells = _divided(cells, _FINE * length)
    grid, array = cells.grid, cells.array
    across, along = (_weights(length / step) for step in (grid.dy, grid.dx))
    more_y, more_x = len(across) // 2, len(along) // 2
    array = np.pad(array, ((0, 0), (more_y, more_y), (more_x, more_x)))
    array = scipy.ndimage.convolve1d(
        scipy.ndimage.convolve1d(array, across, axis=1, mode="constant"), along, axis=2, mode="constant"
    )
    ny, nx = array.shape[1:]
    wide = Grid(nx, ny, grid.dx, grid.dy, grid.x0 - more_x * grid.dx, grid.y0 - more_y * grid.dy)
    return GridLoad(wide, array[0], array[1], array[2], cells.interpolation)


def _weights(cells: float) -> Array:
    """Weights of the mean over a number of cells around the middle of one: its sum and its second moment, n²/12."""
    inner = max(int((cells - 1) // 2), 0)
    places = np.arange(1, inner + 1)
    # Weights a on 2 m + 1 cells, e on the two beside them: (2 m + 1) a + 2 e = 1, 2 Σ i² a + 2 (m + 1)² e = n²/12.
    moments = [[2 * inner + 1, 2], [2 * (places**2).sum(), 2 * (inner + 1) ** 2]]
    equal, edge = np.linalg.solve(moments, [1.0, cells**2 / 12])
    return np.array([edge, *([equal] * (2 * inner + 1)), edge])


def _divided(load: GridLoad, most: float) -> GridLoad:
    """The same load on cells no larger than that, m; an odd number in each, so that the centres stay."""
    grid = load.grid
    if load.interpolation == "bilinear" or max(grid.dx, grid.dy) <= most:
        return load
    nx, ny = (2 * math.ceil(0.5 * (step / most - 1)) + 1 if step > most else 1 for step in (grid.dx, grid.dy))
    return divided(load, nx, ny)


def divided(load: GridLoad, nx: int, ny: int) -> GridLoad:
    """The same load with each cell, uniformly loaded, divided into nx parts along travel and ny across."""
    grid = load.grid
    parts = load.array.repeat(ny, axis=1).repeat(nx, axis=2)
    dx, dy = grid.dx / nx, grid.dy / ny
    x0, y0 = grid.x0 - 0.5 * (nx - 1) * dx, grid.y0 - 0.5 * (ny - 1) * dy
    return GridLoad(Grid(grid.nx * nx, grid.ny * ny, dx, dy, x0, y0), *parts)


def laid(disc: UniformDisc, cell: float) -> GridLoad:
    """A disc on cells of a size, m, each loaded as far as it is covered; the force is kept."""
    flat = Grid.centred(2 * disc.radius, 2 * disc.radius, cell)
    inside = (np.arange(_SAMPLES) + 0.5) / _SAMPLES - 0.5
    x, y = ((at[:, None] + cell * inside).ravel() for at in (flat.x, flat.y))
    covered = np.hypot(x[None], y[:, None]) <= disc.radius
    share = covered.reshape(flat.ny, _SAMPLES, flat.nx, _SAMPLES).mean(axis=(1, 3))
    pressure = share * (disc.normal_load / (share.sum() * flat.cell_area))
    return GridLoad(Grid(flat.nx, flat.ny, cell, cell, flat.x0 + disc.x, flat.y0 + disc.y), pressure)
