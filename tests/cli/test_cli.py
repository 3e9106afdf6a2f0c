import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from rich.console import Console
from typer.testing import CliRunner

import treadload as tl
from cases import COARSE_CASE
from treadload.cli import app
from treadload.results import open_results


@pytest.fixture(autouse=True)
def no_progress(monkeypatch):
    """A busy machine may take longer than what is told as long; tests/cli/test_progress.py looks at that."""
    monkeypatch.setattr("treadload.cli.progress.SHORT", 3600.0)


@pytest.fixture
def case(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(COARSE_CASE)
    return path


def call(*arguments):
    return CliRunner().invoke(app, [str(a) for a in arguments])


def refused(result, code, *words):
    """The command failed with this code and one sentence on stderr that holds these words."""
    assert result.exit_code == code, result.output
    assert isinstance(result.exception, SystemExit)
    assert len(result.stderr.strip().splitlines()) == 1, result.stderr
    assert "Traceback" not in result.output
    for word in words:
        assert word in result.stderr


@pytest.mark.slow
def test_summary_and_report_in_us_units(case, tmp_path):
    plain, ran = (call(*options, "run", case, "--quiet") for options in ((), ("--units", "us")))
    assert ran.exit_code == 0, ran.output
    rows = re.compile(r"(?m)^(?!warning|written)(peak pressure|normal load|approach|tractive force) +(\S+) (\S+)")
    si, us = ({label: (float(n), unit) for label, n, unit in rows.findall(r.stdout)} for r in (plain, ran))
    assert list(us) == list(si)
    assert {unit for _, unit in us.values()} == {"psi", "kip", "in", "lbf"}
    assert us["normal load"][0] * 4.4482216152605 == pytest.approx(si["normal load"][0], abs=1e-3)
    # Files stay in SI units: the file of the second run, in US units, is that of the first.
    tree = open_results(tmp_path / "case.nc").tree
    assert "kPa" in tree["contact"].attrs["rows"]
    assert "psi" not in tree["contact"].attrs["rows"]
    reported = CliRunner().invoke(
        app, ["report", str(tmp_path / "case.nc"), "-o", str(tmp_path / "r.html")], env={"TREADLOAD_UNITS": "us"}
    )
    assert reported.exit_code == 0, reported.output
    page = (tmp_path / "r.html").read_text()
    assert "psi" in page
    assert not re.search(r"<td[^>]*>[-\u2212\d.\s]+ (kPa|mm|kN|MPa)\s*</td>", page)


def test_unknown_units_are_an_error(case):
    refused(call("--units", "imperial", "run", case), 2, "si or us", "'imperial'")


@pytest.mark.slow
def test_run_then_report(case, tmp_path):
    ran = call("run", case)
    assert ran.exit_code == 0, ran.output
    assert "peak pressure" in ran.stdout
    assert "allowable load repetitions" in ran.stdout
    tree = open_results(tmp_path / "case.nc").tree
    assert float(tree["contact"].tractive_force) == pytest.approx(10e3, rel=1e-6)
    reported = call("report", tmp_path / "case.nc", "-o", tmp_path / "r.html")
    assert reported.exit_code == 0, reported.output
    page = (tmp_path / "r.html").read_text()
    assert "coarse" in page
    assert page.rstrip().endswith("</html>")


DESIGN = """
title = "a short life"
spacing = "12 mm"
tire = { profile = "315/80R22.5" }
pavement = { structure = "6 BBSG3 / 15 GB3 / PF3" }
climate = { temperature = 15 }
traffic = { passes_per_year = 1e6, years = 20, classes = [
    { name = "front", share = 1, axle_load = "70 kN", inflation_pressure = "8 bar" } ] }
criteria = [{ name = "base", law = "french-bituminous", layer = "EB-GB3", risk = 0.05 }]
"""


def test_life_then_report(tmp_path):
    path = tmp_path / "design.toml"
    path.write_text(DESIGN)
    ran = call("life", path, "--workers", 1)
    assert ran.exit_code == 0, ran.output
    assert ran.stdout.startswith("Service life: ")
    assert "Governing criterion: base." in " ".join(ran.stdout.split())
    assert "1 contacts and 1 responses for 1 combinations" in ran.stdout
    assert "thickness of EB-GB3" in ran.stdout
    tree = open_results(tmp_path / "design.nc").tree
    assert tree["life"].life_years.sel(criterion="base").item() > 0
    assert "NF P98-086" in tree["life"].attrs["sources"]
    assert tree["life"].attrs["caveats"] == '[""]'
    assert tree["sensitivity"].elasticity.sizes["input"] > 8
    assert tl.Case.from_text(tree.attrs["case"]).build_traffic().years == 20
    reported = call("report", tmp_path / "design.nc", "-o", tmp_path / "r.html")
    assert reported.exit_code == 0, reported.output
    page = (tmp_path / "r.html").read_text()
    assert re.search(r"<dt>Governing criterion</dt><dd>base</dd>", page)
    assert "no wander of traffic" not in page


def test_a_wrong_design_is_refused_in_a_sentence(tmp_path):
    path = tmp_path / "design.toml"
    path.write_text(DESIGN.replace("share = 1", "share = 0.5"))
    refused(call("life", path), 2, "sum to 1")
    path.write_text(DESIGN.replace("french-bituminous", "french-bituminus"))
    refused(call("life", path), 2, "did you mean 'french-bituminous'")


def test_scan_tells_the_quality_and_writes_a_height_map(tmp_path):
    result = call("scan", tl.example_mesh(), "-o", tmp_path / "h.nc", "--spacing", "10 mm")
    assert result.exit_code == 0, result.output
    assert "crown radius" in result.stdout
    assert tl.Tire.from_height_map(tmp_path / "h.nc").fixed_grid.dx == pytest.approx(0.01)


def test_the_catalogue_tells_names_numbers_and_sources(monkeypatch):
    monkeypatch.setattr("treadload.cli.shell.out", Console(width=200, highlight=False, soft_wrap=True, markup=False))
    result = call("catalogue")
    assert result.exit_code == 0, result.output
    for road in tl.catalogue.structures.values():
        assert road.name in result.stdout
    for name in (*tl.catalogue.mixes, *tl.catalogue.materials):
        assert name in result.stdout
    # NF P98-086: E(15 °C, 10 Hz) and ε₆ of EB-GB3.
    assert "E = 9000 MPa at 15 °C, ε₆ = 90 microstrain" in result.stdout
    (number,) = re.findall(r"\[(\d+)\] NF P98-086 \(2019\) as tabulated", result.stdout)
    assert re.search(rf"EB-GB3 .*\[{number}\]", result.stdout)


@pytest.mark.parametrize("kind", ["structures", "mixes", "materials", "tires"])
def test_one_catalogue_and_one_of_its_things(kind):
    known = getattr(tl.catalogue, kind)
    shown = call("catalogue", kind)
    assert shown.exit_code == 0, shown.output
    assert shown.stdout.count("what it is") == 1
    name = next(iter(known))
    one = call("catalogue", kind, name)
    assert one.stdout.startswith(f"{name}: ")
    for text in (known[name].source, *known[name].caveats):
        assert text in one.stdout


def test_brackets_of_a_text_are_printed():
    """Rich takes [pavement] and [kN] for marks of style, and leaves them out."""
    assert "in [pavement] of a case" in call("catalogue", "structures").stdout
    assert "normal_load [kN]" in " ".join(call("sweep", "--help").stdout.replace("│", " ").split())


def test_what_the_catalogue_does_not_have():
    refused(call("catalogue", "mixs"), 2, "no catalogue of 'mixs'; did you mean 'mixes'?")
    refused(call("catalogue", "mixes", "BBSG4"), 2, "no mix 'BBSG4'; did you mean 'BBSG")


def test_the_catalogue_tells_what_a_table_can_be(monkeypatch):
    monkeypatch.setattr("treadload.cli.shell.out", Console(width=250, highlight=False))
    told = call("catalogue").output
    for words in ("friction law, law = …", "anisotropic, flash, map", "half-bonded", "turning", "glb, off"):
        assert words in told


def test_names_of_the_catalogue_stay_whole_in_a_narrow_window(monkeypatch):
    monkeypatch.setattr("treadload.cli.shell.out", Console(width=80, highlight=False, soft_wrap=True))
    result = call("catalogue")
    for name in (*tl.catalogue.structures, *tl.catalogue.mixes):
        assert name in result.stdout


@pytest.mark.slow
def test_run_shows_the_road_at_its_temperature(case, tmp_path):
    start, end = COARSE_CASE.index("[[pavement.layers]]"), COARSE_CASE.index("[rolling]")
    road = '[pavement]\nstructure = "6 BBSG3 / 15 GB3 / PF3"\ntemperature = 15\n\n'
    case.write_text(COARSE_CASE[:start] + road + COARSE_CASE[end:])
    ran = call("run", case)
    assert ran.exit_code == 0, ran.output
    assert "E = 9000 MPa, ν = 0.35, 15 °C, bonded to the layer below" in ran.stdout
    layers = open_results(tmp_path / "case.nc").tree.attrs["layers"]
    assert '"temperature": 15.0' in layers


@pytest.mark.parametrize(
    ("pavement", "words"),
    [
        ('structure = "6/15"\ntemperature = 15', ("no structure '6/15'",)),
        ('structure = "6 BBSG3 / 15 GB3 / PF3"', ("needs a temperature",)),
        ('structure = "6 BBSG3 / 15 GB3 / PF3"\ntemperature = 60', ("60 °C", "-10 to 40 °C")),
    ],
)
def test_bad_roads_end_with_code_2(case, pavement, words):
    start, end = COARSE_CASE.index("[[pavement.layers]]"), COARSE_CASE.index("[rolling]")
    case.write_text(f"{COARSE_CASE[:start]}[pavement]\n{pavement}\n\n{COARSE_CASE[end:]}")
    refused(call("run", case), 2, *words)


def test_version_and_module():
    assert call("--version").stdout == f"treadload {tl.__version__}\n"
    done = subprocess.run(
        [sys.executable, "-m", "treadload", "--version"], capture_output=True, text=True, check=True
    )
    assert done.stdout == f"treadload {tl.__version__}\n"


def test_unknown_commands_are_wrong_usage():
    assert call("rnu").exit_code == 2


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('"10 kN"', '"30 kN"', ("gross sliding", "22750 N")),
        ("0.35", "0.7", ("poisson", "0.5", "0.7")),
        ('"32.5 kN"', '"-1 kN"', ("normal_load", "-1000")),
        ("= 0.7", "= -0.7", ("friction", "-0.7")),
        ('profile = "315/80R22.5"', 'scan = "none.obj"', ("none.obj",)),
        ('profile = "315/80R22.5"', 'profile = "bike"', ("bike", "315/80R22.5")),
        ('"12 mm"', '"200 mm"', ("spacing", "200")),
        ('"12 mm"', '"0.01 mm"', ("spacing", "0.01", "cells")),
    ],
)
def test_bad_cases_end_with_code_2(case, tmp_path, old, new, words):
    assert old in COARSE_CASE
    case.write_text(COARSE_CASE.replace(old, new))
    refused(call("run", case), 2, *words)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["case.toml"]


