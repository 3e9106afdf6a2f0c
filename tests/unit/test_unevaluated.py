"""What an assessment does not evaluate is stated with its number, its place and what to add."""

import pytest

import treadload as tl
from treadload.damage.unevaluated import bottoms_without_depth
from treadload.response import UniformRectangle, solve_response

LINE = tl.FatigueLine(epsilon_6=120e-6, slope=-0.2)
# The road of `treadload init`.
ROAD = tl.Pavement(
    [
        tl.Layer(tl.Elastic(5.4e9, 0.35), 0.06, name="wearing course"),
        tl.Layer(tl.Elastic(9e9, 0.35), 0.2, name="base"),
        tl.Layer(tl.Elastic(80e6, 0.35), name="soil"),
    ]
)
AT = {"x": [k * 0.01 for k in range(-16, 17)], "y": [k * 0.01 for k in range(-16, 17)]}


def response(depths, road=ROAD):
    load = UniformRectangle(0.2, 0.2, 8e5)
    return solve_response(load, road, depths=depths, **AT)


def test_the_bottom_of_a_base_without_a_depth_is_named_with_its_strain():
    (said,) = bottoms_without_depth(response([0.0, 0.06]))
    largest = float(response([0.26]).dataset["in_plane_strain_1"].max()) * 1e6
    assert "the bottom of base at 260 mm" in said
    # In two digits, on points four times as far apart as those of the map.
    assert float(said.split("about ")[1].split()[0]) == pytest.approx(largest, rel=0.05)
    assert 'add "260 mm" to depths' in said
    assert bottoms_without_depth(response([0.0, 0.06, 0.26])) == []


def test_bottoms_that_are_pressed_are_not_named():
    """The wearing course lies on a stiffer base: its bottom at 60 mm is in compression."""
    assert all("60 mm" not in one.replace("260 mm", "") for one in bottoms_without_depth(response([0.0])))


def test_the_assessment_states_what_the_bright_spots_of_the_map_are():
    solved = response([0.0, 0.06])
    verdict = tl.assess(solved, LINE)
    most = float(solved.dataset["principal_strain_1"].max()) * 1e6
    (spot,) = [one for one in verdict.warnings if "principal strain of the map" in one]
    assert f"{most:.3g} microstrain at x = " in spot
    assert "no principal stress is tensile there" in spot
    assert "260 mm" in verdict.summary()
    # No crack opens in the map; 6.1 microstrain open one beyond it, where the surface hogs.
    assert (verdict.dataset["crack_orientation"] == 0).all()
    assert float(verdict.dataset["worst_strain"]) == pytest.approx(6.1e-6, rel=0.02)
    assert any("no crack opens in the map" in text for text in verdict.warnings)


def test_a_map_that_is_evaluated_as_it_is_has_no_bright_spot():
    """Far below the load on one material: the point that is read is the largest of the map."""
    half_space = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    solved = response([0.4], half_space)
    verdict = tl.assess(solved, LINE, depth=0.4, strain="principal")
    if float(verdict.dataset["worst_strain"]) > 0:
        assert not [one for one in verdict.warnings if "of the map" in one]
    assert bottoms_without_depth(solved) == []
