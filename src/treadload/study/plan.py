"""What a case would solve, without solving it: cells, points, contacts, and about how long."""

from __future__ import annotations

import math
import time

import numpy as np

from treadload.case import Case, LifeCase
from treadload.contact import cautions
from treadload.contact.bodies.choose import Pair
from treadload.contact.crossing_fields import STRIDE
from treadload.contact.relief import above
from treadload.contact.solve import place
from treadload.grid import Grid
from treadload.kernels import fft
from treadload.pavement import Pavement
from treadload.response import GridLoad
from treadload.response.doubts import question_doubts, road_doubts
from treadload.results import road_in_rows
from treadload.study.dents import plan_dents
from treadload.study.doubts import traffic_doubts
from treadload.study.loaded import map_grid
from treadload.study.reliability import roads_asked
from treadload.study.run import slice_depths
from treadload.study.seasons import warmed
from treadload.study.wheels import state


def plan_case(case: Case) -> str:
    """What `run_case` would do, as text: tire, road, contact grid, points and depths, a rough time.

    Reads the tire, or the footprint, and finds where the contact lies. Raises the errors of reading, and those of
    forces that friction cannot carry.
    """
    if case.dents:
        return plan_dents(case)
    road, asked = case.pavement.build(), case.response
    lines: list[str] = []
    said: list[str] = []
    if case.footprint is None:
        grid = _contact_grid(case, road)
        wheel = GridLoad(grid, np.zeros(grid.shape))
        tire, rolling = case.build_tire(), case.build_rolling()
        said += cautions.of_numbers(tire, rolling, grid)
        lines += [f"tire      {tire}", f"rolling   {rolling}"]
        lines.append(f"contact   {grid}, {_count(grid.nx * grid.ny)} cells")
    else:
        wheel = case.footprint.build(case.folder)
        grid = wheel.grid
        lines.append(f"footprint {case.footprint.file}, {wheel.grid}, {wheel.normal_load / 1e3:.4g} kN")
    loads = asked.place(wheel)
    cells = map_grid(loads, road)
    bottom = asked.slices_to(road.interfaces.tolist(), rigid_base=road.rigid_base)
    sliced = len(slice_depths(bottom, wheel.grid.dx, road))
    depths = ", ".join(f"{depth * 1e3:g}" for depth in asked.depths)
    wheels = f" under {len(loads)} wheels" if len(loads) > 1 else ""
    lines += [
        f"response  {cells.nx} x {cells.ny} points at {len(asked.depths)} depth(s), {depths} mm{wheels}",
        f"slices    {cells.nx} and {cells.ny} points at {sliced} depths down to {bottom * 1e3:g} mm",
    ]
    if case.damage is not None:
        deep, wide = case.damage.depth, case.damage.mean_over
        read = f"means over {wide * 1e3:g} mm in the top layer" if deep is None else f"points at {deep * 1e3:g} mm"
        lines.append(f"verdict   {case.damage.fatigue.build()}, {read}")
    if case.texture is not None:
        how = "under the whole tire" if case.texture.resolved else "a patch under the pressures of the contact"
        lines.append(f"texture   {case.texture.build(case.folder)}; {how}")
    ways = 0.0
    if case.crossing is not None:
        ways = len(case.crossing.positions or ()) or _positions(case, grid)
        about = "" if case.crossing.positions else "about "
        lines.append(f"crossing  {case.crossing.build()}; {about}{ways:.0f} positions")
        ways *= 1.0 if case.crossing.sliding else _PRESSED
    solved = grid.nx * grid.ny if case.footprint is None else 0
    mapped = cells.nx * cells.ny * len(asked.depths)
    seconds = _seconds(road, solved, mapped, (cells.nx + cells.ny) * sliced, 1 + ways)
    shown = f"{seconds:.1g} s" if seconds < 10 else f"{seconds:.2g} s" if seconds < 100 else f"{seconds / 60:.2g} min"
    lines.append(f"estimate  about {shown} on this machine, within a factor of three or so")
    said += [
        *question_doubts(np.array(asked.depths), case.speed if road.is_viscoelastic else None),
        *road_doubts(road),
    ]
    return "\n".join([*lines, "", road_in_rows(road, case), *(f"warning: {text}" for text in said)])


