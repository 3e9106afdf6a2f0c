"""What a case would solve, without solving it: cells, points, contacts, and about how long."""

from __future__ import annotations

import math
import time
from functools import cached_property

import numpy as np

from treadload.case import Case
from treadload.contact.bodies.choose import Pair
from treadload.contact.contact_grid import place
from treadload.contact.relief import above
from treadload.grid import Grid
from treadload.kernels import fft
from treadload.pavement import Pavement
from treadload.response import GridLoad, map_grid

PRESSED = 0.1
"""Share of a contact's time that its pressure takes."""
# Time over that of one transform of _SIDE² numbers, as measured on contacts of 800 to 12 000 cells: a contact and a
# cell of it, a point of the maps, one of the slices.
_SIDE = 512
_CONTACT, _CELL = 100.0, 0.04
_MAP = {"half-space": 0.006, "layers": 0.012, "viscoelastic": 0.12}
_SLICE = {"half-space": 0.15, "layers": 0.35, "viscoelastic": 6.0}


class Outline:
    """The work of the steps of a case, in words.

    lines: of the plan. warnings: sentences. contacts: how many are solved, 1 the case's own. mapped, sliced: points
    of maps and slices. estimate: of the time, in words, where it does not follow from these.

    >>> wheel = {"tire": {"profile": "315/80R22.5"}, "rolling": {"normal_load": "32.5 kN", "friction": 0.7}}
    >>> case = tl.Case.from_dict(wheel | {"pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3", "temperature": 15}})
    >>> outline = tl.steps.Outline(case)
    >>> outline.add("contact", "15 x 15 cells")
    >>> outline.lines
    ['contact   15 x 15 cells']
    """

    def __init__(self, case: Case) -> None:
        self.case = case
        self.lines: list[str] = []
        self.warnings: list[str] = []
        self.contacts, self.mapped, self.sliced = 0.0, 0, 0
        self.estimate = ""

    def add(self, name: str, text: str) -> None:
        """A line with its name."""
        self.lines.append(f"{name:<9} {text}")

    @cached_property
    def road(self) -> Pavement:
        """The road of the case, stress-dependent layers under the stress of a usual truck."""
        return self.case.road().at_nominal_stress

    @cached_property
    def wheel(self) -> GridLoad:
        """The load of one wheel: a recorded one, or an empty one where the contact would lie."""
        case = self.case
        if case.footprint is not None:
            load: GridLoad = case.footprint.build(case.folder)
            return load
        tire, rolling, relief = case.build_tire(), case.build_rolling(), case.build_relief()
        if rolling.normal_load is not None:
            rolling.check_friction_limit(rolling.normal_load)
        pair = Pair.of(tire, self.road, speed=rolling.speed).both
        grid, _ = place(tire if relief is None else above(tire, relief), rolling, pair, case.spacing)
        return GridLoad(grid, np.zeros(grid.shape))

    @property
    def grid(self) -> Grid:
        """The cells of the load."""
        return self.wheel.grid

    @cached_property
    def wheels(self) -> list[GridLoad]:
        """The loads of all wheels in their places."""
        placed: list[GridLoad] = self.case.response.place(self.wheel)
        return placed

    @cached_property
    def map_cells(self) -> Grid:
        """The points of the maps."""
        return map_grid(self.wheels, self.road)

    def time(self) -> str:
        """About how long the case takes on this machine, in words; "" where nothing is known of it."""
        if self.estimate or not (self.contacts or self.mapped or self.sliced):
            return self.estimate
        cells = self.grid.nx * self.grid.ny if self.contacts else 0
        seconds = seconds_of(self.road, cells, self.mapped, self.sliced, self.contacts)
        shown = (
            f"{seconds:.1g} s" if seconds < 10 else f"{seconds:.2g} s" if seconds < 100 else f"{seconds / 60:.2g} min"
        )
        return f"about {shown} on this machine, within a factor of three or so"


def seconds_of(road: Pavement, cells: int, mapped: int, sliced: int, contacts: float = 1.0) -> float:
    """About how long a case takes on this machine, s.

    cells: of a contact. mapped, sliced: points of maps and slices. contacts: how many.
    """
    kind = "viscoelastic" if road.is_viscoelastic else "half-space" if road.is_homogeneous else "layers"
    contact = (_CONTACT + _CELL * cells) if cells else 0.0
    return _transform() * (contacts * contact + _MAP[kind] * mapped + _SLICE[kind] * sliced)


def _transform() -> float:
    """Seconds of one transform, the best of a few."""
    field = np.ones((_SIDE, _SIDE))
    best = math.inf
    for _ in range(5):
        start = time.perf_counter()
        fft.rfft2(field)
        best = min(best, time.perf_counter() - start)
    return best
