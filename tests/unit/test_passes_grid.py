"""What a grid changes of passes: the path between cells, the box, the rows, and the error that is told."""

import tracemalloc

import numpy as np
import pytest

import treadload as tl
from treadload.materials import VonMises
from treadload.response.passes.box import Box, courses
from treadload.response.passes.grid_error import doubled, enough_cells, largest_mean
from treadload.response.passes.patches import patch_width
from treadload.response.passes.problem import Zone, problem_of
from treadload.response.passes.steady import Track, roll

ELASTIC, YIELD = tl.Elastic(1000.0, 0.3), 2.0
SHEAR_YIELD = YIELD / 3**0.5


def yielding(slope):
    """Von Mises' law with Prager's hardening, a part of the modulus."""
    return tl.materials.ElastoPlastic(ELASTIC, VonMises(YIELD, kinematic=ELASTIC.modulus / slope))


def sphere(peak, shear=0.0):
    """Pressure of a sphere of contact radius 1 with a peak in units of k, and a shear along travel."""
    grid = tl.response.Grid.centred(2.1, 2.1, 2.1 / 32)
    hertz = peak * SHEAR_YIELD * np.sqrt(np.clip(1 - grid.x[None] ** 2 - grid.y[:, None] ** 2, 0, None))
    return tl.response.GridLoad(grid, hertz, traction_x=shear * hertz)


def stress_of(load, box):
    """(6, nz, ny, nx), Pa."""
    data = tl.solve_response(load, tl.Pavement.half_space(ELASTIC), depths=box.depths, x=box.x, y=box.y).dataset
    return np.stack([data[f"stress_{c}"].to_numpy() for c in ("xx", "yy", "zz", "xy", "xz", "yz")])


def square_box(cell, reach=1.6, depth=1.6):
    """Cubes of a size."""
    n, rows = round(2 * reach / cell), round(depth / cell)
    return Box(n, n, cell, cell, -reach + cell / 2, -reach + cell / 2, np.linspace(0, depth, rows + 1))


def test_the_path_within_a_cell_is_of_first_order_in_its_steps():
    # Backward Euler: twice the steps, half of the error. Measured 1.7 and 1.8, rising to 2.
    box = square_box(0.4)
    stress, track = stress_of(sphere(6.0), box), Track.of(box, [yielding(50)] * 4)
    strains = [
        float(track.whole(roll(track, stress, track.virgin(), tolerance=1e-5, steps=n).states)[1].max())
        for n in (2, 4, 8, 16)
    ]
    falls = np.diff(strains)[:-1] / np.diff(strains)[1:]
    assert (np.diff(strains) > 0).all()
    assert ((falls > 1.5) & (falls < 2.2)).all()
    # Six, the default, leave 3 % on cells of four tenths of the contact's radius.
    best = strains[-1] + (strains[-1] - strains[-2])
    found = float(track.whole(roll(track, stress, track.virgin(), tolerance=1e-5).states)[1].max())
    assert abs(found - best) < 0.04 * best


def test_what_unloading_makes_yield_belongs_to_the_pass_itself():
    """Behind the box a line of material goes on to where no load is: what residual stress alone makes yield there,
    the next pass finds done. Before it did not, and took it far ahead of its load, however long the box was."""
    box = square_box(0.4, reach=2.0)
    stress, track = stress_of(sphere(7.0, shear=0.3), box), Track.of(box, [yielding(500)] * 4)
    first = roll(track, stress, track.virgin())
    strain = track.whole(first.states)[0]
    for part, state in zip(track.parts, first.states, strict=True):
        over = part.law.excess(track.residual(strain)[:, part.rows], state)
        # To the tolerance of the pass; without that way the residual stress lies 12 % above the strength.
        assert over.max() < 0.01 * YIELD


@pytest.mark.slow
@pytest.mark.parametrize("cell", [1 / 3, 1 / 5])
def test_a_load_runs_on_every_grid_or_on_none(cell):
    # Refused on cells of a third and a quarter of the contact's radius, where the box grew to 20 m in vain, and run
    # on a fifth.
    done = tl.response.roll_passes(
        sphere(7.0, shear=0.3), tl.Pavement.half_space(yielding(500)), passes=2, spacing=cell, layers=5
    )
    assert done.dataset.sizes["pass"] == 2
    assert float(done.dataset.rut_depth[-1]) > 0.02


