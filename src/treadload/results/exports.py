"""Results as tables for other programs: CSV, Excel and Parquet, one row per point, units in the headings.

NetCDF (`results.files`) keeps everything and is read back; tables are for spreadsheets and scripts.
"""

from __future__ import annotations

import csv
import io
import itertools
import math
import os
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from treadload.composing import BaseResult
from treadload.deferred import xarray as xr
from treadload.errors import InputError, WriteError, how_to_install
from treadload.files import EXCEL, NETCDF, PARQUET, TABLE, check_suffix, write_all, write_whole
from treadload.results.files import save_results
from treadload.results.tree import QUESTIONS, as_tree

FORMATS = NETCDF | TABLE | EXCEL | PARQUET
"""Suffixes that results can be written with, and what they mean."""
TABLES = TABLE | EXCEL | PARQUET
"""Those of tables."""

# Of a sheet of Excel: rows, characters of a cell, characters of a name.
_MOST_ROWS, _CELL, _NAME = 1_048_576, 32_000, 31
# Letters of a piece of text.
_PIECE = 2**20
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f]")


@dataclass(frozen=True, eq=False)
class Table:
    """A table. name: of the sheet, "" for the one that takes the name of the file. columns: heading → values (n,)."""

    name: str
    columns: dict[str, Any]


def check_output(path: str | os.PathLike[str]) -> None:
    """Raise InputError now if results could not be written to `path` later: suffix, package, folder."""
    suffix = check_suffix(path, FORMATS, "results")
    if suffix in EXCEL:
        _openpyxl(path)
    if suffix in PARQUET:
        _pyarrow(path)


def write(results: xr.DataTree | xr.Dataset, path: str | os.PathLike[str]) -> tuple[Path, ...]:
    """Write results in the format that the suffix names; returns the files written. Raises InputError."""
    suffix = check_suffix(path, FORMATS, "results")
    if suffix in TABLE:
        return write_csv(results, path)
    if suffix in PARQUET:
        return write_parquet(results, path)
    return (write_excel(results, path) if suffix in EXCEL else save_results(results, path),)


def write_csv(results: Any, path: str | os.PathLike[str]) -> tuple[Path, ...]:
    """Write results as CSV, one table per file, UTF-8, with commas between values and decimal points.

    results: a contact, response, verdict, life, the result of a case, a dataset or a tree. path: of the file. Fields
    over the same coordinates make a table with one row per point, coordinates first, units in the headings. The main
    table of a single group takes the path; others stand beside it with their names behind an underscore, so that
    "r.csv" of a case makes r_contact.csv, r_contact_scalars.csv, r_response.csv, ..., r_about.csv.
    Returns the files written, the main one first: all of them, or none. Raises InputError.

    >>> road = tl.Pavement.half_space(tl.Elastic(100e6, 0.35))
    >>> response = tl.solve_response(tl.UniformDisc(0.15, 700e3), road, depths=[0.15], x=[0.0, 0.1], y=[0.0])
    >>> path = tl.results.write_csv(response, folder / "plate.csv")[0]
    >>> f"{path.name}: a heading and {len(path.read_text(encoding='utf-8').splitlines()) - 1} points"
    'plate.csv: a heading and 2 points'
    """
    check_suffix(path, TABLE, "tables")
    return write_all(csv_files(results, Path(path)))


def csv_files(results: Any, path: Path) -> list[tuple[Path, Iterator[str]]]:
    """Path and text, piece by piece, of each file that `write_csv` writes."""
    return [(file, _csv(table)) for file, table in _files(_tables(results), path)]


def write_parquet(results: Any, path: str | os.PathLike[str]) -> tuple[Path, ...]:
    """Write results as Parquet, the tables and names of `write_csv`, columns with their types.

    Returns the files written, the main one first: all of them, or none. Raises InputError, also where pyarrow is not
    installed.

    >>> road = tl.Pavement.half_space(tl.Elastic(100e6, 0.35))
    >>> response = tl.solve_response(tl.UniformDisc(0.15, 700e3), road, depths=[0.15], x=[0.0, 0.1], y=[0.0])
    >>> tl.results.write_parquet(response, "plate.parquet")[0].name
    'plate.parquet'
    """
    check_suffix(path, PARQUET, "tables")
    arrow, parquet = _pyarrow(path)

    def encoded(table: Table) -> bytes:
        plain = {name: _arrow_column(values) for name, values in table.columns.items()}
        stream = io.BytesIO()
        parquet.write_table(arrow.table(plain), stream)
        return stream.getvalue()

    return write_all((file, encoded(table)) for file, table in _files(_tables(results), Path(path)))


def _files(tables: list[Table], path: Path) -> Iterator[tuple[Path, Table]]:
    """The file of each table: the path itself for the one without a name, others beside it."""
    for table in tables:
        yield path.with_name(f"{path.stem}_{table.name}{path.suffix}") if table.name else path, table


