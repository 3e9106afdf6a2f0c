"""Miner's sum: the damage of a mixed traffic over a year, across the wheel path, for every criterion."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import xarray as xr

from treadload import variables
from treadload.damage.design import Criterion
from treadload.damage.fatigue import in_words, warnings_of
from treadload.damage.traffic import Climate, Traffic
from treadload.errors import InputError
from treadload.kernels.arrays import Array


@dataclass(frozen=True, eq=False)
class Life:
    """How long a road lasts under a traffic.

    dataset: damage_per_year (criterion, y), of the first year, after wander; damage_share (criterion, axle_class,
    season) of it at the worst y; life_years, life_passes, worst_y, largest_reading (criterion). criteria, traffic,
    climate: what was asked. stats: solves and errors behind the readings. warnings: sentences for the user.
    """

    dataset: xr.Dataset
    criteria: tuple[Criterion, ...]
    traffic: Traffic
    climate: Climate
    stats: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    @property
    def governing(self) -> str:
        """Name of the criterion that fails first."""
        return str(self.dataset["criterion"].to_numpy()[int(np.argmin(self.dataset["life_years"].to_numpy()))])

    def years(self, criterion: str) -> float:
        """Years from the opening until a criterion's damage is 1 at its worst place; inf if never."""
        return float(self.dataset["life_years"].sel(criterion=criterion))

    def summary(self) -> str:
        """Life of every criterion, the governing one, and what eats it."""
        data = self.dataset
        lines = [
            f"life under {self.traffic.passes_per_year:.4g} passes in the first year, growth "
            f"{100 * self.traffic.growth:g} % a year, {self.traffic.wander}, {len(self.climate.seasons)} season(s)"
        ]
        for criterion in self.criteria:
            row = data.sel(criterion=criterion.name)
            law = criterion.law_at(15.0)
            share = row["damage_share"].to_numpy()
            worst = np.unravel_index(int(np.argmax(share)), share.shape)
            lines.append(
                f"  {criterion.name}: {_years(float(row['life_years']))}, {float(row['life_passes']):.3g} passes; "
                f"largest {criterion.quantity} {in_words(law, float(row['largest_reading']))} at "
                f"y = {float(row['worst_y']) * 1e3:.0f} mm; most by {data['axle_class'].to_numpy()[worst[0]]}, "
                f"{data['season'].to_numpy()[worst[1]]} ({100 * share[worst]:.0f} %)"
            )
        if math.isinf(self.years(self.governing)):
            lines.append("Verdict: no criterion is ever used up by this traffic.")
        else:
            lines.append(f"Verdict: {self.governing} governs, after {_years(self.years(self.governing))}.")
        if self.stats:
            lines.append(
                "solved: {contacts} contacts and {responses} responses for {combinations} combinations; readings "
                "interpolated over temperature err by {interpolation_error:.1g} at most".format(**self.stats)
            )
        return "\n".join(lines + [f"warning: {text}" for text in self.warnings])

    def __str__(self) -> str:
        return self.summary()


