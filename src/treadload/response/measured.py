"""Recorded contact stress from files: tables of points, matrices of pressures, saved results."""

from __future__ import annotations

import csv
import difflib
import io
import math
import os
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
import xarray as xr

from treadload import variables
from treadload.errors import InputError
from treadload.files import read_tree
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.units import quantity

# Each column of a table and its SI unit.
_COLUMNS = {"x": "m", "y": "m", "pressure": "Pa", "traction_x": "Pa", "traction_y": "Pa"}
_STRESS = ("pressure", "traction_x", "traction_y")
# Rounding of coordinates in a text file, as a part of a cell.
_EVEN = 0.02
# Cells that a table may span; more is a coordinate gone astray.
_MOST = 20_000_000

_HEADER = re.compile(r"\s*(?P<name>[^\[(]*?)\s*(?:[\[(](?P<unit>[^\])]*)[\])])?\s*$")
_Row = tuple[int, list[str]]


def read_csv(
    path: str | os.PathLike[str],
    *,
    spacing: float | str | tuple[float | str, float | str] | None = None,
    x0: float | None = None,
    y0: float | None = None,
    units: Mapping[str, str] | None = None,
    missing: Literal["error", "zero"] = "error",
    noise: float | str = 0.0,
) -> tuple[Grid, Array, Array, Array]:
    """Cells and pressure, traction_x, traction_y (ny, nx) in Pa from a text file in one of two forms.

    A table has a header with x, y, pressure and perhaps traction_x, traction_y, and a row for each point, in any
    order, on an evenly spaced grid. A column may name its unit, "pressure [kPa]"; other variables of this package
    are passed over. A matrix has pressures only, rows along y (to the right), columns along x (travel).
    Commas, semicolons (then decimal commas too), tabs or blanks separate; # starts a comment line.

    spacing: of the cells, m or a text with a unit, or (dx, dy); a matrix needs it, a table where its coordinates
    do not tell. x0, y0: of a matrix, centre of the first cell, m; None: the origin lies in the middle.
    units: column → unit where the header names none, {"pressure": "kPa"}; otherwise SI. missing: what stands where
    a cell is empty, NaN or absent: "error" or "zero". noise: pressures this far below zero, Pa or a text with a
    unit, are set to zero. Raises InputError that names the line for what cannot be read.
    """
    path = Path(path)
    rows = _rows(path)
    units = dict(units or {})
    if missing not in ("error", "zero"):
        raise InputError(f'missing must be "error" or "zero", got {missing!r}')
    floor = quantity(noise, "Pa")
    unknown = set(units) - set(_COLUMNS)
    if unknown:
        raise InputError(f"units names {sorted(unknown)[0]!r}; the columns are {', '.join(_COLUMNS)}")
    if all(_is_number(cell) for cell in rows[0][1]):
        return _matrix(path, rows, spacing, x0, y0, units, missing, floor)
    if x0 is not None or y0 is not None:
        raise InputError(f"{path} is a table with coordinates of its own: leave out x0 and y0, and move the load")
    return _table(path, rows, spacing, units, missing, floor)


def read_netcdf(path: str | os.PathLike[str]) -> xr.Dataset:
    """Dataset of the contact in a saved result, or of the root of another NetCDF file; InputError if unreadable."""
    path = Path(path)
    if not path.is_file():
        raise InputError(f"there is no file {path}")
    loaded = read_tree(path, "NetCDF-4")
    if "contact" in loaded.children:
        return loaded["contact"].to_dataset()
    if "pressure" in loaded.to_dataset():
        return loaded.to_dataset()
    groups = ", ".join(loaded.children) or "none"
    raise InputError(f"{path} holds no contact and no pressure; its groups: {groups}")


def grid_of(
    shape: Sequence[int],
    spacing: float | str | tuple[float | str, float | str],
    x0: float | None,
    y0: float | None,
) -> Grid:
    """Grid of (ny, nx) cells; spacing: m or a text, or (dx, dy). x0, y0: m, None centres the grid on the origin."""
    (ny, nx), (dx, dy) = shape, _spacing(spacing)
    return Grid(
        nx, ny, dx, dy, -0.5 * (nx - 1) * dx if x0 is None else x0, -0.5 * (ny - 1) * dy if y0 is None else y0
    )


