"""The example of delamination runs on coarse cells and ends in checked numbers."""

import runpy
from pathlib import Path

import pytest

EXAMPLE = Path(__file__).parents[2] / "examples" / "delamination.py"


@pytest.mark.slow
def test_delamination(tmp_path, capsys):
    module = runpy.run_path(str(EXAMPLE))
    found = module["main"](tmp_path, spacing=12e-3, step=15e-3)
    # 6 mm cells and points 9 mm apart give 0.294 and 0.0905: half a step from a peak 60 mm wide costs 1 %.
    assert found["upper"] == pytest.approx(0.294, rel=0.02)
    assert found["lower"] == pytest.approx(0.0905, rel=0.02)
    # The slope -0.1 makes ten times as much of it.
    assert found["passes"] == pytest.approx(found["upper"] ** -10, rel=1e-9)
    assert found["passes"] == pytest.approx(2.1e5, rel=0.2)
    assert found["parting"] == pytest.approx(3.5, rel=0.2)
    assert found["parting"] < found["bonded, then parted"] < found["bonded"]
    # Microstrain below the wearing course: friction of 0.6 takes a sixth off; cells of 12 mm cost a few per cent.
    assert found["rubbing extension"] == pytest.approx(72, rel=0.05)
    assert found["frictionless extension"] == pytest.approx(87, rel=0.05)
    # Base, bottom: the laws' exponent of 5 makes 1 % of strain 5 % of life.
    assert found["bonded"] == pytest.approx(31.3, rel=0.05)
    assert found["parted"] == pytest.approx(6.3, rel=0.05)
    assert "fails first" in capsys.readouterr().out
    for name in ("utilisation.png", "sliding.png", "lives.png"):
        assert (tmp_path / name).stat().st_size > 10_000
