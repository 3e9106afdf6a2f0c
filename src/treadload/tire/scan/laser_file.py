"""Lines of a profile laser in a text, and the TOML file that states what their numbers are.

The text is ours, so that it claims no maker's format: a table, commas, semicolons, tabs or blanks between its cells,
decimal points (or commas, beside another separator), lines that begin with # left out.

    rows    the first line has any word and then the places x of the columns; every other line the encoder and then
            the heights of one profile
    points  the first line has words; every other line one point: encoder, x, z. A profile is what follows each
            other with one encoder reading

A cell that is empty or NaN was not measured, and so are the numbers that `invalid` lists.
"""

from __future__ import annotations

import math
import os
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from treadload.errors import InputError, error_line
from treadload.files import parse_toml, text_of
from treadload.kernels.arrays import Array
from treadload.labels import factor
from treadload.units import Angle, Length, Number

_MOST_BYTES, _MOST_VALUES, _FEWEST = 2**29, 20_000_000, 3
# Of places and heights, m, and of the encoder, rad or m: beyond it nothing is a measurement.
_LARGEST = 1e6
# Between two marks that separate, or one and an end of the line, stands nothing.
_EMPTY = {mark: re.compile(rf"(?:(?<={mark})|^)[ ]*(?={mark}|$)", re.MULTILINE) for mark in (";", ",", "\t")}


@dataclass(frozen=True)
class LaserFile:
    """`[laser]` of a TOML file: a text of profiles, and what its numbers are.

    file: the text. layout: rows or points. encoder: unit of its readings, of an angle (the wheel turned before the
    laser), of a length (the laser moved over a piece of tread), or "count"; then counts_per_turn, or count, the
    length of one, is given. x, z: units of place and height. towards: where z grows, to the "laser" or, of a
    distance, to the "axle". axle: from the axle to z = 0, of a wheel. tilt: by which the right end of the laser's x
    is turned away from the axle. backward: the wheel turned against its rolling, or the laser went against travel.
    left: x grows to the left of travel. invalid: numbers that mean nothing measured. spacing: cells of the map of a
    piece.
    """

    file: Path
    layout: Literal["rows", "points"]
    encoder: str
    x: str
    z: str
    towards: Literal["laser", "axle"] = "laser"
    axle: Length | None = None
    counts_per_turn: Number | None = None
    count: Length | None = None
    tilt: Angle = 0.0
    backward: bool = False
    left: bool = False
    invalid: tuple[Number, ...] = ()
    spacing: Length | None = None

    def __post_init__(self) -> None:
        if (self.encoder == "count") != (self.counts_per_turn is not None or self.count is not None):
            raise InputError(
                'encoder = "count" needs counts_per_turn, or count, the length of one; and no other encoder has them'
            )
        if self.counts_per_turn is not None and self.count is not None:
            raise InputError("give counts_per_turn of a wheel that turned, or count of a laser that moved, not both")
        for name in ("counts_per_turn", "count", "axle", "spacing"):
            value = getattr(self, name)
            if value is not None and not value > 0:
                raise InputError(f"{name} must be more than 0, got {value:g}")
        if not abs(self.tilt) <= math.radians(30):
            raise InputError(f"tilt must lie within ±0.524 rad (30°), got {self.tilt:g}; give it in rad")
        for name in ("x", "z"):
            _unit(name, getattr(self, name), "m")
        if not self.step > 0:
            raise InputError(f"the encoder's unit {self.encoder!r} is nothing")
        if self.turns and self.axle is None:
            raise InputError(
                "a wheel that turned before the laser needs axle, the distance from its axle to where z is 0"
            )
        if self.turns and self.spacing is not None:
            raise InputError("spacing is of the map of a piece of tread, over which the laser moved; leave it out")
        if not self.turns and self.axle is not None:
            raise InputError(
                "axle is of a wheel that turned before the laser; this one moved over a piece: leave it out"
            )

    @property
    def turns(self) -> bool:
        """True where the encoder measures an angle of the wheel, False where it measures a length of the way."""
        return self.counts_per_turn is not None or _is_angle(self.encoder)

    @property
    def step(self) -> float:
        """Rad or m of one of the encoder's units."""
        if self.counts_per_turn is not None:
            return 2 * math.pi / self.counts_per_turn
        if self.count is not None:
            return self.count
        return _unit("encoder", self.encoder, "rad" if self.turns else "m")


