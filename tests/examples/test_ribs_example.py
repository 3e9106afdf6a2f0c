"""The example of ribs runs on coarse cells and ends in checked numbers."""

import runpy
from pathlib import Path

import pytest

RUN = Path(__file__).parents[2] / "examples" / "ribs" / "run.py"


@pytest.mark.slow
def test_ribs_shear_outward_and_a_layer_hardly(tmp_path, capsys):
    found = runpy.run_path(str(RUN))["main"](tmp_path, spacing=6e-3)
    shear = {name: case["amplitude"] for name, case in found["shear"].items()}
    # Cells of 6 mm are within 7 % of those of 3 mm, for which `treadload validate` checks the numbers.
    assert shear["ribs"] == pytest.approx([0.291, 0.293, 0.250], rel=0.07)
    assert shear["friction 0.3"] == pytest.approx([0.248, 0.251, 0.225], rel=0.07)
    assert max(abs(value) for value in shear["layer"]) < 0.04
    assert shear["worn by 6 mm"][0] < shear["ribs"][0]
    assert 2.5 <= found["shear"]["ribs"]["ratios"][0] <= 4
    layer, ribs = found["surface"]["half-space of 5.4 GPa"]
    assert ribs > 1.3 * layer
    cold, hot = (found["surface"][f"French structure, {t:g} °C"][1] for t in (15.0, 40.0))
    assert hot > cold
    assert "from memory" in capsys.readouterr().out
    assert (tmp_path / "ribs.png").stat().st_size > 10_000
