"""Broken results are refused in one sentence that names the group and what of it is wrong."""

import gc
import json
import sys

import h5py
import numpy as np
import pytest
import xarray as xr

import treadload as tl
from treadload.reporting import write_report
from treadload.results import open_results, save_results
from treadload.results.schema import check_tree


@pytest.fixture(scope="module")
def tree(coarse_result):
    return coarse_result.to_tree()


def with_group(tree, name, data):
    groups = {f"/{key}": node.to_dataset() for key, node in tree.children.items()}
    return xr.DataTree.from_dict({"/": xr.Dataset(attrs=tree.attrs), **groups, f"/{name}": data})


def refusal(tree, tmp_path):
    """What a report says, which is what the file of the same says."""
    with pytest.raises(tl.InputError) as caught:
        write_report({"odd": tree}, tmp_path / "report.html")
    said = str(caught.value)
    assert len(said.splitlines()) == 1
    assert not (tmp_path / "report.html").exists()
    return said


def unrolled(data):
    """A contact without slip and creepages over a speed."""
    return data.assign({name: data[name] * np.nan for name in ("slip_x", "slip_y", "creepage_x", "creepage_y")})


def standing(data):
    """A contact at the end of a turn, which has slip distances."""
    return unrolled(data).assign(slip_distance_x=data.slip_x, slip_distance_y=data.slip_y)


def test_results_as_they_are_pass(tree):
    check_tree(tree, "result")


def test_a_wheel_that_stood_has_no_slip_over_a_speed(tree):
    check_tree(with_group(tree, "contact", standing(tree["contact"].to_dataset())), "result")


BREAKS = {
    "without pressure": ("contact", lambda d: d.drop_vars("pressure"), "lacks 'pressure'"),
    "in kPa": (
        "contact",
        lambda d: d.assign(pressure=d.pressure.assign_attrs(units="kPa")),
        "pressure is in kPa, results are in Pa",
    ),
    "of words": ("contact", lambda d: d.assign(pressure=d.pressure.astype(str)), "not numbers"),
    "of an infinite pressure": ("contact", lambda d: d.assign(pressure=d.pressure * np.inf), "NaN or infinite"),
    "of one row": ("contact", lambda d: d.assign(pressure=d.pressure.isel(y=0)), "pressure is over x, not x, y"),
    "empty": ("contact", lambda d: d.isel(x=slice(0, 0)), "it has no x"),
    "backwards": ("contact", lambda d: d.isel(x=slice(None, None, -1)), "x does not increase"),
    "over the road": (
        "response",
        lambda d: d.assign_coords(depth=d["depth"] - 1.0),
        "depth is -1 m, above the road; depth counts downwards",
    ),
    "with three sides of an interface": (
        "slice_along",
        lambda d: d.assign_coords(depth=np.concatenate([[0.0] * 3, d["depth"].to_numpy()[3:]])),
        "depth 0 m is there more than twice",
    ),
    "nowhere": ("contact", lambda d: d.drop_vars("x"), "does not state where"),
    "of a fourth state": ("contact", lambda d: d.assign(state=d.state + 3), "values other than 0 to 2"),
    "with a force of NaN": (
        "contact",
        lambda d: d.assign(normal_load=d.normal_load * np.nan),
        "normal_load has 1 of 1",
    ),
    "with a slip of NaN": (
        "contact",
        lambda d: d.assign(slip_x=d.slip_x * np.nan),
        "slip_x has 783 of 783 values that are NaN or infinite; only a wheel that turned",
    ),
    "with a creepage of NaN": (
        "contact",
        lambda d: d.assign(creepage_y=d.creepage_y * np.nan),
        "creepage_y has 1 of 1",
    ),
    "rolling nowhere": ("contact", lambda d: unrolled(d), "slip_x has"),
    "with a hole in the slip of a turn": (
        "contact",
        lambda d: standing(d).assign(slip_x=d.slip_x),
        "slip_y has",
    ),
    "with an infinite slip": ("contact", lambda d: d.assign(slip_x=d.slip_x + np.inf), "slip_x has"),
    "without directions": (
        "response",
        lambda d: d.drop_vars("principal_direction_1"),
        "lacks 'principal_direction_1'",
    ),
    "of a plane": ("response", lambda d: d.isel(component=slice(0, 2)), "2 components"),
    "without a worst point": ("damage", lambda d: d.drop_vars("worst_strain"), "lacks 'worst_strain'"),
    "with words for ε₆": ("damage", lambda d: d.assign_attrs(epsilon_6="a"), "epsilon_6 must be a finite number"),
    "with a layer over the plane": (
        "response",
        lambda d: d.assign_coords(layer=(("y", "x"), np.zeros((d.sizes["y"], d.sizes["x"])))),
        "layer is over x, y, not depth",
    ),
    "with half a layer": (
        "response",
        lambda d: d.assign_coords(layer=("depth", d["depth"].to_numpy() + 0.5)),
        "layer has values other",
    ),
    "with cells of no size": ("contact", lambda d: d.assign_attrs(dx=0.0), "attribute dx must be above zero, got 0"),
    "with a pressure beyond all": (
        "contact",
        lambda d: d.assign(pressure=(d.pressure.dims, np.full(d.pressure.shape, 1e300))),
        "values beyond 1e+30, which no road and no tire reaches",
    ),
    "with a strain at a million beyond all": (
        "damage",
        lambda d: d.assign_attrs(epsilon_6=1e300),
        "epsilon_6 must be at most 1e+30, got 1e+300",
    ),
    "with passes of zero": ("damage", lambda d: d.assign(worst_passes=0.0), "1 of 1 values that are not above zero"),
    "inside several": ("response", lambda d: d.assign_attrs(part_of=np.array([1.0, 2.0])), "part_of must be text"),
    "with torn names": ("response", lambda d: d.assign_attrs(layer_names="["), "layer_names must be a list as JSON"),
}


