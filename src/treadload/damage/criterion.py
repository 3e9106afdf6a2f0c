"""A criterion: a quantity at a place of a road, and the law that gives the load repetitions to failure there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal, Self

import numpy as np

from treadload.damage.cracks import crack_plane
from treadload.damage.laws.bond import BondStrength, BondUtilisation, ShearFatigue
from treadload.damage.laws.fatigue import FatigueLaw
from treadload.damage.quantity import (
    IN_THE_PLANE,
    STRESS,
    Place,
    Quantity,
    Reading,
    check_reading,
    cut,
    in_tension,
    ordered,
    tension,
)
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.materials.kinds import AnyElastic, upright
from treadload.pavement import Pavement
from treadload.response import MATERIAL_LENGTH
from treadload.response.material import check_length

Side = Literal["above", "below"]

# At which a law that depends on temperature is asked what it reads.
_ANY_TEMPERATURE = 15.0
# How far a criterion looks below its place at most, and how near to the end of its layer, m.
_FARTHEST, _OFF_THE_END = 0.5, 1e-6


@dataclass(frozen=True)
class Criterion:
    """A quantity at a place of the road, and the law that gives the load repetitions until the road fails there.

    name: for tables and figures. law: a fatigue law; or a function that gives it at a temperature of the
    layer, °C. layer: counted from the surface, 0 is the top one, negative from the bottom. place: "top" or
    "bottom" of the layer, or "interface", the bond below the layer, counted as `interface_number` does; left out,
    the usual one of what the law reads. strain: "principal" reads an extension in space, "in-plane" in the horizontal
    plane; left out, as the law's quantity does, and for all others it does not matter.
    length: of the mean over a cube of road that is read near the surface where what the law reads has no bound there,
    m, see `response.material`; None for the points themselves, which depend on the cells there.
    search_to: how far below the top of its layer the largest reading is looked for, m, within the layer, at every
    `length`; None for the top itself.
    parts: how many layers of the road the course has that it reads, from its layer down: more than 1 where it is
    divided over depth. `search_to` goes through all of them.
    reads: what the law reads, with details that the law leaves open, as the strength of a bond.
    An extension at the top of a layer counts only where a principal stress is tensile: no crack opens elsewhere.
    Raises InputError for a law at a place that it does not apply to: one of the bottom of the asphalt, of the
    surface, of the top of the subgrade, of a bond.

    >>> tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 1).name
    'base'
    """

    name: str
    law: FatigueLaw | Callable[[float], FatigueLaw]
    layer: int = 0
    place: Place | None = None
    strain: Reading | None = None
    length: float | None = MATERIAL_LENGTH
    reads: Quantity | None = None
    search_to: float | None = None
    parts: int = 1

    def __post_init__(self) -> None:
        law = self.law_at(_ANY_TEMPERATURE)
        where = law.reads.where
        if self.place is None:
            object.__setattr__(self, "place", where.places[0])
        if self.place not in ("top", "bottom", "interface"):
            raise InputError(
                f'place of the criterion {self.name!r} must be "top" or "bottom" of a layer, or "interface", got '
                f"{self.place!r}"
            )
        if self.strain is not None:
            check_reading(self.strain)
        if self.length is not None:
            check_length(self.length)
        if self.search_to is not None:
            self._check_search(self.search_to)
        if self.parts < 1:
            raise InputError(f"parts of the criterion {self.name!r} must be 1 or more, got {self.parts}")
        if self.reads is not None and (unlike := law.reads.differences(self.reads)):
            here, fitted = (", ".join(f"{name} = {two[k]:g}" for name, two in unlike.items()) for k in (0, 1))
            raise InputError(
                f"the criterion {self.name!r} reads the {self.reads} with {fitted}, but the numbers of its law, "
                f"{law}, were fitted with {here}; give {here} in reads, or a law fitted with {fitted}"
            )
        if self.reads is not None and not law.reads.admits(self.reads):
            raise InputError(
                f"the criterion {self.name!r} reads the {self.reads}, but the numbers of its law, {law}, hold for "
                f"the {law.reads}; take a law for what it should read"
            )
        if self.place not in where.places:
            at = "an interface" if self.place == "interface" else f"the {self.place} of a layer"
            raise InputError(
                f"the criterion {self.name!r} reads {at}, but its law, {law}, reads the {law.reads}; give place = "
                f'"{where.places[0]}"'
            )
        if self.quantity.lacks:
            raise InputError(
                f"the criterion {self.name!r} reads a response, but its law, {law}, reads the {law.reads}, which "
                f"needs {self.quantity.lacks}; give reads= with it"
            )

    @classmethod
    def of_bond(cls, name: str, strength: BondStrength, law: ShearFatigue, interface: int = 0) -> Self:
        """The bond of an interface: after how many passes it fails.

        name: for tables and figures. strength, law: of the bond; strength at the temperature of the layer above.
        interface: counted from the surface, 0 below the top layer, negative from the lowest.
        Tension counts only where the strength has a limit for it; `assess_bonds` states how large it is.
        """
        return cls(name, law, interface, "interface", reads=BondUtilisation(strength))

    @property
    def quantity(self) -> Quantity:
        """What it reads, with all its details."""
        quantity = self.law_at(_ANY_TEMPERATURE).reads if self.reads is None else self.reads
        return quantity if self.strain is None else quantity.with_strain(self.strain)

    def at(self, temperature: float) -> Self:
        """The criterion at a temperature of its layer, °C, where its reading depends on it."""
        before = self.quantity
        quantity = before.at(temperature)
        return self if quantity == before else replace(self, reads=quantity)

    def passing(self, speed: float | None, depth: float, length: float) -> Self:
        """The criterion as a wheel rolls by: speed, m/s, None if unknown; its depth and the footprint's length, m."""
        before = self.quantity
        quantity = before.passing(speed, depth, length)
        return self if quantity is before else replace(self, reads=quantity)

    def law_at(self, temperature: float) -> FatigueLaw:
        """The law at a temperature of the layer, °C."""
        return self.law(temperature) if callable(self.law) else self.law

    def law_on(self, road: Pavement, temperature: float) -> FatigueLaw:
        """The law on a road as it is solved; a law by the layer's modulus takes that of the part which it reads.

        road: of a season and a class, divided, aged and at its frequency where the criterion is. temperature: of the
        layer, °C.
        """
        by_modulus = getattr(self.law, "at_modulus", None)
        material = road.layers[self.number(road)].resolved
        if by_modulus is None or not isinstance(material, AnyElastic):
            return self.law_at(temperature)
        law: FatigueLaw = by_modulus(upright(material)[0])
        return law

    @property
    def side(self) -> Side:
        """Side of the interface on which it reads; the tractions on a bond are the same on both."""
        return "below" if self.place == "top" else "above"

    def number(self, road: Pavement) -> int:
        """Number of the layer from the surface, 0 the top one. Raises InputError for one that is not there."""
        if self.place == "interface":
            return interface_number(road, self.layer)
        count = len(road.layers)
        if not -count <= self.layer < count:
            raise InputError(
                f"the criterion {self.name!r} reads layer {self.layer}, the road has {count}: "
                f"valid are {-count} to {count - 1}"
            )
        return self.layer % count

    def depth(self, road: Pavement) -> float:
        """Depth at which it reads, m. Raises InputError for the bottom of a layer that has none."""
        number, where = self.number(road), self.quantity.where
        if why := self.quantity.impossible_on(road):
            raise InputError(f"the criterion {self.name!r} reads the {self.quantity}, but {why}")
        if where.only and where.layer is not None and number != where.layer % len(road.layers):
            raise InputError(
                f"the criterion {self.name!r} reads layer {self.layer}, but its law, "
                f"{self.law_at(_ANY_TEMPERATURE)}, reads the {self.quantity}; give layer {where.layer}"
            )
        if self.place == "top":
            return float(road.interfaces[number - 1]) if number else 0.0
        if number >= len(road.interfaces):
            raise InputError(
                f"the criterion {self.name!r} reads the bottom of the last layer, which is semi-infinite; "
                "read its top, or a layer above it"
            )
        return float(road.interfaces[number])

    def depths(self, road: Pavement) -> tuple[float, ...]:
        """Depths of which it reads the largest, m: its own, and those below it down to `search_to`."""
        top = self.depth(road)
        if self.search_to is None:
            return (top,)
        last = self.number(road) + self.parts - 1
        ends = float(road.interfaces[last]) if last < len(road.interfaces) else np.inf
        step = MATERIAL_LENGTH if self.length is None else self.length
        count = int(np.ceil(self.search_to / step - 1e-9))
        below = top + self.search_to / count * np.arange(1, count + 1)
        return (top, *(float(depth) for depth in below if depth < ends - _OFF_THE_END))

    def _check_search(self, search_to: float) -> None:
        if not 0 < search_to <= _FARTHEST:
            raise InputError(
                f"search_to of the criterion {self.name!r} must lie in (0, {_FARTHEST:g}] m, got {search_to:g}; "
                "cracks from the surface begin in the upper 20 to 50 mm"
            )
        if self.place != "top" or self.law_at(_ANY_TEMPERATURE).reads.where.only:
            raise InputError(
                f"the criterion {self.name!r} reads one depth, so that search_to does not apply; leave it out, or "
                'read a quantity at place = "top"'
            )

    @property
    def mean_over(self) -> float | None:
        """Side of the cube of road over which it reads a mean near the surface, m; None to read points."""
        return None if self.quantity.bounded else self.length

    @property
    def needs(self) -> tuple[str, ...]:
        """Variables of a response that it reads, in `read` and in `crack`."""
        quantity = self.quantity
        tension: tuple[str, ...] = ()
        if quantity.needs_tension:
            # Below the plane's own tension says whether an upright crack opens, with no component more to solve.
            tension = STRESS if self.place == "top" or not self._upright else IN_THE_PLANE
        return tuple(dict.fromkeys((*quantity.needs, *tension)))

    @property
    def _upright(self) -> bool:
        """True if it reads an extension of the horizontal plane."""
        return self.quantity.extends and self.quantity.strain == "in-plane"

    def read(self, data: xr.Dataset) -> Array:
        """What the law reads (y, x) of a response at one depth, or (depth, y, x), positive where it does harm."""
        values, margin = self._uncut(data)
        return values if margin is None else cut(values, margin > 0)

    def read_uncut(self, data: xr.Dataset) -> tuple[Array, Array | None]:
        """What the law would read were there tension everywhere, and the tension, Pa, without which it reads nothing.

        data: as in `read`. None where tension does not matter, or where a subclass reads in its own way. Both vary
        steadily where `read` ends abruptly.
        """
        return self._uncut(data) if type(self).read is Criterion.read else (self.read(data), None)

    def _uncut(self, data: xr.Dataset) -> tuple[Array, Array | None]:
        quantity = self.quantity
        uses_tension = self.place == "top" and quantity.needs_tension and set(STRESS) <= set(data)
        return quantity.values(data), tension(data) if uses_tension else None

    def crack(self, data: xr.Dataset) -> tuple[Array, Array]:
        """Angle of the trace and dip (y, x), rad, of the crack across what it reads; NaN for none.

        data: as in `read`, or at one x for each y, whose cracks are (y,). None opens where no principal stress is
        tensile.
        """
        quantity = self.quantity
        normal = quantity.crack(data)
        none = np.full([data.sizes[dim] for dim in ordered(data)], np.nan)
        if normal is None:
            return none, none
        angle, dip = crack_plane(normal)
        if not quantity.needs_tension:
            return angle, dip
        opens = quantity.opens(data) if set(STRESS) <= set(self.needs) else in_tension(data, upright=True)
        return np.where(opens, angle, none), np.where(opens, dip, none)


def interface_number(road: Pavement, interface: int) -> int:
    """Number of an interface between layers from the surface. Raises InputError for one that is not there."""
    count = len(road.layers) - 1
    if not -count <= interface < count:
        there = f"valid are {-count} to {count - 1}" if count else "there is none"
        raise InputError(f"the road has {count} interface(s) between layers, got interface {interface}; {there}")
    return interface % count
