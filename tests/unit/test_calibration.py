"""Calibration: numbers of a tire from readings of another that is known, their error bars, what cannot be told."""

import json
from dataclasses import replace

import numpy as np
import pytest

import treadload as tl
from treadload.calibration.extents import covered, extents
from treadload.calibration.fit import STEEL, calibrate
from treadload.calibration.problem import Model, Problem
from treadload.case import Case
from treadload.footprint import Measured, Unknown
from treadload.grid import Grid
from treadload.identifiability import undecided_in_words
from treadload.steps import run
from treadload.templates import first_case
from treadload.tire.numbers import NUMBERS

TIRE = tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3, belt=tl.tire.Belt.from_library("315/80R22.5"))
TRUE = {"foundation": 3.9, "crown_radius": 1.75}
COARSE = 12e-3
LOADS = (15e3, 30e3, 45e3)
ERRORS = {"deflection": 0.005, "length": 0.01, "spread_y": 0.005}


def changed(tire, values):
    for name, value in values.items():
        tire = NUMBERS[name].put(tire, value)
    return tire


def model_of(tire, rows, spacing=COARSE):
    return Model(Problem(tire, tl.Pavement.half_space(STEEL), (), tuple(rows), 0.7, {}, spacing, 1e-8))


def readings_of(tire, rows, spacing=COARSE):
    model = model_of(tire, rows, spacing)
    return [model.readings((), row) for row in range(len(rows))]


@pytest.fixture(scope="module")
def exact():
    """What the true tire reads."""
    rows = [Measured(load=load, deflection=1.0, length=1.0, spread_y=1.0) for load in LOADS]
    return readings_of(changed(TIRE, TRUE), rows)


def data_of(exact, random=None):
    """Rows of data, with noise from a generator."""
    rows = []
    for load, values in zip(LOADS, exact, strict=True):
        noise = 1 + np.array(list(ERRORS.values())) * (0 if random is None else random.normal(size=3))
        told = dict(zip(ERRORS, values * noise, strict=True))
        rows.append(Measured(load=load, **told, errors={name: f"{100 * part} %" for name, part in ERRORS.items()}))
    return rows


@pytest.fixture(scope="module")
def fitted(exact, tmp_path_factory):
    state = tmp_path_factory.mktemp("fit") / "state.json"
    told = []
    found = calibrate(
        TIRE, list(TRUE), data_of(exact, np.random.default_rng(3)), spacing=COARSE, state=state,
        progress=lambda *now: told.append(now),
    )  # fmt: skip
    return found, state, told


def test_exact_readings_give_back_the_numbers(exact, fitted):
    """The search ends where numbers change by a millionth; slopes are forward differences and bend it no more."""
    found = calibrate(TIRE, list(TRUE), data_of(exact), spacing=COARSE, state=fitted[1])
    for name, value in TRUE.items():
        assert found.value(name) == pytest.approx(value, rel=1e-4)
    assert found.tire == changed(TIRE, {name: found.value(name) for name in TRUE})
    assert found.before == TIRE
    assert not found.undecided
    assert not found.warnings


def test_noise_moves_the_numbers_within_their_error_bars(fitted):
    found, _, _ = fitted
    for name, value in TRUE.items():
        low, high = found.interval(name, 0.999)
        assert low < value < high
        assert abs(found.value(name) / value - 1) < 0.05
    # Nine readings with these errors tell both to about a percent: see the hundred trials.
    assert found.standard_deviation("foundation") / 3.9 == pytest.approx(0.0105, rel=0.1)
    assert found.standard_deviation("crown_radius") / 1.75 == pytest.approx(0.015, rel=0.15)
    assert float(found.dataset["number_correlation"][0, 1]) == pytest.approx(
        float(found.dataset["number_correlation"][1, 0])
    )
    assert found.dataset.attrs["degrees_of_freedom"] == 7


def test_deviations_are_those_of_the_linear_model(fitted):
    """Against the textbook's (JᵀJ)⁻¹ of central differences of the solver at the fit, steps ten times as long."""
    found, _, _ = fitted
    model = model_of(TIRE, found.data)

    def all_readings(values):
        model.problem.__dict__["tire"] = changed(TIRE, dict(zip(TRUE, values, strict=True)))
        return np.concatenate([model.readings((), row) for row in range(3)])

    at = np.array([found.value(name) for name in TRUE])
    steps = 0.02 * np.diag(at)
    slopes = np.array([(all_readings(at + h) - all_readings(at - h)) / (2 * h.sum()) for h in steps]).T
    weighted = slopes / found.dataset["reading_error"].to_numpy()[:, None]
    deviations = np.sqrt(np.diag(np.linalg.inv(weighted.T @ weighted)))
    told = [found.standard_deviation(name) for name in TRUE]
    # Forward steps of 1 % and central ones of 2 % differ by the curvature of the readings.
    assert told == pytest.approx(deviations, rel=0.05)


