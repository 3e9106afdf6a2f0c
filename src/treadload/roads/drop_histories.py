"""Time histories of a falling weight: force and deflections over some 60 ms, drop by drop."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import ClassVar

import numpy as np

from treadload.errors import InputError
from treadload.kernels.arrays import Array, IntArray
from treadload.roads.basins import Basins, PlateKind
from treadload.roads.drop_list import DropList
from treadload.roads.layout import TableColumns
from treadload.tables import finite_list, read_table, real_array
from treadload.units import Length

# Times that are fitted, evenly spaced over the record.
_FITTED = 40
# A peak is read by a parabola through this many samples on either side.
_NEAR = 2
# Outer peaks that are later than this, s, show waves that travel: memory delays them by less.
_LATE = 1e-3


@dataclass(frozen=True, eq=False)
class DropHistories(DropList):
    """Force and deflections over time, a row for each drop.

    time: (nt,), s, evenly spaced from the start of the record. force: (n, nt), N. deflection: (n, s, nt), m, down.
    offsets, plate_radius, plate, station, temperature, thickness, source: as in `Basins`. Raises InputError.

    >>> time = [0.002 * k for k in range(25)]
    >>> force = [max(0.0, 50e3 * 4 * t / 0.03 * (1 - t / 0.03)) for t in time]
    >>> drop = tl.roads.DropHistories(time, [force], [[[8e-9 * newton for newton in force]]], [0.0], 0.15)
    >>> f"{drop.peaks.load[0] / 1e3:.0f} kN, {drop.peaks.deflection[0, 0] * 1e6:.0f} µm"
    '50 kN, 398 µm'
    """

    by_drop: ClassVar = ("force", "deflection")

    time: Array
    force: Array
    deflection: Array
    offsets: Array
    plate_radius: float
    plate: PlateKind = "uniform"
    station: tuple[str, ...] = ()
    temperature: Array | None = None
    thickness: Mapping[str, Array] = field(default_factory=dict)
    source: str = ""

    def __post_init__(self) -> None:
        time = finite_list(self.time, "times of the record", "s")
        force = np.atleast_2d(real_array(self.force, "force"))
        deflection = real_array(self.deflection, "deflection")
        deflection = deflection[None] if deflection.ndim == 2 else deflection
        steps = np.diff(time)
        if len(time) < 20 or not (steps > 0).all() or np.ptp(steps) > 0.01 * float(steps.mean()):
            raise InputError(
                f"times of the record must rise evenly, 20 or more of them, got {len(time)} with steps of "
                f"{steps.min(initial=0.0):g} to {steps.max(initial=0.0):g} s; resample the record"
            )
        offsets = finite_list(self.offsets, "offsets of the sensors", "m")
        count = len(force)
        if force.shape != (count, len(time)) or deflection.shape != (count, len(offsets), len(time)):
            raise InputError(
                f"a record of {len(time)} times and {len(offsets)} sensors needs force (n, {len(time)}) and "
                "deflection "
                f"(n, {len(offsets)}, {len(time)}), got {force.shape} and {deflection.shape}"
            )
        self._settle(count, time=time, force=force, deflection=deflection, offsets=offsets)
        # The plate, the offsets and their order are checked as those of a static basin are.
        _ = self.peaks

    def __len__(self) -> int:
        return len(self.force)

    @property
    def load(self) -> Array:
        """Peak force (n,), N."""
        return np.asarray(self.force.max(axis=1))

    @property
    def peaks(self) -> Basins:
        """The basins of the peaks, each sensor at its own time: what a falling weight usually reports."""
        return Basins(
            self.deflection.max(axis=2), self.offsets, self.load, self.plate_radius, self.plate, self.station,
            temperature=self.temperature, thickness=self.thickness, source=self.source,
        )  # fmt: skip

    @property
    def delays(self) -> Array:
        """Times of the sensors' peaks after that of the force (n, s), s, between samples by a parabola."""
        return _peak_times(self.time, self.deflection) - _peak_times(self.time, self.force[:, None])

    @property
    def fitted_times(self) -> IntArray:
        """Numbers of the times that are fitted."""
        step = max(1, -(-len(self.time) // _FITTED))
        return np.arange(0, len(self.time), step)

    @property
    def readings(self) -> Array:
        """What is fitted (n, s times), sensor by sensor."""
        return self.deflection[:, :, self.fitted_times].reshape(len(self), -1)

    @property
    def scales(self) -> Array:
        """Peak of the sensor of each reading (n, s times), m: what relative errors are of."""
        return np.repeat(self.deflection.max(axis=2), len(self.fitted_times), axis=1)

    @property
    def error_sizes(self) -> Array:
        """What relative errors of the sensors are of."""
        return self.scales

    @property
    def usual(self) -> float:
        """Median of the compliance of the peaks, m/N."""
        return self.peaks.usual

    @property
    def numbers(self) -> tuple[Array, ...]:
        """Arrays that the answer depends on."""
        warmth = np.zeros(0) if self.temperature is None else self.temperature
        return self.time, self.force, self.deflection, self.offsets, warmth

    @property
    def conditions(self) -> tuple[object, ...]:
        """What else it depends on."""
        return self.plate_radius, self.plate, "histories"

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is unusual about the list as a whole."""
        return ()

    def refusals(self, usual: float) -> list[str]:
        """For every drop why it cannot be fitted, "" where it can."""
        return self.peaks.refusals(usual)

    def flags(self) -> list[str]:
        """For every drop what is unusual about its peaks, and what layers without inertia cannot show of it."""
        flags = self.peaks.flags()
        lag = self.delays
        for number, late in enumerate(lag[:, -1] - lag[:, 0]):
            if late > _LATE:
                text = (
                    f"inertia: peaks at {self.offsets[-1]:g} m come {late * 1e3:.2g} ms after those of the innermost "
                    "sensor: waves travel, which these layers cannot show, and moduli fitted over time answer for "
                    "it; "
                    "fit the peaks, .peaks"
                )
                flags[number] = "; ".join([flags[number]] * bool(flags[number]) + [text])
        return flags


def read_history(
    path: str | os.PathLike[str],
    *,
    offsets: Sequence[Length],
    plate_radius: Length,
    units: Mapping[str, str],
    time: str = "Time",
    force: str = "Force",
    deflections: Sequence[str] = (),
) -> DropHistories:
    """The record of a drop from a table of text, a row for each time.

    offsets: of the sensors, m. plate_radius: m. units: column → unit, of those that name none in brackets. time,
    force, deflections: columns; deflections left out are D1, D2 and so on. Raises InputError.

    >>> from pathlib import Path
    >>> times = [2 * k for k in range(25)]  # ms
    >>> forces = [max(0.0, 50 * 4 * t / 30 * (1 - t / 30)) for t in times]  # kN
    >>> rows = [f"{t};{force};{8 * force}" for t, force in zip(times, forces, strict=True)]
    >>> _ = Path("drop.txt").write_text("Time [ms];Force [kN];D1 [um]" + "".join(chr(10) + row for row in rows))
    >>> drop = tl.roads.read_history("drop.txt", offsets=[0.0], plate_radius=0.15, units={})
    >>> f"{drop.peaks.load[0] / 1e3:.0f} kN, {drop.peaks.deflection[0, 0] * 1e6:.0f} µm"
    '50 kN, 398 µm'
    """
    table = read_table(path)
    if not table.has_header or len(table.rows) < 2:
        raise InputError(
            f"{path} needs a line of headings, such as Time [s], Force [kN], D1 [µm], and a row for each time"
        )
    columns = TableColumns(table, units)
    names = list(deflections) or [f"D{number + 1}" for number in range(len(offsets))]
    if len(names) != len(offsets):
        raise InputError(f"{path}: {len(offsets)} offsets for {len(names)} columns of deflections; give one for each")
    return DropHistories(
        columns.values(columns.find(time, "time"), "s"),
        columns.values(columns.find(force, "force"), "N")[None],
        np.stack([columns.values(columns.find(name, "deflections"), "m") for name in names])[None],
        np.array([float(offset) for offset in offsets]),
        plate_radius,
        source=Path(path).name,
    )


def _peak_times(time: Array, values: Array) -> Array:
    """Of the peaks of values (..., nt), s."""
    at = np.clip(values.argmax(axis=-1), _NEAR, len(time) - 1 - _NEAR)
    around = np.arange(-_NEAR, _NEAR + 1)
    near = np.take_along_axis(values, at[..., None] + around, axis=-1)
    # The parabola through 2 n + 1 points: least squares.
    bend, tilt, _ = np.linalg.lstsq(np.vander(around, 3), near.reshape(-1, len(around)).T, rcond=None)[0]
    with np.errstate(divide="ignore", invalid="ignore"):
        apart = np.where(bend < 0, -tilt / (2 * bend), 0.0)
    step = float(time[1] - time[0])
    return np.asarray(time[at] + step * np.clip(apart, -_NEAR, _NEAR).reshape(at.shape))
