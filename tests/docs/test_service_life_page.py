"""The three roads of the page `howto/service_life.md` have the service lives that it states."""

import re

import pytest

import treadload as tl
from texts import CLONE

PAGE = CLONE / "docs" / "howto" / "service_life.md"
ROADS = re.findall(r"```toml\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)
ROWS = [
    line.strip("|").split("|") for line in PAGE.read_text("utf-8").splitlines() if re.match(r"\| [IUF]\w+ ", line)
]


def test_the_page_has_three_roads_and_a_row_of_results_for_each():
    assert len(ROADS) == len(ROWS) == 3
    for text in ROADS:
        assert tl.Case.from_text(text).title in text


@pytest.mark.slow
@pytest.mark.parametrize("number", range(3), ids=["India", "United States", "France"])
def test_service_lives_are_those_of_the_page(number):
    life = tl.run(tl.Case.from_text(ROADS[number])).life
    _, governing, years, others = (cell.strip() for cell in ROWS[number])
    # The page states three digits at most.
    assert life.governing == governing
    assert life.years(governing) == pytest.approx(float(years), rel=0.01)
    other, value = others.rsplit(" ", 1)
    assert life.years(other) == pytest.approx(float(value), rel=0.01)
