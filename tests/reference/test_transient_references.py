"""Histories against closed forms of torsion, the steady solution and CONTACT's transient examples."""

import numpy as np
import pytest

from sliding import sliding_shear
from treadload.contact.solvers.marching import Stage, roll_transient
from treadload.contact.solvers.rolling import rigid_slip, solve_rolling
from treadload.contact.solvers.sliding import sliding_pole, sliding_torque
from treadload.validation.histories import (
    ONSET_CREEPAGES,
    ONSET_LAST,
    ONSET_SHIFT,
    ONSET_STEPS,
    arm_of,
    ball,
    compressed_in_stages,
    lubkin,
    onset,
    stuck_disc_torsion,
    turned_ball,
)

MU = 0.4


def test_torsion_without_slip():
    # Reissner & Sagoci. Shear is infinite at the rim, which is a staircase: first order in the cell, 1.5 % of
    # the torque at 32 cells across.
    errors = [abs(stuck_disc_torsion(cells, 0.3) - 1) for cells in (32, 64, 128)]
    assert errors[0] < 0.01
    assert errors[2] < 0.003
    assert errors[2] < errors[1] < errors[0]


def test_torsion_does_not_know_poisson():
    # Circumferential shear changes no volume; what is left is the staircase.
    assert stuck_disc_torsion(64, 0.0) == pytest.approx(stuck_disc_torsion(64, 0.45), rel=0.005)


def test_lubkin_has_its_limits():
    load, g, a = 3.0, 2.0, 1.5
    # Nearly all sticks: the torque is that of a stuck disc. Nearly none: 3π/16 μPa.
    angle, torque = lubkin(0.999, MU, load, g, a)
    assert torque / angle == pytest.approx(8 / 3 * g * a**3, rel=0.01)
    assert lubkin(1e-6, MU, load, g, a)[1] == pytest.approx(3 * np.pi / 16 * MU * load * a, rel=1e-9)


@pytest.mark.parametrize("stick", [0.8, 0.5, 0.2])
@pytest.mark.parametrize("increments", [1, 4])
def test_torsion_with_slip(stick, increments):
    cells, patch = 64, ball(64)
    angle, torque = lubkin(stick, MU, patch.load, 1.0, 1.0)
    found = turned_ball(cells, angle, MU, increments).last.tangential
    # Hertz' pressure is good to 7e-5 at 64 cells, and shear has no singularity.
    assert -patch.moment(found.shear) == pytest.approx(torque, rel=3e-4)
    r = np.hypot(patch.x[None, :], patch.y[:, None])
    sticking = found.stick & patch.contact
    assert r[sticking].max() < stick + 1 / cells
    assert r[patch.contact & ~sticking].min() > stick - 1 / cells


def test_full_sliding_torque():
    patch = ball(64)
    bound = MU * patch.normal.pressure
    exact = 3 * np.pi / 16 * MU * patch.load
    assert sliding_pole(bound, patch.x, patch.y) == pytest.approx((0, 0), abs=1e-8)
    # The error of Hertz' pressure at 64 cells.
    assert sliding_torque(bound, patch.x, patch.y, patch.cell, (0.0, 0.0)) == pytest.approx(exact, rel=1e-4)
    # Far beyond the angle at which a hundredth of the radius sticks.
    angle = 3 * lubkin(0.01, MU, patch.load, 1.0, 1.0)[0]
    found = turned_ball(64, angle, MU).last.tangential
    assert -patch.moment(found.shear) == pytest.approx(exact, rel=1e-4)
    assert not (found.stick & patch.contact).any()
    expected = sliding_shear(bound, angle * arm_of(patch.x, patch.y))
    np.testing.assert_allclose(found.shear, expected, atol=1e-3 * bound.max())


@pytest.mark.parametrize("direction", np.radians([0, 30, 135, 250]))
@pytest.mark.parametrize("spin", [0.0, 0.5])
def test_gross_sliding_in_any_direction(direction, spin):
    patch = ball(32)
    # A hundred times the creepage at which the last cell lets go: elastic slip turns the shear by a hundredth.
    size = 100 * MU * patch.load
    rigid = rigid_slip(
        patch.x, patch.y, patch.influence.dx, (size * np.cos(direction), size * np.sin(direction)), spin * size
    )
    bound = MU * patch.normal.pressure
    found = solve_rolling(patch.influence, bound, rigid, (None, None))
    assert not (found.stick & patch.contact).any()
    np.testing.assert_allclose(found.shear, sliding_shear(bound, rigid), atol=0.01 * bound.max())


