"""What every normal contact must satisfy, whatever the surface."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from treadload.contact.bodies.half_space import HalfSpaces
from treadload.contact.bodies.influence import Influence
from treadload.contact.solvers.normal import solve_normal
from treadload.kernels.gridding.convolution import Convolution, Padding
from treadload.kernels.half_space.rectangle import CombinedElasticity

quick = settings(derandomize=True, deadline=None, max_examples=40)
few = settings(derandomize=True, deadline=None, max_examples=15)

DX = 2e-3
BODIES = CombinedElasticity(1e6, 0.45, 0.0)
SHAPES = st.tuples(st.integers(2, 14), st.integers(2, 14))
LOADS = st.floats(0.01, 500.0)


@st.composite
def surfaces(draw, holes=True):
    """Gap (ny, nx), m: a bowl of some radius with bumps up to 2 mm, and cells without material."""
    ny, nx = draw(SHAPES)
    radius = draw(st.floats(0.05, 5.0))
    bumps = draw(arrays(float, (ny, nx), elements=st.floats(0.0, 2e-3)))
    x, y = DX * (np.arange(nx) - (nx - 1) / 2), DX * (np.arange(ny) - (ny - 1) / 2)
    gap = (x[None, :] ** 2 + y[:, None] ** 2) / (2 * radius) + bumps
    if holes:
        missing = draw(arrays(bool, (ny, nx), elements=st.booleans()))
        missing.flat[draw(st.integers(0, ny * nx - 1))] = False
        gap[missing] = np.nan
    return gap


def influence(gap):
    return Influence(gap.shape, DX, DX, HalfSpaces(BODIES))


@quick
@given(surfaces(), LOADS)
def test_conditions_of_contact(gap, load):
    found = solve_normal(influence(gap), gap, load=load)
    p, material = found.pressure, ~np.isnan(gap)
    assert (p >= 0).all()
    assert not p[~material].any()
    assert abs(p.sum() * DX**2 - load) <= 1e-6 * load
    # The residual is relative to the depth from first touch.
    depth = found.approach - np.nanmin(gap)
    assert depth > 0
    assert np.nanmin(found.gap) >= -1e-6 * depth
    assert np.abs(found.gap[p > 0]).max() <= 1e-6 * depth
    # p·gap = 0, as work: none is stored in an open gap.
    assert np.abs(p[material] * found.gap[material]).max() <= 1e-6 * depth * p.max()


@quick
@given(surfaces(), st.floats(1e-5, 5e-3))
def test_a_deeper_approach_carries_more(gap, depth):
    low = float(np.nanmin(gap))
    one, two = (solve_normal(influence(gap), gap, approach=low + d).pressure.sum() for d in (depth, 1.2 * depth))
    assert two > one > 0


@few
@given(surfaces(), LOADS)
def test_mirrored_and_turned_surfaces_give_mirrored_and_turned_pressure(gap, load):
    p = solve_normal(influence(gap), gap, load=load, tolerance=1e-9).pressure
    scale = 1e-5 * p.max()
    for turn in (lambda f: f[::-1], lambda f: f[:, ::-1], lambda f: f.T):
        turned = turn(gap).copy()
        other = solve_normal(influence(turned), turned, load=load, tolerance=1e-9).pressure
        np.testing.assert_allclose(other, turn(p), atol=scale)


@few
@given(surfaces(), LOADS, st.floats(0.1, 10.0))
def test_stiffness_and_load_scale_together(gap, load, factor):
    p = solve_normal(influence(gap), gap, load=load, tolerance=1e-9)
    stiffer = CombinedElasticity(factor * BODIES.shear_modulus, BODIES.poisson, 0.0)
    other = solve_normal(Influence(gap.shape, DX, DX, HalfSpaces(stiffer)), gap, load=factor * load, tolerance=1e-9)
    np.testing.assert_allclose(other.pressure, factor * p.pressure, atol=1e-5 * factor * p.pressure.max())


@few
@given(surfaces(holes=False), LOADS)
def test_taking_material_away_lets_the_tire_sink(gap, load):
    whole = solve_normal(influence(gap), gap, load=load).approach
    gap = gap.copy()
    gap[::2, ::2] = np.nan
    assert solve_normal(influence(gap), gap, load=load).approach >= whole * (1 - 1e-6)


@quick
@given(SHAPES, st.floats(-3.0, 3.0), st.integers(0, 2**32 - 1))
def test_convolution_is_linear(shape, factor, seed):
    padding = Padding.of(shape)
    rng = np.random.default_rng(seed)
    operator = Convolution(padding, padding.spectrum(rng.normal(size=padding.shape)))
    one, two = rng.normal(size=shape), rng.normal(size=shape)
    together = operator(one + factor * two)
    apart = operator(one) + factor * operator(two)
    np.testing.assert_allclose(together, apart, atol=1e-12 * (1 + np.abs(apart).max()))


@quick
@given(SHAPES, st.integers(0, 2**32 - 1))
def test_the_normal_operator_is_symmetric_and_positive(shape, seed):
    operator = Influence(shape, DX, 1.7 * DX, HalfSpaces(BODIES)).normal
    one, two = np.random.default_rng(seed).normal(size=(2, *shape))
    assert np.isclose(np.vdot(one, operator(two)), np.vdot(two, operator(one)), rtol=1e-9, atol=1e-18)
    assert np.vdot(one, operator(one)) > 0
