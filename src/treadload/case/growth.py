"""A crack in a design case: what starts it, and how it grows."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import model_validator

from treadload.damage import Criterion
from treadload.damage.growth import CrackGrowth
from treadload.errors import InputError
from treadload.read import Choice, Table
from treadload.registry import GROWTH
from treadload.units import Angle, Length, Number

LAW = Choice(GROWTH, "law of crack growth")


class GrowthPart(Table):
    """`[growth]` of a design case: a crack that grows once a criterion has started it, see `tl.study.grow_cracks`.

    criterion: its name; left out, the first that reads the top of the road, else the first at the bottom of a layer.
    initial_length: of the crack when the criterion's damage is 1; left out, the length that it reads over, or 10 mm.
    law: of growth, "paris" or "from-strength"; left out, that of the layer's mix. trace: "longitudinal", "transverse"
    or an angle from travel towards the right; left out, that of the criterion's first crack. path: "vertical",
    "kinked" for steps across the largest hoop stress, or an angle from the vertical. friction: between the crack's
    faces. layers: that it goes through, from the one where it starts. steps: depths at which its stress intensity is
    solved. scatter: of log₁₀ of the passes to initiation; left out, that of the criterion's law, or 0.25.
    """

    criterion: str | None = None
    initial_length: Length | None = None
    law: Annotated[Any, LAW] | None = None
    trace: Literal["longitudinal", "transverse"] | Angle | None = None
    path: Literal["vertical", "kinked"] | Angle = "vertical"
    friction: Number = 0.5
    layers: int = 1
    steps: int = 8
    scatter: Number | None = None

    @model_validator(mode="after")
    def _possible(self) -> GrowthPart:
        self._build("")
        return self

    def build(self, criteria: tuple[Criterion, ...]) -> CrackGrowth:
        """What is asked of the crack. criteria: of the case. Raises InputError."""
        names = [one.name for one in criteria]
        if self.criterion is not None:
            if self.criterion not in names:
                raise InputError(
                    f"growth.criterion {self.criterion!r} is none of the criteria, {', '.join(map(repr, names))}"
                )
            return self._build(self.criterion)
        first = [one.name for one in criteria if one.place == "top" and one.layer == 0]
        first += [one.name for one in criteria if one.place == "bottom"]
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
        )