@pytest.mark.slow
def test_stated_intervals_cover_the_truth(exact, tmp_path):
    """A hundred fits to noise: 95 % intervals hold the truth in 88 to 99 of them, and both numbers come within 5 %.

    By chance alone 95 of 100 scatter by 2.2. Fits share what was solved at their common start, and nothing else.
    """
    random = np.random.default_rng(7)
    hits = dict.fromkeys(TRUE, 0)
    for _ in range(100):
        found = calibrate(TIRE, list(TRUE), data_of(exact, random), spacing=COARSE, state=tmp_path / "state.json")
        for name, value in TRUE.items():
            low, high = found.interval(name)
            hits[name] += low <= value <= high
            assert abs(found.value(name) / value - 1) < 0.05
    assert all(88 <= count <= 99 for count in hits.values()), hits


def test_a_standing_tire_is_that_of_the_contact_solver():
    """The same pressure as `solve_contact` without friction on its own grid, to the tolerance."""
    row = Measured(load=30e3, deflection=1.0)
    contact = tl.solve_contact(
        TIRE,
        tl.Pavement.half_space(STEEL),
        tl.Rolling(normal_load=30e3, friction=0.0),
        spacing=COARSE,
        tolerance=1e-8,
    )
    assert readings_of(TIRE, [row])[0][0] == pytest.approx(float(contact.dataset["approach"]), rel=1e-7)


def test_extents_lie_between_the_cells():
    """A paraboloid on a half-space: the area of the circle, which cells miss by their edge, and its slope."""
    x = (np.arange(41) - 20) * 1e-3
    grid = np.hypot(*np.meshgrid(x, x))

    def area(radius):
        # Means over cells of Hertz's pressure, by 15 points a side.
        fine = (np.arange(41 * 15) - (41 * 15 - 1) / 2) * 1e-3 / 15
        at = np.hypot(*np.meshgrid(fine, fine))
        pressure = np.sqrt(np.maximum(1 - (at / radius) ** 2, 0.0)).reshape(41, 15, 41, 15).mean(axis=(1, 3))
        return extents(pressure, x, x, 1e-3, 1e-3)

    radii = np.linspace(14e-3, 15e-3, 11)
    told = [area(radius) for radius in radii]
    for radius, one in zip(radii, told, strict=True):
        # A tenth of a cell of the radius.
        assert one.net_area == pytest.approx(np.pi * radius**2, rel=0.02)
        assert one.length == pytest.approx(2 * radius, abs=0.3e-3)
        assert one.width == pytest.approx(one.length, rel=1e-9)
    # It grows at every step, where the count of cells stands still or jumps.
    slopes = np.diff([one.net_area for one in told]) / np.diff(np.pi * radii**2)
    assert slopes.min() > 0.5
    assert slopes.max() < 1.5
    assert (covered(np.ones((3, 3))) == 1).all()
    assert grid.shape == (41, 41)


def test_what_the_data_cannot_tell_is_said(exact):
    """Deflections feel neither bending nor, beside the foundation, the modulus and the crown."""
    rows = [Measured(load=load, deflection=values[0]) for load, values in zip(LOADS, exact, strict=True)]
    rows.append(Measured(load=20e3, deflection=0.0212))
    found = calibrate(
        TIRE,
        ["foundation", Unknown("bending_twist", low=50.0, high=300.0)],
        rows,
        spacing=16e-3,
        errors={"deflection": 1e-4},
    )
    said = " ".join(found.undecided)
    assert "these data leave bending_twist undecided" in said
    assert "foundation" not in said
    assert found.standard_deviation("foundation") < 0.02 * found.value("foundation")
    assert said in found.summary()


def test_directions_in_words():
    turned = np.array([[0.8, -0.6], [0.6, 0.8]])
    said = undecided_in_words(["modulus", "bending_along"], np.array([100.0, 0.5]), turned, 1.0)
    assert said == [
        "these data leave bending_along and modulus undecided: changing bending_along by +160 %, modulus by +120 % "
        "moves the readings by no more than their errors"
    ]
    assert undecided_in_words(["arm"], np.array([1.0]), np.eye(1), 1.0) == [
        "these data leave arm undecided: its standard deviation is 100 % of it"
    ]
    assert "no reading depends on it" in undecided_in_words(["arm"], np.array([0.0]), np.eye(1), 1.0)[0]
    assert not undecided_in_words(["arm"], np.array([2.1]), np.eye(1), 1.0)


