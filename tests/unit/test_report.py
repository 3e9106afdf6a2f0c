"""Reports of real small cases: one whole file that holds the numbers and nothing foreign."""

from __future__ import annotations

import json
import re
from html.parser import HTMLParser

import numpy as np
import pytest
import xarray as xr

from treadload.case import Case
from treadload.errors import InputError
from treadload.reporting import report, write_report
from treadload.reporting.reading import ReportCase
from treadload.reporting.tables import result_table
from treadload.reporting.typesetting import with_powers
from treadload.steps import Result, run
from treadload.units import repetitions_in_words
from treadload.us_units import display_units

CASE = """
title = "{title}"
spacing = "12 mm"
[tire]
profile = "315/80R22.5"
inflation_pressure = "8.2 bar"
material = {{ kind = "elastic", modulus = "3 MPa", poisson = 0.5 }}
[[pavement.layers]]
name = "asphalt concrete"
material = {{ kind = "elastic", modulus = "5400 MPa", poisson = 0.35 }}
[rolling]
normal_load = "32.5 kN"
tractive_force = "{force} kN"
friction = 0.7
[response]
depths = ["0 mm", "20 mm"]
[damage]
fatigue = {{ epsilon_6 = "120 microstrain", slope = -0.2 }}
"""


class _Page(HTMLParser):
    """Tags, links and the text outside style sheets."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.links: list[str] = []
        self.images = 0
        self.text: list[str] = []
        self._skip = 0
        self.feed(html)

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self._skip += tag == "style"
        self.images += tag == "img"
        self.links += [value for name, value in attrs if name in ("src", "href") and value]

    def handle_endtag(self, tag):
        self._skip -= tag == "style"

    def handle_data(self, data):
        if not self._skip:
            self.text.append(data)

    @property
    def words(self) -> str:
        return re.sub(r"[ \n]+", " ", " ".join(self.text))


def _only(tree: xr.DataTree, *groups: str) -> xr.DataTree:
    """A tree with some of its groups: fewer figures to draw."""
    kept = {f"/{name}": tree[name].to_dataset() for name in groups}
    return xr.DataTree.from_dict({"/": xr.Dataset(attrs=tree.attrs), **kept})


def _run(title: str, force: float) -> Result:
    return run(Case.from_text(CASE.format(title=title, force=force)))


@pytest.fixture(scope="module")
def results() -> dict[str, Result]:
    return {"free": _run("Free", 0.0), "driving": _run("Driving", 10.0)}


@pytest.fixture(scope="module")
def page(results, tmp_path_factory, page_of_dots) -> _Page:
    trees = {
        "free": _only(results["free"].to_tree(), "contact", "response", "damage"),
        "driving": results["driving"].to_tree(),
    }
    trees["free"]["response"] = xr.DataTree(trees["free"]["response"].to_dataset().isel(depth=[0]))
    path = tmp_path_factory.mktemp("report") / "report.html"
    return _Page(page_of_dots(trees, path, title="Two ways of rolling"))


def test_report_holds_the_numbers_of_every_case(page, results):
    for result in results.values():
        data = result.contact.dataset
        assert result.verdict is not None
        verdict = result.verdict.dataset
        for wanted in (
            f"{float(data.normal_load) / 1e3:.2f}",
            f"{result.contact.area * 1e6:,.0f}".replace(",", "\u202f"),
            f"{float(data.pressure.max()) / 1e3:.0f}",
            f"{100 * result.contact.slip_fraction:.1f}",
            f"{float(result.response.dataset.principal_strain_1.isel(depth=0).max()) * 1e6:.1f}",
            f"{float(result.response.dataset.in_plane_strain_1.isel(depth=0).max()) * 1e6:.1f}",
            f"{float(verdict.worst_strain) * 1e6:.1f} microstrain",
            "in-plane strain, mean over 10 mm",
            f"{float(verdict.worst_depth) * 1e3:g} mm deep",
            "the mean of two contacts whose grids are offset by half a cell",
            with_powers(repetitions_in_words(float(verdict.worst_passes))),
            result.verdict.orientation,
        ):
            assert wanted in page.words
    for unit in ("kN", "kPa", "mm²", "microstrain", "MPa"):
        assert unit in page.words


def test_passes_say_under_how_many_contacts_they_are_read(page, results):
    """Both cases read two; one of the same numbers under one contact says so in the row that they share."""
    pair = "the mean of two contacts whose grids are offset by half a cell"
    assert page.words.count(f"in the horizontal plane, under {pair}. The darkest places") == 2
    assert page.words.count(f"evaluated under {pair} {pair}") == 1
    damage = results["free"].verdict.dataset
    one = damage.copy()
    del one.attrs["lattices"]
    cases = [ReportCase("two", {"damage": damage}, {}), ReportCase("one", {"damage": one}, {})]
    (row,) = [row for section in result_table(cases) for row in section.rows if row.name == "evaluated under"]
    assert row.values == (pair, "one contact")


def test_report_shows_inputs_statistics_citations_and_provenance(page, results):
    for wanted in (
        "Young's modulus",
        "asphalt concrete",
        "coefficient of friction",
        "0.7",
        "residual of the rolling contact",
        "Kalker, J. J. (1990)",
        "treadload",
        "computed by",
        "epsilon_6",
    ):
        assert wanted in page.words
    assert "details" in page.tags
    assert results["free"].case.to_toml().splitlines()[0] in page.words


def test_report_tells_the_largest_strain_under_the_surface(page, results):
    data = [results["driving"].slice_along.dataset, results["driving"].slice_across.dataset]
    largest = max(float(d.principal_strain_1.max()) for d in data)
    row = page.words.split("vertical sections", 1)[1][:60]
    assert f"{largest * 1e6:.1f}" in row
    assert "mm deep" in page.words


def test_report_needs_no_other_file(page):
    assert page.images >= 20
    assert "could not be drawn" not in page.words
    assert "script" not in page.tags
    assert "link" in page.tags
    for link in page.links:
        assert link.startswith(("data:", "#")), link


@pytest.mark.usefixtures("figures_as_dots")
def test_side_by_side_only_for_several(page, results, tmp_path):
    assert "side by side" in page.words
    path = write_report({"alone": _only(results["free"].to_tree(), "contact")}, tmp_path / "one.html")
    one = _Page(path.read_text(encoding="utf-8"))
    assert "side by side" not in one.words
    assert "Free" in one.words


def test_captions_say_which_strain_is_drawn(page):
    assert "Drawn: the three-dimensional strain" in page.words
    assert "Drawn: the strain in the horizontal plane" in page.words


@pytest.mark.usefixtures("figures_as_dots")
def test_text_of_the_user_is_escaped(results, tmp_path):
    bad = '<script>alert("x")</script> & $\\frac'
    tree = _only(results["driving"].to_tree(), "contact", "damage")
    tree.attrs["case"] = 'title = "</pre><script>x</script>"\n[tire]\nscan = "<img src=http://x>"\n'
    tree.attrs["citations"] = json.dumps([bad])
    contact = tree["contact"].to_dataset()
    contact.attrs["warnings"] = json.dumps([bad])
    tree["contact"] = xr.DataTree(contact)
    path = write_report(
        {bad: tree, "other": _only(results["free"].to_tree(), "contact", "damage")},
        tmp_path / "report.html",
        title=bad,
    )
    html = path.read_text(encoding="utf-8")
    page = _Page(html)
    assert "script" not in page.tags
    assert "&lt;script&gt;alert(" in html
    assert all(link.startswith(("data:", "#")) for link in page.links)
    assert "Warning" in page.words


@pytest.mark.slow
def test_absent_groups_are_left_out(results, tmp_path):
    tree = results["driving"].to_tree()
    for kept in (["contact"], ["response"], ["damage"]):
        part = _only(tree, *kept)
        page = _Page(write_report({"part": part}, tmp_path / "part.html").read_text(encoding="utf-8"))
        assert page.images >= 2
        if kept != ["damage"]:
            assert "No assessment" in page.words


@pytest.mark.usefixtures("figures_as_dots")
def test_measured_footprint_with_pressure_only(results, tmp_path):
    data = results["free"].contact.dataset[["pressure"]]
    tree = xr.DataTree.from_dict({"/contact": data.assign_attrs(warnings="not json", stats="[1]")})
    page = _Page(write_report({"sensor": tree}, tmp_path / "r.html").read_text(encoding="utf-8"))
    assert "peak pressure" in page.words
    assert "peak shear" not in page.words


@pytest.mark.slow
def test_verdict_without_sentence_is_composed(results, tmp_path):
    damage = results["driving"].to_tree()["damage"].to_dataset()
    for name in ("sentence", "rows"):
        del damage.attrs[name]
    tree = xr.DataTree.from_dict({"/damage": damage})
    page = _Page(write_report({"case": tree}, tmp_path / "r.html").read_text(encoding="utf-8"))
    passes = with_powers(repetitions_in_words(float(damage.worst_passes)))
    assert f"Allowable load repetitions: {passes}" in page.words
    damage["worst_strain"], damage["worst_passes"] = -1e-6, np.inf
    tree = xr.DataTree.from_dict({"/damage": damage})
    page = _Page(write_report({"case": tree}, tmp_path / "r.html").read_text(encoding="utf-8"))
    assert "only where no principal stress is tensile; this criterion predicts no cracking" in page.words
    damage.attrs["largest_unread"] = -1e-6
    tree = xr.DataTree.from_dict({"/damage": damage})
    page = _Page(write_report({"case": tree}, tmp_path / "r.html").read_text(encoding="utf-8"))
    assert "no tensile strain here" in page.words


def test_a_path_that_cannot_be_written_leaves_nothing(results, tmp_path):
    tree = results["free"].to_tree()
    with pytest.raises(InputError, match="cannot write"):
        write_report({"free": tree}, tmp_path / "missing" / "report.html")
    with pytest.raises(InputError, match="cannot write"):
        write_report({"free": tree}, tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_a_failure_keeps_the_file_from_before(results, tmp_path, monkeypatch):
    path = tmp_path / "report.html"
    path.write_text("before")
    monkeypatch.setattr("treadload.reporting.build.case_sections", lambda *a, **k: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        write_report({"free": results["free"].to_tree()}, path)
    assert path.read_text() == "before"
    assert [p.name for p in tmp_path.iterdir()] == ["report.html"]


def test_reports_need_results(tmp_path):
    with pytest.raises(InputError, match="at least one case"):
        write_report({}, tmp_path / "r.html")
    with pytest.raises(InputError, match="holds nothing"):
        write_report({"empty": xr.DataTree()}, tmp_path / "r.html")


ROAD = """
[pavement]
temperature = [45, 30, 20]
[[pavement.layers]]
name = "wearing course"
thickness = "60 mm"
material = { kind = "published", name = "ViscoRoute" }
bond = { stiffness = "1000 MPa/m" }
[[pavement.layers]]
mix = "EB-GB3"
thickness = "150 mm"
[[pavement.layers]]
mix = "PF3"
"""


@pytest.fixture(scope="module")
def moving() -> Result:
    """A wheel at 72 km/h on a viscoelastic road of three layers; cells of 20 mm."""
    start, end = CASE.index("[[pavement.layers]]"), CASE.index("[rolling]")
    text = CASE[:start].format(title="Moving") + ROAD + CASE[end:].format(force=0)
    response = 'depths = ["40 mm", "210 mm"]\nspeed = "72 km/h"\nwheels = [{ y = 0.15 }]'
    text = text.replace('depths = ["0 mm", "20 mm"]', response).replace('"12 mm"', '"20 mm"')
    return run(Case.from_text(text.replace("slope = -0.2 }", 'slope = -0.2 }\ndepth = "210 mm"')))


@pytest.mark.slow
def test_report_of_a_moving_wheel_on_layers(moving, tmp_path):
    tree = moving.to_tree()
    page = _Page(write_report({"moving": tree}, tmp_path / "r.html").read_text(encoding="utf-8"))
    for wanted in (
        "Wheels at 72 km/h",
        "wearing course",
        "spring of 1000 MPa/m",
        # NF P98-086 prints 2700 MPa for EB-GB3 at 30 °C and 10 Hz.
        "2700",
        "semi-infinite",
        "|E*| at 10 Hz",
        "Deflection bowl.",
        "Energy dissipated in one passage.",
        "Strain against depth.",
        "through the worst point 210 mm deep",
        "wheel 1: y",
        "Sayegh",
        "Goodman",
    ):
        assert wanted in page.words, wanted
    # An elastic road under one wheel has none of these.
    del tree["bowl"]
    part = _Page(write_report({"moving": tree}, tmp_path / "r.html").read_text(encoding="utf-8"))
    assert "Deflection bowl." not in part.words


@pytest.mark.slow
def test_report_in_us_units(moving, tmp_path):
    tree = _only(moving.to_tree(), "contact", "response", "damage")
    with display_units("us"):
        html = write_report({"moving": tree}, tmp_path / "r.html").read_text(encoding="utf-8")
    page = _Page(html)
    for wanted in (
        "Wheels at 44.7 mph",  # 72 km/h, 44.739
        "thickness, in", "modulus E, ksi", "temperature, °F",
        "391.6",  # 2700 MPa of EB-GB3 at 30 °C and 10 Hz is 391.6 ksi
        "118.9",  # inflation pressure, 8.2 bar, of the table of inputs, psi
        "in deep",
    ):  # fmt: skip
        assert wanted in page.words, wanted
    heads = re.findall(r"<th[^>]*>([^<]*)</th>", html)
    assert not [head for head in heads if re.search(r", (mm|kPa|MPa|kN|°C|N)$", head)]
    cells = re.findall(r"<td[^>]*>([^<]*)</td>", html)
    assert "psi" in {cell.strip() for cell in cells} or any(cell.endswith(" psi") for cell in cells)
    assert not [cell for cell in cells if re.fullmatch(r"\s*([-\u2212\d.]+ )?(mm|kPa|MPa|kN|km/h|°C|N)\s*", cell)]
    # Outside the block the same file is in SI units.
    tree = _only(moving.to_tree(), "contact")
    assert "kPa" in write_report({"moving": tree}, tmp_path / "si.html").read_text(encoding="utf-8")


@pytest.mark.slow
def test_energy_is_drawn_where_it_is_lost(moving):
    from treadload.plots import dissipated_energy, png

    across = moving.slice_across.dataset
    figure = dissipated_energy(across)
    ax = figure.axes[0]
    # Down to the bottom of the wearing course, the only layer that loses energy.
    assert ax.get_ylim() == pytest.approx((60, 0))
    known = across.dissipated_energy.where(across.depth <= 0.06)
    assert ax.collections[0].get_array().max() == pytest.approx(float(known.max()))
    assert png(figure)
    elastic = across.assign(dissipated_energy=0 * across.dissipated_energy.fillna(0))
    with pytest.raises(InputError, match="no layer of this road dissipates energy"):
        dissipated_energy(elastic)
    with pytest.raises(InputError, match="dissipated_energy"):
        dissipated_energy(across.drop_vars("dissipated_energy"))


@pytest.mark.slow
def test_report_of_objects(results, tmp_path):
    result = results["driving"]
    path = report([result.contact, result.verdict], tmp_path / "r.html", title="By hand")
    page = _Page(path.read_text(encoding="utf-8"))
    assert "By hand" in page.words
    assert "3 MPa" in page.words
