"""Daily thermal stress in the growth of a crack: an elastic slab in closed form, and years with it."""

import math
from dataclasses import replace

import numpy as np
import pytest

import treadload as tl
from treadload.damage.climate import Climate, Season, TypicalDays
from treadload.damage.growth import CrackGrowth, ParisLaw
from treadload.damage.growth.intensity import Way
from treadload.damage.thermal import DAYS, Thermal
from treadload.life.crossings import distances_to
from treadload.life.growth import grow_cracks
from treadload.life.solve import solve_life
from treadload.life.thermal_growth import Ends, daily_intensity
from treadload.materials import Arrhenius, Prony, Thermorheological
from treadload.pavement import TemperatureProfile

ALPHA, NU, SWING = 2e-5, 0.3, 8.0
HOURS, DEPTHS = np.arange(24.0), np.array([0.0, 0.1, 0.4])
# Nearly elastic: nothing relaxes within years.
FROZEN = Thermorheological(Prony(1e10, ((0.5, 1e13),), NU), Arrhenius(1e-6, 10.0))
LAW = ParisLaw(1e-3, 3.0)


def climate(thermal=None):
    day = 5.0 + SWING * np.cos(2 * math.pi * (HOURS - 15) / 24)
    temperatures = np.broadcast_to(day[:, None], (12, 24, 3))
    days = TypicalDays(HOURS, DEPTHS, temperatures)
    profile = TemperatureProfile(DEPTHS.tolist(), [5.0] * 3)
    return Climate((Season("all year", 1.0, profile),), days=days, thermal=thermal)


def slab():
    return tl.Pavement([tl.Layer(FROZEN, 0.3, name="slab"), tl.Layer(tl.Elastic(1e10, NU))])


def intensity(way, lengths, friction=0.0, thermal=None):
    asked = CrackGrowth("top", law=LAW, friction=friction)
    return daily_intensity(
        slab(),
        climate(thermal or Thermal(ALPHA)),
        distances_to(0.3),
        way,
        lengths,
        asked,
        Ends(0.0, 0.3, upwards=False),
    )


def test_an_elastic_slab_is_an_edge_crack_under_the_tension_of_the_night():
    lengths = np.array([0.02, 0.05])
    found = intensity(Way(np.array([0.0, 0.3]), np.zeros(2)), lengths)
    # The day alternates by SWING about its mean: by day the faces are pressed together, so that the range is the
    # tension of the coldest hour, uniform over depth, in a half-plane: the layer below has the same modulus.
    stress = 1e10 * ALPHA * SWING / (1 - NU)
    exact = 1.1215 * stress * np.sqrt(math.pi * lengths)
    np.testing.assert_allclose(found.ranges, np.broadcast_to(exact, (12, 2)), rtol=2e-3)
    yearly = found.yearly_growth(lambda road, k, size: LAW.growth(size))
    np.testing.assert_allclose(yearly, sum(DAYS) * LAW.growth(exact), rtol=6e-3)
    twice = intensity(Way(np.array([0.0, 0.3]), np.zeros(2)), lengths, thermal=Thermal(2 * ALPHA))
    np.testing.assert_allclose(twice.ranges, 2 * found.ranges, rtol=1e-6)


def test_a_crack_that_leans_is_opened_by_night_and_sheared():
    angle = math.radians(15)
    way = Way(np.array([0.0, 0.3]), np.array([0.0, 0.3 * math.tan(angle)]))
    # Murakami (1987), at 15°, over the crack's own length: 1.068 and 0.174.
    root = 1e10 * ALPHA * SWING / (1 - NU) * math.sqrt(math.pi * 0.02 / math.cos(angle))
    rough = intensity(way, np.array([0.02]), friction=0.5)
    # By day the faces hold by friction: shear is tan 15° = 0.27 of the pressure.
    assert rough.ranges[0, 0] == pytest.approx(root * math.hypot(1.068, 0.174), rel=5e-3)
    smooth = intensity(way, np.array([0.02]))
    assert smooth.ranges[0, 0] > 1.02 * rough.ranges[0, 0], "without friction they slide back by day"


def test_a_climate_that_does_not_ask_has_none():
    assert daily_intensity(
        slab(), climate(), distances_to(0.3), Way(np.array([0.0, 0.3]), np.zeros(2)), np.array([0.02]),
        CrackGrowth("top", law=LAW), Ends(0.0, 0.3, upwards=False),
    ) is None  # fmt: skip
    stone = tl.Pavement([tl.Layer(tl.catalogue.mixes["GC-T3"], 0.3), tl.Layer(tl.Elastic(1e8, NU))])
    assert daily_intensity(
        stone, climate(Thermal()), distances_to(0.3), Way(np.array([0.0, 0.3]), np.zeros(2)), np.array([0.02]),
        CrackGrowth("top", law=LAW), Ends(0.0, 0.3, upwards=False),
    ) is None  # fmt: skip


@pytest.mark.slow
def test_cold_days_shorten_the_growth_of_a_crack():
    from test_crack_growth import solved

    design, _ = solved()
    mixes = tl.catalogue.mixes
    road = tl.Pavement([tl.Layer(mixes["EB-BBSG3"], 0.06), tl.Layer(mixes["EB-GB3"], 0.14), tl.Layer(mixes["PF3"])])
    criterion = tl.damage.Criterion("top", tl.FatigueLine(6e-6, -0.2), 0, "top")
    asked = CrackGrowth("top", law=ParisLaw(5e-4, 4.0, 0.2), steps=4, trace="transverse")
    grown = []
    for thermal in (None, Thermal(3.5e-5)):
        here = replace(design, road=road, climate=climate(thermal), criteria=(criterion,))
        grown.append(grow_cracks(here, solve_life(here), asked))
    without, cold = grown
    assert "thermal_growth_rate" not in without.dataset
    assert (cold.dataset["thermal_growth_rate"] > 0).all()
    assert cold.dataset["thermal_intensity_range"].shape == (12, 4)
    assert float(cold.dataset["growth_rate"].max()) > float(without.dataset["growth_rate"].max())
    assert "stress intensity range of the day" in cold.summary()
    assert any("daily thermal stress adds one cycle a day" in text for text in cold.warnings)
