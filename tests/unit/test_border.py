"""A largest value on the border of a map is solved further; where it cannot be, or still ends there, it is named."""

from dataclasses import replace

import numpy as np
import pytest

from treadload import assess
from treadload.damage import FatigueLine
from treadload.damage.border import beyond_the_map
from treadload.grid import Grid
from treadload.materials import Elastic
from treadload.pavement import Layer, Pavement
from treadload.response import GridLoad, UniformDisc, solve_response

ROAD = Pavement([Layer(Elastic(5e9, 0.35), 0.15), Layer(Elastic(120e6, 0.35))])
DISC = UniformDisc(0.12, 0.7e6)
LINE = FatigueLine(100e-6, -0.2)


def of_a_map(reach, road=ROAD, disc=DISC, count=25):
    x = np.linspace(-reach, reach, count)
    return solve_response(disc, road, depths=[0.0], x=x, y=x)


def texts_of(verdict):
    return [text for text in verdict.warnings if "lies at its end" in text or "opens in the map" in text]


@pytest.fixture(scope="module")
def whole():
    return assess(of_a_map(1.8, count=61), LINE)


def test_a_map_that_ends_before_the_largest_strain_is_solved_further(whole):
    verdict = assess(of_a_map(0.35), LINE)
    data = verdict.dataset
    # 20.4 microstrain in the corner of the map, 21.2 on a ring 0.57 m around the disc.
    assert float(data["worst_strain"]) == pytest.approx(float(whole.dataset["worst_strain"]), rel=1e-3)
    assert float(data["worst_strain"]) > 1.03 * float(data["extension_strain"].max())
    assert float(np.hypot(data["worst_x"], data["worst_y"])) == pytest.approx(0.569, abs=5e-3)
    assert float(data["extension_by_depth"][0]) == pytest.approx(float(data["worst_strain"]), rel=1e-4)
    (text,) = texts_of(verdict)
    assert "350 mm" in text
    # 1.5 m around the disc, of which the map holds 0.35 - 0.12 m.
    assert "1.3 m beyond the map" in text
    assert texts_of(whole) == []


def test_points_at_a_depth_are_solved_further_too():
    near, far = (assess(of_a_map(reach, count=count), LINE, depth=0.0) for reach, count in ((0.35, 25), (1.8, 121)))
    assert float(near.dataset["worst_strain"]) == pytest.approx(float(far.dataset["worst_strain"]), rel=1e-4)
    assert np.hypot(near.dataset["worst_x"], near.dataset["worst_y"]) > 0.5


def test_a_map_in_which_no_crack_opens_is_solved_further(whole):
    # The surface is pressed together everywhere on 0.25 m around the disc.
    response = of_a_map(0.25, count=31)
    local = assess(response, LINE, depth=0.0)
    assert float(local.dataset["extension_strain"].max()) > 0
    assert (local.dataset["crack_orientation"] == 0).all()
    (text,) = texts_of(local)
    assert "no crack opens in the map" in text
    assert local.orientation != "none"
    assert float(assess(response, LINE).dataset["worst_strain"]) == pytest.approx(
        float(whole.dataset["worst_strain"]), rel=1e-3
    )


def test_under_a_tire_the_basin_beyond_is_that_of_the_whole_field():
    grid = Grid(20, 18, 0.012, 0.012, -0.114, -0.102)
    tread = GridLoad(grid, np.full(grid.shape, 0.8e6), np.full(grid.shape, 0.1e6), np.zeros(grid.shape))
    x = np.linspace(-0.21, 0.21, 36)
    verdict = assess(solve_response(tread, ROAD, depths=[0.0, 0.02], x=x, y=x), LINE)
    wide = assess(solve_response(tread, ROAD, depths=[0.0], x=np.linspace(-1.2, 1.2, 81), y=x[::5]), LINE)
    data = verdict.dataset
    assert float(data["worst_strain"]) == pytest.approx(float(wide.dataset["worst_strain"]), rel=2e-3)
    assert abs(float(data["worst_x"])) > 0.4
    assert len(texts_of(verdict)) == 1


def test_a_spot_inside_the_map_does_not_hide_a_larger_basin():
    grid = Grid(20, 18, 0.012, 0.012, -0.114, -0.102)
    driven = GridLoad(grid, np.full(grid.shape, 0.8e6), np.full(grid.shape, -0.3e6), np.zeros(grid.shape))
    x, at = np.arange(-0.15, 0.151, 0.012), np.linspace(-1.5, 1.5, 101)
    verdict, wide = (
        assess(solve_response(driven, ROAD, depths=[0.0], x=places, y=places), LINE) for places in (x, at)
    )
    data = verdict.dataset
    strain = data["extension_strain"].where(data["crack_orientation"] != 0).fillna(0.0).to_numpy()
    row, column = np.unravel_index(int(strain.argmax()), strain.shape)
    # 15.8 microstrain at a place inside the map where a crack opens: nothing at its end asks for more.
    assert 0 < row < len(x) - 1
    assert 0 < column < len(x) - 1
    assert 0 < strain.max() < 16e-6
    # The basin beyond hogs by 39.6.
    assert float(data["worst_strain"]) == pytest.approx(float(wide.dataset["worst_strain"]), rel=1e-3)
    assert float(data["worst_strain"]) > 39e-6
    assert float(data["extension_by_depth"].max()) == pytest.approx(float(data["worst_strain"]), rel=5e-3)
    (text,) = [text for text in verdict.warnings if "smaller than one beyond it" in text]
    place = f"x = {1e3 * float(data['worst_x']):.0f} mm"
    assert place in text
    for figure in (verdict.plot.cracks(), verdict.plot.passes()):
        (words,) = [text.get_text() for text in figure.axes[0].texts if "first beyond the map" in text.get_text()]
        assert place in words


