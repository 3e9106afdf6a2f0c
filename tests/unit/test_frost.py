"""Frost and thaw: the freezing front, indices, depths, and moduli of the seasons."""

import math
from datetime import datetime

import numpy as np
import pytest

import treadload as tl
from treadload.damage import Climate, Season
from treadload.damage.climate import MONTHS, month_of
from treadload.errors import InputError
from treadload.kernels.freezing import FreezingCells, freezing, neumann_front
from treadload.life.layered_climate import climate_fields
from treadload.life.seasons import warmed
from treadload.materials import Elastic, KTheta, StressDependent
from treadload.pavement import (
    Frost,
    Layer,
    Moisture,
    Pavement,
    RoadTemperatures,
    Weather,
    frost_index,
    frost_year,
    road_temperatures,
)
from treadload.plots import frost_months
from treadload.reporting.life import life_report

DAY = 86_400.0


def soil_cells(soil, cell=0.01, depth=6.0):
    ones = np.ones(round(depth / cell))
    (thawed, frozen), (warm, cold) = soil.conductivities, soil.capacities
    return FreezingCells(cell * ones, thawed * ones, frozen * ones, warm * ones, cold * ones, soil.latent * ones)


def road(name="base"):
    return Pavement(
        [
            Layer(Elastic(5e9, 0.35), 0.10, name="asphalt"),
            Layer(Elastic(200e6, 0.35), 0.30, name=name),
            Layer(Elastic(60e6, 0.40), name="soil"),
        ]
    )


def winter(coldest=-10.0, warmest=20.0):
    """Surface temperatures of a year, by hours: a cosine, coldest in mid January."""
    hours = np.arange(365 * 24)
    mean, swing = 0.5 * (warmest + coldest), 0.5 * (warmest - coldest)
    surface = mean - swing * np.cos(2 * math.pi * (hours / 24 - 15) / 365)
    return RoadTemperatures(datetime(2001, 1, 1), 1.0, np.array([0.0]), surface[:, None], surface, "made up")


@pytest.mark.parametrize("ground", [0.0, 3.0])
@pytest.mark.parametrize("soil", [Moisture(), Moisture(0.2, 1700, "fine")])
def test_the_front_follows_neumann(soil, ground):
    cells = soil_cells(soil)
    step, count = 6 * 3600.0, 4 * 60
    _, shares = freezing(cells, np.full(len(cells.thickness), ground), np.full(count + 1, -5.0), step)
    frozen, thawed = (tuple(part[k] for part in (soil.conductivities, soil.capacities)) for k in (1, 0))
    front = neumann_front(frozen, thawed, soil.latent, -5.0, ground)
    for days in (30, 60):
        depth = float(shares[days * 4] @ cells.thickness)
        assert depth == pytest.approx(front * math.sqrt(days * DAY), rel=0.01)


def test_without_water_it_is_the_half_space():
    cells = soil_cells(Moisture(), cell=0.02)
    dry = FreezingCells(
        cells.thickness, *[np.full(len(cells.thickness), value) for value in (2.0, 2.0, 2e6, 2e6, 0.0)]
    )
    temperatures, _ = freezing(dry, np.full(len(dry.thickness), 5.0), np.full(41, -5.0), 6 * 3600.0)
    depth = np.cumsum(dry.thickness) - 0.5 * dry.thickness
    exact = -5.0 + 10.0 * np.array([math.erf(z / (2 * math.sqrt(1e-6 * 10 * DAY))) for z in depth])
    assert temperatures[-1] == pytest.approx(exact, abs=0.15)


def test_heat_that_enters_is_heat_that_is_kept():
    cells = soil_cells(Moisture(), cell=0.02, depth=2.0)
    surface = np.concatenate([np.full(120, -8.0), np.full(240, 6.0)])
    temperatures, shares = freezing(cells, np.full(len(cells.thickness), 2.0), surface, DAY / 4)
    enthalpy = [float(cells.enthalpy(row) @ cells.thickness) for row in temperatures]
    entered = 0.0
    for row in range(1, len(surface)):
        _, top = cells.conductances(shares[row])
        entered += top * (surface[row] - temperatures[row, 0]) * DAY / 4
    assert enthalpy[-1] - enthalpy[0] == pytest.approx(entered, rel=2e-2, abs=1e4)
    assert shares[120].max() == 1
    assert shares[-1].max() == 0


def test_the_frost_index_of_a_winter():
    days = np.full(365, 5.0)
    days[:31], days[350:] = -4.0, -2.0
    # December's frost joins January's.
    assert frost_index(days) == pytest.approx(31 * 4 + 15 * 2)
    assert frost_index(np.full(365, 3.0)) == 0.0


