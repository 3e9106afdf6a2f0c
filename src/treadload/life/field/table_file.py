"""Tables of road sections from text files: a TOML file names them, their columns, units and what empty cells mean."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Literal

import numpy as np

from treadload.errors import InputError, nearest
from treadload.kernels.arrays import Array
from treadload.life.field.events import Surveyed, events_of_columns, events_of_surveys
from treadload.life.field.table import SectionTable
from treadload.named import Catalogue, read_tables, sentence
from treadload.tables import Table, read_table

Meaning = Literal["", "none seen", "not recorded"]
# What a column means → its name in the layout of LTPP's tables, with the unit in it.
COLUMNS: dict[str, str] = {
    "thickness": "asphalt_thickness_mm",
    "family": "family",
    "traffic": "kesal_per_year",
    "mean_air": "mean_air_temperature_C",
    "entry": "age_first_survey",
    "last": "age_last_survey",
    "last_without": "age_last_without_wheelpath_crack",
    "first_crack": "age_first_wheelpath_crack",
    "first_alligator": "age_first_alligator",
    "first_crack_is": "first_crack_is",
    "age": "age",
    "wheelpath_crack": "wheelpath_crack_m",
    "alligator": "alligator_m2",
}
# Unit of a column → factor to SI, and the unit that the layout has.
UNITS: dict[str, dict[str, float]] = {
    "thickness": {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "in": 0.0254},
    "traffic": {"1000/year": 1e3, "1/year": 1.0},
    "mean_air": {"degC": 1.0, "degF": 1.0},
}
# Asphalt of roads, m: a table whose median lies outside is in another unit.
_THINNEST, _THICKEST = 0.025, 0.60
_OLDEST = 100.0


@dataclass(frozen=True)
class TableFile:
    """A TOML file of a table.

    name: of the table. sections, surveys: text files, from the folder of the TOML file; without surveys the events
    are read of the columns of the sections. section: columns that make the name of a section, in both files. columns:
    names of columns where they differ from `COLUMNS`. units: of columns where they differ: thickness "mm", "cm", "m"
    or "in"; traffic "1000/year" or "1/year"; mean_air "degC" or "degF". empty_crack: what an empty cell of a crack
    means, "none seen" or "not recorded". title, source, caveats: of the table. predictions: file of ages that
    mechanics predicted, see `write_predictions`. The table [priors] gives what the sections do not state, see
    `Priors`.
    """

    name: str
    sections: Path
    surveys: Path | None = None
    section: tuple[str, ...] = ("state", "shrp")
    columns: dict[str, str] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)
    empty_crack: Meaning = ""
    title: str = ""
    source: str = ""
    caveats: tuple[str, ...] = ()
    predictions: Path | None = None

    def column(self, meaning: str) -> str:
        """Name of a column in the file."""
        return self.columns.get(meaning, COLUMNS[meaning])


def read_field_table(path: str | os.PathLike[str]) -> SectionTable:
    """The road sections of a TOML file, see `TableFile`, or of the catalogue: "LTPP".

    Raises InputError: no ages, surveys before construction, an empty cell that can mean two things, units by mistake.

    >>> thickness = tl.life.read_field_table("LTPP").thickness
    >>> f"{len(thickness)} sections with {thickness.min() * 1e3:.0f} to {thickness.max() * 1e3:.0f} mm of asphalt"
    '149 sections with 23 to 399 mm of asphalt'
    """
    if isinstance(path, str) and not path.endswith(".toml"):
        return field_tables[path]
    return _read_file(Path(path))[0]


def _read_file(path: Path) -> list[SectionTable]:
    # pydantic is loaded when a file is read, not before.
    from treadload.read import read

    tables = read_tables(path)
    priors = tables.pop("priors", {})
    if not isinstance(priors, dict):
        raise InputError(f"{path}: priors must be a table, [priors], got {priors!r}")
    described: TableFile = read(TableFile, tables, str(path), folder=path.parent)
    for kind, keys in (("columns", COLUMNS), ("units", UNITS)):
        wrong = next((key for key in getattr(described, kind) if key not in keys), None)
        if wrong is not None:
            raise InputError(f"{path}: no {kind} of {wrong!r}; {nearest(wrong, keys)}")
    return [replace(_table(described), priors=priors)]


def _table(file: TableFile) -> SectionTable:
    rows = _Columns(file, read_table(file.sections))
    count = len(rows.names)
    twice = next((name for name in rows.names if rows.names.count(name) > 1), None)
    if twice is not None:
        raise InputError(f"{file.sections}: section {twice!r} is there twice; keep one row for each construction")
    surveys = None if file.surveys is None else _surveys(file, rows.names)
    if surveys is None and not (rows.has("entry") and rows.has("last")):
        raise InputError(
            f"{file.sections} has no ages: no column {file.column('entry')!r} or {file.column('last')!r}, and no "
            'file of surveys; name the columns in [columns] as entry = "…", last = "…", or give surveys = "….csv"'
        )
    warnings: list[str] = []
    if surveys is None:
        entry, last = rows.numbers("entry"), rows.numbers("last")
        ages = tuple(np.unique([first, end]) for first, end in zip(entry, last, strict=True))
        events, kept, sentences = events_of_columns(rows, entry, last, file.empty_crack)
    else:
        ages = tuple(survey.age for survey in surveys)
        entry, last = np.array([age[0] for age in ages]), np.array([age[-1] for age in ages])
        events, kept, sentences = events_of_surveys(surveys)
    warnings += sentences
    _check_ages(file, rows.names, entry, last)
    thickness, traffic, mean_air = (rows.in_si(key) for key in ("thickness", "traffic", "mean_air"))
    _check_thickness(file, thickness)
    families = tuple(rows.texts("family")) if rows.has("family") else ("",) * count
    for key, values in (("thickness", thickness), ("traffic", traffic), ("mean_air", mean_air)):
        missing = int(np.isnan(values).sum())
        if missing:
            warnings.append(
                f"{_IN_WORDS[key]} is missing in {missing} of {count} sections: the mechanics take a prior there"
            )
    table = SectionTable(
        file.name, tuple(rows.names), entry, last, events, thickness, traffic, mean_air, families, ages,
        file.title, sentence(file.source), tuple(map(sentence, file.caveats)), tuple(warnings), file.predictions,
    )  # fmt: skip
    return table if kept.all() else table.at(kept)


_IN_WORDS = {"thickness": "the thickness of the asphalt", "traffic": "the traffic", "mean_air": "the air temperature"}


class _Columns:
    """Cells of a table of sections, or of surveys, by what their columns mean."""

    def __init__(self, file: TableFile, table: Table) -> None:
        self.file, self.table = file, table
        if not table.has_header:
            raise InputError(f"{table.path}: the first line has no names of columns; write them, see `COLUMNS`")
        self.heads = list(table.rows[0])
        missing = [name for name in file.section if name not in self.heads]
        if missing:
            raise InputError(
                f'{table.path} has no column {missing[0]!r}, which names a section; state which do: section = ["…"]'
            )
        places = [self.heads.index(name) for name in file.section]
        self.names = ["-".join(row[k] for k in places if k < len(row)) for row in table.rows[1:]]

    def has(self, meaning: str) -> bool:
        """True if there is such a column."""
        return self.file.column(meaning) in self.heads

    def texts(self, meaning: str) -> list[str]:
        """Cells of a column as they stand there."""
        place = self.heads.index(self.file.column(meaning))
        return [row[place] for row in self.table.rows[1:]]

    def numbers(self, meaning: str) -> Array:
        """Numbers of a column (n,), NaN in empty cells and where there is no such column. Raises InputError."""
        if not self.has(meaning):
            return np.full(len(self.names), math.nan)
        name = self.file.column(meaning)
        values, _ = self.table.values([self.heads.index(name)], first=1, name=lambda _: name)
        return values[:, 0]

    def in_si(self, meaning: str) -> Array:
        """Numbers of a column that has a unit."""
        factors = UNITS[meaning]
        unit = self.file.units.get(meaning, next(iter(factors)))
        if unit not in factors:
            raise InputError(f"the unit of {meaning} must be one of {', '.join(factors)}, got {unit!r}")
        values = self.numbers(meaning)
        return (values - 32) / 1.8 if unit == "degF" else values * factors[unit]


def _surveys(file: TableFile, names: Sequence[str]) -> list[Surveyed]:
    """The surveys of each section, in order of age. Raises InputError."""
    assert file.surveys is not None
    rows = _Columns(file, read_table(file.surveys))
    for meaning in ("age", "wheelpath_crack"):
        if not rows.has(meaning):
            raise InputError(
                f'{file.surveys} has no column {file.column(meaning)!r}; name it in [columns] as {meaning} = "…"'
            )
    age = rows.numbers("age")
    if np.isnan(age).any():
        name = rows.names[int(np.argmax(np.isnan(age)))]
        raise InputError(
            f"{file.surveys}: a survey of section {name!r} has no age; give it in years, or leave it out"
        )
    cracks = {key: _amounts(file, rows, key) for key in ("wheelpath_crack", "alligator")}
    places: dict[str, list[int]] = {name: [] for name in names}
    for k, name in enumerate(rows.names):
        if name in places:
            places[name].append(k)
    empty = next((name for name, at in places.items() if not at), None)
    if empty is not None:
        raise InputError(f"{file.surveys}: section {empty!r} has no survey; add them, or leave the section out")
    surveyed = []
    for at in places.values():
        order = np.array(at)[np.argsort(age[at], kind="stable")]
        surveyed.append(Surveyed(age[order], cracks["wheelpath_crack"][order], cracks["alligator"][order]))
    return surveyed


def _amounts(file: TableFile, rows: _Columns, meaning: str) -> Array:
    """Amounts of a crack at each survey, NaN where it was not recorded. Raises InputError."""
    values = rows.numbers(meaning)
    empty = np.isnan(values)
    if rows.has(meaning) and empty.any() and not file.empty_crack:
        name = rows.names[int(np.argmax(empty))]
        raise InputError(
            f"{file.surveys}: {int(empty.sum())} cells of {file.column(meaning)!r} are empty, of section {name!r} "
            'first: no crack, or not recorded? Say so: empty_crack = "none seen", or "not recorded"'
        )
    if np.any(values < 0):
        raise InputError(f"{file.surveys}: {file.column(meaning)!r} must not be negative, got {np.nanmin(values):g}")
    return np.where(empty, 0.0, values) if rows.has(meaning) and file.empty_crack == "none seen" else values


def _check_ages(file: TableFile, names: Sequence[str], entry: Array, last: Array) -> None:
    """Refuse ages that cannot be. Raises InputError."""
    for k, name in enumerate(names):
        if math.isnan(entry[k]) or math.isnan(last[k]):
            raise InputError(f"{file.sections}: section {name!r} has no age of its surveys; add it, or leave it out")
        if entry[k] <= 0:
            raise InputError(
                f"{file.sections}: section {name!r} was surveyed at {entry[k]:g} years, before it was built; correct "
                "the date of construction, or leave the section out"
            )
        if last[k] < entry[k] or last[k] > _OLDEST:
            raise InputError(
                f"{file.sections}: the last survey of section {name!r} is at {last[k]:g} years, not between the "
                f"first at {entry[k]:g} and {_OLDEST:g}; give ages in years since construction"
            )


def _check_thickness(file: TableFile, thickness: Array) -> None:
    """Ask for the unit where the numbers look like another. Raises InputError."""
    if np.isnan(thickness).all():
        return
    median = float(np.nanmedian(thickness))
    if _THINNEST <= median <= _THICKEST:
        return
    unit = file.units.get("thickness", "mm")
    written = median / UNITS["thickness"][unit]
    likely = [name for name, size in UNITS["thickness"].items() if _THINNEST <= written * size <= _THICKEST]
    question = " or ".join(f'thickness = "{name}"' for name in likely) or "thickness in metres"
    raise InputError(
        f"{file.sections}: half of the sections have less than {written:g} {unit} of asphalt, where roads have "
        f"{1e3 * _THINNEST:g} to {1e3 * _THICKEST:g} mm; is it another unit? Say so in [units]: {question}"
    )


def table_in_words(table: SectionTable) -> str:
    """A table in a line."""
    return f"{table.title or 'road sections'}; {len(table)} sections"


field_tables: Mapping[str, SectionTable] = Catalogue(
    "field table",
    (SectionTable,),
    folder="field_tables",
    read=_read_file,
    words=table_in_words,
    group="treadload.field_tables",
    use='`treadload field LTPP`, `tl.life.field_bench("LTPP")`',
)
"""Tables of road sections by name."""
