import dataclasses
import math

import numpy as np
import pytest
import xarray as xr

from treadload.catalogue import tires
from treadload.errors import GeometryError, InputError
from treadload.grid import Grid
from treadload.materials import Elastic
from treadload.tire import Groove, Tire, TreadProfile, modulus_from_inflation


def bowl(nx=9, ny=7, d=3e-3):
    x, y = np.arange(nx) - (nx - 1) / 2, np.arange(ny) - (ny - 1) / 2
    return (x[None, :] ** 2 + y[:, None] ** 2) * d**2 / 2


def test_modulus_follows_the_published_line():
    assert modulus_from_inflation(820e3) == pytest.approx(2.914e6, rel=1e-12)
    assert modulus_from_inflation(500e3) == pytest.approx(2.05e6, rel=1e-12)


@pytest.mark.parametrize("pressure", [0, -1e5, math.nan, math.inf, 820, 8.2, 9.9e3, 3.1e6, 820e6, "high"])
def test_modulus_refuses_what_cannot_be_pascals(pressure):
    with pytest.raises(InputError, match="Pa"):
        modulus_from_inflation(pressure)


def test_modulus_names_the_unit_that_was_meant():
    with pytest.raises(InputError, match="820 kPa is 820000 Pa"):
        modulus_from_inflation(820)
    with pytest.raises(InputError, match=r"8\.2 bar is 8\.2e5 Pa"):
        modulus_from_inflation(8.2)


def test_elastic_is_the_material_or_comes_from_the_pressure():
    rubber = Elastic(3e6, 0.49)
    assert Tire.from_height_map(bowl(), 3e-3, material=rubber, inflation_pressure=820e3).elastic == rubber
    assert Tire.from_height_map(bowl(), 3e-3, inflation_pressure=820e3).elastic == Elastic(
        modulus_from_inflation(820e3), 0.5
    )
    with pytest.raises(InputError, match="inflation_pressure=820e3"):
        _ = Tire.from_height_map(bowl(), 3e-3).elastic


def test_tire_refuses_wrong_parts():
    with pytest.raises(InputError, match="from_profile"):
        Tire("a tire")
    with pytest.raises(InputError, match="Elastic"):
        Tire.from_height_map(bowl(), 3e-3, material=3e6)
    with pytest.raises(InputError, match="kPa"):
        Tire.from_height_map(bowl(), 3e-3, inflation_pressure=820)


def test_height_map_has_its_own_centred_grid():
    tire = Tire.from_height_map(bowl(), (3e-3, 4e-3))
    grid = tire.fixed_grid
    assert grid == Grid(9, 7, 3e-3, 4e-3, -0.012, -0.012)
    assert tire.extent == pytest.approx((0.027, 0.028))
    assert tire.quality is None
    np.testing.assert_array_equal(tire.height_map(grid), bowl())
    with pytest.raises(InputError, match="leave the spacing out"):
        tire.height_map(Grid.centred(0.027, 0.021, 1e-3))
    with pytest.raises(InputError, match="height map"):
        tire.height_map(dataclasses.replace(grid, x0=0.0))


def test_height_map_shifts_its_minimum_to_zero_and_keeps_nan():
    gap = bowl() + 0.25
    gap[0, 0] = np.nan
    out = Tire.from_height_map(gap, 3e-3).surface.gap
    assert np.nanmin(out) == 0
    assert np.isnan(out[0, 0])
    assert out[1, 1] == pytest.approx(bowl()[1, 1])


def test_a_tire_keeps_its_map_when_the_users_array_changes():
    gap = bowl()
    tire = Tire.from_height_map(gap, 3e-3)
    before = hash(tire)
    gap[:] = 1.0
    tire.height_map(tire.fixed_grid)[:] = 7.0
    assert tire.height_map(tire.fixed_grid).max() < 1e-3
    assert hash(tire) == before
    with pytest.raises(ValueError, match="read-only"):
        tire.surface.gap[0, 0] = 1.0


