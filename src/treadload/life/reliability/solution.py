"""The reliability of a life."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from treadload.composing import BaseResult, Holds
from treadload.damage.scatter import Scatter
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.rows import Row, row
from treadload.variables import display_of

# Decades of strain per metre of thickness that k_r takes, see `damage.laws.french.risk_factor`.
_FRENCH_SLOPE = 2.0
# Inputs that do more than this share of the scatter are told.
_WORTH = 0.005


@dataclass(frozen=True, eq=False)
class Reliability(BaseResult, group="reliability"):
    """How long a road lasts, with which probability, and by what that scatters.

    dataset: years_at_risk, years_at_risk_first_order, risk_factor (criterion, risk); failure_probability,
    failure_probability_first_order (criterion, year); years_error (criterion, risk) and road_years_error (risk),
    parts of the years by which they may err, NaN where that was not looked for; importance (criterion, input), α² of
    the first order at the smallest risk; road_years_at_risk (risk) and road_failure_probability (year) of the first
    criterion to fail; thickness_slope, surface_error, coverage (criterion). scatter: what was asked. stats: what was
    solved and drawn.
    warnings: sentences for the user.

    >>> from treadload.damage.scatter import Scatter
    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> asphalt, soil = tl.Layer(tl.Elastic(5e9, 0.35), 0.03, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> scatter = Scatter(fatigue=0.25, thickness={"asphalt": 0.002})
    >>> road = tl.Pavement([asphalt, soil])
    >>> design = tl.Design(tire, road, traffic, climate, [base], spacing=0.01, scatter=scatter)
    >>> life, draws = tl.solve_life(design), tl.life.MonteCarlo(draws=10000)
    >>> reliability = tl.life.life_reliability(design, life, held_back=0, sampling=draws)
    >>> shares = reliability.dataset.importance.sel(criterion="base")
    >>> f"{shares.sum().item():.0%}: fatigue, thickness and the surface"
    '100%: fatigue, thickness and the surface'
    """

    title: ClassVar[str] = "Reliability of the service life"
    subject: ClassVar[str] = "How long a road lasts, with a probability"
    holds: ClassVar[Holds] = Holds(
        {
            "years_at_risk years_at_risk_first_order years_error risk_factor": "criterion risk",
            "failure_probability failure_probability_first_order": "criterion year",
            "importance": "criterion input",
            "road_years_at_risk road_years_error": "risk",
            "road_failure_probability": "year",
            "thickness_slope surface_error coverage fatigue_scatter": "criterion",
            "law_risk law_risk_factor law_years": "criterion",
            "risk": "risk",
            "year": "year",
        },
        labels={"criterion": "criterion", "input": "input"},
        lists="deviations ends",
        maybe_numbers="design_years",
        stats=("contacts responses points held_back draws seed seconds",),
        positive="risk year",
    )

    dataset: xr.Dataset
    scatter: Scatter
    stats: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    def years(self, risk: float, criterion: str | None = None) -> float:
        """Years until a criterion, or any of them, has failed with a probability that was asked for.

        Raises InputError for another risk or criterion.
        """
        data, risks = self.dataset, self.dataset["risk"].to_numpy()
        near = np.flatnonzero(np.isclose(risks, risk, rtol=1e-6))
        if not len(near):
            raise InputError(
                f"years at a risk of {risk:g} were not asked for; known are "
                f"{', '.join(f'{number:g}' for number in risks)}"
            )
        if criterion is None:
            return float(data["road_years_at_risk"][near[0]])
        if criterion not in data["criterion"].to_numpy():
            names = ", ".join(map(str, data["criterion"].to_numpy()))
            raise InputError(f"no criterion {criterion!r} in this reliability; it has {names}")
        return float(data["years_at_risk"].sel(criterion=criterion)[near[0]])

    def rows(self) -> tuple[Row, ...]:
        """Service life of every criterion at the risks, what scatters it most, what the laws hold, the assessment."""
        data = self.dataset
        risks = [f"at a risk of {100 * float(risk):g} %" for risk in data["risk"]]
        ends, deviations = (json.loads(data.attrs[name]) for name in ("ends", "deviations"))
        rows: list[Row] = []
        for k, name in enumerate(map(str, data["criterion"].to_numpy())):
            at = data.isel(criterion=k)
            rows += _at_risks(at, risks, "years_at_risk", name)
            rows += _errors(at, "years_error", name)
            rows += _at_risks(at, risks, "years_at_risk_first_order", name)
            rows.append(row("end_of_life", str(ends[k]), group=name))
            rows.append(row("importance", _shares(at, deviations), group=name))
            if math.isfinite(float(at["thickness_slope"])):
                note = f"the French method takes {_FRENCH_SLOPE / 100:g}"
                rows.append(row("thickness_slope", at["thickness_slope"], note=note, group=name))
            if math.isfinite(float(at["law_risk_factor"])):
                risk = f"at {100 * float(at['law_risk']):g} %"
                rows.append(row("law_risk_factor", at["law_risk_factor"], note=risk, group=name))
                rows.append(row("law_years", at["law_years"], note=risk, group=name))
        if data.sizes["criterion"] > 1:
            rows += _at_risks(data, risks, "road_years_at_risk", "")
            rows += _errors(data, "road_years_error", "")
        if self.stats:
            solved = (
                "{responses} responses and {contacts} contacts; {points} points for each criterion, {draws} draws; "
                "the errors of the years are those of {held_back} direct solves held back and of the draws; a strain "
                "left out is interpolated within {error:.2g} %".format(
                    **self.stats, error=100 * float(np.max(data["surface_error"].to_numpy()))
                )
            )
            rows.append(row("solved", solved))
        if "design_years" in data.attrs:
            years = float(data.attrs["design_years"])
            chance = float(np.interp(years, data["year"].to_numpy(), data["road_failure_probability"].to_numpy()))
            rows.append(row("road_failure_probability", chance, note=f"within {years:g} years"))
            rows.append(
                row("verdict", f"the road fails within its design life of {years:g} years with {_percent(chance)}.")
            )
        return tuple(rows)


def _at_risks(at: xr.Dataset, risks: list[str], years: str, group: str) -> list[Row]:
    """Years at the risks, by the name of their variable."""
    label = display_of(years).label
    return [
        row(years, value, label=f"{label} {risk}", group=group) for risk, value in zip(risks, at[years], strict=True)
    ]


def _errors(at: xr.Dataset, error: str, group: str) -> list[Row]:
    """What years at the risks may err by, in a line; none where that was not looked for."""
    texts = [
        f"{_share(float(share))} at {100 * float(risk):g} %"
        for risk, share in zip(at["risk"], at[error], strict=True)
        if not math.isnan(float(share))
    ]
    return [row(error, f"± {', '.join(texts)}", group=group)] if texts else []


def _share(part: float) -> str:
    percent = 100 * part
    return f"{percent:.0f} %" if percent >= 10 else f"{max(percent, 0.1):.1f} %"


def _percent(probability: float) -> str:
    if probability < 1e-4:
        return "a probability below 0.01 %"
    return f"a probability of {100 * probability:.2g} %"


def _shares(row: xr.Dataset, words: list[str]) -> str:
    """What scatters a criterion, the most important first. words: the deviation of each input."""
    shares = row["importance"].to_numpy()
    names = row["input"].to_numpy()
    words = [*words[:-2], f"SN {float(row['fatigue_scatter']):g}", words[-1]]
    texts = [f"{names[k]} ({words[k]}) {100 * shares[k]:.0f} %" for k in np.argsort(-shares) if shares[k] > _WORTH]
    return ", ".join(texts) or "nothing: no input that it depends on has a scatter"
