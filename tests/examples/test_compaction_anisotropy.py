"""The example of a grained road: what its grain does to strain and life, and that both stand beside isotropy."""

import runpy
from pathlib import Path

import pytest

import treadload as tl

EXAMPLE = Path(__file__).parents[2] / "examples" / "compaction_anisotropy"


@pytest.mark.slow
def test_compaction_anisotropy(tmp_path, capsys):
    found = runpy.run_path(str(EXAMPLE / "run.py"))["main"](tmp_path, spacing=12e-3)
    plain, grained = found["isotropic"], found["grain in both"]
    bottom, soil = "asphalt, bottom-up", "soil, rutting"
    # On cells of 6 mm: 0.79 and 0.43 of the isotropic lives; deep criteria feel the cells by their forces alone.
    assert grained[bottom] / plain[bottom] == pytest.approx(0.79, abs=0.03)
    assert grained[soil] / plain[soil] == pytest.approx(0.43, abs=0.03)
    # Stone that is half as stiff along spreads less and holds the asphalt less.
    assert found["grain in stone"][bottom] < 0.85 * plain[bottom]
    assert found["grain in asphalt"][soil] < plain[soil]
    said = capsys.readouterr().out
    assert all(name in said for name in found)
    assert (tmp_path / "compaction_anisotropy.png").stat().st_size > 30_000
    kept = tl.open_results(tmp_path / "grain.nc")
    assert kept.life.years(bottom) == pytest.approx(grained[bottom], rel=1e-12)


@pytest.mark.slow
def test_its_life_runs_as_a_case_with_what_it_depends_on():
    case = tl.Case.from_toml(EXAMPLE / "compaction.toml").model_copy(update={"spacing": 24e-3})
    result = tl.run(case)
    found = result.sensitivity.dataset["elasticity"]
    # A layer whose three moduli grow alike lasts longer; the contact feels none of it.
    assert float(found.sel(input="modulus of asphalt")) > 1
    assert float(found.sel(input="modulus of unbound")) > 1


def test_the_case_has_its_grain():
    case = tl.Case.from_toml(EXAMPLE / "compaction.toml")
    asphalt, stone, soil = (layer.material for layer in case.build_road().layers)
    assert asphalt.horizontal > asphalt.vertical
    assert stone.vertical == 2 * stone.horizontal
    assert isinstance(soil, tl.Elastic)
    roads = runpy.run_path(str(EXAMPLE / "run.py"))["roads"](case.build_road())
    assert [layer.material for layer in roads["isotropic"].layers][:2] == [
        tl.Elastic(5.4e9, 0.35),
        tl.Elastic(300e6, 0.35),
    ]
    again = tl.Case.from_text(case.to_toml())
    assert again.build_road() == case.build_road()
