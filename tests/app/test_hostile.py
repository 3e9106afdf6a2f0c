"""A stranger's file in a real Chromium: whatever stands in its texts is shown, and nothing of it runs or loads."""

import os
import re
import stat
import subprocess
import sys
import time
from pathlib import Path

import h5py
import pytest
import tomli_w
import xarray as xr

from page_visits import PATIENCE, Visit, serving
from treadload.app.form import Form
from treadload.case import Case
from treadload.results import save_results
from treadload.steps import run
from treadload.sweeps import sweep

pytestmark = pytest.mark.browser

RUNS = "window.pwned=1"
# Ways out of a string of props, an attribute, a text, a script, a template, a link.
PAYLOADS = {
    "props": f'a" :data-evil="{RUNS}" data-evil="',
    "single": f"a' :data-evil='{RUNS}' data-evil='",
    "bare": f"a :data-evil={RUNS} onmouseover={RUNS}",
    "backslash": f'a\\" :data-evil="{RUNS}" data-evil=\\"',
    "image": f'<img data-evil src=x onerror="{RUNS}">',
    "script": f"</script><script data-evil>{RUNS}</script>",
    "literal": f"`);{RUNS};//${{{RUNS}}}&#96;",
    "template": f"{{{{constructor.constructor('{RUNS}')()}}}}",
    "link": f'<a data-evil href="javascript:{RUNS}">a</a><a data-evil href="http://evil.example/">b</a>',
    "style": "<style data-evil>*{display:none}</style><b onclick=x data-evil>",
    "math": "$\\frac{$ %{customdata} \\x \u202e",
}
FOUND = """() => ({
  ran: window.pwned ?? null,
  made: [...document.querySelectorAll('[data-evil], [onclick], [onerror], [onmouseover]')].map((e) => e.outerHTML),
  links: [...document.querySelectorAll('a')].map((one) => one.getAttribute('href') ?? one.getAttribute('xlink:href'))
    .filter((one) => one && !/^\\.\\/(life|study|network|basins|take\\/\\w+\\/\\w+)?$/.test(one)),
  hidden: getComputedStyle(document.querySelector('#bench')).display === 'none',
})"""


def unharmed(one):
    """Nothing ran, nothing was made of a text, nothing was asked of others, nothing had to be refused."""
    page = one.page
    # Whatever is seen only on demand: tooltips, lists, programs.
    for place in page.locator("#verdict td").all()[:40:6]:
        place.hover(timeout=PATIENCE, force=True)
    page.wait_for_timeout(100)
    found = page.evaluate(FOUND)
    assert found == {"ran": None, "made": [], "links": [], "hidden": False}
    assert one.errors == []
    assert [url for url in one.asked if not re.match(r"(http|ws)://127\.0\.0\.1:|data:|blob:|file:", url)] == []


def coarse(**more):
    return {**Form.first().table, "spacing": "16 mm", **more}


def layers(text):
    made = [dict(one) for one in Form.first().table["pavement"]["layers"]]
    for number, layer in enumerate(made):
        layer["name"] = f"{text} {number}"
    return {"layers": made}


def given(one, button, name, text):
    one.chosen(button, {"name": name, "mimeType": "text/plain", "buffer": text.encode()})


@pytest.mark.parametrize("kind", PAYLOADS)
def test_texts_of_a_case_are_texts(visit, kind):
    """Its title and the names of its layers, on cards, at fields, in the verdict, in a program, in figures."""
    text, page = PAYLOADS[kind], visit.page
    before = visit.solves()
    given(visit, "open a TOML …", "case.toml", tomli_w.dumps(coarse(title=text, pavement=layers(text))))
    visit.ready(before + 1)
    visit.done()
    assert page.get_by_text(f"1  {text} 0", exact=True).count() == 1
    page.get_by_role("button", name="copy as Python").click()
    page.get_by_role("button", name="Close").click()
    # A dialog holds the page where it is until it has gone; before, nothing can be scrolled into view.
    page.wait_for_selector(".q-dialog", state="detached")
    page.wait_for_selector("body:not(.q-body--prevent-scroll)")
    unharmed(visit)


