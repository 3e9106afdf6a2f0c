"""Friction laws against their limits, closed forms, and the moving source of heat."""

from itertools import pairwise

import numpy as np
import pytest
from scipy import integrate, special

from treadload.contact.friction import (
    Anisotropic,
    Coulomb,
    Exponential,
    FlashHeating,
    FrictionMap,
    Heat,
    LinearFalling,
    PressureDependent,
    Rational,
)
from treadload.contact.friction.heat import flash_temperature
from treadload.contact.friction.laws import Interface
from treadload.contact.solvers.rolling import rigid_slip
from treadload.contact.solvers.shift import solve_shift
from treadload.contact.solvers.slipping import solve_slipping
from treadload.kernels.half_space.rectangle import CombinedElasticity
from treadload.validation.patches import paraboloid

DX = 2e-3
BODIES = CombinedElasticity(1e6, 0.4, 0.0)
PATCH = paraboloid(BODIES, (0.3, 0.5), 50.0, (34, 30), (DX, DX))
RUBBER, ASPHALT = Heat(0.25, 2e6), Heat(1.2, 2.1e6)


def roll(law, creepages=(0.0, 0.0), spin=0.0, forces=(None, None), speed=10.0, tolerance=1e-8):
    pressure = PATCH.normal.pressure
    at = Interface(pressure, np.zeros((2, *pressure.shape)), PATCH.x, PATCH.y, DX, speed)
    rigid = rigid_slip(PATCH.x, PATCH.y, DX, creepages, spin)
    return solve_slipping(PATCH.influence, law, at, rigid, forces, tolerance=tolerance)


def force(found):
    return PATCH.force(found.tangential.shear) / PATCH.load


SAME_AS_COULOMB = [
    LinearFalling(0.6, 0.6, 1.0),
    Rational(0.6, 0.6, 1.0),
    Exponential(0.6, 0.6, 1.0),
    # So slow that nothing falls: the slip speed is below 1 m/s.
    Exponential(0.6, 0.0, 1e9),
    PressureDependent(0.6, 1e5, 0.0),
    Anisotropic(0.6, 0.6),
    Anisotropic(2.0, 2.0, Coulomb(0.3)),
    FrictionMap(np.full((7, 5), 0.6), 0.02),
    FrictionMap([[3.0]], 0.02, base=Coulomb(0.2)),
    FlashHeating(Coulomb(0.6), RUBBER, ASPHALT, 0.0, 1.0, 1.0),
    # So much heat taken up that nothing gets warm.
    FlashHeating(Coulomb(0.6), Heat(1e9, 1e15), ASPHALT, 10.0, 10.0, 0.1),
]


@pytest.mark.parametrize("law", SAME_AS_COULOMB, ids=repr)
def test_limits_that_are_coulomb(law):
    wanted = PATCH.roll(0.6, (-0.05, 0.02), 0.5, tolerance=1e-8)
    found = roll(law, (-0.05, 0.02), 0.5)
    # Both solves reach 1e-8 in norm; a single cell of 400 may hold more of it.
    limit = 1e-6 * (0.6 * PATCH.normal.pressure).max()
    np.testing.assert_allclose(found.tangential.shear, wanted.shear, atol=limit)


@pytest.mark.parametrize("law", [Exponential(0.9, 0.5, 0.3), Anisotropic(0.9, 0.4), PressureDependent(0.6, 2e4, 0.3)])
def test_forces_and_creepages_ask_the_same(law):
    forces = (0.3 * PATCH.load, -0.2 * PATCH.load)
    by_force = roll(law, spin=0.3, forces=forces)
    np.testing.assert_allclose(force(by_force), (0.3, -0.2), atol=1e-7)
    by_creepage = roll(law, by_force.tangential.rigid, 0.3)
    np.testing.assert_allclose(force(by_creepage), (0.3, -0.2), atol=1e-6)


