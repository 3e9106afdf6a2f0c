"""The examples of turning on the spot and of starting from rest run and end in checked numbers."""

import runpy
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.mark.slow
def test_parking_turn(tmp_path, capsys):
    found = runpy.run_path(str(EXAMPLES / "parking_turn.py"))["main"](tmp_path, coarse=True)
    # The whole tread slides at 30°, all but a cell or two around the middle.
    assert found["torque"] == pytest.approx(found["sliding torque"], rel=5e-3)
    # μP times the mean arm of a patch of 270 by 280 mm, which is 0.1 m.
    assert found["sliding torque"] == pytest.approx(0.7 * 32.5e3 * 0.1, rel=0.1)
    # Between nothing slides (the stiffness at first) and all slides, the loop is full: 4 M φ at most.
    assert 0.5 * 4 * found["torque"] * 0.5236 < found["loop"] < 4 * found["torque"] * 0.5236
    assert found["turned"] > 3 * found["standing"]
    assert "standing" in capsys.readouterr().out
    for name in ("torque.png", "shear_after_the_turn.png", "strain_after_the_turn.png"):
        assert (tmp_path / name).stat().st_size > 10_000


@pytest.mark.slow
def test_transient_start(tmp_path, capsys):
    found = runpy.run_path(str(EXAMPLES / "transient_start.py"))["main"](tmp_path, coarse=True)
    # 1.2 m are four lengths of the contact: each forgets three quarters or more of what was.
    assert found["end"] == pytest.approx(found["steady"], rel=0.01)
    assert found["end"] < found["steady"]
    # Half of the force stands after about half a length.
    assert 0.1 < found["half way"] < 0.2
    assert found["energy"] > 0
    assert "half of it" in capsys.readouterr().out
    for name in ("force.png", "shear_over_distance.png", "stick_slip_at_the_end.png"):
        assert (tmp_path / name).stat().st_size > 10_000
