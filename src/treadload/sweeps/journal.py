"""The journal of a study: one line for each case as soon as it ends, with a checksum of its own.

A last line that was cut off counts as not written; a damaged line is left out, and the lines behind it are kept.
"""

from __future__ import annotations

import json
import re
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from treadload.errors import InputError
from treadload.sweeps.record import Record

# Where a line ends with its checksum, and where the record of a case begins.
_CHECK = re.compile(rb',"check":"([0-9a-f]{8})"\}\n')
_BEGIN = re.compile(rb'\{"number": ?')
# A line of a study that was begun without checksums has nothing but these names.
_NAMES = {"number", "seconds", "failure", "warnings", "numbers", "coordinates", "fields"}
# Numbers of damaged lines that a sentence lists.
_LISTED = 5


@dataclass
class Journal:
    """What a journal holds.

    records: by number of the case, the last of each. end: bytes up to the end of the last good line. crc: checksum of
    these bytes. damaged: numbers of damaged lines, from 1. lost: cases on them, or behind its end. fields: cases
    that have fields.
    """

    path: Path
    records: dict[int, Record] = field(default_factory=dict)
    end: int = 0
    crc: int = 0
    damaged: tuple[int, ...] = ()
    lost: int = 0
    fields: set[int] = field(default_factory=set)

    def damage(self, missing: int, *, repaired: bool = False) -> str:
        """A sentence on the damaged lines, "" without any that matter. missing: cases of the study without a record.

        repaired: True once these cases have been solved again.
        """
        lost = min(self.lost, missing)
        if not lost:
            return ""
        cases = "1 case" if lost == 1 else f"{lost} cases"
        again = (
            f"{cases} {'was' if lost == 1 else 'were'} solved again"
            if repaired
            else f"the same command solves {cases} again"
        )
        if not self.damaged:
            return f"the journal {self.path} has lost its end: {again}; check the disk that the study is on"
        several, first = len(self.damaged) > 1, ", ".join(map(str, self.damaged[:_LISTED]))
        more = f" and {len(self.damaged) - _LISTED} more" if len(self.damaged) > _LISTED else ""
        return (
            f"line{'s' if several else ''} {first}{more} of the journal {self.path} {'are' if several else 'is'} "
            f"damaged and left out: {again}; check the disk that the study is on"
        )


def line_of(content: Mapping[str, object]) -> bytes:
    """The line of a record, of its `to_json`."""
    # ASCII, since the name of a file in a sentence may be no UTF-8.
    body = json.dumps(content, separators=(",", ":")).encode("ascii")
    return body[:-1] + b',"check":"%08x"}\n' % zlib.crc32(body)


def read_journal(path: Path, count: int) -> Journal:
    """The journal in a file, empty where there is none. count: of cases of the study. Raises InputError."""
    journal = Journal(path)
    wrong: list[int] = []
    at, crc = 0, 0
    try:
        with path.open("rb") as stream:
            for number, line in enumerate(stream, start=1):
                at, crc = at + len(line), zlib.crc32(line, crc)
                record, has_fields = _record(line, count)
                if record is not None:
                    journal.records[record.number] = record
                    (journal.fields.add if has_fields else journal.fields.discard)(record.number)
                    journal.end, journal.crc = at, crc
                elif line.endswith(b"\n"):
                    wrong.append(number)
                    # A lost end of a line joins two of them, a false one parts one in two.
                    journal.lost += len(_BEGIN.findall(line))
    except FileNotFoundError:
        pass
    except OSError as error:
        raise InputError(f"cannot read the journal {path}: {error.strerror or error}") from error
    journal.damaged = tuple(wrong)
    journal.lost = max(journal.lost, min(1, len(wrong)))
    return journal


def checksum(path: Path) -> tuple[int, int]:
    """Bytes of a journal and their checksum, without reading its records. Raises InputError."""
    size, crc = 0, 0
    try:
        with path.open("rb") as stream:
            while block := stream.read(1 << 20):
                size, crc = size + len(block), zlib.crc32(block, crc)
    except FileNotFoundError:
        pass
    except OSError as error:
        raise InputError(f"cannot read the journal {path}: {error.strerror or error}") from error
    return size, crc


def _record(line: bytes, count: int) -> tuple[Record | None, bool]:
    """The record of a line, None for a damaged one, and whether its case has fields."""
    check = _CHECK.search(line, max(0, len(line) - 22))
    try:
        if check is None:
            content: Any = json.loads(line)
            good = line.endswith(b"\n") and isinstance(content, dict) and set(content) <= _NAMES
        else:
            body = line[: check.start()] + b"}"
            good = check.end() == len(line) and int(check[1], 16) == zlib.crc32(body)
            content = json.loads(body) if good else None
        record = Record.from_json(content) if good else None
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return None, False
    if record is None or not 0 <= record.number < count:
        return None, False
    return record, bool(content.get("fields"))
