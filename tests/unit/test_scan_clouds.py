"""Clouds of points, scans of a part of the turn, clutter, and what is no tire."""

import math
import os
import re
import struct
from dataclasses import replace

import numpy as np
import pytest
import trimesh

import treadload as tl
from fuzz.e57_files import put_together, taken_apart, written
from tire_meshes import RIB_TREAD, pose, tire_mesh, write
from treadload.errors import GeometryError, InputError
from treadload.grid import Grid
from treadload.tire import Tire
from treadload.tire.scan.axis import sample_surface
from treadload.tire.scan.e57_file import scan_points
from treadload.tire.scan.panics import without_backtrace

CONTACT = Grid.centred(0.15, 0.25, 3e-3)
FLOORS = np.array([np.abs(CONTACT.y - g.centre) < 0.5 * g.width - 3e-3 for g in RIB_TREAD.grooves]).any(axis=0)


def cloud(points=150_000, noise=0.3e-3, arc=120, seed=7):
    """Points of a ribbed tire in any pose, m; the tread is RIB_TREAD."""
    at, _ = sample_surface(*tire_mesh(around=720, arc=math.radians(arc)), points)
    turn, shift = pose(seed)
    return (at + np.random.default_rng(seed).normal(scale=noise, size=at.shape)) @ turn.T + shift


def las(path, points):
    laspy = pytest.importorskip("laspy")
    header = laspy.LasHeader(point_format=0, version="1.2")
    header.scales, header.offsets = [1e-5] * 3, points.mean(axis=0)
    file = laspy.LasData(header)
    file.x, file.y, file.z = points.T
    file.write(path)
    return path


def e57(path, points):
    pye57 = pytest.importorskip("pye57")
    with pye57.E57(str(path), mode="w") as file:
        file.write_scan_raw({f"cartesian{axis}": points[:, k].copy() for k, axis in enumerate("XYZ")})
    return path


def text(path, points, separator=" ", heading=""):
    np.savetxt(path, points, fmt="%.6f", delimiter=separator, header=heading, comments="")
    return path


def ply(path, points):
    trimesh.PointCloud(points).export(path)
    return path


@pytest.mark.slow
def test_a_cloud_of_a_third_of_a_tire_gives_radius_grooves_and_gap(tmp_path):
    tire = Tire.from_scan(text(tmp_path / "cloud.xyz", 1e3 * cloud(300_000)), units="mm")
    quality = tire.quality
    assert quality.crown_radius == pytest.approx(0.538, abs=0.3e-3)
    # Floors 8 mm wide under points 2 mm apart, whose noise is 0.3 mm.
    assert [g.depth for g in quality.grooves] == pytest.approx([0.015] * 4, abs=1e-3)
    assert [g.centre for g in quality.grooves] == pytest.approx([g.centre for g in RIB_TREAD.grooves], abs=0.5e-3)
    exact = RIB_TREAD.gap(CONTACT.x, CONTACT.y)
    edges = np.array([np.abs(np.abs(CONTACT.y - g.centre) - 0.5 * g.width) < 4e-3 for g in RIB_TREAD.grooves])
    rib = np.isfinite(exact) & (exact < 0.012) & (np.abs(CONTACT.y) < 0.128)[:, None] & ~edges.any(axis=0)[:, None]
    error = (tire.height_map(CONTACT) - exact)[rib]
    # The median of two points to a cell has 0.2 mm of noise.
    assert abs(np.median(error)) < 0.15e-3
    assert np.sqrt(np.mean(error**2)) < 0.4e-3


