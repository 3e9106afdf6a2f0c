"""Studies against what must hold whatever they solve: where things stand, how they scale, what is said."""

import math
import re
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

import treadload as tl
from cases import COARSE_CASE
from treadload.contact import Rolling, solve_contact
from treadload.damage import AxleClass, Climate, Criterion, FatigueLine, Traffic
from treadload.damage.miner import miner
from treadload.damage.uniform import COMPUTED, DISC, RECTANGLE, compare_uniform
from treadload.errors import InputError
from treadload.life import life_sensitivity
from treadload.life.caveats import traffic_caveats
from treadload.life.contacts import Contacts
from treadload.life.delamination import AFTER, BEFORE, PARTING, BondComparison
from treadload.life.passages import solve_passages
from treadload.life.solve import solve_life
from treadload.life.variants import Solver
from treadload.life.wheels import across
from treadload.materials import Elastic
from treadload.pavement import FRICTIONLESS, Layer, Pavement
from treadload.steps import outline, plan
from treadload.tire import Tire, TreadProfile

TIRE = Tire.from_profile(TreadProfile(0.538, 1.678, 0.2, 0.0088), inflation_pressure=820e3)
HALF = Pavement.half_space(Elastic(5e9, 0.35))
TWO = Pavement([Layer(Elastic(5e9, 0.35), 0.15), Layer(Elastic(1e8, 0.35))])
COARSE = {"spacing": 20e-3}
BASE = Criterion("base", FatigueLine(90e-6, -0.2), 0)
ONE = AxleClass("one", 1.0, 20e3, 820e3)
TOP = Criterion("top", FatigueLine(90e-6, -0.2), 0, "top")
CLIMATE = Climate.constant(15.0)


@pytest.fixture(scope="module")
def driving():
    wheel = Rolling(normal_load=20e3, tractive_force=5e3, lateral_force=-2e3, friction=0.7)
    # Points further apart than two cells stand for themselves: at 20 mm, on cells of less than 10.
    return solve_contact(TIRE, TWO, wheel, spacing=9.5e-3)


@pytest.mark.parametrize("depths", [[0.02], [0.15]])
@pytest.mark.slow
def test_uniform_loads_are_read_wherever_the_wheels_stand(driving, depths):
    """A wheel elsewhere reads the same; so do two that are far from each other."""
    asked = {"depths": depths, "mean_over": None}
    here = compare_uniform(driving, TWO, **asked).dataset
    for wheels in (((2.0, -1.5),), ((-1.5, 0.0), (1.5, 1.0)), ((0.0, 1.5), (0.0, -1.5))):
        there = compare_uniform(driving, TWO, wheels=wheels, **asked).dataset
        for name in ("largest_extension", "largest_vertical_compression", "largest_vertical_shear"):
            # What a second wheel adds at 3 m, and points that stand elsewhere by a part of their step.
            np.testing.assert_allclose(there[name], here[name], rtol=0.02, err_msg=name)


def test_deep_down_two_wheels_press_hardest_between_them(driving):
    """Also where no cell of a contact stands: half a metre below wheels that are 0.36 m apart."""
    wheels, z = ((0.0, -0.18), (0.0, 0.18)), 0.5
    found = compare_uniform(driving, HALF, depths=[z], wheels=wheels).dataset["largest_vertical_compression"]
    disc = tl.UniformDisc(math.sqrt(20e3 / 820e3 / math.pi), 820e3)
    pair = [tl.response.place_load(disc, x=x, y=y) for x, y in wheels]
    there = tl.solve_response(pair, HALF, depths=[z], x=[0.0], y=[0.0, 0.18]).dataset["strain_zz"]
    middle, under = (-float(there[0, k, 0]) for k in (0, 1))
    assert middle > 1.02 * under
    # Points 20 mm apart, of which one lies within 10 mm of the middle: (0.01/0.5)² of the reading.
    assert float(found.sel(load=DISC)[0]) == pytest.approx(middle, rel=2e-3)