@pytest.mark.parametrize("name", BREAKS)
def test_a_broken_group(tree, tmp_path, name):
    group, change, words = BREAKS[name]
    said = refusal(with_group(tree, group, change(tree[group].to_dataset())), tmp_path)
    assert said.startswith(f"odd: the group /{group}")
    assert words in said


@pytest.mark.parametrize(
    ("attrs", "words"),
    [
        ({"layers": json.dumps([{"name": "a"}])}, "layer 1 of the attribute layers has no modulus"),
        ({"layers": "[1]"}, "layer 1"),
        ({"layers": "3"}, "layers must be a list as JSON"),
        ({"case": 3}, "the attribute case must be text"),
        ({"created": np.array(["a", "b"])}, "the attribute created must be text"),
        ({"title": np.zeros(99)}, "the attribute title must be text, got array([0., 0."),
        ({"case": "a = " + "9" * 5000}, "more than 4300 digits"),
    ],
)
def test_a_broken_root(tree, tmp_path, attrs, words):
    odd = tree.copy()
    odd.attrs = {**tree.attrs, **attrs}
    assert words in refusal(odd, tmp_path)


@pytest.mark.parametrize("odd", [np.array([2, 3]), 1.5, "2"])
def test_a_format_that_is_no_whole_number(tree, tmp_path, odd):
    attrs = {**tree.attrs, "results_format": odd}
    wrong = xr.DataTree.from_dict({"/": xr.Dataset(attrs=attrs), "/contact": tree["contact"].to_dataset()})
    with pytest.raises(tl.InputError, match="results_format must be a whole number"):
        open_results(save_results(wrong, tmp_path / "odd.nc"))


@pytest.mark.slow
def test_passes_beyond_all_that_is_drawn_leave_a_sentence(tree, tmp_path):
    far = tree["damage"].to_dataset().assign(worst_passes=1e300)
    page = write_report({"odd": with_group(tree, "damage", far)}, tmp_path / "r.html").read_text()
    assert "1e+300 load repetitions lie beyond all that is drawn" in page
    assert "math domain" not in page


def test_the_file_of_a_broken_result_is_refused_too(tree, tmp_path):
    data = tree["contact"].to_dataset().drop_vars("pressure")
    path = save_results(with_group(tree, "contact", data), tmp_path / "odd.nc")
    with pytest.raises(tl.InputError, match=r"odd\.nc: the group /contact lacks 'pressure'"):
        open_results(path)


def test_units_of_a_file_are_no_dates(tree, tmp_path):
    data = tree["contact"].to_dataset()
    data = data.assign(pressure=data["pressure"].assign_attrs(units="days since 2000-01-01"))
    with pytest.raises(tl.InputError, match="pressure is in days since 2000-01-01"):
        open_results(save_results(with_group(tree, "contact", data), tmp_path / "odd.nc"))


def test_a_torn_file_leaves_no_traceback_behind(tree, tmp_path, monkeypatch):
    """h5netcdf printed "Exception ignored in" as Python threw away what it could not open."""
    path = save_results(tree, tmp_path / "torn.nc")
    content = path.read_bytes()
    ignored = []
    monkeypatch.setattr(sys, "unraisablehook", ignored.append)
    for kept in (0, 100, len(content) // 2):
        path.write_bytes(content[:kept])
        with pytest.raises(tl.InputError) as caught:
            open_results(path)
        assert len(str(caught.value).splitlines()) == 1
    gc.collect()
    assert not ignored


def test_a_variable_that_lost_its_dimensions(tree, tmp_path, monkeypatch):
    """The reader of torn files lets it through; what puts its group together does not."""
    path = save_results(tree, tmp_path / "torn.nc")
    lost = tree.copy()
    lost["contact"].variables["pressure"]._dims = ()
    monkeypatch.setattr(xr.DataTree, "from_dict", lambda groups: lost)
    with pytest.raises(tl.InputError, match=r"cannot read .*torn\.nc") as caught:
        open_results(path)
    assert len(str(caught.value).splitlines()) == 1


@pytest.mark.filterwarnings("default")
def test_a_variable_over_the_same_dimension_twice(tree, tmp_path):
    path = save_results(tree, tmp_path / "twice.nc")
    with h5py.File(path, "r+") as file:
        group = file["contact"]
        values = group["pressure"][:]
        del group["pressure"]
        square = group.create_dataset("pressure", data=np.resize(values, (group["x"].size, group["x"].size)))
        for dim in square.dims:
            dim.attach_scale(group["x"])
    with pytest.raises(tl.InputError, match=r"twice\.nc .* has the same dimension twice; give the second") as caught:
        open_results(path)
    assert len(str(caught.value).splitlines()) == 1
