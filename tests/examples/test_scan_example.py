"""The example of two scans: wear and contact come out as of the tread that the scans were made from."""

import runpy
from pathlib import Path

import pytest

EXAMPLE = Path(__file__).parents[2] / "examples" / "scan_to_contact"


@pytest.mark.slow
def test_two_scans_give_wear_and_contact(tmp_path, capsys):
    numbers = runpy.run_path(str(EXAMPLE / "run.py"))["main"](tmp_path, spacing=6e-3)
    assert numbers["worn"] == pytest.approx(4e-3, abs=0.2e-3)
    assert numbers["radius"] == pytest.approx(0.496, abs=0.3e-3)
    # The revolved meridian of 0.2 mm of noise, beside a tread without any.
    assert numbers["peak"] == pytest.approx(numbers["known"], rel=0.08)
    assert "mean tread wear" in capsys.readouterr().out
    assert (tmp_path / "scan.png").stat().st_size > 30_000
    assert (tmp_path / "contact.png").stat().st_size > 20_000
