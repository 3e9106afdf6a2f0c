"""Stiffness of bonds from shear tests, and bonds that soften with temperature."""

import math

import numpy as np
import pytest

import treadload as tl
from treadload.case.choices import BOND
from treadload.errors import InputError
from treadload.pavement import Bond, ShearTest, TestedBond

AREA = math.pi * 0.075**2


def curve(stiffness: float = 2e9, peak: float = 15e3, seat: float = 2e-4) -> tuple[np.ndarray, np.ndarray]:
    """A test that seats, rises straight to 70 % of its peak, rounds off and falls."""
    moved = np.linspace(0, 4e-3, 801)
    straight = stiffness * AREA * (moved - seat)
    rounded = peak * (1 - 0.3 * np.exp(-np.maximum(straight - 0.7 * peak, 0) / (0.3 * peak)))
    force = np.where(straight < 0.7 * peak, np.maximum(straight, 0.0), rounded)
    return moved, np.where(moved > 3e-3, force - 2e6 * (moved - 3e-3), force)


def test_a_shear_curve_gives_stiffness_strength_and_slip(tmp_path) -> None:
    moved, force = curve()
    test = ShearTest(moved, force, AREA, 20.0)
    # The branch is straight from 20 to 50 %: exact but for round-off of the regression.
    assert test.stiffness == pytest.approx(2e9, rel=1e-9)
    assert test.strength == pytest.approx(force.max() / AREA, rel=1e-12)
    assert test.slip == pytest.approx(moved[force.argmax()] - 2e-4, rel=1e-9)
    # The asphalt between the clamps shears, too: 1/k = 1/k_s + h/G.
    with_mix = ShearTest(moved, force, AREA, 20.0, height=5e-2, shear_modulus=1e9 * 200)
    assert 1 / with_mix.stiffness == pytest.approx(1 / 2e9 - 5e-2 / 2e11, rel=1e-9)
    file = tmp_path / "core.csv"
    rows = "\n".join(f"{1e3 * d:.6f};{1e-3 * f:.6f}" for d, f in zip(moved, force, strict=True))
    file.write_text(f"displacement (mm);force (kN)\n{rows}\n")
    # Six digits behind the point in the file.
    assert ShearTest.from_csv(file, area=AREA, temperature=20.0).stiffness == pytest.approx(2e9, rel=1e-5)


def test_a_road_takes_the_stiffness_of_its_temperature() -> None:
    tests = [ShearTest(*curve(k), AREA, warm) for k, warm in ((8e9, 0.0), (2e9, 20.0), (4.5e9, 20.0), (2e8, 40.0))]
    bond = TestedBond.of(tests)
    assert bond.stiffnesses == pytest.approx((8e9, 3e9, 2e8), rel=1e-6)
    assert bond.at(10.0).stiffness == pytest.approx(math.sqrt(8e9 * 3e9), rel=1e-6)
    road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.06, bond=bond), tl.Layer(tl.Elastic(1e9, 0.35))])
    assert isinstance(road.at_temperature(30.0).layers[0].bond, Bond)
    disc = tl.UniformDisc(0.12, 7e5)
    slid = [
        tl.life.solve_interfaces(disc, road.at_temperature(warm), x=[-0.1, 0.0, 0.1], y=[0.0])["jump_x"].max().item()
        for warm in (0.0, 20.0, 40.0)
    ]
    assert slid[0] < slid[1] < slid[2]
    made = BOND.build(BOND.read({"kind": "tested", "temperatures": [0, 40], "stiffnesses": ["8 GPa/m", "200 MPa/m"]}))
    assert made == TestedBond((0.0, 40.0), (8e9, 2e8))


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: ShearTest([0, 1e-3], [0.0], AREA, 20.0), "2 displacements and 1 forces"),
        (lambda: ShearTest(*curve(), 0.0, 20.0), "area of a core"),
        (lambda: ShearTest(curve()[0], -curve()[1], AREA, 20.0).stiffness, "force > 0; is its sign"),
        (
            lambda: ShearTest([0, 1e-3, 2e-3], [0, 7e3, 15e3], AREA, 20.0).stiffness,
            "5 rows or more between 20 and 50",
        ),
        (lambda: ShearTest(curve()[0][::-1], curve()[1], AREA, 20.0), "must not fall before the largest force"),
        (
            lambda: ShearTest(*curve(), AREA, 20.0, height=0.1, shear_modulus=1e7).stiffness,
            "give more than this test",
        ),
        (lambda: TestedBond((20.0,), (1e9,)), "two temperatures or more"),
        (lambda: TestedBond((20.0, 0.0), (1e9, 2e9)), "must rise"),
        (lambda: TestedBond((0.0, 20.0), (1e9, -1.0)), "stiffness of a tested bond"),
        (lambda: TestedBond((0.0, 20.0), (2e9, 1e9)).at(30.0), "tested from 0 to 20 °C has no stiffness at 30"),
        (lambda: TestedBond((0.0, 20.0), (2e9, 1e9)).stiffness, "waits for its temperature"),
    ],
)
def test_bad_tests_get_one_sentence(make, says: str) -> None:
    with pytest.raises(InputError, match=says):
        make()
