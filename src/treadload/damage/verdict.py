"""The verdict: where a road cracks first, which way, and after how many passes."""

from __future__ import annotations

import importlib
import math
from dataclasses import dataclass
from typing import Any, Literal, Protocol

import numpy as np
import xarray as xr

from treadload import variables
from treadload.damage.fatigue import FatigueLine
from treadload.errors import InputError
from treadload.kernels.arrays import Array

# Values of `crack_orientation`.
ORIENTATIONS = ("none", "longitudinal", "transverse", "oblique", "horizontal")
_NONE, _LONGITUDINAL, _TRANSVERSE, _OBLIQUE, _HORIZONTAL = range(5)
# Depths of a response are met to within this, m: round-off of a file or of a unit.
_SAME_DEPTH = 1e-9


class _HasDataset(Protocol):
    @property
    def dataset(self) -> xr.Dataset: ...


@dataclass(frozen=True, eq=False)
class Verdict:
    """What a fatigue line says of a strain field.

    dataset: fields (y, x) extension_strain, allowable_passes, crack_angle, crack_dip, crack_orientation;
    scalars worst_*; NaN angle and dip where nothing extends. line: the fatigue line. strain: the strain
    that the verdict reads, "principal" (three-dimensional) or "in-plane" (horizontal plane).
    """

    dataset: xr.Dataset
    line: FatigueLine
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
            return ORIENTATIONS[_NONE]
        worst = data["crack_orientation"].sel(x=data["worst_x"], y=data["worst_y"])
        return ORIENTATIONS[int(worst)]

    def summary(self) -> str:
        """Worst strain and place, both readings of the strain, passes, the way of the crack, and a verdict."""
        data = self.dataset
        depth, read = float(data.attrs["depth"]), _NAMES[self.strain]
        strain, passes = float(data["worst_strain"]), float(data["worst_passes"])
        lines = [
            f"{self.line}, read with the {read} strain at depth {depth * 1e3:g} mm",
            f"largest extension, three-dimensional: {data.attrs['largest_principal_strain'] * 1e6:.1f} microstrain",
            f"largest extension, horizontal plane:  {data.attrs['largest_in_plane_strain'] * 1e6:.1f} microstrain",
        ]
        if strain <= 0:
            return "\n".join([*lines, "Verdict: nothing extends here; this criterion sees no crack."])
        angle, dip = float(data["worst_crack_angle"]), float(data["worst_crack_dip"])
        against = f"{strain * 1e6:.1f} microstrain is {strain / self.line.epsilon_6:.2f} of ε₆"
        lines += [
            f"worst point: x = {float(data['worst_x']) * 1e3:.1f} mm, y = {float(data['worst_y']) * 1e3:.1f} mm; "
            f"{against}",
            f"crack: {_crack_in_words(self.orientation, angle, dip)}",
            f"allowable passes: {passes:.3g}",
        ]
        few = "fewer" if passes < 1e6 else "more"
        lines.append(
            f"Verdict: the fatigue line allows {passes:.2g} passes at the worst point, {few} than a million; "
            f"{_article(self.orientation)} {self.orientation} crack is the first to expect."
        )
        return "\n".join(lines)

    def __str__(self) -> str:
        return self.summary()


