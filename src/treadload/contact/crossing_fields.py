"""Fields of a crossing: over the positions of the wheel and along the road, and its caveats."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from treadload.contact.bodies.influence import Influence
from treadload.contact.relief import heights_on
from treadload.contact.rolling_state import Rolling
from treadload.contact.solvers.marching import State
from treadload.contact.solvers.normal import NormalSolution
from treadload.deferred import xarray as xr
from treadload.grid import Grid
from treadload.kernels.arrays import Array, IntArray
from treadload.pavement.relief import Relief
from treadload.tire import Tire
from treadload.tire.rib_rows import shares_of_rows
from treadload.variables import dataset

STRIDE = 4
"""Cells between two of them where none are given."""
# Cells that the shortest length of an obstacle needs; Dundurs' β above which shear would change the pressure.
_FEWEST, _ALIKE = 3, 0.05
# Part of a cell by which a cell beside an edge is beyond it.
_NEAR = 1e-6
_SCALARS = (
    "normal_load", "approach", "contact_area", "largest_pressure", "edge_pressure", "share_before", "share_beyond",
    "pressure_centre_x",
)  # fmt: skip


@dataclass(frozen=True)
class Moved:
    """A road's relief as it stands in the frame of a wheel whose axle is at `position`, m along travel."""

    relief: Relief
    position: float

    def height(self, x: Array, y: Array) -> Array:
        """(ny, nx), m, at x (nx,) and y (ny,) of the wheel's frame, m."""
        return self.relief.height(x + self.position, y)


@dataclass(frozen=True, eq=False)
class Scene:
    """What stays the same on the way. gap: of the tread above a plane (ny, nx), m; steps: of the axle (n,), cells."""

    tire: Tire
    relief: Relief
    rolling: Rolling
    grid: Grid
    influence: Influence
    gap: Array
    steps: IntArray

    @property
    def road_x(self) -> Array:
        """Places of the road's cells along travel, m."""
        grid, first, last = self.grid, int(self.steps[0]), int(self.steps[-1])
        return grid.x0 + grid.dx * (np.arange(grid.nx + last - first) + first)

    def over(self, step: int) -> Array:
        """(ny, nx) gap between tread and road, m, with the axle so many cells on."""
        return self.gap - heights_on(Moved(self.relief, step * self.grid.dx), self.grid)


def fields_of(
    scene: Scene, contacts: Sequence[NormalSolution], rubbed: Sequence[State] | None, plain: NormalSolution
) -> xr.Dataset:
    """Fields of a crossing over its positions, and those along the road, as `Crossing` describes them.

    contacts: the contact at every position; rubbed: shear there, None without friction; plain: that without the
    obstacle.
    """
    grid, steps, place_of = scene.grid, scene.steps, scene.road_x
    edges = np.asarray(getattr(scene.relief, "edges", (0.0,)), dtype=float)
    area, shares = grid.cell_area, shares_of_rows(grid.y, grid.dy, scene.tire.ribs)
    wide = (grid.ny, len(place_of))
    highest, closing, sliding = np.zeros(wide), np.zeros(wide), np.zeros(wide)
    before, depth = np.zeros(wide), np.full(wide, -np.inf)
    rows: dict[str, list[float]] = {name: [] for name in _SCALARS}
    for number, (step, contact) in enumerate(zip(steps, contacts, strict=True)):
        at = slice(int(step - steps[0]), int(step - steps[0]) + grid.nx)
        now, sunk = np.zeros(wide), np.full(wide, -np.inf)
        now[:, at] = contact.pressure
        sunk[:, at] = np.nan_to_num(contact.approach - scene.over(int(step)), nan=-np.inf)
        np.maximum(highest, now, out=highest)
        # Where a place comes into contact its two surfaces have closed since they met.
        grown = np.maximum(sunk, 0.0) - np.maximum(depth, 0.0)
        closing += 0.5 * (now + before) * np.maximum(grown, 0.0) * (number > 0)
        before, depth = now, sunk
        if rubbed is not None:
            state = rubbed[number].tangential
            sliding[:, at] += np.maximum(-(state.shear * state.slip).sum(0), 0.0) * (number > 0)
        here = grid.x + step * grid.dx
        load = float(contact.pressure.sum()) * area
        along = contact.pressure.sum(axis=0) * area
        near = (np.abs(here[:, None] - edges[None]) <= 1.01 * grid.dx).any(axis=1)
        for name, value in (
            ("normal_load", load),
            ("approach", contact.approach),
            ("contact_area", float(shares @ (contact.pressure > 0).sum(axis=1)) * area),
            ("largest_pressure", float(contact.pressure.max())),
            ("edge_pressure", float(contact.pressure[:, near].max(initial=0.0))),
            ("share_before", _share(along, here < edges.min() - _NEAR * grid.dx, load)),
            ("share_beyond", _share(along, here > edges.max() + _NEAR * grid.dx, load)),
            ("pressure_centre_x", float(along @ grid.x) / load if load > 0 else math.nan),
        ):
            rows[name].append(value)
    fields: dict[str, tuple[tuple[str, ...], Any]] = {
        name: (("position",), np.array(values)) for name, values in rows.items()
    }
    fields["pressure"] = (("position", "y", "x"), np.stack([contact.pressure for contact in contacts]))
    road = ("y", "road_x")
    fields["road_height"] = (road, scene.relief.height(place_of, grid.y))
    fields["highest_pressure"] = (road, highest)
    fields["closing_work"] = (road, closing)
    beside = (np.abs(place_of[:, None] - edges[None]) <= 1.01 * grid.dx).any(axis=1)
    fields["plain_pressure"] = ((), float(plain.pressure.max()))
    fields["plain_work"] = ((), _plain_work(scene, plain))
    fields["edge_work"] = ((), float(closing[:, beside].max(initial=0.0)))
    if rubbed is not None:
        fields["friction_work_density"] = (road, sliding)
    coordinates = {"position": steps * grid.dx, "y": grid.y, "x": grid.x, "road_x": place_of}
    return dataset(fields, coordinates, dx=grid.dx, dy=grid.dy)