@pytest.mark.parametrize(
    ("gap", "spacing", "error", "says"),
    [
        (np.full((3, 3), np.nan), 1e-3, GeometryError, "all 9 values"),
        (np.array([[0, np.inf]]), 1e-3, InputError, "1 infinite"),
        (np.zeros(5), 1e-3, InputError, "2-D"),
        (np.zeros((0, 5)), 1e-3, InputError, "at least one value"),
        (np.zeros((3, 3)), None, InputError, "spacing"),
        (np.zeros((3, 3)), 0, InputError, "spacing"),
        (np.zeros((3, 3)), (1e-3, -1e-3), InputError, "spacing"),
        (np.zeros((3, 3)), (1e-3, 1e-3, 1e-3), InputError, "spacing"),
        (np.zeros((3, 3)), "fine", InputError, "spacing"),
        ([["a", "b"]], 1e-3, InputError, "numbers"),
        ("nowhere.csv", 1e-3, InputError, "no file"),
    ],
)
def test_height_map_refuses(gap, spacing, error, says):
    with pytest.raises(error, match=says):
        Tire.from_height_map(gap, spacing)


def test_equal_contents_are_equal():
    a, b = (Tire.from_height_map(bowl(), 3e-3, inflation_pressure=8e5) for _ in range(2))
    assert a == b
    assert hash(a) == hash(b)
    assert a != Tire.from_height_map(bowl() * 1.001, 3e-3, inflation_pressure=8e5)
    assert a != Tire.from_height_map(bowl(), 4e-3, inflation_pressure=8e5)
    assert a != dataclasses.replace(a, inflation_pressure=7e5)
    gap = bowl()
    gap[0, 0] = np.nan
    assert Tire.from_height_map(gap, 3e-3) == Tire.from_height_map(gap.copy(), 3e-3)
    assert len({a, b, Tire.from_profile("315/80R22.5")}) == 2
    assert a != Tire.from_profile("315/80R22.5")


def test_tires_print_what_they_are():
    text = str(Tire.from_profile("315/80R22.5", inflation_pressure=820e3, material=Elastic(3e6, 0.5)))
    for part in ("315/80R22.5", "538 mm", "820 kPa", "3 MPa"):
        assert part in text
    assert "9 x 7 cells" in str(Tire.from_height_map(bowl(), 3e-3))


@pytest.mark.parametrize("ending", [".csv", ".txt", ".tsv", ".npy", ".npz"])
def test_matrix_files_give_the_map(tmp_path, ending):
    path = tmp_path / f"map{ending}"
    gap = bowl()
    gap[2, 3] = np.nan
    if ending == ".npy":
        np.save(path, gap)
    elif ending == ".npz":
        np.savez(path, initial_gap=gap, other=np.zeros((2, 2)))
    else:
        np.savetxt(path, gap, delimiter={".csv": ",", ".txt": " ", ".tsv": "\t"}[ending])
    tire = Tire.from_height_map(path, 3e-3)
    np.testing.assert_allclose(tire.height_map(tire.fixed_grid), gap, atol=1e-18)
    with pytest.raises(InputError, match="spacing"):
        Tire.from_height_map(path)


def test_csv_reads_empty_fields_as_no_material(tmp_path):
    path = tmp_path / "map.csv"
    path.write_text("0.001,,0.002\n0,0.003,nan\n")
    gap = Tire.from_height_map(path, 3e-3).surface.gap
    np.testing.assert_array_equal(gap, [[0.001, np.nan, 0.002], [0, 0.003, np.nan]])


@pytest.mark.parametrize("text", ["", "tread\nrubber\n", "1,2,3\n4,5\n"])
def test_matrix_files_that_are_none_are_refused(tmp_path, text):
    path = tmp_path / "map.csv"
    path.write_text(text)
    with pytest.raises((InputError, GeometryError)):
        Tire.from_height_map(path, 3e-3)


