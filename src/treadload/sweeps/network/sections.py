"""A table of road sections: what identifies them, where they lie, how old they are, and which keys differ."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from treadload.case import Case
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.sweeps.design import ROW, Design
from treadload.sweeps.vary import from_file, headings
from treadload.units import quantity

POSITION, STATION, AGE, LENGTH = "position", "station", "age", "length"
"""Columns of a table of sections beside its ids and the keys of the case."""
_YEARS = ("", "year", "years", "yr", "a")
# A road older than this is a mistake: a year of opening in place of an age.
_OLDEST = 200.0


@dataclass(frozen=True, eq=False)
class Sections:
    """Sections of a network.

    design: a case for each, its faults with the reasons. names: of the sections, all different. position: along the
    road, m, NaN where the table has none. age: years since the opening, 0 where the table has none. length: m, NaN
    where the table has none.

    >>> axle = {"name": "cart", "share": 1, "axle_load": "1 kN", "inflation_pressure": "8 bar"}
    >>> profile = {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}
    >>> mix, earth = ({"kind": "elastic", "modulus": modulus, "poisson": 0.35} for modulus in ("5 GPa", "60 MPa"))
    >>> top, soil = {"name": "asphalt", "thickness": "3 cm", "material": mix}, {"name": "soil", "material": earth}
    >>> case = {"tire": {"profile": profile}, "pavement": {"layers": [top, soil]}, "spacing": "1 cm"}
    >>> case |= {"traffic": {"passes_per_year": 1e7, "classes": [axle]}, "climate": {"temperature": 15}}
    >>> line = {"law": "fatigue-line", "epsilon_6": "120 microstrain", "slope": -0.2}
    >>> case["criteria"] = [{"name": "base", "layer": "asphalt", "place": "bottom"} | line]
    >>> from pathlib import Path
    >>> _ = Path("network.csv").write_text('''section;age [years];thickness asphalt [mm]
    ... A;8;40
    ... B;1;30''')
    >>> sections = tl.sweeps.read_sections(tl.Case.from_dict(case), "network.csv")
    >>> sections.design.at(1)
    {'pavement.layers.0.thickness': 0.03}
    """

    design: Design
    names: tuple[str, ...]
    position: Array
    age: Array
    length: Array = field(default_factory=lambda: np.zeros(0))

    def __post_init__(self) -> None:
        if not len(self.length):
            object.__setattr__(self, "length", np.full(self.design.count, math.nan))

    @property
    def has_age(self) -> bool:
        """True if the table states ages."""
        return AGE in {name.casefold() for name in self.design.labels}


def read_sections(case: Case, path: str | os.PathLike[str], *, ids: Sequence[str] = ()) -> Sections:
    """The sections in a CSV file or an Excel sheet, a row each.

    Headings are ids, keys of the case, and four of a network: `station`, an id, or with a unit of length, "station
    [km]", a place along the road; `position [m]`, that place; `age [years]`, since the opening; `length [m]`. ids: as
    in `sweeps.from_file`. A layer whose thickness is 0 is absent in its section, and so is one below the
    surface all of whose cells are empty. A row that cannot be read fails alone. Raises InputError.

    >>> axle = {"name": "cart", "share": 1, "axle_load": "1 kN", "inflation_pressure": "8 bar"}
    >>> profile = {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}
    >>> mix, earth = ({"kind": "elastic", "modulus": modulus, "poisson": 0.35} for modulus in ("5 GPa", "60 MPa"))
    >>> top, soil = {"name": "asphalt", "thickness": "3 cm", "material": mix}, {"name": "soil", "material": earth}
    >>> case = {"tire": {"profile": profile}, "pavement": {"layers": [top, soil]}, "spacing": "1 cm"}
    >>> case |= {"traffic": {"passes_per_year": 1e7, "classes": [axle]}, "climate": {"temperature": 15}}
    >>> line = {"law": "fatigue-line", "epsilon_6": "120 microstrain", "slope": -0.2}
    >>> case["criteria"] = [{"name": "base", "layer": "asphalt", "place": "bottom"} | line]
    >>> from pathlib import Path
    >>> _ = Path("network.csv").write_text('''section;age [years];thickness asphalt [mm]
    ... A;8;40
    ... B;1;30''')
    >>> sections = tl.sweeps.read_sections(tl.Case.from_dict(case), "network.csv")
    >>> [f"{name}: {age:.0f} years old" for name, age in zip(sections.names, sections.age, strict=True)]
    ['A: 8 years old', 'B: 1 years old']
    """
    units = dict(headings(path))
    by_kind = {name.casefold(): name for name in units if name.casefold() in (POSITION, STATION, AGE, LENGTH)}
    design = from_file(case, path, ids=[*ids, *by_kind.values()], absent_layers=True)
    column = next((by_kind[kind] for kind in (POSITION, STATION) if units.get(by_kind.get(kind, ""))), None)
    if column is None and POSITION in by_kind:
        raise InputError(f"column {by_kind[POSITION]!r} needs its unit in the heading, such as position [km]")
    if LENGTH in by_kind and not units.get(by_kind[LENGTH]):
        raise InputError(f"column {by_kind[LENGTH]!r} needs its unit in the heading, such as length [km]")
    faults = dict(design.faults)
    position: Array = np.full(design.count, math.nan)
    age: Array = np.zeros(design.count)
    length: Array = np.full(design.count, math.nan)
    if column is not None:
        position = _numbers(design, column, units[column], faults)
    if AGE in by_kind:
        age = _ages(design, by_kind[AGE], units.get(by_kind[AGE], ""), faults)
    if LENGTH in by_kind:
        length = _lengths(design, by_kind[LENGTH], units[by_kind[LENGTH]], faults)
    design = replace(design, faults=dict(sorted(faults.items())))
    numeric = {name for name in (column, by_kind.get(AGE), by_kind.get(LENGTH)) if name is not None}
    return Sections(design, _names(design, numeric | {ROW}, column), position, age, length)


def _numbers(design: Design, column: str, unit: str, faults: dict[int, str]) -> Array:
    """Places along the road, m; what cannot be read is NaN, and a fault of its row."""
    values = np.full(design.count, math.nan)
    for number, text in enumerate(design.labels[column]):
        try:
            values[number] = quantity(f"{text} {unit}", "m")
        except InputError as error:
            faults.setdefault(number, f"{column}: {error}" if str(text).strip() else f"no value of {column}")
    return values


def _lengths(design: Design, column: str, unit: str, faults: dict[int, str]) -> Array:
    """Lengths of the sections, m; NaN where the table has none, which is no fault: a life does not depend on it."""
    values = np.full(design.count, math.nan)
    for number, text in enumerate(design.labels[column]):
        if str(text).strip():
            try:
                length = quantity(f"{text} {unit}", "m")
            except InputError as error:
                faults.setdefault(number, f"{column}: {error}")
                continue
            if length > 0:
                values[number] = length
            else:
                faults.setdefault(number, f"{column} must be above 0, got {text} {unit}; leave it empty if unknown")
    return values


def _ages(design: Design, column: str, unit: str, faults: dict[int, str]) -> Array:
    """Ages, years; 0 where they cannot be read, which is a fault of its row."""
    if unit.casefold() not in _YEARS:
        raise InputError(f"column {column!r} is in years, got [{unit}]; give age [years]")
    ages = np.zeros(design.count)
    for number, text in enumerate(design.labels[column]):
        try:
            age = quantity(str(text), "")
        except InputError as error:
            faults.setdefault(number, f"{column}: {error}" if str(text).strip() else f"no value of {column}")
            continue
        if 0 <= age <= _OLDEST:
            ages[number] = age
        else:
            faults.setdefault(
                number,
                f"{column} must lie in [0, {_OLDEST:g}] years since the opening, got {age:g}"
                + ("; give an age in place of a year" if age > _OLDEST else ""),
            )
    return ages


def _names(design: Design, without: set[str], column: str | None) -> tuple[str, ...]:
    """A name for each section of its ids, or of its place; its row where it has none, or where names are alike."""
    ids = [values for name, values in design.labels.items() if name not in without]
    if not ids and column is not None:
        ids = [tuple(f"{column} {text}" for text in design.labels[column])]
    rows = design.labels.get(ROW, tuple(range(1, design.count + 1)))
    texts = [" ".join(str(part) for part in parts if str(part)) for parts in zip(*ids, strict=True)] if ids else []
    texts = texts or [""] * design.count
    return tuple(
        f"row {row}" if not text else f"{text} (row {row})" if texts.count(text) > 1 else text
        for text, row in zip(texts, rows, strict=True)
    )