def _plain_work(scene: Scene, plain: NormalSolution) -> float:
    """Largest closing work, J/m², of a road without the obstacle, whose places see the contact from its front on."""
    deep = np.maximum(np.nan_to_num(plain.approach - scene.gap, nan=0.0), 0.0)[:, ::-1]
    pressure = plain.pressure[:, ::-1]
    work = 0.5 * (pressure[:, 1:] + pressure[:, :-1]) * np.maximum(np.diff(deep, axis=1), 0.0)
    return float(work.sum(axis=1).max())


def _share(along: Array, side: Array, load: float) -> float:
    return float(along[side].sum()) / load if load > 0 else 0.0


def caveats(scene: Scene, hold: str, data: xr.Dataset) -> list[str]:
    """What a crossing leaves out, and what of it belongs to the cells: sentences for the user."""
    caveats = [
        "the road below an edge is taken for a half-space, or layers, that go on without end: its own free edge, and "
        "the stress that gathers there, is not in the pressures",
        "the wheel crosses without inertia and its pressures act upright: what a fast wheel adds, and what slopes "
        "push along travel, is not in them",
    ]
    finest = getattr(scene.relief, "finest", None)
    if finest is not None and finest < _FEWEST * scene.grid.dx:
        caveats.append(
            f"the obstacle is {finest * 1e3:.3g} mm long and the cells {scene.grid.dx * 1e3:.3g} mm: pressures at "
            f"its edges are those of the cells; use {finest / _FEWEST * 1e3:.2g} mm or less"
        )
    if getattr(scene.relief, "chamfer", None) == 0 and float(np.ptp(data["road_height"].to_numpy())) > 0:
        caveats.append(
            "the edge is sharp: pressure and work at it grow without end as cells shrink, and are means over a "
            f"cell of {scene.grid.dx * 1e3:.3g} mm; give it a chamfer for numbers that do not belong to the cells"
        )
    apart = int(np.diff(scene.steps).max(initial=1))
    if apart > STRIDE:
        caveats.append(
            f"positions are up to {apart} cells apart: pressures hold at each of them, but works per place ripple "
            f"between them; take positions {STRIDE} cells apart or less for work"
        )
    if scene.rolling.law.largest > 0 and abs(scene.influence.dundurs) > _ALIKE:
        caveats.append(
            f"tire and road differ so that shear changes the pressure (Dundurs' β = {scene.influence.dundurs:.2f}), "
            "which a crossing leaves out"
        )
    if hold == "axle" and (data["normal_load"].to_numpy() <= 0).any():
        caveats.append("the tire leaves the road where it is sunk, since its axle is held")
    return caveats
