"""The store of a study: a Zarr group that others can open, and a journal that no interruption breaks.

Every record is a line of the journal, `.records.jsonl`, as soon as its case ends. The arrays of the group are made of
the journal, of the numbers again and again, of the fields when the study stops: until then each case's fields wait in
a file of their own in `.fields`. `.current`, the mark, records of which journal the arrays are made, and the size and
checksum of their files; while these are as they were, no record has to be read. What is damaged is made again of
the journal; cases whose fields are lost are solved again.
"""

from __future__ import annotations

import contextlib
import errno
import importlib.util
import os
import shutil
import time
import warnings
import zlib
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

from treadload.case import Case
from treadload.deferred import xarray as xr
from treadload.errors import InputError, WriteError
from treadload.files import write_whole
from treadload.sweeps.arrays import damaged_fields, keep_fields, restore_fields, write_arrays, write_fields, zarr
from treadload.sweeps.description import (
    STUDY,
    about,
    check_same,
    fingerprint,
    is_whole,
    read_description,
    write_description,
)
from treadload.sweeps.design import Design
from treadload.sweeps.gathered import gathered, label_of
from treadload.sweeps.journal import Journal, checksum, line_of, read_journal
from treadload.sweeps.manifest import (
    CURRENT,
    Mark,
    clear_arrays,
    damaged,
    lost_fields,
    manifest,
    read_mark,
)
from treadload.sweeps.record import Record, RecordTable
from treadload.sweeps.work import Question

SUFFIX = ".zarr"
_JOURNAL, _FIELDS = ".records.jsonl", ".fields"
# Cases that a sentence lists.
_LISTED = 5
# The arrays are brought up to date so often, s, and never for more than this share of the time.
_OFTEN, _SHARE = 5.0, 0.03
_DAMAGED = "what was kept of its fields is damaged; the same command solves it again, check the disk of the study"


