"""Pictures that a camera would take of a tread under fringes: to plan a measurement, and to try an evaluation."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from treadload.errors import InputError
from treadload.kernels.arrays import Array, BoolArray
from treadload.tire.fringes.calibration import CameraProjector
from treadload.tire.fringes.gamma import light
from treadload.tire.fringes.steps import TURN, even_shifts

# Heights over the frame's plane z = 0, m, from places x and y, m, of one shape.
Heights = Callable[[Array, Array], Array]
# Steps along a ray from the highest to the lowest height, and halvings after them.
_MARCH, _HALVINGS = 48, 18


@dataclass(frozen=True)
class Rig:
    """A camera and a projector above a plane.

    model: their matrices. rows, columns: of the camera's picture. gain: grey level of a white surface in the
    projector's full light, square to it. ambient: of its brightness without the projector, grey levels. noise:
    standard deviation of a grey level. gamma, contrast: of the projector. bits: of the camera, 8 to 16.
    samples: rays along each side of a pixel, whose light it gathers; at walls one ray is too sharp.
    """

    model: CameraProjector
    rows: int
    columns: int
    gain: float = 200.0
    ambient: float = 10.0
    noise: float = 1.0
    gamma: float = 1.0
    contrast: float = 1.0
    bits: int = 8
    samples: int = 1

    @classmethod
    def above(
        cls,
        pixel: float,
        rows: int,
        columns: int,
        *,
        distance: float,
        baseline: float,
        width: float = 1000.0,
        margin: float = 1.2,
    ) -> Rig:
        """A camera that looks straight down and a projector on its left, both at one height.

        pixel: on the plane, m. distance: of both lenses above it, m. baseline: between them, m. width: pixels of the
        projector, whose light covers the picture on the plane `margin` times along x. Its lens is shifted, so that
        fringes on the plane are even.
        """
        focus, u, v = distance / pixel, 0.5 * (columns - 1), 0.5 * (rows - 1)
        # u = u0 + f x/(L - z), v = v0 - f y/(L - z).
        camera = (
            (focus, 0.0, -u, u * distance),
            (0.0, -focus, -v, v * distance),
            (0.0, 0.0, -1.0, distance),
        )
        per_metre = width / (margin * columns * pixel)
        # On the plane the projector's pixel is (width - 1)/2 + x·per_metre.
        far, middle = per_metre * distance, 0.5 * (width - 1)
        shift = middle - far * baseline / distance
        projector = (
            (far, 0.0, -shift, far * baseline + shift * distance),
            (0.0, -far, -middle, middle * distance),
            (0.0, 0.0, -1.0, distance),
        )
        return cls(CameraProjector(camera, projector, width), rows, columns)

    def with_(self, **changes: float) -> Rig:
        """The same rig with other numbers."""
        return replace(self, **changes)  # type: ignore[arg-type]


@dataclass(frozen=True, eq=False)
class Seen:
    """What the camera's rays see, (rows, columns) times the samples of a pixel: places and heights, m; the
    projector's pixel; the light that arrives.

    shade: cosine between surface and projector, 0 where its light does not arrive.
    """

    x: Array
    y: Array
    height: Array
    place: Array
    shade: Array


def look(rig: Rig, heights: Heights, low: float, high: float) -> Seen:
    """Where every ray of the camera meets a surface, and what of the projector's light arrives there.

    heights: of the surface above z = 0, m. low, high: its range, m; where the surface is missing (NaN) it counts as
    low. Raises InputError for an empty range.
    """
    if not high > low:
        raise InputError(f"the surface must have a range of heights, got {low:g} to {high:g} m")
    lens, eye = _lens(rig.model.camera), np.asarray(rig.model.camera)
    fine = rig.samples
    u, v = np.meshgrid(*((np.arange(count * fine) + 0.5) / fine - 0.5 for count in (rig.columns, rig.rows)))
    ray = np.linalg.solve(eye[:, :3], np.stack([u.ravel(), v.ravel(), np.ones(u.size)])).T
    ray /= -ray[:, 2:]

    def surface(x: Array, y: Array) -> Array:
        elevation = np.asarray(heights(x, y), dtype=float)
        return np.where(np.isfinite(elevation), elevation, low)

    drop = lens[2] - np.linspace(high, low, _MARCH + 1)
    upper, lower = np.full(len(ray), drop[0]), np.full(len(ray), drop[-1])
    met = np.zeros(len(ray), dtype=bool)
    for before, after in pairwise(drop):
        places = lens + ray * after
        hit = ~met & (surface(places[:, 0], places[:, 1]) >= places[:, 2])
        upper[hit], lower[hit] = before, after
        met |= hit
    for _ in range(_HALVINGS):
        middle = 0.5 * (upper + lower)
        places = lens + ray * middle[:, None]
        under = surface(places[:, 0], places[:, 1]) >= places[:, 2]
        lower, upper = np.where(under, middle, lower), np.where(under, upper, middle)
    places = lens + ray * (0.5 * (upper + lower))[:, None]
    return _lit(rig, surface, places, high, u.shape)


def _lit(rig: Rig, surface: Heights, places: Array, high: float, shape: tuple[int, int]) -> Seen:
    """Shadow and shade of places (n, 3), m."""
    source, of = _lens(rig.model.projector), np.asarray(rig.model.projector)
    towards = source - places
    size = np.linalg.norm(towards, axis=1)
    step = 1e-5
    x, y, z = places.T
    slope_x = (surface(x + step, y) - surface(x - step, y)) / (2 * step)
    slope_y = (surface(x, y + step) - surface(x, y - step)) / (2 * step)
    facing = (towards[:, 2] - slope_x * towards[:, 0] - slope_y * towards[:, 1]) / size
    shade = np.maximum(facing / np.sqrt(1 + slope_x**2 + slope_y**2), 0.0)
    # Up to the highest place of the surface, something may stand before the light.
    end = np.clip((high - z) / towards[:, 2], 0.0, None)
    dark: BoolArray = np.zeros(len(places), dtype=bool)
    for part in (np.arange(_MARCH) + 1) / _MARCH:
        way = places + towards * (part * end)[:, None]
        dark |= surface(way[:, 0], way[:, 1]) > way[:, 2] + 1e-6
    shade[dark] = 0.0
    seen = np.concatenate([places, np.ones((len(places), 1))], axis=1) @ of.T
    place = seen[:, 0 if rig.model.across == "u" else 1] / seen[:, 2]
    # Beyond its edges the projector gives no light.
    shade[np.logical_not((place >= -0.5) & (place <= rig.model.width - 0.5))] = 0.0
    return Seen(*(field.reshape(shape) for field in (x, y, z, place, shade)))


def pictures_of(
    rig: Rig,
    seen: Seen,
    fringes: float,
    shifts: int | Array,
    rng: np.random.Generator,
    reflectance: Array | float = 0.8,
) -> Array:
    """Grey levels (n, rows, columns), whole numbers, of the steps of one pattern.

    seen: of `look`. fringes: over the projector. shifts: rad, or how many equal parts of a turn. rng: of the noise.
    reflectance: of the surface, 0 to 1, (rows, columns) or one number.
    """
    steps = even_shifts(shifts) if isinstance(shifts, int) else np.asarray(shifts, dtype=float)
    top = 2**rig.bits - 1
    phase = TURN * fringes * (seen.place + 0.5) / rig.model.width
    parts = (rig.rows, rig.samples, rig.columns, rig.samples)
    lit = rig.gain * np.stack(
        [
            (seen.shade * light(phase + step, rig.gamma, rig.contrast)).reshape(parts).mean(axis=(1, 3))
            for step in steps
        ]
    )
    grey = rig.ambient + lit * np.asarray(reflectance)
    grey = np.rint(np.clip(grey + rng.normal(0.0, rig.noise, grey.shape), 0, top))
    whole: Array = grey.astype(np.uint8 if rig.bits <= 8 else np.uint16)
    return whole


def _lens(matrix: tuple[tuple[float, ...], ...]) -> Array:
    """Place of the lens of a matrix, m."""
    whole = np.asarray(matrix)
    return np.asarray(np.linalg.solve(whole[:, :3], -whole[:, 3]), dtype=np.float64)


def planned_deviation(modulation: float, noise: float, steps: int) -> float:
    """Standard deviation of the phase, rad, √2 σ_I/(√N B), for N equal steps; both in grey levels."""
    return math.sqrt(2) * noise / (math.sqrt(steps) * modulation)
