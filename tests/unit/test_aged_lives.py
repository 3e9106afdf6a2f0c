"""Ageing lengthens the life of a mix whose fatigue line stays young: the command line says by how much."""

import re

import pytest
from typer.testing import CliRunner

from cases import BASE_AND_SOIL, ONE_AXLE
from treadload.case import Case
from treadload.cli import app
from treadload.steps import run

AGED = "ageing = { age = 10, mean_air = 12 }\n" + ONE_AXLE + BASE_AND_SOIL


def test_the_command_line_gives_both_lives_and_what_to_do(tmp_path):
    (tmp_path / "aged.toml").write_text(AGED)
    done = CliRunner().invoke(app, ["life", str(tmp_path / "aged.toml"), "--no-sensitivity", "--quiet"])
    assert done.exit_code == 0, done.output
    (line,) = [one for one in done.output.splitlines() if "young mix" in one and one.startswith("warning")]
    assert "fatigue line measured on aged specimens" in line
    old, young = map(float, re.search(r"life of ([\d.]+) years, the young mix ([\d.]+) years", line).groups())
    # The young life is that of mixes of no age on the same parts of the courses.
    alone = run(Case.from_text(AGED.replace("age = 10", "age = 0")), leave_out=("sensitivity",))
    assert young == pytest.approx(alone.life.years("base"), rel=5e-3)  # three digits
    assert old > 1.2 * young
    assert alone.life.warnings == ()
    # The soil lasts longer too, below a stiffer road, and its law knows no age.
    assert "soil: the aged" not in done.output


def test_without_ageing_nothing_is_said(tmp_path):
    assert not any("aged" in text for text in run(Case.from_text(ONE_AXLE + BASE_AND_SOIL)).warnings)
