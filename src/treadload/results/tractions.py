"""Contact stresses as a plain table for programs of finite elements: x, y, p, qx, qy of every loaded cell."""

from __future__ import annotations

import io
import os
from pathlib import Path

import numpy as np

from treadload.composing import Source, dataset_of
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.files import check_suffix, write_whole
from treadload.kernels.arrays import Array

TRACTIONS = {".dat": "contact stresses for finite elements", ".txt": "contact stresses for finite elements"}
"""Suffixes of tables of contact stresses."""

# Units of length and stress, and their factors from SI. N, mm, MPa belong together as m, N, Pa do.
UNITS = {"SI": ("m", 1.0, "Pa", 1.0), "mm": ("mm", 1e3, "MPa", 1e-6)}


def write_tractions(
    contact: Source, path: str | os.PathLike[str], *, units: str = "SI", everywhere: bool = False
) -> Path:
    """Write the stresses on the road, a row a cell, columns x y p qx qy, blanks between, under a header of comments.

    contact: a contact or a footprint, with pressure (y, x), Pa; traction_x, traction_y, zero where they are missing.
    units: "SI" (m, Pa) or "mm" (mm, MPa), which go with N. everywhere: True to write cells without load, too, so that
    the rows form a full grid, x fastest. The header, lines that begin with "#", states axes, signs, units, the size
    of the cells, over each of which the stress is uniform, and the forces that the rows add up to. Returns the path.
    Raises InputError for unknown units, a contact without pressure, and uneven cells.

    >>> patch = tl.response.GridLoad.from_arrays([[400e3, 800e3, 400e3]] * 2, spacing=0.05)
    >>> path = tl.results.write_tractions(tl.Footprint(patch), folder / "print.txt", units="mm")
    >>> rows = [line.split() for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    >>> f"{sum(float(row[2]) for row in rows) * 50 * 50 / 1e3:.0f} kN"  # pressure, MPa, on cells of 50 mm
    '8 kN'
    """
    check_suffix(path, TRACTIONS, "contact stresses")
    if units not in UNITS:
        raise InputError(f"units of contact stresses are 'SI' (m, Pa) or 'mm' (mm, MPa), got {units!r}")
    data = dataset_of(contact)
    p, qx, qy = stresses_on_cells(data, path)
    x, y = (data[name].to_numpy().astype(float) for name in ("x", "y"))
    dx, dy = cell_size(x, "x"), cell_size(y, "y")
    length, per_m, stress, per_pa = UNITS[units]
    forces = [float(plane.sum() * dx * dy) for plane in (p, qx, qy)]
    across, down = np.meshgrid(x, y)
    loaded = np.full(p.shape, True) if everywhere else (p != 0) | (qx != 0) | (qy != 0)
    rows = np.stack([per_m * across, per_m * down, per_pa * p, per_pa * qx, per_pa * qy], axis=-1)[loaded]
    head = [
        "contact stresses on the road, written by treadload",
        f"columns: x y p qx qy; x, y in {length}; p, qx, qy in {stress}",
        "x: direction of travel. y: to the right of travel, seen from above. z would point down, into the road.",
        "p: pressure on the road, positive, acts along +z (down). qx, qy: shear exerted by the tire on the road,",
        "positive along +x, +y. A driving wheel has a negative sum of qx.",
        f"x, y: centres of cells of {per_m * dx:.9g} by {per_m * dy:.9g} {length}; the stress is uniform over each.",
        f"cells: {len(rows)}{'' if everywhere else ', those with load'}; rows run along x first.",
        f"sum over the cells, N: p {forces[0]:.9g}, qx {forces[1]:.9g}, qy {forces[2]:.9g}",
    ]
    stream = io.StringIO()
    stream.writelines(f"# {line}\n" for line in head)
    np.savetxt(stream, rows, fmt="%.9e")
    return write_whole(path, stream.getvalue())


def stresses_on_cells(data: xr.Dataset, path: str | os.PathLike[str]) -> tuple[Array, Array, Array]:
    """Pressure and both shears of a contact (ny, nx), Pa, zero where they are missing. Raises InputError.

    path: of what shall be written, for the error.
    """
    if "pressure" not in data or not {"x", "y"} <= set(data["pressure"].dims):
        raise InputError(f"cannot write {path}: contact stresses need the pressure of a contact over x and y")
    shape = data.sizes["y"], data.sizes["x"]
    p, qx, qy = (
        np.nan_to_num(data[name].transpose("y", "x").to_numpy().astype(float)) if name in data else np.zeros(shape)
        for name in ("pressure", "traction_x", "traction_y")
    )
    return p, qx, qy


def cell_size(values: Array, name: str) -> float:
    """The distance of even centres of cells (n,), m. name: of their axis, for the error. Raises InputError."""
    steps = np.diff(values)
    if not len(steps) or np.ptp(steps) > 1e-6 * abs(steps.mean()):
        raise InputError(
            f"contact stresses need cells of one size, those along {name} differ; interpolate them first"
        )
    return float(steps.mean())
