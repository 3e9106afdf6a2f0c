"""Lugged wheels: extent from the envelope, roundness between lugs, the map of the lugs themselves."""

import math

import numpy as np
import pytest
from typer.testing import CliRunner

import treadload as tl
from tire_meshes import lugged_mesh, pose, write
from treadload.case import Case
from treadload.cli import app
from treadload.errors import GeometryError, InputError
from treadload.grid import Grid
from treadload.tire import Tire

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
WHEELS = {
    "a truck's lugs, diameter 700 mm": {},
    "bars across": {"angle": 0, "lugs": 18, "overlap": 0.12},
    "thin grousers": {"angle": 0, "lugs": 16, "share": 0.06, "overlap": 0.12},
    "a tractor's deep voids": {"radius": 0.8, "width": 0.5, "depth": 0.055},
    "a robot's wheel": {"radius": 0.12, "width": 0.08, "depth": 0.008, "lugs": 14, "overlap": 0.01},
}


def lugged(tmp_path, seed=None, **options):
    vertices, faces, radius = lugged_mesh(around=600, across=61, **options)
    if seed is not None:
        turn, shift = pose(seed)
        vertices = vertices @ turn.T + shift
    return write(tmp_path / "lugs.ply", vertices, faces), radius


@pytest.mark.parametrize("wheel", WHEELS)
def test_a_lugged_wheel_is_as_wide_as_its_lugs(tmp_path, wheel):
    made = {"radius": 0.35, "width": 0.24, **WHEELS[wheel]}
    path, _ = lugged(tmp_path, seed=3, **WHEELS[wheel])
    tire = Tire.from_scan(path, units="m")
    quality = tire.quality
    # The extent has margins, and holds the sidewalls down to 30 mm under the crown.
    assert made["width"] - 5e-3 < tire.extent[1] < made["width"] + 0.09
    # Lugs 3 mm of whose edges are slopes, seen every degree: 0.3 mm.
    assert quality.crown_radius == pytest.approx(made["radius"], abs=0.3e-3)
    assert not quality.revolved
    assert quality.outliers == ()
    assert not any("facets" in text for text in quality.warnings)
    # Beyond the ends of the lugs the shoulder drops as steeply as rays go: nothing that a warning tells.
    assert quality.coverage > 0.98


def test_the_map_of_lugs_is_that_of_the_lugs(tmp_path):
    path, radius = lugged(tmp_path)
    grid = Grid.centred(0.12, 0.2, 4e-3)
    gap = Tire.from_scan(path).height_map(grid)
    # The file's -z is down; its right side lies along +y, so that travel points along -x.
    theta = (np.arange(radius.shape[1]) + 0.5) * 2 * np.pi / radius.shape[1]
    x, z = radius * np.sin(theta), radius * np.cos(theta)
    rows = np.linspace(-0.12, 0.12, radius.shape[0])
    close = []
    for row, y in enumerate(grid.y):
        at = np.argmin(np.abs(rows - y))
        down = z[at] < 0
        order = np.argsort(-x[at][down])
        low = np.interp(grid.x, -x[at][down][order], -z[at][down][order])
        close.append(np.abs((0.35 - low) - gap[row]))
    # Walls of lugs fall 25 mm over 2 mm, and rows of the mesh lie 4 mm apart: four fifths of the map are off them.
    assert np.quantile(np.array(close), 0.8) < 0.3e-3


def test_a_truck_tire_with_lugs_carries_5_kn(tmp_path):
    path, _ = lugged(tmp_path)
    tire = Tire.from_scan(path, inflation_pressure=300e3)
    contact = tl.solve_contact(tire, ROAD, tl.Rolling(normal_load=8e3, friction=0.5))
    assert float(contact.dataset.normal_load) == pytest.approx(8e3, rel=1e-5)
    y = contact.dataset.y.values[(contact.dataset.pressure > 0).any("x").values]
    # Both rows of lugs carry, beyond the 30 mm over which they overlap in the middle.
    assert y.min() < -0.04
    assert y.max() > 0.04


