"""A viscoelastic tire in a case file: read, written back, run, and refused with the reason."""

import pytest

from cases import COARSE_CASE
from treadload.case import Case
from treadload.errors import InputError
from treadload.materials import Prony
from treadload.steps import run

RUBBER = 'material = { kind = "prony", modulus = "10 MPa", terms = [[0.3, "1 ms"], [0.4, "20 ms"]], poisson = 0.49 }'


def text(rubber=RUBBER, speed='speed = "50 km/h"'):
    return COARSE_CASE.replace('inflation_pressure = "8.2 bar"', rubber).replace("[rolling]", f"[rolling]\n{speed}")


def test_read_and_written_back():
    case = Case.from_text(text())
    expected = Prony(10e6, ((0.3, 1e-3), (0.4, 0.02)), 0.49)
    assert case.tire.material.build() == expected
    assert Case.from_text(case.to_toml()).tire.material.build() == expected


def test_run():
    contact = run(Case.from_text(text())).contact
    assert float(contact.dataset.pressure_centre_x) > 1e-3
    assert contact.dataset.rolling_resistance_moment.attrs["units"] == "N m"


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("0.4,", "0.8,", "more than 1"),
        ("0.4,", "0.7,", "Maxwell"),
        ("terms", "term", "did you mean 'terms'"),
        ('"20 ms"', '"20 mm"', r"tire\.material\.terms\.1\.1: cannot read '20 mm'"),
        (
            '"prony"',
            '"steel"',
            r"tire\.material: no material of the kind 'steel'; known are (?=.*elastic)(?=.*prony)(?=.*orthotropic)",
        ),
        ('"10 MPa"', '"-1 MPa"', "modulus must be a positive number"),
    ],
)
def test_refused(old, new, words):
    with pytest.raises(InputError, match=words):
        Case.from_text(text(RUBBER.replace(old, new)))


def test_speed_is_needed():
    with pytest.raises(InputError, match="give the rolling speed"):
        Case.from_text(text(speed=""))


def test_a_viscoelastic_road_needs_a_speed():
    asphalt = 'kind = "prony", terms = [[0.9, "10 ms"]]'
    with pytest.raises(InputError, match=r"give the speed in \[rolling\] or \[response\]"):
        Case.from_text(COARSE_CASE.replace('kind = "elastic"', asphalt))
    case = Case.from_text(COARSE_CASE.replace('kind = "elastic"', asphalt).replace("depths", "speed = 20\ndepths"))
    assert case.pavement.build().layers[0].material == Prony(5.4e9, ((0.9, 0.01),), 0.35)
    assert case.speed == 20
