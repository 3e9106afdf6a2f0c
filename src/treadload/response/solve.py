"""The verb: loads on a road give stress, strain and displacement."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Sequence
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from treadload import variables
from treadload.contact import Contact
from treadload.errors import InputError
from treadload.kernels.arrays import Array, BoolArray
from treadload.kernels.gridding.points import Points
from treadload.kernels.layers.depths import snapped
from treadload.materials.kinds import upright
from treadload.pavement import Pavement
from treadload.response.fields import response_dataset
from treadload.response.input_caveats import overlapping, question_caveats, road_caveats
from treadload.response.layered import View
from treadload.response.loads import GridLoad, Load, UniformRectangle, gather
from treadload.response.material import check_length
from treadload.response.moving import at_speed
from treadload.response.settle import settle
from treadload.response.several import Question, answers
from treadload.response.solution import Response
from treadload.response.sublayers import sublayer_fields
from treadload.response.superposition import common_grid, merged


def solve_response(
    loads: Load | Sequence[Load],
    road: Pavement,
    *,
    depths: ArrayLike,
    x: ArrayLike | None = None,
    y: ArrayLike | None = None,
    points: ArrayLike | None = None,
    speed: float | None = None,
    side: Literal["above", "below"] = "above",
    mean_over: float | None = None,
    progress: Callable[[str], None] | None = None,
) -> Response:
    """Stress, strain and displacement in a road under pressure and shear.

    loads: a contact, a dataset with pressure, traction_x and traction_y (Pa) over y and x, a GridLoad, a
    UniformDisc, a UniformRectangle, or a list of these, whose responses add up in one pass. road: a half-space
    or layers; half-bonded interfaces make it the mean of two responses, see `Pavement.bond_limits`; stress-dependent
    layers have the moduli of these loads, see `settle`, and the road of the result is the settled one.
    depths: m, >= 0, 0 is the surface.
    x, y: coordinates of the points, m; left out, the loads' own grid serves. One y and many depths make a
    vertical slice. points: instead of x and y, (n, 2), a list of places (x, y), m: lines that cross, or anywhere.
    side: of an interface that a depth falls on, within round-off (1e-9 m), "above" or "below", kept as an attribute
    of the dataset, which figures read; the coordinate `layer` is the layer that was read at each depth. Stress and
    strain of a half-space have no jump there, and the horizontal displacement of layers jumps only where they slide.
    speed: at which the loads travel along +x, m/s, needed where a layer is viscoelastic. The result is then the
    steady state, seen from the loads, without inertia: what a fixed point experiences is a line along x read
    from front to rear, at the time -x / speed. 0 and infinity give the elastic limits.
    mean_over: side of a cube of road, m, over which every field is a mean; left out, fields are those of the points.
    The cube stands around the point, below the surface and within its layer; from two sides down the point itself
    is read, where the field no longer varies over the cube. Means near the edges of ribs do not depend on the
    contact's cells, as points there do, see `response.material`.
    progress: called with a line of text while many loads on one material are computed; loads on one lattice near
    each other become one first.
    Returns a Response with fields (depth, y, x), or (depth, point), tension positive, tensor shear strain,
    displacement_z down.
    At the surface stress_zz = -pressure and stress_xz = -traction_x. Loads are uniform on each cell: shear
    leaves an error O(dx) in the surface strain at cell centres, and shows the cells' edges down to half a cell
    of depth. A GridLoad with interpolation="bilinear" has neither, see there.
    Where layers are viscoelastic `dissipated_energy` (depth, y), or (depth, point), is the energy that one
    passage dissipates, NaN at the surface; it has no mean.
    Raises InputError for a wrong value, a speed that is missing or negative, a layer that needs a temperature or
    is a fluid, depths below a rigid base and depths that need too many wavenumbers; ConvergenceError where stress or
    strain would not be a number, and for a stress-dependent layer whose modulus does not settle.
    Method: Love (1929) and Cerruti's solution by corner sums and FFT convolution, see `kernels.half_space.interior`;
    on layers the same with the top layer's material, plus wavenumbers, see `kernels.layers.layered`; under
    moving loads see `kernels.layers.moving`.

    >>> road = tl.Pavement.half_space(tl.Elastic(100e6, 0.35))
    >>> plate = tl.UniformDisc(radius=0.15, pressure=700e3)
    >>> response = tl.solve_response(plate, road, depths=[0.15], points=[[0.0, 0.0]])
    >>> round(float(response.dataset.stress_zz.item()) / 1e3, 1)  # kPa, compression negative
    -452.5
    """
    start = time.perf_counter()
    if side not in ("above", "below"):
        raise InputError(f'side must be "above" or "below", got {side!r}')
    superposed = gather(loads)
    if road.depends_on_stress:
        road = settle(superposed, road, speed=speed).road
    at_depths = _coordinates("depths", depths)
    if (at_depths < 0).any():
        raise InputError(f"depths must not be negative, got {at_depths.min():g} m; depth counts downwards")
    unique, counts = np.unique(snapped(at_depths, road.interfaces), return_counts=True)
    if (counts > 1).any():
        raise InputError(
            f"depths must be distinct by more than round-off, got {unique[counts > 1][0]:g} m, an interface, "
            f"{counts.max()} times"
        )
    layers = [road.layer_at(float(depth), side) for depth in at_depths]
    at = None
    if points is None:
        grid = common_grid(superposed) if x is None or y is None else None
        at_x = place_x = _coordinates("x", x if x is not None or grid is None else grid.x)
        at_y = place_y = _coordinates("y", y if y is not None or grid is None else grid.y)
    elif x is None and y is None:
        place_x, place_y = _places(points)
        at, at_x, at_y = Points.of(place_x, place_y)
    else:
        raise InputError("the response is computed on a grid or at points: give x and y or points, not both")

    cells = merged([load.cell if isinstance(load, UniformRectangle) else load for load in superposed])
    if mean_over is not None:
        check_length(mean_over)
    described_road, road = road, at_speed(road, speed)
    question = Question(cells, road, at_depths)
    view = View(at_x, at_y, at)
    (answer,) = answers([question], view, side=side, speed=speed, mean_over=mean_over, tell=progress)
    solved, read = answer.fields, answer.read
    stress, strain, displacement = solved.stress, solved.strain, solved.displacement
    modulus, poisson = upright(road.surface_material)
    dataset = response_dataset(
        stress,
        strain,
        at_depths,
        place_y,
        place_x,
        displacement=displacement,
        points=at is not None,
        layers=layers,
        side=side,
        road=_in_words(road),
        modulus=modulus,
        poisson=poisson,
        layer_names=json.dumps([layer.name for layer in road.layers], ensure_ascii=False),
        **({"interfaces": road.interfaces} if len(road.interfaces) else {}),
        **({} if speed is None else {"speed": float(speed)}),
        **({} if read is None else {"mean_over": mean_over, "read_from": read.low, "read_to": read.high}),
    )
    dataset = dataset.assign(sublayer_fields(road).data_vars)
    if speed is not None and read is None:
        energy, line = (solved.energy, "y") if at is None else (solved.energy[:, at.rows], "point")
        dataset["dissipated_energy"] = (("depth", line), energy, variables.attributes("dissipated_energy"))
    stats = {"seconds": time.perf_counter() - start, "method": solved.method, "points": stress[0].size}
    gridded = [load for load in superposed if isinstance(load, GridLoad) and load.interpolation == "constant"]
    local = at_depths if read is None else at_depths[read.local]
    warnings = _warnings(gridded, local) + solved.warnings
    warnings += question_caveats(at_depths, speed) + road_caveats(road) + overlapping(superposed)
    warnings += _drift(displacement, at_depths, cells)
    response = Response(dataset, stats, warnings, superposed, described_road, speed, side)
    items = [loads] if isinstance(loads, Contact) else loads if isinstance(loads, Sequence) else []
    contacts = tuple(item for item in items if isinstance(item, Contact))
    if len(contacts) == len(superposed):
        object.__setattr__(response, "contacts", contacts)
    return response


def _drift(displacement: Array, depths: Array, loads: Sequence[object]) -> tuple[str, ...]:
    """A sentence where displacement (3, nz, my, mx) is NaN: along a net shear force over a face that carries none."""
    gone: BoolArray = np.isnan(displacement).any(axis=(2, 3))  # type: ignore[assignment]
    if not gone.any():
        return ()
    gridded = [load for load in loads if isinstance(load, GridLoad)]
    forces = [sum(float(load.array[1 + axis].sum()) * load.grid.cell_area for load in gridded) for axis in (0, 1)]
    along = [axis for axis in (0, 1) if gone[axis].any()]
    net = " and ".join(f"{abs(forces[axis]):.3g} N along {'xy'[axis]}" for axis in along)
    rows = ", ".join(f"{depth * 1e3:g}" for depth in depths[gone.any(axis=0)])
    return (
        f"a net shear force of {net} acts above a frictionless or half-bonded interface, where nothing holds the "
        f"layers: their displacement along it grows without bound and is NaN at {rows} mm; settlement, stress and "
        "strain are finite; for a finite one take a bond that carries shear, Bond(stiffness=...) or Parted(friction)",
    )


def _in_words(road: Pavement) -> str:
    material = road.layers[0].resolved
    if road.is_homogeneous:
        return f"one material, {material}"
    return f"{len(road.layers)} layer(s){' on a rigid base' if road.rigid_base else ''}, top {material}"


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


def _places(points: ArrayLike) -> tuple[Array, Array]:
    """X and y (n,) of a list of places in m."""
    try:
        array = np.asarray(points, dtype=float)
    except (TypeError, ValueError) as error:
        raise InputError(f"points must be a list of places (x, y) in metres, got {points!r}") from error
    if array.ndim != 2 or array.shape[1] != 2 or not len(array):
        raise InputError(f"points must be a list of places (x, y) in metres, shape (n, 2), got shape {array.shape}")
    if not np.isfinite(array).all():
        raise InputError(f"points must be finite, got {array[~np.isfinite(array)][0]}")
    return array[:, 0], array[:, 1]


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