@pytest.mark.slow
def test_frost_goes_deeper_where_it_is_colder_and_drier():
    usual = frost_year(road(), winter(), Frost())
    cold = frost_year(road(), winter(-20.0), Frost())
    wet = frost_year(road(), winter(), Frost(soil=Moisture(0.30, 1450, "fine")))
    mild = frost_year(road(), winter(2.0), Frost())
    depths = [year.frost_depth.max() for year in (mild, wet, usual, cold)]
    assert depths == sorted(depths)
    assert depths[0] == 0
    assert str(mild) == "no frost in the unbound layers"
    assert mild.factor(2) == {}
    assert cold.surface_index > usual.surface_index > 0
    assert "frost reaches" in str(usual)
    # It thaws from above: the upper end of the frozen zone goes down in spring.
    spring = usual.thaw_depth[(usual.months == 3)]
    assert np.nanmax(spring) > np.nanmin(usual.thaw_depth[usual.months == 1])


def test_moduli_by_month():
    year = frost_year(road(), winter(), Frost(frozen=8.0, thawed=0.5, recovery=60))
    base = {month: year.factor(month).get("base", 1.0) for month in range(1, 13)}
    assert base[1] == pytest.approx(8.0, rel=0.01)
    assert min(base.values()) >= 0.5
    assert base[4] < 0.9
    assert base[4] < base[5] < base[6]
    assert base[8] == 1.0
    assert "asphalt" not in year.factor(1)


def test_a_climate_with_frost():
    year = frost_year(road(), winter(), Frost())
    climate = Climate.equal_parts(np.linspace(0, 22, 12), MONTHS).with_frost(year, range(1, 13))
    assert "frost reaches" in climate.about[-1]
    layers = warmed(road(), (), climate.seasons[0]).road.layers
    assert layers[1].resolved.modulus == pytest.approx(200e6 * year.factor(1)["base"])
    assert layers[0].resolved.modulus == 5e9
    with pytest.raises(InputError, match="12 seasons, got 2 months"):
        climate.with_frost(year, [1, 2])


def test_factors_of_a_season():
    season = Season("thaw", 1.0, 5.0, factors={"soil": 0.5})
    assert season.factors == (("soil", 0.5),)
    assert warmed(road(), (), season).road.layers[2].resolved.modulus == 30e6
    by_stress = Pavement([*road().layers[:2], Layer(StressDependent(KTheta(40e6, 0.5)), name="soil")])
    half = warmed(by_stress, (), season).road.layers[2].resolved.modulus
    full = warmed(by_stress, (), Season("summer", 1.0, 5.0)).road.layers[2].resolved.modulus
    assert half == pytest.approx(0.5 * full)
    with pytest.raises(InputError, match="factor of the layer 'soli'; did you mean 'soil'"):
        warmed(road(), (), Season("thaw", 1.0, 5.0, factors={"soli": 0.5}))
    with pytest.raises(InputError, match="factor of soil must be a positive number, got -1"):
        Season("thaw", 1.0, 5.0, factors={"soil": -1})


CASE = """
tire = { profile = "315/80R22.5" }
pavement = { structure = "6 BBSG3 / 10 GB3 / 30 GNT1 / PF2" }

[climate]
air = { months = [-9, -7, -1, 6, 12, 16, 19, 17, 12, 6, -1, -7] }
parts_of_day = 1
frost = { soil = { water = 0.2, dry_density = 1650, kind = "fine" }, thawed = 0.5 }

[traffic]
passes_per_year = 1e5
classes = [{ name = "front", share = 1, axle_load = "70 kN", inflation_pressure = "8 bar" }]

[[criteria]]
name = "soil"
law = "french-subgrade"
"""


@pytest.mark.slow
def test_frost_in_a_case():
    case = tl.Case.from_text(CASE)
    climate = case.build_climate()
    assert any(text.startswith("frost reaches") for text in climate.about)
    by_month = {month_of(season.name): dict(season.factors) for season in climate.seasons}
    assert by_month[1]["GNT1"] == pytest.approx(10.0, rel=0.01)
    assert 0.5 <= by_month[5]["GNT1"] < 1
    assert by_month[9].get("GNT1", 1.0) == pytest.approx(1.0, abs=1e-3)
    stiff = warmed(case.road(), (), climate.seasons[0]).road
    assert max(layer.resolved.modulus for layer in stiff.layers if layer.name == "GNT1") == pytest.approx(
        6e9, rel=0.01
    )
    with pytest.raises(InputError, match="frost belongs to a climate of weather"):
        tl.Case.from_text(
            CASE.replace("air = { months =", "months = ").replace("-7] }", "-7]").replace("parts_of_day = 1\n", "")
        )


