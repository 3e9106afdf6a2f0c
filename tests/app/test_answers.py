"""What the page answers at a glance, and that nothing on it belongs to another case without saying so."""

import itertools
import re

import numpy as np
import pytest

from page_visits import axe_faults, in_theme, within
from treadload.app.case_link import form_of_link, link_of
from treadload.app.form import Form
from treadload.case import Case
from treadload.errors import InputError
from treadload.reporting.typesetting import with_powers
from treadload.steps.allowed import passes_allowed
from treadload.steps.loaded import judge, load_case

pytestmark = pytest.mark.browser

WATCH = """() => { window.seen = [];
  const note = (what) => seen.push([what, performance.now()]);
  document.addEventListener("input", () => note("input"), true);
  new MutationObserver(() => note(document.body.dataset.stale ?? "")).observe(
    document.body, { attributes: true, attributeFilter: ["data-stale"] }) }"""
FRESH = "body:not([data-stale])"
# Whether the headline of the card and the numbers below it have the grey of the page's notes.
COLOURS = """() => { const grey = getComputedStyle(document.querySelector(".bar .stage")).color;
  return ["#card .headline", "#verdict td:last-child"].map(
    (name) => getComputedStyle(document.querySelector(name)).color === grey) }"""
OPACITY = "(name) => +getComputedStyle(document.querySelector(name)).opacity"


def typed(page, path):
    field = page.locator(f'[data-path="{path}"]')
    return field if field.evaluate("one => one.tagName") == "INPUT" else field.locator("input")


def test_results_of_another_input_are_dimmed_until_they_are_solved(visit):
    """From the first letter that is typed, and with the name of the case that they belong to."""
    page, before = visit.page, visit.solves()
    visit.done()
    page.wait_for_selector(FRESH)
    assert not page.locator("#before").is_visible()
    page.evaluate(WATCH)
    field = typed(page, "rolling.normal_load")
    field.fill("36")
    page.wait_for_selector('body[data-stale="all"]')
    (_, start), (_, dimmed) = page.evaluate("seen.slice(0, 2)")
    within((dimmed - start) / 1e3, 0.05, "results dimmed after a letter was typed")
    for name in (".figure.maps", ".figure.profile", ".figure.section"):
        assert page.evaluate(OPACITY, name) < 0.5, name
    # Numbers are grey, and can still be read.
    assert page.evaluate(COLOURS) == [True, True]
    assert axe_faults(visit, dark=False) == []
    assert page.locator("#before").inner_text() == "Results of the case before: 32.5 kN, 10 kN tractive force"
    # Typed back, they are those of the fields again, and nothing was solved.
    field.fill("32.5")
    field.press("Tab")
    page.wait_for_selector(FRESH)
    assert visit.solves() == before
    field.fill("36")
    field.press("Enter")
    visit.ready(before + 1)
    # The section, which is solved last, is that of the run before for a while.
    visit.done()
    page.wait_for_selector(FRESH)
    for name in (".figure.maps", ".figure.section"):
        assert page.evaluate(OPACITY, name) == 1, name
    assert page.evaluate(COLOURS) == [False, False]


def test_a_wrong_number_stands_at_its_field_in_its_unit(visit):
    """The reader speaks of the table and of newtons; the page of the field and of its unit."""
    page, before = visit.page, visit.solves()
    for path, text, wanted in (
        (
            "rolling.normal_load",
            "-5",
            "Normal load must be a positive number of kN, got -5; a truck's wheel carries 20",
        ),
        (
            "pavement.layers.0.thickness",
            "-60",
            "layer 'wearing course': thickness must be a positive number of mm, got",
        ),
    ):
        was = typed(page, path).input_value()
        visit.set(path, text)
        told = page.locator(".q-field--error [role=alert]")
        told.first.wait_for()
        assert told.count() == 1
        assert told.inner_text().startswith(wanted)
        assert typed(page, path).evaluate("one => one.closest('.q-field').classList.contains('q-field--error')")
        # What is shown is of the case before, and says so.
        page.wait_for_selector('body[data-stale="all"]')
        visit.set(path, was)
        page.wait_for_selector(FRESH)
        before += 1
        visit.ready(before)
    visit.done()


