"""What is read of stress and strain: a number with a name, a unit, a place in the road, and the crack that it opens.

A law gives the load repetitions that a reading of a quantity allows, and a criterion reads it at a place of a road.
Ours stand in `damage.quantities`; another package declares an entry point of the group `treadload.quantities`, or
registers its own:

    @QUANTITIES.register("largest_shear")
    @dataclass(frozen=True)
    class LargestShear(Quantity):
        name = "largest_shear"
        words = "largest shear stress"
        unit, shown = "Pa", "MPa"

        def of(self, stress, strain):
            values = tensors.principal(stress)[0]
            return 0.5 * (values[0] - values[2])
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass
from types import MappingProxyType
from typing import Literal, Self

import numpy as np

from treadload import variables
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels import tensors
from treadload.kernels.arrays import Array, BoolArray
from treadload.pavement import Pavement
from treadload.registry import QUANTITIES
from treadload.response.fields import COMPONENTS
from treadload.units import quantity

Place = Literal["top", "bottom", "interface"]
Reading = Literal["principal", "in-plane"]
READINGS: Mapping[str, str] = MappingProxyType({"principal": "three-dimensional", "in-plane": "in-plane"})

STRESS = tuple(f"stress_{name}" for name in COMPONENTS)
STRAIN = tuple(f"strain_{name}" for name in COMPONENTS)
IN_THE_PLANE = (STRESS[0], STRESS[1], STRESS[3])
_DIMS = ("depth", "y", "x")
# Stress above this part of the largest is tension, below it round-off of a free surface.
_TENSION = 1e-9
# Unit in which people read a quantity, and the factor to it from SI.
_SHOWN: Mapping[str, float] = MappingProxyType({"microstrain": 1e6, "MPa": 1e-6, "kPa": 1e-3, "mm": 1e3})
_NO_CRACK = "no crack direction"
UNCALIBRATED = "not calibrated here: a power law of it, or a limit, takes the user's numbers"


@dataclass(frozen=True)
class Where:
    """Where in a road a quantity is read.

    places: of a layer, the usual one first. layer: the usual one, 0 at the surface, -1 the last; None where it may be
    any. only: True if no other layer will do.
    """

    places: tuple[Place, ...]
    layer: int | None = None
    only: bool = False

    @property
    def at_surface(self) -> bool:
        """True if it is read at the surface of the road and nowhere else."""
        return self.only and self.layer == 0 and self.places == ("top",)

    @property
    def at_bottom(self) -> bool:
        """True if it is read at the bottom of a layer and nowhere else."""
        return self.places == ("bottom",)


ANYWHERE = Where(("bottom", "top"))
SURFACE = Where(("top",), 0, only=True)
BOTTOM = Where(("bottom",))
SUBGRADE = Where(("top",), -1)
INTERFACE = Where(("interface",))


class Quantity(ABC):
    """What is read of a field of stress and strain, positive where it does harm; subclasses are frozen dataclasses.

    name: the word for it in cases and files. words: in sentences, "reads the ...". unit: SI, "1" of strains. shown:
    the unit in which people read it, "microstrain", "MPa" or "" for the SI unit. source: the law or author that uses
    it. calibrated: what ties its readings to cracks or ruts of roads, and what does not. where: in a road it is read.
    harm: the words of a report where no crack opens. needs: variables of a response; remedy: what to do without them.
    bounded: False if it has no bound under the edge of a rib, so that a mean over a
    length of road is read near the surface. extends: True for an extension, which `assess` can judge; strain: whether
    it is one in space or in the horizontal plane. needs_tension: True if it does harm only where a principal stress
    is tensile. between_layers: True if it describes failure of the bond of an interface.

    >>> quantity: tl.damage.Quantity = tl.damage.VerticalShear()
    >>> quantity.words, quantity.in_words(250e-6)
    ('vertical shear strain', '250 microstrain')
    """

    name: str
    words: str
    unit: str = "1"
    shown: str = ""
    source: str = ""
    calibrated: str = UNCALIBRATED
    where: Where = ANYWHERE
    needs: tuple[str, ...] = (*STRESS, *STRAIN)
    remedy: str = "give a response as solve_response returns it"
    harm: str = _NO_CRACK
    bounded: bool = False
    extends: bool = False
    strain: Reading = "in-plane"
    needs_tension: bool = False
    between_layers: bool = False

    @abstractmethod
    def of(self, stress: Array, strain: Array) -> Array:
        """The quantity (...) of stress (6, ...), Pa, and strain (6, ...), in the order xx, yy, zz, xy, xz, yz.

        A component that is not among `needs` is NaN, a tensor of which none is empty.
        """

    def normal(self, stress: Array, strain: Array) -> Array | None:
        """Unit vectors (..., 3) across which its crack opens; None if it opens none."""
        return None

    @property
    def caveat(self) -> str:
        """Which of its numbers have no source that could be read, in words; empty if none."""
        return ""

    @property
    def lacks(self) -> str:
        """What must be given before it can be read from a response, in words; empty if nothing."""
        return ""

    def impossible_on(self, road: Pavement) -> str:
        """Why no response of a road gives it, in words; empty if one does."""
        return ""

    def at(self, temperature: float) -> Self:
        """Itself at a temperature of its layer, °C."""
        return self

    def passing(self, speed: float | None, depth: float, length: float) -> Self:
        """The same as a wheel rolls by; speed: m/s, None if unknown; depth and length of the footprint: m."""
        return self

    def with_strain(self, strain: Reading) -> Self:
        """Itself, in space ("principal") or in the horizontal plane ("in-plane") where it knows both."""
        return self

    def admits(self, peer: Quantity) -> bool:
        """True if the numbers of a law that reads this one hold for another too: the same with its details given."""
        return isinstance(peer, type(self)) and not self.differences(peer)

    def differences(self, peer: Quantity) -> dict[str, tuple[float, float]]:
        """Numbers of this quantity, and of another of its class, that are not the same, by name.

        Not of a quantity whose details follow the temperature or the wheel, and not those that this one leaves
        open or at their usual values.
        """
        follows = type(self).at is not Quantity.at or type(self).passing is not Quantity.passing
        if follows or not is_dataclass(self) or not isinstance(peer, type(self)):
            return {}
        pairs = {
            field.name: (getattr(self, field.name), getattr(peer, field.name))
            for field in fields(self)
            if getattr(self, field.name) != field.default
        }
        return {
            name: (value, reference)
            for name, (value, reference) in pairs.items()
            if isinstance(value, int | float)
            and isinstance(reference, int | float)
            and not math.isclose(value, reference)
        }

    def values(self, data: xr.Dataset) -> Array:
        """The quantity over (depth, y, x) of a response's dataset, or fewer. Raises InputError for what it lacks."""
        return self.of(*self._tensors(data))

    def crack(self, data: xr.Dataset) -> Array | None:
        """Unit vectors (depth, y, x, 3) across which its crack opens; None if it opens none."""
        return self.normal(*self._tensors(data))

    def opens(self, data: xr.Dataset) -> BoolArray:
        """Where it can do harm (depth, y, x): everywhere, or where a principal stress is tensile."""
        if self.needs_tension:
            return in_tension(data)
        return np.ones([data.sizes[dim] for dim in ordered(data)], dtype=bool)

    def field(self, data: xr.Dataset) -> xr.DataArray:
        """The quantity with the coordinates of a response's dataset, its unit and its words."""
        dims = ordered(data)
        places = {dim: (dim, data[dim].to_numpy(), variables.attributes(dim)) for dim in dims}
        return xr.DataArray(self.values(data), places, dims, self.name, self.attributes)

    @property
    def attributes(self) -> dict[str, object]:
        """Attributes `units` and `long_name` of a variable that holds it."""
        registered = self.name in variables.VARIABLES
        return variables.attributes(self.name) if registered else {"units": self.unit, "long_name": self.words}

    def missing(self, data: xr.Dataset) -> list[str]:
        """Variables that it needs and a dataset lacks."""
        return [name for name in self.needs if name not in data]

    @property
    def factor(self) -> float:
        """From SI to the unit in which people read it."""
        return _SHOWN.get(self.shown, 1.0)

    def in_words(self, value: float) -> str:
        """A reading with its unit."""
        number, unit = value * self.factor, self.shown or ("" if self.unit == "1" else self.unit)
        if not unit:
            return f"{number:.3g}"
        return f"{number:.0f} {unit}" if number >= 100 else f"{number:.3g} {unit}"

    def number(self, value: float | str) -> float:
        """A reading in SI: a bare number is that already, text carries its unit. Raises InputError."""
        # A pressure and an energy per volume are one to the reader of units.
        return quantity(value, {"1": "", "J/m^3": "Pa"}.get(self.unit, self.unit))

    @property
    def about(self) -> dict[str, object]:
        """What a file states about it, so that its readings are understood without this program."""
        shown = self.shown or ("" if self.unit == "1" else self.unit)
        return {
            "name": self.name, "words": self.words, "shown": shown, "factor": self.factor, "harm": self.harm,
            "source": self.source, "calibrated": self.calibrated,
        }  # fmt: skip

    def __str__(self) -> str:
        return self.words

    def check(self, data: xr.Dataset) -> None:
        """Refuse a dataset that lacks what it needs. Raises InputError."""
        if missing := self.missing(data):
            raise InputError(
                f"the quantity {self.name} needs {', '.join(missing)}, which the response lacks; {self.remedy}"
            )

    def _tensors(self, data: xr.Dataset) -> tuple[Array, Array]:
        self.check(data)
        return self._stacked(data, STRESS), self._stacked(data, STRAIN)

    def _stacked(self, data: xr.Dataset, names: tuple[str, ...]) -> Array:
        """A tensor (6, ...), NaN for the components that it does not need; empty if it needs none of them."""
        if not set(names) & set(self.needs):
            return np.empty(0)
        unasked = np.full([data.sizes[dim] for dim in ordered(data)], np.nan)
        return np.stack([part(data, name) if name in self.needs else unasked for name in names])


