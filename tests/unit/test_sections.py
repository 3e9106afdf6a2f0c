"""A table of sections: ids go through to the results, and a bad row fails alone, by its row and its id."""

import openpyxl
import pytest
from typer.testing import CliRunner

import treadload as tl
from sweeps import same, small_case
from treadload.cli import app
from treadload.errors import InputError
from treadload.sweeps import Design, from_file, plan_sweep, table_of

SECTIONS = """Section;km;modulus [GPa];poisson
A12;0,5;5,4;0,35
B 1;1,2;abc;0,35
C7;2,0;2;
D3;2,5;3;0,9
E9;3,1;4
F2;3,4;2;0,25
G5;4,0;xyz;0,25
"""


@pytest.fixture
def case(tmp_path):
    return small_case(tmp_path)


@pytest.fixture
def table(tmp_path):
    path = tmp_path / "sections.csv"
    path.write_text(SECTIONS)
    return path


def test_ids_go_through_and_bad_rows_fail_alone(case, table):
    study = tl.sweep(case, from_file(case, table, ids=["km"]))
    assert study.dataset["Section"].to_numpy().tolist() == ["A12", "B 1", "C7", "D3", "E9", "F2", "G5"]
    assert study.dataset["km"].to_numpy().tolist() == ["0,5", "1,2", "2,0", "2,5", "3,1", "3,4", "4,0"]
    assert study.dataset["row"].to_numpy().tolist() == [2, 3, 4, 5, 6, 7, 8]
    assert study.dataset["status"].to_numpy().tolist() == [1, 2, 2, 2, 2, 1, 2]
    # The good rows are what they are without the others.
    alone = tl.sweep(case, [{"modulus": 5.4e9, "poisson": 0.35}, {"modulus": 2e9, "poisson": 0.25}])
    kept = study.dataset.isel(case=[0, 5])
    assert (kept["largest_extension"].to_numpy() == alone.dataset["largest_extension"].to_numpy()).all()
    said = "\n".join(study.warnings)
    assert "row 4 (Section C7, km 2,0): no value of poisson" in said
    assert "row 5 (Section D3, km 2,5): " in said
    assert "row 6 (Section E9, km 3,1): 3 values where the header has 4" in said
    # Two rows of one cause are told together, whatever the cell says.
    assert "2 cases failed, row 3 (Section B 1, km 1,2), row 8 (Section G5, km 4,0): " in said
    assert "cannot read 'abc GPa'" in said


def test_a_sheet_numbers_its_rows_as_excel_does(case, tmp_path):
    book = openpyxl.Workbook()
    for row in (["id", "modulus [GPa]", "poisson"], [7.0, 5.4, 0.35], [], ["B1", None, 0.35], ["C", 3, 0.3, "late"]):
        book.active.append(row)
    book.save(tmp_path / "sections.xlsx")
    design = from_file(case, tmp_path / "sections.xlsx")
    assert design.labels == {"row": (2, 4, 5), "id": ("7", "B1", "C")}
    assert design.faults == {1: "no value of modulus", 2: "4 values where the header has 3"}
    assert design.at(0) == {"pavement.layers.0.material.modulus": 5.4e9,
                            "pavement.layers.0.material.poisson": 0.35}  # fmt: skip
    again = Design.from_json(design.to_json(), case)
    assert again.to_json() == design.to_json()
    plan = plan_sweep(case, design)
    assert "2 of the first 3 cases will fail, the first: row 4 (id B1): no value of modulus" in plan


def test_a_store_keeps_the_ids_and_tries_no_bad_row_again(case, table, tmp_path):
    design, path = from_file(case, table, ids=["km"]), tmp_path / "study.zarr"
    first = tl.sweep(case, design, store=path)
    assert same(first.dataset, tl.sweep(case, design).dataset)
    size = (path / ".records.jsonl").stat().st_size
    counts = []
    again = tl.sweep(case, design, store=path, progress=lambda done, total, what: counts.append(done))
    assert counts == []
    assert same(first.dataset, again.dataset)
    assert (path / ".records.jsonl").stat().st_size == size
    rows = table_of(again)
    assert rows["failure"].to_numpy()[2] == "no value of poisson"
    assert rows["Section"].to_numpy()[2] == "C7"


def test_at_the_command_line(case, table, tmp_path):
    arguments = ["sweep", str(tmp_path / "case.toml"), "--table", str(table), "--quiet"]
    wrong = CliRunner().invoke(app, arguments)
    assert wrong.exit_code == 2
    for words in ("column 'km'", "id, name, section or label", "--id 'km'"):
        assert words in wrong.stderr
    done = CliRunner().invoke(app, [*arguments, "--id", "km"])
    assert done.exit_code == 0, done.output
    assert "2, 5 failed" in done.output
    out = CliRunner().invoke(app, ["study", "table", str(tmp_path / "case.zarr"), "-o", str(tmp_path / "out.csv")])
    assert out.exit_code == 0, out.output
    lines = (tmp_path / "out.csv").read_text().splitlines()
    assert "Section" in lines[0]
    assert "A12" in lines[1]
    page = CliRunner().invoke(app, ["study", "report", str(tmp_path / "case.zarr"), "-o", str(tmp_path / "out.html")])
    assert page.exit_code == 0, page.output
    assert "Section B 1" in (tmp_path / "out.html").read_text()
    none = CliRunner().invoke(app, ["sweep", str(tmp_path / "case.toml"), "--id", "km"])
    assert "--table" in none.stderr


@pytest.mark.parametrize(
    ("text", "ids", "words"),
    [
        ("id;poisson\n1;0.3\n", ["km"], "no column 'km' of ids"),
        ("poisson;poisson\n0.2;0.3\n", [], "two columns 'poisson'"),
        ("id;name\n1;a\n", [], "varies nothing"),
        ("id;poisson\nA;x\nB;y\n", [], "poisson"),
    ],
)
def test_tables_that_are_no_study(case, tmp_path, text, ids, words):
    (tmp_path / "cases.csv").write_text(text)
    with pytest.raises(InputError, match=words):
        from_file(case, tmp_path / "cases.csv", ids=ids)


def test_an_id_may_have_the_name_of_anything_of_a_study(case, tmp_path):
    (tmp_path / "cases.csv").write_text("id;status;row;net_area;poisson\na;b;c;d;0.3\n")
    study = tl.sweep(case, from_file(case, tmp_path / "cases.csv", ids=["status", "row", "net_area"]))
    assert study.dataset["status"].to_numpy().tolist() == [1]
    assert study.dataset["id_status"].to_numpy().tolist() == ["b"]
    assert study.dataset["row"].to_numpy().tolist() == [2]
    assert study.dataset["id_row"].to_numpy().tolist() == ["c"]
