"""Moving basins from a table of text: which column is what, in which unit, and which wheels rolled."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np

from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.roads.layout import TableColumns
from treadload.roads.moving_basins import DualWheels, MovingBasins
from treadload.tables import read_table
from treadload.units import Force, Length

_READING = re.compile(r"(?P<kind>[SV])_?(?P<offset>-?[0-9]+)")
_SI = {"slope": "", "velocity": "m/s"}


@dataclass(frozen=True)
class MovingLayout:
    """Which columns of a table of moving basins hold what; those that are left out are found by their names.

    wheel_spacing: between the middles of the dual tires. wheel_width, wheel_length: of the contact of each. measures:
    "slope", or "velocity" of the surface, down. readings: columns of the sensors; left out, all that are named S (V
    of velocities) and the offset ahead of the wheels' middle in mm, "S300 [µm/m]", "V300 [mm/s]", "S-200 [µm/m]"
    behind. offsets: of the sensors; left out, from these names. load: column of the load on the dual wheels.
    load_of_all: that load, where the table has no column. speed: column. side: of the sensors' line to the right of
    the wheels' middle. upwards: True where readings are positive where the surface rises. station, section, position,
    temperature, thickness, units, decimal: as in `BasinLayout`.

    >>> from pathlib import Path
    >>> _ = Path("slopes.csv").write_text('''load [kN],speed [km/h],S100 [um/m],S300 [um/m]
    ... 50,80,400,300''')
    >>> layout = tl.roads.MovingLayout(wheel_spacing=0.35, wheel_width=0.22, wheel_length=0.2)
    >>> basins = tl.roads.read_basins("slopes.csv", layout)
    >>> [f"{slope * 1e6:.0f} µm/m" for slope in basins.slope[0]]
    ['400 µm/m', '300 µm/m']
    """

    wheel_spacing: Length
    wheel_width: Length
    wheel_length: Length
    measures: Literal["slope", "velocity"] = "slope"
    readings: tuple[str, ...] = ()
    offsets: tuple[Length, ...] = ()
    load: str = "load"
    load_of_all: Force | None = None
    speed: str = "speed"
    side: Length = 0.0
    upwards: bool = False
    station: str = ""
    section: str = ""
    position: str = ""
    temperature: str = ""
    thickness: dict[str, str] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)
    decimal: str | None = None


def read_moving_csv(path: str | os.PathLike[str], layout: MovingLayout) -> MovingBasins:
    """Moving basins of a table of text, a row for every place. layout: which column is what. Raises InputError."""
    table = read_table(path, decimal=layout.decimal)
    if not table.has_header or len(table.rows) < 2:
        raise InputError(f"{path} needs a line of headings, such as station, speed [km/h], S300 [µm/m], and places")
    if layout.measures not in _SI:
        raise InputError(f'measures must be "slope" or "velocity", got {layout.measures!r}')
    columns = TableColumns(table, layout.units)
    places, offsets = _sensors(path, columns, layout)
    order = np.argsort(offsets, kind="stable")
    measured = np.stack([columns.values(places[k], _SI[layout.measures]) for k in order], axis=1)
    measured = -measured if layout.upwards else measured
    speed = columns.values(columns.find(layout.speed, "speed"), "m/s")
    if layout.measures == "velocity":
        with np.errstate(divide="ignore", invalid="ignore"):
            measured = np.where(speed[:, None] > 0, measured / speed[:, None], np.nan)
    thickness = {layer: columns.find(name, "thickness") for layer, name in layout.thickness.items()}
    labels = {key: columns.optional(getattr(layout, key), key) for key in ("station", "section")}
    position, warmth = (
        columns.optional(layout.position, "position"),
        columns.optional(layout.temperature, "temperature"),
    )
    return MovingBasins(
        slope=measured,
        offsets=np.array(offsets)[order],
        load=_load(columns, layout, len(speed)),
        speed=speed,
        wheels=DualWheels(layout.wheel_spacing, layout.wheel_width, layout.wheel_length),
        side=layout.side,
        station=() if labels["station"] is None else columns.texts(labels["station"]),
        section=() if labels["section"] is None else columns.texts(labels["section"]),
        position=None if position is None else columns.values(position, "m"),
        temperature=None if warmth is None else columns.values(warmth, "degC"),
        thickness={layer: columns.values(place, "m") for layer, place in (thickness or columns.thickness()).items()},
        source=Path(path).name,
    )


def _load(columns: TableColumns, layout: MovingLayout, count: int) -> Array:
    if layout.load_of_all is not None:
        return np.full(count, float(layout.load_of_all))
    return columns.values(columns.find(layout.load, "load; or give load_of_all"), "N")


def _sensors(
    path: str | os.PathLike[str], columns: TableColumns, layout: MovingLayout
) -> tuple[list[int], list[float]]:
    """Places and offsets, m, of the columns of the sensors."""
    if layout.readings:
        places = [columns.find(name, "readings") for name in layout.readings]
        if len(layout.offsets) != len(places):
            raise InputError(
                f"{path}: the layout has {len(layout.offsets)} offsets for {len(places)} columns of readings; give "
                "one "
                "for each"
            )
        return places, [float(offset) for offset in layout.offsets]
    letter = "S" if layout.measures == "slope" else "V"
    matches = [(place, match) for place, match in columns.named(_READING) if match["kind"] == letter]
    if not matches:
        raise InputError(
            f"{path} has no column of a {layout.measures}, named {letter} and its offset in mm, {letter}300; name "
            "them "
            'in the layout: readings = ["…"], offsets = ["300 mm", …]'
        )
    return [place for place, _ in matches], [1e-3 * float(match["offset"]) for _, match in matches]
