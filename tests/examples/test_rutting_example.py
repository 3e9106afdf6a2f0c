"""The bus stop in July: runs as it is told, and its case is the same stop."""

import runpy
import sys
from pathlib import Path

import pytest

import treadload as tl

FOLDER = Path(__file__).parents[2] / "examples" / "rutting"


@pytest.mark.slow
def test_the_bus_stop_runs_and_draws(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "argv", ["run.py", str(tmp_path)])
    # It ends in its own checks.
    runpy.run_path(str(FOLDER / "run.py"), run_name="__main__")
    drawn = {path.stem for path in tmp_path.glob("*.png")}
    assert drawn == {"rut_standing", "strain_standing", "residual", "rut_counted", "growth", "shakedown"}


def test_the_case_of_the_bus_stop_is_that_of_the_script():
    case = tl.Case.from_toml(FOLDER / "rutting.toml")
    example = runpy.run_path(str(FOLDER / "run.py"))
    assert case.speed == example["STANDING"]
    told, meant = case.build_road().layers[0].material, example["road"](example["VISCOUS"]).layers[0].material
    assert told.elastic == meant.elastic
    assert told.law.fluidity == meant.law.fluidity
    assert told.law.law.friction_angle == pytest.approx(meant.law.law.friction_angle, rel=1e-14)
    assert case.passes.count == 3
