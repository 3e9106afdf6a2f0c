"""Surface-metrology files as treads and as textures, beside an independent reader, and what is refused."""

import hashlib
import io
import struct
import zipfile

import numpy as np
import pytest

from surface_files import MAIN, WRITERS, al3d, archived, sdf_binary, sdf_text, sur, x3p, x3p_members
from treadload.case.tire import TirePart
from treadload.errors import InputError
from treadload.metrology import read_surface_map
from treadload.pavement.texture import read_texture
from treadload.tire import Tire

DX, DY = 0.25e-3, 0.5e-3
HEIGHTS = np.round(1e-3 * np.sin(0.7 * np.arange(9))[None, :] + 2e-4 * np.arange(5)[:, None] ** 2, 6)
HEIGHTS[3, 4] = np.nan
# The example of ISO 25178-71 itself: 7 points in 4 profiles, micrometres.
STANDARD = """aISO-1.0
ManufacID = ISOTC213
CreateDate = 040120100853
ModDate = 050320101353
NumPoints = 7
NumProfiles = 4
Xscale = 1.0E-6
Yscale = 1.0E-6
Zscale = 1.0E-6
Zresolution = 1.0E-9
Compression = 0
DataType = 7
CheckType = 0
*
1.00000 0.99874 0.99495 0.98865 0.97986 0.96858 1.00000
0.99874 0.99748 0.99369 0.98740 0.97862 0.96736 0.99874
0.99495 0.99369 0.98993 0.98366 0.97491 0.96369 0.99495
0.97986 0.97862 0.97491 0.96874 0.96012 0.94907 0.97986
*
< OperatorName > Tom Jones < / OperatorName >
< PartName > S2 Softgauges Example < /PartName >
*"""


@pytest.mark.parametrize("name", WRITERS)
def test_heights_come_back_with_their_holes_as_texture_and_as_tread(tmp_path, name):
    path = tmp_path / name
    path.write_bytes(WRITERS[name](HEIGHTS, DX, DY))
    found = read_surface_map(path)
    # Spacings of SUR and heights of some are single precision; whole numbers count micrometres.
    assert (found.dx, found.dy) == pytest.approx((DX, DY), rel=1e-6)
    np.testing.assert_allclose(found.heights, HEIGHTS, rtol=0, atol=1e-9)
    assert "1 of them not measured" in found.source
    texture = read_texture(path)
    np.testing.assert_allclose(texture.heights, HEIGHTS[::-1], rtol=0, atol=1e-9)
    assert (texture.dx, texture.dy) == pytest.approx((DX, DY), rel=1e-6)
    tire = TirePart(height_map=name, inflation_pressure="8 bar").build(tmp_path)
    gap = tire.height_map(tire.fixed_grid)
    # What is high touches the road first.
    np.testing.assert_allclose(gap, np.nanmax(HEIGHTS) - HEIGHTS, rtol=0, atol=1e-9)
    assert name in str(tire.surface)


def test_the_example_of_the_standard(tmp_path):
    path = tmp_path / "s2.sdf"
    path.write_text(STANDARD)
    found = read_surface_map(path)
    assert (found.dx, found.dy, found.heights.shape) == (pytest.approx(1e-6), pytest.approx(1e-6), (4, 7))
    assert found.heights[0, 0] == pytest.approx(1e-6)
    assert found.heights[3, 5] == pytest.approx(0.94907e-6)


def test_sur_files_in_micrometres_and_flipped(tmp_path):
    path = tmp_path / "a.sur"
    content = bytearray(sur(HEIGHTS, DX, DY, unit=b"um"))
    path.write_bytes(content)
    np.testing.assert_allclose(read_surface_map(path).heights, HEIGHTS, rtol=0, atol=1e-9)
    content[290:292] = struct.pack("<H", 1)
    path.write_bytes(content)
    np.testing.assert_allclose(read_surface_map(path).heights, -HEIGHTS, rtol=0, atol=1e-9)


