"""Fields of a gridded load on the grid of any coordinates, by the cheapest method."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from typing import Literal

import numpy as np

from treadload.kernels.arrays import Array
from treadload.kernels.gridding.lattice import Source, by_lattices, loaded, padded_cells, summed
from treadload.kernels.gridding.precorrected import FINE, FINEST, Kept, interpolated, nodes_of, on_nodes, window

# Measured, in pairs of a point and a cell: a padded cell of a lattice, and a cell near a point, corrected.
_LATTICE_COST, _NEAR_COST = 3.0, 0.5
# The same whatever their size: of each lattice, whose kernels and transforms are called in turn, and of corrections.
_EACH_LATTICE, _CORRECTIONS = 8000.0, 30_000.0

Method = Literal["auto", "fft", "precorrected", "direct"]
_Way = tuple[float, str, int]


def on_grid(
    source: Source, depths: Array, x: Array, y: Array, method: Method = "auto", kept: Kept | None = None
) -> tuple[Array, str]:
    """Fields on the grid of any coordinates x and y.

    depths: (nz,), m. x: (mx,), y: (my,): relative to the centre of the first cell, m, in any order. method: "fft"
    on the lattices that the coordinates form, "precorrected" by interpolation, see `kernels.gridding.precorrected`,
    "direct" by summing over cells, or "auto", the cheapest at each depth. kept: of further calls with the same
    kernels, see `kernels.gridding.precorrected`.
    Returns (nz, components, …, my, mx) and the methods used, "none" without load; … as of the loads, see `Source`.
    """
    fields = np.zeros((len(depths), source.components, *source.load.shape[1:-2], len(y), len(x)))
    part = loaded(source, x, y)
    if part is None:
        return fields, "none"
    ways = [way[1:] for way in _cheapest(*part, depths, method, kept)]
    for way in set(ways):
        rows = [row for row, row_way in enumerate(ways) if row_way == way]
        name, nodes = way
        if name == "fft":
            near = None if kept is None else partial(on_nodes, kept=kept, whole=True)
            fields[rows] = by_lattices(part[0], depths[rows], *part[1:], near)
            continue
        for index in np.ndindex(source.load.shape[1:-2]):
            load = replace(part[0], load=part[0].load[:, *index])
            alone = summed if name == "direct" else partial(interpolated, nodes=nodes, kept=kept)
            fields[(rows, slice(None), *index)] = alone(load, depths[rows], *part[1:])
    return fields, "+".join(sorted({name for name, _ in ways}))


def grid_cost(load: Array, dx: float, dy: float, depths: Array, x: Array, y: Array) -> Array:
    """Pairs of a point and a cell, summed directly, that cost as much as `on_grid` at each depth, (nz,).

    load: (3, ny, nx), whose zeros count. dx, dy: cell, m. The rest as in `on_grid`.
    """
    part = loaded(Source(load, dx, dy, lambda *_: iter(()), 0), x, y)
    if part is None:
        return np.zeros(len(depths))
    return np.array([cost for cost, _, _ in _cheapest(*part, depths, "auto")])


def _cheapest(
    source: Source, x: Array, y: Array, depths: Array, method: Method, kept: Kept | None = None
) -> list[_Way]:
    """Cost, way, and nodes in the shorter side of a cell to interpolate from, at each depth."""
    ny, nx = source.load.shape[-2:]
    sides = ((nx, x, source.dx), (ny, y, source.dy))
    formed = [padded_cells(at, size, cells) for cells, at, size in sides]
    padded, lattices = (math.prod(numbers) for numbers in zip(*formed, strict=True))
    ways: list[_Way] = [
        (_LATTICE_COST * padded + _EACH_LATTICE * lattices, "fft", 0),
        (len(x) * len(y) * (nx + 1.0) * (ny + 1.0), "direct", 0),
    ]
    order, ready = (FINE, set()) if kept is None else (kept.order, kept.ready)
    among: list[_Way] = [
        (
            0.0
            if nodes in ready
            else _LATTICE_COST
            * math.prod(
                count * (cells + np.ptp(at) / size + 1) + order.stencil
                for count, (cells, at, size) in zip(nodes_of(source, nodes), sides, strict=True)
            ),
            "precorrected",
            nodes,
        )
        for nodes in range(1, FINEST + 1)
    ]

    def at_depth(depth: float) -> _Way:
        near = [
            math.prod(2.0 * (cells + 1) for cells in window(source, depth, nodes, order)) for _, _, nodes in among
        ]
        corrected = [
            (cost + _CORRECTIONS + _NEAR_COST * len(x) * len(y) * cells, name, nodes)
            for (cost, name, nodes), cells in zip(among, near, strict=True)
        ]
        return min(way for way in [*ways, *corrected] if method in ("auto", way[1]))

    return [at_depth(float(depth)) for depth in depths]
