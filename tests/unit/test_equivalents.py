"""Classes in standard axles and a climate as one temperature: closed forms, beside lives of one temperature."""

import math
from dataclasses import replace

import numpy as np
import pytest

from treadload.damage import AxleClass, Climate, Criterion, FatigueLine, FrenchSubgrade, Traffic
from treadload.damage.laws.equivalence import STANDARD_AXLES, StandardAxle
from treadload.damage.miner import miner
from treadload.errors import InputError
from treadload.life import life_equivalents, solve_life
from treadload.life.contacts import Contacts
from treadload.life.design import Design
from treadload.life.equivalents import _dual
from treadload.pavement import Pavement
from treadload.plots import standard_axles
from treadload.reporting import report
from treadload.response import dual_wheels, solve_response
from treadload.response.loads import UniformDisc
from treadload.tire import Tire

TIRE = Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
ROAD = Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")
BASE, SOIL = Criterion("base", FatigueLine(75e-6, -0.2), 1), Criterion("soil", FrenchSubgrade(), -1)
DUAL = ((0.0, -0.1875), (0.0, 0.1875))
CLASSES = (
    AxleClass("twin", 0.5, 32.5e3, 820e3, DUAL),
    AxleClass("single", 0.3, 32.5e3, 820e3),
    AxleClass("whole axle", 0.2, 32.5e3, 820e3, ((0.0, -1.0), (0.0, 1.0))),
)
MONTHS = tuple(np.arange(2.0, 30.0, 3.0).tolist())
CLIMATE = Climate.equal_parts(MONTHS)
COARSE = {"spacing": 12e-3, "contacts": Contacts(TIRE, 12e-3), "tolerance": 0.0}


def design():
    return Design(TIRE, ROAD, Traffic(CLASSES, 1e5), CLIMATE, (BASE, SOIL), **COARSE)


@pytest.fixture(scope="module")
def life():
    return solve_life(design(), workers=1)


@pytest.fixture(scope="module")
def found(life):
    return life_equivalents(design(), life, workers=1)


def test_the_axle_on_cells_reads_as_its_discs():
    """Cells of 6 mm in the place of two discs, at the base."""
    y = np.arange(-300, 301) * 2e-3
    wheels = _dual(StandardAxle(), y, None)
    assert sum(load.normal_load for load in wheels.loads) == pytest.approx(65e3)
    discs = dual_wheels(UniformDisc(0.125, 65e3 / 2 / (math.pi * 0.125**2)), 0.375)
    at = {"depths": [0.21], "x": [0.0], "y": [-0.1875, 0.0], "side": "above"}
    warm = ROAD.at_temperature(15.0)
    cells, exact = (solve_response(loads, warm, **at).dataset for loads in (list(wheels.loads), discs))
    # The radius of 0.662 MPa is 125.0 mm; edges shared out among the cells are of second order.
    np.testing.assert_allclose(cells["strain_xx"], exact["strain_xx"], rtol=2e-3)


def test_a_passage_is_as_many_axles_as_its_strain_to_the_power_of_the_law(life, found):
    axles = found.dataset["standard_axles"]
    # The same load on a tire in the place of a disc, at 210 mm: within a tenth in strain.
    assert 0.6 < float(axles.sel(criterion="base", axle_class="twin")) < 1.6
    hottest = life.dataset["damage_share"].sel(criterion="base").sum("axle_class").argmax("season").item()
    peaks = life.readings.isel(season=hottest, turn=0).sel(criterion="base").max("y")
    ratio = float(peaks.sel(axle_class="single") / peaks.sel(axle_class="twin")) ** 5
    told = axles.sel(criterion="base")
    assert float(told.sel(axle_class="single") / told.sel(axle_class="twin")) == pytest.approx(ratio, rel=1e-5)
    np.testing.assert_allclose(found.dataset["mean_standard_axles"], axles.to_numpy() @ [0.5, 0.3, 0.2])


def test_loads_alone_make_the_axles_of_the_conventions(found):
    data = found.dataset
    np.testing.assert_allclose(data["axle_load"], [130e3, 65e3, 65e3])
    np.testing.assert_allclose(data["french_axles"], [1.0, 0.5**5, 0.5**5])
    np.testing.assert_allclose(data["single_axle_loads"], [(130 / 80) ** 4, (65 / 80) ** 4, (65 / 80) ** 4])


