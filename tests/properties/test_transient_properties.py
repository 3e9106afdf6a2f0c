"""What every history must obey: bounds of friction, dissipation, mirrors, frames, scales."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from treadload.contact.bodies.half_space import HalfSpaces
from treadload.contact.bodies.influence import Influence
from treadload.contact.solvers.marching import Stage, roll_transient
from treadload.contact.solvers.normal import solve_normal
from treadload.kernels.half_space.rectangle import CombinedElasticity
from treadload.validation.histories import arm_of
from treadload.validation.patches import centres

CELLS, SPACING = 18, 0.01
X = centres(CELLS, SPACING)
PAIRS = {
    "like": CombinedElasticity.of(1e6, 0.3, 1e6, 0.3),
    "unlike": CombinedElasticity.of(4e5, 0.4, 2e9, 0.35),
}


def tread(seed):
    rng = np.random.default_rng(seed)
    gap = X[None, :] ** 2 / 0.5 + X[:, None] ** 2 / 0.4 + 4e-4 * rng.random((CELLS, CELLS))
    if seed % 2:
        gap[:, CELLS // 2 + 2] = np.nan
    return gap


STEPS = st.lists(
    st.tuples(
        st.sampled_from([0.0, 0.3, 1.0, 2.5]),
        st.floats(-1, 1),
        st.floats(-1, 1),
        st.floats(-5, 5),
        st.floats(40, 80),
    ),
    min_size=1,
    max_size=4,
)


def history(steps, friction=0.6):
    turn = arm_of(X, X)
    return [
        Stage(
            1e-3 * np.reshape([along, across], (2, 1, 1)) + 1e-3 * angle * turn,
            (None, None),
            friction,
            travel * SPACING,
            load=load,
        )
        for travel, along, across, angle, load in steps
    ]


@given(steps=STEPS, seed=st.integers(0, 50), pair=st.sampled_from(sorted(PAIRS)))
@settings(max_examples=12, deadline=None)
def test_friction_only_takes(steps, seed, pair):
    influence = Influence((CELLS, CELLS), SPACING, SPACING, HalfSpaces(PAIRS[pair]))
    for state in roll_transient(influence, history(steps), gap=tread(seed), tolerance=1e-7).states:
        q, s, bound = state.tangential.shear, state.tangential.slip, 0.6 * state.pressure
        assert (np.hypot(*q) <= bound * (1 + 1e-12)).all()
        # In every cell, to the tolerance of the shear.
        assert ((q * s).sum(0) <= 1e-5 * bound.max() * np.hypot(*s).max()).all()
        assert not s[:, state.tangential.stick].any()
        assert state.pressure.sum() * SPACING**2 == pytest.approx(state.stage.load, rel=1e-9)


@given(steps=STEPS, seed=st.integers(0, 50), pair=st.sampled_from(sorted(PAIRS)))
@settings(max_examples=8, deadline=None)
def test_a_mirror_turns_lateral_slip_and_spin(steps, seed, pair):
    influence = Influence((CELLS, CELLS), SPACING, SPACING, HalfSpaces(PAIRS[pair]))
    gap = tread(seed)
    mirrored = [(travel, along, -across, -angle, load) for travel, along, across, angle, load in steps]
    one = roll_transient(influence, history(steps), gap=gap, tolerance=1e-8).last
    other = roll_transient(influence, history(mirrored), gap=gap[::-1], tolerance=1e-8).last
    flipped = other.tangential.shear[:, ::-1] * np.reshape([1, -1], (2, 1, 1))
    np.testing.assert_allclose(flipped, one.tangential.shear, atol=2e-4 * one.pressure.max())


@given(steps=STEPS, seed=st.integers(0, 50))
@settings(max_examples=8, deadline=None)
def test_without_rolling_the_axes_may_be_swapped(steps, seed):
    influence = Influence((CELLS, CELLS), SPACING, SPACING, HalfSpaces(PAIRS["unlike"]))
    gap = tread(seed)
    still = [(0.0, *rest) for _, *rest in steps]
    swapped = [(0.0, across, along, -angle, load) for _, along, across, angle, load in steps]
    one = roll_transient(influence, history(still), gap=gap, tolerance=1e-8).last.tangential.shear
    other = roll_transient(influence, history(swapped), gap=gap.T, tolerance=1e-8).last
    np.testing.assert_allclose(other.tangential.shear[::-1].transpose(0, 2, 1), one, atol=2e-4 * other.pressure.max())


@pytest.mark.parametrize("pair", sorted(PAIRS))
def test_rolling_past_the_road_is_the_road_seen_to_move(pair):
    """In the frame of the contact particles run through it; in the frame of the road the wheel moves on."""
    steps, friction, load = 6, 0.6, 60.0
    bodies = PAIRS[pair]
    creep = np.reshape([-3e-4, 1e-4], (2, 1, 1))
    gap = X[None, :] ** 2 / 0.5 + X[:, None] ** 2 / 0.4
    rolling = Stage(creep * SPACING * 3, (None, None), friction, SPACING, load=load)
    moving = roll_transient(
        Influence((CELLS, CELLS), SPACING, SPACING, HalfSpaces(bodies)),
        [rolling] * (steps + 1),
        gap=gap,
        tolerance=1e-9,
    )
    long = Influence((CELLS, CELLS + steps), SPACING, SPACING, HalfSpaces(bodies))
    state = None
    for step in range(steps + 1):
        at = np.full((CELLS, CELLS + steps), np.nan)
        at[:, step : step + CELLS] = gap
        # The wheel has moved by whole cells: what sticks to the road stays in its cell.
        stage = Stage(creep * SPACING * 3, (None, None), friction, load=load)
        state = roll_transient(long, [stage], gap=at, before=_moved(state), tolerance=1e-9).last
    assert state is not None
    np.testing.assert_allclose(
        state.tangential.shear[..., steps:], moving.last.tangential.shear, atol=1e-4 * state.pressure.max()
    )


def _moved(state):
    # A step under the same load would keep the pressure where it was: nothing is known of the next one.
    if state is None:
        return None
    from dataclasses import replace

    return replace(state, normal=None)


@pytest.mark.parametrize("factor", [0.1, 7.0])
def test_scale(factor):
    """Stresses and moduli by a factor, lengths kept: the same slip, forces by the factor."""
    gap, steps = tread(2), [(0.7, -1.0, 0.4, 2.0, 60.0), (1.6, -0.5, -0.4, 0.0, 70.0)]
    one = CombinedElasticity.of(4e5, 0.4, 2e9, 0.35)
    other = CombinedElasticity.of(4e5 * factor, 0.4, 2e9 * factor, 0.35)
    stages = [history([(*step[:4], step[4] * f) for step in steps]) for f in (1.0, factor)]
    last = [
        roll_transient(
            Influence((CELLS, CELLS), SPACING, SPACING, HalfSpaces(bodies)), way, gap=gap, tolerance=1e-8
        ).last
        for bodies, way in zip((one, other), stages, strict=True)
    ]
    np.testing.assert_allclose(
        last[1].tangential.shear, factor * last[0].tangential.shear, atol=1e-4 * last[1].pressure.max()
    )


def test_a_step_cut_in_two_without_a_change_of_direction_is_the_same_turn():
    # Monotone shift of like bodies under constant pressure: the path does not matter.
    influence = Influence((CELLS, CELLS), SPACING, SPACING, HalfSpaces(PAIRS["like"]))
    pressure = solve_normal(influence, X[None, :] ** 2 + X[:, None] ** 2, load=60.0, tolerance=1e-9).pressure
    turn = 0.02 * arm_of(X, X)
    whole, halves = (
        roll_transient(
            influence, [Stage(turn / n, (None, None), 0.6, pressure=pressure)] * n, tolerance=1e-9
        ).last.tangential.shear
        for n in (1, 2)
    )
    np.testing.assert_allclose(halves, whole, atol=1e-3 * 0.6 * pressure.max())
