"""Tables of sections in the cache folder: read again, made again where damaged, missed where no folder is."""

import importlib.util
from pathlib import Path

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


def catalogue_sections():
    """Sections of the catalogue's ribbed treads, for cells of the default size, as the script of the tables lists."""
    path = Path(__file__).parents[2] / "benchmarks/ship_section_tables.py"
    specification = importlib.util.spec_from_file_location("ship_section_tables", path)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module.POISSON, module.catalogue_sections()


def test_tables_of_the_catalogue_come_with_the_package(solved, folder):
    poisson, sections = catalogue_sections()
    paths = {section_tables.shipped_path(section, poisson) for section in sections}
    assert len(sections) >= 2
    # No table of a tread that has changed is left.
    assert paths == set(next(iter(paths)).parent.glob("*.npz")), "run benchmarks/ship_section_tables.py"
    assert sum(path.stat().st_size for path in paths) < 5e6
    for section in sections:
        face_table(section, poisson)
    # They come before the user's cache, which is left alone.
    assert not solved
    assert not folder.exists()


@pytest.mark.slow
def test_shipped_tables_are_new_solutions():
    poisson, sections = catalogue_sections()
    for section in sections:
        shipped, anew = face_table(section, poisson), section_tables.face_compliance(section, poisson)
        # Single precision.
        np.testing.assert_allclose(shipped.compliance, anew.compliance, atol=1e-7 * np.abs(anew.compliance).max())
        # Powers and logarithms round in the last place as the machine's library does.
        np.testing.assert_allclose(shipped.waves, anew.waves, rtol=1e-14)
        cells = shipped.on_cells(np.array([[-0.003, 0.0], [0.0, 0.003], [0.003, 0.006]])).compliance
        assert np.linalg.eigvalsh(cells).min() > 0


def test_a_new_section_is_solved_once_and_then_read_from_the_cache(solved, folder):
    """What both cost is in `benchmarks/ribs.py`."""
    for _ in range(2):
        section_tables._table.cache_clear()
        face_table(RIB, 0.4951)
    assert solved == [0.4951]
    assert list(folder.iterdir())


def test_a_damaged_shipped_table_is_solved_again(tmp_path, monkeypatch, solved):
    monkeypatch.setattr(section_tables, "_SHIPPED", tmp_path / "shipped")
    path = section_tables.ship(RIB, 0.49, tmp_path / "shipped")
    table = face_table(RIB, 0.49)
    assert solved == [0.49]
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2])
    section_tables._table.cache_clear()
    assert face_table(RIB, 0.49).compliance == pytest.approx(table.compliance, rel=1e-6, abs=1e-18)
    assert len(solved) == 2
