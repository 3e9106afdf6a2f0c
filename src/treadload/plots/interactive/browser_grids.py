"""What a browser holds of a result, so that it draws by itself what lies along any line."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Mapping, Sequence
from typing import NotRequired, TypedDict

import numpy as np

from treadload.composing import Source, dataset_of
from treadload.deferred import xarray as xr
from treadload.kernels.arrays import Array
from treadload.plots.interactive.section_rows import SectionRows
from treadload.plots.interactive.us_figure import line_in_display_units, values_in_display_units
from treadload.plots.kit.layers import Layers
from treadload.plots.kit.plan import KPA, MICRO, MM, Plan, fields_of, plane
from treadload.plots.kit.shown import shown
from treadload.plots.response import VARIABLE

MOST_HELD = 2_000_000
"""Numbers that a browser is sent to hold of one figure, 8 MB; with more, each line is drawn where it was solved."""


class Grid(TypedDict):
    """x, y: centres, in the unit of the map. fields: (ny, nx) each, as base64 of little-endian single floats, in the
    unit of the figure.

    smooth: read between the centres, or of the cell. step: of points on an oblique line. rows: of a section, see
    `SectionRows.as_lists`.
    """

    x: list[float]
    y: list[float]
    fields: list[str]
    smooth: bool
    step: float
    rows: NotRequired[list[list[float]]]


def profile_held(source: Source, overlaid: Mapping[str, Source] | None = None) -> list[Grid]:
    """Fields whose values along a line are the curves of `profiles`, in their order; a grid for each source."""
    data = fields_of(source)
    plan = Plan.of(data)
    if "pressure" in data:
        grids = [_grid(plan, contact_curves(data), "kPa", smooth=False)]
    else:
        grids = [_grid(plan, response_curves(data), "microstrain", smooth=True)]
    for overlay in (overlaid or {}).values():
        over = fields_of(overlay, "pressure")
        grids.append(_grid(Plan.of(over), [np.nan_to_num(plane(over, "pressure")) * KPA], "kPa", smooth=False))
    return grids


def section_held(response: Source, name: str) -> list[Grid]:
    """Fields, one a depth, from whose values along a line the rows of `depth_slice` are made.

    response: over (depth, y, x).
    """
    data = dataset_of(response)
    order = np.argsort(data["depth"].to_numpy(), kind="stable")
    display = shown(data[name])
    values = data[name].transpose("depth", "y", "x").to_numpy() * display.factor
    rows = SectionRows.of(data["depth"].to_numpy()[order] * MM, Layers.of(data))
    return [{**_grid(Plan.of(data), values[order], display.unit, smooth=True), "rows": rows.as_lists()}]


def held_numbers(grids: Iterable[Grid]) -> int:
    """How many numbers some grids hold."""
    return sum(len(grid["fields"]) * len(grid["x"]) * len(grid["y"]) for grid in grids)


def contact_curves(data: xr.Dataset) -> list[Array]:
    """What `profiles` draws of a contact, as fields, kPa."""
    pressure = np.nan_to_num(plane(data, "pressure")) * KPA
    curves = [pressure]
    if "friction_coefficient" in data or "friction" in data:
        mu = plane(data, "friction_coefficient") if "friction_coefficient" in data else float(data["friction"])
        curves.append(np.nan_to_num(mu) * pressure)
    if "traction_x" in data and "traction_y" in data:
        shear = np.hypot(*(np.nan_to_num(plane(data, name)) for name in ("traction_x", "traction_y"))) * KPA
        curves.append(shear)
        if "state" in data:
            curves.append(np.where(plane(data, "state") == 2, shear, np.nan))
    return curves


def response_curves(data: xr.Dataset) -> list[Array]:
    """What `profiles` draws of a response, as fields, microstrain: by kind of strain, then by depth."""
    return [
        plane(data.isel(depth=row), name) * MICRO for name in VARIABLE.values() for row in range(data.sizes["depth"])
    ]


def _grid(plan: Plan, fields: Sequence[Array] | Array, unit: str, *, smooth: bool) -> Grid:
    x, y, (step,) = (line_in_display_units(at) for at in (plan.x, plan.y, (plan.cell / (2 if smooth else 4),)))
    fields = [values_in_display_units(field, unit) for field in fields]
    return {
        "x": [round(float(value), 5) for value in x], "y": [round(float(value), 5) for value in y],
        "smooth": smooth, "step": step,
        "fields": [base64.b64encode(np.asarray(field, dtype="<f4").tobytes()).decode() for field in fields],
    }  # fmt: skip
