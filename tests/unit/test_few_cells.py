"""Contacts of a few cells, of strong coupling and of small creepages."""

from dataclasses import replace

import numpy as np
import pytest

from fuzz.direct_sums import DirectSums
from treadload.contact.bodies.half_space import HalfSpaces
from treadload.contact.bodies.influence import Influence
from treadload.contact.rolling_state import Rolling
from treadload.contact.solvers.coupling import Start, Surfaces, solve_coupled
from treadload.contact.solvers.marching import Stage, roll_transient
from treadload.contact.solvers.normal import solve_normal
from treadload.contact.solvers.rolling import solve_rolling
from treadload.contact.solvers.shift import solve_shift
from treadload.grid import Grid
from treadload.kernels.half_space.rectangle import CombinedElasticity

DX = 1e-3
# Rubber that keeps half of its volume against steel: Dundurs' β is 0.29.
UNLIKE = CombinedElasticity.of(1e6, 0.3, 1e11, 0.3)
STILL = np.zeros((2, 1, 1))


def sphere(cells, radius=0.02, off=0.0):
    x = DX * (np.arange(cells) - (cells - 1) / 2)
    return ((x[None, :] - off) ** 2 + x[:, None] ** 2) / (2 * radius)


def influence(cells, bodies=UNLIKE):
    return Influence((cells, cells), DX, DX, HalfSpaces(bodies))


def direct(state, gap, bodies=UNLIKE):
    """Gap before the approach (ny, nx), m, by sums over pairs of cells."""
    sums = DirectSums(gap.shape, DX, DX, bodies.shear_modulus, bodies.poisson, bodies.difference)
    opening = sums.opening_by_pressure @ state.pressure.ravel()
    return gap + (opening + sums.opening_by_shear @ state.tangential.shear.ravel()).reshape(gap.shape)


@pytest.mark.parametrize(("load", "most"), [(0.01, 1), (0.1, 5), (0.4, 9)])
def test_gap_and_approach_are_those_of_the_shear_returned(load, most):
    # Shear that opens all cells in contact alike moves the approach and no pressure.
    gap = sphere(9)
    shift = [Stage(np.reshape([s, 0.0], (2, 1, 1)), (None, None), 0.5, load=load) for s in (0.0, 2e-6, 2e-6)]
    turned = [Stage(STILL, (f * load, -0.2 * load), 0.5, load=load) for f in (0.1, -0.3)]
    for stages in (shift, turned):
        for state in roll_transient(influence(9), stages, gap=gap).states:
            opened, normal = direct(state, gap), state.normal
            pressed = state.pressure > 0
            assert 0 < pressed.sum() <= most
            scale = normal.approach - opened.min() + np.ptp(opened[pressed])
            scale = max(scale, normal.approach)
            np.testing.assert_allclose(opened[pressed], normal.approach, atol=2e-6 * scale)
            np.testing.assert_allclose(normal.gap, opened - normal.approach, atol=2e-6 * scale)
            assert normal.gap.min() >= -2e-6 * scale


def test_one_cell_carries_its_force_from_a_start_far_away():
    # A start beyond friction, with slips of an earlier step: Newton's method alone carries them farther away.
    bound = np.zeros((3, 3))
    bound[1, 1] = 5.0
    forces = tuple(share * 5.0 * DX**2 for share in (0.04, 0.4))
    rigid = np.zeros((2, 3, 3))
    still = solve_shift(influence(3), bound, rigid, forces)
    far = replace(still, shear=np.full((2, 3, 3), 6.0), rigid=(10 * still.rigid[1], -12 * still.rigid[1]))
    found = solve_shift(influence(3), bound, rigid, forces, start=far)
    np.testing.assert_allclose(found.shear[:, 1, 1], [0.2, 2.0], rtol=1e-9)
    assert found.rigid == pytest.approx(still.rigid, rel=1e-6)


