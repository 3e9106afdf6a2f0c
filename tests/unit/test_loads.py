"""Loads: forces, places, mirrors, gears, arrays and files, and what they refuse."""

import numpy as np
import pytest
import xarray as xr

import treadload as tl
from treadload.errors import InputError
from treadload.grid import Grid
from treadload.response import GridLoad, UniformDisc, UniformRectangle, axle, dual_wheels, place_load, tandem

GRID = Grid(3, 2, 0.003, 0.004, -0.002, 0.01)
PRESSURE = np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.5]]) * 1e5
ALONG, ACROSS = -0.3 * PRESSURE, 0.1 * PRESSURE[:, ::-1]
LOAD = GridLoad(GRID, PRESSURE, ALONG, ACROSS)


def test_forces_are_integrals():
    # 2.15 MPa on 12 mm² a cell.
    assert LOAD.normal_load == pytest.approx(2.15e6 * 12e-6)
    assert LOAD.tractive_force == pytest.approx(0.3 * 2.15e6 * 12e-6)
    assert LOAD.lateral_force == pytest.approx(-0.1 * 2.15e6 * 12e-6)
    block = UniformRectangle(0.2, 0.1, 7e5, traction_x=-1e5, traction_y=5e4)
    assert (block.normal_load, block.tractive_force, block.lateral_force) == pytest.approx((14e3, 2e3, -1e3))
    assert block.cell.normal_load == pytest.approx(14e3)
    assert UniformDisc(0.1, 1e6).normal_load == pytest.approx(np.pi * 1e4)


def test_the_french_axle_weighs_130_kn():
    # 13 t on two pairs of discs of 0.125 m at 0.662 MPa, 0.375 m apart: the reference axle of the French method.
    wheels = axle(UniformDisc(0.125, 0.662e6), track=1.8, dual_spacing=0.375)
    assert sum(wheel.normal_load for wheel in wheels) == pytest.approx(130e3, rel=1e-3)
    assert sorted(wheel.y for wheel in wheels) == pytest.approx([-1.0875, -0.7125, 0.7125, 1.0875])


def test_moved_loads_keep_their_numbers():
    for load in (LOAD, GridLoad(GRID, PRESSURE, interpolation="bilinear")):
        moved = load.moved(x=0.5, y=-0.25)
        assert moved.grid == Grid(3, 2, 0.003, 0.004, -0.002 + 0.5, 0.01 - 0.25)
        assert moved.interpolation == load.interpolation
        np.testing.assert_array_equal(moved.array, load.array)
    assert UniformDisc(0.1, 1e6, 1.0, 2.0).moved(y=1.0) == UniformDisc(0.1, 1e6, 1.0, 3.0)
    block = UniformRectangle(0.1, 0.2, 1e6, 1.0, 2.0, 3.0, 4.0)
    assert block.moved(x=-1.0) == UniformRectangle(0.1, 0.2, 1e6, 0.0, 2.0, 3.0, 4.0)


def test_a_mirror_turns_rows_and_lateral_shear_round():
    image = LOAD.mirrored()
    np.testing.assert_allclose(image.grid.y, [-0.014, -0.010], rtol=1e-14)
    np.testing.assert_array_equal(image.pressure, PRESSURE[::-1])
    np.testing.assert_array_equal(image.traction_x, ALONG[::-1])
    np.testing.assert_array_equal(image.traction_y, -ACROSS[::-1])
    back = image.mirrored()
    np.testing.assert_array_equal(back.array, LOAD.array)
    assert back.grid.y0 == pytest.approx(GRID.y0, rel=1e-14)
    assert UniformDisc(0.1, 1e6, 1.0, 2.0).mirrored() == UniformDisc(0.1, 1e6, 1.0, -2.0)
    block = UniformRectangle(0.1, 0.2, 1e6, 1.0, 2.0, 3.0, 4.0)
    assert block.mirrored() == UniformRectangle(0.1, 0.2, 1e6, 1.0, -2.0, 3.0, -4.0)


