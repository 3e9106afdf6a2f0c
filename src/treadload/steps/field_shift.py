"""`[field_shift]`: years of roads beside a life at the surface, by a shift that the case names."""

from __future__ import annotations

from pathlib import Path
from typing import ClassVar

from pydantic import model_validator

from treadload.case.description import Description
from treadload.case.step import Step
from treadload.damage import Life
from treadload.damage.field_shift import DEFAULT, FieldShift, field_shifts, read_field_shifts
from treadload.life.field.years import FieldYears, field_years
from treadload.life.surface_lines import surface_lines
from treadload.steps.outline import Outline
from treadload.steps.scene import Scene


class FieldShiftStep(Step, name="field_shift"):
    """`[field_shift]` of a design case: years of roads beside those of the mechanics at the surface.

    shift: name of a field shift, "LTPP", or a TOML file with one, "ours.toml".

    >>> axle = {"name": "axle", "share": 1, "axle_load": "100 kN", "inflation_pressure": "8 bar"}
    >>> case = {"tire": {"profile": "315/80R22.5"}, "pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3"}}
    >>> case |= {"traffic": {"passes_per_year": 1e5, "classes": [axle]}, "climate": {"temperature": 15}}
    >>> case["criteria"] = [{"name": "soil", "law": "french-subgrade"}]
    >>> tl.Case.from_dict(case | {"field_shift": {}})
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: case: it needs a criterion that reads tensile strain at the surface, and none
        does; add one with place = "top" of layer 1, or leave [field_shift] out
    """

    after: ClassVar = ("life",)
    heading: ClassVar[str] = "field shift"

    shift: str = DEFAULT

    @model_validator(mode="after")
    def _there(self) -> FieldShiftStep:
        if not self.shift.endswith(".toml"):
            field_shifts[self.shift]
        return self

    def build(self, folder: Path) -> FieldShift:
        """The shift. folder: of the case, from which a file is taken. Raises InputError."""
        if self.shift.endswith(".toml"):
            return read_field_shifts(folder / self.shift)[0]
        return field_shifts[self.shift]

    def check(self, case: Description) -> None:
        """Refuse a case without a criterion at the surface, before anything is solved."""
        road = case.road()
        if not any(surface_lines(road, criterion) for criterion in case.build_criteria()):
            raise ValueError(
                "it needs a criterion that reads tensile strain at the surface, and none does; add one with "
                'place = "top" of layer 1, or leave [field_shift] out'
            )
        self.build(case.folder)

    def solve(self, scene: Scene) -> FieldYears:
        """Years of roads for every criterion of the surface."""
        life = scene.result("life")
        assert isinstance(life, Life)
        return field_years(life, scene.case.road(), self.build(scene.case.folder))

    def plan(self, outline: Outline) -> None:
        """Which shift is applied."""
        outline.add("field shift", f"{self.shift}: {self.build(outline.case.folder)}")
