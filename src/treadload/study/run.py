"""Run a case: tire, contact, response, verdict."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import xarray as xr

from treadload.case import Case
from treadload.contact import Contact, solve_contact
from treadload.damage import Verdict, assess
from treadload.kernels.arrays import Array
from treadload.pavement import Pavement
from treadload.response import Response, solve_response
from treadload.results import to_tree

Progress = Callable[[str], None]

_SLICE_DEPTHS = 31


@dataclass(frozen=True, eq=False)
class Result:
    """What a case gave.

    response: maps at the case's depths. slice_along, slice_across: vertical slices through the worst point,
    along travel and across it. verdict: None if the case has no fatigue line.
    """

    case: Case
    contact: Contact
    response: Response
    slice_along: Response
    slice_across: Response
    verdict: Verdict | None

    def to_tree(self) -> xr.DataTree:
        """All results in one tree with provenance, ready to be saved."""
        parts: list[Contact | Response | Verdict] = [self.contact, self.response, self.slice_along, self.slice_across]
        if self.verdict is not None:
            parts.append(self.verdict)
        return to_tree(parts, case=self.case)

    def summary(self) -> str:
        """One screen: contact, response, verdict."""
        parts = [self.contact.summary(), self.response.summary()]
        if self.verdict is not None:
            parts.append(self.verdict.summary())
        return "\n\n".join(parts)


def run_case(case: Case, progress: Progress | None = None) -> Result:
    """Compute everything that a case asks for.

    progress: called with a line of text at every stage.
    Raises the errors of reading, contact, response and verdict.
    """
    tell = progress or (lambda text: None)
    tell("reading the tire")
    tire = case.build_tire()
    road = case.pavement.build()
    contact = solve_contact(
        tire,
        road,
        case.rolling.build(case.folder),
        spacing=case.spacing,
        tolerance=case.tolerance,
        progress=tell,
    )
    tell("stress and strain in the road")
    response = solve_response(contact, road, depths=case.response.depths)
    along, across = _slices(contact, response, road, case.response.slice_depth)
    verdict = None
    if case.damage is not None:
        tell("verdict")
        line = case.damage.fatigue.build()
        verdict = assess(response, line, depth=case.damage.depth, strain=case.damage.strain)
    return Result(case, contact, response, along, across, verdict)


def _slices(contact: Contact, response: Response, road: Pavement, bottom: float) -> tuple[Response, Response]:
    """Vertical slices through the point of the largest extension at the first depth."""
    strain = response.dataset.principal_strain_1.isel(depth=0)
    row, column = np.unravel_index(int(np.argmax(strain.values)), strain.shape)
    x, y = float(strain.x[column]), float(strain.y[row])
    depths = _graded_depths(bottom, float(contact.dataset.attrs["dx"]))
    return (
        solve_response(contact, road, depths=depths, y=[y]),
        solve_response(contact, road, depths=depths, x=[x]),
    )


def _graded_depths(bottom: float, cell: float) -> Array:
    """Depths from the surface to the bottom, close to each other near the surface where strain varies fast.

    None lies between the surface and half a cell: there the field shows the edges of the cells.
    """
    first = min(0.5 * cell, 0.5 * bottom)
    return np.concatenate([[0.0], np.geomspace(first, bottom, _SLICE_DEPTHS - 1)])
