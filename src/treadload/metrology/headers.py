"""SDF, SUR and AL3D: headers are compared with the length of the file before heights are read."""

from __future__ import annotations

import math
import re
import struct
from typing import TYPE_CHECKING

from treadload.errors import InputError, one_line, positive
from treadload.labels import factor
from treadload.metrology.archive import checked_shape

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

# Heights (rows, columns), m, and the spacing along x and y, m.
Map = tuple["NDArray[np.float64]", float, float]

# SDF (ISO 25178-71, table 1): version, maker, two dates, points, profiles, four scales, compression, type, check.
_SDF = struct.Struct("<8s10s12s12sHH4d3B")
_SDF_TYPES = ("u1", "<u2", "<u4", "<f4", "i1", "<i2", "<i4", "<f8")
_SDF_BYTES = (1, 2, 4, 4, 1, 2, 4, 8)
# What marks a point that was not measured, by the type.
_SDF_BAD = {1: 2**16 - 1, 2: 2**32 - 1, 5: -(2**15), 6: -(2**31)}
_SDF_NEEDED = ("NumPoints", "NumProfiles", "Xscale", "Yscale", "Zscale", "DataType")
_MOST_TEXT = 2**26
_NUMBER = re.compile(rb"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?|[nN][aA][nN]")
_HEADER_LINES = 100
# SUR (Digital Surf, 512 bytes): code, format, objects, version, type; then at their places what is needed below.
_SUR_LENGTH, _SUR_SURFACE, _SUR_PC = 512, 2, 0
# Points that were not measured are so much below the smallest; what "inversion" did to a surface.
_SUR_BAD, _INVERTED, _FLIPPED_Z, _FLOPPED_Z = -2, 1, 2, 3
# Single precision of the mark of a missing point, as SurfaceTopography has it.
_SAME_MARK = 1.5e-7
_AL3D = b"AliconaImaging\x00\r\n"
_TAG = 52
_UNITS = ("m", "dm", "cm", "mm", "µm", "um", "\xe6m", "nm", "pm")


def read_sdf(content: bytes, name: str) -> Map:
    """Heights and spacing of an SDF file, binary or text. Raises InputError with what is wrong in it."""
    if content.startswith(b"bISO-1.0"):
        return _binary_sdf(content, name)
    if content.startswith(b"aISO-1.0"):
        return _text_sdf(content, name)
    raise InputError(
        f"{name!r} does not begin with aISO-1.0 or bISO-1.0, as an SDF file does (ISO 25178-71); give it the ending "
        "of its format"
    )


def _binary_sdf(content: bytes, name: str) -> Map:
    import numpy as np

    _check_length(content, 0, _SDF.size, name, "its header")
    _, _, _, _, columns, rows, x, y, z, _, packed, kind, _ = _SDF.unpack_from(content)
    _check_scales(name, Xscale=x, Yscale=y, Zscale=z)
    if packed or kind >= len(_SDF_BYTES):
        raise InputError(
            f"{name!r} has compression {packed} and data type {kind}; read are compression 0 and types 0 to 7: "
            "export it plain"
        )
    rows, columns = checked_shape(rows, columns, name)
    _check_length(content, _SDF.size, rows * columns * _SDF_BYTES[kind], name, "its heights")
    raw = np.frombuffer(content, dtype=_SDF_TYPES[kind], count=rows * columns, offset=_SDF.size)
    heights = z * raw.astype(np.float64)
    if kind in _SDF_BAD:
        heights[raw == _SDF_BAD[kind]] = np.nan
    return heights.reshape(rows, columns), x, y


