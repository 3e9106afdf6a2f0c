"""What would help a road: every remedy beside the life of the changed design, solved alone; and what is refused."""

import math
from dataclasses import replace

import numpy as np
import pytest

import treadload as tl
from treadload.contact import STRAIGHT, Maneuver
from treadload.damage import AxleClass, Climate, Criterion, FatigueLine, FrenchSubgrade, Traffic, Wander
from treadload.damage.frequency import LoadingFrequency
from treadload.damage.rutting import Rutting
from treadload.errors import InputError
from treadload.life import RemedySteps, life_equivalents, remedies, solve_life
from treadload.life.design import Design
from treadload.life.remedy.road_changes import neighbours
from treadload.life.remedy.solve import remedies_of
from treadload.life.remedy.traffic_changes import _turn_at
from treadload.materials.library import mixes
from treadload.pavement import BONDED, FRICTIONLESS, Pavement
from treadload.tire import Belt, Tire

TIRE = Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
ROAD = Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")
BASE, SOIL = Criterion("base", FatigueLine(70e-6, -0.2), 1), Criterion("soil", FrenchSubgrade(), -1)
BRAKED = AxleClass("braked", 1.0, 32.5e3, 850e3, maneuver=Maneuver.braking(1.5))
TRAFFIC = Traffic((BRAKED,), 1e5, growth=0.02, wander=Wander.normal(0.2), years=20)


def design(road=ROAD, traffic=TRAFFIC, **more):
    return Design(TIRE, road, traffic, Climate.constant(15.0), (BASE, SOIL), spacing=24e-3, **more)


@pytest.fixture(scope="module")
def answer():
    asked = design()
    return remedies(asked, solve_life(asked, workers=1), workers=1)


def changed_road(number, **changes):
    layers = list(ROAD.layers)
    layers[number] = replace(layers[number], **changes)
    return design(Pavement(layers))


def changed_class(**changes):
    return design(traffic=replace(TRAFFIC, classes=(replace(BRAKED, **changes),)))


SAME = {
    "2 cm more EB-GB3": lambda: changed_road(1, thickness=0.17),
    "2 cm more EB-BBSG3": lambda: changed_road(0, thickness=0.08),
    "EB-BBME1 in place of EB-BBSG3": lambda: changed_road(0, material=mixes["EB-BBME1"]),
    "PF4 in place of PF3": lambda: changed_road(2, material=mixes["PF4"]),
    "50 mm more wander": lambda: design(traffic=replace(TRAFFIC, wander=Wander.normal(0.25))),
    "wheel loads 5 % lower": lambda: changed_class(wheel_load=0.95 * 32.5e3),
    "tires inflated by 1 bar less": lambda: changed_class(inflation_pressure=750e3),
    "braking and starting 25 % gentler": lambda: changed_class(maneuver=Maneuver.braking(0.75 * 1.5)),
    "friction 0.1 lower": lambda: changed_class(friction=0.6),
    "friction 0.1 higher": lambda: changed_class(friction=0.8),
    "tires 335/65R22.5 tread": lambda: replace(
        design(), tire=Tire.from_profile("335/65R22.5 tread", inflation_pressure=820e3)
    ),
}


@pytest.mark.parametrize("name", SAME)
def test_a_remedy_is_the_life_of_the_changed_design(answer, name):
    """Contacts start from near ones, which moves lives by their tolerance, 3e-5, to the power of the law, 5."""
    life = solve_life(replace(SAME[name](), contacts=None), workers=1)
    years = answer.dataset["remedy_years"].sel(remedy=name)
    for criterion in ("base", "soil"):
        assert float(years.sel(criterion=criterion)) == pytest.approx(life.years(criterion), rel=1e-3)


def test_they_are_ranked_by_years_won_and_named_in_sentences(answer):
    data = answer.dataset
    won = data["years_won"].to_numpy()
    assert (np.diff(won) <= 0).all()
    np.testing.assert_allclose(won, data["remedy_years"].min("criterion") - data["life_years"].min(), rtol=1e-12)
    assert set(SAME) < set(data["remedy"].to_numpy().tolist())
    first = str(data["remedy"].to_numpy()[0])
    before, after = answer.years_before, float(data["road_years"][0])
    assert answer.sentences()[0] == f"{first}: {before:.3g} → {after:.3g} years by base"
    assert answer.best("base")[0] == (first, after)
    assert f"{first}: {before:.3g} →" in answer.summary()


