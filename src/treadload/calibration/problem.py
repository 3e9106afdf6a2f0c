"""The question of a calibration, and what a tire with other numbers would have read."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext, suppress
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from treadload.calibration.blocks import Blocks
from treadload.calibration.extents import extents
from treadload.calibration.pin_blocks import PinBlocks, faces_of
from treadload.composing import BaseResult
from treadload.contact import Contact, Rolling, solve_contact
from treadload.contact.bodies.body import Body
from treadload.contact.bodies.choose import Pair
from treadload.contact.bodies.influence import Influence
from treadload.contact.bodies.section_tables import interpolated
from treadload.contact.contact_grid import BorderError, check_border, place
from treadload.contact.solvers.normal import solve_normal
from treadload.errors import ConvergenceError, InputError, TreadloadError, one_line
from treadload.footprint.measured import FRICTION, READINGS, Measured, Unknown
from treadload.footprint.measures import shares
from treadload.footprint.registration import cut_off, seen
from treadload.footprint.tire_card import tire_card
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.pavement import Pavement
from treadload.response import GridLoad
from treadload.results.questions import Writer
from treadload.tire import Tire
from treadload.tire.numbers import NUMBERS

# Cells added on each side of the grid that the first contact needs, so that the next ones, wider, find room.
_ROOM = 3
# Rolling is solved less sharply than pressure: its slopes need no more, see `steps`.
_ROLLING_TOLERANCE = 1e-6


@dataclass(frozen=True, eq=False)
class Problem:
    """What is asked.

    sought: numbers. data: rows, their footprints read. friction: that there is before it is fitted. errors: of rows
    without their own. spacing: of cells, m. tolerance: of normal contact.
    """

    tire: Tire
    road: Pavement
    sought: tuple[Unknown, ...]
    data: tuple[Measured, ...]
    friction: float
    errors: Mapping[str, float | str]
    spacing: float | None
    tolerance: float

    def at(self, values: Sequence[float] | Array) -> tuple[Tire, float]:
        """The tire and the friction with these numbers, SI. Raises InputError for numbers no tire can have."""
        tire, friction = self.tire, self.friction
        for unknown, value in zip(self.sought, values, strict=True):
            if unknown.name == FRICTION:
                friction = float(value)
            else:
                tire = NUMBERS[unknown.name].put(tire, float(value))
        return tire, friction

    @cached_property
    def readings(self) -> tuple[tuple[int, str, int], ...]:
        """(row, kind, number) of every reading: a kind with several numbers, as shares of ribs, has several."""
        return tuple(
            (row, name, k)
            for row, measured in enumerate(self.data)
            for name in measured.readings
            for k in range(len(self.measured_of(row, name)))
        )

    def measured_of(self, row: int, name: str) -> Array:
        """What was read of a kind in a row, SI: (numbers,)."""
        if name == "footprint":
            return self.blocks[row].measured
        if name == "pins":
            return self.pin_blocks[row].measured
        return np.atleast_1d(np.asarray(getattr(self.data[row], name), dtype=float))

    @cached_property
    def blocks(self) -> Mapping[int, Blocks]:
        """Blocks of the rows that have a footprint."""
        return {
            row: Blocks.of(measured.footprint)
            for row, measured in enumerate(self.data)
            if measured.footprint is not None
        }

    @cached_property
    def pin_blocks(self) -> Mapping[int, PinBlocks]:
        """Blocks of the rows that have pins, on the ribs of the initial tire."""
        return {
            row: PinBlocks.of(measured.pins, faces_of(self.tire))
            for row, measured in enumerate(self.data)
            if measured.pins is not None
        }

    def rolled(self, tire: Tire, friction: float, row: int, start: Contact | None = None) -> Contact:
        """The contact of a tire that rolls over the pins of a row: freely, or at the row's creepages."""
        measured = self.data[row]
        state = Rolling(
            normal_load=measured.load, friction=friction, creepage_x=measured.creepage_x,
            creepage_y=measured.creepage_y,
        )  # fmt: skip
        return solve_contact(
            inflated(tire, measured),
            self.road,
            state,
            spacing=self.spacing,
            tolerance=_ROLLING_TOLERANCE,
            start=start,
        )

    @property
    def tables(self) -> AbstractContextManager[None]:
        """Tables of ribs between the bounds of ν where that is sought, as few as serve all; else as they are."""
        sought = next((unknown for unknown in self.sought if unknown.name == "poisson"), None)
        if sought is None or self.tire.tread != "ribs":
            return nullcontext()
        _, low, high = sought.on(self.tire, self.friction)
        return interpolated(low, high)

    @cached_property
    def fingerprint(self) -> str:
        """Equal where equal numbers give equal readings: of the question, without the values that were read."""
        fields_hashed = ("load", "inflation_pressure", "ribs", "creepage_x", "creepage_y", "footprint", "pins")
        writer = Writer(lambda result: _digest(result))
        content = {
            "tire": writer.value(self.tire),
            "road": writer.value(self.road),
            "sought": [unknown.name for unknown in self.sought],
            "data": [
                [
                    *measured.readings,
                    *(writer.value(getattr(measured, name)) for name in fields_hashed),
                    *(() if measured.pins is None else measured.pins.pin),
                ]
                for measured in self.data
            ],
            "numbers": [self.friction, self.spacing, self.tolerance],
        }
        digest = hashlib.sha256(json.dumps(content, sort_keys=True).encode())
        for values in writer.arrays.values():
            digest.update(np.ascontiguousarray(values).tobytes())
        return digest.hexdigest()


