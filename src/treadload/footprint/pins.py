"""Three-component pin tables: what pins in a road measured while a tire rolled over them, as a CSV that declares it.

A pin reads means over its face, which is narrower than the distance to the next pin. The footprint has a cell for
every reading; the size of the face goes with it, so that a computed contact is averaged over faces, too.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from treadload.errors import InputError, meant, positive
from treadload.footprint.frames import Frames
from treadload.footprint.spelling import pressure_factor
from treadload.kernels.arrays import Array
from treadload.labels import factor
from treadload.response.measured import places
from treadload.tables import Table, read_table
from treadload.units import quantity

_STRESSES = {"vertical": "pressure", "longitudinal": "traction_x", "lateral": "traction_y"}
_PLACES = {"y": "m", "x": "m", "time": "s"}
_ALSO = {"t": "time", "z": "vertical", "normal": "vertical", "transverse": "lateral"}
_NEEDED = ("y", "vertical", "longitudinal", "lateral")
_HEADING = re.compile(r"\s*(?P<name>[^\[(]*?)\s*(?:[\[(](?P<unit>[^\])]*)[\])])?\s*$")
_DECLARED = re.compile(r"#\s*(?P<key>[A-Za-z][A-Za-z _]*?)\s*:\s*(?P<value>.+?)\s*$")
_ROUND = re.compile(r"^(?P<size>.+?)\s+(?:round|diameter)$")
_BY = re.compile(r"\s*(?:[x×]|by)\s+")
_KEYS = ("pin", "speed")
# Faces of pins that have been built are 5 to 60 mm wide, m.
_SMALLEST, _LARGEST = 1e-3, 0.1
# Pins closer than this part of their face overlap, which rounding of their places does not explain.
_OVERLAP = 0.98
# Shear beyond this part of the vertical stress, both at their largest, is no rubber's; the columns may be swapped.
_MOST_SHEAR = 1.5


@dataclass(frozen=True)
class _Column:
    """A column that is read. place: in the row. unit: as it stands there. to_si: factor; of a force by the face."""

    place: int
    unit: str
    to_si: float


def looks_like(text: str) -> bool:
    """True for a table whose first line that is no comment names y, vertical and a shear."""
    for line in text.splitlines():
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        names = {_name(cell) for cell in re.split(r"[;,\t]", line)}
        return {"y", "vertical"} <= names and bool({"longitudinal", "lateral"} & names)
    return False


def read(
    path: Path,
    *,
    units: Mapping[str, str] | None = None,
    noise: float | str = 0.0,
    decimal: str | None = None,
    pin: float | str | tuple[float | str, float | str] | None = None,
    speed: float | str | None = None,
) -> Frames:
    """The readings of a pin table.

    The header names the columns y, x or time, vertical, longitudinal and lateral, each with its unit in brackets;
    stresses, or the forces on a pin. Lines of comment above it declare the layout:

        # pin: 9.7 mm            side of a square face; "9.7 mm round"; "12 mm x 8 mm" along travel and across it
        # speed: 1.2 m/s         with time in place of x

    y: of the pins, to the right of travel. x: of a reading in the footprint, ahead positive; time: a pin stands and
    the tire comes, so that later readings lie further behind. vertical: compression positive. longitudinal, lateral:
    along travel and to the right, on the road, or on the tire with shear_on.
    units: {"vertical": "kPa"}, of columns whose heading names none; one for "pressure" serves all three.
    noise: readings of a vertical stress this far below zero, Pa or a text, are none. decimal: as in
    `tables.read_table`. pin, speed: in place of what the file declares.
    Pins stand at even distances, and so do readings; a pin without a reading there is missing.
    Raises InputError for a missing column, unit or layout, with the line to write.
    """
    table = read_table(path, decimal=decimal)
    declared = _declared(path)
    face = _face(path, declared.get("pin") if pin is None else pin)
    columns = _columns(table, dict(units or {}), face)
    if len(table.rows) < 2:
        raise InputError(f"{path} has a header and no readings; a row is a reading of one pin")
    names = list(columns)
    values, how = table.values([columns[name].place for name in names], first=1, name=names.__getitem__)
    read_of = {name: columns[name].to_si * column for name, column in zip(names, values.T, strict=True)}
    lines = table.lines[1:]
    for name in ("y", "x", "time"):
        if name in read_of and np.isnan(read_of[name]).any():
            raise InputError(f"{path}, line {lines[int(np.isnan(read_of[name]).argmax())]}: {name} is missing")
    if "time" in read_of:
        read_of["x"] = -_speed(path, declared.get("speed") if speed is None else speed) * read_of.pop("time")
    x0, nx, dx, i = places(path, "x", read_of["x"], lines, None)
    single = float(np.ptp(read_of["y"])) <= 1e-6 * face[1]
    y0, ny, dy, j = places(path, "y", read_of["y"], lines, face[1] if single else None)
    if dy < _OVERLAP * face[1]:
        raise InputError(
            f"{path}: pins {face[1] * 1e3:.3g} mm wide are {dy * 1e3:.3g} mm apart, so that they overlap; correct "
            '"# pin:", or split passes that lay between each other into files'
        )
    fields = _fields(path, read_of, lines, (ny, nx), (j, i))
    floor = quantity(noise, "Pa")
    pressure = fields["vertical"]
    pressure[(pressure < 0) & (pressure >= -floor)] = 0.0
    words = ", ".join(f"{name} in {columns[name].unit}" for name in names)
    shape = f"{face[0] * 1e3:.3g} x {face[1] * 1e3:.3g} mm"
    return Frames(
        pressure[None],
        dy,
        dx,
        (1.0, 1.0),
        traction_x=np.nan_to_num(fields["longitudinal"]),
        traction_y=np.nan_to_num(fields["lateral"]),
        x0=x0,
        y0=y0,
        pin=face,
        source=f"{path.name}: {ny} pins of {shape}, {dy * 1e3:.3g} mm apart, {nx} readings each; {how}, {words}",
        warnings=_caveats(path, fields),
    )


def _name(cell: str) -> str:
    match = _HEADING.match(cell)
    name = (match["name"] if match else cell).strip().strip('"').lower()
    return _ALSO.get(name, name)


def _declared(path: Path) -> dict[str, str]:
    """What comments above the header declare. Raises InputError for a key that stands twice."""
    lines: dict[str, str] = {}
    for line in path.read_text(encoding="utf-8-sig").splitlines():
        if line.strip() and not line.lstrip().startswith("#"):
            break
        match = _DECLARED.match(line.strip())
        key = match["key"].strip().lower() if match else ""
        if match is None or key not in _KEYS:
            continue
        if key in lines:
            raise InputError(f'{path} declares "# {key}:" twice, {lines[key]} and {match["value"]}; keep one')
        lines[key] = match["value"]
    return lines


def _face(path: Path, size: float | str | tuple[float | str, float | str] | None) -> tuple[float, float]:
    """Sides of the face of a pin along x and across, m; of a round one those of a square of its area."""
    if size is None:
        raise InputError(
            f'{path} does not declare its pins; write "# pin: 9.7 mm" above the header, or give pin="9.7 mm"'
        )
    is_round = False
    sides: tuple[float | str, ...]
    if isinstance(size, str):
        match = _ROUND.match(size)
        is_round = match is not None
        sides = tuple(_BY.split(match["size"] if match else size))
    else:
        sides = tuple(size) if isinstance(size, tuple | list) else (size,)
    if len(sides) not in (1, 2) or (is_round and len(sides) != 1):
        raise InputError(
            f'{path}: a pin is "9.7 mm", "9.7 mm round" or "12 mm x 8 mm" along travel and across, got {size!r}'
        )
    scale = 0.5 * math.sqrt(math.pi) if is_round else 1.0
    face = [scale * quantity(side, "m") for side in sides]
    for side in face:
        if not _SMALLEST <= side <= _LARGEST:
            raise InputError(
                f"{path}: the face of a pin is {side * 1e3:g} mm wide, and {_SMALLEST * 1e3:g} to {_LARGEST * 1e3:g} "
                f"mm "
                'is possible; give its unit, "# pin: 9.7 mm"'
            )
    return face[0], face[-1]


def _speed(path: Path, speed: float | str | None) -> float:
    if speed is None:
        raise InputError(
            f'{path} has time and not x, and does not declare a speed; write "# speed: 1.2 m/s" above the header, or '
            f"give "
            'speed="1.2 m/s"'
        )
    value = quantity(speed, "m/s")
    positive(f"{path}: speed", value, "m/s", "x lies along travel")
    return value


def _columns(table: Table, units: dict[str, str], face: tuple[float, float]) -> dict[str, _Column]:
    """The columns that are read. Raises InputError for unknown, missing and double ones, and without a unit."""
    path, line = table.path, table.lines[0]
    if not table.has_header:
        raise InputError(f"{path}, line {line}: a pin table starts with its columns, y [mm], x [mm], vertical [kPa], "
                         "longitudinal [kPa], lateral [kPa]")  # fmt: skip
    columns: dict[str, _Column] = {}
    for place, cell in enumerate(table.rows[0]):
        match = _HEADING.match(cell)
        name, unit = _name(cell), match["unit"] if match else None
        if name not in {*_PLACES, *_STRESSES}:
            near = meant(name, [*_PLACES, *_STRESSES])
            hint = "" if near is None else f'did you mean "{near}"? '
            raise InputError(
                f'{path}, line {line}: unknown column "{cell}"; {hint}a pin table has y, x or time, vertical, '
                f"longitudinal "
                'and lateral, with units like "vertical [kPa]"'
            )
        if name in columns:
            raise InputError(f"{path}, line {line}: the column {name} occurs twice; keep one")
        wanted = units.get(name, units.get("pressure") if name in _STRESSES else None)
        if unit is not None and wanted is not None and unit != wanted:
            raise InputError(f"{path}, line {line}: {name} is in [{unit}] and units= is {wanted!r}; leave units= out")
        if not (unit or wanted):
            example = "kPa" if name in _STRESSES else "mm" if name != "time" else "s"
            raise InputError(
                f'{path}, line {line}: {name} names no unit; write "{name} [{example}]", or give '
                f'units={{"{name}": "{example}"}}'
            )
        columns[name] = _Column(place, str(unit or wanted), _factor(path, line, name, str(unit or wanted), face))
    lacking = [name for name in _NEEDED if name not in columns]
    if lacking:
        raise InputError(
            f"{path}, line {line}: a pin table needs y, x or time, vertical, longitudinal and lateral; "
            f"{', '.join(lacking)} missing"
        )
    if ("x" in columns) == ("time" in columns):
        what = "both x and time" if "x" in columns else "neither x nor time"
        raise InputError(f"{path}, line {line}: a pin table needs one of x and time, this one has {what}; keep one")
    return columns


def _factor(path: Path, line: int, name: str, unit: str, face: tuple[float, float]) -> float:
    """SI of a number in a column; a force is spread over the face."""
    try:
        if name in _PLACES:
            return factor(unit, _PLACES[name])
        try:
            return factor(unit, "N") / (face[0] * face[1])
        except InputError:
            return pressure_factor(unit)
    except InputError as error:
        kind = "a stress such as kPa or a force such as N" if name in _STRESSES else f"{_PLACES[name]} or the like"
        raise InputError(f"{path}, line {line}: {name} is in [{unit}], which is not a unit of {kind}") from error


def _fields(
    path: Path,
    read_of: Mapping[str, Array],
    lines: tuple[int, ...],
    shape: tuple[int, int],
    at: tuple[Array, Array],
) -> dict[str, Array]:
    """Stresses on the cells (ny, nx), Pa; NaN where a pin has no reading, and where one of the three is missing."""
    order = np.full(shape, -1)
    for row, cell in enumerate(zip(*at, strict=True)):
        if order[cell] >= 0:
            raise InputError(
                f"{path}, line {lines[row]}: the pin at y = {read_of['y'][row] * 1e3:g} mm was read at this place in "
                f"line "
                f"{lines[order[cell]]} already; keep one of the readings, or their mean"
            )
        order[cell] = row
    whole = np.all([np.isfinite(read_of[name]) for name in _STRESSES], axis=0)
    if not whole.any():
        raise InputError(f"{path}: no reading has all three components; a missing one is empty or NaN")
    fields = {}
    for name in _STRESSES:
        fields[name] = np.full(shape, np.nan)
        fields[name][at] = np.where(whole, read_of[name], np.nan)
    return fields


def _caveats(path: Path, fields: Mapping[str, Array]) -> tuple[str, ...]:
    """Sentences on what is odd in the stresses."""
    largest = {name: float(np.nanmax(np.abs(values))) for name, values in fields.items()}
    shear = max(("longitudinal", "lateral"), key=largest.__getitem__)
    if largest[shear] <= _MOST_SHEAR * largest["vertical"]:
        return ()
    return (
        f"{path.name}: the largest {shear} stress is {largest[shear] / largest['vertical']:.3g} times the largest "
        f"vertical "
        f"one, and at most {_MOST_SHEAR:g} is usual of rubber on a road; look at the columns and their units",
    )
