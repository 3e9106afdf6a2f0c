"""The words of a life: each criterion's line, who does its damage, the rut, the verdict, and cautions."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from treadload.damage.climate import MONTHS, Climate
from treadload.damage.cracks import HORIZONTAL, ORIENTATIONS
from treadload.damage.criterion import Criterion
from treadload.damage.laws.fatigue import FatigueLaw, warnings_of
from treadload.damage.traffic import Traffic
from treadload.kernels.arrays import Array

# Damage across flat planes above this share of a criterion's is worth a sentence.
_MOSTLY = 0.2
# Years beyond which no road is known and no number of a law is meant, a; files keep the number.
LASTS = 1000.0
RUT = "rut"
"""What a life calls its rut among what ends it."""


def life_in_words(data: xr.Dataset, criteria: Sequence[Criterion], traffic: Traffic, climate: Climate) -> list[str]:
    """Lines on what was asked, on every criterion, on groups of axles and on the rut. data: of a `Life`."""
    lines = [
        f"life under {traffic.passes_per_year:.4g} passes in the first year, growth "
        f"{100 * traffic.growth:g} % per year, {traffic.wander}, {len(climate.seasons)} season(s)"
    ]
    years = traffic.years
    allowed = "the passes of a year" if years is None else f"the passes of {years:g} years"
    between = json.loads(data.attrs.get("between", "{}"))
    for criterion in criteria:
        row = data.sel(criterion=criterion.name)
        law = criterion.law_at(15.0)
        used = ""
        if "design_utilisation" in row:
            used = f", {float(row['design_utilisation']):.2g} of what is allowed for {allowed}"
        lines.append(
            f"  {criterion.name}{_of(between.get(criterion.name))}: {years_in_words(float(row['life_years']))}, "
            f"{float(row['life_passes']):.3g} passes; "
            f"largest {criterion.quantity} {criterion.quantity.in_words(float(row['largest_reading']))} at "
            f"y = {float(row['worst_y']) * 1e3:z.0f} mm{used}; {by_whom(row)}; "
            f"damage 1 means {law.end_of_life}"
        )
    lines += [f"  {text}" for text in json.loads(data.attrs.get("groups", "[]"))]
    rut = rut_in_words(data)
    return lines + ([f"  {rut}"] if rut else [])


def verdict_in_words(governing: str, years: float) -> str:
    """What ends a road first, a criterion or `RUT`, and after how many years."""
    if governing == RUT:
        return f"Verdict: the rut governs, after {years_in_words(years)}."
    if math.isinf(years):
        return "Verdict: no criterion ever fails under this traffic."
    return f"Verdict: {governing} governs, after {years_in_words(years)}."


def by_whom(row: xr.Dataset) -> str:
    """The class and season that do most of a criterion's damage, and what the weather does."""
    share = row["damage_share"].to_numpy()
    worst = np.unravel_index(int(np.argmax(share)), share.shape)
    by = (
        f"most by {row['axle_class'].to_numpy()[worst[0]]}, {row['season'].to_numpy()[worst[1]]} "
        f"({100 * share[worst]:.0f} %)"
    )
    told = [by] if share[worst] > 0 else []
    told += filter(None, [weather_in_words(row)])
    return ", ".join(told) or "no damage"


def weather_in_words(row: xr.Dataset) -> str:
    """What daily thermal stress does of a criterion's damage, in words; empty where it does nothing."""
    if "weather_share" not in row or not float(row["weather_share"].sum()) > 0:
        return ""
    share = row["weather_share"].to_numpy()
    month = int(share.argmax())
    return (
        f"by the weather alone {100 * share.sum():.2g} %, most in {MONTHS[month]}, "
        f"{float(row['weather_stress'][month]) / 1e6:.2g} MPa"
    )


def rut_in_words(data: xr.Dataset) -> str:
    """The rut of a life, layer by layer, and when it reaches its limit; empty without one."""
    if "rut_depth" not in data:
        return ""
    last = 1e3 * data["rut_depth"].to_numpy()[:, -1]
    names = json.loads(data.attrs["rut_names"])
    by = ", ".join(f"{name} {depth:.2g}" for name, depth in zip(names, last, strict=True) if depth > 0)
    told = f"rut after {float(data['year'][-1]):g} years: {last.sum():.3g} mm ({by})"
    if "rut_limit" not in data.attrs:
        return told
    when = float(data.attrs["rut_years"])
    reached = "is never reached" if math.isinf(when) else f"is reached after {years_in_words(when)}"
    return f"{told}; the limit of {1e3 * float(data.attrs['rut_limit']):g} mm {reached}"


