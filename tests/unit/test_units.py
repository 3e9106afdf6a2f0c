import pytest

from treadload import units
from treadload.errors import InputError
from treadload.units import quantity, stress_in_words


@pytest.mark.parametrize(
    ("unit", "written"), [(unit, name) for unit in units._FACTORS for name in units._FACTORS[unit]]
)
def test_usual_units_are_those_of_pint_to_the_last_digit(unit, written, monkeypatch):
    numbers = ["0", "1", "-0.7", "3", "8.2", "32.5", "1e-7", "5400", "0.35", "123.456", "1e12"]
    usual = [quantity(f"{number} {written}", unit) for number in numbers]
    monkeypatch.setattr(units, "_FACTORS", {})
    of_pint = [quantity(f"{number} {written}", unit) for number in numbers]
    # Pint multiplies pound, gravity and 1/inch² after each other: the last of the 15 digits kept differs at a tie.
    assert usual == (pytest.approx(of_pint, rel=1e-14, abs=0) if written == "psi" else of_pint)


def test_degrees_celsius_are_those_of_pint():
    for number in (-40.0, -0.1, 0.0, 15.0, 35.3, 159.95):
        assert units._degrees(number, "degC") == units._degrees(number, "celsius") == number


def test_usual_units_of_another_kind_are_those_of_pint():
    usual = {written for factors in units._FACTORS.values() for written in factors}

    def refused(written, unit):
        try:
            return not units._factor(written, unit)
        except ValueError:
            return True

    wrong = [
        (written, unit)
        for unit in units._FACTORS
        for written in usual - units._FACTORS[unit].keys()
        if units._is_of_another_kind(written, unit) != refused(written, unit)
    ]
    assert not wrong


def test_usual_units_need_no_pint(monkeypatch):
    monkeypatch.setattr(units, "_registry", None)
    assert quantity("3 mm", "m") == 0.003
    assert quantity("20 °C", "degC") == 20.0
    with pytest.raises(InputError, match="'kN' is not a unit of this kind"):
        quantity("20 kN", "m")


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("3 mm", "m", 0.003),
        ("8.2 bar", "Pa", 820e3),
        ("5400 MPa", "Pa", 5.4e9),
        ("32.5 kN", "N", 32.5e3),
        ("120 microstrain", "", 120e-6),
        ("72 km/h", "m/s", 20.0),
        ("180 deg", "rad", 3.14159265358979),
        ("0.05 1/m", "rad/m", 0.05),
        (0.7, "", 0.7),
        (3, "m", 3.0),
    ],
)
def test_quoted_numbers_carry_units_and_bare_ones_are_si(text, unit, value):
    # 15 digits are kept, so that "8.2 bar" is 820000 and not 819999.9999999999.
    assert quantity(text, unit) == pytest.approx(value, rel=1e-14, abs=0)


@pytest.mark.parametrize("text", ["3 bar", "three mm", "", "3 mmm", "nan mm"])
def test_wrong_quantities_say_how_to_write_them(text):
    with pytest.raises(InputError, match=r"mm|finite"):
        quantity(text, "m")


@pytest.mark.parametrize("value", [float("nan"), float("inf"), True, None, [1.0]])
def test_what_is_no_finite_number_is_refused(value):
    with pytest.raises(InputError):
        quantity(value, "N")


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        # A decimal comma and a thousands space, as the French write them: 325000, 0, 0 and 0.65 before.
        ("32,5 kN", "N", 32.5e3),
        ("0,662 MPa", "Pa", 0.662e6),
        ("1 000 kN", "N", 1e6),
        ("6,5 cm", "m", 0.065),
        ("-10,5 °C", "degC", -10.5),
        ("−10 °C", "degC", -10.0),
        ("308 K", "degC", 34.85),
        ("95 °F", "degC", 35.0),
        # Zero is zero in any unit.
        ("0", "rad", 0.0),
        ("7,5 %", "", 0.075),
    ],
)
def test_numbers_are_read_as_they_are_written(text, unit, value):
    assert quantity(text, unit) == pytest.approx(value, rel=1e-14, abs=0)


@pytest.mark.parametrize(
    ("text", "unit", "words"),
    [
        ("1,000 kN", "N", ["may mean 1000 or 1", '"1 000 kN"', '"1.000 kN"']),
        ("1.000,5 kN", "N", ['"1000.5 kN"', '"1.0005 kN"']),
        ("2*3 mm", "m", ["'*3 mm'"]),
        ("3 mm 4", "m", ["'mm 4'"]),
        ("1 00 kN", "N", ["three digits"]),
        ("32.5 KN", "N", ['did you mean "kN"']),
        ("3", "m", ["no unit"]),
        ("30", "rad", ["no unit", '"2 deg"']),
        # Angles are no pure numbers, turns a minute no cycles a second, and 50 °C no difference.
        ("2 deg", "", ["'deg'"]),
        ("600 rpm", "Hz", ["'rpm'"]),
        ("50 degC", "K", ['"50 K"']),
        ("5 delta_degC", "degC", ["35 degC"]),
    ],
)
def test_what_can_be_read_otherwise_is_refused_in_one_sentence(text, unit, words):
    with pytest.raises(InputError) as refused:
        quantity(text, unit)
    assert "\n" not in str(refused.value)
    for word in words:
        assert word in str(refused.value)


def test_an_integer_beyond_floats_is_refused():
    with pytest.raises(InputError, match="finite"):
        quantity(10**400, "m")


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (1.237679e12, "1.24e+03 GPa"),
        (1.237679e9, "1.24 GPa"),
        (0.9999e9, "1 GPa"),
        (45.67e6, "45.7 MPa"),
        (1.2376e6, "1238 kPa"),
        (420.0, "0.42 kPa"),
        (9.96e3, "10 kPa"),
        (1e-6, "0 kPa"),
    ],
)
def test_a_stress_has_the_digits_that_a_reader_needs(value, words):
    assert stress_in_words(value) == words
