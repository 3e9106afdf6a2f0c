"""A traffic in standard axles."""

from __future__ import annotations

from typing import ClassVar

from treadload.case.step import Step
from treadload.damage import Life
from treadload.life.equivalents import Equivalents, life_equivalents
from treadload.steps.scene import Scene


class EquivalentsStep(Step, name="equivalents"):
    """The traffic in standard axles, and the climate as one temperature.

    >>> axle = {"name": "axle", "share": 1, "axle_load": "100 kN", "inflation_pressure": "8 bar"}
    >>> case = {"tire": {"profile": "315/80R22.5"}, "pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3"}}
    >>> case |= {"traffic": {"passes_per_year": 1e5, "classes": [axle]}, "climate": {"temperature": 15}}
    >>> case["criteria"] = [{"name": "soil", "law": "french-subgrade"}]
    >>> [step.name for step in tl.Case.from_dict(case).steps]
    ['life', 'sensitivity', 'equivalents']
    """

    after: ClassVar = ("life",)
    also: ClassVar = ("sensitivity", "reliability", "growth")
    has_table: ClassVar = False

    def solve(self, scene: Scene) -> Equivalents:
        """Standard axles by class and criterion."""
        life = scene.result("life")
        assert isinstance(life, Life)
        return life_equivalents(scene.design, life, workers=scene.options.workers)