@pytest.mark.slow
def test_every_format_of_clouds_gives_the_same_tire(tmp_path):
    points = cloud(40_000, arc=60)
    files = [
        ply(tmp_path / "a.ply", points),
        text(tmp_path / "a.xyz", points),
        text(tmp_path / "a.csv", np.hstack([points, points]), ",", "x,y,z,r,g,b"),
        las(tmp_path / "a.las", points),
        las(tmp_path / "a.laz", points),
        e57(tmp_path / "a.e57", points),
    ]
    from treadload.registry import READERS
    from treadload.tire.scan import cloud_file, mesh_file

    assert cloud_file.READERS is READERS
    for path in files:
        read, faces = mesh_file._read(READERS.find(path.suffix[1:]), path)
        assert len(faces) == 0, path.name
        # A LAS file counts hundredths of a millimetre, PLY of trimesh holds single precision of lengths of 2 m.
        np.testing.assert_allclose(read, points, atol=1e-5, err_msg=path.name)
    quality = Tire.from_scan(files[-1], units="m").quality
    assert quality.crown_radius == pytest.approx(0.538, abs=1.5e-3)
    assert any("less than 90°" in text for text in quality.warnings)


def test_points_at_few_places_are_no_tire(tmp_path):
    """Below twelve places there were no neighbours to lay a plane through."""
    places = np.random.default_rng(1).normal(size=(6, 3))
    with pytest.raises(GeometryError, match="are at 6 places, too few"):
        Tire.from_scan(text(tmp_path / "cloud.xyz", np.tile(places, (200, 1))), units="m")


def test_a_tread_without_width_has_no_more_cells_than_any_other(monkeypatch):
    """A ring, of which a hundredth is scanned a million times as densely: its cells were to fill 17 GB."""
    from treadload.tire.scan import cloud as laid

    turn = np.concatenate([np.linspace(0, 2 * np.pi, 2000), np.linspace(1.0, 1.0 + 1e-5, 10_000)])
    asked = []
    cells = laid._cells
    monkeypatch.setattr(laid, "_cells", lambda *given: (asked.append(given[4]), cells(*given))[1])
    points = np.stack([np.sin(turn), 1e-9 * np.sin(7 * turn), np.cos(turn)], axis=1)
    laid.mesh_of_points(points, "ring")
    assert asked[0] <= 2 * laid.MOST_CELLS


@pytest.mark.parametrize("noise", [0.3e-3, 2e-3])
def test_less_than_45_degrees_is_refused(tmp_path, noise):
    vertices, faces = tire_mesh(arc=math.radians(40), noise=noise, flipped=0.3, seed=2)
    with pytest.raises(GeometryError) as told:
        Tire.from_scan(write(tmp_path / "tire.ply", vertices, faces), units="m")
    if noise < 1e-3:
        assert "at least 45°" in str(told.value)


@pytest.mark.slow
def test_half_of_the_cells_of_grooves_come_back_from_the_same_groove(tmp_path):
    vertices, faces = tire_mesh(around=720, across=120, noise=0.3e-3, flipped=0.3, arc=math.radians(120), seed=4)
    at = vertices[faces].mean(axis=1)
    radius = np.hypot(at[:, 0], at[:, 2])
    depth = RIB_TREAD.rolling_radius - RIB_TREAD.drop(at[:, 1]).clip(0, 0.01) - radius
    deep = (depth > 3e-3) & (np.abs(at[:, 1]) < 0.13)
    along = np.arctan2(at[:, 0], at[:, 2]) * 0.538
    cell = np.floor(along / 5e-3) * 64 + np.floor(at[:, 1] / 5e-3)
    _, number = np.unique(cell, return_inverse=True)
    gone = deep & (np.random.default_rng(1).random(number.max() + 1) < 0.5)[number]
    path = write(tmp_path / "tire.ply", vertices, faces[~gone])
    gap = Tire.from_scan(path, units="m").height_map(CONTACT)
    error = (gap - RIB_TREAD.gap(CONTACT.x, CONTACT.y))[FLOORS]
    assert np.isfinite(error).all()
    # The bound of half a millimetre is for the floors; 0.14 mm was measured.
    assert np.sqrt(np.mean(error**2)) < 0.5e-3
    raw = Tire.from_scan(path, units="m", fill_holes=True).height_map(CONTACT)
    np.testing.assert_array_equal(raw, gap)


