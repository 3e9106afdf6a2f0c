"""Creep curves: what a rolling tire carries, against how much it creeps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Literal

import numpy as np

from treadload.composing import BaseResult, Holds
from treadload.contact.rolling_state import Rolling
from treadload.contact.solution import Contact
from treadload.contact.solve import solve_contact
from treadload.contact.solvers.coupling import Progress
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.pavement import Pavement
from treadload.rows import Row, row
from treadload.tables import finite_list
from treadload.tire import Tire
from treadload.variables import dataset

_CURVE = (
    "tractive_force",
    "lateral_force",
    "aligning_moment",
    "creepage_x",
    "creepage_y",
    "normal_load",
    "approach",
    "friction_work_total",
)


@dataclass(frozen=True, eq=False)
class CreepCurve(BaseResult, group="creep_curve"):
    """Forces of a tire against its creepage.

    dataset: over `creepage`: tractive_force, lateral_force, aligning_moment, slip_fraction and the other scalars
    of a contact. along: "x" or "y". contacts: the contact of every creepage, in the order given.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.7)
    >>> curve = tl.contact.creep_curve(tire, road, wheel, [0.5], spacing=0.006)
    >>> f"{curve.dataset.slip_fraction.item():.0%} of the contact slides"
    '100% of the contact slides'
    """

    title: ClassVar[str] = "Creep curve"
    holds: ClassVar[Holds] = Holds(
        {
            "creepage friction normal_load tractive_force lateral_force aligning_moment slip_fraction": "creepage",
        },
        each={"creepage": "contacts"},
    )

    dataset: xr.Dataset
    along: str
    contacts: tuple[Contact, ...]

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences for the user, of all contacts."""
        return tuple(dict.fromkeys(text for contact in self.contacts for text in contact.warnings))

    @property
    def heading(self) -> str:
        """The direction of the creepage."""
        return f"creepage along {self.along}"

    def rows(self) -> tuple[Row, ...]:
        """Forces over friction times load, slip and moment by creepage."""
        lines = []
        for number, creepage in enumerate(self.dataset.creepage.values):
            here = self.dataset.isel(creepage=number)
            limit = float(here.friction * here.normal_load) or 1.0
            numbers = {
                "tractive_force_ratio": here.tractive_force / limit,
                "lateral_force_ratio": here.lateral_force / limit,
                "slip_fraction": here.slip_fraction, "aligning_moment": here.aligning_moment,
            }  # fmt: skip
            lines += [row(key, float(value), group=f"creepage {creepage:.5f}") for key, value in numbers.items()]
        return tuple(lines)


def creep_curve(
    tire: Tire,
    road: Pavement,
    rolling: Rolling,
    creepages: Sequence[float],
    *,
    along: Literal["x", "y"] = "x",
    spacing: float | None = None,
    tolerance: float = 1e-6,
    progress: Progress | None = None,
) -> CreepCurve:
    """Forces of a tire that rolls at one creepage after another.

    rolling: the rest of the rolling state; what it prescribes along `along` gives way to the creepages.
    creepages: (n,), distinct; solved from the smallest on, each from the solution before it.
    along: "x" for driving and braking, "y" for cornering. spacing, tolerance: as for `solve_contact`.
    Returns the curve in the order of the creepages. Raises InputError for creepages that are not numbers, and the
    errors of solve_contact.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.7)
    >>> curve = tl.contact.creep_curve(tire, road, wheel, [0.5], spacing=0.006)
    >>> f"{curve.dataset.tractive_force.item():.0f} N: the limit of friction"
    '-70 N: the limit of friction'
    """
    values = finite_list(creepages, "creepages")
    if np.unique(values).size != values.size:
        raise InputError(f"creepages must differ from each other, got {creepages!r}")
    if along not in ("x", "y"):
        raise InputError(f'along must be "x" or "y", got {along!r}')
    force = "tractive_force" if along == "x" else "lateral_force"
    by_number: dict[int, Contact] = {}
    start: Contact | None = None
    for number in np.argsort(np.abs(values), kind="stable"):
        if progress is not None:
            progress(f"creepage {values[number]:g}")
        here: dict[str, Any] = {force: None, f"creepage_{along}": float(values[number])}
        state = replace(rolling, **here)
        start = solve_contact(tire, road, state, spacing=spacing, tolerance=tolerance, start=start)
        by_number[int(number)] = start
    contacts = tuple(by_number[number] for number in range(values.size))
    scalars = {
        name: (("creepage",), np.array([float(c.dataset[name]) for c in contacts])) for name in (*_CURVE, "friction")
    }
    scalars["slip_fraction"] = (("creepage",), np.array([c.slip_fraction for c in contacts]))
    return CreepCurve(dataset(scalars, {"creepage": values}), along, contacts)
