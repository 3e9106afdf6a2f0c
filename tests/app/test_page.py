"""The page in a real Chromium: what a user does, what the issue of speed bounds, what an intruder tries."""

import http.client
import re
import time
from contextlib import closing

import numpy as np
import pytest

import treadload as tl
from page_visits import PATIENCE, Visit, axe_faults, in_theme, within
from tire_meshes import tire_mesh, write
from treadload.app.form import Form
from treadload.app.map_figures import block_depths
from treadload.case import Case
from treadload.errors import TreadloadError
from treadload.plots import interactive
from treadload.plots.kit.shown import shown
from treadload.results import save_results
from treadload.steps.allowed import passes_allowed
from treadload.steps.loaded import judge, load_case
from treadload.sweeps import sweep

pytestmark = pytest.mark.browser


# Maps of the road of another run than one before are on the screen, or of its verdict where that was quicker.
DRAWN = """(was) => { const [run, part] = (document.body.dataset.maps ?? "").split(":");
  return run && run !== was && part !== "contact" }"""


def changed_case(**changes):
    """The case of the page with keys changed."""
    table = Form.first().with_values({key.replace("__", "."): value for key, value in changes.items()}).table
    return Case.from_dict(dict(table))


def python(**changes):
    """What Python says of the case of the page with keys changed."""
    case = changed_case(**changes)
    load = load_case(case, lambda text: None)
    return load.contact, judge(load, load.solve(case.response.depths))


def test_the_first_sight(visit):
    """First paint, the cookie in place of the token, no request to anywhere else, no error."""
    page = visit.page
    paint = page.evaluate("performance.getEntriesByName('first-contentful-paint')[0].startTime") / 1e3
    within(paint, 2.0, "first paint")
    assert "token" not in page.url
    visit.done()
    elsewhere = [url for url in visit.asked if not re.match(r"(http|ws)://127\.0\.0\.1:|data:|blob:", url)]
    assert not elsewhere
    assert visit.asked
    assert not visit.errors
    assert not page.evaluate("document.cookie")
    # Nothing is cut at the sides, and the maps are in true scale.
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    scale = page.evaluate(
        "(() => { const l = document.querySelector('.maps')._fullLayout;"
        "const unit = (a) => a._length / Math.abs(a.range[1] - a.range[0]);"
        "return [unit(l.xaxis), unit(l.yaxis), unit(l.xaxis2), unit(l.yaxis2)] })()"
    )
    assert max(scale) < 1.01 * min(scale)


def test_a_changed_load_gives_what_python_gives(visit):
    """Every number of the verdict, to the printed digit."""
    before, was = visit.solves(), visit.page.get_attribute("#bench", "data-run")
    start = time.monotonic()
    visit.set("rolling.normal_load", "36")
    visit.page.wait_for_function(DRAWN, arg=was)
    drawn = time.monotonic() - start
    visit.ready(before + 1)
    within(drawn, 1.5, "a case of 3 mm, contact and road, solved and redrawn")
    root = visit.page.locator("#bench")
    for name in ("contact", "response", "verdict"):
        print(f"processor time until {name} is drawn: {root.get_attribute(f'data-drawn-{name}')} s")
    contact, verdict = python(rolling__normal_load="36 kN")
    told, summary = visit.verdict(), contact.summary() + verdict.summary()
    assert told["normal_load"] == "36.000 kN"
    for row in (*contact.rows(), *verdict.rows()):
        assert told[row.key] == row.text, row.key
        assert row.text in summary, row.key
    assert f"{float(contact.dataset.pressure.max()) / 1e3:.0f} kPa" == told["largest_pressure"]
    if float(verdict.dataset["worst_strain"]) > 0:
        # Beyond 10¹⁰ repetitions two digits are shown.
        shown = float(told["worst_passes"].split()[0])
        assert shown == pytest.approx(float(verdict.dataset["worst_passes"]), rel=0.05)
    else:
        assert "predicts no cracking" in told["verdict"]
    assert visit.page.locator('[data-path="rolling.normal_load"]').count() == 1
    assert "yours" in visit.page.locator(".is-yours").first.inner_text()
    visit.done()


