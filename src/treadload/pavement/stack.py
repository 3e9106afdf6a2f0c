"""A road as the kernels of layered bodies want it."""

from __future__ import annotations

import math

from treadload.errors import InputError
from treadload.kernels.layered import Stack
from treadload.materials import Elastic
from treadload.pavement.structure import Pavement


def stack_of(road: Pavement) -> Stack:
    """Moduli, thicknesses and springs of the distinct layers. Raises InputError for layers that are not elastic."""
    layers = road.distinct_layers
    for layer in layers:
        if not isinstance(layer.material, Elastic):
            raise InputError(
                f"layer {layer.name!r} is not elastic ({layer.material}), and the contact on layers needs elastic "
                "ones; give the modulus at the speed and temperature of the contact"
            )
    return Stack(
        [layer.material.shear_modulus for layer in layers],
        [layer.material.poisson for layer in layers],
        [math.inf if layer.thickness is None else layer.thickness for layer in layers],
        [layer.bond.stiffness for layer in layers[:-1]],
        road.rigid_base,
    )
