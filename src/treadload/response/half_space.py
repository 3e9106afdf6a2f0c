"""Response of a road of one material: the closed forms of the half-space."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from treadload.kernels.arrays import Array
from treadload.kernels.gridding.points import Points
from treadload.kernels.half_space.bilinear import bilinear_on_grid
from treadload.kernels.half_space.disc import disc_fields
from treadload.kernels.half_space.interior import fields_on_grid
from treadload.kernels.tensors import strain_from_stress
from treadload.materials import Elastic
from treadload.response.loads import SurfaceLoad, UniformDisc

_OnGrid = Callable[..., tuple[Array, Array, str]]


def half_space_response(
    loads: Sequence[SurfaceLoad],
    material: Elastic,
    depths: Array,
    x: Array,
    y: Array,
    at: Points | None = None,
    tell: Callable[[str], None] | None = None,
    *,
    moves: bool = True,
) -> tuple[Array, Array, Array, str]:
    """Stress, strain and displacement of a half-space under superposed loads.

    material: of the half-space. depths: (nz,), m, >= 0. x: (mx,), y: (my,), m, any coordinates.
    at: of the grid of x and y only these points, line by line or summed directly. tell: called with a line of text
    at every load of several. moves: False leaves the displacement out, NaN.
    Returns stress, Pa, and strain, both (6, nz, my, mx), tension positive, tensor shear, in the order of
    `kernels.half_space.interior.COMPONENTS`; displacement (3, nz, my, mx), m, z down; and the method: "fft" where
    x and y lie on few lattices of the loads' spacing (that spacing, its fractions or multiples, a single row),
    "precorrected" elsewhere, "direct" for few points, "disc" for discs.
    Exact for loads uniform on each cell or bilinear between cells; near the surface the first leaves an error
    O(dx), see the kernels.
    """
    shape = (len(y), len(x)) if at is None else at.shape
    stress, displacement = np.zeros((6, len(depths), *shape)), np.zeros((3, len(depths), *shape))
    methods: set[str] = set()
    shear, poisson = material.shear_modulus, material.poisson
    for number, load in enumerate(loads, start=1):
        if tell is not None and len(loads) > 1:
            tell(f"stress and strain under load {number} of {len(loads)}")
        if isinstance(load, UniformDisc):
            lines = np.meshgrid(x, y) if at is None else (x[None, at.columns], y[None, at.rows])
            across_x, across_y = lines[0] - load.x, lines[1] - load.y
            for row, depth in enumerate(depths):
                unit = disc_fields(load.radius, across_x, across_y, float(depth), shear, poisson)
                stress[:, row] += load.pressure * unit[0]
                displacement[:, row] += load.pressure * unit[1]
            methods.add("disc")
            continue
        grid = load.grid
        on_grid = bilinear_on_grid if load.interpolation == "bilinear" else fields_on_grid
        place = load.array, grid.dx, grid.dy, depths, shear, poisson

        def fields(x: Array, y: Array, on_grid: _OnGrid = on_grid, place: tuple[Any, ...] = place) -> Array:
            *parts, method = on_grid(*place, x, y, moves=moves)
            methods.add(method)
            return np.concatenate(parts, axis=1)

        at_x, at_y = x - grid.x0, y - grid.y0
        both = np.moveaxis(fields(at_x, at_y) if at is None else at.gathered(fields, at_x, at_y), 1, 0)
        stress += both[:6]
        displacement += both[6:]
    used = "+".join(sorted(methods - {"none"})) or "none"
    return stress, strain_from_stress(stress, material.modulus, poisson), displacement, used
