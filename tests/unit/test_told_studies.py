"""A study told to others: tables, pages, files that open again, and the commands that write them."""

import csv
import json
import sys
from concurrent.futures import Future

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner

import treadload as tl
from studies import CASE, product_study, stored, study_of, wheel
from treadload.cli import app
from treadload.reporting.pictures import Picture
from treadload.results.exports import write
from treadload.sweeps import open_sweep, sampled, table_of
from treadload.sweeps.design import product

VARY = {"friction": [0.2, 0.4, 0.6], "normal_load": ["20 kN", "40 kN"]}


@pytest.fixture(scope="module")
def store(tmp_path_factory):
    path = tmp_path_factory.mktemp("study") / "s.zarr"
    stored(path, product(CASE, VARY), wheel)
    return path


def run(*words):
    return CliRunner().invoke(app, ["study", *map(str, words)])


def rows_of(path):
    with path.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def test_a_table_has_a_row_for_each_case(store, tmp_path):
    done = run("table", store, "-o", tmp_path / "t.csv")
    assert done.exit_code == 0, done.output
    rows = rows_of(tmp_path / "t.csv")
    assert len(rows) == 6
    assert [row["status"] for row in rows] == ["failed"] * 2 + ["solved"] * 4
    assert "gross sliding: 0.2 x 20000 N" in rows[0]["failure"]
    assert rows[0]["worst_strain [1]"] == ""
    assert rows[2]["failure"] == ""
    assert float(rows[2]["worst_strain [1]"]) == pytest.approx(52e-6 * 20 / 30)
    assert float(rows[2]["normal_load [N]"]) == 20e3
    # What is over depths stands in a table of its own, fields only where they are asked for.
    deep = rows_of(tmp_path / "t_friction_normal_load_depth.csv")
    assert len(deep) == 12
    assert len(list(tmp_path.iterdir())) == 2
    assert run("table", store, "-o", tmp_path / "t.csv", "--fields").exit_code == 0
    fields = rows_of(tmp_path / "t_friction_normal_load_y_x.csv")
    assert len(fields) == 6 * 99
    assert "pressure [Pa]" in fields[0]


def test_the_same_table_in_excel_and_parquet(store, tmp_path):
    openpyxl, parquet = pytest.importorskip("openpyxl"), pytest.importorskip("pyarrow.parquet")
    told = rows_of(write(table_of(open_sweep(store)), tmp_path / "t.csv")[0])
    for suffix in ("xlsx", "parquet"):
        assert run("table", store, "-o", tmp_path / f"t.{suffix}").exit_code == 0
    sheet = openpyxl.load_workbook(tmp_path / "t.xlsx")["t"]
    head, *rows = sheet.iter_rows(values_only=True)
    columns = parquet.read_table(tmp_path / "t.parquet").to_pydict()
    assert list(columns) == list(head) == list(told[0])
    for name in ("worst_strain [1]", "friction"):
        found = [float(row[name] or "nan") for row in told]
        np.testing.assert_array_equal(columns[name], found)
        at = head.index(name)
        # A workbook holds 15 digits or 16.
        np.testing.assert_allclose([np.nan if row[at] is None else row[at] for row in rows], found, rtol=1e-15)
    assert columns["failure"][0].startswith("gross sliding")
    assert columns["status"][2] == "solved"


