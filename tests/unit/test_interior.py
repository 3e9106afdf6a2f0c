"""Stress of loaded rectangles: surface limits, singular points, equilibrium, the ways to sum it."""

import numpy as np
import pytest

from half_space import stress_at_points, stress_by_unit_loads, stress_on_cells, stress_on_grid
from treadload.kernels.gridding import lattice
from treadload.kernels.gridding.precorrected import Keeper
from treadload.kernels.half_space import interior

DX, DY = 0.003, 0.004
DEPTHS = np.array([0.0, 1e-4, 0.003, 0.05])


@pytest.fixture
def load():
    rng = np.random.default_rng(7)
    load = rng.normal(size=(3, 9, 12))
    load[0] = np.abs(load[0])
    return load


@pytest.mark.parametrize("poisson", [0.0, 0.35, 0.5])
def test_surface_tractions_are_the_load(load, poisson):
    stress = stress_on_cells(load, DX, DY, np.array([0.0]), poisson)[0]
    # Round-off: the sampling of the load adds zeros only.
    np.testing.assert_allclose(stress[2], -load[0], rtol=1e-14)
    np.testing.assert_allclose(stress[4], -load[1], rtol=1e-14)
    np.testing.assert_allclose(stress[5], -load[2], rtol=1e-14)


def test_nothing_stands_on_the_unloaded_surface(load):
    stress = stress_on_grid(load, DX, DY, np.array([0.0]), 0.35, np.array([-0.01, 0.06]), np.array([0.0, 0.1]))[0]
    np.testing.assert_array_equal(stress[0, [2, 4, 5]], 0.0)


@pytest.mark.parametrize("poisson", [0.0, 0.35, 0.5])
def test_the_limit_to_the_surface_is_the_surface(load, poisson):
    near, at = stress_on_cells(load, DX, DY, np.array([1e-6 * DX, 0.0]), poisson)
    # The field is smooth within a cell: the difference is of the order of the depth over the cell.
    np.testing.assert_allclose(near, at, atol=2e-5 * np.abs(load).max())


def test_centre_of_a_square_and_of_any_rectangle():
    nu, centre = 0.3, np.zeros(1)
    square = stress_by_unit_loads(centre, centre, 0.0, 1.0, 1.0, nu)[0, :, 0]
    # Round-off of a closed form.
    np.testing.assert_allclose(square, [-(1 + 2 * nu) / 2, -(1 + 2 * nu) / 2, -1, 0, 0, 0], atol=1e-15)
    assert stress_by_unit_loads(centre, centre, 0.0, 1.0, 0.2, nu)[0, 2] == -1


def test_a_long_strip_is_in_plane_strain():
    nu, p = 0.35, 1.0
    y = np.array([0.0, 0.2, 0.4, 0.9])
    stress = stress_by_unit_loads(np.zeros(4), y, 0.0, 1e5, 1.0, nu)[0]
    inside = np.array([1, 1, 1, 0])
    # The far ends, 5·10⁴ widths away, change the field by less than 1e-5.
    np.testing.assert_allclose(stress[0], -2 * nu * p * inside, atol=1e-5)
    np.testing.assert_allclose(stress[1], -p * inside, atol=1e-5)
    np.testing.assert_allclose(stress[2], -p * inside, atol=1e-12)


def test_edges_and_corners_are_finite_and_jumps_take_their_mean():
    x, y = np.array([-0.5, 0.0, 0.5, 0.5, 0.5]), np.array([-0.5, 0.5, 0.0, 0.5, 0.2])
    stress = stress_by_unit_loads(x, y, 0.0, 1.0, 1.0, 0.3)
    assert np.isfinite(stress).all()
    share = np.array([0.25, 0.5, 0.5, 0.25, 0.5])
    np.testing.assert_array_equal(stress[0, 2], -share)
    np.testing.assert_array_equal(stress[1, 4], -share)
    both = stress_by_unit_loads(np.array([0.5 - 1e-7, 0.5 + 1e-7]), np.array([0.2, 0.2]), 0.0, 1.0, 1.0, 0.3)[0]
    # Points 1e-7 of the side away on either side of the edge.
    np.testing.assert_allclose(stress[0, :3, 4], both[:3].mean(axis=1), atol=1e-6)