def test_it_states_what_was_solved_and_how(answer):
    """Six contacts differ: load, tire, pressure, braking and friction twice; one response each, wander none."""
    anew = answer.dataset["solved_anew"]
    assert int(anew.sel(remedy="50 mm more wander")) == 0
    assert int(anew.sum()) == anew.size - 1 == answer.stats["responses"]
    assert answer.stats["contacts"] == 6
    assert "1 summed again from the same responses, none by derivative" in answer.summary()


def test_what_does_not_apply_is_named_with_its_reason(answer):
    skipped = "\n".join(answer.skipped)
    assert "bonding an interface: every interface of the road is fully bonded already" in skipped
    assert "larger radius: no class turns" in skipped
    assert "km/h slower or faster: braked has no speed" in skipped


def test_standard_axles_are_those_of_the_life(answer):
    axles = life_equivalents(design(), solve_life(design(), workers=1), workers=1)
    np.testing.assert_allclose(answer.dataset["standard_axles"], axles.dataset["standard_axles"], rtol=1e-12)
    assert "standard axles by base" in answer.summary()


def test_a_law_left_unchanged_by_a_mix_and_less_grip_are_said(answer):
    assert any("EB-GB4 in place of EB-GB3: the law of base is the same" in text for text in answer.warnings)
    assert any("friction 0.1 lower: the road has less grip" in text for text in answer.warnings)


def test_a_remedy_that_leaves_the_range_of_a_law_has_a_warning():
    """The range of a line ends where it allows 10⁸ passes, ε₆ · 100^-0.2: a reading 3 % above falls below it."""
    life = solve_life(design(), workers=1)
    epsilon_6 = life.dataset["largest_reading"].sel(criterion="base").item() / 1.03 * 100**0.2
    near = replace(design(), criteria=(Criterion("base", FatigueLine(epsilon_6, -0.2), 1),))
    answer = remedies(near, solve_life(near, workers=1), RemedySteps(only=("thickness", "friction")), workers=1)
    left = [text for text in answer.warnings if "leaves the range of the law of base" in text]
    assert {text.partition(":")[0] for text in left} == {"2 cm more EB-BBSG3", "2 cm more EB-GB3"}


def test_an_interface_without_bond_is_bonded():
    loose = changed_road(0, bond=FRICTIONLESS)
    answer = remedies(loose, solve_life(loose, workers=1), RemedySteps(only=("bond",)), workers=1)
    (name,) = answer.dataset["remedy"].to_numpy()
    assert name == "EB-BBSG3 bonded to EB-GB3"
    bonded = solve_life(design(), workers=1)
    assert float(answer.dataset["road_years"][0]) == pytest.approx(bonded.years("base"), rel=1e-4)
    assert float(answer.dataset["years_won"][0]) > 0
    assert changed_road(0, bond=BONDED).road == ROAD


@pytest.mark.slow
def test_a_limit_of_the_rut_is_ranked_among_the_criteria():
    ruts = design(rutting=Rutting(limit=8e-3))
    answer = remedies(ruts, solve_life(ruts, workers=1), RemedySteps(only=("wander",)), workers=1)
    assert answer.dataset["criterion"].to_numpy().tolist() == ["base", "soil", "rut"]
    wider = replace(ruts, traffic=replace(TRAFFIC, wander=Wander.normal(0.25)))
    expected = solve_life(wider, workers=1).rut_years
    assert float(answer.dataset["remedy_years"].sel(criterion="rut")[0]) == pytest.approx(expected, rel=1e-4)
    assert np.isnan(answer.dataset["standard_axles"].sel(criterion="rut")).all()


def test_faster_and_slower_read_moduli_at_their_speed():
    rows = tuple(
        replace(BRAKED, speed=v, frequency=LoadingFrequency("mepdg")) for v in (50 / 3.6, 40 / 3.6, 60 / 3.6)
    )
    asked, slow, fast = (design(traffic=replace(TRAFFIC, classes=(row,))) for row in rows)
    answer = remedies(asked, solve_life(asked, workers=1), RemedySteps(only=("speed",)), workers=1)
    for name, alike in (("10 km/h slower", slow), ("10 km/h faster", fast)):
        years = float(answer.dataset["road_years"].sel(remedy=name))
        assert years == pytest.approx(solve_life(alike, workers=1).years("base"), rel=1e-4)


