"""Which cases a study has: keys, units, ranges, tables, samples."""

import zipfile

import numpy as np
import openpyxl
import pytest
import xarray as xr

import treadload as tl
from sweeps import small_case
from treadload.case.keys import find_key, keys_of
from treadload.errors import InputError
from treadload.sweeps import Design, bounds_of, from_file, from_texts, sampled
from treadload.sweeps.design import from_dataset, listed, product
from treadload.templates import first_case


@pytest.fixture(scope="module")
def case():
    return tl.Case.from_text(first_case("run"))


@pytest.fixture(scope="module")
def design_case():
    return tl.Case.from_text(first_case("life"))


def test_a_name_means_the_one_key_that_ends_in_it(case, design_case):
    assert find_key(case, "friction") == "rolling.friction"
    assert find_key(case, "spacing") == "spacing"
    assert find_key(case, "pavement.layers.1.thickness") == "pavement.layers.1.thickness"
    assert find_key(design_case, "deviation") == "traffic.wander.deviation"
    with pytest.raises(InputError, match=r"pavement\.layers\.0\.thickness, pavement\.layers\.1\.thickness"):
        find_key(case, "thickness")
    with pytest.raises(InputError, match="did you mean 'friction'"):
        find_key(case, "frictoin")


def test_units_of_keys(case, design_case):
    units = keys_of(case)
    assert units["rolling.normal_load"] == "N"
    assert units["pavement.layers.0.material.modulus"] == "Pa"
    assert units["pavement.temperature"] == "degC"
    assert units["rolling.creepage_x"] == ""
    assert units["tire.profile"] is None
    assert keys_of(design_case)["traffic.classes.0.wheel_load"] == "N"


def test_a_product_in_si_units_however_they_are_spelt(case):
    spelt = product(case, {"normal_load": ["20 kN", "30,5 kN", 4e4], "friction": [0.3, "0.5"]})
    assert spelt.sizes == {"normal_load": 3, "friction": 2}
    loads, friction = spelt.inputs
    assert loads.labels.tolist() == [20e3, 30.5e3, 40e3]
    assert (loads.key, loads.unit, friction.unit) == ("rolling.normal_load", "N", None)
    assert friction.is_number
    # The last dimension runs fastest.
    assert spelt.at(1) == {"rolling.normal_load": 20e3, "rolling.friction": 0.5}
    assert spelt.words_of(5) == "normal_load 40000 N, friction 0.5"
    coordinates = spelt.coordinates()["normal_load"]
    assert coordinates[2] == {"key": "rolling.normal_load", "units": "N", "long_name": "normal load"}


def test_texts_and_tables_are_labels(case):
    roads = product(case, {"tire.profile": ["315/80R22.5", "205/55R16"], "error_estimate": [True, False]})
    assert roads.inputs[0].labels.tolist() == ["315/80R22.5", "205/55R16"]
    assert roads.inputs[1].labels.tolist() == ["true", "false"]
    laws = [{"law": "coulomb", "coefficient": 0.5}, {"law": "coulomb", "coefficient": 0.7}]
    frictions = product(case, {"rolling.friction": laws})
    assert frictions.inputs[0].labels.tolist() == ["coulomb (1)", "coulomb (2)"]
    assert frictions.at(1)["rolling.friction"]["coefficient"] == 0.7


