"""Basins from files F25 of Dynatest: lines that begin with a code, and lines of drops.

Known of it is what another writer of the format puts in, no description of the maker's: 5020 holds the plate's radius
and the offsets, mm; 5301 begins a point, with its chainage in the sixth value; 5303 its temperatures, of the asphalt,
the surface and the air; a line of a drop has its number, the pressure below the plate, kPa, and the deflections, µm.
Points in other units, histories and F20 or older files were not documented and are refused or skipped.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.roads.basins import Basins

FIRST = "5001,"
_MISSING = ("N0", "")


def read_f25(path: Path, text: str) -> Basins:
    """Basins of a file in this format. text: its content. Raises InputError."""
    radius, offsets = 0.0, np.zeros(0)
    chainage, warm = math.nan, math.nan
    rows: list[Array] = []
    loads: list[float] = []
    stations: list[str] = []
    places: list[float] = []
    warmth: list[float] = []
    for number, line in enumerate(text.splitlines(), start=1):
        cells = [cell.strip().strip('"').strip() for cell in line.split(",")]
        code = cells[0]
        if code == "5020":
            radius, *distances = [_number(path, number, cell) for cell in cells[1:] if cell not in _MISSING]
            radius, offsets = radius * 1e-3, np.array(distances) * 1e-3
            # Rows of sensors end with zeros where none is mounted.
            used = 1 + int(np.max(np.flatnonzero(offsets), initial=0))
            offsets = offsets[:used]
        elif code == "5301":
            chainage, warm = (_number(path, number, cells[5]) if len(cells) > 5 else math.nan), math.nan
        elif code == "5303":
            warm = next((_number(path, number, cell) for cell in cells[2:4] if cell not in _MISSING), math.nan)
        elif code.isdigit() and len(code) < 4:
            if not len(offsets):
                raise InputError(f"{path}, line {number}: a drop before the line 5020 of plate and sensors")
            values = [_number(path, number, cell) for cell in cells[1:] if cell not in _MISSING]
            if len(values) < len(offsets) + 1:
                raise InputError(
                    f"{path}, line {number}: {len(values)} values where a pressure and {len(offsets)} deflections "
                    "belong"
                )
            loads.append(values[0] * 1e3 * math.pi * radius**2)
            rows.append(np.array(values[1 : len(offsets) + 1]) * 1e-6)
            stations.append(f"{chainage:g}" if math.isfinite(chainage) else str(len(stations) + 1))
            places.append(chainage)
            warmth.append(warm)
    if not rows:
        raise InputError(f"{path} reads like a file F25 and has no drops: lines of a number, a pressure, deflections")
    order = np.argsort(offsets, kind="stable")
    return Basins(
        np.array(rows)[:, order], offsets[order], np.array(loads), radius, station=tuple(stations),
        position=np.array(places), temperature=np.array(warmth), source=path.name,
    )  # fmt: skip


def _number(path: Path, line: int, cell: str) -> float:
    try:
        return float(cell)
    except ValueError as error:
        raise InputError(f"{path}, line {line}: {cell!r} is not a number") from error
