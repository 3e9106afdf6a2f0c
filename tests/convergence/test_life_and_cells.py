"""The life under the default reading does not move with the cells of the contact."""

import pytest

import treadload as tl

LINE = tl.FatigueLine(120e-6, -0.2)
HALF = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
DRIVING = tl.Rolling(normal_load=32.5e3, tractive_force=10e3, friction=0.7)
TURNING = tl.Maneuver.turning(12.0, 20 / 3.6).rolling(32.5e3, 0.7, speed=20 / 3.6)


def passes(tire, wheel, spacing, **local):
    contact = tl.solve_contact(tire, HALF, wheel, spacing=spacing)
    response = tl.solve_response(contact, HALF, depths=[0.0, 0.02])
    return float(tl.assess(response, LINE, **local).dataset["worst_passes"])


def ribs():
    return tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3)


def scan():
    pytest.importorskip("trimesh")
    return tl.Tire.from_scan(tl.example_mesh(), inflation_pressure=820e3)


# A life that moves by 5 % is a strain that moves by 1 %. The scan has its shoulder between two cells: its strain
# moves by 1.5 %, its life by 8 %.
@pytest.mark.slow
@pytest.mark.parametrize(
    ("tire", "wheel", "bound"), [(scan, DRIVING, 0.10), (ribs, DRIVING, 0.05), (ribs, TURNING, 0.05)]
)
def test_life_hardly_moves_with_the_cells(tire, wheel, bound):
    coarse, fine = (passes(tire(), wheel, spacing) for spacing in (3e-3, 1.5e-3))
    assert coarse == pytest.approx(fine, rel=bound)


@pytest.mark.slow
def test_points_have_no_such_limit():
    """What the default replaces: from 6 to 1.5 mm the passes at the worst point fall to less than a twentieth."""
    tire = ribs()
    assert passes(tire, DRIVING, 1.5e-3, depth=0.0) < 0.05 * passes(tire, DRIVING, 6e-3, depth=0.0)
    assert passes(tire, DRIVING, 1.5e-3) > 0.4 * passes(tire, DRIVING, 6e-3)
