"""Workbooks of cases in earnest: cells as people fill them, sheets swapped, merged and hidden, archives changed.

A workbook is written by openpyxl and its parts are changed as XML. A row that holds what was written must give it to
the last digit; a row that does not must fail alone, named; a workbook that is none must be refused in one sentence.
"""

from __future__ import annotations

import datetime
import functools
import io
import random
import re
import warnings
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import openpyxl

import treadload as tl
from fuzz.runner import REFUSED, TAKEN, Refusal, WrongAnswer, ask
from fuzz.smudging import broken
from treadload.sweeps import Design, from_file
from treadload.templates import first_case

_SHEET = "xl/worksheets/sheet1.xml"
# What no number is, in the place of one.
_NO_NUMBER = (
    "ERR",
    "#DIV/0!",
    "1.2.3",
    True,
    datetime.datetime(2026, 3, 1),
    "kN",
    "∞",
    "one",
    "1 2",
    "=",
    "--",
)
_SAME = 1e-12


def prepare() -> None:
    """The case is read before warnings are errors."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        _case()


def attack(rng: random.Random, folder: Path) -> str:
    """Write a table of cases, perhaps with odd cells or something wrong, and read it."""
    count = rng.randrange(1, 9)
    wanted: list[tuple[float, float] | None] = []
    cells: list[list[Any]] = []
    for _ in range(count):
        friction, load = (
            round(rng.uniform(0.3, 0.9), rng.randrange(1, 12)),
            round(rng.uniform(15, 40), rng.randrange(9)),
        )
        row, known = _row(rng, friction, load)
        cells.append(row)
        wanted.append((friction, 1e3 * load) if known else None)
    head = ["id", "friction", rng.choice(("normal_load [kN]", "normal_load (kN)", " normal_load  [kN] "))]
    if all(row is None for row in wanted):
        wanted, cells = [(0.5, 2e4)], [["A1", 0.5, 20]]
    merged = count > 1 and len(cells) == count and wanted[0] is not None and rng.random() < 0.2
    if merged:
        # Of merged cells the first alone has a value.
        cells[1], wanted[1] = [cells[1][0], None, 20], None
    content = _book(rng, head, cells, merged=merged)
    wrong = rng.random() < 0.2
    content = _spoiled(rng, content) if wrong else content
    path = folder / "cases.xlsx"
    path.write_bytes(content)
    answer = ask(lambda: from_file(_case(), path))
    if isinstance(answer, Refusal):
        if not wrong:
            raise WrongAnswer(f"a right workbook was refused: {answer}")
        return REFUSED
    if wrong:
        return "taken though changed"
    return _judged(answer, wanted)


def _judged(design: Design, wanted: list[tuple[float, float] | None]) -> str:
    """Rows hold what was written, or are faults."""
    if design.count != len(wanted):
        raise WrongAnswer(f"{design.count} cases of {len(wanted)} rows")
    columns = {variable.name: variable.labels for variable in design.inputs}
    for number, row in enumerate(wanted):
        if (number in design.faults) != (row is None):
            raise WrongAnswer(f"row {number} of {wanted}: {design.faults.get(number, 'no fault')}")
        if row is not None:
            found = float(columns["friction"][number]), float(columns["normal_load"][number])
            if any(abs(one - other) > _SAME * other for one, other in zip(found, row, strict=True)):
                raise WrongAnswer(f"{found} in place of {row}")
    return TAKEN


def _row(rng: random.Random, friction: float, load: float) -> tuple[list[Any], bool]:
    """Cells of a row, and whether they hold a case."""
    name: Any = rng.choice(("A12", 7, 7.5, "größe", None, datetime.date(2026, 1, 1)))
    which = rng.randrange(12)
    if which == 0:
        # A number kept as text, as tables that were pasted have it.
        return [name, str(friction), f" {load!r} "], True
    if which == 1:
        return [name, friction, f"{load!r} kN"], False
    if which == 2:
        return [name, rng.choice(_NO_NUMBER), load], False
    if which == 3:
        return [name, friction, rng.choice(_NO_NUMBER)], False
    if which == 4:
        return [name, *rng.choice(((None, load), (friction, None), ("", load), (friction, "NaN")))], False
    if which == 5:
        # A formula that was never calculated has no value.
        return [name, f"={friction!r}", load], False
    if which == 6:
        return [name, friction, load, "beside the table"], False
    return [name, friction, load], True


def _book(rng: random.Random, head: list[str], rows: list[list[Any]], *, merged: bool) -> bytes:
    """A workbook as spreadsheets save it, with things that change nothing. merged: friction of the first two."""
    book = openpyxl.Workbook()
    sheet = book.active
    for row in [head, *rows]:
        sheet.append(row)
        if not merged and rng.random() < 0.1:
            sheet.append([])
    if merged:
        sheet.merge_cells("B2:B3")
    if rng.random() < 0.3:
        sheet.freeze_panes, sheet["A1"].comment = "A2", openpyxl.comments.Comment("words", "a person")
    if isinstance(sheet["B2"].value, float) and rng.random() < 0.3:
        sheet["B2"].number_format = rng.choice(("0.00E+00", "0%", '"about" 0.0'))
    if rng.random() < 0.3:
        other = book.create_sheet("notes", 0 if rng.random() < 0.5 else None)
        other.append(["friction", "normal_load [kN]"])
        other.append([0.123, 99])
        if book.index(other) == 0:
            other.sheet_state = rng.choice(("hidden", "veryHidden"))
            book.active = 1
    if rng.random() < 0.2:
        # Formats down to the last row that there can be.
        sheet.row_dimensions[50_000].height = 20
    if rng.random() < 0.2:
        book.defined_names["loads"] = openpyxl.workbook.defined_name.DefinedName("loads", attr_text="Sheet!$B$2:$B$9")
    stream = io.BytesIO()
    book.save(stream)
    content = stream.getvalue()
    if rng.random() < 0.2:
        # As a selection of all columns leaves it.
        content = _with(
            content, _own_sheet(content), lambda xml: re.sub(rb'ref="A1:\w+"', b'ref="A1:XFD1048576"', xml)
        )
    return content


def _own_sheet(content: bytes) -> str:
    """The member with the table of cases: the one that has an id."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        names = sorted(name for name in archive.namelist() if name.startswith("xl/worksheets/sheet"))
        return next((name for name in names if b"hidden" not in name.encode()), _SHEET)


