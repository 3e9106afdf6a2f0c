"""Files of surface metrology, whole and with bytes changed: the heights that were written, or one sentence."""

from __future__ import annotations

import random
from pathlib import Path

import numpy as np

from fuzz.runner import TAKEN, Refusal, WrongAnswer, ask
from fuzz.smudging import broken
from fuzz.tables import _refused
from surface_files import WRITERS, archived, x3p_members
from treadload.pavement.texture import read_texture
from treadload.tire import Tire

_DX, _DY = 0.25e-3, 0.5e-3
# Heights are written as whole micrometres; single precision of some.
_SAME = 1e-9


def attack(rng: random.Random, folder: Path) -> str:
    """Write a surface in one of the formats, perhaps break it, and read it as a texture or as a tread."""
    rows, columns = rng.randrange(2, 7), rng.randrange(2, 9)
    heights = np.array([[round(rng.uniform(-2e-3, 2e-3), 6) for _ in range(columns)] for _ in range(rows)])
    if rng.random() < 0.3:
        heights[rng.randrange(rows), rng.randrange(columns)] = np.nan
    name = rng.choice(list(WRITERS))
    wrong = rng.random() < 0.7
    if name.endswith(".x3p") and rng.random() < 0.6:
        # Below its checksums an archive would hide its members from every change.
        members = x3p_members(heights, _DX, _DY, {"d": "D", "s": "F", "l": "L"}[name[0]])
        if wrong:
            one = rng.choice(list(members))
            members[one] = broken(rng, members[one])
        content = archived(members)
    else:
        content = WRITERS[name](heights, _DX, _DY)
        content = broken(rng, content) if wrong else content
    path = folder / name
    path.write_bytes(content)
    if rng.random() < 0.5:
        answer = ask(lambda: read_texture(path))
        found = answer if isinstance(answer, Refusal) else answer.heights
        wanted = heights[::-1]
    else:
        answer = ask(lambda: Tire.from_height_map(path, inflation_pressure=8e5))
        found = answer if isinstance(answer, Refusal) else answer.height_map(answer.fixed_grid)
        wanted = np.nanmax(heights) - heights
    if isinstance(found, Refusal):
        return _refused(found, wrong, path)
    if wrong:
        if not np.isfinite(found).any() or np.isinf(found).any():
            raise WrongAnswer("a surface that is none")
        return "taken though changed"
    if found.shape != wanted.shape or not np.allclose(found, wanted, atol=_SAME, rtol=0, equal_nan=True):
        raise WrongAnswer("other heights than were written")
    return TAKEN
