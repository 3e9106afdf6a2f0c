"""Numbers that no tire, no road and no traffic has are said, with the unit that was likely meant."""

import json
import math
import re

import pytest

import treadload as tl
from cases import COARSE_CASE
from treadload.life.caveats import traffic_caveats
from treadload.plausible import RANGES, caveat, load_caveat
from treadload.steps import run

TRUCK = tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
ASPHALT = tl.Elastic(5.4e9, 0.35)
SOIL = tl.Layer(tl.Elastic(100e6, 0.35), name="soil")
DISC = tl.UniformDisc(0.125, 0.662e6)


@pytest.mark.parametrize("kind", RANGES)
def test_every_range_has_a_reason_and_holds_what_is_usual(kind):
    row = RANGES[kind]
    assert row.reason
    assert row.low <= row.usual[0] < row.usual[1] <= row.high
    for value in (*row.usual, math.nan, math.inf):
        assert caveat(kind, value) == ()
    # Beyond, not at, the bounds.
    assert caveat(kind, row.low) == ()
    assert caveat(kind, row.low - 1e-9 * max(abs(row.low), 1))
    if math.isfinite(row.high):
        assert caveat(kind, row.high) == ()
        assert caveat(kind, row.high * 1.001)


@pytest.mark.parametrize(
    ("kind", "value", "meant"),
    [
        ("speed", 90.0, '"90 km/h"'),
        ("thickness of the surface course", 6.0, '"6 cm"'),
        ("thickness of the surface course", 60.0, '"60 mm"'),
        ("thickness of the unbound layer", 25.0, '"25 cm"'),
        ("modulus of the layer", 5400.0, '"5400 MPa"'),
        ("inflation pressure", 8.2, '"8.2 bar"'),
        ("inflation pressure", 820.0, '"820 kPa"'),
        # 5400 GPa for 5400 MPa.
        ("modulus of the layer", 5400e9, '"5.4e+09 Pa"'),
        ("friction", 70.0, '"70 %"'),
        ("annual growth", 2.0, '"2 %"'),
        ("size of the cells", 3.0, '"3 mm"'),
        ("stiffness of the bond", 1000.0, '"1000 MPa/m"'),
    ],
)
def test_the_unit_that_was_likely_meant_is_named(kind, value, meant):
    (text,) = caveat(kind, value)
    assert meant in text
    assert f"{value:g}" in text


def test_a_load_is_judged_by_the_width_of_its_tire():
    # 32.5 N on a truck tire, and the same on the wheel of a robot; an aircraft's, and the same on a bicycle's.
    (text,) = load_caveat(32.5, 0.292)
    assert 'carries 2 to 88 kN: did you mean "32.5 kN"?' in text
    assert load_caveat(32.5, 0.03) == ()
    assert load_caveat(200e3, 0.43) == ()
    assert load_caveat(500e3, 0.025)


def test_a_contact_says_what_no_tire_does():
    wheel = tl.Rolling(normal_load=32.5, friction=70.0, speed=500.0)
    contact = tl.solve_contact(TRUCK, tl.Pavement.half_space(ASPHALT), wheel, spacing=4e-3)
    said = " ".join(contact.warnings)
    for word in ("wheel load is 32.5 N", '"32.5 kN"', "friction is 70;", '"70 %"', "500 m/s, 1800 km/h"):
        assert word in said
        assert word in contact.summary()
    usual = tl.Rolling(normal_load=32.5e3, friction=0.7, speed=20.0)
    assert not tl.solve_contact(TRUCK, tl.Pavement.half_space(ASPHALT), usual, spacing=12e-3).warnings


def test_a_response_says_what_no_road_is():
    course = tl.Layer(ASPHALT, 6.0, name="wearing course")
    told = tl.solve_response(DISC, tl.Pavement([course, SOIL]), depths=[0.0], x=[0.0], y=[0.0])
    assert (
        'thickness of the surface course is 6 m; surface courses usually measure 1 to 40 cm: did you mean "6 cm"?'
        in (told.summary())
    )
    soft = tl.Pavement([tl.Layer(tl.Elastic(5400.0, 0.35), 0.06, name="top", bond=tl.pavement.Bond(1000.0)), SOIL])
    said = " ".join(tl.solve_response(DISC, soft, depths=[0.0], x=[0.0], y=[0.0]).warnings)
    assert "modulus of layer 1 (top) is 5400 Pa" in said
    assert "stiffness of the bond below layer 1 (top) is 1000 Pa/m" in said
    usual = tl.Pavement([tl.Layer(ASPHALT, 0.06), SOIL])
    assert not tl.solve_response(DISC, usual, depths=[0.0, 1.0], x=[0.0], y=[0.0]).warnings