def test_place_takes_a_dataset_and_mirrors_before_it_moves():
    names = {"pressure": PRESSURE, "traction_x": ALONG, "traction_y": ACROSS}
    data = xr.Dataset({k: (("y", "x"), v) for k, v in names.items()}, {"x": GRID.x, "y": GRID.y})
    placed = place_load(data, x=1.0, y=0.5, mirror=True)
    np.testing.assert_allclose(placed.grid.y, [0.486, 0.490], rtol=1e-12)
    assert placed.grid.x0 == pytest.approx(0.998)
    np.testing.assert_array_equal(placed.traction_y, -ACROSS[::-1])


def test_gears_stand_where_they_should():
    disc = UniformDisc(0.1, 1e6, 0.0, 0.01)
    assert [w.y for w in dual_wheels(disc, 0.34)] == pytest.approx([-0.16, 0.18])
    # An uneven wheel: the left one mirrors the right one.
    left, right = axle(disc, 2.0)
    assert (left.y, right.y) == pytest.approx((-1.01, 1.01))
    block = UniformRectangle(0.2, 0.1, 1e6, traction_y=5.0)
    assert [w.traction_y for w in axle(block, 2.0)] == [-5.0, 5.0]
    assert [w.y for w in axle(block, 2.0, 0.4)] == pytest.approx([-0.8, -1.2, 0.8, 1.2])
    group = tandem(axle(disc, 2.0), 1.35)
    assert [w.x for w in group] == pytest.approx([0.675, 0.675, -0.675, -0.675])
    assert sorted({w.x for w in tandem(disc, 1.35, axles=3)}) == pytest.approx([-1.35, 0.0, 1.35])


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: LOAD.moved(x=np.nan), "finite numbers of metres"),
        (lambda: place_load([LOAD, LOAD], x=1.0), "one load, got 2"),
        (lambda: dual_wheels(LOAD, 0.0), "spacing of dual wheels must be a positive"),
        (lambda: axle(LOAD, -1.0), "track of an axle must be a positive"),
        (lambda: axle(LOAD, 0.3, 0.4), "0.4 m must be smaller than the track"),
        (lambda: tandem(LOAD, np.inf), "wheelbase must be a positive"),
        (lambda: tandem(LOAD, 1.0, axles=0), "at least 1, got 0"),
        (lambda: GridLoad(GRID, PRESSURE, interpolation="cubic"), '"constant" or "bilinear", got \'cubic\''),
        (lambda: GridLoad(GRID, PRESSURE - 1.5e5), r"-50000 Pa in cell \(y, x\) = \(0, 0\)"),
        (lambda: GridLoad.from_arrays(PRESSURE[0], spacing=0.01), "rows along y"),
        (lambda: GridLoad.from_arrays(PRESSURE, ALONG.T, spacing=0.01), r"traction_x has shape \(3, 2\)"),
        (lambda: GridLoad.from_arrays(PRESSURE, spacing=(1, 2, 3)), "got 3 values"),
        (lambda: GridLoad.from_arrays(PRESSURE, spacing="5 kg"), "cannot read '5 kg'"),
        (lambda: GridLoad.from_arrays(PRESSURE, ALONG, spacing=0.01, shear_on="sensor"), "shear_on must be"),
        (lambda: GridLoad.from_arrays(PRESSURE * np.nan, spacing=0.01), "must be finite, got nan in cell"),
    ],
)
def test_refusals(make, message):
    with pytest.raises(InputError, match=message):
        make()


def test_arrays_become_cells_around_the_origin():
    load = GridLoad.from_arrays(PRESSURE, ALONG, spacing=("5 mm", 0.01), shear_on="tire", interpolation="bilinear")
    assert load.grid == Grid(3, 2, 0.005, 0.01, -0.005, -0.005)
    np.testing.assert_array_equal(load.traction_x, -ALONG)
    assert not load.traction_y.any()
    assert load.interpolation == "bilinear"
    assert GridLoad.from_arrays(PRESSURE, spacing=0.01, x0=0.0, y0=1.0).grid == Grid(3, 2, 0.01, 0.01, 0.0, 1.0)


