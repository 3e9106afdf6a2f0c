"""Numbers with units at the edges: "3 mm" becomes 0.003; inside, everything is SI."""

from __future__ import annotations

import math
import re
from functools import cache
from typing import Any

from treadload.errors import InputError

# A number and its scale, which starts at a zero of its own: such units cannot be multiplied.
_TEMPERATURE = re.compile(r"([+-]?[\d.]+(?:[eE][+-]?\d+)?)\s*(\D+)")

_EXAMPLES = {
    "m": '"3 mm"',
    "Pa": '"8.2 bar" or "5400 MPa"',
    "Pa/m": '"1000 MPa/m"',
    "N": '"32.5 kN"',
    "s": '"10 ms"',
    "m/s": '"70 km/h"',
    "rad": '"2 deg"',
    "rad/m": '"0.05 1/m"',
    "K": '"50 K"',
    "degC": '"35 degC" or 35, in °C',
    "1/K": "-0.4",
    "1/K^2": "0.0015",
    "Hz": '"10 Hz"',
    "1/Pa": '"2.5e-5 1/MPa"',
    "J/mol": '"200 kJ/mol"',
    "W/(m K)": '"0.25 W/(m K)"',
    "J/(m^3 K)": '"2.1 MJ/(m^3 K)"',
    "": '"120 microstrain" or 0.7',
}


def quantity(value: object, unit: str) -> float:
    """Value in SI units: a bare number is SI already, a text carries its unit.

    unit: the SI unit it must have; "" for a pure number; "degC" for a temperature, °C. microstrain is 1e-6.
    Raises InputError for text that is no number with a unit of this kind, for NaN and for infinity.
    """
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise InputError(f"expected a number or a text such as {_EXAMPLES[unit]}, got {value!r}")
    number = _parse(value, unit) if isinstance(value, str) else float(value)
    if not math.isfinite(number):
        raise InputError(f"expected a finite number{f' of {unit}' if unit else ''}, got {value}")
    return number


def _parse(text: str, unit: str) -> float:
    registry = _registry()
    try:
        temperature = _TEMPERATURE.fullmatch(text.strip()) if unit == "degC" else None
        value = registry.Quantity(float(temperature[1]), temperature[2]) if temperature else registry.Quantity(text)
        # Fifteen digits take off the dust that factors such as bar → Pa leave.
        return float(f"{value.to(unit).magnitude:.15g}")
    except Exception as error:
        raise InputError(
            f"cannot read {text!r} as a quantity in {unit or 'pure numbers'}; write it like {_EXAMPLES[unit]}"
        ) from error


@cache
def _registry() -> Any:
    # Importing pint takes as long as a small solve; only cases with quoted units pay for it.
    import pint

    registry: Any = pint.UnitRegistry()
    registry.define("microstrain = 1e-6 = ustrain = με")
    return registry
