"""A body pressed into a road that yields, through a history of loads: what comes out, and what can be pressed.

`load_steps` follows the loads, `yielding` is the ground below them.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from treadload import variables
from treadload.citations import DENTS
from treadload.composing import BaseResult, Holds
from treadload.contact.bodies.choose import Pair, road_surface, surface_of
from treadload.contact.bodies.influence import Influence
from treadload.contact.contact_grid import cell_across, check_border, place
from treadload.contact.load_steps import STEP_ERROR, Pressed, Pressing, step_error
from treadload.contact.rib_sections import prepare_ribs
from treadload.contact.rolling_state import Rolling
from treadload.contact.solvers.normal import solve_normal
from treadload.contact.yielding import Ground, Yielding
from treadload.deferred import xarray as xr
from treadload.errors import InputError, positive
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.kernels.eigenstrain.rows import graded_edges
from treadload.materials import ElastoPlastic, PassesPowerLaw, Perzyna
from treadload.pavement import Pavement
from treadload.rows import Row, row
from treadload.tire import Tire
from treadload.tire.rib_rows import shares_of_rows
from treadload.variables import SAMPLE

# Depth of the rows, in radii of the elastic contact under the largest load.
_DEEP = 2.2
# Row and variable by step.
_BY_STEP = (
    ("normal_load",) * 2, ("approach",) * 2, ("largest_pressure", "peak_pressure"), ("net_area", "contact_area"),
    ("largest_plastic_strain",) * 2, ("residual_displacement_z",) * 2,
)  # fmt: skip
# What a side of the box takes of the largest plastic strain, from where on the box is too small; and small strains.
_REACHED, _SMALL = 0.02, 0.05


@dataclass(frozen=True, eq=False)
class Indentation(BaseResult, group="indentation"):
    """A body pressed into a road that yields.

    dataset: normal_load, approach, contact_area, peak_pressure and largest_plastic_strain by step; the last two also
    with _error, what half as long steps of the load changed of them, an upper bound of what the steps leave; pressure
    and residual_displacement_z, what the surface keeps if it were unloaded, over (step, y, x);
    equivalent_plastic_strain over (step, depth, y, x). stats: rounds, substeps, step_error, seconds. warnings:
    sentences. tire, road, loads: the question.

    >>> yielding = tl.materials.ElastoPlastic(tl.Elastic(600e6, 0.35), tl.materials.VonMises(3e6, kinematic=60e6))
    >>> steel = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(210e9, 0.3))
    >>> road, cells = tl.Pavement.half_space(yielding), {"spacing": 0.002, "depth": 0.009, "layers": 3}
    >>> result = tl.contact.solve_indentation(steel, road, [150.0], **cells)
    >>> f"{result.dataset.peak_pressure.item() / 1e6:.1f} MPa"  # Hertz: 5.3 MPa, where nothing yields
    '5.5 MPa'
    """

    title: ClassVar[str] = "Indentation"
    subject: ClassVar[str] = "A body pressed into a road"
    holds: ClassVar[Holds] = Holds(
        {
            "step": "step", "depth": "depth", "y": "y", "x": "x",
            "normal_load approach contact_area peak_pressure largest_plastic_strain": "step",
            "pressure residual_displacement_z": "step y x",
            "equivalent_plastic_strain": "step depth y x",
        },
        not_nan="normal_load pressure residual_displacement_z",
        maybe={"peak_pressure_error largest_plastic_strain_error": "step"},
        texts="law",
        sizes={"step": (1, np.inf)},
    )  # fmt: skip

    dataset: xr.Dataset
    stats: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    tire: Tire | None = None
    road: Pavement | None = None
    loads: tuple[float, ...] = ()

    def cites(self) -> tuple[str, ...]:
        """Methods of the contact and of plastic strain."""
        return DENTS

    @property
    def heading(self) -> str:
        """The law of the road and the number of steps."""
        return f"{self.dataset.attrs['law']}; {self.dataset.sizes['step']} step(s)"

    def rows(self) -> tuple[Row, ...]:
        """Load, approach, peak pressure, plastic strain and dent, step by step; what half as long steps change."""
        data = self.dataset
        lines = [
            row(key, float(data[name][k].max()), group=f"step {k + 1}", display=SAMPLE.get(key))
            for k in range(data.sizes["step"])
            for key, name in _BY_STEP
        ]
        for name in ("peak_pressure_error", "largest_plastic_strain_error"):
            if name in data:
                most = float(data[name.removesuffix("_error")].max()) or 1.0
                share = f"{100 * float(data[name].max()) / most:.1f} % at most, by load steps half as long"
                lines.append(row(name, share))
        return tuple(lines)


def solve_indentation(
    tire: Tire,
    road: Pavement,
    loads: Sequence[float],
    *,
    spacing: float | None = None,
    depth: float | None = None,
    layers: int = 14,
    tolerance: float = 1e-3,
    progress: Callable[[str], None] | None = None,
) -> Indentation:
    """A body pressed into a road that yields, and lifted again: chippings, studs, plates, standing steel wheels.

    tire: the body, of any tire's kind, elastic; a `Tire.from_height_map` of a stiff material for a rigid one. road: a
    half-space of an ElastoPlastic whose law knows no time. loads: N, >= 0, one a step, in their order; 0 lifts it
    off. spacing: of the cells, m, as in `solve_contact`. depth: of what may yield, m; left out, 2.2 times the radius
    of the elastic contact under the largest load. layers: rows of cells in it. tolerance: of the plastic strain of a
    part of a step, relative. The contact has no friction, and depends on the dent. The way from load to load is
    taken in parts, which are halved until peak pressure and largest plastic strain change by less than 1.5 %; what
    the last halving changed is in the result, and in a warning where 32 parts are too few. Raises InputError, and
    ConvergenceError with the residual reached.

    >>> road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    >>> steel = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(210e9, 0.3))
    >>> tl.contact.solve_indentation(steel, road, [100.0, 0.0])
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: an indentation needs a half-space that yields:
    Pavement.half_space(ElastoPlastic(elastic, law))
    """
    start = time.perf_counter()
    tell = (lambda text: None) if progress is None else progress
    material, steps = _checked(road, loads, depth, layers, tolerance)
    pair = Pair(surface_of(tire.elastic, is_tire=True), road_surface(road))
    prepare_ribs(tire, cell_across(tire, spacing), tell)
    most = Rolling(normal_load=2 * max(steps), friction=1.0)
    grid, gap = place(tire, most, pair.both, spacing)
    influence = Influence(grid.shape, grid.dx, grid.dy, pair.both.at_rest, grid.y0)
    normal = solve_normal(influence, gap, load=max(steps), tolerance=1e-4)
    if depth is None:
        touched = normal.pressure > 0
        radius = 0.5 * max(touched.any(axis=0).sum() * grid.dx, touched.any(axis=1).sum() * grid.dy)
        depth = _DEEP * radius
    deep = depth
    ground = Ground(grid, material, graded_edges(0.0, deep, 0.8 * grid.dx, layers))
    tell(f"operators of {grid.nx} x {grid.ny} cells in {len(ground.depths)} rows")
    pressing = Pressing(Yielding(ground, ground.zone(normal.pressure)), influence, gap, normal.pressure, tolerance)

    def check(step: Pressed, number: int) -> None:
        if step.load:
            check_border(step.pressure, grid)
        _check_sides(step.state.hardening, deep, number)

    history = pressing.follow(steps, tell, check)
    error = step_error(history)
    stats = {
        "seconds": time.perf_counter() - start,
        "rounds": pressing.rounds,
        "substeps": sum(step.substeps for step in history),
        "step_error": error,
        "memory_mb": pressing.zone.stress_of_strain.bytes / 1e6,
    }
    shares = shares_of_rows(grid.y, grid.dy, tire.ribs)
    data = _dataset(grid, ground, history, type(material.law).__name__, shares)
    largest = float(data["largest_plastic_strain"].max())
    warnings = []
    if largest > _SMALL:
        warnings.append(
            f"the plastic strain reaches {100 * largest:.1f} %, above {100 * _SMALL:g} %: strains are taken as small"
        )
    if error > STEP_ERROR:
        warnings.append(
            "half as long sub-steps of the load still change the peak pressure or the largest plastic strain by "
            f"{100 * error:.1f} %, above {100 * STEP_ERROR:g} %; take smaller cells, or give loads between the "
            "present ones"
        )
    return Indentation(data, stats, tuple(warnings), tire, road, tuple(steps))


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
    steps = [float(load) for load in np.atleast_1d(np.asarray(loads, dtype=float))]
    if not steps or not np.isfinite(steps).all() or min(steps) < 0 or max(steps) <= 0:
        raise InputError(f"loads must be numbers >= 0 N with one above, got {list(loads)}; 0 lifts the body off")
    if depth is not None:
        positive("depth", depth, "metres", "leave it out for the default")
    if isinstance(layers, bool) or not isinstance(layers, int) or not 2 <= layers <= 64:
        raise InputError(f"layers must be a whole number in [2, 64], got {layers!r}; 14 is the default")
    if not 1e-6 <= tolerance <= 0.1:
        raise InputError(f"tolerance must lie in [1e-6, 0.1], got {tolerance:g}; 1e-3 is the default")
    return material, steps


def _check_sides(p: Array, depth: float, number: int) -> None:
    """Refuse a box that what yields has reached. p: equivalent plastic strain (nz, ny, nx)."""
    largest = float(p.max())
    sides = {"depth": p[-1], "length": p[:, :, [0, -1]], "width": p[:, [0, -1]]}
    for name, side in sides.items():
        if largest > 0 and float(side.max()) > _REACHED * largest:
            remedy = f"raise depth, now {depth:.3g} m" if name == "depth" else "give the body a larger height map"
            raise InputError(
                f"in step {number} the plastic zone reaches the {name} of the box, where it takes "
                f"{100 * float(side.max()) / largest:.0f} % of the largest plastic strain; {remedy}"
            )


def _dataset(grid: Grid, ground: Ground, steps: Sequence[Pressed], law: str, shares: Array) -> xr.Dataset:
    """shares: what part of a cell every row stands for, (ny,)."""
    pressure = np.array([step.pressure for step in steps])
    hardening = np.array([step.state.hardening for step in steps])
    fields: dict[str, tuple[tuple[str, ...], Any]] = {
        "normal_load": (("step",), np.array([step.load for step in steps])),
        "approach": (("step",), np.array([step.approach for step in steps])),
        "contact_area": (("step",), (pressure > 0).sum(axis=2) @ shares * grid.cell_area),
        "peak_pressure": (("step",), pressure.max(axis=(1, 2))),
        "peak_pressure_error": (("step",), np.array([step.peak_error for step in steps])),
        "largest_plastic_strain": (("step",), hardening.max(axis=(1, 2, 3))),
        "largest_plastic_strain_error": (("step",), np.array([step.strain_error for step in steps])),
        "pressure": (("step", "y", "x"), pressure),
        "residual_displacement_z": (("step", "y", "x"), np.array([step.sunk for step in steps])),
        "equivalent_plastic_strain": (("step", "depth", "y", "x"), hardening),
    }
    places = {"step": np.arange(1, len(steps) + 1), "depth": ground.depths, "y": grid.y, "x": grid.x}
    return variables.dataset(fields, places, law=f"yields by {law}", dx=grid.dx, dy=grid.dy)
