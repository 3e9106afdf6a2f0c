"""Basins from a table of text: which column is what, in which unit."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from treadload.errors import InputError, nearest
from treadload.kernels.arrays import Array
from treadload.roads.basins import Basins, PlateKind
from treadload.tables import Table, read_table
from treadload.units import Length, quantity

_HEADING = re.compile(r"(?P<name>.*?)\s*[\[(](?P<unit>[^\])]*)[\])]\s*")
_DEFLECTION = re.compile(r"[Dd]_?(?P<offset>[0-9]+)(?:_(?P<unit>[A-Za-zµμ]+))?")
_THICKNESS = re.compile(r"(?:thickness|h)[ _](?P<layer>.+)")
_SUFFIX = re.compile(r".*_(?P<unit>kN|N|lbf|mm|cm|m|um|µm|mil|in|C|degC)")
_SPELT = {
    "um": "µm",
    "C": "degC",
    "°C": "degC",
    "lb": "lbf",
    "mil": "0.0254 mm",
    "mils": "0.0254 mm",
    "micron": "µm",
    "in": "inch",
}
_USUAL = {"N": "kN", "m": "mm", "m/s": "km/h", "s": "ms", "": "µm/m"}
_FAHRENHEIT = ("°F", "F", "degF")


@dataclass(frozen=True)
class BasinLayout:
    """Which columns of a table hold what; those that are left out are found by their names.

    deflections: columns of the sensors; left out, all that are named D and the offset in mm, "D0 [µm]", "D300 [µm]".
    offsets: of the sensors from the plate's axis; left out, from these names. load: column of the peak load.
    plate_radius: of the plate. plate: "uniform", "rigid" or "segmented". station, section: columns of labels.
    position: column of the place along the road. temperature: column of the asphalt's. thickness: layer → column;
    left out, all that are named "thickness" and the layer, "thickness base [mm]". units: column → unit, for columns
    that name none in brackets or at their end, "load [kN]" or "load_kN". decimal: "." or ",", where the table alone
    does not show it.

    >>> from pathlib import Path
    >>> _ = Path("drops.csv").write_text('''force,centre,near,far
    ... 50,400,300,120''')
    >>> sensors, units = ("centre", "near", "far"), {"force": "kN", "centre": "um", "near": "um", "far": "um"}
    >>> layout = tl.roads.BasinLayout(sensors, (0.0, 0.3, 0.9), "force", units=units)
    >>> basins = tl.roads.read_basins("drops.csv", layout)
    >>> [f"{deflection * 1e6:.0f} µm" for deflection in basins.deflection[0]]
    ['400 µm', '300 µm', '120 µm']
    """

    deflections: tuple[str, ...] = ()
    offsets: tuple[Length, ...] = ()
    load: str = "load"
    plate_radius: Length = 0.15
    plate: PlateKind = "uniform"
    station: str = ""
    section: str = ""
    position: str = ""
    temperature: str = ""
    thickness: dict[str, str] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)
    decimal: str | None = None


def read_csv(path: str | os.PathLike[str], layout: BasinLayout | None = None) -> Basins:
    """Basins of a table of text, a row for every drop. layout: which column is what. Raises InputError."""
    how = layout or BasinLayout()
    table = read_table(path, decimal=how.decimal)
    if not table.has_header or len(table.rows) < 2:
        raise InputError(
            f"{path} needs a line of headings, such as station, load [kN], D0 [µm], D300 [µm], and drops"
        )
    columns = TableColumns(table, how.units)
    deflections = [columns.find(name, "deflections") for name in how.deflections] or columns.deflections()
    if not deflections:
        raise InputError(
            f"{path} has no column of a deflection, named D and its offset in mm, D0 or D300; name them in the "
            "layout: "
            'deflections = ["…"], offsets = ["0 mm", …]'
        )
    offsets = _offsets(path, columns, deflections, how.offsets)
    order = np.argsort(offsets, kind="stable")
    thickness = {layer: columns.find(name, "thickness") for layer, name in how.thickness.items()}
    thickness = thickness or columns.thickness()
    measured = np.stack([columns.values(place, "m") for place in deflections], axis=1)
    temperature = columns.optional(how.temperature, "temperature")
    position = columns.optional(how.position, "position")
    station = columns.optional(how.station, "station")
    section = columns.optional(how.section, "section")
    return Basins(
        deflection=measured[:, order],
        offsets=np.array(offsets)[order],
        load=columns.values(columns.find(how.load, "load"), "N"),
        plate_radius=how.plate_radius,
        plate=how.plate,
        station=() if station is None else columns.texts(station),
        section=() if section is None else columns.texts(section),
        position=None if position is None else columns.values(position, "m"),
        temperature=None if temperature is None else columns.values(temperature, "degC"),
        thickness={layer: columns.values(place, "m") for layer, place in thickness.items()},
        source=Path(path).name,
    )


class TableColumns:
    """Columns of a table by their headings, with or without the unit in brackets."""

    def __init__(self, table: Table, units: Mapping[str, str]) -> None:
        """units: column → unit, of those that name none."""
        self._table, self._units = table, units
        self.headings = [heading.strip() for heading in table.rows[0]]
        bare = [match["name"] if (match := _HEADING.fullmatch(heading)) else heading for heading in self.headings]
        self._places: dict[str, int] = {}
        for place, names in enumerate(zip(bare, self.headings, strict=True)):
            for name in names:
                if self._places.get(name, place) != place:
                    raise InputError(f"{table.path}, line {table.lines[0]}: the column {name!r} occurs twice")
                self._places[name] = place
        self._bare = bare
        stray = next((name for name in units if name not in self._places), None)
        if stray is not None:
            raise InputError(f"{table.path}: units names {stray!r}; {nearest(stray, bare, 'its columns are')}")

    def find(self, name: str, what: str) -> int:
        """Place of a column that must be there."""
        if name not in self._places:
            near = nearest(name, self._bare, "its columns are")
            raise InputError(f"{self._table.path} has no column {name!r} ({what}); {near}")
        return self._places[name]

    def optional(self, name: str, usual: str) -> int | None:
        """Place of a column that is asked for, or is there by its usual name."""
        return self.find(name, usual) if name else self._places.get(usual)

    def deflections(self) -> list[int]:
        """Places of the deflections."""
        return [place for place, name in enumerate(self._bare) if _DEFLECTION.fullmatch(name)]

    def named(self, pattern: re.Pattern[str]) -> list[tuple[int, re.Match[str]]]:
        """Places of the columns whose names match."""
        matches = [(place, pattern.fullmatch(name)) for place, name in enumerate(self._bare)]
        return [(place, match) for place, match in matches if match]

    def thickness(self) -> dict[str, int]:
        """Layer → place of its thickness."""
        layers = {place: _THICKNESS.fullmatch(name) for place, name in enumerate(self._bare)}
        return {match["layer"]: place for place, match in layers.items() if match}

    def offset(self, place: int) -> float | None:
        """Of a sensor, m, from its name; None where the name does not contain it."""
        match = _DEFLECTION.fullmatch(self._bare[place])
        return None if match is None else 1e-3 * float(match["offset"])

    def texts(self, place: int) -> tuple[str, ...]:
        """Cells of a column."""
        return tuple(row[place] for row in self._table.rows[1:])

    def values(self, place: int, si: str) -> Array:
        """Numbers of a column in the SI unit."""
        values, _ = self._table.values([place], first=1, name=lambda column: self.headings[place])
        unit = self._unit(place, si)
        if si == "degC":
            return values[:, 0] if unit not in _FAHRENHEIT else (values[:, 0] - 32) / 1.8
        return values[:, 0] * _factor(unit, si, f"{self._table.path}: {self.headings[place]}")

    def _unit(self, place: int, si: str) -> str:
        heading, bare = self.headings[place], self._bare[place]
        match, suffix = _HEADING.fullmatch(heading), _SUFFIX.fullmatch(bare)
        named = match["unit"] if match else suffix["unit"] if suffix else None
        stated = self._units.get(bare, self._units.get(heading))
        if stated is not None and named is not None and _spelt(stated) != _spelt(named):
            raise InputError(
                f"{self._table.path}: {heading!r} names a unit of its own, and units has {stated!r}; leave one out"
            )
        unit = stated or named
        if unit is None:
            if si == "degC":
                return "degC"
            usual = _USUAL[si]
            raise InputError(
                f"{self._table.path}: {heading!r} names no unit; write {bare} [{usual}], or "
                f'give units = {{ "{bare}" = "{usual}" }} in the layout'
            )
        return unit


def _spelt(unit: str) -> str:
    return _SPELT.get(unit.strip(), unit.strip().replace("μ", "µ"))


def _factor(unit: str, si: str, where: str) -> float:
    try:
        spelt = _spelt(unit)
        return quantity(spelt if spelt[0].isdigit() else f"1 {spelt}", si)
    except (InputError, IndexError) as error:
        raise InputError(f"{where} is in {unit!r}, which is no unit like {_USUAL[si]}") from error


def _offsets(
    path: str | os.PathLike[str], columns: TableColumns, deflections: Sequence[int], stated: Sequence[float]
) -> list[float]:
    if stated:
        if len(stated) != len(deflections):
            raise InputError(
                f"{path}: the layout has {len(stated)} offsets for {len(deflections)} columns of deflections; give "
                "one "
                "for each"
            )
        return [float(offset) for offset in stated]
    named = [columns.offset(place) for place in deflections]
    missing = next((place for place, offset in zip(deflections, named, strict=True) if offset is None), None)
    if missing is not None:
        raise InputError(
            f"{path}: {columns.headings[missing]!r} does not give its offset, as D300 does; give offsets in a layout"
        )
    return [offset for offset in named if offset is not None]