def turned(inversion):
    content = bytearray(sur(HEIGHTS, DX, DY))
    content[290:292] = struct.pack("<H", inversion)
    return bytes(content)


@pytest.mark.slow
@pytest.mark.parametrize("name", [*WRITERS, "offset.x3p", "s2.sdf", *(f"{k}.sur" for k in range(4))])
def test_an_independent_reader_finds_the_same_heights_and_spacing(tmp_path, name):
    """SurfaceTopography 1.27 or later reads the same bytes; both multiply counts in double precision."""
    files = pytest.importorskip("SurfaceTopography.IO")
    offset = x3p_members(HEIGHTS, DX, DY, "L")
    offset["main.xml"] = offset["main.xml"].replace(b"<Offset>0.0</Offset>", b"<Offset>2.5e-4</Offset>")
    content = (
        archived(offset)
        if name == "offset.x3p"
        else STANDARD.encode()
        if name == "s2.sdf"
        else turned(int(name[0]))
        if name.endswith("sur") and name[0].isdigit()
        else WRITERS[name](HEIGHTS, DX, DY)
    )
    path = tmp_path / name
    path.write_bytes(content)
    theirs = files.open_topography(str(path)).topography()
    unit = {"m": 1.0, "mm": 1e-3, "µm": 1e-6}[theirs.unit]
    heights = unit * np.ma.filled(np.ma.asarray(theirs.heights(), dtype=float), np.nan).T
    found = read_surface_map(path)
    np.testing.assert_allclose(found.heights, heights, rtol=1e-12, atol=1e-15)
    spacing = [unit * size / count for size, count in zip(theirs.physical_sizes, theirs.nb_grid_pts, strict=True)]
    assert (found.dx, found.dy) == pytest.approx(tuple(spacing), rel=1e-12)


@pytest.mark.slow
def test_what_another_program_wrote(tmp_path):
    """SurfaceTopography's own writer of X3P."""
    topography = pytest.importorskip("SurfaceTopography")
    path = tmp_path / "theirs.x3p"
    size = (DX * HEIGHTS.shape[1], DY * HEIGHTS.shape[0])
    topography.Topography(np.ma.masked_invalid(HEIGHTS.T), size, unit="m").to_x3p(str(path), dtype="L")
    found = read_surface_map(path)
    np.testing.assert_allclose(found.heights, HEIGHTS, rtol=0, atol=1e-9)
    assert (found.dx, found.dy) == pytest.approx((DX, DY))


def of_header(**changes):
    """An X3P file whose header says something else than its data."""
    members = x3p_members(HEIGHTS, DX, DY)
    told = {"dx": DX, "dy": DY, "kind": "D", "scale": 1.0, "offset": 0.0, "nx": 9, "ny": 5, "valid": ""}
    members["main.xml"] = MAIN.format(**(told | changes)).encode()
    return archived(members)


def with_xml(old, new):
    members = x3p_members(HEIGHTS, DX, DY)
    members["main.xml"] = members["main.xml"].replace(old, new)
    return archived(members)


BILLION = b'<?xml version="1.0"?><!DOCTYPE z [<!ENTITY a "lol"><!ENTITY b "&a;&a;&a;&a;">]><a>&b;</a>'
# As UTF-16 no search for the letters of DOCTYPE finds it.
WIDE = '<?xml version="1.0" encoding="UTF-16"?><!DOCTYPE a [<!ENTITY b "c">]><a>&b;</a>'.encode("utf-16")


def of_tag(key, value, new):
    """An AL3D file with another value of a tag."""
    start = key.ljust(20, b"\0")
    assert start + value in AL3D
    return AL3D.replace(start + value.ljust(len(new), b"\0"), start + new)


def test_the_checksum_that_a_header_states(tmp_path):
    members = x3p_members(HEIGHTS, DX, DY)
    right = hashlib.md5(members["bindata/data.bin"]).hexdigest().upper()
    link = f"<MD5ChecksumPointData>{right}</MD5ChecksumPointData></DataLink>"
    (tmp_path / "a.x3p").write_bytes(with_xml(b"</DataLink>", link.encode()))
    np.testing.assert_array_equal(read_surface_map(tmp_path / "a.x3p").heights, HEIGHTS)