def ribs(count, width=0.03, gap=0.01, length=0.2, peak=0.9e6):
    """Pressure of straight ribs, even across each, on cells of 2.5 x 5 mm."""
    across = count * width + (count - 1) * gap
    grid = tl.response.Grid.centred(length, across, 5e-3, 2.5e-3)
    loaded = np.mod(grid.y + across / 2, width + gap) < width
    return tl.response.GridLoad(grid, peak * loaded[:, None] * (1 - (grid.x / (length / 2)) ** 4).clip(0)[None])


SOFT = tl.Pavement.half_space(tl.materials.ElastoPlastic(tl.Elastic(600e6, 0.35), VonMises(0.4e6, kinematic=60e6)))


@pytest.mark.parametrize("count", [1, 5])
def test_the_width_of_ribs_sets_the_cell(count):
    load = ribs(count)
    problem = problem_of(load, SOFT, Zone())
    assert problem.patch == pytest.approx(0.03)
    # The longer side over 32 along, a twelfth of a rib across; the largest strain is a mean over half a rib.
    assert problem.spacing == pytest.approx(0.2 / 32, rel=0.03)
    assert problem.across == pytest.approx(0.0025)
    assert problem.mean_over == pytest.approx(0.015)
    # Cells half as large have rows half as thick at every depth; both reach as deep.
    fine = problem_of(load, SOFT, Zone((problem.spacing / 2, problem.across / 2)))
    rows, half = problem.row_edges(0.1), fine.row_edges(0.1)
    assert rows[-1] == pytest.approx(half[-1]) == pytest.approx(0.1)
    assert 1.85 < (len(half) - 1) / (len(rows) - 1) < 2.15


def test_patches_weigh_by_their_load_and_discs_are_as_wide_as_they_are():
    # A rib of 40 mm and one of 20 mm, which bears a third of the load: more than a quarter.
    pressure = np.zeros((9, 3))
    pressure[1:5], pressure[6:8] = 1.0, 1.0
    assert patch_width(
        [tl.response.GridLoad(tl.response.Grid(3, 9, 0.01, 0.01, 0.0, 0.0), pressure)]
    ) == pytest.approx(0.02)
    # A tenth of it is too little: the wide one counts.
    pressure[6:8] = 0.2
    assert patch_width(
        [tl.response.GridLoad(tl.response.Grid(3, 9, 0.01, 0.01, 0.0, 0.0), pressure)]
    ) == pytest.approx(0.04)
    # A sphere: a quarter of its load stands on chords of less than 1.7 radii.
    assert patch_width([sphere(1.0)]) == pytest.approx(1.7, abs=0.1)
    assert problem_of(tl.UniformDisc(0.1, 1e6), SOFT, Zone()).patch == pytest.approx(0.2)


def test_cells_of_twice_the_size_cover_the_same_road_and_keep_interfaces():
    layers = courses(tl.Pavement([tl.Layer(yielding(50), 0.3), tl.Layer(yielding(20), 0.5), tl.Layer(yielding(5))]))
    box = Box(7, 6, 0.1, 0.2, 1.0, -0.5, np.array([0.0, 0.1, 0.2, 0.3, 0.5, 0.8, 1.0, 1.3]))
    wide = doubled(box, layers)
    np.testing.assert_allclose(wide.edges, [0, 0.2, 0.3, 0.8, 1.3])
    assert (wide.nx, wide.ny, wide.dx, wide.dy) == (4, 3, 0.2, 0.4)
    assert wide.x.mean() == pytest.approx(box.x.mean())
    assert wide.y.mean() == pytest.approx(box.y.mean())


def test_the_largest_mean_over_a_square():
    box = Box(1, 4, 1.0, 0.5, 0.0, 0.0, np.array([0.0, 1.0, 2.0, 4.0]))
    field = np.array([[0.0, 4.0, 2.0, 0.0], [0.0, 8.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]])
    # One cell wide and half a cell deep; two cells wide and one deep; larger than the box: its mean.
    assert largest_mean(field, box, 0.5) == pytest.approx(8.0)
    assert largest_mean(field, box, 1.0) == pytest.approx(4.0)
    assert largest_mean(field, box, 1.5) == pytest.approx((0.5 * (4 + 2) + 8) * 0.5 / 2.25)
    assert largest_mean(field, box, 9.0) == pytest.approx(14 * 0.5 / 8)
    # Cells cut in two change nothing.
    finer = Box(1, 8, 1.0, 0.25, 0.0, -0.125, np.array([0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0]))
    again = np.repeat(np.repeat(field, 2, axis=0), 2, axis=1)
    for width in (0.3, 0.7, 1.0, 1.9):
        assert largest_mean(again, finer, width) == pytest.approx(largest_mean(field, box, width))


