import errno
import os
import stat
import time

import h5py
import pytest
import xarray as xr

import treadload as tl
from treadload.case.schema import read_case
from treadload.errors import InputError, WriteError
from treadload.files import check_writable, read_tree, write_all, write_whole
from treadload.tire.fringes import read_fringes
from treadload.tire.scan.laser_file import is_laser, read_laser_file


def test_a_file_appears_whole(tmp_path):
    def pieces():
        yield "wh"
        assert not (tmp_path / "a.txt").exists()
        yield "ole"

    assert write_whole(tmp_path / "a.txt", pieces()) == tmp_path / "a.txt"
    assert (tmp_path / "a.txt").read_text() == "whole"
    write_all([(tmp_path / "a.txt", b"\xe4"), (tmp_path / "b.txt", "ä\ud800")])
    assert (tmp_path / "a.txt").read_bytes() == b"\xe4"
    assert (tmp_path / "b.txt").read_text(encoding="utf-8") == "ä?"
    assert sorted(os.listdir(tmp_path)) == ["a.txt", "b.txt"]


@pytest.mark.parametrize("error", [RuntimeError, KeyboardInterrupt])
def test_an_error_leaves_the_old_files_and_nothing_else(tmp_path, error):
    for name in "ab":
        (tmp_path / name).write_text("old")

    def half():
        yield "ha"
        raise error

    with pytest.raises(error):
        write_all([(tmp_path / "a", "new"), (tmp_path / "b", half())])
    assert [(tmp_path / name).read_text() for name in "ab"] == ["old", "old"]
    assert sorted(os.listdir(tmp_path)) == ["a", "b"]


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EDQUOT, errno.EIO])
@pytest.mark.parametrize("step", ["write", "fsync", "replace"])
def test_a_disk_that_refuses_leaves_the_old_file(tmp_path, monkeypatch, number, step):
    path = tmp_path / "a.txt"
    path.write_text("old")

    def fail(*_):
        raise OSError(number, os.strerror(number))

    def pieces():
        yield "x"
        fail()

    if step != "write":
        monkeypatch.setattr(os, step, fail)
    with pytest.raises(WriteError, match=os.strerror(number)) as refused:
        write_whole(path, pieces() if step == "write" else "x" * 70_000)
    monkeypatch.undo()
    assert str(refused.value).endswith("the file that was there is unchanged")
    if number != errno.EIO:
        assert "make room" in str(refused.value)
    if (number, step) == (errno.ENOSPC, "fsync"):
        assert "(70 kB needed, " in str(refused.value)
    assert path.read_text() == "old"
    assert os.listdir(tmp_path) == ["a.txt"]


@pytest.mark.skipif(os.name == "nt", reason="links and modes as on POSIX")
def test_links_are_followed_and_modes_kept(tmp_path):
    (tmp_path / "real").mkdir()
    target = tmp_path / "real" / "a.txt"
    target.write_text("old")
    target.chmod(0o640)
    (tmp_path / "link.txt").symlink_to(target)
    write_whole(tmp_path / "link.txt", "new")
    assert (tmp_path / "link.txt").is_symlink()
    assert target.read_text() == "new"
    assert stat.S_IMODE(target.stat().st_mode) == 0o640
    before = os.umask(0o027)
    try:
        write_whole(tmp_path / "fresh.txt", "")
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "fresh.txt").stat().st_mode) == 0o640


@pytest.mark.skipif(os.name == "nt", reason="devices as on POSIX")
def test_a_device_is_written_to_and_stays_one(tmp_path):
    write_whole(os.devnull, "gone")
    assert stat.S_ISCHR(os.stat(os.devnull).st_mode)


def test_names_as_long_as_a_system_takes_are_written(tmp_path):
    path = tmp_path / ("ä" * 125 + ".txt")
    write_whole(path, "long")
    assert path.read_text() == "long"


