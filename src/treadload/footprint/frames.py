"""What a reader of footprints returns: the map of a file, or several, as they stand there."""

from __future__ import annotations

from dataclasses import dataclass, field

from treadload.kernels.arrays import Array


@dataclass(frozen=True, eq=False)
class Frames:
    """Maps of a sensor in the order of its file: rows down the page, columns to the right.

    values: (frames, rows, columns) in the unit of the file, NaN where there is no sensel. row_spacing,
    column_spacing: between rows and between columns, m; None if the file does not state. law: (scale, exponent):
    pressure, Pa, is scale times a value to the power of the exponent; None if nothing states it. calibrated: False
    for counts of a sensor, whose law somebody may know better. saturation, threshold: in the unit of the file; None
    if it does not state. traction_x, traction_y: of the one frame, Pa. x0, y0: of the first cell, where the file has
    coordinates of its own, m. pin: sides of the face of a pin along x and y, m; None of sensels that fill their cell.
    numbers: of the frames, as the file counts them. source: what was read and how, in words. warnings: sentences for
    the user.

    >>> import numpy as np
    >>> frames = tl.footprint.Frames(np.array([[[0.0, 200.0], [300.0, 0.0]]]), 0.01, 0.01)
    >>> frames.values.shape  # frames, rows and columns
    (1, 2, 2)
    """

    values: Array
    row_spacing: float | None = None
    column_spacing: float | None = None
    law: tuple[float, float] | None = None
    calibrated: bool = True
    saturation: float | None = None
    threshold: float | None = None
    traction_x: Array | None = None
    traction_y: Array | None = None
    x0: float | None = None
    y0: float | None = None
    pin: tuple[float, float] | None = None
    numbers: tuple[int, ...] = field(default=())
    source: str = ""
    warnings: tuple[str, ...] = ()
