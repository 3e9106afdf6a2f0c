"""The store of a study: a Zarr group that others can open, and a journal that no interruption breaks.

Every record is a line of the journal, `.records.jsonl`, as soon as its case ends; a line that was cut off when the
power went counts as not written. The arrays of the group are made from the journal, of the numbers again and again,
of the fields when the study stops: until then each case's fields wait in a file of their own in `.fields`.
"""

from __future__ import annotations

import contextlib
import hashlib
import importlib.util
import json
import os
import shutil
import time
import warnings
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import xarray as xr

from treadload._version import __version__
from treadload.case import Case, LifeCase
from treadload.case.file import FilePart
from treadload.errors import InputError, one_line
from treadload.study.sweeps.arrays import keep_fields, write_arrays, write_fields, zarr
from treadload.study.sweeps.design import Design
from treadload.study.sweeps.gathered import gathered, label_of
from treadload.study.sweeps.record import Record
from treadload.study.sweeps.work import Question

SUFFIX = ".zarr"
_STUDY, _JOURNAL, _FIELDS = "study.json", ".records.jsonl", ".fields"
# The arrays are brought up to date so often, s, and never for more than this share of the time.
_OFTEN, _SHARE = 5.0, 0.03
_KINDS: Mapping[str, type[FilePart]] = {kind.__name__: kind for kind in (Case, LifeCase)}


class Store:
    """The records of a study, on disk as they come. Use `opened` or `begun`."""

    def __init__(self, path: Path, case: FilePart, design: Design, question: Question, name: str) -> None:
        self.path, self.case, self.design, self.question, self.name = path, case, design, question, name
        self.records: dict[int, Record] = {}
        self._journal: Any = None
        self._written, self._cost, self._dirty = 0.0, 0.0, True

    def append(self, record: Record) -> None:
        """Keep a record. Raises InputError where the disk is full."""
        try:
            if record.fields:
                keep_fields(record, self.path / _FIELDS)
            self._journal.write(json.dumps(record.to_json(), ensure_ascii=False) + "\n")
            self._journal.flush()
        except OSError as error:
            raise self._full(error) from error
        # Fields wait on disk, not in memory.
        self.records[record.number] = Record(
            record.number, record.seconds, record.numbers, {}, record.coordinates, record.warnings, record.failure
        )
        self._dirty = True
        if time.monotonic() - self._written > max(_OFTEN, self._cost / _SHARE):
            self.write_numbers()

    def write_numbers(self) -> None:
        """Bring the arrays of the numbers up to date. Raises InputError where the disk is full."""
        if not self._dirty:
            return
        began = time.monotonic()
        data = self.numbers()
        try:
            write_arrays(data, self.path)
        except OSError as error:
            raise self._full(error) from error
        self._written = time.monotonic()
        self._cost, self._dirty = self._written - began, False

    def numbers(self) -> xr.Dataset:
        """The numbers of all records."""
        known = sorted(self.records.values(), key=lambda one: one.number)
        return gathered(self.design, known).assign_attrs(about(self.case, self.design, self.question))

    def write_fields(self) -> None:
        """Put the fields of all cases into arrays over common places; their files go when every case is solved."""
        files = {int(file.stem): file for file in (self.path / _FIELDS).glob("*.npz")}
        files = {number: file for number, file in sorted(files.items()) if number in self.records}
        if not files:
            return
        try:
            write_fields(self.path, self.design, files)
            if len(files) == self.design.count:
                shutil.rmtree(self.path / _FIELDS)
        except OSError as error:
            raise self._full(error) from error

    def _full(self, error: OSError) -> InputError:
        return InputError(
            f"cannot write to {self.path}: {error.strerror or error}; {self.told()}, and the same command goes on "
            "from there"
        )

    def told(self) -> str:
        """How much is kept, for a sentence."""
        return f"{len(self.records)} of {self.design.count} cases are kept in {self.path}"


@contextlib.contextmanager
def begun(path: str | os.PathLike[str], case: FilePart, design: Design, question: Question) -> Iterator[Store]:
    """The store of a study, new or begun before; closed in any case, its arrays up to date.

    Raises InputError for a path that cannot be a store, one of another study, and one that is being written.
    """
    zarr()
    path = _checked(path)
    name = fingerprint(case, design, question)
    store = Store(path, case, design, question, name)
    with _own(path):
        if (path / _STUDY).exists():
            _check_same(path, name)
        elif any(file.name not in (".lock", f".{_STUDY}.part") for file in path.iterdir()):
            raise InputError(f"{path} exists and is no study; give another name, or remove it")
        else:
            _write_study(path, case, design, question, name)
        good = _read_journal(path, store.records, design)
        journal = path / _JOURNAL
        with journal.open("a", encoding="utf-8") as stream:
            stream.truncate(good)
            store._journal = stream
            # Failures are tried again: a machine, a limit or the program may be another today.
            store.records = {number: one for number, one in store.records.items() if one.failure is None}
            try:
                yield store
            finally:
                store.write_numbers()
                store.write_fields()


