"""One pass at once: the plastic strain that a load leaves as it rolls steadily over a track.

In the load's frame material enters at large x and comes out behind. Its plastic strain at x is the sum of the
increments D at all larger x; each is eigenstrain in a bar that reaches back without end. The stress is that of the
elastic road, of the endless bars of earlier passes, and of these bars; along every line of material the return map is
marched from the front, strain-driven. -K of the residual stress is a projection in the elastic energy, so that the
whole contracts; Anderson's mixing takes the plastic strain of the pass to its fixed point.

The path of a material line runs from no load far ahead to no load far behind. Between centres of cells the total
strain changes linearly, and the return map follows it in `STEPS` sub-steps: backward Euler is of first order in the
length of a step, which is then a part of a cell. Behind the box the line is unloaded to the residual stress of the
whole track, in one more column of the fixed point: without it, what unloading makes yield would appear in the next
pass, far ahead of its load.

Source: Dang Van & Maitournam (1993), J. Mech. Phys. Solids 41, 1691-1710, for the steady pass; mixing as in
`kernels.mixing`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from treadload.kernels.arrays import Array
from treadload.kernels.eigenstrain.operator import Operator, endless, track
from treadload.kernels.mixing import Anderson
from treadload.kernels.plasticity.state import ReturnMap, State
from treadload.materials.plastic import ElastoPlastic, PassesPowerLaw
from treadload.response.passes.box import Box

# Rounds of the mixing keep so many; near-perfect plasticity needs them (fewer take twice as long, or do not end).
_MEMORY = 15
_MOST_ROUNDS = 120
# After so many rounds a change above this part will not settle any more.
_PATIENCE, _FAR = 40, 0.03
# Sub-steps of the return map from one cell to the next. On cells of an eighth of a sphere's contact radius plastic
# strain is too small by 5 % of itself with one, by 0.6 % with eight: about as one over their number.
STEPS = 6
# Changes below this part of the strain at yield are no plastic flow.
_NOTHING = 1e-6


class NoSteadyPassError(RuntimeError):
    """A pass whose plastic strain did not settle; residual: change of the last round, relative."""

    def __init__(self, residual: float) -> None:
        super().__init__(f"the plastic strain of a pass still changed by {residual:.1e} of itself")
        self.residual = residual


@dataclass(frozen=True, eq=False)
class Part:
    """Rows of a box that are of one material. rows: of the box. law: its return map."""

    rows: slice
    material: ElastoPlastic
    law: ReturnMap


@dataclass(frozen=True, eq=False)
class Track:
    """What a pass runs over: the box, its materials, and the operators of eigenstrain.

    stiffness: √G of each row, (nz,), √Pa: rows of different stiffness stress each other by the mean of their moduli,
    0 in a row that does not yield. bars, endless: operators for a shear modulus of 1 Pa.
    """

    box: Box
    parts: tuple[Part, ...]
    stiffness: Array
    bars: Operator
    endless: Operator

    @classmethod
    def of(cls, box: Box, layers: Sequence[ElastoPlastic | None]) -> Track:
        """layers: the material of each row, None where it is elastic."""
        box.check_size()
        yielding_layer = next(layer for layer in layers if layer is not None)
        poisson = yielding_layer.elastic.poisson
        stiffness = np.sqrt([0.0 if layer is None else layer.elastic.shear_modulus for layer in layers])
        parts, first = [], 0
        for row in range(1, len(layers) + 1):
            if row == len(layers) or layers[row] != layers[first]:
                material = layers[first]
                if material is not None and not isinstance(material.law, PassesPowerLaw):
                    parts.append(Part(slice(first, row), material, material.return_map()))
                first = row
        cells = box.cells
        # Means over cells: stress at their centres lets neighbours flow in turn where little hardens.
        bars = track(cells, 1.0, poisson, averaged=True, single=True)
        return cls(box, tuple(parts), stiffness, bars, endless(cells, 1.0, poisson, averaged=True))

    @cached_property
    def yield_strain(self) -> float:
        """Smallest strain at yield of the materials: of strength over modulus."""
        return min(part.material.yield_strain for part in self.parts)

    def residual(self, strain: Array) -> Array:
        """Stress (6, nz, ny), Pa, of plastic strain (6, nz, ny) that no longer varies along travel."""
        scale = self.stiffness[:, None]
        return scale * self.endless((scale * strain)[..., None])[..., 0]

    def stress(self, change: Array) -> Array:
        """Stress (6, nz, ny, nx), Pa, of what a pass has changed of the plastic strain so far, (6, nz, ny, nx)."""
        scale = self.stiffness[:, None, None]
        stress: Array = scale * self.bars(scale * taken(change))
        return stress

    def virgin(self) -> tuple[State, ...]:
        """The states of its parts before the first pass."""
        return tuple(State.virgin((part.rows.stop - part.rows.start, self.box.ny)) for part in self.parts)

    def whole(self, states: Sequence[State]) -> tuple[Array, Array]:
        """Plastic strain (6, nz, ny) and equivalent plastic strain (nz, ny) of the states of its parts."""
        strain, hardening = np.zeros((6, *self.box.shape)), np.zeros(self.box.shape)
        for part, state in zip(self.parts, states, strict=True):
            strain[:, part.rows], hardening[part.rows] = state.strain, state.hardening
        return strain, hardening


@dataclass(frozen=True, eq=False)
class Pass:
    """What one pass did. states: of the parts of the track after it. rounds: of the mixing. ends: largest equivalent
    plastic strain that it added behind the box, ahead of it, in the lines at its left and right, and in its last row.
    along: likewise, in each column of cells along travel, (nx,).
    """

    states: tuple[State, ...]
    rounds: int
    ends: Array
    along: Array


def taken(change: Array) -> Array:
    """What each cell along travel adds to a plastic strain (..., nx), coming from the front."""
    increments = change.copy()
    increments[..., :-1] -= change[..., 1:]
    return increments


def roll(
    road: Track,
    elastic: Array | Callable[[Array], Array],
    before: Sequence[State],
    *,
    duration: float = 0.0,
    tolerance: float = 1e-3,
    most: int = _MOST_ROUNDS,
    steps: int = STEPS,
) -> Pass:
    """One pass.

    elastic: stress (6, nz, ny, nx), Pa, of the load on the elastic road; of a load that depends on the track a
    function that gives it, of what the pass has changed of the plastic strain so far, (6, nz, ny, nx). before:
    states of the track. duration: in which material passes one cell, s. tolerance: of the plastic strain of the
    pass, relative. most: rounds. steps: of the return map from one cell to the next.
    Raises NoSteadyPassError where it does not settle.
    """
    old = road.whole(before)[0]
    left = road.residual(old)[..., None]
    # The last column is far behind the load.
    change, mixing = np.zeros((*old.shape, 1 + road.box.nx)), Anderson(_MEMORY)
    least, residual = _NOTHING * road.yield_strain, np.inf
    for rounds in range(1, most + 1):
        stress = np.repeat(left, change.shape[-1], axis=-1)
        stress[..., 1:] += elastic(change[..., 1:]) if callable(elastic) else elastic
        if rounds > 1:
            stress[..., 1:] += road.stress(change[..., 1:])
            stress[..., 0] += road.residual(change[..., 0])
        after, plastic, ends, along = _march(road, stress, old[..., None] + change, before, duration, steps)
        plastic -= old[..., None]
        size, moved = float(np.linalg.norm(plastic)), float(np.linalg.norm(plastic - change))
        residual = moved / size if size else 0.0
        if residual <= tolerance or np.abs(plastic - change).max() <= least:
            return Pass(after, rounds, ends, along)
        if rounds >= _PATIENCE and residual > _FAR:
            break
        change = mixing.next(change, plastic)
    raise NoSteadyPassError(residual)


def _march(
    road: Track, stress: Array, strain: Array, before: Sequence[State], duration: float, steps: int
) -> tuple[tuple[State, ...], Array, Array, Array]:
    """States behind, plastic strain everywhere (6, nz, ny, 1 + nx), what yields at the sides and along, see `Pass`.

    stress, strain: of which the trial stress is made, the first column far behind; strain is the plastic one.
    """
    plastic, ends, columns = np.zeros_like(strain), np.zeros(5), strain.shape[-1]
    along = np.zeros(columns)
    after = []
    for part, start in zip(road.parts, before, strict=True):
        driven = np.moveaxis(stress[:, part.rows] + part.law.elastic(strain[:, part.rows]), -1, 0).copy()
        # Far ahead there is no load, as far behind before.
        state, come_from = start, road.residual(road.whole(before)[0])[:, part.rows] + part.law.elastic(start.strain)
        for column in range(columns - 1, -1, -1):
            last = state
            # No time is known of the ways to the box and from it.
            time = duration if 0 < column < columns - 1 else 0.0
            state = _stepped(part.law, come_from, driven[column], state, time, steps)
            come_from = driven[column]
            plastic[:, part.rows, :, column] = state.strain
            if state is not last:
                along[column] = max(along[column], float((state.hardening - last.hardening).max()))
        added = state.hardening - start.hardening
        ends[2], ends[3] = max(ends[2], added[:, 0].max()), max(ends[3], added[:, -1].max())
        if part.rows.stop == plastic.shape[1]:
            ends[4] = float(added[-1].max())
        after.append(state)
    ends[:2] = along[[0, -1]]
    return tuple(after), plastic, ends, along[1:]


def _stepped(law: ReturnMap, begin: Array, end: Array, state: State, duration: float, steps: int) -> State:
    """The state where C:strain, (6, nz, ny), Pa, has gone straight from begin to end, in a number of steps.

    A yield surface is convex: of a straight way that ends inside it no part lies outside, so that only the points
    that yield at its end are followed.
    """
    yields = law.excess(end - law.elastic(state.strain), state) > 0
    if duration > 0:
        # A viscous law also flows on the way back to its yield surface.
        yields |= law.excess(begin - law.elastic(state.strain), state) > 0
    if not yields.any():
        return state
    first, last, inner = begin[:, yields], end[:, yields], state.at(yields)
    for step in range(1, steps + 1):
        trial = first + (last - first) * (step / steps) - law.elastic(inner.strain)
        inner = law(trial, inner, duration / steps)
    strain, hardening, back = state.strain.copy(), state.hardening.copy(), state.back.copy()
    strain[:, yields], hardening[yields], back[:, yields] = inner.strain, inner.hardening, inner.back
    return State(strain, hardening, back)