def test_parquet_says_what_to_install(store, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    done = run("table", store, "-o", tmp_path / "t.parquet")
    assert done.exit_code == 2
    assert "Parquet needs pyarrow" in done.output
    assert "[study]" in done.output
    assert not list(tmp_path.iterdir())


def test_every_result_can_be_written_as_parquet(coarse_result, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    files = tl.results.write_parquet(coarse_result.contact, tmp_path / "c.parquet")
    assert [file.name for file in files] == ["c.parquet", "c_scalars.parquet"]
    table = parquet.read_table(files[0]).to_pydict()
    pressure = coarse_result.contact.dataset["pressure"]
    np.testing.assert_array_equal(table["pressure [Pa]"], pressure.to_numpy().ravel())
    scalars = dict(zip(*list(parquet.read_table(files[1]).to_pydict().values())[:2], strict=True))
    assert float(scalars["approach"]) == float(coarse_result.contact.dataset["approach"])


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("table", "-o", "t.nc"), "use .csv"),
        (("table", "-o", "t.pdf"), "cannot write a table"),
        (("report", "-o", "t.csv"), "cannot write the report"),
    ],
)
def test_wrong_names_are_refused(store, tmp_path, words, said, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = run(words[0], store, *words[1:])
    assert done.exit_code == 2
    assert said in done.output


def test_what_is_no_study_is_refused(tmp_path):
    for command in ("summary", "table", "report"):
        done = run(command, tmp_path)
        assert done.exit_code == 2
        assert "no study" in done.output or "cannot write" in done.output


def test_the_summary_is_that_of_the_study(store):
    assert run("summary", store).output.strip() == open_sweep(store).summary()


@pytest.fixture
def unprinted(monkeypatch):
    """Figures are made and not turned into pixels, which takes seconds."""

    def picture(title, caption, draw, wide=False):
        assert draw().axes
        encoded = Future()
        encoded.set_result("data:,")
        return [Picture(title, caption, encoded, 100, wide)]

    monkeypatch.setattr("treadload.reporting.pictures.picture", picture)


@pytest.mark.slow
def test_the_page_is_drawn(store, tmp_path):
    assert run("report", store, "-o", tmp_path / "s.html", "-q").exit_code == 0
    page = (tmp_path / "s.html").read_text(encoding="utf-8")
    assert "could not be drawn" not in page
    assert page.count("data:image/webp") == page.count("<figure") == 6


def test_the_page_says_what_was_asked_and_what_came_out(store, tmp_path, unprinted):
    done = run("report", store, "-o", tmp_path / "s.html", "-q")
    assert done.exit_code == 0, done.output
    page = (tmp_path / "s.html").read_text(encoding="utf-8")
    assert "could not be drawn" not in page
    assert "<h1>Study: coarse</h1>" in page
    assert "<td>0.2, 0.4, 0.6</td>" in page
    assert "rolling.normal_load" in page
    assert "20 kN, 40 kN" in page
    # Cases: 6, of which 4 solved and 2 failed, with the first and its reason.
    cells = [part.split("<")[0] for part in page.split(">Cases<")[1].split("<tbody>")[1].split(">")]
    assert [one for one in cells if one.strip().isdigit()][:4] == ["6", "4", "2", "0"]
    assert "friction 0.2, normal load 20 kN" in page
    assert "gross sliding: 0.2 x 20000 N is too little" in page
    # The base case, its tire, the methods, the versions.
    assert "315/80R22.5" in page
    assert "Love, A. E. H. (1929)" in page
    assert "computed by treadload" in page
    # Curves against both inputs, two maps of results, two fields.
    assert page.count("<figure") == 6
    assert 'src="http' not in page


def test_the_page_of_a_slip_study_has_its_curve(tmp_path, unprinted):
    study = product_study(**{"rolling.creepage_x": [-0.1, -0.01, 0.0]})
    assert "<b>Slip curve.</b>" in tl.report(study, tmp_path / "s.html").read_text()


def test_a_sampled_study_is_reported(tmp_path, unprinted):
    study = study_of(sampled(CASE, {"friction": (0.2, 0.9), "normal_load": ("20 kN", "40 kN")}, 8), wheel)
    page = tl.report({"sample": study}, tmp_path / "s.html").read_text()
    assert "8 values" in page


def test_a_study_opens_from_a_file_as_it_was(store, tmp_path):
    study = open_sweep(store)
    opened = tl.open_results(tl.save_results(study, tmp_path / "s.nc"))
    (name,) = opened
    assert name == "sweep"
    back = opened.sweep
    xr.testing.assert_identical(back.dataset, study.dataset.load())
    assert back.failures == study.failures
    assert back.summary() == study.summary()
    assert back.design.words_of(3) == study.design.words_of(3)
    assert opened.case == CASE
    assert back.plot.curve("worst_strain").axes


def test_a_file_of_a_study_that_is_torn_is_refused(tmp_path):
    design = product(CASE, {"friction": [0.1, 0.2], "normal_load": [2e4, 3e4]})
    study = study_of(design, lambda friction, normal_load: {"worst_strain": friction})
    whole = tl.save_results(study, tmp_path / "s.nc")
    tree = tl.open_results(whole).tree
    questions = json.loads(tree["asked"].attrs["questions"])

    def opened(change):
        attrs = questions["sweep"]["attrs"]["table"]
        told = {**questions, "sweep": {**questions["sweep"], "attrs": {"table": [change(*pair) for pair in attrs]}}}
        torn = tree.copy()
        torn["asked"].attrs["questions"] = json.dumps(told)
        return tl.open_results(tl.save_results(torn, tmp_path / "t.nc")).sweep

    assert opened(lambda name, value: [name, value]).summary() == study.summary()
    for name, value, said in (
        ("failures", '[[99, "it broke"]]', "not among the 4"),
        ("failures", "[", "cannot be read as a Sweep"),
        ("design", '{"sizes": {"friction": 4}, "inputs": []}', "the design over {'friction': 4}"),
    ):
        with pytest.raises(tl.InputError, match=said):
            opened(lambda key, old, name=name, value=value: [key, value if key == name else old])
