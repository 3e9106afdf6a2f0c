"""Checks of eigenstrain and stones: Mindlin and Cheng's hot sphere, Eshelby's inclusions, Goodier's cavity."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from treadload.kernels.arrays import Array, BoolArray
from treadload.kernels.eigenstrain import operator
from treadload.kernels.eigenstrain.inclusions import Equivalent, equivalent
from treadload.kernels.eigenstrain.operator import Grid
from treadload.response.heterogeneous.cell_error import strain_error, unlike_axes
from treadload.validation.check import Check, relative

_NU = 0.3
# Mean strain along tensions of 1 over the modulus in x and y, and down, of spheres half a radius below the surface:
# axisymmetric finite elements, 40 and 80 rows of elements between surface and sphere, extrapolated.
NEAR_VOID, NEAR_SOFT = (1.5886, -1.131), (1.4062, -1.0459)
# Bytes of an operator beyond which it is kept in single precision.
_DOUBLE = 128e6
_NORMAL = np.array([1.0, 1, 1, 0, 0, 0])
# Of Eshelby's tensor of a sphere: change of volume, and of shape.
_VOLUME, _SHAPE = (1 + _NU) / (3 * (1 - _NU)), 2 * (4 - 5 * _NU) / (15 * (1 - _NU))


def _block(cells: int, beyond: int, above: float = 0.0) -> tuple[Grid, Array, Array]:
    """Grid of a sphere of so many cells a radius and more beyond it; places along an axis; distances of cells."""
    half = cells + beyond
    at = np.arange(2 * half) - half + 0.5
    grid = Grid(2 * half, 2 * half, 1.0, 1.0, above + np.arange(2 * half + 1.0))
    return grid, at, np.sqrt(at[:, None, None] ** 2 + at[:, None] ** 2 + at**2)


def _tension(cells: int, contrast: float, beyond: int) -> tuple[Equivalent, BoolArray, Array]:
    """A sphere of another modulus in an endless body under a tension of 1; its cells; places along an axis."""
    grid, at, distance = _block(cells, beyond)
    inside = distance < cells
    matrix = 1 / (1 - 2 * _NU), 1 / (1 + _NU)
    apply = operator.cells(grid, 0.5 / (1 + _NU), _NU, averaged=True, surface=False)
    stress = np.zeros((6, *grid.shape))
    stress[0] = 1.0
    count = int(inside.sum())
    moduli = np.full(count, contrast * matrix[0]), np.full(count, contrast * matrix[1])
    return equivalent(apply, stress, inside, moduli, matrix, grid.thickness), inside, at


def near_the_surface(
    contrast: float,
    cells: float,
    cover: float = 0.5,
    tensions: Array | None = None,
    offset: tuple[float, float] = (0.0, 0.0),
) -> tuple[Array, float]:
    """Mean strain of a soft sphere near the surface under uniform tensions, and the error that a result states of it.

    contrast: of its modulus, 0 of a void. cells: a radius. cover: of its top over its radius. tensions: along x, y
    and down, over the modulus, (n, 3); left out, equal ones along x and y. offset: of its centre from a corner of
    cells, in cells. Returns strains along x, y and down (n, 3).
    """
    half = math.ceil(cells + max(map(abs, offset))) + 1
    at, middle = np.arange(2 * half) - half + 0.5, (1 + cover) * cells
    above = max(math.floor(cover * cells) - 1, 0)
    grid = Grid(2 * half, 2 * half, 1.0, 1.0, np.arange(above, math.ceil(middle + cells) + 2.0))
    x, y, z = at - offset[0], at - offset[1], grid.depths - middle
    inside = z[:, None, None] ** 2 + y[:, None] ** 2 + x**2 < cells**2
    apply = operator.cells(grid, 0.5 / (1 + _NU), _NU, averaged=True, single=grid.bytes > _DOUBLE)
    count, matrix = int(inside.sum()), (1 / (1 - 2 * _NU), 1 / (1 + _NU))
    moduli = np.full(count, contrast * matrix[0]), np.full(count, contrast * matrix[1])
    strains = []
    for tension in np.array([[1.0, 1.0, 0.0]]) if tensions is None else tensions:
        stress = np.zeros((6, *grid.shape))
        stress[:3] = tension[:, None, None, None]
        solution = equivalent(apply, stress, inside, moduli, matrix, grid.thickness)
        total, strain = solution.stress[:, inside], solution.eigenstrain[:, inside]
        strains.append(((1 + _NU) * total[:3] - _NU * total[:3].sum(axis=0) + strain[:3]).mean(axis=1))
    return np.array(strains), strain_error(cells, cover, contrast, unlike_axes(inside, x, y, z))


def stone_checks() -> Iterator[Check]:
    """A hot sphere below the surface, spheres of cells in an endless body, the stress beside a cavity."""
    group = "stones"
    for cover, bound in ((2.0, 1e-3), (1.2, 5e-3)):
        grid, at, distance = _block(8, 0, 8 * cover - 8)
        inside = distance < 8
        moved = operator.moved_by_cells(grid, _NU)(_NORMAL[:, None, None, None] * inside)[2, 0]
        share = float(inside.sum()) * 3 / (4 * np.pi)
        exact = -4 / 3 * (1 + _NU) * share * 8 * cover / (at**2 + at[:, None] ** 2 + (8 * cover) ** 2) ** 1.5
        worst = np.unravel_index(int(np.abs(moved - exact).argmax()), moved.shape)
        scale = exact.min()
        yield relative(
            group, f"hot sphere {cover:g} radii deep, 8 cells: rise of the surface, farthest off",
            scale + (moved - exact)[worst], scale, bound, "Mindlin and Cheng (1950), J. Appl. Phys. 21, 931",
        )  # fmt: skip
    remote = np.array([1, -_NU, -_NU, 0, 0, 0])
    mean = remote[:3].sum() / 3 * _NORMAL
    for contrast, cells, bound in ((0.1, 8, 5e-3), (12.0, 8, 4.5e-2)):
        solution, inside, _ = _tension(cells, contrast, 1)
        stress = solution.stress[:, inside].mean(axis=1)
        strain = (stress[0] - _NU * (stress[1] + stress[2])) / contrast
        exact = mean / (1 + (contrast - 1) * _VOLUME) + (remote - mean) / (1 + (contrast - 1) * _SHAPE)
        yield relative(
            group, f"sphere of {contrast:g} times the modulus, {cells} cells a radius: mean strain", strain, exact[0],
            bound, "Eshelby (1957), Proc. R. Soc. A 241, 376",
        )  # fmt: skip
    for name, contrast, near in (("void", 0.0, NEAR_VOID), ("sphere of 0.1 times the modulus", 0.1, NEAR_SOFT)):
        (strain,), error = near_the_surface(contrast, 8)
        for direction, value, reference in zip(("tension", "depth"), strain[[0, 2]].tolist(), near, strict=True):
            yield relative(
                group, f"{name} half a radius below the surface, 8 cells a radius: mean strain along {direction}",
                value, reference, error, "axisymmetric finite elements, tests/bispherical.py",
            )  # fmt: skip
    solution, _, at = _tension(6, 0.0, 4)
    beside, r = solution.stress[0][9:11, :, 9:11].mean(axis=(0, 2)), np.sqrt(at**2 + 0.5)
    exact = 1 + (4 - 5 * _NU) / (2 * (7 - 5 * _NU)) * (6 / r) ** 3 + 9 / (2 * (7 - 5 * _NU)) * (6 / r) ** 5
    yield relative(
        group, "cavity of 6 cells a radius: stress along the tension, second cell beside it", beside[17], exact[17],
        3e-2, "Goodier (1933), J. Appl. Mech. 55, 39",
    )  # fmt: skip
