"""Stones in the mortar of the top layer, in a window below the wheels."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any, ClassVar, Literal

from pydantic import model_validator

from treadload.case.choices import STONE
from treadload.case.description import Description
from treadload.case.step import Step
from treadload.citations import STONES
from treadload.errors import positive
from treadload.materials import Aggregates, Elastic
from treadload.pavement import Pavement
from treadload.read import Table
from treadload.response import Heterogeneous, compute_heterogeneous
from treadload.response.heterogeneous import mortar_road
from treadload.steps.scene import Scene
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


class AggregatesStep(Step, name="aggregates"):
    """`[aggregates]`: stones in the mortar of the top layer, in a window below the wheels.

    material: of the stones. mortar: what is between them; left out, the top layer is mortar. fraction: of the
    window, in (0, 1). radii: of the stones. shares: of the stones' volume by radius; left out, all the same. window:
    where. spacing: of its cells. seed, gap, cover: of the drawing, see `Aggregates.random`. bond_strength: tension
    that the bond of mortar on stone withstands. borders: "steps" of whole cells, or "shares" of cut ones. See
    `treadload.response.compute_heterogeneous`.

    >>> wheel = {"tire": {"profile": "315/80R22.5"}, "rolling": {"normal_load": "32.5 kN", "friction": 0.7}}
    >>> road = {"pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3", "temperature": 15}}
    >>> window = {"x": "0 mm", "y": "0 mm", "length": "40 mm", "width": "40 mm", "depth": "20 mm"}
    >>> stones = {"material": {"kind": "elastic", "modulus": "60 GPa", "poisson": 0.2}, "radii": ["4 mm"]}
    >>> case = tl.Case.from_dict(wheel | road | {"aggregates": stones | {"fraction": 0.3, "window": window}})
    >>> [step.name for step in case.steps if isinstance(step, tl.steps.AggregatesStep)]
    ['aggregates']
    """

    makes: ClassVar = ("heterogeneous",)

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
    def _possible(self) -> AggregatesStep:
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

    def check(self, case: Description) -> None:
        """Refuse a road whose top layer cannot hold the window."""
        self.road(case.road())

    def cites(self, case: Description) -> tuple[str, ...]:
        """Methods of the step."""
        return STONES

    def solve(self, scene: Scene) -> Heterogeneous:
        """Stress and strain in the stones and the mortar of the window."""
        window, load = self.window, scene.loaded
        return compute_heterogeneous(
            load.wheels, self.road(load.road), self.build(), window=(window.length, window.width), depth=window.depth,
            at=(window.x, window.y), spacing=self.spacing, bond_strength=self.bond_strength, borders=self.borders,
            progress=scene.tell,
        )  # fmt: skip