def test_the_error_of_the_grid_stands_beside_the_verdict(tmp_path):
    road, load = tl.Pavement.half_space(yielding(50)), sphere(6.0)
    done = tl.response.roll_passes(load, road, passes=2, spacing=0.4)
    data = done.dataset
    off = float(data.rut_depth_error[-1] / data.rut_depth[-1])
    assert off > 0.1
    assert f"error of the rut depth {100 * off:.2g} %" in " ".join(done.summary().split())
    (text,) = [text for text in done.warnings if "lower spacing (now 400 mm)" in text and "error of the rut" in text]
    assert f"{100 * off:.0f} %" in text
    assert "above 10 %" in text
    assert data.attrs["averaging_width"] == pytest.approx(0.5 * patch_width([load]))
    opened = tl.open_results(tl.save_results(done, tmp_path / "p.nc")).passes
    assert opened.summary() == done.summary()
    # A load that leaves nothing has no error to tell.
    assert "error of the rut depth" not in tl.response.roll_passes(sphere(2.0), road, passes=1, spacing=0.4).summary()


def test_few_cells_that_yield_have_no_error_to_tell():
    """Just above first yield, where a ball's rut grew 2.5 times on cells of two thirds while 1 % was told."""
    done = tl.response.roll_passes(sphere(3.2), tl.Pavement.half_space(yielding(20)), passes=1, spacing=0.2)
    assert float(done.dataset.rut_depth[0]) > 0
    for name in ("rut_depth_error", "peak_plastic_strain_error"):
        assert np.isnan(done.dataset[name]).all()
    assert "error of the rut depth not estimated" in " ".join(done.summary().split())
    (text,) = [text for text in done.warnings if "fewer than the 4" in text]
    assert "lower spacing (now 200 mm)" in text
    assert "not estimated (NaN) while what yields is fewer than 4 cells" in done.dataset.attrs["error_estimate"]


def test_a_pass_with_few_yielding_cells_has_no_error_and_none_has_one_where_the_last_has_few():
    few, many = np.zeros((6, 6)), np.ones((6, 6))
    few[:2, :5] = 1.0
    assert enough_cells([few, many]).tolist() == [False, True]
    assert enough_cells([many, few]).tolist() == [False, False]


@pytest.mark.slow
def test_errors_of_the_cell_fall_faster_than_its_size():
    """Steps of strain between cells resist as the square of their size; beside a small hardening less than that.

    Cells of 8, 4 and 2 mm below a rib: the rut converges as their size to the power 1.4 to 1.8.
    """
    ruts = [
        float(tl.response.roll_passes(ribs(1), SOFT, passes=1, spacing=(2 * s, s)).dataset.rut_depth[0])
        for s in (0.008, 0.004, 0.002)
    ]
    assert ruts[0] < ruts[1] < ruts[2]
    assert (ruts[1] - ruts[0]) / (ruts[2] - ruts[1]) > 2


@pytest.mark.slow
@pytest.mark.parametrize("case", ["rib", "sphere"])
def test_cells_of_half_the_size_lie_within_the_error_that_is_told(case):
    load, road = (ribs(1), SOFT) if case == "rib" else (sphere(5.2), tl.Pavement.half_space(yielding(20)))
    done = tl.response.roll_passes(load, road, passes=1).dataset
    cell = done.attrs["dx"], done.attrs["dy"]
    # The default under a sphere has no finer by half that fits in memory: seven tenths of it.
    part = 0.5 if case == "rib" else 0.7
    fine = tl.response.roll_passes(load, road, passes=1, spacing=(part * cell[0], part * cell[1])).dataset
    for name in ("rut_depth", "peak_plastic_strain"):
        error = float(done[f"{name}_error"][0])
        assert error < 0.1 * float(done[name][0])
        assert abs(float(fine[name][0] - done[name][0])) < error


@pytest.mark.slow
def test_a_pass_needs_no_more_memory_than_its_box_says():
    box = square_box(0.2)
    stress, material = stress_of(sphere(6.0), box), yielding(50)
    tracemalloc.start()
    track = Track.of(box, [material] * len(box.depths))
    roll(track, stress, track.virgin(), tolerance=1e-4)
    used = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert 0.5 * box.bytes < used < box.bytes
    # Half of what bars took with complex numbers, in single precision as well.
    assert track.bars.bytes <= 1.1 * 0.5 * box.cells.bytes
    too_fine = Box(200, 200, box.dx, box.dx, 0.0, 0.0, np.linspace(0, 1.6, 31))
    assert too_fine.too_large
    with pytest.raises(tl.InputError, match=r"needs \d+\.\d GB, above 1.5 GB; raise spacing \(now 200 mm\)"):
        too_fine.check_size()