def test_a_weather_of_months_freezes_the_base():
    weather = Weather.of_months([-8, -6, -1, 6, 12, 16, 19, 17, 12, 6, -1, -6])
    year = frost_year(road(), road_temperatures(road(), weather, [0.0]), Frost())
    assert 0.5 < year.frost_depth.max() < 2.5
    assert year.air_index == pytest.approx(-sum(np.array([-8, -6, -1, -1, -6]) * [31, 28, 31, 30, 31]), rel=0.1)


@pytest.mark.parametrize(("make", "message"), [
    (lambda: Moisture(15), r"water must lie in \[0.005, 1\) of the dry mass, got 15"),
    (lambda: Moisture(0.1, 1.9), r"dry_density must lie in \[800, 2600\] kg/m³, got 1.9"),
    (lambda: Moisture(0.1, 1900, "sand"), "kind must be"),
    (lambda: Frost(thawed=0), r"thawed must lie in \(0, 1\], got 0"),
    (lambda: Frost(frozen=0.5), r"frozen must lie in \[1, 1000\], got 0.5"),
    (lambda: frost_year(road(), winter(), Frost(layers={"bass": Moisture()})), "frost names the layer 'bass'; did"),
])  # fmt: skip
def test_wrong_frost_is_refused(make, message):
    with pytest.raises(InputError, match=message):
        make()


@pytest.mark.slow
def test_a_life_with_frost_runs_to_its_years():
    """Frozen months do next to no damage to the soil; those of the thaw do more than without frost."""
    text = f'spacing = "20 mm"\n{CASE}'
    plain = "\n".join(line for line in text.splitlines() if not line.startswith("frost"))
    lives = [tl.run(tl.Case.from_text(case)).life for case in (text, plain)]
    frozen, without = (float(life.dataset["life_years"][0]) for life in lives)
    assert 0.5 * without < frozen < without
    damage = [life.dataset["damage_share"].sum(["criterion", "axle_class"]) for life in lives]
    # Per year, as shares of the damage are of the years.
    yearly = [part / years for part, years in zip(damage, (frozen, without), strict=True)]
    months = [month_of(str(name)) for name in lives[0].dataset["season"].to_numpy()]
    titles = [{picture.title for picture in life_report("a road", life.dataset).pictures} for life in lives]
    assert ["Frost depth and moduli by month" in drawn for drawn in titles] == [True, False]
    thaw, winter = months.index(6), months.index(2)
    assert float(yearly[0][thaw]) > 1.3 * float(yearly[1][thaw])
    assert float(yearly[0][winter]) < 0.3 * float(yearly[1][winter])


@pytest.fixture(scope="module")
def frozen_fields():
    weather = Weather.of_months([-8, -6, -1, 6, 12, 16, 19, 17, 12, 6, -1, -6])
    temperatures = road_temperatures(road(), weather, [0.0, 0.1, 0.4])
    year = frost_year(road(), temperatures, Frost())
    climate = Climate.of_road(road(), temperatures, parts=1)
    months = [month_of(season.name) for season in climate.seasons]
    return climate_fields(road(), climate.with_frost(year, months)), year


def test_frost_and_moduli_by_month_are_kept_and_drawn(frozen_fields):
    fields, year = frozen_fields
    np.testing.assert_array_equal(fields["frost_depth"], year.frost_depth)
    np.testing.assert_array_equal(fields["day_month"], year.months)
    names = [str(name) for name in fields["factored_layer"].values]
    assert names == ["base", "soil"]
    for column, name in enumerate(names):
        recovered = next(layer for layer in road().layers if layer.name == name).resolved.modulus
        wanted = [recovered * year.factor(month).get(name, 1.0) for month in range(1, 13)]
        np.testing.assert_allclose(fields["season_modulus"].values[:, column], wanted, rtol=1e-12)
    figure = frost_months(fields)
    upper, lower = figure.axes
    assert [label.get_text() for label in lower.get_xticklabels()][:2] == ["Jan", "Feb"]
    drawn = lower.patches[0].get_data().values
    np.testing.assert_allclose(drawn, 1e-6 * fields["season_modulus"].values[:, 0])
    # The line of the frozen depth reaches the deepest day.
    assert np.nanmax(upper.lines[0].get_ydata()) == pytest.approx(year.frost_depth.max())


def test_stated_factors_are_drawn_without_frost():
    seasons = (Season("thaw", 0.2, 5.0, factors={"soil": 0.5}), Season("rest", 0.8, 15.0))
    fields = climate_fields(road(), Climate(seasons))
    np.testing.assert_allclose(fields["season_modulus"].values[:, 0], [30e6, 60e6])
    assert "frost_depth" not in fields
    (ax,) = frost_months(fields).axes
    assert [label.get_text() for label in ax.get_xticklabels()] == ["thaw", "rest"]
    with pytest.raises(InputError, match="needs season_modulus"):
        frost_months(climate_fields(road(), Climate.constant(15.0)))
