"""Response of a road of one material: the closed forms of the half-space."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from treadload.kernels.arrays import Array
from treadload.kernels.interior import stress_on_grid
from treadload.kernels.tensors import strain_from_stress
from treadload.materials import Elastic
from treadload.response.loads import GridLoad


def half_space_response(
    loads: Sequence[GridLoad], material: Elastic, depths: Array, x: Array, y: Array
) -> tuple[Array, Array, str]:
    """Stress and strain of a half-space under superposed loads.

    material: of the half-space. depths: (nz,), m, >= 0. x: (mx,), y: (my,), m, any coordinates.
    Returns stress, Pa, and strain, both (6, nz, my, mx), tension positive, tensor shear, in the order of
    `kernels.interior.COMPONENTS`; and the method: "fft" where x and y lie on few lattices of the loads'
    spacing (that spacing, its fractions or multiples, a single row), "direct" elsewhere, slower.
    Exact for loads uniform on each cell; near the surface that shows as an error O(dx), see the kernel.
    """
    stress = np.zeros((len(depths), 6, len(y), len(x)))
    methods = set()
    for load in loads:
        grid = load.grid
        part, method = stress_on_grid(
            load.array, grid.dx, grid.dy, depths, material.poisson, x - grid.x0, y - grid.y0
        )
        stress += part
        methods.add(method)
    tensor = np.ascontiguousarray(np.moveaxis(stress, 1, 0))
    used = "+".join(sorted(methods - {"none"})) or "none"
    return tensor, strain_from_stress(tensor, material.modulus, material.poisson), used
