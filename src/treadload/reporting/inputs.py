"""The question of each case as a table: from its TOML text, or what the results remember."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterator, Mapping
from typing import Any

from treadload.reporting.reading import ReportCase
from treadload.reporting.tables import MISSING, Row, Section

# Numbers of a case are SI; people read them so. Name of the key → (unit, factor).
_UNITS = {
    **dict.fromkeys(
        ("spacing", "cell", "thickness", "approach", "depths", "depth", "slice_depth", "nominal_diameter"),
        ("mm", 1e3),
    ),
    **dict.fromkeys(("x", "y"), ("mm", 1e3)),
    **dict.fromkeys(("modulus", "glassy_modulus", "static_modulus"), ("MPa", 1e-6)),
    "stiffness": ("MPa/m", 1e-6),
    **dict.fromkeys(("instantaneous_compliance", "long_term_compliance"), ("1/MPa", 1e6)),
    **dict.fromkeys(("temperature", "temperatures", "values", "reference", "tested"), ("°C", 1.0)),
    "activation_energy": ("kJ/mol", 1e-3),
    "c2": ("K", 1.0),
    "tau": ("s", 1.0),
    "frequency": ("Hz", 1.0),
    "inflation_pressure": ("kPa", 1e-3),
    **dict.fromkeys(("normal_load", "tractive_force", "lateral_force"), ("kN", 1e-3)),
    **dict.fromkeys(("rotation", "camber"), ("°", 180 / math.pi)),
    "spin": ("rad/m", 1.0),
    "speed": ("km/h", 3.6),
    "epsilon_6": ("microstrain", 1e6),
}
_NAMES = {
    "poisson": "Poisson's ratio",
    "modulus": "Young's modulus",
    "epsilon_6": "ε₆, strain of a million passes",
    "slope": "slope of the fatigue line",
    "creepage_x": "longitudinal creepage",
    "creepage_y": "lateral creepage",
    "spacing": "cells of the grid",
    "friction": "coefficient of friction",
    "structure": "structure of the catalogue",
    "frequency": "frequency at which mixes are read",
    "bond": "bond to the next layer",
    "extrapolate": "beyond the materials' data",
    "road_compliance": "compliance of the road in the contact",
    "glassy_modulus": "E∞, of fast loading",
    "static_modulus": "E₀, of slow loading",
    "delta": "δ",
    "tau": "τ at the reference of the shift",
}
_HEADINGS = {
    "": "Computation",
    "tire": "Tire",
    "pavement": "Road",
    "rolling": "Rolling",
    "damage": "Fatigue",
    "footprint": "Recorded footprint",
}
_DROPPED = {"title"}


def input_table(cases: list[ReportCase]) -> list[Section]:
    """What was asked: a row for each key that a case gives, a column for each case."""
    asked = [_asked(case) for case in cases]
    keys = list(dict.fromkeys(key for case in asked for key in case))
    headings = list(dict.fromkeys(heading for heading, _, _ in keys))
    # The computation's own settings close the table.
    headings.sort(key=lambda heading: heading == _HEADINGS[""])
    return [
        Section(
            heading,
            tuple(
                Row(name, unit, tuple(case.get((heading, name, unit), MISSING) for case in asked))
                for of, name, unit in keys
                if of == heading
            ),
        )
        for heading in headings
    ]


Key = tuple[str, str, str]


def _asked(case: ReportCase) -> dict[Key, str]:
    try:
        table = tomllib.loads(case.toml)
    except tomllib.TOMLDecodeError:
        table = {}
    found = dict(_rows(table))
    contact = case.group("contact")
    if contact is not None:
        told = {"tire": "Tire", "road": "Road", "rolling": "Rolling"}
        # The results' own words stand where the case is silent.
        silent = {key: heading for key, heading in told.items() if not any(of == heading for of, _, _ in found)}
        for key, heading in silent.items():
            if contact.attrs.get(key):
                found[heading, "as solved", ""] = str(contact.attrs[key])
        if contact.attrs.get("tire") and "tire" not in silent:
            found["Tire", "as solved", ""] = str(contact.attrs["tire"])
        cells = f"{contact.sizes['x']} × {contact.sizes['y']}"
        if "dx" in contact.attrs and "dy" in contact.attrs:
            cells += f" of {float(contact.attrs['dx']) * 1e3:g} × {float(contact.attrs['dy']) * 1e3:g} mm"
        found[_HEADINGS[""], "grid of the contact", ""] = cells
    return found


def _rows(table: Mapping[str, Any]) -> Iterator[tuple[Key, str]]:
    for section, value in table.items():
        if section in _DROPPED:
            continue
        if not isinstance(value, Mapping):
            yield _row("", (section,), value)
            continue
        for path, leaf in _leaves(value):
            yield _row(section, path, leaf)


def _leaves(table: Mapping[str, Any], before: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Values of nested tables with their path; tables in a list are numbered."""
    for key, value in table.items():
        if isinstance(value, Mapping):
            yield from _leaves(value, (*before, key))
        elif isinstance(value, list) and value and all(isinstance(item, Mapping) for item in value):
            single = key.removesuffix("s")
            for number, item in enumerate(value, start=1):
                yield from _leaves(item, (*before, f"{single} {number}"))
        else:
            yield (*before, key), value


def _row(section: str, path: tuple[str, ...], value: Any) -> tuple[Key, str]:
    key = path[-1]
    unit, factor = _UNITS.get(key, ("", 1.0))
    items = value if isinstance(value, list) else [value]
    # A quoted number carries its own unit.
    own = any(isinstance(item, str) for item in items)
    text = ", ".join(_value(item, factor) for item in items)
    parents = [part for part in path[:-1] if part not in ("material", "fatigue")]
    name = ": ".join([*parents, _NAMES.get(key, key.replace("_", " "))])
    heading = _HEADINGS.get(section, section.replace("_", " ").capitalize())
    return (heading, name, "" if own else unit), text


def _value(item: Any, factor: float) -> str:
    if isinstance(item, bool):
        return "yes" if item else "no"
    if isinstance(item, int | float):
        return f"{round(item * factor, 10):.6g}".replace("-", "\u2212")
    return str(item)
