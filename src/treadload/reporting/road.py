"""The road of a case in a report: its layers as a table."""

from __future__ import annotations

from dataclasses import dataclass

from treadload.plots.kit.style import measure
from treadload.reporting.reading import LayerTable, ReportCase
from treadload.reporting.tables import MISSING
from treadload.rows import Row


@dataclass(frozen=True)
class RoadTable:
    """Layers of a road as text. heading: case and speed, where they are needed. rows: a tuple of cells a layer."""

    heading: str
    rows: tuple[tuple[str, ...], ...]
    viscoelastic: bool


# Unit of display and digits of the numbers of a layer.
_NUMBERS = {"thickness": ("mm", "g"), "modulus": ("MPa", ".4g"), "temperature": ("°C", "g")}


def road_columns() -> tuple[str, ...]:
    """Heads of the table of layers, with units."""
    thickness, modulus, temperature = (_shown(kind, 0.0).shown_unit for kind in _NUMBERS)
    return (
        "layer",
        f"thickness, {thickness}",
        f"modulus E, {modulus}",
        "Poisson's ratio",
        f"temperature, {temperature}",
        "bond to the layer below",
    )


def _shown(kind: str, value: float) -> Row:
    """A number of a layer, SI, as it is shown. kind: of it."""
    unit, form = _NUMBERS[kind]
    return Row(kind, kind, value, unit, form)


def road_tables(cases: list[ReportCase]) -> list[RoadTable]:
    """A table for each case whose road is known."""
    return [_table(case, case.layers, named=len(cases) > 1) for case in cases if case.layers]


def _table(case: ReportCase, layers: list[LayerTable], *, named: bool) -> RoadTable:
    speed = "" if case.speed is None else f"wheels at {_speed(case.speed).text}"
    season = str(case.attrs.get("season", ""))
    warm = f"in the season that does most of the governing damage, {season}" if season else ""
    words = ": ".join(part for part in (case.label if named else "", speed, warm) if part)
    words = words[:1].upper() + words[1:]
    rows = tuple(_row(number, layer) for number, layer in enumerate(layers, start=1))
    return RoadTable(words, rows, any(layer.get("frequency") for layer in layers))


def _speed(speed: float) -> Row:
    return Row("speed", "speed", speed, form=lambda value: f"{measure(value * 3.6)} km/h")


def _row(number: int, layer: LayerTable) -> tuple[str, ...]:
    thickness, temperature = layer.get("thickness"), layer.get("temperature")
    modulus, poisson = _shown("modulus", layer["modulus"]).number, f"{layer['poisson']:g}"
    if layer.get("anisotropic") and layer.get("material"):
        # The words tell all of its moduli and ratios.
        modulus, poisson = str(layer["material"]), MISSING
    return (
        layer.get("name") or f"layer {number}",
        "semi-infinite" if thickness is None else _shown("thickness", thickness).number,
        modulus + (f" (|E*| at {layer['frequency']:g} Hz)" if layer.get("frequency") else ""),
        poisson,
        MISSING if temperature is None else _shown("temperature", temperature).number,
        layer.get("bond") or MISSING,
    )
