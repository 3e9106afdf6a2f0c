"""The examples of the inflated belt run on coarse cells and end in checked numbers."""

import runpy
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[2] / "examples" / "belt"


@pytest.mark.slow
def test_load_deflection(tmp_path, capsys):
    found = runpy.run_path(str(EXAMPLES / "load_deflection.py"))["main"](tmp_path, spacing=12e-3)
    rms = found["rms"]
    # Five measured points, one fitted number; cells of 6 mm give 6.9 and 18.0 % as well.
    assert rms["belt"] <= 0.08
    assert rms["belt"] < rms["half-space, eq. 15 anew"]
    assert rms["half-space, eq. 15 as printed"] == pytest.approx(0.18, abs=0.005)
    assert rms["half-space, one E"] > 0.3
    # Cells of 12 mm move the foundation by 1 % from those of 6 mm, 4.31 /m.
    assert found["foundation"] == pytest.approx(4.31, rel=0.03)
    # The data alone: no tire grows faster than its pressure, and then half as much.
    (grown, inflated), (later, more) = found["growth"][40, 70], found["growth"][70, 95]
    assert grown > inflated
    assert later - 1 < 0.5 * (more - 1)
    assert found["alone"][70] > 1.25 * max(found["alone"][40], found["alone"][95])
    assert "What the data contradict" in capsys.readouterr().out
    assert (tmp_path / "load_deflection.png").stat().st_size > 10_000
