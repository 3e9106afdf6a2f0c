"""Tables of points and plain matrices: read as recorded loads are, but with every unit stated."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from treadload.errors import InputError
from treadload.footprint.frames import Frames
from treadload.footprint.spelling import pressure_factor
from treadload.response import measured
from treadload.tables import read_table

_STRESSES = ("pressure", "traction_x", "traction_y")


def read(
    path: Path,
    *,
    spacing: float | str | tuple[float | str, float | str] | None = None,
    units: Mapping[str, str] | None = None,
    decimal: str | None = None,
    noise: float | str = 0.0,
    counts: bool = False,
) -> Frames:
    """The one frame of a text file: a matrix of pressures, or a table with x, y, pressure and perhaps shear.

    spacing: of a matrix, m or a text, or (dx, dy) of columns and rows. units: {"pressure": "kPa"}, for what the file
    names no unit of. noise: as `measured.read_csv` takes it. counts: a matrix may have no unit, its values are to be
    calibrated. Raises InputError for a unit that is not stated, and as `measured.read_csv`.
    """
    units_by_name = dict(units or {})
    for name in _STRESSES:
        if name in units_by_name:
            # Spelled as sensors do, "kg/cm2".
            units_by_name[name] = f"{pressure_factor(units_by_name[name])!r} Pa"
    is_table = read_table(path, decimal=decimal).has_header
    bare = counts and "pressure" not in units_by_name and not is_table
    try:
        recorded = measured.read_csv(
            path,
            spacing=spacing,
            units=units_by_name,
            missing="keep",
            noise=0.0 if bare else noise,
            decimal=decimal,
            strict=not bare,
        )
    except InputError as error:
        if "noise= gives" not in str(error):
            raise
        raise InputError(str(error).replace("noise= gives", "threshold= gives")) from error
    grid, source = recorded.grid, recorded.source
    if units and "pressure" in units:
        source = source.replace(units_by_name["pressure"], units["pressure"])
    return Frames(
        recorded.pressure[None],
        grid.dy,
        grid.dx,
        None if bare else (1.0, 1.0),
        not bare,
        traction_x=None if recorded.traction_x is None else np.nan_to_num(recorded.traction_x),
        traction_y=None if recorded.traction_y is None else np.nan_to_num(recorded.traction_y),
        x0=grid.x0 if is_table else None,
        y0=grid.y0 if is_table else None,
        source=source.replace("pressure in Pa", "counts") if bare else source,
    )
