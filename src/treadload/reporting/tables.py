"""Tables of results and statistics: a row for each quantity, a column for each case."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from treadload.plots.kit.style import power_of_ten, thousands
from treadload.reporting.reading import ReportCase, groups_in_columns
from treadload.reporting.typesetting import typeset, with_minus
from treadload.response import Response
from treadload.rows import Row as StatedRow
from treadload.rows import blocks_of, table_of

MISSING = "–"


@dataclass(frozen=True)
class Row:
    """A quantity, its unit, and its value for every case, as text. note: a word about it."""

    name: str
    unit: str
    values: tuple[str, ...]
    note: str = ""


@dataclass(frozen=True)
class NamedTable:
    """A table of texts. heading: above it, may be empty. rows: a tuple of cells for each."""

    heading: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class Section:
    """Rows under a heading."""

    heading: str
    rows: tuple[Row, ...]


def result_table(cases: list[ReportCase]) -> list[Section]:
    """What came out: forces and contact, strain, assessment; rows that no case can fill are left out."""
    strains = (
        f"Largest tensile strain at points {cases[0].depth_in_words}: near the edges of ribs it depends on the cells"
    )
    sections = []
    for kind, columns in groups_in_columns().items():
        if kind == Response.group:
            sections.append(Section(strains, tuple(_rows([case.strains for case in cases], note="direction"))))
        elif columns.rows:
            stated = [
                {row.key: row for row in case.rows(kind) if not row.group and row.key != "verdict"} for case in cases
            ]
            sections.append(Section(columns.rows, tuple(_rows(stated))))
    return _filled(sections)


def _rows(columns: Sequence[Mapping[str, StatedRow]], note: str = "") -> Iterator[Row]:
    """Rows of several cases side by side. note: what their notes are, as a row; left out, they follow the label."""
    for key in dict.fromkeys(key for column in columns for key in column):
        cells = [column.get(key) for column in columns]
        stated = [cell for cell in cells if cell is not None]
        units = {row.shown_unit for row in stated}
        unit, remark = (values.pop() if len(values) == 1 else "" for values in (units, {row.note for row in stated}))
        label = stated[0].label
        values = tuple(MISSING if row is None else typeset(row, bare=bool(unit)) for row in cells)
        yield Row(label, unit, values, "" if note else remark)
        if any(row.place is not None for row in stated):
            yield Row(
                f"{label}: where", "",
                tuple(MISSING if row is None or row.place is None else with_minus(str(row.place)) for row in cells),
            )  # fmt: skip
        if note:
            yield Row(f"{label}: {note}", "", tuple(MISSING if row is None else row.note for row in cells))


def tables_of(rows: Sequence[StatedRow]) -> tuple[NamedTable, ...]:
    """Rows of a result: a table of values for rows without a group or of a group of its own, a line a group else.

    Remarks stand in the last column.
    """
    return tuple(_grouped(block) if len(block) > 1 else _listed(block[0]) for block in blocks_of(rows))


def _listed(rows: Sequence[StatedRow]) -> NamedTable:
    return _with_remarks(
        rows[0].group, ("", ""), [(row.label, typeset(row)) for row in rows],
        [with_minus(row.remark) for row in rows],
    )  # fmt: skip


def _grouped(block: Sequence[Sequence[StatedRow]]) -> NamedTable:
    heads, *lines = table_of(block, lambda row, bare: typeset(row, bare=bare))
    several = max(sum(bool(row.remark) for row in members) for members in block) > 1
    remarks = [
        "; ".join(f"{row.label} {row.remark}" if several else row.remark for row in members if row.remark)
        for members in block
    ]
    return _with_remarks("", tuple(heads), [tuple(line) for line in lines], list(map(with_minus, remarks)))


def _with_remarks(
    heading: str, columns: tuple[str, ...], lines: Sequence[tuple[str, ...]], remarks: Sequence[str]
) -> NamedTable:
    if not any(remarks):
        return NamedTable(heading, columns, tuple(lines))
    cells = tuple((*line, remark) for line, remark in zip(lines, remarks, strict=True))
    return NamedTable(heading, (*columns, "note" if any(columns) else ""), cells)


def statistics_table(cases: list[ReportCase]) -> list[Section]:
    """How it was solved: iterations, residuals, cells, seconds."""
    sections = []
    for group, columns in groups_in_columns().items():
        statistics = [case.statistics(group) for case in cases]
        names = list(dict.fromkeys(name for stats in statistics for name in stats))
        rows = tuple(
            Row(
                _STATISTICS.get(name, name.replace("_", " ")),
                "s" if name == "seconds" else "",
                tuple(_number(stats.get(name)) for stats in statistics),
            )
            for name in names
        )
        if columns.stats:
            sections.append(Section(columns.stats, rows))
    return _filled(sections)


_STATISTICS = {
    "normal_iterations": "iterations of the normal contact",
    "normal_residual": "residual of the normal contact",
    "newton_iterations": "Newton iterations of the rolling contact",
    "krylov_iterations": "Krylov iterations of the rolling contact",
    "splitting_iterations": "splitting iterations of the rolling contact",
    "rolling_residual": "residual of the rolling contact",
    "coupling_rounds": "rounds between normal and rolling contact",
    "coupling_change": "last change of the pressure between rounds",
    "dundurs": "Dundurs' β of tire and road",
    "seconds": "time",
}


def _filled(sections: list[Section]) -> list[Section]:
    kept = [
        Section(s.heading, tuple(row for row in s.rows if any(value != MISSING for value in row.values)))
        for s in sections
    ]
    return [section for section in kept if section.rows]


def _number(value: object) -> str:
    if value is None:
        return MISSING
    if isinstance(value, bool):
        return "yes" if value else "no"
    if not isinstance(value, int | float):
        return str(value)
    if float(value).is_integer() and abs(value) < 1e9:
        return thousands(float(value))
    if abs(value) >= 0.01:
        return f"{value:.3g}"
    return power_of_ten(value) if value > 0 else f"{value:.2g}".replace("-", "\u2212")
