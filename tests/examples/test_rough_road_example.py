"""The rough road: texture, real area, enveloped pressure and figures as the example tells."""

import runpy
from pathlib import Path

import pytest

EXAMPLE = Path(__file__).parents[2] / "examples" / "rough_road" / "run.py"


@pytest.mark.slow
def test_rough_road(tmp_path, capsys):
    found = runpy.run_path(str(EXAMPLE))["main"](tmp_path, points=128, spacing=12e-3)
    assert 0.2 < found["touches"] < 0.9
    assert found["deep"] == pytest.approx(1, abs=0.03)
    said = capsys.readouterr().out
    assert "of the wheel's contact" in said
    assert "MPD" in said
    for name in ("rough_road.png", "chip_seal.png", "enveloped.png", "rough_road.nc"):
        assert (tmp_path / name).stat().st_size > 10_000
