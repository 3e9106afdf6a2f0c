"""Small meshes of a tire, broken as files and as surfaces: a tire, or one sentence."""

from __future__ import annotations

import contextlib
import functools
import random
import struct
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np

import treadload.tire.scan.axis
import treadload.tire.scan.pipeline
import treadload.tire.scan.surface
from fuzz.runner import REFUSED, TAKEN, Refusal, WrongAnswer, ask
from treadload.tire import Tire
from treadload.tire.scan.axis import sample_surface
from treadload.tire.scan.rays import revolved

# A small wheel: the rays that a scan takes go with its width.
_RADIUS, _WIDTH = 0.3, 0.12
_ROUND, _ACROSS = 36, 7
# One in so many is sampled as densely as the package does it. The others take a tenth of the points and wider rays,
# which is the same program twenty times as fast.
DENSE = 200
_UNITS = {"m": 1.0, "mm": 1e-3, "inch": 0.0254}


def attack(rng: random.Random, folder: Path) -> str:
    """Write a tire as some kind of mesh, break the surface or the file, and read it."""
    vertices, faces = _tire()
    unit = rng.choice((None, "m", "mm", "inch"))
    vertices = vertices / _UNITS[unit or "m"]
    changed = rng.random() < 0.6
    if changed:
        for _ in range(rng.choice((1, 1, 2))):
            vertices, faces = _break(rng, vertices, faces)
    suffix = rng.choice(list(_WRITERS))
    path = folder / f"tire{suffix}"
    content = _WRITERS[suffix](vertices, faces)
    torn = rng.random() < 0.4
    path.write_bytes(_torn(rng, content, suffix) if torn else content)
    with contextlib.nullcontext() if rng.randrange(DENSE) == 0 else _sparse():
        answer = ask(lambda: Tire.from_scan(path, units=unit))
    if isinstance(answer, Refusal):
        if not changed and not torn:
            raise WrongAnswer(f"a right mesh was refused: {answer}")
        return REFUSED
    quality = answer.quality
    if not changed and not torn and abs(quality.crown_radius / _RADIUS - 1) > 0.01:
        # Facets of 10 degrees cut 0.4 % under the circle.
        raise WrongAnswer(f"a radius of {quality.crown_radius} m, {_RADIUS} m was written")
    if not (np.isfinite(quality.crown_radius) and 0.1 <= quality.crown_radius <= 2.25):
        raise WrongAnswer(f"a radius of {quality.crown_radius} m was taken")
    return TAKEN


@contextlib.contextmanager
def _sparse() -> Iterator[None]:
    few = functools.partial(sample_surface, count=2000)
    with (
        mock.patch.object(treadload.tire.scan.pipeline, "sample_surface", few),
        mock.patch.object(treadload.tire.scan.axis, "SMOOTHING_NEIGHBOURS", 10),
        mock.patch.object(treadload.tire.scan.surface, "revolved", functools.partial(revolved, step=np.pi / 36)),
        mock.patch.object(treadload.tire.scan.surface, "STANDARD_SPACING", 12e-3),
    ):
        yield


@functools.cache
def _tire() -> tuple[Any, Any]:
    """A smooth tire with side walls: vertices (n, 3), m, and faces (m, 3)."""
    angle = 2 * np.pi * np.arange(_ROUND) / _ROUND
    y = np.linspace(-0.5, 0.5, _ACROSS) * _WIDTH
    profile = [(0.7 * _RADIUS, y[0]), *((_RADIUS - 0.4 * v**2, v) for v in y), (0.7 * _RADIUS, y[-1])]
    vertices = np.array([(r * np.cos(a), v, r * np.sin(a)) for r, v in profile for a in angle])
    faces = []
    for row in range(len(profile) - 1):
        for k in range(_ROUND):
            a, b = row * _ROUND + k, row * _ROUND + (k + 1) % _ROUND
            faces += [(a, b, a + _ROUND), (b, b + _ROUND, a + _ROUND)]
    return vertices, np.array(faces)


def _break(rng: random.Random, vertices: Any, faces: Any) -> tuple[Any, Any]:
    with np.errstate(all="ignore"):
        return _broken(rng, vertices.copy(), faces.copy())


