import dataclasses
import math

import numpy as np
import pytest
import xarray as xr

from treadload.errors import GeometryError, InputError
from treadload.grid import Grid
from treadload.materials import Elastic
from treadload.tire import Tire, TreadProfile, modulus_from_inflation


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
        {"x": grid.x, "y": grid.y},
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
        Tire.from_height_map(bare)
    assert Tire.from_height_map(bare, 3e-3).fixed_grid.dx == 3e-3
    uneven = two[["a"]].assign_coords(x=np.arange(9.0) ** 2, y=np.arange(7.0))
    with pytest.raises(InputError, match="not evenly spaced"):
        Tire.from_height_map(write("uneven.nc", uneven))
    millimetres = xr.Dataset({"a": (("y", "x"), bowl(), {"units": "mm"})})
    with pytest.raises(InputError, match="'mm'"):
        Tire.from_height_map(write("mm.nc", millimetres), 3e-3)
    (tmp_path / "broken.nc").write_bytes(b"not a file of that kind")
    with pytest.raises(InputError, match="NetCDF"):
        Tire.from_height_map(tmp_path / "broken.nc")
    (tmp_path / "map.xyz").write_text("1 2")
    with pytest.raises(InputError, match="unknown ending"):
        Tire.from_height_map(tmp_path / "map.xyz", 3e-3)


def test_from_profile_takes_a_name_or_a_profile():
    profile = TreadProfile.from_library("315/80R22.5")
    assert Tire.from_profile(profile) == Tire.from_profile("315_80r22.5")
    assert Tire.from_profile(profile).fixed_grid is None
    with pytest.raises(InputError, match="TreadProfile"):
        Tire.from_profile(3)
    length, width = Tire.from_profile(profile).extent
    assert 0.4 < length < 0.6
    assert 0.282 < width < 0.33
