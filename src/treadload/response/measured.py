"""Recorded contact stress from files: tables of points, matrices of pressures, saved results."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, TypedDict, Unpack

import numpy as np

from treadload import variables
from treadload.deferred import xarray as xr
from treadload.errors import InputError, meant
from treadload.files import read_tree
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.labels import check_names, factor, factor_of, factor_of_argument
from treadload.tables import Table, read_table
from treadload.units import quantity

# What is read and its SI unit.
_COLUMNS = {"x": "m", "y": "m", "pressure": "Pa", "traction_x": "Pa", "traction_y": "Pa"}
_STRESS = ("pressure", "traction_x", "traction_y")
# What columns are also called.
_ALSO = {"p": "pressure", "qx": "traction_x", "qy": "traction_y"}
# Rounding of coordinates in a text file, as a part of a cell; round-off of those that went through a binary one.
_EVEN, _EXACT = 0.02, 1e-4
# Cells that a table may span; more is a coordinate gone astray.
_MOST = 20_000_000

_HEADER = re.compile(r"\s*(?P<name>[^\[(]*?)\s*(?:[\[(](?P<unit>[^\])]*)[\])])?\s*$")


@dataclass(frozen=True)
class Recorded:
    """Stress as it was recorded: cells, and pressure, traction_x, traction_y (ny, nx), Pa.

    source: where it was read and how it was understood, in words; "" for arrays.
    """

    grid: Grid
    pressure: Array
    traction_x: Array | None
    traction_y: Array | None
    source: str = ""


class Layout(TypedDict, total=False):
    """The fields of `TextLayout`, as keywords."""

    spacing: float | str | tuple[float | str, float | str] | None
    x0: float | None
    y0: float | None
    units: Mapping[str, str] | None
    missing: Literal["error", "zero", "keep"]
    noise: float | str
    decimal: str | None


@dataclass(frozen=True)
class TextLayout:
    """How a text of numbers is read where it does not state this itself, see `read_csv`."""

    spacing: float | str | tuple[float | str, float | str] | None = None
    x0: float | None = None
    y0: float | None = None
    units: Mapping[str, str] | None = None
    missing: Literal["error", "zero", "keep"] = "error"
    noise: float | str = 0.0
    decimal: str | None = None


def read_csv(path: str | os.PathLike[str], *, strict: bool = False, **layout: Unpack[Layout]) -> Recorded:
    """Cells and stress from a text file in one of two forms.

    A table has a header with x, y, pressure (or p) and perhaps traction_x, traction_y (or qx, qy), and a row for each
    point, in any order, on an evenly spaced grid. A column may name its unit, "pressure [kPa]"; other variables of
    this package are passed over. A matrix has pressures only, rows along y (to the right), columns along x (travel).
    Semicolons, tabs, commas or blanks separate, and points or commas are decimal marks, as `tables.read_table`
    recognises them; # starts a comment line.

    layout: spacing=, x0=, y0=, units=, missing=, noise= and decimal=. spacing: of the cells, m or text with a unit,
    or (dx, dy); a matrix needs it, a table where its coordinates do not give it. x0, y0: of a matrix, centre of the
    first cell, m; None: the origin lies in the middle. units: column → unit where the header names none, {"pressure":
    "kPa"}; otherwise SI. missing: what is read where a cell is empty, is NaN or NoData, or is absent: "error",
    "zero", or "keep" for NaN. noise: pressures this far below zero, Pa or text with a unit, are set to zero. decimal:
    "." or ",", where the file can be read in two ways. strict: refuse what names no unit, which is SI otherwise.
    Raises InputError that names the line for what cannot be read.
    """
    path, how = Path(path), TextLayout(**layout)
    if how.missing not in ("error", "zero", "keep"):
        raise InputError(f'missing must be "error" or "zero", or "keep" for NaN, got {how.missing!r}')
    floor = quantity(how.noise, "Pa")
    units = dict(how.units or {})
    check_names(units, _COLUMNS, "the columns")
    table = read_table(path, decimal=how.decimal)
    if not table.has_header:
        return _matrix(table, how.spacing, how.x0, how.y0, units, how.missing, floor, strict)
    if how.x0 is not None or how.y0 is not None:
        raise InputError(f"{path} is a table with coordinates of its own: leave out x0 and y0, and move the load")
    return _table(table, how.spacing, units, how.missing, floor, strict)


def read_netcdf(path: str | os.PathLike[str], units: Mapping[str, str] | None = None) -> Recorded:
    """Stress of the contact in a saved result, or of the root of another NetCDF file.

    Every variable must name its unit (attribute units); units: {"pressure": "kPa"} where it does not.
    Raises InputError for what cannot be read.
    """
    path = Path(path)
    if not os.path.isfile(path):
        raise InputError(f"there is no file {path}")
    loaded = read_tree(path, "NetCDF-4")
    if "contact" in loaded.children:
        data = loaded["contact"].to_dataset()
    elif "pressure" in loaded.to_dataset():
        data = loaded.to_dataset()
    else:
        groups = ", ".join(loaded.children) or "none"
        raise InputError(f"{path} holds no contact and no pressure; its groups: {groups}")
    return of_dataset(data, where=str(path), units=units, strict=True)


def of_dataset(
    data: xr.Dataset, *, where: str = "", units: Mapping[str, str] | None = None, strict: bool = False
) -> Recorded:
    """Stress of a dataset: `pressure`, and `traction_x` and `traction_y` if they are there, over `y` and `x`.

    where: the file it comes from, for errors. units: of variables that name none; strict: refuse those that neither
    names, which are SI otherwise. Attributes dx and dy give the cell, m, where a single coordinate cannot.
    Raises InputError if pressure or a coordinate is missing, not a number, or not evenly spaced.
    """
    units = dict(units or {})
    missing = [name for name in ("pressure", "x", "y") if name not in data.variables]
    if missing:
        begin = f"{where}: a" if where else "a"
        raise InputError(f"{begin} load needs pressure over y and x; {', '.join(missing)} missing in the dataset")
    check_names(units, _COLUMNS, "the variables")
    about = where or "the dataset"
    parts: dict[str, Array] = {}
    by_unit: dict[str, list[str]] = {}
    factors: dict[str, float] = {}
    for name, si in _COLUMNS.items():
        if name not in data.variables:
            continue
        part = data[name]
        wanted = (name,) if name in ("x", "y") else ("y", "x")
        if set(part.dims) != set(wanted) or len(part.dims) != len(wanted):
            raise InputError(f"{name} must have dimensions ({', '.join(wanted)}), got {part.dims}")
        if part.dtype.kind not in "iuf":
            # What names a unit of time is read as time.
            raise InputError(f"{about}: {name} must hold numbers in {si} or the like, got {part.dtype}")
        named = part.attrs.get("units")
        factors[name] = factor_of(name, named, si, units, where=about, bare=None if strict else si)
        by_unit.setdefault(str(units.get(name) if named is None else named), []).append(name)
        with np.errstate(over="ignore"):
            parts[name] = factors[name] * np.asarray(part.transpose(*wanted).to_numpy(), dtype=float)
    cell = {name: data.attrs.get(f"d{name}") for name in ("x", "y") if factors[name] == 1.0}
    x0, nx, dx = _evenly("x", parts["x"], cell.get("x"))
    y0, ny, dy = _evenly("y", parts["y"], cell.get("y"))
    source = f"{Path(where).name}: " + ", ".join(
        f"{' and '.join(names)} in {unit}" for unit, names in by_unit.items()
    )
    grid = Grid(nx, ny, dx, dy, x0, y0)
    stress = [parts.get(name) for name in _STRESS]
    assert stress[0] is not None
    return Recorded(grid, stress[0], stress[1], stress[2], source if where else "")


def grid_of(
    shape: Sequence[int],
    spacing: float | str | tuple[float | str, float | str],
    x0: float | None,
    y0: float | None,
) -> Grid:
    """Grid of (ny, nx) cells; spacing: m or text, or (dx, dy). x0, y0: m, None centres the grid on the origin."""
    (ny, nx), (dx, dy) = shape, _spacing(spacing)
    return Grid(
        nx, ny, dx, dy, -0.5 * (nx - 1) * dx if x0 is None else x0, -0.5 * (ny - 1) * dy if y0 is None else y0
    )


def shear_sign(shear_on: str) -> float:
    """1 for shear recorded on the road, -1 for the opposite shear on the tire."""
    if shear_on not in ("road", "tire"):
        raise InputError(f'shear_on must be "road" or "tire", the body that the shear acts on, got {shear_on!r}')
    return 1.0 if shear_on == "road" else -1.0


def _spacing(spacing: object) -> tuple[float, float]:
    both = tuple(spacing) if isinstance(spacing, (tuple, list)) else (spacing, spacing)
    if len(both) != 2:
        raise InputError(f"spacing must be one length or (dx, dy), got {len(both)} values")
    return quantity(both[0], "m"), quantity(both[1], "m")


def _checked(table: Table, first: int, name: str, values: Array, missing: str, floor: float) -> Array:
    """Stress (rows, …), Pa: what is missing and what is noise as asked for."""
    values = values.copy()
    unknown = np.isnan(values)
    if unknown.any() and missing == "error":
        line = table.lines[first + int(np.argwhere(unknown)[0][0])]
        raise InputError(
            f'{table.path}, line {line}: {name} is missing; give missing="zero" if nothing pressed there'
        )
    values[unknown] = np.nan if missing == "keep" else 0.0
    if name == "pressure":
        values[(values < 0) & (values >= -floor)] = 0.0
        below = np.argwhere(values < 0)
        if len(below):
            raise InputError(
                f"{table.path}, line {table.lines[first + int(below[0][0])]}: pressure is negative, "
                f"{values[tuple(below[0])]:g} Pa; compression counts positive, and noise= gives how far below zero a "
                "sensor may read"
            )
    return values


def _matrix(
    table: Table,
    spacing: float | str | tuple[float | str, float | str] | None,
    x0: float | None,
    y0: float | None,
    units: Mapping[str, str],
    missing: str,
    floor: float,
    strict: bool,
) -> Recorded:
    if spacing is None:
        raise InputError(
            f'{table.path} starts with numbers, so it is a matrix of pressures and needs spacing="5 mm" or (dx, dy); '
            "a table of points starts with a header x, y, pressure"
        )
    values, how = table.values(name=lambda column: "pressure")
    unit = units.get("pressure")
    if unit is None and strict:
        raise InputError(_no_unit(table.path, "pressure"))
    scaled: Array = values * (1.0 if unit is None else factor_of_argument("pressure", unit, "Pa"))
    pressure = _checked(table, 0, "pressure", scaled, missing, floor)
    grid = grid_of(pressure.shape, spacing, x0, y0)
    return Recorded(grid, pressure, None, None, f"{table.path.name}: {how}, pressure in {unit or 'Pa'}")


def _table(
    table: Table, spacing: object, units: Mapping[str, str], missing: str, floor: float, strict: bool
) -> Recorded:
    path, lines = table.path, table.lines[1:]
    columns, named = _columns(table, units)
    bare = [name for name, unit in named.items() if unit is None]
    if bare and strict:
        raise InputError(_no_unit(path, bare[0]))
    if not lines:
        raise InputError(f"{path} has a header and no points")
    heads = {place: name for name, place in columns.items()}
    values, how = table.values(list(columns.values()), first=1, name=heads.__getitem__)
    at: dict[str, Array] = {}
    for (name, unit), column in zip(named.items(), values.T, strict=True):
        with np.errstate(over="ignore"):
            scaled: Array = column * (1.0 if unit is None else factor(unit, _COLUMNS[name]))
        if name in ("x", "y"):
            if np.isnan(scaled).any():
                raise InputError(f"{path}, line {lines[int(np.isnan(scaled).argmax())]}: {name} is missing")
            at[name] = scaled
        else:
            at[name] = _checked(table, 1, name, scaled, missing, floor)
    steps = (None, None) if spacing is None else _spacing(spacing)
    x0, nx, dx, i = places(path, "x", at["x"], lines, steps[0])
    y0, ny, dy, j = places(path, "y", at["y"], lines, steps[1])
    if nx * ny > _MOST:
        raise InputError(f"{path} spans {nx} x {ny} cells of {dx:g} x {dy:g} m; check its x and y for strays")
    owner = np.full((ny, nx), -1)
    for row, cell in enumerate(zip(j, i, strict=True)):
        if owner[cell] >= 0:
            raise InputError(
                f"{path}, line {lines[row]}: the point x = {at['x'][row]:g} m, y = {at['y'][row]:g} m is "
                f"already in line {lines[owner[cell]]}"
            )
        owner[cell] = row
    if missing == "error" and (owner < 0).any():
        row, column = (int(k) for k in np.argwhere(owner < 0)[0])
        raise InputError(
            f"{path} has no row for x = {x0 + column * dx:g} m, y = {y0 + row * dy:g} m ({int((owner < 0).sum())} of "
            f'{nx * ny} points are missing); give missing="zero" if nothing pressed there'
        )
    fields: dict[str, Array] = {}
    for name in set(columns) & set(_STRESS):
        fields[name] = np.full((ny, nx), np.nan if missing == "keep" else 0.0)
        fields[name][j, i] = at[name]
    grid = Grid(nx, ny, dx, dy, x0, y0)
    units_text = ", ".join(f"{name} in {unit or _COLUMNS[name]}" for name, unit in named.items())
    source = f"{path.name}: {how}, {units_text}"
    return Recorded(grid, fields["pressure"], fields.get("traction_x"), fields.get("traction_y"), source)


def _no_unit(path: Path, name: str) -> str:
    unit = "mm" if _COLUMNS[name] == "m" else "kPa"
    return f'{path}: {name} names no unit; give units={{"{name}": "{unit}"}}, or write {name} [{unit}] in a header'


def _columns(table: Table, units: Mapping[str, str]) -> tuple[dict[str, int], dict[str, str | None]]:
    """Place in the row and unit, None for SI, of each column that is read."""
    columns: dict[str, int] = {}
    named: dict[str, str | None] = {}
    path, line = table.path, table.lines[0]
    for place, cell in enumerate(table.rows[0]):
        match = _HEADER.match(cell)
        name, unit = (match["name"], match["unit"]) if match else (cell, None)
        name = _ALSO.get(name, name)
        if name not in _COLUMNS:
            if name in variables.VARIABLES:
                continue
            near = meant(name, _COLUMNS)
            hint = "" if near is None else f'did you mean "{near}"? '
            raise InputError(
                f'{path}, line {line}: unknown column "{cell}"; {hint}a table has {", ".join(_COLUMNS)}, '
                'with units like "pressure [kPa]"'
            )
        if name in columns:
            raise InputError(f"{path}, line {line}: the column {name} occurs twice")
        if unit is not None and name in units:
            raise InputError(f"{path}, line {line}: {name} has a unit in the header, [{unit}]; leave it out of units")
        if unit is None and name in units:
            factor_of_argument(name, units[name], _COLUMNS[name])
        elif unit is not None:
            factor(unit, _COLUMNS[name])
        columns[name] = place
        named[name] = units.get(name) if unit is None else unit
    lacking = [name for name in ("x", "y", "pressure") if name not in columns]
    if lacking:
        raise InputError(f"{path}, line {line}: a table needs x, y and pressure; {', '.join(lacking)} missing")
    return columns, named


def places(
    path: Path, name: str, values: Array, lines: Sequence[int], step: float | None
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
    if not off[worst] <= _EVEN:
        raise InputError(
            f"{path}, line {lines[worst]}: {name} = {values[worst]:g} m is not a whole number of steps of {step:g} m "
            f"from {first:g} m; resample onto an even grid"
        )
    if index.max() > _MOST:
        raise InputError(f"{path} spans {index.max():.3g} cells of {step:g} m along {name}; check it for strays")
    return first, round(float(index.max())) + 1, step, np.round(index).astype(int)


def _evenly(name: str, values: Array, single: object) -> tuple[float, int, float]:
    """First value, number and spacing of evenly spaced, rising coordinates; `single`: spacing if there is but one."""
    if values.size == 1 and isinstance(single, int | float | np.number):
        return float(values.item()), 1, float(single)
    if len(values) < 2:
        raise InputError(
            f"the spacing along {name} cannot be read from {values.size} coordinate(s); give a GridLoad with its Grid"
        )
    with np.errstate(over="ignore", invalid="ignore"):
        spacing = float(values[-1] - values[0]) / (len(values) - 1)
        uneven = float(np.abs(np.diff(values) - spacing).max())
    if not (spacing > 0 and uneven <= _EXACT * spacing):
        raise InputError(
            f"{name} must increase in even steps: the mean step is {spacing:g} m, the worst differs by {uneven:g} m; "
            "sort or resample the load"
        )
    return float(values[0]), len(values), spacing
