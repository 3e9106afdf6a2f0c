"""What repeated passes come to: elastic, shakedown, cyclic or ratchetting."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np

from treadload.kernels.arrays import Array
from treadload.response.passes.box import over_strength
from treadload.response.passes.melan import melan_factor, unbounded
from treadload.response.passes.steady import NoSteadyPassError, Track, roll

Kind = Literal["elastic", "shakedown", "cyclic", "ratchetting"]

# Of the strain at yield, that a pass adds: below the first it is elastic, below the second it has shaken down.
_ELASTIC, _SHAKEN = 1e-6, 0.01
# Of the plastic strain that a pass adds, what it leaves: below this it runs in a cycle.
_CLOSED = 0.10
CRITERION = (
    f"elastic: no pass adds plastic strain; shakedown: the last adds less than {_SHAKEN:g} of the strain at yield; "
    f"cyclic: what it leaves is less than {_CLOSED:g} of what it adds, so that strain runs in a loop; ratchetting: "
    "strain grows pass by pass, or no steady pass exists"
)
# Passes that a load of a search may take, and bisections of the load.
_TRIED, _STEPS, _ROUNDS = 8, 5, 60
# A load shakes down whose passes add so little, of the strain at yield, or fall so fast.
_SOON, _FALLS = 0.03, 0.6


def judged(added: Sequence[float], left: Sequence[float], yield_strain: float) -> Kind:
    """The assessment on passes, see `CRITERION`.

    added: largest equivalent plastic strain that each pass adds. left: largest change of it that each leaves.
    """
    if max(added) <= _ELASTIC * yield_strain:
        return "elastic"
    if at_rest(added[-1], yield_strain):
        return "shakedown"
    return "cyclic" if left[-1] <= _CLOSED * added[-1] else "ratchetting"


def at_rest(added: float, yield_strain: float) -> bool:
    """Whether a pass adds as little as shakedown means."""
    return added <= _SHAKEN * yield_strain


def still_falls(added: Sequence[float]) -> float | None:
    """By what the last pass adds less than the one before, as a part of it; None where it does not."""
    if len(added) < 2 or not added[-1] < 0.95 * added[-2]:
        return None
    return 1 - added[-1] / added[-2]


def in_words(verdict: str, falls: float | None) -> str:
    """An assessment in the words of a headline: passes that still fall are undecided. falls: see `still_falls`."""
    if falls is None:
        return verdict
    return f"{verdict} so far, not yet at rest: the last pass adds {100 * falls:.0f} % less than the one before"


def elastic_factor(road: Track, stress: Array) -> float:
    """Part of a load, of stress (6, nz, ny, nx), Pa, at which the first point yields; infinite where none does."""
    # Yield functions of virgin materials are a part that grows with the load, less the strength.
    most = 1 + max(float(over_strength(part.material, stress[:, part.rows]).max()) for part in road.parts)
    return 1 / most if most > 0 else np.inf


def shakedown_factor(road: Track, stress: Array, *, most: float = 1.0, duration: float = 0.0) -> float:
    """Largest part of a load that comes to rest, up to `most`.

    stress: (6, nz, ny, nx), Pa, on the elastic road. By Melan's theorem where all laws are Prager's; else found by
    passes, a few for a load, halving between yield and `most`, within 3 % of the part between both.
    """
    if all(unbounded(part.material.law) for part in road.parts):
        return min(melan_factor(road, stress), most)
    low, high = min(elastic_factor(road, stress), most), most
    for _ in range(_STEPS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _shakes(road, middle * stress, duration) else (low, middle)
    return low


def _shakes(road: Track, stress: Array, duration: float) -> bool:
    states, added = road.virgin(), [np.inf]
    for _ in range(_TRIED):
        before = road.whole(states)[1]
        try:
            states = roll(road, stress, states, duration=duration, tolerance=3e-3, most=_ROUNDS).states
        except NoSteadyPassError:
            return False
        added.append(float((road.whole(states)[1] - before).max()))
        if added[-1] <= _SOON * road.yield_strain:
            return True
    return added[-1] <= _FALLS * added[-2]
