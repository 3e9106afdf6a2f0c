"""The tutorials, followed literally: files are written, commands run, Python in one session a page."""

import re
import shlex
from pathlib import Path

import pytest
from typer.testing import CliRunner

from treadload.cli import app

TUTORIALS = Path(__file__).parents[2] / "docs" / "tutorials"
# What makes an environment is done before.
MAKING = ("python3 -m venv", ". .venv/", "pip install")


def follow(page, folder):
    """Do what a page says, in order. Returns the commands run and the names that its Python has left."""
    made, ran = {}, []
    for language, block in re.findall(r"```(\w+)\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL):
        if language == "toml":
            (folder / re.match(r"# (\S+\.toml)\n", block)[1]).write_text(block, encoding="utf-8")
        elif language == "python":
            exec(compile(block, page.name, "exec"), made)
        else:
            assert language == "sh"
            for line in block.splitlines():
                if line.startswith(MAKING):
                    continue
                words = shlex.split(line)
                assert words[0] == "treadload"
                done = CliRunner().invoke(app, words[1:])
                assert done.exit_code == 0, f"{line}\n{done.output}"
                ran.append(line)
    return ran, made


WRITES = {
    "first_contact": {
        "pressure.png",
        "stick_slip.png",
        "report.html",
        "first.nc",
        "case.toml",
        "case.nc",
        "case.html",
    },
    "my_own_scan": {"my_tire.obj", "tread.nc", "tread.png", "pressure.png", "two_tires.png", "scan.nc", "scan.html"},
    "my_own_road": {"section.png", "road.toml", "road.nc"},
    "an_existing_road": {
        "bowls.csv",
        "structure.toml",
        "moduli.nc",
        "basins.png",
        "moduli.png",
        "rest.toml",
        "rest.nc",
        "overlay.toml",
        "overlay_design.nc",
    },
    "hot_road": set(),
    "my_own_traffic": {"life.toml", "mine.nc", "mine.html", "years.png", "shares.png", "more.nc"},
}


def test_every_tutorial_is_followed():
    assert set(WRITES) == {page.stem for page in TUTORIALS.glob("*.md")} - {"index"}


@pytest.mark.slow
@pytest.mark.parametrize("name", WRITES)
def test_a_tutorial_does_what_it_says(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    ran, made = follow(TUTORIALS / f"{name}.md", tmp_path)
    assert ran
    assert made
    assert {path.name for path in tmp_path.iterdir()} >= WRITES[name]
