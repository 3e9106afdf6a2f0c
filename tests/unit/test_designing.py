"""How thick a layer must be: the root, what stands on both sides of it, and what is said where there is none."""

import math
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

import treadload as tl
from treadload.case import Case
from treadload.cli import app
from treadload.damage import AxleClass, Climate, Criterion, FatigueLine, FrenchSubgrade, Traffic
from treadload.damage.laws.fatigue import PowerLine
from treadload.damage.laws.french import FrenchBituminous, risk_factor
from treadload.damage.quantities import VerticalCompression
from treadload.damage.rutting import Rutting
from treadload.damage.scatter import Scatter
from treadload.errors import InputError
from treadload.life import design_thickness, solve_life
from treadload.life.contacts import Contacts
from treadload.life.thickness_search import ThicknessSearch
from treadload.pavement import Pavement
from treadload.tire import Tire

TIRE = Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
ROAD = Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")
BASE, SOIL = Criterion("base", FatigueLine(75e-6, -0.2), 1), Criterion("soil", FrenchSubgrade(), -1)
TRAFFIC = Traffic((AxleClass("one", 1.0, 32.5e3, 820e3),), 1e5, 0.02, years=20.0)
WARM = Climate.constant(15.0)
COARSE = {"spacing": 12e-3, "contacts": Contacts(TIRE, 12e-3)}


def designed(criteria=(BASE, SOIL), **asked):
    parts = {name: asked.pop(name) for name in ("rutting", "scatter", "criteria_of") if name in asked}
    design = tl.Design(TIRE, ROAD, TRAFFIC, WARM, criteria, **parts, **COARSE)
    return design_thickness(design, **{"layer": 1, "workers": 1, **asked})


def years_of(thickness, criteria=(BASE, SOIL)):
    layers = list(ROAD.layers)
    layers[1] = replace(layers[1], thickness=thickness)
    life = solve_life(tl.Design(TIRE, Pavement(layers), TRAFFIC, WARM, criteria, **COARSE), workers=1)
    return float(life.dataset["life_years"].min())


@pytest.fixture(scope="module")
def found():
    return designed()


def test_the_rounded_thickness_lasts_and_a_centimetre_less_does_not(found):
    assert found.thickness == pytest.approx(round(found.thickness, 2), abs=1e-12)
    assert found.years(found.thickness) >= 20 > found.years(found.thickness - 0.01)
    # By lives of their own, not those of the search.
    assert years_of(found.thickness) == pytest.approx(found.years(found.thickness), rel=1e-12)
    # A tenth of the step is a hundredth of the thickness in 6 %, a life's power of four.
    exact = float(found.dataset["exact_thickness"])
    assert years_of(exact) == pytest.approx(20, rel=0.04)
    assert found.thickness - 0.01 < exact <= found.thickness
    assert found.road.layers[1].thickness == found.thickness
    groups = {row.group for row in found.rows()}
    assert {f"{found.thickness * 1e3:.0f} mm", f"{found.thickness * 1e3 - 10:.0f} mm"} <= groups
    assert found.stats["lives"] <= 8


def test_a_finer_step_comes_nearer(found):
    fine = designed(step=0.002, years=20.0)
    assert found.thickness - 0.01 < fine.thickness <= found.thickness
    assert 20 <= fine.years(fine.thickness) < found.years(found.thickness)


@pytest.mark.slow
def test_a_risk_goes_into_the_laws_that_have_one():
    """Half a risk needs a thicker layer, and laws without are told."""

    def law(road):
        asphalt = sum(layer.thickness for layer in road.layers[:2])
        return (Criterion("base", FrenchBituminous(90e-6, -0.2, 0.3, asphalt, 0.5, 1.3), 1), SOIL)

    few, many = (designed(law(ROAD), criteria_of=law, risk=risk) for risk in (0.01, 0.3))
    assert few.thickness > many.thickness
    assert few.life.laws[0][0].risk == 0.01
    assert few.life.laws[0][0].thickness == pytest.approx(0.06 + few.thickness)
    assert any(text.startswith("soil: its law") and "no risk" in text for text in few.warnings)
    with pytest.raises(InputError, match="has no meaning; give the design a scatter"):
        designed((SOIL,), risk=0.05)


