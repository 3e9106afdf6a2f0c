"""Cases that are drawn to be accepted, solved on small grids, and judged by what must hold of any answer.

Every table of a case is drawn in at least one of twenty cases. Judges: balance of forces, Coulomb's law, slip
against shear, no pressure across a gap, mirror image, scale of all stresses, superposition of halves of the load, and
twice as fine cells for one in ten. Bounds have their reasons beside them.
"""

from __future__ import annotations

import copy
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

import treadload as tl
from fuzz.runner import REFUSED, TAKEN, Refusal, WrongAnswer, ask
from treadload.case import Case
from treadload.errors import ConvergenceError
from treadload.steps import run, slices

Table = dict[str, Any]

SOLVED = "solved"
# Parts of a case beside contact, response and damage, and how often each is drawn; shares of the rest are contacts.
PARTS = {
    "footprint": 0.08, "passes": 0.06, "aggregates": 0.06, "texture": 0.06, "crossing": 0.06, "indentation": 0.06,
    "drum": 0.06,
}  # fmt: skip
# Keys that are stresses or forces: all of them times a factor is another case with the same strains.
_SCALED = {
    "modulus", "inflation_pressure", "normal_load", "tractive_force", "lateral_force", "load", "loads",
    "yield_stress", "hardening", "stiffness", "bond_strength", "pressure",
}  # fmt: skip
_FACTOR = 2.0

# Depths of a vertical slice, in place of 31: slices take nine tenths of the time of a layered case, and each depth
# is one more of the same.
_DEPTHS_OF_A_SLICE = 5


def prepare() -> None:
    """Leave out most depths of the vertical slices."""
    slices._SLICE_DEPTHS = slices._MOVING_DEPTHS = _DEPTHS_OF_A_SLICE


def draw(rng: random.Random, folder: Path) -> Table:
    """The table of a case. folder: for the files that it names."""
    part = rng.choices([*PARTS, ""], [*PARTS.values(), 1 - sum(PARTS.values())])[0]
    if part in ("indentation", "drum"):
        return _pressed(rng, part)
    case: Table = {"title": rng.choice(("", 'a "title" [x]', "essai été")), "pavement": _road(rng, part)}
    if part == "footprint":
        case["footprint"] = _footprint(rng, folder)
    else:
        case |= {"tire": _tire(rng, part), "rolling": _rolling(rng, part)}
        # Few cells, at least eight across a tread: waves of a layered road cost as their square.
        profile = case["tire"]["profile"]
        width = profile["width"] if isinstance(profile, dict) else 0.22
        case["spacing"] = min(width / rng.uniform(8.2, 11), 0.026)
    case["response"] = _response(rng, part)
    if rng.random() < 0.5:
        case["damage"] = _damage(rng, case["response"]["depths"])
    extra: dict[str, Callable[[], Table]] = {
        "passes": lambda: {"count": rng.randint(1, 2), "spacing": "30 mm", "layers": rng.randint(4, 6)},
        "aggregates": lambda: {
            "material": {"modulus": "50 GPa", "poisson": 0.2}, "fraction": rng.uniform(0.1, 0.3),
            "radii": ["4 mm"], "window": {"length": "24 mm", "width": "24 mm", "depth": "16 mm"},
            "spacing": "2 mm", "seed": rng.randint(0, 9), "borders": rng.choice(("steps", "shares")),
        },
        "texture": lambda: {
            "rubber": {"kind": "elastic", "modulus": rng.uniform(2e6, 1e7), "poisson": 0.5}, "size": "25 mm",
            "spacing": "1.5625 mm", "hurst": rng.uniform(0.6, 0.95), "shortest": "6.25 mm", "roll_off": "12.5 mm",
            "rms_height": rng.uniform(5e-5, 3e-4), "seed": rng.randint(0, 9),
        },
        "crossing": lambda: {
            "joint": {"width": "32 mm", "depth": "20 mm"}, "positions": [rng.uniform(-0.05, 0.05)],
        },
    }  # fmt: skip
    if part in extra:
        case[part] = extra[part]()
    return case


