"""`examples/top_down`: the bus stop on coarse cells under both tires; the other places are cases that can be read."""

import runpy
from pathlib import Path

import numpy as np
import pytest

import treadload as tl

EXAMPLE = Path(__file__).parents[2] / "examples" / "top_down"


@pytest.mark.slow
def test_top_down(tmp_path, capsys):
    results = runpy.run_path(str(EXAMPLE / "run.py"))["main"](tmp_path, 16e-3, 1, ["bus_stop"])
    said = capsys.readouterr().out
    assert "Bus stop, half-space" in said
    assert "Bus stop, belt" in said
    assert "Bus stop, ribs" in said
    names = {"bus_stop_half-space", "bus_stop_belt", "bus_stop_ribs"}
    written = {f"{name}.{kind}" for name in names for kind in ("nc", "html")} | {"depth_against_years.png"}
    assert {path.name for path in tmp_path.iterdir()} == written
    opened = tl.open_results(tmp_path / "bus_stop_belt.nc")
    assert opened.growth.years_to(0.04) == pytest.approx(results["bus_stop", "belt"].growth.years_to(0.04), rel=1e-12)


@pytest.mark.slow
def test_a_kinked_crack_below_twelve_profiles_starts_in_the_nearest_season_solved():
    changes = ["spacing=0.024", "climate.parts_of_day=1", 'growth.path="kinked"', "growth.steps=3"]
    case = tl.Case.from_toml(EXAMPLE / "bus_stop.toml", changes=changes)
    result = tl.run(case, workers=1)
    assert len(result.life.climate.seasons) == 12
    # Eight of them are solved for each of four classes.
    assert result.growth.stats["responses"] == 32
    years = result.growth.dataset["reach_years"].to_numpy()
    assert (np.diff(years) > 0).all()
    # A climate of profiles has no one temperature.
    assert np.isnan(result.equivalents.dataset["equivalent_temperature"]).all()


@pytest.mark.parametrize("place", ["motorway", "exit_curve", "bus_stop"])
def test_its_cases_can_be_read(place):
    case = tl.Case.from_toml(EXAMPLE / f"{place}.toml")
    assert {row.speed for row in case.build_traffic().classes} != {None}


@pytest.mark.slow
def test_what_would_help_the_bus_stop(tmp_path, capsys):
    run = runpy.run_path(str(EXAMPLE / "what_helps.py"))["main"]
    answers = run(tmp_path, ["bus_stop"], "24 mm", ["thickness", "bond", "turning", "wander"])
    assert "2 cm more EB-GB3" in capsys.readouterr().out
    assert {path.name for path in tmp_path.iterdir()} == {"bus_stop_remedies.nc", "bus_stop_remedies.png"}
    # The base governs, whose law includes wander: only the surface gains by it.
    gains = answers["bus_stop"].dataset["remedy_years"] / answers["bus_stop"].dataset["life_years"]
    assert float(gains.sel(remedy="50 mm more wander", criterion="base, bottom-up")) == pytest.approx(1.0, rel=1e-12)
    assert float(gains.sel(remedy="50 mm more wander", criterion="surface, MEPDG")) > 1
    assert len(answers["bus_stop"].skipped) == 2