@dataclass(frozen=True, eq=False)
class Lines:
    """Profiles as they were measured.

    encoder: (n,) rad or m, rising with the rolling of the wheel, or with travel. x: (n, m) places to the right of
    travel, rising, and z: (n, m) heights away from the axle, of a wheel radii, m; NaN where nothing was measured.
    """

    encoder: Array
    x: Array
    z: Array


def _is_angle(unit: str) -> bool:
    try:
        factor(unit, "rad")
    except InputError:
        return False
    return True


def _unit(name: str, unit: str, si: str) -> float:
    """What numbers in a unit are multiplied by to be SI. Raises InputError."""
    try:
        return factor(unit, si)
    except InputError as error:
        such = {"m": "mm or m", "rad": "deg or rad"}[si]
        counts = ', "count"' if name == "encoder" else ""
        raise InputError(f"{name} = {unit!r} is no unit such as {such}{counts}") from error


def is_laser(path: Path) -> bool:
    """True for a TOML file with a table [laser]; False for any other, readable or not."""
    try:
        return "laser" in parse_toml(text_of(path, ""), path.name)
    except InputError:
        return False


def read_laser_file(path: str | os.PathLike[str]) -> LaserFile:
    """The table [laser] of a TOML file; paths in it start from its folder. Raises InputError."""
    # pydantic is loaded when a file is read, not before.
    from treadload.read import read

    file = Path(path)
    table = parse_toml(text_of(file, "a TOML file with a table [laser]"), str(file))
    if not isinstance(table.get("laser"), dict) or set(table) - {"laser", "title"}:
        raise InputError(
            f"{file} must hold the table [laser] and nothing besides but a title; see docs/howto/laser.md"
        )
    laser: LaserFile = read(LaserFile, table["laser"], f"{file}, laser", folder=file.parent)
    return laser


def read_lines(laser: LaserFile, folder: Path) -> Lines:
    """The lines of the text that a table asks for. Raises InputError that names the file."""
    path = folder / laser.file
    numbers, heading = _numbers(path)
    if laser.layout == "rows":
        encoder, z = numbers[:, 0], numbers[:, 1:]
        x = _places(heading, z.shape[1], path)
    else:
        encoder, x, z = _gathered(numbers, path)
    if not np.isfinite(encoder).all():
        raise InputError(f"{path.name!r} has lines without a reading of the encoder, in its first column")
    for mark in laser.invalid:
        z = np.where(z == mark, np.nan, z)
    with np.errstate(over="ignore", invalid="ignore"):
        encoder = laser.step * (-encoder if laser.backward else encoder)
        x = _unit("x", laser.x, "m") * (-x if laser.left else x)
        z = _unit("z", laser.z, "m") * (-z if laser.towards == "axle" else z)
        if laser.left if x.ndim > 1 else x[-1] < x[0]:
            x, z = x[..., ::-1], z[:, ::-1]
        if laser.tilt:
            # The profile lies in one plane: a turn in it about its zero.
            cos, sin = math.cos(laser.tilt), math.sin(laser.tilt)
            x, z = cos * x - sin * z, cos * z + sin * x
        z = z + (laser.axle or 0.0)
        size = np.nanmax(np.abs(z), initial=0.0) + np.nanmax(np.abs(x), initial=0.0) + np.abs(encoder).max()
    if not np.isfinite(z).any():
        raise InputError(f"{path.name!r} has no height: all its cells are empty, NaN or numbers that invalid lists")
    if not size < _LARGEST:
        raise InputError(f"{path.name!r} has places, heights or turns beyond all that a laser measures, {size:.3g}")
    return Lines(encoder, np.where(np.isfinite(z), np.broadcast_to(x, z.shape), np.nan), z)


