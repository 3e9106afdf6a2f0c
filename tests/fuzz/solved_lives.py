"""Cases of design that are drawn to be accepted, solved on coarse cells, and judged by what must hold of any life.

Judges: shares of the damage add up to one, the shortest life governs, twice the passes halve a life without growth,
risks come in order, and every summary is a text.
"""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

import treadload as tl
from fuzz.runner import REFUSED, TAKEN, Refusal, WrongAnswer, ask
from fuzz.solved import SOLVED
from treadload.case import Case
from treadload.errors import ConvergenceError

Table = dict[str, Any]

_STRUCTURES = {
    "6 BBSG3 / 15 GB3 / PF3": ("EB-BBSG3", "EB-GB3"),
    "8 BBSG3 / 15 GB3 / PF3": ("EB-BBSG3", "EB-GB3"),
    "6 BBSG3 / 13 EME2 / PF3": ("EB-BBSG3", "EB-EME2"),
}
_GEARS = ("single", "dual", "tandem", "tandem-dual", "tridem")


def draw(rng: random.Random) -> Table:
    """The table of a case of design."""
    structure = rng.choice(list(_STRUCTURES))
    top, base = _STRUCTURES[structure]
    case: Table = {
        "spacing": "20 mm", "tolerance": 0.02, "tire": {"profile": "315/80R22.5"},
        "pavement": {"structure": structure}, "climate": _climate(rng), "traffic": _traffic(rng),
        "criteria": _criteria(rng, top, base),
    }  # fmt: skip
    if rng.random() < 0.12:
        case["ageing"] = {"age": rng.randint(1, 20), "binder": "60/70", "mean_air": 11}
    if rng.random() < 0.12:
        case["rutting"] = rng.choice(({}, {"limit": "15 mm"}))
    if rng.random() < 0.12:
        case["growth"] = {"steps": 3, "layers": 1}
    if rng.random() < 0.12:
        case["reliability"] = {"risks": [0.05, 0.5], "draws": 2000, "traffic": rng.uniform(0, 0.3)}
    return case


def _climate(rng: random.Random) -> Table:
    pick = rng.random()
    if pick < 0.6:
        return {"temperature": rng.uniform(0, 28)}
    if pick < 0.85:
        mean, swing = rng.uniform(8, 16), rng.uniform(0, 8)
        return {"months": [round(mean - swing * float(np.cos(2 * np.pi * k / 12)), 2) for k in range(12)]}
    share = round(rng.uniform(0.2, 0.8), 3)
    return {
        "seasons": [
            {"name": "cold", "share": share, "temperature": rng.uniform(0, 10)},
            {"name": "warm", "share": round(1 - share, 3), "temperature": rng.uniform(15, 29)},
        ]
    }


def _traffic(rng: random.Random) -> Table:
    share = round(rng.uniform(0.1, 0.9), 3)
    shares = [1.0] if rng.random() < 0.6 else [share, round(1 - share, 3)]
    classes = [
        {
            "name": f"class {number}", "share": part, "axle_load": rng.uniform(6e4, 1.3e5),
            "inflation_pressure": rng.choice(("8 bar", rng.uniform(6e5, 9.5e5))), "gear": rng.choice(_GEARS),
        }
        for number, part in enumerate(shares)
    ]  # fmt: skip
    if rng.random() < 0.3:
        classes[0]["maneuver"] = rng.choice(("straight", {"kind": "braking", "deceleration": 2.0}))
    traffic: Table = {"passes_per_year": 10 ** rng.uniform(4, 6), "classes": classes}
    if rng.random() < 0.5:
        traffic["growth"] = rng.uniform(-0.02, 0.05)
    if rng.random() < 0.5:
        traffic["years"] = rng.randint(5, 40)
    if rng.random() < 0.5:
        traffic["wander"] = {"deviation": rng.uniform(0.05, 0.3)}
    if rng.random() < 0.2:
        traffic["standard_axle"] = rng.choice(("irc37", {"load": "100 kN"}))
    if rng.random() < 0.2:
        traffic["frequency"] = "mepdg"
        for one in classes:
            one["speed"] = rng.uniform(5, 25)
    return traffic


def _criteria(rng: random.Random, top: str, base: str) -> list[Table]:
    at_base: Table = {"name": "base", "law": "french-bituminous", "layer": base}
    at_base |= rng.choice(({"risk": rng.uniform(0.01, 0.5)}, {"traffic_class": rng.choice(("T4", "T1", "TEX"))}))
    listed: list[Table] = [
        at_base,
        {"name": "top", "law": "fatigue-line", "layer": top, "place": "top"},
        {"name": "soil", "law": "french-subgrade"},
        {
            "name": "guide", "law": "mepdg-bottom-up", "layer": base, "air_voids": rng.uniform(0.03, 0.09),
            "binder_volume": rng.uniform(0.08, 0.12),
        },
    ]  # fmt: skip
    return rng.sample(listed, rng.randint(1, 3))


def attack(rng: random.Random, folder: Path) -> str:
    """Draw a case of design, solve it and judge the answer."""
    table = draw(rng)
    case = _case(table, folder)
    if isinstance(case, Refusal):
        return REFUSED
    result = ask(lambda: _solved(case))
    if isinstance(result, Refusal):
        return TAKEN
    judge(case, table, result, folder)
    return SOLVED


def _case(table: Table, folder: Path) -> Any:
    path = folder / "case.toml"
    path.write_text(tomli_w.dumps(table), encoding="utf-8")
    return ask(lambda: Case.from_toml(path))


def _solved(case: Case) -> Any:
    try:
        return tl.run(case, leave_out=("sensitivity",), workers=1)
    except ConvergenceError as error:
        raise WrongAnswer(f"did not converge: {str(error)[:200]}") from error


def judge(case: Case, table: Table, result: Any, folder: Path) -> None:
    """What must hold of the life, its standard axles and its reliability."""
    life = result.life
    data = life.dataset
    for part in result.parts.values():
        if not part.summary().strip():
            raise WrongAnswer(f"{type(part).__name__} has an empty summary")
    shares = data["damage_share"].sum(("axle_class", "season")).to_numpy()
    failing = np.isfinite(data["life_passes"].to_numpy())
    # Sums of a few hundred numbers.
    if failing.any() and not np.allclose(shares[failing], 1.0, rtol=1e-9):
        raise WrongAnswer(f"shares of the damage add up to {shares[failing]}")
    years = data["life_years"].to_numpy()
    if not (years >= 0).all():
        raise WrongAnswer(f"a life of {years} years")
    if failing.any() and years.min() != years[list(data["criterion"].to_numpy()).index(life.governing_criterion)]:
        raise WrongAnswer(f"{life.governing_criterion} governs, which is not the shortest of {years}")
    if result.reliability is not None:
        early, late = (result.reliability.years(risk) for risk in (0.05, 0.5))
        if not early <= late:
            raise WrongAnswer(f"{early} years at 5 % of risk and {late} at 50 %")
    if not table["traffic"].get("growth") and failing.any() and len(table["criteria"]) == 1:
        twice = {**table, "traffic": {**table["traffic"], "passes_per_year": 2 * table["traffic"]["passes_per_year"]}}
        halved = _solved(_case({key: value for key, value in twice.items() if key != "growth"}, folder)).life
        if not np.allclose(halved.dataset["life_years"], years / 2, rtol=1e-9):
            raise WrongAnswer(f"twice the passes: {halved.dataset['life_years'].to_numpy()} for {years / 2} years")
