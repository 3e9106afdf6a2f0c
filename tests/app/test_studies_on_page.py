"""Studies and networks that are started on the page, beside what Python gives of the same cases."""

import csv
import itertools

import numpy as np
import pytest

import treadload as tl
from page_visits import axe_faults
from treadload.app.form import Form
from treadload.case import Case
from treadload.errors import InputError
from treadload.sweeps import from_texts, sweep
from treadload.sweeps.network import solve_network
from treadload.units import remaining_in_words

pytestmark = pytest.mark.browser

CASE = """
spacing = "16 mm"
[tire]
profile = "315/80R22.5"
[[pavement.layers]]
name = "asphalt"
thickness = "100 mm"
material = { kind = "elastic", modulus = "6000 MPa", poisson = 0.35 }
[[pavement.layers]]
name = "subgrade"
material = { kind = "elastic", modulus = "70 MPa", poisson = 0.4 }
[climate]
temperature = 15
[traffic]
passes_per_year = 10000
[[traffic.classes]]
name = "axle"
share = 1.0
axle_load = "100 kN"
inflation_pressure = "8 bar"
[[criteria]]
name = "asphalt, bottom-up"
law = "fatigue-line"
layer = "lowest asphalt layer"
place = "bottom"
epsilon_6 = "150 microstrain"
slope = -0.2
"""
SECTIONS = [
    ("id", "station [km]", "age [years]", "thickness asphalt [mm]", "passes_per_year"),
    ("A-1", 0.0, 3, 160, 9000),
    ("A-2", 0.7, 12, 90, 20000),
    ("A-3", 1.4, 8, 120, 9000),
    ("A-4", 2.1, 8, -5, 9000),
]


@pytest.fixture(scope="module")
def study(visit):
    """The page of studies, in another tab, while the bench has cells of 16 mm."""
    visit.set("spacing", "16")
    visit.ready(2)
    visit.done()
    tab = visit.tab("study")
    tab.page.wait_for_selector('#bench[data-state="idle"]')
    yield tab
    tab.page.close()


def fill(page, label, text):
    page.locator(f'input[data-of="{label}"], [data-of="{label}"] input').first.fill(text)


def test_a_study_is_started_and_shown(study):
    """Of the case that stands on the bench; its numbers are those of `treadload.sweep`."""
    page = study.page
    fill(page, "from 0", "20")
    fill(page, "to 0", "30")
    fill(page, "values 0", "3")
    page.wait_for_function("document.querySelector('#study-size').innerText.startsWith('3 cases')")
    page.locator("#solve").click()
    page.wait_for_selector('#bench[data-state="shown"]')
    assert page.locator("#study-name").inner_text() == "study of normal load"
    assert page.locator("#sliders [data-dim]").count() == 1
    case = Case.from_dict(dict(Form.first().with_values({"spacing": "16 mm"}).table))
    made = sweep(case, from_texts(case, ["rolling.normal_load=20 kN:30 kN:3"]))
    drawn = page.evaluate("[...document.querySelector('.curve')._fullData[0].y]")
    largest = made.dataset["largest_pressure"].to_numpy() / 1e3
    np.testing.assert_allclose(drawn, largest, rtol=1e-6)
    assert page.locator(".figure.field.js-plotly-plot").count() == 1


def test_a_wrong_range_stands_at_its_field(study):
    page = study.page
    before = page.get_attribute("#bench", "data-moves")
    fill(page, "from 0", "40")
    fill(page, "to 0", "30 mm")
    page.locator("#solve").click()
    told = page.locator(".q-field--error [role=alert]")
    told.first.wait_for()
    assert "'mm' is not a unit of this kind" in told.first.inner_text()
    fill(page, "to 0", "30")
    page.locator("#solve").click()
    page.wait_for_function(
        "[...document.querySelectorAll('.q-field--error [role=alert]')]"
        ".some((label) => label.innerText.includes('larger than'))"
    )
    assert page.get_attribute("#bench", "data-moves") == before
    for dark in (False, True):
        assert axe_faults(study, dark) == []


