"""Strength of bonds by temperature and rate: laws, their fit, how a wheel's passage sets the rate, and in a life."""

import math

import numpy as np
import pytest

from treadload.case.criteria import CRITERION
from treadload.citations import COMMONLY_QUOTED
from treadload.damage import AxleClass, Climate, Criterion, ShearFatigue, TimedStrength, Traffic, passage_rate
from treadload.damage.laws.bond_by_test import LEUTNER_RATE, QUOTED_SOFTENING, utilisation_of
from treadload.errors import InputError
from treadload.life.design import Design
from treadload.life.solve import solve_life
from treadload.materials import Elastic
from treadload.pavement import Layer, Pavement
from treadload.tire import Tire

LAW = TimedStrength(0.85e6, 0.05, 0.2, friction_angle=math.radians(30))


def test_the_strength_is_an_exponential_of_temperature_and_a_power_of_the_rate() -> None:
    # The law written out: round-off of four products.
    warm = LAW.at(35.0).at_rate(10 * LEUTNER_RATE)
    wanted = 0.85e6 * math.exp(-0.05 * 15) * 10**0.2 + 0.3e6 * math.tan(math.radians(30))
    assert float(warm.utilisation(wanted, 0.3e6)) == pytest.approx(1, rel=1e-12)
    # Time and temperature stand for each other: so many decades of rate for so many kelvin.
    kelvin = 0.2 * math.log(10) / 0.05
    assert LAW.at(20 + kelvin).at_rate(10 * LEUTNER_RATE).cohesion == pytest.approx(0.85e6, rel=1e-12)
    assert LAW.at(40.0).at(20.0).cohesion == pytest.approx(0.85e6, rel=1e-12)


def test_the_quoted_softening_gives_the_ratios_that_it_was_taken_from() -> None:
    # 2.3 between 10 and 25 °C, 6 between 25 and 60 °C; one exponential for both is within 8 % of each.
    assert math.exp(15 * QUOTED_SOFTENING) == pytest.approx(2.3, rel=0.08)
    assert math.exp(35 * QUOTED_SOFTENING) == pytest.approx(6, rel=0.08)
    least = TimedStrength.leutner_minimum("wearing")
    assert least.caveat.count(COMMONLY_QUOTED) == 1
    assert least.cohesion == pytest.approx(15e3 / (math.pi * 0.075**2))


def test_a_law_is_found_again_in_its_tests() -> None:
    warm, fast, pressed = np.meshgrid([0.0, 10.0, 20.0, 30.0], [1e-5, 1e-4, 1e-3], [0.0, 0.2e6, 0.4e6])
    bears = 0.85e6 * np.exp(-0.05 * (warm - 20)) * (fast / LEUTNER_RATE) ** 0.2 + pressed * math.tan(0.6)
    found = TimedStrength.fit(bears.ravel(), warm.ravel(), rate=fast.ravel(), normal=pressed.ravel())
    # Tests without scatter: the tolerance of the least squares, 1e-8, through a square root.
    assert found.softening == pytest.approx(0.05, rel=1e-4)
    assert found.rate_exponent == pytest.approx(0.2, rel=1e-4)
    assert found.friction_angle == pytest.approx(0.6, rel=1e-4)
    assert found.at(20.0).at_rate(LEUTNER_RATE).cohesion == pytest.approx(0.85e6, rel=1e-4)
    assert found.scatter < 1e-4
    # With scatter of 5 % its own estimate is within a third of it: 36 tests.
    noisy = bears * np.random.default_rng(1).normal(1, 0.05, bears.shape)
    again = TimedStrength.fit(noisy.ravel(), warm.ravel(), rate=fast.ravel(), normal=pressed.ravel())
    assert again.scatter == pytest.approx(0.05, rel=0.33)
    assert again.softening == pytest.approx(0.05, rel=0.1)


def test_beyond_its_tests_a_strength_stays_on_the_safe_side_and_says_so() -> None:
    law = TimedStrength(0.85e6, 0.05, 0.2, temperatures=(10.0, 40.0), rates=(1e-5, 1e-2))
    assert law.at(0.0).cohesion == law.at(10.0).cohesion
    assert "below 10 °C" in law.at(0.0).caveat
    assert law.at(50.0).cohesion == pytest.approx(0.85e6 * math.exp(-1.5), rel=1e-12)
    assert "above 40 °C" in law.at(50.0).caveat
    assert law.at_rate(1.0).cohesion == law.at_rate(1e-2).cohesion
    assert "faster than 600 mm/min" in law.at_rate(1.0).caveat
    assert law.at_rate(1e-6).cohesion < law.at_rate(1e-5).cohesion
    assert "is extrapolated" in law.at_rate(1e-6).caveat
    assert not law.at(25.0).at_rate(1e-3).caveat


