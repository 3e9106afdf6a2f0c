"""Run a design case: the life of its road, and what that life depends on."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from treadload.case import LifeCase
from treadload.composing import BaseResult
from treadload.damage.growth import Growth
from treadload.damage.miner import Life
from treadload.describing import first_line
from treadload.errors import InputError
from treadload.pavement import Pavement
from treadload.results import Study, to_tree
from treadload.study.aged import longer_by_ageing
from treadload.study.contacts import Contacts, Progress
from treadload.study.designing import ThicknessDesign, design_thickness
from treadload.study.equivalents import Equivalents, life_equivalents
from treadload.study.growth import grow_cracks
from treadload.study.life import solve_life
from treadload.study.reliability import Reliability, life_reliability, roads_asked
from treadload.study.seasons import warmed
from treadload.study.sensitivity import Sensitivity, life_sensitivity

Shown = Callable[[str, BaseResult], None]


@dataclass(frozen=True, eq=False)
class LifeResult(Study):
    """What a design case gave.

    road: whose materials wait for their temperature. sensitivity: None if it was not asked for, or no criterion
    ever fails. reliability: None where the case has no [reliability], or no criterion ever fails. growth: None where
    the case has no [growth]. equivalents: the traffic in standard axles, the climate as one temperature.
    """

    case: LifeCase
    road: Pavement
    life: Life
    sensitivity: Sensitivity | None
    reliability: Reliability | None = None
    growth: Growth | None = None
    equivalents: Equivalents | None = None

    @property
    def parts(self) -> Mapping[str, BaseResult]:
        """Its results by their names in a tree."""
        parts: dict[str, BaseResult | None] = {
            "life": self.life, "sensitivity": self.sensitivity, "reliability": self.reliability,
            "growth": self.growth, "equivalents": self.equivalents,
        }  # fmt: skip
        return {name: part for name, part in parts.items() if part is not None}

    def to_tree(self) -> xr.DataTree:
        """The life in one tree with provenance, ready to be saved; the road in the season that does most damage."""
        shares = self.life.dataset["damage_share"].sel(criterion=self.life.governing_criterion).sum("axle_class")
        season = self.life.climate.seasons[int(np.argmax(shares.to_numpy()))]
        road = warmed(self.road, (), season).road
        return to_tree(self.parts, case=self.case, road=road, season=season, summary=self.summary())

    def summary(self) -> str:
        """One screen: life by criterion, the governing one, what it depends on, how much was solved."""
        return "\n\n".join(str(part) for part in self.parts.values())

    __repr__ = first_line


def run_life(
    case: LifeCase,
    *,
    sensitivity: bool = True,
    workers: int | None = None,
    progress: Progress | None = None,
    shown: Shown | None = None,
) -> LifeResult:
    """The life of the road of a case and its sensitivities; its reliability, a crack's growth where the case asks.

    sensitivity: False to leave them out. workers: threads; all cores if left out. progress: called after every solve.
    shown: called with the name of each result and the result as soon as it is there.
    Raises the errors of reading, contact and response.
    """
    tire, road, spacing = case.build_tire(), case.build_road(), case.spacing
    tell = shown or (lambda name, part: None)
    if case.reliability is not None:
        # What cannot scatter is refused before anything is solved.
        roads_asked(road, case.build_criteria(), case.reliability.build())
    contacts = Contacts(tire, spacing)
    shared: dict[str, Any] = {"spacing": spacing, "workers": workers, "progress": progress, "contacts": contacts}
    question = (tire, road, case.build_traffic(), case.build_climate(), case.build_criteria())
    rutting = None if case.rutting is None else case.rutting.build()
    life = solve_life(*question, tolerance=case.tolerance, rutting=rutting, **shared)
    longer = longer_by_ageing(*question, life, tolerance=case.tolerance, **shared)
    life = replace(life, warnings=(*life.warnings, *longer))
    tell("life", life)
    ends = np.isfinite(life.years(life.governing_criterion))
    depends = life_sensitivity(tire, road, life, **shared) if sensitivity and ends else None
    if depends is not None:
        tell("sensitivity", depends)
    part = case.reliability
    scatters = None if part is None or not ends else life_reliability(tire, road, life, **part.asked(), **shared)
    if scatters is not None:
        tell("reliability", scatters)
    crack = None
    if case.growth is not None:
        asked = case.growth.build(case.build_criteria())
        crack = grow_cracks(tire, road, life, asked, contacts=contacts, workers=workers, progress=progress)
        tell("growth", crack)
    alike = life_equivalents(road, life, workers=workers)
    tell("equivalents", alike)
    return LifeResult(case, road, life, depends, scatters, crack, alike)


def design_case(
    case: LifeCase,
    *,
    layer: int | str,
    years: float | None = None,
    risk: float | None = None,
    workers: int | None = None,
    progress: Progress | None = None,
    **asked: Any,
) -> ThicknessDesign:
    """The thickness of a layer for which the road of a case lasts.

    layer: its name, or its number from the surface, 1 the top one, as in `[[criteria]]`. years: those of the traffic
    if left out. risk: of failing, in (0, 1); with `[reliability]` in the case the years at that risk are those of its
    scatter. asked: low, high and step, m, see `design_thickness`. workers, progress: as in `run_life`. Raises
    InputError, and ConvergenceError of a contact.
    """
    road, number = case.build_road(), layer
    if isinstance(layer, int):
        if not 1 <= layer <= len(road.layers):
            raise InputError(f"no layer {layer}; the road has 1 to {len(road.layers)}, counted from the surface")
        number = layer - 1
    scatter = None if case.reliability is None or risk is None else case.reliability.build()
    rutting = None if case.rutting is None else case.rutting.build()
    return design_thickness(
        case.build_tire(), road, case.build_traffic(), case.build_climate(),
        lambda changed: tuple(one.on(changed) for one in case.criteria),
        layer=number, years=years, risk=risk, scatter=scatter, spacing=case.spacing, tolerance=case.tolerance,
        rutting=rutting, workers=workers, progress=progress, **asked,
    )  # fmt: skip