def _csv(table: Table) -> Iterator[str]:
    """A table as text, piece by piece: large ones are not in memory at once."""
    stream = io.StringIO()
    writer = csv.writer(stream)
    for row in itertools.chain([tuple(table.columns)], _rows(table)):
        writer.writerow(row)
        if stream.tell() > _PIECE:
            yield stream.getvalue()
            stream.seek(0)
            stream.truncate()
    yield stream.getvalue()


def _arrow_column(values: Any) -> Any:
    """Numbers as they are, anything else as texts."""
    column = np.asarray(values)
    return column if column.dtype.kind in "fiub" else [str(value) for value in column.tolist()]


def write_excel(results: Any, path: str | os.PathLike[str]) -> Path:
    """Write results as an Excel workbook, one sheet per table, see `write_csv`.

    Returns the path; the file appears whole or not at all. Raises InputError, also where openpyxl is not installed
    and for a table of more rows than a sheet holds.

    >>> road = tl.Pavement.half_space(tl.Elastic(100e6, 0.35))
    >>> response = tl.solve_response(tl.UniformDisc(0.15, 700e3), road, depths=[0.15], x=[0.0, 0.1], y=[0.0])
    >>> tl.results.write_excel(response, "plate.xlsx").name
    'plate.xlsx'
    """
    path = Path(path)
    check_suffix(path, EXCEL, "a workbook")
    openpyxl = _openpyxl(path)
    tables = _tables(results)
    for table in tables:
        rows = len(next(iter(table.columns.values())))
        if rows >= _MOST_ROWS:
            raise InputError(
                f"cannot write {path}: the table {table.name or path.stem!r} has {rows} rows and a heading, but a "
                f"sheet holds {_MOST_ROWS}; write .csv or .nc, or ask for fewer depths"
            )
    content = io.BytesIO()
    try:
        _book(openpyxl, tables, path.stem).save(content)
    except OSError as error:
        # Sheets of any length wait in temporary files.
        raise WriteError(
            f"cannot write {path}: {error.strerror or error} in the folder of temporary files; make room there, or "
            "name another by TMPDIR"
        ) from error
    return write_whole(path, content.getvalue())


def _book(openpyxl: Any, tables: Sequence[Table], stem: str) -> Any:
    """A workbook with a sheet for each table. stem: name of the one without a name."""
    book = openpyxl.Workbook(write_only=True)
    taken: set[str] = set()
    for table in tables:
        sheet = book.create_sheet(_sheet_name(table.name or stem, taken))
        sheet.freeze_panes = "A2"
        text = openpyxl.cell.WriteOnlyCell
        sheet.append([_text(text, sheet, heading) for heading in table.columns])
        for row in _excel_rows(table):
            sheet.append([_text(text, sheet, value) if isinstance(value, str) else value for value in row])
    return book


def _tables(results: Any) -> list[Table]:
    if isinstance(results, BaseResult):
        results = results.dataset
    elif not isinstance(results, xr.Dataset):
        results = as_tree(results)
    if isinstance(results, xr.Dataset):
        tables = list(_of_group("", results))
    else:
        groups = {str(name): node.to_dataset() for name, node in results.children.items() if name != QUESTIONS}
        groups = {name: data for name, data in groups.items() if data.data_vars}
        single = len(groups) == 1
        if results.data_vars:
            # What stands at the root takes the name of the file.
            groups, single = {"": results.to_dataset(), **groups}, False
        tables = [table for name, data in groups.items() for table in _of_group("" if single else name, data)]
        tables += [_about(results)] if tables else []
    if not tables:
        raise InputError("there is nothing to write: these results hold no fields")
    return tables


def _of_group(group: str, data: xr.Dataset) -> Iterator[Table]:
    """The tables of a group: fields by their dimensions, the most first, numbers without any last."""
    by_dims: dict[tuple[str, ...], list[str]] = {}
    for name, field in data.data_vars.items():
        by_dims.setdefault(tuple(str(d) for d in field.dims if d != "component"), []).append(str(name))
    scalars = by_dims.pop((), [])
    main = max(by_dims, key=lambda dims: len(by_dims[dims]), default=None)
    for dims in sorted(by_dims, key=lambda dims: dims != main):
        name = "_".join([group] * bool(group) + ([] if dims == main else list(dims)))
        yield Table(name, _columns(data, dims, by_dims[dims]))
    if scalars:
        rows = [data[name] for name in scalars]
        columns = {
            "quantity": scalars,
            "value": [row.item() for row in rows],
            "unit": [_unit(row) for row in rows],
            "meaning": [str(row.attrs.get("long_name", "")) for row in rows],
        }
        yield Table("_".join([*([group] if group else []), *(["scalars"] if group or by_dims else [])]), columns)


