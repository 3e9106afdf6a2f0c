"""A state of a history as a contact: the fields at its end, named and signed as every other contact."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from treadload.contact import cautions
from treadload.contact.fields import Scene, contact_dataset, loads
from treadload.contact.rolling_state import Rolling
from treadload.contact.solution import Contact
from treadload.contact.solvers.marching import State


def scalars_of(scene: Scene, state: State) -> dict[str, float]:
    """Load, approach, forces on the tire and their moment about the origin, share of slip, work of the step."""
    touching = state.pressure > 0
    slipping = touching & ~state.tangential.stick
    return {
        **loads(scene.grid, state.pressure, state.tangential.shear),
        "approach": math.nan if state.normal is None else state.normal.approach,
        "slip_fraction": float(slipping.sum() / max(1, touching.sum())),
        "friction_energy": 0.0 + state.work(scene.grid.cell_area),
    }


def contact_at(
    scene: Scene,
    state: State,
    rolling: Rolling,
    creepages: tuple[float, float],
    stats: Mapping[str, object],
    warnings: Sequence[str] = (),
) -> Contact:
    """The contact at the end of a step.

    creepages: given or solved for, NaN where nothing rolled; then there is no slip velocity over rolling speed
    either, and `slip_distance_x`, `slip_distance_y` hold the slip over the step, m. warnings: besides those of the
    tire and of results that are not numbers.
    """
    tangential, travel = state.tangential, state.stage.travel
    velocity = tangential.slip / travel if travel > 0 else np.full_like(tangential.slip, math.nan)
    bound = state.stage.bound(state.pressure)
    data = contact_dataset(
        scene,
        state.pressure,
        np.full(scene.grid.shape, math.nan) if state.normal is None else state.normal.gap,
        tangential,
        velocity,
        planes={
            "slip_distance_x": tangential.slip[0],
            "slip_distance_y": tangential.slip[1],
            "friction_coefficient": np.divide(
                bound, state.pressure, out=np.zeros_like(bound), where=state.pressure > 0
            ),
        },
        scalars={
            "creepage_x": creepages[0],
            "creepage_y": creepages[1],
            "spin": rolling.spin,
            "friction": float(bound.sum() / max(state.pressure.sum(), np.finfo(float).tiny)),
            **scalars_of(scene, state),
        },
    )
    warnings_of = (
        *cautions.of_tire(scene.tire),
        *cautions.of_numbers(scene.tire, rolling, scene.grid),
        *warnings,
        *cautions.of_fields(data),
    )
    return Contact(data, scene.tire, scene.road, rolling, stats, warnings_of)
