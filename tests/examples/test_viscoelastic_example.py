"""The example of rolling resistance runs on coarse cells and ends in checked numbers."""

import runpy
from pathlib import Path

import pytest

EXAMPLE = Path(__file__).parents[2] / "examples" / "rolling_resistance.py"


@pytest.mark.slow
def test_rolling_resistance(tmp_path, capsys):
    found = runpy.run_path(str(EXAMPLE))["main"](tmp_path, spacing=12e-3, speeds=(0.1, 20.0, 500.0))
    one, five = found.values()
    # One relaxation resists at one speed; five resist at all of them. 6 mm cells give 0.17, 11.61 and 1.55 N/kN.
    assert one == pytest.approx([0.17, 11.6, 1.55], rel=0.03)
    assert five == pytest.approx([2.56, 3.85, 3.35], rel=0.03)
    assert "km/h" in capsys.readouterr().out
    assert (tmp_path / "rolling_resistance.png").stat().st_size > 10_000
