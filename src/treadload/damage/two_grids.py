"""The contacts of a response solved again on other cells: shifted by half a cell, or twice as large."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from treadload.composing import Source
from treadload.contact import Contact, solve_contact
from treadload.contact.bodies.choose import RoadCompliance
from treadload.contact.solve import Search
from treadload.contact.tractions import solve_tractions
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.response import Response, solve_response
from treadload.response.loads import GridLoad, PlacedLoad
from treadload.tire import Tire

COARSER = 2.0


def shifted_loads(response: Source) -> list[PlacedLoad]:
    """Loads of the contacts of a response on cells half a cell beside.

    Raises InputError where they cannot be solved again.
    """
    return [_load_beside(contact) for contact in _solvable(response).contacts]


def coarser(response: Source) -> Response:
    """A response to its contacts on cells twice as large. Raises InputError where they cannot be solved again."""
    solved = _solvable(response)
    contacts = solved.contacts
    places: dict[str, Array | None] = {}
    for name in ("x", "y"):
        at = solved.dataset[name].to_numpy()
        of_the_contact = len(contacts) == 1 and np.array_equal(at, contacts[0].dataset[name].to_numpy())
        places[name] = None if of_the_contact else at
    assert solved.road is not None
    depths = solved.dataset["depth"].to_numpy()
    with solving_coarser(cell_of(response)):
        wide = [_coarser_contact(contact) for contact in contacts]
    x, y = places["x"], places["y"]
    return solve_response(wide, solved.road, depths=depths, x=x, y=y, speed=solved.speed, side=solved.side)


@contextmanager
def solving_coarser(cell: float) -> Iterator[None]:
    """An InputError inside states that it is about the coarser grid. cell: side of the cells asked for, m."""
    try:
        yield
    except InputError as error:
        raise InputError(
            f"error_estimate solves the contact on cells of {COARSER * cell * 1e3:g} mm as well, twice the spacing "
            f"of {cell * 1e3:g} mm: {error}; or leave error_estimate out"
        ) from error


def cell_of(response: Source) -> float:
    """Side of the cells of a response's contacts, m."""
    return float(_solvable(response).contacts[0].dataset.attrs["dx"])


def _solvable(response: Source) -> Response:
    if not isinstance(response, Response) or not response.contacts:
        raise InputError(
            "a second grid needs the contacts of the response, and this one does not have them: solve that of a "
            "contact, tl.solve_response(contact, road, depths=...), or give the shifted contact yourself"
        )
    for contact in response.contacts:
        check_two_grids(contact.tire)
        if "road_height" in contact.dataset:
            raise InputError(
                "a second grid solves the contact again, and its relief is not kept; give the shifted "
                "contact yourself"
            )
    return response


def _coarser_contact(contact: Contact) -> Contact:
    """A contact on cells twice as large."""
    return solve_contact(
        contact.tire,
        contact.road,
        contact.rolling,
        spacing=COARSER * float(contact.dataset.attrs["dx"]),
        tolerance=_tolerance(contact),
        road_compliance=_compliance(contact),
    )


def _load_beside(contact: Contact) -> GridLoad:
    """What a contact loads the road with on cells moved by half a cell both ways."""
    cell = float(contact.dataset.attrs["dx"])
    search = Search(cell, (0.5, 0.5), _tolerance(contact), _compliance(contact))
    solved = solve_tractions(contact.tire, contact.road, contact.rolling, search)
    return GridLoad(solved.grid, solved.pressure, solved.shear[0], solved.shear[1])


def _tolerance(contact: Contact) -> float:
    return float(contact.stats.get("tolerance", 1e-6))


def _compliance(contact: Contact) -> RoadCompliance:
    return "layers" if contact.stats.get("layers_solved") else "half_space"


def check_two_grids(tire: Tire | None) -> None:
    """Raise InputError for what exists on fixed cells only. None: a recorded footprint."""
    if what := only_on_fixed_cells(tire):
        raise InputError(f"an error estimate solves the contact on two grids, and {what} has one; leave it out")


def only_on_fixed_cells(tire: Tire | None) -> str:
    """What exists on fixed cells only, in words; empty for a tread of any cells. None: a recorded footprint."""
    if tire is None:
        return "a recorded footprint"
    return "" if tire.fixed_grid is None else "a height map"