def test_passes_by_criterion_are_what_python_gives(visit):
    """Rows, digits and places of the table below the verdict; and what it says of layers that have none."""
    visit.done()
    load = load_case(changed_case(rolling__normal_load="36 kN"), lambda text: None)
    allowed = passes_allowed(load, judge(load, load.solve(load.case.response.depths)))
    told = visit.verdict()
    page = visit.page
    assert [one.name for one in allowed.rows] == ["fatigue line", "french-subgrade"]
    soil = allowed.rows[1]
    assert told["allowed:1"] == f"{soil.passes:.3g}"
    detail = page.locator('[data-detail="allowed:1"]').inner_text()
    assert detail.startswith(f"soil, top, 260 mm deep: {soil.reading * 1e6:.0f} microstrain")
    assert page.locator("#allowed .note").first.inner_text() == allowed.without[0]
    assert page.locator("#allowed a").get_attribute("href") == "./life"


def test_a_wrong_value_is_told_at_its_field(visit):
    before = visit.solves()
    visit.set("rolling.normal_load", "3 mm")
    told = visit.page.locator(".q-field--error [role=alert]").first
    told.wait_for()
    with pytest.raises(TreadloadError) as same:
        Case.from_dict(dict(Form.first().with_values({"rolling.normal_load": "3 mm"}).table))
    # At the field, in the unit of the field.
    assert told.inner_text() == str(same.value).partition("rolling.normal_load: ")[2].replace("in N:", "in kN:")
    assert visit.solves() == before
    visit.set("rolling.normal_load", "36")
    visit.ready(before + 1)
    visit.done()


def test_maps_are_laid_out_for_the_window_again(visit):
    """In a window that became wider they are as high as a page of that width draws them, in true scale and larger."""
    page, width = visit.page, visit.page.viewport_size["width"]
    layout = "document.querySelector('.maps')._fullLayout"
    high, unit = (
        f"{layout}.height",
        f"(({{_length, range}}) => _length / Math.abs(range[1] - range[0]))({layout}.yaxis)",
    )
    before, small = page.evaluate(high), page.evaluate(unit)
    page.set_viewport_size({"width": 1900, "height": 860})
    page.wait_for_function(f"(was) => {high} > 1.2 * was", arg=before)
    assert page.evaluate(unit) > 1.2 * small
    page.set_viewport_size({"width": width, "height": 860})
    page.wait_for_function(f"(was) => Math.abs({high} - was) < 3", arg=before)


def title_of(visit, figure):
    return visit.page.evaluate(f"document.querySelector('.{figure}')?.layout?.xaxis?.title?.text ?? ''")


def shape(page):
    return page.evaluate(
        "(({x0, y0, x1, y1}) => ({x0, y0, x1, y1}))(document.querySelector('.maps').layout.shapes[0])"
    )


def line_in_words(page):
    """What the page should say of a line along travel."""
    line = shape(page)
    assert line["y0"] == line["y1"]
    # Halves are rounded up in the browser.
    number = np.floor(10 * line["y0"] + 0.5) / 10
    return f"y {number:g} mm".replace("-", "−")


def drag(page, by):
    """Take the line of the slice with the mouse, and let it go so many mm to the right of travel."""
    place = page.evaluate(
        "(() => { const m = document.querySelector('.maps'), l = m._fullLayout, s = m.layout.shapes[0];"
        "const b = m.getBoundingClientRect();"
        "return [b.x + l.xaxis._offset + l.xaxis.d2p(-60), b.y + l.yaxis._offset + l.yaxis.d2p(s.y0),"
        "        l.yaxis._length / Math.abs(l.yaxis.range[1] - l.yaxis.range[0])] })()"
    )
    page.mouse.move(place[0], place[1])
    page.mouse.down()
    page.mouse.move(place[0], place[1] + 0.3 * by * place[2], steps=4)
    page.mouse.move(place[0], place[1] + by * place[2], steps=4)
    page.mouse.up()


