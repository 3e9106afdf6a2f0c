"""The verb: a contact over a mortar with stones in it gives the stress in both."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal, TypedDict, Unpack, get_args

import numpy as np

from treadload import variables
from treadload.errors import ConvergenceError, InputError, positive
from treadload.kernels.arrays import Array, BoolArray, IntArray
from treadload.kernels.eigenstrain import operator
from treadload.kernels.eigenstrain.inclusions import equivalent
from treadload.kernels.eigenstrain.operator import Grid
from treadload.kernels.tensors import strain_from_stress
from treadload.materials import Aggregates, Elastic
from treadload.materials.aggregates import Spheres, Window, check_apart
from treadload.pavement import Pavement
from treadload.response.fields import COMPONENTS
from treadload.response.heterogeneous.bonds import faces
from treadload.response.heterogeneous.cell_error import BASIS, caveats, largest, soft_errors
from treadload.response.heterogeneous.cut import mixed, shares
from treadload.response.heterogeneous.readings import Fields, Packing, readings
from treadload.response.heterogeneous.solution import Heterogeneous
from treadload.response.loads import GridLoad, Load, PlacedLoad, gather
from treadload.response.solve import solve_response

Borders = Literal["steps", "shares"]

# A matrix near incompressibility has no eigenstrain that stands for another volume.
_STIFFEST_POISSON = 0.49
# Bytes of the operator beyond which it is kept in single precision, and the most that it may take.
_DOUBLE, _MOST = 128e6, 1.5e9
# Whole cells of a window, within this part of a cell.
_WHOLE = 1e-6
# Of the equations; products of the operator before they count as unsolved.
_TOLERANCE, _ITERATIONS = 1e-6, 600
# Cells of a radius below which the stress at a stone's border is that of its steps.
_RESOLVED = 4.0


class Sizes(TypedDict, total=False):
    """Of the block in which stones stand: length along x and width along y, its depth, and its cells, m."""

    window: tuple[float, float] | None
    depth: float | None
    spacing: float | None


def compute_heterogeneous(
    loads: Load | Sequence[Load],
    mortar: Elastic | Pavement,
    stones: Aggregates | Sequence[Aggregates],
    *,
    at: tuple[float, float] = (0.0, 0.0),
    bond_strength: float | None = None,
    borders: Borders = "steps",
    progress: Callable[[str], None] | None = None,
    **sizes: Unpack[Sizes],
) -> Heterogeneous:
    """Stress and strain in a window of road in which stones stand in a mortar.

    loads: a contact or other loads, see `solve_response`. mortar: what is between the stones, Elastic; or a road of
    layers whose top layer it is, for the stress that comes from the layers. stones: Aggregates, or several of other
    materials, voids among them. sizes: window=, depth= and spacing=. window: length along x and width along y, m.
    depth: of the window from the surface down, m. at: its middle, m, for instance below the edge of a rib. spacing:
    of the cells, m, a whole part of the window's sides. A scan brings window, depth and spacing with it.
    bond_strength: tension that the bond of mortar and stone withstands, Pa, for the ravelling index; left out, the
    load's largest pressure takes its place. borders: of spheres. "steps": a cell is of the stone that its centre is
    in, all of it. "shares": each stone has as many cells as its volume, and cells that the border of a stiff one
    cuts have the mean compliance of both parts: what stones bear and what they do to what is around them is then
    nearer to the truth, by a factor of ten with 8 cells a radius; in cut cells the stress is that of both. progress:
    called with a line of text while it computes.

    The stress of the mortar alone is that of `solve_response` at the cells' centres. Stones change it by equivalent
    eigenstrain in cells, below a free surface, see `kernels.eigenstrain.inclusions`. Limits: one Poisson's ratio and
    modulus around the stones, that of the mortar also outside of the window; the stones do not affect layers below;
    the contact does not either, which is right for a tire, a thousand times softer than the road; a stone's border is
    made of steps, so the peak in the cells beside it never converges: percentiles do. The error of the mean strain of
    soft stones and voids by these steps is `soft_strain_error`, a fit to finite elements, see
    `response.heterogeneous.cell_error`.
    Returns a Heterogeneous. Raises InputError for what cannot be, ConvergenceError where the equations stay unsolved.

    >>> load = tl.response.GridLoad.from_arrays([[0.8e6] * 4] * 4, spacing=5e-3)
    >>> stone = tl.materials.Aggregates.from_centres(0.0, 0.0, 5.5e-3, 4e-3, tl.Elastic(60e9, 0.2))
    >>> cells = {"window": (12e-3, 12e-3), "depth": 12e-3, "spacing": 2e-3}
    >>> result = tl.response.compute_heterogeneous(load, tl.Elastic(3e9, 0.35), stone, **cells)
    >>> f"the stone carries {result.dataset.stone_over_mastic.item():.1f} times the stress of the mortar"
    'the stone carries 1.6 times the stress of the mortar'
    """
    start = time.perf_counter()
    tell = progress or (lambda text: None)
    groups = _groups(stones)
    road, matrix = _road(mortar)
    block = _block(groups, **sizes)
    _check_layer(road, block.window.depth)
    for name, value in zip("xy", at, strict=True):
        if isinstance(value, bool | str) or not math.isfinite(value):
            raise InputError(f"the window's middle must be finite numbers of metres, got {name} = {value!r}")
    if bond_strength is not None:
        positive("bond_strength", bond_strength, "Pa", "bitumen on stone has near 1e6")
    if borders not in get_args(Borders):
        raise InputError(f'borders must be "steps" or "shares", got {borders!r}')
    placed = gather(loads)

    tell("placing the stones")
    numbers, group, spheres, warnings, holder, share = _stones(groups, block, borders == "shares")
    grid = block.grid
    x, y = at[0] + block.x, at[1] + block.y
    tell("stress of the mortar alone")
    response = solve_response(placed, road, depths=grid.depths, x=x, y=y, progress=progress)
    alone = np.stack([response.dataset[f"stress_{name}"].to_numpy() for name in COMPONENTS])

    tell("cells of eigenstrain")
    apply = operator.cells(grid, matrix.shear_modulus, matrix.poisson, averaged=True, single=grid.bytes > _DOUBLE)
    moduli = np.array([_moduli(group.material) for group in groups])[group]
    stiff = np.concatenate([[False], (moduli >= _moduli(matrix)).all(axis=1)])[holder]
    cut = stiff & (share < 1)
    inside = stiff | (numbers > 0)
    # Of a cell of a soft stone all is stone.
    of, part = np.where(stiff, holder, numbers)[inside] - 1, np.where(stiff, share, 1.0)[inside]
    stiffness = mixed(moduli[of, 0], _moduli(matrix)[0], part), mixed(moduli[of, 1], _moduli(matrix)[1], part)
    tell("stones")
    inclusion = equivalent(
        apply, alone, inside, stiffness, _moduli(matrix), grid.thickness, tolerance=_TOLERANCE, most=_ITERATIONS
    )
    if not inclusion.residual < 10 * _TOLERANCE:
        raise ConvergenceError(
            f"the stress around the stones reached a residual of {inclusion.residual:.2g} in {inclusion.iterations} "
            f"iterations of {inclusion.method}, not {_TOLERANCE:g}; lessen the contrast of stiff and soft stones in "
            "one window",
            inclusion.residual,
        )
    strain = strain_from_stress(inclusion.stress, matrix.modulus, matrix.poisson) + inclusion.eigenstrain
    if cut.any():
        # Parts behind one another bear one stress; a cell has the strain of the part that it stands for.
        cut_moduli = np.vstack([_moduli(matrix), moduli])[numbers[cut]]
        mean = inclusion.stress[:3, cut].sum(axis=0) / 3
        strain[:, cut] = inclusion.stress[:, cut] / cut_moduli[:, 1]
        strain[:3, cut] += mean / cut_moduli[:, 0] - mean / cut_moduli[:, 1]
    radii = np.concatenate([sphere.radius for sphere in spheres]) if spheres else np.empty(0)
    bonds = faces(numbers * _bonded(numbers, group, groups), inclusion.stress, x, y, grid.depths, grid.thickness)
    pressure = max((_largest_pressure(load) for load in placed), default=0.0)
    dataset = readings(
        Packing(numbers, group, (x, y, grid.depths), grid, float(radii.max(initial=0.0))),
        Fields(inclusion.stress, strain), Fields(alone, strain_from_stress(alone, matrix.modulus, matrix.poisson)),
        bonds, bond_strength, pressure,
    )  # fmt: skip
    contrasts = (moduli / _moduli(matrix)).min(axis=1)
    depths = np.concatenate([sphere.z for sphere in spheres]) if spheres else radii
    errors = soft_errors(numbers, radii, depths, contrasts, x, y, grid.depths)
    if errors.size:
        dataset = dataset.assign(variables.dataset({"soft_strain_error": ((), largest(errors))}, {}))
        dataset.attrs["error_estimate"] = BASIS
        warnings += caveats(errors, max(block.spacing))
    dataset.attrs |= {
        "mortar": str(matrix), "aggregates": "; ".join(map(str, groups)), "spacing": block.spacing[0],
        "window_x": float(at[0]), "window_y": float(at[1]),
    }  # fmt: skip
    if radii.size and radii.min() < _RESOLVED * max(block.spacing):
        warnings.append(
            f"the smallest stones have a radius of {radii.min() / max(block.spacing):.2g} cells, fewer than "
            f"{_RESOLVED:g}: they look larger than they are, by some 3 % of their effect with 10 cells and 5 % with "
            "5; a smaller spacing or counting them as mortar helps"
        )
    if radii.size and min(block.window.length, block.window.width) < 3 * 2 * radii.max():
        warnings.append(
            f"the window of {block.window} is less than three diameters of the largest stone wide, "
            f"{2e3 * radii.max():g} mm: what is read in it depends on where single stones lie; enlarge it, or take "
            "several seeds"
        )
    stats = {
        "seconds": time.perf_counter() - start, "iterations": inclusion.iterations, "residual": inclusion.residual,
        "method": inclusion.method, "cells": int(numbers.size), "bytes": apply.bytes,
    }  # fmt: skip
    return Heterogeneous(dataset, stats, (*warnings, *response.warnings), placed, road, tuple(groups), bond_strength)


@dataclass(frozen=True, eq=False)
class _Block:
    """The cells of a window. x, y: centres from its middle, m. spacing: (dx, dy, dz), m."""

    window: Window
    grid: Grid
    x: Array
    y: Array
    spacing: tuple[float, float, float]


def _groups(stones: object) -> list[Aggregates]:
    groups = [stones] if isinstance(stones, Aggregates) else list(stones) if isinstance(stones, Sequence) else []
    if not groups or not all(isinstance(group, Aggregates) for group in groups):
        raise InputError(
            f"stones must be Aggregates or a list of them, got {type(stones).__name__}; see its random()"
        )
    if any(group.scanned for group in groups) and len(groups) > 1:
        raise InputError("a scan of stones determines every cell: it cannot be put together with other stones")
    return groups


def _road(mortar: object) -> tuple[Pavement, Elastic]:
    """The road that the mortar's stress comes from, and the mortar."""
    road = mortar if isinstance(mortar, Pavement) else None
    material = road.layers[0].resolved if road is not None else mortar
    if not isinstance(material, Elastic):
        why = (
            "it relaxes, and stones take over the load as it does: give it as it is at the passage's frequency f, "
            "tl.Elastic(abs(mortar.complex_modulus(2 * np.pi * f)), mortar.poisson)"
            if hasattr(material, "complex_modulus")
            else "give tl.Elastic(modulus, poisson)"
        )
        raise InputError(f"the mortar between stones must be Elastic, got {type(material).__name__}; {why}")
    if road is not None and road.is_viscoelastic:
        raise InputError(
            "the road below the mortar is viscoelastic, and stones are computed at one instant: give the layers as "
            "they are at the passage's frequency, as tl.Elastic"
        )
    if material.poisson > _STIFFEST_POISSON:
        raise InputError(
            f"the mortar's Poisson's ratio is {material.poisson:g}, above {_STIFFEST_POISSON}: of a matrix that "
            "keeps its volume no eigenstrain changes it; take 0.49 or less, asphalt mortar is near 0.4"
        )
    return road if road is not None else Pavement.half_space(material, "mortar"), material


