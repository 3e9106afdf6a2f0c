"""The way from load to load over ground that yields: sub-steps, and the error that they leave.

The plastic strain d that a sub-step adds is the only unknown: it moves the surface, whose contact gives the pressure.
The stress of that, with that of d itself, goes into the return map,

    contact(gap + u_z(d)) -> p,   trial = S p + K d + C d,   d = Return(trial; state before the sub-step),

a fixed point that contracts, since -K is a projection in the elastic energy; Anderson's mixing finds it. The contact
is solved inside, to a tolerance far below that of the plastic strain.

A return map is a backward Euler step: where the material flows freely its stress is that of the middle of the step,
so one jump to 19 times the load of first yield leaves the peak pressure 10 % too high, and the error only halves with
the steps. The second backward difference formula (BDF2) is a backward Euler step from a state ahead of the last,

    y + ω² / (1 + 2 ω) (y - y_before),   ω = size of this step over that before,

of second order for one return map a step; its first step, and the first after the load turns, is Euler's. All loads
are followed in sub-steps and again in half as long ones until peak pressure and plastic strain agree at every load.

Sources: Jacq, Nélias, Lormand & Girodin (2002), J. Tribol. 124, 653-667, for the semi-analytical method; Frérot,
Bonnet, Molinari & Anciaux (2019), Comput. Methods Appl. Mech. Eng. 351, 951-976, for driving it by strain; Hairer &
Wanner (1996), Solving Ordinary Differential Equations II, section V.1, for BDF2.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np

from treadload.contact.bodies.influence import Influence
from treadload.contact.solvers.normal import NormalSolution, solve_normal
from treadload.contact.yielding import Yielding
from treadload.errors import ConvergenceError
from treadload.kernels.arrays import Array
from treadload.kernels.mixing import Anderson
from treadload.kernels.plasticity.state import State

Progress = Callable[[str], None]
Check = Callable[["Pressed", int], None]

# Less memory takes more than twice as many rounds above ten times the load of first yield.
_MEMORY, _MOST_ROUNDS = 15, 75
# Of the contact inside: looser than this part of what the plastic strain still changes it would stall the mixing.
_INNER, _FINEST = 1e-3, 1e-7
# Sub-steps over the largest load at first, and times that they are halved at most.
_PARTS, _MOST_HALVINGS = 2, 4
# Change of peak pressure and plastic strain by the last halving, over the largest of all loads. Of a method of
# second order a third of it is the error: half a per cent, as that of the cells.
STEP_ERROR = 0.015


@dataclass(frozen=True, eq=False)
class Pressed:
    """Body and ground under one load, N.

    pressure: (ny, nx), Pa. sunk: surface by plastic strain alone, (ny, nx), m. substeps: from the load before.
    peak_error, strain_error: what half as long sub-steps changed of the peak pressure, Pa, and of the largest
    equivalent plastic strain. before, size: state at the beginning of the last sub-step and its size, N, 0 where
    nothing yielded.
    """

    load: float
    approach: float
    pressure: Array
    sunk: Array
    state: State
    substeps: int
    before: State
    size: float
    peak_error: float = 0.0
    strain_error: float = 0.0

    @property
    def peak(self) -> float:
        """Largest pressure, Pa."""
        return float(self.pressure.max())

    @property
    def strain(self) -> float:
        """Largest equivalent plastic strain."""
        return float(self.state.hardening.max())


@dataclass
class Pressing:
    """A body over ground. gap: (ny, nx), m. near: pressure to start from, (ny, nx), Pa. tolerance: of the plastic
    strain of a sub-step, relative. zone: grows where it must. rounds: of the fixed point so far.
    """

    zone: Yielding
    influence: Influence
    gap: Array
    near: Array
    tolerance: float
    rounds: int = field(default=0, init=False)

    @property
    def virgin(self) -> Pressed:
        """Before any load."""
        state, flat = State.virgin(self.zone.ground.shape), np.zeros_like(self.gap)
        return Pressed(0.0, 0.0, flat, flat, state, 0, state, 0.0)

    def follow(self, loads: Sequence[float], progress: Progress, check: Check) -> list[Pressed]:
        """Through loads, N, in sub-steps short enough. check: called with each state and its number.

        Raises ConvergenceError where the shortest do not settle.
        """
        counts = [max(1, math.ceil(_PARTS * abs(b - a) / max(loads) - 1e-9)) for a, b in pairwise([0.0, *loads])]
        coarse: list[Pressed] | None = None
        for halvings in range(_MOST_HALVINGS + 1):
            try:
                fine = self._through(loads, [count << halvings for count in counts], progress, check)
            except ConvergenceError:
                if halvings == _MOST_HALVINGS:
                    raise
                coarse = None
                continue
            if not any(step.substeps for step in fine):
                break
            if coarse is not None:
                fine = [
                    replace(new, peak_error=abs(new.peak - old.peak), strain_error=abs(new.strain - old.strain))
                    for new, old in zip(fine, coarse, strict=True)
                ]
                if step_error(fine) <= STEP_ERROR:
                    break
            coarse = fine
        return fine

    def _through(
        self, loads: Sequence[float], counts: Sequence[int], progress: Progress, check: Check
    ) -> list[Pressed]:
        """Through loads in so many sub-steps each."""
        steps = [self.virgin]
        for number, (load, count) in enumerate(zip(loads, counts, strict=True), start=1):
            progress(f"step {number} of {len(loads)}, in {count} part(s)")
            steps.append(self._reach(load, steps[-1], count, f"step {number}"))
            check(steps[-1], number)
        return steps[1:]

    def _reach(self, load: float, begin: Pressed, count: int, name: str) -> Pressed:
        """From one load to another in so many sub-steps, or none where the ground stays elastic."""
        bare, elastic = self._elastic(load, begin.state)
        if elastic:
            return self._pressed(load, bare, begin.state, 0, begin.state, 0.0)
        state, before, size_before = begin.state, begin.before, begin.size
        size = (load - begin.load) / count
        for part in range(1, count + 1):
            ahead = _ahead(before, size_before, state, size)
            level = load if part == count else begin.load + part * size
            before, size_before = state, size
            state, touching = self._jump(level, ahead, name)
        return self._pressed(load, touching, state, count, before, size)

    def _pressed(
        self, load: float, touching: NormalSolution | None, state: State, count: int, before: State, size: float
    ) -> Pressed:
        pressure = np.zeros_like(self.gap) if touching is None else touching.pressure
        approach = 0.0 if touching is None else touching.approach
        sunk = self.zone.sunk(self.zone.of(state).strain)
        return Pressed(load, approach, pressure, sunk, state, count, before, size)

    def _elastic(self, load: float, state: State) -> tuple[NormalSolution | None, bool]:
        """Contact over a state as it is, and whether the ground stays elastic under it."""
        self.rounds += 1
        zone, inner = self.zone, self.zone.of(state)
        stress, touching = zone.stress_of_strain(inner.strain), None
        if load:
            dented = self.gap + zone.sunk(inner.strain)
            touching = solve_normal(self.influence, dented, load=load, start=self.near, tolerance=_FINEST)
            self.near = touching.pressure
            stress = stress + zone.pressed(self.near)
        after = zone.ground.material.return_map()(stress, inner)
        # What a sub-step has left undone within its tolerance is no yielding.
        small = max(self.tolerance * float(inner.hardening.max()), 1e-6 * zone.ground.material.yield_strain)
        return touching, float((after.hardening - inner.hardening).max()) <= small

    def _jump(self, load: float, state: State, name: str) -> tuple[State, NormalSolution | None]:
        """State and contact under a load, N, in one return map from a state."""
        while True:
            inner, touching = self._settled(load, self.zone.of(state), name)
            after = self.zone.put(state, inner)
            if self.zone.spared_border(state, after):
                return after, touching
            self.zone = self.zone.grown(state, after)

    def _settled(self, load: float, state: State, name: str) -> tuple[State, NormalSolution | None]:
        """The same in the zone alone."""
        zone, material = self.zone, self.zone.ground.material
        law, change, mixing = material.return_map(), np.zeros_like(state.strain), Anderson(_MEMORY)
        still = self.tolerance
        touching: NormalSolution | None = None
        for _ in range(_MOST_ROUNDS):
            self.rounds += 1
            stress = zone.stress_of_strain(state.strain + change) + law.elastic(change)
            if load:
                dented = self.gap + zone.sunk(state.strain + change)
                inner = min(max(_INNER * still, _FINEST), _INNER)
                touching = solve_normal(self.influence, dented, load=load, start=self.near, tolerance=inner)
                self.near = touching.pressure
                stress = stress + zone.pressed(self.near)
            after = law(stress, state)
            step = after.strain - state.strain
            size, off = float(np.linalg.norm(step)), float(np.linalg.norm(step - change))
            if off <= self.tolerance * size or np.abs(step - change).max() <= 1e-6 * material.yield_strain:
                return after, touching
            change, still = mixing.next(change, step), off / size if size else self.tolerance
        raise ConvergenceError(
            f"the plastic strain of {name} did not settle at {load:g} N in {_MOST_ROUNDS} rounds: it still changes "
            f"by {off / size:.1e} of itself, above the tolerance of {self.tolerance:.1e}; give loads between the "
            "present ones",
            off / size,
        )


def step_error(steps: Sequence[Pressed]) -> float:
    """The larger error of both, over the largest peak pressure and plastic strain of all loads."""
    peak, strain = max(step.peak for step in steps), max(step.strain for step in steps)
    return max(
        max(step.peak_error for step in steps) / peak if peak else 0.0,
        max(step.strain_error for step in steps) / strain if strain else 0.0,
    )


def _ahead(before: State, size_before: float, now: State, size: float) -> State:
    """Where BDF2 starts its return map: ahead of the state now, unless the load has turned."""
    # Longer than the last sub-step it would go further ahead than the flow is sure to follow.
    ratio = min(size / size_before, 1.0) if size_before else 0.0
    if ratio <= 0:
        return now
    part = ratio**2 / (1 + 2 * ratio)
    return State(
        now.strain + part * (now.strain - before.strain),
        now.hardening + part * (now.hardening - before.hardening),
        now.back + part * (now.back - before.back),
    )
