"""Deflection basins on the page: its list and numbers are those of the result, in the process and in a browser."""

import json
import math

import numpy as np
import pytest

pytest.importorskip("plotly")
pytest.importorskip("nicegui")

import treadload as tl
from page_visits import PATIENCE
from treadload.app.basin_points import about_basins, basin_figures, basin_rows
from treadload.app.engine import Engine
from treadload.errors import InputError
from treadload.plots.interactive import basin_fit, moduli_profile
from treadload.results import save_results
from treadload.roads import Basins
from treadload.variables import modulus_in_words

OFFSETS = np.array([0.0, 0.2, 0.3, 0.45, 0.6, 0.9, 1.2])
STRANGE = "<b>km 3</b> & more"


def road(asphalt, base, soil):
    layers = [tl.Layer(tl.Elastic(asphalt, 0.35), 0.15, name="asphalt"), tl.Layer(tl.Elastic(base, 0.35), 0.3,
              name="base"), tl.Layer(tl.Elastic(soil, 0.4), name="soil")]  # fmt: skip
    return tl.Pavement(layers)


@pytest.fixture(scope="module")
def moduli():
    """Five drops: three clean ones, one that is not monotone, one that is refused."""
    bowls = []
    for factor in (1.0, 0.8, 1.3):
        stiff = road(5e9 * factor, 3e8, 7e7)
        plate = tl.UniformDisc(0.15, 5e4 / (math.pi * 0.15**2))
        response = tl.solve_response(plate, stiff, depths=[0.0], x=OFFSETS, y=[0.0])
        bowls.append(response.dataset["displacement_z"].to_numpy()[0, 0])
    wrong = bowls[0].copy()
    wrong[3] = 1.2 * wrong[2]
    bowls += [wrong, -bowls[0]]
    stations = ("km 1", "km 2", STRANGE, "km 4", "km 5")
    return tl.backcalculate(
        Basins(np.array(bowls), OFFSETS, 5e4, 0.15, station=stations, position=1e3 * np.arange(1.0, 6.0)),
        road(4e9, 2e8, 5e7),
    )


def test_the_list_holds_all_drops(moduli):
    about = about_basins(moduli)
    assert [drop["station"] for drop in about["drops"]] == ["km 1", "km 2", STRANGE, "km 4", "km 5"]
    assert [drop["status"] for drop in about["drops"]] == ["fitted", "fitted", "fitted", "flagged", "refused"]
    assert {drop["load"] for drop in about["drops"]} == {"50"}
    assert about["drops"][4]["misfit"] == "–"
    assert any("3 fitted, 1 flagged, 1 refused" in line for line in about["summary"])


def test_a_drop_shows_what_the_result_holds(moduli):
    data = moduli.dataset
    rows = {row["key"]: row["value"] for row in basin_rows(moduli, 1)}
    low, high = moduli.interval(1, "base")
    assert rows["modulus:base"] == modulus_in_words(float(data["fitted_modulus"][1, 1]))
    assert rows["interval:base"] == f"90 % from {modulus_in_words(low)} to {modulus_in_words(high)}"
    assert rows["thickness:asphalt"] == "150 mm"
    assert rows["status"] == "fitted"
    assert "monotone" in {row["key"]: row["value"] for row in basin_rows(moduli, 3)}["reason"]
    refused = {row["key"]: row["value"] for row in basin_rows(moduli, 4)}
    assert refused["status"] == "refused"
    assert "reason" in refused
    assert not [key for key in refused if key.startswith("modulus:")]
    figures = basin_figures(moduli, 1, "dark")
    line, dots = figures["basin"].data
    np.testing.assert_allclose(dots.y, 1e6 * data["measured_deflection"].to_numpy()[1])
    np.testing.assert_allclose(line.y, 1e6 * data["fitted_deflection"].to_numpy()[1])
    assert figures["basin"].layout.title.text.startswith("<b>km 2</b>, 50 kN: misfit")


def test_a_law_is_shown_with_its_factor():
    granular = tl.materials.StressDependent(tl.materials.KTheta(150e6, 0.5), sublayer=0.1)
    road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.1, name="asphalt"), tl.Layer(granular, 0.3, name="base"),
        tl.Layer(tl.Elastic(6e7, 0.4), name="soil")])  # fmt: skip
    bowls = 1e-6 * np.array([[900, 640, 404, 178], [1400, 1005, 645, 288]])
    drops = Basins(bowls, np.array([0, 0.3, 0.6, 1.2]), np.array([50e3, 80e3]), 0.15, station=("a", "a"))
    result = tl.backcalculate(drops, road)
    rows = {row["key"]: row["value"] for row in basin_rows(result, 1)}
    factor = float(result.dataset["law_factor"][1, 1])
    assert rows["law:base"].startswith(f"{factor:.3g} times its law")
    assert "law:soil" not in rows