def write(tmp_path, text, name="stress.csv"):
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return path


TABLES = {
    "comma": "# sensor 12\nx [mm],y [mm],pressure [kPa],traction_x [kPa],traction_y [MPa]\n"
    "0,0,100,10,0\n0,4,300,30,0\n\n3,0,200,20,0\n3,4,400,40,0.005\n",
    "semicolon": "x (mm);y (mm);pressure (kPa);traction_x (kPa);traction_y (MPa)\n"
    "0,0;0;100,0;10;0\n0;4;300;30;0\n3;0;200;20;0\n3;4;400;40;0,005\n",
    "tab": "y [m]\tx [m]\tgap [m]\tpressure [Pa]\ttraction_x [Pa]\ttraction_y [Pa]\n"
    "0\t0\t1\t1e5\t1e4\t0\n0.004\t0\t1\t3e5\t3e4\t0\n0\t0.003\t1\t2e5\t2e4\t0\n0.004\t0.003\t1\t4e5\t4e4\t5000\n",
    "blank": "x [mm]  y [mm] pressure [kPa] traction_x[kPa] traction_y [kPa]\n"
    "0 0 100 10 0\n0 4 300 30 0\n3 0 200 20 0\n3 4 400 40 5\n",
}


@pytest.mark.parametrize("kind", TABLES)
def test_tables_in_any_order_and_dress(tmp_path, kind):
    load = GridLoad.from_csv(write(tmp_path, TABLES[kind]))
    assert (load.grid.nx, load.grid.ny, load.grid.x0, load.grid.y0) == (2, 2, 0.0, 0.0)
    assert (load.grid.dx, load.grid.dy) == pytest.approx((0.003, 0.004), rel=1e-12)
    np.testing.assert_allclose(load.pressure, [[1e5, 2e5], [3e5, 4e5]], rtol=1e-12)
    np.testing.assert_allclose(load.traction_x, [[1e4, 2e4], [3e4, 4e4]], rtol=1e-12)
    np.testing.assert_allclose(load.traction_y, [[0, 0], [0, 5e3]], rtol=1e-12)
    assert load.normal_load == pytest.approx(1e6 * 12e-6)


def test_units_by_keyword_and_shear_on_the_tire(tmp_path):
    path = write(tmp_path, "x,y,pressure,traction_x\n0,0,1,0.5\n5,0,2,0\n0,5,3,0\n5,5,4,0\n")
    load = GridLoad.from_csv(path, units={"x": "mm", "y": "mm", "pressure": "bar"}, shear_on="tire")
    np.testing.assert_allclose(load.pressure, [[1e5, 2e5], [3e5, 4e5]], rtol=1e-12)
    assert load.traction_x[0, 0] == -0.5
    assert load.grid.dx == pytest.approx(0.005)


def test_coordinates_rounded_in_the_file_keep_their_number(tmp_path):
    # Sensels of 1.27 mm written to hundredths: the smallest step alone would give 201 cells in place of 200.
    rows = [f"{1.27 * i:.2f},{1.27 * j:.2f},1" for j in range(2) for i in range(200)]
    load = GridLoad.from_csv(write(tmp_path, "x [mm],y [mm],pressure\n" + "\n".join(rows)))
    assert load.grid.shape == (2, 200)
    assert load.grid.dx == pytest.approx(1.27e-3, rel=1e-4)


def test_a_sparse_table_fills_with_zero_when_asked(tmp_path):
    path = write(tmp_path, "x,y,pressure\n0,0,5\n0.02,0.01,7\n0.01,0,nan\n")
    with pytest.raises(InputError, match="line 4: pressure is missing"):
        GridLoad.from_csv(path)
    load = GridLoad.from_csv(path, missing="zero")
    np.testing.assert_array_equal(load.pressure, [[5, 0, 0], [0, 0, 7]])


