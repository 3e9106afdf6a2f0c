"""The road: layers on a half-space or a rigid base, and how they hold together."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.materials import Elastic, Material, TemperatureDependent


@dataclass(frozen=True)
class Bond:
    """How a layer holds to the one below: shear = stiffness x relative sliding; the layers never part.

    stiffness: Pa/m, >= 0; infinite when bonded, 0 without friction. It matters between some 1e9 and 1e12 Pa/m.
    Raises InputError for a negative stiffness.
    Source: Goodman, Taylor and Brekke (1968), J. Soil Mech. Found. Div. ASCE 94, 637-659.
    """

    stiffness: float

    def __post_init__(self) -> None:
        if not self.stiffness >= 0:
            raise InputError(
                f"the stiffness of a bond must be >= 0 Pa/m, got {self.stiffness}; 0 is frictionless, "
                "infinity is bonded"
            )

    def __str__(self) -> str:
        if self == BONDED:
            return "bonded"
        return "frictionless" if self == FRICTIONLESS else f"spring of {self.stiffness / 1e6:g} MPa/m"


BONDED = Bond(math.inf)
"""No relative sliding."""
FRICTIONLESS = Bond(0.0)
"""No shear between the layers."""


@dataclass(frozen=True)
class Layer:
    """One layer of a road.

    material: what it is made of: elastic, viscoelastic, or known once its temperature is. thickness: m; None for
    the last layer, which goes down for ever. name: free text. bond: to the layer below, BONDED, FRICTIONLESS or
    Bond(stiffness=...).
    """

    material: Material | TemperatureDependent
    thickness: float | None = None
    name: str = ""
    bond: Bond = BONDED

    def __post_init__(self) -> None:
        if self.thickness is not None and not (math.isfinite(self.thickness) and self.thickness > 0):
            raise InputError(
                f"layer {self.name!r}: thickness must be a positive number of metres, got {self.thickness}; "
                "leave it out for the last layer"
            )
        if not isinstance(self.bond, Bond):
            raise InputError(
                f"layer {self.name!r}: bond must be BONDED, FRICTIONLESS or Bond(stiffness=...), got {self.bond!r}"
            )

    @property
    def elastic(self) -> Elastic:
        """The material, where it is elastic. Raises InputError for one that needs a speed or a temperature."""
        material = self.resolved
        if not isinstance(material, Elastic):
            raise InputError(
                f"layer {self.name!r} is viscoelastic ({material}): give the speed of the load (m/s), or solve with "
                "an elastic limit of the material, .glassy for fast and .rubbery for slow loads"
            )
        return material

    @property
    def resolved(self) -> Material:
        """The material, elastic or viscoelastic. Raises InputError for one that needs a temperature."""
        if isinstance(self.material, TemperatureDependent):
            raise InputError(
                f"layer {self.name!r} depends on temperature ({self.material}): choose one first with "
                "Pavement.at_temperature(...)"
            )
        return self.material


@dataclass(frozen=True)
class Pavement:
    """Layers from the surface down; the last one has no thickness, unless it lies on a rigid base.

    layers: from the surface down. rigid_base: True if the last layer, then with a thickness, is bonded to rock
    that does not move. Raises InputError for a missing or surplus thickness and a bond below the last layer.
    """

    layers: tuple[Layer, ...]
    rigid_base: bool = False

    def __init__(self, layers: Sequence[Layer], *, rigid_base: bool = False) -> None:
        object.__setattr__(self, "layers", tuple(layers))
        object.__setattr__(self, "rigid_base", bool(rigid_base))
        if not self.layers:
            raise InputError("a pavement needs at least one layer, got none")
        for number, layer in enumerate(self.layers[:-1], start=1):
            if layer.thickness is None:
                raise InputError(
                    f"layer {number} ({layer.name!r}) of {len(self.layers)} has no thickness; "
                    "only the last layer goes down for ever"
                )
        last = self.layers[-1]
        if self.rigid_base and last.thickness is None:
            raise InputError(
                f"the last layer ({last.name!r}) lies on a rigid base and needs a thickness, got none; "
                "give one or take the rigid base away"
            )
        if not self.rigid_base and last.thickness is not None:
            raise InputError(
                f"the last layer ({last.name!r}) must have no thickness, "
                f"got {last.thickness} m; add the soil below it as a layer without thickness"
            )
        if last.bond != BONDED:
            raise InputError(
                f"the last layer ({last.name!r}) has no layer below it to hold to, got the bond {last.bond}; "
                "give the bond to the layer above the interface"
            )

    @classmethod
    def half_space(cls, material: Material | TemperatureDependent, name: str = "") -> Pavement:
        """A road of one material, as deep as you like."""
        return cls([Layer(material, name=name)])

    @property
    def surface_material(self) -> Elastic:
        """Elastic material of the top layer; of a viscoelastic one the limit of fast loads.

        Raises InputError for a material that needs a temperature.
        """
        material = self.layers[0].resolved
        return material if isinstance(material, Elastic) else material.glassy

    @property
    def distinct_layers(self) -> tuple[Layer, ...]:
        """The layers, with neighbours of one material that are bonded taken as one."""
        joined = [self.layers[0]]
        for layer in self.layers[1:]:
            above = joined[-1]
            if above.bond != BONDED or above.material != layer.material:
                joined.append(layer)
                continue
            assert above.thickness is not None
            thickness = None if layer.thickness is None else above.thickness + layer.thickness
            joined[-1] = replace(above, thickness=thickness, bond=layer.bond)
        return tuple(joined)

    @property
    def interfaces(self) -> Array:
        """Depth of the bottom of every layer that has one, m, downwards; empty for a half-space."""
        return np.cumsum([layer.thickness for layer in self.layers if layer.thickness is not None])

    @property
    def is_homogeneous(self) -> bool:
        """True if the road is one half-space: one material, bonded, without rigid base."""
        return len(self.distinct_layers) == 1 and not self.rigid_base
