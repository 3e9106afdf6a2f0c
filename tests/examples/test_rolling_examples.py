"""The rolling examples run on coarse cells and end in checked numbers."""

import runpy
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"


def main_of(name):
    return runpy.run_path(str(EXAMPLES / f"{name}.py"))["main"]


def test_creep_curve(tmp_path, capsys):
    slopes = main_of("creep_curve")(tmp_path, spacing=12e-3, creepages=(-0.05, -0.005, 0.0, 0.005))
    dry, wet, smooth = slopes.values()
    # At small creepage nearly all of the patch sticks: friction matters little, and so do the grooves.
    assert wet == pytest.approx(dry, rel=0.05)
    assert smooth == pytest.approx(dry, rel=0.05)
    assert dry == pytest.approx(237e3, rel=0.05)
    assert "creep stiffness" in capsys.readouterr().out
    assert (tmp_path / "creep_curve.png").stat().st_size > 10_000


def test_cornering(tmp_path):
    found = main_of("cornering")(tmp_path, spacing=12e-3, speeds=(10.0, 30.0))
    (slow, _), (fast, orientation) = found.values()
    assert fast > 2 * slow
    assert orientation == "longitudinal"
    for name in ("aligning_moment.png", "strain.png"):
        assert (tmp_path / name).stat().st_size > 10_000
