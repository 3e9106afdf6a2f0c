"""Results as tables: what a spreadsheet opens is what the name of the file says."""

import csv
import json
import sys

import numpy as np
import pytest
import xarray as xr

import treadload as tl
from treadload.results import exports
from treadload.variables import dataset


def rows_of(path):
    with path.open(encoding="utf-8", newline="") as stream:
        return list(csv.reader(stream))


def column(rows, heading):
    number = rows[0].index(heading)
    return [row[number] for row in rows[1:]]


def test_a_case_becomes_a_table_for_each_group(coarse_result, tmp_path):
    files = tl.results.write_csv(coarse_result, tmp_path / "r.csv")
    names = [path.name for path in files]
    assert names[:2] == ["r_contact.csv", "r_contact_scalars.csv"]
    assert {"r_response.csv", "r_slice_along.csv", "r_damage.csv", "r_about.csv"} <= set(names)
    # Nothing else is there, and not the bare name, which none of them is.
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(names)
    data = coarse_result.response.dataset
    rows = rows_of(tmp_path / "r_response.csv")
    assert rows[0][:3] == ["depth [m]", "y [m]", "x [m]"]
    for name, unit in (("stress_zz", "Pa"), ("principal_strain_1", "1")):
        # repr of a float is read back to the last bit.
        found = np.array([float(value) for value in column(rows, f"{name} [{unit}]")])
        np.testing.assert_array_equal(found, data[name].to_numpy().ravel())
    depth, y, x = np.meshgrid(data.depth, data.y, data.x, indexing="ij")
    for heading, values in zip(rows[0], (depth, y, x), strict=False):
        np.testing.assert_array_equal([float(value) for value in column(rows, heading)], values.ravel())
    # A direction is three columns.
    sideways = data.principal_direction_1.sel(component="y").to_numpy().ravel()
    told = [float(value or "nan") for value in column(rows, "principal_direction_1_y [1]")]
    np.testing.assert_array_equal(told, sideways)


def test_scalars_say_what_they_are(coarse_result, tmp_path):
    files = tl.results.write_csv(coarse_result.contact, tmp_path / "c.csv")
    assert [path.name for path in files] == ["c.csv", "c_scalars.csv"]
    rows = {row[0]: row for row in rows_of(files[1])}
    assert rows["quantity"] == ["quantity", "value", "unit", "meaning"]
    assert float(rows["tractive_force"][1]) == float(coarse_result.contact.dataset.tractive_force)
    assert rows["tractive_force"][2:] == ["N", "force of the road on the tire along travel, positive when driving"]


def test_the_about_table_holds_the_case_and_what_was_warned(coarse_result, tmp_path):
    tree = coarse_result.to_tree()
    tree["contact"].attrs["warnings"] = json.dumps(["mind the gap"])
    tl.results.write_csv(tree, tmp_path / "r.csv")
    about = {tuple(row[:2]): row[2] for row in rows_of(tmp_path / "r_about.csv")}
    assert about["", "case"] == coarse_result.case.to_toml()
    assert json.loads(about["contact", "warnings"]) == ["mind the gap"]


def test_points_and_fields_without_coordinates_are_rows(tmp_path):
    at = [(0.0, 0.0), (0.1, 0.2)]
    road = tl.Pavement.half_space(tl.Elastic(5e9, 0.35))
    response = tl.solve_response(tl.UniformDisc(0.1, 7e5), road, depths=[0.05, 0.1], points=at)
    rows = rows_of(tl.results.write_csv(response, tmp_path / "p.csv")[0])
    assert rows[0][:2] == ["depth [m]", "point"]
    assert {"x [m]", "y [m]"} <= set(rows[0])
    assert len(rows) == 1 + 4
    assert [float(value) for value in column(rows, "x [m]")] == [0.0, 0.1, 0.0, 0.1]


