"""What a store records about its files: JSON under a checksum, sizes and checksums of the files of its arrays."""

from __future__ import annotations

import contextlib
import json
import shutil
import zlib
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from treadload.sweeps.journal import line_of

CURRENT = ".current"
# Names of zarr's files; all others of an array are its chunks.
_ABOUT = (".zgroup", ".zattrs", ".zarray", ".zmetadata")
_BLOCK = 1 << 20

Files = dict[str, tuple[int, int]]
"""Size and checksum of files, by their path in the store."""


@dataclass(frozen=True)
class Mark:
    """Of what the arrays are made, when they were last brought up to date.

    study: fingerprint. journal: its bytes and their checksum; None while the arrays are being made. done: cases that
    have ended for good. names: of the numbers, in order. files: of the arrays. fields: cases with fields in them.
    """

    study: str
    journal: tuple[int, int] | None = None
    done: int = 0
    names: tuple[str, ...] = ()
    files: Files = field(default_factory=dict)
    fields: frozenset[int] = frozenset()

    def text(self) -> str:
        """The mark under a checksum."""
        return sealed(
            {
                "study": self.study, "journal": self.journal, "done": self.done, "names": list(self.names),
                "files": self.files, "fields": _ranges(self.fields),
            }
        )  # fmt: skip


def sealed(content: Mapping[str, object]) -> str:
    """JSON of a mapping with the checksum of its text as the last entry."""
    return line_of(content).decode("ascii")


def unsealed(text: bytes) -> dict[str, object]:
    """What `sealed` has written. Raises ValueError where the checksum is missing or differs."""
    try:
        content = json.loads(text)
        check = content.pop("check")
    except (ValueError, LookupError, AttributeError, TypeError, RecursionError) as error:
        raise ValueError("it has no checksum") from error
    if line_of(content) != text or not isinstance(check, str):
        raise ValueError("its checksum differs")
    return dict(content)


def read_mark(path: Path) -> Mark | None:
    """The mark of a store; None where it is missing or damaged."""
    try:
        state = json.loads(json.dumps(unsealed((path / CURRENT).read_bytes())))
        journal = state["journal"]
        return Mark(
            str(state["study"]), None if journal is None else (int(journal[0]), int(journal[1])), int(state["done"]),
            tuple(state["names"]), {name: (int(size), int(crc)) for name, (size, crc) in state["files"].items()},
            frozenset(number for first, end in state["fields"] for number in range(first, end)),
        )  # fmt: skip
    except (OSError, ValueError, LookupError, TypeError, AttributeError):
        return None


def manifest(path: Path, seen: dict[str, tuple[int, int, int]]) -> Files:
    """Files of the arrays of a store. seen: size, time of change, ns, and checksum of before; brought up to date."""
    files: Files = {}
    for name in _names(path):
        state = (path / name).stat()
        recorded = seen.get(name)
        if recorded is None or recorded[:2] != (state.st_size, state.st_mtime_ns):
            recorded = seen[name] = (state.st_size, state.st_mtime_ns, _sum(path / name))
        files[name] = (recorded[0], recorded[2])
    return files


def damaged(path: Path, files: Files) -> list[str]:
    """Files of the arrays that are missing, too many, or differ from a manifest, sorted."""
    there = set(_names(path))
    wrong = there ^ set(files)
    for name in there & set(files):
        size, crc = files[name]
        try:
            if (path / name).stat().st_size != size or _sum(path / name) != crc:
                wrong.add(name)
        except OSError:
            wrong.add(name)
    return sorted(wrong)


def clear_arrays(path: Path, wrong: Iterable[str] | None = None, numbers: Collection[str] = ()) -> None:
    """Remove arrays whose files are damaged, of a field the damaged chunks alone; all of them if `wrong` is None.

    numbers: names of arrays that are no fields.
    """
    listed = _names(path) if wrong is None else [*wrong]
    for name in [*listed, ".zmetadata"]:
        array, _, file = name.rpartition("/")
        with contextlib.suppress(FileNotFoundError, NotADirectoryError):
            if array and (wrong is None or array in numbers or file in _ABOUT):
                shutil.rmtree(path / array)
            else:
                (path / name).unlink()


def lost_fields(
    path: Path, shape: tuple[int, ...], wrong: Iterable[str], numbers: Collection[str]
) -> set[int] | None:
    """Cases whose fields stood in damaged files; None for all.

    shape: of the design. wrong: see `damaged`. numbers: names of arrays that are no fields.
    """
    lost: set[int] = set()
    for name in wrong:
        array, _, file = name.rpartition("/")
        if not array or array in numbers:
            continue
        try:
            chunks = [int(size) for size in json.loads((path / array / ".zarray").read_bytes())["chunks"]]
            block = [int(part) for part in file.split(".")]
        except (OSError, ValueError, LookupError, TypeError):
            return None
        # The places of a field are an array of their own, which all cases need.
        if f"{array}/.zarray" in wrong or len(block) != len(chunks) or len(chunks) <= len(shape):
            return None
        first = 0
        for at, size in zip(block[: len(shape)], shape, strict=True):
            first = first * size + at
        along, last = chunks[len(shape) - 1], block[len(shape) - 1]
        first += last * (along - 1)
        lost |= set(range(first, first + min(along, shape[-1] - last * along)))
    return lost


def _names(path: Path) -> list[str]:
    """Files of the arrays, by their path in the store: those of the group, and those of folders that are not ours."""
    names = [name for name in _ABOUT if (path / name).is_file()]
    for folder in path.iterdir():
        if folder.is_dir() and not folder.name.startswith("."):
            names += [
                file.relative_to(path).as_posix()
                for file in folder.rglob("*")
                if file.is_file() and ".part" not in file.name
            ]
    return names


def _sum(file: Path) -> int:
    crc = 0
    with file.open("rb") as stream:
        while block := stream.read(_BLOCK):
            crc = zlib.crc32(block, crc)
    return crc


def _ranges(numbers: Collection[int]) -> list[list[int]]:
    """First and end of the runs of whole numbers."""
    runs: list[list[int]] = []
    for number in sorted(numbers):
        if runs and runs[-1][1] == number:
            runs[-1][1] += 1
        else:
            runs.append([number, number + 1])
    return runs
