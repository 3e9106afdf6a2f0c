"""Studies in memory: what is kept of every case, fields, failures, and that places and orders do not matter."""

import numpy as np
import pytest
import xarray as xr

import treadload as tl
from sweeps import same, small_case
from treadload.errors import InputError
from treadload.sweeps.selection import attributes, selectors_for
from treadload.sweeps.sweep import _anchor
from treadload.sweeps.work import Question, Worker

TIRE = """
spacing = "16 mm"
[tire]
profile = "315/80R22.5"
inflation_pressure = "8.2 bar"
[[pavement.layers]]
material = { kind = "elastic", modulus = "5400 MPa", poisson = 0.35 }
[rolling]
normal_load = "30 kN"
friction = 0.7
creepage_x = -0.01
[response]
depths = ["0 mm", "20 mm"]
"""
FIELDS = ["pressure", "response.stress_zz", "max(principal_strain_1)"]


@pytest.fixture(scope="module")
def tire_case():
    return tl.Case.from_text(TIRE)


@pytest.fixture(scope="module")
def rolled(tire_case):
    vary = {"friction": [0.3, 0.5, 0.7], "normal_load": ["20 kN", "30 kN"]}
    return tl.sweep(tire_case, vary, fields=FIELDS)


def test_every_number_is_that_of_the_case_run_alone(tire_case, rolled):
    case = tire_case.from_dict(
        {**tire_case.as_tables(), "rolling": {**tire_case.as_tables()["rolling"], "friction": 0.5}}
    )
    alone = tl.run(case)
    here = rolled.dataset.sel(friction=0.5, normal_load=30e3)
    # A study starts its contacts near each other: equal to the solver's tolerance, of 1e-6 of μp and of the approach.
    assert float(here["tractive_force"]) == pytest.approx(float(alone.contact.dataset["tractive_force"]), rel=1e-5)
    assert float(here["solved_normal_load"]) == pytest.approx(30e3, rel=1e-9)
    assert float(here["largest_pressure"]) == pytest.approx(float(alone.contact.dataset.pressure.max()), rel=1e-6)
    assert float(here["net_area"]) == alone.contact.area
    whole = alone.contact.dataset.pressure
    kept = here["pressure"].sel(x=whole.x, y=whole.y, method="nearest")
    assert abs(kept.to_numpy() - whole.to_numpy()).max() < 1e-5 * float(whole.max())
    strain = alone.response.dataset["principal_strain_1"].max(("y", "x"))
    assert here["max_principal_strain_1"].to_numpy() == pytest.approx(strain.to_numpy(), rel=1e-5)
    # Where a mean is read near the surface it is smaller than the largest point, deeper it is the same.
    assert float(here["largest_extension"][0]) < float(strain[0])


def test_sections_keep_their_own_depths(tmp_path):
    case = small_case(tmp_path)
    study = tl.sweep(case, {"modulus": [2e9, 5.4e9]}, fields=["slice_along.strain_xx", "extension_by_depth"])
    alone = tl.run(case).slice_along.dataset["strain_xx"]
    kept = study.dataset["slice_along.strain_xx"].sel(modulus=5.4e9)
    assert kept.dims == ("slice_along_depth", "slice_along_x")
    assert kept.sizes["slice_along_depth"] == alone.sizes["depth"] > study.dataset.sizes["depth"] == 2
    assert kept.to_numpy() == pytest.approx(alone.isel(y=0).to_numpy(), rel=1e-12)
    # What is over one dimension is a number of every case.
    assert study.dataset["extension_by_depth"].dims == ("modulus", "depth")


def test_fields_stand_on_the_places_of_all_cases(rolled):
    data = rolled.dataset
    assert data["pressure"].dims == ("friction", "normal_load", "y", "x")
    # The larger load needs more cells, and the smaller one has none there.
    load = (data["pressure"].sum(("y", "x")) * (0.016**2)).to_numpy()
    assert load == pytest.approx(np.tile([20e3, 30e3], (3, 1)), rel=1e-6)
    assert data["pressure"].attrs["units"] == "Pa"
    assert data["max_principal_strain_1"].attrs["long_name"].startswith("largest over the plane")
    assert data["response.stress_zz"].dims == ("friction", "normal_load", "depth", "y", "x")


