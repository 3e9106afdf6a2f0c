"""The first crack from the surface: both directions, its load and season, and shares of what opens it."""

from functools import cache

import numpy as np
import pytest

from treadload.app.pictures import pictures_for, pictures_of
from treadload.case import Case
from treadload.contact.maneuver import STRAIGHT, Maneuver
from treadload.damage.cycles import harm_of, harm_of_each
from treadload.damage.laws.fatigue import FatigueLine
from treadload.life.first_crack import rolling_freely
from treadload.life.seasons import warmed
from treadload.life.solve import solve_life, solve_sum
from treadload.reporting.life import life_report
from treadload.response.several import Question, tensors_of_many
from treadload.results import to_tree
from treadload.steps.design import design_of

CASE = """
spacing = "10 mm"
[tire]
profile = "315/80R22.5"
[pavement]
layers = [
  { name = "asphalt", thickness = "%s", material = { modulus = "%s", poisson = 0.35 } },
  { name = "soil", material = { modulus = "80 MPa", poisson = 0.35 } },
]
[climate]
temperature = 15
[traffic]
passes_per_year = 1e5
wander = { deviation = "100 mm" }
[[traffic.classes]]
name = "axle"
share = 1
wheel_load = "35 kN"
inflation_pressure = "8.3 bar"
wheels = %s
maneuver = %s
[[criteria]]
name = "surface"
law = "fatigue-line"
layer = "asphalt"
place = "top"
epsilon_6 = "30 microstrain"
slope = -0.2
[[criteria]]
name = "soil"
law = "french-subgrade"
"""
TURNING = '{ kind = "turning", radius = 15, speed = 9 }'
BRAKING = '{ kind = "braking", deceleration = 4 }'
STIFF, SOFT = ("200 mm", "5400 MPa"), ("200 mm", "600 MPa")


@cache
def solved(road=STIFF, maneuver='"straight"', wheels="[[0, 0]]"):
    text = CASE % (*road, wheels, maneuver if maneuver.startswith("{") else '{ kind = "straight" }')
    design = design_of(Case.from_text(text, name="case"))
    return design, solve_life(design)


def of_surface(life, name):
    return life.dataset[name].sel(criterion="surface").to_numpy()


@pytest.mark.parametrize(("road", "maneuver"), [(STIFF, "straight"), (STIFF, BRAKING), (SOFT, BRAKING)])
def test_shares_of_what_opens_it_add_up_to_one(road, maneuver):
    _, life = solved(road, maneuver)
    shares = of_surface(life, "cause_share")
    assert shares.sum() == pytest.approx(1.0, abs=1e-12)
    assert (shares >= 0).all()
    assert np.isnan(life.dataset["cause_share"].sel(criterion="soil")).all()


def test_rolling_freely_braking_has_no_share_and_hogging_governs_a_stiff_road():
    _, life = solved(STIFF, "straight")
    hogging, tread, force = of_surface(life, "cause_share")
    assert force == 0
    # A stiff plate bends; what this tread's edges do lies where nothing is in tension.
    assert hogging > 0.95
    assert tread == pytest.approx(1 - hogging)
    (line,) = [row.value for row in life.rows() if row.key == "first_crack_cause"]
    assert line.startswith("surface: ")
    assert "under axle in" in line
    assert "0 % braking or driving" in line


def test_where_a_wheel_scuffs_the_near_field_governs_and_the_crack_runs_along_travel():
    _, life = solved(STIFF, TURNING)
    hogging, tread, force = of_surface(life, "cause_share")
    assert force == 0
    assert tread > 0.9
    assert hogging < 0.1
    transverse, longitudinal = of_surface(life, "crack_repetitions")
    assert longitudinal < transverse
    (line,) = [row.value for row in life.rows() if row.key == "first_crack_cause"]
    assert line.startswith("surface: longitudinal first")


def test_a_braked_wheel_opens_the_surface_behind_itself_across_travel():
    _, life = solved(STIFF, BRAKING)
    _, _, force = of_surface(life, "cause_share")
    transverse, longitudinal = of_surface(life, "crack_repetitions")
    assert force > 0.5
    assert transverse < longitudinal


