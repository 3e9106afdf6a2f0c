"""Textures as files, whole and with bytes changed: the heights that were written, or one sentence."""

from __future__ import annotations

import random
from pathlib import Path

import numpy as np

from crg import KINDS, crg
from fuzz.runner import REFUSED, TAKEN, Refusal, WrongAnswer, ask
from fuzz.tables import _refused, _write
from treadload.pavement.texture import Texture, read_texture

# Single precision, and seven digits of a text.
_SAME = 2e-7
_HEADER = "Road Name\tattack\t\n*****DATA*****\nData Point No:\tDistance (mm)\tDepth (mm)\n"


def attack(rng: random.Random, folder: Path) -> str:
    """Write a texture in some form, perhaps break it, and read it."""
    return rng.choice((_crg, _crg, _crg, _laser, _numpy))(rng, folder)


def _heights(rng: random.Random, rows: int, columns: int) -> np.ndarray:
    return np.array([[round(rng.uniform(-0.01, 0.01), 6) for _ in range(columns)] for _ in range(rows)])


def _crg(rng: random.Random, folder: Path) -> str:
    grid = _heights(rng, 5, 4)
    if rng.random() < 0.3:
        grid[rng.randrange(5), rng.randrange(4)] = np.nan
    content = bytearray(crg(rng.choice(KINDS), grid=grid))
    broken = rng.random() < 0.6
    for _ in range(rng.randrange(1, 8) if broken else 0):
        place = rng.randrange(len(content))
        match rng.randrange(4):
            case 0:
                content[place] = rng.randrange(256)
            case 1:
                del content[place : place + rng.randrange(1, 100)]
                content = content or bytearray(b"$")
            case 2:
                content[place:place] = bytes(rng.randrange(256) for _ in range(rng.randrange(1, 20)))
            case _:
                content = content[: max(1, place)]
    path = folder / "road.crg"
    path.write_bytes(bytes(content))
    return _judged(path, {}, grid[:, ::-1].T, broken)


def _laser(rng: random.Random, folder: Path) -> str:
    heights = 1e3 * _heights(rng, 1, rng.randrange(2, 40))[0]
    told = ["" if k and rng.random() < 0.2 else f"{value:.3f}" for k, value in enumerate(heights)]
    text = _HEADER + "".join(f"{k}.000\t{0.5 * k:.3f}\t{one}\n" for k, one in enumerate(told))
    path = folder / "profile.dat"
    broken = _write(rng, path, text)
    return _judged(path, {}, 1e-3 * np.array([[float(one) if one else np.nan for one in told]]), broken)


def _numpy(rng: random.Random, folder: Path) -> str:
    grid = _heights(rng, rng.randrange(1, 6), rng.randrange(2, 6))
    path = folder / "map.npy"
    np.save(path, grid)
    broken = rng.random() < 0.5
    if broken:
        content = bytearray(path.read_bytes())
        for _ in range(rng.randrange(1, 5)):
            content[rng.randrange(len(content))] = rng.randrange(256)
        path.write_bytes(bytes(content))
    return _judged(path, {"spacing": 1e-3}, grid, broken)


def _judged(path: Path, asked: dict, heights: np.ndarray, broken: bool) -> str:
    answer = ask(lambda: read_texture(path, **asked))
    if isinstance(answer, Refusal):
        return _refused(answer, broken, path)
    assert isinstance(answer, Texture)
    if broken:
        if not np.isfinite(answer.heights).any() or np.isinf(answer.heights).any() or not answer.dx > 0:
            raise WrongAnswer("a texture that is none")
        return "taken though changed"
    if not np.allclose(answer.heights, heights, atol=_SAME, rtol=0, equal_nan=True):
        raise WrongAnswer("other heights than were written")
    return TAKEN if np.isfinite(answer.heights).any() else REFUSED
