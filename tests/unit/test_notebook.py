"""What a notebook shows where a figure, a description or a result is the last line of a cell."""

from __future__ import annotations

import ast
import base64
import io
import re
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

import treadload as tl
import treadload.plots
from treadload.describing import Described, as_call, as_html
from treadload.rows import row

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
# A screen of a notebook.
LINES, LETTERS = 40, 220


@pytest.fixture(scope="module")
def contact() -> tl.contact.Contact:
    x = 5e-3 * (np.arange(24) - 11.5)
    tire = tl.Tire.from_height_map((x[None, :] ** 2 + x[:, None] ** 2) / 0.8, 5e-3, material=tl.Elastic(3e6, 0.5))
    return tl.solve_contact(tire, ROAD, tl.Rolling(normal_load=400.0, friction=0.7, tractive_force=100.0))


@pytest.fixture(scope="module")
def response(contact) -> tl.response.Response:
    return tl.solve_response(contact, ROAD, depths=[0.0, 0.01])


def test_a_figure_brings_its_picture_into_a_notebook(contact, response):
    verdict = tl.assess(response, tl.FatigueLine(120e-6, -0.2))
    for figure in (contact.plot.pressure(), response.plot.strain_directions(), verdict.plot.fatigue_line()):
        # IPython asks a thing that pyplot does not draw for this; a plain Figure has none, and shows its name.
        image, size = figure._repr_png_()
        picture = Image.open(io.BytesIO(image))
        assert picture.format == "PNG"
        assert np.asarray(picture).std() > 0
        # Twice as many pixels as the page shows: sharp on every screen.
        assert picture.width == pytest.approx(2 * size["width"], abs=1)
        assert picture.height == pytest.approx(2 * size["height"], abs=1)


def test_a_picture_is_shown_once_and_leaves_no_trace(contact, tmp_path):
    import matplotlib.pyplot as plt

    before = plt.get_fignums()
    figure = contact.plot.pressure()
    first, _ = figure._repr_png_()
    # What pyplot knows, a notebook would draw a second time at the end of the cell.
    assert plt.get_fignums() == before
    assert isinstance(figure, Figure)
    assert figure.dpi == 100
    figure.savefig(tmp_path / "pressure.png")
    assert Image.open(tmp_path / "pressure.png").width == pytest.approx(100 * figure.get_figwidth(), abs=1)
    assert figure._repr_png_()[0] == first


def shown_small(page: str) -> Image.Image:
    (data,) = re.findall(r'<img class="tl-picture" alt="[^"]+" src="data:image/png;base64,([^"]+)">', page)
    return Image.open(io.BytesIO(base64.b64decode(data)))


def test_a_result_and_a_study_bring_a_small_picture(contact, response):
    """Of the figure that stands for them, a few hundred pixels wide, so that a notebook stays small."""
    picture = shown_small(contact._repr_html_())
    assert picture.format == "PNG"
    assert 400 < picture.width <= 800
    assert np.asarray(picture).std() > 0
    assert len(contact._repr_html_()) < 300_000
    # A study shows the picture of its first part.
    opened = tl.results.Results(tl.results.to_tree([contact, response]))
    assert np.array_equal(np.asarray(shown_small(opened._repr_html_())), np.asarray(picture))


def test_a_figure_that_fails_leaves_the_numbers(contact, monkeypatch):
    def broken(*_, **__):
        raise RuntimeError("the pen is dry")

    monkeypatch.setattr("treadload.plots.contact.figure_and_axes", broken)
    page = contact._repr_html_()
    assert "<img" not in page
    assert "peak pressure" in page


