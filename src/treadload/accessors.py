"""What a later room offers of a result, as the figures behind `contact.plot`, without an arrow that runs back.

The room registers what it offers when it is imported; who imports it when it is first asked for is stated in
`treadload/__init__.py`, for rooms of this package, or by whoever brings another.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

Offer = TypeVar("Offer", bound=Callable[..., Any])

_OFFERS: dict[tuple[str, str], Callable[[Any], Any]] = {}
_ROOMS: dict[str, Callable[[], object]] = {}


def offers(name: str, *kinds: str) -> Callable[[Offer], Offer]:
    """Decorator: this, called with a result, is what `result.name` gives. kinds: names of the results' classes."""

    def register(offer: Offer) -> Offer:
        _OFFERS.update(dict.fromkeys(((name, kind) for kind in kinds), offer))
        return offer

    return register


def found_in(name: str, room: Callable[[], object]) -> None:
    """Say where offers of a name come from. room: imports what registers them, when one is first asked for."""
    _ROOMS[name] = room


def offered(name: str, result: object) -> Any:
    """What is offered of a result under a name. Raises AttributeError where nothing is."""
    kinds = [one.__name__ for one in type(result).__mro__]
    if not any((name, kind) in _OFFERS for kind in kinds) and name in _ROOMS:
        _ROOMS[name]()
    for kind in kinds:
        if (name, kind) in _OFFERS:
            return _OFFERS[name, kind](result)
    raise AttributeError(f"{kinds[0]!r} has no {name!r}: no room offers it")


def room_of(name: str) -> None:
    """Import what registers under a name, so that all of it is known."""
    if name in _ROOMS:
        _ROOMS[name]()
