"""Where the stress below passing wheels is read for cracks: few lines down the road, few seasons."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy

from treadload.damage.growth.intensity import BREAK
from treadload.kernels.arrays import Array, IntArray
from treadload.kernels.layers.synthesis import CRACKS
from treadload.life.climate import curves, first_nodes
from treadload.life.seasons import Warm
from treadload.life.wheels import MARGIN, Wheels
from treadload.response.basin import basin_tensors
from treadload.response.layered import View
from treadload.response.several import Question, answers, components_of

# Points near a wheel and apart from it, m, along travel and across it; how far from its edges they reach, and how far
# around them the finer ones do. Beyond, in the basin, points stand further apart.
_NEAR, _FAR, _REACH, _AROUND = 0.012, 0.040, 0.24, 0.02
_BASIN_X, _BASIN_Y = 0.048, 0.072
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


@dataclass(frozen=True, eq=False)
class CrackLines:
    """Places y and x, m, rising, at which the stress is read down the road; those of them near the wheels.

    near_y, near_x: by number. Elsewhere what is read is the basin around the wheels.
    """

    y: Array
    x: Array
    near_y: IntArray
    near_x: IntArray

    @classmethod
    def of(cls, wheels: Wheels, y: Array, reach: float) -> CrackLines:
        """Of a class that is read at y, evenly spaced, m. reach: m, along travel, of the basin, see `basin_reach`."""
        cell_x, cell_y = float(wheels.x[0, 1] - wheels.x[0, 0]), wheels.cell
        behind = wheels.x[0, 0] - cell_x * math.ceil(_REACH / cell_x)
        lattice = np.arange(behind, wheels.x[-1, -1] + _REACH + 0.5 * cell_x, cell_x)
        near_x = _spread(lattice, [(row[0], row[-1]) for row in wheels.x], cell_x)
        beside = [(load.grid.y[0], load.grid.y[-1]) for load in wheels.loads]
        cells = y[:: round(cell_y / (y[1] - y[0]))]
        inside = (cells > min(low for low, _ in beside) - MARGIN) & (cells < max(high for _, high in beside) + MARGIN)
        near_y = _spread(cells[inside], beside, cell_y)
        at_x = _outside(near_x, wheels.x[0, 0] - reach, wheels.x[-1, -1] + reach, _BASIN_X)
        at_y = _outside(near_y, float(y[0]), float(y[-1]), _BASIN_Y)
        return cls(at_y, at_x, np.searchsorted(at_y, near_y), np.searchsorted(at_x, near_x))


def _outside(near: Array, low: float, high: float, step: float) -> Array:
    """Points near the wheels, and others beyond them down to low and up to high, a step apart at most, m."""
    before, behind = max(math.ceil((near[0] - low) / step), 0), max(math.ceil((high - near[-1]) / step), 0)
    return np.concatenate(
        [
            np.linspace(low, near[0], before + 1)[:-1],
            near,
            np.linspace(near[-1], high, behind + 1)[1:],
        ]
    )


def stresses(wheels: Wheels, roads: Sequence[Warm], depths: Array, lines: CrackLines) -> list[Array]:
    """Stress (6, nz, ny, nx), Pa, in each road: under the wheels as they are near them, in their basin elsewhere."""
    at: dict[str, Any] = {"needs": _STRESS, "side": "above"}
    at["speed"] = wheels.speed if roads[0].road.is_viscoelastic else None
    around = basin_tensors([Question(wheels.coarse, road.road, depths) for road in roads], lines.x, lines.y, **at)
    components = components_of(_STRESS)
    assert components is not None
    view = View(lines.x[lines.near_x], lines.y[lines.near_y], components=components, accuracy=CRACKS)
    near = answers(
        [Question(wheels.joined, road.road, depths) for road in roads],
        view,
        side="above",
        speed=at["speed"],
        mean_over=None,
    )
    assert around is not None
    block = np.ix_(lines.near_y, lines.near_x)
    result = []
    for far, close in zip(around, near, strict=True):
        stress = np.stack([far[name].to_numpy() for name in _STRESS])
        stress[:, :, block[0], block[1]] = close.fields.stress
        result.append(stress)
    return result


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
    """Ranges (n, rows, 4, cycles) at y (n, y, 4, cycles), monotone cubics between rows, level beyond them."""
    ranges_here: Array = scipy.interpolate.PchipInterpolator(rows, ranges, axis=1)(np.clip(y, rows[0], rows[-1]))
    return ranges_here
