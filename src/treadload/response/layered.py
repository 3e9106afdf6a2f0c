"""Response of layers: the half-space of the top layer in closed form, and what the layers change by wavenumbers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.kernels.gridding.gridded import grid_cost
from treadload.kernels.gridding.points import Points
from treadload.kernels.gridding.precorrected import Keeper
from treadload.kernels.layers.hankel import AxialPlanes, Disc, synthesise_discs
from treadload.kernels.layers.layered import Stack
from treadload.kernels.layers.load_spectra import Cells
from treadload.kernels.layers.synthesis import FULL, Accuracy, ElasticPlane, rule, synthesise_cells
from treadload.pavement import Pavement
from treadload.pavement.stack import medium_of, plane_of
from treadload.response.half_space import EvaluationGrid, half_space_fields
from treadload.response.layout import Layout, Site
from treadload.response.loads import GridLoad, SurfaceLoad, UniformDisc

# A wavenumber costs so many pairs of a point and a corner in the closed form, measured.
_WAVE_COST = 1.4
# A net shear force below this part of the shear in all is round-off.
_NET = 1e-9
# Wavenumbers that one response may take: about a minute.
_MOST = 6e7
# The same under discs, where one direction serves.
_MOST_ALONG = 1e6

# Components of the fields: xx, yy, zz, xy, xz, yz, then u_x, u_y, u_z.
ALL = tuple(range(9))
_YZ = 5


@dataclass(frozen=True, eq=False)
class View:
    """What is asked of fields, and where.

    x: (mx,), y: (my,), m, any coordinates. at: of the grid of x and y only these points. components: those needed of
    xx, yy, zz, xy, xz, yz and u_x, u_y, u_z. accuracy: of the waves. kept: of other views of the same loads, see
    `half_space_fields`.
    """

    x: Array
    y: Array
    at: Points | None = None
    components: Sequence[int] = ALL
    accuracy: Accuracy = FULL
    kept: Keeper | None = None

    @property
    def shape(self) -> tuple[int, int]:
        """Of a field."""
        return (len(self.y), len(self.x)) if self.at is None else self.at.shape


Solved = tuple[Array, Array, Array, str]
"""Stress (6, nz, my, mx) in Pa, strain likewise, displacement (3, nz, my, mx) in m, z down; and the method.