def shear_sign(shear_on: str) -> float:
    """1 for shear recorded on the road, -1 for the opposite shear on the tire."""
    if shear_on not in ("road", "tire"):
        raise InputError(f'shear_on must be "road" or "tire", the body that the shear acts on, got {shear_on!r}')
    return 1.0 if shear_on == "road" else -1.0


def _spacing(spacing: Any) -> tuple[float, float]:
    both = tuple(spacing) if isinstance(spacing, (tuple, list)) else (spacing, spacing)
    if len(both) != 2:
        raise InputError(f"spacing must be one length or (dx, dy), got {len(both)} values")
    return quantity(both[0], "m"), quantity(both[1], "m")


def _rows(path: Path) -> list[_Row]:
    """Cells of every line that holds some, with the line's number."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from error
    except UnicodeDecodeError as error:
        raise InputError(f"cannot read {path}: it is no UTF-8 text (byte {error.start}); save it as UTF-8") from error
    lines = [(number, line) for number, line in enumerate(text.splitlines(), start=1) if line.strip()]
    lines = [(number, line) for number, line in lines if not line.lstrip().startswith("#")]
    if not lines:
        raise InputError(f"{path} holds no numbers: it is empty or all comments")
    separator = next((mark for mark in (";", "\t", ",") if mark in lines[0][1]), None)
    if separator is None:
        # A blank stands before a unit, too.
        return [(number, re.findall(r"[^\s\[(]+(?:\s*[\[(][^\])]*[\])])?", line)) for number, line in lines]
    rows = []
    for number, line in lines:
        cells = [cell.strip() for cell in next(csv.reader(io.StringIO(line), delimiter=separator))]
        rows.append((number, [cell.replace(",", ".") for cell in cells] if separator == ";" else cells))
    return rows


def _is_number(cell: str) -> bool:
    try:
        float(cell or "nan")
    except ValueError:
        return False
    return True


def _value(path: Path, line: int, name: str, cell: str) -> float:
    """The number in a cell; NaN where it is empty."""
    try:
        value = float(cell or "nan")
    except ValueError as error:
        raise InputError(f"{path}, line {line}: {name} is {cell!r}, not a number") from error
    if math.isinf(value):
        raise InputError(f"{path}, line {line}: {name} is infinite")
    return value


def _checked(path: Path, line: int, name: str, value: float, missing: str, floor: float) -> float:
    """A stress in Pa: what is missing and what is noise as asked for."""
    if math.isnan(value):
        if missing == "zero":
            return 0.0
        raise InputError(f'{path}, line {line}: {name} is missing; give missing="zero" if nothing pressed there')
    if name == "pressure" and -floor <= value < 0:
        return 0.0
    if name == "pressure" and value < 0:
        raise InputError(
            f"{path}, line {line}: pressure is negative, {value:g} Pa; compression counts positive, and noise= says "
            "how far below zero a sensor may read"
        )
    return value


def _factor(name: str, unit: str | None) -> float:
    return 1.0 if unit is None else quantity(f"1 {unit}", _COLUMNS[name])


def _matrix(
    path: Path,
    rows: list[_Row],
    spacing: Any,
    x0: float | None,
    y0: float | None,
    units: Mapping[str, str],
    missing: str,
    floor: float,
) -> tuple[Grid, Array, Array, Array]:
    if spacing is None:
        raise InputError(
            f'{path} starts with numbers, so it is a matrix of pressures and needs spacing="5 mm" or (dx, dy); '
            "a table of points starts with a header x, y, pressure"
        )
    factor, width = _factor("pressure", units.get("pressure")), len(rows[0][1])
    pressure = np.empty((len(rows), width))
    for row, (line, cells) in enumerate(rows):
        if len(cells) != width:
            raise InputError(f"{path}, line {line}: {len(cells)} values where the first row has {width}")
        for column, cell in enumerate(cells):
            value = factor * _value(path, line, "pressure", cell)
            pressure[row, column] = _checked(path, line, "pressure", value, missing, floor)
    none = np.zeros_like(pressure)
    return grid_of(pressure.shape, spacing, x0, y0), pressure, none, none


def _table(
    path: Path, rows: list[_Row], spacing: Any, units: Mapping[str, str], missing: str, floor: float
) -> tuple[Grid, Array, Array, Array]:
    columns, factors = _columns(path, rows[0], units)
    body = rows[1:]
    if not body:
        raise InputError(f"{path} has a header and no points")
    width, at = len(rows[0][1]), {name: np.empty(len(body)) for name in columns}
    for row, (line, cells) in enumerate(body):
        if len(cells) != width:
            raise InputError(f"{path}, line {line}: {len(cells)} values where the header has {width}")
        for name, column in columns.items():
            value = factors[name] * _value(path, line, name, cells[column])
            if name in ("x", "y"):
                if math.isnan(value):
                    raise InputError(f"{path}, line {line}: {name} is missing")
            else:
                value = _checked(path, line, name, value, missing, floor)
            at[name][row] = value
    lines = [line for line, _ in body]
    steps = (None, None) if spacing is None else _spacing(spacing)
    x0, nx, dx, i = _places(path, "x", at["x"], lines, steps[0])
    y0, ny, dy, j = _places(path, "y", at["y"], lines, steps[1])
    if nx * ny > _MOST:
        raise InputError(f"{path} spans {nx} x {ny} cells of {dx:g} x {dy:g} m; check its x and y for strays")
    owner = np.full((ny, nx), -1)
    for row, cell in enumerate(zip(j, i, strict=True)):
        if owner[cell] >= 0:
            raise InputError(
                f"{path}, line {lines[row]}: the point x = {at['x'][row]:g} m, y = {at['y'][row]:g} m stood in line "
                f"{lines[owner[cell]]} already"
            )
        owner[cell] = row
    if missing == "error" and (owner < 0).any():
        row, column = (int(k) for k in np.argwhere(owner < 0)[0])
        raise InputError(
            f"{path} has no row for x = {x0 + column * dx:g} m, y = {y0 + row * dy:g} m ({int((owner < 0).sum())} of "
            f'{nx * ny} points are missing); give missing="zero" if nothing pressed there'
        )
    fields = {name: np.zeros((ny, nx)) for name in _STRESS}
    for name in set(columns) & set(_STRESS):
        fields[name][j, i] = at[name]
    return Grid(nx, ny, dx, dy, x0, y0), fields["pressure"], fields["traction_x"], fields["traction_y"]


def _columns(path: Path, header: _Row, units: Mapping[str, str]) -> tuple[dict[str, int], dict[str, float]]:
    """Place in the row and factor to SI of each column that is read."""
    columns: dict[str, int] = {}
    factors: dict[str, float] = {}
    line, cells = header
    for place, cell in enumerate(cells):
        match = _HEADER.match(cell)
        name, unit = (match["name"], match["unit"]) if match else (cell, None)
        if name not in _COLUMNS:
            if name in variables.VARIABLES:
                continue
            close = difflib.get_close_matches(name, _COLUMNS, n=1)
            hint = f'did you mean "{close[0]}"? ' if close else ""
            raise InputError(
                f'{path}, line {line}: unknown column "{cell}"; {hint}a table has {", ".join(_COLUMNS)}, '
                'with units like "pressure [kPa]"'
            )
        if name in columns:
            raise InputError(f"{path}, line {line}: the column {name} stands there twice")
        if unit is not None and name in units:
            raise InputError(f"{path}, line {line}: {name} has a unit in the header, [{unit}]; leave it out of units")
        columns[name] = place
        factors[name] = _factor(name, units.get(name) if unit is None else unit)
    lacking = [name for name in ("x", "y", "pressure") if name not in columns]
    if lacking:
        raise InputError(f"{path}, line {line}: a table needs x, y and pressure; {', '.join(lacking)} missing")
    return columns, factors


def _places(
    path: Path, name: str, values: Array, lines: list[int], step: float | None
) -> tuple[float, int, float, Array]:
    """First coordinate, number of cells, spacing and index of each value; step: the spacing if given."""
    ordered = np.sort(values)
    first, gaps = float(ordered[0]), np.diff(ordered)
    if step is None:
        # What differs by less than this is one coordinate with round-off.
        gaps = gaps[gaps > 1e-6 * gaps.max(initial=0.0)]
        if not len(gaps):
            raise InputError(f"{path}: all points have the same {name}; give spacing= for the size of the cells")
        # A mean over neighbours: rounding of a single step would add up over the cells.
        step = float(gaps[gaps < 1.5 * gaps.min()].mean())
    index = (values - first) / step
    off = np.abs(index - np.round(index))
    worst = int(off.argmax())
    if off[worst] > _EVEN:
        raise InputError(
            f"{path}, line {lines[worst]}: {name} = {values[worst]:g} m is no whole number of steps of {step:g} m "
            f"from {first:g} m; resample onto an even grid"
        )
    return first, round(float(index.max())) + 1, step, np.round(index).astype(int)