def test_a_matrix_and_its_noise(tmp_path):
    path = write(tmp_path, "1\t2\t-0.01\n4\t5\t\n")
    load = GridLoad.from_csv(
        path, spacing="5 mm", units={"pressure": "bar"}, noise="2 kPa", missing="zero", x0=0.0, y0=0.1
    )
    np.testing.assert_allclose(load.pressure, [[1e5, 2e5, 0], [4e5, 5e5, 0]], rtol=1e-12)
    assert load.grid == Grid(3, 2, 0.005, 0.005, 0.0, 0.1)


@pytest.mark.parametrize(
    ("text", "options", "message"),
    [
        ("", {}, "empty or all comments"),
        ("# nothing\n\n", {}, "empty or all comments"),
        ("x,y,pressure\n", {}, "a header and no points"),
        ("1,2\n3,4\n", {}, 'needs spacing="5 mm"'),
        ("1,2\n3\n", {"spacing": 0.01}, "line 2: 1 values where the first row has 2"),
        ("1,2\n3,x\n", {"spacing": 0.01}, "line 2: pressure is 'x', not a number"),
        ("1,2\n3,nan\n", {"spacing": 0.01}, 'line 2: pressure is missing; give missing="zero"'),
        ("1,2\n3,-4\n", {"spacing": 0.01}, "line 2: pressure is negative, -4 Pa"),
        ("1,2\n3,inf\n", {"spacing": 0.01}, "line 2: pressure is infinite"),
        ("x,y,presure\n0,0,1\n", {}, 'unknown column "presure"; did you mean "pressure"'),
        ("x,y,PRESSURE\n0,0,1\n", {}, 'unknown column "PRESSURE"; did you mean "pressure"'),
        ("x,y\n0,0\n", {}, "needs x, y and pressure; pressure missing"),
        ("x,y,pressure,x\n0,0,1,0\n", {}, "x occurs twice"),
        ("x,y,pressure [furlong]\n0,0,1\n", {}, "cannot read '1 furlong'"),
        ("x,y,pressure [Pa]\n0,0,1\n", {"units": {"pressure": "kPa"}}, r"unit in the header, \[Pa\]"),
        ("x,y,pressure\n0,0,1\n", {"units": {"force": "N"}}, "units names 'force'"),
        ("x,y,pressure\n0,0,1\n1,0\n", {}, "line 3: 2 values where the header has 3"),
        ("x,y,pressure\n0,,1\n", {}, "line 2: y is missing"),
        ("x,y,pressure\n0,0,1\n", {}, "all points have the same x; give spacing="),
        ("x,y,pressure\n0,0,1\n1,1,1\n0,0,2\n", {}, "line 4: the point x = 0 m, y = 0 m is already in line 2"),
        ("x,y,pressure\n0,0,1\n1,1,1\n", {}, r"no row for x = 1 m, y = 0 m \(2 of 4 points"),
        ("x,y,pressure\n0,0,1\n1,0,1\n2.7,0,1\n0,1,1\n", {}, "line 4: x = 2.7 m is not a whole number of steps"),
        ("x,y,pressure\n0,0,1\n1e-3,1e-3,1\n100,100,1\n", {}, "check its x and y for strays"),
        ("x,y,pressure\n0,0,1\n", {"x0": 1.0}, "leave out x0 and y0"),
        ("x,y,pressure\n0,0,1\n", {"missing": "skip"}, 'missing must be "error" or "zero"'),
    ],
)
def test_bad_text_files(tmp_path, text, options, message):
    with pytest.raises(InputError, match=message):
        GridLoad.from_csv(write(tmp_path, text), **options)


