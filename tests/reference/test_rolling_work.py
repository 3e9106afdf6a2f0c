"""The work of rolling does not grow with the grid: products with the slip operator, nested, to 1e-6."""

from dataclasses import replace

import numpy as np
import pytest

from treadload.catalogue import tires
from treadload.contact.bodies.half_space import HalfSpaces, combined
from treadload.contact.bodies.influence import Influence
from treadload.contact.solvers.normal import solve_normal
from treadload.contact.solvers.rolling import rigid_slip, solve_rolling
from treadload.grid import Grid
from treadload.kernels.half_space.rectangle import CombinedElasticity
from treadload.materials import Elastic
from treadload.tire import LateralGrooves, Tire
from treadload.validation.patches import paraboloid

MOST_PRODUCTS = 100
GRIDS = [64, 128, 256, pytest.param(512, marks=pytest.mark.slow)]

RIBS = tires["315/80R22.5"]
LUGS = replace(
    RIBS, lateral=(LateralGrooves(pitch=0.06, width=0.012, depth=0.012, wall_angle=0.1, edge_radius=0.002),)
)


def on_tread(profile, cells, forces, spin):
    grid = Grid.centred(0.34, 0.34, 0.34 / cells)
    influence = Influence(grid.shape, grid.dx, grid.dy, HalfSpaces(combined(Elastic(3e6, 0.5), Elastic(5.4e9, 0.35))))
    pressure = solve_normal(influence, Tire.from_profile(profile).height_map(grid), load=32.5e3).pressure
    return solve_rolling(influence, 0.7 * pressure, rigid_slip(grid.x, grid.y, grid.dx, (0.0, 0.0), spin), forces)


def check(found):
    assert found.residual <= 1e-6
    assert found.products <= MOST_PRODUCTS
    assert found.splitting == 0


@pytest.mark.parametrize("cells", GRIDS)
def test_disc_at_half_saturation(cells):
    bodies = CombinedElasticity(1.0, 0.25, 0.0)
    patch = paraboloid(bodies, (1.0, 1.0), 4 * bodies.contact_modulus / 3, (cells, cells), (2.2 / cells,) * 2)
    check(patch.roll(0.3, (0.5 * 0.3 * patch.load / 4.12, 0.0)))


@pytest.mark.parametrize("cells", GRIDS)
def test_ribbed_tread_driving(cells):
    check(on_tread(RIBS, cells, (10e3, 0.0), 0.0))


@pytest.mark.parametrize("cells", GRIDS)
def test_lugged_tread_driving_in_a_turn(cells):
    found = on_tread(LUGS, cells, (10e3, 6e3), 1 / 20)
    check(found)
    assert np.isfinite(found.shear).all()
