"""The road in a case: layers and how they hold together."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Discriminator, Field, Tag

from treadload.case.fields import Length, Part, Stiffness
from treadload.case.materials import MaterialPart
from treadload.pavement import BONDED, FRICTIONLESS, Bond, Layer, Pavement

BOND_TAGS = ("word", "spring")


class BondPart(Part):
    """`bond = { stiffness = "1000 MPa/m" }`."""

    stiffness: Stiffness


class LayerPart(Part):
    """`[[pavement.layers]]`, from the surface down; the last one has no thickness unless the base is rigid.

    bond, to the layer below: "bonded", "frictionless" or `{ stiffness = "1000 MPa/m" }`.
    """

    material: MaterialPart
    thickness: Length | None = None
    name: str = ""
    bond: Annotated[
        Annotated[Literal["bonded", "frictionless"], Tag("word")] | Annotated[BondPart, Tag("spring")],
        Discriminator(lambda v: "word" if isinstance(v, str) else "spring"),
    ] = "bonded"

    def build(self) -> Layer:
        """The layer."""
        if isinstance(self.bond, BondPart):
            bond = Bond(self.bond.stiffness)
        else:
            bond = FRICTIONLESS if self.bond == "frictionless" else BONDED
        return Layer(self.material.build(), self.thickness, name=self.name, bond=bond)


class PavementPart(Part):
    """`[pavement]`: the road's layers."""

    layers: tuple[LayerPart, ...] = Field(min_length=1)
    rigid_base: bool = False

    def build(self) -> Pavement:
        """The pavement."""
        return Pavement([layer.build() for layer in self.layers], rigid_base=self.rigid_base)
