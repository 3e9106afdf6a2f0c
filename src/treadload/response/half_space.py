"""Response of a road of one material: the closed forms of the half-space."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from treadload.kernels.anisotropy import interior
from treadload.kernels.anisotropy.interior import Modes
from treadload.kernels.arrays import Array
from treadload.kernels.gridding.points import Points
from treadload.kernels.gridding.precorrected import Keeper
from treadload.kernels.half_space.bilinear import bilinear_sums_on_grid
from treadload.kernels.half_space.disc import disc_fields
from treadload.kernels.half_space.interior import sums_on_grid
from treadload.kernels.half_space.upright import Medium
from treadload.materials.kinds import AnyElastic, Solid
from treadload.pavement.stack import medium_of, plane_of
from treadload.response.grain import modes_of, on_cells
from treadload.response.loads import SurfaceLoad, UniformDisc


@dataclass(frozen=True, eq=False)
class EvaluationGrid:
    """Points at which fields are evaluated.

    depths: (nz,), m, >= 0. x: (mx,), y: (my,), m, any coordinates. at: of their grid only these points. mean: weights
    (rows, nz) of sums over the depths, which are given in their place; not on materials with a horizontal grain.
    """

    depths: Array
    x: Array
    y: Array
    at: Points | None = None
    mean: Array | None = None

    @property
    def shape(self) -> tuple[int, int]:
        """Of a field at one depth."""
        return (len(self.y), len(self.x)) if self.at is None else self.at.shape

    @property
    def sums(self) -> Array:
        """Weights of the sums over the depths; of single depths the unit matrix."""
        return np.eye(len(self.depths)) if self.mean is None else self.mean


# Distances that differ by less than this part of a cell are the same.
_SAME = 1e-7


def half_space_response(
    loads: Sequence[SurfaceLoad],
    material: AnyElastic,
    where: EvaluationGrid,
    *,
    tell: Callable[[str], None] | None = None,
    moves: bool = True,
    kept: Keeper | None = None,
) -> tuple[Array, Array, Array, str]:
    """Stress, strain and displacement of a half-space under superposed loads.

    material: of the half-space. where: points, line by line or summed directly. tell: called with a line of text at
    every load of several. kept: see `half_space_fields`. moves: False leaves the displacement out, NaN.
    Returns stress, Pa, and strain, both (6, nz, my, mx), tension positive, tensor shear, in the order of
    `kernels.half_space.interior.COMPONENTS`; displacement (3, nz, my, mx), m, z down; and the method: "fft" where
    x and y lie on few lattices of the loads' spacing (that spacing, its fractions or multiples, a single row),
    "precorrected" elsewhere, "direct" for few points, "disc" for discs.
    Exact for loads uniform on each cell or bilinear between cells; near the surface the first leaves an error
    O(dx), see the kernels. On a material that is neither isotropic nor the same in all horizontal directions discs
    are laid on cells, and InputError is raised for loads that are bilinear.
    """
    medium: Medium | Modes
    if isinstance(material, Solid):
        medium, unit = medium_of(material), plane_of(material)[0]
    else:
        unit = material.upright[0]
        medium, loads = modes_of(material, unit), on_cells(loads)
    ((fields, method),) = half_space_fields([loads], medium, where, tell=tell, moves=moves, kept=kept)
    stress = np.moveaxis(fields[:, :6], 1, 0)
    displacement = np.moveaxis(fields[:, 6:], 1, 0) / unit if moves else np.full((3, *stress.shape[1:]), np.nan)
    return stress, material.strain(stress), displacement, method


def half_space_fields(
    loads: Sequence[Sequence[SurfaceLoad]],
    medium: Medium | Modes,
    where: EvaluationGrid,
    *,
    tell: Callable[[str], None] | None = None,
    moves: bool = True,
    precision: type[np.floating] = np.float64,
    kept: Keeper | None = None,
) -> list[tuple[Array, str]]:
    """Stress and displacement times the shear modulus, (nz, 9, my, mx), and the method, for each of some loads.

    loads: each superposed from several. medium: Poisson's ratio, or what stands in its place where the half-space is
    another along z; the shear modulus is then that of the horizontal plane. Or the modes of any other anisotropy, and
    the unit of its stiffness, for loads on cells alone. The others as in `half_space_response`;
    moves: False leaves the displacement out, (nz, 6, my, mx). precision: of convolutions and of what is returned.
    kept: what further calls under the same loads need again, see `kernels.gridding.precorrected`. What cells do to
    each other is computed once for all loads that stand on the same cells, and once for wheels behind each other that
    press alike.
    """
    results = [np.zeros((len(where.sums), 9 if moves else 6, *where.shape), precision) for _ in loads]
    methods: list[set[str]] = [set() for _ in loads]
    many = [load for several in loads for load in several]
    number = 0

    def count_solved(count: int) -> None:
        nonlocal number
        for _ in range(count):
            number += 1
            if tell is not None and len(many) > 1:
                tell(f"stress and strain under load {number} of {len(many)}")

    for several, result, used in zip(loads, results, methods, strict=True):
        for load in several:
            if isinstance(load, UniformDisc):
                assert not isinstance(medium, Modes)
                count_solved(1)
                _add_disc(result, load, medium, where)
                used.add("disc")
    for (print_, places), members in _prints(loads).items():
        count_solved(len(places) * len(members))
        array = np.stack([member for _, member in members], axis=1).astype(precision, copy=False)
        fields, method = _under_print(print_, places, array, medium, where, moves=moves, kept=kept)
        for column, (owner, _) in enumerate(members):
            results[owner] += fields[:, :, column]
            methods[owner].add(method)
    return [
        (result, "+".join(sorted(used - {"none"})) or "none") for result, used in zip(results, methods, strict=True)
    ]


_Print = tuple[int, int, float, float, float, Literal["constant", "bilinear"]]
"""Cells that a load stands on: nx, ny, dx, dy, y0 and how it varies between them."""


def _prints(
    loads: Sequence[Sequence[SurfaceLoad]],
) -> dict[tuple[_Print, tuple[float, ...]], list[tuple[int, Array]]]:
    """Numbers of loads and arrays (3, ny, nx) by the cells that they stand on and by places, x of the first cells."""
    prints: dict[tuple[_Print, tuple[float, ...]], list[tuple[int, Array]]] = {}
    for number, several in enumerate(loads):
        alike: list[tuple[_Print, Array, list[float]]] = []
        for load in several:
            if isinstance(load, UniformDisc):
                continue
            grid, array = load.grid, load.array
            key: _Print = (grid.nx, grid.ny, grid.dx, grid.dy, grid.y0, load.interpolation)
            places = next((at for shape, values, at in alike if shape == key and np.array_equal(values, array)), None)
            if places is None:
                alike.append((key, array, [grid.x0]))
            else:
                places.append(grid.x0)
        for key, array, places in alike:
            prints.setdefault((key, tuple(places)), []).append((number, array))
    return prints


def _under_print(
    cells: _Print,
    places: tuple[float, ...],
    array: Array,
    medium: Medium | Modes,
    where: EvaluationGrid,
    *,
    moves: bool,
    kept: Keeper | None,
) -> tuple[Array, str]:
    """Fields (rows, 9 or 6, n, my, mx) of arrays (3, n, ny, nx) on the same cells, summed over their places."""
    _, _, dx, dy, y0, interpolation = cells
    depths, mean = where.depths, where.sums
    methods: set[str] = set()

    def on_grid(x: Array, y: Array) -> tuple[Array, str]:
        if isinstance(medium, Modes):
            stress, displacement, method = interior.fields_on_grid(
                array, dx, dy, depths, 1.0, medium, x, y, moves=moves
            )
            return np.concatenate([stress, displacement] if moves else [stress], axis=1), method
        closed = bilinear_sums_on_grid if interpolation == "bilinear" else sums_on_grid
        return closed(array, dx, dy, depths, mean, medium, x, y, moves=moves, kept=kept)

    def fields(x: Array, y: Array) -> Array:
        apart = (x - np.array(places)[:, None]).ravel()
        _, first, back = np.unique(np.round(apart / (_SAME * dx)), return_index=True, return_inverse=True)
        both, method = on_grid(apart[first], y - y0)
        methods.add(method)
        turns = back.reshape(len(places), -1)
        if len(turns) == 1 and np.array_equal(turns[0], np.arange(len(first))):
            return both
        total: Array = both[..., turns[0]]
        for offset in turns[1:]:
            total += both[..., offset]
        return total

    x, y, at = where.x, where.y, where.at
    solved = fields(x, y) if at is None else at.gathered(fields, x, y)
    return solved, "+".join(sorted(methods - {"none"})) or "none"


def _add_disc(
    result: Array,
    disc: UniformDisc,
    medium: Medium,
    where: EvaluationGrid,
) -> None:
    x, y, at, mean = where.x, where.y, where.at, where.sums
    lines = np.meshgrid(x, y) if at is None else (x[None, at.columns], y[None, at.rows])
    across_x, across_y = lines[0] - disc.x, lines[1] - disc.y
    for row, depth in enumerate(where.depths):
        stress, displacement = disc_fields(disc.radius, across_x, across_y, float(depth), 1.0, medium)
        both = np.concatenate([stress, displacement])[: result.shape[1]]
        for place in np.flatnonzero(mean[:, row]):
            result[place] += (mean[place, row] * disc.pressure) * both
