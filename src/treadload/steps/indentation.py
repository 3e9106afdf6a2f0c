"""A body that dents a road that yields: pressed into it and lifted, or rolled over its own track."""

from __future__ import annotations

import math
from typing import ClassVar

from pydantic import model_validator

from treadload.case.description import Description
from treadload.case.step import Source
from treadload.citations import DENTS, PASSES
from treadload.contact.indentation import Indentation, check_indented, solve_indentation
from treadload.errors import positive
from treadload.response import Passes, roll_drum
from treadload.steps.outline import Outline
from treadload.steps.passes import check_yields
from treadload.steps.scene import Scene
from treadload.units import Force, Length, Number, Speed


class DentSource(Source):
    """A body that dents its road, in place of a wheel."""

    @classmethod
    def stray_text(cls, key: str) -> str:
        """Which keys are not its own."""
        return (
            f"[{cls.name}] replaces [rolling] and what follows, with cells and a tolerance of its own; "
            f"leave out {key}"
        )

    @classmethod
    def missing_text(cls, key: str) -> str:
        """What to give."""
        if key == "tire":
            return f"'tire' is missing: the body of [{cls.name}], such as a profile with a material of steel"
        return super().missing_text(key)

    def check(self, case: Description) -> None:
        """Refuse a belt, and a road that cannot yield."""
        super().check(case)
        if case.tire is not None and case.tire.belt is not None:
            raise ValueError(f"[{self.name}] takes an elastic body; give tire.material in place of belt")
        check_yields(f"[{self.name}] needs", case.road())

    def plan(self, outline: Outline) -> None:
        """The body, and that it takes minutes."""
        outline.lines.insert(0, f"body      {outline.case.build_tire()}")
        outline.estimate = "minutes: on 64 x 64 cells in 14 rows at most five a step, half a one a pass"


class IndentationStep(DentSource, name="indentation"):
    """`[indentation]`: the body of `[tire]` pressed into a half-space that yields, see `contact.solve_indentation`.

    loads: one a step, in their order; 0 lifts the body off. spacing: of the cells, 3 mm or those of a height map if
    left out. depth: of what may yield; left out, 2.2 times the radius of the elastic contact. layers: rows of cells
    in it. tolerance: of the plastic strain of a step, relative. It stands in place of `[rolling]`.

    >>> case = tl.Case.from_text('''
    ... indentation = { loads = ["640 N", "0 N"] }
    ... [tire]
    ... profile = { rolling_radius = "1 m", crown_radius = "1 m", width = "60 mm" }
    ... material = { modulus = "210 GPa", poisson = 0.3 }
    ... [[pavement.layers]]
    ... material = { modulus = "100 MPa", poisson = 0.35 }
    ... plasticity = { kind = "von-mises", yield_stress = "0.4 MPa", hardening = "20 MPa" }
    ... ''')
    >>> [step.name for step in case.steps]
    ['indentation']
    """

    loads: tuple[Force, ...]
    spacing: Length | None = None
    depth: Length | None = None
    layers: int = 14
    tolerance: Number = 1e-3

    @model_validator(mode="after")
    def _possible(self) -> IndentationStep:
        if not self.loads or not all(0 <= load < math.inf for load in self.loads) or max(self.loads) <= 0:
            raise ValueError(
                f"loads must be forces >= 0 N with one above, got {list(self.loads)}; 0 lifts the body off"
            )
        _check_cells(self, "spacing", "depth")
        return self

    def check(self, case: Description) -> None:
        """Refuse a belt, a road that cannot yield, and one on which no indentation is solved."""
        super().check(case)
        check_indented(case.road())

    def cites(self, case: Description) -> tuple[str, ...]:
        """Methods of the step."""
        return (*super().cites(case), *DENTS)

    def solve(self, scene: Scene) -> Indentation:
        """Pressure, plastic strain and dent, step by step."""
        scene.tell("reading the tire")
        return solve_indentation(
            scene.case.build_tire(), scene.case.road(), self.loads, spacing=self.spacing, depth=self.depth,
            layers=self.layers, tolerance=self.tolerance, progress=scene.tell,
        )  # fmt: skip

    def plan(self, outline: Outline) -> None:
        """The loads."""
        loads = ", ".join(f"{load:g}" for load in self.loads)
        outline.add("pressed", f"{len(self.loads)} step(s), {loads} N; {self.layers} rows of cells")
        super().plan(outline)


