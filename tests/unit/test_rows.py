"""Rows of a result: one description, rendered as text."""

import math
import re

import pytest

from treadload.rows import Place, Row, as_text, blocks_of, row
from treadload.variables import SCALES, VARIABLES, display_of


def test_row_takes_label_unit_and_digits_from_variables():
    load = row("normal_load", 32500.0)
    assert (load.label, load.unit, load.text) == ("normal load", "kN", "32.500 kN")
    assert row("largest_pressure", 1.244e6).text == "1244 kPa"
    assert row("slip_fraction", 0.123).text == "12.3 %"
    assert row("tractive_force", -1e-9).text == "0.0 N"
    assert row("spin", math.nan).text == "–"


def test_number_without_a_variable_needs_a_display():
    with pytest.raises(KeyError):
        row("nothing_of_the_kind", 1.0)
    assert row("law", "Coulomb, 0.7", label="friction").text == "Coulomb, 0.7"


def test_each_variable_can_be_shown():
    for name in VARIABLES:
        shown = display_of(name)
        assert shown.label, name
        assert shown.unit in SCALES, name
        assert Row(name, shown.label, 1.0, shown.unit, shown.form).text, name


def test_groups_with_the_same_rows_become_a_table():
    rows = [
        row("normal_load", 1e3),
        row("approach", 1e-3, group="first"),
        row("largest_pressure", 1e6, group="first"),
        row("approach", 2e-3, group="second"),
        row("largest_pressure", 2e7, group="second", note="beyond the law"),
    ]
    assert [len(block) for block in blocks_of(rows)] == [1, 2]
    lines = as_text(rows, ["spacing is 9 mm"]).splitlines()
    assert lines[0] == "normal load  1.000 kN"
    assert lines[1].split() == ["approach,", "mm", "peak", "pressure"]
    assert lines[2].split() == ["first", "1.00", "1000", "kPa"]
    assert lines[3].split() == ["second", "2.00", "20", "MPa"]
    assert lines[4:] == ["  second: beyond the law", "warning: spacing is 9 mm"]


def test_a_table_wider_than_a_terminal_has_a_line_for_each_quantity():
    label = "service life, by draws at a risk of {} %"
    rows = [
        row("years_at_risk", 0.5 * risk + k, label=label.format(risk), group=name, note="± 3 %" if risk == 5 else "")
        for k, name in enumerate(("surface, top-down", "platform, rutting"))
        for risk in (5, 50, 95)
    ]
    lines = as_text(rows).splitlines()
    assert re.split(" {2,}", lines[0].strip()) == ["surface, top-down", "platform, rutting"]
    assert [re.split(" {2,}", line)[0] for line in lines[1:4]] == [label.format(risk) for risk in (5, 50, 95)]
    assert [line.split()[-2:] for line in lines[1:3]] == [["3.5", "years"], ["26", "years"]]
    assert lines[4:] == ["  surface, top-down: ± 3 %", "  platform, rutting: ± 3 %"]
    assert max(map(len, lines)) <= 100


def test_a_single_group_is_a_heading_with_its_rows():
    here = Place(0.0125, -1e-9, 0.06)
    lines = as_text([row("largest_pressure", 1e6, place=here, group="surface", note="a cell")]).splitlines()
    assert lines == ["surface:", "  peak pressure  1000 kPa at x = 12.5 mm, y = 0.0 mm, 60 mm deep, a cell"]
