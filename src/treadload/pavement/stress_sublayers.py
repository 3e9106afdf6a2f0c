"""Stress-dependent layers divided over depth, and the stress of their own weight."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.materials import AtStress, StressDependent
from treadload.pavement.bonds import BONDED
from treadload.pavement.layer import Layer
from treadload.pavement.structure import Pavement
from treadload.pavement.sublayers import part_sizes

# Parts are as thick as this, m, near the surface, and as this share of the depth of their top further down.
THINNEST, PER_DEPTH = 0.03, 0.25
# A semi-infinite layer is divided to so far below its top, m; its rest has the modulus of the stress at so many times
# the depth of that.
_DIVIDED_TO, _REST = 10.0, 1.25
# Of the layers whose weight is not stated, asphalt and what is bound, N/m³.
UNIT_WEIGHT = 23e3
# Layers that a response solves in seconds.
_MOST = 80


@dataclass(frozen=True, eq=False)
class StressSublayers:
    """A road whose stress-dependent layers are divided over depth.

    road: divided; the parts still depend on stress. owner: for each of its layers the number of the layer that it
    was. parts: numbers of the parts that depend on stress (n,). depths: at which their stress is taken, their middles
    (n,), m. vertical, horizontal: stress of the weight of the road there (n,), Pa, compression positive.
    """

    road: Pavement
    owner: tuple[int, ...]
    parts: tuple[int, ...]
    depths: Array
    vertical: Array
    horizontal: Array

    @classmethod
    def of(cls, road: Pavement) -> StressSublayers:
        """The road, whose layers have their temperature, divided. Raises InputError for too many parts."""
        layers: list[Layer] = []
        owner: list[int] = []
        top = 0.0
        for number, layer in enumerate(road.layers):
            divided = _parts(layer, top)
            layers += divided
            owner += [number] * len(divided)
            top += layer.thickness or 0.0
        if len(layers) > _MOST:
            raise InputError(
                f"the road would have {len(layers)} sublayers, at most {_MOST} are solved; take thicker ones by "
                "sublayer= of the materials"
            )
        divided_road = Pavement(layers, rigid_base=road.rigid_base)
        parts = tuple(number for number, layer in enumerate(layers) if layer.depends_on_stress)
        depths, vertical = _overburden(divided_road)
        pressure = np.array([_material(layers[number]).earth_pressure for number in parts])
        at = list(parts)
        return cls(divided_road, tuple(owner), parts, depths[at], vertical[at], pressure * vertical[at])

    @property
    def materials(self) -> tuple[StressDependent, ...]:
        """Of the parts that depend on stress."""
        return tuple(_material(self.road.layers[number]) for number in self.parts)

    def name(self, part: int) -> str:
        """Of the layer that a part belongs to, counted among those that depend on stress."""
        number = self.owner[self.parts[part]]
        return self.road.layers[self.parts[part]].name.rpartition(" ")[0] or f"layer {number + 1}"

    def with_materials(self, materials: Sequence[AtStress]) -> Pavement:
        """The road with the parts that depend on stress as they are under a state of stress."""
        layers = list(self.road.layers)
        for number, material in zip(self.parts, materials, strict=True):
            layers[number] = replace(layers[number], material=material)
        return Pavement(layers, rigid_base=self.road.rigid_base)


def _material(layer: Layer) -> StressDependent:
    assert isinstance(layer.material, StressDependent)
    return layer.material


def _parts(layer: Layer, top: float) -> list[Layer]:
    """A layer divided over depth, bonded within; itself where it does not depend on stress."""
    if not layer.depends_on_stress:
        return [layer]
    finite = _DIVIDED_TO if layer.thickness is None else layer.thickness
    sizes = part_sizes(top, finite, _material(layer).sublayer, thinnest=THINNEST, per_depth=PER_DEPTH)
    thicknesses: list[float | None] = [*sizes, *([None] if layer.thickness is None else [])]
    count = len(thicknesses)
    name = layer.name or "layer"
    return [
        replace(
            layer, thickness=thickness, name=f"{name} {part}/{count}", bond=layer.bond if part == count else BONDED
        )
        for part, thickness in enumerate(thicknesses, start=1)
    ]


def _overburden(road: Pavement) -> tuple[Array, Array]:
    """Depth at which each layer's stress is taken, m, and the vertical stress of the road's weight there, Pa."""
    depths, stresses = [], []
    top = above = 0.0
    for layer in road.layers:
        weight = layer.material.unit_weight if isinstance(layer.material, StressDependent) else UNIT_WEIGHT
        middle = top * (_REST - 1) if layer.thickness is None else 0.5 * layer.thickness
        depths.append(top + middle)
        stresses.append(above + weight * middle)
        top += layer.thickness or 0.0
        above += weight * (layer.thickness or 0.0)
    return np.array(depths), np.array(stresses)
