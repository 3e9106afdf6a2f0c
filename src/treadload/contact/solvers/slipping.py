"""Steady rolling under any friction law: shear, slip and friction that fit each other.

Where friction reads the slip, both are solved in turn: the bound of the last slip, the slip under that bound, a
part of the way. Friction that falls may leave two steady states, one that sticks more and one that slides more;
the rounds start from the coefficient at rest and so lead to the first, unless a start is given.

Friction that rises with slip, as rubber's does at first, is a monotone law and has one steady state. There the bound
of a cell moves with its slip: a round takes it where the line from rest to the last slip meets the line on which the
cell deflects by itself, and Anderson's mixing accounts for the other cells.

Source: Vollebregt & Schuttelaars (2012), J. Sound Vib. 331, 2141-2155 (falling friction and its two branches).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from treadload.contact.bodies.influence import Influence
from treadload.contact.friction.laws import FrictionLaw, Interface, largest_force
from treadload.contact.solvers.rolling import solve_rolling
from treadload.contact.solvers.tangential import Forces, TangentialSolution
from treadload.errors import ConvergenceError, InputError
from treadload.kernels.arrays import Array
from treadload.kernels.mixing import Anderson

_MOST_ROUNDS = 200
# Share of the way to the new slip of a cell: halved where a round turns round what the last one did, and larger again
# where it goes on. Friction that falls lets slip spread from cell to cell, slowly near the limit of stick, and faster
# once it has begun: rounds that move more than the last ones are no sign that they diverge.
_RELAXATION = 0.7
_LEAST_RELAXATION = 0.02
_TURNED, _ONWARD = 0.5, 1.3
# Of friction that rises: rounds that are mixed, the reserve of a bound that must carry forces, and slips, over the
# rolling speed, at which a law is asked what it can carry; of its coefficients, what is round-off, and what is not.
_MEMORY, _RESERVE = 8, 1.02
_PROBES = tuple(10.0 ** (0.5 * n) for n in range(-12, 1))
_ROUND_OFF, _BEYOND = 1e-9, 1e-6


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
    rest, bound = law.bound(replace(at, slip=np.zeros_like(at.slip))), law.bound(at)
    rising = _Rising(influence, law, at, rest, forces)
    if rising.share > 1:
        # Not without slip.
        bound = rising.enough(bound)
    solution = solve_rolling(influence, bound, rigid, forces, axes=law.axes, start=start, tolerance=tolerance)
    newton, krylov, splitting = solution.newton, solution.krylov, solution.splitting
    share: Array = np.full(bound.shape, _RELAXATION)
    before, change = np.zeros_like(at.slip), 0.0
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
        if rising.begun or (wanted > rest * (1 + _ROUND_OFF)).any():
            bound = rising.next(bound, wanted, solution)
            solution = solve_rolling(
                influence, bound, rigid, forces, axes=law.axes, start=solution, tolerance=tolerance
            )
            newton, krylov = newton + solution.newton, krylov + solution.krylov
            splitting += solution.splitting
            continue
        step = solution.slip - at.slip
        along = (step * before).sum(0)
        share = np.clip(share * np.where(along < 0, _TURNED, _ONWARD), _LEAST_RELAXATION, _RELAXATION)
        before = step
        at = replace(at, slip=at.slip + share * step)
        bound = law.bound(at)
        _check_fallen(influence, law, bound, forces)
        solution = solve_rolling(influence, bound, rigid, forces, axes=law.axes, start=solution, tolerance=tolerance)
        newton, krylov = newton + solution.newton, krylov + solution.krylov
        splitting += solution.splitting
    how, remedy = "falls", "raise its reference speed or the tolerance, or lower the rolling speed"
    if rising.begun:
        how = "rises"
        if any(forces):
            remedy = (
                f"the forces take {100 * rising.share / _RESERVE:.3g} % of friction at rest: prescribe the creepage"
            )
    raise ConvergenceError(
        f"friction and slip did not settle in {_MOST_ROUNDS} rounds: the bound still changes by {change:.2e}, above "
        f"the tolerance of {tolerance:.2e}; friction that {how} steeply makes stick and slip alternate: {remedy}",
        change,
    )


def strongest(law: FrictionLaw, at: Interface) -> Array:
    """Bound of shear (ny, nx), Pa, at the slip, the same in all cells, at which friction carries most.

    That is at rest, unless friction rises with slip. Raises InputError for coefficients that are negative, not finite
    or beyond the largest one that the law states.
    """
    best = law.bound(replace(at, slip=np.zeros_like(at.slip)))
    for slip in _PROBES if law.needs_speed else ():
        trial = np.zeros_like(at.slip)
        trial[0] = slip
        bound = law.bound(replace(at, slip=trial))
        pressed = at.pressure > 0
        mu = bound[pressed] / at.pressure[pressed]
        worst = mu[np.argmax(np.where(np.isfinite(mu) & (mu >= 0), mu, np.inf))] if mu.size else 0.0
        if not 0 <= worst <= law.largest * (1 + _BEYOND):
            raise InputError(
                f"friction {law} gives a coefficient of {worst:g} at a slip of {slip * at.known_speed:.3g} m/s, and "
                f"its `largest` is {law.largest:g}; a law's coefficient must lie between 0 and its largest"
            )
        if bound.sum() > best.sum() * (1 + _ROUND_OFF):
            best = bound
    return best


class _Rising:
    """Rounds of a friction that rises with slip. rest: its bound (ny, nx) without slip, Pa."""

    def __init__(self, influence: Influence, law: FrictionLaw, at: Interface, rest: Array, forces: Forces) -> None:
        self.influence, self.law, self.at, self.rest = influence, law, at, rest
        self.stretch = np.array(law.axes)[:, None, None]
        self.slope: Array = np.zeros_like(rest)
        self.mixing = Anderson(_MEMORY)
        self.begun = False
        area = influence.dx * influence.dy
        demand, limit = largest_force(law.axes, forces, float(rest.sum()) * area)
        # Of the bound at rest, what carries the forces with some reserve.
        self.share = _RESERVE * demand / limit if limit > 0 else 0.0

    def enough(self, bound: Array) -> Array:
        """The bound, or one nearer to the strongest where this cannot carry the forces."""
        short = self.share * float(self.rest.sum()) - float(bound.sum())
        if short <= 0:
            return bound
        most = strongest(self.law, self.at)
        reserve = float(most.sum() - bound.sum())
        return bound + min(1.0, short / reserve) * (most - bound) if reserve > 0 else bound

    def next(self, bound: Array, wanted: Array, solution: TangentialSolution) -> Array:
        """The bound of the next round. wanted: of the law at the slip that the last one made."""
        self.begun = True
        slip, size = np.hypot(*(solution.slip * self.stretch)), np.hypot(*(solution.shear / self.stretch))
        # Shear that a cell by itself gives up per slip velocity over speed, Pa.
        stiffness = self.at.dx / self.influence.self_influence(rolls=True)
        slips = slip > 0
        rise = np.maximum(wanted - self.rest, 0.0) / np.where(slips, slip, 1.0)
        self.slope = np.where(slips, rise, self.slope)
        part = self.slope / (self.slope + stiffness)
        local = self.rest + part * np.maximum(size + stiffness * slip - self.rest, 0.0)
        # Beyond its peak friction may fall below that at rest.
        local = np.where(wanted < self.rest, wanted, local)
        mixed = self.mixing.next(bound, local)
        low, high = np.minimum(self.rest, wanted), np.maximum(self.law.largest * self.at.pressure, self.rest)
        return self.enough(np.where(self.rest > 0, np.clip(mixed, low, high), local))


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
