"""The meshes that come with treadload and with its tests, against their known dimensions."""

import functools
import math
import time
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from treadload.grid import Grid
from treadload.tire import Tire, example_mesh
from treadload.tire.scan.axis import fit_axis, sample_surface
from treadload.tire.scan.mesh_file import read_mesh

trimesh = pytest.importorskip("trimesh")

MESHES = Path(__file__).parents[1] / "data" / "tire_meshes"
CITY, DURO, SEMI = (MESHES / f"{name}.obj" for name in ("CityBusTire", "Duro_Tire", "SemiTractor_tire"))


@pytest.fixture(scope="module")
def example():
    return Tire.from_scan(example_mesh(), inflation_pressure=820e3)


def test_the_example_comes_with_its_licence():
    beside = {path.name for path in example_mesh().parent.iterdir()}
    assert {"LICENSE_BSD-3-Clause_ProjectChrono.txt", "SOURCE.md"} <= beside


def test_example_dimensions(example):
    quality = example.quality
    assert quality.crown_radius == pytest.approx(0.5046, abs=1e-3)
    assert quality.width == pytest.approx(0.3435, abs=1e-3)
    assert quality.facet_sag == pytest.approx(0.7e-3, abs=0.2e-3)
    assert quality.units == "m"
    assert quality.watertight
    # Facets that cut 0.6 mm raise the peak pressure by 8 %, and the ribs are the same all round.
    assert quality.revolved
    assert quality.noise < 0.01e-3
    assert quality.outliers == ()
    assert quality.coverage > 0.999
    assert [g.width for g in quality.grooves] == pytest.approx([0.017, 0.025, 0.017], abs=2e-3)
    assert [g.centre for g in quality.grooves] == pytest.approx([-0.070, 0, 0.070], abs=1e-3)
    assert all(0.013 <= g.floor <= 0.018 for g in quality.grooves)


def test_example_map(example):
    grid = Grid.centred(0.33, 0.3, 3e-3)
    gap = example.height_map(grid)
    assert np.nanmin(gap) == 0
    # Between facets and circle along the crown of the rib at y = 20 mm.
    row = np.argmin(np.abs(grid.y - 0.020))
    circle = 0.5046 - np.sqrt(0.5046**2 - grid.x**2)
    assert np.abs(gap[row] - gap[row].min() - circle).max() < 1.0e-3
    np.testing.assert_allclose(gap, gap[::-1], atol=1.5e-3 + 0.15 * gap.max())
    floor = gap[np.argmin(np.abs(grid.y)), grid.nx // 2]
    assert floor == pytest.approx(0.0165, abs=1.5e-3)


@pytest.mark.parametrize(("path", "radius", "grooves"), [(CITY, 0.526, 4), (DURO, 0.474, 5)])
def test_other_meshes(path, radius, grooves):
    quality = quality_of(path)
    assert quality.crown_radius == pytest.approx(radius, abs=1e-3)
    assert len(quality.grooves) == grooves
    assert not quality.watertight
    assert quality.revolved
    assert quality.outliers == ()
    if path == CITY:
        assert quality.facet_sag == pytest.approx(2.5e-3, abs=0.2e-3)
        assert any("facets cut 2.5 mm" in text for text in quality.warnings)
        assert [g.depth for g in quality.grooves] == pytest.approx([7.8e-3] * 4, abs=1e-3)


@pytest.mark.parametrize(
    ("path", "radius", "width", "depths"),
    [
        # As the SOURCE.md beside each has them; of the first the floors lie 14 to 17 mm under the crown.
        (example_mesh(), 0.5046, 0.3435, [0.0145, 0.0165, 0.0145]),
        (CITY, 0.526, 0.2945, [0.0078] * 4),
        (DURO, 0.474, 0.275, [0.016] * 5),
        (SEMI, 0.5585, 0.305, []),
    ],
    ids=lambda one: one.stem if isinstance(one, Path) else None,
)
def test_every_mesh_has_its_documented_radius_and_grooves_within_a_millimetre(path, radius, width, depths):
    tire = Tire.from_scan(path)
    quality = tire.quality
    assert quality.crown_radius == pytest.approx(radius, abs=1e-3)
    assert quality.width == pytest.approx(width, abs=1e-3)
    # Those of the first are told below the crown, those of the others at their lower wall: a rounded crown makes one
    # rib beside a groove lower than the other.
    found = [groove.floor if path == example_mesh() else groove.lower_wall for groove in quality.grooves]
    assert found == pytest.approx(depths, abs=1e-3)


def test_grooves_of_the_duro_are_those_of_its_corners():
    """Depth counts from the mean of the ribs beside it, 16.5 to 17.2 mm here; the lower wall is 15.9 to 16.5 mm."""
    points = read_mesh(DURO).vertices
    places = np.unique(np.round(np.stack([points[:, 1], np.hypot(points[:, 0], points[:, 2])], axis=1), 4), axis=0)
    corner = {round(float(y), 4): float(r) for y, r in places if r > 0.44}
    ribs = [(-0.0724, -0.0536), (-0.0441, -0.0253), (-0.0082, 0.0082), (0.0253, 0.0441), (0.0536, 0.0724)]
    floors = [(-0.0645, -0.0546), (-0.0391, -0.028), (-0.0062, 0.0062), (0.028, 0.0391), (0.0546, 0.0645)]
    exact = [
        0.5 * (corner[a] + corner[b] - corner[c] - corner[d]) for (a, b), (c, d) in zip(ribs, floors, strict=True)
    ]
    measured = [groove.depth for groove in quality_of(DURO).grooves]
    # The meridian is read every millimetre, and ribs fall 0.1 mm in one.
    assert measured == pytest.approx(exact, abs=0.2e-3)


@functools.cache
def quality_of(path):
    return Tire.from_scan(path).quality


@pytest.mark.parametrize("path", [example_mesh(), CITY, DURO])
@pytest.mark.parametrize("seed", [1, 2])
def test_pose_and_scale_are_recovered(tmp_path, path, seed):
    mesh = read_mesh(path)
    turn = Rotation.random(random_state=seed).as_matrix()
    shift = np.random.default_rng(seed).normal(size=3)
    moved = 1e3 * (mesh.vertices @ turn.T + shift)
    axis = fit_axis(*sample_surface(moved, mesh.faces))
    off = np.linalg.norm(np.cross(axis.direction, turn[:, 1]))
    assert math.degrees(math.asin(off)) < 0.05
    away = axis.origin * 1e-3 - shift
    assert np.linalg.norm(away - (away @ turn[:, 1]) * turn[:, 1]) < 0.1e-3
    moved_path = tmp_path / "moved.ply"
    trimesh.Trimesh(moved, mesh.faces, process=False).export(moved_path)
    here, there = quality_of(path), Tire.from_scan(moved_path).quality
    assert there.units == "mm"
    assert there.crown_radius == pytest.approx(here.crown_radius, abs=0.2e-3)
    assert there.width == pytest.approx(here.width, abs=0.3e-3)
    assert [g.width for g in there.grooves] == pytest.approx([g.width for g in here.grooves], abs=1e-3)


def test_example_is_fast(example):
    start = time.process_time()
    Tire.from_scan(example_mesh()).height_map(Grid.centred(0.33, 0.3, 3e-3))
    # About 0.7 s on one core; the bound leaves room for a busy or slow machine.
    assert time.process_time() - start < 4.0
