"""Ranges of what tires, roads and traffic can be: outside, a sentence that names the unit that was likely meant.

A number beyond its range is not an error: robots and aircraft roll, too. The ranges are so wide that what falls out
has most often lost its unit.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Range:
    """What a quantity can be.

    unit: SI. low, high: outside them a sentence is given. usual: what most are. owner: whose it is, in words. units:
    that a person may have thought in, with what they are worth in SI; the usual values are given in the first.
    reason: why these bounds. noun: the quantity in a sentence; left out, the key of the row. remedy: what to do where
    no other unit was likely meant.
    """

    unit: str
    low: float
    high: float
    usual: tuple[float, float]
    owner: str
    units: tuple[tuple[str, float], ...]
    reason: str
    noun: str = ""
    remedy: str = ""


_LENGTHS = (("mm", 1e-3), ("cm", 1e-2), ("m", 1.0))
_PRESSURES = (("kPa", 1e3), ("bar", 1e5), ("MPa", 1e6))

RANGES: dict[str, Range] = {
    # Over the width of the tread, N/m; see `load_caveat`.
    "wheel load": Range(
        "N", 200.0, 1e7, (7e3, 300e3), "a tire of this width usually carries", (("kN", 1e3),),
        "Per metre of width a bicycle carries 20, a car 25, a truck 110, an aircraft 450 and a steel wheel 2000 kN; "
        "the toy of 1 kg stands on 300 N/m.",
    ),
    "inflation pressure": Range(
        "Pa", 30e3, 2.5e6, (100e3, 1.6e6), "tires usually have", _PRESSURES,
        "Agricultural and sand tires go down to 40 kPa, those of aircraft and racing bicycles up to 1.7 MPa.",
    ),
    "modulus of the tire": Range(
        "Pa", 5e4, math.inf, (0.5e6, 100e6), "treads usually have", (("MPa", 1e6), ("kPa", 1e3), ("GPa", 1e9)),
        "Foam has 0.1 MPa, rubber 1 to 100; steel wheels and rigid punches have no upper bound.",
    ),
    "friction": Range(
        "", 0.0, 2.0, (0.05, 1.5), "road and tire usually have", (("", 1.0), ("%", 1e-2)),
        "Racing tires reach 1.8.",
        remedy="a dry road is near 0.7, a wet one near 0.4, and racing tires reach 1.8: lower it, or prescribe a "
        "creepage of 0 where nothing is to slip",
    ),
    "speed": Range(
        "m/s", 0.0, 60.0, (0.3, 38.0), "vehicles usually roll at", (("km/h", 1 / 3.6),),
        "216 km/h; beyond it is an aircraft, or km/h without their unit.",
    ),
    "size of the cells": Range(
        "m", 2e-5, 0.1, (0.5e-3, 20e-3), "contacts are usually solved on", _LENGTHS,
        "Finer cells see the texture of the rubber, coarser ones no tire.",
    ),
    "width of the surface": Range(
        "m", 2e-3, 5.0, (0.02, 0.8), "treads usually measure", _LENGTHS,
        "Treads measure 20 mm on a bicycle and 1.2 m on a mining truck; rollers and plates are a few metres wide.",
    ),
    "thickness of the surface course": Range(
        "m", 2e-3, 1.0, (0.01, 0.4), "surface courses usually measure", (("cm", 1e-2), ("mm", 1e-3), ("m", 1.0)),
        "Surface dressings have 5 mm, full-depth asphalt and runways of concrete 0.5 m.",
    ),
    "thickness of the layer": Range(
        "m", 2e-3, 4.0, (0.03, 0.6), "courses usually measure", (("cm", 1e-2), ("mm", 1e-3), ("m", 1.0)),
        "Interlayers have a few millimetres; stiff layers thicker than a few metres are rock, not road.",
        "thickness",
    ),
    "thickness of the unbound layer": Range(
        "m", 2e-3, 20.0, (0.05, 2.0), "unbound layers usually measure", (("cm", 1e-2), ("mm", 1e-3), ("m", 1.0)),
        "Embankments are a few metres high.",
        "thickness",
    ),
    "thickness of the soil": Range(
        "m", 2e-3, 200.0, (0.05, 20.0), "soil above rock usually measures", (("m", 1.0), ("cm", 1e-2), ("mm", 1e-3)),
        "Rock lies within tens of metres, or does not matter.",
        "thickness",
    ),
    "modulus of the layer": Range(
        "Pa", 1e5, 1e12, (20e6, 45e9), "layers usually have", (("MPa", 1e6), ("GPa", 1e9), ("kPa", 1e3)),
        "Peat has 0.3 MPa, steel decks 210 GPa.",
        "modulus",
    ),
    "Poisson's ratio": Range(
        "", 0.0, 0.5, (0.1, 0.5), "materials of roads usually have", (("", 1.0),),
        "Below zero a pressed body becomes narrower; no road does.",
    ),
    "stiffness of the bond": Range(
        "Pa/m", 1e6, 1e15, (1e8, 1e13), "bonds that matter have", (("MPa/m", 1e6), ("GPa/m", 1e9)),
        "Below some 1e9 Pa/m layers slide freely, above some 1e12 they hold as if bonded.",
        "stiffness",
    ),
    "depth": Range(
        "m", 0.0, 50.0, (1e-3, 3.0), "roads are usually read at", (("m", 1.0), ("cm", 1e-2), ("mm", 1e-3)),
        "Below 50 m no wheel has an effect.",
    ),
    "number of passes per year": Range(
        "", 1.0, 1e8, (1e3, 2e7), "wheel paths usually see", (("", 1.0),),
        "A lane that is always full sees 2e7 vehicles a year.",
    ),
    "annual growth": Range(
        "", -0.3, 0.3, (-0.05, 0.1), "traffic usually grows by", (("%", 1e-2),),
        "A factor of ten within nine years.",
    ),
    "temperature": Range(
        "°C", -60.0, 85.0, (-20.0, 60.0), "roads usually have", (("°C", 1.0),),
        "The coldest roads and the hottest black surfaces on record.",
    ),
}  # fmt: skip
"""One row per quantity; the key is its name in a sentence."""


def caveat(kind: str, value: float, where: str = "", scale: float = 1.0) -> tuple[str, ...]:
    """A sentence where a value, SI, lies outside the range of its kind; nothing for one inside, NaN and infinity.

    kind: a key of RANGES. where: whose it is, for the sentence. scale: what the bounds are multiplied by.
    """
    row = RANGES[kind]
    if not math.isfinite(value) or row.low * scale <= value <= row.high * scale:
        return ()
    usual = (row.usual[0] * scale, row.usual[1] * scale)
    name, worth = row.units[0]
    fast = f", {value * 3.6:g} km/h" if row.unit == "m/s" else ""
    text = f"the {row.noun or kind}{f' of {where}' if where else ''} is {_written(value, row.unit)}{fast}; "
    text += f"{row.owner} {_short(usual[0] / worth)} to {_short(usual[1] / worth)} {name}".rstrip()
    meant = _meant(value, row, usual)
    if meant:
        text += f": did you mean {' or '.join(meant[:2])}?"
    elif row.unit:
        text += f" (a number without a unit is in {row.unit})"
    elif row.remedy:
        text += f"; {row.remedy}"
    return (text,)


def load_caveat(load: float, width: float, where: str = "") -> tuple[str, ...]:
    """A sentence where a tire of a width, m, cannot carry a load, N."""
    return caveat("wheel load", load, where, scale=width) if math.isfinite(width) and width > 0 else ()


def _meant(value: float, row: Range, usual: Sequence[float]) -> list[str]:
    """Values that a person may have meant: the same digits in another unit, or without the one that came too much."""
    units_beside = [(name, worth) for name, worth in row.units if worth != 1]
    lost = [f'"{value:g} {name}"' for name, worth in units_beside if usual[0] <= value * worth <= usual[1]]
    surplus = [
        f'"{_written(value / worth, row.unit)}"' for _, worth in units_beside if usual[0] <= value / worth <= usual[1]
    ]
    return lost or surplus


def _written(value: float, unit: str) -> str:
    return f"{value:g} {unit}".rstrip()


def _short(value: float) -> str:
    return f"{value:.2g}" if abs(value) < 100 else f"{value:.0f}" if abs(value) < 1e5 else f"{value:.0e}"
