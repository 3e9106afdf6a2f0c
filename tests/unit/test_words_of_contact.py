"""What a contact says of itself in words: the numbers of its fields, and what it caveats."""

import math
import re

import numpy as np
import pytest

from treadload.contact import Maneuver, Rolling, solve_contact, solve_transient
from treadload.contact.cautions import of_tire
from treadload.contact.contact_grid import BorderError, check_border
from treadload.errors import InputError
from treadload.grid import Grid
from treadload.materials import Elastic
from treadload.pavement import FRICTIONLESS, Layer, Pavement
from treadload.tire import Tire, TreadProfile

CELL = 8e-3
AT = CELL * (np.arange(24) - 11.5)
BOWL = np.add.outer(AT**2 / 0.9, AT**2 / 0.8)
TIRE = Tire.from_height_map(BOWL, CELL, material=Elastic(2e6, 0.45))
LAYERS = Pavement([Layer(Elastic(5e9, 0.35), 0.05), Layer(Elastic(1e7, 0.35))])


def number(text, pattern):
    return float(re.search(pattern, text)[1].replace("−", "-"))


@pytest.fixture(scope="module")
def turned():
    wheel = Rolling(normal_load=900.0, friction=0.6, tractive_force=150.0, lateral_force=-90.0, spin=0.3, speed=12.0)
    return solve_contact(TIRE, LAYERS, wheel)


def test_the_summary_is_that_of_its_fields(turned):
    text, data = turned.summary(), turned.dataset
    pressure, area = data.pressure.to_numpy(), CELL**2
    touching = pressure > 0
    shear = np.hypot(data.traction_x, data.traction_y).to_numpy()
    assert number(text, r"normal load +(\S+) kN") == pytest.approx(1e-3 * pressure.sum() * area, abs=5e-4)
    assert number(text, r"approach +(\S+) mm") == pytest.approx(1e3 * float(data.approach), abs=5e-3)
    assert number(text, r"contact area +(\S+) mm²") == pytest.approx(touching.sum() * 64, abs=0.5)
    mean = pressure[touching].mean()
    assert number(text, r"mean pressure +(\S+) kPa") == pytest.approx(1e-3 * mean, abs=0.5)
    assert number(text, r"peak pressure +(\S+) kPa") == pytest.approx(1e-3 * pressure.max(), abs=0.5)
    assert number(text, r"peak shear +(\S+) kPa") == pytest.approx(1e-3 * shear.max(), abs=0.5)
    assert number(text, r"tractive force +(\S+) N") == pytest.approx(150.0, abs=0.06)
    assert number(text, r"lateral force +(\S+) N") == pytest.approx(-90.0, abs=0.06)
    assert number(text, r"aligning moment +(\S+) N m") == pytest.approx(float(data.aligning_moment), abs=0.05)
    assert number(text, r"longitudinal creepage +(\S+)") == pytest.approx(float(data.creepage_x), abs=5e-6)
    assert number(text, r"lateral creepage +(\S+)") == pytest.approx(float(data.creepage_y), abs=5e-6)
    assert number(text, r"spin +(\S+) rad/m") == 0.3
    slipping = (data.state == 2).to_numpy().sum() / touching.sum()
    assert 0.05 < slipping < 0.95
    assert number(text, r"slip share of the contact +(\S+) %") == pytest.approx(100 * slipping, abs=0.05)
    lost = (data.traction_x * data.slip_x + data.traction_y * data.slip_y).to_numpy().sum() * area
    assert number(text, r"frictional energy loss per metre +(\S+) J/m") == pytest.approx(lost, abs=5e-4)
    assert number(text, r"frictional power +(\S+) W") == pytest.approx(12.0 * lost, abs=0.05)
    assert number(text, r"grid +(\d+) x") == 24
    assert "cells of 8 x 8 mm" in text
    assert text.splitlines()[1].startswith("tread ")
    assert f"{number(text, 'contact area +(.+) mm²'):.0f} mm²" in repr(turned)


def test_the_share_of_the_road_is_told_in_per_cent(turned):
    """Layers ten times as soft below make the road give way more: their sign is plus."""
    text = turned.summary()
    assert number(text, r"compliance by the road +(\S+) %") == pytest.approx(
        100 * turned.stats["road_share"], rel=0.01
    )
    assert number(text, r"change of compliance by layers +\+(\S+) %") == pytest.approx(
        100 * turned.stats["layer_share"], rel=0.06
    )
    assert turned.stats["layer_share"] > 0
    stiff = Pavement([Layer(Elastic(1e7, 0.35), 0.05), Layer(Elastic(5e9, 0.35))])
    assert solve_contact(TIRE, stiff, Rolling(normal_load=900.0, friction=0.6)).stats["layer_share"] < 0


