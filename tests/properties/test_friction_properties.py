"""What every friction law must keep to, whatever the patch and the wheel does."""

import numpy as np
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from treadload.contact.bodies.half_space import HalfSpaces
from treadload.contact.bodies.influence import Influence
from treadload.contact.friction import (
    Anisotropic,
    Exponential,
    FlashHeating,
    FrictionMap,
    Heat,
    LinearFalling,
    PressureDependent,
    Rational,
)
from treadload.contact.friction.laws import Interface
from treadload.contact.solvers.rolling import rigid_slip
from treadload.contact.solvers.slipping import solve_slipping
from treadload.kernels.half_space.rectangle import CombinedElasticity

some = settings(derandomize=True, deadline=None, max_examples=30)
DX, SPEED, TOLERANCE = 2e-3, 10.0, 1e-7
BODIES = CombinedElasticity(1e6, 0.45, 0.0)
CREEPAGES = st.tuples(st.floats(-0.3, 0.3), st.floats(-0.3, 0.3))
SPINS = st.sampled_from([0.0, 0.5, -2.0])
FACTORS = st.floats(0.3, 1.2)
RUBBER, ASPHALT = Heat(0.25, 2e6), Heat(1.2, 2.1e6)


@st.composite
def pressures(draw):
    """Pressure (ny, nx), Pa: a dome with rough cells and cells out of contact."""
    ny, nx = draw(st.integers(2, 10)), draw(st.integers(2, 10))
    y, x = np.meshgrid(np.linspace(-1, 1, ny), np.linspace(-1, 1, nx), indexing="ij")
    rough = draw(arrays(float, (ny, nx), elements=st.floats(0.5, 1.0)))
    pressure = 2e5 * rough * np.sqrt(np.maximum(0, 1 - 0.7 * (x * x + y * y)))
    pressure[draw(arrays(bool, (ny, nx), elements=st.sampled_from([False, False, False, True])))] = 0.0
    assume((pressure > 0).sum() >= 2)
    return pressure


@st.composite
def simple(draw):
    """A law without a base. Friction falls slowly enough for one steady state."""
    static = draw(FACTORS)
    kinetic = static * draw(st.floats(0.6, 1.0))
    kind = draw(st.sampled_from([LinearFalling, Rational, Exponential, PressureDependent]))
    if kind is PressureDependent:
        return PressureDependent(static, 1e5, draw(st.floats(0.0, 1 / 3)))
    return kind(static, kinetic, draw(st.floats(0.5, 5.0)))


@st.composite
def laws(draw):
    law = draw(simple())
    if draw(st.booleans()):
        law = Anisotropic(draw(FACTORS), draw(FACTORS), law)
    if draw(st.booleans()):
        law = FrictionMap(draw(arrays(float, (3, 2), elements=st.floats(0.3, 1.0))), 0.02, base=law)
    if draw(st.booleans()):
        law = FlashHeating(law, RUBBER, ASPHALT, draw(st.floats(0.0, 5.0)), 20.0, draw(st.floats(0.5, 1.0)))
    return law


def roll(pressure, law, creepages, spin=0.0, forces=(None, None)):
    ny, nx = pressure.shape
    x, y = DX * (np.arange(nx) - (nx - 1) / 2), DX * (np.arange(ny) - (ny - 1) / 2)
    at = Interface(pressure, np.zeros((2, ny, nx)), x, y, DX, SPEED)
    influence = Influence(pressure.shape, DX, DX, HalfSpaces(BODIES))
    rigid = rigid_slip(x, y, DX, creepages, spin)
    found = solve_slipping(influence, law, at, rigid, forces, tolerance=TOLERANCE)
    return found, at, influence, rigid


def true_slip(found, influence, rigid):
    """Slip over one step (2, ny, nx), m, computed anew from the shear of all cells."""
    shear = found.tangential.shear
    padding = influence.rolling_padding
    (xx, yy, xy), (q_x, q_y) = influence.tangential(padding), padding.forward(shear)
    u = padding.inverse(np.array([xx * q_x + xy * q_y, xy * q_x + yy * q_y]))
    given = rigid + np.array(found.tangential.rigid)[:, None, None]
    return u[..., :-1] - u[..., 1:] + DX * given


@some
@given(pressures(), laws(), CREEPAGES, SPINS)
def test_bound_dissipation_and_the_associated_rule(pressure, law, creepages, spin):
    found, at, influence, rigid = roll(pressure, law, creepages, spin)
    shear, stretch = found.tangential.shear, np.array(law.axes)[:, None, None]
    scale = np.linalg.norm(found.bound)
    # The bound is the law's at the slip that was found.
    here = Interface(at.pressure, found.tangential.slip, at.x, at.y, DX, SPEED)
    assert np.linalg.norm(law.bound(here) - found.bound) <= TOLERANCE * scale
    assert (np.hypot(*(shear / stretch)) <= found.bound * (1 + 1e-9)).all()
    assert (found.coefficient <= law.largest * (1 + 1e-12)).all()
    # Stick without slip, and slip normal to the ellipse: stretched, q' is the nearest of the disc to q' - r s'.
    reach = shear / stretch - stretch * true_slip(found, influence, rigid) / influence.self_influence(rolls=True)
    size = np.hypot(*reach)
    nearest = reach * np.divide(found.bound, size, out=np.ones_like(size), where=size > found.bound)
    assert np.linalg.norm(shear / stretch - nearest) <= 2 * TOLERANCE * scale
    # Work is lost in every cell; what is gained is round-off of the solve.
    work = -(shear * found.tangential.slip).sum(0)
    assert work.min() >= -1e-9 * max(work.max(), 1e-3)


@some
@given(pressures(), laws(), CREEPAGES)
def test_mirrored_across_travel(pressure, law, creepages):
    assume(not _has_map(law))
    one = roll(pressure, law, creepages)[0].tangential
    other = roll(pressure[::-1].copy(), law, (creepages[0], -creepages[1]))[0].tangential
    scale = 1e-4 * law.largest * pressure.max()
    np.testing.assert_allclose(other.shear[0], one.shear[0, ::-1], atol=scale)
    np.testing.assert_allclose(other.shear[1], -one.shear[1, ::-1], atol=scale)


def _has_map(law):
    while law is not None:
        if isinstance(law, FrictionMap):
            return True
        law = getattr(law, "base", None)
    return False


@some
@given(pressures(), laws(), st.floats(0.0, 2 * np.pi), st.floats(0.0, 0.4))
def test_forces_are_carried(pressure, law, angle, part):
    at_rest = Interface(
        pressure,
        np.zeros((2, *pressure.shape)),
        DX * (np.arange(pressure.shape[1]) - (pressure.shape[1] - 1) / 2),
        DX * (np.arange(pressure.shape[0]) - (pressure.shape[0] - 1) / 2),
        DX,
        SPEED,
    )
    limit = law.bound(at_rest).sum() * DX**2
    pull = part * limit * np.array(law.axes) * np.array([np.cos(angle), np.sin(angle)])
    found = roll(pressure, law, (0.0, 0.0), forces=(float(pull[0]), float(pull[1])))[0]
    np.testing.assert_allclose(found.tangential.shear.sum((1, 2)) * DX**2, pull, atol=1e-6 * limit)
    # What is driven one way creeps the other way: the work of the forces is not negative.
    assert pull @ np.array(found.tangential.rigid) <= 1e-9 * limit
