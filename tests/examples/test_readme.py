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


def test_it_is_short():
    """A page that somebody reads to its end."""
    assert len(README.read_text(encoding="utf-8").splitlines()) <= 120


def test_its_pictures_exist():
    pictures = re.findall(r"!\[[^\]]*\]\(([^)]+)\)", README.read_text(encoding="utf-8"))
    assert pictures
    for picture in pictures:
        assert (README.parent / picture).stat().st_size > 10_000
