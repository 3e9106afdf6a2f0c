"""Temperatures of the user, in °C."""

from __future__ import annotations

import math

from treadload.errors import InputError

# A road above boiling water is kelvin mistaken for °C; below absolute zero there is nothing.
_HOTTEST, _COLDEST = 100.0, -273.15


def check_celsius(temperature: float) -> float:
    """A temperature, °C, as a float. Raises InputError for what is not one, and for what looks like kelvin."""
    try:
        value = float(temperature)
    except (TypeError, ValueError) as error:
        raise InputError(f"a temperature must be a number of °C, got {temperature!r}") from error
    if not math.isfinite(value) or value < _COLDEST:
        raise InputError(f"a temperature must be a finite number of °C above {_COLDEST:g}, got {value:g}")
    if value > _HOTTEST:
        raise InputError(
            f"{value:g} °C is hotter than {_HOTTEST:g} °C; if it is in kelvin, give °C: {value + _COLDEST:.6g}"
        )
    return value
