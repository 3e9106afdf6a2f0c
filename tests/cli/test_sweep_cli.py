"""`treadload sweep` from outside."""

import json

import pytest
from typer.testing import CliRunner

import treadload as tl
from sweeps import small_case
from treadload.cli import app
from treadload.sweeps import open_sweep

pytest.importorskip("zarr")


def run(*arguments):
    return CliRunner().invoke(app, [str(one) for one in arguments])


@pytest.fixture
def case(tmp_path):
    small_case(tmp_path)
    return tmp_path / "case.toml"


def test_a_product_with_fields_and_units(case):
    done = run("sweep", case, "--vary", "modulus=1 GPa:4 GPa:2", "--vary", "poisson=[0.3, 0.4]", "--field",
               "max(stress_xx)", "--quiet")  # fmt: skip
    assert done.exit_code == 0, done.output
    assert "pavement.layers.0.material.modulus: 1e+09 to 4e+09 Pa, 2 values" in done.output
    assert f"written: {case.with_suffix('.zarr')}" in done.output
    study = open_sweep(case.with_suffix(".zarr"))
    assert study.dataset.sizes["modulus"] == study.dataset.sizes["poisson"] == 2
    assert "max_stress_xx" in study.dataset
    again = run("sweep", case, "--vary", "modulus=1 GPa:4 GPa:2", "--vary", "poisson=[0.3, 0.4]", "--field",
                "max(stress_xx)")  # fmt: skip
    assert again.exit_code == 0
    assert len((case.with_suffix(".zarr") / ".records.jsonl").read_text().splitlines()) == 4


def test_a_table_and_a_sample(case, tmp_path):
    (tmp_path / "cases.csv").write_text("modulus [GPa];poisson\n5,4;0,35\n2;0,25\n")
    done = run("sweep", case, "--table", tmp_path / "cases.csv", "-o", tmp_path / "t.zarr")
    assert done.exit_code == 0, done.output
    assert open_sweep(tmp_path / "t.zarr").dataset["modulus"].to_numpy().tolist() == [5.4e9, 2e9]
    done = run(
        "sweep", case, "--vary", "poisson=0.2:0.4", "--sample", "latin:3", "--seed", "5", "-o", tmp_path / "s.zarr"
    )
    assert done.exit_code == 0, done.output
    assert open_sweep(tmp_path / "s.zarr").dataset.sizes == {"case": 3, "depth": 2}


def test_a_plan_solves_nothing(case):
    done = run("sweep", case, "--vary", "poisson=0.2:0.8:4", "--dry-run")
    # 0.6 and 0.8 are no Poisson's ratios: of a range that is an error before anything is solved.
    assert done.exit_code == 2
    done = run("sweep", case, "--vary", "poisson=0.2:0.4:4", "--dry-run")
    assert done.exit_code == 0, done.output
    assert "cases     4" in done.output
    assert "would be written" in done.output
    assert not case.with_suffix(".zarr").exists()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ((), "nothing is varied"),
        (("--vary", "poisson"), "write key=values"),
        (("--vary", "poison=0.3"), "did you mean 'poisson'"),
        (("--vary", "poisson=0.3", "--field", "presure"), "did you mean 'pressure'"),
        (("--vary", "poisson=0.3", "-o", "x.nc"), "is a folder *.zarr"),
        (("--vary", "poisson=0.3", "--table", "x.csv"), "--table gives all cases"),
        (("--table", "x.csv"), "cannot read x.csv"),
    ],
)
def test_wrong_use_is_one_sentence(case, options, said):
    done = run("sweep", case, *options)
    assert done.exit_code == 2
    assert said in done.stderr
    assert len(done.stderr.splitlines()) == 1


def test_a_study_of_which_all_failed_ends_with_one(case, monkeypatch):
    from treadload.steps import scene

    monkeypatch.setattr(scene, "load_case", lambda *args, **more: 1 / 0)
    done = run("sweep", case, "--vary", "poisson=[0.3, 0.4]")
    assert done.exit_code == 1
    assert "2 cases failed" in done.output


def test_an_interruption_says_how_to_go_on(case, monkeypatch):
    from treadload.sweeps import store

    append, calls = store.Store.append, []

    def stop(self, record):
        append(self, record)
        calls.append(1)
        if len(calls) == 2:
            raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(store.Store, "append", stop)
        done = run("sweep", case, "--vary", "poisson=0.2:0.4:3")
    assert done.exit_code == 130
    assert "interrupted; 2 of 3 cases are kept in" in done.stderr
    assert run("sweep", case, "--vary", "poisson=0.2:0.4:3").exit_code == 0


def test_a_design_case_is_varied_too(tmp_path):
    from treadload.templates import first_case

    design = tmp_path / "design.toml"
    design.write_text(first_case("life"))
    done = run("sweep", design, "--vary", "passes_per_year=1e5:1e6:2", "--dry-run")
    assert done.exit_code == 0, done.output
    assert "traffic.passes_per_year: 100000 to 1e+06" in done.output
    assert json.dumps(tl.Case.from_toml(design).as_tables())