@pytest.mark.slow
def test_a_scatter_gives_every_criterion_its_years_at_the_risk():
    """Fatigue alone: at 5 % the strain allowed is 10^(-1.645 x 0.2 x 0.3) of that at even odds, k_r."""
    scatter = Scatter(fatigue=0.3, thickness=0.0)
    by_scatter = designed((BASE,), risk=0.05, scatter=scatter, step=0.002)
    weaker = Criterion("base", FatigueLine(75e-6 * risk_factor(0.05, -0.2, 0.3, 0.0), -0.2), 1)
    by_factor = designed((weaker,), step=0.002)
    # Twice the fineness of the root, and the error of a quantile of 10⁵ draws.
    assert by_scatter.dataset["exact_thickness"] == pytest.approx(
        float(by_factor.dataset["exact_thickness"]), abs=6e-4
    )


class Drifting(ThicknessSearch):
    """Years at the risk, 20 at 158 mm, which change by a factor and by a rate where they are solved afresh."""

    def __init__(self, factor, rate):
        design = tl.Design(TIRE, ROAD, TRAFFIC, WARM, (BASE,), scatter=Scatter(fatigue=0.3), **COARSE)
        super().__init__(design, 1, 20.0, 0.05, {})
        self.factor, self.rate = factor, rate
        self.shifted = 1.0

    def at_risk(self, thickness, *, fresh=False):
        if fresh:
            self.shifted = self.factor * math.exp(self.rate * (thickness - 0.158))
        self.years_by_thickness[thickness] = np.array([20 * (thickness / 0.158) ** 4 * self.shifted])
        return self.years_by_thickness[thickness]


@pytest.mark.parametrize(
    ("factor", "rate", "thickness"), [(1, 0, 0.16), (1, -3, 0.16), (0.9, 0, 0.17), (1.4, 5, 0.15)]
)
def test_a_rounded_thickness_counts_with_years_at_the_risk_of_its_own(factor, rate, thickness):
    search = Drifting(factor, rate)
    exact, rounded = search.rounded(0.158, 0.01, (0.04, 0.4), "base")
    assert rounded == pytest.approx(thickness)
    assert rounded - 0.01 < exact <= rounded
    for size in (rounded - 0.01, rounded):
        fresh = 20 * (size / 0.158) ** 4 * factor * math.exp(rate * (size - 0.158))
        assert search.shortest(size) == pytest.approx(fresh, rel=1e-12)
    assert search.shortest(rounded) >= 20 > search.shortest(rounded - 0.01)


def test_a_life_that_thickness_does_not_lengthen_is_refused():
    with pytest.raises(InputError, match=r"160 mm, to which it is rounded up, 18\.7"):
        Drifting(1.0, -60.0).rounded(0.158, 0.01, (0.04, 0.4), "base")


def test_what_cannot_be_found_is_refused_in_a_sentence():
    with pytest.raises(
        InputError, match=r"no thickness of EB-GB3 from 40 to 80 mm lasts 20 years: the longest.*by base"
    ):
        designed(between=(0.04, 0.08))
    top = Criterion("top", PowerLine(VerticalCompression(), 1e-5, -0.2), 0, "top")
    with pytest.raises(InputError, match="by top, which a thicker EB-GB3 does not help"):
        designed((top,), between=(0.15, 0.25))
    for asked, said in (
        ({"layer": "GB3"}, "did you mean 'EB-GB3'"),
        ({"layer": 2}, "semi-infinite"),
        ({"layer": 5}, "there is no layer 5"),
        ({"years": 0.0}, "years must be a positive"),
        ({"between": (0.3, 0.2)}, "0 < low < high"),
        ({"risk": 1.0}, "between 0 and 1, got 1"),
    ):
        with pytest.raises(InputError, match=said):
            designed(**asked)
    with pytest.raises(InputError, match="needs years"):
        design_thickness(tl.Design(TIRE, ROAD, replace(TRAFFIC, years=None), WARM, (BASE,), **COARSE), 1)