def test_the_slice_is_dragged(visit):
    """With the mouse on the map, and with the slider, which a keyboard moves; the browser draws it by itself."""
    page = visit.page
    visit.done()
    page.wait_for_function("document.querySelector('.section.js-plotly-plot')?.layout?.xaxis?.title?.text")
    before = title_of(visit, "section")
    assert page.locator("#placed").inner_text() == line_in_words(page)
    # Towards the middle: the largest strain lies below either shoulder.
    drag(page, -60 if shape(page)["y0"] > 0 else 60)
    changed = "(was) => document.querySelector('.section').layout.xaxis.title.text !== was"
    page.wait_for_function(changed, arg=before)
    dragged = title_of(visit, "section")
    assert page.locator("#placed").inner_text() == line_in_words(page)
    assert float(page.locator("#place").input_value()) == pytest.approx(shape(page)["y0"], abs=0.51)
    assert title_of(visit, "profile").split(" (mm)")[0] == dragged.split(" (mm)")[0]
    # The slider goes along, from the keyboard.
    page.locator("#along").click()
    page.wait_for_function(changed, arg=dragged)
    was = title_of(visit, "section")
    page.locator("#place").focus()
    page.evaluate(
        "window.__drawn = []; ((draw) => { treadloadDraw = (...told) => { __drawn.push(told[0]); draw(...told) } })"
        "(treadloadDraw)"
    )
    start = time.monotonic()
    page.keyboard.press("ArrowRight")
    page.wait_for_function(changed, arg=was)
    within(time.monotonic() - start, 0.2, "a move of the slider on a solved case")
    assert page.locator("#placed").inner_text() == "y 1 mm"
    # The line lies there on both maps, where plotly itself would draw it.
    lines = "[...document.querySelectorAll('.maps .shapelayer path')].map((one) => one.getAttribute('d'))"
    moved = page.evaluate(lines)
    page.evaluate("Plotly.redraw(document.querySelector('.maps')).then(() => {})")
    numbers = [[float(n) for one in told for n in re.findall(r"[-0-9.]+", one)]
               for told in (moved, page.evaluate(lines))]  # fmt: skip
    np.testing.assert_allclose(*numbers, atol=0.02)
    # And there the mouse finds it.
    was = title_of(visit, "section")
    page.locator("#place").press("ArrowRight")
    page.wait_for_function(changed, arg=was)
    was = title_of(visit, "section")
    drag(page, -40)
    page.wait_for_function(changed, arg=was)
    assert page.evaluate("__drawn") == []


def test_the_slice_stays_on_the_map(visit):
    """Dragged or put beyond the border of the map, the line lies on the border."""
    page = visit.page
    visit.done()
    edges = page.evaluate(
        "(({x, y}) => [x[0], x.at(-1), y[0], y.at(-1)])(document.querySelector('.maps')._fullData[0])"
    )
    for sign, border in ((1, edges[3]), (-1, edges[2])):
        page.evaluate("treadloadPut({ along: 'x', at: 0 })")
        drag(page, sign * (abs(border) + 40))
        page.wait_for_function("(y) => document.querySelector('.maps').layout.shapes[0].y0 === y", arg=border)
        line = shape(page)
        assert line["y1"] == border
        assert edges[0] <= line["x0"] < line["x1"] <= edges[1]
        assert page.locator("#placed").inner_text() == line_in_words(page)
        assert np.isfinite(drawn(visit, "profile", "y")[0]).all()
    page.evaluate("treadloadPut({ along: 'y', at: 1e4 })")
    line = shape(page)
    assert (line["x0"], line["x1"]) == (edges[1], edges[1])
    assert edges[2] <= line["y0"] < line["y1"] <= edges[3]
    # A line aslant that was moved as a whole comes back as a whole, and one with an end outside is cut there.
    page.evaluate("treadloadPut({ along: 'x', at: 0 })")
    within_map = "([line, before]) => treadloadWithin(document.querySelector('.maps'), line, before)"
    before = {"x0": -20, "y0": -10, "x1": 20, "y1": 10}
    back = page.evaluate(within_map, [{key: at + 1e3 * key.startswith("y") for key, at in before.items()}, before])
    assert back == pytest.approx({"x0": -20, "x1": 20, "y0": edges[3] - 20, "y1": edges[3]})
    back = page.evaluate(within_map, [{**before, "x1": 1e3}, before])
    assert back == pytest.approx({**before, "x1": edges[1]})
    assert not visit.errors


def drawn(visit, figure, key):
    """What stands in the traces of a figure, None where there is a gap."""
    told = visit.page.evaluate(
        f"document.querySelector('.{figure}').data.map((one) => Array.isArray(one.{key}?.[0])"
        f" ? one.{key}.map((row) => [...row].map((v) => Number.isFinite(v) ? v : null))"
        f" : [...one.{key}].map((v) => Number.isFinite(v) ? v : null))"
    )
    return [np.array(one, dtype=float) for one in told]


