"""solve_response at a list of points: the grid's values, refusals, text, files."""

import numpy as np
import pytest
import xarray as xr

import treadload as tl
from treadload.grid import Grid
from treadload.kernels.gridding.points import Points
from treadload.materials import Prony
from treadload.response import GridLoad, UniformDisc, solve_response
from treadload.results import open_results, save_results
from treadload.steps.slices import _line

GRID = Grid(9, 7, 0.02, 0.02, -0.08, -0.06)
SOLID = Prony(8e9, ((0.5, 0.02), (0.4, 0.3)), 0.35)
BASE, SOIL = tl.Elastic(2e8, 0.3), tl.Elastic(5e7, 0.4)
DEPTHS = [0.0, 0.05, 0.15]
# Off the load's lattice; a line along x, one along y, which cross, and points beside them.
X, Y = np.array([-0.151, -0.043, -0.017, 0.002, 0.029, 0.071]), np.array([-0.083, -0.031, 0.004, 0.037, 0.09])
CROSS = [(x, Y[2]) for x in X] + [(X[1], y) for y in Y] + [(X[4], Y[0]), (X[5], Y[4]), (X[0], Y[3])]


def load(interpolation="constant"):
    rng = np.random.default_rng(4)
    stress = rng.uniform(0, 1e6, GRID.shape), *rng.uniform(-3e5, 3e5, (2, *GRID.shape))
    return GridLoad(GRID, *stress, interpolation=interpolation)


def layers(top):
    return tl.Pavement([tl.Layer(top, 0.08, name="asphalt"), tl.Layer(BASE, 0.2), tl.Layer(SOIL)])


DISCS = [UniformDisc(0.1, 7e5), UniformDisc(0.07, 5e5, 0.1, 0.05)]
ELASTIC = tl.Elastic(5e9, 0.35)


@pytest.mark.parametrize(
    ("loads", "road", "speed"),
    [
        (load(), tl.Pavement.half_space(ELASTIC), None),
        (load("bilinear"), tl.Pavement.half_space(ELASTIC), None),
        (DISCS, tl.Pavement.half_space(ELASTIC), None),
        (load(), layers(ELASTIC), None),
        ([load("bilinear"), *DISCS], layers(ELASTIC), None),
        (load(), layers(SOLID), 15.0),
        pytest.param(DISCS, layers(SOLID), 15.0, marks=pytest.mark.slow),
        (load(), tl.Pavement.half_space(SOLID), 15.0),
    ],
    ids=[
        "half-space",
        "bilinear",
        "discs",
        "layers",
        "discs on layers",
        "moving",
        "moving discs",
        "moving half-space",
    ],
)
def test_points_have_the_values_of_the_grid(loads, road, speed):
    depths = DEPTHS if speed is None else DEPTHS[1:]
    whole = solve_response(loads, road, depths=depths, x=X, y=Y, speed=speed).dataset
    found = solve_response(loads, road, depths=depths, points=CROSS, speed=speed).dataset
    at = {name: ("point", [place[k] for place in CROSS]) for k, name in enumerate("xy")}
    for name in whole.data_vars:
        if name == "principal_direction_1":
            continue
        dims = ("depth", "point")
        wanted = whole[name].sel({dim: xr.Variable(*at[dim]) for dim in "xy" if dim in whole[name].dims})
        assert found[name].dims == dims
        # Round-off: the same integrals in another order of summation; angles where they are not those of nothing.
        size = np.nanmax(np.abs(wanted)) + (name == "in_plane_angle_1")
        np.testing.assert_allclose(
            found[name], wanted.transpose(*dims), atol=1e-11 * size if name == "in_plane_angle_1" else 1e-12 * size
        )
    assert found["principal_direction_1"].dims == ("depth", "point", "component")
    np.testing.assert_array_equal(found["x"], at["x"][1])
    np.testing.assert_array_equal(found["y"], at["y"][1])


@pytest.mark.parametrize("seed", range(4))
def test_lines_and_lone_points_make_the_list(seed):
    rng = np.random.default_rng(seed)
    x, y = rng.integers(0, 8, 40) * 0.1, rng.integers(0, 5, 40) * 0.1
    points, at_x, at_y = Points.of(x, y)
    members = np.concatenate([group.members for group in points.groups])
    assert sorted(members) == list(range(40))
    left, right = rng.random((2, len(at_y), 6)), rng.random((6, len(at_x)))
    rows, columns = np.searchsorted(at_y, y), np.searchsorted(at_x, x)
    # Round-off.
    np.testing.assert_allclose(points.product(left, right)[:, 0], (left @ right)[:, rows, columns], rtol=1e-13)

    def plane(x, y):
        return 3 * x + 7 * y[:, None]

    np.testing.assert_array_equal(points.gathered(plane, at_x, at_y)[0], 3 * at_x[columns] + 7 * at_y[rows])
    assert points.total(lambda x, y: np.array([len(x) * len(y)]), at_x, at_y) == 40
    upright, level = points.halves
    assert sorted([*upright.members, *level.members]) == list(range(40))
    for half in (upright, level):
        np.testing.assert_array_equal(half.rows[half.points.rows], rows[half.members])
        np.testing.assert_array_equal(half.columns[half.points.columns], columns[half.members])


