"""Means over a cube of road, and verdicts that read them."""

import json
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import treadload as tl
from treadload.damage import FatigueLine, FrenchBituminous, MepdgTopDown, ShearFatigue, assess
from treadload.errors import InputError
from treadload.grid import Grid
from treadload.response import GridLoad, UniformDisc, UniformRectangle, solve_response
from treadload.response.material import MATERIAL_LENGTH, spread_over, windows

LINE = FatigueLine(120e-6, -0.2)
HALF = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
LAYERS = tl.Pavement([tl.Layer(tl.Elastic(7e9, 0.35), 0.06), tl.Layer(tl.Elastic(1.2e8, 0.35))])
COMPONENTS = ("xx", "yy", "zz", "xy", "xz", "yz")


def strain(data):
    return np.stack([data[f"strain_{name}"].transpose("depth", "y", "x").to_numpy() for name in COMPONENTS])


@pytest.mark.parametrize("road", [HALF, LAYERS], ids=["half-space", "layers"])
def test_the_mean_is_that_of_many_points_of_the_cube(road):
    """Independent: points of the response itself, 20 x 20 across the cube and 12 of Gauss down it."""
    load = UniformRectangle(0.12, 0.2, 8e5, traction_x=-2.5e5, traction_y=1e5)
    length, x, y = 0.01, [-0.06, 0.0201], [0.0993]
    found = strain(solve_response(load, road, depths=[0.0, 0.012], x=x, y=y, mean_over=length).dataset)
    inside = length * ((np.arange(20) + 0.5) / 20 - 0.5)
    nodes, weights = np.polynomial.legendre.leggauss(12)
    all_x, all_y = (np.add.outer(at, inside).ravel() for at in (x, y))
    for row, (low, high) in enumerate([(0.0, 0.01), (0.007, 0.017)]):
        depths = 0.5 * (low + high) + 0.5 * (high - low) * nodes
        points = strain(solve_response(load, road, depths=depths, x=all_x, y=all_y).dataset)
        cube = points.reshape(6, len(nodes), len(y), 20, len(x), 20).mean(axis=(3, 5))
        expected = np.einsum("cnyx,n->cyx", cube, weights / 2)
        # Two points of Gauss stand for the mean over depth. Under the corner of a load that ends at once, where the
        # field has a logarithm, they err by 4 % at the surface and 1 % below; under a tire by 0.3 %.
        assert np.abs(found[:, row] - expected).max() < (0.05, 0.02)[row] * np.abs(expected).max()


def test_deep_points_are_read_themselves():
    load = UniformRectangle(0.12, 0.2, 8e5)
    at = {"x": [0.0, 0.05], "y": [0.0], "depths": [0.02, 0.06]}
    mean, point = (strain(solve_response(load, LAYERS, **at, mean_over=m).dataset) for m in (0.01, None))
    np.testing.assert_array_equal(mean, point)


def test_windows_stay_in_the_road_and_in_their_layer():
    read = windows(np.array([0.0, 0.003, 0.008, 0.012, 0.012, 0.05]), 0.01, np.array([0.012]), [0, 0, 0, 0, 1, 1])
    np.testing.assert_allclose(read.low, [0, 0, 0.003, 0.007, 0.012, 0.05], atol=1e-15)
    np.testing.assert_allclose(read.high, [0.01, 0.01, 0.012, 0.012, 0.017, 0.05], atol=1e-15)
    np.testing.assert_array_equal(read.local, [False] * 5 + [True])
    np.testing.assert_allclose(read.mean.sum(axis=1), [1] * 5 + [0], atol=1e-15)
    # The mean of a depth is its middle.
    np.testing.assert_allclose((read.mean @ read.nodes)[:5], 0.5 * (read.low + read.high)[:5], atol=1e-15)


@settings(max_examples=40, deadline=None)
@given(
    st.floats(5e-4, 0.03), st.floats(5e-4, 0.03), st.floats(1e-3, 0.05), st.integers(1, 6), st.integers(1, 6),
    st.sampled_from(["constant", "bilinear"]), st.integers(0, 2**32 - 1),
)  # fmt: skip
def test_a_load_keeps_its_force_and_centre(dx, dy, length, nx, ny, interpolation, seed):
    values = np.random.default_rng(seed).uniform(0.1, 1.0, (3, ny, nx))
    load = GridLoad(Grid(nx, ny, dx, dy, 0.02, -0.01), *values, interpolation)
    wide = spread_over(load, length)
    area, wider = load.grid.cell_area, wide.grid.cell_area
    # Round-off of sums.
    np.testing.assert_allclose(wide.array.sum((1, 2)) * wider, load.array.sum((1, 2)) * area, rtol=1e-10)
    for name, axis in (("x", 1), ("y", 2)):
        weight = load.array.sum(axis) @ getattr(load.grid, name) * area
        np.testing.assert_allclose(wide.array.sum(axis) @ getattr(wide.grid, name) * wider, weight, atol=1e-12)


