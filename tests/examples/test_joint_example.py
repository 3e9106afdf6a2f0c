"""A wheel over a joint and a frame: the example runs, draws and ends in its own checks."""

import runpy
import sys
from pathlib import Path

import pytest


@pytest.mark.slow
def test_the_joint_runs_and_draws(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "argv", ["run.py", str(tmp_path)])
    runpy.run_path(str(Path(__file__).parents[2] / "examples" / "joint" / "run.py"), run_name="__main__")
    assert {path.name for path in tmp_path.glob("joint*")} == {"joint.png", "joint_contacts.png", "joint.nc"}
