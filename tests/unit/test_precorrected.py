"""Points off the lattice of the load: interpolation from lattices against sums over the cells."""

import numpy as np
import pytest

from bilinear_loads import bilinear_on_grid
from treadload.kernels.gridding import gridded, precorrected
from treadload.kernels.half_space.interior import fields_on_grid, sums_on_grid

DX = 0.003
WAYS = {"constant": fields_on_grid, "bilinear": bilinear_on_grid}


def both(way, load, dx, dy, depth, x, y, method):
    stress, displacement, used = WAYS[way](load, dx, dy, np.array([depth]), 1.0, 0.35, x, y, method)
    return np.concatenate([stress, displacement], axis=1)[0], used


def apart(found, exact):
    """Largest difference by the largest value of each field."""
    largest = np.abs(exact).max(axis=(1, 2))
    # Beside the load the surface carries no traction: zero either way.
    return (np.abs(found - exact).max(axis=(1, 2)) / np.where(largest == 0, 1, largest)).max()


def rough(ny, nx, seed=5):
    """Load that steps from cell to cell, the hardest to interpolate."""
    return np.random.default_rng(seed).random((3, ny, nx))


def anywhere(count, cells, size, seed=6):
    """Points on the load and up to half its length beyond."""
    return cells * size * np.random.default_rng(seed).uniform(-0.5, 1.5, count)


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("depth", [0.0, 0.2 * DX, 3 * DX, 12 * DX])
@pytest.mark.parametrize("nodes", [1, 2, 4])
def test_interpolation_is_the_sum(way, depth, nodes, monkeypatch):
    monkeypatch.setattr(gridded, "_cheapest", lambda *at: [(0.0, "precorrected", nodes)] * len(at[3]))
    load, x, y = rough(16, 20), anywhere(13, 20, DX), anywhere(11, 16, DX, 7)
    found, used = both(way, load, DX, DX, depth, x, y, "precorrected")
    assert used == "precorrected"
    monkeypatch.undo()
    exact, _ = both(way, load, DX, DX, depth, x, y, "direct")
    # 1e-8 of the largest value is the bound; steps between all cells are the hardest to keep it for.
    assert apart(found, exact) < 1e-8


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("dy", [0.7 * DX, 3.3 * DX])
def test_long_cells(way, dy):
    load, x, y = rough(14, 18), anywhere(12, 18, DX), anywhere(9, 14, dy, 7)
    for depth in (0.0, 2 * DX):
        found, _ = both(way, load, DX, dy, depth, x, y, "precorrected")
        exact, _ = both(way, load, DX, dy, depth, x, y, "direct")
        assert apart(found, exact) < 1e-8


def test_edges_corners_centres_and_nodes():
    load = rough(14, 18)
    # Centres, edges, nodes of two in a cell, and round-off beside them.
    x = DX * np.array([0.0, 0.5, 3.25, 7.5 - 1e-12, 7.5, 17.5, 18.0, 4 + 1e-13])
    y = DX * np.array([-0.5, 2.0, 6.5, 6.75, 13.5])
    found, _ = both("constant", load, DX, DX, 0.0, x, y, "precorrected")
    exact, _ = both("constant", load, DX, DX, 0.0, x, y, "direct")
    # The logarithms at the edges belong to the cells, which are summed either way.
    assert apart(found, exact) < 1e-8


def test_points_away_from_the_load():
    load = rough(10, 12)
    x, y = DX * np.array([-400.3, -80.7, 95.1]), DX * np.array([333.3, 1.2])
    found, _ = both("constant", load, DX, DX, 0.0, x, y, "precorrected")
    exact, _ = both("constant", load, DX, DX, 0.0, x, y, "direct")
    assert apart(found, exact) < 1e-8


def test_stencils_hold_polynomials():
    at = np.random.default_rng(1).uniform(-3, 9, 40)
    for nodes in (1, 2, 3):
        stencils = precorrected._Stencils.of(at, nodes, precorrected.FINE.stencil)
        for power in range(precorrected.FINE.stencil):
            total = np.zeros(len(at))
            for start, count, back in stencils.lattices():
                total += back @ ((start + np.arange(count)) / 10) ** power
            # Round-off of twelve terms.
            np.testing.assert_allclose(total, (at / 10) ** power, atol=1e-13)


def test_the_cheapest_way_is_taken_at_each_depth():
    load, x, y = rough(60, 60), anywhere(30, 60, DX), anywhere(30, 60, DX, 7)
    assert both("constant", load, DX, DX, 0.0, x, y, "auto")[1] == "precorrected"
    assert both("constant", load, DX, DX, 0.0, DX * np.arange(30), DX * np.arange(30.0), "auto")[1] == "fft"
    assert both("constant", load, DX, DX, 0.0, x[:1], y[:2], "auto")[1] == "direct"


def test_what_is_kept_serves_further_points():
    """The same numbers for patches that come one after the other, also for a load on nearly as many cells."""
    loads, keeper = [rough(16, 20), rough(15, 19)], precorrected.Keeper()
    depths, mean = np.array([0.7, 2.6]) * DX, np.array([[0.5, 0.5]])
    for corner in (4.2, 9.6, -3.0):
        x, y = DX * (corner + np.arange(13) / 6), DX * (corner - 1 + np.arange(13) / 6)
        for load in loads:
            found, _ = sums_on_grid(load, DX, DX, depths, mean, 0.35, x, y, moves=False, kept=keeper)
            alone, used = sums_on_grid(load, DX, DX, depths, mean, 0.35, x, y, "precorrected", moves=False)
            rougher, _ = sums_on_grid(
                load, DX, DX, depths, mean, 0.35, x, y, moves=False, kept=keeper.with_order(precorrected.ROUGH)
            )
            exact, _ = sums_on_grid(load, DX, DX, depths, mean, 0.35, x, y, "direct", moves=False)
            assert used == "precorrected"
            # Interpolation leaves 1e-9, round-off of transforms on other numbers of cells less.
            assert apart(found[0], exact[0]) < 1e-8
            assert apart(found[0], alone[0]) < 1e-9
            # As measured, with a margin: see `ROUGH`.
            assert apart(rougher[0], exact[0]) < 2e-6
    # One kernel, whose transforms for nine lattices of nodes serve both loads.
    (kept,) = keeper.by_kernel.values()
    assert len(kept.nodes) == 18
    assert len(kept.spectra) == 9
