import os

import pytest

import treadload as tl
from treadload.case.schema import read_case
from treadload.errors import InputError
from treadload.files import check_writable, replacing
from treadload.tire.fringes import read_fringes
from treadload.tire.scan.laser_file import asked_of, is_laser


def test_a_file_appears_whole(tmp_path):
    with replacing(tmp_path / "a.txt") as temporary:
        temporary.write_text("whole")
        assert not (tmp_path / "a.txt").exists()
    assert (tmp_path / "a.txt").read_text() == "whole"
    assert os.listdir(tmp_path) == ["a.txt"]


@pytest.mark.parametrize("error", [RuntimeError, KeyboardInterrupt])
def test_an_error_leaves_the_old_file_and_nothing_else(tmp_path, error):
    (tmp_path / "a.txt").write_text("old")

    def write_half():
        with replacing(tmp_path / "a.txt") as temporary:
            temporary.write_text("ha")
            raise error

    with pytest.raises(error):
        write_half()
    assert (tmp_path / "a.txt").read_text() == "old"
    assert os.listdir(tmp_path) == ["a.txt"]


def test_unwritable_paths_say_why(tmp_path):
    with pytest.raises(InputError, match="does not exist"):
        check_writable(tmp_path / "no" / "a.txt")
    with pytest.raises(InputError, match="is a folder"):
        check_writable(tmp_path)
    check_writable(tmp_path / "a.txt")
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize(
    ("read", "wanted"),
    [
        (tl.Case.from_toml, "the TOML file of a case"),
        (read_case, "the TOML file of a case"),
        (tl.tire.TreadProfile.from_toml, "the TOML file of a tread profile"),
        (read_fringes, "a TOML file that names the pictures"),
        (asked_of, r"a TOML file with a table \[laser\]"),
    ],
)
def test_what_is_no_text_is_refused_with_the_byte_and_what_to_give(read, wanted, tmp_path):
    file = tmp_path / "a.toml"
    file.write_bytes(b'title = "\xe9t\xe9"')
    with pytest.raises(InputError, match=rf"a.toml is not a text file in UTF-8 \(byte 9\); give {wanted}"):
        read(file)
    assert not is_laser(file)
