"""Loading frequencies of classes of axles: the rules by hand, the road that follows, and the life that says so."""

import math
from dataclasses import replace

import numpy as np
import pytest
from tests.cases import ONE_AXLE

from treadload.case import Case
from treadload.catalogue import mixes
from treadload.damage import AxleClass, Season
from treadload.damage.frequency import LoadingFrequency, contact_radius
from treadload.errors import InputError
from treadload.life.seasons import frequencies, laws_of, layer_temperatures, roads_of, warmed
from treadload.materials import GlobalAging
from treadload.pavement import Pavement, TemperatureProfile

ROAD = Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")


def test_the_rule_of_the_mepdg_by_hand():
    # One course of 0.2 m, 64 times as stiff as its soil: z_eff = 0.1 x 4; 70 km/h over 2 (0.1 + 0.4) m.
    found = LoadingFrequency().frequencies([0.2], [6.4e9, 1e8], 70 / 3.6, 0.1)
    assert found == pytest.approx([70 / 3.6 / (2 * (0.1 + 0.4))])
    # Two courses: the lower one below all of the upper's depth.
    two = LoadingFrequency().frequencies([0.1, 0.2], [6.4e9, 0.8e9, 1e8], 20.0, 0.1)
    assert two == pytest.approx([20 / (2 * (0.1 + 0.2)), 20 / (2 * (0.1 + 0.4 + 0.2))])
    angular = LoadingFrequency("mepdg", angular=True).frequencies([0.2], [6.4e9, 1e8], 70 / 3.6, 0.1)
    assert angular[0] == pytest.approx(found[0] / (2 * math.pi))


def test_the_rule_of_brown_by_hand():
    found = LoadingFrequency("brown").frequencies([0.2], [6.4e9, 1e8], 60 / 3.6, 0.1)
    time = 10 ** (0.5 * 0.1 - 0.2 - 0.94 * math.log10(60))
    assert found == pytest.approx([1 / (2 * math.pi * time)])


def test_the_road_settles_where_moduli_and_frequencies_agree():
    rule, each = LoadingFrequency(), [25.0] * 3
    road, found = rule.on(ROAD, each, 20.0, 0.12)
    moduli = [layer.elastic.modulus for layer in road.at_temperature(each, extrapolate=True).layers]
    assert rule.frequencies([0.06, 0.15], moduli, 20.0, 0.12) == pytest.approx(found, rel=2e-3)
    assert moduli[0] == mixes["EB-BBSG3"].modulus(25.0, frequency=found[0], extrapolate=True)
    assert found[0] > found[1]


def test_slow_classes_read_softer_roads_in_parts_that_age():
    season = Season("noon", 1.0, TemperatureProfile((0.0, 0.2), (30.0, 25.0)), ageing=GlobalAging(8.0, 12.0))
    fast = AxleClass("a", 1.0, 40e3, 8e5, speed=25.0, frequency=LoadingFrequency())
    slow = replace(fast, speed=2.0)
    roads = [warmed(ROAD, (), season, row).road for row in (fast, slow, replace(fast, frequency=None))]
    surface = [road.layers[0].elastic.modulus for road in roads]
    assert surface[0] > surface[1]
    assert surface[2] == warmed(ROAD, (), season).road.layers[0].elastic.modulus
    found, ratios = frequencies(ROAD, season, slow)
    assert len(found) == len(ratios) == 6
    assert ratios[0] == pytest.approx(surface[1] / surface[2])
    assert contact_radius(40e3, 8e5) == pytest.approx(math.sqrt(0.05 / math.pi))


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (
            "passes_per_year = 1e5",
            'passes_per_year = 1e5\nfrequency = "mepdg"',
            "follows from its speed",
        ),
        ("passes_per_year = 1e5", "passes_per_year = 1e5\nangular = true", "angular belongs to a frequency"),
        ("passes_per_year = 1e5", 'passes_per_year = 1e5\nfrequency = "fast"', "mepdg"),
    ],
)
def test_bad_frequencies_of_a_case_are_refused(old, new, said):
    text = ONE_AXLE.replace(old, new) + '\n[[criteria]]\nname = "soil"\nlaw = "french-subgrade"\n'
    with pytest.raises(InputError, match=said):
        Case.from_text(text)


