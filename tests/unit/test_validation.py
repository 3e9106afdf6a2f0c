"""The validation table: every row passes, and a row that does not is shown as such."""

import math

import pytest

from treadload.errors import ConvergenceError, InputError
from treadload.validation import GROUPS, Check, format_markdown, format_table, run_checks
from treadload.validation import table as table_module
from treadload.validation.check import absolute, relative

# More than a second each on one core.
SLOW = {
    *("conditions", "contact on layers", "disc", "histories", "iterations", "layers", "mesh", "moving", "stones"),
    *("cracks", "published", "strain", "traffic", "yielding", "rib sections", "three ribs", "rolling ribs"),
    *("blocks", "ribs"),
}


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.slow] if name in SLOW else []) for name in GROUPS]
)
def test_every_row_passes(name):
    if name == "mesh":
        pytest.importorskip("trimesh")
    checks = run_checks(names=[name])
    assert checks
    failed = [check for check in checks if not check.passed]
    assert not failed, "\n" + format_table(failed)
    for check in checks:
        assert check.source
        assert abs(check.deviation) <= check.bound


def test_numbers_of_our_own_are_not_credited_to_a_publication():
    """Worked out by us from a source's formulas: a regression. Printed by others: their name alone."""
    checks = run_checks(names=["fatigue"])
    ours = {"French fatigue law", "MEPDG fatigue"}
    assert {check.group for check in checks} == {"French designs as printed", *ours}
    for check in checks:
        assert check.source.startswith("own regression") == (check.group in ours), check.quantity
    assert sum(check.group not in ours for check in checks) == 6


def test_relative_and_absolute():
    good = relative("g", "q", 1.01, 1.0, 0.02, "s")
    assert good.passed
    assert good.deviation == pytest.approx(0.01)
    assert not relative("g", "q", 0.97, 1.0, 0.02, "s").passed
    assert not relative("g", "q", -1.0, 1.0, 0.02, "s").passed
    assert absolute("g", "q", 3, 3, 0, "s").passed
    assert not absolute("g", "q", 4, 3, 0.5, "s").passed


@pytest.mark.parametrize("make", [relative, absolute])
def test_what_is_not_a_number_never_passes(make):
    assert not make("g", "q", math.nan, 1.0, 1e9, "s").passed


def test_order_and_progress():
    told = []
    checks = run_checks(told.append, ["modulus", "carter"])
    assert told == ["modulus", "carter"]
    assert checks[0].group == "modulus from inflation"
    assert checks[-1].group.startswith("Carter")


def test_an_unknown_name_is_refused_with_a_hint():
    with pytest.raises(InputError, match="did you mean 'carter'"):
        run_checks(names=["cartr"])
    with pytest.raises(InputError, match="known: hertz"):
        run_checks(names=["zzz"])


def test_a_solver_that_stops_makes_a_failed_row(monkeypatch):
    def stops():
        yield relative("g", "before", 1.0, 1.0, 0.1, "s")
        raise ConvergenceError("stopped after 3 iterations", 0.5)

    monkeypatch.setattr(table_module, "GROUPS", {"broken": stops, "modulus": GROUPS["modulus"]})
    checks = run_checks()
    assert [check.passed for check in checks] == [True, False, True]
    assert "stopped after 3 iterations" in checks[1].quantity
    assert math.isnan(checks[1].measured)


ROWS = [
    relative("Hertz", "peak, kPa", 264.057, 264.113, 0.005, "Johnson (1985)"),
    absolute("grooved tire", "|q| above μp", 4, 3, 0.5, "law"),
    Check("carter", "stopped: why", math.nan, math.nan, math.nan, 0.0, False, ""),
]


def test_plain_table():
    text = format_table(ROWS)
    lines = text.splitlines()
    assert lines[0].split()[:2] == ["problem", "quantity"]
    assert "264.057" in lines[2]
    assert "-0.021 %" in lines[2]
    assert "0.5 %" in lines[2]
    assert "yes" in lines[2]
    assert "NO" in lines[3]
    assert "nan" in lines[4]
    assert lines[-1] == "1 of 3 checks passed"
    # Columns stand under each other.
    assert lines[0].index("quantity") == lines[2].index("peak") == lines[3].index("|q|")


def test_markdown_table():
    lines = format_markdown(ROWS).splitlines()
    assert lines[0].startswith("| problem | quantity |")
    columns = lines[1].count("|")
    for line in lines[2:5]:
        assert line.replace("\\|", "").count("|") == columns
    assert "\\|q\\| above μp" in lines[3]
    assert lines[-1] == "1 of 3 checks passed"
