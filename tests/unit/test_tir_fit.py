"""A solved tire as a Magic Formula: the fit, its refusals, the file that is written, and the command."""

import re
import time
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

import treadload as tl
from cases import belted_truck
from treadload.cli import app
from treadload.errors import InputError, WriteError
from treadload.footprint import magic_formula
from treadload.tire import MagicFormula

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
TRUCK = tl.Tire.from_profile("315/80R22.5", inflation_pressure=800e3, belt=tl.tire.Belt.from_library("315/80R22.5"))
WHEEL = tl.Rolling(normal_load=20e3, friction=0.75)
LOADS = [22e3, 30e3, 38e3]


@pytest.fixture(scope="module")
def fit():
    return magic_formula(TRUCK, ROAD, WHEEL, loads=LOADS[::-1], spacing=25e-3)


def states(tire, count=200):
    rng = np.random.default_rng(34)
    load = tire.nominal_load * rng.uniform(0.3, 1.6, count)
    slip, angle, lean = (rng.uniform(-size, size, count) for size in (0.4, 0.3, 0.1))
    return load, {"slip": slip, "slip_angle": angle, "inclination": lean}


@pytest.mark.slow
def test_curves_are_fitted_and_named(fit):
    # Cells of 25 mm: the curves themselves are coarse.
    assert fit.largest_residual < 0.03
    kinds = [curve.kind for curve in fit.curves]
    assert [kinds.count(kind) for kind in ("along", "across", "combined")] == [3, 3, 6]
    assert fit.undecided == {"PKY4": 2.0}
    assert fit.formula.coefficients["PKY4"] == 2.0
    assert "PKY4 = 2" in fit.summary()
    assert fit.formula.nominal_load == 30e3
    assert fit.formula.unloaded_radius == TRUCK.outer_radius
    assert fit.formula.friction(30e3) == pytest.approx((0.75, 0.75), rel=0.03)


@pytest.mark.slow
def test_residuals_are_those_of_the_curves(fit):
    curve = next(curve for curve in fit.curves if curve.name == "combined at 5°, 38 kN")
    out = fit.formula.forces(38e3, slip=curve.slip, slip_angle=np.radians(5))
    off = np.sqrt(np.mean((out.lateral_force - curve.lateral_force) ** 2)) / 38e3
    assert fit.residuals[curve.name]["lateral_force"] == pytest.approx(off)
    assert (curve.lateral_force < 0).all()
    assert set(fit.residuals) == {curve.name for curve in fit.curves}
    poor = {name for name, values in fit.residuals.items() if max(values.values()) > 0.01}
    assert {name for name in fit.residuals if any(name in text for text in fit.warnings)} == poor


@pytest.mark.slow
def test_slopes_and_deflections_are_those_of_the_solves(fit):
    card = tl.footprint.tire_card(TRUCK, ROAD, [30e3], stiffness=False, spacing=25e-3).dataset
    at = np.interp(30e3, fit.formula.deflection[1], fit.formula.deflection[0])
    # The card rolls on friction of 1, and solves end at 1e-6.
    assert at == pytest.approx(float(card["approach"].squeeze()), rel=1e-5)
    secant = 30e3 / at
    # It stiffens under load, by less than half.
    assert secant < fit.formula.sections["VERTICAL"]["VERTICAL_STIFFNESS"] < 1.5 * secant


@pytest.mark.slow
def test_a_fit_is_drawn(fit):
    figure = tl.plots.tir_fit(fit)
    assert len(figure.axes) == 4
    along = figure.axes[0]
    points = [line.get_ydata() for line in along.get_lines() if line.get_marker() == "o"]
    solved = [curve.tractive_force / curve.normal_load for curve in fit.curves if curve.kind == "along"]
    np.testing.assert_allclose(points, solved)


def invented(signs="ISO"):
    """A 6.1 tire with something everywhere, and with other signs."""
    from test_tir import INVENTED

    tire = MagicFormula.from_file(INVENTED)
    if signs == "adapted SAE":
        turned = {"PKY1": -tire.coefficients["PKY1"]}
        sections = {**tire.sections, "LATERAL_COEFFICIENTS": {**tire.sections["LATERAL_COEFFICIENTS"], **turned}}
        return replace(tire, sections=sections, signs=signs)
    return replace(tire, signs=signs)


@pytest.mark.parametrize("signs", ["ISO", "SAE", "adapted SAE"])
def test_a_written_tire_is_read_back_the_same(signs, tmp_path):
    tire = replace(invented(signs), deflection=np.array([[0.0, 0.01, 0.02], [0.0, 3e3, 7e3]]))
    path = tire.to_file(tmp_path / "again.tir")
    again = MagicFormula.from_file(path)
    assert (again.version, again.signs) == ("6.1", signs)
    load, state = states(tire)
    before, after = tire.forces(load, **state), again.forces(load, **state)
    for name in vars(before):
        np.testing.assert_allclose(getattr(after, name), getattr(before, name), rtol=1e-9, err_msg=name)
    np.testing.assert_array_equal(again.deflection, tire.deflection)
    assert again.nominal_pressure == tire.nominal_pressure
    assert again.to_file(tmp_path / "third.tir").read_text() == path.read_text()


