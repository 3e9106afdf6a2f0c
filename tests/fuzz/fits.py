"""Clouds that are a tire, are none, or hardly make a surface, into the fit of the axle: a tire or a sentence.

What is changed here is geometry, not bytes: planes, lines, balls, boxes, few points, copies, several tires, points
far off, every size and place.
"""

from __future__ import annotations

import random
from pathlib import Path

import numpy as np

from fuzz.runner import TAKEN, Refusal, WrongAnswer, ask
from treadload.tire import Tire

_MOST = 6000
_RADIUS, _WIDTH = 0.5, 0.22


def attack(rng: random.Random, folder: Path) -> str:
    """Draw a cloud and read it as a tire."""
    random = np.random.default_rng(rng.randrange(2**32))
    kind = rng.choice(sorted(_KINDS))
    points = _KINDS[kind](random)
    clean = kind == "tire"
    if not clean or rng.random() < 0.5:
        points, clean = _worn(rng, random, points), False
    path = folder / f"{kind}.xyz"
    np.savetxt(path, points, fmt="%.9g")
    units = rng.choice([None, "m", "mm"]) if not clean else "m"
    answer = ask(lambda: Tire.from_scan(path, units=units))
    if isinstance(answer, Refusal):
        if clean:
            raise WrongAnswer(f"a whole tire was refused: {answer}")
        return "refused"
    radius = answer.outer_radius
    if not (radius is not None and np.isfinite(radius) and 0.1 <= radius <= 2.25):
        raise WrongAnswer(f"a {kind} is a tire of radius {radius}")
    if clean and abs(radius - _RADIUS) > 2e-3:
        raise WrongAnswer(f"a tire of radius {_RADIUS} m is read as {radius:.4f} m")
    ask(lambda: answer.height_map(answer.fixed_grid or _grid()))
    return TAKEN if clean else "taken though odd"


def _grid():
    from treadload.grid import Grid

    return Grid.centred(0.1, 0.15, 0.01)


def _worn(rng: random.Random, random: np.random.Generator, points: np.ndarray) -> np.ndarray:
    """The cloud with noise, copies, holes, points far off, another size, pose and place."""
    size = float(np.ptp(points, axis=0).max()) or 1.0
    if rng.random() < 0.5:
        points = points + random.normal(scale=size * 10 ** rng.uniform(-5, -1), size=points.shape)
    if rng.random() < 0.3:
        points = np.concatenate([points, points[: rng.randrange(1, len(points))]])
    if rng.random() < 0.3:
        points = points[points[:, rng.randrange(3)] > np.quantile(points, rng.random())]
    if rng.random() < 0.3 and len(points):
        points[random.integers(len(points), size=rng.randrange(1, 20))] *= 10 ** rng.uniform(-3, 9)
    if rng.random() < 0.3:
        points = np.round(points, rng.randrange(0, 4))
    if rng.random() < 0.5:
        points = points @ np.linalg.qr(random.normal(size=(3, 3)))[0]
    if rng.random() < 0.4:
        points = points * 10 ** rng.uniform(-12, 12)
    if rng.random() < 0.4:
        points = points + random.normal(size=3) * 10 ** rng.uniform(-3, 9)
    return points if len(points) else np.zeros((1, 3))


def _tire(random: np.random.Generator, arc: float = 2 * np.pi) -> np.ndarray:
    turn, y = random.uniform(0, arc, _MOST), random.uniform(-0.5 * _WIDTH, 0.5 * _WIDTH, _MOST)
    # Without grooves, whose walls so few points do not resolve.
    r = _RADIUS - 0.5 * y**2 / 0.5
    return np.stack([r * np.sin(turn), y, r * np.cos(turn)], axis=1)


def _part(random: np.random.Generator) -> np.ndarray:
    return _tire(random, random.uniform(0.0, 2 * np.pi))


def _two(random: np.random.Generator) -> np.ndarray:
    return np.concatenate([_tire(random), _tire(random) + random.normal(size=3)])


def _on_floor(random: np.random.Generator) -> np.ndarray:
    floor = random.uniform(-1, 1, (_MOST, 3))
    floor[:, 2] = -_RADIUS
    return np.concatenate([_tire(random), floor])


def _ball(random: np.random.Generator) -> np.ndarray:
    at = random.normal(size=(_MOST, 3))
    return at / np.linalg.norm(at, axis=1, keepdims=True) * random.uniform(0.1, 1.0)


def _tube(random: np.random.Generator) -> np.ndarray:
    turn, y = random.uniform(0, 2 * np.pi, _MOST), random.uniform(-1, 1, _MOST) * random.uniform(0.001, 3)
    return np.stack([0.5 * np.sin(turn), y, 0.5 * np.cos(turn)], axis=1)


_KINDS = {
    "tire": _tire,
    "part": _part,
    "two": _two,
    "floor": _on_floor,
    "ball": _ball,
    "tube": _tube,
    "plane": lambda random: random.uniform(-1, 1, (_MOST, 3)) * [1, 1, 0],
    "line": lambda random: random.uniform(-1, 1, (_MOST, 1)) * random.normal(size=3),
    "box": lambda random: random.uniform(-1, 1, (_MOST, 3)),
    "point": lambda random: np.tile(random.normal(size=3), (_MOST, 1)),
    "few": lambda random: random.normal(size=(random.integers(1, 1100), 3)),
    "circle": lambda random: _tire(random) * [1, 0, 1],
    "lattice": lambda random: np.round(random.uniform(-5, 5, (_MOST, 3))),
}
