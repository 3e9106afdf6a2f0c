"""CONTRIBUTING shows the package of `examples/plugin`; here each of its seven things does its work."""

import json
import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest

import treadload as tl
from cases import COARSE_CASE, ONE_AXLE
from packages import build, forget
from tire_meshes import tire_mesh
from treadload.app.result_rows import rows_of
from treadload.app.unsolved import unsolved
from treadload.case import Case

CLONE = Path(__file__).parents[2]
PLUGIN = CLONE / "examples" / "plugin"
MODULES = {path.stem: path.read_text("utf-8") for path in (PLUGIN / "road_laws").glob("*.py") if path.stem[0] != "_"}
PROJECT = tomllib.loads((PLUGIN / "pyproject.toml").read_text("utf-8"))["project"]
PAGE = (CLONE / "CONTRIBUTING.md").read_text("utf-8")


@pytest.fixture
def road_laws(tmp_path, monkeypatch):
    declared = "".join(
        f"[{group}]\n" + "".join(f"{name} = {place}\n" for name, place in points.items())
        for group, points in PROJECT["entry-points"].items()
    )
    build(tmp_path / "site", "road_laws", declared, version="1.0", **MODULES)
    monkeypatch.syspath_prepend(str(tmp_path / "site"))
    yield
    forget("road_laws")


def test_the_page_shows_the_package_as_it_is():
    shown = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    assert set(MODULES) == {"material", "layer", "friction", "criterion", "reader", "body", "step"}
    assert all(text in shown for text in MODULES.values())
    assert (PLUGIN / "pyproject.toml").read_text("utf-8") in re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)


def swapped(*changes):
    text = COARSE_CASE
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return text


ASPHALT = 'material = { kind = "elastic", modulus = "5400 MPa", poisson = 0.35 }'
LAYERS = (
    'thickness = "6 cm"\nmaterial = { kind = "softening", modulus = "7000 MPa", decade = "25 K" }\n'
    '[[pavement.layers]]\nmaterial = { kind = "soil", cbr = "5 %" }'
)


def test_a_material_and_a_layer_law_of_a_package(road_laws):
    text = swapped(
        (ASPHALT, LAYERS), ("[[pavement.layers]]\nname", "[pavement]\ntemperature = 40\n[[pavement.layers]]\nname")
    )
    case = Case.from_text(text)
    assert Case.from_text(case.to_toml()) == case
    top, below = (layer.material for layer in case.pavement.build().layers)
    # 25 K above the reference of 15 °C are one decade.
    assert (top.modulus, top.poisson) == pytest.approx((700e6, 0.35))
    assert below == tl.Elastic(17.6e6 * 5**0.64, 0.4)
    with pytest.raises(tl.InputError, match=r"measured from -10 to 40 °C, got 41 °C"):
        Case.from_text(text.replace("temperature = 40", "temperature = 41")).pavement.build()


def test_a_friction_law_of_a_package(road_laws):
    law = 'friction = { law = "rubber-power", coefficient_there = 0.7, pressure = "600 kPa" }'
    result = tl.run(Case.from_text(swapped(("friction       = 0.7", law))))
    data = result.contact.dataset
    pressure = data.pressure.to_numpy()
    touching = pressure > 0
    expected = np.minimum(0.7 * (pressure[touching] / 6e5) ** (-1 / 3), 1.5)
    np.testing.assert_allclose(data.friction_coefficient.to_numpy()[touching], expected, rtol=1e-9)
    assert "falling with its power 0.33" in result.to_tree()["contact"].attrs["rolling"]


def test_a_criterion_of_a_package(road_laws):
    table = '[[criteria]]\nname = "{}"\nlayer = "EB-GB3"\nlaw = "{}"\nepsilon_6 = "100 microstrain"\n{}\n'
    text = (
        ONE_AXLE
        + table.format("ours", "fatigue-line", "slope = -0.2")
        + table.format("theirs", "test-track", "power = 5\nshift = 2")
    )
    result = tl.run(Case.from_text(text), leave_out=("sensitivity",))
    ours, theirs = result.life.dataset.life_years.to_numpy()
    assert theirs == pytest.approx(2 * ours, rel=1e-9)
    assert "test track, power 5" in result.summary() + str(result.to_tree()["life"].attrs)


