"""X3P, a ZIP archive with an XML header (ISO 25178-72): bombs and lies are refused before heights are read."""

from __future__ import annotations

import hashlib
import io
import math
import re
import zipfile
from typing import TYPE_CHECKING
from xml.parsers import expat

from treadload.errors import InputError, one_line, reading

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

MOST_POINTS = 25_000_000
_MOST_MEMBERS = 1000
_MOST_XML = 2**22
_MOST_UNPACKED = 2**29
# Measured heights pack 1 to 20 times; what packs more in a large member is nothing measured.
_MOST_RATIO, _SMALL = 200, 2**20
_DEEPEST, _MOST_ELEMENTS = 32, 20_000
_HEADER = "main.xml"
_BYTES = {"I": 2, "L": 4, "F": 4, "D": 8}
_TYPES = {"I": "<i2", "L": "<i4", "F": "<f4", "D": "<f8"}
_AXES = "Record1/Axes"
_LINK = "Record3/DataLink"
_UNSAFE = re.compile(r"^[/\\]|^[A-Za-z]:|(^|[/\\])\.\.([/\\]|$)|\0")


def read_x3p(content: bytes, name: str) -> tuple[NDArray[np.float64], float, float]:
    """Heights (rows, columns), m, NaN where the file marks a point as invalid, and the spacing along x and y, m.

    The length of a member and its checksums, that of the archive and the MD5 of the header where it states one, must
    fit. Raises InputError with what is wrong in the file.
    """
    import numpy as np

    if not content.startswith(b"PK"):
        raise InputError(f"{name!r} is no ZIP archive, as every X3P file is; give it the ending of its format")
    with reading(repr(name), "X3P"), zipfile.ZipFile(io.BytesIO(content)) as archive:
        members = _members(archive, name)
        if _HEADER not in members:
            raise InputError(f"{name!r} has no {_HEADER}, as every X3P file has; export it again")
        if members[_HEADER].file_size > _MOST_XML:
            raise InputError(
                f"{_HEADER} of {name!r} has {members[_HEADER].file_size} bytes, more than {_MOST_XML}; export again"
            )
        fields = _fields(archive.read(members[_HEADER]), name)
        rows, columns, kind = _layout(fields, name)
        count = rows * columns
        raw = _member(archive, members, fields, "Point", count * _BYTES[kind], name)
        heights = np.frombuffer(raw, dtype=_TYPES[kind]).astype(np.float64).reshape(rows, columns)
        if fields.get(f"{_LINK}/ValidPointsLink"):
            bits = np.frombuffer(_member(archive, members, fields, "Valid", -(-count // 8), name), dtype=np.uint8)
            valid = np.unpackbits(bits, count=count, bitorder="little").reshape(rows, columns).astype(bool)
            heights[~valid] = np.nan
    scale, offset = (
        _number(fields, f"{_AXES}/CZ/{part}", name, positive=False) if f"{_AXES}/CZ/{part}" in fields else otherwise
        for part, otherwise in (("Increment", 1.0), ("Offset", 0.0))
    )
    dx, dy = (_number(fields, f"{_AXES}/{axis}/Increment", name, positive=True) for axis in ("CX", "CY"))
    return scale * heights + offset, dx, dy


def _members(archive: zipfile.ZipFile, name: str) -> dict[str, zipfile.ZipInfo]:
    """Members by name, once all of them are bounded."""
    entries = archive.infolist()
    if len(entries) > _MOST_MEMBERS:
        raise InputError(f"{name!r} has {len(entries)} members, an X3P file has at most {_MOST_MEMBERS}")
    total = sum(member.file_size for member in entries)
    if total > _MOST_UNPACKED:
        raise InputError(
            f"{name!r} unpacks to {total} bytes, more than {_MOST_UNPACKED}; cut a piece of the surface, or do not "
            "trust the file"
        )
    for member in entries:
        if _UNSAFE.search(member.filename):
            raise InputError(f"{name!r} has a member outside its archive, {member.filename!r}; do not trust the file")
        if member.flag_bits & 1 or member.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise InputError(
                f"{member.filename!r} in {name!r} is encrypted or packed as no X3P file is; export again"
            )
        if member.file_size > _SMALL and member.file_size > _MOST_RATIO * member.compress_size:
            raise InputError(
                f"{member.filename!r} in {name!r} unpacks from {member.compress_size} to {member.file_size} bytes, "
                f"more than {_MOST_RATIO} times; nothing measured packs so small, do not trust the file"
            )
    members = {member.filename: member for member in entries}
    if len(members) < len(entries):
        raise InputError(f"{name!r} has two members of one name; export it again")
    return members


def _fields(xml: bytes, name: str) -> dict[str, str]:
    """Texts of the header by their path below the root, as "Record1/Revision". No document type is read at all."""
    path: list[str] = []
    texts: dict[str, list[str]] = {}
    count = 0

    def begin(tag: str, _: object) -> None:
        nonlocal count
        count += 1
        path.append(tag.rpartition(":")[2])
        if count > _MOST_ELEMENTS or len(path) > _DEEPEST:
            raise InputError(
                f"{_HEADER} of {name!r} has more than {_MOST_ELEMENTS} elements, or elements {_DEEPEST} deep; an X3P "
                "file has some fifty, four deep"
            )
        here = "/".join(path[1:])
        if here in texts and here.startswith(("Record1", "Record3")):
            raise InputError(f"{_HEADER} of {name!r} says {here} twice; export it again")
        texts.setdefault(here, [])

    def end(_: str) -> None:
        path.pop()

    def words(text: str) -> None:
        texts["/".join(path[1:])].append(text)

    def refuse(*_: object) -> int:
        raise InputError(
            f"{_HEADER} of {name!r} declares a document type or entities, which no X3P file needs and XML bombs are "
            "made of; do not trust the file"
        )

    parser = expat.ParserCreate()
    parser.StartElementHandler, parser.EndElementHandler, parser.CharacterDataHandler = begin, end, words
    parser.StartDoctypeDeclHandler = parser.EntityDeclHandler = parser.ExternalEntityRefHandler = refuse
    with reading(f"{_HEADER} of {name!r}", "XML"):
        parser.Parse(xml, True)
    return {path: "".join(parts).strip() for path, parts in texts.items()}


def _layout(fields: dict[str, str], name: str) -> tuple[int, int, str]:
    """Rows, columns and the type of a height."""
    for path, wanted in (
        ("Record1/FeatureType", "SUR"), (f"{_AXES}/CX/AxisType", "I"), (f"{_AXES}/CY/AxisType", "I"),
        (f"{_AXES}/CZ/AxisType", "A"), ("Record3/MatrixDimension/SizeZ", "1"),
    ):  # fmt: skip
        if fields.get(path) != wanted:
            raise InputError(
                f"{name!r} says {one_line(repr(fields.get(path)))} for {path}, a surface on even cells has "
                f"{wanted!r}; profiles and clouds are not read, export a surface"
            )
    if f"{_LINK}/PointDataLink" not in fields:
        raise InputError(f"{name!r} keeps its heights in no binary member; export it with binary data")
    kind = fields.get(f"{_AXES}/CZ/DataType", "")
    if kind not in _BYTES:
        raise InputError(f"{name!r} has heights of the type {one_line(repr(kind))}; known are {', '.join(_BYTES)}")
    for axis in ("CX", "CY"):
        _number(fields, f"{_AXES}/{axis}/Increment", name, positive=True)
    for path in (f"{_AXES}/CZ/Increment", f"{_AXES}/CZ/Offset"):
        if path in fields:
            _number(fields, path, name, positive=path.endswith("Increment"))
    columns, rows = (_count(fields, f"Record3/MatrixDimension/Size{axis}", name) for axis in "XY")
    return *checked_shape(rows, columns, name), kind


def checked_shape(rows: int, columns: int, name: str) -> tuple[int, int]:
    """Numbers of points that a map can have. Raises InputError."""
    if rows < 1 or columns < 2 or rows * columns > MOST_POINTS:
        raise InputError(
            f"{name!r} states {rows} x {columns} points; a surface has two columns or more, and {MOST_POINTS} "
            "points at most: thin it or cut a piece of it"
        )
    return rows, columns


def _number(fields: dict[str, str], path: str, name: str, *, positive: bool) -> float:
    try:
        value = float(fields.get(path, ""))
    except ValueError:
        value = math.nan
    if not math.isfinite(value) or (positive and not value > 0):
        kind = "a positive number" if positive else "a finite number"
        raise InputError(f"{name!r} says {one_line(repr(fields.get(path)))} for {path}, which must be {kind}")
    return value


def _count(fields: dict[str, str], path: str, name: str) -> int:
    text = fields.get(path, "")
    if not re.fullmatch(r"[0-9]{1,9}", text):
        raise InputError(f"{name!r} says {one_line(repr(fields.get(path)))} for {path}, which must be a whole number")
    return int(text)


def _member(
    archive: zipfile.ZipFile,
    members: dict[str, zipfile.ZipInfo],
    fields: dict[str, str],
    what: str,
    size: int,
    name: str,
) -> bytes:
    """The member of "Point" data or "Valid" points that the header names, its length and checksums tried."""
    link, checksum = {
        "Point": ("PointDataLink", "MD5ChecksumPointData"),
        "Valid": ("ValidPointsLink", "MD5ChecksumValidPoints"),
    }[what]
    path = fields.get(f"{_LINK}/{link}")
    if path not in members:
        raise InputError(f"{name!r} names {one_line(repr(path))} for data, and has no such member; export it again")
    if members[path].file_size != size:
        raise InputError(
            f"{path!r} in {name!r} has {members[path].file_size} bytes, and its header states {size}; it is "
            "truncated or damaged, export or copy it again"
        )
    with archive.open(members[path]) as stream:
        parts, left = [], size
        while left > 0 and (part := stream.read(min(left, 2**20))):
            parts.append(part)
            left -= len(part)
        if left or stream.read(1):
            raise InputError(f"{path!r} in {name!r} is not as long as its archive states; export or copy it again")
    data, wanted = b"".join(parts), fields.get(f"{_LINK}/{checksum}", "")
    if wanted and hashlib.md5(data, usedforsecurity=False).hexdigest() != wanted.casefold():
        raise InputError(
            f"{path!r} in {name!r} has another MD5 checksum than {checksum} in its header, {one_line(repr(wanted))}; "
            "heights were changed after the file was written: export or copy it again"
        )
    return data
