"""Inputs of a response that no road and no vehicle has: sentences for its warnings."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from treadload.kernels.arrays import Array
from treadload.materials import ElastoPlastic
from treadload.materials.kinds import limit_of, upright
from treadload.pavement import Pavement
from treadload.plausible import caveat
from treadload.response.loads import GridLoad, PlacedLoad, UniformDisc

# Layers less stiff than this are soil or unbound, Pa.
_SOFT = 1e9


def road_caveats(road: Pavement) -> tuple[str, ...]:
    """Sentences on the layers of a road at its temperature."""
    warnings: tuple[str, ...] = ()
    for number, layer in enumerate(road.at_nominal_stress.layers):
        material = layer.resolved
        modulus, poisson = upright(limit_of(material, "glassy"))
        place = f"layer {number + 1}" + (f" ({layer.name})" if layer.name else "")
        if isinstance(layer.material, ElastoPlastic):
            warnings += (
                f"{place} can yield, and this is the response of its elastic part; roll_passes follows the rest",
            )
        warnings += caveat("modulus of the layer", modulus, place) + caveat("Poisson's ratio", poisson, place)
        if layer.thickness is not None:
            kind = _position(number, len(road.layers), modulus)
            warnings += caveat(kind, layer.thickness, "" if number == 0 else place)
        bond = layer.bond.sticking
        if len(bond.limits) == 1 and 0 < bond.stiffness < math.inf:
            warnings += caveat("stiffness of the bond", bond.stiffness, f"the bond below {place}")
    return warnings


def _position(number: int, count: int, modulus: float) -> str:
    """The row of the table with the usual thicknesses of a layer."""
    if count > 1 and number == 0:
        return "thickness of the surface course"
    if number == count - 1:
        return "thickness of the soil"
    return "thickness of the unbound layer" if modulus < _SOFT else "thickness of the layer"


def question_caveats(depths: Array, speed: float | None) -> tuple[str, ...]:
    """Sentences on the depths, m, and the speed, m/s."""
    return caveat("depth", float(depths.max())) + (() if speed is None else caveat("speed", speed))


def overlapping(loads: Sequence[PlacedLoad]) -> tuple[str, ...]:
    """A sentence where footprints of wheels overlap, which those of tires cannot.

    Loads with one centre are parts of one wheel, and pass.
    """
    pressed = [(number, _box(load)) for number, load in enumerate(loads, start=1)]
    pressing = [(number, box) for number, box in pressed if box is not None]
    if len(pressing) < 2:
        return ()
    numbers, boxes = [number for number, _ in pressing], np.array([box for _, box in pressing])
    low, high, cell = boxes[:, 0:2], boxes[:, 2:4], boxes[:, 4]
    middle = 0.5 * (low + high)
    for k in range(len(boxes) - 1):
        later = slice(k + 1, None)
        shared = np.minimum(high[later], high[k]) - np.maximum(low[later], low[k])
        apart = np.abs(middle[later] - middle[k]).max(axis=1)
        step = np.maximum(cell[later], cell[k])
        # One cell either way is the rounding onto the lattice.
        bad = np.flatnonzero((shared > 1.5 * step[:, None]).all(axis=1) & (apart > step))
        if bad.size:
            j = k + 1 + int(bad[0])
            length, width = (shared[bad[0]] * 1e3).tolist()
            dx, dy = (np.abs(middle[j] - middle[k]) * 1e3).tolist()
            return (
                f"the footprints of wheels {numbers[k]} and {numbers[j]} overlap by {length:.0f} mm "
                f"along travel and {width:.0f} mm across: their centres are {dx:.0f} and {dy:.0f} mm apart, and two "
                "tires cannot occupy the same place; set them further apart (a number without a unit is in m)",
            )
    return ()


def _box(load: PlacedLoad) -> tuple[float, ...] | None:
    """Lowest x and y, highest x and y of what is pressed, and the size of a cell, m."""
    if isinstance(load, GridLoad):
        pressed, grid = load.array[0] > 0, load.grid
        if not pressed.any():
            return None
        x, y = grid.x[pressed.any(axis=0)], grid.y[pressed.any(axis=1)]
        half_x, half_y = grid.dx / 2, grid.dy / 2
        return x[0] - half_x, y[0] - half_y, x[-1] + half_x, y[-1] + half_y, max(grid.dx, grid.dy)
    if load.pressure <= 0:
        return None
    if isinstance(load, UniformDisc):
        # Two discs beside each other meet where their squares do, along x or y as wheels stand.
        return load.x - load.radius, load.y - load.radius, load.x + load.radius, load.y + load.radius, 1e-6
    return (
        load.x - load.length / 2, load.y - load.width / 2, load.x + load.length / 2, load.y + load.width / 2, 1e-6
    )  # fmt: skip
