"""US units of display: each conversion beside pint's, which knows none of the numbers of the table."""

import json
import math
import re

import pint
import pytest

from treadload.errors import InputError
from treadload.rows import Place, Row, as_json, as_text, from_json, row
from treadload.us_units import US_UNITS, display_units, sentence_in_display_units, us_unit
from treadload.variables import SCALES, VARIABLES, display_of

# Unit of display → the same unit and the US unit, in the words of pint.
PINT = {
    "m": ("m", "ft"), "mm": ("mm", "inch"), "µm": ("um", "thou"), "mm²": ("mm**2", "inch**2"),
    "cm²": ("cm**2", "inch**2"), "N": ("N", "lbf"), "kN": ("kN", "kip"), "Pa": ("Pa", "psi"), "kPa": ("kPa", "psi"),
    "MPa": ("MPa", "psi"), "GPa": ("GPa", "ksi"), "MPa/m": ("MPa/m", "psi/inch"), "N m": ("N*m", "lbf*ft"),
    "kN m": ("kN*m", "kip*ft"), "N/mm": ("N/mm", "lbf/inch"), "kN/rad": ("kN/rad", "kip/rad"),
    "kN/°": ("kN/deg", "kip/deg"), "N m/°": ("N*m/deg", "lbf*ft/deg"), "rad/m": ("rad/m", "rad/ft"),
    "N/kN": ("N/kN", "lbf/kip"), "MPa√m": ("MPa*m**0.5", "ksi*inch**0.5"), "J": ("J", "ft*lbf"),
    "J/m²": ("J/m**2", "ft*lbf/ft**2"), "kJ/m²": ("kJ/m**2", "ft*lbf/ft**2"),
    "J/m³": ("J/m**3", "ft*lbf/ft**3"), "km/h": ("km/h", "mile/hour"), "°C": ("degC", "degF"),
    "K": ("kelvin", "delta_degF"), "kW/m²": ("kW/m**2", "W/inch**2"),
}  # fmt: skip
# Read once: a registry takes a fifth of a second.
UNITS = pint.UnitRegistry()
STAY = {"", "J/m", "microstrain", "%", "°", "W", "s", "years"}
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def test_each_unit_of_display_is_converted_or_stays():
    assert set(US_UNITS) == set(PINT)
    assert set(US_UNITS) | STAY == set(SCALES)


@pytest.mark.parametrize("unit", sorted(PINT))
@pytest.mark.parametrize("value", [0.0, 0.0137, -812e3])
def test_a_number_is_that_of_pint(unit, value):
    before, after = PINT[unit]
    quantity = UNITS.Quantity(value * SCALES[unit], before)
    expected = quantity.to(after).magnitude
    # The zeros of the scales of temperature cancel: round-off of 273.15 K remains.
    assert US_UNITS[unit].number(value) == pytest.approx(expected, rel=1e-12, abs=1e-12 if unit != "°C" else 1e-10)


def test_moduli_are_in_ksi():
    expected = UNITS.Quantity(5400.0, "MPa").to("ksi").magnitude
    with display_units("us"):
        unit = us_unit("MPa", "fitted_modulus")
        assert unit is not None
        assert unit.number(5400e6) == pytest.approx(expected, rel=1e-12)
        assert row("fitted_modulus", 5400e6).text == "783.2 ksi"


@pytest.mark.parametrize("name", sorted(name for name in VARIABLES if display_of(name).unit in US_UNITS))
def test_the_row_of_each_variable_holds_the_number_of_pint(name):
    value = 0.0123 * 10 ** math.floor(-math.log10(SCALES[display_of(name).unit]) + 3)
    stated = row(name, value)
    before, after = PINT[display_of(name).unit]
    if display_of(name).unit == "MPa" and "modulus" in name:
        after = "ksi"
    expected = UNITS.Quantity(value * SCALES[stated.unit], before).to(after).magnitude
    in_si = stated.text
    with display_units("us"):
        shown, unit = stated.text, stated.shown_unit
        assert row(name, value).label == stated.label
    assert shown.endswith(f" {unit}")
    assert unit == US_UNITS[stated.unit].symbol or after == "ksi"
    # The number is rounded to its digits: it may be off by half of the last, of three at least.
    digits = re.search(r"\.(\d+)", shown)
    step = 10.0 ** -(len(digits[1]) if digits else 0)
    assert float(NUMBER.match(shown)[0]) == pytest.approx(expected, rel=5e-3, abs=0.51 * step)
    assert stated.text == in_si