def test_a_known_length_gives_the_scale(tmp_path):
    vertices, faces = tire_mesh(around=180, across=60)
    path = write(tmp_path / "tire.ply", 0.7431 * vertices, faces)
    quality = Tire.from_scan(path, scale=1 / 0.7431).quality
    assert quality.units == "reference"
    assert quality.crown_radius == pytest.approx(0.538, rel=3e-4)
    with pytest.raises(InputError, match="not both"):
        Tire.from_scan(path, scale=1.0, units="m")
    with pytest.raises(InputError, match="positive number of m"):
        Tire.from_scan(path, scale=-1.0)


@pytest.mark.slow
def test_pieces_apart_from_the_tire_are_left_out(tmp_path):
    vertices, faces = tire_mesh(around=180, across=60)
    stand = trimesh.creation.box((0.5, 0.3, 0.4)).subdivide().subdivide()
    stand.apply_translation((0.9, 0.0, 0.2))
    both = trimesh.util.concatenate([trimesh.Trimesh(vertices, faces, process=False), stand])
    quality = Tire.from_scan(write(tmp_path / "tire.ply", both.vertices, both.faces), units="m").quality
    assert quality.crown_radius == pytest.approx(0.538, abs=0.5e-3)


@pytest.mark.parametrize("shift", [(0, 0.36, 0), (1.3, 0, 0)])
def test_two_tires_are_refused(tmp_path, shift):
    vertices, faces = tire_mesh(around=180, across=60)
    both = np.concatenate([vertices, vertices + np.array(shift)])
    path = write(tmp_path / "tires.ply", both, np.concatenate([faces, faces + len(vertices)]))
    with pytest.raises(GeometryError, match="two pieces of like size beside each other"):
        Tire.from_scan(path, units="m")


@pytest.mark.parametrize("how", [{"units": "m"}, {"nominal_diameter": 1.076}])
def test_a_car_is_refused(tmp_path, how):
    body = trimesh.creation.box((4.2, 1.4, 1.8)).subdivide().subdivide().subdivide()
    roof = trimesh.creation.box((2.0, 0.6, 1.5)).subdivide().subdivide()
    roof.apply_translation((0, 1.0, 0))
    wheels = []
    for x in (-1.3, 1.3):
        for z in (-0.9, 0.9):
            wheel = trimesh.creation.cylinder(0.32, 0.2, sections=60)
            wheel.apply_translation((x, -0.7, z))
            wheels.append(wheel)
    car = trimesh.util.concatenate([body, roof, *wheels])
    with pytest.raises(GeometryError, match="not round"):
        Tire.from_scan(write(tmp_path / "car.ply", car.vertices, car.faces), **how)


