"""US customary units for numbers that people read: the table of units, and the setting that turns it on.

Files, cases and everything inside stay in SI units; rows of results (`rows.py`), sentences of reports and finished
figures (`plots/kit/us_figure.py`) are shown in the units that are asked for here.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from types import MappingProxyType

from treadload.errors import InputError, nearest
from treadload.units import times_power_of_ten

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
    "J": USUnit("ft lbf", _LBF * _FOOT, 1), "kW/m²": USUnit("W/in²", 1 / _INCH**2, 1),
    "J/m²": USUnit("ft lbf/ft²", _LBF / _FOOT, 2), "kJ/m²": USUnit("ft lbf/ft²", _LBF / _FOOT, -1),
    "J/m³": USUnit("ft lbf/ft³", _LBF / _FOOT**2, 2), "km/h": USUnit("mph", 5280 * _FOOT / 3600, 1),
    "°C": USUnit("°F", 5 / 9, 0, 32.0), "K": USUnit("Δ°F", 5 / 9),
})  # fmt: skip
"""Unit of display (a key of `variables.SCALES`) → the US unit.

Other units stay: microstrain, %, years, W, and J/m, whose rows are labelled "per metre".
"""
_MODULUS = USUnit("ksi", 1e3 * _PSI, 1)
# A stiffness in a sentence: no stress of a road or a tire is so large, Pa.
_STIFF = 1e8
# A difference of temperature in a sentence.
_WARMER = USUnit("°F", 5 / 9, 1)
# From here on a number of a sentence has a decimal less: it was rounded in its SI unit.
_LARGE = 10.0

# Units that a sentence may have and that stay; they are longer than one of the table, and not to be taken for it.
_STAY = ("J/m", "kJ/mol", "J/mol", "W/(m K)", "MJ/(m³ K)", "m/s²", "m/s", "kN/m³", "MPa s", "Pa s")
_OF_SENTENCES: Mapping[str, USUnit] = MappingProxyType({
    "cm": USUnit("in", _INCH, 1), "km": USUnit("mi", 5280 * _FOOT, 1),
    "kN m/rad": USUnit("kip ft/rad", 1e3 * _LBF * _FOOT, 1), "N m/rad": USUnit("lbf ft/rad", _LBF * _FOOT, 1),
})  # fmt: skip
_ALL_US: Mapping[str, USUnit] = MappingProxyType({**US_UNITS, **_OF_SENTENCES})
_NAMES = "|".join(re.escape(unit) for unit in sorted((*_ALL_US, *_STAY), key=len, reverse=True))
_BLANK = "[ \n\u00a0\u202f]"
_NUMBER = "[+\u2212-]?\\d(?:[\u202f]?\\d)*(?:\\.\\d+)?(?:×10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+|e[+-]?\\d+)?"
_QUANTITY = re.compile(
    # Not the end of a name, a formula or a longer number.
    rf"(?<![\w.^⁻])(?P<number>{_NUMBER})(?P<blank>{_BLANK}?)(?P<unit>{_NAMES})(?![\w°²³√/·%^-]|{_BLANK}√)"
)
# A number that shares the unit of the next: 3 to 5 mm; x = 3, y = 5 mm; and after these words:
_SHARED = re.compile(
    rf"(?<![\w.^⁻])(?P<number>{_NUMBER})"
    rf"(?P<link>{_BLANK}(?:to|±|and|x|×){_BLANK}|[–-]|,{_BLANK}(?:[xyz]{_BLANK}={_BLANK})?)\Z"
)
# Depths 0, 20 mm; between 3 and 5 mm; cells of 3 x 3 mm. Elsewhere a comma, "and" and "x" part numbers of two kinds.
_SHARED_AFTER = {
    ",": re.compile(r"(?:depths?|solved,|at)\s\Z"), "and": re.compile(r"between\s\Z"), "x": re.compile(r"of\s\Z"),
    "×": re.compile(r"of\s\Z"),
}  # fmt: skip
_OF_AXIS = re.compile(rf"(?:\A|\()(?P<unit>{_NAMES}|MPa √m)(?:\)|\Z)")
_POWER = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")


@contextmanager
def display_units(system: str) -> Iterator[None]:
    """Show results in "si" or "us" units inside a `with` block: summaries, reports and figures.

    system: "si" or "us". What is written or drawn inside shows its numbers in these units; files of results stay in
    SI. Raises InputError for another word.

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


def in_us_units() -> bool:
    """True where numbers are shown in US units."""
    return _system.get() == "us"


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