def test_a_wheel_shears_a_bond_in_the_time_that_it_takes_to_reach_it() -> None:
    # 0.1 + 0.06 m at 20 m/s are 8 ms; a test that fails at 2 mm must run 0.25 m/s to take as long.
    assert passage_rate(20.0, 0.06, 0.2) == pytest.approx(0.25, rel=1e-12)
    assert LAW.passing(20.0, 0.06, 0.2).cohesion == LAW.at_rate(0.25).cohesion
    assert "no speed" in LAW.passing(None, 0.06, 0.2).caveat
    assert TimedStrength(1e6, 0.05).passing(None, 0.06, 0.2).caveat == ""


def test_a_life_reads_the_bond_by_season_and_speed_and_names_its_interface() -> None:
    tire = Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
    layers = [Layer(Elastic(7e9, 0.35), 0.06, name="wearing course"), Layer(Elastic(1e9, 0.35), name="base")]
    bond = Criterion.of_bond("bond", TimedStrength(1e6, 0.05, 0.2, rates=(1e-5, 1.0)), ShearFatigue(-0.1))
    classes = tuple(
        AxleClass(name, 0.5, 32.5e3, 820e3, speed=speed) for name, speed in (("slow", 2.0), ("fast", 20.0))
    )
    climate = Climate.equal_parts([20.0, 40.0], ("spring", "summer"))
    life = solve_life(
        Design(tire, Pavement(layers), Traffic(classes, 1e5), climate, [bond], spacing=12e-3, tolerance=0.0),
        workers=1,
    )
    read = life.dataset["class_reading"].sel(criterion="bond")
    # One elastic road: only the strength differs, by e^(0.05 · 20) and 10^0.2. A tire has no memory here.
    ratio = read.sel(season="summer") / read.sel(season="spring")
    np.testing.assert_allclose(ratio, math.e, rtol=1e-6)
    np.testing.assert_allclose(read.sel(axle_class="slow") / read.sel(axle_class="fast"), 10**0.2, rtol=1e-6)
    (largest,) = [row for row in life.rows() if row.group == "bond" and row.key == "largest_reading"]
    assert largest.value == pytest.approx(float(life.dataset["largest_reading"].sel(criterion="bond")))
    (depth,) = [row for row in life.rows() if row.group == "bond" and row.key == "read_depth"]
    assert depth.note == "interface 1, below wearing course"
    assert largest.sentence in life.summary()


def test_fatigue_is_a_line_through_cyclic_tests() -> None:
    used = np.array([0.2, 0.3, 0.5, 0.7])
    law = ShearFatigue.fit(used, (used / 0.9) ** -6.0)
    assert law.slope == pytest.approx(-1 / 6, rel=1e-9)
    assert law.single_pass == pytest.approx(0.9, rel=1e-9)
    with pytest.raises(InputError, match="needs 3 tests or more"):
        ShearFatigue.fit([0.2, 0.3], [1e5, 1e4])
    with pytest.raises(InputError, match="columns that were exchanged"):
        ShearFatigue.fit([0.2, 0.3, 0.5], [1e3, 1e4, 1e5])


def test_a_case_gives_the_tests_of_a_bond() -> None:
    table = {
        "name": "bond", "law": "shear-fatigue", "layer": 1, "slope": -0.1,
        "reads": {
            "quantity": "utilisation", "cohesion": "0.85 MPa", "softening": 0.053, "rate_exponent": 0.2,
            "temperature": 20, "temperatures": [10, 60],
        },
    }  # fmt: skip
    road = Pavement([Layer(Elastic(7e9, 0.35), 0.06), Layer(Elastic(1e9, 0.35))])
    made = CRITERION.read(table).on(road)
    assert made.quantity.strength == TimedStrength(0.85e6, 0.053, 0.2, temperatures=(10.0, 60.0))
    assert not isinstance(utilisation_of(0.85e6).strength, TimedStrength)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: TimedStrength(0.0, 0.05), "cohesion of a bond"),
        (lambda: TimedStrength(1e6, -0.05), "softening must be >= 0 per kelvin, got -0.05"),
        (lambda: TimedStrength(1e6, 0.05, 1.0), r"rate_exponent must lie in \[0, 1\), got 1"),
        (lambda: TimedStrength(1e6, 0.05, temperatures=(40.0, 10.0)), "turn them round"),
        (lambda: TimedStrength.fit([1e6, 2e6], [10.0, 20.0]), "3 tests or more, got 2"),
        (lambda: TimedStrength.fit([1e6, 2e6, 4e6], [10.0, 20.0, 30.0]), "bear more where it is warmer"),
        (lambda: TimedStrength.fit([1e6, 2e6, -4e6], [10.0, 20.0, 30.0]), "strengths and rates > 0"),
        (lambda: passage_rate(0.0, 0.06, 0.2), "speed of a wheel"),
        (lambda: LAW.at(math.nan), "must be finite, got nan"),
    ],
)
def test_bad_tests_get_one_sentence(make, says: str) -> None:
    with pytest.raises(InputError, match=says):
        make()