def test_the_three_ways_agree(load):
    ny, nx = load.shape[1:]
    lattice = stress_on_cells(load, DX, DY, DEPTHS, 0.35)
    grid_y, grid_x = np.meshgrid(DY * np.arange(ny), DX * np.arange(nx), indexing="ij")
    points = stress_at_points(load, DX, DY, DEPTHS, 0.35, grid_x.ravel(), grid_y.ravel()).reshape(lattice.shape)
    # Round-off of some hundred terms of order one.
    np.testing.assert_allclose(lattice, points, atol=1e-12)
    alone = np.zeros_like(lattice)
    for j in range(ny):
        for i in range(nx):
            at = DX * (np.arange(nx) - i), DY * (np.arange(ny) - j)
            alone += stress_on_grid(load[:, j : j + 1, i : i + 1], DX, DY, DEPTHS, 0.35, *at, method="direct")[0]
    np.testing.assert_allclose(lattice, alone, atol=1e-12)


GRIDS = {
    "the load's": (np.arange(12.0), np.arange(9.0)),
    "between the cells": (np.arange(11) + 0.5, np.arange(9.0)),
    "one row": (np.arange(-5.0, 20), np.array([4.0])),
    "one column": (np.array([3.0]), np.arange(-5.0, 20)),
    "twice as fine, in disorder": (np.arange(24)[::-1] / 2, np.arange(18) / 2),
    "coarser and far": (np.arange(-40, 60, 3.0), np.arange(-12, 30, 4.0) + 0.25),
    "a third": (np.arange(20) / 3, np.array([0.1, 7.7])),
}


@pytest.mark.parametrize("name", GRIDS)
def test_any_grid_by_lattices_and_by_points(load, name):
    x, y = GRIDS[name]
    by_fft, _ = stress_on_grid(load, DX, DY, DEPTHS, 0.35, DX * x, DY * y, method="fft")
    by_sum, _ = stress_on_grid(load, DX, DY, DEPTHS, 0.35, DX * x, DY * y, method="direct")
    assert by_fft.shape == (4, 6, len(y), len(x))
    # Round-off of some hundred terms of order one.
    np.testing.assert_allclose(by_fft, by_sum, atol=1e-12)


@pytest.mark.parametrize("name", GRIDS)
def test_sums_leave_out_corners_at_which_the_load_does_not_change(load, name):
    x, y = (DX * GRIDS[name][0], DY * GRIDS[name][1])
    # A groove, and a block under one pressure: inside of it no corner counts.
    grooved = load.copy()
    grooved[:, 3:6] = 0.0
    grooved[:, 6:, 2:9] = 0.7
    by_fft, _ = stress_on_grid(grooved, DX, DY, DEPTHS, 0.35, x, y, method="fft")
    by_sum, _ = stress_on_grid(grooved, DX, DY, DEPTHS, 0.35, x, y, method="direct")
    np.testing.assert_allclose(by_fft, by_sum, atol=1e-12)


def test_the_cheaper_way_is_taken():
    load = np.ones((3, 40, 50))
    near = DX * np.arange(50), DY * np.arange(40)
    odd = np.sqrt(np.arange(2.0, 5.0)), np.array([0.0])
    assert stress_on_grid(load, DX, DY, DEPTHS[:1], 0.3, *near)[1] == "fft"
    assert stress_on_grid(load, DX, DY, DEPTHS[:1], 0.3, *odd)[1] == "direct"


def test_unloaded_margins_change_nothing(load):
    x, y = DX * np.arange(12), DY * np.arange(9)
    wide = np.pad(load, ((0, 0), (3, 5), (2, 7)))
    plain, _ = stress_on_grid(load, DX, DY, DEPTHS, 0.35, x, y)
    padded, _ = stress_on_grid(wide, DX, DY, DEPTHS, 0.35, x + 2 * DX, y + 3 * DY)
    np.testing.assert_allclose(padded, plain, atol=1e-12)


def test_no_load_no_stress():
    stress, method = stress_on_grid(np.zeros((3, 4, 5)), DX, DY, DEPTHS, 0.3, np.arange(3.0), np.arange(2.0))
    assert method == "none"
    assert stress.shape == (4, 6, 2, 3)
    assert not stress.any()


def test_surface_balance_is_exact(load):
    stress = stress_on_cells(load, DX, DY, np.array([0.0]), 0.35)[0]
    # Sums of a hundred numbers.
    np.testing.assert_allclose(stress[[2, 4, 5]].sum(axis=(1, 2)), -load.sum(axis=(1, 2)), rtol=1e-13)


