"""The rut of a life: its laws by hand, what adds up, the case, the figure, what is refused."""

from dataclasses import replace

import numpy as np
import pytest
from tests.cases import ONE_AXLE

import treadload as tl
from treadload.case import Case
from treadload.damage import Climate, FrenchSubgrade, asphalt_rut
from treadload.damage.criterion import Criterion
from treadload.damage.miner import miner
from treadload.damage.rutting import Rutting
from treadload.errors import InputError
from treadload.grid import Grid
from treadload.life import rutting, sensitivity
from treadload.life.design import Design
from treadload.life.rutting import rut_fields
from treadload.life.wheels import Wheels
from treadload.plots.life import life_years
from treadload.plots.ruts import life_rut
from treadload.response import GridLoad, solve_response
from treadload.units import years_in_words

CASE = ONE_AXLE.replace("temperature = 15", "temperature = 30") + (
    '[rutting]\nlimit = "10 mm"\n[[criteria]]\nname = "soil"\nlaw = "french-subgrade"\n'
)


def test_the_curve_of_soil_runs_between_its_two_ratios():
    """0.15 at the first pass and 20 at the 10⁹th; beta and rho by hand for a water content of 10 %."""
    soil = Rutting(water_content=0.1)
    assert soil.soil_ratio(1.0) == pytest.approx(0.15, rel=1e-12)
    assert soil.soil_ratio(1e9) == pytest.approx(20.0, rel=1e-12)
    beta = 10 ** (-0.61119 - 0.17638)
    rho = 1e9 * (np.log(0.15 / 20) / (1 - 1e9**beta)) ** (1 / beta)
    start = 0.5 * (np.exp(rho**beta) * 0.15 + np.exp((rho / 1e9) ** beta) * 20)
    assert soil.soil_ratio(1e6) == pytest.approx(start * np.exp(-((rho / 1e6) ** beta)), rel=1e-9)


@pytest.fixture(scope="module")
def asked():
    case = Case.from_text(CASE)
    grid = Grid.centred(0.2, 0.2, 0.02)
    wheels = Wheels((GridLoad(grid, np.full(grid.shape, 0.7e6)),), grid.x[None], None, "one", 0.0)
    return case.build_road(), case.build_traffic(), case.build_climate(), wheels


def rut_of(road, traffic, climate, wheels, rutting, tolerance=5e-3):
    soil = Criterion("soil", FrenchSubgrade(), -1)
    return rut_fields(Design(None, road, traffic, climate, [soil], tolerance=tolerance), rutting, wheels)


def test_the_asphalt_ruts_as_one_load_does_and_with_the_power_of_the_years(asked):
    road, traffic, climate, wheels = asked
    data, said = rut_of(road, traffic, climate, [wheels], Rutting())
    years = data["rut_depth"].sel(year=[5.0, 20.0]).to_numpy()
    np.testing.assert_allclose(years[:2, 1] / years[:2, 0], 4**0.4791, rtol=1e-9)
    warm = road.at_temperature(30.0)
    depths = np.linspace(0.001, 0.209, 27)
    response = solve_response(wheels.loads[0], warm, depths=depths, x=wheels.x[0], y=[-0.02, 0.0, 0.02])
    one = asphalt_rut(response, warm, 30.0, 20 * traffic.passes_per_year, thickness=0.21)
    # By the middles of 3 cm here, by trapezoids of 8 mm there.
    assert years[:2, 1].sum() == pytest.approx(float(one.max()), rel=0.05)
    assert any("read in a public program that codes NCHRP 1-37A (2004), not in the guide" in text for text in said)


def test_what_is_divided_adds_up_to_the_whole(asked):
    """The same axle as two classes in two seasons of one temperature; strain hardening keeps no order."""
    road, traffic, _, wheels = asked
    half = replace(traffic.classes[0], share=0.5)
    two = replace(traffic, classes=(half, replace(half, name="other")))
    whole, _ = rut_of(road, traffic, Climate.equal_parts([30.0]), [wheels], Rutting())
    parts, _ = rut_of(road, two, Climate.equal_parts([30.0, 30.0]), [wheels, wheels], Rutting())
    np.testing.assert_allclose(parts["rut_depth"], whole["rut_depth"], rtol=1e-12)
    # A hot summer ruts more than its mean temperature.
    hot, _ = rut_of(road, traffic, Climate.equal_parts([20.0, 40.0]), [wheels], Rutting())
    assert float(hot["rut_depth"][0, -1]) > 1.1 * float(whole["rut_depth"][0, -1])
    cold = rut_of(road, traffic, Climate.equal_parts([-5.0, 30.0]), [wheels], Rutting())[1]
    assert any("below 5 °C counts as if at 5 °C" in text for text in cold)


