"""Footprints that are made up: a tread of ribs, a sensor that sees it, and the file that its program exports."""

import numpy as np

from treadload.footprint import Footprint
from treadload.grid import Grid
from treadload.kernels.gridding.overlap import means_over_cells
from treadload.response import GridLoad


def ribbed(nx=48, ny=42, cell=5.4e-3, load=35e3, tilt=(1.2, 0.9)):
    """Four ribs under a dome of pressure that leans forward and to the right, so that no image of it is itself."""
    grid = Grid.centred(nx * cell, ny * cell, cell)
    x, y = np.meshgrid(grid.x, grid.y)
    half, wide = 0.42 * nx * cell, 0.44 * ny * cell
    dome = np.sqrt(np.maximum(1 - (x / half) ** 2 - 0.3 * (y / wide) ** 2, 0.0)) * (np.abs(y) < wide)
    groove = np.zeros_like(dome, dtype=bool)
    for middle in (-0.45, 0.0, 0.5):
        groove |= np.abs(y - middle * wide) < 0.07 * wide
    pressure = np.where(groove, 0.0, dome * np.maximum(1 + tilt[0] * x + tilt[1] * y, 0.0))
    return GridLoad(grid, pressure * load / (pressure.sum() * grid.cell_area))


def edges(grid):
    return [np.concatenate([a - 0.5 * d, [a[-1] + 0.5 * d]]) for a, d in ((grid.x, grid.dx), (grid.y, grid.dy))]


def sensed(load, *, pitch=8e-3, cells=(38, 33), shift=(0.0, 0.0), angle=0.0, noise=0.0, threshold=0.0,
           saturation=np.inf, turns=0, mirrored=False, seed=1):  # fmt: skip
    """What a sensor states of a load.

    shift: of its middle, m. angle: of its axes, rad. turns, mirrored: of its print.
    """
    nx, ny = cells
    grid = Grid(nx, ny, pitch, pitch, shift[0] - 0.5 * (nx - 1) * pitch, shift[1] - 0.5 * (ny - 1) * pitch)
    seen = means_over_cells(load.pressure, *edges(load.grid), *edges(grid), angle)
    seen = seen * (1 + noise * np.random.default_rng(seed).standard_normal(seen.shape))
    seen = np.where(seen < threshold, 0.0, np.clip(seen, 0.0, saturation))
    seen = np.rot90(seen, -turns)
    seen = seen[::-1] if mirrored else seen
    return Footprint(GridLoad.from_arrays(seen, spacing=pitch), threshold=threshold, saturation=saturation)


def tekscan(frames, *, units="kPa", pitch="0.5 cm", lines=(), without=(), end="\r\n", digits="%g", movie=""):
    """The text of an export. frames: (rows, columns) each, NaN for no sensel. lines: more of the header."""
    rows, columns = np.shape(frames[0])
    header = {
        "DATA_TYPE": "MOVIE",
        "VERSION": "Tekscan Pressure Measurement System 5.90I",
        "SENSOR_TYPE": "5400N",
        "ROWS": rows,
        "COLS": columns,
        "ROW_SPACING": pitch,
        "COL_SPACING": pitch,
        "START_FRAME": 1,
        "END_FRAME": len(frames),
        "UNITS": units,
        "MIRROR_ROW": 0,
        "MIRROR_COL": 0,
    }
    header.update(dict(line.split(" ", 1) for line in lines))
    text = [f"{key} {value}" for key, value in header.items() if key not in without and value is not None]
    text.append("ASCII_DATA @@")
    for number, frame in enumerate(frames, start=1):
        text += ["", f"Frame {number}{movie}"]
        text += [",".join("B" if np.isnan(value) else digits % value for value in row) for row in frame]
    return end.join([*text, "@@", ""])
