"""Uniform discs that stand for a contact in programs that know no other load, and what is lost with them."""

from __future__ import annotations

import csv
import io
import math
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np

from treadload.composing import Source, dataset_of
from treadload.describing import Described
from treadload.errors import InputError, positive
from treadload.files import TABLE, check_suffix, write_whole
from treadload.kernels.arrays import Array
from treadload.response import UniformDisc
from treadload.rows import Row, row

_MOST, _ROUNDS = 50, 200


@dataclass(frozen=True)
class EquivalentDiscs(Described):
    """Discs that stand for a contact. discs: of `UniformDisc`. lost: what they do not represent, name → value in SI.

    `lost` holds: pressure, the largest of the contact, and peak, that of the discs, Pa; tractive, lateral: shear
    forces on the road that are left out, N; spread_x, spread_y: root mean square of the distance of the load from its
    centre, of the discs over that of the contact; overlap: the largest share of its radius by which a disc reaches
    over another.

    >>> patch = tl.response.GridLoad.from_arrays([[400e3, 800e3, 400e3]] * 2, spacing=0.05)
    >>> discs = tl.results.equivalent_discs(tl.Footprint(patch))
    >>> f"the peak of {discs.lost['pressure'] / 1e3:.0f} kPa becomes {discs.lost['peak'] / 1e3:.0f} kPa"
    'the peak of 800 kPa becomes 533 kPa'
    """

    discs: tuple[UniformDisc, ...]
    lost: Mapping[str, float]

    @property
    def normal_load(self) -> float:
        """N."""
        return sum(disc.normal_load for disc in self.discs)

    title: ClassVar[str] = "Uniform discs"

    @property
    def heading(self) -> str:
        """How many, and what is kept."""
        return f"{len(self.discs)}, with the load, the contact area and the centre of pressure of the contact"

    def rows(self) -> tuple[Row, ...]:
        """The discs, and what is lost."""
        lost = self.lost
        lines = [row("normal_load", self.normal_load)]
        for number, disc in enumerate(self.discs, start=1):
            numbers = {
                "print_centre_x": disc.x, "print_centre_y": disc.y, "disc_radius": disc.radius,
                "uniform_pressure": disc.pressure, "normal_load": disc.normal_load,
            }  # fmt: skip
            lines += [row(key, value, group=f"disc {number}") for key, value in numbers.items()]
        lines += [
            row("largest_pressure", lost["peak"], note=f"{row('largest_pressure', lost['pressure']).text} before"),
            row("spread_ratio_x", lost["spread_x"]),
            row("spread_ratio_y", lost["spread_y"]),
        ]
        if max(abs(lost["tractive"]), abs(lost["lateral"])) >= 0.5:
            forces = f"{lost['tractive']:.0f} N along travel and {lost['lateral']:.0f} N to the right"
            lines.append(row("neglected_shear", forces))
        if lost["overlap"] > 0:
            lines.append(row("disc_overlap", lost["overlap"]))
        return tuple(lines)

    def write_csv(self, path: str | os.PathLike[str]) -> Path:
        """Write the discs as a table, x, y and radius in m, pressure in MPa, load in kN. Returns the path."""
        check_suffix(path, TABLE, "discs")
        stream = io.StringIO()
        writer = csv.writer(stream)
        writer.writerow(["x [m]", "y [m]", "radius [m]", "pressure [MPa]", "load [kN]"])
        for disc in self.discs:
            writer.writerow([disc.x, disc.y, disc.radius, disc.pressure / 1e6, disc.normal_load / 1e3])
        return write_whole(path, stream.getvalue())


