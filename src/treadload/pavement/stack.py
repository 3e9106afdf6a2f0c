"""An elastic road as the kernels of layered bodies want it."""

from __future__ import annotations

import math
from collections.abc import Sequence

from treadload.errors import InputError
from treadload.kernels.half_space.upright import Medium, UprightMedium
from treadload.kernels.layers.layered import Stack
from treadload.kernels.layers.upright import Upright
from treadload.materials import Elastic, Solid
from treadload.pavement.structure import Pavement


def stack_of(road: Pavement, materials: Sequence[Solid] | None = None, *, sticking: bool = False) -> Stack:
    """Moduli, thicknesses and springs of the distinct layers, neighbours of one material taken as one.

    materials: of the distinct layers, in place of their own. sticking: True to bond a parted face.
    Raises InputError for a layer that is not elastic, for a half-bonded interface, which is two roads, and for a
    parted face.
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
        springs.append((layer.bond.sticking if sticking else layer.bond).stiffness)
    return Stack(
        tuple(plane_of(material)[0] for material in materials),
        tuple(plane_of(material)[1] for material in materials),
        tuple(math.inf if layer.thickness is None else layer.thickness for layer in layers),
        tuple(springs),
        road.rigid_base,
        () if all(isinstance(material, Elastic) for material in materials) else tuple(map(upright_of, materials)),
    )


def plane_of(material: Solid) -> tuple[float, float]:
    """Shear modulus, Pa, and Poisson's ratio in the horizontal plane."""
    if isinstance(material, Elastic):
        return material.shear_modulus, material.poisson
    return material.shear_horizontal, material.poisson_horizontal


def upright_of(material: Solid) -> Upright | None:
    """What a material has of its own along the vertical; None of an isotropic one."""
    if isinstance(material, Elastic):
        return None
    stiffness = material.stiffness
    return Upright(float(stiffness[2, 2]), float(stiffness[0, 2]), float(stiffness[3, 3]))


def medium_of(material: Solid) -> Medium:
    """A half-space of a material, but for the shear modulus in the horizontal plane."""
    (shear, poisson), upright = plane_of(material), upright_of(material)
    return poisson if upright is None else UprightMedium.of(shear, poisson, upright)
