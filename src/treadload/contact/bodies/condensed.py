"""Normal compliance of ribs with a share of their shear condensed out.

Friction holds the face of a rib that is pressed: where it sticks, a change of pressure changes the shear as well, and
this shear closes the gap again. With the compliance of the rows under a wave along travel as C_tt, C_nt, C_tn and
C_nn, the normal compliance of a face that sticks is the Schur complement C_nn - C_nt C_tt⁻¹ C_tn. Rounds of pressure
and shear that press with a part of it need fewer steps, because the pressure allows for what the shear will do. They
lead to the same solution: the reaction that was allowed for is taken off with the pressure of the same round.

Source: static condensation, Guyan (1965), AIAA J. 3, 380.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from treadload.contact.bodies.influence import Influence
from treadload.kernels.arrays import Array
from treadload.kernels.gridding.strips import Strips

# Share of the reaction that is condensed out. Cells that stick react by nearly all of it and cells that slide by
# nothing: with a half, neither is further off than the other.
_SHARE = 0.5
_NAME = "condensed"


@dataclass(frozen=True)
class CondensedInfluence(Influence):
    """`Influence` of an elastic pair with strips whose normal compliance has a share of the shear condensed out.

    plain: the operators of the pair, which all but `normal`, its inverse and its diagonal are.
    """

    plain: Influence | None = None

    __hash__ = None  # type: ignore[assignment]

    @classmethod
    def of(cls, influence: Influence) -> CondensedInfluence | None:
        """The same cells and bodies; None of a pair without strips, or with memory, which is not symmetric."""
        if not (influence.has_strips and influence.symmetric):
            return None
        condensed = influence.derived.get(_NAME)
        if not isinstance(condensed, cls):
            cells = influence.shape, influence.dx, influence.dy
            condensed = influence.derived[_NAME] = cls(*cells, influence.pair, influence.first_y, influence)
        return condensed

    def gap_by(self, shear: Array, pressure: Array) -> Array:
        """Gap opening (ny, nx), m, by shear (2, ny, nx) on body 1, less what `normal` of the pressure (ny, nx) has.

        `normal` of a pressure and this together are the gap opening of the pair by pressure and shear.
        """
        assert self.plain is not None
        loads = np.concatenate([shear, pressure[None]])
        opening = self._openings.displacement(loads, (0, 1, 2), (2,), self.shape[1])[0]
        return np.asarray(opening + self.plain.convolved_gap(shear))

    def strips_of(self, length: int) -> Strips | None:
        """As of `Influence`."""
        if length not in self._lengths:
            strips = self._plain_strips(length)
            blocks = []
            for block, reaction in zip(strips.blocks, _reactions(strips), strict=True):
                rows = reaction.shape[1]
                condensed = block.copy()
                condensed[:, -rows:, -rows:] -= reaction
                blocks.append(condensed)
            self._lengths[length] = Strips(strips.rows, tuple(blocks), length)
        return self._lengths[length]

    @cached_property
    def _openings(self) -> Strips:
        """Opening by shear, and by pressure what is condensed out of `normal`, in the length of `padding`."""
        strips = self._plain_strips(self.padding.shape[1])
        blocks = []
        for block, reaction in zip(strips.blocks, _reactions(strips), strict=True):
            rows = reaction.shape[1]
            opening = block.copy()
            opening[:, -rows:, -rows:] = reaction
            blocks.append(opening)
        return Strips(strips.rows, tuple(blocks), strips.length)

    def _plain_strips(self, length: int) -> Strips:
        assert self.plain is not None
        strips = self.plain.strips_of(length)
        assert strips is not None
        return strips


def _reactions(strips: Strips) -> list[Array]:
    """What is condensed out of the normal compliance (waves, n, n) of every group, m/Pa."""
    reactions = []
    for block in strips.blocks:
        shear = 2 * block.shape[1] // 3
        sticking, coupling = block[:, :shear, :shear], block[:, shear:, :shear]
        reactions.append(_SHARE * coupling @ np.linalg.solve(sticking, coupling.swapaxes(1, 2)))
    return reactions
