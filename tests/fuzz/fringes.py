"""Measurements with fringes: the TOML, its arrays and its pictures, whole and changed: heights, or one sentence."""

from __future__ import annotations

import functools
import io
import random
import tomllib
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

from fuzz.cases import _change
from fuzz.runner import REFUSED, TAKEN, Refusal, WrongAnswer, ask
from fuzz.smudging import broken
from treadload.tire.fringes import read_fringes

_ROWS, _COLUMNS, _STEPS = 24, 30, 4
_TOML = """
title = "attacked"
saturation = 255
noise = 1.0
steepest = "80 deg"
spacing = "1 mm"

[reference_plane]
pixel = "0.5 mm"
distance = "500 mm"
baseline = "200 mm"
period = "4 mm"

[[patterns]]
fringes = 1
tread = "one.npy"
reference = "one_plane.npy"

[[patterns]]
fringes = 8
tread = "eight_*.png"
reference = "eight_plane.npy"
"""


def prepare() -> None:
    """Libraries are loaded before warnings are errors."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        _files()


def attack(rng: random.Random, folder: Path) -> str:
    """Write a small measurement, break its TOML, an array or a picture, and evaluate it."""
    files = dict(_files())
    which = rng.random()
    text = _TOML
    if which < 0.35:
        table = tomllib.loads(text)
        for _ in range(rng.choice((1, 1, 2))):
            _change(rng, table)
        text = tomli_w.dumps(table)
    elif which < 0.45:
        text = broken(rng, text.encode()).decode("latin-1")
    elif which < 0.9:
        name = rng.choice(list(files))
        files[name] = broken(rng, files[name])
    for name, content in files.items():
        (folder / name).write_bytes(content)
    path = folder / "fringes.toml"
    path.write_text(text, encoding="utf-8", errors="surrogatepass")
    answer = ask(lambda: read_fringes(path))
    if isinstance(answer, Refusal):
        if which >= 0.9:
            raise WrongAnswer(f"a right measurement was refused: {answer}")
        return REFUSED
    gap = answer.dataset["initial_gap"].to_numpy()
    if not np.isfinite(gap).any() or np.isinf(gap).any():
        raise WrongAnswer("a tread that is none")
    return TAKEN


@functools.cache
def _files() -> dict[str, bytes]:
    from PIL import Image

    x = (np.arange(_COLUMNS) + 0.5) / _COLUMNS
    bump = 0.2 * np.exp(-(((np.arange(_ROWS)[:, None] - 12) / 5) ** 2) - ((x[None, :] - 0.5) / 0.2) ** 2)
    files: dict[str, Any] = {}
    for name, fringes in (("one", 1), ("eight", 8)):
        for what, phase in (
            ("", fringes * (2 * np.pi * x + 0.1 * bump)),
            ("_plane", fringes * 2 * np.pi * x + 0 * bump),
        ):
            steps = [
                np.round(120 + 80 * np.cos(phase + 2 * np.pi * k / _STEPS)).astype(np.uint8) for k in range(_STEPS)
            ]
            if name == "eight" and not what:
                for k, one in enumerate(steps):
                    stream = io.BytesIO()
                    Image.fromarray(one).save(stream, "png")
                    files[f"eight_{k}.png"] = stream.getvalue()
                continue
            stream = io.BytesIO()
            np.save(stream, np.stack(steps))
            files[f"{name}{what}.npy"] = stream.getvalue()
    return files
