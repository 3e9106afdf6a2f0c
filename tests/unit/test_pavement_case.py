"""The layers of a case: bonds and a rigid base, read and written."""

import math

import pytest

import treadload as tl
from cases import COARSE_CASE

LAYERS = """
[[pavement.layers]]
name = "wearing course"
thickness = "60 mm"
material = { kind = "elastic", modulus = "7000 MPa", poisson = 0.35 }
bond = { stiffness = "1000 MPa/m" }

[[pavement.layers]]
thickness = "150 mm"
material = { kind = "elastic", modulus = "9000 MPa", poisson = 0.35 }
bond = "frictionless"

[[pavement.layers]]
material = { kind = "elastic", modulus = "120 MPa", poisson = 0.35 }
bond = "bonded"

"""
START = COARSE_CASE.index("[[pavement.layers]]")
LAYERED = COARSE_CASE[:START] + LAYERS + COARSE_CASE[COARSE_CASE.index("[rolling]") :]


def test_layers_with_bonds():
    case = tl.Case.from_text(LAYERED)
    road = case.pavement.build()
    assert [layer.bond for layer in road.layers] == [
        tl.pavement.Bond(1e9),
        tl.pavement.FRICTIONLESS,
        tl.pavement.BONDED,
    ]
    assert [layer.thickness for layer in road.layers] == [0.06, 0.15, None]
    assert math.isinf(road.layers[2].bond.stiffness)
    again = tl.Case.from_text(case.to_toml())
    assert again == case
    assert again.pavement.build() == road


def test_a_rigid_base():
    text = LAYERED.replace("[[pavement.layers]]\nmaterial", '[[pavement.layers]]\nthickness = "3 m"\nmaterial')
    text = text.replace("[rolling]", "[pavement]\nrigid_base = true\n\n[rolling]", 1)
    # TOML wants the table before its arrays.
    head = text.index("[[pavement.layers]]")
    text = text.replace("[pavement]\nrigid_base = true\n", "")
    text = text[:head] + "[pavement]\nrigid_base = true\n\n" + text[head:]
    case = tl.Case.from_text(text)
    assert case.pavement.build().rigid_base
    assert tl.Case.from_text(case.to_toml()) == case


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"frictionless"', '"glued"', r"pavement\.layers\.1\.bond: .*'bonded', 'half-bonded', 'frictionless' or"),
        ('"frictionless"', "-1e9", r"a bond is .* got -1000000000\.0"),
        ('thickness = "60 mm"', 'thickness = "infinite"', "leave its thickness out"),
        ('"1000 MPa/m"', '"-1 MPa/m"', "must be >= 0 Pa/m"),
        ('"1000 MPa/m"', '"1000 MPa"', "Pa/m"),
        (
            "{ stiffness =",
            "{ stifness =",
            r"unknown key 'pavement\.layers\.0\.bond\.stifness'; did you mean 'stiffness'",
        ),
        ('bond = "bonded"', 'bond = "frictionless"', "no layer below it"),
    ],
)
def test_bad_bonds(old, new, message):
    with pytest.raises(tl.InputError, match=message):
        tl.Case.from_text(LAYERED.replace(old, new))
