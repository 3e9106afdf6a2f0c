import pytest

from treadload.errors import InputError
from treadload.units import quantity


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