def equivalent_discs(contact: Source, count: int = 1, *, pressure: float | None = None) -> EquivalentDiscs:
    """Uniform discs with the load, the area in contact and the centre of the load of a contact.

    contact: a contact or footprint, with pressure (y, x), Pa, on even cells. count: of discs; the cells are parted
    into as many groups, each near to its own centre of load, by weighted k-means from a fixed start, so that the same
    contact gives the same discs. A disc has the load, the area and the centre of load of its group. pressure: of all
    discs, Pa, such as the inflation pressure, in place of the area: radii then follow from the loads. Returns the
    discs and what is lost; they go into `solve_response`. Raises InputError for a count that no cells can fill.

    >>> patch = tl.response.GridLoad.from_arrays([[400e3, 800e3, 400e3]] * 2, spacing=0.05)
    >>> disc = tl.results.equivalent_discs(tl.Footprint(patch)).discs[0]
    >>> f"radius {disc.radius * 1e3:.0f} mm, {disc.pressure / 1e3:.0f} kPa"
    'radius 69 mm, 533 kPa'
    """
    data = dataset_of(contact)
    if "pressure" not in data or not {"x", "y"} <= set(data["pressure"].dims):
        raise InputError("discs stand for the pressure of a contact over x and y; this has none")
    if isinstance(count, bool) or not isinstance(count, int) or not 1 <= count <= _MOST:
        raise InputError(f"the number of discs must be 1 to {_MOST}, got {count!r}")
    if pressure is not None:
        positive("the pressure of the discs", pressure, "Pa")
    x, y = (data[name].to_numpy().astype(float) for name in ("x", "y"))
    if min(len(x), len(y)) < 2:
        raise InputError("discs need cells along and across travel; the contact has a single row")
    cell = float(np.diff(x).mean() * np.diff(y).mean())
    p = np.nan_to_num(data["pressure"].transpose("y", "x").to_numpy().astype(float))
    rows, columns = np.nonzero(p > 0)
    if len(rows) < count:
        raise InputError(f"{count} discs need as many cells in contact, there are {len(rows)}; ask for fewer")
    points, weight = np.stack([x[columns], y[rows]], axis=-1), p[rows, columns]
    group = _parted(points, weight, count)
    discs = []
    for number in range(count):
        members = group == number
        load, area = float(weight[members].sum() * cell), float(members.sum() * cell)
        centre = (points[members] * weight[members, None]).sum(axis=0) / weight[members].sum()
        even = load / area if pressure is None else pressure
        discs.append(UniformDisc(math.sqrt(load / (math.pi * even)), even, float(centre[0]), float(centre[1])))
    discs.sort(key=lambda disc: (disc.y, disc.x))
    return EquivalentDiscs(tuple(discs), _lost(data, points, weight, cell, discs))


def _parted(points: Array, weight: Array, count: int) -> Array:
    """Group of each point (n,), 0 to count - 1, none empty: k-means with weights."""
    mean = np.average(points, axis=0, weights=weight)
    spread = np.cov((points - mean).T, aweights=weight) if len(points) > 1 else np.eye(2)
    along = (points - mean) @ np.linalg.eigh(spread)[1][:, -1]
    order = np.argsort(along, kind="stable")
    share = np.cumsum(weight[order]) / weight.sum()
    group = np.empty(len(points), dtype=int)
    group[order] = np.minimum((share * count * (1 - 1e-12)).astype(int), count - 1)
    for _ in range(_ROUNDS):
        for number in np.setdiff1d(np.arange(count), group):
            # Nobody's: the half of the largest group that lies further along.
            large = np.nonzero(group == np.bincount(group, minlength=count).argmax())[0]
            group[large[len(large) // 2 :]] = number
        centres = np.stack([
            np.average(points[group == k], axis=0, weights=weight[group == k]) for k in range(count)
        ])  # fmt: skip
        nearest = ((points[:, None, :] - centres[None]) ** 2).sum(axis=-1).argmin(axis=1)
        if (nearest == group).all() or len(np.unique(nearest)) < count:
            break
        group = nearest
    return group


def _lost(data: object, points: Array, weight: Array, cell: float, discs: list[UniformDisc]) -> dict[str, float]:
    load = weight * cell
    centre = np.average(points, axis=0, weights=load)
    spread = np.average((points - centre) ** 2, axis=0, weights=load)
    loads = np.array([disc.normal_load for disc in discs])
    # A uniform disc spreads its load by half its radius along each axis.
    theirs = np.average(
        [[(disc.x - centre[0]) ** 2 + disc.radius**2 / 4, (disc.y - centre[1]) ** 2 + disc.radius**2 / 4]
         for disc in discs], axis=0, weights=loads,
    )  # fmt: skip
    over = [
        (a.radius + b.radius - math.hypot(a.x - b.x, a.y - b.y)) / min(a.radius, b.radius)
        for number, a in enumerate(discs) for b in discs[:number]
    ]  # fmt: skip
    shear = {
        name: float(np.nansum(data[of].to_numpy()) * cell) if of in data else 0.0  # type: ignore[index, operator]
        for name, of in (("tractive", "traction_x"), ("lateral", "traction_y"))
    }
    return {
        "pressure": float(weight.max()), "peak": max(disc.pressure for disc in discs), **shear,
        "spread_x": float(math.sqrt(theirs[0] / spread[0])) if spread[0] > 0 else math.inf,
        "spread_y": float(math.sqrt(theirs[1] / spread[1])) if spread[1] > 0 else math.inf,
        "overlap": max(0.0, *over, 0.0),
    }  # fmt: skip
