"""An elastic road as the kernels of layered bodies want it."""

from __future__ import annotations

import math
from collections.abc import Sequence

from treadload.errors import InputError
from treadload.kernels.layers.layered import Stack
from treadload.materials.elastic import Elastic
from treadload.pavement.structure import Pavement


def stack_of(road: Pavement, materials: Sequence[Elastic] | None = None) -> Stack:
    """Moduli, thicknesses and springs of the distinct layers, neighbours of one material taken as one.

    materials: of the distinct layers, in place of their own.
    Raises InputError for a layer that is not elastic and for a half-bonded interface, which is two roads.
    """
    layers = road.distinct_layers
    materials = [layer.elastic for layer in layers] if materials is None else materials
    springs = []
    for layer in layers[:-1]:
        if len(layer.bond.limits) > 1:
            raise InputError(
                f"the interface below layer {layer.name!r} is {layer.bond}, which stands for the mean of "
                f"{len(layer.bond.limits)} roads; solve each of road.bond_limits"
            )
        springs.append(layer.bond.stiffness)
    return Stack(
        tuple(material.shear_modulus for material in materials),
        tuple(material.poisson for material in materials),
        tuple(math.inf if layer.thickness is None else layer.thickness for layer in layers),
        tuple(springs),
        road.rigid_base,
    )