@pytest.mark.parametrize(("creepages", "spin"), [((-1.0, 0.0), 0.0), ((-0.8, -0.4), 0.4), ((0.0, 0.7), -0.5)])
def test_a_march_ends_in_steady_rolling(creepages, spin):
    patch = ball(16)
    scale = 0.4 * MU * patch.load
    creepages, spin, travel = (scale * creepages[0], scale * creepages[1]), scale * spin, patch.influence.dx
    steady = patch.roll(MU, creepages, spin, tolerance=1e-10).shear
    slip = rigid_slip(patch.x, patch.y, travel, creepages, spin) * travel
    step = Stage(slip, (None, None), MU, travel, pressure=patch.normal.pressure)
    solution = roll_transient(patch.influence, [step] * 128, tolerance=1e-9)
    apart = [
        float(np.linalg.norm(state.tangential.shear - steady) / np.linalg.norm(steady)) for state in solution.states
    ]
    # Every length of the contact (16 steps) forgets four fifths of what was: 2 % after three, 1e-5 after eight.
    # The fixed point of steps of one cell is the steady equation itself, so nothing but the tolerance remains.
    assert apart[47] < 0.02
    assert apart[-1] < 2e-5
    assert apart[79] < 0.08 * apart[47]


@pytest.mark.parametrize("part", [0.37, 0.5, 2.0])
def test_steps_of_any_length_end_near_steady_rolling(part):
    patch = ball(16)
    force = (0.5 * MU * patch.load, 0.2 * MU * patch.load)
    steady = patch.roll(MU, forces=force, tolerance=1e-9)
    travel = part * patch.influence.dx
    step = Stage(np.zeros((2, 1, 1)), force, MU, travel, pressure=patch.normal.pressure)
    solution = roll_transient(patch.influence, [step] * int(64 / part), keep="last")
    # The error of the steady equation is of first order in the step, and a few per cent of the creepage for a 16th
    # of the contact; here two such errors differ (3.6 % measured, 2.5 % with 24 cells across).
    assert solution.creepages[-1] == pytest.approx(steady.rigid, rel=0.05 * max(1.0, part))


def test_onset_of_rolling():
    patch, solution = onset()
    assert patch.contact.sum() == 621
    # Every digit that CONTACT prints.
    assert solution.rigid[0, 0] * 1e2 == pytest.approx(ONSET_SHIFT, abs=5e-4)
    assert solution.creepages[1:10, 0] * 1e3 == pytest.approx(ONSET_CREEPAGES, abs=5e-4)
    # CONTACT's own two runs of it, rolling and world-fixed, differ in the fifth digit.
    assert solution.creepages[ONSET_STEPS, 0] * 1e3 == pytest.approx(ONSET_LAST, rel=3e-4)
    steady = patch.roll(0.4013, forces=(-0.657 * 0.4013 * 0.4705, 0.0), tolerance=1e-8)
    assert solution.creepages[ONSET_STEPS, 0] == pytest.approx(steady.rigid[0], rel=2e-5)


@pytest.mark.slow
def test_compression_of_dissimilar_bodies_in_stages():
    state = compressed_in_stages().last
    touching = state.pressure > 0
    # Every digit that CONTACT prints, and every cell.
    assert state.pressure.max() == pytest.approx(2.392e-2, abs=5e-6)
    assert state.normal.approach == pytest.approx(9.874e-2, abs=5e-6)
    assert touching.sum() == 921
    assert (touching & state.tangential.stick).sum() == 225
    # Spence: peak pressure over Hertz' of the same load 1.31, half the radius sticks; 34 cells across.
    hertz = (6 * 0.470508 * (2 * 0.004116) ** 2 / np.pi**3) ** (1 / 3)
    assert state.pressure.max() / hertz == pytest.approx(1.31, rel=0.01)
    assert np.sqrt(225 / 921) == pytest.approx(0.5, abs=0.02)