def test_a_file_that_cannot_be_used_leaves_the_case_as_it_was(visit, tmp_path):
    page, before = visit.page, visit.solves()
    verdict = visit.verdict()
    fields = page.locator("[data-path]").count()
    path = tmp_path / "garbage.obj"
    path.write_bytes(b"\x00\xff v no mesh " * 50)
    visit.chosen("mesh …", path)
    told = page.locator("#problems .problem")
    told.wait_for()
    # The user's name of the file, and what is in force.
    assert "garbage.obj" in told.inner_text()
    assert told.inner_text().endswith("The case keeps what it had before.")
    assert page.locator('[data-path="tire.scan"]').count() == 0
    assert page.locator("[data-path]").count() == fields
    page.wait_for_selector(FRESH)
    assert visit.solves() == before
    assert {key: text for key, text in visit.verdict().items() if not key.startswith("allowed")} == {
        key: text for key, text in verdict.items() if not key.startswith("allowed")
    }


def test_runs_are_named_by_what_sets_them_apart(visit):
    page, before = visit.page, visit.solves()
    visit.set("pavement.layers.0.thickness", "80")
    visit.ready(before + 1)
    visit.done()
    names = page.locator("#runs b").all_inner_texts()
    assert names[0] == "wearing course thickness 80 mm, normal load 36 kN"
    assert names[-1] == "wearing course thickness 60 mm, normal load 32.5 kN"
    assert len(set(names)) == len(names)
    label = page.locator("#runs button").first.get_attribute("aria-label")
    assert label == f"show the run {names[0]}"
    visit.set("pavement.layers.0.thickness", "60")
    visit.ready(before + 2)
    visit.done()


def test_the_section_is_as_wide_as_its_row_and_smooth_within_layers(visit):
    page = visit.page
    page.wait_for_selector(FRESH)
    box = (
        "(name) => { const l = document.querySelector(name)._fullLayout; return [l.xaxis._offset, l.xaxis._length] }"
    )
    profile, section = (page.evaluate(box, name) for name in (".profile", ".section"))
    assert section == pytest.approx(profile, abs=2)
    # As the browser makes it of the depths that it holds.
    page.evaluate("treadloadPut({ along: 'x', at: 40 })")
    page.wait_for_function("Array.isArray(document.querySelector('.section').data[0].z)")
    held = page.evaluate(
        "(({z, y}) => ({z: z.map((row) => [...row]), y: [...y]}))(document.querySelector('.section')._fullData[0])"
    )
    z, y = np.array(held["z"], dtype=float), np.array(held["y"])
    assert 60.0 in y
    assert 260.0 in y
    # Piecewise linear over some sixteen depths: between rows of one layer the value changes by small steps.
    deep = (y[1:] + y[:-1]) / 2
    assert len(deep) >= 90
    steps = np.abs(np.diff(z, axis=0)).max(axis=1) / np.nanmax(z)
    inside = np.array([not any(a < face < b for face in (60.0, 260.0)) for a, b in itertools.pairwise(deep)])
    assert steps[inside & (deep[:-1] > 20)].max() < 0.05


def test_light_and_dark_redraw_all_figures(visit):
    page = visit.page
    papers = """(names) => names.map((name) => document.querySelector(`.figure.${name}`)._fullLayout.font.color)"""
    names = ["maps", "profile", "section"]
    page.locator("#tread").click()
    page.wait_for_selector(".figure.tread.js-plotly-plot")
    page.wait_for_timeout(500)
    names.append("tread")
    for _ in range(2):
        before = page.evaluate(papers, names)
        counts = page.evaluate("(names) => names.map((name) => treadloadTimes[name].count)", names)
        start = page.evaluate("performance.now()")
        page.locator("#theme").click()
        page.wait_for_function(
            "([names, counts]) => names.every((name, n) => treadloadTimes[name].count > counts[n])",
            arg=[names, counts],
        )
        ends = page.evaluate("(names) => names.map((name) => treadloadTimes[name].end)", names)
        within((max(ends) - start) / 1e3, 1.0, "all figures redrawn in the other theme")
        assert not set(before) & set(page.evaluate(papers, names))
    page.locator("#tread").click()


