"""The life of a road in a report: its verdict in words, its criteria as a table, its figures."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from treadload.damage.indices import NO_WORK
from treadload.damage.words import rut_in_words, weather_in_words
from treadload.plots.climate import day_temperatures, season_moduli
from treadload.plots.kit.style import measure, power_of_ten, signed
from treadload.plots.life import life_change, life_damage, life_inputs, life_shares, life_years
from treadload.plots.ruts import life_rut
from treadload.plots.works import life_works, shears
from treadload.reporting.first import FirstPage, first_of_life, which_way
from treadload.reporting.pictures import Picture, picture

COLUMNS = (
    "criterion", "life", "passes", "damage at the design life", "largest reading", "where", "first crack",
)  # fmt: skip

WORKS = ("axles", "polishing: work of sliding, J/m²", "ravelling: work of tearing, J/m²", "in the season")


@dataclass(frozen=True)
class LifeReport:
    """What a report says of one life. label: of the case. facts: (term, value). rows: of `COLUMNS`. laws: name of a
    criterion, law, source, doubt, what the end of life is. groups: sentences on groups of axles. solved: what was
    solved for it. first: where it would crack first, by whom; None for files from before that page. works:
    rows of `WORKS`.
    """

    label: str
    facts: tuple[tuple[str, str], ...]
    rows: tuple[tuple[str, ...], ...]
    pictures: tuple[Picture, ...]
    laws: tuple[tuple[str, str, str, str, str], ...]
    groups: tuple[str, ...]
    solved: str
    first: FirstPage | None = None
    works: tuple[tuple[str, ...], ...] = ()


def life_report(label: str, data: xr.Dataset) -> LifeReport:
    """The report of a life. data: the group /life."""
    laws, sources, doubts, reads = (
        json.loads(data.attrs.get(name, "[]")) for name in ("laws", "sources", "doubts", "reads")
    )
    names = [str(name) for name in data["criterion"].to_numpy()]
    ends = json.loads(data.attrs.get("ends", "[]")) or [""] * len(names)
    between = json.loads(data.attrs.get("between", "{}"))
    rows = tuple(
        _row(data.isel(criterion=k), names[k], reads[k], between.get(names[k], "")) for k in range(len(names))
    )
    return LifeReport(
        label,
        _facts(data),
        rows,
        tuple(_pictures(data)),
        tuple(zip(names, laws, sources, doubts, ends, strict=True)),
        tuple(json.loads(data.attrs.get("groups", "[]"))),
        _solved(data),
        first_of_life(data),
        _works(data),
    )


def _works(data: xr.Dataset) -> tuple[tuple[str, ...], ...]:
    """Cells of `WORKS` for every class of axles."""
    if not {"largest_polishing_work", "largest_tearing_work"} <= set(data):
        return ()
    rows = []
    for k, name in enumerate(data["axle_class"].to_numpy()):
        polishing, tearing = (data[f"largest_{what}_work"][k].to_numpy() for what in ("polishing", "tearing"))
        if np.isnan(tearing).all():
            rows.append((str(name), _work(float(polishing)), "–", "–"))
            continue
        most = int(np.nanargmax(tearing))
        season = str(data["season"].to_numpy()[most])
        torn = float(tearing[most])
        rows.append((str(name), _work(float(polishing)), _work(torn), season if torn >= NO_WORK else "–"))
    return tuple(rows)


def _work(value: float) -> str:
    """A work, J/m²; 0 where it is what a solution leaves of a wheel that rolls freely."""
    return f"{value:.3g}" if not value < NO_WORK else "0"


def sentence(data: xr.Dataset) -> str:
    """The verdict in a sentence."""
    row = _governing(data)
    name, years = str(row["criterion"].item()), float(row["life_years"])
    design = data.attrs.get("design_years")
    rutted = float(data.attrs.get("rut_years", math.inf))
    if rutted < years:
        early = "" if design is None or rutted >= design else f", of a design life of {float(design):g} years"
        return f"the rut governs and ends the road's life after {measure(rutted)} years{early}."
    if math.isinf(years):
        return "no criterion ever fails under this traffic."
    said = f"{name} governs and ends the road's life after {measure(years)} years"
    if design is None:
        return f"{said}."
    used = float(row["design_damage"])
    if years >= float(design):
        return f"{said}: a design life of {float(design):g} years uses up {100 * used:.0f} % of it."
    early = measure(float(design) - years)
    return f"{said}, {early} years before the end of its design life of {float(design):g} years."


def exhausted(data: xr.Dataset) -> bool:
    """True where the road fails before its design life is over."""
    design = data.attrs.get("design_years")
    ends = min(float(data["life_years"].min()), float(data.attrs.get("rut_years", math.inf)))
    return design is not None and ends < float(design)


def _governing(data: xr.Dataset) -> xr.Dataset:
    return data.isel(criterion=int(data["life_years"].to_numpy().argmin()))


def _facts(data: xr.Dataset) -> tuple[tuple[str, str], ...]:
    row = _governing(data)
    first, years = str(row["criterion"].item()), float(row["life_years"])
    rutted = float(data.attrs.get("rut_years", math.inf))
    facts = [
        ("governing criterion" if years <= rutted else "first criterion to fail", first),
        ("its life", _years(years)),
    ]
    if rutted < years:
        facts.insert(0, ("governs", f"the rut, after {_years(rutted)}"))
    if "design_damage" in data:
        facts.append((f"its damage after {float(data.attrs['design_years']):g} years", _number(row["design_damage"])))
    ends = json.loads(data.attrs.get("ends", "[]"))
    if ends:
        facts.append(("damage 1 means", str(ends[int(data["life_years"].to_numpy().argmin())])))
    facts += [("worst place", f"{_deep(row)}, {_aside(row)}"), ("first crack", which_way(row, _harm(data)))]
    if weather := weather_in_words(row):
        facts.append(("daily thermal stress", weather))
    if "elasticity" in data:
        inputs = zip(data["input"].to_numpy()[:3], data["elasticity"].to_numpy()[:3], strict=True)
        for name, value in inputs:
            step = "" if str(name).startswith("temperature") else " (+5 %)"
            facts.append((f"depends most on {name}{step}", f"life {changed_life(str(name), float(value))}"))
    return tuple(facts)


def changed_life(name: str, elasticity: float) -> str:
    """Change of the life as the input grows by the step of the figure, in words."""
    change = life_change(name, elasticity)
    return f"{'+' if change > 0 else ''}{signed(change, 0)} %"


def _row(row: xr.Dataset, name: str, reads: Mapping[str, Any], between: str) -> tuple[str, ...]:
    """Cells of `COLUMNS`. reads: what the file says of the quantity, see `damage.quantity.Quantity.about`. between:
    the interface that it reads, in words, or nothing.
    """
    reading, unit = float(row["largest_reading"]) * float(reads["factor"]), str(reads["shown"])
    read = f"{measure(reading) if unit == 'microstrain' else f'{reading:.3g}'} {unit}".strip()
    return (
        name,
        _years(float(row["life_years"])),
        power_of_ten(float(row["life_passes"])),
        _number(row["design_damage"]) if "design_damage" in row else "–",
        read,
        f"{f'{between}, ' if between else ''}{_deep(row)}, {_aside(row)}",
        which_way(row, str(reads["harm"])),
    )


def _years(years: float) -> str:
    return "never" if math.isinf(years) else f"{measure(years)} years"


def _number(value: Any) -> str:
    number = float(value)
    return f"{number:.2g}" if number >= 1e-3 else power_of_ten(number) if number > 0 else "0"


def _deep(row: xr.Dataset) -> str:
    depth = float(row["read_depth"]) if "read_depth" in row else math.nan
    if math.isnan(depth):
        return "depth unknown"
    return "at the surface" if depth == 0 else f"{depth * 1e3:g} mm deep"


def _aside(row: xr.Dataset) -> str:
    y = float(row["worst_y"]) * 1e3
    if abs(y) < 10:
        return "in the middle of the wheel path"
    return f"{abs(y):.0f} mm to the {'right' if y > 0 else 'left'}"


def _harm(data: xr.Dataset) -> str:
    """What the quantity of the governing criterion does where it opens no crack."""
    reads = json.loads(data.attrs.get("reads", "[]"))
    return str(reads[int(data["life_years"].to_numpy().argmin())]["harm"]) if reads else ""


def _solved(data: xr.Dataset) -> str:
    stats = json.loads(data.attrs.get("stats", "{}"))
    if not stats:
        return ""
    told = (
        f"{stats['contacts']} contacts and {stats['responses']} responses were solved for {stats['combinations']} "
        f"combinations of class and season in {measure(stats['seconds'])} s; what is interpolated over the climate "
        f"moves damage no more than readings off by {stats['interpolation_error']:.1g} of the largest would"
    )
    if stats.get("wheels_moved"):
        told += f"; wheels were moved by up to {stats['wheels_moved'] * 1e3:.1f} mm onto the common cells"
    if "sensitivity_responses" in data.attrs:
        told += (
            f". The sensitivities took {int(data.attrs['sensitivity_contacts'])} more contacts and "
            f"{int(data.attrs['sensitivity_responses'])} more responses, for the classes and seasons that do "
            f"{100 * float(data.attrs['sensitivity_coverage']):.0f} % of the governing damage"
        )
    return told + "."


def _pictures(data: xr.Dataset) -> list[Picture]:
    return [
        *picture(
            "Life by criterion",
            "Years from opening until Miner's sum is 1 at the worst place, or the rut is at its limit. Orange: what "
            "governs.",
            lambda: life_years(data),
        ),
        *(
            picture(
                "What the life depends on",
                "How the governing life changes as each input grows by 5 %, temperature by 1 °C; the three that "
                "weigh most are bold. Strength: the strain or stress that the law allows.",
                lambda: life_inputs(data),
            )
            if "elasticity" in data
            else []
        ),
        *picture(
            "Damage across the wheel path",
            "Miner's sum of every criterion, with lateral wander unless the law includes it; dots mark the worst "
            "places. Full lines are read at the surface, dashed ones below.",
            lambda: life_damage(data),
            wide=True,
        ),
        *picture(
            "Who does the damage, and when",
            "Shares of the governing damage at its worst place by class of axles and season; blank: below 0.5 %.",
            lambda: life_shares(data),
            wide=True,
        ),
        *(
            picture(
                "What polishes and tears the surface",
                "Work of sliding, and elastic work of the shear in the skin, of one wheel's passage at its worst "
                "place, by class of axles and season. Indices that rank, not calibrated; 0: below a ten-thousandth "
                "of the largest.",
                lambda: life_works(data),
                wide=True,
            )
            if shears(data)
            else []
        ),
        *(
            picture(
                "Rut against years",
                f"R{rut_in_words(data)[1:]}. Where it is deepest, with lateral wander; what was not read in "
                "its source stands in the warnings.",
                lambda: life_rut(data),
                wide=True,
            )
            if "rut_depth" in data
            else []
        ),
        *(
            picture(
                "Temperature of the road",
                "Mean day of four months over depth and hour, by heat conduction below the weather; dashed: "
                "interfaces of layers.",
                lambda: day_temperatures(data),
                wide=True,
            )
            if "day_temperature" in data
            else []
        ),
        *(
            picture(
                "Modulus over depth",
                "Temperature and Young's modulus of the parts that courses are divided into, in the coldest and the "
                "warmest season, at the frequency at which mixes are given.",
                lambda: season_moduli(data),
                wide=True,
            )
            if "sublayer_modulus" in data
            else []
        ),
    ]
