"""Odd values of a case that once came through as raw exceptions, or kept the program busy for ever."""

import pytest

import treadload as tl
from cases import COARSE_CASE
from treadload.case import Case
from treadload.errors import TreadloadError
from treadload.tire import LateralGrooves, TreadProfile
from treadload.units import quantity

TREAD = "profile = { rolling_radius = 0.5, crown_radius = 1.0, width = 0.2 }"


def changed(old, new):
    assert old in COARSE_CASE
    return COARSE_CASE.replace(old, new)


def refusal(text):
    with pytest.raises(tl.InputError) as caught:
        Case.from_text(text, name="my.toml")
    said = str(caught.value)
    assert len(said.splitlines()) == 1
    return said


@pytest.mark.parametrize("law", ['["coulomb"]', '{ a = "coulomb" }', "1", "true"])
def test_a_law_of_friction_is_named_by_a_word(law):
    assert "rolling.friction: no law" in refusal(changed("= 0.7", f"= {{ law = {law}, coefficient = 0.7 }}"))


@pytest.mark.parametrize(
    ("tread", "words"),
    [
        (
            ', lateral = [{ pitch = 0.05, width = 0.01, depth = 0.01, y_range = ["-5 mm", {}] }]',
            "tire.profile.lateral.0.y_range.1: expected",
        ),
        (
            ", lateral = [{ pitch = 0.05, width = 0.01, depth = 0.01, y_range = 0.1 }]",
            "tire.profile.lateral.0.y_range: must be a list, got 0.1",
        ),
        (
            ', grooves = [{ centre = 0, width = "10 kg", depth = 0.01 }]',
            "tire.profile.grooves.0.width: cannot read '10 kg'",
        ),
        (", grooves = 0.3", "tire.profile.grooves: must be a list, got 0.3"),
        (", grooves = [0.3]", "tire.profile.grooves.0: must be a table of keys and values, got 0.3"),
        (", name = 3", "tire.profile.name: must be text, got 3"),
    ],
)
def test_a_tread_of_a_case_is_checked_where_it_is_read(tread, words):
    text = changed('profile = "315/80R22.5"', TREAD.replace(" }", f"{tread} }}"))
    assert words in refusal(text)


def test_numbers_of_a_tread_carry_their_unit():
    lugs = '{ pitch = "5 cm", width = "1 cm", depth = 0.01, angle = "10 deg", y_range = ["-50 mm", 0.05] }'
    text = changed('profile = "315/80R22.5"', TREAD.replace(" }", f", lateral = [{lugs}] }}"))
    case = Case.from_text(text)
    expected = LateralGrooves(0.05, 0.01, 0.01, angle=quantity("10 deg", "rad"), y_range=(-0.05, 0.05))
    assert case.build_tire().surface.profile.lateral == (expected,)
    assert Case.from_text(case.to_toml()) == case


def test_a_range_from_python_is_two_numbers():
    with pytest.raises(tl.InputError, match="y_range must be"):
        LateralGrooves(0.05, 0.01, 0.01, y_range=("a", {}))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("title = " + "9" * 5000, "a whole number of more than 4300 digits"),
        ("a = " + "[" * 3000 + "]" * 3000, "too deep in each other"),
        (".".join("a" * 1000) + " = 1", "too deep in each other"),
        ("title = 'a", "not valid TOML"),
    ],
)
def test_texts_that_the_reader_of_toml_cannot_take(text, words, tmp_path):
    assert words in refusal(text)
    (tmp_path / "tread.toml").write_text(text)
    with pytest.raises(tl.InputError, match=words):
        TreadProfile.from_toml(tmp_path / "tread.toml")


@pytest.mark.parametrize("name", ["a" * 5000 + ".csv", "a\0b.csv"])
def test_a_name_that_no_file_can_have_is_no_file(name):
    with pytest.raises(tl.InputError, match="no file"):
        tl.Tire.from_height_map(name, 5e-3)
    with pytest.raises(tl.InputError, match="no scan file"):
        tl.Tire.from_scan(name)


def test_the_folder_is_no_key():
    assert "unknown key 'folder'" in refusal('folder = "/"\n' + COARSE_CASE)


def test_a_case_is_a_table():
    with pytest.raises(tl.InputError, match="a table of keys and values"):
        Case.from_dict([1, 2])


def test_keys_are_text():
    with pytest.raises(tl.InputError, match="keys must be text, got 1; write it in quotes"):
        Case.from_dict({1: 2})
    with pytest.raises(tl.InputError, match="unknown key 'self'"):
        Case.from_dict({"self": 3})


def test_a_power_of_a_power_is_no_unit():
    # Python would be asked for 9^387420489.
    with pytest.raises(tl.InputError, match="not a unit of this kind"):
        quantity("5 m**9**9**9", "m")
    assert quantity("3 m**2/m", "m") == 3


def test_many_errors_are_told_as_few():
    said = refusal(changed("= 0.7", "= 0.7\n" + "\n".join(f"k{n} = 1" for n in range(50))))
    assert said.endswith("and 46 more")


def test_an_error_is_one_line_of_bounded_length():
    said = str(TreadloadError("first\n  second\r\nthird \x1b[31m" + "9" * 5000))
    assert len(said.splitlines()) == 1
    assert len(said) < 200
    assert "\x1b" not in said
    assert said.startswith("first   second third")
    assert len(str(TreadloadError("one two " * 1000))) < 1300