def _text_sdf(content: bytes, name: str) -> Map:
    import numpy as np

    if len(content) > _MOST_TEXT:
        raise InputError(
            f"{name!r} is text of {len(content)} bytes, more than {_MOST_TEXT}; export it as binary SDF (bISO-1.0)"
        )
    lines = content[: 2**16].split(b"\n")[:_HEADER_LINES]
    end = next((k for k, line in enumerate(lines) if line.strip() == b"*"), None)
    if end is None:
        raise InputError(f"{name!r} has no line of * below its header, where the heights of an SDF file begin")
    fields: dict[str, str] = {}
    for line in lines[1:end]:
        key, mark, value = line.decode("latin-1").partition("=")
        if mark and fields.setdefault(key.strip(), value.strip()) != value.strip():
            raise InputError(f"{name!r} says {one_line(key.strip())} twice; export it again")
    missing = [key for key in _SDF_NEEDED if key not in fields]
    if missing:
        raise InputError(f"{name!r} lacks {missing[0]} in its header; export it again")
    x, y, z = (_float(fields[key]) for key in ("Xscale", "Yscale", "Zscale"))
    _check_scales(name, Xscale=x, Yscale=y, Zscale=z)
    packed, kind = fields.get("Compression", "0"), fields["DataType"]
    if packed != "0" or not re.fullmatch("[0-7]", kind):
        raise InputError(
            f"{name!r} has compression {one_line(packed)} and data type {one_line(kind)}; read are compression 0 and "
            "types 0 to 7: export it plain"
        )
    counts = [fields[key] for key in ("NumProfiles", "NumPoints")]
    if not all(re.fullmatch("[0-9]{1,9}", count) for count in counts):
        raise InputError(f"{name!r} states {one_line(' x '.join(counts))} points; both must be whole numbers")
    rows, columns = checked_shape(int(counts[0]), int(counts[1]), name)
    body = content[sum(len(line) + 1 for line in lines[: end + 1]) :]
    words = body.partition(b"*")[0].split()
    if len(words) != rows * columns:
        raise InputError(
            f"{name!r} states {rows} x {columns} points and has {len(words)} heights; it is truncated or damaged, "
            "export or copy it again"
        )
    wrong = next((word for word in words if word != b"BAD" and not _NUMBER.fullmatch(word)), None)
    if wrong is not None:
        raise InputError(
            f"{name!r} has {one_line(repr(wrong.decode('latin-1')))} among its heights, which are numbers with "
            "decimal points, or BAD; export or copy it again"
        )
    heights = z * np.array([math.nan if word == b"BAD" else float(word) for word in words])
    return heights.reshape(rows, columns), x, y


