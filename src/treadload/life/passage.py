"""One passage: what the laws read as the wheels of a class roll over one road, and the peaks and valleys of it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from scipy.interpolate import CubicSpline, make_interp_spline

from treadload.damage.criterion import Criterion, Side
from treadload.kernels.arrays import Array
from treadload.life.contacts import Counter
from treadload.life.peaks import Strips, over_strips, peaks_and_valleys, readings
from treadload.life.seasons import Warm
from treadload.life.wheels import MARGIN, Wheels
from treadload.response import solve_response
from treadload.response.several import Question, tensors_of_many

# Near the surface points stand on every cell up to this far beside a wheel, m.
_BESIDE = 0.06
# Below this depth, m, points a sixth of the depth apart, at most the last, m, follow the field: 1 % of the shear
# at 60 mm.
_DEEP, _PER_DEPTH, _COARSE = 0.05, 6, 0.02
_DIMS = ("depth", "y", "x")
# Names of variables, their dimensions and their values; a criterion, its fields and the result of its cracks.
Fields = Mapping[str, tuple[tuple[str, ...], Array]]
Worst = tuple[Criterion, Fields, Array]
# Of a law that tells none, and any temperature: exponents hardly depend on it.
_USUAL, _ANY_TEMPERATURE = -0.2, 15.0
# Points of all fields that are solved together: some 330 MB with what is made of them.
_TOGETHER = 1_500_000


@dataclass(frozen=True, eq=False)
class Passing:
    """A class that rolls over a road in a season, read at y, m, evenly spaced; turns: peaks and valleys to keep."""

    wheels: Wheels
    warm: Warm
    y: Array
    turns: int

    def depth(self, number: int) -> float:
        """At which one of its criteria reads, m."""
        return self.warm.criteria[number].depth(self.warm.road)

    def criterion(self, number: int) -> Criterion:
        """One of its criteria, as these wheels roll by."""
        criterion = self.warm.criteria[number]
        return criterion.passing(self.wheels.speed, self.depth(number), self.wheels.length)

    def depths(self, number: int) -> tuple[float, ...]:
        """Of which one of its criteria reads the largest, m."""
        return self.warm.criteria[number].depths(self.warm.road)

    @property
    def speed(self) -> float | None:
        """At which the wheels roll, m/s, where the road minds."""
        return self.wheels.speed if self.warm.road.is_viscoelastic else None


def solve_passings(tasks: Sequence[Passing], pool: Executor, count: Counter, threads: int = 1) -> list[Array]:
    """Peaks, valleys and cracks, see `passages`, for each task, those that share much together.

    threads: that the pool has.
    """
    solved: dict[int, Array] = {}

    def solve(members: list[int]) -> None:
        for number, passage in zip(members, passages([tasks[k] for k in members]), strict=True):
            solved[number] = count.after(passage, "response")

    list(pool.map(solve, batches(tasks, threads)))
    return [solved[number] for number in range(len(tasks))]


def batches(tasks: Sequence[Passing], threads: int = 1) -> list[list[int]]:
    """Tasks by number that are worth solving together: their wheels stand on the same cells, at the same speed.

    Those of one road follow each other, and so many go together that their fields stay small, and that no thread is
    left without.
    """
    alike: dict[Any, list[int]] = {}
    for number, task in enumerate(tasks):
        grids = tuple(load.grid for load in task.wheels.loads)
        alike.setdefault((grids, task.speed, float(task.y[0]), len(task.y)), []).append(number)
    parts: list[list[int]] = []
    for members in alike.values():
        first = tasks[members[0]]
        strides = {_Plane.of(first, k).stride for k in range(len(first.warm.criteria))}
        points = max(
            len(_along(first.wheels, stride)) * len(_rows(first.wheels, first.y, stride)) for stride in strides
        )
        roads = [id(tasks[number].warm.road) for number in members]
        members.sort(key=lambda number: roads.index(id(tasks[number].warm.road)))
        size = max(1, min(_TOGETHER // points, math.ceil(len(members) * len(alike) / threads)))
        parts += [members[start : start + size] for start in range(0, len(members), size)]
    return parts


def passages(tasks: Sequence[Passing]) -> list[Array]:
    """(criterion, turns + 3, y): peaks and valleys, see `Passages`, then angle and dip of the crack, and the depth.

    For each of some tasks that stand on the same cells at the same speed, see `batches`.
    """
    y, wheels = tasks[0].y, tasks[0].wheels
    results: list[Array] = [np.empty((len(task.warm.criteria), task.turns + 3, len(y))) for task in tasks]
    planes: dict[_Plane, dict[int, list[int]]] = {}
    for number, task in enumerate(tasks):
        for k in range(len(task.warm.criteria)):
            planes.setdefault(_Plane.of(task, k), {}).setdefault(number, []).append(k)
    for plane, members in planes.items():
        x, rows = _along(wheels, plane.stride), _rows(wheels, y, plane.stride)
        solved = _solved([(tasks[number], numbers) for number, numbers in members.items()], plane, x, y[rows])
        lines = _Lines.of(plane, wheels, rows, y)
        worst = []
        for (number, numbers), data in zip(members.items(), solved, strict=True):
            levels = list(data["depth"].to_numpy())
            for k in numbers:
                own_rows = [levels.index(depth) for depth in tasks[number].depths(k)]
                at = data if own_rows == list(range(len(levels))) else data.isel(depth=own_rows)
                criterion, result = tasks[number].criterion(k), results[number][k]
                worst.append((criterion, _read(result, criterion, at, tasks[number], plane, lines), result))
        _add_cracks(worst, lines.nearest, tasks[0].turns)
    return results


@dataclass(frozen=True)
class _Plane:
    """What is read together.

    stride: cells from one point to the next, 0 near the surface. side: of interfaces. mean_over: m, None for points.
    """

    stride: int
    side: Side
    mean_over: float | None

    @classmethod
    def of(cls, task: Passing, number: int) -> _Plane:
        """Where one of the criteria of a task reads."""
        depth, criterion = task.depth(number), task.warm.criteria[number]
        stride = _stride(depth, task.wheels.cell)
        # Deep down points and means are alike.
        return cls(stride, criterion.side if depth > 0 else "above", None if stride else criterion.mean_over)


def _solved(tasks: Sequence[tuple[Passing, list[int]]], plane: _Plane, x: Array, y: Array) -> list[xr.Dataset]:
    """What criteria, by number, read over (depth, y, x), for each task."""
    needs = {name for task, numbers in tasks for k in numbers for name in task.warm.criteria[k].needs}
    at: dict[str, Any] = {"speed": tasks[0][0].speed, "side": plane.side, "mean_over": plane.mean_over}
    depths = [np.array(sorted({depth for k in numbers for depth in task.depths(k)})) for task, numbers in tasks]
    places = [(task.wheels, task.warm.road, levels) for (task, _), levels in zip(tasks, depths, strict=True)]
    tensors = tensors_of_many(
        [Question(wheels.joined, road, levels) for wheels, road, levels in places], x, y, needs=needs, **at
    )
    if tensors is not None:
        return tensors
    return [
        solve_response(wheels.loads, road, depths=levels, x=x, y=y, **at).dataset for wheels, road, levels in places
    ]


@dataclass(frozen=True, eq=False)
class _Lines:
    """Across travel: rows that are solved, of y, m; those nearest to each y; and strips, where readings take them."""

    rows: Any
    y: Array
    nearest: Any
    strips: Strips | None

    @classmethod
    def of(cls, plane: _Plane, wheels: Wheels, rows: Any, y: Array) -> _Lines:
        """With strips where means near the surface are read."""
        fine = plane.mean_over is not None and wheels.cell <= plane.mean_over and not plane.stride
        nearest = np.abs(y[:, None] - y[None, rows]).argmin(axis=1)
        return cls(rows, y, nearest, Strips.of(y[rows], y) if fine else None)


def _read(
    result: Array, criterion: Criterion, data: xr.Dataset, task: Passing, plane: _Plane, lines: _Lines
) -> Fields:
    """Into (turns + 3, y) what a criterion reads of a plane (depth, rows, x); the fields where it reads most."""
    turns = task.turns
    smooth = plane.stride > 0
    uncut, margin = criterion.read_uncut(data)
    by_depth = readings(uncut, margin)
    deepest, read = by_depth.argmax(axis=0), by_depth.max(axis=0)
    x, at = data["x"].to_numpy(), {"centres": task.wheels.x.mean(axis=1), "turns": turns}
    if lines.strips is not None:
        power = 1 / abs(getattr(criterion.law_at(_ANY_TEMPERATURE), "exponent", _USUAL))
        result[:turns] = over_strips(lines.strips, x, uncut, margin, power=power, **at)
    else:
        peaks = peaks_and_valleys(x, uncut, margin, smooth=smooth or plane.mean_over is not None, **at)
        # Near the surface cells do not tell what is between them.
        rows = lines.y[lines.rows]
        between = CubicSpline(rows, peaks, axis=1) if smooth else make_interp_spline(rows, peaks, k=1, axis=1)
        result[:turns] = np.maximum(between(lines.y), 0.0)
    instant = read.argmax(axis=1)
    deep = np.take_along_axis(deepest, instant[:, None], axis=1)[:, 0]
    result[turns + 2] = data["depth"].to_numpy()[deep][lines.nearest]
    return _at(data, deep, instant)


def _at(data: xr.Dataset, deep: Any, instant: Any) -> Fields:
    """What a dataset has over all of depth, y and x, at one depth and one x for each y, by their numbers."""
    # xarray's own way costs more than what is read.
    points = np.arange(len(instant))
    return {
        str(name): (("y", *map(str, field.dims[3:])), field.to_numpy()[deep, points, instant])
        for name, field in data.variables.items()
        if field.dims[:3] == _DIMS
    }


def _add_cracks(worst: Sequence[Worst], nearest: object, turns: int) -> None:
    """Into results (turns + 3, y) angle and dip of the cracks that criteria see where they read most.

    Criteria that read one quantity see their cracks at once: there are few places of each.
    """
    alike: list[list[Worst]] = []
    for member in worst:
        group = next((group for group in alike if _sees_alike(group[0][0], member[0])), None)
        if group is None:
            alike.append([member])
        else:
            group.append(member)
    for several in alike:
        criterion, first, _ = several[0]
        places = xr.Dataset(
            {
                name: (dims, np.concatenate([fields[name][1] for _, fields, _ in several]))
                for name, (dims, _) in first.items()
            }
        )
        for part, cracks in enumerate(criterion.crack(places)):
            for (*_, result), group in zip(several, np.split(cracks, len(several)), strict=True):
                result[turns + part] = group[nearest]


def _sees_alike(criterion: Criterion, reference: Criterion) -> bool:
    """Whether two criteria see the same cracks in the same fields."""
    return (type(criterion), criterion.place, criterion.quantity) == (
        type(reference),
        reference.place,
        reference.quantity,
    )


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