@pytest.mark.parametrize("angle", [0.0, 0.4, 1.0, np.pi / 2, 2.5, -1.2])
def test_gross_sliding_on_the_ellipse(angle):
    """Slip along the normal of the ellipse: Q_c = -P μ_c² w_c / √(μ_x² w_x² + μ_y² w_y²)."""
    along, across = 0.9, 0.4
    way = np.array([np.cos(angle), np.sin(angle)])
    found = roll(Anisotropic(along, across), tuple(500.0 * way))
    squares = np.array([along**2, across**2])
    wanted = -squares * way / np.sqrt((squares * way**2).sum())
    # Elastic slip, μp/G of 0.1, turns the way of a slip of 500 by less than 1e-3.
    np.testing.assert_allclose(force(found), wanted, atol=1e-3)
    assert not found.tangential.stick.any()


def test_the_ellipse_turned_by_a_right_angle_in_a_shift():
    turned = paraboloid(BODIES, (0.5, 0.3), 50.0, (30, 34), (DX, DX))
    law, other = Anisotropic(0.9, 0.4), Anisotropic(0.4, 0.9)
    forces = (0.3 * PATCH.load, -0.2 * PATCH.load)
    none = np.zeros((2, *PATCH.contact.shape))
    mean = 0.6
    one = solve_shift(PATCH.influence, mean * PATCH.normal.pressure, none, forces, axes=law.axes, tolerance=1e-8)
    two = solve_shift(
        turned.influence,
        mean * turned.normal.pressure,
        none.transpose(0, 2, 1),
        forces[::-1],
        axes=other.axes,
        tolerance=1e-8,
    )
    limit = 1e-6 * (mean * PATCH.normal.pressure).max()
    np.testing.assert_allclose(two.shear[::-1].transpose(0, 2, 1), one.shear, atol=limit)
    np.testing.assert_allclose(two.slip[::-1].transpose(0, 2, 1), one.slip, atol=1e-6 * np.abs(one.slip).max())
    assert two.rigid[::-1] == pytest.approx(one.rigid, rel=1e-6)


@pytest.mark.parametrize("kind", [LinearFalling, Rational, Exponential])
def test_falling_friction_has_its_largest_force_before_it_slides(kind):
    law = kind(0.9, 0.4, 1.0)
    creepages = [0.005, 0.02, 0.04, 0.06, 0.08, 0.12, 0.2, 0.5, 2.0, 50.0]
    forces = np.array([-force(roll(law, (c, 0.0), tolerance=1e-6))[0] for c in creepages])
    best = int(forces.argmax())
    assert 0 < best < len(creepages) - 3
    assert (np.diff(forces[: best + 1]) > 0).all()
    # Beyond the fall of the linear law, what elastic slip turns aside still fades, by some 1e-6.
    assert (np.diff(forces[best:]) < 1e-5).all()
    # Less than at rest, for part of the patch slides already; in the end all of it, at 500 m/s.
    assert 0.45 < forces[best] < 0.9
    assert forces[-1] == pytest.approx(0.4, abs=2e-3)
    # Where all slides, and slip is nearly the creepage, force follows the law.
    at = Interface(np.ones((1, 1)), np.full((2, 1, 1), [[[0.5]], [[0.0]]]), np.zeros(1), np.zeros(1), DX, 10.0)
    assert forces[7] == pytest.approx(law.coefficient(at)[0, 0], abs=0.02)


def test_falling_friction_starts_from_the_coefficient_at_rest():
    """A creepage too small to slide anywhere finds the branch that sticks, however low the kinetic value."""
    found = roll(Exponential(50.0, 0.01, 1e-3), (-1e-4, 0.0))
    stuck = PATCH.roll(50.0, (-1e-4, 0.0), tolerance=1e-8)
    assert found.tangential.stick.sum() > 0.9 * PATCH.contact.sum()
    assert force(found)[0] == pytest.approx(PATCH.force(stuck.shear)[0] / PATCH.load, rel=0.1)


def test_a_slippery_wheel_path_turns_the_force_aside():
    """Friction 0.3 on the left half and 0.9 on the right: in gross sliding, each half drags by its own share."""
    law = FrictionMap([[0.3], [0.3], [0.9], [0.9]], x=[0.0], y=[-0.05, -1e-9, 1e-9, 0.05])
    found = roll(law, (-300.0, 0.0))
    # Both halves carry 25 N; the step lies between two rows of cells.
    assert force(found)[0] == pytest.approx(0.6, abs=1e-3)
    halves = (PATCH.normal.pressure * np.sign(PATCH.y)[:, None] * PATCH.y[:, None]).sum() / 2
    moment = PATCH.moment(found.tangential.shear) / PATCH.cell
    assert moment == pytest.approx(-(0.9 - 0.3) * halves, rel=2e-3)


