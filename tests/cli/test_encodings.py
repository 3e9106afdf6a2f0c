"""Whatever encoding standard output has, no command ends in a raw error, and Python prints every summary."""

import io
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import treadload as tl
from treadload.cli import ending
from treadload.spelling import SPELT, printable, spelt

COARSE = (Path(__file__).parents[1] / "faults" / "case.toml").read_text(encoding="utf-8")
COMMANDS = (
    "--help", "criteria", "catalogue", "catalogue mixes", "catalogue structures", "run --help", "life --help",
    "schema", "init -o first.toml", "run case.toml --dry-run", "run case.toml -o done.nc",
    "report contact.nc -o contact.html", "export done.nc -o done.csv", "cite done.nc", "as-python case.toml",
    "run nowhere-µ-工.toml",
)  # fmt: skip
DRIVER = """
import json, os, shlex, sys
from treadload.cli import main

codes = {}
for line in json.loads(sys.argv[1]):
    sys.argv = ["treadload", *(os.fsdecode(argument.encode()) for argument in shlex.split(line))]
    try:
        main()
    except SystemExit as end:
        codes[line] = end.code
with open("codes.json", "w", encoding="utf-8") as file:
    json.dump(codes, file)
"""
# Surroundings of standard output, the encoding in which it is written, and the name of a file there.
WORLDS = {
    "a pipe of Western Windows": ({"PYTHONIOENCODING": "cp1252"}, "cp1252", r"µ-\u5de5"),
    "a terminal of old Western Linux": ({"PYTHONIOENCODING": "latin-1"}, "latin-1", r"µ-\u5de5"),
    "a pipe under C": (
        {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
        "utf-8",
        r"\xc2\xb5-\xe5\xb7\xa5",
    ),
    "ASCII on request": ({"TREADLOAD_ASCII": "1"}, "ascii", r"mu-\u5de5"),
}


@pytest.mark.parametrize(
    "world",
    [
        pytest.param(world, marks=pytest.mark.slow) if world in ("a terminal of old Western Linux", "a pipe under C")
        else world
        for world in WORLDS
    ],
)  # fmt: skip
def test_commands_print_in_any_encoding(tmp_path, coarse_contact, world):
    changes, encoding, name = WORLDS[world]
    # The figures of a contact alone are drawn in a third of the time, and no figure is printed.
    tl.save_results(coarse_contact, tmp_path / "contact.nc")
    (tmp_path / "case.toml").write_text(COARSE, encoding="utf-8")
    (tmp_path / "driver.py").write_text(DRIVER, encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": str(Path(tl.__file__).parents[1]), **changes}
    command = [sys.executable, "driver.py", json.dumps(COMMANDS)]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, check=False)
    out, err = done.stdout.decode(encoding), done.stderr.decode(encoding)
    assert "Traceback" not in err
    assert done.returncode == 0
    codes = json.loads((tmp_path / "codes.json").read_text(encoding="utf-8"))
    assert codes == {line: 2 if "nowhere" in line else 0 for line in COMMANDS}
    assert "error: " in err
    # What the encoding lacks is spelt, not lost.
    assert ("…" if encoding in ("utf-8", "cp1252") else "...") in out
    assert name in err


@pytest.mark.parametrize("encoding", ["cp1252", "latin-1", "ascii", "cp437", "utf-8"])
@given(text=st.text(st.characters()))
def test_any_text_is_spelt_in_any_encoding(encoding, text):
    assert len(spelt(text, encoding).encode(encoding)) >= len(text)
    if not any("\ud800" <= letter <= "\udfff" for letter in text):
        assert spelt(text, "utf-8") == text


def test_signs_are_spelt_as_an_engineer_would():
    assert spelt("σ₁ ≤ 10⁻⁶ µm², μ = 0.7, 3.35·10⁶ at 40 °C …", "ascii") == (
        "sigma_1 <= 10^-6 um^2, mu = 0.7, 3.35*10^6 at 40 degC ..."
    )
    assert spelt("Tread™ ℠", "ascii") == "TreadTM SM"


def test_summaries_can_be_printed_from_python(monkeypatch, coarse_contact):
    whole = coarse_contact.text()
    assert not whole.isascii()
    assert coarse_contact.summary() == whole
    file = io.TextIOWrapper(io.BytesIO(), encoding="ascii")
    monkeypatch.setattr(sys, "stdout", file)
    print(coarse_contact.summary())
    file.flush()
    assert file.buffer.getvalue().decode("ascii").strip() == printable(whole).strip()


def test_the_tree_of_a_result_keeps_all_characters(monkeypatch, coarse_run):
    whole = coarse_run.contact.text()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(io.BytesIO(), encoding="ascii"))
    assert coarse_run.to_tree()["contact"].attrs["summary"] == whole


@pytest.fixture(scope="module")
def coarse_run():
    return tl.run(tl.Case.from_text(COARSE))


@pytest.fixture
def coarse_contact(coarse_run):
    return coarse_run.contact


class Terminal(io.TextIOWrapper):
    """A stream that a person reads."""

    def isatty(self):
        return True


def test_terminals_keep_their_encoding_and_pipes_take_all_characters(monkeypatch):
    monkeypatch.delenv("PYTHONIOENCODING", raising=False)
    terminal, pipe = (kind(io.BytesIO(), encoding="latin-1") for kind in (Terminal, io.TextIOWrapper))
    for stream in (terminal, pipe):
        ending.set_encoding(stream)
    assert (terminal.encoding, pipe.encoding) == ("latin-1", "utf-8")
    assert terminal.errors == pipe.errors == SPELT
