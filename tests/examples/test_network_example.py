"""The example of a network solves its sections and names the rows that are wrong."""

import runpy
from pathlib import Path

import pytest

pytest.importorskip("zarr")
EXAMPLE = Path(__file__).parents[2] / "examples" / "network" / "run.py"


@pytest.mark.slow
def test_the_network_of_a_county(tmp_path):
    network = runpy.run_path(str(EXAMPLE))["main"](tmp_path)
    assert len(network.ranked) == 10
    assert network.ranked[:3] == ("C2-03", "C2-04", "C3-01")
    assert network.remaining("C2-03") < -20
    assert network.remaining("C1-05") == pytest.approx(5.67, abs=0.1)
    assert str(network.dataset["governing_criterion"].sel(section="C3-01").item()) == "subgrade, rutting"
    assert "C1-06, C3-02" in " ".join(network.warnings)
    assert "Sections by remaining life" in (tmp_path / "network.html").read_text(encoding="utf-8")