def plan_life(case: LifeCase) -> str:
    """What `run_life` would do, as text: contacts, responses, criteria. Reads the tire. Raises InputError."""
    tire, road, traffic = case.build_tire(), case.build_road(), case.build_traffic()
    criteria, seasons = case.build_criteria(), case.build_climate().seasons
    warm = [warmed(road, criteria, season) for season in seasons]
    distinct = [one for k, one in enumerate(warm) if one not in warm[:k]]
    contacts = len({state(row) for row in traffic.classes})
    lines = [
        f"tire      {tire}",
        f"traffic   {traffic.passes_per_year:g} passes in the first year in {len(traffic.classes)} classes: "
        + ", ".join(f"{row.name} {100 * row.share:g} %" for row in traffic.classes),
        f"climate   {len(seasons)} season(s), {len(distinct)} of them different",
        f"contacts  {contacts} on cells of {case.spacing * 1e3:g} mm",
        f"responses {len(traffic.classes) * len(distinct)} at most, fewer where readings are interpolated over the "
        "climate; the sensitivities take about as many again",
    ]
    lines += [f"criterion {one.name}: {one.law_at(15.0)} at {one.depth(road) * 1e3:g} mm" for one in criteria]
    if case.reliability is not None:
        roads = roads_asked(road, criteria, case.reliability.build())
        lines.append(f"scatter   {roads} roads for each criterion, in the seasons that do half of its damage")
    said = [*traffic_doubts(tire, traffic, case.build_climate()), *road_doubts(warm[0].road)]
    return "\n".join([*lines, *(f"warning: {text}" for text in said)])


def _contact_grid(case: Case, road: Pavement) -> Grid:
    """Where the contact lies, placed as `solve_contact` places it."""
    tire, rolling, relief = case.build_tire(), case.build_rolling(), case.build_relief()
    if rolling.normal_load is not None:
        rolling.check_friction_limit(rolling.normal_load)
    pair = Pair.of(tire, road, speed=rolling.speed).both
    grid, _ = place(tire if relief is None else above(tire, relief), rolling, pair, case.spacing)
    return grid


def _positions(case: Case, grid: Grid) -> int:
    """About how many positions a crossing has that names none: half a contact clear on both sides, a stride apart."""
    assert case.crossing is not None
    edges = getattr(case.crossing.build(), "edges", (0.0,))
    way = max(edges) - min(edges) + 1.25 * grid.nx * grid.dx
    return math.ceil(way / (STRIDE * (case.crossing.spacing or grid.dx)))


# Time over that of one transform of _SIDE² numbers, as measured on contacts of 800 to 12 000 cells: a contact and a
# cell of it, a point of the maps, one of the slices.
_SIDE = 512
_CONTACT, _CELL = 100.0, 0.04
# Share of a contact's time that its pressure takes.
_PRESSED = 0.1
_MAP = {"half-space": 0.006, "layers": 0.012, "viscoelastic": 0.12}
_SLICE = {"half-space": 0.15, "layers": 0.35, "viscoelastic": 6.0}


def _seconds(road: Pavement, contact: int, mapped: int, sliced: int, contacts: float = 1.0) -> float:
    """About how long a case takes on this machine. contact: cells; mapped, sliced: points; contacts: how many."""
    kind = "viscoelastic" if road.is_viscoelastic else "half-space" if road.is_homogeneous else "layers"
    contact_cost = (_CONTACT + _CELL * contact) if contact else 0.0
    return _transform() * (contacts * contact_cost + _MAP[kind] * mapped + _SLICE[kind] * sliced)


def _transform() -> float:
    """Seconds of one transform, the best of a few."""
    field = np.ones((_SIDE, _SIDE))
    best = math.inf
    for _ in range(5):
        start = time.perf_counter()
        fft.rfft2(field)
        best = min(best, time.perf_counter() - start)
    return best


def _count(number: int) -> str:
    return f"{number:,}".replace(",", "\u202f")
