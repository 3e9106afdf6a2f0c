"""How a rut is counted in a service life."""

from __future__ import annotations

from typing import ClassVar

from pydantic import model_validator

from treadload.case.step import Step
from treadload.damage.rutting import Rutting
from treadload.steps.scene import Scene
from treadload.units import Length, Number, Share


class RuttingStep(Step, name="rutting"):
    """`[rutting]`: how a rut is counted; the service life takes it, and its result holds the rut.

    limit: depth of the rut that ends the life; left out, none does. water_content: of soil and unbound layers, a
    share of their dry mass. calibration: local factor on all of the rut. See `treadload.damage.Rutting`.

    >>> axle = {"name": "axle", "share": 1, "axle_load": "100 kN", "inflation_pressure": "8 bar"}
    >>> case = {"tire": {"profile": "315/80R22.5"}, "pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3"}}
    >>> case |= {"traffic": {"passes_per_year": 1e5, "classes": [axle]}, "climate": {"temperature": 15}}
    >>> case["criteria"] = [{"name": "soil", "law": "french-subgrade"}]
    >>> [step.name for step in tl.Case.from_dict(case | {"rutting": {"limit": "12.7 mm"}}).steps]
    ['life', 'rutting', 'sensitivity', 'equivalents']
    """

    after: ClassVar = ("life",)
    makes: ClassVar = ()

    limit: Length | None = None
    water_content: Share = 0.1
    calibration: Number = 1.0

    @model_validator(mode="after")
    def _possible(self) -> RuttingStep:
        self.build()
        return self

    def build(self) -> Rutting:
        """How the rut is counted."""
        return Rutting(self.limit, self.water_content, self.calibration)

    def solve(self, scene: Scene) -> None:
        """Nothing of its own."""
