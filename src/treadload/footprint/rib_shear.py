"""Shear of a computed contact beside that of a footprint, rib by rib: variables and rows of a comparison."""

from __future__ import annotations

from typing import Any

import numpy as np

from treadload.deferred import xarray as xr
from treadload.footprint.footprint import Footprint, edges_of
from treadload.footprint.measures import turn
from treadload.footprint.thirds import RibForces, largest, on_cells, on_pins, on_sensels, rib_faces
from treadload.kernels.arrays import Array
from treadload.kernels.gridding.overlap import STRAIGHT
from treadload.response import GridLoad
from treadload.rows import Row, row

_FORCES = ("third_load", "third_force_x", "third_force_y")
_LARGEST = ("rib_largest_pressure", "rib_largest_traction_x", "rib_largest_traction_y")
_ROWS = {
    "lateral_by_thirds": "lateral shear by thirds of ribs, over the pressure of the rib",
    "longitudinal_by_thirds": "longitudinal shear, the same",
    "rib_outward_shear": "shear outward from the middle of ribs, the same",
    "largest_readings": "largest p : q_y : q_x of the sensor",
}
_WORDS = {"computed": "computed", "seen": "through sensor", "measured": "measured"}


def shear_by_ribs(
    load: GridLoad, sensor: Footprint, by_sensor: Array, edges: Array, angle: float
) -> dict[str, tuple[tuple[str, ...], Array]]:
    """Variables over (map, rib, third) and (map, rib): none where neither the contact nor the footprint has shear.

    load: as computed. sensor: as it was laid. by_sensor: (3, ny, nx), Pa, what it reads of the load. edges: (ribs +
    1,) between ribs, m. angle: of the sensor's axes from travel, rad.
    """
    if not (sensor.has_shear or load.array[1:].any()):
        return {}
    faces = rib_faces(np.maximum(load.array[0], 0.0), load.grid.y, load.grid.dy, edges)
    pressure, along, across = sensor.load.array
    measured = np.array([np.maximum(pressure, 0.0), *turn(along, across, angle)])
    if not sensor.has_shear:
        measured[1:] = np.nan
    computed = on_cells(load.array, edges_of(load.grid)[1], load.grid.dx, faces)
    forces = [computed, *(_forces(part, sensor, faces, angle) for part in (by_sensor, measured))]
    values = np.array([part.values for part in forces])
    most = np.array([largest(part, sensor.sensels, sensor.grid.y, faces) for part in (by_sensor, measured)])
    # The largest of cells depends on the cells.
    most = np.concatenate([np.full((1, *most.shape[1:]), np.nan), most])
    fields: dict[str, tuple[tuple[str, ...], Any]] = {
        name: (("map", "rib", "third"), values[:, number]) for number, name in enumerate(_FORCES)
    }
    fields |= {name: (("map", "rib"), most[:, number]) for number, name in enumerate(_LARGEST)}
    return fields | {"rib_outward_shear": (("map", "rib"), np.array([part.outward for part in forces]))}


def _forces(stress: Array, sensor: Footprint, faces: Array, angle: float) -> RibForces:
    grid, there = sensor.grid, sensor.sensels
    if sensor.pin is not None:
        return on_pins(stress, there, grid.y, grid.dx, faces)
    working = np.where(there, stress, 0.0)
    if abs(angle) < STRAIGHT:
        return on_cells(working, edges_of(grid)[1], grid.dx, faces)
    _, across = turn(*np.meshgrid(grid.x, grid.y), angle)
    return on_sensels(working, across, grid.cell_area, faces)


def shear_rows(data: xr.Dataset) -> list[Row]:
    """Rows of a comparison: lateral and longitudinal shear of the thirds of each rib, and the largest readings."""
    if "third_load" not in data:
        return []
    texts: dict[str, dict[str, str]] = {name: {} for name in _ROWS}
    for name, words in _WORDS.items():
        at = data.sel(map=name)
        forces = RibForces(np.array([at[of].to_numpy() for of in _FORCES]))
        if np.isnan(forces.values[1:]).all():
            continue
        along, across = forces.relative
        texts["lateral_by_thirds"][words] = _by_ribs(across)
        texts["longitudinal_by_thirds"][words] = _by_ribs(along)
        texts["rib_outward_shear"][words] = _line(at["rib_outward_shear"].to_numpy())
        most = np.array([at[of].to_numpy() for of in _LARGEST])
        if np.isfinite(most).any():
            texts["largest_readings"][words] = _ratio(most)
    return [
        row(name, text, label=words, group=_ROWS[name])
        for name, lines in texts.items()
        for words, text in lines.items()
    ]


def _by_ribs(values: Array) -> str:
    """Thirds of a rib from left to right, ribs apart by bars."""
    return " | ".join(_line(rib) for rib in values)


def _line(values: Array) -> str:
    return " ".join("–" if np.isnan(value) else f"{value:+z.2f}" for value in values)


def _ratio(most: Array) -> str:
    """Largest pressure to lateral to longitudinal shear, the first as 10."""
    pressure, along, across = np.nanmax(most, axis=1)
    return f"10 : {10 * across / pressure:.1f} : {10 * along / pressure:.1f}, of {pressure / 1e3:.0f} kPa"
