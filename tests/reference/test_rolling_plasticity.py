"""Passes beside theory: first yield and shakedown of a rolling sphere; beside marching in steps; their cost."""

import resource
import time

import numpy as np
import pytest

import treadload as tl
from treadload.kernels.eigenstrain.operator import cells
from treadload.kernels.mixing import Anderson
from treadload.kernels.plasticity.state import State
from treadload.materials import VonMises
from treadload.response.passes.box import Box, courses, over_strength, row_edges
from treadload.response.passes.melan import melan_factor
from treadload.response.passes.steady import Track, roll
from treadload.response.passes.verdict import judged

ELASTIC, YIELD = tl.Elastic(1000.0, 0.3), 2.0
PRAGER = tl.materials.ElastoPlastic(ELASTIC, VonMises(YIELD, kinematic=ELASTIC.modulus / 50))
SHEAR_YIELD = YIELD / 3**0.5


def hertz(peak, cells_across=64):
    """Pressure of a sphere of contact radius 1, rolling without friction."""
    grid = tl.response.Grid.centred(2.1, 2.1, 2.1 / cells_across)
    radius = grid.x[None] ** 2 + grid.y[:, None] ** 2
    return tl.response.GridLoad(grid, peak * np.sqrt(np.clip(1 - radius, 0, None)))


def box_of(n, rows, reach=1.5, depth=1.5):
    dx = 2 * reach / n
    return Box(
        n,
        n,
        dx,
        dx,
        -reach + dx / 2,
        -reach + dx / 2,
        row_edges(courses(tl.Pavement.half_space(PRAGER)), dx, depth, rows),
    )


def stress_of(load, box, x=None):
    x = box.x if x is None else x
    data = tl.solve_response(load, tl.Pavement.half_space(ELASTIC), depths=box.depths, x=x, y=box.y).dataset
    return np.stack([data[f"stress_{c}"].to_numpy() for c in ("xx", "yy", "zz", "xy", "xz", "yz")])


def test_a_sphere_first_yields_at_1_6_times_the_yield_stress():
    # Theory: 1.61 Y at ν = 0.3, 0.48 a deep. Cells miss the peak by a little.
    box = box_of(24, 14)
    material = tl.materials.ElastoPlastic(ELASTIC, VonMises(YIELD))
    factor = 1 / (1 + over_strength(material, stress_of(hertz(1.0), box)).max())
    assert 1.60 < factor / YIELD < 1.65


def test_a_rolling_sphere_comes_to_rest_below_melans_4_68_k():
    # Without friction: Johnson (1985), Contact Mechanics, section 9.2. One line of material below the middle, sampled
    # finely: the largest shear of Hertz, half a radius deep.
    depths, x = np.linspace(0.25, 0.5, 26), np.linspace(-1.6, 1.6, 161)
    data = tl.solve_response(hertz(1.0), tl.Pavement.half_space(ELASTIC), depths=depths, x=x, y=np.zeros(1)).dataset
    stress = np.stack([data[f"stress_{c}"].to_numpy() for c in ("xx", "yy", "zz", "xy", "xz", "yz")])
    road = Track.of(Box(161, 1, 0.02, 0.02, -1.6, 0.0, np.linspace(0.245, 0.505, 27)), [PRAGER] * 26)
    assert melan_factor(road, stress) / SHEAR_YIELD == pytest.approx(4.68, rel=3e-3)


