"""Rows and words of a life: each criterion, what does most of its damage, the rut, the assessment, and cautions."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from treadload.damage.climate import MONTHS, Climate
from treadload.damage.cracks import HORIZONTAL, NONE, ORIENTATIONS, opens_down
from treadload.damage.criterion import Criterion
from treadload.damage.field_shift import DEFAULT, field_shifts
from treadload.damage.laws.conditions import conditions_of
from treadload.damage.laws.fatigue import FatigueLaw
from treadload.damage.laws.validity import range_warnings
from treadload.damage.traffic import Traffic
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.rows import Row, row
from treadload.units import repetitions_in_words, years_in_words
from treadload.variables import Display, display_of

# Damage across flat planes above this share of a criterion's is worth a sentence.
_MOSTLY = 0.2
DIRECTIONS = ("transverse", "longitudinal")
"""Directions of cracks from the surface that are evaluated side by side."""
CAUSES = ("hogging", "tread", "braking or driving")
"""What opens the first crack: the basin away from the footprints, what is near them, the longitudinal force."""

PER_CRITERION = ("laws", "sources", "caveats", "reads")
"""Attributes of a life with an entry for each criterion, JSON."""
OF_SENSITIVITY = ("sensitivity_contacts", "sensitivity_responses", "sensitivity_coverage")
"""Attributes of a life that holds its sensitivities, too: all or none."""
STEEPEST = 500.0
"""Largest elasticity: a life that changes by e⁵⁰⁰ is none, and the percentage shown of it overflows at e⁷⁰⁹."""
_STATS = ("contacts", "responses", "combinations", "seconds", "interpolation_error")


def check_life(data: xr.Dataset) -> None:
    """Raise InputError where what a life holds of its criteria does not fit them. data: with attributes of JSON."""
    count = data.sizes.get("criterion", 0)
    if not count:
        raise InputError("it has no criterion")
    texts = {name: json.loads(data.attrs.get(name, "[]")) for name in (*PER_CRITERION, "ends")}
    for name in (*PER_CRITERION, *(["ends"] if texts["ends"] else [])):
        if len(texts[name]) != count:
            raise InputError(f"the attribute {name} must have {count} entries, one per criterion")
    stats = json.loads(data.attrs.get("stats", "{}"))
    lacking = next((key for key in _STATS if stats and type(stats.get(key)) not in (int, float)), None)
    if lacking is not None:
        raise InputError(f"the attribute stats has no number for {lacking!r}")
    if 0 < sum(name in data.attrs for name in OF_SENSITIVITY) < len(OF_SENSITIVITY):
        raise InputError(f"it has some of the attributes {', '.join(OF_SENSITIVITY)}, and needs all or none")
    if ("design_damage" in data) != ("design_years" in data.attrs):
        raise InputError("it has one of design_damage and the attribute design_years, and needs both or none")


def heading_of(traffic: Traffic, climate: Climate) -> str:
    """Traffic and climate of a life in a line."""
    span = f" for {traffic.grows_for:g} years, constant from then on" if math.isfinite(traffic.grows_for) else ""
    return (
        f"{traffic.passes_per_year:.4g} load repetitions in the first year, growth {100 * traffic.growth:g} % per "
        f"year{span}, {traffic.wander}, {len(climate.seasons)} season(s)"
    )


def criterion_rows(data: xr.Dataset, criterion: Criterion, traffic: Traffic) -> list[Row]:
    """Rows of a criterion: service life, largest value with its place, utilisation, what does most of its damage.

    data: of a `Life`.
    """
    name, quantity = criterion.name, criterion.quantity
    between = json.loads(data.attrs.get("between", "{}")).get(name)
    number = f"layer {criterion.layer + 1}" if criterion.layer >= 0 else "the last layer"
    notes = {"read_depth": between or f"{criterion.place} of {number}"}
    at = data.sel(criterion=name)
    span = "a year" if traffic.years is None else f"{traffic.years:g} years"
    value = Display(display_of("largest_reading").label, "", quantity.in_words)
    rows = [
        row("life_years", at["life_years"], group=name, note=f"damage 1 means {criterion.law_at(15.0).end_of_life}"),
        row("life_passes", at["life_passes"], group=name),
        row(
            "largest_reading", at["largest_reading"], group=name, display=value,
            note=f"largest {str(quantity).removeprefix('largest ')}",
        ),
        *(row(key, at[key], group=name, note=notes.get(key, "")) for key in ("read_depth", "worst_y") if key in at),
    ]  # fmt: skip
    rows += [
        row(key, at[key], group=name, label=f"{display_of(key).label} in {span}")
        for key in ("design_utilisation", "design_damage")
        if key in at
    ]
    rows += _line_rows(data, at, name)
    rows.append(row("damage_by", by_whom(at), group=name))
    # The tests behind a line of the catalogue are no number of the law: a file keeps the words.
    kept = json.loads(data.attrs.get("conditions", "{}")).get(name)
    conditions = str(kept) if kept else conditions_of(criterion.law_at(15.0))
    rows.append(row("law_conditions", conditions, group=name))
    if "orientation_damage" in at:
        rows.append(row("first_crack", which_way(at, quantity.harm), group=name))
    return rows


def life_rows(data: xr.Dataset, criteria: Sequence[Criterion], traffic: Traffic) -> list[Row]:
    """Rows on every criterion, on groups of axles and on the rut. data: of a `Life`."""
    rows = [criterion_row for criterion in criteria for criterion_row in criterion_rows(data, criterion, traffic)]
    rows += [row("group_factor", text) for text in json.loads(data.attrs.get("groups", "[]"))]
    causes = [cause_in_words(data, criterion.name) for criterion in criteria]
    rows += [row("first_crack_cause", text) for text in causes if text]
    if "surface_lines" in data.attrs:
        shift = field_shifts[DEFAULT]
        rows.append(row("roads_show", f"{shift.roads_show}; {shift.ranks}"))
    return rows + rut_rows(data)


def _line_rows(data: xr.Dataset, at: xr.Dataset, name: str) -> list[Row]:
    """Years of a surface criterion by the line of a young mix and by that of old cores; none of others."""
    lines = json.loads(data.attrs.get("surface_lines", "{}")).get(name, ())
    keys = ("life_years_fresh_line", "life_years_aged_line")
    return [row(key, at[key], group=name, note=text) for key, text in zip(keys, lines, strict=False) if key in at]


def cause_in_words(data: xr.Dataset, name: str) -> str:
    """The first crack from the surface by a criterion: which way, by which load and season, by what; "" for none."""
    if "cause_share" not in data or not np.isfinite(data["cause_share"].sel(criterion=name)).all():
        return ""
    at = data.sel(criterion=name)
    share, most = at["damage_share"].to_numpy(), {}
    row_number, season = np.unravel_index(int(share.argmax()), share.shape)
    load = f"{at['axle_class'].to_numpy()[row_number]} in {at['season'].to_numpy()[season]}"
    for number in np.argsort(at["crack_repetitions"].to_numpy(), kind="stable"):
        direction, count = str(at["direction"].to_numpy()[number]), float(at["crack_repetitions"][number])
        most[direction] = (
            "never"
            if math.isinf(count)
            else f"after {repetitions_in_words(count)} of its load repetitions at y = "
            f"{1e3 * float(at['crack_place'][number]):z.0f} mm ({1e6 * float(at['crack_strain'][number]):.3g} "
            "microstrain)"
        )
    (first, when), (second, later) = most.items()
    causes = ", ".join(
        f"{100 * float(value):z.0f} % {cause}"
        for cause, value in zip(at["cause"].to_numpy(), at["cause_share"].to_numpy(), strict=True)
    )
    return (
        f"{name}: {first} first, under {load} ({100 * share.max():.0f} % of the damage), {when}; {second} {later}; "
        f"at the worst place, y = {1e3 * float(at['worst_y']):z.0f} mm, its damage is {causes}"
    )


def by_whom(data: xr.Dataset) -> str:
    """The class and season that do most of a criterion's damage, and what the weather does."""
    share = data["damage_share"].to_numpy()
    worst = np.unravel_index(int(np.argmax(share)), share.shape)
    classes = f"{data['axle_class'].to_numpy()[worst[0]]}, {data['season'].to_numpy()[worst[1]]}"
    most = [f"{classes} ({100 * share[worst]:.0f} %)"] if share[worst] > 0 else []
    return ", ".join([*most, *filter(None, [weather_in_words(data)])]) or "no damage"


