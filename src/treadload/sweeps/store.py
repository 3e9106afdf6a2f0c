"""The store of a study: a Zarr group that others can open, and a journal that no interruption breaks.

Every record is a line of the journal, `.records.jsonl`, as soon as its case ends. The arrays of the group are made of
the journal, of the numbers again and again, of the fields when the study stops: until then each case's fields wait in
a file of their own in `.fields`. `.current` says of which journal the arrays are made; while that is the journal,
nothing else has to be read.
"""

from __future__ import annotations

import contextlib
import errno
import hashlib
import importlib.util
import json
import os
import shutil
import time
import warnings
import zlib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import xarray as xr

from treadload._version import __version__
from treadload.case import Case
from treadload.errors import InputError, WriteError, one_line
from treadload.files import write_whole
from treadload.sweeps.arrays import keep_fields, restore_fields, write_arrays, write_fields, zarr
from treadload.sweeps.design import Design
from treadload.sweeps.gathered import gathered, label_of
from treadload.sweeps.journal import Journal, checksum, line_of, read_journal
from treadload.sweeps.record import Record
from treadload.sweeps.work import Question

SUFFIX = ".zarr"
_STUDY, _JOURNAL, _FIELDS, _CURRENT = "study.json", ".records.jsonl", ".fields", ".current"
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
        self._written, self._cost, self._dirty = 0.0, 0.0, True

    def read(self, journal: Journal, *, current: bool) -> None:
        """Go on from a journal. current: True if the arrays are made of it."""
        self._kept, self._dirty = journal, not current
        self.repaired = journal.damage(self.design.count - len(journal.records), repaired=True)
        # Failures are tried again: a machine, a limit or the program may be another today.
        faults = self.design.faults
        self.records = {n: record for n, record in journal.records.items() if record.failure is None or n in faults}

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
        self.records[record.number] = Record.from_json(stored)
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
        current = {
            "journal": [self._kept.end, self._kept.crc],
            "done": sum(record.failure is None or n in self.design.faults for n, record in self.records.items()),
            "names": _names(self._kept, self.design),
        }
        with self.writing():
            # Whoever finds no mark reads the journal.
            write_whole(self.path / _CURRENT, '{"journal": null}', sync=False)
            write_arrays(data, self.path)
            write_whole(self.path / _CURRENT, json.dumps(current), sync=False)
        self._written = time.monotonic()
        self._cost, self._dirty = self._written - began, False

    def numbers(self) -> xr.Dataset:
        """The numbers of all records."""
        records = sorted(self.records.values(), key=lambda record: record.number)
        damage = self._kept.damage(self.design.count - len(records))
        data = gathered(self.design, records).assign_attrs(about(self.case, self.design, self.question))
        return data.assign_attrs(damage=damage) if damage else data

    def write_fields(self) -> None:
        """Put the fields of all cases into arrays over common places; their files go when every case was tried."""
        folder = self.path / _FIELDS
        files = {int(file.stem): file for file in folder.glob("*.npz")}
        files = {number: file for number, file in sorted(files.items()) if number in self.records}
        if not files:
            return
        with self.writing():
            numbers = {label_of(name, self.design) for record in self.records.values() for name in record.numbers}
            solved = {number for number, record in self.records.items() if record.failure is None}
            files |= restore_fields(self.path, self.design, sorted(solved - set(files)), numbers, folder)
            damaged = write_fields(self.path, self.design, dict(sorted(files.items())))
            for number in damaged:
                files[number].unlink()
                self.append(Record(number, 0.0, failure=_DAMAGED))
            if len(self.records) == self.design.count:
                shutil.rmtree(folder)

    @contextlib.contextmanager
    def writing(self) -> Iterator[None]:
        """Say what is kept where the disk is full. Raises WriteError."""
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
        if (path / _STUDY).exists():
            _check_same(path, name)
        elif any(file.name != ".lock" for file in path.iterdir()):
            raise InputError(f"{path} exists and is no study; give another name, or remove it")
        else:
            with store.writing():
                _write_study(path, case, design, question, name)
        current = _current(path)
        # Fields that wait are put together first.
        whole = current.get("done") == design.count and not (path / _FIELDS).exists()
        if whole and current["journal"] == list(checksum(path / _JOURNAL)):
            store.finished = True
            yield store
            return
        journal = read_journal(path / _JOURNAL, design.count)
        store.read(journal, current=current.get("journal") == [journal.end, journal.crc])
        with contextlib.ExitStack() as stack:
            with store.writing():
                # A buffer would be written once more when it is closed, on the same full disk.
                stream = stack.enter_context((path / _JOURNAL).open("ab", buffering=0))
                stream.truncate(journal.end)
            store._journal = stream
            try:
                yield store
            finally:
                try:
                    store.write_fields()
                finally:
                    store.write_numbers()


