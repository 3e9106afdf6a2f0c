"""solve_rolling and solve_shift: forces and creepages, limits of friction, starts, and what they raise."""

import functools

import numpy as np
import pytest

from treadload.contact.bodies.half_space import HalfSpaces
from treadload.contact.bodies.influence import Influence
from treadload.contact.solvers import tangential
from treadload.contact.solvers.rolling import rigid_slip, solve_rolling
from treadload.contact.solvers.shift import solve_shift
from treadload.errors import ConvergenceError
from treadload.kernels.half_space.rectangle import CombinedElasticity
from treadload.validation.patches import paraboloid

BODIES = CombinedElasticity(1e6, 0.4, 0.0)
PATCH = paraboloid(BODIES, (0.3, 0.5), 50.0, (34, 30), (2e-3, 2e-3))
MU = 0.6
LIMIT = MU * PATCH.load


@pytest.mark.parametrize("fractions", [(0.3, 0.0), (-0.5, 0.2), (0.0, 0.7), (0.6, -0.6)])
@pytest.mark.parametrize("spin", [0.0, 0.4])
def test_forces_and_creepages_are_two_ways_to_ask_the_same(fractions, spin):
    forces = tuple(f * LIMIT for f in fractions)
    by_force = PATCH.roll(MU, spin=spin, forces=forces, tolerance=1e-9)
    np.testing.assert_allclose(PATCH.force(by_force.shear), forces, atol=1e-8 * LIMIT)
    by_creepage = PATCH.roll(MU, by_force.rigid, spin, tolerance=1e-9)
    np.testing.assert_allclose(by_creepage.shear, by_force.shear, atol=1e-6 * (MU * PATCH.normal.pressure).max())
    assert by_creepage.rigid == (0.0, 0.0)


@pytest.mark.parametrize("component", [0, 1])
def test_one_force_and_one_creepage(component):
    forces, creepages = [None, None], [0.0, 0.0]
    forces[component], creepages[1 - component] = 0.4 * LIMIT, -0.01
    mixed = PATCH.roll(MU, tuple(creepages), forces=tuple(forces), tolerance=1e-9)
    assert PATCH.force(mixed.shear)[component] == pytest.approx(0.4 * LIMIT, rel=1e-8)
    assert mixed.rigid[1 - component] == 0.0
    creepages[component] = mixed.rigid[component]
    alone = PATCH.roll(MU, tuple(creepages), tolerance=1e-9)
    np.testing.assert_allclose(alone.shear, mixed.shear, atol=1e-6 * (MU * PATCH.normal.pressure).max())


def test_a_driving_wheel_has_negative_creepage():
    found = PATCH.roll(MU, forces=(0.3 * LIMIT, 0.0))
    assert found.rigid[0] < 0
    assert abs(found.rigid[1]) < 1e-6 * abs(found.rigid[0])


def test_stick_lies_next_to_the_leading_edge():
    found = PATCH.roll(MU, forces=(0.5 * LIMIT, 0.0))
    middle = PATCH.contact.shape[0] // 2
    stick = found.stick[middle][PATCH.contact[middle]]
    # Along travel: slip first, then stick up to the edge at large x.
    assert not stick[0]
    assert stick[-1]
    assert (np.diff(stick.astype(int)) >= 0).all()


def test_spin_alone_makes_a_lateral_force():
    spun = PATCH.roll(MU, spin=0.5, forces=(None, None))
    along, across = PATCH.force(spun.shear)
    # Kalker: Q_y = -c³G C23 φ.
    assert across < -0.01 * LIMIT
    assert abs(along) < 1e-3 * abs(across)
    turned = PATCH.roll(MU, spin=-0.5, forces=(None, None))
    assert PATCH.force(turned.shear)[1] == pytest.approx(-across, rel=1e-6)


def test_with_endless_friction_nothing_slips():
    found = PATCH.roll(1e6, (-0.02, 0.01), tolerance=1e-12)
    assert found.stick[PATCH.contact].all()
    assert not found.slip.any()


def test_without_friction_nothing_is_carried():
    found = PATCH.roll(0.0, (-0.02, 0.01))
    assert not found.shear.any()
    assert not found.stick.any()
    np.testing.assert_array_equal(found.slip, rigid_slip(PATCH.x, PATCH.y, 2e-3, (-0.02, 0.01), 0.0))


def test_the_force_grows_with_creepage_towards_sliding():
    forces = [-PATCH.force(PATCH.roll(MU, (xi, 0.0)).shear)[0] / LIMIT for xi in (0.001, 0.01, 0.03, 0.1, 0.5, 3.0)]
    assert (np.diff(forces) > 0).all()
    assert forces[0] > 0
    # At a creepage of 3 the elastic slip turns the shear by less than 1 %.
    assert 0.9999 < forces[-1] <= 1.0


@pytest.mark.parametrize("fraction", [0.9, 0.99, 0.999])
def test_close_to_gross_sliding(fraction):
    found = PATCH.roll(MU, forces=(fraction * LIMIT, 0.0))
    assert PATCH.force(found.shear)[0] == pytest.approx(fraction * LIMIT, rel=1e-5)


def test_a_start_changes_the_work_and_not_the_answer():
    rigid = rigid_slip(PATCH.x, PATCH.y, 2e-3, (0.0, 0.0), 0.0)
    bound = MU * PATCH.normal.pressure
    near = solve_rolling(PATCH.influence, bound, rigid, (0.30 * LIMIT, 0.0), tolerance=1e-8)
    warm = solve_rolling(PATCH.influence, bound, rigid, (0.31 * LIMIT, 0.0), start=near, tolerance=1e-8)
    cold = solve_rolling(PATCH.influence, bound, rigid, (0.31 * LIMIT, 0.0), tolerance=1e-8)
    np.testing.assert_allclose(warm.shear, cold.shear, atol=1e-5 * bound.max())


