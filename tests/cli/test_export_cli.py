"""`treadload export`, `cite` and `as-python`."""

import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

import treadload as tl
from cases import COARSE_CASE
from treadload.cli import app
from treadload.templates import first_case


@pytest.fixture(scope="module")
def result(coarse_result, tmp_path_factory):
    return tl.save_results(coarse_result, tmp_path_factory.mktemp("results") / "coarse.nc")


def call(*arguments):
    return CliRunner().invoke(app, [str(one) for one in arguments])


@pytest.mark.parametrize("name", ["c.vts", "r.vtr", "c.vtu", "c.dat", "all.csv", "all.xlsx"])
def test_a_result_is_exported_by_the_suffix(result, tmp_path, name):
    done = call("export", result, "-o", tmp_path / name)
    assert done.exit_code == 0, done.output
    assert "written: " in done.output
    assert list(tmp_path.iterdir())


def test_discs_are_printed_and_written(result, tmp_path):
    done = call("export", result, "-o", tmp_path / "discs.csv", "--discs", 3)
    assert done.exit_code == 0, done.output
    assert "Uniform discs: 3" in done.output
    assert "discs over radius" in done.output
    assert len((tmp_path / "discs.csv").read_text().splitlines()) == 4


def test_what_cannot_be_exported_is_told_in_a_sentence(result, tmp_path):
    for arguments, words in (
        (("-o", tmp_path / "x.stl"), "cannot write results to"),
        (("-o", tmp_path / "x.vtu", "--part", "tyre"), "has no part 'tyre'"),
        (("-o", tmp_path / "x.dat", "--units", "psi"), "got 'psi'"),
        (("-o", tmp_path / "x.vts", "--part", "response"), r"write a response as .vtr or .vtu"),
    ):
        done = call("export", result, *arguments)
        assert done.exit_code == 2
        assert words in " ".join(done.output.split())
    assert not list(tmp_path.iterdir())


def test_cite_names_the_methods_of_a_result_a_case_a_tire_or_the_program(result, tmp_path):
    case = tmp_path / "case.toml"
    case.write_text(COARSE_CASE, encoding="utf-8")
    # A road of mixes, which has no temperature before its seasons.
    design = tmp_path / "design.toml"
    design.write_text(first_case("life"), encoding="utf-8")
    tire = Path(__file__).parents[1] / "data" / "tir" / "invented_6_1.tir"
    wanted = {(tire,): {"pacejka2012", "besselink2010"}, (): {"treadload", "materials2021"},
              (result,): {"kalker1990", "love1929"}, (case,): {"kalker1990"},
              (design,): {"kalker1990", "miner1945"}}  # fmt: skip
    for source, keys in wanted.items():
        done = call("cite", *source)
        assert done.exit_code == 0, done.output
        assert keys <= set(re.findall(r"^@\w+\{(.+),$", done.output, re.M))
    done = call("cite", result, "-o", tmp_path / "used.bib")
    assert done.exit_code == 0
    # The solver never split its operators here: the reference of that is not among those used.
    used = (tmp_path / "used.bib").read_text(encoding="utf-8")
    assert ("lions1979" in used) == bool(tl.open_results(result).contact.stats.get("splitting_iterations"))


def test_a_case_is_printed_as_python(tmp_path):
    case = tmp_path / "case.toml"
    case.write_text(COARSE_CASE, encoding="utf-8")
    done = call("as-python", case, "--set", "rolling.friction=0.6")
    assert done.exit_code == 0, done.output
    compile(done.output, "case.py", "exec")
    assert "friction=0.6" in done.output
    assert call("as-python", case, "-o", tmp_path / "case.py").exit_code == 0
    assert "solve_contact" in (tmp_path / "case.py").read_text(encoding="utf-8")
