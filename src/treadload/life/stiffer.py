"""Roads with a modulus times a factor, and what tables call their layers."""

from __future__ import annotations

from dataclasses import replace

from treadload.materials import Anisotropic, Elastic, Mix, StressDependent
from treadload.pavement import Pavement


def stiffer(road: Pavement, number: int, factor: float) -> Pavement:
    """The road with the modulus of a layer, from 0 at the surface, times a factor; at all temperatures."""
    layers = list(road.layers)
    material = layers[number].material
    if isinstance(material, Mix):
        rows = tuple(tuple(value * factor for value in row) for row in material.moduli)
        layers[number] = replace(layers[number], material=replace(material, moduli=rows))
    elif isinstance(material, StressDependent):
        layers[number] = replace(layers[number], material=replace(material, factor=material.factor * factor))
    elif isinstance(material, Anisotropic):
        layers[number] = replace(layers[number], material=material.stiffer(factor))
    else:
        assert isinstance(material, Elastic)
        layers[number] = replace(layers[number], material=replace(material, modulus=material.modulus * factor))
    return Pavement(layers, rigid_base=road.rigid_base)


def names_of(road: Pavement) -> list[str]:
    """What tables call the layers: their names, with their numbers where several have one."""
    names = [layer.name or f"layer {k}" for k, layer in enumerate(road.layers, start=1)]
    return [name if names.count(name) == 1 else f"{name} ({k})" for k, name in enumerate(names, start=1)]