def test_unused_margin_does_not_matter():
    wide = paraboloid(BODIES, (0.3, 0.5), 50.0, (44, 48), (2e-3, 2e-3))
    found = wide.roll(MU, forces=(0.4 * LIMIT, 0.0), tolerance=1e-9)
    narrow = PATCH.roll(MU, forces=(0.4 * LIMIT, 0.0), tolerance=1e-9)
    inner = found.shear[:, 5:-5, 9:-9]
    np.testing.assert_allclose(inner, narrow.shear, atol=1e-5 * (MU * PATCH.normal.pressure).max())
    assert found.rigid == pytest.approx(narrow.rigid, rel=1e-5)


def test_rolling_falls_back_on_splitting(monkeypatch):
    """Where Newton's method does not settle, the slow way does."""
    wanted = PATCH.roll(MU, forces=(0.4 * LIMIT, 0.0))
    real = tangential.coulomb_newton.solve

    def stalled(*args, **kwargs):
        return real(*args, **{**kwargs, "max_iterations": 0})

    monkeypatch.setattr(tangential.coulomb_newton, "solve", stalled)
    found = PATCH.roll(MU, forces=(0.4 * LIMIT, 0.0))
    assert found.newton == 0
    assert found.splitting > 0
    np.testing.assert_allclose(found.shear, wanted.shear, atol=1e-4 * (MU * PATCH.normal.pressure).max())


@pytest.fixture
def fewer_steps(monkeypatch):
    """A quarter of Newton's steps and a 25th of those of splitting: for what cannot converge, and is raised then."""
    newton, split = tangential.coulomb_newton.solve, tangential.coulomb_splitting.split
    for module, name, real, steps in (
        (tangential.coulomb_newton, "solve", newton, 15),
        (tangential.coulomb_splitting, "split", split, 200),
    ):
        monkeypatch.setattr(module, name, functools.partial(real, max_iterations=steps))


@pytest.mark.usefixtures("fewer_steps")
@pytest.mark.parametrize(
    ("part", "remedy"), [(0.5, "raise the tolerance"), (0.95, "95 % of friction: prescribe the creepage instead")]
)
def test_rolling_says_how_far_it_came(part, remedy):
    with pytest.raises(ConvergenceError, match=remedy) as caught:
        PATCH.roll(MU, forces=(part * LIMIT, 0.0), tolerance=1e-18)
    assert 0 < caught.value.residual < 1e-6


@pytest.mark.parametrize("fractions", [(0.4, 0.0), (-0.2, 0.6)])
def test_shift_by_force_and_by_distance(fractions):
    bound = MU * PATCH.normal.pressure
    forces = tuple(f * LIMIT for f in fractions)
    none = np.zeros((2, *bound.shape))
    by_force = solve_shift(PATCH.influence, bound, none, forces, tolerance=1e-9)
    # The rigid shift of the start lets most cells stick, from where the fast way leads on.
    assert by_force.splitting == 0
    np.testing.assert_allclose(PATCH.force(by_force.shear), forces, atol=1e-8 * LIMIT)
    rigid = none + np.array(by_force.rigid)[:, None, None]
    by_distance = solve_shift(PATCH.influence, bound, rigid, (None, None), tolerance=1e-9)
    np.testing.assert_allclose(by_distance.shear, by_force.shear, atol=1e-6 * bound.max())
    size, slip = np.hypot(*by_force.shear), by_force.slip
    assert (size <= bound * (1 + 1e-9)).all()
    assert not slip[:, by_force.stick].any()
    sliding = PATCH.contact & ~by_force.stick
    # Slip against the shear on body 1, wherever it is more than round-off of the solve.
    fast = sliding & (np.hypot(*slip) > 1e-6 * np.hypot(*slip).max())
    assert ((by_force.shear * slip).sum(0)[fast] < 0).all()


def test_a_shift_without_friction_slips_freely():
    none = np.zeros(PATCH.contact.shape)
    rigid = np.full((2, *none.shape), 1e-3)
    found = solve_shift(PATCH.influence, none, rigid, (None, None))
    assert not found.shear.any()
    np.testing.assert_array_equal(found.slip, rigid)


@pytest.mark.usefixtures("fewer_steps")
def test_a_shift_beyond_friction_does_not_converge():
    none = np.zeros((2, *PATCH.contact.shape))
    with pytest.raises(ConvergenceError, match="prescribe the shift instead") as caught:
        solve_shift(PATCH.influence, MU * PATCH.normal.pressure, none, (1.2 * LIMIT, 0.0))
    assert caught.value.residual > 1e-3


def test_single_rows_and_columns_of_cells():
    for shape in ((1, 20), (20, 1)):
        influence = Influence(shape, 2e-3, 2e-3, HalfSpaces(BODIES))
        bound = np.full(shape, 1e5)
        rigid = np.zeros((2, *shape))
        rigid[0] = -0.01
        found = solve_rolling(influence, bound, rigid, (None, 0.0))
        assert (np.hypot(*found.shear) <= bound * (1 + 1e-9)).all()
        assert found.shear[0].sum() > 0
        assert abs(found.shear[1].sum()) < 1e-3 * bound.sum()


@pytest.mark.parametrize("cells", [1, 2, 7, 12, 192])
def test_sums_to_the_leading_edge_are_running_sums(cells):
    shear = np.random.default_rng(1).normal(size=(2, 5, cells))
    expected = np.cumsum(shear[..., ::-1], axis=-1)[..., ::-1]
    np.testing.assert_allclose(tangential._summed_ahead(shear), expected, rtol=0, atol=1e-12)
