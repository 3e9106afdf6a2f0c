"""The basin that wheels bend into a road, beyond their footprints: how far it reaches, and what it extends there.

Ahead of, behind and beside the wheels the surface hogs. What it does there is bending: smooth over centimetres, with
nothing of the treads' edges in it, so that coarse cells, few points and few waves give it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from treadload.deferred import xarray as xr
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.kernels.layers.synthesis import BASIN
from treadload.materials import AtStress
from treadload.materials.kinds import limit_of, upright
from treadload.pavement import Layer, Pavement
from treadload.response.layered import View
from treadload.response.loads import GridLoad, SurfaceLoad
from treadload.response.material import windows
from treadload.response.several import Question, Side, answers, components_of, needed_fields
from treadload.response.superposition import merged

BEYOND = 0.080
"""The basin is read this far from the cells of a footprint, m: nearly three deviations of its blur."""

NEAR_SURFACE = 0.05
"""To this depth, m, fields follow the surface, whose largest strain may lie in the basin around the wheels."""

SHORTEST, LONGEST = 1.5, 10.0
"""How far around the wheels a basin is followed at least and at most, m."""

# Radii of relative stiffness that a basin reaches: the surface of a plate on a solid hogs most at 1.6 of them.
_RADII = 3.0
# Cells under which the basin is solved are this part of its blur.
_CELL = 0.45


def stiffness_radius(road: Pavement) -> float:
    """Radius of relative stiffness ℓ of the layers as one plate on the last of them as an elastic solid, m.

    ℓ³ = 2 D (1 - ν_s²) / E_s with D = Σ ∫ E/(1 - ν²) (z - z₀)² dz about the neutral axis z₀ of bonded layers (Hogg
    1938, Phil. Mag. 25, 576-582; Ioannides, Thompson and Barenberg 1985, TRR 1043). On a rigid base the last layer is
    that solid; of a stress-dependent soil, which is divided over depth, its uppermost part. 0 for a half-space.
    """
    layers = _on_one_soil(road)
    if len(layers) < 2:
        return 0.0
    elastic = [upright(limit_of(layer.resolved, "glassy")) for layer in layers]
    plate = np.array([modulus / (1 - poisson**2) for modulus, poisson in elastic[:-1]])
    edges = np.concatenate([[0.0], np.cumsum([layer.thickness for layer in layers[:-1]])])
    top, bottom = edges[:-1], edges[1:]
    neutral = float((plate * (bottom**2 - top**2)).sum() / (2 * (plate * (bottom - top)).sum()))
    bending = float((plate * ((bottom - neutral) ** 3 - (top - neutral) ** 3)).sum() / 3)
    modulus, poisson = elastic[-1]
    return float((2 * bending * (1 - poisson**2) / modulus) ** (1 / 3))


def _on_one_soil(road: Pavement) -> Sequence[Layer]:
    """The layers, without the parts of a stress-dependent soil below its uppermost one."""
    layers = list(road.layers)
    while len(layers) > 1:
        above, last = layers[-2].material, layers[-1].material
        if not (isinstance(above, AtStress) and isinstance(last, AtStress) and above.law == last.law):
            break
        del layers[-1]
    return layers


def basin_reach(roads: Iterable[Pavement]) -> float:
    """How far around the wheels the widest basin of some roads is followed, m, see `SHORTEST` and `LONGEST`."""
    return min(max([SHORTEST, *(_RADII * stiffness_radius(road) for road in roads)]), LONGEST)


def too_wide(road: Pavement) -> str:
    """A sentence on a road so stiff that its basin is wider than it is followed; empty if it is not."""
    radius = stiffness_radius(road)
    if _RADII * radius <= LONGEST:
        return ""
    return (
        f"the layers are so stiff over the last one that the wheels bend a basin of {_RADII * radius:.3g} m around "
        f"them (radius of relative stiffness {radius:.3g} m); it is followed to {LONGEST:g} m, and what lies further "
        "is not evaluated: check the moduli and thicknesses"
    )


def coarsened(loads: Sequence[GridLoad]) -> list[SurfaceLoad]:
    """The same loads on the cells that a basin needs, with their forces; fewer where they are close together."""
    return merged([_coarse(load) for load in loads])


def basin_tensors(
    questions: Sequence[Question],
    x: Array,
    y: Array,
    *,
    needs: Iterable[str],
    speed: float | None = None,
    side: Side = "above",
    mean_over: float | None = None,
) -> list[xr.Dataset] | None:
    """Stress and strain that are needed, over (depth, y, x), of basins under loads; arguments as `tensors_of_many`.

    loads of the questions: see `coarsened`. A mean over a cube is the value in its middle. Points lie `BEYOND` the
    loads, where fields are smooth; nearer ones are means over the blur.
    """
    components = components_of(needs)
    if components is None:
        return None
    wanted, centred = set(needs), []
    for question in questions:
        depths = question.depths
        if mean_over is not None:
            where = [question.road.layer_at(float(z), side) for z in depths]
            read = windows(depths, mean_over, question.road.interfaces, where)
            depths = 0.5 * (read.low + read.high)
        centred.append(replace(question, depths=depths))
    view = View(x, y, components=components, accuracy=BASIN)
    solved = answers(centred, view, side=side, speed=speed, mean_over=None)
    return needed_fields(questions, solved, x, y, wanted)


def _coarse(load: GridLoad) -> GridLoad:
    """The load on cells as many times as large as the blur allows, with its forces."""
    grid = load.grid
    by_x, by_y = (max(1, round(_CELL * BASIN.blur / step)) for step in (grid.dx, grid.dy))
    nx, ny = -(-grid.nx // by_x), -(-grid.ny // by_y)
    whole = np.zeros((3, ny * by_y, nx * by_x))
    whole[:, : grid.ny, : grid.nx] = load.array
    means = whole.reshape(3, ny, by_y, nx, by_x).mean(axis=(2, 4))
    at_x, at_y = (
        start + 0.5 * (by - 1) * step for start, by, step in ((grid.x0, by_x, grid.dx), (grid.y0, by_y, grid.dy))
    )
    return GridLoad(Grid(nx, ny, by_x * grid.dx, by_y * grid.dy, at_x, at_y), *means)
