"""Many loads on many roads at once: every pair is what it is alone, and what is shared is computed once."""

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from treadload import variables
from treadload.contact import Maneuver
from treadload.damage import AxleClass, Climate, Criterion, FatigueLine, FrenchSubgrade, Traffic
from treadload.damage.indices import tearing_work
from treadload.damage.quantity import STRAIN, STRESS
from treadload.grid import Grid
from treadload.kernels.gridding.points import Points
from treadload.life import surface_works
from treadload.life.contacts import Contacts, Counter
from treadload.life.design import Design
from treadload.life.passage import Passing, batches, passages
from treadload.life.seasons import Warm
from treadload.life.wheels import Wheels, state
from treadload.materials import Elastic, Mix, Prony
from treadload.pavement import HALF_BONDED, Layer, Pavement
from treadload.response import GridLoad, UniformDisc, layout, several, solve_response
from treadload.response import layered as layered_module
from treadload.response.layered import View
from treadload.response.several import Question, tensors_of_many
from treadload.tire import Tire, TreadProfile

X, Y = np.linspace(-0.1, 0.13, 5), np.linspace(-0.09, 0.08, 3)
RANDOM = np.random.default_rng(5)
GRID = Grid(6, 5, 0.02, 0.018, -0.05, -0.036)


def load(grid=GRID, shear=1.0):
    pressure, along, across = RANDOM.uniform(0, 1e6, (3, *grid.shape))
    return GridLoad(grid, pressure, shear * along, shear * across)


def road(modulus=5e9, thickness=0.08, poisson=0.35, bond=None):
    more = {} if bond is None else {"bond": bond}
    return Pavement(
        [
            Layer(Elastic(modulus, poisson), thickness, "top", **more),
            Layer(Elastic(8e8, 0.4), 0.2, "base"),
            Layer(Elastic(1e8, 0.45), None, "soil"),
        ]
    )


LOADS = ([load()], [load(shear=0.0), load().moved(0.4, 0.02), UniformDisc(0.1, 7e5, 0.02)])
ROADS = (
    road(9e9),
    road(thickness=0.1, poisson=0.25),
    road(bond=HALF_BONDED),
    Pavement.half_space(Elastic(5e9, 0.35)),
)


@pytest.mark.parametrize(("side", "mean_over"), [("above", None), ("below", 0.01)])
@pytest.mark.slow
def test_every_pair_is_what_it_is_alone(side, mean_over):
    questions = [
        Question(loads, one, np.array([0.003, float(one.interfaces[0]) if len(one.interfaces) else 0.1]))
        for one in ROADS
        for loads in LOADS
    ]
    asked = {"side": side, "mean_over": mean_over}
    found = tensors_of_many(questions, X, Y, needs=(*STRESS, *STRAIN), **asked)
    assert len(found) == len(questions)
    for question, one in zip(questions, found, strict=True):
        alone = solve_response(question.loads, question.road, depths=question.depths, x=X, y=Y, **asked).dataset
        for name in (*STRESS, *STRAIN):
            size = max(float(np.abs(alone[part]).max()) for part in alone if str(part).startswith(name[:6]))
            # Waves as readings need them, multiplied in single numbers.
            np.testing.assert_allclose(one[name], alone[name], rtol=0, atol=1e-6 * size, err_msg=name)


@pytest.mark.parametrize(
    "needs", [("strain_zz",), ("strain_xx", "strain_yy", "strain_xy"), ("stress_xz", "stress_yz"), STRESS]
)
def test_only_the_components_asked_for_are_given_and_are_the_same(needs):
    questions = [Question(LOADS[1], one, np.array([0.0, 0.08])) for one in ROADS[:2]]
    whole = tensors_of_many(questions, X, Y, needs=(*STRESS, *STRAIN))
    for one, all_of_it in zip(tensors_of_many(questions, X, Y, needs=needs), whole, strict=True):
        assert set(one.data_vars) == set(needs)
        for name in needs:
            # Sums in another order.
            size = max(float(np.abs(all_of_it[part]).max()) for part in all_of_it if str(part).startswith(name[:6]))
            np.testing.assert_allclose(one[name], all_of_it[name], rtol=0, atol=1e-12 * size)


