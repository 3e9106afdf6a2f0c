"""A study on the page: what its sliders show is what its dataset holds, and what is no study is refused."""

import json

import numpy as np
import pytest
import xarray as xr

import treadload as tl
from treadload.app.engine import Engine
from treadload.app.engines import Engines
from treadload.app.form import Form
from treadload.app.session import STUDIES, Session
from treadload.app.study_points import about_study, point_of, point_rows
from treadload.case import Case
from treadload.errors import InputError
from treadload.plots.kit.shown import shown
from treadload.results import save_results
from treadload.sweeps import sweep


@pytest.fixture(scope="module")
def study():
    """Two inputs, one field, and a case that fails: the force is more than the friction bears."""
    form = Form.first().with_values({"spacing": "16 mm", "damage": None, "response.depths": ["20 mm"]})
    varied = {"rolling.friction": [0.2, 0.6, 0.8], "rolling.normal_load": [20e3, 30e3]}
    return sweep(Case.from_dict(dict(form.table)), varied, fields=("pressure",))


def test_dimensions_and_results_are_told_in_words(study):
    about = about_study(study)
    assert [one["name"] for one in about["dims"]] == ["rolling.friction", "rolling.normal_load"]
    assert [one["words"] for one in about["dims"]] == ["friction", "normal load"]
    assert about["dims"][1]["values"] == ["20 kN", "30 kN"]
    assert "largest_pressure" in about["readings"]
    assert set(about["fields"]) == {"pressure"}


def test_a_point_shows_what_the_dataset_holds(study):
    at = {"rolling.friction": 2, "rolling.normal_load": 1}
    made = point_of(study, at, "largest_pressure", "rolling.normal_load", "pressure", "light", 900.0)
    data = study.dataset
    line = data["largest_pressure"].isel({"rolling.friction": 2}).to_numpy()
    curve = made["curve"].data
    np.testing.assert_allclose(curve[0].y, line / 1e3)
    assert (curve[1].x[0], curve[1].y[0]) == pytest.approx((30.0, line[1] / 1e3))
    field = made["field"].data[0]
    pressure = data["pressure"].isel(at).to_numpy() / 1e3
    np.testing.assert_allclose(np.nan_to_num(field.z), pressure, rtol=1e-6)
    # One scale for all points, so that a move of a slider shows what changes.
    assert field.zmax == pytest.approx(float(data["pressure"].max()) / 1e3)
    told = {row["key"]: row["value"] for row in point_rows(study, at)}
    assert told["at:rolling.normal_load"] == "30 kN"
    assert told["solved:largest_pressure"].startswith(f"{line[1] / 1e3:.4g}"[:4])
    # What has a value for each depth says which depth it is of; and round-off is nothing.
    words = {row["key"]: row["label"] for row in point_rows(study, at)}
    assert words["solved:largest_extension"] == "largest tensile strain, depth 20 mm"
    titled = point_of(study, at, "largest_extension", "rolling.normal_load", "", "light", 900.0)["curve"]
    assert titled.layout.title.text == "<b>Largest tensile strain</b>, depth 20 mm"
    assert shown(xr.DataArray(4e-16, attrs={"units": "m"}), "worst_y").number(4e-16) == "0 mm"


def test_a_failed_case_says_why(study):
    rows = point_rows(study, {"rolling.friction": 0, "rolling.normal_load": 0})
    assert rows[-2]["value"] == "failed"
    assert rows[-1]["value"] == dict(study.failures)[0]
    curve = point_of(study, {}, "largest_pressure", "rolling.friction", "", "dark", 900.0)["curve"]
    assert np.isnan(curve.data[0].y[0])
    assert list(curve.data[2].x) == [0.2]


def test_what_the_study_has_not_is_refused(study):
    with pytest.raises(InputError, match="0 to 2"):
        point_rows(study, {"rolling.friction": 9})
    with pytest.raises(InputError, match="a dimension of the study"):
        point_of(study, {}, "largest_pressure", "spacing", "", "light", 900.0)
    with pytest.raises(InputError, match="is no map"):
        point_of(study, {}, "largest_pressure", "rolling.friction", "largest_pressure", "light", 900.0)


def test_a_study_is_opened_from_its_file_and_nothing_else_is(study, tmp_path):
    said = []
    engine = Engine(lambda line: said.append(json.loads(line)))
    engine.answer({"id": 1, "do": "folder", "folder": str(tmp_path)})
    save_results(study, tmp_path / "upload_1.nc")
    engine.answer({"id": 2, "do": "open", "run": "a", "file": "upload_1.nc", "kind": "study"})
    assert said[-1]["done"]
    engine.answer({"id": 3, "do": "study", "run": "a"})
    assert said[-1]["dims"] == about_study(study)["dims"]
    asked = {"at": {"rolling.friction": 1}, "reading": "largest_pressure", "along": "rolling.friction",
             "field": "pressure", "theme": "dark", "width": 900.0}  # fmt: skip
    engine.answer({"id": 4, "do": "point", "run": "a", **asked})
    assert set(said[-1]["figures"]) == {"curve", "field"}
    (tmp_path / "upload_2.nc").write_bytes(b"no such file")
    engine.answer({"id": 5, "do": "open", "run": "b", "file": "upload_2.nc", "kind": "study"})
    assert "error" in said[-1]
    road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    response = tl.solve_response(tl.UniformDisc(0.1, 7e5), road, depths=[0.02], x=np.linspace(-0.1, 0.1, 5),
                                 y=np.linspace(-0.1, 0.1, 5))  # fmt: skip
    save_results(response, tmp_path / "upload_3.nc")
    engine.answer({"id": 6, "do": "open", "run": "c", "file": "upload_3.nc", "kind": "study"})
    assert "no study" in said[-1]["error"]


def test_a_store_of_zarr_is_refused_with_its_reason():
    session = Session(Engines())
    try:
        with pytest.raises(InputError, match=r"Zarr.*save_results"):
            session.keep("study.zarr.zip", b"PK", STUDIES)
    finally:
        session.close()


def test_the_map_of_a_failed_case_says_so(study):
    """And that of a solved one does not."""
    for friction, told in ((0, ["this case failed; the reason is at the right"]), (2, [])):
        at = {"rolling.friction": friction, "rolling.normal_load": 0}
        field = point_of(study, at, "largest_pressure", "rolling.friction", "pressure", "light", 900.0)["field"]
        assert [one.text for one in field.layout.annotations] == told
        assert np.isfinite(field.data[0].z).any() == (not told)
