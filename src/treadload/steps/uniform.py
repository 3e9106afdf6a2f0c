"""The wheel as conventional design loads the road: uniform pressure on a disc and on a rectangle."""

from __future__ import annotations

from typing import ClassVar

from treadload.case.description import Description
from treadload.case.step import Step
from treadload.contact import Contact
from treadload.damage import UniformComparison, compare_uniform
from treadload.errors import positive
from treadload.response import MATERIAL_LENGTH
from treadload.response.material import check_length
from treadload.steps.outline import Outline
from treadload.steps.scene import Scene
from treadload.steps.script import Script
from treadload.units import Length, Number, Pressure


class UniformStep(Step, name="uniform"):
    """`[uniform]`: the computed contact and uniform loads of the same force, see `treadload.damage.compare_uniform`.

    depths: left out, the surface, some down to 160 mm and the bottoms of the layers. pressure: of the uniform loads;
    left out, the inflation pressure. slenderness: length along travel over width of the rectangle. mean_over: side of
    the cube of road whose mean strain is evaluated near the surface.

    >>> wheel = {"tire": {"profile": "315/80R22.5", "inflation_pressure": "8 bar"}, "spacing": "12 mm"}
    >>> wheel |= {"rolling": {"normal_load": "32.5 kN", "friction": 0.7}, "response": {"depths": ["0 mm", "20 mm"]}}
    >>> road = {"pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3", "temperature": 15}}
    >>> plan = tl.plan(tl.Case.from_dict(wheel | road | {"uniform": {}}))
    >>> next(line for line in plan.splitlines() if line.startswith("uniform"))
    'uniform loads disc and rectangle; depths chosen by the road'
    """

    swept: ClassVar = True

    depths: tuple[Length, ...] | None = None
    pressure: Pressure | None = None
    slenderness: Number = 1.0
    mean_over: Length = MATERIAL_LENGTH

    @property
    def is_quick(self) -> bool:
        """True: the page shows it as soon as it is solved."""
        return True

    def check(self, case: Description) -> None:
        """Refuse uniform loads without a pressure, and values out of bounds."""
        check_length(self.mean_over)
        positive("uniform.slenderness", self.slenderness, remedy="1 is a square")
        if self.pressure is not None:
            positive("uniform.pressure", self.pressure, "Pa", "left out, it is the inflation pressure")
        elif case.tire is None or case.tire.inflation_pressure is None:
            raise ValueError("[uniform] needs a pressure: the tire has no inflation pressure; give uniform.pressure")
        if case.pavement is not None and case.road().is_viscoelastic:
            raise ValueError("[uniform] compares loads on an elastic road, and a layer is viscoelastic; leave it out")

    def solve(self, scene: Scene) -> UniformComparison:
        """The largest strains at each depth under the three loads."""
        contact = scene.result("contact")
        assert isinstance(contact, Contact)
        scene.tell("uniform loads")
        return compare_uniform(
            contact, scene.loaded.road, depths=self.depths, pressure=self.pressure, slenderness=self.slenderness,
            mean_over=self.mean_over,
        )  # fmt: skip

    def plan(self, outline: Outline) -> None:
        """The loads and their depths."""
        wanted = "chosen by the road" if self.depths is None else ", ".join(f"{z * 1e3:g} mm" for z in self.depths)
        outline.add("uniform loads", f"disc and rectangle; depths {wanted}")

    def python(self, script: Script) -> list[str]:
        """`tl.damage.compare_uniform`."""
        how = {name: getattr(self, name) for name in type(self).model_fields if self.names_key(name)}
        return [script.call("uniform = tl.damage.compare_uniform", ["contact", "road", *script.keywords(how)])]
