"""The modulus from inflation was fitted to one truck tire: other tires that take it by default are told."""

import numpy as np
import pytest

import treadload as tl
from treadload.tire.modulus import modulus_caveat

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
SEDAN = tl.tire.TreadProfile(0.317, 0.8, 0.18, 0.01)
ROBOT = tl.tire.TreadProfile(0.15, 0.3, 0.08, 0.005)


def said(tire, load):
    contact = tl.solve_contact(tire, ROAD, tl.Rolling(normal_load=load, friction=0.5), spacing=4e-3)
    return contact, [text for text in contact.warnings if "one truck tire" in text]


@pytest.mark.parametrize(
    ("profile", "pressure", "load", "words"),
    [
        (SEDAN, 230e3, 4e3, ("1.32 MPa", "0.63 m", "230 kPa")),
        (ROBOT, 150e3, 200, ("0.3 m", "150 kPa")),
        ("315/80R22.5", 300e3, 20e3, ("300 kPa (not 500 to 1000 kPa)",)),
    ],
)
def test_a_tire_that_is_no_truck_tire_is_told(profile, pressure, load, words):
    _, warnings = said(tl.Tire.from_profile(profile, inflation_pressure=pressure), load)
    assert len(warnings) == 1
    for word in (*words, "give its material"):
        assert word in warnings[0]


def test_the_truck_tires_of_the_readme_are_not():
    assert not said(tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3), 32.5e3)[1]
    # The example mesh, 1.009 m at 820 kPa, and 385/65R22.5 at 900 kPa.
    assert modulus_caveat(820e3, 1.009) is None
    assert modulus_caveat(900e3, 1.072) is None


def test_a_belt_has_no_modulus_from_its_inflation():
    tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=300e3, belt=tl.tire.Belt())
    wheel = tl.Rolling(normal_load=20e3, friction=0.0)
    contact = tl.solve_contact(tire, ROAD, wheel, spacing=12e-3)
    assert not [text for text in contact.warnings if "modulus" in text]


def test_a_material_of_its_own_is_nobodys_default():
    tire = tl.Tire.from_profile(SEDAN, inflation_pressure=230e3, material=tl.Elastic(1.5e6, 0.5))
    assert not said(tire, 4e3)[1]


def test_a_height_map_is_known_by_its_curvature():
    x = 4e-3 * (np.arange(40) - 19.5)
    for radius, told in ((0.3, 1), (0.52, 0)):
        gap = x[None, :] ** 2 / (2 * radius) + x[:, None] ** 2 * 2
        tire = tl.Tire.from_height_map(gap, 4e-3, inflation_pressure=820e3)
        assert tire.outer_radius == pytest.approx(radius, rel=1e-6)
        assert len(said(tire, 1e3)[1]) == told
    assert tl.Tire.from_height_map(np.zeros((9, 9)), 4e-3).outer_radius is None


@pytest.mark.usefixtures("figures_as_dots")
def test_summary_and_report_tell_it(tmp_path):
    contact, (warning,) = said(tl.Tire.from_profile(SEDAN, inflation_pressure=230e3), 4e3)
    assert warning[:60] in " ".join(contact.summary().split())
    tl.report([contact], tmp_path / "r.html")
    assert "fitted to one truck tire" in (tmp_path / "r.html").read_text()
