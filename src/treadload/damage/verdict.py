"""The verdict: where a road cracks first, which way, and after how many passes."""

from __future__ import annotations

import importlib
import json
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from treadload import variables
from treadload.damage.direction import (
    NONE,
    OBLIQUE_TOLERANCE,
    ORIENTATIONS,
    READINGS,
    HasDataset,
    Reading,
    check_reading,
    check_tolerance,
    crack_plane,
    extension,
    gridded,
    orientation,
)
from treadload.damage.fatigue import SUBGRADE, TENSION, FatigueLine, PowerLaw, warnings_of
from treadload.describing import first_line
from treadload.errors import InputError
from treadload.kernels.depths import same_depth


@dataclass(frozen=True, eq=False)
class Verdict:
    """What a law of fatigue says of a strain field.

    dataset: fields (y, x) extension_strain, allowable_passes, crack_angle, crack_dip, crack_orientation;
    scalars worst_*; NaN angle and dip where nothing extends. line: the law of fatigue. strain: the strain
    that the verdict reads, "principal" (three-dimensional) or "in-plane" (horizontal plane).
    """

    dataset: xr.Dataset
    line: PowerLaw
    strain: str

    @property
    def plot(self) -> Any:
        """Figures of this verdict: see treadload.plots.VerdictPlots."""
        return importlib.import_module("treadload.plots").VerdictPlots(self)

    @property
    def orientation(self) -> str:
        """Orientation of the crack at the worst point, in a word of `ORIENTATIONS`."""
        data = self.dataset
        if data["worst_strain"] <= 0:
            return ORIENTATIONS[NONE]
        worst = data["crack_orientation"].sel(x=data["worst_x"], y=data["worst_y"])
        return ORIENTATIONS[int(worst)]

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences for the user: numbers of the law without a source, extrapolation."""
        return tuple(json.loads(self.dataset.attrs["warnings"]))

    def summary(self) -> str:
        """Worst strain and place, both readings of the strain, passes, the way of the crack, and a verdict."""
        data = self.dataset
        depth, read = float(data.attrs["depth"]), READINGS[self.strain]
        strain, passes = float(data["worst_strain"]), float(data["worst_passes"])
        lines = [
            f"{self.line}, read with the {read} strain at depth {depth * 1e3:g} mm",
            f"largest extension, three-dimensional: {data.attrs['largest_principal_strain'] * 1e6:.1f} microstrain",
            f"largest extension, horizontal plane:  {data.attrs['largest_in_plane_strain'] * 1e6:.1f} microstrain",
        ]
        if strain <= 0:
            lines += [f"warning: {text}" for text in self.warnings]
            return "\n".join([*lines, "Verdict: nothing extends here; this criterion sees no crack."])
        million = "ε₆" if isinstance(self.line, FatigueLine) else "what allows a million passes"
        angle, dip = float(data["worst_crack_angle"]), float(data["worst_crack_dip"])
        against = f"{strain * 1e6:.1f} microstrain is {strain / self.line.at_a_million:.2f} of {million}"
        lines += [
            f"worst point: x = {float(data['worst_x']) * 1e3:.1f} mm, y = {float(data['worst_y']) * 1e3:.1f} mm; "
            f"{against}",
            f"crack: {_crack_in_words(self.orientation, angle, dip)}",
            f"allowable passes: {passes:.3g}",
            *(f"warning: {text}" for text in self.warnings),
        ]
        name = "fatigue line" if isinstance(self.line, FatigueLine) else "law of fatigue"
        few = "fewer" if passes < 1e6 else "more"
        lines.append(
            f"Verdict: the {name} allows {passes:.2g} passes at the worst point, {few} than a million; "
            f"{_article(self.orientation)} {self.orientation} crack is the first to expect."
        )
        return "\n".join(lines)

    def __str__(self) -> str:
        return self.summary()

    __repr__ = first_line


def assess(
    response: HasDataset,
    line: PowerLaw,
    *,
    depth: float = 0.0,
    strain: Reading = "principal",
    oblique_tolerance: float = OBLIQUE_TOLERANCE,
) -> Verdict:
    """Where and which way a road cracks under repeated passes of a load.

    A crack opens across the largest extension: its plane is perpendicular to that direction, and its trace
    on the surface is perpendicular to the direction's horizontal projection.

    response: with principal_strain_1, principal_direction_1, in_plane_strain_1 and in_plane_angle_1 over
    (depth, y, x). line: fatigue line or another law that reads an extension. depth: one of the response's depths, m.
    strain: "principal" reads the three-dimensional extension, which at the surface contains the shear of
    the load itself; "in-plane" the largest in the horizontal plane, whose cracks are vertical.
    oblique_tolerance: rad, in (0, π/4]. A trace within it of the direction of travel is longitudinal, within
    it of across transverse, else oblique; an extension within it of the vertical opens a horizontal crack.
    At the surface the extension peaks at rib edges and at the rear of the slip zone, where the exact field
    has roots and logarithms: the largest value still grows as the cells of the contact shrink.
    Returns a Verdict. Raises InputError for an unknown depth, strain or tolerance.
    """
    check_reading(strain)
    check_tolerance(oblique_tolerance)
    if line.quantity in (SUBGRADE, TENSION):
        raise InputError(
            f"a verdict reads an extension, but {line} reads the {line.quantity}; take a law of extension"
        )
    plane = _plane(gridded(response), depth)
    largest, direction = extension(plane, strain)
    crack_angle, dip = crack_plane(direction)
    opens = largest > 0
    crack_angle, dip = np.where(opens, crack_angle, np.nan), np.where(opens, dip, np.nan)
    passes = line.allowable_passes(largest)
    row, column = np.unravel_index(int(np.nanargmax(largest)), largest.shape)
    dims, none = ("y", "x"), ()
    fields: dict[str, tuple[tuple[str, ...], object]] = {
        "extension_strain": (dims, largest),
        "allowable_passes": (dims, passes),
        "crack_angle": (dims, crack_angle),
        "crack_dip": (dims, dip),
        "crack_orientation": (dims, orientation(crack_angle, dip, oblique_tolerance)),
        "worst_x": (none, float(plane["x"][column])),
        "worst_y": (none, float(plane["y"][row])),
        "worst_strain": (none, largest[row, column]),
        "worst_passes": (none, passes[row, column]),
        "worst_crack_angle": (none, crack_angle[row, column]),
        "worst_crack_dip": (none, dip[row, column]),
    }
    dataset = variables.dataset(
        fields,
        {"y": plane["y"].to_numpy(), "x": plane["x"].to_numpy()},
        depth=float(plane["depth"]),
        strain=strain,
        law=str(line),
        epsilon_6=line.at_a_million,
        slope=line.exponent,
        oblique_tolerance=oblique_tolerance,
        largest_principal_strain=float(plane["principal_strain_1"].max()),
        largest_in_plane_strain=float(plane["in_plane_strain_1"].max()),
        warnings=json.dumps(warnings_of(line, largest), ensure_ascii=False),
    )
    return Verdict(dataset, line, strain)


def _plane(data: xr.Dataset, depth: float) -> xr.Dataset:
    depths = data["depth"].to_numpy()
    nearest = int(np.argmin(np.abs(depths - depth)))
    if not same_depth(depths[nearest], depth):
        known = ", ".join(f"{d:g}" for d in depths)
        raise InputError(f"the response has no depth {depth:g} m, it has {known} m; solve it with that depth")
    return data.isel(depth=nearest).transpose("y", "x", ...)


def _crack_in_words(name: str, angle: float, dip: float) -> str:
    if name == "horizontal":
        return f"horizontal, as when layers part (dip {math.degrees(dip):.0f}° from the horizontal)"
    side = "right" if angle > 0 else "left"
    turned = f"{abs(math.degrees(angle)):.0f}° from travel" + (f" to the {side}" if name == "oblique" else "")
    return f"{name}, its trace {turned}, its plane {math.degrees(dip):.0f}° from the horizontal"


def _article(word: str) -> str:
    return "an" if word[0] in "aeiou" else "a"
