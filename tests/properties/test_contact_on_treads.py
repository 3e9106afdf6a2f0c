"""The conditions of contact on treads of every kind, under everything a wheel does."""

import pytest

from treadload.contact import Rolling, solve_contact
from treadload.materials import Elastic
from treadload.pavement import Pavement
from treadload.tire import LateralGrooves, Tire, TreadProfile, equal_ribs, example_mesh
from treadload.validation.tires import contact_conditions

ROAD = Pavement.half_space(Elastic(5.4e9, 0.35))
RIBS = TreadProfile(0.538, 2.0, 0.282, 0.010, grooves=equal_ribs(0.282, 4, 0.012, 0.015))
LUGS = TreadProfile(
    0.538,
    2.0,
    0.282,
    0.010,
    grooves=equal_ribs(0.282, 4, 0.012, 0.015),
    lateral=(
        LateralGrooves(0.04, 0.008, 0.010, angle=0.4),
        LateralGrooves(0.03, 0.006, 0.012, angle=-0.5, y_range=(0.05, 0.14)),
    ),
)
LIMIT = 0.7 * 32.5e3
MOTIONS = {
    "free": {},
    "driving": {"tractive_force": 10e3},
    "braking in a turn": {"tractive_force": -10e3, "lateral_force": 6e3, "spin": 0.05},
    "almost sliding": {"tractive_force": 0.999 * LIMIT},
    "almost sliding sideways": {"lateral_force": 0.99 * LIMIT},
    "turning on the spot": {"spin": 5.0},
    "given creepages": {"creepage_x": -0.05, "creepage_y": 0.02},
    "on ice": {"friction": 0.01},
}


def holds(tire, spacing, **motion):
    rolling = Rolling(**{"normal_load": 32.5e3, "friction": 0.7, **motion})
    contact = solve_contact(tire, ROAD, rolling, spacing=spacing)
    failed = [check for check in contact_conditions("", contact) if not check.passed]
    assert not failed, failed


@pytest.mark.parametrize("motion", MOTIONS.values(), ids=MOTIONS)
@pytest.mark.parametrize("poisson", [0.5, 0.47])
def test_ribs_on_coarse_cells(motion, poisson):
    holds(Tire.from_profile(RIBS, material=Elastic(3e6, poisson)), 8e-3, **motion)


@pytest.mark.slow
@pytest.mark.parametrize("motion", MOTIONS.values(), ids=MOTIONS)
@pytest.mark.parametrize("poisson", [0.5, 0.45])
def test_lugs(motion, poisson):
    holds(Tire.from_profile(LUGS, material=Elastic(3e6, poisson)), 3e-3, **motion)


@pytest.mark.slow
@pytest.mark.parametrize("motion", ["driving", "braking in a turn"])
def test_the_example_mesh(motion):
    pytest.importorskip("trimesh")
    holds(Tire.from_scan(example_mesh(), inflation_pressure=820e3), 3e-3, **MOTIONS[motion])
