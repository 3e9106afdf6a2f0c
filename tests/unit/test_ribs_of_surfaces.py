"""Ribs from a scan's meridian and from a height map: walls as they are, the undertread, and what is no rib."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
import trimesh

import treadload as tl
from tire_meshes import RIB_TREAD, lugged_mesh, tire_mesh
from treadload.contact import rib_sections
from treadload.contact.bodies.section_tables import face_table
from treadload.contact.bounds import check_ribs
from treadload.errors import InputError
from treadload.grid import Grid
from treadload.kernels.sections import Section
from treadload.tire.cross_section import TreadSection, interrupted_share, lateral_obstacle, measured_section
from treadload.tire.grooves import Groove, LateralGrooves
from treadload.tire.ribs import ribs_between, section_of
from treadload.tire.unrolled import find_grooves

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
BELT = tl.tire.Belt(tread=tl.Elastic(5.5e6, 0.495), bending=(80, 100, 150))
ON_BELT = {"inflation_pressure": 820e3, "belt": BELT, "tread": "ribs"}
WHEEL = tl.Rolling(normal_load=8e3, friction=0.5)
# Two grooves with leaning walls.
NARROW = tl.tire.TreadProfile(
    0.5, 0.8, 0.12, 0.005, (Groove(-0.02, 0.01, 0.015, 0.2), Groove(0.02, 0.01, 0.015, 0.2))
)


def walls(section):
    """Places of all walls, m, and slopes."""
    return (
        np.array([edge for channel in section.channels for edge in (channel.left, channel.right)]),
        np.array([slope for channel in section.channels for slope in channel.slopes]),
    )


def map_of(profile, step, nx=80, **more):
    """Tire of the height map of a profile on cells of a size, m."""
    grid = Grid.on_lattice(nx * step, profile.width + 0.01, step)
    gap = tl.Tire.from_profile(profile).height_map(grid)
    return tl.Tire.from_height_map(gap, step, **(ON_BELT | more))


@pytest.fixture(scope="module")
def scanned(tmp_path_factory):
    path = tmp_path_factory.mktemp("scan") / "tire.stl"
    trimesh.Trimesh(*tire_mesh(RIB_TREAD, around=720)).export(path)
    return tl.Tire.from_scan(path, units="m", **ON_BELT)


def test_walls_of_a_scan_are_those_of_its_drawing(scanned):
    drawn, measured = section_of(RIB_TREAD), scanned.cross_section
    assert measured.measured
    assert measured.obstacle == ""
    places, slopes = walls(measured)
    expected, drawn_slopes = walls(drawn)
    # Places across lie 0.25 mm apart, and the drawing leans its walls over 0.2 mm besides; they run 2.1 mm.
    assert places == pytest.approx(expected, abs=0.25e-3)
    assert slopes == pytest.approx(drawn_slopes, abs=0.03)
    assert [channel.depth for channel in measured.channels] == pytest.approx([0.015] * 4, abs=0.3e-3)
    # The shoulder ends where the arc turns into the sidewall, 10 mm of rounding inside it.
    assert measured.right == pytest.approx(drawn.right, abs=3e-3)
    assert measured.left == pytest.approx(-measured.right, abs=0.2e-3)


@pytest.mark.slow
def test_a_scan_presses_like_the_profile_that_it_is_of(scanned):
    drawn = tl.Tire.from_profile(RIB_TREAD, **ON_BELT)
    assert len(scanned.ribs) == len(drawn.ribs) == 5
    wheel = tl.Rolling(normal_load=30e3, friction=0.3)
    contacts = [tl.solve_contact(tire, ROAD, wheel, spacing=6e-3) for tire in (scanned, drawn)]
    approach, shear = (
        [float(getattr(np.abs(contact.dataset[name]), how)()) for contact in contacts]
        for name, how in (("approach", "max"), ("traction_y", "sum"))
    )
    assert approach[0] == pytest.approx(approach[1], rel=0.01)
    assert shear[0] == pytest.approx(shear[1], rel=0.05)
    words = " ".join(contacts[0].warnings)
    assert re.search(r"5 mm of rubber below the deepest groove \(1(4\.9|5\.[01]) mm\), which is assumed", words)
    assert "undertread" not in " ".join(contacts[1].warnings)


def test_the_example_mesh_has_the_ribs_that_the_catalogue_states():
    entry = tl.catalogue.tires["335/65R22.5"]
    tire = tl.Tire.from_scan(entry, **ON_BELT)
    assert sum(len(group.faces) for group in tire.ribs) == entry.ribs == 4
    section = tire.cross_section
    # Its outer grooves have an inner wall that is steeper than their outer one, and the tread is its own image.
    (outer, inner), (_, _), (also_inner, also_outer) = (channel.slopes for channel in section.channels)
    assert outer > inner
    assert (also_inner, also_outer) == pytest.approx((inner, outer), abs=0.02)
    assert section.left == pytest.approx(-section.right, abs=1e-3)
    assert tire.carcass.belt.tread_thickness == pytest.approx(section.deepest + 0.005)
    assert tire.quality.interrupted < 1e-3


def test_the_catalogue_says_which_tires_have_ribs():
    rows = {name: words for name, words, _ in tl.catalogue.tires.rows()}
    assert "5 ribs between circumferential grooves" in rows["315/80R22.5"]
    assert "4 ribs between circumferential grooves" in rows["335/65R22.5"]
    profile = tl.catalogue.tires["315/80R22.5"]
    assert replace(profile, grooves=()).ribs == 0
    assert replace(profile, lateral=(LateralGrooves(0.07, 0.01, 0.01),)).ribs == 0


def test_lugs_are_no_ribs(tmp_path):
    vertices, faces, _ = lugged_mesh(around=400, across=61)
    path = tmp_path / "lugs.stl"
    trimesh.Trimesh(vertices, faces).export(path)
    with pytest.raises(InputError, match=r"lateral grooves or sipes interrupt \d+%.*at most 1%.*layer"):
        tl.Tire.from_scan(path, units="m", **ON_BELT)


@pytest.mark.parametrize("step", [1e-3, 2e-3])
def test_a_height_map_is_cut_at_its_grooves(step):
    drawn, cut = section_of(NARROW), map_of(NARROW, step).cross_section
    places, slopes = walls(cut)
    expected, drawn_slopes = walls(drawn)
    assert places == pytest.approx(expected, abs=0.5 * step)
    # A slope is known to about a cell over the depth.
    assert slopes == pytest.approx(drawn_slopes, abs=step / 0.015)
    assert [channel.depth for channel in cut.channels] == pytest.approx([0.015] * 2, abs=0.3e-3)


@pytest.mark.slow
def test_a_height_map_on_ribs_presses_like_its_profile():
    profile = tl.Tire.from_profile(NARROW, **ON_BELT)
    tires = (map_of(NARROW, 4e-3, undertread=0.005), profile)
    contacts = [
        tl.solve_contact(tire, ROAD, WHEEL, spacing=None if tire.fixed_grid else 4e-3).dataset for tire in tires
    ]
    approach, shear = ([float(np.abs(data[name]).sum()) for data in contacts] for name in ("approach", "traction_y"))
    # The map knows walls to half a cell, and its radius by a parabola.
    assert approach[0] == pytest.approx(approach[1], rel=0.03)
    assert shear[0] == pytest.approx(shear[1], rel=0.15)


def test_maps_that_are_not_of_ribs():
    grid = Grid.on_lattice(0.16, 0.13, 2e-3)
    lateral = replace(NARROW, lateral=(LateralGrooves(0.05, 0.006, 0.01),))
    for tread, words in (
        (lateral, r"lateral grooves or sipes interrupt \d+%"),
        (replace(NARROW, grooves=(), lateral=lateral.lateral), "lateral grooves"),
    ):
        gap = tl.Tire.from_profile(tread).height_map(grid)
        with pytest.raises(InputError, match=words):
            tl.Tire.from_height_map(gap, 2e-3, **ON_BELT)
    bare = tl.Tire.from_profile(NARROW).height_map(grid)
    bare[np.abs(np.abs(grid.y) - 0.02) < 3e-3] = np.nan
    with pytest.raises(InputError, match="no floor of its grooves at y = -2"):
        tl.Tire.from_height_map(bare, 2e-3, **ON_BELT)
    with pytest.raises(InputError, match=r"4 x 81 cells, 5 are needed"):
        tl.Tire.from_height_map(bare[:4], 2e-3, **ON_BELT)


def test_a_map_with_ribs_too_narrow_for_its_cells():
    tire = map_of(NARROW, 2e-3)
    check_ribs(tire, 10e-3)
    with pytest.raises(
        InputError, match=r"31 mm wide.*3 cells of 11 mm; a height map .* on cells of 10\.3 mm or less"
    ):
        check_ribs(tire, 11e-3)
    with pytest.raises(InputError, match=r'use spacing = "10 mm"'):
        check_ribs(tl.Tire.from_profile(NARROW, **ON_BELT), 11e-3)


def test_undertread_is_below_the_deepest_groove():
    tire = tl.Tire.from_profile(NARROW, **ON_BELT)
    assert tire.carcass.belt == BELT
    thick = replace(tire, undertread=0.008)
    assert thick.carcass.belt.tread_thickness == pytest.approx(0.023)
    # The neutral line stays where it is below the tread.
    assert thick.carcass.belt.arm == pytest.approx(BELT.arm + 0.003)
    assert replace(tire, undertread=0.0).ribs[1].section.floors == pytest.approx((0.0, 0.0))
    for wrong in (-1e-3, 0.2, math.nan):
        with pytest.raises(InputError, match=r"undertread must lie between 0 and 0\.1 m"):
            replace(tire, undertread=wrong)
    with pytest.raises(InputError, match="this tread is a layer"):
        replace(tire, tread="layer", undertread=0.005)


def test_rubber_that_keeps_its_volume_exactly_is_refused():
    with pytest.raises(InputError, match=r"below 0\.5, got 0\.5.*0\.495"):
        tl.Tire.from_profile(NARROW, **(ON_BELT | {"belt": replace(BELT, tread=tl.Elastic(5.5e6, 0.5))}))


@pytest.mark.slow
def test_each_wall_has_its_own_slope():
    """A section is its mirrored image's image, and a wall that leans more is stiffer on its side alone."""
    upright, leaning = (
        Section(((-0.02, 0.02),), 0.02, (0.005, 0.005), (0.004, 0.004), draft) for draft in (0.0, ((0.0, 0.25),))
    )
    assert leaning.mirrored.mirrored == leaning
    assert leaning.feet == (pytest.approx((-0.02, 0.02375)),)
    assert leaning.mirrored.feet == (pytest.approx((-0.02375, 0.02)),)
    both = Section(((-0.02, 0.02),), 0.02, (0.005, 0.005), (0.004, 0.004), 0.25)
    assert both.drafts == ((0.25, 0.25),)
    ends = np.array([[-0.02, -0.017], [0.017, 0.02]])
    left, right = (
        np.array([
            face_table(section, 0.495).on_cells(ends).at(np.zeros(1))[0].reshape(3, 2, 3, 2)[1, side, 1, side]
            for section in (upright, leaning, both)
        ])
        for side in (0, 1)
    )  # fmt: skip
    assert left[0] == pytest.approx(right[0], rel=1e-6)
    assert right[1] < 0.95 * right[0]
    assert right[1] == pytest.approx(right[2], rel=0.03)
    assert left[1] == pytest.approx(left[0], rel=0.03)