class Store:
    """The records of a study, on disk as they come. Use `opened` or `begun`.

    finished: True where every case that can be is solved and the arrays hold it: then no record is read. repaired: a
    sentence on what was damaged and is solved again, "" if nothing was.
    """

    def __init__(self, path: Path, case: Case, design: Design, question: Question, name: str) -> None:
        self.path, self.case, self.design, self.question, self.name = path, case, design, question, name
        self.records: dict[int, Record] = {}
        self.finished, self.repaired = False, ""
        self._journal: Any = None
        self._kept = Journal(path / _JOURNAL)
        self._mark, self._seen = Mark(name), dict[str, tuple[int, int, int]]()
        self._written, self._cost, self._dirty = 0.0, 0.0, True

    def read(self, mark: Mark | None, wrong: Sequence[str]) -> None:
        """Go on from a journal. mark: of the arrays, None for none. wrong: their damaged files."""
        journal = self._kept = read_journal(self.path / _JOURNAL, self.design.count)
        state = (journal.end, journal.crc)
        self._dirty = mark is None or mark.journal != state or bool(wrong)
        # Failures are tried again: a machine, a limit or the program may be another today.
        faults = self.design.faults
        self.records = {n: record for n, record in journal.records.items() if record.failure is None or n in faults}
        if mark is not None:
            journal.lost = max(journal.lost, mark.done - len(self.records))
        damage_text = wrong if mark is not None and mark.journal is not None else ()
        self.repaired = "; ".join(
            text
            for text in (
                self.repaired,
                journal.damage(self.design.count - len(journal.records), repaired=True),
                _unmarked(self.path, journal, mark, damage_text, repaired=True),
                self._mend_fields(mark, wrong),
            )
            if text
        )

    def _mend_fields(self, mark: Mark | None, wrong: Sequence[str]) -> str:
        """Forget the cases whose fields are lost, and remove damaged arrays. Returns a sentence, "" if none are."""
        files = self._files()
        bad = damaged_fields(files)
        for number in bad:
            files.pop(number).unlink()
        columns = {*(mark.names if mark else ()), "status", "seconds", *self.design.coordinates(), *self.design.dims}
        lost = None if mark is None else lost_fields(self.path, self.design.shape, wrong, columns)
        kept = frozenset[int]() if mark is None or lost is None else mark.fields - lost
        if mark is None or (wrong and not kept):
            clear_arrays(self.path)
        elif wrong:
            clear_arrays(self.path, wrong, columns)
        self._mark = replace(mark or self._mark, fields=kept)
        if mark is None:
            with self.writing():
                self._keep_mark(self._mark)
        again = sorted((self._kept.fields & set(self.records)) - kept - set(files))
        for number in again:
            del self.records[number]
        return _lost_in_words(again, self.design, self.path) if again else ""

    def _files(self) -> dict[int, Path]:
        """Files of the fields of cases, by number."""
        files = {int(file.stem): file for file in (self.path / _FIELDS).glob("*.npz") if file.stem.isdecimal()}
        return {number: file for number, file in sorted(files.items()) if number in self.records}

    def append(self, record: Record) -> None:
        """Keep a record. Raises WriteError where the disk is full."""
        stored = record.to_json()
        line = line_of(stored)
        with self.writing():
            if record.fields:
                keep_fields(record, self.path / _FIELDS)
            if self._journal.write(line) < len(line):
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        self._kept.end += len(line)
        self._kept.crc = zlib.crc32(line, self._kept.crc)
        # Fields wait on disk, not in memory.
        self.records[record.number] = Record.from_json(cast("RecordTable", stored))
        self._dirty = True
        if time.monotonic() - self._written > max(_OFTEN, self._cost / _SHARE):
            self.write_numbers()

    def write_numbers(self) -> None:
        """Bring the arrays of the numbers up to date. Raises WriteError where the disk is full."""
        if not self._dirty:
            return
        began = time.monotonic()
        data = self.numbers()
        self._kept.records = self.records
        mark = replace(
            self._mark,
            journal=(self._kept.end, self._kept.crc),
            done=sum(record.failure is None or n in self.design.faults for n, record in self.records.items()),
            names=tuple(_names(self._kept, self.design)),
        )
        with self.writing():
            # Whoever finds a mark without a journal reads the journal.
            self._keep_mark(replace(self._mark, journal=None))
            write_arrays(data, self.path)
            self._keep_mark(replace(mark, files=manifest(self.path, self._seen)))
        self._written = time.monotonic()
        self._cost, self._dirty = self._written - began, False

    def _keep_mark(self, mark: Mark) -> None:
        write_whole(self.path / CURRENT, mark.text(), sync=False)
        self._mark = mark

    def numbers(self) -> xr.Dataset:
        """The numbers of all records."""
        records = sorted(self.records.values(), key=lambda record: record.number)
        damage = self._kept.damage(self.design.count - len(records))
        data = gathered(self.design, records).assign_attrs(about(self.case, self.design, self.question))
        return data.assign_attrs(damage=damage) if damage else data

    def close(self) -> None:
        """Bring all arrays up to date. Raises WriteError where the disk is full."""
        try:
            self._write_fields()
        finally:
            self.write_numbers()
        # Not before the mark says that the arrays have them.
        if (self.path / _FIELDS).exists() and len(self.records) == self.design.count:
            shutil.rmtree(self.path / _FIELDS)

    def _write_fields(self) -> None:
        """Put the fields of all cases into arrays over common places."""
        files = self._files()
        if not files:
            return
        folder, self._dirty = self.path / _FIELDS, True
        with self.writing():
            numbers = {label_of(name, self.design) for record in self.records.values() for name in record.numbers}
            solved = {number for number, record in self.records.items() if record.failure is None}
            behind = sorted((solved & self._mark.fields) - set(files))
            files |= restore_fields(self.path, self.design, behind, numbers, folder)
            # From here on they are in the files alone.
            self._keep_mark(replace(self._mark, journal=None, fields=frozenset()))
            damaged = write_fields(self.path, self.design, dict(sorted(files.items())))
            for number in damaged:
                files.pop(number).unlink()
                self.append(Record(number, 0.0, failure=_DAMAGED))
            self._mark = replace(self._mark, fields=frozenset(files))

    @contextlib.contextmanager
    def writing(self) -> Iterator[None]:
        """State what is kept where the disk is full. Raises WriteError."""
        try:
            yield
        except (OSError, WriteError) as error:
            cause = error.__cause__ if isinstance(error, WriteError) else error
            why = getattr(cause, "strerror", None) or cause or error
            raise WriteError(
                f"cannot write to {self.path}: {why}; {self.state_in_words()}, and the same command goes on from "
                "there"
            ) from cause

    def state_in_words(self) -> str:
        """How much is kept, for a sentence."""
        kept = self.design.count if self.finished else len(self.records)
        return f"{kept} of {self.design.count} cases are kept in {self.path}"


