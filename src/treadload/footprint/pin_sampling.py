"""What pins would read of a computed contact, and a table of it: data of a known tire, for plans of measurements."""

from __future__ import annotations

import math
import os

import numpy as np

from treadload.errors import InputError, positive
from treadload.files import write_whole
from treadload.footprint.footprint import Footprint, checked_pin
from treadload.footprint.registration import through
from treadload.grid import Grid
from treadload.response import GridLoad

_COLUMNS = "y [mm],x [mm],vertical [kPa],longitudinal [kPa],lateral [kPa]"


def sample_pins(
    load: GridLoad, *, pin: float | tuple[float, float], pitch: float, step: float = 2e-3, offset: float = 0.0
) -> Footprint:
    """The footprint that a row of pins across the road reads while a load rolls over it.

    load: as computed, see `GridLoad.from_dataset` of a contact. pin: side of the square faces, or sides along x and
    y, m. pitch: between pins, m, at least as wide as one. step: of travel between readings, m. offset: of a pin from
    y = 0, m. Readings are means over faces, exact by area, without noise. Raises InputError for pins that overlap.

    >>> load = tl.response.GridLoad(tl.response.Grid.centred(0.16, 0.16, 0.01), [[0] * 4 + [6e5] * 8 + [0] * 4] * 16)
    >>> tl.footprint.sample_pins(load, pin=0.010, pitch=0.008)
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: pins 10 mm wide overlap at a pitch of 8 mm; give a pitch of at least 10 mm
    """
    face = checked_pin(pin if isinstance(pin, tuple) else (pin, pin))
    positive("pitch of the pins", pitch, "m", "17 mm is 0.017")
    positive("step between readings", step, "m", "2 mm is 0.002")
    if pitch < face[1]:
        raise InputError(
            f"pins {face[1] * 1e3:.3g} mm wide overlap at a pitch of {pitch * 1e3:.3g} mm; give a pitch of at least "
            f"{face[1] * 1e3:.3g} mm"
        )
    (left, right), (back, front) = load.extent_y, load.extent_x
    # One more on each side, that the row ends beside the contact.
    first, last = math.ceil((left - offset) / pitch) - 1, math.floor((right - offset) / pitch) + 1
    count = max(2, math.ceil((front - back + 2 * face[0]) / step) + 1)
    middle = 0.5 * (front + back)
    grid = Grid(count, last - first + 1, step, pitch, middle - 0.5 * (count - 1) * step, offset + first * pitch)
    empty = Footprint(GridLoad(grid, np.zeros(grid.shape)), pin=face)
    pressure, along, across = through(load, empty)
    return Footprint(GridLoad(grid, pressure, along, across, source=load.source), pin=face)


def write_pins(footprint: Footprint, path: str | os.PathLike[str], *, comment: str = "") -> None:
    """Write a pin table that `read_footprint` reads: positions in mm, stress in kPa.

    footprint: of pins. comment: lines that state what it is, above the declared layout. Missing readings are left
    empty. Raises InputError for a footprint without pins.

    >>> load = tl.response.GridLoad(tl.response.Grid.centred(0.16, 0.16, 0.01), [[0] * 4 + [6e5] * 8 + [0] * 4] * 16)
    >>> pins = tl.footprint.sample_pins(load, pin=0.010, pitch=0.020, step=0.010)
    >>> tl.footprint.write_pins(pins, folder / "pins.csv")
    >>> f"{tl.footprint.read_footprint(folder / 'pins.csv').peak_pressure / 1e3:.0f} kPa"
    '600 kPa'
    """
    if footprint.pin is None:
        raise InputError(
            "a pin table needs the size of the pins: give a footprint of sample_pins, or one with pin set"
        )
    grid, there = footprint.grid, footprint.sensels
    lines = [f"# {line}" for line in comment.splitlines()]
    lines += ["# pin table: stress of the tire on the road; x ahead, y to the right, compression positive"]
    lines += [f"# pin: {footprint.pin[0] * 1e3:.6g} mm x {footprint.pin[1] * 1e3:.6g} mm", _COLUMNS]
    stress = footprint.load.array / 1e3
    for j, y in enumerate(grid.y):
        for i, x in enumerate(grid.x):
            values = ",".join(f"{value:z.2f}" for value in stress[:, j, i]) if there[j, i] else ",,"
            lines.append(f"{y * 1e3:z.3f},{x * 1e3:z.3f},{values}")
    write_whole(path, "\n".join(lines) + "\n")
