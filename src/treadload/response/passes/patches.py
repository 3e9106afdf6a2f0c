"""How wide the patches are that a load presses on: ribs and blocks set the cells of what yields below them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from treadload.kernels.arrays import Array
from treadload.response.loads import GridLoad, UniformDisc

# Of the load stands on patches that are narrower: a rib in the middle counts, the thin ends of an ellipse do not.
_SHARE = 0.25


def patch_width(loads: Sequence[GridLoad | UniformDisc]) -> float:
    """Width of the loaded patches across travel, m: a quarter of the load stands on narrower ones.

    loads: as cells, see `passes.problem`. In every line across travel a patch is a row of neighbouring cells with
    pressure; a load that is no grid is a patch as wide as it is.
    """
    widths, forces = [], []
    for load in loads:
        if isinstance(load, GridLoad):
            width, force = _runs(load.pressure, load.grid.dy, load.grid.cell_area)
        else:
            low, high = load.extent_y
            width, force = np.array([high - low]), np.array([load.pressure * (high - low) ** 2])
        widths.append(width)
        forces.append(force)
    width, force = np.concatenate(widths), np.concatenate(forces)
    order = np.argsort(width)
    shares = np.cumsum(force[order]) / force.sum()
    return float(width[order][np.searchsorted(shares, _SHARE * (1 - 1e-9))])


def _runs(pressure: Array, step: float, area: float) -> tuple[Array, Array]:
    """Widths, m, and forces, N, of the patches of all lines across travel of a pressure (ny, nx)."""
    # Lines one after the other, an empty cell before each.
    line = np.pad(np.clip(pressure, 0.0, None), ((1, 1), (0, 0))).T.ravel()
    edges = np.flatnonzero(np.diff((line > 0).astype(int)))
    begin, end = edges[::2] + 1, edges[1::2] + 1
    summed = np.concatenate([[0.0], np.cumsum(line)])
    return (end - begin) * step, (summed[end] - summed[begin]) * area
