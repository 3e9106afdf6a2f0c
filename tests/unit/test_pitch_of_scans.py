"""Blocks of scans: lugs as the mesh has them, grooves cut into measured ribs, what is refused."""

import math
import time

import numpy as np
import pytest

import treadload as tl
from tire_meshes import lugged_mesh, tire_mesh, write
from treadload.contact import Rolling, solve_pitch
from treadload.errors import InputError
from treadload.tire import Tire
from treadload.tire.belt import Belt
from treadload.tire.grooves import LateralGrooves
from treadload.tire.lugs import lugged_tread

BELT = Belt(tread=tl.Elastic(5e6, 0.49), tread_thickness=0.02)
RADIUS, LUGS, SHARE, DEPTH = 0.35, 30, 0.6, 0.015


def lugged(tmp_path, angle, **options):
    made = {"lugs": LUGS, "share": SHARE, "depth": DEPTH, "overlap": -0.004, "angle": angle} | options
    vertices, faces, _ = lugged_mesh(around=720, across=61, **made)
    path = write(tmp_path / "lugs.ply", vertices, faces)
    return Tire.from_scan(path, units="m", inflation_pressure=4e5, belt=BELT)


def test_lugs_of_a_scan_are_those_of_its_mesh(tmp_path):
    angle = 30
    tread = lugged_tread(lugged(tmp_path, angle))
    pitch = 2 * math.pi * RADIUS / LUGS
    # The crown's radius of the scan: 0.1 mm.
    assert tread.pattern.period == pytest.approx(pitch, rel=1e-3)
    assert len(tread.pattern.blocks) == 2
    left, right = sorted(tread.pattern.blocks, key=lambda block: block.y)
    for block in (left, right):
        corners = np.array(block.block.corners)
        # Walls run over 2 mm and samples stand 1.5 mm apart.
        assert np.linalg.norm(corners[1] - corners[0]) == pytest.approx(SHARE * pitch, abs=1.5e-3)
        assert np.ptp(corners[:, 1]) == pytest.approx(0.12 - 0.004, abs=4e-3)
        lean = (corners[3, 0] - corners[0, 0]) / np.ptp(corners[:, 1])
        # Of the left and of the right row the other way; the scan decides which of both comes first.
        assert abs(lean) == pytest.approx(math.tan(math.radians(angle)), abs=0.02)
        floors = sorted(block.block.floors)
        # Free beside the tread, and 5 mm of undertread in the voids.
        assert floors[0] == 0
        assert floors[1:] == pytest.approx([0.005] * 3, abs=0.3e-3)
    # Staggered by half a pitch.
    assert (right.x - left.x) % pitch == pytest.approx(0.5 * pitch, abs=1.5e-3)
    # The gap is that of the tops: of a circle.
    x = np.linspace(-0.04, 0.04, 5)
    y = np.array([0.04, 0.045])
    gap = tread.gap(x, y)
    circle = RADIUS - np.sqrt(RADIUS**2 - x**2)
    np.testing.assert_allclose(gap[0] - gap[0, 2], circle, atol=0.2e-3)


@pytest.mark.slow
def test_scans_without_blocks_of_their_own(tmp_path):
    with pytest.raises(InputError, match="endless along travel; give `lateral`"):
        # Rows that meet over the middle and run into each other.
        lugged_tread(lugged(tmp_path, 45, overlap=0.03, lugs=20, share=0.3))
    ribs = Tire.from_scan(write(tmp_path / "ribs.ply", *tire_mesh()[:2]), inflation_pressure=8e5, belt=BELT)
    with pytest.raises(InputError, match="no lateral voids: its ribs are endless"):
        lugged_tread(ribs)
    deep = lugged(tmp_path, 0, depth=0.021)
    with pytest.raises(InputError, match="21 mm deep and the tread 20 mm thick"):
        lugged_tread(deep)


@pytest.mark.slow
def test_measured_ribs_that_grooves_cut_roll_through_a_pitch(tmp_path):
    path = write(tmp_path / "ribs.ply", *tire_mesh()[:2])
    tire = Tire.from_scan(path, inflation_pressure=8e5, belt=BELT)
    road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    passage = solve_pitch(
        tire, road, Rolling(normal_load=30e3, friction=0.7), lateral=[LateralGrooves(0.07, 0.01, 0.012)],
        spacing=0.01, positions=4,
    )  # fmt: skip
    data = passage.dataset
    assert data.attrs["change"] <= 0.01
    np.testing.assert_allclose(data.normal_load, 30e3, rtol=1e-9)
    # A groove of 10 mm in a pitch of 70 mm takes a seventh of the area, but blocks that may bulge are softer than the
    # layer, and the contact is longer.
    smooth = tl.solve_contact(tire, road, Rolling(normal_load=30e3, friction=0.7), spacing=0.01)
    ratio = float(data.contact_area.mean()) / smooth.area
    assert 0.8 < ratio < 1.15


@pytest.mark.slow
def test_one_pitch_of_the_example_mesh_stays_within_its_bounds():
    """335/65R22.5 with lateral grooves every 70 mm, 12 positions: a minute of two cores, periodic to 1 %."""
    tire = Tire.from_scan(tl.catalogue.tires["335/65R22.5"], inflation_pressure=8.2e5, belt=BELT)
    road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    wheel = Rolling(normal_load=35e3, friction=0.7, creepage_x=-0.01, creepage_y=0.005)

    def passage(periodic):
        return solve_pitch(
            tire,
            road,
            wheel,
            lateral=[LateralGrooves(0.07, 0.01, 0.012)],
            spacing=6e-3,
            positions=12,
            periodic=periodic,
        ).dataset

    began = time.process_time()
    data = passage(0.01)
    # A minute of two cores; 34 s of one processor where it was measured last.
    assert time.process_time() - began < 120
    assert data.sizes["position"] == 12
    assert data.attrs["change"] <= 0.01
    np.testing.assert_allclose(data.normal_load, 35e3, rtol=1e-9)
    settled = passage(1e-3)
    for name in ("tractive_force", "lateral_force"):
        last = settled[name].to_numpy()
        # The wheel pulls and steers by more than 2 % of what friction can bear.
        assert np.abs(last).max() > 0.02 * 0.7 * 35e3
        np.testing.assert_allclose(data[name], last, rtol=0, atol=0.01 * np.abs(last).max())