def test_the_card_gives_the_answer_and_explains_the_map(visit):
    """Load repetitions, criterion, place and reason of Python's; why the map's brightest spot is another number."""
    page = visit.page
    page.wait_for_selector(FRESH)
    load = load_case(Case.from_dict(dict(Form.first().with_values({"rolling.normal_load": "36 kN"}).table)),
                     lambda text: None)  # fmt: skip
    verdict = judge(load, load.solve(load.case.response.depths))
    allowed = passes_allowed(load, verdict)
    first = min(allowed.rows, key=lambda line: line.passes)
    assert page.locator("#card .headline").inner_text() == with_powers(
        f"Allowable load repetitions: {first.passes:.3g}"
    )
    assert page.locator('[data-fact="Governing criterion"]').inner_text() == first.name == "french-subgrade"
    assert page.locator('[data-fact="Place"]').inner_text().startswith("soil, top, 260 mm deep")
    assert f"{1e6 * first.reading:.0f} microstrain" in page.locator('[data-fact="Why"]').inner_text()
    assert page.locator("#further").inner_text().startswith("Does not govern: fatigue line with ")
    # The number on the map is in the sentence that says what it is.
    marked = page.evaluate(
        "document.querySelector('.maps').data.filter((t) => t.name === 'peak').map((t) => t.text[0])"
    )[-1]
    number = re.match(r"\d+", marked)[0]
    bright = page.locator("#bright").inner_text()
    assert f"{number} microstrain" in bright
    assert "no principal stress is tensile there" in bright or "as means over 10 mm" in bright


def test_the_card_is_drawn_with_the_maps(visit):
    page, before = visit.page, visit.solves()
    page.evaluate(
        "() => { window.carded = 0; new MutationObserver(() => {"
        " if (document.querySelector('#card .headline') && !document.body.dataset.stale?.includes('all'))"
        " window.carded ||= performance.now() })"
        ".observe(document.querySelector('.right'), {childList: true, subtree: true}) }"
    )
    field = typed(page, "rolling.normal_load")
    field.fill("35")
    start = page.evaluate("performance.now()")
    field.press("Enter")
    page.wait_for_function("window.carded")
    within((page.evaluate("window.carded") - start) / 1e3, 1.5, "card drawn after a load was changed")
    visit.ready(before + 1)
    visit.done()
    page.wait_for_selector(FRESH)


def test_road_and_tire_are_drawn_to_one_scale(visit):
    page = visit.page
    drawing = """() => { const l = document.querySelector('.figure.road')._fullLayout;
      const unit = (a) => a._length / Math.abs(a.range[1] - a.range[0]);
      return { units: [unit(l.xaxis), unit(l.yaxis)], texts: l.annotations.map((one) => one.text),
               boxes: l.shapes.map(({ x0, x1, y0, y1 }) => [x0, x1, y0, y1]) } }"""
    page.wait_for_selector(".figure.road.js-plotly-plot")
    drawn = page.evaluate(drawing)
    assert drawn["units"][0] == pytest.approx(drawn["units"][1], rel=0.01)
    assert drawn["texts"][:3] == ["wearing course 60 mm", "base 200 mm", "soil"]
    wearing, base, _, tire = drawn["boxes"]
    assert wearing[2:] == pytest.approx([0, -60])
    assert base[2:] == pytest.approx([-60, -260])
    case = Case.from_dict(dict(Form.first().table))
    assert tire[1] - tire[0] == pytest.approx(1e3 * case.build_tire().surface.profile.width)