@pytest.mark.parametrize("kind", ["props", "image", "literal", "link"])
def test_what_is_wrong_with_a_strangers_file_is_a_text(visit, kind):
    """Names of mixes, belts and keys in errors and in lists of choices; names of files; headers of footprints."""
    text, page = PAYLOADS[kind], visit.page
    refused(visit, "open a TOML …", text.replace("/", "") + ".toml", "tire = [")
    wrong = layers("plain")
    wrong["layers"][0] = {"thickness": "60 mm", "mix": text, "bond": text}
    table = coarse(pavement=wrong, tire={"profile": text, "belt": text})
    given(visit, "open a TOML …", "case.toml", tomli_w.dumps({**table, text: {text: 1}}))
    page.locator(".q-field--error").first.wait_for()
    unharmed(visit)
    anew(visit)
    goes = {"mesh …": ".obj", "height map …": ".csv", "footprint …": ".csv", "open a result …": ".nc"}
    for button, suffix in goes.items():
        refused(visit, button, text.replace("/", "") + suffix, f"{text}\n{text},{text}\n")
    anew(visit)


def anew(one):
    """The first case again, solved."""
    before = one.solves()
    one.page.get_by_role("button", name="start again").click()
    one.ready(before + 1)
    one.done()


def refused(one, button, name, text):
    """Give a file that is refused, and wait for the sentence."""
    # Above all fields, or at the field that the sentence names.
    places = "'#problems .problem, .q-field--error .q-field__messages'"
    said = f"[...document.querySelectorAll({places})].map((place) => place.innerText).join()"
    before = one.page.evaluate(said)
    given(one, button, name, text)
    one.page.wait_for_function(f"(was) => {said} && {said} !== was", arg=before)
    unharmed(one)


def test_a_strangers_result_is_drawn_and_nothing_else(visit, tmp_path):
    """A file of results, all of whose texts may be anything: those that are shown are shown as they are."""
    text, page = "".join(PAYLOADS[kind] for kind in ("props", "image", "link")), visit.page
    path = tmp_path / "result.nc"
    save_results(run(Case.from_dict(coarse(title=text, pavement=layers(text)))).to_tree(), path)
    changed = 0
    with h5py.File(path, "r+") as file:
        for group in (file, *(one for one in file.values() if isinstance(one, h5py.Group))):
            for name in ("reading", "strain", "verdict", "warnings", "title", "summary", "line", "side"):
                if name in group.attrs and isinstance(group.attrs[name], str):
                    group.attrs[name] = text
                    changed += 1
    assert changed
    cards = page.locator("#runs [role=listitem]").count()
    problems = page.locator("#problems .problem")
    visit.chosen("open a result …", {"name": "a<img data-evil>.nc", "mimeType": "x/x", "buffer": path.read_bytes()})
    page.wait_for_function(
        "(was) => document.querySelectorAll('#runs [role=listitem]').length > was"
        " || document.querySelector('#problems .problem')", arg=cards,
    )  # fmt: skip
    unharmed(visit)
    assert problems.count() or page.get_by_text("a<img data-evil>.nc").count()


def test_names_of_a_strangers_life_are_texts(visit):
    """Classes of axles, seasons, criteria, layers: at fields, in rows, in figures and their lists."""
    one = visit.tab("life")
    page = one.page
    page.wait_for_selector('#bench[data-state="idle"]')
    for kind in ("props", "image", "math"):
        text = PAYLOADS[kind]
        form = Form.first("life").with_values({"spacing": "16 mm", "reliability": None})
        table = dict(form.table)
        table["title"] = text
        table["traffic"]["classes"] = [
            {**row, "name": f"{text}{k}"} for k, row in enumerate(table["traffic"]["classes"][:1])
        ]
        table["traffic"]["classes"][0]["share"] = 1.0
        table["climate"] = {"seasons": [{"name": text, "share": 1.0, "temperature": 15}]}
        table["criteria"] = [{**row, "name": f"{text}{k}"} for k, row in enumerate(table["criteria"][:2])]
        before = one.solves()
        given(one, "open a TOML …", "life.toml", tomli_w.dumps(table))
        one.ready(before + 1)
        page.wait_for_selector("#pictures img")
        assert page.locator("#verdict").get_by_text(f"{text}0").count()
        unharmed(one)
    page.close()


