"""Run a case of a body that dents its road: pressed into it, or rolled over its own track."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import xarray as xr

from treadload.case import Case
from treadload.composing import BaseResult
from treadload.contact.indentation import Indentation, solve_indentation
from treadload.describing import first_line
from treadload.errors import InputError
from treadload.pavement import Pavement
from treadload.response import Passes, roll_drum
from treadload.results import Study, road_in_rows, to_tree


@dataclass(frozen=True, eq=False)
class Dents(Study):
    """What a case with `[indentation]` or `[drum]` gave. road: it, at its temperature; one of the two is None."""

    case: Case
    road: Pavement
    indentation: Indentation | None = None
    passes: Passes | None = None

    @property
    def parts(self) -> Mapping[str, BaseResult]:
        """Its results by their names in a tree."""
        parts = {"indentation": self.indentation, "passes": self.passes}
        return {name: part for name, part in parts.items() if part is not None}

    def to_tree(self) -> xr.DataTree:
        """All results in one tree with provenance, ready to be saved."""
        return to_tree(self.parts, case=self.case, road=self.road, summary=self.summary())

    def summary(self) -> str:
        """One screen: the road, and what the body leaves in it."""
        return "\n\n".join([road_in_rows(self.road, self.case), *(one.summary() for one in self.parts.values())])

    __repr__ = first_line


def run_dents(case: Case, progress: Callable[[str], None] | None = None) -> Dents:
    """Press the body of a case into its road, or roll it over its own track.

    case: with `[indentation]` or `[drum]`. progress: called with a line of text at every stage. Raises InputError for
    a case of a wheel, and the errors of `solve_indentation` and `roll_drum`.
    """
    tell = progress or (lambda text: None)
    asked, drum = case.indentation, case.drum
    if asked is None and drum is None:
        raise InputError("this case has neither [indentation] nor [drum]; solve it by treadload.run_case(case)")
    tell("reading the tire")
    road, body = case.build_road(), case.build_tire()
    if asked is not None:
        pressed = solve_indentation(
            body, road, asked.loads, spacing=asked.spacing, depth=asked.depth, layers=asked.layers,
            tolerance=asked.tolerance, progress=tell,
        )  # fmt: skip
        return Dents(case, road, indentation=pressed)
    assert drum is not None
    rolled = roll_drum(
        body, road, drum.load, passes=drum.passes, speed=drum.speed, spacing=drum.spacing, depth=drum.depth,
        layers=drum.layers, tolerance=drum.tolerance, progress=tell,
    )  # fmt: skip
    return Dents(case, road, passes=rolled)


def plan_dents(case: Case) -> str:
    """What `run_dents` would do, as text: body, steps or passes, road. Reads the tire. Raises its errors."""
    lines = [f"body      {case.build_tire()}"]
    if case.indentation is not None:
        loads = ", ".join(f"{one:g}" for one in case.indentation.loads)
        lines.append(
            f"pressed   {len(case.indentation.loads)} step(s), {loads} N; {case.indentation.layers} rows of cells"
        )
    if case.drum is not None:
        lines.append(f"rolled    {case.drum.load / 1e3:.4g} kN, at most {case.drum.passes} pass(es)")
    lines.append("estimate  minutes: on 64 x 64 cells in 14 rows at most five a step, half a one a pass")
    return "\n".join([*lines, "", road_in_rows(case.build_road(), case)])
