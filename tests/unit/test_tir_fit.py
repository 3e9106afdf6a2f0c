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
from treadload.contact import solve_transient
from treadload.errors import InputError, WriteError
from treadload.footprint import magic_formula
from treadload.materials import Prony
from treadload.tire import MagicFormula

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
TRUCK = tl.Tire.from_profile("315/80R22.5", inflation_pressure=800e3, belt=tl.tire.Belt.from_library("315/80R22.5"))
WHEEL = tl.Rolling(normal_load=20e3, friction=0.75)
LOADS = [22e3, 30e3, 38e3]
CAR = tl.Tire.from_profile("205/60R15", inflation_pressure=220e3, belt=tl.tire.Belt.from_library("205/60R15"))


@pytest.fixture(scope="module")
def fit():
    return magic_formula(TRUCK, ROAD, WHEEL, loads=LOADS[::-1], pressures=[700e3, 900e3], spacing=25e-3)


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
    assert [kinds.count(kind) for kind in ("along", "across", "combined")] == [9, 9, 6]
    assert {"PKY4", "BREFF"} <= set(fit.undecided)
    for name, value in fit.undecided.items():
        assert f"{name} = {value:g}" in fit.summary()
        assert {**fit.formula.sections["VERTICAL"], **fit.formula.coefficients}[name] == value
    absent = {name for names in fit.not_fitted.values() for name in names}
    assert {"PDY3", "PHY1", "RVY1", "QSX1", "QSY1"} <= absent
    assert not absent & {"PPX1", "PPX2", "PPY1", "PPZ1", "PFZ1"}
    assert all(fit.formula.coefficients[name] == 0 for name in absent if name not in ("QSY7",))
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
    assert {name for name in fit.residuals if any(f" of {name} is fitted" in text for text in fit.warnings)} == poor


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
def test_inflation_pressures_have_curves_and_coefficients(fit):
    c = fit.formula.coefficients
    # A softer tire has a longer footprint, and slips less under the same force.
    soft, hard = (
        fit.formula.forces(30e3, slip=0.005, slip_angle=0.005, inflation_pressure=pressure)
        for pressure in (700e3, 900e3)
    )
    assert soft.tractive_force > hard.tractive_force
    assert c["PPX1"] < 0
    assert any(name.startswith("along") and name.endswith(", 900 kPa") for name in fit.residuals)
    assert fit.formula.sections["INFLATION_PRESSURE_RANGE"] == {"PRESMIN": 700e3, "PRESMAX": 900e3}
    assert fit.formula.nominal_pressure == 800e3


@pytest.mark.slow
def test_radii_and_standing_stiffnesses_are_those_of_the_solves(fit):
    assert fit.state_residuals.keys() == {
        "approach", "effective_rolling_radius", "fore_aft_stiffness", "lateral_stiffness",
    }  # fmt: skip
    assert max(fit.state_residuals.values()) < 0.03
    assert len(fit.states) == 9
    for state in fit.states:
        out = fit.formula.free_rolling(state.normal_load, inflation_pressure=state.inflation_pressure)
        assert out.deflection == pytest.approx(state.deflection, rel=0.02)
        assert out.effective_rolling_radius == pytest.approx(state.effective_rolling_radius, rel=2e-3)
    card = tl.footprint.tire_card(TRUCK, ROAD, [30e3], spacing=25e-3).dataset.squeeze()
    middle = next(state for state in fit.states if (state.normal_load, state.inflation_pressure) == (30e3, 800e3))
    # The card has the same definitions; its wheel rolls on friction of 1.
    assert middle.lateral_stiffness == pytest.approx(float(card["lateral_stiffness"]), rel=1e-4)
    assert middle.effective_rolling_radius == pytest.approx(float(card["effective_rolling_radius"]), rel=1e-4)
    relaxation = fit.formula.free_rolling(30e3).relaxation_length_y
    # The slope at zero slip of curves that start at half a degree, on cells of 25 mm.
    assert relaxation == pytest.approx(float(card["relaxation_length"]), rel=0.15)


@pytest.mark.slow
def test_a_step_of_the_slip_angle_takes_the_relaxation_length(fit):
    # Steps of half a cell; the area between the force and its end is the relaxation length of a first-order lag.
    distance = np.arange(1, 161) * 12.5e-3
    free = float(tl.solve_contact(TRUCK, ROAD, replace(WHEEL, normal_load=30e3), spacing=25e-3).dataset.creepage_x)
    wheel = replace(WHEEL, normal_load=30e3, creepage_x=free, creepage_y=1e-3)
    force = solve_transient(TRUCK, ROAD, wheel, distances=distance, spacing=25e-3).dataset["lateral_force"]
    lag = np.trapezoid(1 - force.to_numpy() / float(force[-1]), np.concatenate([[0.0], distance]))
    assert fit.formula.free_rolling(30e3).relaxation_length_y == pytest.approx(lag, rel=0.1)


def test_a_viscoelastic_tread_resists_rolling():
    from treadload.footprint.free_states import FreeState
    from treadload.footprint.tir_sections import fit_sections

    # Invented: 0.8 % of the load at 4 kN and 220 kPa, powers 0.9 of the load and -0.4 of the pressure.
    states = [
        FreeState(
            load, pressure, 0.02 * load / 4e3 * 220e3 / pressure, 0.305, 3e5, 1e5,
            0.008 * 4e3 * 0.313 * (load / 4e3) ** 0.9 * (pressure / 220e3) ** -0.4,
        )
        for pressure, loads in ((220e3, (3e3, 4e3, 5e3)), (200e3, (4e3,)))
        for load in loads
    ]  # fmt: skip
    rolling = fit_sections(states, 4e3, 0.313, 220e3).rolling
    assert rolling == pytest.approx({"QSY1": 0.008, "QSY7": 0.9, "QSY8": -0.4}, rel=1e-9)


