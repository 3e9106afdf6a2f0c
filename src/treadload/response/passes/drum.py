"""A drum that rolls over its own track: its pressure depends on the rut of earlier passes, and the one that it makes.

As in `passes.steady` a pass is one fixed point of its plastic strain. The load is part of it: plastic strain of
earlier passes, endless bars, and of this one, bars that reach back, moves the surface; the contact on what is left of
the gap gives the pressure, its stress goes into the return map. So the drum meets in front the surface that earlier
passes left, and behind it lies the new rut.

Source: that of `passes.steady` and `contact.indentation`, whose coupling is this one at a standstill.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Unpack

import numpy as np

from treadload import variables
from treadload.contact.bodies.choose import Pair, road_surface, surface_of
from treadload.contact.bodies.influence import Influence
from treadload.contact.bounds import check_ribs
from treadload.contact.contact_grid import BorderError, check_border
from treadload.contact.solvers.normal import NormalSolution, solve_normal
from treadload.deferred import xarray as xr
from treadload.errors import ConvergenceError, InputError, positive
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.kernels.gridding.below import Below
from treadload.kernels.plasticity.state import State
from treadload.materials import PassesPowerLaw
from treadload.pavement import Pavement
from treadload.response.layered import View
from treadload.response.loads import GridLoad
from treadload.response.passes.box import Box, over_strength, row_edges
from treadload.response.passes.dents import Dents
from treadload.response.passes.fields import cautions, passes_dataset
from treadload.response.passes.problem import Problem, Zone, ZoneKeys, problem_of
from treadload.response.passes.solution import Passes
from treadload.response.passes.steady import Pass, Track, roll, taken
from treadload.response.passes.stepping import (
    GROWN,
    GROWTHS,
    REACHED,
    Record,
    check_depth,
    follow,
    grown,
    too_far,
    verdict_of,
)
from treadload.response.several import Question, answers
from treadload.tire import Tire
from treadload.tire.rib_rows import shares_of_rows

# Cells that the elastic contact is found on, along and across, first on all of the drum and then around it; how many
# of its half lengths that reaches.
_ALONG, _ACROSS, _AROUND = 64, 33, 4.0
# Cells of the elastic contact along travel, of the drum across, and the most of a box along travel to begin with.
_LENGTH, _WIDTH, _LONG = 12, 28, 56
# Yield of the elastic road is searched for so many half lengths of the elastic contact ahead and down, at every
# fourth cell and so many depths. The box reaches so many of them, or this much further than what yields: behind,
# ahead of the drum, where a wave of material runs, and down; beside it as far as ahead.
_SEARCHED, _EVERY, _PROBED, _REACH, _BEHIND, _AHEAD, _DEEPER = 30.0, 4, 16, 2.5, 1.3, 2.0, 1.3
# Of the contact inside: a looser one would stall the mixing.
_INNER = 1e-7
# Rows of cells in what may yield.
_ROWS = 10


@dataclass(eq=False)
class _Rolled:
    """The drum on the cells of a box. near: the last contact."""

    box: Box
    grid: Grid
    gap: Array
    influence: Influence
    below: Below
    dents: Dents
    load: float
    near: NormalSolution
    contacts: list[NormalSolution] = field(default_factory=list)

    def pressed(self, old: Array) -> Callable[[Array], Array]:
        """Stress of the drum on a track with a plastic strain (6, nz, ny), by what this pass has changed of it."""
        rut = self.dents.endless(old)[:, None]

        def stress(change: Array) -> Array:
            dented = self.gap + rut + self.dents.track(taken(change))
            self.near = solve_normal(
                self.influence, dented, load=self.load, start=self.near.pressure, tolerance=_INNER
            )
            return self.below(self.near.pressure)

        return stress


def roll_drum(
    drum: Tire,
    road: Pavement,
    load: float,
    *,
    passes: int = 8,
    speed: float | None = None,
    tolerance: float = 1e-3,
    progress: Callable[[str], None] | None = None,
    **zone: Unpack[ZoneKeys],
) -> Passes:
    """What a drum or a steel wheel leaves as it rolls over its own track, pass by pass, until that comes to rest.

    drum: of any tire's kind, elastic: steel, or stiff for a rigid one; a smooth drum is a TreadProfile without
    grooves and with a crown radius of kilometres. road: with a layer that yields, elastic below. load: N, on the
    drum. passes: at most; a pass that adds less than 1 % of the strain at yield is the last. speed: m/s, which laws
    of Perzyna need. zone: spacing=, depth= and layers= of what may yield. spacing: of the cells along and across
    travel, m; left out, a twelfth of the elastic contact's length and a 28th of the drum's width. depth: of what may
    yield, m; left out, it grows until it holds it. layers: rows of cells in it. tolerance: of the plastic strain of a
    pass, relative.

    The contact has no friction: the drum is towed, or pushed by other wheels. It is that of the drum on the dented
    road, on layers with their compliance. Limits are those of `roll_passes` else.
    Returns Passes with what each finds: pressure over (pass, y, x), contact_length, contact_width, contact_area,
    peak_pressure, approach, how deep the drum stands below the surface that was, pressure_centre_x, and
    rolling_resistance, N, the load times that over the radius.
    Raises InputError, and ConvergenceError where a contact is not found.

    >>> yielding = tl.materials.ElastoPlastic(tl.Elastic(600e6, 0.35), tl.materials.VonMises(3e6, kinematic=60e6))
    >>> steel = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(210e9, 0.3))
    >>> road, cells = tl.Pavement.half_space(yielding), {"spacing": (0.003, 0.003), "depth": 0.009, "layers": 3}
    >>> passes = tl.response.roll_drum(steel, road, 120.0, **cells)
    >>> passes.verdict
    'shakedown'
    """
    start = time.perf_counter()
    positive("load", load, "N", "a vibrating roller's drum carries near 50e3")
    if isinstance(passes, bool) or not isinstance(passes, int | np.integer) or passes < 1:
        raise InputError(f"passes must be a whole number >= 1, got {passes!r}")
    if not 1e-6 <= tolerance <= 0.1:
        raise InputError(f"tolerance must lie in [1e-6, 0.1], got {tolerance:g}; 1e-3 is the default")
    keys: ZoneKeys = {"layers": _ROWS, **zone}
    followed = Zone(**keys)
    cell = _cell(followed.spacing, drum)
    pair = Pair(surface_of(drum.elastic, is_tire=True), road_surface(road, "layers"))
    elastic = _elastic(drum, pair, load)
    question = problem_of(elastic, road, replace(followed, spacing=None), speed=speed, tell=progress)
    if any(isinstance(course.material.law, PassesPowerLaw) for course in question.courses):
        raise InputError(
            "a PassesPowerLaw has no flow that could act on the drum: give VonMises, MohrCoulomb, DruckerPrager or "
            "Perzyna"
        )
    box = _box(question, drum, elastic, cell)
    records, rolled, words, attrs = _grown(question, drum, pair, box, load, int(passes), tolerance)
    data = passes_dataset(road, question.courses, rolled.box, records, attrs)
    data = data.merge(_of_contacts(rolled, drum), combine_attrs="override")
    seconds = time.perf_counter() - start
    stats = {"seconds": seconds, "rounds": sum(record.rounds for record in records), "box": str(rolled.box)}
    return Passes(
        data, stats, (*cautions(road, question.courses, records), *words), (), road, speed, drum, float(load)
    )


def _cell(spacing: object, drum: Tire) -> tuple[float, float] | None:
    if drum.surface.fixed_grid is not None:
        grid = drum.surface.fixed_grid
        if spacing is not None:
            raise InputError(
                f"the height map has cells of {grid.dx * 1e3:g} x {grid.dy * 1e3:g} mm and keeps them; leave "
                "spacing out"
            )
        return grid.dx, grid.dy
    if spacing is None:
        return None
    if not isinstance(spacing, tuple | list) or len(spacing) != 2:
        raise InputError(f"spacing must be a length along travel and one across, m, got {spacing!r}")
    for name, value in zip(("along", "across"), spacing, strict=True):
        positive(f"spacing {name} travel", value, "metres", "leave it out for the default")
    return float(spacing[0]), float(spacing[1])


def _elastic(drum: Tire, pair: Pair, load: float) -> GridLoad:
    """The elastic contact, on cells that are as long and as wide as it asks for."""
    surface = drum.surface
    if surface.fixed_grid is not None:
        return _pressed(drum, pair, surface.fixed_grid, load)
    length, width = surface.extent
    first = _pressed(drum, pair, Grid.centred(length, width, length / _ALONG, width / _ACROSS), load)
    around = 2 * _AROUND * (_half(first) + first.grid.dx)
    return _pressed(drum, pair, Grid.centred(min(length, around), width, around / _ALONG, width / _ACROSS), load)


def _pressed(drum: Tire, pair: Pair, grid: Grid, load: float) -> GridLoad:
    check_ribs(drum, grid.dy)
    influence = Influence(grid.shape, grid.dx, grid.dy, pair.both.at_rest, grid.y0)
    normal = solve_normal(influence, drum.height_map(grid), load=load, tolerance=1e-3)
    check_border(normal.pressure, grid)
    return GridLoad(grid, normal.pressure)


def _half(load: GridLoad) -> float:
    """Half of the length of a contact, m."""
    return 0.5 * float(load.grid.dx * (load.pressure > 0).any(axis=0).sum())


def _box(question: Problem, drum: Tire, elastic: GridLoad, cell: tuple[float, float] | None) -> Box:
    """Around the contact and what yields under it on the elastic road."""
    half, fixed, grid = _half(elastic), drum.surface.fixed_grid, elastic.grid
    top, last = question.courses[0].top, question.courses[-1].bottom
    deepest = min(last, top + _SEARCHED * half) if question.depth is None else min(last, question.depth)
    depths = top + np.geomspace(min(half, deepest - top) / 4, (deepest - top) * (1 - 1e-9), _PROBED)
    beside = math.ceil(_SEARCHED * half / grid.dx / _EVERY)
    x = grid.dx * _EVERY * np.arange(-beside, beside + 1)
    stress = question.stress(x, grid.y, depths)
    yields = np.zeros(stress.shape[1:], bool)
    for row, z in enumerate(depths):
        material = question.material_at(float(z))
        if material is not None:
            yields[row] = over_strength(material, stress[:, row]) > 0
    rows, columns = np.flatnonzero(yields.any(axis=(1, 2))), np.flatnonzero(yields.any(axis=(0, 1)))
    yielding = float(np.abs(x[columns]).max(initial=0.0))
    behind, ahead = max(_REACH * half, _BEHIND * yielding), max(_REACH * half, _AHEAD * yielding)
    width = drum.surface.extent[1]
    dx, dy = (max(2 * half / _LENGTH, (behind + ahead) / _LONG), width / _WIDTH) if cell is None else cell
    below = float(depths[min(rows[-1] + 1, len(depths) - 1)]) if rows.size else top + dx
    deep = question.depth if question.depth is not None else top + _DEEPER * (below - top)
    edges = row_edges(question.courses, 0.8 * dx, deep, question.layers)
    if fixed is not None:
        return Box(fixed.nx, fixed.ny, fixed.dx, fixed.dy, fixed.x0, fixed.y0, edges)
    back, front, aside = math.ceil(behind / dx), math.ceil(ahead / dx), math.ceil((0.5 * width + ahead) / dy)
    return Box(back + front + 1, 2 * aside + 1, dx, dy, -back * dx, -aside * dy, edges)


def _grown(
    question: Problem, drum: Tire, pair: Pair, box: Box, load: float, passes: int, tolerance: float
) -> tuple[list[Record], _Rolled, tuple[str, ...], dict[str, object]]:
    """All passes, in a box that holds what yields and what touches."""
    fixed = drum.surface.fixed_grid is not None
    for _ in range(GROWTHS + 1):
        question.tell(f"operators of {box.nx} x {box.ny} cells in {len(box.depths)} rows")
        track = Track.of(box, [question.material_at(float(z)) for z in box.depths])
        rolled = _rolled(question, drum, pair, box, load)
        try:
            records, ends, words, attrs = _run(question, rolled, track, passes, tolerance)
        except BorderError as cut:
            if fixed:
                raise
            box = box.grown(*([GROWN] * 2 if cut.along else [0.0] * 2), *([GROWN] * 2 if cut.across else [0.0] * 2))
            continue
        if not (ends > REACHED).any():
            return records, rolled, words, attrs
        check_depth(question, ends)
        if fixed and (ends[:4] > REACHED).any():
            raise InputError(
                f"the plastic zone reaches the sides of the height map, {box.nx * box.dx * 1e3:.0f} x "
                f"{box.ny * box.dy * 1e3:.0f} mm; give a larger one, NaN where there is no material"
            )
        box = grown(question, box, ends, box.dx)
    raise too_far(box)


def _rolled(question: Problem, drum: Tire, pair: Pair, box: Box, load: float) -> _Rolled:
    grid = Grid(box.nx, box.ny, box.dx, box.dy, box.x0, box.y0)
    check_ribs(drum, grid.dy)
    influence = Influence(grid.shape, grid.dx, grid.dy, pair.both.at_rest, grid.y0)
    gap = drum.height_map(grid)
    unit_load = GridLoad(Grid(1, 1, box.dx, box.dy, 0.0, 0.0), np.ones((1, 1)))
    x, y = box.dx * np.arange(1 - box.nx, box.nx), box.dy * np.arange(1 - box.ny, box.ny)
    view = View(x, y, components=range(6))
    (kernel,) = answers(
        [Question((unit_load,), question.road, box.depths)], view, side="below", speed=None, mean_over=None
    )
    near = solve_normal(influence, gap, load=load, tolerance=1e-4)
    return _Rolled(
        box, grid, gap, influence, Below.of(kernel.fields.stress), Dents.of(box, question.road), load, near
    )


def _run(
    question: Problem, rolled: _Rolled, track: Track, passes: int, tolerance: float
) -> tuple[list[Record], Array, tuple[str, ...], dict[str, object]]:
    box = rolled.box
    duration = 0.0 if question.speed is None else box.dx / question.speed

    def next_pass(number: int, states: Sequence[State]) -> tuple[Pass, float]:
        question.tell(f"pass {number} of at most {passes}")
        pressed = rolled.pressed(track.whole(states)[0])
        done = roll(track, pressed, states, duration=duration, tolerance=tolerance)
        check_border(rolled.near.pressure, rolled.grid)
        rolled.contacts.append(rolled.near)
        return done, 0.0

    records, ends, error = follow(track, passes, next_pass, deepest=question.courses[-1].bottom, rests=True)
    if error is not None:
        number = len(rolled.contacts) + 1
        raise ConvergenceError(
            f"the plastic strain of pass {number} still changed by {error.residual:.1e} of itself, above "
            f"{tolerance:.1e}: under this load the road has no steady pass; lower the load, give a law that hardens, "
            "or raise the tolerance",
            error.residual,
        )
    verdicts, words = verdict_of(track, records, failed=False, straight=True)
    return records, ends, words, verdicts


def _of_contacts(rolled: _Rolled, drum: Tire) -> xr.Dataset:
    """What each pass finds of the contact."""
    grid, contacts = rolled.grid, rolled.contacts
    pressure = np.array([contact.pressure for contact in contacts])
    touching, shares = pressure > 0, shares_of_rows(grid.y, grid.dy, drum.ribs)
    moment = (pressure * grid.x).sum(axis=(1, 2)) * grid.cell_area
    radius = getattr(drum.surface, "outer_radius", None)
    force = np.full(len(contacts), np.nan) if radius is None else moment / radius
    fields: dict[str, tuple[tuple[str, ...], Any]] = {
        "pressure": (("pass", "y", "x"), pressure),
        "approach": (("pass",), np.array([contact.approach for contact in contacts])),
        "contact_length": (("pass",), touching.any(axis=1).sum(axis=1) * grid.dx),
        "contact_width": (("pass",), touching.any(axis=2).sum(axis=1) * grid.dy),
        "contact_area": (("pass",), touching.sum(axis=2) @ shares * grid.cell_area),
        "peak_pressure": (("pass",), pressure.max(axis=(1, 2))),
        "pressure_centre_x": (("pass",), moment / rolled.load),
        "rolling_resistance": (("pass",), force),
    }
    return variables.dataset(fields, {"x": grid.x})
