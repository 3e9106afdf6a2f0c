"""How much a verdict depends on the contact's cells: the same question on cells twice as large."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from treadload.contact import Rolling, solve_contact
from treadload.contact.solve import DEFAULT_SPACING
from treadload.damage import Verdict, assess
from treadload.damage.laws.fatigue import PowerLaw
from treadload.errors import InputError
from treadload.pavement import Pavement
from treadload.response import solve_response
from treadload.tire import Tire

COARSER = 2.0


def assess_on_two_grids(
    tire: Tire,
    road: Pavement,
    rolling: Rolling,
    line: PowerLaw,
    *,
    spacing: float = DEFAULT_SPACING,
    depths: Sequence[float] = (0.0,),
    speed: float | None = None,
    **reading: Any,
) -> Verdict:
    """A verdict with an estimate of how much the contact's cells change it.

    Contact, response and verdict are solved on cells of `spacing`, m, and on cells twice as large. The difference of
    the two readings is the error of the finer one where that is of first order, three times as much where it is of
    second. The part that depends on where the cells lie at the edges of ribs need not fall: see
    `shifted` of `assess`.
    depths, speed: of `solve_response`. reading: keywords of `assess`.
    Returns the verdict on the finer cells, with the estimate in its summary and the coarser reading in its
    attributes.
    Raises InputError for a height map, whose cells are fixed, and what contact, response and verdict raise.
    """
    check_two_grids(tire)

    def solve(cells: float) -> Verdict:
        contact = solve_contact(tire, road, rolling, spacing=cells)
        return assess(solve_response(contact, road, depths=depths, speed=speed), line, **reading)

    return with_error(solve(spacing), solve(COARSER * spacing), spacing)


def check_two_grids(tire: Tire | None) -> None:
    """Raise InputError for what can be solved on its own cells only; None stands for a recorded footprint."""
    if what := known_on_its_cells(tire):
        raise InputError(f"an error estimate solves the contact on two grids, and {what} has one; leave it out")


def known_on_its_cells(tire: Tire | None) -> str:
    """What is known on its own cells only, in words; empty for what others know too. None: a recorded footprint."""
    if tire is None:
        return "a recorded footprint"
    return "" if tire.fixed_grid is None else "a height map"


def with_error(verdict: Verdict, coarse: Verdict, spacing: float) -> Verdict:
    """A verdict on cells of `spacing`, m, that states what it read on coarser ones."""
    about = {
        "spacing": spacing,
        "coarse_spacing": COARSER * spacing,
        "coarse_strain": float(coarse.dataset["worst_strain"]),
    }
    return replace(verdict, dataset=verdict.dataset.assign_attrs(about))
