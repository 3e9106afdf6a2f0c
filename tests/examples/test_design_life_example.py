"""The example of a design ends in a page whose numbers hold together; on coarser cells and fewer months."""

import runpy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import treadload as tl
from treadload.life.solve import solve_life
from treadload.steps.design import design_of

EXAMPLE = Path(__file__).parents[2] / "examples" / "design_life"


@pytest.mark.slow
def test_design_life(tmp_path, capsys):
    result = runpy.run_path(str(EXAMPLE / "run.py"))["main"](tmp_path, spacing=12e-3)
    years = {c.name: result.life.years(c.name) for c in result.life.criteria}
    # Cells of 6 mm give 23.8 and 87 years, of 3 mm 24.0 and 88: deep criteria feel the cells by their forces alone.
    # The French laws hold the wander of traffic; counted twice it would be 40.2 and 167 years.
    assert years["base, bottom-up"] == pytest.approx(23.8, rel=0.05)
    assert years["platform, rutting"] == pytest.approx(87, rel=0.05)
    twice = result.life.dataset["life_years_with_wander"]
    assert float(twice.sel(criterion="base, bottom-up")) == pytest.approx(40.2, rel=0.05)
    assert float(twice.sel(criterion="platform, rutting")) == pytest.approx(167, rel=0.05)
    said = capsys.readouterr().out
    assert "Governing criterion: base, bottom-up. " in said
    assert "9 contacts" in said
    page = (tmp_path / "life.html").read_text()
    assert "What the life depends on" in page
    assert tl.open_results(tmp_path / "life.nc").life.governing == "base, bottom-up"


@pytest.mark.slow
def test_lives_of_the_design_are_those_of_all_seasons_solved():
    """On the cells of the case: few seasons stand for all, within 3e-3 of the years of every criterion."""
    case = tl.Case.from_toml(EXAMPLE / "design.toml")
    design = design_of(case)
    few, all_of_them = (solve_life(replace(design, tolerance=one)) for one in (design.tolerance, 0.0))
    assert few.stats["responses"] < all_of_them.stats["responses"]
    np.testing.assert_allclose(few.dataset["life_years"], all_of_them.dataset["life_years"], rtol=3e-3)


def test_the_design_is_a_valid_case():
    case = tl.Case.from_toml(EXAMPLE / "design.toml")
    assert len(case.build_traffic().classes) == 9
    assert len(case.build_climate().seasons) == 12
    assert [row.name for row in case.build_road().layers] == ["EB-BBSG3", "EB-GB3", "PF3"]