QUANTITIES.makes(Quantity)


def ordered(data: xr.Dataset) -> list[str]:
    """Dimensions of the road that a dataset has, in the order in which quantities come."""
    sizes = data.sizes
    return [dim for dim in _DIMS if dim in sizes]


def part(data: xr.Dataset, name: str) -> Array:
    """A variable over (depth, y, x), or those of them that the dataset has."""
    # Not the array with its coordinates, nor a transposed one where it is in order: they cost more than small fields.
    variable, dims = data.variables[name], ordered(data)
    if variable.dims[: len(dims)] != tuple(dims):
        variable = variable.transpose(*dims, ...)
    values: Array = variable.values
    return values


def in_tension(data: xr.Dataset, *, upright: bool = False) -> BoolArray:
    """Where a principal stress of a response's dataset is tensile: (depth, y, x), or fewer; all if it has no stress.

    No crack opens elsewhere, whatever extends: beside a point that is squeezed hard a body extends as well.
    upright: True for a principal stress of the horizontal plane, which opens upright cracks.
    """
    names = IN_THE_PLANE if upright else STRESS
    if any(name not in data for name in names):
        return np.ones([data.sizes[dim] for dim in ordered(data)], dtype=bool)
    tensile: BoolArray = tension(data, upright=upright) > 0
    return tensile


def cut(values: Array, opens: BoolArray) -> Array:
    """Readings, nothing where no crack can open."""
    kept: Array = np.where(opens, values, np.minimum(values, 0.0))
    return kept


def tension(data: xr.Dataset, *, upright: bool = False) -> Array:
    """The largest principal stress of a response's dataset, Pa, above what round-off leaves: (depth, y, x), or fewer.

    upright: see `in_tension`.
    """
    stress = np.stack([part(data, name) for name in (IN_THE_PLANE if upright else STRESS)])
    limit = _TENSION * np.abs(stress).max(initial=0.0)
    if upright:
        x, y, xy = stress
        return np.asarray(0.5 * (x + y) + np.hypot(0.5 * (x - y), xy) - limit)
    return np.asarray(tensors.largest_principal(stress) - limit)


def check_reading(strain: str) -> None:
    """Raise InputError for an unknown reading of the strain."""
    if strain not in READINGS:
        raise InputError(f'strain must be "principal" or "in-plane", got {strain!r}')
