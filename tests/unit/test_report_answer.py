"""A report begins with a picture and the answer; fields that are round-off are named instead of drawn."""

import html
import re

import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes
from PIL import Image
from test_open_results import MADE, life

import treadload as tl
from treadload.figure_registry import figures_of
from treadload.plots.kit.round_off import ROUND_OFF, round_off
from treadload.reporting import report
from treadload.us_units import display_units


@pytest.fixture(autouse=True)
def unprinted(monkeypatch):
    """Figures are drawn and not turned into pixels, which takes seconds."""

    def raster(figure, dpi):
        return Image.new("RGB", (1, 1), "white")

    monkeypatch.setattr("treadload.reporting.pictures.raster", raster)


def page_of(results, tmp_path, **how):
    return report(results, tmp_path / "r.html", **how).read_text("utf-8")


def first_picture(page):
    """Title of the first picture, and whether it stands before all tables and with the answer."""
    title = re.search(r"<figcaption><b>(.*?)\.</b>", page)
    start = page.index("<main>")
    assert page.index("<figure", start) < page.index("<table", start)
    assert page.index("<figure", start) < page.index('class="headline"', start) < page.index("<table", start)
    return html.unescape(title[1])


def card(page):
    """The headline and the facts of the first answer."""
    (article,) = re.findall(r'<article class="card.*?</article>', page, re.DOTALL)[:1]
    facts = re.findall(r"<dt>(.*?)</dt><dd>(.*?)</dd>", article)
    headline = re.search(r'<p class="headline">(.*?)</p>', article)[1]
    return html.unescape(headline), {term: html.unescape(text) for term, text in facts}


def test_a_run_begins_with_the_cracks_to_expect(coarse_result, tmp_path):
    page = page_of(coarse_result, tmp_path)
    assert first_picture(page) == "Cracks to expect"
    # Once, not in its section again.
    assert page.count("<b>Cracks to expect.</b>") == 1
    headline, facts = card(page)
    rows = {row.key: row for row in coarse_result.verdict.rows()}
    passes = float(rows["worst_passes"].value)
    assert headline.startswith(
        "Does not govern: more than 10¹⁰" if passes >= 1e10 else "Allowable load repetitions: "
    )
    assert f": {rows['worst_strain'].number} microstrain, " in facts["Why"]
    assert re.fullmatch(r"(surface|\d+ mm deep); x = \S+ mm, y = \S+ mm", facts["Place"])


def test_a_life_begins_with_its_criteria(tmp_path):
    result = life()
    page = page_of(result, tmp_path)
    assert first_picture(page) == "Life by criterion"
    headline, facts = card(page)
    rows = {row.key: row for row in result.rows() if not row.group}
    assert headline == f"Service life: {rows['governing_years'].text}"
    assert facts["Governing criterion"] == str(rows["governing"].value)
    assert "most damage by" in facts["Why"]


def test_lives_that_outlast_all_roads_do_not_govern(tmp_path):
    for factor, words in (
        (1e9, "Does not govern: service life of more than 100 years"),
        (np.inf, "no criterion fails"),
    ):
        result = life()
        data = result.dataset.copy()
        for name in ("life_years", "life_passes"):
            data[name] = data[name] * factor
        page = page_of(type(result)(**{**vars(result), "dataset": data}), tmp_path)
        assert words in card(page)[0]


def test_a_study_begins_with_a_curve_and_its_range(tmp_path):
    page = page_of(MADE["Sweep"](), tmp_path)
    assert first_picture(page).startswith("Against friction")
    headline, extent = re.findall(r'<p class="(?:headline|sentence)">(.*?)</p>', page)
    assert headline == "2 of 2 cases solved"
    assert "(friction 0.4)" in extent
    assert "(friction 0.6)" in extent


def test_two_results_begin_with_both_on_one_scale(coarse_result, tmp_path):
    page = page_of({"first": coarse_result.to_tree(), "second": coarse_result.to_tree()}, tmp_path)
    assert first_picture(page) == "Largest tensile strain, three-dimensional, side by side"
    assert page.count('class="headline"') == 2


