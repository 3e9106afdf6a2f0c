"""A life in the process of a browser: part by part, in the digits of its summary, and not a solve too many."""

import base64
import json

import pytest

from treadload.app.engine import Engine
from treadload.app.form import Form
from treadload.app.result_rows import rows_of
from treadload.case import Case
from treadload.results import open_results
from treadload.steps import run
from treadload.units import years_in_words

pytestmark = pytest.mark.slow


def quick():
    """Tables of a life that takes a second or two."""
    form = Form.first("life").with_values({"climate": {"temperature": 15}})
    return dict(form.with_values({"spacing": "16 mm", "reliability": None}).table)


@pytest.fixture(scope="module")
def solved(tmp_path_factory):
    """An engine that has solved a life as run "a", and what it said."""
    said = []
    engine = Engine(lambda line: said.append(json.loads(line)))
    engine.answer({"id": 1, "do": "folder", "folder": str(tmp_path_factory.mktemp("life"))})
    engine.answer({"id": 2, "do": "life", "run": "a", "table": quick(), "theme": "light"})
    engine._solving.join()
    return engine, said


def test_parts_are_shown_as_they_come_in_the_digits_of_the_summary(solved):
    _, said = solved
    parts = [one for one in said if "part" in one]
    assert [one["part"] for one in parts] == ["life", "sensitivity", "equivalents"]
    assert any("of" in one.get("stage", "") for one in said)
    assert said[-1]["done"]
    result = run(Case.from_dict(quick()))
    summary = result.summary()
    told = {row["key"]: row["value"] for row in parts[-1]["rows"]}
    assert told["governing"] == result.life.governing
    for name in parts[0]["criteria"]:
        assert told[f"life_years:{name}"] == years_in_words(result.life.years(name))
        assert told[f"life_years:{name}"] in summary
    by_class = [float(value.split()[0]) for key, value in told.items() if key.startswith("by_class:")]
    # Of three classes, each rounded to one per cent, those below half a per cent left out.
    assert sum(by_class) == pytest.approx(100, abs=2.5)
    assert told["solved"].startswith(f"{result.life.stats['contacts']} contacts")
    assert any(row["heading"] == "Sensitivity" for row in parts[-1]["rows"])
    for name, picture in parts[0]["pictures"].items():
        head, _, body = picture["url"].partition(",")
        assert head == "data:image/svg+xml;base64", name
        assert b"<svg" in base64.b64decode(body)[:2000]


def test_the_road_below_a_run_of_a_process_that_gave_way_is_solved_on_request(tmp_path):
    """Another process knows a run by its file, which has no block of road below the maps."""
    said = []

    def process():
        engine = Engine(lambda line: said.append(json.loads(line)))
        engine.answer({"id": 1, "do": "folder", "folder": str(tmp_path)})
        return engine

    def figures(engine):
        engine.answer({"id": 3, "do": "cut", "run": "a", "theme": "light", "line": [-0.05, 0.0, 0.05, 0.0]})
        return said[-1]["figures"], said[-1]["lacks_section"]

    first = process()
    table = dict(Form.first().with_values({"spacing": "16 mm"}).table)
    first.answer({"id": 2, "do": "run", "run": "a", "table": table, "theme": "light", "view": {}})
    first._solving.join()
    before, lacks = figures(first)
    assert not lacks
    second = process()
    without, lacks = figures(second)
    assert "section" not in without
    assert lacks
    second.answer({"id": 4, "do": "section", "run": "a"})
    assert said[-1]["done"]
    after, lacks = figures(second)
    assert not lacks
    assert after["section"] == before["section"]


def test_who_does_it_is_told_for_the_chosen_criterion(solved):
    engine, said = solved
    said.clear()
    names = [row["name"] for row in quick()["criteria"]]
    for name in names:
        engine.answer({"id": 3, "do": "shares", "run": "a", "criterion": name})
    assert len({one["pictures"]["life.shares"]["url"] for one in said}) == len(names)
    for one, name in zip(said, names, strict=True):
        assert {row["note"] for row in one["rows"] if row["heading"] == "Damage by axle class"} == {f"of {name}"}


@pytest.mark.parametrize("kind", ["nc", "csv"])
def test_a_life_is_taken_home_also_after_the_process_was_ended(solved, kind):
    engine, said = solved
    other = Engine(lambda line: said.append(json.loads(line)))
    other.answer({"id": 1, "do": "folder", "folder": str(engine.runs.folder)})
    said.clear()
    other.answer({"id": 4, "do": "export", "run": "a", "kind": kind})
    file = engine.runs.folder / said[-1]["file"]
    assert file.stat().st_size > 500
    if kind == "nc":
        held = open_results(file)
        assert set(held.parts) == {"life", "sensitivity", "equivalents"}
        assert isinstance(held.case, Case)
    other.answer({"id": 5, "do": "pictures", "run": "a"})
    assert set(said[-1]["pictures"]) >= {"life.years", "life.shares", "sensitivity.inputs"}


def test_a_life_without_an_end_says_never(solved):
    assert years_in_words(float("inf")) == "never"
    assert rows_of({}) == []


def test_a_life_is_stopped_between_two_solves(solved, tmp_path):
    said = []
    engine = Engine(lambda line: said.append(json.loads(line)))
    engine.answer({"id": 1, "do": "folder", "folder": str(tmp_path)})
    engine._stop.set()
    engine.answer({"id": 2, "do": "life", "run": "b", "table": dict(Form.first("life").table), "theme": "light"})
    engine.answer({"id": 0, "do": "stop"})
    engine._solving.join()
    assert said[-1].get("stopped")
    assert not any("ready" in one for one in said)
    assert not list(tmp_path.glob("b*"))
