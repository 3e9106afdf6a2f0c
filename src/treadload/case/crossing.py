"""A case's wheel over a step, a joint or a plate."""

from __future__ import annotations

import itertools
from typing import Annotated, ClassVar, Literal

from pydantic import model_validator

from treadload.contact import Rolling
from treadload.contact.crossing import MOST_POSITIONS
from treadload.errors import positive
from treadload.pavement import Relief, RoadJoint, RoadPlate, RoadStep
from treadload.read import As, Made, Table
from treadload.units import Length


class CrossingPart(Table):
    """`[crossing]`: the wheel over one obstacle, position by position, see `treadload.contact.cross_obstacle`.

    step: a road that changes its height. joint: a gap straight across. plate: what stands above the road or lies
    below it, such as a bump or the frame of a manhole. positions: of the axle along travel, the obstacle's middle at
    0, ascending; left out, from clear of it to clear of it, every fourth cell. hold: "load" lets the axle rise and
    sink with the road; "axle" keeps it at its height on the plane. spacing: of the cells; left out, that of the case.
    sliding: true to follow shear as well, under the friction and forces of `[rolling]`; false leaves it out, and the
    pressures are the same.
    """

    one_of: ClassVar = ("step", "joint", "plate")

    step: Annotated[Made, As(RoadStep)] | None = None
    joint: Annotated[Made, As(RoadJoint)] | None = None
    plate: Annotated[Made, As(RoadPlate)] | None = None
    positions: tuple[Length, ...] | None = None
    hold: Literal["load", "axle"] = "load"
    spacing: Length | None = None
    sliding: bool = False

    @model_validator(mode="after")
    def _one_obstacle(self) -> CrossingPart:
        given = [name for name in self.one_of if getattr(self, name) is not None]
        if len(given) != 1:
            what = " and ".join(given) or "none"
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
        made = next(part for part in (self.step, self.joint, self.plate) if part is not None)
        relief: Relief = made.build()
        return relief

    def rolling(self, wheel: Rolling) -> Rolling:
        """What the wheel does on its way: all that the case says, or its load alone."""
        return wheel if self.sliding else Rolling(normal_load=wheel.normal_load, friction=0.0, speed=wheel.speed)

    def check(self, wheel: Rolling | None) -> None:
        """Refuse what does not fit the rest of the case. wheel: its rolling state."""
        if wheel is None:
            raise ValueError("[crossing] needs a wheel, and this case has a footprint; give tire and rolling")
        if wheel.normal_load is None:
            raise ValueError("[crossing] needs rolling.normal_load; an approach is that of one position only")
        if self.sliding and wheel.law.needs_speed:
            raise ValueError(
                f"crossing.sliding does not follow friction that falls with slip, {wheel.law}; give a number, or "
                "leave sliding out"
            )
