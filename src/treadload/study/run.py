"""Run a case: tire or footprint, contact, response, verdict."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from treadload.case import Case
from treadload.composing import BaseResult
from treadload.contact import (
    Contact,
    Crossing,
    Enveloped,
    TextureContact,
    cross_obstacle,
    solve_texture,
)
from treadload.damage import Verdict
from treadload.describing import first_line
from treadload.errors import InputError
from treadload.footprint import Footprint
from treadload.kernels.arrays import Array
from treadload.pavement import Pavement
from treadload.response import (
    GridLoad,
    Heterogeneous,
    Passes,
    Response,
    compute_heterogeneous,
    roll_passes,
)
from treadload.results import Study, road_in_rows, to_tree
from treadload.study.loaded import Loaded, Progress, judge, load_case, on_two_grids

# Depths of a slice; under a moving load each costs several times as much.
_SLICE_DEPTHS, _MOVING_DEPTHS = 31, 16
# As a depth just below an interface, m.
_BELOW = 1e-6
# The deflection bowl, m: behind the wheel, before it, between its points.
_BEHIND, _AHEAD, _STEP = 2.5, 1.5, 0.01


@dataclass(frozen=True, eq=False)
class Result(Study):
    """What a case gave.

    road: at its temperature. contact: None if a footprint was recorded, which is then `footprint`. response: maps at
    the case's depths, over all wheels. slice_along, slice_across: vertical slices along travel and across it through
    the worst point of the map that the verdict reads, else the first. bowl: deflection of the surface along travel
    under the first wheel; None on a half-space. verdict: None if the case has no fatigue line. passes, heterogeneous,
    texture, enveloped, crossing: None if the case asks for none.
    """

    case: Case
    road: Pavement
    contact: Contact | None
    footprint: Footprint | None
    response: Response
    slice_along: Response
    slice_across: Response
    bowl: Response | None
    verdict: Verdict | None
    passes: Passes | None = None
    heterogeneous: Heterogeneous | None = None
    texture: TextureContact | None = None
    enveloped: Enveloped | None = None
    crossing: Crossing | None = None

    @property
    def parts(self) -> Mapping[str, BaseResult]:
        """Its results by their names in a tree."""
        load = replace(self.footprint, road=self.road) if self.footprint is not None else self.contact
        parts = {
            "contact": load, "response": self.response, "slice_along": self.slice_along,
            "slice_across": self.slice_across, "bowl": self.bowl, "damage": self.verdict,
            "passes": self.passes, "heterogeneous": self.heterogeneous, "texture": self.texture,
            "enveloped": self.enveloped, "crossing": self.crossing,
        }  # fmt: skip
        return {name: part for name, part in parts.items() if part is not None}

    def to_tree(self) -> xr.DataTree:
        """All results in one tree with provenance, ready to be saved."""
        return to_tree(self.parts, case=self.case, road=self.road, summary=self.summary())

    def summary(self) -> str:
        """One screen: contact, road, response, verdict."""
        parts = self.parts
        told = [parts["contact"].summary(), road_in_rows(self.road, self.case), self.response.summary()]
        rest = (self.verdict, self.passes, self.heterogeneous, self.texture, self.enveloped, self.crossing)
        return "\n\n".join([*told, *(one.summary() for one in rest if one is not None)])

    __repr__ = first_line


def run_case(case: Case, progress: Progress | None = None) -> Result:
    """Compute everything that a case asks for.

    progress: called with a line of text at every stage.
    Raises the errors of reading, contact, response and verdict.
    """
    return read_loaded(load_case(case, progress or (lambda text: None)))


def read_loaded(load: Loaded) -> Result:
    """Everything that the case of a loaded road asks for."""
    case, tell = load.case, load.tell
    response = load.solve(case.response.depths)
    verdict = None
    if case.damage is not None:
        tell("verdict")
        verdict = judge(load, response)
        if case.damage.error_estimate:
            verdict = on_two_grids(load, verdict)
    tell("vertical slices")
    road, grid = load.road, load.grid
    worst_x, worst_y = _worst_point(response, verdict)
    bottom = case.response.slices_to(road.interfaces.tolist(), rigid_base=road.rigid_base)
    depths = slice_depths(bottom, load.wheel.grid.dx, road)
    crossing = [(x, worst_y) for x in grid.x] + [(worst_x, y) for y in grid.y]
    slices = load.solve(depths, points=crossing)
    along, across = _line(slices, slice(grid.nx), "x"), _line(slices, slice(grid.nx, None), "y")
    bowl = None
    if not road.is_homogeneous:
        tell("deflection bowl")
        ahead, right = _centre(load.wheels[0])
        steps = np.arange(-round(_BEHIND / _STEP), round(_AHEAD / _STEP) + 1) * _STEP
        bowl = load.solve([0.0], x=ahead + steps, y=[right])
        # For whoever draws it: a line of points does not say where the load's centre is.
        bowl = replace(bowl, dataset=bowl.dataset.assign_attrs(load_x=ahead))
    passes = None if case.passes is None else passes_of(case, load)
    stones = None if case.aggregates is None else stones_of(case, load)
    rough = None if case.texture is None or case.texture.resolved else texture_of(case, load)
    way = None if case.crossing is None else crossing_of(case, load)
    return Result(
        case, road, load.contact, load.footprint, response, along, across, bowl, verdict, passes, stones, rough,
        load.enveloped, way,
    )  # fmt: skip


def texture_of(case: Case, load: Loaded) -> TextureContact:
    """The tread's rubber on the texture that a case names, under the pressures of its contact."""
    asked = case.texture
    assert asked is not None
    if load.contact is None:
        raise InputError("[texture] needs the contact of a tire, and this case has a recorded footprint")
    return solve_texture(
        asked.build(case.folder), asked.build_rubber(), load.contact, thickness=asked.thickness,
        speed=case.speed, wave=asked.wave, progress=load.tell,
    )  # fmt: skip


