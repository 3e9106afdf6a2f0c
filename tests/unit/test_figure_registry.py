"""Figures that are registered: `.plot`, its listing, report and page show ours and those of other packages."""

from __future__ import annotations

import inspect
import re
import subprocess
import sys
from dataclasses import dataclass

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure
from PIL import Image

import treadload as tl
from packages import build
from treadload.app.pictures import picture_of, titles_of
from treadload.composing import BaseResult, result_classes
from treadload.errors import InputError
from treadload.figure_registry import Drawing, Plots, comparison, comparisons, figure, figures_of
from treadload.plots.kit.figure import new_figure
from treadload.registry import COMPARISONS, FIGURES, RESULTS, declared_points
from treadload.rows import Row

PACKAGE = '''
"""Figures of somebody else."""
from dataclasses import dataclass

import xarray as xr
from matplotlib.figure import Figure
from PIL import Image

from treadload.composing import BaseResult
from treadload.figure_registry import figure
from treadload.rows import Row


@figure("Contact", title="Hexagons", caption="Means over hexagons.", when=lambda data: "pressure" in data)
def hexagons(contact, size=0.01):
    """Pressure by hexagons."""
    drawn = Figure()
    drawn.add_subplot().plot([0, size])
    return drawn


@dataclass(frozen=True, eq=False)
class Bristle(BaseResult, group="bristle"):
    """What a brush leaves."""

    dataset: xr.Dataset

    def rows(self):
        return (Row("bristles", "bristles", 2.0),)


@figure("Bristle", main=True, title="Bristles", caption="One by one.")
def bristles(result):
    """Bristles one by one."""
    drawn = Figure()
    drawn.add_subplot().plot(result.heights if isinstance(result, xr.Dataset) else result.dataset.heights)
    return drawn


def bare(contact):
    """Without a decorator."""
'''
POINTS = """
[treadload.figures]
Contact.hexagons = brushes.figures:hexagons
Contact.torn = brushes.nowhere:torn
Contact.bare = brushes.figures:bare

[treadload.results]
Bristle = brushes.figures:Bristle
"""


@pytest.fixture(autouse=True)
def _nothing_stays(monkeypatch):
    """Figures and classes that a test registers are forgotten behind it."""
    for registry in (FIGURES, COMPARISONS, RESULTS):
        registry.built_in()
        monkeypatch.setattr(registry, "_built_in", dict(registry._built_in))


@pytest.fixture
def brushes(tmp_path, monkeypatch):
    folder = tmp_path / "site"
    build(folder, "brushes", POINTS, figures=PACKAGE)
    monkeypatch.syspath_prepend(str(folder))
    yield folder
    for name in [name for name in sys.modules if name.split(".")[0] == "brushes"]:
        del sys.modules[name]


@pytest.fixture(scope="module")
def contact() -> tl.contact.Contact:
    x = 5e-3 * (np.arange(16) - 7.5)
    tire = tl.Tire.from_height_map((x[None, :] ** 2 + x[:, None] ** 2) / 0.8, 5e-3, material=tl.Elastic(3e6, 0.5))
    road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    return tl.solve_contact(tire, road, tl.Rolling(normal_load=100.0, friction=0.7))


@pytest.fixture
def unprinted(monkeypatch):
    """Figures are drawn and not turned into pixels, which takes seconds."""

    def raster(drawn, dpi):
        assert drawn.axes
        return Image.new("RGB", (1, 1), "white")

    monkeypatch.setattr("treadload.reporting.pictures.raster", raster)


def captions(page: str) -> dict[str, str]:
    """Title → caption of the figures of a page."""
    return dict(re.findall(r"<figcaption><b>(.*?)\.</b> (.*?)</figcaption>", page))


