"""Layered roads: the half-space as a limit, superposition, symmetry, interfaces, what drifts."""

import numpy as np
import pytest

import treadload as tl
from treadload.grid import Grid
from treadload.response import GridLoad, layered

ASPHALT, BASE, SOIL = tl.Elastic(7e9, 0.35), tl.Elastic(9e9, 0.3), tl.Elastic(5e7, 0.4)
GRID = Grid(9, 7, 0.02, 0.02, -0.08, -0.06)
NAMES = [f"{kind}_{c}" for kind in ("stress", "strain") for c in ("xx", "yy", "zz", "xy", "xz", "yz")]
NAMES += [f"displacement_{c}" for c in "xyz"]


def load(seed=0):
    rng = np.random.default_rng(seed)
    return GridLoad(GRID, rng.uniform(0, 1e6, GRID.shape), *rng.uniform(-3e5, 3e5, (2, *GRID.shape)))


def road(bond=tl.pavement.BONDED, other=tl.pavement.BONDED):
    return tl.Pavement([tl.Layer(ASPHALT, 0.06, bond=bond), tl.Layer(BASE, 0.15, bond=other), tl.Layer(SOIL)])


def close(one, other, tolerance, names=NAMES):
    for name in names:
        a, b = one[name].to_numpy(), other[name].to_numpy()
        assert np.abs(a - b).max() <= tolerance * np.abs(b).max(), name


def test_equal_layers_are_the_half_space():
    # A spring this stiff slides by 1e-14 of what the body moves, yet takes the way of the layers.
    stuck = tl.pavement.Bond(1e25)
    same = tl.Pavement([tl.Layer(ASPHALT, 0.06, bond=stuck), tl.Layer(ASPHALT, 0.15, bond=stuck), tl.Layer(ASPHALT)])
    points = {"depths": [0.0, 0.003, 0.02, 0.058, 0.06, 0.1, 0.3], "x": [-0.1, 0.0, 0.013], "y": [0.0, 0.05]}
    layered = tl.solve_response(load(), same, **points)
    assert layered.stats["method"].startswith("layered")
    closed = tl.solve_response(load(), tl.Pavement.half_space(ASPHALT), **points)
    for depth in points["depths"]:
        close(layered.dataset.sel(depth=depth), closed.dataset.sel(depth=depth), 1e-8)


def test_surface_carries_the_load_exactly():
    surface = tl.solve_response(load(), road(), depths=[0.0]).dataset.isel(depth=0)
    # No step of the load rings: what is left is the quadrature, of waves that the first interface returns.
    np.testing.assert_allclose(surface["stress_zz"], -load().pressure, atol=1e-3)
    np.testing.assert_allclose(surface["stress_xz"], -load().traction_x, atol=1e-3)
    np.testing.assert_allclose(surface["stress_yz"], -load().traction_y, atol=1e-3)


def test_both_ways_meet_where_one_takes_over():
    # At 0.9 of the first layer the closed form of its half-space is given up.
    points = {"x": [0.0, 0.05], "y": [0.0]}
    both = tl.solve_response(load(), road(), depths=[0.9 * 0.06 - 1e-12, 0.9 * 0.06 + 1e-12], **points).dataset
    close(both.isel(depth=0), both.isel(depth=1), 1e-8)


def test_loads_add_up_in_one_pass():
    parts = [
        load(),
        tl.UniformDisc(0.1, 6e5, x=0.2),
        tl.UniformRectangle(0.2, 0.1, 5e5, y=-0.3, traction_x=1e5),
    ]
    points = {"depths": [0.0, 0.1], "x": [0.0, 0.2], "y": [-0.25, 0.0]}
    together = tl.solve_response(parts, road(), **points).dataset
    apart = [tl.solve_response(part, road(), **points).dataset for part in parts]
    total = {name: sum(data[name] for data in apart) for name in NAMES}
    close(together, total, 1e-8)


