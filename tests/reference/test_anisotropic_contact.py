"""Contact on tilted axes against Hertz's pressure in one integral, and against itself turned round."""

import numpy as np
import pytest
from tests.grain import LEANING, STRAIGHT, TILTED

import treadload as tl
from treadload.contact.bodies import Influence, Sum, surface_of
from treadload.contact.solvers.coupling import Surfaces, solve_coupled
from treadload.contact.solvers.shift import solve_shift
from treadload.grid import Grid
from treadload.validation.closed_forms import hertz
from treadload.validation.grain import axes_of, hertz_on_grain, pressed

LOAD = 1e6
SPHERE = np.eye(2) / 2
SADDLE = np.array([[0.5, 0.1], [0.1, 0.9]])


@pytest.mark.parametrize("curvature", [SPHERE, SADDLE], ids=["sphere", "ellipse"])
@pytest.mark.parametrize("material", [LEANING, TILTED, STRAIGHT], ids=["leaning", "tilted", "straight"])
def test_hertz_on_tilted_axes_and_its_rate(material, curvature):
    exact = hertz_on_grain(material, curvature, LOAD)
    width = 2.6 * exact.axes[0]
    errors = []
    for cells in (16, 32, 64):
        found = pressed(material, curvature, LOAD, cells, width)
        errors.append(abs(found.approach / exact.approach - 1))
        assert found.iterations <= 12
    # The bound at 64 cells; measured 0.8e-4 to 1.0e-4, and second order.
    assert errors[-1] < 5e-4
    assert np.log2(errors[0] / errors[-1]) / 2 > 1.5
    assert found.pressure.max() == pytest.approx(exact.peak, rel=1e-3)
    ratio, angle = axes_of(found.pressure)
    assert ratio == pytest.approx(exact.axes[0] / exact.axes[1], rel=1e-3)
    # Half a cell at the end of the long axis is 0.6°; the moments know it better.
    assert np.degrees(abs(angle - exact.angle)) < 0.1


def test_the_witness_is_hertz_of_equal_moduli_and_fits_the_coefficients():
    same = tl.materials.Orthotropic([1e9] * 3, [1e9 / 2.6] * 3, [0.3] * 3)
    exact, known = hertz_on_grain(same, np.diag([0.25, 1.0]), LOAD), hertz(2.0, 0.5, LOAD, 1e9 / 0.91)
    assert exact.approach == pytest.approx(known.approach, rel=1e-12)
    assert exact.axes == pytest.approx((known.a, known.b), rel=1e-12)
    assert exact.angle == pytest.approx(0, abs=1e-9)


def test_hertz_s_pressure_makes_the_paraboloid_of_the_witness():
    exact, errors = hertz_on_grain(TILTED, SADDLE, LOAD), []
    for cells in (24, 48, 96):
        step = 2.6 * exact.axes[0] / cells
        x = step * (np.arange(cells) - 0.5 * (cells - 1))
        x, y = np.meshgrid(x, x)

        def form(m, x=x, y=y):
            return m[0, 0] * x * x + 2 * m[0, 1] * x * y + m[1, 1] * y * y

        inside = 1 - form(exact.shape)
        pressure = exact.peak * np.sqrt(np.maximum(inside, 0))
        body = surface_of(TILTED, is_tire=False)
        sunk = Influence((cells, cells), step, step, body).normal(pressure)
        errors.append(np.abs(sunk - exact.approach + form(SADDLE))[inside > 0.2].max() / exact.approach)
    # Of the cells at the rim, where the pressure rises like a root.
    assert errors[2] < 1e-3
    assert errors[2] < 0.5 * errors[1] < 0.25 * errors[0]


def test_a_shift_turned_by_a_right_angle_is_the_shift_of_the_turned_solid():
    side = 21
    x = 1e-3 * (np.arange(side) - 10)
    bound = 2e7 * np.sqrt(np.maximum(0, 1 - (x[None] ** 2 + 1.7 * x[:, None] ** 2) / 8.3e-3**2))
    steel = surface_of(tl.Elastic(210e9, 0.3), is_tire=True)

    def shear(material, bound, forces):
        influence = Influence((side, side), 1e-3, 1e-3, Sum.of(steel, surface_of(material, is_tire=False)))
        return solve_shift(influence, bound, np.zeros((2, side, side)), forces, tolerance=1e-8)

    total = float(bound.sum()) * 1e-6
    here = shear(TILTED, bound, (0.6 * total, 0.3 * total))
    # x becomes y and y becomes -x: rows are turned against columns.
    there = shear(TILTED.rotated(yaw=np.pi / 2), np.rot90(bound, -1), (-0.3 * total, 0.6 * total))
    turned = np.rot90(here.shear, -1, axes=(1, 2))
    np.testing.assert_allclose(there.shear[0], -turned[1], rtol=0, atol=1e-6 * bound.max())
    np.testing.assert_allclose(there.shear[1], turned[0], rtol=0, atol=1e-6 * bound.max())
    assert there.rigid == pytest.approx((-here.rigid[1], here.rigid[0]), rel=1e-6)
    assert 0.2 < here.stick.sum() / (bound > 0).sum() < 0.9


