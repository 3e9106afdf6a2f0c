"""The book: every public name once, doctests that hold, links that lead somewhere."""

import doctest
import importlib
import re
from pathlib import Path
from types import ModuleType

import pytest

import treadload as tl

CLONE = Path(__file__).parents[2]
DOCS = CLONE / "docs"
REFERENCE = sorted((DOCS / "reference").glob("*.md"))
PAGES = [CLONE / "README.md", CLONE / "CONTRIBUTING.md", CLONE / "CHANGELOG.md", *sorted(DOCS.rglob("*.md"))]
ROOMS = [name for name in tl.__all__ if isinstance(getattr(tl, name), ModuleType)]


@pytest.fixture
def house_reference(monkeypatch):
    pytest.importorskip("sphinx")
    monkeypatch.syspath_prepend(str(DOCS / "_ext"))
    return importlib.import_module("house_reference")


def test_the_reference_documents_every_public_name_once(house_reference):
    named = house_reference.listed(DOCS / "reference")
    assert len(named) > 250
    every = named + house_reference.unlisted(DOCS / "reference")
    things = [getattr(importlib.import_module(place), name) for place, name in every]
    seen = {id(thing) for thing in things}
    for room in (tl, *(getattr(tl, name) for name in ROOMS)):
        for name in room.__all__:
            thing = getattr(room, name)
            assert id(thing) in seen or isinstance(thing, ModuleType) or name.startswith("_"), name
    # What two rooms offer is told once; equal numbers are one object.
    told = [id(thing) for thing in things if not isinstance(thing, int | float | str)]
    assert len(told) == len(set(told))
    assert "{unlisted}" in (DOCS / "reference" / "more.md").read_text("utf-8")


def test_docstrings_of_the_house_become_fields(house_reference):
    text, made = house_reference.fields("depth: m, >= 0. x, y: places, m. Returns the figure.", ["depth", "x", "y"])
    assert text == "Returns the figure."
    assert made == [":param depth: m, >= 0.", ":param x / y: places, m."]
    assert house_reference.safe("|q| <= `mu` p_ *x*") == r"\|q\| <= :py:obj:`mu` p\_ \*x\*"


@pytest.mark.parametrize(
    "page", [page for page in REFERENCE if ">>>" in page.read_text("utf-8")], ids=lambda p: p.stem
)
def test_the_examples_of_the_reference_hold(page):
    text = "\n".join(re.findall(r"```pycon\n(.*?)```", page.read_text("utf-8"), re.DOTALL))
    test = doctest.DocTestParser().get_doctest(text, {}, page.stem, str(page), 0)
    assert test.examples
    said = []
    doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE).run(test, out=said.append)
    assert not said, "".join(said)


def headings(page):
    """Anchors of a page, as GitHub and MyST make them."""
    text = re.sub(r"```.*?```", "", page.read_text("utf-8"), flags=re.DOTALL)
    titles = re.findall(r"^#+ (.+)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(CLONE)))
def test_links_lead_somewhere(page):
    text = re.sub(r"```.*?```", "", page.read_text("utf-8"), flags=re.DOTALL)
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        if re.match(r"[a-z]+:", target):
            continue
        name, _, anchor = target.partition("#")
        there = page if not name else (page.parent / name).resolve()
        assert there.exists(), f"{page.name}: {target}"
        assert not anchor or anchor in headings(there), f"{page.name}: no heading for #{anchor} in {there.name}"


def test_every_page_of_the_book_is_in_it():
    for folder in ("tutorials", "reference", "coming_from"):
        text = (DOCS / folder / "index.md").read_text("utf-8")
        pages = {page.stem for page in (DOCS / folder).glob("*.md")} - {"index"}
        assert pages <= set(re.findall(r"^[\w-]+$", text, re.MULTILINE)), folder
    for folder in ("howto", "explanation"):
        assert "```{rest}" in (DOCS / folder / "index.md").read_text("utf-8")


def test_what_a_page_asks_of_another_host_is_found(tmp_path, monkeypatch):
    pytest.importorskip("sphinx")
    monkeypatch.syspath_prepend(str(DOCS / "_ext"))
    from house_offline import foreign

    (tmp_path / "a.html").write_text(
        '<a href="https://a.org">far</a><img src="b.png"><link rel="canonical" href="https://a.org">'
    )
    (tmp_path / "a.css").write_text("a { background: url(b.png) }")
    assert foreign(tmp_path) == []
    (tmp_path / "b.html").write_text(
        '<script async src="https://c.org/x.js"></script><link rel="s" href="//d.org/x.css">'
    )
    (tmp_path / "b.css").write_text("@import 'https://e.org/x.css'; a { src: url('//f.org/x.woff') }")
    assert len(foreign(tmp_path)) == 4


def test_the_page_of_validation_has_the_groups_that_are_measured():
    page = (DOCS / "explanation" / "validation.md").read_text("utf-8")
    rows = [line.split(" | ") for line in page.splitlines() if line.startswith("| ")][1:]
    assert len(rows) > 280
    assert {row[6] for row in rows} == {"yes"}
    assert f"{len(rows)} of {len(rows)} checks passed" in page
