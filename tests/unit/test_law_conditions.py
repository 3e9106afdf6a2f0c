"""What loading a law was calibrated for, under a life, and criteria that do not govern."""

import numpy as np
import pytest

from treadload.damage import AxleClass, Climate, Criterion, FatigueLine, FrenchBituminous, Traffic
from treadload.damage.laws.conditions import conditions_of
from treadload.damage.miner import miner
from treadload.units import years_in_words


def test_what_a_law_does_not_state_is_not_stated():
    line = conditions_of(FatigueLine(100e-6, -0.2))
    assert line.endswith("frequency, temperature, controlled strain or stress, rest periods: not stated")


def test_the_french_line_is_of_10_degrees_and_25_hertz():
    line = conditions_of(FrenchBituminous(90e-6, -0.2, 0.3, 0.2, 0.05, 1.3))
    assert "25 Hz" in line
    assert "10 °C" in line
    assert "controlled strain or stress, rest periods: not stated" in line


def test_a_law_of_another_package_without_the_fields_has_the_line_too():
    assert conditions_of(object()).endswith("rest periods: not stated")


def test_years_beyond_a_hundred_do_not_govern_and_name_their_repetitions():
    """A reading of ε₆ allows 10⁶ passes, 10 years; one of 0.5 ε₆ 2⁵ times as many, 320 years."""
    criteria = [Criterion(name, FatigueLine(100e-6, -0.2), 0, "bottom") for name in ("near", "far")]
    readings = np.array([100e-6, 50e-6])[:, None, None, None] * np.ones((2, 1, 1, 5))
    traffic = Traffic((AxleClass("all", 1.0, 32.5e3, 820e3),), 1e5)
    life = miner(readings, criteria, traffic, Climate.constant(15.0), y=np.arange(5) * 0.01)
    assert life.years("far") == pytest.approx(320)
    verdict = life.rows()[-1].text
    assert "near governs and ends the service life after 10 years" in verdict
    assert "Does not govern: far: more than 100 years (3.2e+07 repetitions)" in verdict
    assert {row.group for row in life.rows() if row.key == "law_conditions"} == {"near", "far"}
    assert years_in_words(100.0) == "100 years"