def test_a_fit_at_its_bound_and_data_at_odds_are_told(exact):
    found = calibrate(
        TIRE, [Unknown("foundation", start=3.5, high="3.7 1/m"), "crown_radius"], data_of(exact), spacing=16e-3
    )
    told = " ".join(found.warnings)
    assert "foundation ended at its bound of 3.7 1/m: the data want it higher still" in told
    assert "they contradict each other or the model" in told
    assert np.isnan(found.standard_deviation("foundation"))
    assert np.isfinite(found.standard_deviation("crown_radius"))
    assert "not determined" in found.summary()


def test_without_errors_the_scatter_tells_them(exact):
    """Customary errors weigh the readings; a common factor of all leaves the error bars where they are."""
    rows = [replace(one, errors=None) for one in data_of(exact, np.random.default_rng(1))]
    found = calibrate(TIRE, "foundation", rows, spacing=16e-3)
    d = found.dataset
    scatter = float(np.sqrt((d["residual"] ** 2).sum() / 8))
    assert d.attrs["scatter"] == pytest.approx(scatter)
    slope = d["reading_slope"].to_numpy()[:, 0]
    assert found.standard_deviation("foundation") / found.value("foundation") == pytest.approx(
        scatter / np.linalg.norm(slope), rel=1e-6
    )
    low, high = found.interval("foundation")
    # Student's with 8 degrees of freedom.
    assert (high - low) / 2 == pytest.approx(2.306 * found.standard_deviation("foundation"), rel=1e-3)


def test_a_search_goes_on_from_its_state(exact, fitted):
    found, state, told = fitted
    assert told[-1][0] == found.stats["contacts"] == len(told)
    assert all(done <= of and what == "contact" for done, of, what in told)
    again = calibrate(TIRE, list(TRUE), found.data, spacing=COARSE, state=state)
    assert again.stats["contacts"] == 0
    assert again.stats["contacts_from_state"] >= found.stats["contacts"]
    np.testing.assert_array_equal(again.dataset["fitted_value"], found.dataset["fitted_value"])
    with pytest.raises(tl.InputError, match="belongs to another calibration"):
        calibrate(TIRE, list(TRUE), found.data, spacing=14e-3, state=state)
    broken = state.with_name("broken.json")
    broken.write_text(json.dumps({"calibration": "x"})[:-3])
    with pytest.raises(tl.InputError, match="remove it to start again"):
        calibrate(TIRE, list(TRUE), found.data, spacing=COARSE, state=broken)


def test_an_error_on_the_way_leaves_what_was_found(exact, tmp_path):
    state = tmp_path / "state.json"

    def stop(done, of, what):
        if done == 5:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        calibrate(TIRE, list(TRUE), data_of(exact), spacing=16e-3, state=state, progress=stop)
    assert len(json.loads(state.read_text())["points"]) == 5


@pytest.mark.parametrize("count", [4, 7])
def test_a_search_cut_anywhere_ends_with_the_same_digits(fitted, tmp_path, count):
    found, state, _ = fitted
    told = json.loads(state.read_text())
    cut = tmp_path / "cut.json"
    cut.write_text(json.dumps({**told, "points": told["points"][:count]}))
    again = calibrate(TIRE, list(TRUE), found.data, spacing=COARSE, state=cut)
    assert again.stats["contacts_from_state"] == count
    assert again.dataset.equals(found.dataset)


def test_a_reading_does_not_depend_on_those_before_it(exact):
    """A contact that starts from the one before differs by its tolerance, 1e-8, and slopes by more."""
    rows = [Measured(load=load, deflection=1.0, length=1.0, spread_y=1.0) for load in LOADS]
    problem = replace(model_of(TIRE, rows).problem, sought=tuple(Unknown(name) for name in TRUE))
    points = [(3.9, 1.75), (2.0, 1.2), (6.0, 2.4)]
    model = Model(problem)
    there = [model.readings(point, 1) for point in points]
    for point, values in zip(points, there, strict=True):
        np.testing.assert_array_equal(Model(problem).readings(point, 1), values)
    for point, values in reversed(list(zip(points, there, strict=True))):
        np.testing.assert_array_equal(model.readings(point, 1), values)