@pytest.mark.parametrize("ends", [(-160, 7, 160, 7), (-31, -160, -31, 160), (-90.3, -60.7, 110.1, 75.4)])
def test_what_the_browser_draws_along_a_line_is_what_python_draws(visit, ends):
    """Profiles of the contact and the section of the road, number by number; single floats carry seven digits."""
    page, case = visit.page, changed_case(rolling__normal_load="36 kN")
    visit.done()
    page.wait_for_function("document.querySelector('.section')?.data?.[0]?.z")
    keys = [f"shapes[0].{key}" for key in ("x0", "y0", "x1", "y1")]
    before = title_of(visit, "section")
    page.evaluate(
        "(told) => Plotly.relayout(document.querySelector('.maps'), told)", dict(zip(keys, ends, strict=True))
    )
    page.wait_for_function("(was) => document.querySelector('.section').layout.xaxis.title.text !== was", arg=before)
    load = load_case(case, lambda text: None)
    faces = load.road.interfaces.tolist()
    block = load.solve(block_depths(case.response.slices_to(faces, rigid_base=False), faces, 12))
    x0, y0, x1, y1 = (1e-3 * one for one in ends)
    # What reaches beyond the map is cut off.
    cut = interactive.Cut((x0, y0), (x1, y1)).within(load.contact)
    profile, section = interactive.profiles(load.contact, cut), interactive.depth_slice(block, cut)
    assert title_of(visit, "profile") == profile.layout.xaxis.title.text
    assert title_of(visit, "section") == section.layout.xaxis.title.text
    for key in ("x", "y"):
        for shown_here, one in zip(drawn(visit, "profile", key), profile.data, strict=True):
            np.testing.assert_allclose(shown_here, one[key], rtol=1e-5, atol=1e-3)
    (here,), (at,) = drawn(visit, "section", "z"), drawn(visit, "section", "x")
    np.testing.assert_allclose(at, section.data[0].x, atol=1e-3)
    np.testing.assert_allclose(here, section.data[0].z, rtol=1e-5, atol=1e-4 * np.nanmax(section.data[0].z))


def test_a_click_in_the_verdict_flies_to_the_place(visit):
    page = visit.page
    page.locator('#verdict [data-row="largest_pressure"] button').click()
    page.wait_for_function(
        "(() => { const r = document.querySelector('.maps')._fullLayout.xaxis.range;"
        "return Math.abs(r[1] - r[0]) < 200 })()"
    )
    at = float(python(rolling__normal_load="36 kN")[0].dataset.pressure.max(dim="y").idxmax("x")) * 1e3
    low, high = page.evaluate("document.querySelector('.maps')._fullLayout.xaxis.range")
    assert low < at < high


def test_a_place_beyond_the_map_is_shown_together_with_the_map(visit):
    page = visit.page
    left, right, near, far = page.evaluate(
        "(({x, y}) => [x[0], x.at(-1), y[0], y.at(-1)])(document.querySelector('.maps')._fullData[0])"
    )
    page.evaluate("treadloadFly(1100, -700)")
    page.wait_for_function("document.querySelector('.maps')._fullLayout.xaxis.range[1] > 1100")
    low, high = page.evaluate("document.querySelector('.maps')._fullLayout.xaxis.range")
    bottom, top = page.evaluate("document.querySelector('.maps')._fullLayout.yaxis.range")
    assert low <= left < right < 1100 < high
    # y points to the right of travel: downwards.
    assert top < -700 < near < far <= bottom
    page.evaluate("treadloadWhole()")


def test_garbage_gives_the_sentence_of_the_reader(visit, tmp_path):
    path = tmp_path / "garbage.obj"
    path.write_bytes(b"\x00\xff v no mesh " * 50)
    visit.chosen("mesh …", path)
    told = visit.page.locator("#problems .problem").first
    told.wait_for()
    with pytest.raises(TreadloadError) as same:
        tl.Tire.from_scan(path)
    # The file has its own name, and all other words are the reader's.
    assert told.inner_text() == f"{str(same.value).replace(str(path), path.name)}. The case keeps what it had before."


