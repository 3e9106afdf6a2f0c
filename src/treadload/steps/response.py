"""Stress and strain in the road: depths, wheels, speed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, Literal

from pydantic import model_validator

from treadload.case.description import Description
from treadload.case.step import Step
from treadload.damage.uniform import READINGS
from treadload.deferred import xarray as xr
from treadload.errors import positive
from treadload.read import Table
from treadload.response import GridLoad, Response, place_load
from treadload.steps.outline import Outline
from treadload.steps.scene import Scene
from treadload.steps.script import Script
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


class ResponseStep(Step, name="response"):
    """`[response]`: depths of the maps, wheels, speed, and how deep the vertical slices go.

    depths: of the maps, downwards; 0 is the surface. slice_depth: of the vertical slices; left out, 60 mm, on layers
    a quarter below the last interface, 600 mm at most. wheels: copies of the contact, whose responses add up; left
    out, one at the origin. speed: left out, that of [rolling]; a viscoelastic road needs one. side: "above" or
    "below", of an interface that a depth falls on.

    >>> wheel = {"tire": {"profile": "315/80R22.5", "inflation_pressure": "8 bar"}, "spacing": "12 mm"}
    >>> wheel |= {"rolling": {"normal_load": "32.5 kN", "friction": 0.7}, "response": {"depths": ["0 mm", "20 mm"]}}
    >>> road = {"pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3", "temperature": 15}}
    >>> plan = tl.plan(tl.Case.from_dict(wheel | road))
    >>> next(line for line in plan.splitlines() if line.startswith("response"))
    'response  45 x 47 points at 2 depth(s), 0, 20 mm'
    """

    swept: ClassVar = True

    depths: tuple[Length, ...] = (0.0,)
    slice_depth: Length | None = None
    wheels: tuple[WheelPart, ...] = (WheelPart(),)
    speed: Speed | None = None
    side: Literal["above", "below"] = "above"

    @model_validator(mode="after")
    def _downwards(self) -> ResponseStep:
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
            raise ValueError("two of the wheels are at the same place; give each its own x and y")
        if self.speed is not None and self.speed < 0:
            raise ValueError(f"speed must be >= 0 m/s, got {self.speed:g}; a wheel rolls towards positive x")
        return self

    @classmethod
    def default(cls) -> ResponseStep:
        """The surface below one wheel."""
        return cls()

    def check(self, case: Description) -> None:
        """Refuse depths below a rigid base, and a viscoelastic road without a speed."""
        road = case.road()
        if road.is_viscoelastic and case.speed is None:
            raise ValueError("the road is viscoelastic: give the speed in [rolling] or [response]")
        if not road.reaches(max(self.depths)):
            raise ValueError(
                f"response.depths reach {max(self.depths):g} m, below the rigid base at {road.interfaces[-1]:g} m"
            )

    @property
    def is_quick(self) -> bool:
        """True: the page shows it as soon as it is solved."""
        return True

    def solve(self, scene: Scene) -> Response:
        """Maps at the depths, over all wheels."""
        return scene.loaded.solve(self.depths)

    def numbers(self, scene: Scene) -> xr.Dataset:
        """The largest strains and stress of the plane at every depth, as surface criteria read them."""
        data = scene.means.dataset
        largest = {name: ("depth", quantity.values(data).max(axis=(1, 2))) for name, quantity in READINGS.items()}
        return xr.Dataset(largest, {"depth": data["depth"].to_numpy()})

    def plan(self, outline: Outline) -> None:
        """Points, depths and wheels of the maps."""
        cells, wheels = outline.map_cells, len(outline.wheels)
        depths = ", ".join(f"{depth * 1e3:g}" for depth in self.depths)
        under = f" under {wheels} wheels" if wheels > 1 else ""
        outline.add("response", f"{cells.nx} x {cells.ny} points at {len(self.depths)} depth(s), {depths} mm{under}")
        outline.mapped += cells.nx * cells.ny * len(self.depths)

    def python(self, script: Script) -> list[str] | None:
        """`tl.solve_response`; None for several wheels."""
        if self.wheels != (WheelPart(),):
            return None
        case, road = script.case, script.case.road()
        keywords = {
            "depths": list(self.depths),
            "side": self.side if self.side != "above" else None,
            "speed": case.speed if road.is_viscoelastic else None,
        }
        points, lines = [], []
        if not road.is_homogeneous:
            lines = [
                "# On layers also 0.1 m beside the contact: stiff ones spread the load.",
                "points = tl.response.map_grid([tl.response.GridLoad.from_dataset(contact)], road)",
            ]
            points = ["x=points.x", "y=points.y"]
        arguments = ["contact", "road", *script.keywords(keywords), *points]
        return [*lines, script.call("response = tl.solve_response", arguments)]

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