def _road(rng: random.Random, part: str) -> Table:
    if part not in ("passes", "aggregates") and rng.random() < 0.15:
        temperature = rng.choice((0, 15, 30, "86 degF"))
        return {
            "structure": rng.choice(("6 BBSG3 / 15 GB3 / PF3", "4 BBM / 15 GNT1 / PF2")),
            "temperature": temperature,
        }
    layers: list[Table] = []
    for number in range(rng.choice((1, 2, 2, 3, 4))):
        modulus = 10 ** rng.uniform(7.5, 10.3)
        layer: Table = {
            "name": f"layer {number}",
            "material": {"modulus": modulus, "poisson": rng.uniform(0.1, 0.49)},
        }
        layer["thickness"] = rng.choice((rng.uniform(0.04, 0.3), f"{rng.randint(4, 30)} cm"))
        bonds: list[Any] = ["bonded", "half-bonded", {"stiffness": 10 ** rng.uniform(9, 11)}]
        layer["bond"] = rng.choices(bonds, (0.8, 0.1, 0.1))[0]
        layers.append(layer)
    layers[-1] = {key: value for key, value in layers[-1].items() if key not in ("thickness", "bond")}
    if part == "aggregates" and len(layers) > 1:
        layers[0]["thickness"] = 0.06
    if part == "passes":
        layers = layers[-1:]
        layers[0]["material"] = {"modulus": 300e6, "poisson": 0.35}
        layers[0]["plasticity"] = {
            "kind": "von-mises",
            "yield_stress": 10 ** rng.uniform(5.5, 6.5),
            "hardening": 30e6,
        }
    return {"layers": layers}


def _tire(rng: random.Random, part: str) -> Table:
    tire: Table = {"profile": "315/80R22.5", "inflation_pressure": rng.choice(("8.2 bar", rng.uniform(5e5, 9e5)))}
    if rng.random() < 0.3:
        radius, width = rng.uniform(0.3, 0.7), rng.uniform(0.12, 0.3)
        tire["profile"] = {"rolling_radius": radius, "crown_radius": rng.uniform(0.5, 3.0), "width": width}
    kind = rng.choices(("", "elastic", "belt", "prony"), (0.4, 0.3, 0.2, 0.1))[0]
    if kind == "belt" and isinstance(tire["profile"], str) and part != "texture":
        tire["belt"] = "315/80R22.5"
    elif kind in ("elastic", "prony"):
        tire["material"] = {"modulus": rng.uniform(2e6, 2e7), "poisson": rng.uniform(0.4, 0.5)}
    return tire


def _rolling(rng: random.Random, part: str) -> Table:
    load, friction = 10 ** rng.uniform(3.5, 4.6), rng.uniform(0.2, 1.0)
    rolling: Table = {"normal_load": load, "friction": friction}
    for force, creepage in (("tractive_force", "creepage_x"), ("lateral_force", "creepage_y")):
        pick = rng.random()
        if pick < 0.3:
            rolling[force] = rng.uniform(-0.5, 0.5) * 0.7 * friction * load
        elif pick < 0.5:
            rolling[creepage] = rng.choice((-1, 1)) * 10 ** rng.uniform(-5, -1)
    if rng.random() < 0.15:
        rolling["spin"] = rng.uniform(-1, 1)
    if rng.random() < 0.15:
        rolling["speed"] = rng.uniform(1, 30)
    return rolling


def _response(rng: random.Random, part: str) -> Table:
    depths: list[Any] = sorted({0.0, *(round(rng.uniform(0.0, 0.4), 3) for _ in range(rng.randint(0, 2)))})
    response: Table = {"depths": depths}
    if rng.random() < 0.2 and part in ("", "footprint"):
        response["wheels"] = [{}, {"y": rng.uniform(0.3, 0.5), "mirror": rng.random() < 0.5}]
    if rng.random() < 0.1:
        response["slice_depth"] = rng.uniform(0.05, 0.3)
    return response


def _damage(rng: random.Random, depths: list[Any]) -> Table:
    damage: Table = {"fatigue": {"epsilon_6": rng.uniform(6e-5, 2e-4), "slope": -rng.uniform(0.15, 0.3)}}
    if rng.random() < 0.3:
        damage["strain"] = "principal"
    if rng.random() < 0.3:
        damage["depth"] = depths[0]
    elif rng.random() < 0.5:
        damage["lattices"] = 1
    return damage


