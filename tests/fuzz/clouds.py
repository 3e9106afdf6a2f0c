"""Clouds of points in every format, whole and with bytes changed: the points that were written, or one sentence.

What is made of points is attacked with the meshes; here the readers are.
"""

from __future__ import annotations

import functools
import random
import warnings
from pathlib import Path

import numpy as np

from fuzz.runner import TAKEN, Refusal, WrongAnswer, ask
from fuzz.smudging import broken
from fuzz.tables import _refused
from treadload.registry import READERS
from treadload.tire.scan import cloud_file, mesh_file

_POINTS = 1200
# A LAS file counts hundredths of a millimetre, texts end there.
_SAME = 1.1e-5
_FORMATS = (".xyz", ".csv", ".ply", ".las", ".laz", ".e57")
assert cloud_file.READERS is READERS


def prepare() -> None:
    """Files are written once, before warnings are errors."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for suffix in _FORMATS:
            _file(suffix)


def attack(rng: random.Random, folder: Path) -> str:
    """Write a cloud in one of the formats, perhaps break it, and read it."""
    suffix = rng.choice(_FORMATS)
    content, wrong = _file(suffix), rng.random() < 0.8
    path = folder / f"cloud{suffix}"
    path.write_bytes(broken(rng, content) if wrong else content)
    answer = ask(lambda: mesh_file._read(READERS.find(suffix[1:]), path))
    if isinstance(answer, Refusal):
        return _refused(answer, wrong, path)
    points, faces = answer
    if points.ndim != 2 or points.dtype != np.float64 or faces.dtype != np.int64:
        raise WrongAnswer(f"points of shape {points.shape} and type {points.dtype}")
    if wrong:
        return "taken though changed"
    if points.shape != (_POINTS, 3) or np.abs(points - _points()).max() > _SAME:
        raise WrongAnswer("other points than were written")
    return TAKEN


@functools.cache
def _points() -> np.ndarray:
    random = np.random.default_rng(3)
    turn, y = random.uniform(0, 2, _POINTS), random.uniform(-0.1, 0.1, _POINTS)
    return np.round(np.stack([0.5 * np.sin(turn), y, 0.5 * np.cos(turn)], axis=1), 5)


@functools.cache
def _file(suffix: str) -> bytes:
    import tempfile

    points = _points()
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / f"cloud{suffix}"
        if suffix in (".xyz", ".csv"):
            np.savetxt(path, points, fmt="%.5f", delimiter=" " if suffix == ".xyz" else ",")
        elif suffix == ".ply":
            import trimesh

            trimesh.PointCloud(points).export(path)
        elif suffix == ".e57":
            import pye57

            with pye57.E57(str(path), mode="w") as file:
                file.write_scan_raw({f"cartesian{axis}": points[:, k].copy() for k, axis in enumerate("XYZ")})
        else:
            import laspy

            header = laspy.LasHeader(point_format=0, version="1.2")
            header.scales, header.offsets = [1e-5] * 3, [0.0] * 3
            made = laspy.LasData(header)
            made.x, made.y, made.z = points.T
            made.write(path)
        return path.read_bytes()
