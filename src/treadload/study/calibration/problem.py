"""The question of a calibration, and what a tire with other numbers would have read."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from treadload.composing import BaseResult
from treadload.contact import Rolling, solve_contact
from treadload.contact.bodies.body import Body
from treadload.contact.bodies.choose import Pair
from treadload.contact.bodies.influence import Influence
from treadload.contact.solve import BorderError, check_border, place
from treadload.contact.solvers.normal import solve_normal
from treadload.errors import ConvergenceError, InputError, TreadloadError, one_line
from treadload.footprint.measured import FRICTION, READINGS, Measured, Unknown
from treadload.footprint.measures import shares
from treadload.footprint.registration import cut_off, seen
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.pavement import Pavement
from treadload.response import GridLoad
from treadload.results.questions import Writer
from treadload.study.calibration.blocks import Blocks
from treadload.study.calibration.extents import extents
from treadload.study.tire_card import tire_card
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
        for one, value in zip(self.sought, values, strict=True):
            if one.name == FRICTION:
                friction = float(value)
            else:
                tire = NUMBERS[one.name].put(tire, float(value))
        return tire, friction

    @cached_property
    def readings(self) -> tuple[tuple[int, str, int], ...]:
        """(row, kind, number) of every reading: a kind with several numbers, as shares of ribs, has several."""
        return tuple(
            (row, name, k)
            for row, one in enumerate(self.data)
            for name in one.readings
            for k in range(len(self.measured_of(row, name)))
        )

    def measured_of(self, row: int, name: str) -> Array:
        """What was read of a kind in a row, SI: (numbers,)."""
        if name == "footprint":
            return self.blocks[row].measured
        return np.atleast_1d(np.asarray(getattr(self.data[row], name), dtype=float))

    @cached_property
    def blocks(self) -> Mapping[int, Blocks]:
        """Blocks of the rows that have a footprint."""
        return {row: Blocks.of(one.footprint) for row, one in enumerate(self.data) if one.footprint is not None}

    @cached_property
    def fingerprint(self) -> str:
        """Equal where equal numbers give equal readings: of the question, without the values that were read."""
        asked = ("load", "inflation_pressure", "ribs", "creepage_x", "creepage_y", "footprint")
        writer = Writer(lambda result: _digest(result))
        told = {
            "tire": writer.value(self.tire),
            "road": writer.value(self.road),
            "sought": [one.name for one in self.sought],
            "data": [[*one.readings, *(writer.value(getattr(one, name)) for name in asked)] for one in self.data],
            "numbers": [self.friction, self.spacing, self.tolerance],
        }
        digest = hashlib.sha256(json.dumps(told, sort_keys=True).encode())
        for values in writer.arrays.values():
            digest.update(np.ascontiguousarray(values).tobytes())
        return digest.hexdigest()


def inflated(tire: Tire, asked: Measured) -> Tire:
    """The tire at the pressure of a row."""
    return tire if asked.inflation_pressure is None else replace(tire, inflation_pressure=asked.inflation_pressure)


def _digest(result: BaseResult) -> str:
    digest = hashlib.sha256()
    for name in sorted(map(str, result.dataset.variables)):
        digest.update(name.encode() + np.ascontiguousarray(result.dataset[name].to_numpy()).tobytes())
    return digest.hexdigest()


class Model:
    """What the readings of a row would be with other numbers. Grids and pressures are kept from call to call."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self._grids: dict[int, Grid] = {}
        self._pressures: dict[int, Array] = {}

    def readings(self, values: Sequence[float], row: int) -> Array:
        """All readings of a row, SI, in the order of the problem.

        Raises ConvergenceError and InputError that say at which numbers.
        """
        problem = self.problem
        try:
            tire, friction = problem.at(values)
            return self._readings(tire, friction, row)
        except TreadloadError as error:
            told = ", ".join(f"{one.name} = {value:.6g}" for one, value in zip(problem.sought, values, strict=True))
            said = (
                f"with {told}: {one_line(str(error))}; bound the numbers sought (low, high) so that this is not tried"
            )
            kind = ConvergenceError if isinstance(error, ConvergenceError) else InputError
            raise kind(said) from error

    def _readings(self, tire: Tire, friction: float, row: int) -> Array:
        asked = self.problem.data[row]
        tire = inflated(tire, asked)
        kinds = {READINGS[name].how for name in asked.readings}
        found: dict[str, Any] = {}
        if "print" in kinds:
            found |= self._print(tire, row)
        if "card" in kinds:
            found |= self._card(tire, asked)
        if "rolling" in kinds:
            found |= self._rolling(tire, friction, asked)
        return np.concatenate([np.atleast_1d(np.asarray(found[name], dtype=float)) for name in asked.readings])

    def pressed(self, tire: Tire, row: int) -> tuple[Array, Grid, float]:
        """Pressure, Pa, its cells, and the approach, m, of a standing tire without friction under a row's load."""
        bodies = Pair.of(tire, self.problem.road).both
        known = self._grids.get(row)
        if known is not None:
            # A grid that was made for other numbers may have become too small.
            with suppress(BorderError):
                return self._on(known, bodies, tire, row)
        self._pressures.pop(row, None)
        return self._on(self._placed(tire, bodies, row), bodies, tire, row)

    def _on(self, grid: Grid, bodies: Body, tire: Tire, row: int) -> tuple[Array, Grid, float]:
        solved = solve_normal(
            Influence(grid.shape, grid.dx, grid.dy, bodies),
            tire.height_map(grid),
            load=self.problem.data[row].load,
            start=self._pressures.get(row),
            tolerance=self.problem.tolerance,
        )
        check_border(solved.pressure, grid)
        self._grids[row], self._pressures[row] = grid, solved.pressure
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

    def _print(self, tire: Tire, row: int) -> dict[str, Any]:
        asked = self.problem.data[row]
        pressure, grid, approach = self.pressed(tire, row)
        found: dict[str, Any] = {"deflection": approach}
        if {"net_area", "gross_area", "length", "width"} & set(asked.readings):
            told = extents(pressure, grid.x, grid.y, grid.dx, grid.dy)
            found |= {name: getattr(told, name) for name in ("net_area", "gross_area", "length", "width")}
        total = float(pressure.sum())
        for name, places, axis in (("spread_x", grid.x, 0), ("spread_y", grid.y, 1)):
            along = pressure.sum(axis=axis) / total
            centre = float((along * places).sum())
            found[name] = float(np.sqrt((along * (places - centre) ** 2).sum()))
        if asked.ribs is not None:
            across = np.broadcast_to(grid.y[:, None], pressure.shape)
            found["rib_shares"] = shares(pressure, across, np.asarray(asked.ribs))
        if asked.footprint is not None:
            found["footprint"] = self._through(pressure, grid, row)
        return found

    def _through(self, pressure: Array, grid: Grid, row: int) -> Array:
        """Shares of blocks as the sensor tells them, its middle of pressure laid on the computed one."""
        blocks, sensor = self.problem.blocks[row], self.problem.data[row].footprint
        load = GridLoad(grid, pressure)
        total = float(pressure.sum())
        x = float((pressure.sum(axis=0) * grid.x).sum()) / total
        y = float((pressure.sum(axis=1) * grid.y).sum()) / total
        sensels = replace(
            sensor.grid, x0=sensor.grid.x0 + x - blocks.centre[0], y0=sensor.grid.y0 + y - blocks.centre[1]
        )
        told = cut_off(seen(load, sensels, 0.0), sensor.threshold, sensor.saturation)
        return blocks.shares(np.where(sensor.sensels, told, 0.0))

    def _card(self, tire: Tire, asked: Measured) -> dict[str, Any]:
        slopes = set(asked.readings) - {"effective_rolling_radius"}
        assert asked.load is not None
        card = tire_card(
            tire,
            self.problem.road,
            [asked.load],
            stiffness=any(READINGS[name].how == "card" for name in slopes),
            spacing=self.problem.spacing,
            tolerance=_ROLLING_TOLERANCE,
        ).dataset
        names = [name for name in asked.readings if READINGS[name].how == "card"]
        return {name: float(card[name].to_numpy().ravel()[0]) for name in names}

    def _rolling(self, tire: Tire, friction: float, asked: Measured) -> dict[str, Any]:
        state = Rolling(
            normal_load=asked.load, friction=friction, creepage_x=asked.creepage_x, creepage_y=asked.creepage_y
        )
        found = solve_contact(
            tire, self.problem.road, state, spacing=self.problem.spacing, tolerance=_ROLLING_TOLERANCE
        ).dataset
        names = [name for name in asked.readings if READINGS[name].how == "rolling"]
        return {name: float(found[name]) for name in names}