def test_a_mesh_is_uploaded_and_solved(visit, tmp_path):
    path = tmp_path / "mine.obj"
    write(path, *tire_mesh(around=180, across=60))
    before = visit.solves()
    visit.chosen("mesh …", path)
    visit.ready(before + 1)
    assert visit.page.locator('[data-path="tire.scan"]').input_value() == "mine.obj"
    assert visit.verdict()["normal_load"] == "36.000 kN"
    visit.done()


def test_a_solve_is_cancelled(visit):
    page, before = visit.page, visit.solves()
    visit.set("spacing", "1")
    page.wait_for_selector('#bench[data-state="solving"]')
    start = time.monotonic()
    page.locator("#cancel").click()
    page.wait_for_selector('#bench[data-state="cancelled"]')
    within(time.monotonic() - start, 2.0, "a solve cancelled")
    assert visit.solves() == before
    # What was solved before is still there, and the next case is solved.
    assert page.locator("#runs [role=listitem]").count() >= 2
    visit.set("spacing", "8")
    visit.ready(before + 1)
    assert visit.page.locator("#verdict").inner_text().count("8 x 8 mm") == 1
    visit.done()


def test_two_runs_are_compared_on_one_scale(visit):
    page = visit.page
    cards = page.locator("#runs [role=listitem]")
    cards.nth(0).get_by_role("button", name="take as A").click()
    page.locator("#runs [role=listitem]").nth(1).get_by_role("button", name="take as B").click()
    page.locator("#compare:not([disabled])").click()
    page.wait_for_selector('#bench[data-state="compared"]')
    page.wait_for_function("document.querySelector('.maps').data.filter((t) => t.type === 'heatmap').length === 3")
    ends = page.evaluate(
        "document.querySelector('.maps').data.filter((t) => t.type === 'heatmap').map((t) => [t.zmin, t.zmax])"
    )
    assert ends[0] == ends[1]
    assert ends[2][0] == -ends[2][1]


def test_two_users_do_not_see_each_other(chromium, server, visit):
    """Nor reach what the other has, by any address."""
    mine = visit.page.get_attribute("#bench", "data-run")
    verdict = visit.verdict()
    other = Visit(chromium, server.address())
    try:
        other.ready(1)
        theirs = other.page.get_attribute("#bench", "data-run")
        assert other.verdict()["normal_load"] == "32.500 kN"
        assert other.page.locator("#runs [role=listitem]").count() == 1
        assert visit.verdict() == verdict
        base = other.page.url
        assert visit.context.request.get(f"{base}take/{mine}/csv").status == 200
        for run, kind in (
            (mine, "csv"),
            (mine, "nc"),
            ("../" + mine, "csv"),
            (mine + ".nc", "csv"),
            (theirs, "../nc"),
        ):
            assert other.context.request.get(f"{base}take/{run}/{kind}").status in (403, 404), (run, kind)
        for path in (
            "look/../page.py",
            "look/%2e%2e/page.py",
            "look/..%2fpage.py",
            "take/%2e%2e%2f%2e%2e/nc",
            "docs",
            "openapi.json",
        ):
            assert other.context.request.get(f"{base}{path}").status == 404, path
    finally:
        other.context.close()


def asked(host, path, method="GET", **headers):
    """Status of a request that no browser would make."""
    with closing(http.client.HTTPConnection(host, timeout=60)) as line:
        line.putrequest(method, path, skip_host="Host" in headers)
        for name, value in headers.items():
            line.putheader(name.replace("_", "-"), value)
        line.endheaders()
        return line.getresponse().status


def test_the_server_refuses_whoever_has_no_token(server, visit):
    host = server.host
    cookie = "; ".join(f"{one['name']}={one['value']}" for one in visit.context.cookies())
    socket = {"Upgrade": "websocket", "Connection": "Upgrade", "Sec_WebSocket_Version": "13",
              "Sec_WebSocket_Key": "dGhlIHNhbXBsZSBub25jZQ=="}  # fmt: skip
    wire = "/_nicegui_ws/socket.io/?EIO=4&transport=websocket"
    assert asked(host, "/") == 403
    assert asked(host, "/_nicegui_ws/socket.io/?EIO=4&transport=polling") == 403
    assert asked(host, "/?token=wrong") == 403
    assert asked(host, "/look/bench.js") == 403
    assert asked(host, "/", Cookie=cookie) == 200
    assert asked(host, "/", Cookie=cookie, Host="evil.example") == 421
    assert asked(host, "/", Cookie=cookie, Origin="http://evil.example") == 403
    assert asked(host, wire, **socket, Origin=f"http://{host}") == 403
    assert asked(host, wire, **socket, Cookie=cookie, Origin="http://evil.example") == 403
    assert asked(host, wire, **socket, Cookie=cookie) == 403
    assert asked(host, wire, **socket, Cookie=cookie, Origin=f"http://{host}") == 101
    large = {"Content_Length": str(10**9), "Origin": f"http://{host}", "Cookie": cookie}
    assert asked(host, "/_nicegui/client/x/upload/1", "POST", **large) == 413


