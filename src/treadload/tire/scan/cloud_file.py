"""Points of a cloud without triangles: text, LAS and LAZ, E57, each held against its own header first."""

from __future__ import annotations

import re
import struct
import warnings
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, BinaryIO

import numpy as np

from treadload.errors import GeometryError, InputError, error_line, how_to_install, reading
from treadload.kernels.arrays import Array
from treadload.registry import READERS
from treadload.tire.scan.e57_file import scan_points
from treadload.tire.scan.mesh_file import Triangles
from treadload.tire.scan.panics import without_backtrace

if TYPE_CHECKING:
    from laspy import LazBackend

MOST_POINTS = 50_000_000
FEWEST_POINTS = 1000
# A LAZ file packs a point into 2 bytes or more; one that declares more than this many a byte lies.
_MOST_PER_BYTE = 20
# A chunk of a LAZ file begins with one point as it is, 20 bytes or more.
_SMALLEST_CHUNK, _MOST_CHUNKS = 20, 2**32
_HEADER_LINES = 30
_SPLIT = re.compile(r"[,;\s]+")


@READERS.register("xyz", "txt", "csv", "asc", "pts")
def _of_text(path: Path) -> Triangles:
    """Points of lines "x y z ..." with blanks, tabs, commas or semicolons between; words may stand above them."""
    with path.open("rb") as file:
        start = file.read(4096)
    if b"\0" in start:
        raise InputError(
            f"scan file {path.name!r} is not text, although its file extension is {path.suffix}; give it "
            "the file extension of its format"
        )
    with path.open(encoding="utf-8", errors="replace") as file:
        lines = [line for line, _ in zip(file, range(_HEADER_LINES), strict=False)]
    skip = next((k for k, line in enumerate(lines) if _is_point(line)), None)
    if skip is None:
        raise InputError(
            f"scan file {path.name!r} has no line of three numbers x y z among its first {len(lines)}; export the "
            "points as text, one on a line, with decimal points"
        )
    separator = ";" if ";" in lines[skip] else "," if "," in lines[skip] else None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            points = np.loadtxt(
                path, delimiter=separator, skiprows=skip, usecols=(0, 1, 2), comments=("#", "//"), ndmin=2,
                encoding="utf-8", max_rows=MOST_POINTS + 1,
            )  # fmt: skip
    except (ValueError, UnicodeDecodeError) as error:
        raise InputError(
            f"scan file {path.name!r} has a line that is no point x y z ({error_line(error)}); it may be truncated, "
            "or have decimal commas: export it with decimal points"
        ) from error
    return _checked(points, path)


def _is_point(line: str) -> bool:
    words = [word for word in _SPLIT.split(line.strip()) if word]
    try:
        return len([float(word) for word in words]) >= 3
    except ValueError:
        return False


@READERS.register("las", "laz")
def _of_las(path: Path) -> Triangles:
    """Points of a LAS or LAZ file, offset and scale of its header applied."""
    try:
        import laspy
    except ImportError as error:
        raise InputError(
            f"reading {path.suffix} needs laspy, which is not installed; {how_to_install('clouds')}"
        ) from error
    _check_las_header(path)
    with (
        reading(f"scan file {path.name!r}", path.suffix[1:].upper()),
        without_backtrace(),
        laspy.open(path, laz_backend=_unpacker(laspy)) as file,
    ):
        count = int(file.header.point_count)
        if not 0 < count <= min(MOST_POINTS, _MOST_PER_BYTE * path.stat().st_size):
            raise InputError(
                f"scan file {path.name!r} declares {count} points in {path.stat().st_size} bytes, between 1 "
                f"and {MOST_POINTS} can be; it may be damaged, export or copy it again"
            )
        parts = [np.stack([part.x, part.y, part.z], axis=1) for part in file.chunk_iterator(1_000_000)]
        points = np.concatenate(parts) if parts else np.zeros((0, 3))
    if len(points) != count:
        raise InputError(
            f"scan file {path.name!r} declares {count} points and has {len(points)}; it may be truncated, "
            "export or copy it again"
        )
    return _checked(np.asarray(points, dtype=np.float64), path)


def _unpacker(laspy: ModuleType) -> LazBackend | None:
    """The one of LAZ that goes through the file; the parallel one reserves what a damaged table asks for."""
    return laspy.LazBackend.Lazrs if laspy.LazBackend.Lazrs.is_available() else None


def _check_las_header(path: Path) -> None:
    """Sizes in the fixed header against the file's own (LAS 1.2 to 1.4, ASPRS, table 4.1)."""
    size = path.stat().st_size
    with path.open("rb") as file:
        head = file.read(375)
    if not head.startswith(b"LASF") or len(head) < 227:
        raise InputError(
            f"scan file {path.name!r} does not begin with a LAS header; give it the ending "
            "of its format, or export it again"
        )
    header, offset, records = struct.unpack_from("<HII", head, 94)
    if not 227 <= header <= offset <= size or records > size // 54:
        raise InputError(
            f"the header of {path.name!r} puts its points at byte {offset} behind {records} records, the file has "
            f"{size}; it is truncated or damaged, export or copy it again"
        )
    # Records are walked here: one whose length lies would be read beyond the file.
    with path.open("rb") as file:
        at = header
        for _ in range(records):
            file.seek(at)
            record = file.read(54)
            if len(record) < 54 or (at := at + 54 + struct.unpack_from("<H", record, 20)[0]) > offset:
                raise InputError(
                    f"a record of the header of {path.name!r} reaches beyond byte {offset}, where its points begin; "
                    "it is damaged, export or copy it again"
                )
        # The upper bits of the point format say that points are packed.
        if head[104] & 0xC0:
            _check_chunks(file, path, offset, size)


def _check_chunks(file: BinaryIO, path: Path, offset: int, size: int) -> None:
    """The table of chunks of a LAZ file: the unpacker reserves room for all of them, or aborts the process."""
    file.seek(offset)
    where = struct.unpack("<q", file.read(8).ljust(8, b"\0"))[0]
    if where == -1:
        # Written by a stream that could not go back: the place stands at the end.
        file.seek(size - 8)
        where = struct.unpack("<q", file.read(8))[0]
    chunks = _MOST_CHUNKS
    if offset + 8 <= where <= size - 8:
        file.seek(where + 4)
        chunks = struct.unpack("<I", file.read(4))[0]
    if chunks > size // _SMALLEST_CHUNK:
        raise InputError(
            f"{path.name!r} has no table of its packed points where it states, or one of {chunks} chunks in {size} "
            "bytes; it is truncated or damaged, export or copy it again"
        )


@READERS.register("e57")
def _of_e57(path: Path) -> Triangles:
    """Points of all scans of an E57 file, each in the frame of the file by its pose."""
    return _checked(scan_points(path, MOST_POINTS), path)


def _checked(points: Array, path: Path) -> Triangles:
    if len(points) > MOST_POINTS:
        raise InputError(
            f"scan file {path.name!r} holds more than {MOST_POINTS} points; thin it in the scanning software"
        )
    if len(points) < FEWEST_POINTS:
        raise GeometryError(
            f"scan file {path.name!r} has {len(points)} points, fewer than the {FEWEST_POINTS} that a tire needs; is "
            "it the right file?"
        )
    return points, np.zeros((0, 3), dtype=np.int64)
