"""Numbers with units at the edges: "3 mm" becomes 0.003; inside, everything is SI.

Text is a number and a unit, and nothing else. The number is read here, strictly: pint would read "32,5 kN" as
325 kN and work out "2*3 mm". Only the unit goes to pint.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Annotated

from treadload.errors import InputError

if TYPE_CHECKING:
    import pint
    from pydantic_core import CoreSchema

# What may stand between thousands: blank, no-break, thin and narrow no-break space, apostrophes, underscore.
_GAP = "[ \u00a0\u2009\u202f'\u2019_]"
_NUMBER = re.compile(
    rf"(?P<sign>[+\-\u2212]?)"
    rf"(?P<whole>[1-9][0-9]{{0,2}}(?P<gap>{_GAP})[0-9]{{3}}(?:(?P=gap)[0-9]{{3}})*(?![0-9])|[0-9]*)"
    r"(?P<mark>[.,]?)(?P<part>(?<=[.,])[0-9]*|)"
    r"(?:[eE](?P<power>[+\-\u2212]?[0-9]+))?"
)
# Digits that belong to a unit: powers, and the one of "1/m". A power of a power would keep pint busy for ever.
_POWERS = re.compile(r"(?:\^|\*\*)\s*\(?-?[0-9]\)?(?!\s*(?:\^|\*\*))|^1\s*(?=/)")
_LETTERS = re.compile(r"(?:[^\W\d]|[%‰°⁻/*() ])*")
_BARE_POWER = re.compile(r"(?<=[A-Za-zµμ])([23])(?![0-9A-Za-z])")
_TIMES = str.maketrans({"·": "*", "⋅": "*", "\u00a0": " ", "\u2009": " ", "\u202f": " "})

PSI = 6894.757293168361
"""A pound-force per square inch, Pa: of laws that are published in it."""
# Years and load repetitions beyond which no road is known and no number of a law is meant; files keep the number.
LASTS, COUNTLESS = 100.0, 1e10

_EXAMPLES = {
    "m": '"3 mm"',
    "Pa": '"8.2 bar" or "5400 MPa"',
    "m^2": '"587 cm^2"',
    "Pa/m": '"1000 MPa/m"',
    "N/m": '"436 N/mm"',
    "N/rad": '"198 kN/rad"',
    "N m/rad": '"9 kN m/rad"',
    "N": '"32.5 kN"',
    "s": '"10 ms"',
    "m/s": '"70 km/h"',
    "m/s^2": '"3 m/s^2"',
    "rad": '"2 deg"',
    "rad/m": '"0.05 1/m"',
    "1/m": '"4.9 1/m"',
    "N m": '"80 N m"',
    "K": '"50 K"',
    "degC": '"35 degC" or 35, in °C',
    "1/K": "-0.4",
    "1/K^2": "0.0015",
    "Hz": '"10 Hz"',
    "1/Pa": '"2.5e-5 1/MPa"',
    "J/mol": '"200 kJ/mol"',
    "W/(m K)": '"0.25 W/(m K)"',
    "J/(m^3 K)": '"2.1 MJ/(m^3 K)"',
    "N/m^3": '"20 kN/m^3"',
    "": '"120 microstrain" or 0.7',
}
# Spellings that a person types with capitals astray.
_USUAL = (
    "m", "cm", "mm", "µm", "km", "N", "kN", "MN", "Pa", "kPa", "MPa", "GPa", "bar", "psi", "N/mm²", "kN/m²", "MPa/m",
    "m/s", "km/h", "s", "ms", "Hz", "K", "deg", "rad", "1/m", "kJ/mol", "J/mol", "1/MPa", "microstrain",
)  # fmt: skip
# Usual units, by the SI unit asked for, which need no pint: it takes as long to start as a small solve.
_FACTORS = {
    "m": {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "µm": 1e-6, "km": 1e3},
    "m^2": {"m^2": 1.0, "cm^2": 1e-4, "mm^2": 1e-6},
    "Pa": {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "bar": 1e5, "psi": PSI},
    "Pa/m": {"MPa/m": 1e6, "GPa/m": 1e9},
    "N": {"N": 1.0, "kN": 1e3},
    "N m": {"N m": 1.0},
    "N/m": {"N/m": 1.0, "N/mm": 1e3},
    "N/m^3": {"N/m^3": 1.0, "kN/m^3": 1e3},
    "1/m": {"1/m": 1.0},
    "m/s": {"m/s": 1.0, "km/h": 1 / 3.6},
    "s": {"s": 1.0, "ms": 1e-3},
    "Hz": {"Hz": 1.0},
    "K": {"K": 1.0},
    "rad": {"rad": 1.0, "deg": math.pi / 180},
    "": {"%": 1e-2, "microstrain": 1e-6},
}
# Of the same dimension: what is counted in the first can be written in units of the second.
_ALIKE = {"Pa/m": "N/m^3", "N/m^3": "Pa/m"}
# Angles are pure numbers to pint; here 2 deg is not a pure number, and 600 rpm are not 62.8 Hz.
_ALSO = {"rad/m": "1/m"}


def quantity(value: object, unit: str) -> float:
    """Value in SI units: a bare number is SI already, text carries its unit.

    unit: the SI unit it must have; "" for a pure number; "degC" for a temperature, °C. microstrain is 1e-6.
    The number of a text has a point or a comma as its decimal mark, perhaps thousands in groups of three with a
    space, an apostrophe or an underscore between, perhaps an exponent: "32.5 kN", "32,5 kN", "1 000 kN", "1.2e6 N".
    Raises InputError for text that is not a number with a unit of this kind, for a number that can be read in two
    ways ("1,000 kN"), for NaN and for infinity.
    """
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise InputError(f"expected a number or text such as {_EXAMPLES[unit]}, got {value!r}")
    try:
        number = _parse(value, unit) if isinstance(value, str) else float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        shown = value if isinstance(value, str | float) else "an integer of more than 308 digits"
        raise InputError(f"expected a finite number{f' of {unit}' if unit else ''}, got {shown}")
    return number


def leading_number(text: str) -> tuple[float, str]:
    """The number that a text starts with, and what stands behind it.

    Raises InputError where there is none, or where it can be read in two ways.
    """
    bare = text.strip()
    match = _NUMBER.match(bare)
    assert match is not None
    whole, part, rest = re.sub(_GAP, "", match["whole"]), match["part"], bare[match.end() :]
    if not (whole or part):
        raise InputError(f"cannot read {text!r}: it does not start with a number")
    if re.match(r"[.,]", rest):
        raise InputError(_several_marks(bare))
    if match["mark"] == "," and len(part) == 3 and not match["gap"] and re.fullmatch("[1-9][0-9]{0,2}", whole):
        raise InputError(
            f"{text!r} may mean {whole + part} or {float(f'{whole}.{part}'):g}; write {_quoted(whole + part, rest)} "
            f"or {_quoted(f'{whole} {part}', rest)} for the first, {_quoted(f'{whole}.{part}', rest)} for the second"
        )
    # A group that is not one of three: "1 00 kN", "0 662 MPa"; the 1 of "5 1/m" belongs to the unit.
    if re.match(rf"{_GAP}*[0-9]", rest) and not re.match(r"\s*1\s*/", rest):
        raise InputError(
            f"{text!r} holds digits behind its number; groups of thousands have three digits and one blank between, "
            'as in "1 000 kN"'
        )
    digits = f"{match['sign']}{whole or 0}.{part or 0}e{match['power'] or 0}"
    return float(digits.replace("\u2212", "-")), rest.strip()


def _several_marks(text: str) -> str:
    """The message about a number with more than one decimal mark."""
    number = re.match(r"[+\-\u2212]?[0-9.,]*", text)
    assert number is not None
    shown, unit = number[0].rstrip(".,"), text[number.end() :]
    *before, after = re.split("[.,]", shown)
    if len(before) < 2:
        return f"{text!r} holds several points or commas; write one decimal mark"
    last = "".join(before) + "." + after
    # Two kinds of marks: the last is the decimal one, or the first. One kind: all between thousands, or the last not.
    mixed = len({mark for mark in shown if mark in ".,"}) > 1
    ways = [last, f"{before[0]}.{''.join(before[1:])}{after}"] if mixed else ["".join(before) + after, last]
    return f"{text!r} may mean {ways[0]} or {ways[1]}; write {_quoted(ways[0], unit)} or {_quoted(ways[1], unit)}"


def _quoted(number: str, unit: str) -> str:
    return f'"{number}{unit}"'


def _parse(text: str, unit: str) -> float:
    how = f"write it like {_EXAMPLES[unit]}"
    try:
        number, written = leading_number(text)
    except InputError as error:
        complaint = str(error)
        raise InputError(
            complaint if "write" in complaint or "groups" in complaint else f"{complaint}; {how}"
        ) from error
    if not written and unit and unit != "degC" and number == 0:
        return 0.0
    try:
        if unit == "degC":
            value = _degrees(number, written)
        else:
            value = number * (_FACTORS.get(unit, {}).get(written) or _unusual_factor(written, unit))
    except InputError:
        raise
    except Exception as error:
        kind = unit or "pure numbers"
        near = next((f'"{unit}"' for unit in _USUAL if unit.casefold() == written.casefold() != unit), "")
        why = "it has no unit" if not written else f"{written!r} is not a unit of this kind"
        hint = f"did you mean {near}?" if near else how
        raise InputError(f"cannot read {text!r} as a quantity in {kind}: {why}; {hint}") from error
    # Fifteen digits remove the round-off that factors such as bar → Pa leave.
    return float(f"{value:.15g}")


def _unusual_factor(written: str, unit: str) -> float:
    """As `_factor`, which is asked only where no usual unit of another kind is written."""
    if _is_of_another_kind(written, unit):
        raise ValueError("another kind of unit")
    return _factor(written, unit)


def _is_of_another_kind(written: str, unit: str) -> bool:
    """Whether a usual unit is not of this kind, without pint, whose import takes as long as a small solve."""
    unlike = _FACTORS.keys() - {unit, _ALIKE.get(unit)}
    return unit in _FACTORS and any(written in _FACTORS[kind] for kind in unlike)


@cache
def _factor(written: str, unit: str) -> float:
    """What a number in a unit, as written, is multiplied by. Raises whatever pint does for another kind of unit."""
    registry = _registry()
    units = _units(written)
    wanted = [registry.parse_units(dimension) for dimension in (unit, *([_ALSO[unit]] if unit in _ALSO else []))]
    if not any(_roots(units) == _roots(dimension) for dimension in wanted):
        raise ValueError("another kind of unit")
    if registry.Quantity(0.0, units).to(unit).magnitude != 0:
        raise ValueError("a scale with a zero of its own is not a multiple of a unit")
    return float(registry.Quantity(1.0, units).to(unit).magnitude)


def _degrees(number: float, written: str) -> float:
    """Temperature in °C. Raises whatever pint does for another kind of unit."""
    if written in ("degC", "°C"):
        return round(number, 9)
    units = _units(written)
    if "delta" in str(units):
        raise ValueError("a difference is not a temperature")
    # Round-off of the zeros of the scales.
    return round(float(_registry().Quantity(number, units).to("degC").magnitude), 9)


def _units(written: str) -> pint.Unit:
    """A unit of pint from its text, which may hold no number but powers."""
    text = _BARE_POWER.sub(r"^\1", written.translate(_TIMES))
    text = f"1{text}" if text.startswith("/") else text
    if not _LETTERS.fullmatch(_POWERS.sub("", text)):
        raise ValueError("digits and signs in a unit")
    return _registry().parse_units(text)


def _roots(units: pint.Unit) -> dict[str, object]:
    """Base units and their powers, angles among them."""
    return dict(_registry().get_root_units(units)[1]._units)


@cache
def _registry() -> pint.UnitRegistry[float]:
    # Importing pint takes as long as a small solve; only cases with quoted units pay for it.
    import pint

    registry: pint.UnitRegistry[float] = pint.UnitRegistry()
    registry.define("microstrain = 1e-6 = ustrain = με = µε")
    return registry


# Of text in a schema, for ECMA: it begins with a number, and more than digits and marks follow where a unit must.
# What is read, `quantity` decides.
_BARE = r"^\s*[+\-\u2212]?(?:[0-9]|[.,][0-9])"
_WITH_UNIT = _BARE + r".*[^\s0-9.,]"


@dataclass(frozen=True)
class Unit:
    """What a number is counted in, as an annotation: `Annotated[float, Unit("Pa")]`.

    si: unit of the number, "" of a pure number, "degC" of a temperature. kind: of quantity, where people count it in
    a unit of its own, as moduli in MPa and other pressures in kPa.
    """

    si: str
    kind: str = ""

    @property
    def symbol(self) -> str:
        """What people count it in, for whoever shows it."""
        return self.kind or self.si

    @property
    def example(self) -> str:
        """A value as a case writes it."""
        return _OF_KINDS.get(self.kind or self.si) or _EXAMPLES[self.si]

    # What pydantic asks of an annotation; nothing here needs it.
    def __get_pydantic_core_schema__(self, source: object, handler: Callable[[object], CoreSchema]) -> CoreSchema:
        """How a case reads it: `quantity`."""
        from pydantic_core import core_schema

        return core_schema.no_info_before_validator_function(lambda value: quantity(value, self.si), handler(source))

    def __get_pydantic_json_schema__(self, schema: object, handler: object) -> dict[str, object]:
        """A number in SI units, or text with its unit."""
        bare = "°C" if self.si == "degC" else self.si
        words = f"A number in {bare}, or text such as {self.example}." if bare else f"A number, {self.example}."
        kind = {"x-kind": self.kind} if self.kind else {}
        pattern = _WITH_UNIT if self.si else _BARE
        return {"type": ["number", "string"], "pattern": pattern, "description": words, "x-unit": self.si, **kind}


_OF_KINDS = {
    "": "0.7",
    "degC": '"35 degC"',
    "modulus": '"5400 MPa"',
    "radius": '"25 m"',
    "sliding speed": '"2 m/s"',
    "strain": '"120 microstrain"',
    "share": '0.25 or "25 %"',
    "years": "20",
    "1/year": "1e6",
}

Length = Annotated[float, Unit("m")]
Radius = Annotated[float, Unit("m", "radius")]
Pressure = Annotated[float, Unit("Pa")]
Modulus = Annotated[float, Unit("Pa", "modulus")]
Stiffness = Annotated[float, Unit("Pa/m")]
Force = Annotated[float, Unit("N")]
PerLength = Annotated[float, Unit("1/m")]
BendingStiffness = Annotated[float, Unit("N m")]
Area = Annotated[float, Unit("m^2")]
Moment = Annotated[float, Unit("N m")]
SpringStiffness = Annotated[float, Unit("N/m")]
CorneringStiffness = Annotated[float, Unit("N/rad")]
AligningStiffness = Annotated[float, Unit("N m/rad")]
Speed = Annotated[float, Unit("m/s")]
SlidingSpeed = Annotated[float, Unit("m/s", "sliding speed")]
Acceleration = Annotated[float, Unit("m/s^2")]
Angle = Annotated[float, Unit("rad")]
Curvature = Annotated[float, Unit("rad/m")]
Time = Annotated[float, Unit("s")]
Frequency = Annotated[float, Unit("Hz")]
Kelvin = Annotated[float, Unit("K")]
Celsius = Annotated[float, Unit("degC")]
PerDegree = Annotated[float, Unit("1/K")]
PerDegreeSquared = Annotated[float, Unit("1/K^2")]
Compliance = Annotated[float, Unit("1/Pa")]
MolarEnergy = Annotated[float, Unit("J/mol")]
Conductivity = Annotated[float, Unit("W/(m K)")]
HeatCapacity = Annotated[float, Unit("J/(m^3 K)")]
UnitWeight = Annotated[float, Unit("N/m^3")]
Number = Annotated[float, Unit("")]
Strain = Annotated[float, Unit("", "strain")]
Share = Annotated[float, Unit("", "share")]
Years = Annotated[float, Unit("", "years")]
PerYear = Annotated[float, Unit("", "1/year")]
"""Numbers of descriptions with their units, for annotations: a type checker sees a float."""


def years_in_words(years: float) -> str:
    """Years with three digits, that they are more than roads last, or that they never end; "–" where not known."""
    if math.isnan(years):
        return "–"
    if math.isinf(years):
        return "never"
    return f"{years:.3g} years" if years <= LASTS else f"more than {LASTS:g} years"


def remaining_in_words(years: float) -> str:
    """Years that are left of a service life; that none are, and how long ago it ended, where they are negative."""
    return f"none (ended {-years:.3g} years ago)" if years < 0 else years_in_words(years)


_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def times_power_of_ten(number: str) -> str:
    """A number such as "1.2e+05" with a raised power: "1.2×10⁵"."""
    mantissa, _, power = number.partition("e")
    return f"{mantissa}×10{str(int(power)).translate(_RAISED)}"


def repetitions_in_words(repetitions: float) -> str:
    """Load repetitions with three digits; that they are more than any road sees; "–" where not known."""
    if math.isnan(repetitions):
        return "–"
    if math.isinf(repetitions):
        return "unlimited"
    return f"{repetitions:.3g}" if repetitions < COUNTLESS else f"{repetitions:.2g} (over 10¹⁰)"


def stress_in_words(value: float) -> str:
    """A stress, Pa, as a reader needs it: whole kPa of a tire, three digits of MPa or GPa from 10 MPa on.

    Below 10 kPa it has two digits; below 1 Pa it is none.
    """
    if abs(value) < 9.95e3:
        return f"{value / 1e3:.2g} kPa" if abs(value) >= 1.0 else "0 kPa"
    for size, unit in ((1e9, "GPa"), (1e6, "MPa")):
        if abs(value) >= 10e6 and abs(value) >= 0.9995 * size:
            return f"{value / size:.3g} {unit}"
    return f"{value / 1e3:.0f} kPa"
