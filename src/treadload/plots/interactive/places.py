"""Places that an assessment names, as marks on a map, and where to look from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from treadload.composing import Source
from treadload.plots.kit.plan import KPA, MICRO, MM, fields_of, peak_of, plane
from treadload.plots.kit.style import measure


@dataclass(frozen=True)
class Place:
    """A place that a result names. x, y, depth: m; x or depth None where it names none. text: what is there."""

    x: float | None
    y: float
    text: str
    depth: float | None = None

    def view(self, span: float = 0.12) -> dict[str, list[float]]:
        """Ranges of the axes of linked maps around the place, mm, for `Plotly.relayout`. span: m, of the view."""
        x, y, half = MM * (self.x or 0.0), MM * self.y, MM * span / 2
        # Seen from above: y points down the page.
        return {"xaxis.range": [x - half, x + half], "yaxis.range": [y + half, y - half]}


def places_of(source: Source) -> list[Place]:
    """Places that a result, or its dataset, names: its worst point, largest value, or worst line along travel.

    Of an assessment its worst point; of a contact the largest pressure; of a response the largest extension, in
    space and in the plane, at every depth; of a life the worst y of every criterion, which has no x.
    """
    data = fields_of(source)
    variables: dict[str, Any] = {str(name): variable for name, variable in data.variables.items()}
    if "worst_x" in variables and "worst_strain" in variables:
        strain = float(variables["worst_strain"]) * MICRO
        passes = float(variables["worst_passes"])
        x, y, depth = (float(variables[f"worst_{name}"]) for name in ("x", "y", "depth"))
        how = ", ".join(str(data.attrs[key]) for key in ("strain", "reading") if key in data.attrs)
        text = f"verdict: {measure(strain)} microstrain{f' ({how})' if how else ''}, {passes:.2g} load repetitions"
        return [Place(x, y, text, depth)]
    if "worst_y" in variables and "criterion" in variables:
        years = (
            data["life_years"].to_numpy() if "life_years" in variables else np.full(data.sizes["criterion"], np.nan)
        )
        return [Place(None, float(y), f"{name}: {measure(float(year))} years")
                for name, y, year in zip(data["criterion"].to_numpy().tolist(), data["worst_y"].to_numpy(), years,
                                        strict=True)]  # fmt: skip
    if not {"x", "y"} <= set(variables):
        return []
    across, down = (np.atleast_1d(data[name].to_numpy()) for name in ("x", "y"))
    if "pressure" in variables:
        row, column = peak_of(values := plane(data, "pressure"))
        return [
            Place(
                float(across[column]), float(down[row]), f"largest pressure: {measure(KPA * values[row, column])} kPa"
            )
        ]
    places = []
    for name, words in (("principal_strain_1", "in space"), ("in_plane_strain_1", "in the horizontal plane")):
        for number in range(data.sizes.get("depth", 0) if name in variables else 0):
            row, column = peak_of(values := plane(data.isel(depth=number), name))
            depth = float(data["depth"][number])
            most = measure(MICRO * values[row, column])
            text = f"largest tensile strain {words}, {MM * depth:g} mm deep: {most} microstrain"
            places.append(Place(float(across[column]), float(down[row]), text, depth))
    return places
