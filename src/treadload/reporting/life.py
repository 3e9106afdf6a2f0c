"""The life of a road in a report: its assessment in words, its criteria as a table, its figures."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from treadload.damage.indices import NO_WORK
from treadload.deferred import xarray as xr
from treadload.plots.kit.style import measure, power_of_ten, signed, thousands
from treadload.plots.life import life_change
from treadload.reporting.first import FirstPage, first_of_life
from treadload.reporting.pictures import Picture, pictures_of
from treadload.rows import Row, from_json
from treadload.us_units import us_unit

_FACTS = ("rut_depth", "rut_years")
# Of the governing criterion, in the answer or in the table of all criteria.
_BELOW = (
    "life_years", "life_passes", "law_conditions", "largest_reading", "read_depth", "worst_y", "damage_by",
    "first_crack", "design_damage",
)  # fmt: skip
_WORK = "J/m²"


@dataclass(frozen=True)
class LifeReport:
    """The part of a report about one life.

    label: of the case. facts: (term, value). laws: name of a criterion, law, source, caveat, what the end of life is.
    groups: sentences on first cracks and on groups of axles. solved: what was solved for it. first: the criteria,
    where it would crack first, by which criterion; None for files without it. works: rows of `work_columns`.
    """

    label: str
    facts: tuple[tuple[str, str], ...]
    pictures: tuple[Picture, ...]
    laws: tuple[tuple[str, str, str, str, str], ...]
    groups: tuple[str, ...]
    solved: str
    first: FirstPage | None = None
    works: tuple[tuple[str, ...], ...] = ()


def life_report(label: str, data: xr.Dataset) -> LifeReport:
    """The report of a life. data: the group /life."""
    laws, sources, caveats = (json.loads(data.attrs.get(name, "[]")) for name in ("laws", "sources", "caveats"))
    names = [str(name) for name in data["criterion"].to_numpy()]
    ends = json.loads(data.attrs.get("ends", "[]")) or [""] * len(names)
    shown = from_json(data.attrs.get("rows"))
    return LifeReport(
        label,
        _facts(data, shown),
        tuple(pictures_of("Life", [data], {})),
        tuple(zip(names, laws, sources, caveats, ends, strict=True)),
        (*_first_cracks(shown), *json.loads(data.attrs.get("groups", "[]"))),
        _solved(data),
        first_of_life(data, shown),
        _works(data),
    )


def _first_cracks(rows: Sequence[Row]) -> list[str]:
    """Sentences on the first crack from the surface: its direction, its load and season, and what opens it."""
    return [f"First crack from the surface by {row.text}" for row in rows if row.key == "first_crack_cause"]


def _works(data: xr.Dataset) -> tuple[tuple[str, ...], ...]:
    """Cells of `work_columns` for every class of axles."""
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
    """A work, J/m², as shown; 0 where it is what a solution leaves of a wheel that rolls freely."""
    if value < NO_WORK:
        return "0"
    us = us_unit(_WORK)
    number = value if us is None else us.number(value)
    return thousands(number) if number >= 1e3 else f"{number:.3g}"


def work_columns() -> tuple[str, ...]:
    """Heads of the table of what a passage does to the surface."""
    us = us_unit(_WORK)
    unit = _WORK if us is None else us.symbol
    return "axles", f"polishing: work of sliding, {unit}", f"ravelling: work of tearing, {unit}", "in the season"


def least_work() -> str:
    """What stands as 0 in that table, with its unit."""
    us = us_unit(_WORK)
    return f"10⁻⁸ {_WORK}" if us is None else f"{power_of_ten(us.number(NO_WORK))} {us.symbol}"


def exhausted(data: xr.Dataset) -> bool:
    """True where the road fails before its design life is over."""
    design = data.attrs.get("design_years")
    ends = min(float(data["life_years"].min()), float(data.attrs.get("rut_years", math.inf)))
    return design is not None and ends < float(design)


def _governing(data: xr.Dataset) -> xr.Dataset:
    return data.isel(criterion=int(data["life_years"].to_numpy().argmin()))


def _facts(data: xr.Dataset, rows: Sequence[Row]) -> tuple[tuple[str, str], ...]:
    """What governs and its rows; what it depends on most. rows: of the life."""
    alone = {row.key: row for row in rows if not row.group}
    first = str(_governing(data)["criterion"].item())
    governing = [row for row in rows if row.group == first and row.key not in _BELOW]
    facts = [(row.label, row.text) for key, row in alone.items() if key in _FACTS]
    facts += [(f"{first}: {row.label}", row.text) for row in governing]
    facts += [(f"{first}: limit", row.note) for row in rows if row.group == first and row.key == "life_years"]
    if "elasticity" in data:
        for name, value in zip(data["input"].to_numpy()[:3], data["elasticity"].to_numpy()[:3], strict=True):
            step = "" if str(name).startswith("temperature") else " (+5 %)"
            facts.append((f"depends most on {name}{step}", f"life {changed_life(str(name), float(value))}"))
    return tuple(facts)


def changed_life(name: str, elasticity: float) -> str:
    """Change of the life as the input grows by the step of the figure, in words."""
    change = life_change(name, elasticity)
    return f"{'+' if change > 0 else ''}{signed(change, 0)} %"


def _solved(data: xr.Dataset) -> str:
    stats = json.loads(data.attrs.get("stats", "{}"))
    if not stats:
        return ""
    text = (
        f"{stats['contacts']} contacts and {stats['responses']} responses were solved for {stats['combinations']} "
        f"combinations of class and season in {measure(stats['seconds'])} s; what is interpolated over the climate "
        f"moves damage no more than readings off by {stats['interpolation_error']:.1g} of the largest would"
    )
    if stats.get("wheels_moved"):
        text += f"; wheels were moved by up to {stats['wheels_moved'] * 1e3:.1f} mm onto the common cells"
    if "sensitivity_responses" in data.attrs:
        text += (
            f". The sensitivities took {int(data.attrs['sensitivity_contacts'])} more contacts and "
            f"{int(data.attrs['sensitivity_responses'])} more responses, for the classes and seasons that do "
            f"{100 * float(data.attrs['sensitivity_coverage']):.0f} % of the governing damage"
        )
    return text + "."
