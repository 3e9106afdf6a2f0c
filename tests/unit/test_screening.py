"""Tornado, Sobol indices and Morris effects, through a stand-in for the solver whose indices are known."""

import math

import numpy as np
import pytest

import treadload as tl
from cases import COARSE_CASE
from studies import CASE, study_of
from treadload.sweeps import screening
from treadload.sweeps.screening import answers

RANGES = {"friction": (0.3, 0.9), "normal_load": ("20 kN", "40 kN"), "rolling.tractive_force": (0.0, 2e3)}
LOW, HIGH = np.array([0.3, 2e4, 0.0]), np.array([0.9, 4e4, 2e3])


@pytest.fixture
def stand_in(monkeypatch):
    """Put a function of the three inputs, each from 0 to 1, in the place of the solver."""

    def put(function, failing=lambda u: ""):
        def solve(friction, normal_load, tractive_force):
            u = (np.array([friction, normal_load, tractive_force]) - LOW) / (HIGH - LOW)
            return failing(u) or {
                "worst_strain": function(u),
                "largest_extension": np.array([1.0, 2.0]) * function(u),
            }

        monkeypatch.setattr(answers, "sweep", lambda case, design, **more: study_of(design, solve, case))

    return put


SMALL = COARSE_CASE.replace("12 mm", "20 mm")


def approach(text):
    case = tl.Case.from_text(text)
    return float(
        tl.solve_contact(case.build_tire(), case.build_road(), case.rolling.build(), spacing=0.02).dataset["approach"]
    )


def ishigami(u):
    x = math.pi * (2 * u - 1)
    return math.sin(x[0]) + 7 * math.sin(x[1]) ** 2 + 0.1 * x[2] ** 4 * math.sin(x[0])


def g_function(u):
    return math.prod((abs(4 * one - 2) + a) / (1 + a) for one, a in zip(u, (0, 1, 9), strict=True))


def closed_form_of_g():
    """Sobol' (1993): partial variances (1/3)/(1 + a)²."""
    parts = np.array([1 / 3 / (1 + a) ** 2 for a in (0, 1, 9)])
    whole = np.prod(1 + parts) - 1
    return parts / whole, parts * np.prod(1 + parts) / (1 + parts) / whole


# a = 7, b = 0.1; Ishigami and Homma (1990).
_V = 7**2 / 8 + 0.1 * math.pi**4 / 5 + 0.1**2 * math.pi**8 / 18 + 0.5
_V1, _V13 = 0.5 * (1 + 0.1 * math.pi**4 / 5) ** 2, 0.1**2 * math.pi**8 * (1 / 18 - 1 / 50)
ISHIGAMI = (np.array([_V1, 7**2 / 8, 0]) / _V, np.array([_V1 + _V13, 7**2 / 8, _V13]) / _V)


@pytest.mark.parametrize(
    ("function", "expected"), [(ishigami, ISHIGAMI), (g_function, closed_form_of_g())], ids=["ishigami", "g"]
)
def test_sobol_indices_are_those_of_the_closed_form(stand_in, function, expected):
    stand_in(function)
    found = screening.sobol(CASE, RANGES, "worst_strain", blocks=512)
    data = found.dataset.sel(input=list(RANGES))
    for name, exact in zip(("first_order", "total_order"), expected, strict=True):
        values, interval = data[name].to_numpy(), data[f"{name}_interval"].to_numpy()
        # The interval is that of 95 %: of a fixed seed twice of it, and no wider than 0.15 where it is checked.
        assert (np.abs(values - exact) <= 2 * interval + 0.005).all()
        assert interval.max() < 0.15
    totals = found.dataset["total_order"].to_numpy()
    assert (np.diff(totals) <= 0).all()
    assert "512 blocks of 5 cases" in found.summary()
    assert found.dataset["key"].to_numpy().tolist()[0].startswith("rolling.")


def test_pairs_have_indices_of_their_own(stand_in):
    stand_in(ishigami)
    found = screening.sobol(CASE, RANGES, "worst_strain", blocks=512, second_order=True)
    pairs = found.dataset["second_order"]
    names = list(RANGES)
    # Only the first and the third input act together. 0.1: the estimator of pairs is the roughest of all.
    assert float(pairs.sel(input=names[0], other=names[2])) == pytest.approx(_V13 / _V, abs=0.1)
    assert float(pairs.sel(input=names[2], other=names[0])) == float(pairs.sel(input=names[0], other=names[2]))
    assert abs(float(pairs.sel(input=names[0], other=names[1]))) < 0.1
    assert math.isnan(float(pairs.sel(input=names[1], other=names[1])))
    assert f"{names[0]} with {names[2]}" in found.summary() or f"{names[2]} with {names[0]}" in found.summary()


