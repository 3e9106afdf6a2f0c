"""The deflection bowl of a layered road."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar

import numpy as np

from treadload.case.description import Description
from treadload.case.step import Step
from treadload.response import GridLoad, Response
from treadload.steps.scene import Scene
from treadload.steps.script import Script

# The deflection bowl, m: behind the wheel, before it, between its points.
_BEHIND, _AHEAD, _STEP = 2.5, 1.5, 0.01


class BowlStep(Step, name="bowl"):
    """Deflection of the surface of layers along travel, under the first wheel.

    >>> wheel = {"tire": {"profile": "315/80R22.5"}, "rolling": {"normal_load": "32.5 kN", "friction": 0.7}}
    >>> case = tl.Case.from_dict(wheel | {"pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3", "temperature": 15}})
    >>> next(step.name for step in case.steps if isinstance(step, tl.steps.BowlStep))
    'bowl'
    """

    after: ClassVar = ("contact", "response")
    has_table: ClassVar = False
    is_quiet: ClassVar = True

    @classmethod
    def wanted(cls, case: Description) -> BowlStep | None:
        """The step on layers; the deflection of a half-space is unbounded."""
        return None if case.pavement is None or case.road().is_homogeneous else cls()

    def solve(self, scene: Scene) -> Response:
        """The line of points."""
        scene.tell("deflection bowl")
        ahead, right = _centre(scene.loaded.wheels[0])
        steps = np.arange(-round(_BEHIND / _STEP), round(_AHEAD / _STEP) + 1) * _STEP
        bowl = scene.loaded.solve([0.0], x=ahead + steps, y=[right])
        # For whoever draws it: a line of points does not say where the load's centre is.
        return replace(bowl, dataset=bowl.dataset.assign_attrs(load_x=ahead))

    def python(self, script: Script) -> list[str]:
        """Nothing: a figure of a report, and no part of the script."""
        return []


def _centre(load: GridLoad) -> tuple[float, float]:
    """Centre of pressure, m, along x and y."""
    pressure, grid = load.array[0], load.grid
    total = max(float(pressure.sum()), np.finfo(float).tiny)
    return float((pressure * grid.x[None]).sum() / total), float((pressure * grid.y[:, None]).sum() / total)