def opened(path: str | os.PathLike[str]) -> tuple[xr.Dataset, FilePart, str]:
    """A study's dataset, its arrays read when they are used, its case and its folder's name.

    Works while it is being solved and after it was killed. Raises InputError for what is no study.
    """
    zarr()
    path = Path(path)
    told = _study(path)
    try:
        case = _KINDS[told["kind"]].from_text(told["case"], folder=path / told["folder"], name=f"the case of {path}")
        design = Design.from_json(told["design"], case)
    except (KeyError, TypeError) as error:
        raise InputError(f"{path} cannot be read as a study: {type(error).__name__}: {error}") from error
    records: dict[int, Record] = {}
    _read_journal(path, records, design)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            data = xr.open_zarr(path, chunks=None, consolidated=False, decode_times=False)
            current = int((data["status"] != 0).sum()) == len(records)
        except Exception:
            # Killed before the arrays were first made.
            data, current = xr.Dataset(), False
    if not current:
        fresh = gathered(design, sorted(records.values(), key=lambda one: one.number))
        data = fresh.assign_attrs(about(case, design, None))
    order = ["status", "seconds", *(label_of(name, design) for one in records.values() for name in one.numbers)]
    first = [name for name in dict.fromkeys(order) if name in data]
    return data[[*first, *(name for name in data.data_vars if name not in first)]], case, str(path)


def fingerprint(case: FilePart, design: Design, question: Question) -> str:
    """What tells studies apart: case, files that it reads, design, fields, version."""
    table = case.given()
    told = [__version__, question.kind, table, design.to_json(), [one.text for one in question.asked]]
    digest = hashlib.sha256(json.dumps(told, sort_keys=True, default=str).encode())
    for value in _texts(table):
        file = case.folder / value
        with contextlib.suppress(OSError, ValueError):
            if file.is_file():
                digest.update(hashlib.sha256(file.read_bytes()).digest())
    return digest.hexdigest()[:16]


def about(case: FilePart, design: Design, question: Question | None) -> dict[str, Any]:
    """What a study says of itself, as attributes of its dataset."""
    return {
        "title": case.title,
        "case": case.to_toml(),
        "kind": type(case).__name__,
        "cases": design.count,
        "design": json.dumps(design.to_json(), ensure_ascii=False),
        "treadload_version": __version__,
        **({} if question is None else {"asked": json.dumps([one.text for one in question.asked])}),
    }


def _texts(value: Any) -> Iterator[str]:
    if isinstance(value, str):
        if len(value) < 4096:
            yield value
    elif isinstance(value, Mapping | list | tuple):
        for one in value.values() if isinstance(value, Mapping) else value:
            yield from _texts(one)


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
def _own(path: Path) -> Iterator[None]:
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
        yield


def _write_study(path: Path, case: FilePart, design: Design, question: Question, name: str) -> None:
    told = {
        "treadload_study": 1,
        "version": __version__,
        "name": name,
        "kind": question.kind,
        "case": case.to_toml(),
        "folder": os.path.relpath(case.folder.resolve(), path.resolve()),
        "design": design.to_json(),
        "asked": [one.text for one in question.asked],
    }
    temporary = path / f".{_STUDY}.part"
    temporary.write_text(json.dumps(told, ensure_ascii=False), encoding="utf-8")
    temporary.replace(path / _STUDY)
    # So that it opens before the first case has ended.
    write_arrays(gathered(design, ()).assign_attrs(about(case, design, question)), path)


def _study(path: Path) -> dict[str, Any]:
    try:
        told = json.loads((path / _STUDY).read_text(encoding="utf-8"))
        if not isinstance(told, dict) or told.get("treadload_study") != 1:
            raise ValueError("another kind of file")
    except (OSError, ValueError, RecursionError) as error:
        raise InputError(
            f"{path} is no study that `treadload sweep` has written: {one_line(str(error))[:200]}"
        ) from error
    return told


def _check_same(path: Path, name: str) -> None:
    told = _study(path)
    if told.get("name") != name:
        version = told.get("version")
        why = (
            f"treadload {version} began it, and this is {__version__}"
            if version != __version__
            else "its case, its files, what is varied or what is kept differ"
        )
        raise InputError(f"{path} holds another study: {why}; give another name with -o, or remove the folder")


def _read_journal(path: Path, records: dict[int, Record], design: Design) -> int:
    """Records by number; returns how many bytes of the journal are whole lines."""
    good = 0
    try:
        with (path / _JOURNAL).open("rb") as stream:
            for line in stream:
                try:
                    record = Record.from_json(json.loads(line))
                    whole = line.endswith(b"\n") and 0 <= record.number < design.count
                except (ValueError, KeyError, TypeError, RecursionError):
                    whole = False
                if not whole:
                    break
                records[record.number] = record
                good += len(line)
    except FileNotFoundError:
        pass
    except OSError as error:
        raise InputError(f"cannot read the journal of {path}: {error.strerror or error}") from error
    return good
