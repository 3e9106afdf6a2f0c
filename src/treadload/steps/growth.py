"""A crack that grows once a criterion has started it."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

from pydantic import model_validator

from treadload.case.description import Description
from treadload.case.step import Step
from treadload.damage import Criterion, Life
from treadload.damage.growth import CrackGrowth, Growth
from treadload.damage.growth.options import POINTS, STEPS
from treadload.errors import InputError
from treadload.life.growth import grow_cracks
from treadload.read import Choice
from treadload.registry import GROWTH
from treadload.steps.scene import Scene
from treadload.units import Angle, Length, Number

LAW = Choice(GROWTH, "law of crack growth")


class GrowthStep(Step, name="growth"):
    """`[growth]` of a design case: a crack that grows once a criterion has started it, see `tl.life.grow_cracks`.

    criterion: its name; left out, the first that reads the top of the road, else the first at the bottom of a layer.
    initial_length: of the crack when the criterion's damage is 1; left out, the length that it reads over, or 10 mm.
    law: of growth, "paris" or "from-strength"; left out, that of the layer's mix. trace: "longitudinal",
    "transverse", "both" side by side, or an angle from travel towards the right; left out, that of the criterion's
    first crack. path: "vertical",
    "kinked" for steps across the largest hoop stress, or an angle from the vertical. friction: between the crack's
    faces. layers: that it goes through, from the one where it starts. steps: depths at which its stress intensity is
    solved. points: along the crack at which its faces may touch. scatter: of log₁₀ of the passes to initiation; left
    out, that of the criterion's law, or 0.25.

    >>> axle = {"name": "axle", "share": 1, "axle_load": "100 kN", "inflation_pressure": "8 bar"}
    >>> case = {"tire": {"profile": "315/80R22.5"}, "pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3"}}
    >>> case |= {"traffic": {"passes_per_year": 1e5, "classes": [axle]}, "climate": {"temperature": 15}}
    >>> case["criteria"] = [{"name": "soil", "law": "french-subgrade"}]
    >>> tl.Case.from_dict(case | {"growth": {}})
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: case: no criterion reads the top of the road or the bottom of a layer, where a
        crack could start; add one, or leave out [growth]
    """

    after: ClassVar = ("life",)

    criterion: str | None = None
    initial_length: Length | None = None
    law: Annotated[Any, LAW] | None = None
    trace: Literal["longitudinal", "transverse", "both"] | Angle | None = None
    path: Literal["vertical", "kinked"] | Angle = "vertical"
    friction: Number = 0.5
    layers: int = 1
    steps: int = STEPS
    scatter: Number | None = None
    points: int = POINTS

    @model_validator(mode="after")
    def _possible(self) -> GrowthStep:
        self._build("")
        return self

    def check(self, case: Description) -> None:
        """Refuse a criterion that the case does not have."""
        self.build(case.build_criteria())

    def solve(self, scene: Scene) -> Growth:
        """How deep the crack is by the number of passes."""
        life = scene.result("life")
        assert isinstance(life, Life)
        return grow_cracks(
            scene.design, life, self.build(scene.case.build_criteria()),
            workers=scene.options.workers, progress=scene.progress.count,
        )  # fmt: skip

    def build(self, criteria: tuple[Criterion, ...]) -> CrackGrowth:
        """What is asked of the crack. criteria: of the case. Raises InputError."""
        names = [criterion.name for criterion in criteria]
        if self.criterion is not None:
            if self.criterion not in names:
                raise InputError(
                    f"growth.criterion {self.criterion!r} is none of the criteria, {', '.join(map(repr, names))}"
                )
            return self._build(self.criterion)
        first = [criterion.name for criterion in criteria if criterion.place == "top" and criterion.layer == 0]
        first += [criterion.name for criterion in criteria if criterion.place == "bottom"]
        if not first:
            raise InputError(
                "no criterion reads the top of the road or the bottom of a layer, where a crack could start; add "
                "one, or leave out [growth]"
            )
        return self._build(first[0])

    def _build(self, name: str) -> CrackGrowth:
        law = None if self.law is None else LAW.build(self.law)
        return CrackGrowth(
            name,
            self.initial_length,
            law,
            self.trace,
            self.path,
            self.friction,
            self.layers,
            self.steps,
            self.scatter,
            self.points,
        )
