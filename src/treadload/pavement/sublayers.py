"""Courses divided over depth, so that each part has its own temperature and age."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from treadload.errors import InputError
from treadload.materials import TemperatureDependent
from treadload.materials.ageing import Aged, Ageing
from treadload.pavement.bonds import BONDED
from treadload.pavement.layer import Layer
from treadload.pavement.structure import Pavement
from treadload.pavement.temperature import TemperatureProfile

# Parts are as thick as this at the surface, m, where a day's wave is steepest, and half as thick as they are deep.
THINNEST, PER_DEPTH = 0.02, 0.5
# Layers that a response solves in seconds.
_MOST = 60


def divided(
    road: Pavement, *, thickest: float | None = None, ageing: Ageing | None = None
) -> tuple[Pavement, tuple[int, ...]]:
    """The road with every course that depends on temperature divided into bonded parts of the same mix.

    road: whose materials wait for their temperature. thickest: of a part, m, then all of a course are equal; left
    out, 20 mm at the surface and half its depth further down. ageing: of the mixes, each part at its middle.
    Returns the road and, for each of its layers, the number of the layer that it was. Raises InputError.

    >>> parts, courses = tl.pavement.divided(tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3"), thickest=0.05)
    >>> [round(layer.thickness * 1e3) for layer in parts.layers[:-1]]  # mm
    [30, 30, 50, 50, 50]
    >>> courses
    (0, 0, 1, 1, 1, 2)
    """
    if thickest is not None and not 0.002 <= thickest <= 10:
        raise InputError(f"sublayers must be 2 mm thick at least, got {thickest * 1e3:g} mm; 20 mm is usual")
    layers: list[Layer] = []
    owner: list[int] = []
    top = 0.0
    for number, layer in enumerate(road.layers):
        if layer.thickness is None or not isinstance(layer.material, TemperatureDependent):
            layers.append(layer)
            owner.append(number)
            top += layer.thickness or 0.0
            continue
        sizes = part_sizes(top, layer.thickness, thickest)
        for part, size in enumerate(sizes):
            material = layer.material if ageing is None else Aged(layer.material, ageing, top + 0.5 * size)
            bond = layer.bond if part == len(sizes) - 1 else BONDED
            layers.append(replace(layer, material=material, thickness=size, bond=bond))
            top += size
        owner += [number] * len(sizes)
    if len(layers) > _MOST:
        raise InputError(
            f"the road would have {len(layers)} sublayers, at most {_MOST} are solved; take thicker ones"
        )
    return Pavement(layers, rigid_base=road.rigid_base), tuple(owner)


def middle_temperatures(road: Pavement, profile: TemperatureProfile) -> list[float]:
    """Temperature of a profile at the middle of each layer, °C; of the last, which has none, at its top.

    Beyond the profile its nearest temperature holds.
    """
    tops = np.concatenate([[0.0], road.interfaces])[: len(road.layers)]
    deep = [top + 0.5 * (layer.thickness or 0.0) for top, layer in zip(tops, road.layers, strict=True)]
    return [profile.temperature_at(depth, extrapolate=True) for depth in deep]


def part_sizes(
    top: float,
    thickness: float,
    thickest: float | None,
    *,
    thinnest: float = THINNEST,
    per_depth: float = PER_DEPTH,
) -> list[float]:
    """Thicknesses of the parts of a course below a depth, m.

    thickest: of equal parts; None for parts as thick as `thinnest` or `per_depth` times the depth of their top.
    """
    if thickest is not None:
        count = max(1, math.ceil(thickness / thickest - 1e-9))
        return [thickness / count] * count
    sizes: list[float] = []
    at, end = top, top + thickness
    while end - at > 1e-9:
        wide = max(thinnest, per_depth * at)
        # What is left over joins the last part, unless it is half of one.
        wide = end - at if end - at < 1.5 * wide else wide
        sizes.append(wide)
        at += wide
    return sizes