def test_the_rectangle_carries_the_shear_of_the_contact(driving):
    """γ = |q| / G on the surface of the evenly sheared rectangle, with both components."""
    found = compare_uniform(driving, HALF, depths=[0.0], mean_over=None, slenderness=1.5).dataset
    shear = math.hypot(5e3, 2e3) / float(found["uniform_area"])
    expected = shear / (5e9 / 2.7)
    assert float(found["largest_vertical_shear"].sel(load=RECTANGLE)[0]) == pytest.approx(expected, rel=1e-3)
    assert float(found["largest_vertical_shear"].sel(load=DISC)[0]) < 1e-6 * expected
    # Whoever gives a pressure gets it, on the area that carries the load.
    given = compare_uniform(driving, HALF, depths=[0.1], pressure=600e3).dataset
    assert float(given["uniform_pressure"]) == 600e3
    assert float(given["uniform_area"]) == pytest.approx(20e3 / 600e3, rel=1e-6)


def test_the_table_of_uniform_loads_is_that_of_the_dataset(driving):
    compared = compare_uniform(driving, TWO, depths=[0.02, 0.15])
    rows = compared.rows()
    for depth in (0.02, 0.15):
        numbers = [float(row.number) for row in rows if row.group.startswith(f"{1e3 * depth:.0f} mm deep, ")]
        names = ("largest_extension", "largest_in_plane_extension", "largest_vertical_shear")
        data = compared.dataset.sel(depth=depth)
        wanted = [1e6 * float(data[name].sel(load=load)) for load in (COMPUTED, DISC, RECTANGLE) for name in names]
        np.testing.assert_allclose(numbers, wanted, atol=0.051)


def contact_on(cells, step):
    y = step * (np.arange(cells) - (cells - 1) / 2)
    return SimpleNamespace(dataset=xr.Dataset(coords={"y": y}, attrs={"dy": step}))


@pytest.mark.parametrize("wheels", [((0.0, -0.9),), ((0.0, 0.9),), ((0.0, -0.9), (1.3, 0.2))])
def test_readings_reach_a_foot_beyond_the_outermost_wheel_on_either_side(wheels):
    row = AxleClass("aside", 1.0, 2e4, 8e5, wheels)
    y = across([contact_on(9, 0.02), contact_on(5, 0.02)], [replace(row, wheels=((0.0, 0.0),)), row])
    assert y[0] == pytest.approx(-0.9 - 0.08 / 2 - 0.3, abs=0.021)
    assert y[-1] == pytest.approx(0.9 + 0.08 / 2 + 0.3, abs=0.021)
    steps = np.diff(y)
    assert steps.max() <= 2e-3 + 1e-12
    np.testing.assert_allclose(steps, steps[0], rtol=1e-9)


def test_caveats_ask_the_tire_of_the_class():
    """Forty, meant as kilonewtons: too little for a truck's tire, and not for the trolley's of the other classes."""
    narrow = Tire.from_profile(TreadProfile(0.3, 0.6, 0.06, 0.008), inflation_pressure=8e5)
    wide = Tire.from_profile(TreadProfile(0.54, 1.7, 0.38, 0.009), inflation_pressure=8e5)
    light = AxleClass("light", 1.0, 40.0, 8e5)

    def loads_doubted(row, common=narrow):
        return [text for text in traffic_caveats(common, Traffic((row,), 1e5), CLIMATE) if "load" in text]

    assert not loads_doubted(light)
    assert loads_doubted(light, common=wide) == loads_doubted(replace(light, tire=wide)) != []
    assert not loads_doubted(replace(light, tire=narrow), common=wide)


def test_damage_of_a_changed_question_is_that_of_its_life():
    """What the sensitivities solve is what a life solves: the largest damage of a year."""
    pair = replace(ONE, wheels=((0.0, 0.0), (1.4, 0.0)))
    traffic = Traffic((pair,), 1e5)
    life = solve_life(tl.Design(TIRE, TWO, traffic, CLIMATE, (BASE,), **COARSE), workers=1)
    solver = Solver(BASE, [(0, 0)], Contacts(TIRE, 20e-3), None)
    with ThreadPoolExecutor(1) as pool:
        (found, doubled) = solver.damages([(TWO, traffic, CLIMATE), (TWO, Traffic((pair,), 2e5), CLIMATE)], pool)
    assert found == pytest.approx(float(life.dataset["damage_per_year"].max()), rel=1e-9)
    assert doubled == pytest.approx(2 * found, rel=1e-12)
    assert (solver.solved, solver.responses) == (1, 2)