def test_shoulder_ribs_have_upright_outer_walls():
    first, middle, last = ribs_between(section_of(NARROW), 0.020)
    slope = math.tan(0.2)
    assert middle.section.draft == pytest.approx(slope)
    outer = first.section if not first.mirrored else last.section
    assert sorted(outer.drafts[0]) == pytest.approx([0.0, slope])
    assert outer.floors[0] == 0.0
    assert outer.drafts[0][0] == 0.0


def test_ribs_end_where_the_tread_does_and_need_grooves_less_deep():
    section = section_of(NARROW)
    groups = ribs_between(section, 0.020)
    assert groups[0].faces[0][0] == pytest.approx(-0.06)
    assert groups[-1].faces[-1][1] == pytest.approx(0.06)
    with pytest.raises(InputError, match=r"15 mm deep and the tread 14 mm thick.*undertread"):
        ribs_between(section, 0.014)
    smooth = TreadSection(-0.06, 0.06)
    assert [group.faces for group in ribs_between(smooth, 0.02)] == [((-0.06, 0.06),)]


def test_a_curved_wall_becomes_the_straight_one_nearest_to_it():
    y = np.arange(-240, 241) * 0.25e-3
    # The right wall stands upright in its lower half, and leans by a half above.
    depth = np.interp(y, [-0.0101, -0.01, 0.008, 0.0081, 0.01185], [0, 15e-3, 15e-3, 7.5e-3, 0])
    (groove,) = find_grooves(y, -depth, 0.0)
    section = measured_section(y, -depth, [groove], math.inf)
    (channel,) = section.channels
    assert channel.left == pytest.approx(-0.010, abs=0.6e-3)
    assert channel.slopes[0] == pytest.approx(0.0, abs=0.07)
    # Least squares over the middle 70 % of its height: 0 in one half of it, ½ in the other.
    assert channel.slopes[1] == pytest.approx(0.25, abs=0.04)
    # Straight or not, it leaves as much void.
    straight = channel.right - channel.left - 0.5 * channel.depth * sum(channel.slopes)
    assert straight * channel.depth == pytest.approx(np.trapezoid(depth, y), rel=0.05)
    assert len(section.caveats) == 1
    assert "straight line" in section.caveats[0]


