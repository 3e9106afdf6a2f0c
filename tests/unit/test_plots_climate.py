"""What a life states of its climate over depth, and the two figures of it: they show what was solved."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.text import Text

from treadload.catalogue import mixes
from treadload.damage import Climate, Criterion, FatigueLine, Season, Traffic, miner
from treadload.damage.climate import TypicalDays
from treadload.damage.traffic import AxleClass
from treadload.errors import InputError
from treadload.life.layered_climate import climate_fields
from treadload.life.seasons import warmed
from treadload.materials import GlobalAging
from treadload.pavement import Pavement, RoadTemperatures, TemperatureProfile, Weather
from treadload.plots import day_temperatures, season_moduli
from treadload.reporting.life import life_report
from treadload.results import open_results, save_results

ROAD = Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")
DEPTHS = np.array([0.0, 0.03, 0.06, 0.135, 0.21])


def a_year():
    """A year of hours: the month's number times 2 °C, a daily wave of 5 °C at the surface that ends at 210 mm."""
    start = Weather.of_months([10.0] * 12).start
    hours = np.arange(8760)
    flat = RoadTemperatures(start, 1.0, DEPTHS, np.zeros((8760, 5)), np.zeros(8760), "a wave")
    wave = 5 * np.cos(2 * np.pi * (hours - 14) / 24)[:, None] * (1 - DEPTHS / 0.21)
    return replace(flat, temperatures=2.0 * flat.months[:, None] + wave)


@pytest.fixture(scope="module")
def climate():
    return Climate.of_road(ROAD, a_year(), ageing=GlobalAging(10.0, 12.0))


@pytest.fixture(scope="module")
def fields(climate):
    return climate_fields(ROAD, climate)


def test_the_mean_day_of_each_month_is_kept(climate, fields):
    day = fields["day_temperature"]
    assert day.dims == ("month", "hour", "profile_depth")
    expected = 2.0 * 7 + 5 * np.cos(2 * np.pi * (np.arange(24) - 14) / 24)
    # All days of a month are alike here, so that their mean is each of them to round-off.
    np.testing.assert_allclose(day.sel(month=7, profile_depth=0.0), expected, rtol=1e-12)
    np.testing.assert_allclose(day.sel(month=7, profile_depth=0.21), 14.0, rtol=1e-12)
    warmer = climate.warmer(3.0).days
    np.testing.assert_allclose(warmer.temperatures, day.to_numpy() + 3.0)
    with pytest.raises(InputError, match="typical days need finite temperatures"):
        TypicalDays(np.arange(24.0), DEPTHS, np.full((12, 24, 5), np.nan))


def test_the_moduli_are_those_of_the_road_that_is_solved(climate, fields):
    season = climate.seasons[26]
    assert season.name == "July, 12-18 h"
    solved = [layer.resolved.modulus for layer in warmed(ROAD, (), season).road.layers[:-1]]
    old = fields["sublayer_modulus"].sel(season=season.name).to_numpy()
    np.testing.assert_array_equal(old, solved)
    young = fields["sublayer_modulus_young"].sel(season=season.name).to_numpy()
    assert (old > young).all()
    # The young mix by its own table at the temperature of the part.
    top = float(fields["sublayer_temperature"].sel(season=season.name)[0])
    assert young[0] == pytest.approx(mixes["EB-BBSG3"].modulus(top), rel=1e-12)
    assert fields["sublayer_layer"].to_numpy().tolist() == [0, 0, 0, 1, 1, 1]
    assert fields["sublayer_bottom"][-1] == pytest.approx(0.21)


def test_a_climate_that_divides_nothing_tells_nothing():
    assert not climate_fields(ROAD, Climate.constant(15.0)).variables
    profile = TemperatureProfile((0.0, 0.21), (20.0, 15.0))
    mixed = Climate((Season("deep", 0.5, profile), Season("plain", 0.5, 15.0)))
    assert not climate_fields(ROAD, mixed).variables


def test_the_maps_hold_the_days_and_the_interfaces(fields):
    figure = day_temperatures(fields, months=(1, 7))
    axes = [ax for ax in figure.axes if ax.get_title(loc="left")]
    assert [ax.get_title(loc="left") for ax in axes] == ["January", "July"]
    assert any("surface 9 to 19 °C" in text.get_text() for text in axes[1].findobj(Text))
    borders = [line.get_ydata()[0] for line in axes[0].get_lines()]
    assert borders == pytest.approx([0.0, 60.0])
    with pytest.raises(InputError, match="from 1, January, to 12"):
        day_temperatures(fields, months=(0,))
    with pytest.raises(InputError, match="needs day_temperature"):
        day_temperatures(fields.drop_vars("day_temperature"))


def test_the_lines_are_the_coldest_and_the_warmest_season(fields):
    figure = season_moduli(fields)
    left, right = figure.axes
    cold, warm = (line.get_xdata()[::2] for line in left.get_lines()[:2])
    mean = fields["sublayer_temperature"].to_numpy()
    assert cold[0] == mean[:, 0].min()
    assert warm[0] == mean[:, 0].max()
    names = [text.get_text() for text in right.get_legend().get_texts()]
    assert names == ["January, 0-6 h", "December, 12-18 h", "aged, as the life is solved", "young"]
    drawn = [line.get_xdata()[::2] for line in right.get_lines()[:4]]
    for at, name in ((1, names[0]), (3, names[1])):
        np.testing.assert_allclose(drawn[at], 1e-6 * fields["sublayer_modulus"].sel(season=name))


def test_they_are_drawn_from_a_file_and_in_the_report(climate, fields, tmp_path, monkeypatch):
    y = np.linspace(-0.4, 0.4, 21)
    values = np.full((1, 1, 48), 100e-6)[..., None] * np.exp(-0.5 * (y / 0.1) ** 2)
    row = (AxleClass("axle", 1.0, 50e3, 8e5),)
    criteria = (Criterion("top", FatigueLine(100e-6, -0.2), 0, "top"),)
    warm = np.array([[season.temperatures[0] for season in climate.seasons]])
    life = miner(values, criteria, Traffic(row, 1e5), climate, y=y, layer_temperatures=warm)
    life = replace(life, dataset=life.dataset.merge(fields, combine_attrs="override"))
    opened = open_results(save_results(life, tmp_path / "life.nc"))
    back = opened["life"]
    np.testing.assert_array_equal(back.climate.days.temperatures, climate.days.temperatures)
    assert len(back.plot.temperatures().axes) == 5
    assert len(back.plot.moduli().axes) == 2
    # Which figures its report asks for; they are drawn above.
    drawn = []
    monkeypatch.setattr("treadload.reporting.pictures.picture", lambda title, *_, **__: drawn.append(title) or [])
    life_report("a road", back.dataset)
    assert drawn[-2:] == ["Temperature of the road", "Modulus over depth"]
    drawn.clear()
    life_report("a road", back.dataset.drop_vars(["day_temperature", "sublayer_modulus"]))
    assert not {"Temperature of the road", "Modulus over depth"} & set(drawn)
