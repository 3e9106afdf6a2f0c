"""Texts of a NetCDF file that are not UTF-8: numbers are read and written again, names and labels are refused."""

import h5py
import pytest

import treadload as tl
from cases import COARSE_CASE
from treadload.reporting import report

# A title in Latin-1 that says it is UTF-8, with two bytes of no encoding before it.
BYTES = b"\xff\xfe caf\xe9"


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    path = tmp_path_factory.mktemp("texts") / "result.nc"
    # The texts that are damaged are those of the file and of its contact, which is a quarter of the result.
    case = tl.Case.from_text(COARSE_CASE.replace("12 mm", "24 mm"))
    return tl.save_results(tl.results.to_tree(tl.run(case).contact, title="coarse"), path)


def put(holder, name, kind):
    """An attribute with bytes that are not UTF-8, of fixed or of any length."""
    length = len(BYTES) if kind == "fixed" else None
    holder.attrs.create(name, BYTES, dtype=h5py.string_dtype("utf-8", length))


@pytest.fixture(scope="module")
def undamaged(saved):
    return tl.open_results(saved).tree


@pytest.mark.usefixtures("without_figures")
@pytest.mark.parametrize("kind", ["fixed", "variable"])
@pytest.mark.parametrize("place", ["/", "/contact", "/contact/pressure"])
def test_a_text_that_is_not_utf8_costs_no_number(saved, undamaged, tmp_path, place, kind):
    path = tmp_path / "damaged.nc"
    path.write_bytes(saved.read_bytes())
    with h5py.File(path, "r+") as file:
        put(file[place], "title", kind)
    results = tl.open_results(path)
    assert results.tree.equals(undamaged)
    node = results.tree if place == "/" else results.tree[place]
    assert node.attrs["title"] == "?? caf?"
    again = tl.save_results(results.tree, tmp_path / "again.nc")
    assert tl.open_results(again).tree.equals(results.tree)
    tl.results.write_csv(results.tree, tmp_path / "tables.csv")
    assert "?? caf?" in (tmp_path / "tables_about.csv").read_text(encoding="utf-8") or place == "/contact/pressure"
    if place == "/":
        report(results, tmp_path / "page.html")
        assert "?? caf?" in (tmp_path / "page.html").read_text(encoding="utf-8")


def test_a_unit_that_is_not_utf8_is_refused_as_another_unit(saved, tmp_path):
    path = tmp_path / "damaged.nc"
    path.write_bytes(saved.read_bytes())
    with h5py.File(path, "r+") as file:
        put(file["/contact/pressure"], "units", "fixed")
    with pytest.raises(tl.InputError, match=r"pressure is in \?\? caf\?, results are in Pa"):
        tl.open_results(path)


def test_names_and_labels_that_are_not_utf8_are_refused(saved, tmp_path):
    path = tmp_path / "damaged.nc"
    path.write_bytes(saved.read_bytes())
    with h5py.File(path, "r+") as file:
        group = file["/contact"].id
        group.links.move(b"pressure", group, b"press\xff")
    with pytest.raises(
        tl.InputError,
        match=r"cannot read .*damaged\.nc as a result .*: the name or label b'press.*not UTF-8; write it again",
    ):
        tl.open_results(path)


def test_labels_that_are_not_utf8_are_refused(tmp_path):
    path = tmp_path / "labels.nc"
    with h5py.File(path, "w") as file:
        labels = file.create_dataset("layer", (1,), dtype=h5py.string_dtype("utf-8"))
        labels[0] = BYTES
        labels.make_scale("layer")
    with pytest.raises(tl.InputError, match=r"cannot read .*labels\.nc as .*label b'.* caf.* is not UTF-8"):
        tl.open_results(path)
