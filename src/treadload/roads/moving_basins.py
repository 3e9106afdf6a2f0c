"""Moving basins: slopes of the surface that a traffic-speed deflectometer measures ahead of its rolling wheels."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import ClassVar, TypeAlias

import numpy as np

from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array, BoolArray
from treadload.response.loads import GridLoad, Load, SurfaceLoad, UniformDisc, UniformRectangle, gather
from treadload.roads.drop_list import DropList, checked_column
from treadload.tables import finite_list, real_array

# The line of the sensors passes at least this far beside every loaded cell, m.
GAP = 0.005
# A slope that no road shows under any wheel: 10 mm/m. A list whose median per newton is this far off is in other
# units.
_STEEPEST, _OTHER_DROP = 1e-2, 20.0
# Speeds between walking and what a lorry cannot, m/s.
_SLOWEST, _FASTEST = 0.5, 45.0
# Rising towards the wheels by more than this part of the largest slope, and this much, is not a basin.
_RISE, _RESOLUTION = 0.05, 2e-5


@dataclass(frozen=True)
class DualWheels:
    """Two tires side by side, each with a uniform pressure on a rectangle.

    spacing: between the middles of the tires, m. width, length: of each contact, m. `loads` makes the loads of 1 N
    together; their middle is the origin. Raises InputError for tires without a gap between them.

    >>> tl.roads.DualWheels(spacing=0.2, width=0.22, length=0.2)
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: tires of 220 mm at 200 mm leave a gap of -20 mm, less than 10 mm, in which no
        sensor can look
    """

    spacing: float
    width: float
    length: float

    def __post_init__(self) -> None:
        for name in ("spacing", "width", "length"):
            positive(name, getattr(self, name), "metres", "220 mm is 0.22")
        if self.spacing - self.width < 2 * GAP:
            raise InputError(
                f"tires of {self.width * 1e3:g} mm at {self.spacing * 1e3:g} mm leave a gap of "
                f"{(self.spacing - self.width) * 1e3:g} mm, less than {2e3 * GAP:g} mm, in which no sensor can look"
            )

    @property
    def loads(self) -> tuple[UniformRectangle, UniformRectangle]:
        """Both contacts, 1 N together."""
        pressure = 0.5 / (self.length * self.width)
        right_wheel = UniformRectangle(self.length, self.width, pressure, y=0.5 * self.spacing)
        return right_wheel, right_wheel.mirrored()


Wheels: TypeAlias = "DualWheels | Load | Sequence[Load]"
"""Dual wheels, or whatever loads a response takes: contacts, grids, rectangles, discs."""


@dataclass(frozen=True, eq=False)
class MovingBasins(DropList):
    """Slopes ahead of rolling wheels, a row for each place of the road.

    slope: (n, s), -∂u/∂x with u the deflection, down, and x ahead: positive ahead of the wheels, where the surface
    goes down; velocity of the surface, down, over the speed. NaN where a sensor has none. offsets: ahead of the
    wheels' middle (s,), m, rising, negative behind. load: on the wheels (n,), N. speed: (n,), m/s. wheels:
    `DualWheels` or loads; only their shape counts. side: of the sensors' line to the right of the wheels' middle, m.
    station, position, section, temperature, thickness, source: as in `Basins`. Raises InputError.

    >>> wheels = tl.roads.DualWheels(spacing=0.35, width=0.22, length=0.2)
    >>> basins = tl.roads.MovingBasins.from_velocity([[10e-3, 6e-3]], [0.1, 0.3], [50e3], [20.0], wheels)
    >>> [f"{slope * 1e6:.0f} µm/m" for slope in basins.slope[0]]
    ['500 µm/m', '300 µm/m']
    """

    by_drop: ClassVar = ("slope", "load", "speed")

    slope: Array
    offsets: Array
    load: Array
    speed: Array
    wheels: Wheels
    side: float = 0.0
    station: tuple[str, ...] = ()
    position: Array | None = None
    section: tuple[str, ...] = ()
    temperature: Array | None = None
    thickness: Mapping[str, Array] = field(default_factory=dict)
    source: str = ""

    def __post_init__(self) -> None:
        offsets = finite_list(self.offsets, "offsets of the sensors", "m")
        slope = np.atleast_2d(real_array(self.slope, "slope"))
        count = len(slope)
        if slope.ndim != 2 or slope.shape[1] != len(offsets):
            raise InputError(
                f"slope needs a row for each place and a column for each of {len(offsets)} sensors, got {slope.shape}"
            )
        if not (np.diff(offsets) > 0).all():
            raise InputError(
                f"offsets of the sensors must rise, got {', '.join(f'{r:g}' for r in offsets)} m; sort them ahead"
            )
        beside = min(max(low - self.side, self.side - high) for low, high in _extents(self.unit_loads))
        if beside < GAP:
            raise InputError(
                f"the line of the sensors at {self.side * 1e3:g} mm passes {max(beside, 0.0) * 1e3:g} mm beside the "
                f"loaded cells; it must pass {GAP * 1e3:g} mm or more beside them, as between dual tires"
            )
        load, speed = checked_column("load", self.load, count), checked_column("speed", self.speed, count)
        self._settle(count, slope=slope, offsets=offsets, load=load, speed=speed)

    @classmethod
    def from_velocity(
        cls, velocity: Array, offsets: Array, load: Array, speed: Array, wheels: Wheels, **more: object
    ) -> MovingBasins:
        """From velocities of the surface (n, s), m/s, down, as Doppler lasers measure them. The rest as the class."""
        values = np.atleast_2d(real_array(velocity, "velocity"))
        along = checked_column("speed", speed, len(values))
        with np.errstate(divide="ignore", invalid="ignore"):
            slope = np.where(along[:, None] > 0, values / along[:, None], np.nan)
        return cls(slope, offsets, load, along, wheels, **more)  # type: ignore[arg-type]

    def __len__(self) -> int:
        return len(self.load)

    @property
    def unit_loads(self) -> tuple[SurfaceLoad, ...]:
        """The wheels as loads of 1 N together."""
        placed = self.wheels.loads if isinstance(self.wheels, DualWheels) else gather(self.wheels)
        loads = [load.cell if isinstance(load, UniformRectangle) else load for load in placed]
        total = sum(load.normal_load for load in loads)
        if not total > 0:
            raise InputError(f"the wheels carry {total:g} N together; their loads need a pressure above 0")
        return tuple(_scaled(load, 1 / total) for load in loads)

    @property
    def readings(self) -> Array:
        """What is fitted (n, s)."""
        return self.slope

    @property
    def scales(self) -> Array:
        """What misfits are over (n, s): the size of all slopes of a place, which pass through zero."""
        size = np.sqrt(
            np.nanmean(np.where(np.isfinite(self.slope).any(axis=1, keepdims=True), self.slope, 1.0) ** 2, axis=1)
        )
        return np.repeat(size[:, None], len(self.offsets), axis=1)

    @property
    def error_sizes(self) -> Array:
        """What relative errors of the readings are of (n, s)."""
        return self.slope

    @property
    def numbers(self) -> tuple[Array, ...]:
        """Arrays that the answer depends on."""
        warmth = np.zeros(0) if self.temperature is None else self.temperature
        pressures = [np.asarray(load.pressure, dtype=float) for load in self.unit_loads]
        return self.slope, self.offsets, self.load, self.speed, warmth, *pressures

    @property
    def conditions(self) -> tuple[object, ...]:
        """What else it depends on."""
        return self.side, [(load.extent_x, load.extent_y) for load in self.unit_loads]

    @property
    def sensors(self) -> BoolArray:
        """(n, s), True where a sensor has a slope."""
        return np.isfinite(self.slope)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is unusual about the list as a whole."""
        return ()

    @property
    def usual(self) -> float:
        """Median of the largest slope over the load, 1/N; NaN without any."""
        largest = self._largest
        usable = largest[largest > 0]
        return float(np.median(usable)) if len(usable) else np.nan

    @property
    def _largest(self) -> Array:
        with np.errstate(all="ignore"):
            per_load = np.where(self.sensors, self.slope, -np.inf).max(axis=1) / self.load
        return np.where(np.isfinite(per_load), per_load, np.nan)

    def refusals(self, usual: float) -> list[str]:
        """For every place why it cannot be fitted, "" where it can. usual: of the whole list, 1/N."""
        return [self._refusal(number, float(steep), usual) for number, steep in enumerate(self._largest)]

    def _refusal(self, number: int, steep: float, usual: float) -> str:
        load, speed = float(self.load[number]), float(self.speed[number])
        if not (np.isfinite(load) and load > 0):
            return f"its load is {load:g} N; a basin needs a load above 0"
        if not _SLOWEST <= speed <= _FASTEST:
            return (
                f"its speed is {speed:g} m/s; a moving basin needs {_SLOWEST:g} to {_FASTEST:g} m/s: check the unit"
            )
        if not self.sensors[number].any():
            return "no sensor has a slope"
        if not steep > 0:
            return (
                "no sensor has a slope above 0; slopes are positive ahead of the wheels, where the surface goes "
                "down: "
                "check their sign"
            )
        if steep * load > _STEEPEST:
            return f"its slope of {steep * load * 1e3:.3g} mm/m is beyond any road; check the units"
        if np.isfinite(usual) and not 1 / _OTHER_DROP < steep / usual < _OTHER_DROP:
            return f"its slope per load is {steep / usual:.3g} times the median of the file; are units mixed in it?"
        return ""

    def flags(self) -> list[str]:
        """For every place what is unusual about its shape, "" for nothing."""
        flags = []
        for values in self.slope:
            ahead = (self.offsets > 0) & np.isfinite(values)
            low = float(values[ahead].min(initial=0.0))
            most = float(np.nanmax(np.abs(values))) if np.isfinite(values).any() else 0.0
            rises = low < -max(_RISE * most, _RESOLUTION)
            flags.append(f"the surface rises ahead of the wheels: a slope of {low * 1e6:.3g} µm/m" if rises else "")
        return flags

    def __repr__(self) -> str:
        return f"<MovingBasins of {len(self)} places, {len(self.offsets)} sensors, {self.source or 'no source'}>"


def _extents(loads: Sequence[SurfaceLoad]) -> list[tuple[float, float]]:
    """Loaded stretches across, each row of cells that carries something by itself."""
    parts: list[tuple[float, float]] = []
    for load in loads:
        if isinstance(load, UniformDisc):
            parts.append(load.extent_y)
            continue
        grid = load.grid
        for row in np.flatnonzero(load.pressure.any(axis=1)):
            middle = grid.y0 + row * grid.dy
            parts.append((middle - 0.5 * grid.dy, middle + 0.5 * grid.dy))
    return parts


def _scaled(load: SurfaceLoad, factor: float) -> SurfaceLoad:
    """Pressure alone, times a factor: the shear under wheels that roll freely is left out."""
    if isinstance(load, UniformDisc):
        return replace(load, pressure=load.pressure * factor)
    return GridLoad(load.grid, np.asarray(load.pressure) * factor)
