"""E57 files taken apart and put together again: pages with checksums, the XML that says what lies where."""

from __future__ import annotations

import struct
import tempfile
from pathlib import Path

import numpy as np

_PAGE, _CONTENT = 1024, 1020


def _table() -> np.ndarray:
    """CRC-32C (Castagnoli), reflected polynomial 0x82F63B78."""
    table = np.arange(256, dtype=np.uint32)
    for _ in range(8):
        table = np.where(table & 1, (table >> 1) ^ np.uint32(0x82F63B78), table >> 1).astype(np.uint32)
    return table


_CRC = _table()


def checksums(pages: np.ndarray) -> np.ndarray:
    """CRC-32C of rows (n, 1020) of bytes, all rows at once."""
    sums = np.full(len(pages), 0xFFFFFFFF, dtype=np.uint32)
    for column in pages.T:
        sums = (sums >> np.uint32(8)) ^ _CRC[(sums ^ column) & np.uint32(0xFF)]
    return sums ^ np.uint32(0xFFFFFFFF)


def taken_apart(content: bytes) -> tuple[bytes, bytes]:
    """The binary sections with the header, and the XML, both without checksums of pages."""
    logical = b"".join(content[at : at + _CONTENT] for at in range(0, len(content), _PAGE))
    xml, length = struct.unpack_from("<QQ", logical, 24)
    start = xml // _PAGE * _CONTENT + xml % _PAGE
    return logical[:start], logical[start : start + length]


def put_together(sections: bytes, xml: bytes, **header: int) -> bytes:
    """A file with this XML behind the binary sections. header: numbers to lie about, length, place, size or page."""
    logical = bytearray(sections + xml)
    logical += bytes(-len(logical) % _CONTENT)
    count = len(logical) // _CONTENT
    at = len(sections) // _CONTENT * _PAGE + len(sections) % _CONTENT
    told = {"length": count * _PAGE, "place": at, "size": len(xml), "page": _PAGE} | header
    struct.pack_into("<4Q", logical, 16, *(told[key] & (2**64 - 1) for key in ("length", "place", "size", "page")))
    pages = np.frombuffer(bytes(logical), dtype=np.uint8).reshape(count, _CONTENT)
    sums = checksums(pages).astype(">u4").view(np.uint8).reshape(count, 4)
    return np.concatenate([pages, sums], axis=1).tobytes()


def written(scans: list[dict[str, np.ndarray]], poses: list[tuple[np.ndarray, np.ndarray] | None]) -> bytes:
    """A file by pye57 with fields of scans, each with its (quaternion, translation)."""
    import pye57

    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "a.e57"
        with pye57.E57(str(path), mode="w") as file:
            for fields, pose in zip(scans, poses, strict=True):
                turn, shift = pose if pose is not None else (np.array([1.0, 0, 0, 0]), np.zeros(3))
                file.write_scan_raw(fields, rotation=turn, translation=shift)
        return path.read_bytes()
