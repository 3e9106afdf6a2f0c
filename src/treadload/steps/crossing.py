"""The wheel over a step, a joint or a plate."""

from __future__ import annotations

import itertools
import math
from typing import Annotated, ClassVar, Literal

from pydantic import model_validator

from treadload.case.choices import TIRE_MATERIAL
from treadload.case.description import Description
from treadload.case.step import Step, numbers_of
from treadload.contact import Contact, Crossing, Rolling, cross_obstacle
from treadload.contact.crossing import MOST_POSITIONS
from treadload.contact.crossing_fields import STRIDE
from treadload.deferred import xarray as xr
from treadload.errors import positive
from treadload.materials import Prony
from treadload.pavement import Relief, RoadJoint, RoadPlate, RoadStep
from treadload.read import As, TargetTable
from treadload.steps.outline import PRESSED, Outline
from treadload.steps.scene import Scene
from treadload.units import Length


class CrossingStep(Step, name="crossing"):
    """`[crossing]`: the wheel over one obstacle, position by position, see `treadload.contact.cross_obstacle`.

    step: a road that changes its height. joint: a gap straight across. plate: what stands above the road or lies
    below it, such as a bump or the frame of a manhole. positions: of the axle along travel, the obstacle's middle at
    0, ascending; left out, from clear of it to clear of it, every fourth cell. hold: "load" lets the axle rise and
    sink with the road; "axle" keeps it at its height on the plane. spacing: of the cells; left out, that of the case.
    sliding: true to follow shear as well, under the friction and forces of `[rolling]`; false leaves it out, and the
    pressures are the same.

    >>> wheel = {"tire": {"profile": "315/80R22.5"}, "rolling": {"normal_load": "32.5 kN", "friction": 0.7}}
    >>> road = {"pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3", "temperature": 15}}
    >>> tl.Case.from_dict(wheel | road | {"crossing": {}})
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: case: crossing: give one obstacle, step, joint or plate, got none; each is a
        case of its own
    """

    one_of: ClassVar = ("step", "joint", "plate")
    swept: ClassVar = True

    step: Annotated[TargetTable, As(RoadStep)] | None = None
    joint: Annotated[TargetTable, As(RoadJoint)] | None = None
    plate: Annotated[TargetTable, As(RoadPlate)] | None = None
    positions: tuple[Length, ...] | None = None
    hold: Literal["load", "axle"] = "load"
    spacing: Length | None = None
    sliding: bool = False

    @model_validator(mode="after")
    def _one_obstacle(self) -> CrossingStep:
        kinds = [name for name in self.one_of if getattr(self, name) is not None]
        if len(kinds) != 1:
            what = " and ".join(kinds) or "none"
            raise ValueError(f"give one obstacle, step, joint or plate, got {what}; each is a case of its own")
        self.build()
        if self.spacing is not None:
            positive("spacing", self.spacing, "metres", "leave it out for that of the case")
        if self.positions is not None:
            self._check(self.positions)
        return self

    def _check(self, positions: tuple[float, ...]) -> None:
        if not 1 <= len(positions) <= MOST_POSITIONS:
            raise ValueError(f"give 1 to {MOST_POSITIONS} positions, got {len(positions)}; or leave them out")
        for before, after in itertools.pairwise(positions):
            if not after > before:
                raise ValueError(f"positions must ascend, got {before:g} m and then {after:g} m; put them in order")

    def build(self) -> Relief:
        """The obstacle."""
        obstacle = next(part for part in (self.step, self.joint, self.plate) if part is not None)
        relief: Relief = obstacle.build()
        return relief

    def rolling(self, wheel: Rolling) -> Rolling:
        """What the wheel does on its way: all that the case states, or its load alone."""
        return wheel if self.sliding else Rolling(normal_load=wheel.normal_load, friction=0.0, speed=wheel.speed)

    def check(self, case: Description) -> None:
        """Refuse what does not fit the rest of the case."""
        if case.rolling is None:
            raise ValueError("[crossing] needs a wheel, and this case has a footprint; give tire and rolling")
        wheel = case.build_rolling()
        if wheel.normal_load is None:
            raise ValueError("[crossing] needs rolling.normal_load; an approach is that of one position only")
        if self.sliding and wheel.law.needs_speed:
            raise ValueError(
                f"crossing.sliding does not follow friction that falls with slip, {wheel.law}; give a number, or "
                "leave sliding out"
            )
        if case.tire is not None and isinstance(TIRE_MATERIAL.build(case.tire.material), Prony):
            raise ValueError("[crossing] knows elastic tires only; give tire.material an elastic modulus")

    def solve(self, scene: Scene) -> Crossing:
        """The way of the wheel over the obstacle, position by position."""
        case, contact = scene.case, scene.result("contact")
        assert isinstance(contact, Contact)
        return cross_obstacle(
            contact.tire, scene.loaded.road, self.rolling(contact.rolling), self.build(), positions=self.positions,
            hold=self.hold, spacing=case.spacing if self.spacing is None else self.spacing,
            tolerance=case.source.tolerance_of(case), road_compliance=case.road_compliance, progress=scene.tell,
        )  # fmt: skip

    def numbers(self, scene: Scene) -> xr.Dataset:
        """Those of the way, and the peaks over its positions."""
        way = scene.result("crossing")
        assert way is not None
        peaks = {f"max_{name}": float(way.dataset[name].max()) for name in ("largest_pressure", "edge_pressure")}
        return numbers_of(way.dataset).assign(peaks)

    def plan(self, outline: Outline) -> None:
        """The obstacle and the number of positions; as many contacts."""
        count = len(self.positions or ()) or self._positions(outline)
        about = "" if self.positions else "about "
        outline.add("crossing", f"{self.build()}; {about}{count:.0f} positions")
        outline.contacts += count * (1.0 if self.sliding else PRESSED)

    def _positions(self, outline: Outline) -> int:
        """About how many there are where none is named: half a contact clear on both sides, a stride apart."""
        edges, grid = getattr(self.build(), "edges", (0.0,)), outline.grid
        way = max(edges) - min(edges) + 1.25 * grid.nx * grid.dx
        return math.ceil(way / (STRIDE * (self.spacing or grid.dx)))