def test_unwritable_paths_say_why(tmp_path, monkeypatch):
    with pytest.raises(InputError, match="does not exist"):
        check_writable(tmp_path / "no" / "a.txt")
    with pytest.raises(InputError, match="is a folder"):
        check_writable(tmp_path)
    with pytest.raises(InputError, match="name too long; give another name"):
        check_writable(tmp_path / ("a" * 400))
    with pytest.raises(InputError, match="null byte; give another name"):
        check_writable(tmp_path / "a\0b")
    check_writable(tmp_path / "a.txt")
    assert os.listdir(tmp_path) == []
    (tmp_path / "kept.txt").write_text("old")
    # For root everything is writable.
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    with pytest.raises(InputError, match="is read-only; make it writable"):
        write_whole(tmp_path / "kept.txt", "new")
    assert (tmp_path / "kept.txt").read_text() == "old"


@pytest.mark.skipif(os.name == "nt", reason="links as on POSIX")
def test_links_that_lead_nowhere_are_refused(tmp_path):
    (tmp_path / "a").symlink_to(tmp_path / "b")
    (tmp_path / "b").symlink_to(tmp_path / "a")
    with pytest.raises(InputError, match="symbolic links; give another name"):
        write_whole(tmp_path / "a", "new")
    assert (tmp_path / "a").is_symlink()


@pytest.mark.parametrize(
    ("link", "said"),
    [
        (lambda file: file["/"], "/part/again is a link to a group that has another name"),
        (lambda file: h5py.SoftLink("/"), "/part/again is a link to a group that has another name"),
        (lambda file: h5py.ExternalLink("other.nc", "/"), "/part/again is a link to another file"),
        (lambda file: h5py.SoftLink("/part/again"), "too many links"),
    ],
)
def test_groups_that_lead_in_circles_are_refused_at_once(tmp_path, link, said):
    path = tmp_path / "a.nc"
    xr.DataTree.from_dict({"/part": xr.Dataset({"a": 1.0})}).to_netcdf(path, engine="h5netcdf")
    with h5py.File(path, "a") as file:
        file["part/again"] = link(file)
    began = time.process_time()
    with pytest.raises(InputError, match=said):
        read_tree(path, "NetCDF-4")
    # A reader that follows them ends after minutes, if at all.
    assert time.process_time() - began < 5


def test_groups_beyond_all_depth_are_refused(tmp_path):
    with h5py.File(tmp_path / "a.nc", "w") as file:
        file.create_group("/".join("a" * 300))
    with pytest.raises(InputError, match="more than 60 groups deep"):
        read_tree(tmp_path / "a.nc", "NetCDF-4")


def test_a_file_that_changes_while_it_is_read_is_refused(tmp_path, monkeypatch):
    path = tmp_path / "a.nc"
    xr.Dataset({"a": 1.0}).to_netcdf(path, engine="h5netcdf")
    load = xr.Dataset.load

    def changed(data):
        loaded = load(data)
        os.utime(path, ns=(1, 1))
        return loaded

    monkeypatch.setattr(xr.Dataset, "load", changed)
    with pytest.raises(InputError, match="changed while it was read; wait for what writes it"):
        read_tree(path, "NetCDF-4")


@pytest.mark.parametrize(
    ("read", "wanted"),
    [
        (tl.Case.from_toml, "the TOML file of a case"),
        (read_case, "the TOML file of a case"),
        (tl.tire.TreadProfile.from_toml, "the TOML file of a tread profile"),
        (read_fringes, "a TOML file that names the pictures"),
        (read_laser_file, r"a TOML file with a table \[laser\]"),
    ],
)
def test_what_is_no_text_is_refused_with_the_byte_and_what_to_give(read, wanted, tmp_path):
    file = tmp_path / "a.toml"
    file.write_bytes(b'title = "\xe9t\xe9"')
    with pytest.raises(InputError, match=rf"a.toml is not a text file in UTF-8 \(byte 9\); give {wanted}"):
        read(file)
    assert not is_laser(file)