def test_netcdf_brings_its_cells(tmp_path):
    path = tmp_path / "tread.nc"
    grid = Grid(9, 7, 3e-3, 4e-3, 0.1, -0.02)
    data = xr.Dataset(
        {"initial_gap": (("y", "x"), bowl(), {"units": "m"}), "other": (("y", "x"), bowl())},
        {name: (name, at, {"units": "m"}) for name, at in (("x", grid.x), ("y", grid.y))},
    )
    data.to_netcdf(path, engine="h5netcdf")
    tire = Tire.from_height_map(path)
    assert dataclasses.astuple(tire.fixed_grid) == pytest.approx(dataclasses.astuple(grid))
    np.testing.assert_array_equal(tire.height_map(grid), bowl())

    data.isel(x=slice(None, None, -1)).transpose("x", "y").to_netcdf(tmp_path / "turned.nc", engine="h5netcdf")
    assert Tire.from_height_map(tmp_path / "turned.nc", name=tire.name) == tire
    with pytest.raises(InputError, match="leave spacing out"):
        Tire.from_height_map(path, 5e-3)


def test_netcdf_that_is_unclear_is_refused(tmp_path):
    def write(name, data):
        data.to_netcdf(tmp_path / name, engine="h5netcdf")
        return tmp_path / name

    two = xr.Dataset({"a": (("y", "x"), bowl()), "b": (("y", "x"), bowl())})
    with pytest.raises(InputError, match="initial_gap"):
        Tire.from_height_map(write("two.nc", two), 3e-3)
    bare = write("bare.nc", two[["a"]])
    with pytest.raises(InputError, match="no coordinates"):
        Tire.from_height_map(bare, units="m")
    with pytest.raises(InputError, match="gap names no unit"):
        Tire.from_height_map(bare, 3e-3)
    assert Tire.from_height_map(bare, 3e-3, units="m").fixed_grid.dx == 3e-3
    uneven = two[["a"]].assign_coords(x=np.arange(9.0) ** 2, y=np.arange(7.0))
    with pytest.raises(InputError, match="not evenly spaced"):
        Tire.from_height_map(write("uneven.nc", uneven), units="m")
    litres = xr.Dataset({"a": (("y", "x"), bowl(), {"units": "l"})})
    with pytest.raises(InputError, match="'l', which is not a unit of length"):
        Tire.from_height_map(write("litres.nc", litres), 3e-3)
    (tmp_path / "broken.nc").write_bytes(b"not a file of that kind")
    with pytest.raises(InputError, match="NetCDF"):
        Tire.from_height_map(tmp_path / "broken.nc")
    (tmp_path / "map.xyz").write_text("1 2")
    with pytest.raises(InputError, match="unknown ending"):
        Tire.from_height_map(tmp_path / "map.xyz", 3e-3)


def test_from_profile_takes_a_name_or_a_profile():
    profile = tires["315/80R22.5"]
    assert Tire.from_profile(profile) == Tire.from_profile("315_80r22.5")
    assert Tire.from_profile(profile).fixed_grid is None
    with pytest.raises(InputError, match="TreadProfile"):
        Tire.from_profile(3)
    length, width = Tire.from_profile(profile).extent
    assert 0.4 < length < 0.6
    assert 0.282 < width < 0.33


def labelled(factor=1.0, units="m", places=1.0, at="m"):
    """The bowl in a unit, on cells of 3 x 4 mm in another."""
    attrs = {} if units is None else {"units": units}
    where = {} if at is None else {"units": at}
    grid = Grid(9, 7, 3e-3, 4e-3, 0.0, 0.0)
    coordinates = {"x": ("x", places * grid.x, where), "y": ("y", places * grid.y, where)}
    return xr.Dataset({"initial_gap": (("y", "x"), factor * bowl(), attrs)}, coordinates)


