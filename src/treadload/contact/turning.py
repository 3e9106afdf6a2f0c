"""A wheel that turns on the spot: spin without rolling, from the first slip at the rim to full sliding.

The tire's tread turns about z in increments and remembers where it stuck, so that a turn to and fro gives the
loop of friction. The axes turn with the wheel: the tread keeps its place on the grid, and the road goes round
beneath it. On the road, which hardly gives way, fields lie turned by the angle.
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar, Unpack

import numpy as np

from treadload.composing import BaseResult, Holds
from treadload.contact.fields import Scene
from treadload.contact.numerics import Numerics, NumericsKeys
from treadload.contact.rolling_state import Rolling
from treadload.contact.snapshot import contact_at, scalars_of
from treadload.contact.solution import Contact
from treadload.contact.solvers.marching import State
from treadload.contact.solvers.sliding import sliding_pole, sliding_torque
from treadload.contact.transient import run, set_scene, stage_of, standing
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.pavement import Pavement
from treadload.rows import Row, row
from treadload.tables import finite_list
from treadload.tire import Tire
from treadload.variables import dataset


@dataclass(frozen=True, eq=False)
class TurnResult(BaseResult, group="turn"):
    """What a turn on the spot took, with the question that was asked.

    dataset: over (step,), step 0 being the standing wheel: turn_angle, steering_torque, slip_fraction, … and
    the scalar sliding_torque. contact: the fields at the end, in the axes of the wheel. rolling: load and
    friction. pivot: the point that was held, m, or None. stats: iterations, seconds.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.7)
    >>> turn = tl.contact.turn_on_the_spot(tire, road, wheel, angles=[0.5], spacing=0.006)
    >>> f"{turn.dataset.steering_torque.values[-1]:.2f} N m at an angle of 0.5 rad"
    '0.62 N m at an angle of 0.5 rad'
    """

    title: ClassVar[str] = "Turn on the spot"
    holds: ClassVar[Holds] = Holds(
        {"turn_angle steering_torque slip_fraction friction_energy": "step", "sliding_torque": ""},
        sizes={"step": (2, math.inf)},
    )

    dataset: xr.Dataset
    contact: Contact
    rolling: Rolling
    pivot: tuple[float, float] | None
    stats: Mapping[str, Any] = field(default_factory=dict)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences for the user, of the contact at the end."""
        return self.contact.warnings

    @property
    def stiffness(self) -> float:
        """Torque over angle of the first increment, N m/rad."""
        d = self.dataset
        angle = float(d.turn_angle[1])
        return float(d.steering_torque[1]) / angle if angle else math.nan

    @property
    def heading(self) -> str:
        """Load, friction and pivot."""
        about = "a free centre" if self.pivot is None else f"a pivot at {self.pivot[0]:g}, {self.pivot[1]:g} m"
        return f"{self.rolling}, about {about}"

    def rows(self) -> tuple[Row, ...]:
        """Torque, stiffness and work; torque and slip over the angle."""
        d = self.dataset
        chosen = np.unique(np.linspace(0, d.sizes["step"] - 1, 9).astype(int))
        return (
            row("sliding_torque", float(d.sliding_torque)),
            row("turning_stiffness", self.stiffness),
            row("friction_energy", float(d.friction_energy.sum())),
            *(
                row(name, float(d[name][k]), group=f"step {k}")
                for k in chosen
                for name in ("turn_angle", "steering_torque", "slip_fraction")
            ),
        )

    def __repr__(self) -> str:
        d = self.dataset
        angle, torque = math.degrees(float(d.turn_angle[-1])), float(d.steering_torque[-1])
        return f"<TurnResult {self.rolling}: {torque:.1f} N m at {angle:.2f}°>"