def test_a_disc_is_spread_like_its_cells():
    disc = UniformDisc(0.1, 7e5, 0.03, -0.02)
    wide = spread_over(disc, 0.01)
    assert wide.normal_load == pytest.approx(disc.normal_load, rel=1e-12)
    inside = np.hypot(wide.grid.x[None] - 0.03, wide.grid.y[:, None] + 0.02) < 0.09
    np.testing.assert_allclose(wide.pressure[inside], 7e5, rtol=1e-3)
    assert wide.pressure[np.hypot(wide.grid.x[None] - 0.03, wide.grid.y[:, None] + 0.02) > 0.11].max() == 0


@pytest.fixture(scope="module")
def driving():
    tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
    wheel = tl.Rolling(normal_load=32.5e3, tractive_force=10e3, friction=0.7)
    return tl.solve_contact(tire, HALF, wheel, spacing=6e-3)


@pytest.fixture(scope="module")
def response(driving):
    return solve_response(driving, HALF, depths=[0.0, 0.0025, 0.02])


@pytest.mark.slow
def test_the_verdict_is_the_worst_of_all_depths_and_says_which(driving, response):
    verdict = assess(response, LINE)
    data = verdict.dataset
    assert "mean over 10 mm, at depth 0, 2.5, 20 mm" in verdict.summary()
    assert f"depth {float(data.worst_depth) * 1e3:g} mm" in verdict.summary()
    assert float(data.worst_depth) == float(data.depth[int(data.extension_by_depth.values.argmax())])
    assert float(data.worst_strain) >= float(data.extension_by_depth.max())
    # Between the cells: beside the map's largest, by no more than a cell and a step of the first search.
    row, column = np.unravel_index(int(data.allowable_passes.values.argmin()), data.allowable_passes.shape)
    assert abs(float(data.worst_x) - float(data.x[column])) <= 6.5e-3
    assert abs(float(data.worst_y) - float(data.y[row])) <= 6.5e-3
    again = solve_response(
        driving, HALF, depths=[0.0], x=[float(data.worst_x)], y=[float(data.worst_y)], mean_over=0.01
    ).dataset
    assert again.in_plane_strain_1.item() == pytest.approx(float(data.worst_strain), rel=1e-9)
    # A response that is a mean already says the same.
    mean = solve_response(driving, HALF, depths=[0.0, 0.0025, 0.02], mean_over=0.01)
    assert float(assess(mean, LINE).dataset.worst_strain) == pytest.approx(float(data.worst_strain), rel=1e-12)


def test_a_local_reading_is_labelled(response):
    local = assess(response, LINE, depth=0.0)
    assert "local, depends on the cells, at depth 0 mm" in local.summary()
    # At least half as much again as the mean, at the edge of a rib: what the label is for.
    assert float(local.dataset.worst_strain) > 1.5 * float(assess(response, LINE).dataset.worst_strain)
    assert "strain, local, at depth 20 mm" in assess(response, LINE, depth=0.02).summary()


def test_depths_below_the_top_layer_are_named_and_left_out():
    load = UniformRectangle(0.2, 0.2, 8e5, traction_x=-3e5)
    at = np.linspace(-0.15, 0.15, 31)
    found = solve_response(load, LAYERS, depths=[0.0, 0.06, 0.1], x=at, y=at)
    verdict = assess(found, LINE)
    np.testing.assert_array_equal(verdict.dataset.depth, [0.0, 0.06])
    assert any("the depths 100 mm lie below the top layer" in text for text in verdict.warnings)
    below = solve_response(load, LAYERS, depths=[0.0, 0.06], x=at, y=at, side="below")
    np.testing.assert_array_equal(assess(below, LINE).dataset.depth, [0.0])
    deep = solve_response(load, LAYERS, depths=[0.1], x=at, y=at)
    with pytest.raises(InputError, match="no depth of the response lies in the top layer"):
        assess(deep, LINE)


def test_nothing_cracks_where_nothing_is_tensile():
    """A stiff course that bends: upright extension under the wheel, where every principal stress presses."""
    road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3", temperature=15)
    at = np.linspace(-0.08, 0.08, 17)
    pressed = solve_response(UniformDisc(0.12, 8e5), road, depths=[0.0, 0.01], x=at, y=at)
    # Without its road the response is not solved beyond the map, where the surface hogs.
    verdict = assess(replace(pressed, road=None), LINE, strain="principal", depth=0.0)
    assert float(pressed.dataset.principal_strain_1.max()) > 10e-6
    assert verdict.orientation == "none"
    assert np.isinf(verdict.dataset.allowable_passes).all()
    assert "only where no principal stress is tensile; this criterion predicts no cracking" in verdict.summary()
    assert "worst point" not in verdict.summary()