@pytest.mark.parametrize(
    ("key", "value", "si", "us"),
    [
        ("largest_pressure", 812e3, "812 kPa", "117.8 psi"),
        ("largest_pressure", 12.3e6, "12.3 MPa", "1784 psi"),
        ("normal_load", 40e3, "40.000 kN", "8.9924 kip"),
        ("tractive_force", -1e-9, "0.0 N", "0.00 lbf"),
        ("approach", 12.34e-3, "12.34 mm", "0.4858 in"),
        ("read_depth", 0.2, "200 mm", "7.874 in"),
        ("net_area", 0.0532, "53200 mm²", "82.460 in²"),
        ("equivalent_temperature", 15.0, "15.0 °C", "59.0 °F"),
        ("flash_temperature", 10.0, "10.0 K", "18.0 Δ°F"),
        ("mastic_tension", 12.34e6, "12.3 MPa", "1790 psi"),
        ("fitted_modulus", 82e6, "82 MPa", "11.9 ksi"),
        ("worst_strain", 123.4e-6, "123.4 microstrain", "123.4 microstrain"),
        ("life_years", 17.0, "17 years", "17 years"),
        ("life_passes", 1.5e6, "1.5e+06", "1.5e+06"),
        ("slip_fraction", 0.123, "12.3 %", "12.3 %"),
        ("spin", math.nan, "–", "–"),
    ],
)
def test_texts_of_rows(key, value, si, us):
    stated = row(key, value)
    assert stated.text == si
    with display_units("us"):
        assert stated.text == us
    assert stated.text == si


def test_a_place_and_the_head_of_a_table():
    rows = [
        row("approach", 1e-3, group="first", place=Place(0.0254, -1e-9, 0.0508)),
        row("approach", 2e-3, group="second"),
    ]
    with display_units("us"):
        lines = as_text(rows).splitlines()
    assert lines[0].split() == ["approach,", "in"]
    assert lines[1].split() == ["first", "0.0394"]
    assert lines[3] == "  first: at x = 1.000 in, y = 0.000 in, 2 in deep"
    assert "mm" in as_text(rows)


def test_files_keep_si_and_rows_of_files_are_converted():
    rows = [row("largest_pressure", 812e3), row("approach", 12e-3), row("law", "Coulomb, 0.7")]
    with display_units("us"):
        written = as_json(rows)
    assert written == as_json(rows)
    assert json.loads(written)[0]["form"] == {"text": "812 kPa"}
    with display_units("us"):
        assert [line.text for line in from_json(written)] == ["117.8 psi", "0.4724 in", "Coulomb, 0.7"]
    assert [line.text for line in from_json(written)] == ["812 kPa", "12.00 mm", "Coulomb, 0.7"]


def test_the_text_and_the_note_of_a_row_are_converted():
    stated = Row("grid", "grid", "cells of 2 mm", note="on a base of 200 mm")
    with display_units("us"):
        assert stated.sentence == "cells of 0.08 in, on a base of 7.87 in"
        assert as_text([stated], ["5 mm is too coarse"]).splitlines()[1] == "warning: 0.20 in is too coarse"
    assert stated.sentence == "cells of 2 mm, on a base of 200 mm"


@pytest.mark.parametrize(
    ("si", "us"),
    [
        ("peak 812 kPa", "peak 118 psi"),
        ("x = \u221248.0, y = \u2212123.0 mm", "x = \u22121.890, y = \u22124.843 in"),
        ("mean over 10 mm, at depth 0, 20 mm", "mean over 0.39 in, at depth 0, 0.79 in"),
        ("criterion 2, 15 mm deep", "criterion 2, 0.59 in deep"),
        ("79 x 107 cells of 3 x 3 mm", "79 x 107 cells of 0.12 x 0.12 in"),
        ("10 to 20 mm, 5\u20137 mm", "0.39 to 0.79 in, 0.20\u20130.28 in"),
        ("between 3 and 5 mm", "between 0.12 and 0.20 in"),
        ("friction 0.3 and 20 kN", "friction 0.3 and 4.5 kip"),
        ("\u03bcP = 0.3 x 20000 N", "\u03bcP = 0.3 x 4496 lbf"),
        ("31\u202f674 mm\u00b2", "49.09 in\u00b2"),
        ("E = 5400 MPa, 1.2 MPa", "E = 783 ksi, 174 psi"),
        ("1.2\u00d710\u2075 Pa", "1.74\u00d710\u00b9 psi"),
        ("\u22125 \u00b0C, +1 \u00b0C, by 1 \u00b0C", "23 \u00b0F, +1.8 \u00b0F, by 1.8 \u00b0F"),
        ("0 mm deep", "0 in deep"),
        ("4 J/m, 3 kN/m\u00b3, 20 m/s, 120 microstrain", "4 J/m, 3 kN/m\u00b3, 20 m/s, 120 microstrain"),
        ("50 kN m/rad, 80 kN", "37 kip ft/rad, 18 kip"),
        ("the 3 months, 2 N-type and 12 Nm", "the 3 months, 2 N-type and 12 Nm"),
    ],
)
def test_numbers_of_a_sentence(si, us):
    assert sentence_in_display_units(si) == si
    with display_units("us"):
        assert sentence_in_display_units(si) == us
        assert sentence_in_display_units(us) == us


def test_the_setting_ends_with_its_block_even_by_an_error():
    with pytest.raises(ZeroDivisionError), display_units("us"):
        raise ZeroDivisionError
    assert row("approach", 1e-3).text == "1.00 mm"


@pytest.mark.parametrize("word", ["imperial", "US", ""])
def test_another_word_is_an_error(word):
    with pytest.raises(InputError, match="si or us"), display_units(word):
        pass