NAMELESS = """() => [...document.querySelectorAll('input, button, a, [role=slider], [role=combobox], img')]
  .filter((one) => one.offsetParent && !one.closest('[aria-hidden=true], .js-plotly-plot') && one.type !== 'file')
  .filter((one) => !(one.ariaLabel || one.labels?.length || one.innerText?.trim() || one.alt || one.closest('label')))
  .map((one) => one.outerHTML.slice(0, 160))"""
PALE = """() => { const light = (c) => { const v = c.match(/[0-9.]+/g).slice(0, 3).map((x) => { x /= 255;
    return x <= 0.03928 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4 });
    return 0.2126*v[0] + 0.7152*v[1] + 0.0722*v[2] };
  const under = (e) => { for (; e; e = e.parentElement) { const c = getComputedStyle(e).backgroundColor;
    if (!/, 0\\)$|transparent/.test(c)) return c } return 'rgb(255, 255, 255)' };
  const bad = [];
  for (const e of document.querySelectorAll('h1, h2, label, button, a, td, .note, .warning, .stage, input')) {
    if (!e.offsetParent || e.disabled || e.closest('.js-plotly-plot, .q-uploader')) continue;
    const a = light(getComputedStyle(e).color), b = light(under(e));
    const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    if (ratio < 4.5) bad.push([ratio, e.outerHTML.slice(0, 120)]) } return bad }"""


@pytest.mark.parametrize("dark", [False, True])
def test_everything_has_a_name_and_can_be_read(visit, dark):
    """The main rules of accessibility: names of controls, contrast 4.5, one heading, the way of the tabulator."""
    page = visit.page
    in_theme(page, dark)
    assert page.evaluate(NAMELESS) == []
    assert page.evaluate(PALE) == []
    assert page.locator("h1").count() == page.locator("main").count() == 1
    page.locator("#theme").focus()
    reached = set()
    for _ in range(80):
        page.keyboard.press("Tab")
        reached.add(page.evaluate("document.activeElement.closest('section')?.ariaLabel ?? ''"))
    assert {"the case", "maps and slices"} <= reached


@pytest.fixture(scope="module")
def life(visit):
    """The page of a life, in another tab of the same browser."""
    one = visit.tab("life")
    one.page.wait_for_selector('#bench[data-state="idle"]')
    return one


def test_a_life_is_what_python_gives(life, tmp_path):
    """From a case of one's own: years by criterion, who does it, when, what it depends on, and home with it."""
    page = life.page
    form = Form.first("life").with_values({"climate": {"temperature": 15}, "spacing": "16 mm", "reliability": None})
    path = tmp_path / "mine.toml"
    path.write_text(form.to_toml(), encoding="utf-8")
    life.chosen("open a TOML …", path)
    number = life.ready(1)
    result = tl.run(Case.from_toml(path), leave_out=("sensitivity",))
    told = life.verdict()
    assert told["governing"] == result.life.governing
    summary = result.summary()
    names = [one.name for one in result.life.criteria]
    assert len(names) == 3
    for name in names:
        assert told[f"life_years:{name}"] in summary
    assert {"by_class", "by_season", "elasticity"} <= {key.partition(":")[0] for key in told}
    drawn = page.locator("#pictures img")
    assert {drawn.nth(k).get_attribute("data-picture") for k in range(drawn.count())} >= {
        "life.years",
        "sensitivity.inputs",
        "life.shares",
    }
    assert page.evaluate("[...document.querySelectorAll('#pictures img')].every((one) => one.naturalWidth > 100)")
    # Who does it, and when, by another criterion than the first to fail.
    other = next(name for name in names if name != result.life.governing_criterion)
    page.locator(f'#verdict [data-row="life_years:{other}"] button').click()
    page.wait_for_selector(f'#bench[data-criterion="{other}"]')
    base = re.match("http://[^/]+/", page.url)[0]
    for kind in ("nc", "csv"):
        assert life.context.request.get(f"{base}take/{number}/{kind}", timeout=PATIENCE).status == 200


