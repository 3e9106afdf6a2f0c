"""Networks: sections of a table, their remaining lives and their ranks; a study of lives behind them."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import treadload as tl
from sweeps import same
from treadload.errors import InputError
from treadload.life import contacts
from treadload.life.seasons import warmed
from treadload.reporting.network import network_tables
from treadload.sweeps import open_sweep, read_sections, solve_network
from treadload.sweeps.network.solution import bands
from treadload.sweeps.network.solve import network_of, ranks_of

CASE = """
title = "two roads"
spacing = "20 mm"
tire = { profile = "315/80R22.5" }
climate = { temperature = 15 }
[[pavement.layers]]
name = "asphalt"
thickness = "12 cm"
material = { kind = "elastic", modulus = "5400 MPa", poisson = 0.35 }
[[pavement.layers]]
name = "base"
thickness = "25 cm"
material = { kind = "elastic", modulus = "300 MPa", poisson = 0.35 }
[[pavement.layers]]
name = "soil"
material = { kind = "elastic", modulus = "60 MPa", poisson = 0.4 }
[traffic]
passes_per_year = 1e4
years = 20
[[traffic.classes]]
name = "axle"
share = 1
axle_load = "100 kN"
inflation_pressure = "8 bar"
[[criteria]]
name = "bottom-up"
law = "fatigue-line"
layer = "lowest asphalt layer"
place = "bottom"
epsilon_6 = "120 microstrain"
slope = -0.2
[[criteria]]
name = "soil"
law = "french-subgrade"
layer = "top of the subgrade"
constant = 0.012
"""
TABLE = """section;lane;station [km];age [years];thickness asphalt [mm];modulus soil [MPa]
A;1;0.0;4;120;60
A;2;0.5;4;80;60
B;1;1.5;30;100;45
B;1;2.0;3;;60
C;1;2.5;2.5.1;120;60
D;1;x;2;120;60
E;1;3.0;1990;120;60
F;1;3.5;2;-20;60
"""


@pytest.fixture
def case():
    return tl.Case.from_text(CASE)


@pytest.fixture
def table(tmp_path):
    path = tmp_path / "sections.csv"
    path.write_text(TABLE)
    return path


def test_sections_are_ranked_and_bad_rows_fail_alone(case, table, tmp_path):
    network = solve_network(case, table, ids=["lane"])
    data = network.dataset
    names = [str(name) for name in data["section"].to_numpy()]
    assert names == ["A 1", "A 2", "B 1 (row 4)", "B 1 (row 5)", "C 1", "D 1", "E 1", "F 1"]
    assert data["section_status"].to_numpy().tolist() == [1, 1, 1, 2, 2, 2, 2, 2]
    assert data["section_position"].to_numpy()[:4].tolist() == [0, 500, 1500, 2000]
    reasons = [str(text) for text in data["reason"].to_numpy()]
    assert reasons[:3] == [""] * 3
    assert reasons[3] == "no value of thickness asphalt; give a thickness of 0 where the layer is absent"
    assert reasons[4].startswith("age: ")
    assert reasons[5].startswith("station: ")
    assert "[0, 200] years" in reasons[6]
    assert "in place of a year" in reasons[6]
    assert "thickness" in reasons[7]
    # The same numbers as a life of its own.
    thin = CASE.replace("12 cm", "80 mm")
    life = tl.run(tl.Case.from_text(thin)).life
    assert data["life_years"].to_numpy()[1].tolist() == life.dataset["life_years"].to_numpy().tolist()
    years = data["life_years"].to_numpy()[:3]
    assert data["governing_years"].to_numpy()[:3].tolist() == years.min(axis=1).tolist()
    governing = [str(name) for name in data["governing_criterion"].to_numpy()[:3]]
    assert governing == [("bottom-up", "soil")[k] for k in years.argmin(axis=1)]
    remaining = years.min(axis=1) - [4, 4, 30]
    assert data["remaining_years"].to_numpy()[:3] == pytest.approx(remaining, rel=1e-12)
    assert network.ranked == tuple(np.array(names)[:3][np.argsort(remaining)])
    assert network.remaining("B 1 (row 4)") == pytest.approx(remaining[2])
    with pytest.raises(InputError, match="section 'F 1' failed"):
        network.remaining("F 1")
    with pytest.raises(InputError, match="there is no section 'Z'"):
        network.remaining("Z")
    text = network.text()
    assert "3 solved, 5 failed" in text
    assert "none (ended" in text
    assert "2 of 3 sections have no remaining life" in " ".join(network.warnings)
    assert f"1. {network.ranked[0]}" in text
    assert "5 of 8 sections failed: B 1 (row 5), C 1, D 1, E 1, F 1" in " ".join(network.warnings)
    opened = tl.open_results(tl.save_results(network, tmp_path / "n.nc")).network
    assert opened.ranked == network.ranked
    assert opened.text() == text


ABSENT = """section;length [km];age [years];thickness asphalt [mm];thickness base [mm];modulus base [MPa]
A;0.5;4;120;250;300
B;1;30;80;0;
C;1.5;30;80;;
D;;30;0.0;250;300
E;2;30;100;;300
F;-2;30;100;250;300
"""


def test_sections_without_a_layer_are_solved_without_it(case, tmp_path):
    path = tmp_path / "s.csv"
    path.write_text(ABSENT)
    network = solve_network(case, path)
    data = network.dataset
    assert data["section_status"].to_numpy().tolist() == [1, 1, 1, 1, 2, 2]
    years = data["life_years"].to_numpy()
    # As the road that is written without it.
    base = CASE.index('[[pavement.layers]]\nname = "base"')
    without = CASE[:base] + CASE[CASE.index('[[pavement.layers]]\nname = "soil"') :]
    life = tl.run(tl.Case.from_text(without.replace("12 cm", "80 mm"))).life
    assert years[1].tolist() == years[2].tolist() == life.dataset["life_years"].to_numpy().tolist()
    # No asphalt, no criterion of it; the others decide.
    assert np.isnan(years[3, 0])
    assert years[3, 1] > 0
    words = " ".join(network.warnings)
    assert "criterion 'bottom-up' is not evaluated: the road has no lowest asphalt layer" in words
    assert "asphalt in 1 section(s), such as D; base in 2 section(s), such as B" in words
    reasons = [str(text) for text in data["reason"].to_numpy()]
    assert reasons[4] == "no value of thickness base; give a thickness of 0 where the layer is absent"
    assert "length must be above 0" in reasons[5]
    # Sections B and C have no life left, D has no length.
    text = network.text()
    assert "2.5 km at their end or beyond" in text
    assert "3 km in all" in text
    assert "1 solved sections have no length, such as D" in words
    assert "0.5 km" in [row[2] for row in network_tables(data)[0].rows]
    opened = tl.open_results(tl.save_results(network, tmp_path / "n.nc")).network
    assert opened.text() == text


SEASONAL = """[climate]
seasons = [
    { name = "thaw", share = 0.2, temperature = [5, 5, 5], factors = { base = 0.5, soil = 0.6 } },
    { name = "rest", share = 0.8, temperature = 15 },
]"""


def test_what_a_climate_states_of_an_absent_layer_is_left_out():
    climate = "climate = { temperature = 15 }"
    mix = CASE.replace('material = { kind = "elastic", modulus = "5400 MPa", poisson = 0.35 }', 'mix = "EB-GB3"')
    text = mix.replace(climate, SEASONAL)
    whole = tl.Case.from_text(text).build_climate().seasons[0]
    assert whole.factors == (("base", 0.5), ("soil", 0.6))
    without = tl.Case.from_text(text.replace('"25 cm"', "0")).build_climate().seasons[0]
    assert without.factors == (("soil", 0.6),)
    assert without.temperature == (5.0, 5.0)
    # The name of no layer is still refused.
    wrong = tl.Case.from_text(text.replace('"25 cm"', "0").replace("factors = { base", "factors = { bass"))
    with pytest.raises(InputError, match="factor of the layer 'bass'"):
        warmed(wrong.road(), (), wrong.build_climate().seasons[0])
    frost = """[climate]