def test_a_disc_has_an_axis_and_squares_turn():
    disc = tl.solve_response(tl.UniformDisc(0.12, 7e5), road(), depths=[0.0, 0.06, 0.3], x=[0.1], y=[0.0]).dataset
    turned = tl.solve_response(tl.UniformDisc(0.12, 7e5), road(), depths=[0.0, 0.06, 0.3], x=[0.0], y=[0.1]).dataset
    for one, other in (("stress_xx", "stress_yy"), ("stress_xz", "stress_yz"), ("displacement_x", "displacement_y")):
        a, b = disc[one].to_numpy(), turned[other].to_numpy()
        assert np.abs(a - b).max() <= 1e-8 * np.abs(b).max()


@pytest.mark.parametrize("stiffness", [1e9, 1e11])
def test_the_spring_between_layers(stiffness):
    points = {"depths": [0.06], "x": [-0.05, 0.0, 0.12], "y": [0.0, 0.04]}
    solved = {
        side: tl.solve_response(load(), road(tl.pavement.Bond(stiffness)), side=side, **points).dataset
        for side in ("above", "below")
    }
    close(solved["above"], solved["below"], 1e-9, ["stress_zz", "stress_xz", "stress_yz", "displacement_z"])
    for axis in "xy":
        slide = solved["above"][f"displacement_{axis}"] - solved["below"][f"displacement_{axis}"]
        stress = solved["above"][f"stress_{axis}z"].to_numpy()
        # The layer above is dragged along by the load; σ_xz = -k_s [u] with z down.
        assert np.abs(stress + stiffness * slide.to_numpy()).max() <= 1e-7 * np.abs(stress).max()


def test_half_bonded_is_the_mean_of_two_roads():
    # Interfaces switch together: two roads, not four.
    half = road(tl.pavement.HALF_BONDED, tl.pavement.HALF_BONDED)
    points = {"depths": [0.0, 0.06, 0.21], "x": [-0.05, 0.1], "y": [0.0]}
    pressed = tl.UniformRectangle(0.2, 0.1, 5e5)
    found = tl.solve_response(pressed, half, **points).dataset
    stuck, free = (
        tl.solve_response(pressed, road(bond, bond), **points).dataset
        for bond in (tl.pavement.BONDED, tl.pavement.FRICTIONLESS)
    )
    # The same two sums: round-off alone.
    close(found, {name: (stuck[name] + free[name]) / 2 for name in NAMES}, 1e-14)
    # Principal values are those of the mean tensor, which for the largest lie below the mean of the two.
    largest = found["principal_strain_1"]
    assert (largest <= (stuck["principal_strain_1"] + free["principal_strain_1"]) / 2 + 1e-15).all()
    tensor = np.empty((*largest.shape, 3, 3))
    for i, one in enumerate("xyz"):
        for j, other in enumerate("xyz"):
            tensor[..., i, j] = found[f"strain_{''.join(sorted(one + other))}"]
    np.testing.assert_allclose(np.linalg.eigvalsh(tensor)[..., -1], largest, atol=1e-12 * float(abs(largest).max()))


def test_half_bonded_layers_of_one_material_slide_in_one_of_two_roads():
    built = tl.Pavement([tl.Layer(ASPHALT, 0.1, bond=tl.pavement.HALF_BONDED), tl.Layer(ASPHALT)])
    points = {"depths": [0.0, 0.1], "x": [0.0], "y": [0.0]}
    found, whole, free = (
        tl.solve_response(tl.UniformDisc(0.1, 5e5), one, **points)
        for one in (built, tl.Pavement.half_space(ASPHALT), built.bond_limits[1])
    )
    assert found.stats["method"] == "disc and layered+disc"
    close(found.dataset, {name: (whole.dataset[name] + free.dataset[name]) / 2 for name in NAMES}, 1e-14)


