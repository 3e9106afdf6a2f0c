"""A measured map of pressure as shares of its load in blocks: what a fit follows in place of single sensels.

A sensel reads the peak at the edge of a rib or misses it; the load of a block does not ask where in it the edge lies.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from treadload.footprint.footprint import Footprint
from treadload.footprint.measures import find_ribs
from treadload.kernels.arrays import Array

# Blocks along travel, and across where no grooves divide the print into ribs.
_ALONG, _ACROSS = 5, 5


@dataclass(frozen=True, eq=False)
class Blocks:
    """Blocks of a footprint's sensels: ribs across times parts of equal load along.

    which: (ny, nx), number of the block of a sensel. count: of blocks. centre: of pressure, m. measured: share of
    the load in each block.
    """

    which: NDArray[np.int64]
    count: int
    centre: tuple[float, float]
    measured: Array

    @classmethod
    def of(cls, sensor: Footprint) -> Blocks:
        """Blocks of a footprint."""
        grid, pressure = sensor.grid, np.where(sensor.sensels, np.maximum(sensor.pressure, 0.0), 0.0)
        along, across = pressure.sum(axis=0), pressure.sum(axis=1)
        ribs = find_ribs(pressure, grid.y, grid.dy)[1:-1]
        edges_y = ribs if len(ribs) else equal_parts(across, grid.y, grid.dy, _ACROSS)
        edges_x = equal_parts(along, grid.x, grid.dx, _ALONG)
        rows = np.searchsorted(edges_y, grid.y)
        columns = np.searchsorted(edges_x, grid.x)
        which = np.asarray(rows[:, None] * _ALONG + columns[None, :], dtype=np.int64)
        count = (len(edges_y) + 1) * _ALONG
        centre = (float((along * grid.x).sum() / along.sum()), float((across * grid.y).sum() / across.sum()))
        blocks = cls(which, count, centre, np.zeros(0))
        return cls(which, count, centre, blocks.shares(pressure))

    def shares(self, pressure: Array) -> Array:
        """Share of the load in each block: (count,). pressure: (ny, nx) of the sensels, Pa."""
        total = float(pressure.sum())
        summed = np.bincount(self.which.ravel(), weights=pressure.ravel(), minlength=self.count)
        parts: Array = summed / (total if total > 0 else 1.0)
        return parts


def equal_parts(force: Array, places: Array, step: float, parts: int) -> Array:
    """Edges inside, m, between which equal parts of the force lie; they fall between cells."""
    cumulated = np.concatenate([[0.0], np.cumsum(force)]) / force.sum()
    edges = np.concatenate([places - 0.5 * step, [places[-1] + 0.5 * step]])
    cuts = np.searchsorted(cumulated, np.arange(1, parts) / parts)
    inside: Array = edges[cuts]
    return inside