def which_way(data: xr.Dataset, harm: str) -> str:
    """Orientation that does most of a criterion's damage, with the angle of the first trace.

    harm: the words where no crack opens.
    """
    if "orientation_damage" not in data:
        return "–"
    shares = data["orientation_damage"]
    most = int(np.argmax(shares.to_numpy()))
    word, part = str(shares["orientation"].to_numpy()[most]), f"{100 * float(shares[most]):.0f} % of the damage"
    if not float(shares[most]) > 0 or word == ORIENTATIONS[NONE]:
        return harm
    if not opens_down(word):
        return f"parallel to the surface ({part})"
    angle = float(data["first_crack_angle"])
    trace = "" if math.isnan(angle) else f", first trace {_degrees(angle)}° from travel"
    return f"{word} ({part}){trace}"


def weather_in_words(data: xr.Dataset) -> str:
    """What daily thermal stress does of a criterion's damage, in words; empty where it does nothing."""
    if "weather_share" not in data or not float(data["weather_share"].sum()) > 0:
        return ""
    share = data["weather_share"].to_numpy()
    month = int(share.argmax())
    return (
        f"by the weather alone {100 * share.sum():.2g} %, most in {MONTHS[month]}, "
        f"{float(data['weather_stress'][month]) / 1e6:.2g} MPa"
    )


