"""Where the stress below passing wheels is read for cracks: few lines down the road, few seasons."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from treadload.damage.growth.intensity import BREAK
from treadload.kernels.arrays import Array
from treadload.life.climate import curves, first_nodes
from treadload.life.seasons import Warm
from treadload.life.wheels import Wheels
from treadload.response.several import Question, tensors_of_many

# Points near a wheel and apart from it, m, along travel and across it; how far from its edges they reach, and how far
# around them the finer ones do.
_NEAR, _FAR, _REACH, _AROUND = 0.012, 0.040, 0.24, 0.02
# The first distance below the surface at which stress is read, m, the largest ratio of two that follow, and the
# longest step as a part of the way.
_FIRST, _RATIO, _STEP = 0.003, 1.5, 0.1
_STRESS = tuple(f"stress_{part}" for part in ("xx", "yy", "zz", "xy", "xz", "yz"))
# Roads of a climate that are solved, of one temperature each and of profiles over depth; ranges in the others lie on
# curves and surfaces over warmth.
_SEASONS, _PROFILES = 5, 8


def distances_to(thickness: float, interfaces: Sequence[float] = (), *, upwards: bool = False) -> Array:
    """From the mouth at which the stress is read, m: close to each other near the surface of the road.

    interfaces: distances, m, where the stress jumps; it is read on both of their sides, see
    `damage.growth.intensity.between`. upwards: the mouth is at the lower end of the way.
    """
    distances = [0.0, min(_FIRST, 0.25 * thickness)]
    while distances[-1] < thickness:
        distances.append(min(_RATIO * distances[-1], distances[-1] + _STEP * thickness))
    # The last step is not a short one.
    even = np.array(distances) * thickness / distances[-1]
    if upwards:
        even = (thickness - even)[::-1]
    sides = [place + side for place in interfaces for side in (-0.4 * BREAK, 0.4 * BREAK)]
    clear = [abs(distance - place) > 0.1 * _FIRST for distance in even for place in interfaces]
    apart = np.array(clear, dtype=bool).reshape(len(even), len(interfaces)).all(axis=1)
    return np.sort(np.concatenate([even[apart], sides]))


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
    questions = [Question(wheels.joined, road.road, depths) for road in roads]
    tensors = tensors_of_many(questions, x, y, needs=_STRESS, speed=speed, side="above")
    assert tensors is not None
    return [np.stack([data[name].to_numpy() for name in _STRESS]) for data in tensors]


def nodes_of_climate(warmth: Array | None, count: int) -> list[int]:
    """Numbers of the roads that are solved, of so many: the ends of their warmth and some between."""
    if warmth is None or count <= (_SEASONS if warmth.ndim == 1 else _PROFILES):
        return list(range(count))
    if warmth.ndim == 1:
        wanted = np.linspace(warmth.min(), warmth.max(), _SEASONS)
        return sorted({int(np.abs(warmth - point).argmin()) for point in wanted})
    kept = first_nodes(warmth)
    while len(kept) < _PROFILES:
        kept.append(int(np.linalg.norm(warmth[:, None] - warmth[kept], axis=-1).min(axis=1).argmax()))
    return sorted(kept)


def over_seasons(warmth: Array | None, nodes: list[int], ranges: Array) -> Array:
    """Ranges in all roads (road, ...), from those (nodes, ...) that were solved."""
    if warmth is None or len(nodes) == len(warmth):
        return ranges
    order = sorted(range(len(nodes)), key=lambda k: warmth[nodes[k]] if warmth.ndim == 1 else k)
    solved = [nodes[k] for k in order]
    every: Array = np.maximum(curves(warmth[solved], ranges[order], 0)(warmth), 0.0)
    every[nodes] = ranges
    return every


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
    ranges_here: Array = ranges[:, at] * (1 - part) + ranges[:, at + 1] * part
    return ranges_here
