"""`treadload --units us app`: card, tables, maps, hover texts and the slice in US units; fields and files in SI."""

import re
from zipfile import ZipFile

import pytest

import treadload as tl
from page_visits import Visit, axe_faults, serving

pytestmark = pytest.mark.browser

INCH, PSI, KIP = 25.4, 6.894757293168361, 4.4482216152605
SI = re.compile(r"\d\s*(mm|kPa|MPa|kN)(?![\w/])")


@pytest.fixture(scope="module")
def visit(chromium, tmp_path_factory):
    with serving(tmp_path_factory.mktemp("us"), units="us") as server:
        one = Visit(chromium, server.printed)
        one.ready(1)
        one.done()
        yield one
        one.context.close()


def redrawn_in_other_theme(page):
    """Let the process draw all figures again, and wait for them."""
    names = ["maps", "profile", "section"]
    counts = page.evaluate("(names) => names.map((name) => treadloadTimes[name].count)", names)
    page.locator("#theme").click()
    page.wait_for_function(
        "([names, counts]) => names.every((name, n) => treadloadTimes[name].count > counts[n])", arg=[names, counts]
    )


def test_card_and_tables_are_in_us_units(visit):
    page, rows = visit.page, visit.verdict()
    place = page.locator('[data-fact="Place"]').inner_text()
    # The top of the soil, below 60 and 200 mm.
    assert place.startswith(f"soil, top, {260 / INCH:.1f} in deep; x = ")
    assert place.endswith(" in")
    assert rows["normal_load"] == f"{32.5 / KIP:.4f} kip"
    peak = float(rows["largest_pressure"].removesuffix(" psi"))
    marked = page.evaluate("document.querySelector('.maps').data.filter((t) => t.name === 'peak')[0].text[0]")
    assert marked == f"{peak:.0f} psi"
    for name in ("#verdict", "#allowed", "#bright"):
        assert SI.search(page.locator(name).inner_text()) is None


def test_fields_stay_in_si_and_say_so(visit):
    page = visit.page
    note = page.locator("#units").inner_text()
    assert note.startswith("A number in a field is in the SI unit at the field")
    assert note.endswith("Results are in US units.")
    thickness = page.locator('[data-path="pavement.layers.0.thickness"]')
    assert "mm" in thickness.evaluate("one => one.closest('.q-field').innerText")
    before = visit.solves()
    visit.set("rolling.normal_load", "40")
    visit.ready(before + 1)
    visit.done()
    assert visit.verdict()["normal_load"] == f"{40 / KIP:.4f} kip"
    visit.set("rolling.normal_load", "32.5")
    visit.ready(before + 2)
    visit.done()


def test_hover_of_the_maps(visit):
    """The text at a cell is its number in the figure, whose unit the colour bar and the axes name."""
    page = visit.page
    titles = page.evaluate(
        "(({ xaxis, yaxis2 }) => [xaxis.title.text, yaxis2.title.text])(document.querySelector('.maps')._fullLayout)"
    )
    assert titles == ["x, direction of travel (in)", "y, right of travel (in)"]
    at = page.evaluate(
        """() => { const p = document.querySelector('.maps'), { xaxis, yaxis } = p._fullLayout;
          const box = p.getBoundingClientRect();
          return [box.x + xaxis._offset + xaxis.d2p(0), box.y + yaxis._offset + yaxis.d2p(0)] }"""
    )
    page.mouse.move(at[0] - 30, at[1] - 30)
    page.mouse.move(*at)
    page.wait_for_selector(".maps .hoverlayer .hovertext")
    x, y, text = re.match(
        r"x (\S+) in, y (\S+) in\s*(.*)", page.locator(".maps .hoverlayer .hovertext").first.text_content()
    ).groups()
    assert abs(float(x.replace("\u2212", "-"))) < 0.1
    assert abs(float(y.replace("\u2212", "-"))) < 0.1
    assert text.endswith(" psi")
    # The middle rib bears some 800 kPa to 1 MPa of a tire of 820 kPa.
    assert 0.6 * 820 < PSI * float(text.removesuffix(" psi")) < 1.6 * 820


def test_the_slice_is_put_in_inches_and_solved_there(visit):
    page = visit.page
    page.evaluate("treadloadPut({ along: 'x', at: 50.8 })")
    page.wait_for_function("document.getElementById('placed').textContent === 'y 2 in'")
    line = page.evaluate("(({ x0, y0, y1 }) => [x0, y0, y1])(document.querySelector('.maps').layout.shapes[0])")
    assert line[1:] == pytest.approx([2, 2])
    title = "document.querySelector('.profile')._fullLayout.xaxis.title.text"
    page.wait_for_function(f"{title}.endsWith('at y = 2.000 in')")
    drawn = page.evaluate("(({ x, y }) => [[...x], [...y]])(document.querySelector('.profile')._fullData[0])")
    # From the process, which reads the same line in the road's coordinates.
    redrawn_in_other_theme(page)
    again = page.evaluate("(({ x, y }) => [[...x], [...y]])(document.querySelector('.profile')._fullData[0])")
    assert again[0] == pytest.approx(drawn[0], abs=1e-4)
    assert again[1] == pytest.approx(drawn[1], rel=1e-4, abs=1e-3)
    redrawn_in_other_theme(page)


def test_a_place_of_the_table_is_shown_where_it_is(visit):
    page = visit.page
    marked = page.evaluate(
        "(({ x, y }) => [x[0], y[0]])(document.querySelector('.maps').data.filter((t) => t.name === 'peak')[0])"
    )
    page.locator('[data-row="largest_pressure"] button').click()
    middle = """() => { const { xaxis, yaxis } = document.querySelector('.maps')._fullLayout;
      return [xaxis, yaxis].map(({ range }) => (range[0] + range[1]) / 2) }"""
    page.wait_for_function(f"Math.abs(({middle})()[1] - {marked[1]}) < 0.2")
    assert page.evaluate(middle) == pytest.approx(marked, abs=0.2)
    page.evaluate("treadloadWhole()")


def test_files_stay_in_si_and_the_report_is_in_us_units(visit, tmp_path):
    paths = {}
    for kind, name in (("nc", "r.nc"), ("html", "r.html"), ("csv", "r.zip")):
        with visit.page.expect_download() as download:
            visit.page.locator(f'[data-take="{kind}"]').click()
        paths[kind] = tmp_path / name
        download.value.save_as(paths[kind])
    tree = tl.open_results(paths["nc"]).tree
    assert "32.500 kN" in tree.attrs["summary"]
    assert not re.search(r"\b(psi|kip)\b", tree.attrs["summary"])
    report = paths["html"].read_text("utf-8")
    assert re.search(r"<td[^>]*>7\.3063</td>", report)
    assert re.search(r"<td[^>]*>kip</td>", report)
    with ZipFile(paths["csv"]) as archive:
        text = "".join(archive.read(name).decode() for name in archive.namelist())
    assert not re.search(r"\b(psi|kip)\b", text)


def test_axe_finds_no_fault(visit):
    assert axe_faults(visit, dark=False) == []
    assert not visit.errors
