"""What every rolling contact must satisfy, whatever the patch and the wheel does."""

import numpy as np
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from treadload.contact import Rolling, solve_contact
from treadload.contact.bodies.half_space import HalfSpaces
from treadload.contact.bodies.influence import Influence
from treadload.contact.solvers.rolling import rigid_slip, solve_rolling
from treadload.kernels.half_space.rectangle import CombinedElasticity
from treadload.materials import Elastic
from treadload.pavement import Pavement
from treadload.tire import Tire
from treadload.validation.tires import contact_conditions

few = settings(derandomize=True, deadline=None, max_examples=15)
some = settings(derandomize=True, deadline=None, max_examples=30)

DX = 2e-3
BODIES = CombinedElasticity(1e6, 0.45, 0.0)
CREEPAGES = st.tuples(st.floats(-0.3, 0.3), st.floats(-0.3, 0.3))
SPINS = st.sampled_from([0.0, 0.5, -2.0, 5.0])
FRACTIONS = st.tuples(st.floats(0.0, 0.9), st.floats(0.0, 2 * np.pi))
TOLERANCE = 1e-7


@st.composite
def bounds(draw):
    """μp (ny, nx), Pa: a dome with rough cells and cells out of contact."""
    ny, nx = draw(st.integers(2, 12)), draw(st.integers(2, 12))
    y, x = np.meshgrid(np.linspace(-1, 1, ny), np.linspace(-1, 1, nx), indexing="ij")
    rough = draw(arrays(float, (ny, nx), elements=st.floats(0.5, 1.0)))
    bound = 2e5 * rough * np.sqrt(np.maximum(0, 1 - 0.7 * (x * x + y * y)))
    open_cells = draw(arrays(bool, (ny, nx), elements=st.sampled_from([False, False, False, True])))
    bound[open_cells] = 0.0
    assume((bound > 0).sum() >= 2)
    return bound


def roll(bound, creepages=(0.0, 0.0), spin=0.0, forces=(None, None), bodies=BODIES):
    ny, nx = bound.shape
    x, y = DX * (np.arange(nx) - (nx - 1) / 2), DX * (np.arange(ny) - (ny - 1) / 2)
    influence = Influence(bound.shape, DX, DX, HalfSpaces(bodies))
    return solve_rolling(influence, bound, rigid_slip(x, y, DX, creepages, spin), forces, tolerance=TOLERANCE)


def natural_residual(bound, found, creepages, spin):
    """|q - P(q - r s)| / |μp| of the returned shear, with the slip computed anew from its cells."""
    ny, nx = bound.shape
    x, y = DX * (np.arange(nx) - (nx - 1) / 2), DX * (np.arange(ny) - (ny - 1) / 2)
    influence = Influence(bound.shape, DX, DX, HalfSpaces(BODIES))
    total = np.asarray(creepages) + np.asarray(found.rigid)
    padding = influence.rolling_padding
    (xx, yy, xy), (q_x, q_y) = influence.tangential(padding), padding.forward(found.shear)
    u = padding.inverse(np.array([xx * q_x + xy * q_y, xy * q_x + yy * q_y]))
    slip = u[..., :-1] - u[..., 1:] + DX * rigid_slip(x, y, DX, tuple(total), spin)
    reach = found.shear - slip / influence.self_influence(rolls=True)
    size = np.hypot(*reach)
    nearest = reach * np.divide(bound, size, out=np.ones_like(size), where=size > bound)
    return np.linalg.norm(found.shear - nearest) / np.linalg.norm(bound)


@some
@given(bounds(), CREEPAGES, SPINS)
@example(np.array([[0.0, 1e5, 0.0], [1e5, 2e5, 1e5]]), (0.0, 1e-191), 0.0)  # its square is no number
def test_friction_and_slip(bound, creepages, spin):
    found = roll(bound, creepages, spin)
    size = np.hypot(*found.shear)
    assert (size <= bound * (1 + 1e-9)).all()
    # Stick without slip and slip against the shear, both in one number.
    assert natural_residual(bound, found, creepages, spin) <= 2 * TOLERANCE
    contact = bound > 0
    assert not found.slip[:, found.stick].any()
    assert not found.slip[:, ~contact].any()
    sliding = contact & ~found.stick
    assert np.allclose(size[sliding], bound[sliding], rtol=1e-9)


