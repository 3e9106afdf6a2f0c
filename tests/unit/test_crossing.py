"""A wheel over a step, a joint or a plate: plain contact where there is none, mirrors, balance, closed forms."""

import math

import numpy as np
import pytest

import treadload as tl
from treadload.contact import cross_obstacle
from treadload.errors import InputError
from treadload.pavement import Relief, RoadJoint, RoadPlate, RoadStep
from treadload.tire import TreadProfile

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
TREAD = TreadProfile(rolling_radius=0.5, crown_radius=0.6, width=0.2)
TIRE = tl.Tire.from_profile(TREAD, material=tl.Elastic(4e6, 0.5))
FREE = tl.Rolling(normal_load=8e3, friction=0.0)
CELL = 8e-3


def crossed(relief, **more):
    given = {"positions": CELL * np.arange(-14, 15, 7), "spacing": CELL, **more}
    return cross_obstacle(TIRE, ROAD, given.pop("rolling", FREE), relief, **given)


def test_a_step_of_no_height_is_the_plain_contact_bit_for_bit():
    plain = tl.solve_contact(TIRE, ROAD, FREE, spacing=CELL)
    found = crossed(RoadStep(0.0))
    assert isinstance(RoadStep(0.0), Relief)
    for number in range(found.dataset.sizes["position"]):
        assert np.array_equal(found.dataset.pressure.values[number], plain.dataset.pressure.values)
    assert float(found.dataset.approach[2]) == float(plain.dataset.approach)


def test_the_load_is_carried_at_every_position_and_goes_over_to_the_other_side():
    found = crossed(RoadStep(5e-3), positions=[-0.2, -0.05, 0.0, 0.05, 0.2])
    data = found.dataset
    carried = data.pressure.sum(("x", "y")).values * CELL**2
    # The solver meets the load to round-off of the sum.
    assert np.allclose(carried, 8e3, rtol=1e-9)
    before, beyond = data.share_before.values, data.share_beyond.values
    assert before[0] > 0.99
    assert beyond[-1] > 0.99
    assert (np.diff(before) < 1e-9).all()
    # The axle rises by the step, once it is over it.
    assert float(data.approach[0] - data.approach[-1]) == pytest.approx(5e-3, abs=2e-5)
    assert float(data.edge_pressure.max()) > 1.2 * float(data.largest_pressure[0])
    assert "half-space" in " ".join(found.warnings)
    assert "the edge is sharp" in " ".join(found.warnings)


def test_an_edge_that_is_none_or_chamfered_is_not_called_sharp():
    for relief in (RoadStep(0.0), RoadStep(5e-3, chamfer=0.03)):
        assert "sharp" not in " ".join(crossed(relief, positions=[0.0]).warnings)


@pytest.mark.slow
@pytest.mark.parametrize(
    "relief", [RoadPlate(4e-3, 0.06), RoadJoint(0.024, 0.02, 0.006), RoadPlate(-4e-3, 0.09, round=True)]
)
def test_what_is_mirrored_has_a_mirrored_history(relief):
    data = crossed(relief).dataset
    # Tolerance of the contact, 1e-6 of the approach, on pressures of a few hundred kPa.
    assert np.allclose(data.pressure.values, data.pressure.values[::-1, :, ::-1], atol=2e-4 * 8e5)
    for name in ("approach", "contact_area", "largest_pressure", "edge_pressure"):
        assert np.allclose(data[name], data[name][::-1], rtol=2e-3), name
    assert np.allclose(data.share_before, data.share_beyond[::-1], atol=1e-3)


@pytest.mark.slow
def test_a_step_up_is_a_step_down_the_other_way():
    up, down = crossed(RoadStep(3e-3)).dataset, crossed(RoadStep(-3e-3)).dataset
    assert np.allclose(up.pressure.values, down.pressure.values[::-1, :, ::-1], atol=2e-4 * 8e5)


@pytest.mark.slow
def test_a_held_axle_takes_the_step_as_load():
    data = crossed(RoadStep(2e-3), hold="axle").dataset
    assert np.ptp(data.approach.values) == 0.0
    assert float(data.normal_load[0]) == pytest.approx(8e3, rel=1e-6)
    # Over the step it is the plain contact with 2 mm more of approach.
    deeper = tl.solve_contact(
        TIRE, ROAD, tl.Rolling(approach=float(data.approach[0]) + 2e-3, friction=0.0), spacing=CELL
    )
    far = crossed(RoadStep(2e-3), hold="axle", positions=[-0.2, 0.2]).dataset
    assert float(far.normal_load[-1]) == pytest.approx(float(deeper.dataset.normal_load), rel=1e-5)


