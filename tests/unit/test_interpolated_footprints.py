"""Footprints between the cases of a study: what they keep, their error, and stores that are rejected."""

import itertools
import json
import shutil
import time

import numpy as np
import pytest
import xarray as xr
import zarr

import treadload as tl
from cases import COARSE_CASE
from studies import X, Y, question, records_of, stored
from treadload.errors import InputError
from treadload.footprint import FootprintSet
from treadload.kernels import radial_basis
from treadload.sweeps.design import listed, product
from treadload.sweeps.store import begun

CASE = tl.Case.from_text(COARSE_CASE.replace('tractive_force = "10 kN"', "creepage_x = 0.0").split("[response]")[0])
LOW, HIGH = np.array([20e3, 6e5, -0.03]), np.array([40e3, 10e5, 0.02])
KEYS = ("rolling.normal_load", "tire.inflation_pressure", "rolling.creepage_x")
FIELDS = ("pressure", "traction_x", "traction_y")
CELL = (X[1] - X[0]) * (Y[1] - Y[0])
MU = 0.7


def stress(normal_load, inflation_pressure=8e5, creepage_x=0.0, friction=MU, **_):
    """A smooth contact that grows with the load and shrinks with the inflation, with shear that slip saturates."""
    half = 0.075 * (normal_load / 3e4) ** 0.3 * (inflation_pressure / 8e5) ** -0.3
    x, y = np.meshgrid(X, Y)
    pressure = np.maximum(1 - (x / half) ** 4 - (y / 0.14) ** 4 + 0.5 * x, 0.0) ** 0.5
    pressure *= normal_load / (pressure.sum() * CELL)
    return {
        "pressure": pressure,
        "traction_x": friction * pressure * np.tanh(60 * creepage_x * (1 - x / half)) * 0.9,
        "traction_y": 0.2 * friction * pressure * np.sin(40 * y),
    }


def rows(count, seed=0):
    """Inputs of cases: the corners of the box, and random ones inside."""
    corners = np.array(list(itertools.product((0.0, 1.0), repeat=3)))
    inside = np.random.default_rng(seed).random((count, 3))
    points = LOW + np.concatenate([corners, inside]) * (HIGH - LOW)
    return [dict(zip(KEYS, point, strict=True)) for point in points.tolist()]


@pytest.fixture(scope="module")
def store(tmp_path_factory):
    path = tmp_path_factory.mktemp("set") / "set.zarr"
    stored(path, listed(CASE, rows(60)), stress, CASE)
    return path


def changed(store, path, **attrs):
    """A copy of a store with other attributes."""
    shutil.copytree(store, path)
    group = zarr.open_group(path, mode="a", zarr_format=2)
    group.attrs.update(attrs)
    zarr.consolidate_metadata(path, zarr_format=2)
    return path


def test_cubes_of_distances_reproduce_a_plane_and_the_points():
    points = np.random.default_rng(1).uniform(-1, 1, (30, 3))
    plane = points @ np.array([[1.0, -2.0], [0.5, 0.0], [3.0, 1.0]]) + np.array([4.0, -1.0])
    basis, without = radial_basis.fit(points, plane)
    at = np.array([0.3, -0.2, 0.1])
    # Linear functions are in the span: exact everywhere, and with any point left out.
    assert basis(at) == pytest.approx(at @ np.array([[1.0, -2.0], [0.5, 0.0], [3.0, 1.0]]) + [4.0, -1.0], abs=1e-9)
    np.testing.assert_allclose(without, plane, atol=1e-8)


def test_errors_left_out_are_those_of_fits_without_the_point():
    points = np.random.default_rng(2).uniform(-1, 1, (25, 2))
    values = np.sin(3 * points[:, :1]) * points[:, 1:]
    basis, without = radial_basis.fit(points, values)
    for k in (0, 7, 24):
        rest = np.arange(25) != k
        alone, _ = radial_basis._through(points[rest], values[rest], basis.lengths)
        assert alone(points[k]) == pytest.approx(without[k], abs=1e-9)


