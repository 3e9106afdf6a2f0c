"""The verb: loads on a road give stress, strain and displacement."""

from __future__ import annotations

import json
import time
from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.pavement import Pavement
from treadload.response.fields import response_dataset
from treadload.response.half_space import half_space_response
from treadload.response.layered import layered_response
from treadload.response.loads import GridLoad, Load, SurfaceLoad, UniformRectangle, common_grid, gather
from treadload.response.solution import Response


def solve_response(
    loads: Load | Sequence[Load],
    road: Pavement,
    *,
    depths: ArrayLike,
    x: ArrayLike | None = None,
    y: ArrayLike | None = None,
    side: Literal["above", "below"] = "above",
) -> Response:
    """Stress, strain and displacement in a road under pressure and shear.

    loads: a contact, a dataset with pressure, traction_x and traction_y (Pa) over y and x, a GridLoad, a
    UniformDisc, a UniformRectangle, or a list of these, whose responses add up in one pass. road: a half-space
    or elastic layers; half-bonded interfaces make it the mean of two responses, see `Pavement.bond_limits`.
    depths: m, >= 0, 0 is the surface.
    x, y: coordinates of the points, m; left out, the loads' own grid serves. One y and many depths make a
    vertical slice. side: of an interface that a depth falls on, "above" or "below"; stress and strain of a
    half-space have no jump there, and the horizontal displacement of layers jumps only where they slide.
    Returns a Response with fields (depth, y, x), tension positive, tensor shear strain, displacement_z down.
    At the surface stress_zz = -pressure and stress_xz = -traction_x. Loads are uniform on each cell: shear
    leaves an error O(dx) in the surface strain at cell centres, and shows the cells' edges down to half a cell
    of depth. A GridLoad with interpolation="bilinear" has neither, see there.
    Raises InputError for a wrong value, depths below a rigid base and depths that need too many wavenumbers.
    Method: Love (1929) and Cerruti's solution by corner sums and FFT convolution, see `kernels.interior`; on
    layers the same with the top layer's material, plus wavenumbers, see `kernels.layered`.
    """
    start = time.perf_counter()
    if side not in ("above", "below"):
        raise InputError(f'side must be "above" or "below", got {side!r}')
    at_depths = _coordinates("depths", depths)
    if (at_depths < 0).any():
        raise InputError(f"depths must not be negative, got {at_depths.min():g} m; depth counts downwards")
    superposed = gather(loads)
    grid = common_grid(superposed) if x is None or y is None else None
    at_x = _coordinates("x", x if x is not None or grid is None else grid.x)
    at_y = _coordinates("y", y if y is not None or grid is None else grid.y)

    cells = [load.cell if isinstance(load, UniformRectangle) else load for load in superposed]
    material = road.distinct_layers[0].elastic
    if road.is_homogeneous:
        words = f"one material, {material}"
    else:
        words = f"{len(road.layers)} layer(s){' on a rigid base' if road.rigid_base else ''}, top {material}"
    limits = [_solve(cells, limit, at_depths, at_x, at_y, below=side == "below") for limit in road.bond_limits]
    stress, strain, displacement, method = _mean(limits)
    dataset = response_dataset(
        stress,
        strain,
        at_depths,
        at_y,
        at_x,
        displacement=displacement,
        road=words,
        modulus=material.modulus,
        poisson=material.poisson,
        layer_names=json.dumps([layer.name for layer in road.layers], ensure_ascii=False),
        **({"interfaces": road.interfaces} if len(road.interfaces) else {}),
    )
    stats = {"seconds": time.perf_counter() - start, "method": method, "points": stress[0].size}
    gridded = [load for load in superposed if isinstance(load, GridLoad) and load.interpolation == "constant"]
    warnings = _warnings(gridded, at_depths)
    if np.isnan(displacement).any():
        warnings += (
            "a net shear force acts above a frictionless or half-bonded interface, where nothing holds the layers: "
            "their horizontal displacement has no finite value and is NaN; stress and strain hold",
        )
    return Response(dataset, stats, warnings)


# Stress, strain and displacement, and how they were found.
_Fields = tuple[Array, Array, Array, str]


def _solve(
    loads: Sequence[SurfaceLoad], road: Pavement, depths: Array, x: Array, y: Array, *, below: bool
) -> _Fields:
    if road.is_homogeneous:
        return half_space_response(loads, road.distinct_layers[0].elastic, depths, x, y)
    return layered_response(loads, road, depths, x, y, below=below)


def _mean(solved: Sequence[_Fields]) -> _Fields:
    """Mean of the fields; one alone is not copied."""
    if len(solved) == 1:
        return solved[0]
    stress, strain, displacement, methods = zip(*solved, strict=True)
    how = " and ".join(dict.fromkeys(methods))
    return np.mean(stress, axis=0), np.mean(strain, axis=0), np.mean(displacement, axis=0), how


def _warnings(loads: Sequence[GridLoad], depths: Array) -> tuple[str, ...]:
    if not loads:
        return ()
    half = 0.5 * min(min(load.grid.dx, load.grid.dy) for load in loads)
    shallow = depths[(depths > 0) & (depths < half)]
    if not shallow.size:
        return ()
    return (
        f"depth {shallow.min() * 1e3:g} mm is less than half a cell, {half * 1e3:g} mm: "
        "strain there shows the steps of the load between cells; take the surface, a finer contact or a GridLoad "
        'with interpolation="bilinear"',
    )


def _coordinates(name: str, values: ArrayLike | None) -> Array:
    """One-dimensional, finite, distinct coordinates in m."""
    try:
        array = np.atleast_1d(np.asarray(values, dtype=float))
    except (TypeError, ValueError) as error:
        raise InputError(f"{name} must be numbers of metres, got {values!r}") from error
    if array.ndim != 1 or not array.size:
        raise InputError(f"{name} must be a list of at least one number of metres, got shape {array.shape}")
    if not np.isfinite(array).all():
        raise InputError(f"{name} must be finite, got {array[~np.isfinite(array)][0]}")
    unique, counts = np.unique(array, return_counts=True)
    if (counts > 1).any():
        raise InputError(f"{name} must be distinct, got {unique[counts > 1][0]:g} m {counts.max()} times")
    return array