def test_every_class_of_results_lists_figures_that_say_what_they_are():
    for name, kind in result_classes().items():
        figures = figures_of(name)
        assert figures, name
        assert len([one for one in figures if one.main]) <= 1
        for one in figures:
            assert inspect.getdoc(one.draw), one.name
            # A report has words for all that it shows.
            assert not one.caption or one.title
        assert {one.name for one in figures} < set(dir(kind.plot.fget(object.__new__(kind)))), name


def test_a_figure_keeps_docstring_and_options_without_the_result(contact):
    drawn = contact.plot.pressure
    assert drawn.__name__ == "pressure"
    assert list(inspect.signature(drawn).parameters) == ["ax"]
    assert "Contact pressure in plan" in inspect.getdoc(drawn)
    listed = repr(contact.plot)
    assert listed.startswith("figures of Contact\n")
    assert "  stick_slip: Shear in plan with the zones that stick and slip, kPa." in listed.splitlines()


def test_a_name_that_is_no_figure(contact):
    with pytest.raises(AttributeError, match="Contact has no figure 'presure'; did you mean 'pressure'"):
        contact.plot.presure()
    assert not hasattr(contact.plot, "_repr_html_")


def test_a_figure_that_is_registered_is_drawn_listed_and_reported(contact, tmp_path, unprinted):
    @figure("Contact", title="Ratio", caption=lambda data: f"Of {data.sizes['x']} columns.")
    def ratio(result, *, power: float = 1.0):
        """Ratio of what touches."""
        drawn = new_figure(3, 2)
        drawn.add_subplot().plot([0, power])
        return drawn

    assert "ratio" in dir(contact.plot)
    assert contact.plot.ratio(power=3.0).axes[0].lines[0].get_ydata()[1] == 3.0
    # Ours are still there, and stand first.
    shown = captions(tl.report(contact, tmp_path / "r.html").read_text())
    assert next(iter(shown)) == "Contact pressure"
    assert list(shown)[-1] == "Ratio"
    assert shown["Ratio"] == f"Of {contact.dataset.sizes['x']} columns."
    key = next(key for key, title in titles_of({"contact": contact}).items() if title == "Ratio")
    picture = picture_of(key, {"contact": contact})
    assert picture["url"].startswith("data:image/svg+xml;base64,")
    with pytest.raises(InputError, match=r"no figure 'contact\.none'"):
        picture_of("contact.none", {"contact": contact})
    with pytest.raises(InputError, match=r"the figure 'Contact.ratio' is .*ratio already.*give it another name"):
        figure("Contact", name="ratio")(lambda result: None)


def test_a_class_defined_here_has_figures_a_thumbnail_and_a_section(tmp_path, unprinted):
    @dataclass(frozen=True, eq=False)
    class Brush(BaseResult, group="brush"):
        dataset: xr.Dataset

        def rows(self):
            return (Row("bristles", "bristles", 2.0),)

    @figure("Brush", main=True, title="Heights", caption="Of all bristles.")
    def heights(result):
        drawn = Figure()
        data = result if isinstance(result, xr.Dataset) else result.dataset
        drawn.add_subplot().plot(data["heights"])
        return drawn

    brush = Brush(xr.Dataset({"heights": ("n", [1.0, 2.0])}))
    assert dir(brush.plot) == ["heights", "main", "thumbnail"]
    assert brush.plot.thumbnail().startswith(b"\x89PNG")
    page = tl.report(brush, tmp_path / "r.html").read_text()
    assert "<h3>Brush</h3>" in page
    assert captions(page) == {"Heights": "Of all bristles."}
    # One that is derived has them as well.
    fine = type("Fine", (Brush,), {})(brush.dataset)
    assert "heights" in dir(fine.plot)


def test_pictures_with_options_and_what_stands_beside(contact):
    @figure("Contact", title="Levels", when=lambda data, beside: (Drawing({"n": n}, f"{n}") for n in beside["n"]))
    def levels(result, n):
        return new_figure(1, 1)

    (one,) = [one for one in figures_of("Contact") if one.name == "levels"]
    drawings = one.drawings(contact.dataset, {"n": [1, 2]})
    assert [(drawing.options["n"], drawing.title) for drawing in drawings] == [(1, "1"), (2, "2")]
    assert one.drawings(contact.dataset, {"n": []}) == []