def miner(
    readings: xr.DataArray | Array,
    criteria: Sequence[Criterion],
    traffic: Traffic,
    climate: Climate,
    *,
    y: Array | None = None,
    layer_temperatures: Array | None = None,
) -> Life:
    """Life of a road by Miner's sum, D = Σ n / N, over classes of axles and seasons, after wander.

    readings: (criterion, axle_class, season, y), what each criterion's law reads as a wheel passes, in the order
    of criteria, traffic.classes and climate.seasons; one cycle a passage. y: evenly spaced, m; left out, the
    coordinate of readings. layer_temperatures: (criterion, season), °C, for laws that depend on it; left out, the
    seasons' one temperature.
    The years are those after which the damage at the worst place is 1. Raises InputError for wrong shapes.
    """
    values = np.asarray(readings, dtype=float)
    expected = (len(criteria), len(traffic.classes), len(climate.seasons))
    if values.ndim != 4 or values.shape[:3] != expected:
        raise InputError(
            f"readings must be (criterion, axle_class, season, y) = {expected} and y, got {values.shape}"
        )
    at = np.asarray(readings["y"] if y is None and isinstance(readings, xr.DataArray) else y, dtype=float)
    if at.shape != (values.shape[3],) or len(at) < 2 or np.ptp(np.diff(at)) > 1e-6 * abs(at[1] - at[0]):
        raise InputError(f"y must be {values.shape[3]} evenly spaced values in m, got shape {at.shape}")
    if layer_temperatures is None:
        if any(isinstance(season.temperature, tuple) for season in climate.seasons):
            raise InputError("seasons with a temperature for each layer need layer_temperatures (criterion, season)")
        one = [float(season.temperature) for season in climate.seasons]  # type: ignore[arg-type]
        layer_temperatures = np.tile(one, (len(criteria), 1))
    spacing = float(at[1] - at[0])
    cycles = (
        traffic.passes_per_year
        * np.array([row.share for row in traffic.classes])[:, None]
        * np.array([season.share for season in climate.seasons])
    )
    damage = np.empty_like(values)
    warnings: list[str] = []
    for k, criterion in enumerate(criteria):
        for s in range(len(climate.seasons)):
            law = criterion.law_at(float(layer_temperatures[k, s]))
            allowed = np.asarray(law.allowable_passes(values[k, :, s]))
            damage[k, :, s] = cycles[:, s, None] / allowed
            warnings += warnings_of(law, values[k, :, s])
    spread = traffic.wander.spread(damage, spacing)
    margin = (spread.shape[-1] - len(at)) // 2
    wide = at[0] + spacing * (np.arange(spread.shape[-1]) - margin)
    yearly = spread.sum(axis=(1, 2))
    worst = yearly.argmax(axis=-1)
    peak = np.take_along_axis(yearly, worst[:, None], axis=-1)[:, 0]
    shares = np.stack([part[..., column] for part, column in zip(spread, worst, strict=True)])
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = np.where(peak[:, None, None] > 0, shares / peak[:, None, None], 0.0)
        passes = np.where(peak > 0, traffic.passes_per_year / peak, math.inf)
    names = [criterion.name for criterion in criteria]
    dataset = variables.dataset(
        {
            "damage_per_year": (("criterion", "y"), yearly),
            "damage_share": (("criterion", "axle_class", "season"), shares),
            "life_years": (("criterion",), [traffic.years_to(float(p)) for p in passes]),
            "life_passes": (("criterion",), passes),
            "worst_y": (("criterion",), wide[worst]),
            "largest_reading": (("criterion",), values.max(axis=(1, 2, 3))),
        },
        {
            "criterion": names,
            "axle_class": [row.name for row in traffic.classes],
            "season": [season.name for season in climate.seasons],
            "y": wide,
        },
        passes_per_year=traffic.passes_per_year,
        growth=traffic.growth,
        growth_kind=traffic.kind,
        wander=str(traffic.wander),
        laws=json.dumps([str(criterion.law_at(15.0)) for criterion in criteria], ensure_ascii=False),
        sources=json.dumps([criterion.law_at(15.0).source for criterion in criteria], ensure_ascii=False),
        quantities=json.dumps([criterion.quantity for criterion in criteria], ensure_ascii=False),
    )
    return Life(dataset, tuple(criteria), traffic, climate, warnings=tuple(dict.fromkeys(warnings)))


def passes_in_two_phases(before: Array, after: Array, change: float) -> Array:
    """Passes until Miner's sum is 1 where the road changes on the way: n₁ d₁ + (n - n₁) d₂ = 1.

    before, after: d₁ and d₂, damage of a pass, any shape, >= 0. change: n₁, passes until the change, >= 0 or inf.
    What is used up before the change fails as if there were none; inf where no damage is done.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        alone = np.where(before > 0, 1 / before, np.inf)
        left = np.where(before > 0, 1 - change * before, 1.0)
        later = change + np.where(after > 0, left / after, np.inf)
    return np.where(alone <= change, alone, later)


def _years(years: float) -> str:
    return "never" if math.isinf(years) else f"{years:.3g} years"
