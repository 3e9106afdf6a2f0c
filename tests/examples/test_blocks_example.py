"""The example of blocks runs on coarse cells and ends in checked numbers."""

import runpy
from pathlib import Path

import pytest

import treadload as tl

FOLDER = Path(__file__).parents[2] / "examples" / "blocks"


@pytest.mark.slow
def test_blocks_roll_through_a_pitch(tmp_path):
    numbers = runpy.run_path(str(FOLDER / "run.py"))["main"](tmp_path, spacing=10e-3, positions=4)
    assert numbers["change"] <= 0.01
    assert numbers["load"] < 1e-6
    assert numbers["net_force"] < 1e-6
    # Steps have a tolerance of 1e-4 of friction.
    assert numbers["asymmetry"] < 2e-3
    # Lateral grooves take a fifth of the faces of the ribs, and blocks are softer.
    assert 0.7 < numbers["area"] < 1
    assert 1 < numbers["approach"] < 1.1
    assert numbers["strain_worst"] >= numbers["strain_mean"] > 0
    for name in ("history", "maps", "strains"):
        assert (tmp_path / f"{name}.png").stat().st_size > 10_000


def test_the_case_of_blocks_is_read_and_planned():
    case = tl.Case.from_toml(FOLDER / "blocks.toml")
    assert "3 blocks in a pitch of 70 mm" in str(tl.plan(case))