def test_files_that_are_not_what_they_say(tmp_path):
    points = cloud(2_000)
    good = las(tmp_path / "a.las", points).read_bytes()
    packed = las(tmp_path / "a.laz", points).read_bytes()
    start = struct.unpack_from("<I", packed, 96)[0]
    table = struct.unpack_from("<q", packed, start)[0]
    billion = struct.pack("<I", 1_900_000_000)
    for name, content, told in [
        ("half.las", good[: len(good) // 2], "truncated|has"),
        ("many.las", good[:107] + struct.pack("<I", 2**31) + good[111:], "between 1 and"),
        ("records.las", good[:100] + struct.pack("<I", 2**31) + good[104:], "header"),
        # The unpacker of LAZ would reserve 30 GB for these, and end the process.
        ("chunks.laz", packed[: table + 4] + billion + packed[table + 8 :], "1900000000 chunks"),
        (
            "table.laz",
            packed[:start] + struct.pack("<q", 2**40) + packed[start + 8 :],
            "no table of its packed points",
        ),
        ("tail.laz", packed[: table + 2], "no table of its packed points"),
        ("text.las", b"1 2 3\n" * 500, "does not begin with a LAS header"),
        ("binary.xyz", good, "is not text"),
        ("words.xyz", b"hello\nworld\n", "no line of three numbers"),
        ("comma.xyz", b"1,5 2,5 3,5\n" * 2000, "decimal points|usable|plane|points"),
        ("cut.xyz", b"1 2 3\n" * 2000 + b"1 2", "no point x y z"),
        ("few.xyz", b"1 2 3\n" * 20, "fewer than the 1000"),
        ("text.e57", b"1 2 3\n" * 500, "does not begin with an E57 header"),
        ("cut.e57", b"ASTM-E57" + bytes(2000), "truncated or damaged"),
        ("empty.laz", b"", "empty"),
        ("same.xyz", b"1 2 3\n" * 2000, "no tire in any unit"),
    ]:
        (tmp_path / name).write_bytes(content)
        with pytest.raises((InputError, GeometryError), match=told):
            Tire.from_scan(tmp_path / name, units="m")


def test_poses_of_e57_are_read_by_name_and_points_are_counted(tmp_path):
    """The order of the children of a structure means nothing (ASTM E2807); pye57 takes it as w, x, y, z."""
    pytest.importorskip("pye57")
    points = np.random.default_rng(1).uniform(-1, 1, (1200, 3)).astype(np.float32).astype(float)
    turn = np.array([np.cos(0.3), np.sin(0.3), 0.0, 0.0])
    fields = {f"cartesian{axis}": points[:, k].copy() for k, axis in enumerate("XYZ")}
    sections, xml = taken_apart(written([fields], [(turn, np.array([1.0, 2.0, 3.0]))]))
    parts = re.search(rb"( *<w .*\n)((?: *<[xyz] .*\n)+)", xml)
    c, s = np.cos(0.6), np.sin(0.6)
    wanted = points @ np.array([[1, 0, 0], [0, c, -s], [0, s, c]]).T + [1, 2, 3]
    path = tmp_path / "a.e57"
    for text in (xml, xml.replace(parts[0], parts[2] + parts[1])):
        path.write_bytes(put_together(sections, text))
        # Coordinates are written in single precision, the pose in double.
        np.testing.assert_allclose(scan_points(path, 10**6), wanted, rtol=0, atol=1e-6)
    for old, new, says in (
        (b'recordCount="1200"', b'recordCount="1300"', "declares 1300 points and has 1200"),
        (b'recordCount="1200"', b'recordCount="40000000"', "40000000 points in"),
        (b"<w ", b"<w type='Float'>9</w><v ", "could not be read as E57"),
    ):
        path.write_bytes(put_together(sections, xml.replace(old, new)))
        with pytest.raises(InputError, match=says):
            scan_points(path, 10**9)
    longer = re.sub(rb"(<w [^>]*>)[^<]*", rb"\g<1>1.5", xml)
    path.write_bytes(put_together(sections, longer))
    with pytest.raises(InputError, match=r"quaternion of the length 1\.52883"):
        scan_points(path, 10**6)


def test_a_panic_of_the_library_that_unpacks_prints_nothing(tmp_path, capfd):
    """Its backtrace goes to the descriptor of stderr; the sentence is all that a reader needs."""
    packed = bytearray(las(tmp_path / "a.laz", cloud(2_000)).read_bytes())
    record = struct.unpack_from("<H", packed, 94)[0] + 54
    for at, why in ((32, "at least one"), (36, "mid > len|non-zero")):
        damaged = bytearray(packed)
        # The number of parts of a packed point, and the size of the first.
        damaged[record + at] = 0
        (tmp_path / "b.laz").write_bytes(damaged)
        with pytest.raises(InputError, match=f"could not be read as LAZ .*({why}).*; it may be truncated"):
            Tire.from_scan(tmp_path / "b.laz", units="m")
        printed = capfd.readouterr()
        assert (printed.out, printed.err) == ("", "")
    with without_backtrace():
        os.write(2, b"a warning\n")
    with pytest.raises(OSError, match="descriptor"), without_backtrace():
        os.write(-os.write(2, b"before an error\n"), b"")
    assert capfd.readouterr().err == "a warning\nbefore an error\n"


@pytest.mark.slow
def test_meshes_as_photogrammetry_writes_them(tmp_path):
    """Texture coordinates split at seams, a material that is missing, colours, a scrap apart, any scale."""
    vertices, faces = tire_mesh(around=180, across=60)
    turn, shift = pose(5)
    at = 0.3127 * (vertices @ turn.T + shift)
    lines = ["mtllib textured.mtl", "usemtl skin"]
    corners = at[faces].reshape(-1, 3)
    # Every corner of every triangle is a vertex of its own, as where a texture is cut up wholly.
    lines += [f"v {x:.7f} {y:.7f} {z:.7f} 0.5 0.4 0.3" for x, y, z in corners]
    lines += [f"vt {k % 97 / 97:.4f} {k % 89 / 89:.4f}" for k in range(len(corners))]
    lines += [f"f {k}/{k} {k + 1}/{k + 1} {k + 2}/{k + 2}" for k in range(1, len(corners), 3)]
    (tmp_path / "textured.obj").write_text("\n".join(lines))
    textured = Tire.from_scan(tmp_path / "textured.obj", scale=1 / 0.3127).quality
    scrap = trimesh.creation.icosphere(2, 0.02)
    scrap.apply_translation(at.mean(axis=0))
    mesh = trimesh.util.concatenate([trimesh.Trimesh(at, faces, process=False), scrap])
    mesh.visual.vertex_colors = np.full((len(mesh.vertices), 4), 200, dtype=np.uint8)
    mesh.export(tmp_path / "coloured.ply")
    coloured = Tire.from_scan(tmp_path / "coloured.ply", nominal_diameter=1.076).quality
    for quality in (textured, coloured):
        # Within 0.03 %: the bound of a scale from one known length.
        assert quality.crown_radius == pytest.approx(0.538, rel=3e-4)
        assert len(quality.grooves) == 4
    assert textured.n_points == len(np.unique(faces))


def worn_by(worn):
    """The tread with ribs, evenly worn by a depth, m."""
    grooves = (
        replace(g, depth=g.depth - worn, width=g.width - 2 * worn * math.tan(g.wall_angle)) for g in RIB_TREAD.grooves
    )
    return replace(RIB_TREAD, rolling_radius=RIB_TREAD.rolling_radius - worn, grooves=tuple(grooves))


@pytest.mark.slow
def test_what_was_worn_off(tmp_path):
    from treadload.plots import save
    from treadload.plots.scan import scan as drawn
    from treadload.results.scanned import scan_fields, scan_wear

    worn = 4e-3
    now = worn_by(worn)
    tires = []
    for k, (tread, arc) in enumerate([(RIB_TREAD, 360), (now, 150)]):
        vertices, faces = tire_mesh(tread, noise=0.2e-3, arc=math.radians(arc), around=500)
        turn, shift = pose(k)
        tires.append(Tire.from_scan(write(tmp_path / f"{k}.ply", vertices @ turn.T + shift, faces), units="m"))
    old, new = tires
    gone = scan_wear(new, old)
    assert gone.mean == pytest.approx(worn, abs=0.1e-3)
    assert gone.uneven < 0.2e-3
    assert abs(gone.datum) < 0.1e-3
    assert [before - after for _, before, after in gone.grooves] == pytest.approx([worn] * 4, abs=0.2e-3)
    data = scan_fields(new, old, spacing=6e-3)
    assert float(data.worn.median()) == pytest.approx(worn, abs=0.1e-3)
    figure = drawn(data)
    save(figure, tmp_path / "scan.png")
    unrolled, _, tops, over = figure.axes[:4]
    # An even wear is not one colour: the scale lies about it. What was scanned fills the panel, right is below.
    low, high = unrolled.collections[0].get_clim()
    assert low < 1e3 * worn < high
    assert high - low < 2
    assert 75 < tops.get_xlim()[1] - tops.get_xlim()[0] - 75 < 110
    assert unrolled.yaxis_inverted()
    assert over.yaxis_inverted()
    save(drawn(scan_fields(new, spacing=6e-3)), tmp_path / "alone.png")
    assert (tmp_path / "scan.png").stat().st_size > 30_000


@pytest.mark.slow
def test_the_command_scales_both_scans_and_writes_the_wear(tmp_path):
    from typer.testing import CliRunner

    from treadload.cli import app
    from treadload.files import read_tree

    worn = 3e-3
    now = worn_by(worn)
    # As two reconstructions from photographs leave them: each in a unit of its own.
    for name, tread, unit in (("now", now, 0.731), ("then", RIB_TREAD, 0.912)):
        vertices, faces = tire_mesh(tread, around=240, across=60)
        write(tmp_path / f"{name}.ply", unit * vertices, faces)
    asked = ["scan", str(tmp_path / "now.ply"), "--known-length", "0.731 = 1000 mm", "--spacing", "10 mm", "--quiet"]
    both = [*asked, "--reference", str(tmp_path / "then.ply")]
    output = tmp_path / "tread.nc"
    done = CliRunner().invoke(app, [*both, "--reference-length", "0.912 = 1000 mm", "-o", str(output)])
    assert done.exit_code == 0, done.output
    tree = read_tree(output, "NetCDF-4")
    gap, data = tree.to_dataset(), tree["wear"].to_dataset()
    assert set(gap.data_vars) == {"initial_gap"}
    # Facets of 1.5° lie 0.05 mm under the circle in both.
    assert float(data.median_tread_wear.median()) == pytest.approx(worn, abs=0.1e-3)
    assert float(data.tread_wear.median()) == pytest.approx(worn, abs=0.1e-3)
    assert data.tread_wear.attrs["units"] == "m"
    assert re.search(r"mean tread wear +3\.0\d? mm", data.attrs["summary"])
    assert "crown radius 53" in gap.attrs["scan"]
    # It opens as a result, and a report tells it and draws it.
    opened = tl.open_results(output).wear
    assert opened.mean == pytest.approx(worn, abs=0.1e-3)
    assert [before - now for _, before, now in opened.grooves] == pytest.approx([worn] * 4, abs=0.2e-3)
    page = tmp_path / "wear.html"
    done = CliRunner().invoke(app, ["report", str(output), "-o", str(page), "--quiet"])
    assert done.exit_code == 0, done.output
    text = page.read_text()
    for told in ("Tread wear", "mean tread wear", "Worn off since the earlier scan"):
        assert told in text
    # As tables the gap keeps the name of the file.
    done = CliRunner().invoke(app, [*both, "--reference-length", "0.912 = 1000 mm", "-o", str(tmp_path / "t.csv")])
    assert done.exit_code == 0, done.output
    assert "initial_gap" in (tmp_path / "t.csv").read_text()[:200]
    assert "tread_wear" in (tmp_path / "t_wear.csv").read_text()[:200]
    # The file is a height map of the tread as before.
    assert Tire.from_height_map(output, inflation_pressure=8e5).fixed_grid.dx == pytest.approx(10e-3)
    # One known length for both: the earlier tire would be a quarter larger, and that is said.
    wrong = CliRunner().invoke(app, both)
    assert wrong.exit_code != 0
    assert "larger, more than a tread is deep" in " ".join(wrong.output.split())
    alone = CliRunner().invoke(app, [*asked, "--reference-length", "1 = 1 m"])
    assert alone.exit_code != 0
    assert "give it with --reference" in " ".join(alone.output.split())


@pytest.mark.slow
def test_a_scan_of_half_a_million_triangles_gives_the_map_of_the_tread(tmp_path):
    """Its time and memory are measured by `benchmarks/scans.py`."""
    triangles = 500_000
    across = round(math.sqrt(triangles / 6.4))
    vertices, faces = tire_mesh(around=round(triangles / 2 / (across + 55)), across=across, noise=0.3e-3, flipped=0.3)
    assert len(faces) == pytest.approx(triangles, rel=0.05)
    tire = Tire.from_scan(write(tmp_path / "tire.ply", vertices, faces), units="m")
    assert tire.surface.outer_radius == pytest.approx(RIB_TREAD.rolling_radius, abs=0.5e-3)
    gap = tire.height_map(Grid.centred(0.3, 0.3, 3e-3))
    # Along the middle of a rib the gap is that of the circle; noise of 0.3 mm is averaged over few points a cell.
    middle = gap[gap.shape[0] // 2]
    x = Grid.centred(0.3, 0.3, 3e-3).x
    circle = RIB_TREAD.rolling_radius - np.sqrt(RIB_TREAD.rolling_radius**2 - x**2)
    assert np.nanmedian(np.abs(middle - circle - np.nanmin(middle - circle))) < 1.5e-3