@pytest.mark.parametrize("wheel", ["outer", "inner"])
@pytest.mark.parametrize("radius", [60.0, -25.0])
def test_a_turn_at_another_speed_is_the_turn_of_that_speed(wheel, radius):
    def turn(speed):
        return Maneuver.turning(radius, speed, crossfall=0.025, track=2.0, centre_of_gravity=1.6, wheel=wheel)

    faster, expected = _turn_at(turn(11.0), 11.0, 8.0), turn(8.0)
    assert faster.lateral == pytest.approx(expected.lateral, rel=1e-12)
    assert faster.spin == expected.spin
    assert faster.load_ratio == pytest.approx(expected.load_ratio, rel=1e-12)


def test_a_turn_whose_force_is_not_that_of_its_speed_is_refused():
    with pytest.raises(InputError, match="speed of its turn"):
        _turn_at(Maneuver("odd", lateral=0.6, spin=1 / 60), 5.0, 8.0)


def test_a_wider_turn_has_less_side_force_and_less_spin():
    turning = replace(BRAKED, maneuver=Maneuver.turning(60.0, 11.0), speed=11.0)
    found, _ = remedies_of(design(traffic=replace(TRAFFIC, classes=(turning,))), RemedySteps(only=("turning",)))
    expected = Maneuver.turning(80.0, 11.0)
    (row,) = found[0].design.traffic.classes
    assert (row.maneuver.lateral, row.maneuver.spin) == pytest.approx((expected.lateral, expected.spin), rel=1e-12)


def test_neighbours_in_the_catalogue_are_of_the_same_use():
    def names(name):
        return [neighbour.name for neighbour in neighbours(mixes[name])]

    assert names("EB-BBSG3") == ["EB-BBME1", "EB-BBSG1"]
    assert names("EB-GB3") == ["EB-GB4", "EB-GB2"]
    assert names("EB-EME2") == ["EB-EME1"]
    assert names("PF2") == ["PF2qs"]
    assert names("PF4") == []
    assert names("GC-T3") == ["GC-T4", "GLp-T3"] or names("GC-T3") == ["GC-T4", "GCV-T3"]


def test_on_a_belt_the_next_tire_has_the_belt_of_its_size():
    tire = Tire.from_profile("315/80R22.5", inflation_pressure=820e3, belt=Belt.from_library("315/80R22.5"))
    found, _ = remedies_of(replace(design(), tire=tire), RemedySteps(only=("tire",)))
    assert found[0].design.tire.belt == Belt.from_library("335/65R22.5")
    assert found[0].design.tire.inflation_pressure == 820e3


def test_the_next_tire_fits_the_same_vehicle():
    def found(name):
        tire = Tire.from_profile(name, inflation_pressure=820e3)
        return remedies_of(replace(design(), tire=tire), RemedySteps(only=("tire",)))

    assert found("335/65R22.5 tread")[0][0].design.tire.name == "385/65R22.5"
    # The last of the trucks, not the aircraft's of about the same radius, which comes next by name.
    assert found("445/50R22.5")[0][0].design.tire.name == "11R22.5"
    assert not found("H44.5x16.5-21")[0]
    assert not found("205/60R15")[0]
    assert "no other profile of about this radius" in str(found("205/60R15")[1])


def test_measured_wander_is_stretched_about_its_mean():
    wander = Wander.measured([-0.1, 0.0, 0.3], [0.25, 0.5, 0.25])
    found, _ = remedies_of(design(traffic=replace(TRAFFIC, wander=wander)), RemedySteps(only=("wander",)))
    wide = found[0].design.traffic.wander

    def moments(of):
        at, part = np.array(of.offsets), np.array(of.shares)
        mean = float(at @ part)
        return mean, math.sqrt(float((at - mean) ** 2 @ part))

    assert moments(wide) == pytest.approx((moments(wander)[0], moments(wander)[1] + 0.05), rel=1e-12)


@pytest.mark.parametrize(
    ("traffic", "kind", "why"),
    [
        (replace(TRAFFIC, wander=Wander.none()), "wander", "has no wander"),
        (replace(TRAFFIC, classes=(replace(BRAKED, maneuver=STRAIGHT),)), "braking", "no class brakes"),
        (replace(TRAFFIC, classes=(replace(BRAKED, maneuver=Maneuver.braking()),)), "braking", "locked"),
        (replace(TRAFFIC, classes=(replace(BRAKED, tire=TIRE),)), "tire", "a tire of its own"),
        (replace(TRAFFIC, classes=(replace(BRAKED, inflation_pressure=90e3),)), "pressure", "0.9 bar"),
        (replace(TRAFFIC, classes=(replace(BRAKED, speed=8.0),)), "speed", "no class turns"),
    ],
)
def test_a_change_that_a_traffic_does_not_allow_has_its_reason(traffic, kind, why):
    found, refused = remedies_of(design(traffic=traffic), RemedySteps(only=(kind,)))
    assert not found
    assert why in str(refused[0])


