"""A body that dents a road that yields: pressed into it and lifted, or rolled over its own track."""

from __future__ import annotations

import math

from pydantic import model_validator

from treadload.errors import positive
from treadload.read import Table
from treadload.units import Force, Length, Number, Speed


class IndentationPart(Table):
    """`[indentation]`: the body of `[tire]` pressed into a half-space that yields, see `treadload.solve_indentation`.

    loads: one a step, in their order; 0 lifts the body off. spacing: of the cells, 3 mm or those of a height map if
    left out. depth: of what may yield; left out, 2.2 times the radius of the elastic contact. layers: rows of cells
    in it. tolerance: of the plastic strain of a step, relative. It stands in place of `[rolling]`.
    """

    loads: tuple[Force, ...]
    spacing: Length | None = None
    depth: Length | None = None
    layers: int = 14
    tolerance: Number = 1e-3

    @model_validator(mode="after")
    def _possible(self) -> IndentationPart:
        if not self.loads or not all(0 <= one < math.inf for one in self.loads) or max(self.loads) <= 0:
            raise ValueError(
                f"loads must be forces >= 0 N with one above, got {list(self.loads)}; 0 lifts the body off"
            )
        _check_cells(self, "spacing", "depth")
        return self


class DrumPart(Table):
    """`[drum]`: the body of `[tire]` rolled over its own track, see `treadload.response.roll_drum`.

    load: on the drum. passes: at most; one that adds less than 1 % of the strain at yield is the last. speed: which
    laws of Perzyna need. spacing_along, spacing_across: of the cells along travel and across it, both or none; left
    out, a twelfth of the elastic contact's length and a 28th of the drum's width. depth: of what may yield; left out,
    it grows until it holds it. layers: rows of cells in it. tolerance: of the plastic strain of a pass, relative. It
    stands in place of `[rolling]`.
    """

    load: Force
    passes: int = 8
    speed: Speed | None = None
    spacing_along: Length | None = None
    spacing_across: Length | None = None
    depth: Length | None = None
    layers: int = 10
    tolerance: Number = 1e-3

    @model_validator(mode="after")
    def _possible(self) -> DrumPart:
        positive("load", self.load, "N", 'a vibrating roller\'s drum carries near "50 kN"')
        if self.passes < 1:
            raise ValueError(f"passes must be >= 1, got {self.passes}")
        if self.speed is not None:
            positive("speed", self.speed, "m/s", "leave it out where no law follows time")
        if (self.spacing_along is None) != (self.spacing_across is None):
            raise ValueError("give spacing_along and spacing_across, or none of them")
        _check_cells(self, "spacing_along", "spacing_across", "depth")
        return self

    @property
    def spacing(self) -> tuple[float, float] | None:
        """Of the cells along travel and across it, m."""
        if self.spacing_along is None or self.spacing_across is None:
            return None
        return self.spacing_along, self.spacing_across


def _check_cells(part: IndentationPart | DrumPart, *lengths: str) -> None:
    for name in lengths:
        value = getattr(part, name)
        if value is not None:
            positive(name, value, "metres", "leave it out for the default")
    if not 2 <= part.layers <= 64:
        default = type(part).model_fields["layers"].default
        raise ValueError(f"layers must lie in [2, 64], got {part.layers}; {default} is the default")
    if not 1e-6 <= part.tolerance <= 0.1:
        default = type(part).model_fields["tolerance"].default
        raise ValueError(f"tolerance must lie in [1e-6, 0.1], got {part.tolerance:g}; {default:g} is the default")
