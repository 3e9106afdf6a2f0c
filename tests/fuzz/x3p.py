"""X3P in earnest: archives and headers as other writers make them, and bombs, lies and swaps in them.

An archive is made anew after each change, so that a change lies below its checksums. What is accepted must hold the
heights that were written.
"""

from __future__ import annotations

import hashlib
import io
import random
import re
import zipfile
from pathlib import Path

import numpy as np

from fuzz.runner import TAKEN, Refusal, WrongAnswer, ask
from fuzz.smudging import broken
from fuzz.tables import _refused
from surface_files import x3p_members
from treadload.metrology import read_surface_map
from treadload.pavement.texture import read_texture
from treadload.tire import Tire

_DX, _DY = 0.25e-3, 0.5e-3
_LINK = "</DataLink>"
_SIZES = ("0", "-3", "1", "1e3", "99999999999", "100000000", "nan", "", "3.5", "٣", "0x3")
_STEPS = ("0", "-0.00025", "nan", "inf", "1e999", "", "x", "1,5", "0x1p-3", "1_0")
# Heights of the kind "F" are single precision of 2 mm at most.
_SAME = 1e-9


def attack(rng: random.Random, folder: Path) -> str:
    """Write a surface, as another program would or with something wrong, and read it as map, texture or tread."""
    rows, columns = rng.randrange(2, 9), rng.randrange(2, 9)
    heights = np.array([[round(rng.uniform(-2e-3, 2e-3), 6) for _ in range(columns)] for _ in range(rows)])
    kind = rng.choice("DFLI")
    if rng.random() < 0.4:
        heights[rng.randrange(rows), rng.randrange(columns)] = np.nan
    members = x3p_members(heights, _DX, _DY, kind)
    wanted = heights.copy()
    for _ in range(rng.randrange(4)):
        members, wanted = _varied(rng, members, wanted, kind)
    wrong = rng.random() < 0.25
    content = _spoiled(rng, members) if wrong else _archived(rng, members)
    path = folder / "surface.x3p"
    path.write_bytes(content)
    return _judged(rng, path, wanted, wrong)


def _judged(rng: random.Random, path: Path, wanted: np.ndarray, wrong: bool) -> str:
    """A word for what came of a file. wanted: heights that were written, in the order of the file."""
    which = rng.randrange(3)
    if which == 0:
        answer = ask(lambda: read_surface_map(path))
        found = answer if isinstance(answer, Refusal) else answer.heights
    elif which == 1:
        answer = ask(lambda: read_texture(path))
        found = answer if isinstance(answer, Refusal) else answer.heights[::-1]
    else:
        answer = ask(lambda: Tire.from_height_map(path, inflation_pressure=8e5))
        found = answer if isinstance(answer, Refusal) else answer.height_map(answer.fixed_grid)
        wanted = np.nanmax(wanted) - wanted
    if isinstance(found, Refusal):
        return _refused(found, wrong, path)
    if np.isinf(found).any() or not np.isfinite(found).any():
        raise WrongAnswer("a surface that is none")
    if wrong:
        return "taken though changed"
    spacing = (answer.fixed_grid.dx, answer.fixed_grid.dy) if which == 2 else (answer.dx, answer.dy)
    if not np.allclose(spacing, (_DX, _DY), rtol=1e-6):
        raise WrongAnswer(f"points {spacing} apart, {(_DX, _DY)} m were written")
    if found.shape != wanted.shape or not np.allclose(found, wanted, atol=_SAME, rtol=0, equal_nan=True):
        raise WrongAnswer("other heights than were written")
    return TAKEN