def years_in_words(years: float) -> str:
    """Years with three digits, that they are more than roads last, or that they never end."""
    if math.isinf(years):
        return "never"
    return f"{years:.3g} years" if years <= LASTS else f"more than {LASTS:g} years"


def asked_in_words(criteria: Sequence[Criterion], laws: Sequence[FatigueLaw]) -> dict[str, str]:
    """What a file says of criteria and their laws, a law for each: attributes, JSON."""
    said: dict[str, list[Any]] = {
        "laws": [str(one.law_at(15.0)) for one in criteria],
        "sources": [one.law_at(15.0).source for one in criteria],
        "doubts": [
            "; ".join(filter(None, (law.doubt, one.quantity.doubt))) for law, one in zip(laws, criteria, strict=True)
        ],
        "ends": [law.end_of_life for law in laws],
        "reads": [one.quantity.about for one in criteria],
        "proposed": [_proposed(one, law) for one, law in zip(criteria, laws, strict=True)],
        "places": [one.place for one in criteria],
    }
    return {name: json.dumps(texts, ensure_ascii=name == "places") for name, texts in said.items()}


def cautions(
    data: xr.Dataset,
    criteria: Sequence[Criterion],
    laws: Sequence[Sequence[Sequence[FatigueLaw]]],
    readings: Array,
    shares: Array,
    twice: Sequence[bool],
) -> tuple[str, ...]:
    """Sentences for the user of a life.

    laws: (criterion, axle_class, season). readings: (criterion, axle_class, season, turn, y). shares: of the damage,
    (criterion, axle_class, season). twice: of each criterion, whether its law includes the wander of the traffic.
    """
    said = [
        f"{criterion.name}: {text}"
        for k, criterion in enumerate(criteria)
        for text in _warnings(laws[k], readings[k], shares[k])
    ]
    said += [f"{one.name}: {one.quantity}: {one.quantity.doubt}" for one in criteria if one.quantity.doubt]
    said += [
        f"{one.name}: its law was calibrated on roads on which wheels wander, so that the traffic's wander is left "
        f"out here and the life is {years_in_words(years)}; counted twice it would be "
        f"{data['life_years_with_wander'].item(k) / years:.3g} times as long"
        for k, (one, years) in enumerate(zip(criteria, data["life_years"].to_numpy().tolist(), strict=True))
        if twice[k] and math.isfinite(years)
    ]
    return tuple(dict.fromkeys(said + _flat(data, criteria)))


def _proposed(criterion: Criterion, law: FatigueLaw) -> str:
    """Who proposed a criterion: of a law of any quantity whoever proposed that, else the law's source."""
    any_quantity = dataclasses.is_dataclass(law) and any(one.name == "reads" for one in dataclasses.fields(law))
    return criterion.quantity.source if any_quantity else law.source


def _flat(data: xr.Dataset, criteria: Sequence[Criterion]) -> list[str]:
    """Sentences on criteria of extension whose damage splits the road parallel to its surface."""
    if "orientation_damage" not in data:
        return []
    shares = data["orientation_damage"].sel(orientation=ORIENTATIONS[HORIZONTAL]).to_numpy()
    return [
        f"{name}: {100 * share:.0f} % of its damage is read across planes closer to horizontal than 45°, which "
        "split the road parallel to its surface: no crack from the surface down, nor from the bottom up; read "
        + ('strain = "in-plane" for those' if one.quantity.extends else "in_plane_extension for those")
        for name, share, one in zip(data["criterion"].to_numpy(), shares, criteria, strict=True)
        if share > _MOSTLY and not one.quantity.between_layers
    ]


def _warnings(laws: Sequence[Sequence[FatigueLaw]], values: Array, shares: Array) -> list[str]:
    """Sentences on a criterion: of the season that does most, and of that which is read largest."""
    seasons = dict.fromkeys([int(shares.sum(axis=0).argmax()), int(values.max(axis=(0, 2, 3)).argmax())])
    heaviest = int(values.max(axis=(1, 2, 3)).argmax())
    return [text for season in seasons for text in warnings_of(laws[heaviest][season], values[:, season])]


def _of(place: str | None) -> str:
    return f" ({place})" if place else ""
