"""Fit the foundation of the catalogue's belts whose only known number is a deflection under the usual load.

    python benchmarks/catalogue_belts.py

It prints the foundation that the belt has in the catalogue, the fitted one, and the one of a deflection 10 % smaller.
The deflections are estimates, as the caveats of each belt state. The catalogue has three digits of each.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from scipy.optimize import brentq

import treadload as tl
from treadload.tire import Belt

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))


@dataclass(frozen=True)
class UsualState:
    """Load, N, inflation pressure, Pa, deflection, m, and size of the cells, m, of a tire of the catalogue."""

    load: float
    pressure: float
    deflection: float
    spacing: float = 6e-3


STATES = {
    "11R22.5": UsualState(27.5e3, 724e3, 0.034),
    "275/70R22.5": UsualState(30.9e3, 900e3, 0.032),
    "385/65R22.5": UsualState(44.1e3, 900e3, 0.037),
    "445/50R22.5": UsualState(45.4e3, 830e3, 0.037),
    "H44.5x16.5-21": UsualState(182e3, 1410e3, 0.082),
    "37-622": UsualState(450.0, 400e3, 0.005, 1e-3),
}


def deflection(name: str, foundation: float) -> float:
    """Approach, m, of the tire of this name under its usual load, with a foundation, 1/m, on a stiff road."""
    state = STATES[name]
    belt = replace(Belt.from_library(name), foundation=foundation)
    tire = tl.Tire.from_profile(name, inflation_pressure=state.pressure, belt=belt)
    wheel = tl.Rolling(normal_load=state.load, friction=0.0)
    return float(tl.solve_contact(tire, ROAD, wheel, spacing=state.spacing).dataset["approach"])


def foundation_of(name: str, target: float) -> float:
    """Foundation, 1/m, with which the tire of this name deflects by `target`, m."""
    known = Belt.from_library(name).foundation
    return float(brentq(lambda value: deflection(name, value) - target, known / 3, known * 3, rtol=1e-3))


def main() -> None:
    """Print one line for each belt."""
    for name, state in STATES.items():
        fitted, stiffer = (foundation_of(name, share * state.deflection) for share in (1.0, 0.9))
        known = Belt.from_library(name).foundation
        print(f"{name:14s} catalogue {known:6.2f} /m, fitted {fitted:6.2f} /m, deflection -10 %: {stiffer:6.2f} /m")


if __name__ == "__main__":
    main()
