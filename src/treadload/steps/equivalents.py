"""A traffic in standard axles."""

from __future__ import annotations

from typing import ClassVar

from treadload.case.step import Step
from treadload.damage import Life
from treadload.life.equivalents import Equivalents, life_equivalents
from treadload.steps.scene import Scene


class EquivalentsStep(Step, name="equivalents"):
    """The traffic in standard axles, and the climate as one temperature."""

    after: ClassVar = ("life",)
    also: ClassVar = ("sensitivity", "reliability", "growth")
    has_table: ClassVar = False

    def solve(self, scene: Scene) -> Equivalents:
        """Standard axles by class and criterion."""
        life = scene.result("life")
        assert isinstance(life, Life)
        return life_equivalents(scene.design, life, workers=scene.options.workers)
