"""The wheels of a class of axles: which contacts they need, and where they stand on the common lattice."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from treadload.contact import Contact, Maneuver, solve_contact
from treadload.damage.traffic import AxleClass
from treadload.errors import InputError
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.pavement import Pavement
from treadload.response import GridLoad
from treadload.response.basin import coarsened
from treadload.response.loads import SurfaceLoad
from treadload.response.material import divided
from treadload.response.superposition import merged
from treadload.tire import Tire

# Of contact and slip in a passage: lives move by 4e-6 from those of 1e-6, with half of the products, measured.
_TOLERANCE = 3e-5
# Points beyond the outer edges of the wheels, m: strain there is a few per cent of the largest.
MARGIN = 0.3
# Readings stand at least this close to each other across travel, m: a fifth of the length they are averaged over.
_BETWEEN = 2e-3
# Where a side force leaves tension in strips of a few millimetres, cells are divided across travel to this size, m,
# before their mean near the surface is taken: years within 0.4 % of those of the same load on cells of 0.75 mm, see
# `docs/notes/cells_and_means.md`.
_EVALUATED_CELL = 1.5e-3
SIDE_FORCE = 0.05
"""Part of the load from which on a side force narrows what is tensile to strips of a few millimetres."""
# Round-off of a place, in cells.
_ROUND_OFF = 1e-9


@dataclass(frozen=True, eq=False)
class Wheels:
    """The wheels of a class with their contact, on the cells of the common lattice.

    loads: one per wheel. x: of the cells' centres under the axles, m, one row per axle, from the rear to the front.
    speed: m/s, or None. moved: the largest distance along x or y between where a wheel stands and where the class has
    it, m. offsets: for each load, from where it stands to where the class has it along x and y, m; empty: none.
    has_side_force: True for a side force of more than `SIDE_FORCE`.
    """

    loads: tuple[GridLoad, ...]
    x: Array
    speed: float | None
    name: str
    moved: float
    offsets: tuple[tuple[float, float], ...] = ()
    has_side_force: bool = False

    @cached_property
    def joined(self) -> list[SurfaceLoad]:
        """The same loads, fewer where they stand close together."""
        return merged(self.loads)

    @cached_property
    def near_surface(self) -> list[SurfaceLoad]:
        """The same loads on divided cells, for means near the surface, see `parts`."""
        return self.joined if self.parts == 1 else merged([divided(load, 1, self.parts) for load in self.loads])

    @cached_property
    def deep(self) -> list[SurfaceLoad]:
        """The same loads where the class has them, shared out among cells, for what lies a few of these deep."""
        if not self.offsets:
            return self.joined
        pairs = zip(self.loads, self.offsets, strict=True)
        return merged([_shared_out(load, *offset) for load, offset in pairs])

    @cached_property
    def coarse(self) -> list[SurfaceLoad]:
        """The same loads on the cells that their basin needs."""
        return coarsened(self.loads)

    @cached_property
    def length(self) -> float:
        """Of the longest footprint, m."""
        pressed = [load.grid.dx * np.ptp(np.flatnonzero((load.pressure > 0).any(axis=0))) for load in self.loads]
        return float(max(pressed)) + self.loads[0].grid.dx

    @property
    def parts(self) -> int:
        """Into which each cell is divided across travel where means near the surface are evaluated."""
        return math.ceil(self.cell / _EVALUATED_CELL - _ROUND_OFF) if self.has_side_force else 1

    @property
    def cell(self) -> float:
        """Size of the cells across travel, m."""
        return self.loads[0].grid.dy


def check_speed(row: AxleClass, road: Pavement) -> None:
    """Raise InputError for a class without speed on a viscoelastic road."""
    if road.is_viscoelastic and row.speed is None:
        raise InputError(f"the road is viscoelastic: give the class {row.name!r} a speed in m/s")


def has_side_force(maneuver: Maneuver) -> bool:
    """Whether wheels have a side force of more than `SIDE_FORCE`."""
    return abs(maneuver.lateral) > SIDE_FORCE


class State(NamedTuple):
    """What the contact of a class depends on, besides the tire and the road.

    halved: True on cells half as large as those of the other classes, see `life.halving`.
    """

    wheel_load: float
    inflation_pressure: float
    maneuver: Maneuver
    friction: Any
    speed: float | None
    tire: Tire | None
    halved: bool = False

    @property
    def numbers(self) -> tuple[float, float]:
        """Load and pressure."""
        return self.wheel_load, self.inflation_pressure

    def cell(self, spacing: float) -> float:
        """Size of its cells, m. spacing: of the cells of the life, m."""
        return spacing / 2 if self.halved else spacing


def state(row: AxleClass) -> State:
    """The state of a class."""
    return State(row.wheel_load, row.inflation_pressure, row.maneuver, row.friction, row.speed, row.tire)


def states_of(row: AxleClass, tire: Tire) -> tuple[State, ...]:
    """The state of a class; and, where wheels are mirrored and their tread is not its own mirror image, that whose
    mirror image is theirs: with side force and spin reversed.
    """
    if not row.mirrored or (row.tire or tire).is_symmetric:
        return (state(row),)
    maneuver = replace(row.maneuver, lateral=-row.maneuver.lateral, spin=-row.maneuver.spin)
    return state(row), state(replace(row, maneuver=maneuver))


def contact_in_state(
    tire: Tire, road: Pavement, wanted: State, spacing: float, *, start: Contact | None = None
) -> Contact:
    """The contact in a state. spacing: of the cells of a life, m. start: one near it."""
    inflated = replace(wanted.tire or tire, inflation_pressure=wanted.inflation_pressure)
    rolling = wanted.maneuver.rolling(wanted.wheel_load, wanted.friction, speed=wanted.speed)
    return solve_contact(inflated, road, rolling, spacing=wanted.cell(spacing), start=start, tolerance=_TOLERANCE)


def across(contacts: Sequence[Contact], classes: Sequence[AxleClass], reach: float = MARGIN) -> Array:
    """Evenly spaced y, m, on the cells of the first contact and between them, over all wheels and a reach, m, beside.

    Between cells lie the places of the largest readings, which must not depend on where the cells lie.
    """
    first = contacts[0].dataset
    dy, start = float(first.attrs["dy"]), float(first["y"][0])
    half = max(
        float(np.abs(contact.dataset["y"]).max()) + max(abs(y) for _, y in row.wheels)
        for contact, row in zip(contacts, classes, strict=True)
    )
    low, high = np.floor((-half - reach - start) / dy), np.ceil((half + reach - start) / dy)
    between = math.ceil(dy / _BETWEEN - 1e-9)
    return start + dy / between * np.arange(between * low, between * high + 1)


def wheels_of(contacts: Sequence[Contact], row: AxleClass, y: Array) -> Wheels:
    """The wheels of a class, each moved by half a cell at most onto the lattice of y and of its own x.

    contacts: in the states of the class, see `states_of`.
    """
    first, last = GridLoad.from_dataset(contacts[0].dataset), GridLoad.from_dataset(contacts[-1].dataset)
    grid = first.grid
    dx, dy = grid.dx, grid.dy
    loads, offsets = [], []
    for number, (at_x, at_y) in enumerate(row.wheels):
        print_ = last.mirrored() if len(contacts) > 1 and number in row.mirrored else first
        row_y = _nearest_cell((at_y + print_.grid.y0 - y[0]) / dy)
        near_x, near_y = dx * _nearest_cell(at_x / dx), float(y[0]) + dy * row_y - print_.grid.y0
        loads.append(print_.moved(x=near_x, y=near_y))
        offsets.append((at_x - near_x, at_y - near_y))
    centres = sorted({_nearest_cell(at_x / dx) for at_x, _ in row.wheels})
    return Wheels(
        tuple(loads),
        np.array([grid.x + dx * centre for centre in centres]),
        row.speed,
        row.name,
        float(np.abs(offsets).max()),
        tuple(offsets),
        has_side_force(row.maneuver),
    )


def _nearest_cell(cells: float) -> int:
    """The nearest whole number of cells; of two the larger, so that wheels half a cell off keep their distances."""
    return math.floor(cells + 0.5 + _ROUND_OFF)


def _shared_out(load: GridLoad, off_x: float, off_y: float) -> GridLoad:
    """A load moved by less than a cell, m: what each cell holds is shared with the next, by the part of a cell.

    Force and middle are kept; the square of its extent grows by a quarter of a cell's square at most.
    """
    grid = load.grid
    fields = np.pad(load.array, ((0, 0), (1, 1), (1, 1)))
    for axis, part in ((1, off_y / grid.dy), (2, off_x / grid.dx)):
        fields = (1 - abs(part)) * fields + abs(part) * np.roll(fields, int(np.sign(part)), axis=axis)
    wider = Grid(grid.nx + 2, grid.ny + 2, grid.dx, grid.dy, grid.x0 - grid.dx, grid.y0 - grid.dy)
    return replace(load, grid=wider, pressure=fields[0], traction_x=fields[1], traction_y=fields[2])
