"""Every unit that a case knows, in every spelling of the number and of the unit."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from treadload.errors import InputError
from treadload.units import _EXAMPLES, quantity

# SI unit: spellings of units of its kind, and what each is worth in SI, by hand.
SPELLINGS = {
    "m": {"m": 1, "mm": 1e-3, "cm": 1e-2, "µm": 1e-6, "μm": 1e-6, "km": 1e3, "in": 0.0254, "inch": 0.0254},
    "Pa": {
        "Pa": 1, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "bar": 1e5, "N/mm²": 1e6, "N/mm2": 1e6, "N/mm^2": 1e6,
        "kN/m^2": 1e3, "kN / m²": 1e3, "N/mm**2": 1e6, "psi": 0.45359237 * 9.80665 / 0.0254**2,
    },
    "Pa/m": {"Pa/m": 1, "MPa/m": 1e6, "kPa/mm": 1e6, "N/mm³": 1e9, "N/m^3": 1},
    "N/m^3": {"N/m^3": 1, "kN/m^3": 1e3, "kN/m³": 1e3},
    "N": {"N": 1, "kN": 1e3, "MN": 1e6, "daN": 10, "kgf": 9.80665, "lbf": 0.45359237 * 9.80665},
    "s": {"s": 1, "ms": 1e-3, "min": 60, "h": 3600},
    "m/s": {"m/s": 1, "km/h": 1 / 3.6, "mph": 0.44704, "m·s^-1": 1, "mm/ms": 1},
    "m/s^2": {"m/s^2": 1, "m/s²": 1, "mm/s^2": 1e-3},
    "rad": {"rad": 1, "deg": math.pi / 180, "°": math.pi / 180, "mrad": 1e-3},
    "rad/m": {"rad/m": 1, "1/m": 1, "/m": 1, "1 / km": 1e-3, "deg/m": math.pi / 180},
    "1/m": {"1/m": 1, "/m": 1, "1 / km": 1e-3, "m^-1": 1, "1/mm": 1e3},
    "m^2": {"m^2": 1, "m²": 1, "cm^2": 1e-4, "mm²": 1e-6, "mm2": 1e-6},
    "N m": {"N m": 1, "N·m": 1, "kN m": 1e3, "N mm": 1e-3},
    "N/m": {"N/m": 1, "N/mm": 1e3, "kN/m": 1e3, "kN/mm": 1e6},
    "N/rad": {"N/rad": 1, "kN/rad": 1e3, "N/deg": 180 / math.pi},
    "N m/rad": {"N m/rad": 1, "kN m/rad": 1e3, "N m/deg": 180 / math.pi},
    "K": {"K": 1, "mK": 1e-3, "delta_degC": 1},
    "degC": {"degC": 1, "°C": 1},
    "1/K": {"1/K": 1, "/K": 1, "1/°C": 1, "%/K": 0.01},
    "1/K^2": {"1/K^2": 1, "1/K²": 1, "1/K**2": 1},
    "Hz": {"Hz": 1, "kHz": 1e3, "1/s": 1},
    "1/Pa": {"1/Pa": 1, "1/MPa": 1e-6, "1 / GPa": 1e-9, "mm²/N": 1e-6},
    "J/mol": {"J/mol": 1, "kJ/mol": 1e3},
    "W/(m K)": {"W/(m K)": 1, "W/m/K": 1, "mW/(mm·K)": 1, "W/(m·K)": 1},
    "J/(m^3 K)": {"J/(m^3 K)": 1, "MJ/(m³ K)": 1e6, "J/m^3/K": 1},
    "": {"": 1, "%": 0.01, "‰": 1e-3, "microstrain": 1e-6, "με": 1e-6, "µε": 1e-6, "ppm": 1e-6, "mm/m": 1e-3},
}  # fmt: skip
PAIRS = [(unit, written) for unit, ways in SPELLINGS.items() for written in ways]
GAPS = (" ", "\u00a0", "\u2009", "\u202f", "'", "’", "_")


def grouped(digits, gap):
    """Digits in groups of three from the right."""
    first = len(digits) % 3
    return gap.join([digits[:first], *(digits[k : k + 3] for k in range(first, len(digits), 3))][first == 0 :])


@st.composite
def numbers(draw):
    """A number as a person writes it, and its value."""
    sign = draw(st.sampled_from(["", "+", "-", "−"]))
    digits = str(draw(st.integers(0, 10**9)))
    # Three decimals behind a comma alone are refused, see below.
    part = draw(st.sampled_from(["", "5", "25", "0625", "662", "000"]))
    gap = draw(st.sampled_from(["", *GAPS])) if len(digits) > 3 else ""
    marks = "." if len(part) == 3 and not gap and len(digits) < 4 and digits != "0" else ".,"
    mark = draw(st.sampled_from(marks)) if part else ""
    power = draw(st.sampled_from(["", "e3", "E-2", "e+1", "e−3"]))
    shown = f"{sign}{grouped(digits, gap) if gap else digits}{mark}{part}{power}"
    return shown, float(f"{sign}{digits}.{part or 0}{power}".replace("−", "-"))


def test_every_unit_of_a_case_is_among_the_spellings():
    assert set(SPELLINGS) == set(_EXAMPLES)


@settings(deadline=None)
@given(number=numbers(), pair=st.sampled_from(PAIRS), blank=st.sampled_from(["", " ", "  ", "\u00a0"]))
def test_a_number_and_a_unit_are_read_for_what_they_are(number, pair, blank):
    (shown, value), (unit, written) = number, pair
    # A blank between digits and the 1 of "1/m" keeps them apart.
    blank = " " if written[:1] == "1" and not blank else blank
    # 15 digits are kept; a factor such as that of psi loses two.
    assert quantity(f"{shown}{blank}{written}", unit) == pytest.approx(value * SPELLINGS[unit][written], rel=1e-13)


@settings(deadline=None)
@given(
    number=numbers(),
    pair=st.sampled_from([pair for pair in PAIRS if pair[1]]),
    more=st.sampled_from(["4", " 4", "*2", "2*", " + 1", "-1", " 3 mm", ",5", ".5", "^", "/2", "=", "!"]),
)
def test_what_is_not_read_in_full_is_refused(number, pair, more):
    unit, written = pair
    with pytest.raises(InputError):
        quantity(f"{number[0]} {written}{more}", unit)
    with pytest.raises(InputError):
        quantity(f"2*{number[0]} {written}", unit)


@settings(deadline=None)
@given(whole=st.integers(1, 999), part=st.integers(0, 999), pair=st.sampled_from(PAIRS))
def test_a_comma_before_three_digits_is_refused_with_both_readings(whole, part, pair):
    unit, written = pair
    text = f"{whole},{part:03d} {written}"
    with pytest.raises(InputError) as refused:
        quantity(text, unit)
    for reading in (f"{whole}{part:03d} {written}", f"{whole} {part:03d} {written}", f"{whole}.{part:03d} {written}"):
        assert f'"{reading.strip()}"' in str(refused.value)
        quantity(reading, unit)


@settings(deadline=None)
@given(
    digits=st.from_regex(r"[0-9]{1,3}([.,][0-9]{1,4}){2,3}", fullmatch=True),
    pair=st.sampled_from(PAIRS),
)
def test_several_decimal_marks_are_refused(digits, pair):
    with pytest.raises(InputError, match="may mean"):
        quantity(f"{digits} {pair[1]}", pair[0])


@settings(deadline=None)
@given(pair=st.sampled_from([pair for pair in PAIRS if pair[1]]), other=st.sampled_from(sorted(SPELLINGS)))
def test_units_of_another_kind_are_refused(pair, other):
    unit, written = pair
    same = {
        frozenset(("rad/m", "1/K")),
        frozenset(("rad/m", "1/m")),
        frozenset(("Hz", "1/s")),
        frozenset(("Pa/m", "N/m^3")),
    }
    if other == unit or frozenset((unit, other)) in same or written in SPELLINGS[other]:
        return
    if {unit, other} == {"K", "degC"} and "deg" not in written and "°" not in written:
        return
    with pytest.raises(InputError):
        quantity(f"3 {written}", other)


@settings(deadline=None)
@given(
    digits=st.from_regex(r"[0-9]{1,4} [0-9]{1,2}|[0-9]{1,3} [0-9]{4,6}|0 [0-9]{3}|[0-9]{4} [0-9]{3}", fullmatch=True)
)
def test_thousands_in_crooked_groups_are_refused(digits):
    with pytest.raises(InputError, match="three digits"):
        quantity(f"{digits} kN", "N")
