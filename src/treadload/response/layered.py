"""Response of layers: the half-space of the top layer in closed form, and what the layers change by wavenumbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.kernels.gridding.gridded import grid_cost
from treadload.kernels.gridding.points import Points
from treadload.kernels.layers.hankel import AxialPlanes, Disc, synthesise_discs
from treadload.kernels.layers.layered import Stack, transfer
from treadload.kernels.layers.synthesis import Cells, ElasticPlane, rule, synthesise_cells
from treadload.kernels.tensors import strain_from_stress
from treadload.materials import Elastic
from treadload.pavement import Pavement
from treadload.pavement.stack import stack_of
from treadload.response.half_space import half_space_response
from treadload.response.loads import GridLoad, SurfaceLoad, UniformDisc

# Waves are cut where they have fallen to e^-33; with powers of k h before them 1e-10 of the strain is left,
# counted in soft soil below a stiff layer. At e^-27 it is 3e-7, at e^-36 4e-12, measured.
_FALL = 33.0
# Nearer to the first interface than this part of its depth the split gains nothing and costs the closed form.
_SPLIT = 0.9
# A wavenumber costs so many pairs of a point and a corner in the closed form, measured.
_WAVE_COST = 1.4
# A net shear force below this part of the shear in all is round-off.
_NET = 1e-9
# Wavenumbers that one response may take: about a minute.
_MOST = 6e7
# The same under discs, where one direction serves.
_MOST_ALONG = 1e6


def layered_response(
    loads: Sequence[SurfaceLoad],
    road: Pavement,
    depths: Array,
    x: Array,
    y: Array,
    *,
    below: bool,
    at: Points | None = None,
) -> tuple[Array, Array, Array, str]:
    """Stress, strain and displacement of a layered road under superposed loads.

    depths: (nz,), m, >= 0. x: (mx,), y: (my,), m, any coordinates. below: whether a depth on an interface takes
    the layer below it. at: of the grid of x and y only these points.
    Returns stress (6, nz, my, mx) in Pa, strain likewise, displacement (3, nz, my, mx) in m, z down; and the
    method. Near the surface the closed form of a half-space of the top layer carries the steps of the load; what
    the layers add falls off like exp(-k (2 h - z)). Deeper the waves fall off like exp(-k z) themselves.
    Displacement along a net shear force is NaN in the layers above a frictionless interface: nothing holds them.
    Raises InputError where that decay is too slow for the distance of the points.
    """
    materials = [layer.elastic for layer in road.distinct_layers]
    stack = stack_of(road)
    depths = stack.snapped(depths)
    where = [stack.layer_at(float(z), below) for z in depths]
    length = max(float(stack.interfaces[-1]) * (max(stack.shear) / min(stack.shear)) ** (1 / 3), float(depths.max()))
    near = [layer == 0 and z < _SPLIT * stack.interfaces[0] for z, layer in zip(depths, where, strict=True)]
    layout = _Layout(stack, depths, where, below, near)
    fields = np.zeros((len(depths), 9, *((len(y), len(x)) if at is None else at.shape)))
    methods = {"layered"}
    discs = [load for load in loads if isinstance(load, UniformDisc)]
    gridded = [load for load in loads if isinstance(load, GridLoad)]
    if discs:
        fields += _under_discs(discs, layout, x, y, length, at)
        methods.add(_add_top(fields, discs, layout, materials[0], x, y, at))
    if gridded:
        layout = replace(layout, split=_worth_splitting(gridded, layout, x, y, length, at))
        fields += _under_cells(gridded, layout, x, y, length, at)
        methods.add(_add_top(fields, gridded, layout, materials[0], x, y, at))
    stress, displacement = np.moveaxis(fields[:, :6], 1, 0).copy(), np.moveaxis(fields[:, 6:], 1, 0).copy()
    method = "+".join(sorted(methods - {"none"}, key=lambda name: (name != "layered", name)))
    for component, drifts in enumerate(drifting(stack, loads)):
        if drifts:
            # A sheet that nothing holds: the displacement under a net force has no finite value.
            displacement[component, [row for row, layer in enumerate(where) if layer <= stack.spring.index(0.0)]] = (
                np.nan
            )
    strain = np.empty_like(stress)
    for row, layer in enumerate(where):
        material = materials[layer]
        strain[:, row] = strain_from_stress(stress[:, row], material.modulus, material.poisson)
    return stress, strain, displacement, method


def drifting(stack: Stack, loads: Sequence[SurfaceLoad]) -> tuple[bool, bool]:
    """Whether a net shear force along x and along y meets a frictionless interface."""
    if 0.0 not in stack.spring:
        return False, False
    shear = [load.array[1:] * load.grid.cell_area for load in loads if isinstance(load, GridLoad)]
    net = sum((part.sum(axis=(1, 2)) for part in shear), np.zeros(2))
    size = sum(float(np.abs(part).sum()) for part in shear)
    return bool(abs(net[0]) > _NET * size), bool(abs(net[1]) > _NET * size)


@dataclass(frozen=True)
class _Layout:
    """Depths in a stack: the layer of each, its side of an interface, whether the top's half-space is split off."""

    stack: Stack
    depths: Array
    where: list[int]
    below: bool
    split: list[bool]

    @property
    def limit(self) -> Array:
        """Largest wavenumber that matters at each depth, 1/m."""
        top = float(self.stack.interfaces[0])
        return np.array(
            [_FALL / (2 * top - z if near else z) for z, near in zip(self.depths, self.split, strict=True)]
        )

    @property
    def rows(self) -> list[int]:
        """Depths at which the half-space is split off."""
        return [row for row, near in enumerate(self.split) if near]

    def kernels(self, k: Array) -> tuple[Array, Array]:
        """What unit loads do, (nz, 4, 2, nk) and (nz, 2, nk), without the half-space where it is split off."""
        result = transfer(k, self.stack, list(self.depths), [self.below] * len(self.depths))
        rows = self.rows
        if rows:
            top = Stack([self.stack.shear[0]], [self.stack.poisson[0]], [], [])
            alone = transfer(k, top, list(self.depths[rows]), [False] * len(rows))
            result.plane[rows] -= alone.plane
            result.transverse[rows] -= alone.transverse
        return result.plane, result.transverse