def test_interrupted_faces_are_counted_without_grooves_and_noise():
    y, random = np.arange(-60, 60) * 1e-3, np.random.default_rng(2)
    smooth = 0.5 + np.zeros((120, 400)) + random.normal(scale=0.5e-3, size=(120, 400))
    smooth[np.abs(y) < 5e-3] -= 0.015
    grooves = find_grooves(y, np.median(smooth, axis=1), 0.5)
    assert len(grooves) == 1
    assert interrupted_share(y, smooth, grooves) < 1e-3
    cut = smooth.copy()
    cut[:, ::10] -= 0.008
    assert interrupted_share(y, cut, grooves) == pytest.approx(0.1, abs=0.005)
    assert lateral_obstacle(0.1).startswith("lateral grooves")
    assert lateral_obstacle(0.005) == lateral_obstacle(math.nan) == ""


@pytest.mark.parametrize("surface", ["scan", "height_map"])
def test_a_case_gives_ribs_of_a_surface(surface, tmp_path):
    grid = Grid.on_lattice(0.2, 0.3, 2e-3)
    np.save(tmp_path / "map.npy", tl.Tire.from_profile(RIB_TREAD).height_map(grid))
    what = 'scan = "example"' if surface == "scan" else 'height_map = "map.npy"\ncell = "2 mm"'
    text = f"""
[tire]
{what}
inflation_pressure = "8.2 bar"
belt = "315/80R22.5"
tread = "ribs"
undertread = "6 mm"
[[pavement.layers]]
material = {{ kind = "elastic", modulus = "5400 MPa", poisson = 0.35 }}
[rolling]
normal_load = "30 kN"
friction = 0.7
"""
    case = tl.Case.from_text(text, folder=tmp_path)
    tire = case.build_tire()
    assert sum(len(group.faces) for group in tire.ribs) == (4 if surface == "scan" else 5)
    script = tl.steps.case_as_python(case)
    assert "tread='ribs'" in script
    assert "undertread=0.006" in script
    for wrong, words in (
        (text.replace('belt = "315/80R22.5"\n', ""), "needs a belt"),
        (text.replace('tread = "ribs"\n', ""), "undertread"),
    ):
        with pytest.raises(InputError, match=words):
            tl.Case.from_text(wrong, folder=tmp_path)


def test_sections_are_solved_with_a_word_on_each(monkeypatch):
    solved, words = [], []
    monkeypatch.setattr(rib_sections, "face_table", lambda section, poisson: solved.append((section, poisson)))
    tire = tl.Tire.from_profile(NARROW, **ON_BELT)
    rib_sections.prepare_ribs(tire, 3e-3, words.append)
    # Both shoulders share one, the middle rib has its own.
    assert [text.split(" of the ribs")[0] for text in words] == ["cross-section 1 of 2", "cross-section 2 of 2"]
    assert {poisson for _, poisson in solved} == {0.495}
    rib_sections.prepare_ribs(replace(tire, tread="layer"), 3e-3, words.append)
    assert len(solved) == len(words) == 2


@pytest.mark.slow
def test_a_file_keeps_the_ribs_of_a_scan(scanned, tmp_path):
    contact = tl.solve_contact(scanned, ROAD, tl.Rolling(normal_load=30e3, friction=0.3), spacing=8e-3)
    tl.save_results(contact, tmp_path / "scan.nc")
    again = tl.open_results(tmp_path / "scan.nc").contact.tire
    assert again.ribs == scanned.ribs
    assert again.rib_sides == "free"