def crossing_of(case: Case, load: Loaded) -> Crossing:
    """The way of the wheel over the obstacle that a case names."""
    asked = case.crossing
    assert asked is not None
    # A footprint in place of the tire was refused when the case was read.
    assert load.contact is not None
    contact = load.contact
    return cross_obstacle(
        contact.tire, load.road, asked.rolling(contact.rolling), asked.build(), positions=asked.positions,
        hold=asked.hold, spacing=case.spacing if asked.spacing is None else asked.spacing, tolerance=case.tolerance,
        road_compliance=case.road_compliance, progress=load.tell,
    )  # fmt: skip


def passes_of(case: Case, load: Loaded) -> Passes:
    """What the passes leave that a case asks for."""
    asked = case.passes
    assert asked is not None
    return roll_passes(
        load.wheels, load.road, passes=asked.count, speed=case.speed, spacing=asked.spacing, depth=asked.depth,
        layers=asked.layers, wander=asked.wander, progress=load.tell,
    )  # fmt: skip


def stones_of(case: Case, load: Loaded) -> Heterogeneous:
    """The window with stones that a case asks for."""
    asked = case.aggregates
    assert asked is not None
    window = asked.window
    return compute_heterogeneous(
        load.wheels, asked.road(load.road), asked.build(), window=(window.length, window.width), depth=window.depth,
        at=(window.x, window.y), spacing=asked.spacing, bond_strength=asked.bond_strength, borders=asked.borders,
        progress=load.tell,
    )  # fmt: skip


def _worst_point(response: Response, verdict: Verdict | None) -> tuple[float, float]:
    """X and y, m, of the verdict's worst point; without one of the largest extension of the first map."""
    if verdict is not None and float(verdict.dataset["worst_strain"]) > 0:
        return float(verdict.dataset["worst_x"]), float(verdict.dataset["worst_y"])
    strain = response.dataset.principal_strain_1.isel(depth=0)
    row, column = np.unravel_index(int(np.nanargmax(strain.values)), strain.shape)
    return float(strain.x[column]), float(strain.y[row])


def _line(response: Response, members: slice, along: str) -> Response:
    """The points of a response that lie on one line along x or y, as a grid of a single row or column."""
    points = response.dataset.isel(point=members)
    count = points.sizes["point"]
    places = {name: points[name].to_numpy()[: count if name == along else 1] for name in ("y", "x")}
    coordinates = {
        name: (name, places.get(name, points[name].to_numpy()), points[name].attrs)
        for name in ("depth", "y", "x", "component")
    }
    coordinates["layer"] = ("depth", points["layer"].to_numpy(), points["layer"].attrs)
    fields: dict[Hashable, tuple[Any, ...]] = {}
    for name, part in points.data_vars.items():
        values, more = part.to_numpy(), part.dims[2:]
        if name == "dissipated_energy":
            # The same all along x.
            fields[name] = ("depth", "y"), values[:, : len(places["y"])], part.attrs
        else:
            values = np.expand_dims(values, 1 if along == "x" else 2)
            fields[name] = ("depth", "y", "x", *more), values, part.attrs
    data = xr.Dataset(fields, coordinates, points.attrs)
    seconds = response.stats["seconds"] * count / response.dataset.sizes["point"]
    stats = {**response.stats, "seconds": seconds, "points": count * data.sizes["depth"]}
    return replace(response, dataset=data, stats=stats)


def slice_depths(bottom: float, cell: float, road: Pavement) -> Array:
    """Depths from the surface to the bottom, close to each other near the surface where strain varies fast.

    None lies between the surface and half a cell: there the field shows the edges of the cells. Both sides of every
    interface are among them.
    """
    first = min(0.5 * cell, 0.5 * bottom)
    count = _MOVING_DEPTHS if road.is_viscoelastic else _SLICE_DEPTHS
    graded = np.concatenate([[0.0], np.geomspace(first, bottom, count - 1)])
    above = [depth for depth in road.interfaces if depth <= bottom]
    below = [depth + _BELOW for depth in above if depth < bottom]
    # Depths that differ by round-off alone would be solved twice.
    return np.unique(np.round(np.concatenate([graded, above, below]), 9))


def _centre(load: GridLoad) -> tuple[float, float]:
    """Centre of pressure, m, along x and y."""
    pressure, grid = load.array[0], load.grid
    total = max(float(pressure.sum()), np.finfo(float).tiny)
    return float((pressure * grid.x[None]).sum() / total), float((pressure * grid.y[:, None]).sum() / total)