def test_few_blocks_and_vague_indices_are_said(stand_in):
    stand_in(ishigami)
    found = screening.sobol(CASE, RANGES, "worst_strain", blocks=8)
    assert any("8 blocks are few" in text for text in found.warnings)
    assert any("interval is wider than they are" in text and "blocks" in text for text in found.warnings)
    enough = screening.sobol(CASE, RANGES, "worst_strain", blocks=128)
    assert not any("are few" in text for text in enough.warnings)


def test_blocks_with_a_failed_case_are_left_out_and_said(stand_in):
    slides = lambda u: "gross sliding" if u[0] < 0.02 else ""  # noqa: E731
    stand_in(lambda u: u[0] + 2 * u[1], slides)
    found = screening.sobol(CASE, RANGES, "worst_strain", blocks=128)
    (said,) = [text for text in found.warnings if "left out" in text]
    assert "of 128 blocks" in said
    assert said.endswith("gross sliding")
    assert found.dataset.attrs["blocks"] == 128 - int(said.split()[0])
    # Of a linear function the shares are those of the squares of its slopes; what is lost moves them little.
    data = found.dataset.sel(input=list(RANGES))
    np.testing.assert_allclose(data["total_order"], [0.2, 0.8, 0.0], atol=0.1)


@pytest.mark.parametrize("verb", [screening.sobol, screening.morris])
def test_too_many_failures_are_refused(stand_in, verb):
    stand_in(lambda u: u[0], lambda u: "gross sliding" if u[0] < 0.4 else "")
    with pytest.raises(tl.InputError, match=r"more than 20 %.*narrow them.*gross sliding"):
        verb(CASE, RANGES, "worst_strain")


def test_morris_effects_of_a_linear_function_are_its_slopes(stand_in):
    slopes = np.array([3.0, -5.0, 0.5])
    stand_in(lambda u: float(slopes @ u))
    found = screening.morris(CASE, RANGES, "worst_strain", trajectories=8)
    data = found.dataset.sel(input=list(RANGES))
    # Exact but for round-off: an effect is over the whole range, whatever its unit.
    np.testing.assert_allclose(data["mean_effect"], slopes, rtol=1e-9)
    np.testing.assert_allclose(data["absolute_effect"], np.abs(slopes), rtol=1e-9)
    np.testing.assert_allclose(data["effect_deviation"], 0, atol=1e-9)
    assert found.dataset["input"].to_numpy().tolist() == ["normal_load", "friction", "rolling.tractive_force"]
    assert found.rows()[0].group == "normal_load"
    assert "down" in found.summary()
    assert not found.warnings


def test_morris_tells_what_bends(stand_in):
    stand_in(lambda u: u[0] * (2 * u[1] - 1))
    found = screening.morris(CASE, RANGES, "worst_strain", trajectories=20)
    data = found.dataset.sel(input="friction")
    assert float(data["effect_deviation"]) > abs(float(data["mean_effect"]))
    assert "bends or interacts" in found.summary()
    few = screening.morris(CASE, RANGES, "worst_strain", trajectories=3)
    assert any("3 trajectories are few" in text for text in few.warnings)


def test_tornado_goes_to_both_ends_of_every_input(stand_in):
    stand_in(lambda u: float(np.array([3.0, -5.0, 0.5]) @ u))
    found = screening.tornado(CASE, {**RANGES, "rolling.tractive_force": (0.0, 2e3)}, "worst_strain")
    data = found.dataset
    assert data["input"].to_numpy().tolist() == ["normal_load", "friction", "rolling.tractive_force"]
    # The base case has a force of 10 kN, five times the top of its range.
    base = float(data["reading_base"])
    np.testing.assert_allclose(data["input_base"], [32.5e3, 0.7, 10e3])
    load, friction, force = (data.sel(input=name) for name in data["input"].to_numpy())
    assert float(load["reading_low"]) - float(load["reading_high"]) == pytest.approx(5.0)
    assert float(friction["swing"]) == pytest.approx(3.0)
    assert float(force["reading_low"]) == pytest.approx(base - 2.5)
    assert any(
        "rolling.tractive_force of the base case, 10000, lies outside its range" in one for one in found.warnings
    )


