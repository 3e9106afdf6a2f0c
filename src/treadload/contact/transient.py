"""A tire that starts to roll, brakes, steers in: tire and road over a travelled distance.

The wheel first stands under its load without a force along the road. Then it rolls step by step, and every
particle of the tread remembers where it stuck. Steady rolling is reached two to three lengths of the contact
later.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar, Unpack

import numpy as np

from treadload.composing import BaseResult, Holds
from treadload.contact import cautions
from treadload.contact.bodies.choose import Pair, RoadCompliance, road_surface, surface_of
from treadload.contact.bounds import check_ribs
from treadload.contact.contact_grid import cell_across, check_border, place
from treadload.contact.fields import Scene, tractions
from treadload.contact.numerics import Numerics, NumericsKeys
from treadload.contact.rib_sections import prepare_ribs
from treadload.contact.rolling_state import Rolling, bound_on
from treadload.contact.snapshot import contact_at, scalars_of
from treadload.contact.solution import Contact
from treadload.contact.solvers.marching import Stage, State, march
from treadload.contact.solvers.rolling import rigid_slip
from treadload.contact.solvers.tangential import Forces
from treadload.deferred import xarray as xr
from treadload.errors import InputError, within
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.pavement import Pavement
from treadload.rows import Row, row
from treadload.tables import finite_list
from treadload.tire import Tire
from treadload.variables import dataset

_BY_STEP = ("distance", "tractive_force", "lateral_force", "creepage_x", "creepage_y", "slip_fraction")
# Farther, the distances between cells are lost in round-off; shorter, a step is lost beside a cell.
_FARTHEST, _SHORTEST = 1e6, 1e-12


@dataclass(frozen=True, eq=False)
class TransientResult(BaseResult, group="transient"):
    """What happened over the distance, with the question that was asked.

    dataset: over (step,), step 0 being the standing wheel; fields over (step, y, x) when they were asked for.
    contact: the fields at the end. rolling: the state of every step. stats: iterations, seconds.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.7)
    >>> transient = tl.contact.solve_transient(tire, road, wheel, distances=[0.005, 0.01], spacing=0.006)
    >>> transient.dataset.sizes["step"]  # the standing wheel and both distances
    3
    """

    title: ClassVar[str] = "Transient rolling"
    holds: ClassVar[Holds] = Holds(
        {"distance tractive_force lateral_force creepage_x creepage_y slip_fraction friction_energy": "step"}
    )

    dataset: xr.Dataset
    contact: Contact
    rolling: tuple[Rolling, ...]
    stats: Mapping[str, Any] = field(default_factory=dict)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences for the user, of the contact at the end."""
        return self.contact.warnings

    @property
    def heading(self) -> str:
        """The rolling state at the end."""
        return str(self.rolling[-1])

    def rows(self) -> tuple[Row, ...]:
        """How far, and energy lost; forces, creepages and slip over the distance."""
        d = self.dataset
        chosen = np.unique(np.linspace(0, d.sizes["step"] - 1, 8).astype(int))
        return (
            row("distance", float(d.distance[-1]), note=f"{d.sizes['step'] - 1} steps"),
            row("friction_energy", float(d.friction_energy.sum())),
            *(row(name, float(d[name][k]), group=f"step {k}") for k in chosen for name in _BY_STEP),
        )

    def __repr__(self) -> str:
        far = float(self.dataset.distance[-1]) * 1e3
        return f"<TransientResult {self.rolling[-1]}: {far:.1f} mm in {self.dataset.sizes['step'] - 1} steps>"