def mortar_road(road: Pavement, mortar: Elastic | None, depth: float) -> Pavement:
    """A road whose top layer is the mortar, its own material where that is None.

    depth: of the window, m. Raises InputError where the top layer is no mortar, or thinner than the window.
    """
    if mortar is not None:
        road = replace(road, layers=(replace(road.layers[0], material=mortar), *road.layers[1:]))
    _road(road)
    _check_layer(road, depth)
    return road


def _check_layer(road: Pavement, depth: float) -> None:
    top = float(road.interfaces[0]) if len(road.interfaces) else math.inf
    if depth > top * (1 + _WHOLE):
        raise InputError(
            f"the window is {depth * 1e3:g} mm deep and the mortar's layer {top * 1e3:g} mm: stones lie in "
            "the top layer alone; lessen the depth"
        )


def _block(
    groups: Sequence[Aggregates], *, window: object = None, depth: float | None = None, spacing: float | None = None
) -> _Block:
    scan = groups[0].scanned
    if scan is not None:
        if window is not None or depth is not None or spacing is not None:
            raise InputError("a scan of stones brings its window, depth and spacing with it; leave them out")
        (nz, ny, nx), (dx, dy, dz) = scan
        whole = Window(nx * dx, ny * dy, nz * dz)
    else:
        if window is None or depth is None or spacing is None:
            raise InputError(
                "stones need a window to lie in: give window=(length, width), depth and spacing, m, for instance "
                "window=(36e-3, 36e-3), depth=16e-3, spacing=1e-3"
            )
        if not isinstance(window, tuple | list) or len(window) != 2:
            raise InputError(f"window must be a length along x and a width along y, m, got {window!r}")
        for name, value in {"length": window[0], "width": window[1], "depth": depth}.items():
            positive(f"the {name} of the window", value, "metres", "36 mm is 0.036")
        positive("spacing", spacing, "metres", "1 mm is 0.001")
        whole = Window(float(window[0]), float(window[1]), float(depth))
        nx, ny, nz = (_count(name, side, spacing) for name, side in vars(whole).items())
        dx = dy = dz = float(spacing)
    size = 4 * (6 * nz) ** 2 * (nx + 1) * (ny + 1)
    if size > _MOST:
        raise InputError(
            f"{nx} x {ny} x {nz} cells need {size / 1e9:.3g} GB, more than {_MOST / 1e9:g}; memory goes with the "
            "square of the layers: take a shallower window or larger cells"
        )
    grid = Grid(nx, ny, dx, dy, dz * np.arange(nz + 1.0))
    x, y = (size * (np.arange(count) - 0.5 * (count - 1)) for size, count in ((dx, nx), (dy, ny)))
    return _Block(whole, grid, x, y, (dx, dy, dz))