def test_names_of_a_strangers_study_are_texts(visit, tmp_path):
    """Its inputs, results, units and reasons of failures: on sliders, in lists, in titles of figures."""
    varied = {"rolling.friction": [0.2, 0.6], "rolling.normal_load": [20e3, 30e3]}
    table = {key: value for key, value in coarse().items() if key != "damage"}
    made = sweep(Case.from_dict(table), varied, fields=("pressure",))
    path, text = tmp_path / "study.nc", f"{PAYLOADS['image']}{PAYLOADS['link']}"
    save_results(made, path)
    with xr.open_datatree(path, engine="h5netcdf") as tree:
        groups = {name: node.to_dataset().load() for name, node in tree.subtree_with_keys}
    name = text.replace("/", "")
    renamed = {}
    for group, data in groups.items():
        for field in data.variables.values():
            for key in ("units", "long_name"):
                if key in field.attrs:
                    field.attrs[key] = text
        known = {old: new for old, new in (("rolling.friction", name), ("largest_pressure", f"largest {name}"))
                 if old in data.variables}  # fmt: skip
        renamed[group] = data.rename(known)
    xr.DataTree.from_dict(renamed).to_netcdf(path, engine="h5netcdf")
    one = visit.tab("study")
    page = one.page
    page.wait_for_selector('#bench[data-state="idle"]')
    one.chosen("open a study …", path)
    page.wait_for_function("document.querySelector('#problems .problem') || document.body.dataset.curve")
    page.wait_for_timeout(1500)
    unharmed(one)
    for choice in page.locator("[data-choice]").all():
        choice.click()
        page.keyboard.press("ArrowDown")
        page.keyboard.press("Enter")
        page.wait_for_timeout(300)
    unharmed(one)
    page.close()


def test_what_a_case_asks_for_besides_is_named_beside_its_result(visit):
    page, before = visit.page, visit.solves()
    damage = {**Form.first().table["damage"], "error_estimate": True}
    # The error is estimated on cells twice as large.
    asks = coarse(damage=damage, spacing="8 mm", crossing={"step": {"rise": "10 mm"}})
    given(visit, "open a TOML …", "case.toml", tomli_w.dumps(asks))
    visit.ready(before + 1)
    said = page.locator("#unsolved").inner_text()
    assert "did not solve [crossing]" in said
    assert "treadload run case.toml" in said
    page.get_by_role("button", name="start again").click()
    visit.ready(before + 2)
    assert page.locator("#unsolved").count() == 0
    visit.done()


def test_a_process_that_ended_is_forgotten_with_the_next_solve(visit, server):
    """Its sentence goes when the next case is solved."""
    page, before = visit.page, visit.solves()
    visit.set("spacing", "1")
    page.wait_for_selector('#bench[data-state="solving"]')
    children = subprocess.run(["pgrep", "-P", str(server.process.pid)], capture_output=True, text=True, check=True)
    time.sleep(0.5)
    for pid in children.stdout.split():
        os.kill(int(pid), 9)
    page.get_by_text("the process that solves has ended").wait_for()
    visit.set("spacing", "16")
    visit.ready(before + 1)
    assert page.locator("#problems .problem").count() == 0
    visit.done()


def test_the_browser_is_let_in_without_a_token_among_arguments(chromium, tmp_path):
    """By a private file that sends it on, once; and by a new address on request, once."""
    told = tmp_path / "told"
    opener = tmp_path / "open"
    opener.write_text(f'#!/bin/sh\necho "$@" > {told}\n')
    opener.chmod(opener.stat().st_mode | stat.S_IXUSR)
    (tmp_path / "server").mkdir()
    os.environ["BROWSER"] = f"{opener} %s"
    try:
        with serving(tmp_path / "server", "--open") as server:
            for _ in range(100):
                if told.exists() and told.read_text().strip():
                    break
                time.sleep(0.1)
            argument = told.read_text().strip()
            assert re.fullmatch(r"file://\S+/open\.html", argument)
            file = Path(argument.removeprefix("file://"))
            assert stat.S_IMODE(file.stat().st_mode) == 0o600
            assert stat.S_IMODE(file.parent.stat().st_mode) == 0o700
            listed = subprocess.run(["ps", "-eo", "args"], capture_output=True, text=True, check=True).stdout
            assert "token=" not in listed
            one = Visit(chromium, argument)
            one.ready(1)
            assert one.page.url == server.base
            assert not file.exists()
            # The address that was printed is another; a second browser comes by it, and a third does not.
            other = chromium.new_context().new_page()
            assert other.goto(server.printed).status == 200
            other.wait_for_selector("#bench")
            late = chromium.new_context().new_page()
            assert late.goto(server.printed).status == 403
            assert "--new-link" in late.inner_text("body")
            env = {**os.environ, "TMPDIR": str(tmp_path / "server")}
            asked = [sys.executable, "-m", "treadload", "app", "--new-link"]
            made = subprocess.run(asked, capture_output=True, text=True, env=env, check=True).stdout
            assert late.goto(made.split()[-1]).status == 200
            late.wait_for_selector("#bench")
            assert late.url == server.base
            for page in (one.page, other, late):
                page.context.close()
    finally:
        del os.environ["BROWSER"]
