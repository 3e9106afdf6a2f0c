"""The example of pins finds what its table was computed with; that of the mesh has the catalogue's tread."""

import math
import runpy
from pathlib import Path

import numpy as np
import pytest

import treadload as tl
from treadload.catalogue import belts, tires

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.mark.slow
def test_pins(tmp_path, capsys):
    found = runpy.run_path(str(EXAMPLES / "pins" / "run.py"))["main"](tmp_path, spacing=6e-3)
    # Made on cells of 3 mm and fitted on 6 mm: 6.11 MPa and 0.357 for 6 MPa and 0.35.
    assert found["fitted"]["modulus"] == pytest.approx(6e6, rel=0.05)
    assert found["fitted"]["friction"] == pytest.approx(0.35, rel=0.06)
    assert not found["undecided"]
    off = {
        name: float(np.abs(found[name].sel(map="seen") - found[name].sel(map="measured")).mean())
        for name in ("before", "after")
    }
    # On average over the ribs, of an outward shear of 0.2 to 0.3.
    assert off["after"] < 0.02 < off["before"]
    assert "no measurement" in (EXAMPLES / "pins" / "pins.csv").read_text(encoding="utf-8").splitlines()[0]
    assert "lateral shear by thirds" in capsys.readouterr().out
    for name in ("shear.png", "shear_fitted.png", "fit.png"):
        assert (tmp_path / name).stat().st_size > 10_000


def test_the_catalogued_tread_is_that_of_the_mesh():
    pytest.importorskip("trimesh")
    example = runpy.run_path(str(EXAMPLES / "belt" / "mesh_tire.py"))
    shape = example["meridian_of"](tl.example_mesh())
    tread = tires["335/65R22.5 tread"]
    across, off = shape.arc()
    # Corners of the mesh are taken to 0.1 mm.
    assert tread.crown_radius == pytest.approx(across, rel=0.005)
    assert off < 0.4e-3
    assert tread.width == pytest.approx(2 * shape.ribs[-1, 1, 0], abs=0.2e-3)
    grooves = shape.grooves()
    for groove, name in zip(tread.grooves, ("side", "middle", "side"), strict=True):
        centre, width, depth, _ = grooves[name]
        assert abs(groove.centre) == pytest.approx(centre, abs=0.2e-3)
        assert groove.width == pytest.approx(width, abs=0.2e-3)
        assert groove.depth == pytest.approx(depth, abs=0.2e-3)
    walls = (2 * grooves["middle"][3] + 4 * grooves["side"][3]) / 6
    assert math.tan(tread.grooves[0].wall_angle) == pytest.approx(walls, abs=0.002)
    belt = belts["335/65R22.5"]
    crown = float(shape.corners[:, 1].max())
    assert belt.meridional == pytest.approx((crown**2 - shape.widest**2) / (2 * crown), rel=0.01)
    # Five millimetres of undertread below the deepest groove, as assumed.
    assert belt.tread_thickness == pytest.approx(max(groove.depth for groove in tread.grooves) + 5e-3, abs=1e-9)


@pytest.mark.slow
def test_sidewalls_fit_the_measured_deflections(tmp_path):
    example = runpy.run_path(str(EXAMPLES / "belt" / "mesh_tire.py"))
    found = example["main"](tmp_path, spacing=8e-3, treads=("ribs",))
    # Cells of 6 mm give 4.55 ± 0.39 /m and 7.0 % of the load.
    assert found["foundation"]["ribs"] == pytest.approx(belts["335/65R22.5"].foundation, rel=0.03)
    assert found["deviation"]["ribs"] == pytest.approx(0.39, rel=0.2)
    assert found["rms"]["ribs"] < 0.08
    # What the files state as vertical stiffness lies between load over deflection and its slope.
    for secant, slope in found["stiffness"].values():
        assert 0.9 < secant < 1 < slope < 1.25
    assert (tmp_path / "mesh_tire.png").stat().st_size > 10_000
