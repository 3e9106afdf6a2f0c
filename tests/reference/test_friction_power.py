"""Work of friction against CONTACT (revision 2707) and against the work of the creep forces."""

import numpy as np
import pytest

from treadload.kernels.half_space.rectangle import CombinedElasticity
from treadload.validation.dissimilar import rubber_on_asphalt
from treadload.validation.patches import paraboloid

# Rolling disc of test_rolling_of_contact: a = 6 mm, G = 80 GPa, ν = 0.25, P = 48.25 kN, μ = 0.3; SI here.
RADIUS, LOAD, MU, A = 1e-3 / (2 * 0.785398163397e-3), 48254.8631591, 0.3, 6e-3
BODIES = CombinedElasticity(80e9, 0.25, 0.0)
# The program's default speed; it counts what friction takes from the bodies as negative, in W.
SPEED = 30.0


def disc(n, size=3):
    dx = 2 * A / n
    return paraboloid(BODIES, (RADIUS, RADIUS), LOAD, (n + 2 * size,) * 2, (dx, dx))


def work(patch, found):
    """Work of friction per length travelled, N."""
    return -float((found.shear * found.slip).sum()) * patch.cell


@pytest.mark.parametrize(
    ("fractions", "n", "power"),
    [
        ((0.3, 0.0), 25, 37.4436874994),
        ((0.5, 0.0), 25, 131.552002688),
        ((0.4, 0.4), 25, 189.602663241),
        ((0.7, 0.0), 50, 330.750603864),
    ],
)
def test_frictional_power_of_a_disc(fractions, n, power):
    patch = disc(n)
    found = patch.roll(MU, forces=tuple(f * MU * LOAD for f in fractions), tolerance=1e-8)
    # The program iterates to 1e-6 of its norm of shear.
    assert SPEED * work(patch, found) == pytest.approx(power, rel=1e-5)


def test_frictional_power_of_a_tire():
    """Dissimilar bodies, 20 m/s, driving with 10 kN."""
    data = rubber_on_asphalt(tractive_force=10e3, speed=20.0).dataset
    assert float(data.friction_power_total) == pytest.approx(4959.09031159, rel=1e-4)
    assert float(data.friction_power.sum()) * 0.012**2 == pytest.approx(float(data.friction_power_total), rel=1e-12)


@pytest.mark.parametrize(("creepages", "spin"), [((-1.2e-3, 0.0), 0.0), ((-4e-4, 6e-4), 0.3), ((0.0, 0.0), 0.4)])
def test_friction_takes_the_work_of_the_creep_forces(creepages, spin):
    """Rolling keeps the elastic energy, so that ∫ q·s = Q·ξ + Mφ; the difference upwind loses some of first order."""
    errors = []
    for n in (32, 64, 128):
        patch = disc(n)
        found = patch.roll(MU, creepages, spin, tolerance=1e-7)
        along, across = patch.force(found.shear)
        given = -(along * creepages[0] + across * creepages[1] + patch.moment(found.shear) * spin)
        errors.append(1 - work(patch, found) / given)
    rates = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert (np.array(errors) > 0).all()
    assert rates == pytest.approx(np.ones(2), abs=0.25)
    # 2.0, 2.1 and 2.4 % at 128 cells across, and half of it with every refinement.
    assert errors[-1] < 0.025