def test_inputs_are_coordinates_with_units(rolled):
    assert rolled.dataset["normal_load"].to_numpy().tolist() == [20e3, 30e3]
    assert rolled.dataset["normal_load"].attrs == {
        "key": "rolling.normal_load", "units": "N", "long_name": "normal load",
    }  # fmt: skip
    assert rolled.stats["solved"] == 6
    assert rolled.rows()[0].sentence == "rolling.friction: 0.3 to 0.7, 3 values"


def test_the_order_of_cases_and_the_place_do_not_matter(tire_case, rolled):
    vary = {"friction": [0.3, 0.5, 0.7], "normal_load": ["20 kN", "30 kN"]}
    threaded = tl.sweep(tire_case, vary, fields=FIELDS, jobs=2, in_threads=True)
    assert same(rolled.dataset, threaded.dataset)
    design = rolled.design
    anchor = _anchor(tire_case, design)
    assert anchor == {"rolling.friction": 0.3}
    question = Question(tire_case.as_tables(), tire_case.folder, anchor=anchor)
    for number in (5, 0, 2):
        record = Worker(question).solve(number, design.at(number))
        at = rolled.dataset.isel(friction=number // 2, normal_load=number % 2)
        assert float(record.numbers["tractive_force"][1]) == float(at["tractive_force"])


def test_cases_that_differ_behind_the_contact_share_it(tire_case, monkeypatch):
    from treadload.sweeps import work

    solved = []
    original = work.contact_of
    monkeypatch.setattr(work, "contact_of", lambda *args, **more: solved.append(1) or original(*args, **more))
    tl.sweep(tire_case, {"response.wheels": [[{"y": 0.0}], [{"y": 0.16}], [{"y": 0.32}]]})
    assert len(solved) == 1
    # A crossing comes beside the plain wheel, and solves its own contacts.
    case = tire_case.from_dict({**tire_case.as_tables(), "crossing": {"step": {"rise": 2e-3}}})
    worker = Worker(Question(case.as_tables(), case.folder))
    low, high = (worker._parts({"crossing.step.rise": rise}) for rise in (2e-3, 3e-3))
    assert low.scene.loaded.contact is high.scene.loaded.contact
    assert len(solved) == 2


def test_a_tire_is_read_once_whatever_inflates_it(tire_case, monkeypatch):
    from treadload.case.model import Case
    from treadload.sweeps import work

    read, used = [], []
    build, solve = Case.build_tire, work.contact_of
    monkeypatch.setattr(Case, "build_tire", lambda case: read.append(1) or build(case))

    def solved(case, *args, tire, **more):
        used.append((tire, build(case)))
        return solve(case, *args, tire=tire, **more)

    monkeypatch.setattr(work, "contact_of", solved)
    tl.sweep(tire_case, {"inflation_pressure": ["6 bar", "8 bar"]})
    assert len(read) == 1
    assert all(tire == own for tire, own in used)
    assert [tire.inflation_pressure for tire, _ in used] == [6e5, 8e5]


def test_what_fails_is_kept_and_the_others_go_on(tmp_path):
    case = small_case(tmp_path)
    study = tl.sweep(case, [{"poisson": 0.9}, {"poisson": 0.35}, {"poisson": 0.7}])
    assert study.dataset["status"].to_numpy().tolist() == [2, 1, 2]
    assert [number for number, _ in study.failures] == [0, 2]
    assert np.isnan(study.dataset["largest_extension"].sel(depth=0.02)).to_numpy().tolist() == [True, False, True]
    # One cause, told once: the numbers in it differ.
    told = [text for text in study.warnings if "failed" in text]
    assert len(told) == 1
    assert told[0].startswith("2 cases failed, the first with poisson 0.9: ")


def test_a_bug_in_one_case_does_not_end_a_study(tmp_path, monkeypatch):
    from treadload.steps import scene

    case, calls = small_case(tmp_path), []
    original = scene.load_case

    def broken(*args, **more):
        calls.append(1)
        if len(calls) == 2:
            raise ZeroDivisionError("nobody foresaw this")
        return original(*args, **more)

    monkeypatch.setattr(scene, "load_case", broken)
    study = tl.sweep(case, {"poisson": [0.2, 0.3, 0.4]})
    assert study.failures == ((1, "ZeroDivisionError: nobody foresaw this"),)


def test_numbers_scale_as_elasticity_says(tmp_path):
    # Strain goes like one over the modulus, stress does not know it.
    study = tl.sweep(small_case(tmp_path), {"modulus": np.geomspace(1e9, 1e10, 4)}, fields=["max(stress_xx)"])
    data = study.dataset
    assert (data["largest_extension"] * data["modulus"]).std("modulus").max() < 1e-9 * 1e6
    assert data["max_stress_xx"].std("modulus").max() < 1e-9 * abs(data["max_stress_xx"]).max()
    assert set(study.results) >= {"largest_extension", "worst_strain", "worst_passes", "max_stress_xx"}


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        (["presure"], "did you mean 'pressure'"),
        (["sum(pressure)"], "not one of max, min, mean"),
        (["max(pressure"], "write a name"),
        (["belt.pressure"], "no part 'belt'"),
        ("pressure", "a list of names"),
    ],
)
def test_wrong_fields_are_refused_before_anything_is_solved(tmp_path, fields, said):
    with pytest.raises(InputError, match=said):
        tl.sweep(small_case(tmp_path), {"poisson": [0.2, 0.3]}, fields=fields)


