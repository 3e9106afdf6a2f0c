"""Laws that rolling obeys whatever the patch: scaling, rotation in a shift, two solvers, more creepage more force."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from treadload.contact.bodies.half_space import HalfSpaces
from treadload.contact.bodies.influence import Influence
from treadload.contact.solvers.rolling import rigid_slip, solve_rolling
from treadload.contact.solvers.shift import solve_shift
from treadload.contact.solvers.tangential import _problem
from treadload.kernels.complementarity import coulomb_newton
from treadload.kernels.complementarity.coulomb_splitting import split
from treadload.kernels.half_space.rectangle import CombinedElasticity

some = settings(max_examples=15, deadline=None, derandomize=True)
SHAPE, DX = (9, 11), 2e-3
BODIES = CombinedElasticity(1e6, 0.4, 0.0)
TOLERANCE = 1e-8


@st.composite
def patches(draw):
    """Friction bounds of a dome with a random groove, Pa."""
    y, x = np.meshgrid(np.linspace(-1.1, 1.1, SHAPE[0]), np.linspace(-1.1, 1.1, SHAPE[1]), indexing="ij")
    bound = draw(st.floats(1e4, 1e6)) * np.sqrt(np.maximum(0, 1 - x**2 - y**2))
    bound[draw(st.integers(2, 6))] = 0
    return bound


def roll(bound, creepages, spin=0.0, scale=1.0, bodies=BODIES):
    dx = DX * scale
    x, y = dx * (np.arange(SHAPE[1]) - 5.0), dx * (np.arange(SHAPE[0]) - 4.0)
    influence = Influence(SHAPE, dx, dx, HalfSpaces(bodies))
    return solve_rolling(influence, bound, rigid_slip(x, y, dx, creepages, spin), (None, None), tolerance=TOLERANCE)


creepage = st.floats(-0.3, 0.3)


@some
@given(patches(), creepage, creepage, st.floats(0.1, 10))
def test_lengths_scale(bound, along, across, scale):
    """A patch of another size with the same creepages bears the same shear; spin scales with one over length."""
    one = roll(bound, (along, across), spin=5.0)
    other = roll(bound, (along, across), spin=5.0 / scale, scale=scale)
    np.testing.assert_allclose(other.shear, one.shear, atol=1e-5 * bound.max())


@some
@given(patches(), creepage, creepage, st.floats(0.1, 10))
def test_stresses_scale(bound, along, across, scale):
    """Modulus and bound times the same factor: so is the shear."""
    stiff = CombinedElasticity(BODIES.shear_modulus * scale, BODIES.poisson, 0.0)
    one, other = roll(bound, (along, across)), roll(scale * bound, (along, across), bodies=stiff)
    np.testing.assert_allclose(other.shear / scale, one.shear, atol=1e-5 * bound.max())


@some
@given(patches(), creepage, creepage, st.floats(0.1, 10))
def test_creepage_scales_with_friction(bound, along, across, scale):
    """Bound and creepages times the same factor: linear elasticity and the disc scale together."""
    one, other = roll(bound, (along, across)), roll(scale * bound, (scale * along, scale * across))
    np.testing.assert_allclose(other.shear / scale, one.shear, atol=1e-5 * bound.max())


@some
@given(patches(), st.floats(-2e-3, 2e-3), st.floats(-2e-3, 2e-3))
def test_a_shift_turns_with_its_axes(bound, along, across):
    rigid = np.stack([np.full(SHAPE, along), np.full(SHAPE, across)])
    one = solve_shift(Influence(SHAPE, DX, DX, HalfSpaces(BODIES)), bound, rigid, (None, None), tolerance=TOLERANCE)
    turned_rigid = np.stack([rigid[1].T, rigid[0].T])
    influence = Influence(SHAPE[::-1], DX, DX, HalfSpaces(BODIES))
    other = solve_shift(influence, bound.T.copy(), turned_rigid, (None, None), tolerance=TOLERANCE)
    atol = 1e-4 * bound.max()
    np.testing.assert_allclose(other.shear[0].T, one.shear[1], atol=atol)
    np.testing.assert_allclose(other.shear[1].T, one.shear[0], atol=atol)


@some
@given(patches(), creepage, creepage, st.floats(-20, 20))
def test_both_solvers_find_the_same(bound, along, across, spin):
    x, y = DX * (np.arange(SHAPE[1]) - 5.0), DX * (np.arange(SHAPE[0]) - 4.0)
    rigid = DX * rigid_slip(x, y, DX, (along, across), spin)
    problem = _problem(Influence(SHAPE, DX, DX, HalfSpaces(BODIES)), bound, rigid, (None, None), True, (1.0, 1.0))
    fast = coulomb_newton.solve(problem, tolerance=TOLERANCE)
    slow, _, _ = split(problem, np.zeros_like(rigid), np.zeros(2), tolerance=TOLERANCE, max_iterations=20_000)
    assert fast.converged
    np.testing.assert_allclose(fast.shear, slow, atol=1e-5 * bound.max())


@some
@given(patches(), st.floats(1e-4, 0.2), st.floats(1.05, 3.0))
def test_more_creepage_more_force(bound, small, factor):
    one, other = roll(bound, (small, 0.0)), roll(bound, (small * factor, 0.0))
    # S is monotone: forces and creepages grow together, up to the tolerance.
    assert -other.shear[0].sum() >= -one.shear[0].sum() * (1 - 1e-6)
    assert np.abs(one.shear[0].sum()) <= bound.sum() * (1 + 1e-12)
    assert other.residual == pytest.approx(0, abs=TOLERANCE)