@pytest.mark.parametrize(
    ("vary", "said"),
    [
        ({}, "nothing is varied"),
        ({"friction": 0.5}, "needs a list of values"),
        ({"friction": []}, "has no values"),
        ({"friction": [0.5, 0.5]}, "given twice"),
        ({"normal_load": ["20 kN", 20e3]}, "given twice"),
        ({"friction": [-0.1, 0.5]}, "friction must be >= 0"),
        ({"friction": [0.3], "rolling.friction": [0.5]}, "varied twice"),
        ({"rolling.frction": [0.3]}, "unknown key 'rolling.frction'"),
        ({"normal_load": ["20 mm"]}, "is not a unit of this kind"),
        ({"pavement.layers.7.thickness": [0.1]}, "a list of 3"),
        ({"friction": [float("nan")]}, "nan"),
    ],
)
def test_wrong_products_are_refused_before_anything_is_solved(case, vary, said):
    with pytest.raises(InputError, match=said):
        product(case, vary)


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("friction=0.3:0.9:7", [0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9]),
        ('normal_load="20 kN:40 kN:3"', [20e3, 30e3, 40e3]),
        ("normal_load=20:40 kN:3", [20e3, 30e3, 40e3]),
        ("pavement.layers.0.thickness=1 cm:16 cm:3:log", [0.01, 0.04, 0.16]),
        ("friction=[0.3, 0.7]", [0.3, 0.7]),
        ('normal_load=["20 kN", "30 kN"]', [20e3, 30e3]),
        ("friction=0.4", [0.4]),
    ],
)
def test_ranges_and_lists_as_texts(case, text, values):
    # Twelve digits: no 0.6000000000000001 that nobody typed.
    assert from_texts(case, [text]).inputs[0].labels.tolist() == pytest.approx(values, rel=1e-12)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("friction", "write key=values"),
        ("friction=0,3", "write a list in brackets"),
        ("friction=0.3:0.9", "low:high:count"),
        ("friction=0.3:0.9:1", "from 2 to"),
        ("friction=0.3:0.9:x", "from 2 to"),
        ("friction=0:0.9:3:log", "above zero"),
        ("friction=[0.3", "cannot read the list"),
        ("tire.profile=a:b:3", "tire"),
    ],
)
def test_wrong_texts(case, text, said):
    with pytest.raises(InputError, match=said):
        from_texts(case, [text])
    with pytest.raises(InputError, match="varied twice"):
        from_texts(case, ["friction=0.3", "friction=0.5"])


def test_tables_with_units_in_headings_and_cells(case, tmp_path):
    table = tmp_path / "cases.csv"
    table.write_text("normal_load [kN];friction;inflation_pressure\n20,5;0,5;8 bar\n30;0,7;9 bar\n")
    made = from_file(case, table)
    assert made.sizes == {"case": 2}
    assert [one.labels.tolist() for one in made.inputs] == [[20.5e3, 30e3], [0.5, 0.7], [8e5, 9e5]]
    book = openpyxl.Workbook()
    for row in (["normal_load [kN]", "friction", "inflation_pressure"], [20.5, 0.5, "8 bar"], [30, 0.7, "9 bar"]):
        book.active.append(row)
    book.save(tmp_path / "cases.xlsx")
    again = from_file(case, tmp_path / "cases.xlsx")
    assert [one.labels.tolist() for one in again.inputs] == [one.labels.tolist() for one in made.inputs]


def test_a_hidden_sheet_before_the_table_is_no_table(case, tmp_path):
    book = openpyxl.Workbook()
    book.active.append(["friction"])
    book.active.append([0.9])
    book.active.sheet_state = "hidden"
    book.create_sheet("cases").append(["friction"])
    book["cases"].append([0.5])
    # Formats down to the last row are no rows.
    book["cases"].row_dimensions[1_000_000].height = 20
    book.active = 1
    book.save(tmp_path / "cases.xlsx")
    assert from_file(case, tmp_path / "cases.xlsx").inputs[0].labels.tolist() == [0.5]


