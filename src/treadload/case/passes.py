"""How often the load of a case rolls over its road, where that yields."""

from __future__ import annotations

from pydantic import model_validator

from treadload.errors import positive
from treadload.read import Table
from treadload.units import Length


class PassesPart(Table):
    """`[passes]`: passes of the wheels over a road with a layer that yields, see `treadload.roll_passes`.

    count: how many. spacing: of the cells that may yield; left out, the footprint's longer side over 32, and across
    travel a twelfth of a rib's width where that is less. depth: of the box of these, from the surface; left out, it
    grows until it holds what yields. layers: rows of cells in it; left out, as many as it takes.
    wander: standard deviation of the wheel's place across the road; left out, all passes follow one line.
    """

    count: int = 10
    spacing: Length | None = None
    depth: Length | None = None
    layers: int | None = None
    wander: Length | None = None

    @model_validator(mode="after")
    def _possible(self) -> PassesPart:
        if self.count < 1:
            raise ValueError(f"count must be >= 1, got {self.count}")
        if self.layers is not None and not 2 <= self.layers <= 64:
            raise ValueError(f"layers must lie in [2, 64], got {self.layers}; leave it out for the default")
        for name in ("spacing", "depth", "wander"):
            value = getattr(self, name)
            if value is not None:
                positive(name, value, "metres", "leave it out for the default")
        return self
