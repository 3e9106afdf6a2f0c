"""SDF in earnest (ISO 25178-71): all types of heights, texts as people and programs write them, and what is wrong.

What is accepted must hold the heights that were written.
"""

from __future__ import annotations

import random
import re
import struct
from pathlib import Path

import numpy as np

from fuzz.smudging import broken
from fuzz.x3p import _DX, _DY, _judged
from surface_files import sdf_text

_TYPES = ("u1", "<u2", "<u4", "<f4", "i1", "<i2", "<i4", "<f8")
# What stands for a point that was not measured; of the others no mark is known.
_BAD = {1: 65535, 2: 2**32 - 1, 3: np.nan, 5: -(2**15), 6: -(2**31), 7: np.nan}
_SCALE = 1e-6
_NUMBERS = ("nan", "inf", "-1", "0", "1e999", "", "x", "1,5", "0x10", "٣", "99999999999", "1 2", "BAD")


def attack(rng: random.Random, folder: Path) -> str:
    """Write a surface as text or as numbers, whole or with something wrong, and read it."""
    rows, columns = rng.randrange(2, 9), rng.randrange(2, 9)
    wrong = rng.random() < 0.25
    content, heights = (_text if rng.random() < 0.5 else _numbers)(rng, rows, columns, wrong)
    path = folder / "surface.sdf"
    path.write_bytes(content)
    return _judged(rng, path, heights, wrong)


def _numbers(rng: random.Random, rows: int, columns: int, wrong: bool) -> tuple[bytes, np.ndarray]:
    """A binary file and the heights in it."""
    kind = rng.randrange(8)
    low, high = (0, 120) if kind in (0, 1, 2) else (-120, 120)
    counts = np.array([[rng.randrange(low, high) for _ in range(columns)] for _ in range(rows)], dtype=float)
    heights = _SCALE * counts
    if kind in _BAD and rng.random() < 0.5:
        place = rng.randrange(rows), rng.randrange(columns)
        counts[place], heights[place] = _BAD[kind], np.nan
    fields = [
        "bISO-1.0",
        "treadload",
        "231120260300",
        "231120260300",
        columns,
        rows,
        _DX,
        _DY,
        _SCALE,
        0.0,
        0,
        kind,
        0,
    ]
    if wrong and rng.random() < 0.6:
        at = rng.randrange(4, 13)
        odd = (
            (0, 1, 2, 255) if at >= 10 else (0, 1, 40_000, 65_535) if at < 6 else (0.0, -1.0, np.nan, np.inf, 1e-320)
        )
        fields[at] = rng.choice(odd)
    packed = [field.encode() if isinstance(field, str) else field for field in fields]
    content = struct.pack("<8s10s12s12sHH4d3B", *packed) + counts.astype(_TYPES[kind]).tobytes()
    # A trailer is allowed.
    content += rng.choice((b"", b"", b"<OperatorName> Tom </OperatorName>"))
    return (broken(rng, content) if wrong else content), heights


def _text(rng: random.Random, rows: int, columns: int, wrong: bool) -> tuple[bytes, np.ndarray]:
    """A text file and the heights in it."""
    heights = np.array([[round(rng.uniform(-2e-3, 2e-3), 9) for _ in range(columns)] for _ in range(rows)])
    if rng.random() < 0.5:
        heights[rng.randrange(rows), rng.randrange(columns)] = np.nan
    text = sdf_text(heights, _DX, _DY).decode()
    head, body = re.split(r"(?<=\n\*)\n", text, maxsplit=1)
    if rng.random() < 0.3:
        lines = head.split("\n")
        middle = lines[1:-1]
        rng.shuffle(middle)
        head = "\n".join([lines[0], *middle, lines[-1]])
    if rng.random() < 0.3:
        head = re.sub(" = ", rng.choice(("=", "\t=\t", "   =  ")), head)
    if rng.random() < 0.3:
        # A profile may go on in the next line.
        body = re.sub(" ", lambda _: rng.choice((" ", "  ", "\t", "\n")), body)
    if rng.random() < 0.3:
        body = re.sub(r"-?\d+\.\d+", lambda word: f"{float(word[0]):.12e}", body)
    if rng.random() < 0.3:
        body += rng.choice(("<PartName> Größe </PartName>\n*", "anything at all\n"))
    if wrong:
        which = rng.randrange(4)
        if which == 0:
            found = rng.choice(list(re.finditer(r"(?<== ).*|(?<==).*", head)))
            head = head[: found.start()] + rng.choice(_NUMBERS) + head[found.end() :]
        elif which == 1:
            found = rng.choice(list(re.finditer(r"\S+", body)))
            body = body[: found.start()] + rng.choice(_NUMBERS) + body[found.end() :]
        elif which == 2:
            head = head.replace("NumPoints", f"NumPoints = {columns + 1}\nNumPoints", 1)
    whole = f"{head}\n{body}"
    content = (whole.replace("\n", "\r\n") if rng.random() < 0.3 else whole).encode()
    return (broken(rng, content) if wrong and rng.random() < 0.5 else content), heights