def test_other_variables_are_left_to_the_whole_response():
    question = [Question(LOADS[0], ROADS[0], np.array([0.05]))]
    assert tensors_of_many(question, X, Y, needs=("strain_xx", "principal_strain_1")) is None


@pytest.mark.parametrize(
    "at", [None, pytest.param(Points.of(X[[0, 2, 3]], Y)[0], marks=pytest.mark.slow)], ids=["grid", "points"]
)
@pytest.mark.parametrize("loads", [LOADS[0], LOADS[1], [replace(LOADS[0][0], interpolation="bilinear")]])
def test_sums_over_depths_are_those_of_the_depths(loads, at):
    """In the waves, in the closed form, under discs, between two bonds, where there are no layers and at a speed."""
    # Some depths with the half-space split off and some without, two in one sum; one of the surface; one deep alone.
    depths = np.array([0.0, 0.004, 0.01, 0.07, 0.075])
    mean = np.array([[0.5, 0.3, 0.2, 0.0, 0.0], [0.0, 0.1, 0.5, 0.4, 0.0], [0.0, 0.0, 0.0, 0.0, 1.0]])
    x, y = (X, Y) if at is None else Points.of(X[[0, 2, 3]], Y)[1:]
    slow = Pavement([Layer(Prony(9e9, [(0.3, 0.05)], 0.35), 0.08), Layer(Elastic(1e8, 0.4))])
    for one, speed in ((ROADS[0], None), (ROADS[2], None), (ROADS[3], None), (slow, 20.0)):
        asked = {"view": View(x, y, at), "side": "above", "speed": speed, "mean_over": None}
        (each,), (summed,) = (
            several.answers([Question(loads, one, depths, weights)], **asked) for weights in (None, mean)
        )
        for name in ("stress", "strain", "displacement"):
            expected = np.einsum("rz,czyx->cryx", mean, getattr(each.fields, name))
            found, size = getattr(summed.fields, name), np.nanmax(np.abs(expected))
            assert found.shape == expected.shape
            # As many digits as waves have, cut as they are at the shallower of two depths.
            np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9 * size, err_msg=f"{name} in {one}")


def test_what_pairs_share_is_computed_once(monkeypatch):
    """The half-space for each Poisson's ratio, the layers' functions for each road and depth."""
    calls = {"half": 0, "transfer": 0}
    half, transfer = layered_module.half_space_fields, layout.transfer

    def counted(name, function):
        def count(*given, **more):
            calls[name] += 1
            return function(*given, **more)

        return count

    monkeypatch.setattr(layered_module, "half_space_fields", counted("half", half))
    monkeypatch.setattr(layout, "transfer", counted("transfer", transfer))
    layout._plane.cache_clear()
    roads, wheels = [road(modulus) for modulus in (2e9, 3e9, 4e9)], (LOADS[0], [load()])
    questions = [Question(loads, one, np.array([0.0])) for one in roads for loads in wheels]
    tensors_of_many(questions, X, Y, needs=STRESS)
    # Of a road: its layers and its half-space.
    assert calls == {"half": 1, "transfer": 2 * len(roads)}
    tensors_of_many(questions, X, Y, needs=STRESS)
    assert calls["transfer"] == 2 * len(roads)


def test_loads_on_one_road_at_the_same_depths_stand_on_one_site(monkeypatch):
    """And what the closed form would cost under a load is counted once for all roads."""
    sites, costs = [], []
    whole, cost = several.layered_responses, layered_module.grid_cost

    def told(loads, places, pairs, *rest, **more):
        sites.append((len(places), pairs))
        return whole(loads, places, pairs, *rest, **more)

    monkeypatch.setattr(several, "layered_responses", told)
    monkeypatch.setattr(layered_module, "grid_cost", lambda *given: costs.append(1) or cost(*given))
    wheels = ([load()], [load()], [load()])
    questions = [Question(one, own, np.array([0.0, 0.01])) for own in ROADS[:2] for one in wheels]
    tensors_of_many(questions, X, Y, needs=STRESS)
    assert sites == [(2, [(load, site) for site in range(2) for load in range(3)])]
    assert len(costs) == 1


