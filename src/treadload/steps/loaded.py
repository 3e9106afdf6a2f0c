"""The road of a case under its wheels, ready to be read anywhere, and what its damage reads there."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypedDict, Unpack

from numpy.typing import ArrayLike

from treadload.case import Case
from treadload.contact import Contact, Enveloped, envelop, solve_contact
from treadload.contact.contact_grid import NO_OFFSET
from treadload.damage import Verdict, assess
from treadload.damage.two_grids import COARSER, check_two_grids, only_on_fixed_cells, solving_coarser
from treadload.damage.verdict import with_error
from treadload.errors import InputError
from treadload.footprint import Footprint
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.pavement import Pavement
from treadload.response import GridLoad, Response, map_grid, settle, solve_response
from treadload.response.superposition import mean_loads
from treadload.tire import Tire

Progress = Callable[[str], None]


class CellKeys(TypedDict, total=False):
    """On which cells the contact of a case is solved, and of which tire, see `contact_of`."""

    spacing: float | None
    tire: Tire | None
    offset: tuple[float, float]


class Points(TypedDict, total=False):
    """Where a response is read, see `solve_response`."""

    x: ArrayLike
    y: ArrayLike
    points: ArrayLike


Touch = Callable[..., Contact]
"""Solves a contact of a case on cells of its spacing or another, see `contact_of`."""


def contact_of(
    case: Case,
    road: Pavement,
    tell: Progress,
    *,
    spacing: float | None = None,
    start: Contact | None = None,
    tire: Tire | None = None,
    offset: tuple[float, float] = NO_OFFSET,
) -> Contact:
    """The contact of a case, on cells of its spacing or another.

    start, offset: see `solve_contact`. tire: that of the case, where it is read already.
    """
    if tire is None:
        tell("reading the tire")
        tire = case.build_tire()
    return solve_contact(
        tire,
        road,
        case.build_rolling(),
        spacing=case.spacing if spacing is None else spacing,
        tolerance=case.source.tolerance_of(case),
        road_compliance=case.road_compliance,
        relief=case.build_relief(),
        start=start,
        offset=offset,
        progress=tell,
    )


@dataclass(frozen=True, eq=False)
class Loaded:
    """A road under the wheels of a case, ready to be read anywhere; stress-dependent layers have settled moduli.

    contact: None if a footprint was recorded. wheel: the load of one wheel; wheels: all of them in their places.
    enveloped: the contact that loads the layers, where the case spreads the pressure on peaks. touch: solves
    further contacts of the case, as `contact_of` does.
    """

    case: Case
    road: Pavement
    contact: Contact | None
    footprint: Footprint | None
    wheel: GridLoad
    wheels: list[GridLoad]
    tell: Progress
    enveloped: Enveloped | None = None
    touch: Touch = contact_of

    @property
    def grid(self) -> Grid:
        """The points of the maps."""
        return map_grid(self.wheels, self.road)

    @cached_property
    def shifted_wheels(self) -> list[GridLoad] | None:
        """All wheels on a grid shifted by half a cell, where an assessment takes the mean of both grids."""
        table, contact = self.case.damage, self.contact
        if table is None or table.lattices == 1 or table.depth is not None:
            return None
        what = only_on_fixed_cells(None if contact is None else contact.tire)
        if contact is None or what:
            if table.lattices == 2:
                raise InputError(f"{what} has one lattice of cells and is not known between them; give lattices = 1")
            return None
        self.tell("the same contact on cells half a cell beside")
        shifted = self.touch(
            self.case, self.road, self.tell, tire=contact.tire, offset=(0.5, 0.5),
            spacing=float(contact.dataset.attrs["dx"]),
        )  # fmt: skip
        placed: list[GridLoad] = self.case.response.place(
            GridLoad.from_dataset(shifted if self.enveloped is None else _enveloped(self.case, shifted))
        )
        return placed

    @property
    def read_wheels(self) -> list[GridLoad]:
        """The loads that surface criteria read: of all wheels, the mean of both lattices where there are two."""
        return self.wheels if self.shifted_wheels is None else mean_loads([self.wheels, self.shifted_wheels])

    def solve(
        self,
        depths: Sequence[float] | Array,
        *,
        mean_over: float | None = None,
        loads: Sequence[GridLoad] | None = None,
        **points: Unpack[Points],
    ) -> Response:
        """The response at depths, m, at x and y or `points`; on the grid of the maps where none of them is given.

        mean_over: length whose means are read near the surface, m, see `solve_response`. loads: in place of the
        wheels.
        """
        if not points:
            count = f" under {len(self.wheels)} wheels" if len(self.wheels) > 1 else ""
            self.tell(f"stress and strain in the road{count}")
            points = {"x": self.grid.x, "y": self.grid.y}
        # The response of an elastic road does not depend on speed.
        speed = self.case.speed if self.road.is_viscoelastic else None
        return solve_response(
            self.wheels if loads is None else loads, self.road, depths=depths, side=self.case.response.side,
            speed=speed, progress=self.tell, mean_over=mean_over, **points,
        )  # fmt: skip


def load_case(case: Case, tell: Progress, *, contact: Contact | None = None, touch: Touch = contact_of) -> Loaded:
    """The road of a case and what loads it.

    contact: that of the case, where it is known already. touch: solves the contacts of the case that are not.
    """
    if case.rolling is None and case.footprint is None:
        raise InputError(
            f"this case has [{case.source.name}], and no wheel whose response could be read; solve it by "
            f"treadload.run(case), or by `treadload {case.command}`"
        )
    road, footprint, enveloped = case.road(), None, None
    if case.footprint is None:
        contact = touch(case, road, tell) if contact is None else contact
        if case.texture is not None and case.texture.enveloping is not None:
            enveloped = _enveloped(case, contact)
        wheel = GridLoad.from_dataset(contact)
        if enveloped is not None:
            wheel = replace(GridLoad.from_dataset(enveloped), rib_sides=wheel.rib_sides)
    else:
        tell("reading the footprint")
        footprint = case.footprint.read(case.folder)
        wheel = footprint.load
    wheels = case.response.place(wheel)
    if road.depends_on_stress:
        tell("moduli of the stress-dependent layers")
        road = settle(wheels, road, speed=case.speed if road.is_viscoelastic else None).road
    return Loaded(case, road, contact, footprint, wheel, wheels, tell, enveloped, touch)


def judge(load: Loaded, response: Response) -> Verdict:
    """The assessment that the case of a loaded road asks for.

    response: at its depths; or of means, under `load.read_wheels`.
    """
    damage = load.case.damage
    assert damage is not None
    mean_read = "mean_over" in response.dataset.attrs
    verdict = assess(
        response, damage.fatigue.build(), shifted=None if mean_read else load.shifted_wheels, depth=damage.depth,
        strain=damage.strain, mean_over=damage.mean_over,
    )  # fmt: skip
    lattices = {"lattices": 2} if mean_read and load.shifted_wheels is not None else {}
    return replace(verdict, dataset=verdict.dataset.assign_attrs(lattices))


def on_two_grids(load: Loaded, verdict: Verdict) -> Verdict:
    """The assessment with what it is on cells twice as large."""
    case, tell = load.case, load.tell
    check_two_grids(None if load.contact is None else load.contact.tire)
    tell("error estimate")
    cell = load.wheel.grid.dx
    with solving_coarser(cell):
        contact = load.touch(case, load.road, tell, spacing=COARSER * cell)
    coarse = load_case(case, tell, contact=contact, touch=load.touch)
    return with_error(verdict, judge(coarse, coarse.solve(case.response.depths)), cell)


def _enveloped(case: Case, contact: Contact) -> Enveloped:
    """The contact that loads the layers, where the case spreads the pressure on peaks."""
    assert case.texture is not None
    assert case.texture.enveloping is not None
    return envelop(contact, case.texture.enveloping)
