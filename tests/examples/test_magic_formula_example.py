"""A maker's .tir file beside a solved tire."""

import runpy
from pathlib import Path

CURVES = Path(__file__).parents[2] / "examples" / "magic_formula" / "curves.py"


def test_the_solved_tire_is_near_the_textbook_at_its_nominal_load(tmp_path, capsys):
    found = runpy.run_path(str(CURVES))["main"](tmp_path, spacing=12e-3)
    # The belt's stiffnesses were chosen after the file at 35 kN: the rest is friction and how it falls with the load.
    assert found["lateral_force 35 kN"] < 0.04
    assert found["tractive_force 35 kN"] < 0.1
    assert found["tractive_force 17.5 kN"] > found["tractive_force 35 kN"]
    assert "rms of solve less file" in capsys.readouterr().out
    assert (tmp_path / "tir_curves.png").stat().st_size > 10_000