def test_the_directions_are_the_strains_across_them_on_a_fine_field():
    design, life = solved(STIFF, "straight")
    passages = solve_sum(design).passages
    warm = warmed(design.road, design.criteria[:1], design.climate.seasons[0])
    x = np.concatenate([np.arange(-1.3, -0.24, 0.01), np.arange(0.24, 1.3, 0.01)])
    question = Question(passages.wheels[0].joined, warm.road, np.zeros(1))
    needs = design.criteria[0].needs
    # Ahead and behind on the wheel's line, and beside it: the footprint itself is squeezed.
    (along,) = tensors_of_many([question], x, np.array([0.0]), needs=needs, mean_over=0.01)
    (beside,) = tensors_of_many([question], np.array([0.0]), x, needs=needs, mean_over=0.01)
    expected = [float(along["strain_xx"].max()), float(beside["strain_yy"].max())]
    # The basin's coarse points: half a per cent; rows along x between those of the fine field a little more.
    np.testing.assert_allclose(of_surface(life, "crack_strain"), expected, rtol=0.02)
    # Two alike cycles a passage, spread by no more than the basin's width: one cycle at most, half of it at least.
    law = FatigueLine(30e-6, -0.2)
    allowed = law.allowable_passes(expected[0])
    assert 0.5 * allowed < of_surface(life, "crack_repetitions")[0] < 1.3 * allowed


def test_the_first_crack_of_a_mirrored_traffic_is_its_mirror_image():
    _, left = solved(STIFF, BRAKING, "[[0, -0.3], [0, 0.02]]")
    _, right = solved(STIFF, BRAKING, "[[0, 0.3], [0, -0.02]]")
    # Wheels stand on cells of 10 mm.
    np.testing.assert_allclose(of_surface(left, "crack_place"), -of_surface(right, "crack_place"), atol=0.011)
    np.testing.assert_allclose(of_surface(left, "cause_share"), of_surface(right, "cause_share"), atol=0.02)


def test_each_cycle_does_what_all_of_them_do_together():
    law = FatigueLine(100e-6, -0.2)
    tops, bottoms = np.array([[80e-6, 60e-6, 90e-6]]), np.array([[20e-6, 30e-6, 0.0]])
    each = harm_of_each(law, tops, bottoms)
    expected = ((tops / 100e-6) ** 5 - (bottoms / 100e-6) ** 5) / 1e6
    np.testing.assert_allclose(each, expected, rtol=1e-12)
    turns = np.array([90e-6, 20e-6, 80e-6, 30e-6, 60e-6])[:, None]
    assert each.sum() == pytest.approx(harm_of(law, turns)[0], rel=1e-12)


def test_rolling_freely_keeps_the_turn_and_the_side_force():
    turning = Maneuver("exit", tractive=-0.2, lateral=0.3, spin=0.02)
    free = rolling_freely(turning)
    assert (free.tractive, free.lateral, free.spin) == (0.0, 0.3, 0.02)
    assert rolling_freely(Maneuver.braking()) == STRAIGHT


def test_the_figure_shows_both_directions_and_what_opens_the_crack():
    _, life = solved(STIFF, BRAKING)
    figure = life.plot.first_crack()
    plan, bars = figure.axes
    texts = [text.get_text() for text in plan.texts]
    counts, places = (of_surface(life, f"crack_{name}") for name in ("repetitions", "place"))
    first = ("transverse", "longitudinal")[int(np.argmin(counts))]
    assert plan.get_title(loc="left") == f"First crack: {first}"
    for name, place in zip(("transverse", "longitudinal"), places, strict=True):
        assert any(text.startswith(f"{name}: after") and f"y = {1e3 * place:z.0f} mm" in text for text in texts)
    widths = [bar.get_width() for bar in bars.patches]
    assert widths == pytest.approx(100 * of_surface(life, "cause_share"))
    # Of a criterion without a crack from the surface the first that has one is drawn.
    assert life.plot.first_crack(criterion="soil").axes[0].get_title(loc="left") == f"First crack: {first}"


@pytest.mark.slow
def test_the_report_of_a_life_states_and_draws_the_first_crack():
    _, life = solved(STIFF, BRAKING)
    report = life_report("case", to_tree([life], title="case")["life"].to_dataset())
    (words,) = [text for text in report.groups if text.startswith("First crack from the surface by surface")]
    assert "transverse first, under axle" in words
    assert "braking or driving" in words
    assert any(picture.title == "First crack from the surface" for picture in report.pictures)
    # The table of all criteria is there although those of the surface have more rows.
    assert report.first is not None
    assert {line[0] for line in report.first.rows} == {"surface", "soil"}
    # The page draws the registered figures, for the criterion that is chosen too.
    page = pictures_of("life", {"life": life})["life.first_crack"]
    assert page["url"]
    assert pictures_for("life", {"life": life}, "soil")["life.first_crack"]["url"]