def rut_rows(data: xr.Dataset) -> list[Row]:
    """The rut of a life, layer by layer, and when it reaches its limit; none without one."""
    if "rut_depth" not in data:
        return []
    last = data["rut_depth"].to_numpy()[:, -1]
    names = json.loads(data.attrs["rut_names"])
    layers = ", ".join(f"{name} {1e3 * depth:.2g}" for name, depth in zip(names, last, strict=True) if depth > 0)
    label = f"{display_of('rut_depth').label} after {float(data['year'][-1]):g} years"
    rows = [row("rut_depth", last.sum(), label=label, note=layers)]
    if "rut_limit" in data.attrs:
        label = f"rut of {1e3 * float(data.attrs['rut_limit']):g} mm reached after"
        rows.append(row("rut_years", float(data.attrs["rut_years"]), label=label))
    return rows


def rut_in_words(data: xr.Dataset) -> str:
    """The rut of a life in a sentence; empty without one."""
    return "; ".join(f"{rut_row.label} {rut_row.sentence}" for rut_row in rut_rows(data))


def criteria_attributes(criteria: Sequence[Criterion], laws: Sequence[FatigueLaw]) -> dict[str, str]:
    """Attributes of a file on criteria and their laws, a law for each, JSON."""
    texts_by_name: dict[str, list[Any]] = {
        "laws": [str(criterion.law_at(15.0)) for criterion in criteria],
        "sources": [criterion.law_at(15.0).source for criterion in criteria],
        "caveats": [
            "; ".join(filter(None, (law.caveat, criterion.quantity.caveat)))
            for law, criterion in zip(laws, criteria, strict=True)
        ],
        "ends": [law.end_of_life for law in laws],
        "reads": [criterion.quantity.about for criterion in criteria],
        "proposed": [_proposed(criterion, law) for criterion, law in zip(criteria, laws, strict=True)],
        "places": [criterion.place for criterion in criteria],
    }
    texts = {name: json.dumps(texts, ensure_ascii=name == "places") for name, texts in texts_by_name.items()}
    conditions = {criterion.name: conditions_of(law) for criterion, law in zip(criteria, laws, strict=True)}
    return {**texts, "conditions": json.dumps(conditions, ensure_ascii=False)}


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
    names = ([str(row) for row in data["axle_class"].to_numpy()], [str(row) for row in data["season"].to_numpy()])
    warnings = [
        f"{criterion.name}: {text}"
        for k, criterion in enumerate(criteria)
        for text in range_warnings(laws[k], readings[k].max(axis=(2, 3)), shares[k], names)
    ]
    warnings += [
        f"{criterion.name}: {criterion.quantity}: {criterion.quantity.caveat}"
        for criterion in criteria
        if criterion.quantity.caveat
    ]
    warnings += [
        f"{criterion.name}: its law was calibrated on roads on which wheels wander, so that the traffic's wander is "
        f"left out here and the life is {years_in_words(years)}; counted twice it would be "
        f"{data['life_years_with_wander'].item(k) / years:.3g} times as long"
        for k, (criterion, years) in enumerate(zip(criteria, data["life_years"].to_numpy().tolist(), strict=True))
        if twice[k] and math.isfinite(years)
    ]
    return tuple(dict.fromkeys(warnings + _flat(data, criteria)))


def _proposed(criterion: Criterion, law: FatigueLaw) -> str:
    """Who proposed a criterion: of a law of any quantity whoever proposed that, else the law's source."""
    any_quantity = dataclasses.is_dataclass(law) and any(field.name == "reads" for field in dataclasses.fields(law))
    return criterion.quantity.source if any_quantity else law.source


def _flat(data: xr.Dataset, criteria: Sequence[Criterion]) -> list[str]:
    """Sentences on criteria of extension whose damage splits the road parallel to its surface."""
    if "orientation_damage" not in data:
        return []
    shares = data["orientation_damage"].sel(orientation=ORIENTATIONS[HORIZONTAL]).to_numpy()
    return [
        f"{name}: {100 * share:.0f} % of its damage is read across planes closer to horizontal than 45°, which "
        "split the road parallel to its surface: no crack from the surface down, nor from the bottom up; read "
        + ('strain = "in-plane" for those' if criterion.quantity.extends else "in_plane_extension for those")
        for name, share, criterion in zip(data["criterion"].to_numpy(), shares, criteria, strict=True)
        if share > _MOSTLY and not criterion.quantity.between_layers
    ]


def _degrees(angle: float) -> str:
    """An angle in rad as whole degrees with a true minus."""
    return f"{math.degrees(angle):z.0f}".replace("-", "\u2212")