def test_wheels_that_reach_into_each_other_are_told():
    road, at = tl.Pavement.half_space(ASPHALT), {"depths": [0.05], "x": [0.0], "y": [0.0]}
    near = tl.solve_response(tl.response.dual_wheels(DISC, 0.2), road, **at)
    assert "wheels 1 and 2 overlap by 250 mm along travel and 50 mm across" in near.warnings[0]
    assert "0 and 200 mm apart" in near.warnings[0]
    # The French axle; and two parts of one load, which may lie on each other.
    assert not tl.solve_response(tl.response.axle(DISC, 1.8, 0.375), road, **at).warnings
    assert not tl.solve_response([DISC, DISC], road, **at).warnings
    # Footprints, of which empty cells count for nothing.
    grid = tl.response.Grid.centred(0.4, 0.4, 0.01)
    pressed = (abs(grid.x)[None, :] < 0.1) & (abs(grid.y)[:, None] < 0.1)
    foot = tl.response.GridLoad(grid, 7e5 * pressed)
    assert not tl.solve_response(tl.response.dual_wheels(foot, 0.22), road, **at).warnings
    told = tl.solve_response([foot, foot.moved(x=1.0), foot.moved(x=1.0, y=0.1)], road, **at).warnings
    assert "wheels 2 and 3 overlap by 200 mm along travel and 100 mm across" in told[0]


def test_a_case_carries_the_sentences_to_its_file():
    case = tl.Case.from_text(COARSE_CASE.replace("friction       = 0.7", "friction = 0.7\nspeed = 90"))
    tree = run(case).to_tree()
    said = [text for group in tree.children.values() for text in json.loads(group.attrs.get("warnings", "[]"))]
    assert any('did you mean "90 km/h"?' in text for text in said)


def test_a_life_says_what_no_traffic_is():
    row = tl.damage.AxleClass("front", 1.0, 35.0, 8e5, wheels=((0.0, 0.0), (0.0, 0.1)))
    traffic = tl.damage.Traffic((row,), 1e12, growth=2.0, years=2)
    road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")
    criterion = tl.damage.Criterion("base", tl.FatigueLine(90e-6, -0.2), 1, "bottom")
    life = tl.solve_life(tl.Design(TRUCK, road, traffic, tl.damage.Climate.constant(15.0), [criterion], spacing=4e-3))
    said = "\n".join(life.warnings)
    for word in (
        "number of passes per year is 1e+12",
        'annual growth is 2; traffic usually grows by -5 to 10 %: did you mean "2 %"?',
        "wheel load of front is 35 N",
        '"35 kN"',
    ):
        assert word in said
        assert word in life.summary()
    heavy = tl.damage.AxleClass("front", 1.0, 35e3, 8e5, wheels=((0.0, 0.0), (0.0, 0.1)))
    usual = tl.damage.Traffic((heavy,), 1e5, growth=0.02, years=20)
    life = tl.solve_life(tl.Design(TRUCK, road, usual, tl.damage.Climate.constant(15.0), [criterion], spacing=12e-3))
    (text,) = [text for text in life.warnings if "overlap by" in text]
    assert text.startswith("front: the footprints of wheels 1 and 2")


def test_a_class_is_judged_by_its_own_tire():
    narrow = tl.Tire.from_profile(tl.tire.TreadProfile(0.1, 0.03, 0.03))
    rows = [
        tl.damage.AxleClass("robot", 0.5, 20.0, 5e4, tire=narrow),
        tl.damage.AxleClass("truck", 0.5, 20.0, 8e5),
    ]
    said = traffic_caveats(TRUCK, tl.damage.Traffic(tuple(rows), 1e5), tl.damage.Climate.constant(15.0))
    assert len(said) == 1
    assert "wheel load of truck is 20 N" in said[0]


@pytest.mark.parametrize(
    ("load", "belt", "words"),
    [
        (10e3, None, r"is 0\.\d+ times the inflation pressure.*too large.*give a belt"),
        (32.5e3, None, ""),
        (32.5e3, "315/80R22.5", ""),
        (60e3, "315/80R22.5", r"is 1\.\d+ times the inflation pressure.*too small.*look at the load"),
    ],
)
def test_a_mean_pressure_that_no_inflated_tire_has_is_named(load, belt, words):
    """On cells of 12 mm the area is right within a few per cent; the bounds are wider."""
    pressure = 820e3 if load < 50e3 else 560e3
    made = None if belt is None else tl.tire.Belt.from_library(belt)
    tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=pressure, belt=made)
    road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    contact = tl.solve_contact(tire, road, tl.Rolling(normal_load=load, friction=0.7), spacing=12e-3)
    told = [text for text in contact.warnings if "times the inflation pressure" in text]
    assert len(told) == bool(words)
    assert not words or re.search(words, told[0])
