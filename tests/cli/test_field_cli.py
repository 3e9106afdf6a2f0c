"""`treadload field` from a table to a file and a page."""

import json

import pytest
from typer.testing import CliRunner

import treadload as tl
from treadload.cli.commands import app

run = CliRunner()


@pytest.mark.slow
def test_a_table_becomes_a_file_and_a_page(tmp_path):
    files = ["-o", str(tmp_path / "x.nc"), "--report", str(tmp_path / "x.html")]
    done = run.invoke(app, ["field", "LTPP", "-q", *files])
    assert done.exit_code == 0, done.output
    assert "5.15 years" in done.output
    opened = tl.open_results(tmp_path / "x.nc").field_bench
    assert opened.parameters().level > 5
    page = (tmp_path / "x.html").read_text(encoding="utf-8")
    assert "Share of roads that have cracked" in page
    assert "Who is left at the first survey" in page


def test_a_look_as_json():
    done = run.invoke(app, ["field", "LTPP", "--look", "--json", "-q"])
    rows = json.loads(done.stdout)
    assert rows[0]["value"] == "LTPP, 149 sections"
    assert {row["key"] for row in rows} >= {"cell_sections", "seen_share"}


def test_what_is_wrong_is_a_sentence(tmp_path):
    for options, words in (
        (["LTP"], "did you mean 'LTPP'"),
        ([str(tmp_path / "none.toml")], "cannot read"),
        (["LTPP", "--event", "rut"], "no event 'rut'"),
        (["LTPP", "-o", "x.pdf"], ".nc"),
    ):
        done = run.invoke(app, ["field", *options])
        assert done.exit_code == 2, done.output
        assert words in done.output