def _with(content: bytes, member: str, change: Callable[[bytes], bytes]) -> bytes:
    """The archive with one of its members changed."""
    stream = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(content)) as archive, zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as made:
        for name in archive.namelist():
            part = archive.read(name)
            made.writestr(name, change(part) if name == member else part)
    return stream.getvalue()


def _spoiled(rng: random.Random, content: bytes) -> bytes:
    """A workbook with something wrong in it."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        names = archive.namelist()
    which = rng.randrange(12)
    if which == 0:
        return broken(rng, content)
    if which == 1:
        return content[: rng.randrange(len(content))]
    if which == 2:
        return _with(content, rng.choice(names), lambda part: broken(rng, part))
    if which == 3:
        entities = b'<!ENTITY a0 "lol">' + b"".join(
            b'<!ENTITY a%d "%s">' % (k, b"&a%d;" % (k - 1) * 10) for k in range(1, 12)
        )
        return _with(content, rng.choice(names), lambda part: b"<!DOCTYPE a [%s]><a>&a11;</a>" % entities)
    if which == 4:
        return _with(content, _SHEET, lambda part: part.replace(b"</sheetData>", b" " * 4 * 10**7 + b"</sheetData>"))
    if which == 5:
        # A cell in the last row and column that there can be, in many rows.
        rows = b"".join(b'<row r="%d"><c r="XFD%d"><v>1</v></c></row>' % (k, k) for k in range(1000, 3000))
        return _with(content, _SHEET, lambda part: part.replace(b"</sheetData>", rows + b"</sheetData>"))
    if which == 6:
        row = rng.choice((b"1048576", b"99999999999", b"-1", b"0", b"x"))
        return _with(content, _SHEET, lambda part: part.replace(b'r="2"', b'r="%s"' % row))
    if which == 7:
        kind = rng.choice((b"s", b"str", b"b", b"e", b"d", b"inlineStr", b"q"))
        return _with(content, _SHEET, lambda part: part.replace(b't="n"', b't="%s"' % kind))
    if which == 8:
        value = rng.choice((b"nan", b"1e999", b"-1e999", b"", b"99999999", b"1,5", b"\xff\xfe", b"0x1"))
        return _with(content, _SHEET, lambda part: re.sub(rb"<v>[^<]*</v>", b"<v>%s</v>" % value, part))
    if which == 9:
        one, other = rng.sample(names, 2)
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            first, second = archive.read(one), archive.read(other)
        return _with(_with(content, one, lambda _: second), other, lambda _: first)
    if which == 10:
        return _with(content, rng.choice(names), lambda _: rng.choice((b"", b"\0" * 100, b"<a/>", b"\xff\xfe<a/>")))
    return rng.choice((b"", b"a;b\n1;2\n", b"PK\x03\x04", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(4000)))


@functools.cache
def _case() -> tl.Case:
    return tl.Case.from_text(first_case("run"))