def test_unwritable_output_is_found_before_the_computation(case, tmp_path, monkeypatch):
    monkeypatch.setattr("treadload.run", None)
    refused(call("run", case, "-o", tmp_path / "no" / "r.nc"), 2, "does not exist")
    refused(call("run", case, "-o", tmp_path), 2, "is a folder")
    refused(call("demo", "-o", case / "demo"), 2, "cannot make the folder")


@pytest.mark.parametrize("content", [b"", b"v 1 2", b"\x00\x01\x02 no mesh"])
def test_broken_meshes_are_refused(tmp_path, content):
    (tmp_path / "tire.obj").write_bytes(content)
    refused(call("scan", tmp_path / "tire.obj"), 2, "tire.obj")


def test_a_mesh_in_wrong_units_is_refused():
    refused(call("scan", tl.example_mesh(), "--units", "km"), 2, "km")
    refused(call("scan", tl.example_mesh(), "--units", "cm"), 2)


def test_a_height_map_that_cuts_the_contact_is_refused(case, tmp_path):
    (tmp_path / "flat.csv").write_text("\n".join(",".join("0.0" for _ in range(20)) for _ in range(20)))
    text = COARSE_CASE.replace('spacing = "12 mm"', "").replace(
        'profile = "315/80R22.5"', 'height_map = "flat.csv"\ncell = "5 mm"'
    )
    case.write_text(text)
    refused(call("run", case), 2, "border", "larger")


