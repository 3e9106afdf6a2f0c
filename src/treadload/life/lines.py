"""The lines along and across travel on which a passage is read: every cell near the surface, few deeper down."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy

from treadload.damage.criterion import Criterion, Side
from treadload.kernels.arrays import Array, IntArray
from treadload.life.basin import BESIDE_STEP, Basin
from treadload.life.peaks import Strips
from treadload.life.wheels import MARGIN, Wheels
from treadload.response.basin import BEYOND, NEAR_SURFACE
from treadload.response.several import components_of

# Below this depth, m, points a sixth of the depth apart, at most the last, m, follow the field: 1 % of the shear
# at 60 mm.
_PER_DEPTH, _COARSE = 6, 0.02


@dataclass(frozen=True)
class Plane:
    """What is read together.

    stride: cells from one point to the next, 0 near the surface. side: of interfaces. mean_over: m, None for points.
    margin: how far around the wheels points stand, m. wide: True if the basin around them is read besides.
    """

    stride: int
    side: Side
    mean_over: float | None
    margin: float = MARGIN
    wide: bool = False

    @classmethod
    def of(cls, criterion: Criterion, depth: float, cell: float) -> Plane:
        """Where a criterion reads at a depth, m, under wheels on cells, m."""
        stride = stride_of(depth, cell)
        wide = not stride and components_of(criterion.needs) is not None
        side = criterion.side if depth > 0 else "above"
        # Deep down points and means are alike.
        return cls(stride, side, None if stride else criterion.mean_over, BEYOND if wide else MARGIN, wide)


@dataclass(frozen=True, eq=False)
class Lines:
    """Across travel: rows that are solved near the wheels, and lines in order, those of a basin among them.

    rows: of the near field, m. order: of these and the basin's, one after the other. nearest: line of each y.
    core: y near the wheels, with strips where readings take them; onto_core (core, rows) makes their values of those
    on the rows. evaluated: m, where cycles are counted, the core's and the basin's lines, ordered among the two.
    """

    rows: Any
    y: Array
    order: Any
    nearest: Any
    core: Any
    strips: Strips | None
    onto_core: Any
    evaluated: Array
    ordered: Any

    @classmethod
    def of(cls, plane: Plane, wheels: Wheels, rows: Array, y: Array, basin: Basin | None) -> Lines:
        """With strips where means near the surface are read. rows: see `rows_of`."""
        fine = plane.mean_over is not None and wheels.cell <= plane.mean_over and not plane.stride
        places = rows if basin is None else np.concatenate([rows, basin.rows])
        order = np.argsort(places, kind="stable")
        near, parts = nearest_of(rows, y), parts_of(wheels, plane)
        core = np.flatnonzero(np.abs(rows[near] - y) <= wheels.cell / parts) if plane.wide else np.arange(len(y))
        strips = Strips.of(rows, y[core], narrow=wheels.has_side_force) if fine else None
        evaluated = y[core] if basin is None else np.concatenate([y[core], basin.rows])
        # Beside wide cells a line of the basin may lie on one of the core, which is kept.
        lines, ordered = np.unique(np.round(evaluated, 9), return_index=True)
        onto = straight(rows, y[core])
        nearest = nearest_of(places[order], y)
        return cls(rows, y, order, nearest, core, strips, onto, lines, ordered)


def straight(places: Array, y: Array) -> scipy.sparse.csr_array:
    """Weights (ny, n) of values at n rising places in those of straight lines between them, level beyond."""
    behind = np.clip(np.searchsorted(places, y), 1, len(places) - 1)
    low = places[behind - 1]
    part = np.clip((y - low) / (places[behind] - low), 0.0, 1.0)
    weights = np.stack([1 - part, part], axis=1).ravel()
    columns = np.stack([behind - 1, behind], axis=1).ravel()
    return scipy.sparse.csr_array((weights, columns, np.arange(0, len(columns) + 1, 2)), shape=(len(y), len(places)))


def nearest_of(places: Array, y: Array) -> IntArray:
    """The nearest of rising places to each y, by number."""
    behind = np.clip(np.searchsorted(places, y), 1, len(places) - 1)
    return behind - (y - places[behind - 1] < places[behind] - y)


def stride_of(depth: float, cell: float) -> int:
    """Cells from one point to the next at a depth; 0 near the surface, where each counts."""
    wide = min(depth / _PER_DEPTH, _COARSE)
    return max(1, int(wide / cell + 0.5)) if depth > NEAR_SURFACE else 0


def along(wheels: Wheels, plane: Plane) -> Array:
    """Where along x a passage is read, m: on the cells under the axles and once between them, or every so many cells
    and further where fields are smooth; beside axles up to where the basin begins.
    """
    cell = float(wheels.x[0, 1] - wheels.x[0, 0])
    if plane.stride:
        step = plane.stride * cell
        beyond = step * np.ceil(plane.margin / step)
        return np.arange(wheels.x[0, 0] - beyond, wheels.x[-1, -1] + beyond + step / 2, step)
    centres = wheels.x.mean(axis=1)
    between = wheels.x[0, 0] + cell * np.round((0.5 * (centres[1:] + centres[:-1]) - wheels.x[0, 0]) / cell)
    places = [*wheels.x, between]
    if plane.wide:
        step = cell * max(1, round(BESIDE_STEP / cell))
        off = step * np.arange(1, math.ceil(plane.margin / step) + 1)
        places = [*wheels.x, *(cells[0] - off for cells in wheels.x), *(cells[-1] + off for cells in wheels.x)]
    return np.unique(np.round(np.concatenate(places), 9))


def parts_of(wheels: Wheels, plane: Plane) -> int:
    """Into how many rows each cell is divided: where means near the surface are evaluated, see `Wheels.parts`."""
    return wheels.parts if plane.wide and plane.mean_over is not None and wheels.cell <= plane.mean_over else 1


def rows_of(wheels: Wheels, y: Array, plane: Plane) -> Array:
    """The rows to solve, m: of y every cell under and beside a wheel; few elsewhere, and everywhere at depth.

    None further than the margin from the wheels. Where cells are divided, see `parts_of`, a row in each part.
    """
    cells = np.arange(0, len(y), round(wheels.cell / (y[1] - y[0])))
    wanted, reached = np.zeros((2, len(cells)), dtype=bool)
    for load in wheels.loads:
        distance = np.maximum(load.grid.y[0] - y[cells], y[cells] - load.grid.y[-1])
        reached |= distance < plane.margin + ((plane.stride or 1) + 1) * wheels.cell
        if not plane.stride:
            wanted |= distance < BEYOND
    if not plane.wide:
        wanted[:: plane.stride or max(1, int(_COARSE / wheels.cell + 0.5))] = True
    wanted &= reached
    if not plane.wide and reached[-1]:
        wanted[-1] = True
    rows, parts = y[cells[wanted]], parts_of(wheels, plane)
    if parts == 1:
        return rows
    within = wheels.cell * ((np.arange(parts) + 0.5) / parts - 0.5)
    divided: Array = (rows[:, None] + within).ravel()
    return divided


def points_of(wheels: Wheels, y: Array, plane: Plane) -> int:
    """How many points of the near field are solved in a plane."""
    return len(along(wheels, plane)) * len(rows_of(wheels, y, plane))