def test_crossing_lines_need_no_grid():
    x, y = np.array([*range(30), *[4] * 20]), np.array([*[7] * 30, *range(20)])
    upright, level = Points.of(x, y)[0].halves
    # The point where they cross stands in the list twice, on each line once or on the longer one of both.
    assert list(upright.columns) == [4]
    assert list(level.rows) == [7]
    assert len(upright.rows) in (19, 20)
    assert len(level.columns) == 30


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"points": [(0, 0)], "x": [0.0]}, r"give x and y or points, not both"),
        ({"points": [(0, 0)], "y": [0.0]}, r"give x and y or points, not both"),
        (
            {"points": [0.0, 1.0]},
            r"points must be a list of places \(x, y\) in metres, shape \(n, 2\), got shape \(2,\)",
        ),
        ({"points": [(0, 0, 0)]}, r"shape \(n, 2\), got shape \(1, 3\)"),
        ({"points": np.zeros((0, 2))}, r"got shape \(0, 2\)"),
        ({"points": [(0, np.nan)]}, r"points must be finite, got nan"),
        ({"points": "here"}, r"points must be a list of places \(x, y\) in metres, got 'here'"),
    ],
)
def test_refusals(given, message):
    with pytest.raises(tl.InputError, match=message):
        solve_response(load(), tl.Pavement.half_space(ELASTIC), depths=[0.0], **given)


@pytest.fixture(scope="module")
def response():
    return solve_response(load(), tl.Pavement.half_space(ELASTIC), depths=[0.0, 0.05], points=CROSS)


def test_the_summary_names_the_worst_point(response):
    text = response.summary()
    assert f"2 depth(s) of {len(CROSS)} points" in text
    worst = response.dataset["principal_strain_1"].sel(depth=0.05)
    worst = worst.isel(point=int(worst.to_numpy().argmax()))
    assert f"{float(worst) * 1e6:.1f} microstrain at x = {float(worst.x) * 1e3:.1f} mm" in text


def test_a_file_keeps_the_points(response, tmp_path):
    save_results(response, tmp_path / "points.nc")
    read = open_results(tmp_path / "points.nc").points.dataset
    xr.testing.assert_identical(read.drop_attrs(deep=False), response.dataset.drop_attrs(deep=False))


@pytest.mark.parametrize(
    "use",
    [
        lambda r: tl.assess(r, tl.FatigueLine(epsilon_6=1e-4, slope=-0.2)),
        lambda r: r.plot.strain_directions(),
        lambda r: r.plot.depth_slice(),
        lambda r: r.plot.profile(),
    ],
)
def test_what_needs_a_grid_says_so(response, use):
    with pytest.raises(tl.InputError, match=r"needs a grid.* 14 points.*solve_response with x and y"):
        use(response)


@pytest.mark.parametrize(("along", "members"), [("x", slice(len(X))), ("y", slice(len(X), len(X) + len(Y)))])
def test_a_case_splits_crossing_lines_into_its_slices(along, members):
    road, speed = layers(SOLID), 15.0
    crossing = solve_response(load(), road, depths=[0.05, 0.15], points=CROSS[:11], speed=speed)
    line = {"x": X, "y": [Y[2]]} if along == "x" else {"x": [X[1]], "y": Y}
    alone = solve_response(load(), road, depths=[0.05, 0.15], **line, speed=speed)
    found = _line(crossing, members, along)
    assert list(found.dataset.data_vars) == list(alone.dataset.data_vars)
    assert list(found.dataset.coords) == list(alone.dataset.coords)
    assert found.stats["points"] == alone.stats["points"]
    for name, wanted in alone.dataset.variables.items():
        assert (found.dataset[name].dims, found.dataset[name].attrs) == (wanted.dims, wanted.attrs)
        if name in ("component", "principal_direction_1"):
            continue
        # Other points, other wavenumbers: 1e-4 of the energy, 1e-7 of the rest.
        accuracy = 1e-4 if name == "dissipated_energy" else 1e-6 if name == "in_plane_angle_1" else 1e-7
        np.testing.assert_allclose(found.dataset[name], wanted, atol=accuracy * np.abs(wanted).max(), rtol=0)
