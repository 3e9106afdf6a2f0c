"""Whatever surrounds the program, its commands give the same numbers, the same words and no raw error."""

import csv
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import treadload as tl
from cases import BASE_AND_SOIL, ONE_AXLE
from faults.kills import CALIBRATION
from tire_meshes import tire_mesh
from treadload.cli.commands import app

COARSE = (Path(__file__).parents[1] / "faults" / "case.toml").read_text(encoding="utf-8")
FATIGUE = '[damage]\nfatigue = { epsilon_6 = "120 microstrain", slope = -0.2 }\n'
LONG = f"Straße 工程 {'ä' * 60}/{'b' * 150}/{'c' * 150}"
COMMANDS = {
    "run": "run case.toml -q -o run.nc",
    "export": "export run.nc -o run.csv",
    "report": "report run.nc -q -o run.html",
    "compare": "compare run.nc print.csv -q --units kPa --spacing 24mm -o compare.nc",
    "life": "life life.toml -q --workers 2 -o life.nc",
    "design": "design life.toml -q --layer EB-GB3 --years 20 --low 100mm --high 200mm --step 50mm -o design.nc",
    "sweep": "sweep small.toml -q --vary modulus=1e9:5e9:2 --jobs 2 -o sweep.zarr",
    "table": "study table sweep.zarr -o table.csv",
    "scan": "scan wheel.ply -q --units m --spacing 12mm -o scan.nc",
    "calibrate": "calibrate calibrate.toml -q -o calibrate.nc",
}
# Processes of a study, calibrations and lives are tried by the slow test, and so are long paths under C.
QUICK, QUICK_WORLD = ("run", "export"), "a German of Nepal without a home"
# One command after another in one process, which is told how processes start and whether C writes decimal commas.
DRIVER = """
import contextlib, io, json, locale, multiprocessing, os, shlex, sys
from treadload.cli import main

if __name__ == "__main__":
    commands, method = json.loads(sys.argv[1]), sys.argv[2]
    told = locale.setlocale(locale.LC_ALL, "")
    if method:
        multiprocessing.set_start_method(method)
    printed = {"comma": locale.localeconv()["decimal_point"]}
    for name, line in commands.items():
        sys.argv = ["treadload", *shlex.split(line)]
        out, err = io.StringIO(), io.StringIO()
        code = None
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            try:
                main()
            except SystemExit as end:
                code = end.code
        printed[name] = [code, out.getvalue(), err.getvalue()]
    with open("printed.json", "w", encoding="utf-8") as file:
        json.dump(printed, file)
"""
WORLDS = {
    "a German of Nepal without a home": (
        {"LC_ALL": "de_DE.UTF-8", "TZ": "Asia/Kathmandu", "PYTHONHASHSEED": "1", "HOME": None}, "", "fork",
    ),
    "a long path in C": (
        {"LC_ALL": "C", "TZ": "Pacific/Auckland", "PYTHONHASHSEED": "12345", "PYTHONUTF8": "0"}, LONG, "spawn",
    ),
}  # fmt: skip
USUAL = {"LC_ALL": "C.UTF-8", "TZ": "UTC", "PYTHONHASHSEED": "0", "OMP_NUM_THREADS": "1", "COLUMNS": "100"}


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    """A folder with a case."""
    folder = tmp_path_factory.mktemp("case")
    (folder / "case.toml").write_text(COARSE + FATIGUE, encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def inputs(case, tmp_path_factory):
    """A folder with what all commands read."""
    import trimesh

    from sweeps import CASE, PRINT

    folder = tmp_path_factory.mktemp("inputs")
    shutil.copy(case / "case.toml", folder)
    (folder / "life.toml").write_text(ONE_AXLE + BASE_AND_SOIL, encoding="utf-8")
    (folder / "calibrate.toml").write_text(CALIBRATION, encoding="utf-8")
    (folder / "small.toml").write_text(CASE.replace("print.csv", "small.csv"), encoding="utf-8")
    (folder / "small.csv").write_text(PRINT)
    contact = tl.run(tl.Case.from_text(COARSE)).contact
    np.savetxt(folder / "print.csv", contact.dataset["pressure"].to_numpy() / 1e3, delimiter=";", fmt="%.3f")
    vertices, faces = tire_mesh(around=180, across=40)
    trimesh.Trimesh(vertices, faces, process=False).export(folder / "wheel.ply")
    return folder


@pytest.fixture(scope="module")
def usual(inputs, tmp_path_factory):
    """What all commands give in usual surroundings."""
    return given(inputs, tmp_path_factory.mktemp("usual") / "here", tuple(COMMANDS), {}, "spawn")


@pytest.fixture(scope="module")
def german(tmp_path_factory):
    """Where the C library finds a locale with decimal commas; "" where it is known or cannot be made."""
    if shutil.which("localedef") is None:
        return ""
    folder = tmp_path_factory.mktemp("locales")
    subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", folder / "de_DE.UTF-8"], capture_output=True)
    return str(folder) if (folder / "de_DE.UTF-8").exists() else ""


def given(inputs, folder, names, changes, method):
    """What commands print and write in a folder: (code, words, errors) of each, and what stands in its file."""
    shutil.copytree(inputs, folder)
    (folder / "driver.py").write_text(DRIVER, encoding="utf-8")
    source = str(Path(tl.__file__).parents[1])
    environment = {**os.environ, **USUAL, "PYTHONPATH": source, **changes}
    environment = {name: value for name, value in environment.items() if value is not None}
    lines = {name: COMMANDS[name] for name in COMMANDS if name in names}
    command = [sys.executable, "driver.py", json.dumps(lines), method]
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, b"", b"")
    printed = json.loads((folder / "printed.json").read_text(encoding="utf-8"))
    comma = printed.pop("comma")
    for name, (code, _, errors) in printed.items():
        assert (code, errors) == (0, ""), (name, code, errors)
    written = {name: contents(folder / line.split()[-1]) for name, line in lines.items()}
    return {name: words(out) for name, (_, out, _) in printed.items()}, written, comma