def assess(
    response: _HasDataset,
    line: FatigueLine,
    *,
    depth: float = 0.0,
    strain: Literal["principal", "in-plane"] = "principal",
    oblique_tolerance: float = math.radians(15),
) -> Verdict:
    """Where and which way a road cracks under repeated passes of a load.

    A crack opens across the largest extension: its plane is perpendicular to that direction, and its trace
    on the surface is perpendicular to the direction's horizontal projection.

    response: with principal_strain_1, principal_direction_1, in_plane_strain_1 and in_plane_angle_1 over
    (depth, y, x). line: of the material at that depth. depth: one of the response's depths, m.
    strain: "principal" reads the three-dimensional extension, which at the surface contains the shear of
    the load itself; "in-plane" the largest in the horizontal plane, whose cracks are vertical.
    oblique_tolerance: rad, in (0, π/4]. A trace within it of the direction of travel is longitudinal, within
    it of across transverse, else oblique; an extension within it of the vertical opens a horizontal crack.
    At the surface the extension peaks at rib edges and at the rear of the slip zone, where the exact field
    has roots and logarithms: the largest value still grows as the cells of the contact shrink.
    Returns a Verdict. Raises InputError for an unknown depth, strain or tolerance.
    """
    if strain not in _NAMES:
        raise InputError(f'strain must be "principal" or "in-plane", got {strain!r}')
    if not 0 < oblique_tolerance <= math.pi / 4:
        raise InputError(f"oblique_tolerance must lie in (0, π/4] rad, got {oblique_tolerance}")
    plane = _plane(response.dataset, depth)
    principal, in_plane = (plane[name].to_numpy() for name in ("principal_strain_1", "in_plane_strain_1"))
    if strain == "principal":
        extension, direction = principal, plane["principal_direction_1"].transpose("y", "x", "component").to_numpy()
    else:
        extension, angle = in_plane, plane["in_plane_angle_1"].to_numpy()
        direction = np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=-1)

    crack_angle, dip = crack_plane(direction)
    opens = extension > 0
    crack_angle, dip = np.where(opens, crack_angle, np.nan), np.where(opens, dip, np.nan)
    passes = line.allowable_passes(extension)
    row, column = np.unravel_index(int(np.nanargmax(extension)), extension.shape)
    dims, none = ("y", "x"), ()
    fields: dict[str, tuple[tuple[str, ...], object]] = {
        "extension_strain": (dims, extension),
        "allowable_passes": (dims, passes),
        "crack_angle": (dims, crack_angle),
        "crack_dip": (dims, dip),
        "crack_orientation": (dims, orientation(crack_angle, dip, oblique_tolerance)),
        "worst_x": (none, float(plane["x"][column])),
        "worst_y": (none, float(plane["y"][row])),
        "worst_strain": (none, extension[row, column]),
        "worst_passes": (none, passes[row, column]),
        "worst_crack_angle": (none, crack_angle[row, column]),
        "worst_crack_dip": (none, dip[row, column]),
    }
    dataset = variables.dataset(
        fields,
        {"y": plane["y"].to_numpy(), "x": plane["x"].to_numpy()},
        depth=float(plane["depth"]),
        strain=strain,
        epsilon_6=line.epsilon_6,
        slope=line.slope,
        oblique_tolerance=oblique_tolerance,
        largest_principal_strain=float(np.nanmax(principal)),
        largest_in_plane_strain=float(np.nanmax(in_plane)),
    )
    return Verdict(dataset, line, strain)


def crack_plane(direction: Array) -> tuple[Array, Array]:
    """Angle of the trace and dip of the plane perpendicular to a unit vector (..., 3).

    Returns the angle of the trace from travel towards the right, rad, in (-π/2, π/2], and the dip from the
    horizontal, rad, in [0, π/2]. A vertical direction has dip 0 and no trace: its angle is NaN.
    """
    x, y, z = direction[..., 0], direction[..., 1], direction[..., 2]
    flat = np.hypot(x, y)
    # The trace lies along (-y, x); a line has no sense, so the half turn that points backwards is folded.
    angle = np.arctan2(x, -y)
    angle = np.where(angle > np.pi / 2, angle - np.pi, np.where(angle <= -np.pi / 2, angle + np.pi, angle))
    return np.where(flat > 0, angle, np.nan), np.arctan2(flat, np.abs(z))


def orientation(angle: Array, dip: Array, tolerance: float) -> Array:
    """Codes of `ORIENTATIONS` (...) from the angle of the trace and the dip (...), rad; none where dip is NaN."""
    steep = np.abs(angle)
    code = np.full(np.shape(dip), _OBLIQUE, dtype=np.int8)
    code = np.where(steep <= tolerance, _LONGITUDINAL, code)
    code = np.where(steep >= math.pi / 2 - tolerance, _TRANSVERSE, code)
    code = np.where(dip <= tolerance, _HORIZONTAL, code)
    codes: Array = np.where(np.isnan(dip), _NONE, code).astype(np.int8)
    return codes


_NAMES = {"principal": "three-dimensional", "in-plane": "in-plane"}


def _plane(data: xr.Dataset, depth: float) -> xr.Dataset:
    depths = data["depth"].to_numpy()
    nearest = int(np.argmin(np.abs(depths - depth)))
    if not abs(depths[nearest] - depth) <= _SAME_DEPTH:
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
