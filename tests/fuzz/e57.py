"""E57 in earnest: scans by pye57 with poses, invalid points and fields beside, their XML and pages changed.

Pages get their checksums again, so that a change reaches its reader. What is accepted must hold the points that were
written, moved by the pose that the file states, by a few lines that share nothing with the package.
"""

from __future__ import annotations

import functools
import random
import re
import warnings
from pathlib import Path

import numpy as np

from fuzz.e57_files import put_together, taken_apart, written
from fuzz.runner import TAKEN, Refusal, WrongAnswer, ask
from fuzz.smudging import broken
from fuzz.tables import _refused
from treadload.tire.scan.e57_file import scan_points

_MOST = 50_000_000
# pye57 writes single precision of coordinates below 2 m, and a pose turns them.
_SAME = 1e-6
_HARMLESS = ("none", "reordered", "renamed", "more", "moved", "turned", "no pose", "spherical", "one scan")
_ODD = ("-1", "0", "1e9", "99999999999", "nan", "inf", "1e400", "", "x", "0x10", "1,5", "٣", "18446744073709551616")


def prepare() -> None:
    """Files are written once, before warnings are errors."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for kind in range(_KINDS):
            _file(kind)


_KINDS = 6


def attack(rng: random.Random, folder: Path) -> str:
    """Change what a file states in a way that keeps it right, or not, and read it."""
    sections, xml, scans, poses = _file(rng.randrange(_KINDS))
    change = rng.choice(_HARMLESS) if rng.random() < 0.75 else "broken"
    text, wanted = xml.decode(), [_moved(points, pose) for points, pose in zip(scans, poses, strict=True)]
    lies: dict[str, int] = {}
    may_fail = change == "broken"
    if change == "reordered":
        # The order of the children of a structure means nothing.
        text = re.sub(r"( *<w .*\n)((?: *<[xyz] .*\n)+)", r"\2\1", text)
    elif change == "renamed":
        text = re.sub(r"CDATA\[Scan \d+", f"CDATA[{rng.choice(('Größe', '', '%s', '&amp;', '扫描'))}", text)
    elif change == "more":
        text = text.replace("<images2D", f"<!-- {'more ' * rng.randrange(1, 2000)} --><images2D")
    elif change in ("moved", "turned"):
        pose = (_turn(rng), np.array([rng.choice((0.0, 1e-3, 5.0, -250.0)) for _ in range(3)]))
        text = _posed(text, *pose)
        wanted = [_moved(points, pose) for points in scans]
    elif change == "no pose":
        text = re.sub(r'<pose type="Structure">.*?</pose>', "", text, flags=re.DOTALL)
        wanted = scans
    elif change == "spherical":
        names = {"X": "Range", "Y": "Azimuth", "Z": "Elevation"}
        text = re.sub(r"cartesian([XYZ])\b", lambda found: f"spherical{names[found[1]]}", text)
        text = text.replace("cartesianInvalidState", "sphericalInvalidState")
        wanted = [_moved(_of_spheres(points), pose) for points, pose in zip(scans, poses, strict=True)]
    elif change == "one scan":
        first = re.search(r"<vectorChild.*?</vectorChild>", text, flags=re.DOTALL)
        assert first is not None
        text = re.sub(r"(<vectorChild.*</vectorChild>)", lambda _: first[0], text, count=1, flags=re.DOTALL)
        wanted = wanted[:1]
    elif change == "broken":
        content = _broken(rng, sections, text, lies)
    if change != "broken":
        content = put_together(sections, text.encode())
    path = folder / "scan.e57"
    path.write_bytes(content)
    answer = ask(lambda: scan_points(path, _MOST))
    if isinstance(answer, Refusal):
        return _refused(answer, may_fail, path)
    if answer.ndim != 2 or answer.shape[1] != 3 or answer.dtype != np.float64:
        raise WrongAnswer(f"points of shape {answer.shape} and type {answer.dtype}")
    if may_fail:
        if len(answer) > 20 * len(content):
            raise WrongAnswer(f"{len(answer)} points from {len(content)} bytes")
        return "taken though changed"
    points = np.concatenate(wanted)
    if answer.shape != points.shape or np.abs(answer - points).max() > _SAME * max(1.0, np.abs(points).max()):
        raise WrongAnswer(f"other points than were written, after {change}")
    return TAKEN


def _broken(rng: random.Random, sections: bytes, text: str, lies: dict[str, int]) -> bytes:
    """A file with something wrong in its XML, its sections, its pages or its header."""
    which = rng.randrange(9)
    xml = text.encode()
    if which == 0:
        numbers = list(re.finditer(r"(?<=[>\"])[-+0-9.e]+(?=[<\"])", text))
        found = rng.choice(numbers)
        xml = (text[: found.start()] + rng.choice(_ODD) + text[found.end() :]).encode()
    elif which == 1:
        count = rng.choice(("0", "-5", "1199", "1201", "5000", "900000", "49000000", "2000000000", "1e3", ""))
        xml = re.sub(r'recordCount="\d+"', f'recordCount="{count}"', text, count=1).encode()
    elif which == 2:
        kinds = (
            "Integer",
            "Float",
            "ScaledInteger",
            "String",
            "Structure",
            "Vector",
            "Blob",
            "CompressedVector",
            "Q",
        )
        found = rng.choice(list(re.finditer(r'type="(\w+)"', text)))
        xml = (text[: found.start(1)] + rng.choice(kinds) + text[found.end(1) :]).encode()
    elif which == 3:
        bomb = '<!DOCTYPE z [<!ENTITY a "lol"><!ENTITY b "' + "&a;" * 50 + '"><!ENTITY c "' + "&b;" * 50 + '">]>'
        deep = "<a type='Structure'>" * rng.choice((10, 3000)) + "</a>" * rng.choice((10, 3000))
        text = (
            text.replace("?>", f"?>{bomb}", 1).replace("<![CDATA[Scan 0]]>", "&c;")
            if rng.random() < 0.5
            else text.replace("<images2D", f"{deep}<images2D")
        )
        xml = text.encode()
    elif which == 4:
        xml = broken(rng, xml)
    elif which == 5:
        head, body = sections[:48], sections[48:]
        sections = head + broken(rng, body)[: len(body)].ljust(len(body), b"\0")
    elif which == 6:
        lies[rng.choice(("length", "place", "size", "page"))] = rng.choice((0, 1, 47, 1023, 2**31, 2**63, -1))
    elif which == 7:
        # A page whose checksum is wrong.
        content = bytearray(put_together(sections, xml))
        content[rng.randrange(len(content) // 1024) * 1024 + rng.choice((1021, 500))] ^= 1 << rng.randrange(8)
        return bytes(content)
    else:
        turn = rng.choice(((0.0, 0.0, 0.0, 0.0), (2.0, 0.0, 0.0, 0.0), (float("nan"),) * 4, (1e200,) * 4))
        xml = _posed(text, np.array(turn), np.zeros(3)).encode()
    content = put_together(sections, xml, **lies)
    return content[: rng.randrange(len(content))] if rng.random() < 0.1 else content


def _posed(text: str, turn: np.ndarray, shift: np.ndarray) -> str:
    """The XML with another pose of all scans."""
    parts = [
        f'<{part} type="Structure">{_numbers(names, values)}</{part}>'
        for part, names, values in (("rotation", "wxyz", turn), ("translation", "xyz", shift))
    ]
    pose = f'<pose type="Structure">{"".join(parts)}</pose>'
    return re.sub(r'<pose type="Structure">.*?</pose>', pose, text, flags=re.DOTALL)


def _numbers(names: str, values: np.ndarray) -> str:
    return "".join(
        f'<{name} type="Float">{float(value)!r}</{name}>' for name, value in zip(names, values, strict=True)
    )


def _turn(rng: random.Random) -> np.ndarray:
    turn = np.array([rng.gauss(0, 1) for _ in range(4)])
    return turn / np.linalg.norm(turn)


def _moved(points: np.ndarray, pose: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    """Points turned by a quaternion q p q* and shifted: p + 2 w (v x p) + 2 v x (v x p) + t."""
    (w, *v), shift = pose
    across = np.cross(v, points)
    return points + 2 * w * across + 2 * np.cross(v, across) + shift


def _of_spheres(points: np.ndarray) -> np.ndarray:
    """Range, azimuth and elevation as x, y, z."""
    away, turn, rise = points.T
    plane = away * np.exp(1j * turn) * np.cos(rise)
    return np.stack([plane.real, plane.imag, away * np.sin(rise)], axis=1)


@functools.cache
def _file(kind: int) -> tuple[bytes, bytes, list[np.ndarray], list[tuple[np.ndarray, np.ndarray]]]:
    """Sections and XML of a file, the valid points of its scans, and their poses."""
    rng, draw = np.random.default_rng(kind), random.Random(kind)
    scans, kept, poses = [], [], []
    for _ in range(1 + kind % 3):
        points = rng.uniform(-1, 1, (1200, 3)).astype(np.float32).astype(np.float64)
        fields = {f"cartesian{axis}": points[:, k].copy() for k, axis in enumerate("XYZ")}
        if kind % 2:
            fields["intensity"] = rng.uniform(0, 1, 1200)
            state = rng.integers(0, 2, 1200)
            fields["cartesianInvalidState"] = state.astype(np.int8)
            points = points[state == 0]
        scans.append(fields)
        kept.append(points)
        poses.append((_turn(draw), rng.uniform(-3, 3, 3)))
    sections, xml = taken_apart(written(scans, list(poses)))
    return sections, xml, kept, poses