@pytest.mark.parametrize(
    ("law", "more", "words"),
    [
        (ShearFatigue(-0.2), {}, "is for the utilisation of the bond; take a law for a tensile strain"),
        (
            MepdgTopDown(5e9, 0.15, 0.06, 0.11),
            {"depth": 0.06},
            "reads the tensile strain at the surface, got depth",
        ),
        (FrenchBituminous(90e-6, -0.2, 0.3, 0.15, 0.05, 1.3), {}, "give depth= of that bottom"),
        (FrenchBituminous(90e-6, -0.2, 0.3, 0.15, 0.05, 1.3), {"depth": 0.02}, "the road has 0.06 m"),
    ],
)
def test_laws_are_refused_where_they_do_not_speak(law, more, words):
    at = np.linspace(-0.1, 0.1, 5)
    found = solve_response(UniformDisc(0.1, 8e5), LAYERS, depths=[0.0, 0.02, 0.06], x=at, y=at)
    with pytest.raises(InputError, match=words):
        assess(found, law, **more)


def test_criteria_are_refused_where_their_law_does_not_speak():
    top, bottom = MepdgTopDown(5e9, 0.15, 0.06, 0.11), FrenchBituminous(90e-6, -0.2, 0.3, 0.15, 0.05, 1.3)
    with pytest.raises(InputError, match=r'reads the bottom of a layer.*give place = "top"'):
        tl.damage.Criterion("a", top, 0, "bottom")
    with pytest.raises(InputError, match=r'reads the top of a layer.*give place = "bottom"'):
        tl.damage.Criterion("a", bottom, 0, "top")
    with pytest.raises(InputError, match=r"reads layer 1.*give layer 0"):
        tl.damage.Criterion("a", top, 1, "top").depth(LAYERS)
    with pytest.raises(InputError, match="reads the utilisation of the bond"):
        tl.damage.Criterion("a", ShearFatigue(-0.2))
    with pytest.raises(InputError, match=r"mean_over must lie in \(0, 0.1\] m, got 10"):
        tl.damage.Criterion("a", LINE, length=10)


def test_a_response_without_its_road_needs_a_depth(response):
    from types import SimpleNamespace

    with pytest.raises(InputError, match="give depth= to read the points"):
        assess(SimpleNamespace(dataset=response.dataset), LINE)


@pytest.mark.slow
def test_two_grids_tell_the_error(driving):
    contact = tl.solve_contact(driving.tire, HALF, driving.rolling, spacing=3e-3)
    response = solve_response(contact, HALF, depths=[0.0])
    verdict = assess(response, LINE, error_estimate=True)
    text = next(line for line in verdict.summary().splitlines() if line.startswith("error estimate"))
    assert "cells of 6 mm" in text
    read, coarse = float(verdict.dataset.worst_strain), float(verdict.dataset.attrs["coarse_strain"])
    assert f"a difference of {100 * abs(coarse - read) / read:.2g} %" in text
    finer = assess(
        solve_response(tl.solve_contact(driving.tire, HALF, driving.rolling, spacing=1.5e-3), HALF, depths=[0.0]),
        LINE,
    )
    # The estimate holds the distance to a grid twice as fine.
    assert abs(float(finer.dataset.worst_strain) - read) <= abs(coarse - read)
    # Of its own shifted contact as of one that is given.
    shifted = tl.solve_contact(driving.tire, HALF, driving.rolling, spacing=3e-3, offset=(0.5, 0.5))
    own, given = (assess(response, LINE, shifted=one).dataset for one in (True, shifted))
    assert float(own.worst_strain) == float(given.worst_strain) != read
    fixed = replace(contact, tire=tl.Tire.from_height_map(np.zeros((20, 20)), 5e-3, material=tl.Elastic(3e6, 0.5)))
    for second in ({"error_estimate": True}, {"shifted": True}):
        with pytest.raises(InputError, match="a height map has one"):
            assess(solve_response(fixed, HALF, depths=[0.0]), LINE, **second)
        with pytest.raises(InputError, match="solve that of a contact"):
            assess(
                solve_response(tl.UniformDisc(0.1, 7e5), HALF, depths=[0.0], x=[0, 0.1], y=[0, 0.1]), LINE, **second
            )


def test_a_case_asks_for_the_error():
    from cases import COARSE_CASE

    text = COARSE_CASE.replace("slope = -0.2 }", "slope = -0.2 }\nerror_estimate = true")
    result = tl.run(tl.Case.from_text(text.replace('"12 mm"', '"8 mm"')))
    assert "error estimate" in result.summary()
    assert result.to_tree()["damage"].attrs["coarse_strain"] > 0