def test_the_standard_axle_is_a_choice(life, found):
    """At the base by the fifth power of the ratio of the strains below the discs of both axles."""
    light = replace(life, traffic=replace(life.traffic, standard_axle=STANDARD_AXLES["irc37"]))
    told = life_equivalents(design(), light, workers=1)
    by_light, by_heavy = (one.dataset["standard_axles"].sel(criterion="base") for one in (told, found))
    hottest = life.dataset["damage_share"].sel(criterion="base").sum("axle_class").argmax("season").item()
    warm = ROAD.at_temperature(MONTHS[hottest])

    def strain(axle):
        discs = dual_wheels(UniformDisc(axle.radius, axle.load / 4 / (math.pi * axle.radius**2)), axle.spacing)
        y = np.linspace(-0.3, 0.3, 121)
        read = solve_response(discs, warm, depths=[0.21], x=[0.0], y=y, side="above").dataset
        return float(max(read["strain_xx"].max(), read["strain_yy"].max()))

    expected = (strain(STANDARD_AXLES["french"]) / strain(STANDARD_AXLES["irc37"])) ** 5
    # Both axles on cells of 6 mm: 2e-3 in strain, five times that here, and the peak is found between cells.
    np.testing.assert_allclose(by_light / by_heavy, expected, rtol=0.02)
    assert told.dataset.attrs["standard_axle_load"] == 80e3
    assert "axles of 80 kN on dual discs of 0.56 MPa, 310 mm" in told.summary()
    figure = standard_axles(told)
    assert "80 kN" in figure.axes[0].get_xlabel()
    assert any("(P / 80 kN)⁴" in text.get_text() for text in figure.axes[0].get_legend().get_texts())


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"load": 0.0}, "load of the standard axle must be a positive"),
        ({"pressure": -1.0}, "pressure of the standard axle must be a positive"),
        ({"spacing": 0.1}, r"overlap at a spacing of 100 mm; give a spacing of at least 250 mm"),
    ],
)
def test_a_standard_axle_that_cannot_be_is_refused(asked, message):
    with pytest.raises(InputError, match=message):
        StandardAxle(**asked)


def test_a_year_of_the_equivalent_temperature_does_the_damage_of_the_climate(life, found):
    """Beside a life that is solved at that temperature; of the other criterion by the same temperature."""
    warmth = float(found.dataset["equivalent_temperature"].sel(criterion=life.governing))
    assert np.mean(MONTHS) < warmth < max(MONTHS)
    solved = solve_life(Design(TIRE, ROAD, life.traffic, Climate.constant(warmth), (BASE, SOIL), **COARSE), workers=1)
    # What stands between temperatures 3 °C apart is interpolated; moduli are straight between 10 and 20 °C.
    np.testing.assert_allclose(found.dataset["years_at_equivalent"], solved.dataset["life_years"], rtol=0.02)
    np.testing.assert_allclose(
        found.dataset["equivalent_reading"].sel(criterion=life.governing),
        solved.dataset["largest_reading"].sel(criterion=life.governing), rtol=0.01,
    )  # fmt: skip
    told = found.dataset.sel(criterion=life.governing)
    assert float(told["years_at_equivalent"]) == pytest.approx(float(told["life_years"]), rel=1e-6)
    assert f"{warmth:.1f}" in {row.number for row in found.rows() if row.key == "equivalent_temperature"}


def test_miners_mean_of_an_exponential_is_its_closed_form(life):
    """D ∝ exp(a T): θ = ln(mean of exp(a T)) / a, through the seasons' own points."""
    rate = 0.1
    degrees = np.linspace(0, 30, 31)
    climate = Climate.equal_parts(degrees.tolist())
    y = life.readings["y"].to_numpy()
    readings = np.full((1, 1, 31, len(y)), 50e-6) * np.exp(rate * degrees / 5)[:, None]
    made = miner(readings, (BASE,), _one(), climate, y=y)
    found = life_equivalents(design(), made, workers=1).dataset
    expected = math.log(np.mean(np.exp(rate * degrees))) / rate
    assert float(found["equivalent_temperature"][0]) == pytest.approx(expected, abs=1e-9)
    assert float(found["equivalent_reading"][0]) == pytest.approx(50e-6 * math.exp(rate * expected / 5), rel=1e-9)


def _one():
    return Traffic((replace(CLASSES[0], share=1.0),), 1e5)


def test_a_climate_of_one_temperature_has_no_other():
    still = solve_life(Design(TIRE, ROAD, _one(), Climate.constant(15.0), (BASE,), **COARSE), workers=1)
    found = life_equivalents(design(), still, workers=1)
    assert np.isnan(found.dataset["equivalent_temperature"]).all()
    assert "equivalent temperature" not in found.summary()


def test_a_report_of_them_alone_is_titled_by_them_and_promises_no_dots_that_are_not_drawn(found, tmp_path):
    text = report(found, tmp_path / "axles.html").read_text()
    assert "<h1>A traffic in standard axles</h1>" in text
    # A criterion by which nothing does damage has no dots.
    none = found.dataset.copy(deep=True)
    none["standard_axles"][list(none["criterion"].to_numpy()).index("soil")] = np.nan
    drawn = [text.get_text() for text in standard_axles(none).axes[0].get_legend().get_texts()]
    assert len(drawn) == 2
    assert "base" in drawn
