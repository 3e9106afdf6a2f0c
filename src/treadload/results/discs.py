"""Uniform discs that stand for a contact in programs that know no other load, and what is lost with them."""

from __future__ import annotations

import csv
import io
import math
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from treadload.composing import Source, dataset_of
from treadload.errors import InputError, positive
from treadload.files import TABLE, check_suffix, write_whole
from treadload.kernels.arrays import Array
from treadload.response import UniformDisc

_MOST, _ROUNDS = 50, 200


@dataclass(frozen=True)
class EquivalentDiscs:
    """Discs that stand for a contact. discs: of `UniformDisc`. lost: what they do not say, name → value in SI.

    `lost` holds: pressure, the largest of the contact, and peak, that of the discs, Pa; tractive, lateral: shear
    forces on the road that are left out, N; spread_x, spread_y: root mean square of the distance of the load from its
    centre, of the discs over that of the contact; overlap: the largest share of its radius by which a disc reaches
    over another.
    """

    discs: tuple[UniformDisc, ...]
    lost: Mapping[str, float]

    @property
    def normal_load(self) -> float:
        """N."""
        return sum(disc.normal_load for disc in self.discs)

    def summary(self) -> str:
        """The discs as a table, and what is lost."""
        rows = [
            f"  {number:>2}  {disc.x * 1e3:9.1f}  {disc.y * 1e3:9.1f}  {disc.radius * 1e3:9.2f}  "
            f"{disc.pressure / 1e6:9.4f}  {disc.normal_load / 1e3:9.3f}"
            for number, disc in enumerate(self.discs, start=1)
        ]
        lost = self.lost
        pressure, peak = lost["pressure"] / 1e3, lost["peak"] / 1e3
        wide = f"{lost['spread_x']:.3f} of its own along travel, {lost['spread_y']:.3f} across it"
        said = [
            "what is kept: the load, the area in contact, and the centre of the load",
            f"what is lost: the largest pressure, {pressure:.0f} kPa, becomes {peak:.0f} kPa",
            f"  the load's spread is {wide}",
        ]
        if max(abs(lost["tractive"]), abs(lost["lateral"])) >= 0.5:
            forces = f"{lost['tractive']:.0f} N along travel and {lost['lateral']:.0f} N to the right"
            said.append(f"  the shear, {forces}, is left out")
        if lost["overlap"] > 0:
            said.append(f"  discs reach over each other, by {100 * lost['overlap']:.0f} % of a radius at most")
        heads = ("no", "x (mm)", "y (mm)", "radius (mm)", "pressure (MPa)", "load (kN)")
        head = f"  {heads[0]:>2}  {heads[1]:>9}  {heads[2]:>9}  {heads[3]:>9}  {heads[4]:>9}  {heads[5]:>9}"
        return "\n".join([f"{len(self.discs)} uniform disc(s), {self.normal_load / 1e3:.4g} kN", head, *rows, *said])

    __str__ = summary

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
        own = group == number
        load, area = float(weight[own].sum() * cell), float(own.sum() * cell)
        centre = (points[own] * weight[own, None]).sum(axis=0) / weight[own].sum()
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
            np.average(points[group == one], axis=0, weights=weight[group == one]) for one in range(count)
        ])  # fmt: skip
        nearest = ((points[:, None, :] - centres[None]) ** 2).sum(axis=-1).argmin(axis=1)
        if (nearest == group).all() or len(np.unique(nearest)) < count:
            break
        group = nearest
    return group


def _lost(data: object, points: Array, weight: Array, cell: float, discs: list[UniformDisc]) -> dict[str, float]:
    load = weight * cell
    centre = np.average(points, axis=0, weights=load)
    own = np.average((points - centre) ** 2, axis=0, weights=load)
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
        "spread_x": float(math.sqrt(theirs[0] / own[0])) if own[0] > 0 else math.inf,
        "spread_y": float(math.sqrt(theirs[1] / own[1])) if own[1] > 0 else math.inf,
        "overlap": max(0.0, *over, 0.0),
    }  # fmt: skip
