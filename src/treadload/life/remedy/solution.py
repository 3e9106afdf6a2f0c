"""What would help a road, as a result: years after each remedy, ranked, with its sentences and its table."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from treadload.composing import BaseResult, Holds
from treadload.deferred import xarray as xr
from treadload.rows import Row, row
from treadload.units import LASTS, years_in_words
from treadload.variables import Display, display_of

# Remedies that a criterion's sentence lists, and the part of a life that is worth a mention.
_LISTED, _WORTH = 3, 0.01
HOW = ("summed again from the same responses", "solved again")
"""How a remedy's years came about, by its `solved_anew`; none is by derivative."""


@dataclass(frozen=True, eq=False)
class Remedies(BaseResult, group="remedies"):
    """What would help a road: years after each change that an agency can make, by one step, the best first.

    dataset: over remedy, ranked by years_won: remedy_years (remedy, criterion), road_years and years_won (remedy) of
    the first criterion to fail; solved_anew (remedy), 1 where contacts or responses were solved for it, 0 where the
    evaluated values of the life stay and only the sum is new; life_years (criterion) of the road as it is;
    standard_axles (criterion, axle_class), mean_standard_axles (criterion), see `Equivalents`. A limit of the rut
    counts as a criterion, without standard axles. Attributes: kinds and governing of each remedy, JSON lists.
    skipped: changes that do not apply, and why. stats: how much was solved. warnings: sentences, of laws whose range
    a remedy leaves.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> asphalt, soil = tl.Layer(tl.Elastic(5e9, 0.35), 0.03, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> design = tl.Design(tire, tl.Pavement([asphalt, soil]), traffic, climate, [base], spacing=0.01)
    >>> life = tl.solve_life(design)
    >>> answer = tl.life.remedies(design, life, tl.life.RemedySteps(only=("thickness",)))
    >>> f"{answer.dataset.years_won.max().item():.0f} years won by 2 cm more asphalt"
    '59 years won by 2 cm more asphalt'
    """

    title: ClassVar[str] = "What would help"
    subject: ClassVar[str] = "What would help a road"
    holds: ClassVar[Holds] = Holds(
        {
            "remedy_years": "remedy criterion",
            "road_years years_won solved_anew": "remedy",
            "life_years mean_standard_axles": "criterion",
            "standard_axles": "criterion axle_class",
        },
        labels={"remedy": "remedy", "criterion": "criterion", "axle_class": "axle_class"},
        texts="standard_axle",
        lists="kinds governing",
        codes={"solved_anew": len(HOW)},
        stats=("contacts responses seconds",),
    )

    dataset: xr.Dataset
    skipped: tuple[str, ...] = ()
    stats: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    @property
    def heading(self) -> str:
        """The road as it is."""
        return f"each change by one step; the road as it is lasts {years_in_words(self.years_before)}"

    @property
    def years_before(self) -> float:
        """Years that the road lasts as it is."""
        return float(self.dataset["life_years"].min())

    def best(self, criterion: str) -> list[tuple[str, float]]:
        """Remedies with the years that a criterion lasts after them, the best first. Raises KeyError for no such."""
        after = self.dataset["remedy_years"].sel(criterion=criterion).to_numpy()
        names = [str(name) for name in self.dataset["remedy"].to_numpy()]
        order = np.argsort(-after, kind="stable")
        return [(names[k], float(after[k])) for k in order]

    def sentences(self) -> tuple[str, ...]:
        """A sentence for each remedy, the best first: years before and after, and by which criterion."""
        data, before = self.dataset, self.years_before
        governing = json.loads(data.attrs["governing"])
        first = str(data["criterion"].to_numpy()[int(data["life_years"].to_numpy().argmin())])
        return tuple(
            f"{name}: {_change(before, float(years))} by {by}" + ("" if by == first else f" instead of {first}")
            for name, years, by in zip(
                data["remedy"].to_numpy(), data["road_years"].to_numpy(), governing, strict=True
            )
        )

    def rows(self) -> tuple[Row, ...]:
        """The table of years by remedy and criterion, what helps each criterion, standard axles, the assessment."""
        data = self.dataset
        criteria = [str(name) for name in data["criterion"].to_numpy()]
        rows: list[Row] = []
        for k, name in enumerate(map(str, data["remedy"].to_numpy())):
            rows += [row("road_years", data["road_years"][k], group=name)]
            rows += [row("years_won", data["years_won"][k], group=name)]
            rows += [
                row("remedy_years", years, group=name, label=f"{display_of('remedy_years').label} {criterion}")
                for criterion, years in zip(criteria, data["remedy_years"].to_numpy()[k], strict=True)
            ]
        rows += [row("best_remedy", self._helps(name), label=f"helps {name}") for name in criteria]
        rows += [row("not_applicable", text) for text in self.skipped]
        for k, name in enumerate(map(str, data["axle_class"].to_numpy())):
            rows += [
                row(
                    "standard_axles", value, group=name, display=Display(f"standard axles by {criterion}", "", _axles)
                )
                for criterion, value in zip(criteria, data["standard_axles"].to_numpy()[:, k], strict=True)
                if not np.isnan(data["standard_axles"].sel(criterion=criterion).to_numpy()).all()
            ]
        if self.stats:
            rows.append(row("solved", self._how()))
        return (*rows, row("verdict", self._verdict()))

    def _helps(self, criterion: str) -> str:
        before = float(self.dataset["life_years"].sel(criterion=criterion))
        gains = [
            f"{name}, {_change(before, after)}"
            for name, after in self.best(criterion)
            if after > (1 + _WORTH) * before
        ]
        return "; ".join(gains[:_LISTED]) or f"none of these changes lengthens {years_in_words(before)}"

    def _how(self) -> str:
        anew = self.dataset["solved_anew"].to_numpy().astype(int)
        counts = ", ".join(f"{int((anew == code).sum())} {HOW[code]}" for code in (1, 0) if (anew == code).any())
        return (
            f"{counts or 'none'}, none by derivative; {self.stats['contacts']} contacts and "
            f"{self.stats['responses']} responses"
        )

    def _verdict(self) -> str:
        data = self.dataset
        if not data.sizes["remedy"] or not float(data["years_won"][0]) > _WORTH * self.years_before:
            return (
                f"none of these changes, by one step, lengthens {years_in_words(self.years_before)} by more than 1 %."
            )
        helpful = [
            text
            for text, won in zip(self.sentences(), data["years_won"].to_numpy(), strict=True)
            if won > _WORTH * self.years_before
        ]
        return "; ".join(helpful[:_LISTED]) + "."


def _change(before: float, after: float) -> str:
    """Years before and after, "12 → 19 years"."""
    if math.isfinite(before) and before <= LASTS and math.isfinite(after) and after <= LASTS:
        return f"{before:.3g} → {after:.3g} years"
    if math.isfinite(after) and min(before, after) > LASTS:
        return f"{years_in_words(before)} before and after, {after / before:.2f} times as long"
    return f"{years_in_words(before)} → {years_in_words(after)}"


def _axles(value: float) -> str:
    return "–" if math.isnan(value) else f"{value:.3g}"
