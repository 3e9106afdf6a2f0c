"""One passage: what the laws read as the wheels of a class roll over one road, and the peaks and valleys of it."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.interpolate import Akima1DInterpolator, CubicSpline

from treadload.damage.criterion import Side
from treadload.kernels.arrays import Array
from treadload.response import solve_response
from treadload.study.seasons import Warm
from treadload.study.wheels import MARGIN, Wheels

# Near the surface points stand on every cell up to this far beside a wheel, m.
_BESIDE = 0.06
# Below this depth, m, points a sixth of the depth apart, at most the last, m, follow the field: 1 % of the shear
# at 60 mm.
_DEEP, _PER_DEPTH, _COARSE = 0.05, 6, 0.02


def passage(wheels: Wheels, warm: Warm, y: Array, turns: int) -> Array:
    """(criterion, turns + 2, y): peaks and valleys, see `Passages`, then the angle and the dip of the crack."""
    readings = np.empty((len(warm.criteria), turns + 2, len(y)))
    depths = [criterion.depth(warm.road) for criterion in warm.criteria]
    groups: dict[tuple[int, Side, float | None], list[int]] = {}
    for k, (depth, criterion) in enumerate(zip(depths, warm.criteria, strict=True)):
        stride = _stride(depth, wheels.cell)
        side = criterion.side if depth > 0 else "above"
        # Deep down points and means are alike.
        groups.setdefault((stride, side, None if stride else criterion.mean_over), []).append(k)
    speed = wheels.speed if warm.road.is_viscoelastic else None
    for (stride, side, mean_over), members in groups.items():
        at = sorted({depths[k] for k in members})
        x, rows = _along(wheels, stride), _rows(wheels, y, stride)
        data = solve_response(
            wheels.loads, warm.road, depths=at, x=x, y=y[rows], speed=speed, side=side, mean_over=mean_over
        ).dataset
        nearest = np.abs(y[:, None] - y[None, rows]).argmin(axis=1)
        for k in members:
            plane = data.isel(depth=at.index(depths[k]))
            read = warm.criteria[k].read(plane)
            peaks = _turns(x, read, wheels.x.mean(axis=1), turns, smooth=stride > 0 or mean_over is not None)
            readings[k, :turns] = np.maximum(_between(y[rows], peaks, smooth=stride > 0)(y), 0.0)
            instant = read.argmax(axis=1)[:, None]
            for part, field in enumerate(warm.criteria[k].crack(plane)):
                readings[k, turns + part] = np.take_along_axis(field, instant, axis=1)[nearest, 0]
    return readings


def _stride(depth: float, cell: float) -> int:
    """Cells from one point to the next at a depth; 0 near the surface, where each counts."""
    wide = min(depth / _PER_DEPTH, _COARSE)
    return max(1, int(wide / cell + 0.5)) if depth > _DEEP else 0


def _along(wheels: Wheels, stride: int) -> Array:
    """Where along x a passage is read, m: on the cells under the axles and once between them, or every so many cells
    and further where fields are smooth.
    """
    cell = float(wheels.x[0, 1] - wheels.x[0, 0])
    if stride:
        step = stride * cell
        beyond = step * np.ceil(MARGIN / step)
        return np.arange(wheels.x[0, 0] - beyond, wheels.x[-1, -1] + beyond + step / 2, step)
    centres = wheels.x.mean(axis=1)
    between = wheels.x[0, 0] + cell * np.round((0.5 * (centres[1:] + centres[:-1]) - wheels.x[0, 0]) / cell)
    return np.unique(np.round(np.concatenate([*wheels.x, between]), 9))


def _rows(wheels: Wheels, y: Array, stride: int) -> Any:
    """Which values of y to solve: every cell under and beside a wheel, few elsewhere; few everywhere at depth."""
    cells = np.arange(0, len(y), round(wheels.cell / (y[1] - y[0])))
    wanted = np.zeros(len(cells), dtype=bool)
    wanted[:: stride or max(1, int(_COARSE / wheels.cell + 0.5))] = True
    wanted[-1] = True
    if not stride:
        for load in wheels.loads:
            low, high = load.grid.y[0] - _BESIDE, load.grid.y[-1] + _BESIDE
            wanted |= (y[cells] > low) & (y[cells] < high)
    return cells[wanted]


def _between(y: Array, peaks: Array, *, smooth: bool) -> CubicSpline | Akima1DInterpolator:
    """Curves through peaks (turns, ny) over y. smooth: as they are deep down; near the surface they end abruptly
    where nothing is tensile, and must not overshoot beside such an end.
    """
    return CubicSpline(y, peaks, axis=1) if smooth else Akima1DInterpolator(y, peaks, axis=1, method="makima")


def _turns(x: Array, read: Array, centres: Array, turns: int, *, smooth: bool) -> Array:
    """Peak under each axle and valley between (turns, ny) of a passage (ny, nx), zeros behind the last.

    centres: of the axles along x, m, rising. A peak belongs to the axle that it is nearest to; a valley is the
    least between two centres, which changes steadily as peaks wander below an axle and never hides a cycle.
    smooth: peaks lie between points too, on the parabola through three of them.
    """
    result = np.zeros((turns, len(read)))
    ends = np.concatenate([[-np.inf], 0.5 * (centres[1:] + centres[:-1]), [np.inf]])
    for axle in range(len(centres)):
        inside = np.flatnonzero((x >= ends[axle]) & (x <= ends[axle + 1]))
        at = inside[read[:, inside].argmax(axis=1)]
        result[2 * axle] = _vertex(read, at) if smooth else np.take_along_axis(read, at[:, None], axis=1)[:, 0]
    for axle in range(len(centres) - 1):
        between = (x >= centres[axle]) & (x <= centres[axle + 1])
        result[2 * axle + 1] = read[:, between].min(axis=1)
    return np.maximum(result, 0.0)


def _vertex(read: Array, at: Any) -> Array:
    """Top of the parabola through each row's largest value, in the columns `at`, and its even neighbours."""
    inner = np.clip(at, 1, read.shape[1] - 2)
    before, peak, after = (np.take_along_axis(read, (inner + k)[:, None], axis=1)[:, 0] for k in (-1, 0, 1))
    bend = 2 * peak - before - after
    # At the ends of the row, and on a plateau, there is nothing to add.
    good = (inner == at) & (bend > 0) & (peak >= before) & (peak >= after)
    rise = (after - before) ** 2 / (8 * np.where(good, bend, 1.0))
    own: Array = np.take_along_axis(read, at[:, None], axis=1)[:, 0]
    return np.where(good, own + rise, own)