def test_a_body_of_a_package(road_laws, tmp_path):
    x = 2e-3 * (np.arange(80) - 39.5)
    gap = np.broadcast_to(x[None, :] ** 2, (12, 80)).copy()
    gap[[0, -1]] = np.nan
    np.savetxt(tmp_path / "map.csv", gap, delimiter=",")
    (tmp_path / "case.toml").write_text(
        '[tire]\nheight_map = "map.csv"\ncell = "2 mm"\n'
        'material = { kind = "bristles", normal_stiffness = "40 MPa/m", shear_stiffness = "20 MPa/m" }\n'
        '[[pavement.layers]]\nmaterial = { modulus = "1e10 MPa", poisson = 0.35 }\n'
        '[rolling]\napproach = "4 mm"\nfriction = 0\n'
    )
    case = Case.from_toml(tmp_path / "case.toml")
    found = tl.solve_contact(case.build_tire(), case.pavement.build(), case.build_rolling()).dataset
    # A bed of springs: no cell feels another. The road is a millionth as compliant.
    exact = 4e7 * np.maximum(4e-3 - (x**2 - x[39] ** 2), 0.0)
    np.testing.assert_allclose(found.pressure[5], exact, atol=1e-5 * exact.max())


@pytest.mark.slow
def test_a_reader_of_a_package(road_laws, tmp_path):
    points, faces = tire_mesh()
    (tmp_path / "wheel.jmesh").write_text(json.dumps({"vertices": points.tolist(), "faces": faces.tolist()}))
    text = swapped(('profile = "315/80R22.5"', 'scan = "wheel.jmesh"\nunits = "m"'))
    tire = Case.from_text(text, folder=tmp_path).build_tire()
    assert tire.quality is not None
    (tmp_path / "torn.jmesh").write_text("?")
    with pytest.raises(tl.InputError, match=r"could not be read by the reader 'jmesh' of the package road-laws 1\.0"):
        tl.Tire.from_scan(tmp_path / "torn.jmesh")


STEP = swapped(("[response]", "[carrying]\nshare = 0.6\n[response]"))


def test_a_step_of_a_package_is_run_planned_and_summed_up(road_laws, tmp_path):
    case = Case.from_text(STEP)
    assert Case.from_text(case.to_toml()) == case
    result = tl.run(case)
    pressure = result.contact.dataset["pressure"].sum("y").to_numpy()
    count = round(float(result.carrying.dataset["carrying_length"]) / float(result.contact.dataset.attrs["dx"]))
    carried = np.sort(pressure)[::-1].cumsum() / pressure.sum()
    assert carried[count - 1] >= 0.6 > carried[count - 2]
    assert "carrying length" in result.summary()
    assert "60 % of the load" in result.summary()
    assert tl.plan(case)
    with pytest.raises(tl.InputError, match=r"share must lie in \(0, 1\), got 1.2"):
        Case.from_text(STEP.replace("share = 0.6", "share = 1.2"))
    with pytest.raises(tl.InputError, match=r"unknown key 'carrying\.shar'; did you mean 'share'"):
        Case.from_text(STEP.replace("share = 0.6", "shar = 0.6"))


def test_a_step_of_a_package_is_swept(road_laws):
    study = tl.sweep(Case.from_text(STEP), {"carrying.share": [0.3, 0.6]})
    short, long = study.dataset["carrying_length"].to_numpy()
    assert 0 < short < long


@pytest.mark.slow
def test_a_step_of_a_package_is_run_by_the_command_opened_in_a_fresh_process_and_reported(road_laws, tmp_path):
    (tmp_path / "case.toml").write_text(STEP, encoding="utf-8")
    source = str(Path(tl.__file__).parents[1])
    path = os.pathsep.join([str(tmp_path / "site"), source])
    environment = {**os.environ, "PYTHONPATH": path}
    command = [sys.executable, "-m", "treadload"]
    for words in (["run", "case.toml"], ["report", "case.nc", "-o", "report.html"]):
        done = subprocess.run(
            [*command, *words], cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr
    opened = "import treadload as tl; print(tl.open_results('case.nc').carrying.rows()[0].text)"
    done = subprocess.run(
        [sys.executable, "-c", opened], cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
    )
    assert re.fullmatch(r"\d+ mm\n", done.stdout), done.stderr
    page = (tmp_path / "report.html").read_text("utf-8")
    assert "Carrying length" in page
    assert "Load along travel" in page
    # Without the package the file opens; its part is named.
    bare = {**environment, "PYTHONPATH": source}
    done = subprocess.run(
        [sys.executable, "-c", opened.replace("rows()[0].text", "warnings")],
        cwd=tmp_path, env=bare, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert "no installed package has the class 'CarryingLength'" in done.stdout


def test_a_step_of_a_package_is_on_the_page(road_laws):
    case = Case.from_text(STEP)
    assert unsolved(case) == []
    parts = tl.run(case).parts
    labels = [row["label"] for row in rows_of(parts)]
    assert "carrying length" in [label.lower() for label in labels]
