"""From phase to height: by a reference plane, or by the matrices of camera and projector."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.tire.fringes.steps import TURN
from treadload.units import Length, Number

# Terms of u^i v^j with i + j up to this, by which both numbers of the reference plane run over the picture.
DEGREE = 4
_FEWEST = 10 * (DEGREE + 1) * (DEGREE + 2) // 2
# Rays closer to the plane of their fringe than this, rad, meet it anywhere; of distances, what lenses lie apart.
_GRAZING = 1e-3

Matrix = tuple[tuple[Number, ...], ...]


# Lengths of a rig, m.
_SHORTEST, _LONGEST = 1e-6, 1e3


@dataclass(frozen=True, eq=False)
class Points:
    """Places of pixels, m, in a right-handed frame: x, y and the height towards the camera.

    per_radian: change of the height with the phase, m/rad. NaN where nothing is known.
    """

    x: Array
    y: Array
    height: Array
    per_radian: Array


@dataclass(frozen=True)
class ReferencePlane:
    """Heights above a plane that was photographed under the same fringes.

    The phase differs from that on the plane by Δφ, and h = Δφ/(c + e Δφ), which is exact for a pinhole camera and a
    pinhole projector anywhere; c and e run smoothly over the picture. pixel: size on the plane, m. heights: of the
    planes in `planes` of the patterns, m above the reference, by which c and e are found; one gives c alone, with
    e = 0. In their place distance, baseline and period: of lenses at one height above the plane (m), beside each
    other along the rows of the picture (m; positive when the projector stands on the left of the camera and the phase
    grows to the right), under fringes of the finest pattern so wide on the plane (m), h = distance Δφ/(Δφ + 2π
    baseline/period). The frame's x points to the right of the picture and its y up. camera_distance: of the camera's
    lens from the plane, m; high places are then put where the camera, above the middle of the picture, saw them; left
    out, it looks straight down everywhere, as a telecentric lens does; distance serves for it as well.
    """

    pixel: Length
    heights: tuple[Length, ...] = ()
    distance: Length | None = None
    baseline: Length | None = None
    period: Length | None = None
    camera_distance: Length | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "heights", tuple(self.heights))
        positive("pixel", self.pixel, "metres", "the side of a pixel on the reference plane, such as 0.5 mm")
        for name in ("distance", "period", "camera_distance"):
            if getattr(self, name) is not None:
                positive(name, getattr(self, name), "metres")
        lengths = [getattr(self, name) for name in ("distance", "baseline", "period")]
        present = [length is not None for length in lengths]
        if any(present) != all(present) or all(present) == bool(self.heights):
            raise InputError(
                "a reference plane needs either heights= of further planes, or distance=, baseline= and period= "
                "together"
            )
        if self.baseline is not None and not (math.isfinite(self.baseline) and self.baseline != 0):
            raise InputError(f"baseline must be a length other than 0 m, got {self.baseline:g}")
        for name, length in zip(("distance", "baseline", "period"), lengths, strict=True):
            if length is not None and not _SHORTEST <= abs(length) <= _LONGEST:
                raise InputError(
                    f"{name} is {length:g} m, no rig has one beyond {_SHORTEST:g} to {_LONGEST:g} m; what unit is it?"
                )
        if len(set(self.heights)) != len(self.heights) or 0.0 in self.heights:
            raise InputError(
                f"heights must differ and none may be 0, the reference itself, got {list(self.heights)} m"
            )

    def coefficients(self, differences: Sequence[Array], shape: tuple[int, int]) -> tuple[Array, Array, float]:
        """C and e over the picture, and how far the planes lie from them, rms, m (NaN without planes).

        differences: phase on each plane of `heights` less that on the reference, rad, (rows, columns).
        """
        if not self.heights:
            assert self.distance is not None
            assert self.baseline is not None
            assert self.period is not None
            c = TURN * self.baseline / (self.period * self.distance)
            return np.full(shape, c), np.full(shape, 1 / self.distance), math.nan
        phases = np.stack(list(differences))
        heights = np.asarray(self.heights)[:, None]
        valid = np.isfinite(phases).all(axis=0)
        if valid.sum() < _FEWEST:
            raise InputError(
                f"the planes are seen together in {int(valid.sum())} pixels, {_FEWEST} at least are needed; use "
                "planes that fill the picture, bright and not saturated"
            )
        terms = _terms(shape)
        rows, valid_phases = terms[valid], phases[:, valid]
        if len(self.heights) == 1:
            weights = np.linalg.lstsq(rows, valid_phases[0] / heights[0], rcond=None)[0]
            c, e = terms @ weights, np.zeros(shape)
        else:
            # Δφ = h c + h Δφ e: linear in both, first pixel by pixel, then over the picture.
            each = np.stack([np.broadcast_to(heights, valid_phases.shape), heights * valid_phases], axis=2)
            normal = np.einsum("kpi,kpj->pij", each, each)
            # Scaled, so that neither column is lost beside the other.
            size = np.sqrt(np.einsum("pii->pi", normal))
            normal /= size[:, :, None] * size[:, None, :]
            right = np.einsum("kpi,kp->pi", each, valid_phases) / size
            solution = np.linalg.solve(normal, right[..., None])[..., 0] / size
            c, e = (terms @ np.linalg.lstsq(rows, solution[:, k], rcond=None)[0] for k in range(2))
        left = valid_phases / (c[valid] + e[valid] * valid_phases) - heights
        return c, e, float(np.sqrt((left**2).mean()))

    def points(self, difference: Array, c: Array, e: Array) -> Points:
        """Places of all pixels from the phase less that on the plane, rad."""
        base = c + e * difference
        with np.errstate(divide="ignore", invalid="ignore"):
            height = difference / base
            per_radian = np.abs(c / base**2)
        rows, columns = difference.shape
        x = np.broadcast_to((np.arange(columns) - 0.5 * (columns - 1)) * self.pixel, difference.shape)
        y = np.broadcast_to(((np.arange(rows) - 0.5 * (rows - 1)) * -self.pixel)[:, None], difference.shape)
        far = self.camera_distance or self.distance
        shrink = 1.0 if far is None else 1 - height / far
        return Points(x * shrink, y * shrink, height, per_radian)

    @property
    def is_linear(self) -> bool:
        """True if one plane alone gives c, and e is taken as 0."""
        return len(self.heights) == 1


@dataclass(frozen=True)
class CameraProjector:
    """Heights by rays of a camera and planes of light of a projector, both pinholes.

    camera, projector: matrices (3 rows of 4 numbers) that take (x, y, z, 1) of a calibrated frame to (s u, s v, s),
    u to the right and v down, in pixels from the centre of the first one. The frame's z is the height, towards the
    camera. unit: of a length in that frame, m. width: pixels of the projector across its fringes. across: along which
    of its axes the phase grows, "u" for upright fringes, "v" for lying ones. Pictures must have no lens distortion.
    Source: Hartley and Zisserman (2004), Multiple View Geometry, for the matrices.
    """

    camera: Matrix
    projector: Matrix
    width: Number
    unit: Length = 1.0
    across: str = "u"

    def __post_init__(self) -> None:
        for name in ("camera", "projector"):
            matrix_rows = getattr(self, name)
            try:
                matrix = np.asarray(matrix_rows, dtype=float)
            except (TypeError, ValueError):
                matrix = np.zeros(0)
            if matrix.shape != (3, 4) or not np.isfinite(matrix).all():
                raise InputError(
                    f"the matrix of the {name} must have 3 rows of 4 finite numbers, got {matrix_rows!r}"
                )
            if np.linalg.matrix_rank(matrix[:, :3]) < 3:
                raise InputError(
                    f"the left 3 x 3 of the matrix of the {name} is singular, so it has no lens; calibrate a pinhole"
                )
            object.__setattr__(self, name, tuple(tuple(map(float, row)) for row in matrix))
        both = [np.asarray(matrix) for matrix in (self.camera, self.projector)]
        lenses = [np.linalg.solve(matrix[:, :3], -matrix[:, 3]) for matrix in both]
        if np.linalg.norm(lenses[0] - lenses[1]) < _GRAZING * max(map(np.linalg.norm, lenses)):
            raise InputError("camera and projector are in one place: their lenses must lie apart for heights to show")
        positive("width of the projector", self.width, "pixels")
        positive("unit", self.unit, "metres", 'such as "1 mm" for a frame in millimetres')
        if self.across not in ("u", "v"):
            raise InputError(f'across must be "u" or "v", got {self.across!r}')

    def points(self, phase: Array, fringes: float) -> Points:
        """Places of all pixels from the absolute phase, rad, of so many fringes over the projector's width."""
        rows, columns = phase.shape
        u, v = (
            np.broadcast_to(np.arange(columns), phase.shape),
            np.broadcast_to(np.arange(rows)[:, None], phase.shape),
        )
        turning = self.width / (TURN * fringes)
        # Pixel 0 is lit from half a pixel before its centre.
        place = phase * turning - 0.5
        of = np.asarray(self.projector)
        line = of[0 if self.across == "u" else 1]
        eye = np.asarray(self.camera)
        planes = np.stack(
            [eye[0] - u[..., None] * eye[2], eye[1] - v[..., None] * eye[2], line - place[..., None] * of[2]], axis=-2
        )
        valid = np.isfinite(phase)
        where = np.full((*phase.shape, 3), np.nan)
        moves = np.full((*phase.shape, 3), np.nan)
        if valid.any():
            left, right = planes[valid][..., :3], -planes[valid][..., 3]
            size = np.linalg.norm(left, axis=2)
            flat = np.abs(np.linalg.det(left)) < _GRAZING * size.prod(axis=1)
            if flat.all():
                raise InputError(
                    "no ray of the camera crosses the fringes' planes of light: across= is the wrong axis, or a "
                    "matrix is wrong"
                )
            left[flat] = np.eye(3)
            solved = np.linalg.solve(left, right[..., None])[..., 0]
            reach = solved @ of[2, :3] + of[2, 3]
            push = np.zeros_like(solved)
            push[:, 2] = reach * turning
            moved = np.linalg.solve(left, push[..., None])[..., 0]
            solved[flat] = moved[flat] = np.nan
            where[valid], moves[valid] = solved * self.unit, moved * self.unit
        return Points(where[..., 0], where[..., 1], where[..., 2], np.abs(moves[..., 2]))


def _terms(shape: tuple[int, int]) -> Array:
    """Products of powers of both places, (rows, columns, terms), over -1 to 1."""
    rows, columns = shape
    v, u = np.linspace(-1, 1, rows)[:, None], np.linspace(-1, 1, columns)[None, :]
    return np.stack([u**i * v**j for i in range(DEGREE + 1) for j in range(DEGREE + 1 - i)], axis=-1)
