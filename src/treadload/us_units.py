"""US customary units for numbers that people read: the table of units, and the setting that turns it on.

Files, cases and everything inside stay in SI units; rows of results (`rows.py`) ask here in what they are shown.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from types import MappingProxyType

from treadload.errors import InputError, nearest

SYSTEMS = ("si", "us")
_system: ContextVar[str] = ContextVar("treadload_display_units", default="si")

# Exact by definition: international foot and pound, standard gravity.
_FOOT, _INCH, _LBF = 0.3048, 0.0254, 4.4482216152605
_PSI, _DEGREE = _LBF / _INCH**2, 0.017453292519943295

_FIXED = re.compile(r"(?P<flags>[+z]*)\.(?P<decimals>\d+)f")
_GENERAL = re.compile(r"(?P<flags>[+z]*)(?:\.(?P<digits>\d+))?g")
# Numbers from here on have a power of ten.
_LONG = 1e7
_TEXT = re.compile(r"(?P<sign>[+-]?)\d+(?:\.(?P<decimals>\d+))?(?P<power>e[+-]?\d+)? (?P<unit>\S.*)")


@dataclass(frozen=True)
class USUnit:
    """A US unit. symbol: as shown. size: of the unit, SI. decimals: more than the number in its SI unit has, so that
    no digit is lost. zero: what the number is where that in SI is zero, of a temperature.
    """

    symbol: str
    size: float
    decimals: int = 0
    zero: float = 0.0

    def number(self, value: float) -> float:
        """A value, SI, in this unit."""
        return value / self.size + self.zero

    def text(self, value: float, form: str) -> str:
        """A value, SI, in this unit, without the unit. form: of the number in the SI unit of display."""
        number, fixed, general = self.number(value), _FIXED.fullmatch(form), _GENERAL.fullmatch(form)
        if fixed is not None:
            return f"{number:{fixed['flags']}.{max(int(fixed['decimals']) + self.decimals, 0)}f}"
        if general is not None:
            digits = int(general["digits"] or 4)
            rounded = float(f"{number:.{digits}g}")
            # 1780 psi, not 1.78e+03 psi.
            is_whole = 10.0**digits <= abs(rounded) < _LONG
            return f"{rounded:{general['flags']}.0f}" if is_whole else f"{number:{general['flags']}.{digits}g}"
        return format(number, form)


US_UNITS: Mapping[str, USUnit] = MappingProxyType({
    "m": USUnit("ft", _FOOT), "mm": USUnit("in", _INCH, 2), "µm": USUnit("mil", 1e-3 * _INCH, 2),
    "mm²": USUnit("in²", _INCH**2, 3), "cm²": USUnit("in²", _INCH**2, 1),
    "N": USUnit("lbf", _LBF, 1), "kN": USUnit("kip", 1e3 * _LBF, 1),
    "Pa": USUnit("psi", _PSI, 4), "kPa": USUnit("psi", _PSI, 1), "MPa": USUnit("psi", _PSI, -2),
    "GPa": USUnit("ksi", 1e3 * _PSI, -2), "MPa/m": USUnit("psi/in", _PSI / _INCH),
    "N m": USUnit("lbf ft", _LBF * _FOOT, 1), "kN m": USUnit("kip ft", 1e3 * _LBF * _FOOT, 1),
    "N/mm": USUnit("lbf/in", _LBF / _INCH), "kN/rad": USUnit("kip/rad", 1e3 * _LBF, 1),
    "kN/°": USUnit("kip/°", 1e3 * _LBF / _DEGREE, 1), "N m/°": USUnit("lbf ft/°", _LBF * _FOOT / _DEGREE, 1),
    "rad/m": USUnit("rad/ft", 1 / _FOOT, 1), "N/kN": USUnit("lbf/kip", 1e-3),
    "MPa√m": USUnit("ksi√in", 1e3 * _PSI * _INCH**0.5, 1),
    "J": USUnit("ft lbf", _LBF * _FOOT, 1),
    "J/m²": USUnit("ft lbf/ft²", _LBF / _FOOT, 2), "kJ/m²": USUnit("ft lbf/ft²", _LBF / _FOOT, -1),
    "J/m³": USUnit("ft lbf/ft³", _LBF / _FOOT**2, 2), "km/h": USUnit("mph", 5280 * _FOOT / 3600, 1),
    "°C": USUnit("°F", 5 / 9, 0, 32.0), "K": USUnit("Δ°F", 5 / 9),
})  # fmt: skip
"""Unit of display (a key of `variables.SCALES`) → the US unit.

Other units stay: microstrain, %, years, W, and J/m, whose rows are labelled "per metre".
"""
_MODULUS = USUnit("ksi", 1e3 * _PSI, 1)


@contextmanager
def display_units(system: str) -> Iterator[None]:
    """Show the numbers of rows in "si" or "us" units inside a `with` block.

    system: "si" or "us". Summaries and reports that are written inside show their numbers in these units; files of
    results stay in SI. Raises InputError for another word.

    >>> from treadload.rows import row
    >>> with display_units("us"):
    ...     row("normal_load", 40e3).text
    '8.9924 kip'
    """
    check_system(system)
    token = _system.set(system)
    try:
        yield
    finally:
        _system.reset(token)


def check_system(system: str) -> str:
    """The name of a system of units. Raises InputError for one that does not exist."""
    if system not in SYSTEMS:
        raise InputError(f"units are shown in si or us, got {system!r}; {nearest(system, SYSTEMS)}")
    return system


def us_unit(unit: str, key: str = "") -> USUnit | None:
    """The US unit that a number is shown in; None where its unit stays, and in SI.

    unit: of display. key: of the row; moduli are shown in ksi, stresses in psi.
    """
    if _system.get() == "si":
        return None
    return _MODULUS if unit == "MPa" and "modulus" in key else US_UNITS.get(unit)


def in_display_units(text: str, value: float, key: str = "") -> str:
    """A number with its unit, "812 kPa", in the units of display; other texts stay. value: the same number, SI."""
    match = _TEXT.fullmatch(text)
    shown = us_unit(match["unit"], key) if match is not None else None
    if match is None or shown is None:
        return text
    sign = "+" if match["sign"] == "+" else ""
    form = f"{sign}.3g" if match["power"] else f"{sign}.{len(match['decimals'] or '')}f"
    return f"{shown.text(value, form)} {shown.symbol}"
