"""One passage: what the laws read as the wheels of a class roll over one road, and the peaks and valleys of it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import scipy

from treadload.damage.criterion import Criterion
from treadload.damage.cycles import as_turns, rainflow, turning_points
from treadload.deferred import xarray as xr
from treadload.kernels.arrays import Array, IntArray
from treadload.life.basin import Basin
from treadload.life.contacts import Counter
from treadload.life.followed import Followed, power_of
from treadload.life.lines import Lines, Plane, along, nearest_of, parts_of, points_of, rows_of
from treadload.life.peaks import over_strips, peaks_and_valleys, readings
from treadload.life.seasons import Warm
from treadload.life.wheels import Wheels
from treadload.response import solve_response
from treadload.response.basin import SHORTEST, basin_tensors
from treadload.response.loads import SurfaceLoad
from treadload.response.several import Question, tensors_of_many

# Cycles of a passage that are kept at least, and for each axle: the road hogs ahead of and behind each.
_FEWEST_CYCLES, _CYCLES_PER_AXLE = 3, 2
# Rows a smooth field is read on end where it has faded to this part of its largest, or it is solved further.
_FAINT = 0.5
# What a result holds behind the turns: angle and dip of the crack, the depth, and whether it lies on the border.
ANGLE, DIP, DEPTH, BORDER, BEHIND = range(5)
_DIMS = ("depth", "y", "x")
# Names of variables, their dimensions and their values; a criterion, its fields and the result of its cracks.
Fields = Mapping[str, tuple[tuple[str, ...], Array]]
Worst = tuple[Criterion, Fields, Array]
# Points of all fields that are solved together: some 330 MB with what is made of them.
_TOGETHER = 1_500_000


@dataclass(frozen=True, eq=False)
class Passing:
    """A class that rolls over a road in a season, read at y, m, evenly spaced.

    turns: peaks and valleys to keep, see `turns_of`. reach: how far ahead and behind its basin is followed, m.
    """

    wheels: Wheels
    warm: Warm
    y: Array
    turns: int
    reach: float = SHORTEST

    def depth(self, number: int) -> float:
        """At which a criterion, by number, is evaluated, m."""
        return self.warm.criteria[number].depth(self.warm.road)

    def criterion(self, number: int) -> Criterion:
        """One of its criteria, as these wheels roll by."""
        criterion = self.warm.criteria[number]
        return criterion.passing(self.wheels.speed, self.depth(number), self.wheels.length)

    def depths(self, number: int) -> tuple[float, ...]:
        """Of which a criterion, by number, takes the largest value, m."""
        return self.warm.criteria[number].depths(self.warm.road)

    def plane(self, number: int) -> Plane:
        """Where one of its criteria reads."""
        return Plane.of(self.warm.criteria[number], self.depth(number), self.wheels.cell)

    @cached_property
    def planes(self) -> dict[tuple[Plane, int], list[int]]:
        """Criteria, by number, that are read in each plane with rows in so many parts of a cell, see `parts_of`."""
        planes: dict[tuple[Plane, int], list[int]] = {}
        for number in range(len(self.warm.criteria)):
            plane = self.plane(number)
            planes.setdefault((plane, parts_of(self.wheels, plane)), []).append(number)
        return planes

    @property
    def speed(self) -> float | None:
        """At which the wheels roll, m/s, where the road minds."""
        return self.wheels.speed if self.warm.road.is_viscoelastic else None


def turns_of(wheels: Iterable[Wheels]) -> int:
    """Peaks and valleys to keep of passages of some wheels."""
    return 2 * max(_FEWEST_CYCLES, _CYCLES_PER_AXLE * max(len(member.x) for member in wheels)) - 1


def solve_passings(tasks: Sequence[Passing], pool: Executor, count: Counter, threads: int = 1) -> list[Array]:
    """Peaks, valleys and cracks, see `passages`, for each task, those that share much together.

    threads: that the pool has.
    """
    solved = dict(stream_passings(tasks, pool, count, threads))
    return [solved[number] for number in range(len(tasks))]


def stream_passings(
    tasks: Sequence[Passing], pool: Executor, count: Counter, threads: int = 1
) -> Iterator[tuple[int, Array]]:
    """The number of each task and its result, batch by batch, so that not all results are held; else as above."""

    def solve(members: list[int]) -> list[tuple[int, Array]]:
        solved = passages([tasks[k] for k in members])
        return [(number, count.after(passage, "response")) for number, passage in zip(members, solved, strict=True)]

    for batch in pool.map(solve, batches(tasks, threads)):
        yield from batch


def batches(tasks: Sequence[Passing], threads: int = 1) -> list[list[int]]:
    """Tasks by number that are worth solving together: their wheels stand on the same cells, at the same speed.

    Those of one road follow each other; so many go together that fields stay small and every thread has work.
    """
    alike: dict[Any, list[int]] = {}
    for number, task in enumerate(tasks):
        grids = tuple(load.grid for load in task.wheels.loads)
        alike.setdefault((grids, task.speed, float(task.y[0]), len(task.y), task.reach), []).append(number)
    parts: list[list[int]] = []
    for members in alike.values():
        roads = [id(tasks[number].warm.road) for number in members]
        members.sort(key=lambda number: roads.index(id(tasks[number].warm.road)))
        size = math.ceil(len(members) * len(alike) / threads)
        points: dict[tuple[Plane, int], int] = {}
        parts.append([])
        for number in members:
            task = tasks[number]
            added = {key: points_of(task.wheels, task.y, key[0]) for key in task.planes}
            most = max(points.get(key, 0) + count for key, count in added.items())
            if parts[-1] and (len(parts[-1]) == size or most > _TOGETHER):
                points = {}
                parts.append([])
            parts[-1].append(number)
            points |= {key: points.get(key, 0) + count for key, count in added.items()}
    return parts


def passages(tasks: Sequence[Passing]) -> list[Array]:
    """(criterion, turns + BEHIND, y): peaks and valleys, see `Passages`, then what is behind them.

    For each of some tasks that stand on the same cells at the same speed, see `batches`.
    """
    results: list[Array] = [
        np.empty((len(task.warm.criteria), task.turns + BEHIND, len(task.y)), np.float32) for task in tasks
    ]
    planes: dict[tuple[Plane, int], dict[int, list[int]]] = {}
    for number, task in enumerate(tasks):
        for key, numbers in task.planes.items():
            planes.setdefault(key, {})[number] = numbers
    around = _basins(tasks)
    for (plane, _), members in planes.items():
        again = _pass(tasks, plane, members, around.get(plane), results)
        # What is largest at the edge of what was solved is solved further.
        if again:
            _pass(tasks, replace(plane, margin=tasks[0].reach), again, None, results)
    return results


def _basins(tasks: Sequence[Passing]) -> dict[Plane, dict[int, xr.Dataset]]:
    """What is solved around the wheels of each task, by number, for every wide plane."""
    planes: dict[Plane, dict[int, list[int]]] = {}
    for number, task in enumerate(tasks):
        for (plane, _), numbers in task.planes.items():
            if plane.wide:
                planes.setdefault(plane, {})[number] = numbers
    x, y = Basin.points(tasks[0].wheels, tasks[0].y, tasks[0].reach)
    solved = {}
    for plane, members in planes.items():
        several = [(tasks[number], numbers) for number, numbers in members.items()]
        solved[plane] = dict(zip(members, _solved(several, plane, x, y, basin=True), strict=True))
    return solved


def _pass(
    tasks: Sequence[Passing],
    plane: Plane,
    members: Mapping[int, list[int]],
    around: Mapping[int, xr.Dataset] | None,
    results: Sequence[Array],
) -> dict[int, list[int]]:
    """Into results what criteria, by number of each task, read in a plane; those whose largest is on its border.

    around: what `_basins` solved, where the plane is wide.
    """
    first = tasks[min(members)]
    wheels, y, turns = first.wheels, first.y, first.turns
    x, rows = along(wheels, plane), rows_of(wheels, y, plane)
    basin = None if around is None else Basin.of(wheels, y, rows, first.reach)
    lines = Lines.of(plane, wheels, rows, y, basin)
    worst: list[Worst] = []
    several = [(tasks[number], numbers) for number, numbers in members.items()]
    again: dict[int, list[int]] = {}
    for (number, numbers), data in zip(members.items(), _solved(several, plane, x, rows), strict=True):
        task, levels = tasks[number], list(data["depth"].to_numpy())
        far = None if basin is None or around is None else basin.lines(around[number])
        for k in numbers:
            depth_rows = [levels.index(depth) for depth in task.depths(k)]
            whole = depth_rows == list(range(len(levels)))
            at = data if whole else data.isel(depth=depth_rows)
            criterion, result = task.criterion(k), results[number][k]
            if basin is None or far is None:
                fields, ends = _read(result, criterion, at, task, plane, lines)
                if ends and plane.margin < task.reach:
                    again.setdefault(number, []).append(k)
            else:
                away, outside = (part if whole else part.isel(depth=depth_rows) for part in far)
                fields = _read_both(result, criterion, (at, outside, away), task, lines, basin)
            worst.append((criterion, fields, result))
    _add_cracks(worst, lines.nearest, turns)
    return again


def near_and_far(task: Passing, number: int) -> tuple[Lines, Basin, tuple[xr.Dataset, xr.Dataset, xr.Dataset]] | None:
    """Lines of a passage with what one of its criteria reads there, see `_read_both`; None where it has no basin."""
    plane = task.plane(number)
    if not plane.wide:
        return None
    wheels, y, several = task.wheels, task.y, [(task, [number])]
    rows = rows_of(wheels, y, plane)
    basin = Basin.of(wheels, y, rows, task.reach)
    lines = Lines.of(plane, wheels, rows, y, basin)
    (beyond,) = _solved(several, plane, basin.x, basin.y, basin=True)
    (near,) = _solved(several, plane, along(wheels, plane), rows)
    away, outside = basin.lines(beyond)
    return lines, basin, (near, outside, away)


def _solved(
    tasks: Sequence[tuple[Passing, list[int]]], plane: Plane, x: Array, y: Array, *, basin: bool = False
) -> list[xr.Dataset]:
    """What criteria, by number, read over (depth, y, x), for each task. basin: True of that around the wheels."""
    needs = {name for task, numbers in tasks for k in numbers for name in task.warm.criteria[k].needs}
    at: dict[str, Any] = {"speed": tasks[0][0].speed, "side": plane.side, "mean_over": plane.mean_over}
    depths = [np.array(sorted({depth for k in numbers for depth in task.depths(k)})) for task, numbers in tasks]
    places = [(task.wheels, task.warm.road, levels) for (task, _), levels in zip(tasks, depths, strict=True)]
    solve = basin_tensors if basin else tensors_of_many
    tensors = solve(
        [Question(_loads(wheels, plane, basin=basin), road, levels) for wheels, road, levels in places],
        x,
        y,
        needs=needs,
        **at,
    )
    if tensors is not None:
        return tensors
    return [
        solve_response(wheels.loads, road, depths=levels, x=x, y=y, **at).dataset for wheels, road, levels in places
    ]


def _loads(wheels: Wheels, plane: Plane, *, basin: bool) -> list[SurfaceLoad]:
    """Wheels as what is read needs them: on coarse cells around them, where the class has them deep down."""
    if basin:
        return wheels.coarse
    if plane.stride:
        return wheels.deep
    return wheels.near_surface if parts_of(wheels, plane) > 1 else wheels.joined


def _read(
    result: Array, criterion: Criterion, data: xr.Dataset, task: Passing, plane: Plane, lines: Lines
) -> tuple[Fields, bool]:
    """Into (turns + BEHIND, y) what a criterion reads of a plane (depth, rows, x); the fields where it reads most.

    And whether that has not faded at the border.
    """
    turns, smooth = task.turns, plane.stride > 0
    uncut, margin = criterion.read_uncut(data)
    by_depth = readings(uncut, margin)
    deepest, read = by_depth.argmax(axis=0), by_depth.max(axis=0)
    x, centres = data["x"].to_numpy(), task.wheels.x.mean(axis=1)
    at, power = {"centres": centres, "turns": 2 * len(centres) - 1}, power_of(criterion)
    rows = lines.rows
    if lines.strips is not None:
        peaks = over_strips(lines.strips, x, uncut, margin, power=power, **at)
    else:
        peaks = peaks_and_valleys(x, uncut, margin, smooth=smooth or plane.mean_over is not None, **at)
        # Near the surface cells do not tell what is between them.
        between = (
            scipy.interpolate.CubicSpline(rows, peaks, axis=1)
            if smooth
            else scipy.interpolate.make_interp_spline(rows, peaks, k=1, axis=1)
        )
        inside = (lines.y >= rows[0]) & (lines.y <= rows[-1])
        peaks = np.where(inside, np.maximum(between(lines.y), 0.0), 0.0)
    result[:turns] = as_turns(*rainflow(peaks[::2].T, peaks[1::2].T), turns, power)
    instant = read.argmax(axis=1)
    deep = np.take_along_axis(deepest, instant[:, None], axis=1)[:, 0]
    result[turns + DEPTH] = data["depth"].to_numpy()[deep][lines.nearest]
    border = max(read[0].max(), read[-1].max(), read[:, 0].max(), read[:, -1].max())
    result[turns + BORDER] = ((instant == 0) | (instant == len(x) - 1))[lines.nearest]
    return _at(data, deep, instant), bool(border > _FAINT * read.max())


def _read_both(
    result: Array,
    criterion: Criterion,
    fields: tuple[xr.Dataset, xr.Dataset, xr.Dataset],
    task: Passing,
    lines: Lines,
    basin: Basin,
) -> Fields:
    """Into (turns + BEHIND, y) what a criterion reads near and far; the fields where it reads most on each line.

    fields: near (depth, rows, x); of the basin on some of the rows, and on its lines, see `Basin.lines`. Lines are
    followed from rest to rest; peaks under axles are those between the points, or those of strips.
    """
    turns, power = task.turns, power_of(criterion)
    near, outside, far = fields
    followed = Followed.of(criterion.read_uncut, fields, task.wheels, lines, basin, criterion.mean_over, power)
    x, x_all, read, far_read = near["x"].to_numpy(), followed.x, followed.read, followed.away
    whole, away = followed.by_depth, followed.away_by_depth
    on_core = followed.core[:, np.argsort(x_all, kind="stable")]
    on_lines = np.concatenate([_turns_of(on_core, turns, power), _turns_of(far_read, turns, power)], axis=1)
    # Most turns of most classes are nothing.
    filled = np.flatnonzero(on_lines.any(axis=1))
    between = scipy.interpolate.make_interp_spline(
        lines.evaluated, on_lines[np.ix_(filled, lines.ordered)], k=1, axis=1
    )
    result[:turns] = 0.0
    result[filled] = np.maximum(between(lines.y), 0.0)
    most = np.concatenate([read.argmax(axis=1), far_read.argmax(axis=1)])
    count = len(read)
    deep = np.concatenate(
        [
            whole.argmax(axis=0)[np.arange(count), most[:count]],
            away.argmax(axis=0)[np.arange(len(far_read)), most[count:]],
        ]
    )
    result[turns + DEPTH] = near["depth"].to_numpy()[deep][lines.order][lines.nearest]
    x_most = np.concatenate([x_all[most[:count]], basin.columns[most[count:]]])
    ends = (x_most <= basin.columns[0]) | (x_most >= basin.columns[-1])
    ends[count:] |= (basin.rows <= basin.y[0]) | (basin.rows >= basin.y[-1])
    result[turns + BORDER] = ends[lines.order][lines.nearest]
    deep_near, at = deep[:count], most[:count]
    inner, outer = np.flatnonzero(at < len(x)), np.flatnonzero(at >= len(x))
    parts = (
        _at(near, deep_near[inner], at[inner], inner),
        _at(outside, deep_near[outer], at[outer] - len(x), nearest_of(basin.outside_rows, basin.near)[outer]),
        _at(far, deep[count:], most[count:]),
    )
    back = np.argsort(np.concatenate([inner, outer, np.arange(count, len(deep))]), kind="stable")[lines.order]
    return {
        name: (dims, np.concatenate([part_of[name][1] for part_of in parts])[back])
        for name, (dims, _) in parts[0].items()
    }


def _turns_of(read: Array, turns: int, power: float) -> Array:
    """Turns (turns, n) of lines of readings (n, nx)."""
    return as_turns(*rainflow(*turning_points(read)), turns, power)


def _at(
    data: xr.Dataset, deep: IntArray, instant: IntArray, rows: IntArray | None = None
) -> dict[str, tuple[tuple[str, ...], Array]]:
    """What a dataset has over all of depth, y and x, at one depth and one x for each y, or some, by their numbers."""
    # xarray's own way costs more than what is read.
    points = np.arange(len(instant)) if rows is None else rows
    return {
        str(name): (("y", *map(str, field.dims[3:])), field.values[deep, points, instant])
        for name, field in data.variables.items()
        if field.dims[:3] == _DIMS
    }


def _add_cracks(worst: Sequence[Worst], nearest: object, turns: int) -> None:
    """Into results (turns + BEHIND, y) angle and dip of the cracks that criteria see where they read most.

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