def test_a_deep_plane_carries_the_load(load):
    depth, reach, spacing = 0.1, 1.0, 0.01
    x = np.arange(-reach, reach + spacing / 2, spacing)
    centred = DX * 5.5, DY * 4
    stress, _ = stress_on_grid(load, DX, DY, np.array([depth]), 0.35, x + centred[0], x + centred[1], method="direct")
    within = np.hypot(*np.meshgrid(x, x)) <= reach
    carried = np.where(within, stress[0, [2, 4, 5]], 0).sum(axis=(1, 2)) * spacing**2
    slant = np.hypot(depth, reach)
    # What point loads leave outside the circle (Boussinesq, Cerruti).
    normal = 1 - (depth / slant) ** 3
    shear = 1 - depth * (3 * reach**2 + 2 * depth**2) / (2 * slant**3)
    total = -load.sum(axis=(1, 2)) * DX * DY * [normal, shear, shear]
    # 1e-3 of the load: its width, 0.04 m, in a circle of 1 m, and the rim cut by cells of 0.01 m.
    np.testing.assert_allclose(carried, total, atol=1e-3 * np.abs(load).sum() * DX * DY / 3)


def test_far_below_it_is_a_point_load():
    depth = 50.0
    load = np.zeros((3, 2, 2))
    load[0] = 1e5
    stress = stress_on_cells(load, DX, DY, np.array([depth]), 0.35)[0]
    force = load[0].sum() * DX * DY
    # Boussinesq on the axis; differences of corners lose (cell / depth)² of 16 digits: 1e-16 / 4e-9.
    np.testing.assert_allclose(stress[2], -3 * force / (2 * np.pi * depth**2), rtol=1e-6)


def test_points_far_from_a_load_in_single_numbers_are_those_of_double_ones(monkeypatch):
    """Wheels of other axles: from coarse cells and few offsets, within what readings ask, 1e-6 of the largest."""
    random, offsets = np.random.default_rng(3), []
    load = random.uniform(-1, 1, (3, 2, 40, 50)) * np.array([9.0, 3.0, 3.0])[:, None, None, None]
    load[0] = np.abs(load[0])
    y = 3e-3 * np.concatenate([np.arange(-30, 60, 7), np.arange(0, 40)])
    functions = interior.at_corners
    monkeypatch.setattr(interior, "at_corners", lambda *at: offsets.append(at[0].size * at[1].size) or functions(*at))
    for first, count, coarse in ((231, 50, True), (-231 - 50, 50, True), (231, 1, True), (120, 20, False)):
        x, depths = 3e-3 * (first + np.arange(count)), np.array([0.0, 2e-3, 9e-3])
        given = (3e-3, 3e-3, depths, 1.0, 0.35, x, y, "fft")
        exact, few = (interior.fields_on_grid(one, *given, moves=False)[0] for one in (load, load.astype(np.float32)))
        assert np.abs(few - exact).max() < 3e-7 * np.abs(load).max()
        # A sixth each way, and four corners of its own for each.
        assert (sum(offsets[3:]) < 0.35 * sum(offsets[:3])) == coarse
        offsets.clear()


def test_lattices_are_counted_as_they_are_formed():
    several = np.random.default_rng(8)
    for x in (np.arange(9.0), several.normal(0, 30, 25), np.append(np.arange(5) / 3, [80.0, 80.5])):
        for cells in (1, 12, 60):
            formed = lattice.as_lattices(x, 1.0, cells)
            padded = sum(cells + count for _, count, _, _ in formed)
            assert lattice.padded_cells(x, 1.0, cells) == (padded, len(formed))


def test_loads_of_nearly_the_same_shape_share_the_spectra_of_their_kernels():
    several, kept = np.random.default_rng(9), Keeper()
    x = y = 0.1 * np.arange(40.0)
    for shape in ((29, 33), (28, 30), (27, 40)):
        load = several.normal(size=(3, *shape))
        given = (load, 1.0, 1.0, np.array([0.7]), np.eye(1), 0.3, x, y, "precorrected")
        shared, _ = interior.sums_on_grid(*given, kept=kept)
        alone, _ = interior.sums_on_grid(*given)
        assert np.abs(shared - alone).max() < 1e-12 * np.abs(alone).max()
    (known,) = kept.by_kernel.values()
    # As many as the nodes of a cell; the third load is wider than the first.
    assert len(known.spectra) == 2 * len({key[1:3] for key in known.spectra})
