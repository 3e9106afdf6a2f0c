"""solve_response: the dataset, grids, superposition, slices, text and refusals."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from treadload import variables
from treadload.errors import InputError
from treadload.grid import Grid
from treadload.materials import Elastic
from treadload.pavement import Layer, Pavement
from treadload.response import GridLoad, Response, UniformDisc, solve_response

ASPHALT = Elastic(5.4e9, 0.35)
ROAD = Pavement.half_space(ASPHALT)
GRID = Grid(14, 11, 0.003, 0.004, -0.02, 0.01)


def make_load(grid=GRID, seed=3):
    rng = np.random.default_rng(seed)
    pressure = rng.random(grid.shape) * 1e6
    return GridLoad(grid, pressure, 0.3 * pressure * rng.random(grid.shape), -0.2 * pressure)


def as_dataset(load):
    names = ("pressure", "traction_x", "traction_y")
    return xr.Dataset(
        {name: (("y", "x"), getattr(load, name)) for name in names}, {"x": load.grid.x, "y": load.grid.y}
    )


@pytest.fixture(scope="module")
def response():
    return solve_response(make_load(), ROAD, depths=[0, 0.003, 0.02])


def test_every_variable_has_its_name_unit_and_dimensions(response):
    data = response.dataset
    assert dict(data.sizes) == {"depth": 3, "y": 11, "x": 14, "component": 3}
    largest = {"largest_principal_strain", "largest_in_plane_strain"}
    names = [
        *(name for name in variables._RESPONSE if name not in largest),
        "displacement_x",
        "displacement_y",
        "displacement_z",
    ]
    assert set(names) == set(data.data_vars)
    for name in names:
        assert data[name].attrs == variables.attributes(name)
        last = ("component",) if name == "principal_direction_1" else ()
        assert data[name].dims == ("depth", "y", "x", *last)
    assert list(data["component"].values) == ["x", "y", "z"]
    assert data.attrs["modulus"] == 5.4e9
    assert data.attrs["poisson"] == 0.35


def test_the_surface_carries_the_load(response):
    load, surface = make_load(), response.dataset.sel(depth=0)
    # Round-off.
    np.testing.assert_allclose(surface["stress_zz"], -load.pressure, rtol=1e-14)
    np.testing.assert_allclose(surface["stress_xz"], -load.traction_x, rtol=1e-14)
    np.testing.assert_allclose(surface["stress_yz"], -load.traction_y, rtol=1e-14)
    np.testing.assert_allclose(surface["strain_xz"], -load.traction_x / (2 * ASPHALT.shear_modulus), rtol=1e-13)


def test_strain_and_stress_obey_hooke(response):
    data, nu, modulus = response.dataset, ASPHALT.poisson, ASPHALT.modulus
    trace = data["strain_xx"] + data["strain_yy"] + data["strain_zz"]
    back = modulus / (1 + nu) * (data["strain_yy"] + nu / (1 - 2 * nu) * trace)
    # Round-off of MPa, amplified by 1 / (1 - 2ν) = 3.3.
    np.testing.assert_allclose(back, data["stress_yy"], atol=1e-8)


def test_principal_fields_belong_together(response):
    data = response.dataset
    x, y, z = (data["principal_direction_1"].sel(component=c) for c in "xyz")
    along = (
        data["strain_xx"] * x * x
        + data["strain_yy"] * y * y
        + data["strain_zz"] * z * z
        + 2 * (data["strain_xy"] * x * y + data["strain_xz"] * x * z + data["strain_yz"] * y * z)
    )
    # Round-off of strain of 1e-4.
    np.testing.assert_allclose(along, data["principal_strain_1"], atol=1e-17)
    assert (data["principal_strain_1"] >= data["in_plane_strain_1"] - 1e-17).all()
    total = sum(data[f"principal_strain_{k}"] for k in (1, 2, 3))
    np.testing.assert_allclose(total, data["strain_xx"] + data["strain_yy"] + data["strain_zz"], atol=1e-17)


def test_a_dataset_and_a_result_load_like_a_grid_load(response):
    load = make_load()
    for given in (as_dataset(load), as_dataset(load).transpose("x", "y"), SimpleNamespace(dataset=as_dataset(load))):
        other = solve_response(given, ROAD, depths=[0, 0.003, 0.02])
        # Coordinates that went through a dataset give back the spacing to round-off.
        np.testing.assert_allclose(other.dataset["strain_xx"], response.dataset["strain_xx"], atol=1e-15)


def test_a_load_without_shear():
    load = make_load()
    bare = as_dataset(load)[["pressure"]]
    plain = solve_response(GridLoad(GRID, load.pressure), ROAD, depths=0.0)
    np.testing.assert_allclose(
        solve_response(bare, ROAD, depths=0.0).dataset["stress_xx"], plain.dataset["stress_xx"], atol=1e-6
    )
    assert not plain.dataset["stress_xz"].any()


def test_a_slice_is_a_part_of_the_whole(response):
    data = response.dataset
    row, column = float(data["y"][4]), float(data["x"][6])
    along = solve_response(make_load(), ROAD, depths=data["depth"].values, y=row).dataset
    across = solve_response(make_load(), ROAD, depths=data["depth"].values, x=[column]).dataset
    assert dict(along.sizes) == {"depth": 3, "y": 1, "x": 14, "component": 3}
    # Round-off of 1e6 Pa in transforms of another length.
    np.testing.assert_allclose(along["stress_xy"].isel(y=0), data["stress_xy"].isel(y=4), atol=1e-7)
    np.testing.assert_allclose(across["stress_xy"].isel(x=0), data["stress_xy"].isel(x=6), atol=1e-7)


def test_any_output_grid(response):
    x, y = np.array([-0.5, -0.011, 0.0123]), np.array([0.05, 0.031])
    odd = solve_response(make_load(), ROAD, depths=[0.003], x=x, y=y).dataset
    assert odd["stress_zz"].shape == (1, 2, 3)
    np.testing.assert_array_equal(odd["x"], x)
    # On a cell centre it is the value of the load's own grid; round-off.
    own = response.dataset["stress_zz"].sel(depth=0.003).sel(x=-0.011, method="nearest").isel(y=3)
    found = solve_response(make_load(), ROAD, depths=[0.003], x=[float(own.x), 0.0123], y=[float(own.y)])
    np.testing.assert_allclose(found.dataset["stress_zz"][0, 0, 0], own, atol=1e-7)


def test_loads_add_up_on_the_grid_that_holds_them():
    one, shifted = make_load(), Grid(6, 5, GRID.dx, GRID.dy, GRID.x0 + 20 * GRID.dx, GRID.y0 - 3 * GRID.dy)
    other = make_load(shifted, seed=5)
    both = solve_response([one, as_dataset(other)], ROAD, depths=[0.0, 0.01]).dataset
    assert both.sizes["x"] == 26
    assert both.sizes["y"] == 14
    parts = [
        solve_response(load, ROAD, depths=[0.0, 0.01], x=both["x"], y=both["y"]).dataset["stress_yy"]
        for load in (one, other)
    ]
    # Round-off of 1e6 Pa.
    np.testing.assert_allclose(both["stress_yy"], parts[0].values + parts[1].values, atol=1e-7)


def test_loads_on_different_lattices_need_coordinates():
    other = make_load(Grid(6, 5, 0.002, 0.004, 0.0, 0.0))
    with pytest.raises(InputError, match="give x and y"):
        solve_response([make_load(), other], ROAD, depths=[0.01])
    assert solve_response([make_load(), other], ROAD, depths=[0.01], x=[0.0], y=[0.0]).dataset.sizes["x"] == 1


def test_layers_of_one_material_are_one_material(response):
    same = Pavement([Layer(ASPHALT, 0.06), Layer(ASPHALT)])
    other = solve_response(make_load(), same, depths=[0, 0.003, 0.02], side="below")
    xr.testing.assert_equal(other.dataset, response.dataset)


def test_summary_says_both_extensions_and_where(response):
    text = response.summary()
    assert "E = 5400 MPa" in text
    assert text.count("tensile strain, three-dimensional") == text.count("tensile strain, horizontal plane") == 3
    surface = response.dataset.sel(depth=0)
    for name in ("principal_strain_1", "in_plane_strain_1"):
        assert f"{float(surface[name].max()) * 1e6:.1f} microstrain at x = " in text
    assert str(response) == text


def test_summary_of_pure_compression():
    response = solve_response(
        GridLoad(Grid(3, 3, 0.1, 0.1, 0, 0), np.full((3, 3), 1e6)), ROAD, depths=0, x=0.1, y=0.1
    )
    assert "no tensile strain" in response.summary()


def test_stats(response):
    assert isinstance(response, Response)
    assert response.stats["points"] == 3 * 14 * 11
    assert response.stats["method"] == "fft"
    assert response.stats["seconds"] > 0


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"depths": [0.0, -0.01]}, "must not be negative, got -0.01"),
        ({"depths": [np.nan]}, "must be finite"),
        ({"depths": []}, "at least one"),
        ({"depths": ["deep"]}, "must be numbers"),
        ({"depths": [0.01, 0.01]}, "distinct"),
        ({"x": [[0.0]]}, "at least one"),
        ({"y": [np.inf]}, "must be finite"),
        ({"side": "left"}, "side must be"),
        ({"loads": []}, "empty list"),
        ({"loads": 3.0}, "float"),
        ({"loads": ["no"]}, "str"),
        (
            {"road": Pavement([Layer(ASPHALT, 0.06)], rigid_base=True), "depths": [0.07]},
            "below the rigid base at 0.06",
        ),
        ({"road": Pavement([Layer(ASPHALT, 1e-5), Layer(Elastic(1e8, 0.4))])}, "thin layers near the surface"),
        ({"loads": UniformDisc(0.1, 1e6)}, "give x and y"),
    ],
)
def test_refusals(changes, message):
    arguments = {"loads": make_load(), "road": ROAD, "depths": [0.0], **changes}
    with pytest.raises(InputError, match=message):
        solve_response(arguments.pop("loads"), arguments.pop("road"), **arguments)


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda d: d.drop_vars("pressure"), "pressure missing"),
        (lambda d: d.assign(pressure=-d["pressure"]), "must not be negative"),
        (lambda d: d.assign(traction_x=d["traction_x"] * np.nan), "traction_x must be finite"),
        (lambda d: d.isel(x=[0]), "spacing along x"),
        (lambda d: d.isel(x=[0, 1, 3]), "even steps"),
        (lambda d: d.isel(y=slice(None, None, -1)), "even steps"),
        (lambda d: d.assign(pressure=d["pressure"].expand_dims("time")), "dimensions"),
    ],
)
def test_bad_datasets(spoil, message):
    with pytest.raises(InputError, match=message):
        GridLoad.from_dataset(spoil(as_dataset(make_load())))


def test_a_load_keeps_its_own_numbers():
    pressure = np.ones(GRID.shape)
    load = GridLoad(GRID, pressure)
    pressure[:] = 5
    assert load.pressure.max() == 1
    with pytest.raises(ValueError, match="read-only"):
        load.pressure[0, 0] = 2
    with pytest.raises(InputError, match="shape"):
        GridLoad(GRID, np.ones((2, 2)))


def test_a_single_row_of_cells_needs_its_width():
    load = make_load(Grid(5, 1, 0.003, 0.2, 0.0, 0.0))
    read = GridLoad.from_dataset(as_dataset(load).assign_attrs(dx=0.003, dy=0.2))
    # The spacing along x is read from five coordinates.
    assert read.grid.dx == pytest.approx(0.003, rel=1e-12)
    assert read.grid.dy == 0.2
    np.testing.assert_array_equal(read.pressure, load.pressure)


def test_depths_within_half_a_cell_warn():
    assert not solve_response(make_load(), ROAD, depths=[0.0, 0.0015], y=0.02).warnings
    shallow = solve_response(make_load(), ROAD, depths=[0.0, 0.001], y=0.02)
    assert "depth 1 mm is less than half a cell, 1.5 mm" in shallow.warnings[0]
    assert shallow.warnings[0] in shallow.summary()
    smooth = replace(make_load(), interpolation="bilinear")
    assert not solve_response(smooth, ROAD, depths=[0.0, 0.001], y=0.02).warnings


def test_points_between_the_cells_read_smooth_shear_better():
    # Hertz-shaped shear: stress_xx = -(4 + ν) π q0 x / 8 a inside (Johnson 1985, equation 7.29 without pressure).
    radius, nu = 0.1, ASPHALT.poisson
    errors = {}
    for n in (50, 100):
        grid = Grid.centred(2 * radius, 2 * radius, 2 * radius / n)
        fine = (np.arange(n * 8) + 0.5) / (n * 8) * 2 - 1
        shape = np.sqrt(np.maximum(0, 1 - fine[None, :] ** 2 - fine[:, None] ** 2))
        shear = 1e6 * shape.reshape(n, 8, n, 8).mean(axis=(1, 3))
        load = GridLoad(grid, 0 * shear, shear)
        for name, x in (("centres", grid.x), ("between", grid.x + grid.dx / 2)):
            inner = x[np.abs(x) < 0.7 * radius]
            found = solve_response(load, ROAD, depths=0.0, x=inner, y=grid.y[n // 2]).dataset["stress_xx"]
            exact = -(4 + nu) * np.pi / 8 * 1e6 * inner / radius
            errors[name, n] = np.abs(found.to_numpy().squeeze() - exact).max()
    # First order at centres; between them, several times smaller already at 50 cells.
    assert 1.7 < errors["centres", 50] / errors["centres", 100] < 2.3
    assert errors["between", 50] < 0.25 * errors["centres", 50]
