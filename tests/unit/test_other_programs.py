"""What is written for other programs, read back by somebody else: ParaView's formats, tables, BibTeX."""

import base64
import csv
import re
import xml.etree.ElementTree as ET
import zlib

import numpy as np
import pytest

import treadload as tl
from treadload.citations import CITATIONS, REFERENCES
from treadload.results.bibtex import bibtex
from treadload.results.vtk import _packed

meshio = pytest.importorskip("meshio")


@pytest.fixture(scope="module")
def contact(coarse_result):
    return coarse_result.contact


@pytest.fixture(scope="module")
def response(coarse_result):
    return coarse_result.response


def unpacked(text):
    """Blocks packed by zlib behind their head: how many, the size of each, that of the last, their packed sizes."""
    blocks = int.from_bytes(base64.b64decode(text[:12])[:8], "little")
    end = -(-8 * (3 + blocks) // 3) * 4
    head = np.frombuffer(base64.b64decode(text[:end]), "<u8")
    body, start, parts = base64.b64decode(text[end:]), 0, []
    for size in map(int, head[3:]):
        parts.append(zlib.decompress(body[start : start + size]))
        start += size
    assert start == len(body)
    assert all(len(part) == head[1] for part in parts[:-1])
    assert len(parts[-1]) == (head[2] or head[1])
    return b"".join(parts)


def test_more_than_one_block_is_packed_as_its_head_says():
    for size in (1, 2**20, 2**20 + 8, 3 * 2**20):
        raw = np.random.default_rng(1).integers(0, 3, size, dtype=np.uint8).tobytes()
        assert unpacked(_packed(raw)) == raw


def parsed(path):
    """Type of the grid, its extent, and every array by its name, by the words of the format's makers."""
    root = ET.parse(path).getroot()
    assert root.attrib["byte_order"] == "LittleEndian"
    assert root.attrib["header_type"] == "UInt64"
    assert root.attrib["compressor"] == "vtkZLibDataCompressor"
    arrays = {}
    for one in root.iter("DataArray"):
        kind = {"Float64": "<f8", "Int64": "<i8", "UInt8": "u1"}[one.attrib["type"]]
        values = np.frombuffer(unpacked(one.text), kind)
        parts = int(one.attrib.get("NumberOfComponents", 1))
        arrays[one.attrib["Name"]] = values.reshape(-1, parts) if parts > 1 else values
    return root, arrays


def test_a_contact_becomes_a_structured_grid_with_vectors(contact, tmp_path):
    root, arrays = parsed(tl.results.write_vtk(contact, tmp_path / "contact.vts"))
    data = contact.dataset
    ny, nx = data.pressure.shape
    grid = root.find("StructuredGrid")
    assert grid.attrib["WholeExtent"] == f"0 {nx} 0 {ny} 0 0"
    assert arrays["points"].shape == ((nx + 1) * (ny + 1), 3)
    # Cells, x fastest, as VTK counts them.
    np.testing.assert_array_equal(arrays["pressure"], data.pressure.to_numpy().ravel())
    np.testing.assert_array_equal(arrays["traction"][:, 0], data.traction_x.to_numpy().ravel())
    np.testing.assert_array_equal(arrays["traction"][:, 1], data.traction_y.to_numpy().ravel())
    assert root.find(".//CellData").attrib["Vectors"] == "traction"
    first = arrays["points"][0]
    assert first[:2] == pytest.approx([float(data.x[0]) - 6e-3, float(data.y[0]) - 6e-3])


def test_meshio_reads_the_same_contact_as_cells(contact, tmp_path):
    mesh = meshio.read(tl.results.write_vtk(contact, tmp_path / "contact.vtu"))
    (cells,) = mesh.cells
    assert cells.type == "quad"
    corners = mesh.points[cells.data]
    # Areas of the cells, by the shoelace formula: 12 x 12 mm, all turned the same way.
    x, y = corners[..., 0], corners[..., 1]
    area = 0.5 * (x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum(axis=1)
    assert np.abs(area) == pytest.approx(144e-6)
    assert np.ptp(np.sign(area)) == 0
    load = (np.abs(area) * mesh.cell_data["pressure"][0]).sum()
    assert load == pytest.approx(32.5e3, rel=1e-6)
    middle = corners.mean(axis=1)
    peak = middle[mesh.cell_data["pressure"][0].argmax()]
    assert (
        float(contact.dataset.pressure.sel(x=peak[0], y=peak[1], method="nearest")) == contact.dataset.pressure.max()
    )


def test_a_response_becomes_a_rectilinear_grid_with_tensors(response, tmp_path):
    root, arrays = parsed(tl.results.write_vtk(response, tmp_path / "response.vtr"))
    data = response.dataset
    nz, ny, nx = data.strain_xx.shape
    assert root.find("RectilinearGrid").attrib["WholeExtent"] == f"0 {nx - 1} 0 {ny - 1} 0 {nz - 1}"
    np.testing.assert_array_equal(arrays["z"], data.depth)
    tensor = arrays["stress"].reshape(nz, ny, nx, 3, 3)
    # Symmetric, and each component where ParaView names it: XX XY XZ YX YY YZ ZX ZY ZZ.
    np.testing.assert_array_equal(tensor, np.swapaxes(tensor, -1, -2))
    for name, (row, column) in {
        "xx": (0, 0),
        "xy": (0, 1),
        "xz": (0, 2),
        "yy": (1, 1),
        "yz": (1, 2),
        "zz": (2, 2),
    }.items():
        np.testing.assert_array_equal(tensor[..., row, column], data[f"stress_{name}"])
    assert root.find(".//PointData").attrib["Tensors"] == "stress"
    direction = arrays["principal_direction_1"].reshape(nz, ny, nx, 3)
    np.testing.assert_array_equal(direction, data.principal_direction_1.transpose("depth", "y", "x", "component"))


def test_meshio_reads_a_response_as_bricks(response, tmp_path):
    mesh = meshio.read(tl.results.write_vtk(response, tmp_path / "response.vtu"))
    (cells,) = mesh.cells
    assert cells.type == "hexahedron"
    assert mesh.point_data["strain"].shape == (response.dataset.strain_xx.size, 9)
    corners = mesh.points[cells.data]
    a, b, d = (corners[:, k] - corners[:, 0] for k in (1, 3, 4))
    # Right-handed bricks of positive volume: depth points down.
    assert np.abs(np.einsum("ni,ni->n", np.cross(a, b), d)) == pytest.approx(0.012 * 0.012 * 0.02)


def test_vtk_of_the_other_kind_is_refused_in_a_sentence(contact, response, tmp_path):
    with pytest.raises(tl.InputError, match=r"write a response as \.vtr or \.vtu"):
        tl.results.write_vtk(response, tmp_path / "r.vts")
    with pytest.raises(tl.InputError, match=r"write a contact as \.vts or \.vtu"):
        tl.results.write_vtk(contact, tmp_path / "c.vtr")
    points = tl.solve_response(contact, contact.road, depths=[0.01], points=[(0.0, 0.0), (0.01, 0.0)])
    with pytest.raises(tl.InputError, match="needs a result on a grid"):
        tl.results.write_vtk(points, tmp_path / "p.vtu")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(("units", "metre", "pascal"), [("SI", 1.0, 1.0), ("mm", 1e3, 1e-6)])
def test_contact_stresses_add_up_to_the_forces(contact, tmp_path, units, metre, pascal):
    path = tl.results.write_tractions(contact, tmp_path / "contact.dat", units=units)
    x, y, p, qx, qy = np.loadtxt(path, unpack=True)
    area = (12e-3 * metre) ** 2
    assert p.sum() * area == pytest.approx(32.5e3, rel=1e-6)
    # Driving: the tire pushes the road backwards, with what the road gives the tire.
    assert qx.sum() * area == pytest.approx(-10e3, rel=1e-5)
    assert abs(qy.sum() * area) < 1
    head = [line for line in path.read_text(encoding="utf-8").splitlines() if line.startswith("#")]
    said = re.search(r"sum over the cells, N: p (\S+), qx (\S+), qy (\S+)", "\n".join(head))
    assert float(said[1]) == pytest.approx(p.sum() * area)
    assert float(said[2]) == pytest.approx(qx.sum() * area)
    here = contact.dataset.sel(x=x[7] / metre, y=y[7] / metre, method="nearest")
    assert (p[7] / pascal, qx[7] / pascal) == pytest.approx((float(here.pressure), float(here.traction_x)))
    assert len(p) == int((contact.dataset.pressure > 0).sum())


def test_contact_stresses_as_a_full_grid_and_wrong_units(contact, tmp_path):
    path = tl.results.write_tractions(contact, tmp_path / "all.txt", everywhere=True)
    rows = np.loadtxt(path)
    assert rows.shape == (contact.dataset.pressure.size, 5)
    np.testing.assert_allclose(
        rows[:, 2].reshape(contact.dataset.pressure.shape), contact.dataset.pressure, rtol=1e-9
    )
    with pytest.raises(tl.InputError, match=r"'SI' .* or 'mm' .*, got 'psi'"):
        tl.results.write_tractions(contact, tmp_path / "c.dat", units="psi")


@pytest.mark.parametrize("count", [1, 2, 5])
def test_discs_keep_load_area_and_centre(contact, count, tmp_path):
    made = tl.results.equivalent_discs(contact, count)
    data = contact.dataset
    assert len(made.discs) == count
    # Sums of the same numbers in another order: round-off.
    assert made.normal_load == pytest.approx(float(data.pressure.sum()) * 144e-6, rel=1e-12)
    assert sum(np.pi * disc.radius**2 for disc in made.discs) == pytest.approx(contact.area, rel=1e-12)
    for axis in ("x", "y"):
        centre = sum(disc.normal_load * getattr(disc, axis) for disc in made.discs) / made.normal_load
        assert centre == pytest.approx(float((data.pressure * data[axis]).sum() / data.pressure.sum()), abs=1e-12)
    assert made.lost["tractive"] == pytest.approx(-10e3, rel=1e-5)
    assert made == tl.results.equivalent_discs(contact, count)
    with made.write_csv(tmp_path / "discs.csv").open(encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    assert sum(float(row["load [kN]"]) for row in rows) == pytest.approx(32.5, rel=1e-6)
    assert [float(row["radius [m]"]) for row in rows] == [disc.radius for disc in made.discs]


def test_one_disc_loses_the_shape_and_more_discs_lose_less(contact):
    spreads = [tl.results.equivalent_discs(contact, count).lost for count in (1, 5, 20)]
    assert spreads[0]["spread_y"] < 0.95
    off = [abs(one["spread_y"] - 1) for one in spreads]
    assert off[2] < off[0]
    words = tl.results.equivalent_discs(contact).summary()
    assert "-10000 N along travel" in words
    assert "514 kPa, 1196 kPa before" in words


def test_a_disc_of_a_given_pressure_and_wrong_counts(contact):
    made = tl.results.equivalent_discs(contact, 1, pressure=820e3)
    (disc,) = made.discs
    assert disc.pressure == 820e3
    assert np.pi * disc.radius**2 * 820e3 == pytest.approx(32.5e3, rel=1e-6)
    for count in (0, 51, True):
        with pytest.raises(tl.InputError, match="must be 1 to 50"):
            tl.results.equivalent_discs(contact, count)
    with pytest.raises(tl.InputError, match="positive"):
        tl.results.equivalent_discs(contact, 1, pressure=-1.0)


def entries(text):
    """BibTeX read by counting braces: {key: (kind, {field: value})}."""
    found = {}
    for start in re.finditer(r"@(\w+)\{([^,]+),", text):
        depth, at = 1, start.end()
        while depth:
            depth += {"{": 1, "}": -1}.get(text[at], 0)
            at += 1
        fields = dict(re.findall(r"^  (\w+) = \{(.*)\},$", text[start.end() : at], re.M))
        assert start[2] not in found
        found[start[2]] = (start[1], fields)
    return found


def test_references_are_data_from_which_prose_and_bibtex_follow():
    keys = [reference.key for reference in REFERENCES.values()]
    assert len(set(keys)) == len(keys) == len(CITATIONS)
    assert CITATIONS["convolution"] == (
        "Liu, S., Wang, Q., Liu, G. (2000). A versatile method of discrete convolution and FFT (DC-FFT) for contact "
        "analyses. Wear 243, 101-111."
    )
    assert CITATIONS["chain"].endswith("Using Semi-Analytical Model. doi:10.3390/ma14092117")
    # As another program reads them: the same keys.
    assert set(entries(bibtex(CITATIONS.values()))) == {*keys, "treadload"}


def test_every_method_has_an_entry_of_bibtex():
    made = entries(bibtex(CITATIONS.values()))
    assert len(made) == len(CITATIONS) + 1
    for key, (kind, fields) in made.items():
        assert re.fullmatch(r"[a-z]+\d{4}b*|treadload", key), key
        assert kind in ("article", "book", "inproceedings", "misc", "software"), key
        assert {"year"} <= set(fields), key
        assert "title" in fields, key
    kind, love = made["love1929"]
    assert kind == "article"
    assert love["author"] == "Love, A. E. H."
    assert (love["journal"], love["volume"], love["pages"]) == ("Phil. Trans. R. Soc. A", "228", "377--420")
    assert made["kalker1990"] == (
        "book",
        {"author": "Kalker, J. J.", "year": "1990", "title": "{Three-Dimensional Elastic Bodies in Rolling Contact}",
         "publisher": "Kluwer"},
    )  # fmt: skip
    assert made["liu2000"][1]["author"] == "Liu, S. and Wang, Q. and Liu, G."
    # Once each, however often it is asked for.
    assert bibtex([CITATIONS["rolling"]] * 3).count("@book") == 1
