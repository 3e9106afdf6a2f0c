"""The reliability of a life."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from treadload.composing import BaseResult, Holds
from treadload.damage.scatter import Scatter
from treadload.describing import first_line
from treadload.errors import InputError

# Decades of strain per metre of thickness that k_r takes, see `damage.laws.french.risk_factor`.
_FRENCH_SLOPE = 2.0
# Inputs that do more than this share of the scatter are told.
_WORTH = 0.005


@dataclass(frozen=True, eq=False)
class Reliability(BaseResult, group="reliability"):
    """How long a road lasts, with which probability, and by what that scatters.

    dataset: years_at_risk, years_at_risk_first_order, risk_factor (criterion, risk); failure_probability,
    failure_probability_first_order (criterion, year); importance (criterion, input), α² of the first order at the
    smallest risk; road_years_at_risk (risk) and road_failure_probability (year) of the first criterion to fail;
    thickness_slope, surface_error, coverage (criterion). scatter: what was asked. stats: what was solved and drawn.
    warnings: sentences for the user.
    """

    holds: ClassVar[Holds] = Holds(
        {
            "years_at_risk years_at_risk_first_order risk_factor": "criterion risk",
            "failure_probability failure_probability_first_order": "criterion year",
            "importance": "criterion input",
            "road_years_at_risk": "risk",
            "road_failure_probability": "year",
            "thickness_slope surface_error coverage fatigue_scatter": "criterion",
            "law_risk law_risk_factor law_years": "criterion",
            "risk": "risk",
            "year": "year",
        },
        labels={"criterion": "criterion", "input": "input"},
        lists="deviations ends",
        maybe_numbers="design_years",
        stats=("contacts responses points draws seed seconds",),
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
                f"years at a risk of {risk:g} were not asked for; known are {', '.join(f'{one:g}' for one in risks)}"
            )
        if criterion is None:
            return float(data["road_years_at_risk"][near[0]])
        if criterion not in data["criterion"].to_numpy():
            known = ", ".join(map(str, data["criterion"].to_numpy()))
            raise InputError(f"no criterion {criterion!r} in this reliability; it has {known}")
        return float(data["years_at_risk"].sel(criterion=criterion)[near[0]])

    def summary(self) -> str:
        """Years of every criterion at the risks, what scatters most, and what the laws and the method say."""
        data = self.dataset
        risks = ", ".join(f"{100 * risk:g} %" for risk in data["risk"].to_numpy())
        ends, words = (json.loads(data.attrs[name]) for name in ("ends", "deviations"))
        lines = [f"reliability: years until failure with a probability of {risks}"]
        for k, name in enumerate(data["criterion"].to_numpy()):
            row = data.isel(criterion=k)
            lines.append(
                f"  {name}: {_list(row['years_at_risk'])} years, to the first order "
                f"{_list(row['years_at_risk_first_order'])}; failure means {ends[k]}"
            )
            lines.append(f"    scatters by {_shares(row, words)}")
            slope = float(row["thickness_slope"])
            if math.isfinite(slope):
                lines.append(
                    f"    its strain loses {slope / 100:.3g} decades per cm of thickness; the French method takes "
                    f"{_FRENCH_SLOPE / 100:g}"
                )
            if math.isfinite(float(row["law_risk_factor"])):
                risk, factor, years = (float(row[f"law_{one}"]) for one in ("risk", "risk_factor", "years"))
                lines.append(
                    f"    its law at {100 * risk:g} % by k_r = {factor:.3f}: {_years(years)} years; that k_r is "
                    "taken out here"
                )
        if data.sizes["criterion"] > 1:
            lines.append(f"  the first of them to fail: {_list(data['road_years_at_risk'])} years")
        if "design_years" in data.attrs:
            lines.append(self._verdict())
        if self.stats:
            lines.append(
                "solved: {responses} responses and {contacts} contacts at {points} points, {draws} draws; strains "
                "are interpolated within {error:.2g} %".format(
                    **self.stats, error=100 * float(np.max(data["surface_error"].to_numpy()))
                )
            )
        return "\n".join(lines + [f"warning: {text}" for text in self.warnings])

    def _verdict(self) -> str:
        data, design = self.dataset, float(self.dataset.attrs["design_years"])
        probability = float(np.interp(design, data["year"].to_numpy(), data["road_failure_probability"].to_numpy()))
        return f"Verdict: the road fails within its design life of {design:g} years with {_percent(probability)}."

    __repr__ = first_line


def _list(years: xr.DataArray) -> str:
    return ", ".join(_years(float(one)) for one in years.to_numpy())


def _years(years: float) -> str:
    return "never" if math.isinf(years) else f"{years:.3g}"


def _percent(probability: float) -> str:
    if probability < 1e-4:
        return "a probability below 0.01 %"
    return f"a probability of {100 * probability:.2g} %"


def _shares(row: xr.Dataset, words: list[str]) -> str:
    """What scatters a criterion, the most important first. words: the deviation of each input."""
    shares = row["importance"].to_numpy()
    names = row["input"].to_numpy()
    words = [*words[:-2], f"SN {float(row['fatigue_scatter']):g}", words[-1]]
    told = [f"{names[k]} ({words[k]}) {100 * shares[k]:.0f} %" for k in np.argsort(-shares) if shares[k] > _WORTH]
    return ", ".join(told) or "nothing: no input that it depends on has a scatter"
