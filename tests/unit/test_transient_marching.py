"""The march through a history: kernels ahead of the cells, steps, starts, and what it refuses."""

import numpy as np
import pytest

from sliding import sliding_shear
from treadload.contact.bodies.ahead import Ahead
from treadload.contact.bodies.half_space import HalfSpaces
from treadload.contact.bodies.influence import Influence
from treadload.contact.solvers.marching import Stage, march, roll_transient
from treadload.contact.solvers.shift import solve_shift
from treadload.contact.solvers.sliding import sliding_pole, sliding_torque
from treadload.errors import InputError
from treadload.kernels.half_space.rectangle import CombinedElasticity
from treadload.validation.patches import centres, paraboloid

RNG = np.random.default_rng(7)
BODIES = CombinedElasticity(1.0, 0.3, 0.2)
INFLUENCE = Influence((13, 17), 0.2, 0.3, HalfSpaces(BODIES))
SHEAR, PRESSURE = RNG.normal(size=(2, 13, 17)), RNG.random((13, 17))
PATCH = paraboloid(CombinedElasticity(1e6, 0.4, 0.0), (0.3, 0.5), 50.0, (24, 26), (3e-3, 3e-3))
STILL = np.zeros((2, 1, 1))
MU = 0.6


def test_ahead_by_nothing_is_the_displacement_itself():
    here = Ahead(INFLUENCE, 0.0)
    expected = INFLUENCE.displacement(PRESSURE, SHEAR)
    np.testing.assert_allclose(here(SHEAR, PRESSURE), expected[:2], atol=1e-13)
    np.testing.assert_allclose(here(SHEAR) + here.by_pressure(PRESSURE), expected[:2], atol=1e-13)
    np.testing.assert_allclose(here.gap(SHEAR), INFLUENCE.gap_by_shear(SHEAR), atol=1e-13)


@pytest.mark.parametrize("cells", [1, 5, 20])
def test_ahead_by_whole_cells_is_the_displacement_of_a_larger_grid(cells):
    wide = Influence((13, 40), 0.2, 0.3, HalfSpaces(BODIES))
    shear, pressure = np.zeros((2, 13, 40)), np.zeros((13, 40))
    shear[..., :17], pressure[:, :17] = SHEAR, PRESSURE
    expected = wide.displacement(pressure, shear)[:2, :, cells : cells + 17]
    np.testing.assert_allclose(Ahead(INFLUENCE, 0.2 * cells)(SHEAR, PRESSURE), expected, atol=1e-13)


