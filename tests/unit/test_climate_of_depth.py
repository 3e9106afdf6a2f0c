"""Roads divided over depth, warm and aged as depth has it, from a weather to the life of a case."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from tests.cases import ONE_AXLE

from treadload.case import Case
from treadload.catalogue import mixes
from treadload.damage import Climate, Criterion, FatigueLine, PowerLine, Season, VerticalShear
from treadload.errors import InputError
from treadload.grid import Grid
from treadload.life import solve_life
from treadload.life.climate import nodes, over_the_climate, warmth_of
from treadload.life.design import Design
from treadload.life.seasons import beyond_data, layer_temperatures, warmed
from treadload.materials import Aged, Elastic, GlobalAging
from treadload.pavement import (
    Layer,
    Pavement,
    RoadTemperatures,
    TemperatureProfile,
    Weather,
    divided,
)
from treadload.response import GridLoad, solve_response

ROAD = Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")
PROFILE = TemperatureProfile((0.0, 0.06, 0.21), (38.0, 30.0, 22.0))
MONTHS = [1, 2, 6, 10, 14, 17, 19, 19, 15, 10, 5, 2]


def test_courses_are_divided_into_parts_that_grow_with_depth():
    parts, owner = divided(ROAD)
    assert owner == (0, 0, 0, 1, 1, 1, 2)
    assert np.allclose(parts.interfaces, [0.02, 0.04, 0.06, 0.09, 0.135, 0.21])
    even, owner = divided(ROAD, thickest=0.03)
    assert owner == (0, 0, 1, 1, 1, 1, 1, 2)
    assert np.isclose(even.interfaces[-1], 0.21)
    # What does not depend on temperature stays whole.
    stiff = Pavement([Layer(Elastic(5e9, 0.35), 0.1), *ROAD.layers[1:]])
    assert divided(stiff)[1][:2] == (0, 1)
    with pytest.raises(InputError, match="2 mm thick at least"):
        divided(ROAD, thickest=1e-4)


def test_parts_of_one_temperature_are_the_whole_road():
    # A division alone must move nothing: the same response to round-off.
    load = GridLoad(Grid(4, 4, 0.02, 0.02, -0.04, -0.04), np.full((4, 4), 5e5))
    parts, _ = divided(ROAD)
    whole, split = (
        solve_response(load, road.at_temperature(18.0), depths=[0.0, 0.06, 0.21], x=[0.0], y=[0.0]).dataset
        for road in (ROAD, parts)
    )
    for name in ("strain_xx", "stress_zz"):
        assert np.allclose(whole[name], split[name], rtol=1e-9)


def test_a_season_over_depth_warms_each_part_and_moves_the_criteria():
    season = Season("noon", 1.0, PROFILE)
    base = Criterion("base", FatigueLine(100e-6, -0.2), layer=1)
    surface = Criterion("surface", FatigueLine(100e-6, -0.2), layer=0, place="top")
    platform = Criterion("platform", FatigueLine(100e-6, -0.2), layer=2, place="top")
    warm = warmed(ROAD, (base, surface, platform), season)
    moduli = [layer.elastic.modulus for layer in warm.road.layers]
    assert moduli[0] == mixes["EB-BBSG3"].modulus(PROFILE.temperature_at(0.01))
    assert moduli[5] == mixes["EB-GB3"].modulus(PROFILE.temperature_at(0.1725))
    assert moduli[:3] == sorted(moduli[:3])
    # At the same depths as on the whole road.
    assert [one.depth(warm.road) for one in warm.criteria] == [
        pytest.approx(one.depth(ROAD)) for one in (base, surface, platform)
    ]
    found = layer_temperatures(
        ROAD, (base, surface), (season, replace(season, temperature=TemperatureProfile((0, 1), (60, 60))))
    )
    assert found[:, 0] == pytest.approx([PROFILE.temperature_at(0.1725), PROFILE.temperature_at(0.01)])
    # Laws go no further than the table of the mix; the road does, and says so.
    assert (found[:, 1] == 40).all()
    hot = Season("hot", 0.3, TemperatureProfile((0.0, 0.2), (55.0, 25.0)))
    names = {name for name, _, _ in beyond_data(ROAD, hot)}
    assert names == {"EB-BBSG3", "EB-GB3"}
    top = warmed(ROAD, (), hot).road.layers[0].elastic.modulus
    assert top == mixes["EB-BBSG3"].modulus(hot.profile.temperature_at(0.01), extrapolate=True) < 1000e6


def test_a_warmer_season_shifts_the_whole_profile():
    season = Season("noon", 1.0, PROFILE).warmer(2.0)
    assert season.temperatures == (40.0, 32.0, 24.0)
    assert Season("s", 1.0, (10.0, 12.0)).warmer(1.0).temperature == (11.0, 13.0)


class TestAgeing:
    old = GlobalAging(10.0, 12.0)

    def test_viscosity_by_hand(self):
        # 25 °C is 536.67 °R: log log η₀ = 10.6508 - 3.5537 log 536.67 = 0.9502; C = 10^-1.7361, from the formulas.
        log_t = math.log10(536.67)
        young = 10.6508 - 3.5537 * log_t
        assert self.old.viscosity(25.0) == pytest.approx(young, abs=1e-9)
        log_c = 274.4946 - 193.831 * log_t + 33.9366 * log_t**2
        a = (
            -0.004166
            + 10**log_c * (1.41213 + math.log10(53.6))
            + young * (-14.5521 + 10.47662 * log_t - 1.88161 * log_t**2)
        )
        b = 0.197725 + 0.068384 * log_c
        aged = (young + 120 * a) / (1 + 120 * b)
        assert self.old.aged_viscosity(25.0, 0.0) == pytest.approx(aged, rel=1e-9)
        # Ten years make this binder at 25 °C some five times as viscous at the surface.
        assert 4 < 10 ** (10**aged - 10**young) < 6

    def test_it_fades_with_depth_and_never_thins(self):
        depths = [0.0, 0.006, 0.02, 0.05, 0.1, 0.3, 5.0]
        by_depth = [self.old.aged_viscosity(20.0, z) for z in depths]
        assert by_depth[0] == by_depth[1]
        assert by_depth[1:] == sorted(by_depth[1:], reverse=True)
        assert by_depth[-1] == pytest.approx(self.old.viscosity(20.0), rel=0.01)
        for warm in np.linspace(-25, 70, 20):
            assert self.old.aged_viscosity(warm, 0.0) >= self.old.viscosity(warm)
            assert self.old.as_cold_as(warm, 0.0) <= warm
        older = GlobalAging(20.0, 12.0)
        assert older.aged_viscosity(20.0, 0.0) > self.old.aged_viscosity(20.0, 0.0)
        assert GlobalAging(10.0, 22.0).aged_viscosity(20.0, 0.0) > self.old.aged_viscosity(20.0, 0.0)

    def test_a_new_road_is_young_and_an_old_one_stiff_at_the_surface(self):
        mix = mixes["EB-BBSG3"]
        assert Aged(mix, GlobalAging(0.0, 12.0), 0.01).at(20.0) == mix.at(20.0)
        aged = [Aged(mix, self.old, z).at(30.0).modulus for z in (0.01, 0.05, 0.2)]
        assert aged == sorted(aged, reverse=True)
        # As stiff as where the young binder has the old one's viscosity, which is what the temperature means.
        cold = self.old.as_cold_as(30.0, 0.01)
        assert self.old.viscosity(cold) == pytest.approx(self.old.aged_viscosity(30.0, 0.01))
        assert aged[0] == mix.modulus(cold)
        with pytest.raises(InputError, match="60 °C lies outside its data"):
            Aged(mix, self.old, 0.01).at(60.0)

    @pytest.mark.parametrize(
        ("given", "said"),
        [
            ({"age": -1}, "age of a road must lie in"),
            ({"mean_air": 300}, "-20 to 40 °C|kelvin"),
            ({"binder": "PG 64-99"}, "no binder 'PG 64-99'; known are"),
            ({"intercept": 10.6}, "both intercept and slope"),
            ({"intercept": 10.6, "slope": 3.5}, "slope must be negative"),
            ({"intercept": 10.6, "slope": -3.5, "binder": "AC-20"}, "not both"),
        ],
    )
    def test_bad_input_is_one_sentence(self, given, said):
        with pytest.raises(InputError, match=said):
            GlobalAging(**{"age": 10.0, "mean_air": 12.0, **given})

    def test_a_season_ages_the_parts(self):
        season = Season("all year", 1.0, 20.0, ageing=self.old)
        warm = warmed(ROAD, (), season).road
        moduli = [layer.elastic.modulus for layer in warm.layers]
        assert moduli[:3] == sorted(moduli[:3], reverse=True)
        assert moduli[0] > 1.5 * mixes["EB-BBSG3"].modulus(20.0)
        with pytest.raises(InputError, match="temperature for each layer and ageing"):
            Season("all year", 1.0, (20.0, 20.0, 20.0), ageing=self.old)


def _year(amplitude=0.0):
    """A year of hours with a daily wave of that amplitude around 20 °C."""
    hours = np.arange(8760)
    warm = 20 + amplitude * np.cos(2 * np.pi * (hours - 14) / 24)
    start = Weather.of_months(MONTHS).start
    depths = np.array([0.0, 0.21, 1.0])
    return RoadTemperatures(start, 1.0, depths, np.repeat(warm[:, None], 3, axis=1), warm, "a wave")


def test_a_year_becomes_months_by_parts_of_the_day():
    climate = Climate.of_road(ROAD, _year(5.0))
    assert len(climate.seasons) == 48
    assert math.fsum(one.share for one in climate.seasons) == pytest.approx(1)
    january = climate.seasons[2]
    assert january.name == "January, 12-18 h"
    assert january.share == pytest.approx(31 / 365 / 4)
    hours = np.arange(12, 18)
    # In a mix the temperature that does their harm, E^-4; in the soil their mean.
    warm = 20 + 5 * np.cos(2 * np.pi * (hours - 14) / 24)
    mix = mixes["EB-BBSG3"]
    harm = np.mean([mix.modulus(one) ** -4 for one in warm])
    assert mix.modulus(january.temperatures[0]) ** -4 == pytest.approx(harm, rel=1e-3)
    assert january.temperatures[2] == pytest.approx(np.mean(warm))
    # Trucks by night alone: no afternoon remains.
    night = Climate.of_road(ROAD, _year(5.0), hours=[1 / 6] * 6 + [0.0] * 18)
    assert len(night.seasons) == 12
    assert "48 seasons by month and 4 part(s)" in climate.about[0]


def _binning_error(swing, parts):
    """The error of a reading that the seasons state, as a number."""
    about = Climate.of_road(ROAD, _year(swing), parts=parts).about[0]
    return float(re.search(r"readings off by (\S+) % would", about)[1]) / 100


def test_what_the_parts_of_a_day_miss_falls_with_their_number():
    assert _binning_error(0.0, parts=4) == pytest.approx(0, abs=1e-12)
    errors = [_binning_error(8.0, parts=parts) for parts in (1, 2, 4, 8, 24)]
    assert errors == sorted(errors, reverse=True)
    assert errors[-1] == pytest.approx(0, abs=1e-12)
    # From six hours to three the spread within a part halves at least, and counts squared at best.
    assert 2 < errors[2] / errors[3] < 5


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"parts": 5}, "must divide 24"),
        ({"hours": [1 / 24] * 23}, "24 shares"),
        ({"hours": [0.05] * 24}, "must sum to 1, got 1.2; give fractions, not per cent"),
    ],
)
def test_bad_parts_are_refused(given, said):
    with pytest.raises(InputError, match=said):
        Climate.of_road(ROAD, _year(), **given)


def test_less_than_a_year_is_refused():
    short = _year()
    short = replace(short, temperatures=short.temperatures[:4000], air=short.air[:4000])
    with pytest.raises(InputError, match="a year of temperatures, 8760 hours, got 4000 from 2001-01-01 on"):
        Climate.of_road(ROAD, short)


def test_readings_over_profiles_are_interpolated_within_the_tolerance():
    rng = np.random.default_rng(4)
    seasons = [
        Season(str(k), 1 / 40, TemperatureProfile((0.0, 0.21), (mean + slope, mean - slope)))
        for k, (mean, slope) in enumerate(zip(rng.uniform(0, 32, 40), rng.uniform(-4, 7, 40), strict=True))
    ]
    roads = [warmed(ROAD, (), one).road for one in seasons]
    features = warmth_of(seasons, roads)
    assert features.ndim == 2
    moduli = np.log([[layer.elastic.modulus for layer in road.layers] for road in roads])
    y = np.linspace(-1, 1, 21)
    # A reading as a strain depends on stiffness: a power of the moduli, more of the lower course.
    peak = np.exp(-0.3 * moduli[:, 0] - 0.5 * moduli[:, 4] + 8)[:, None, None] * np.exp(-8 * y**2)
    kept, error = nodes(features, peak, 5e-3)
    assert len(kept) <= 20
    assert error <= 5e-3
    other = 0.7 * peak**1.1
    whole = over_the_climate(features, kept, other[None][:, kept], 1)[0]
    assert np.abs(whole / other - 1)[:, :, 10].max() < 0.03


def test_a_search_goes_through_all_parts_of_its_course():
    """As on the whole course, and no further; the first part ends at 20 mm."""
    law = PowerLine(VerticalShear(), 100e-6, -0.2)
    asked = [Criterion(str(k), law, k, "top", search_to=0.1) for k in (0, 1, 2)]
    warm = warmed(ROAD, asked, Season("noon", 1.0, PROFILE))
    for new, old in zip(warm.criteria, asked, strict=True):
        assert new.depths(warm.road) == pytest.approx(old.depths(ROAD))
    assert warm.criteria[0].depths(warm.road)[-1] == pytest.approx(0.05)
    with pytest.raises(InputError, match="parts of the criterion '0' must be 1 or more, got 0"):
        replace(asked[0], parts=0)


def test_a_life_below_a_profile_finds_the_shear_below_the_first_part():
    case = Case.from_text(ONE_AXLE + BASE)
    law = PowerLine(VerticalShear(), 100e-6, -0.2)
    tops = [Criterion(name, law, 0, "top", search_to=to) for name, to in (("near", 0.02), ("deep", 0.05))]
    # Of one temperature, divided or not: the same road, so the same depth and the same reading.
    climates = [
        Climate((Season("all year", 1.0, one),)) for one in (TemperatureProfile((0.0, 0.3), (15.0, 15.0)), 15.0)
    ]
    divided_, whole = (
        solve_life(Design(case.build_tire(), ROAD, case.build_traffic(), one, tops, spacing=0.02)).dataset
        for one in climates
    )
    assert float(divided_.read_depth[1]) > 0.02
    assert float(divided_.read_depth[1]) == float(whole.read_depth[1])
    assert float(divided_.largest_reading[1]) > 1.05 * float(divided_.largest_reading[0])
    # Cubes end where a part does.
    assert float(divided_.largest_reading[1]) == pytest.approx(float(whole.largest_reading[1]), rel=0.05)


WEATHER = ONE_AXLE.replace("climate = { temperature = 15 }", f"climate = {{ air = {{ months = {MONTHS} }} }}")
BASE = """
[[criteria]]
name = "base"
law = "french-bituminous"
layer = "EB-GB3"
risk = 0.05
"""


def test_a_case_of_weather_and_age_is_built():
    case = Case.from_text(WEATHER + BASE)
    climate = case.build_climate()
    assert len(climate.seasons) == 48
    assert climate.seasons[0].profile.depths[0] == 0
    assert any("no wind" in text for text in climate.warnings)
    aged = Case.from_text("ageing = { age = 10 }\n" + WEATHER + BASE).build_climate()
    assert aged.seasons[0].ageing.mean_air == pytest.approx(np.mean(MONTHS), abs=0.5)
    assert any("aged" in text for text in aged.about)
    constant = Case.from_text("ageing = { age = 10, mean_air = 12 }\n" + ONE_AXLE + BASE).build_climate()
    assert constant.seasons[0].profile is not None


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (WEATHER.replace("{ air", "{ temperature = 15, air"), "exactly one of"),
        (ONE_AXLE.replace("= 15 }", "= 15, parts_of_day = 4 }"), "parts_of_day belongs to a climate of weather"),
        (ONE_AXLE.replace("temperature = 15", 'file = "none.csv"'), "cannot read .*none.csv"),
        ("ageing = { age = 10 }\n" + ONE_AXLE, "ageing needs mean_air"),
        ("ageing = { age = 10, mean_air = 12 }\n" + ONE_AXLE.replace("6 BBSG3 / 15 GB3 / PF3", "20 GC-T3 / PF3"),
         "needs a mix with moduli over temperature"),
    ],
)  # fmt: skip
def test_bad_climates_of_a_case_are_refused(text, said):
    criterion = BASE if "GB3" in text else '\n[[criteria]]\nname = "soil"\nlaw = "french-subgrade"\n'
    with pytest.raises(InputError, match=said):
        Case.from_text(text + criterion)