In the precision of what was asked; rows of sums in place of nz where these were asked.
"""


def layered_response(
    loads: Sequence[SurfaceLoad],
    road: Pavement,
    depths: Array,
    x: Array,
    y: Array,
    *,
    below: bool,
    at: Points | None = None,
) -> Solved:
    """Stress, strain and displacement of one layered road under superposed loads, see `layered_responses`."""
    return next(layered_responses([loads], [Site(road, depths)], [(0, 0)], View(x, y, at), below=below))


def layered_responses(
    loads: Sequence[Sequence[SurfaceLoad]],
    sites: Sequence[Site],
    pairs: Sequence[tuple[int, int]],
    view: View,
    *,
    below: bool,
) -> Iterator[Solved]:
    """Stress, strain and displacement of layered roads under loads, on the same points, one pair after the other.

    loads: each superposed from several. pairs: (n) of a load and a site, by number. view: components that it does not
    ask for are NaN, as is strain that follows from them. below: whether a depth on an interface takes the layer below
    it.
    Near the surface the closed form of a half-space of the top layer carries the steps of the load, once for each
    load and Poisson's ratio; what the layers add falls off like exp(-k (2 h - z)). Deeper the waves fall off like
    exp(-k z) themselves.
    Displacement along a net shear force is NaN in the layers above a frictionless interface: nothing holds them.
    Raises InputError where that decay is too slow for the distance of the points.
    """
    layouts = [Layout.of(site, below, view.accuracy) for site in sites]
    discs = [[load for load in several if isinstance(load, UniformDisc)] for several in loads]
    gridded = [[load for load in several if isinstance(load, GridLoad)] for several in loads]
    under_cells = [pair for pair in pairs if gridded[pair[0]]]
    costs = _Closed(gridded, view)
    split = [_split(layout, gridded, number, under_cells, view, costs) for number, layout in enumerate(layouts)]
    waves = iter(_under_cells(gridded, split, under_cells, view) if under_cells else [])
    tops = _Top(discs, view), _Top(gridded, view)
    # One after the other: what is made of the waves is larger than they are.
    for load, site in pairs:
        # (components, rows, my, mx)
        fields = np.zeros((len(view.components), len(layouts[site].mean), *view.shape), view.accuracy.precision)
        methods = {"layered"}
        if gridded[load]:
            fields = next(waves)
            methods.add(tops[1].add(fields, load, split[site]))
        if discs[load]:
            fields += np.einsum("rz,zcyx->cryx", layouts[site].mean, _under_discs(discs[load], layouts[site], view))
            methods.add(tops[0].add(fields, load, layouts[site]))
        yield _solved(fields, layouts[site], loads[load], methods, view.components)


def _solved(
    fields: Array, layout: Layout, loads: Sequence[SurfaceLoad], methods: set[str], components: Sequence[int]
) -> Solved:
    """Stress, strain and displacement of one pair from its fields (components, rows, my, mx)."""
    stack, shape = layout.stack, fields.shape[1:]
    wanted = list(components)
    if wanted[:6] == list(range(6)):
        stress = fields[:6]
    else:
        stress = np.full((6, *shape), np.nan, fields.dtype)
        stress[[component for component in wanted if component <= _YZ]] = fields[
            [k for k, component in enumerate(wanted) if component <= _YZ]
        ]
    displacement = np.broadcast_to(np.array(np.nan, fields.dtype), (3, *shape))
    if max(wanted) > _YZ:
        displacement = displacement.copy()
        displacement[[component - 6 for component in wanted if component > _YZ]] = fields[
            [k for k, component in enumerate(wanted) if component > _YZ]
        ]
        for component, drifts in enumerate(drifting(stack, loads)):
            if drifts:
                # A sheet that nothing holds: the displacement under a net force has no finite value.
                loose = [row for row, layer in enumerate(layout.rows_in) if layer <= stack.spring.index(0.0)]
                displacement[component, loose] = np.nan
    strain = np.empty_like(stress)
    for row, layer in enumerate(layout.rows_in):
        strain[:, row] = layout.materials[layer].strain(stress[:, row])
    method = "+".join(sorted(methods - {"none"}, key=lambda name: (name != "layered", name)))
    return stress, strain, displacement, method


def drifting(stack: Stack, loads: Sequence[SurfaceLoad]) -> tuple[bool, bool]:
    """Whether a net shear force along x and along y meets a frictionless interface."""
    if 0.0 not in stack.spring:
        return False, False
    shear = [load.array[1:] * load.grid.cell_area for load in loads if isinstance(load, GridLoad)]
    net = sum((part.sum(axis=(1, 2)) for part in shear), np.zeros(2))
    size = sum(float(np.abs(part).sum()) for part in shear)
    return bool(abs(net[0]) > _NET * size), bool(abs(net[1]) > _NET * size)


@dataclass(frozen=True, eq=False)
class _Top:
    """The half-space of the top layer in a view, under loads that are seen together.

    known: its fields (rows, 9 or 6, my, mx) under each of the loads, with displacement times the shear modulus, and
    the method that gave them; by the medium, Poisson's ratio in isotropy, depths and their weights, all that they
    depend on.
    """

    loads: Sequence[Sequence[SurfaceLoad]]
    view: View
    solved: dict[tuple[Any, ...], list[tuple[Array, str]]] = field(default_factory=dict)

    def add(self, fields: Array, load: int, layout: Layout) -> str:
        """Add that of a load to fields (components, rows, my, mx) where it was split off; the method."""
        if not layout.rows:
            return "none"
        material, depths, view = layout.materials[0], layout.depths[layout.rows], self.view
        medium, mean = medium_of(material), layout.mean[:, layout.rows]
        rows = np.flatnonzero(mean.any(axis=1))
        key = (medium, *depths, mean.tobytes())
        if key not in self.solved:
            self.solved[key] = half_space_fields(
                self.loads,
                medium,
                EvaluationGrid(depths, view.x, view.y, view.at, mean[rows]),
                moves=max(view.components) > _YZ,
                precision=view.accuracy.precision,
                kept=view.kept,
            )
        top, method = self.solved[key][load]
        for place, component in enumerate(view.components):
            part = top[:, component] if component <= _YZ else top[:, component] / plane_of(material)[0]
            for row, sheet in zip(rows, part, strict=True):
                fields[place, row] += sheet
        return method


def _split(
    layout: Layout,
    loads: Sequence[Sequence[GridLoad]],
    number: int,
    pairs: Sequence[tuple[int, int]],
    view: View,
    costs: _Closed,
) -> Layout:
    """The layout with the half-space split off where that is cheaper under the first of its loads."""
    first = next((load for load, site in pairs if site == number), None)
    if first is None:
        return layout
    return replace(layout, split=_worth_splitting(loads[first], layout, view, costs.of(first, layout.depths)))


@dataclass(frozen=True, eq=False)
class _Closed:
    """What the closed form costs under loads in a view: that of each load at each depth is counted once."""

    loads: Sequence[Sequence[GridLoad]]
    view: View
    solved: dict[tuple[int, tuple[float, ...]], Array] = field(default_factory=dict)

    def of(self, load: int, depths: Array) -> Array:
        """Of one of the loads, by number, at depths (nz,), as `grid_cost` counts."""
        key = (load, tuple(map(float, depths)))
        if key not in self.solved:

            def cost(x: Array, y: Array) -> Array:
                several = [(grid_load, grid_load.grid) for grid_load in self.loads[load]]
                parts = [
                    grid_cost(grid_load.array, at.dx, at.dy, depths, x - at.x0, y - at.y0)
                    for grid_load, at in several
                ]
                costs: Array = np.sum(parts, axis=0)
                return costs

            x, y, at = self.view.x, self.view.y, self.view.at
            self.solved[key] = cost(x, y) if at is None else at.total(cost, x, y)
        return self.solved[key]


def _worth_splitting(loads: Sequence[GridLoad], layout: Layout, view: View, closed: Array) -> list[bool]:
    """Where the half-space is split off: not at depths where the waves alone cost less than its closed form.

    closed: of the closed form at each depth.
    """

    def worth(row: int) -> bool:
        z = float(layout.depths[row])
        if not layout.split[row] or z == 0:
            return layout.split[row]
        along, across = _rules(loads, layout.fall / layout.stack.faded(z), view, layout.length)
        return bool(closed[row] < _WAVE_COST * len(along[0]) * len(across[0]))

    return [worth(row) for row in range(len(layout.depths))]


def _rules(
    loads: Sequence[GridLoad], limit: float, view: View, length: float
) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    """Nodes and weights in kx and ky up to a limit."""
    reach_x, reach_y = (
        _reach([load.extent_x for load in loads], view.x),
        _reach([load.extent_y for load in loads], view.y),
    )
    longest = max(length, reach_x, reach_y)
    return (
        view.accuracy.blurred(*rule(limit, reach_x, longest, view.accuracy)),
        view.accuracy.blurred(*rule(limit, reach_y, longest, view.accuracy)),
    )


def _under_discs(discs: Sequence[UniformDisc], layout: Layout, view: View) -> Array:
    """Fields (nz, components, my, mx) of discs by Hankel's integrals."""
    widest = max(max(np.abs(view.x - disc.x).max(), np.abs(view.y - disc.y).max()) + disc.radius for disc in discs)
    if layout.limit.max() * widest > _MOST_ALONG:
        raise InputError(_too_many(layout, float(widest), f"{layout.limit.max() * widest:.2g}", _MOST_ALONG))
    planes = AxialPlanes(
        lambda k: layout.kernels(k)[0][:, :, 1],
        np.array([layout.stack.shear[layer] for layer in layout.where]),
        np.array([layout.stack.poisson[layer] for layer in layout.where]),
        layout.limit,
        layout.fall / float(layout.limit.max()),
        np.array([layout.stack.lift_of(layer) for layer in layout.where]) if layout.stack.upright else None,
    )
    places = [Disc(disc.radius, disc.pressure, disc.x, disc.y) for disc in discs]
    return synthesise_discs(places, planes, view.x, view.y, layout.length, view.at)[:, list(view.components)]