def _add_top(
    fields: Array,
    loads: Sequence[SurfaceLoad],
    layout: _Layout,
    material: Elastic,
    x: Array,
    y: Array,
    at: Points | None,
) -> str:
    """Add the top layer's half-space where it was split off; the method that gave it."""
    if not layout.rows:
        return "none"
    stress, _, displacement, method = half_space_response(loads, material, layout.depths[layout.rows], x, y, at)
    fields[layout.rows, :6] += np.moveaxis(stress, 1, 0)
    fields[layout.rows, 6:] += np.moveaxis(displacement, 1, 0)
    return method


def _worth_splitting(
    loads: Sequence[GridLoad], layout: _Layout, x: Array, y: Array, length: float, at: Points | None
) -> list[bool]:
    """Where the half-space is split off: not at depths where the waves alone cost less than its closed form."""

    def cost(x: Array, y: Array) -> Array:
        costs: Array = np.sum(
            [
                grid_cost(one.array, grid.dx, grid.dy, layout.depths, x - grid.x0, y - grid.y0)
                for one in loads
                for grid in [one.grid]
            ],
            axis=0,
        )
        return costs

    closed = cost(x, y) if at is None else at.total(cost, x, y)

    def worth(row: int) -> bool:
        z = float(layout.depths[row])
        if not layout.split[row] or z == 0:
            return layout.split[row]
        along, across = _rules(loads, _FALL / z, x, y, length)
        return bool(closed[row] < _WAVE_COST * len(along[0]) * len(across[0]))

    return [worth(row) for row in range(len(layout.depths))]


def _rules(
    loads: Sequence[GridLoad], limit: float, x: Array, y: Array, length: float
) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    """Nodes and weights in kx and ky up to a limit."""
    reach_x, reach_y = _reach([load.extent_x for load in loads], x), _reach([load.extent_y for load in loads], y)
    longest = max(length, reach_x, reach_y)
    return rule(limit, reach_x, longest), rule(limit, reach_y, longest)


def _under_discs(
    discs: Sequence[UniformDisc], layout: _Layout, x: Array, y: Array, length: float, at: Points | None
) -> Array:
    """Fields (nz, 9, my, mx) of discs by Hankel's integrals."""
    widest = max(max(np.abs(x - disc.x).max(), np.abs(y - disc.y).max()) + disc.radius for disc in discs)
    if layout.limit.max() * widest > _MOST_ALONG:
        raise InputError(_too_many(layout, float(widest), f"{layout.limit.max() * widest:.2g}", _MOST_ALONG))
    planes = AxialPlanes(
        lambda k: layout.kernels(k)[0][:, :, 1],
        np.array([layout.stack.shear[layer] for layer in layout.where]),
        np.array([layout.stack.poisson[layer] for layer in layout.where]),
        layout.limit,
        _FALL / float(layout.limit.max()),
    )
    return synthesise_discs([Disc(one.radius, one.pressure, one.x, one.y) for one in discs], planes, x, y, length, at)


def _under_cells(
    loads: Sequence[GridLoad], layout: _Layout, x: Array, y: Array, length: float, at: Points | None
) -> Array:
    """Fields (nz, 9, my, mx) of gridded loads by wavenumbers in both directions."""
    along, across = _rules(loads, float(layout.limit.max()), x, y, length)
    if len(along[0]) * len(across[0]) > _MOST:
        reach = max(_reach([load.extent_x for load in loads], x), _reach([load.extent_y for load in loads], y))
        raise InputError(_too_many(layout, reach, f"{len(along[0])} x {len(across[0])}", _MOST))
    cells = [
        Cells(one.array, grid.dx, grid.dy, grid.x0, grid.y0, 2 if one.interpolation == "bilinear" else 1)
        for one in loads
        for grid in [one.grid]
    ]
    planes = [_plane(layout, row) for row in range(len(layout.depths))]
    return synthesise_cells(cells, planes, x, y, along, across, at)


def _plane(layout: _Layout, row: int) -> ElasticPlane:
    one = slice(row, row + 1)
    alone = replace(layout, depths=layout.depths[one], where=layout.where[one], split=layout.split[one])

    def kernels(k: Array) -> tuple[Array, Array]:
        plane, transverse = alone.kernels(k)
        return plane[0], transverse[0]

    layer = layout.where[row]
    return ElasticPlane(kernels, layout.stack.shear[layer], layout.stack.poisson[layer], float(layout.limit[row]))


def _too_many(layout: _Layout, reach: float, needed: str, most: float) -> str:
    worst, top = float(layout.depths[int(np.argmax(layout.limit))]), float(layout.stack.interfaces[0])
    return (
        f"depth {worst:g} m under a top layer of {top:g} m with points up to {reach:g} m from "
        f"the load needs {needed} wavenumbers, more than {most:g}: leave out the "
        "depths around thin layers near the surface or compute fewer distant points at a time"
    )


def _reach(extents: Sequence[tuple[float, float]], points: Array) -> float:
    low, high = min(extent[0] for extent in extents), max(extent[1] for extent in extents)
    return float(max(points.max() - low, high - points.min()))
