"""A dry run tells what a run then solves."""

import re

import pytest

import treadload as tl
from cases import COARSE_CASE
from treadload.steps import plan, run

LAYERS = """
[[pavement.layers]]
name = "asphalt"
thickness = "6 cm"
material = { modulus = "7 GPa", poisson = 0.35 }
[[pavement.layers]]
name = "soil"
material = { modulus = "100 MPa", poisson = 0.35 }
"""


def on_layers():
    start, end = COARSE_CASE.index("[[pavement.layers]]"), COARSE_CASE.index("[rolling]")
    return (
        COARSE_CASE[:start].replace("12 mm", "24 mm")
        + LAYERS
        + COARSE_CASE[end:].replace("[response]", "[response]\nwheels = [{}, { y = 0.4 }]")
    )


@pytest.mark.parametrize(("toml", "side"), [(COARSE_CASE, 12), (on_layers(), 24)], ids=["half-space", "layers"])
def test_the_plan_is_what_is_solved(toml, side):
    case = tl.Case.from_text(toml)
    text = plan(case)
    result = run(case)
    contact, response = result.contact.dataset.sizes, result.response.dataset.sizes
    assert f"contact   {contact['x']} x {contact['y']} cells of {side} x {side} mm" in text
    assert f"response  {response['x']} x {response['y']} points at 2 depth(s), 0, 20 mm" in text
    along, across = result.slice_along.dataset.sizes, result.slice_across.dataset.sizes
    assert f"slices    {along['x']} and {across['y']} points at {along['depth']} depths" in text
    assert re.search(r"estimate  about [\d.e+]+ (s|min) on this machine", text)
    assert ("under 2 wheels" in text) == ("wheels" in toml)
    for layer in result.road.layers:
        assert layer.name in text


def test_a_plan_finds_what_a_run_would_refuse():
    with pytest.raises(tl.InputError, match="gross sliding"):
        plan(tl.Case.from_text(COARSE_CASE, changes=["rolling.tractive_force=30 kN"]))
    with pytest.raises(tl.InputError, match="fewer than 8 cells"):
        plan(tl.Case.from_text(COARSE_CASE, changes=["spacing=200 mm"]))


def test_a_plan_tells_numbers_that_no_tire_has():
    text = plan(tl.Case.from_text(COARSE_CASE, changes=["rolling.speed=90", "tire.inflation_pressure=20 kPa"]))
    assert (
        'warning: the speed is 90 m/s, 324 km/h; vehicles usually roll at 1.1 to 137 km/h: did you mean "90 km/h"?'
        in (text)
    )
    assert "warning: the inflation pressure is 20000 Pa" in text
    assert "warning" not in plan(tl.Case.from_text(COARSE_CASE))


def test_the_plan_of_a_design_counts_its_solves():
    design = """
spacing = "12 mm"
tire = { profile = "315/80R22.5" }
pavement = { structure = "6 BBSG3 / 15 GB3 / PF3" }
climate = { months = [4, 5, 9, 12, 17, 22, 25, 24, 19, 14, 8, 5] }
traffic = { passes_per_year = 1e5, years = 20, classes = [
    { name = "front", share = 0.5, axle_load = "70 kN", inflation_pressure = "8 bar" },
    { name = "rear", share = 0.5, axle_load = "70 kN", inflation_pressure = "8 bar", gear = "tandem" } ] }
criteria = [{ name = "base", law = "french-bituminous", layer = "EB-GB3", risk = 0.05 }]
"""
    text = plan(tl.Case.from_text(design))
    # Both classes press alike; May and December are as warm as February and January are not: 5 °C twice.
    assert "contacts  1 on cells of 12 mm" in text
    assert "climate   12 season(s), 11 of them different" in text
    assert "responses 22 at most" in text
    assert "front 50 %, rear 50 %" in text
    assert "criterion base: " in text
