"""Random lives of one class and one season: no largest value on the border of what was solved without a warning.

Each is solved as its case asks, and once more on a field 1.6 times as wide on all sides. Where the wider field holds
a larger value, the life must have named its border; where it holds none, it need not. `python -m fuzz random_lives`,
in the folder tests; the words of the tally count the lives with such a warning.
"""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

from fuzz.runner import REFUSED, Refusal, WrongAnswer, ask
from treadload.case import Case
from treadload.damage.life import Life
from treadload.kernels.arrays import Array
from treadload.life.design import Design
from treadload.life.passage import Passing, passages, turns_of
from treadload.life.seasons import roads_of
from treadload.life.solve import solve_life
from treadload.life.wheels import across, states_of, wheels_of
from treadload.response.basin import LONGEST, basin_reach
from treadload.steps.design import design_of

Table = dict[str, Any]

QUIET, WARNED = "quiet", "warned"
WIDER = 1.6
# The points of a basin stand elsewhere on a wider field: they err by half a per cent of the largest value.
SLACK = 0.01
_GEARS = ("single", "dual", "tandem", "tandem-dual", "tridem")
_MANEUVERS: tuple[Table, ...] = (
    {"kind": "straight"},
    {"kind": "braking", "deceleration": 1.5},
    {"kind": "uphill", "grade": 0.06, "driven_share": 0.4},
    {"kind": "turning", "radius": "60 m", "speed": "30 km/h"},
)


def draw(rng: random.Random) -> Table:
    """The table of a life of one class and one season."""
    layers, names = _layers(rng)
    row: Table = {
        "name": "axle", "share": 1, "axle_load": rng.uniform(4e4, 1.3e5), "gear": rng.choice(_GEARS),
        "inflation_pressure": rng.uniform(6e5, 9.5e5), "maneuver": rng.choice(_MANEUVERS),
        "speed": rng.uniform(5, 25),
    }  # fmt: skip
    traffic: Table = {"passes_per_year": 1e5, "classes": [row]}
    if rng.random() < 0.5:
        traffic["wander"] = {"deviation": rng.uniform(0.05, 0.3)}
    strain = rng.choice(("in-plane", "principal"))
    criteria: list[Table] = [
        {
            "name": "surface", "law": "fatigue-line", "layer": names[0], "place": "top", "strain": strain,
            "epsilon_6": 1e-4, "slope": rng.uniform(-0.3, -0.12),
        },
        {
            "name": "bottom", "law": "fatigue-line", "layer": rng.choice(names[:-1]), "place": "bottom",
            "epsilon_6": 1e-4, "slope": rng.uniform(-0.3, -0.12),
        },
        {"name": "subgrade", "law": "french-subgrade", "layer": names[-1]},
    ]  # fmt: skip
    return {
        "spacing": "20 mm", "tire": {"profile": "315/80R22.5"}, "pavement": {"layers": layers},
        "climate": {"temperature": 15}, "traffic": traffic, "criteria": criteria,
    }  # fmt: skip


def _layers(rng: random.Random) -> tuple[list[Table], list[str]]:
    """From thin asphalt on gravel to concrete on soft soil."""
    top = _layer("surface course", rng, (1e9, 2e10), (0.03, 0.15))
    base = rng.choice(
        (
            [_layer("base", rng, (1.5e8, 8e8), (0.15, 0.5))],
            [_layer("base", rng, (2e9, 1.5e10), (0.08, 0.3))],
            [_layer("base", rng, (1e10, 4e10), (0.15, 0.4)), _layer("subbase", rng, (1e8, 2e9), (0.1, 0.4))],
            [],
        )
    )
    soil = _layer("soil", rng, (2e7, 3e8), None)
    rows = [top, *base, soil]
    return rows, [row["name"] for row in rows]


def _layer(
    name: str, rng: random.Random, modulus: tuple[float, float], thickness: tuple[float, float] | None
) -> Table:
    poisson = round(rng.uniform(0.2, 0.45), 2)
    material = {"kind": "elastic", "modulus": _between(rng, *modulus), "poisson": poisson}
    row: Table = {"name": name, "material": material}
    if thickness is not None:
        row["thickness"] = _between(rng, *thickness)
        if rng.random() < 0.15:
            row["bond"] = rng.choice(("half-bonded", "frictionless"))
    return row


def _between(rng: random.Random, low: float, high: float) -> float:
    """Evenly in the logarithm."""
    return float(f"{low * (high / low) ** rng.random():.4g}")


def attack(rng: random.Random, folder: Path) -> str:
    """Draw a life, solve it, and compare its largest values with those of a wider field."""
    path = folder / "case.toml"
    path.write_text(tomli_w.dumps(draw(rng)), encoding="utf-8")
    design = ask(lambda: design_of(Case.from_toml(path)))
    if isinstance(design, Refusal):
        return REFUSED
    life = solve_life(design, workers=1)
    judge(design, life)
    return WARNED if any(_bordered(life, name) for name in _names(life)) else QUIET


def judge(design: Design, life: Life) -> None:
    """Raise WrongAnswer where a wider field has a larger value and no warning says so."""
    for name, most, wide in zip(_names(life), life.dataset["largest_reading"].to_numpy(), wider(design), strict=True):
        if wide > (1 + SLACK) * most and not _bordered(life, name):
            raise WrongAnswer(f"{name}: {most:.4g} at most, {wide:.4g} on a wider field, and no warning")


def wider(design: Design) -> Array:
    """The largest value of every criterion on a field `WIDER` times as wide."""
    (row,), (season,) = design.traffic.classes, design.climate.seasons
    (warm,) = roads_of(design.road, design.criteria, [season], [row]).distinct
    contacts = [design.contacts.solved[state] for state in states_of(row, design.tire)]
    reach = min(WIDER * basin_reach([warm.road]), WIDER * LONGEST)
    y = across(contacts[:1], [row], reach)
    wheels = wheels_of(contacts, row, y)
    read = passages([Passing(wheels, warm, y, turns_of([wheels]), reach)])[0]
    largest: Array = np.asarray(read[:, 0].max(axis=1), dtype=float)
    return largest


def _names(life: Life) -> list[str]:
    return [criterion.name for criterion in life.criteria]


def _bordered(life: Life, name: str) -> bool:
    """Whether a warning says that a larger value may lie beyond what was solved."""
    return any(
        (text.startswith(f"{name}:") and "end of the field" in text) or "what lies further is not evaluated" in text
        for text in life.warnings
    )