class DrumStep(DentSource, name="drum"):
    """`[drum]`: the body of `[tire]` rolled over its own track, see `treadload.response.roll_drum`.

    load: on the drum. passes: at most; one that adds less than 1 % of the strain at yield is the last. speed: which
    laws of Perzyna need. spacing_along, spacing_across: of the cells along travel and across it, both or none; left
    out, a twelfth of the elastic contact's length and a 28th of the drum's width. depth: of what may yield; left out,
    it grows until it holds it. layers: rows of cells in it. tolerance: of the plastic strain of a pass, relative. It
    replaces `[rolling]`.

    >>> case = tl.Case.from_text('''
    ... drum = { load = "640 N", passes = 4 }
    ... [tire]
    ... profile = { rolling_radius = "1 m", crown_radius = "1 m", width = "60 mm" }
    ... material = { modulus = "210 GPa", poisson = 0.3 }
    ... [[pavement.layers]]
    ... material = { modulus = "100 MPa", poisson = 0.35 }
    ... plasticity = { kind = "von-mises", yield_stress = "0.4 MPa", hardening = "20 MPa" }
    ... ''')
    >>> [step.name for step in case.steps]
    ['drum']
    """

    makes: ClassVar = ("passes",)

    load: Force
    passes: int = 8
    speed: Speed | None = None
    spacing_along: Length | None = None
    spacing_across: Length | None = None
    depth: Length | None = None
    layers: int = 10
    tolerance: Number = 1e-3

    @model_validator(mode="after")
    def _possible(self) -> DrumStep:
        positive("load", self.load, "N", 'a vibrating roller\'s drum carries near "50 kN"')
        if self.passes < 1:
            raise ValueError(f"passes must be >= 1, got {self.passes}")
        if self.speed is not None:
            positive("speed", self.speed, "m/s", "leave it out where no law follows time")
        if (self.spacing_along is None) != (self.spacing_across is None):
            raise ValueError("give spacing_along and spacing_across, or none of them")
        _check_cells(self, "spacing_along", "spacing_across", "depth")
        return self

    @property
    def spacing(self) -> tuple[float, float] | None:
        """Of the cells along travel and across it, m."""
        if self.spacing_along is None or self.spacing_across is None:
            return None
        return self.spacing_along, self.spacing_across

    def cites(self, case: Description) -> tuple[str, ...]:
        """Methods of the step."""
        return (*super().cites(case), *DENTS, *PASSES)

    def solve(self, scene: Scene) -> Passes:
        """What the passes of the drum leave."""
        scene.tell("reading the tire")
        return roll_drum(
            scene.case.build_tire(), scene.case.road(), self.load, passes=self.passes, speed=self.speed,
            spacing=self.spacing, depth=self.depth, layers=self.layers, tolerance=self.tolerance,
            progress=scene.tell,
        )  # fmt: skip

    def plan(self, outline: Outline) -> None:
        """Load and passes."""
        outline.add("rolled", f"{self.load / 1e3:.4g} kN, at most {self.passes} pass(es)")
        super().plan(outline)


def _check_cells(part: IndentationStep | DrumStep, *lengths: str) -> None:
    for name in lengths:
        value = getattr(part, name)
        if value is not None:
            positive(name, value, "metres", "leave it out for the default")
    if not 2 <= part.layers <= 64:
        default = type(part).model_fields["layers"].default
        raise ValueError(f"layers must lie in [2, 64], got {part.layers}; {default} is the default")
    if not 1e-6 <= part.tolerance <= 0.1:
        default = type(part).model_fields["tolerance"].default
        raise ValueError(f"tolerance must lie in [1e-6, 0.1], got {part.tolerance:g}; {default:g} is the default")
