"""Tire on road: choose the grid, solve normal contact and rolling, couple them, report."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from treadload.contact import cautions
from treadload.contact.bodies.choose import Pair, RoadCompliance
from treadload.contact.bodies.layers import RoadShare, half_space_share, road_share
from treadload.contact.bounds import check_modulus, check_ribs
from treadload.contact.contact_grid import (
    NO_OFFSET,
    BorderError,
    cell_across,
    check_border,
    place,
    same_place,
    widened,
)
from treadload.contact.fields import Scene, contact_dataset, tangential_of
from treadload.contact.friction.laws import Coulomb
from treadload.contact.memory_bound import check_memory
from treadload.contact.relief import above, caveats_of, check_step, heights_on
from treadload.contact.rib_sections import prepare_ribs
from treadload.contact.rolling_state import Rolling
from treadload.contact.solution import Contact
from treadload.contact.solvers.coupling import Coupled, Progress, Start, Surfaces, solve_coupled
from treadload.errors import InputError
from treadload.materials import Anisotropic, TransverselyIsotropic
from treadload.pavement import Pavement
from treadload.pavement.relief import Relief
from treadload.pavement.stack import stack_of
from treadload.tire import Tire

_FINEST, _COARSEST = 1e-12, 1e-2
# Forces that differ by more than this part of friction make another shear than that of half the grid.
_OTHERWISE = 0.1
# A change of compliance by the layers that calls for a warning.
_LAYERS_MATTER = 0.01


def solve_contact(
    tire: Tire,
    road: Pavement,
    rolling: Rolling,
    *,
    spacing: float | None = None,
    offset: tuple[float, float] = NO_OFFSET,
    tolerance: float = 1e-6,
    road_compliance: RoadCompliance = "half_space",
    relief: Relief | None = None,
    start: Contact | None = None,
    progress: Progress | None = None,
) -> Contact:
    """Contact pressure and shear, stick and slip, of a tire that rolls steadily on a road.

    tire: its surface and material; a viscoelastic one needs the rolling speed. rolling: load or approach,
    forces or creepages, friction.
    road: road_compliance selects how its surface deforms: as a "half_space" of the top layer's material, which
    serves every soft tire, or as the "layers" do, which a steel wheel or a plate needs. The stats state how much
    of the compliance is the road's (road_share) and what its layers change (layer_share); a warning states that
    layers left out matter. An elastic tire and elastic layers only; stress-dependent ones have their nominal moduli.
    relief: how far the road's surface rises above its plane, as a `pavement.Texture` or any `pavement.Relief`; None
    for a plane. The approach is then counted from the plane, and the dataset has `road_height`. A texture
    whose points lie further apart than the cells is refused.
    spacing: cell size, m; 3 mm if left out. A height map keeps its own cells. offset: by which the cells are moved
    along x and y, in parts of a cell from -0.5 to 0.5, so that other cells hold the edges of ribs.
    tolerance: of the contact conditions relative to the approach, of the slip conditions relative to μp, or to a
    hundred times the shear where that is less, and of the coupling between them. start: a contact near this one: its
    grid serves again where it is large enough, and the search then begins at its fields. progress: called with a line
    of text at every stage.
    Returns the fields on a grid that holds the whole contact patch.
    Raises InputError for forces beyond friction and for friction above a frictionless interface, GeometryError if
    the contact is larger than the surface, ConvergenceError with the residual reached.
    Method: Kalker (1990) on half-spaces; dissimilar materials by `contact.solvers.coupling`, layers by
    `kernels.layers.images`.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    >>> contact = tl.solve_contact(tire, road, tl.Rolling(normal_load=100.0, friction=0.7), spacing=0.006)
    >>> f"peak pressure {contact.dataset.pressure.max() / 1e3:.0f} kPa"  # Hertz: 212 kPa
    'peak pressure 212 kPa'
    """
    began = time.perf_counter()
    search = Search(spacing, offset, tolerance, road_compliance, relief, start)
    scene, pair = solve_search(tire, road.at_nominal_stress, rolling, search, progress or (lambda text: None))
    contact = _contact(scene, rolling, pair, road_compliance, relief, tolerance, time.perf_counter() - began)
    # The stress of loads on the road is settled by the response.
    return replace(contact, road=road) if road.depends_on_stress else contact


@dataclass(frozen=True, eq=False)
class Search:
    """How a contact is looked for; as the keywords of `solve_contact`."""

    spacing: float | None
    offset: tuple[float, float]
    tolerance: float
    road_compliance: RoadCompliance
    relief: Relief | None = None
    start: Contact | None = None


def solve_search(
    tire: Tire, road: Pavement, rolling: Rolling, search: Search, tell: Progress
) -> tuple[Scene, Coupled]:
    """Bodies and grid of a contact, and the pressure and shear on it; arguments and errors as of `solve_contact`."""
    tolerance, relief, start = search.tolerance, search.relief, search.start
    if not _FINEST <= tolerance <= _COARSEST:
        raise InputError(
            f"tolerance must lie in [{_FINEST:g}, {_COARSEST:g}], got {tolerance:g}; 1e-6 is the default, and below "
            f"{_FINEST:g} lies round-off"
        )
    if rolling.normal_load is not None:
        rolling.check_friction_limit(rolling.normal_load)
    bodies = Pair.of(tire, road, speed=rolling.speed, road_compliance=search.road_compliance)
    for name, body in (("the tire", bodies.tire), ("the road", bodies.road)):
        check_modulus(name, body)
    if rolling.law.largest > 0:
        bodies.both.check_shear()
    if tire.ribs:
        prepare_ribs(tire, cell_across(tire, search.spacing), tell)
    tell("locating the contact")
    # A tire that remembers makes its largest contact where it rolls slowly.
    over = tire if relief is None else above(tire, relief)
    if start is None:
        grid, gap = place(over, rolling, bodies.both, search.spacing, search.offset)
    elif tuple(search.offset) != NO_OFFSET:
        raise InputError("a start has its own cells, and offset moves them; leave one of the two out")
    else:
        grid, gap = same_place(over, rolling, bodies.both, start, search.spacing)
    check_ribs(tire, grid.dy)
    if relief is not None:
        check_step(relief, max(grid.dx, grid.dy))
    near = None if start is None or start.dataset.pressure.shape != grid.shape else _near(start, rolling)
    while True:
        scene = Scene(tire, road, bodies, grid, gap)
        tell(f"normal contact on {grid}")
        check = partial(check_border, grid=grid)
        try:
            pair = solve_coupled(
                scene.influence,
                Surfaces(grid, gap, tire.row_slip(grid)),
                rolling,
                check=check,
                start=near,
                tolerance=tolerance,
                tell=tell,
            )
        except BorderError as error:
            wider = widened(tire, grid, error, search.offset)
            if wider is None:
                raise
            check_memory(tire, rolling, bodies.both, wider)
            # Shear of dissimilar bodies has carried the contact beyond its grid.
            grid, gap, near = wider, over.height_map(wider), None
        else:
            return scene, pair


def _near(start: Contact, rolling: Rolling) -> Start:
    """The fields of an earlier contact, for the solvers; of the shear only where it is one as that sought."""
    pressure = start.dataset.pressure.values
    return Start(pressure, tangential_of(start.dataset) if _rolls_alike(rolling, start.rolling) else None)


def _rolls_alike(rolling: Rolling, before: Rolling) -> bool:
    """Whether prescribed forces, as shares of the load, differ by no more than a part of friction."""
    if rolling.normal_load is None or before.normal_load is None:
        return True
    pairs = zip(rolling.forces, before.forces, strict=True)
    return all(
        now is None
        or last is None
        or abs(now / rolling.normal_load - last / before.normal_load) <= _OTHERWISE * rolling.law.largest
        for now, last in pairs
    )


def _contact(
    scene: Scene,
    rolling: Rolling,
    pair: Coupled,
    road_compliance: RoadCompliance,
    relief: Relief | None,
    tolerance: float,
    seconds: float,
) -> Contact:
    tire, road, grid = scene.tire, scene.road, scene.grid
    normal, slipping, tangential = pair.normal, pair.slipping, pair.slipping.tangential
    creepages = rolling.creepages
    pressure_moment = float((normal.pressure * grid.x[None, :]).sum()) * grid.cell_area
    load = float(normal.pressure.sum()) * grid.cell_area
    # The law opposes slip to shear, so that work is lost in every cell; below zero lies round-off only.
    work = np.maximum(-(tangential.shear * tangential.slip).sum(0), 0.0)
    lost = float(work.sum()) * grid.cell_area
    # The coefficient that would carry as much on the whole patch; Coulomb's is its own mean.
    mean = rolling.law.number if isinstance(rolling.law, Coulomb) else slipping.bound.sum() / normal.pressure.sum()
    planes = {"friction_coefficient": slipping.coefficient, "friction_work": work}
    scalars = {
        "approach": normal.approach,
        "creepage_x": creepages[0] + tangential.rigid[0],
        "creepage_y": creepages[1] + tangential.rigid[1],
        "spin": rolling.spin,
        "pressure_centre_x": pressure_moment / load,
        "rolling_resistance_moment": pressure_moment,
        "friction": float(mean),
        "friction_work_total": lost,
    }
    if rolling.speed is not None:
        with np.errstate(over="ignore"):
            planes["friction_power"] = work * rolling.speed
            scalars["friction_power_total"] = lost * rolling.speed
    if relief is not None:
        planes["road_height"] = heights_on(relief, grid)
    if slipping.temperature is not None:
        planes["flash_temperature"] = slipping.temperature
    data = contact_dataset(
        scene, normal.pressure, normal.gap, tangential, tangential.slip, planes=planes, scalars=scalars
    )
    stats: dict[str, Any] = {
        "normal_iterations": pair.normal_iterations,
        "normal_residual": normal.residual,
        "newton_iterations": pair.newton,
        "krylov_iterations": pair.krylov,
        "splitting_iterations": pair.splitting,
        "rolling_residual": tangential.residual,
        "friction_rounds": slipping.rounds,
        "friction_change": slipping.change,
        "coupling_rounds": pair.rounds,
        "coupling_change": pair.change,
        "dundurs": scene.influence.dundurs,
        "cells": grid.nx * grid.ny,
        "tolerance": tolerance,
        "seconds": seconds,
        **scene.bodies.both.stats,
    }
    warnings = [
        *cautions.of_tire(tire),
        *cautions.of_rolling(tire, rolling),
        *cautions.of_numbers(tire, rolling, grid),
        *(() if relief is None else caveats_of(relief, grid)),
    ]
    area = float((normal.pressure > 0).sum()) * grid.cell_area
    if relief is None:
        warnings += cautions.of_mean_pressure(tire, load, area)
    if pair.splitting:
        warnings.append(f"Newton's method stalled and went on after {pair.splitting} steps of the slower splitting")
    share = _share(scene, area)
    layered = road_compliance == "layers" and not road.is_homogeneous
    if share is not None:
        stats |= {"road_share": share.share, "layer_share": share.layering, "layers_solved": layered}
        if not layered and abs(share.layering) > _LAYERS_MATTER:
            warnings.append(
                f"the layers of the road change the compliance of this contact by {100 * share.layering:.1f} %, and "
                'it was solved on a half-space of the top layer; solve it with road_compliance="layers"'
            )
    elif not road.is_homogeneous and _grained(road):
        alone = half_space_share(scene.bodies.tire, scene.bodies.road, area)
        if alone.share > _LAYERS_MATTER:
            warnings.append(
                f"the road gives {100 * alone.share:.3g} % of the compliance of this contact as a half-space of its "
                f"top layer, and what its layers change of that is not known: layer {_grained(road)[0]!r} has a "
                "horizontal grain; a TransverselyIsotropic or an Elastic in its place shows"
            )
    return Contact(data, tire, road, rolling, stats, tuple(warnings + cautions.of_fields(data)))


def _share(scene: Scene, area: float) -> RoadShare | None:
    """The road's share in a contact of an area, m²; None while a layer waits for its temperature.

    None also for layers of which one has a horizontal grain.
    """
    if any(layer.depends_on_temperature for layer in scene.road.layers):
        return None
    if _grained(scene.road):
        return half_space_share(scene.bodies.tire, scene.bodies.road, area) if scene.road.is_homogeneous else None
    # Of a road that changes with time or bond, the stiffest: the one that the half-space stands for.
    return road_share(scene.bodies.tire, stack_of(scene.road.glassy.sticking.bond_limits[0]), area)


def _grained(road: Pavement) -> list[str]:
    """Names of the layers whose stiffness depends on the horizontal direction; of such layers no body is known."""
    return [
        layer.name
        for layer in road.layers
        if not layer.depends_on_temperature
        and isinstance(layer.resolved, Anisotropic)
        and not isinstance(layer.resolved, TransverselyIsotropic)
    ]
