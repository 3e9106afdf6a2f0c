"""Wheels put together: dual wheels, axles and groups of axles, for `solve_response` to superpose in one pass.

y points to the right, x ahead. A load is a contact, a dataset, a GridLoad, a UniformDisc or a UniformRectangle;
several make a group. Every function returns a tuple of loads, so that they nest:

    wheel = UniformDisc(0.125, 0.662e6)
    axle(wheel, track=1.8, dual_spacing=0.375)        # the French standard axle of 130 kN
    tandem(axle(contact, track=2.0), wheelbase=1.35)
"""

from __future__ import annotations

from collections.abc import Sequence

from treadload.deferred import xarray as xr
from treadload.errors import InputError, positive
from treadload.response.loads import GridLoad, Load, PlacedLoad, gather

# Side force over the load, above which a wheel does not roll straight.
_SIDE = 0.01


def place_load(load: Load, *, x: float = 0.0, y: float = 0.0, mirror: bool = False) -> PlacedLoad:
    """A load elsewhere: mirrored in the plane y = 0 if asked, then moved by x and y, m.

    load: one load; a contact becomes a GridLoad. Raises InputError for several loads or a move that is not a number.

    >>> road, tire = tl.Pavement.half_space(tl.Elastic(100e6, 0.35)), tl.UniformDisc(0.125, 662e3)
    >>> pair = [tire, tl.response.place_load(tire, y=0.375)]
    >>> below = [tl.solve_response(load, road, depths=[1.0], points=[[0.0, 0.0]]) for load in (tire, pair)]
    >>> [f"{response.dataset.stress_zz.item() / 1e3:.1f} kPa" for response in below]
    ['-15.2 kPa', '-26.3 kPa']
    """
    gathered = gather(load)
    if len(gathered) != 1:
        raise InputError(f"place_load takes one load, got {len(gathered)}; place each of them")
    placed = gathered[0].mirrored() if mirror else gathered[0]
    return placed.moved(x, y)


def dual_wheels(load: Load, spacing: float, *, mirrored: bool | None = None) -> tuple[PlacedLoad, ...]:
    """Two equal wheels side by side, at y = -spacing/2 and y = spacing/2 from where the load stands.

    spacing: between the wheels' centres, m, > 0. mirrored: whether the left one is the mirror image of the load in
    the plane of its wheel, as the two tires of a pair are mounted back to back: what faces outward on the right one
    faces inward on the left one. Left out: yes, unless the load rolls with spin or carries a side force of more than
    1 % of its weight, which a mirror would reverse; for the pair in a bend solve the turned tire too and
    `place_load` both. A symmetric tire that rolls straight gives two equal loads either way.
    Raises InputError for a wrong spacing.

    >>> wheels = tl.response.dual_wheels(tl.UniformDisc(0.125, 662e3), 0.375)
    >>> [round(wheel.y, 4) for wheel in wheels]
    [-0.1875, 0.1875]
    """
    positive("the spacing of dual wheels", spacing, "metres", "trucks have near 0.35")
    turned = not any(_leans(wheel) for wheel in _each(load)) if mirrored is None else mirrored
    right = gather(load)
    left = tuple(wheel.mirrored().moved(y=2 * _middle(wheel)) if turned else wheel for wheel in right)
    return tuple(wheel.moved(y=side * spacing / 2) for side, pair in ((-1, left), (1, right)) for wheel in pair)


def _middle(load: PlacedLoad) -> float:
    """Where the plane of the wheel stands, m."""
    return sum(load.extent_y) / 2 if isinstance(load, GridLoad) else load.y


def _each(load: Load | Sequence[Load]) -> Sequence[Load]:
    return load if isinstance(load, Sequence) else [load]


def _leans(load: Load) -> bool:
    """Whether a load is one of a wheel that rolls with spin, or carries a side force."""
    data = load if isinstance(load, xr.Dataset) else getattr(load, "dataset", None)
    if data is not None and "spin" in data and float(data["spin"]) != 0:
        return True
    return any(abs(getattr(wheel, "lateral_force", 0.0)) > _SIDE * wheel.normal_load for wheel in gather(load))


def axle(load: Load | Sequence[Load], track: float, dual_spacing: float | None = None) -> tuple[PlacedLoad, ...]:
    """An axle: the wheel at y = track/2 on the right and its mirror image on the left.

    load: the right wheel, centred at y = 0. track: between the centres of the wheels, or of the pairs of dual
    wheels, m, > 0. dual_spacing: between the centres of dual wheels, m, smaller than the track; None: single
    wheels. Raises InputError for a wrong length.

    >>> wheels = tl.response.axle(tl.UniformDisc(0.125, 662e3), 1.8)
    >>> len(wheels)
    2
    """
    positive("the track of an axle", track, "metres", "trucks have near 2")
    wheels = gather(load)
    if dual_spacing is not None:
        if dual_spacing >= track:
            raise InputError(f"the dual spacing {dual_spacing:g} m must be smaller than the track, {track:g} m")
        wheels = tuple(wheel for load in wheels for wheel in dual_wheels(load, dual_spacing))
    right = tuple(wheel.moved(y=track / 2) for wheel in wheels)
    return (*(wheel.mirrored() for wheel in right), *right)


def tandem(loads: Load | Sequence[Load], wheelbase: float, axles: int = 2) -> tuple[PlacedLoad, ...]:
    """Equal axles one behind another, centred along x on where the loads stand.

    loads: one axle, or one wheel. wheelbase: between neighbouring axles, m, > 0. axles: 2 for a tandem, 3 for a
    tridem. Raises InputError for a wrong length or number.

    >>> wheels = tl.response.tandem(tl.UniformDisc(0.125, 662e3), 1.31)
    >>> len(wheels)
    2
    """
    positive("the wheelbase", wheelbase, "metres", "a tandem has near 1.3")
    if isinstance(axles, bool) or not isinstance(axles, int) or axles < 1:
        raise InputError(f"axles must be a whole number of at least 1, got {axles!r}")
    gathered = gather(loads)
    return tuple(load.moved(x=((axles - 1) / 2 - k) * wheelbase) for k in range(axles) for load in gathered)
