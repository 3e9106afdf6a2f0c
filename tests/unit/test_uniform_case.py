"""`[uniform]` of a case: the step gives what the verb gives, and goes wherever a step of a case goes."""

import runpy

import pytest
import xarray as xr

import treadload as tl
from cases import COARSE_CASE
from treadload.app.result_rows import rows_of
from treadload.app.unsolved import unsolved
from treadload.case import Case

TEXT = COARSE_CASE.partition("[response]")[0].replace("12 mm", "24 mm").replace('"10 kN"', "0")
DEPTHS = '[uniform]\ndepths = ["20 mm", "80 mm"]\nslenderness = 1.4\n'


@pytest.fixture(scope="module")
def result():
    return tl.run(Case.from_text(TEXT + DEPTHS))


def test_the_step_gives_what_the_verb_gives(result):
    verb = tl.damage.compare_uniform(result.contact, result.road, depths=[0.02, 0.08], slenderness=1.4)
    xr.testing.assert_identical(result.uniform.dataset, verb.dataset)
    # Load over the inflation pressure of 8.2 bar.
    assert float(verb.dataset["uniform_area"]) == pytest.approx(32.5e3 / 8.2e5, rel=1e-5)


@pytest.mark.slow
def test_it_is_planned_summed_up_written_opened_reported_and_on_the_page(result, tmp_path):
    case = Case.from_text(TEXT + DEPTHS)
    assert Case.from_text(case.to_toml()) == case
    assert "disc and rectangle; depths 20 mm, 80 mm" in tl.plan(case)
    assert "20 mm deep, uniform disc" in result.summary()
    opened = tl.open_results(tl.save_results(result, tmp_path / "x.nc"))
    xr.testing.assert_identical(opened.uniform.dataset, result.uniform.dataset)
    assert "Comparison with uniform loads" in tl.report(result, tmp_path / "x.html").read_text("utf-8")
    assert unsolved(case) == []
    assert any("uniform disc" in line["group"] for line in rows_of(result.parts))


def test_its_script_gives_the_same(result, tmp_path):
    path = tmp_path / "script.py"
    path.write_text(tl.steps.case_as_python(Case.from_text(TEXT + DEPTHS)), encoding="utf-8")
    assert "tl.damage.compare_uniform" in path.read_text("utf-8")
    xr.testing.assert_identical(runpy.run_path(str(path))["uniform"].dataset, result.uniform.dataset)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("slenderness = 1.4", "slenderness = 0", "uniform.slenderness must be a positive number"),
        ("slenderness = 1.4", 'pressure = "-1 bar"', "uniform.pressure must be a positive number of Pa, got -100000"),
        ("slenderness = 1.4", 'mean_over = "2 m"', r"mean_over must lie in \(0, 0.1\] m, got 2"),
        ('inflation_pressure = "8.2 bar"', 'material = { modulus = "3 MPa", poisson = 0.5 }',
         "needs a pressure: the tire has no inflation pressure; give uniform.pressure"),
    ],
)  # fmt: skip
def test_bad_tables_are_refused(old, new, message):
    assert old in TEXT + DEPTHS
    with pytest.raises(tl.InputError, match=message):
        Case.from_text((TEXT + DEPTHS).replace(old, new))
