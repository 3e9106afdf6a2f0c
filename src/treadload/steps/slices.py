"""Vertical slices through the road."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np

from treadload.case.step import Results, Step
from treadload.damage import Verdict
from treadload.deferred import xarray as xr
from treadload.kernels.arrays import Array
from treadload.kernels.largest import index_of_largest
from treadload.pavement import Pavement
from treadload.response import Response
from treadload.steps.outline import Outline
from treadload.steps.scene import Scene
from treadload.steps.script import Script

# Depths of a slice; under a moving load each costs several times as much.
_SLICE_DEPTHS, _MOVING_DEPTHS = 31, 16
# As a depth just below an interface, m.
_BELOW_FACE = 1e-6


class SlicesStep(Step, name="slices"):
    """Vertical slices along and across travel, through the worst point of the assessment if it lies in the map.

    >>> wheel = {"tire": {"profile": "315/80R22.5", "inflation_pressure": "8 bar"}, "spacing": "12 mm"}
    >>> wheel |= {"rolling": {"normal_load": "32.5 kN", "friction": 0.7}, "response": {"depths": ["0 mm", "20 mm"]}}
    >>> road = {"pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3", "temperature": 15}}
    >>> plan = tl.plan(tl.Case.from_dict(wheel | road))
    >>> next(line for line in plan.splitlines() if line.startswith("slices"))
    'slices    45 and 47 points at 35 depths down to 262.5 mm'
    """

    after: ClassVar = ("contact", "response")
    also: ClassVar = ("damage",)
    makes: ClassVar = ("slice_along", "slice_across")
    has_table: ClassVar = False
    is_quiet: ClassVar = True

    def solve(self, scene: Scene) -> Results:
        """Both slices, of one solve."""
        scene.tell("vertical slices")
        load, response, verdict = scene.loaded, scene.result("response"), scene.result("damage")
        assert isinstance(response, Response)
        road, grid = load.road, load.grid
        worst_x, worst_y = _worst_point(response, verdict if isinstance(verdict, Verdict) else None)
        bottom = scene.case.response.slices_to(road.interfaces.tolist(), rigid_base=road.rigid_base)
        depths = slice_depths(bottom, load.wheel.grid.dx, road)
        crossing = [(x, worst_y) for x in grid.x] + [(worst_x, y) for y in grid.y]
        slices = load.solve(depths, points=crossing)
        return {
            "slice_along": _line(slices, slice(grid.nx), "x"),
            "slice_across": _line(slices, slice(grid.nx, None), "y"),
        }

    def plan(self, outline: Outline) -> None:
        """Points and depths."""
        road, cells = outline.road, outline.map_cells
        bottom = outline.case.response.slices_to(road.interfaces.tolist(), rigid_base=road.rigid_base)
        depths = len(slice_depths(bottom, outline.grid.dx, road))
        outline.add("slices", f"{cells.nx} and {cells.ny} points at {depths} depths down to {bottom * 1e3:g} mm")
        outline.sliced += (cells.nx + cells.ny) * depths

    def python(self, script: Script) -> list[str]:
        """Nothing: figures of a report, and no part of the script."""
        return []


def _worst_point(response: Response, verdict: Verdict | None) -> tuple[float, float]:
    """X and y, m, of the assessment's worst point if it lies in the map, else of the largest strain of the first map.

    A worst point in the basin far ahead of a wheel has a section without the wheel, which explains nothing.
    """
    strain = response.dataset.principal_strain_1.isel(depth=0)
    if verdict is not None and float(verdict.dataset["worst_strain"]) > 0:
        worst = {name: float(verdict.dataset[f"worst_{name}"]) for name in ("x", "y")}
        if all(float(strain[name][0]) <= worst[name] <= float(strain[name][-1]) for name in worst):
            return worst["x"], worst["y"]
    row, column = index_of_largest(strain.values)
    return float(strain.x[column]), float(strain.y[row])


def _line(response: Response, members: slice, along: str) -> Response:
    """The points of a response that lie on one line along x or y, as a grid of a single row or column."""
    points = response.dataset.isel(point=members)
    count = points.sizes["point"]
    places = {name: points[name].to_numpy()[: count if name == along else 1] for name in ("y", "x")}
    coordinates = {
        name: (name, places.get(name, points[name].to_numpy()), points[name].attrs)
        for name in ("depth", "y", "x", "component")
    }
    coordinates["layer"] = ("depth", points["layer"].to_numpy(), points["layer"].attrs)
    fields: dict[Hashable, tuple[Any, ...]] = {}
    for name, part in points.data_vars.items():
        if "depth" not in part.dims:
            # Of the road, as moduli of sublayers are: with the map.
            continue
        values, more = part.to_numpy(), part.dims[2:]
        if name == "dissipated_energy":
            # The same all along x.
            fields[name] = ("depth", "y"), values[:, : len(places["y"])], part.attrs
        else:
            values = np.expand_dims(values, 1 if along == "x" else 2)
            fields[name] = ("depth", "y", "x", *more), values, part.attrs
    data = xr.Dataset(fields, coordinates, points.attrs)
    seconds = response.stats["seconds"] * count / response.dataset.sizes["point"]
    stats = {**response.stats, "seconds": seconds, "points": count * data.sizes["depth"]}
    return replace(response, dataset=data, stats=stats)


def slice_depths(bottom: float, cell: float, road: Pavement) -> Array:
    """Depths from the surface to the bottom, close to each other near the surface where strain varies fast.

    None lies between the surface and half a cell: there the field shows the edges of the cells. Both sides of every
    interface are among them.
    """
    first = min(0.5 * cell, 0.5 * bottom)
    count = _MOVING_DEPTHS if road.is_viscoelastic else _SLICE_DEPTHS
    graded = np.concatenate([[0.0], np.geomspace(first, bottom, count - 1)])
    above = [depth for depth in road.interfaces if depth <= bottom]
    below = [depth + _BELOW_FACE for depth in above if depth < bottom]
    # Depths that differ by round-off alone would be solved twice.
    return np.unique(np.round(np.concatenate([graded, above, below]), 9))