def _varied(
    rng: random.Random, members: dict[str, bytes], heights: np.ndarray, kind: str
) -> tuple[dict[str, bytes], np.ndarray]:
    """The same file as another program writes it, and the heights that it then holds."""
    members, which = dict(members), rng.randrange(10)
    head = members["main.xml"].decode("utf-8-sig")
    if which == 0:
        head = head.replace("p:ISO", "iso:ISO").replace("xmlns:p", "xmlns:iso")
    elif which == 1:
        head = re.sub(r">\n?<", ">\r\n   <", head)
    elif which == 2 and "MD5ChecksumPointData" not in head:
        digest = hashlib.md5(members["bindata/data.bin"]).hexdigest()
        digest = digest.upper() if rng.random() < 0.5 else digest
        head = head.replace(_LINK, f"<MD5ChecksumPointData>{digest}</MD5ChecksumPointData>{_LINK}")
    elif which == 3 and "ValidPointsLink" not in head:
        # Points of any type may be marked as not measured.
        known = np.isfinite(heights) & (np.array([rng.random() < 0.8 for _ in heights.flat]).reshape(heights.shape))
        if known.any():
            members["bindata/valid.bin"] = np.packbits(known.ravel(), bitorder="little").tobytes()
            head = head.replace(_LINK, f"<ValidPointsLink>bindata/valid.bin</ValidPointsLink>{_LINK}")
            heights = np.where(known, heights, np.nan)
    elif which == 4 and "<Offset>0.0</Offset>" in head:
        shift = rng.choice((1e-3, -2.5e-2, 0.5))
        head = head.replace("<Offset>0.0</Offset>", f"<Offset>{shift!r}</Offset>")
        heights = heights + shift
    elif which == 5 and kind in "DF":
        head = head.replace("<Increment>1.0</Increment>", "").replace("<Offset>0.0</Offset>", "")
    elif which == 6:
        members |= {"md5checksum.hex": b"00 *bindata/data.bin\n", "vendor/größe.txt": bytes(rng.randrange(2000))}
    elif which == 7:
        head = head.replace(
            "<Record2>", f"<Record2><Comment>{rng.choice(('Größe &amp; Maß', '扫描', 'x' * 5000))}</Comment>"
        )
    elif which == 8 and not members["main.xml"].startswith(b"\xef"):
        members["main.xml"] = b"\xef\xbb\xbf" + head.encode()
        return members, heights
    else:
        head = head.replace("<p:", "<!-- made by hand --><p:", 1) if rng.random() < 0.5 else head
    members["main.xml"] = head.encode("utf-8-sig" if members["main.xml"].startswith(b"\xef") else "utf-8")
    return members, heights


def _archived(rng: random.Random, members: dict[str, bytes], *, packing: int | None = None) -> bytes:
    stream = io.BytesIO()
    names = list(members)
    rng.shuffle(names)
    with zipfile.ZipFile(stream, "w", packing or rng.choice((zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED))) as archive:
        for name in names:
            archive.writestr(name, members[name])
        archive.comment = b"x" * rng.choice((0, 0, 300))
    return stream.getvalue()


def _spoiled(rng: random.Random, members: dict[str, bytes]) -> bytes:
    """An archive with something wrong in it."""
    members, which = dict(members), rng.randrange(13)
    head = members["main.xml"].decode("utf-8-sig")
    if which == 0:
        axis = rng.choice("XY")
        head = re.sub(rf"<Size{axis}>\d+", f"<Size{axis}>{rng.choice(_SIZES)}", head)
    elif which == 1:
        found = rng.choice(list(re.finditer(r"(?<=Increment>)[^<]+|(?<=Offset>)[^<]+", head)))
        head = head[: found.start()] + rng.choice(_STEPS) + head[found.end() :]
    elif which == 2:
        entities = "".join(f'<!ENTITY a{k} "{f"&a{k - 1};" * 10}">' for k in range(1, 12))
        head = head.replace("<p:", f'<!DOCTYPE p [<!ENTITY a0 "lol">{entities}]><p:', 1).replace("2026", "&a11;")
    elif which == 3:
        members["bindata/data.bin"] = bytes(rng.choice((10**6, 3 * 10**7)))
    elif which == 4:
        head = re.sub(r"<DataType>[DFLI]", f"<DataType>{rng.choice('DFLIQ')}", head)
    elif which == 5:
        head = head.replace(_LINK, f"<MD5ChecksumPointData>{'0' * 32}</MD5ChecksumPointData>{_LINK}")
    elif which == 6:
        # Of the same length, so that nothing but the meaning changes.
        members["main.xml"], members["bindata/data.bin"] = members["bindata/data.bin"], members["main.xml"]
        return _archived(rng, members)
    elif which == 7:
        path = rng.choice(("../data.bin", "/etc/passwd", "C:\\data.bin", "bindata/none.bin", "main.xml", ""))
        head = head.replace("<PointDataLink>bindata/data.bin", f"<PointDataLink>{path}")
        members[path or "a"] = members["bindata/data.bin"] if path != "main.xml" else members["main.xml"]
    elif which == 8:
        members["main.xml"] = members["main.xml"].replace(b"2026", b"\xff\xfe\xc0\x80", 1)
        return _archived(rng, members)
    elif which == 9:
        name = rng.choice(list(members))
        members[name] = broken(rng, members[name])
        return _archived(rng, members)
    elif which == 10:
        return broken(rng, _archived(rng, members))
    elif which == 11:
        content = _archived(rng, members)
        return content[: rng.randrange(len(content))]
    else:
        encoded = head.replace('encoding="UTF-8"', 'encoding="UTF-16"').encode("utf-16")
        members["main.xml"] = rng.choice(
            (encoded, head.encode("utf-16"), head.encode("utf-7"), b"", head.encode() * 2)
        )
        return _archived(rng, members)
    members["main.xml"] = head.encode()
    return _archived(rng, members)
