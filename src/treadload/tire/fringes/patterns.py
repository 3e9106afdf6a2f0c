"""What is asked of a measurement with fringes: the pictures, and how they are evaluated."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.tire.fringes.calibration import CameraProjector, ReferencePlane

# Modulation below this share of the camera's range is shadow.
SHADOW = 0.04
STEEPEST = math.radians(70)


@dataclass(frozen=True, eq=False)
class Pattern:
    """Pictures of one fringe pattern, each (n, rows, columns) in grey levels, step by step.

    fringes: periods over the width of the projector. tread: of the tire. reference: of the empty reference plane,
    and planes: of planes at the heights of a `ReferencePlane`; of neither for a `CameraProjector`. shifts: of the
    steps, rad; left out, equal parts of a turn.
    """

    fringes: float
    tread: Array
    reference: Array | None = None
    planes: tuple[Array, ...] = ()
    shifts: tuple[float, ...] | None = None

    def __post_init__(self) -> None:
        positive("fringes over the projector", self.fringes)
        for name, pictures in (
            ("tread", self.tread),
            ("reference", self.reference),
            *(("planes", p) for p in self.planes),
        ):
            if pictures is None:
                continue
            if pictures.ndim != 3:
                raise InputError(
                    f"pictures of a pattern must be (steps, rows, columns), got {pictures.shape} for {name}"
                )
            if pictures.shape != self.tread.shape:
                raise InputError(
                    f"the pattern of {self.fringes:g} fringes has {_of(self.tread)} of the tread and "
                    f"{_of(pictures)} of the {name}; take the same steps with the same camera"
                )


@dataclass(frozen=True)
class Evaluation:
    """How pictures are evaluated.

    saturation: grey level at which the camera is full; left out, the largest that the pixels' type holds. shadow:
    modulation, as a share of the saturation, below which a pixel is given up. noise: standard deviation of a grey
    level; left out, from what four or more steps leave over. gamma: of the projector, a number, or "auto", from its
    second harmonic. contrast: of the fringes sent to the projector. steepest: slope, rad, at which neighbours are
    taken for a wall and given up. anchor: row, column and height, m, of a place, which one pattern alone needs;
    travel: where the wheel goes in the picture (of a `ReferencePlane`; right is x and up is y of the frame of a
    `CameraProjector`). spacing: cells of the height map, m; left out, a pixel on the plane, or one and a half in
    perspective.
    """

    saturation: float | None = None
    shadow: float = SHADOW
    noise: float | None = None
    gamma: float | Literal["auto"] = 1.0
    contrast: float = 1.0
    steepest: float = STEEPEST
    anchor: tuple[int, int, float] | None = None
    travel: str = "right"
    spacing: float | None = None

    def __post_init__(self) -> None:
        for name in ("saturation", "noise", "spacing"):
            value = getattr(self, name)
            if value is not None:
                positive(name, value)
        if not 0 < self.shadow < 0.5:
            raise InputError(f"shadow must lie between 0 and 0.5 of the saturation, got {self.shadow:g}; {SHADOW}")
        if not 0 < self.steepest < math.pi / 2:
            raise InputError(f"steepest must lie between 0 and π/2 rad, got {self.steepest:g}")


def check(patterns: Sequence[Pattern], calibration: ReferencePlane | CameraProjector, evaluation: Evaluation) -> None:
    """Refuse pictures that do not belong together, or to the calibration. Raises InputError."""
    if not patterns:
        raise InputError("give pictures of one pattern of fringes or more")
    shape = patterns[0].tread.shape[1:]
    for pattern in patterns:
        if pattern.tread.shape[1:] != shape:
            raise InputError(
                f"patterns of {pattern.tread.shape[2]} x {pattern.tread.shape[1]} and {shape[1]} x {shape[0]} "
                "pixels do not belong together; take all with one camera"
            )
        if isinstance(calibration, ReferencePlane):
            if pattern.reference is None:
                raise InputError(
                    f"the pattern of {pattern.fringes:g} fringes lacks its pictures of the reference plane"
                )
            if len(pattern.planes) != len(calibration.heights):
                raise InputError(
                    f"the pattern of {pattern.fringes:g} fringes has {len(pattern.planes)} planes, but the "
                    f"calibration names {len(calibration.heights)} heights"
                )
    if len(patterns) == 1 and isinstance(calibration, CameraProjector) and patterns[0].fringes > 1:
        raise InputError(
            "a camera and a projector need the fringe of every pixel: add patterns, such as 1 and 8 fringes, to it"
        )
    if len(patterns) == 1 and isinstance(calibration, ReferencePlane) and evaluation.anchor is None:
        raise InputError(
            "one pattern alone leaves the height open by whole fringes: give anchor = row, column and height of a "
            "place, to half a fringe, or add patterns of other fringe counts"
        )


def full_level(pictures: Array) -> float | None:
    """The largest grey level of whole numbers; unknown for fractions."""
    kind: Any = pictures.dtype
    return float(np.iinfo(kind).max) if kind.kind in "ui" else None


def least_modulation(patterns: Sequence[Pattern], evaluation: Evaluation) -> float:
    """Modulation, grey levels, below which a pixel is in shadow."""
    tread = patterns[-1].tread
    return evaluation.shadow * (evaluation.saturation or full_level(tread) or float(tread.max()))


def _of(pictures: Array) -> str:
    return f"{pictures.shape[0]} pictures of {pictures.shape[2]} x {pictures.shape[1]} pixels"