def test_a_written_tire_is_whole_or_not_there(tmp_path, monkeypatch):
    path = tmp_path / "tire.tir"
    invented().to_file(path)
    before = path.read_text()

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.replace", full)
    with pytest.raises((WriteError, OSError)):
        replace(invented(), side="left").to_file(path)
    assert path.read_text() == before
    assert list(tmp_path.iterdir()) == [path]


def test_what_the_format_cannot_hold_is_not_written(tmp_path):
    from test_tir import textbook

    with pytest.raises(InputError, match=r"is of version 5.2: keep its file; written are tires of version 6.1"):
        textbook().to_file(tmp_path / "a.tir")
    with pytest.raises(InputError, match="is mirrored: write the tire itself"):
        invented().mirrored().to_file(tmp_path / "a.tir")
    with pytest.raises(InputError, match=r"\.tir \(a tire property file\)"):
        invented().to_file(tmp_path / "a.txt")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"loads": [20e3, 30e3]}, r"3 loads or more, got 2: .*give such as \[20e3, 27.5e3, 35e3\]"),
        ({"loads": [20e3, 20e3, 30e3]}, "loads must differ"),
        ({"loads": [20e3, -1.0, 30e3]}, "each of the loads must be a positive number of N"),
        ({"reach": 5.0}, "reach must"),
        (
            {"reach": 0.3},
            r"never slides: at a slip of -0.09 \d+ % of the contact slips, .*raise reach above 0.3",
        ),
    ],
)
def test_a_fit_that_the_curves_cannot_decide_is_refused(change, words):
    rolling = replace(WHEEL, friction=2.0)
    with pytest.raises(InputError, match=words):
        magic_formula(TRUCK, ROAD, rolling, **{"loads": LOADS, "spacing": 30e-3, **change})


def test_a_tire_that_leans_or_pulls_is_refused(monkeypatch):
    tire = tl.Tire.from_scan(tl.example_mesh(), camber=np.radians(3), material=tl.Elastic(4e6, 0.45))
    with pytest.raises(InputError, match=r"leans by 3°.*stand it upright"):
        magic_formula(tire, ROAD, WHEEL, loads=LOADS)
    contact = tl.solve_contact(TRUCK, ROAD, replace(WHEEL, creepage_y=0.01), spacing=30e-3)
    monkeypatch.setattr("treadload.footprint.slip_curves.solve_contact", lambda *_, **__: contact)
    with pytest.raises(InputError, match=r"under 22000 N the tire rolls freely at a slip angle of 0.57°"):
        magic_formula(TRUCK, ROAD, WHEEL, loads=LOADS, spacing=30e-3)


@pytest.mark.slow
def test_the_command_writes_and_draws_a_tire(tmp_path):
    case, path, figure = tmp_path / "case.toml", tmp_path / "truck.tir", tmp_path / "truck.png"
    case.write_text(belted_truck("25 mm", 0.75))
    arguments = ["tir", str(case), "--quiet", "-o", str(path), "--figure", str(figure)]
    done = CliRunner().invoke(app, [*arguments, "--loads", "22 kN; 30 kN; 38 kN"])
    assert done.exit_code == 0, done.output
    assert "Magic Formula of a solved tire" in done.output
    assert re.search(r"across, 30 kN +– +\d\.\d\d +\d\.\d\d", done.output)
    again = MagicFormula.from_file(path)
    assert again.nominal_load == 30e3
    assert figure.stat().st_size > 10_000


def test_the_command_refuses_before_it_solves(tmp_path):
    case = tmp_path / "case.toml"
    case.write_text(belted_truck("25 mm", 0.75))
    for more, words in (
        (["--loads", "20 kN; 30 kN"], "3 loads or more, got 2"),
        (["--loads", "20 kN; 30 kN; 40 kN", "-o", str(tmp_path / "a.nc")], "tire property file"),
        (["--loads", "20 bar"], "20 bar"),
    ):
        done = CliRunner().invoke(app, ["tir", str(case), "--quiet", *more])
        assert done.exit_code == 2, done.output
        assert words in done.output


@pytest.mark.slow
def test_the_catalogued_tire_is_fitted_within_a_percent_in_a_minute(tmp_path):
    start = time.process_time()
    fit = magic_formula(TRUCK, ROAD, WHEEL, loads=[20e3, 27.5e3, 35e3, 42.5e3], spacing=6e-3)
    assert time.process_time() - start < 60
    assert fit.largest_residual < 0.01
    again = MagicFormula.from_file(fit.formula.to_file(tmp_path / "truck.tir"))
    load, state = states(again)
    before, after = fit.formula.forces(load, **state), again.forces(load, **state)
    for name in ("tractive_force", "lateral_force", "aligning_moment"):
        np.testing.assert_allclose(getattr(after, name), getattr(before, name), rtol=1e-9, atol=1e-9 * 35e3)