def _under_cells(
    loads: Sequence[Sequence[GridLoad]], layouts: Sequence[Layout], pairs: Sequence[tuple[int, int]], view: View
) -> list[Array]:
    """Fields (components, rows, my, mx) of pairs of a gridded load and a layout, by wavenumbers both ways."""
    used = [layouts[site] for site in sorted({site for _, site in pairs})]
    every = [grid_load for number in sorted({load for load, _ in pairs}) for grid_load in loads[number]]
    steepest = max(used, key=lambda layout: float(layout.limit.max()))
    along, across = _rules(every, float(steepest.limit.max()), view, max(layout.length for layout in used))
    if len(along[0]) * len(across[0]) > _MOST:
        reach = max(
            _reach([load.extent_x for load in every], view.x), _reach([load.extent_y for load in every], view.y)
        )
        raise InputError(_too_many(steepest, reach, f"{len(along[0])} x {len(across[0])}", _MOST))
    planes: list[ElasticPlane] = []
    tasks: list[tuple[int, int]] = []
    for load, site in pairs:
        for row in range(len(layouts[site].mean)):
            plane = layouts[site].plane(row)
            if plane not in planes:
                planes.append(plane)
            tasks.append((load, planes.index(plane)))
    cells = [_cells(several) for several in loads]
    fields = synthesise_cells(
        cells, planes, tasks, view.x, view.y, along, across, view.at, view.components, view.accuracy.precision
    )
    ends = np.cumsum([len(layouts[site].mean) for _, site in pairs])[:-1]
    return np.split(fields.swapaxes(0, 1), ends, axis=1)


def _cells(loads: Sequence[GridLoad]) -> list[Cells]:
    return [
        Cells(load.array, grid.dx, grid.dy, grid.x0, grid.y0, 2 if load.interpolation == "bilinear" else 1)
        for load in loads
        for grid in [load.grid]
    ]


def _too_many(layout: Layout, reach: float, needed: str, most: float) -> str:
    worst, top = float(layout.depths[int(np.argmax(layout.limit))]), float(layout.stack.interfaces[0])
    return (
        f"depth {worst:g} m under a top layer of {top:g} m with points up to {reach:g} m from "
        f"the load needs {needed} wavenumbers, more than {most:g}: leave out the "
        "depths around thin layers near the surface or compute fewer distant points at a time"
    )


def _reach(extents: Sequence[tuple[float, float]], points: Array) -> float:
    low, high = min(extent[0] for extent in extents), max(extent[1] for extent in extents)
    return float(max(points.max() - low, high - points.min()))
