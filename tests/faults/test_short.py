"""A little of each fault; `python -m faults` runs as much as you like."""

import os

import pytest

pytestmark = pytest.mark.skipif(os.name == "nt", reason="forks and limits as on POSIX")


@pytest.fixture(scope="module")
def writers():
    from faults.writers import writers

    return writers()


QUICK = [
    "netcdf",
    "csv",
    "parquet",
    "excel",
    "cells",
    "tractions",
    "discs",
    "png",
    "savefig",
    "init",
    "cite",
    "state",
]
SLOW = [
    *QUICK, "points", "mesh", "svg", "pdf", "as-python", "store", "report", "linked", "schema", "taken home",
    "upload",
]  # fmt: skip
# Writers whose files have room on a disk of 8 kB.
SMALL = ("discs", "cite", "as-python")


@pytest.mark.parametrize("name", QUICK)
def test_a_limit_of_files_is_a_sentence_and_the_old_file_stays(writers, name):
    from faults.places import by_limit

    assert set(by_limit(writers[name], (0.6,), (True,))) == {"refused"}


@pytest.mark.slow
@pytest.mark.parametrize("name", SLOW)
def test_full_and_read_only_disks_are_sentences_and_old_files_stay(writers, name):
    from faults.places import by_limit, by_right, by_size

    writer = writers[name]
    # A study writes many files, and may fit below a limit that its largest one does not.
    assert "refused" in by_limit(writer, (0.0, 0.9, 2.0), (False, True))
    words = set(by_size(writer, (8, 40)))
    assert words <= {"refused", "not mounted", "done", "too small"}
    assert name in SMALL or words & {"refused", "not mounted"}
    by_right(writer)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["run", "tables", "life", "sweep", "calibrate", "report"])
def test_a_command_stopped_at_any_moment_leaves_what_is_whole_and_goes_on(name):
    from faults.kills import kills

    told = []
    assert kills(2, [name], seed=1, tell=told.append) == 0, "\n".join(told)


@pytest.mark.slow
def test_a_page_stopped_at_any_moment_leaves_no_process_and_starts_again():
    pytest.importorskip("nicegui")
    pytest.importorskip("aiohttp")
    from faults.pages import stopped_pages

    told = []
    assert stopped_pages(2, seed=1, tell=told.append) == 0, "\n".join(told)


def test_a_file_is_read_whole_or_refused_while_it_changes():
    from faults.races import read_while_replaced

    assert read_while_replaced(10, whole=True) == {"read": 10}
    read_while_replaced(10, whole=False)


def test_two_writers_leave_what_is_of_one():
    from faults.races import two_writers_of_a_file

    two_writers_of_a_file(50)


@pytest.mark.slow
def test_the_second_writer_of_a_store_is_refused_and_the_first_goes_on():
    from faults.races import read_while_replaced, two_writers_of_a_store

    assert "is being written by another study; wait for it" in two_writers_of_a_store()
    assert read_while_replaced(80, whole=True) == {"read": 80}
    assert sum(read_while_replaced(80, whole=False).values()) == 80


@pytest.mark.parametrize("signals", ["kill", "term", "interrupt"])
def test_a_process_stopped_while_it_writes_leaves_whole_files(signals):
    from faults.kills import stopped_while_writing

    assert stopped_while_writing(signals, 5).total() == 5


@pytest.mark.slow
@pytest.mark.parametrize("signals", ["kill", "term", "interrupt"])
def test_a_process_stopped_while_it_writes_leaves_whole_files_often(signals):
    from faults.kills import stopped_while_writing

    stopped_while_writing(signals, 60, seed=1)
