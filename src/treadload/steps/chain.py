"""Run a case, or plan it: every step that it asks for, in order of dependence."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from treadload.case import Case
from treadload.composing import BaseResult
from treadload.damage import Life, Verdict
from treadload.damage.answer import Answer
from treadload.deferred import xarray as xr
from treadload.describing import first_line
from treadload.pavement import Pavement
from treadload.response.input_caveats import question_caveats, road_caveats
from treadload.results import Study, road_in_rows, to_tree
from treadload.results.opened import ALIASES
from treadload.steps.outline import Outline
from treadload.steps.scene import Options, Progress, Scene, group_names, stream
from treadload.us_units import display_units

Shown = Callable[[str, BaseResult], None]


@dataclass(frozen=True, eq=False)
class Result(Study):
    """What a case gave.

    case: that was run. road: at its temperature; of a service life, waiting for it; None for the track of a test rig.
    parts: results by their names in a tree, each an attribute, too: `result.contact`, `result.response`,
    `result.life`, ...; None for a step that the case does not ask for.

    >>> tire = {"profile": {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}, "inflation_pressure": "8 bar"}
    >>> road = {"layers": [{"material": {"kind": "elastic", "modulus": "5 GPa", "poisson": 0.35}}]}
    >>> wheel = {"normal_load": "100 N", "friction": 0.7}
    >>> case = tl.Case.from_dict({"tire": tire, "pavement": road, "rolling": wheel, "spacing": "6 mm"})
    >>> result = tl.run(case, leave_out=("response", "slices"))
    >>> f"{result.contact.area * 1e4:.0f} cm²", result.life
    ('10 cm²', None)
    """

    case: Case
    road: Pavement | None
    parts: Mapping[str, BaseResult]

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or "parts" not in self.__dict__:
            raise AttributeError(name)
        group = ALIASES.get(name, name)
        if group in self.parts:
            return self.parts[group]
        if group in group_names():
            return None
        raise AttributeError(f"this result has no part {name!r}; it holds {', '.join(self.parts)}")

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self.parts})

    def to_tree(self) -> xr.DataTree:
        """All results in one tree with provenance, ready to be saved."""
        with display_units("si"):
            text = self.text()
        road, season = self.case.source.road_of(self.case, self.parts)
        return to_tree(self.parts, case=self.case, road=road, season=season, summary=text)

    def text(self) -> str:
        """One screen: the answer, what loads the road, its layers, and all further results but those for figures."""
        quiet = {group for step in self.case.steps if step.is_quiet for group in step.makes}
        texts = [part.text() for group, part in self.parts.items() if group not in quiet]
        if self.case.source.states_road and self.road is not None:
            # The road stands behind what loads it.
            texts.insert(1 if "contact" in self.parts else 0, road_in_rows(self.road, self.case))
        answer = answer_of(self.parts)
        return "\n\n".join([*([] if answer is None else [answer.first_line]), *texts])

    __repr__ = first_line


def answer_of(parts: Mapping[str, BaseResult]) -> Answer | None:
    """The answer of the service life among results by name, else that of the fatigue law; None without either."""
    life, verdict = parts.get("life"), parts.get("damage")
    if isinstance(life, Life):
        return life.answer
    return verdict.answer if isinstance(verdict, Verdict) else None


def run(
    case: Case,
    *,
    leave_out: tuple[str, ...] = (),
    workers: int | None = None,
    jobs: int = 1,
    state: str | Path | None = None,
    progress: Callable[[str], None] | Progress | None = None,
    shown: Shown | None = None,
) -> Result:
    """Compute everything that a case asks for.

    leave_out: names of steps that are not solved, such as "sensitivity", which doubles the work of a life. workers:
    threads of a service life; all cores if left out. jobs, state: of a calibration, see `calibrate`.
    progress: called with a line of text at every stage. shown: called with the name of each result and the result as
    soon as it is there.
    Raises InputError for a case that cannot be solved, and the errors of reading and of the solvers.

    >>> case = tl.Case.from_text('''
    ... spacing = "6 mm"
    ... tire = { profile = { rolling_radius = 0.3, crown_radius = 0.3, width = 0.06 }, inflation_pressure = "8 bar" }
    ... pavement = { layers = [{ material = { kind = "elastic", modulus = "5 GPa", poisson = 0.35 } }] }
    ... rolling = { normal_load = "100 N", friction = 0.7 }
    ... ''')
    >>> contact = tl.run(case, leave_out=("response", "slices")).contact
    >>> f"{contact.area * 1e4:.0f} cm²"
    '10 cm²'
    """
    options = Options(leave_out=leave_out, workers=workers, jobs=jobs, state=state)
    scene = Scene(case, _progress(progress), options)
    results: dict[str, BaseResult] = {}
    for group, result in stream(scene):
        results[group] = result
        if shown is not None:
            shown(group, result)
    return result_of(scene)


def result_of(scene: Scene) -> Result:
    """The result of a case of which all that is wanted is solved."""
    order = {group: place for place, group in enumerate(group_names())}
    groups = sorted(scene.results, key=lambda group: order.get(group, len(order)))
    parts = {group: scene.results[group] for group in groups}
    roads = (getattr(part, "road", None) for part in parts.values())
    road = next((part for part in roads if isinstance(part, Pavement)), None)
    return Result(scene.case, road if scene.case.source.states_road else scene.case.build_road(), parts)


def plan(case: Case) -> str:
    """What `run` would do, as text: the steps, cells, points and depths, a rough time.

    Reads the tire, or the footprint, and finds where the contact lies. Raises the errors of reading, and those of
    forces that friction cannot carry.

    >>> case = tl.Case.from_text('''
    ... spacing = "6 mm"
    ... tire = { profile = { rolling_radius = 0.3, crown_radius = 0.3, width = 0.06 }, inflation_pressure = "8 bar" }
    ... pavement = { layers = [{ material = { kind = "elastic", modulus = "5 GPa", poisson = 0.35 } }] }
    ... rolling = { normal_load = "100 N", friction = 0.7 }
    ... ''')
    >>> "15 x 15 cells of 6 x 6 mm" in tl.plan(case)
    True
    """
    outline = Outline(case)
    for step in case.steps:
        step.plan(outline)
    lines = list(outline.lines)
    if outline.time():
        lines.append(f"estimate  {outline.time()}")
    road = case.build_road()
    if road is None:
        return "\n".join(lines)
    if case.source.states_road:
        if outline.mapped:
            speed = case.speed if road.is_viscoelastic else None
            outline.warnings += question_caveats(np.array(case.response.depths), speed)
            outline.warnings += road_caveats(road)
        lines += ["", road_in_rows(road, case)]
    return "\n".join([*lines, *(f"warning: {text}" for text in outline.warnings)])


def _progress(progress: Callable[[str], None] | Progress | None) -> Progress:
    """Counts as lines of text, for who takes text alone."""
    if progress is None or isinstance(progress, Progress):
        return progress or Progress()
    return Progress(progress, lambda done, total, what: progress(f"{what} {done} of {total}"))
