"""What a store records about its study: case, design, what is kept, version; under a checksum."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TypedDict, cast

from treadload._version import __version__
from treadload.case import Case
from treadload.errors import InputError
from treadload.files import write_whole
from treadload.sweeps.design import Design, DesignTable
from treadload.sweeps.manifest import read_mark, sealed, unsealed
from treadload.sweeps.work import Question

STUDY = "study.json"


def fingerprint(case: Case, design: Design, question: Question) -> str:
    """What identifies a study: case, files that it reads, design, fields, version."""
    table = case.as_tables()
    content = [__version__, table, design.to_json(), [reading.text for reading in question.selectors]]
    digest = hashlib.sha256(json.dumps(content, sort_keys=True, default=str).encode())
    for value in _texts(table):
        file = case.folder / value
        with contextlib.suppress(OSError, ValueError):
            if file.is_file():
                digest.update(hashlib.sha256(file.read_bytes()).digest())
    return digest.hexdigest()[:16]


def about(case: Case, design: Design, question: Question | None) -> dict[str, object]:
    """Description of a study, as attributes of its dataset."""
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


def write_description(path: Path, case: Case, design: Design, question: Question, name: str) -> None:
    """Write the description of a study into its store. name: its fingerprint."""
    content = {
        "treadload_study": 1,
        "version": __version__,
        "name": name,
        "case": case.to_toml(),
        "folder": os.path.relpath(case.folder.resolve(), path.resolve()),
        "design": design.to_json(),
        "asked": [reading.text for reading in question.selectors],
    }
    write_whole(path / STUDY, sealed(content))


def is_whole(path: Path) -> bool:
    """Whether the description of a study is there and undamaged."""
    try:
        unsealed((path / STUDY).read_bytes())
    except (OSError, ValueError):
        return False
    return True


class StudyTable(TypedDict):
    """What of the description of a study is read from its file."""

    treadload_study: int
    case: str
    folder: str
    design: DesignTable


def read_description(path: Path) -> StudyTable:
    """The description of a study. Raises InputError where there is none, or a damaged one."""
    try:
        text = (path / STUDY).read_bytes()
    except OSError as error:
        raise InputError(
            f"{path} is no study that `treadload sweep` has written: {error.strerror or error}; name the folder "
            "*.zarr that it made"
        ) from error
    try:
        study = cast("StudyTable", unsealed(text))
        if study.get("treadload_study") != 1:
            raise ValueError("it is another kind of file")
    except ValueError as error:
        mends = "the same `treadload sweep` mends it"
        mends = mends if read_mark(path) else "name another store, or remove the folder"
        raise InputError(
            f"{path} is no study that this version of `treadload sweep` has written, or is damaged: its {STUDY} "
            f"cannot be trusted, {error}; {mends}"
        ) from error
    return study


def check_same(path: Path, name: str) -> None:
    """Raise InputError for a store of another study. name: fingerprint of this one."""
    study = read_description(path)
    if study.get("name") != name:
        version = study.get("version")
        why = (
            f"treadload {version} began it, and this is {__version__}"
            if version != __version__
            else "its case, its files, what is varied or what is kept differ"
        )
        raise InputError(f"{path} holds another study: {why}; give another name with -o, or remove the folder")