def test_a_solver_that_fails_ends_with_code_1(case, monkeypatch):
    from treadload.contact.solvers import coupling

    monkeypatch.setattr(coupling, "_MOST_ROUNDS", 1)
    refused(call("run", case), 1, "did not settle")


@pytest.mark.skipif(os.name == "nt", reason="signals as on POSIX")
def test_an_interrupted_run_leaves_nothing_behind(case, tmp_path):
    case.write_text(COARSE_CASE.replace('"12 mm"', '"1 mm"'))
    process = subprocess.Popen(
        [sys.executable, "-m", "treadload", "run", str(case)],
        stderr=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        # A shell that runs in the background hands on that it ignores the signal.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    # The first line of progress: past the imports, amid the solve, be it of the contact or already of the road.
    assert re.match(r" +\d+ s  \w", process.stderr.readline())
    process.send_signal(signal.SIGINT)
    _, stderr = process.communicate(timeout=60)
    assert process.returncode == 130, stderr
    assert "interrupted; no file was changed" in stderr
    assert "the same command starts again" in stderr
    assert "Traceback" not in stderr
    assert sorted(p.name for p in tmp_path.iterdir()) == ["case.toml"]


@pytest.mark.slow
def test_what_is_written_is_what_the_name_says(case, tmp_path):
    ran = call("run", case, "-o", tmp_path / "r.csv")
    assert ran.exit_code == 0, ran.output
    written = [line.removeprefix("written: ") for line in ran.stdout.splitlines() if line.startswith("written: ")]
    assert str(tmp_path / "r_contact.csv") in written
    for file in written:
        assert file.endswith(".csv")
        assert Path(file).read_text(encoding="utf-8").splitlines()[0].count(",") >= 1
    openpyxl = pytest.importorskip("openpyxl")
    assert call("run", case, "-o", tmp_path / "r.xlsx").exit_code == 0
    assert "response" in openpyxl.load_workbook(tmp_path / "r.xlsx", read_only=True).sheetnames
    scanned = call("scan", tl.example_mesh(), "-o", tmp_path / "h.csv", "--spacing", "20 mm")
    assert scanned.exit_code == 0, scanned.output
    assert (tmp_path / "h.csv").read_text().startswith("y [m],x [m],initial_gap [m]\n")


def test_a_suffix_that_is_not_known_is_refused_before_the_work(case, tmp_path, monkeypatch):
    monkeypatch.setattr("treadload.run", None)
    monkeypatch.setattr("treadload.run", None)
    monkeypatch.setattr("treadload.tire.Tire.from_scan", None)
    known = (".nc", ".csv", ".xlsx")
    refused(call("run", case, "-o", tmp_path / "r.json"), 2, ".json", *known)
    refused(call("run", case, "-o", tmp_path / "r.pdf"), 2, "print", *known)
    refused(call("life", case, "-o", tmp_path / "r"), 2, "no suffix", *known)
    refused(call("scan", tl.example_mesh(), "-o", tmp_path / "r.obj"), 2, ".obj", *known)
    refused(call("report", case, "-o", tmp_path / "r.pdf"), 2, ".html", "print")
    refused(call("report", case, "-o", tmp_path / "r.nc"), 2, ".html")


def test_keys_are_set_and_a_dry_run_solves_nothing(case, tmp_path, monkeypatch):
    monkeypatch.setattr("treadload.run", None)
    told = call(
        "run", case, "--dry-run", "--set", "rolling.friction=0.6", "--set", "spacing=10 mm", "-o", tmp_path / "r.csv"
    )
    assert told.exit_code == 0, told.output
    assert "μ = 0.6" in told.stdout
    assert "cells of 10 x 10 mm" in told.stdout
    assert f"would be written: {tmp_path / 'r.csv'}" in told.stdout
    assert sorted(p.name for p in tmp_path.iterdir()) == ["case.toml"]
    refused(call("run", case, "--dry-run", "--set", "rolling.frictoin=0.6"), 2, "did you mean 'friction'")
    refused(call("run", case, "--dry-run", "-o", tmp_path / "r.pdf"), 2, ".pdf")


def test_a_dry_run_of_a_design(tmp_path):
    path = tmp_path / "design.toml"
    path.write_text(DESIGN)
    told = call("life", path, "--dry-run", "--set", "traffic.classes.0.axle_load=90 kN", "--set", "spacing=8 mm")
    assert told.exit_code == 0, told.output
    assert "contacts  1 on cells of 8 mm" in told.stdout
    assert "design.nc" in told.stdout
    refused(call("life", path, "--set", "traffic.classes.1.share=1"), 2, "a list of 1")


def test_run_takes_every_case_and_life_only_its_own(case, tmp_path):
    path = tmp_path / "design.toml"
    path.write_text(DESIGN)
    planned = call("run", path, "--dry-run")
    assert planned.exit_code == 0, planned.output
    assert "contacts  1 on" in planned.stdout
    refused(call("life", case), 2, f"treadload run {case}")


def test_shells_can_complete():
    shown = call("--help")
    assert "--install-completion" in shown.stdout
    environment = {
        **os.environ,
        "_TREADLOAD_COMPLETE": "complete_bash",
        "COMP_WORDS": "treadload cat",
        "COMP_CWORD": "1",
    }
    done = subprocess.run(
        [sys.executable, "-c", "from treadload.cli import app; app(prog_name='treadload')"],
        env=environment, capture_output=True, text=True,
    )  # fmt: skip
    assert done.stdout.split() == ["catalogue"]


@pytest.mark.parametrize("kind", ["run", "life", "calibrate"])
def test_init_writes_a_case_that_can_be_run_and_spares_what_is_there(kind, tmp_path):
    path = tmp_path / "my.toml"
    made = call("init", kind, "-o", path)
    assert made.exit_code == 0
    assert f"treadload {kind} {path} --dry-run" in made.output
    planned = call(kind, path, "--dry-run")
    assert planned.exit_code == 0, planned.output
    path.write_text("mine")
    refused(call("init", kind, "-o", path), 2, "exists already", "--force")
    assert path.read_text() == "mine"
    assert call("init", kind, "-o", path, "--force").exit_code == 0
    assert "title = " in path.read_text()


def test_schema_is_printed_or_written(tmp_path):
    printed = call("schema")
    assert printed.exit_code == 0
    assert "rolling" in json.loads(printed.stdout)["properties"]
    path = tmp_path / "case.schema.json"
    assert call("schema", "life", "-o", path).exit_code == 0
    assert "traffic" in json.loads(path.read_text(encoding="utf-8"))["properties"]
    refused(call("schema", "live"), 2, "did you mean 'life'")