def test_the_answer_is_in_us_units(coarse_result, tmp_path):
    with display_units("us"):
        page = page_of(coarse_result, tmp_path)
    assert re.fullmatch(r"(surface|\S+ in deep); x = \S+ in, y = \S+ in", card(page)[1]["Place"])


def test_sections_are_as_wide_as_the_page(coarse_result):
    (section,) = [each for each in figures_of("Response") if each.name == "depth_slice"]
    assert section.wide
    figure = coarse_result.slice_along.plot.depth_slice()
    # 1072 pixels of a page of 1120 with its margins, 98 to the inch.
    assert figure.get_figwidth() * 98 == pytest.approx(1072, rel=0.02)
    figure.draw_without_rendering()
    drawn = max(figure.axes[0].get_position().width, 0)
    assert drawn > 0.7


def test_label_and_arrow_of_travel_stand_apart(coarse_result):
    for figure in (coarse_result.contact.plot.shear(), coarse_result.contact.plot.stick_slip()):
        figure.draw_without_rendering()
        flat = next(ax for ax in figure.axes if ax.get_xlabel().startswith("x") and ax.name != "3d")
        (word,) = [text for text in flat.texts if text.get_text() == "travel"]
        assert flat.xaxis.label.get_window_extent().x1 < word.get_window_extent().x0


def tensor(scale, xz):
    dims, shape = ("y", "x"), (4, 5)
    return xr.Dataset(
        {
            "stress_xx": (dims, np.full(shape, scale), {"units": "Pa"}),
            "stress_xz": (dims, np.full(shape, xz), {"units": "Pa"}),
            "strain_xx": (dims, np.full(shape, scale / 5e9), {"units": "1"}),
            "strain_xy": (dims, np.full(shape, 1e-19), {"units": "1"}),
        },
        {"x": np.arange(5) * 1e-2, "y": np.arange(4) * 1e-2},
    )  # fmt: skip


def test_a_field_below_a_millionth_of_its_kind_is_round_off():
    data = tensor(8e5, 1e-12)
    assert round_off(data, "stress_xx") == ""
    said = round_off(data, "stress_xz")
    assert said == "round-off, at most 1e-15 kPa, below a millionth of the largest stress, 8e+02 kPa"
    assert round_off(data, "strain_xy").startswith("round-off, at most 1e-13 microstrain")
    # The threshold is relative: the same stress in a problem of its own size is drawn.
    assert round_off(tensor(1e-11, 1e-12), "stress_xz") == ""
    assert round_off(tensor(1.0, 1.01 * ROUND_OFF), "stress_xz") == ""
    assert round_off(tensor(1.0, 0.99 * ROUND_OFF), "stress_xz") != ""
    # Nothing is compared with nothing.
    assert round_off(tensor(0.0, 0.0), "stress_xz") == ""


def test_a_report_names_what_it_does_not_draw(tmp_path):
    fields = tl.results.Fields(tensor(8e5, 1e-12))
    page = page_of(fields, tmp_path)
    titles = re.findall(r"<figcaption><b>(.*?)\.</b>", page)
    assert len(titles) == 2
    assert page.count('class="quiet negligible"') == 2
    assert "Not drawn: Stress xz: round-off, at most 1e-15 kPa" in page
    with display_units("us"):
        assert "psi, below a millionth of the largest stress" in page_of(fields, tmp_path)


def test_a_frictionless_contact_has_no_map_of_its_shear(tmp_path):
    x = 5e-3 * (np.arange(16) - 7.5)
    tire = tl.Tire.from_height_map((x[None, :] ** 2 + x[:, None] ** 2) / 0.8, 5e-3, material=tl.Elastic(3e6, 0.5))
    road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    contact = tl.solve_contact(tire, road, tl.Rolling(normal_load=100.0, friction=0.0))
    page = page_of(contact, tmp_path)
    assert "<b>Shear, stick and slip.</b>" not in page
    assert "Not drawn: Shear, stick and slip: " in page
    assert not [ax for ax in contact.plot.pressure().findobj(Axes) if "shear" in ax.get_ylabel()]
