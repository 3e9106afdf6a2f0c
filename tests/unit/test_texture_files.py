"""Textures from files."""

import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from crg import GRID, KINDS, crg
from treadload.errors import InputError
from treadload.pavement import texture as tx

DATA = Path(__file__).parents[1] / "data" / "texture"
PLACES = np.array(
    [(2.0, 0), (2.3, 0.1), (3.9, -0.7), (4.0, 0.75), (3.25, 0.4), (1.4, 0.1), (4.6, -0.2), (2.7, 1.2), (3.3, -1.9),
     (5.9, 1.7)]
).T  # fmt: skip
# z at these places of this file by OpenCRG's own C library, release 1.2 of asam-ev/OpenCRG, crgEvaluv2z with the
# border modes given and GRID_NAN_MODE 0, rounded to 1e-7 m.
BY_OPENCRG = {
    (2, 2): [0.025, 0.0572, 0.1038, 0.07, 0.108, 0.029, 0.095, 0.1005, 0.1015, 0.07],
    (1, 2): [0.025, 0.0572, 0.1038, 0.07, 0.108, 0.0, 0.0, 0.1005, 0.1015, 0.0],
    (2, 1): [0.025, 0.0572, 0.1038, 0.07, 0.108, 0.029, 0.095, 0.0, 0.0, 0.06],
    (3, 3): [0.025, 0.0572, 0.1038, 0.07, 0.108, 0.0954, 0.0582, 0.0724, 0.1008, 0.0624],
    (4, 4): [0.025, 0.0572, 0.1038, 0.07, 0.108, 0.0834, 0.0942, 0.0996, 0.1052, 0.0222],
}


def written(folder, name, content):
    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("modes", BY_OPENCRG)
def test_opencrg_is_evaluated_as_by_its_own_library(tmp_path, kind, modes):
    options = "$ROAD_CRG_OPTS\nBORDER_MODE_U = {}\nBORDER_MODE_V = {}\n$\n".format(*modes)
    road = tx.read_crg(written(tmp_path, "road.crg", crg(kind, options)))
    # Seven digits were written; single precision holds them.
    np.testing.assert_allclose(road.z(*PLACES), BY_OPENCRG[modes], atol=1.1e-7)


def test_opencrg_beyond_its_borders_may_be_nothing(tmp_path):
    options = "$ROAD_CRG_OPTS\nBORDER_MODE_U = 0\nBORDER_MODE_V = 0\n$\n"
    z = tx.read_crg(written(tmp_path, "road.crg", crg("KDBI", options))).z(*PLACES)
    assert np.isnan(z[5:]).all()
    assert np.isfinite(z[:5]).all()


@pytest.mark.parametrize("kind", KINDS)
def test_opencrg_as_a_texture_lies_to_the_right(tmp_path, kind):
    grid = GRID.copy()
    grid[1, 0] = np.nan
    one = tx.read_texture(written(tmp_path, "road.crg", crg(kind, grid=grid)))
    np.testing.assert_allclose(one.heights, grid[:, ::-1].T, atol=1e-7)
    assert (one.dx, one.dy) == (0.5, 0.5)


def test_opencrg_sections_of_their_own_places(tmp_path):
    text = crg("LRFI").decode()
    for number, place in enumerate((-0.75, -0.25, 0.3, 0.75), start=1):
        text = text.replace(f"D:long section {number},m", f"D:long section at v = {place},m")
    road = tx.read_crg(written(tmp_path, "road.crg", text))
    np.testing.assert_allclose(road.v, [-0.75, -0.25, 0.3, 0.75])
    with pytest.raises(InputError, match=r"0\.45 to 0.55 m apart across"):
        road.texture()


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("$CT", "$XX", "does not begin with \\$CT"),
        ("$" * 79, "", "no line of \\$\\$\\$\\$"),
        ("INCREMENT = 0.5\n", "INCREMENT = x\n", "expected NAME = number"),
        ("REFERENCE_LINE_INCREMENT = 0.5", "", "needs REFERENCE_LINE_INCREMENT"),
        ("REFERENCE_LINE_END_U = 4.0", "REFERENCE_LINE_END_U = 9.0", "rows are missing or too many"),
        ("LONG_SECTION_V_INCREMENT = 0.5", "LONG_SECTION_V_INCREMENT = 0.1", "do not reach from"),
        ("LONG_SECTION_V_LEFT = 0.75", "LONG_SECTION_V_LEFT = -2", "does not state where"),
        ("#:LRFI", "#:LRBI", "the format 'LRBI'; known are"),
        ("D:long section 4,m", "D:long section 4,feet", "must be in m"),
        ("D:long section 4,m", "D:temperature,m", "is none of OpenCRG's"),
        ("D:long section 4,m\n", "", "more than its 6 channels"),
        ("0.0500000", "0.05x0000", "is no number"),
        ("$KD_", "$ROAD_CRG_MODS\nSCALE_Z_GRID = 2\n$\n$KD_", "changes its data by SCALE_Z_GRID"),
        ("$KD_", "$ROAD_CRG_FILE\nother.crg\n$\n$KD_", "refers to other files"),
        ("$KD_", "$ROAD_CRG_OPTS\nBORDER_MODE_U = 7\n$\n$KD_", "must be 0, 1, 2, 3 or 4"),
        ("$KD_", "$ROAD_CRG_OPTS\nBORDER_SMOOTH_UBEG = 1\n$\n$KD_", "smooths its borders"),
    ],
)
def test_opencrg_that_lies_is_refused(tmp_path, old, new, told):
    text = crg("LRFI").decode()
    assert old in text
    with pytest.raises(InputError, match=told):
        tx.read_crg(written(tmp_path, "road.crg", text.replace(old, new)))


