"""Units as sensors and their programs spell them."""

from __future__ import annotations

import re

from treadload.errors import InputError
from treadload.labels import factor
from treadload.units import quantity

# Of pressure, as programs of sensors write it: kilograms and pounds are those of force.
_PRESSURES = {
    **dict.fromkeys(("PSI", "Psi", "psi", "lb/in2", "lbs/in2", "lb/in^2", "lbf/in2", "PSIG"), "psi"),
    **dict.fromkeys(("KPa", "KPA", "kpa", "kPA"), "kPa"),
    **dict.fromkeys(("Mpa", "MPA"), "MPa"),
    **dict.fromkeys(("kg/cm2", "kg/cm²", "kg/cm^2", "Kg/cm2", "KG/CM2", "kgf/cm²", "kp/cm2", "kp/cm²"), "kgf/cm^2"),
    **dict.fromkeys(("g/cm2", "g/cm²", "gf/cm2"), "gf/cm^2"),
    **dict.fromkeys(("mmHg", "MMHG", "mmhg"), "mmHg"),
    **dict.fromkeys(("PASCAL", "PA"), "Pa"),
    **dict.fromkeys(("BAR", "Bar"), "bar"),
}
# Those who count smaller than pascals have lost a capital.
_LEAST = 1.0
_LENGTHS = {
    re.compile(r"\b(?:mili|milli)met(?:er|re)s?\b", re.IGNORECASE): "mm",
    re.compile(r"\bcentimet(?:er|re)s?\b", re.IGNORECASE): "cm",
    re.compile(r"\bmet(?:er|re)s?\b", re.IGNORECASE): "m",
    re.compile(r"\b(?:inches|inch|in)\b", re.IGNORECASE): "inch",
}
_RAW = ("RAW", "COUNT", "COUNTS")

KGF_CM2 = 98066.5
"""A kilogram-force per square centimetre, Pa."""


def is_counts(unit: str) -> bool:
    """True if a unit states that nothing was calibrated."""
    return unit.strip().upper() in _RAW


def pressure_factor(unit: str) -> float:
    """Pascals of a unit of pressure as a file or a person spells it. Raises InputError for anything else."""
    text = unit.strip()
    try:
        pascals = factor(_PRESSURES.get(text, text), "Pa")
    except InputError as error:
        raise InputError(f"{unit!r} is not a unit of pressure such as kPa, MPa, psi, bar or kgf/cm2") from error
    if pascals < _LEAST:
        raise InputError(
            f"{unit!r} is {pascals:g} Pa, which no footprint is counted in; did you mean {_larger(text)}?"
        )
    return pascals


def length(text: str) -> float:
    """Metres of a number with its unit, as headers write it. Raises InputError."""
    for pattern, unit in _LENGTHS.items():
        text = pattern.sub(unit, text)
    return quantity(text.strip(), "m")


def _larger(unit: str) -> str:
    return "MPa" if unit == "mPa" else "Pa or kPa"
