"""What the page says of a backcalculation: its drops in a list, and what is known at one of them."""

from __future__ import annotations

import math
from collections.abc import Mapping

from treadload.app.answers import PageRow
from treadload.composing import BaseResult
from treadload.describing import title_of
from treadload.errors import InputError
from treadload.plots.interactive.basins import basin_fit, moduli_profile
from treadload.roads import Backcalculation
from treadload.us_units import sentence_in_display_units
from treadload.variables import modulus_in_words

# Drops of a list and characters of a text that a browser is sent.
_MOST_DROPS, _MOST_LETTERS = 20_000, 80
_STATUS = ("fitted", "flagged", "refused")


def basins_of(parts: Mapping[str, BaseResult]) -> Backcalculation:
    """The backcalculation among the results of a file. Raises InputError."""
    result = next((part for part in parts.values() if isinstance(part, Backcalculation)), None)
    if result is None:
        raise InputError(
            f"this file holds {', '.join(parts)} and no backcalculation; `treadload backcalculate` writes one"
        )
    return result


def about_basins(result: Backcalculation) -> dict[str, object]:
    """Drops with station, load, misfit and status, and a summary. Raises InputError for more than a list holds."""
    data = result.dataset
    count = data.sizes["basin"]
    if count > _MOST_DROPS:
        raise InputError(f"this file has {count} drops, a list {_MOST_DROPS} at most; cut it into parts")
    columns = (data[name].to_numpy() for name in ("station", "plate_load", "basin_misfit", "basin_status"))
    drops = [
        {
            "number": number, "station": str(station)[:_MOST_LETTERS], "load": f"{load / 1e3:.3g}",
            "misfit": f"{100 * misfit:.2g}" if math.isfinite(misfit) else "–", "status": _STATUS[int(status)],
        }
        for number, (station, load, misfit, status) in enumerate(zip(*columns, strict=True))
    ]  # fmt: skip
    summary = [title_of(result), *(f"{stated.label} {stated.sentence}".strip() for stated in result.rows())]
    return {"drops": drops, "summary": summary}


def basin_figures(result: Backcalculation, drop: int, theme: str) -> dict[str, object]:
    """The fit of a drop beside its readings, and moduli along the road."""
    return {"basin": basin_fit(result, drop, theme=theme), "moduli": moduli_profile(result, drop, theme=theme)}


def basin_rows(result: Backcalculation, drop: int) -> list[PageRow]:
    """Load, misfit, moduli with their intervals, thicknesses, and what is wrong or undecided at a drop."""
    number = result.drop(drop)
    at = result.dataset.isel(basin=number)
    status = int(at["basin_status"])
    rows = [
        _row("station", "station", str(at["station"].item()), "Drop"),
        _row("load", "load", f"{float(at['plate_load']) / 1e3:.4g} kN", "Drop"),
        _row("status", "status", _STATUS[status], "Drop"),
    ]
    if math.isfinite(float(at["asphalt_temperature"])):
        rows.append(_row("temperature", "asphalt", f"{float(at['asphalt_temperature']):.3g} °C", "Drop"))
    if math.isfinite(float(at["basin_misfit"])):
        rows.append(_row("misfit", "misfit, rms", f"{100 * float(at['basin_misfit']):.2g} %", "Drop"))
    if text := str(at["reason"].item()):
        rows.append(_row("reason", "reason", text, "Drop"))
    for layer in (str(name) for name in at["layer_name"].to_numpy()):
        layer_data = at.isel(layer_name=list(map(str, at["layer_name"].to_numpy())).index(layer))
        modulus, deep = float(layer_data["fitted_modulus"]), float(layer_data["layer_thickness"])
        if not math.isfinite(modulus):
            continue
        low, high = result.interval(number, layer)
        bars = (
            f"90 % from {modulus_in_words(low)} to {modulus_in_words(high)}"
            if math.isfinite(low) and math.isfinite(high)
            else "no interval: fixed, at a bound or undecided"
        )
        rows.append(_row(f"modulus:{layer}", layer, modulus_in_words(modulus), "Moduli"))
        rows.append(_row(f"interval:{layer}", "", bars, "Moduli"))
        factor = float(layer_data["law_factor"]) if "law_factor" in layer_data else math.nan
        if math.isfinite(factor):
            text = f"{factor:.3g} times its law; the modulus is that at θ = 150 kPa, q = 75 kPa"
            rows.append(_row(f"law:{layer}", "", text, "Moduli"))
        if math.isfinite(deep):
            rows.append(_row(f"thickness:{layer}", f"thickness of {layer}", f"{1e3 * deep:.4g} mm", "Layers"))
    if math.isfinite(float(at["stiff_depth"])):
        rows.append(_row("stiff_depth", "stiff layer below", f"{float(at['stiff_depth']):.4g} m", "Layers"))
    if text := str(at["undecided"].item()):
        rows.append(_row("undecided", "undecided", text, "Undecided"))
    order = ("Drop", "Moduli", "Layers", "Undecided")
    return sorted(rows, key=lambda row: order.index(row["heading"]))


def _row(key: str, label: str, value: str, heading: str) -> PageRow:
    return {
        "key": key,
        "label": label,
        "value": sentence_in_display_units(value),
        "heading": heading,
        "about": "",
        "group": "",
        "note": "",
    }
