"""What a grid changes of passes: the path between cells, the box, the rows, and the error that is told."""

import numpy as np
import pytest

import treadload as tl
from treadload.materials import VonMises
from treadload.response.passes.box import Box
from treadload.response.passes.steady import Track, roll

ELASTIC, YIELD = tl.Elastic(1000.0, 0.3), 2.0
SHEAR_YIELD = YIELD / 3**0.5


def yielding(slope):
    """Von Mises' law with Prager's hardening, a part of the modulus."""
    return tl.ElastoPlastic(ELASTIC, VonMises(YIELD, kinematic=ELASTIC.modulus / slope))


def sphere(peak, shear=0.0):
    """Pressure of a sphere of contact radius 1 with a peak in units of k, and a shear along travel."""
    grid = tl.Grid.centred(2.1, 2.1, 2.1 / 32)
    hertz = peak * SHEAR_YIELD * np.sqrt(np.clip(1 - grid.x[None] ** 2 - grid.y[:, None] ** 2, 0, None))
    return tl.GridLoad(grid, hertz, traction_x=shear * hertz)


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
    done = tl.roll_passes(
        sphere(7.0, shear=0.3), tl.Pavement.half_space(yielding(500)), passes=2, spacing=cell, layers=5
    )
    assert done.dataset.sizes["pass"] == 2
    assert float(done.dataset.rut_depth[-1]) > 0.02