@pytest.mark.slow
@pytest.mark.parametrize("load", [4.5, 4.7, 4.9])
def test_plastic_flow_under_a_rolling_sphere_dies_out_at_4_7_k_and_goes_on_at_4_9_k(load):
    box = box_of(24, 10)
    stress, track = stress_of(hertz(load * SHEAR_YIELD), box), Track.of(box, [PRAGER] * 10)
    # Cells of a/8 miss the largest shear: by Melan's theorem they come to rest up to 4.71 k.
    limit = load * melan_factor(track, stress)
    assert limit == pytest.approx(4.71, rel=2e-3)
    assert (load < limit) == (load < 4.8)
    states, added, left = track.virgin(), [], []
    for _ in range(12):
        before = track.whole(states)
        states = roll(track, stress, states).states
        after = track.whole(states)
        added.append(float((after[1] - before[1]).max()) / track.yield_strain)
        left.append(float(np.abs(after[0] - before[0]).max()) / track.yield_strain)
    falls = np.array(added[1:]) / added[:-1]
    if load == 4.5:
        # Well below the limit flow dies out geometrically.
        assert (falls[-6:] < 0.6).all()
        assert judged(added, left, 1.0) == "shakedown"
    elif load == 4.7:
        # So near its limit flow dies out slowly, in every pass.
        assert (falls < 0.96).all()
        assert added[-1] < 0.01 * added[0]
    else:
        assert (falls[-6:] > 0.97).all()
        assert added[-1] > 0.05 * added[0]
        assert judged(added, left, 1.0) in ("cyclic", "ratchetting")


def marched(box, load, material, long, steps):
    """Plastic strain that a load leaves in a world-fixed grid as it moves on cell by cell, and products."""
    world = Box(long, box.ny, box.dx, box.dy, 0.0, box.y0, box.edges)
    operator = cells(world.cells, ELASTIC.shear_modulus, 0.3, averaged=True, along=long)
    law, state, products = material.return_map(), State.virgin((len(box.depths), box.ny, long)), 0
    offsets = np.arange(-long, 2 * long) * box.dx
    wide = stress_of(load, box, offsets)
    for place in steps:
        stress = wide[..., long - place : 2 * long - place]
        change, mixing = np.zeros_like(state.strain), Anderson(15)
        for _ in range(60):
            guess = state.strain + change
            products += 1
            trial = stress + operator(guess) + law.elastic(change)
            after = law(trial, state)
            found = after.strain - state.strain
            if np.linalg.norm(found - change) <= 1e-4 * max(np.linalg.norm(found), 1e-9):
                break
            change = mixing.next(change, found)
        state = after
    return state.strain, products


@pytest.mark.slow
@pytest.mark.parametrize("slope", [5, 50])
def test_a_whole_pass_is_what_marching_leaves_at_a_twentieth_of_the_products(slope):
    # Stress is the mean over cells. Read at their centres it lets neighbours flow in turn as a march goes on: at a
    # fiftieth of the modulus both are then 21 % apart.
    n, rows, material = 16, 6, tl.materials.ElastoPlastic(ELASTIC, VonMises(YIELD, kinematic=ELASTIC.modulus / slope))
    box = box_of(n, rows, reach=1.6, depth=1.2)
    load = hertz(4.5 * SHEAR_YIELD)
    track = Track.of(box, [material] * rows)
    # Both read the path of material at the same places, whole cells from the load.
    stress = stress_of(load, box, (np.arange(n) - n // 2) * box.dx)
    # A march moves the load by whole cells: one step of the return map each.
    done = roll(track, stress, track.virgin(), tolerance=1e-4, steps=1)
    left = track.whole(done.states)[0]
    found, products = marched(box, load, material, 40, range(6, 36))
    # Where the march began is forgotten after three radii, to 0.5 %.
    middle = found[..., 26:30].mean(axis=-1)
    assert np.linalg.norm(middle - left) < 0.01 * np.linalg.norm(left)
    assert products >= 20 * done.rounds


@pytest.mark.slow
def test_a_pass_on_64_64_16_takes_fifteen_seconds_and_a_gigabyte():
    box = box_of(64, 16)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    stress, track = stress_of(hertz(4.9 * SHEAR_YIELD), box), Track.of(box, [PRAGER] * 16)
    start = time.process_time()
    done = roll(track, stress, track.virgin())
    assert done.rounds < 40
    assert time.process_time() - start <= 15
    # All that the pass and its operator took; kB on Linux.
    assert (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) * 1024 <= 1e9