def test_workbooks_that_unpack_to_too_much(case, tmp_path):
    path = tmp_path / "cases.xlsx"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("xl/worksheets/sheet1.xml", bytes(2**25))
    with pytest.raises(InputError, match="more than 1000 times"):
        from_file(case, path)
    book = openpyxl.Workbook()
    book.active.append(["friction"])
    book.active.append([0.5])
    for row in range(3, 330):
        book.active.cell(row, 16384).value = 1
    book.save(path)
    with pytest.raises(InputError, match="more than 5000000 cells"):
        from_file(case, path)
    path.write_bytes(b"a;b")
    with pytest.raises(InputError, match="save it again, or save the sheet as CSV"):
        from_file(case, path)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("1;2\n3;4\n", "the first line names the keys"),
        ("friction;normal_load\n0.5\n", "line 2: 1 values where the header has 2"),
        ("friction;load\n0.5;3\n", "no key 'load'"),
        ("friction\n", "list of cases is empty"),
    ],
)
def test_wrong_tables(case, tmp_path, text, said):
    (tmp_path / "cases.csv").write_text(text)
    with pytest.raises(InputError, match=said):
        from_file(case, tmp_path / "cases.csv")


def test_a_dataset_of_coordinates_keeps_its_dimensions(case):
    given = xr.Dataset(
        {"rolling.tractive_force": (("load", "driven"), [[0.0, 5e3], [0.0, 8e3]])},
        {"load": [0, 1], "driven": ["free", "driving"]},
    ).drop_vars(["load", "driven"])
    given["rolling.normal_load"] = ("load", [20e3, 30e3])
    made = from_dataset(case, given)
    assert made.sizes == {"load": 2, "driven": 2}
    assert made.at(3) == {"rolling.tractive_force": 8e3, "rolling.normal_load": 30e3}


@pytest.mark.parametrize("method", ["sobol", "latin", "random"])
def test_samples_fill_their_ranges_and_repeat(case, method):
    ranges = {"friction": (0.3, 0.9), "normal_load": ("20 kN", "40 kN")}
    one, again, other = (sampled(case, ranges, 64, method=method, seed=seed) for seed in (1, 1, 2))
    points = np.array([one.inputs[k].labels for k in range(2)])
    assert (points == [again.inputs[k].labels for k in range(2)]).all()
    assert (points != [other.inputs[k].labels for k in range(2)]).any()
    assert (points >= [[0.3], [20e3]]).all()
    assert (points <= [[0.9], [40e3]]).all()
    # Stratified methods have their mean in the middle to 1/n or so, random numbers to 3 σ = 3 · range/√(12 n).
    off = abs(points.mean(1) - [0.6, 30e3]) / [0.6, 20e3]
    assert (off < (0.011 if method != "random" else 3 / np.sqrt(12 * 64))).all()


def test_wrong_samples(case):
    with pytest.raises(InputError, match="one of sobol, latin, random"):
        sampled(case, {"friction": (0.3, 0.9)}, 8, method="halton")
    with pytest.raises(InputError, match="low and high end"):
        bounds_of(case, {"friction": (0.3, 0.5, 0.9)})
    with pytest.raises(InputError, match="a sample needs numbers"):
        bounds_of(case, {"tire.profile": ("315/80R22.5", "205/55R16")})
    with pytest.raises(InputError, match="such as sobol:256"):
        from_texts(case, ["friction=0.3:0.9"], sample="sobol")


def test_a_list_of_cases_may_hold_wrong_ones_but_not_only_these(tmp_path):
    case = small_case(tmp_path)
    made = listed(case, [{"poisson": 0.9}, {"poisson": 0.3}])
    assert made.count == 2
    with pytest.raises(InputError, match="poisson"):
        listed(case, [{"poisson": 0.9}, {"poisson": 0.8}])
    with pytest.raises(InputError, match="give the same"):
        listed(case, [{"poisson": 0.3}, {"modulus": 1e9}])


def test_a_design_goes_through_json(case):
    made = product(case, {"normal_load": ["20 kN", 3e4], "tire.profile": ["315/80R22.5", "205/55R16"]})
    again = Design.from_json(made.to_json(), case)
    assert again.to_json() == made.to_json()
    assert [again.at(k) for k in range(4)] == [made.at(k) for k in range(4)]
    with pytest.raises(InputError, match="design of the study cannot be read"):
        Design.from_json({"sizes": {"a": 0}, "inputs": []}, case)
