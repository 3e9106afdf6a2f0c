"""What is varied, from texts and tables: "friction=0.3:0.9:7", a CSV file, a sheet of Excel."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from treadload.case import Case
from treadload.case.changes import read_value
from treadload.case.keys import find_key
from treadload.errors import InputError, nearest
from treadload.files import EXCEL
from treadload.results.sheets import numbered_rows
from treadload.sweeps.absent import absent_in, layer_columns
from treadload.sweeps.design import ROW, Design, listed, product
from treadload.sweeps.sampling import bounds_of, sampled
from treadload.tables import NO_DATA, read_table

EXAMPLES = 'friction=0.3:0.9:7, normal_load="20 kN:40 kN:5" or pavement.temperature=[5, 15, 35]'
# Values that one text may ask for.
_MOST = 100_000
IDS = ("id", "name", "section", "label")
"""Headings, in capitals or not, of columns that identify a row of a table."""
# Cells without a value.
_EMPTY = {"", *(word.casefold() for word in NO_DATA)}
_HEADING = re.compile(r"(?P<name>[^\[(]+?)\s*(?:[\[(](?P<unit>[^\])]*)[\])])?")


def from_texts(case: Case, texts: Sequence[str], *, sample: str = "", seed: int = 0) -> Design:
    """The cases that texts ask for.

    texts: "key=low:high:count", evenly spaced, with ":log" behind it evenly in their logarithms; "key=[a, b, c]", a
    list of TOML; every combination of them is a case. sample: "sobol:256", "latin:100" or "random:50": so many cases
    spread over ranges "key=low:high" instead. seed: of the sample. Raises InputError.

    >>> wheel = {"tire": {"profile": "315/80R22.5"}, "rolling": {"normal_load": "32.5 kN", "friction": 0.7}}
    >>> case = tl.Case.from_dict(wheel | {"pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3", "temperature": 15}})
    >>> design = tl.sweeps.from_texts(case, ["normal_load=20e3:40e3:3", "friction=[0.5, 0.7]"])
    >>> f"{design.count} cases", design.at(5)
    ('6 cases', {'rolling.normal_load': 40000.0, 'rolling.friction': 0.7})
    """
    pairs: dict[str, str] = {}
    for text in texts:
        name, sign, value = (part.strip() for part in text.partition("="))
        if not sign or not name or not value:
            raise InputError(f"cannot vary {text!r}: write key=values, such as {EXAMPLES}")
        if name in pairs:
            raise InputError(f"{name} is varied twice; give all its values at once")
        pairs[name] = value.strip("\"'")
    if sample:
        method, _, count = sample.partition(":")
        if not (count.isascii() and count.isdigit() and len(count) < 9):
            raise InputError(f"cannot sample {sample!r}: write the method and how many cases, such as sobol:256")
        ranges = {name: _ends(name, text) for name, text in pairs.items()}
        return sampled(case, ranges, int(count), method=method, seed=seed)
    return product(case, {name: _values(case, name, text) for name, text in pairs.items()})


def _ends(name: str, text: str) -> tuple[object, object]:
    parts = [part.strip() for part in text.split(":")]
    if len(parts) != 2 or not all(parts):
        raise InputError(f"a sample needs the low and the high end of {name}, as {name}=0.3:0.9, got {text!r}")
    return read_value(parts[0]), read_value(parts[1])


def _values(case: Case, name: str, text: str) -> list[object]:
    if text.startswith("["):
        items = read_value(text)
        if not isinstance(items, list):
            raise InputError(f'cannot read the list {text!r} of {name}; write it as ["20 kN", "30 kN"]')
        return items
    parts = [part.strip() for part in text.split(":")]
    spaced = parts[-1] == "log"
    parts = parts[:-1] if spaced else parts
    if len(parts) != 3 or not all(parts):
        if "," in text or ";" in text:
            raise InputError(f"{name}={text}: write a list in brackets, as {name}=[0.3, 0.5]")
        if len(parts) == 1:
            return [read_value(text)]
        raise InputError(f"{name}={text}: a range is low:high:count, such as {EXAMPLES}")
    count = parts[2]
    if not (count.isascii() and count.isdigit() and 2 <= int(count) <= _MOST):
        raise InputError(f"{name}={text}: the count of a range is a whole number from 2 to {_MOST}, got {count!r}")
    low, high = (read_value(part) for part in parts[:2])
    # A unit behind the high end alone holds for both: "20:40 kN:5".
    if isinstance(low, int | float) and isinstance(high, str) and (unit := re.search(r"[^\d.,\s+-].*$", high)):
        low = f"{parts[0]} {unit[0]}"
    start, end = bounds_of(case, {name: (low, high)})[name]
    if spaced and start <= 0:
        raise InputError(f"{name}={text}: logarithms need ends above zero, got {start:g}")
    values = np.geomspace(start, end, int(count)) if spaced else np.linspace(start, end, int(count))
    # Round-off in a step would make values that nobody typed: 0.6000000000000001.
    return [float(f"{value:.12g}") for value in values]


def from_file(
    case: Case, path: str | os.PathLike[str], *, ids: Sequence[str] = (), absent_layers: bool = False
) -> Design:
    """Cases from a CSV file or the first visible sheet of an Excel workbook: headings are keys, rows are cases.

    A heading may carry a unit, "normal_load [kN]"; a cell may, too. ids: headings of columns that only identify a row
    and go through to the results, as `IDS` do without being listed; so does the number of the row. absent_layers:
    True where a layer all of whose cells are empty is absent in the row, as it is with a thickness of 0. A row that
    cannot be read fails alone. Raises InputError.

    >>> tire = {"profile": {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}, "inflation_pressure": "8 bar"}
    >>> road = {"layers": [{"material": {"kind": "elastic", "modulus": "5 GPa", "poisson": 0.35}}]}
    >>> wheel = {"normal_load": "100 N", "friction": 0.7}
    >>> case = tl.Case.from_dict({"tire": tire, "pavement": road, "rolling": wheel, "spacing": "6 mm"})
    >>> from pathlib import Path
    >>> _ = Path("loads.csv").write_text('''normal_load [N],friction
    ... 50,0.5
    ... 100,0.7''')
    >>> design = tl.sweeps.from_file(case, "loads.csv")
    >>> f"{design.count} cases", design.at(1)
    ('2 cases', {'rolling.normal_load': 100.0, 'rolling.friction': 0.7})
    """
    path = Path(path)
    head, rows = _read(path)
    columns = _columns(path, head)
    names = [name for name, _ in columns]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise InputError(f"{path} has two columns {twice!r}; give each its heading")
    unknown = next((name for name in ids if name not in names), None)
    if unknown is not None:
        raise InputError(f"{path} has no column {unknown!r} of ids; {nearest(unknown, names, 'it has')}")
    chosen = [name for name in names if name in ids or name.casefold() in IDS]
    _check_keys(case, path, [name for name in names if name not in chosen])
    called = {name: f"id_{name}" if name == ROW else name for name in chosen}
    labels: dict[str, list[str | int]] = {ROW: [], **{name: [] for name in called.values()}}
    cases: list[dict[str, Any]] = []
    faults: dict[int, str] = {}
    layers = layer_columns(case, [name for name in names if name not in chosen])
    for number, (line, row) in enumerate(rows):
        cells = dict(zip(names, [*row, *[None] * len(names)], strict=False))
        labels[ROW].append(line)
        for name in chosen:
            labels[called[name]].append(_label(cells[name]))
        wanted = {name: unit for name, unit in columns if name not in chosen}
        absent = absent_in(layers, cells, wanted, empty_is_absent=absent_layers)
        empty = [name for name in wanted if name not in absent and _is_empty(cells[name])]
        if any(not _is_empty(cell) for cell in row[len(names) :]) or len(row) < len(names):
            faults[number] = f"{len(row)} values where the header has {len(names)}"
        elif empty:
            faults[number] = f"no value of {', '.join(empty)}"
            if absent_layers and any(layer.thickness in empty for layer in layers):
                faults[number] += "; give a thickness of 0 where the layer is absent"
        read = {name: None if name in empty else _cell(cells[name], unit) for name, unit in wanted.items()}
        cases.append({**read, **absent})
    if rows and len(faults) == len(rows):
        raise InputError(f"{path}, line {rows[0][0]}: {faults[0]}; no row of the table can be read")
    return listed(case, cases, labels=labels, faults=faults)


def headings(path: str | os.PathLike[str]) -> list[tuple[str, str]]:
    """Names and units, "" for none, of the columns of a table of cases. Raises InputError."""
    path = Path(path)
    return _columns(path, _read(path)[0])


def _columns(path: Path, head: Sequence[object]) -> list[tuple[str, str]]:
    columns: list[tuple[str, str]] = []
    for cell in head:
        match = _HEADING.fullmatch(str(cell).strip())
        if match is None:
            raise InputError(f"{path}: {cell!r} is no heading of a key, such as friction or normal_load [kN]")
        columns.append((match["name"].strip(), (match["unit"] or "").strip()))
    return columns


def _check_keys(case: Case, path: Path, names: Sequence[str]) -> None:
    """Raise InputError for headings that are no keys of a case, with what a column of ids needs."""
    if not names:
        raise InputError(f"{path} varies nothing: its columns are ids; add one that is a key, such as friction")
    for name in names:
        try:
            find_key(case, name)
        except InputError as error:
            raise InputError(
                f"{path}, column {name!r}: {error}; a column that only identifies its row has the heading "
                f"{', '.join(IDS[:-1])} or {IDS[-1]}, or is named by --id {name!r}"
            ) from error


def _is_empty(cell: object) -> bool:
    return cell is None or (isinstance(cell, str) and cell.strip().casefold() in _EMPTY)


def _label(cell: object) -> str:
    """A cell as the text of an id: 12 for the 12.0 of a spreadsheet."""
    plain = int(cell) if isinstance(cell, float) and cell.is_integer() else cell
    return "" if plain is None else str(plain).strip()


def _cell(cell: object, unit: str) -> object:
    if not isinstance(cell, bool | int | float | str):
        # A date, say, which is no value of a case.
        cell = str(cell)
    if isinstance(cell, str):
        return f"{cell} {unit}" if unit and unit not in ("-", "1") else read_value(cell)
    return f"{cell!r} {unit}" if unit and unit not in ("-", "1") else cell


def _read(path: Path) -> tuple[Sequence[object], Sequence[tuple[int, Sequence[object]]]]:
    """Headings, and rows with their numbers, of a sheet or a table of text."""
    return _sheet(path) if path.suffix.lower() in EXCEL else _text(path)


def _text(path: Path) -> tuple[Sequence[object], Sequence[tuple[int, Sequence[object]]]]:
    table = read_table(path)
    if not table.has_header:
        raise InputError(
            f"{path}: the first line names the keys, such as friction;normal_load [kN]; it holds numbers"
        )
    return table.rows[0], list(zip(table.lines[1:], table.rows[1:], strict=True))


def _sheet(path: Path) -> tuple[Sequence[object], Sequence[tuple[int, Sequence[object]]]]:
    (_, head), *rows = numbered_rows(path)
    width = max((k + 1 for k, cell in enumerate(head) if cell is not None), default=0)
    return head[:width], rows
