"""Stress intensity of a crack in a road as wheels pass: from the uncracked stress along its path.

The section is that across the crack's trace: plane strain, with the uncracked three-dimensional stress of that place
as the load. The weight functions are those of the layers, see `kernels.fracture`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import scipy

from treadload.damage.growth.options import POINTS, STEEPEST
from treadload.errors import ConvergenceError, InputError
from treadload.kernels.arrays import Array
from treadload.kernels.fracture.closure import stress_intensity
from treadload.kernels.fracture.crack import CrackFaces, crack_faces
from treadload.kernels.fracture.dislocations import Section
from treadload.kernels.fracture.layers import Strip
from treadload.materials import Elastic
from treadload.pavement import Pavement

# States whose tensile and shear tractions make less than this part of the largest stress intensity are taken as none.
_LEAST = 0.005
# Distances closer than this are the two sides of an interface, where the stress jumps, m.
BREAK = 2e-6
# A tip at an interface has another singularity: the last solve stops short of it by this part of the way.
CLOSE = 0.95


@dataclass(frozen=True, eq=False)
class Crossing:
    """Uncracked stress around the path of cracks as the wheels of a class pass in a season.

    stress: (6, nd, ny, nx), Pa, xx, yy, zz, xy, xz, yz, at distances (nd,) from the mouth into the road, m, rising
    from 0, places y and x of the crack in the wheels' frame, m, rising. section: layers with the one that cracks.
    upwards: True for a crack that grows up from below. axles: of the class.
    """

    stress: Array
    distances: Array
    y: Array
    x: Array
    section: Section
    upwards: bool
    poisson: float
    axles: int


def way_through(road: Pavement, start: int, layers: int, *, upwards: bool) -> tuple[float, float]:
    """Depths, m, between which a crack runs that starts in a layer, by number, and goes through so many.

    Raises InputError for layers without a thickness.
    """
    first, last = (start - layers + 1, start) if upwards else (start, start + layers - 1)
    if first < 0 or last >= len(road.layers) or road.layers[last].thickness is None:
        raise InputError(
            f"a crack through {layers} layer(s) from layer {start + 1} leaves the layers that have a thickness; the "
            f"road has {len(road.interfaces)} of them"
        )
    return float(road.interfaces[first - 1]) if first else 0.0, float(road.interfaces[last])


def section_of(road: Pavement, top: float, bottom: float) -> tuple[Section, float]:
    """Layers in a section, those between two depths, m, as one, and its Poisson's ratio.

    road: elastic, or viscoelastic and then as under fast loads; of half-bonded interfaces as if bonded. The crack
    goes through whole layers, parts of a course with temperatures of their own among them; they become one of their
    mean modulus. Raises InputError.
    """
    ends = np.concatenate([[0.0], road.interfaces])
    first, last = int(np.abs(ends - top).argmin()), int(np.abs(ends - bottom).argmin()) - 1
    elastic = road.bond_limits[0]
    if elastic.is_viscoelastic:
        elastic = elastic.glassy
    strips = []
    for number, layer in enumerate(elastic.layers):
        material = layer.resolved
        if not isinstance(material, Elastic):
            raise InputError(
                f"layer {layer.name or number + 1!r} is {material}; cracks grow in layers that are the same in all "
                "directions, so give them Elastic materials"
            )
        slip = 1 / layer.bond.stiffness if layer.bond.stiffness > 0 else math.inf
        strips.append(Strip(material.modulus, material.poisson, layer.thickness or math.inf, slip))
    joined_strips = strips[first : last + 1]
    if any(strip.slip for strip in joined_strips[:-1]):
        raise InputError("a crack goes through layers that are bonded; the bond between those asked is not")
    thick = [strip.thickness for strip in joined_strips]
    joined = Strip(
        float(np.average([strip.modulus for strip in joined_strips], weights=thick)),
        float(np.average([strip.poisson for strip in joined_strips], weights=thick)),
        sum(thick),
        joined_strips[-1].slip,
    )
    section = Section((*strips[:first], joined, *strips[last + 1 :]), first, elastic.rigid_base)
    return section, joined.poisson


@dataclass(frozen=True, eq=False)
class Way:
    """A path: offsets (k,), m, along the normal of the trace, at distances (k,) from the mouth, rising from 0."""

    distances: Array
    offsets: Array

    def at(self, distance: Array) -> tuple[Array, Array]:
        """Offset, m, and its slope at distances, m; straight on beyond the last one."""
        if not self.offsets.any():
            return np.zeros_like(distance), np.zeros_like(distance)
        if len(self.distances) == 2:
            slope = self.offsets[1] / self.distances[1]
            return slope * distance, np.full_like(distance, slope)
        curve = scipy.interpolate.PchipInterpolator(self.distances, self.offsets)
        return curve(distance), curve.derivative()(distance)

    def until(self, distance: float) -> Way:
        """As far as a distance, m; a straight one goes on in its direction."""
        if len(self.distances) == 2:
            return self
        keep = self.distances <= distance * (1 + 1e-9)
        return Way(self.distances[keep], self.offsets[keep])


def faces_along(section: Section, way: Way, distance: float, *, upwards: bool, points: int = POINTS) -> CrackFaces:
    """The faces of a crack whose tip is at a distance from its mouth, m."""

    def curve(s: Array) -> tuple[Array, Array, Array, Array]:
        offset, slope = way.at(s)
        turn = -1.0 if upwards else 1.0
        mouth = section.thickness if upwards else 0.0
        return offset, mouth + turn * s, slope, np.full_like(s, turn)

    return crack_faces(section, curve, distance, points)


def tractions(crossing: Crossing, faces: CrackFaces, trace: float) -> Array:
    """Normal, along the path and out of the plane (ny, nx, 3, n), Pa, at the points of the faces.

    trace: its angle from travel towards the right, rad. x of the faces counts along the trace's normal.
    """
    across = np.array([-math.sin(trace), math.cos(trace)])
    distance = crossing.section.thickness - faces.z if crossing.upwards else faces.z
    stress: Array = np.einsum("kd,cdyx->ckyx", between(crossing.distances, distance), crossing.stress, optimize=True)
    if faces.x.any():
        stress = _moved(stress, crossing, faces.x[:, None] * across)
    xx, yy, zz, xy, xz, yz = stress
    s, c = across
    # Across and along the trace, seen from above.
    nn, nt, nz = s * s * xx + c * c * yy + 2 * s * c * xy, s * c * (yy - xx) + (s * s - c * c) * xy, s * xz + c * yz
    tz = c * xz - s * yz
    n, t = faces.normal[:, :, None, None], faces.tangent[:, :, None, None]
    normal = n[0] ** 2 * nn + n[1] ** 2 * zz + 2 * n[0] * n[1] * nz
    shear = n[0] * t[0] * nn + n[1] * t[1] * zz + (n[0] * t[1] + n[1] * t[0]) * nz
    lateral = n[0] * nt + n[1] * tz
    return np.stack([normal, shear, lateral]).transpose(2, 3, 0, 1)


def between(distances: Array, at: Array) -> Array:
    """Weights (n, nd) of what is known at distances (nd,), m, rising, for its values at others (n,) within them.

    Cubic between two distances, with the slope of the parabola through each and its neighbours; two that are closer
    than BREAK are the sides of an interface, across which nothing is interpolated.
    """
    weights = np.zeros((len(at), len(distances)))
    ends = np.flatnonzero(np.diff(distances) < BREAK) + 1
    for piece in np.split(np.arange(len(distances)), ends):
        low, high = distances[piece[0]], distances[piece[-1]]
        first, last = piece[0] == 0, piece[-1] == len(distances) - 1
        rows = np.flatnonzero((first | (at >= low)) & (last | (at < high)))
        weights[np.ix_(rows, piece)] = _cubic(distances[piece], at[rows])
    lost = ~weights.any(axis=1)
    if lost.any():
        closest = np.abs(distances - at[lost, None]).argmin(axis=1)
        weights[np.flatnonzero(lost), closest] = 1.0
    return weights


def _cubic(x: Array, at: Array) -> Array:
    unit = np.eye(len(x))
    if len(x) == 2:
        slope: Array = np.repeat(np.diff(unit, axis=0) / np.diff(x)[:, None], 2, axis=0)
    else:
        slope = np.asarray(np.gradient(unit, x, axis=0, edge_order=2))
    weights: Array = scipy.interpolate.CubicHermiteSpline(x, unit, slope)(at)
    return weights


def _moved(stress: Array, crossing: Crossing, by: Array) -> Array:
    """Stress (6, n, ny, nx) at places moved by (n, 2), m, along x and y."""
    columns, rows = np.arange(len(crossing.x)), np.arange(len(crossing.y))
    shifted = np.empty_like(stress)
    for k, (along, across) in enumerate(by):
        grid = np.meshgrid(
            np.interp(crossing.y + across, crossing.y, rows), np.interp(crossing.x + along, crossing.x, columns),
            indexing="ij",
        )  # fmt: skip
        for part in range(len(stress)):
            shifted[part, k] = scipy.ndimage.map_coordinates(stress[part, k], grid, order=1)
    return shifted


def modes(crossing: Crossing, faces: CrackFaces, trace: float, friction: float) -> tuple[Array, int]:
    """K_I, K_II, K_III (ny, nx, 3), Pa √m, at every state of a passage; in how many the faces jam, see there.

    Raises ConvergenceError.
    """
    load = tractions(crossing, faces, trace)
    # Faces that touch can open elsewhere, so that the sum over the whole path says little: its parts do.
    pull, shear, lateral = np.maximum(load[..., 0, :], 0.0), np.abs(load[..., 1, :]), np.abs(load[..., 2, :])
    in_plane = np.concatenate([pull, shear], axis=-1) @ np.abs(faces.plane).T
    size = np.maximum(in_plane.max(axis=-1), lateral @ np.abs(faces.antiplane))
    moves = size > _LEAST * size.max()
    factors = np.zeros((*size.shape, 3))
    try:
        factors[moves], settled = stress_intensity(faces, load[moves], friction)
    except ArithmeticError as error:
        raise ConvergenceError(str(error)) from error
    return factors, int((~settled).sum())


def intensity_ranges(history: Array, poisson: float, axles: int) -> Array:
    """Ranges of a passage's cycles (ny, 4, cycles), Pa √m: of modes I, II, III and Irwin's of the three.

    history: K (ny, nx, 3) in the order of the passage, from and to rest. Cycles are counted by rainflow, mode by
    mode; the largest of the modes are taken together, ΔK² = ΔK_I² + ΔK_II² + ΔK_III² / (1 - ν), as if they peaked at
    once, and so on. axles: of which each makes two cycles at most. Faces that close leave K_I = 0, so that its range
    is that part of the passage in which the crack is open: no more is made of the ratio of smallest to largest.
    Source: Irwin (1957) for the sum; Matsuishi and Endo (1968) for the count.
    """
    count = 2 * axles
    ranges = np.zeros((len(history), 4, count))
    for row, passage in enumerate(history):
        for mode in range(3):
            if passage[:, mode].any():
                cycles = rainflow(passage[:, mode])[:count]
                ranges[row, mode, : len(cycles)] = cycles
    ranges[:, 3] = np.sqrt(ranges[:, 0] ** 2 + ranges[:, 1] ** 2 + ranges[:, 2] ** 2 / (1 - poisson))
    return ranges


def rainflow(values: Array) -> list[float]:
    """Ranges of the cycles of a history that begins and ends at zero and comes again and again, the largest first."""
    line = np.concatenate([[0.0], values, [0.0]])
    # From its largest deflection on, the repeated history closes every cycle.
    start = int(np.abs(line).argmax())
    line = np.concatenate([line[start:], line[: start + 1]])
    steps = np.diff(line)
    line = np.append(line[:-1][steps != 0], line[-1])
    turns: Any = np.concatenate([[True], np.diff(line[:-1]) * np.diff(line[1:]) < 0, [True]]) if len(line) > 2 else []
    stack: list[float] = []
    ranges = []
    for value in line[turns].tolist() if len(line) > 2 else []:
        stack.append(value)
        while len(stack) > 3 and abs(stack[-2] - stack[-3]) <= min(
            abs(stack[-1] - stack[-2]), abs(stack[-3] - stack[-4])
        ):
            ranges.append(abs(stack[-2] - stack[-3]))
            del stack[-3:-1]
    # What is left goes out from the largest deflection and comes back to it.
    ranges += [abs(b - a) for a, b in zip(stack[:-1:2], stack[1::2], strict=False)]
    return sorted((value for value in ranges if value > 0), reverse=True)


def kink_angle(first: float, second: float) -> float:
    """Angle, rad, from the tangent towards the normal of the path, across which the hoop stress is largest.

    first, second: K_I >= 0 and K_II. Source: Erdogan and Sih (1963), J. Basic Eng. 85, 519-527.
    """
    if second == 0:
        return 0.0
    return 2 * math.atan((first - math.hypot(first, math.sqrt(8) * second)) / (4 * second))


def hoop_intensity(factors: Array) -> Array:
    """Largest hoop stress at a distance from the tip times √2πr (...), Pa √m, of K (..., 3)."""
    first, second = factors[..., 0], factors[..., 1]
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = (first - np.hypot(first, np.sqrt(8) * second)) / (4 * second)
    half = np.arctan(np.where(second == 0, 0.0, ratio))
    hoop: Array = np.cos(half) * (first * np.cos(half) ** 2 - 1.5 * second * np.sin(2 * half))
    return hoop


def crack_paths(
    crossings: Sequence[Crossing], weights: Array, place: int, distances: Array, trace: float, friction: float
) -> Way:
    """The kinked path of the crack at one place y, step by step to distances (k,), m; to the first it is straight.

    crossings: of the classes and seasons. weights: how much each counts, such as its share of the passes. Every step
    goes where the largest hoop stress of any state points, weighted by how much the class and season count.
    """
    from_mouth, offsets = [0.0, float(distances[0])], [0.0, 0.0]
    angle = 0.0
    for k in range(1, len(distances)):
        way = Way(np.array(from_mouth), np.array(offsets))
        best = (0.0, 0.0, 0.0)
        for crossing, weight in zip(crossings, weights, strict=True):
            faces = faces_along(crossing.section, way, from_mouth[-1], upwards=crossing.upwards)
            near = slice(max(place - 1, 0), place + 2)
            factors = modes(_rows(crossing, near), faces, trace, friction)[0][place - near.start]
            hoop = hoop_intensity(factors) * weight
            at = int(hoop.argmax())
            if hoop[at] > best[0]:
                best = (float(hoop[at]), float(factors[at, 0]), float(factors[at, 1]))
        _, slope = way.at(np.array(from_mouth[-1:]))
        turn = kink_angle(best[1], best[2]) if best[0] > 0 else 0.0
        # From the tangent towards the normal; going down the normal points to where offsets grow, going up away.
        sign = -1.0 if crossings[0].upwards else 1.0
        angle = float(np.clip(math.atan(float(slope[0])) + sign * turn, -STEEPEST, STEEPEST))
        step = float(distances[k]) - from_mouth[-1]
        offsets.append(offsets[-1] + step * math.tan(angle))
        from_mouth.append(float(distances[k]))
    return Way(np.array(from_mouth), np.array(offsets))


def _rows(crossing: Crossing, rows: slice) -> Crossing:
    return partial(Crossing, crossing.stress[:, :, rows], crossing.distances, crossing.y[rows])(
        crossing.x, crossing.section, crossing.upwards, crossing.poisson, crossing.axles
    )