def test_a_footprint_between_cases_is_near_the_case_itself(store):
    errors = []
    for row in rows(20, seed=5)[8:]:
        load, pressure, slip = row.values()
        made = tl.Footprint.interpolate(store, load=load, pressure=pressure, slip=slip).load.array
        solved = np.stack([stress(load, pressure, slip)[name] for name in FIELDS])
        inside = (made[0] > 0) | (solved[0] > 0)
        mean = solved[0][solved[0] > 0].mean()
        errors.append(np.sqrt(np.square((made - solved)[:, inside]).mean(1)) / mean)
    # The bound of the stress set: 3 % of the mean pressure, rms; these 68 cases of large cells reach 1.3 %.
    assert (np.sqrt(np.square(errors).mean(0)) < 0.03).all()


def test_load_and_moments_are_kept_and_friction_bounds_the_shear(store):
    footprint_set = FootprintSet.from_store(store)
    x, y = np.meshgrid(X, Y)
    for load, pressure, slip in ((20e3, 6e5, -0.03), (31.3e3, 7.7e5, -0.012), (40e3, 10e5, 0.02)):
        footprint = tl.Footprint.interpolate(footprint_set, load=load, pressure=pressure, slip=slip)
        made = footprint.load.array
        assert footprint.normal_load == pytest.approx(load, rel=1e-12)
        assert made[0].min() >= 0
        assert (np.hypot(made[1], made[2]) <= MU * made[0] * (1 + 1e-12)).all()
        # Moments and forces are linear in the fields, and so those that the raw interpolation has.
        at = footprint_set._scaled(np.array([load, pressure, slip]))
        raw = np.zeros_like(made)
        raw[0][footprint_set._loaded] = footprint_set._pressure(at)
        raw[1:, footprint_set._loaded] = footprint_set._shear(at).reshape(2, -1)
        raw *= load / (raw[0].sum() * CELL)
        for weight in (x, y):
            assert (weight * made[0]).sum() * CELL == pytest.approx((weight * raw[0]).sum() * CELL, abs=1e-7 * load)
        assert made[1].sum() * CELL == pytest.approx(raw[1].sum() * CELL, abs=1e-4 * load)
        assert (x * made[2] - y * made[1]).sum() * CELL == pytest.approx(
            (x * raw[2] - y * raw[1]).sum() * CELL, abs=1e-5 * load
        )


def test_at_a_case_it_is_the_case(store):
    row = rows(60)[20]
    load, pressure, slip = row.values()
    made = tl.Footprint.interpolate(store, load=load, pressure=pressure, slip=slip).load.array
    solved = stress(load, pressure, slip)
    # But for the modes that are left out, 0.03 % of the variance in amplitude.
    assert made[0] == pytest.approx(solved["pressure"], abs=0.01 * solved["pressure"].max())


def test_it_states_its_error_and_takes_milliseconds(store, tmp_path):
    footprint = tl.Footprint.interpolate(store, load="30 kN", pressure="8 bar", slip=0.0)
    data = footprint.dataset
    assert 0 < float(data.pressure_error) <= float(data.largest_pressure_error) < 0.2
    assert data.traction_x_error.attrs["units"] == "1"
    assert "interpolated between 68 cases" in footprint.source
    assert "when left out" in footprint.summary()
    best = min(_seconds(store, slip) for slip in np.linspace(-0.02, 0.01, 9))
    # The bound of the stress set, 10 ms, in processor time.
    assert best < 0.01
    tl.save_results(footprint, tmp_path / "f.nc")
    assert tl.open_results(tmp_path / "f.nc").contact.dataset.attrs["tire"].startswith("interpolated footprint")


def _seconds(store, slip):
    began = time.process_time()
    tl.Footprint.interpolate(store, load=30e3, pressure=8e5, slip=float(slip))
    return time.process_time() - began


def test_it_loads_a_road(store):
    footprint = tl.Footprint.interpolate(store, load=30e3, pressure=8e5, slip=-0.01)
    road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    response = tl.solve_response(footprint.load, road, depths=[0.05])
    assert float(response.dataset.stress_zz.min()) < -1e5