def sentence_in_display_units(text: str) -> str:
    """A sentence with its numbers in the units of display: "3 to 5 mm deep" becomes "0.12 to 0.20 in deep".

    text: with SI units. A number keeps its digits; one that shares the unit of the next is shown in it as well. From
    100 MPa on it is a modulus, shown in ksi; "+1 °C" and "by 1 °C" are differences of temperature. Units without a US
    unit stay.
    """
    if _system.get() == "si":
        return text
    parts, done = [], 0
    for match in _QUANTITY.finditer(text):
        unit = match["unit"]
        if unit not in _ALL_US:
            continue
        start, numbers = match.start(), [(match["number"], "")]
        while (shared := _SHARED.search(text, done, start)) is not None:
            start = shared.start()
            numbers.insert(0, (shared["number"], shared["link"]))
        while (link := numbers[0][1].strip()) in _SHARED_AFTER and not _SHARED_AFTER[link].search(text, 0, start):
            start += len("".join(numbers.pop(0)))
        is_difference = unit == "°C" and (numbers[0][0].startswith("+") or text[:start].endswith("by "))
        largest = max(abs(_value(number)) for number, _ in numbers) * _size_of(unit)
        shown = _WARMER if is_difference else _us_unit_of(unit, largest)
        texts = (_shown_number(number, unit, shown) + link for number, link in numbers)
        parts += [text[done:start], *texts, match["blank"] or " ", shown.symbol]
        done = match.end()
    return "".join([*parts, text[done:]])


@dataclass(frozen=True)
class AxisUnit:
    """The unit of an axis whose numbers are in an SI unit. size: of the SI unit, SI. shown: the US unit."""

    size: float
    shown: USUnit

    def number(self, value: float) -> float:
        """A number of the axis in the US unit."""
        return self.shown.number(value * self.size)

    def value(self, number: float) -> float:
        """A number in the US unit in that of the axis."""
        return (number - self.shown.zero) * self.shown.size / self.size


def axis_in_display_units(label: str, largest: float = 0.0) -> tuple[str, AxisUnit | None]:
    """The label of an axis in the units of display, and the unit of its numbers; None where they stay.

    label: ends with its unit in brackets, "depth (mm)", or is a unit. largest: number of the axis, in its unit.
    """
    match = _OF_AXIS.search(label)
    unit = match["unit"].replace(" √", "√") if match is not None else ""
    if _system.get() == "si" or match is None or unit not in _ALL_US:
        return sentence_in_display_units(label), None
    is_modulus = unit == "MPa" and "modul" in label
    shown = _MODULUS if is_modulus else _us_unit_of(unit, abs(largest) * _size_of(unit))
    before, after = label[: match.start("unit")], label[match.end("unit") :]
    parts = sentence_in_display_units(before), shown.symbol, sentence_in_display_units(after)
    return "".join(parts), AxisUnit(_size_of(unit), shown)


@functools.cache
def _size_of(unit: str) -> float:
    """An SI unit of a sentence in SI base units."""
    # Loads NumPy, which commands that show no number do without.
    from treadload.variables import SCALES

    return {"cm": 1e-2, "km": 1e3, "kN m/rad": 1e3, "N m/rad": 1.0}.get(unit) or 1 / SCALES[unit]


def _us_unit_of(unit: str, largest: float) -> USUnit:
    """The US unit of numbers in an SI unit. largest: of them, SI."""
    if unit == "MPa" and largest >= _STIFF:
        return _MODULUS
    return _ALL_US[unit]


def _value(number: str) -> float:
    """The number of a text with a true minus, narrow spaces and raised powers."""
    mantissa, _, power = number.replace("\u2212", "-").replace("\u202f", "").partition("×10")
    return float(mantissa) * 10.0 ** int(power.translate(_POWER) or 0)


def _shown_number(number: str, unit: str, shown: USUnit) -> str:
    """A number of a sentence in a US unit, with as many digits as it had."""
    value = _value(number)
    if value == 0 and not shown.zero:
        return "0"
    minus, plus = "\u2212" if "\u2212" in number else "-", "+" if number.startswith("+") else ""
    if "×10" in number or "e" in number:
        return times_power_of_ten(f"{shown.number(value * _size_of(unit)):{plus}.2e}").replace("-", minus)
    decimals = len(number.partition(".")[2])
    added = shown.decimals - (abs(shown.number(value * _size_of(unit))) >= _LARGE and shown.decimals > 0)
    return f"{shown.number(value * _size_of(unit)):{plus}.{max(decimals + added, 0)}f}".replace("-", minus)