def words(text):
    """What is printed, but for times."""
    return re.sub(r"[\d.]+ s\b", "", text)


def contents(path):
    """What a file or a store holds, in a form to compare; a page says when it was written."""
    if path.suffix == ".nc":
        return tl.open_results(path).tree
    if path.suffix == ".zarr":
        return tl.sweeps.open_sweep(path).dataset.load().drop_vars("seconds")
    if path.suffix == ".html":
        when, how_long = (
            r"\d{4}-\d\d-\d\d \d\d:\d\d(:\d\d)? UTC",
            r'(?<=<td class="unit">s</td><td class="value">)[^<]*',
        )
        return re.sub(f"{when}|{how_long}", "", path.read_text(encoding="utf-8"))
    # What a table says of its results holds times.
    files = [file for file in sorted(path.parent.glob(f"{path.stem}*.csv")) if not file.stem.endswith("_about")]
    return {file.name: list(rows(file)) for file in files}


def rows(path):
    """Lines of a table without how long each case took."""
    with path.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            row.pop("seconds [s]", None)
            yield row


def check(one, other):
    """Refuse another word or another digit."""
    assert one[0] == other[0]
    for name, content in one[1].items():
        alike = content.equals(other[1][name]) if hasattr(content, "equals") else content == other[1][name]
        assert alike, name


def test_the_same_numbers_everywhere(tmp_path, case, german):
    """Two commands in a process of other surroundings, and in this one in the usual ones."""
    there = given_in_a_world(tmp_path, case, german, QUICK_WORLD, QUICK)
    folder = tmp_path / "usual"
    shutil.copytree(case, folder)
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        for name, value in USUAL.items():
            patch.setenv(name, value)
        printed = {name: output_of(COMMANDS[name]) for name in QUICK}
    written = {name: contents(folder / COMMANDS[name].split()[-1]) for name in QUICK}
    check(there, (printed, written))


def output_of(line):
    """What a command prints in this process."""
    ran = CliRunner().invoke(app, line.split())
    assert (ran.exit_code, ran.stderr) == (0, "")
    return words(ran.stdout)


@pytest.mark.slow
@pytest.mark.parametrize("world", WORLDS)
def test_every_command_gives_the_same_everywhere(tmp_path, inputs, usual, german, world):
    check(given_in_a_world(tmp_path, inputs, german, world, tuple(COMMANDS)), usual)


def given_in_a_world(tmp_path, inputs, german, world, names):
    """What commands give in a world, whose decimal mark of C is that of its language."""
    changes, path, method = WORLDS[world]
    if changes["LC_ALL"].startswith("de"):
        if not german:
            pytest.skip("no locale with decimal commas can be made here")
        changes = {**changes, "LOCPATH": german}
    folder = tmp_path / (path or "here")
    folder.parent.mkdir(parents=True, exist_ok=True)
    there = given(inputs, folder, names, changes, method)
    assert there[2] == ("," if german and changes["LC_ALL"].startswith("de") else ".")
    return there


@pytest.mark.slow
@pytest.mark.parametrize("line", ["run case.toml -o run.nc", "study table --help", "catalogue tires", "run --help"])
def test_a_reader_that_leaves_is_no_error(tmp_path, inputs, line):
    shutil.copy(inputs / "case.toml", tmp_path)
    source = str(Path(tl.__file__).parents[1])
    script = f'set -o pipefail; "{sys.executable}" -m treadload {line} | head -n 1'
    environment = {**os.environ, **USUAL, "PYTHONPATH": source}
    done = subprocess.run(
        ["bash", "-c", script], cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert len(done.stdout.splitlines()) == 1
    assert "Traceback" not in done.stderr
    assert "Broken" not in done.stderr
