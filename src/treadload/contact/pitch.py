"""A tread with blocks rolls through one pitch: pressure and shear at every position of the wheel.

Steady rolling does not exist on blocks: the contact repeats after a pitch. It is marched, step by step as in
`solve_transient`, from a standing wheel until a pitch repeats the one before.
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, Unpack

import numpy as np

from treadload.composing import BaseResult, Holds
from treadload.contact import cautions
from treadload.contact.bodies.blocks import belt_alone
from treadload.contact.bodies.body import Body
from treadload.contact.bodies.choose import Pair, road_surface, surface_of
from treadload.contact.contact_grid import DEFAULT_SPACING, place
from treadload.contact.fields import loads, tractions
from treadload.contact.numerics import Numerics, NumericsKeys
from treadload.contact.pitch_window import Window
from treadload.contact.rolling_state import Rolling
from treadload.contact.solution import Contact
from treadload.contact.solvers.marching import State
from treadload.deferred import xarray as xr
from treadload.errors import ConvergenceError, GeometryError, InputError, positive
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.materials import Elastic
from treadload.pavement import Pavement
from treadload.rows import Row, row
from treadload.tire import Tire
from treadload.tire.belt import InflatedBelt
from treadload.tire.grooves import LateralGrooves
from treadload.tire.lugs import LuggedTread, lugged_tread
from treadload.tire.ribs import section_of
from treadload.tire.tread import ProfileSurface
from treadload.variables import dataset

POSITIONS = 12
"""Positions of the wheel in a pitch."""
_FEWEST_POSITIONS, _MOST_POSITIONS = 4, 200
_TOLERANCES = (1e-9, 1e-2)
# Blocks are softer than the layer by which the contact is located, m.
_FURTHER = 0.012
_MOST_PITCHES = 40
_BY_POSITION = (
    "normal_load", "approach", "contact_area", "largest_pressure", "largest_traction", "tractive_force",
    "lateral_force", "aligning_moment", "creepage_x", "creepage_y", "slip_fraction", "friction_energy",
)  # fmt: skip
_SCALARS = ("approach", "normal_load", "tractive_force", "lateral_force", "aligning_moment", "creepage_x")
_FIELDS = ("pressure", "traction_x", "traction_y", "state")


# Of the conditions of every step.
_TOLERANCE = 1e-4


@dataclass(frozen=True, eq=False)
class PitchPassage(BaseResult, group="pitch"):
    """What one pitch of a tread with blocks does to a road, with the question that was asked.

    dataset: numbers over (position,), the place of the axle within the pitch, and pressure, traction_x, traction_y
    and state over (position, y, x) in the frame of the road, on which the blocks stand where they stick; attributes
    pitch, m, and change, the largest difference from the pitch before. stats: iterations, seconds.

    >>> passage = tl.open_results("pitch.nc").pitch  # of tl.contact.solve_pitch, which takes 10 s
    >>> loads = passage.dataset.normal_load.values
    >>> f"{loads.mean():.0f} N at every one of {len(loads)} positions"
    '500 N at every one of 4 positions'
    """

    title: ClassVar[str] = "Passage of one pitch"
    holds: ClassVar[Holds] = Holds(
        {
            " ".join(_BY_POSITION): "position",
            "spin": "",
            " ".join(_FIELDS): "position y x",
        },
        finite="pressure traction_x traction_y normal_load tractive_force lateral_force approach",
        codes={"state": 3},
        numbers="dx dy pitch change",
        positive="dx dy pitch",
        sizes={"position": (_FEWEST_POSITIONS, _MOST_POSITIONS)},
    )

    dataset: xr.Dataset
    tire: Tire
    road: Pavement
    rolling: Rolling
    stats: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    @property
    def heading(self) -> str:
        """Load, friction and rolling state."""
        return str(self.rolling)

    @property
    def worst(self) -> int:
        """Number of the position with the largest shear of a cell."""
        return int(self.dataset["largest_traction"].to_numpy().argmax())

    def contact(self, number: int) -> Contact:
        """The contact at a position, in the frame of the wheel, as `solve_response` and others take it.

        Raises InputError for a number that is no position.
        """
        count = self.dataset.sizes["position"]
        if not -count <= number < count:
            raise InputError(f"the pitch has positions 0 to {count - 1}, got {number}")
        data = self.dataset.isel(position=number)
        grid = {"x": data["x"].to_numpy() - float(data["position"]), "y": data["y"].to_numpy()}
        named = {name: (("y", "x"), data[name].transpose("y", "x").to_numpy()) for name in _FIELDS}
        numbers = {name: ((), float(data[name])) for name in (*_SCALARS, "creepage_y", "spin")}
        fields = dataset({**named, **numbers}, grid, dx=data.attrs["dx"], dy=data.attrs["dy"])
        return Contact(fields, self.tire, self.road, self.rolling, self.stats, self.warnings)

    @property
    def contacts(self) -> tuple[Contact, ...]:
        """The contacts at all positions, one by one, whose responses are those of a passage."""
        return tuple(self.contact(number) for number in range(self.dataset.sizes["position"]))

    def rows(self) -> tuple[Row, ...]:
        """Pitch and positions; mean and worst of peaks, forces and area over the pitch; what each position has."""
        d = self.dataset
        count, at = d.sizes["position"], d["position"].to_numpy()
        work = float(d["friction_energy"].sum())

        def over(name: str) -> Row:
            values = d[name].to_numpy()
            where = int(np.abs(values).argmax())
            note = f"axle at {at[where] * 1e3:.1f} mm, mean {row(_key(name), float(values.mean())).text}"
            return row(_key(name), float(values[where]), note=note)

        return (
            row("pitch", float(d.attrs["pitch"]), note=f"{count} positions"),
            row("periodicity", float(d.attrs["change"]), note="of shear, from one pitch to the next"),
            row("normal_load", float(d["normal_load"].mean())),
            *(over(name) for name in ("largest_pressure", "largest_traction", "contact_area", "approach")),
            *(over(name) for name in ("tractive_force", "lateral_force", "slip_fraction")),
            row("friction_energy", work, note="over the pitch"),
            *(
                row(_key(name), float(d[name][k]), group=f"axle at {at[k] * 1e3:.1f} mm")
                for k in range(count)
                for name in (
                    "largest_pressure",
                    "largest_traction",
                    "contact_area",
                    "tractive_force",
                    "lateral_force",
                )
            ),
        )

    def __repr__(self) -> str:
        peak = float(self.dataset["largest_pressure"].max()) / 1e3
        return f"<PitchPassage {self.rolling}: {self.dataset.sizes['position']} positions, {peak:.0f} kPa peak>"


def _key(name: str) -> str:
    """The row of a variable."""
    return "net_area" if name == "contact_area" else name


def solve_pitch(
    tire: Tire,
    road: Pavement,
    rolling: Rolling,
    *,
    lateral: Sequence[LateralGrooves] = (),
    positions: int = POSITIONS,
    spacing: float | None = None,
    periodic: float = 0.01,
    **numerics: Unpack[NumericsKeys],
) -> PitchPassage:
    """Roll a tread with blocks through one pitch, after as many as it takes to repeat itself.

    tire: on a belt, with a profile that has lateral grooves, or a scan. lateral: the grooves that cut the ribs of a
    scan or of a profile without lateral grooves; all blocks have free sides and are bonded to the belt. rolling:
    forces or creepages, as in `solve_transient`; friction that does not fall with slip. positions: of the wheel in a
    pitch, 4 to 200. spacing: of the cells, m, 3 mm if left out; along travel the nearest that divides the pitch.
    periodic: by which pressure and shear may still change from a pitch to the next, relative. numerics: tolerance=,
    of the conditions of every step, 1e-4 if left out; road_compliance=, progress= as in `solve_contact`. Returns the
    fields at all positions. Raises InputError for a tire without blocks, sipes among them, GeometryError if the
    contact is larger than the surface, ConvergenceError if pitches do not come to repeat each other. Method: blocks
    by 3-D finite elements (`kernels.sections`), history by Kalker (1990), section 4.2.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.7)
    >>> tl.contact.solve_pitch(tire, road, wheel)
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: blocks need a belt: give belt, such as Belt.from_library("315/80R22.5")
    """
    began = time.perf_counter()
    keys: NumericsKeys = {"tolerance": _TOLERANCE, **numerics}
    how = Numerics(**keys)
    tolerance, road_compliance, tell = how.tolerance, how.road_compliance, how.tell
    _check(rolling, positions, tolerance, periodic)
    tread = lugged_tread(tire, tuple(lateral))
    assert tire.belt is not None
    tire = replace(tire, belt=tire.belt.under_ribs())
    inflated = tire.carcass
    assert isinstance(inflated, InflatedBelt)
    if not isinstance(inflated.belt.tread, Elastic):
        raise InputError(
            "blocks are of elastic rubber, got a viscoelastic tread of the belt; give its limit, tread.glassy or "
            "tread.rubbery"
        )
    tell("locating the contact")
    window = _window(tire, tread, rolling, road_surface(road, road_compliance), (spacing, positions))
    tell(f"compliance of {tread.pattern}")
    if rolling.law.largest > 0:
        window.pair.check_shear()
    assert window.influence.patches is not None
    tell("standing wheel")
    state = window.stand(rolling, tolerance)
    last: list[State] = []
    change, newton, products = math.inf, 0, 0
    for pitch in range(1, _MOST_PITCHES + 1):
        passage: list[State] = []
        for number, after in enumerate(window.roll(rolling, state, tolerance), 1):
            tell(f"pitch {pitch}, position {number} of {positions}")
            _check_border(window, after, number)
            passage.append(after)
            newton, products = newton + after.tangential.newton, products + after.tangential.products
        if last:
            change = max(_change(now, before) for now, before in zip(passage, last, strict=True))
        last, state = passage, window.moved_on(passage[-1])
        if change <= periodic:
            break
    else:
        raise ConvergenceError(
            f"pressure and shear still change by {change:.2e} from one pitch to the next after {_MOST_PITCHES}, "
            f"above {periodic:.2e}; raise periodic, or lower the tolerance of {tolerance:.1e}",
            change,
        )
    stats = {
        "pitches": pitch,
        "positions": positions,
        "change": change,
        "newton_iterations": newton,
        "products": products,
        "dundurs": window.influence.dundurs,
        "cells": window.grid.nx * window.grid.ny,
        "blocks": len(tread.pattern.blocks),
        "land_ratio": tread.pattern.land_ratio,
        "tolerance": tolerance,
        "seconds": time.perf_counter() - began,
    }
    data = _dataset(window, rolling, passage, change)
    return PitchPassage(data, tire, road, rolling, stats, tuple(_warnings(window, rolling)))


def check_positions(positions: int) -> None:
    """Refuse numbers of positions in a pitch that no passage has. Raises InputError."""
    if not _FEWEST_POSITIONS <= positions <= _MOST_POSITIONS:
        raise InputError(
            f"positions must lie in [{_FEWEST_POSITIONS}, {_MOST_POSITIONS}], got {positions}; {POSITIONS} is the "
            "default"
        )


def _check(rolling: Rolling, positions: int, tolerance: float, periodic: float) -> None:
    check_positions(positions)
    low, high = _TOLERANCES
    if not low <= tolerance <= high:
        raise InputError(f"tolerance must lie in [{low:g}, {high:g}], got {tolerance:g}; 1e-4 is the default")
    positive("periodic", periodic, "of the fields, relative", "0.01 is the default")
    if rolling.law.needs_speed:
        raise InputError(
            f"friction {rolling.law} falls with slip, and a history does not follow that: its steps would depend on "
            "their length; give friction that depends on pressure and place only"
        )
    if rolling.normal_load is not None:
        rolling.check_friction_limit(rolling.normal_load)


def _window(tire: Tire, tread: LuggedTread, rolling: Rolling, road: Body, cells: tuple[float | None, int]) -> Window:
    """The window that holds the contact on its way through a pitch, with a block beyond on both sides."""
    spacing, positions = cells
    step = DEFAULT_SPACING if spacing is None else spacing
    positive("spacing", step, "metres", "3 mm is 0.003")
    period = tread.pattern.period
    smooth = replace(tire, surface=tread.smooth, tread="layer")
    layer = Pair(surface_of(smooth.elastic, is_tire=True), road)
    located, _ = place(smooth, rolling, layer.both, step)
    inflated = tire.carcass
    assert isinstance(inflated, InflatedBelt)
    number = max(1, round(period / step))
    dx = period / number
    ahead = 0.5 * located.nx * located.dx + _FURTHER + tread.pattern.longest
    behind = math.ceil(ahead / dx)
    # A row of cells more at both sides than the outermost blocks have.
    widest = max(abs(y + block.y) for block in tread.pattern.blocks for _, y in block.block.corners)
    rows = min(located.ny // 2 + 1, math.ceil(widest / step) + 1)
    grid = Grid(2 * behind + number, 2 * rows + 1, dx, step, (0.5 - behind) * dx, -rows * step)
    return Window(tire, tread, belt_alone(inflated, road), grid, number, positions)


def _check_border(window: Window, state: State, number: int) -> None:
    """Refuse a contact that reaches blocks which do not lie whole in the window."""
    pressed = np.asarray(state.pressure > 0)
    if not pressed.any():
        raise InputError("the approach does not bring tire and road into contact; raise it")
    free = math.ceil(window.pattern.longest / window.grid.dx)
    columns, rows = np.asarray(pressed.any(0)), np.asarray(pressed.any(1))
    if columns[:free].any() or columns[-free:].any() or rows[[0, -1]].any():
        raise GeometryError(
            f"the contact reaches the border of the window on the tread at position {number}: the tread is known on "
            f"{window.grid.nx * window.grid.dx * 1e3:.0f} x {window.grid.ny * window.grid.dy * 1e3:.0f} mm; lower "
            "the load or raise the inflation pressure"
        )


def _change(now: State, before: State) -> float:
    """Largest relative difference of pressure and of shear."""
    pressure = np.linalg.norm(now.pressure - before.pressure) / np.linalg.norm(now.pressure)
    shear = np.linalg.norm(now.tangential.shear)
    apart = np.linalg.norm(now.tangential.shear - before.tangential.shear)
    return float(max(pressure, apart / shear if shear > 0 else 0.0))


def _dataset(window: Window, rolling: Rolling, passage: Sequence[State], change: float) -> xr.Dataset:
    at = window.step * np.arange(1, len(passage) + 1)
    rows = [_row(window, rolling, state, float(axle)) for state, axle in zip(passage, at, strict=True)]
    names = {name: np.array([line[name] for line in rows]) for name in rows[0]}
    dims = {1: ("position",), 3: ("position", "y", "x")}
    fields: dict[str, Any] = {name: (dims[values.ndim], values) for name, values in names.items()}
    fields["spin"] = ((), rolling.spin)
    grid = window.grid
    data = dataset(fields, {"position": at, "x": grid.x, "y": grid.y}, dx=grid.dx, dy=grid.dy)
    return data.assign_attrs(pitch=window.pattern.period, change=change)


def _row(window: Window, rolling: Rolling, state: State, axle: float) -> dict[str, float | Array]:
    """What a position has."""
    grid, tangential, pressed = window.grid, state.tangential, state.pressure > 0
    shear = tangential.shear
    solved, imposed = np.array(state.displaced) / window.step, rolling.creepages
    creepages = [solved[c] if force is not None else imposed[c] for c, force in enumerate(rolling.forces)]
    return {
        **loads(window.seen_from(axle), state.pressure, shear),
        "approach": math.nan if state.normal is None else state.normal.approach,
        "contact_area": float(pressed.sum()) * grid.cell_area,
        "largest_pressure": float(state.pressure.max()),
        "largest_traction": float(np.hypot(*shear).max()),
        "creepage_x": float(creepages[0]),
        "creepage_y": float(creepages[1]),
        "slip_fraction": float((pressed & ~tangential.stick).sum() / pressed.sum()),
        "friction_energy": 0.0 + state.work(grid.cell_area),
        "pressure": state.pressure,
        **tractions(state.pressure, tangential),
    }


def _warnings(window: Window, rolling: Rolling) -> list[str]:
    tire = window.tire
    assert tire.belt is not None
    warnings = [*cautions.of_tire(tire), *cautions.of_numbers(tire, rolling, window.grid)]
    if isinstance(tire.surface, ProfileSurface):
        warnings += cautions.of_tie_bars(section_of(tire.surface.profile))
    warnings += cautions.of_rubber("blocks", tire.belt)
    if window.pattern.is_joined:
        warnings.append(
            "the undertread or a tie bar between blocks reaches higher than 40 % of the tread, and what it passes "
            "from block to block is left out"
        )
    return warnings
