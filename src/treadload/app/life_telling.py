"""What the page says of a life: rows in the digits of its summary, and its figures."""

from __future__ import annotations

import base64
import io
from collections.abc import Callable, Mapping
from typing import Any

from treadload.app.telling import Row, row
from treadload.composing import BaseResult
from treadload.damage.miner import Life
from treadload.damage.words import years_in_words
from treadload.plots import growth, life, reliability, ruts

# Inputs that a life depends on, of which this many are told.
_INPUTS = 6
# Shares below this are not told, %.
_LEAST = 0.5


def life_rows(parts: Mapping[str, BaseResult], criterion: str = "") -> list[Row]:
    """Years by criterion, who does the damage and when, what it depends on.

    criterion: whose damage is shared out; left out, the governing one.
    """
    held = parts.get("life")
    if not isinstance(held, Life):
        return []
    data = held.dataset
    names = [str(name) for name in data["criterion"].to_numpy()]
    rows = [row("governs", "Governs", held.governing, group="life", criterion=held.governing_criterion)]
    for name in names:
        one = data.sel(criterion=name)
        place = (
            f"largest reading at y = {float(one['worst_y']) * 1e3:z.0f} mm, {float(one['life_passes']):.3g} passes"
        )
        rows.append(row(f"years:{name}", name, years(held.years(name)), group="life", criterion=name, note=place))
    chosen = criterion if criterion in names else held.governing_criterion
    share = 100 * data["damage_share"].sel(criterion=chosen)
    for dim, key, group in (("axle_class", "who", "who"), ("season", "when", "when")):
        others = [one for one in share.dims if one != dim]
        totals = share.sum(others)
        for name, value in zip(totals[dim].to_numpy(), totals.to_numpy(), strict=True):
            if value >= _LEAST:
                rows.append(row(f"{key}:{name}", str(name), f"{value:.0f} %", group=group, note=f"of {chosen}"))
    rows += _depends(parts) + _probabilities(parts)
    stats = held.stats
    if stats:
        rows += [
            row("contacts", "Contacts", f"{stats['contacts']}", group="solver"),
            row("responses", "Responses", f"{stats['responses']}", group="solver"),
            row("combinations", "Combinations", f"{stats['combinations']}", group="solver"),
        ]
    return rows


def _depends(parts: Mapping[str, BaseResult]) -> list[Row]:
    if "sensitivity" not in parts:
        return []
    data = parts["sensitivity"].dataset
    told = zip([str(name) for name in data["input"].to_numpy()], data["elasticity"].to_numpy(), strict=True)
    return [
        row(f"input:{name}", name, f"{life.life_change(name, float(value)):+.1f} %", group="depends",
            note="change of the life as this grows by 5 %, temperature by 1 °C")
        for name, value in list(told)[:_INPUTS]
    ]  # fmt: skip


def _probabilities(parts: Mapping[str, BaseResult]) -> list[Row]:
    if "reliability" not in parts:
        return []
    verdict = [line for line in parts["reliability"].summary().splitlines() if line.startswith("Verdict: ")]
    return (
        [row("probability", "Probability", "", group="risk", note=verdict[0].removeprefix("Verdict: "))]
        if verdict
        else []
    )


def years(value: float) -> str:
    """Years as the summary of a life has them."""
    return years_in_words(value)


def pictures_of(name: str, part: BaseResult) -> dict[str, str]:
    """Figures of a part of a life, as data URLs, by their names. name: of the part."""
    draws: dict[str, dict[str, Callable[[Any], Any]]] = {
        "life": {"years": life.life_years, "shares": life.life_shares, "across": life.life_damage},
        "sensitivity": {"inputs": life.life_inputs},
        "reliability": {"probability": reliability.reliability_years, "scatter": reliability.reliability_inputs},
        "growth": {"crack": growth.crack_depth},
    }
    drawn = dict(draws.get(name, {}))
    if name == "life":
        if "rut_depth" in part.dataset:
            drawn["rut"] = ruts.life_rut
        if not float(part.dataset["damage_per_year"].max()) > 0:
            drawn.pop("across")
    return {key: as_url(draw(part)) for key, draw in drawn.items()}


def shares_of(part: BaseResult, criterion: str) -> dict[str, str]:
    """Who does the damage of a criterion, and when."""
    return {"shares": as_url(life.life_shares(part, criterion))}


def as_url(figure: Any) -> str:
    """A figure as the address of a picture that holds it."""
    out = io.BytesIO()
    figure.savefig(out, format="svg", metadata={"Date": None})
    return f"data:image/svg+xml;base64,{base64.b64encode(out.getvalue()).decode()}"