def test_on_one_material_the_field_beyond_is_evaluated_too():
    """40 mm deep a driven tread leaves a tensile spot of 2.6 microstrain on the map; 0.24 m ahead of it are 7.3."""
    road, grid = Pavement.half_space(Elastic(5e9, 0.2)), Grid(20, 18, 0.012, 0.012, -0.114, -0.102)
    shape = np.maximum(1 - (grid.x / 0.12) ** 4, 0) * np.maximum(1 - (grid.y[:, None] / 0.108) ** 4, 0)
    load = GridLoad(grid, 0.8e6 * shape, np.full(grid.shape, -0.1e6), np.zeros(grid.shape))
    x, at = np.linspace(-0.13, 0.13, 23), np.linspace(-0.6, 0.6, 101)
    verdict, wide = (
        assess(solve_response(load, road, depths=[0.04], x=places, y=places), LINE, depth=0.04) for places in (x, at)
    )
    strain = verdict.dataset["extension_strain"].where(verdict.dataset["crack_orientation"] != 0).fillna(0.0)
    assert float(strain.max()) < 3e-6
    assert float(strain[1:-1, 1:-1].max()) == float(strain.max()) > 0
    assert float(verdict.dataset["worst_strain"]) == pytest.approx(float(wide.dataset["worst_strain"]), rel=5e-3)
    assert float(verdict.dataset["worst_strain"]) > 7e-6
    assert 0.2 < abs(float(verdict.dataset["worst_x"])) < 0.3


def test_the_figures_state_a_first_crack_beyond_the_map():
    verdict = assess(of_a_map(0.25, count=31), LINE, depth=0.0)
    for figure in (verdict.plot.cracks(), verdict.plot.passes()):
        assert any("23 microstrain beyond the map" in text.get_text() for text in figure.axes[0].texts)


def test_a_largest_value_that_ends_with_the_basin_is_named_with_the_enlargements():
    x = np.linspace(0.0, 1.0, 11)
    rising = beyond_the_map(x[None, None] + 0 * x[:, None], x, x, lambda x, y: x[None, None] + 0 * y[:, None], 1.5)
    assert rising.at_end
    # The largest y of equal values counts, so that both axes are enlarged: 0.3, 0.9 and 1.5 m.
    assert (rising.enlargements, rising.reach, rising.x) == (3, 1.5, 2.5)


def test_a_basin_wider_than_it_is_followed_is_named():
    # Incompressible, so that nothing is tensile beside the disc: the slab hogs from about its radius of 7.8 m on.
    stiff = Pavement([Layer(Elastic(40e9, 0.5), 0.8), Layer(Elastic(8e6, 0.5))])
    (text,) = texts_of(assess(of_a_map(0.3, stiff), LINE, depth=0.0))
    assert "no crack opens in the map" in text
    assert "still lies at the end" in text
    assert "followed to 10 m" in text


def test_a_maximum_at_the_end_of_a_map_needs_no_words():
    x = np.linspace(-1.0, 0.0, 21)

    def hill(x, y):
        return np.exp(-(x[None, None] ** 2) - (y[:, None] + 0.5) ** 2)

    beyond = beyond_the_map(hill(x, x), x, x, hill, 1.5)
    assert not beyond.at_end
    assert beyond.value == pytest.approx(1.0, rel=1e-5)
    assert beyond.x == pytest.approx(0.0, abs=2e-3)


def test_a_response_that_cannot_be_solved_again_is_named():
    response = replace(of_a_map(0.35), loads=())
    (text,) = texts_of(assess(response, LINE, depth=0.0))
    assert "1.5 m for the whole basin" in text
    assert "cannot be solved again" in text


def test_a_line_of_places_has_no_border():
    response = solve_response(DISC, ROAD, depths=[0.0], x=np.linspace(-1.8, 1.8, 61), y=[0.0])
    assert texts_of(assess(response, LINE)) == []
    four = solve_response(DISC, ROAD, depths=[0.0], x=[-0.5, -0.3, 0.3, 0.4], y=[0.0])
    assert texts_of(assess(four, LINE)) == []