def test_rolling_the_other_way_round_is_rolling_on_the_solid_turned_by_180_degrees():
    """Turned about the vertical, the scene is the same: creepages change sign, and so does the shear."""
    grid = Grid.centred(0.04, 0.036, 2e-3)
    gap = (grid.x[None] ** 2 + 1.4 * grid.y[:, None] ** 2) / 0.4
    steel = surface_of(tl.Elastic(210e9, 0.3), is_tire=True)

    def shear(material, **asked):
        influence = Influence(grid.shape, grid.dx, grid.dy, Sum.of(steel, surface_of(material, is_tire=False)))
        wheel = tl.Rolling(normal_load=3e3, friction=0.4, **asked)
        return solve_coupled(influence, Surfaces(grid, gap), wheel, check=lambda p: None, tolerance=1e-7)

    # The image in y = 0 of an axis that leans along travel is itself: sideways forces are images of each other.
    along = STRAIGHT.rotated(pitch=0.5)
    left, right = (shear(along, tractive_force=300.0, lateral_force=side) for side in (-200.0, 200.0))
    one, other = left.slipping.tangential, right.slipping.tangential
    scale = np.abs(one.shear).max()
    np.testing.assert_allclose(one.shear[0, ::-1], other.shear[0], rtol=0, atol=1e-5 * scale)
    np.testing.assert_allclose(one.shear[1, ::-1], -other.shear[1], rtol=0, atol=1e-5 * scale)
    # On one that leans across, driving straight makes a side force of its own, and turned round the opposite one.
    creeping = {"creepage_x": 1e-3, "creepage_y": 0.0}
    there = [
        shear(STRAIGHT.rotated(yaw=yaw, roll=roll), **creeping).slipping.tangential.shear.sum((1, 2))
        for yaw, roll in ((0.4, 0.5), (-0.4, -0.5))
    ]
    assert there[0][0] == pytest.approx(there[1][0], rel=1e-5)
    assert there[0][1] == pytest.approx(-there[1][1], rel=1e-5)
    assert abs(there[0][1]) > 0.01 * abs(there[0][0])


@pytest.mark.slow
def test_a_history_on_tilted_axes_ends_in_steady_rolling():
    x = 2e-3 * (np.arange(20) - 9.5)
    gap = (x[None, :] ** 2 + x[:, None] ** 2) / (2 * 0.1)
    tire = tl.Tire.from_height_map(gap, 2e-3, material=tl.Elastic(210e9, 0.3))
    road = tl.Pavement.half_space(TILTED)
    wheel = tl.Rolling(normal_load=1500.0, friction=0.5, tractive_force=300.0)
    steady = tl.solve_contact(tire, road, wheel, tolerance=1e-8)
    end = tl.contact.solve_transient(tire, road, wheel, distances=2e-3 * np.arange(1, 41), tolerance=1e-8).contact
    assert steady.stats["dundurs"] > 0.1
    for name in ("pressure", "traction_x", "traction_y"):
        one, other = end.dataset[name], steady.dataset[name]
        np.testing.assert_allclose(one, other, atol=2e-5 * float(np.abs(steady.dataset.pressure).max()))
    assert float(end.dataset.creepage_y) == pytest.approx(float(steady.dataset.creepage_y), rel=1e-4)
    # The grain alone pushes the wheel sideways.
    assert abs(float(steady.dataset.creepage_y)) > 0.05 * abs(float(steady.dataset.creepage_x))


@pytest.mark.slow
def test_a_tire_with_memory_rolls_on_a_tilted_road():
    """Neither reciprocal nor mirrored; where the road is stiff, it is the tire alone."""
    solid = tl.materials.Prony.standard_linear_solid(4e6, 3e6, 5e-3, 0.45)
    x = 4e-3 * (np.arange(24) - 11.5)
    gap = (x[None, :] ** 2 + x[:, None] ** 2) / 0.3
    tire = tl.Tire.from_height_map(gap, 4e-3, material=solid)
    wheel = tl.Rolling(normal_load=60.0, friction=0.5, creepage_x=2e-3, speed=5.0)
    stiff = tl.materials.Orthotropic([3e13, 1.5e13, 1e13], [0.6e13, 0.5e13, 0.4e13], [0.3] * 3).rotated(
        0.7, 0.6, 0.35
    )
    found = tl.solve_contact(tire, tl.Pavement.half_space(stiff), wheel, tolerance=1e-8).dataset
    rigid = tl.solve_contact(tire, tl.Pavement.half_space(tl.Elastic(1e17, 0.3)), wheel, tolerance=1e-8).dataset
    scale = float(rigid.pressure.max())
    for name in ("pressure", "traction_x", "traction_y"):
        # The road gives 3e-7 of the compliance.
        np.testing.assert_allclose(found[name], rigid[name], rtol=0, atol=1e-5 * scale)