@pytest.mark.slow
def test_a_rut_at_its_limit_ends_a_design_as_a_criterion_does():
    """The platform alone would do with less; the rut of 6 mm asks for more, and governs on both sides of the step."""
    asked = {"criteria": (SOIL,), "years": 60.0, "rutting": Rutting(limit=6e-3)}
    with_rut, without = designed(**asked), designed((SOIL,), years=60.0)
    assert with_rut.dataset["criterion"].to_numpy().tolist() == ["soil", "rut"]
    assert with_rut.thickness > without.thickness
    assert with_rut.years(with_rut.thickness) >= 60.0 > with_rut.years(with_rut.thickness - with_rut.step)
    assert with_rut.life.governing == "rut"
    at = f"{with_rut.thickness * 1e3:.0f} mm"
    tried = {row.key: row.text for row in with_rut.rows() if row.group == at}
    assert tried == {"trial_years": f"{with_rut.life.rut_years:.3g} years", "governing": "rut"}
    with pytest.raises(InputError, match=r"from 40 to 200 mm lasts 150 years: the longest .* by rut"):
        designed(**{**asked, "years": 150.0, "between": (0.04, 0.2)})
    named = Criterion("rut", FrenchSubgrade(), -1)
    with pytest.raises(InputError, match="a criterion has the name 'rut', which the life's rut has"):
        designed(**{**asked, "criteria": (named,)})


def test_what_lasts_already_says_so():
    found = designed(between=(0.3, 0.4))
    assert found.thickness == pytest.approx(0.3)
    assert any("lasts already" in text for text in found.warnings)
    assert found.is_at_bound
    rows = {row.key: row for row in found.rows()}
    verdict = rows["verdict"].text
    assert rows["exact_thickness"].text == "300.0 mm"
    assert rows["exact_thickness"].note.startswith("at most")
    assert "may be thinner than 300 mm" in verdict
    assert "smaller low" in verdict


def test_a_bound_that_is_needed_is_the_answer(found):
    """The lower bound just above the thickness that lasts: a step less does not last, so that it is no guess."""
    bound = round(float(found.dataset["exact_thickness"]) + 1e-3, 3)
    near = designed(between=(bound, 0.4), step=0.02)
    assert not near.is_at_bound
    assert "may be thinner" not in near.summary()


CASE = """
spacing = "20 mm"
tire = { profile = "315/80R22.5" }
pavement = { structure = "6 BBSG3 / 15 GB3 / PF3" }
climate = { temperature = 15 }
traffic = { passes_per_year = 1e5, years = 20, classes = [
    { name = "one", share = 1, wheel_load = "32.5 kN", inflation_pressure = "8.2 bar" }] }
criteria = [{ name = "base", law = "french-bituminous", layer = "EB-GB3", risk = 0.05 }]
"""


@pytest.mark.slow
def test_the_command_finds_it_and_writes_it(tmp_path):
    (tmp_path / "case.toml").write_text(CASE)
    ask = ["design", str(tmp_path / "case.toml"), "--layer", "2", "--risk", "12 %", "--workers", "1", "--quiet"]
    done = CliRunner().invoke(app, ask)
    assert done.exit_code == 0, done.output
    assert "EB-GB3 for 20 years at a risk of 12 %" in done.output
    opened = tl.open_results(tmp_path / "case_design.nc")
    assert opened["design"].life.laws[0][0].risk == pytest.approx(0.12)
    assert opened["design"].summary() in done.output.replace("\n\n", "\n")
    assert isinstance(opened.case, Case)
    assert math.isfinite(opened["design"].thickness)
    wrong = CliRunner().invoke(app, [*ask[:3], "9", "--quiet"])
    assert wrong.exit_code == 2
    assert "no layer 9; the road has 1 to 3" in wrong.output