def test_files_that_are_not_there_or_no_text(tmp_path):
    with pytest.raises(InputError, match="No such file"):
        GridLoad.from_csv(tmp_path / "no.csv")
    binary = tmp_path / "binary.csv"
    binary.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="not UTF-8 text"):
        GridLoad.from_csv(binary)
    with pytest.raises(InputError, match="there is no file"):
        GridLoad.from_file(tmp_path / "no.nc")
    with pytest.raises(InputError, match="as NetCDF-4"):
        GridLoad.from_file(binary)
    empty = tl.save_results(xr.Dataset({"gap": ("x", [1.0])}), tmp_path / "other.nc")
    with pytest.raises(InputError, match="no contact and no pressure"):
        GridLoad.from_file(empty)


def test_a_saved_contact_loads_the_road_again(tmp_path):
    at = 0.005 * (np.arange(16) - 7.5)
    # A ball of 0.3 m: a contact of radius 18 mm in a map of 80 mm.
    gap = (at[None, :] ** 2 + at[:, None] ** 2) / 0.6
    tire = tl.Tire.from_height_map(gap, 0.005, material=tl.Elastic(3e6, 0.49))
    road = tl.Pavement.half_space(tl.Elastic(5e9, 0.35))
    contact = tl.solve_contact(tire, road, tl.Rolling(normal_load=100.0, friction=0.5, tractive_force=20.0))
    path = tl.save_results(tl.results.to_tree([contact]), tmp_path / "contact.nc")
    for load in (GridLoad.from_file(path, interpolation="bilinear"), GridLoad.from_dataset(contact)):
        assert load.normal_load == pytest.approx(100.0, rel=1e-6)
        # The contact's own sign: positive when driving; the solver's tolerance.
        assert load.tractive_force == pytest.approx(20.0, rel=1e-4)
        np.testing.assert_array_equal(load.pressure, contact.dataset["pressure"])
    flat = tl.save_results(contact.dataset, tmp_path / "flat.nc")
    assert GridLoad.from_file(flat).normal_load == pytest.approx(100.0, rel=1e-6)


def test_our_own_table_of_a_contact_comes_back(tmp_path):
    names = {"pressure": PRESSURE, "traction_x": ALONG, "traction_y": ACROSS, "gap": 0 * PRESSURE}
    data = tl.variables.dataset({k: (("y", "x"), v) for k, v in names.items()}, {"x": GRID.x, "y": GRID.y})
    load = GridLoad.from_csv(tl.results.write_csv(data, tmp_path / "contact.csv")[0])
    np.testing.assert_allclose(load.array, LOAD.array, rtol=1e-12)
    np.testing.assert_allclose([load.grid.x, load.grid.y[:1].repeat(3)], [GRID.x, GRID.y[:1].repeat(3)], atol=1e-12)


def stored(tmp_path, pressure="Pa", factor=1.0, at="m", places=1.0, **more):
    """A NetCDF file of 10 kN on 3 x 4 cells in units of its own."""
    attrs = {} if pressure is None else {"units": pressure}
    where = {} if at is None else {"units": at}
    values = np.full((4, 3), 10e3 / (12 * 0.005 * 0.004)) * factor
    data = xr.Dataset(
        {"pressure": (("y", "x"), values, attrs), **more},
        {"x": ("x", 0.005 * np.arange(3) * places, where), "y": ("y", 0.004 * np.arange(4) * places, where)},
    )
    path = tmp_path / "stress.nc"
    data.to_netcdf(path, engine="h5netcdf")
    return path