@pytest.mark.parametrize(
    ("inputs", "message"),
    [
        ({"load": 45e3}, r"load = 45000 N lies above the highest of the set, 40000 N .*solve this case"),
        ({"load": "19 kN"}, r"load = 19000 N lies below the lowest of the set, 20000 N"),
        ({"pressure": "11 bar"}, r"pressure = 1.1e\+06 Pa lies above the highest of the set, 1e\+06 Pa"),
        ({"slip": -0.05}, r"slip = -0.05 lies below the lowest of the set, -0.03"),
        ({"slip": None}, r"give slip: the set varies rolling.creepage_x from -0.03 to 0.02"),
        ({"load": "30 bar"}, r"30 bar"),
    ],
)
def test_a_point_outside_of_the_range_names_the_bound(store, inputs, message):
    with pytest.raises(InputError, match=message):
        tl.Footprint.interpolate(store, **{"load": 30e3, "pressure": 8e5, "slip": 0.0, **inputs})


def test_failed_cases_are_left_out_and_named(tmp_path):
    def some(normal_load, **inputs):
        return f"gross sliding at {normal_load:g} N" if normal_load > 39e3 else stress(normal_load, **inputs)

    path = tmp_path / "failing.zarr"
    design = listed(CASE, rows(60))
    stored(path, design, some, CASE)
    bad = [k for k, row in enumerate(rows(60)) if row[KEYS[0]] > 39e3]
    footprint = tl.Footprint.interpolate(path, load=30e3, pressure=8e5, slip=0.0)
    (warning,) = footprint.warnings
    assert f"{len(bad)} of 68 cases" in warning
    assert f"case {bad[0]}: gross sliding at 40000 N" in warning
    with pytest.raises(InputError, match=r"above the highest of the set, 38\d\d\d"):
        tl.Footprint.interpolate(path, load=39.5e3, pressure=8e5, slip=0.0)
    # They are kept in the store, with their status.
    assert int((xr.open_zarr(path).status == 2).sum()) == len(bad)


def test_a_half_written_store_is_rejected(store, tmp_path):
    path = tmp_path / "half.zarr"
    design = listed(CASE, rows(60))
    with begun(path, CASE, design, question(CASE)) as keeping:
        for record in itertools.islice(records_of(design, stress), 30):
            keeping.append(record)
    with pytest.raises(InputError, match=r"half-written: 38 of its 68 cases are not solved yet; the same tl\.sweep"):
        FootprintSet.from_store(path)
    # Stopped between the numbers and the fields.
    shutil.copytree(store, tmp_path / "bare.zarr")
    for name in FIELDS:
        shutil.rmtree(tmp_path / "bare.zarr" / name)
    zarr.consolidate_metadata(tmp_path / "bare.zarr", zarr_format=2)
    with pytest.raises(InputError, match=r"has no pressure, traction_x, traction_y.*fields="):
        FootprintSet.from_store(tmp_path / "bare.zarr")
    shutil.copytree(store, tmp_path / "torn.zarr")
    group = zarr.open_group(tmp_path / "torn.zarr", mode="a", zarr_format=2)
    group["pressure"][3:5] = np.nan
    with pytest.raises(InputError, match=r"half-written: 2 of its 68 solved cases have no fields"):
        FootprintSet.from_store(tmp_path / "torn.zarr")


def test_a_store_of_another_version_is_rejected_unless_it_is_accepted(store, tmp_path):
    path = changed(store, tmp_path / "old.zarr", treadload_version="0.0.7")
    with pytest.raises(InputError, match=r'solved by treadload 0\.0\.7.*accept it by version="0\.0\.7"'):
        tl.Footprint.interpolate(path, load=30e3, pressure=8e5, slip=0.0)
    assert tl.Footprint.interpolate(path, load=30e3, pressure=8e5, slip=0.0, version="0.0.7").normal_load > 0
    with pytest.raises(InputError, match=r"the version given is 9\.9"):
        FootprintSet.from_store(store, version="9.9")


