"""Tekscan's ASCII export (.asf, .csv, .txt of I-Scan): a header of keys, then frames of rows.

Layout after six independent public readers and one real header; the binary .fsx is closed.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from treadload.errors import InputError
from treadload.footprint.frames import Frames
from treadload.footprint.spelling import is_counts, length, pressure_factor
from treadload.kernels.arrays import Array
from treadload.tables import Table
from treadload.units import leading_number, quantity

_KEY = re.compile(r"(?P<key>[A-Za-z][A-Za-z0-9_ ]*?):?\s+(?P<rest>.*)")
_DATA, _END = "ASCII_DATA", "@@"
_FRAME = re.compile(r"Frame\s+(?P<number>[0-9]{1,9})\s*(?:[,;].*)?", re.IGNORECASE)
_SUM = re.compile(r"Raw Sum\s*=\s*(?P<sum>[0-9]+(?:\.[0-9]+)?)", re.IGNORECASE)
# Rows that numpy reads as the reader of tables would: no letters, no zeros in front, no marks but points.
_SIMPLE = re.compile(r"[0-9.,+\-B ]*")
_LEADING_ZERO = re.compile(r"(?:^|[,+\- ])0[0-9]")
_HOLE = "B"
# Full scale of counts of eight bits, and digits that a header prints.
_FULL, _DIGITS = 255, 0.01
# Sums of rounded values.
_SUM_DIGITS = 0.005
_LAW_KEYS = ("SCALE_FACTOR", "EXPONENT")


def looks_like(text: str) -> bool:
    """True if a text begins as such an export does."""
    head = text[:20_000]
    marks = re.findall(r"^(?:DATA_TYPE|ASCII_DATA|ROWS|COLS|SENSEL_AREA|SENSOR_TYPE|ROW_SPACING)\b", head, re.M)
    return len(set(marks)) >= 2


def read(path: Path, text: str) -> Frames:
    """Frames of an export. Raises InputError that names the line for what cannot be read, or is at odds."""
    lines = re.split(r"\r\n|\r|\n", text)
    start = next((n for n, line in enumerate(lines) if line.strip().startswith(_DATA)), None)
    if start is None:
        raise InputError(f"{path} has a header of Tekscan and no line {_DATA}; export it again, with its data")
    header = _Header(path, _keys(lines[:start]))
    frames = _frames(path, lines, start + 1)
    if not frames:
        raise InputError(f"{path} has no frame behind {_DATA}; export the frames with the header")
    maps = [_values(path, frame, header) for frame in frames]
    for frame, sensels in zip(frames, maps, strict=True):
        if sensels.shape != maps[0].shape:
            raise InputError(
                f"{path}, line {frame.line}: frame {frame.number} has {sensels.shape[0]} x {sensels.shape[1]} "
                f"values, the first frame {maps[0].shape[0]} x {maps[0].shape[1]}; the file is cut or was edited: "
                "export it again"
            )
    return _assembled(path, header, frames, np.stack(maps))


@dataclass(frozen=True)
class _Frame:
    """Rows of a frame with the numbers of their lines; what its own line states about the sum."""

    number: int
    line: int
    rows: tuple[str, ...]
    lines: tuple[int, ...]
    raw_sum: float | None


@dataclass(frozen=True)
class _Header:
    """Keys of the header with their lines, read when asked for."""

    path: Path
    keys: Mapping[str, tuple[int, str]]

    def text(self, key: str) -> str | None:
        """What a key states, None if it is not there or empty."""
        return self.keys[key][1] if key in self.keys and self.keys[key][1] else None

    def fault(self, key: str, why: str) -> InputError:
        """An error that names the line of a key."""
        return InputError(f"{self.path}, line {self.keys[key][0]}: {key} {why}")

    def whole(self, key: str) -> int | None:
        """A whole number."""
        text = self.text(key)
        if text is None:
            return None
        if not re.fullmatch("[0-9]{1,9}", text):
            raise self.fault(key, f"is {text!r}, not a whole number; correct the header")
        return int(text)

    def number(self, key: str) -> float | None:
        """A pure number."""
        text = self.text(key)
        if text is None:
            return None
        try:
            return quantity(text, "")
        except InputError as error:
            raise self.fault(key, f"is {text!r}, not a number; correct the header") from error

    def length(self, key: str) -> float | None:
        """A length, m, with its unit."""
        text = self.text(key)
        if text is None:
            return None
        try:
            metres = length(text)
        except InputError as error:
            raise self.fault(key, f"is {text!r}, which needs a number and a unit such as mm or cm") from error
        if not metres > 0:
            raise self.fault(key, f"is {text!r} and must be above 0; correct the header or give spacing=")
        return metres


def _keys(lines: Sequence[str]) -> dict[str, tuple[int, str]]:
    """Keys of a header with the number of their line; of one that comes twice the first."""
    keys: dict[str, tuple[int, str]] = {}
    for number, line in enumerate(lines, start=1):
        match = _KEY.fullmatch(line.strip("\ufeff \t") + " ")
        if match is not None:
            keys.setdefault(match["key"].upper(), (number, match["rest"].strip()))
    return keys


def _frames(path: Path, lines: Sequence[str], start: int) -> list[_Frame]:
    frames: list[_Frame] = []
    head: tuple[int, int, float | None] | None = None
    rows: list[tuple[int, str]] = []

    def close() -> None:
        if head is not None:
            numbers = tuple(number for number, _ in rows)
            frames.append(_Frame(head[0], head[1], tuple(row for _, row in rows), numbers, head[2]))
        elif rows:
            raise InputError(f"{path}, line {rows[0][0]}: values come before the first line Frame; export it again")
        rows.clear()

    for number, line in enumerate(lines[start:], start=start + 1):
        bare = line.strip(" \t")
        if bare.lower().startswith("frame"):
            close()
            match = _FRAME.fullmatch(bare)
            if match is None:
                raise InputError(f"{path}, line {number}: cannot read {bare[:60]!r} as the line of a frame")
            summed = _SUM.search(bare)
            head = (int(match["number"]), number, float(summed["sum"]) if summed else None)
        elif bare == _END:
            break
        elif bare:
            rows.append((number, bare))
    close()
    return frames


def _values(path: Path, frame: _Frame, header: _Header) -> Array:
    """Values (rows, columns) of a frame, NaN where there is no sensel."""
    wanted = (header.whole("ROWS"), header.whole("COLS"))
    if wanted[0] == 0 or wanted[1] == 0 or not frame.rows:
        count = len(frame.rows) if frame.rows or wanted[0] is None else wanted[0]
        raise InputError(
            f"{path}, line {frame.line}: frame {frame.number} has {count} rows"
            + (f" of {wanted[1]} values" if wanted[1] is not None else "")
            + "; export a sensor with rows and columns"
        )
    if wanted[0] is not None and len(frame.rows) != wanted[0]:
        raise InputError(
            f"{path}, line {frame.line}: frame {frame.number} has {len(frame.rows)} rows, the header has ROWS "
            f"{wanted[0]}; the file is cut or was edited: export it again"
        )
    separator = next((mark for mark in (";", "\t") if mark in frame.rows[0]), ",")
    rows = [row.rstrip(separator).split(separator) for row in frame.rows]
    columns = len(rows[0]) if wanted[1] is None else wanted[1]
    for line, row in zip(frame.lines, rows, strict=True):
        if len(row) != columns:
            says = "the first row" if wanted[1] is None else "the header has COLS"
            raise InputError(
                f"{path}, line {line}: {len(row)} values, {says} {columns}; the file is cut or was edited: export it "
                "again"
            )
    text = ",".join(",".join(row) for row in rows) if separator == "," else ""
    if text and _SIMPLE.fullmatch(text) and not _LEADING_ZERO.search(text):
        try:
            values = np.array(text.replace(_HOLE, "nan").split(","), dtype=float).reshape(len(rows), columns)
        except ValueError:
            pass
        else:
            if not np.isinf(values).any():
                return values
    cells = tuple(tuple("NaN" if cell.strip() == _HOLE else cell.strip() for cell in row) for row in rows)
    table = Table(path, cells, frame.lines, separator, "." if separator == "," else None)
    values, _ = table.values(name=lambda column: f"frame {frame.number}: the value")
    return values


def _assembled(path: Path, header: _Header, frames: Sequence[_Frame], values: Array) -> Frames:
    rows, columns = header.length("ROW_SPACING"), header.length("COL_SPACING")
    _check_area(header, rows, columns)
    first, last = header.whole("START_FRAME"), header.whole("END_FRAME")
    if first is not None and last is not None and last - first + 1 != len(frames):
        raise header.fault(
            "END_FRAME",
            f"and START_FRAME announce {last - first + 1} frames, the file holds {len(frames)}; it is cut or was "
            "edited: export it again",
        )
    unit = header.text("UNITS")
    counts = unit is not None and is_counts(unit)
    warnings: list[str] = []
    law = saturation = None
    try:
        law = (pressure_factor(unit), 1.0) if unit is not None and not counts else None
    except InputError as error:
        raise header.fault("UNITS", f"is wrong: {error}; correct the header") from error
    if counts:
        law, saturation = _law(header), float(_FULL)
        for frame, map_ in zip(frames, values, strict=True):
            top, total = float(np.nanmax(map_, initial=0.0)), float(np.nansum(map_))
            if top > _FULL:
                raise header.fault(
                    "UNITS",
                    f"is {unit}, counts of 0 to {_FULL}, and frame {frame.number} holds {top:g}; one is wrong",
                )
            if frame.raw_sum is not None and abs(total - frame.raw_sum) > _SUM_DIGITS * max(total, frame.raw_sum):
                raise InputError(
                    f"{path}, line {frame.line}: frame {frame.number} sums up to {total:g} and has Raw Sum="
                    f"{frame.raw_sum:g}; the file was edited: export it again"
                )
    elif law is not None:
        saturation = _saturation(header, law[0], values)
    threshold = header.number("NOISE_THRESHOLD")
    if threshold is not None and not counts:
        # It is in counts; what a count is worth only the law of the sensor tells.
        header_law = _law(header)
        threshold = None if header_law is None or law is None else header_law[0] * threshold ** header_law[1] / law[0]
    if counts and law is None:
        warnings.append("its values are raw counts without a calibration in the header")
    notes = [f"{path.name}: Tekscan ASCII", *([f"sensor {kind}"] if (kind := header.text("SENSOR_TYPE")) else [])]
    notes.append(f"values in {unit}" if unit is not None else "values without a unit")
    if law is not None and counts:
        notes.append(f"pressure = {law[0]:g} Pa x raw^{law[1]:g}, as its header states")
    turned = [key for key in ("MIRROR_ROW", "MIRROR_COL") if header.text(key) not in (None, "0")]
    if turned:
        notes.append(f"exported with {' and '.join(turned)}")
    return Frames(
        values, rows, columns, law, not counts and unit is not None, saturation, threshold,
        numbers=tuple(frame.number for frame in frames), source=", ".join(notes), warnings=tuple(warnings),
    )  # fmt: skip


def _check_area(header: _Header, rows: float | None, columns: float | None) -> None:
    """Refuse an area of the sensels that is not that of their spacing."""
    text = header.text("SENSEL_AREA")
    if text is None or rows is None or columns is None:
        return
    try:
        area = quantity(text.replace("²", "2"), "m^2")
    except InputError as error:
        raise header.fault(
            "SENSEL_AREA", f"is {text!r}, which needs a number and a unit such as mm2 or cm2"
        ) from error
    if abs(area - rows * columns) > _DIGITS * rows * columns:
        raise header.fault(
            "SENSEL_AREA",
            f"is {text}, and ROW_SPACING times COL_SPACING {rows * columns * 1e6:.5g} mm2; correct the one that is "
            "wrong, the load depends on it",
        )


def _law(header: _Header) -> tuple[float, float] | None:
    """Scale, Pa, and exponent of pressure = scale * raw ** exponent, where the header states them and their unit."""
    scale, exponent = (header.number(key) for key in _LAW_KEYS)
    full = header.text("SATURATION_PRESSURE")
    if scale is None or exponent is None or full is None:
        return None
    number, unit = leading_number(full)
    try:
        worth = pressure_factor(unit)
    except InputError as error:
        raise header.fault("SATURATION_PRESSURE", f"is {full!r}: {error}") from error
    if not (scale > 0 and 0 < exponent < 10):
        raise header.fault("SCALE_FACTOR", f"is {scale:g} and EXPONENT {exponent:g}; both must be above 0")
    top = scale * _FULL**exponent
    if not math.isclose(top, number, rel_tol=_DIGITS):
        raise header.fault(
            "SATURATION_PRESSURE",
            f"is {full}, and SCALE_FACTOR * {_FULL} ** EXPONENT {top:.6g}; one of them is wrong: export it again or "
            "give calibration=",
        )
    return scale * worth, exponent


def _saturation(header: _Header, factor: float, values: Array) -> float | None:
    """Largest value that the sensor can read, in the unit of the values."""
    text = header.text("SATURATION_PRESSURE")
    if text is None:
        return None
    try:
        number, unit = leading_number(text)
        full = number * pressure_factor(unit) / factor
    except InputError as error:
        raise header.fault(
            "SATURATION_PRESSURE", f"is {text!r}, which needs a number and a unit of pressure"
        ) from error
    top = float(np.nanmax(values, initial=0.0))
    if top > full * (1 + _DIGITS):
        raise header.fault(
            "SATURATION_PRESSURE",
            f"is {text}, and the data hold {top / full:.3g} times as much; UNITS is {header.text('UNITS')}: one of "
            "them is wrong",
        )
    return full if full > 0 else None