def inflated(tire: Tire, measured: Measured) -> Tire:
    """The tire at the pressure of a row."""
    return (
        tire if measured.inflation_pressure is None else replace(tire, inflation_pressure=measured.inflation_pressure)
    )


def _digest(result: BaseResult) -> str:
    digest = hashlib.sha256()
    for name in sorted(map(str, result.dataset.variables)):
        digest.update(name.encode() + np.ascontiguousarray(result.dataset[name].to_numpy()).tobytes())
    return digest.hexdigest()


class Model:
    """What the readings of a row would be with other numbers.

    Every contact starts from the pressure of the initial tire, on its grid, so a reading depends on its numbers alone
    and not on the points evaluated before: a resumed search gives the same digits.
    """

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self._initials: dict[int, tuple[Grid, Array] | None] = {}
        self._rolled: dict[int, Contact] = {}

    def readings(self, values: Sequence[float], row: int) -> Array:
        """All readings of a row, SI, in the order of the problem.

        Raises ConvergenceError and InputError that state the numbers of the tire at which it happened.
        """
        problem = self.problem
        try:
            tire, friction = problem.at(values)
            with problem.tables:
                return self._readings(tire, friction, row)
        except TreadloadError as error:
            where = ", ".join(
                f"{unknown.name} = {value:.6g}" for unknown, value in zip(problem.sought, values, strict=True)
            )
            text = (
                f"with {where}: {one_line(str(error))}; bound the numbers sought (low, high) so that this is not "
                "tried"
            )
            kind = ConvergenceError if isinstance(error, ConvergenceError) else InputError
            raise kind(text) from error

    def _readings(self, tire: Tire, friction: float, row: int) -> Array:
        measured = self.problem.data[row]
        tire = inflated(tire, measured)
        kinds = {READINGS[name].how for name in measured.readings}
        values_by_name: dict[str, Any] = {}
        if "print" in kinds:
            values_by_name |= self._print(tire, row)
        if "card" in kinds:
            values_by_name |= self._card(tire, measured)
        if "rolling" in kinds:
            values_by_name |= self._rolling(tire, friction, measured)
        if "pins" in kinds:
            rolled = GridLoad.from_dataset(self.rolled(tire, friction, row))
            values_by_name["pins"] = self.problem.pin_blocks[row].computed(rolled)
        return np.concatenate(
            [np.atleast_1d(np.asarray(values_by_name[name], dtype=float)) for name in measured.readings]
        )

    def pressed(self, tire: Tire, row: int) -> tuple[Array, Grid, float]:
        """Pressure, Pa, its cells, and the approach, m, of a standing tire without friction under a row's load."""
        bodies = Pair.of(tire, self.problem.road).both
        initial = self._initial(row)
        if initial is not None:
            # A grid that was made for other numbers may be too small.
            with suppress(BorderError):
                return self._on(initial[0], bodies, tire, row, start=initial[1])
        return self._on(self._placed(tire, bodies, row), bodies, tire, row)

    def rolled(self, tire: Tire, friction: float, row: int) -> Contact:
        """The contact of a tire that rolls over the pins of a row, begun at that of the initial tire."""
        if row not in self._rolled:
            self._rolled[row] = self.problem.rolled(self.problem.tire, self.problem.friction, row)
        return self.problem.rolled(tire, friction, row, self._rolled[row])

    def _initial(self, row: int) -> tuple[Grid, Array] | None:
        """Grid and pressure, Pa, of the initial tire in a row; None where its contact fails."""
        if row not in self._initials:
            try:
                tire = inflated(self.problem.tire, self.problem.data[row])
                bodies = Pair.of(tire, self.problem.road).both
                pressure, grid, _ = self._on(self._placed(tire, bodies, row), bodies, tire, row)
                self._initials[row] = grid, pressure
            except TreadloadError:
                self._initials[row] = None
        return self._initials[row]

    def _on(
        self, grid: Grid, bodies: Body, tire: Tire, row: int, start: Array | None = None
    ) -> tuple[Array, Grid, float]:
        solved = solve_normal(
            Influence(grid.shape, grid.dx, grid.dy, bodies, grid.y0),
            tire.height_map(grid),
            load=self.problem.data[row].load,
            start=start,
            tolerance=self.problem.tolerance,
        )
        check_border(solved.pressure, grid)
        return solved.pressure, grid, solved.approach

    def _placed(self, tire: Tire, bodies: Body, row: int) -> Grid:
        """A grid for the contact, with room for those of other numbers where the tread is known."""
        state = Rolling(normal_load=self.problem.data[row].load, friction=0.0)
        grid, _ = place(tire, state, bodies, self.problem.spacing)
        if tire.fixed_grid is not None:
            return grid
        step, (length, width) = grid.dx, tire.extent
        along, across = max(grid.nx * step, length), max(grid.ny * step, width)
        return Grid.on_lattice(
            min((grid.nx + 2 * _ROOM) * step, along), min((grid.ny + 2 * _ROOM) * step, across), step
        )

    def _print(self, tire: Tire, row: int) -> dict[str, object]:
        measured = self.problem.data[row]
        pressure, grid, approach = self.pressed(tire, row)
        values_by_name: dict[str, Any] = {"deflection": approach}
        if {"net_area", "gross_area", "length", "width"} & set(measured.readings):
            sizes = extents(pressure, grid.x, grid.y, grid.dx, grid.dy)
            values_by_name |= {name: getattr(sizes, name) for name in ("net_area", "gross_area", "length", "width")}
        total = float(pressure.sum())
        for name, places, axis in (("spread_x", grid.x, 0), ("spread_y", grid.y, 1)):
            along = pressure.sum(axis=axis) / total
            centre = float((along * places).sum())
            values_by_name[name] = float(np.sqrt((along * (places - centre) ** 2).sum()))
        if measured.ribs is not None:
            across = np.broadcast_to(grid.y[:, None], pressure.shape)
            values_by_name["rib_shares"] = shares(pressure, across, np.asarray(measured.ribs))
        if measured.footprint is not None:
            values_by_name["footprint"] = self._through(pressure, grid, row)
        return values_by_name

    def _through(self, pressure: Array, grid: Grid, row: int) -> Array:
        """Shares of blocks as a sensor measures them, its centre of pressure moved onto the computed one."""
        blocks, sensor = self.problem.blocks[row], self.problem.data[row].footprint
        load = GridLoad(grid, pressure)
        total = float(pressure.sum())
        x = float((pressure.sum(axis=0) * grid.x).sum()) / total
        y = float((pressure.sum(axis=1) * grid.y).sum()) / total
        sensels = replace(
            sensor.grid, x0=sensor.grid.x0 + x - blocks.centre[0], y0=sensor.grid.y0 + y - blocks.centre[1]
        )
        clipped = cut_off(seen(load, sensels, 0.0), sensor.threshold, sensor.saturation)
        return blocks.shares(np.where(sensor.sensels, clipped, 0.0))

    def _card(self, tire: Tire, measured: Measured) -> dict[str, object]:
        slopes = set(measured.readings) - {"effective_rolling_radius"}
        assert measured.load is not None
        card = tire_card(
            tire,
            self.problem.road,
            [measured.load],
            stiffness=any(READINGS[name].how == "card" for name in slopes),
            spacing=self.problem.spacing,
            tolerance=_ROLLING_TOLERANCE,
        ).dataset
        names = [name for name in measured.readings if READINGS[name].how == "card"]
        return {name: float(card[name].to_numpy().ravel()[0]) for name in names}

    def _rolling(self, tire: Tire, friction: float, measured: Measured) -> dict[str, object]:
        state = Rolling(
            normal_load=measured.load,
            friction=friction,
            creepage_x=measured.creepage_x,
            creepage_y=measured.creepage_y,
        )
        data = solve_contact(
            tire, self.problem.road, state, spacing=self.problem.spacing, tolerance=_ROLLING_TOLERANCE
        ).dataset
        names = [name for name in measured.readings if READINGS[name].how == "rolling"]
        return {name: float(data[name]) for name in names}