@pytest.mark.slow
def test_voids_deeper_than_grooves_are_no_holes(tmp_path):
    path, _ = lugged(tmp_path, radius=0.8, width=0.5, depth=0.055)
    quality = Tire.from_scan(path, units="m").quality
    assert quality.hole_fraction < 0.02
    # The contact itself is not stopped for holes between its lugs, which were 36 % of it.
    gap = Tire.from_scan(path, units="m", fill_holes=False).height_map(Grid.centred(0.3, 0.4, 0.01))
    assert np.nanmin(gap) < 2e-3


@pytest.mark.slow
def test_an_oval_wheel_says_how_to_take_it_as_it_is(tmp_path):
    vertices, faces, _ = lugged_mesh(around=600, across=41)
    oval = write(tmp_path / "oval.ply", vertices * np.array([1.06, 1, 1]), faces)
    with pytest.raises(GeometryError, match=r"not round.*roundness=0\.0\d.*--roundness") as refused:
        Tire.from_scan(oval)
    allowed = float(str(refused.value).split("roundness=")[1].split(" ")[0])
    assert Tire.from_scan(oval, roundness=allowed).quality.crown_radius == pytest.approx(0.36, abs=0.02)
    done = CliRunner().invoke(app, ["scan", str(oval)])
    assert done.exit_code == 2
    assert "--roundness" in done.stderr
    done = CliRunner().invoke(app, ["scan", str(oval), "--roundness", str(allowed)])
    assert done.exit_code == 0, done.output
    for bad in (-0.1, math.nan, 3, "round"):
        with pytest.raises(InputError, match="roundness must lie between 0 and 1"):
            Tire.from_scan(oval, roundness=bad)


def test_the_command_reads_lugs(tmp_path):
    path, _ = lugged(tmp_path, angle=0, lugs=18, overlap=0.12)
    done = CliRunner().invoke(app, ["scan", str(path), "-o", str(tmp_path / "h.nc"), "--spacing", "10 mm"])
    assert done.exit_code == 0, done.output
    assert tl.Tire.from_height_map(tmp_path / "h.nc").fixed_grid.ny * 0.01 > 0.24


@pytest.mark.slow
def test_a_case_takes_every_option_of_a_scan(tmp_path):
    path, _ = lugged(tmp_path)
    text = f"""
tire = {{ scan = "{path}", inflation_pressure = "3 bar", smooth = "4 mm", outliers = "keep", roundness = 0.05 }}
pavement = {{ layers = [{{ material = {{ kind = "elastic", modulus = "5 GPa", poisson = 0.35 }} }}] }}
rolling = {{ normal_load = "5 kN", friction = 0.5 }}
response = {{ depths = [0] }}
"""
    tire = Case.from_text(text, name="lugs.toml").tire.build(tmp_path)
    assert tire.quality.smoothing == 4e-3
    with pytest.raises(InputError, match="smooth"):
        Case.from_text(text.replace('"4 mm"', '"a lot"'), name="lugs.toml").tire.build(tmp_path)


def test_revolving_lugs_says_what_it_does(tmp_path):
    path, _ = lugged(tmp_path)
    quality = Tire.from_scan(path, revolve=True).quality
    assert any("loses what changes" in text for text in quality.warnings)
    # What is left is the carcass between the lugs, which cover three tenths of the turn.
    assert quality.crown_radius < 0.35 - 0.01 or quality.revolved


def test_coarse_lugs_get_advice_that_helps(tmp_path):
    vertices, faces, _ = lugged_mesh(around=120, across=21, lugs=6, share=0.6, wall=0.02)
    path = write(tmp_path / "coarse.ply", vertices, faces)
    told = [text for text in Tire.from_scan(path).quality.warnings if "facets" in text]
    assert told
    assert "use a finer mesh" in told[0]
    assert "revolve=True" not in told[0]


def test_the_land_ratio_of_lugs_is_the_share_of_the_turn_that_they_cover(tmp_path):
    vertices, faces, radius = lugged_mesh(share=0.35)
    quality = Tire.from_scan(write(tmp_path / "lugs.ply", vertices, faces), units="m").quality
    # 3 mm below the tops, of a crown that falls by half a square of the place across.
    half = 0.12
    y = np.linspace(-half, half, radius.shape[0])
    exact = float((radius > (0.35 - y**2 / 2)[:, None] - 3e-3).mean())
    assert quality.land_ratio == pytest.approx(exact, abs=0.04)
