"""How often the load of a case rolls over its road, where that yields."""

from __future__ import annotations

from pydantic import model_validator

from treadload.case.description import Description
from treadload.case.step import Step
from treadload.citations import PASSES
from treadload.errors import positive
from treadload.materials import ElastoPlastic
from treadload.pavement import Pavement
from treadload.response import Passes, roll_passes
from treadload.steps.scene import Scene
from treadload.units import Length


class PassesStep(Step, name="passes"):
    """`[passes]`: passes of the wheels over a road with a layer that yields, see `treadload.response.roll_passes`.

    count: how many. spacing: of the cells that may yield; left out, the footprint's longer side over 32, and across
    travel a twelfth of a rib's width where that is less. depth: of the box of these, from the surface; left out, it
    grows until it holds what yields. layers: rows of cells in it; left out, as many as it takes.
    wander: standard deviation of the wheel's place across the road; left out, all passes follow one line.

    >>> wheel = {"tire": {"profile": "315/80R22.5"}, "rolling": {"normal_load": "32.5 kN", "friction": 0.7}}
    >>> road = {"pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3", "temperature": 15}}
    >>> tl.Case.from_dict(wheel | road | {"passes": {"count": 10}})
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: case: [passes] need a layer that can yield: give one of the layers a
        plasticity, such as { kind = "mohr-coulomb", cohesion = "100 kPa", friction_angle = "35 deg" }
    """

    count: int = 10
    spacing: Length | None = None
    depth: Length | None = None
    layers: int | None = None
    wander: Length | None = None

    @model_validator(mode="after")
    def _possible(self) -> PassesStep:
        if self.count < 1:
            raise ValueError(f"count must be >= 1, got {self.count}")
        if self.layers is not None and not 2 <= self.layers <= 64:
            raise ValueError(f"layers must lie in [2, 64], got {self.layers}; leave it out for the default")
        for name in ("spacing", "depth", "wander"):
            value = getattr(self, name)
            if value is not None:
                positive(name, value, "metres", "leave it out for the default")
        return self

    def check(self, case: Description) -> None:
        """Refuse a road that cannot yield."""
        check_yields("[passes] need", case.road())

    def cites(self, case: Description) -> tuple[str, ...]:
        """Methods of the step."""
        return PASSES

    def solve(self, scene: Scene) -> Passes:
        """What the passes leave."""
        load = scene.loaded
        return roll_passes(
            load.wheels, load.road, passes=self.count, speed=scene.case.speed, spacing=self.spacing, depth=self.depth,
            layers=self.layers, wander=self.wander, progress=scene.tell,
        )  # fmt: skip


def check_yields(who: str, road: Pavement) -> None:
    """Raise ValueError for a road without a layer that can yield. who: needs one, the beginning of a sentence."""
    if not any(isinstance(layer.material, ElastoPlastic) for layer in road.layers):
        raise ValueError(
            f"{who} a layer that can yield: give one of the layers a plasticity, "
            'such as { kind = "mohr-coulomb", cohesion = "100 kPa", friction_angle = "35 deg" }'
        )