def read_sur(content: bytes, name: str) -> Map:
    """Heights and spacing of a SUR file. Raises InputError with what is wrong in it."""
    import numpy as np

    if content.startswith(b"DSCOMPRESSED"):
        raise InputError(f"{name!r} is a compressed SUR file, which is not read; export it uncompressed")
    if not content.startswith(b"DIGITAL SURF"):
        raise InputError(
            f"{name!r} does not begin with DIGITAL SURF, as a SUR file does; give it the ending of its format"
        )
    _check_length(content, 0, _SUR_LENGTH, name, "its header")
    order, objects, _, kind = struct.unpack_from("<4H", content, 12)
    if order != _SUR_PC or objects != 1 or kind != _SUR_SURFACE:
        raise InputError(
            f"{name!r} holds {objects} objects of type {kind} in byte order {order}; read is one surface (1, 2, 0): "
            "export the surface alone"
        )
    bits, lowest, _, columns, rows, points = struct.unpack_from("<HiiiiI", content, 98)
    x, y, z = struct.unpack_from("<3f", content, 120)
    _check_scales(name, spacing_x=x, spacing_y=y, spacing_z=z)
    metres = []
    for at in range(180, 276, 16):
        unit = content[at : at + 16].split(b"\0")[0].decode("latin-1").strip()
        if unit not in _UNITS:
            raise InputError(
                f"{name!r} is in {one_line(repr(unit))}, no unit of length that is known ({', '.join(_UNITS[:5])}, "
                "nm, pm); export heights and not angles or pictures"
            )
        metres.append(factor("µm" if unit == "\xe6m" else unit, "m"))
    if bits not in (16, 32):
        raise InputError(f"{name!r} has heights of {bits} bits; 16 and 32 are known")
    rows, columns = checked_shape(rows, columns, name)
    if points != rows * columns:
        raise InputError(f"{name!r} states {points} points in {rows} x {columns}; export or copy it again")
    comment, private = struct.unpack_from("<2H", content, 334)
    start = _SUR_LENGTH + comment + private
    _check_length(content, start, points * bits // 8, name, "its heights")
    raw = np.frombuffer(content, dtype=f"<i{bits // 8}", count=points, offset=start).astype(np.int64)
    heights = metres[2] * z * raw.astype(np.float64)
    if struct.unpack_from("<H", content, 86)[0] == 1:
        heights[raw == lowest + _SUR_BAD] = np.nan
    heights = heights.reshape(rows, columns)
    inversion = struct.unpack_from("<H", content, 290)[0]
    if inversion in (_INVERTED, _FLIPPED_Z, _FLOPPED_Z):
        heights = -heights
    heights = heights[:, ::-1] if inversion == _FLIPPED_Z else heights[::-1] if inversion == _FLOPPED_Z else heights
    return heights, metres[0] * x, metres[1] * y


def read_al3d(content: bytes, name: str) -> Map:
    """Heights and spacing of an AL3D file. Raises InputError with what is wrong in it."""
    import numpy as np

    if not content.startswith(_AL3D):
        raise InputError(
            f"{name!r} does not begin with AliconaImaging, as an AL3D file does; give it the ending of its format"
        )
    tags: dict[str, str] = {}
    at, count = len(_AL3D), 2
    while len(tags) < count:
        _check_length(content, at, _TAG, name, "its tags")
        key, value, end = struct.unpack_from("20s30s2s", content, at)
        key, value = (field.split(b"\0")[0].decode("latin-1").strip() for field in (key, value))
        if end != b"\r\n" or key in tags:
            raise InputError(f"{name!r} has a broken tag at byte {at}; it is damaged, export or copy it again")
        tags[key] = value
        at += _TAG
        if len(tags) == 2:
            if list(tags) != ["Version", "TagCount"] or not re.fullmatch("[0-9]{1,3}", value):
                raise InputError(
                    f"{name!r} begins with the tags {one_line(', '.join(tags))} and {one_line(repr(value))}, an AL3D "
                    f"file with Version and TagCount, below 1000; export or copy it again"
                )
            count = 2 + int(value)
    needed = ("Rows", "Cols", "DepthImageOffset", "PixelSizeXMeter", "PixelSizeYMeter", "InvalidPixelValue")
    missing = [key for key in needed if key not in tags]
    if missing:
        raise InputError(f"{name!r} lacks the tag {missing[0]}; export a depth map again")
    numbers = [tags[key] for key in needed[:3]]
    if not all(re.fullmatch("[0-9]{1,10}", number) for number in numbers):
        raise InputError(f"{name!r} states Rows, Cols, offset {one_line(', '.join(numbers))}; all must be whole")
    dx, dy = (_float(tags[key]) for key in needed[3:5])
    _check_scales(name, **dict(zip(needed[3:5], (dx, dy), strict=True)))
    mark = tags["InvalidPixelValue"]
    if mark.casefold() != "nan" and math.isnan(_float(mark)):
        raise InputError(f"{name!r} says {one_line(repr(mark))} for InvalidPixelValue, which must be a number or NaN")
    rows, columns = checked_shape(int(numbers[0]), int(numbers[1]), name)
    if int(numbers[2]) < at:
        raise InputError(
            f"{name!r} has no depth image, its offset is {numbers[2]}; export heights, not a picture alone"
        )
    # Rows are filled up to multiples of 8 bytes.
    filled = -(-columns // 2) * 2
    _check_length(content, int(numbers[2]), rows * filled * 4, name, "its heights")
    raw = np.frombuffer(content, dtype="<f4", count=rows * filled, offset=int(numbers[2]))
    heights = raw.reshape(rows, filled)[:, :columns].astype(np.float64)
    missing_mark = _float(mark)
    heights[np.abs(heights - missing_mark) <= _SAME_MARK * abs(missing_mark)] = np.nan
    return heights, dx, dy


def _float(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan


def _check_scales(name: str, **scales: float) -> None:
    for key, value in scales.items():
        positive(f"{key} of {name!r}", value, remedy="export it again")


def _check_length(content: bytes, start: int, length: int, name: str, what: str) -> None:
    if start + length > len(content):
        raise InputError(
            f"{name!r} has {len(content)} bytes, and {what} would reach to byte {start + length}; it is truncated or "
            "damaged, export or copy it again"
        )
