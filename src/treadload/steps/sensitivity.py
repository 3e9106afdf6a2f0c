"""What the service life of a road depends on."""

from __future__ import annotations

from typing import ClassVar

from treadload.case.step import Step
from treadload.damage import Life
from treadload.life.sensitivity import Sensitivity, life_sensitivity
from treadload.steps.life import fails
from treadload.steps.scene import Scene


class SensitivityStep(Step, name="sensitivity"):
    """What the service life depends on: its change as each input grows by 5 %, temperature by 1 °C.

    >>> axle = {"name": "axle", "share": 1, "axle_load": "100 kN", "inflation_pressure": "8 bar"}
    >>> case = {"tire": {"profile": "315/80R22.5"}, "pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3"}}
    >>> case |= {"traffic": {"passes_per_year": 1e5, "classes": [axle]}, "climate": {"temperature": 15}}
    >>> case["criteria"] = [{"name": "soil", "law": "french-subgrade"}]
    >>> scene = tl.steps.Scene(tl.Case.from_dict(case), options=tl.steps.Options(leave_out=("sensitivity",)))
    >>> [step.name for step in scene.steps]  # half the work of a life with its sensitivity
    ['life', 'equivalents']
    """

    after: ClassVar = ("life",)
    has_table: ClassVar = False

    def solve(self, scene: Scene) -> Sensitivity | None:
        """Elasticities; None where no criterion ever fails."""
        life = scene.result("life")
        assert isinstance(life, Life)
        if not fails(life):
            return None
        return life_sensitivity(scene.design, life, workers=scene.options.workers, progress=scene.progress.count)