def solve_transient(
    tire: Tire,
    road: Pavement,
    rolling: Rolling | Sequence[Rolling],
    *,
    distances: Sequence[float] | Array,
    spacing: float | None = None,
    fields: bool = False,
    **numerics: Unpack[NumericsKeys],
) -> TransientResult:
    """Rolling from rest: pressure, shear, stick and slip of a tire step by step along its way.

    tire, spacing: as in `solve_contact`; an elastic tire only. numerics: tolerance=, of every step, road_compliance=
    and progress= likewise.
    rolling: one state for the whole way, or one for every step; the wheel stands under the load of the first before.
    distances: rolled since the start at the end of every step, m, ascending from zero; steps
    may be smaller or larger than a cell. A step of no distance shifts the wheel where it stands, by forces; a
    creepage does nothing there.
    fields: keep pressure, tractions and state of every step.
    Returns forces, creepages, share of slip and work of friction over the distance, and the contact at the end.
    Raises InputError for distances that run backwards or forces beyond friction, GeometryError if the contact
    is larger than the surface, ConvergenceError with the residual reached.
    Method: Kalker (1990), section 4.2: step by step, with the influence coefficients at the travelled distance.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.7)
    >>> tl.contact.solve_transient(tire, road, wheel, distances=[0.02, 0.01], spacing=0.006)
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: distances must ascend from zero, got 0.01 m after 0.02 m; to roll backwards
    turn the tire round
    """
    began = time.perf_counter()
    how = Numerics(**numerics)
    tolerance, road_compliance, tell = how.tolerance, how.road_compliance, how.tell
    ends = _checked_distances(distances)
    wanted = _one_for_each(rolling, ends.size)
    if tire.ribs:
        prepare_ribs(tire, cell_across(tire, spacing), tell)
    tell("locating the contact")
    scene = set_scene(tire, road, wanted, spacing, road_compliance)
    stages = [standing(scene, wanted[0])]
    for state_of_rolling, travel in zip(wanted, np.diff(ends, prepend=0.0), strict=True):
        slip = rigid_slip(
            scene.grid.x, scene.grid.y, float(travel), state_of_rolling.creepages, state_of_rolling.spin
        )
        slip[0] += tire.row_slip(scene.grid)
        stages.append(stage_of(scene, state_of_rolling, slip * travel, state_of_rolling.forces, float(travel)))
    rows: list[dict[str, Any]] = []
    newton = products = 0
    for number, state in enumerate(run(scene, stages, tolerance)):
        tell(f"step {number} of {ends.size}")
        state_of_rolling = wanted[max(0, number - 1)]
        rows.append(_row(scene, state, state_of_rolling, float(ends[number - 1]) if number else 0.0, fields))
        newton, products = newton + state.tangential.newton, products + state.tangential.products
    stats = {
        "steps": int(ends.size),
        "newton_iterations": newton,
        "products": products,
        "dundurs": scene.influence.dundurs,
        "cells": scene.grid.nx * scene.grid.ny,
        "seconds": time.perf_counter() - began,
    }
    creepages = rows[-1]["creepage_x"], rows[-1]["creepage_y"]
    warnings = cautions.of_rolling(tire, wanted[-1])
    contact = contact_at(scene, state, wanted[-1], creepages, stats, warnings)
    return TransientResult(_dataset(scene.grid, rows), contact, wanted, stats)


def set_scene(
    tire: Tire,
    road: Pavement,
    rolling: Sequence[Rolling],
    spacing: float | None,
    road_compliance: RoadCompliance = "half_space",
) -> Scene:
    """Grid that holds the contact of every one of these states, the gap on it, and the two bodies."""
    # A body that remembers is known in steady rolling only.
    bodies = Pair(surface_of(tire.elastic, is_tire=True), road_surface(road, road_compliance))
    if any(state.law.largest > 0 for state in rolling):
        bodies.both.check_shear()
    loads = [state.normal_load for state in rolling]
    if None in loads and any(load is not None for load in loads):
        raise InputError("the steps give normal_load here and approach there; give one of them throughout")
    for state in rolling:
        if state.law.needs_speed:
            raise InputError(
                f"friction {state.law} falls with slip, and a history does not follow that: its steps would depend "
                "on their length; give friction that depends on pressure and place only"
            )
        if state.normal_load is not None:
            state.check_friction_limit(state.normal_load)
    heaviest = max(rolling, key=lambda state: state.normal_load or state.approach or 0.0)

    grid, gap = place(tire, heaviest, bodies.both, spacing)
    check_ribs(tire, grid.dy)
    return Scene(tire, road, bodies, grid, gap)


