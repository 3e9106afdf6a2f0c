"""What a case wants to know of the road: depths, wheels, speed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from pydantic import model_validator

from treadload.errors import positive
from treadload.read import Table
from treadload.response import GridLoad, place_load
from treadload.units import Length, Speed

# A vertical slice goes this far below the last interface, as a part of its depth, and no deeper than that, m.
_BELOW, _DEEPEST = 1.25, 0.6
_SHALLOW = 0.06


class WheelPart(Table):
    """`{ x = "0 mm", y = "170 mm", mirror = true }`: where a copy of the wheel stands, to the nearest cell.

    x: along travel. y: to the right. mirror: True for its image in the plane y = 0, as the left wheel of an axle is
    of the right one.
    """

    x: Length = 0.0
    y: Length = 0.0
    mirror: bool = False


class ResponsePart(Table):
    """`[response]`: depths of the maps, wheels, speed, and how deep the vertical slices go.

    depths: of the maps, downwards; 0 is the surface. slice_depth: of the vertical slices; left out, 60 mm, on layers
    a quarter below the last interface, 600 mm at most. wheels: copies of the contact, whose responses add up; left
    out, one at the origin. speed: left out, that of [rolling]; a viscoelastic road needs one. side: "above" or
    "below", of an interface that a depth falls on.
    """

    depths: tuple[Length, ...] = (0.0,)
    slice_depth: Length | None = None
    wheels: tuple[WheelPart, ...] = (WheelPart(),)
    speed: Speed | None = None
    side: Literal["above", "below"] = "above"

    @model_validator(mode="after")
    def _downwards(self) -> ResponsePart:
        if not self.depths:
            raise ValueError("depths needs at least one depth, got none; 0 is the surface")
        if min(self.depths) < 0:
            raise ValueError(f"depths must be >= 0, got {min(self.depths):g} m; depth counts downwards")
        if len(set(self.depths)) != len(self.depths):
            raise ValueError(f"depths must differ from each other, got {list(self.depths)} m")
        if self.slice_depth is not None:
            positive("slice_depth", self.slice_depth, "metres", "leave it out for one that suits the road")
        if not self.wheels:
            raise ValueError("wheels needs at least one wheel, got none; leave it out for one at the origin")
        if len(set(self.wheels)) != len(self.wheels):
            raise ValueError("two of the wheels stand at the same place; give each its own x and y")
        if self.speed is not None and self.speed < 0:
            raise ValueError(f"speed must be >= 0 m/s, got {self.speed:g}; a wheel rolls towards positive x")
        return self

    def slices_to(self, interfaces: Sequence[float], *, rigid_base: bool) -> float:
        """Depth of the vertical slices, m, on a road with these interfaces, m; never below a rigid base."""
        if self.slice_depth is not None:
            return self.slice_depth
        if not len(interfaces):
            return _SHALLOW
        last = float(interfaces[-1])
        return min(_DEEPEST, last if rigid_base else _BELOW * last)

    def place(self, wheel: GridLoad) -> list[GridLoad]:
        """Copies of a wheel at their places, each moved to the nearest cells of the first."""
        placed: list[GridLoad] = []
        for part in self.wheels:
            copy = place_load(wheel, x=part.x, y=part.y, mirror=part.mirror)
            assert isinstance(copy, GridLoad)
            first = placed[0].grid if placed else copy.grid
            placed.append(
                copy.moved(
                    _to_cells(copy.grid.x0 - first.x0, first.dx),
                    _to_cells(copy.grid.y0 - first.y0, first.dy),
                )
            )
        return placed


def _to_cells(apart: float, cell: float) -> float:
    """What makes a distance a whole number of cells, m."""
    return round(apart / cell) * cell - apart