@pytest.mark.slow
def test_rolling_resistance_is_that_of_the_solve():
    from treadload.footprint.free_states import free_state
    from treadload.footprint.tir_sections import fit_sections

    belt = replace(TRUCK.belt, tread=Prony(8e6, ((0.3, 2e-3),), poisson=0.47))
    tire, radius = replace(TRUCK, belt=belt), TRUCK.outer_radius
    wheel = replace(WHEEL, speed=10.0)
    states = []
    for load in LOADS:
        contact = tl.solve_contact(tire, ROAD, replace(wheel, normal_load=load), spacing=25e-3)
        states.append(free_state(tire, ROAD, load, contact, radius, 25e-3))
    fit = fit_sections(states, 30e3, radius, 800e3)
    # The footprint is six cells long, and the moment is the small difference of its halves.
    assert fit.residuals["rolling_resistance_moment"] < 0.1
    c = fit.rolling
    for state in states:
        moment = radius * 30e3 * c["QSY1"] * (state.normal_load / 30e3) ** c["QSY7"]
        assert moment == pytest.approx(state.resisting_moment, rel=0.15)
    # A few thousandths of the load, as of a truck tire; it stands on rubber that has relaxed.
    assert 1e-3 < c["QSY1"] < 2e-2
    relaxed = replace(tire, belt=replace(belt, tread=belt.tread.rubbery))
    card = tl.footprint.tire_card(relaxed, ROAD, [30e3], spacing=25e-3).dataset.squeeze()
    assert states[1].lateral_stiffness == pytest.approx(float(card["lateral_stiffness"]), rel=1e-4)


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
        ({"pressures": [0.0]}, "each of the pressures must be a positive number of Pa"),
        ({"pressures": [700e3, 700e3]}, "pressures must differ"),
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


def test_pressures_of_a_tire_that_does_not_feel_them_are_refused():
    tire = tl.Tire.from_profile("315/80R22.5", material=tl.Elastic(3e6, 0.47), inflation_pressure=800e3)
    with pytest.raises(InputError, match=r"whatever its inflation, so that 2 pressures .* leave pressures out"):
        magic_formula(tire, ROAD, WHEEL, loads=LOADS, pressures=[7e5, 9e5])


def test_a_coefficient_that_the_curves_leave_open_is_fixed_and_named():
    from treadload.footprint.slip_curves import SlipCurve
    from treadload.footprint.tir_coefficients import ALONG, Draft

    made = {"PCX1": 1.4, "PDX1": 0.8, "PDX2": -0.05, "PKX1": 14.0, "PEX1": -0.6, "PKX3": -0.2}
    slip = np.linspace(-0.25, 0.25, 21)
    draft = Draft(4e3, 0.3, None)

    def curve(load):
        draft.values.update(dict.fromkeys(ALONG, 0.0) | made)
        none = np.zeros(slip.size)
        empty = SlipCurve("along", load, slip, none, none, none, none, none)
        force = load * draft._remainder([empty], ["tractive_force"])({})
        return replace(empty, tractive_force=force)

    curves = [curve(load) for load in (3e3, 4e3, 5e3)]
    draft = Draft(4e3, 0.3, None)
    draft.fit(ALONG, curves, ["tractive_force"])
    found = {name: draft.values[name] for name in made if name not in draft.undecided}
    # PKX2 and PKX3 are nearly the same over these loads: one of them is left.
    assert {"PHX1", "PHX2", "PVX1", "PVX2", "PEX4"} <= set(draft.undecided)
    assert all(draft.values[name] == value for name, value in draft.undecided.items())
    for name in ("PCX1", "PDX1", "PDX2", "PKX1"):
        assert found[name] == pytest.approx(made[name], rel=0.02, abs=2e-3)
    left = draft._remainder(curves, ["tractive_force"])(draft.values)
    assert np.sqrt(np.mean(left**2)) < 2.1e-5


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
@pytest.mark.parametrize(
    ("tire", "friction", "loads", "pressures", "spacing"),
    [
        (TRUCK, 0.75, [20e3, 27.5e3, 35e3, 42.5e3], [700e3, 900e3], 6e-3),
        (CAR, 0.8, [2.75e3, 3.5e3, 4e3, 4.5e3], [205e3, 235e3], 4e-3),
    ],
)
def test_tires_of_the_catalogue_are_fitted_within_a_percent_in_a_minute(
    tire, friction, loads, pressures, spacing, tmp_path
):
    start = time.process_time()
    rolling = replace(WHEEL, friction=friction)
    fit = magic_formula(tire, ROAD, rolling, loads=loads, pressures=pressures, spacing=spacing)
    assert time.process_time() - start < 60
    assert fit.largest_residual < 0.01
    again = MagicFormula.from_file(fit.formula.to_file(tmp_path / "tire.tir"))
    load, state = states(again)
    before, after = fit.formula.forces(load, **state), again.forces(load, **state)
    for name in ("tractive_force", "lateral_force", "aligning_moment"):
        np.testing.assert_allclose(getattr(after, name), getattr(before, name), rtol=1e-9, atol=1e-9 * loads[-1])
