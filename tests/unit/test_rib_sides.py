"""The caveat of a surface that is evaluated below a tire whose ribs have no free sides."""

from dataclasses import replace

import numpy as np
import pytest

import treadload as tl
from treadload.damage.rib_sides import EVALUATED, FEWER, SHALLOW, STRAINS, sides_in_words
from treadload.tire.grooves import Groove, LateralGrooves

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
LINE = tl.FatigueLine(epsilon_6=120e-6, slope=-0.2)
GROOVES = (Groove(-0.02, 0.01, 0.015), Groove(0.02, 0.01, 0.015))
NARROW = tl.tire.TreadProfile(0.5, 0.8, 0.12, 0.005, GROOVES)
RUBBER = tl.Elastic(3e6, 0.5)
FEW = {"x": [0.0, 0.01], "y": [0.0, 0.01]}


def caveats(warnings):
    return [text for text in warnings if "free sides" in text]


@pytest.fixture(scope="module")
def contact():
    tire = tl.Tire.from_profile(NARROW, material=RUBBER)
    return tl.solve_contact(tire, ROAD, tl.Rolling(normal_load=6e3, friction=0.5), spacing=8e-3)


def assessed(loads, depths=(0.0,), **how):
    return tl.assess(tl.solve_response(loads, ROAD, depths=list(depths), **FEW), LINE, **how)


def test_sides_of_the_ribs_of_a_tire():
    plain = tl.Tire.from_profile(NARROW, material=RUBBER)
    belt = tl.tire.Belt(tread=tl.Elastic(5.5e6, 0.495))
    ribs = tl.Tire.from_profile(NARROW, inflation_pressure=8e5, belt=belt, tread="ribs")
    lateral = replace(NARROW, lateral=(LateralGrooves(0.07, 0.01, 0.01),))
    across = (np.arange(40) - 19.5) * 3e-3
    smooth = across[None, :] ** 2 + across[:, None] ** 2
    assert plain.rib_sides == replace(ribs, tread="layer").rib_sides == "filled"
    assert ribs.rib_sides == "free"
    assert tl.Tire.from_profile(lateral, material=RUBBER).rib_sides == "unknown"
    assert tl.Tire.from_profile(replace(NARROW, grooves=()), material=RUBBER).rib_sides == "none"
    assert tl.Tire.from_height_map(smooth, 3e-3, material=RUBBER).rib_sides == "none"
    # A wheel of steel with grooves does not bulge.
    assert tl.Tire.from_profile(NARROW, material=tl.Elastic(210e9, 0.3)).rib_sides == "none"


def test_a_surface_below_filled_grooves_has_a_caveat_with_a_range(contact):
    assert contact.dataset.attrs["rib_sides"] == "filled"
    (text,) = caveats(assessed(contact).warnings)
    assert f"{FEWER[0]} to {FEWER[1]} times fewer" in text
    # Of which strain the range is, and that the evaluated one hardly changes.
    assert "no principal stress is tensile" in text
    assert f"at most {EVALUATED} microstrain" in text
    assert 'tread = "ribs"' in text
    # Wheels that are placed, mirrored and averaged are of the same tire.
    assert caveats(assessed(tl.response.dual_wheels(contact, 0.34)).warnings) == [text]
    assert caveats(assessed(contact, depths=(0.06, 0.1), depth=0.06).warnings) == []
    assert caveats(assessed(contact, depths=(0.0, 0.1), depth=0.1).warnings) == []
    assert SHALLOW == 0.02


def test_the_range_is_that_of_the_strains_in_the_sentence():
    low, high = ((free / filled) ** 5 for filled, free in STRAINS)
    # As many digits as cells allow: 12.9 and 660 of rounded strains.
    assert FEWER[0] == pytest.approx(low, rel=0.3)
    assert FEWER[1] == pytest.approx(high, rel=0.1)


def test_loads_that_are_of_no_tire_have_none(contact):
    assert caveats(assessed(tl.UniformDisc(0.1, 8e5)).warnings) == []
    bare = contact.dataset.drop_attrs(deep=False).assign_attrs(dx=8e-3, dy=8e-3)
    assert caveats(assessed(tl.response.GridLoad.from_dataset(bare)).warnings) == []


def test_one_sentence_for_several_tires():
    assert sides_in_words(["free", "none", ""]) == []
    assert "has them filled" in sides_in_words(["free", "filled", "unknown"])[0]
    (text,) = sides_in_words(["unknown", "unknown"])
    assert "not known" in text


def test_an_opened_file_keeps_the_caveat(contact, tmp_path):
    response = tl.solve_response(contact, ROAD, depths=[0.0], **FEW)
    tl.save_results([contact, response], tmp_path / "both.nc")
    opened = tl.open_results(tmp_path / "both.nc")
    assert opened.contact.dataset.attrs["rib_sides"] == "filled"
    assert len(caveats(tl.assess(opened.response, LINE).warnings)) == 1


LIFE = """
spacing = "20 mm"
tire = { profile = "315/80R22.5" }
pavement = { structure = "6 BBSG3 / 15 GB3 / PF3" }
climate = { temperature = 15 }
[traffic]
passes_per_year = 1e5
[[traffic.classes]]
name = "axle"
share = 1
axle_load = "100 kN"
inflation_pressure = "8 bar"
[[criteria]]
name = "base"
law = "french-bituminous"
layer = "EB-GB3"
risk = 0.05
"""
TOP = """
[[criteria]]
name = "top"
law = "fatigue-line"
layer = "EB-BBSG3"
place = "top"
"""


@pytest.mark.parametrize(("text", "number"), [(LIFE, 0), (LIFE + TOP, 1)])
def test_a_life_says_so_where_it_evaluates_the_surface(text, number):
    life = tl.run(tl.Case.from_text(text), leave_out=("sensitivity",)).life
    assert len(caveats(life.warnings)) == number
