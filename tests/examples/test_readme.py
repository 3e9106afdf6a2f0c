"""The README's Python runs as it stands."""

import re
from pathlib import Path

import pytest

README = Path(__file__).parents[2] / "README.md"


def run(numbers, folder, monkeypatch):
    blocks = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)
    code = "\n".join(blocks[number] for number in numbers)
    monkeypatch.chdir(folder)
    made = {}
    exec(compile(code, str(README), "exec"), made)
    return made


@pytest.mark.slow
def test_the_first_python_of_the_readme(tmp_path, monkeypatch, capsys):
    run((0, 1), tmp_path, monkeypatch)
    assert "allowable load repetitions" in capsys.readouterr().out
    assert sorted(path.name for path in tmp_path.iterdir()) == ["report.html", "results.nc", "strain.png"]


@pytest.mark.slow
def test_the_road_in_july(tmp_path, monkeypatch, capsys):
    run((2,), tmp_path, monkeypatch)
    said = capsys.readouterr().out
    assert "depth 210 mm" in said
    assert "uniform disc" in said


def test_the_tire_on_a_belt(tmp_path, monkeypatch):
    made = run((3,), tmp_path, monkeypatch)
    assert made["tire"].carcass.belt is made["belt"]


def test_its_pictures_exist():
    pictures = re.findall(r"!\[[^\]]*\]\(([^)]+)\)", README.read_text(encoding="utf-8"))
    assert pictures
    for picture in pictures:
        assert (README.parent / picture).stat().st_size > 10_000