@contextlib.contextmanager
def begun(path: str | os.PathLike[str], case: Case, design: Design, question: Question) -> Iterator[Store]:
    """The store of a study, new or begun before; closed in any case, its arrays up to date.

    Raises InputError for a path that cannot be a store, one of another study, and one that is being written;
    WriteError where the disk is full.
    """
    zarr()
    path = _checked(path)
    name = fingerprint(case, design, question)
    store = Store(path, case, design, question, name)
    with _locked(path):
        mark = read_mark(path)
        # A damaged description is written again if the mark is that of this study.
        if mark is not None and mark.study == name and not is_whole(path):
            store.repaired = f"the description of the study, {path / STUDY}, was damaged and is written again"
            with store.writing():
                write_description(path, case, design, question, name)
        elif (path / STUDY).exists():
            check_same(path, name)
        elif any(file.name != ".lock" for file in path.iterdir()):
            raise InputError(f"{path} exists and is no study; give another name, or remove it")
        else:
            with store.writing():
                _write_study(path, case, design, question, name)
        wrong = [] if mark is None else damaged(path, mark.files)
        # Fields that wait are put together first.
        whole = mark is not None and mark.done == design.count and not wrong and not (path / _FIELDS).exists()
        if mark is not None and whole and mark.journal == checksum(path / _JOURNAL):
            store.finished = True
            yield store
            return
        store.read(mark, wrong)
        with contextlib.ExitStack() as stack:
            with store.writing():
                # A buffer would be written once more when it is closed, on the same full disk.
                stream = stack.enter_context((path / _JOURNAL).open("ab", buffering=0))
                stream.truncate(store._kept.end)
            store._journal = stream
            try:
                yield store
            finally:
                store.close()


def opened(path: str | os.PathLike[str]) -> tuple[xr.Dataset, Case, str]:
    """A study's dataset, its arrays read when they are used, its case and its folder's name.

    Works while it is being solved and after it was killed. Raises InputError for what is no study.
    """
    zarr()
    path = Path(path)
    study = read_description(path)
    try:
        case = Case.from_text(study["case"], folder=path / study["folder"], name=f"the case of {path}")
        design = Design.from_json(study["design"], case)
    except (KeyError, TypeError) as error:
        raise InputError(f"{path} cannot be read as a study: {type(error).__name__}: {error}") from error
    mark, wrong = read_mark(path), list[str]()
    if mark is not None and mark.journal == checksum(path / _JOURNAL):
        wrong = damaged(path, mark.files)
        if not wrong:
            return _in_order(_arrays(path), mark.names), case, str(path)
        # A study that goes on may have changed them in the meantime.
        wrong = wrong if read_mark(path) == mark else []
    # Killed before the arrays were last made, or the arrays or their journal have become others.
    journal = read_journal(path / _JOURNAL, design.count)
    if mark is not None and read_mark(path) == mark:
        done = sum(record.failure is None or n in design.faults for n, record in journal.records.items())
        journal.lost = max(journal.lost, mark.done - done)
    data = gathered(design, sorted(journal.records.values(), key=lambda record: record.number))
    damage = [journal.damage(design.count - len(journal.records)), _unmarked(path, journal, mark, wrong)]
    damage_text = "; ".join(text for text in damage if text)
    data = data.assign_attrs(about(case, design, None) | ({"damage": damage_text} if damage_text else {}))
    return _in_order(data, _names(journal, design)), case, str(path)


