"""The roller on a soft fill: runs as it is told and draws."""

import runpy
import sys
from pathlib import Path

import pytest

EXAMPLE = Path(__file__).parents[2] / "examples" / "roller" / "run.py"


@pytest.mark.slow
def test_the_roller_runs_and_draws(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "argv", ["run.py", str(tmp_path)])
    # It ends in its own checks.
    runpy.run_path(str(EXAMPLE), run_name="__main__")
    assert {path.stem for path in tmp_path.glob("*.png")} == {"drum", "rut", "strain", "pressures"}