@pytest.mark.slow
def test_elasticities_of_one_layer_on_nothing_else_have_closed_forms():
    """On a half-space under a soft tire strain goes as 1/E: life goes as E to the power of -1/slope."""
    traffic = Traffic((ONE,), 1e5)
    design = tl.Design(TIRE, HALF, traffic, CLIMATE, (TOP,), **COARSE)
    life = solve_life(design, workers=1)
    told = []
    found = life_sensitivity(design, life, progress=lambda *said: told.append(said), workers=1)
    values = dict(zip(found.dataset["input"].to_numpy(), found.dataset["elasticity"].to_numpy(), strict=True))
    (modulus,) = [value for name, value in values.items() if name.startswith("modulus")]
    # ln(1.05 / 0.95) in place of the derivative leaves 1e-3 of it.
    assert modulus == pytest.approx(5, rel=5e-3)
    assert values["wheel load"] < 0
    # Every solve is told once, and the last is the last.
    assert [done for done, _, _ in told] == list(range(1, len(told) + 1))
    assert told[-1][0] == told[-1][1] == found.contacts + found.responses
    assert {what for _, _, what in told} == {"contact", "response"}


@pytest.mark.parametrize("coverage", [0.0, -0.1, 1.0001, math.nan])
def test_a_coverage_that_is_no_share_is_refused_before_anything_is_solved(coverage):
    with pytest.raises(InputError, match="coverage must lie in"):
        life_sensitivity(None, None, coverage=coverage)


def test_the_solves_of_several_classes_are_counted_to_the_last():
    """Two contacts; the heavier class in every road, the other where the first needs it."""
    traffic = Traffic((replace(ONE, share=0.5), AxleClass("other", 0.5, 15e3, 700e3)), 1e5)
    told = []
    found = solve_passages(
        tl.Design(TIRE, HALF, traffic, CLIMATE, (TOP,), **COARSE), progress=lambda *said: told.append(said), workers=1
    )
    assert (found.contacts, found.responses) == (2, 2)
    assert told[-1][:2] == (4, 4)
    assert [what for _, _, what in told].count("contact") == 2


def test_each_criterion_is_read_on_its_side_of_an_interface():
    """Across a frictionless interface strain jumps: the bottom of a course is pulled, the top of the base is not."""
    road = Pavement([Layer(Elastic(5e9, 0.35), 0.1, bond=FRICTIONLESS), Layer(Elastic(2e9, 0.35))])
    above, below = (
        Criterion("bottom", FatigueLine(1e-4, -0.2), 0),
        Criterion("top", FatigueLine(1e-4, -0.2), 1, "top"),
    )
    read = solve_passages(
        tl.Design(TIRE, road, Traffic((ONE,), 1), CLIMATE, (above, below), **COARSE), workers=1
    ).readings
    contact = solve_contact(TIRE, road, Rolling(normal_load=20e3, friction=0.7), spacing=20e-3)
    x = np.arange(-0.3, 0.3, 0.02)
    for criterion, side in (("bottom", "above"), ("top", "below")):
        data = tl.solve_response(contact, road, depths=[0.1], x=x, y=x, side=side).dataset
        largest = float(data["in_plane_strain_1"].max())
        # 20 mm between points of a field 0.1 m wide: a per cent of what is read above the interface.
        assert float(read.sel(criterion=criterion).max()) == pytest.approx(largest, rel=0.02, abs=1e-6)
    assert float(read.sel(criterion="bottom").max()) > 1.5 * float(read.sel(criterion="top").max())


def comparison(years, between):
    """A comparison of bonds with given lives (state, criterion), and which criteria are bonds."""
    names = [f"c{k}" for k in range(len(between))]
    criteria = tuple(
        SimpleNamespace(
            name=name, quantity=SimpleNamespace(between_layers=one, in_words=lambda value: f"{value:g} units")
        )
        for name, one in zip(names, between, strict=True)
    )
    lives = SimpleNamespace(criteria=criteria, warnings=("told once",))
    dims = ("state", "criterion")
    data = xr.Dataset(
        {
            "life_years": (dims, np.asarray(years, dtype=float)),
            "largest_reading": (dims, np.arange(3.0 * len(names)).reshape(3, -1)),
            "parting_passes": 2e5,
            "parting_years": 1.5,
        },
        {"state": [BEFORE, AFTER, PARTING], "criterion": names},
        {"between": "asphalt / base"},
    )
    return BondComparison(data, lives, lives, 0, FRICTIONLESS, names[0])


