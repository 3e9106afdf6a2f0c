"""The road of a case in a report: its layers as a table."""

from __future__ import annotations

from dataclasses import dataclass

from treadload.plots.kit.style import measure
from treadload.reporting.reading import LayerTable, ReportCase
from treadload.reporting.tables import MISSING


@dataclass(frozen=True)
class RoadTable:
    """Layers of a road as text. heading: case and speed, those that need saying. rows: a tuple of cells a layer."""

    heading: str
    rows: tuple[tuple[str, ...], ...]
    viscoelastic: bool


COLUMNS = (
    "layer",
    "thickness, mm",
    "modulus E, MPa",
    "Poisson's ratio",
    "temperature, °C",
    "bond to the layer below",
)


def road_tables(cases: list[ReportCase]) -> list[RoadTable]:
    """A table for each case whose road is known."""
    return [_table(case, case.layers, named=len(cases) > 1) for case in cases if case.layers]


def _table(case: ReportCase, layers: list[LayerTable], *, named: bool) -> RoadTable:
    speed = "" if case.speed is None else f"wheels at {measure(case.speed * 3.6)} km/h"
    season = str(case.attrs.get("season", ""))
    warm = f"in the season that does most of the governing damage, {season}" if season else ""
    words = ": ".join(part for part in (case.label if named else "", speed, warm) if part)
    words = words[:1].upper() + words[1:]
    rows = tuple(_row(number, layer) for number, layer in enumerate(layers, start=1))
    return RoadTable(words, rows, any(layer.get("frequency") for layer in layers))


def _row(number: int, layer: LayerTable) -> tuple[str, ...]:
    thickness, temperature = layer.get("thickness"), layer.get("temperature")
    modulus, poisson = f"{layer['modulus'] / 1e6:.4g}", f"{layer['poisson']:g}"
    if layer.get("anisotropic") and layer.get("material"):
        # The words tell all of its moduli and ratios.
        modulus, poisson = str(layer["material"]), MISSING
    return (
        layer.get("name") or f"layer {number}",
        "semi-infinite" if thickness is None else f"{thickness * 1e3:g}",
        modulus + (f" (|E*| at {layer['frequency']:g} Hz)" if layer.get("frequency") else ""),
        poisson,
        MISSING if temperature is None else f"{temperature:g}",
        layer.get("bond") or MISSING,
    )
