"""Lines of a profile laser as a surface: of a wheel that turned before it, or of a piece that it passed over."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np

from treadload.deferred import xarray as xr
from treadload.describing import Described
from treadload.errors import GeometryError, InputError
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.registry import READERS
from treadload.rows import Row, row
from treadload.tire.cells import from_neighbours
from treadload.tire.scan.cloud import bridged
from treadload.tire.scan.laser_file import Lines, read_laser_file, read_lines
from treadload.tire.scan.mesh_file import Triangles
from treadload.variables import dataset

# Lines nearer than this part of their usual distance are one; no surface is laid between those further apart.
_SAME_LINE, _APART = 0.5, 3.0
# From so many turns of a wheel on, lines are averaged over a whole step.
_SEVERAL = 1.5
# Points of a lattice: neighbouring lines are joined where there would be more.
_MOST_POINTS, _FEWEST_LINES = 1_000_000, 8
# Of a piece: cells, in steps of the laser; share of its points below the tops, and how near to these others are.
_CELLS, _TOPS, _NEAR_TOPS, _ROUNDS = 1.5, 0.9, 1.5e-3, 20
_MOST_CELLS = 25_000_000


@READERS.register("toml")
def wheel_of_lines(path: Path) -> Triangles:
    """Vertices (n, 3), m, and faces (m, 3) through the lines of a wheel that turned before a laser.

    The frame is x ahead, y to the right, z down, turned by half a turn about y: the angle 0 of the encoder faces the
    road. Lines at one angle, of several turns or of a wheel that stood, are averaged; drop-outs of up to two lines
    are bridged from both sides. Raises InputError and GeometryError.
    """
    laser = read_laser_file(path)
    if not laser.turns:
        raise InputError(
            f"the laser of {path.name!r} moved over a piece of tread, of which no wheel can be made; make a height "
            "map of it, `treadload scan lines.toml -o tread.nc`, and name that in height_map"
        )
    lines = read_lines(laser, path.parent)
    angle, x, z, step = _joined(lines, 2 * math.pi)
    after = np.roll(np.arange(len(angle)), -1)
    near = (angle[after] - angle) % (2 * math.pi) < _APART * step
    # A tread that goes on behind the angle 0 has no end there.
    ends = 3 if near[-1] else 0
    x, z = (
        bridged(np.pad(values, ((ends, ends), (0, 0)), mode="wrap").T).T[ends : ends + len(angle)]
        for values in (x, z)
    )
    finite = np.isfinite(z) & np.isfinite(x) & (z > 0)
    number = np.cumsum(finite.ravel()).reshape(finite.shape) - 1
    both = finite & finite[after] & near[:, None]
    quad = both[:, :-1] & both[:, 1:]
    a, b, c, d = (
        corner[quad] for corner in (number[:, :-1], number[:, 1:], number[after][:, :-1], number[after][:, 1:])
    )
    faces = np.concatenate([np.stack([a, c, b], axis=1), np.stack([b, c, d], axis=1)])
    if not len(faces):
        raise GeometryError(f"no two lines of {path.name!r} lie so near each other that a surface is between them")
    turn, r, y = np.broadcast_to(angle[:, None], z.shape)[finite], z[finite], x[finite]
    return np.stack([-r * np.sin(turn), y, -r * np.cos(turn)], axis=1), faces


@dataclass(frozen=True, eq=False)
class LaserPiece(Described):
    """A piece of tread under a laser that moved over it.

    dataset: initial_gap over (y, x), m, levelled, NaN where nothing was measured. lines, dropouts: how many lines,
    and the share of points that was not measured. slopes: of the plane that was taken off, ahead and to the right.
    """

    dataset: xr.Dataset
    lines: int
    dropouts: float
    slopes: tuple[float, float]

    title: ClassVar[str] = "Piece of tread under a laser"

    def rows(self) -> tuple[Row, ...]:
        """Lines, cells, and the plane that was taken off."""
        gap = self.dataset["initial_gap"]
        ahead, right = (math.degrees(math.atan(slope)) for slope in self.slopes)
        cells = f"{gap.sizes['x']} x {gap.sizes['y']} cells of {gap.attrs['dx'] * 1e3:.3g} mm"
        return (
            row("laser_lines", f"{self.lines}, {self.dropouts:.1%} of their points not measured"),
            row("grid", f"{cells}, {float(gap.isnull().mean()):.1%} without a height"),
            row("levelling", f"by {ahead:+.2f}° along travel and {right:+.2f}° across"),
            row("deepest_cell", float(gap.max()), note="below the tops"),
        )


def piece_of_lines(path: str | os.PathLike[str]) -> LaserPiece:
    """Height map of a piece of tread from the lines of a laser that moved over it.

    The plane on the tops is taken off, since nobody mounts a laser or a piece exactly level. Cells without a point
    take the mean of their neighbours where five or more of these have one. Raises InputError and GeometryError.
    """
    laser, name = read_laser_file(path), Path(path).name
    if laser.turns:
        raise InputError(f"the wheel of {name!r} turned before its laser; it is a scan of a tire, Tire.from_scan")
    lines = read_lines(laser, Path(path).parent)
    place, x, z, step = _joined(lines, None)
    across = np.diff(x, axis=1)
    along = float(np.nanmedian(across)) if np.isfinite(across).any() else step
    spacing = laser.spacing or _CELLS * max(step, along)
    finite = np.isfinite(z)
    ahead, right, height = np.broadcast_to(place[:, None], z.shape)[finite], x[finite], z[finite]
    ahead, right = ahead - 0.5 * (ahead.min() + ahead.max()), right - 0.5 * (right.min() + right.max())
    slopes = _plane_on_tops(ahead, right, height)
    level = height - slopes[0] * ahead - slopes[1] * right
    cells = [2 * round(float(np.abs(at).max()) / spacing) + 1 for at in (ahead, right)]
    if not cells[0] * cells[1] <= _MOST_CELLS:
        raise InputError(f"cells of {spacing:g} m make a map of {cells[0]} x {cells[1]}; take larger ones")
    grid = Grid.centred(cells[0] * spacing, cells[1] * spacing, spacing)
    column = np.clip(np.rint((ahead - grid.x0) / spacing).astype(np.int64), 0, grid.nx - 1)
    row = np.clip(np.rint((right - grid.y0) / spacing).astype(np.int64), 0, grid.ny - 1)
    key = row * grid.nx + column
    count = np.bincount(key, minlength=grid.nx * grid.ny)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = (np.bincount(key, level, grid.nx * grid.ny) / count).reshape(grid.shape)
    filled = from_neighbours(np.asarray(mean, dtype=np.float64))
    gap = np.nanmax(filled) - filled
    about = {"laser": name, "dx": grid.dx, "dy": grid.dy}
    data = dataset({"initial_gap": (("y", "x"), gap)}, {"x": grid.x, "y": grid.y}, **about)
    data["initial_gap"].attrs.update(dx=grid.dx, dy=grid.dy)
    return LaserPiece(data, len(lines.encoder), 1 - float(np.isfinite(lines.z).mean()), slopes)


def _joined(lines: Lines, turn: float | None) -> tuple[Array, Array, Array, float]:
    """Readings (k,), places and heights (k, m) in the order of the readings, and the usual step between them.

    Lines within half a step are averaged, of a wheel also those a whole turn apart. turn: rad, None without.
    """
    reading = lines.encoder if turn is None else np.unwrap(lines.encoder)
    steps = np.abs(np.diff(reading))
    steps = steps[steps > 1e-9 * max(float(np.ptp(reading)), 1e-300)]
    if len(steps) < _FEWEST_LINES:
        raise GeometryError(
            f"{len(steps) + 1} lines at different readings of the encoder, fewer than {_FEWEST_LINES}; was it on?"
        )
    step = float(np.median(steps))
    way = float(np.ptp(reading))
    turns = 1.0 if turn is None else way / turn
    fewest = math.ceil(2 * min(way, turn or way) / step * lines.z.shape[1] / _MOST_POINTS) / 2
    wide = step * max(_SAME_LINE if turns < _SEVERAL else 1.0, fewest)
    # The first line lies amid the first bin, and those of later turns beside it.
    start = float(reading[0] if turn is not None else reading.min()) - 0.5 * wide
    reading = reading - start if turn is None else (reading - start) % turn
    bins = np.floor(reading / wide).astype(np.int64)
    order = np.argsort(bins, kind="stable")
    first = np.flatnonzero(np.r_[True, np.diff(bins[order]) > 0])
    finite = np.isfinite(lines.z)[order]
    count = np.add.reduceat(finite, first, axis=0, dtype=np.int64)
    with np.errstate(invalid="ignore", divide="ignore"):
        x, z = (
            np.add.reduceat(np.where(finite, coordinate[order], 0.0), first, axis=0) / count
            for coordinate in (lines.x, lines.z)
        )
    at = start + np.add.reduceat(reading[order], first) / np.diff(np.r_[first, len(order)])
    return at, x, z, max(step, wide)


def _plane_on_tops(ahead: Array, right: Array, height: Array) -> tuple[float, float]:
    """Slopes of the plane through the tops: what lies near its upper tenth, found again about the plane itself."""
    matrix = np.stack([ahead, right, np.ones_like(ahead)], axis=1)
    used = np.ones(len(height), dtype=bool)
    slopes: Array = np.zeros(3)
    for _ in range(_ROUNDS):
        slopes = np.asarray(np.linalg.lstsq(matrix[used], height[used], rcond=None)[0], dtype=np.float64)
        rest = height - matrix @ slopes
        tops = np.abs(rest - float(np.quantile(rest, _TOPS))) < _NEAR_TOPS
        if np.array_equal(tops, used):
            break
        used = tops
    return float(slopes[0]), float(slopes[1])