def _arrays(path: Path) -> xr.Dataset:
    """The arrays of a store, read when they are used."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        data: xr.Dataset = xr.open_zarr(path, chunks=None, consolidated=False, decode_times=False)
        return data


def _unmarked(
    path: Path, journal: Journal, mark: Mark | None, wrong: Sequence[str], *, repaired: bool = False
) -> str:
    """A sentence where the arrays cannot be trusted, "" where they can or none were made."""
    if wrong:
        more = f" and {len(wrong) - 1} more" if len(wrong) > 1 else ""
        why = f"arrays of {path} are damaged or missing ({wrong[0]}{more})"
    elif mark is None and journal.records:
        why = f"{path / CURRENT}, which vouches for the arrays, is damaged or missing"
    else:
        return ""
    if repaired:
        return f"{why}: they were made again of the journal; check the disk that the study is on"
    return f"{why}: numbers are read from the journal, without fields; the same command makes the arrays again"


def _lost_in_words(numbers: Sequence[int], design: Design, path: Path) -> str:
    listed = "; ".join(f"{number} ({design.words_of(number)})" for number in numbers[:_LISTED])
    more = f" and {len(numbers) - _LISTED} more" if len(numbers) > _LISTED else ""
    cases = "1 case" if len(numbers) == 1 else f"{len(numbers)} cases"
    return (
        f"fields of {cases} in {path} were damaged or missing, number {listed}{more}: "
        f"{'it was' if len(numbers) == 1 else 'they were'} solved again"
    )


def _names(journal: Journal, design: Design) -> list[str]:
    """Numbers of all records, in the order of their first."""
    return list(
        dict.fromkeys(label_of(name, design) for record in journal.records.values() for name in record.numbers)
    )


def _in_order(data: xr.Dataset, names: Sequence[str]) -> xr.Dataset:
    """Arrays with the state of every case first, then its numbers, then fields."""
    first = [name for name in ("status", "seconds", *names) if name in data]
    return data[[*first, *(name for name in data.data_vars if name not in first)]]


def _checked(path: str | os.PathLike[str]) -> Path:
    path = Path(path)
    if path.suffix != SUFFIX:
        raise InputError(f"the store of a study is a folder *{SUFFIX}, got {path}; take {path.with_suffix(SUFFIX)}")
    if path.exists() and not path.is_dir():
        raise InputError(f"{path} is a file; a store is a folder, give another name")
    try:
        path.mkdir(exist_ok=True)
    except OSError as error:
        raise InputError(f"cannot make the store {path}: {error.strerror or error}") from error
    return path


@contextlib.contextmanager
def _locked(path: Path) -> Iterator[None]:
    """Only one study writes to a store; the lock goes with the process, however it ends."""
    try:
        lock = (path / ".lock").open("w")
    except OSError as error:
        raise InputError(f"cannot write to {path}: {error.strerror or error}") from error
    with lock:
        # Where there are no such locks, two studies in one store are the user's care.
        if importlib.util.find_spec("fcntl") is not None:
            import fcntl

            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError as error:
                raise InputError(
                    f"{path} is being written by another study; wait for it, or name another store"
                ) from error
        _clear(path)
        try:
            yield
        finally:
            _clear(path)


def _clear(path: Path) -> None:
    """Remove what a kill or a full disk has left half written, of ours and of zarr."""
    for file in [*path.rglob("*.part"), *path.rglob("*.partial")]:
        with contextlib.suppress(OSError):
            file.unlink()


def _write_study(path: Path, case: Case, design: Design, question: Question, name: str) -> None:
    write_description(path, case, design, question, name)
    # So that it opens before the first case has ended.
    write_arrays(gathered(design, ()).assign_attrs(about(case, design, question)), path)
