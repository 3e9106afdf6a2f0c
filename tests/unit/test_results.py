import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import treadload as tl
from treadload.case import Case
from treadload.results import height_map, open_results, save_results


def test_a_tree_survives_the_disk(coarse_result, tmp_path):
    tree = coarse_result.to_tree()
    save_results(tree, tmp_path / "r.nc")
    back = open_results(tmp_path / "r.nc").tree
    assert set(back.children) == {"contact", "response", "slice_along", "slice_across", "damage", "asked"}
    for name, group in tree.children.items():
        xr.testing.assert_identical(back[name].to_dataset(), group.to_dataset())
    assert [p.name for p in tmp_path.iterdir()] == ["r.nc"]


def test_provenance_tells_the_whole_question(coarse_result):
    attrs = coarse_result.to_tree().attrs
    assert Case.from_text(attrs["case"]) == coarse_result.case
    assert attrs["treadload_version"] == tl.__version__
    assert attrs["title"] == "coarse"
    cited = " ".join(json.loads(attrs["citations"]))
    for author in ("Kalker", "Love", "Polonsky", "Vollebregt", "Johnson"):
        assert author in cited


def test_every_variable_has_units_and_a_long_name(coarse_result):
    tree = coarse_result.to_tree()
    for group in (node for name, node in tree.children.items() if name != "asked"):
        for name, variable in group.to_dataset().variables.items():
            if name != "component":
                assert variable.attrs["units"], name
                assert variable.attrs["long_name"], name


def test_other_files_are_no_results(tmp_path):
    with pytest.raises(tl.InputError, match="there is no result file"):
        open_results(tmp_path / "no.nc")
    (tmp_path / "text.nc").write_text("no")
    with pytest.raises(tl.InputError, match="cannot read"):
        open_results(tmp_path / "text.nc")
    xr.Dataset({"a": 1}).to_netcdf(tmp_path / "other.nc", engine="h5netcdf")
    with pytest.raises(tl.InputError, match="not a result of treadload"):
        open_results(tmp_path / "other.nc")


def test_a_saved_height_map_makes_the_same_tire(tmp_path):
    tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
    data = height_map(tire, 0.01)
    save_results(data, tmp_path / "tread.nc")
    again = tl.Tire.from_height_map(tmp_path / "tread.nc", inflation_pressure=820e3)
    assert again.fixed_grid.dx == pytest.approx(0.01)
    # Coordinates pass through text-free binary; only the shift of the minimum to zero may round.
    np.testing.assert_allclose(
        again.height_map(again.fixed_grid), data.initial_gap - data.initial_gap.min(), atol=1e-12
    )


def test_csv_has_a_row_a_cell_and_units_in_its_heading(coarse_result, tmp_path):
    data = coarse_result.contact.dataset
    tl.results.write_csv(data, tmp_path / "c.csv")
    heading, *rows = (tmp_path / "c.csv").read_text().splitlines()
    assert "pressure [Pa]" in heading
    assert len(rows) == data.pressure.size


def test_slices_pass_through_the_worst_point(coarse_result):
    worst = coarse_result.verdict.dataset
    assert coarse_result.slice_along.dataset.y.item() == pytest.approx(float(worst.worst_y), abs=1e-12)
    assert coarse_result.slice_across.dataset.x.item() == pytest.approx(float(worst.worst_x), abs=1e-12)


def test_citations_follow_what_was_used(coarse_result):
    from dataclasses import replace

    from treadload.citations import references
    from treadload.contact.friction import Exponential

    plain = " ".join(references(coarse_result.contact.cites()))
    assert "Anderson" in plain
    assert "slip-velocity" not in plain
    contact = coarse_result.contact
    law = Exponential(static=0.9, kinetic=0.6, reference_speed=2.0)
    falling = replace(contact, rolling=replace(contact.rolling, friction=law, speed=20.0))
    assert "slip-velocity" in " ".join(references(falling.cites()))


def test_a_package_cites_whole_references_and_a_case_what_its_steps_use():
    from treadload.citations import CITATIONS, references

    whole = "Doe, J. (2020). Roads. J. Roads 1, 1-2."
    assert references((whole, "layers", whole)) == [CITATIONS["chain"], whole, CITATIONS["layers"]]
    cited = tl.Case.from_toml(Path(__file__).parents[2] / "examples/rutting/rutting.toml").cites()
    assert {"passes", "eigenstrain", "newton"} <= set(cited)


def test_files_follow_cf(coarse_result, tmp_path):
    """CF-1.11, 2.5.1 and 2.6: no missing values of coordinates, flags of the same type, history.

    compliance-checker 6.1 with cf:1.11 --criteria=strict finds no error in such a file, nor in any of its groups.
    """
    import h5py

    with h5py.File(tl.save_results(coarse_result.to_tree(), tmp_path / "r.nc")) as file:
        assert file.attrs["Conventions"] == "CF-1.11"
        assert "treadload" in file.attrs["history"]
        state = file["contact/state"]
        assert state.attrs["flag_values"].dtype == state.dtype
        assert (state.attrs["flag_values"].tolist(), state.attrs["flag_meanings"]) == ([0, 1, 2], "open stick slip")
        for axis in ("contact/x", "contact/y", "response/depth"):
            assert "_FillValue" not in file[axis].attrs
        assert file["response/depth"].attrs["positive"] == "down"
    # A dataset alone is a file by convention, too, and its own history is kept.
    data = coarse_result.contact.dataset.assign_attrs(history="measured")
    with h5py.File(tl.save_results(data, tmp_path / "d.nc")) as file:
        assert (file.attrs["Conventions"], file.attrs["history"]) == ("CF-1.11", "measured")
