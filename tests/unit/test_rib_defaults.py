"""Cases that the package hands out roll on free ribs; a case that names no tread has none."""

import tomllib
from importlib import resources

import pytest

import treadload as tl
from treadload.templates import first_case
from treadload.tire.belt import InflatedBelt


def tires_in(text):
    """Tables `tire` of a case, of the wheel and of classes of traffic, and values of keys that end so."""
    found = []

    def walk(table):
        for key, value in table.items():
            if key == "tire" or key.endswith(".tire"):
                found.append(value)
            if isinstance(value, dict):
                walk(value)
            for item in value if isinstance(value, list) else ():
                if isinstance(item, dict):
                    walk(item)

    walk(tomllib.loads(text))
    return found


@pytest.mark.parametrize("kind", ["run", "life"])
def test_a_first_case_rolls_on_ribs(kind):
    tires = tires_in(first_case(kind))
    assert tires
    assert {tire.get("tread") for tire in tires} == {"ribs"}


@pytest.mark.parametrize("place", ["demo/free.toml", "demo/tractive.toml", "app/starts.toml"])
def test_the_demo_and_the_page_start_on_ribs(place):
    text = resources.files("treadload").joinpath(place).read_text(encoding="utf-8")
    profiles = [tire for tire in tires_in(text) if "profile" in tire or "scan" in tire]
    assert profiles
    assert {tire.get("tread") for tire in profiles} == {"ribs"}


def test_a_case_that_names_no_belt_and_no_tread_has_no_ribs():
    case = tl.Case.from_text(
        '[tire]\nprofile = "315/80R22.5"\ninflation_pressure = "8.2 bar"\n[[pavement.layers]]\n'
        'material = { kind = "elastic", modulus = "5400 MPa", poisson = 0.35 }\n'
        '[rolling]\nnormal_load = "35 kN"\nfriction = 0.7\n'
    )
    assert case.build_tire().ribs == ()
    # A half-space, as it was before treads stood on belts.
    assert not isinstance(case.build_tire().carcass, InflatedBelt)
