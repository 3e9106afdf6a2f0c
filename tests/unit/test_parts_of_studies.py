"""The parts of a life and of a case on their own: where is read, what is solved, what stands between."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from scipy.interpolate import PchipInterpolator

import treadload as tl
from treadload.damage import Criterion, FatigueLine, miner
from treadload.damage.climate import Climate, Season
from treadload.damage.cycles import harm_of
from treadload.damage.traffic import AxleClass, Traffic, Wander
from treadload.grid import Grid
from treadload.life.climate import curves, nodes, over_the_climate, warmth_of
from treadload.life.groups import _one_axle, in_words
from treadload.life.lines import Plane, along, rows_of, stride_of
from treadload.life.peaks import Strips, onto_lines, over_strips, peaks_and_valleys
from treadload.life.sensitivity import _growth, _without_solves
from treadload.life.variants import most
from treadload.life.wheels import across, wheels_of
from treadload.materials import Elastic
from treadload.pavement import Layer, Pavement
from treadload.response import GridLoad, map_grid
from treadload.response.input_caveats import overlapping
from treadload.steps.slices import slice_depths

DX, DY = 0.01, 0.012
PRESSURE = np.ones((9, 7)) * 7e5
GRID = Grid(7, 9, DX, DY, -3 * DX, -4 * DY)


def contact(pressure=PRESSURE, grid=GRID):
    fields = {"pressure": (("y", "x"), pressure), "traction_x": (("y", "x"), 0.1 * pressure)}
    data = xr.Dataset(fields, {"y": grid.y, "x": grid.x}, {"dx": grid.dx, "dy": grid.dy})
    return SimpleNamespace(dataset=data)


TRIDEM = AxleClass("tridem", 1.0, 3e4, 8e5, tuple((x, y) for x in (1.3, 0.0, -1.31) for y in (-0.1733, 0.1733)))


@pytest.fixture(scope="module")
def y():
    return across([contact()], [TRIDEM])


@pytest.fixture(scope="module")
def wheels(y):
    return wheels_of([contact()], TRIDEM, y)


def test_readings_lie_on_the_cells_between_them_and_beside_the_wheels(y):
    steps = np.diff(y)
    assert np.ptp(steps) < 1e-12
    # At most 2 mm apart, on cells of 12 mm: six to a cell, and every cell's centre among them.
    assert steps[0] == pytest.approx(2e-3)
    assert all(np.abs(y - centre).min() < 1e-12 for centre in GRID.y)
    edge = 0.1733 + 4 * DY
    # A foot beside the outermost centres, to the next cell.
    assert edge + 0.3 <= y[-1] <= edge + 0.3 + 2 * DY
    assert -edge - 0.3 - 2 * DY <= y[0] <= -edge - 0.3


def test_wheels_stand_where_their_class_says_within_half_a_cell(wheels, y):
    assert len(wheels.loads) == 6
    for load, (x, right) in zip(wheels.loads, TRIDEM.wheels, strict=True):
        assert load.normal_load == pytest.approx(63 * 7e5 * DX * DY, rel=1e-12)
        assert abs(load.grid.x.mean() - x) <= DX / 2 + 1e-12
        assert abs(load.grid.y.mean() - right) <= DY / 2 + 1e-12
        assert np.abs(y - load.grid.y[0]).min() < 1e-12
    # From the rear to the front.
    assert wheels.x.mean(axis=1) == pytest.approx([-1.31, 0.0, 1.3], abs=DX / 2)
    np.testing.assert_allclose(np.diff(wheels.x, axis=1), DX, rtol=1e-9)
    # Told as how far the wheel that moves most is from its place, the first wheel of the class as well as others.
    told = [abs(load.grid.x.mean() - x) for load, (x, _) in zip(wheels.loads, TRIDEM.wheels, strict=True)]
    told += [abs(load.grid.y.mean() - right) for load, (_, right) in zip(wheels.loads, TRIDEM.wheels, strict=True)]
    assert wheels.moved == pytest.approx(max(told), rel=1e-9)
    assert 0 < wheels.moved <= DY / 2
    assert (wheels.cell, wheels.name, wheels.speed) == (DY, "tridem", None)


def test_a_single_wheel_off_the_lattice_is_moved(y):
    one = wheels_of([contact()], AxleClass("one", 1.0, 3e4, 8e5, ((0.3 * DX, 0.0),)), y)
    # To the cell below it; against the first wheel, which is itself, it would stand still.
    assert one.moved == pytest.approx(0.3 * DX, rel=1e-9)


def test_an_axle_alone_has_its_own_wheels(wheels):
    alone = _one_axle(wheels)
    assert len(alone.loads) == 2
    assert {round(load.grid.x.mean(), 6) for load in alone.loads} == {-1.31}
    np.testing.assert_array_equal(alone.x, wheels.x[:1])


@pytest.mark.parametrize(
    ("depth", "cell", "stride"),
    # Cells near the surface; below 50 mm a sixth of the depth, 20 mm at most, and a cell at least.
    [(0.0, 0.004, 0), (0.05, 0.004, 0), (0.06, 0.004, 3), (0.5, 0.004, 5), (0.09, 0.04, 1), (0.06, 0.0025, 4)],
)
def test_strides_follow_the_depth(depth, cell, stride):
    assert stride_of(depth, cell) == stride


def test_near_the_surface_a_passage_is_read_on_cells_and_once_between(wheels):
    x = along(wheels, Plane(0, "above", 0.01))
    assert len(x) == 3 * 7 + 2
    assert all(np.abs(x - centre).min() < 1e-8 for centre in wheels.x.ravel())
    between = [one for one in x if np.abs(wheels.x - one).min() > 2 * DX]
    middles = [-0.655, 0.65]
    assert between == pytest.approx(middles, abs=0.51 * DX + 5e-3)
    # On the lattice of the cells.
    assert np.allclose((between - wheels.x[0, 0]) / DX, np.round((between - wheels.x[0, 0]) / DX), atol=1e-6)


def test_deep_down_a_passage_is_read_evenly_and_beyond_its_axles(wheels):
    x = along(wheels, Plane(2, "above", None))
    np.testing.assert_allclose(np.diff(x), 2 * DX, rtol=1e-9)
    assert wheels.x[0, 0] - 0.3 - 2 * DX <= x[0] <= wheels.x[0, 0] - 0.3 + 1e-9
    assert wheels.x[-1, -1] + 0.3 - 2 * DX <= x[-1] <= wheels.x[-1, -1] + 0.3 + 2 * DX


def test_rows_are_every_cell_beside_wheels_and_few_elsewhere(wheels, y):
    near, deep = (rows_of(wheels, y, Plane(stride, "above", 0.01)) for stride in (0, 2))
    for one in (near, deep):
        assert (one[0], one[-1]) == (y[0], pytest.approx(y[-1], abs=DY))
        # Cells, not the points between them.
        np.testing.assert_allclose((one - y[0]) / DY, np.round((one - y[0]) / DY), atol=1e-9)
    for load in wheels.loads:
        beside = near[(near > load.grid.y[0] - 0.05) & (near < load.grid.y[-1] + 0.05)]
        np.testing.assert_allclose(np.diff(beside), DY, rtol=1e-9)
    far = near[near > 0.1733 + 4 * DY + 0.07]
    assert np.diff(far)[:-1] == pytest.approx(2 * DY)
    assert np.diff(deep)[:-1] == pytest.approx(2 * DY)


def test_cells_of_wheels_with_a_side_force_are_divided_across_travel_near_the_surface(y):
    """Each cell of 12 mm into 8 parts of 1.5 mm with a row each; the same force, at the same place."""
    row = replace(TRIDEM, maneuver=tl.contact.Maneuver(lateral=0.06))
    pushed, straight = wheels_of([contact()], row, y), wheels_of([contact()], TRIDEM, y)
    assert (pushed.parts, straight.parts) == (8, 1)
    assert straight.near_surface is straight.joined
    # A mean over 20 mm, as one over 10 mm is less than these wide cells.
    plane = Plane(0, "above", 0.02, wide=True)
    rows, cells = rows_of(pushed, y, plane), rows_of(straight, y, plane)
    np.testing.assert_allclose(rows.reshape(-1, 8).mean(axis=1), cells, atol=1e-12)
    np.testing.assert_allclose(np.diff(rows.reshape(-1, 8), axis=1), 1.5e-3, rtol=1e-9)
    fine, coarse = pushed.near_surface, pushed.joined
    for force in ("normal_load", "tractive_force"):
        expected = sum(getattr(load, force) for load in coarse)
        assert sum(getattr(load, force) for load in fine) == pytest.approx(expected, rel=1e-12)
    assert [load.extent_y for load in fine] == [pytest.approx(load.extent_y) for load in coarse]
    # Points, depths below the surface and means over less than a cell keep the cells.
    for other in (Plane(0, "above", None, wide=True), Plane(2, "above", None), Plane(0, "above", 0.01, wide=True)):
        np.testing.assert_array_equal(rows_of(pushed, y, other), rows_of(straight, y, other))


def test_fields_between_rows_are_cubic_where_rows_are_even_and_straight_elsewhere():
    rows = np.array([0.0, 1, 2, 3, 4, 9, 14, 19, 24])
    y = np.linspace(0, 24, 97)
    columns, weights = onto_lines(rows, y)
    onto = np.zeros((len(y), 9))
    np.add.at(onto, (np.arange(len(y))[:, None], columns), weights)
    # What goes through the rows, and gives one of ones.
    np.testing.assert_allclose((onto @ np.eye(9))[np.searchsorted(y, rows)], np.eye(9), atol=1e-14)
    cubic, found = y**3 - 7 * y**2, onto @ (rows**3 - 7 * rows**2)[:, None]
    inside = ((y >= 1) & (y <= 3)) | ((y >= 9) & (y <= 19))
    np.testing.assert_allclose(found[inside, 0], cubic[inside], atol=1e-10)
    # Beside a change of step and at the ends straight lines.
    ends = (y < 1) | ((y > 4) & (y < 9)) | (y > 19)
    np.testing.assert_allclose(found[ends, 0], np.interp(y[ends], rows, rows**3 - 7 * rows**2), atol=1e-10)


def test_a_strip_does_the_mean_damage_of_its_lines():
    """A reading with a step between two lines: the damage over all y is that of the step, wherever it lies."""
    rows, x = 3e-3 * np.arange(40), np.zeros(1)
    y = 1.5e-3 * np.arange(79)
    for edge in np.linspace(0.05, 0.053, 7):
        uncut, margin = np.full((40, 1), 2e-4), (edge - rows)[:, None]
        strips = over_strips(Strips.of(rows, y), x, uncut, margin, centres=np.zeros(1), turns=1, power=5.0)[0]
        # As wide as the tensile part, to a line in four.
        width = 1.5e-3 * ((strips / 2e-4) ** 5).sum() - 0.75e-3
        assert width == pytest.approx(edge, abs=1.5e-3 / 4)


def test_peaks_and_valleys_in_turn():
    """Two axles of 3 and 5 over a ground of 1: the valley is what lies between, and nothing comes after."""
    x = np.linspace(-2, 2, 81)
    read = (1 + 2 * np.exp(-((x + 1) ** 2) / 0.02) + 4 * np.exp(-((x - 1) ** 2) / 0.02))[None]
    found = peaks_and_valleys(x, read, centres=np.array([-1.0, 1.0]), turns=5, smooth=False)
    np.testing.assert_allclose(found[:, 0], [3, 1, 5, 0, 0], atol=1e-6)
    # What is pressed together all along does no harm.
    assert (peaks_and_valleys(x, -read, centres=np.array([-1.0, 1.0]), turns=3, smooth=False) == 0).all()


def readings(warmth, power):
    """(road, turn, y) that follow a power of the warmth."""
    return (warmth[:, None, None] ** power) * np.ones((1, 1, 3))


def test_few_roads_tell_the_rest():
    warmth = np.array([3.0, 1.0, 2.0, 5.0, 4.0])
    # A straight line needs its ends; none is left out for no tolerance, nor of three roads.
    kept, error = nodes(warmth, readings(warmth, 1.0), 1e-6)
    assert (kept, error) == ([1, 3], pytest.approx(0, abs=1e-12))
    assert nodes(warmth, readings(warmth, 1.0), 0) == ([0, 1, 2, 3, 4], 0.0)
    assert nodes(None, readings(warmth, 1.0), 1e-6) == ([0, 1, 2, 3, 4], 0.0)
    assert nodes(warmth[:3], readings(warmth[:3], 1.0), 1e-6) == ([0, 1, 2], 0.0)
    four = warmth[:4]
    assert nodes(four, readings(four, 1.0), 1e-6)[0] == [1, 3]
    # A curve needs more for less error, and says the error that it has.
    warmth = np.linspace(1, 5, 17)
    bent = readings(warmth, 3.0)
    few, much = nodes(warmth, bent, 0.05)
    more, little = nodes(warmth, bent, 0.005)
    assert len(few) < len(more)
    assert 0 < much <= 0.05
    assert little <= 0.005
    assert [warmth[k] for k in few] == sorted(warmth[k] for k in few)
    # Nothing read is nothing lost.
    assert nodes(warmth, 0 * bent, 1e-6) == ([0, 16], 0.0)


def test_an_edge_that_opens_between_two_temperatures_costs_no_road_where_wheels_wander():
    """A reading at one place of many that jumps: all roads are needed for it alone, few for the harm after wander."""
    warmth = np.linspace(20, 22, 12)
    step, y = 1.5e-3, 1.5e-3 * np.arange(800)
    read = (2 * np.exp(-0.5 * warmth)[:, None] * np.exp(-(((y - y.mean()) / 0.1) ** 2)))[:, None]
    read[5:, :, 430] *= 1.2
    still, _ = nodes(warmth, read, 5e-3, Wander.none(), step)
    few, error = nodes(warmth, read, 5e-3, Wander.normal(0.25), step)
    assert len(still) > 6
    assert len(few) <= 4
    # What it says is what the damage of a law of the fifth power shows: at most five times the error.
    wander, over = Wander.normal(0.25), PchipInterpolator(warmth[few], read[few])(warmth)
    true, found = (wander.spread(one[:, 0] ** 5, step).max(axis=1) for one in (read, over))
    assert np.abs(found / true - 1).max() <= 5 * error <= 0.025


def test_roads_between_are_read_between_and_cracks_from_the_nearest():
    warmth = np.array([3.0, 1.0, 2.2, 5.0, 4.0])
    line = readings(warmth, 1.0)[None]
    crack = np.broadcast_to(np.array([10.0, 20, 30, 40, 50])[None, :, None, None], (1, 5, 1, 3))
    everything = np.concatenate([line, crack], axis=2)
    kept = [1, 0, 3]
    found = over_the_climate(warmth, kept, everything[:, kept], 1)
    np.testing.assert_allclose(found[:, :, :1], line, rtol=1e-12)
    # 2.2 lies nearest to 3, 4 as near to 3 as to 5.
    assert found[0, [0, 1, 2, 3], 1, 0].tolist() == [10, 20, 10, 40]
    assert found[0, 4, 1, 0] in (10, 40)
    # Where nothing is read, only what is behind the turns is there, whatever the directions of warmth.
    nothing = everything[:, kept, 1:]
    for at in (warmth, np.stack([warmth, warmth**2], axis=1)):
        np.testing.assert_array_equal(over_the_climate(at, kept, nothing, 0)[0, kept], nothing[0])


def two(modulus, below=1e8):
    return Pavement([Layer(Elastic(modulus, 0.35), 0.1), Layer(Elastic(below, 0.35))])


def test_warmth_orders_roads_by_the_stiffness_of_all_layers():
    seasons = [Season("a", 0.5, 10.0), Season("b", 0.5, 30.0)]
    found = warmth_of(seasons, [two(8e9), two(2e9)])
    # Both layers count alike: a quarter of the modulus is half of it in each.
    assert found[0] - found[1] == pytest.approx(math.log(4) / 2)
    assert warmth_of(seasons, [two(8e9), two(8e9)]) is None
    assert warmth_of([Season("a", 1.0, (10.0, 5.0)), seasons[1]], [two(8e9), two(2e9)]) is None
    solid = Pavement([Layer(tl.materials.Prony(8e9, ((0.5, 0.1),), 0.35), 0.1), Layer(Elastic(1e8, 0.35))])
    assert warmth_of(seasons, [solid, two(2e9)]) is None


def test_groups_in_words():
    names, criteria = ("single", "tandem", "tridem", "four"), ("base", "soil")
    factors = np.array([[np.nan, 0.8, 0.7, 0.6], [np.nan, np.nan, 1.2, np.nan]])
    said = in_words(names, criteria, factors, np.array([1, 2, 3, 4]))
    assert said[0].startswith("tandem: each of 2 axles does K = 0.80 (base) times the damage")
    assert said[0].endswith("the French method takes 0.75 for bituminous layers and 12 for hydraulic layers")
    assert "0.70 (base), 1.20 (soil)" in said[1]
    assert said[1].endswith("1.1 for bituminous layers and 113 for hydraulic layers")
    assert said[2] == "four: each of 4 axles does K = 0.60 (base) times the damage it would do alone"
    assert len(said) == 3
    (unknown,) = in_words(("x",), criteria, np.full((2, 1), np.nan), np.array([2]))
    assert "K = unknown" in unknown


def test_harm_is_that_of_peaks_less_that_of_valleys():
    law = FatigueLine(100e-6, -0.2)
    turns = 1e-6 * np.array([[100.0, 80.0], [50.0, 80.0], [90.0, 80.0], [0.0, 0.0]])
    expected = 1e-6 * np.array([1 - 0.5**5 + 0.9**5, 0.8**5])
    np.testing.assert_allclose(harm_of(law, turns), expected, rtol=1e-12)
    # More valley than peak is round-off of curves: no road heals.
    assert harm_of(law, np.array([[10e-6], [20e-6]])).item() == 0


def life(growth=0.0, wander=None):
    y = 0.05 * np.arange(-20, 21)
    bell = np.exp(-(y**2) / 0.1)
    values = np.stack([np.stack([[100e-6 * bell]]), np.stack([[160e-6 * bell]])])
    criteria = (
        Criterion("weak", FatigueLine(120e-6, -0.2)),
        Criterion("strong", FatigueLine(120e-6, -0.25)),
    )
    row = AxleClass("one", 1.0, 3e4, 8e5)
    traffic = Traffic((row,), 1e5, growth=growth, wander=wander or Wander())
    return miner(values, criteria, traffic, Climate.constant(15.0), y=y)


def test_the_year_is_held_closer_than_any_season_of_it():
    """Errors of one sign add up over seasons: the sum that a life is made of asks for more roads than readings."""
    warmth = np.linspace(0.0, 1.0, 12)
    bent = 1e-4 * np.exp(0.8 * warmth**2)[:, None, None] * np.ones((1, 1, 5))
    # Every season's harm weighs alike in the year.
    weight = (bent.max() / bent) ** 5

    def yearly(readings):
        return ((readings / bent.max()) ** 5 * weight).sum(axis=1)

    few, _ = nodes(warmth, bent, 0.02)
    more, error = nodes(warmth, bent, 0.02, yearly=yearly)
    assert set(few) < set(more)
    assert error <= 0.02

    def off(kept):
        read, true = (yearly(one).sum(axis=0)[0] for one in (curves(warmth[kept], bent[kept], 0)(warmth), bent))
        return abs(read / true - 1)

    # A fifth of the tolerance.
    assert off(more) <= 0.004 < off(few)


def test_strength_weighs_as_the_slope_of_its_law_says():
    """Years follow ε₆ to the power 1/|b|, passes to the power -1, by the power law itself."""
    found = [_without_solves(life(), number, 1.0) for number in (0, 1)]
    assert found[0] == pytest.approx({"passes": -1.0, "strength of weak": 5.0}, rel=1e-9)
    assert found[1] == pytest.approx({"passes": -1.0, "strength of strong": 4.0}, rel=1e-9)
    # Half of the weight where traffic grows so that half as many more years bring all the more passes.
    half = _without_solves(life(), 1, 0.5)
    assert half == pytest.approx({"passes": -0.5, "strength of strong": 2.0}, rel=1e-9)


def test_wander_as_wide_as_the_bowl_lives_longer_by_a_closed_form():
    """A bell of harm under bells of tracks: the peak falls as 1/√(1 + s²/w²), w² that of the harm."""
    deviation = 0.2
    found = _without_solves(life(wander=Wander.normal(deviation)), 1, 1.0)["wander"]
    # Harm is the fourth power of exp(-y²/0.1): variance 0.1/8.
    assert found == pytest.approx(deviation**2 / (deviation**2 + 0.1 / 8), rel=0.01)


def test_growth_of_traffic_shortens_what_an_input_gives():
    row = AxleClass("one", 1.0, 3e4, 8e5)
    assert _growth(Traffic((row,), 1e5), 1e6) == pytest.approx(1.0, rel=1e-12)
    # n = ln(1 + g N/q) / ln(1 + g): d ln n / d ln N = u / ((1 + u) ln(1 + u)), u = g N / q.
    u = 0.05 * 20
    growing = _growth(Traffic((row,), 1e5, growth=0.05), 20e5)
    assert growing == pytest.approx(u / ((1 + u) * math.log(1 + u)), rel=1e-3)
    # Traffic that dies out before the end of life has no years to follow.
    assert _growth(Traffic((row,), 1e5, growth=-0.5), 1.99e5) == 1.0


def test_the_pairs_that_do_most():
    shares = np.array([[0.1, 0.5], [0.3, 0.1]])
    assert most(shares, 0.5) == ([(0, 1)], pytest.approx(0.5))
    assert most(shares, 0.51) == ([(0, 1), (1, 0)], pytest.approx(0.8))
    pairs, covered = most(shares, 1.0)
    assert sorted(pairs) == [(0, 0), (0, 1), (1, 0), (1, 1)]
    assert covered == pytest.approx(1.0)


def test_maps_of_layers_have_a_margin_of_a_hands_width():
    load = GridLoad(GRID, PRESSURE)
    bare, wide = map_grid([load], Pavement.half_space(Elastic(5e9, 0.35))), map_grid([load], two(5e9))
    assert bare == GRID
    assert (wide.x[0], wide.x[-1]) == pytest.approx((GRID.x[0] - 0.1, GRID.x[-1] + 0.1))
    # 0.1 m is no whole number of cells of 12 mm: nine.
    assert (wide.y[0], wide.y[-1]) == pytest.approx((GRID.y[0] - 9 * DY, GRID.y[-1] + 9 * DY))
    assert (wide.dx, wide.dy) == (DX, DY)


def test_depths_of_a_slice():
    road = Pavement([Layer(Elastic(5e9, 0.35), 0.1), Layer(Elastic(1e9, 0.35), 0.2), Layer(Elastic(1e8, 0.35))])
    depths = slice_depths(0.3, 0.01, road)
    assert depths[0] == 0
    assert depths[1] == pytest.approx(0.005)
    assert 0.1 in depths
    assert 0.1 + 1e-6 in depths
    # The bottom of the slice is above its interface; nothing lies below it.
    assert depths[-1] == pytest.approx(0.3)
    assert (np.diff(depths) > 0.9e-6).all()
    # Finer near the surface: each step wider than the one before, but for those at the interfaces.
    plain = slice_depths(0.3, 0.01, Pavement.half_space(Elastic(5e9, 0.35)))
    assert len(plain) == 31
    ratios = plain[2:] / plain[1:-1]
    assert np.ptp(ratios) < 1e-6
    assert slice_depths(0.004, 0.01, road)[1] == pytest.approx(0.002)


def test_a_dual_wheel_is_mirrored_unless_it_leans():
    """1 % of the weight to the side is straight still."""
    for share, turned in ((0.0099, True), (0.0101, False)):
        load = GridLoad(GRID, PRESSURE, traction_y=-share * PRESSURE)
        left, right = tl.response.dual_wheels(load, 0.35)
        assert right.lateral_force == pytest.approx(share * load.normal_load)
        assert left.lateral_force == pytest.approx((-1 if turned else 1) * share * load.normal_load)


def test_wheels_that_overlap_by_a_cell_are_told():
    """Cells reach half a cell beyond their centres, on both sides of both loads."""
    load = GridLoad(GRID, PRESSURE)
    for axis, size, cell in (("x", 7 * DX, DX), ("y", 9 * DY, DY)):
        assert overlapping([load, load.moved(**{axis: size - 2 * cell})])
        assert not overlapping([load, load.moved(**{axis: size + 0.1 * cell})])
        assert overlapping([load, load.moved(**{axis: -(size - 2 * cell)})])
        assert not overlapping([load, load.moved(**{axis: -(size + 0.1 * cell)})])
