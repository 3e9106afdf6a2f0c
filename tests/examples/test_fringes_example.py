"""A tread under fringes: pictures, file, evaluation and figures as the example tells."""

import runpy
import sys
from pathlib import Path

import pytest


@pytest.mark.slow
def test_the_tread_under_fringes_runs_and_draws(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "argv", ["run.py", str(tmp_path)])
    # It ends in its own checks.
    runpy.run_path(str(Path(__file__).parents[2] / "examples" / "fringes" / "run.py"), run_name="__main__")
    assert {path.name for path in tmp_path.iterdir()} >= {
        "fringes.png",
        "beside_truth.png",
        "tread.nc",
        "fringes.toml",
    }