def _count(name: str, side: float, spacing: float) -> int:
    cells = side / spacing
    if cells < 1 - _WHOLE or abs(cells - round(cells)) > _WHOLE * max(cells, 1.0):
        whole = max(1, round(cells))
        raise InputError(
            f"the window's {name} of {side * 1e3:g} mm is {cells:.4g} cells of {spacing * 1e3:g} mm; take a whole "
            f"number, {whole * spacing * 1e3:g} mm is {whole}"
        )
    return round(cells)


def _stones(
    groups: Sequence[Aggregates], block: _Block, shared: bool
) -> tuple[IntArray, IntArray, list[Spheres], list[str], IntArray, Array]:
    """Numbers (nz, ny, nx) of stones, from 1; the group of each; those that are spheres; warnings; of each cell the
    stone that has the largest share in it, and that share.
    """
    numbers = np.zeros(block.grid.shape, int)
    holder, share = numbers.copy(), np.zeros(numbers.shape)
    group: list[int] = []
    spheres: list[Spheres] = []
    for which, packing in enumerate(groups):
        balls = packing.spheres(block.window, spheres)
        if balls is not None and shared:
            of_cells, nearest, part = shares(balls, block.x, block.y, block.grid.depths)
        else:
            of_cells = packing.numbers(balls, block.x, block.y, block.grid.depths)
            nearest, part = of_cells, (of_cells > 0).astype(float)
        present = np.unique(of_cells[of_cells > 0])
        if balls is None:
            of_cells = nearest = np.searchsorted(present, of_cells) * (of_cells > 0) + (of_cells > 0)
        larger = part > share
        holder[larger], share[larger] = len(group) + nearest[larger], part[larger]
        numbers[of_cells > 0] = len(group) + of_cells[of_cells > 0]
        count = len(balls.x) if balls is not None else len(present)
        group += [which] * count
        if balls is not None:
            spheres.append(balls)
    if len(spheres) > 1:
        check_apart(*spheres)
    lost = len(group) - len(np.unique(numbers[numbers > 0]))
    if lost == len(group):
        raise InputError(
            f"none of the {len(group)} stones holds the centre of a cell of {block.spacing[0] * 1e3:g} mm; take a "
            "smaller spacing"
        )
    warnings = []
    if lost:
        warnings.append(
            f"{lost} of {len(group)} stones hold no cell's centre and are left out; take a smaller spacing, or count "
            "them as mortar"
        )
    return numbers, np.array(group, int), spheres, warnings, holder, share


def _moduli(material: Elastic | None) -> tuple[float, float]:
    """3 k and 2 G, Pa; of a void none."""
    if material is None:
        return 0.0, 0.0
    squeeze = 1 - 2 * material.poisson
    return (material.modulus / squeeze if squeeze > 0 else math.inf), 2 * material.shear_modulus


def _bonded(numbers: IntArray, group: IntArray, groups: Sequence[Aggregates]) -> BoolArray:
    """Where a cell is of a stone, and not of a void, which nothing is bonded to."""
    solid = np.array([False, *(groups[k].material is not None for k in group)])
    return solid[numbers]


def _largest_pressure(load: PlacedLoad) -> float:
    return float(load.pressure.max()) if isinstance(load, GridLoad) else float(load.pressure)