def opened(path: str | os.PathLike[str]) -> tuple[xr.Dataset, Case, str]:
    """A study's dataset, its arrays read when they are used, its case and its folder's name.

    Works while it is being solved and after it was killed. Raises InputError for what is no study.
    """
    zarr()
    path = Path(path)
    study = _study(path)
    try:
        case = Case.from_text(study["case"], folder=path / study["folder"], name=f"the case of {path}")
        design = Design.from_json(study["design"], case)
    except (KeyError, TypeError) as error:
        raise InputError(f"{path} cannot be read as a study: {type(error).__name__}: {error}") from error
    current, journal = _current(path), None
    arrays = _arrays(path)
    if not current:
        # Of a store that was begun without a mark.
        journal = read_journal(path / _JOURNAL, design.count)
        if "status" in arrays and int((arrays["status"] != 0).sum()) == len(journal.records):
            current = {"journal": list(checksum(path / _JOURNAL)), "names": _names(journal, design)}
    if "status" in arrays and current.get("journal") == list(checksum(path / _JOURNAL)):
        return _in_order(arrays, current["names"]), case, str(path)
    # Killed before the arrays were last made, or their journal has become another.
    journal = journal or read_journal(path / _JOURNAL, design.count)
    data = gathered(design, sorted(journal.records.values(), key=lambda record: record.number))
    damage = journal.damage(design.count - len(journal.records))
    data = data.assign_attrs(about(case, design, None) | ({"damage": damage} if damage else {}))
    return _in_order(data, _names(journal, design)), case, str(path)


def _arrays(path: Path) -> xr.Dataset:
    """The arrays of a store, read when they are used; none where it was killed before they were first made."""
    with warnings.catch_warnings(), contextlib.suppress(Exception):
        warnings.simplefilter("ignore")
        data: xr.Dataset = xr.open_zarr(path, chunks=None, consolidated=False, decode_times=False)
        return data
    return xr.Dataset()


def _names(journal: Journal, design: Design) -> list[str]:
    """Numbers of all records, in the order of their first."""
    return list(
        dict.fromkeys(label_of(name, design) for record in journal.records.values() for name in record.numbers)
    )


def _in_order(data: xr.Dataset, names: Sequence[str]) -> xr.Dataset:
    """Arrays with the state of every case first, then its numbers, then fields."""
    first = [name for name in ("status", "seconds", *names) if name in data]
    return data[[*first, *(name for name in data.data_vars if name not in first)]]


def fingerprint(case: Case, design: Design, question: Question) -> str:
    """What tells studies apart: case, files that it reads, design, fields, version."""
    table = case.as_tables()
    content = [__version__, table, design.to_json(), [reading.text for reading in question.selectors]]
    digest = hashlib.sha256(json.dumps(content, sort_keys=True, default=str).encode())
    for value in _texts(table):
        file = case.folder / value
        with contextlib.suppress(OSError, ValueError):
            if file.is_file():
                digest.update(hashlib.sha256(file.read_bytes()).digest())
    return digest.hexdigest()[:16]


def about(case: Case, design: Design, question: Question | None) -> dict[str, Any]:
    """What a study says of itself, as attributes of its dataset."""
    return {
        "title": case.title,
        "case": case.to_toml(),
        "cases": design.count,
        "design": json.dumps(design.to_json(), ensure_ascii=False),
        "treadload_version": __version__,
        **({} if question is None else {"asked": json.dumps([reading.text for reading in question.selectors])}),
    }


def _texts(value: object) -> Iterator[str]:
    if isinstance(value, str):
        if len(value) < 4096:
            yield value
    elif isinstance(value, Mapping | list | tuple):
        for item in value.values() if isinstance(value, Mapping) else value:
            yield from _texts(item)


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
    content = {
        "treadload_study": 1,
        "version": __version__,
        "name": name,
        "case": case.to_toml(),
        "folder": os.path.relpath(case.folder.resolve(), path.resolve()),
        "design": design.to_json(),
        "asked": [reading.text for reading in question.selectors],
    }
    write_whole(path / _STUDY, json.dumps(content))
    # So that it opens before the first case has ended.
    write_arrays(gathered(design, ()).assign_attrs(about(case, design, question)), path)


def _current(path: Path) -> dict[str, Any]:
    """Of which journal the arrays are made; empty where nothing says it."""
    try:
        state = json.loads((path / _CURRENT).read_text(encoding="utf-8"))
        return {"journal": list(state["journal"] or ()), "done": int(state["done"]), "names": list(state["names"])}
    except FileNotFoundError:
        return {}
    except (OSError, ValueError, LookupError, TypeError, RecursionError):
        # Being made, or damaged: then the journal tells.
        return {"journal": []}


def _study(path: Path) -> dict[str, Any]:
    try:
        study = json.loads((path / _STUDY).read_text(encoding="utf-8"))
        if not isinstance(study, dict) or study.get("treadload_study") != 1:
            raise ValueError("another kind of file")
    except (OSError, ValueError, RecursionError) as error:
        raise InputError(
            f"{path} is no study that `treadload sweep` has written: {one_line(str(error))[:200]}"
        ) from error
    return study


def _check_same(path: Path, name: str) -> None:
    study = _study(path)
    if study.get("name") != name:
        version = study.get("version")
        why = (
            f"treadload {version} began it, and this is {__version__}"
            if version != __version__
            else "its case, its files, what is varied or what is kept differ"
        )
        raise InputError(f"{path} holds another study: {why}; give another name with -o, or remove the folder")