@some
@given(bounds(), FRACTIONS, SPINS)
def test_forces_are_carried(bound, fraction, spin):
    part, angle = fraction
    limit = bound.sum() * DX**2
    # Spin turns part of the friction against itself: only rolling without it carries all that μP allows.
    assume(spin == 0 or part < 0.4)
    forces = part * limit * np.cos(angle), part * limit * np.sin(angle)
    found = roll(bound, spin=spin, forces=forces)
    np.testing.assert_allclose(found.shear.sum((1, 2)) * DX**2, forces, atol=1e-6 * limit)
    assert (np.hypot(*found.shear) <= bound * (1 + 1e-9)).all()
    assert natural_residual(bound, found, (0.0, 0.0), spin) <= 2 * TOLERANCE


@few
@given(bounds(), CREEPAGES, SPINS)
def test_mirrored_across_travel(bound, creepages, spin):
    one = roll(bound, creepages, spin)
    other = roll(bound[::-1].copy(), (creepages[0], -creepages[1]), -spin)
    # Spin acts by w_y = φ x too: it changes sign with y.
    scale = 1e-4 * bound.max()
    np.testing.assert_allclose(other.shear[0], one.shear[0, ::-1], atol=scale)
    np.testing.assert_allclose(other.shear[1], -one.shear[1, ::-1], atol=scale)


@few
@given(bounds(), CREEPAGES, SPINS)
def test_driving_and_braking_are_alike_for_like_bodies(bound, creepages, spin):
    one = roll(bound, creepages, spin)
    other = roll(bound, (-creepages[0], -creepages[1]), -spin)
    np.testing.assert_allclose(other.shear, -one.shear, atol=1e-4 * bound.max())


@few
@given(bounds(), CREEPAGES)
def test_scaling_friction_and_creepage_scales_shear(bound, creepages):
    one = roll(bound, creepages)
    other = roll(3 * bound, (3 * creepages[0], 3 * creepages[1]))
    np.testing.assert_allclose(other.shear, 3 * one.shear, atol=1e-4 * bound.max())


@few
@given(bounds(), CREEPAGES)
def test_endless_friction_sticks_everywhere(bound, creepages):
    assume(np.hypot(*creepages) > 1e-3)
    found = roll(1e4 * bound, creepages)
    assert found.stick[bound > 0].all()
    assert not found.slip.any()


@few
@given(bounds(), st.floats(0.0, 2 * np.pi))
def test_large_creepage_drags_with_all_friction(bound, angle):
    creepages = 200 * np.cos(angle), 200 * np.sin(angle)
    found = roll(bound, creepages)
    forces = found.shear.sum((1, 2)) / bound.sum()
    np.testing.assert_allclose(forces, (-np.cos(angle), -np.sin(angle)), atol=0.02)
    # Never more than μP.
    assert np.hypot(*forces) <= 1 + 1e-9


@few
@given(bounds(), CREEPAGES)
def test_shear_feeds_on_slip(bound, creepages):
    """Friction dissipates: the work of shear on the slip of the tire is never positive."""
    found = roll(bound, creepages)
    assert (found.shear * found.slip).sum() <= 1e-9 * bound.max()


@few
@given(
    st.floats(0.3, 0.49),
    st.floats(0.2, 1.0),
    st.floats(-0.8, 0.8),
    st.floats(-0.5, 0.5),
    st.sampled_from([0.0, 0.2]),
)
def test_whole_contact_of_unlike_bodies(poisson, friction, along, across, spin):
    """Through solve_contact, with pressure and shear acting on each other."""
    assume(np.hypot(along, across) < 0.85)
    x = 4e-3 * (np.arange(26) - 12.5)
    gap = (x[None, :] ** 2 + 0.5 * x[:, None] ** 2) / 0.5
    gap[8:10] = np.nan
    tire = Tire.from_height_map(gap, 4e-3, material=Elastic(2e6, poisson))
    wheel = Rolling(
        normal_load=250.0,
        friction=friction,
        tractive_force=along * friction * 250.0,
        lateral_force=across * friction * 250.0,
        spin=spin,
    )
    contact = solve_contact(tire, Pavement.half_space(Elastic(5.4e9, 0.35)), wheel)
    failed = [check for check in contact_conditions("", contact) if not check.passed]
    assert not failed
