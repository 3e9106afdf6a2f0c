"""What scatters in a service life, and the risks whose years are asked for."""

from __future__ import annotations

from typing import ClassVar

from pydantic import model_validator

from treadload.case.step import Step
from treadload.damage import Life
from treadload.damage.scatter import Scatter, check_risks
from treadload.life.reliability import FEWEST_HELD, MonteCarlo, Reliability, life_reliability, number_of_roads
from treadload.steps.life import fails
from treadload.steps.outline import Outline
from treadload.steps.scene import Scene
from treadload.units import Kelvin, Length, Number, Share


class ReliabilityStep(Step, name="reliability"):
    """`[reliability]` of a design case: deviations of what its life depends on, see `damage.scatter.Scatter`.

    risks: probabilities of failure, in (0, 1), whose years are reported. fatigue: SN, of log₁₀ of the passes that a
    law allows, of all laws or a table by the names of criteria; left out, that of each law, else of its mix.
    thickness: Sh, of all asphalt, or a table by the names of layers; left out, by the rule of the French method.
    moduli: coefficient of variation of every layer's modulus, or a table by the names of layers. traffic:
    coefficient of variation of the passes. temperature: of the year. modulus_correlation: of the logarithms of two
    moduli, a list of [layer, layer, correlation]. coverage: share of a criterion's damage that is solved again
    with the inputs changed. held_back: direct solves at each risk for the error of its years; 0 for none. draws: of
    the Monte Carlo. seed: of the draws.

    >>> axle = {"name": "axle", "share": 1, "axle_load": "100 kN", "inflation_pressure": "8 bar"}
    >>> case = {"tire": {"profile": "315/80R22.5"}, "pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3"}}
    >>> case |= {"traffic": {"passes_per_year": 1e5, "classes": [axle]}, "climate": {"temperature": 15}}
    >>> case["criteria"] = [{"name": "soil", "law": "french-subgrade"}]
    >>> print(tl.plan(tl.Case.from_dict(case | {"reliability": {"risks": [0.05]}})).splitlines()[-1])
    scatter   5 roads for each criterion, in the seasons that do half of its damage
    """

    after: ClassVar = ("life",)

    risks: tuple[Share, ...] = (0.05, 0.5, 0.95)
    fatigue: Number | dict[str, Number] | None = None
    thickness: Length | dict[str, Length] | None = None
    moduli: Share | dict[str, Share] = 0.0
    traffic: Share = 0.0
    temperature: Kelvin = 0.0
    modulus_correlation: tuple[tuple[str, str, Number], ...] = ()
    coverage: Share = 0.5
    held_back: int = 4
    draws: int = 100_000
    seed: int = 1

    @model_validator(mode="after")
    def _possible(self) -> ReliabilityStep:
        check_risks(self.risks)
        if not 0 < self.coverage <= 1:
            raise ValueError(f"coverage must lie in (0, 1], got {self.coverage:g}; 0.5 is the default")
        if self.held_back != 0 and self.held_back < FEWEST_HELD:
            raise ValueError(f"held_back must be 0, for no error, or at least {FEWEST_HELD}, got {self.held_back}")
        if not 1000 <= self.draws <= 10_000_000:
            raise ValueError(f"draws must lie in [1000, 10 000 000], got {self.draws}; 100 000 is the default")
        self.build()
        return self

    def build(self) -> Scatter:
        """The scatter."""
        return Scatter(
            self.fatigue, self.thickness, self.moduli, self.traffic, self.temperature, self.modulus_correlation
        )

    def solve(self, scene: Scene) -> Reliability | None:
        """Years at the risks; None where no criterion ever fails."""
        life = scene.result("life")
        assert isinstance(life, Life)
        if not fails(life):
            return None
        return life_reliability(
            scene.design, life, risks=self.risks, coverage=self.coverage, held_back=self.held_back,
            sampling=MonteCarlo(self.draws, self.seed),
            workers=scene.options.workers, progress=scene.progress.count,
        )  # fmt: skip

    def plan(self, outline: Outline) -> None:
        """How many roads are solved."""
        roads = number_of_roads(outline.road, outline.case.build_criteria(), self.build())
        outline.add("scatter", f"{roads} roads for each criterion, in the seasons that do half of its damage")