@pytest.mark.parametrize(
    ("factor", "units", "places", "at"),
    [
        (1e3, "mm", 1e3, "mm"),
        (1e3, "millimeters", 1e2, "centimetre"),
        (1e6, "um", 1.0, "Meter"),
        (1e3, "1e-3 m", 1 / 0.0254, "inch"),
        (1e6, "µm", 1.0, "m"),
    ],
)
def test_netcdf_is_read_in_its_own_units(tmp_path, factor, units, places, at):
    """x in mm once gave cells of 3 m."""
    path = tmp_path / "map.nc"
    labelled(factor, units, places, at).to_netcdf(path, engine="h5netcdf")
    tire = Tire.from_height_map(path)
    # Round-off of the factors.
    np.testing.assert_allclose(tire.surface.gap, bowl(), rtol=1e-13, atol=1e-18)
    assert (tire.fixed_grid.dx, tire.fixed_grid.dy) == pytest.approx((3e-3, 4e-3), rel=1e-12)
    assert f"gap in {units}, x in {at}, y in {at}" in str(tire)
    memory = Tire.from_height_map(labelled(factor, units, places, at).initial_gap)
    np.testing.assert_array_equal(memory.surface.gap, tire.surface.gap)


@pytest.mark.parametrize(
    ("data", "options", "message"),
    [
        (labelled(units=None), {}, "gap names no unit; write its attribute units .*, or give units="),
        (labelled(at=None), {}, 'x names no unit; .* units={"x": "mm"}'),
        (
            labelled(units="furlongs/fortnight"),
            {},
            "fortnight', which is not a unit of length such as m, mm",
        ),
        (labelled(units="Pa"), {}, "'Pa', which is not a unit of length"),
        (labelled(units="1"), {}, "'1', which is not a unit of length"),
        (labelled(units=3.0), {}, "which is not a unit of length"),
        (labelled(at="degrees_east"), {}, "x is in 'degrees_east'"),
        (labelled(at="days since 2000-01-01"), {}, "x is in 'days since 2000-01-01', which is not a unit of length"),
        (labelled(), {"units": {"gap": "mm"}}, "gap names a unit of its own, 'm'; leave it out of units"),
        (labelled(), {"units": {"height": "mm"}}, "units names 'height'; the names of a height map are gap, x, y"),
        (labelled(units=None), {"units": {"gap": "kPa"}}, "units has 'kPa' for gap, which is not a unit of length"),
        (labelled(1e3), {}, r"heights differ by .* more than any tread's; give units={\"gap\": \"mm\"}"),
    ],
)
def test_netcdf_with_strange_units_is_refused(tmp_path, data, options, message):
    path = tmp_path / "map.nc"
    data.to_netcdf(path, engine="h5netcdf")
    with pytest.raises(InputError, match=message) as caught:
        Tire.from_height_map(path, **options)
    assert "\n" not in str(caught.value)


def test_units_by_keyword_where_the_file_names_none(tmp_path):
    path = tmp_path / "map.nc"
    labelled(1e3, None, 1e3, None).to_netcdf(path, engine="h5netcdf")
    for units in ("mm", {"gap": "mm", "x": "mm", "y": "mm"}):
        tire = Tire.from_height_map(path, units=units)
        np.testing.assert_allclose(tire.surface.gap, bowl(), rtol=1e-13, atol=1e-18)
    np.savetxt(tmp_path / "map.csv", 1e3 * bowl(), delimiter=";")
    tire = Tire.from_height_map(tmp_path / "map.csv", 3e-3, units={"gap": "mm"})
    np.testing.assert_allclose(tire.surface.gap, bowl(), rtol=1e-13, atol=1e-18)
    tire = Tire.from_height_map(1e3 * bowl(), 3e-3, units="mm")
    np.testing.assert_allclose(tire.surface.gap, bowl(), rtol=1e-13, atol=1e-18)


def test_our_own_height_map_comes_back(tmp_path):
    from treadload.results import height_map, save_results

    tire = Tire.from_profile("315/80R22.5")
    data = height_map(tire, 6e-3)
    back = Tire.from_height_map(save_results(data, tmp_path / "tread.nc"))
    np.testing.assert_array_equal(back.surface.gap, data.initial_gap)
    assert 0.0 in back.fixed_grid.x