def _footprint(rng: random.Random, folder: Path) -> Table:
    ny, nx = rng.randint(5, 12), rng.randint(5, 14)
    values = np.array([[rng.uniform(0, 900) * (rng.random() < 0.8) for _ in range(nx)] for _ in range(ny)])
    values[[0, -1]] = values[:, [0, -1]] = 0
    values[ny // 2, nx // 2] = 700
    np.savetxt(folder / "print.csv", values, delimiter=",", fmt="%.3f")
    return {"file": "print.csv", "units": {"pressure": "kPa"}, "spacing": rng.choice(("10 mm", 0.02))}


def _pressed(rng: random.Random, part: str) -> Table:
    """A steel ball on ground that yields, about its load of first yield."""
    load = rng.uniform(300.0, 900.0)
    ball: Table = {"rolling_radius": "1 m", "crown_radius": "1 m", "width": "60 mm"}
    ground: Table = {
        "material": {"modulus": 1e8, "poisson": rng.uniform(0.2, 0.45)},
        "plasticity": {
            "kind": "von-mises",
            "yield_stress": rng.uniform(3e5, 6e5),
            "hardening": rng.uniform(1e7, 3e7),
        },
    }
    tire = {"profile": ball, "material": {"modulus": 2.1e11, "poisson": 0.3}}
    table: Table = {"tire": tire, "pavement": {"layers": [ground]}}
    if part == "indentation":
        table[part] = {"loads": [load, 0.0], "spacing": "5 mm", "layers": 5}
    else:
        table[part] = {"load": load, "passes": 1, "spacing_along": "4 mm", "spacing_across": "5 mm", "layers": 4}
    return table


def attack(rng: random.Random, folder: Path) -> str:
    """Draw a case, solve it and judge the answer."""
    table = draw(rng, folder)
    case = _case(table, folder)
    if isinstance(case, Refusal):
        return REFUSED
    result = ask(lambda: _quietly(lambda: run(case)))
    if isinstance(result, Refusal):
        return TAKEN
    for part in result.parts.values():
        if not part.summary().strip():
            raise WrongAnswer(f"{type(part).__name__} has an empty summary")
    if case.rolling is None:
        _finite(result.parts)
        return SOLVED
    contact = result.contact
    judge_contact(contact)
    _finite(result.parts)
    chosen = rng.random()
    bare = {
        key: value for key, value in table.items() if key in ("tire", "pavement", "rolling", "spacing", "response")
    }
    if chosen < 0.3:
        judge_mirror(bare, contact, folder)
    elif chosen < 0.6:
        judge_scale(bare, result, folder)
    elif chosen < 0.9:
        judge_halves(case, contact)
    else:
        judge_refined(bare, contact, folder)
    return SOLVED


def _case(table: Table, folder: Path) -> Any:
    path = folder / "case.toml"
    path.write_text(tomli_w.dumps(table), encoding="utf-8")
    return ask(lambda: Case.from_toml(path))


def _quietly(question: Callable[[], Any]) -> Any:
    """The answer. A solver that says that it did not converge breaks the bound of this attack."""
    try:
        return question()
    except ConvergenceError as error:
        raise WrongAnswer(f"did not converge: {str(error)[:200]}") from error


def _solved(table: Table, folder: Path) -> tl.contact.Contact:
    case = _case(table, folder)
    return tl.solve_contact(
        case.build_tire(),
        case.build_road(),
        case.build_rolling(),
        spacing=case.spacing,
        tolerance=case.source.tolerance_of(case),
    )


def grid_of(contact: tl.contact.Contact) -> tl.response.Grid:
    """The cells of a contact."""
    return tl.response.GridLoad.from_dataset(contact.dataset).grid


def _near(name: str, one: Any, other: Any, bound: float, scale: float) -> None:
    away = float(np.abs(np.asarray(one) - np.asarray(other)).max()) / scale
    if not away <= bound:
        raise WrongAnswer(f"{name}: {away:.2e} apart, {bound:.0e} is allowed")


def _finite(parts: Any) -> None:
    """Principal strains are known wherever stresses are."""
    for name, part in parts.items():
        if name == "response" and not np.isfinite(part.dataset["principal_strain_1"]).all():
            raise WrongAnswer("a principal strain is not a number")


def judge_contact(contact: tl.contact.Contact) -> None:
    """Balance, bounds, complementarity and work; the solver's tolerance is 1e-6, of sums 1e-5."""
    data, cell = contact.dataset, grid_of(contact).cell_area
    pressure, shear = data["pressure"].to_numpy(), np.hypot(data["traction_x"], data["traction_y"]).to_numpy()
    peak = pressure.max()
    if pressure.min() < 0:
        raise WrongAnswer(f"pressure of {pressure.min():g} Pa")
    rolling = contact.rolling
    if rolling.normal_load is not None:
        _near("normal load", pressure.sum() * cell, rolling.normal_load, 1e-5, rolling.normal_load)
    bound = data["friction_coefficient"].to_numpy() * pressure
    _near("Coulomb", np.maximum(shear - bound, 0.0), 0.0, 2e-5, max(float(bound.max()), 1e-12 * peak))
    for name, force in (("traction_x", rolling.tractive_force), ("traction_y", rolling.lateral_force)):
        if getattr(rolling, f"creepage_{name[-1]}") is None and force is not None:
            # Shear on the road pushes it backwards.
            sign = -1.0 if name == "traction_x" else float(np.sign(data[name].sum()) * np.sign(force)) or 1.0
            _near(f"balance of {name}", data[name].sum() * cell, sign * force, 2e-5, float(bound.sum() * cell))
    gap = data["gap"].to_numpy()
    depth = max(float(contact.dataset["approach"]), 1e-9)
    _near("pressure across a gap", np.where(pressure > 0, gap, 0.0), 0.0, 2e-5, depth)
    work = data["traction_x"] * data["slip_x"] + data["traction_y"] * data["slip_y"]
    # Shear on the road against the slip of the tire over it: the same sign everywhere where both are known.
    work = np.nan_to_num(work.to_numpy())
    if work.size and abs(min(work.min(), 0.0)) > 1e-4 * max(abs(work).max(), 1e-300):
        raise WrongAnswer(f"slip gains work: {work.min():g} of {abs(work).max():g}")


def judge_mirror(table: Table, contact: tl.contact.Contact, folder: Path) -> None:
    """The tread and the road are their own images in y = 0: forces and creepages aside with another sign."""
    other = copy.deepcopy(table)
    for key in ("lateral_force", "creepage_y", "spin"):
        if key in other["rolling"]:
            other["rolling"][key] = -other["rolling"][key]
    image = _solved(other, folder).dataset
    data = contact.dataset
    for name, sign in (("pressure", 1), ("traction_x", 1), ("traction_y", -1)):
        scale = float(data["pressure"].max())
        _near(f"mirror of {name}", data[name].to_numpy()[::-1], sign * image[name].to_numpy(), 1e-4, scale)


def judge_scale(table: Table, result: Any, folder: Path) -> None:
    """All stresses and forces twice as large: the same strains."""
    if "structure" in table["pavement"]:
        return
    other = _scaled(copy.deepcopy(table))
    if "material" not in other["tire"] and "belt" not in other["tire"]:
        # The modulus that follows from an inflation pressure is a rule, no constant factor.
        return
    if "belt" in other["tire"]:
        return
    contact = _solved(other, folder).dataset
    data = result.contact.dataset
    for name in ("pressure", "traction_x", "traction_y"):
        scale = float(data["pressure"].max())
        _near(f"scale of {name}", contact[name] / _FACTOR, data[name], 1e-4, scale)


def _scaled(value: Any, key: str = "") -> Any:
    if isinstance(value, dict):
        return {name: _scaled(part, name) for name, part in value.items()}
    if isinstance(value, list):
        return [_scaled(part, key) for part in value]
    if key not in _SCALED:
        return value
    if isinstance(value, str):
        number, unit = value.split()
        return f"{_FACTOR * float(number)!r} {unit}"
    return _FACTOR * value


def judge_halves(case: Case, contact: tl.contact.Contact) -> None:
    """The response of a contact is the sum of those of its left and right halves."""
    road = case.build_road()
    if road.is_viscoelastic or any(layer.depends_on_temperature for layer in road.layers):
        return
    data, grid = contact.dataset, grid_of(contact)
    left = (grid.y < 0)[:, None]
    fields = [data[name].to_numpy() for name in ("pressure", "traction_x", "traction_y")]
    loads = [
        tl.response.GridLoad(grid, *(np.where(part, one, 0.0) for one in fields))
        for part in (left, ~left, left | True)
    ]
    depth = max(max(case.response.depths), 0.02)
    at = {"depths": [depth], "x": grid.x[:: max(1, grid.nx // 6)], "y": grid.y[:: max(1, grid.ny // 6)]}
    one, other, both = (tl.solve_response(load, road, **at).dataset for load in loads)
    for name in ("stress_xx", "stress_zz", "stress_yz", "strain_yy"):
        scale = float(np.abs(both[name]).max()) + 1e-9 * float(np.abs(both["stress_zz"]).max())
        # Layers are synthesised to 1e-6 of the largest value; each half has its own.
        _near(f"halves of {name}", one[name] + other[name], both[name], 1e-3, scale)


def judge_refined(table: Table, contact: tl.contact.Contact, folder: Path) -> None:
    """Twice as fine cells: the approach within 5 %, the radii of gyration of the pressure within 10 %.

    Fewer than 16 cells in contact say the approach within 10 %: 11 are 5.7 % off, 39 0.4 %, 157 0.04 %.
    A contact may be wider by half a cell at each end: its radius, of a uniform row width / √12, by a cell / √12.
    The peak is no judge: below the edge of a rib it grows with the cells, without bound.
    """
    spacing = grid_of(contact).dx / 2
    fine = _solved({**table, "spacing": spacing}, folder).dataset
    coarse = contact.dataset
    approach = float(coarse["approach"])
    few = int((coarse["pressure"] > 0).sum()) < 16
    _near("refined approach", float(fine["approach"]), approach, 0.1 if few else 0.05, approach)
    for along in ("x", "y"):
        one, other = (float(np.sqrt((data["pressure"] * data[along] ** 2).sum() / data["pressure"].sum()))
                      for data in (coarse, fine))  # fmt: skip
        bound = max(0.1, 2 * spacing / np.sqrt(12) / one)
        _near(f"refined radius of gyration along {along}", other, one, bound, one)
