"""Cases of a body that dents its road: pressed into it, or rolled over its own track; run, kept, refused."""

import tomllib

import jsonschema
import numpy as np
import pytest
from typer.testing import CliRunner

import treadload as tl
from treadload.case.schema import json_schema
from treadload.cli import app
from treadload.steps import run

BALL = """
title = "A ball on soft ground"
[tire]
profile = { rolling_radius = "1 m", crown_radius = "1 m", width = "60 mm" }
material = { modulus = "210 GPa", poisson = 0.3 }
[[pavement.layers]]
name = "soft"
material = { modulus = "100 MPa", poisson = 0.35 }
plasticity = { kind = "von-mises", yield_stress = "0.4 MPa", hardening = "20 MPa" }
"""
PRESSED = f'{BALL}[indentation]\nloads = ["640 N", "0 N"]\nspacing = "4 mm"\nlayers = 6\n'
ROLLED = f'{BALL}[drum]\nload = "640 N"\npasses = 1\nspacing_along = "3 mm"\nspacing_across = "4 mm"\nlayers = 4\n'


def case(text):
    return tl.Case.from_text(text)


@pytest.mark.parametrize("text", [PRESSED, ROLLED])
def test_the_schema_knows_the_tables_and_the_case_comes_back(text):
    assert list(jsonschema.Draft202012Validator(json_schema("run")).iter_errors(tomllib.loads(text))) == []
    made = case(text)
    assert tl.Case.from_text(made.to_toml()) == made


def ran(text, folder):
    """What `treadload run` writes, opened."""
    (folder / "case.toml").write_text(text)
    done = CliRunner().invoke(app, ["run", str(folder / "case.toml"), "-o", str(folder / "r.nc"), "-q"])
    assert done.exit_code == 0, done.output
    opened = tl.open_results(folder / "r.nc")
    assert opened.case == case(text)
    assert "Jacq" in opened.tree.attrs["citations"]
    return opened


def test_a_case_presses_its_body_and_a_report_shows_it(tmp_path):
    opened = ran(PRESSED, tmp_path)
    assert list(opened) == ["indentation"]
    made = case(PRESSED)
    same = tl.contact.solve_indentation(made.build_tire(), made.build_road(), [640.0, 0.0], spacing=4e-3, layers=6)
    np.testing.assert_array_equal(
        opened.indentation.dataset.residual_displacement_z, same.dataset.residual_displacement_z
    )
    assert float(same.dataset.residual_displacement_z[1].max()) > 0
    assert opened.indentation.summary() == same.summary()
    assert same.summary() in opened.summary()
    page = tl.report(opened, tmp_path / "r.html").read_text()
    assert "Indentation" in page
    assert "could not be drawn" not in page


@pytest.mark.slow
def test_a_case_rolls_its_drum_and_a_report_shows_it(tmp_path):
    opened = ran(ROLLED, tmp_path)
    assert list(opened) == ["passes"]
    assert opened.passes.summary() == run(case(ROLLED)).passes.summary()
    page = tl.report(opened, tmp_path / "r.html").read_text()
    assert "oad that yields" in page
    assert "could not be drawn" not in page


def test_a_dry_run_tells_what_would_be_solved():
    assert "2 step(s), 640, 0 N" in tl.plan(case(PRESSED))
    assert "at most 1 pass(es)" in tl.plan(case(ROLLED))


@pytest.mark.parametrize(
    ("text", "old", "new", "words"),
    [
        (PRESSED, '["640 N", "0 N"]', "[]", "loads must be forces >= 0 N with one above"),
        (PRESSED, '["640 N", "0 N"]', '["-1 N"]', "loads must be forces >= 0 N with one above"),
        (PRESSED, "layers = 6", "layers = 1", r"layers must lie in \[2, 64\], got 1; 14 is the default"),
        (PRESSED, "layers = 6", "tolerance = 1", r"tolerance must lie in \[1e-6, 0.1\], got 1; 0.001"),
        (PRESSED, "[indentation]", '[damage]\nfatigue = { epsilon_6 = 1e-4, slope = -0.2 }\n[indentation]',
         "leave out damage"),
        (PRESSED, 'name = "soft"', 'thickness = "5 cm"\nmaterial = { modulus = "1 GPa", poisson = 0.3 }\n'
         "[[pavement.layers]]", "a road of 2 layers cannot be dented yet"),
        (PRESSED, "[indentation]", "[drum]\nload = 1\n[indentation]", "leave out drum"),
        (PRESSED, 'plasticity = { kind = "von-mises", yield_stress = "0.4 MPa", hardening = "20 MPa" }', "",
         r"\[indentation\] needs a layer that can yield"),
        (PRESSED, '[tire]\nprofile = { rolling_radius = "1 m", crown_radius = "1 m", width = "60 mm" }\n'
         'material = { modulus = "210 GPa", poisson = 0.3 }', "", "'tire' is missing: the body of"),
        (ROLLED, '"640 N"', '"0 N"', "load must be a positive number of N"),
        (ROLLED, "passes = 1", "passes = 0", "passes must be >= 1, got 0"),
        (ROLLED, 'spacing_along = "3 mm"', "", "give spacing_along and spacing_across, or none"),
    ],
)  # fmt: skip
def test_a_wrong_case_is_refused_in_a_sentence(text, old, new, words):
    assert old in text
    with pytest.raises(tl.InputError, match=words) as caught:
        case(text.replace(old, new, 1))
    assert len(str(caught.value).splitlines()) == 1


def test_a_case_has_one_source_and_no_rolling_state_but_that_of_a_wheel():
    rolling = "[rolling]\nnormal_load = 100\nfriction = 0.5\n"
    wheel = case(PRESSED.split("[indentation]")[0] + rolling)
    sources = [described.source.name for described in (case(PRESSED), case(ROLLED), wheel)]
    assert sources == ["indentation", "drum", "contact"]
    for more, name in ((rolling, "rolling"), (ROLLED[ROLLED.index("[drum]") :], "drum")):
        with pytest.raises(tl.InputError, match=rf"\[indentation\] replaces .* leave out {name}"):
            case(PRESSED + more)
    for text, name in ((PRESSED, "indentation"), (ROLLED, "drum")):
        with pytest.raises(tl.InputError, match=rf"has \[{name}\] and no rolling state"):
            case(text).build_rolling()
    assert wheel.build_rolling().normal_load == 100
