"""Tables of sections in the cache folder: read again, made again where damaged, missed where no folder is."""

import numpy as np
import pytest

from treadload.contact.bodies import section_tables
from treadload.contact.bodies.section_tables import face_table
from treadload.kernels.sections import Section

RIB = Section(((-0.015, 0.015),), 0.02, (0.0, 0.0))


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("TREADLOAD_CACHE", str(tmp_path))
    section_tables._table.cache_clear()
    yield tmp_path / "sections"
    section_tables._table.cache_clear()


@pytest.fixture
def solved(monkeypatch):
    """Poisson's ratios of the sections that were solved."""
    ratios = []

    def solve(section, poisson):
        ratios.append(poisson)
        return section_tables_solver(section, poisson)

    section_tables_solver = section_tables.face_compliance
    monkeypatch.setattr(section_tables, "face_compliance", solve)
    return ratios


def test_a_section_is_solved_once(folder, solved):
    first = face_table(RIB, 0.49)
    assert face_table(RIB, 0.49) is first
    section_tables._table.cache_clear()
    again = face_table(Section(((-0.015 - 1e-12, 0.015),), 0.02, (0.0, 0.0)), 0.49)
    np.testing.assert_array_equal(again.compliance, first.compliance)
    assert solved == [0.49]
    assert [file.suffix for file in folder.iterdir()] == [".npz"]


@pytest.mark.parametrize("damage", [b"", b"nothing of the kind", None])
def test_a_damaged_file_is_made_again(folder, solved, damage):
    table = face_table(RIB, 0.49)
    (file,) = folder.iterdir()
    content = file.read_bytes()
    file.write_bytes(content[: len(content) // 2] if damage is None else damage)
    section_tables._table.cache_clear()
    np.testing.assert_array_equal(face_table(RIB, 0.49).compliance, table.compliance)
    assert len(solved) == 2
    assert file.read_bytes() == content


def test_another_version_and_another_table_under_its_name_are_made_again(folder, solved, monkeypatch):
    face_table(RIB, 0.49)
    (file,) = folder.iterdir()
    content = file.read_bytes()
    face_table(RIB, 0.45)
    (other,) = set(folder.iterdir()) - {file}
    other.write_bytes(content)
    section_tables._table.cache_clear()
    assert face_table(RIB, 0.45).poisson == 0.45
    monkeypatch.setattr(section_tables, "_VERSION", 2)
    section_tables._table.cache_clear()
    face_table(RIB, 0.45)
    assert solved == [0.49, 0.45, 0.45, 0.45]


def test_where_nothing_can_be_written_the_table_is_still_there(folder, solved, monkeypatch):
    folder.parent.joinpath("file").write_text("")
    monkeypatch.setenv("TREADLOAD_CACHE", str(folder.parent / "file"))
    assert face_table(RIB, 0.49).compliance.shape[0] == 27
    monkeypatch.setenv("TREADLOAD_CACHE", "")
    section_tables._table.cache_clear()
    assert face_table(RIB, 0.49).compliance.shape[0] == 27
    assert not folder.exists()


def test_the_oldest_of_many_files_leave(folder, monkeypatch):
    monkeypatch.setattr(section_tables, "_MOST_FILES", 2)
    for poisson in (0.3, 0.35, 0.4):
        face_table(RIB, poisson)
    assert len(list(folder.iterdir())) == 2