def test_the_road_ends_with_the_first_of_its_layers_and_not_with_its_bond():
    years = [[9, 9, 9], [0.1, 0.2, 0.3], [1, 5, 4]]
    assert comparison(years, [True, False, False]).governing == "c2"
    assert comparison(years, [False, False, False]).governing == "c0"
    # Where nothing but bonds was asked, the first of them.
    assert comparison(years, [True, True, True]).governing == "c0"
    assert comparison([[9, 9], [9, 9], [math.inf, 3]], [False, True]).governing == "c0"


def test_the_table_of_a_parted_bond_leaves_out_what_means_nothing():
    compared = comparison([[9, 8], [0.1, 0.2], [1.5, 4]], [True, False])
    lines, rows = compared.summary().splitlines(), compared.rows()
    bond, layer = ([row.text for row in rows if row.group.startswith(name)] for name in ("c0", "c1"))
    # Bonded, parted, and one after the other; the parted bond's own criterion is not read.
    assert bond == ["0 units", "9 years", "–", "–", "4 units", "1.5 years"]
    assert layer == ["1 units", "8 years", "3 units", "0.2 years", "5 units", "4 years"]
    assert lines.count("warning: told once") == 1
    verdict = rows[-1].text
    assert re.match(r"c0 .* after 2e\+05 load repetitions, 1\.5 years; c1 governs", verdict)
    assert verdict.endswith("lasts 4 years instead of 8 years.")


@pytest.mark.parametrize(
    ("transform", "told"), [(1e-9, r"about \S+ s on"), (0.06, r"about \d\d s on"), (0.5, r"about \d+(\.\d)? min on")]
)
def test_a_plan_tells_seconds_or_minutes(monkeypatch, transform, told):
    """By how fast this machine is; some 24 s where a transform takes 60 ms."""
    monkeypatch.setattr(outline, "_transform", lambda: transform)
    text = plan(tl.Case.from_text(COARSE_CASE))
    assert re.search(told, text), text


@pytest.mark.parametrize("road", [HALF, TWO])
def test_an_estimate_adds_up_what_is_solved(monkeypatch, road):
    monkeypatch.setattr(outline, "_transform", lambda: 1.0)
    nothing, some, more = (outline.seconds_of(road, cells, 0, 0) for cells in (0, 1000, 2000))
    assert nothing == 0
    # A contact takes something besides its cells.
    assert some - nothing > more - some > 0
    assert outline.seconds_of(road, 0, 10, 20) == pytest.approx(
        outline.seconds_of(road, 0, 10, 0) + outline.seconds_of(road, 0, 0, 20)
    )
    assert outline.seconds_of(road, 0, 20, 0) == pytest.approx(2 * outline.seconds_of(road, 0, 10, 0))


def test_a_transform_takes_time():
    assert 0 < outline._transform() < 60


def test_a_plan_says_what_the_verdict_reads():
    assert "means over 10 mm in the top layer" in plan(tl.Case.from_text(COARSE_CASE))
    deep = plan(tl.Case.from_text(COARSE_CASE, changes=["damage.depth=20 mm"]))
    assert "points at 20 mm" in deep
    assert "means over" not in deep


def test_years_of_a_life_add_up_over_classes():
    """Half of the passes in each of two equal classes is one class with all of them."""
    y = np.linspace(-0.4, 0.4, 41)
    bell = 1e-4 * np.exp(-(y**2) / 0.02)
    halves = Traffic((replace(ONE, name="a", share=0.5), replace(ONE, name="b", share=0.5)), 1e5, 0.03)
    two = miner(np.stack([[[bell], [bell]]]), (BASE,), halves, CLIMATE, y=y)
    one = miner(np.stack([[[bell]]]), (BASE,), Traffic((ONE,), 1e5, 0.03), CLIMATE, y=y)
    assert two.years("base") == pytest.approx(one.years("base"), rel=1e-12)
    np.testing.assert_allclose(two.dataset["damage_share"].to_numpy().ravel(), 0.5, rtol=1e-12)