@pytest.mark.slow
def test_processes_find_the_same(fitted):
    """To the last digit, whichever process solves which contact."""
    found, _, _ = fitted
    beside = calibrate(TIRE, list(TRUE), found.data, spacing=COARSE, jobs=2)
    assert beside.dataset.equals(found.dataset)


ROW = Measured(load=30e3, deflection=0.03)


@pytest.mark.parametrize(
    ("sought", "data", "more", "word"),
    [
        (["foundatoin"], [ROW], {}, "did you mean 'foundation'"),
        (["foundation", "crown_radius"], [ROW], {}, "1 readings cannot determine 2 numbers"),
        ([], [ROW], {}, "needs something to seek"),
        (["arm", "arm"], [ROW], {}, "arm is sought twice"),
        (["camber"], [ROW], {}, "this tire has no camber"),
        (["friction"], [ROW], {}, "no reading knows of it"),
        ([Unknown("arm", start="25 mm")], [ROW], {}, "outside its bounds 0 to 0.02"),
        ([Unknown("arm", low="5 mm", high="4 mm")], [ROW], {}, "leaves nothing"),
        (["belt_radius"], [ROW], {}, "starts at inf"),
        (["foundation"], [], {}, "needs data|cannot determine"),
        (["foundation"], [ROW], {"errors": {"deflecton": 1e-3}}, "did you mean 'deflection'"),
        (["foundation"], [ROW], {"errors": {"deflection": -1e-3}}, "error of deflection must be a positive"),
        (["foundation"], [ROW], {"jobs": 0}, "jobs must be a whole number"),
        (["foundation"], [ROW], {"tolerance": 1e-3}, "slopes need 1e-8"),
        (["foundation"], [ROW], {"spacing": -1.0}, "spacing must be a positive number"),
    ],
)
def test_a_question_without_an_answer_is_refused(sought, data, more, word):
    with pytest.raises(tl.InputError, match=word):
        calibrate(TIRE, sought, data, **more)


@pytest.mark.parametrize(
    ("told", "word"),
    [
        ({"load": 30e3}, "needs a reading"),
        ({"deflection": 0.03}, "needs its load"),
        ({"load": 30e3, "deflection": -0.03}, "deflection of the data must be a positive"),
        ({"load": 30e3, "deflection": 0.03, "inflation_pressure": 8.2}, "not kPa or bar"),
        ({"load": 30e3, "rib_shares": (0.5, 0.5)}, "go together"),
        ({"load": 30e3, "rib_shares": (0.5, 0.4), "ribs": (-0.1, 0.0, 0.1)}, "a sum of 0.9"),
        ({"load": 30e3, "rib_shares": (0.5, 0.5), "ribs": (-0.1, 0.1)}, "one edge more"),
        ({"load": 30e3, "tractive_force": 1e3}, "give the creepage"),
        ({"load": 30e3, "deflection": 0.03, "creepage_x": 0.01}, "no force was given"),
        ({"load": 30e3, "deflection": 0.03, "errors": {"length": 1e-3}}, "has no reading"),
    ],
)
def test_a_row_that_cannot_be_is_refused(told, word):
    with pytest.raises(tl.InputError, match=word):
        Measured(**told)


def test_every_number_of_a_tire_is_read_and_put():
    lateral = replace(TIRE, belt=replace(TIRE.belt, belt_radius=0.8, arm=0.015))
    for name, number in NUMBERS.items():
        if name == "camber":
            continue
        before = number.of(lateral)
        after = number.put(lateral, before * 0.9)
        assert number.of(after) == pytest.approx(0.9 * before), name
        assert number.put(after, before) == lateral, name
        low, high = number.bounds(lateral)
        assert low <= before <= high, name
    half_space = tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
    assert NUMBERS["modulus"].of(half_space) == pytest.approx(2.914e6)
    assert NUMBERS["modulus"].put(half_space, 3e6).material == tl.Elastic(3e6, 0.5)
    with pytest.raises(tl.InputError, match=r"has no foundation .* it has modulus"):
        NUMBERS["foundation"].of(half_space)


def test_friction_and_slopes_of_rolling_are_readings():
    """A half-space: the force of sliding tells friction, the slope of the tire card the modulus."""
    tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
    rows = [
        Measured(load=30e3, creepage_x=0.2, tractive_force=-15e3),
        Measured(load=30e3, deflection=0.0125),
    ]
    found = calibrate(tire, ["friction", "modulus"], rows, spacing=20e-3, friction=0.6)
    # Wholly sliding: μP.
    assert found.friction == found.value("friction") == pytest.approx(0.5, rel=1e-3)
    assert found.value("modulus") != NUMBERS["modulus"].of(tire)


