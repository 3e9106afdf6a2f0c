"""Coarse and lugged meshes without noise: their crown, what is no outlier, and voids that are no grooves."""

import dataclasses
import math

import numpy as np
import pytest

import treadload as tl
from tire_meshes import lattice_faces, lugged_mesh, tire_mesh, write
from treadload.errors import GeometryError, InputError
from treadload.tire import Tire
from treadload.tire.quality import GrooveMeasure


def largest(vertices):
    return float(np.hypot(vertices[:, 0], vertices[:, 2]).max())


@pytest.mark.parametrize("around", [24, 28, 32, 60])
def test_the_crown_of_a_coarse_tread_is_its_largest_vertex(tmp_path, around):
    """Facets of 4.6 mm sag: once 1.5 mm above every vertex."""
    vertices, faces = tire_mesh(around=around)
    quality = Tire.from_scan(write(tmp_path / "tire.off", vertices, faces), units="m").quality
    assert quality.facet_sag == pytest.approx(0.538 * (1 - math.cos(math.pi / around)), rel=0.03)
    # The corners lie on the circle: 0.1 mm for the fit of the axle and for rays beside the corners.
    assert quality.crown_radius == pytest.approx(largest(vertices), abs=1e-4)


@pytest.mark.parametrize("around", [60, 100, 240])
def test_the_crown_of_a_lugged_wheel_is_not_above_its_vertices(tmp_path, around):
    vertices, faces, _ = lugged_mesh(around=around, across=41)
    quality = Tire.from_scan(write(tmp_path / "tire.off", vertices, faces), units="m").quality
    # A lug that few corners show is lower on most of the turn; 0.1 mm for the fit of the axle.
    assert largest(vertices) - 0.3e-3 < quality.crown_radius < largest(vertices) + 1e-4


def test_corners_of_lugs_of_a_clean_mesh_are_no_outliers(tmp_path):
    """60 facets round 20 lugs: 100 corners above the envelope, once refused. With noise they may be errors."""
    vertices, faces, _ = lugged_mesh(around=60, across=41)
    quality = Tire.from_scan(write(tmp_path / "tire.off", vertices, faces), units="m").quality
    assert len(quality.outliers) == 100
    assert any("taken for corners of lugs and kept" in text for text in quality.warnings)
    vertices, faces, _ = lugged_mesh(around=60, across=41, noise=0.3e-3)
    with pytest.raises(GeometryError, match=r"more than the 30 that are taken for errors.*outliers=\"keep\""):
        Tire.from_scan(write(tmp_path / "noisy.off", vertices, faces), units="m")


def test_a_ripple_beside_lugs_is_no_groove(tmp_path):
    """Eight grooves were listed on it, of 2 mm beside voids of 25 mm."""
    vertices, faces, _ = lugged_mesh(around=100, across=41)
    quality = Tire.from_scan(write(tmp_path / "tire.off", vertices, faces), units="m").quality
    assert quality.grooves == ()


def rings(gap, depth, ring=0.03, radius=0.3, count=3, around=180):
    """Ridges round a wheel, m: vertices and faces."""
    width = count * ring + (count - 1) * gap
    starts = -0.5 * width + (ring + gap) * np.arange(count)
    low = radius - depth
    ridges = [
        point for y in starts for point in ((low, y - 1e-4), (radius, y), (radius, y + ring), (low, y + ring + 1e-4))
    ]
    profile = [(low - 0.02, -0.5 * width - 1e-3), *ridges, (low - 0.02, 0.5 * width + 1e-3)]
    angle = 2 * np.pi * np.arange(around) / around
    vertices = np.array([(r * np.cos(a), y, r * np.sin(a)) for r, y in profile for a in angle])
    return vertices, lattice_faces(len(profile), around, closed=True)


@pytest.mark.parametrize(("depth", "met"), [(0.02, True), (0.08, True), (0.154, False)])
def test_ridges_have_grooves_between_them_however_deep(tmp_path, depth, met):
    """Once none at 154 mm, and a land ratio of 100 % from 80 mm on."""
    path = write(tmp_path / "tire.off", *rings(0.02, depth))
    quality = Tire.from_scan(path, units="m").quality
    assert len(quality.grooves) == 2
    # 90 mm of 130 mm; cells of 1 mm at four walls.
    assert quality.land_ratio == pytest.approx(90 / 130, abs=0.02)
    assert [one.width for one in quality.grooves] == pytest.approx([0.02, 0.02], abs=1.5e-3)
    if met:
        assert [one.depth for one in quality.grooves] == pytest.approx([depth, depth], abs=0.2e-3)
    assert any("no ray met the floor" in text for text in quality.warnings) is not met


def test_a_void_too_wide_for_a_groove_is_named_and_is_no_land(tmp_path):
    quality = Tire.from_scan(write(tmp_path / "tire.off", *rings(0.05, 0.02)), units="m").quality
    assert quality.grooves == ()
    assert any("100 mm of the width lie in voids wider than the 45 mm" in text for text in quality.warnings)
    assert quality.land_ratio == pytest.approx(90 / 190, abs=0.02)


def test_shallow_grooves_are_no_land(tmp_path):
    """Grooves of 2.5 mm were listed beside a land ratio of 100 %."""
    quality = Tire.from_scan(write(tmp_path / "tire.off", *rings(0.02, 0.0025)), units="m").quality
    assert len(quality.grooves) == 2
    assert quality.land_ratio == pytest.approx(90 / 130, abs=0.02)


def test_a_small_wheel_is_told_the_bound_and_the_remedy(tmp_path):
    path = write(tmp_path / "tire.off", *rings(0.003, 0.003, ring=0.01, radius=0.034))
    with pytest.raises(InputError, match=r"0\.068 m, outside 0\.2 to 4\.5 m.*scale a model up"):
        Tire.from_scan(path, units="m")


def test_many_grooves_are_one_line():
    quality = Tire.from_scan(tl.example_mesh()).quality
    many = tuple(GrooveMeasure(1e-3 * k, 3e-3, 2e-3 + 1e-5 * k, 2e-3) for k in range(51))
    text = str(dataclasses.replace(quality, grooves=many))
    assert "51 grooves, 2.0 to 2.5 mm deep" in text
    assert "groove at y" not in text
