"""A criterion of design: a place in the road, and the law that says after how many passes it fails there."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal, Protocol, Self

import numpy as np
import xarray as xr

from treadload.damage.cracks import Reading, check_reading, crack_plane, extension, in_tension
from treadload.damage.laws.fatigue import (
    BOTTOM_EXTENSION,
    EXTENSION,
    SUBGRADE,
    SURFACE_EXTENSION,
    TENSION,
    FatigueLaw,
)
from treadload.errors import InputError
from treadload.kernels import tensors
from treadload.kernels.arrays import Array
from treadload.pavement import Pavement
from treadload.response import MATERIAL_LENGTH
from treadload.response.fields import COMPONENTS
from treadload.response.material import check_length

Place = Literal["top", "bottom"]
Side = Literal["above", "below"]

# Places of which laws speak, the usual one first, by what they read.
_PLACES: Mapping[str, tuple[Place, ...]] = {
    EXTENSION: ("bottom", "top"),
    SURFACE_EXTENSION: ("top",),
    BOTTOM_EXTENSION: ("bottom",),
    SUBGRADE: ("top",),
    TENSION: ("bottom", "top"),
}
# Layer that laws speak of by what they read, 0 the top one, -1 the last; others speak of any.
_LAYERS: Mapping[str, int] = {SURFACE_EXTENSION: 0, SUBGRADE: -1}
# At which a law that depends on temperature is asked what it reads.
_ANY_TEMPERATURE = 15.0


def usual_place(quantity: str) -> Place:
    """Place at which a law that reads this speaks of a layer, if nobody says otherwise. Raises InputError."""
    if quantity not in _PLACES:
        raise InputError(f"no response tells the {quantity}; take a law of {', '.join(_PLACES)}")
    return _PLACES[quantity][0]


def usual_layer(quantity: str) -> int | None:
    """Layer of which a law that reads this speaks, 0 the top one, -1 the last; None where it may be any."""
    return _LAYERS.get(quantity)


class Criterion(Protocol):
    """What Miner's sum and the solvers of passages ask of a criterion: a place, a reading and its law."""

    @property
    def name(self) -> str:
        """For tables and figures."""

    @property
    def quantity(self) -> str:
        """What the law reads."""

    @property
    def side(self) -> Side:
        """Side of the interface on which it reads."""

    def at(self, temperature: float) -> Self:
        """The criterion at a temperature of its layer, °C, where its reading depends on it."""

    def law_at(self, temperature: float) -> FatigueLaw:
        """The law at a temperature of its layer, °C."""

    def number(self, road: Pavement) -> int:
        """Number of its layer from the surface."""

    def depth(self, road: Pavement) -> float:
        """Depth at which it reads, m."""

    @property
    def mean_over(self) -> float | None:
        """Side of the cube of road over which it reads a mean near the surface, m; None to read points."""

    def read(self, data: xr.Dataset) -> Array:
        """What the law reads (y, x) of a response at that depth, positive where it does harm."""

    def crack(self, data: xr.Dataset) -> tuple[Array, Array]:
        """Angle of the trace and dip (y, x), rad, of the crack; NaN for none."""