def _numbers(path: Path) -> tuple[Array, list[str]]:
    """Cells below the first line, NaN where one is empty, and those of the first line."""
    if not os.path.isfile(path):
        raise InputError(f"no file {str(path)!r}: give the text of the laser's profiles")
    if path.stat().st_size > _MOST_BYTES:
        raise InputError(f"{path.name!r} has {path.stat().st_size / 1e6:.0f} MB, more than {_MOST_BYTES / 1e6:.0f}")
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path.name!r} is no text in UTF-8: {error_line(error)}") from error
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    if len(lines) <= _FEWEST:
        raise InputError(f"{path.name!r} has {len(lines)} lines; a heading and {_FEWEST} more are the least")
    mark = next((mark for mark in (";", "\t", ",") if mark in lines[0]), None)
    heading = [cell.strip() for cell in (lines[0].split(mark) if mark else lines[0].split())]
    body = "\n".join(lines[1:])
    if mark in (";", "\t", None):
        body = body.replace(",", ".")
        heading = [cell.replace(",", ".") for cell in heading]
    if mark is not None:
        body = _EMPTY[mark].sub("nan", body)
    if len(heading) * (len(lines) - 1) > _MOST_VALUES:
        raise InputError(f"{path.name!r} has more than {_MOST_VALUES} values; leave out profiles, or columns")
    try:
        numbers = np.loadtxt(body.split("\n"), delimiter=mark, ndmin=2, comments=None)
    except ValueError as error:
        raise InputError(
            f"{path.name!r} has a cell that is no number, or lines of unlike length: {error_line(error)}"
        ) from error
    if numbers.shape[1] != len(heading):
        raise InputError(
            f"{path.name!r} has {numbers.shape[1]} numbers a line below a heading of {len(heading)} cells"
        )
    if np.isinf(numbers).any():
        raise InputError(f"{path.name!r} has a number that is infinite; a cell without a value is empty or NaN")
    return numbers, heading


def _places(heading: list[str], columns: int, path: Path) -> Array:
    """Places x of the columns of the layout rows."""
    try:
        x = np.array([float(cell) for cell in heading[1:]])
    except ValueError as error:
        raise InputError(
            f"the first line of {path.name!r} must have a word and then the places x of the columns "
            f"({error_line(error)})"
        ) from error
    if columns < _FEWEST or not np.isfinite(x).all() or not ((np.diff(x) > 0).all() or (np.diff(x) < 0).all()):
        raise InputError(
            f"the places x in the first line of {path.name!r} must be {_FEWEST} or more and rise, or fall, throughout"
        )
    return x


def _gathered(numbers: Array, path: Path) -> tuple[Array, Array, Array]:
    """Encoder (n,), places and heights (n, m) of points that follow each other."""
    if numbers.shape[1] != 3:
        raise InputError(f"{path.name!r} must have three columns, encoder, x and z, and has {numbers.shape[1]}")
    first = np.flatnonzero(np.r_[True, np.diff(numbers[:, 0]) != 0])
    of = np.cumsum(np.r_[False, np.diff(numbers[:, 0]) != 0])
    x = numbers[:, 1]
    steps = np.diff(x)[np.diff(of) == 0]
    steps = np.abs(steps[np.isfinite(steps) & (steps != 0)])
    if not steps.size:
        raise InputError(f"the profiles of {path.name!r} have one point each: points of one must follow each other")
    step, low = float(np.median(steps)), float(np.nanmin(x))
    width = (float(np.nanmax(x)) - low) / step
    if not width * len(first) <= _MOST_VALUES:
        raise InputError(
            f"the points of {path.name!r} lie too unevenly over x: {width:.3g} columns of their usual step"
        )
    columns = round(width) + 1
    valid = np.isfinite(x) & np.isfinite(numbers[:, 2])
    cell = of[valid] * columns + np.rint((x[valid] - low) / step).astype(np.int64)
    count = np.bincount(cell, minlength=len(first) * columns)
    with np.errstate(invalid="ignore", divide="ignore"):
        sums: Any = [np.bincount(cell, part[valid], len(count)) / count for part in (x, numbers[:, 2])]
    return numbers[first, 0], *(cell_sum.reshape(len(first), columns) for cell_sum in sums)
