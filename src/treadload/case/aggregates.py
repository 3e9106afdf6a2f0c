"""A window of stones in mortar that a case looks into."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any, Literal

from pydantic import model_validator

from treadload.case.choices import STONE
from treadload.errors import positive
from treadload.materials import Aggregates, Elastic
from treadload.pavement import Pavement
from treadload.read import Table
from treadload.response.heterogeneous import mortar_road
from treadload.units import Length, Number, Pressure, Share

StoneTable = Annotated[Any, STONE]


class WindowPart(Table):
    """`window = { y = "-60 mm", length = "36 mm", width = "36 mm", depth = "16 mm" }`: where stones are seen.

    x, y: of its middle, m; y = 0 is below the middle of the wheel. length: along x. width: along y. depth: from the
    surface down.
    """

    x: Length = 0.0
    y: Length = 0.0
    length: Length
    width: Length
    depth: Length


class AggregatesPart(Table):
    """`[aggregates]`: stones in the mortar of the top layer, in a window below the wheels.

    material: of the stones. mortar: what is between them; left out, the top layer is mortar. fraction: of the
    window, in (0, 1). radii: of the stones. shares: of the stones' volume by radius; left out, all the same. window:
    where. spacing: of its cells. seed, gap, cover: of the drawing, see `tl.Aggregates.random`. bond_strength: tension
    that mortar on stone bears. borders: "steps" of whole cells, or "shares" of cut ones. See
    `treadload.compute_heterogeneous`.
    """

    material: StoneTable
    mortar: StoneTable = None
    fraction: Number
    radii: tuple[Length, ...]
    shares: tuple[Share, ...] | None = None
    window: WindowPart
    spacing: Length = 1e-3
    seed: int = 0
    gap: Length = 0.0
    cover: Length = 0.0
    bond_strength: Pressure | None = None
    borders: Literal["steps", "shares"] = "steps"

    @model_validator(mode="after")
    def _possible(self) -> AggregatesPart:
        self.build()
        positive("spacing", self.spacing, "metres", "1 mm is 0.001")
        return self

    def build(self) -> Aggregates:
        """The stones, not drawn yet."""
        radii: Sequence[Any] = self.radii
        if self.shares is not None:
            if len(self.shares) != len(self.radii):
                raise ValueError(f"shares need one per radius, got {len(self.shares)} for {len(self.radii)}")
            radii = list(zip(self.radii, self.shares, strict=True))
        stone: Elastic = STONE.build(self.material)
        return Aggregates.random(self.fraction, radii, stone, seed=self.seed, gap=self.gap, cover=self.cover)

    def road(self, road: Pavement) -> Pavement:
        """The road with the mortar in its top layer. Raises InputError for one that cannot hold the window."""
        return mortar_road(road, None if self.mortar is None else STONE.build(self.mortar), self.window.depth)
