"""Points of an E57 file (ASTM E2807), each scan in the frame of the file by its pose."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from treadload.errors import InputError, how_to_install, reading
from treadload.kernels.arrays import Array

if TYPE_CHECKING:
    import pye57

# A packed point takes bits: a file that claims to hold more than this many points a byte is wrong about it.
_MOST_PER_BYTE = 20
_CARTESIAN = ("cartesianX", "cartesianY", "cartesianZ")
_SPHERICAL = ("sphericalRange", "sphericalAzimuth", "sphericalElevation")
# Length of a quaternion that files write with 7 digits or more.
_UNIT = 1e-4


def scan_points(path: Path, most: int) -> Array:
    """Points (n, 3) of all scans of an E57 file, in the unit of the file, invalid ones left out.

    most: points that a file may hold. Raises InputError for a file that is damaged, or whose scans hold fewer points
    than their headers state, and without pye57.
    """
    try:
        import pye57
    except ImportError as error:
        raise InputError(
            f"reading .e57 needs pye57, which is not installed; {how_to_install('clouds')}, or, where the library "
            "has no wheel (Linux on ARM, macOS on Intel), export the points as .las or .ply"
        ) from error
    _check_header(path)
    with reading(f"scan file {path.name!r}", "E57"), pye57.E57(str(path)) as file:
        headers = [file.get_header(k) for k in range(file.scan_count)]
        counts = [int(header.point_count) for header in headers]
        most = min(most, _MOST_PER_BYTE * path.stat().st_size)
        if min(counts, default=0) < 0 or not 0 < sum(counts) <= most:
            raise InputError(
                f"scan file {path.name!r} declares {sum(counts)} points in {path.stat().st_size} bytes, between "
                f"1 and {most} can be; it may be damaged, or hold pictures only: export it again"
            )
        return np.concatenate([_points(file, header, k, path.name) for k, header in enumerate(headers)])


def _points(file: pye57.E57, header: pye57.ScanHeader, number: int, name: str) -> Array:
    """Points (n, 3) of a scan in the frame of the file."""
    count, fields = int(header.point_count), set(header.point_fields)
    system = next((names for names in (_CARTESIAN, _SPHERICAL) if fields.issuperset(names)), None)
    if system is None:
        raise InputError(
            f"scan {number + 1} of {name!r} has neither {', '.join(_CARTESIAN)} nor {', '.join(_SPHERICAL)}; export "
            "its points with coordinates"
        )
    state = "cartesianInvalidState" if system is _CARTESIAN else "sphericalInvalidState"
    data, buffers = file.make_buffers([*system, *{state} & fields], count)
    # What a file does not hold leaves the arrays as they were.
    points_read = int(header.points.reader(buffers).read()) if count else 0
    if points_read != count:
        raise InputError(
            f"scan {number + 1} of {name!r} declares {count} points and has {points_read}; it may be truncated, "
            "export or copy it again"
        )
    points = np.stack([np.asarray(data[field], dtype=np.float64) for field in system], axis=1)
    if state in data:
        points = points[np.asarray(data[state]) == 0]
    if system is _SPHERICAL:
        distance, azimuth, elevation = points.T
        level = distance * np.cos(elevation)
        points = np.stack([level * np.cos(azimuth), level * np.sin(azimuth), distance * np.sin(elevation)], axis=1)
    if not header.node.isDefined("pose"):
        return points
    turn = _named(header.node, "rotation", "wxyz") or (1.0, 0.0, 0.0, 0.0)
    length = float(np.sqrt(np.sum(np.square(turn))))
    if not abs(length - 1) <= _UNIT:
        raise InputError(
            f"scan {number + 1} of {name!r} is turned by a quaternion of the length {length:.6g}, which must be 1; "
            "it is damaged, export it again"
        )
    moved: Array = points @ _rotation(np.array(turn) / length).T + np.array(
        _named(header.node, "translation", "xyz") or (0.0, 0.0, 0.0)
    )
    return moved


def _named(node: pye57.libe57.StructureNode, part: str, names: str) -> tuple[float, ...] | None:
    """Numbers of a part of the pose by their names, as files have them in any order; None where it is not there."""
    if not node.isDefined(f"pose/{part}"):
        return None
    return tuple(float(node[f"pose/{part}/{name}"].value()) for name in names)


def _rotation(quaternion: Array) -> Array:
    """The matrix (3, 3) of a unit quaternion w, x, y, z."""
    w, x, y, z = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def _check_header(path: Path) -> None:
    """The fixed header against the file (ASTM E2807, 48 bytes): length, and where its XML lies."""
    size = path.stat().st_size
    with path.open("rb") as file:
        head = file.read(48)
    if not head.startswith(b"ASTM-E57") or len(head) < 48:
        raise InputError(
            f"scan file {path.name!r} does not begin with an E57 header; give it the ending "
            "of its format, or export it again"
        )
    length, xml, xml_length, page = struct.unpack_from("<QQQQ", head, 16)
    if length != size or page != 1024 or not 48 <= xml <= size or not 0 < xml_length <= size - xml:
        raise InputError(
            f"the header of {path.name!r} states {length} bytes with its index at byte {xml}, the file has {size}; "
            "it is truncated or damaged, export or copy it again"
        )
