"""The largest reading over a range of depths, and where it stands."""

import numpy as np
import pytest

import treadload as tl
from cases import ONE_AXLE
from treadload.case import Case
from treadload.damage import Criterion, FatigueLine, FrenchSubgrade, MepdgTopDown, PowerLine, VonMisesStrain
from treadload.errors import InputError

SHEARED = """[[criteria]]
name = "top"
law = "power-law"
reads = "vertical_shear_strain"
reading_6 = "100 microstrain"
slope = -0.2
layer = 1
place = "top"
[[criteria]]
name = "deep"
law = "power-law"
reads = "vertical_shear_strain"
reading_6 = "100 microstrain"
slope = -0.2
layer = 1
place = "top"
search_to = "50 mm"
[[criteria]]
name = "one depth"
law = "power-law"
reads = "vertical_shear_strain"
reading_6 = "100 microstrain"
slope = -0.2
layer = 1
place = "top"
search_to = "1 mm"
"""


@pytest.mark.slow
def test_a_life_reads_the_largest_down_to_a_depth_and_says_where():
    """Shear between the vertical and the horizontal grows with depth below a free rolling tire."""
    life = tl.run(Case.from_text(ONE_AXLE + SHEARED), leave_out=("sensitivity",)).life
    data = life.dataset
    depth = data.read_depth.to_numpy()
    assert depth[0] == 0.0
    # Of single numbers.
    assert 0.01 - 1e-8 <= depth[1] <= 0.05 + 1e-8
    top, deep, near = data.largest_reading.to_numpy()
    assert deep > 1.2 * top
    # The cubes of both depths are one: from the surface down.
    assert near == pytest.approx(top, rel=1e-9)
    assert "search_to" in Case.from_text(ONE_AXLE + SHEARED).to_toml()


def test_its_reading_is_that_of_a_criterion_at_the_depth_that_it_names():
    road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3", temperature=15)
    law = PowerLine(VonMisesStrain(), 1e-4, -0.2)
    searched = Criterion("a", law, 0, "top", search_to=0.1)
    # Every 10 mm, and not beyond the layer of 60 mm.
    np.testing.assert_allclose(searched.depths(road), [0, 0.01, 0.02, 0.03, 0.04, 0.05], atol=1e-12)
    assert Criterion("a", law, 0, "top").depths(road) == (0.0,)
    assert Criterion("a", law, 1, "top", search_to=0.004).depths(road) == pytest.approx((0.06, 0.064))
    load = tl.UniformRectangle(0.2, 0.2, 8e5)
    at = np.linspace(-0.15, 0.15, 13)
    found = tl.solve_response(load, road, depths=searched.depths(road), x=at, y=at, mean_over=0.01).dataset
    read = searched.read(found)
    assert read.shape == (6, 13, 13)
    np.testing.assert_array_equal(read[3], searched.read(found.isel(depth=3)))


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ((FatigueLine(1e-4, -0.2), 0, "bottom", 0.02), 'a quantity at place = "top"'),
        ((FatigueLine(1e-4, -0.2), 0, "top", 0.0), r"search_to of the criterion 'a' must lie in \(0, 0.5\] m, got 0"),
        ((FatigueLine(1e-4, -0.2), 0, "top", 20.0), r"must lie in \(0, 0.5\] m, got 20"),
        ((MepdgTopDown(5e9, 0.15, 0.06, 0.11), 0, "top", 0.02), "reads one depth, so that search_to does not apply"),
    ],
)
def test_where_there_is_nothing_to_search_it_is_refused(given, words):
    law, layer, place, search = given
    with pytest.raises(InputError, match=words):
        Criterion("a", law, layer, place, search_to=search)
    Criterion("soil", FrenchSubgrade(), -1, "top")


def test_a_verdict_looks_between_the_depths_and_says_where():
    """Below the middle of a disc the plane is pressed at the surface, and extends most about a radius deep.

    The surface is left out: around the disc it extends more than any depth below it.
    """
    half = tl.Pavement.half_space(tl.Elastic(5e9, 0.1))
    at = np.linspace(-0.016, 0.016, 5)
    found = tl.solve_response(tl.UniformDisc(0.1, 8e5), half, depths=[0.05, 0.3], x=at, y=at)
    data = tl.assess(found, FatigueLine(1e-4, -0.2)).dataset
    depths = np.linspace(0.0, 0.4, 401)
    line = tl.solve_response(tl.UniformDisc(0.1, 8e5), half, depths=depths, x=[0.0], y=[0.0]).dataset
    strain, tensile = line.in_plane_strain_1.squeeze().to_numpy(), line.stress_xx.squeeze().to_numpy() > 0
    peak = int(np.where(tensile, strain, 0.0).argmax())
    assert float(data.worst_strain) > 1.01 * float(data.extension_by_depth.max())
    # A fifth of the distance between two depths, on a flat maximum.
    assert abs(float(data.worst_depth) - depths[peak]) <= 0.05
    assert float(data.worst_strain) == pytest.approx(strain[peak], rel=0.02)
    assert float(data.worst_depth) not in found.dataset.depth.to_numpy()