SPEED, LENGTH, FLUX = 10.0, 0.1, 1e5
EFFUSIVITY = RUBBER.effusivity + ASPHALT.effusivity


def band(n, speed, effusivity, length=LENGTH):
    """Temperature behind the leading edge of a uniform source on n cells."""
    return flash_temperature(np.full((1, n), FLUX), length / n, speed, effusivity)[0]


@pytest.mark.parametrize("n", [1, 10, 100])
def test_flash_temperature_of_a_band_source(n):
    """Jaeger's uniform band, fast: T = 2 f √(d/πV) / (b₁ + b₂) at a distance d behind its leading edge."""
    behind = LENGTH * (n - 0.5 - np.arange(n)) / n
    exact = 2 * FLUX * np.sqrt(behind / (np.pi * SPEED)) / EFFUSIVITY
    np.testing.assert_allclose(band(n, SPEED, EFFUSIVITY), exact, rtol=1e-12)


def test_flash_temperature_leads_to_the_largest_of_jaeger():
    """T_max = (2 f/λ) √(2aκ/πV) on one body, at the trailing edge of a band of half-width a; half a cell short."""
    exact = 2 * FLUX / RUBBER.conductivity * np.sqrt(LENGTH * RUBBER.diffusivity / (np.pi * SPEED))
    errors = [1 - band(n, SPEED, RUBBER.effusivity).max() / exact for n in (10, 20, 40)]
    assert np.log2(np.array(errors[:-1]) / np.array(errors[1:])) == pytest.approx(np.ones(2), abs=0.05)


@pytest.mark.parametrize(("peclet", "tolerance"), [(100.0, 0.02), (1e3, 2e-3), (1e4, 2e-4)])
def test_flash_temperature_against_the_moving_line_source(peclet, tolerance):
    """At any speed, T = f/(πλ) ∫ exp(-V ξ/2κ) K₀(V|ξ|/2κ) dξ over the band (Carslaw & Jaeger, section 10.7).

    ξ: distance ahead of a line of the source. In the middle of the band the strips are off by the heat that
    spreads ahead, a part of 1/Pe, with Pe = V L/κ.
    """
    speed = peclet * RUBBER.diffusivity / LENGTH
    rate = speed / (2 * RUBBER.diffusivity)

    def line(ahead):
        # k0e carries exp(|z|): behind the source both exponentials cancel.
        z = rate * ahead
        return np.exp(-z - abs(z)) * special.k0e(abs(z))

    edges = [0.0, *np.geomspace(1e-6, 1.0, 13)]
    half = 0.5 * LENGTH
    parts = [
        integrate.quad(line, sign * half * low, sign * half * high)[0] * sign
        for sign in (1, -1)
        for low, high in pairwise(edges)
    ]
    exact = FLUX / (np.pi * RUBBER.conductivity) * sum(parts)
    # An odd number of cells has a centre in the middle.
    assert band(101, speed, RUBBER.effusivity)[50] == pytest.approx(exact, rel=tolerance)


def test_heat_lowers_friction_towards_the_trailing_edge():
    law = FlashHeating(Coulomb(0.9), RUBBER, ASPHALT, 0.5, 8.0, 0.4)
    found = roll(law, (-2.0, 0.0), speed=10.0)
    row = PATCH.contact.shape[0] // 2
    mu, rise = found.coefficient[row][PATCH.contact[row]], found.temperature[row][PATCH.contact[row]]
    assert (np.diff(mu) >= -1e-12).all()
    assert mu[-1] > 1.5 * mu[0]
    assert rise.max() > 0.5
    assert 0.36 < force(found)[0] < 0.9
    # The temperature is that of the work of friction that was found.
    work = -(found.tangential.shear * found.tangential.slip).sum(0) * 10.0
    np.testing.assert_allclose(flash_temperature(work, DX, 10.0, EFFUSIVITY)[row], found.temperature[row], rtol=1e-5)
