"""What loading a law was calibrated for, under a life, and criteria that do not govern."""

import numpy as np
import pytest

from treadload.damage import AxleClass, Climate, Criterion, FatigueLine, FrenchBituminous, Traffic
from treadload.damage.laws.american import AsphaltInstitute, MepdgBottomUp
from treadload.damage.laws.conditions import conditions_of
from treadload.damage.laws.indian import IrcFatigue
from treadload.damage.laws.of_layer import OnLayer, law_of_layer
from treadload.damage.miner import miner
from treadload.pavement import Pavement
from treadload.units import years_in_words


def test_what_a_law_does_not_state_is_not_stated():
    line = conditions_of(FatigueLine(100e-6, -0.2))
    assert line.endswith("frequency, temperature, controlled strain or stress, rest periods: not stated")


def test_the_french_line_is_of_10_degrees_and_25_hertz():
    line = conditions_of(FrenchBituminous(90e-6, -0.2, 0.3, 0.2, 0.05, 1.3))
    assert "25 Hz" in line
    assert "10 °C" in line
    assert "constant displacement" in line
    assert "NF P 98-261-1" in line


def test_a_line_of_a_mix_is_tested_as_its_mix_and_given_numbers_are_not():
    """The source of the catalogue states 10 °C and 25 Hz for ε₆; the user's numbers state nothing."""
    at = OnLayer("top", Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3"), 0)
    of_mix = law_of_layer(FatigueLine, at, {}, ("epsilon_6", "slope"))
    assert "temperature: 10 °C" in conditions_of(of_mix)
    assert conditions_of(of_mix).startswith("by tests of the layer's mix, without a shift")
    assert of_mix == FatigueLine(of_mix.epsilon_6, of_mix.slope)
    of_user = law_of_layer(FatigueLine, at, {"epsilon_6": 1e-4, "slope": -0.2}, ("epsilon_6", "slope"))
    assert "temperature" in conditions_of(of_user).rpartition(";")[2]
    assert conditions_of(of_user).endswith("not stated")


def test_laws_with_a_modulus_carry_frequency_and_temperature_by_it():
    for law in (AsphaltInstitute(5e9), IrcFatigue(3e9, 0.03, 0.11), MepdgBottomUp(5e9, 0.2, 0.06, 0.11)):
        assert "frequency: none of its own: through E" in conditions_of(law)


def test_a_law_of_another_package_without_the_fields_has_the_line_too():
    assert conditions_of(object()).endswith("rest periods: not stated")


def test_a_law_without_an_amplitude_takes_the_peak_of_a_cycle_and_says_so():
    class OfCycles(FatigueLine):
        def allowable_cycles(self, amplitude, mean):
            return self.allowable_passes(amplitude + mean)

    assert "each cycle by its peak" in conditions_of(FatigueLine(100e-6, -0.2))
    assert "each cycle by its amplitude and mean" in conditions_of(OfCycles(100e-6, -0.2))


def test_years_beyond_a_hundred_do_not_govern_and_name_their_repetitions():
    """A reading of ε₆ allows 10⁶ passes, 10 years; one of 0.5 ε₆ 2⁵ times as many, 320 years."""
    criteria = [Criterion(name, FatigueLine(100e-6, -0.2), 0, "bottom") for name in ("near", "far")]
    readings = np.array([100e-6, 50e-6])[:, None, None, None] * np.ones((2, 1, 1, 5))
    traffic = Traffic((AxleClass("all", 1.0, 32.5e3, 820e3),), 1e5)
    life = miner(readings, criteria, traffic, Climate.constant(15.0), y=np.arange(5) * 0.01)
    assert life.years("far") == pytest.approx(320)
    verdict = life.rows()[-1].text
    assert verdict.startswith("Service life: 10 years. Governing criterion: near. ")
    assert verdict.endswith("Does not govern: far with more than 100 years or 3.2e+07 load repetitions.")
    assert {row.group for row in life.rows() if row.key == "law_conditions"} == {"near", "far"}
    assert years_in_words(100.0) == "100 years"
