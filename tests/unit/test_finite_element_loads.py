"""Loads of finite elements: sums of forces in the text, and the reactions that CalculiX finds."""

import re
import shutil
import subprocess

import numpy as np
import pytest
import xarray as xr

import treadload as tl
from treadload.errors import InputError
from treadload.results.elements import write_elements

DX, DY = 4e-3, 5e-3


@pytest.fixture(scope="module")
def patch():
    """Pressure and both shears on some cells, Pa."""
    rng = np.random.default_rng(1)
    x, y = DX * (np.arange(6) - 2.5), DY * (np.arange(5) - 1.0)
    pressure = rng.uniform(2e5, 9e5, (5, 6)) * (rng.random((5, 6)) < 0.7)
    shear = [rng.uniform(-2e5, 3e5, (5, 6)) * (pressure > 0) for _ in "xy"]
    fields = {"pressure": pressure, "traction_x": shear[0], "traction_y": shear[1]}
    return xr.Dataset({name: (("y", "x"), values) for name, values in fields.items()}, {"x": x, "y": y})


def numbers_below(text, keyword):
    """Rows of numbers below a keyword."""
    part = re.search(rf"^\*{keyword}[^\n]*\n((?:[^*][^\n]*\n)*)", text, re.MULTILINE)[1]
    return [[word.strip() for word in line.split(",")] for line in part.splitlines()]


def forces_of(patch):
    return [float(patch[name].sum()) * DX * DY for name in ("traction_x", "traction_y", "pressure")]


@pytest.mark.parametrize("pressure", ["faces", "nodes"])
@pytest.mark.parametrize(("units", "per_m", "per_pa"), [("mm", 1e3, 1e-6), ("SI", 1.0, 1.0)])
def test_sums_of_forces_and_moments_are_those_of_the_contact(patch, tmp_path, pressure, units, per_m, per_pa):
    """Ten digits are written, and the sums are of some forty numbers."""
    mesh, loads = write_elements(patch, tmp_path / "a.inp", units=units, pressure=pressure, first=11)
    assert loads.name == "a_loads.inp"
    text, steps = mesh.read_text(), loads.read_text()
    nodes = {
        int(row[0]): np.array(row[1:], dtype=float) for row in numbers_below(text, "NODE, NSET=TREADLOAD_SURFACE")
    }
    elements = {int(row[0]): [int(word) for word in row[1:]] for row in numbers_below(text, "ELEMENT")}
    assert len(elements) == int((patch.pressure > 0).sum())
    assert min(nodes) == min(elements) == 11
    at_node = {number: np.zeros(3) for number in nodes}
    for number, component, value in numbers_below(steps, "CLOAD"):
        at_node[int(number)][int(component) - 1] += float(value)
    if pressure == "faces":
        for number, face, value in numbers_below(steps, "DLOAD"):
            assert face == "P1"
            for node in elements[int(number)][:4]:
                at_node[node][2] += 0.25 * float(value) / per_pa * DX * DY
    total = sum(at_node.values())
    np.testing.assert_allclose(total, forces_of(patch), rtol=1e-8)
    moment = sum(np.cross(nodes[number], force) for number, force in at_node.items()) / per_m
    p, qx, qy = (patch[name].to_numpy() for name in ("pressure", "traction_x", "traction_y"))
    x, y = np.meshgrid(patch.x, patch.y)
    wanted = DX * DY * np.array([(y * p).sum(), (-x * p).sum(), (x * qy - y * qx).sum()])
    np.testing.assert_allclose(moment, wanted, rtol=1e-7, atol=1e-9)


def test_of_a_solved_contact_and_at_the_command_line(coarse_result, tmp_path):
    from typer.testing import CliRunner

    from treadload.cli import app

    saved = tl.save_results(coarse_result.to_tree(), tmp_path / "r.nc")
    ran = CliRunner().invoke(app, ["export", str(saved), "-o", str(tmp_path / "print.inp"), "--units", "mm"])
    assert ran.exit_code == 0, ran.output
    head = (tmp_path / "print_loads.inp").read_text().splitlines()[2]
    said = [float(word) for word in re.findall(r"[xyz] (-?[\d.e+-]+)", head)]
    data = coarse_result.contact.dataset
    # The tire drives: it pushes the road back.
    assert said == pytest.approx(
        [-float(data.tractive_force), -float(data.lateral_force), float(data.normal_load)], rel=1e-5, abs=0.1
    )


def test_what_cannot_be_written(patch, tmp_path):
    for wrong, says in (({"units": "inch"}, "inch"), ({"first": 0}, "1 to 100000000"), ({"pressure": "all"}, "all")):
        with pytest.raises(InputError, match=says):
            write_elements(patch, tmp_path / "a.inp", **wrong)
    with pytest.raises(InputError, match="no cell"):
        write_elements(0 * patch, tmp_path / "a.inp")
    with pytest.raises(InputError, match="pressure of a contact"):
        write_elements(patch.drop_vars("pressure"), tmp_path / "a.inp")
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX (ccx) is not installed")
@pytest.mark.parametrize("pressure", ["faces", "nodes"])
def test_calculix_reads_both_files_and_finds_the_reactions(patch, tmp_path, pressure):
    """Nodes of the lower face are held; their reactions are the forces of the contact, to the digits it prints."""
    write_elements(patch, tmp_path / "a.inp", units="mm", pressure=pressure)
    deck = """*INCLUDE, INPUT=a.inp
*MATERIAL, NAME=M
*ELASTIC
5000., 0.35
*SOLID SECTION, ELSET=TREADLOAD_PATCH, MATERIAL=M
*BOUNDARY
TREADLOAD_BOTTOM, 1, 3
*STEP
*STATIC
*INCLUDE, INPUT=a_loads.inp
*NODE PRINT, NSET=TREADLOAD_BOTTOM, TOTALS=ONLY
RF
*END STEP
"""
    (tmp_path / "deck.inp").write_text(deck)
    ran = subprocess.run(["ccx", "deck"], cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False)
    told = (tmp_path / "deck.dat").read_text()
    assert ran.returncode == 0, ran.stdout[-1500:]
    reactions = [float(word) for word in re.findall(r"-?\d\.\d+E[+-]\d+", told.split("total force")[1])[-3:]]
    np.testing.assert_allclose(reactions, [-force for force in forces_of(patch)], rtol=2e-6)