def test_two_strips_of_a_flat_punch_over_a_joint_carry_what_the_closed_form_says():
    """A rigid flat punch of half width b over a joint of half width a, plane strain: p ~ |x|/√((b² - x²)(x² - a²)).

    Its share within |x| < c is that of a strip: ∫ = (2/π)·arcsin √((c² - a²)/(b² - a²)). A punch 40 times as long as
    wide is plane in its middle. Source: Gladwell (1980), Contact Problems in the Classical Theory of Elasticity.
    """
    cell, half, inner = 1e-3, 15.5e-3, 5e-3
    long = 401
    flat = np.zeros((long, 31))
    punch = tl.Tire.from_height_map(
        np.pad(flat, 2, constant_values=np.nan), cell, material=tl.Elastic(2e16, 0.3), name="punch"
    )
    found = cross_obstacle(
        punch, ROAD, tl.Rolling(normal_load=1e4, friction=0.0), RoadJoint(2 * inner, 0.05), positions=[0.0]
    )
    x, line = found.dataset.x.values, found.dataset.pressure.values[0][long // 2 + 2]
    assert (line[np.abs(x) < inner - 0.6 * cell] == 0).all()
    reach = 10.5e-3
    inside = np.abs(x) < reach
    share = line[inside].sum() / line.sum()
    exact = 2 / math.pi * math.asin(math.sqrt((reach**2 - inner**2) / (half**2 - inner**2)))
    # Cells of a tenth of a strip: half a cell of either edge is uncertain, 4 % of the share.
    assert share == pytest.approx(exact, rel=0.04)


def test_the_closed_form_of_two_strips_solves_the_equation_of_the_plane():
    """∫ p(s)/(x - s) ds = 0 on both strips: what is flat stays flat. With t = s² an integral of Cauchy's kind."""
    a, b = 0.35, 1.0
    middle, half = 0.5 * (a * a + b * b), 0.5 * (b * b - a * a)
    # Chebyshev's rule for ∫ dt/(√((b² - t)(t - a²)) (x² - t)) converges where x² lies between two of its nodes.
    count = 400
    nodes = middle + half * np.cos((np.arange(count) + 0.5) * np.pi / count)
    for number in (30, 120, 250, 370):
        at = middle + half * np.cos(number * np.pi / count)
        terms = np.pi / count / (at - nodes)
        assert abs(terms.sum()) < 1e-9 * np.abs(terms).sum()


@pytest.mark.slow
def test_the_approach_on_a_chamfered_step_converges_with_the_cells():
    """Of a chamfer that the cells resolve; pressure at an upright edge grows with every finer grid."""
    relief = RoadStep(4e-3, chamfer=0.048)
    approach = [
        float(crossed(relief, positions=[0.0], spacing=cell).dataset.approach[0]) for cell in (8e-3, 4e-3, 2e-3, 1e-3)
    ]
    error = np.abs(np.diff(approach))
    # First order at least: a halving of the cells takes half of the change or more.
    assert error[1] < 0.6 * error[0]
    assert error[2] < 0.6 * error[1]


@pytest.mark.slow
def test_sliding_at_the_edge_costs_work_where_it_happens():
    found = crossed(RoadStep(5e-3), rolling=tl.Rolling(normal_load=8e3, friction=0.6), spacing=CELL)
    data = found.dataset
    assert (data.friction_work_density.values >= 0).all()
    along = data.friction_work_density.max("y").values
    near = np.abs(data.road_x.values) < 0.05
    assert along[near].max() == along.max()
    assert "frictional energy loss per area" in found.summary()
    # Pressing lays work on all that is touched; more at the edge than on the plane before it.
    closed = data.closing_work.max("y").values
    assert closed[near].max() > closed[data.road_x.values < -0.06].max()


def test_heights_of_obstacles_are_those_that_are_drawn():
    x, y = np.array([-0.03, -0.01, 0.0, 0.01, 0.03]), np.array([0.0, 0.2])
    assert np.allclose(RoadStep(4e-3).height(x, y), [[0, 0, 2e-3, 4e-3, 4e-3]] * 2)
    assert np.allclose(RoadStep(4e-3, 0.04).height(x, y), [[0, 1e-3, 2e-3, 3e-3, 4e-3]] * 2)
    assert np.allclose(RoadJoint(0.03, 5e-3).height(x, y), [[0, -5e-3, -5e-3, -5e-3, 0]] * 2)
    assert np.allclose(RoadJoint(0.016, 9e-3, 4e-3).height(x, y)[0], [0, -2e-3, -9e-3, -2e-3, 0])
    assert np.allclose(RoadPlate(5e-3, 0.03, round=True).height(x, y)[1], 0)
    assert np.allclose(RoadPlate(5e-3, 0.03, 0.1).height(x, y), [[0, 5e-3, 5e-3, 5e-3, 0], [0] * 5])


@pytest.mark.parametrize(
    ("ask", "said"),
    [
        (lambda: RoadStep(5.0), "in metres"),
        (lambda: RoadStep(5e-3, -1.0), "chamfer must be"),
        (lambda: RoadJoint(0.0, 5e-3), "width of the joint"),
        (lambda: RoadJoint(0.01, 5e-3, 0.01), "does not fit"),
        (lambda: RoadPlate(5e-3, 0.6, 0.6, round=True), "no width"),
        (lambda: crossed(RoadStep(1e-3), hold="wheel"), "hold must be"),
        (lambda: crossed(RoadStep(1e-3), positions=[0.0, 1e-4]), "positions must ascend"),
        (lambda: crossed(RoadStep(1e-3), rolling=tl.Rolling(approach=5e-3, friction=0)), "needs its normal_load"),
        (lambda: crossed("a bump"), "relief must be"),
    ],
)
def test_bad_questions_are_refused_in_one_sentence(ask, said):
    with pytest.raises(InputError) as refused:
        ask()
    assert said in str(refused.value)