@dataclass(frozen=True)
class DesignCriterion:
    """A place in the road and the law that says after how many passes it fails there.

    name: for tables and figures. law: a law of fatigue; or a function that gives it at a temperature of the
    layer, °C. layer: counted from the surface, 0 is the top one, negative from the bottom. place: "top" or
    "bottom" of the layer. strain: "principal" reads the extension in space, "in-plane" in the horizontal plane;
    laws of the subgrade read the vertical compression instead, laws of tension the largest horizontal stress.
    length: of the mean over a cube of road that an extension near the surface is, m, see `response.material`; None
    for the points themselves, which depend on the cells there.
    An extension at the top of a layer counts only where a principal stress is tensile: no crack opens elsewhere.
    Raises InputError for a law at a place of which it does not speak: one of the bottom of the asphalt, of the
    surface, of the top of the subgrade.
    """

    name: str
    law: FatigueLaw | Callable[[float], FatigueLaw]
    layer: int = 0
    place: Place = "bottom"
    strain: Reading = "in-plane"
    length: float | None = MATERIAL_LENGTH

    def __post_init__(self) -> None:
        if self.place not in ("top", "bottom"):
            raise InputError(f'place of the criterion {self.name!r} must be "top" or "bottom", got {self.place!r}')
        check_reading(self.strain)
        if self.length is not None:
            check_length(self.length)
        if self.quantity not in _PLACES:
            raise InputError(
                f"the criterion {self.name!r} reads a response, but its law, {self.law_at(_ANY_TEMPERATURE)}, reads "
                f"the {self.quantity}; take a law of {', '.join(_PLACES)}"
            )
        if self.place not in _PLACES[self.quantity]:
            raise InputError(
                f"the criterion {self.name!r} reads the {self.place} of a layer, but its law, "
                f"{self.law_at(_ANY_TEMPERATURE)}, reads the {self.quantity}; give place = "
                f'"{_PLACES[self.quantity][0]}"'
            )

    def at(self, temperature: float) -> Self:
        """Itself: strain and stress are read alike at every temperature."""
        return self

    def law_at(self, temperature: float) -> FatigueLaw:
        """The law at a temperature of the layer, °C."""
        return self.law(temperature) if callable(self.law) else self.law

    @property
    def quantity(self) -> str:
        """What the law reads."""
        return self.law_at(_ANY_TEMPERATURE).quantity

    @property
    def side(self) -> Side:
        """Side of the interface on which the layer lies."""
        return "below" if self.place == "top" else "above"

    def number(self, road: Pavement) -> int:
        """Number of the layer from the surface, 0 the top one. Raises InputError for one that is not there."""
        count = len(road.layers)
        if not -count <= self.layer < count:
            raise InputError(
                f"the criterion {self.name!r} reads layer {self.layer}, the road has {count}: "
                f"{-count} to {count - 1} are there"
            )
        return self.layer % count

    def depth(self, road: Pavement) -> float:
        """Depth at which it reads, m. Raises InputError for the bottom of a layer that has none."""
        number = self.number(road)
        if number and self.quantity == SURFACE_EXTENSION:
            raise InputError(
                f"the criterion {self.name!r} reads layer {self.layer}, but its law, "
                f"{self.law_at(_ANY_TEMPERATURE)}, reads the {self.quantity}; give layer 0"
            )
        if self.place == "top":
            return float(road.interfaces[number - 1]) if number else 0.0
        if number >= len(road.interfaces):
            raise InputError(
                f"the criterion {self.name!r} reads the bottom of the last layer, which is semi-infinite; "
                "read its top, or a layer above it"
            )
        return float(road.interfaces[number])

    @property
    def mean_over(self) -> float | None:
        """Side of the cube that an extension near the surface is a mean over, m; None for what else is read."""
        return self.length if self.quantity in (EXTENSION, SURFACE_EXTENSION) else None

    def read(self, data: xr.Dataset) -> Array:
        """What the law reads (y, x) of a response at the criterion's one depth, positive where it does harm."""
        if self.quantity == SUBGRADE:
            return -data["strain_zz"].transpose("y", "x").to_numpy()
        if self.quantity == TENSION:
            stress = np.stack([data[f"stress_{name}"].transpose("y", "x").to_numpy() for name in COMPONENTS])
            return tensors.in_plane_principal(stress)[0]
        found = extension(data.transpose("y", "x", ...), self.strain)[0]
        if self.place == "top":
            return np.where(in_tension(data), found, np.minimum(found, 0.0))
        return found

    def crack(self, data: xr.Dataset) -> tuple[Array, Array]:
        """Angle of the trace and dip (y, x), rad, of the crack across what it reads; NaN for a subgrade."""
        if self.quantity == SUBGRADE:
            none = np.full((data.sizes["y"], data.sizes["x"]), np.nan)
            return none, none
        if self.quantity == TENSION:
            stress = np.stack([data[f"stress_{name}"].transpose("y", "x").to_numpy() for name in COMPONENTS])
            angle = tensors.in_plane_principal(stress)[1]
            return crack_plane(np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=-1))
        return crack_plane(extension(data.transpose("y", "x", ...), self.strain)[1])
