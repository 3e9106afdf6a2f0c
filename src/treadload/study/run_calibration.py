"""Run a calibration case."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any

import xarray as xr

from treadload.case import CalibrationCase
from treadload.composing import BaseResult
from treadload.describing import first_line
from treadload.footprint.measured import READINGS
from treadload.results import Study, to_tree
from treadload.study.calibration import Calibration, calibrate
from treadload.study.calibration.evaluations import Progress
from treadload.study.calibration.fit import pose
from treadload.study.calibration.solution import shown


@dataclass(frozen=True, eq=False)
class CalibrationResult(Study):
    """What a calibration case gave."""

    case: CalibrationCase
    calibration: Calibration

    @property
    def parts(self) -> dict[str, BaseResult]:
        """Its result by its name in a tree."""
        return {"calibration": self.calibration}

    def to_tree(self) -> xr.DataTree:
        """The calibration in one tree with provenance, ready to be saved."""
        return to_tree(self.parts, case=self.case, road=self.calibration.road, summary=self.summary())

    def summary(self) -> str:
        """That of the calibration."""
        return self.calibration.summary()

    __repr__ = first_line


def plan_calibration(case: CalibrationCase) -> str:
    """What `run_calibration` would do, as text: what is sought by what. Reads the tire. Raises InputError."""
    problem = pose(**_asked(case))
    lines = [f"tire      {problem.tire}"]
    for one in problem.sought:
        factor, unit = shown(one.unit)
        start, low, high = (factor * value for value in one.on(problem.tire, problem.friction))
        lines.append(f"sought    {one.name}, {one.words}: from {start:.4g} {unit}, {low:.4g} to {high:.4g}")
    kinds = [READINGS[name].words for _, name, _ in problem.readings]
    counts = ", ".join(f"{kinds.count(words)} {words}" for words in dict.fromkeys(kinds))
    cells = "of the height map" if problem.spacing is None else f"of {problem.spacing * 1e3:g} mm"
    step = (len(problem.sought) + 1) * len(problem.data)
    lines += [
        f"readings  {len(problem.readings)} in {len(problem.data)} rows: {counts}",
        f"contacts  {step} for a step of the search, of which 4 to 8 are usual; on cells {cells}",
    ]
    return "\n".join(lines)


def _asked(case: CalibrationCase) -> dict[str, Any]:
    """What a case asks, as the arguments of `pose` and `calibrate`."""
    asked = case.calibration
    return {
        "tire": case.build_tire(),
        "sought": asked.build_sought(),
        "data": case.build_data(),
        "road": case.build_road(),
        "friction": asked.friction,
        "errors": asked.errors,
        "spacing": case.spacing,
        "tolerance": case.tolerance,
    }


def run_calibration(
    case: CalibrationCase,
    *,
    jobs: int = 1,
    state: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
) -> CalibrationResult:
    """The calibration of a case. jobs, state, progress: as in `calibrate`; raises its errors and those of reading."""
    found = calibrate(**_asked(case), jobs=jobs, state=state, progress=progress)
    return CalibrationResult(case, found)
