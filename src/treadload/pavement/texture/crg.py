"""OpenCRG: a road's heights on a grid along a reference line, as ASAM's specification 1.2 has it.

Read: comments, road parameters, data definition, options of borders, road data of all four formats (LRFI, LDFI, KRBI,
KDBI). Refused: references to other files, and modifiers that change something. Evaluated: z at (u, v), bilinear
between the points, with slope and banking, beyond the borders by their modes. Where the reference line runs on the
map, phi, x and y, is read past.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from treadload.errors import InputError, one_line
from treadload.kernels.arrays import Array, BoolArray
from treadload.pavement.texture.description import Texture

# Format → (bytes of a number in binary, 0 in text; characters of a number in text; bytes of a record).
_FORMATS = {"KRBI": (4, 0), "KDBI": (8, 0), "LRFI": (0, 10), "LDFI": (0, 20)}
_RECORD = 80
_KEY = re.compile(r"^\s*([A-Za-z_0-9]+)\s*=\s*(\S+)\s*$")
_AT = re.compile(r"^long section at v\s*=\s*(\S+)$", re.IGNORECASE)
_NUMBERED = re.compile(r"^long section\s+(\d+)$", re.IGNORECASE)
# Modifiers at these values change nothing.
_NEUTRAL = {
    "scale_z_grid": 1.0, "scale_slope": 1.0, "scale_banking": 1.0, "scale_length": 1.0, "scale_width": 1.0,
    "scale_curvature": 1.0, "grid_nan_mode": 0.0, "grid_nan_offset": 0.0,
}  # fmt: skip
NONE, ZERO, KEEP, REPEAT, REFLECT = range(5)
_MOST_POINTS = 50_000_000


@dataclass(frozen=True, eq=False)
class CurvedGrid:
    """Heights over u, along the reference line, and v, to its left, m.

    u, v: (nu,), (nv,), rising; u in even steps. grid: (nu, nv), m, NaN where none is known. banking, slope: (nu,),
    m/m, zero where the file has none. start: height of the reference line where it begins, m. options: of the
    borders, by their names in small letters.
    """

    u: Array
    v: Array
    grid: Array
    banking: Array
    slope: Array
    start: float = 0.0
    options: Mapping[str, float] = field(default_factory=dict)
    source: str = ""

    def z(self, u: Array, v: Array) -> Array:
        """Height, m, at places (u, v), m, of one shape: the grid, bilinear, and the line's slope and banking.

        Beyond the borders by border_mode_u and border_mode_v: 0 NaN, 1 zero, 2 the last value (if left out), 3
        repeated, 4 mirrored; with their offsets.
        """
        u, v = np.broadcast_arrays(np.asarray(u, float), np.asarray(v, float))
        step = self.u[1] - self.u[0]
        at_u, out_u = _bordered(u, self.u[0], self.u[-1], self._mode("u"))
        at_v, out_v = _bordered(v, self.v[0], self.v[-1], self._mode("v"))
        i, along = _cell((at_u - self.u[0]) / step, self.u.size)
        j = np.clip(np.searchsorted(self.v, at_v, side="right") - 1, 0, self.v.size - 2)
        across = np.clip((at_v - self.v[j]) / (self.v[j + 1] - self.v[j]), 0.0, 1.0)
        total = np.zeros(u.shape)
        for di, wu in ((0, 1 - along), (1, along)):
            for dj, wv in ((0, 1 - across), (1, across)):
                # A point of no weight does not count, though it be NaN.
                weight = wu * wv
                total = total + np.where(weight > 0, weight * self.grid[i + di, j + dj], 0.0)
        zero_u, zero_v = out_u & (self._mode("u") == ZERO), out_v & (self._mode("v") == ZERO)
        total = np.where(zero_v, 0.0, total)
        # OpenCRG's own evaluation goes round with v in banking only where the sections are evenly spaced.
        aside = at_v if self._even else np.clip(v, self.v[0], self.v[-1])
        total = total + self._line(at_u) + np.interp(at_u, self.u, self.banking) * aside
        offset = np.zeros(u.shape)
        for axis, out in (("u", out_u), ("v", out_v)):
            offset = offset + out * self.options.get(f"border_offset_{axis}", 0.0) * (
                self._mode(axis) in (ZERO, KEEP)
            )
        # And beyond a corner where u keeps its last value, the reference line is kept as well.
        total = np.where(zero_u | (zero_v & ~(out_u & (self._mode("u") == KEEP))), 0.0, total) + offset
        unknown = (out_u & (self._mode("u") == NONE)) | (out_v & (self._mode("v") == NONE))
        return np.where(unknown, np.nan, total)

    def texture(self) -> Texture:
        """The heights as a texture: u along travel, -v to the right; its reference line as straight and level.

        Raises InputError where the v are not evenly spaced.
        """
        steps = np.diff(self.v)
        if not self._even:
            raise InputError(
                f"the sections of {self.source!r} lie {steps.min():g} to {steps.max():g} m apart across, and a "
                "texture needs even steps; take z(u, v) of pavement.texture.read_crg at places of your own"
            )
        heights = self.grid[:, ::-1].T
        step = float(self.u[1] - self.u[0])
        return Texture(heights, step, float(steps[0]), source=f"OpenCRG {self.source}")

    @property
    def _even(self) -> bool:
        steps = np.diff(self.v)
        return bool(np.allclose(steps, steps[0], rtol=1e-6))

    def _mode(self, axis: str) -> int:
        return int(self.options.get(f"border_mode_{axis}", KEEP))

    def _line(self, u: Array) -> Array:
        """Height of the reference line, m: its slope summed up, each value that of the step behind it."""
        step = self.u[1] - self.u[0]
        raised = self.start + np.concatenate([[0.0], np.cumsum(self.slope[1:] * step)])
        return np.asarray(np.interp(u, self.u, raised))


def _bordered(at: Array, first: float, last: float, mode: int) -> tuple[Array, BoolArray]:
    """Places within the borders that stand for those beyond, and which lay beyond."""
    out = (at < first) | (at > last)
    length = last - first
    if mode == REPEAT:
        return np.where(out, first + np.mod(at - first, length), at), out
    if mode == REFLECT:
        away = np.mod(at - first, 2 * length)
        return np.where(out, first + np.minimum(away, 2 * length - away), at), out
    return np.clip(at, first, last), out


def _cell(place: Array, count: int) -> tuple[Array, Array]:
    low = np.clip(np.floor(place).astype(int), 0, count - 2)
    return low, np.clip(place - low, 0.0, 1.0)


def read_crg(path: Path) -> CurvedGrid:
    """The grid of an OpenCRG file. Raises InputError with what is wrong in it."""
    path = Path(path)
    raw = path.read_bytes()
    head, body = _parted(raw)
    blocks = _blocks(head)
    if "ct" not in blocks:
        raise InputError(f"{path.name!r} does not begin with $CT, as every OpenCRG file does")
    if blocks.get("road_crg_file"):
        raise InputError(
            f"{path.name!r} refers to other files ($ROAD_CRG_FILE); give the file that has the road data"
        )
    if body is None:
        raise InputError(f"{path.name!r} has no line of $$$$, below which the road data of an OpenCRG file begin")
    _check_modifiers(_numbers(blocks.get("road_crg_mods", []), path.name), path.name)
    road = _numbers(blocks.get("road_crg", []), path.name)
    options = _options(_numbers(blocks.get("road_crg_opts", []), path.name), path.name)
    kind, channels = _channels(blocks.get("kd_definition", []), path.name)
    data = _data(body, kind, len(channels), path.name)
    step = road.get("reference_line_increment")
    if step is None or not step > 0:
        raise InputError(f"{path.name!r} needs REFERENCE_LINE_INCREMENT > 0 in $ROAD_CRG, got {step}")
    first = road.get("reference_line_start_u", 0.0)
    u = first + step * np.arange(len(data))
    end = road.get("reference_line_end_u")
    if end is not None and abs(end - u[-1]) > 0.5 * step:
        raise InputError(
            f"{path.name!r} states that it ends at u = {end:g} m, and its {len(data)} rows end at {u[-1]:g} m: rows "
            "are missing or too many"
        )
    sections = [k for k, (name, _) in enumerate(channels) if name == "z"]
    v = _across(road, [channels[k][1] for k in sections], path.name)
    named = {name: data[:, k] for k, (name, _) in enumerate(channels) if name in ("banking", "slope")}
    constant = {
        "banking": road.get("reference_line_start_b", 0.0), "slope": road.get("reference_line_start_s", 0.0),
    }  # fmt: skip
    banking, slope = (named.get(axis, np.full(len(u), constant[axis])) for axis in ("banking", "slope"))
    if not np.isfinite(banking).all() or not np.isfinite(slope[1:]).all():
        raise InputError(f"{path.name!r} has a banking or slope that is no number")
    slope = np.concatenate([[0.0], slope[1:]])
    order = np.argsort(v)
    start = road.get("reference_line_start_z", 0.0)
    return CurvedGrid(u, v[order], data[:, sections][:, order], banking, slope, start, options, path.name)


def _parted(raw: bytes) -> tuple[list[str], bytes | None]:
    """Lines before the one of $$$$, and what comes after it; None of no such line."""
    marker = re.search(rb"^\$\$\$\$[^\r\n]*(\r\n|\n|\r)", raw, re.MULTILINE)
    if marker is None:
        return raw.decode("latin-1").splitlines(), None
    return raw[: marker.start()].decode("latin-1").splitlines(), raw[marker.end() :]


def _blocks(lines: list[str]) -> dict[str, list[str]]:
    blocks: dict[str, list[str]] = {}
    current: list[str] | None = None
    for line in lines:
        if line.startswith("$"):
            word = re.match(r"^\$([A-Za-z_]+)", line)
            current = None if word is None else blocks.setdefault(word[1].lower(), [])
        elif current is not None and not line.startswith("*"):
            text = line.split("!", 1)[0].rstrip()
            if text.strip():
                current.append(text)
    return blocks


def _numbers(lines: list[str], name: str) -> dict[str, float]:
    options = {}
    for line in lines:
        pair = _KEY.match(line)
        try:
            assert pair is not None
            value = float(pair[2].replace("d", "e").replace("D", "e"))
        except (AssertionError, ValueError) as error:
            raise InputError(f"{name!r}: expected NAME = number, got {one_line(line)!r}") from error
        if not math.isfinite(value):
            raise InputError(f"{name!r}: {pair[1]} is no finite number: {pair[2]}")
        options[pair[1].lower()] = value
    return options


def _check_modifiers(options: Mapping[str, float], name: str) -> None:
    active = [key for key, value in options.items() if value != _NEUTRAL.get(key, math.nan)]
    if active:
        raise InputError(
            f"{name!r} changes its data by {active[0].upper()} in $ROAD_CRG_MODS, which is not followed here; apply "
            "it with the tools of OpenCRG and write the result"
        )


def _options(options: Mapping[str, float], name: str) -> dict[str, float]:
    for axis in ("u", "v"):
        mode = options.get(f"border_mode_{axis}", KEEP)
        if mode not in range(5):
            raise InputError(f"{name!r}: BORDER_MODE_{axis.upper()} must be 0, 1, 2, 3 or 4, got {mode:g}")
    if any(options.get(f"border_smooth_u{end}", 0.0) for end in ("beg", "end")):
        raise InputError(f"{name!r} smooths its borders (BORDER_SMOOTH_U…), which is not followed here; set it to 0")
    return {key: value for key, value in options.items() if key.startswith("border_")}


def _channels(lines: list[str], name: str) -> tuple[str, list[tuple[str, float | None]]]:
    kind, channels = "KRBI", []
    for line in lines:
        tag, _, rest = line.strip().partition(":")
        if tag == "#":
            kind = rest.strip().upper()
            if kind not in _FORMATS:
                raise InputError(
                    f"{name!r} has road data of the format {one_line(kind)!r}; known are {', '.join(_FORMATS)}"
                )
        elif tag.upper() == "D":
            channels.append(_channel(rest, name))
        elif tag.upper() != "U":
            raise InputError(f"{name!r}: expected #:, D: or U: in $KD_Definition, got {one_line(line)!r}")
    if not any(name == "z" for name, _ in channels):
        raise InputError(f"{name!r} defines no long section (D:long section …) in $KD_Definition")
    return kind, channels


def _channel(text: str, name: str) -> tuple[str, float | None]:
    what, _, unit = text.rpartition(",")
    what = " ".join(what.split())
    for key in ("phi", "banking", "slope"):
        if what.lower() == f"reference line {key}":
            return key, None
    if unit.strip() != "m":
        raise InputError(f"{name!r}: a long section must be in m, got {one_line(text)!r}")
    at, numbered = _AT.match(what), _NUMBERED.match(what)
    if numbered is not None:
        return "z", None
    try:
        assert at is not None
        place = float(at[1])
        assert math.isfinite(place)
    except (AssertionError, ValueError) as error:
        raise InputError(f"{name!r}: the channel {one_line(text)!r} is none of OpenCRG's") from error
    return "z", place


def _across(road: Mapping[str, float], places: list[float | None], name: str) -> Array:
    """Places of the sections across, m: of their own, or by two of right border, left border and increment."""
    if len(places) < 2:
        raise InputError(f"{name!r} has {len(places)} long section; a grid needs two or more")
    stated = [place for place in places if place is not None]
    count = len(places)
    if stated:
        if len(stated) < count or len(set(stated)) < count:
            raise InputError(f"{name!r}: every long section needs a v of its own, or none of them")
        return np.array(stated)
    right, left, step = (road.get(f"long_section_v_{edge}") for edge in ("right", "left", "increment"))
    if right is None and left is None and step is not None:
        right, left = -0.5 * (count - 1) * step, 0.5 * (count - 1) * step
    elif right is not None and left is None and step is not None:
        left = right + (count - 1) * step
    elif left is not None and right is None and step is not None:
        right = left - (count - 1) * step
    if right is None or left is None or not left > right:
        raise InputError(
            f"{name!r} does not state where its long sections lie; it needs LONG_SECTION_V_RIGHT and _LEFT"
        )
    if step is not None and abs(right + (count - 1) * step - left) > 0.5 * step:
        raise InputError(
            f"{name!r}: {count} long sections every {step:g} m do not reach from {right:g} to {left:g} m across"
        )
    return np.linspace(right, left, count)


def _data(body: bytes, kind: str, columns: int, name: str) -> Array:
    binary, wide = _FORMATS[kind]
    values = _binary(body, binary, columns, name) if binary else _text(body, wide, columns, name)
    if len(values) < 2:
        raise InputError(f"{name!r} has {len(values)} rows of road data; a grid needs two or more")
    if np.isinf(values).any():
        raise InputError(f"{name!r} has {int(np.isinf(values).sum())} infinite values in its road data")
    return values


def _binary(body: bytes, size: int, columns: int, name: str) -> Array:
    if len(body) % _RECORD:
        raise InputError(
            f"{name!r}: its binary road data have {len(body)} bytes, not a whole number of records of {_RECORD}: it "
            "was cut off, or is no binary file"
        )
    values = np.frombuffer(body, f">f{size}").astype(float)
    if values.size > _MOST_POINTS:
        raise InputError(f"{name!r} has {values.size} numbers, more than {_MOST_POINTS:.0e}; cut a piece of it")
    rows = values.size // columns
    rest = values[rows * columns :]
    # The last record is filled up with NaN, which may make whole rows of few columns.
    while (
        rows > 1
        and values.size - (rows - 1) * columns <= _RECORD // size
        and (np.isnan(values[(rows - 1) * columns : rows * columns]).all())
    ):
        rows -= 1
    if not np.isnan(rest).all():
        raise InputError(f"{name!r}: {values.size} numbers are no rows of {columns} channels; it was cut off")
    return values[: rows * columns].reshape(rows, columns)


def _text(body: bytes, wide: int, columns: int, name: str) -> Array:
    """Rows that begin in a record of their own; a number has a width, one that begins with * is not known.

    Records of more than 80 characters are read as well, as the example files of OpenCRG have them.
    """
    lines = [line for line in body.decode("latin-1").splitlines() if line.strip()]
    rows: list[list[float]] = []
    row: list[float] = []
    for number, line in enumerate(lines, start=1):
        row += [_number(cell, number, name) for cell in _cells(line.rstrip(), wide)]
        if len(row) > columns:
            raise InputError(f"{name!r}: row {len(rows) + 1} of its road data has more than its {columns} channels")
        if len(row) == columns:
            rows.append(row)
            row = []
    if row:
        raise InputError(
            f"{name!r}: the last row of its road data has {len(row)} of {columns} channels; it was cut off"
        )
    return np.array(rows, dtype=float).reshape(len(rows), columns)


def _cells(line: str, wide: int) -> list[str]:
    # The first field may be one longer: "**unused**" and a leading blank.
    return [line[k : k + wide] for k in range(0, len(line), wide)]


def _number(cell: str, row: int, name: str) -> float:
    text = cell.strip()
    if text.startswith("*"):
        return math.nan
    try:
        value = float(text.replace("D", "e").replace("d", "e"))
    except ValueError as error:
        raise InputError(f"{name!r}: {one_line(text)!r} in row {row} of its road data is no number") from error
    return value
