"""Deflection basins of a falling weight: load, plate, sensors, and what a file records about every drop."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import ClassVar, Literal, Protocol, get_args

import numpy as np

from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array, BoolArray, IntArray
from treadload.roads.drop_list import DropList
from treadload.tables import finite_list, real_array

PlateKind = Literal["uniform", "rigid", "segmented"]

# A sensor whose deflection is this many times its neighbour's, or a drop whose deflection per load is this many times
# the median of its file, is in another unit: 25.4 is the smallest step between mm, mil and µm.
_OTHER_UNIT, _OTHER_DROP = 20.0, 20.0
# Deflection below the plate over the load, m/N, times the plate's diameter, m: 1/E of a half-space, for moduli of
# 0.5 MPa to 500 GPa.
_SOFTEST, _STIFFEST = 2e-6, 2e-12
# Deflections may rise outwards by this part, or this much, m, before the basin is flagged: resolution of the sensors.
_RISE, _RESOLUTION = 0.01, 1e-6


class Measured(Protocol):
    """Whatever was measured of a road, a row for every drop or place; see `Basins`."""

    @property
    def thickness(self) -> Mapping[str, Array]:
        """Name of a layer → its thickness at each drop (n,), m."""

    @property
    def temperature(self) -> Array | None:
        """Of the asphalt (n,), °C."""

    @property
    def offsets(self) -> Array:
        """Of the sensors (s,), m."""

    @property
    def readings(self) -> Array:
        """What is fitted (n, r)."""

    @property
    def scales(self) -> Array:
        """What the misfit of each reading is over (n, r)."""

    @property
    def error_sizes(self) -> Array:
        """What relative errors of the readings are of (n, r)."""

    @property
    def usual(self) -> float:
        """What most rows show for each newton; NaN without any."""

    @property
    def numbers(self) -> tuple[Array, ...]:
        """Arrays that the answer depends on."""

    @property
    def conditions(self) -> tuple[object, ...]:
        """What else it depends on, each with a complete repr."""

    def __len__(self) -> int: ...

    def rows(self, chosen: Sequence[int] | IntArray | BoolArray) -> Measured:
        """Some of the rows."""

    def refusals(self, usual: float) -> list[str]:
        """For every row why it cannot be fitted."""

    def flags(self) -> list[str]:
        """For every row what is unusual."""


@dataclass(frozen=True, eq=False)
class Basins(DropList):
    """Deflection basins, a row for every drop.

    deflection: (n, s), m, down; NaN where a sensor has none. offsets: of the sensors from the plate's axis (s,), m,
    rising. load: (n,), N. plate_radius: m. plate: pressure below it, "uniform", "rigid", or "segmented", whose
    segments share the load equally and press nearly uniformly. station: a label for each drop. position: along the
    road (n,), m, NaN where it is not known. section: a label for each drop, or (). temperature: of the asphalt (n,),
    °C, NaN where it is not known. thickness: name of a layer → its thickness at each drop (n,), m; 0 where the layer
    is absent. source: where they are from. Raises InputError.

    >>> basins = tl.roads.Basins([[400e-6, 300e-6, 120e-6]], offsets=[0.0, 0.3, 0.9], load=[50e3], plate_radius=0.15)
    >>> f"{basins.compliance[0] * 1e9:.0f} µm per kN below the plate"
    '8 µm per kN below the plate'
    """

    by_drop: ClassVar = ("deflection", "load")

    deflection: Array
    offsets: Array
    load: Array
    plate_radius: float
    plate: PlateKind = "uniform"
    station: tuple[str, ...] = ()
    position: Array | None = None
    section: tuple[str, ...] = ()
    temperature: Array | None = None
    thickness: Mapping[str, Array] = field(default_factory=dict)
    source: str = ""

    def __post_init__(self) -> None:
        offsets = finite_list(self.offsets, "offsets of the sensors", "m")
        deflection = np.atleast_2d(real_array(self.deflection, "deflection"))
        count = len(deflection)
        load = np.atleast_1d(real_array(self.load, "load"))
        load = np.full(count, load[0]) if len(load) == 1 else load
        positive("plate_radius", self.plate_radius, "metres", "150 mm is 0.15")
        if self.plate not in get_args(PlateKind):
            raise InputError(f'plate must be "uniform", "rigid" or "segmented", got {self.plate!r}')
        if deflection.ndim != 2 or deflection.shape[1] != len(offsets) or load.shape != (count,):
            raise InputError(
                f"deflection needs a row for each drop and a column for each of {len(offsets)} sensors, and load a "
                f"value for each drop; got {deflection.shape} and {load.shape}"
            )
        if offsets[0] < 0 or not (np.diff(offsets) > 0).all():
            raise InputError(
                f"offsets of the sensors must be 0 or more and rise, got {', '.join(f'{r:g}' for r in offsets)} m; "
                "sort the sensors outwards"
            )
        inside = offsets[(offsets > 0) & (offsets <= self.plate_radius)]
        if len(inside):
            raise InputError(
                f"a sensor at {inside[0] * 1e3:g} mm lies inside the plate of radius {self.plate_radius * 1e3:g} mm; "
                "only its centre is open: check the offsets, their unit and the radius"
            )
        self._settle(count, deflection=deflection, offsets=offsets, load=load)

    def __len__(self) -> int:
        return len(self.load)

    @property
    def readings(self) -> Array:
        """What is fitted (n, s)."""
        return self.deflection

    @property
    def scales(self) -> Array:
        """What the misfit of each reading is over (n, s)."""
        return self.deflection

    @property
    def error_sizes(self) -> Array:
        """What relative errors of the readings are of (n, s)."""
        return self.deflection

    @property
    def numbers(self) -> tuple[Array, ...]:
        """Arrays that the answer depends on."""
        return self.deflection, self.offsets, self.load

    @property
    def conditions(self) -> tuple[object, ...]:
        """What else it depends on."""
        return self.plate_radius, self.plate

    @property
    def sensors(self) -> BoolArray:
        """(n, s), True where a sensor has a deflection."""
        return np.isfinite(self.deflection)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is unusual about the list as a whole."""
        if self.position is None:
            return ()
        along = self.position[np.isfinite(self.position)]
        back = np.flatnonzero(np.diff(along) < 0)
        if not len(back) or not (np.diff(along) > 0).any():
            return ()
        at = int(back[0])
        return (
            f"stations are out of order: {along[at + 1]:g} m follows {along[at]:g} m; results keep the order of the "
            "file, figures sort them along the road",
        )

    @property
    def compliance(self) -> Array:
        """Deflection of the innermost sensor over the load (n,), m/N; NaN without any."""
        with np.errstate(all="ignore"):
            per_load = self.deflection / self.load[:, None]
        return np.array([row[np.isfinite(row)][0] if np.isfinite(row).any() else np.nan for row in per_load])

    @property
    def usual(self) -> float:
        """Median of the compliance, m/N; NaN without any."""
        usable = self.compliance[self.compliance > 0]
        return float(np.median(usable)) if len(usable) else np.nan

    def refusals(self, usual: float) -> list[str]:
        """For every drop why it cannot be fitted, "" where it can. usual: compliance of the whole list, m/N."""
        return [self._refusal(number, first, usual) for number, first in enumerate(self.compliance)]

    def _refusal(self, number: int, first: float, usual: float) -> str:
        load, values = float(self.load[number]), self.deflection[number]
        there = np.isfinite(values)
        if not (np.isfinite(load) and load > 0):
            return f"its load is {load:g} N; a basin needs a load above 0"
        if not there.any():
            return "no sensor has a deflection"
        low = np.flatnonzero(there & (values <= 0))
        if len(low):
            at = int(low[0])
            return (
                f"the deflection at {self.offsets[at] * 1e3:g} mm is {values[at] * 1e6:g} µm; deflections are above "
                "0, leave the cell empty where a sensor failed"
            )
        scale = first * 2 * self.plate_radius
        if not _STIFFEST < scale < _SOFTEST:
            return (
                f"its deflection of {first * load * 1e6:.4g} µm under {load / 1e3:.4g} kN belongs to a modulus of "
                f"{1e-6 / scale:.3g} MPa, which no road has; check the units of loads and deflections"
            )
        if np.isfinite(usual) and not 1 / _OTHER_DROP < first / usual < _OTHER_DROP:
            return (
                f"its deflection per load is {first / usual:.3g} times the median of the file; are units mixed "
                "within the file?"
            )
        near = values[there]
        ratio = near[1:] / near[:-1]
        odd = np.flatnonzero((ratio > _OTHER_UNIT) | (ratio < 1 / (5 * _OTHER_UNIT)))
        if len(odd):
            at = self.offsets[there][int(odd[0]) + 1]
            return (
                f"the deflection at {at * 1e3:g} mm is {ratio[odd[0]]:.3g} times that of the sensor before; are "
                "units mixed within the file?"
            )
        return ""

    def flags(self) -> list[str]:
        """For every drop what is wrong with the shape of its basin, "" where nothing is."""
        flags = []
        for values in self.deflection:
            there = np.flatnonzero(np.isfinite(values))
            near = values[there]
            rise = np.diff(near)
            worst = int(np.argmax(rise)) if len(rise) else 0
            if len(rise) and rise[worst] > max(_RISE * near[worst], _RESOLUTION):
                inner, outer = self.offsets[there[worst]], self.offsets[there[worst + 1]]
                flags.append(
                    f"not monotone: {near[worst + 1] * 1e6:.4g} µm at {outer * 1e3:g} mm after "
                    f"{near[worst] * 1e6:.4g} µm at {inner * 1e3:g} mm"
                )
            else:
                flags.append("")
        return flags

    def __repr__(self) -> str:
        return f"<Basins of {len(self)} drops, {len(self.offsets)} sensors, {self.source or 'no source'}>"