SEPARATED = {
    "commas": "0.0012,0.5e-3,0\n0.001,,0.002\n",
    "semicolons": "0.0012;0.5e-3;0\n0.001;NaN;0.002\n",
    "semicolons, decimal commas": "0,0012;0,5e-3;0\n0,001;nodata;0,002\n",
    "tabs, decimal commas": "0,0012\t0,5e-3\t0\n0,001\t\t0,002\n",
    "blanks": "  0.0012  0.5e-3 0\n 0.001  NA 0.002\n",
    "blanks, decimal commas": "0,0012 0,5e-3 0\n0,001 null 0,002\n",
    "commas and blanks": "0.0012, 0.5e-3, 0\n0.001, , 0.002\n",
    "quoted decimal commas": '"0,0012","0,5e-3",0\n"0,001",,"0,002"\n',
    "a byte order mark, comments, DOS lines": "\ufeff# gap, m\r\n0.0012,0.5e-3,0\r\n\r\n0.001,N/A,0.002\r\n",
}


@pytest.mark.parametrize("kind", SEPARATED)
def test_separators_and_decimal_marks_are_recognised(tmp_path, kind):
    path = tmp_path / "map.csv"
    path.write_text(SEPARATED[kind], encoding="utf-8", newline="")
    tire = Tire.from_height_map(path, 3e-3)
    np.testing.assert_array_equal(tire.surface.gap, [[0.0012, 0.0005, 0], [0.001, np.nan, 0.002]])
    assert "3 x 2 cells of 3 x 3 mm, gap up to 2 mm, 1 of 6 without material; read from map.csv: " in str(tire)
    assert ("decimal commas" in str(tire)) == ("decimal commas" in kind)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        # What once made holes in silence.
        ("0.001,ERR\n0.002,0.003\n", "line 1: the gap is 'ERR', not a number; .*row 1, column 2"),
        ("0.001,0.002\n0.002,0.0o3\n", "line 2: the gap is '0.0o3', not a number; .*row 2, column 2"),
        ("0.001,#REF!\n0.002,0.003\n", "line 1: the gap is '#REF!'"),
        ("0.001,0.002\n#N/A,0.003\n", "line 2: the gap is '#N/A'"),
        ("0,001;0.002\n0,002;0,003\n", "a comma in '0,001' in line 1 and a point in '0.002' in line 1"),
        ("0.001 0,002\n0.002 0.003\n", "a comma in '0,002' in line 1 and a point in '0.001'"),
        ("0,001,0,002\n0,002,0,003\n", "may be two whole numbers or one with a decimal comma"),
        ("0,001,0,02\n0,002,0,003\n", "may be two whole numbers or one with a decimal comma"),
        ("0,001,0.5\n0,002,0.5\n", "'001', with a zero in front; has it lost its decimal mark"),
        ("0,5\n0,7\n", "may be two whole numbers or one with a decimal comma"),
        ("0.001;0.002\n0.003;0012\n", "'0012', with a zero in front"),
        ("1.200,5;0\n1.300,5;0\n", "'1.200,5'"),
        ("1,200;350\n1,300;250\n", "'1,200' in line 1, a decimal number or thousands"),
        ("0.001;0.002;0.003\n0.001;0.002\n", "line 2: 2 values where the first row has 3"),
        ("0.001,0.002\n0.003,inf\n", r"line 2: the gap is infinite \(row 2, column 2\)"),
        ("0.001,0.002\n0.003,1e999\n", "line 2: the gap is infinite"),
        ("0.001,0.002\n0.003,1_0\n", "'1_0', not a number"),
        ("0.001,0.002\n0.003,\u0661\n", "not a number"),
        ("0.001,0.002\n0.003,1\u202f000\n", "not a number"),
        ("0.001,0.002\n0.003,0.001\n#0.003,0.001\n", "line 3 reads like a row of numbers and is a comment"),
        ("0.001\n\n0.003\n", "line 2 is empty; write NaN"),
        ('0.001,"0.0"2\n', "line 1: its quotation marks cannot be read"),
        ("x;y;gap\n0;0;0.001\n", "line 1: the gap is 'x', not a number"),
        ("0.001,0.002\n-9999,0.003\n", "heights differ by 9999 m on a map of 0.006 x 0.006 m"),
        ("11.5;12\n3;4\n", 'give units={"gap": "mm"}'),
    ],
)
def test_a_cell_that_is_no_number_is_an_error(tmp_path, text, message):
    path = tmp_path / "map.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=message) as caught:
        Tire.from_height_map(path, 3e-3)
    assert "\n" not in str(caught.value)


