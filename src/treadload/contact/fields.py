"""The fields of a contact, named and signed as in results: the one place where the solvers' signs turn.

Inside the solvers shear acts on the tire and u = u_tire - u_road; results hold the shear on the road and the road's
displacement.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from treadload.contact.bodies.body import Body
from treadload.contact.bodies.choose import Pair
from treadload.contact.bodies.influence import Influence, operators
from treadload.contact.solvers.tangential import TangentialSolution
from treadload.deferred import xarray as xr
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.pavement import Pavement
from treadload.tire import Tire
from treadload.variables import dataset

# The attribute of a contact that states how the sides of its tire's ribs are, see `Tire.rib_sides`.
RIB_SIDES = "rib_sides"
Fields = dict[str, tuple[tuple[str, ...], Any]]
_PLANE = ("y", "x")


@dataclass(frozen=True, eq=False)
class Scene:
    """What stays the same while a contact is solved: tire and road, their bodies, the grid, the gap before loading.

    gap: (ny, nx), m, NaN where there is no material.
    """

    tire: Tire
    road: Pavement
    bodies: Pair
    grid: Grid
    gap: Array

    @cached_property
    def influence(self) -> Influence:
        """Operators of both bodies on the grid."""
        return self._on_grid(self.bodies.both)

    def displacement_of_road(self, pressure: Array, shear: Array) -> Array:
        """(3, ny, nx), m: along x, y and down, by pressure (ny, nx) and shear on the tire (2, ny, nx), Pa."""
        along_x, along_y, opening = self._on_grid(self.bodies.road).displacement(pressure, shear)
        # u = u_tire - u_road: with a rigid tire the road moves the other way. What opens the gap lowers the road.
        return np.array([-along_x, -along_y, opening])

    def _on_grid(self, body: Body) -> Influence:
        return operators(self.grid.shape, self.grid.dx, self.grid.dy, body, self.grid.y0)


def shear_on_road(shear: Array) -> Array:
    """Shear on the road from that on the tire, either way (2, …), Pa."""
    return 0.0 - shear


def tangential_of(data: xr.Dataset) -> TangentialSolution:
    """The solvers' fields of an earlier contact."""
    shear = shear_on_road(np.stack([data["traction_x"].to_numpy(), data["traction_y"].to_numpy()]))
    slip = np.stack([data["slip_x"].to_numpy(), data["slip_y"].to_numpy()])
    creepages = (float(data["creepage_x"]), float(data["creepage_y"]))
    return TangentialSolution(shear, slip, creepages, data["state"].to_numpy() == 1, 0.0)


def tractions(pressure: Array, tangential: TangentialSolution) -> dict[str, Array]:
    """traction_x, traction_y on the road (ny, nx), Pa, and state, 0 open, 1 stick, 2 slip."""
    along, across = shear_on_road(tangential.shear)
    touching = np.where(tangential.stick, 1, 2)
    return {"traction_x": along, "traction_y": across, "state": np.where(pressure > 0, touching, 0).astype(np.int8)}


def loads(grid: Grid, pressure: Array, shear: Array) -> dict[str, float]:
    """Load, N, forces of the road on the tire, N, and their moment about the origin, N m."""
    along, across = shear.sum((1, 2)) * grid.cell_area
    moment = (grid.x[None, :] * shear[1] - grid.y[:, None] * shear[0]).sum() * grid.cell_area
    return {
        "normal_load": float(pressure.sum()) * grid.cell_area,
        "tractive_force": float(along),
        "lateral_force": float(across),
        "aligning_moment": float(moment),
    }


def contact_dataset(
    scene: Scene,
    pressure: Array,
    gap: Array,
    tangential: TangentialSolution,
    velocity: Array,
    *,
    planes: Mapping[str, Array],
    scalars: Mapping[str, float],
) -> xr.Dataset:
    """The fields that every contact has, and those of its own.

    pressure, gap after loading: (ny, nx), Pa, m. tangential: shear and slip on the tire. velocity: slip of the tire
    relative to the road over rolling speed (2, ny, nx). planes: further fields (ny, nx). scalars: creepages, spin,
    approach, friction, and others; loads are added.
    """
    grid = scene.grid
    displacement = scene.displacement_of_road(pressure, tangential.shear)
    fields = {
        "initial_gap": scene.gap,
        "gap": gap,
        "pressure": pressure,
        **tractions(pressure, tangential),
        "slip_x": velocity[0],
        "slip_y": velocity[1],
        **{f"displacement_{axis}": part for axis, part in zip("xyz", displacement, strict=True)},
        **planes,
    }
    numbers = {**loads(grid, pressure, tangential.shear), **scalars}
    named: Fields = {name: (_PLANE, values) for name, values in fields.items()}
    named |= {name: ((), value) for name, value in numbers.items()}
    about = {RIB_SIDES: scene.tire.rib_sides}
    return dataset(named, {"x": grid.x, "y": grid.y}, dx=grid.dx, dy=grid.dy, **about)
