"""Rates of rolling contact: first order, for the difference along travel is taken upwind."""

import numpy as np
import pytest

from treadload.contact.bodies.half_space import HalfSpaces
from treadload.contact.bodies.influence import Influence
from treadload.contact.solvers.normal import solve_normal
from treadload.contact.solvers.rolling import solve_rolling
from treadload.contact.solvers.shift import solve_shift
from treadload.kernels.half_space.rectangle import CombinedElasticity
from treadload.validation.closed_forms import carter_shear, cattaneo_shift, hertz
from treadload.validation.patches import LONG, cylinder, paraboloid

MU, RADIUS, STICK = 0.3, 100.0, 0.6


def rates(errors):
    errors = np.abs(np.asarray(errors))
    return np.log2(errors[:-1] / errors[1:])


def test_carter():
    bodies = CombinedElasticity(1.0, 0.28, 0.0)
    peak = bodies.contact_modulus / (2 * RADIUS)
    fields, forces = [], []
    for n in (50, 100, 200, 400):
        patch = cylinder(bodies, RADIUS, np.pi * peak / 2, n + 6, 2 / n, LONG)
        found = patch.roll(MU, (-(1 - STICK) * MU / RADIUS, 0.0), tolerance=1e-9)
        error = found.shear[0, 0] / (MU * peak) - carter_shear(patch.x, STICK)
        fields.append(np.sqrt((error**2).mean()))
        forces.append(patch.force(found.shear)[0] / (MU * patch.load) - (1 - STICK**2))
    assert rates(forces) == pytest.approx(np.ones(3), abs=0.05)
    # Roots of the ends cost the rms a logarithm.
    assert (rates(fields) > 0.9).all()
    assert fields[-1] < 1e-3


def test_force_of_a_disc():
    """Q_x at half of Kalker's unit creepage, against the limit that finer grids (512²) were extrapolated to."""
    bodies = CombinedElasticity(1.0, 0.25, 0.0)
    exact = hertz(RADIUS, RADIUS, 4 * bodies.contact_modulus / (3 * RADIUS), bodies.contact_modulus)
    errors = []
    for n in (32, 64, 128):
        patch = paraboloid(bodies, (RADIUS, RADIUS), exact.load, (n + 4, n + 4), (2 / n, 2 / n))
        force = patch.force(patch.roll(MU, (-0.5 * MU * exact.load / 4.12, 0.0)).shear)[0]
        errors.append(force / (MU * patch.load) - 0.4272)
    # First order; the staircase of the rim is worth 0.2.
    assert rates(errors) == pytest.approx(np.ones(2), abs=0.2)


def test_shift_of_a_disc():
    """Cattaneo's shift: better than first order, as the approach of the same disc."""
    bodies = CombinedElasticity(1.0, 0.0, 0.0)
    exact = hertz(RADIUS, RADIUS, 4 * bodies.contact_modulus / (3 * RADIUS), bodies.contact_modulus)
    errors = []
    for n in (32, 64, 128):
        patch = paraboloid(bodies, (RADIUS, RADIUS), exact.load, (n + 4, n + 4), (2 / n, 2 / n))
        bound = MU * patch.normal.pressure
        force = -MU * patch.load * (1 - 0.5**3)
        found = solve_shift(patch.influence, bound, np.zeros((2, *bound.shape)), (force, 0.0), tolerance=1e-8)
        errors.append(found.rigid[0] / cattaneo_shift(exact.load, MU, 1.0, 1.0, 0.0, 0.5) - 1)
    assert (rates(errors) > 1).all()
    assert abs(errors[0]) < 1e-4


@pytest.mark.parametrize(
    ("cells", "most"), [(100, 36), (200, 34), pytest.param(400, 39, marks=pytest.mark.slow)], ids=str
)
@pytest.mark.parametrize("by_force", [False, True], ids=["creepage", "force"])
def test_products_of_a_disc(cells, most, by_force):
    """Half of the friction used: 37, 43 and 55 by creepage while every step sought two digits, asked for or not."""
    bodies = CombinedElasticity(1.0, 0.25, 0.0)
    dx = 2.2 / cells
    x = dx * (np.arange(cells) - (cells - 1) / 2)
    gap = (x[None, :] ** 2 + x[:, None] ** 2) * 3 / (8 * bodies.contact_modulus)
    influence = Influence(gap.shape, dx, dx, HalfSpaces(bodies))
    pressure = solve_normal(influence, gap, load=1.0).pressure
    rigid, forces = np.zeros((2, *gap.shape)), (0.43 * 0.3, 0.0) if by_force else (None, None)
    rigid[0] = 0.0 if by_force else 0.5 * 0.3 / 4.12
    found = solve_rolling(influence, 0.3 * pressure, rigid, forces)
    assert found.products <= most
    assert found.residual <= 1e-6
    assert found.splitting == 0
