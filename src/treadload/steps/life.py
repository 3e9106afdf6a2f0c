"""Service life of a road: its traffic, its climate, its criteria."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar

import numpy as np

from treadload.case.description import Description
from treadload.case.step import Results, Source, at_key, numbers_of
from treadload.damage import Life
from treadload.damage.climate import Climate, Season
from treadload.deferred import xarray as xr
from treadload.life.ageing import longer_by_ageing
from treadload.life.caveats import traffic_caveats
from treadload.life.design import DEFAULT_TOLERANCE
from treadload.life.reliability import number_of_roads
from treadload.life.seasons import warmed
from treadload.life.solve import solve_life
from treadload.life.wheels import state
from treadload.pavement import Pavement
from treadload.pavement.sublayers import middle_temperatures
from treadload.steps.design import spacing_of
from treadload.steps.outline import Outline
from treadload.steps.scene import Scene

_MARKS = frozenset({"traffic", "climate", "ageing", "criteria"})


class LifeStep(Source, name="life"):
    """The service life of a road under `[traffic]` and `[climate]`, by its `[[criteria]]`.

    >>> axle = {"name": "axle", "share": 1, "axle_load": "100 kN", "inflation_pressure": "8 bar"}
    >>> case = {"tire": {"profile": "315/80R22.5"}, "pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3"}}
    >>> case |= {"traffic": {"passes_per_year": 1e5, "classes": [axle]}, "climate": {"temperature": 15}}
    >>> case["criteria"] = [{"name": "soil", "law": "french-subgrade"}]
    >>> print(tl.plan(tl.Case.from_dict(case)).splitlines()[-1])
    criterion soil: French method, subgrade, 12000 microstrain x N^-0.222 at 210 mm
    """

    uses: ClassVar = ("title", "spacing", "tolerance", "tire", "pavement", "traffic", "climate", "ageing", "criteria")
    needs: ClassVar = ("tire", "pavement", "traffic", "climate")
    command: ClassVar = "life"
    # Of values interpolated over the climate; 0 solves every season.
    tolerances: ClassVar = (0.0, DEFAULT_TOLERANCE, 0.5)
    has_table: ClassVar = False
    swept: ClassVar = True
    waits_for_temperature: ClassVar = True
    states_road: ClassVar = False
    hidden: ClassVar = ("pavement.temperature", "pavement.extrapolate")

    @classmethod
    def wanted(cls, case: Description) -> LifeStep | None:
        """The step of a case with a traffic, a climate or criteria."""
        return cls() if case.model_fields_set & _MARKS else None

    @classmethod
    def stray_text(cls, key: str) -> str:
        """What a case with a traffic is not."""
        return f"a case with [traffic], [climate] and [[criteria]] has no use for {key!r}; leave it out"

    def check(self, case: Description) -> None:
        """Refuse criteria, temperatures and materials that do not go together."""
        keys = set() if case.pavement is None else case.pavement.model_fields_set
        for path in self.hidden:
            if path.rpartition(".")[2] in keys:
                raise at_key(path, "it is not allowed here: the road takes the temperatures of [climate]")
        road, climate = case.road(), case.build_climate()
        if not case.criteria:
            raise ValueError("a life needs at least one of [[criteria]], got none")
        names = [criterion.name for criterion in case.criteria]
        twice = next((name for name in names if names.count(name) > 1), None)
        if twice is not None:
            raise ValueError(f"two criteria have the name {twice!r}; give them different names")
        case.build_traffic()
        temperatures = {season.temperature for season in climate.seasons}
        waiting = any(layer.depends_on_temperature for layer in road.layers)
        if case.ageing is not None and not waiting:
            raise ValueError(
                "ageing needs a mix with moduli over temperature, and no layer has one; give mixes of the catalogue "
                "or materials with a shift"
            )
        if len(temperatures) > 1 and not waiting:
            raise ValueError(
                f"the climate has {len(temperatures)} temperatures, but no layer has moduli for them; give mixes of "
                "the catalogue or materials with a shift, or one temperature"
            )
        self._check_seasons(case, road, climate)

    def _check_seasons(self, case: Description, road: Pavement, climate: Climate) -> None:
        criteria = case.build_criteria()
        for season in climate.seasons:
            profile, warm = season.profile, season.temperatures
            if profile is None:
                each = list(warm) if isinstance(season.temperature, tuple) else [*warm] * len(road.layers)
                warmed_road = road.at_temperature(season.temperature)
            else:
                warmed_road = road.at_temperature(middle_temperatures(road, profile), extrapolate=True)
            for criterion in criteria:
                number = criterion.number(road)
                criterion.depth(warmed_road)
                if profile is None:
                    criterion.law_at(each[number])

    def solve(self, scene: Scene) -> Life:
        """Damage by class, season and criterion, and the years until it is 1."""
        case = scene.case
        if case.reliability is not None:
            # What cannot scatter is refused before anything is solved.
            number_of_roads(case.road(), case.build_criteria(), case.reliability.build())
        workers, progress = scene.options.workers, scene.progress.count
        life = solve_life(scene.design, workers=workers, progress=progress)
        longer = longer_by_ageing(scene.design, life, workers=workers, progress=progress)
        return replace(life, warnings=(*life.warnings, *longer, *case.left_out))

    def numbers(self, scene: Scene) -> xr.Dataset:
        """Numbers of every criterion, and which fails first."""
        life = scene.result("life")
        assert isinstance(life, Life)
        kept = {row.key: row.value for row in life.rows() if row.key in ("governing", "governing_years")}
        return numbers_of(life.dataset, ("criterion",)).assign(kept)

    def cites(self, case: Description) -> tuple[str, ...]:
        """Methods of a wheel on the road, and of Miner's sum."""
        return (*super().cites(case), "miner")

    def plan(self, outline: Outline) -> None:
        """Contacts, responses, criteria."""
        case = outline.case
        tire, road, traffic = case.build_tire(), case.road(), case.build_traffic()
        criteria, climate = case.build_criteria(), case.build_climate()
        warm = [warmed(road, criteria, season) for season in climate.seasons]
        distinct = [season for k, season in enumerate(warm) if season not in warm[:k]]
        contacts = len({state(row) for row in traffic.classes})
        outline.add("tire", f"{tire}")
        outline.add(
            "traffic",
            f"{traffic.passes_per_year:g} passes in the first year in {len(traffic.classes)} classes: "
            + ", ".join(f"{row.name} {100 * row.share:g} %" for row in traffic.classes),
        )
        outline.add("climate", f"{len(climate.seasons)} season(s), {len(distinct)} of them different")
        outline.add("contacts", f"{contacts} on cells of {spacing_of(case) * 1e3:g} mm")
        outline.add(
            "responses",
            f"{len(traffic.classes) * len(distinct)} at most, fewer where readings are interpolated over the "
            "climate; the sensitivities take about as many again",
        )
        outline.lines += [
            f"criterion {criterion.name}: {criterion.law_at(15.0)} at {criterion.depth(road) * 1e3:g} mm"
            for criterion in criteria
        ]
        outline.warnings += traffic_caveats(tire, traffic, climate)

    def road_of(self, case: Description, results: Results) -> tuple[Pavement | None, Season | None]:
        """The road in the season that does most damage."""
        life = results["life"]
        assert isinstance(life, Life)
        shares = life.dataset["damage_share"].sel(criterion=life.governing_criterion).sum("axle_class")
        season = life.climate.seasons[int(np.argmax(shares.to_numpy()))]
        return warmed(case.road(), (), season).road, season


def fails(life: Life) -> bool:
    """True if the governing criterion ever fails."""
    return bool(np.isfinite(life.years(life.governing_criterion)))