def standing(scene: Scene, rolling: Rolling) -> Stage:
    """The step that puts the wheel down, with no force along the road."""
    return stage_of(scene, rolling, np.zeros((2, 1, 1)), (0.0, 0.0))


def stage_of(scene: Scene, rolling: Rolling, rigid: Array, forces: Forces, travel: float = 0.0) -> Stage:
    """A step under the load and the friction of a rolling state; the rest as in `Stage`."""
    return Stage(
        rigid, forces, bound_on(scene.grid, rolling), travel, rolling.law.axes,
        load=rolling.normal_load, approach=rolling.approach,
    )  # fmt: skip


def run(scene: Scene, stages: Sequence[Stage], tolerance: float) -> Iterator[State]:
    """March on the scene's grid; refuses a contact that the grid cuts off."""
    for state in march(scene.influence, stages, gap=scene.gap, tolerance=tolerance):
        check_border(state.pressure, scene.grid)
        if not state.pressure.any():
            raise InputError("the approach does not bring tire and road into contact; raise it")
        yield state


def _row(scene: Scene, state: State, rolling: Rolling, distance: float, fields: bool) -> dict[str, float | Array]:
    travel = state.stage.travel
    rigid = state.stage.rigid.mean((1, 2)) + np.array(state.displaced)
    solved = np.array(state.displaced) / travel if travel > 0 else np.full(2, np.nan)
    imposed = np.array(rolling.creepages)
    creepages = np.where([force is None for force in state.stage.forces], imposed, solved) if travel > 0 else solved
    row: dict[str, float | Array] = {
        "distance": distance,
        "creepage_x": float(creepages[0]),
        "creepage_y": float(creepages[1]),
        "spin": rolling.spin if travel > 0 else np.nan,
        "shift_x": float(rigid[0]),
        "shift_y": float(rigid[1]),
        **scalars_of(scene, state),
    }
    if fields:
        row |= {"pressure": state.pressure, **tractions(state.pressure, state.tangential)}
    return row


def _dataset(grid: Grid, rows: Sequence[dict[str, object]]) -> xr.Dataset:
    names = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    dims = {1: ("step",), 3: ("step", "y", "x")}
    variables = {name: (dims[values.ndim], values) for name, values in names.items()}
    coordinates: dict[str, Any] = {"step": np.arange(len(rows))}
    if any(values.ndim == 3 for values in names.values()):
        coordinates |= {"x": grid.x, "y": grid.y}
    return dataset(variables, coordinates, dx=grid.dx, dy=grid.dy).set_coords("distance")


def _checked_distances(distances: Sequence[float] | Array) -> Array:
    ends = finite_list(distances, "distances", "m")
    within("distances", float(np.abs(ends).max(initial=0.0)), 0.0, _FARTHEST, "m", "a contact is 0.2 m long")
    steps = np.diff(ends, prepend=0.0)
    short = steps[(steps > 0) & (steps < _SHORTEST)]
    if short.size:
        raise InputError(
            f"a step of the distances is {short[0]:g} m, and below {_SHORTEST:g} m it is lost in round-off; a step "
            "of 0 m shifts the wheel where it is"
        )
    if (steps < 0).any():
        where = int(np.argmax(steps < 0))
        raise InputError(
            f"distances must ascend from zero, got {ends[where]:g} m after {ends[where - 1] if where else 0:g} m; "
            "to roll backwards turn the tire round"
        )
    return ends


def _one_for_each(rolling: Rolling | Sequence[Rolling], number: int) -> tuple[Rolling, ...]:
    if isinstance(rolling, Rolling):
        return (rolling,) * number
    if len(rolling) != number:
        raise InputError(f"give one Rolling, or one for each of the {number} distances; got {len(rolling)}")
    return tuple(rolling)
