"""Lines of a laser, whole and with bytes changed in text or TOML: the points that were written, or one sentence."""

from __future__ import annotations

import functools
import random
from pathlib import Path

import numpy as np

from fuzz.runner import TAKEN, Refusal, WrongAnswer, ask
from fuzz.smudging import broken
from fuzz.tables import _refused
from treadload.tire.scan.laser import piece_of_lines, wheel_of_lines

_LINES, _COLUMNS, _AXLE = 24, 15, 0.3
_SAME = 2e-6


def attack(rng: random.Random, folder: Path) -> str:
    """Write lines in one of the layouts, of a wheel or a piece, perhaps break a file, and read them."""
    wheel, layout = rng.random() < 0.6, rng.choice(("rows", "points"))
    text, table = _files(wheel, layout, rng.choice((",", ";", "\t", " ")))
    wrong = rng.random() < 0.8
    if wrong and rng.random() < 0.7:
        text = broken(rng, text)
    elif wrong:
        table = broken(rng, table)
    (folder / "lines.csv").write_bytes(text)
    path = folder / "lines.toml"
    path.write_bytes(table)
    answer = ask(lambda: wheel_of_lines(path) if wheel else piece_of_lines(path))
    if isinstance(answer, Refusal):
        return _refused(answer, wrong, path)
    if wheel:
        points, faces = answer
        if points.ndim != 2 or not np.isfinite(points).all() or not (faces.min() >= 0 and faces.max() < len(points)):
            raise WrongAnswer(f"points of shape {points.shape}, faces up to {faces.max()}")
        told = np.sort(np.hypot(points[:, 0], points[:, 2]))
        right = np.sort((_AXLE + _lines()[2]).ravel())
    else:
        told, right = np.array(answer.dataset.initial_gap.sizes["y"]), np.array(0)
        if not answer.summary() or np.isinf(answer.dataset.initial_gap).any():
            raise WrongAnswer("a map that is infinite")
    if wrong:
        return "taken though changed"
    if wheel and (told.shape != right.shape or np.abs(told - right).max() > _SAME):
        raise WrongAnswer("other points than were written")
    return TAKEN


@functools.cache
def _lines() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Encoder, a turn's part or a length in thousands; x, m; heights, m."""
    drawn = np.random.default_rng(3)
    return (
        np.arange(_LINES, dtype=float),
        np.linspace(-0.05, 0.05, _COLUMNS),
        np.round(drawn.uniform(0.0, 0.01, (_LINES, _COLUMNS)), 6),
    )


@functools.cache
def _files(wheel: bool, layout: str, mark: str) -> tuple[bytes, bytes]:
    encoder, x, z = _lines()
    if layout == "rows":
        rows = [mark.join(["e", *(f"{1e3 * one:.4f}" for one in x)])]
        rows += [mark.join([f"{a:g}", *(f"{1e3 * b:.4f}" for b in row)]) for a, row in zip(encoder, z, strict=True)]
    else:
        rows = [mark.join(["encoder", "x", "z"])]
        rows += [
            mark.join([f"{a:g}", f"{1e3 * b:.4f}", f"{1e3 * c:.4f}"])
            for a, row in zip(encoder, z, strict=True)
            for b, c in zip(x, row, strict=True)
        ]
    about = f'encoder = "{"deg" if wheel else "mm"}"\n' + (f'axle = "{1e3 * _AXLE:g} mm"\n' if wheel else "")
    table = f'[laser]\nfile = "lines.csv"\nlayout = "{layout}"\nx = "mm"\nz = "mm"\ninvalid = [-9999]\n{about}'
    return ("\n".join(rows) + "\n").encode(), table.encode()