def test_a_link_restores_a_case(visit):
    """In another tab, on the page that is open, and not where it is damaged."""
    page = visit.page
    visit.context.grant_permissions(["clipboard-read", "clipboard-write"])
    page.locator("#copy-link").click()
    page.wait_for_function("document.getElementById('link')?.value")
    address = page.locator("#link").input_value()
    assert page.evaluate("navigator.clipboard.readText()") == address
    assert re.fullmatch(r"http://127\.0\.0\.1:\d+/#case=1\.[\w-]+", address)
    before = visit.solves()
    visit.set("rolling.normal_load", "30")
    visit.ready(before + 1)
    visit.done()
    page.goto(address)
    page.wait_for_function("document.querySelector('[data-path=\"rolling.normal_load\"]')?.value === '35'")
    visit.ready(before + 2)
    assert visit.verdict()["normal_load"] == "35.000 kN"
    assert "#" not in page.url
    # A link that lost its end.
    page.goto(address[:-30])
    told = page.locator("#link-problem .problem")
    told.wait_for()
    assert "damaged" in told.inner_text() or "cut off" in told.inner_text()
    assert "copy the whole link again" in told.inner_text()
    assert typed(page, "rolling.normal_load").input_value() == "35"


def test_links_hold_what_they_can_and_refuse_the_rest():
    """A round trip; files, long cases, other pages, other machines' paths and what is no link."""
    form = Form.first().with_values({"rolling.normal_load": "41 kN", "title": "Straße, 40 °C"})
    link = link_of(form, ())
    assert form_of_link(f"#{link}", "run") == form
    assert len(link) < 1000
    scanned = Form.first().with_values({"tire": {"scan": "upload_1.obj"}})
    with pytest.raises(InputError, match="1 uploaded file"):
        link_of(scanned, ("upload_1.obj",))
    noise = np.random.default_rng(3).integers(0, 10**6, 4000)
    with pytest.raises(InputError, match="8000 are the most"):
        link_of(form.with_values({"title": " ".join(map(str, noise))}), ())
    with pytest.raises(InputError, match="page 'the bench'"):
        form_of_link(link, "life")
    with pytest.raises(InputError, match="file of the machine"):
        form_of_link(link_of(Form.first().with_values({"tire": {"scan": "/etc/passwd"}}), ()), "run")
    for wrong in (
        "case=",
        "case=1.",
        "case=1.!!",
        "case=2.abc",
        link[:-9],
        link.replace("1.", "1.AA"),
        "case=1." + "a" * 9000,
    ):
        with pytest.raises(InputError, match="link"):
            form_of_link(wrong, "run")
    # Few letters that would unpack to much.
    huge = link_of(form.with_values({"title": "a" * 500_000}), ())
    with pytest.raises(InputError, match="cut off"):
        form_of_link(huge, "run")


def test_a_link_of_another_page_is_told_there(visit):
    link = link_of(Form.first("life"), ())
    other = visit.tab(f"#{link}")
    try:
        told = other.page.locator("#link-problem .problem")
        told.wait_for()
        assert "page 'life'" in told.inner_text()
    finally:
        other.page.close()


@pytest.mark.parametrize("width", [1024, 1440, 2560])
def test_nothing_is_cut_at_the_sides(visit, width):
    """Also while results are dimmed, with a wrong field, and in both themes."""
    page, size = visit.page, visit.page.viewport_size
    page.set_viewport_size({"width": width, "height": 900})
    field = typed(page, "rolling.normal_load")
    was = field.input_value()
    field.fill("-5")
    field.press("Enter")
    page.locator(".q-field--error [role=alert]").first.wait_for()
    for dark in (False, True):
        in_theme(page, dark)
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
        # The mark of the case before covers no button and no link.
        free = """() => { const b = document.getElementById('before').getBoundingClientRect();
          return b.width > 100 && [...document.querySelectorAll('.bar button, .bar a')].every((one) => {
            const o = one.getBoundingClientRect();
            return o.right <= b.left || o.left >= b.right || o.bottom <= b.top || o.top >= b.bottom }) }"""
        assert page.evaluate(free)
    field.fill(was)
    field.press("Enter")
    page.set_viewport_size(size)
    in_theme(page, False)


@pytest.mark.parametrize("dark", [False, True], ids=["light", "dark"])
def test_axe_finds_no_fault_on_the_card_and_the_drawing(visit, dark):
    visit.page.wait_for_selector(FRESH)
    assert axe_faults(visit, dark) == []


def test_nothing_went_wrong(visit):
    assert not visit.errors