def test_what_fails_leaves_a_sentence_and_takes_nothing_else_along(contact, tmp_path, unprinted):
    @figure("Contact", title="Split", caption="")
    def split(result):
        return 1 / 0

    @figure("Contact", title="Unsure", caption="", when=lambda data: data["nowhere"])
    def unsure(result):
        return new_figure(1, 1)

    page = tl.report(contact, tmp_path / "r.html").read_text()
    assert "Split.</b> This figure could not be drawn: ZeroDivisionError, division by zero." in page
    assert "Unsure.</b> This figure could not be drawn: the result lacks " in page
    assert "Contact pressure" in captions(page)
    parts = {"contact": contact}
    assert "division by zero" in picture_of("contact.split", parts)["missing"]
    assert contact.plot.thumbnail().startswith(b"\x89PNG")


def test_a_comparison_is_drawn_for_several_cases_in_place_of_each(contact, tmp_path, unprinted):
    drawn = []

    @comparison("Contact", title="Both", caption="On one scale.")
    @figure("Contact", title="One", caption="")
    def overlaid(contacts, labels=("alone",)):
        drawn.append(list(labels))
        made = new_figure(1, 1)
        made.add_subplot()
        return made

    assert "overlaid" in [one.name for one in comparisons()]
    page = tl.report({"a": contact, "b": contact}, tmp_path / "two.html").read_text()
    assert captions(page)["Both"] == "On one scale."
    assert "One" not in captions(page)
    assert drawn == [["a", "b"]]
    assert "One" in captions(tl.report(contact, tmp_path / "one.html").read_text())
    assert drawn[1:] == [["alone"]]


def test_a_figure_of_a_package_appears_and_a_broken_one_is_named(brushes, contact, tmp_path, unprinted):
    # Listed before anything of the package is loaded.
    assert {"hexagons", "torn", "bare", "pressure"} <= set(dir(contact.plot))
    assert "brushes" not in sys.modules
    assert contact.plot.hexagons(size=0.5).axes[0].lines[0].get_ydata()[1] == 0.5
    assert contact.plot.pressure().axes
    with pytest.raises(InputError, match=r"the package brushes 1\.2 brings 'Contact.torn'.*repair that package or"):
        contact.plot.torn()
    with pytest.raises(InputError, match=r"brings the figure 'Contact.bare'.*@figure\(.Contact., name=.bare"):
        contact.plot.bare()
    page = tl.report(contact, tmp_path / "r.html").read_text()
    assert captions(page)["Hexagons"] == "Means over hexagons."
    assert "could not be drawn: the package brushes 1.2 brings &#39;Contact.torn&#39;" in page
    assert titles_of({"contact": contact})["contact.hexagons"] == "Hexagons"


def test_a_class_of_a_package_brings_its_figures(brushes, tmp_path, unprinted):
    bristle = RESULTS.find("Bristle").target(xr.Dataset({"heights": ("n", [1.0, 3.0])}))
    assert bristle.plot.main == "bristles"
    page = tl.report(bristle, tmp_path / "r.html").read_text()
    assert captions(page) == {"Bristles": "One by one."}


def test_two_packages_with_one_figure_are_named(brushes, contact, monkeypatch):
    build(brushes, "combs", "[treadload.figures]\nContact.hexagons = combs.figures:hexagons\n", figures="")
    monkeypatch.setattr("treadload.registry.declared_points", declared_points.__wrapped__)
    with pytest.raises(InputError, match=r"'Contact.hexagons' comes from the package (brushes|combs) .*rename one"):
        dir(contact.plot)


def test_nothing_is_loaded_before_a_figure_is_wanted():
    code = "import sys, treadload as tl; tl.contact.Contact.plot; print('matplotlib' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"
    assert Plots(object()).main == ""