@pytest.mark.slow
def test_tornado_of_a_real_case_is_its_finite_difference():
    case = tl.Case.from_text(SMALL)
    ranges = {"normal_load": ("32.2 kN", "32.8 kN"), "rolling.tractive_force": ("10 kN", "40 kN")}
    found = screening.tornado(case, ranges, "approach")
    base = approach(SMALL)
    assert float(found.dataset["reading_base"]) == pytest.approx(base, rel=1e-9)
    load = found.dataset.sel(input="normal_load")
    # The same solver on the same cells, to its own tolerance.
    assert float(load["reading_high"]) == pytest.approx(approach(SMALL.replace("32.5 kN", "32.8 kN")), rel=1e-6)
    assert float(load["reading_low"]) < base < float(load["reading_high"])
    # 40 kN are more than friction carries: a gap that says why, at the end of the list.
    force = found.dataset.isel(input=1)
    assert str(force["input"].item()) == "rolling.tractive_force"
    assert math.isnan(float(force["reading_high"]))
    assert any("high end of rolling.tractive_force, 40000 N: gross sliding" in text for text in found.warnings)
    assert "failed" in found.summary()


def test_what_cannot_be_asked_is_refused_in_a_sentence(stand_in):
    stand_in(lambda u: u[0])
    with pytest.raises(tl.InputError, match=r"largest_extension is over depth: 0, 0.02; state which, at=\{'depth'"):
        screening.tornado(CASE, RANGES, "largest_extension")
    deep = screening.tornado(CASE, RANGES, "largest_extension", at={"depth": 0.02})
    assert deep.dataset.attrs["place"] == "depth 20 mm"
    assert float(deep.dataset["reading_base"]) == pytest.approx(2 * (0.7 - 0.3) / 0.6)
    with pytest.raises(tl.InputError, match=r"has no depth 0.05; it has 0, 0.02"):
        screening.tornado(CASE, RANGES, "largest_extension", at={"depth": 0.05})
    with pytest.raises(tl.InputError, match=r"worst_strain is not over depth"):
        screening.tornado(CASE, RANGES, "worst_strain", at={"depth": 0.0})
    with pytest.raises(tl.InputError, match=r"the cases have no 'strain'"):
        screening.tornado(CASE, RANGES, "strain")
    with pytest.raises(tl.InputError, match=r"values of friction are given twice"):
        screening.morris(CASE, {"friction": (0.3, "0.3")}, "worst_strain")
    with pytest.raises(tl.InputError, match=r"blocks must be a power of two.*got 100"):
        screening.sobol(CASE, RANGES, "worst_strain", blocks=100)
    with pytest.raises(tl.InputError, match=r"give two or more"):
        screening.sobol(CASE, {"friction": (0.3, 0.9)}, "worst_strain")
    with pytest.raises(tl.InputError, match=r"trajectories must be a whole number, from 2 on, got 1"):
        screening.morris(CASE, RANGES, "worst_strain", trajectories=1)
    with pytest.raises(tl.InputError, match=r"turns around the number that the case gives for rolling.speed"):
        screening.tornado(CASE, {"rolling.speed": ("10 km/h", "90 km/h")}, "worst_strain")


def test_a_result_that_no_input_changes_is_refused(stand_in):
    stand_in(lambda u: 7.0)
    with pytest.raises(tl.InputError, match=r"is 7 in all cases"):
        screening.sobol(CASE, RANGES, "worst_strain", blocks=8)


def test_logarithms_of_passes(stand_in):
    stand_in(lambda u: 10.0 ** (3 * u[0] + 4 * u[1]))
    found = screening.sobol(CASE, RANGES, "worst_strain", blocks=128, logarithmic=True)
    data = found.dataset.sel(input=list(RANGES))
    # A linear function again: 9 to 16.
    np.testing.assert_allclose(data["total_order"], [9 / 25, 16 / 25, 0], atol=0.05)
    assert found.dataset.attrs["of"] == "log10 of worst_strain"


def test_without_salib_it_says_what_to_install(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "SALib", None)
    with pytest.raises(tl.InputError, match=r"needs SALib.*\[study\].*sweeps.screening.tornado"):
        screening.morris(CASE, RANGES, "worst_strain")
