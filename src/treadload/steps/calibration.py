"""A tire, what was measured of it, and which of its numbers are sought."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, TypedDict

from pydantic import Field, model_validator

from treadload.calibration import Calibration, calibrate
from treadload.calibration.fit import pose
from treadload.calibration.solution import shown
from treadload.case.description import Description
from treadload.case.step import Source
from treadload.footprint.measured import READINGS, Measured, Unknown, unknowns
from treadload.pavement import Pavement
from treadload.read import As
from treadload.steps.outline import Outline
from treadload.steps.scene import Scene
from treadload.tire import Tire
from treadload.units import Number

# A name, or a table.
SOUGHT = As(tuple[str | Unknown, ...])
MEASURED = As(tuple[Measured, ...])
ROWS = As(tuple[tuple[float | str, ...], ...])
ERRORS = As(dict[str, float | str])


class Question(TypedDict):
    """The arguments of `calibrate` that a case states."""

    tire: Tire
    sought: tuple[Unknown, ...]
    data: tuple[Measured, ...]
    road: Pavement | None
    friction: float
    errors: dict[str, float | str] | None
    spacing: float | None
    tolerance: float


class CalibrationStep(Source, name="calibration"):
    """`[calibration]`: which numbers of the tire are sought, and what was measured.

    parameters: names, "foundation" or "modulus", or tables { name, start, low, high }. load_deflection: rows of load
    and deflection, perhaps with the inflation pressure: [["10 kN", "14.1 mm", "8 bar"]]. data: rows of other readings
    under a load and a pressure: areas, length, width, rib_shares with ribs, a footprint, pins, stiffnesses, forces
    at a creepage. errors: standard deviations by reading, { deflection = "0.3 mm", net_area = "2 %" }, for rows
    without their own. friction: of rolling readings.

    >>> tire = {"profile": "315/80R22.5", "belt": "315/80R22.5", "inflation_pressure": "8 bar"}
    >>> sought = {"parameters": ["foundation"], "load_deflection": [["10 kN", "14.1 mm", "8 bar"]]}
    >>> [step.name for step in tl.Case.from_dict({"tire": tire, "calibration": sought}).steps]
    ['calibration']
    """

    uses: ClassVar = ("title", "spacing", "tolerance", "tire", "pavement")
    needs: ClassVar = ("tire",)
    command: ClassVar = "calibrate"
    states_road: ClassVar = False
    # Of normal contact; slopes are differences and need it small.
    tolerances: ClassVar = (1e-12, 1e-8, 1e-4)

    parameters: Annotated[Any, SOUGHT]
    load_deflection: Annotated[Any, ROWS] = ()
    data: Annotated[Any, MEASURED] = ()
    errors: Annotated[Any, ERRORS] = Field(default_factory=dict)
    friction: Number = 0.7

    @model_validator(mode="after")
    def _buildable(self) -> CalibrationStep:
        self.build_sought()
        self.build_data()
        Measured.check_errors(self.errors)
        if not self.friction > 0:
            raise ValueError(f"friction must be above 0, got {self.friction:g}")
        return self

    def build_sought(self) -> tuple[Unknown, ...]:
        """What is sought."""
        return unknowns(SOUGHT.build(self.parameters))

    def build_data(self) -> tuple[Measured, ...]:
        """What was measured, footprints not yet read."""
        rows = (*Measured.load_deflection(self.load_deflection), *MEASURED.build(self.data))
        if not rows:
            raise ValueError("give load_deflection, or rows of [[calibration.data]]")
        return rows

    def check(self, case: Description) -> None:
        """Refuse a tire without a modulus."""
        super().check(case)
        if not case.has_elastic_tire:
            raise ValueError("a calibration seeks numbers of an elastic tire; give an elastic material, or a belt")
        case.build_road()

    def problem(self, case: Description) -> Question:
        """The arguments of `calibrate`; footprints are read from the folder."""
        return {
            "tire": case.build_tire(),
            "sought": self.build_sought(),
            "data": tuple(row.loaded(case.folder) for row in self.build_data()),
            "road": case.build_road(),
            "friction": self.friction,
            "errors": self.errors,
            "spacing": case.spacing,
            "tolerance": self.tolerance_of(case),
        }

    def solve(self, scene: Scene) -> Calibration:
        """The numbers that fit the data best, with error bars."""
        options = scene.options
        return calibrate(
            **self.problem(scene.case), jobs=options.jobs, state=options.state, progress=scene.progress.count
        )

    def plan(self, outline: Outline) -> None:
        """What is sought by what, and how many contacts a step of the search takes."""
        problem = pose(**self.problem(outline.case))
        outline.add("tire", f"{problem.tire}")
        for number in problem.sought:
            factor, unit = shown(number.unit)
            start, low, high = (factor * value for value in number.on(problem.tire, problem.friction))
            outline.add("sought", f"{number.name}, {number.words}: from {start:.4g} {unit}, {low:.4g} to {high:.4g}")
        kinds = [READINGS[name].words for _, name, _ in problem.readings]
        counts = ", ".join(f"{kinds.count(words)} {words}" for words in dict.fromkeys(kinds))
        cells = "of the height map" if problem.spacing is None else f"of {problem.spacing * 1e3:g} mm"
        count = (len(problem.sought) + 1) * len(problem.data)
        outline.add("readings", f"{len(problem.readings)} in {len(problem.data)} rows: {counts}")
        outline.add("contacts", f"{count} for a step of the search, of which 4 to 8 are usual; on cells {cells}")
