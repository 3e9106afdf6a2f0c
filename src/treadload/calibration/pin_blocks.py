"""Readings of pins as shear over load in blocks: what a fit follows in place of single pins.

A pin at the wall of a rib reads what its place makes of the steepest part of the shear. A block holds the pins of a
third of a rib during a fifth of the load: its shear over its load does not ask how a pin was calibrated, nor how the
load is spread over the ribs.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from treadload.calibration.blocks import equal_parts
from treadload.errors import InputError
from treadload.footprint.footprint import Footprint
from treadload.footprint.registration import register_pins, through
from treadload.footprint.thirds import THIRDS, thirds
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.kernels.gridding.overlap import overlaps
from treadload.response import GridLoad
from treadload.tire import ProfileSurface, Tire

# Parts of equal load along travel.
_ALONG = 5
# Blocks that carry less than this part of the mean one have a ratio of noise.
_LEAST = 0.1
# Cells across of ribs that press alike, m.
_FINE = 1e-3


@dataclass(frozen=True, eq=False)
class PinBlocks:
    """Blocks of the readings of a table of pins.

    sensor: the pins, moved across to where the ribs put them. which: (ny, nx), number of the block of a reading,
    -1 of none. names: of the blocks, in words. measured: (2 blocks,), shear along travel, then to the right, of each
    block over its load.
    """

    sensor: Footprint
    which: NDArray[np.int64]
    names: tuple[str, ...]
    measured: Array

    @classmethod
    def of(cls, sensor: Footprint, faces: Array) -> PinBlocks:
        """Blocks of pins under ribs with these faces (ribs, 2), m; the pins are moved across to where they fit these
        best.

        Raises InputError where no pin is under a rib.
        """
        sensor = sensor.moved(0.0, register_pins(_uniform(faces, sensor), sensor).shift_y)
        places, there = sensor.grid, sensor.sensels
        read = np.where(there, np.maximum(sensor.pressure, 0.0), 0.0)
        along = read.sum(axis=0)
        part = np.searchsorted(equal_parts(along, places.x, places.dx, _ALONG), places.x)
        which = np.full(places.shape, -1, dtype=np.int64)
        names: list[str] = []
        for rib, parts in enumerate(thirds(faces)):
            for third, (left, right) in enumerate(parts):
                rows = np.flatnonzero((places.y >= left) & (places.y < right))
                for k in range(_ALONG):
                    here = np.zeros(places.shape, dtype=bool)
                    here[np.ix_(rows, np.flatnonzero(part == k))] = True
                    here &= there
                    if read[here].sum() > _LEAST * read.sum() / (_ALONG * 3 * len(faces)):
                        which[here] = len(names)
                        names.append(f"{THIRDS[third]} third of rib {rib + 1}, part {k + 1} from the rear")
        if not names:
            raise InputError(
                f"no pin is under a rib: they are {places.dy * 1e3:.3g} mm apart and the widest rib is "
                f"{float(np.diff(faces).max()) * 1e3:.3g} mm wide; measure with pins closer together"
            )
        blocks = cls(sensor, which, tuple(names), np.zeros(0))
        return cls(sensor, which, tuple(names), blocks.ratios(sensor.load.array))

    def ratios(self, stress: Array) -> Array:
        """(2 blocks,): shear along travel, then to the right, over load. stress: (3, ny, nx) of the pins, Pa."""
        inside = self.which >= 0
        sums = [np.bincount(self.which[inside], weights=part[inside], minlength=len(self.names)) for part in stress]
        load = np.where(sums[0] > 0, sums[0], np.inf)
        both: Array = np.concatenate([sums[1] / load, sums[2] / load])
        return both

    def computed(self, load: GridLoad) -> Array:
        """The same of a computed load, the pins moved to where they read its pressure best."""
        placed = register_pins(load, self.sensor, 0.0)
        return self.ratios(through(load, self.sensor.moved(placed.shift_x, placed.shift_y)))

    def name(self, number: int) -> str:
        """Which reading a number is, in words."""
        way = "along travel" if number < len(self.names) else "lateral"
        return f"{way}, {self.names[number % len(self.names)]}"


def faces_of(tire: Tire) -> Array:
    """(ribs, 2) left and right end of the ribs of a tire, m. Raises InputError where none are known."""
    groups = tire.ribs
    if groups:
        return np.array([face for group in groups for face in group.faces])
    if not isinstance(tire.surface, ProfileSurface):
        raise InputError(
            "pins need to know where the ribs of the tire are, and this surface is no profile; give a TreadProfile, "
            "or "
            "the map of pressure as footprint"
        )
    profile = tire.surface.profile
    half = 0.5 * profile.width
    walls = [groove.centre + side * groove.width for groove in profile.grooves for side in (-0.5, 0.5)]
    return np.array(sorted([-half, *walls, half])).reshape(-1, 2)


def _uniform(faces: Array, sensor: Footprint) -> GridLoad:
    """Ribs that press alike over the length of a footprint: they determine where pins stood under them."""
    read = np.where(sensor.sensels, np.maximum(sensor.pressure, 0.0), 0.0).sum(axis=0)
    at = np.flatnonzero(read > 0)
    length = float(sensor.grid.x[at[-1]] - sensor.grid.x[at[0]]) + sensor.grid.dx
    left, right = float(faces[0, 0]), float(faces[-1, 1])
    count = int(np.ceil((right - left) / _FINE))
    step = (right - left) / count
    cells = left + step * np.arange(count + 1)
    share = np.array([overlaps(cells, face)[:, 0] for face in faces]).sum(axis=0)[:, None] / step
    middle = 0.5 * float(sensor.grid.x[at[0]] + sensor.grid.x[at[-1]])
    return GridLoad(Grid(1, count, length, step, middle, left + 0.5 * step), share)