def test_a_life_says_that_it_reads_planes_parallel_to_the_surface():
    tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
    road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3", temperature=15)
    one = tl.damage.AxleClass("one", 1.0, 32.5e3, 820e3)
    traffic = tl.damage.Traffic((one,), 1e5)
    upright, plane = (
        tl.damage.Criterion(strain, FatigueLine(100e-6, -0.2), 0, "top", strain)
        for strain in ("principal", "in-plane")
    )
    life = tl.solve_life(
        tl.Design(tire, road, traffic, tl.damage.Climate.constant(15.0), (upright, plane), spacing=12e-3)
    )
    flat = life.dataset.orientation_damage.sel(orientation="horizontal")
    assert float(flat.sel(criterion="principal")) > 0.5
    assert float(flat.sel(criterion="in-plane")) == 0
    (text,) = [text for text in life.warnings if "parallel to its surface" in text]
    assert text.startswith("principal: ")
    assert json.loads(tl.results.to_tree(life)["life"].attrs["warnings"])


def test_the_default_is_written_down():
    assert MATERIAL_LENGTH == 0.010
    assert tl.Case.from_text(__import__("cases").COARSE_CASE).damage.mean_over == MATERIAL_LENGTH


def test_the_reading_is_the_largest_between_the_points_of_the_map():
    """Where the line at which tension ends cuts the reading off, the map's own points are off by a twentieth."""
    block = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 1.0, 0.05, 0.0), inflation_pressure=820e3)
    contact = tl.solve_contact(block, HALF, tl.Rolling(normal_load=3e3, tractive_force=1e3, friction=0.7))
    data = assess(solve_response(contact, HALF, depths=[0.0]), LINE).dataset
    x, y = (float(data[name]) + np.linspace(-5e-4, 5e-4, 41) for name in ("worst_x", "worst_y"))
    fine = solve_response(contact, HALF, depths=[0.0], x=x, y=y, mean_over=0.01).dataset
    xx, yy, zz, xy, xz, yz = (fine[f"stress_{name}"].to_numpy() for name in COMPONENTS)
    stress = np.moveaxis(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]), (0, 1), (-2, -1))
    tensile = np.linalg.eigvalsh(stress)[..., -1] > 0
    assert 0.2 < tensile.mean() < 0.9  # the line runs through
    largest = float(np.where(tensile, fine.in_plane_strain_1, 0.0).max())
    # Lines of steps of 1/16 mm, along which the reading changes by 1 % a millimetre and more.
    assert float(data.worst_strain) == pytest.approx(largest, rel=3e-3)
    assert largest > 1.02 * float(data.extension_by_depth.max())


def test_a_map_coarser_than_the_mean_is_searched_between_its_points():
    """The same field on maps of any spacing: the largest strain is that of a map of 2 mm."""
    block = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 1.0, 0.05, 0.0), inflation_pressure=820e3)
    contact = tl.solve_contact(block, HALF, tl.Rolling(normal_load=3e3, tractive_force=1e3, friction=0.7))
    ends = [contact.dataset[name].to_numpy()[[0, -1]] for name in ("x", "y")]

    def assessed(spacing):
        x, y = (np.arange(first, last + spacing / 2, spacing) for first, last in ends)
        return assess(solve_response(contact, HALF, depths=[0.0], x=x, y=y), LINE)

    fine = float(assessed(0.002).dataset.worst_strain)
    for spacing in (0.01, 0.0115, 0.015):
        coarse = assessed(spacing)
        # The line where tension ends cuts the strain off; the searches of two maps meet it at different points.
        assert float(coarse.dataset.worst_strain) == pytest.approx(fine, rel=6e-3)
        assert float(coarse.dataset.extension_by_depth.max()) < 0.9 * fine
        assert not any("apart" in text for text in coarse.warnings)
    # Four points across are chosen places and not a map.
    (text,) = (text for text in assessed(0.03).warnings if "apart" in text)
    assert "30 mm along y apart" in text
    assert "a spacing of 10 mm or less" in text


def test_a_map_too_large_to_be_filled_is_named():
    at = np.linspace(-2.0, 2.0, 9)
    result = assess(solve_response(UniformDisc(0.15, 8e5), LAYERS, depths=[0.0], x=at, y=at), LINE)
    (text,) = (text for text in result.warnings if "apart" in text)
    assert "500 mm along y and 500 mm along x apart" in text
    assert "a spacing of 10 mm or less" in text


def test_a_coarser_grid_that_is_too_coarse_is_named():
    from cases import COARSE_CASE

    text = COARSE_CASE.replace("slope = -0.2 }", "slope = -0.2 }\nerror_estimate = true").replace("12 mm", "24 mm")
    with pytest.raises(
        InputError, match=r"on cells of 48 mm as well, twice the spacing of 24 mm: .*error_estimate out"
    ):
        tl.run(tl.Case.from_text(text))