@pytest.mark.parametrize(
    ("pressure", "factor"),
    [
        ("kPa", 1e-3),
        ("MPa", 1e-6),
        ("N m-2", 1.0),
        ("N.mm-2", 1e-6),
        ("kg m-1 s-2", 1.0),
        ("psi", 1 / 6894.757293168361),
        ("Pascal", 1.0),
        ("bars", 1e-5),
    ],
)
def test_netcdf_is_read_in_its_own_units(tmp_path, pressure, factor):
    """Pressures in kPa once made 10 N of 10 kN."""
    path = stored(tmp_path, pressure, factor, "mm", 1e3)
    load = GridLoad.from_file(path)
    assert load.normal_load == pytest.approx(10e3, rel=1e-12)
    assert (load.grid.dx, load.grid.dy) == pytest.approx((0.005, 0.004), rel=1e-12)
    assert str(load).startswith("10 kN on 240 mm² (3 x 4 cells of 5 x 4 mm), peak pressure 41667 kPa")
    assert load.source == f"stress.nc: x and y in mm, pressure in {pressure}"
    # A dataset in memory keeps what its attributes say.
    assert GridLoad.from_dataset(xr.load_dataset(path, engine="h5netcdf")).normal_load == pytest.approx(10e3)


def test_netcdf_without_units_takes_them_by_keyword(tmp_path):
    path = stored(tmp_path, None, 1e-3)
    with pytest.raises(InputError, match=r'pressure names no unit; .* or give units={"pressure": "kPa"}'):
        GridLoad.from_file(path)
    assert GridLoad.from_file(path, units={"pressure": "kPa"}).normal_load == pytest.approx(10e3)
    # In memory a bare number is SI, as everywhere.
    bare = xr.load_dataset(path, engine="h5netcdf")
    assert GridLoad.from_dataset(bare).normal_load == pytest.approx(10.0)
    assert GridLoad.from_dataset(bare, units={"pressure": "kPa"}).normal_load == pytest.approx(10e3)


@pytest.mark.parametrize(
    ("given", "units", "message"),
    [
        ({"pressure": "kpa"}, None, "pressure is in 'kpa', which is not a unit of pressure such as Pa, kPa"),
        ({"pressure": "mm"}, None, "'mm', which is not a unit of pressure"),
        ({"pressure": "kg/cm2"}, None, "'kg/cm2', which is not a unit of pressure"),
        ({"pressure": "1"}, None, "not a unit of pressure"),
        ({"at": "km/h"}, None, "x is in 'km/h', which is not a unit of length"),
        ({"at": None}, None, "x names no unit"),
        ({"at": "days since 2000-01-01"}, None, "not a unit of length"),
        ({}, {"pressure": "kPa"}, "pressure names a unit of its own, 'Pa'"),
        ({}, {"stress": "kPa"}, "units names 'stress'; the variables are x, y, pressure"),
        ({"pressure": None}, {"pressure": "kilo"}, "units has 'kilo' for pressure, which is not a unit of pressure"),
        ({"traction_x": ("x", [1.0, 2.0, 3.0], {"units": "Pa"})}, None, r"traction_x must have dimensions \(y, x\)"),
        ({"traction_x": (("y", "x"), np.full((4, 3), "a"), {"units": "Pa"})}, None, "traction_x must hold numbers"),
    ],
)
def test_netcdf_with_strange_units_is_refused(tmp_path, given, units, message):
    with pytest.raises(InputError, match=message) as caught:
        GridLoad.from_file(stored(tmp_path, **given), units=units)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "text",
    [
        "x [mm]\ty [mm]\tpressure [kPa]\n0,5\t0\t100,5\n1,0\t0\t200\n",
        "x [mm] y [mm] pressure [kPa]\n0,5 0 100,5\n1,0 0 200\n",
        'x [mm],y [mm],pressure [kPa]\n"0,5",0,"100,5"\n"1,0",0,200\n',
    ],
)
def test_tables_with_decimal_commas(tmp_path, text):
    load = GridLoad.from_csv(write(tmp_path, text), spacing=("0.5 mm", "1 mm"))
    np.testing.assert_allclose(load.pressure, [[100.5e3, 200e3]], rtol=1e-12)
    assert "decimal commas" in load.source
    assert "pressure in kPa" in load.source


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("1;2,5\n3;4.5\n", "a comma in '2,5' in line 1 and a point in '4.5' in line 2"),
        ("1 2\n3 ERR\n", "line 2: pressure is 'ERR', not a number"),
        ("x;y;pressure\n0;0;1\n1;0;o\n", "line 3: pressure is 'o', not a number"),
        ("x,y,pressure\n0;0;1\n", "line 1: pressure|unknown column"),
        ("x,y,pressure\n0,0,1,5\n1,0,2,5\n", "line 2: 4 values where the header has 3"),
        ("100,200\n300,400\n", "may be two whole numbers or one with a decimal comma"),
        ("1;2;3\n#4;5;6\n7;8;9\n", "line 2 reads like a row of numbers"),
        ("ERR;2;3\n4;5;6\n", "line 1: pressure is 'ERR'"),
    ],
)
def test_what_a_table_cannot_mean(tmp_path, text, message):
    with pytest.raises(InputError, match=message):
        GridLoad.from_csv(write(tmp_path, text), spacing="5 mm")