@pytest.mark.parametrize(
    ("cell", "side", "along", "across"),
    [
        ((2, 0), "trailing", True, False),
        ((2, 5), "leading", True, False),
        ((0, 3), "left", False, True),
        ((3, 3), "right", False, True),
        ((0, 0), "trailing .*left", True, True),
    ],
)
def test_a_border_is_cut_where_pressure_stands_on_it(cell, side, along, across):
    pressure, grid = np.zeros((4, 6)), Grid.centred(0.06, 0.04, 0.01)
    check_border(pressure, grid)
    pressure[1:3, 2:4] = 1e5
    check_border(pressure, grid)
    pressure[cell] = 1.0
    with pytest.raises(BorderError, match=f"{side} .*1 cells.*60 x 40 mm") as caught:
        check_border(pressure, grid)
    assert (caught.value.along, caught.value.across) == (along, across)


def test_a_history_above_a_loose_interface_needs_a_wheel_without_friction():
    loose = Pavement([Layer(Elastic(5e9, 0.35), 0.05, bond=FRICTIONLESS), Layer(Elastic(1e8, 0.35))])
    asked = {"distances": [CELL], "road_compliance": "layers"}
    with pytest.raises(InputError, match="frictionless interface"):
        solve_transient(TIRE, loose, Rolling(normal_load=300.0, friction=0.5), **asked)
    smooth = solve_transient(TIRE, loose, Rolling(normal_load=300.0, friction=0.0), **asked)
    assert float(smooth.dataset.normal_load[-1]) == pytest.approx(300.0, rel=1e-6)


def test_a_modulus_by_inflation_is_doubted_for_a_tire_of_another_size():
    """The line was fitted to a truck tire: its diameter counts where it is known."""

    def caveats(radius, pressure=8e5):
        profile = TreadProfile(radius, 1.2, 0.2, 0.008)
        return [
            text for text in of_tire(Tire.from_profile(profile, inflation_pressure=pressure)) if "modulus" in text
        ]

    assert caveats(0.52) == []
    (small,) = caveats(0.3)
    assert "an outer diameter of 0.6 m" in small
    (soft,) = caveats(0.52, 2e5)
    assert "200 kPa" in soft
    assert "diameter" not in soft
    # Whoever gives the material knows it.
    known = Tire.from_profile(TreadProfile(0.3, 1.2, 0.2, 0.008), inflation_pressure=8e5, material=Elastic(3e6, 0.5))
    assert of_tire(known) == []


def test_a_wheel_at_rest_on_a_bend_slides_down_the_crossfall():
    """Without speed nothing pulls outward; the weight's part along the road is left, to the inside."""
    for radius in (50.0, -50.0):
        still = Maneuver.turning(radius, 0.0, crossfall=0.03)
        assert still.lateral == pytest.approx(-math.copysign(0.03, radius), rel=1e-12)
        assert still.spin == 1 / radius
        assert still.load_ratio == 1.0
    with pytest.raises(InputError, match="speed must be >= 0"):
        Maneuver.turning(50.0, -1e-9)


def test_a_vehicle_leans_on_its_outer_wheel():
    """Moments about the axle's middle by hand, on level ground: V²/gR to the side at the height of the centre."""
    radius, speed, height, track = 60.0, 12.0, 1.6, 2.0
    pull = speed**2 / (9.81 * radius)
    given = {"track": track, "centre_of_gravity": height}
    outer, inner = (Maneuver.turning(radius, speed, wheel=one, **given) for one in ("outer", "inner"))
    assert outer.load_ratio + inner.load_ratio == pytest.approx(2.0, rel=1e-12)
    # The two loads differ by so much that they balance the side force: (P₂ - P₁) t/2 = F h.
    assert (outer.load_ratio - inner.load_ratio) / 2 * track / 2 == pytest.approx(pull * height, rel=1e-12)
    assert outer.name.endswith("outer wheel")
    assert inner.name.endswith("inner wheel")
    # 9.81 m/s² are one weight of braking.
    assert Maneuver.braking(9.81).tractive == -1.0
    with pytest.raises(InputError, match=r"tips: .* from 0.625 on"):
        Maneuver.turning(radius, 24.0, **given)


def test_small_sizes_are_sizes():
    assert Maneuver.braking(0.5).tractive == pytest.approx(-0.5 / 9.81)
    for wrong in (0.0, -0.5, math.inf):
        with pytest.raises(InputError, match="deceleration must be"):
            Maneuver.braking(wrong)
