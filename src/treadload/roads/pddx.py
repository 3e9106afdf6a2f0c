"""Basins from the Pavement Deflection Data Exchange format of AASHTO, version 1.0: sections of keys and values.

Known of it is what writers of the format put in: sections in brackets, `key = value` lines, units in words, one
section for each test location, and a line for each drop: its load, then the deflections in the order of the sensors.
Time histories beside the peaks are skipped. The text of the standard itself was not available.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np

from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.roads.basins import Basins

TITLE = "Pavement Deflection Data Exchange"
_DROP = re.compile(r"dropdata_?\s*([0-9]*)")
_LENGTHS = {
    "millimeter": 1e-3, "millimetre": 1e-3, "centimeter": 1e-2, "meter": 1.0, "metre": 1.0, "kilometer": 1e3,
    "inch": 0.0254, "inches": 0.0254, "foot": 0.3048, "feet": 0.3048, "mile": 1609.344, "micron": 1e-6,
    "micrometer": 1e-6,
    "mil": 25.4e-6, "mils": 25.4e-6,
}  # fmt: skip
_FORCES = {
    "kilo-newton": 1e3, "kilonewton": 1e3, "newton": 1.0, "pound": 4.4482216152605, "pound-force": 4.4482216152605,
    "pounds": 4.4482216152605, "kip": 4448.2216152605,
}  # fmt: skip
_SECTIONS = tuple[str, dict[str, str]]


def read_pddx(path: Path, text: str) -> Basins:
    """Basins of a file in this format. text: its content. Raises InputError."""
    sections = _sections(text)
    head = {key: value for _, values in sections[:1] for key, value in values.items()}
    delimiter, mark = head.get("delimitersymbol", ",") or ",", head.get("decimalsymbol", ".") or "."
    everything: dict[str, str] = {}
    for name, values in sections:
        if not name.startswith("test location"):
            everything |= values

    def numbers(value: str) -> list[float]:
        cells = [cell.strip().replace(mark, ".") for cell in value.split(delimiter)]
        try:
            return [float(cell) for cell in cells if cell]
        except ValueError as error:
            raise InputError(f"{path}: {value!r} must be numbers with {delimiter!r} between them") from error

    def of(key: str) -> str:
        if key.lower() not in everything:
            raise InputError(f"{path} is a PDDX file without {key}; write it, or export the drops as CSV")
        return everything[key.lower()]

    def scale(key: str, units: dict[str, float]) -> float:
        word = of(key).split(delimiter)[0].strip().lower()
        singular = word if word in units else word.removesuffix("s")
        if singular not in units:
            raise InputError(f"{path}: {key} is {word!r}, which is not known; known are {', '.join(units)}")
        return units[singular]

    length = scale("SensorLocationUnits", _LENGTHS)
    radius = numbers(of("LoadPlateRadius"))[0] * scale("LoadPlateRadiusUnits", _LENGTHS)
    offsets = np.array(numbers(of("DeflectionSensorXAxisDistances"))) * length
    count = int(numbers(of("NumberOfDeflectionSensors"))[0])
    if len(offsets) == count + 1 and offsets[0] == offsets[1]:
        # Some writers list the load cell, at the axis, before the sensors.
        offsets = offsets[1:]
    if len(offsets) != count:
        raise InputError(f"{path}: {len(offsets)} distances for {count} deflection sensors")
    force, deflection = scale("LoadUnits", _FORCES), scale("DeflectionUnits", _LENGTHS)
    along = scale("TestLocationUnits", _LENGTHS) if "testlocationunits" in everything else 1.0
    rows: list[Array] = []
    loads: list[float] = []
    stations: list[str] = []
    places: list[float] = []
    warmth: list[float] = []
    for name, values in sections:
        if not name.startswith("test location"):
            continue
        place = numbers(values.get("testlocation", ""))[:1] or [np.nan]
        warm = _temperature(everything, values, numbers)
        for key, value in values.items():
            if _DROP.fullmatch(key):
                drop = numbers(value)
                if len(drop) < count + 1:
                    raise InputError(
                        f"{path}, [{name}], {key}: {len(drop)} values where a load and {count} deflections belong"
                    )
                loads.append(drop[0] * force)
                rows.append(np.array(drop[1 : count + 1]) * deflection)
                stations.append(name.removeprefix("test location").strip())
                places.append(place[0] * along)
                warmth.append(warm)
    if not rows:
        raise InputError(f"{path} is a PDDX file without drops: no [Test Location …] has a line DropData_1")
    # Sensors on the other side of the plate count by their distance.
    distance = np.abs(offsets)
    order = np.argsort(distance, kind="stable")
    twice = np.flatnonzero(np.diff(distance[order]) == 0)
    if len(twice):
        raise InputError(
            f"{path}: two sensors lie {distance[order][twice[0]] * 1e3:g} mm from the plate; leave one out"
        )
    return Basins(
        np.array(rows)[:, order], distance[order], np.array(loads), radius, station=tuple(stations),
        position=np.array(places), temperature=np.array(warmth), source=path.name,
    )  # fmt: skip


def _temperature(everything: dict[str, str], values: dict[str, str], numbers: Callable[[str], list[float]]) -> float:
    """Of the asphalt, °C: that called pavement, asphalt or manual, else the surface's; NaN where there is none."""
    uses = [use.strip().lower() for use in everything.get("temperaturesensoruse", "").split(",")]
    values_of_sensors = numbers(values["testtemperatures"]) if values.get("testtemperatures") else []
    for wanted in ("pavement", "asphalt", "manual", "surface"):
        for use, value in zip(uses, values_of_sensors, strict=False):
            if wanted in use:
                fahrenheit = everything.get("temperatureunits", "celsius").strip().lower().startswith("f")
                return (value - 32) / 1.8 if fahrenheit else value
    return float("nan")


def _sections(text: str) -> list[_SECTIONS]:
    sections: list[_SECTIONS] = []
    for line in text.splitlines():
        bare = line.strip()
        if bare.startswith("[") and bare.endswith("]"):
            sections.append((bare[1:-1].strip().lower(), {}))
        elif "=" in bare and sections:
            key, _, value = bare.partition("=")
            sections[-1][1][key.strip().lower()] = value.strip()
    return sections