air = { months = [-9, -7, -1, 6, 12, 16, 19, 17, 12, 6, -1, -7] }
parts_of_day = 1
frost = { layers = { base = { water = 0.08 } } }"""
    frozen = tl.Case.from_text(mix.replace(climate, frost).replace('"25 cm"', "0")).build_climate()
    assert {name for season in frozen.seasons for name, _ in season.factors} == {"soil"}


def test_a_layer_of_no_thickness_is_absent_in_any_case():
    absent = CASE.replace('"25 cm"', "0").replace('layer = "top of the subgrade"', "layer = 3")
    case = tl.Case.from_text(absent)
    assert [layer.name for layer in case.road().layers] == ["asphalt", "soil"]
    assert [criterion.layer for criterion in case.build_criteria()] == [0, 1]
    named = tl.Case.from_text(absent.replace("layer = 3", 'layer = "Base"'))
    assert [criterion.name for criterion in named.build_criteria()] == ["bottom-up"]
    assert named.left_out == ("criterion 'soil' is not evaluated: the road has no Base",)
    with pytest.raises(InputError, match=r"no criterion is left.*'bottom-up', 'soil'"):
        tl.Case.from_text(absent.replace('"12 cm"', "0").replace("layer = 3", "layer = 2"))


def test_a_table_without_ages_and_places_counts_all_sections_as_new(case, tmp_path):
    path = tmp_path / "s.csv"
    path.write_text("id;thickness asphalt [mm]\nA;120\nB;60\n")
    network = solve_network(case, path)
    assert np.isnan(network.dataset["section_position"].to_numpy()).all()
    assert (network.dataset["remaining_years"] == network.dataset["governing_years"]).all()
    assert any("no column age" in text for text in network.warnings)
    assert network.plot.stations().axes[0].get_xlabel() == "section, in the order of the table"
    assert [table.columns[2] for table in network_tables(network.dataset)] == ["remaining life"]


def test_figures_and_tables_of_a_network(case, table, tmp_path):
    network = solve_network(case, table, ids=["lane"])
    stations = network.plot.stations()
    axes = stations.axes[0]
    assert axes.get_xlabel() == "station (km)"
    drawn = np.sort(np.concatenate([line.get_xdata() for line in axes.lines if line.get_marker() in ("o", "^")]))
    assert drawn.tolist() == [0, 0.5, 1.5]
    due = network.plot.due().axes[0]
    past = int((network.dataset["remaining_years"] <= 0).sum())
    assert any(f"{past} now" in text.get_text() for text in due.texts) or f"{past} now" in due.get_title(loc="left")
    first, failed = network_tables(network.dataset)
    assert [row[0] for row in first.rows] == ["1", "2", "3"]
    assert first.rows[0][1] == network.ranked[0]
    assert "km" in first.rows[0][2]
    assert len(failed.rows) == 5
    page = tl.report(network, tmp_path / "n.html").read_text(encoding="utf-8")
    assert "Sections by remaining life" in page
    assert page.index(network.ranked[0]) < page.index(network.ranked[-1])
    for _, reason in failed.rows:
        assert reason.replace("'", "&#39;").partition("'")[0][:20] in page


def test_a_network_of_which_nothing_was_solved_draws_nothing(case, tmp_path):
    path = tmp_path / "s.csv"
    path.write_text("id;age;thickness asphalt [mm]\nA;-1;120\nB;300;60\n")
    network = solve_network(case, path)
    assert network.ranked == ()
    assert "2 failed" in network.text()
    with pytest.raises(InputError, match="no section was solved"):
        network.plot.stations()


@pytest.mark.parametrize(
    ("head", "said"),
    [
        ("id;position;modulus soil", r"column 'position' needs its unit.*position \[km\]"),
        ("id;age [months];modulus soil", r"is in years, got \[months\]"),
        ("id;age [years]", "varies nothing"),
        ("id;modulus sole", "no layer has the name 'sole'; did you mean 'soil'"),
    ],
)
def test_wrong_tables_are_refused(case, tmp_path, head, said):
    path = tmp_path / "s.csv"
    path.write_text(f"{head}\nA;1;6e7\n" if head.count(";") == 2 else f"{head}\nA;1\n")
    with pytest.raises(InputError, match=said):
        read_sections(case, path)


def test_only_a_design_case_makes_a_network(table):
    from treadload.templates import first_case

    with pytest.raises(InputError, match=r"needs a design case.*treadload init life.*`treadload run`"):
        solve_network(tl.Case.from_text(first_case("run")), table)
    study = tl.sweep(tl.Case.from_text(CASE), {"modulus soil": [5e7, 6e7]})
    with pytest.raises(InputError, match="the study has 2 cases, the table 8 sections"):
        network_of(study, read_sections(tl.Case.from_text(CASE), table, ids=["lane"]))


def test_ranks_and_bands():
    remaining = np.array([3.0, np.nan, -2.0, np.inf, 0.0, 5.0, 21.0])
    assert ranks_of(remaining).tolist() == [3, 0, 1, 6, 2, 4, 5]
    counts = [count for _, count in bands(remaining[[0, 2, 3, 4, 5, 6]])]
    assert counts == [2, 2, 0, 0, 2]


def test_contacts_are_solved_once_for_all_sections_of_one_surface(case, monkeypatch):
    solved = []
    original = contacts.contact_in_state
    monkeypatch.setattr(
        contacts, "contact_in_state", lambda *args, **more: solved.append(1) or original(*args, **more)
    )
    rows = [{"thickness asphalt": deep, "passes_per_year": passes} for deep, passes in ((0.1, 1e4), (0.2, 2e4))]
    tl.sweep(case, rows)
    assert len(solved) == 1
    # Another material of the surface, another pressure: contacts of their own, and the numbers of a life alone.
    keys = {"modulus asphalt": [4e9, 4e9 * (1 + 1e-14)], "traffic.classes.0.inflation_pressure": [8e5, 9e5]}
    study = tl.sweep(case, keys)
    assert len(solved) == 1 + 4
    alone = tl.run(tl.Case.from_text(CASE.replace("5400 MPa", "4 GPa").replace("8 bar", "9 bar"))).life
    assert (study.dataset["life_years"].to_numpy()[0, 1] == alone.dataset["life_years"].to_numpy()).all()


@pytest.mark.slow
def test_a_killed_network_goes_on_and_solves_nothing_twice(case, tmp_path):
    pytest.importorskip("zarr")
    (tmp_path / "sections.toml").write_text(CASE)
    rows = [f"S{k};{80 + 5 * k};{50 + k}" for k in range(16)]
    (tmp_path / "sections.csv").write_text("\n".join(["id;thickness asphalt [mm];modulus soil [MPa]", *rows]) + "\n")
    command = [sys.executable, "-m", "treadload", "network", "sections.csv", "--quiet"]
    killed = subprocess.Popen(command, cwd=tmp_path, env={**os.environ}, start_new_session=True)
    journal = tmp_path / "sections.zarr" / ".records.jsonl"
    until = time.monotonic() + 60
    while time.monotonic() < until and (not journal.exists() or len(journal.read_text().splitlines()) < 5):
        time.sleep(0.02)
    os.killpg(killed.pid, signal.SIGKILL)
    assert killed.wait() != 0
    before = [json.loads(line) for line in journal.read_text().splitlines() if line.endswith("}")]
    assert 5 <= len(before) < 16
    assert not (tmp_path / "sections.html").exists()
    done = subprocess.run(command, cwd=tmp_path, env={**os.environ}, capture_output=True, text=True, check=True)
    assert "16 solved" in done.stdout
    after = [json.loads(line) for line in journal.read_text().splitlines()]
    assert after[: len(before)] == before
    assert len(after) <= 17
    whole = solve_network(case, Path(tmp_path / "sections.csv"))
    assert same(open_sweep(tmp_path / "sections.zarr").dataset, tl.sweep(case, read_sections(
        case, tmp_path / "sections.csv").design).dataset)  # fmt: skip
    assert f"1. {whole.ranked[0]}" in done.stdout
