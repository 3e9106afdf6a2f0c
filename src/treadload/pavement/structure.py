"""The road: layers on a half-space."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from treadload.errors import InputError
from treadload.materials import Elastic


@dataclass(frozen=True)
class Layer:
    """One layer of a road.

    material: what it is made of. thickness: m; None for the last layer, which goes down for ever.
    name: free text.
    """

    material: Elastic
    thickness: float | None = None
    name: str = ""

    def __post_init__(self) -> None:
        if self.thickness is not None and not (math.isfinite(self.thickness) and self.thickness > 0):
            raise InputError(
                f"layer {self.name!r}: thickness must be a positive number of metres, got {self.thickness}; "
                "leave it out for the last layer"
            )


@dataclass(frozen=True)
class Pavement:
    """Layers from the surface down; the last one has no thickness."""

    layers: tuple[Layer, ...]

    def __init__(self, layers: Sequence[Layer]) -> None:
        object.__setattr__(self, "layers", tuple(layers))
        if not self.layers:
            raise InputError("a pavement needs at least one layer, got none")
        for number, layer in enumerate(self.layers[:-1], start=1):
            if layer.thickness is None:
                raise InputError(
                    f"layer {number} ({layer.name!r}) of {len(self.layers)} has no thickness; "
                    "only the last layer goes down for ever"
                )
        if self.layers[-1].thickness is not None:
            raise InputError(
                f"the last layer ({self.layers[-1].name!r}) must have no thickness, "
                f"got {self.layers[-1].thickness} m; add the soil below it as a layer without thickness"
            )

    @classmethod
    def half_space(cls, material: Elastic, name: str = "") -> Pavement:
        """A road of one material, as deep as you like."""
        return cls([Layer(material, name=name)])

    @property
    def surface_material(self) -> Elastic:
        """Material of the top layer."""
        return self.layers[0].material

    @property
    def is_homogeneous(self) -> bool:
        """True if every layer has the same material."""
        return all(layer.material == self.surface_material for layer in self.layers)
