"""The numbers that a result states, row by row: summary, notebook, report, page, sheet and sweep render these rows.

A row names its variable; label, display unit and format stand in `variables.py`.
"""

from __future__ import annotations

import itertools
import json
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import SupportsFloat, TypedDict

import numpy as np

from treadload.us_units import display_units, in_display_units, sentence_in_display_units, us_unit
from treadload.variables import SCALES, Display, display_of

_WIDEST, _LONGEST = 34, 26
"""Letters, at most: of a label that sets the column of the values in a summary, of a cell in a table of one."""

# A table wider than a terminal is turned: a line a quantity in place of a line a group.
_TERMINAL = 100


@dataclass(frozen=True)
class Place:
    """Where in the road a number holds. x: along travel, y: to the right, depth: below the surface, m."""

    x: float
    y: float
    depth: float | None = None

    def __str__(self) -> str:
        inch = us_unit("mm")
        if inch is not None:
            deep = "" if self.depth is None else f", {inch.number(self.depth):.4g} in deep"
            return f"x = {inch.number(self.x):z.3f} in, y = {inch.number(self.y):z.3f} in{deep}"
        deep = "" if self.depth is None else f", {self.depth * 1e3:.4g} mm deep"
        return f"x = {_mm(self.x)} mm, y = {_mm(self.y)} mm{deep}"


@dataclass(frozen=True)
class Row:
    """A number or a text that a result states.

    key: name of the variable, or of the row where it is none. label: for people. value: a number in SI units, or a
    text. unit: that the number is shown in, a key of `variables.SCALES`. form: of the shown number, a format or a
    function of the SI value that returns the text with its unit. note: a remark behind the value. place: where the
    number holds. group: rows with the same heading, such as the name of a criterion.
    """

    key: str
    label: str
    value: float | str
    unit: str = ""
    form: str | Callable[[float], str] = ".4g"
    note: str = ""
    place: Place | None = None
    group: str = ""

    @property
    def number(self) -> str:
        """The value in its display unit, without the unit where that is fixed."""
        if isinstance(self.value, str):
            return sentence_in_display_units(self.value)
        if math.isnan(self.value):
            return "–"
        if callable(self.form):
            return in_display_units(self.form(self.value), self.value, self.key)
        us = us_unit(self.unit, self.key)
        if us is not None:
            return us.text(self.value, self.form)
        return format(self.value * SCALES[self.unit], self.form)

    @property
    def shown_unit(self) -> str:
        """The unit of `number`; empty where the number stands with its unit, has none or is a text."""
        if callable(self.form) or isinstance(self.value, str):
            return ""
        us = us_unit(self.unit, self.key)
        return self.unit if us is None else us.symbol

    @property
    def text(self) -> str:
        """The value with its unit."""
        bare = not self.shown_unit or isinstance(self.value, str) or math.isnan(self.value)
        return self.number if bare else f"{self.number} {self.shown_unit}"

    @property
    def sentence(self) -> str:
        """The value with its unit, place and note."""
        return self.text + (" " if self.place else ", " if self.note else "") + self.remark

    @property
    def remark(self) -> str:
        """Place and note; empty without either."""
        note = sentence_in_display_units(self.note)
        return ", ".join(filter(None, (f"at {self.place}" if self.place else "", note)))


def row(
    key: str,
    value: SupportsFloat | str,
    *,
    label: str = "",
    note: str = "",
    place: Place | None = None,
    group: str = "",
    display: Display | None = None,
) -> Row:
    """The row of a variable, shown as `variables.py` states.

    key: of a variable, or of a row that is none. value: in SI units, or a text. label: in place of the variable's.
    display: in place of that of the variable. Raises KeyError for a number whose key is not a variable's and that has
    no display.
    """
    number = value if isinstance(value, str) else float(value)
    if isinstance(number, str) and label:
        return Row(key, label, number, note=note, place=place, group=group)
    shown = display or display_of(key)
    return Row(key, label or shown.label, number, shown.unit, shown.form, note, place, group)


def extremes(key: str, values: Sequence[float] | np.ndarray) -> Row:
    """The row of the largest of several values, with the smallest behind it where it differs."""
    high, low = row(key, max(values)), row(key, min(values))
    return high if high.text == low.text else replace(high, note=f"smallest {low.text}")


def as_text(rows: Sequence[Row], warnings: Iterable[str] = ()) -> str:
    """Rows and warnings as a screenful of text: a line a row, a table where several groups have the same rows."""
    lines: list[str] = []
    wide = min(max((len(line.label) for line in rows if not line.group), default=0), _WIDEST)
    for block in blocks_of(rows):
        if len(block) > 1:
            lines += _table(block)
            continue
        (members,) = block
        if members[0].group:
            lines.append(f"{members[0].group}:")
        indent = "  " if members[0].group else ""
        column = max(len(member.label) for member in members) if members[0].group else wide
        lines += [
            f"{indent}{member.label:<{column}}  {member.sentence}" if member.label else member.sentence
            for member in members
        ]
    return "\n".join(lines + [f"warning: {sentence_in_display_units(text)}" for text in warnings])