@pytest.mark.parametrize("speed", [8, 10])
def test_a_bus_at_walking_speed_cannot_go_slower(speed):
    row = replace(BRAKED, speed=speed / 3.6, frequency=LoadingFrequency("mepdg"))
    found, refused = remedies_of(design(traffic=replace(TRAFFIC, classes=(row,))), RemedySteps(only=("speed",)))
    assert [remedy.name for remedy in found] == ["10 km/h faster"]
    assert f"rolls at {speed} km/h" in str(refused[0])


@pytest.mark.parametrize(
    ("steps", "why"),
    [
        ({"thickness": 0.0}, "thickness"),
        ({"load": 1.0}, r"\(0, 1\)"),
        ({"only": ("thicknes",)}, "did you mean 'thickness'"),
    ],
)
def test_bad_steps_are_refused(steps, why):
    with pytest.raises(InputError, match=why):
        RemedySteps(**steps)


def test_what_has_no_answer_is_refused():
    life = solve_life(design(), workers=1)
    with pytest.raises(InputError, match="give the life of this design"):
        remedies(replace(design(), criteria=(SOIL,)), life)
    idle = design(traffic=replace(TRAFFIC, passes_per_year=0.0))
    with pytest.raises(InputError, match="give more passes"):
        remedies(idle, solve_life(idle, workers=1))
    with pytest.raises(InputError, match="did you mean 'EB-GB3'"):
        remedies(design(), life, RemedySteps(mixes={"EB-GB33": "EB-GB4"}))


CASE = """
spacing = "24 mm"
[tire]
profile = "315/80R22.5"
[pavement]
structure = "6 BBSG3 / 15 GB3 / PF3"
[climate]
temperature = "15 degC"
[traffic]
passes_per_year = 100000
years = 20
[[traffic.classes]]
name = "driven"
share = 1.0
wheel_load = "32.5 kN"
inflation_pressure = "8.5 bar"
maneuver = { kind = "uphill", grade = 0.06, driven_share = 0.3 }
[[criteria]]
name = "base"
law = "french-bituminous"
layer = "EB-GB3"
risk = 0.05
[remedies]
thickness = "3 cm"
mixes = { EB-GB3 = "EME2" }
only = ["thickness", "mix", "wander"]
"""


def test_a_case_asks_for_them_by_a_table(tmp_path, monkeypatch):
    # Other tests draw the figures of a report.
    monkeypatch.setattr("treadload.reporting.pictures.picture", lambda *_, **__: [])
    file = tmp_path / "case.toml"
    file.write_text(CASE)
    case = tl.Case.from_toml(file)
    assert "remedies  6: 6 take about as many responses as the life each, 0 of them new contacts" in tl.plan(case)
    result = tl.run(case, leave_out=("sensitivity",), workers=1)
    names = result.remedies.dataset["remedy"].to_numpy().tolist()
    assert {"3 cm more EB-GB3", "EB-EME2 in place of EB-GB3", "PF4 in place of PF3"} < set(names)
    # ε₆, k_c and SN are those of the new mix, as in the case that names it.
    other = tmp_path / "other.toml"
    other.write_text(CASE.partition("[remedies]")[0].replace("GB3", "EME2"))
    expected = tl.run(tl.Case.from_toml(other), leave_out=("sensitivity",), workers=1).life.years("base")
    years = result.remedies.dataset["road_years"].sel(remedy="EB-EME2 in place of EB-GB3")
    assert float(years) == pytest.approx(expected, rel=1e-9)
    page = tmp_path / "page.html"
    tl.report(result, page)
    assert "What would help" in page.read_text()
    assert "3 cm more EB-GB3" in page.read_text()


def test_a_mix_that_is_not_there_is_refused_before_anything_is_solved(tmp_path):
    file = tmp_path / "case.toml"
    file.write_text(CASE.replace('"EME2"', '"EME9"'))
    with pytest.raises(InputError, match="EME"):
        tl.Case.from_toml(file)