def test_a_mix_of_one_frequency_is_refused():
    road = Pavement.from_catalogue("6 BBME3 / 15 GB3 / PF3")
    with pytest.raises(InputError, match="tabulated at 10 Hz only"):
        LoadingFrequency().on(road, [20.0] * 3, 20.0, 0.12)


@pytest.mark.slow
def test_the_life_says_what_its_frequencies_change():
    from treadload.steps import run

    text = ONE_AXLE.replace("passes_per_year = 1e5", 'passes_per_year = 1e5\nfrequency = "mepdg"').replace(
        'name = "axle"', 'name = "axle"\nspeed = "10 km/h"'
    )
    criteria = '\n[[criteria]]\nname = "base"\nlaw = "french-bituminous"\nlayer = "EB-GB3"\nrisk = 0.05\n'
    own = run(Case.from_text(text + criteria), leave_out=("sensitivity",)).life
    plain = run(Case.from_text(ONE_AXLE + criteria), leave_out=("sensitivity",)).life
    # Slow traffic on a softer road.
    assert own.years("base") < plain.years("base")
    assert f"{own.years('base'):.3g} years with these frequencies, {plain.years('base'):.3g} without" in own.summary()
    assert np.isfinite(own.years("base"))


INSTITUTE = '\n[[criteria]]\nname = "base"\nlaw = "asphalt-institute"\nlayer = "EB-GB3"\n'


def test_a_law_by_modulus_reads_the_modulus_that_is_solved():
    """Of the part of an old course at its depth's temperature, at the frequency of the class."""
    (criterion,) = Case.from_text(ONE_AXLE + INSTITUTE).build_criteria()
    season = Season("noon", 1.0, TemperatureProfile((0.0, 0.2), (30.0, 25.0)), ageing=GlobalAging(8.0, 12.0))
    fast = AxleClass("a", 1.0, 40e3, 8e5, speed=25.0, frequency=LoadingFrequency())
    classes = (fast, replace(fast, speed=2.0), replace(fast, frequency=None))
    roads = roads_of(ROAD, (criterion,), (season,), classes)
    laws = laws_of(roads, layer_temperatures(ROAD, (criterion,), (season,)))[0]
    solved = [own[0].road.layers[5].elastic.modulus for own in roads.by_class]
    assert [row[0].modulus for row in laws] == solved
    assert solved[0] > 1.3 * solved[1]
    # As given: young, at 10 Hz.
    given = criterion.law_at(float(layer_temperatures(ROAD, (criterion,), (season,))[0, 0]))
    assert solved[2] > 1.05 * given.modulus


@pytest.mark.slow
def test_a_slow_class_is_judged_by_the_law_of_its_soft_mix():
    from treadload.steps import run

    text = ONE_AXLE.replace("passes_per_year = 1e5", 'passes_per_year = 1e5\nfrequency = "mepdg"').replace(
        'name = "axle"', 'name = "axle"\nspeed = "10 km/h"'
    )
    life = run(Case.from_text(text + INSTITUTE), leave_out=("sensitivity",)).life
    ((law,),) = life.class_laws[0]
    given = life.criteria[0].law_at(15.0)
    assert law.modulus < 0.8 * given.modulus
    reading = float(life.dataset["class_reading"][0, 0, 0])
    # One axle that does not wander, in one season: Miner's sum by hand, with E^-0.854.
    assert float(life.dataset["life_passes"][0]) == pytest.approx(float(law.allowable_passes(reading)), rel=1e-9)
    before = float(given.allowable_passes(reading))
    assert float(life.dataset["life_passes"][0]) == pytest.approx(before * (law.modulus / given.modulus) ** -0.854)
    print(law.modulus, given.modulus, life.dataset["life_passes"].values, before)
