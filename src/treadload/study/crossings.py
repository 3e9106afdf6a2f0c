"""Where the stress below passing wheels is read for cracks: few lines down the road, few seasons."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from scipy.interpolate import PchipInterpolator

from treadload.kernels.arrays import Array
from treadload.response.several import Question, tensors_of_many
from treadload.study.seasons import Warm
from treadload.study.wheels import Wheels

# Points near a wheel and apart from it, m, along travel and across it; how far from its edges they reach, and how far
# around them the finer ones do.
_NEAR, _FAR, _REACH, _AROUND = 0.012, 0.040, 0.24, 0.02
# The first distance below the surface at which stress is read, m, and the largest ratio of two that follow.
_FIRST, _RATIO = 0.003, 1.5
_STRESS = tuple(f"stress_{part}" for part in ("xx", "yy", "zz", "xy", "xz", "yz"))
# Roads of a climate that are solved; ranges in the others lie on splines over warmth.
_SEASONS = 5


def distances_to(thickness: float) -> Array:
    """From the mouth at which the stress is read, m."""
    count = max(3, math.ceil(math.log(thickness / _FIRST) / math.log(_RATIO)))
    return np.concatenate([[0.0], np.geomspace(_FIRST, thickness, count + 1)])


def lines(wheels: Wheels, y: Array) -> tuple[Array, Array]:
    """Places y and x at which the stress is read, m."""
    cell_x, cell_y = float(wheels.x[0, 1] - wheels.x[0, 0]), wheels.cell
    behind = wheels.x[0, 0] - cell_x * math.ceil(_REACH / cell_x)
    lattice = np.arange(behind, wheels.x[-1, -1] + _REACH + 0.5 * cell_x, cell_x)
    x = _spread(lattice, [(row[0], row[-1]) for row in wheels.x], cell_x)
    cells = y[:: round(cell_y / (y[1] - y[0]))]
    return _spread(cells, [(load.grid.y[0], load.grid.y[-1]) for load in wheels.loads], cell_y), x


def stresses(wheels: Wheels, roads: Sequence[Warm], depths: Array, x: Array, y: Array) -> list[Array]:
    """Stress (6, nz, ny, nx), Pa, in each road."""
    speed = wheels.speed if roads[0].road.is_viscoelastic else None
    questions = [Question(wheels.joined, one.road, depths) for one in roads]
    found = tensors_of_many(questions, x, y, needs=_STRESS, speed=speed, side="above")
    assert found is not None
    return [np.stack([data[name].to_numpy() for name in _STRESS]) for data in found]


def nodes_of_climate(warmth: Array | None, count: int) -> list[int]:
    """Numbers of the roads that are solved, of so many, by their warmth: the ends and some between."""
    if warmth is None or count <= _SEASONS:
        return list(range(count))
    wanted = np.linspace(warmth.min(), warmth.max(), _SEASONS)
    return sorted({int(np.abs(warmth - one).argmin()) for one in wanted}, key=lambda one: float(warmth[one]))


def in_season(warmth: Array | None, nodes: list[int], ranges: Array, number: int) -> Array:
    """Ranges in a road by number, from those (nodes, ...) that were solved."""
    if number in nodes:
        told: Array = ranges[nodes.index(number)]
        return told
    assert warmth is not None
    between: Array = np.maximum(PchipInterpolator(warmth[nodes], ranges)(warmth[number]), 0.0)
    return between


def _spread(lattice: Array, spans: Sequence[tuple[float, float]], cell: float) -> Array:
    """Points of a lattice: close to each other over spans and beside them, further apart elsewhere."""
    near, far = max(1, round(_NEAR / cell)), max(1, round(_FAR / cell))
    wanted = np.zeros(len(lattice), dtype=bool)
    wanted[::far] = True
    wanted[-1] = True
    fine = np.zeros(len(lattice), dtype=bool)
    fine[::near] = True
    for low, high in spans:
        wanted |= fine & (lattice > low - _AROUND) & (lattice < high + _AROUND)
    return lattice[wanted]


def between_rows(rows: Array, y: Array, ranges: Array) -> Array:
    """Ranges (n, rows, 4, cycles) at y (n, y, 4, cycles), linear between rows."""
    at = np.clip(np.searchsorted(rows, y) - 1, 0, len(rows) - 2)
    part = np.clip((y - rows[at]) / (rows[at + 1] - rows[at]), 0.0, 1.0)[:, None, None]
    told: Array = ranges[:, at] * (1 - part) + ranges[:, at + 1] * part
    return told