def test_tearing_is_worked_out_once_for_all_seasons(monkeypatch):
    given, calls = {"x": np.arange(4) * 0.01, "y": np.arange(3) * 0.01}, []
    shear = {f"traction_{name}": (("y", "x"), RANDOM.uniform(-1e5, 1e5, (3, 4))) for name in "xy"}
    contact = variables.dataset(shear, given)
    row, tire = AxleClass("one", 1.0, 20e3, 820e3), Tire.from_profile(TreadProfile(0.538, 1.678, 0.2, 0.0088))
    mix = Mix("mix", (0.0, 30.0), (10.0,), ((9e9, 1e9),), 0.35)
    warm = Pavement([Layer(mix, 0.1), Layer(Elastic(1e8, 0.4))])
    monkeypatch.setattr(surface_works, "tearing_work", lambda *one: calls.append(1) or tearing_work(*one))
    year = Climate.equal_parts([5.0, 25.0])
    design = Design(tire, warm, Traffic((row,), 1e6), year, [Criterion("soil", FrenchSubgrade(), -1)])
    design.contacts.solved[state(row)] = SimpleNamespace(dataset=contact)
    found = surface_works.surface_works(design)
    moduli = [warm.at_temperature(t).layers[0].resolved.shear_modulus for t in (5.0, 25.0)]
    expected = [[float(tearing_work(contact, one).max()) for one in moduli]]
    np.testing.assert_allclose(found["largest_tearing_work"][1], expected, rtol=1e-14)
    assert len(calls) == 1


def test_the_rest_of_a_road_that_is_no_number_is_refused(monkeypatch):
    nothing = np.full((6, 1, 3, 5), np.nan)
    monkeypatch.setattr(several, "layered_responses", lambda *given, **more: iter([(nothing,) * 4]))
    with pytest.raises(several.ConvergenceError, match="is not a number"):
        tensors_of_many([Question(LOADS[0], ROADS[0], np.array([0.05]))], X, Y, needs=("strain_zz",))


CELLS = Grid(5, 5, 0.02, 0.02, -0.04, -0.04)
ACROSS = 0.02 * np.arange(-10, 11)
CRITERIA = (
    Criterion("top", FatigueLine(90e-6, -0.2), 0, "top", "principal"),
    Criterion("base", FatigueLine(90e-6, -0.2), 1),
    Criterion("soil", FrenchSubgrade(), -1, "top"),
)


def wheels(places=((0.0, 0.0),), cells=CELLS, *, pushed=False):
    one = load(cells)
    loads = tuple(one.moved(x, y) for x, y in places)
    x = np.array([cells.x + at for at in sorted({x for x, _ in places})])
    return Wheels(loads, x, None, "one", 0.0, has_side_force=pushed)


@pytest.fixture(scope="module")
def tasks():
    warm = [Warm(road(modulus), CRITERIA) for modulus in (3e9, 6e9)]
    rolling = [wheels(), wheels(), wheels(((0.0, 0.0), (0.6, 0.0)))]
    return [Passing(one, season, ACROSS, 3) for one in rolling for season in warm]


def test_passages_together_are_those_alone(tasks):
    for members in batches(tasks):
        together = passages([tasks[number] for number in members])
        for number, found in zip(members, together, strict=True):
            task = tasks[number]
            (alone,) = passages([task])
            size = np.abs(alone[:, :3]).max(axis=(1, 2), keepdims=True)
            # Single numbers, added up in another order.
            np.testing.assert_allclose(found[:, :3] / size, alone[:, :3] / size, rtol=0, atol=1e-6)
            # A trace at the angle π/2 is the one at -π/2; it turns by the error over the gap of principals.
            np.testing.assert_allclose(np.sin(found[:, 3:] - alone[:, 3:]), 0 * found[:, 3:], atol=1e-5)


