"""The page's card, the report and the summary give one answer: the same label, number and words."""

import html
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from test_open_results import life

import treadload as tl
from treadload.app.verdict_card import card_of
from treadload.case import Case
from treadload.damage.answer import life_answer
from treadload.reporting import report
from treadload.reporting.typesetting import typeset_text, with_powers
from treadload.steps.allowed import Allowed, PassesAllowed
from treadload.templates import first_case
from treadload.units import COUNTLESS, LASTS, repetitions_in_words, years_in_words
from treadload.us_units import display_units

EXAMPLES = Path(__file__).parents[2] / "examples"
SLOW = ("sensitivity", "reliability", "equivalents", "slices")


@pytest.fixture(autouse=True)
def unprinted(monkeypatch):
    """Figures are drawn and not turned into pixels, which takes seconds."""
    monkeypatch.setattr("treadload.reporting.pictures.raster", lambda figure, dpi: Image.new("RGB", (1, 1), "white"))


def first_of(page):
    """Headline, facts and further criteria of the first answer of a report."""
    article = re.search(r'<article class="card.*?</article>', page, re.DOTALL)[0]
    headline, further = (re.search(rf'<p class="{name}">(.*?)</p>', article) for name in ("headline", "quiet"))
    facts = {term: html.unescape(text) for term, text in re.findall(r"<dt>(.*?)</dt><dd>(.*?)</dd>", article)}
    return html.unescape(headline[1]), facts, html.unescape(further[1]) if further else ""


def check(result, parts, number, path):
    """All three give the same answer. number: that the headline must state, in words; empty where nothing governs."""
    card = card_of(parts)
    headline, facts, further = first_of(report(result, path).read_text("utf-8"))
    assert card["headline"] == headline
    assert headline.startswith(("Service life: ", "Allowable load repetitions: ", "Does not govern: "))
    assert number in headline
    for term, text in card["facts"]:
        assert facts[term] == text, term
    assert {"Place", "Why"} <= set(facts)
    assert card["further"] == further
    sentence = typeset_text(result.summary())
    whole = [headline, *(f"{term}: {text}" for term, text in card["facts"]), *filter(None, [further])]
    assert f"{'. '.join(whole)}." in sentence
    return sentence, headline


def number_of(parts):
    """The number that the headline of these results must state."""
    if "life" in parts:
        years = parts["life"].years(parts["life"].governing)
        return years_in_words(years)
    passes = float(parts["damage"].dataset["worst_passes"])
    return with_powers(repetitions_in_words(passes)) if passes < COUNTLESS else "more than 10¹⁰"


def test_a_wheel_on_a_road(coarse_result, tmp_path):
    parts = dict(coarse_result.parts)
    sentence, headline = check(coarse_result, parts, number_of(parts), tmp_path / "r.html")
    # The first line that the command line prints.
    criterion = re.search("(Governing c|C)riterion: (.*?)\\. Place", sentence)[2]
    assert sentence.partition("\n")[0] == f"{headline} ({criterion})"
    # A file that is opened again.
    opened = tl.open_results(tl.save_results(coarse_result, tmp_path / "r.nc"))
    check(opened, {name: opened[name] for name in opened}, number_of(parts), tmp_path / "r.html")
    with display_units("us"):
        check(coarse_result, parts, number_of(parts), tmp_path / "us.html")
        assert re.search(r"y = \S+ in$", dict(card_of(parts)["facts"])["Place"])


def test_a_law_that_allows_fewer(coarse_result, tmp_path):
    verdict = tl.assess(coarse_result.response, tl.FatigueLine(12e-6, -0.2), depth=0.02)
    parts = {"damage": verdict}
    passes = float(verdict.dataset["worst_passes"])
    assert passes < COUNTLESS
    _, headline = check(verdict, parts, number_of(parts), tmp_path / "r.html")
    assert headline == f"Allowable load repetitions: {with_powers(f'{passes:.3g}')}"