def test_a_field_that_a_case_lacks_is_told_with_those_it_has(tmp_path):
    study = tl.sweep(small_case(tmp_path), {"poisson": [0.2]}, fields=["response.flash_temperature"])
    assert "no field 'response.flash_temperature'" in study.failures[0][1]


def test_labels_and_their_attributes(tire_case):
    one = selectors_for(["mean(stress_xx)", "max(response.stress_xx)", "bowl.displacement_z"], tire_case)
    assert [part.label for part in one] == ["mean_of_stress_xx", "max_stress_xx", "bowl.displacement_z"]
    assert attributes("mean_of_stress_xx")["units"] == "Pa"
    assert attributes("mean_stress")["long_name"] == "mean stress, tension positive"
    assert attributes("bowl.displacement_z")["units"] == "m"


@pytest.mark.parametrize(
    ("vary", "more", "said"),
    [
        ("friction", {}, "cannot vary str"),
        ({"poisson": [0.3]}, {"jobs": 0}, "jobs must be"),
        ({"poisson": [0.3]}, {"jobs": 1.5}, "whole number"),
        ({"poisson": [0.3]}, {"store": "x.nc"}, "is a folder"),
    ],
)
def test_wrong_questions(tmp_path, vary, more, said):
    with pytest.raises(InputError, match=said):
        tl.sweep(small_case(tmp_path), vary, **more)


def test_a_calibration_is_no_question_to_vary():
    from treadload.templates import first_case

    with pytest.raises(InputError, match=r"\[calibration\], of which no numbers are kept"):
        tl.sweep(tl.case.Case.from_text(first_case("calibrate")), {"friction": [0.5]})


def test_a_dataset_of_cases_keeps_its_dimensions(tmp_path):
    cases = xr.Dataset({"modulus": (("road", "age"), [[1e9, 2e9], [3e9, 6e9]])}, {"road": ["a", "b"]})
    with pytest.raises(InputError, match="no key 'road'"):
        tl.sweep(small_case(tmp_path), cases)
    study = tl.sweep(small_case(tmp_path), cases.drop_vars("road"))
    assert study.dataset["largest_extension"].dims == ("road", "age", "depth")
    strain = study.dataset["largest_extension"].isel(depth=0).to_numpy()
    assert strain * [[1, 2], [3, 6]] == pytest.approx(np.full((2, 2), strain[0, 0]), rel=1e-9)
