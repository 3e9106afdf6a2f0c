"""A state of a history as a contact: the fields at its end, named and signed as every other contact."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from treadload.contact import cautions
from treadload.contact.bodies.influence import Influence
from treadload.contact.rolling_state import Rolling
from treadload.contact.solution import Contact
from treadload.contact.solvers.marching import State
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.kernels.half_space.rectangle import CombinedElasticity
from treadload.pavement import Pavement
from treadload.tire import Tire
from treadload.variables import dataset


@dataclass(frozen=True, eq=False)
class Scene:
    """What stays the same over a history: tire and road, the grid, the gap before loading (ny, nx), m."""

    tire: Tire
    road: Pavement
    grid: Grid
    gap: Array
    influence: Influence


def scalars_of(scene: Scene, state: State) -> dict[str, float]:
    """Load, forces on the tire and their moment about the origin, share of slip, work of friction over the step."""
    grid, shear = scene.grid, state.tangential.shear
    along, across = shear.sum((1, 2)) * grid.cell_area
    moment = (grid.x[None, :] * shear[1] - grid.y[:, None] * shear[0]).sum() * grid.cell_area
    touching = state.pressure > 0
    slipping = touching & ~state.tangential.stick
    return {
        "normal_load": float(state.pressure.sum()) * grid.cell_area,
        "approach": math.nan if state.normal is None else state.normal.approach,
        "tractive_force": float(along),
        "lateral_force": float(across),
        "aligning_moment": float(moment),
        "slip_fraction": float(slipping.sum() / max(1, touching.sum())),
        "friction_energy": 0.0 + state.work(grid.cell_area),
    }


def contact_of(
    scene: Scene,
    state: State,
    rolling: Rolling,
    creepages: tuple[float, float],
    stats: Mapping[str, Any],
    warnings: Sequence[str] = (),
) -> Contact:
    """The contact at the end of a step.

    creepages: given or found, NaN where nothing rolled; then there is no slip velocity over rolling speed
    either, and `slip_distance_x`, `slip_distance_y` tell the slip over the step, m. warnings: besides those of the
    tire and of results that are no numbers.
    """
    grid, tangential = scene.grid, state.tangential
    stiff = scene.road.surface_material
    alone = CombinedElasticity.of(math.inf, 0.0, stiff.shear_modulus, stiff.poisson)
    road_only = Influence(grid.shape, grid.dx, grid.dy, alone)
    displacement = road_only.displacement(state.pressure, tangential.shear)
    traction = 0.0 - tangential.shear
    travel = state.stage.travel
    velocity = tangential.slip / travel if travel > 0 else np.full_like(tangential.slip, math.nan)
    bound = state.stage.bound(state.pressure)
    coefficient = np.divide(bound, state.pressure, out=np.zeros_like(bound), where=state.pressure > 0)
    plane = ("y", "x")
    gap = np.full(grid.shape, math.nan) if state.normal is None else state.normal.gap
    fields: dict[str, tuple[tuple[str, ...], Any]] = {
        "initial_gap": (plane, scene.gap),
        "gap": (plane, gap),
        "pressure": (plane, state.pressure),
        "traction_x": (plane, traction[0]),
        "traction_y": (plane, traction[1]),
        "state": (plane, np.where(state.pressure > 0, np.where(tangential.stick, 1, 2), 0).astype(np.int8)),
        "slip_x": (plane, velocity[0]),
        "slip_y": (plane, velocity[1]),
        "slip_distance_x": (plane, tangential.slip[0]),
        "slip_distance_y": (plane, tangential.slip[1]),
        "displacement_x": (plane, -displacement[0]),
        "displacement_y": (plane, -displacement[1]),
        "displacement_z": (plane, displacement[2]),
        "creepage_x": ((), creepages[0]),
        "creepage_y": ((), creepages[1]),
        "spin": ((), rolling.spin),
        "friction": ((), float(bound.sum() / max(state.pressure.sum(), np.finfo(float).tiny))),
        "friction_coefficient": (plane, coefficient),
        **{name: ((), value) for name, value in scalars_of(scene, state).items()},
    }
    data = dataset(fields, {"x": grid.x, "y": grid.y}, dx=grid.dx, dy=grid.dy)
    said = (
        *cautions.of_tire(scene.tire),
        *cautions.of_numbers(scene.tire, rolling, grid),
        *warnings,
        *cautions.of_fields(data),
    )
    return Contact(data, scene.tire, scene.road, rolling, stats, said)