def test_what_nothing_holds_is_not_given():
    points = {"depths": [0.0, 0.1, 0.5], "x": [0.0], "y": [0.0]}
    slab = road(other=tl.pavement.FRICTIONLESS)
    response = tl.solve_response(tl.UniformRectangle(0.2, 0.1, 5e5, traction_x=1e5), slab, **points)
    assert np.isnan(response.dataset["displacement_x"].to_numpy().ravel()).tolist() == [True, True, False]
    assert np.isfinite(response.dataset["displacement_y"]).all()
    assert np.isfinite(response.dataset["strain_xx"]).all()
    assert "net shear force of 2e+03 N along x" in response.warnings[0]
    assert "NaN at 0, 100 mm" in response.warnings[0]
    assert "Bond(stiffness=...)" in response.warnings[0]
    assert not tl.solve_response(tl.UniformDisc(0.1, 5e5), slab, **points).warnings


def test_means_below_a_face_that_nothing_holds_are_finite():
    points = {"depths": [0.05, 0.5], "x": [0.0], "y": [0.0]}
    slab, rectangle = road(other=tl.pavement.FRICTIONLESS), tl.UniformRectangle(0.2, 0.1, 5e5, traction_x=1e5)
    point = tl.solve_response(rectangle, slab, **points).dataset
    means = tl.solve_response(rectangle, slab, mean_over=0.02, **points)
    moved = means.dataset["displacement_x"].to_numpy().ravel()
    # Weights of nothing times NaN had left none.
    assert np.isnan(moved).tolist() == [True, False]
    assert "NaN at 50 mm" in means.warnings[0]
    # 20 mm at half a metre: what the mean leaves of the second derivative.
    assert moved[1] == pytest.approx(float(point["displacement_x"][1, 0, 0]), rel=1e-3, abs=1e-9)


def test_a_rigid_base_does_not_move():
    built = tl.Pavement([tl.Layer(ASPHALT, 0.06), tl.Layer(SOIL, 0.5)], rigid_base=True)
    data = tl.solve_response(load(), built, depths=[0.0, 0.56], x=[0.0, 0.05], y=[0.0]).dataset
    for axis in "xyz":
        moved = np.abs(data[f"displacement_{axis}"].to_numpy())
        assert moved[1].max() <= 1e-9 * moved[0].max()


def test_waves_alone_are_the_half_space_split_off_and_what_the_layers_add(monkeypatch):
    points = {"depths": [0.0, 0.02, 0.05], "x": np.linspace(-0.1, 0.1, 4), "y": [0.0, 0.013]}
    monkeypatch.setattr(layered, "_WAVE_COST", 0.0)
    alone = tl.solve_response(load(), road(), **points).dataset
    monkeypatch.setattr(layered, "_WAVE_COST", 1e9)
    split = tl.solve_response(load(), road(), **points).dataset
    close(alone, split, 1e-8)


def test_a_thin_surfacing_under_a_footprint_is_not_refused():
    thin = tl.Pavement([tl.Layer(tl.Elastic(3e9, 0.35), 0.01), tl.Layer(BASE, 0.2), tl.Layer(SOIL)])
    cells = Grid.centred(0.06, 0.06, 3e-3)
    pressure = 8e5 * np.ones(cells.shape)
    patch = GridLoad(cells, pressure, 0.3 * pressure, -0.1 * pressure)
    points = {"depths": [0.0, 0.005, 0.01, 0.02], "x": [-0.031, 0.0, 0.4], "y": [0.0]}
    found = tl.solve_response(patch, thin, **points).dataset
    # The same as one rectangle: its waves are those of no cells at all.
    one = tl.UniformRectangle(0.06, 0.06, 8e5, traction_x=0.3 * 8e5, traction_y=-0.1 * 8e5)
    whole = tl.solve_response(one, thin, **points).dataset
    for depth in points["depths"]:
        close(found.sel(depth=depth), whole.sel(depth=depth), 1e-8)
