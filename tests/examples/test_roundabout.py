"""The example of the roundabout runs on coarse cells and ends in checked numbers."""

import math
import runpy
from pathlib import Path

import pytest

import treadload as tl

FOLDER = Path(__file__).parents[2] / "examples" / "roundabout"
STRUCTURE = "6 BBSG3 / 15 GB3 / PF3"


@pytest.mark.slow
def test_roundabout(tmp_path, capsys):
    found = runpy.run_path(str(FOLDER / "run.py"))["main"](tmp_path, spacing=4e-3)
    # 10 mm deep cells of 2 mm give these microstrain; 4 mm, almost half the depth, are allowed 8 %.
    fine = {
        "the paper's asphalt": {
            "straight": 56,
            "locked": 92,
            "roundabout": 75,
            "outer wheel": 95,
            "parking turn": 101,
        },
        STRUCTURE: {"straight": 56, "locked": 76, "roundabout": 74, "outer wheel": 99, "parking turn": 69},
    }
    for road, strains in fine.items():
        for name, strain in strains.items():
            assert float(found[road].deep.sel(maneuver=name)) * 1e6 == pytest.approx(strain, rel=0.08), (road, name)
    # The structure bends: under a wheel that rolls straight its surface is pressed together in the plane, and what
    # `assess` reads lies beyond the contact's map, where the basin's side is bent upwards: 8.0 microstrain.
    straight = found[STRUCTURE].sel(maneuver="straight")
    assert float(straight.in_plane) < 0 < float(straight.deep)
    assert float(straight["read"]) == pytest.approx(7.96e-6, rel=0.02)
    mix = tl.catalogue.mixes["EB-BBSG3"]
    line = tl.FatigueLine(mix.epsilon_6, mix.slope)
    assert float(straight.passes) == pytest.approx(float(line.allowable_passes(float(straight["read"]))), rel=1e-6)
    assert "outer wheel" in capsys.readouterr().out
    for name in ("tearing_half_space", "tearing_structure", "tearing_parking", "strain", "rose_structure"):
        assert (tmp_path / f"{name}.png").stat().st_size > 10_000


def test_the_case_file_is_the_maneuver():
    case = tl.Case.from_toml(FOLDER / "roundabout.toml")
    turn = tl.contact.Maneuver.turning(12.0, 20 / 3.6).rolling(32.5e3, 0.7)
    written = case.rolling.build()
    # Four digits are written in the file.
    assert written.forces == pytest.approx(turn.forces, rel=1e-4)
    assert written.spin == pytest.approx(turn.spin, rel=1e-4)
    assert case.pavement.build() == tl.Pavement.from_catalogue(STRUCTURE, temperature=15)
    assert math.isclose(case.damage.fatigue.epsilon_6, tl.catalogue.mixes["EB-BBSG3"].epsilon_6)
