"""The example of stones: what they do to the mastic's tension, seed by seed, and the case that asks for a window."""

import runpy
from pathlib import Path

import numpy as np
import pytest

import treadload as tl

EXAMPLE = Path(__file__).parents[2] / "examples" / "aggregates"


@pytest.mark.slow
def test_aggregates(tmp_path, capsys):
    table = runpy.run_path(str(EXAMPLE / "run.py"))["main"](tmp_path, seeds=(1, 2), spacing=2e-3, cells=6e-3)
    stiff, soft = table["3 GPa, seed 1"], table["1.5 GPa, seed 1"]
    # Stones of twenty times the modulus carry more of the load, the more the softer the mortar is.
    assert 1.1 < stiff["carried"] < soft["carried"]
    assert stiff["factor"] > 1.5
    assert stiff["mastic"] > stiff["alone"]
    assert stiff["ravelling"] > 0
    assert "standard deviation" in capsys.readouterr().out
    assert (tmp_path / "stones.png").stat().st_size > 30_000
    assert tl.open_results(tmp_path / "stones.nc").heterogeneous.factor(99) == pytest.approx(stiff["factor"])


@pytest.mark.slow
def test_the_case_with_stones_runs_is_written_and_reported(tmp_path):
    text = (EXAMPLE / "aggregates.toml").read_text().replace('spacing = "3 mm"', 'spacing = "8 mm"')
    case = tl.Case.from_text(text.replace('"1 mm"', '"2 mm"'))
    result = tl.run(case)
    assert result.heterogeneous is not None
    assert "ravelling index" in result.summary()
    tl.save_results(result, tmp_path / "case.nc")
    back = tl.open_results(tmp_path / "case.nc")
    np.testing.assert_array_equal(back.heterogeneous.dataset.stress_zz, result.heterogeneous.dataset.stress_zz)
    page = tl.report(back, tmp_path / "case.html").read_text()
    assert "Stones in mortar" in page
    assert "could not be drawn" not in page
    assert "Eshelby" in page


def test_the_case_says_what_its_window_is():
    case = tl.Case.from_toml(EXAMPLE / "aggregates.toml")
    again = tl.Case.from_text(case.to_toml())
    assert again.aggregates == case.aggregates
    assert again.aggregates.build().packing.radii == ((0.005, 0.6), (0.002, 0.4))
    road = case.aggregates.road(case.build_road())
    assert road.layers[0].material == tl.Elastic(3e9, 0.35)
    assert case.build_road().layers[0].material == tl.Elastic(5.4e9, 0.35)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('depth = "16 mm"', 'depth = "60 mm"', "the window is 60 mm deep and the mortar's layer 40 mm"),
        ("shares   = [0.4, 0.6]", "shares = [0.4]", "shares need one per radius, got 1 for 2"),
        ("fraction = 0.33", "fraction = 1.33", "fraction of stones must lie in (0, 1)"),
        ('mortar   = { modulus = "3 GPa", poisson = 0.35 }', 'mortar = { modulus = "3 GPa", poisson = 0.5 }', "0.49"),
        ('spacing  = "1 mm"', 'spacing  = "0 mm"', "spacing must be a positive number"),
    ],
)
def test_a_case_that_cannot_be_is_refused_before_it_is_solved(old, new, words):
    text = (EXAMPLE / "aggregates.toml").read_text()
    assert old in text
    with pytest.raises(tl.InputError) as refused:
        tl.Case.from_text(text.replace(old, new))
    assert words in str(refused.value)
