"""Gridded loads on one lattice: the grid that holds them, and their sum as one load."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from treadload.errors import InputError
from treadload.grid import Grid
from treadload.pavement import Pavement
from treadload.response.loads import GridLoad, PlacedLoad, SurfaceLoad

# Round-off of coordinates that went through a file, as a part of a cell.
_EVEN = 1e-4
# Loads whose cells are this near to each other, as a part of a cell, add up cell by cell.
_SAME = 1e-8
# Most cells of a sum, by those of its parts: the ground between wheels costs too.
_GROWTH = 1.5


def common_grid(several: Sequence[PlacedLoad]) -> Grid:
    """Smallest grid that holds every load's cells; InputError if the loads do not share one lattice."""
    loads = [load for load in several if isinstance(load, GridLoad)]
    if len(loads) < len(several):
        raise InputError("a disc or a rectangle has no grid of its own; give x and y of the result")
    whole = first = loads[0].grid
    for number, grid in enumerate((load.grid for load in loads[1:]), start=2):
        if _apart(first, grid) > _EVEN:
            raise InputError(f"load {number} ({grid}) and load 1 ({first}) share no grid; give x and y of the result")
        whole = _union(whole, grid)
    return whole


def merged(loads: Sequence[SurfaceLoad]) -> list[SurfaceLoad]:
    """Loads with the same sum, fewer where gridded ones share a lattice and little ground lies between them.

    Dual wheels a whole number of cells apart become one load, so that they cost what one does; of many wheels rows
    become loads first, and then rows of rows.
    """
    rest = [load for load in loads if not isinstance(load, GridLoad)]
    sums, before = [load for load in loads if isinstance(load, GridLoad)], -1
    while len(sums) != before:
        before = len(sums)
        sums = _joined(sums)
    return [*rest, *sums]


def mean_loads(several: Sequence[Sequence[PlacedLoad]]) -> list[GridLoad]:
    """Loads that add up to the mean of several sets of gridded ones. Raises InputError for a disc or a rectangle."""
    loads = [load for group in several for load in group if isinstance(load, GridLoad)]
    if len(loads) < sum(map(len, several)):
        raise InputError("a disc or a rectangle has no cells, so that there is nothing to shift; leave shifted out")
    parts = [(load, load.array / len(several)) for load in loads]
    return [replace(load, pressure=part[0], traction_x=part[1], traction_y=part[2]) for load, part in parts]


def _joined(loads: Sequence[GridLoad]) -> list[GridLoad]:
    """Loads with the same sum: each joined to the first that it belongs to."""
    sums: list[GridLoad] = []
    for load in loads:
        for place, earlier in enumerate(sums):
            if _belong(earlier, load):
                sums[place] = _sum(earlier, load)
                break
        else:
            sums.append(load)
    return sums


def _belong(first: GridLoad, second: GridLoad) -> bool:
    if first.interpolation != second.interpolation or _apart(first.grid, second.grid) > _SAME:
        return False
    whole = _union(first.grid, second.grid)
    return whole.nx * whole.ny <= _GROWTH * (first.pressure.size + second.pressure.size)


def _sum(first: GridLoad, second: GridLoad) -> GridLoad:
    whole = _union(first.grid, second.grid)
    total = np.zeros((3, *whole.shape))
    for load in (first, second):
        column, row = _shift(whole, load.grid)
        total[:, row : row + load.grid.ny, column : column + load.grid.nx] += load.array
    pressure, along, across = total
    return GridLoad(whole, pressure, along, across, first.interpolation)


def _shift(first: Grid, grid: Grid) -> tuple[int, int]:
    """Whole cells from the first cell of one grid to that of another, along x and y."""
    return round((grid.x0 - first.x0) / first.dx), round((grid.y0 - first.y0) / first.dy)


def _apart(first: Grid, grid: Grid) -> float:
    """How far two grids are from sharing a lattice, in cells."""
    column, row = _shift(first, grid)
    return max(
        abs((grid.x0 - first.x0) / first.dx - column),
        abs((grid.y0 - first.y0) / first.dy - row),
        abs(grid.dx / first.dx - 1),
        abs(grid.dy / first.dy - 1),
    )


def _union(first: Grid, grid: Grid) -> Grid:
    """Smallest grid that holds both."""
    column, row = _shift(first, grid)
    low_x, low_y = min(0, column), min(0, row)
    return Grid(
        max(first.nx, column + grid.nx) - low_x,
        max(first.ny, row + grid.ny) - low_y,
        first.dx,
        first.dy,
        first.x0 + low_x * first.dx,
        first.y0 + low_y * first.dy,
    )


# What a map of layers shows beside the wheels, m: stiff layers spread the load.
_MARGIN = 0.1


def map_grid(loads: Sequence[GridLoad], road: Pavement) -> Grid:
    """The cells of all wheels, on layers with a margin around them.

    >>> patch = tl.response.GridLoad.from_arrays([[400e3, 800e3, 400e3]], spacing=0.05)
    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> grid = tl.response.map_grid([patch], road)
    >>> f"{grid.nx} x {grid.ny} cells around a load of {patch.grid.nx} x {patch.grid.ny}"
    '7 x 5 cells around a load of 3 x 1'
    """
    grid = common_grid(loads)
    if road.is_homogeneous:
        return grid
    more_x, more_y = math.ceil(_MARGIN / grid.dx), math.ceil(_MARGIN / grid.dy)
    return Grid(
        grid.nx + 2 * more_x,
        grid.ny + 2 * more_y,
        grid.dx,
        grid.dy,
        grid.x0 - more_x * grid.dx,
        grid.y0 - more_y * grid.dy,
    )
