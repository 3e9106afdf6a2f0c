"""Where a road would crack first, by whom: all criteria of a life side by side, all quantities of a response."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from treadload.damage.cracks import OBLIQUE_TOLERANCE, ORIENTATIONS, crack_plane, in_a_cell, opens_down, orientation
from treadload.damage.fields import known_quantities
from treadload.damage.quantity import Quantity, cut, in_tension
from treadload.damage.words import LASTS, years_in_words
from treadload.plots.first import crack_or_not, failing_order, first_places
from treadload.plots.kit.style import measure, power_of_ten, signed
from treadload.plots.response import NAMES
from treadload.reporting.pictures import Picture, picture

_LIFE = (
    "criterion", "by whom", "largest reading", "where", "which way", "class, season", "of what is allowed", "damage",
    "fails after",
)  # fmt: skip
_RESPONSE = ("quantity", "by whom", "largest", "where", "which way", "calibrated")
# A number as Python writes small and large ones.
_TINY = re.compile(r"\d[\d.]*e[+-]\d+")
CRACKS, FAILS = "Where would it crack first, by whom", "Where would it fail first, by whom"


@dataclass(frozen=True)
class FirstPage:
    """What a report says of it. heading: with the word "crack" only where one opens. sentence: the first of them.

    columns, rows: the table, first to fail first. note: how it is read.
    """

    heading: str
    sentence: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str
    pictures: tuple[Picture, ...] = ()


def first_of_life(data: xr.Dataset) -> FirstPage | None:
    """The page of a life; None for files from before it. data: the group /life."""
    if not {"design_utilisation", "read_depth"} <= set(data) or "proposed" not in data.attrs:
        return None
    reads, proposed, places = (json.loads(data.attrs[name]) for name in ("reads", "proposed", "places"))
    order = failing_order(data)
    rows = tuple(_life_row(data, k, reads[k], proposed[k], places[k]) for k in order)
    cracks = any(crack_or_not(data, k) == "crack" for k in order)
    first = rows[0]
    ends = first[-1]
    said = (
        "No criterion fails under this traffic."
        if ends == "never"
        else f"First fails {first[0]} after {ends}: {first[3]}; {first[4]}; most by {first[5]}."
    )
    note = (
        "Criteria by other laws end in different ways; see Methods. Over what is allowed: the largest reading over "
        "the one that the law allows for all passes of the design life, or of a year. y: right of the middle of the "
        "wheel path. A plane nearer to the horizontal than 45° is no crack from the surface down, and none opens "
        "where no principal stress is tensile."
    )
    drawn = picture(
        "All criteria side by side",
        "Left: where each is worst, by its number in the order of failing. Right: its largest reading over what its "
        "law allows; beyond the dashed line it fails within the passes counted.",
        lambda: first_places(data),
        wide=True,
    )
    return FirstPage(CRACKS if cracks else FAILS, said, _LIFE, rows, note, tuple(drawn))


def first_of_response(data: xr.Dataset) -> FirstPage | None:
    """The page of a response on a grid: where each quantity is largest; None where it has none of their fields."""
    if not {"depth", "y", "x"} <= set(data.dims):
        return None
    found = [_response_row(one, data) for one in known_quantities().values() if not one.missing(data)]
    rows = tuple(row for row, _ in found)
    if not rows:
        return None
    depths = ", ".join(f"{1e3 * float(z):g}" for z in np.atleast_1d(data["depth"].to_numpy()))
    over = data.attrs.get("mean_over")
    how = f"means over {1e3 * float(over):g} mm" if over else "points, which depend on the cells near edges of ribs"
    note = (
        f"Largest of the depths solved, {depths} mm, at {how}. Extensions are read only where a principal stress is "
        "tensile. No law ranks them: what is calibrated, and for what, stands in the last column."
    )
    heading = (
        "Where it would crack, by whom" if any(opens for _, opens in found) else "What is largest where, by whom"
    )
    return FirstPage(heading, "", _RESPONSE, rows, note)


def short_source(source: str) -> str:
    """A source up to its year; the whole stands under Methods."""
    return re.split(r"(?<=\)),|; ", source)[0]


def _life_row(data: xr.Dataset, number: int, reads: Mapping[str, Any], proposed: str, place: str) -> tuple[str, ...]:
    row = data.isel(criterion=number)
    share = row["damage_share"].to_numpy()
    by = np.unravel_index(int(share.argmax()), share.shape)
    harmed = bool(share[by] > 0)
    where = f"{_deep(float(row['read_depth']), place)}, y = {signed(1e3 * float(row['worst_y']), 0)} mm"
    most = f"{row['axle_class'].to_numpy()[by[0]]}, {row['season'].to_numpy()[by[1]]}" if harmed else "–"
    value, years = float(row["largest_reading"]) * float(reads["factor"]), float(row["life_years"])
    if "design_damage" in row:
        damage, when = float(row["design_damage"]), f"in {float(data.attrs['design_years']):g} years"
    else:
        damage, when = float(row["damage_per_year"].max()), "in a year"
    return (
        str(row["criterion"].item()),
        short_source(proposed),
        f"{value:.3g} {reads['shown']}".strip() if value > 0 else "none",
        where if value > 0 else "–",
        which_way(row, str(reads["harm"])) if harmed else "no damage",
        most,
        small_or(float(row["design_utilisation"])),
        f"{f'{damage:.2g}' if 1e-3 <= damage < 1e3 else power_of_ten(damage) if damage > 0 else '0'} {when}",
        _years(years),
    )


def which_way(row: xr.Dataset, harm: str) -> str:
    """Where the damage of a criterion runs: the orientation that does most of it, with the angle of the first trace.

    harm: what to say where no crack opens.
    """
    if "orientation_damage" not in row:
        return "–"
    shares = row["orientation_damage"]
    most = int(np.argmax(shares.to_numpy()))
    word, part = str(shares["orientation"].to_numpy()[most]), f"{100 * float(shares[most]):.0f} % of the damage"
    if not float(shares[most]) > 0 or word == ORIENTATIONS[0]:
        return harm
    if not opens_down(word):
        return f"parallel to the surface ({part})"
    angle = float(row["first_crack_angle"])
    trace = "" if math.isnan(angle) else f", first trace {signed(math.degrees(angle), 0)}° from travel"
    return f"{word} ({part}){trace}"


def _response_row(quantity: Quantity, data: xr.Dataset) -> tuple[tuple[str, ...], bool]:
    """Cells of the table, and whether a crack runs down there."""
    values = cut(quantity.values(data), quantity.opens(data))
    at = np.unravel_index(int(np.nanargmax(values)), values.shape)
    largest = float(values[at])
    depth, y, x = (float(data[name][k]) for name, k in zip(("depth", "y", "x"), at, strict=True))
    way, opens = "–", False
    if largest > 0:
        normal = quantity.crack(data)
        way = quantity.harm
        if normal is not None and _is_tensile(data, at):
            angle, dip = (np.asarray(part[at]) for part in crack_plane(normal))
            word = ORIENTATIONS[int(orientation(angle, dip, OBLIQUE_TOLERANCE))]
            way, opens = in_a_cell(word), opens_down(word)
        elif normal is not None:
            way = "none: nothing is tensile"
    # Numbers stay on the line of what they belong to.
    places = (f"{name}\u00a0=\u00a0{signed(1e3 * at, 0)}\u00a0mm" for name, at in (("x", x), ("y", y)))
    where = ", ".join((_deep(depth), *places)) if largest > 0 else "–"
    read = reading_in_words(quantity, largest) if largest > 0 else "none"
    name = f"{quantity.words}, {NAMES[quantity.strain]}" if quantity.extends else quantity.words
    row = (name, short_source(quantity.source), read, where, way, quantity.calibrated)
    return row, opens


def reading_in_words(quantity: Quantity, value: float) -> str:
    """A reading with its unit, small ones by a power of ten."""
    return _TINY.sub(lambda found: power_of_ten(float(found[0])), quantity.in_words(value))


def _is_tensile(data: xr.Dataset, at: tuple[Any, ...]) -> bool:
    return bool(in_tension(data)[at])


def small_or(value: float) -> str:
    """A share with two digits."""
    return f"{value:.2g}" if value >= 1e-3 or value == 0 else "below 0.001"


def _years(years: float) -> str:
    if math.isinf(years) or years > LASTS:
        return years_in_words(years)
    return f"{measure(years)} years"


def _deep(depth: float, place: str = "") -> str:
    if math.isnan(depth):
        return "depth unknown"
    if depth == 0:
        return "surface"
    on = {"top": ", on top of a layer", "bottom": ", bottom of a layer", "interface": ", the bond there"}.get(
        place, ""
    )
    return f"{depth * 1e3:g} mm deep{on}"
