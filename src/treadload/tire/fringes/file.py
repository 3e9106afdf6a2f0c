"""A measurement with fringes as a TOML file that names its pictures."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from treadload.errors import InputError
from treadload.files import parse_toml, text_of
from treadload.tire.fringes.calibration import CameraProjector, ReferencePlane
from treadload.tire.fringes.measure import FringeScan, measure_fringes
from treadload.tire.fringes.patterns import SHADOW, STEEPEST, Evaluation, Pattern
from treadload.tire.fringes.pictures import read_pictures
from treadload.units import Angle, Length, Number

Pictures = str | tuple[str, ...]


@dataclass(frozen=True)
class PatternFile:
    """Pictures of one fringe pattern.

    fringes: periods over the width of the projector. tread: pictures of the tire, one a step: a list of files, a text
    with "*" whose files are numbered, or a .npy of (steps, rows, columns). reference: of the empty plane. planes: of
    planes at the heights of the calibration. shifts: of the steps; left out, equal parts of a turn. steps: how many
    pictures there must be.
    """

    fringes: Number
    tread: Pictures
    reference: Pictures | None = None
    planes: tuple[Pictures, ...] = ()
    shifts: tuple[Angle, ...] | None = None
    steps: int | None = None

    def read(self, folder: Path) -> Pattern:
        """Its pictures."""
        steps = len(self.shifts) if self.steps is None and self.shifts is not None else self.steps
        about = f"pattern of {self.fringes:g} fringes"
        tread = read_pictures(self.tread, folder, f"{about}, tread", steps)
        reference = self.reference
        plane = None if reference is None else read_pictures(reference, folder, f"{about}, reference", steps)
        planes = [
            read_pictures(plane, folder, f"{about}, plane {k + 1}", steps) for k, plane in enumerate(self.planes)
        ]
        return Pattern(self.fringes, tread, plane, tuple(planes), self.shifts)


@dataclass(frozen=True)
class Anchor:
    """A place of known height. row, column: of the picture, from 0. height: above the reference plane."""

    row: int
    column: int
    height: Length


@dataclass(frozen=True)
class FringeFile:
    """`treadload scan fringes.toml`: pictures of a tread under fringes, and what makes heights of them.

    patterns: of different fringe counts; one alone needs an anchor. reference_plane, projector: exactly one, the
    calibration. The other keys are those of `Evaluation`. title: free text.
    """

    patterns: tuple[PatternFile, ...]
    reference_plane: ReferencePlane | None = None
    projector: CameraProjector | None = None
    title: str = ""
    saturation: Number | None = None
    shadow: Number = SHADOW
    noise: Number | None = None
    gamma: Number | Literal["auto"] = 1.0
    contrast: Number = 1.0
    steepest: Angle = STEEPEST
    anchor: Anchor | None = None
    travel: Literal["right", "left", "up", "down"] = "right"
    spacing: Length | None = None

    @property
    def calibration(self) -> ReferencePlane | CameraProjector:
        """The one that is given. Raises InputError."""
        models = [model for model in (self.reference_plane, self.projector) if model is not None]
        if len(models) != 1:
            raise InputError(
                f"a measurement with fringes has [reference_plane] or [projector], one of them, got {len(models)}"
            )
        return models[0]

    def evaluation(self) -> Evaluation:
        """How the pictures are evaluated."""
        at = None if self.anchor is None else (self.anchor.row, self.anchor.column, self.anchor.height)
        return Evaluation(
            self.saturation,
            self.shadow,
            self.noise,
            self.gamma,
            self.contrast,
            self.steepest,
            at,
            self.travel,
            self.spacing,
        )


def read_fringes(path: str | os.PathLike[str]) -> FringeScan:
    """Height map of the measurement that a TOML file names; pictures start from its folder.

    Raises InputError that names file and key, and what `read_pictures` and `measure_fringes` raise.
    """
    # pydantic is loaded when a file is read, not before.
    from treadload.read import read

    file = Path(path)
    text = text_of(file, "a TOML file that names the pictures")
    fringe_file: FringeFile = read(FringeFile, parse_toml(text, str(file)), str(file), folder=file.parent)
    calibration, evaluation = fringe_file.calibration, fringe_file.evaluation()
    return measure_fringes([pattern.read(file.parent) for pattern in fringe_file.patterns], calibration, evaluation)