@pytest.mark.slow
def test_few_roads_of_a_climate_give_the_rut_of_all(asked, monkeypatch):
    road, traffic, _, wheels = asked
    half = replace(traffic.classes[0], share=0.5)
    two = replace(traffic, classes=(half, replace(half, name="other")))
    year = Climate.equal_parts(np.linspace(0.0, 36.0, 13).tolist())
    solved, solve = [], rutting._compression

    def counted(*asked):
        solved.append(1)
        return solve(*asked)

    monkeypatch.setattr(rutting, "_compression", counted)
    all_of_them, _ = rut_of(road, two, year, [wheels, wheels], Rutting(), tolerance=0.0)
    assert len(solved) == 26
    few, _ = rut_of(road, two, year, [wheels, wheels], Rutting())
    assert len(solved) - 26 <= 20
    # Measured: 0.3 %.
    total = all_of_them["rut_depth"].sum("rut_layer")
    np.testing.assert_allclose(few["rut_depth"].sum("rut_layer"), total, rtol=1e-2)


def test_the_limit_is_reached_when_the_curve_meets_it(asked):
    road, traffic, climate, wheels = asked
    free, _ = rut_of(road, traffic, climate, [wheels], Rutting())
    at_seven = float(free["rut_depth"].sel(year=7.0).sum())
    data, _ = rut_of(road, traffic, climate, [wheels], Rutting(limit=at_seven))
    assert data.attrs["rut_years"] == pytest.approx(7.0, rel=1e-5)
    assert rut_of(road, traffic, climate, [wheels], Rutting(limit=0.19))[0].attrs["rut_years"] > 100
    figure = life_rut(data)
    assert len(figure.axes[0].collections) == 3
    # The legend stands below, not on the line of the limit.
    figure.canvas.draw()
    legend = figure.axes[0].get_legend()
    assert len(legend.get_texts()) == 3
    assert legend.get_window_extent().y1 < figure.axes[0].bbox.y0


@pytest.mark.parametrize(("years", "first"), [(12.0, "rut"), (100.0, "soil")])
def test_a_rut_governs_a_life_as_a_criterion_does(asked, years, first):
    """What ends the road first is its answer, in what asks for it and in what cannot ask the rut."""
    road, traffic, climate, wheels = asked
    free, _ = rut_of(road, traffic, climate, [wheels], Rutting())
    total = free["rut_depth"].sum("rut_layer")
    limit = float(total.interp(year=12.0)) if years == 12.0 else 0.19
    data, _ = rut_of(road, traffic, climate, [wheels], Rutting(limit=limit))
    soil = Criterion("soil", FrenchSubgrade(), -1)
    at = soil.law.allowable_strain(traffic.passes(40.0))
    values = np.zeros((1, 1, 1, 3))
    values[..., 1] = at
    life = miner(values, [soil], traffic, climate, y=np.array([-0.1, 0.0, 0.1]))
    life = replace(life, dataset=life.dataset.merge(data, combine_attrs="no_conflicts"))
    assert life.governing == first
    assert life.governing_criterion == "soil"
    assert life.years("rut") == life.rut_years == pytest.approx(float(data.attrs["rut_years"]))
    assert life.years(life.governing) == min(life.rut_years, life.years("soil"))
    said = sensitivity._of_the_rut(life)
    bars = [text.get_text().replace("\n", " ") for text in life_years(life).axes[0].get_yticklabels()]
    assert bars == ["soil", f"rut of {1e3 * limit:g} mm"]
    if first == "soil":
        assert said == []
        return
    assert life.rut_years == pytest.approx(12.0, rel=0.01)
    # Traffic without growth: a per cent more passes, a per cent fewer years.
    assert "the rut, which ends the road first, after 12 years: by its curve its years change by -1 % as" in said[0]
    power = float(np.log(total.sel(year=13.0) / total.sel(year=12.0)) / np.log(13 / 12))
    assert f"by {1 / power:+.2g} % as its limit does" in said[0]
    assert "the life by soil" in said[0]


@pytest.mark.slow
def test_a_case_tells_its_rut_and_a_file_keeps_it(tmp_path):
    result = tl.run(Case.from_text(CASE), leave_out=("sensitivity",))
    said = result.summary()
    assert "Governing criterion: rut" in said
    assert "rut of 10 mm reached after" in said
    opened = tl.open_results(tl.save_results(result, tmp_path / "r.nc"))
    assert opened.life.summary() == result.life.summary()
    page = tl.report(opened, tmp_path / "r.html").read_text()
    assert "rut of 10 mm reached after" in page
    assert f"Service life: {years_in_words(result.life.rut_years)}" in page
    assert "could not be drawn" not in page


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"limit": -1.0}, "limit must be a positive number"),
        ({"limit": 15.0}, "limit is the depth of a rut in m, at most 0.2, got 15; 15 mm is 0.015"),
        (
            {"water_content": 10.0},
            r"water_content must be a share of the dry mass in \(0, 0.4\], got 10; 10 % is",
        ),
        ({"calibration": 0.0}, "calibration must be a positive number"),
    ],
)
def test_what_cannot_be_is_refused(wrong, said):
    with pytest.raises(InputError, match=said) as caught:
        Rutting(**wrong)
    assert len(str(caught.value).splitlines()) == 1