def blocks_of(rows: Sequence[Row]) -> list[list[list[Row]]]:
    """Rows by group, in their order, and neighbouring groups with the same keys together: such a block is a table.

    Groups with several places stay apart.
    """
    groups = [list(members) for _, members in itertools.groupby(rows, key=lambda member: member.group)]
    blocks: list[list[list[Row]]] = []
    for members in groups:
        keys = [member.key for member in members]
        before = blocks[-1][-1] if blocks else None
        # Several places in a line cannot be read.
        sparse = all(sum(member.place is not None for member in part) <= 1 for part in (members, before or ()))
        alike = before is not None and before[0].group and members[0].group and sparse
        if alike and [member.key for member in before or ()] == keys:
            blocks[-1].append(members)
        else:
            blocks.append([members])
    return blocks


def _plain_cell(shown: Row, bare: bool) -> str:
    return shown.number if bare else shown.text


def table_of(block: Sequence[Sequence[Row]], write: Callable[[Row, bool], str] = _plain_cell) -> list[list[str]]:
    """A block of groups with the same keys as cells of text: a line of heads, then a line a group.

    A head is the label, with the unit where all of the column share it; a cell is then the bare number. write: a
    cell, of a row and whether it goes without its unit.
    """
    heads, columns = [""], [[members[0].group for members in block]]
    for column in zip(*block, strict=True):
        units = {member.shown_unit for member in column}
        unit = units.pop() if len(units) == 1 else ""
        heads.append(f"{column[0].label}, {unit}" if unit else column[0].label)
        columns.append([write(shown, bool(unit)) for shown in column])
    return [heads, *map(list, zip(*columns, strict=True))]


def notes_of(block: Sequence[Sequence[Row]]) -> list[str]:
    """Remarks and places of the rows of a table, with the group that each belongs to."""
    return [f"{member.group}: {member.remark}" for members in block for member in members if member.remark]


def as_json(rows: Iterable[Row]) -> str:
    """Rows as a text that a file holds."""
    with display_units("si"):
        return json.dumps([_plain(line) for line in rows], ensure_ascii=False)


def from_json(text: object) -> tuple[Row, ...]:
    """Rows that a file holds; none where the text is not that of rows."""
    try:
        tables = json.loads(text) if isinstance(text, str) else []
        return tuple(_read(table) for table in tables)
    except (ValueError, TypeError, KeyError, RecursionError):
        return ()


def _plain(shown: Row) -> dict[str, object]:
    place = None if shown.place is None else [shown.place.x, shown.place.y, shown.place.depth]
    # A function of the number is kept by what it wrote.
    form = {"text": shown.text} if callable(shown.form) else shown.form
    table = {"key": shown.key, "label": shown.label, "value": shown.value, "unit": shown.unit, "form": form,
             "note": shown.note, "place": place, "group": shown.group}  # fmt: skip
    return {name: value for name, value in table.items() if value not in ("", None)}


class RowTable(TypedDict, total=False):
    """A row as a file holds it; what stands at its default is left out. form: or the text that it made."""

    key: str
    label: str
    value: float | str
    unit: str
    form: str | dict[str, str]
    note: str
    place: list[float] | None
    group: str


def _written(text: str) -> Callable[[float], str]:
    return lambda value: text


def _read(table: RowTable) -> Row:
    shape, place = table.get("form", ""), table.get("place")
    form: str | Callable[[float], str] = shape if isinstance(shape, str) else _written(str(shape["text"]))
    value, unit = table.get("value", ""), str(table.get("unit", ""))
    if not isinstance(value, str):
        value, _ = float(value), SCALES[unit]
    return Row(str(table["key"]), str(table.get("label", "")), value, unit, form, str(table.get("note", "")),
               None if place is None else Place(*place), str(table.get("group", "")))  # fmt: skip


def _aligned(lines: Iterable[Sequence[str]]) -> list[str]:
    """Lines of cells as text: the first column to the left, the others to the right."""
    lines = list(lines)
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    return [
        "  ".join(f"{cell:{'>' if k else '<'}{widths[k]}}" for k, cell in enumerate(line)).rstrip() for line in lines
    ]


def _table(block: Sequence[Sequence[Row]]) -> list[str]:
    """A line a group, or a line a quantity where that is narrower; columns of long texts, and remarks, below."""
    lines = table_of(block)
    widths = [max(map(len, column)) for column in zip(*(lines[1:]), strict=True)]
    shown = [k for k, width in enumerate(widths) if k == 0 or width <= _LONGEST]
    cells = [[line[k] for k in shown] for line in lines]
    written = _aligned(cells)
    if max(map(len, written)) > _TERMINAL:
        written = min(written, _aligned(zip(*cells, strict=True)), key=lambda way: max(map(len, way)))
    for members, line in zip(block, lines[1:], strict=True):
        long = [k - 1 for k in range(1, len(line)) if k not in shown]
        remarks = [
            f"{member.label} {member.sentence}" if k in long else member.remark for k, member in enumerate(members)
        ]
        written += [f"  {members[0].group}: {remark}" for remark in remarks if remark]
    return written


def _mm(metres: float) -> str:
    # + 0.0: no "-0.0" for round-off.
    return f"{round(metres * 1e3, 1) + 0.0:.1f}"