def _broken(rng: random.Random, vertices: Any, faces: Any) -> tuple[Any, Any]:
    if not len(vertices) or not len(faces):
        return vertices, faces
    size = float(np.nanmax(np.abs(vertices[np.isfinite(vertices)]), initial=1.0))
    some = [rng.randrange(len(vertices)) for _ in range(rng.choice((1, 3, 40)))]
    which = rng.randrange(13)
    if which == 0:
        vertices[some] *= rng.choice((0, -1, 1.01, 1.3, 1e6, 1e300))
    elif which == 1:
        vertices[some] = rng.choice((np.nan, np.inf, 0.0))
    elif which == 2:
        keep = np.array([rng.random() > rng.choice((0.05, 0.5, 0.99)) for _ in faces])
        faces = faces[keep]
    elif which == 3:
        faces = np.concatenate([faces, faces[: rng.randrange(len(faces))]])
    elif which == 4:
        faces[rng.randrange(len(faces))] = rng.choice((0, len(vertices), -1, 10**9))
    elif which == 5:
        vertices[:, rng.randrange(3)] *= rng.choice((0, 0.3, 1.1, 5, 1e-6))
    elif which == 6:
        vertices = vertices * rng.choice((1e-12, 1e-3, 25.4, 1e9, 1e200))
    elif which == 7:
        noise = np.random.default_rng(rng.randrange(2**32)).normal(size=vertices.shape)
        vertices += rng.choice((1e-4, 1e-2, 0.3)) * size * noise
    elif which == 8:
        vertices += rng.choice((1.0, 1e3, 1e8)) * size
    elif which == 9:
        faces = faces[:, ::-1] if rng.random() < 0.5 else faces[: rng.randrange(len(faces) + 1)]
    elif which == 10:
        vertices = vertices[:, rng.sample(range(3), 3)]
    elif which == 11:
        vertices[: rng.randrange(len(vertices))] = vertices[0]
    else:
        vertices = np.concatenate([vertices, rng.uniform(0.1, 20) * size * np.eye(3)])
        faces = np.concatenate([faces, [[len(vertices) - 3, len(vertices) - 2, len(vertices) - 1]]])
    return vertices, faces


def _obj(vertices: Any, faces: Any) -> bytes:
    points = [f"v {x:.8g} {y:.8g} {z:.8g}" for x, y, z in vertices]
    return "\n".join([*points, *(f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces)]).encode()


def _off(vertices: Any, faces: Any) -> bytes:
    lines = ["OFF", f"{len(vertices)} {len(faces)} 0", *(f"{x:.8g} {y:.8g} {z:.8g}" for x, y, z in vertices)]
    return "\n".join([*lines, *(f"3 {a} {b} {c}" for a, b, c in faces), ""]).encode()


def _ply(vertices: Any, faces: Any) -> bytes:
    head = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}", *(f"property float {n}" for n in "xyz")]
    head += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    points = [f"{x:.8g} {y:.8g} {z:.8g}" for x, y, z in vertices]
    return "\n".join([*head, *points, *(f"3 {a} {b} {c}" for a, b, c in faces), ""]).encode()


def _stl(vertices: Any, faces: Any) -> bytes:
    faces = faces[((faces >= 0) & (faces < len(vertices))).all(axis=1)]
    with np.errstate(all="ignore"):
        corners = vertices[faces].astype("<f4")
    triangles = b"".join(struct.pack("<3f", 0, 0, 0) + corner.tobytes() + b"\0\0" for corner in corners)
    return bytes(80) + struct.pack("<I", len(faces)) + triangles


_WRITERS: dict[str, Callable[[Any, Any], bytes]] = {".obj": _obj, ".off": _off, ".ply": _ply, ".stl": _stl}


def _torn(rng: random.Random, content: bytes, suffix: str) -> bytes:
    """The file with some of its bytes changed, cut off, or lines gone."""
    at = rng.randrange(len(content) + 1)
    which = rng.randrange(5)
    if which == 0:
        return content[:at]
    if which == 1:
        changed = bytearray(content)
        for _ in range(rng.choice((1, 10))):
            changed[rng.randrange(rng.choice((min(200, len(changed)), len(changed))))] = rng.randrange(256)
        return bytes(changed)
    if which == 2 and suffix != ".stl":
        lines = content.split(b"\n")
        line = rng.randrange(len(lines))
        odd = rng.choice(
            (b"", b"f 1 2", b"v 1 2", b"f a b c", b"v 1e999 0 0", b"\xff", b"f 1/1/1 2/2/2 3/3/3", b"3 1 2")
        )
        return b"\n".join([*lines[:line], odd, *lines[line + rng.randrange(2) :]])
    if which == 3:
        return rng.choice((b"", b"\n", b"solid\n", b"ply\n", b"OFF\n", b"\x00" * 100, b"v 0 0 0\n"))
    return content[:at] + bytes(rng.randrange(256) for _ in range(rng.randrange(1, 8))) + content[at:]
