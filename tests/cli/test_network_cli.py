"""`treadload network` from outside."""

import pytest
from typer.testing import CliRunner

import treadload as tl
from treadload.cli import app

pytest.importorskip("zarr")
CASE = """
spacing = "20 mm"
tire = { profile = "315/80R22.5" }
pavement = { structure = "6 BBSG3 / 15 GB3 / PF3" }
climate = { temperature = 15 }
[traffic]
passes_per_year = 1e5
[[traffic.classes]]
name = "axle"
share = 1
axle_load = "100 kN"
inflation_pressure = "8 bar"
[[criteria]]
name = "base"
law = "french-bituminous"
layer = "lowest asphalt layer"
risk = 0.05
[[criteria]]
name = "soil"
law = "french-subgrade"
"""
# Structures of two and three layers of asphalt, one that is not of the catalogue.
TABLE = "section,structure,age\nN1,6 BBSG3 / 15 GB3 / PF3,3\nN2,6 BBSG3 / 8 GB3 / 8 GB3 / PF2,3\nN3,6 NONE / PF2,3\n"


def run(*arguments):
    return CliRunner().invoke(app, ["network", *map(str, arguments)])


@pytest.fixture
def table(tmp_path):
    (tmp_path / "net.toml").write_text(CASE)
    (tmp_path / "net.csv").write_text(TABLE)
    return tmp_path / "net.csv"


def test_sections_of_several_structures_by_the_name_of_their_table(table, tmp_path):
    done = run(table, "-o", tmp_path / "n.nc", "--quiet")
    assert done.exit_code == 0, done.output
    assert "2 solved, 1 failed" in done.output
    assert "N3" in done.output
    assert (tmp_path / "net.html").exists()
    assert (tmp_path / "net.zarr").exists()
    network = tl.open_results(tmp_path / "n.nc").network
    assert set(network.ranked) == {"N1", "N2"}
    # Two lifts carry the same as one of their thickness, on the softer platform.
    assert network.remaining("N2") != network.remaining("N1")
    again = run(table, "--report", tmp_path / "again.html", "-q")
    assert again.exit_code == 0
    assert (tmp_path / "again.html").exists()


def test_a_plan_solves_nothing(table, tmp_path):
    done = run(table, "--dry-run")
    assert done.exit_code == 0, done.output
    assert "cases     3" in done.output
    assert f"would be written: {tmp_path / 'net.html'}" in done.output
    assert not (tmp_path / "net.zarr").exists()


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda folder: (folder / "net.toml").unlink(), "net.toml"),
        (lambda folder: (folder / "net.csv").write_text("section,strukture\nN1,x\n"), "did you mean 'structure'"),
        (lambda folder: (folder / "net.csv").write_text("section,age\nN1,3\n"), "varies nothing"),
    ],
)
def test_wrong_use_is_one_sentence(table, tmp_path, change, said):
    change(tmp_path)
    done = run(table)
    assert done.exit_code == 2
    assert said in done.stderr
    assert len(done.stderr.splitlines()) == 1


def test_sections_that_all_fail_end_with_one(table):
    table.write_text("section,structure,age\nN1,6 BBSG3 / 15 GB3 / PF3,-1\n")
    done = run(table, "-q")
    assert done.exit_code == 1, done.output
    assert "1 failed" in done.output
    assert not table.with_suffix(".html").exists()
