"""A body pressed into a road that yields, through a history of loads.

The plastic strain d that a step adds is the only unknown: it moves the surface, whose contact gives the pressure. The
stress of that, with that of d itself, goes into the return map,

    contact(gap + u_z(d)) -> p,   trial = S p + K d + C d,   d = Return(trial; state before the step),

a fixed point that contracts, since -K is a projection in the elastic energy; Anderson's mixing finds it. The contact
is solved inside, to a tolerance far below that of the plastic strain.

Sources: Jacq, Nélias, Lormand & Girodin (2002), J. Tribol. 124, 653-667, for the semi-analytical method; Frérot,
Bonnet, Molinari & Anciaux (2019), Comput. Methods Appl. Mech. Eng. 351, 951-976, for driving it by strain.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from treadload import variables
from treadload.composing import BaseResult, Holds
from treadload.contact.bodies.choose import Pair
from treadload.contact.bodies.influence import Influence
from treadload.contact.rolling_state import Rolling
from treadload.contact.solve import check_border, place
from treadload.contact.solvers.normal import NormalSolution, solve_normal
from treadload.contact.yielding import Ground, Yielding
from treadload.describing import first_line
from treadload.errors import ConvergenceError, InputError, positive
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.kernels.eigenstrain.rows import graded_edges
from treadload.kernels.mixing import Anderson
from treadload.kernels.plasticity.state import State
from treadload.materials import ElastoPlastic, PassesPowerLaw, Perzyna
from treadload.pavement import Pavement
from treadload.tire import Tire

# Less memory takes more than twice as many rounds above ten times the load of first yield.
_MEMORY, _MOST_ROUNDS = 15, 75
# Times that a step is halved before it is given up.
_MOST_HALVINGS = 3
# Of the contact inside: looser than this part of what the plastic strain still changes it would stall the mixing.
_INNER, _FINEST = 1e-3, 1e-7
# Depth of the rows, in radii of the elastic contact under the largest load.
_DEEP = 2.2
# What a side of the box takes of the largest plastic strain, from where on the box is too small; and small strains.
_REACHED, _SMALL = 0.02, 0.05


@dataclass(frozen=True, eq=False)
class Indentation(BaseResult, group="indentation"):
    """A body pressed into a road that yields.

    dataset: normal_load, approach, contact_area, peak_pressure and largest_plastic_strain by step; pressure and
    residual_displacement_z, what the surface keeps if it were unloaded, over (step, y, x); equivalent_plastic_strain
    over (step, depth, y, x). stats: rounds, seconds. warnings: sentences. tire, road, loads: the question.
    """

    holds: ClassVar[Holds] = Holds(
        {
            "step": "step", "depth": "depth", "y": "y", "x": "x",
            "normal_load approach contact_area peak_pressure largest_plastic_strain": "step",
            "pressure residual_displacement_z": "step y x",
            "equivalent_plastic_strain": "step depth y x",
        },
        known="normal_load pressure residual_displacement_z",
        texts="law",
        sizes={"step": (1, np.inf)},
    )  # fmt: skip

    dataset: xr.Dataset
    stats: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    tire: Tire | None = None
    road: Pavement | None = None
    loads: tuple[float, ...] = ()

    def summary(self) -> str:
        """Load, approach, peak pressure, plastic strain and dent, step by step."""
        data = self.dataset
        lines = [f"indentation of a road, {data.attrs['law']}; {data.sizes['step']} step(s)"]
        lines.append("load N     approach µm   peak MPa   area mm²   plastic strain %   dent µm")
        for row in range(data.sizes["step"]):
            one = data.isel(step=row)
            lines.append(
                f"{float(one['normal_load']):<10.4g} {float(one['approach']) * 1e6:>11.4g} "
                f"{float(one['peak_pressure']) / 1e6:>10.4g} {float(one['contact_area']) * 1e6:>10.4g} "
                f"{100 * float(one['largest_plastic_strain']):>18.3g} "
                f"{float(one['residual_displacement_z'].max()) * 1e6:>9.4g}"
            )
        return "\n".join(lines + [f"warning: {text}" for text in self.warnings])

    __repr__ = first_line


@dataclass
class _Pressing:
    """Brings a body from one load to the next. rounds, halved: of all steps so far; zone: grows where it must."""

    zone: Yielding
    influence: Influence
    gap: Array
    tolerance: float
    rounds: int = 0
    halved: int = 0

    def reach(
        self, load: float, before: float, state: State, near: Array, name: str, halvings: int
    ) -> tuple[State, NormalSolution | None]:
        """State and contact under a load, N, after another; a step that does not settle is halved first."""
        try:
            return self._jump(load, state, near, name, _MOST_ROUNDS if halvings else 2 * _MOST_ROUNDS)
        except ConvergenceError:
            if not halvings:
                raise
        self.halved += 1
        middle = 0.5 * (before + load)
        state, touching = self.reach(middle, before, state, near, name, halvings - 1)
        near = near if touching is None else touching.pressure
        return self.reach(load, middle, state, near, name, halvings - 1)

    def _jump(
        self, load: float, state: State, near: Array, name: str, most: int
    ) -> tuple[State, NormalSolution | None]:
        """The same in one jump of so many rounds at most. Raises ConvergenceError."""
        while True:
            inner, touching = self._settled(load, self.zone.of(state), near, name, most)
            after = self.zone.put(state, inner)
            if self.zone.held(state, after):
                return after, touching
            self.zone = self.zone.grown(state, after)

    def _settled(
        self, load: float, state: State, near: Array, name: str, most: int
    ) -> tuple[State, NormalSolution | None]:
        """The same in the zone alone."""
        zone, material = self.zone, self.zone.ground.material
        law, change, mixing = material.return_map(), np.zeros_like(state.strain), Anderson(_MEMORY)
        still = self.tolerance
        touching: NormalSolution | None = None
        for _ in range(most):
            self.rounds += 1
            stress = zone.own(state.strain + change) + law.elastic(change)
            if load:
                dented = self.gap + zone.sunk(state.strain + change)
                inner = min(max(_INNER * still, _FINEST), _INNER)
                touching = solve_normal(self.influence, dented, load=load, start=near, tolerance=inner)
                near = touching.pressure
                stress = stress + zone.pressed(near)
            after = law(stress, state)
            step = after.strain - state.strain
            size, off = float(np.linalg.norm(step)), float(np.linalg.norm(step - change))
            if off <= self.tolerance * size or np.abs(step - change).max() <= 1e-6 * material.yield_strain:
                return after, touching
            change, still = mixing.next(change, step), off / size if size else self.tolerance
        raise ConvergenceError(
            f"the plastic strain of {name} did not settle at {load:g} N in {most} rounds: it still changes by "
            f"{off / size:.1e} of itself, above the tolerance of {self.tolerance:.1e}; take smaller steps",
            off / size,
        )


def solve_indentation(
    tire: Tire,
    road: Pavement,
    loads: Sequence[float],
    *,
    spacing: float | None = None,
    depth: float | None = None,
    layers: int = 14,
    tolerance: float = 1e-4,
    progress: Callable[[str], None] | None = None,
) -> Indentation:
    """A body pressed into a road that yields, and lifted again: chippings, studs, plates, standing steel wheels.

    tire: the body, of any tire's kind, elastic; a `Tire.from_height_map` of a stiff material for a rigid one. road: a
    half-space of an ElastoPlastic whose law knows no time. loads: N, >= 0, one a step, in their order; 0 lifts it
    off. spacing: of the cells, m, as in `solve_contact`. depth: of what may yield, m; left out, 2.2 times the radius
    of the elastic contact under the largest load. layers: rows of cells in it. tolerance: of the plastic strain of a
    step, relative. The contact has no friction, and feels the dent. A step is one jump, halved where it does not
    settle: yielding that turns on the way asks for more steps. Raises InputError, and ConvergenceError with the
    residual reached.
    """
    start = time.perf_counter()
    tell = (lambda text: None) if progress is None else progress
    material, steps = _checked(road, loads, depth, layers, tolerance)
    pair = Pair.of(tire, road)
    most = Rolling(normal_load=2 * max(steps), friction=1.0)
    grid, gap = place(tire, most, pair.both, spacing)
    influence = Influence(grid.shape, grid.dx, grid.dy, pair.both.at_rest)
    normal = solve_normal(influence, gap, load=max(steps), tolerance=1e-4)
    if depth is None:
        touched = normal.pressure > 0
        radius = 0.5 * max(touched.any(axis=0).sum() * grid.dx, touched.any(axis=1).sum() * grid.dy)
        depth = _DEEP * radius
    ground = Ground(grid, material, graded_edges(0.0, depth, 0.8 * grid.dx, layers))
    tell(f"operators of {grid.nx} x {grid.ny} cells in {len(ground.depths)} rows")
    pressing = _Pressing(Yielding(ground, ground.zone(normal.pressure)), influence, gap, tolerance)
    state, pressure = State.virgin(ground.shape), normal.pressure
    found: list[tuple[float, float, Array, State, Array]] = []
    for number, (before, load) in enumerate(pairwise([0.0, *steps]), start=1):
        tell(f"step {number} of {len(steps)}")
        state, touching = pressing.reach(load, before, state, pressure, f"step {number}", _MOST_HALVINGS)
        if touching is not None:
            check_border(touching.pressure, grid)
            pressure = touching.pressure
        _check_sides(state, depth, number)
        held = np.zeros(grid.shape) if touching is None else touching.pressure
        level = 0.0 if touching is None else touching.approach
        found.append((load, level, held, state, pressing.zone.sunk(pressing.zone.of(state).strain)))
    stats = {
        "seconds": time.perf_counter() - start,
        "rounds": pressing.rounds,
        "halved_steps": pressing.halved,
        "memory_mb": pressing.zone.own.bytes / 1e6,
    }
    data = _dataset(grid, ground, found, type(material.law).__name__)
    largest = float(data["largest_plastic_strain"].max())
    warnings = () if largest <= _SMALL else (
        f"the plastic strain reaches {100 * largest:.1f} %, above {100 * _SMALL:g} %: strains are taken as small",
    )  # fmt: skip
    return Indentation(data, stats, warnings, tire, road, tuple(steps))


def check_indented(road: Pavement) -> ElastoPlastic:
    """The material of a road that can be dented. Raises InputError for a road that this solver does not know."""
    material = road.layers[0].material
    if not road.is_homogeneous:
        raise InputError(
            f"a road of {len(road.layers)} layers cannot be dented yet: stress and dent of plastic strain are those "
            "of a half-space here; give Pavement.half_space of the layer that yields, or roll a drum, which knows "
            "layers"
        )
    if not isinstance(material, ElastoPlastic):
        raise InputError(
            "an indentation needs a half-space that yields: Pavement.half_space(ElastoPlastic(elastic, law))"
        )
    if isinstance(material.law, Perzyna | PassesPowerLaw):
        raise InputError(
            f"{type(material.law).__name__} follows time or passes, and a step of an indentation has neither; give "
            "VonMises, MohrCoulomb or DruckerPrager"
        )
    return material


def _checked(
    road: Pavement, loads: Sequence[float], depth: float | None, layers: int, tolerance: float
) -> tuple[ElastoPlastic, list[float]]:
    material = check_indented(road)
    steps = [float(one) for one in np.atleast_1d(np.asarray(loads, dtype=float))]
    if not steps or not np.isfinite(steps).all() or min(steps) < 0 or max(steps) <= 0:
        raise InputError(f"loads must be numbers >= 0 N with one above, got {list(loads)}; 0 lifts the body off")
    if depth is not None:
        positive("depth", depth, "metres", "leave it out for the default")
    if isinstance(layers, bool) or not isinstance(layers, int) or not 2 <= layers <= 64:
        raise InputError(f"layers must be a whole number in [2, 64], got {layers!r}; 14 is the default")
    if not 1e-6 <= tolerance <= 0.1:
        raise InputError(f"tolerance must lie in [1e-6, 0.1], got {tolerance:g}; 1e-4 is the default")
    return material, steps


def _check_sides(state: State, depth: float, number: int) -> None:
    """Refuse a box that what yields has reached."""
    p = state.hardening
    largest = float(p.max())
    sides = {"depth": p[-1], "length": p[:, :, [0, -1]], "width": p[:, [0, -1]]}
    for name, side in sides.items():
        if largest > 0 and float(side.max()) > _REACHED * largest:
            remedy = f"raise depth, now {depth:.3g} m" if name == "depth" else "give the body a larger height map"
            raise InputError(
                f"in step {number} the plastic zone reaches the {name} of the box, where it takes "
                f"{100 * float(side.max()) / largest:.0f} % of the largest plastic strain; {remedy}"
            )


def _dataset(grid: Grid, ground: Ground, found: Sequence[tuple[Any, ...]], law: str) -> xr.Dataset:
    loads, levels, pressures, states, moved = zip(*found, strict=True)
    pressure, hardening = np.array(pressures), np.array([one.hardening for one in states])
    fields: dict[str, tuple[tuple[str, ...], Any]] = {
        "normal_load": (("step",), np.array(loads)),
        "approach": (("step",), np.array(levels)),
        "contact_area": (("step",), (pressure > 0).sum(axis=(1, 2)) * grid.cell_area),
        "peak_pressure": (("step",), pressure.max(axis=(1, 2))),
        "largest_plastic_strain": (("step",), hardening.max(axis=(1, 2, 3))),
        "pressure": (("step", "y", "x"), pressure),
        "residual_displacement_z": (("step", "y", "x"), np.array(moved)),
        "equivalent_plastic_strain": (("step", "depth", "y", "x"), hardening),
    }
    places = {"step": np.arange(1, len(loads) + 1), "depth": ground.depths, "y": grid.y, "x": grid.x}
    return variables.dataset(fields, places, law=f"yields by {law}", dx=grid.dx, dy=grid.dy)