def test_every_figure_of_the_house_is_one_that_shows():
    folder = Path(treadload.plots.__file__).parent
    made = [
        f"{path.name}:{node.lineno}"
        for path in folder.glob("*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "Figure"
    ]
    assert made == []


def test_descriptions_and_results_stand_on_one_screen(contact, response):
    verdict = tl.assess(response, tl.FatigueLine(120e-6, -0.2))
    road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")
    tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
    for thing in (road, road.at_temperature(15), tire, contact.rolling, contact, response, verdict):
        lines = repr(thing).splitlines()
        assert len(lines) <= LINES, thing
        assert max(map(len, lines)) <= LETTERS, thing
    # Results in a line, without the table of their dataset.
    assert repr(response).startswith("<Response: one material")
    assert repr(verdict).startswith("<Verdict: ")
    assert "Dataset" not in repr(response) + repr(verdict)


def test_a_description_reads_as_the_call_that_makes_it():
    road = tl.Pavement(
        [tl.Layer(tl.Elastic(6.999999999999999e9, 0.35), 0.06, "wearing course"), tl.Layer(tl.Elastic(5e7, 0.4))]
    )
    said = repr(road)
    assert "Elastic(modulus=7e9, poisson=0.35)" in said
    # What stands at its default is not said.
    assert "bond" not in said
    assert "rigid_base" not in said
    built = eval(said, {name: getattr(tl, name) for name in ("Pavement", "Layer", "Elastic")})
    assert built.layers[0].name == "wearing course"
    assert built.interfaces == pytest.approx([0.06])
    assert built.layers[1] == road.layers[1]
    assert repr(tl.Rolling(normal_load=32.5e3, friction=0.7)) == "Rolling(normal_load=32500.0, friction=0.7)"
    assert "FRICTIONLESS" not in repr(tl.Layer(tl.Elastic(1e9, 0.3), 0.1, bond=tl.pavement.FRICTIONLESS))
    assert "bond=" in repr(tl.Layer(tl.Elastic(1e9, 0.3), 0.1, bond=tl.pavement.FRICTIONLESS))


def test_long_members_are_told_by_their_size():
    mix = repr(tl.catalogue.mixes["EB-GB3"])
    assert "moduli=<3 x 6 numbers>" in mix
    assert "temperatures=(-10.0, 0.0, 10.0, 20.0, 30.0, 40.0)" in mix
    load = tl.response.GridLoad(tl.response.Grid.centred(0.03, 0.02, 1e-3), np.ones((20, 30)))
    assert "20 x 30" in repr(load)
    assert len(repr(load)) < 300
    axles = tuple(tl.damage.AxleClass(f"axle {k}", 0.05, 4e4, 8e5) for k in range(20))
    said = as_call(tl.damage.Traffic(axles, 1e5))
    assert "… 20 in all" in said
    assert "axle 19" not in said


class Cracked(Described):
    """A result of a few rows, with two steps and a verdict."""

    title = "Cracked road"
    heading = "after <5> years"
    warnings = ("the spacing is 9 mm",)

    def rows(self):
        steps = [(("normal_load", 1e3), ("largest_pressure", 2e6)), (("normal_load", 2e3), ("largest_pressure", 3e6))]
        table = [row(key, value, group=f"step {k}") for k, step in enumerate(steps) for key, value in step]
        return (row("net_area", 0.05), *table, row("verdict", "no crack <yet>.", label="Verdict"))


def test_a_result_of_many_rows_is_told_in_one_line():
    assert repr(Cracked()) == "<Cracked: no crack <yet>.>"


def test_a_summary_is_title_rows_and_warnings():
    lines = Cracked().summary().splitlines()
    assert lines[0] == "Cracked road: after <5> years"
    assert lines[-2:] == ["Verdict           no crack <yet>.", "warning: the spacing is 9 mm"]


def test_a_notebook_shows_rows_and_tables_of_groups():
    page = as_html(Cracked.title, [Cracked()], Cracked.warnings)
    assert "Cracked road" in page
    assert "no crack &lt;yet&gt;." in page
    assert "<tr><th>net contact area</th><td>50000 mm²</td></tr>" in page
    # Groups of the same rows are a table with a head.
    assert "<tr><th></th><th>normal load, kN</th><th>peak pressure</th></tr>" in page
    assert "<tr><th>step 1</th><td>2.000</td><td>3000 kPa</td></tr>" in page
    assert "Warning: the spacing is 9 mm" in page


def test_several_results_are_folded_after_the_first():
    page = as_html("Both", [Cracked(), Cracked()])
    assert page.count("<details open>") == 1
    assert page.count("<summary>Cracked road: after &lt;5&gt; years</summary>") == 2


def test_a_case_says_what_was_given():
    case = tl.Case.from_text(
        '[tire]\nprofile = "315/80R22.5"\ninflation_pressure = "8.2 bar"\n'
        '[[pavement.layers]]\nmaterial = { modulus = "5400 MPa", poisson = 0.35 }\n'
        '[rolling]\nnormal_load = "32.5 kN"\nfriction = 0.7\n'
    )
    assert "None" not in repr(case)
    assert "TirePart(profile='315/80R22.5', inflation_pressure=820000.0)" in repr(case)
