"""Steady rolling under any friction law: shear, slip and friction that fit each other.

Where friction reads the slip, both are solved in turn: the bound of the last slip, the slip under that bound, a
part of the way. Friction that falls may leave two steady states, one that sticks more and one that slides more;
the rounds start from the coefficient at rest and so lead to the first, unless a start says otherwise.

Source: Vollebregt & Schuttelaars (2012), J. Sound Vib. 331, 2141-2155 (falling friction and its two branches).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from treadload.contact.bodies.influence import Influence
from treadload.contact.friction.laws import FrictionLaw, Interface, largest_force
from treadload.contact.solvers.rolling import solve_rolling
from treadload.contact.solvers.tangential import Forces, TangentialSolution
from treadload.errors import ConvergenceError
from treadload.kernels.arrays import Array

_MOST_ROUNDS = 200
# Share of the way to the new slip; halved where the rounds move apart.
_RELAXATION = 0.7
_LEAST_RELAXATION = 0.02


@dataclass(frozen=True)
class SlippingSolution:
    """Rolling contact with the friction that its slip makes.

    tangential: shear, slip, creepages, stick. bound: μp (ny, nx), Pa. coefficient: μ (ny, nx), zero outside the
    contact. temperature: flash temperature (ny, nx), K, or None. rounds: of friction and slip.
    change: of the bound in the last round, relative. newton, krylov, splitting: iterations of all rounds.
    """

    tangential: TangentialSolution
    bound: Array
    coefficient: Array
    temperature: Array | None
    rounds: int
    change: float
    newton: int
    krylov: int
    splitting: int


def solve_slipping(
    influence: Influence,
    law: FrictionLaw,
    at: Interface,
    rigid: Array,
    forces: Forces,
    *,
    start: TangentialSolution | None = None,
    tolerance: float = 1e-6,
) -> SlippingSolution:
    """Shear, slip, creepages and friction of steady rolling under a known pressure.

    at: pressure, cells and speed; its slip is where the search begins (zero: at rest). rigid, forces: as for
    `solve_rolling`. start: a solution near this one. tolerance: of rolling, and of the bound's relative change.
    Raises InputError of the law, ConvergenceError with the residual reached.
    """
    bound = law.bound(at)
    solution = solve_rolling(influence, bound, rigid, forces, axes=law.axes, start=start, tolerance=tolerance)
    newton, krylov, splitting = solution.newton, solution.krylov, solution.splitting
    share, before, change = _RELAXATION, np.inf, 0.0
    for rounds in range(1, _MOST_ROUNDS + 1):
        if law.needs_speed:
            wanted = law.bound(replace(at, slip=solution.slip))
            change = float(np.linalg.norm(wanted - bound) / max(np.linalg.norm(bound), np.finfo(float).tiny))
        if change <= tolerance:
            here = replace(at, slip=solution.slip)
            mu = np.divide(bound, at.pressure, out=np.zeros_like(bound), where=at.pressure > 0)
            return SlippingSolution(
                solution, bound, mu, law.temperature(here), rounds, change, newton, krylov, splitting
            )
        if change > before:
            share = max(0.5 * share, _LEAST_RELAXATION)
        before = change
        at = replace(at, slip=at.slip + share * (solution.slip - at.slip))
        bound = law.bound(at)
        _check_fallen(influence, law, bound, forces)
        solution = solve_rolling(influence, bound, rigid, forces, axes=law.axes, start=solution, tolerance=tolerance)
        newton, krylov = newton + solution.newton, krylov + solution.krylov
        splitting += solution.splitting
    raise ConvergenceError(
        f"friction and slip did not settle in {_MOST_ROUNDS} rounds: the bound still changes by {change:.2e}, "
        f"above the tolerance of {tolerance:.2e}; friction that falls steeply makes stick and slip alternate in "
        "time: raise its reference speed or the tolerance, or lower the rolling speed",
        change,
    )


def _check_fallen(influence: Influence, law: FrictionLaw, bound: Array, forces: Forces) -> None:
    """Refuse forces that friction carries at rest, and no longer once slip has lowered it."""
    total = float(bound.sum()) * influence.dx * influence.dy
    demand, limit = largest_force(law.axes, forces, total)
    if demand >= limit > 0:
        raise ConvergenceError(
            f"gross sliding: friction falls with slip to {limit:.6g} N, less than the {demand:.6g} N that it "
            "would carry at rest; lower the force, or prescribe the creepage instead",
            demand / limit - 1,
        )