def test_the_decimal_mark_may_be_given(tmp_path):
    path = tmp_path / "map.csv"
    path.write_text("0,5\n0,7\n")
    np.testing.assert_array_equal(Tire.from_height_map(path, 3e-3, units="mm", decimal=",").surface.gap.shape, (2, 1))
    np.testing.assert_array_equal(Tire.from_height_map(path, 3e-3, units="mm", decimal=".").surface.gap.shape, (2, 2))
    with pytest.raises(InputError, match=r'decimal must be "\." or ","'):
        Tire.from_height_map(path, 3e-3, decimal=";")


@pytest.mark.parametrize(
    ("array", "message"),
    [
        (np.array([[1j, 0.0]]), "complex128"),
        (np.array([["0.1", "0.2"]]), "<U3"),
        (np.array([[True, False]]), "bool"),
    ],
)
def test_arrays_that_are_no_real_numbers(tmp_path, array, message):
    with pytest.raises(InputError, match=message):
        Tire.from_height_map(array, 3e-3)
    np.save(tmp_path / "map.npy", array)
    with pytest.raises(InputError, match=message):
        Tire.from_height_map(tmp_path / "map.npy", 3e-3)


def test_masked_cells_are_no_material():
    gap = np.ma.masked_where(np.eye(3, dtype=bool), np.full((3, 3), 1e-3))
    assert np.isnan(Tire.from_height_map(gap, 3e-3).surface.gap).sum() == 3


def test_broken_files_say_one_line_and_leave_no_traceback(tmp_path, recwarn, monkeypatch):
    """Bytes astray, from the header to the data: no raw exception, and nothing from the end of a half-made object."""
    import sys

    ended = []
    monkeypatch.setattr(sys, "unraisablehook", ended.append)
    whole = tmp_path / "map.nc"
    labelled().to_netcdf(whole, engine="h5netcdf")
    raw, rng, path = whole.read_bytes(), np.random.default_rng(7), tmp_path / "bad.nc"
    said = []
    for number in range(120):
        bad = bytearray(raw)
        for place in rng.integers(0, len(bad), 4):
            bad[place] = rng.integers(0, 256)
        path.write_bytes(bad[: rng.integers(0, len(bad))] if number % 4 == 0 else bad)
        try:
            Tire.from_height_map(path)
        except (InputError, GeometryError) as error:
            said.append(str(error))
    assert len(said) > 30
    assert not any("\n" in text for text in said)
    assert not ended


def test_which_treads_are_their_own_mirror_image():
    rib = TreadProfile(0.5, 1.0, 0.2, grooves=(Groove(0.03, 0.01, 0.01),))
    assert not Tire.from_profile(rib).is_symmetric
    assert Tire.from_profile("315/80R22.5").is_symmetric
    gap = np.add.outer(np.abs(np.arange(-3, 4)) * 1e-3, np.zeros(5))
    assert Tire.from_height_map(gap, 3e-3).is_symmetric
    gap[0] = np.nan
    assert not Tire.from_height_map(gap, 3e-3).is_symmetric


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (labelled().initial_gap[:0], r"got shape \(0, 9\)"),
        (labelled().initial_gap.expand_dims("time"), r"got shape \(1, 7, 9\)"),
        (labelled().initial_gap.assign_coords(x=np.r_[0.0, 1e308, -1e308, np.zeros(6)]), "not evenly spaced"),
    ],
)
def test_odd_arrays_with_coordinates_are_refused(data, message):
    with pytest.raises(InputError, match=message):
        Tire.from_height_map(data)


def test_a_flat_map_of_zeros_may_be_whole_numbers(tmp_path):
    path = tmp_path / "flat.csv"
    path.write_text("0,0,0,0\n0,0,0,0\n")
    assert Tire.from_height_map(path, 3e-3).surface.gap.shape == (2, 4)