def table_of(page):
    return page.locator("#ranked tbody tr").evaluate_all(
        "(rows) => rows.map((row) => [...row.cells].map((cell) => cell.innerText.trim()))"
    )


def test_a_table_of_sections_comes_out_ranked(visit, tmp_path):
    """CSV in, ranked CSV out: ranks and years of `solve_network`; a section that fails is last, with its reason."""
    path, case = tmp_path / "roads.csv", tmp_path / "roads.toml"
    with path.open("w", newline="") as file:
        csv.writer(file, delimiter=";").writerows(SECTIONS)
    case.write_text(CASE)
    tab = visit.tab("network")
    page = tab.page
    page.wait_for_selector('#bench[data-state="idle"]')
    page.locator("#solve").click()
    page.locator("#problems .problem").wait_for()
    assert "open a table of sections first" in page.locator("#problems").inner_text()
    tab.chosen("open a TOML …", case)
    page.wait_for_function("document.querySelector('#case').innerText.startsWith('roads.toml')")
    tab.chosen("open a table …", path)
    page.wait_for_function("document.querySelector('#sections').innerText === 'roads.csv'")
    page.locator("#solve").click()
    page.wait_for_selector('#bench[data-state="shown"]')
    network = solve_network(Case.from_toml(case), path)
    rows = table_of(page)
    assert [row[1] for row in rows[:3]] == list(network.ranked)
    assert [row[0] for row in rows] == ["1", "2", "3", "–"]
    for row in rows[:3]:
        assert row[4] == remaining_in_words(network.remaining(row[1]))
    assert rows[3][1] == "A-4"
    assert "thickness" in rows[3][6]
    assert all(a <= b for a, b in itertools.pairwise(network.remaining(row[1]) for row in rows[:3]))
    with page.expect_download() as taken:
        page.locator("#take-ranked").click()
    assert taken.value.suggested_filename == "roads_ranked.csv"
    with open(taken.value.path(), encoding="utf-8-sig", newline="") as file:
        assert [line[:2] for line in csv.reader(file)][1:] == [row[:2] for row in rows]
    home = page.evaluate("document.querySelector('[data-take=nc]').href")
    assert tab.context.request.get(home).status == 200
    # A table that cannot be used leaves the ranked tab, and says why.
    bad = tmp_path / "bad.csv"
    bad.write_text("id;nonsense [mm]\nA;1\n")
    with pytest.raises(InputError) as same:
        tl.sweeps.read_sections(Case.from_toml(case), bad)
    tab.chosen("open a table …", bad)
    page.wait_for_function("document.querySelector('#sections').innerText === 'bad.csv'")
    page.locator("#solve").click()
    told = page.locator("#problems .problem")
    told.wait_for()
    assert told.inner_text().split("nonsense")[-1] == str(same.value).split("nonsense")[-1]
    assert table_of(page) == rows
    for dark in (False, True):
        assert axe_faults(tab, dark) == []
    for width in (1024, 1440, 2560):
        page.set_viewport_size({"width": width, "height": 900})
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth"), width
    assert not tab.errors
    page.close()


def test_a_spreadsheet_of_sections_is_read(visit, tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    for row in SECTIONS[:3]:
        book.active.append(row)
    book.save(tmp_path / "roads.xlsx")
    case = tmp_path / "roads.toml"
    case.write_text(CASE)
    tab = visit.tab("network")
    page = tab.page
    page.wait_for_selector('#bench[data-state="shown"]')
    tab.chosen("open a TOML …", case)
    tab.chosen("open a table …", tmp_path / "roads.xlsx")
    page.wait_for_function("document.querySelector('#sections').innerText === 'roads.xlsx'")
    page.locator("#solve").click()
    page.wait_for_function("document.querySelectorAll('#ranked tbody tr').length === 2")
    assert [row[1] for row in table_of(page)] == ["A-2", "A-1"]
    assert not tab.errors
    page.close()