def test_a_life_and_one_that_outlasts_all_roads(tmp_path):
    result = life()
    years = result.years(result.governing)
    assert years < LASTS
    _, headline = check(result, {"life": result}, f"{years:.3g} years", tmp_path / "r.html")
    assert headline.startswith("Service life: ")
    data = result.dataset.copy()
    for name in ("life_years", "life_passes"):
        data[name] = data[name] * 1e9
    lasting = replace(result, dataset=data)
    _, headline = check(lasting, {"life": lasting}, "more than 100 years", tmp_path / "r.html")
    assert headline == "Does not govern: service life of more than 100 years"


def test_place_and_design_life_of_a_life():
    """Of the governing criterion of the sum: the top of the first layer, 0 mm off the middle, 20 years of design."""
    result = life()
    facts = dict(result.answer.facts)
    years = result.years(result.governing)
    at = result.dataset.sel(criterion=result.governing)
    assert facts["Governing criterion"] == result.governing
    assert facts["Place"].endswith(f"y = {1e3 * float(at['worst_y']):.0f} mm")
    short = f"20 years, not reached: {20 - years:.3g} years too short"
    assert facts["Design life"] == (short if years < 20 else f"20 years, reached with a damage of "
                                    f"{float(at['design_damage']):.2g}")  # fmt: skip
    assert result.answer.state == ("short" if years < 20 else "meets")


def test_a_rut_that_governs():
    result = life()
    data = result.dataset.copy()
    data["rut_depth"] = (("rut_layer", "year"), np.array([[0.004, 0.012]]))
    data = data.assign_coords(year=[1.0, 5.0]).assign_attrs(rut_names='["asphalt"]', rut_limit=0.01, rut_years=0.5)
    rutted = replace(result, dataset=data)
    answer = life_answer(data, rutted.rows())
    assert rutted.governing == "rut"
    assert answer.headline == "Service life: 0.5 years"
    assert dict(answer.facts)["Why"].startswith("rut of 10 mm reached after 0.5 years")


def test_the_criteria_of_layers_take_the_answer_of_the_law_where_it_governs(coarse_result):
    verdict = coarse_result.verdict
    worst, passes = (float(verdict.dataset[f"worst_{name}"]) for name in ("strain", "passes"))
    own = Allowed("fatigue line", "asphalt", "", 0.0, verdict.line, worst, 0.0, 0.0)
    assert own.passes == pytest.approx(passes)
    law = tl.FatigueLine(1e-3, -0.2)
    weak, harmless = (Allowed(name, "soil", "top", 0.26, law, value, 0.1, -0.05) for name, value in
                      (("subgrade", 800e-6), ("base", 0.0)))  # fmt: skip
    governs = PassesAllowed((own, harmless)).answer(verdict.answer)
    assert (governs.headline, governs.facts) == (verdict.answer.headline, verdict.answer.facts)
    assert governs.further == "Does not govern: base, whose value is not harmful"
    answer = PassesAllowed((own, weak)).answer(verdict.answer)
    # (1000 / 800)⁵ million.
    assert answer.headline == f"Allowable load repetitions: {1e6 * 1.25**5:.3g}"
    facts = dict(answer.facts)
    assert facts["Governing criterion"] == "subgrade"
    assert facts["Place"] == "soil, top, 260 mm deep; x = 100 mm, y = -50 mm"
    assert facts["Why"].endswith("800 microstrain")
    nothing = PassesAllowed((harmless,)).answer(None)
    assert nothing.state == "meets"
    assert dict(nothing.facts)["Why"] == "no criterion evaluates a harmful value under this load"


@pytest.mark.slow
@pytest.mark.parametrize("name", ["run", "life", "dual_wheel", "hot_day", "design_life/design", "top_down/motorway"])
def test_cases_of_the_templates_and_examples(name, tmp_path):
    path = EXAMPLES / f"{name}.toml"
    case = Case.from_toml(path) if path.exists() else Case.from_text(first_case(name))
    result = tl.run(case.model_copy(update={"spacing": 0.016}), leave_out=SLOW)
    parts = dict(result.parts)
    sentence, headline = check(result, parts, number_of(parts), tmp_path / "r.html")
    criterion = re.search("(Governing c|C)riterion: (.*?)\\. Place", sentence)[2]
    assert sentence.partition("\n")[0] == f"{headline} ({criterion})"