def turn_on_the_spot(
    tire: Tire,
    road: Pavement,
    rolling: Rolling,
    *,
    angles: Sequence[float] | Array,
    pivot: tuple[float, float] | None = None,
    spacing: float | None = None,
    **numerics: Unpack[NumericsKeys],
) -> TurnResult:
    """Torque that turns a standing wheel about z, and what the tread does to the road meanwhile.

    tire, spacing: as in `solve_contact`; an elastic tire only. numerics: tolerance=, road_compliance= and
    progress= likewise.
    rolling: load, friction, and forces along the road that act all the while; no creepages, no spin.
    angles: of the wheel at the end of every increment, rad, positive to the right; they may go to and fro.
    pivot: (x, y) that is held, m, such as where the kingpin meets the road; None: the wheel finds its centre,
    so that the forces along the road stay as they are given.
    Returns torque, slip and work of friction over the angle, the torque at which everything slides, and the
    contact at the end. Raises as `solve_contact`.
    Method: Kalker (1990), section 1.5, without rolling; limits: Reissner & Sagoci (1944), Lubkin (1951).

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.7)
    >>> turn = tl.contact.turn_on_the_spot(tire, road, wheel, angles=[0.5], spacing=0.006)
    >>> f"{turn.dataset.sliding_torque.item():.2f} N m"
    '0.62 N m'
    """
    began = time.perf_counter()
    how = Numerics(**numerics)
    tolerance, road_compliance, tell = how.tolerance, how.road_compliance, how.tell
    if rolling.creepage_x is not None or rolling.creepage_y is not None or rolling.spin:
        raise InputError("a wheel that turns on the spot does not roll: leave creepages and spin out, give angles")
    if pivot is not None and any(rolling.forces):
        raise InputError("a held pivot takes what force it needs: leave the forces out, or the pivot")
    ends = _checked_angles(angles)
    tell("locating the contact")
    scene = set_scene(tire, road, (rolling,), spacing, road_compliance)
    centre = (0.0, 0.0) if pivot is None else pivot
    arm = np.zeros((2, *scene.grid.shape))
    arm[0] = centre[1] - scene.grid.y[:, None]
    arm[1] = scene.grid.x[None, :] - centre[0]
    forces = rolling.forces if pivot is None else (None, None)
    turns = np.diff(ends, prepend=0.0)
    stages = [standing(scene, rolling), *(stage_of(scene, rolling, turn * arm, forces) for turn in turns)]
    rows: list[dict[str, float]] = []
    newton = products = 0
    for number, state in enumerate(run(scene, stages, tolerance)):
        tell(f"increment {number} of {ends.size}")
        before = float(ends[number - 2]) if number > 1 else 0.0
        rows.append(_row(scene, state, before, float(ends[number - 1]) if number else 0.0, centre))
        newton, products = newton + state.tangential.newton, products + state.tangential.products
    bound, axes, grid = state.stage.bound(state.pressure), state.stage.axes, scene.grid
    pole = sliding_pole(bound, grid.x, grid.y, axes) if pivot is None else pivot
    limit = sliding_torque(bound, grid.x, grid.y, grid.cell_area, pole, axes)
    stats = {
        "increments": int(ends.size),
        "newton_iterations": newton,
        "products": products,
        "dundurs": scene.influence.dundurs,
        "cells": grid.nx * grid.ny,
        "seconds": time.perf_counter() - began,
    }
    contact = contact_at(scene, state, rolling, (math.nan, math.nan), stats)
    return TurnResult(_dataset(rows, limit), contact, rolling, pivot, stats)


def _row(scene: Scene, state: State, before: float, angle: float, centre: tuple[float, float]) -> dict[str, float]:
    scalars = scalars_of(scene, state)
    turned = angle - before
    shift = state.displaced
    about_pivot = (
        scalars["aligning_moment"] - centre[0] * scalars["lateral_force"] + centre[1] * scalars["tractive_force"]
    )
    # A turn about the pivot and a shift are a turn about another point.
    pole = (centre[0] - shift[1] / turned, centre[1] + shift[0] / turned) if turned else (math.nan, math.nan)
    return {
        "turn_angle": angle,
        "steering_torque": 0.0 - about_pivot,
        "pole_x": pole[0],
        "pole_y": pole[1],
        "shift_x": shift[0],
        "shift_y": shift[1],
        **scalars,
    }


def _dataset(rows: Sequence[dict[str, float]], limit: float) -> xr.Dataset:
    fields: dict[str, tuple[tuple[str, ...], Any]] = {
        name: (("step",), np.array([row[name] for row in rows])) for name in rows[0]
    }
    fields["sliding_torque"] = ((), limit)
    return dataset(fields, {"step": np.arange(len(rows))}).set_coords("turn_angle")


def _checked_angles(angles: Sequence[float] | Array) -> Array:
    ends = finite_list(angles, "angles", "rad")
    if np.abs(ends).max() > math.pi:
        raise InputError(f"angles are in rad and at most π, got {np.abs(ends).max():g}; for degrees use math.radians")
    steps = np.diff(ends, prepend=0.0)
    if (steps == 0).any():
        raise InputError(f"increment {int(np.argmax(steps == 0)) + 1} turns by nothing: leave that angle out")
    return ends