def test_a_life_is_cancelled_and_the_bench_is_left_alone(life, visit):
    page, before = life.page, visit.verdict()
    runs = page.locator("#runs [role=listitem]").count()
    life.set("spacing", "1.5")
    page.wait_for_selector('#bench[data-state="solving"]')
    page.locator("#cancel").click()
    page.wait_for_selector('#bench[data-state="cancelled"]')
    assert page.locator("#runs [role=listitem]").count() == runs
    assert life.solves() == 1
    assert visit.verdict() == before


def test_a_wrong_number_of_a_life_is_told_at_its_field(life):
    life.set("traffic.classes.0.axle_load", "3 mm")
    told = life.page.locator(".q-field--error [role=alert]").first
    told.wait_for()
    assert "3 mm" in told.inner_text()
    life.set("traffic.classes.0.axle_load", "70")


@pytest.fixture(scope="module")
def study(visit, tmp_path_factory):
    """The page of a study, in another tab of the same browser, with a study of six cases opened."""
    form = Form.first().with_values({"spacing": "16 mm", "damage": None})
    varied = {"rolling.friction": [0.5, 0.6, 0.8], "rolling.normal_load": [20e3, 30e3]}
    made = sweep(Case.from_dict(dict(form.table)), varied, fields=("pressure",))
    path = tmp_path_factory.mktemp("study") / "mine.nc"
    save_results(made, path)
    one = visit.tab("study")
    one.made = made
    one.page.wait_for_selector('#bench[data-state="idle"]')
    one.chosen("open a study …", path)
    one.page.wait_for_selector('body[data-curve="1"][data-field="1"]')
    return one


def test_a_study_opens_as_sliders_over_its_dimensions(study):
    """Moved from the keyboard: what is told and drawn is the dataset at that point."""
    page, data = study.page, study.made.dataset
    assert page.locator("#sliders [data-dim]").count() == 2
    page.locator('[data-dim="rolling.normal_load"] [tabindex="0"]').focus()
    moves = []
    # There, back and there again: what other pages of the suite still do is in one move, seldom in all.
    for number, key in enumerate(("ArrowRight", "ArrowLeft", "ArrowRight"), start=2):
        start = time.monotonic()
        page.keyboard.press(key)
        page.wait_for_selector(f'body[data-curve="{number}"][data-field="{number}"]')
        moves.append(time.monotonic() - start)
    within(min(moves), 0.2, "a move of a slider of a study")
    here = {"rolling.friction": 0, "rolling.normal_load": 1}
    assert page.locator('[data-at="rolling.normal_load"]').inner_text() == "30 kN"
    told = study.verdict()
    assert told["at:rolling.normal_load"] == "30 kN"
    largest = float(data["largest_pressure"].isel(here))
    assert told["solved:largest_pressure"] == shown(data["largest_pressure"], "largest_pressure").number(largest)
    mark = page.evaluate("document.querySelector('.curve').data[1].y[0]")
    assert mark == pytest.approx(float(told["solved:largest_pressure"].split()[0]), rel=1e-3)
    taken = page.evaluate("document.querySelector('[data-take=csv]').href")
    assert study.context.request.get(taken, timeout=PATIENCE).status == 200


def test_a_file_that_is_no_study_is_refused_with_a_sentence(study, tmp_path):
    path = tmp_path / "garbage.nc"
    path.write_bytes(b"no file of results")
    study.chosen("open a study …", path)
    study.page.locator("#problems .problem").first.wait_for()
    assert study.page.locator("#sliders [data-dim]").count() == 2


@pytest.mark.parametrize("dark", [False, True], ids=["light", "dark"])
@pytest.mark.parametrize("which", ["visit", "life", "study"])
def test_axe_finds_no_serious_fault(which, dark, request):
    assert axe_faults(request.getfixturevalue(which), dark) == []


def test_nothing_went_wrong_in_the_browser(visit, life, study):
    assert not visit.errors
    assert not life.errors
    assert not study.errors
