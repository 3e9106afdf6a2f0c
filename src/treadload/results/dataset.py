"""Datasets of what no solver made: the height map of a tire, a footprint that was recorded."""

from __future__ import annotations

import xarray as xr

from treadload._version import __version__
from treadload.grid import Grid
from treadload.pavement import Pavement
from treadload.response import GridLoad
from treadload.results.roads import road_in_words
from treadload.tire import Tire
from treadload.variables import dataset


def height_map(tire: Tire, spacing: float) -> xr.Dataset:
    """The tire's initial gap on its whole extent, as `Tire.from_height_map` reads it back from a file.

    spacing: of the cells, m; a tire that is a height map keeps its own.
    """
    grid = tire.fixed_grid or Grid.on_lattice(*tire.extent, spacing)
    gap = {"initial_gap": (("y", "x"), tire.height_map(grid))}
    about = {"tire": str(tire), "treadload_version": __version__}
    return dataset(gap, {"x": grid.x, "y": grid.y}, dx=grid.dx, dy=grid.dy, **about)


def footprint(load: GridLoad, road: Pavement | None) -> xr.Dataset:
    """A recorded footprint with the names that a contact has."""
    plane = ("y", "x")
    pressure, along, across = load.array
    fields: dict[str, tuple[tuple[str, ...], object]] = {
        "pressure": (plane, pressure),
        "traction_x": (plane, along),
        "traction_y": (plane, across),
        "normal_load": ((), load.normal_load),
        "tractive_force": ((), load.tractive_force),
        "lateral_force": ((), load.lateral_force),
    }
    words = {} if road is None else {"road": road_in_words(road)}
    cell = {"dx": load.grid.dx, "dy": load.grid.dy}
    told = f"recorded footprint{f', read from {load.source}' if load.source else ''}: {load}"
    return dataset(fields, {"x": load.grid.x, "y": load.grid.y}, **cell, tire=told, **words)