def test_opencrg_cut_off_is_refused(tmp_path):
    for kind, told in (("KRBI", "whole number of records"), ("LDFI", "has 4 of 7 channels; it was cut off")):
        data = crg(kind)
        data = data[:-7] if kind == "KRBI" else data[: data.rstrip().rfind(b"\n") + 1]
        with pytest.raises(InputError, match=told):
            tx.read_crg(written(tmp_path, "road.crg", data))


def test_laser_profile_as_it_was_measured():
    one = tx.read_texture(DATA / "aylesbury_station_0_cut.dat")
    assert one.is_profile
    assert one.dx == pytest.approx(37.5e-6, rel=2e-3)
    assert one.length == pytest.approx(0.2, rel=1e-3)
    # About 9 % drop-outs, as its SOURCE.md says of the whole.
    assert 0.02 < one.dropouts / one.heights.size < 0.2
    assert -20e-3 < np.nanmin(one.heights) < np.nanmax(one.heights) < 20e-3


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda lines: [*lines[:14], "x\ty\tz", *lines[15:]], "expected number, distance and height in mm"),
        (lambda lines: [*lines[:14], *lines[400:]], "do not rise in even steps"),
        (lambda lines: lines[:11], "has 0 points below"),
        (
            lambda lines: [line.replace("*****DATA*****", "x*****DATA*****") for line in lines],
            "not on a line of its own",
        ),
    ],
)
def test_laser_profile_that_lies_is_refused(tmp_path, change, told):
    lines = (DATA / "aylesbury_station_0_cut.dat").read_text().splitlines()
    with pytest.raises(InputError, match=re.escape(told)):
        tx.read_texture(written(tmp_path, "p.dat", "\n".join(change(lines))))


def test_matrices_of_heights(tmp_path):
    heights = np.arange(12.0).reshape(3, 4)
    np.save(tmp_path / "map.npy", heights)
    np.savetxt(tmp_path / "map.csv", heights, delimiter=",")
    np.savetxt(tmp_path / "line.txt", heights[0])
    for name in ("map.npy", "map.csv"):
        one = tx.read_texture(tmp_path / name, spacing=(1e-3, 2e-3), units="mm")
        np.testing.assert_allclose(one.heights, 1e-3 * heights)
        assert (one.dx, one.dy) == (1e-3, 2e-3)
    assert tx.read_texture(tmp_path / "line.txt", spacing=1e-3, units="mm").is_profile
    with pytest.raises(InputError, match="give spacing in m"):
        tx.read_texture(tmp_path / "map.npy")
    with pytest.raises(InputError, match="differ by 11 m"):
        tx.read_texture(tmp_path / "map.npy", spacing=1e-3)


def test_netcdf_in_its_units(tmp_path):
    field = xr.DataArray(
        np.arange(12.0).reshape(3, 4), dims=("y", "x"), attrs={"units": "mm"},
        coords={"y": ("y", [0.0, 2, 4], {"units": "mm"}), "x": ("x", [0.0, 1, 2, 3], {"units": "mm"})},
    )  # fmt: skip
    field.to_dataset(name="height").to_netcdf(tmp_path / "map.nc", engine="h5netcdf")
    one = tx.read_texture(tmp_path / "map.nc")
    np.testing.assert_allclose(one.heights, 1e-3 * field)
    assert (one.dx, one.dy) == pytest.approx((1e-3, 2e-3))
    uneven = field.assign_coords(x=[0.0, 1, 2, 9])
    uneven.to_dataset(name="height").to_netcdf(tmp_path / "bad.nc", engine="h5netcdf")
    with pytest.raises(InputError, match=r"even steps|names no unit|unit"):
        tx.read_texture(tmp_path / "bad.nc")


def test_files_that_are_none(tmp_path):
    with pytest.raises(InputError, match="no file"):
        tx.read_texture(tmp_path / "none.crg")
    with pytest.raises(InputError, match="unknown ending"):
        tx.read_texture(written(tmp_path, "photo.jpg", b"\xff\xd8"))
    with pytest.raises(InputError, match="could not be read as a matrix"):
        tx.read_texture(written(tmp_path, "map.npy", b"not numpy"), spacing=1e-3)