@pytest.mark.parametrize("quarter", [1, 3, 5, 7])
def test_ahead_by_a_part_of_a_cell_is_the_displacement_of_finer_cells(quarter):
    # Centres of cells of half the size lie a quarter ahead of and behind those of the whole.
    fine = Influence((13, 52), 0.1, 0.3, HalfSpaces(BODIES))
    shear, pressure = np.zeros((2, 13, 52)), np.zeros((13, 52))
    shear[..., :34], pressure[:, :34] = SHEAR.repeat(2, -1), PRESSURE.repeat(2, -1)
    expected = fine.displacement(pressure, shear)[:2, :, (quarter + 1) // 2 :: 2][..., :17]
    np.testing.assert_allclose(Ahead(INFLUENCE, 0.05 * quarter)(SHEAR, PRESSURE), expected, atol=1e-13)


def test_ahead_by_half_a_cell_meets_the_corners_and_stays_smooth():
    middle, below, above = (Ahead(INFLUENCE, 0.1 + d)(SHEAR, PRESSURE) for d in (0.0, -1e-9, 1e-9))
    assert np.isfinite(middle).all()
    # The slope at a cell's edge is a logarithm: 1e-9 cells make about 20 times as much.
    np.testing.assert_allclose(middle, 0.5 * (below + above), atol=1e-6)


def test_like_bodies_feel_no_pressure():
    alike = Ahead(Influence((13, 17), 0.2, 0.3, HalfSpaces(CombinedElasticity(1.0, 0.3, 0.0))), 0.1)
    assert not alike.by_pressure(PRESSURE).any()
    assert not alike.gap(SHEAR).any()


@pytest.mark.parametrize("force", [(0.5, 0.0), (0.3, -0.6)])
def test_one_step_of_no_travel_is_a_shift(force):
    forces = tuple(f * MU * PATCH.load for f in force)
    step = Stage(STILL, forces, MU, pressure=PATCH.normal.pressure)
    marched = roll_transient(PATCH.influence, [step], tolerance=1e-8)
    bound = MU * PATCH.normal.pressure
    shifted = solve_shift(PATCH.influence, bound, np.zeros((2, *bound.shape)), forces, tolerance=1e-8)
    np.testing.assert_allclose(marched.last.tangential.shear, shifted.shear, atol=1e-6 * bound.max())
    assert marched.last.displaced == pytest.approx(shifted.rigid, rel=1e-6)
    carried = marched.last.tangential.shear.sum((1, 2)) * PATCH.influence.dx * PATCH.influence.dy
    np.testing.assert_allclose(carried, forces, atol=1e-8 * MU * PATCH.load)
    assert np.isnan(marched.creepages).all()


def test_a_force_held_changes_nothing_more():
    step = Stage(STILL, (0.5 * MU * PATCH.load, 0.0), MU, pressure=PATCH.normal.pressure)
    solution = roll_transient(PATCH.influence, [step] * 3, tolerance=1e-9)
    assert np.abs(solution.rigid[1:]).max() < 1e-6 * abs(solution.rigid[0, 0])


def test_a_history_goes_on_from_a_state():
    step = Stage(np.reshape([-2e-5, 1e-5], (2, 1, 1)), (None, None), MU, 3e-3, pressure=PATCH.normal.pressure)
    whole = roll_transient(PATCH.influence, [step] * 4, tolerance=1e-9)
    first = roll_transient(PATCH.influence, [step] * 2, keep="last", tolerance=1e-9)
    assert len(whole.states) == 4
    assert len(first.states) == 1
    rest = roll_transient(PATCH.influence, [step] * 2, before=first.last, tolerance=1e-9)
    np.testing.assert_allclose(
        rest.last.tangential.shear, whole.last.tangential.shear, atol=1e-6 * PATCH.normal.pressure.max()
    )


def test_friction_may_be_a_map_or_a_function():
    p = PATCH.normal.pressure
    by_number = Stage(STILL, (10.0, 0.0), MU, pressure=p)
    by_map = Stage(STILL, (10.0, 0.0), np.full(p.shape, MU), pressure=p)
    by_function = Stage(STILL, (10.0, 0.0), lambda pressure: MU * pressure, pressure=p)
    found = [roll_transient(PATCH.influence, [stage]).rigid for stage in (by_number, by_map, by_function)]
    np.testing.assert_allclose(found[1], found[0])
    np.testing.assert_allclose(found[2], found[0])


def test_a_load_is_as_good_as_its_pressure():
    x, y = PATCH.x, PATCH.y
    gap = x[None, :] ** 2 / 0.6 + y[:, None] ** 2 / 1.0
    slip = np.reshape([-2e-5, 0.0], (2, 1, 1))
    by_load = Stage(slip, (None, None), MU, 3e-3, load=PATCH.load)
    by_pressure = Stage(slip, (None, None), MU, 3e-3, pressure=PATCH.normal.pressure)
    one = roll_transient(PATCH.influence, [by_load] * 2, gap=gap).last
    other = roll_transient(PATCH.influence, [by_pressure] * 2).last
    np.testing.assert_allclose(one.tangential.shear, other.tangential.shear, atol=1e-4 * other.pressure.max())


def test_what_the_march_refuses():
    p = PATCH.normal.pressure
    with pytest.raises(InputError, match="forward"):
        Stage(STILL, (None, None), MU, -1e-3, pressure=p)
    with pytest.raises(InputError, match="finite"):
        Stage(np.full((2, 1, 1), np.nan), (None, None), MU, pressure=p)
    with pytest.raises(InputError, match="only one"):
        Stage(STILL, (None, None), MU, pressure=p, load=3.0)
    with pytest.raises(InputError, match="gap"):
        next(march(PATCH.influence, [Stage(STILL, (None, None), MU, load=3.0)]))
    with pytest.raises(InputError, match="no cell can carry"):
        next(march(PATCH.influence, [Stage(STILL, (1.0, None), 0.0, pressure=p)]))
    with pytest.raises(InputError, match="at least one step"):
        roll_transient(PATCH.influence, [])
    with pytest.raises(InputError, match="keep"):
        roll_transient(PATCH.influence, [], keep="some")


@pytest.mark.parametrize("axes", [(1.0, 1.0), (1.25, 0.8)])
def test_sliding_about_the_pole_needs_no_force(axes):
    x, y = centres(31, 1.0), centres(25, 1.0)
    bound = np.exp(-((x[None, :] - 4.2) ** 2) / 40 - (y[:, None] + 2.3) ** 2 / 60) * (1 + 0.1 * x[None, :])
    bound = np.maximum(bound, 0)
    pole = sliding_pole(bound, x, y, axes)
    w = np.stack(np.broadcast_arrays(pole[1] - y[:, None], x[None, :] - pole[0]))
    q = sliding_shear(bound, w, axes)
    # The cell around the pole gives no direction: a hundredth of all.
    assert np.abs(q.sum((1, 2))).max() < 0.01 * bound.sum()
    torque = sliding_torque(bound, x, y, 1.0, pole, axes)
    assert torque == pytest.approx(-(w * q).sum(), rel=1e-12)
    for off in ((0.5, 0.0), (0.0, 0.5), (-0.5, 0.5)):
        assert sliding_torque(bound, x, y, 1.0, (pole[0] + off[0], pole[1] + off[1]), axes) > torque