def test_whole_numbers_of_a_sensor_are_read(tmp_path):
    load = GridLoad.from_csv(write(tmp_path, "0,12,7\n0,115,90\n"), spacing="5 mm", units={"pressure": "kPa"})
    np.testing.assert_array_equal(load.pressure, [[0, 12e3, 7e3], [0, 115e3, 90e3]])
    given = GridLoad.from_csv(write(tmp_path, "100,200\n300,400\n"), spacing="5 mm", decimal=".")
    np.testing.assert_array_equal(given.pressure, [[100, 200], [300, 400]])


def shoulder(traction_y=0.0, y0=-0.02):
    """A wheel that presses harder on its right side."""
    pressure = np.tile([[2e5], [3e5], [9e5]], (1, 4))
    return GridLoad(Grid(4, 3, 0.02, 0.02, -0.03, y0), pressure, None, np.full((3, 4), traction_y))


def test_the_tires_of_a_pair_are_mounted_back_to_back():
    """What faces outward on the right wheel faces inward on the left one: the harder sides are the outer ones."""
    left, right = dual_wheels(shoulder(), 0.3)
    np.testing.assert_array_equal(right.pressure, shoulder().pressure)
    np.testing.assert_array_equal(left.pressure, shoulder().pressure[::-1])
    assert (left.grid.y.mean(), right.grid.y.mean()) == pytest.approx((-0.15, 0.15))
    # Where the load stands off the origin, the pair stands about that place.
    left, right = dual_wheels(shoulder(y0=0.98), 0.3)
    assert (left.grid.y.mean(), right.grid.y.mean()) == pytest.approx((0.85, 1.15))
    assert left.pressure[0, 0] == right.pressure[-1, 0] == 9e5
    same, _ = dual_wheels(shoulder(), 0.3, mirrored=False)
    np.testing.assert_array_equal(same.pressure, shoulder().pressure)


def test_a_mirror_would_turn_a_side_force_round():
    """A pair in a bend pushes one way; free shear that balances is turned round with its tire."""
    left, right = dual_wheels(shoulder(traction_y=1e5), 0.3)
    assert left.lateral_force == pytest.approx(right.lateral_force)
    np.testing.assert_array_equal(left.pressure, right.pressure)
    turned, right = dual_wheels(shoulder(traction_y=1e5), 0.3, mirrored=True)
    assert turned.lateral_force == pytest.approx(-right.lateral_force)
    spinning = xr.Dataset(
        {"pressure": (("y", "x"), shoulder().pressure), "spin": 0.1},
        {"y": shoulder().grid.y, "x": shoulder().grid.x},
    )
    left, right = dual_wheels(spinning, 0.3)
    np.testing.assert_array_equal(left.pressure, right.pressure)
    left, right = dual_wheels(spinning.assign(spin=0.0), 0.3)
    np.testing.assert_array_equal(left.pressure, right.pressure[::-1])