def patched(content, at, new):
    return content[:at] + new + content[at + len(new) :]


SUR, SDF, TEXT, AL3D, X3P = (make(HEIGHTS, DX, DY) for make in (sur, sdf_binary, sdf_text, al3d, x3p))
BAD = {
    "bomb.x3p": (archived({"main.xml": BILLION}), "document type or entities"),
    "wide.x3p": (archived({"main.xml": WIDE}), "document type or entities"),
    "outside.x3p": (with_xml(b"?>\n<p", b'?>\n<!DOCTYPE p SYSTEM "file:///etc/passwd">\n<p'), "document type"),
    "deep.x3p": (archived({"main.xml": b"<a>" * 40 + b"</a>" * 40}), "32 deep"),
    "many.x3p": (archived({"main.xml": b"<a>" + b"<b/>" * 30_000 + b"</a>"}), "more than 20000 elements"),
    "long.x3p": (archived({"main.xml": b"<a>" + b" " * 2**22 + b"</a>"}), "more than 200 times|more than 4194304"),
    "packed.x3p": (archived(x3p_members(HEIGHTS, DX, DY) | {"more.bin": bytes(2**21)}), "more than 200 times"),
    "members.x3p": (archived({f"{k}": b"" for k in range(1001)}), "1001 members"),
    "path.x3p": (archived(x3p_members(HEIGHTS, DX, DY) | {"../../etc/cron": b"x"}), "outside its archive"),
    "drive.x3p": (archived({"C:\\a": b"x"}), "outside its archive"),
    "empty.x3p": (archived({}), "no ZIP archive|no main.xml"),
    "nothing.x3p": (b"", "0 bytes"),
    "words.x3p": (b"1 2 3\n" * 50, "no ZIP archive"),
    "cut.x3p": (X3P[:200], "could not be read as X3P"),
    "larger.x3p": (of_header(nx=10), "360 bytes, and its header states 400"),
    "huge.x3p": (of_header(nx=10**8, ny=10**8), "points at most"),
    "line.x3p": (of_header(nx=1, ny=45), "two columns or more"),
    "nan.x3p": (of_header(dx=float("nan")), "positive number"),
    "minus.x3p": (of_header(dy=-1.0), "positive number"),
    "kind.x3p": (of_header(kind="Q"), "known are I, L, F, D"),
    "link.x3p": (of_header(valid="<ValidPointsLink>main</ValidPointsLink>"), "no such member"),
    "twice.x3p": (with_xml(b"<SizeX>9</SizeX>", b"<SizeX>9</SizeX><SizeX>8</SizeX>"), "twice"),
    "checksum.x3p": (with_xml(b"</DataLink>", b"<MD5ChecksumPointData>00</MD5ChecksumPointData></DataLink>"), "MD5"),
    "profile.x3p": (with_xml(b">SUR<", b">PRF<"), "profiles and clouds are not read"),
    "words.sdf": (b"hello", "aISO-1.0 or bISO-1.0"),
    "cut.sdf": (SDF[:-1], "it is truncated"),
    "head.sdf": (SDF[:60], "its header would reach"),
    "lie.sdf": (patched(SDF, 42, struct.pack("<H", 60_000)), "it is truncated"),
    "packed.sdf": (patched(SDF, 78, b"\1"), "compression 1"),
    "scale.sdf": (patched(SDF, 46, struct.pack("<d", 0.0)), "Xscale of .* positive number, got 0"),
    "short.sdf": (TEXT[:-40], "heights; it is truncated"),
    "lacks.sdf": (TEXT.replace(b"NumPoints", b"Points"), "lacks NumPoints"),
    "comma.sdf": (TEXT.replace(b"BAD", b"1,5"), "'1,5' among its heights"),
    "hex.sdf": (TEXT.replace(b"BAD", b"0x1"), "'0x1' among its heights"),
    "endless.sdf": (TEXT.replace(b"\n*", b"\n#"), "no line of"),
    "nan.sdf": (TEXT.replace(b"Xscale = 0.00025", b"Xscale = nan"), "Xscale of .* positive number, got nan"),
    "words.sur": (b"hello", "DIGITAL SURF"),
    "packed.sur": (b"DSCOMPRESSED" + SUR[12:], "compressed"),
    "cut.sur": (SUR[:-1], "it is truncated"),
    "head.sur": (SUR[:500], "its header would reach"),
    "lie.sur": (patched(SUR, 108, struct.pack("<i", 10**9)), "points at most|points in"),
    "minus.sur": (patched(SUR, 108, struct.pack("<i", -9)), "two columns"),
    "series.sur": (sur(HEIGHTS, DX, DY, kind=5, objects=3), "3 objects of type 5"),
    "unit.sur": (sur(HEIGHTS, DX, DY, unit=b"deg"), "no unit of length"),
    "bits.sur": (patched(SUR, 98, struct.pack("<H", 64)), "64 bits"),
    "comment.sur": (patched(SUR, 334, struct.pack("<H", 60_000)), "it is truncated"),
    "words.al3d": (b"hello", "AliconaImaging"),
    "cut.al3d": (AL3D[:-1], "it is truncated"),
    "tags.al3d": (of_tag(b"TagCount", b"9", b"999"), "broken tag"),
    "lacks.al3d": (AL3D.replace(b"Rows", b"Raws"), "lacks the tag Rows"),
    "rows.al3d": (of_tag(b"Rows", b"5", b"99"), "truncated"),
    "offset.al3d": (of_tag(b"DepthImageOffset", b"845", b"0\0\0"), "no depth image"),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_bombs_and_lies_are_refused(tmp_path, name):
    content, says = BAD[name]
    path = tmp_path / name
    path.write_bytes(content)
    for read in (read_texture, lambda path: Tire.from_height_map(path, inflation_pressure=8e5)):
        with pytest.raises(InputError, match=says):
            read(path)


def test_an_archive_that_lies_about_the_length_of_a_member(tmp_path):
    """The directory says what the member does not hold; nothing is unpacked further than it says."""
    members = x3p_members(HEIGHTS, DX, DY)
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name, content in members.items():
            archive.writestr(name, content)
        archive.filelist[1].file_size = archive.filelist[1].compress_size = 8
    (tmp_path / "a.x3p").write_bytes(stream.getvalue())
    with pytest.raises(InputError, match="8 bytes, and its header states 360"):
        read_texture(tmp_path / "a.x3p")
    # One flipped bit in the data is found by the checksum of the archive.
    whole = archived(members)
    with zipfile.ZipFile(io.BytesIO(whole)) as archive:
        start = archive.getinfo("bindata/data.bin").header_offset + 60
    (tmp_path / "b.x3p").write_bytes(patched(whole, start, bytes([whole[start] ^ 1])))
    with pytest.raises(InputError, match="could not be read as X3P"):
        read_texture(tmp_path / "b.x3p")


def test_these_files_bring_their_own_spacing_and_units(tmp_path):
    path = tmp_path / "a.x3p"
    path.write_bytes(X3P)
    for asked in ({"spacing": 1e-3}, {"units": "mm"}):
        with pytest.raises(InputError, match="brings its own spacing and units"):
            read_texture(path, **asked)
        with pytest.raises(InputError, match="brings its own spacing and units"):
            Tire.from_height_map(path, **asked)
    with pytest.raises(InputError, match="no file"):
        read_texture(tmp_path / "missing.sur")


def test_a_surface_without_a_measured_point(tmp_path):
    for name, make in (("a.x3p", x3p), ("a.al3d", al3d), ("a.sdf", sdf_text)):
        (tmp_path / name).write_bytes(make(np.full((5, 9), np.nan), DX, DY))
        with pytest.raises(InputError, match="none of the 45 points"):
            read_texture(tmp_path / name)