def test_moduli_along_the_road_have_their_bars(moduli):
    drawn, data = moduli_profile(moduli, 3), moduli.dataset
    base = [trace for trace in drawn.data if trace.name == "base"]
    x = np.concatenate([trace.x for trace in base])
    assert sorted(x.tolist()) == [1000, 2000, 3000, 4000]
    solid = next(trace for trace in base if trace.marker.symbol == "circle")
    for at, modulus, up, down in zip(solid.x, solid.y, solid.error_y.array, solid.error_y.arrayminus, strict=True):
        drop = int(at / 1000) - 1
        assert modulus == pytest.approx(1e-6 * float(data["fitted_modulus"][drop, 1]))
        assert modulus + up == pytest.approx(1e-6 * float(data["modulus_high"][drop, 1]))
        assert modulus - down == pytest.approx(1e-6 * float(data["modulus_low"][drop, 1]))
    # The flagged drop is hollow, the chosen one marked in every panel.
    hollow = next(trace for trace in base if trace.marker.symbol == "circle-open")
    assert 4000 in hollow.x
    assert [tuple(trace.x) for trace in drawn.data if trace.name == "here"] == [(4000,)] * 3
    assert moduli_profile(moduli).layout.xaxis.title.text == "along the road (m)"


def test_names_of_a_file_are_no_markup(moduli):
    assert "&lt;b&gt;km 3&lt;/b&gt; &amp; more" in basin_fit(moduli, 2).layout.title.text
    texts = {text for trace in moduli_profile(moduli).data for text in (trace.text if trace.text is not None else ())}
    assert "&lt;b&gt;km 3&lt;/b&gt; &amp; more" in texts


def test_what_is_not_there_is_refused(moduli):
    with pytest.raises(InputError, match="there is no drop 9; this backcalculation has 0 to 4"):
        basin_fit(moduli, 9)
    with pytest.raises(InputError, match="no drop -1"):
        moduli_profile(moduli, -1)


def test_a_result_file_is_opened_and_nothing_else_is(moduli, tmp_path):
    said = []
    engine = Engine(lambda line: said.append(json.loads(line)))
    engine.answer({"id": 1, "do": "folder", "folder": str(tmp_path)})
    save_results(moduli, tmp_path / "upload_1.nc")
    engine.answer({"id": 2, "do": "open", "run": "a", "file": "upload_1.nc", "kind": "basins"})
    assert said[-1]["done"]
    engine.answer({"id": 3, "do": "basins", "run": "a"})
    assert said[-1]["drops"] == about_basins(moduli)["drops"]
    engine.answer({"id": 4, "do": "basin", "run": "a", "drop": 2, "theme": "light"})
    assert set(said[-1]["figures"]) == {"basin", "moduli"}
    assert {row["key"]: row["value"] for row in said[-1]["rows"]}["station"] == STRANGE
    response = tl.solve_response(tl.UniformDisc(0.1, 7e5), road(5e9, 3e8, 7e7), depths=[0.02],
                                 x=np.linspace(-0.1, 0.1, 5), y=np.linspace(-0.1, 0.1, 5))  # fmt: skip
    save_results(response, tmp_path / "upload_2.nc")
    engine.answer({"id": 5, "do": "open", "run": "b", "file": "upload_2.nc", "kind": "basins"})
    assert "no backcalculation; `treadload backcalculate` writes one" in said[-1]["error"]


@pytest.mark.slow
def test_a_backcalculation_opens_in_a_browser(visit, moduli, tmp_path):
    save_results(moduli, tmp_path / "moduli.nc")
    tab = visit.tab("basins")
    page = tab.page
    page.wait_for_selector('#bench[data-state="idle"]')
    tab.chosen("open a backcalculation …", tmp_path / "moduli.nc")
    page.wait_for_selector('#bench[data-state="shown"][data-drop="0"]')
    rows = page.locator("#drops tbody tr")
    assert rows.count() == 5
    assert STRANGE in rows.nth(2).inner_text()
    page.wait_for_selector(".figure.basin .main-svg")
    page.wait_for_selector(".figure.moduli .main-svg")
    assert tab.verdict()["station"] == "km 1"
    # Another drop of the list, by its station.
    rows.nth(3).locator(".q-checkbox").click()
    page.wait_for_selector('#bench[data-state="shown"][data-drop="3"]')
    assert tab.verdict()["status"] == "flagged"
    page.wait_for_function("document.querySelector('.figure.basin').textContent.includes('km 4')")
    page.get_by_placeholder("find a station").fill("km 5")
    page.wait_for_function("document.querySelectorAll('#drops tbody tr').length === 1")
    page.locator("#drops tbody tr .q-checkbox").click()
    page.wait_for_selector('#bench[data-state="shown"][data-drop="4"]')
    assert tab.verdict()["status"] == "refused"
    taken = page.locator('[data-take="csv"]').evaluate("link => link.href")
    assert tab.context.request.get(taken, timeout=PATIENCE).status == 200
    # A file of another kind is refused with a sentence, and what stands stays.
    (tmp_path / "x.nc").write_bytes(b"nothing")
    tab.chosen("open a backcalculation …", tmp_path / "x.nc")
    page.locator("#problems .problem").first.wait_for()
    assert tab.verdict()["status"] == "refused"
    assert not [text for text in tab.errors if "ResizeObserver" not in text]
    page.close()
