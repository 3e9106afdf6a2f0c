"""`treadload backcalculate`: from a table and a structure file to moduli in a file."""

import numpy as np
import pytest
from typer.testing import CliRunner

import treadload as tl
from treadload.cli import app
from treadload.steps import StructureFile

STRUCTURE = """
[[pavement.layers]]
name = "asphalt"
thickness = "150 mm"
material = { kind = "elastic", modulus = "5000 MPa", poisson = 0.35 }
[[pavement.layers]]
name = "soil"
material = { kind = "elastic", modulus = "70 MPa", poisson = 0.4 }
[backcalculation]
error = ["2 %", "1 µm"]
stiff_layer = "none"
priors = { asphalt = ["3000 MPa", 0.5] }
bounds = { soil = ["5 MPa", "1 GPa"] }
"""
BASINS = "station;load [kN];D0 [µm];D300 [µm];D900 [µm]\nA;50;600;330;120\nB;50;0;330;120\n"


@pytest.fixture
def files(tmp_path):
    (tmp_path / "road.toml").write_text(STRUCTURE, encoding="utf-8")
    (tmp_path / "basins.csv").write_text(BASINS, encoding="utf-8")
    return [str(tmp_path / "basins.csv"), str(tmp_path / "road.toml")]


def call(*words):
    return CliRunner().invoke(app, ["backcalculate", *words, "--quiet"])


def test_moduli_are_told_and_written(files, tmp_path):
    done = call(*files)
    assert done.exit_code == 0, done.output
    assert "1 refused" in done.output
    assert "station B: the deflection at 0 mm is 0 µm" in done.output
    result = tl.open_results(tmp_path / "basins_moduli.nc").backcalculation
    assert result.dataset["basin_status"].values.tolist()[1] == 2
    assert StructureFile.from_toml(files[1]).backcalculation.options()["stiff_layer"] is None
    assert np.isnan(result.dataset["stiff_depth"].values[0])


@pytest.mark.parametrize(
    ("key", "words"),
    [
        ("backcalculation.fixed=['asphalt']", "'asphalt' is fixed and has bounds or a prior"),
        ("backcalculation.fix=['asphalt']", "did you mean"),
        ("basins.load=P", "no column 'P'"),
    ],
)
def test_wrong_keys_are_named(files, key, words):
    done = call(*files, "--set", key)
    assert done.exit_code == 2
    assert words in " ".join(done.output.split())