def test_a_workbook_holds_the_same_numbers(coarse_result, tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    path = tl.results.write_excel(coarse_result, tmp_path / "r.xlsx")
    book = openpyxl.load_workbook(path)
    assert book.sheetnames[:2] == ["contact", "contact_scalars"]
    assert book.sheetnames[-1] == "about"
    rows = list(book["contact"].values)
    assert rows[0][:2] == ("y [m]", "x [m]")
    data = coarse_result.contact.dataset
    pressure = rows[0].index("pressure [Pa]")
    # A workbook keeps sixteen digits.
    np.testing.assert_allclose([row[pressure] for row in rows[1:]], data.pressure.to_numpy().ravel(), rtol=1e-15)
    assert book["contact"].freeze_panes == "A2"


def test_what_a_sheet_cannot_hold_is_kept_as_text(tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    data = xr.Dataset(
        {"value": ("name", [1.5, np.nan, np.inf]), "note": ("name", ["=1+1", "a\x07b", "x" * 70_000])},
        {"name": ["a", "b", "c"]},
    )
    sheet = openpyxl.load_workbook(tl.results.write_excel(data, tmp_path / "odd.xlsx")).active
    rows = list(sheet.values)
    assert rows[1] == ("a", 1.5, "=1+1")
    assert sheet["C2"].data_type == "s"
    assert rows[2] == ("b", None, "a b")
    assert "".join(row[2] for row in rows[3:]) == "x" * 70_000
    assert rows[3][1] == "inf"


def test_a_life_is_told_by_criterion(tmp_path):
    fields = {
        "life_years": (("criterion",), [12.5, 30.0]),
        "worst_y": (("criterion",), [0.0, 0.1]),
        "damage_per_year": (("criterion", "y"), np.arange(6.0).reshape(2, 3)),
    }
    data = dataset(fields, {"criterion": ["base", "soil"], "y": [0.0, 0.1, 0.2]})
    files = tl.results.write_csv(xr.DataTree.from_dict({"/life": data}), tmp_path / "life.csv")
    assert [path.name for path in files] == ["life.csv", "life_criterion_y.csv", "life_about.csv"]
    assert rows_of(files[0])[1][:2] == ["base", "12.5"]
    assert rows_of(files[1])[4] == ["soil", "0.0", "3.0"]


def test_all_files_or_none(coarse_result, tmp_path):
    (tmp_path / "r_about.csv").mkdir()
    with pytest.raises(tl.InputError, match="is a folder"):
        tl.results.write_csv(coarse_result, tmp_path / "r.csv")
    assert [path.name for path in tmp_path.iterdir()] == ["r_about.csv"]


@pytest.mark.parametrize("write", [tl.save_results, tl.results.write_csv, tl.results.write_excel, exports.write])
@pytest.mark.parametrize("name", ["r.pdf", "r.json", "r", "r.txt"])
def test_other_suffixes_are_refused_with_those_known(write, name, coarse_result, tmp_path):
    with pytest.raises(tl.InputError, match=r"use \..*\("):
        write(coarse_result.contact.dataset, tmp_path / name)
    assert not list(tmp_path.iterdir())


def test_netcdf_is_not_written_under_another_name(coarse_result, tmp_path):
    with pytest.raises(tl.InputError, match=r"suffix \.csv is not known, use \.nc or \.nc4 or \.h5 \(NetCDF\)"):
        tl.save_results(coarse_result.to_tree(), tmp_path / "r.csv")


def test_a_workbook_without_openpyxl_is_refused_with_what_to_run(monkeypatch, coarse_result, tmp_path):
    monkeypatch.setitem(sys.modules, "openpyxl", None)
    with pytest.raises(tl.InputError, match=r"pip install '\.\[excel\]'"):
        exports.check_output(tmp_path / "r.xlsx")
    with pytest.raises(tl.InputError, match="openpyxl"):
        tl.results.write_excel(coarse_result.contact, tmp_path / "r.xlsx")


def test_a_table_longer_than_a_sheet_is_refused(monkeypatch, coarse_result, tmp_path):
    monkeypatch.setattr(exports, "_MOST_ROWS", 100)
    with pytest.raises(tl.InputError, match="holds 100"):
        tl.results.write_excel(coarse_result.contact, tmp_path / "r.xlsx")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("nothing", [xr.Dataset(), xr.DataTree(), 3.0])
def test_nothing_is_no_table(nothing, tmp_path):
    with pytest.raises(tl.InputError, match=r"nothing to write|made of results"):
        tl.results.write_csv(nothing, tmp_path / "r.csv")