def _columns(data: xr.Dataset, dims: Sequence[str], names: Sequence[str]) -> dict[str, Any]:
    """Coordinates and fields over these dimensions, flat, the last dimension running fastest."""
    shape = tuple(data.sizes[dim] for dim in dims)
    columns: dict[str, Any] = {}
    for number, dim in enumerate(dims):
        if dim in data.coords:
            columns[_heading(dim, data[dim])] = _flat(data[dim], dims, shape)
        else:
            along = np.arange(shape[number]).reshape([-1 if k == number else 1 for k in range(len(dims))])
            columns[dim] = np.broadcast_to(along, shape).ravel()
    # Along a list of points x and y are coordinates, too.
    for name in sorted(str(name) for name in data.coords if name not in dims):
        if data[name].dims and set(data[name].dims) <= set(dims):
            columns[_heading(name, data[name])] = _flat(data[name], dims, shape)
    for name in names:
        field = data[name]
        if "component" in field.dims:
            for part in (
                data["component"].to_numpy() if "component" in data.coords else range(field.sizes["component"])
            ):
                axis_field = field.sel(component=part) if "component" in data.coords else field.isel(component=part)
                columns[_heading(f"{name}_{part}", field)] = _flat(axis_field, dims, shape)
        else:
            columns[_heading(name, field)] = _flat(field, dims, shape)
    return columns


def _flat(field: xr.DataArray, dims: Sequence[str], shape: tuple[int, ...]) -> Any:
    """Values of a field, repeated along the dimensions that it lacks."""
    present = [dim for dim in dims if dim in field.dims]
    values = field.transpose(*present).to_numpy()
    wide = values.reshape([size if dim in present else 1 for dim, size in zip(dims, shape, strict=True)])
    return np.broadcast_to(wide, shape).ravel()


def _heading(name: str, field: xr.DataArray) -> str:
    unit = _unit(field)
    return f"{name} [{unit}]" if unit else name


def _unit(field: xr.DataArray) -> str:
    return str(field.attrs.get("units", ""))


def _about(tree: xr.DataTree) -> Table:
    """Description of the tree and its groups: title, case, warnings, versions."""
    nodes = [("", tree), *((str(name), node) for name, node in tree.children.items() if name != QUESTIONS)]
    rows = [(group, str(name), str(value)) for group, node in nodes for name, value in node.attrs.items()]
    group, name, value = zip(*rows, strict=True) if rows else ((), (), ())
    return Table("about", {"group": list(group), "name": list(name), "value": list(value)})


def _rows(table: Table) -> Iterator[tuple[Any, ...]]:
    """Rows of plain values; NaN is an empty cell."""
    columns = [
        values if isinstance(values, list) else np.asarray(values).tolist() for values in table.columns.values()
    ]
    return zip(*([None if value != value else value for value in column] for column in columns), strict=True)


def _excel_rows(table: Table) -> Iterator[tuple[Any, ...]]:
    """Rows that fit into cells: infinity as text, long texts in pieces below each other."""
    for row in _rows(table):
        fit = [str(value) if isinstance(value, float) and math.isinf(value) else value for value in row]
        longest = max((len(value) for value in fit if isinstance(value, str)), default=0)
        if longest <= _CELL:
            yield tuple(fit)
            continue
        for start in range(0, longest, _CELL):
            yield tuple(value[start : start + _CELL] if isinstance(value, str) else value for value in fit)


def _text(cell: Any, sheet: Any, value: str) -> Any:
    """A cell of text, also where it starts with "=" and would be a formula."""
    written = cell(sheet, _CONTROL.sub(" ", value))
    written.data_type = "s"
    return written


def _sheet_name(name: str, taken: set[str]) -> str:
    """A name that Excel takes, and that no other sheet has."""
    plain = re.sub(r"[\[\]:*?/\\']", "_", name)[:_NAME] or "results"
    name, number = plain, 2
    while name.casefold() in taken:
        name = f"{plain[: _NAME - 1 - len(str(number))]}_{number}"
        number += 1
    taken.add(name.casefold())
    return name


def _pyarrow(path: str | os.PathLike[str]) -> tuple[Any, Any]:
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError as error:
        raise InputError(
            f"cannot write {path}: Parquet needs pyarrow, which is not installed; {how_to_install('study')}, or "
            "write .csv"
        ) from error
    return pyarrow, pyarrow.parquet


def _openpyxl(path: str | os.PathLike[str]) -> Any:
    try:
        import openpyxl
        import openpyxl.cell
    except ImportError as error:
        raise InputError(
            f"cannot write {path}: Excel needs openpyxl, which is not installed; {how_to_install('excel')}, or write "
            ".csv"
        ) from error
    return openpyxl