def footprint_of(tire, load, pitch=8e-3):
    """What a mat of sensels reads under a tire, as a Footprint."""
    rows = [Measured(load=load, deflection=1.0)]
    pressure, grid, _ = model_of(tire, rows, 6e-3).pressed(tire, 0)
    whole = tl.footprint.Footprint(tl.response.GridLoad(grid, pressure))
    return whole.resampled(pitch).moved(0.013, -0.021)


def test_a_map_tells_the_crown_wherever_it_lay():
    """Shares of blocks of a map of 8 mm sensels, moved by 13 and -21 mm, from another crown."""
    seen = footprint_of(changed(TIRE, {"crown_radius": 1.9}), 30e3)
    found = calibrate(TIRE, ["crown_radius"], [Measured(footprint=seen)], spacing=6e-3)
    assert found.value("crown_radius") == pytest.approx(1.9, rel=0.02)
    assert len(found.comparisons) == 1
    assert float(found.comparisons[0].dataset["overlap_of_pressure"]) > 0.95
    assert found.dataset["residual"].std() < found.dataset["residual_before"].std()
    opened = tl.results.Results(tl.results.to_tree(found)).calibration
    assert opened.comparisons[0].sentence == found.comparisons[0].sentence
    with pytest.raises(tl.InputError, match=r"carries 30 kN and its row gives 50 kN, -40 %"):
        Measured(load=50e3, footprint=seen).loaded()
    empty = Measured(load=50e3, footprint=tl.response.GridLoad(Grid.centred(0.1, 0.1, 0.01), np.zeros((10, 10))))
    with pytest.raises(tl.InputError, match="no load"):
        empty.loaded()


def test_it_is_saved_drawn_reported_and_opened(fitted, tmp_path):
    found, _, _ = fitted
    path = tl.save_results(found, tmp_path / "fit.nc")
    opened = tl.open_results(path).calibration
    assert opened.summary() == found.summary()
    assert opened.tire == found.tire
    assert opened.sought == found.sought
    assert opened.interval("foundation") == found.interval("foundation")
    for draw in (opened.plot.fit, opened.plot.numbers):
        assert draw().axes[0].get_title(loc="left")
    page = tl.report(found, tmp_path / "fit.html").read_text(encoding="utf-8")
    assert "Calibration of the tire" in page
    assert "How sure" not in page.split("Calibration of the tire")[0]
    with pytest.raises(tl.InputError, match="was not sought"):
        found.value("arm")


def test_a_case_asks_the_same(exact, tmp_path):
    case = Case.from_text(first_case("calibrate"))
    assert Case.from_text(case.to_toml()) == case
    rows = ", ".join(
        f'["{load / 1e3} kN", "{values[0] * 1e3} mm"]' for load, values in zip(LOADS, exact, strict=True)
    )
    text = f"""
spacing = "16 mm"
tire = {{ profile = "315/80R22.5", inflation_pressure = "8.2 bar", belt = "315/80R22.5" }}
[calibration]
parameters = ["foundation", {{ name = "modulus", start = "5 MPa", low = "1 MPa" }}]
load_deflection = [{rows}]
errors = {{ deflection = "0.1 mm" }}
"""
    asked = Case.from_text(text)
    assert asked.source.command == "calibrate"
    state = tmp_path / "state.json"
    result = run(asked, state=state)
    sought = ["foundation", Unknown("modulus", 5e6, 1e6)]
    rows = asked.calibration.build_data()
    own = calibrate(asked.build_tire(), sought, rows, errors={"deflection": 1e-4}, spacing=16e-3, state=state)
    # The same question: its state has every point.
    assert own.stats["contacts"] == 0
    np.testing.assert_array_equal(result.calibration.dataset["fitted_value"], own.dataset["fitted_value"])
    opened = tl.open_results(tl.save_results(result, tmp_path / "r.nc"))
    assert opened.case == asked
    assert opened.road == result.calibration.road
    for old, new, word in (
        ('"foundation"', '"foundaton"', "did you mean 'foundation'"),
        ('"5 MPa"', '"5 mm"', "cannot read '5 mm' as a quantity in Pa"),
        ('"0.1 mm"', '"0.1 kN"', "cannot read '0.1 kN' as a quantity in m"),
        ('"1 MPa" }', '"1 MPa", top = 3 }', "top"),
        ("load_deflection", "load_deflexion", "did you mean 'load_deflection'"),
    ):
        assert old in text
        with pytest.raises(tl.InputError, match=word):
            Case.from_text(text.replace(old, new))
