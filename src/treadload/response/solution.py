"""The response of a road: stress and strain, and what to read in them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar, Literal

import numpy as np
import xarray as xr

from treadload.composing import BaseResult, Holds
from treadload.describing import first_line
from treadload.pavement import Pavement
from treadload.response.fields import angle_in_words, direction_in_words, layer_in_words
from treadload.response.loads import PlacedLoad


@dataclass(frozen=True, eq=False)
class Response(BaseResult, group="response"):
    """Stress and strain in a road.

    dataset: fields (depth, y, x), or (depth, point) of a list of points, with the names of `treadload.variables`; its
    attributes hold the material. stats: seconds spent, points evaluated, method ("fft", "precorrected", "direct",
    "disc", "layered" or several, "none" without load). warnings: sentences for the user. loads, road, speed, side:
    the question, so that more can be asked of the same road; no road for fields that come from elsewhere. restrained:
    stress that was added to both horizontal normal stresses, Pa, one per depth; empty where none was, see
    `add_thermal_stress`.
    """

    # On a grid, or at a list of points.
    holds: ClassVar[Holds] = Holds(
        {
            "depth": "depth",
            "x y": "...",
            "principal_strain_1 in_plane_strain_1 in_plane_angle_1": "depth ...",
            "principal_direction_1": "depth component ...",
        },
        known="principal_strain_1 in_plane_strain_1",
        maybe_numbers="mean_over",
        sizes={"component": (3, 3)},
    )

    dataset: xr.Dataset
    stats: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    loads: tuple[PlacedLoad, ...] = ()
    road: Pavement | None = None
    speed: float | None = None
    side: Literal["above", "below"] = "above"
    restrained: tuple[float, ...] = ()

    @property
    def group_name(self) -> str:
        """What its points are: a map, a section along or across travel, a line of the surface, a list."""
        size = self.dataset.sizes
        if "point" in size:
            return "points"
        if size["depth"] == 1 and size["y"] == 1 and size["x"] > 1:
            return "bowl"
        if size["y"] == 1 and size["x"] > 1:
            return "slice_along"
        return "slice_across" if size["x"] == 1 and size["y"] > 1 else self.group

    def summary(self) -> str:
        """Largest extension at each depth, three-dimensional and in the horizontal plane, with its place."""
        data = self.dataset
        lines = [
            f"response of a road, {data.attrs.get('road', 'unnamed')}; "
            f"{data.sizes['depth']} depth(s) of {_count(data)} points"
            + (f"; means over {data.attrs['mean_over'] * 1e3:g} mm" if "mean_over" in data.attrs else "")
        ]
        for row, depth in enumerate(data["depth"].values):
            plane = data.isel(depth=row)
            side = layer_in_words(plane)
            lines.append(f"depth {depth * 1e3:g} mm{f' ({side})' if side else ''}, largest extension strain")
            if plane[["principal_strain_1", "in_plane_strain_1"]].isnull().all().to_array().any():
                lines.append("  unknown: it is NaN everywhere")
                continue
            where = _largest(plane["principal_strain_1"])
            words = direction_in_words(plane["principal_direction_1"].isel(where).to_numpy())
            lines.append(f"  three-dimensional: {_at(plane['principal_strain_1'].isel(where), words)}")
            where = _largest(plane["in_plane_strain_1"])
            words = angle_in_words(float(plane["in_plane_angle_1"].isel(where)))
            lines.append(f"  horizontal plane:  {_at(plane['in_plane_strain_1'].isel(where), words)}")
        return "\n".join(lines + [f"warning: {text}" for text in self.warnings])

    __repr__ = first_line


def _largest(values: xr.DataArray) -> dict[str, int]:
    place = np.unravel_index(int(np.nanargmax(values.to_numpy())), values.shape)
    return dict(zip(map(str, values.dims), map(int, place), strict=True))


def _count(data: xr.Dataset) -> str:
    return str(data.sizes["point"]) if "point" in data.sizes else f"{data.sizes['x']} x {data.sizes['y']}"


def _at(value: xr.DataArray, direction: str) -> str:
    strain = float(value)
    if strain <= 0:
        return f"none (at most {strain * 1e6:.3g} microstrain)"
    return (
        f"{strain * 1e6:.1f} microstrain at x = {_mm(float(value['x']))} mm, "
        f"y = {_mm(float(value['y']))} mm, {direction}"
    )


def _mm(metres: float) -> str:
    # + 0.0: no "-0.0" for round-off.
    return f"{round(metres * 1e3, 1) + 0.0:.1f}"
