"""Coarse meshes with points that stand wrong: a tire of the right size, or one sentence."""

import numpy as np
import pytest

from tire_meshes import lattice_faces, write
from treadload.errors import GeometryError, InputError
from treadload.tire import Tire

RADIUS, ROUND = 0.3, 36


def wheel(radius=RADIUS, round_=ROUND):
    """A wheel of 120 mm with side walls, 9 points across."""
    angle = 2 * np.pi * np.arange(round_) / round_
    y = np.linspace(-0.06, 0.06, 7)
    profile = [(0.7 * radius, y[0]), *((radius - 0.4 * v**2, v) for v in y), (0.7 * radius, y[-1])]
    vertices = np.array([(r * np.cos(a), v, r * np.sin(a)) for r, v in profile for a in angle])
    return vertices, lattice_faces(len(profile), round_, closed=True)


@pytest.mark.parametrize("factor", [-1.0, 0.0])
def test_a_point_beyond_the_axle_is_no_facet(tmp_path, factor):
    """The edges of one go through the tire; once they were facets that cut 0.27 m under a circle of 0.3 m."""
    vertices, faces = wheel()
    vertices[4 * ROUND] *= factor
    quality = Tire.from_scan(write(tmp_path / "tire.off", vertices, faces), units="m").quality
    # The crown of this wheel; a facet of 10 degrees cuts 1.1 mm.
    assert quality.crown_radius == pytest.approx(RADIUS, abs=1e-3)
    assert quality.facet_sag == pytest.approx(RADIUS * (1 - np.cos(np.pi / ROUND)), rel=0.01)


def test_facets_that_hide_the_tread_are_refused(tmp_path):
    """A heptagon: 0.6 (1 - cos 180°/7) m."""
    path = write(tmp_path / "tire.off", *wheel(radius=0.6, round_=7))
    with pytest.raises(GeometryError, match=r"cut 59 mm under the circle .* export the mesh finer"):
        Tire.from_scan(path, units="m")


def test_the_tread_itself_has_a_possible_diameter(tmp_path):
    """The axle was fitted to less than the tread; a tire beyond the bound was taken."""
    angle = 2 * np.pi * np.arange(180) / 180
    ring = [(2.246, -0.006), (2.254, -0.005), (2.254, 0.005), (2.246, 0.006)]
    profile = [(2.246, -0.85), *ring, (2.246, 0.85)]
    vertices = np.array([(r * np.cos(a), y, r * np.sin(a)) for r, y in profile for a in angle])
    path = write(tmp_path / "tire.off", vertices, lattice_faces(len(profile), 180, closed=True))
    with pytest.raises(InputError, match=r"an outer diameter of 4.51 m, outside 0.2 to 4.5 m"):
        Tire.from_scan(path, units="m")


def test_a_torn_vertex_is_told(tmp_path):
    """Of two numbers in one line the reader of OBJ makes two for every vertex."""
    vertices, faces = wheel()
    lines = write(tmp_path / "whole.obj", vertices, faces).read_text().splitlines()
    at = next(place for place, line in enumerate(lines) if line.startswith("v "))
    lines[at] = "v 1 2"
    path = tmp_path / "tire.obj"
    path.write_text("\n".join(lines))
    with pytest.raises(InputError, match=r"'tire\.obj' has 2 numbers per vertex"):
        Tire.from_scan(path, units="m")
