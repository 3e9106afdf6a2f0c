"""What is read of stress and strain in stones and mortar: fields, percentiles, bonds, factors."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from treadload import variables
from treadload.deferred import xarray as xr
from treadload.kernels.arrays import Array, BoolArray, IntArray
from treadload.kernels.eigenstrain.operator import Grid
from treadload.kernels.tensors import largest_principal
from treadload.response.fields import tensor_fields
from treadload.response.heterogeneous.bonds import Faces, share_below

PERCENTILES = (50.0, 90.0, 95.0, 99.0, 100.0)
# The percentile of the bonds' pull that ravelling is read at.
_RAVELLING = 0.95
# Most of a side of the window that its border takes.
_BORDER = 0.25


@dataclass(frozen=True, eq=False)
class Fields:
    """Stress, Pa, and strain (6, nz, ny, nx) of a material in the window."""

    stress: Array
    strain: Array


@dataclass(frozen=True, eq=False)
class Packing:
    """Aggregates on the cells of a window.

    numbers: of stones by cells (nz, ny, nx), 0 for mortar. group: of each stone. places: centres x, y and depth, m,
    of the cells of the grid. radius: of the largest stone, m, 0 if unknown.
    """

    numbers: Any
    group: Any
    places: tuple[Array, Array, Array]
    grid: Grid
    radius: float


def readings(
    packing: Packing, with_stones: Fields, alone: Fields, bonds: Faces, strength: float | None, pressure: float
) -> xr.Dataset:
    """The dataset of a `Heterogeneous`.

    with_stones, alone: of the mortar with stones, and of the mortar alone. strength: of the bond, Pa. pressure: the
    load's largest, Pa.
    """
    numbers, group, grid, radius = packing.numbers, packing.group, packing.grid, packing.radius
    stress, strain = with_stones.stress, with_stones.strain
    x, y, z = packing.places
    inner = _inner(x, y, z, grid, radius)
    mortar, stone = inner & (numbers == 0), inner & (numbers > 0)
    volume = np.broadcast_to(grid.thickness[:, None, None], numbers.shape)
    tension, extension = largest_principal(stress), largest_principal(strain)
    tension_alone, extension_alone = largest_principal(alone.stress), largest_principal(alone.strain)

    def percentiles(values: Array, where: BoolArray) -> list[float]:
        return [share_below(values[where], volume[where], share / 100) for share in PERCENTILES]

    def mean(values: Array, where: BoolArray) -> float:
        return float(np.average(values[where], weights=volume[where])) if where.any() else float("nan")

    in_mortar = percentiles(extension, mortar)
    everywhere = mean(np.maximum(extension, 0.0), inner)
    upper = _upper(numbers, bonds, x, y, z, grid, radius, inner)
    pull = share_below(bonds.pull[upper], bonds.area[upper], _RAVELLING)
    phase = np.concatenate([[0], np.asarray(group) + 1])[numbers]
    dims, faces = ("depth", "y", "x"), ("face",)
    fields: dict[str, tuple[tuple[str, ...], Any]] = {
        **tensor_fields(stress, strain),
        "principal_stress_1": (dims, tension),
        "principal_strain_1": (dims, extension),
        "tension_without_stones": (dims, tension_alone),
        "extension_without_stones": (dims, extension_alone),
        "phase": (dims, phase),
        "stone": (dims, numbers),
        "mastic_tension": (("percentile",), percentiles(tension, mortar)),
        "mastic_extension": (("percentile",), in_mortar),
        "stone_tension": (("percentile",), percentiles(tension, stone)),
        "homogeneous_tension": (("percentile",), percentiles(tension_alone, inner)),
        "homogeneous_extension": (("percentile",), percentiles(extension_alone, inner)),
        "peak_over_mean": (
            ("percentile",),
            np.array(in_mortar) / everywhere if everywhere > 0 else np.full(5, np.nan),
        ),
        "mean_extension": ((), everywhere),
        "bond_normal": (faces, bonds.normal),
        "bond_shear": (faces, bonds.shear),
        "bond_pull": (faces, bonds.pull),
        "face_area": (faces, bonds.area),
        "face_stone": (faces, bonds.stone),
        "face_x": (faces, bonds.x),
        "face_y": (faces, bonds.y),
        "face_depth": (faces, bonds.depth),
        "bond_tension_high": ((), share_below(bonds.normal, bonds.area, _RAVELLING)),
        "bond_shear_high": ((), share_below(bonds.shear, bonds.area, _RAVELLING)),
        "ravelling_index": ((), pull / (strength if strength is not None else pressure or np.nan)),
        "stone_fraction": ((), float(volume[numbers > 0].sum() / volume.sum())),
        "stone_over_mastic": ((), mean(stress[2], stone) / mean(stress[2], mortar)),
    }
    coordinates = {"depth": z, "y": y, "x": x, "percentile": np.array(PERCENTILES)}
    over = {"bond_strength": strength} if strength is not None else {"largest_load_pressure": pressure}
    return variables.dataset(fields, coordinates, **over)


def _inner(x: Array, y: Array, z: Array, grid: Grid, radius: float) -> BoolArray:
    """Cells that are read: not those beside the sides and the bottom, beyond which there would be stones."""
    sides = [min(radius, _BORDER * len(at) * size) for at, size in ((x, grid.dx), (y, grid.dy))]
    along, across = (
        (at >= at[0] - 0.5 * size + side) & (at <= at[-1] + 0.5 * size - side)
        for at, size, side in ((x, grid.dx, sides[0]), (y, grid.dy, sides[1]))
    )
    above = z <= grid.edges[-1] - min(radius, _BORDER * (grid.edges[-1] - grid.edges[0]))
    inside: BoolArray = above[:, None, None] & across[:, None] & along
    return inside


def _upper(
    numbers: IntArray, bonds: Faces, x: Array, y: Array, z: Array, grid: Grid, radius: float, inner: BoolArray
) -> BoolArray:
    """Faces of stones that begin less than the largest radius below the surface, away from the window's sides."""
    shallow = z < max(radius, float(grid.thickness[0]))
    first = np.unique(numbers[shallow])
    places = [
        np.clip(np.searchsorted(at, values), 0, len(at) - 1)
        for at, values in ((z, bonds.depth), (y, bonds.y), (x, bonds.x))
    ]
    above_any: BoolArray = np.asarray(inner.any(axis=0))
    result: BoolArray = np.isin(bonds.stone, first) & above_any[places[1], places[2]]
    return result