def test_wheels_with_a_side_force_go_with_others_on_the_same_cells():
    """The basin and what lies deep are solved together, means near the surface on rows of their own."""
    surface = Criterion("surface", FatigueLine(90e-6, -0.2), 0, "top", "principal", length=0.03)
    season = Warm(road(6e9), (surface, *CRITERIA))
    several = [Passing(wheels(pushed=pushed), season, ACROSS, 3) for pushed in (False, True)]
    assert [task.wheels.parts > 1 for task in several] == [False, True]
    assert batches(several) == [[0, 1]]
    for found, task in zip(passages(several), several, strict=True):
        (alone,) = passages([task])
        size = np.abs(alone[:, :3]).max(axis=(1, 2), keepdims=True)
        np.testing.assert_allclose(found[:, :3] / size, alone[:, :3] / size, rtol=0, atol=1e-6)


def test_what_stands_on_the_same_cells_goes_together_road_by_road(tasks, monkeypatch):
    assert batches(tasks) == [[0, 2, 1, 3], [4, 5]]
    # However much is asked, fields stay small.
    monkeypatch.setattr("treadload.life.passage._TOGETHER", 1)
    assert batches(tasks) == [[0], [2], [1], [3], [4], [5]]
    slow = Passing(wheels(), Warm(Pavement([Layer(Prony(9e9, [(0.3, 0.05)], 0.35))]), CRITERIA[:1]), ACROSS, 3)
    assert batches([tasks[0], slow]) == [[0], [1]]


def test_near_contacts_start_from_each_other_and_come_to_the_same():
    tire = Tire.from_profile(TreadProfile(0.538, 1.678, 0.2, 0.0088), inflation_pressure=820e3)
    row = AxleClass("one", 1.0, 20e3, 820e3)
    light, heavy = state(row), state(AxleClass("one", 1.0, 21e3, 820e3))
    said = []
    asked = {"road": Pavement.half_space(Elastic(5e9, 0.35))}
    with ThreadPoolExecutor(1) as pool:
        shared, cold = Contacts(tire, 20e-3), Contacts(tire, 20e-3)
        count = Counter(2, lambda *words: said.append(words))
        shared.solve([light, light], **asked, pool=pool, count=count)
        assert shared.missing([light, heavy, heavy]) == [heavy]
        shared.solve([light, heavy], **asked, pool=pool, count=count)
        cold.solve([heavy], **asked, pool=pool, count=Counter(1, None))
    assert said == [(1, 2, "contact"), (2, 2, "contact")]
    warm, alone = shared.solved[heavy].dataset["pressure"], cold.solved[heavy].dataset["pressure"]
    assert shared.solved[heavy].stats["normal_iterations"] <= cold.solved[heavy].stats["normal_iterations"]
    # Both hold the contact conditions within 3e-5 of the approach.
    warm = warm.sel(x=alone["x"], y=alone["y"], method="nearest", tolerance=1e-6)
    np.testing.assert_allclose(warm, alone, rtol=0, atol=1e-4 * float(alone.max()))
    assert math.isclose(float(shared.solved[heavy].dataset["normal_load"]), 21e3, rel_tol=1e-9)


def test_other_maneuvers_begin_at_the_pressure_under_the_same_load_and_come_to_the_same():
    tire = Tire.from_profile(TreadProfile(0.538, 1.678, 0.2, 0.0088), inflation_pressure=820e3)
    turned = (Maneuver(), Maneuver.braking(2.0))
    straight, braked = (state(AxleClass("one", 1.0, 20e3, 820e3, maneuver=one)) for one in turned)
    asked = {"road": Pavement.half_space(Elastic(5e9, 0.35))}
    with ThreadPoolExecutor(1) as pool:
        shared, cold = Contacts(tire, 10e-3), Contacts(tire, 10e-3)
        shared.solve([straight, braked], **asked, pool=pool, count=Counter(2, None))
        cold.solve([braked], **asked, pool=pool, count=Counter(1, None))
    warm, alone = shared.solved[braked], cold.solved[braked]
    assert warm.stats["normal_iterations"] < alone.stats["normal_iterations"]
    # The shear begins on half the grid, not with that of a free wheel.
    assert warm.stats["newton_iterations"] <= alone.stats["newton_iterations"]
    for name in ("pressure", "traction_x"):
        # Both hold their conditions within 3e-5.
        apart = np.abs(warm.dataset[name].to_numpy() - alone.dataset[name].to_numpy()).max()
        assert apart < 1e-4 * float(alone.dataset["pressure"].max())
