"""A wheel over a step, a joint or a plate: a quasi-static history of contacts along the road.

The tire moves forward over a road that stands still: at the position X of its axle the cell at x of the wheel's frame
stands over the place X + x of the road, whose height is taken from the gap. The pressure is that of frictionless
contact at every position; where there is friction, shear follows in steps that remember where they stuck, under that
pressure, so that sliding at the edge costs work where it happens.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar, Literal, Unpack

import numpy as np

from treadload.composing import BaseResult, Holds
from treadload.contact import cautions
from treadload.contact.bodies.choose import Pair, road_surface, surface_of
from treadload.contact.bodies.influence import Influence
from treadload.contact.contact_grid import cell_across, check_border, place
from treadload.contact.crossing_fields import STRIDE, Moved, Scene, caveats, fields_of
from treadload.contact.numerics import Numerics, NumericsKeys
from treadload.contact.relief import above, check_step
from treadload.contact.rib_sections import prepare_ribs
from treadload.contact.rolling_state import Rolling, bound_on
from treadload.contact.solvers.marching import Stage, State, march
from treadload.contact.solvers.normal import NormalSolution, solve_normal
from treadload.contact.solvers.rolling import rigid_slip
from treadload.deferred import xarray as xr
from treadload.errors import ConvergenceError, InputError
from treadload.grid import Grid
from treadload.kernels.arrays import Array, IntArray
from treadload.pavement import Pavement
from treadload.pavement.relief import Relief
from treadload.rows import Row, extremes, row
from treadload.tables import finite_list
from treadload.tire import Tire

_WORK = ("closing_work", "edge_work", "plain_work", "friction_work_density")
MOST_POSITIONS = 400
"""Positions of a history at most."""


@dataclass(frozen=True, eq=False)
class Crossing(BaseResult, group="crossing"):
    """A wheel that crosses an obstacle, with the question that was asked.

    dataset: scalars over (position,), pressure over (position, y, x) in the wheel's frame, and over (y, road_x) the
    road's own fields: its height, the largest pressure, the work of closing and of friction; plain_pressure and
    plain_work, the largest without the obstacle; edge_work, the largest closing work within a cell of an edge.
    hold: "load" or "axle". stats: iterations, seconds. warnings: sentences for the user.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.7)
    >>> step, free = tl.pavement.RoadStep(0.001), tl.Rolling(normal_load=100.0, friction=0.0)
    >>> crossing = tl.contact.cross_obstacle(tire, road, free, step, positions=[-0.06, 0.06], spacing=0.006)
    >>> before, after = crossing.dataset.approach.values
    >>> f"the axle rises by {(before - after) * 1e3:.2f} mm over a step of 1 mm"
    'the axle rises by 1.00 mm over a step of 1 mm'
    """

    title: ClassVar[str] = "Crossing of an obstacle"
    holds: ClassVar[Holds] = Holds(
        {
            "normal_load approach contact_area largest_pressure edge_pressure share_before share_beyond": "position",
            "pressure": "position y x",
            "road_height highest_pressure closing_work": "y road_x",
        },
        maybe={"friction_work_density": "y road_x", "plain_pressure plain_work edge_work": ""},
        numbers="dx dy",
        positive="dx dy",
    )

    dataset: xr.Dataset
    tire: Tire
    road: Pavement
    rolling: Rolling
    relief: Relief
    hold: str = "load"
    stats: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    @property
    def heading(self) -> str:
        """The obstacle."""
        return str(self.relief)

    def rows(self) -> tuple[Row, ...]:
        """The way, the load, peaks of pressure, contact area and work."""
        d = self.dataset
        at, peak = d["position"].to_numpy(), d["largest_pressure"].to_numpy()
        constant = "the load" if self.hold == "load" else "the height of the axle"
        way = f"{at[0] * 1e3:.1f} to {at[-1] * 1e3:.1f} mm in {len(at)} positions, {constant} held"
        plain = float(d["plain_pressure"]) if "plain_pressure" in d else 0.0

        def pressure(key: str, value: float, place: str = "") -> Row:
            over = f"{value / plain:.3g} times that without the obstacle" if plain > 0 else ""
            return row(key, value, note=", ".join(filter(None, (place, over))))

        lines = [
            row("position", way),
            *(
                extremes(key, d[name].to_numpy())
                for key, name in (("normal_load",) * 2, ("net_area", "contact_area"))
            ),
            pressure("largest_pressure", float(peak.max()), f"axle at {at[peak.argmax()] * 1e3:.1f} mm"),
            pressure("edge_pressure", float(d["edge_pressure"].max())),
            *([row("plain_pressure", plain)] if plain > 0 else []),
            *(row(name, float(d[name].max())) for name in _WORK if name in d),
        ]
        return tuple(lines)


def cross_obstacle(
    tire: Tire,
    road: Pavement,
    rolling: Rolling,
    relief: Relief,
    *,
    positions: Sequence[float] | Array | None = None,
    hold: Literal["load", "axle"] = "load",
    spacing: float | None = None,
    **numerics: Unpack[NumericsKeys],
) -> Crossing:
    """A wheel at one position after another over a road that is no plane, without inertia.

    tire, road, spacing: as in `solve_contact`; an elastic tire. numerics: tolerance=, road_compliance= and progress=
    likewise. rolling: the load, and friction with forces or creepages; friction 0 leaves shear out. relief: of the
    road, such as `pavement.RoadStep`, `RoadJoint` or `RoadPlate`, its middle at x = 0. positions: of the axle along
    travel, m, ascending, moved to whole cells; left out, from clear of the obstacle to clear of it, every fourth
    cell. hold: "load" lets the axle rise and sink, "axle" keeps it at the height that the load gives on the plane z =
    0. Returns a history with its positions. Raises InputError, GeometryError and ConvergenceError as `solve_contact`.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.0)
    >>> tl.contact.cross_obstacle(tire, road, wheel, tl.pavement.RoadStep(0.01), positions=[0.0, -0.1], spacing=0.006)
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: positions must ascend by a cell of 6 mm or more, got 0 m and then -0.1 m; take
    them further apart, or smaller cells
    """
    began = time.perf_counter()
    how = Numerics(**numerics)
    tolerance, road_compliance, tell = how.tolerance, how.road_compliance, how.tell
    if hold not in ("load", "axle"):
        raise InputError(f'hold must be "load" or "axle", got {hold!r}')
    if not isinstance(relief, Relief):
        raise InputError(
            f"relief must be a pavement.RoadStep, RoadJoint, RoadPlate or have a method height(x, y), got {relief!r}"
        )
    if rolling.normal_load is None:
        raise InputError("a wheel over an obstacle needs its normal_load; an approach is that of one position only")
    if rolling.law.needs_speed:
        raise InputError(f"friction {rolling.law} falls with slip, and a history does not follow that; give a number")
    bodies = Pair(surface_of(tire.elastic, is_tire=True), road_surface(road, road_compliance))
    if rolling.law.largest > 0:
        bodies.both.check_shear()
    prepare_ribs(tire, cell_across(tire, spacing), tell)
    tell("locating the contact")
    dx, low, high = _reach(tire, rolling, bodies, spacing, relief)
    check_step(relief, dx)
    steps = _steps(positions, dx, low, high)
    grid = _grid(tire, rolling, bodies, spacing, relief, steps, dx)
    influence = Influence(grid.shape, grid.dx, grid.dy, bodies.both, grid.y0)
    # As sharp as `solve_coupled` presses, whose plain contact this is.
    tight = tolerance if abs(influence.dundurs) <= tolerance else 0.5 * tolerance
    scene = Scene(tire, relief, rolling, grid, influence, tire.height_map(grid), steps)
    plain = solve_normal(influence, scene.gap, load=rolling.normal_load, tolerance=tight)
    approach = plain.approach if hold == "axle" else None
    contacts: list[NormalSolution] = []
    for number, step in enumerate(steps):
        tell(f"position {number + 1} of {len(steps)}")
        load = rolling.normal_load if approach is None else None
        normal = solve_normal(influence, scene.over(int(step)), load=load, approach=approach, tolerance=tight)
        check_border(normal.pressure, grid)
        contacts.append(normal)
    rubbed = None
    if rolling.law.largest > 0:
        tell("sliding along the way")
        rubbed = _sliding(scene, contacts, tolerance)
    stats = {
        "positions": len(steps),
        "normal_iterations": sum(contact.iterations for contact in contacts),
        "normal_residual": max(contact.residual for contact in contacts),
        "dundurs": influence.dundurs,
        "cells": grid.nx * grid.ny,
        "seconds": time.perf_counter() - began,
    }
    data = fields_of(scene, contacts, rubbed, plain)
    warnings = (*cautions.of_tire(tire), *cautions.of_numbers(tire, rolling, grid), *caveats(scene, hold, data))
    return Crossing(data, tire, road, rolling, relief, hold, stats, warnings)


def _reach(
    tire: Tire, rolling: Rolling, bodies: Pair, spacing: float | None, relief: Relief
) -> tuple[float, float, float]:
    """Cell along travel, and positions at which the contact on a plane is clear of the obstacle, m."""
    grid, gap = place(tire, rolling, bodies.both, spacing)
    first = solve_normal(
        Influence(grid.shape, grid.dx, grid.dy, bodies.both, grid.y0), gap, load=rolling.normal_load, tolerance=1e-2
    )
    touching = np.abs(grid.x[np.any(first.pressure > 0, axis=0)]).max(initial=0.0) + 2 * grid.dx
    edges = getattr(relief, "edges", (0.0,))
    return grid.dx, min(edges) - 1.25 * touching, max(edges) + 1.25 * touching


def _steps(positions: Sequence[float] | Array | None, dx: float, low: float, high: float) -> IntArray:
    """Whole numbers of cells, ascending."""
    if positions is None:
        # Symmetric about the middle, so that what is mirrored has a mirrored history.
        half = math.ceil(max(-low, high) / (STRIDE * dx))
        whole = STRIDE * np.arange(-half, half + 1)
        return _check_count(whole)
    places = finite_list(positions, "positions", "m")
    steps = np.rint(places / dx).astype(int)
    if (np.diff(steps) <= 0).any():
        at = int(np.argmax(np.diff(steps) <= 0))
        raise InputError(
            f"positions must ascend by a cell of {dx * 1e3:g} mm or more, got {places[at]:g} m and then "
            f"{places[at + 1]:g} m; take them further apart, or smaller cells"
        )
    return _check_count(steps)


def _check_count(steps: IntArray) -> IntArray:
    if len(steps) > MOST_POSITIONS:
        raise InputError(
            f"{len(steps)} positions are more than {MOST_POSITIONS}; give fewer positions, further apart"
        )
    return steps


def _grid(
    tire: Tire, rolling: Rolling, bodies: Pair, spacing: float | None, relief: Relief, steps: IntArray, dx: float
) -> Grid:
    """The largest of the grids that the contact needs on the plane and at the positions."""
    grids = [place(tire, rolling, bodies.both, spacing)[0]]
    if tire.fixed_grid is None:
        grids += [
            place(above(tire, Moved(relief, int(step) * dx)), rolling, bodies.both, spacing)[0] for step in steps
        ]
    long, wide = (max(getattr(grid, name) for grid in grids) for name in ("nx", "ny"))
    first = grids[0]
    if (first.nx, first.ny) == (long, wide):
        return first
    return Grid.on_lattice(long * first.dx, wide * first.dy, first.dx)


def _sliding(scene: Scene, contacts: Sequence[NormalSolution], tolerance: float) -> list[State]:
    """Shear, slip and work of a wheel that rolls from its first position to its last under known pressures."""
    grid, rolling, law = scene.grid, scene.rolling, scene.rolling.law

    bound = bound_on(grid, rolling)

    def stages() -> Iterator[Stage]:
        yield Stage(np.zeros((2, 1, 1)), (0.0, 0.0), bound, 0.0, law.axes, pressure=contacts[0].pressure)
        slip = rigid_slip(grid.x, grid.y, grid.dx, rolling.creepages, rolling.spin)
        slip[0] += scene.tire.row_slip(grid)
        for travel, contact in zip(np.diff(scene.steps) * grid.dx, contacts[1:], strict=True):
            yield Stage(slip * travel, rolling.forces, bound, float(travel), law.axes, pressure=contact.pressure)

    try:
        return list(march(scene.influence, stages(), tolerance=tolerance))
    except (InputError, ConvergenceError) as error:
        raise type(error)(f"shear along the way: {error}; or leave it out with friction=0") from error