def test_two_cells_that_slip_apart_under_no_force():
    # Bounds that differ by round-off of the pressure: the larger cell sticks, a micrometre of rigid slip away.
    bound = np.zeros((4, 3))
    bound[1, 1], bound[2, 1] = 5.0, 5.0 * (1 + 3e-7)
    rigid = np.zeros((2, 4, 3))
    rigid[1, 1, 1], rigid[1, 2, 1] = 1e-6, -1e-6
    found = solve_shift(Influence((4, 3), DX, DX, HalfSpaces(UNLIKE)), bound, rigid, (0.0, 0.0))
    assert found.residual <= 1e-6
    assert abs(found.shear[1].sum()) <= 1e-8 * bound.sum()
    assert found.stick[2, 1]
    assert not found.stick[1, 1]
    # What sticks does not move: its rigid slip makes up for the other's, to what the two cells deflect.
    assert found.rigid[1] == pytest.approx(1e-6, rel=0.02)


@pytest.mark.parametrize("slip", [1e-4, 1e-3])
def test_strong_friction_between_unlike_bodies_settles(slip):
    # Plain alternation circles: shear of five times the pressure moves the pressure by more than there was.
    bodies = CombinedElasticity.of(1e6, 0.0, 1e11, 0.3)
    # Dundurs' β.
    assert bodies.difference / (1 - bodies.poisson) > 0.49
    x = DX * (np.arange(9) - 4)
    gap = np.where(np.hypot(x[None, :], x[:, None]) < 2.5 * DX, 0.0, np.nan)
    stage = Stage(np.reshape([slip, 0.4 * slip], (2, 1, 1)), (None, None), 5.0, load=0.5)
    state = roll_transient(influence(9, bodies), [stage], gap=gap).last
    opened, pressed = direct(state, gap, bodies), state.pressure > 0
    assert state.change <= 1e-6
    assert np.ptp(opened[pressed]) <= 4e-6 * np.nanmax(np.abs(opened))


def test_a_start_with_shear_leaves_none_where_there_is_no_friction_now():
    gap = sphere(12)
    grid = Grid(12, 12, DX, DX, -5.5 * DX, -5.5 * DX)

    def solve(friction, start=None):
        rolling = Rolling(normal_load=1.0, friction=friction, creepage_x=0.01)
        return solve_coupled(influence(12), Surfaces(grid, gap), rolling, check=lambda p: None, start=start)

    rubbed = solve(0.8)
    start = Start(rubbed.normal.pressure, rubbed.slipping.tangential)
    smooth, cold = solve(0.0, start).normal, solve(0.0).normal
    # Both are pressed to 1e-6 of the approach.
    np.testing.assert_allclose(smooth.pressure, cold.pressure, atol=2e-5 * cold.pressure.max())
    assert smooth.approach == pytest.approx(cold.approach, rel=2e-6)
    assert abs(rubbed.normal.approach / cold.approach - 1) > 1e-3


@pytest.mark.parametrize("friction", [0.3, 5.0])
def test_the_force_of_a_small_creepage_is_proportional_to_it(friction):
    # Where nothing slips the problem is linear, but for the thin rim at the trailing edge.
    like = CombinedElasticity(1e6, 0.4, 0.0)
    patch = influence(24, like)
    pressure = solve_normal(patch, sphere(24), load=10.0).pressure
    forces = []
    for creepage in (1e-10, 1e-7, 1e-5):
        rigid = np.broadcast_to(np.reshape([creepage, 0.3 * creepage], (2, 1, 1)), (2, 24, 24)).copy()
        solution = solve_rolling(patch, friction * pressure, rigid, (None, None))
        forces.append(solution.shear.sum((1, 2)) / creepage)
        assert solution.residual <= 1e-6
    # To 1e-4 of the shear; against the residual alone those of 1e-7 were 18 % off, those of 1e-10 zero.
    np.testing.assert_allclose(forces[1], forces[0], rtol=2e-4)
    np.testing.assert_allclose(forces[2], forces[0], rtol=3e-3)