def test_what_is_no_set_is_rejected(store, tmp_path):
    with pytest.raises(InputError, match=r"cannot be read as a Zarr store"):
        FootprintSet.from_store(tmp_path / "nothing.zarr")
    with pytest.raises(InputError, match=r"is not a study of treadload"):
        FootprintSet.from_store(xr.Dataset({"pressure": ("x", [1.0])}))
    data = xr.open_zarr(store).load()
    case = data.attrs["case"].replace("friction = 0.7", 'friction = { law = "exponential" }')
    with pytest.raises(InputError, match=r"bounded by one coefficient"):
        FootprintSet.from_store(data.assign_attrs(case=case))
    few = [{**row, "rolling.friction": 0.5 + 0.01 * k} for k, row in enumerate(rows(20))]
    stored(tmp_path / "friction.zarr", listed(CASE, few), stress, CASE)
    with pytest.raises(InputError, match=r"varies rolling\.friction, and an interpolation is over"):
        FootprintSet.from_store(tmp_path / "friction.zarr")
    stored(tmp_path / "few.zarr", listed(CASE, rows(2)), stress, CASE)
    with pytest.raises(InputError, match=r"over 3 inputs needs 16 solved cases or more, got 10"):
        FootprintSet.from_store(tmp_path / "few.zarr")
    design = json.loads(data.attrs["design"])
    twice = data.assign({KEYS[k]: ("case", np.where(np.arange(68) == 9, data[KEYS[k]][8], data[KEYS[k]]))
                         for k in range(3)})  # fmt: skip
    assert design["sizes"] == {"case": 68}
    with pytest.raises(InputError, match=r"two cases of the study have the same inputs"):
        FootprintSet.from_store(twice)


def test_a_study_of_load_alone_and_of_every_combination(tmp_path):
    loads = [{"rolling.normal_load": load} for load in np.linspace(20e3, 40e3, 9)]
    stored(tmp_path / "loads.zarr", listed(CASE, loads), stress, CASE)
    alone = FootprintSet.from_store(tmp_path / "loads.zarr")
    assert dict(alone.ranges) == {"load": (20e3, 40e3)}
    assert alone.at(load="31 kN", pressure="8.2 bar").normal_load == pytest.approx(31e3, rel=1e-12)
    with pytest.raises(InputError, match=r"pressure = 700000 Pa is not in the set, which has 820000 Pa alone"):
        alone.at(load="31 kN", pressure="7 bar")
    grid = {"rolling.normal_load": [20e3, 27e3, 33e3, 40e3], "rolling.creepage_x": [-0.02, -0.01, 0.0, 0.01]}
    stored(tmp_path / "grid.zarr", product(CASE, grid), stress, CASE)
    both = tl.Footprint.interpolate(tl.sweeps.open_sweep(tmp_path / "grid.zarr"), load=30e3, slip=-0.005)
    assert both.load.tractive_force == pytest.approx(-stress(30e3, 8e5, -0.005)["traction_x"].sum() * CELL, rel=0.05)


@pytest.mark.slow
def test_a_solved_set_meets_its_bound(tmp_path):
    """72 solved cases of a half-space tire; 12 others, drawn beforehand, are held back."""
    corners = np.array(list(itertools.product((0.0, 1.0), repeat=3)))
    held, inside = np.split(np.random.default_rng(3).random((76, 3)), [12])
    points = LOW + np.concatenate([corners, inside]) * (HIGH - LOW)
    design = tl.sweeps.over_points(CASE, list(KEYS), points)
    study = tl.sweep(CASE, design, fields=FIELDS, store=tmp_path / "solved.zarr")
    assert study.stats["solved"] == 72
    errors = []
    for load, pressure, slip in (LOW + held * (HIGH - LOW)).tolist():
        made = tl.Footprint.interpolate(study.path, load=load, pressure=pressure, slip=slip).dataset
        rolling = tl.Rolling(normal_load=load, friction=MU, creepage_x=slip)
        tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=pressure)
        solved = tl.solve_contact(tire, CASE.road(), rolling, spacing=0.012).dataset
        solved = solved.reindex(x=made.x, y=made.y, method="nearest", tolerance=1e-6, fill_value=0.0)
        inside = (made.pressure > 0) | (solved.pressure > 0)
        mean = float(solved.pressure.where(solved.pressure > 0).mean())
        errors.append([float(((made[f] - solved[f]) ** 2).where(inside).mean()) ** 0.5 / mean for f in FIELDS])
    # The bound of the stress set, rms; 200 cases in place of 72 and ribs on a belt reach half of it.
    assert (np.sqrt(np.square(errors).mean(0)) < 0.03).all()
